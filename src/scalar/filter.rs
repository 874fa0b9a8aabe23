//! Port of `wgsl/filter.wesl`.

use super::bias::{
    DPSM_BIAS_DISTANCE, DpsmReceiver, dpsm_bias_footprint, dpsm_bias_slack, dpsm_bias_window,
    dpsm_receiver_distance,
};
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::hemisphere::dpsm_hemisphere;
use super::kernel::{
    DpsmKernel, DpsmTap, dpsm_kernel_mirrored, dpsm_kernel_projected, dpsm_kernel_ring,
    dpsm_kernel_tap, dpsm_kernel_turn,
};
use super::light::{DPSM_ATLAS, DpsmLight, dpsm_light_coordinates, dpsm_light_layer};
use super::maps::Maps;
use super::paraboloid::{DPSM_SMALLEST, dpsm_project_own, dpsm_texel_width};
use super::visibility::{DpsmLookup, dpsm_lookup};

/// A tap of one texel, compared along the texel's centre.
pub const DPSM_TAP_HARD: u32 = 0;

/// A tap of 2 x 2 texels by a sampler that interpolates.
pub const DPSM_TAP_LINEAR: u32 = 1;

/// A filter's taps, and what the maps' depths may rightly be off by.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmTaps<T> {
    /// Number of taps, at least 1.
    pub count: u32,
    /// DPSM_TAP_HARD or DPSM_TAP_LINEAR, as the sampler does.
    pub kind: u32,
    /// Step of the stored depths, as for dpsm_bias_slack.
    pub quantum: T,
    /// Relative error of the maps' distances, as for dpsm_bias_slack.
    pub tolerance: T,
}

/// A filter's taps with what all of them share: no tap divides by it again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmReader<T> {
    /// The receiver.
    pub receiver: DpsmReceiver<T>,
    /// DPSM_TAP_HARD or DPSM_TAP_LINEAR.
    pub kind: u32,
    /// Texels per unit of the disk, u right and v down.
    pub scale: Vec2<T>,
    /// Units of the disk per texel.
    pub unscale: Vec2<T>,
    /// The map's middle in texels.
    pub middle: T,
    /// Texture coordinates per texel of the map.
    pub texel: T,
    /// Depth of a distance: l times x minus y, in [0, 1], less l times z plus w of slack.
    pub depth: Vec4<T>,
}

/// What dividing by a reciprocal adds to a depth's rounding, 4 eps of each of its terms.
pub const DPSM_FILTER_ROUNDING: f64 = 1.0 / (1u64 << 21) as f64;

/// The reader of a receiver's taps.
pub fn dpsm_filter_reader<T: Float>(
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
) -> DpsmReader<T> {
    let one = T::lit(1.0);
    let rounding = T::lit(DPSM_FILTER_ROUNDING);
    let width = dpsm_texel_width(light.size, light.guard);
    let range = light.far - light.near;
    // dpsm_bias_slack is linear in the distance
    let none = dpsm_bias_slack(T::lit(0.0), light, taps.quantum, taps.tolerance);
    let slope = (taps.tolerance + T::lit(DPSM_BIAS_DISTANCE + DPSM_FILTER_ROUNDING)) / range;
    let down = Vec2::new(one, -one);
    DpsmReader {
        receiver,
        kind: taps.kind,
        scale: down / width,
        unscale: down * width,
        middle: T::lit(0.5) * light.size,
        texel: one / light.size,
        depth: Vec4::new(
            one / range,
            light.near / range,
            slope,
            none + rounding * (light.near / range),
        ),
    }
}

/// Where a tap reads, and the depth that it compares.
pub fn dpsm_filter_lookup<T: Float>(
    reader: DpsmReader<T>,
    tap: DpsmTap<T>,
    light: DpsmLight<T>,
) -> DpsmLookup<T> {
    let middle = Vec2::splat(reader.middle);
    let mut place = tap.uv * reader.scale + middle;
    let mut uv = tap.uv;
    if reader.kind == DPSM_TAP_HARD {
        let last = Vec2::splat(light.size - T::lit(1.0));
        let texel = place.floor();
        let zero = T::lit(0.0);
        place = Vec2::new(texel.x.clamp(zero, last.x), texel.y.clamp(zero, last.y))
            + Vec2::splat(T::lit(0.5));
        uv = (place - middle) * reader.unscale;
    }
    let met = dpsm_receiver_distance(reader.receiver, uv, tap.hemisphere);
    // beyond the plane's horizon what is nearer than the receiver shadows it
    let is_met = met > T::lit(DPSM_SMALLEST);
    let l = select(reader.receiver.distance, met, is_met).min(light.far);
    let mut depth = l * reader.depth.x - reader.depth.y;
    if reader.kind != DPSM_TAP_HARD {
        if is_met {
            let there = DpsmReceiver { distance: l, ..reader.receiver };
            depth = depth - dpsm_bias_footprint(there, uv, T::lit(1.0), light);
        } else {
            // within the window the plane is no nearer than its height over the chord
            let chord = dpsm_bias_window(uv, T::lit(1.0), light).sqrt();
            let plane = reader.receiver.plane.w / chord.max(T::lit(DPSM_SMALLEST));
            depth = depth.min(plane * reader.depth.x - reader.depth.y);
        }
    }
    let inside = depth.clamp(T::lit(0.0), T::lit(1.0));
    DpsmLookup {
        coordinates: dpsm_light_coordinates(light, tap.hemisphere, place * reader.texel),
        depth: inside - (l * reader.depth.z + reader.depth.w),
        layer: dpsm_light_layer(light, tap.hemisphere),
        hemisphere: tap.hemisphere,
        mapped: tap.hemisphere < light.hemispheres,
    }
}

/// One tap: 1 lit, 0 in shadow, between them for a linear one.
pub fn dpsm_filter_tap<T: Float>(
    maps: &impl Maps<T>,
    reader: DpsmReader<T>,
    tap: DpsmTap<T>,
    light: DpsmLight<T>,
) -> T {
    let at = dpsm_filter_lookup(reader, tap, light);
    let lit = maps.compare(at.coordinates, at.layer, at.depth);
    select(T::lit(0.0), lit, at.mapped)
}

/// One tap at the receiver itself.
pub fn dpsm_filter_hardware<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    taps: DpsmTaps<T>,
) -> T {
    let own = DpsmTap { uv: dpsm_project_own(p), hemisphere: dpsm_hemisphere(p) };
    dpsm_filter_tap(maps, dpsm_filter_reader(receiver, light, taps), own, light)
}

/// side x side taps around the receiver's place in its own map, all against one depth.
pub fn dpsm_filter_pcf<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    light: DpsmLight<T>,
    side: u32,
    bias: T,
) -> T {
    let at = dpsm_lookup(p, light);
    let atlas = light.placement == DPSM_ATLAS;
    let extent = select(Vec2::splat(T::lit(1.0)), light.rectangle.zw(), atlas);
    let texel = extent / light.size;
    let middle = T::lit(0.5) * T::lit(side.into()) - T::lit(0.5);
    let mut sum = T::lit(0.0);
    for index in 0..side * side {
        let [x, y] = [index % side, index / side].map(|i| T::lit(i.into()));
        let offset = Vec2::new(x, y) - Vec2::splat(middle);
        let st = at.coordinates + offset * texel;
        sum = sum + maps.compare(st, at.layer, at.depth - bias);
    }
    select(T::lit(0.0), sum / T::lit((side * side).into()), at.mapped)
}

/// The disk that stands for a cone, filled with Vogel's spiral.
pub fn dpsm_filter_disk<T: Float>(
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
        sum = sum + dpsm_filter_tap(maps, reader, tap, light);
        direction = dpsm_kernel_turn(direction);
    }
    sum / T::lit(taps.count.into())
}

/// dpsm_filter_disk with the seam crossed by mirroring, for comparison.
pub fn dpsm_filter_mirror<T: Float>(
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
        sum = sum + dpsm_filter_tap(maps, reader, tap, light);
        direction = dpsm_kernel_turn(direction);
    }
    sum / T::lit(taps.count.into())
}

/// Osman's own form: each tap moved in light space and projected again.
pub fn dpsm_filter_reproject<T: Float>(
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
        sum = sum + dpsm_filter_tap(maps, reader, tap, light);
        direction = dpsm_kernel_turn(direction);
    }
    sum / T::lit(taps.count.into())
}
