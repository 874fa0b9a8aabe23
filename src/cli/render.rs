//! The commands that make pictures.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use dpsm::gpu::Device;
use dpsm::render::{Frame, Lookup, Rendering, Settings, float};
use dpsm::{measure, scene};
use glam::DVec3;

use super::number::{ANY, whole32};
use super::output::{Outputs, print};
use super::setup::{self, SetupArguments};
use super::{AdapterChoice, CliError, describe};

/// Render a scene lit by a point light, its shadows from paraboloid maps or a cube's
#[derive(Debug, Args)]
#[command(after_help = after_help())]
pub struct RenderArguments {
    #[command(flatten)]
    setup: SetupArguments,
    /// The picture to write, a .png file
    #[arg(short, long)]
    output: PathBuf,
    /// Where receivers find their texture coordinates
    #[arg(long, value_enum, default_value = "pixel")]
    lookup: LookupName,
    /// Width and height of the picture
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "960x720")]
    image: [u32; 2],
    /// N x N samples a pixel, each with a shadow test of its own: 1 to 8
    #[arg(long, value_name = "N", value_parser = whole32::<0, ANY>, default_value_t = Settings::default().samples)]
    samples: u32,
    /// The factor on linear light; by default such that at most 0.5% of the pixels are too bright to
    /// show, and 2 at most
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true)]
    exposure: Option<f32>,
    /// Test shadows on the flat triangles, not on the curved surface that the normals suggest: so the
    /// edges of coarse meshes show in their shadows
    #[arg(long)]
    no_terminator: bool,
    /// Also write the picture by rays in place of maps, to compare with: to the light as a point, or to
    /// the sphere that the filter stands for
    #[arg(long)]
    rays: bool,
    /// Also write the shadow maps and what the light sees of each hemisphere or face
    #[arg(long)]
    maps: bool,
}

fn after_help() -> String {
    let mut text = String::from("Built-in scenes:\n");
    for (name, about) in scene::BUILT_IN {
        let _ = writeln!(text, "  {name:<16}{about}");
    }
    text.push_str(
        "\nExamples:\n  \
         dpsm render brabec-room --maps -o room.png\n  \
         dpsm render brabec-room --light=-1,2,0.5 --walls 1 --method vertex -o bowed.png\n  \
         dpsm render brabec-room --method cube --maps -o cube.png\n  \
         dpsm render cornell --method tessellated --level 8 -o subdivided.png\n  \
         dpsm render brabec-ceiling --size 512 --format d16 -o ceiling.png\n  \
         dpsm render cornell --method fragment-depth --filter hardware -o cornell.png\n  \
         dpsm render atrium.glb --light 0,4,0 --adapter cpu -o atrium.png",
    );
    text
}

/// Lookups by their option names.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum LookupName {
    Pixel,
    Vertex,
}

/// Parses `960x720`.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let number = whole32::<0, ANY>;
    let (width, height) = text.split_once('x').ok_or("expected WIDTHxHEIGHT, as in 960x720")?;
    Ok([number(width)?, number(height)?])
}

/// The scene's name and frame, checked before anything is opened or rendered.
pub fn framed(arguments: &RenderArguments) -> Result<(String, Frame), CliError> {
    if !arguments.output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
    {
        let output = arguments.output.display();
        return Err(CliError::Usage(format!("pictures are PNG: name {output} something.png")));
    }
    let lookup = match arguments.lookup {
        LookupName::Pixel => Lookup::Pixel,
        LookupName::Vertex => Lookup::Vertex,
    };
    let RenderArguments { image, samples, exposure, maps: views, .. } = *arguments;
    let terminator = !arguments.no_terminator;
    let base =
        Settings { image, lookup, samples, exposure, terminator, views, ..Settings::default() };
    match lookup {
        Lookup::Pixel => arguments.setup.softened().frame(base),
        Lookup::Vertex => arguments.setup.frame(base),
    }
}

/// `dpsm render`.
pub fn render(adapter: AdapterChoice, arguments: &RenderArguments) -> Result<(), CliError> {
    let (scene, frame) = framed(arguments)?;
    let mut outputs = Outputs::for_option("-o");
    outputs.check(&arguments.output)?;
    let device = adapter.open()?;
    let picture = picture(device.as_ref(), &scene, &frame, arguments, &mut outputs)?;
    finish(format!("{}\n{picture}", describe(device.as_ref())), outputs)
}

/// Renders one picture and its companions into the outputs, and reports on it.
fn picture(
    device: Option<&Device>,
    scene: &str,
    frame: &Frame,
    arguments: &RenderArguments,
    outputs: &mut Outputs,
) -> Result<String, CliError> {
    let output = &arguments.output;
    let rendering = setup::render(device, frame)?;
    outputs.add_picture(output, &rendering.lit)?;
    if arguments.rays {
        let by_rays = measure::picture_by_rays(frame).picture(rendering.exposure);
        outputs.add_picture(&beside(output, "rays"), &by_rays)?;
    }
    companions(frame, &rendering, output, outputs)?;
    let mut report = format!("{scene}: {} triangles\n", frame.triangles.len());
    let light = option("light", frame.in_file(frame.light.position));
    let [camera, target] = [("camera", frame.view.eye), ("look-at", frame.view.target())]
        .map(|(name, point)| option(name, frame.in_file(float(point))));
    let _ = writeln!(report, "  {light} {camera} {target} --exposure {}", rendering.exposure);
    for (pass, time) in &rendering.timings {
        let _ = writeln!(report, "  {pass:<12}{:9.3} ms", time.as_secs_f64() * 1e3);
    }
    Ok(report)
}

/// An option of a point, ready to be pasted: up to six decimals, as f32 has no more to give.
fn option(name: &str, point: DVec3) -> String {
    let [x, y, z] = point.to_array().map(|c| (c * 1e6).round() / 1e6);
    format!("--{name}={x},{y},{z}")
}

/// Moves the outputs to their places and prints the report with their names.
fn finish(mut report: String, outputs: Outputs) -> Result<(), CliError> {
    report.push_str("written:\n");
    for path in outputs.finish()? {
        let _ = writeln!(report, "  {}", path.display());
    }
    print(&report)
}

/// A companion's place beside the main picture.
fn beside(output: &Path, kind: &str) -> PathBuf {
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    output.with_file_name(format!("{stem}-{kind}.png"))
}

/// Adds the maps as grey pictures and the light's views beside the main picture.
fn companions(
    frame: &Frame,
    rendering: &Rendering,
    output: &Path,
    outputs: &mut Outputs,
) -> Result<(), CliError> {
    let names = frame.settings.method.projection().names();
    if let Some(maps) = &rendering.maps {
        for (layer, name) in (0..maps.layers).zip(names) {
            outputs
                .add_picture(&beside(output, &format!("{name}-map")), &frame.grey(maps, layer))?;
        }
    }
    for (view, name) in rendering.views.iter().zip(names) {
        outputs.add_picture(&beside(output, &format!("{name}-view")), view)?;
    }
    Ok(())
}
