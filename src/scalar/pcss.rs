//! Port of `wgsl/pcss.wesl`.

use super::bias::DpsmReceiver;
use super::depth::dpsm_distance;
use super::filter::{
    DPSM_FILTER_SHIFT, DPSM_FILTER_SMALLEST, DPSM_FILTER_UNMAPPED, DPSM_FILTER_WIDEST, DpsmDisk,
    DpsmTaps, dpsm_filter_cone, dpsm_filter_layers, dpsm_filter_lit, dpsm_filter_map,
    dpsm_filter_places, dpsm_filter_read, dpsm_filter_sum, dpsm_filter_within,
};
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::hemisphere::DPSM_BACK;
use super::kernel::{dpsm_kernel_next, dpsm_kernel_rings};
use super::light::DpsmLight;
use super::maps::Maps;
use super::paraboloid::DPSM_SMALLEST;
use super::plane::dpsm_plane;

/// What a search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmBlockers<T> {
    /// The farthest blocker's stored depth among the first taps of all rings, the second ones, and
    /// so on; below 0 where there is none.
    pub farthest: Vec4<T>,
    /// Whether they were all lit.
    pub all: [bool; 4],
}

/// The tangent of the cone in which a caster shades a receiver partly.
pub fn dpsm_pcss_tangent<T: Float>(distance: T, blocker: T, radius: T) -> T {
    let smallest = T::lit(DPSM_SMALLEST);
    let behind = (distance - blocker).max(T::lit(0.0)) / distance.max(smallest);
    (behind * (radius / blocker.max(smallest))).min(T::lit(DPSM_FILTER_WIDEST))
}

/// The radius of a ring of a search: the square of the share of taps farther in.
pub fn dpsm_pcss_ring<T: Float>(share: T) -> T {
    share * share
}

/// What was found so far, and a ring more.
pub fn dpsm_pcss_found<T: Float>(
    found: DpsmBlockers<T>,
    disk: DpsmDisk<T>,
    offset: Vec2<T>,
    ring: T,
    stored: Vec4<T>,
) -> DpsmBlockers<T> {
    let reach = stored + Vec4::splat(disk.near);
    let lit = dpsm_filter_lit(disk, offset, ring, reach);
    let within = dpsm_filter_within(disk, ring, reach);
    let (stored, before) = (stored.to_array(), found.farthest.to_array());
    let none = T::lit(DPSM_FILTER_UNMAPPED);
    let farther = |i: usize| before[i].max(select(none, stored[i], within[i] && !lit[i]));
    DpsmBlockers {
        farthest: Vec4::from_array(std::array::from_fn(farther)),
        all: std::array::from_fn(|i| found.all[i] && lit[i]),
    }
}

/// The blockers of a receiver in a disk.
pub fn dpsm_pcss_search<T: Float>(
    maps: &impl Maps<T>,
    disk: DpsmDisk<T>,
    light: DpsmLight<T>,
    rings: u32,
) -> DpsmBlockers<T> {
    let other = DPSM_BACK.wrapping_sub(disk.hemisphere);
    let own = dpsm_filter_map(light, disk.hemisphere);
    let beyond = dpsm_filter_map(light, other).x;
    let layers = dpsm_filter_layers(light, disk.hemisphere);
    let mapped = [disk.hemisphere < light.hemispheres, other < light.hemispheres];
    let per = T::lit(1.0) / T::lit(rings.into());
    let mut share = T::lit(0.5) * per;
    let mut direction = Vec2::new(T::lit(1.0), T::lit(0.0));
    let none = Vec4::splat(T::lit(DPSM_FILTER_UNMAPPED));
    let mut found = DpsmBlockers { farthest: none, all: [true; 4] };
    for _ in 0..rings {
        let ring = dpsm_pcss_ring(share);
        let offset = direction * ring;
        let four = dpsm_filter_places(disk, own, beyond, offset);
        let stored = dpsm_filter_read(maps, four, layers, mapped, light.reversed);
        found = dpsm_pcss_found(found, disk, offset, ring, stored);
        direction = dpsm_kernel_next(direction);
        share = share + per;
    }
    found
}

/// The kernel's tangent that the farthest blocker asks for; half a texel's diagonal at least.
pub fn dpsm_pcss_width<T: Float>(
    found: DpsmBlockers<T>,
    distance: T,
    pitch: T,
    radius: T,
    light: DpsmLight<T>,
) -> T {
    let zero = T::lit(0.0);
    let each = found.farthest;
    let farthest = each.x.max(each.y).max(each.z.max(each.w));
    let blocker = dpsm_distance(farthest, light.near, light.far);
    let asked = select(zero, dpsm_pcss_tangent(distance, blocker, radius), farthest >= zero);
    asked.max(T::lit(DPSM_FILTER_SMALLEST) * pitch).min(T::lit(DPSM_FILTER_WIDEST))
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
    let shift = T::lit(DPSM_FILTER_SHIFT);
    let at = dpsm_plane(p, receiver, shift, light, taps.quantum, taps.tolerance);
    let distance = receiver.distance;
    let seen = radius / distance.max(T::lit(DPSM_SMALLEST));
    let smallest = (T::lit(DPSM_FILTER_SMALLEST) * at.pitch).min(T::lit(DPSM_FILTER_WIDEST));
    let widest = dpsm_pcss_tangent(distance, nearest, radius).max(smallest);
    let search = dpsm_filter_cone(at, widest, seen, rotation);
    let rings = dpsm_kernel_rings(taps.count);
    let found = dpsm_pcss_search(maps, search, light, rings);
    if found.all.iter().all(|lit| *lit) {
        return T::lit(1.0);
    }
    let width = dpsm_pcss_width(found, distance, at.pitch, radius, light);
    let disk = dpsm_filter_cone(at, width, seen, rotation);
    dpsm_filter_sum(maps, disk, light, rings)
}
