//! The options that every command on a scene shares, and the frame that they make.

use clap::{Args, ValueEnum};
use dpsm::gpu::{self, Device};
use dpsm::render::{Format, Frame, Lookup, Method, Settings};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scene::{self, Light, Options};
use dpsm::{cpu, render};
use glam::Vec3;
use serde::Serialize;

use super::{CliError, parse_vector};

/// Scene, light and method.
#[derive(Debug, Args)]
pub struct SetupArguments {
    /// A built-in scene, or a .obj, .gltf or .glb file
    scene: String,
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
    #[arg(long, default_value_t = Settings::default().size)]
    size: u32,
    /// Storage of the maps
    #[arg(long, value_enum, default_value = "d32")]
    format: FormatName,
    /// How the maps are made
    #[arg(long, value_enum, default_value = "vertex")]
    method: MethodName,
    /// How the maps are read
    #[arg(long, value_enum, default_value = "hard")]
    filter: FilterName,
    /// What keeps surfaces from shadowing themselves
    #[arg(long, value_enum, default_value = "constant")]
    bias: BiasName,
    /// The constant bias in units of depth; by default what 45 degrees incidence needs
    #[arg(long, value_name = "DEPTH", allow_negative_numbers = true)]
    constant_bias: Option<f32>,
    /// Near sphere's radius in world units
    #[arg(long, allow_negative_numbers = true)]
    near: Option<f32>,
    /// Far sphere's radius in world units
    #[arg(long, allow_negative_numbers = true)]
    far: Option<f32>,
    /// Quads along a side of a built-in room's wall; 1 gives two triangles
    #[arg(long, default_value_t = Options::default().walls)]
    walls: u32,
    /// The camera's position
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    camera: Option<Vec3>,
    /// The point that the camera looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    look_at: Option<Vec3>,
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

/// Filters by their option names, the planned ones included.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum FilterName {
    Hard,
    Hardware,
    Pcf,
    Disk,
    Reproject,
    Pcss,
}

/// Biases by their option names, the planned ones included.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum BiasName {
    Constant,
    Footprint,
    TexelCentre,
}

/// The options that say how, by their names on the command line.
#[derive(Clone, Debug, Serialize)]
pub struct Names {
    pub format: String,
    pub method: String,
    pub filter: String,
    pub bias: String,
}

impl SetupArguments {
    /// The chosen options' names.
    pub fn names(&self) -> Names {
        Names {
            format: name(self.format),
            method: name(self.method),
            filter: name(self.filter),
            bias: name(self.bias),
        }
    }

    /// Opens the scene and makes the frame; warnings go to stderr.
    pub fn frame(
        &self,
        image: [u32; 2],
        lookup: Lookup,
        views: bool,
    ) -> Result<(String, Frame), CliError> {
        let settings = Settings {
            size: self.size,
            format: match self.format {
                FormatName::D16 => Format::D16,
                FormatName::D24 => Format::D24,
                FormatName::D32 => Format::D32,
            },
            method: match self.method {
                MethodName::Vertex => Method::Vertex,
                MethodName::FragmentDepth => Method::FragmentDepth,
                planned => return Err(not_built("--method", planned, "vertex, fragment-depth")),
            },
            lookup,
            sampling: match self.filter {
                FilterName::Hard => Sampling::Nearest,
                FilterName::Hardware => Sampling::Linear,
                planned => return Err(not_built("--filter", planned, "hard, hardware")),
            },
            image,
            near: self.near,
            far: self.far,
            bias: match self.bias {
                BiasName::Constant => self.constant_bias,
                planned => return Err(not_built("--bias", planned, "constant")),
            },
            views,
        };
        let scene = scene::open(&self.scene, &Options { walls: self.walls })?;
        for warning in &scene.warnings {
            eprintln!("dpsm: {warning}");
        }
        let mut light = scene.default_light();
        match self.light {
            Some(position) => light = Light { position, axis: None, ..light },
            None if scene.lights.len() > 1 => {
                eprintln!("dpsm: the scene has {} lights; using the first", scene.lights.len());
            }
            None => {}
        }
        let hemispherical = self.hemisphere || light.axis.is_some();
        let axis = self.axis.or(light.axis).unwrap_or(Vec3::NEG_Y);
        let mut camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
        camera.eye = self.camera.unwrap_or(camera.eye);
        camera.target = self.look_at.unwrap_or(camera.target);
        let frame = Frame::new(&scene, light.position, axis, hemispherical, &camera, settings)?;
        Ok((scene.name, Frame { color: light.color, ..frame }))
    }
}

/// The error for a value that is named and not built.
fn not_built(option: &'static str, value: impl ValueEnum, built: &'static str) -> CliError {
    CliError::NotBuilt { option, value: name(value), built }
}

fn name(value: impl ValueEnum) -> String {
    value.to_possible_value().map_or(String::new(), |value| value.get_name().into())
}

/// A rendering by the adapter, or by the ports where there is none.
pub fn render(device: Option<&Device>, frame: &Frame) -> Result<render::Rendering, CliError> {
    Ok(match device {
        Some(device) => gpu::render(device, frame)?,
        None => cpu::render(frame)?,
    })
}

/// The maps alone, by the adapter, or by the ports where there is none.
pub fn make_maps(device: Option<&Device>, frame: &Frame) -> Result<DepthMaps, CliError> {
    Ok(match device {
        Some(device) => gpu::make_maps(device, frame)?,
        None => cpu::make_maps(frame)?,
    })
}
