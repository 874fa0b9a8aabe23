//! Cost against the number of triangles, the size of the maps, the number of lights.

use dpsm::gpu::{Device, GpuError, MeshBuffers, Parts, ShadowMaps};
use dpsm::render::{Method, Settings};
use dpsm::scalar::float::Vec3;
use dpsm::scene;

use super::plot::{Plot, draw};
use super::{KEPT, Place, Variant, settings, time};

/// Runs of each point of a curve.
const RUNS: usize = 7;

/// The curves: name, method, what is recorded.
const CURVES: [(&str, Method, Parts); 5] = [
    ("vertex", Method::Vertex, Parts::ALL),
    ("exact, lists each frame", Method::Exact, Parts::ALL),
    ("refined each frame", Method::Refined, Parts::ALL),
    ("refined, lists kept", Method::Refined, KEPT),
    ("cube, faces culled, lists kept", Method::Cube, KEPT),
];

/// Medians of every curve for each value on the horizontal axis.
fn table(
    title: &'static str,
    axis: &'static str,
    file: &str,
    values: &[u32],
    measure: impl Fn(u32) -> Result<Vec<f64>, GpuError>,
) -> Result<(), GpuError> {
    println!("\n{title}, median of {RUNS} runs in ms\n");
    let names = CURVES.map(|(name, ..)| name);
    println!("| {axis} | {} |\n|---|{}", names.join(" | "), "---|".repeat(names.len()));
    let mut curves: Vec<(&str, Vec<(f64, f64)>)> =
        names.iter().map(|&name| (name, Vec::new())).collect();
    for &value in values {
        let times = measure(value)?;
        let row: Vec<String> = times.iter().map(|ms| format!("{ms:.2}")).collect();
        println!("| {value} | {} |", row.join(" | "));
        for (curve, ms) in curves.iter_mut().zip(times) {
            curve.1.push((value.into(), ms));
        }
    }
    draw(file, &Plot { title, axis, curves });
    Ok(())
}

fn medians(
    device: &Device,
    place: &Place,
    adapt: impl Fn(Method) -> Settings,
) -> Result<Vec<f64>, GpuError> {
    let mesh = MeshBuffers::new(device, &place.frame(adapt(Method::Vertex)))?;
    let variant = |(name, method, parts): (&str, Method, Parts)| {
        Variant::new(device, &mesh, place, name, adapt(method), parts)
    };
    let variants = CURVES.into_iter().map(variant).collect::<Result<Vec<_>, _>>()?;
    Ok(time(device, &mesh, &variants, RUNS)?.iter().map(|t| t.median).collect())
}

pub fn triangles(device: &Device) -> Result<(), GpuError> {
    let counts = [1_000, 4_000, 16_000, 64_000, 250_000, 1_000_000, 2_000_000];
    let title = "dozen, maps of 1024 x 1024";
    table(title, "triangles", "cost-triangles.svg", &counts, |count| {
        medians(device, &Place::of(scene::dozen(count as usize), "dozen"), settings)
    })
}

pub fn sizes(device: &Device) -> Result<(), GpuError> {
    let place = Place::of(scene::dozen(40_000), "dozen");
    let title = "dozen, 40,000 triangles";
    table(title, "map size", "cost-sizes.svg", &[256, 512, 1024, 2048, 4096], |size| {
        medians(device, &place, |method| Settings { size, ..settings(method) })
    })
}

/// Texels along a side of the maps of many lights.
const SMALL: u32 = 256;

pub fn lights(device: &Device) -> Result<(), GpuError> {
    let place = Place::of(scene::dozen(40_000), "dozen");
    let title = "dozen, 40,000 triangles, maps of 256 x 256 in one array";
    table(title, "lights", "cost-lights.svg", &[1, 4, 16, 64], |count| {
        let adapt =
            |method, parts| Settings { size: SMALL, keep_lists: parts == KEPT, ..settings(method) };
        let mesh = MeshBuffers::new(device, &place.frame(adapt(Method::Vertex, Parts::ALL)))?;
        let variant = |(name, method, parts): (&str, Method, Parts)| {
            let frame = place.frame(adapt(method, parts));
            // a grid of lights around the scene's own
            let light = |i: u32| {
                let step = Vec3::new((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32);
                let position = frame.light.position + (step - Vec3::splat(1.5)) * 0.1;
                dpsm::scalar::light::DpsmLight { position, ..frame.light }
            };
            let lights: Vec<_> = (0..count).map(light).collect();
            let maps = ShadowMaps::with_lights(device, &frame, &mesh, &lights)?;
            Ok(Variant::of(name, maps, parts))
        };
        let variants = CURVES.into_iter().map(variant).collect::<Result<Vec<_>, GpuError>>()?;
        Ok(time(device, &mesh, &variants, RUNS)?.iter().map(|t| t.median).collect())
    })
}
