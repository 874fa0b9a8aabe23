//! How much lists hold.

use super::{By, GROUP, GROUPS, INDEX_BYTES, PART_BYTES, QUEUE_BYTES, RECORD_BYTES, VERTEX_BYTES};
use crate::gpu::{Device, storage_bytes};

/// Room for parts beyond one a triangle, in each map, where the adapter has it: with less, large
/// triangles are drawn by hulls around the whole map.
const EXTRA: u64 = 1 << 17;

/// Room for what refinement makes beyond the mesh's own, where nothing has counted it.
const REFINED: u64 = 1 << 18;

/// Most triangles that are listed at once: 2^21 / 64 workgroups are half of WebGPU's limit.
const LARGEST_CHUNK: u64 = 1 << 21;

/// What lists have room for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Room {
    /// Triangles; of refined ones those that are drawn as depth alone, in both maps.
    pub triangles: u32,
    /// In each map parts beyond one a triangle, or refined triangles drawn with their planes.
    pub extra: u32,
    /// Refined: vertices, those of the mesh included.
    pub vertices: u32,
    /// Refined: triangles that are split at once.
    pub queue: u32,
}

impl Room {
    /// For chunks of so many triangles and vertices.
    pub fn of(device: &Device, by: Option<By>, triangles: u32, vertices: u32) -> Self {
        match by {
            Some(By::Refinement) => {
                let more = Self::refined(device);
                let with = |count: u32| count.saturating_add(more);
                Self {
                    triangles: with(triangles.saturating_mul(2)),
                    extra: with(triangles / 2),
                    vertices: with(vertices),
                    queue: with(triangles / 2),
                }
            }
            Some(By::Part) => Self { triangles, extra: Self::extra(device), ..Self::default() },
            Some(By::Face) => Self { triangles, ..Self::default() },
            None => Self::default(),
        }
    }

    /// No more than so much beyond the triangles and vertices themselves.
    pub fn at_most(self, triangles: u32, vertices: u32, more: u32) -> Self {
        let with = |count: u32| count.saturating_add(more);
        Self {
            triangles: self.triangles.min(with(triangles.saturating_mul(2))),
            extra: self.extra.min(more),
            vertices: self.vertices.min(with(vertices)),
            queue: self.queue.min(more),
        }
    }

    /// The larger of each.
    pub fn max(self, other: Self) -> Self {
        Self {
            triangles: self.triangles.max(other.triangles),
            extra: self.extra.max(other.extra),
            vertices: self.vertices.max(other.vertices),
            queue: self.queue.max(other.queue),
        }
    }

    /// Twice as much of what refinement fills, where the adapter can bind more.
    pub fn doubled(self, device: &Device) -> Option<Self> {
        let limit = storage_bytes(&device.device.limits());
        let twice = |count: u32, bytes: u64| {
            (2 * u64::from(count)).min(limit / bytes).max(count.into()) as u32
        };
        let larger = Self {
            triangles: twice(self.triangles, INDEX_BYTES),
            extra: twice(self.extra, 2 * RECORD_BYTES),
            vertices: twice(self.vertices, VERTEX_BYTES),
            // dispatched at once
            queue: twice(self.queue, 2 * QUEUE_BYTES).min(GROUPS * GROUP),
        };
        (larger != self).then_some(larger)
    }

    /// Room for parts beyond one a triangle, in each map: at most half of what can be bound.
    fn extra(device: &Device) -> u32 {
        (storage_bytes(&device.device.limits()) / (4 * PART_BYTES)).min(EXTRA) as u32
    }

    /// Room beyond the mesh's own, at most an eighth of what can be bound.
    fn refined(device: &Device) -> u32 {
        (storage_bytes(&device.device.limits()) / (8 * RECORD_BYTES)).min(REFINED) as u32
    }

    /// Triangles in a chunk, by the adapter's limit on what a shader may bind.
    pub fn chunk(device: &Device, by: By, triangles: u32) -> u32 {
        let limit = storage_bytes(&device.device.limits());
        let fits = match by {
            By::Refinement => {
                (limit / RECORD_BYTES).saturating_sub((2 * Self::refined(device)).into())
            }
            By::Part | By::Face => {
                (limit / (2 * PART_BYTES)).saturating_sub(Self::extra(device).into())
            }
        };
        triangles.clamp(1, fits.clamp(1, LARGEST_CHUNK) as u32)
    }
}
