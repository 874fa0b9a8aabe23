//! Plans for random lights: whether they keep their target as measured, and what they cost against
//! the cheapest setting that a sweep over all choices finds.

use std::time::Instant;

use dpsm::gpu::{self, Device, MeshBuffers, Parts, ShadowMaps};
use dpsm::measure::{Bench, truth_of, truth_of_casters};
use dpsm::plan::choose::{LEAST_SIZE, ladder, ladder_below};
use dpsm::plan::cost::{self, EXACT, Rates, Seen};
use dpsm::plan::{Plan, Proof, Request, Sight, Target, plan, shows};
use dpsm::render::{Bias, Casting, Filter, Format, Frame, Method, Settings};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scene::{self, Camera};
use dpsm::truth::Truth;
use fastrand::Rng;
use glam::{DVec3, Vec3};

use super::place::{Place, position};

/// Lights of each scene, where LIGHTS does not say how many.
const POSES: usize = 20;

fn poses() -> usize {
    std::env::var("LIGHTS").ok().and_then(|text| text.parse().ok()).unwrap_or(POSES)
}

/// Points that a setting must light rightly, and 64 more around each beside an edge.
const POINTS: usize = 10_000;

/// Targets, one for each pose in turn.
const TARGETS: [&str; 4] = ["0.5texel", "0.2deg", "0.01", "1texel"];

/// Every so many poses the plan's and the sweep's choice are timed, in turn, so often.
const TIMED: usize = 5;
const RUNS: usize = 9;

type Failed = Box<dyn std::error::Error>;

/// A light in a scene.
struct Pose<'a> {
    device: &'a Device,
    place: &'a Place,
    light: Vec3,
    axis: Option<Vec3>,
    camera: Camera,
    seen: [Vec<Seen>; 2],
}

/// Settings, and the maps' axis and number.
#[derive(Clone)]
struct Setting {
    name: String,
    settings: Settings,
    axis: Vec3,
    maps: usize,
}

pub fn score(names: &[String]) -> Result<(), Failed> {
    let device = Device::open()?;
    println!("adapter: {}", device.describe());
    println!("{} lights a scene, {POINTS} points, targets {} in turn", poses(), TARGETS.join(", "));
    let places: Vec<Place> =
        scene::BUILT_IN.iter().map(|(name, _)| Place::built_in(name, 8)).collect();
    println!(
        "| scene | met | largest share of the target | cost of the sweep's: median, largest | tried | timed: plan of sweep | plan ms |"
    );
    println!("|---|---|---|---|---|---|---|");
    let mut all = Vec::new();
    for place in &places {
        if names.is_empty() || names.contains(&place.scene.name) {
            let scores = of_scene(&device, place)?;
            println!("{}", row(&place.scene.name, &scores));
            all.extend(scores);
        }
    }
    println!("{}", row("all", &all));
    Ok(())
}

/// What one pose gave.
struct Score {
    share: f64,
    met: bool,
    /// The plan's cost over the sweep's.
    cost: Option<f64>,
    tried: usize,
    /// The same, measured.
    timed: Option<f64>,
    milliseconds: f64,
}

fn row(name: &str, scores: &[Score]) -> String {
    let sorted = |of: &dyn Fn(&Score) -> Option<f64>| {
        let mut values: Vec<f64> = scores.iter().filter_map(of).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let middle = |values: &[f64]| values.get(values.len() / 2).copied().unwrap_or(f64::NAN);
    let last = |values: &[f64]| values.last().copied().unwrap_or(f64::NAN);
    let (shares, costs) = (sorted(&|s| Some(s.share)), sorted(&|s| s.cost));
    let (timed, times) = (sorted(&|s| s.timed), sorted(&|s| Some(s.milliseconds)));
    let within = costs.iter().filter(|cost| **cost <= 1.15).count();
    format!(
        "| {name} | {} of {} | {:.3} | {:.3}, {:.3}; {within} of {} within 1.15 | {} | {:.2} [{:.2}, {:.2}] | {:.0} |",
        scores.iter().filter(|s| s.met).count(),
        scores.len(),
        last(&shares),
        middle(&costs),
        last(&costs),
        costs.len(),
        scores.iter().map(|s| s.tried).sum::<usize>(),
        middle(&timed),
        timed.first().copied().unwrap_or(f64::NAN),
        last(&timed),
        middle(&times)
    )
}

fn of_scene(device: &Device, place: &Place) -> Result<Vec<Score>, Failed> {
    let mut rng = Rng::with_seed(7);
    let probe = place.frame(Settings::default());
    let truth = truth_of(&probe);
    let own = place.scene.default_light().axis;
    let mut scores = Vec::new();
    for number in 0..poses() {
        let light = position(place, &truth, &mut rng);
        let target: Target = TARGETS[number % TARGETS.len()].parse()?;
        let camera = place.scene.camera.unwrap_or_else(|| place.scene.default_camera(light));
        let request = Request {
            lights: vec![light],
            axis: own,
            camera: Some(camera),
            ..Request::new(&place.scene, target)
        };
        let start = Instant::now();
        let plan = plan(&request)?;
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        let kept = kept(&plan, place);
        let all = vec![true; kept.len()];
        let origin = light.as_dvec3();
        let seen = [&all, &kept].map(|kept| cost::seen(&place.scene, kept, origin));
        let pose = Pose { device, place, light, axis: own, camera, seen };
        let mut score = pose.judge(&plan, target, number)?;
        score.milliseconds = milliseconds;
        println!(
            "  {} {number}: {light:.2} {target}: {} {} x {} {} {}: share {:.3}, cost {:.3}, timed {:.2?}",
            place.scene.name,
            plan.hemispheres,
            plan.size,
            plan.size,
            plan.format,
            plan.method,
            score.share,
            score.cost.unwrap_or(f64::NAN),
            score.timed
        );
        scores.push(score);
    }
    Ok(scores)
}

/// False for the meshes that a plan leaves out.
fn kept(plan: &Plan, place: &Place) -> Vec<bool> {
    let out = |mesh| plan.left_out.iter().any(|left| left.mesh == mesh);
    (0..place.scene.meshes.len()).map(|mesh| !out(mesh)).collect()
}

impl Pose<'_> {
    fn judge(&self, plan: &Plan, target: Target, number: usize) -> Result<Score, Failed> {
        let base = Settings::default();
        let planned = Setting {
            name: "plan".into(),
            settings: plan.settings(&base)?,
            axis: Vec3::from_array(plan.axis),
            maps: plan.hemispheres as usize,
        };
        let frame = self.frame(&planned)?;
        // what is left out changes the order of triangles
        let truth = &truth_of(&frame);
        let empty = DepthMaps::empty(1, frame.light.hemispheres, Sampling::Nearest);
        let mut points = Bench::new(&frame, &empty, truth).points_from_camera(POINTS, 99);
        let eye = self.camera.eye.as_dvec3();
        points.retain(|point| shows(point, self.light.as_dvec3(), eye));
        let axis = self.axis.map(|axis| axis.as_dvec3());
        let casters = truth_of_casters(&frame);
        let origin = self.light.as_dvec3();
        let sights = [truth, &casters].map(|truth| Sight { truth, origin });
        let proof = Proof::beside_edges(sights, target, points, Some(eye), axis, 99);
        let maps = gpu::make_maps(self.device, &frame)?;
        let wrong = proof.wrong(&Bench::new(&frame, &maps, truth));
        let met = wrong.share <= 1.0;
        // by the same rates, each mesh by its own method
        let own = plan.milliseconds.iter().sum();
        let mut best = (if met { own } else { f64::INFINITY }, planned.clone());
        let mut tried = 0;
        for combination in self.combinations(plan) {
            self.sweep(&combination, &proof, truth, &mut best, &mut tried)?;
        }
        let found = best.0.is_finite();
        let timed = match found && number.is_multiple_of(TIMED) {
            true => Some(self.time(&planned, &best.1)?),
            false => None,
        };
        let cost = found.then(|| own / best.0);
        if cost.is_some_and(|cost| cost > 1.15) {
            let Setting { name, settings, axis, maps } = &best.1;
            println!("    cheaper: {name}, {maps} of {} around {axis:.2}", settings.size);
        }
        if !met {
            println!("    missed: {wrong:?}");
            let at = proof.points().iter().find(|point| Some(point.world) == wrong.place);
            if let Some(point) = at {
                let judged = dpsm::measure::judge(&Bench::new(&frame, &maps, truth), point);
                let cosine = point.normal.map(|n| n.dot((point.world - origin).normalize()));
                println!("    incidence's cosine {cosine:.4?}: {judged:?}");
            }
        }
        Ok(Score { share: wrong.share, met, cost, tried, timed, milliseconds: 0.0 })
    }

    /// Every choice but the size.
    fn combinations(&self, plan: &Plan) -> Vec<Setting> {
        let view = frame_view(self.camera);
        let axes: Vec<(Vec3, usize)> = match self.axis {
            Some(axis) => vec![(axis, 1)],
            None => {
                let fixed = [Vec3::NEG_Y, Vec3::X, Vec3::Z, view.forward];
                let own = Vec3::from_array(plan.axis);
                let both = fixed.into_iter().chain([own]);
                both.flat_map(|axis| [(axis, 2), (axis, 1), (-axis, 1)]).collect()
            }
        };
        let castings =
            [Vec::new(), plan.settings(&Settings::default()).unwrap_or_default().casting];
        let mut found = Vec::new();
        for (axis, maps) in axes {
            for casting in &castings {
                for method in METHODS {
                    let mut casting = casting.clone();
                    for of in &mut casting {
                        *of = match *of {
                            Casting::By(_) => Casting::By(method),
                            other => other,
                        };
                    }
                    let settings = Settings {
                        method,
                        casting,
                        filter: Filter::Single,
                        bias: Bias::Plane,
                        format: Format::D32,
                        near: Some(plan.near),
                        far: Some(plan.far),
                        ..Settings::default()
                    };
                    let name = format!("{method:?}");
                    found.push(Setting { name, settings, axis, maps });
                }
            }
        }
        found
    }

    /// The smallest size that holds, where it is cheaper than the best so far: the largest cheaper
    /// one must hold, then sizes are halved between.
    fn sweep(
        &self,
        combination: &Setting,
        proof: &Proof<'_>,
        truth: &Truth,
        best: &mut (f64, Setting),
        tried: &mut usize,
    ) -> Result<(), Failed> {
        let sized = |size| {
            let settings = Settings { size, ..combination.settings.clone() };
            Setting { settings, ..combination.clone() }
        };
        let cheaper = |size: u32| self.cost(&sized(size)) < best.0 * 0.999;
        if !cheaper(LEAST_SIZE) {
            return Ok(());
        }
        let (mut low, mut high) = (LEAST_SIZE, 4096);
        while high - low > low / 64 + 8 {
            let middle = ladder_below(f64::from(low + high) / 2.0).unwrap_or(low).max(low + 1);
            let middle = ladder(middle.into());
            if middle >= high {
                break;
            }
            if cheaper(middle) { low = middle } else { high = middle }
        }
        if proof.needs_other_half(&self.frame(&sized(LEAST_SIZE))?) {
            return Ok(());
        }
        let mut holds = |size: u32| -> Result<bool, Failed> {
            *tried += 1;
            let frame = self.frame(&sized(size))?;
            let maps = gpu::make_maps(self.device, &frame)?;
            Ok(proof.holds(&Bench::new(&frame, &maps, truth)))
        };
        let mut right = low;
        if !holds(right)? {
            return Ok(());
        }
        let mut wrong = LEAST_SIZE;
        while right - wrong > right / 64 + 8 {
            let middle = ladder(f64::from(right + wrong) / 2.0);
            if middle >= right {
                break;
            }
            if holds(middle)? { right = middle } else { wrong = middle }
        }
        *best = (self.cost(&sized(right)), sized(right));
        Ok(())
    }

    fn frame(&self, setting: &Setting) -> Result<Frame, Failed> {
        let Setting { settings, axis, maps, .. } = setting;
        let scene = &self.place.scene;
        let settings = settings.clone();
        Ok(Frame::new(scene, self.light, *axis, *maps == 1, &self.camera, settings)?)
    }

    /// By the cost model.
    fn cost(&self, setting: &Setting) -> f64 {
        let Setting { settings, axis, maps, .. } = setting;
        let seen = &self.seen[usize::from(!settings.casting.is_empty())];
        let axis: DVec3 = axis.as_dvec3().normalize();
        let loads = &cost::loads(seen, axis)[..*maps];
        let rates = match settings.method {
            Method::Vertex | Method::FragmentDepth => Rates::LLVMPIPE_STRAIGHT,
            _ => Rates::LLVMPIPE,
        };
        let [width, height] = settings.image.map(f64::from);
        let exact = if settings.method == Method::Exact { EXACT } else { 1.0 };
        exact * cost::generation(&rates, loads, seen.len(), settings.size)
            + rates.lookup * width * height
    }

    /// The plan's time to make its maps over the other's, in turn: medians.
    fn time(&self, plan: &Setting, other: &Setting) -> Result<f64, Failed> {
        let mut medians = Vec::new();
        let mut ready = Vec::new();
        for setting in [plan, other] {
            let frame = self.frame(setting)?;
            let mesh = MeshBuffers::new(self.device, &frame)?;
            ready.push((ShadowMaps::new(self.device, &frame, &mesh)?, mesh, Vec::new()));
        }
        for run in 0..=RUNS {
            for (maps, mesh, times) in &mut ready {
                let time = self.device.time("maps", |encoder, stamps| {
                    maps.record_parts(encoder, mesh, stamps, Parts::ALL);
                })?;
                times.extend(time.filter(|_| run > 0));
            }
        }
        for (.., times) in &mut ready {
            times.sort();
            medians.push(times.get(times.len() / 2).map_or(f64::NAN, |t| t.as_secs_f64()));
        }
        Ok(medians[0] / medians[1])
    }
}

/// Methods that the sweep tries.
const METHODS: [Method; 2] = [Method::Refined, Method::Vertex];

fn frame_view(camera: Camera) -> dpsm::render::View {
    dpsm::render::View::new(&camera, Settings::default().image).expect("a usable camera")
}
