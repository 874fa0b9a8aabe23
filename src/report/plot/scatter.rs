//! Speed against error.

use plotters::prelude::*;

use super::super::data::{Role, SceneFigures, Times, Variant};
use super::super::pareto;
use super::{Axis, Chart, Fault, INK, SIZE, axes, color, svg, text};

/// What an error is bought with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Making all maps.
    Generation,
    /// A pixel's shadow test.
    Lookup,
    /// The maps' memory.
    Memory,
}

impl Cost {
    /// All three, in the page's order.
    pub const ALL: [Self; 3] = [Self::Generation, Self::Lookup, Self::Memory];

    /// One word, as in a figure's id.
    pub fn name(self) -> &'static str {
        match self {
            Self::Generation => "generation",
            Self::Lookup => "lookup",
            Self::Memory => "memory",
        }
    }

    /// The vertical axis.
    pub fn axis(self) -> &'static str {
        match self {
            Self::Generation => "making the maps, ms",
            Self::Lookup => "lookup, ns a pixel",
            Self::Memory => "memory of the maps, MiB",
        }
    }

    fn of(self, variant: &Variant) -> Times {
        match self {
            Self::Generation => variant.generation,
            Self::Lookup => variant.lookup,
            Self::Memory => {
                let mib = variant.bytes as f64 / f64::from(1 << 20);
                Times { runs: 1, least: mib, low: mib, median: mib, high: mib }
            }
        }
    }
}

/// The error of a scene's variants against one cost. Filled marks are on the plot's own Pareto
/// front, the stepped line; the number beside a mark is the variant's row in the page's table.
pub fn speed_error(scene: &SceneFigures, cost: Cost) -> String {
    let errors: Vec<f64> = scene.variants.iter().map(|v| 100.0 * v.error.misclassified()).collect();
    let times: Vec<Times> = scene.variants.iter().map(|variant| cost.of(variant)).collect();
    let x = Axis::of(errors.iter().copied());
    let y = Axis::of(times.iter().flat_map(|t| [t.low, t.median, t.high]));
    let places: Vec<_> = errors.iter().zip(&times).map(|(e, t)| (*e, t.median)).collect();
    let front = pareto::front(&places);
    let names: Vec<&str> = front.iter().map(|&i| scene.variants[i].name.as_str()).collect();
    let title = format!("{}: error against {}", scene.name, cost.axis());
    let about = format!(
        "Each mark is a variant; less is better on both axes. Pareto front, from the least error: \
         {}",
        names.join("; ")
    );
    svg(SIZE, &title, &about, |area| {
        let mut chart = axes(area, (&x, "wrong points, %"), (&y, cost.axis()))?;
        chart.draw_series([PathElement::new(steps(&places, &front), INK.mix(0.6))])?;
        let whisker = |i: usize| {
            let (at, times) = (places[i].0, times[i]);
            let ends = [(at, times.low), (at, times.high)];
            PathElement::new(ends, color(&scene.variants[i].method, i).stroke_width(2))
        };
        chart.draw_series((0..places.len()).map(whisker))?;
        // the plan's and the front's marks on top
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.sort_by_key(|i| (scene.variants[*i].role == Role::Plan, front.contains(i)));
        for &i in &order {
            mark(&mut chart, &scene.variants[i], i, places[i], front.contains(&i))?;
        }
        order.reverse();
        order.retain(|i| front.contains(i) || scene.variants[*i].role != Role::Other);
        label(&mut chart, &places, &order)
    })
}

/// From one point of the front to the next, right and then down: what is above is beaten.
fn steps(places: &[(f64, f64)], front: &[usize]) -> Vec<(f64, f64)> {
    let corner = |pair: &[usize]| {
        let (a, b) = (places[pair[0]], places[pair[1]]);
        [(b.0, a.1), b]
    };
    let first = front.first().map(|&i| places[i]);
    first.into_iter().chain(front.windows(2).flat_map(corner)).collect()
}

/// A circle; a square for cubes, a star for the plan's choice.
fn mark(
    chart: &mut Chart<'_, '_>,
    variant: &Variant,
    place: usize,
    at: (f64, f64),
    filled: bool,
) -> Result<(), Fault> {
    let color = color(&variant.method, place);
    let style = if filled { color.filled() } else { color.stroke_width(2) };
    let here = EmptyElement::at(at);
    match variant.role {
        Role::Cube => chart.draw_series([here + Rectangle::new([(-6, -6), (6, 6)], style)])?,
        Role::Other => chart.draw_series([here + Circle::new((0, 0), 6, style)])?,
        Role::Plan => {
            let outline = PathElement::new(star(), INK.stroke_width(1));
            chart.draw_series([here + Polygon::new(star(), color.filled()) + outline])?
        }
    };
    Ok(())
}

/// A star of five corners around (0, 0).
fn star() -> Vec<(i32, i32)> {
    let corner = |i: usize| {
        let (angle, r) = (i as f64 * std::f64::consts::PI / 5.0, [12.0, 5.0][i % 2]);
        ((r * angle.sin()).round() as i32, (-r * angle.cos()).round() as i32)
    };
    (0..=10).map(corner).collect()
}

/// Numbers beside marks, each where no other number and no other mark is; else none.
fn label(chart: &mut Chart<'_, '_>, places: &[(f64, f64)], order: &[usize]) -> Result<(), Fault> {
    const LINE: i32 = 15;
    let pixels: Vec<_> = places.iter().map(|at| chart.backend_coord(at)).collect();
    let (columns, rows) = chart.plotting_area().get_pixel_range();
    let mut taken: Vec<[i32; 4]> =
        pixels.iter().map(|(x, y)| [x - 5, y - 5, x + 5, y + 5]).collect();
    for &i in order {
        let name = (i + 1).to_string();
        let wide = 9 * name.len() as i32;
        let ways =
            [(8, -18), (-8 - wide, -18), (8, 4), (-8 - wide, 4), (-wide / 2, -26), (-wide / 2, 12)];
        let fits = |&(x, y): &(i32, i32)| {
            let (x, y) = (pixels[i].0 + x, pixels[i].1 + y);
            let own = [x, y, x + wide, y + LINE];
            let inside = x >= columns.start
                && own[2] <= columns.end
                && y >= rows.start
                && own[3] <= rows.end;
            let apart =
                |b: &[i32; 4]| own[2] <= b[0] || b[2] <= own[0] || own[3] <= b[1] || b[3] <= own[1];
            (inside && taken.iter().all(apart)).then_some(own)
        };
        let Some((way, own)) = ways.iter().find_map(|way| Some((*way, fits(way)?))) else {
            continue;
        };
        taken.push(own);
        chart.draw_series([EmptyElement::at(places[i]) + Text::new(name, way, text(18))])?;
    }
    Ok(())
}
