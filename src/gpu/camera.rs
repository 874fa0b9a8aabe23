//! The camera pass, the hemisphere views, and the whole rendering of a frame.

use super::lookup::{camera_shader, camera_uniform, constants};
use super::maps::ShadowMaps;
use super::mesh::MeshBuffers;
use super::passes::{depth_attachment, depth_state, light_words};
use super::timer::{ALONE, render_writes};
use super::{Device, GpuError};
use crate::render::{Frame, Lookup, Picture, Projection, Rendering};
use crate::scalar::maps::{DepthMaps, Sampling};

/// Format of the pictures: the attachment encodes sRGB.
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Format of the camera's own depth buffer, reversed: 0 is infinitely far.
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Renders a frame: maps, lit image and, where the settings ask for them, a view of each
/// hemisphere or face.
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
    let pass = Pass { name: "camera", stages, reversed: true, image: frame.settings.image };
    let (lit, time) = camera.draw(device, &pass, &mesh, 0)?;
    timings.push(time);
    let mut views = Vec::new();
    if frame.settings.views {
        let image = [frame.settings.map_size(); 2];
        let stages = match projection {
            Projection::Cube => ["cube_view", "cube_view_fragment"],
            Projection::Paraboloid => ["view", "view_fragment"],
        };
        for (map, name) in (0..frame.light.hemispheres).zip(projection.names()) {
            let pass = Pass { name: &format!("{name} view"), stages, reversed: false, image };
            let (view, time) = camera.draw(device, &pass, &mesh, map)?;
            views.push(view);
            timings.push(time);
        }
    }
    let stored = match frame.settings.views {
        true => Some(maps.download(device, frame.settings.sampling)?),
        false => None,
    };
    Ok(Rendering { lit, maps: stored, views, timings })
}

/// Makes a frame's maps alone and reads them back.
pub fn make_maps(device: &Device, frame: &Frame) -> Result<DepthMaps, GpuError> {
    let mesh = MeshBuffers::new(device, frame)?;
    let maps = ShadowMaps::new(device, frame, &mesh)?;
    let encoder = device.encode("the maps", |encoder| maps.record(encoder, &mesh, None))?;
    device.submit("the maps", encoder)?;
    maps.download(device, frame.settings.sampling)
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

/// One colour pass.
struct Pass<'a> {
    name: &'a str,
    /// Entry points of the vertex and of the fragment stage.
    stages: [&'a str; 2],
    /// Depth buffer with 1 near and 0 far.
    reversed: bool,
    /// Width and height.
    image: [u32; 2],
}

/// What the camera passes bind.
struct Camera<'a> {
    module: wgpu::ShaderModule,
    uniform: wgpu::Buffer,
    constants: [(&'static str, f64); 2],
    sampler: wgpu::Sampler,
    lights: wgpu::Buffer,
    maps: &'a ShadowMaps,
}

impl<'a> Camera<'a> {
    fn new(device: &Device, frame: &Frame, maps: &'a ShadowMaps) -> Result<Self, GpuError> {
        let module = camera_shader(device)?;
        let uniform = camera_uniform(device, frame, &maps.lights[0])?;
        let constants = constants(frame);
        let sampler = comparison_sampler(device, frame.settings.sampling)?;
        let all: Vec<u32> = maps.lights.iter().flat_map(light_words).collect();
        let bytes = bytemuck::cast_slice(&all);
        let lights = device.upload("light bytes", bytes, wgpu::BufferUsages::STORAGE)?;
        Ok(Self { module, uniform, constants, sampler, lights, maps })
    }

    /// Draws all triangles with one pair of entry points and reads the picture back.
    fn draw(
        &self,
        device: &Device,
        &Pass { name, stages, reversed, image: [width, height] }: &Pass<'_>,
        mesh: &MeshBuffers,
        instance: u32,
    ) -> Result<(Picture, (String, std::time::Duration)), GpuError> {
        let (compare, clear) = match reversed {
            true => (wgpu::CompareFunction::Greater, 0.0),
            false => (wgpu::CompareFunction::Less, 1.0),
        };
        let pipeline = device.step(name, || self.pipeline(device, stages, compare))?;
        let target = |format, usage| {
            device.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(name),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let (color, depth, group) = device.step(name, || {
            let color = target(COLOR, wgpu::TextureUsages::COPY_SRC);
            let depth = target(DEPTH, wgpu::TextureUsages::empty());
            let many = stages.contains(&"lights_fragment");
            (color, depth, self.group(device, &pipeline, mesh, many))
        })?;
        let color_view = color.create_view(&Default::default());
        let depth_view = depth.create_view(&Default::default());
        let time = device.time_warm(name, |encoder, stamps| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(name),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &color_view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: Some(depth_attachment(&depth_view, clear)),
                timestamp_writes: render_writes(stamps, ALONE),
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3 * mesh.triangles, instance..instance + 1);
        })?;
        Ok((picture(device, &color)?, time))
    }

    fn pipeline(
        &self,
        device: &Device,
        [vertex, fragment]: [&str; 2],
        compare: wgpu::CompareFunction,
    ) -> wgpu::RenderPipeline {
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
            depth_stencil: Some(depth_state(DEPTH, compare)),
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
        mesh: &MeshBuffers,
        many: bool,
    ) -> wgpu::BindGroup {
        let lights = wgpu::BindGroupEntry { binding: 7, resource: self.lights.as_entire_binding() };
        let mut entries = vec![
            wgpu::BindGroupEntry { binding: 0, resource: self.uniform.as_entire_binding() },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&self.maps.view),
            },
            wgpu::BindGroupEntry {
                binding: 2,
                resource: wgpu::BindingResource::Sampler(&self.sampler),
            },
            wgpu::BindGroupEntry { binding: 3, resource: mesh.positions.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 4, resource: mesh.indices.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 5, resource: mesh.surfaces.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 6, resource: mesh.masks.as_entire_binding() },
        ];
        entries.extend(many.then_some(lights));
        device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("camera"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }
}

/// A sampler that compares with less-equal and clamps at the edges.
pub fn comparison_sampler(device: &Device, sampling: Sampling) -> Result<wgpu::Sampler, GpuError> {
    let filter = match sampling {
        Sampling::Nearest => wgpu::FilterMode::Nearest,
        Sampling::Linear => wgpu::FilterMode::Linear,
    };
    device.step("the comparison sampler", || {
        device.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("comparison"),
            mag_filter: filter,
            min_filter: filter,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        })
    })
}

/// Reads a colour texture back.
fn picture(device: &Device, texture: &wgpu::Texture) -> Result<Picture, GpuError> {
    use wgpu::BufferUsages as Usage;
    let (width, height) = (texture.width(), texture.height());
    let row = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let bytes = u64::from(row) * u64::from(height);
    let back = device.buffer("picture bytes", bytes, Usage::MAP_READ | Usage::COPY_DST)?;
    let encoder = device.encode("reading the picture", |encoder| {
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &back,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
    })?;
    device.submit("reading the picture", encoder)?;
    let data = device.read(&back, bytes)?;
    let line = |line: &[u8]| -> Vec<[u8; 4]> { line[..width as usize * 4].as_chunks().0.to_vec() };
    let pixels = data.chunks(row as usize).flat_map(line).collect();
    Ok(Picture { width, height, pixels })
}
