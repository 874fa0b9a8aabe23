//! The shader of the camera passes and what it is told; the shadow test alone at given points.

use super::camera::{comparison_sampler, point_sampler};
use super::maps::ShadowMaps;
use super::passes::{light_words, shader, uniform_buffer};
use super::timer::{ALONE, Stamps, render_writes};
use super::{Device, GpuError};
use crate::render::{AMBIENT, Bias, Filter, Frame, Projection, SPECULAR, Shine, View};
use crate::scalar::float::Vec3;
use crate::scalar::light::DpsmLight;

/// What each pixel of a test is stored as.
const SHARE: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// Bytes of a point: position and normal, each padded to a vec4.
const POINT_BYTES: u64 = 32;

/// The camera passes' shader.
pub fn camera_shader(device: &Device) -> Result<wgpu::ShaderModule, GpuError> {
    shader(
        device,
        "camera.wesl",
        concat!(
            include_str!("camera.wesl"),
            include_str!("shadow.wesl"),
            include_str!("position.wesl"),
            include_str!("mask.wesl")
        ),
    )
}

/// Its struct Camera, of one sample's view.
pub fn camera_uniform(
    device: &Device,
    frame: &Frame,
    view: &View,
    light: &DpsmLight<f32>,
) -> Result<wgpu::Buffer, GpuError> {
    let rows = [
        (view.eye, view.near),
        (view.right, view.scale[0]),
        (view.up, view.scale[1]),
        (view.forward, AMBIENT),
        (frame.color, SPECULAR),
    ];
    let row = |(v, last): (glam::Vec3, f32)| [v.x, v.y, v.z, last].map(f32::to_bits);
    let mut words: Vec<u32> = rows.into_iter().flat_map(row).collect();
    words.extend(light_words(light));
    let settings = &frame.settings;
    let tolerance = settings.too_near();
    let quantum = settings.quantum();
    let biases = [frame.bias, quantum, tolerance, settings.window()];
    words.extend(biases.map(f32::to_bits));
    words.extend(frame.filter_words());
    words.extend(view.shift.map(f32::to_bits));
    words.push(frame.settings.terminator.into());
    let Shine { cone: [inner, outer], range } = frame.shine;
    words.extend([inner, outer, range].map(f32::to_bits));
    // a struct is as large as its alignment asks
    words.resize(words.len().next_multiple_of(4), 0);
    uniform_buffer(device, &words)
}

/// Its constants: the kinds of filter and bias, as shadow.wesl numbers them.
pub fn constants(frame: &Frame) -> [(&'static str, f64); 2] {
    let filter = match frame.settings.filter {
        Filter::Single => 0,
        Filter::Naive(_) => 1,
        Filter::Disk(_) => 2,
        Filter::Mirror(_) => 3,
        Filter::Reproject(_) => 4,
        Filter::Soft { .. } => 5,
    };
    let bias = match frame.settings.bias_taken() {
        Bias::Constant(_) => 0,
        Bias::Footprint => 1,
        Bias::TexelCentre => 2,
        Bias::Plane => 3,
        Bias::Normal => 4,
    };
    [("filtering", filter.into()), ("bias_kind", bias.into())]
}

/// Compiles shadow tests of points, to time them or to read their results.
#[derive(Debug)]
pub struct PointTests {
    module: wgpu::ShaderModule,
}

/// The shadow test of a frame's filter and bias at each of some points, and nothing else; drawn, a
/// pixel a point, as renderers do.
#[derive(Debug)]
pub struct PointTest {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    target: wgpu::Texture,
    view: wgpu::TextureView,
    points: usize,
}

impl PointTests {
    /// Compiles what all tests share.
    pub fn new(device: &Device) -> Result<Self, GpuError> {
        Ok(Self { module: camera_shader(device)? })
    }

    /// The points' buffer: light-space position and normal of each, all of one light.
    pub fn upload(device: &Device, points: &[[Vec3<f32>; 2]]) -> Result<wgpu::Buffer, GpuError> {
        let words = |v: Vec3<f32>| [v.x, v.y, v.z, 0.0];
        let words: Vec<f32> = points.iter().flatten().copied().flat_map(words).collect();
        let bytes = bytemuck::cast_slice(&words);
        device.upload("point bytes", bytes, wgpu::BufferUsages::STORAGE)
    }

    /// The test of the first light of maps that the frame's method made.
    pub fn of(
        &self,
        device: &Device,
        frame: &Frame,
        maps: &ShadowMaps,
        points: &wgpu::Buffer,
    ) -> Result<PointTest, GpuError> {
        let uniform = camera_uniform(device, frame, &frame.view, &maps.lights[0])?;
        let sampler =
            comparison_sampler(device, frame.settings.sampling_taken(), frame.settings.reversed)?;
        let point = point_sampler(device)?;
        let fragment = match frame.settings.method.projection() {
            Projection::Paraboloid => "test_fragment",
            Projection::Cube => "cube_test_fragment",
        };
        let count = points.size() / POINT_BYTES;
        // rows of whole multiples of what a copy asks for
        let alignment = u64::from(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT) / 4;
        let width = count.isqrt().next_multiple_of(alignment).max(alignment);
        let [kind, bias] = constants(frame);
        let constants = [kind, bias, ("test_width", width as f64)];
        let (width, height) = (width as u32, count.div_ceil(width).max(1) as u32);
        device.step("the shadow test", || {
            let pipeline = self.pipeline(device, fragment, &constants);
            let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
            let mut entries = vec![
                (0, uniform.as_entire_binding()),
                (1, wgpu::BindingResource::TextureView(&maps.view)),
                (2, wgpu::BindingResource::Sampler(&sampler)),
                (8, points.as_entire_binding()),
            ];
            if fragment == "test_fragment" {
                entries.push((9, wgpu::BindingResource::Sampler(&point)));
            }
            let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(fragment),
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries.into_iter().map(entry).collect::<Vec<_>>(),
            });
            let target = device.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(fragment),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: SHARE,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            let view = target.create_view(&Default::default());
            PointTest { pipeline, group, target, view, points: count as usize }
        })
    }

    fn pipeline(
        &self,
        device: &Device,
        fragment: &str,
        constants: &[(&str, f64)],
    ) -> wgpu::RenderPipeline {
        let compilation_options =
            wgpu::PipelineCompilationOptions { constants, ..Default::default() };
        device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment),
            layout: None,
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some("test"),
                compilation_options: compilation_options.clone(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(fragment),
                compilation_options,
                targets: &[Some(SHARE.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

impl PointTest {
    /// Records the tests of all points.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, stamps: Stamps<'_>) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow test"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            timestamp_writes: render_writes(stamps, ALONE),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Runs the tests and gives each point's share of the light.
    pub fn run(&self, device: &Device) -> Result<Vec<f32>, GpuError> {
        let row = 4 * self.target.width();
        let bytes = u64::from(row) * u64::from(self.target.height());
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let back = device.buffer("shares read back", bytes, usage)?;
        let encoder = device.encode("the shadow test", |encoder| {
            self.record(encoder, None);
            encoder.copy_texture_to_buffer(
                self.target.as_image_copy(),
                wgpu::TexelCopyBufferInfo {
                    buffer: &back,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(row),
                        rows_per_image: None,
                    },
                },
                self.target.size(),
            );
        })?;
        device.submit("the shadow test", encoder)?;
        let mut shares: Vec<f32> = bytemuck::pod_collect_to_vec(&device.read(&back, bytes)?);
        shares.truncate(self.points);
        Ok(shares)
    }
}
