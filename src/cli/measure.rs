//! `dpsm measure`: a scene's shadows against ray casting.

use std::fmt::Write;

use clap::Args;
use dpsm::gpu::Device;
use dpsm::measure::{self, Bench, MapError, PenumbraError, Point, ShadowError, Source};
use dpsm::render::{Frame, Lookup, Projection};
use dpsm::scalar::maps::DepthMaps;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use super::output::print;
use super::setup::{Names, SetupArguments, make_maps};
use super::{AdapterChoice, CliError, describe};

/// Measure a scene's shadows against ray casting
#[derive(Debug, Args)]
#[command(after_help = "\
Map error, shadow error, penumbra error and their sources; docs/measure.md explains each figure.
Hybrid maps are judged with the tolerance that they are made with, --tau, and all others with 0: a
silhouette so many texels outside a texel excuses its error.

Examples:
  dpsm measure brabec-room --walls 1 --size 512
  dpsm measure brabec-room --walls 1 --size 512 --method cube
  dpsm measure cornell --tau 0.05
  dpsm measure atrium.obj --light 0,4,0 --method fragment-depth --json")]
pub struct MeasureArguments {
    #[command(flatten)]
    pub setup: SetupArguments,
    /// Surface points to judge
    #[arg(long, default_value_t = 20_000, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    count: u32,
    /// Scatter the points over all surfaces in place of those that the camera sees
    #[arg(long)]
    scatter: bool,
    /// Chooses the points; the same seed chooses the same ones
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// JSON in place of a table
    #[arg(long)]
    json: bool,
}

/// Width and height of the image whose camera chooses points.
const IMAGE: [u32; 2] = [960, 720];

/// The scene's frame, its maps, and the adapter that made them.
pub fn prepare(
    adapter: AdapterChoice,
    setup: &SetupArguments,
) -> Result<(String, Frame, DepthMaps, Option<Device>), CliError> {
    let (scene, frame) = framed(setup)?;
    let device = adapter.open()?;
    let spinner = ProgressBar::new_spinner().with_message("maps");
    spinner.enable_steady_tick(std::time::Duration::from_millis(100));
    let maps = make_maps(device.as_ref(), &frame)?;
    spinner.finish_and_clear();
    Ok((scene, frame, maps, device))
}

/// The scene's name and frame, where no image is rendered.
pub fn framed(setup: &SetupArguments) -> Result<(String, Frame), CliError> {
    setup.frame(IMAGE, Lookup::Pixel, false)
}

/// A bar on stderr, where that is a terminal.
pub fn bar(what: &'static str, steps: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:>14} [{bar:40}] {pos}/{len} {eta}");
    let bar = ProgressBar::new(steps as u64).with_message(what);
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// Everything that `dpsm measure` finds.
#[derive(Serialize)]
struct Report {
    scene: String,
    computed_by: String,
    triangles: usize,
    size: u32,
    options: Names,
    /// In units of depth, where it is the bias.
    constant_bias: Option<f32>,
    seed: u64,
    map: MapError,
    shadow: ShadowError,
    penumbra: PenumbraError,
    sources: Vec<Source>,
    /// The method whose errors `meshes` are: this one, or what `vertex` would do in its place.
    meshes_as: String,
    /// Empty for a cube, which has no disk.
    meshes: Vec<MeshSources>,
}

/// What straight edges and affine depth do to one mesh.
#[derive(Serialize)]
struct MeshSources {
    mesh: String,
    triangles: usize,
    /// Triangles that cross a stored disk's border: not in the two sources below.
    left_out: usize,
    bowed_edges: Source,
    affine_depth: Source,
}

/// `dpsm measure`.
pub fn measure(adapter: AdapterChoice, arguments: &MeasureArguments) -> Result<(), CliError> {
    let (scene, frame, maps, device) = prepare(adapter, &arguments.setup)?;
    let truth = measure::truth_of(&frame);
    let bench = Bench::new(&frame, &maps, &truth);
    let points: Vec<Point> = match arguments.scatter {
        true => bench.points_scattered(arguments.count as usize, arguments.seed),
        false => bench.points_from_camera(arguments.count as usize, arguments.seed),
    };
    if points.len() < arguments.count as usize {
        let (seen, asked) = (points.len(), arguments.count);
        eprintln!("dpsm: the camera sees surfaces through {seen} of {asked} places of the image");
    }
    let progress = bar("map rows", (maps.size * maps.layers) as usize);
    let [tau, _] = frame.settings.tolerances();
    let map = measure::map_error(&bench, tau.into(), || progress.inc(1));
    progress.finish_and_clear();
    let progress = bar("points", points.len());
    let shadow = measure::shadow_error(&bench, &points, || progress.inc(1));
    progress.finish_and_clear();
    let progress = bar("cones", points.len());
    let penumbra = measure::penumbra_error(&bench, &points, || progress.inc(1));
    progress.finish_and_clear();
    let sources = measure::attribute(&bench, &points, &penumbra);
    let by_mesh = |(name, triangles): &(String, std::ops::Range<u32>)| MeshSources {
        mesh: name.clone(),
        triangles: triangles.len(),
        left_out: measure::left_out(&bench, triangles.clone()),
        bowed_edges: measure::bowed_edges(&bench, triangles.clone()),
        affine_depth: measure::affine_depth(&bench, triangles.clone()),
    };
    let options = Names::of(&frame.settings);
    let meshes_as = match measure::draws_straight(frame.settings.method) {
        true => options.method.clone(),
        false => "vertex".to_string(),
    };
    let report = Report {
        scene,
        computed_by: describe(device.as_ref()),
        triangles: frame.triangles.len(),
        size: maps.size,
        options,
        constant_bias: frame.constant_bias(),
        seed: arguments.seed,
        map,
        shadow,
        penumbra,
        sources,
        meshes_as,
        meshes: match bench.projection {
            Projection::Paraboloid => frame.meshes.iter().map(by_mesh).collect(),
            Projection::Cube => Vec::new(),
        },
    };
    match arguments.json {
        true => print(&pretty(&report)?),
        false => print(&table(&report)),
    }
}

fn table(report: &Report) -> String {
    let share = |part: usize, whole: usize| 100.0 * part as f64 / whole.max(1) as f64;
    let mut text = String::new();
    let Report { scene, computed_by, triangles, size, options, constant_bias, .. } = report;
    let Names { format, method, filter, bias, .. } = options;
    let constant = constant_bias.map_or(String::new(), |bias| format!(" {bias}"));
    let _ = writeln!(text, "{computed_by}");
    let _ = writeln!(
        text,
        "{scene}: {triangles} triangles, {size} x {size}, {format}, {method}, {filter}, {bias} bias{constant}"
    );
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
    let _ = writeln!(text, "\n{:<18}{:>13}{:>13}  unit", "source", "measured", "predicted");
    for source in &report.sources {
        let Source { name, measured, predicted, unit, place } = source;
        let at = if place.is_empty() { String::new() } else { format!(", at {place}") };
        let predicted = predicted.map_or("-".into(), |predicted| format!("{predicted:.4e}"));
        let _ = writeln!(text, "{name:<18}{measured:>13.4e}{predicted:>13}  {unit}{at}");
    }
    if report.meshes.is_empty() {
        return text;
    }
    if report.meshes_as != *method {
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
    text
}

/// A value as JSON.
pub fn pretty(value: &impl Serialize) -> Result<String, CliError> {
    let text = serde_json::to_string_pretty(value);
    text.map(|text| text + "\n").map_err(|error| CliError::Usage(format!("no JSON: {error}")))
}
