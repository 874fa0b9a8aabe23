//! What changed between two reports, noise left out; docs/report.md.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::Deserialize;

use super::data::{Report, SceneFigures, Times, VERSION, Variant};
use super::html::number;
use super::noise::{FALSE_ALARM, FEWEST_RUNS, SMALLEST_CHANGE, chance_of_counts, chance_of_times};

/// Why two reports cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// Written by another version of this program.
    #[error("report {name} is of version {found}, this program's is {VERSION}; make it again")]
    Version {
        /// Which: A or B.
        name: &'static str,
        /// Its version.
        found: u32,
    },
    /// No report.
    #[error("report {name} cannot be read: {source}")]
    Json {
        /// Which: A or B.
        name: &'static str,
        /// Why.
        source: serde_json::Error,
    },
}

/// A report from the text of a report.json.
///
/// # Errors
///
/// A text that holds none, or one of another [`VERSION`], whatever else that has.
pub fn read(name: &'static str, json: &str) -> Result<Report, CompareError> {
    #[derive(Deserialize)]
    struct Versioned {
        version: u32,
    }
    let fault = |source| CompareError::Json { name, source };
    match serde_json::from_str::<Versioned>(json).map_err(fault)?.version {
        found if found != VERSION => Err(CompareError::Version { name, found }),
        _ => serde_json::from_str(json).map_err(fault),
    }
}

/// A figure of both reports that may have changed.
struct Change {
    scene: String,
    /// Variant and figure.
    what: String,
    values: [String; 2],
    /// Of two times, b / a.
    ratio: Option<f64>,
    /// The chance of a gap as large without any change; 0 where there is no noise.
    chance: f64,
}

/// Everything that is compared.
#[derive(Default)]
struct Comparison {
    times: Vec<Change>,
    shares: Vec<Change>,
    exact: Vec<Change>,
    /// What cannot be compared, and why.
    notes: Vec<String>,
    few_runs: usize,
}

/// A text that says what differs from a to b by more than noise.
///
/// A time counts as changed, and so does a share of points that were drawn anew, where a gap as
/// large had a chance below 1% over the number of all such comparisons. Figures of the same points
/// have no noise: any difference counts.
///
/// # Errors
///
/// A report of another [`VERSION`].
pub fn compare(a: &Report, b: &Report) -> Result<String, CompareError> {
    for (name, report) in [("A", a), ("B", b)] {
        if report.version != VERSION {
            return Err(CompareError::Version { name, found: report.version });
        }
    }
    let mut found = Comparison::default();
    let other = other_machine(a, b);
    let timed = other.is_none();
    found.notes.extend(other.map(|reason| format!("times are not compared: {reason}")));
    for (name, report) in [("A", a), ("B", b)] {
        if !report.unfinished.is_empty() {
            found.notes.push(format!("{name} is unfinished: {}", report.unfinished.join(", ")));
        }
    }
    if let (true, Some(x), Some(y)) = (timed, &a.timing.empty_pass, &b.timing.empty_pass) {
        found.time("", "empty pass, ms", x, y);
    }
    let scenes = |report: &Report| named(report.scenes.iter().cloned(), |scene| scene.name.clone());
    for (name, x, y) in found.paired("scene", scenes(a), scenes(b)) {
        found.scene(&name, &x, &y, timed);
    }
    if timed {
        found.costs(a, b);
    }
    Ok(found.text(a, b))
}

/// Why times of the two do not compare.
fn other_machine(a: &Report, b: &Report) -> Option<String> {
    let facts = |report: &Report| {
        let machine = &report.machine;
        [
            ("adapter", machine.adapter.clone()),
            ("back-end", machine.backend.clone()),
            ("number of cores", machine.cores.to_string()),
            ("system", machine.system.clone()),
        ]
    };
    let differ = facts(a).into_iter().zip(facts(b)).find(|(x, y)| x != y);
    differ.map(|((what, x), (_, y))| format!("the {what} differs, `{x}` and `{y}`"))
}

fn named<T>(all: impl Iterator<Item = T>, name: impl Fn(&T) -> String) -> BTreeMap<String, T> {
    all.map(|one| (name(&one), one)).collect()
}

impl Comparison {
    /// What both have, by name; what one lacks is noted.
    fn paired<T>(
        &mut self,
        kind: &str,
        a: BTreeMap<String, T>,
        mut b: BTreeMap<String, T>,
    ) -> Vec<(String, T, T)> {
        let mut both = Vec::new();
        for (name, x) in a {
            match b.remove(&name) {
                Some(y) => both.push((name, x, y)),
                None => self.notes.push(format!("{kind} only in A: {name}")),
            }
        }
        self.notes.extend(b.keys().map(|name| format!("{kind} only in B: {name}")));
        both
    }

    fn scene(&mut self, name: &str, a: &SceneFigures, b: &SceneFigures, timed: bool) {
        let same_scene =
            (a.triangles, a.light, a.hemispherical) == (b.triangles, b.light, b.hemispherical);
        if !same_scene {
            self.notes.push(format!("{name}: not compared, its triangles or its light differ"));
            return;
        }
        let same_points = (a.points, a.seed) == (b.points, b.seed);
        if !same_points {
            self.notes.push(format!(
                "{name}: other points ({} of seed {}, {} of seed {}), so shares are compared with \
                 their noise, and means and largest errors are not",
                a.points, a.seed, b.points, b.seed
            ));
        }
        if a.plan != b.plan {
            self.notes.push(format!("{name}: the plan's lines differ"));
        }
        let variants =
            |scene: &SceneFigures| named(scene.variants.iter().cloned(), |v| v.name.clone());
        let kind = format!("{name}: variant");
        for (variant, x, y) in self.paired(&kind, variants(a), variants(b)) {
            if timed {
                self.time(name, &format!("{variant}: making, ms"), &x.generation, &y.generation);
                self.time(name, &format!("{variant}: lookup, ns"), &x.lookup, &y.lookup);
            }
            self.facts(name, &variant, &x, &y);
            let errors = shares(&x, a.points).into_iter().zip(shares(&y, b.points));
            for ((figure, p, of_a), (_, q, of_b)) in errors {
                let what = format!("{variant}: {figure}");
                if same_points {
                    self.exact(name, what, p, q);
                } else {
                    self.share(name, what, (p, of_a), (q, of_b));
                }
            }
            if same_points {
                for ((figure, p), (_, q)) in distances(&x).into_iter().zip(distances(&y)) {
                    self.exact(name, format!("{variant}: {figure}"), p, q);
                }
            }
        }
        if same_points {
            let sources = |s: &SceneFigures| {
                named(s.sources.iter().cloned(), |s| format!("{} of {}", s.name, s.variant))
            };
            for (source, x, y) in self.paired(&format!("{name}: source"), sources(a), sources(b)) {
                self.exact(name, format!("{source}: measured"), x.measured, y.measured);
            }
        }
    }

    /// What has no noise whatever the points.
    fn facts(&mut self, scene: &str, variant: &str, a: &Variant, b: &Variant) {
        let facts = |v: &Variant| {
            [
                ("bytes", v.bytes),
                ("texels", v.texels),
                ("passes", v.passes.into()),
                ("triangles", v.triangles),
            ]
        };
        for ((figure, x), (_, y)) in facts(a).into_iter().zip(facts(b)) {
            self.exact(scene, format!("{variant}: {figure}"), x as f64, y as f64);
        }
    }

    fn costs(&mut self, a: &Report, b: &Report) {
        let points = |report: &Report| {
            let curves = report
                .costs
                .iter()
                .flat_map(|plot| plot.curves.iter().map(move |curve| (plot.title.clone(), curve)));
            let points = curves.flat_map(|(title, curve)| {
                let name = curve.name.clone();
                curve.points.iter().map(move |(x, t)| (format!("{title}: {name} at {x}"), *t))
            });
            points.collect::<BTreeMap<String, Times>>()
        };
        for (name, x, y) in self.paired("cost", points(a), points(b)) {
            self.time("costs", &name, &x, &y);
        }
    }

    fn time(&mut self, scene: &str, what: &str, a: &Times, b: &Times) {
        let Some(chance) = chance_of_times(a, b) else {
            self.few_runs += 1;
            return;
        };
        let ratio = (a.median > 0.0).then(|| b.median / a.median);
        self.times.push(change(scene, what.to_string(), a.median, b.median, ratio, chance));
    }

    fn share(&mut self, scene: &str, what: String, a: (f64, usize), b: (f64, usize)) {
        let counted = |(share, of): (f64, usize)| ((share * of as f64).round() as u64, of as u64);
        let chance = chance_of_counts(counted(a), counted(b));
        self.shares.push(change(scene, what, a.0, b.0, None, chance));
    }

    fn exact(&mut self, scene: &str, what: String, a: f64, b: f64) {
        let chance = if a == b { 1.0 } else { 0.0 };
        self.exact.push(change(scene, what, a, b, None, chance));
    }

    fn text(&self, a: &Report, b: &Report) -> String {
        let mut out = format!("A: {}\nB: {}\n", a.machine.computed_by, b.machine.computed_by);
        let differ = |what: &str, x: &str, y: &str| {
            if x == y { String::new() } else { format!("{what}: {x} -> {y}\n") }
        };
        out += &differ("driver", &a.machine.driver, &b.machine.driver);
        let (versions, others) = (&a.machine.versions, &b.machine.versions);
        for name in versions.keys().chain(others.keys().filter(|n| !versions.contains_key(*n))) {
            let of =
                |all: &BTreeMap<String, String>| all.get(name).cloned().unwrap_or("none".into());
            out += &differ(&format!("version of {name}"), &of(versions), &of(others));
        }
        out += &self.notes.iter().map(|note| format!("{note}\n")).collect::<String>();
        let level = |all: &[Change]| FALSE_ALARM / all.len().max(1) as f64;
        out += &listed("times", &self.times, level(&self.times));
        if !self.times.is_empty() {
            let _ = writeln!(
                out,
                "  (false alarm in any of them: at most 1 in {}; changes below {}% do not count)",
                1.0 / FALSE_ALARM,
                100.0 * SMALLEST_CHANGE
            );
        }
        if self.few_runs > 0 {
            let _ = writeln!(
                out,
                "{} times have fewer than {FEWEST_RUNS} runs: not compared",
                self.few_runs
            );
        }
        out += &listed("shares of other points", &self.shares, level(&self.shares));
        out + &listed("figures without noise", &self.exact, f64::MIN_POSITIVE)
    }
}

/// The points that are wrong, as shares of how many.
fn shares(variant: &Variant, points: usize) -> [(&'static str, f64, usize); 5] {
    let error = &variant.error;
    [
        ("acne, share of smoothly lit points", error.acne, error.smoothly_lit),
        ("leak, share of points deep in shadow", error.leak, error.deep_in_shadow),
        ("false shadow, share of points", error.false_shadow, points),
        ("false light, share of points", error.false_light, points),
        ("faults, share of points", error.faults, points),
    ]
}

/// Means, and errors of single points, whose largest depends on which points there are.
fn distances(variant: &Variant) -> [(&'static str, f64); 7] {
    let error = &variant.error;
    [
        ("RMSE", error.rmse),
        ("mean darkness of smoothly lit points", error.acne_mean),
        ("mean light of points deep in shadow", error.leak_mean),
        ("contact gap", error.contact_gap),
        ("median edge, texels", error.edge_texels_median),
        ("largest edge, texels", error.edge_texels_largest),
        ("largest edge, degrees", error.edge_degrees_largest),
    ]
}

fn change(scene: &str, what: String, a: f64, b: f64, ratio: Option<f64>, chance: f64) -> Change {
    Change { scene: scene.to_string(), what, values: [a, b].map(precise), ratio, chance }
}

/// As many digits as tell equal from different.
fn precise(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        format!("{value}")
    } else {
        format!("{value:.6}")
    }
}

/// The changes whose chance is below a level, and how many were looked at.
fn listed(kind: &str, all: &[Change], level: f64) -> String {
    if all.is_empty() {
        return String::new();
    }
    let changed: Vec<&Change> = all.iter().filter(|change| change.chance < level).collect();
    let mut out = format!("{kind}: {} compared, {} changed\n", all.len(), changed.len());
    for change in changed {
        let place =
            if change.scene.is_empty() { String::new() } else { format!("{}: ", change.scene) };
        let [a, b] = &change.values;
        let _ = write!(out, "  {place}{}: {a} -> {b}", change.what);
        if let Some(ratio) = change.ratio {
            let _ = write!(out, ", times {}", number(ratio));
        }
        out.push('\n');
    }
    out
}
