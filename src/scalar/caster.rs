//! Port of `wgsl/caster.wesl`.

use super::depth::{dpsm_depth, dpsm_depth_stored, dpsm_within};
use super::float::{Float, Vec3, Vec4};
use super::light::DpsmLight;
use super::paraboloid::dpsm_project;

/// What the vertex stage hands on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmCasterVertex<T> {
    /// Clip-space position: projected disk, depth, 1.
    pub clip: Vec4<T>,
    /// Brabec's alpha: at least 0.5 inside the stored disk.
    pub hemisphere_value: T,
}

/// What a fragment stores.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmCasterFragment<T> {
    /// Stored depth with bias.
    pub depth: T,
    /// False where the fragment must be discarded.
    pub keep: bool,
}

/// The cosine from the map's axis of the stored disk's border r = 1 + guard.
pub fn dpsm_caster_border<T: Float>(guard: T) -> T {
    let one = T::lit(1.0);
    let square = (one + guard) * (one + guard);
    (one - square) / (one + square)
}

/// Brabec's vertex: projected disk, biased radial depth and hemisphere value.
pub fn dpsm_caster_vertex<T: Float>(
    p: Vec3<T>,
    light: DpsmLight<T>,
    bias: T,
) -> DpsmCasterVertex<T> {
    let half = T::lit(0.5);
    let l = p.length();
    let disk = dpsm_project(p) / (T::lit(1.0) + light.guard);
    let depth = dpsm_depth_stored(dpsm_depth(l, light.near, light.far) + bias, light.reversed);
    let height = p.z - l * dpsm_caster_border(light.guard);
    DpsmCasterVertex {
        clip: Vec4::new(disk.x, disk.y, depth, T::lit(1.0)),
        hemisphere_value: half + half * height / light.far,
    }
}

/// Brabec's alpha test: false where the fragment belongs to the other hemisphere.
pub fn dpsm_caster_keep<T: Float>(hemisphere_value: T) -> bool {
    hemisphere_value >= T::lit(0.5)
}

/// The blog's fragment: radial depth of the interpolated position, clipped.
pub fn dpsm_caster_fragment<T: Float>(
    p: Vec3<T>,
    light: DpsmLight<T>,
    bias: T,
) -> DpsmCasterFragment<T> {
    let l = p.length();
    let inside = p.z >= l * dpsm_caster_border(light.guard);
    DpsmCasterFragment {
        depth: dpsm_depth_stored(dpsm_depth(l, light.near, light.far) + bias, light.reversed),
        keep: inside && dpsm_within(l, light.near, light.far),
    }
}
