//! Port of `wgsl/filter.wesl`.

use super::bias::{
    DPSM_BIAS_DISTANCE, DpsmReceiver, dpsm_bias_footprint, dpsm_bias_slack, dpsm_bias_window,
    dpsm_receiver_distance,
};
use super::depth::dpsm_depth_stored;
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::hemisphere::{DPSM_BACK, dpsm_hemisphere};
use super::kernel::{
    DpsmKernel, DpsmTap, dpsm_kernel_mirrored, dpsm_kernel_next, dpsm_kernel_projected,
    dpsm_kernel_ring, dpsm_kernel_rings, dpsm_kernel_turn,
};
use super::light::{DPSM_ATLAS, DpsmLight, dpsm_light_coordinates, dpsm_light_layer};
use super::maps::Maps;
use super::paraboloid::{DPSM_SMALLEST, dpsm_project_own, dpsm_texel_width};
use super::plane::{DpsmPlane, dpsm_plane};
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
            let plane = reader.receiver.plane.w / (chord + reader.receiver.rounding);
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
    let reference = dpsm_depth_stored(at.depth, light.reversed);
    let lit = maps.compare(at.coordinates, at.layer, reference);
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
    let reference = dpsm_depth_stored(at.depth - bias, light.reversed);
    let mut sum = T::lit(0.0);
    for index in 0..side * side {
        let [x, y] = [index % side, index / side].map(|i| T::lit(i.into()));
        let offset = Vec2::new(x, y) - Vec2::splat(middle);
        let st = at.coordinates + offset * texel;
        sum = sum + maps.compare(st, at.layer, reference);
    }
    select(T::lit(0.0), sum / T::lit((side * side).into()), at.mapped)
}

/// How far along its normal a receiver is moved for a kernel, in texels times the sine.
pub const DPSM_FILTER_SHIFT: f64 = 0.45;

/// How much nearer than the plane, in texels, is still lit.
pub const DPSM_FILTER_OWN: f64 = 0.5;

/// What a receiver at grazing incidence is to be moved by in addition, in texels.
pub const DPSM_FILTER_GRAZING: f64 = 0.258;

/// The smallest kernel's half-angle in texels: half a texel's diagonal, rounded up.
pub const DPSM_FILTER_SMALLEST: f64 = 0x16a09e8 as f64 / (1u64 << 25) as f64;

/// The bias cone's least half-angle, as its tangent.
pub const DPSM_FILTER_CONE: f64 = 0.1;

/// The bias cone's half-angle in those of the light, where that is more.
pub const DPSM_FILTER_WIDER: f64 = 1.3333334;

/// Largest tangent of a kernel, 45 degrees.
pub const DPSM_FILTER_WIDEST: f64 = 1.0;

/// What one tap in shadow adds to a sum in which a lit one adds 1.
pub const DPSM_FILTER_DARK: f64 = 1024.0;

/// What all taps of a kernel share: where they read, and what they compare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmDisk<T> {
    /// The receiver's place.
    pub place: Vec2<T>,
    /// What the place gains by x; by y it gains (y, -x) of that.
    pub right: Vec2<T>,
    /// The receiver's hemisphere.
    pub hemisphere: u32,
    /// n . d of the receiver's plane at the receiver, with all that it may be too small by.
    pub facing: T,
    /// What that gains by x and y.
    pub lean: Vec2<T>,
    /// What it may gain by x^2 + y^2.
    pub rest: T,
    /// The plane's height.
    pub height: T,
    /// The receiver's distance.
    pub distance: T,
    /// What a stored depth lacks to be a distance in their units.
    pub near: T,
    /// How much nearer than the receiver a blocker must be for each unit of the tap's radius.
    pub steep: T,
    /// How far from the receiver's direction any blocker counts, in the kernel's radii.
    pub least: T,
}

/// The disk of a kernel around a receiver.
pub fn dpsm_filter_cone<T: Float>(
    at: DpsmPlane<T>,
    tangent: T,
    light_tangent: T,
    rotation: Vec2<T>,
) -> DpsmDisk<T> {
    let [quarter, half, one] = [0.25, 0.5, 1.0].map(T::lit);
    let square = at.uv.dot(at.uv);
    let r = square.sqrt();
    let radius = tangent * (half + half * square);
    let across = rotation * radius;
    let aside = Vec2::new(-rotation.y, rotation.x);
    let sine = at.lean.length();
    // the nearest texel's centre lies up to half a diagonal away
    let texel = T::lit(DPSM_FILTER_SMALLEST) * at.pitch;
    let [own, grazing] = [DPSM_FILTER_OWN, DPSM_FILTER_GRAZING].map(T::lit);
    let rise = (own * at.cosine).max(grazing * sine) + texel * sine;
    // the lean is to first order in the disk; this bounds the rest (docs/filter.md)
    let reach = tangent + texel;
    let within = one / (one - half * (r * reach).min(one));
    let curved = reach * reach * (half * r + quarter * reach) * (within * within * within);
    let cone = (T::lit(DPSM_FILTER_WIDER) * light_tangent).max(T::lit(DPSM_FILTER_CONE));
    DpsmDisk {
        place: Vec2::new(at.uv.x, -at.uv.y),
        right: Vec2::new(across.x, -across.y),
        hemisphere: at.hemisphere,
        facing: at.facing + rise * at.pitch,
        lean: Vec2::new(at.lean.dot(rotation), at.lean.dot(aside)) * tangent,
        rest: sine * curved,
        height: at.height,
        distance: at.distance,
        near: at.near,
        steep: tangent / cone,
        least: texel / tangent,
    }
}

/// A map in its texture: the coordinates of its middle, and what one unit of the disk is there.
pub fn dpsm_filter_map<T: Float>(light: DpsmLight<T>, hemisphere: u32) -> Vec4<T> {
    let (half, one) = (T::lit(0.5), T::lit(1.0));
    let middle = dpsm_light_coordinates(light, hemisphere, Vec2::splat(half));
    let atlas = light.placement == DPSM_ATLAS;
    let extent =
        select(Vec2::splat(one), light.rectangle.zw(), atlas) * (half / (one + light.guard));
    Vec4::new(middle.x, middle.y, extent.x, extent.y)
}

/// Where four taps of a disk read: texture coordinates, and in which map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmFour<T> {
    /// Texture coordinates along x.
    pub s: Vec4<T>,
    /// Texture coordinates along y.
    pub t: Vec4<T>,
    /// Which lie beyond the rim, and read the other hemisphere's map.
    pub crossed: [bool; 4],
}

/// Where four taps read: those beyond the rim continue in the other map.
pub fn dpsm_filter_places<T: Float>(
    disk: DpsmDisk<T>,
    own: Vec4<T>,
    other: T,
    offset: Vec2<T>,
) -> DpsmFour<T> {
    let one = T::lit(1.0);
    let step = dpsm_filter_step(disk, offset);
    let u = [step.x, step.y, -step.x, -step.y].map(|step| disk.place.x + step);
    let v = [step.y, -step.x, -step.y, step.x].map(|step| disk.place.y + step);
    let far: [T; 4] = std::array::from_fn(|i| u[i] * u[i] + v[i] * v[i]);
    let inward = far.map(|far| one / far.max(one));
    let crossed = far.map(|far| far > one);
    let s = |i: usize| select(own.x, other, crossed[i]) + u[i] * inward[i] * own.z;
    DpsmFour {
        s: Vec4::from_array(std::array::from_fn(s)),
        t: Vec4::from_array(std::array::from_fn(|i| own.y + v[i] * inward[i] * own.w)),
        crossed,
    }
}

/// How far a tap's place is from the receiver's.
pub fn dpsm_filter_step<T: Float>(disk: DpsmDisk<T>, offset: Vec2<T>) -> Vec2<T> {
    Vec2::new(
        disk.right.x * offset.x + disk.right.y * offset.y,
        disk.right.y * offset.x - disk.right.x * offset.y,
    )
}

/// What a tap that lies where a hemispherical light has no map reads: nearer than all.
pub const DPSM_FILTER_UNMAPPED: f64 = -1.0;

/// The layers of a receiver's own map and of the other one.
pub fn dpsm_filter_layers<T: Float>(light: DpsmLight<T>, hemisphere: u32) -> [u32; 2] {
    let other = DPSM_BACK.wrapping_sub(hemisphere);
    [dpsm_light_layer(light, hemisphere), dpsm_light_layer(light, other)]
}

/// The depths that four taps read.
pub fn dpsm_filter_read<T: Float>(
    maps: &impl Maps<T>,
    at: DpsmFour<T>,
    layers: [u32; 2],
    mapped: [bool; 2],
    reversed: u32,
) -> Vec4<T> {
    let (s, t) = (at.s.to_array(), at.t.to_array());
    let read = |i: usize| {
        let map = usize::from(at.crossed[i]);
        let stored = maps.sample(Vec2::new(s[i], t[i]), layers[map]);
        let depth = dpsm_depth_stored(stored, reversed);
        select(T::lit(DPSM_FILTER_UNMAPPED), depth, mapped[map])
    };
    Vec4::from_array(std::array::from_fn(read))
}

/// Which of four taps are lit: no nearer than the receiver's plane.
pub fn dpsm_filter_lit<T: Float>(
    disk: DpsmDisk<T>,
    offset: Vec2<T>,
    ring: T,
    reach: Vec4<T>,
) -> [bool; 4] {
    let along = disk.lean.x * offset.x + disk.lean.y * offset.y;
    let aside = disk.lean.y * offset.x - disk.lean.x * offset.y;
    let middle = disk.facing + disk.rest * ring;
    let facing = [along, aside, -along, -aside].map(|gained| middle + gained);
    let reach = reach.to_array();
    std::array::from_fn(|i| reach[i] * facing[i] >= disk.height)
}

/// Which of four taps lie within the bias cone.
pub fn dpsm_filter_within<T: Float>(disk: DpsmDisk<T>, ring: T, reach: Vec4<T>) -> [bool; 4] {
    let grown = T::lit(1.0) + disk.steep * ring;
    reach.to_array().map(|reach| reach * grown < disk.distance)
}

/// The share of the light by the sum of what taps say: of those that say anything.
pub fn dpsm_filter_share<T: Float>(sum: Vec4<T>) -> T {
    let all = sum.dot(Vec4::splat(T::lit(1.0)));
    let dark = (all / T::lit(DPSM_FILTER_DARK)).floor();
    let lit = all - T::lit(DPSM_FILTER_DARK) * dark;
    lit / (lit + dark).max(T::lit(1.0))
}

/// What four taps of a kernel say, to be summed.
pub fn dpsm_filter_even<T: Float>(
    disk: DpsmDisk<T>,
    offset: Vec2<T>,
    ring: T,
    stored: Vec4<T>,
) -> Vec4<T> {
    let reach = stored + Vec4::splat(disk.near);
    let lit = dpsm_filter_lit(disk, offset, ring, reach);
    let dark = dpsm_filter_within(disk, ring, reach);
    let [none, one, shadow] = [0.0, 1.0, DPSM_FILTER_DARK].map(T::lit);
    let says = |i: usize| select(select(none, shadow, dark[i]), one, lit[i]);
    Vec4::from_array(std::array::from_fn(says))
}

/// The share of the light over a disk that is filled evenly.
pub fn dpsm_filter_sum<T: Float>(
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
        let stored = dpsm_filter_read(maps, four, layers, mapped, light.reversed);
        sum = sum + dpsm_filter_even(disk, offset, ring, stored);
        direction = dpsm_kernel_next(direction);
        share = share + per;
    }
    dpsm_filter_share(sum)
}

/// The radius of a ring by the share of those farther in, and by its square.
pub const DPSM_FILTER_DENSE: [f64; 2] = [0.68, 0.32];

/// The radius of a ring of taps that lie the denser the nearer they are to the middle.
pub fn dpsm_filter_dense<T: Float>(share: T) -> T {
    let [first, second] = DPSM_FILTER_DENSE.map(T::lit);
    share * (first + second * share)
}

/// What a kernel of fixed size has found so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmContact<T> {
    /// The sum of what its taps say.
    pub sum: Vec4<T>,
    /// The distance of the blocker that is farthest from the light, 0 before there is one.
    pub farthest: T,
}

/// What was found so far, and a ring more: nothing beyond what the farthest blocker asks for.
pub fn dpsm_filter_contact<T: Float>(
    found: DpsmContact<T>,
    disk: DpsmDisk<T>,
    offset: Vec2<T>,
    ring: T,
    stored: Vec4<T>,
) -> DpsmContact<T> {
    let [none, one, shadow] = [0.0, 1.0, DPSM_FILTER_DARK].map(T::lit);
    let reach = stored + Vec4::splat(disk.near);
    let lit = dpsm_filter_lit(disk, offset, ring, reach);
    let dark = dpsm_filter_within(disk, ring, reach);
    let each = reach.to_array();
    let [a, b, c, d] =
        std::array::from_fn(|i| select(select(none, each[i], dark[i]), none, lit[i]));
    let farthest = found.farthest.max(a.max(b).max(c.max(d)));
    // ring <= distance / farthest - 1 + least
    let counted = farthest * (one + ring - disk.least) <= disk.distance;
    let says = |i: usize| select(select(none, shadow, dark[i]), one, lit[i]);
    let said = Vec4::from_array(std::array::from_fn(says));
    DpsmContact { sum: found.sum + select(Vec4::splat(none), said, counted), farthest }
}

/// The share of a spherical light that a receiver sees under the given tangent, by one loop.
pub fn dpsm_filter_disk<T: Float>(
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
        let stored = dpsm_filter_read(maps, four, layers, mapped, light.reversed);
        found = dpsm_filter_contact(found, disk, offset, ring, stored);
        direction = dpsm_kernel_next(direction);
        share = share + per;
    }
    dpsm_filter_share(found.sum)
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
