//! Depth textures from and to arrays, for formats that cannot be copied.

use super::passes::{
    depth_attachment, depth_state, depth_texture, layers_view, shader, uniform_buffer,
};
use super::{Device, GpuError};
use crate::render::Format;
use crate::scalar::maps::DepthMaps;

/// Texels along a side of a workgroup of texels.wesl's download.
const TILE: u32 = 8;

/// The passes' shader.
#[derive(Debug)]
pub struct Texels {
    module: wgpu::ShaderModule,
}

impl Texels {
    /// Compiles the passes.
    pub fn new(device: &Device) -> Result<Self, GpuError> {
        let module = shader(device, "texels.wesl", include_str!("texels.wesl"))?;
        Ok(Self { module })
    }

    /// Every layer's stored depths, row by row.
    pub fn download(
        &self,
        device: &Device,
        view: &wgpu::TextureView,
        texture: &wgpu::Texture,
    ) -> Result<Vec<f32>, GpuError> {
        use wgpu::BufferUsages as Usage;
        let size = texture.width();
        let rows = texture.depth_or_array_layers() * texture.height();
        let band = (device.chunk_bytes / (u64::from(size) * 4)).clamp(1, u64::from(rows)) as u32;
        let bytes = u64::from(band) * u64::from(size) * 4;
        let texels = device.buffer("texels", bytes, Usage::STORAGE | Usage::COPY_SRC)?;
        let back = device.buffer("texels read back", bytes, Usage::MAP_READ | Usage::COPY_DST)?;
        let uniform = uniform_buffer(device, &[0, 0, 0, 0])?;
        let (pipeline, group) = device.step("reading the maps", || {
            let pipeline =
                device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some("download"),
                    layout: None,
                    module: &self.module,
                    entry_point: Some("download"),
                    compilation_options: Default::default(),
                    cache: None,
                });
            let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("download"),
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: wgpu::BindingResource::TextureView(view),
                    },
                    wgpu::BindGroupEntry { binding: 1, resource: texels.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 3, resource: uniform.as_entire_binding() },
                ],
            });
            (pipeline, group)
        })?;
        let mut depths = Vec::new();
        for first in (0..rows).step_by(band as usize) {
            let taken = band.min(rows - first);
            let encoder = device.encode("reading the maps", |encoder| {
                device.queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&[first, taken]));
                let mut pass = encoder.begin_compute_pass(&Default::default());
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.dispatch_workgroups(size.div_ceil(TILE), taken.div_ceil(TILE), 1);
                drop(pass);
                encoder.copy_buffer_to_buffer(&texels, 0, &back, 0, bytes);
            })?;
            device.submit("reading the maps", encoder)?;
            let bytes = u64::from(taken) * u64::from(size) * 4;
            let band: Vec<f32> = bytemuck::pod_collect_to_vec(&device.read(&back, bytes)?);
            depths.extend(band);
        }
        Ok(depths)
    }

    /// A depth texture that stores the given maps.
    pub fn upload(
        &self,
        device: &Device,
        maps: &DepthMaps,
        format: Format,
    ) -> Result<wgpu::Texture, GpuError> {
        use wgpu::BufferUsages as Usage;
        let texture = depth_texture(device, [maps.size; 2], maps.layers, format.texture())?;
        let bytes: &[u8] = bytemuck::cast_slice(&maps.depths);
        let depths =
            device.buffer("depth bytes", bytes.len() as u64, Usage::STORAGE | Usage::COPY_DST)?;
        let encoder = device.encode("writing the maps", |encoder| {
            device.queue.write_buffer(&depths, 0, bytes);
            let pipeline = self.upload_pipeline(device, maps.size, format);
            let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("upload"),
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[wgpu::BindGroupEntry {
                    binding: 2,
                    resource: depths.as_entire_binding(),
                }],
            });
            for layer in 0..maps.layers {
                let view = layers_view(&texture, layer, 1);
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("upload"),
                    depth_stencil_attachment: Some(depth_attachment(&view, 1.0)),
                    ..Default::default()
                });
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.draw(0..3, layer..layer + 1);
            }
        })?;
        device.submit("writing the maps", encoder)?;
        Ok(texture)
    }

    fn upload_pipeline(&self, device: &Device, size: u32, format: Format) -> wgpu::RenderPipeline {
        device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("upload"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some("upload"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(depth_state(format.texture(), wgpu::CompareFunction::Always)),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some("upload_fragment"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &[("size", f64::from(size))],
                    ..Default::default()
                },
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
