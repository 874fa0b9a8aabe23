//! The camera pass, and the whole rendering of a frame.

use super::lookup::{camera_shader, camera_uniform, constants};
use super::maps::ShadowMaps;
use super::mesh::MeshBuffers;
use super::passes::{depth_attachment, depth_state, light_words};
use super::timer::{ALONE, Stamps, render_writes};
use super::{Device, GpuError};
use crate::render::{Frame, Linear, Lookup, Projection, Rendering};
use crate::scalar::maps::{DepthMaps, Sampling};

/// Format of the pictures: linear light, as bright as it comes.
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Bytes of a pixel in it.
const PIXEL_BYTES: u32 = 16;

/// Format of the camera's own depth buffer, reversed: 0 is infinitely far.
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Renders a frame: maps, lit image and, where the settings ask for them, a view of each
/// hemisphere or face, which takes the processor's ray caster.
pub fn render(device: &Device, frame: &Frame) -> Result<Rendering, GpuError> {
    check_image(device, frame.settings.image)?;
    let mesh = MeshBuffers::new(device, frame)?;
    let lights: Vec<_> = std::iter::once(frame.light).chain(frame.more.iter().copied()).collect();
    let maps = ShadowMaps::with_lights(device, frame, &mesh, &lights)?;
    let mut timings = vec![device.time_warm("maps", |encoder, stamps| {
        maps.record(encoder, &mesh, stamps);
    })?];
    let camera = Camera::new(device, frame, &maps)?;
    let projection = frame.settings.method.projection();
    let stages = match (projection, frame.settings.lookup) {
        (Projection::Cube, _) => ["pixel_lookup", "cube_lookup_fragment"],
        (Projection::Paraboloid, Lookup::Pixel) if !frame.more.is_empty() => {
            ["pixel_lookup", "lights_fragment"]
        }
        (Projection::Paraboloid, Lookup::Pixel) => ["pixel_lookup", "pixel_lookup_fragment"],
        (Projection::Paraboloid, Lookup::Vertex) => ["vertex_lookup", "vertex_lookup_fragment"],
    };
    let (lit, time) = camera.lit(device, stages, &mesh)?;
    timings.push(time);
    let (views, stored) = match frame.settings.views {
        true => (
            crate::cpu::views(frame, &mut timings),
            Some(maps.download(device, frame.settings.sampling_taken())?),
        ),
        false => (Vec::new(), None),
    };
    Ok(Rendering::new(frame, &lit, &views, stored, timings))
}

/// Makes a frame's maps alone and reads them back.
pub fn make_maps(device: &Device, frame: &Frame) -> Result<DepthMaps, GpuError> {
    let mesh = MeshBuffers::new(device, frame)?;
    let maps = ShadowMaps::new(device, frame, &mesh)?;
    let encoder = device.encode("the maps", |encoder| maps.record(encoder, &mesh, None))?;
    device.submit("the maps", encoder)?;
    maps.download(device, frame.settings.sampling_taken())
}

fn check_image(device: &Device, image: [u32; 2]) -> Result<(), GpuError> {
    let limit = device.device.limits().max_texture_dimension_2d;
    match image.iter().find(|&&side| !(1..=limit).contains(&side)) {
        Some(&asked) => {
            let what = "--image side";
            Err(GpuError::Limit { what, asked: asked.into(), limit: limit.into() })
        }
        None => Ok(()),
    }
}

/// What the camera passes bind.
struct Camera<'a> {
    module: wgpu::ShaderModule,
    /// One for each sample of a pixel.
    uniforms: Vec<wgpu::Buffer>,
    constants: [(&'static str, f64); 2],
    sampler: wgpu::Sampler,
    point: wgpu::Sampler,
    lights: wgpu::Buffer,
    maps: &'a ShadowMaps,
    /// Width and height.
    image: [u32; 2],
}

/// A pass's name and time.
type Timing = (String, std::time::Duration);

impl<'a> Camera<'a> {
    fn new(device: &Device, frame: &Frame, maps: &'a ShadowMaps) -> Result<Self, GpuError> {
        let module = camera_shader(device)?;
        let image = frame.settings.image;
        let uniform = |place: &[f32; 2]| {
            camera_uniform(device, frame, &frame.view.sampled(*place, image), &maps.lights[0])
        };
        let uniforms = frame.settings.places().iter().map(uniform).collect::<Result<_, _>>()?;
        let constants = constants(frame);
        let sampler =
            comparison_sampler(device, frame.settings.sampling_taken(), frame.settings.reversed)?;
        let point = point_sampler(device)?;
        let all: Vec<u32> = maps.lights.iter().flat_map(light_words).collect();
        let bytes = bytemuck::cast_slice(&all);
        let lights = device.upload("light bytes", bytes, wgpu::BufferUsages::STORAGE)?;
        Ok(Self { module, uniforms, constants, sampler, point, lights, maps, image })
    }

    /// The mean of each pixel's samples, and the time of the first of them.
    fn lit(
        &self,
        device: &Device,
        stages: [&str; 2],
        mesh: &MeshBuffers,
    ) -> Result<(Linear, Timing), GpuError> {
        const NAME: &str = "camera";
        let [width, height] = self.image;
        let pipeline = device.step(NAME, || self.pipeline(device, stages))?;
        let target = |format, usage| {
            device.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(NAME),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let (color, depth, groups) = device.step(NAME, || {
            let color = target(COLOR, wgpu::TextureUsages::COPY_SRC);
            let depth = target(DEPTH, wgpu::TextureUsages::empty());
            let group = |uniform| self.group(device, &pipeline, uniform, mesh, stages);
            (color, depth, self.uniforms.iter().map(group).collect::<Vec<_>>())
        })?;
        let color_view = color.create_view(&Default::default());
        let depth_view = depth.create_view(&Default::default());
        let record = |group, encoder: &mut wgpu::CommandEncoder, stamps: Stamps<'_>| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(NAME),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &color_view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: Some(depth_attachment(&depth_view, 0.0)),
                timestamp_writes: render_writes(stamps, ALONE),
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..3 * mesh.triangles, 0..1);
        };
        let mut sum = Linear::empty(self.image);
        let mut timing = None;
        for group in &groups {
            if timing.is_none() {
                let record = |encoder: &mut _, stamps: Stamps<'_>| record(group, encoder, stamps);
                timing = Some(device.time_warm(NAME, record)?);
            } else {
                let encoder = device.encode(NAME, |encoder| record(group, encoder, None))?;
                device.submit(NAME, encoder)?;
            }
            sum.add(&linear(device, &color)?);
        }
        let nothing = || (NAME.into(), std::time::Duration::ZERO);
        Ok((sum.divided(groups.len() as u32), timing.unwrap_or_else(nothing)))
    }

    fn pipeline(&self, device: &Device, [vertex, fragment]: [&str; 2]) -> wgpu::RenderPipeline {
        let compilation_options =
            wgpu::PipelineCompilationOptions { constants: &self.constants, ..Default::default() };
        device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(vertex),
            layout: None,
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(vertex),
                compilation_options: compilation_options.clone(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(depth_state(DEPTH, wgpu::CompareFunction::Greater)),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(fragment),
                compilation_options,
                targets: &[Some(COLOR.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn group(
        &self,
        device: &Device,
        pipeline: &wgpu::RenderPipeline,
        uniform: &wgpu::Buffer,
        mesh: &MeshBuffers,
        stages: [&str; 2],
    ) -> wgpu::BindGroup {
        let lights = wgpu::BindGroupEntry { binding: 7, resource: self.lights.as_entire_binding() };
        let mut entries = vec![
            wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&self.maps.view),
            },
            wgpu::BindGroupEntry { binding: 3, resource: mesh.positions.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 4, resource: mesh.indices.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 5, resource: mesh.surfaces.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 6, resource: mesh.masks.as_entire_binding() },
        ];
        let [_, fragment] = stages;
        let samplers = [(2, &self.sampler), (9, &self.point)];
        let used = samplers.into_iter().filter(|(binding, _)| match fragment {
            "pixel_lookup_fragment" => true,
            "lights_fragment" => *binding == 9,
            _ => *binding == 2,
        });
        entries.extend(used.map(|(binding, sampler)| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::Sampler(sampler),
        }));
        entries.extend((fragment == "lights_fragment").then_some(lights));
        device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("camera"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }
}

/// A sampler that compares with less-equal, or for reversed maps with greater-equal, and clamps at the
/// edges.
pub fn comparison_sampler(
    device: &Device,
    sampling: Sampling,
    reversed: bool,
) -> Result<wgpu::Sampler, GpuError> {
    let filter = match sampling {
        Sampling::Nearest => wgpu::FilterMode::Nearest,
        Sampling::Linear => wgpu::FilterMode::Linear,
    };
    device.step("the comparison sampler", || {
        device.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("comparison"),
            mag_filter: filter,
            min_filter: filter,
            compare: Some(match reversed {
                false => wgpu::CompareFunction::LessEqual,
                true => wgpu::CompareFunction::GreaterEqual,
            }),
            ..Default::default()
        })
    })
}

/// The sampler that reads stored depths as they are: the nearest texel, or the four around a corner.
pub fn point_sampler(device: &Device) -> Result<wgpu::Sampler, GpuError> {
    device.step("the point sampler", || {
        device
            .device
            .create_sampler(&wgpu::SamplerDescriptor { label: Some("point"), ..Default::default() })
    })
}

/// Reads a colour texture back, band by band.
fn linear(device: &Device, texture: &wgpu::Texture) -> Result<Linear, GpuError> {
    use wgpu::BufferUsages as Usage;
    let (width, height) = (texture.width(), texture.height());
    let row = (width * PIXEL_BYTES).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let band = (device.chunk_bytes / u64::from(row)).clamp(1, u64::from(height)) as u32;
    let bytes = u64::from(row) * u64::from(band);
    let back = device.buffer("picture bytes", bytes, Usage::MAP_READ | Usage::COPY_DST)?;
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    for first in (0..height).step_by(band as usize) {
        let rows = band.min(height - first);
        let encoder = device.encode("reading the picture", |encoder| {
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo {
                    origin: wgpu::Origin3d { x: 0, y: first, z: 0 },
                    ..texture.as_image_copy()
                },
                wgpu::TexelCopyBufferInfo {
                    buffer: &back,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(row),
                        rows_per_image: None,
                    },
                },
                wgpu::Extent3d { width, height: rows, depth_or_array_layers: 1 },
            );
        })?;
        device.submit("reading the picture", encoder)?;
        let data = device.read(&back, u64::from(row) * u64::from(rows))?;
        for line in data.chunks(row as usize) {
            let line = &line[..(width * PIXEL_BYTES) as usize];
            pixels.extend(bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(line));
        }
    }
    Ok(Linear { width, height, pixels })
}
