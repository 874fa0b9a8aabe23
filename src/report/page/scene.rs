//! A scene's section.

use std::collections::BTreeMap;

use super::super::data::{Image, Role, SceneFigures, Source, Variant};
use super::super::html::{count, escape, number, percent};
use super::super::plot::{Cost, color, hex, speed_error};
use super::rest::key;
use super::{SceneIds, table, times, warning};

/// Pictures, plots, tables, the plan and the sources of error.
pub fn section(scene: &SceneFigures, images: &[Image], ids: &SceneIds, software: bool) -> String {
    let own = images.iter().filter(|image| image.scene == scene.name);
    let pictures: String = own.zip(&ids.images).map(|(image, id)| picture(image, id)).collect();
    let plots = Cost::ALL.iter().zip(&ids.plots);
    let plots: String = plots.map(|(cost, id)| plot(scene, *cost, id)).collect();
    let [x, y, z] = scene.light;
    let kind = if scene.hemispherical {
        "a light with one hemisphere"
    } else {
        "an omnidirectional light"
    };
    format!(
        "<section id=\"{}\">\n<h2>Scene: {}</h2>\n<p>{} {} triangles, {kind} at ({x}, {y}, {z}); \
         {} points that the camera sees are judged (seed {}).</p>\n<div \
         class=\"grid\">\n{pictures}</div>\n<h3>Speed against error</h3>\n{}{}<div \
         class=\"grid\">\n{plots}</div>\n{}{}{}</section>\n",
        ids.section,
        escape(&scene.name),
        escape(&scene.about),
        count(scene.triangles as i64),
        count(scene.points as i64),
        scene.seed,
        warning(software),
        legend(&scene.variants),
        variants(&scene.variants, &ids.tables[0]),
        plan(&scene.plan),
        sources(&scene.sources, &ids.tables[1]),
    )
}

fn picture(image: &Image, id: &str) -> String {
    // base 64 alone may stand in the address
    let fits = |c: &char| c.is_ascii_alphanumeric() || "+/=".contains(*c);
    let png: String = image.png.chars().filter(fits).collect();
    let title = escape(&image.title);
    format!(
        "<figure id=\"{id}\">\n<img src=\"data:image/png;base64,{png}\" width=\"{}\" height=\"{}\" \
         alt=\"{title}\">\n<figcaption><b>{title}</b>{}</figcaption>\n</figure>\n",
        image.size[0],
        image.size[1],
        escape(&image.caption)
    )
}

fn plot(scene: &SceneFigures, cost: Cost, id: &str) -> String {
    let (title, about) = match cost {
        Cost::Generation => (
            "Making the maps",
            "What to look for: lower left is better. Marks on the stepped line have no rival here; \
             along it, less error costs more time.",
        ),
        Cost::Lookup => (
            "Reading the maps",
            "What to look for: what a better filter or bias costs each pixel. Variants that are \
             read alike stand at about the same height.",
        ),
        Cost::Memory => (
            "Memory",
            "What to look for: variants of the same height store equally much; the leftmost of \
             them makes the most of it.",
        ),
    };
    format!(
        "<figure id=\"{id}\">\n{}<figcaption><b>{title}</b>{about}</figcaption>\n</figure>\n",
        speed_error(scene, cost)
    )
}

/// Colours of the methods that there are, and the shapes.
fn legend(variants: &[Variant]) -> String {
    let methods: BTreeMap<&str, String> = variants
        .iter()
        .enumerate()
        .map(|(i, variant)| (variant.method.as_str(), hex(color(&variant.method, i))))
        .collect();
    let colors: String = methods.iter().map(|(method, color)| key(color, method)).collect();
    let shape = |shape: &str, text: &str| {
        format!("<li><svg viewBox=\"0 0 24 24\" aria-hidden=\"true\">{shape}</svg>{text}</li>\n")
    };
    let outline = "fill=\"none\" stroke=\"currentColor\" stroke-width=\"3\"";
    let shapes = [
        shape(
            "<circle cx=\"12\" cy=\"12\" r=\"10\" fill=\"currentColor\"/>",
            "filled: on the front",
        ),
        shape(
            &format!("<circle cx=\"12\" cy=\"12\" r=\"9\" {outline}/>"),
            "hollow: beaten in this plot",
        ),
        shape(&format!("<rect x=\"3\" y=\"3\" width=\"18\" height=\"18\" {outline}/>"), "a cube"),
        shape(
            "<path \
             fill=\"currentColor\" d=\"M12 0 15 8 24 9 17 14 19 23 12 18 5 23 7 14 0 9 9 8Z\"/>",
            "what <code>dpsm plan</code> chooses",
        ),
        shape(&format!("<path d=\"M0 3H10V20H24\" {outline}/>"), "Pareto front of the plot"),
    ];
    format!(
        "<ul class=\"legend\">\n{colors}{}</ul>\n<p class=\"soft\">A number beside a mark is the \
         variant's row in the table below. A vertical line through it joins the quartiles of its \
         time. Axes are logarithmic; what has no error at all stands left of the dashed \
         line.</p>\n",
        shapes.concat()
    )
}

const HEAD: [&str; 20] = [
    "row",
    "variant",
    "making, ms",
    "lookup, ns a pixel",
    "MiB",
    "wrong",
    "acne",
    "leak",
    "RMSE",
    "false shadow",
    "false light",
    "faults",
    "contact gap",
    "edge, texels: median",
    "largest",
    "largest, degrees",
    "maps",
    "passes",
    "triangles drawn",
    "how it is read",
];

fn variants(variants: &[Variant], id: &str) -> String {
    let rows: String = variants.iter().enumerate().map(|(i, variant)| row(i, variant)).collect();
    let caption = "Every variant; a star is the plan's choice, squares are cubes. Grey ones are \
                   dominated: the variant named below is at least as good in making, lookup, \
                   memory and wrong points, and better in one. Acne: of the \
                   points that are smoothly lit, those in shadow by the map; leak: of those deep in \
                   shadow, those lit.";
    table(id, "named", caption, &HEAD, &rows)
}

fn row(i: usize, variant: &Variant) -> String {
    let error = &variant.error;
    let sign = match variant.role {
        Role::Other => "",
        Role::Cube => " ■",
        Role::Plan => " ★",
    };
    let cells = [
        times(&variant.generation),
        times(&variant.lookup),
        number(variant.bytes as f64 / f64::from(1 << 20)),
        percent(error.misclassified()),
        percent(error.acne),
        percent(error.leak),
        number(error.rmse),
        percent(error.false_shadow),
        percent(error.false_light),
        percent(error.faults),
        number(error.contact_gap),
        number(error.edge_texels_median),
        number(error.edge_texels_largest),
        number(error.edge_degrees_largest),
        format!("{}\u{a0}×\u{a0}{}²", variant.maps, variant.size),
        variant.passes.to_string(),
        count(variant.triangles as i64),
    ];
    let cells: String = cells.iter().map(|cell| format!("<td>{cell}</td>")).collect();
    let read =
        [&variant.filter, &variant.bias, &variant.format].map(|text| escape(text)).join(", ");
    let class = if variant.dominated_by.is_empty() { "front" } else { "beaten" };
    let beaten = match variant.dominated_by.as_str() {
        "" => String::new(),
        by => format!("<small>beaten by {}</small>", escape(by)),
    };
    format!(
        "<tr class=\"{class}\"><td>{}</td><th scope=\"row\">{}{sign}{beaten}</th>{cells}\
         <td class=\"text\">{read}</td></tr>\n",
        i + 1,
        escape(&variant.name)
    )
}

fn plan(lines: &[String]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let lines = lines.iter().map(|line| format!("<li>{}</li>\n", escape(line)));
    format!("<h3>What the plan chooses, and why</h3>\n<ul>{}</ul>\n", lines.collect::<String>())
}

fn sources(sources: &[Source], id: &str) -> String {
    let row = |source: &Source| {
        format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td class=\"text\">{}</td>\
             <td class=\"text\">{}</td></tr>\n",
            escape(&source.name),
            number(source.measured),
            source.predicted.map_or("none".to_string(), number),
            escape(&source.unit),
            escape(&source.variant)
        )
    };
    let head = ["source", "largest measured", "bound or prediction", "unit", "variant"];
    let caption = "One source at a time, all others exact.";
    format!(
        "<h3>Where the error comes from</h3>\n<p>What to look for: the source whose error is \
         largest is the one to work on. A measured figure should not exceed its bound.</p>\n{}",
        table(id, "sources", caption, &head, &sources.iter().map(row).collect::<String>())
    )
}
