//! What making the maps costs, by method, and whether the maps are right.
//!
//! `cargo bench --bench maps [-- ratios [SCENE...] | tolerances [SCENE...] | parts | triangles | sizes |
//! lights | leaves | right]`; without an argument all but `right`, which takes ten minutes. Tables are Markdown; `triangles`,
//! `sizes` and `lights` also draw docs/pictures/cost-*.svg, `leaves` docs/pictures/leaves-*.png.

mod cost;
mod floor;
mod leaves;
mod place;
mod plot;
mod right;

use std::time::Duration;

use dpsm::gpu::{self, Device, GpuError, MeshBuffers, Parts, ShadowMaps, Stamps, Timed};
use dpsm::render::{Level, Method, Passes, Settings};
use dpsm::scene;
use floor::Floor;
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
    let parts: [(&str, Part); 8] = [
        ("tolerances", tolerances),
        ("ratios", ratios),
        ("parts", parts),
        ("triangles", cost::triangles),
        ("sizes", cost::sizes),
        ("lights", cost::lights),
        ("leaves", leaves::pictures),
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
    made: Made,
}

/// What is recorded.
enum Made {
    Maps(Box<ShadowMaps>, Parts),
    Floor(Floor),
}

/// Everything but the making of lists: for lists that were kept.
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
        Ok(Self::of(name, maps, parts))
    }

    pub fn of(name: &str, maps: ShadowMaps, parts: Parts) -> Self {
        Self { name: name.into(), made: Made::Maps(Box::new(maps), parts) }
    }

    /// One draw of each triangle in the maps that it touches.
    pub fn floor(device: &Device, place: &Place, settings: Settings) -> Result<Self, GpuError> {
        let floor = Floor::new(device, &place.frame(settings))?;
        Ok(Self { name: "floor".into(), made: Made::Floor(floor) })
    }

    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        mesh: &MeshBuffers,
        stamps: Stamps<'_>,
        wanted: Option<Parts>,
    ) {
        match &self.made {
            Made::Maps(maps, parts) => {
                maps.record_parts(encoder, mesh, stamps, wanted.unwrap_or(*parts));
            }
            Made::Floor(floor) => floor.record(encoder),
        }
    }

    /// Bytes of its lists.
    pub fn list_bytes(&self) -> u64 {
        match &self.made {
            Made::Maps(maps, _) => maps.list_bytes(),
            Made::Floor(_) => 0,
        }
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
        device.time(&variant.name, |encoder, stamps| {
            variant.record(encoder, mesh, stamps, Some(Parts::ALL));
        })?;
    }
    let records: Vec<_> = variants
        .iter()
        .map(|variant| {
            move |encoder: &mut wgpu::CommandEncoder, stamps: Stamps<'_>| {
                variant.record(encoder, mesh, stamps, None);
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

/// Every method against the vertex method, and the refined one against the cube.
fn ratios(device: &Device) -> Result<(), GpuError> {
    println!(
        "\n{SIZE} x {SIZE} a hemisphere, cube faces of half that, D32, {RUNS} runs interleaved,"
    );
    println!("median [quartiles] in ms, and the share of the vertex method's median");
    for place in &asked_places() {
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
            make("cube, faces culled, lists kept", cube(true), KEPT)?,
            Variant::floor(device, place, settings(Method::Refined))?,
            make("refined, lists kept", settings(Method::Refined), KEPT)?,
            make("refined each frame", settings(Method::Refined), Parts::ALL)?,
            make("refined, one pass, lists kept", atlas(Method::Refined), KEPT)?,
            make("vertex, one pass", atlas(Method::Vertex), Parts::ALL)?,
            make("fragment-depth", settings(Method::FragmentDepth), Parts::ALL)?,
            make(&format!("tessellated, {level:?}"), tessellated, Parts::ALL)?,
            make("exact, lists kept", settings(Method::Exact), KEPT)?,
            make("exact, lists each frame", settings(Method::Exact), Parts::ALL)?,
            make("cube", cube(false), Parts::ALL)?,
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
        table(place, &variants, &times);
    }
    Ok(())
}

/// Prints times, and their ratios to the first three variants: the vertex method, the culled cube,
/// the floor.
fn table(place: &Place, variants: &[Variant], times: &[Times]) {
    println!("\n{}\n\n| method | ms | of vertex | of culled cube | of floor | MB |", place.name);
    println!("|---|---|---|---|---|---|");
    for (variant, t) in variants.iter().zip(times) {
        let [vertex, cube, floor] = [0, 1, 2].map(|i: usize| t.median / times[i].median);
        println!(
            "| {} | {:.2} [{:.2}, {:.2}] | {vertex:.2} | {cube:.2} | {floor:.2} | {:.1} |",
            variant.name,
            t.median,
            t.low,
            t.high,
            variant.list_bytes() as f64 / 1e6
        );
    }
}

/// The places to time, or those of them that the arguments name.
fn asked_places() -> Vec<Place> {
    let mut places = vec![
        Place::built_in("brabec-room", 1),
        Place::of(scene::crowd(40_000), "crowd"),
        Place::of(scene::dozen(40_000), "dozen"),
    ];
    match Place::sponza() {
        Some(sponza) => places.push(sponza),
        None => println!("sponza: skipped, its file is not there"),
    }
    places.push(Place::of(scene::crowd(550_000), "crowd"));
    places.push(Place::of(scene::dozen(550_000), "dozen"));
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let named = |place: &Place| asked.contains(&place.scene.name);
    if places.iter().any(named) {
        places.retain(named);
    }
    places
}

/// Refined maps by tau; and by how far a distance may be off, as a share of the finest texel.
fn tolerances(device: &Device) -> Result<(), GpuError> {
    for place in &asked_places() {
        let mesh = MeshBuffers::new(device, &place.frame(settings(Method::Vertex)))?;
        let make = |name: &str, settings: Settings, parts: Parts| {
            Variant::new(device, &mesh, place, name, settings, parts)
        };
        let cube = Settings { cull_faces: true, ..settings(Method::Cube) };
        let mut variants = vec![
            make("vertex", settings(Method::Vertex), Parts::ALL)?,
            make("cube, faces culled, lists kept", cube, KEPT)?,
            Variant::floor(device, place, settings(Method::Refined))?,
        ];
        let texel = 2.0 / SIZE as f32;
        let tried =
            [(0.03125, 0.5), (0.125, 0.5), (0.25, 0.5), (0.5, 0.5), (0.25, 0.25), (0.25, 1.0)];
        for (tau, share) in tried {
            let depth_tolerance = Some(share * texel);
            let settings = Settings { tau, depth_tolerance, ..settings(Method::Refined) };
            variants.push(make(&format!("refined, tau {tau}, {share} texel"), settings, KEPT)?);
        }
        let times = time(device, &mesh, &variants, RUNS)?;
        table(place, &variants, &times);
    }
    Ok(())
}

/// Where the time of the refined method goes, by leaving stages out.
fn parts(device: &Device) -> Result<(), GpuError> {
    println!("\nwhere the time goes: the same passes with stages left out\n");
    for place in [Place::built_in("brabec-room", 1), Place::of(scene::dozen(40_000), "dozen")] {
        println!("{}\n\n| stages | ms |\n|---|---|", place.name);
        let frame = place.frame(settings(Method::Vertex));
        let mesh = MeshBuffers::new(device, &frame)?;
        let stages = [
            ("all, lists each frame", Parts::ALL),
            ("lists alone", Parts { draw: false, ..Parts::ALL }),
            ("drawing alone", KEPT),
            ("drawing without planes", Parts { planes: false, ..KEPT }),
            ("drawing without depth-only triangles", Parts { flat: false, ..KEPT }),
            ("an empty pass a map", Parts { flat: false, planes: false, ..KEPT }),
        ];
        let mut variants = Vec::new();
        for (name, parts) in stages {
            let settings = Settings { keep_lists: true, ..settings(Method::Refined) };
            let maps = ShadowMaps::new(device, &place.frame(settings), &mesh)?;
            variants.push(Variant::of(name, maps, parts));
        }
        let times = time(device, &mesh, &variants, RUNS)?;
        for (time, (name, _)) in times.iter().zip(stages) {
            println!("| {name} | {:.2} |", time.median);
        }
        println!();
    }
    Ok(())
}
