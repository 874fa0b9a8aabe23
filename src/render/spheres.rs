//! The clipping spheres, where nothing else is asked for.

use glam::DVec3;

use super::{FrameError, LARGEST, Method, SMALLEST, Settings, Vertex};

/// Far's distance beyond the farthest vertex, so that rounding never clips it.
const FAR_SLACK: f32 = 1.001;

/// Far in metres where there is nothing: any will do.
const EMPTY_FAR: f32 = 1.0;

/// Near's largest share of far. Radial depth is linear and a float stores small ones as exactly as large
/// ones, so that near may be the smallest that there is: nothing is cut off.
const NEAR_SHARE: f32 = 1e-3;

/// Near's share of the nearest caster's distance, so that rounding never clips it.
const NEAR_SLACK: f32 = 0.99;

/// Step of the floats below 1, where nearly all of a cube's perspective depths lie.
const FLOAT_STEP: f32 = 1.0 / (1 << 24) as f32;

impl Settings {
    /// Near and far as they are given, or as the scene asks, from its vertices and the distance of the
    /// nearest caster, which only a cube's maps need; `None` where there is none.
    pub(super) fn spheres(
        &self,
        vertices: &[Vertex],
        light: DVec3,
        nearest: Option<impl FnOnce() -> f64>,
    ) -> Result<[f32; 2], FrameError> {
        let distance = |vertex: &Vertex| vertex.position.as_dvec3().distance(light);
        let reach = vertices.iter().map(distance).fold(0.0, f64::max) as f32;
        let far = self.far.unwrap_or_else(|| match nearest.is_none() {
            // with nothing to reach, far is near's thousandfold all the same
            true => self.near.map_or(EMPTY_FAR, |near| near * 1e3),
            false => reach * FAR_SLACK,
        });
        let near = self.near.unwrap_or_else(|| match self.method {
            Method::Cube => {
                let nearest = nearest.map_or(f64::INFINITY, |nearest| nearest());
                self.near_of_cube(nearest as f32, far)
            }
            _ => SMALLEST.min(far * NEAR_SHARE),
        });
        match near >= SMALLEST && near < far && far <= LARGEST {
            true => Ok([near, far]),
            false => Err(FrameError::Spheres { near, far }),
        }
    }

    /// Perspective depth at far changes by far / near steps for each part of the distance, so near is no
    /// nearer than the casters ask, and never so near that a step at far is more than a texel's width.
    fn near_of_cube(&self, nearest: f32, far: f32) -> f32 {
        let step = self.format.quantum().max(FLOAT_STEP);
        let least = (far * step * self.map_size() as f32).min(far * NEAR_SHARE);
        (nearest * NEAR_SLACK).clamp(least, far * NEAR_SHARE)
    }
}

/// A cube's face cuts at a plane, whose corners lie this much farther out than its middle.
pub(super) fn corner(guard: f32) -> f32 {
    (1.0 + 2.0 * (1.0 + guard) * (1.0 + guard)).sqrt()
}
