//! The least that a scene needs: hemispheres, seam, spheres, size, format, method, filter and bias
//! that keep shadow edges within a target, and why.
//!
//! Derivations, and how plans score against a sweep over all choices: `docs/plan.md`.
//!
//! ```
//! use dpsm::plan::{Request, plan};
//! use dpsm::scene::{Options, open};
//!
//! let scene = open("cornell", &Options::default())?;
//! let request = Request::new(&scene, "0.2deg".parse()?);
//! let plan = plan(&request)?;
//! assert!(plan.meets && plan.size < 2048);
//! for choice in &plan.choices {
//!     println!("{}: {}, {}", choice.what, choice.value, choice.why);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod axis;
pub mod casters;
pub mod choose;
pub mod cost;
mod error;
mod explain;
mod score;
mod sight;
mod target;

pub use error::PlanError;
pub use explain::Choice;
pub use score::{Proof, Wrong};
pub use sight::{Ends, Sample, Sight};
pub use target::{TEXEL_OF, Target};

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use crate::measure::{Bench, Point, truth_of, truth_of_drawn};
use crate::render::{Bias, Casting, Filter, Format, Frame, Method, Settings, View};
use crate::scalar::maps::{DepthMaps, Sampling};
use crate::scene::{Camera, Light, Scene};
use axis::{Axis, Judge};
use casters::{Casters, casters};
use choose::{Candidate, Case};
use cost::Rates;

/// The version of plan files that this program writes and reads.
pub const VERSION: u32 = 2;

/// Receivers that a plan looks at, shared out over the lights.
const POINTS: usize = 20_000;

/// The main axis of a light that has none.
const DOWN: Vec3 = Vec3::NEG_Y;

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Of each of its meshes, whether it is to cast no shadow; may be empty.
    pub no_cast: Vec<bool>,
    /// Positions of the light: one, or a path's.
    pub lights: Vec<Vec3>,
    /// The axis of a hemispherical light.
    pub axis: Option<Vec3>,
    /// The camera; without one all surfaces are to be right.
    pub camera: Option<Camera>,
    /// Width and height of its image.
    pub image: [u32; 2],
    /// How far shadow edges may be off.
    pub error: Target,
    /// Most bytes of the maps.
    pub budget: Option<u64>,
    /// What steps cost.
    pub rates: Rates,
    /// Chooses the receivers.
    pub seed: u64,
}

impl<'a> Request<'a> {
    /// For the scene's own light, and all of its surfaces.
    pub fn new(scene: &'a Scene, error: Target) -> Self {
        let Light { position, axis, .. } = scene.default_light();
        Self {
            scene,
            no_cast: Vec::new(),
            lights: vec![position],
            axis,
            camera: None,
            image: Settings::default().image,
            error,
            budget: None,
            rates: Rates::LLVMPIPE,
            seed: 1,
        }
    }
}

/// A mesh that is left out of the maps.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeftOut {
    /// Its place among the scene's meshes, from 0.
    pub mesh: usize,
    /// Its name.
    pub name: String,
    /// It is to cast no shadow; the others' shadows are not seen.
    #[serde(default)]
    pub no_cast: bool,
}

/// Settings that keep a target, and why; the contents of a plan file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// [`VERSION`].
    pub version: u32,
    /// The scene's name, its meshes and triangles.
    pub scene: String,
    /// Meshes of the scene.
    pub meshes: usize,
    /// Triangles of the scene.
    pub triangles: usize,
    /// Positions of the light that it was made for, in the coordinates of the scene's file.
    pub lights: Vec<[f64; 3]>,
    /// The target.
    pub error: Target,
    /// The maps' axis, unit.
    pub axis: [f32; 3],
    /// Maps: 1 or 2.
    pub hemispheres: u32,
    /// Texels along a side of each.
    pub size: u32,
    /// d16 or d32.
    pub format: String,
    /// The method of all meshes that are kept: exact.
    pub method: String,
    /// single: the four texels around a receiver against its plane.
    pub filter: String,
    /// Near sphere's radius.
    pub near: f32,
    /// Far sphere's radius.
    pub far: f32,
    /// Meshes that are not drawn into the maps.
    pub left_out: Vec<LeftOut>,
    /// True where the target is met, as predicted.
    pub meets: bool,
    /// The predicted error, in the target's unit.
    pub predicted: Target,
    /// Predicted milliseconds to make the maps, and to read them for the image.
    pub milliseconds: [f64; 2],
    /// Bytes of the maps.
    pub bytes: u64,
    /// The choices, a line each.
    pub choices: Vec<Choice>,
}

/// Plans.
///
/// # Errors
/// See [`PlanError`].
pub fn plan(request: &Request<'_>) -> Result<Plan, PlanError> {
    let view = request.camera.map(|camera| View::new(&camera, request.image)).transpose()?;
    check_target(request)?;
    // meshes and lights are checked before they are looked at
    frames(request, &[])?;
    let Casters { left_out, near, far } =
        casters(request.scene, &request.no_cast, &request.lights, view.as_slice());
    let frames = frames(request, &left_out)?;
    let samples = samples(request, &frames);
    if samples.is_empty() {
        return Err(PlanError::NothingSeen);
    }
    let kept: Vec<bool> = left_out.iter().map(Option::is_none).collect();
    let seen: Vec<_> =
        frames.iter().map(|frame| cost::seen(request.scene, &kept, origin(frame))).collect();
    let sorted = seen.iter().map(Vec::len).max().unwrap_or(0);
    let [width, height] = request.image.map(u64::from);
    let plain = |axis: &Axis| {
        let size = choose::ladder(axis.demand);
        cost::generation(&request.rates, &axis.loads, sorted, size)
    };
    let judge = Judge { samples: &samples, seen: &seen, cost: &plain };
    let axes = axes(request, &judge, view.as_ref());
    let case = Case {
        samples: &samples,
        spheres: [near, far],
        sorted,
        pixels: width * height,
        rates: &request.rates,
    };
    let mut candidates: Vec<Candidate> =
        axes.iter().enumerate().flat_map(|(index, axis)| case.candidates(index, axis)).collect();
    let fits = |candidate: &&Candidate| request.budget.is_none_or(|most| candidate.bytes <= most);
    let meets = |candidate: &&Candidate| fits(candidate) && candidate.share <= 1.0;
    if !candidates.iter().any(|candidate| meets(&candidate)) {
        candidates.extend(within_budget(request, &case, &axes));
    }
    let best = candidates.iter().filter(meets).min_by(|a, b| a.order(b));
    let nearest = || candidates.iter().filter(fits).min_by(|a, b| a.share.total_cmp(&b.share));
    let Some(best) = best.or_else(nearest) else { return Err(PlanError::Budget) };
    Ok(explain::explained(request, &case, &axes, &candidates, best, &left_out))
}

impl Plan {
    /// Refuses a plan that this program did not write for this scene.
    pub fn check(&self, scene: &Scene) -> Result<(), PlanError> {
        let (meshes, triangles) = (scene.meshes.len(), scene.triangle_count());
        if self.version != VERSION {
            return Err(PlanError::Version(self.version));
        }
        let named = |out: &LeftOut| scene.meshes.get(out.mesh).is_some_and(|m| m.name == out.name);
        match meshes == self.meshes
            && triangles == self.triangles
            && self.left_out.iter().all(named)
        {
            true => Ok(()),
            false => Err(PlanError::Scene {
                planned: self.scene.clone(),
                meshes: self.meshes,
                triangles: self.triangles,
            }),
        }
    }

    /// The settings that it stands for; image, lookup and views are those of `base`.
    pub fn settings(&self, base: &Settings) -> Result<Settings, PlanError> {
        let unknown = |what, value: &str| PlanError::Value { what, value: value.into() };
        let filter = match self.filter.as_str() {
            "single" => Filter::Single,
            other => return Err(unknown("filter", other)),
        };
        let method = match self.method.as_str() {
            "exact" => Method::Exact,
            other => return Err(unknown("method", other)),
        };
        let mut casting = vec![Casting::By(method); self.meshes];
        for out in &self.left_out {
            if let Some(mesh) = casting.get_mut(out.mesh) {
                *mesh = if out.no_cast { Casting::LeftOut } else { Casting::Unseen };
            }
        }
        Ok(Settings {
            size: self.size,
            casting,
            format: match self.format.as_str() {
                "d16" => Format::D16,
                "d32" => Format::D32,
                other => return Err(unknown("format", other)),
            },
            method,
            filter,
            bias: Bias::Plane,
            near: Some(self.near),
            far: Some(self.far),
            ..base.clone()
        })
    }

    /// True where the maps hold one hemisphere alone.
    pub fn is_hemispherical(&self) -> bool {
        self.hemispheres == 1
    }
}

/// Refuses errors beyond the scene's size, or beyond the angle that any map keeps.
fn check_target(request: &Request<'_>) -> Result<(), PlanError> {
    let size = f64::from(request.scene.bounds().extent().length());
    let than = match request.error {
        Target::Units(units) if units > size => format!("more than the scene's size, {size:.3}"),
        Target::Texels(_) | Target::Degrees(_) if request.error.is_capped() => {
            "more than 45 degrees".into()
        }
        _ => return Ok(()),
    };
    Err(PlanError::Target { error: request.error.to_string(), than })
}

/// Candidates of the largest sizes that a budget holds.
fn within_budget(request: &Request<'_>, case: &Case<'_>, axes: &[Axis]) -> Vec<Candidate> {
    let most = request.budget.unwrap_or(u64::MAX);
    let mut found = Vec::new();
    for (index, axis) in axes.iter().enumerate() {
        for format in [Format::D16, Format::D32] {
            let texels = most / (u64::from(axis.maps) * choose::texel_bytes(format));
            let size = choose::ladder_below((texels as f64).sqrt());
            let fine = size.filter(|size| case.is_fine(*size, format));
            found.extend(fine.map(|size| case.candidate(index, axis, size, format)));
        }
    }
    found
}

/// The axes that are tried: two maps, and one where it holds all that shows.
fn axes(request: &Request<'_>, judge: &Judge<'_>, view: Option<&View>) -> Vec<Axis> {
    if let Some(axis) = request.axis {
        return vec![judge.axis("the light's own", axis.as_dvec3().normalize_or(DVec3::NEG_Y), 1)];
    }
    let mut named: Vec<(String, DVec3)> =
        [("down", DVec3::NEG_Y), ("x", DVec3::X), ("z", DVec3::Z)]
            .map(|(name, axis)| (name.to_string(), axis))
            .into();
    if let Some(view) = view {
        let own = [("the camera's right", view.right), ("the camera's up", view.up)];
        named.push(("the camera's plane".into(), view.forward.as_dvec3()));
        named.extend(own.map(|(name, axis)| (name.to_string(), axis.as_dvec3())));
    }
    named.extend(judge.principal().map(|axis| ("a principal axis".to_string(), axis)));
    let mut axes = judge.best(&named, 2);
    if let Some(centre) = judge.centre() {
        let turned = |(name, axis): &(String, DVec3)| {
            [(name.clone(), *axis), (format!("{name}, turned round"), -*axis)]
        };
        let mut both: Vec<_> = named.iter().flat_map(turned).collect();
        both.push(("around all that shows".into(), centre));
        axes.extend(judge.best(&both, 1));
    }
    axes
}

/// A frame for each position of the light, all with the default settings but for what is left out.
fn frames(
    request: &Request<'_>,
    left_out: &[Option<casters::Reason>],
) -> Result<Vec<Frame>, PlanError> {
    if request.lights.is_empty() {
        return Err(PlanError::NoLight);
    }
    let camera = request.camera.unwrap_or(Camera {
        eye: Vec3::ZERO,
        target: Vec3::NEG_Z,
        up: Vec3::Y,
        vertical_fov: 1.0,
    });
    let casting = |reason: &Option<casters::Reason>| match reason {
        Some(casters::Reason::Switched) => Casting::LeftOut,
        Some(_) => Casting::Unseen,
        None => Casting::By(Method::Exact),
    };
    let casting = left_out.iter().map(casting).collect();
    let method = Method::Exact;
    let settings = Settings { image: request.image, method, casting, ..Settings::default() };
    let frame = |&light: &Vec3| {
        let axis = request.axis.unwrap_or(DOWN);
        let hemispherical = request.axis.is_some();
        Frame::new(request.scene, light, axis, hemispherical, &camera, settings.clone())
    };
    Ok(request.lights.iter().map(frame).collect::<Result<_, _>>()?)
}

/// The receivers of all lights; those behind a hemispherical light are dark by definition.
fn samples(request: &Request<'_>, frames: &[Frame]) -> Vec<Sample> {
    let (truth, casters) = (truth_of(&frames[0]), truth_of_drawn(&frames[0]));
    let count = POINTS.div_ceil(frames.len());
    let mut samples = Vec::new();
    for (seed, frame) in (request.seed..).zip(frames) {
        let points = receivers(frame, &truth, request.camera.is_some(), count, seed);
        let sight = Sight { truth: &casters, origin: origin(frame) };
        samples.extend(sight.samples(&points, request.error));
    }
    if let Some(axis) = request.axis {
        samples.retain(|sample| sample.direction.dot(axis.as_dvec3()) >= 0.0);
    }
    samples
}

/// Points that the frame's camera sees, or over all surfaces.
fn receivers(
    frame: &Frame,
    truth: &crate::truth::Truth,
    from_camera: bool,
    count: usize,
    seed: u64,
) -> Vec<Point> {
    let empty = DepthMaps::empty(1, frame.light.hemispheres, Sampling::Nearest);
    let bench = Bench::new(frame, &empty, truth);
    match from_camera {
        true => {
            let mut points = bench.points_from_camera(count, seed);
            points.retain(|point| shows(point, origin(frame), frame.view.eye.as_dvec3()));
            points
        }
        false => bench.points_scattered(count, seed),
    }
}

/// A surface that gets less of the light than this is as good as dark: a white one in the host's
/// ambient light of a fifth changes by three steps of 255 between lit and shadowed.
const FAINT: f64 = 0.01;

/// True where an eye sees the side of a point's surface that the light is on, and the light is not
/// so grazing that nothing shows: else it is dark whatever the maps say.
pub fn shows(point: &Point, light: DVec3, eye: DVec3) -> bool {
    let Some(normal) = point.normal else { return true };
    let side = |from: DVec3| normal.dot((from - point.world).normalize_or_zero());
    side(light) * side(eye) >= 0.0 && side(light).abs() >= FAINT
}

/// The light's position.
fn origin(frame: &Frame) -> DVec3 {
    let p = frame.light.position;
    Vec3::new(p.x, p.y, p.z).as_dvec3()
}
