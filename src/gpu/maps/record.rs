//! Recording the passes that make the maps.

use std::ops::Range;

use super::{Set, ShadowMaps, layers_of};
use crate::gpu::lists::{CURVED, DRAW_BYTES, FLAT, MASKED, STEEP, STRADDLING};
use crate::gpu::mesh::MeshBuffers;
use crate::gpu::multiview::view_mask;
use crate::gpu::passes::{MapPass, PASS_BYTES, depth_attachment};
use crate::gpu::timer::{Ends, Stamps, render_writes};
use crate::render::Method;
use crate::scalar::light::DPSM_ATLAS;

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

impl ShadowMaps {
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
        let (mut target, mut at) = (0, 0);
        for (number, light) in self.lights.iter().enumerate() {
            let maps = light.hemispheres as usize;
            let views = self.views[number];
            let targets = (layers_of(light) / views) as usize;
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
                for pass_number in 0..targets {
                    let ends = Ends {
                        first: first && sorter.is_none() && pass_number == 0,
                        last: last && pass_number + 1 == targets,
                    };
                    let view = &self.targets[target + pass_number];
                    let mut pass = begin(encoder, (view, views), chunk == 0, stamps, ends);
                    let is_atlas = light.placement == DPSM_ATLAS;
                    let drawn = if is_atlas { 0..maps } else { pass_number..pass_number + 1 };
                    for map in drawn {
                        if is_atlas {
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
            target += targets;
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
        let pipelines = &self.pipelines[&self.views[number]];
        // each view of multiview draws what any of them sees
        let seen_from =
            (self.method != Method::Cube && self.views[number] == 1).then_some(hemisphere);
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
                    pass.set_pipeline(&pipelines[0]);
                    pass.draw_indexed_indirect(draws, (FLAT + map) * DRAW_BYTES);
                    pass.set_pipeline(&pipelines[1]);
                    pass.draw_indirect(draws, STRADDLING * DRAW_BYTES);
                }
                if parts.steep {
                    pass.set_pipeline(&pipelines[2]);
                    pass.draw_indirect(draws, (STEEP + map) * DRAW_BYTES);
                }
                if parts.curved {
                    pass.set_pipeline(&pipelines[3]);
                    pass.draw_indirect(draws, (CURVED + map) * DRAW_BYTES);
                    if first_masked < mesh.triangles {
                        pass.set_pipeline(&pipelines[4]);
                        pass.draw_indirect(draws, (MASKED + map) * DRAW_BYTES);
                    }
                }
            }
            Method::Cube if self.sorter.is_some() => {
                pass.set_pipeline(&pipelines[0]);
                pass.set_vertex_buffer(0, mesh.positions.slice(..));
                pass.set_index_buffer(set.lists.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed_indirect(draws, u64::from(hemisphere) * DRAW_BYTES);
                draw_ranges(pass, &pipelines[1], mesh, [masked(chunk)]);
            }
            Method::Tessellated => {
                let seen = mesh.meshes.iter().zip(&self.levels[number]);
                for (extent, &level) in seen.filter(|(m, _)| m.is_seen(&light, seen_from)) {
                    let is_masked = extent.triangles.start >= first_masked;
                    pass.set_pipeline(&pipelines[usize::from(is_masked)]);
                    let each = 3 * level * level;
                    let Range { start, end } = extent.triangles;
                    pass.draw(start * each..end * each, level..level + 1);
                }
            }
            _ => {
                let seen = mesh.seen(&light, seen_from);
                draw_ranges(pass, &pipelines[0], mesh, seen.iter().cloned().map(opaque));
                draw_ranges(pass, &pipelines[1], mesh, seen.iter().cloned().map(masked));
            }
        }
    }
}

fn draw_ranges(
    pass: &mut wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    mesh: &MeshBuffers,
    ranges: impl IntoIterator<Item = Range<u32>>,
) {
    for range in ranges.into_iter().filter(|range| !range.is_empty()) {
        pass.set_pipeline(pipeline);
        mesh.draw_range(pass, range, 0);
    }
}

/// Begins the pass into a layer, or into one a view; cleared unless an earlier chunk drew there.
fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    (target, views): (&wgpu::TextureView, u32),
    clear: bool,
    stamps: Stamps<'_>,
    ends: Ends,
) -> wgpu::RenderPass<'e> {
    let mut attachment = depth_attachment(target, 1.0);
    if !clear {
        let (load, store) = (wgpu::LoadOp::Load, wgpu::StoreOp::Store);
        attachment.depth_ops = Some(wgpu::Operations { load, store });
    }
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("map"),
        depth_stencil_attachment: Some(attachment),
        timestamp_writes: render_writes(stamps, ends),
        multiview_mask: view_mask(views),
        ..Default::default()
    })
}
