//! What the cost of the maps and of the lookups grows with.

use super::data::{Curve, Curves, Times};
use super::gather::{Job, Part, ReportError, Subject};
use super::timing::{self, MS};
use super::variants::{Choice, cone, method_name, of};
use crate::gpu::{Device, MeshBuffers, PointTests, ShadowMaps};
use crate::measure::{self, Bench};
use crate::render::{Filter, Frame, Method, Settings};
use crate::scalar::float::Vec3;
use crate::scalar::light::DpsmLight;
use crate::scalar::maps::{DepthMaps, Sampling};
use crate::scene::{self, Options};

/// Methods of the curves; the tessellated one, which is slow, is left out.
const METHODS: [Method; 4] = [Method::Vertex, Method::Exact, Method::Refined, Method::Cube];

/// What the horizontal axes show; the ports take the first of each alone.
const TRIANGLES: [u32; 5] = [1_000, 4_000, 16_000, 64_000, 250_000];
const SIZES: [u32; 4] = [1, 2, 4, 8];
const LIGHTS: [u32; 3] = [1, 4, 16];
const SIDES: [u32; 4] = [1, 2, 4, 8];

/// Triangles where something else varies.
const SOME: u32 = 16_000;

/// Runs of each point that count, at the most.
const RUNS: u32 = 3;

/// How many of the axes' values the ports take.
const PORTS: usize = 3;

/// Cost against triangles, map size, lights and taps; by the ports against triangles and map size.
pub fn costs(job: &Job<'_>) -> Result<Part, ReportError> {
    let effort = super::Effort { runs: job.effort.runs.min(RUNS), ..job.effort.clone() };
    let job = &Job { effort: &effort, ..*job };
    let ports = job.device.is_none();
    let some = |values: &[u32]| match ports {
        true => values[..values.len().min(PORTS)].to_vec(),
        false => values.to_vec(),
    };
    let methods = METHODS.map(method_name);
    let dozen = |count: u32| Subject::new(scene::dozen(count as usize), None);
    let middle = dozen(if ports { TRIANGLES[1] } else { SOME });
    let at_size = |size: u32| METHODS.map(|method| of(&effort, method, size));
    (job.step)("cost of triangles");
    let title = format!("Making the maps against triangles, maps of {0} x {0}", effort.size);
    let triangles = curves(title, "triangles", "ms", &methods, &some(&TRIANGLES), |count| {
        generation(job, &dozen(count), &at_size(effort.size), 1)
    })?;
    (job.step)("cost of map sizes");
    let about = format!("{} triangles", middle.scene.triangle_count());
    let sizes = SIZES.map(|part| effort.size * part / 4);
    let title = format!("Making the maps against their size, {about}");
    let sizes =
        curves(title, "texels along a map's side", "ms", &methods, &some(&sizes), |size| {
            generation(job, &middle, &at_size(size), 1)
        })?;
    let mut costs = vec![triangles, sizes];
    if let Some(device) = job.device {
        (job.step)("cost of lights");
        let size = effort.size / 4;
        let title = format!("Making the maps against lights, {about}, maps of {size} x {size}");
        let lights = curves(title, "lights", "ms", &methods, &LIGHTS, |count| {
            generation(job, &middle, &at_size(size), count)
        })?;
        (job.step)("cost of taps");
        costs.extend([lights, taps(device, job)?]);
    }
    Ok(Part { costs, ..Part::default() })
}

/// A curve of each name, measured at each value.
fn curves(
    title: String,
    axis: &str,
    unit: &str,
    names: &[&str],
    values: &[u32],
    measure: impl Fn(u32) -> Result<Vec<Times>, ReportError>,
) -> Result<Curves, ReportError> {
    let curve = |name: &&str| Curve { name: name.to_string(), points: Vec::new() };
    let mut curves: Vec<Curve> = names.iter().map(curve).collect();
    for &value in values {
        for (curve, times) in curves.iter_mut().zip(measure(value)?) {
            curve.points.push((value.into(), times));
        }
    }
    Ok(Curves { title, axis: axis.into(), unit: unit.into(), curves })
}

/// Times of making the maps of so many lights, ms.
fn generation(
    job: &Job<'_>,
    subject: &Subject,
    settings: &[Settings],
    lights: u32,
) -> Result<Vec<Times>, ReportError> {
    let Some(device) = job.device else {
        let choices: Vec<Choice> = settings.iter().map(Choice::of).collect();
        return Ok(timing::by_ports(job, subject, &choices, &|_| Vec::new())?.generation);
    };
    let mesh = match settings.first() {
        Some(settings) => MeshBuffers::new(device, &subject.frame(settings)?)?,
        None => return Ok(Vec::new()),
    };
    let mesh = &mesh;
    let made = |settings: &Settings| {
        let frame = subject.frame(settings)?;
        // in a grid around the scene's own
        let light = |i: u32| {
            let step = Vec3::new((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32);
            let position = frame.light.position + step * 0.1;
            DpsmLight { position, ..frame.light }
        };
        let lights: Vec<_> = (0..lights).map(light).collect();
        Ok(ShadowMaps::with_lights(device, &frame, mesh, &lights)?)
    };
    let made = settings.iter().map(made).collect::<Result<Vec<_>, ReportError>>()?;
    let records = made.iter().map(|maps| -> timing::Record<'_> {
        Box::new(move |encoder, stamps| maps.record(encoder, mesh, stamps))
    });
    timing::in_turn(device, "the maps", &records.collect::<Vec<_>>(), job.effort.runs, MS)
}

/// The shadow test against taps: the naive kernel's texels and the disk's taps, hard and 2 x 2.
fn taps(device: &Device, job: &Job<'_>) -> Result<Curves, ReportError> {
    let room = scene::open("brabec-room", &Options::default())?;
    let subject = Subject::new(room, None);
    let settings = of(job.effort, Method::Refined, job.effort.size / 2);
    let frame = subject.frame(&settings)?;
    let mesh = MeshBuffers::new(device, &frame)?;
    let maps = ShadowMaps::new(device, &frame, &mesh)?;
    let encoder = device.encode("the maps", |encoder| maps.record(encoder, &mesh, None))?;
    device.submit("the maps", encoder)?;
    let truth = measure::truth_of(&frame);
    let empty = DepthMaps::empty(1, 1, Sampling::Nearest);
    let bench = Bench::new(&frame, &empty, &truth);
    let seen = bench.points_of_image();
    let receivers: Vec<_> = seen.iter().flatten().map(|p| bench.receiver(p).into()).collect();
    let receivers = |_: &Frame| receivers.clone();
    let tests = PointTests::new(device)?;
    let size = settings.size;
    let title = format!("One pixel's shadow test, brabec-room, maps of {size} x {size}");
    let names = ["pcf", "disk", "reproject", "disk of 2 x 2 taps"];
    let taps = SIDES.map(|side| side * side);
    curves(title, "taps", "ns", &names, &taps, |count| {
        let filters = [
            (Filter::Naive(count.isqrt()), Sampling::Nearest),
            (Filter::Disk(cone(count)), Sampling::Nearest),
            (Filter::Reproject(cone(count)), Sampling::Nearest),
            (Filter::Disk(cone(count)), Sampling::Linear),
        ];
        let choices = filters.map(|(filter, sampling)| {
            Choice::of(&Settings { filter, sampling, ..settings.clone() })
        });
        timing::lookups(device, job, &subject, &choices, &receivers, &tests, |_| &maps)
    })
}
