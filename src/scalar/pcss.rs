//! Port of `wgsl/pcss.wesl`.

use super::bias::DpsmReceiver;
use super::depth::dpsm_distance;
use super::filter::{
    DPSM_TAP_HARD, DpsmTaps, dpsm_filter_disk, dpsm_filter_lookup, dpsm_filter_reader,
};
use super::float::{Float, Vec2, Vec3};
use super::kernel::{DpsmKernel, dpsm_kernel, dpsm_kernel_ring, dpsm_kernel_tap, dpsm_kernel_turn};
use super::light::DpsmLight;
use super::maps::Maps;
use super::paraboloid::{DPSM_SMALLEST, dpsm_project_own, dpsm_texel_pitch};
use super::visibility::DpsmLookup;

/// Largest tangent of a kernel, 45 degrees.
pub const DPSM_PCSS_WIDEST: f64 = 1.0;

/// What a search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmBlockers<T> {
    /// Sum over the blockers of the tangent of the cone that each asks for.
    pub tangents: T,
    /// Taps that found a blocker.
    pub count: u32,
    /// Taps that lie where a hemispherical light has no map.
    pub unmapped: u32,
}

/// The tangent of the cone in which a caster shades a receiver partly.
pub fn dpsm_pcss_tangent<T: Float>(distance: T, blocker: T, radius: T) -> T {
    let smallest = T::lit(DPSM_SMALLEST);
    let behind = (distance - blocker).max(T::lit(0.0)) / distance.max(smallest);
    (behind * (radius / blocker.max(smallest))).min(T::lit(DPSM_PCSS_WIDEST))
}

/// What was found so far, and one tap more.
pub fn dpsm_pcss_found<T: Float>(
    found: DpsmBlockers<T>,
    stored: T,
    at: DpsmLookup<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    radius: T,
) -> DpsmBlockers<T> {
    if !at.mapped {
        return DpsmBlockers { unmapped: found.unmapped.wrapping_add(1), ..found };
    }
    if stored >= at.depth {
        return found;
    }
    let blocker = dpsm_distance(stored, light.near, light.far);
    let tangent = dpsm_pcss_tangent(receiver.distance, blocker, radius);
    let count = found.count.wrapping_add(1);
    DpsmBlockers { tangents: found.tangents + tangent, count, ..found }
}

/// The blockers of a receiver's plane in a kernel: texels that store less than it.
pub fn dpsm_pcss_search<T: Float>(
    maps: &impl Maps<T>,
    receiver: DpsmReceiver<T>,
    kernel: DpsmKernel<T>,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
    radius: T,
    rotation: Vec2<T>,
) -> DpsmBlockers<T> {
    let hard = DpsmTaps { kind: DPSM_TAP_HARD, ..taps };
    let reader = dpsm_filter_reader(receiver, light, hard);
    let mut found = DpsmBlockers { tangents: T::lit(0.0), count: 0, unmapped: 0 };
    let mut direction = rotation;
    for index in 0..taps.count {
        let offset = direction * dpsm_kernel_ring::<T>(index, taps.count);
        let tap = dpsm_kernel_tap(kernel, offset);
        let at = dpsm_filter_lookup(reader, tap, light);
        let texel = (at.coordinates * maps.size()).floor();
        let stored = maps.load(texel, at.layer);
        found = dpsm_pcss_found(found, stored, at, receiver, light, radius);
        direction = dpsm_kernel_turn(direction);
    }
    found
}

/// The kernel's tangent that the blockers ask for, the mean of theirs; a texel's at least.
pub fn dpsm_pcss_width<T: Float>(found: DpsmBlockers<T>, pitch: T) -> T {
    (found.tangents / T::lit(found.count.into()).max(T::lit(1.0))).max(pitch)
}

/// The share of a spherical light that a receiver sees.
#[allow(clippy::too_many_arguments)] // those of the shader
pub fn dpsm_pcss<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
    radius: T,
    nearest: T,
    rotation: Vec2<T>,
) -> T {
    let pitch = dpsm_texel_pitch(dpsm_project_own(p), light.size, light.guard);
    let widest = dpsm_pcss_tangent(receiver.distance, nearest, radius);
    let search = dpsm_kernel(p, widest.max(pitch));
    let found = dpsm_pcss_search(maps, receiver, search, light, taps, radius, rotation);
    if found.count == 0 && found.unmapped == 0 {
        return T::lit(1.0);
    }
    let kernel = dpsm_kernel(p, dpsm_pcss_width(found, pitch));
    dpsm_filter_disk(maps, receiver, kernel, light, taps, rotation)
}
