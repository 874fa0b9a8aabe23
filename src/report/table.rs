//! Every figure of a report as one CSV table in long form: a line a figure.

use serde::Serialize;
use serde_json::Value;

use super::data::Report;

const HEAD: [&str; 7] = ["section", "scene", "variant", "at", "figure", "value", "unit"];

/// The table. A spreadsheet or pandas pivots it: `figure` names a field of report.json by its path
/// within its scene, variant, source, map or curve; `at` is a curve's place on its horizontal axis,
/// its plot's title stands under `scene` and its name under `variant`. What is null in report.json
/// is an empty value.
///
/// # Errors
///
/// What `csv` and `serde_json` refuse; nothing that a report can hold.
pub fn csv(report: &Report) -> Result<Vec<u8>, csv::Error> {
    let mut out = Table { writer: csv::Writer::from_writer(Vec::new()) };
    out.writer.write_record(HEAD)?;
    let mut whole = value(report)?;
    for part in ["scenes", "parameterisations", "costs"] {
        whole[part].take();
    }
    out.lines(
        ["report", "", "", ""],
        "",
        &without(whole, &["scenes", "parameterisations", "costs"]),
    )?;
    for scene in &report.scenes {
        let own = without(value(scene)?, &["name", "variants", "sources"]);
        out.lines(["scene", &scene.name, "", ""], "", &own)?;
        for variant in &scene.variants {
            let own = without(value(variant)?, &["name"]);
            out.lines(["variant", &scene.name, &variant.name, ""], "", &own)?;
        }
        for source in &scene.sources {
            let own = without(value(source)?, &["name", "variant", "unit"]);
            for (figure, value) in own.as_object().into_iter().flatten() {
                let figure = format!("{}.{figure}", source.name);
                let place = ["source", &scene.name, &source.variant, ""];
                out.line(place, &figure, value, Some(&source.unit))?;
            }
        }
    }
    for map in &report.parameterisations {
        let own = without(value(map)?, &["name"]);
        out.lines(["parameterisation", "", &map.name, ""], "", &own)?;
    }
    for plot in &report.costs {
        for curve in &plot.curves {
            for (x, times) in &curve.points {
                let at = value(x)?.to_string();
                for (figure, value) in value(times)?.as_object().into_iter().flatten() {
                    let place = ["cost", plot.title.as_str(), curve.name.as_str(), at.as_str()];
                    let unit = if figure == "runs" { "" } else { plot.unit.as_str() };
                    let figure = format!("{}.{figure}", plot.axis);
                    out.line(place, &figure, value, Some(unit))?;
                }
            }
        }
    }
    out.writer.into_inner().map_err(|error| error.into_error().into())
}

/// As report.json has it, f32 in its own few digits.
fn value(of: &impl Serialize) -> Result<Value, csv::Error> {
    let text = serde_json::to_string(of).map_err(std::io::Error::from)?;
    Ok(serde_json::from_str(&text).map_err(std::io::Error::from)?)
}

fn without(mut value: Value, fields: &[&str]) -> Value {
    if let Some(object) = value.as_object_mut() {
        object.retain(|name, _| !fields.contains(&name.as_str()));
    }
    value
}

struct Table {
    writer: csv::Writer<Vec<u8>>,
}

impl Table {
    /// A line for every value below.
    fn lines(&mut self, place: [&str; 4], path: &str, value: &Value) -> Result<(), csv::Error> {
        let inner =
            |name: &str| if path.is_empty() { name.into() } else { format!("{path}.{name}") };
        match value {
            Value::Object(fields) => {
                fields.iter().try_for_each(|(name, value)| self.lines(place, &inner(name), value))
            }
            Value::Array(all) => {
                let all = all.iter().enumerate();
                all.into_iter().try_for_each(|(i, v)| self.lines(place, &inner(&i.to_string()), v))
            }
            value => self.line(place, path, value, None),
        }
    }

    fn line(
        &mut self,
        place: [&str; 4],
        figure: &str,
        value: &Value,
        unit: Option<&str>,
    ) -> Result<(), csv::Error> {
        let text = match value {
            Value::Null => String::new(),
            Value::String(text) => text.clone(),
            value => value.to_string(),
        };
        let unit = unit.unwrap_or(if value.is_number() { unit_of(place[0], figure) } else { "" });
        self.writer.write_record([&place[..], &[figure, &text, unit]].concat())
    }
}

/// The unit of a field by its path.
fn unit_of(section: &str, figure: &str) -> &'static str {
    let last = figure.rsplit('.').next().unwrap_or(figure);
    match figure.split('.').next().unwrap_or(figure) {
        _ if last == "runs" || last == "warm_up" => "runs",
        "generation" => "ms",
        "timing" => "ms",
        "lookup" => "ns/pixel",
        "bytes" => "B",
        "light" => "world unit",
        "used" => "share",
        "largest" | "smallest" if section == "parameterisation" => "sr",
        "texels_for_equal_largest" => "texel sr",
        "texels_for_equal_side" => "texel rad^2",
        "error" => match last {
            "contact_gap" => "world unit",
            "edge_texels_median" | "edge_texels_largest" => "texel",
            "edge_degrees_largest" => "degree",
            "rmse" => "",
            "acne_mean" | "leak_mean" => "share of light",
            "acne" => "share of smoothly lit points",
            "leak" => "share of points deep in shadow",
            "smoothly_lit" | "deep_in_shadow" => "points",
            _ => "share of points",
        },
        _ => "",
    }
}
