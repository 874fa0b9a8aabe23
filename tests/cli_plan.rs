//! `dpsm plan`, its file, and what it says to bad input.

#![cfg(feature = "cli")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-plan-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn dpsm(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    command.current_dir(folder).args(arguments).output().unwrap()
}

/// What a command prints that succeeds.
fn printed(folder: &Path, arguments: &[&str]) -> String {
    let output = dpsm(folder, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    String::from_utf8(output.stdout).unwrap()
}

/// What a command says that must end with exit code 2.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = dpsm(folder, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
    assert!(!stderr.contains("panicked") && !stderr.contains("fault of this program"), "{stderr}");
    stderr
}

#[test]
fn a_plan_is_taken_by_every_command_on_a_scene() {
    let folder = folder("taken");
    let arguments = ["plan", "cornell", "--camera", "scene", "--error", "0.5deg", "-o", "p.json"];
    let text = printed(&folder, &arguments);
    for part in ["hemispheres", "nothing that shows lies behind floor", "whole", "predicted: "] {
        assert!(text.contains(part), "{text}");
    }
    let json = std::fs::read_to_string(folder.join("p.json")).unwrap();
    let plan: serde_json::Value = serde_json::from_str(&json).unwrap();
    let size = plan["size"].as_u64().unwrap();
    let cpu = ["--adapter", "cpu", "cornell", "--plan", "p.json"];
    let with = |command: &str, more: &[&str]| {
        let all: Vec<&str> = [command].into_iter().chain(cpu).chain(more.iter().copied()).collect();
        printed(&folder, &all)
    };
    with("render", &["--image", "64x48", "--maps", "-o", "p.png"]);
    let map = image::open(folder.join("p-front-map.png")).unwrap();
    assert_eq!(u64::from(map.width()), size);
    with("bake", &["-o", "maps.exr"]);
    let report: serde_json::Value =
        serde_json::from_str(&with("measure", &["--count", "2000", "--json"])).unwrap();
    assert_eq!(report["size"], plan["size"]);
    assert_eq!(report["options"]["format"], plan["format"]);
    assert_eq!(report["options"]["method"], plan["method"]);
    assert_eq!(report["options"]["filter"], plan["filter"]);
    std::fs::write(folder.join("points.csv"), "x,y,z\n0.278,0.0,0.28\n").unwrap();
    with("probe", &["--points", "points.csv"]);
}

#[test]
fn the_same_seed_gives_the_same_plan_and_the_light_may_move() {
    let folder = folder("seed");
    let lights = "x,y,z\n0.2,0.4,0.2\n0.3,0.4,0.2\n";
    std::fs::write(folder.join("path.csv"), lights).unwrap();
    let path = ["plan", "cornell", "--path", "path.csv", "--json", "--error", "1deg"];
    let (first, second) = (printed(&folder, &path), printed(&folder, &path));
    assert_eq!(first, second);
    let given = [
        "plan",
        "cornell",
        "--light",
        "0.2,0.4,0.2",
        "--light",
        "0.3,0.4,0.2",
        "--json",
        "--error",
        "1deg",
    ];
    assert_eq!(printed(&folder, &given), first);
}

#[test]
fn bad_requests_name_the_input_and_the_remedy() {
    let folder = folder("bad");
    std::fs::write(folder.join("empty.csv"), "x,y,z\n").unwrap();
    for (arguments, parts) in [
        (&["plan", "nowhere"][..], &["no scene is called `nowhere`"][..]),
        (&["plan", "cornell", "--error", "2miles"], &["`2miles` is no error", "0.1deg"]),
        (&["plan", "cornell", "--error", "-1"], &["`-1` is no error above 0"]),
        (&["plan", "cornell", "--budget", "0"], &["--budget 0 is no number of MiB above 0"]),
        (&["plan", "cornell", "--budget", "1e-9"], &["raise --budget"]),
        (&["plan", "cornell", "--camera", "here"], &["expected three numbers", "or `scene`"]),
        (&["plan", "cornell", "--look-at", "0,0,0"], &["--camera"]),
        (&["plan", "cornell", "--path", "none.csv"], &["none.csv"]),
        (&["plan", "cornell", "--path", "empty.csv"], &["empty.csv has no position"]),
        (&["plan", "cornell", "--light", "0,0,0", "--path", "empty.csv"], &["cannot be used with"]),
        (
            &["plan", "cornell", "--camera", "9,9,9", "--look-at", "99,99,99"],
            &["nothing that the light could reach is seen", "--camera"],
        ),
        (&["plan", "cornell", "--camera", "1,1,1", "--look-at", "1,1,1"], &["camera"]),
        (&["plan", "cornell", "--image", "0x4"], &["image width 0"]),
        (&["plan", "cornell", "-o", "no/such/folder.json"], &["folder.json", "-o"]),
    ] {
        let stderr = refused(&folder, arguments);
        for part in parts {
            assert!(stderr.contains(part), "{arguments:?}: `{part}` is not in\n{stderr}");
        }
    }
}

#[test]
fn bad_plans_are_refused() {
    let folder = folder("bad-plans");
    printed(&folder, &["plan", "cornell", "--error", "1deg", "-o", "p.json"]);
    let json = std::fs::read_to_string(folder.join("p.json")).unwrap();
    let write = |name: &str, text: String| std::fs::write(folder.join(name), text).unwrap();
    write("text.json", "no plan".into());
    write("version.json", json.replace("\"version\": 2", "\"version\": 7"));
    write("size.json", json.replace("\"size\": ", "\"size\": 9999"));
    write("filter.json", json.replace("\"filter\": \"single", "\"filter\": \"hard"));
    let render = |scene: &'static str, plan: &'static str, more: &[&'static str]| {
        let all = ["--adapter", "cpu", "render", scene, "-o", "p.png", "--plan", plan];
        refused(&folder, &[&all[..], more].concat())
    };
    for (stderr, part) in [
        (render("cornell", "none.json", &[]), "cannot read none.json"),
        (render("cornell", "text.json", &[]), "text.json is no plan"),
        (render("cornell", "version.json", &[]), "a plan of version 7, not 2"),
        (render("cornell", "filter.json", &[]), "the plan's filter `hard`"),
        (render("cornell", "size.json", &[]), "must be from 1 to"),
        (render("brabec-room", "p.json", &[]), "the plan is for `cornell` with 7 meshes"),
        (
            refused(&folder, &["bake", "cornell", "--plan", "p.json", "-o", "p.exr"]),
            "p.exr's parameters would replace the plan p.json",
        ),
        (render("cornell", "p.json", &["--size", "64"]), "cannot be used with"),
        (render("cornell", "p.json", &["--bias", "constant"]), "cannot be used with"),
    ] {
        assert!(stderr.contains(part), "`{part}` is not in\n{stderr}");
    }
    assert!(!folder.join("p.png").exists());
}
