//! `dpsm report`: what it measures, and that an interrupted run is readable and taken up again.

#![cfg(feature = "cli")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use dpsm::report::data::{Report, Role, Times, Variant};
use dpsm::report::{NAGA, WGPU};

/// Little work, of every kind.
const QUICK: [&str; 8] = ["--size", "64", "--image", "48x36", "--count", "300", "--runs", "2"];

/// An empty folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn dpsm(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dpsm"));
    command.current_dir(folder).args(arguments);
    command
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    dpsm(folder, arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A report of some scenes, which must succeed.
fn reported(folder: &Path, scenes: &[&str], more: &[&str]) -> (Report, String) {
    let gpu = more.contains(&"gpu");
    let adapter: &[&str] = if gpu { &[] } else { &["--adapter", "cpu"] };
    let output = run(folder, &[&["report"], scenes, &QUICK, adapter, more].concat());
    let stderr = text(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    (read(&folder.join("dpsm-report")), stderr)
}

/// report.json, which must be whole and come back as it was; so must the others be.
fn read(folder: &Path) -> Report {
    let json = std::fs::read_to_string(folder.join("report.json")).unwrap();
    let report: Report = serde_json::from_str(&json).unwrap();
    assert_eq!(serde_json::to_string_pretty(&report).unwrap() + "\n", json);
    let html = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(
        html.to_lowercase().starts_with("<!doctype html>") && html.trim_end().ends_with("</html>")
    );
    let table = std::fs::read_to_string(folder.join("report.csv")).unwrap();
    for scene in &report.scenes {
        assert!(html.contains(&scene.name), "{}", scene.name);
        assert!(table.contains(&scene.name), "{}", scene.name);
    }
    for name in &report.unfinished {
        assert!(html.contains(name), "{name} is unfinished, and the page does not say so");
    }
    report
}

fn part(folder: &Path, name: &str) -> PathBuf {
    folder.join("dpsm-report/parts").join(format!("{name}.json"))
}

fn check_times(times: &Times, runs: u32, what: &str) {
    let Times { least, low, median, high, .. } = *times;
    assert_eq!(times.runs, runs, "{what}");
    assert!(least > 0.0 && high.is_finite(), "{what}: {times:?}");
    assert!(least <= low && low <= median && median <= high, "{what}: {times:?}");
}

fn costs(v: &Variant) -> [f64; 4] {
    [v.generation.median, v.lookup.median, v.bytes as f64, v.error.misclassified()]
}

/// No worse anywhere, and better somewhere.
fn beats(a: &Variant, b: &Variant) -> bool {
    let pairs = || costs(a).into_iter().zip(costs(b));
    pairs().all(|(a, b)| a <= b) && pairs().any(|(a, b)| a < b)
}

/// What holds of every report of a scene.
fn check(report: &Report, runs: u32) {
    for scene in &report.scenes {
        assert!(scene.points > 30, "{}", scene.name);
        let find = |name: &str| {
            let found = scene.variants.iter().find(|variant| variant.name == name);
            found.unwrap_or_else(|| panic!("{}: no variant {name}", scene.name))
        };
        for variant in &scene.variants {
            let name = format!("{}, {}", scene.name, variant.name);
            let alike = scene.variants.iter().filter(|other| other.name == variant.name);
            assert_eq!(alike.count(), 1, "{name}");
            check_times(&variant.generation, runs, &name);
            check_times(&variant.lookup, runs, &name);
            let maps = match (variant.method.as_str(), scene.hemispherical) {
                ("cube", _) => 6,
                (_, true) => 1,
                (_, false) => 2,
            };
            let planned = variant.name.starts_with("plan: ");
            // a plan may do with one map
            let maps = if planned && variant.maps == 1 { 1 } else { maps };
            let role = match planned {
                true => Role::Plan,
                false if maps == 6 => Role::Cube,
                false => Role::Other,
            };
            assert_eq!((variant.maps, variant.passes, variant.role), (maps, maps, role), "{name}");
            let texels = u64::from(maps) * u64::from(variant.size).pow(2);
            let depth = if variant.format == "d16" { 2 } else { 4 };
            assert_eq!((variant.texels, variant.bytes), (texels, depth * texels), "{name}");
            let cut = variant.method == "tessellated";
            // a plan may leave meshes out
            let all = scene.triangles as u64;
            assert!(planned || variant.triangles >= all, "{name}");
            assert!(
                cut || variant.triangles == all || planned && variant.triangles < all,
                "{name}"
            );
            let e = variant.error;
            assert!(e.faults <= e.misclassified() && e.misclassified() <= 1.0, "{name}: {e:?}");
            for value in [e.rmse, e.acne, e.acne_mean, e.leak, e.leak_mean] {
                assert!((0.0..=1.0).contains(&value), "{name}: {e:?}");
            }
            let judged = e.smoothly_lit + e.deep_in_shadow;
            assert!(judged <= scene.points, "{name}: {e:?}");
            for value in [e.contact_gap, e.edge_texels_median, e.edge_degrees_largest] {
                assert!(value.is_finite() && value >= 0.0, "{name}: {e:?}");
            }
            assert!(e.edge_texels_median <= e.edge_texels_largest, "{name}: {e:?}");
            // straight edges between 2 triangles' corners may be wrong anywhere
            let right = ["exact", "refined", "cube"].contains(&variant.method.as_str());
            assert!(!right || e.faults < 0.01 && e.misclassified() < 0.5, "{name}: {e:?}");
            match variant.dominated_by.as_str() {
                "" => {
                    let better = scene.variants.iter().find(|other| beats(other, variant));
                    assert!(better.is_none(), "{name} is beaten by {:?}", better.map(|v| &v.name));
                }
                other => assert!(beats(find(other), variant), "{name} is not beaten by {other}"),
            }
        }
        let plans = scene.variants.iter().filter(|variant| variant.role == Role::Plan);
        assert!(plans.count() == 1 && scene.plan.len() == 9, "{}: {:?}", scene.name, scene.plan);
        let methods = ["vertex", "fragment-depth", "tessellated", "exact", "refined", "cube"];
        for method in methods {
            assert!(scene.variants.iter().any(|variant| variant.method == method), "{method}");
        }
        for filter in ["single", "hard", "hardware", "pcf 4 x 4", "disk 16"] {
            assert!(scene.variants.iter().any(|variant| variant.filter == filter), "{filter}");
        }
        // at equal memory a cube has as many texels, to the rounding of its faces
        let equal =
            |v: &&Variant| v.method == "refined" && v.format == "d32" && v.filter == "single";
        for refined in scene.variants.iter().filter(equal).rev().take(1) {
            let as_large = |v: &&Variant| {
                let ratio = v.texels as f64 / refined.texels as f64;
                v.role == Role::Cube && (ratio - 1.0).abs() < 0.1
            };
            let half = scene.variants.iter().filter(as_large).count();
            let middle = scene.variants.iter().any(|v| {
                let ratio = 4.0 * v.texels as f64 / refined.texels as f64;
                v.role == Role::Cube && (ratio - 1.0).abs() < 0.1
            });
            assert!(half == 1 || middle, "{}: no cube as large", scene.name);
            // and at equal worst texel faces half as wide
            let half = |v: &Variant| v.role == Role::Cube && 2 * v.size == refined.size;
            assert!(scene.variants.iter().any(half), "{}: no cube as fine", scene.name);
        }
        for source in &scene.sources {
            find(&source.variant);
            assert!(source.measured.is_finite(), "{source:?}");
            assert!(source.predicted.is_none_or(f64::is_finite), "{source:?}");
        }
        let of = |name: &str| scene.sources.iter().filter(|s| s.name == name).count();
        assert_eq!((of("resolution"), of("bowed edges")), (2, 1), "{}", scene.name);
    }
    assert!(report.costs.len() >= 2);
    for curves in &report.costs {
        for curve in &curves.curves {
            assert!(curve.points.len() >= 3, "{}: {}", curves.title, curve.name);
            for (at, times) in &curve.points {
                let what = format!("{}: {} at {at}", curves.title, curve.name);
                check_times(times, runs.min(3), &what);
            }
        }
    }
    assert!(report.unfinished.is_empty(), "{:?}", report.unfinished);
}

#[test]
fn ports_report_on_scenes_with_one_hemisphere_and_with_two() {
    let folder = folder("ports");
    let (report, _) = reported(&folder, &["brabec-ceiling", "brabec-room"], &["--walls", "1"]);
    check(&report, 2);
    assert_eq!(report.machine.adapter, "");
    assert!(report.machine.software && report.timing.empty_pass.is_none());
    let [ceiling, room] = report.scenes.as_slice() else { panic!("{:?}", report.scenes.len()) };
    assert!(ceiling.hemispherical && !room.hemispherical);
    // walls of two triangles: the original method cannot, the default can
    let error = |name: &str| room.variants.iter().find(|v| v.name == name).unwrap().error;
    assert_eq!(error("refined 64").faults, 0.0);
    let [original, ours] = ["fragment-depth 32", "refined 64"].map(error);
    println!("{original:?} {ours:?}");
    assert!(original.acne > 0.05 && ours.acne == 0.0, "{original:?} {ours:?}");
    let html = std::fs::read_to_string(folder.join("dpsm-report/report.html")).unwrap();
    // of a hemisphere its map and its view; lit twice, and the errors of three methods
    assert_eq!(html.matches("data:image/png;base64,").count(), (2 + 2 + 3) + (2 + 4 + 3));
}

#[test]
fn adapter_reports_on_a_file_with_its_empty_pass_and_all_costs() {
    if dpsm::gpu::Device::open().is_err() {
        return println!("skipped: no adapter");
    }
    let folder = folder("adapter");
    let quad = "o floor\nv -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nf 3 2 1\nf 4 3 1\n\
                o board\nv -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\nf 7 6 5\nf 8 7 5\n";
    std::fs::write(folder.join("costs.obj"), quad).unwrap();
    let (report, _) = reported(&folder, &["costs.obj"], &["--adapter", "gpu"]);
    check(&report, 2);
    // `costs` is the name of another part
    assert_eq!(report.scenes[0].name, "costs-2");
    assert!(!report.machine.adapter.is_empty() && report.machine.versions["wgpu"] == WGPU);
    check_times(&report.timing.empty_pass.unwrap(), 2, "the empty pass");
    assert_eq!(report.costs.len(), 4);
    let disk = &report.costs[3].curves[1];
    assert!(disk.points.iter().map(|point| point.0).eq([1.0, 4.0, 16.0, 64.0]), "{disk:?}");
    disk.points.iter().for_each(|(_, times)| check_times(times, 2, "the disk"));
}

#[test]
fn killed_run_leaves_a_readable_report_and_is_taken_up() {
    let folder = folder("killed");
    let scenes = ["cornell", "seam-box", "gaps"];
    let arguments = [&["report", "--adapter", "cpu"], scenes.as_slice(), &QUICK].concat();
    let mut child =
        dpsm(&folder, &arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let first = part(&folder, "cornell");
    let start = Instant::now();
    let out = folder.join("dpsm-report");
    let finished = || {
        // the part is moved into place before the report on it
        first.exists()
            && std::fs::read_to_string(out.join("report.csv"))
                .is_ok_and(|table| table.contains("cornell"))
    };
    while !finished() {
        assert!(start.elapsed() < Duration::from_secs(300) && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let report = read(&out);
    let left = &report.unfinished;
    assert_eq!(report.scenes[0].name, "cornell");
    assert!(left.ends_with(&["gaps".to_string(), "costs".to_string()]), "{left:?}");
    let bytes = std::fs::read(&first).unwrap();
    let made = std::fs::metadata(&first).unwrap().modified().unwrap();
    // a part that was cut off is made again, and said so
    std::fs::write(part(&folder, "gaps"), "{ \"fingerprint\": \"dpsm").unwrap();
    let (report, stderr) = reported(&folder, &scenes, &[]);
    assert!(stderr.contains("gaps.json is no part of a report"), "{stderr}");
    check(&report, 2);
    assert_eq!(report.scenes.iter().map(|s| &*s.name).collect::<Vec<_>>(), scenes);
    assert_eq!(std::fs::read(&first).unwrap(), bytes);
    assert_eq!(std::fs::metadata(&first).unwrap().modified().unwrap(), made);

    // all is there: nothing is measured, and the figures are the same
    let (again, _) = reported(&folder, &scenes, &[]);
    assert_eq!(again, report);
    // other options, another light: nothing is taken
    let (other, stderr) = reported(&folder, &["cornell"], &["--seed", "2"]);
    assert!(stderr.contains("cornell.json is of another"), "{stderr}");
    assert_eq!(other.scenes[0].seed, 2);
    let moved = ["--seed", "2", "--light", "0.3,0.4,0.3"];
    let (moved, stderr) = reported(&folder, &["cornell"], &moved);
    assert!(stderr.contains("cornell.json is of another"), "{stderr}");
    assert_eq!(moved.scenes[0].light, [0.3, 0.4, 0.3]);
    let before = std::fs::metadata(&first).unwrap().modified().unwrap();
    let fresh = ["--seed", "2", "--light", "0.3,0.4,0.3", "--fresh"];
    reported(&folder, &["cornell"], &fresh);
    assert!(std::fs::metadata(&first).unwrap().modified().unwrap() > before);
}

#[test]
fn bad_input_is_refused_before_anything_is_written() {
    let folder = folder("bad");
    std::fs::write(folder.join("file"), "").unwrap();
    std::fs::write(folder.join("foreign.json"), "{\"scenes\": 3}").unwrap();
    let before = std::fs::read_dir(&folder).unwrap().count();
    let cases: [(&[&str], &[&str]); 9] = [
        (&["brabec-rom"], &["no scene is called `brabec-rom`", "did you mean"]),
        (&["nowhere.obj"], &["nowhere.obj", "check the path"]),
        (&["cornell", "cornell"], &["cornell is named twice", "once"]),
        (&["cornell", "-o", "file"], &["cannot write file", "--folder"]),
        (&["cornell", "--size", "32"], &["--size", "64"]),
        (&["cornell", "--image", "0x4"], &["image width 0", "1 to"]),
        (&["cornell", "--light", "nan,0,0"], &["float range"]),
        (&["--compare", "missing.json", "foreign.json"], &["missing.json", "check the path"]),
        (
            &["--compare", "foreign.json", "foreign.json"],
            &["foreign.json: report A cannot be read", "that `dpsm report` wrote"],
        ),
    ];
    for (arguments, parts) in cases {
        let output = run(&folder, &[&["report"], arguments].concat());
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        for part in parts {
            assert!(stderr.contains(part), "{arguments:?}: no `{part}` in\n{stderr}");
        }
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), before, "{arguments:?}");
    }
}

#[test]
fn two_reports_are_compared() {
    let folder = folder("compared");
    reported(&folder, &["cornell"], &[]);
    let name = "dpsm-report/report.json";
    let output = run(&folder, &["report", "--compare", name, name]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(!output.stdout.is_empty());
}

#[test]
fn versions_are_those_of_the_lock_file() {
    let lock = include_str!("../Cargo.lock");
    for (name, version) in [("wgpu", WGPU), ("naga", NAGA)] {
        let entry = format!("name = \"{name}\"\nversion = \"{version}\"\n");
        assert!(lock.contains(&entry), "{name} is not {version}");
    }
}
