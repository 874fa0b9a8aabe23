//! Plots as SVG text for the page, in colours that its style sheet can change.

mod axis;
mod scatter;

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;

use super::data::{Curves, Parameterisation};
use super::html::{escape, number};
use axis::Axis;
pub use scatter::{Cost, speed_error};

/// Width and height of a plot's own units; a phone shows about two thirds of them in pixels.
const SIZE: (u32, u32) = (480, 400);
const INK: RGBColor = BLACK;

/// Colours that those who see few can tell apart (Okabe and Ito), for what has no colour of its
/// own.
const PALETTE: [RGBColor; 6] = [
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// The colour of a method, of another name by its place.
pub fn color(name: &str, place: usize) -> RGBColor {
    let known = ["refined", "vertex", "cube", "tessellated", "fragment-depth", "exact"];
    let method = known.iter().position(|method| name.split([' ', ',']).next() == Some(method));
    PALETTE[method.unwrap_or(place) % PALETTE.len()]
}

/// A colour as in SVG.
pub fn hex(RGBColor(r, g, b): RGBColor) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

type Fault = Box<dyn std::error::Error>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

fn text(size: u32) -> TextStyle<'static> {
    TextStyle::from(("sans-serif", size).into_font()).color(&INK)
}

/// An SVG element with a title and a description for those who cannot see it.
fn svg(
    (width, height): (u32, u32),
    title: &str,
    about: &str,
    draw: impl FnOnce(&Area<'_>) -> Result<(), Fault>,
) -> String {
    let mut out = String::new();
    let drawn = {
        let area = SVGBackend::with_string(&mut out, (width, height)).into_drawing_area();
        draw(&area).and_then(|()| Ok(area.present()?))
    };
    let body = match (drawn, out.find('>')) {
        (Ok(()), Some(end)) => out.split_off(end + 1).replace("\"#000000\"", "\"currentColor\""),
        (Err(error), _) => format!("<text y=\"20\">{}</text></svg>", escape(&error.to_string())),
        (Ok(()), None) => "</svg>".to_string(),
    };
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\">\
         <title>{}</title><desc>{}</desc>{body}",
        escape(title),
        escape(about)
    )
}

/// Empty logarithmic axes.
fn axes<'a, 'b>(
    area: &'a Area<'b>,
    (x, x_name): (&Axis, &str),
    (y, y_name): (&Axis, &str),
) -> Result<Chart<'a, 'b>, Fault> {
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .margin_right(14)
        .x_label_area_size(54)
        .y_label_area_size(74)
        .build_cartesian_2d(x.clone(), y.clone())?;
    chart
        .configure_mesh()
        .x_desc(x_name)
        .y_desc(y_name)
        .label_style(text(20))
        .axis_desc_style(text(21))
        .axis_style(INK.mix(0.5))
        .bold_line_style(INK.mix(0.15))
        .light_line_style(TRANSPARENT)
        .draw()?;
    if let Some(edge) = x.edge() {
        let std::ops::Range { start, end } = Ranged::range(y);
        let line = [(edge, start), (edge, end)];
        chart.draw_series([DashedPathElement::new(line, 4, 4, INK.mix(0.5))])?;
    }
    Ok(chart)
}

/// Times against one quantity, both axes logarithmic, quartiles as vertical lines.
pub fn curves(curves: &Curves) -> String {
    let points = || curves.curves.iter().flat_map(|curve| &curve.points);
    let x = Axis::of(points().map(|(x, _)| *x));
    let y = Axis::of(points().flat_map(|(_, times)| [times.low, times.median, times.high]));
    let about = format!(
        "{} against {}, both logarithmic: {}",
        curves.unit,
        curves.axis,
        curves.curves.iter().map(|curve| curve.name.as_str()).collect::<Vec<_>>().join("; ")
    );
    svg(SIZE, &curves.title, &about, |area| {
        let mut chart = axes(area, (&x, &curves.axis), (&y, &curves.unit))?;
        for (i, curve) in curves.curves.iter().enumerate() {
            let style = color(&curve.name, i).stroke_width(2);
            let medians: Vec<_> = curve.points.iter().map(|(x, t)| (*x, t.median)).collect();
            let whisker = |(x, times): &(f64, super::data::Times)| {
                PathElement::new([(*x, times.low), (*x, times.high)], style)
            };
            chart.draw_series(curve.points.iter().map(whisker))?;
            chart.draw_series(medians.iter().map(|at| Circle::new(*at, 4, style.filled())))?;
            chart.draw_series([PathElement::new(medians, style)])?;
        }
        Ok(())
    })
}

/// Texels that each map of all directions needs, as bars.
pub fn bars(maps: &[Parameterisation]) -> String {
    const ROW: u32 = 62;
    let needs =
        |map: &Parameterisation| [Some(map.texels_for_equal_largest), map.texels_for_equal_side];
    let most = maps.iter().flat_map(needs).flatten().fold(1.0, f64::max);
    let lines: Vec<String> = maps
        .iter()
        .map(|map| format!("{} {}", map.name, number(map.texels_for_equal_largest)))
        .collect();
    let size = (SIZE.0, ROW * maps.len() as u32 + 8);
    svg(size, "Texels needed for equal quality", &lines.join("; "), |area| {
        for (i, map) in maps.iter().enumerate() {
            let top = i as i32 * ROW as i32 + 4;
            area.draw_text(&map.name, &text(19), (6, top))?;
            for (j, texels) in needs(map).into_iter().enumerate() {
                let (top, bottom) = (top + 19 + j as i32 * 19, top + 35 + j as i32 * 19);
                // room for the number behind the longest bar
                let end = texels.map_or(6, |t| 6 + (t / most * f64::from(SIZE.0 - 70)) as i32);
                let bar = [(6, top), (end, bottom)];
                area.draw(&Rectangle::new(bar, PALETTE[2 - 2 * j].filled()))?;
                let value = texels.map_or("no number is enough".to_string(), number);
                area.draw_text(&value, &text(18), (end + 6, top))?;
            }
        }
        Ok(())
    })
}

/// The colours of [`bars`]: equal largest texel, equal longest side.
pub const BARS: [RGBColor; 2] = [PALETTE[2], PALETTE[0]];
