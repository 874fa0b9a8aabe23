//! Recording the passes that make the maps.

use std::ops::Range;

use super::sets::Set;
use super::{Chunk, ShadowMaps, layers_of};
use crate::gpu::lists::{DRAW_BYTES, FLAT, MASKED, MASKED_PARTS, PARTS, PLANE, WHOLE, Work};
use crate::gpu::mesh::MeshBuffers;
use crate::gpu::multiview::view_mask;
use crate::gpu::passes::{MapPass, PASS_BYTES, depth_attachment};
use crate::gpu::timer::{Ends, Stamps, render_writes};
use crate::render::{Method, common};
use crate::scalar::light::{DPSM_ATLAS, DPSM_REVERSED};

/// What to record of the maps' making. Drawing without sorting needs lists that were kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// Making the lists, for methods that have them.
    pub sort: bool,
    /// The passes; the members below choose among the refined lists.
    pub draw: bool,
    /// What is drawn as depth alone.
    pub flat: bool,
    /// What is drawn with its plane's distance at each fragment.
    pub planes: bool,
}

impl Parts {
    /// Everything.
    pub const ALL: Self = Self { sort: true, draw: true, flat: true, planes: true };
}

impl ShadowMaps {
    /// Records the passes that make all maps, and the making of their lists.
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
        let jobs = self.lights.len() * self.batches.len();
        let (mut target, mut at, mut begun) = (0, 0, 0);
        for (number, light) in self.lights.iter().enumerate() {
            let maps = light.hemispheres as usize;
            let views = self.views[number];
            let targets = (layers_of(light) / views) as usize;
            for (batch_number, batch) in self.batches.iter().enumerate() {
                let job = number * self.batches.len() + batch_number;
                let (mut first, last) = (job == 0, job + 1 == jobs);
                let set = &self.sets[self.places[job]];
                let listed = batch.clone().find(|&chunk| self.chunks[chunk].by.is_some());
                let sorter = listed.and_then(|chunk| {
                    let by = self.chunks[chunk].by?;
                    Some((chunk, self.sorters.get(&by)?))
                });
                if let (Some((chunk, sorter)), Some(group), true) =
                    (sorter, &set.sorting, parts.sort)
                {
                    let uniforms = at + chunk * maps;
                    let ends = Ends { first, last: last && !parts.draw };
                    let Chunk { triangles, vertices, .. } = &self.chunks[chunk];
                    let work = Work {
                        offset: (uniforms * PASS_BYTES) as u32,
                        triangles: triangles.len() as u32,
                        vertices: vertices.len() as u32,
                        levels: self.uniforms[uniforms].levels,
                    };
                    sorter.record(encoder, group, work, &set.lists, stamps, ends);
                    first = false;
                }
                if !parts.draw {
                    continue;
                }
                for pass_number in 0..targets {
                    let ends = Ends {
                        first: first && pass_number == 0,
                        last: last && pass_number + 1 == targets,
                    };
                    begun += 1;
                    let view = &self.targets[target + pass_number];
                    let empty = if light.reversed == DPSM_REVERSED { 0.0 } else { 1.0 };
                    let clear = (batch_number == 0).then_some(empty);
                    let mut pass = begin(encoder, (view, views), clear, stamps, ends);
                    let is_atlas = light.placement == DPSM_ATLAS;
                    // with multiview one pass draws the lists of all maps
                    let drawn = match is_atlas || views > 1 {
                        true => 0..maps,
                        false => pass_number..pass_number + 1,
                    };
                    for map in drawn {
                        if is_atlas {
                            let size = light.size;
                            pass.set_viewport(map as f32 * size, 0.0, size, size, 0.0, 1.0);
                            let side = size as u32;
                            pass.set_scissor_rect(map as u32 * side, 0, side, side);
                        }
                        let seen = |&chunk: &usize| {
                            let own = self.chunks[chunk].method;
                            views == 1
                                || map == 0
                                || [Method::Exact, Method::Refined].contains(&own)
                        };
                        for chunk in batch.clone().filter(seen) {
                            let place = (at + chunk * maps + map, number);
                            self.draw(&mut pass, mesh, &self.chunks[chunk], place, set, parts);
                        }
                    }
                }
            }
            at += maps * self.chunks.len();
            target += targets;
        }
        debug_assert!(!parts.draw || begun == self.passes(), "{begun} passes");
    }

    /// Draws one map's chunk.
    fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        mesh: &MeshBuffers,
        chunk: &Chunk,
        (at, number): (usize, usize),
        set: &Set,
        parts: Parts,
    ) {
        let MapPass { light, hemisphere, first_masked, .. } = self.uniforms[at];
        let Chunk { triangles, method, by, .. } = chunk;
        let views = self.views[number];
        let pipelines = &self.pipelines[&(views, *method)];
        // each view of multiview draws what any of them sees
        let seen_from = (*method != Method::Cube && views == 1).then_some(hemisphere);
        pass.set_bind_group(0, &set.drawing, &[(at * PASS_BYTES) as u32]);
        let opaque = triangles.start..triangles.end.min(first_masked);
        let masked = triangles.start.max(first_masked)..triangles.end;
        let draws = &set.lists.draws;
        match method {
            Method::Refined => {
                let map = u64::from(hemisphere);
                if parts.flat {
                    pass.set_pipeline(&pipelines[0]);
                    pass.set_vertex_buffer(0, set.lists.vertices.slice(..));
                    pass.set_index_buffer(set.lists.indices.slice(..), wgpu::IndexFormat::Uint32);
                    pass.draw_indexed_indirect(draws, (FLAT + map) * DRAW_BYTES);
                }
                if parts.planes {
                    pass.set_vertex_buffer(0, set.lists.records.slice(..));
                    pass.set_pipeline(&pipelines[1]);
                    pass.draw_indirect(draws, (PLANE + map) * DRAW_BYTES);
                    if !masked.is_empty() {
                        pass.set_pipeline(&pipelines[2]);
                        pass.draw_indirect(draws, (MASKED + map) * DRAW_BYTES);
                    }
                }
                // nothing, unless the lists had no room
                pass.set_pipeline(&pipelines[3]);
                pass.draw_indirect(draws, WHOLE * DRAW_BYTES);
            }
            Method::Exact => {
                let map = u64::from(hemisphere);
                pass.set_pipeline(&pipelines[0]);
                pass.draw_indirect(draws, (PARTS + map) * DRAW_BYTES);
                if !masked.is_empty() {
                    pass.set_pipeline(&pipelines[1]);
                    pass.draw_indirect(draws, (MASKED_PARTS + map) * DRAW_BYTES);
                }
            }
            Method::Cube if by.is_some() => {
                pass.set_pipeline(&pipelines[0]);
                pass.set_vertex_buffer(0, mesh.positions.slice(..));
                pass.set_index_buffer(set.lists.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed_indirect(draws, u64::from(hemisphere) * DRAW_BYTES);
                draw_ranges(pass, &pipelines[1], mesh, [masked]);
            }
            Method::Tessellated => {
                let seen = self.levels[number].iter();
                for (extent, level) in seen.filter(|(mesh, _)| mesh.is_seen(&light, seen_from)) {
                    let Range { start, end } = common(&extent.triangles, triangles);
                    if start < end {
                        pass.set_pipeline(&pipelines[usize::from(start >= first_masked)]);
                        let each = 3 * level * level;
                        pass.draw(start * each..end * each, *level..level + 1);
                    }
                }
            }
            _ => {
                let seen = mesh.seen(&light, seen_from);
                for (pipeline, part) in pipelines.iter().zip([opaque, masked]) {
                    draw_ranges(pass, pipeline, mesh, seen.iter().map(|mesh| common(mesh, &part)));
                }
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

/// Begins the pass into a layer, or into one a view; cleared to a depth unless an earlier chunk drew
/// there.
fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    (target, views): (&wgpu::TextureView, u32),
    clear: Option<f32>,
    stamps: Stamps<'_>,
    ends: Ends,
) -> wgpu::RenderPass<'e> {
    let mut attachment = depth_attachment(target, clear.unwrap_or_default());
    if clear.is_none() {
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
