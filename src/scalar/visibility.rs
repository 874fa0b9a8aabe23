//! Port of `wgsl/visibility.wesl`.

use super::depth::{dpsm_depth, dpsm_depth_stored, dpsm_receiver_depth};
use super::float::{Float, Vec2, Vec3, select};
use super::hemisphere::{DPSM_BACK, DPSM_FRONT, dpsm_flip, dpsm_hemisphere};
use super::light::{DpsmLight, dpsm_light_coordinates, dpsm_light_layer};
use super::maps::Maps;
use super::paraboloid::{dpsm_disk_to_texture, dpsm_project};

/// Where a receiver looks, and what it compares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmLookup<T> {
    /// Texture coordinates in the texture that holds the map.
    pub coordinates: Vec2<T>,
    /// The receiver's own depth, in [0, 1].
    pub depth: T,
    /// Array layer.
    pub layer: u32,
    /// The receiver's hemisphere.
    pub hemisphere: u32,
    /// False where the light has no map for the receiver's hemisphere: always in shadow.
    pub mapped: bool,
}

/// Brabec's interpolants for a lookup by texture coordinates from the vertex stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmReceiverVertex<T> {
    /// Texture coordinates in the front map.
    pub front: Vec2<T>,
    /// Texture coordinates in the back map.
    pub back: Vec2<T>,
    /// The receiver's own depth, not clamped.
    pub depth: T,
    /// At least 0.5 in the front hemisphere: 0.5 + z / (2 far).
    pub hemisphere_value: T,
}

/// The lookup of a light-space point: hemisphere, place in the texture and own depth.
pub fn dpsm_lookup<T: Float>(p: Vec3<T>, light: DpsmLight<T>) -> DpsmLookup<T> {
    let hemisphere = dpsm_hemisphere(p);
    let disk = dpsm_project(dpsm_flip(p, hemisphere));
    let st = dpsm_disk_to_texture(disk, light.guard);
    DpsmLookup {
        coordinates: dpsm_light_coordinates(light, hemisphere, st),
        depth: dpsm_receiver_depth(p.length(), light.near, light.far),
        layer: dpsm_light_layer(light, hemisphere),
        hemisphere,
        mapped: hemisphere < light.hemispheres,
    }
}

/// The shadow test for each pixel: 1 lit, 0 in shadow; `maps` stands for texture and sampler.
pub fn dpsm_visibility<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    light: DpsmLight<T>,
    bias: T,
) -> T {
    let at = dpsm_lookup(p, light);
    let reference = dpsm_depth_stored(at.depth - bias, light.reversed);
    let lit = maps.compare(at.coordinates, at.layer, reference);
    select(T::lit(0.0), lit, at.mapped)
}

/// Brabec's vertex of a receiver: coordinates in both maps, depth and the hemisphere value.
pub fn dpsm_receiver_vertex<T: Float>(p: Vec3<T>, light: DpsmLight<T>) -> DpsmReceiverVertex<T> {
    let half = T::lit(0.5);
    let l = p.length();
    let front = dpsm_project(p);
    let back = dpsm_project(dpsm_flip(p, DPSM_BACK));
    DpsmReceiverVertex {
        front: dpsm_disk_to_texture(front, light.guard),
        back: dpsm_disk_to_texture(back, light.guard),
        depth: dpsm_depth(l, light.near, light.far),
        hemisphere_value: half + half * p.z / light.far,
    }
}

/// The shadow test with interpolated texture coordinates: 1 lit, 0 in shadow.
pub fn dpsm_visibility_vertex<T: Float>(
    maps: &impl Maps<T>,
    at: DpsmReceiverVertex<T>,
    light: DpsmLight<T>,
    bias: T,
) -> T {
    let hemisphere = select(DPSM_BACK, DPSM_FRONT, at.hemisphere_value >= T::lit(0.5));
    let own_map = select(at.back, at.front, hemisphere == DPSM_FRONT);
    let st = dpsm_light_coordinates(light, hemisphere, own_map);
    let inside = at.depth.clamp(T::lit(0.0), T::lit(1.0));
    let own = dpsm_depth_stored(inside - bias, light.reversed);
    let lit = maps.compare(st, dpsm_light_layer(light, hemisphere), own);
    select(T::lit(0.0), lit, hemisphere < light.hemispheres)
}
