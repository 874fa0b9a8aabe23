//! A surface point and its lit colour, as camera.wesl's `shade`.

use glam::Vec3;

use super::{mix, vector, words};
use crate::render::{AMBIENT, Frame, SPECULAR, float};
use crate::scalar::float::{self as scalar, Float, select};
use crate::scalar::hemisphere::dpsm_to_light;
use crate::scalar::shade::{dpsm_highlight, dpsm_lambert, dpsm_shade};

/// A surface point in light space.
pub(super) struct Surface {
    pub p: scalar::Vec3<f32>,
    pub normal: scalar::Vec3<f32>,
    pub albedo: Vec3,
}

impl Surface {
    pub fn new(frame: &Frame, triangle: u32, weights: [f32; 3]) -> Self {
        let light = frame.light;
        let corners = frame.triangles[triangle as usize].map(|i| frame.vertices[i as usize]);
        let p = mix(weights, corners, |v| words(dpsm_to_light(float(v.position), light)));
        let normal = mix(weights, corners, |v| {
            let n = float(v.normal);
            [light.right.dot(n), light.up.dot(n), light.forward.dot(n)]
        });
        Self { p: vector(p), normal: vector(normal), albedo: corners[0].albedo }
    }

    /// Lit colour seen from `eye` in light space, as camera.wesl's `shade`.
    pub fn shade(&self, frame: &Frame, eye: scalar::Vec3<f32>, visibility: f32) -> Vec3 {
        let opposite = vector([0.0; 3]) - self.p;
        let to_light = opposite / self.p.length().max(frame.light.near);
        let to_eye = (eye - self.p) / Float::max((eye - self.p).length(), frame.view.near);
        let unit = self.normal / self.normal.length().max(1e-6);
        let normal = select(vector([0.0; 3]) - unit, unit, unit.dot(to_eye) >= 0.0);
        let cosine = dpsm_lambert(normal, to_light);
        let highlight = select(0.0, dpsm_highlight(normal, to_light, to_eye), cosine > 0.0);
        let color = frame.color;
        let lit = dpsm_shade(
            float(color * self.albedo * (AMBIENT * (0.5 + 0.5 * normal.dot(to_eye)))),
            float(color * self.albedo * cosine),
            float(color * SPECULAR * highlight),
            visibility,
        );
        Vec3::new(lit.x, lit.y, lit.z)
    }
}
