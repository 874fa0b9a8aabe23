//! A report as CSV, its Pareto fronts, and what changed between two; docs/report.md.

#![cfg(feature = "cli")]

#[path = "report/fixture.rs"]
mod fixture;

use dpsm::report::compare::{CompareError, compare, read};
use dpsm::report::data::{Report, Times, VERSION, Variant};
use dpsm::report::pareto;
use dpsm::report::table::csv;
use fixture::{HARD_NAME, images, report, times};
use serde_json::Value;

fn records(report: &Report) -> Vec<Vec<String>> {
    let table = csv(report).unwrap();
    let mut reader = ::csv::Reader::from_reader(table.as_slice());
    assert_eq!(reader.headers().unwrap().len(), 7);
    reader.records().map(|record| record.unwrap().iter().map(String::from).collect()).collect()
}

/// Every number of a JSON value.
fn numbers(value: &Value, out: &mut Vec<String>) {
    match value {
        Value::Number(number) => out.push(number.to_string()),
        Value::Array(all) => all.iter().for_each(|value| numbers(value, out)),
        Value::Object(all) => all.values().for_each(|value| numbers(value, out)),
        _ => (),
    }
}

#[test]
fn table_holds_every_number_of_the_json() {
    let report = report();
    let mut wanted = Vec::new();
    let json = serde_json::to_string(&report).unwrap();
    numbers(&serde_json::from_str(&json).unwrap(), &mut wanted);
    let mut found: Vec<String> = Vec::new();
    for record in records(&report) {
        if record[5].parse::<f64>().is_ok() && record[4] != "computed_by" {
            found.push(record[5].clone());
        }
    }
    // a curve's place stands once for each of its five figures
    let places = report.costs.iter().flat_map(|plot| &plot.curves).flat_map(|curve| &curve.points);
    found.extend(places.map(|(x, _)| serde_json::to_string(x).unwrap()));
    wanted.sort();
    found.sort();
    assert_eq!(wanted.len(), found.len());
    assert!(wanted == found, "some number of report.json is not in the table");
}

#[test]
fn figures_stand_in_their_line_with_their_unit() {
    let report = report();
    let all = records(&report);
    let line = |place: [&str; 5]| {
        let found: Vec<_> = all.iter().filter(|record| record[..5] == place).collect();
        assert_eq!(found.len(), 1, "{place:?}");
        (found[0][5].as_str(), found[0][6].as_str())
    };
    let name = "refined 1024 hardware";
    let variant = report.scenes[1].variants.iter().find(|v| v.name == name).unwrap();
    let making = variant.generation.median.to_string();
    assert_eq!(
        line(["variant", HARD_NAME, name, "", "generation.median"]),
        (making.as_str(), "ms")
    );
    assert_eq!(line(["variant", HARD_NAME, name, "", "generation.runs"]), ("15", "runs"));
    assert_eq!(line(["variant", HARD_NAME, name, "", "role"]), ("plan", ""));
    assert_eq!(line(["scene", HARD_NAME, "", "", "light.0"]), ("-1.0", "world unit"));
    assert_eq!(line(["report", "", "", "", "machine.software"]), ("true", ""));
    assert_eq!(line(["report", "", "", "", "timing.empty_pass"]), ("", ""));
    let cube = line(["parameterisation", "", "cube", "", "largest"]);
    assert_eq!(cube, ("24.0", "sr"));
    let infinite = line(["parameterisation", "", "longitude-latitude", "", "ratio"]);
    assert_eq!(infinite, ("", ""));
    let plot = &report.costs[0];
    let at = line(["cost", &plot.title, "cube", "10000.0", "triangles.median"]);
    assert_eq!(at, ("21.0", "ms"));
}

#[test]
fn reports_come_back_from_json_as_they_were() {
    let report = report();
    let json = serde_json::to_string(&report).unwrap();
    assert!(report == serde_json::from_str(&json).unwrap());
    assert!(images().iter().all(|image| !image.png.is_empty()));
}

/// Four variants that cost (making, lookup, bytes, misclassified).
fn variants(costs: &[[f64; 4]]) -> Vec<Variant> {
    let variant = |(i, cost): (usize, &[f64; 4])| {
        let mut variant = Variant { name: format!("v{i}"), ..Variant::default() };
        variant.generation.median = cost[0];
        variant.lookup.median = cost[1];
        variant.bytes = cost[2] as u64;
        variant.error.false_light = cost[3];
        variant
    };
    costs.iter().enumerate().map(variant).collect()
}

#[test]
fn variants_are_dominated_by_what_is_nowhere_worse() {
    let mut all = variants(&[
        [1.0, 1.0, 1.0, 0.5],
        [1.0, 1.0, 1.0, 0.5], // a tie: neither
        [2.0, 1.0, 1.0, 0.5], // worse in one
        [2.0, 2.0, 2.0, 0.4],
        [3.0, 2.0, 2.0, 0.6], // beaten by the last and by the first: the more exact is named
        [0.5, 9.0, 9.0, 0.9],
    ]);
    all[0].dominated_by = "an earlier run".to_string();
    pareto::mark(&mut all);
    let by: Vec<&str> = all.iter().map(|variant| variant.dominated_by.as_str()).collect();
    assert_eq!(by, ["", "", "v0", "", "v3", ""]);
    // each of the four counts
    for cost in 0..4 {
        let mut costs = [[1.0; 4], [1.0; 4]];
        costs[1][cost] = 2.0;
        let mut pair = variants(&costs);
        pareto::mark(&mut pair);
        assert_eq!(pair[1].dominated_by, "v0", "{cost}");
    }
}

#[test]
fn front_of_a_plot_goes_from_left_to_right_and_keeps_ties() {
    let points = [(3.0, 1.0), (1.0, 3.0), (2.0, 2.0), (2.0, 2.0), (2.0, 3.0), (0.0, 9.0)];
    assert_eq!(pareto::front(&points), [5, 1, 2, 3, 0]);
    assert_eq!(pareto::front(&[]), [0; 0]);
}

/// Runs around a median, drawn anew.
fn drawn(rng: &mut fastrand::Rng, median: f64) -> Times {
    let mut all: Vec<f64> = (0..15)
        .map(|_| {
            let z: f64 = (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0;
            median * (0.05 * z).exp()
        })
        .collect();
    all.sort_by(f64::total_cmp);
    Times { runs: 15, least: all[0], low: all[3], median: all[7], high: all[11] }
}

/// The report with all its times measured anew.
fn again(rng: &mut fastrand::Rng) -> Report {
    let mut report = report();
    for variant in report.scenes.iter_mut().flat_map(|scene| &mut scene.variants) {
        variant.generation = drawn(rng, 10.0);
        variant.lookup = drawn(rng, 3.0);
    }
    for curve in report.costs.iter_mut().flat_map(|plot| &mut plot.curves) {
        curve.points.iter_mut().for_each(|(_, times)| *times = drawn(rng, 7.0));
    }
    report
}

#[test]
fn runs_of_the_same_speed_show_no_change() {
    let mut rng = fastrand::Rng::with_seed(7);
    let alarms = (0..100)
        .filter(|_| {
            let text = compare(&again(&mut rng), &again(&mut rng)).unwrap();
            assert!(text.contains("times: 250 compared"), "{text}");
            !text.contains("times: 250 compared, 0 changed")
        })
        .count();
    // one in 100 is promised; five or more have a chance of 0.3%
    assert!(alarms <= 4, "{alarms} of 100");
}

#[test]
fn a_slower_variant_is_named_with_its_ratio() {
    let mut rng = fastrand::Rng::with_seed(8);
    let (a, mut b) = (report(), report());
    let variant = b.scenes[0].variants.iter_mut().find(|v| v.name == "refined 512 hard").unwrap();
    let before = variant.generation;
    variant.generation = times(before.median * 1.2, 0.01);
    variant.lookup = times(variant.lookup.median * 1.005, 0.05);
    let text = compare(&a, &b).unwrap();
    assert!(text.contains(", 1 changed\n  brabec-room: refined 512 hard: making, ms"), "{text}");
    assert!(text.contains("times 1.20\n"), "{text}");
    let same = compare(&again(&mut rng), &a).unwrap();
    assert!(!same.contains("times: 250 compared, 0 changed"), "{same}");
}

#[test]
fn errors_of_the_same_points_have_no_noise_and_of_others_have() {
    let (a, mut b) = (report(), report());
    let name = a.scenes[0].variants[3].name.clone();
    b.scenes[0].variants[3].error.false_light += 0.000_05;
    b.scenes[0].variants[3].error.contact_gap *= 1.5;
    let text = compare(&a, &b).unwrap();
    assert!(text.contains(&format!("brabec-room: {name}: false light, share of points")), "{text}");
    assert!(text.contains(&format!("brabec-room: {name}: contact gap")), "{text}");
    assert!(text.contains("figures without noise") && text.contains(", 2 changed"), "{text}");
    // one point of 20,000 more is nothing where the points are others
    b.scenes[0].seed = 2;
    let text = compare(&a, &b).unwrap();
    assert!(text.contains("other points (20000 of seed 1, 20000 of seed 2)"), "{text}");
    assert!(text.contains("shares of other points: 270 compared, 0 changed"), "{text}");
    assert!(!text.contains("contact gap"), "{text}");
    b.scenes[0].variants[3].error.false_light += 0.01;
    let text = compare(&a, &b).unwrap();
    assert!(text.contains("shares of other points: 270 compared, 1 changed"), "{text}");
}

#[test]
fn what_cannot_be_compared_is_named() {
    let (a, mut b) = (report(), report());
    b.scenes[0].variants.pop();
    b.scenes[2].light[0] += 1.0;
    b.scenes.remove(3);
    b.machine.versions.insert("wgpu".to_string(), "30.0.2".to_string());
    b.machine.versions.insert("naga".to_string(), "30".to_string());
    b.timing.empty_pass = Some(times(0.1, 0.1));
    let text = compare(&a, &b).unwrap();
    for line in [
        "brabec-room: variant only in A: cube 512 disk",
        "scene only in A: No Error",
        "no-error: not compared, its triangles or its light differ",
        "version of wgpu: 30.0.1 -> 30.0.2",
        "version of naga: none -> 30",
        "A is unfinished: costs: lights & <taps>",
    ] {
        assert!(text.contains(&format!("{line}\n")), "{line}:\n{text}");
    }
    assert!(text.contains("times: "));
    b.machine.adapter = "another".to_string();
    let text = compare(&a, &b).unwrap();
    assert!(text.contains("times are not compared: the adapter differs, `llvmpipe"), "{text}");
    assert!(!text.contains("times: "), "{text}");
}

#[test]
fn reports_of_another_version_are_refused() {
    let (a, mut b) = (report(), report());
    b.version = VERSION + 1;
    let refused = |error| match error {
        CompareError::Version { name, found } => (name, found),
        CompareError::Json { .. } => panic!("{error}"),
    };
    assert_eq!(refused(compare(&a, &b).unwrap_err()), ("B", VERSION + 1));
    // also where its fields are others
    let other = format!("{{\"version\": {}, \"pictures\": []}}", VERSION + 1);
    let older = read("A", &other).unwrap_err();
    assert_eq!(refused(older), ("A", VERSION + 1));
    assert!(matches!(read("A", "{}"), Err(CompareError::Json { .. })));
    let json = serde_json::to_string(&a).unwrap();
    assert!(read("A", &json).unwrap() == a);
}
