//! Port of `wgsl/refine.wesl`.

use super::classify::{DPSM_CLASSIFY_SPREAD, DpsmProjected, dpsm_classify_flat_error};
use super::depth::{dpsm_depth, dpsm_depth_stored};
use super::edge::{DPSM_EDGE_NEAREST, DPSM_EDGE_SNAP, dpsm_edge_ordered};
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::light::DpsmLight;
use super::paraboloid::{DPSM_SMALLEST, dpsm_project, dpsm_texel_width};
use super::triangle::{DPSM_TRIANGLE_CHORD, DpsmHull};

/// The edge from a triangle's first corner to its second, split; bits of a mask.
pub const DPSM_REFINE_FIRST: u32 = 1;

/// The edge from the second corner to the third.
pub const DPSM_REFINE_SECOND: u32 = 2;

/// The edge from the third corner to the first.
pub const DPSM_REFINE_THIRD: u32 = 4;

/// What dpsm_refine_edge gives for an edge inside the triangle.
pub const DPSM_REFINE_INNER: u32 = 6;

/// Height of a plane, as a share of the nearest corner's distance, below which its foot is split at.
pub const DPSM_REFINE_FLUSH: f64 = 0.25;

/// How much of the tolerance of distances what is drawn may be too near.
pub const DPSM_REFINE_NEARER: f64 = 0.125;

/// Most that a slope adds to the tolerance of distances.
pub const DPSM_REFINE_SLOPE: f64 = 1.0 / 32.0;

/// Where an edge is split: where the bisector of the angle between its ends meets it.
pub fn dpsm_refine_point<T: Float>(a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    let ordered = dpsm_edge_ordered(a, b);
    let first = select(b, a, ordered);
    let second = select(a, b, ordered);
    let nearer = first.length();
    let share = nearer / (nearer + second.length()).max(T::lit(DPSM_EDGE_NEAREST));
    first + (second - first) * share
}

/// How far from its arc an edge may be drawn for a tau in texels, in disk units.
pub fn dpsm_refine_reach<T: Float>(light: DpsmLight<T>, tau: T) -> T {
    let texel = dpsm_texel_width(light.size, light.guard);
    (T::lit(0.9375) * tau - T::lit(DPSM_EDGE_SNAP)).max(T::lit(0.0)) * texel
}

/// True where a chord is so long that its edge is split in any case.
pub fn dpsm_refine_long<T: Float>(a: Vec2<T>, b: Vec2<T>) -> bool {
    let chord = b - a;
    chord.dot(chord) > T::lit(DPSM_TRIANGLE_CHORD * DPSM_TRIANGLE_CHORD)
}

/// True where an edge must be split: its chord is long, or its arc lies more than `reach` from it.
pub fn dpsm_refine_splits<T: Float>(
    start: DpsmProjected<T>,
    end: DpsmProjected<T>,
    reach: T,
) -> bool {
    if dpsm_refine_long(start.uv, end.uv) {
        return true;
    }
    let chord = end.uv - start.uv;
    let square = chord.dot(chord);
    // no arc lies farther from its chord than c^2 / 4
    if T::lit(0.25) * square <= reach {
        return false;
    }
    let middle = dpsm_project(dpsm_refine_point(start.p, end.p));
    let arm = middle - select(end.uv, start.uv, dpsm_edge_ordered(start.p, end.p));
    (arm.x * chord.y - arm.y * chord.x).abs() > reach * square.sqrt()
}

/// Corners of a part of a triangle whose edges in `split` are split: 0 to 2 are the triangle's
/// own, 3 to 5 the points that split its first, second and third edge.
pub fn dpsm_refine_corners(split: u32, part: u32, crossed: bool) -> [u32; 3] {
    // turned so that the first edge is split, and of two the second
    let mut turn = 0;
    if split == DPSM_REFINE_SECOND || split == (DPSM_REFINE_SECOND | DPSM_REFINE_THIRD) {
        turn = 1;
    } else if split == DPSM_REFINE_THIRD || split == (DPSM_REFINE_THIRD | DPSM_REFINE_FIRST) {
        turn = 2;
    }
    let corners: [u32; 3] = match ((split & 7).count_ones(), part) {
        (1, 0) => [0, 3, 2],
        (1, _) => [3, 1, 2],
        (2, 1) if crossed => [0, 3, 2],
        (2, 1) => [0, 3, 4],
        (2, 2..) if crossed => [3, 4, 2],
        (2, 2..) => [0, 4, 2],
        (3, 0) => [0, 3, 5],
        (_, 0 | 1) => [3, 1, 4],
        (_, 2) => [5, 4, 2],
        _ => [3, 4, 5],
    };
    corners.map(|corner| dpsm_refine_turned(corner, turn))
}

/// A corner as dpsm_refine_corners gives it, of a triangle whose corners are counted from `turn` on.
pub fn dpsm_refine_turned(corner: u32, turn: u32) -> u32 {
    corner.wrapping_add(turn) % 3 + select(0, 3, corner >= 3)
}

/// What the edge between two corners as dpsm_refine_corners gives them is: 0 to 2, that whole edge
/// of the triangle; 3 to 5, a half of its first, second or third edge; DPSM_REFINE_INNER.
pub fn dpsm_refine_edge(a: u32, b: u32) -> u32 {
    let low = a.min(b);
    let high = a.max(b);
    if high < 3 {
        return select(low, 2, low == 0 && high == 2);
    }
    let edge = (high - 3).min(2);
    let ends = low == edge || low == (edge + 1) % 3;
    select(DPSM_REFINE_INNER, 3 + edge, ends)
}

/// True where the edges that a part of a triangle has inside it may be drawn as chords: they leave
/// the halves of the triangle's own edges at angles that are twice what an arc can turn from its
/// chord.
pub fn dpsm_refine_fat<T: Float>(
    first: DpsmProjected<T>,
    second: DpsmProjected<T>,
    third: DpsmProjected<T>,
    halves: u32,
) -> bool {
    let zero = T::lit(0.0);
    let nearest = T::lit(DPSM_EDGE_NEAREST);
    let [a, b, c] = [first, second, third].map(|at| at.p / at.distance.max(nearest));
    let ab = b - a;
    let bc = c - b;
    let ca = a - c;
    let squares = [ab.dot(ab), bc.dot(bc), ca.dot(ca)];
    let bits = [DPSM_REFINE_FIRST, DPSM_REFINE_SECOND, DPSM_REFINE_THIRD];
    let longest = |wanted: bool| {
        let of = |k: usize| select(zero, squares[k], (halves & bits[k] != 0) == wanted);
        of(0).max(of(1)).max(of(2)).sqrt()
    };
    let [half, inner] = [longest(true), longest(false)];
    // with unit vectors, the sine of a corner's angle on the sphere times those of its sides
    let area = a.dot(ab.cross(ca)).abs();
    let short = squares.iter().all(|square| *square <= T::lit(3.25));
    short && area >= half * inner * half.min(T::lit(DPSM_TRIANGLE_CHORD))
}

/// True where a triangle whose plane passes close to the light has the light's foot inside.
pub fn dpsm_refine_foot<T: Float>(a: Vec3<T>, b: Vec3<T>, c: Vec3<T>, plane: Vec4<T>) -> bool {
    let nearest = a.length().min(b.length()).min(c.length());
    let flush = plane.w.abs() < T::lit(DPSM_REFINE_FLUSH) * nearest;
    if !flush {
        return false;
    }
    let normal = plane.xyz();
    let foot = normal * plane.w;
    let side = |p: Vec3<T>, q: Vec3<T>| normal.dot((q - p).cross(foot - p));
    side(a, b).min(side(b, c)).min(side(c, a)) > T::lit(0.0)
}

/// True where nothing of a triangle of these disk corners, and of what it is refined to, can be
/// drawn in the stored disk or the texel around it.
pub fn dpsm_refine_outside<T: Float>(
    a: Vec2<T>,
    b: Vec2<T>,
    c: Vec2<T>,
    light: DpsmLight<T>,
) -> bool {
    let texel = dpsm_texel_width(light.size, light.guard);
    let border = T::lit(1.0) + light.guard + texel + T::lit(1.0 / 64.0);
    a.dot(a).min(b.dot(b)).min(c.dot(c)) > border * border
}

/// True where the distances of a triangle's corners may be interpolated.
pub fn dpsm_refine_flat<T: Float>(
    hull: DpsmHull<T>,
    distances: Vec3<T>,
    plane: Vec4<T>,
    reach: T,
    depth_tolerance: T,
) -> bool {
    let square = |side: Vec2<T>| side.dot(side);
    let sides = [hull.b - hull.a, hull.c - hull.b, hull.a - hull.c].map(square);
    let square = sides[0].max(sides[1]).max(sides[2]);
    let short = square <= T::lit(DPSM_TRIANGLE_CHORD * DPSM_TRIANGLE_CHORD);
    if !short {
        return false;
    }
    let nearest = distances.x.min(distances.y).min(distances.z).max(T::lit(DPSM_SMALLEST));
    let farthest = distances.x.max(distances.y).max(distances.z);
    let spread = (farthest / nearest - T::lit(1.0)).min(T::lit(DPSM_CLASSIFY_SPREAD));
    let along = reach * spread / square.sqrt().max(T::lit(DPSM_EDGE_NEAREST));
    let error = dpsm_classify_flat_error(hull, distances, plane);
    error.x <= T::lit(DPSM_REFINE_NEARER) * depth_tolerance
        && error.y <= depth_tolerance + along.min(T::lit(DPSM_REFINE_SLOPE))
}

/// The clip-space position at which a vertex is drawn: its disk coordinates scaled to the stored
/// disk, and its stored depth.
pub fn dpsm_refine_clip<T: Float>(uv: Vec2<T>, distance: T, light: DpsmLight<T>) -> Vec4<T> {
    let one = T::lit(1.0);
    let depth = dpsm_depth_stored(dpsm_depth(distance, light.near, light.far), light.reversed);
    let scaled = uv / (one + light.guard);
    Vec4::new(scaled.x, scaled.y, depth, one)
}
