//! The table on the terminal, and docs/accuracy.md.

use std::fmt::Write;
use std::fs;
use std::io;
use std::path::Path;

use dpsm::accuracy::{BINS, Stats};
use dpsm::scalar::bounds::Unit;

use super::Row;

/// The largest share of the bound on any implementation.
fn most(row: &Row) -> f64 {
    let others = row.others.iter().flatten().map(|stats| stats.worst.share());
    others.fold(row.port.worst.share().max(row.loose.worst.share()), f64::max)
}

/// What is left of a closed bound.
fn slack(row: &Row) -> String {
    match row.judge.bound.unit {
        Unit::Interval => "-".into(),
        _ => format!("{:.2}", 1.0 - most(row)),
    }
}

/// The largest error in eps, as a share of the interval, or nothing where there is none.
fn largest(row: &Row, stats: Option<&Stats>) -> String {
    match (row.judge.bound.unit, stats) {
        (_, None) => "-".into(),
        (Unit::Exact, Some(stats)) if stats.broken == 0 => "0".into(),
        (Unit::Interval, Some(stats)) => format!("{:.2}", stats.worst.eps),
        (_, Some(stats)) => {
            let own = format!("{:.1}", stats.worst.bound);
            // its own, where the bound depends on the input
            let of = if own == bound(row) || stats.worst.eps == 0.0 {
                String::new()
            } else {
                format!("/{own}")
            };
            format!("{:.2}{of}", stats.worst.eps)
        }
    }
}

/// The bound at the worst input.
fn bound(row: &Row) -> String {
    match row.judge.bound.unit {
        Unit::Exact => "exact".into(),
        Unit::Interval => "interval".into(),
        _ => format!("{:.1}", row.port.worst.bound),
    }
}

/// One line of the terminal's table.
pub fn line(row: &Row) -> String {
    let others: String =
        row.others.iter().map(|stats| format!(" {:>7}", largest(row, stats.as_ref()))).collect();
    format!(
        "{:<34}{:>10}{:>9}{:>8}{:>8}{others}{:>8}",
        row.judge.bound.function,
        row.port.points,
        bound(row),
        largest(row, Some(&row.loose)),
        largest(row, Some(&row.port)),
        slack(row)
    )
}

/// The function's comment from its domain or bound on.
fn promise(module: &str, function: &str) -> String {
    let text = dpsm::module(module).map_or("", |module| module.text);
    let end = text.find(&format!("fn {function}(")).unwrap_or(0);
    let comment = text[..end].rsplit("\n\n").next().unwrap_or("");
    let lines = comment.lines().map(|line| line.trim_start_matches("///").trim());
    let joined = lines.collect::<Vec<_>>().join(" ");
    let from = ["Domain", "Bound:", "Exact"].iter().filter_map(|word| joined.find(word)).min();
    joined[from.unwrap_or(0)..].trim().to_string()
}

/// The functions that read textures, which have no row.
fn samplers(text: &mut String) {
    text.push_str(SAMPLERS);
    for module in dpsm::MODULES {
        let starts = module.text.lines().filter_map(|line| line.strip_prefix("fn "));
        for function in starts.filter_map(|line| line.split('(').next()) {
            if dpsm::scalar::bounds::Bound::of(function).is_none() {
                let _ = writeln!(text, "- `{function}`: {}", promise(module.name, function));
            }
        }
    }
}

const SAMPLERS: &str = "
## Functions that read maps

Each tap is a decision: where its lookup reads and what it compares are bounded above, and it is that of exact arithmetic unless these straddle a texel's border or the stored depth. tests/adapter.rs compares the single lookups with their ports on the adapter for a million points in each format, tests/filter the filters, tap by tap.

";

/// A histogram of the shares of the bound, its bars by the logarithm of their counts.
fn histogram(stats: &Stats) -> String {
    let most = stats.histogram.iter().copied().max().unwrap_or(0).max(1) as f64;
    let mut bars = String::new();
    for (bin, &count) in stats.histogram.iter().enumerate().filter(|(_, count)| **count > 0) {
        let height = 2.0 + 14.0 * (count as f64).ln_1p() / most.ln_1p();
        let colour = if bin == BINS - 1 { "#d62728" } else { "#1f77b4" };
        let (x, y) = (4 * bin, 16.0 - height);
        let _ = write!(
            bars,
            r#"<rect x="{x}" y="{y:.1}" width="3" height="{height:.1}" fill="{colour}"/>"#
        );
    }
    let width = 4 * BINS;
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="17"><path d="M0 16.5h80" stroke="#888"/>{bars}</svg>
"##
    )
}

fn hex(input: &[u32]) -> String {
    input.iter().map(|bits| format!("{bits:08x}")).collect::<Vec<_>>().join(" ")
}

/// Writes docs/accuracy.md, docs/pictures/accuracy/ and src/cases/worst.txt.
pub fn write(names: &[String], rows: &[Row]) -> io::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pictures = root.join("docs/pictures/accuracy");
    fs::create_dir_all(&pictures)?;
    let mut text = INTRODUCTION.to_string();
    text.push_str("\nImplementations, beside the f32 port:\n\n");
    for (k, name) in names.iter().enumerate() {
        let _ = writeln!(text, "{}. {name}", k + 1);
    }
    let columns: String = (1..=names.len()).map(|k| format!(" {k} |")).collect();
    let rules = "---|".repeat(names.len());
    let mut worst = String::new();
    let mut module = "";
    for row in rows {
        let bound_of = row.judge.bound;
        if bound_of.module != module {
            module = bound_of.module;
            let _ = write!(
                text,
                "\n## [{module}]({page}.md)\n\n| function | bound | unit | intervals | any driver | port |{columns} slack | 99% | mean | rounded | other | open | points | shares |\n|---|---|---|---|---|---|{rules}---|---|---|---|---|---|---|---|\n",
                page = page(module)
            );
        }
        fs::write(pictures.join(format!("{}.svg", bound_of.function)), histogram(&row.port))?;
        let unit = format!("{:?}", bound_of.unit).to_lowercase();
        let others: String =
            row.others.iter().map(|stats| format!(" {} |", largest(row, stats.as_ref()))).collect();
        let share = |count: u64| count as f64 / row.port.points.max(1) as f64;
        let allowed = match bound_of.unit {
            Unit::Exact | Unit::Interval | Unit::Angle => "".to_string(),
            _ => format!("{:.2}", row.allowed.eps),
        };
        let _ = writeln!(
            text,
            "| `{}` | {} | {unit} | {allowed} | {} | {} |{others} {} | {:.2} | {:.3} | {:.1}% | {} | {} | {} | ![]({}) |",
            bound_of.function,
            bound(row),
            largest(row, Some(&row.loose)),
            largest(row, Some(&row.port)),
            slack(row),
            row.port.percentile(),
            row.port.mean(),
            100.0 * share(row.port.rounded),
            row.port.decisions,
            row.port.open,
            row.port.points,
            format_args!("pictures/accuracy/{}.svg", bound_of.function),
        );
        for input in [&row.port.input, &row.loose.input].into_iter().filter(|i| !i.is_empty()) {
            let _ = writeln!(worst, "{} {}", bound_of.function, hex(input));
        }
    }
    text.push_str("\n## Domains, bounds and worst inputs\n\nThe text is the WGSL function's own comment; the input is the port's worst, the bits of its words in hexadecimal.\n\n");
    for row in rows {
        let function = row.judge.bound.function;
        let _ = write!(text, "- `{function}`: {}", promise(row.judge.bound.module, function));
        match row.port.input.is_empty() {
            true => text.push('\n'),
            false => {
                let _ = writeln!(text, " Worst: `{}`.", hex(&row.port.input));
            }
        }
    }
    samplers(&mut text);
    long_run(&root.join("docs/long-run.csv"), &mut text);
    fs::write(root.join("docs/accuracy.md"), text)?;
    fs::write(root.join("src/cases/worst.txt"), worst)
}

/// The table of a long search, where there is one.
fn long_run(path: &Path, text: &mut String) {
    let Ok(table) = fs::read_to_string(path) else { return };
    text.push_str(LONG_RUN);
    for line in table.lines().skip(1) {
        let fields: Vec<_> = line.split(',').collect();
        if let [
            function,
            points,
            unit,
            error,
            bound,
            share,
            mean,
            most,
            rounded,
            other,
            open,
            outside,
            worst,
        ] = fields[..]
        {
            let _ = writeln!(
                text,
                "| `{function}` | {points} | {unit} | {error} | {bound} | {share} | {mean} | {most} | {rounded} | {other} | {open} | {outside} | `{worst}` |"
            );
        }
    }
}

const LONG_RUN: &str = "
## The long run

`dpsm eval FUNCTION --exhaustive`, on the f32 port; errors and bounds in eps, the rest shares and counts, as above.

| function | points | unit | largest | bound | share | mean | 99% | rounded | other | open | outside | worst input |
|---|---|---|---|---|---|---|---|---|---|---|---|---|
";

/// The page that has a module's derivations.
fn page(module: &str) -> &str {
    match module {
        "pcss" | "raw" | "lights" => "filter",
        module => module,
    }
}

const INTRODUCTION: &str = include_str!("introduction.md");
