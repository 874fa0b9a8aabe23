//! Shadow maps of some lights, by any method.

mod record;
mod sets;

pub use record::Parts;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::Range;

use self::sets::{Host, Set, plan_sets, upload};
use super::lists::{By, Lists, Room, Sorter};
use super::mesh::MeshBuffers;
use super::multiview::{try_views, views};
use super::passes::{MapPass, depth_texture, layers_view, map_bindings, pipelines};
use super::texels::Texels;
use super::{Device, GpuError};
use crate::render::{Extent, Format, Frame, Method, Passes, Settings};
use crate::scalar::light::{DPSM_ATLAS, DPSM_LAYERS, DPSM_REVERSED, DpsmLight};
use crate::scalar::maps::{DepthMaps, Sampling};

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
    sorters: BTreeMap<By, Sorter>,
    /// One for each light and batch where they are kept, else one for each way of making lists.
    sets: Vec<Set>,
    /// Of each light and batch, the number of its set.
    places: Vec<usize>,
    /// Whether refinement needs more room than there is.
    overfull: bool,
    /// By the number of views in a pass, and by method.
    pipelines: BTreeMap<(u32, Method), Vec<wgpu::RenderPipeline>>,
}

/// Triangles that are drawn at once.
#[derive(Clone, Debug)]
struct Chunk {
    triangles: Range<u32>,
    method: Method,
    /// How lists are made of them first, if any are.
    by: Option<By>,
    /// The vertices that they use, where that matters.
    vertices: Range<u32>,
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
        let chunks = chunks(device, frame);
        let batches = batches(&chunks);
        let tessellated = frame.tessellated();
        let levels = |light| {
            let levels = frame.levels(&tessellated, light)?;
            Ok(tessellated.iter().cloned().zip(levels).collect())
        };
        let levels = lights.iter().map(levels).collect::<Result<_, GpuError>>()?;
        let layout = map_bindings(device)?;
        let mut by_views = BTreeMap::new();
        for &views in &views {
            for &Chunk { method, .. } in &chunks {
                if let Entry::Vacant(vacant) = by_views.entry((views, method)) {
                    vacant.insert(pipelines(device, &layout, method, settings.stored(), views)?);
                }
            }
        }
        let mut sorters = BTreeMap::new();
        for by in chunks.iter().filter_map(|chunk| chunk.by) {
            if let Entry::Vacant(vacant) = sorters.entry(by) {
                vacant.insert(Sorter::new(device, by)?);
            }
        }
        let host = Host { device, frame, mesh, lights: &lights, chunks: &chunks };
        let planned = plan_sets(&host, &batches, &sorters)?;
        let uniforms = host.uniforms(|light, chunk| {
            let batch = batches.iter().position(|batch| batch.contains(&chunk)).unwrap_or(0);
            planned.rooms[planned.places[light * batches.len() + batch]]
        });
        let buffer = upload(device, &uniforms)?;
        let set = |(&by, &room): (&Option<By>, &Room)| {
            host.set(by, Lists::new(device, by, room)?, &buffer, &layout, &sorters)
        };
        let sets = planned.kinds.iter().zip(&planned.rooms).map(set).collect::<Result<_, _>>()?;
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
            sorters,
            sets,
            places: planned.places,
            overfull: planned.overfull,
            pipelines: by_views,
        })
    }

    /// True where refinement needs more room than the settings or the adapter give it: the maps are
    /// right all the same, but drawn by the slowest way there is.
    pub fn is_overfull(&self) -> bool {
        self.overfull
    }

    /// Bytes of all lists.
    pub fn list_bytes(&self) -> u64 {
        self.sets.iter().map(|set| set.lists.bytes()).sum()
    }

    /// Number of maps of the first light.
    pub fn hemispheres(&self) -> u32 {
        self.lights.first().map_or(0, |light| light.hemispheres)
    }

    /// Render passes that one recording begins: for each light one a map, or one in all where its
    /// maps share one; that many again for each list of triangles beyond the first, where there are
    /// more than fit at once or where some are drawn `Exact` and some `Refined`.
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

/// How lists are made of a method's triangles.
fn listed_by(method: Method, settings: &Settings) -> Option<By> {
    match method {
        Method::Refined => Some(By::Refinement),
        Method::Exact => Some(By::Part),
        Method::Cube if settings.cull_faces => Some(By::Face),
        _ => None,
    }
}

/// Ranges of triangles as they are drawn: those of lists in as many as lists need.
fn chunks(device: &Device, frame: &Frame) -> Vec<Chunk> {
    let mut chunks = Vec::new();
    for (Range { start, end }, method) in frame.drawn() {
        let by = listed_by(method, &frame.settings);
        let step = by.map_or(end - start, |by| Room::chunk(device, by, end - start));
        let chunk = |first: u32| {
            let triangles = first..first.saturating_add(step).min(end);
            let vertices = match by {
                Some(By::Refinement) => used(frame, &triangles),
                _ => 0..0,
            };
            Chunk { triangles, method, by, vertices }
        };
        chunks.extend((start..end).step_by(step as usize).map(chunk));
    }
    chunks
}

/// The vertices that triangles use: from the first to the last, at least one.
fn used(frame: &Frame, triangles: &Range<u32>) -> Range<u32> {
    let corners = frame.triangles[triangles.start as usize..triangles.end as usize].as_flattened();
    let last = (frame.vertices.len() as u32).saturating_sub(1);
    let first = corners.iter().min().map_or(0, |&first| first.min(last));
    first..corners.iter().max().map_or(0, |&high| high.min(last)) + 1
}

/// Chunks for one pass a map: consecutive ones, of which one may have lists, as a set holds one. At
/// least one batch, as passes without draws clear the maps.
fn batches(chunks: &[Chunk]) -> Vec<Range<usize>> {
    let mut batches = Vec::new();
    let (mut start, mut has_lists) = (0, false);
    for (index, chunk) in chunks.iter().enumerate() {
        if chunk.by.is_some() && has_lists {
            batches.push(start..index);
            start = index;
        }
        has_lists |= chunk.by.is_some();
    }
    batches.push(start..chunks.len());
    batches
}
