//! The map passes: shadow maps in an array texture, one layer a hemisphere.

use super::texels::Texels;
use super::timer::{Stamps, render_writes};
use super::{Device, GpuError};
use crate::link::link_source;
use crate::render::{Format, Frame, Method, Vertex};
use crate::scalar::light::DpsmLight;
use crate::scalar::maps::{DepthMaps, Sampling};
use crate::validate::validate;

/// A frame's triangles in the adapter's memory.
#[derive(Debug)]
pub struct MeshBuffers {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl MeshBuffers {
    /// Uploads the triangles of a frame.
    pub fn new(device: &Device, frame: &Frame) -> Result<Self, GpuError> {
        use wgpu::BufferUsages as Usage;
        let vertices = bytemuck::cast_slice(&frame.vertices);
        let indices = bytemuck::cast_slice(frame.triangles.as_flattened());
        let upload = |label, bytes: &[u8], usage| {
            let buffer = device.buffer(label, bytes.len() as u64, usage | Usage::COPY_DST)?;
            device.step(label, || device.queue.write_buffer(&buffer, 0, bytes))?;
            Ok::<_, GpuError>(buffer)
        };
        Ok(Self {
            vertices: upload("vertex buffer bytes", vertices, Usage::VERTEX)?,
            indices: upload("index buffer bytes", indices, Usage::INDEX)?,
            count: frame.triangles.len() as u32 * 3,
        })
    }

    /// Draws every triangle with the given instance index.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, instance: u32) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, instance..instance + 1);
    }
}

/// The vertex buffer's layout: position, normal, albedo.
pub const VERTEX_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<Vertex>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3],
};

/// Shadow maps of one light and the pipeline that draws them.
#[derive(Debug)]
pub struct ShadowMaps {
    /// The array texture.
    pub texture: wgpu::Texture,
    /// All layers, for sampling.
    pub view: wgpu::TextureView,
    layers: Vec<wgpu::TextureView>,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl Format {
    /// The texture format.
    pub fn texture(self) -> wgpu::TextureFormat {
        match self {
            Format::D16 => wgpu::TextureFormat::Depth16Unorm,
            Format::D24 => wgpu::TextureFormat::Depth24Plus,
            Format::D32 => wgpu::TextureFormat::Depth32Float,
        }
    }
}

impl ShadowMaps {
    /// Maps for a frame's light: size, format and method from its settings.
    pub fn new(device: &Device, frame: &Frame) -> Result<Self, GpuError> {
        let settings = &frame.settings;
        let texture = depth_texture(
            device,
            settings.size,
            frame.light.hemispheres,
            settings.format.texture(),
        )?;
        let layers =
            (0..frame.light.hemispheres).map(|layer| layer_view(&texture, layer)).collect();
        let (vertex, fragment) = match settings.method {
            Method::Vertex => ("vertex_method", "vertex_method_fragment"),
            Method::FragmentDepth => ("fragment_depth_method", "fragment_depth_method_fragment"),
        };
        let module = shader(device, "caster.wesl", include_str!("caster.wesl"))?;
        let uniform = uniform_buffer(device, &light_words(&frame.light))?;
        let pipeline = device.step("the map pipeline", || {
            device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("map"),
                layout: None,
                vertex: vertex_state(&module, vertex),
                primitive: Default::default(),
                depth_stencil: Some(depth_state(
                    settings.format.texture(),
                    wgpu::CompareFunction::Less,
                )),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(fragment),
                    compilation_options: Default::default(),
                    targets: &[],
                }),
                multiview_mask: None,
                cache: None,
            })
        })?;
        let group = device.step("the map bindings", || {
            device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("map"),
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: uniform.as_entire_binding(),
                }],
            })
        })?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(Self { texture, view, layers, pipeline, group })
    }

    /// Number of maps.
    pub fn hemispheres(&self) -> u32 {
        self.layers.len() as u32
    }

    /// Records the pass that makes one hemisphere's map.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        hemisphere: u32,
        mesh: &MeshBuffers,
        stamps: Stamps<'_>,
    ) {
        let view = &self.layers[hemisphere as usize];
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("map"),
            depth_stencil_attachment: Some(depth_attachment(view, 1.0)),
            timestamp_writes: render_writes(stamps),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        mesh.draw(&mut pass, hemisphere);
    }

    /// Reads the stored depths back.
    pub fn download(&self, device: &Device, sampling: Sampling) -> Result<DepthMaps, GpuError> {
        Texels::new(device)?.download(device, &self.view, &self.texture, sampling)
    }
}

/// A square depth texture with `layers` layers, checked against the adapter's limits.
pub fn depth_texture(
    device: &Device,
    size: u32,
    layers: u32,
    format: wgpu::TextureFormat,
) -> Result<wgpu::Texture, GpuError> {
    let limits = device.device.limits();
    for (what, asked, limit) in [
        ("--size", size, limits.max_texture_dimension_2d),
        ("number of maps", layers, limits.max_texture_array_layers),
    ] {
        if !(1..=limit).contains(&asked) {
            return Err(GpuError::Limit { what, asked: asked.into(), limit: limit.into() });
        }
    }
    device.step("the maps' texture", || {
        device.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("maps"),
            size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: layers },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        })
    })
}

/// One layer, to draw into.
pub fn layer_view(texture: &wgpu::Texture, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
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

/// A vertex stage that reads the frame's vertices.
pub fn vertex_state<'a>(
    module: &'a wgpu::ShaderModule,
    entry_point: &'a str,
) -> wgpu::VertexState<'a> {
    wgpu::VertexState {
        module,
        entry_point: Some(entry_point),
        compilation_options: Default::default(),
        buffers: &[Some(VERTEX_LAYOUT)],
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
