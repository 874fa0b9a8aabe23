//! Maps of scenes that are given as functions of the direction.

use dpsm::scalar::bias::{DpsmReceiver, dpsm_receiver};
use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::filter::{DPSM_TAP_HARD, DpsmTaps};
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::dpsm_flip;
use dpsm::scalar::kernel::dpsm_kernel_guard;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::{dpsm_texture_to_disk, dpsm_unproject};
use fastrand::Rng;

use crate::common::{cross, unit};

/// A light at the origin with maps of that size, its guard band for 2 x 2 texels.
pub fn light(size: u32) -> DpsmLight<f64> {
    DpsmLight {
        position: Vec3::splat(0.0),
        near: 0.1,
        far: 20.0,
        guard: dpsm_kernel_guard(size.into(), 2.0),
        size: size.into(),
        first_layer: 0,
        ..dpsm::cases::light(0).widen()
    }
}

/// A random rotation's rows.
pub fn rotated(light: DpsmLight<f64>, rng: &mut Rng) -> DpsmLight<f64> {
    let forward = unit(rng).widen();
    let forward = forward / forward.length();
    let right = cross(forward, unit(rng).widen());
    let right = right / right.length();
    DpsmLight { right, up: cross(forward, right), forward, ..light }
}

/// A direction of light space in world space.
pub fn to_world(light: DpsmLight<f64>, d: Vec3<f64>) -> Vec3<f64> {
    light.right * d.x + light.up * d.y + light.forward * d.z
}

/// A direction of world space in light space.
pub fn to_light(light: DpsmLight<f64>, d: Vec3<f64>) -> Vec3<f64> {
    Vec3::new(light.right.dot(d), light.up.dot(d), light.forward.dot(d))
}

/// Both maps of a scene: the distance in each world direction, `None` where nothing is hit. What
/// lies outside the stored disk is never written.
pub fn maps(
    light: DpsmLight<f64>,
    scene: impl Fn(Vec3<f64>) -> Option<f64>,
    sampling: Sampling,
) -> DepthMaps {
    let size = light.size as u32;
    let mut maps = DepthMaps::empty(size, 2, sampling);
    for layer in 0..2 {
        for (x, y) in (0..size).flat_map(|y| (0..size).map(move |x| (x, y))) {
            let st = Vec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / light.size;
            let uv = dpsm_texture_to_disk(st, light.guard);
            if uv.length() > 1.0 + light.guard {
                continue;
            }
            let d = to_world(light, dpsm_flip(dpsm_unproject(uv), layer));
            if let Some(distance) = scene(d) {
                let index = maps.index(x.into(), y.into(), layer);
                let depth = dpsm_depth(distance, light.near, light.far);
                maps.depths[index] = depth.clamp(0.0, 1.0) as f32;
            }
        }
    }
    maps
}

/// The light in f32.
pub fn narrow(light: DpsmLight<f64>) -> DpsmLight<f32> {
    DpsmLight {
        position: light.position.narrow(),
        near: light.near as f32,
        right: light.right.narrow(),
        far: light.far as f32,
        up: light.up.narrow(),
        guard: light.guard as f32,
        forward: light.forward.narrow(),
        size: light.size as f32,
        rectangle: light.rectangle.narrow(),
        first_layer: light.first_layer,
        placement: light.placement,
        hemispheres: light.hemispheres,
        reversed: 0,
    }
}

/// Hard taps at maps of 32-bit floats.
pub fn hard(count: u32) -> DpsmTaps<f64> {
    DpsmTaps { count, kind: DPSM_TAP_HARD, quantum: 0.0, tolerance: 0.0 }
}

/// The same taps in f32.
pub fn narrow_taps(taps: DpsmTaps<f64>) -> DpsmTaps<f32> {
    DpsmTaps {
        count: taps.count,
        kind: taps.kind,
        quantum: taps.quantum as f32,
        tolerance: taps.tolerance as f32,
    }
}

/// The first tap's direction where it does not matter.
pub fn first<T: dpsm::scalar::float::Float>() -> Vec2<T> {
    Vec2::new(T::lit(1.0), T::lit(0.0))
}

/// A floor three units from the light along a world axis, and a round lid before it that all rays
/// within LID of the axis hit.
pub struct Lid {
    pub axis: Vec3<f64>,
}

/// Half-angle of the lid seen from the light.
pub const LID: f64 = 0.5;

/// Distances of floor and lid.
pub const FLOOR: f64 = 3.0;
pub const LID_DISTANCE: f64 = 1.5;

impl Lid {
    /// The distance of what a world direction hits.
    pub fn distance(&self, d: Vec3<f64>) -> Option<f64> {
        if crate::common::angle(d, self.axis) < LID {
            return Some(LID_DISTANCE);
        }
        let along = d.dot(self.axis) / d.length();
        (along > 0.0).then(|| FLOOR / along)
    }

    /// A floor point at an angle from the axis, in light space, and its receiver.
    pub fn receiver(
        &self,
        light: DpsmLight<f64>,
        off: f64,
        azimuth: f64,
    ) -> (Vec3<f64>, DpsmReceiver<f64>) {
        let helper = if self.axis.x.abs() < 0.9 { (1.0, 0.0) } else { (0.0, 1.0) };
        let side = cross(self.axis, Vec3::new(helper.0, helper.1, 0.0));
        let side = side / side.length();
        let other = cross(self.axis, side);
        let away = side * azimuth.cos() + other * azimuth.sin();
        let world = self.axis * FLOOR + away * (FLOOR * off.tan());
        let p = to_light(light, world);
        (p, dpsm_receiver(p, to_light(light, self.axis), 0.0))
    }
}
