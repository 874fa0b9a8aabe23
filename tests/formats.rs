//! Depth formats on the adapter: depths that are rendered are stored within one quantum, and a
//! depth is not less than itself beyond what the bias allows.

#![cfg(feature = "gpu")]

mod common;

use common::{device, rng};
use dpsm::gpu::{Device, comparison_sampler};
use dpsm::render::Format;
use dpsm::scalar::maps::Sampling;
use wgpu::BufferUsages as Usage;

/// Texels along a side.
const SIZE: u32 = 256;
const COUNT: usize = (SIZE * SIZE) as usize;

/// eps, the error of one f32 operation.
const EPS: f32 = f32::EPSILON;

/// How a depth gets into the attachment.
#[derive(Clone, Copy, Debug, PartialEq)]
enum By {
    /// The fragment stage's frag_depth.
    Fragment,
    /// The vertex stage's position, interpolated over a triangle.
    Position,
}

const TEXT: &str = "
@group(0) @binding(0) var<storage, read> depths: array<f32>;
const SIZE: u32 = 256u;

// One triangle over all texels.
@vertex
fn whole(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn depth_of(@builtin(position) at: vec4<f32>) -> @builtin(frag_depth) f32 {
    let texel = vec2<u32>(at.xy);
    return depths[texel.y * SIZE + texel.x];
}

// One triangle a texel, around its centre.
@vertex
fn texel(
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,
) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(vertex & 1u), f32(vertex >> 1u)) - 0.25;
    let at = vec2<f32>(vec2<u32>(instance % SIZE, instance / SIZE)) + 0.5 + 0.75 * corner;
    let disk = at / f32(SIZE) * 2.0 - 1.0;
    return vec4<f32>(disk.x, -disk.y, depths[instance], 1.0);
}

@group(0) @binding(1) var map: texture_depth_2d;
@group(0) @binding(2) var comparison: sampler_comparison;
@group(0) @binding(3) var<storage, read_write> found: array<vec4<f32>>;
struct Bias { most: f32, quantum: f32 }
@group(0) @binding(4) var<uniform> bias: Bias;

// What is stored, and whether it is lit without a bias, with a quantum's and with the modules'.
@compute @workgroup_size(64)
fn compare(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<u32>(id.x % SIZE, id.x / SIZE);
    let st = (vec2<f32>(at) + 0.5) / f32(SIZE);
    let own = depths[id.x];
    found[id.x] = vec4<f32>(
        textureLoad(map, at, 0),
        textureSampleCompareLevel(map, comparison, st, own),
        textureSampleCompareLevel(map, comparison, st, own - bias.quantum),
        textureSampleCompareLevel(map, comparison, st, own - bias.most),
    );
}
";

/// Depths in [0, 1]: the first half steps of each format, between them, beside them and small
/// ones, the others uniform.
fn depths() -> Vec<f32> {
    let mut rng = rng("depths");
    let mut all = vec![0.0, 1.0, 1e-40, f32::MIN_POSITIVE, 1e-20, 1e-9, 1.0_f32.next_down()];
    while all.len() < COUNT / 2 {
        let steps = [65535.0, 16777215.0][rng.usize(0..2)];
        let step = (rng.f64() * steps).floor();
        let depth = match rng.u32(0..4) {
            0 => (step / steps) as f32,
            1 => ((step + 0.5) / steps) as f32,
            2 => ((step / steps) as f32).next_up(),
            _ => ((step / steps) as f32).next_down(),
        };
        all.push(depth.clamp(0.0, 1.0));
    }
    all.resize_with(COUNT, || rng.f32());
    all
}

/// Renders the depths, and what is found of each: stored, lit, lit less a quantum, less the bias.
fn found(device: &Device, depths: &[f32], format: Format, by: By, bias: f32) -> Vec<[f32; 4]> {
    let gpu = &device.device;
    let source = wgpu::ShaderSource::Wgsl(TEXT.into());
    let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let texture = gpu.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: format.texture(),
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let view = texture.create_view(&Default::default());
    let draw = gpu.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(if by == By::Fragment { "whole" } else { "texel" }),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: format.texture(),
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: (by == By::Fragment).then(|| wgpu::FragmentState {
            module: &module,
            entry_point: Some("depth_of"),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    });
    let compare = gpu.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("compare"),
        compilation_options: Default::default(),
        cache: None,
    });
    let input = device.upload("depths", bytemuck::cast_slice(depths), Usage::STORAGE).unwrap();
    let size = 16 * depths.len() as u64;
    let output = device.buffer("found", size, Usage::STORAGE | Usage::COPY_SRC).unwrap();
    let back = device.buffer("back", size, Usage::MAP_READ | Usage::COPY_DST).unwrap();
    let biases = [bias, format.quantum(), 0.0, 0.0];
    let biases = device.upload("bias", bytemuck::cast_slice(&biases), Usage::UNIFORM).unwrap();
    let sampler = comparison_sampler(device, Sampling::Nearest, false).unwrap();
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    let group = |layout: wgpu::BindGroupLayout, entries: &[wgpu::BindGroupEntry]| {
        gpu.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries })
    };
    let drawn = group(draw.get_bind_group_layout(0), &[entry(0, input.as_entire_binding())]);
    let compared = group(
        compare.get_bind_group_layout(0),
        &[
            entry(0, input.as_entire_binding()),
            entry(1, wgpu::BindingResource::TextureView(&view)),
            entry(2, wgpu::BindingResource::Sampler(&sampler)),
            entry(3, output.as_entire_binding()),
            entry(4, biases.as_entire_binding()),
        ],
    );
    let mut encoder = gpu.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.5),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&draw);
    pass.set_bind_group(0, &drawn, &[]);
    pass.draw(0..3, if by == By::Fragment { 0..1 } else { 0..SIZE * SIZE });
    drop(pass);
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&compare);
    pass.set_bind_group(0, &compared, &[]);
    pass.dispatch_workgroups(SIZE * SIZE / 64, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&output, 0, &back, 0, size);
    device.submit("depths", encoder).unwrap();
    bytemuck::pod_collect_to_vec(&device.read(&back, size).unwrap())
}

#[test]
fn rendered_depths_are_stored_within_a_quantum_and_lit_against_themselves_with_the_bias() {
    let Some(device) = device() else { return };
    let depths = depths();
    println!("{:<16}{:>12}{:>12}{:>26}", "format", "off", "quantum", "falsely shadowed");
    for format in [Format::D16, Format::D24, Format::D32] {
        for by in [By::Fragment, By::Position] {
            // interpolation over a triangle: three products and their sum
            let interpolated = if by == By::Position { 4.0 * EPS } else { 0.0 };
            // the modules' for formats and their rounding (DPSM_BIAS_DEPTH)
            let rounding = if format == Format::D32 { interpolated } else { 2.0 * EPS };
            let bias = format.quantum() + rounding;
            let found = found(&device, &depths, format, by, bias);
            let off = depths.iter().zip(&found).map(|(d, found)| (found[0] - d).abs());
            let most = off.clone().fold(0.0, f32::max);
            // subnormals may be stored as 0
            let normal = |depth: f32| depth == 0.0 || depth.is_normal();
            let shadowed = |column: usize, first: usize| {
                let all = depths.iter().zip(&found).skip(first);
                all.filter(|(depth, found)| normal(**depth) && found[column] == 0.0).count()
            };
            let share = |column| 100.0 * shadowed(column, COUNT / 2) as f64 / (COUNT / 2) as f64;
            println!(
                "{:<16}{most:>12.3e}{:>12.3e}{:>25.1}%, less a quantum {:.1}%, less the bias {:.1}%",
                format!("{format:?} {by:?}"),
                format.quantum(),
                share(1),
                share(2),
                share(3),
            );
            let allowed = format.quantum() + interpolated + f32::MIN_POSITIVE;
            // a 24-bit unorm is itself rounded to f32
            let read = if format == Format::D24 { EPS } else { 0.0 };
            assert!(most <= allowed + read, "{format:?} by {by:?}: {most:e}");
            assert_eq!(shadowed(3, 0), 0, "{format:?} by {by:?}");
            if format == Format::D32 && by == By::Fragment {
                assert_eq!(shadowed(1, 0), 0, "{format:?} by {by:?}");
            }
        }
    }
}
