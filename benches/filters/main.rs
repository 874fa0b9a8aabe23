//! What the filters cost: ns a pixel and ratios on the adapter, interleaved, and the SPIR-V
//! instructions of their loops. `cargo bench --bench filters [-- time | instructions]`; `-- page`
//! writes docs/seam.md and its pictures.

mod page;
mod spirv;

use dpsm::gpu::{
    self, ALONE, Device, Evaluator, GpuError, Resources, Stamps, Texels, Timed, comparison_sampler,
    compute_writes,
};
use dpsm::render::Format;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use wgpu::BufferUsages as Usage;

/// Timed runs of each variant, after one that is thrown away; variants take turns.
const RUNS: u32 = 15;

/// Pixels along a side: neighbours look at neighbouring texels, as on a wall.
const SIDE: usize = 512;

/// Map size, layers enough for a cube's faces.
const SIZE: u32 = 1024;

/// Imports and the light that all variants share, and taps of each kind.
const SHARED: &str = "
import dpsm::bias::{dpsm_receiver};
import dpsm::cube::{dpsm_cube_visibility};
import dpsm::filter::{
    DpsmTaps, dpsm_filter_disk, dpsm_filter_hardware, dpsm_filter_mirror, dpsm_filter_pcf,
    dpsm_filter_reproject,
};
import dpsm::kernel::{dpsm_kernel, dpsm_kernel_ring, dpsm_kernel_turn};
import dpsm::light::{DpsmLight};
import dpsm::pcss::{dpsm_pcss};
import dpsm::plane::{dpsm_visibility_normal, dpsm_visibility_plane};
import dpsm::visibility::{dpsm_visibility};

const LIGHT = DpsmLight(
    vec3<f32>(0.0), 0.1, vec3<f32>(1.0, 0.0, 0.0), 20.0, vec3<f32>(0.0, 1.0, 0.0), 0.003,
    vec3<f32>(0.0, 0.0, 1.0), 1024.0, vec4<f32>(0.0, 0.0, 1.0, 1.0), 0u, 0u, 2u, 0u,
);
const HARD = DpsmTaps(16u, 0u, 0.0, 0.0);
const LINEAR = DpsmTaps(16u, 1u, 0.0, 0.0);
const FIRST = vec2<f32>(0.6, 0.8);
const TANGENT = 0.02;
fn pixel(
    maps: texture_depth_2d_array,
    comparison: sampler_comparison,
    point: sampler,
    p: vec3<f32>,
    normal: vec3<f32>,
) -> f32 {
    let receiver = dpsm_receiver(p, normal, 0.0);
";

/// Name, sampling and body of each variant; each is compared with the variant named last.
const VARIANTS: &[(&str, Sampling, &str, &str)] = &[
    (
        "naive 4 x 4",
        Sampling::Nearest,
        "return dpsm_filter_pcf(maps, comparison, p, LIGHT, 4u, 0.01);",
        "naive 4 x 4",
    ),
    (
        "disk 16",
        Sampling::Nearest,
        "return dpsm_filter_disk(maps, point, p, receiver, TANGENT, LIGHT, HARD, FIRST);",
        "naive 4 x 4",
    ),
    (
        "mirror 16",
        Sampling::Nearest,
        "return dpsm_filter_mirror(
            maps, comparison, receiver, dpsm_kernel(p, TANGENT), LIGHT, HARD, FIRST,
        );",
        "naive 4 x 4",
    ),
    (
        "reproject 16",
        Sampling::Nearest,
        "return dpsm_filter_reproject(
            maps, comparison, p, TANGENT, receiver, LIGHT, HARD, FIRST,
        );",
        "naive 4 x 4",
    ),
    (
        "disk 16 again",
        Sampling::Nearest,
        "return dpsm_filter_disk(maps, point, p, receiver, TANGENT, LIGHT, HARD, FIRST);",
        "reproject 16",
    ),
    (
        "pcss 16 + 16",
        Sampling::Nearest,
        "return dpsm_pcss(maps, point, p, receiver, LIGHT, HARD, 0.1, 1.0, FIRST);",
        "naive 4 x 4",
    ),
    (
        "cube 16",
        Sampling::Nearest,
        "var direction = FIRST;
        var sum = 0.0;
        var index = 0u;
        while index < 16u {
            let offset = direction * (dpsm_kernel_ring(index, 16u) * TANGENT * length(p));
            let q = p + vec3<f32>(offset, 0.0);
            sum += dpsm_cube_visibility(maps, comparison, q, LIGHT, 0.01);
            direction = dpsm_kernel_turn(direction);
            index += 1u;
        }
        return sum / 16.0;",
        "disk 16",
    ),
    (
        "hardware 2 x 2, constant bias",
        Sampling::Linear,
        "return dpsm_visibility(maps, comparison, p, LIGHT, 0.01);",
        "hardware 2 x 2, constant bias",
    ),
    (
        "plane",
        Sampling::Nearest,
        "return dpsm_visibility_plane(maps, point, p, receiver, LIGHT, 0.0, 0.0);",
        "hardware 2 x 2, constant bias",
    ),
    (
        "normal",
        Sampling::Linear,
        "return dpsm_visibility_normal(maps, comparison, p, receiver, LIGHT, 0.0, 0.0);",
        "hardware 2 x 2, constant bias",
    ),
    (
        "hardware 2 x 2, footprint",
        Sampling::Linear,
        "return dpsm_filter_hardware(maps, comparison, p, receiver, LIGHT, LINEAR);",
        "hardware 2 x 2, constant bias",
    ),
    (
        "hard at the texel's centre",
        Sampling::Nearest,
        "return dpsm_filter_hardware(maps, comparison, p, receiver, LIGHT, HARD);",
        "hardware 2 x 2, constant bias",
    ),
];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let wanted = |name: &str| arguments.is_empty() || arguments.iter().any(|asked| asked == name);
    if wanted("instructions") {
        spirv::table();
    }
    let page = arguments.iter().any(|asked| asked == "page");
    if wanted("time") || page {
        let device = match Device::open() {
            Ok(device) => device,
            Err(error) => return println!("no times: {error}"),
        };
        println!("adapter: {}", device.describe());
        if page {
            if let Err(error) = page::write(&device) {
                println!("{error}");
            }
        } else if let Err(error) = times(&device) {
            println!("{error}");
        }
    }
}

/// Points of a wall of SIDE x SIDE pixels, and their normals: in the middle of the front map, or
/// with the seam across all of it.
fn wall(seam: bool) -> Vec<u32> {
    let mut words = Vec::new();
    for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
        let [x, y] = [x, y].map(|c| c as f32 / SIDE as f32 - 0.5);
        // in the seam every kernel's disk has its centre within a hundredth of the rim
        let p = if seam { [3.0, 3.0 * x, 0.06 * y] } else { [2.0 * x + 0.5, 2.0 * y + 0.5, 3.0] };
        let normal = if seam { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
        words.extend(p.into_iter().chain(normal).map(f32::to_bits));
    }
    words
}

/// Casters in front of half of all directions, in bands of some texels.
fn maps() -> DepthMaps {
    let mut maps = DepthMaps::empty(SIZE, 6, Sampling::Nearest);
    for (index, depth) in maps.depths.iter_mut().enumerate() {
        let (x, y) = (index as u32 % SIZE, index as u32 / SIZE);
        *depth = if (x / 37 + y / 29) % 2 == 0 { 0.07 } else { 1.0 };
    }
    maps
}

fn times(device: &Device) -> Result<(), GpuError> {
    let texture = Texels::new(device)?.upload(device, &maps(), Format::D32)?;
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let point = dpsm::gpu::point_sampler(device)?;
    let samplers = [
        comparison_sampler(device, Sampling::Nearest, false)?,
        comparison_sampler(device, Sampling::Linear, false)?,
    ];
    let mut evaluators = Vec::new();
    for (_, _, body, _) in VARIANTS {
        let linked = dpsm::link_source("pixel.wesl", &format!("{SHARED}{body}\n}}\n"))?;
        evaluators.push(Evaluator::of(device, &linked, "pixel")?);
    }
    println!("{RUNS} runs, interleaved; {SIDE} x {SIDE} pixels, maps of {SIZE}");
    for (place, seam) in [("away from the seam", false), ("on the seam", true)] {
        let words = wall(seam);
        let records = SIDE * SIDE;
        let bytes = |words: usize| (words * 4) as u64;
        let input = &device.upload("pixels", bytemuck::cast_slice(&words), Usage::STORAGE)?;
        let output = &device.buffer("visibilities", bytes(records), Usage::STORAGE)?;
        let timed: Vec<_> = evaluators
            .iter()
            .enumerate()
            .map(|(index, evaluator)| {
                let sampler = &samplers[usize::from(VARIANTS[index].1 == Sampling::Linear)];
                let resources = Some(Resources { texture: &view, sampler, point: &point });
                move |encoder: &mut wgpu::CommandEncoder, stamps: Stamps<'_>| {
                    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                        label: None,
                        timestamp_writes: compute_writes(stamps, ALONE),
                    });
                    evaluator.record(&mut pass, input, output, records, resources);
                }
            })
            .collect();
        let timed: Vec<Timed<'_>> = timed.iter().map(|record| ("filter", record as _)).collect();
        let times = device.time_in_turn(&timed, 1, RUNS)?;
        println!("\n{place}\n\n| filter | ns a pixel | quartiles | ratio | to |");
        println!("|---|---|---|---|---|");
        let nanos: Vec<[f64; 3]> = times
            .iter()
            .map(|times| {
                let [_, low, median, high] = gpu::quartiles(times);
                [low, median, high].map(|seconds| seconds * 1e9 / records as f64)
            })
            .collect();
        for ((name, _, _, to), [low, median, high]) in VARIANTS.iter().zip(&nanos) {
            let base = VARIANTS.iter().position(|(name, ..)| name == to).unwrap_or(0);
            let ratio = median / nanos[base][1];
            println!("| {name} | {median:.1} | {low:.1} to {high:.1} | {ratio:.2} | {to} |");
        }
    }
    Ok(())
}
