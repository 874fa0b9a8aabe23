//! The program: link, validate and eval.

use std::path::Path;
use std::process::{Command, Output};

use super::{HEAD, folder};

fn dpsm(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    command.current_dir(folder).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// What it prints, and what it says on stderr.
fn done(folder: &Path, arguments: &[&str]) -> (String, String) {
    let output = dpsm(folder, arguments);
    let stderr = text(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    (text(&output.stdout), stderr)
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = dpsm(folder, arguments);
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
    stderr
}

fn body(statement: &str) -> String {
    format!(
        "{HEAD}@fragment\nfn lit(@location(0) p: vec3<f32>) -> @location(0) vec4<f32> {{\n    {statement}\n    \
         return vec4<f32>(dpsm_visibility(maps, comparison, p, light, 0.001));\n}}\n"
    )
}

#[test]
fn link_decides_features_and_asks_naga_when_told() {
    let wesl = body("@if(A) { return vec4f(0.0); }");
    let folder =
        folder("program", &[("cond.wesl", &wesl), ("bad.wesl", "fn f() -> f32 { return g(); }\n")]);
    let (linked, notes) = done(&folder, &["link", "cond.wesl"]);
    assert!(linked.contains("    @if(A) { return vec4f(0.0); }\n"));
    assert!(notes.contains("cond.wesl:8: `@if(A)`") && notes.contains("--feature A"), "{notes}");
    let (linked, notes) = done(&folder, &["link", "cond.wesl", "--feature", "A", "--validate"]);
    assert!(linked.contains("           { return vec4f(0.0); }\n") && notes.is_empty());
    for off in ["A=false", "*=false", "A=true,A=false"] {
        let (linked, _) = done(&folder, &["link", "cond.wesl", "--feature", off]);
        assert!(!linked.contains("vec4f(0.0)"), "{off}");
    }
    assert!(
        refused(&folder, &["link", "cond.wesl", "--validate"]).contains("cond.wesl:8: no WGSL yet")
    );
    assert!(
        refused(&folder, &["link", "cond.wesl", "--feature", "B"])
            .contains("the feature `A` is not given")
    );
    for wrong in ["A=1", "", "*", "a b", "A=maybe"] {
        refused(&folder, &["link", "cond.wesl", "--feature", wrong]);
    }
    // naga has no word without being asked
    let (linked, _) = done(&folder, &["link", "bad.wesl"]);
    assert_eq!(linked, "fn f() -> f32 { return g(); }\n");
    assert!(
        refused(&folder, &["link", "bad.wesl", "--validate", "-o", "out.wgsl"])
            .contains("bad.wesl:1:24")
    );
    assert!(!folder.join("out.wgsl").exists());
}

#[test]
fn modules_of_other_folders_are_given_by_path() {
    let folder = folder(
        "program-modules",
        &[
            (
                "main/a.wesl",
                "import super::noise::{noise};\nimport super::tone::{tone};\nfn f() -> f32 { return noise() + tone(); }\n",
            ),
            ("common/noise.wesl", "fn noise() -> f32 { return 1.0; }\n"),
            ("common/tone.wesl", "fn tone() -> f32 { return 1.0; }\n"),
        ],
    );
    let modules = ["--module", "common/noise.wesl", "--module", "common/tone.wesl"];
    done(&folder, &[&["validate", "main/a.wesl"][..], &modules].concat());
    let (linked, _) =
        done(&folder, &[&["link", "main/a.wesl", "--validate"][..], &modules].concat());
    assert!(linked.contains("// common/noise.wesl\n"));
    let missing = refused(&folder, &["link", "main/a.wesl"]);
    assert!(
        missing.contains("main/a.wesl:1: no module `noise`") && missing.contains("`a.wesl`"),
        "{missing}"
    );
    assert!(refused(&folder, &["link", "noise", "--module", "common"]).contains("it is a folder"));
    assert!(
        refused(&folder, &["link", "noise", "--module", "common/nois.wesl"])
            .contains("`noise.wesl`")
    );
}

#[test]
fn validate_takes_every_file_of_dist_and_says_what_it_does_not_check() {
    let dist = Path::new(env!("CARGO_MANIFEST_DIR")).join("dist");
    for module in dpsm::MODULES {
        let file = format!("{}.wgsl", module.name);
        let (said, notes) = done(&dist, &["validate", &file]);
        assert!(
            said.starts_with(&format!("{file}: valid by naga")) && notes.is_empty(),
            "{said}{notes}"
        );
        assert!(said.contains("not checked: uniformity"), "{said}");
    }
    let folder =
        folder("uniformity", &[("u.wesl", &body("if p.x > 0.0 { return vec4f(dpdx(p.x)); }"))]);
    let (said, _) = done(&folder, &["validate", "u.wesl"]);
    assert!(
        said.contains("not checked: uniformity") && said.contains("u.wesl:8:33 (`dpdx`)"),
        "{said}"
    );
    assert!(said.contains("--tint"), "{said}");
    assert!(
        refused(&folder, &["validate", "visibility"]).contains("dpsm link visibility --validate")
    );
    assert!(refused(&folder, &["validate", "v.wesl"]).contains("holds `u.wesl`"));
}

#[test]
fn tint_is_asked_where_node_and_its_package_are() {
    let good = body("");
    let folder = folder(
        "tint",
        &[("u.wesl", &body("if p.x > 0.0 { return vec4f(dpdx(p.x)); }")), ("good.wesl", &good)],
    );
    // no node on an empty path
    let mut without = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    without.current_dir(&folder).env("PATH", "").env("DPSM_TINT", folder.join("none"));
    let output = without.args(["validate", "good.wesl", "--tint"]).output().unwrap();
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(
        stderr.contains("no Tint: `node` is not there") && stderr.contains("without --tint"),
        "{stderr}"
    );
    // tools/webgpu installs it
    let package = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/tint");
    let current = std::fs::read_to_string(package.join("package.json")).unwrap_or_default();
    if current != include_str!("../../tools/package.json")
        || !package.join("node_modules/webgpu").is_dir()
    {
        println!("skipped: tools/webgpu has not run");
        return;
    }
    let ask = |file: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dpsm"));
        command.current_dir(&folder).env("DPSM_TINT", &package);
        command.args(["validate", "--tint", file]).output().unwrap()
    };
    let output = ask("u.wesl");
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(
        stderr.contains("u.wesl:8:33: error: 'dpdx' must only be called from uniform"),
        "{stderr}"
    );
    let output = ask("good.wesl");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("good.wesl: valid by Tint"));
}

#[test]
fn wrong_names_list_what_there_is_with_the_nearest_first() {
    let folder = folder("names", &[]);
    for (arguments, parts) in [
        (
            &["link", "nosuch"][..],
            &["unknown module `nosuch`", "`visibility`", "`depth`", "`shade`"][..],
        ),
        (&["link", "visibilty"], &["did you mean `visibility`? There are `visibility`, "]),
        (&["link", "dpsm_nosuc"], &["unknown module `dpsm_nosuc`; there are `", "::dpsm_"]),
        (
            &["link", "dpsm_projct"],
            &["did you mean `paraboloid::dpsm_project`? There are `paraboloid::dpsm_project`"],
        ),
        (
            &["link", "dpsm_project"],
            &[
                "`dpsm_project` is an item of the module `paraboloid`",
                "write `paraboloid::dpsm_project`",
            ],
        ),
        (&["link", "depth::nosuch"], &["unknown item `nosuch` in module `depth`", "`dpsm_depth`"]),
        (&["link", "depth::dpsm_project"], &["did you mean `paraboloid::dpsm_project`?"]),
        (
            &["eval", "dpsm_nosuch"],
            &["unknown function `dpsm_nosuch`; there are `", "more; `dpsm eval --list` shows all"],
        ),
        (&["eval", "dpsm_projct"], &["did you mean `dpsm_project`? There are `dpsm_project`, "]),
        (
            &["eval", "paraboloid"],
            &["`paraboloid` is a module, not a function", "`dpsm_project`, "],
        ),
        (&["eval", "paraboloid::dpsm_project"], &["write `dpsm_project` alone"]),
        (&["eval", "DpsmLight"], &["`DpsmLight` is a `struct` of the module `light`"]),
        (&["eval", "dpsm_nosuch", "--exhaustive"], &["unknown function `dpsm_nosuch`"]),
    ] {
        let stderr = refused(&folder, arguments);
        for part in parts {
            assert!(stderr.contains(part), "{arguments:?}: `{part}` is not in\n{stderr}");
        }
    }
    let (list, _) = done(&folder, &["eval", "--list"]);
    assert!(list.contains("dpsm_project(p.x, p.y, p.z)\n"), "{list}");
    assert!(!list.contains("dpsm_visibility("), "it takes a texture");
}
