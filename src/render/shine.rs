//! Which directions and distances a light reaches, before anything stands in its way.

use crate::scalar::float::{Float, Vec3};
use crate::scalar::shade::{dpsm_range, dpsm_spot};
use crate::scene::Light;

use super::Frame;

/// What a light reaches: all, or a spot's cone around its main axis, and no farther than a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shine {
    /// Cosines of the angles up to which a spot is full, and from which on it is dark.
    pub cone: [f32; 2],
    /// Where nothing is left of it, world units.
    pub range: f32,
}

impl Shine {
    /// Everywhere: the cosines are those of no angle, so that every direction lies inside.
    pub const EVERYWHERE: Self = Self { cone: [-2.0, -3.0], range: f32::MAX };

    /// A light's.
    pub fn of(light: &Light) -> Self {
        let cone = light.cone.map(|cone| [cone.inner.cos(), cone.outer.cos()]);
        Self {
            cone: cone.unwrap_or(Self::EVERYWHERE.cone),
            range: light.range.unwrap_or(Self::EVERYWHERE.range),
        }
    }

    /// The share of it at a light-space position: 1 in the middle, 0 outside.
    pub fn share(&self, p: Vec3<f32>) -> f32 {
        let distance = p.length();
        let [inner, outer] = self.cone;
        let cosine = p.z / Float::max(distance, f32::MIN_POSITIVE);
        dpsm_spot(cosine, inner, outer) * dpsm_range(distance, self.range)
    }
}

impl Frame {
    /// The frame with a light's colour, cone and range. Beyond a range all is dark, so far comes as near
    /// unless the settings say where it is.
    pub fn shining(mut self, light: &Light) -> Self {
        self.color = light.color;
        self.shine = Shine::of(light);
        if self.settings.far.is_none() && self.shine.range > self.light.near {
            self.light.far = self.light.far.min(self.shine.range);
        }
        self
    }
}
