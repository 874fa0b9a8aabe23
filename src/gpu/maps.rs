//! The map passes: shadow maps of some lights, by any method.

use std::ops::Range;

use super::lists::{By, CURVED, DRAW_BYTES, FLAT, Lists, MASKED, STEEP, STRADDLING, Sorter};
use super::mesh::MeshBuffers;
use super::passes::{
    MapPass, PASS_BYTES, bind, depth_attachment, depth_texture, layer_view, pipelines,
};
use super::texels::Texels;
use super::timer::{Ends, Stamps, render_writes};
use super::{Device, GpuError};
use crate::render::{Format, Frame, Method, Passes};
use crate::scalar::light::{DPSM_ATLAS, DPSM_LAYERS, DpsmLight};
use crate::scalar::maps::{DepthMaps, Sampling};
use crate::scalar::paraboloid::dpsm_texel_width;

/// Shadow maps of some lights and the pipelines that draw them.
#[derive(Debug)]
pub struct ShadowMaps {
    /// The array texture: a layer a map, or a layer a light with its maps side by side.
    pub texture: wgpu::Texture,
    /// All layers, for sampling.
    pub view: wgpu::TextureView,
    /// The lights, with the place of their maps filled in.
    pub lights: Vec<DpsmLight<f32>>,
    method: Method,
    levels: Vec<Vec<u32>>,
    layers: Vec<wgpu::TextureView>,
    chunks: Vec<Range<u32>>,
    passes: Vec<MapPass>,
    sorter: Option<Sorter>,
    /// One for each light and chunk where they are kept, else one.
    sets: Vec<Set>,
    pipelines: Vec<wgpu::RenderPipeline>,
}

/// Lists and what binds them.
#[derive(Debug)]
struct Set {
    lists: Lists,
    sorting: Option<wgpu::BindGroup>,
    drawing: wgpu::BindGroup,
}

/// What to record of the maps' making. Drawing without sorting needs lists that were kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// Sorting of triangles into lists, for methods that do.
    pub sort: bool,
    /// The passes; the members below choose among the sorted lists.
    pub draw: bool,
    /// Flat triangles of one hemisphere, and those that straddle the seam.
    pub flat: bool,
    /// Flat triangles whose distance is computed at each fragment.
    pub steep: bool,
    /// Exact triangles and parts.
    pub curved: bool,
}

impl Parts {
    /// Everything.
    pub const ALL: Self = Self { sort: true, draw: true, flat: true, steep: true, curved: true };
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
    pub fn new(device: &Device, frame: &Frame, mesh: &MeshBuffers) -> Result<Self, GpuError> {
        Self::with_lights(device, frame, mesh, &[frame.light])
    }

    /// Maps for several lights in one texture; all have the size of the frame's.
    pub fn with_lights(
        device: &Device,
        frame: &Frame,
        mesh: &MeshBuffers,
        lights: &[DpsmLight<f32>],
    ) -> Result<Self, GpuError> {
        let settings = &frame.settings;
        let method = settings.method;
        let (lights, side) = placed(lights, settings.passes);
        let layers = lights.iter().map(layers_of).sum();
        let size = settings.map_size();
        let texture =
            depth_texture(device, [size * side, size], layers, settings.format.texture())?;
        let by = match method {
            Method::Exact | Method::Hybrid => Some(By::Class),
            Method::Cube if settings.cull_faces => Some(By::Face),
            _ => None,
        };
        let capacity = match by {
            Some(_) => Lists::chunk(device, mesh.triangles),
            None => mesh.triangles.max(1),
        };
        let chunk = |i: u32| i * capacity..((i + 1) * capacity).min(mesh.triangles);
        let chunks: Vec<_> = (0..mesh.triangles.div_ceil(capacity).max(1)).map(chunk).collect();
        let room = [capacity, Lists::extra(device)];
        let passes = passes(frame, mesh, &lights, &chunks, room);
        let levels = match method {
            Method::Tessellated => lights
                .iter()
                .map(|light| frame.levels(&mesh.meshes, light))
                .collect::<Result<_, _>>()?,
            _ => Vec::new(),
        };
        let mut bytes = vec![0u8; passes.len() * PASS_BYTES];
        for (pass, bytes) in passes.iter().zip(bytes.chunks_mut(PASS_BYTES)) {
            bytes[..size_of::<MapPass>()].copy_from_slice(bytemuck::bytes_of(pass));
        }
        let uniforms = device.upload("map uniform bytes", &bytes, wgpu::BufferUsages::UNIFORM)?;
        let uniform = || {
            wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &uniforms,
                offset: 0,
                size: wgpu::BufferSize::new(size_of::<MapPass>() as u64),
            })
        };
        let (pipelines, layout) = pipelines(device, method, settings.format)?;
        let sorter = by.map(|by| Sorter::new(device, by)).transpose()?;
        let kept =
            if settings.keep_lists && by.is_some() { lights.len() * chunks.len() } else { 1 };
        let set = |_| {
            let lists = Lists::new(device, by, capacity)?;
            let [positions, indices, entries, records, surfaces, masks, planes] = [
                &mesh.positions,
                &mesh.indices,
                &lists.entries,
                &lists.records,
                &mesh.surfaces,
                &mesh.masks,
                &lists.planes,
            ]
            .map(|buffer| buffer.as_entire_binding());
            let (sorting, drawing) = device.step("the map bindings", || {
                let resources =
                    vec![uniform(), positions, indices, entries, records, surfaces, masks, planes];
                let group = |sorter: &Sorter| sorter.group(device, uniform(), mesh, &lists);
                (sorter.as_ref().map(group), bind(device, &layout, resources))
            })?;
            Ok(Set { lists, sorting, drawing })
        };
        let sets = (0..kept).map(set).collect::<Result<_, GpuError>>()?;
        let layers = (0..layers).map(|layer| layer_view(&texture, layer)).collect();
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(Self {
            texture,
            view,
            lights,
            method,
            levels,
            layers,
            chunks,
            passes,
            sorter,
            sets,
            pipelines,
        })
    }

    /// Number of maps of the first light.
    pub fn hemispheres(&self) -> u32 {
        self.lights.first().map_or(0, |light| light.hemispheres)
    }

    /// Records the passes that make all maps, sorting included.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        mesh: &MeshBuffers,
        stamps: Stamps<'_>,
    ) {
        self.record_parts(encoder, mesh, stamps, Parts::ALL);
    }

    /// Records a part of it.
    pub fn record_parts(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        mesh: &MeshBuffers,
        stamps: Stamps<'_>,
        parts: Parts,
    ) {
        let sorter = self.sorter.as_ref().filter(|_| parts.sort);
        let jobs = self.lights.len() * self.chunks.len();
        let (mut layer, mut at) = (0, 0);
        for (number, light) in self.lights.iter().enumerate() {
            let maps = light.hemispheres as usize;
            for (chunk, triangles) in self.chunks.iter().enumerate() {
                let job = number * self.chunks.len() + chunk;
                let (first, last) = (job == 0, job + 1 == jobs);
                let set = &self.sets[job.min(self.sets.len() - 1)];
                if let (Some(sorter), Some(group)) = (sorter, &set.sorting) {
                    let offset = (at + chunk * maps) * PASS_BYTES;
                    let ends = Ends { first, last: last && !parts.draw };
                    let bound = (group, offset as u32);
                    let count = triangles.len() as u32;
                    sorter.record(encoder, bound, count, &set.lists, stamps, ends);
                }
                if !parts.draw {
                    continue;
                }
                let attachments = layers_of(light) as usize;
                for attachment in 0..attachments {
                    let ends = Ends {
                        first: first && sorter.is_none() && attachment == 0,
                        last: last && attachment + 1 == attachments,
                    };
                    let view = &self.layers[layer + attachment];
                    let mut pass = begin(encoder, view, chunk == 0, stamps, ends);
                    let drawn = match attachments == maps {
                        true => attachment..attachment + 1,
                        false => 0..maps,
                    };
                    for map in drawn {
                        if attachments != maps {
                            let size = light.size;
                            pass.set_viewport(map as f32 * size, 0.0, size, size, 0.0, 1.0);
                            let side = size as u32;
                            pass.set_scissor_rect(map as u32 * side, 0, side, side);
                        }
                        let place = at + chunk * maps + map;
                        self.draw(&mut pass, mesh, (place, number), set, parts);
                    }
                }
            }
            at += maps * self.chunks.len();
            layer += layers_of(light) as usize;
        }
    }

    /// Draws one map's chunk.
    fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        mesh: &MeshBuffers,
        (at, number): (usize, usize),
        set: &Set,
        parts: Parts,
    ) {
        let MapPass { light, hemisphere, first, triangles, first_masked, .. } = self.passes[at];
        pass.set_bind_group(0, &set.drawing, &[(at * PASS_BYTES) as u32]);
        let chunk = first..first + triangles;
        let within = |range: Range<u32>, low: u32, high: u32| {
            range.start.clamp(low, high)..range.end.clamp(low, high)
        };
        let opaque = |range: Range<u32>| within(range, 0, first_masked);
        let masked = |range: Range<u32>| within(range, first_masked, u32::MAX);
        let draws = &set.lists.draws;
        match self.method {
            Method::Exact | Method::Hybrid => {
                let map = u64::from(hemisphere);
                pass.set_vertex_buffer(0, mesh.positions.slice(..));
                pass.set_index_buffer(set.lists.indices.slice(..), wgpu::IndexFormat::Uint32);
                if parts.flat {
                    pass.set_pipeline(&self.pipelines[0]);
                    pass.draw_indexed_indirect(draws, (FLAT + map) * DRAW_BYTES);
                    pass.set_pipeline(&self.pipelines[1]);
                    pass.draw_indirect(draws, STRADDLING * DRAW_BYTES);
                }
                if parts.steep {
                    pass.set_pipeline(&self.pipelines[2]);
                    pass.draw_indirect(draws, (STEEP + map) * DRAW_BYTES);
                }
                if parts.curved {
                    pass.set_pipeline(&self.pipelines[3]);
                    pass.draw_indirect(draws, (CURVED + map) * DRAW_BYTES);
                    if first_masked < mesh.triangles {
                        pass.set_pipeline(&self.pipelines[4]);
                        pass.draw_indirect(draws, (MASKED + map) * DRAW_BYTES);
                    }
                }
            }
            Method::Cube if self.sorter.is_some() => {
                pass.set_pipeline(&self.pipelines[0]);
                pass.set_vertex_buffer(0, mesh.positions.slice(..));
                pass.set_index_buffer(set.lists.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed_indirect(draws, u64::from(hemisphere) * DRAW_BYTES);
                self.draw_ranges(pass, 1, mesh, [masked(chunk)]);
            }
            Method::Tessellated => {
                let seen = mesh.meshes.iter().zip(&self.levels[number]);
                for (extent, &level) in seen.filter(|(m, _)| m.is_seen(&light, Some(hemisphere))) {
                    let is_masked = extent.triangles.start >= first_masked;
                    pass.set_pipeline(&self.pipelines[usize::from(is_masked)]);
                    let each = 3 * level * level;
                    let Range { start, end } = extent.triangles;
                    pass.draw(start * each..end * each, level..level + 1);
                }
            }
            _ => {
                let hemisphere = (self.method != Method::Cube).then_some(hemisphere);
                let seen = mesh.seen(&light, hemisphere);
                self.draw_ranges(pass, 0, mesh, seen.iter().cloned().map(opaque));
                self.draw_ranges(pass, 1, mesh, seen.iter().cloned().map(masked));
            }
        }
    }

    fn draw_ranges(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pipeline: usize,
        mesh: &MeshBuffers,
        ranges: impl IntoIterator<Item = Range<u32>>,
    ) {
        for range in ranges.into_iter().filter(|range| !range.is_empty()) {
            pass.set_pipeline(&self.pipelines[pipeline]);
            mesh.draw_range(pass, range, 0);
        }
    }

    /// Reads the stored depths of the first light's maps back, a layer a map.
    pub fn download(&self, device: &Device, sampling: Sampling) -> Result<DepthMaps, GpuError> {
        let light = &self.lights[0];
        let maps = Texels::new(device)?.download(device, &self.view, &self.texture)?;
        let size = light.size as usize;
        let count = light.hemispheres;
        let wide = self.texture.width() as usize;
        // side by side: a row of each map in turn
        let row = |map: usize, y: usize| match wide == size {
            true => (map * size + y) * size,
            false => y * wide + map * size,
        };
        let mut depths = Vec::with_capacity(size * size * count as usize);
        for map in 0..count as usize {
            for y in 0..size {
                depths.extend_from_slice(&maps[row(map, y)..][..size]);
            }
        }
        Ok(DepthMaps { size: size as u32, layers: count, depths, sampling })
    }
}

/// Layers that a light's maps take.
fn layers_of(light: &DpsmLight<f32>) -> u32 {
    if light.placement == DPSM_ATLAS { 1 } else { light.hemispheres }
}

/// The lights with their places, and how many maps lie side by side.
fn placed(lights: &[DpsmLight<f32>], passes: Passes) -> (Vec<DpsmLight<f32>>, u32) {
    let side = match passes {
        Passes::Atlas => lights.iter().map(|light| light.hemispheres).max().unwrap_or(1),
        Passes::Single => 1,
    };
    let mut layer = 0;
    let place = |&light: &DpsmLight<f32>| {
        let mut light = DpsmLight { first_layer: layer, placement: DPSM_LAYERS, ..light };
        if passes == Passes::Atlas {
            light.placement = DPSM_ATLAS;
            light.rectangle.z = 1.0 / side as f32;
        }
        layer += layers_of(&light);
        light
    };
    (lights.iter().map(place).collect(), side)
}

/// The uniforms of each light, chunk and map, in this order.
fn passes(
    frame: &Frame,
    mesh: &MeshBuffers,
    lights: &[DpsmLight<f32>],
    chunks: &[Range<u32>],
    [capacity, extra]: [u32; 2],
) -> Vec<MapPass> {
    let [tau, depth_tolerance] = frame.settings.tolerances();
    let pass = |light: DpsmLight<f32>, chunk: &Range<u32>, hemisphere: u32| {
        let beside = if light.placement == DPSM_ATLAS { hemisphere as f32 } else { 0.0 };
        MapPass {
            light,
            hemisphere,
            first: chunk.start,
            triangles: chunk.len() as u32,
            first_masked: mesh.first_masked,
            capacity,
            extra,
            middle: [(beside + 0.5) * light.size, 0.5 * light.size],
            texel: dpsm_texel_width(light.size, light.guard),
            tau,
            depth_tolerance,
            padding: 0,
        }
    };
    let mut passes = Vec::new();
    for light in lights {
        for chunk in chunks {
            passes.extend((0..light.hemispheres).map(|h| pass(*light, chunk, h)));
        }
    }
    passes
}

/// Begins the pass into one layer; cleared unless an earlier chunk drew into it.
fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    clear: bool,
    stamps: Stamps<'_>,
    ends: Ends,
) -> wgpu::RenderPass<'e> {
    let mut attachment = depth_attachment(view, 1.0);
    if !clear {
        let (load, store) = (wgpu::LoadOp::Load, wgpu::StoreOp::Store);
        attachment.depth_ops = Some(wgpu::Operations { load, store });
    }
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("map"),
        depth_stencil_attachment: Some(attachment),
        timestamp_writes: render_writes(stamps, ends),
        ..Default::default()
    })
}
