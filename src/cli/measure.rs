//! `dpsm measure`: a scene's shadows against ray casting.

mod text;

use clap::Args;
use dpsm::gpu::Device;
use dpsm::measure::{
    self, Bench, MapError, PenumbraError, PictureError, Point, SeenError, ShadowError, SoftError,
    Source,
};
use dpsm::render::{Filter, Frame, Projection, Settings};
use dpsm::scalar::maps::DepthMaps;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use super::number::{whole, whole32};
use super::output::print;
use super::setup::{Names, SetupArguments, make_maps};
use super::{AdapterChoice, CliError, describe};

/// Measure a scene's shadows against ray casting
#[derive(Debug, Args)]
#[command(after_help = "\
What is wrong, acne and leaks first, then the errors of shadows, penumbrae and maps, and their sources;
docs/measure.md explains each figure.
Refined maps are judged with the tolerance that they are made with, --tau, and all others with 0: a
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
    #[arg(long, default_value_t = 20_000, value_parser = whole32::<1, 10_000_000>)]
    count: u32,
    /// Scatter the points over all surfaces in place of those that the camera sees
    #[arg(long)]
    scatter: bool,
    /// Chooses the points; the same seed chooses the same ones
    #[arg(long, value_parser = whole::<0, { u64::MAX }>, default_value_t = 1)]
    seed: u64,
    /// Pixels along the width of the picture of which every pixel is judged, its height three quarters
    /// of it; 0 for none; by default 480, or 160 where rays to a spherical light are the truth
    #[arg(long, value_name = "PIXELS", value_parser = whole32::<0, 8192>)]
    picture: Option<u32>,
    /// JSON in place of a table
    #[arg(long)]
    json: bool,
}

/// Widths of the picture, by the truth's kind.
const HARD_PICTURE: u32 = 480;
const SOFT_PICTURE: u32 = 160;

/// The errors of all pixels; none of a picture without any.
fn picture(bench: &Bench<'_>, width: Option<u32>) -> Option<PictureError> {
    let (usual, threshold) = match bench.frame.settings.filter {
        Filter::Single | Filter::Naive(_) => (HARD_PICTURE, measure::WRONG_HARD),
        _ => (SOFT_PICTURE, measure::WRONG_SOFT),
    };
    let width = width.unwrap_or(usual);
    let size = [width, width * IMAGE[1] / IMAGE[0]];
    let seen = bench.points_of_grid(size);
    let progress = bar("pixels", seen.len());
    let errors = measure::errors_of_image(bench, &seen, width, || progress.inc(1));
    progress.finish_and_clear();
    (!errors.is_empty()).then(|| measure::picture_error(&errors, width, threshold))
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
    setup.frame(Settings { image: IMAGE, ..Settings::default() })
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
    seen: SeenError,
    /// None where no picture is asked for.
    picture: Option<PictureError>,
    /// None for filters that stand for no spherical light.
    soft: Option<SoftError>,
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
    let progress = bar("surroundings", points.len());
    let around = measure::surroundings_of(&bench, &points, || progress.inc(1));
    progress.finish_and_clear();
    let seen = measure::seen_error(&bench, &points, &around);
    let picture = picture(&bench, arguments.picture);
    let progress = bar("soft shadows", points.len());
    let soft = measure::soft_error(&bench, &points, || progress.inc(1));
    progress.finish_and_clear();
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
        seen,
        picture,
        soft,
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
        false => print(&text::table(&report)),
    }
}

/// A value as JSON.
pub fn pretty(value: &impl Serialize) -> Result<String, CliError> {
    let text = serde_json::to_string_pretty(value);
    text.map(|text| text + "\n").map_err(|error| CliError::Usage(format!("no JSON: {error}")))
}
