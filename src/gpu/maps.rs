//! Shadow maps of some lights, by any method.

mod record;

pub use record::Parts;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::Range;

use super::lists::{By, Lists, Sorter};
use super::mesh::MeshBuffers;
use super::multiview::{try_views, views};
use super::passes::{
    MapPass, PASS_BYTES, bind, depth_texture, layers_view, map_bindings, pipelines,
};
use super::texels::Texels;
use super::{Device, GpuError};
use crate::render::{Extent, Format, Frame, Method, Passes, Settings};
use crate::scalar::light::{DPSM_ATLAS, DPSM_LAYERS, DPSM_REVERSED, DpsmLight};
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
    /// Of each light, the tessellated meshes and their levels.
    levels: Vec<Vec<(Extent, u32)>>,
    /// Views of each light's passes, and what each pass draws into.
    views: Vec<u32>,
    targets: Vec<wgpu::TextureView>,
    chunks: Vec<Chunk>,
    /// Chunks that are drawn in the same passes.
    batches: Vec<Range<usize>>,
    uniforms: Vec<MapPass>,
    sorter: Option<Sorter>,
    /// One for each light and batch where they are kept, else one.
    sets: Vec<Set>,
    /// By the number of views in a pass, and by method.
    pipelines: BTreeMap<(u32, Method), Vec<wgpu::RenderPipeline>>,
}

/// Triangles that are drawn at once.
#[derive(Clone, Debug)]
struct Chunk {
    triangles: Range<u32>,
    method: Method,
    /// They are sorted into lists first.
    is_sorted: bool,
}

/// Lists and what binds them.
#[derive(Debug)]
struct Set {
    lists: Lists,
    sorting: Option<wgpu::BindGroup>,
    drawing: wgpu::BindGroup,
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

    /// Maps for several lights in one texture; all have the size of the frame's. `mesh` holds the
    /// triangles of a frame with the same castings.
    pub fn with_lights(
        device: &Device,
        frame: &Frame,
        mesh: &MeshBuffers,
        lights: &[DpsmLight<f32>],
    ) -> Result<Self, GpuError> {
        frame.settings.check_passes()?;
        let maps = Self::untried(device, frame, mesh, lights)?;
        if maps.views.iter().any(|&views| views > 1) {
            try_views(device)?;
        }
        Ok(maps)
    }

    /// As `with_lights`, trusting the settings and the driver.
    pub(super) fn untried(
        device: &Device,
        frame: &Frame,
        mesh: &MeshBuffers,
        lights: &[DpsmLight<f32>],
    ) -> Result<Self, GpuError> {
        let settings = &frame.settings;
        let views = views(device, lights, settings.passes)?;
        let (lights, side) = placed(lights, settings.passes);
        let layers = lights.iter().map(layers_of).sum();
        let size = settings.map_size();
        let texture =
            depth_texture(device, [size * side, size], layers, settings.format.texture())?;
        let drawn = frame.drawn();
        let by = drawn.iter().find_map(|(_, method)| sorted_by(*method, settings));
        let capacity = capacity(device, settings, &drawn);
        let chunks = chunks(settings, drawn, capacity);
        let batches = batches(&chunks);
        let room = [capacity, Lists::extra(device)];
        let uniforms = uniforms(frame, mesh, &lights, &chunks, room);
        let tessellated = frame.tessellated();
        let levels = |light| {
            let levels = frame.levels(&tessellated, light)?;
            Ok(tessellated.iter().cloned().zip(levels).collect())
        };
        let levels = lights.iter().map(levels).collect::<Result<_, GpuError>>()?;
        // with nothing to draw, as large as can be bound
        let mut bytes = vec![0u8; uniforms.len().max(1) * PASS_BYTES];
        for (pass, bytes) in uniforms.iter().zip(bytes.chunks_mut(PASS_BYTES)) {
            bytes[..size_of::<MapPass>()].copy_from_slice(bytemuck::bytes_of(pass));
        }
        let buffer = device.upload("map uniform bytes", &bytes, wgpu::BufferUsages::UNIFORM)?;
        let uniform = || {
            wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &buffer,
                offset: 0,
                size: wgpu::BufferSize::new(size_of::<MapPass>() as u64),
            })
        };
        let layout = map_bindings(device)?;
        let mut by_views = BTreeMap::new();
        for &views in &views {
            for &Chunk { method, .. } in &chunks {
                if let Entry::Vacant(vacant) = by_views.entry((views, method)) {
                    vacant.insert(pipelines(device, &layout, method, settings.stored(), views)?);
                }
            }
        }
        let sorter = by.map(|by| Sorter::new(device, by)).transpose()?;
        let kept =
            if settings.keep_lists && by.is_some() { lights.len() * batches.len() } else { 1 };
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
        let mut targets = Vec::new();
        for (light, &views) in lights.iter().zip(&views) {
            let own = light.first_layer..light.first_layer + layers_of(light);
            let target = |layer| layers_view(&texture, layer, views);
            targets.extend(own.step_by(views as usize).map(target));
        }
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(Self {
            texture,
            view,
            lights,
            levels,
            views,
            targets,
            chunks,
            batches,
            uniforms,
            sorter,
            sets,
            pipelines: by_views,
        })
    }

    /// Number of maps of the first light.
    pub fn hemispheres(&self) -> u32 {
        self.lights.first().map_or(0, |light| light.hemispheres)
    }

    /// Render passes that one recording begins: for each light one a map, or one in all where its
    /// maps share one; that many again for each list of triangles beyond the first, where there are
    /// more than fit at once or where some are drawn `Exact` and some `Hybrid`.
    pub fn passes(&self) -> usize {
        self.targets.len() * self.batches.len()
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
        let reversed = light.reversed == DPSM_REVERSED;
        Ok(DepthMaps { size: size as u32, layers: count, depths, sampling, reversed })
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
        Passes::Single | Passes::Multiview => 1,
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

/// What a method sorts its triangles by.
fn sorted_by(method: Method, settings: &Settings) -> Option<By> {
    match method {
        Method::Exact | Method::Hybrid => Some(By::Class),
        Method::Cube if settings.cull_faces => Some(By::Face),
        _ => None,
    }
}

/// Triangles that lists have room for.
fn capacity(device: &Device, settings: &Settings, drawn: &[(Range<u32>, Method)]) -> u32 {
    let sorted = drawn.iter().filter(|(_, method)| sorted_by(*method, settings).is_some());
    let longest = sorted.map(|(triangles, _)| triangles.len() as u32).max();
    Lists::chunk(device, longest.unwrap_or(0))
}

/// Ranges of triangles as they are drawn: those that are sorted in as many as lists need.
fn chunks(settings: &Settings, drawn: Vec<(Range<u32>, Method)>, capacity: u32) -> Vec<Chunk> {
    let mut chunks = Vec::new();
    for (Range { start, end }, method) in drawn {
        let is_sorted = sorted_by(method, settings).is_some();
        let step = if is_sorted { capacity } else { end - start };
        let chunk = |first: u32| {
            let triangles = first..first.saturating_add(step).min(end);
            Chunk { triangles, method, is_sorted }
        };
        chunks.extend((start..end).step_by(step as usize).map(chunk));
    }
    chunks
}

/// Chunks for one pass a map: consecutive ones, of which one may be sorted, as lists hold one. At
/// least one batch, as passes without draws clear the maps.
fn batches(chunks: &[Chunk]) -> Vec<Range<usize>> {
    let mut batches = Vec::new();
    let (mut start, mut has_lists) = (0, false);
    for (index, chunk) in chunks.iter().enumerate() {
        if chunk.is_sorted && has_lists {
            batches.push(start..index);
            start = index;
        }
        has_lists |= chunk.is_sorted;
    }
    batches.push(start..chunks.len());
    batches
}

/// The uniforms of each light, chunk and map, in this order.
fn uniforms(
    frame: &Frame,
    mesh: &MeshBuffers,
    lights: &[DpsmLight<f32>],
    chunks: &[Chunk],
    [capacity, extra]: [u32; 2],
) -> Vec<MapPass> {
    let pass = |light: DpsmLight<f32>, chunk: &Chunk, hemisphere: u32| {
        let [tau, depth_tolerance] = frame.settings.tolerances_of(chunk.method);
        let beside = if light.placement == DPSM_ATLAS { hemisphere as f32 } else { 0.0 };
        MapPass {
            light,
            hemisphere,
            first: chunk.triangles.start,
            triangles: chunk.triangles.len() as u32,
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
    let mut uniforms = Vec::new();
    for light in lights {
        for chunk in chunks {
            uniforms.extend((0..light.hemispheres).map(|h| pass(*light, chunk, h)));
        }
    }
    uniforms
}
