//! A surface point and its lit colour, as camera.wesl's `shade`.

use glam::Vec3;

use super::{mix, vector, words};
use crate::render::{AMBIENT, Frame, SPECULAR, float};
use crate::scalar::float::{self as scalar, Float, select};
use crate::scalar::hemisphere::dpsm_to_light;
use crate::scalar::light::DpsmLight;
use crate::scalar::shade::{
    DpsmCorner, dpsm_highlight, dpsm_lambert, dpsm_shade, dpsm_shadow_terminator,
};

/// A surface point in light space.
#[derive(Clone, Copy)]
pub(super) struct Surface {
    pub triangle: u32,
    pub weights: [f32; 3],
    /// The triangle's own normal.
    pub plane: scalar::Vec3<f32>,
    pub p: scalar::Vec3<f32>,
    pub normal: scalar::Vec3<f32>,
    pub albedo: Vec3,
}

impl Surface {
    pub fn new(frame: &Frame, triangle: u32, weights: [f32; 3]) -> Self {
        let light = frame.light;
        let corners = frame.triangles[triangle as usize].map(|i| frame.vertices[i as usize]);
        let p = mix(weights, corners, |v| words(dpsm_to_light(float(v.position), light)));
        let normal = mix(weights, corners, |v| words(to_light_space(light, float(v.normal))));
        Self {
            triangle,
            weights,
            plane: frame.light_normal(triangle),
            p: vector(p),
            normal: vector(normal),
            albedo: corners[0].albedo,
        }
    }

    /// Where the shadow test is made, as camera.wesl's `receiver_of`.
    pub fn receiver(&self, frame: &Frame, eye: scalar::Vec3<f32>) -> scalar::Vec3<f32> {
        if !frame.settings.terminator {
            return self.p;
        }
        let light = frame.light;
        let side = side_of(self.plane, self.normal, eye - self.p);
        let corners = frame.triangles[self.triangle as usize].map(|i| {
            let v = frame.vertices[i as usize];
            let position = dpsm_to_light(float(v.position), light);
            DpsmCorner { position, normal: to_light_space(light, float(v.normal)) * side }
        });
        let [a, b, c] = corners;
        dpsm_shadow_terminator(self.p, vector(self.weights), a, b, c)
    }

    /// Lit colour seen from `eye` in light space, as camera.wesl's `shade`.
    pub fn shade(&self, frame: &Frame, eye: scalar::Vec3<f32>, visibility: f32) -> Vec3 {
        let opposite = vector([0.0; 3]) - self.p;
        let to_light = opposite / self.p.length().max(frame.light.near);
        let to_eye = (eye - self.p) / Float::max((eye - self.p).length(), frame.view.near);
        let unit = self.normal / self.normal.length().max(1e-6);
        let normal = unit * side_of(self.plane, unit, to_eye);
        let cosine = dpsm_lambert(normal, to_light);
        let highlight = select(0.0, dpsm_highlight(normal, to_light, to_eye), cosine > 0.0);
        let color = frame.color;
        let lit = dpsm_shade(
            float(color * self.albedo * (AMBIENT * (0.5 + 0.5 * normal.dot(to_eye).max(0.0)))),
            float(color * self.albedo * cosine),
            float(color * SPECULAR * highlight),
            visibility * frame.shine.share(self.p),
        );
        Vec3::new(lit.x, lit.y, lit.z)
    }
}

fn to_light_space(light: DpsmLight<f32>, v: scalar::Vec3<f32>) -> scalar::Vec3<f32> {
    vector([light.right.dot(v), light.up.dot(v), light.forward.dot(v)])
}

/// 1 where a vertex normal lies on the eye's side of its triangle, else -1.
fn side_of(plane: scalar::Vec3<f32>, normal: scalar::Vec3<f32>, to_eye: scalar::Vec3<f32>) -> f32 {
    select(-1.0, 1.0, plane.dot(normal) * plane.dot(to_eye) >= 0.0)
}
