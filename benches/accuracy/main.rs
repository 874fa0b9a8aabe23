//! The modules' functions on every implementation that is present, each result beside its bound.
//!
//! Run: `tools/accuracy`. Options: `--search N` inputs of the port, `--points N` of the others,
//! `--write` writes docs/accuracy.md, its pictures and src/cases/worst.txt, `--only PART` of a
//! function's name, `disagreements` sorts by cause what is not the port bit for bit.

#[path = "../../tests/common/mod.rs"]
mod common;
mod disagreements;
mod flushed;
mod implementation;
mod page;

use dpsm::accuracy::{CHUNK, Inputs, Judge, Stats, bits, judge_all, search, search_loosely};
use dpsm::scalar::bounds::{self, Error};
use implementation::Implementation;

/// One function's figures.
pub struct Row {
    pub judge: Judge,
    /// Of the port.
    pub port: Stats,
    /// Of each implementation; `None` where it cannot run the function.
    pub others: Vec<Option<Stats>>,
    /// Of a driver that rounds at random within WGSL's rules.
    pub loose: Stats,
    /// The most that the interval allows, with the exact decisions.
    pub allowed: Error,
}

/// What is asked for.
struct Options {
    search: u64,
    points: u64,
    write: bool,
    only: String,
    disagreements: bool,
}

impl Options {
    fn parse() -> Result<Self, String> {
        let mut arguments = std::env::args().skip(1);
        // `cargo test --benches` only tries it
        let tried = !std::env::args().any(|argument| argument == "--bench");
        let mut options = Self {
            search: if tried { 1 } else { 1_000_000 },
            points: if tried { 1 } else { 100_000 },
            write: false,
            only: String::new(),
            disagreements: false,
        };
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
            let number = |text: String| text.parse().map_err(|_| format!("`{text}` is no number"));
            match argument.as_str() {
                "--search" => options.search = number(value()?)?,
                "--points" => options.points = number(value()?)?,
                "--only" => options.only = value()?,
                "--write" => options.write = true,
                "disagreements" => options.disagreements = true,
                "--bench" => {}
                other => return Err(format!("unknown option `{other}`")),
            }
        }
        if options.search == 0 || options.points == 0 {
            return Err("--search and --points must be at least 1".into());
        }
        if !bounds::all().iter().any(|bound| bound.function.contains(&options.only)) {
            return Err(format!("no function's name contains `{}`", options.only));
        }
        if options.write && !options.only.is_empty() {
            return Err("--write writes every function's line: leave --only out".into());
        }
        Ok(options)
    }
}

/// An implementation's answers to the first inputs of the domain.
fn judged(
    implementation: &mut dyn Implementation,
    judge: &Judge,
    points: u64,
) -> Result<Option<Stats>, String> {
    let inputs = Inputs::of(judge);
    let mut records = Vec::new();
    let mut chunk = 0;
    while (records.len() as u64) < points && chunk * (CHUNK as u64) < 4 * points + CHUNK as u64 {
        records.extend(inputs.chunk(chunk).into_iter().filter(|record| judge.inside(record)));
        chunk += 1;
    }
    records.truncate(points as usize);
    let words: Vec<u32> = records.iter().flatten().map(|&word| bits(word)).collect();
    let answers = implementation.evaluate(judge.bound.function, &words)?;
    Ok(answers.map(|answers| judge_all(judge, &records, &answers)))
}

/// The most that the interval allows over some inputs.
fn allowed(judge: &Judge) -> Error {
    let records = Inputs::of(judge).chunk(u64::MAX / 2);
    let errors = records.iter().filter_map(|record| judge.allowed(record));
    errors.fold(Error::default(), |a, b| if b.share() > a.share() { b } else { a })
}

fn main() -> Result<(), String> {
    let options = Options::parse()?;
    let mut all = implementation::all();
    if options.disagreements {
        return disagreements::print(&mut all, options.points as usize);
    }
    let names: Vec<String> = all.iter().map(|one| one.name()).collect();
    for (k, name) in names.iter().enumerate() {
        println!("[{}] {name}", k + 1);
    }
    let columns: String = (1..=all.len()).map(|k| format!("{:>8}", format!("[{k}]"))).collect();
    println!(
        "{:<34}{:>10}{:>9}{:>8}{:>8}{columns}{:>8}",
        "function", "points", "bound", "any", "port", "slack"
    );
    let mut rows = Vec::new();
    let mut broken = Vec::new();
    for bound in bounds::all().iter().filter(|bound| bound.function.contains(&options.only)) {
        let judge = Judge::of(bound.function).ok_or("a function without a judge")?;
        let port = search(&judge, options.search, |_| {});
        let mut others = Vec::new();
        for (one, name) in all.iter_mut().zip(&names) {
            let stats = judged(one.as_mut(), &judge, options.points);
            let stats = stats.unwrap_or_else(|error| {
                broken.push(format!("{name}: {}: {error}", bound.function));
                None
            });
            if let Some(stats) = stats.as_ref().filter(|stats| stats.broken > 0) {
                let input = &stats.broken_input;
                broken.push(format!(
                    "{name}: {}: {} outside, {input:08x?}",
                    bound.function, stats.broken
                ));
            }
            others.push(stats);
        }
        if port.broken > 0 {
            let input = &port.broken_input;
            broken.push(format!("port: {}: {} outside, {input:08x?}", bound.function, port.broken));
        }
        let loose = search_loosely(&judge, options.search, |_| {});
        if loose.broken > 0 {
            let input = &loose.broken_input;
            broken.push(format!(
                "any driver: {}: {} outside, {input:08x?}",
                bound.function, loose.broken
            ));
        }
        let row = Row { allowed: allowed(&judge), judge, port, loose, others };
        println!("{}", page::line(&row));
        rows.push(row);
    }
    if !broken.is_empty() {
        return Err(format!("outside their bounds:\n{}", broken.join("\n")));
    }
    if options.write {
        page::write(&names, &rows).map_err(|error| format!("cannot write the page: {error}"))?;
    }
    Ok(())
}
