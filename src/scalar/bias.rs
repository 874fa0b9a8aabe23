//! Port of `wgsl/bias.wesl`.

use super::depth::{dpsm_depth, dpsm_depth_stored};
use super::edge::dpsm_edge_terms;
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::hemisphere::dpsm_flip;
use super::light::{DpsmLight, dpsm_light_coordinates};
use super::maps::Maps;
use super::paraboloid::{
    DPSM_SMALLEST, dpsm_disk_to_texture, dpsm_project_own, dpsm_texel_width, dpsm_texture_to_disk,
};
use super::visibility::{DpsmLookup, dpsm_lookup};

/// A receiver: its plane and its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmReceiver<T> {
    /// Unit normal in light space, not flipped, turned so that the height is not below 0, and the
    /// height normal . p.
    pub plane: Vec4<T>,
    /// |p|.
    pub distance: T,
    /// How far rounding may have moved the plane, as a share of the distance: DPSM_RECEIVER_ROUNDING
    /// and what the world position's own adds.
    pub rounding: T,
}

/// How far rounding may turn and move a receiver's plane and a caster's against each other, 64 eps.
pub const DPSM_RECEIVER_ROUNDING: f64 = 1.0 / (1u64 << 17) as f64;

/// How far rounding may move a world position that vertices interpolate, for each unit of its largest
/// coordinate: 8 eps.
pub const DPSM_POSITION_ROUNDING: f64 = 1.0 / (1u64 << 20) as f64;

/// What rounding adds to a receiver's and a stored depth for each unit of distance, 24 eps.
pub const DPSM_BIAS_DISTANCE: f64 = 24.0 / (1u64 << 23) as f64;

/// The same for each unit of near, 10 eps.
pub const DPSM_BIAS_NEAR: f64 = 10.0 / (1u64 << 23) as f64;

/// A square's half-diagonal over half its side, sqrt(2), rounded up.
pub const DPSM_BIAS_DIAGONAL: f64 = 0x16a09e8 as f64 / (1u64 << 24) as f64;

/// The square of the shortest normal that is one: 2^-100.
pub const DPSM_BIAS_NORMAL: f64 = 1.0 / (1u128 << 100) as f64;

/// How far a surface point that vertices interpolate may lie off its triangle, in world units, for
/// its world position.
pub fn dpsm_position_error<T: Float>(world: Vec3<T>) -> T {
    T::lit(DPSM_POSITION_ROUNDING) * world.x.abs().max(world.y.abs()).max(world.z.abs())
}

/// The receiver at a light-space point with a normal of any length, of either side.
pub fn dpsm_receiver<T: Float>(p: Vec3<T>, normal: Vec3<T>, error: T) -> DpsmReceiver<T> {
    let distance = p.length();
    let square = normal.dot(normal);
    let known = square >= T::lit(DPSM_BIAS_NORMAL);
    let along = select(p, normal, known);
    let size = select(distance.max(T::lit(DPSM_SMALLEST)), square.sqrt(), known);
    let unit = along * (T::lit(1.0) / size);
    let height = select(distance, unit.dot(p), known);
    let turned = select(unit, -unit, height < T::lit(0.0));
    let moved = (error / distance.max(T::lit(DPSM_SMALLEST))).min(T::lit(1.0));
    let rounding = T::lit(DPSM_RECEIVER_ROUNDING) + moved;
    DpsmReceiver { plane: turned.extend(height.abs()), distance, rounding }
}

/// The cosine of a receiver's incidence.
pub fn dpsm_receiver_cosine<T: Float>(receiver: DpsmReceiver<T>) -> T {
    (receiver.plane.w / receiver.distance.max(T::lit(DPSM_SMALLEST))).min(T::lit(1.0))
}

/// The distance of the receiver's plane in the direction of a hemisphere's disk point: the least
/// that rounding allows, and DPSM_SMALLEST where the direction does not meet the plane.
pub fn dpsm_receiver_distance<T: Float>(
    receiver: DpsmReceiver<T>,
    uv: Vec2<T>,
    hemisphere: u32,
) -> T {
    let d = dpsm_flip(dpsm_edge_terms(uv).xyz(), hemisphere);
    let whole = T::lit(1.0) + uv.dot(uv);
    let facing = receiver.plane.xyz().dot(d);
    if facing <= T::lit(0.0) {
        return T::lit(DPSM_SMALLEST);
    }
    let leaned = facing + receiver.rounding * whole;
    (receiver.plane.w * (whole / leaned)).max(T::lit(DPSM_SMALLEST))
}

/// What is left of the bias where the same direction is compared, in units of depth.
pub fn dpsm_bias_slack<T: Float>(distance: T, light: DpsmLight<T>, quantum: T, tolerance: T) -> T {
    let spread =
        (tolerance + T::lit(DPSM_BIAS_DISTANCE)) * distance + T::lit(DPSM_BIAS_NEAR) * light.near;
    quantum + spread / (light.far - light.near)
}

/// The square of the chord on the unit sphere from a disk point to the farthest corner of the
/// square window around it, at most 2.
pub fn dpsm_bias_window<T: Float>(uv: Vec2<T>, texels: T, light: DpsmLight<T>) -> T {
    let one = T::lit(1.0);
    let side = texels * dpsm_texel_width(light.size, light.guard);
    let r = uv.length();
    let inner = (r - side * T::lit(DPSM_BIAS_DIAGONAL)).max(T::lit(0.0));
    // 4 d^2 / ((1 + r^2) (1 + r'^2)) for disk points d apart, here d^2 = 2 side^2
    let chord = T::lit(8.0) * (side * side / ((one + uv.dot(uv)) * (one + inner * inner)));
    chord.min(T::lit(2.0))
}

/// How much nearer than a receiver its plane may be within a chord of its direction, in units of
/// depth, for the cosine of its incidence.
pub fn dpsm_bias_plane<T: Float>(
    cosine: T,
    distance: T,
    chord_square: T,
    rounding: T,
    light: DpsmLight<T>,
) -> T {
    let one = T::lit(1.0);
    let sine = ((one - cosine) * (one + cosine)).sqrt();
    let fall = T::lit(0.5) * chord_square;
    let turn = (chord_square * (one - T::lit(0.25) * chord_square)).sqrt();
    // cos(a - psi) - cos a; the plane's nearest point, at a = 0, if it is within the window
    let steeper = (sine * turn - cosine * fall).max(T::lit(0.0));
    let drop = select(steeper, one - cosine, cosine >= one - fall) + rounding;
    distance * (drop / (cosine + drop)) / (light.far - light.near)
}

/// The footprint bias in units of depth: how much nearer than the receiver its plane may be at the
/// texel centres within a square window.
pub fn dpsm_bias_footprint<T: Float>(
    receiver: DpsmReceiver<T>,
    uv: Vec2<T>,
    texels: T,
    light: DpsmLight<T>,
) -> T {
    let chord_square = dpsm_bias_window(uv, texels, light);
    let cosine = dpsm_receiver_cosine(receiver);
    dpsm_bias_plane(cosine, receiver.distance, chord_square, receiver.rounding, light)
}

/// The centre, on the disk, of the texel that holds a disk point.
pub fn dpsm_texel_centre<T: Float>(uv: Vec2<T>, light: DpsmLight<T>) -> Vec2<T> {
    let st = dpsm_disk_to_texture(uv, light.guard);
    let last = Vec2::splat(light.size - T::lit(1.0));
    let texel = (st * light.size).floor().max(Vec2::splat(T::lit(0.0))).min(last);
    dpsm_texture_to_disk((texel + Vec2::splat(T::lit(0.5))) / light.size, light.guard)
}

/// Where a receiver looks, and the depth that it compares, less all bias, along the centre of its
/// texel: that of its plane there.
pub fn dpsm_lookup_texel_centre<T: Float>(
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    quantum: T,
    tolerance: T,
) -> DpsmLookup<T> {
    let at = dpsm_lookup(p, light);
    let centre = dpsm_texel_centre(dpsm_project_own(p), light);
    let st = dpsm_disk_to_texture(centre, light.guard);
    let there = dpsm_receiver_distance(receiver, centre, at.hemisphere);
    // beyond the plane's horizon only what is nearer than the receiver can shadow it
    let met = there > T::lit(DPSM_SMALLEST);
    let compared = select(receiver.distance, there.min(light.far), met);
    let depth = dpsm_depth(compared, light.near, light.far).clamp(T::lit(0.0), T::lit(1.0));
    DpsmLookup {
        coordinates: dpsm_light_coordinates(light, at.hemisphere, st),
        depth: depth - dpsm_bias_slack(compared, light, quantum, tolerance),
        ..at
    }
}

/// Where a receiver looks, and the depth that it compares, less a window's bias and the slack.
pub fn dpsm_lookup_biased<T: Float>(
    p: Vec3<T>,
    window: T,
    light: DpsmLight<T>,
    quantum: T,
    tolerance: T,
) -> DpsmLookup<T> {
    let l = p.length();
    let depth = dpsm_depth(l, light.near, light.far) - window;
    let depth = depth.clamp(T::lit(0.0), T::lit(1.0));
    let slack = dpsm_bias_slack(l, light, quantum, tolerance);
    DpsmLookup { depth: depth - slack, ..dpsm_lookup(p, light) }
}

/// The shadow test along the centre of the receiver's texel: 1 lit, 0 in shadow.
pub fn dpsm_visibility_texel_centre<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    quantum: T,
    tolerance: T,
) -> T {
    let at = dpsm_lookup_texel_centre(p, receiver, light, quantum, tolerance);
    let reference = dpsm_depth_stored(at.depth, light.reversed);
    let lit = maps.compare(at.coordinates, at.layer, reference);
    select(T::lit(0.0), lit, at.mapped)
}

/// The shadow test less the footprint bias of a window: 1 lit, 0 in shadow.
pub fn dpsm_visibility_footprint<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    texels: T,
    quantum: T,
    tolerance: T,
) -> T {
    let window = dpsm_bias_footprint(receiver, dpsm_project_own(p), texels, light);
    let at = dpsm_lookup_biased(p, window, light, quantum, tolerance);
    let reference = dpsm_depth_stored(at.depth, light.reversed);
    let lit = maps.compare(at.coordinates, at.layer, reference);
    select(T::lit(0.0), lit, at.mapped)
}
