//! The report as one HTML file that needs nothing else.

mod rest;
mod scene;

use std::collections::BTreeSet;

use super::data::{Image, Report, Times};
use super::html::{escape, number, percent, slug};
use super::plot::Cost;

const STYLE: &str = include_str!("page/page.css");
const INTRODUCTION: &str = include_str!("page/introduction.html");
const SOFTWARE: &str = "Times of a software adapter: only their ratios within this page mean \
                        anything. A GPU's milliseconds never stand beside them.";

/// The whole page, without script and without anything that is fetched. Pictures of scenes that the
/// report lacks are left out.
pub fn page(report: &Report, images: &[Image]) -> String {
    let ids = Ids::of(report, images);
    let scenes: Vec<String> = (report.scenes.iter().zip(&ids.scenes))
        .map(|(scene, ids)| scene::section(scene, images, ids, report.machine.software))
        .collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Point-light shadows: speed against error</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n\
         <h1>Point-light shadows: speed against error</h1>\n<p>Computed by {}.</p>\n{}{}</header>\n\
         {}<main>\n{INTRODUCTION}{}{}{}{}</main>\n</body>\n</html>\n",
        escape(&report.machine.computed_by),
        warning(report.machine.software),
        rest::unfinished(&report.unfinished),
        contents(report, &ids),
        machine(report),
        scenes.concat(),
        rest::parameterisations(&report.parameterisations, &ids.parameterisations),
        rest::costs(&report.costs, &ids.costs, report.machine.software),
    )
}

/// The ids of all figures of the page, in its order.
pub fn figures(report: &Report, images: &[Image]) -> Vec<String> {
    let ids = Ids::of(report, images);
    let scenes = ids.scenes.into_iter().flat_map(|s| [s.images, s.plots, s.tables].concat());
    scenes.chain([ids.parameterisations]).chain(ids.costs).collect()
}

/// Ids of sections and figures; no two are equal.
struct Ids {
    scenes: Vec<SceneIds>,
    parameterisations: String,
    costs: Vec<String>,
}

/// Ids of one scene's figures.
struct SceneIds {
    section: String,
    images: Vec<String>,
    plots: Vec<String>,
    /// Of the variants, and of the sources of error.
    tables: Vec<String>,
}

impl Ids {
    fn of(report: &Report, images: &[Image]) -> Self {
        let mut taken = BTreeSet::new();
        let mut unique = |name: String| {
            let mut id = name.clone();
            let mut more = 2;
            while !taken.insert(id.clone()) {
                id = format!("{name}-{more}");
                more += 1;
            }
            id
        };
        let scenes = report.scenes.iter().map(|scene| {
            let section = unique(format!("scene-{}", slug(&scene.name)));
            let name = section.trim_start_matches("scene-").to_string();
            let mut figure = |kind: &str| unique(format!("fig-{name}-{}", slug(kind)));
            let own = images.iter().filter(|image| image.scene == scene.name);
            SceneIds {
                images: own.map(|image| figure(&image.kind)).collect(),
                plots: Cost::ALL.map(|cost| figure(&format!("plot {}", cost.name()))).to_vec(),
                tables: ["variants", "sources"].map(&mut figure).to_vec(),
                section,
            }
        });
        Self {
            scenes: scenes.collect(),
            parameterisations: unique("fig-parameterisations".to_string()),
            costs: (report.costs.iter())
                .map(|curves| unique(format!("fig-cost-{}", slug(&curves.title))))
                .collect(),
        }
    }
}

/// What to know of a software adapter's times, wherever there are times.
fn warning(software: bool) -> String {
    if software { format!("<p class=\"warning\">{SOFTWARE}</p>\n") } else { String::new() }
}

fn contents(report: &Report, ids: &Ids) -> String {
    let link = |id: &str, text: &str| format!("<li><a href=\"#{id}\">{}</a></li>\n", escape(text));
    let scenes = report.scenes.iter().zip(&ids.scenes);
    let scenes: String =
        scenes.map(|(s, ids)| link(&ids.section, &format!("Scene: {}", s.name))).collect();
    format!(
        "<nav aria-label=\"Contents\">\n<ul>\n{}{}{scenes}{}{}</ul>\n</nav>\n",
        link("introduction", "What this page is about"),
        link("machine", "The machine and the clock"),
        link("parameterisations", "Ways to store all directions"),
        link("costs", "What makes it slower"),
    )
}

/// A median with its quartiles.
fn times(times: &Times) -> String {
    if times.runs == 0 {
        return "–".to_string();
    }
    let (low, median, high) = (number(times.low), number(times.median), number(times.high));
    if low == high { median } else { format!("{median}<small>{low}–{high}</small>") }
}

/// What a table shows, and its head and rows, that scroll by themselves where the page is narrow.
fn table(id: &str, class: &str, caption: &str, head: &[&str], rows: &str) -> String {
    let head: String = head.iter().map(|cell| format!("<th scope=\"col\">{cell}</th>")).collect();
    format!(
        "<p class=\"soft\" id=\"{id}-about\">{caption}</p>\n<div class=\"scroll\" tabindex=\"0\" \
         id=\"{id}\">\n<table class=\"{class}\" aria-describedby=\"{id}-about\">\n\
         <thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\n</div>\n"
    )
}

fn machine(report: &Report) -> String {
    let machine = &report.machine;
    let row = |name: &str, value: &str| {
        let value = if value.is_empty() { "–" } else { value };
        format!(
            "<tr><th scope=\"row\">{}</th><td class=\"text\">{}</td></tr>\n",
            escape(name),
            escape(value)
        )
    };
    let empty = report.timing.empty_pass.filter(|empty| empty.runs > 0);
    let empty = empty.map_or("none was timed".to_string(), |times| {
        let [low, median, high] = [times.low, times.median, times.high].map(number);
        format!("{median} ms (quartiles {low} and {high})")
    });
    let mut rows = vec![
        row("adapter", &machine.adapter),
        row("kind", if machine.software { "software" } else { "hardware" }),
        row("driver", &machine.driver),
        row("back-end", &machine.backend),
        row("system", &format!("{}, {} cores", machine.system, machine.cores)),
        row(
            "warm-up",
            &format!("runs of each variant that are thrown away: {}", report.timing.warm_up),
        ),
        row(
            "repetitions",
            &format!("runs that count: {}; the variants take turns", report.timing.runs),
        ),
        row("typical spread", &spread(report)),
        row("an empty pass", &empty),
    ];
    rows.extend(machine.versions.iter().map(|(name, version)| row(name, version)));
    format!(
        "<section id=\"machine\">\n<h2>The machine and the clock</h2>\n<p>Times are medians. The \
         two small numbers beside one are its quartiles: half of all runs lie between them. A \
         difference smaller than that spread says little. The empty pass is what the clock shows \
         when nothing is drawn; no time near it means anything.</p>\n{}</section>\n",
        table("machine-table", "", "What computed the figures", &["what", "value"], &rows.concat())
    )
}

/// Half of all timed variants spread less than this: the distance of the quartiles over the median.
fn spread(report: &Report) -> String {
    let variants = report.scenes.iter().flat_map(|scene| &scene.variants);
    let mut spreads: Vec<f64> = variants
        .flat_map(|variant| [variant.generation, variant.lookup])
        .filter(|times| times.runs > 1 && times.median > 0.0)
        .map(|times| (times.high - times.low) / times.median)
        .collect();
    spreads.sort_by(f64::total_cmp);
    match spreads.get(spreads.len() / 2) {
        Some(middle) => format!("{} of the median between the quartiles", percent(*middle)),
        None => "unknown".to_string(),
    }
}
