//! Every figure of a report, as report.json holds it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// The version of report.json that this program writes and reads.
pub const VERSION: u32 = 2;

/// A whole report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`VERSION`].
    pub version: u32,
    /// What computed it.
    pub machine: Machine,
    /// How times were taken.
    pub timing: Timing,
    /// One a scene.
    pub scenes: Vec<SceneFigures>,
    /// What other maps of all directions cost in texels.
    pub parameterisations: Vec<Parameterisation>,
    /// Cost against triangles, map size, lights, taps.
    pub costs: Vec<Curves>,
    /// What an interrupted run has left open, by name; empty in a finished report.
    pub unfinished: Vec<String>,
}

/// What computed the figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Adapter and driver in one line, or that the ports ran.
    pub computed_by: String,
    /// The adapter's name, empty for the ports.
    pub adapter: String,
    /// Its driver and version.
    pub driver: String,
    /// The back-end: vulkan, metal, dx12.
    pub backend: String,
    /// True of a software adapter, and of the ports.
    pub software: bool,
    /// Cores of the processor.
    pub cores: usize,
    /// Operating system and architecture.
    pub system: String,
    /// Versions by name: dpsm, wgpu, naga, rustc.
    pub versions: BTreeMap<String, String>,
}

/// How times were taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Runs of each variant that are thrown away.
    pub warm_up: u32,
    /// Runs that count; the variants take turns.
    pub runs: u32,
    /// A pass that draws nothing, ms; `None` for the ports.
    pub empty_pass: Option<Times>,
}

/// Repeated times, in the unit that the field names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// How many.
    pub runs: u32,
    /// Smallest.
    pub least: f64,
    /// Lower quartile.
    pub low: f64,
    /// Median.
    pub median: f64,
    /// Upper quartile.
    pub high: f64,
}

/// A scene's figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneFigures {
    /// Its name.
    pub name: String,
    /// One line about it.
    pub about: String,
    /// Triangles.
    pub triangles: usize,
    /// The light's position, in the coordinates of the scene's file.
    pub light: [f64; 3],
    /// True of a light with one hemisphere.
    pub hemispherical: bool,
    /// Points that were judged, seen by the camera.
    pub points: usize,
    /// Their seed.
    pub seed: u64,
    /// Ways to make and read the maps.
    pub variants: Vec<Variant>,
    /// What `dpsm plan` says, a line a choice; empty without a plan.
    pub plan: Vec<String>,
    /// Where the error of the default variant comes from.
    pub sources: Vec<Source>,
}

/// One way to make and read the maps, measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Variant {
    /// Unique in its scene: method, size, filter.
    pub name: String,
    /// Method of the maps by its option name.
    pub method: String,
    /// Texels along a side of a map.
    pub size: u32,
    /// Maps: hemispheres or faces.
    pub maps: u32,
    /// Passes that make them.
    pub passes: u32,
    /// Filter by its option name.
    pub filter: String,
    /// Bias by its option name.
    pub bias: String,
    /// Format by its option name.
    pub format: String,
    /// Texels of all maps.
    pub texels: u64,
    /// Their memory.
    pub bytes: u64,
    /// Triangles drawn, after subdivision.
    pub triangles: u64,
    /// Making all maps, ms.
    pub generation: Times,
    /// One pixel's shadow test, ns.
    pub lookup: Times,
    /// How wrong the shadows are.
    pub error: ErrorFigures,
    /// What it is in the plots.
    pub role: Role,
    /// Another variant that is at least as good in generation, lookup, memory and error, and better
    /// in one; empty on the Pareto front.
    pub dominated_by: String,
}

/// What a variant is in the plots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// One of many.
    #[default]
    Other,
    /// A cube, at equal worst texel or at equal memory.
    Cube,
    /// The plan's choice.
    Plan,
}

/// Shadows against ray casting, at the scene's points; docs/measure.md.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorFigures {
    /// Root of the mean squared difference of the visibility from the hard truth.
    pub rmse: f64,
    /// Smoothly lit points that the map shadows, share of these.
    pub acne: f64,
    /// The mean of 1 - visibility over the smoothly lit points.
    pub acne_mean: f64,
    /// Smoothly lit points.
    pub smoothly_lit: usize,
    /// Points deep in shadow that the map lights, share of these.
    pub leak: f64,
    /// The mean of the visibility over the points deep in shadow.
    pub leak_mean: f64,
    /// Points deep in shadow.
    pub deep_in_shadow: usize,
    /// Lit points that the map shadows, share of all.
    pub false_shadow: f64,
    /// Shadowed points that the map lights, share of all.
    pub false_light: f64,
    /// Of these the points that resolution does not explain, share of all.
    pub faults: f64,
    /// Largest contact gap, world units.
    pub contact_gap: f64,
    /// Misclassified points' distance from the true edge in texels: median.
    pub edge_texels_median: f64,
    /// The same: largest.
    pub edge_texels_largest: f64,
    /// The same in degrees seen from the light: largest.
    pub edge_degrees_largest: f64,
}

impl ErrorFigures {
    /// Misclassified points, share of all, nothing excused: the error of the plots.
    pub fn misclassified(&self) -> f64 {
        self.false_shadow + self.false_light
    }
}

/// One source of error.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Its name.
    pub name: String,
    /// The variant whose error it is of.
    pub variant: String,
    /// Largest error measured.
    pub measured: f64,
    /// The bound or the prediction there.
    pub predicted: Option<f64>,
    /// Unit of both.
    pub unit: String,
}

/// A map of all directions, computed; solid angles in steradians.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Parameterisation {
    /// Its name.
    pub name: String,
    /// Passes with one rasterised image each.
    pub passes: u32,
    /// Share of the stored texels that a direction uses.
    pub used: f64,
    /// Largest solid angle of a texel, for one texel in all: times texels stored.
    pub largest: f64,
    /// Smallest likewise; 0 where texels shrink to nothing.
    pub smallest: f64,
    /// Largest over smallest solid angle; infinite where texels shrink to nothing (null in JSON).
    pub ratio: Option<f64>,
    /// Texels stored for a largest texel of 1 sr, so that figures are texels times steradians.
    pub texels_for_equal_largest: f64,
    /// The same for a longest side of 1 rad, taken in any direction; `None` where it is infinite.
    pub texels_for_equal_side: Option<f64>,
    /// Largest ratio of a texel's sides as angles; `None` where it is infinite.
    pub anisotropy: Option<f64>,
    /// What to know about it.
    pub note: String,
}

/// Curves of one plot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Curves {
    /// What it shows.
    pub title: String,
    /// The horizontal axis.
    pub axis: String,
    /// The vertical one, with its unit.
    pub unit: String,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// One curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Its name.
    pub name: String,
    /// Value on the horizontal axis, and the times there.
    pub points: Vec<(f64, Times)>,
}

/// A picture of a scene; not in report.json, but in the page.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// Its scene.
    pub scene: String,
    /// What it is, unique in its scene: lit, front-map, refined-errors, ...
    pub kind: String,
    /// A title of a few words.
    pub title: String,
    /// What to look for, for a newcomer.
    pub caption: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The PNG's bytes in base 64.
    pub png: String,
}
