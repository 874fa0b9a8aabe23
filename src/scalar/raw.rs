//! Port of `wgsl/raw.wesl`.

use super::bias::DpsmReceiver;
use super::filter::{DPSM_TAP_HARD, DpsmReader, DpsmTaps, dpsm_filter_lookup, dpsm_filter_reader};
use super::float::{Float, Vec2, Vec3, select};
use super::hemisphere::dpsm_hemisphere;
use super::kernel::{
    DpsmKernel, DpsmTap, dpsm_kernel, dpsm_kernel_mirrored, dpsm_kernel_projected,
    dpsm_kernel_ring, dpsm_kernel_tap, dpsm_kernel_turn,
};
use super::light::{DPSM_ATLAS, DpsmLight};
use super::maps::Maps;
use super::paraboloid::{dpsm_project_own, dpsm_texel_pitch};
use super::pcss::{DpsmBlockers, dpsm_pcss_found, dpsm_pcss_tangent, dpsm_pcss_width};
use super::visibility::{DpsmLookup, dpsm_lookup};

/// The depth stored in a texel, coordinates clamped to the texture.
pub fn dpsm_raw_load<T: Float>(maps: &impl Maps<T>, texel: Vec2<T>, layer: u32) -> T {
    maps.load(texel, layer)
}

/// 1 where the texel at the lookup's coordinates stores no less than its depth, else 0.
pub fn dpsm_raw_compare<T: Float>(maps: &impl Maps<T>, at: DpsmLookup<T>, kind: u32) -> T {
    let [zero, half, one] = [0.0, 0.5, 1.0].map(T::lit);
    let place = at.coordinates * maps.size();
    let lit = |texel: Vec2<T>| select(zero, one, at.depth <= dpsm_raw_load(maps, texel, at.layer));
    if kind == DPSM_TAP_HARD {
        return lit(place.floor());
    }
    let first = (place - Vec2::splat(half)).floor();
    let share = place - Vec2::splat(half) - first;
    let column = |x: T| {
        let [top, bottom] = [zero, one].map(|y| lit(first + Vec2::new(x, y)));
        [top, bottom]
    };
    let ([left_top, left_bottom], [right_top, right_bottom]) = (column(zero), column(one));
    let top = left_top * (one - share.x) + right_top * share.x;
    let bottom = left_bottom * (one - share.x) + right_bottom * share.x;
    top * (one - share.y) + bottom * share.y
}

/// dpsm_filter_tap by loads.
pub fn dpsm_raw_tap<T: Float>(
    maps: &impl Maps<T>,
    reader: DpsmReader<T>,
    tap: DpsmTap<T>,
    light: DpsmLight<T>,
) -> T {
    let at = dpsm_filter_lookup(reader, tap, light);
    select(T::lit(0.0), dpsm_raw_compare(maps, at, reader.kind), at.mapped)
}

/// dpsm_filter_hardware by loads.
pub fn dpsm_raw_hardware<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
) -> T {
    let own = DpsmTap { uv: dpsm_project_own(p), hemisphere: dpsm_hemisphere(p) };
    dpsm_raw_tap(maps, dpsm_filter_reader(receiver, light, taps), own, light)
}

/// dpsm_filter_pcf by loads.
pub fn dpsm_raw_pcf<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    light: DpsmLight<T>,
    side: u32,
    bias: T,
    kind: u32,
) -> T {
    let own = dpsm_lookup(p, light);
    let atlas = light.placement == DPSM_ATLAS;
    let extent = select(Vec2::splat(T::lit(1.0)), light.rectangle.zw(), atlas);
    let texel = extent / light.size;
    let middle = T::lit(0.5) * T::lit(side.into()) - T::lit(0.5);
    let mut sum = T::lit(0.0);
    for index in 0..side * side {
        let [x, y] = [index % side, index / side].map(|i| T::lit(i.into()));
        let offset = Vec2::new(x, y) - Vec2::splat(middle);
        let coordinates = own.coordinates + offset * texel;
        let at = DpsmLookup { coordinates, depth: own.depth - bias, ..own };
        sum = sum + dpsm_raw_compare(maps, at, kind);
    }
    select(T::lit(0.0), sum / T::lit((side * side).into()), own.mapped)
}

/// dpsm_filter_disk by loads.
pub fn dpsm_raw_disk<T: Float>(
    maps: &impl Maps<T>,
    receiver: DpsmReceiver<T>,
    kernel: DpsmKernel<T>,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
    rotation: Vec2<T>,
) -> T {
    let reader = dpsm_filter_reader(receiver, light, taps);
    let mut sum = T::lit(0.0);
    let mut direction = rotation;
    for index in 0..taps.count {
        let offset = direction * dpsm_kernel_ring::<T>(index, taps.count);
        let tap = dpsm_kernel_tap(kernel, offset);
        sum = sum + dpsm_raw_tap(maps, reader, tap, light);
        direction = dpsm_kernel_turn(direction);
    }
    sum / T::lit(taps.count.into())
}

/// dpsm_filter_mirror by loads.
pub fn dpsm_raw_mirror<T: Float>(
    maps: &impl Maps<T>,
    receiver: DpsmReceiver<T>,
    kernel: DpsmKernel<T>,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
    rotation: Vec2<T>,
) -> T {
    let reader = dpsm_filter_reader(receiver, light, taps);
    let mut sum = T::lit(0.0);
    let mut direction = rotation;
    for index in 0..taps.count {
        let offset = direction * dpsm_kernel_ring::<T>(index, taps.count);
        let tap = dpsm_kernel_mirrored(kernel, offset);
        sum = sum + dpsm_raw_tap(maps, reader, tap, light);
        direction = dpsm_kernel_turn(direction);
    }
    sum / T::lit(taps.count.into())
}

/// dpsm_filter_reproject by loads.
pub fn dpsm_raw_reproject<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    tangent: T,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
    rotation: Vec2<T>,
) -> T {
    let reader = dpsm_filter_reader(receiver, light, taps);
    let mut sum = T::lit(0.0);
    let mut direction = rotation;
    for index in 0..taps.count {
        let offset = direction * dpsm_kernel_ring::<T>(index, taps.count);
        let tap = dpsm_kernel_projected(p, tangent, offset);
        sum = sum + dpsm_raw_tap(maps, reader, tap, light);
        direction = dpsm_kernel_turn(direction);
    }
    sum / T::lit(taps.count.into())
}

/// dpsm_pcss_search by loads.
pub fn dpsm_raw_pcss_search<T: Float>(
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
        let stored = dpsm_raw_load(maps, (at.coordinates * maps.size()).floor(), at.layer);
        found = dpsm_pcss_found(found, stored, at, receiver, light, radius);
        direction = dpsm_kernel_turn(direction);
    }
    found
}

/// dpsm_pcss by loads.
#[allow(clippy::too_many_arguments)] // those of the shader
pub fn dpsm_raw_pcss<T: Float>(
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
    let found = dpsm_raw_pcss_search(maps, receiver, search, light, taps, radius, rotation);
    if found.count == 0 && found.unmapped == 0 {
        return T::lit(1.0);
    }
    let kernel = dpsm_kernel(p, dpsm_pcss_width(found, pitch));
    dpsm_raw_disk(maps, receiver, kernel, light, taps, rotation)
}
