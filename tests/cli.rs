//! The program: its commands, and what it says to bad input.

#![cfg(feature = "cli")]

mod common;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn dpsm(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    command.current_dir(folder).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Files in a folder, by name.
fn files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Runs a command that must fail with exit code 2, say all of `parts` and leave no file behind.
fn refused(name: &str, arguments: &[&str], parts: &[&str]) {
    let folder = folder(name);
    let before = files(&folder);
    let output = dpsm(&folder, arguments);
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
    for part in parts {
        assert!(stderr.contains(part), "{arguments:?}: `{part}` is not in\n{stderr}");
    }
    assert!(!stderr.contains("panicked"), "{stderr}");
    assert_eq!(files(&folder), before, "{arguments:?} left files behind");
}

#[test]
fn no_argument_reports_on_every_built_in_scene() {
    let folder = folder("main-job");
    let mut command = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    command.current_dir(&folder).args(["--adapter", "cpu"]);
    let mut child = command.stdout(std::process::Stdio::null()).spawn().unwrap();
    let out = folder.join("dpsm-report");
    // the whole takes minutes: what is left is named from the beginning
    while !out.join("report.csv").exists() {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("report.json")).unwrap()).unwrap();
    let left = report["unfinished"].as_array().unwrap().clone();
    let mut expected: Vec<&str> = dpsm::scene::BUILT_IN.iter().map(|(name, _)| *name).collect();
    expected.push("costs");
    assert_eq!(left, expected);
    assert_eq!(files(&out), ["parts", "report.csv", "report.html", "report.json"]);
}

#[test]
fn missing_adapter_falls_back_to_the_ports_and_says_so() {
    let folder = folder("no-adapter");
    let mut command = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    // a back-end that this system has not
    let missing = if cfg!(windows) { "metal" } else { "dx12" };
    command.current_dir(&folder).env("WGPU_BACKEND", missing);
    let arguments = ["render", "cornell", "--size", "64", "--image", "32x24", "-o", "cornell.png"];
    let output = command.args(arguments).output().unwrap();
    let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{stderr}");
    assert!(stderr.contains("no usable adapter of the back-end WGPU_BACKEND="), "{stderr}");
    assert!(stdout.contains("the scalar ports on the processor"), "{stdout}");
    assert_eq!(files(&folder), ["cornell.png"]);

    let output = command.args(["--adapter", "gpu"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("--adapter cpu"), "the remedy is not named");
}

#[test]
fn adapter_that_is_named_and_not_there_is_an_error_that_lists_those_that_are() {
    let folder = folder("named-adapter");
    let mut command = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    command.current_dir(&folder).env("WGPU_ADAPTER_NAME", "no such adapter");
    let output =
        command.args(["render", "cornell", "--size", "64", "-o", "c.png"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let stderr = text(&output.stderr);
    assert!(stderr.contains("no usable adapter whose name contains `no such adapter`"), "{stderr}");
    if let Some(device) = common::device() {
        assert!(stderr.contains(&device.info.name), "{stderr}");
    }
    assert!(files(&folder).is_empty());
}

#[test]
fn negative_light_coordinates_work_with_and_without_an_equals_sign() {
    let folder = folder("negative");
    for (name, light) in [
        ("a.png", &["--light=-1,2,0.5"][..]),
        ("b.png", &["--light", "-1,2,0.5"]),
        ("default.png", &[]),
    ] {
        let mut arguments = vec![
            "render",
            "brabec-room",
            "--adapter",
            "cpu",
            "--size",
            "64",
            "--image",
            "32x24",
            "-o",
            name,
        ];
        arguments.extend(light);
        let output = dpsm(&folder, &arguments);
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    let read = |name| std::fs::read(folder.join(name)).unwrap();
    assert_eq!(read("a.png"), read("b.png"));
    assert_ne!(read("a.png"), read("default.png"));
}

#[test]
fn bad_scenes_are_refused() {
    let folder = folder("scenes");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.join(name), text).unwrap();
        folder.join(name).display().to_string()
    };
    let empty = write("no-triangles.obj", "v 0 0 0\n");
    let malformed = write("malformed.gltf", "{ \"asset\": ");
    let render = |scene| ["render", scene, "--adapter", "cpu", "-o", "out.png"];
    refused("unknown", &render("brabec-rom"), &["brabec-rom", "brabec-room"]);
    refused("missing", &render("nowhere.obj"), &["nowhere.obj"]);
    refused("empty", &render(&empty), &["no-triangles.obj", "triangles"]);
    refused("malformed", &render(&malformed), &["malformed.gltf"]);
}

#[test]
fn non_finite_vertices_are_counted_named_and_dropped_with_a_warning() {
    let folder = folder("non-finite");
    let scene = "o quad\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv nan 0 0\n\
                 f 1 2 3\nf 1 3 4\nf 1 2 5\n";
    std::fs::write(folder.join("quad.obj"), scene).unwrap();
    let arguments = [
        "render",
        "quad.obj",
        "--adapter",
        "cpu",
        "--light",
        "0.5,0.5,2",
        "--size",
        "64",
        "--image",
        "32x24",
        "-o",
        "quad.png",
    ];
    let output = dpsm(&folder, &arguments);
    let stderr = text(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    assert!(stderr.contains("1 non-finite"), "{stderr}");
    assert!(stderr.contains("1 triangle"), "{stderr}");
}

#[test]
fn bad_settings_are_refused() {
    let with = |extra: &[&'static str]| {
        let mut arguments = vec!["render", "cornell", "--adapter", "cpu", "-o", "out.png"];
        arguments.extend(extra);
        arguments
    };
    refused("axis", &with(&["--axis=0,0,0"]), &["axis", "--axis"]);
    refused("picture", &["render", "cornell", "-o", "out.jpg"], &["out.jpg", "PNG"]);
    refused("near", &with(&["--near", "-1"]), &["near -1"]);
    refused(
        "bias-of-another-filter",
        &with(&["--filter", "single", "--bias", "footprint"]),
        &["--bias footprint is not for --filter single", "hard and hardware"],
    );
    refused(
        "filter-of-another-bias",
        &with(&["--filter", "hard", "--bias", "plane"]),
        &["--bias plane is not for --filter hard", "--filter single"],
    );
    refused(
        "filter-taps",
        &with(&["--filter", "single", "--taps", "8"]),
        &["--filter single takes no --taps"],
    );
    refused(
        "filter-no-taps",
        &with(&["--filter", "disk", "--taps", "0"]),
        &["0 taps", "1 to 1024"],
    );
    for filter in ["single", "disk", "pcss"] {
        let linear = ["--filter", filter, "--linear-taps"];
        let named = format!("--filter {filter} takes no --linear-taps");
        refused("filter-linear", &with(&linear), &[&named]);
    }
    let angle = ["--filter", "disk", "--kernel-angle", "90"];
    refused("filter-angle", &with(&angle), &["--kernel-angle 90", "below 90"]);
    let soft = ["--filter", "disk", "--light-size", "0.1"];
    refused("filter-soft", &with(&soft), &["--filter disk takes no --light-size or --nearest"]);
    let radius = ["--filter", "mirror", "--kernel-radius=-1"];
    refused("filter-radius", &with(&radius), &["--kernel-radius) of -1", "0 to 1024"]);
    let cube = ["--filter", "pcss", "--method", "cube"];
    refused("filter-cube", &with(&cube), &["paraboloid maps", "--filter hard", "another --method"]);
    let vertex = ["--filter", "disk", "--lookup", "vertex"];
    refused("filter-vertex", &with(&vertex), &["lookups by pixel", "--lookup pixel"]);
    let two = ["--bias", "footprint", "--constant-bias", "0.01"];
    refused("bias", &with(&two), &["--constant-bias is for --bias constant, not footprint"]);
    refused("light-text", &with(&["--light", "1,2"]), &["--light", "three numbers"]);
    refused("light-range", &with(&["--light", "1e39,0,0"]), &["1e39", "float range"]);
    refused("light-huge", &with(&["--light", "1e30,0,0"]), &["light", "1e18"]);
    refused("light-nan", &with(&["--light", "nan,0,0"]), &["nan", "float range"]);
    refused("spheres", &with(&["--near", "2", "--far", "1"]), &["near 2", "far 1"]);
    refused("size-zero", &with(&["--size", "0"]), &["--size 0"]);
    refused("size-large", &with(&["--size", "100000"]), &["--size 100000", "16384"]);
    refused("image", &with(&["--image", "0x10"]), &["image width 0"]);
    refused("samples", &with(&["--samples", "9"]), &["--samples 9 must be from 1 to 8"]);
    refused("exposure", &with(&["--exposure", "-1"]), &["--exposure -1", "leave it out"]);
    refused("image-text", &with(&["--image", "10"]), &["960x720"]);
    let cube = |extra: &[&'static str]| [&with(&["--method", "cube"])[..], extra].concat();
    refused("lookup", &cube(&["--lookup", "vertex"]), &["lookup by vertex", "--lookup pixel"]);
    refused("atlas", &cube(&["--passes", "atlas"]), &["atlas", "--passes single"]);
    refused("cube-views", &cube(&["--passes", "multiview"]), &["multiview", "--passes single"]);
    refused("passes", &with(&["--passes", "double"]), &["--passes", "atlas"]);
    let level = ["--method", "tessellated", "--level", "0"];
    refused("level", &with(&level), &["--level", "`0` is not from 1 to 64"]);
    refused("method-name", &with(&["--method", "vertx"]), &["vertex"]);
    refused("walls", &["render", "brabec-room", "--walls", "0", "-o", "o.png"], &["walls"]);
    let whole = "`1e3` is not written as a whole number: give 1000";
    refused("size-power", &with(&["--size", "1e3"]), &["--size", whole]);
    refused("size-part", &with(&["--size", "10.5"]), &["--size", "`10.5` is not a whole number"]);
    refused("size-most", &with(&["--size", "99999999999"]), &["--size", "4294967295"]);
    refused("image-power", &with(&["--image", "1e3x10"]), &["--image", whole]);
    refused("same-point", &with(&["--camera", "0,0,0", "--look-at", "0,0,0"]), &["same point"]);
}

#[test]
fn options_that_a_command_would_not_look_at_are_refused() {
    let with = |extra: &[&'static str]| {
        [&["render", "cornell", "--adapter", "cpu", "-o", "out.png"][..], extra].concat()
    };
    for (option, method) in [
        (&["--level", "4"][..], "tessellated"),
        (&["--tau", "0.1"][..], "refined"),
        (&["--no-cull-faces"][..], "cube"),
    ] {
        let named = format!("{} is for --method {method}, not exact", option[0]);
        let exact = [&["--method", "exact"][..], option].concat();
        refused("option-of-another-method", &with(&exact), &[&named]);
    }
    for filter in ["disk", "mirror", "reproject", "pcss"] {
        for bias in
            [&["--bias", "footprint"][..], &["--bias", "plane"], &["--constant-bias", "0.01"]]
        {
            let named = format!("is not for --filter {filter}: give none");
            let asked = [&["--filter", filter][..], bias].concat();
            refused("bias-of-taps", &with(&asked), &[&named]);
        }
    }
    let pcf = ["--filter", "pcf", "--bias", "plane"];
    refused("bias-of-pcf", &with(&pcf), &["--bias plane is not for --filter pcf"]);
    let folder = folder("walls-of-a-file");
    let obj = folder.join("floor.obj");
    std::fs::write(&obj, "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n").unwrap();
    let obj = obj.to_str().unwrap();
    for scene in [obj, "hills"] {
        for command in [
            &["render", scene, "-o", "out.png"][..],
            &["measure", scene],
            &["plan", scene],
            &["report", scene],
        ] {
            let arguments = [command, &["--walls", "2"]].concat();
            refused("walls-of-none", &arguments, &["--walls is for built-in rooms", scene]);
        }
    }
    refused("folder-of-none", &["--folder", "there", "modules"], &["--folder there", "-o"]);
}

#[test]
fn meshes_that_are_to_cast_no_shadow_are_named_in_every_command() {
    let folder = folder("no-cast");
    std::fs::write(folder.join("below.csv"), "x,y,z\n0.1,0,0.1\n5,0,4\n").unwrap();
    let obj = "o floor\nv -9 0 -9\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nf 1 2 3 4\n\
               o shade\nv -1 2 -1\nv -1 2 1\nv 1 2 1\nv 1 2 -1\nf 5 6 7 8\n";
    std::fs::write(folder.join("lamp.obj"), obj).unwrap();
    let lit = |extra: &[&str]| {
        let common = ["probe", "lamp.obj", "--light", "0,3,0", "--points", "below.csv"];
        let output =
            dpsm(&folder, &[&common[..], &["--adapter", "cpu", "--size", "128"], extra].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let lines = text(&output.stdout);
        let columns = |line: &str| {
            let fields: Vec<&str> = line.split(',').collect();
            format!("{} {}", fields[0], fields[6])
        };
        lines.lines().skip(1).map(columns).collect::<Vec<_>>()
    };
    assert_eq!(lit(&[]), ["0 0", "1 1"]);
    assert_eq!(lit(&["--no-cast", "shade"]), ["1 1", "1 1"]);
    // a plan remembers it
    let plan = ["plan", "lamp.obj", "--light", "0,3,0", "--no-cast", "shade", "-o", "plan.json"];
    let planned = dpsm(&folder, &plan);
    assert!(planned.status.success(), "{}", text(&planned.stderr));
    assert!(
        text(&planned.stdout).contains("to cast no shadow: shade"),
        "{}",
        text(&planned.stdout)
    );
    let by_plan =
        ["probe", "lamp.obj", "--plan", "plan.json", "--points", "below.csv", "--adapter", "cpu"];
    let output = dpsm(&folder, &by_plan);
    let lines = text(&output.stdout);
    assert!(lines.lines().skip(1).all(|line| line.starts_with("1,")), "{lines}");
    for command in [
        &["render", "cornell", "-o", "o.png"][..],
        &["measure", "cornell"],
        &["bake", "cornell", "-o", "o.exr"],
        &["plan", "cornell"],
        &["report", "cornell"],
    ] {
        let arguments = [command, &["--no-cast", "tall blok"]].concat();
        refused("no-cast-unknown", &arguments, &["--no-cast tall blok", "no"]);
    }
    let unknown = ["measure", "cornell", "--no-cast", "ceilin"];
    refused("no-cast-nearest", &unknown, &["it has ceiling, "]);
}

#[test]
fn plans_for_a_spot_keep_its_cone_and_range() {
    let folder = folder("planned-spot");
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases");
    let [scene, points] = ["spot.gltf", "spot.csv"].map(|name| cases.join(name));
    let [scene, points] = [&scene, &points].map(|path| path.to_str().unwrap());
    let planned = dpsm(&folder, &["plan", scene, "-o", "plan.json"]);
    assert!(planned.status.success(), "{}", text(&planned.stderr));
    let probe = |extra: &[&str]| {
        let common = ["probe", scene, "--points", points, "--adapter", "cpu"];
        let output = dpsm(&folder, &[&common[..], extra].concat());
        let lines = text(&output.stdout);
        let lit = |line: &str| line.starts_with("1,");
        lines.lines().skip(1).map(lit).collect::<Vec<_>>()
    };
    assert_eq!(probe(&["--plan", "plan.json"]), [false, true, true, false, false]);
    // a light that is moved shines everywhere
    assert_eq!(probe(&["--light", "0,4,0"]), [false, true, true, true, true]);
}

#[test]
fn what_near_or_far_cuts_off_is_named_by_the_commands() {
    let folder = folder("clipped");
    let common = ["--size", "64", "--adapter", "cpu", "--count", "50"];
    let said = |extra: &[&str]| {
        let output = dpsm(&folder, &[&["measure", "cornell"][..], &common, extra].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stderr)
    };
    assert!(!said(&[]).contains("cuts off"));
    assert!(said(&["--near", "0.3"]).contains("near 3.000e-1 cuts off casters at the light: `"));
    assert!(said(&["--far", "0.4"]).contains("far 4.000e-1 cuts off casters beyond it: `"));
    assert!(said(&["--far", "1e5", "--format", "d16"]).contains("give --format d32"));
}

#[test]
fn points_are_counted_by_one_option_everywhere() {
    let folder = folder("counts");
    for command in [
        &["measure", "cornell", "--count", "0"][..],
        &["report", "cornell", "--count", "0"],
        &["eval", "--exhaustive", "--count", "0"],
    ] {
        let output = dpsm(&folder, command);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains("--count"), "{}", text(&output.stderr));
    }
}

#[test]
fn unwritable_outputs_are_refused_and_nothing_is_half_written() {
    let render = |output| ["render", "cornell", "--adapter", "cpu", "--size", "64", "-o", output];
    let missing = ["missing/out.png", "there is no folder `missing`; make it", "-o"];
    refused("no-folder", &render("missing/out.png"), &missing);
    let bake = ["bake", "cornell", "--size", "64", "-o", "missing/maps.exr"];
    refused("no-folder-bake", &bake, &["there is no folder `missing`"]);
    let folder = folder("is-folder");
    std::fs::create_dir(folder.join("out.png")).unwrap();
    let output = dpsm(&folder, &render("out.png"));
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(files(&folder), ["out.png"]);
}

#[cfg(unix)]
#[test]
fn links_keep_linking_and_pipes_are_refused() {
    let folder = folder("special");
    std::fs::write(folder.join("real.wgsl"), "old").unwrap();
    std::os::unix::fs::symlink("real.wgsl", folder.join("link.wgsl")).unwrap();
    assert!(dpsm(&folder, &["link", "depth", "-o", "link.wgsl"]).status.success());
    assert!(folder.join("link.wgsl").is_symlink());
    let written = std::fs::read_to_string(folder.join("real.wgsl")).unwrap();
    assert_eq!(written, dpsm::link(&["depth"]).unwrap().text);
    assert!(Command::new("mkfifo").arg(folder.join("pipe")).status().unwrap().success());
    let output = dpsm(&folder, &["link", "depth", "-o", "pipe"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("no regular file"), "{}", text(&output.stderr));
    assert_eq!(files(&folder), ["link.wgsl", "pipe", "real.wgsl"]);
}

#[test]
fn back_end_that_is_not_there_is_named() {
    let folder = folder("back-end");
    let mut command = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    command.current_dir(&folder).env("WGPU_BACKEND", "nonsense");
    let output = command.args(["--adapter", "gpu", "eval", "dpsm_depth"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("WGPU_BACKEND=nonsense"), "{}", text(&output.stderr));
}

#[test]
fn modules_are_listed_with_their_imports() {
    let output = dpsm(&folder("modules"), &["modules"]);
    insta::assert_snapshot!("modules", text(&output.stdout));
}

#[test]
fn link_prints_or_writes_the_linked_text() {
    let folder = folder("link");
    let output = dpsm(&folder, &["link", "visibility"]);
    assert!(output.status.success());
    assert_eq!(text(&output.stdout), dpsm::link(&["visibility"]).unwrap().text);
    let output = dpsm(&folder, &["link", "shade", "depth::dpsm_depth", "-o", "out.wgsl"]);
    assert!(output.status.success() && output.stdout.is_empty());
    let written = std::fs::read_to_string(folder.join("out.wgsl")).unwrap();
    assert_eq!(written, dpsm::link(&["shade", "depth::dpsm_depth"]).unwrap().text);
    refused("link-unknown", &["link", "visbility"], &["visbility", "`visibility`"]);
    refused("link-missing", &["link", "missing.wesl"], &["missing.wesl"]);
}

#[test]
fn validate_names_the_users_own_line() {
    let folder = folder("validate");
    let good = "import dpsm::depth::{dpsm_depth};\n\nfn f(l: f32) -> f32 { return dpsm_depth(l, 0.1, 1.0); }\n";
    let bad = good.replace("0.1, 1.0", "0.1");
    std::fs::write(folder.join("good.wesl"), good).unwrap();
    std::fs::write(folder.join("bad.wesl"), bad).unwrap();
    let output = dpsm(&folder, &["validate", "good.wesl"]);
    assert!(output.status.success());
    assert!(text(&output.stdout).starts_with("good.wesl: valid"), "{}", text(&output.stdout));
    let output = dpsm(&folder, &["validate", "bad.wesl"]);
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr.contains("bad.wesl:3:"), "{stderr}");
    assert!(stderr.contains("return dpsm_depth(l, 0.1);"), "{stderr}");
}

#[test]
fn eval_compares_adapter_port_and_reference() {
    let folder = folder("eval");
    std::fs::write(folder.join("points.csv"), "x,y,z\n3,4,0\n0,0,-1\n").unwrap();
    let output =
        dpsm(&folder, &["eval", "dpsm_project", "--adapter", "cpu", "--input", "points.csv"]);
    let stdout = text(&output.stdout);
    let lines: Vec<_> = stdout.lines().collect();
    assert_eq!(
        lines[0],
        "record,component,adapter,port_f32,reference_f64,floats_adapter_port,\
         ulp_port_reference,share_of_bound"
    );
    // 0.6 is off by 0.4 ULP of 2^-24, eps of 1, and 9.5 eps of 0.6 are allowed
    assert_eq!(lines[1], "1,x,,0.6,0.6,,0.400,0.035");
    assert_eq!(lines[3], "2,x,,33554432,33554432,,0.000,0.000");
    assert_eq!(lines.len(), 5);
    let output = dpsm(&folder, &["eval", "dpsm_lookup", "--adapter", "cpu"]);
    assert!(text(&output.stdout).contains("back pole"), "hard cases are the default input");
}

#[test]
fn eval_searches_a_function_or_all_and_says_how_close_the_bound_is() {
    let folder = folder("eval-search");
    let search = |extra: &[&str]| {
        let arguments = [&["eval", "--exhaustive", "--count", "500"], extra].concat();
        let output = dpsm(&folder, &arguments);
        text(&output.stdout).lines().map(String::from).collect::<Vec<_>>()
    };
    let lines = search(&["dpsm_project"]);
    assert!(lines[0].starts_with("function,points,unit,error_eps,bound_eps,share,"));
    assert_eq!(lines.len(), 2);
    let fields: Vec<_> = lines[1].split(',').collect();
    let number = |k: usize| fields[k].parse::<f64>().unwrap();
    assert_eq!((fields[0], fields[2]), ("dpsm_project", "relative"));
    assert!(number(1) >= 500.0 && number(3) > 0.0 && number(5) <= 1.0);
    assert_eq!(fields[12].split(' ').count(), 3, "the worst input's bits");
    assert_eq!(search(&[]).len(), 1 + dpsm::scalar::ports::PORTS.len());
    refused("eval-search-name", &["eval", "dpsm_projct", "--exhaustive"], &["`dpsm_project`"]);
    refused("eval-no-name", &["eval"], &["FUNCTION"]);
    refused("eval-no-points", &["eval", "--exhaustive", "--count", "0"], &["--count"]);
}

#[test]
fn eval_names_the_line_and_column_of_a_bad_record() {
    let folder = folder("eval-bad");
    let path = |name: &str, text: &str| {
        std::fs::write(folder.join(name), text).unwrap();
        folder.join(name).display().to_string()
    };
    let eval = |path| ["eval", "dpsm_project", "--adapter", "cpu", "--input", path];
    let number = path("number.csv", "p.x,p.y,p.z\n1,2,3\n1,two,3\n");
    refused("eval-number", &eval(&number), &["number.csv:3", "`p.y`", "`two`"]);
    let column = path("column.csv", "p.x,p.y\n1,2\n");
    refused("eval-column", &eval(&column), &["column.csv:1", "`p.z`", "p.x,p.y,p.z"]);
    let short = path("short.csv", "p.x,p.y,p.z\n1,2\n");
    refused("eval-short", &eval(&short), &["short.csv:2", "`p.z`"]);
    refused("eval-name", &["eval", "dpsm_projct"], &["dpsm_projct", "`dpsm_project`"]);
    refused("eval-texture", &["eval", "dpsm_visibility"], &["dpsm_visibility", "texture"]);
}

#[test]
fn bake_writes_distances_and_the_lights_parameters() {
    use exr::prelude::*;
    let folder = folder("bake");
    let arguments =
        ["bake", "brabec-room", "--adapter", "cpu", "--size", "64", "-o", "maps.exr", "--json"];
    let output = dpsm(&folder, &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(files(&folder), ["maps.exr", "maps.json"]);
    let read = |name| std::fs::read(folder.join(name)).unwrap();
    let light: serde_json::Value = serde_json::from_slice(&read("maps.json")).unwrap();
    let stdout: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(stdout["light"], light);
    assert_eq!(light["position"], serde_json::json!([0.0, 2.0, 0.0]));
    let image = read_all_flat_layers_from_file(folder.join("maps.exr")).unwrap();
    let names: Vec<_> =
        image.layer_data.iter().map(|layer| layer.attributes.layer_name.clone().unwrap()).collect();
    assert_eq!(names, [Text::from("front"), Text::from("back")]);
    for layer in &image.layer_data {
        assert_eq!(layer.size, Vec2(64, 64));
        assert_eq!(layer.channel_data.list[0].name, Text::from("distance"));
        let distances: Vec<f32> = layer.channel_data.list[0].sample_data.values_as_f32().collect();
        // corners are outside the disk; the middle sees floor or ceiling, 2 away, by a vertex
        assert_eq!(distances[0], f32::INFINITY);
        let middle = distances[32 * 64 + 32];
        assert!((1.9..2.1).contains(&middle), "{middle}");
    }
}

#[test]
fn probe_judges_each_line_in_order() {
    let folder = folder("probe");
    // on the floor in the light; under the box; beyond far; at the light itself
    let points = "x,y,z,nx,ny,nz\n0.1,0,0.2,0,1,0\n0.7,0,-1.3,0,1,0\n50,0,0,0,1,0\n0,2,0,0,1,0\n";
    std::fs::write(folder.join("points.csv"), points).unwrap();
    let probe = ["probe", "brabec-room", "--adapter", "cpu", "--points", "points.csv"];
    let output = dpsm(&folder, &probe);
    let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{stderr}");
    assert!(stderr.contains("2 points lie inside near"), "{stderr}");
    let rows: Vec<Vec<&str>> = stdout.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 5);
    assert_eq!(rows[0], ["visibility", "hemisphere", "u", "v", "stored", "own", "truth", "edge"]);
    let column = |row: usize, name: &str| -> f64 {
        let index = rows[0].iter().position(|n| *n == name).unwrap();
        rows[row][index].parse().unwrap()
    };
    assert_eq!((column(1, "visibility"), column(1, "truth"), column(1, "edge")), (1.0, 1.0, 0.0));
    assert_eq!((column(2, "visibility"), column(2, "truth")), (0.0, 0.0));
    let own = |x: f64, y: f64, z: f64| (x * x + (y - 2.0) * (y - 2.0) + z * z).sqrt();
    // coordinates pass through f64, the light's position and rotation through f32
    for (row, [x, y, z]) in [[0.1, 0.0, 0.2], [0.7, 0.0, -1.3], [50.0, 0.0, 0.0]].iter().enumerate()
    {
        let exact = own(*x, *y, *z);
        assert!((column(row + 1, "own") - exact).abs() <= 1e-6 * exact, "{row}");
    }
    assert_eq!(column(4, "visibility"), 1.0, "nothing lies between the light and itself");
    let json = dpsm(&folder, &[&probe[..], &["--json", "-o", "judged.json"]].concat());
    assert!(json.status.success(), "{}", text(&json.stderr));
    let judged = std::fs::read(folder.join("judged.json")).unwrap();
    let judged: Vec<serde_json::Value> = serde_json::from_slice(&judged).unwrap();
    assert_eq!(judged.len(), 4);
    assert_eq!(judged[1]["truth"], 0);
}

#[test]
fn probe_names_the_line_and_column_of_a_bad_point() {
    let folder = folder("probe-bad");
    let path = |name: &str, text: &str| {
        std::fs::write(folder.join(name), text).unwrap();
        folder.join(name).display().to_string()
    };
    let probe = |path| ["probe", "cornell", "--adapter", "cpu", "--points", path];
    let number = path("number.csv", "x,y,z\n1,2,3\n1,2,east\n");
    refused("probe-number", &probe(&number), &["number.csv:3", "`z`", "`east`"]);
    let infinite = path("infinite.csv", "x,y,z\n1e999,2,3\n");
    refused("probe-infinite", &probe(&infinite), &["infinite.csv:2", "`x`", "finite"]);
    let header = path("header.csv", "a,b,c\n1,2,3\n");
    refused("probe-header", &probe(&header), &["header.csv:1", "a,b,c", "x,y,z"]);
    let short = path("short.csv", "x,y,z\n1,2\n");
    refused("probe-short", &probe(&short), &["short.csv:2", "`z`"]);
    let normal = path("normal.csv", "x,y,z,nx,ny,nz\n1,2,3,0,0,0\n");
    refused("probe-normal", &probe(&normal), &["normal.csv:2", "nx,ny,nz"]);
    let lines = path("crlf.csv", "\u{feff}x,y,z\r\n1,0,1\r\nx,1,1\r\n");
    refused("probe-crlf", &probe(&lines), &["crlf.csv:3", "`x`"]);
    let long = path("long.csv", "x,y,z\n1,2,3,4\n");
    refused("probe-long", &probe(&long), &["long.csv:2", "`4`", "`z`"]);
    std::fs::write(folder.join("latin.csv"), b"x,y,z\n1,2,3\n1,\xe9,3\n").unwrap();
    let latin = folder.join("latin.csv").display().to_string();
    refused("probe-latin", &probe(&latin), &["latin.csv:3", "UTF-8"]);
    let count = ["measure", "cornell", "--count", "99999999999"];
    refused("measure-count", &count, &["--count"]);
    for tau in ["-0.1", "0", "0.01", "5", "nan", "wide"] {
        refused("measure-tau", &["measure", "cornell", "--tau", tau], &["--tau", tau]);
    }
    refused("bake-name", &["bake", "cornell", "-o", "maps.png"], &["maps.png", "EXR"]);
    // said before the scene is read
    refused("bake-first", &["bake", "nowhere.obj", "-o", "maps.png"], &["maps.png", "EXR"]);
    refused("probe-missing", &probe("nowhere.csv"), &["nowhere.csv"]);
}

#[test]
fn measure_reports_the_same_in_a_table_and_in_json() {
    let folder = folder("measure");
    let measure = [
        "measure",
        "brabec-room",
        "--walls",
        "1",
        "--size",
        "128",
        "--count",
        "500",
        "--seed",
        "5",
        "--method",
        "vertex",
        "--adapter",
        "cpu",
    ];
    let output = dpsm(&folder, &measure);
    let table = text(&output.stdout);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let output = dpsm(&folder, &[&measure[..], &["--json"]].concat());
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let all = &json["map"]["all"];
    assert!(all["off_1e2"].as_u64() > all["covered"].as_u64().map(|covered| covered / 2));
    assert_eq!(json["map"]["tau"], 0.0, "vertex maps have no tolerance");
    assert_eq!(json["meshes_as"], "vertex");
    let faults = [&all["faults_off"], &all["holes"], &all["excused"], &json["map"]["worst"]["x"]];
    for count in
        [&all["texels"], &all["missing"], &json["shadow"]["edge_points"]].into_iter().chain(faults)
    {
        assert!(table.contains(&count.to_string()), "{count} is not in\n{table}");
    }
    let sources: Vec<_> = json["sources"].as_array().unwrap().iter().collect();
    let names = sources.iter().map(|source| source["name"].as_str().unwrap());
    let expected = [
        "f32 arithmetic",
        "storage format",
        "resolution",
        "bowed edges",
        "affine depth",
        "bias",
        "filter",
    ];
    assert_eq!(names.collect::<Vec<_>>(), expected);
    for name in expected {
        assert!(table.contains(name), "{name} is not in\n{table}");
    }
}

#[test]
fn tau_is_the_methods_and_refined_maps_are_judged_by_it() {
    let folder = folder("measure-refined");
    let measure = |extra: &[&str]| {
        let common = ["measure", "brabec-room", "--walls", "1", "--adapter", "cpu"];
        let small = ["--size", "64", "--count", "50"];
        let output = dpsm(&folder, &[&common[..], &small, extra].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    for (extra, tau) in
        [(&[][..], 0.25_f32), (&["--tau", "0.5"], 0.5), (&["--method", "exact"], 0.0)]
    {
        let json: serde_json::Value =
            serde_json::from_str(&measure(&[extra, &["--json"]].concat())).unwrap();
        assert_eq!(json["map"]["tau"], f64::from(tau), "{extra:?}");
        let names = json["sources"].as_array().unwrap().iter().map(|source| &source["name"]);
        let expected = ["f32 arithmetic", "storage format", "resolution", "bias", "filter"];
        assert_eq!(names.collect::<Vec<_>>(), expected);
        assert_eq!(json["meshes_as"], "vertex");
    }
    assert!(measure(&[]).contains("what the vertex method would do to these meshes"));
}

#[test]
fn cube_renders_bakes_probes_and_measures_its_six_faces() {
    let folder = folder("cube");
    let cube = ["brabec-room", "--adapter", "cpu", "--method", "cube", "--size", "64"];
    let run = |command: &str, extra: &[&str]| {
        let output = dpsm(&folder, &[&[command], &cube[..], extra].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let faces = ["+x", "-x", "+y", "-y", "+z", "-z"];
    let stdout = run("render", &["--image", "32x24", "--maps", "-o", "room.png"]);
    let mut expected = vec!["room.png".to_string()];
    for kind in ["map", "view"] {
        for face in faces {
            let timed = if kind == "map" { "maps".into() } else { format!("{face} {kind}") };
            assert!(stdout.contains(&timed), "{timed}:\n{stdout}");
            let name = format!("room-{face}-{kind}.png");
            // half of --size: a face's texels are then as fine as a map's
            let picture = image::open(folder.join(&name)).unwrap();
            assert_eq!((picture.width(), picture.height()), (32, 32), "{name}");
            expected.push(name);
        }
    }
    expected.sort();
    assert_eq!(files(&folder), expected);

    run("bake", &["-o", "faces.exr"]);
    let image = exr::prelude::read_all_flat_layers_from_file(folder.join("faces.exr")).unwrap();
    let names: Vec<_> = image
        .layer_data
        .iter()
        .map(|layer| layer.attributes.layer_name.clone().unwrap().to_string())
        .collect();
    assert_eq!(names, faces);
    // +z looks down at the floor, 2 below; beside the middle it is farther by less than a texel
    let floor: Vec<f32> =
        image.layer_data[4].channel_data.list[0].sample_data.values_as_f32().collect();
    let texel = 2.0 / 30.0_f32;
    assert!((2.0..=2.0 * (1.0 + texel * texel)).contains(&floor[16 * 32 + 16]));

    std::fs::write(folder.join("points.csv"), "x,y,z,nx,ny,nz\n0.1,0,0.2,0,1,0\n").unwrap();
    let probed = run("probe", &["--points", "points.csv"]);
    let row: Vec<f64> =
        probed.lines().nth(1).unwrap().split(',').map(|field| field.parse().unwrap()).collect();
    assert_eq!((row[0], row[1], row[6]), (1.0, 4.0, 1.0), "lit, on +z, lit in truth");
    let place = [row[2].abs().max(row[3].abs()), row[2].abs().min(row[3].abs())];
    assert!((place[0] - 0.1).abs() <= 1e-6 && (place[1] - 0.05).abs() <= 1e-6, "{probed}");

    let json: serde_json::Value =
        serde_json::from_str(&run("measure", &["--count", "200", "--json"])).unwrap();
    let all = &json["map"]["all"];
    assert_eq!((&all["texels"], &all["faults_off"]), (&(6 * 30 * 30).into(), &0.into()));
    assert_eq!(json["meshes"], serde_json::json!([]));
}

#[test]
fn csv_files_take_time_as_their_length_not_its_square() {
    let folder = folder("long");
    let path = folder.join("long.csv");
    std::fs::write(&path, "x,y,z\n".to_string() + &"0,0,0\n".repeat(200_000) + "0,0,x\n").unwrap();
    let begun = std::time::Instant::now();
    let points = ["probe", "cornell", "--points", path.to_str().unwrap()];
    refused("long-csv", &points, &["long.csv:200002", "column `z`: `x`"]);
    // a tenth of a second; to count all lines before each again takes minutes
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
}

#[test]
fn printed_light_camera_and_exposure_make_the_same_picture_again() {
    let folder = folder("printed");
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4\nf 2 3 7 6\n";
    std::fs::write(folder.join("cube.obj"), cube).unwrap();
    let render = |output: &'static str, more: &[&str]| {
        let given = ["render", "cube.obj", "--adapter", "cpu", "--image", "48x36", "-o", output];
        let output = dpsm(&folder, &[&given[..], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let stdout = render("first.png", &[]);
    let printed = stdout.lines().find(|line| line.contains("--light=")).unwrap();
    let again = render("again.png", &printed.split_whitespace().collect::<Vec<_>>());
    assert!(again.contains(printed), "{again}");
    let [first, again] =
        ["first.png", "again.png"].map(|name| image::open(folder.join(name)).unwrap().into_rgba8());
    // the target is printed with six decimals
    let apart = first.iter().zip(again.iter()).filter(|(a, b)| a.abs_diff(**b) > 1).count();
    assert!(apart <= first.len() / 1000, "{apart}");
    let background = first.get_pixel(0, 0);
    let object = first.pixels().filter(|pixel| *pixel != background).count();
    assert!(object > 48 * 36 / 4, "{object} pixels of the object");
}
