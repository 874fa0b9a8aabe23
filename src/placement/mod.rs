//! A light and a camera for scenes that bring none: inside a room, or around what stands alone.

mod camera;
mod space;

use glam::{DVec3, Vec3};

use crate::scene::{Bounds, Light, Scene};
use space::Space;

/// The side that objects are shown from, as most files have their front on +z: three quarters from
/// the front, somewhat from above.
const SHOWN_FROM: DVec3 = DVec3::new(-0.6, 0.45, 1.0);

/// Where the light of an object stands, seen from its middle: on the same side, so that most of
/// what is seen is lit, but higher and farther round, so that shapes and shadows show.
const LIT_FROM: DVec3 = DVec3::new(-1.2, 1.3, 0.6);

/// Distance of an object's light from its middle, in radii of the sphere around it.
const LIGHT_RADII: f64 = 2.0;

impl Scene {
    /// The scene's first light; without one, a white omnidirectional light of our choice.
    ///
    /// In a room, which is a place that sees the front of surfaces in most directions, it hangs in
    /// the open, halfway between what is below and what is above it. Otherwise it stands outside
    /// the bounds, above, in front and on the left. Its coordinates are short decimals. It casts a
    /// few thousand rays: a tenth of a second for 100,000 triangles.
    pub fn default_light(&self) -> Light {
        self.lights.first().copied().unwrap_or_else(|| Light {
            position: self.light_position(),
            axis: None,
            color: Vec3::ONE,
            cone: None,
            range: None,
        })
    }

    fn light_position(&self) -> Vec3 {
        let bounds = self.bounds();
        let (center, radius) = (bounds.center().as_dvec3(), self.radius());
        let position = Space::new(self)
            .place_for_light()
            .unwrap_or_else(|| center + LIT_FROM.normalize() * (LIGHT_RADII * radius));
        short(position, radius)
    }

    /// Radius of the sphere around the bounds; 1 for a single point.
    fn radius(&self) -> f64 {
        let Bounds { min, max } = self.bounds();
        let radius = 0.5 * (max.as_dvec3() - min.as_dvec3()).length();
        if radius > 0.0 { radius } else { 1.0 }
    }
}

/// A point a hundredth of a scene's radius away at most, whose coordinates are short decimals.
fn short(point: DVec3, radius: f64) -> Vec3 {
    // no step for a radius that is not finite
    let step = 10.0_f64.powf((0.01 * radius).log10().floor());
    let rounded = (point / step).round() * step;
    let usable = rounded.is_finite() && step > 0.0;
    (if usable { rounded } else { point }).as_vec3()
}
