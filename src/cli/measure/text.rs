//! What `dpsm measure` prints.

use std::fmt::Write;

use dpsm::measure::{MapError, SoftError, Source};

use super::super::setup::Names;
use super::{MeshSources, Report};

/// The whole: first what a person sees, then the maps, and what explains the errors.
pub fn table(report: &Report) -> String {
    let mut text = String::new();
    head(report, &mut text);
    seen(report, &mut text);
    points(report, &mut text);
    maps(report, &mut text);
    sources(report, &mut text);
    text
}

fn share(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole.max(1) as f64
}

fn head(report: &Report, text: &mut String) {
    let Report { scene, computed_by, triangles, size, options, constant_bias, .. } = report;
    let Names { format, method, filter, bias, .. } = options;
    let constant = constant_bias.map_or(String::new(), |bias| format!(" {bias}"));
    let _ = writeln!(text, "{computed_by}");
    let _ = writeln!(
        text,
        "{scene}: {triangles} triangles, {size} x {size}, {format}, {method}, {filter}, {bias} bias{constant}"
    );
}

/// Acne, leaks and all that is wrong.
fn seen(report: &Report, text: &mut String) {
    let s = &report.seen;
    let _ = writeln!(
        text,
        "\nwrong {:.3}% of {} points, nothing excused; RMSE {:.4}\n  \
         {:.3}% on sides of solids turned away from the light, which shading leaves dark\n  \
         acne {:.3}% of {} smoothly lit points, mean darkness {:.3}%\n  \
         leak {:.3}% of {} points deep in shadow, mean light {:.3}%",
        100.0 * s.wrong_share(),
        s.points,
        s.rmse,
        share(s.wrong_turned_away, s.points),
        100.0 * s.acne_share(),
        s.smoothly_lit,
        100.0 * s.acne_mean,
        100.0 * s.leak_share(),
        s.deep_in_shadow,
        100.0 * s.leak_mean
    );
    soft(report, text);
    let Some(p) = &report.picture else { return };
    let [width, height] = p.size;
    let _ = writeln!(
        text,
        "  picture of {width} x {height}: {:.3}% of {} pixels off by more than {}, RMSE {:.4}; the \
         largest patch of them {}, dots {}",
        100.0 * p.wrong_share(),
        p.pixels,
        p.threshold,
        p.rmse,
        p.largest_patch,
        p.dots
    );
}

/// Against rays to a spherical light.
fn soft(report: &Report, text: &mut String) {
    let Some(SoftError { radius, all, facing, creases, elsewhere }) = &report.soft else { return };
    let _ = writeln!(text, "soft, against rays to a light of radius {radius:.4}:");
    let rows =
        [("all", all), ("facing", facing), ("at creases", creases), ("elsewhere", elsewhere)];
    for (name, figures) in rows {
        let _ = writeln!(
            text,
            "  {name:<11}RMSE {:.4} of {} points; {} fully lit, mean darkness {:.3}%; {} in the \
             umbra, mean light {:.3}%",
            figures.rmse,
            figures.points,
            figures.fully_lit,
            100.0 * figures.darkness,
            figures.umbra,
            100.0 * figures.light
        );
    }
}

fn points(report: &Report, text: &mut String) {
    let s = &report.shadow;
    let _ = writeln!(
        text,
        "\nshadow error at {} points, {} of them edge points, {} outside near or far, {} where the \
         light has no map\n  \
         misclassified {} ({:.3}%): false shadow {}, false light {}\n  \
         faults (not at edges) {}: false shadow {}, false light {}; contact gap {:.4e}\n  \
         {} within 32 texels of the true edge: median {:.2}, largest {:.2} texels, {:.2e} rad\n  \
         seam band: {} of {} misclassified",
        s.points,
        s.edge_points,
        s.outside_spheres,
        s.unmapped,
        s.misclassified(),
        share(s.misclassified(), s.points),
        s.false_shadow,
        s.false_light,
        s.faults(),
        s.faults_shadow,
        s.faults_light,
        s.contact_gap,
        s.near_edge,
        s.edge_texels_median,
        s.edge_texels_largest,
        s.edge_radians_largest,
        s.seam_misclassified,
        s.seam_points
    );
    let p = &report.penumbra;
    let _ = writeln!(
        text,
        "\npenumbra error (cone of {:.2} texels): RMSE {:.4} over {} points, {:.4} over the {} in \
         the penumbra\n  \
         seam band: {:.4} over {} of these, interior {:.4}, ratio {:.3}",
        p.cone_texels,
        p.rmse,
        p.points,
        p.penumbra_rmse,
        p.penumbra_points,
        p.seam_rmse,
        p.seam_points,
        p.interior_rmse,
        p.seam_rmse / p.interior_rmse.max(f64::MIN_POSITIVE)
    );
}

fn maps(report: &Report, text: &mut String) {
    let _ = writeln!(
        text,
        "\nmap error (of the distance)\n{:<10}{:>10}{:>10}{:>9}{:>8}{:>9}{:>9}{:>11}{:>11}",
        "", "texels", "covered", "missing", "extra", "> 1%", "> 0.1%", "99th", "largest"
    );
    let MapError { tau, all, rim, centre, worst } = &report.map;
    let tau = *tau as f32; // as it was given
    let bands = [("all", all), ("r > 0.9", rim), ("r <= 0.9", centre)];
    for (name, band) in bands {
        let _ = writeln!(
            text,
            "{name:<10}{:>10}{:>10}{:>9}{:>8}{:>8.2}%{:>8.2}%{:>11.2e}{:>11.2e}",
            band.texels,
            band.covered,
            band.missing,
            band.extra,
            share(band.off_1e2, band.covered),
            share(band.off_1e3, band.covered),
            band.percentile_99,
            band.largest
        );
    }
    let _ = writeln!(
        text,
        "\nmap faults (> 0.1%, missing or extra, no silhouette within {tau} texel)\n\
         {:<10}{:>10}{:>10}{:>9}{:>8}{:>10}{:>21}",
        "", "faults", "> 0.1%", "holes", "extra", "excused", "largest of the rest"
    );
    for (name, band) in bands {
        let _ = writeln!(
            text,
            "{name:<10}{:>10}{:>10}{:>9}{:>8}{:>10}{:>21.2e}",
            band.faults(),
            band.faults_off,
            band.holes,
            band.faults_extra,
            band.excused,
            band.largest_rest
        );
    }
    if let Some(worst) = worst {
        let [u, v] = worst.uv;
        let _ = writeln!(
            text,
            "  worst: layer {}, texel ({}, {}), place ({u:.6}, {v:.6}): stored {:.7}, true {:.7}, off by \
             {:.2e}; incidence {:.2} degrees, eps tan {:.1e}",
            worst.layer,
            worst.x,
            worst.y,
            worst.stored,
            worst.hit,
            worst.error,
            worst.incidence.to_degrees(),
            worst.conditioning
        );
    }
}

fn sources(report: &Report, text: &mut String) {
    let _ = writeln!(text, "\n{:<18}{:>13}{:>13}  unit", "source", "measured", "predicted");
    for source in &report.sources {
        let Source { name, measured, predicted, unit, place } = source;
        let at = if place.is_empty() { String::new() } else { format!(", at {place}") };
        let predicted = predicted.map_or("-".into(), |predicted| format!("{predicted:.4e}"));
        let _ = writeln!(text, "{name:<18}{measured:>13.4e}{predicted:>13}  {unit}{at}");
    }
    if report.meshes.is_empty() {
        return;
    }
    if report.meshes_as != report.options.method {
        let _ = writeln!(text, "\nwhat the {} method would do to these meshes:", report.meshes_as);
    }
    let _ = writeln!(
        text,
        "\n{:<26}{:>10}{:>9}{:>15}{:>11}{:>15}{:>12}",
        "mesh", "triangles", "left out", "bow in texels", "predicted", "affine", "predicted"
    );
    for MeshSources { mesh, triangles, left_out, bowed_edges, affine_depth } in &report.meshes {
        let percent = |share: f64| format!("{:.2}%", 100.0 * share);
        let texels = |bow: f64| format!("{bow:.3}");
        let or_none =
            |value: Option<f64>, show: &dyn Fn(f64) -> String| value.map_or("-".to_string(), show);
        let _ = writeln!(
            text,
            "{mesh:<26}{triangles:>10}{left_out:>9}{:>15}{:>11}{:>15}{:>12}",
            texels(bowed_edges.measured),
            or_none(bowed_edges.predicted, &texels),
            percent(affine_depth.measured),
            or_none(affine_depth.predicted, &percent)
        );
    }
}
