//! The texels that a point's lookup reads, and rays that fill them.

use glam::DVec3;

use super::{Bench, Point};
use crate::scalar::float::Vec2;
use crate::scalar::maps::Sampling;
use crate::scalar::paraboloid::dpsm_texture_to_disk;

/// The fewest rays along a side of a footprint, its corners included.
pub(super) const FEWEST_RAYS: usize = 5;

/// The most of them, for wide kernels.
const MOST_RAYS: usize = 17;

/// The texels that a point's lookup reads.
pub(super) struct Footprint {
    /// The map, and the texel that holds the point.
    pub(super) map: u32,
    texel: [f64; 2],
    /// Texels read on each side of it.
    reach: f64,
}

impl Footprint {
    /// `None` where the light has no map.
    pub(super) fn of(bench: &Bench<'_>, point: &Point) -> Option<Self> {
        let p = bench.to_light(point.world).narrow();
        let at = bench.projection.lookup(p, bench.frame.light);
        let texel = |c: f32| (f64::from(c) * f64::from(bench.maps.size)).floor();
        let own = match bench.maps.sampling {
            Sampling::Nearest => 0.0,
            Sampling::Linear => 1.0,
        };
        at.mapped.then(|| Self {
            map: at.hemisphere,
            texel: [at.coordinates.x, at.coordinates.y].map(texel),
            reach: own + bench.kernel_texels(point).ceil(),
        })
    }

    /// Texels along its side.
    pub(super) fn width(&self) -> f64 {
        1.0 + 2.0 * self.reach
    }

    /// Rays along its side, corners included: two a texel, within limits.
    pub(super) fn rays(&self) -> usize {
        ((2.0 * self.width() + 1.0) as usize).clamp(FEWEST_RAYS, MOST_RAYS)
    }

    /// The place of one of `rays` x `rays` that fill it, row by row, corners included.
    pub(super) fn place(&self, bench: &Bench<'_>, index: usize, rays: usize) -> Vec2<f64> {
        let offset = |k: usize| k as f64 / (rays - 1) as f64 * self.width() - self.reach;
        let [x, y] = self.texel;
        texel_place(bench, [x + offset(index % rays), y + offset(index / rays)])
    }

    /// The same as a world direction.
    pub(super) fn direction(&self, bench: &Bench<'_>, index: usize, rays: usize) -> DVec3 {
        bench.direction(self.place(bench, index, rays), self.map)
    }
}

/// The place of coordinates counted in texels.
pub(super) fn texel_place(bench: &Bench<'_>, [x, y]: [f64; 2]) -> Vec2<f64> {
    dpsm_texture_to_disk(Vec2::new(x, y) / bench.light.size, bench.light.guard)
}
