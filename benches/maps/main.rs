//! What making the maps costs, by method, and whether the maps are right.
//!
//! `cargo bench --bench maps [-- ratios [SCENE...] | parts | triangles | sizes | lights | right]`;
//! without an argument all but `right`, which takes ten minutes. Tables are Markdown; `triangles`,
//! `sizes` and `lights` also draw docs/pictures/cost-*.svg.

mod cost;
mod place;
mod plot;
mod right;

use std::time::Duration;

use dpsm::gpu::{self, Device, GpuError, MeshBuffers, Parts, ShadowMaps, Stamps, Timed};
use dpsm::render::{Level, Method, Passes, Settings};
use dpsm::scene;
use place::Place;

/// Timed runs of each variant, after one that is thrown away; variants take turns.
const RUNS: usize = 15;

fn main() {
    let device = match Device::open() {
        Ok(device) => device,
        Err(error) => return println!("no figures: {error}"),
    };
    println!("adapter: {}", device.describe());
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let wanted = |name: &str| match arguments.as_slice() {
        [] => name != "right",
        names => names.iter().any(|asked| asked == name),
    };
    type Part = fn(&Device) -> Result<(), GpuError>;
    let parts: [(&str, Part); 6] = [
        ("ratios", ratios),
        ("parts", parts),
        ("triangles", cost::triangles),
        ("sizes", cost::sizes),
        ("lights", cost::lights),
        ("right", right::right),
    ];
    for (name, part) in parts {
        if wanted(name)
            && let Err(error) = part(&device)
        {
            println!("{name}: {error}");
        }
    }
}

/// One way to make maps, ready to run.
pub struct Variant {
    pub name: String,
    pub maps: ShadowMaps,
    pub parts: Parts,
}

/// Everything but the sorting: for lists that were kept.
pub const KEPT: Parts = Parts { sort: false, ..Parts::ALL };

impl Variant {
    pub fn new(
        device: &Device,
        mesh: &MeshBuffers,
        place: &Place,
        name: &str,
        settings: Settings,
        parts: Parts,
    ) -> Result<Self, GpuError> {
        let settings = Settings { keep_lists: parts == KEPT || !parts.sort, ..settings };
        let maps = ShadowMaps::new(device, &place.frame(settings), mesh)?;
        Ok(Self { name: name.into(), maps, parts })
    }
}

/// Median and quartiles in milliseconds.
#[derive(Clone, Copy)]
pub struct Times {
    pub low: f64,
    pub median: f64,
    pub high: f64,
}

/// Times the variants in turn.
pub fn time(
    device: &Device,
    mesh: &MeshBuffers,
    variants: &[Variant],
    runs: usize,
) -> Result<Vec<Times>, GpuError> {
    for variant in variants {
        // fills the lists that are kept
        device.time(&variant.name, |encoder, stamps| variant.maps.record(encoder, mesh, stamps))?;
    }
    let records: Vec<_> = variants
        .iter()
        .map(|variant| {
            move |encoder: &mut wgpu::CommandEncoder, stamps: Stamps<'_>| {
                variant.maps.record_parts(encoder, mesh, stamps, variant.parts);
            }
        })
        .collect();
    let timed: Vec<Timed<'_>> =
        variants.iter().zip(&records).map(|(v, record)| (v.name.as_str(), record as _)).collect();
    let times = device.time_in_turn(&timed, 1, runs as u32)?;
    let quartiles = |times: &Vec<Duration>| {
        let [_, low, median, high] = gpu::quartiles(times).map(|seconds| seconds * 1e3);
        Times { low, median, high }
    };
    Ok(times.iter().map(quartiles).collect())
}

/// Map size of the ratios: 1024 a hemisphere, as in the paper's time 512.
const SIZE: u32 = 1024;

fn settings(method: Method) -> Settings {
    Settings { method, size: SIZE, ..Settings::default() }
}

/// Every method against the vertex method, and the hybrid one against the cube.
fn ratios(device: &Device) -> Result<(), GpuError> {
    println!(
        "\n{SIZE} x {SIZE} a hemisphere, cube faces of half that, D32, {RUNS} runs interleaved,"
    );
    println!("median [quartiles] in ms, and the share of the vertex method's median");
    let mut places = vec![
        Place::built_in("brabec-room", 1),
        Place::built_in("brabec-room", 8),
        Place::of(scene::dozen(40_000), "dozen"),
        Place::of(scene::dozen(550_000), "dozen"),
        Place::of(scene::crowd(40_000), "crowd"),
        Place::of(scene::crowd(550_000), "crowd"),
    ];
    match Place::sponza() {
        Some(sponza) => places.push(sponza),
        None => println!("sponza: skipped, its file is not there"),
    }
    // further arguments name scenes
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let named = |place: &&Place| asked.contains(&place.scene.name);
    let some = places.iter().any(|place| named(&place));
    for place in places.iter().filter(|place| !some || named(place)) {
        let frame = place.frame(settings(Method::Vertex));
        let mesh = MeshBuffers::new(device, &frame)?;
        let make = |name: &str, settings: Settings, parts: Parts| {
            Variant::new(device, &mesh, place, name, settings, parts)
        };
        let cube = |cull_faces| Settings { cull_faces, ..settings(Method::Cube) };
        let atlas = |method| Settings { passes: Passes::Atlas, ..settings(method) };
        let views = |method| Settings { passes: Passes::Multiview, ..settings(method) };
        // a mesh that reaches from near the light to far away would be cut into a hundred million
        let level = match place.scene.name.as_str() {
            "sponza" => Level::Constant(2),
            _ => Level::Mesh(64),
        };
        let tessellated = Settings { level, ..settings(Method::Tessellated) };
        let mut variants = vec![
            make("vertex", settings(Method::Vertex), Parts::ALL)?,
            make("vertex, one pass", atlas(Method::Vertex), Parts::ALL)?,
            make("fragment-depth", settings(Method::FragmentDepth), Parts::ALL)?,
            make(&format!("tessellated, {level:?}"), tessellated, Parts::ALL)?,
            make("exact, lists kept", settings(Method::Exact), KEPT)?,
            make("exact, sorted each frame", settings(Method::Exact), Parts::ALL)?,
            make("hybrid, lists kept", settings(Method::Hybrid), KEPT)?,
            make("hybrid, sorted each frame", settings(Method::Hybrid), Parts::ALL)?,
            make("hybrid, one pass, lists kept", atlas(Method::Hybrid), KEPT)?,
            make("cube", cube(false), Parts::ALL)?,
            make("cube, faces culled, lists kept", cube(true), KEPT)?,
            make("cube, faces culled each frame", cube(true), Parts::ALL)?,
        ];
        // last, as not every adapter has it
        for (name, settings) in [
            ("vertex, multiview", views(Method::Vertex)),
            ("fragment-depth, multiview", views(Method::FragmentDepth)),
            ("tessellated, multiview", Settings { level, ..views(Method::Tessellated) }),
        ] {
            match make(name, settings, Parts::ALL) {
                Ok(variant) => variants.push(variant),
                Err(error) => println!("\n{name}: {error}"),
            }
        }
        let times = time(device, &mesh, &variants, RUNS)?;
        println!("\n{}\n\n| method | ms | of vertex | of cube | of culled cube |", place.name);
        println!("|---|---|---|---|---|");
        let base = [0, 9, 10].map(|i: usize| times[i].median);
        for (variant, t) in variants.iter().zip(&times) {
            let [vertex, cube, culled] = base.map(|base| t.median / base);
            println!(
                "| {} | {:.2} [{:.2}, {:.2}] | {vertex:.2} | {cube:.2} | {culled:.2} |",
                variant.name, t.median, t.low, t.high
            );
        }
    }
    Ok(())
}

/// Where the time of the exact and hybrid methods goes, by leaving stages out.
fn parts(device: &Device) -> Result<(), GpuError> {
    println!("\nwhere the time goes: the same passes with stages left out\n");
    for place in [Place::built_in("brabec-room", 1), Place::of(scene::dozen(40_000), "dozen")] {
        println!("{}\n\n| stages | exact ms | hybrid ms |\n|---|---|---|", place.name);
        let frame = place.frame(settings(Method::Vertex));
        let mesh = MeshBuffers::new(device, &frame)?;
        let stages = [
            ("all, sorted each frame", Parts::ALL),
            ("sorting alone", Parts { draw: false, ..Parts::ALL }),
            ("drawing alone", KEPT),
            ("drawing without curved", Parts { curved: false, ..KEPT }),
            ("drawing without steep", Parts { steep: false, ..KEPT }),
            ("drawing without flat", Parts { flat: false, ..KEPT }),
            ("an empty pass a map", Parts { flat: false, steep: false, curved: false, ..KEPT }),
        ];
        let mut variants = Vec::new();
        for (name, parts) in stages {
            for method in [Method::Exact, Method::Hybrid] {
                let settings = Settings { keep_lists: true, ..settings(method) };
                let maps = ShadowMaps::new(device, &place.frame(settings), &mesh)?;
                variants.push(Variant { name: name.into(), maps, parts });
            }
        }
        let times = time(device, &mesh, &variants, RUNS)?;
        for (pair, (name, _)) in times.chunks(2).zip(stages) {
            println!("| {name} | {:.2} | {:.2} |", pair[0].median, pair[1].median);
        }
        println!();
    }
    Ok(())
}
