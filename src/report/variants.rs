//! Which ways to shadows are compared in a scene.

use super::data::{Role, Variant};
use super::gather::{Effort, Subject};
use crate::plan::{PlanError, Request, Target, plan};
use crate::render::{
    Bias, Filter, Format, Frame, FrameError, Kernel, Level, Method, Settings, Taps,
};
use crate::scalar::maps::Sampling;
use glam::Vec3;

/// A way to make and read the maps.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Unique in its scene.
    pub name: String,
    /// How.
    pub settings: Settings,
    /// What it is in the plots.
    pub role: Role,
    /// The maps' axis, and whether they hold one hemisphere alone, where it is not as usual.
    pub around: Option<(Vec3, bool)>,
}

/// What `dpsm plan` chooses for a scene, and why.
#[derive(Clone, Debug)]
pub struct Planned {
    choice: Choice,
    /// A line a choice.
    pub lines: Vec<String>,
}

/// Triangles are cut into as many a side at the most, and into as many in all, as more take seconds.
const LEVEL: u32 = 16;
const MOST_TRIANGLES: u64 = 1_000_000;

/// Half-angle of the disk's cone in degrees, and its taps, as `dpsm render` has them.
const CONE_DEGREES: f32 = 1.0;
const TAPS: u32 = 16;

/// Texels along the naive kernel's side.
const NAIVE_SIDE: u32 = 4;

/// The error that the plan keeps.
const ERROR: Target = Target::Texels(0.5);

/// Plans for what the scene's camera sees of its light.
pub fn planned(subject: &Subject, effort: &Effort) -> Result<Planned, PlanError> {
    let request = Request {
        no_cast: subject.no_cast.clone(),
        lights: vec![subject.light.position],
        axis: subject.light.axis,
        camera: Some(subject.camera),
        image: effort.image,
        ..Request::new(&subject.scene, ERROR)
    };
    let plan = plan(&request)?;
    let settings = plan.settings(&of(effort, Method::Refined, effort.size))?;
    let choice = Choice::of(&settings);
    let maps = if plan.is_hemispherical() { "1 map" } else { "2 maps" };
    let name = format!("plan: {}, {maps}", choice.name);
    let around = Some((Vec3::from_array(plan.axis), plan.is_hemispherical()));
    let lines = plan.choices.iter().map(|choice| {
        let error = choice
            .error
            .map_or(String::new(), |error| format!(", error {}", plan.error.with(error).short()));
        format!("{}: {}{error}: {}", choice.what, choice.value, choice.why)
    });
    let lines = lines.collect();
    Ok(Planned { choice: Choice { name, role: Role::Plan, around, ..choice }, lines })
}

/// The default: what the pictures and the attribution of error show.
pub fn default_settings(effort: &Effort) -> Settings {
    of(effort, Method::Refined, effort.size)
}

/// A method's settings for maps of a size.
pub fn of(effort: &Effort, method: Method, size: u32) -> Settings {
    let level = Level::Mesh(LEVEL);
    Settings { method, size, level, image: effort.image, ..Settings::default() }
}

/// A method's settings for the maps that the pictures show.
pub fn pictured(effort: &Effort, method: Method) -> Settings {
    of(effort, method, effort.size / 2)
}

/// Taps over the usual cone.
pub fn cone(count: u32) -> Taps {
    Taps { count, kernel: Kernel::Tangent(CONE_DEGREES.to_radians().tan()) }
}

/// All variants of a scene. The ports, which are slow, take fewer.
pub fn choices(
    subject: &Subject,
    effort: &Effort,
    ports: bool,
    planned: Option<&Planned>,
) -> Result<Vec<Choice>, FrameError> {
    let sizes = [effort.size / 4, effort.size / 2, effort.size];
    let [_, middle, large] = sizes;
    let mut wanted = Vec::new();
    let all: &[u32] = if ports { &[middle, large] } else { &sizes };
    wanted.extend(all.iter().map(|&size| of(effort, Method::Vertex, size)));
    for method in [Method::FragmentDepth, Method::Tessellated, Method::Exact] {
        let some: &[u32] = if ports { &[middle] } else { &[middle, large] };
        wanted.extend(some.iter().map(|&size| of(effort, method, size)));
    }
    wanted.extend(all.iter().map(|&size| of(effort, Method::Refined, size)));
    let read = Settings { size: middle, ..default_settings(effort) };
    wanted.push(Settings { format: Format::D16, ..read.clone() });
    wanted.push(Settings { bias: Bias::TexelCentre, ..read.clone() });
    let (sampling, bias) = (Sampling::Linear, Bias::Footprint);
    wanted.push(Settings { sampling, bias, ..read.clone() });
    wanted.push(Settings { filter: Filter::Naive(NAIVE_SIDE), ..read.clone() });
    wanted.push(Settings { filter: Filter::Disk(cone(TAPS)), ..read });
    // a cube's faces at equal worst texel are half as wide; at equal memory six hold as many texels
    // as the maps of the other methods
    let maps = if subject.light.axis.is_some() { 1.0 } else { 2.0 };
    let face = |size: u32| (f64::from(size) * f64::sqrt(maps / 6.0)).round() as u32;
    wanted.extend(all.iter().map(|&size| of(effort, Method::Cube, size)));
    let some: &[u32] = if ports { &[middle] } else { &[middle, large] };
    wanted.extend(some.iter().map(|&size| of(effort, Method::Cube, 2 * face(size).max(1))));
    for settings in wanted.iter_mut().filter(|s| s.method == Method::Tessellated) {
        let halves = std::iter::successors(Some(LEVEL), |level| Some(level / 2));
        for most in halves.take_while(|level| *level > 0) {
            settings.level = Level::Mesh(most);
            if drawn(&subject.frame(settings)?)? <= MOST_TRIANGLES {
                break;
            }
        }
    }
    let mut choices: Vec<Choice> = wanted.iter().map(Choice::of).collect();
    choices.extend(planned.map(|planned| planned.choice.clone()));
    Ok(choices)
}

/// Triangles that a frame's method draws, after subdivision.
fn drawn(frame: &Frame) -> Result<u64, FrameError> {
    if frame.settings.method != Method::Tessellated {
        return Ok(frame.drawn().iter().map(|(range, _)| range.len() as u64).sum());
    }
    let extents = frame.extents();
    let levels = frame.levels(&extents, &frame.light)?;
    let cut = |level: u32| u64::from(level) * u64::from(level);
    let of_mesh = extents.iter().zip(levels);
    Ok(of_mesh.map(|(mesh, level)| mesh.triangles.len() as u64 * cut(level)).sum())
}

impl Choice {
    /// One of many, or a cube, named by its settings.
    pub fn of(settings: &Settings) -> Self {
        let role = match settings.method {
            Method::Cube => Role::Cube,
            _ => Role::Other,
        };
        Self { name: name(settings), settings: settings.clone(), role, around: None }
    }

    /// The scene's frame.
    pub fn frame(&self, subject: &Subject) -> Result<Frame, FrameError> {
        subject.frame_around(&self.settings, self.around)
    }
}

/// What the maps depend on, all else as by default: equal ones share maps.
pub fn of_maps(choice: &Choice) -> Choice {
    let Settings { filter, sampling, bias, .. } = Settings::default();
    let settings = Settings { filter, sampling, bias, ..choice.settings.clone() };
    Choice { around: choice.around, ..Choice::of(&settings) }
}

/// What is known of a variant before it is measured.
pub fn described(choice: &Choice, frame: &Frame) -> Result<Variant, FrameError> {
    let Settings { method, format, .. } = choice.settings;
    let (size, maps) = (choice.settings.map_size(), frame.light.hemispheres);
    let texels = u64::from(size) * u64::from(size) * u64::from(maps);
    let bytes = match format {
        Format::D16 => 2,
        Format::D24 | Format::D32 => 4,
    };
    Ok(Variant {
        name: choice.name.clone(),
        method: method_name(method).into(),
        size,
        maps,
        passes: maps,
        filter: filter_name(&choice.settings),
        bias: match choice.settings.bias_taken() {
            Bias::Plane => "plane",
            Bias::Normal => "normal",
            Bias::Constant(_) => "constant",
            Bias::Footprint => "footprint",
            Bias::TexelCentre => "texel-centre",
        }
        .into(),
        format: format_name(format).into(),
        texels,
        bytes: texels * bytes,
        triangles: drawn(frame)?,
        role: choice.role,
        ..Variant::default()
    })
}

/// Method, size, and what is not as by default.
fn name(settings: &Settings) -> String {
    let mut name = match settings.method {
        Method::Cube => format!("cube 6 x {}", settings.map_size()),
        method => format!("{} {}", method_name(method), settings.size),
    };
    let (filter, format) = (filter_name(settings), format_name(settings.format));
    for (part, usual) in [(filter.as_str(), "single"), (format, "d32")] {
        if part != usual {
            name = format!("{name} {part}");
        }
    }
    name
}

/// A method's option name.
pub fn method_name(method: Method) -> &'static str {
    match method {
        Method::Vertex => "vertex",
        Method::FragmentDepth => "fragment-depth",
        Method::Tessellated => "tessellated",
        Method::Exact => "exact",
        Method::Refined => "refined",
        Method::Cube => "cube",
    }
}

fn format_name(format: Format) -> &'static str {
    match format {
        Format::D16 => "d16",
        Format::D24 => "d24",
        Format::D32 => "d32",
    }
}

/// A filter's option name, and its taps where it has some.
fn filter_name(settings: &Settings) -> String {
    match (settings.filter, settings.sampling) {
        (Filter::Single, _) if matches!(settings.bias, Bias::Plane | Bias::Normal) => {
            "single".into()
        }
        (Filter::Single, Sampling::Nearest) => "hard".into(),
        (Filter::Single, Sampling::Linear) => "hardware".into(),
        (Filter::Naive(side), _) => format!("pcf {side} x {side}"),
        (Filter::Disk(taps), _) => format!("disk {}", taps.count),
        (Filter::Mirror(taps), _) => format!("mirror {}", taps.count),
        (Filter::Reproject(taps), _) => format!("reproject {}", taps.count),
        (Filter::Soft { taps, .. }, _) => format!("pcss {taps}"),
    }
}
