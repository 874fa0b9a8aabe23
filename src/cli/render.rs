//! The commands that make pictures.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use dpsm::gpu::{self, Device};
use dpsm::render::{Format, Frame, Lookup, Method, Picture, Rendering, Settings};
use dpsm::scalar::maps::DepthMaps;
use dpsm::scene::{self, Camera, Light, Scene};
use dpsm::{cpu, scene::Options};
use glam::Vec3;

use super::output::{Outputs, print};
use super::{AdapterChoice, CliError, describe, parse_vector};

/// Render a scene lit by a point light, its shadows from paraboloid maps
#[derive(Debug, Args)]
#[command(after_help = after_help())]
pub struct RenderArguments {
    /// A built-in scene, or a .obj, .gltf or .glb file
    scene: String,
    /// The picture to write (PNG)
    #[arg(short, long)]
    output: PathBuf,
    /// The light's position; by default the scene's own light
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    light: Option<Vec3>,
    /// A hemispherical light: one map, the other half always in shadow
    #[arg(long)]
    hemisphere: bool,
    /// The light's main axis; by default the light's own, or down
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    axis: Option<Vec3>,
    /// Texels along a side of a map
    #[arg(long, default_value_t = 1024)]
    size: u32,
    /// Storage of the maps
    #[arg(long, value_enum, default_value = "d32")]
    format: FormatName,
    /// How the maps are made
    #[arg(long, value_enum, default_value = "vertex")]
    method: MethodName,
    /// Where receivers find their texture coordinates
    #[arg(long, value_enum, default_value = "pixel")]
    lookup: LookupName,
    /// Near sphere's radius in world units
    #[arg(long)]
    near: Option<f32>,
    /// Far sphere's radius in world units
    #[arg(long)]
    far: Option<f32>,
    /// Constant bias in units of depth; by default what 45 degrees incidence needs
    #[arg(long)]
    bias: Option<f32>,
    /// Quads along a side of a built-in room's wall; 1 gives two triangles
    #[arg(long, default_value_t = Options::default().walls)]
    walls: u32,
    /// The camera's position
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    camera: Option<Vec3>,
    /// The point that the camera looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    look_at: Option<Vec3>,
    /// Width and height of the picture
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "960x720")]
    image: [u32; 2],
    /// Also write the shadow maps and what the light sees of each hemisphere
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
         dpsm render brabec-ceiling --size 512 --format d16 -o ceiling.png\n  \
         dpsm render cornell --light=-0.1,0.4,0.2 --method fragment-depth -o cornell.png\n  \
         dpsm render atrium.glb --light 0,4,0 --adapter cpu -o atrium.png",
    );
    text
}

/// Formats by their option names.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum FormatName {
    D16,
    D24,
    D32,
}

/// Methods by their option names, the planned ones included.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum MethodName {
    Vertex,
    FragmentDepth,
    Tessellated,
    Exact,
    Hybrid,
    Cube,
}

/// Lookups by their option names.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum LookupName {
    Pixel,
    Vertex,
}

impl MethodName {
    fn method(self) -> Result<Method, CliError> {
        match self {
            MethodName::Vertex => Ok(Method::Vertex),
            MethodName::FragmentDepth => Ok(Method::FragmentDepth),
            planned => Err(CliError::NotBuilt {
                option: "--method",
                value: planned.to_possible_value().map_or(String::new(), |v| v.get_name().into()),
                built: "vertex, fragment-depth",
            }),
        }
    }
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.parse().map_err(|_| format!("`{text}` is not a whole number"));
    let (width, height) = text.split_once('x').ok_or("expected WIDTHxHEIGHT, as in 960x720")?;
    Ok([number(width)?, number(height)?])
}

/// `dpsm` with no command: the two scenes of Brabec, Annen and Seidel 2002.
pub fn main_job(adapter: AdapterChoice, folder: &Path) -> Result<(), CliError> {
    let device = adapter.open()?;
    std::fs::create_dir_all(folder)
        .map_err(|source| CliError::Write { path: folder.into(), source })?;
    let mut report = format!("{}\n", describe(device.as_ref()));
    for name in ["brabec-room", "brabec-ceiling"] {
        let scene = scene::open(name, &Options::default())?;
        let light = scene.default_light();
        let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
        // 512 x 512 maps and picture, as in the paper's section 5
        let settings =
            Settings { size: 512, image: [512, 512], views: true, ..Settings::default() };
        let output = folder.join(format!("{name}.png"));
        let axis = light.axis.unwrap_or(Vec3::NEG_Y);
        let frame = frame(&scene, &light, axis, &camera, settings)?;
        report.push_str(&picture(device.as_ref(), &scene.name, &frame, &output)?);
    }
    print(&report)
}

/// `dpsm render`.
pub fn render(adapter: AdapterChoice, arguments: &RenderArguments) -> Result<(), CliError> {
    let settings = Settings {
        size: arguments.size,
        format: match arguments.format {
            FormatName::D16 => Format::D16,
            FormatName::D24 => Format::D24,
            FormatName::D32 => Format::D32,
        },
        method: arguments.method.method()?,
        lookup: match arguments.lookup {
            LookupName::Pixel => Lookup::Pixel,
            LookupName::Vertex => Lookup::Vertex,
        },
        image: arguments.image,
        near: arguments.near,
        far: arguments.far,
        bias: arguments.bias,
        views: arguments.maps,
    };
    let scene = scene::open(&arguments.scene, &Options { walls: arguments.walls })?;
    for warning in &scene.warnings {
        eprintln!("dpsm: {warning}");
    }
    let mut light = scene.default_light();
    match arguments.light {
        Some(position) => light = Light { position, axis: None, ..light },
        None if scene.lights.len() > 1 => {
            eprintln!("dpsm: the scene has {} lights; using the first", scene.lights.len());
        }
        None => {}
    }
    if arguments.hemisphere {
        light.axis = Some(light.axis.unwrap_or(Vec3::NEG_Y));
    }
    let axis = arguments.axis.or(light.axis).unwrap_or(Vec3::NEG_Y);
    let mut camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
    camera.eye = arguments.camera.unwrap_or(camera.eye);
    camera.target = arguments.look_at.unwrap_or(camera.target);
    let device = adapter.open()?;
    let mut report = format!("{}\n", describe(device.as_ref()));
    let frame = frame(&scene, &light, axis, &camera, settings)?;
    report.push_str(&picture(device.as_ref(), &scene.name, &frame, &arguments.output)?);
    print(&report)
}

fn frame(
    scene: &Scene,
    light: &Light,
    axis: Vec3,
    camera: &Camera,
    settings: Settings,
) -> Result<Frame, CliError> {
    let hemispherical = light.axis.is_some();
    let frame = Frame::new(scene, light.position, axis, hemispherical, camera, settings)?;
    Ok(Frame { color: light.color, ..frame })
}

/// Renders one picture and its companions, and reports on it.
fn picture(
    device: Option<&Device>,
    scene: &str,
    frame: &Frame,
    output: &Path,
) -> Result<String, CliError> {
    let rendering = match device {
        Some(device) => gpu::render(device, frame)?,
        None => cpu::render(frame),
    };
    let mut outputs = Outputs::default();
    outputs.add_picture(output, &rendering.lit)?;
    if frame.settings.views {
        companions(&rendering, output, &mut outputs)?;
    }
    let mut report = format!("{scene}: {} triangles\n", frame.triangles.len());
    for (pass, time) in &rendering.timings {
        let _ = writeln!(report, "  {pass:<12}{:9.3} ms", time.as_secs_f64() * 1e3);
    }
    for path in outputs.finish()? {
        let _ = writeln!(report, "  {}", path.display());
    }
    Ok(report)
}

/// Adds the maps as grey pictures and the hemisphere views beside the main picture.
fn companions(rendering: &Rendering, output: &Path, outputs: &mut Outputs) -> Result<(), CliError> {
    let beside = |kind: &str| {
        let stem = output.file_stem().unwrap_or_default().to_string_lossy();
        output.with_file_name(format!("{stem}-{kind}.png"))
    };
    for (layer, name) in (0..rendering.maps.layers).zip(["front-map", "back-map"]) {
        outputs.add_picture(&beside(name), &grey(&rendering.maps, layer))?;
    }
    for (view, name) in rendering.views.iter().zip(["front-view", "back-view"]) {
        outputs.add_picture(&beside(name), view)?;
    }
    Ok(())
}

/// A map as a grey picture: black at the near sphere, white at the far one or where it is empty.
fn grey(maps: &DepthMaps, layer: u32) -> Picture {
    let shade = |&depth: &f32| {
        let value = (depth * 255.0).round() as u8;
        [value, value, value, 255]
    };
    let pixels = maps.layer(layer).iter().map(shade).collect();
    Picture { width: maps.size, height: maps.size, pixels }
}
