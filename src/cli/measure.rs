//! The commands that compare with ray casting: bake, probe, measure.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use dpsm::gpu::Device;
use dpsm::measure::{self, Bench, Judgement, MapError, PenumbraError, Point, ShadowError, Source};
use dpsm::render::{Frame, LARGEST, Lookup};
use dpsm::scalar::depth::dpsm_distance;
use dpsm::scalar::maps::DepthMaps;
use glam::DVec3;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use super::output::{Outputs, print, write_or_print};
use super::setup::{Names, SetupArguments, make_maps};
use super::table::Table;
use super::{AdapterChoice, CliError, describe};

/// Make the maps and write them as EXR, distances in world units
#[derive(Debug, Args)]
#[command(after_help = "\
One layer a hemisphere (`front`, `back`) with the channel `distance`: f32, world units, infinite
where nothing was hit. MAPS.json beside it holds the light's parameters. Nothing is
chosen at random.

Example:
  dpsm bake brabec-room --light=-1,2,0.5 --size 512 -o maps.exr")]
pub struct BakeArguments {
    #[command(flatten)]
    setup: SetupArguments,
    /// The .exr file to write
    #[arg(short, long)]
    output: PathBuf,
    /// Print what was written as JSON
    #[arg(long)]
    json: bool,
}

/// Judge points given in a CSV file: by the maps, and by ray casting
#[derive(Debug, Args)]
#[command(after_help = "\
The input's header is x,y,z or x,y,z,nx,ny,nz: world units, unit normals. One line of output for
each line of input, in its order, with the header
visibility,hemisphere,u,v,stored,own,truth,edge: u and v are disk coordinates in the hemisphere's
map, stored and own distances from the light, truth 1 where ray casting sees the light, edge 1
where the rays over the texel's footprint do not all agree. Nothing is chosen at random.

Example:
  dpsm probe brabec-room --points points.csv --size 512 -o judged.csv")]
pub struct ProbeArguments {
    #[command(flatten)]
    setup: SetupArguments,
    /// The points
    #[arg(long)]
    points: PathBuf,
    /// Write here instead of standard output
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// JSON in place of CSV
    #[arg(long)]
    json: bool,
}

/// Measure a scene's shadows against ray casting
#[derive(Debug, Args)]
#[command(after_help = "\
Map error, shadow error, penumbra error and their sources; docs/measure.md explains each figure.

Examples:
  dpsm measure brabec-room --walls 1 --size 512
  dpsm measure atrium.obj --light 0,4,0 --method fragment-depth --json")]
pub struct MeasureArguments {
    #[command(flatten)]
    setup: SetupArguments,
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

fn prepare(
    adapter: AdapterChoice,
    setup: &SetupArguments,
) -> Result<(String, Frame, DepthMaps, Option<Device>), CliError> {
    let (scene, frame) = setup.frame(IMAGE, Lookup::Pixel, false)?;
    let device = adapter.open()?;
    let spinner = ProgressBar::new_spinner().with_message("maps");
    spinner.enable_steady_tick(std::time::Duration::from_millis(100));
    let maps = make_maps(device.as_ref(), &frame)?;
    spinner.finish_and_clear();
    Ok((scene, frame, maps, device))
}

/// A bar on stderr, where that is a terminal.
fn bar(what: &'static str, steps: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:>14} [{bar:40}] {pos}/{len} {eta}");
    let bar = ProgressBar::new(steps as u64).with_message(what);
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// `dpsm bake`.
pub fn bake(adapter: AdapterChoice, arguments: &BakeArguments) -> Result<(), CliError> {
    let (scene, frame, maps, device) = prepare(adapter, &arguments.setup)?;
    let path = &arguments.output;
    let beside = path.with_extension("json");
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr")) {
        return Err(CliError::Usage(format!(
            "maps are EXR: name {} something.exr",
            path.display()
        )));
    }
    let light = frame.light;
    let vector = |v: dpsm::scalar::float::Vec3<f32>| [v.x, v.y, v.z];
    let names = arguments.setup.names();
    let parameters = serde_json::json!({
        "scene": scene,
        "position": vector(light.position),
        "right": vector(light.right),
        "up": vector(light.up),
        "forward": vector(light.forward),
        "near": light.near,
        "far": light.far,
        "guard": light.guard,
        "size": maps.size,
        "hemispheres": light.hemispheres,
        "format": names.format,
        "method": names.method,
        "filter": names.filter,
        "bias": names.bias,
        "constant_bias": frame.bias,
        "computed_by": describe(device.as_ref()),
    });
    let mut outputs = Outputs::for_option("-o");
    outputs.add(path, &exr_bytes(path, &frame, &maps)?)?;
    outputs.add(&beside, pretty(&parameters)?.as_bytes())?;
    let written = outputs.finish()?;
    if arguments.json {
        return print(&pretty(&serde_json::json!({ "written": written, "light": parameters }))?);
    }
    let mut text =
        format!("{}\n{scene}: {} triangles\n", describe(device.as_ref()), frame.triangles.len());
    for path in written {
        let _ = writeln!(text, "  {}", path.display());
    }
    print(&text)
}

/// The maps as an EXR file, one layer a hemisphere.
fn exr_bytes(path: &Path, frame: &Frame, maps: &DepthMaps) -> Result<Vec<u8>, CliError> {
    use exr::prelude::*;
    let distance = |&depth: &f32| match depth < 1.0 {
        true => dpsm_distance(depth, frame.light.near, frame.light.far),
        false => f32::INFINITY,
    };
    let size = maps.size as usize;
    let layer = |(index, name): (u32, &str)| {
        let samples = maps.layer(index).iter().map(distance).collect();
        let channel = AnyChannel::new("distance", FlatSamples::F32(samples));
        let attributes = LayerAttributes::named(name);
        Layer::new(
            (size, size),
            attributes,
            Encoding::SMALL_LOSSLESS,
            AnyChannels::sort(std::iter::once(channel).collect()),
        )
    };
    let layers: Vec<_> = (0..maps.layers).zip(["front", "back"]).map(layer).collect();
    let bounds = IntegerBounds::from_dimensions((size, size));
    let image = Image::from_layers(ImageAttributes::new(bounds), layers);
    let mut bytes = std::io::Cursor::new(Vec::new());
    image
        .write()
        .to_buffered(&mut bytes)
        .map_err(|error| CliError::Exr { path: path.into(), message: error.to_string() })?;
    Ok(bytes.into_inner())
}

/// `dpsm probe`.
pub fn probe(adapter: AdapterChoice, arguments: &ProbeArguments) -> Result<(), CliError> {
    let given = read_points(&arguments.points)?;
    let (_, frame, maps, device) = prepare(adapter, &arguments.setup)?;
    eprintln!("dpsm: {}", describe(device.as_ref()));
    let truth = measure::truth_of(&frame);
    let bench = Bench::new(&frame, &maps, &truth);
    let progress = bar("points", given.len());
    let judge = |&(position, normal): &(DVec3, Option<DVec3>)| {
        progress.inc(1);
        measure::judge(&bench, &bench.point_at(position, normal))
    };
    let judged: Vec<Judgement> = given.iter().map(judge).collect();
    progress.finish_and_clear();
    let (near, far) = (bench.light.near, bench.light.far);
    let outside = judged.iter().filter(|j| !(near..=far).contains(&j.own)).count();
    if outside > 0 {
        eprintln!(
            "dpsm: {outside} points lie inside near {near} or beyond far {far}: compared at the sphere"
        );
    }
    let text = match arguments.json {
        true => pretty(&judged.iter().map(row).collect::<Vec<_>>())?,
        false => {
            let mut text = String::from("visibility,hemisphere,u,v,stored,own,truth,edge\n");
            for judgement in &judged {
                let Row { visibility, hemisphere, u, v, stored, own, truth, edge } = row(judgement);
                let stored = stored.unwrap_or(f64::INFINITY);
                let _ = writeln!(
                    text,
                    "{visibility},{hemisphere},{u},{v},{stored},{own},{truth},{edge}"
                );
            }
            text
        }
    };
    write_or_print(arguments.output.as_deref(), &text)
}

/// One line of `dpsm probe`.
#[derive(Serialize)]
struct Row {
    visibility: f32,
    hemisphere: u32,
    u: f64,
    v: f64,
    /// `None` (null) where the texel is empty: JSON has no infinity.
    stored: Option<f64>,
    own: f64,
    truth: u8,
    edge: u8,
}

fn row(judgement: &Judgement) -> Row {
    Row {
        visibility: judgement.visibility,
        hemisphere: judgement.hemisphere,
        u: judgement.uv[0],
        v: judgement.uv[1],
        stored: judgement.stored.is_finite().then_some(judgement.stored),
        own: judgement.own,
        truth: judgement.lit.into(),
        edge: judgement.edge.into(),
    }
}

/// Positions, with normals where the header has them.
fn read_points(path: &Path) -> Result<Vec<(DVec3, Option<DVec3>)>, CliError> {
    let table = Table::read(path)?;
    let fault = |line: u64, message: String| CliError::Csv { path: path.into(), line, message };
    let names = ["x", "y", "z", "nx", "ny", "nz"];
    let header: Vec<&str> = table.header.iter().map(String::as_str).collect();
    if header != names[..3] && header != names {
        let found = header.join(",");
        let message = format!("the header is `{found}`, and must be x,y,z or x,y,z,nx,ny,nz");
        return Err(fault(1, message));
    }
    let mut points = Vec::new();
    for (line, record) in table.records {
        let mut numbers = [0.0; 6];
        for ((field, name), number) in record.iter().zip(names).zip(&mut numbers) {
            // as for the light: beyond it squares of distances overflow f32
            let usable = |value: &f64| value.abs() <= f64::from(LARGEST);
            let parsed: Option<f64> = field.parse().ok().filter(usable);
            *number = parsed.ok_or_else(|| {
                let range = "is not a finite number up to 1e18";
                fault(line, format!("column `{name}`: `{field}` {range}"))
            })?;
        }
        let [x, y, z, nx, ny, nz] = numbers;
        let normal = match header.len() {
            6 => {
                let normal = DVec3::new(nx, ny, nz);
                if (normal.length() - 1.0).abs() > 1e-3 {
                    let message =
                        format!("columns `nx,ny,nz`: the normal {normal} is not a unit one");
                    return Err(fault(line, message));
                }
                Some(normal.normalize())
            }
            _ => None,
        };
        points.push((DVec3::new(x, y, z), normal));
    }
    Ok(points)
}

/// Everything that `dpsm measure` finds.
#[derive(Serialize)]
struct Report {
    scene: String,
    computed_by: String,
    triangles: usize,
    size: u32,
    options: Names,
    constant_bias: f32,
    seed: u64,
    map: MapError,
    shadow: ShadowError,
    penumbra: PenumbraError,
    sources: Vec<Source>,
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
    let map = measure::map_error(&bench, || progress.inc(1));
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
    let report = Report {
        scene,
        computed_by: describe(device.as_ref()),
        triangles: frame.triangles.len(),
        size: maps.size,
        options: arguments.setup.names(),
        constant_bias: frame.bias,
        seed: arguments.seed,
        map,
        shadow,
        penumbra,
        sources,
        meshes: frame.meshes.iter().map(by_mesh).collect(),
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
    let Names { format, method, filter, bias } = options;
    let _ = writeln!(text, "{computed_by}");
    let _ = writeln!(
        text,
        "{scene}: {triangles} triangles, {size} x {size}, {format}, {method}, {filter}, {bias} bias {constant_bias}"
    );
    let _ = writeln!(
        text,
        "\nmap error (of the distance)\n{:<10}{:>10}{:>10}{:>9}{:>8}{:>9}{:>9}{:>11}{:>11}",
        "", "texels", "covered", "missing", "extra", "> 1%", "> 0.1%", "99th", "largest"
    );
    let MapError { all, rim, centre } = &report.map;
    for (name, band) in [("all", all), ("r > 0.9", rim), ("r <= 0.9", centre)] {
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
         the penumbra",
        p.cone_texels, p.rmse, p.points, p.penumbra_rmse, p.penumbra_points
    );
    let _ = writeln!(text, "\n{:<18}{:>13}{:>13}  unit", "source", "measured", "predicted");
    for source in &report.sources {
        let Source { name, measured, predicted, unit, place } = source;
        let at = if place.is_empty() { String::new() } else { format!(", at {place}") };
        let predicted = predicted.map_or("-".into(), |predicted| format!("{predicted:.4e}"));
        let _ = writeln!(text, "{name:<18}{measured:>13.4e}{predicted:>13}  {unit}{at}");
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

fn pretty(value: &impl Serialize) -> Result<String, CliError> {
    let text = serde_json::to_string_pretty(value);
    text.map(|text| text + "\n").map_err(|error| CliError::Usage(format!("no JSON: {error}")))
}
