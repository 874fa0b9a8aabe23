//! The options that every command on a scene shares, and the frame that they make.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use dpsm::gpu::{self, Device};
use dpsm::plan::Plan;
use dpsm::render::{
    Bias, Filter, Format, Frame, Kernel, LARGEST_TAU, Level, Method, Passes, SMALLEST_TAU,
    Settings, Taps,
};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scene::{self, Options, Scene};
use dpsm::{cpu, render};
use glam::{DVec3, Vec3};
use serde::Serialize;

use super::number::{ANY, whole32};
use super::output::read_text;
use super::{CliError, parse_vector};

/// Scene, light and method.
#[derive(Clone, Debug, Args)]
pub struct SetupArguments {
    /// A built-in scene, or a .obj, .gltf or .glb file
    scene: String,
    /// The light's position; by default the scene's own light
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    light: Option<DVec3>,
    /// More lights of the same kind, one option each: the picture is the mean over all; maps and
    /// measures are of the first
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    more_light: Vec<DVec3>,
    /// A hemispherical light: one map, the other half always in shadow; a cube has all six faces
    #[arg(long)]
    hemisphere: bool,
    /// The light's main axis; by default the light's own, or down
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    axis: Option<DVec3>,
    /// A plan that `dpsm plan -o` wrote: it says all that is said below but the camera, and the light
    /// where --light does not
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with_all = [
            "hemisphere", "axis", "size", "format", "method", "tau", "level", "no_cull_faces",
            "filter", "taps", "kernel_angle", "kernel_radius", "light_size", "nearest",
            "linear_taps", "bias", "constant_bias", "near", "far",
        ]
    )]
    pub plan: Option<PathBuf>,
    /// Texels along a side of a map; a cube's faces have half as many, for texels as fine
    #[arg(long, value_name = "N", value_parser = whole32::<0, ANY>, default_value_t = Settings::default().size)]
    size: u32,
    /// Storage of the maps
    #[arg(long, value_enum, default_value = "d32")]
    format: FormatName,
    /// How the maps are made
    #[arg(long, value_enum, default_value = "refined")]
    method: MethodName,
    /// For refined: how far off an edge may be drawn, in texels, 1/64 to 4, by default 1/4; `measure`
    /// judges the maps by it too
    #[arg(long, value_name = "TEXELS", value_parser = parse_tau, allow_negative_numbers = true)]
    tau: Option<f32>,
    /// For tessellated: each triangle into N x N; by default each mesh as tau asks
    #[arg(long, value_name = "N", value_parser = whole32::<1, 64>)]
    level: Option<u32>,
    /// For cube: draw all triangles to each face, also those that it cannot see
    #[arg(long)]
    no_cull_faces: bool,
    /// How the maps are drawn
    #[arg(long, value_enum, default_value = "single")]
    passes: PassesName,
    /// How the maps are read; by default single, or hard with a bias that single does not take;
    /// pictures are soft by default (pcss)
    #[arg(long, value_enum)]
    filter: Option<FilterName>,
    /// For disk, mirror, reproject and pcss: taps of a kernel; for pcf: texels along its side
    #[arg(long, value_name = "N", value_parser = whole32::<0, ANY>)]
    taps: Option<u32>,
    /// For disk, mirror and reproject: the kernel's half-angle in degrees, below 90; by default 1
    #[arg(
        long,
        value_name = "DEGREES",
        conflicts_with = "kernel_radius",
        allow_negative_numbers = true
    )]
    kernel_angle: Option<f32>,
    /// For disk, mirror and reproject: the kernel's radius at the receiver, in world units
    #[arg(long, value_name = "RADIUS", allow_negative_numbers = true)]
    kernel_radius: Option<f32>,
    /// For pcss: the light's radius in world units; by default a fiftieth of far
    #[arg(long, value_name = "RADIUS", allow_negative_numbers = true)]
    light_size: Option<f32>,
    /// For pcss: distance from the light of the nearest casters that are searched for all over their
    /// penumbra; by default an eighth of far
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true)]
    nearest: Option<f32>,
    /// For pcf, mirror and reproject: each tap 2 x 2 texels
    #[arg(long)]
    linear_taps: bool,
    /// What keeps surfaces from shadowing themselves in single, hard, hardware and pcf: by default
    /// plane, texel-centre, footprint and footprint; the other filters compare planes
    #[arg(long, value_enum)]
    bias: Option<BiasName>,
    /// For constant: the bias in units of depth; by default what 45 degrees incidence needs
    #[arg(long, value_name = "DEPTH", allow_negative_numbers = true)]
    constant_bias: Option<f32>,
    /// Near sphere's radius in world units
    #[arg(long, allow_negative_numbers = true)]
    near: Option<f32>,
    /// Far sphere's radius in world units
    #[arg(long, allow_negative_numbers = true)]
    far: Option<f32>,
    /// A mesh that casts no shadow, by its name: a bulb, a lamp's shade; several by one option each
    #[arg(long, value_name = "NAME")]
    no_cast: Vec<String>,
    /// Quads along a side of a built-in room's wall, by default 8; 1 gives two triangles
    #[arg(long, value_name = "N", value_parser = whole32::<0, ANY>)]
    walls: Option<u32>,
    /// The camera's position
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    camera: Option<DVec3>,
    /// The point that the camera looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    look_at: Option<DVec3>,
}

/// Formats by their option names.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum FormatName {
    D16,
    D24,
    D32,
}

/// Methods by their option names.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum MethodName {
    /// Straight edges, all interpolated (Brabec 2002)
    Vertex,
    /// Straight edges, the distance of the interpolated position
    FragmentDepth,
    /// `vertex` on subdivided triangles (Osman 2006)
    Tessellated,
    /// Each triangle as its arcs bound it, its distance by texel
    Exact,
    /// Edges split until they lie within tau of their arcs, then plain triangles
    Refined,
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
    match (SMALLEST_TAU..=LARGEST_TAU).contains(&tau) {
        true => Ok(tau),
        false => Err(format!("`{text}` is not from {SMALLEST_TAU} to {LARGEST_TAU} texels")),
    }
}

/// Filters by their option names.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum FilterName {
    /// Four texels, each lit, in shadow or undecided; a soft edge a texel wide
    Single,
    /// One texel
    Hard,
    /// The hardware's 2 x 2 comparison
    Hardware,
    /// The naive kernel, texels of one map, to compare with
    Pcf,
    /// A cone around the receiver's direction, across the seam
    Disk,
    /// The same with each tap projected again (Osman 2006), to compare with
    Reproject,
    /// The same with the seam mirrored, to compare with
    Mirror,
    /// Soft shadows of a spherical light that harden towards contact
    Pcss,
}

/// How many meshes an error lists.
const NAMED: usize = 20;

/// Taps of a kernel, where none are given; and texels along a naive kernel's side.
const TAPS: u32 = 16;
const NAIVE_SIDE: u32 = 4;

/// Biases by their option names.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum BiasName {
    /// For single: the receiver's plane at each of four texels
    Plane,
    /// For single: the receiver's own distance, by the hardware's comparisons
    Normal,
    /// One for all receivers (Brabec 2002)
    Constant,
    /// What the receiver's plane changes over the texels that are read
    Footprint,
    /// The receiver's plane along the texel's centre; with `--filter hardware` as footprint
    TexelCentre,
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

impl Names {
    /// The names of a frame's settings.
    pub fn of(settings: &Settings) -> Self {
        let filter = match (settings.filter, settings.sampling) {
            (Filter::Single, _) if matches!(settings.bias, Bias::Plane | Bias::Normal) => {
                FilterName::Single
            }
            (Filter::Single, Sampling::Nearest) => FilterName::Hard,
            (Filter::Single, Sampling::Linear) => FilterName::Hardware,
            (Filter::Naive(_), _) => FilterName::Pcf,
            (Filter::Disk(_), _) => FilterName::Disk,
            (Filter::Mirror(_), _) => FilterName::Mirror,
            (Filter::Reproject(_), _) => FilterName::Reproject,
            (Filter::Soft { .. }, _) => FilterName::Pcss,
        };
        let level = match settings.level {
            Level::Constant(level) => Some(level),
            Level::Mesh(_) => None,
        };
        Self {
            format: name(FormatName::of(settings.format)),
            method: name(MethodName::of(settings.method)),
            tau: settings.tau,
            level,
            passes: name(match settings.passes {
                Passes::Single => PassesName::Single,
                Passes::Atlas => PassesName::Atlas,
                Passes::Multiview => PassesName::Multiview,
            }),
            filter: name(filter),
            bias: name(match settings.bias {
                Bias::Plane => BiasName::Plane,
                Bias::Normal => BiasName::Normal,
                Bias::Constant(_) => BiasName::Constant,
                Bias::Footprint => BiasName::Footprint,
                Bias::TexelCentre => BiasName::TexelCentre,
            }),
        }
    }
}

impl FormatName {
    fn of(format: Format) -> Self {
        match format {
            Format::D16 => Self::D16,
            Format::D24 => Self::D24,
            Format::D32 => Self::D32,
        }
    }
}

impl MethodName {
    fn of(method: Method) -> Self {
        match method {
            Method::Vertex => Self::Vertex,
            Method::FragmentDepth => Self::FragmentDepth,
            Method::Tessellated => Self::Tessellated,
            Method::Exact => Self::Exact,
            Method::Refined => Self::Refined,
            Method::Cube => Self::Cube,
        }
    }
}

impl SetupArguments {
    /// The same with soft shadows where nothing says how maps are read: by a spherical light, or for
    /// several lights by kernels, which they all share. A cube's maps have no such filter.
    pub fn softened(&self) -> Self {
        let says = self.filter.is_some()
            || self.bias.is_some()
            || self.constant_bias.is_some()
            || self.plan.is_some()
            || matches!(self.method, MethodName::Cube);
        let cone = self.kernel_angle.is_some() || self.kernel_radius.is_some();
        let soft = match cone || !self.more_light.is_empty() {
            true => FilterName::Disk,
            false => FilterName::Pcss,
        };
        Self { filter: if says { self.filter } else { Some(soft) }, ..self.clone() }
    }

    /// The name of the filter that is asked for, or that the bias is for.
    fn filter_name(&self) -> FilterName {
        let other = !matches!(self.bias, None | Some(BiasName::Plane | BiasName::Normal));
        let usual = match other || self.constant_bias.is_some() {
            true => FilterName::Hard,
            false => FilterName::Single,
        };
        self.filter.unwrap_or(usual)
    }

    /// The filter that is asked for.
    fn filter(&self) -> Result<Filter, CliError> {
        let kernel = match (self.kernel_angle, self.kernel_radius) {
            (_, Some(radius)) => Kernel::Radius(radius),
            (angle, None) => {
                let angle = angle.unwrap_or(1.0);
                if !(0.0..90.0).contains(&angle) {
                    let message = format!("--kernel-angle {angle} is not from 0 to below 90");
                    return Err(CliError::Usage(message));
                }
                Kernel::Tangent(angle.to_radians().tan())
            }
        };
        let given = self.kernel_angle.is_some() || self.kernel_radius.is_some();
        let soft = self.light_size.is_some() || self.nearest.is_some();
        let unused = |options: &str| {
            let message = format!("--filter {} takes no {options}", name(self.filter_name()));
            Err(CliError::Usage(message))
        };
        use FilterName as Name;
        let of_cone = [Name::Disk, Name::Mirror, Name::Reproject].contains(&self.filter_name());
        let single = [Name::Single, Name::Hard, Name::Hardware].contains(&self.filter_name());
        // their taps read single texels
        let gathers = [Name::Disk, Name::Pcss].contains(&self.filter_name());
        match () {
            () if given && !of_cone => return unused("--kernel-angle or --kernel-radius"),
            () if soft && self.filter_name() != Name::Pcss => {
                return unused("--light-size or --nearest");
            }
            () if single && self.taps.is_some() => return unused("--taps"),
            () if (single || gathers) && self.linear_taps => return unused("--linear-taps"),
            () => {}
        }
        let taps = Taps { count: self.taps.unwrap_or(TAPS), kernel };
        Ok(match self.filter_name() {
            Name::Single | Name::Hard | Name::Hardware => Filter::Single,
            Name::Pcf => Filter::Naive(self.taps.unwrap_or(NAIVE_SIDE)),
            Name::Disk => Filter::Disk(taps),
            Name::Mirror => Filter::Mirror(taps),
            Name::Reproject => Filter::Reproject(taps),
            Name::Pcss => {
                let (radius, nearest) = (self.light_size, self.nearest);
                Filter::Soft { taps: taps.count, radius, nearest }
            }
        })
    }

    /// The bias that is asked for, or that the filter is best with.
    fn bias(&self) -> Result<Bias, CliError> {
        use BiasName as Name;
        let usual = match self.filter_name() {
            FilterName::Hard if self.constant_bias.is_some() => Name::Constant,
            FilterName::Hard => Name::TexelCentre,
            FilterName::Hardware | FilterName::Pcf => Name::Footprint,
            _ if self.constant_bias.is_some() => Name::Constant,
            _ => Name::Plane,
        };
        let asked = self.bias.unwrap_or(usual);
        let given = self.bias.is_some() || self.constant_bias.is_some();
        let fits = match self.filter_name() {
            FilterName::Single => matches!(asked, Name::Plane | Name::Normal),
            FilterName::Hard | FilterName::Hardware | FilterName::Pcf => {
                !matches!(asked, Name::Plane | Name::Normal)
            }
            _ => !given,
        };
        if !fits {
            let (bias, filter) = (name(asked), name(self.filter_name()));
            let remedy = match self.filter_name() {
                FilterName::Single => "plane or normal; --filter hard and hardware take the others",
                FilterName::Hard | FilterName::Hardware | FilterName::Pcf => {
                    "another; plane and normal are for --filter single"
                }
                _ => "none: its taps compare the receiver's plane",
            };
            let message = format!("--bias {bias} is not for --filter {filter}: give {remedy}");
            return Err(CliError::Usage(message));
        }
        Ok(match (asked, self.constant_bias) {
            (Name::Constant, constant) => Bias::Constant(constant),
            (other, Some(_)) => {
                let other = name(other);
                let message = format!("--constant-bias is for --bias constant, not {other}");
                return Err(CliError::Usage(message));
            }
            (Name::Plane, None) => Bias::Plane,
            (Name::Normal, None) => Bias::Normal,
            (Name::Footprint, None) => Bias::Footprint,
            (Name::TexelCentre, None) => Bias::TexelCentre,
        })
    }

    /// Refuses options of other methods.
    fn check_method(&self) -> Result<(), CliError> {
        use MethodName as Name;
        let others = [
            ("--tau", self.tau.is_some(), Name::Refined),
            ("--level", self.level.is_some(), Name::Tessellated),
            ("--no-cull-faces", self.no_cull_faces, Name::Cube),
        ];
        let ignored = |(_, given, method): &&(&str, bool, Name)| *given && *method != self.method;
        match others.iter().find(ignored) {
            Some((option, _, method)) => {
                let (method, asked) = (name(*method), name(self.method));
                let message = format!("{option} is for --method {method}, not {asked}");
                Err(CliError::Usage(message))
            }
            None => Ok(()),
        }
    }

    /// Opens the scene and makes the frame; warnings go to stderr. The picture's settings, lookup
    /// and views are those of `base`.
    pub fn frame(&self, base: Settings) -> Result<(String, Frame), CliError> {
        self.check_method()?;
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
                MethodName::Refined => Method::Refined,
                MethodName::Cube => Method::Cube,
            },
            tau: self.tau.unwrap_or(Settings::default().tau),
            level: self.level.map_or(Settings::default().level, Level::Constant),
            cull_faces: !self.no_cull_faces,
            passes: match self.passes {
                PassesName::Single => Passes::Single,
                PassesName::Atlas => Passes::Atlas,
                PassesName::Multiview => Passes::Multiview,
            },
            sampling: match (self.filter_name(), self.linear_taps) {
                (FilterName::Hardware, _) => Sampling::Linear,
                (FilterName::Single | FilterName::Hard, _) | (_, false) => Sampling::Nearest,
                (_, true) => Sampling::Linear,
            },
            filter: self.filter()?,
            near: self.near,
            far: self.far,
            bias: self.bias()?,
            ..base
        };
        let plan = self.plan.as_deref().map(planned).transpose()?;
        let of_plan = plan.as_ref().and_then(|plan| plan.lights.first().copied());
        let position = self.light.or(of_plan.map(DVec3::from_array));
        let scene = open(&self.scene, self.walls, position)?;
        if let Some(plan) = &plan {
            plan.check(&scene)?;
        }
        let no_cast = no_cast(&scene, &self.no_cast)?;
        let mut settings = match &plan {
            Some(plan) => plan.settings(&settings)?,
            None => settings,
        };
        settings.leave_out(&no_cast);
        let mut light = scene.default_light();
        // a plan for the scene's own light keeps its cone and range
        let moved = position.map(|position| scene.local(position));
        let own = self.light.is_none() && moved == Some(light.position);
        match moved.filter(|_| !own) {
            Some(position) => light = light.moved(position),
            None if own => {}
            None if scene.lights.len() > 1 => {
                eprintln!("dpsm: the scene has {} lights; using the first", scene.lights.len());
            }
            None => {}
        }
        let (axis, hemispherical) = match &plan {
            Some(plan) => (Vec3::from_array(plan.axis), plan.is_hemispherical()),
            None => (
                self.axis.map(|axis| axis.as_vec3()).or(light.axis).unwrap_or(Vec3::NEG_Y),
                self.hemisphere || light.axis.is_some(),
            ),
        };
        let mut camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
        camera.eye = self.camera.map_or(camera.eye, |eye| scene.local(eye));
        camera.target = self.look_at.map_or(camera.target, |target| scene.local(target));
        let frame_at =
            |position| Frame::new(&scene, position, axis, hemispherical, &camera, settings.clone());
        let more = self.more_light.iter().map(|&position| frame_at(scene.local(position)));
        let more: Result<Vec<Frame>, _> = more.collect();
        let frame = frame_at(light.position)?.shining(&light);
        for warning in frame.warnings() {
            eprintln!("dpsm: {warning}");
        }
        Ok((scene.name, frame.with_lights(more?.into_iter().map(|frame| frame.light))?))
    }
}

/// True of the built-in scenes that are made of walls.
pub fn has_walls(name: &str) -> bool {
    name != "hills" && scene::BUILT_IN.iter().any(|(built_in, _)| *built_in == name)
}

/// Opens a scene, most exact around a point of the file's coordinates; its warnings go to stderr.
pub fn open(name: &str, walls: Option<u32>, around: Option<DVec3>) -> Result<Scene, CliError> {
    if walls.is_some() && !has_walls(name) {
        let message = format!("--walls is for built-in rooms, and `{name}` is none; leave it out");
        return Err(CliError::Usage(message));
    }
    let options = Options { around, ..Options::default() };
    let scene = scene::open(name, &Options { walls: walls.unwrap_or(options.walls), ..options })?;
    for warning in &scene.warnings {
        eprintln!("dpsm: {warning}");
    }
    Ok(scene)
}

/// Of each of a scene's meshes, whether it is one of those that are named; all of one name are.
pub fn no_cast(scene: &Scene, names: &[String]) -> Result<Vec<bool>, CliError> {
    let is = |name: &str| scene.meshes.iter().any(|mesh| mesh.name == name);
    if let Some(unknown) = names.iter().find(|name| !is(name)) {
        let mut known: Vec<&str> = scene.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
        known.sort_by_key(|name| strsim::damerau_levenshtein(name, unknown));
        known.dedup();
        let more = known.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        known.truncate(NAMED);
        let message = format!(
            "--no-cast {unknown}: the scene has no mesh of that name; it has {}{more}",
            known.join(", ")
        );
        return Err(CliError::Usage(message));
    }
    Ok(scene.meshes.iter().map(|mesh| names.contains(&mesh.name)).collect())
}

/// Reads a plan.
fn planned(path: &Path) -> Result<Plan, CliError> {
    serde_json::from_str(&read_text(path)?).map_err(|error| {
        let path = path.display();
        CliError::Usage(format!("{path} is no plan: {error}; make one with `dpsm plan -o {path}`"))
    })
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
