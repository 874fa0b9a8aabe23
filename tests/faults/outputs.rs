//! Places that cannot be written: what a command writes appears whole and together, or not at all.

use crate::support::{BAKE, EVAL, LINK, PROBE, RENDER, Run, Writes, contents, folder, run};

const ALL: [&Writes; 5] = [&RENDER, &BAKE, &PROBE, &EVAL, &LINK];

#[cfg(unix)]
#[test]
fn disk_that_is_full_leaves_every_file_as_it_was() {
    for command in ALL {
        let folder = command.folder("full");
        let before = contents(&folder);
        // no file may hold a byte: writing fails as on a full disk
        let run = command.run(&folder, "cpu", "trap '' XFSZ; ulimit -f 0;", &[]);
        assert!(run.stderr.contains("cannot write"), "{run:?}");
        run.failed(command.name, 1, "choose another place with -o");
        assert_eq!(contents(&folder), before, "{}", command.name);
    }
}

/// A name of 255 bytes, the longest that file systems take: for what is written beside it under a
/// longer name there is no place, which only its move finds out.
#[cfg(unix)]
fn longest(extension: &str) -> String {
    "n".repeat(255 - extension.len()) + extension
}

#[cfg(unix)]
#[test]
fn outputs_of_one_command_appear_together_or_not_at_all() {
    for (command, extension) in [(&BAKE, ".exr"), (&RENDER, ".png")] {
        let name = longest(extension);
        let arguments = command.arguments.iter().map(|&argument| match argument {
            "maps.exr" | "room.png" => name.as_str(),
            other => other,
        });
        let dpsm = |folder: &std::path::Path| -> Run {
            let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_dpsm"));
            program.current_dir(folder).args(arguments.clone()).args(["--adapter", "cpu"]);
            run(&mut program)
        };
        for old in [None, Some("from before")] {
            let folder = folder(&format!("together-{}", command.name));
            if let Some(old) = old {
                std::fs::write(folder.join(&name), old).unwrap();
            }
            let before = contents(&folder);
            let run = dpsm(&folder);
            assert!(run.stderr.contains("cannot write"), "{run:?}");
            run.failed(command.name, 2, "choose another place with -o");
            assert_eq!(contents(&folder), before, "{}", command.name);
        }
    }
}

#[test]
fn folder_that_is_a_file_is_refused() {
    for command in ALL {
        let folder = command.folder("no-folder");
        std::fs::write(folder.join("plain"), "a file").unwrap();
        let before = contents(&folder);
        let below = format!("plain/{}", command.files[0]);
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_dpsm"));
        let arguments = command.arguments.iter().map(|&argument| match argument {
            argument if argument == command.files[0] => below.as_str(),
            other => other,
        });
        let run = run(program.current_dir(&folder).args(arguments).args(["--adapter", "cpu"]));
        run.failed(command.name, 2, "choose another place with -o");
        assert!(run.stderr.contains(&below), "{run:?}");
        assert_eq!(contents(&folder), before, "{}", command.name);
    }
    for place in ["plain", "plain/below"] {
        let folder = folder("job-folder");
        std::fs::write(folder.join("plain"), "a file").unwrap();
        let arguments = &["--folder", place];
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_dpsm"));
        let run = run(program.current_dir(&folder).args(arguments).args(["--adapter", "cpu"]));
        run.failed(place, 2, "choose another place with --folder");
        assert_eq!(contents(&folder).len(), 1);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_is_full_is_an_error() {
    let eval = Writes { name: "print", arguments: &["eval", "dpsm_depth"], files: &[] };
    let run = eval.run(&folder("print"), "cpu", "exec >/dev/full;", &[]);
    run.failed("eval", 1, "choose another place with -o");
    assert!(run.stderr.contains("cannot write standard output"), "{run:?}");
    // what was written before is whole, and stays
    let folder = BAKE.folder("print");
    let run = BAKE.run(&folder, "cpu", "exec >/dev/full;", &[]);
    run.failed("bake", 1, "choose another place with -o");
    assert!(BAKE.files.iter().all(|file| folder.join(file).exists()), "{run:?}");
}
