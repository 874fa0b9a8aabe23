//! The pipelines of the map passes, and helpers for bindings and depth attachments.

use super::mesh::{POSITION_LAYOUT, SURFACE_LAYOUT};
use super::multiview::{multiview_text, view_mask};
use super::{Device, GpuError};
use crate::link::link_source;
use crate::render::{Format, Method, Settings};
use crate::scalar::light::DpsmLight;
use crate::validate::validate;

/// The shader's struct MapPass.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct MapPass {
    pub light: DpsmLight<f32>,
    pub hemisphere: u32,
    pub first: u32,
    pub triangles: u32,
    pub first_masked: u32,
    pub first_vertex: u32,
    pub vertices: u32,
    pub capacity: u32,
    pub extra: u32,
    pub vertex_room: u32,
    pub queue_room: u32,
    pub levels: u32,
    pub padding: u32,
    pub middle: [f32; 2],
    pub texel: f32,
    pub tau: f32,
    pub depth_tolerance: f32,
    pub scale: f32,
    pub rest: [u32; 2],
}

/// Bytes from one pass's uniforms to the next, WebGPU's alignment of dynamic offsets.
pub const PASS_BYTES: usize = 256;

/// What a pipeline's vertex stage reads from vertex buffers.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reads {
    Positions,
    Surfaces,
    Refined,
    Planar,
    Nothing,
}

/// How maps store depths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stored {
    /// Storage of the maps.
    pub format: Format,
    /// Whether they hold 1 less the depth.
    pub reversed: bool,
}

impl Stored {
    /// What is drawn into them.
    fn compare(self) -> wgpu::CompareFunction {
        match self.reversed {
            false => wgpu::CompareFunction::Less,
            true => wgpu::CompareFunction::Greater,
        }
    }
}

impl Settings {
    /// How a frame's maps store depths.
    pub(super) fn stored(&self) -> Stored {
        Stored { format: self.format, reversed: self.reversed }
    }
}

/// Vertex and fragment entry points.
type Stages = (&'static str, Option<&'static str>, Reads);

/// Of a refined vertex its distance, and its disk coordinates in both maps.
const REFINED_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: 32,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &[
        wgpu::VertexAttribute {
            format: wgpu::VertexFormat::Float32,
            offset: 12,
            shader_location: 5,
        },
        wgpu::VertexAttribute {
            format: wgpu::VertexFormat::Float32x4,
            offset: 16,
            shader_location: 6,
        },
    ],
};

/// Of a vertex of what is drawn with its plane: disk coordinates, plane, its triangle, and the least
/// distance.
const PLANAR_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: 32,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![5 => Float32x2, 6 => Float32x4, 7 => Uint32, 8 => Float32],
};

/// The draws of a method, one pipeline each: opaque triangles first, alpha-tested ones last.
fn stages(method: Method) -> &'static [Stages] {
    match method {
        Method::Vertex => &[
            ("vertex_method", Some("vertex_method_fragment"), Reads::Positions),
            ("vertex_method_masked", Some("vertex_method_masked_fragment"), Reads::Surfaces),
        ],
        Method::FragmentDepth => &[
            ("fragment_depth_method", Some("fragment_depth_method_fragment"), Reads::Positions),
            ("fragment_depth_masked", Some("fragment_depth_masked_fragment"), Reads::Surfaces),
        ],
        Method::Tessellated => &[
            ("tessellated", Some("vertex_method_fragment"), Reads::Nothing),
            ("tessellated", Some("vertex_method_masked_fragment"), Reads::Nothing),
        ],
        Method::Exact => &[
            ("exact", Some("exact_fragment"), Reads::Nothing),
            ("exact", Some("exact_masked_fragment"), Reads::Nothing),
        ],
        Method::Refined => &[
            ("refined", None, Reads::Refined),
            ("planar", Some("planar_fragment"), Reads::Planar),
            ("planar_masked", Some("planar_masked_fragment"), Reads::Planar),
            ("whole", Some("exact_masked_fragment"), Reads::Nothing),
        ],
        Method::Cube => &[
            ("cube", None, Reads::Positions),
            ("cube_masked", Some("cube_masked_fragment"), Reads::Surfaces),
        ],
    }
}

/// The layout of what the map passes bind.
pub fn map_bindings(device: &Device) -> Result<wgpu::BindGroupLayout, GpuError> {
    let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT;
    let mut entries = vec![uniform_entry(visibility)];
    entries.extend((1..6).map(|i| storage(i, true, visibility)));
    let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some("maps"), entries: &entries };
    device.step("the map bindings", || device.device.create_bind_group_layout(&descriptor))
}

/// The pipelines of a method, for passes of so many views.
pub fn pipelines(
    device: &Device,
    bindings: &wgpu::BindGroupLayout,
    method: Method,
    maps: Stored,
    views: u32,
) -> Result<Vec<wgpu::RenderPipeline>, GpuError> {
    let text = concat!(
        include_str!("caster.wesl"),
        include_str!("pass.wesl"),
        include_str!("position.wesl"),
        include_str!("mask.wesl")
    );
    let module = match views {
        1 => shader(device, "caster.wesl", text)?,
        _ => shader(device, "caster.wesl for multiview", &multiview_text(text))?,
    };
    device.step("the map pipelines", || {
        let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("maps"),
            bind_group_layouts: &[Some(bindings)],
            immediate_size: 0,
        });
        let make = |stages: &Stages| pipeline(device, &module, &layout, *stages, maps, views);
        stages(method).iter().map(make).collect()
    })
}

fn pipeline(
    device: &Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    (vertex, fragment, reads): Stages,
    maps: Stored,
    views: u32,
) -> wgpu::RenderPipeline {
    let buffers: &[_] = match reads {
        Reads::Positions => &[Some(POSITION_LAYOUT)],
        Reads::Surfaces => &[Some(POSITION_LAYOUT), Some(SURFACE_LAYOUT)],
        Reads::Refined => &[Some(REFINED_LAYOUT)],
        Reads::Planar => &[Some(PLANAR_LAYOUT)],
        Reads::Nothing => &[],
    };
    device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers,
        },
        primitive: Default::default(),
        depth_stencil: Some(depth_state(maps.format.texture(), maps.compare())),
        multisample: Default::default(),
        fragment: fragment.map(|fragment| wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: view_mask(views),
        cache: None,
    })
}

/// Binding 0: one pass's uniforms, at a dynamic offset.
pub fn uniform_entry(visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: true,
        min_binding_size: None,
    };
    wgpu::BindGroupLayoutEntry { binding: 0, visibility, ty, count: None }
}

/// A storage buffer's binding.
pub fn storage(
    binding: u32,
    read_only: bool,
    visibility: wgpu::ShaderStages,
) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

/// Binds resources in the order of their numbers.
pub fn bind(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    resources: Vec<wgpu::BindingResource<'_>>,
) -> wgpu::BindGroup {
    let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
    let entries: Vec<_> = (0..).zip(resources).map(entry).collect();
    let descriptor = wgpu::BindGroupDescriptor { label: None, layout, entries: &entries };
    device.device.create_bind_group(&descriptor)
}

/// A depth texture with `layers` layers, checked against the adapter's limits.
pub fn depth_texture(
    device: &Device,
    [width, height]: [u32; 2],
    layers: u32,
    format: wgpu::TextureFormat,
) -> Result<wgpu::Texture, GpuError> {
    let limits = device.device.limits();
    for (what, asked, limit) in [
        ("--size", width.max(height), limits.max_texture_dimension_2d),
        ("number of maps", layers, limits.max_texture_array_layers),
    ] {
        if !(1..=limit).contains(&asked) {
            return Err(GpuError::Limit { what, asked: asked.into(), limit: limit.into() });
        }
    }
    device.step("the maps' texture", || {
        device.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("maps"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        })
    })
}

/// Some layers, to draw into: one alone, or one a view.
pub fn layers_view(texture: &wgpu::Texture, first: u32, count: u32) -> wgpu::TextureView {
    let dimension = match count {
        1 => wgpu::TextureViewDimension::D2,
        _ => wgpu::TextureViewDimension::D2Array,
    };
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(dimension),
        base_array_layer: first,
        array_layer_count: Some(count),
        ..Default::default()
    })
}

/// A depth attachment that is cleared first.
pub fn depth_attachment(
    view: &wgpu::TextureView,
    clear: f32,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(clear),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}

/// A depth test that writes.
pub fn depth_state(
    format: wgpu::TextureFormat,
    compare: wgpu::CompareFunction,
) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(true),
        depth_compare: Some(compare),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

/// Links, validates and compiles one of the host's shaders.
pub fn shader(device: &Device, path: &str, text: &str) -> Result<wgpu::ShaderModule, GpuError> {
    let linked = link_source(path, text)?;
    validate(&linked)?;
    let source = wgpu::ShaderSource::Wgsl(linked.text.as_str().into());
    let descriptor = wgpu::ShaderModuleDescriptor { label: Some(path), source };
    device.step(path, || device.device.create_shader_module(descriptor))
}

/// The light as the shader's struct, word by word.
pub fn light_words(light: &DpsmLight<f32>) -> Vec<u32> {
    bytemuck::cast_slice(bytemuck::bytes_of(light)).to_vec()
}

/// A uniform buffer that holds these words.
pub fn uniform_buffer(device: &Device, words: &[u32]) -> Result<wgpu::Buffer, GpuError> {
    let bytes: &[u8] = bytemuck::cast_slice(words);
    let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
    let buffer = device.buffer("uniform buffer bytes", bytes.len() as u64, usage)?;
    device.step("the uniforms", || device.queue.write_buffer(&buffer, 0, bytes))?;
    Ok(buffer)
}
