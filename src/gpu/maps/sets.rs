//! Sets of lists for the maps of some lights: how large they are, and what binds them.

use std::collections::BTreeMap;
use std::ops::Range;

use super::Chunk;
use crate::gpu::lists::{Bound, By, Lists, Room, Sorter, Work};
use crate::gpu::mesh::MeshBuffers;
use crate::gpu::passes::{MapPass, PASS_BYTES, bind};
use crate::gpu::timer::Ends;
use crate::gpu::{Device, GpuError};
use crate::render::{Frame, Settings, refinement_levels};
use crate::scalar::light::{DPSM_ATLAS, DpsmLight};
use crate::scalar::paraboloid::dpsm_texel_width;

/// Lists and what binds them.
#[derive(Debug)]
pub(super) struct Set {
    pub(super) lists: Lists,
    pub(super) sorting: Option<Bound>,
    pub(super) drawing: wgpu::BindGroup,
}

/// What sets there are.
pub(super) struct Planned {
    pub(super) kinds: Vec<Option<By>>,
    pub(super) rooms: Vec<Room>,
    /// Of each light and batch, the number of its set.
    pub(super) places: Vec<usize>,
    pub(super) overfull: bool,
}

/// Sets for each light and batch. Refinement's are as large as it needs, which a first one says.
pub(super) fn plan_sets(
    host: &Host<'_>,
    batches: &[Range<usize>],
    sorters: &BTreeMap<By, Sorter>,
) -> Result<Planned, GpuError> {
    let settings = &host.frame.settings;
    let mut planned =
        Planned { kinds: Vec::new(), rooms: Vec::new(), places: Vec::new(), overfull: false };
    for light in 0..host.lights.len() {
        for batch in batches {
            let listed = batch.clone().find(|&chunk| host.chunks[chunk].by.is_some());
            let by = listed.and_then(|chunk| host.chunks[chunk].by);
            let room = match (listed, by) {
                (Some(chunk), Some(By::Refinement)) => {
                    let (room, is_over) = host.refined_room(light, chunk, sorters)?;
                    planned.overfull |= is_over;
                    room
                }
                (Some(chunk), by) => {
                    Room::of(host.device, by, host.chunks[chunk].triangles.len() as u32, 0)
                }
                _ => Room::default(),
            };
            let shared = match settings.keep_lists && by.is_some() {
                true => None,
                false => planned.kinds.iter().position(|kind| *kind == by),
            };
            let place = shared.unwrap_or(planned.kinds.len());
            match shared {
                Some(place) => planned.rooms[place] = planned.rooms[place].max(room),
                None => {
                    planned.kinds.push(by);
                    planned.rooms.push(room);
                }
            }
            planned.places.push(place);
        }
    }
    Ok(planned)
}

/// What sets of lists are made from.
pub(super) struct Host<'a> {
    pub(super) device: &'a Device,
    pub(super) frame: &'a Frame,
    pub(super) mesh: &'a MeshBuffers,
    pub(super) lights: &'a [DpsmLight<f32>],
    pub(super) chunks: &'a [Chunk],
}

impl Host<'_> {
    /// The uniforms of each light, chunk and map, in this order.
    pub(super) fn uniforms(&self, room: impl Fn(usize, usize) -> Room) -> Vec<MapPass> {
        let mut uniforms = Vec::new();
        for (number, light) in self.lights.iter().enumerate() {
            for (chunk_number, chunk) in self.chunks.iter().enumerate() {
                let room = room(number, chunk_number);
                let pass = |hemisphere| self.uniform(light, chunk, hemisphere, room);
                uniforms.extend((0..light.hemispheres).map(pass));
            }
        }
        uniforms
    }

    fn uniform(
        &self,
        light: &DpsmLight<f32>,
        chunk: &Chunk,
        hemisphere: u32,
        room: Room,
    ) -> MapPass {
        let settings = &self.frame.settings;
        let [tau, depth_tolerance] = settings.tolerances_of(chunk.method);
        let beside = if light.placement == DPSM_ATLAS { hemisphere as f32 } else { 0.0 };
        MapPass {
            light: *light,
            hemisphere,
            first: chunk.triangles.start,
            triangles: chunk.triangles.len() as u32,
            first_masked: self.mesh.first_masked,
            first_vertex: chunk.vertices.start,
            vertices: chunk.vertices.len() as u32,
            capacity: room.triangles,
            extra: room.extra,
            vertex_room: room.vertices,
            queue_room: room.queue,
            levels: levels(chunk, settings),
            padding: 0,
            middle: [(beside + 0.5) * light.size, 0.5 * light.size],
            texel: dpsm_texel_width(light.size, light.guard),
            tau,
            depth_tolerance,
            scale: 1.0 / (light.far - light.near),
            rest: [0; 2],
        }
    }

    /// Binds lists.
    pub(super) fn set(
        &self,
        by: Option<By>,
        lists: Lists,
        uniforms: &wgpu::Buffer,
        layout: &wgpu::BindGroupLayout,
        sorters: &BTreeMap<By, Sorter>,
    ) -> Result<Set, GpuError> {
        let device = self.device;
        let mesh = self.mesh;
        let [positions, indices, records, surfaces, masks] =
            [&mesh.positions, &mesh.indices, &lists.records, &mesh.surfaces, &mesh.masks]
                .map(|buffer| buffer.as_entire_binding());
        let (sorting, drawing) = device.step("the map bindings", || {
            let resources = vec![one_pass(uniforms), positions, indices, records, surfaces, masks];
            let sorter = by.and_then(|by| sorters.get(&by));
            let group = |sorter: &Sorter| sorter.group(device, one_pass(uniforms), mesh, &lists);
            (sorter.map(group), bind(device, layout, resources))
        })?;
        Ok(Set { lists, sorting, drawing })
    }

    /// The room that refinement of a light's chunk needs, by doing it; and whether it is more than
    /// there can be.
    fn refined_room(
        &self,
        light: usize,
        chunk: usize,
        sorters: &BTreeMap<By, Sorter>,
    ) -> Result<(Room, bool), GpuError> {
        let (device, by) = (self.device, By::Refinement);
        let Chunk { triangles, vertices, .. } = &self.chunks[chunk];
        let [triangles, vertices] = [triangles, vertices].map(|range| range.len() as u32);
        let Some(sorter) = sorters.get(&by) else { return Ok((Room::default(), false)) };
        let mut room = Room::of(device, Some(by), triangles, vertices);
        let most = self.frame.settings.most_refined;
        if let Some(more) = most {
            room = room.at_most(triangles, vertices, more);
        }
        loop {
            let pass = self.uniform(&self.lights[light], &self.chunks[chunk], 0, room);
            let buffer = upload(device, &[pass])?;
            let lists = Lists::new(device, Some(by), room)?;
            let group = device.step("the map bindings", || {
                sorter.group(device, one_pass(&buffer), self.mesh, &lists)
            })?;
            let work = Work { offset: 0, vertices, triangles, levels: pass.levels };
            let encoder = device.encode("refinement", |encoder| {
                let ends = Ends { first: true, last: true };
                sorter.record(encoder, &group, work, &lists, None, ends);
            })?;
            device.submit("refinement", encoder)?;
            let (needed, is_over) = lists.needed(device, vertices)?;
            if !is_over {
                return Ok((needed, false));
            }
            match (most, room.doubled(device)) {
                (None, Some(larger)) => room = larger,
                _ => return Ok((room, true)),
            }
        }
    }
}

/// How often the edges of a chunk are split.
fn levels(chunk: &Chunk, settings: &Settings) -> u32 {
    match chunk.by {
        Some(By::Refinement) => refinement_levels(settings.size, settings.tau),
        _ => 0,
    }
}

/// Uniforms at the offsets that passes bind them by.
pub(super) fn upload(device: &Device, uniforms: &[MapPass]) -> Result<wgpu::Buffer, GpuError> {
    // with nothing to draw, as large as can be bound
    let mut bytes = vec![0u8; uniforms.len().max(1) * PASS_BYTES];
    for (pass, bytes) in uniforms.iter().zip(bytes.chunks_mut(PASS_BYTES)) {
        bytes[..size_of::<MapPass>()].copy_from_slice(bytemuck::bytes_of(pass));
    }
    device.upload("map uniform bytes", &bytes, wgpu::BufferUsages::UNIFORM)
}

/// One pass's uniforms, to be bound at their offset.
fn one_pass(uniforms: &wgpu::Buffer) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer: uniforms,
        offset: 0,
        size: wgpu::BufferSize::new(size_of::<MapPass>() as u64),
    })
}
