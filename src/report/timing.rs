//! Times of making and of reading the maps.

use std::time::{Duration, Instant};

use super::data::{Times, Timing};
use super::gather::{Effort, Job, ReportError, Subject};
use super::variants::{Choice, of_maps};
use crate::cpu;
use crate::gpu::{self, Device, MeshBuffers, Parts, PointTests, ShadowMaps, Stamps};
use crate::render::{Casting, Frame, Method, Settings};
use crate::scalar::float::Vec3;
use crate::scalar::maps::DepthMaps;

/// Runs on an adapter that are thrown away: the first compiles.
pub const WARM_UP: u32 = 1;

/// Pixels that the ports' lookups are timed on.
const PORT_PIXELS: usize = 20_000;

/// A light-space position and normal.
pub type Receiver = [Vec3<f32>; 2];

/// The points that lookups are timed on, as a frame's light sees them.
pub type Receivers<'a> = dyn Fn(&Frame) -> Vec<Receiver> + 'a;

/// What is recorded into an encoder.
pub type Record<'a> = Box<dyn Fn(&mut wgpu::CommandEncoder, Stamps<'_>) + 'a>;

/// What making and reading the maps took, and the maps.
pub struct Timed {
    /// Each variant's set of maps; those that only read differently share one.
    pub sets: Vec<usize>,
    /// Each set's making, ms.
    pub generation: Vec<Times>,
    /// Each set's maps.
    pub maps: Vec<DepthMaps>,
    /// Each variant's shadow test of one pixel, ns.
    pub lookup: Vec<Times>,
    /// A pass for each map that draws nothing, ms.
    pub empty_pass: Option<Times>,
}

impl Times {
    /// Quartiles of times, in units of so many seconds.
    pub fn of(times: &[Duration], unit: f64) -> Self {
        let [least, low, median, high] = gpu::quartiles(times).map(|seconds| seconds / unit);
        Self { runs: times.len() as u32, least, low, median, high }
    }
}

/// Milliseconds and nanoseconds in seconds.
pub const MS: f64 = 1e-3;
const NS: f64 = 1e-9;

/// How the times of a report are taken.
pub fn timing(effort: &Effort, ports: bool) -> Timing {
    let warm_up = if ports { 0 } else { WARM_UP };
    Timing { warm_up, runs: effort.runs, empty_pass: None }
}

/// The sets of maps that variants need, and which of them each needs.
fn sets(choices: &[Choice]) -> (Vec<Choice>, Vec<usize>) {
    let mut sets: Vec<Choice> = Vec::new();
    let mut set = |choice: &Choice| {
        let wanted = of_maps(choice);
        let found = sets.iter().position(|set| *set == wanted);
        found.unwrap_or_else(|| {
            sets.push(wanted);
            sets.len() - 1
        })
    };
    let of_choices = choices.iter().map(&mut set).collect();
    (sets, of_choices)
}

/// True of the usual refined maps.
fn is_refined(set: &Choice) -> bool {
    set.settings.method == Method::Refined && set.around.is_none()
}

/// Everything but what draws.
const EMPTY: Parts = Parts { sort: false, draw: true, flat: false, planes: false };

/// Times by the adapter's timestamps.
pub fn by_adapter(
    device: &Device,
    job: &Job<'_>,
    subject: &Subject,
    choices: &[Choice],
    receivers: &Receivers<'_>,
) -> Result<Timed, ReportError> {
    let (wanted, sets) = sets(choices);
    (job.step)("maps");
    // what leaves meshes out has an order of triangles of its own
    let mut meshes: Vec<(Vec<Casting>, MeshBuffers)> = Vec::new();
    let mut made = Vec::new();
    for set in &wanted {
        let frame = set.frame(subject)?;
        let casting = &set.settings.casting;
        let known = meshes.iter().position(|(of, _)| of == casting);
        let index = match known {
            Some(index) => index,
            None => {
                meshes.push((casting.clone(), MeshBuffers::new(device, &frame)?));
                meshes.len() - 1
            }
        };
        made.push((ShadowMaps::new(device, &frame, &meshes[index].1)?, index));
    }
    let made: Vec<(ShadowMaps, &MeshBuffers)> =
        made.into_iter().map(|(maps, index)| (maps, &meshes[index].1)).collect();
    // first, so that the maps that it empties are made again after it
    let refined = wanted.iter().rposition(is_refined);
    let mut records: Vec<Record<'_>> = Vec::new();
    records.extend(refined.map(|index| -> Record<'_> {
        let (maps, mesh) = &made[index];
        Box::new(move |encoder, stamps| maps.record_parts(encoder, mesh, stamps, EMPTY))
    }));
    records.extend(made.iter().map(|(maps, mesh)| -> Record<'_> {
        Box::new(move |encoder, stamps| maps.record(encoder, mesh, stamps))
    }));
    let mut generation = in_turn(device, "the maps", &records, job.effort.runs, MS)?;
    let empty_pass = refined.map(|_| generation.remove(0));

    (job.step)("lookups");
    let tests = PointTests::new(device)?;
    let lookup =
        lookups(device, job, subject, choices, receivers, &tests, |index| &made[sets[index]].0)?;
    (job.step)("reading the maps");
    let sampling = Settings::default().sampling_taken();
    let maps = made.iter().map(|(maps, _)| maps.download(device, sampling));
    let maps = maps.collect::<Result<_, _>>()?;
    Ok(Timed { sets, generation, maps, lookup, empty_pass })
}

/// Times of each variant's shadow test, ns a pixel, on maps that were made.
pub fn lookups<'a>(
    device: &Device,
    job: &Job<'_>,
    subject: &Subject,
    choices: &[Choice],
    receivers: &Receivers<'_>,
    tests: &PointTests,
    maps: impl Fn(usize) -> &'a ShadowMaps,
) -> Result<Vec<Times>, ReportError> {
    let mut tried = Vec::new();
    let mut points = None;
    let mut count = 0;
    for (index, choice) in choices.iter().enumerate() {
        let frame = choice.frame(subject)?;
        if points.as_ref().is_none_or(|(around, _)| *around != choice.around) {
            let receivers = receivers(&frame);
            count = receivers.len();
            if count == 0 {
                return Ok(vec![Times::default(); choices.len()]);
            }
            points = Some((choice.around, PointTests::upload(device, &receivers)?));
        }
        if let Some((_, points)) = &points {
            tried.push(tests.of(device, &frame, maps(index), points)?);
        }
    }
    let records: Vec<Record<'_>> = tried
        .iter()
        .map(|test| -> Record<'_> { Box::new(move |encoder, stamps| test.record(encoder, stamps)) })
        .collect();
    let unit = NS * count as f64;
    in_turn(device, "the shadow test", &records, job.effort.runs, unit)
}

/// Times of what is recorded, in turn.
pub fn in_turn(
    device: &Device,
    name: &str,
    records: &[Record<'_>],
    runs: u32,
    unit: f64,
) -> Result<Vec<Times>, ReportError> {
    let timed: Vec<gpu::Timed<'_>> =
        records.iter().map(|record| (name, record.as_ref() as _)).collect();
    let times = device.time_in_turn(&timed, WARM_UP, runs)?;
    Ok(times.iter().map(|times| Times::of(times, unit)).collect())
}

/// Times of the ports by the clock, nothing thrown away.
pub fn by_ports(
    job: &Job<'_>,
    subject: &Subject,
    choices: &[Choice],
    receivers: &Receivers<'_>,
) -> Result<Timed, ReportError> {
    let (wanted, sets) = sets(choices);
    (job.step)("maps");
    let frames: Vec<Frame> =
        wanted.iter().map(|set| set.frame(subject)).collect::<Result<_, _>>()?;
    let mut maps = Vec::new();
    let mut times = vec![Vec::new(); frames.len()];
    for run in 0..job.effort.runs.max(1) {
        for (index, frame) in frames.iter().enumerate() {
            let start = Instant::now();
            let made = cpu::make_maps(frame)?;
            times[index].push(start.elapsed());
            if run == 0 {
                maps.push(made);
            }
        }
    }
    let generation = times.iter().map(|times| Times::of(times, MS)).collect();
    (job.step)("lookups");
    let mut lookup = Vec::new();
    for (choice, &set) in choices.iter().zip(&sets) {
        let frame = choice.frame(subject)?;
        let receivers = receivers(&frame);
        let stride = receivers.len().div_ceil(PORT_PIXELS).max(1);
        let some: Vec<Receiver> = receivers.into_iter().step_by(stride).collect();
        let maps: DepthMaps = DepthMaps {
            sampling: choice.settings.sampling_taken(),
            ..DepthMaps::clone(&maps[set])
        };
        let run = |_| {
            let start = Instant::now();
            let sum: f32 =
                some.iter().map(|[p, normal]| frame.visibility(&maps, *p, *normal)).sum();
            std::hint::black_box(sum);
            start.elapsed()
        };
        let times: Vec<Duration> = (0..job.effort.runs.max(1)).map(run).collect();
        lookup.push(Times::of(&times, NS * some.len().max(1) as f64));
    }
    Ok(Timed { sets, generation, maps, lookup, empty_pass: None })
}
