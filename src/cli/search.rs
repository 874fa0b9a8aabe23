//! `dpsm eval --exhaustive`: the largest errors of the ports over their whole domains.

use std::path::Path;

use dpsm::accuracy::{self, Judge};
use dpsm::scalar::bounds;

use super::CliError;
use super::eval::signature;
use super::measure::bar;
use super::output::write_or_print;

/// Searches one function, or all, over so many inputs each, and writes CSV.
pub fn search(function: Option<&str>, points: u64, output: Option<&Path>) -> Result<(), CliError> {
    let names: Vec<&str> = match function {
        Some(function) => vec![function],
        None => bounds::all().iter().map(|bound| bound.function).collect(),
    };
    // hours later is too late to learn that the table has no place
    if let Some(path) = output {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        tempfile::tempfile_in(folder.unwrap_or(Path::new(".")))
            .map_err(|source| CliError::Write { path: path.into(), source, remedy: "--output" })?;
    }
    let broken = |error: csv::Error| CliError::Usage(format!("cannot write the table: {error}"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer
        .write_record([
            "function",
            "points",
            "unit",
            "error_eps",
            "bound_eps",
            "share",
            "mean_share",
            "99_percent_share",
            "rounded",
            "other_decision",
            "open",
            "outside",
            "worst_input",
        ])
        .map_err(broken)?;
    let mut outside = Vec::new();
    let all =
        bar("points", usize::try_from(points).unwrap_or(usize::MAX).saturating_mul(names.len()));
    for name in names {
        let judge = match Judge::of(name) {
            Some(judge) => judge,
            // says what is wrong with the name
            None => {
                return Err(signature(name)
                    .err()
                    .unwrap_or_else(|| CliError::Usage(format!("`{name}` has no port"))));
            }
        };
        all.set_message(name.to_string());
        let stats = accuracy::search(&judge, points, |more| all.inc(more));
        let worst = match stats.broken {
            0 => &stats.input,
            _ => &stats.broken_input,
        };
        let hex: Vec<String> = worst.iter().map(|bits| format!("{bits:08x}")).collect();
        writer
            .write_record([
                name.to_string(),
                stats.points.to_string(),
                format!("{:?}", judge.bound.unit).to_lowercase(),
                format!("{:.4}", stats.worst.eps),
                format!("{:.4}", stats.worst.bound),
                format!("{:.4}", stats.worst.share()),
                format!("{:.4}", stats.mean()),
                format!("{:.2}", stats.percentile()),
                format!("{:.4}", stats.rounded as f64 / stats.points.max(1) as f64),
                stats.decisions.to_string(),
                stats.open.to_string(),
                stats.broken.to_string(),
                hex.join(" "),
            ])
            .map_err(broken)?;
        if stats.broken > 0 {
            outside.push(name);
        }
    }
    all.finish_and_clear();
    let bytes = writer.into_inner().map_err(|error| CliError::Usage(error.to_string()))?;
    write_or_print(output, &String::from_utf8_lossy(&bytes))?;
    match outside.is_empty() {
        true => Ok(()),
        false => Err(CliError::Outside(outside.join(", "))),
    }
}
