//! The least that maps can cost here: one depth-only draw of each triangle in the maps that it
//! touches, as it is, from vertices that are projected already. Its maps are wrong.

use dpsm::gpu::{Device, GpuError};
use dpsm::render::{Frame, float};
use dpsm::scalar::classify::{DPSM_IN_BACK, DPSM_IN_FRONT, dpsm_classify, dpsm_projected};
use dpsm::scalar::hemisphere::{DPSM_BACK, DPSM_FRONT, dpsm_flip, dpsm_to_light};
use dpsm::scalar::refine::dpsm_refine_clip;
use dpsm::scalar::triangle::dpsm_triangle_plane;

const SHADER: &str = "
@vertex fn vertex(@location(0) clip: vec3<f32>) -> @builtin(position) vec4<f32> {
    return vec4<f32>(clip, 1.0);
}
";

/// One map's triangles.
struct Map {
    target: wgpu::TextureView,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

pub struct Floor {
    pipeline: wgpu::RenderPipeline,
    maps: Vec<Map>,
}

impl Floor {
    pub fn new(device: &Device, frame: &Frame) -> Result<Self, GpuError> {
        let light = frame.light;
        let module = device.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("floor"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let pipeline = device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("floor"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 12,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                })],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        });
        let size = frame.settings.size;
        let texture = device.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("floor"),
            size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 2 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Depth32Float,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let placed: Vec<_> =
            frame.vertices.iter().map(|v| dpsm_to_light(float(v.position), light)).collect();
        let map = |(map, bit): (u32, u32)| {
            let seen: Vec<_> = placed.iter().map(|&p| dpsm_projected(dpsm_flip(p, map))).collect();
            let drawn = |corners: &&[u32; 3]| {
                let [a, b, c] = corners.map(|index| placed[index as usize]);
                let own = if a.z + b.z + c.z >= 0.0 { DPSM_FRONT } else { DPSM_BACK };
                let [a, b, c] = [a, b, c].map(|p| dpsm_projected(dpsm_flip(p, own)));
                let height = dpsm_triangle_plane(a.p, b.p, c.p).w;
                dpsm_classify(a, b, c, height, own, light) & bit != 0
            };
            let indices: Vec<u32> =
                frame.triangles.iter().filter(drawn).flatten().copied().collect();
            let clips: Vec<[f32; 3]> = seen
                .iter()
                .map(|at| {
                    let clip = dpsm_refine_clip(at.uv, at.distance, light);
                    [clip.x, clip.y, clip.z]
                })
                .collect();
            let target = texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: map,
                array_layer_count: Some(1),
                ..Default::default()
            });
            let vertex = wgpu::BufferUsages::VERTEX;
            Ok(Map {
                target,
                vertices: device.upload("floor", bytemuck::cast_slice(&clips), vertex)?,
                indices: device.upload(
                    "floor",
                    bytemuck::cast_slice(&indices),
                    wgpu::BufferUsages::INDEX,
                )?,
                count: indices.len() as u32,
            })
        };
        let maps = [(DPSM_FRONT, DPSM_IN_FRONT), (DPSM_BACK, DPSM_IN_BACK)];
        let maps = maps.into_iter().map(map).collect::<Result<_, GpuError>>()?;
        Ok(Self { pipeline, maps })
    }

    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        for map in &self.maps {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("floor"),
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &map.target,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(1.0),
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_vertex_buffer(0, map.vertices.slice(..));
            pass.set_index_buffer(map.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..map.count, 0, 0..1);
        }
    }
}
