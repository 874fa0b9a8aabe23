//! Port of `wgsl/hemisphere.wesl`.

use super::float::{Float, Vec2, Vec3, select};
use super::light::DpsmLight;

/// The hemisphere z >= 0.
pub const DPSM_FRONT: u32 = 0;

/// The hemisphere z < 0.
pub const DPSM_BACK: u32 = 1;

/// Disk radius that stands for the pole opposite to the hemisphere's own: 2^25.
pub const DPSM_POLE_RADIUS: f64 = 33554432.0;

/// World space to light space: moves by the light's position first, then rotates.
pub fn dpsm_to_light<T: Float>(world: Vec3<T>, light: DpsmLight<T>) -> Vec3<T> {
    let p = world - light.position;
    Vec3::new(light.right.dot(p), light.up.dot(p), light.forward.dot(p))
}

/// The hemisphere of a light-space point: DPSM_FRONT for z >= 0 (-0 included), else DPSM_BACK.
pub fn dpsm_hemisphere<T: Float>(p: Vec3<T>) -> u32 {
    select(DPSM_BACK, DPSM_FRONT, p.z >= T::lit(0.0))
}

/// A light-space point as the given hemisphere's map sees it: z negated for the back.
pub fn dpsm_flip<T: Float>(p: Vec3<T>, hemisphere: u32) -> Vec3<T> {
    Vec3::new(p.x, p.y, select(p.z, -p.z, hemisphere == DPSM_BACK))
}

/// Crosses the seam: the same direction in the other hemisphere's disk coordinates, uv / r^2.
pub fn dpsm_invert<T: Float>(uv: Vec2<T>) -> Vec2<T> {
    let square = uv.dot(uv);
    if square <= T::lit(1.0 / (DPSM_POLE_RADIUS * DPSM_POLE_RADIUS)) {
        return Vec2::new(T::lit(DPSM_POLE_RADIUS), T::lit(0.0));
    }
    uv / square
}
