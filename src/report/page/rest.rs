//! What is of no scene.

use super::super::data::{Curves, Parameterisation};
use super::super::html::{escape, number, percent};
use super::super::plot::{self, BARS, color, hex};
use super::{table, warning};

/// What an interrupted run left open.
pub fn unfinished(names: &[String]) -> String {
    if names.is_empty() {
        return String::new();
    }
    let names: String = names.iter().map(|name| format!("<li>{}</li>", escape(name))).collect();
    format!(
        "<div class=\"warning\" id=\"unfinished\"><p>This report is unfinished. The same command \
         goes on with what is missing:</p><ul>{names}</ul></div>\n"
    )
}

/// A colour and what it stands for.
pub fn key(color: &str, text: &str) -> String {
    format!(
        "<li><svg viewBox=\"0 0 10 10\" aria-hidden=\"true\"><rect width=\"10\" height=\"10\" \
         fill=\"{color}\"/></svg>{}</li>\n",
        escape(text)
    )
}

/// Sphere, longitude-latitude, cube, paraboloid, and what is newer.
pub fn parameterisations(maps: &[Parameterisation], id: &str) -> String {
    let or_infinite = |value: Option<f64>| value.map_or("infinite".to_string(), number);
    let row = |map: &Parameterisation| {
        let cells = [
            map.passes.to_string(),
            percent(map.used),
            number(map.largest),
            number(map.smallest),
            or_infinite(map.ratio),
            number(map.texels_for_equal_largest),
            or_infinite(map.texels_for_equal_side),
            or_infinite(map.anisotropy),
        ];
        let cells: String = cells.iter().map(|cell| format!("<td>{cell}</td>")).collect();
        let name = escape(&map.name);
        format!("<tr><th scope=\"row\">{name}</th>{cells}</tr>\n")
    };
    let note = |map: &Parameterisation| {
        let (name, note) = (escape(&map.name), escape(&map.note));
        format!("<div><dt>{name}</dt><dd>{note}</dd></div>\n")
    };
    let head = [
        "map",
        "passes",
        "texels used",
        "largest texel, sr",
        "smallest, sr",
        "ratio",
        "texels for equal largest",
        "texels for equal side",
        "longest side / shortest",
    ];
    let caption = "Solid angles (steradians, sr) are for a map of one texel in all: divide them by \
                   the number of texels stored.";
    format!(
        "<section id=\"parameterisations\">\n<h2>Ways to store all directions</h2>\n<p>A point \
         light needs a flat map of all directions, and no flat map shows them all alike, as no \
         map of the Earth does. The worst place decides how coarse a shadow can become: so here \
         is how many texels each map stores when its largest texel covers the same solid angle, \
         and when the longest side of any texel spans the same angle. Fewer is better. All \
         figures are computed from the maps' equations.</p>\n\
         <p><b>Paraboloids do not win on texels.</b> A cube needs a quarter fewer, and the corners \
         of both squares, 21.5% of what is stored, are unused. Paraboloids win on passes: two, \
         where the other maps that a rasteriser can draw take four to eight. And they win on \
         uniformity: a texel is square wherever it is, and the largest has only four times the \
         smallest's solid angle.</p>\n<figure class=\"wide\" id=\"{id}\">\n<ul \
         class=\"legend\">{}{}</ul>{}<figcaption><b>Texels needed for equal quality</b>What to \
         look for: the shorter a bar, the more a map makes of its memory. Texels times \
         steradians, and times squared \
         radians.</figcaption>\n</figure>\n{}<dl>\n{}</dl>\n</section>\n",
        key(&hex(BARS[0]), "equal largest texel"),
        key(&hex(BARS[1]), "equal longest side"),
        plot::bars(maps),
        table(
            "parameterisations-table",
            "",
            caption,
            &head,
            &maps.iter().map(row).collect::<String>()
        ),
        maps.iter().map(note).collect::<String>()
    )
}

/// Cost against triangles, map size, lights, taps.
pub fn costs(costs: &[Curves], ids: &[String], software: bool) -> String {
    let figure = |(curves, id): (&Curves, &String)| {
        let keys = curves.curves.iter().enumerate();
        let keys: String = keys.map(|(i, c)| key(&hex(color(&c.name, i)), &c.name)).collect();
        format!(
            "<figure id=\"{id}\">\n{}<figcaption><ul class=\"legend\">{keys}</ul><b>{}</b>What to \
             look for: a curve that stays flat costs nothing more; one that climbs a step up for \
             each step to the right doubles with {}.</figcaption>\n</figure>\n",
            plot::curves(curves),
            escape(&curves.title),
            escape(&curves.axis)
        )
    };
    let figures: String = costs.iter().zip(ids).map(figure).collect();
    format!(
        "<section id=\"costs\">\n<h2>What makes it slower</h2>\n<p>Both axes are logarithmic: \
         equal steps multiply by equal factors. Dots are medians, vertical lines reach from one \
         quartile to the other.</p>\n{}<div class=\"grid\">\n{figures}</div>\n</section>\n",
        warning(software)
    )
}
