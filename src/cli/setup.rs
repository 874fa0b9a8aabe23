//! The options that every command on a scene shares, and the frame that they make.

use clap::{Args, ValueEnum};
use dpsm::gpu::{self, Device};
use dpsm::measure::MAX_TAU;
use dpsm::render::{Bias, Format, Frame, Level, Lookup, Method, Passes, Settings};
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
    /// A hemispherical light: one map, the other half always in shadow; a cube has all six faces
    #[arg(long)]
    hemisphere: bool,
    /// The light's main axis; by default the light's own, or down
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    axis: Option<Vec3>,
    /// Texels along a side of a map; a cube's faces have half as many, for texels as fine
    #[arg(long, default_value_t = Settings::default().size)]
    size: u32,
    /// Storage of the maps
    #[arg(long, value_enum, default_value = "d32")]
    format: FormatName,
    /// How the maps are made
    #[arg(long, value_enum, default_value = "hybrid")]
    method: MethodName,
    /// How far off an edge may be drawn, in texels, 0 to 4: for hybrid, whose maps `measure` judges
    /// by it too, and for tessellated without --level
    #[arg(long, value_name = "TEXELS", default_value_t = Settings::default().tau, value_parser = parse_tau, allow_negative_numbers = true)]
    tau: f32,
    /// For tessellated: each triangle into N x N; by default each mesh as tau asks
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    level: Option<u32>,
    /// For cube: draw all triangles to each face, also those that it cannot see
    #[arg(long)]
    no_cull_faces: bool,
    /// How the maps are drawn
    #[arg(long, value_enum, default_value = "single")]
    passes: PassesName,
    /// How the maps are read
    #[arg(long, value_enum, default_value = "hard")]
    filter: FilterName,
    /// What keeps surfaces from shadowing themselves
    #[arg(long, value_enum, default_value = "texel-centre")]
    bias: BiasName,
    /// For constant: the bias in units of depth; by default what 45 degrees incidence needs
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

/// Methods by their option names.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum MethodName {
    /// Straight edges, all interpolated (Brabec 2002)
    Vertex,
    /// Straight edges, the distance of the interpolated position
    FragmentDepth,
    /// `vertex` on subdivided triangles (Osman 2006)
    Tessellated,
    /// Each triangle as its arcs bound it, its distance by texel
    Exact,
    /// Flat triangles where they are enough, exact ones elsewhere
    Hybrid,
    /// Six perspective faces, to compare with
    Cube,
}

/// Passes by their option names.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum PassesName {
    /// One pass a map, one layer each
    Single,
    /// All maps of a light in one pass, side by side in one layer
    Atlas,
    /// All maps of a light in one pass, one layer each: vertex, fragment-depth, tessellated
    Multiview,
}

/// Parses a tolerance in texels.
fn parse_tau(text: &str) -> Result<f32, String> {
    let tau: f32 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    match (0.0..=MAX_TAU).contains(&f64::from(tau)) {
        true => Ok(tau),
        false => Err(format!("`{text}` is not from 0 to {MAX_TAU} texels")),
    }
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

/// Biases by their option names.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum BiasName {
    /// One for all receivers (Brabec 2002)
    Constant,
    /// What the receiver's plane changes over the texels that are read
    Footprint,
    /// The receiver's plane along the texel's centre; with `--filter hardware` as footprint
    TexelCentre,
    /// The same, or the receiver's own distance where that is nearer
    TexelCentreOrOwn,
    /// As footprint, for receivers of unknown planes up to 84 degrees incidence
    NoNormal,
}

/// The options that say how, by their names on the command line.
#[derive(Clone, Debug, Serialize)]
pub struct Names {
    pub format: String,
    pub method: String,
    pub tau: f32,
    pub level: Option<u32>,
    pub passes: String,
    pub filter: String,
    pub bias: String,
}

impl SetupArguments {
    /// The chosen options' names.
    pub fn names(&self) -> Names {
        Names {
            format: name(self.format),
            method: name(self.method),
            tau: self.tau,
            level: self.level,
            passes: name(self.passes),
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
                MethodName::Tessellated => Method::Tessellated,
                MethodName::Exact => Method::Exact,
                MethodName::Hybrid => Method::Hybrid,
                MethodName::Cube => Method::Cube,
            },
            tau: self.tau,
            level: self.level.map_or(Settings::default().level, Level::Constant),
            cull_faces: !self.no_cull_faces,
            passes: match self.passes {
                PassesName::Single => Passes::Single,
                PassesName::Atlas => Passes::Atlas,
                PassesName::Multiview => Passes::Multiview,
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
            bias: match (self.bias, self.constant_bias) {
                (BiasName::Constant, constant) => Bias::Constant(constant),
                (other, Some(_)) => {
                    let other = name(other);
                    let message = format!("--constant-bias is for --bias constant, not {other}");
                    return Err(CliError::Usage(message));
                }
                (BiasName::Footprint, None) => Bias::Footprint,
                (BiasName::TexelCentre, None) => Bias::TexelCentre,
                (BiasName::TexelCentreOrOwn, None) => Bias::TexelCentreOrOwn,
                (BiasName::NoNormal, None) => Bias::WITHOUT_NORMAL,
            },
            views,
            ..Settings::default()
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
