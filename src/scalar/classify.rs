//! Port of `wgsl/classify.wesl`.

use super::edge::{DPSM_EDGE_ROUNDING, DPSM_EDGE_SNAP, dpsm_edge_terms};
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::hemisphere::DPSM_FRONT;
use super::light::DpsmLight;
use super::paraboloid::{DPSM_SMALLEST, dpsm_project, dpsm_texel_width};
use super::triangle::{DPSM_TRIANGLE_CHORD, DpsmHull};

/// Not drawn: outside the clipping spheres, without area, not finite, or between texel centres.
pub const DPSM_CULLED: u32 = 0;

/// Bit of the front hemisphere, whose stored disk a triangle may touch.
pub const DPSM_IN_FRONT: u32 = 1;

/// Bit of the back hemisphere.
pub const DPSM_IN_BACK: u32 = 2;

/// A vertex as a map sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmProjected<T> {
    /// Light space, flipped for the map.
    pub p: Vec3<T>,
    /// Its distance from the light.
    pub distance: T,
    /// Its disk coordinates.
    pub uv: Vec2<T>,
}

/// Largest coordinate of a usable vertex, 2^62.
pub const DPSM_CLASSIFY_LARGEST: f64 = (1u64 << 62) as f64;

/// Slack for the rounding of radii and chords where they are compared with the rim.
pub const DPSM_CLASSIFY_RIM: f64 = 0.9999;

/// Texel centres a side up to which a triangle's are tried one by one.
pub const DPSM_CLASSIFY_CENTRES: f64 = 4.0;

/// Smallest facing of a plane that is told from edge-on.
pub const DPSM_CLASSIFY_FACING: f64 = 1.0 / (1u64 << 60) as f64;

/// Largest spread of distances: its cube is finite, and an error of it is beyond all tolerance.
pub const DPSM_CLASSIFY_SPREAD: f64 = (1u64 << 40) as f64;

/// True where every component is a number up to 2^62.
pub fn dpsm_classify_usable<T: Float>(p: Vec3<T>) -> bool {
    [p.x, p.y, p.z].iter().all(|c| c.abs() <= T::lit(DPSM_CLASSIFY_LARGEST))
}

/// A vertex as a map sees it, from its position in light space, flipped for the map.
pub fn dpsm_projected<T: Float>(p: Vec3<T>) -> DpsmProjected<T> {
    DpsmProjected { p, distance: p.length(), uv: dpsm_project(p) }
}

/// The maps into which a triangle is drawn: DPSM_IN_FRONT, DPSM_IN_BACK, both, or DPSM_CULLED.
pub fn dpsm_classify<T: Float>(
    first: DpsmProjected<T>,
    second: DpsmProjected<T>,
    third: DpsmProjected<T>,
    height: T,
    own: u32,
    light: DpsmLight<T>,
) -> u32 {
    if ![first.p, second.p, third.p].into_iter().all(dpsm_classify_usable) {
        return DPSM_CULLED;
    }
    let farthest = first.distance.max(second.distance).max(third.distance);
    if farthest < light.near {
        return DPSM_CULLED;
    }
    let ab = second.uv - first.uv;
    let bc = third.uv - second.uv;
    let ca = first.uv - third.uv;
    let longest = ab.dot(ab).max(bc.dot(bc)).max(ca.dot(ca));
    let small = longest <= T::lit(DPSM_TRIANGLE_CHORD * DPSM_TRIANGLE_CHORD);
    let outer = first.uv.dot(first.uv).max(second.uv.dot(second.uv)).max(third.uv.dot(third.uv));
    // no point of a small triangle is farther on the disk from a corner than its longest chord
    let reach = (outer.sqrt() + longest.sqrt()) * (T::lit(1.0) + light.guard);
    let both = !small || reach >= T::lit(DPSM_CLASSIFY_RIM);
    // no arc lies farther from its chord than c^2 / 4
    if !both && dpsm_classify_misses(first.uv, second.uv, third.uv, light, T::lit(0.25) * longest) {
        return DPSM_CULLED;
    }
    // a plane that holds the light is seen edge-on; rounding of the height is far below 1/1024
    let away = height.abs();
    let seen = away > T::lit(0.0);
    if !seen || away > light.far + T::lit(1.0 / 1024.0) * farthest {
        return DPSM_CULLED;
    }
    let own_bit = select(DPSM_IN_BACK, DPSM_IN_FRONT, own == DPSM_FRONT);
    select(own_bit, DPSM_IN_FRONT | DPSM_IN_BACK, both)
}

/// Largest relative errors of a plane's distance when it is interpolated between three disk points:
/// how much too near, and how much too far.
pub fn dpsm_classify_flat_error<T: Float>(
    hull: DpsmHull<T>,
    distances: Vec3<T>,
    plane: Vec4<T>,
) -> Vec2<T> {
    let half = T::lit(0.5);
    let ab = dpsm_classify_distance(plane, (hull.a + hull.b) * half);
    let bc = dpsm_classify_distance(plane, (hull.b + hull.c) * half);
    let ca = dpsm_classify_distance(plane, (hull.c + hull.a) * half);
    let next = Vec3::new(distances.y, distances.z, distances.x);
    let errors = (distances + next) * half - Vec3::new(ab, bc, ca);
    let nearest = distances.x.min(distances.y).min(distances.z);
    let farther = distances.x.max(distances.y).max(distances.z) - nearest;
    let unit = nearest.max(T::lit(DPSM_SMALLEST));
    let spread = (farther / unit).min(T::lit(DPSM_CLASSIFY_SPREAD));
    let square = |side: Vec2<T>| side.dot(side);
    let sides = [hull.b - hull.a, hull.c - hull.b, hull.a - hull.c].map(square);
    let longest = sides[0].max(sides[1]).max(sides[2]);
    let unseen = T::lit(0.25) * spread * (longest + spread * spread);
    let low = errors.x.min(errors.y).min(errors.z);
    let high = errors.x.max(errors.y).max(errors.z);
    let zero = Vec2::splat(T::lit(0.0));
    Vec2::new(-low, high).max(zero) * T::lit(1.5) / unit + Vec2::splat(unseen)
}

/// The distance of a plane (unit normal, height) in the direction of uv; below 0 behind.
pub fn dpsm_classify_distance<T: Float>(plane: Vec4<T>, uv: Vec2<T>) -> T {
    let facing = plane.xyz().dot(dpsm_edge_terms(uv).xyz());
    let least = T::lit(DPSM_CLASSIFY_FACING);
    let seen = select(facing, least, facing.abs() < least);
    plane.w * (T::lit(1.0) + uv.dot(uv)) / seen
}

/// True where a triangle of disk corners, and what lies within `bow` of it on the disk, covers no
/// texel centre.
pub fn dpsm_classify_misses<T: Float>(
    a: Vec2<T>,
    b: Vec2<T>,
    c: Vec2<T>,
    light: DpsmLight<T>,
    bow: T,
) -> bool {
    let one = T::lit(1.0);
    let half = T::lit(0.5);
    let ab = b - a;
    let bc = c - b;
    let ca = a - c;
    let texel = dpsm_texel_width(light.size, light.guard);
    let outside = T::lit(DPSM_EDGE_SNAP) * texel + T::lit(DPSM_EDGE_ROUNDING) + bow;
    // texel centres are at whole numbers
    let middle = Vec2::splat(half * light.size - half);
    let around = Vec2::splat(outside);
    let first = ((a.min(b).min(c) - around) / texel + middle).ceil();
    let last = ((a.max(b).max(c) + around) / texel + middle).floor();
    let most = first + Vec2::splat(T::lit(DPSM_CLASSIFY_CENTRES) - one);
    let few = last.x <= most.x && last.y <= most.y;
    if !few {
        return false;
    }
    // an edge's distance times its length is at most what the length's bound, |x| + |y|, allows
    let limit = |edge: Vec2<T>| -outside * (edge.x.abs() + edge.y.abs());
    let limits = [limit(ab), limit(bc), limit(ca)];
    // counted, so that it ends where steps of 1 round away
    for i in 0..DPSM_CLASSIFY_CENTRES as u32 {
        for j in 0..DPSM_CLASSIFY_CENTRES as u32 {
            let centre = first + Vec2::new(T::lit(f64::from(j)), T::lit(f64::from(i)));
            if centre.x > last.x || centre.y > last.y {
                break;
            }
            let p = (centre - middle) * texel;
            let pa = p - a;
            let pb = p - b;
            let pc = p - c;
            let sides =
                [ab.x * pa.y - ab.y * pa.x, bc.x * pb.y - bc.y * pb.x, ca.x * pc.y - ca.y * pc.x];
            let each = || sides.into_iter().zip(limits);
            if each().all(|(side, limit)| side >= limit) || each().all(|(s, limit)| -s >= limit) {
                return false;
            }
        }
    }
    true
}
