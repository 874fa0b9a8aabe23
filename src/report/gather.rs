//! The figures of one scene.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use super::data::{Curves, ErrorFigures, Image, SceneFigures, Source, Times};
use super::timing::{self, Timed};
use super::variants::{self, Choice};
use super::{pareto, pictures};
use crate::gpu::{Device, GpuError};
use crate::measure::{self, Bench, Point, SeenError, ShadowError};
use crate::plan::PlanError;
use crate::render::{Frame, FrameError, Method, Settings};
use crate::scalar::maps::{DepthMaps, Sampling};
use crate::scene::{BUILT_IN, Camera, Light, Scene, SceneError};

/// How much is measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effort {
    /// Texels along a side of the largest maps, at least [`Effort::SMALLEST`]; others have a half
    /// and a quarter of it.
    pub size: u32,
    /// Width and height of the pictures, whose pixels are also what the lookups are timed on.
    pub image: [u32; 2],
    /// Points that are judged.
    pub points: usize,
    /// Their seed.
    pub seed: u64,
    /// Runs of each variant that count.
    pub runs: u32,
}

impl Effort {
    /// The smallest `size`: below it maps of different variants would be as large.
    pub const SMALLEST: u32 = 64;

    /// What an adapter does in seconds a scene, or what the ports do.
    pub fn usual(ports: bool) -> Self {
        let usual = Self { size: 1024, image: [480, 360], points: 2000, seed: 1, runs: 5 };
        match ports {
            true => Self { size: 256, points: 1000, runs: 2, ..usual },
            false => usual,
        }
    }
}

/// A scene to report on.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Unique in the report.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// Its light.
    pub light: Light,
    /// What sees the points.
    pub camera: Camera,
    /// Of each of the scene's meshes, whether it casts no shadow; may be empty.
    pub no_cast: Vec<bool>,
}

impl Subject {
    /// A scene with its own light, or one that is given in the file's coordinates, and its own camera.
    pub fn new(scene: Scene, light: Option<DVec3>) -> Self {
        let own = scene.default_light();
        let light = light.map_or(own, |position| own.moved(scene.local(position)));
        let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
        Self { name: scene.name.clone(), scene, light, camera, no_cast: Vec::new() }
    }

    /// The frame of some settings.
    pub fn frame(&self, settings: &Settings) -> Result<Frame, FrameError> {
        self.frame_around(settings, None)
    }

    /// The same with maps around another axis, and whether they hold one hemisphere alone.
    pub fn frame_around(
        &self,
        settings: &Settings,
        around: Option<(Vec3, bool)>,
    ) -> Result<Frame, FrameError> {
        let Light { position, axis, .. } = self.light;
        let (axis, one) = around.unwrap_or((axis.unwrap_or(Vec3::NEG_Y), axis.is_some()));
        let mut settings = settings.clone();
        settings.leave_out(&self.no_cast);
        let frame = Frame::new(&self.scene, position, axis, one, &self.camera, settings)?;
        Ok(frame.shining(&self.light))
    }

    /// Refuses what no frame can be made of.
    pub fn check(&self, effort: &Effort) -> Result<(), FrameError> {
        self.frame(&variants::default_settings(effort)).map(drop)
    }

    /// A hash of all that figures depend on: meshes as they were loaded, light and camera.
    pub fn hash(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        format!("{} {:?} {:?}", self.name, self.light, self.camera).hash(&mut hasher);
        self.no_cast.hash(&mut hasher);
        for mesh in &self.scene.meshes {
            let words =
                |v: &[Vec3]| v.iter().flat_map(|v| v.to_array()).map(f32::to_bits).collect();
            let words: [Vec<u32>; 3] =
                [words(&mesh.positions), words(&mesh.normals), words(&[mesh.albedo])];
            (words, &mesh.triangles).hash(&mut hasher);
            if let Some(mask) = &mesh.mask {
                let texcoords = mesh.texcoords.iter().flat_map(|v| v.to_array());
                texcoords.map(f32::to_bits).collect::<Vec<_>>().hash(&mut hasher);
                (&mask.alpha, mask.width, mask.cutoff.to_bits()).hash(&mut hasher);
            }
        }
        hasher.finish()
    }

    /// One line about the scene.
    fn about(&self) -> String {
        let built_in = BUILT_IN.iter().find(|(name, _)| *name == self.scene.name);
        match built_in {
            Some((_, about)) => about.to_string(),
            None => format!("{} meshes from a file", self.scene.meshes.len()),
        }
    }
}

/// What measures, how much, and who is told of each step.
#[derive(Clone, Copy)]
pub struct Job<'a> {
    /// The adapter; `None` for the ports.
    pub device: Option<&'a Device>,
    /// How much.
    pub effort: &'a Effort,
    /// Called with the name of each step as it begins.
    pub step: &'a dyn Fn(&str),
}

/// A part of a report that is finished, as it is kept to be taken up again.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// What it depends on: a part with another one is of no use.
    pub fingerprint: String,
    /// A scene's figures.
    pub scene: Option<SceneFigures>,
    /// A scene's pictures.
    pub images: Vec<Image>,
    /// A pass for each map that draws nothing, ms.
    pub empty_pass: Option<Times>,
    /// What cost grows with.
    pub costs: Vec<Curves>,
}

/// Why a part cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The adapter.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Settings that do not fit the scene.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A scene that does not open.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture that cannot be encoded.
    #[error("cannot encode a picture: {0}")]
    Picture(#[from] image::ImageError),
}

/// Measures a scene.
pub fn scene(job: &Job<'_>, subject: &Subject) -> Result<Part, ReportError> {
    let effort = job.effort;
    (job.step)("rays");
    let settings = variants::default_settings(effort);
    let frame = subject.frame(&settings)?;
    let truth = measure::truth_of(&frame);
    let empty = DepthMaps::empty(1, 1, Sampling::Nearest);
    let bench = Bench::new(&frame, &empty, &truth);
    let seen = bench.points_of_image();
    let points = bench.points_from_camera(effort.points, effort.seed);
    let receivers = |frame: &Frame| {
        let bench = Bench::new(frame, &empty, &truth);
        seen.iter().flatten().map(|point| bench.receiver(point).into()).collect()
    };
    (job.step)("the plan");
    // a scene of which the camera sees nothing has none
    let planned = match variants::planned(subject, effort) {
        Ok(planned) => Some(planned),
        Err(PlanError::Frame(error)) => return Err(error.into()),
        Err(_) => None,
    };
    let choices = variants::choices(subject, effort, job.device.is_none(), planned.as_ref())?;
    let timed = match job.device {
        Some(device) => timing::by_adapter(device, job, subject, &choices, &receivers)?,
        None => timing::by_ports(job, subject, &choices, &receivers)?,
    };
    (job.step)("errors");
    let mut measured = Vec::new();
    let mut sources = Vec::new();
    // variants that read the same texels share what shows in them
    let mut around = HashMap::new();
    for (index, choice) in choices.iter().enumerate() {
        let frame = choice.frame(subject)?;
        let mut variant = variants::described(choice, &frame)?;
        variant.generation = timed.generation[timed.sets[index]];
        variant.lookup = timed.lookup[index];
        let maps = read_as(&timed, index, choice);
        let bench = Bench::new(&frame, &maps, &truth);
        let key =
            format!("{:?} {:?}", frame.light, (maps.size, maps.sampling, choice.settings.filter));
        let around = around
            .entry(key + &format!(" {:?}", bench.projection))
            .or_insert_with(|| measure::surroundings_of(&bench, &points, || {}));
        let seen = measure::seen_error(&bench, &points, around);
        variant.error = figures(&measure::shadow_error(&bench, &points, || {}), &seen);
        if is_explained(choice, effort) {
            sources.extend(explained(&bench, &points, &choice.name));
        }
        measured.push(variant);
    }
    pareto::mark(&mut measured);
    (job.step)("pictures");
    let images = pictures::pictures(job, subject, &truth, &seen, |method| {
        let wanted = Choice::of(&variants::pictured(effort, method));
        let at = |choice: &Choice| *choice == wanted;
        let index = choices.iter().position(at)?;
        Some(read_as(&timed, index, &choices[index]))
    })?;
    let figures = SceneFigures {
        name: subject.name.clone(),
        about: subject.about(),
        triangles: frame.triangles.len(),
        light: subject.scene.in_file(subject.light.position).to_array(),
        hemispherical: subject.light.axis.is_some(),
        points: points.len(),
        seed: effort.seed,
        variants: measured,
        plan: planned.map_or(Vec::new(), |planned| planned.lines),
        sources,
    };
    let empty_pass = timed.empty_pass;
    Ok(Part { scene: Some(figures), images, empty_pass, ..Part::default() })
}

/// A variant's maps as its filter samples them.
fn read_as(timed: &Timed, index: usize, choice: &Choice) -> DepthMaps {
    let sampling = choice.settings.sampling_taken();
    DepthMaps { sampling, ..timed.maps[timed.sets[index]].clone() }
}

/// The shares of all points, and the largest of what has a size.
fn figures(error: &ShadowError, seen: &SeenError) -> ErrorFigures {
    let share = |part: usize| part as f64 / error.points.max(1) as f64;
    ErrorFigures {
        rmse: seen.rmse,
        acne: seen.acne_share(),
        acne_mean: seen.acne_mean,
        smoothly_lit: seen.smoothly_lit,
        leak: seen.leak_share(),
        leak_mean: seen.leak_mean,
        deep_in_shadow: seen.deep_in_shadow,
        false_shadow: share(error.false_shadow),
        false_light: share(error.false_light),
        faults: share(error.faults()),
        contact_gap: error.contact_gap,
        edge_texels_median: error.edge_texels_median,
        edge_texels_largest: error.edge_texels_largest,
        edge_degrees_largest: error.edge_radians_largest.to_degrees(),
    }
}

/// True of the variants whose error is attributed to its sources: the default one, and the
/// original method as large.
fn is_explained(choice: &Choice, effort: &Effort) -> bool {
    let explained = [Method::Refined, Method::Vertex];
    let wanted = |&method: &Method| Choice::of(&variants::of(effort, method, effort.size));
    explained.iter().any(|method| *choice == wanted(method))
}

/// Points whose penumbra is measured: 64 rays each.
const CONES: usize = 500;

fn explained(bench: &Bench<'_>, points: &[Point], variant: &str) -> Vec<Source> {
    let some = &points[..points.len().min(CONES)];
    let penumbra = measure::penumbra_error(bench, some, || {});
    let source = |source: measure::Source| Source {
        name: source.name.into(),
        variant: variant.into(),
        measured: source.measured,
        predicted: source.predicted,
        unit: source.unit.into(),
    };
    measure::attribute(bench, points, &penumbra).into_iter().map(source).collect()
}
