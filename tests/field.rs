//! The lines of docs/cases.md: each command does what the page says.

#![cfg(feature = "cli")]

use std::path::Path;
use std::process::Command;

/// Kind, command and what is right, of each line of the table.
fn cases() -> Vec<[String; 3]> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/cases.md")).unwrap();
    let lines = page.lines().filter(|line| line.contains("| `dpsm "));
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split(" | ").map(|cell| cell.trim().to_string()).collect()
    };
    lines.map(|line| cells(line).try_into().expect("three cells")).collect()
}

/// A command's exit code, standard output and error, by the ports in the project's root.
fn run(command: &str) -> (Option<i32>, String, String) {
    let arguments = command.trim_matches('`').split(' ').skip(1);
    let mut program = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    program.current_dir(env!("CARGO_MANIFEST_DIR")).args(["--adapter", "cpu"]).args(arguments);
    let output = program.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn every_case_of_the_page_comes_out_right() {
    let cases = cases();
    assert!(cases.len() > 25, "{}", cases.len());
    for [kind, command, right] in cases {
        let (code, stdout, stderr) = run(&command);
        if !right.chars().all(|c| "01 ".contains(c)) {
            assert_eq!(code, Some(2), "{kind}: {stderr}");
            assert!(stderr.contains(&right), "{kind}: `{right}` is not in\n{stderr}");
            continue;
        }
        assert_eq!(code, Some(0), "{kind}: {stderr}");
        let column = |index: usize| {
            let of = |line: &str| line.split(',').nth(index).unwrap().parse::<f32>().unwrap();
            let values = stdout.lines().skip(1).map(of);
            values.map(|value| format!("{}", value.round())).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(column(0), right, "{kind}: by maps");
        assert_eq!(column(6), right, "{kind}: by rays");
    }
}
