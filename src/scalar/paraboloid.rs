//! Port of `wgsl/paraboloid.wesl`.

use super::float::{Float, Vec2, Vec3};
use super::hemisphere::dpsm_invert;

/// Smallest distance that is told from the light's own position: 2^-51.
pub const DPSM_SMALLEST: f64 = 1.0 / (1u64 << 51) as f64;

/// Projects a light-space point to the front map's disk coordinates.
pub fn dpsm_project<T: Float>(p: Vec3<T>) -> Vec2<T> {
    let own = dpsm_project_own(p);
    if p.z >= T::lit(0.0) {
        return own;
    }
    dpsm_invert(own)
}

/// Projects a light-space point to its own hemisphere's disk coordinates, r <= 1.
pub fn dpsm_project_own<T: Float>(p: Vec3<T>) -> Vec2<T> {
    p.xy() / (p.length() + p.z.abs()).max(T::lit(DPSM_SMALLEST))
}

/// The unit direction of front-map disk coordinates: (2u, 2v, 1 - r^2) / (1 + r^2).
pub fn dpsm_unproject<T: Float>(uv: Vec2<T>) -> Vec3<T> {
    let one = T::lit(1.0);
    let square = uv.dot(uv);
    Vec3::new(uv.x + uv.x, uv.y + uv.y, one - square) / (one + square)
}

/// The angle in radians that a texel of an N x N map (size = N) spans at disk coordinates uv.
pub fn dpsm_texel_pitch<T: Float>(uv: Vec2<T>, size: T, guard: T) -> T {
    T::lit(4.0) * (T::lit(1.0) + guard) / (size + size * uv.dot(uv))
}

/// The width of a texel of an N x N map (size = N) on the disk.
pub fn dpsm_texel_width<T: Float>(size: T, guard: T) -> T {
    T::lit(2.0) * (T::lit(1.0) + guard) / size
}

/// The solid angle in steradians of a texel at disk coordinates uv: the square of its pitch.
pub fn dpsm_texel_solid_angle<T: Float>(uv: Vec2<T>, size: T, guard: T) -> T {
    let pitch = dpsm_texel_pitch(uv, size, guard);
    pitch * pitch
}

/// Disk coordinates to texture coordinates: the stored disk r <= 1 + guard fills [0, 1].
pub fn dpsm_disk_to_texture<T: Float>(uv: Vec2<T>, guard: T) -> Vec2<T> {
    let half = T::lit(0.5);
    Vec2::splat(half) + Vec2::new(uv.x, -uv.y) * half / (T::lit(1.0) + guard)
}

/// Texture coordinates to disk coordinates, the inverse of dpsm_disk_to_texture.
pub fn dpsm_texture_to_disk<T: Float>(st: Vec2<T>, guard: T) -> Vec2<T> {
    (st - Vec2::splat(T::lit(0.5))) * Vec2::new(T::lit(2.0), T::lit(-2.0)) * (T::lit(1.0) + guard)
}
