//! Port of `wgsl/lights.wesl`.

use super::bias::{dpsm_position_error, dpsm_receiver};
use super::filter::{DpsmTaps, dpsm_filter_disk};
use super::float::{Float, Vec2, Vec3, Vec4};
use super::hemisphere::dpsm_to_light;
use super::kernel::dpsm_kernel_tangent;
use super::light::DpsmLight;
use super::maps::Maps;
use super::plane::dpsm_visibility_plane;

/// A world-space direction in light space.
pub fn dpsm_lights_turn<T: Float>(direction: Vec3<T>, light: DpsmLight<T>) -> Vec3<T> {
    Vec3::new(light.right.dot(direction), light.up.dot(direction), light.forward.dot(direction))
}

/// The share of one light that a surface point gets.
#[allow(clippy::too_many_arguments)] // those of the shader
pub fn dpsm_lights_visibility<T: Float>(
    maps: &impl Maps<T>,
    world: Vec3<T>,
    normal: Vec3<T>,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
    radius: T,
    rotation: Vec2<T>,
) -> T {
    let p = dpsm_to_light(world, light);
    let receiver = dpsm_receiver(p, dpsm_lights_turn(normal, light), dpsm_position_error(world));
    if radius <= T::lit(0.0) {
        return dpsm_visibility_plane(maps, p, receiver, light, taps.quantum, taps.tolerance);
    }
    let tangent = dpsm_kernel_tangent(p, radius);
    dpsm_filter_disk(maps, p, receiver, tangent, light, taps, rotation)
}

/// The shares of up to four lights; 0 for those from count on.
#[allow(clippy::too_many_arguments)] // those of the shader
pub fn dpsm_lights_four<T: Float>(
    maps: &impl Maps<T>,
    world: Vec3<T>,
    normal: Vec3<T>,
    lights: [DpsmLight<T>; 4],
    count: u32,
    taps: DpsmTaps<T>,
    radius: T,
    rotation: Vec2<T>,
) -> Vec4<T> {
    let mut shares = [T::lit(0.0); 4];
    for (share, light) in shares.iter_mut().zip(lights).take(count as usize) {
        *share = dpsm_lights_visibility(maps, world, normal, light, taps, radius, rotation);
    }
    let [x, y, z, w] = shares;
    Vec4::new(x, y, z, w)
}
