//! Port of `wgsl/raw.wesl`.

use super::bias::DpsmReceiver;
use super::depth::{dpsm_depth_stored, dpsm_depth_stored_four};
use super::filter::{
    DPSM_FILTER_SHIFT, DPSM_FILTER_SMALLEST, DPSM_FILTER_UNMAPPED, DPSM_FILTER_WIDEST,
    DPSM_TAP_HARD, DpsmContact, DpsmDisk, DpsmFour, DpsmReader, DpsmTaps, dpsm_filter_cone,
    dpsm_filter_contact, dpsm_filter_dense, dpsm_filter_even, dpsm_filter_layers,
    dpsm_filter_lookup, dpsm_filter_map, dpsm_filter_places, dpsm_filter_reader, dpsm_filter_share,
};
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::hemisphere::{DPSM_BACK, dpsm_hemisphere};
use super::kernel::{
    DpsmKernel, DpsmTap, dpsm_kernel_mirrored, dpsm_kernel_next, dpsm_kernel_projected,
    dpsm_kernel_ring, dpsm_kernel_rings, dpsm_kernel_turn,
};
use super::light::{DPSM_ATLAS, DpsmLight, dpsm_light_coordinates, dpsm_light_layer};
use super::maps::Maps;
use super::paraboloid::{DPSM_SMALLEST, dpsm_project_own};
use super::pcss::{
    DpsmBlockers, dpsm_pcss_found, dpsm_pcss_ring, dpsm_pcss_tangent, dpsm_pcss_width,
};
use super::plane::{DPSM_PLANE_SHIFT, dpsm_plane, dpsm_plane_four, dpsm_plane_share};
use super::visibility::{DpsmLookup, dpsm_lookup};

/// The depth stored in a texel, coordinates clamped to the texture.
pub fn dpsm_raw_load<T: Float>(maps: &impl Maps<T>, texel: Vec2<T>, layer: u32) -> T {
    maps.load(texel, layer)
}

/// 1 where the texel at the lookup's coordinates stores no less than its depth, else 0.
pub fn dpsm_raw_compare<T: Float>(
    maps: &impl Maps<T>,
    at: DpsmLookup<T>,
    kind: u32,
    reversed: u32,
) -> T {
    let [zero, half, one] = [0.0, 0.5, 1.0].map(T::lit);
    let place = at.coordinates * maps.size();
    let lit = |texel: Vec2<T>| {
        let held = dpsm_raw_load(maps, texel, at.layer);
        select(zero, one, at.depth <= dpsm_depth_stored(held, reversed))
    };
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
    select(T::lit(0.0), dpsm_raw_compare(maps, at, reader.kind, light.reversed), at.mapped)
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
        sum = sum + dpsm_raw_compare(maps, at, kind, light.reversed);
    }
    select(T::lit(0.0), sum / T::lit((side * side).into()), own.mapped)
}

/// dpsm_visibility_plane by loads.
pub fn dpsm_raw_plane<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    quantum: T,
    tolerance: T,
) -> T {
    let at = dpsm_plane(p, receiver, T::lit(DPSM_PLANE_SHIFT), light, quantum, tolerance);
    let four = dpsm_plane_four(at, light);
    let corner = (four.xy() + Vec2::splat(T::lit(1.0))) / light.size;
    let st = dpsm_light_coordinates(light, at.hemisphere, corner);
    let first = (st * maps.size() - Vec2::splat(T::lit(0.5))).floor();
    let layer = dpsm_light_layer(light, at.hemisphere);
    let load = |right: f64, down: f64| {
        dpsm_raw_load(maps, first + Vec2::new(T::lit(right), T::lit(down)), layer)
    };
    let stored = Vec4::new(load(0.0, 1.0), load(1.0, 1.0), load(1.0, 0.0), load(0.0, 0.0));
    let depths = dpsm_depth_stored_four(stored, light.reversed);
    select(T::lit(0.0), dpsm_plane_share(at, four, depths), at.hemisphere < light.hemispheres)
}

/// dpsm_filter_read by loads.
pub fn dpsm_raw_read<T: Float>(
    maps: &impl Maps<T>,
    at: DpsmFour<T>,
    layers: [u32; 2],
    mapped: [bool; 2],
    reversed: u32,
) -> Vec4<T> {
    let (s, t, size) = (at.s.to_array(), at.t.to_array(), maps.size());
    let read = |i: usize| {
        let map = usize::from(at.crossed[i]);
        let stored = dpsm_raw_load(maps, (Vec2::new(s[i], t[i]) * size).floor(), layers[map]);
        let depth = dpsm_depth_stored(stored, reversed);
        select(T::lit(DPSM_FILTER_UNMAPPED), depth, mapped[map])
    };
    Vec4::from_array(std::array::from_fn(read))
}

/// dpsm_filter_sum by loads.
pub fn dpsm_raw_sum<T: Float>(
    maps: &impl Maps<T>,
    disk: DpsmDisk<T>,
    light: DpsmLight<T>,
    rings: u32,
) -> T {
    let other = DPSM_BACK.wrapping_sub(disk.hemisphere);
    let own = dpsm_filter_map(light, disk.hemisphere);
    let beyond = dpsm_filter_map(light, other).x;
    let layers = dpsm_filter_layers(light, disk.hemisphere);
    let mapped = [disk.hemisphere < light.hemispheres, other < light.hemispheres];
    let per = T::lit(1.0) / T::lit(rings.into());
    let mut share = T::lit(0.5) * per;
    let mut direction = Vec2::new(T::lit(1.0), T::lit(0.0));
    let mut sum = Vec4::splat(T::lit(0.0));
    for _ in 0..rings {
        let ring = share.sqrt();
        let offset = direction * ring;
        let four = dpsm_filter_places(disk, own, beyond, offset);
        let stored = dpsm_raw_read(maps, four, layers, mapped, light.reversed);
        sum = sum + dpsm_filter_even(disk, offset, ring, stored);
        direction = dpsm_kernel_next(direction);
        share = share + per;
    }
    dpsm_filter_share(sum)
}

/// dpsm_filter_disk by loads.
pub fn dpsm_raw_disk<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    tangent: T,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
    rotation: Vec2<T>,
) -> T {
    let shift = T::lit(DPSM_FILTER_SHIFT);
    let at = dpsm_plane(p, receiver, shift, light, taps.quantum, taps.tolerance);
    let least = T::lit(DPSM_FILTER_SMALLEST) * at.pitch;
    let wide = tangent.max(least).min(T::lit(DPSM_FILTER_WIDEST));
    let disk = dpsm_filter_cone(at, wide, wide, rotation);
    let rings = dpsm_kernel_rings(taps.count);
    let other = DPSM_BACK.wrapping_sub(disk.hemisphere);
    let own = dpsm_filter_map(light, disk.hemisphere);
    let beyond = dpsm_filter_map(light, other).x;
    let layers = dpsm_filter_layers(light, disk.hemisphere);
    let mapped = [disk.hemisphere < light.hemispheres, other < light.hemispheres];
    let per = T::lit(1.0) / T::lit(rings.into());
    let mut share = T::lit(0.5) * per;
    let mut direction = Vec2::new(T::lit(1.0), T::lit(0.0));
    let mut found = DpsmContact { sum: Vec4::splat(T::lit(0.0)), farthest: T::lit(0.0) };
    for _ in 0..rings {
        let ring = dpsm_filter_dense(share);
        let offset = direction * ring;
        let four = dpsm_filter_places(disk, own, beyond, offset);
        let stored = dpsm_raw_read(maps, four, layers, mapped, light.reversed);
        found = dpsm_filter_contact(found, disk, offset, ring, stored);
        direction = dpsm_kernel_next(direction);
        share = share + per;
    }
    dpsm_filter_share(found.sum)
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
        let stored = dpsm_raw_read(maps, four, layers, mapped, light.reversed);
        found = dpsm_pcss_found(found, disk, offset, ring, stored);
        direction = dpsm_kernel_next(direction);
        share = share + per;
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
    let shift = T::lit(DPSM_FILTER_SHIFT);
    let at = dpsm_plane(p, receiver, shift, light, taps.quantum, taps.tolerance);
    let distance = receiver.distance;
    let seen = radius / distance.max(T::lit(DPSM_SMALLEST));
    let smallest = (T::lit(DPSM_FILTER_SMALLEST) * at.pitch).min(T::lit(DPSM_FILTER_WIDEST));
    let widest = dpsm_pcss_tangent(distance, nearest, radius).max(smallest);
    let search = dpsm_filter_cone(at, widest, seen, rotation);
    let rings = dpsm_kernel_rings(taps.count);
    let found = dpsm_raw_pcss_search(maps, search, light, rings);
    if found.all.iter().all(|lit| *lit) {
        return T::lit(1.0);
    }
    let width = dpsm_pcss_width(found, distance, at.pitch, radius, light);
    let disk = dpsm_filter_cone(at, width, seen, rotation);
    dpsm_raw_sum(maps, disk, light, rings)
}
