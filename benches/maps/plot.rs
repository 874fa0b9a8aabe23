//! A plot of some curves, both axes logarithmic, as SVG in docs/pictures.

use plotters::prelude::*;

/// Curves of (value, milliseconds).
pub struct Plot<'a> {
    pub title: &'a str,
    pub axis: &'a str,
    pub curves: Vec<(&'a str, Vec<(f64, f64)>)>,
}

/// Colours that those who see few can tell apart (Okabe and Ito).
const COLORS: [RGBColor; 5] = [
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
];

pub fn draw(file: &str, plot: &Plot<'_>) {
    let path = format!("{}/docs/pictures/{file}", env!("CARGO_MANIFEST_DIR"));
    match drawn(&path, plot) {
        Ok(()) => println!("\nplot: docs/pictures/{file}"),
        Err(error) => println!("\nno plot: {path}: {error}"),
    }
}

fn drawn(path: &str, plot: &Plot<'_>) -> Result<(), Box<dyn std::error::Error>> {
    let points = || plot.curves.iter().flat_map(|(_, points)| points);
    let range = |of: fn(&(f64, f64)) -> f64, slack: f64| {
        let low = points().map(of).fold(f64::INFINITY, f64::min);
        let high = points().map(of).fold(0.0, f64::max);
        (low / slack..high * slack).log_scale()
    };
    let area = SVGBackend::new(path, (720, 440)).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(plot.title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(58)
        .build_cartesian_2d(range(|p| p.0, 1.1), range(|p| p.1, 1.3))?;
    chart.configure_mesh().x_desc(plot.axis).y_desc("ms (software adapter)").draw()?;
    for ((name, points), color) in plot.curves.iter().zip(COLORS) {
        let style = color.stroke_width(2);
        chart
            .draw_series(LineSeries::new(points.iter().copied(), style))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK)
        .draw()?;
    area.present()?;
    Ok(())
}
