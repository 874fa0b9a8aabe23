//! Port of `wgsl/triangle.wesl`.

use super::caster::DpsmCasterFragment;
use super::depth::{dpsm_depth, dpsm_depth_stored, dpsm_within};
use super::edge::{
    DPSM_EDGE_NEAREST, DPSM_EDGE_ROUNDING, dpsm_edge_largest, dpsm_edge_line, dpsm_edge_normal,
    dpsm_edge_sagitta, dpsm_edge_terms, dpsm_edge_unit,
};
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::light::DpsmLight;
use super::paraboloid::{dpsm_project, dpsm_texel_width};

/// What the fragment stage needs of a triangle; the same for all of its fragments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmTriangle<T> {
    /// Edge from the first to the second vertex, inside on its left.
    pub first: Vec4<T>,
    /// Edge from the second to the third.
    pub second: Vec4<T>,
    /// Edge from the third to the first.
    pub third: Vec4<T>,
    /// Normal times largest distance over height, and the largest distance of a vertex.
    pub face: Vec4<T>,
    /// Its extent along its longest chord.
    pub span: Vec3<T>,
}

/// Smallest height that is told from 0, as a share of the largest distance.
pub const DPSM_TRIANGLE_HEIGHT: f64 = 1.0 / (1u64 << 60) as f64;

/// Largest chord on the disk of a triangle, or a part of one, that one hull surrounds.
pub const DPSM_TRIANGLE_CHORD: f64 = 0.25;

/// Smallest sine of a hull's angles.
pub const DPSM_TRIANGLE_SINE: f64 = 1.0 / 64.0;

/// How far a hull lies outside its triangle, in texels.
pub const DPSM_TRIANGLE_MARGIN: f64 = 1.0 / 32.0;

/// Unit normal and height, below 0 where the triangle turns clockwise as seen from the light.
pub fn dpsm_triangle_plane<T: Float>(a: Vec3<T>, b: Vec3<T>, c: Vec3<T>) -> Vec4<T> {
    // the two shorter edges span the plane best
    let ab = b - a;
    let bc = c - b;
    let ca = a - c;
    let squares = Vec3::new(ab.dot(ab), bc.dot(bc), ca.dot(ca));
    let mut normal = ab.cross(bc);
    if squares.x >= squares.y && squares.x >= squares.z {
        normal = bc.cross(ca);
    } else if squares.y >= squares.z {
        normal = ca.cross(ab);
    }
    let unit = dpsm_edge_unit(normal);
    // from the nearest vertex, whose product is rounded least
    let lengths = Vec3::new(a.dot(a), b.dot(b), c.dot(c));
    let mut nearest = a;
    if lengths.y < lengths.x {
        nearest = b;
    }
    if lengths.z < lengths.x.min(lengths.y) {
        nearest = c;
    }
    unit.extend(unit.dot(nearest))
}

/// A triangle's plane as its fragments need it: the normal, turned away from the light, times the
/// largest distance of a vertex over the height, and that distance.
pub fn dpsm_triangle_face<T: Float>(plane: Vec4<T>, farthest: T) -> Vec4<T> {
    // 2^-120: below every share within the domain; all vertices may be at the light
    let least = T::lit(1.0 / (1u128 << 120) as f64);
    let height = plane.w.abs().max(farthest * T::lit(DPSM_TRIANGLE_HEIGHT)).max(least);
    let outward = select(plane.xyz(), -plane.xyz(), plane.w < T::lit(0.0));
    (outward * (farthest / height)).extend(farthest)
}

/// Prepares a triangle for its fragments.
pub fn dpsm_triangle<T: Float>(
    a: Vec3<T>,
    b: Vec3<T>,
    c: Vec3<T>,
    light: DpsmLight<T>,
) -> DpsmTriangle<T> {
    let plane = dpsm_triangle_plane(a, b, c);
    let turned = plane.w < T::lit(0.0);
    let second = select(b, c, turned);
    let third = select(c, b, turned);
    let farthest = a.length().max(b.length()).max(c.length());
    DpsmTriangle {
        first: dpsm_edge_line(a, second),
        second: dpsm_edge_line(second, third),
        third: dpsm_edge_line(third, a),
        face: dpsm_triangle_face(plane, farthest),
        span: dpsm_triangle_span(a, b, c, light),
    }
}

/// The extent of a triangle along its longest chord: a disk point is between the ends where
/// |span . (u, v, 1)| <= 1.
pub fn dpsm_triangle_span<T: Float>(
    a: Vec3<T>,
    b: Vec3<T>,
    c: Vec3<T>,
    light: DpsmLight<T>,
) -> Vec3<T> {
    let half = T::lit(0.5);
    let disk_a = dpsm_project(a);
    let disk_b = dpsm_project(b);
    let disk_c = dpsm_project(c);
    let ab = disk_b - disk_a;
    let bc = disk_c - disk_b;
    let ca = disk_a - disk_c;
    let squares = Vec3::new(ab.dot(ab), bc.dot(bc), ca.dot(ca));
    let longest = squares.x.max(squares.y).max(squares.z);
    let small = longest <= T::lit(DPSM_TRIANGLE_CHORD * DPSM_TRIANGLE_CHORD);
    if !small {
        return Vec3::splat(T::lit(0.0));
    }
    let mut start = disk_a;
    let mut along = ab;
    if squares.y == longest {
        start = disk_b;
        along = bc;
    } else if squares.z == longest {
        start = disk_c;
        along = ca;
    }
    let size = longest.sqrt();
    let margin = T::lit(DPSM_TRIANGLE_MARGIN) * dpsm_texel_width(light.size, light.guard);
    let reach = half * size + (margin + T::lit(DPSM_EDGE_ROUNDING));
    let smallest = T::lit(1.0 / (1u64 << 60) as f64);
    let scaled = along / (size.max(smallest) * reach);
    Vec3::new(scaled.x, scaled.y, -scaled.dot(start + along * half))
}

/// How far a disk point is inside the nearest of the three edges.
pub fn dpsm_triangle_inside<T: Float>(triangle: DpsmTriangle<T>, uv: Vec2<T>) -> T {
    let terms = dpsm_edge_terms(uv);
    let low = triangle.first.dot(terms).min(triangle.second.dot(terms));
    low.min(triangle.third.dot(terms))
}

/// True where a disk point is inside the three edges, an edge itself included, or within rounding
/// of two of them.
pub fn dpsm_triangle_covers<T: Float>(triangle: DpsmTriangle<T>, uv: Vec2<T>) -> bool {
    let terms = dpsm_edge_terms(uv);
    let first = triangle.first.dot(terms);
    let second = triangle.second.dot(terms);
    let third = triangle.third.dot(terms);
    let low = first.min(second);
    let high = first.max(second);
    let lowest = low.min(third);
    let middle = low.max(high.min(third));
    let rounding = T::lit(DPSM_EDGE_ROUNDING);
    let inside = lowest >= T::lit(0.0) || (lowest >= -rounding && middle <= rounding);
    let one = T::lit(1.0);
    inside && triangle.span.dot(Vec3::new(uv.x, uv.y, one)).abs() <= one
}

/// Radial distance of the triangle's plane in the direction of uv, at most that of its farthest
/// vertex.
pub fn dpsm_triangle_distance<T: Float>(face: Vec4<T>, uv: Vec2<T>) -> T {
    let terms = dpsm_edge_terms(uv);
    let whole = T::lit(1.0) + uv.dot(uv);
    face.w * whole / face.xyz().dot(terms.xyz()).max(whole)
}

/// The disk coordinates of a fragment's position in a map whose middle is at `middle` texels.
pub fn dpsm_triangle_disk<T: Float>(position: Vec2<T>, middle: Vec2<T>, texel: T) -> Vec2<T> {
    (position - middle) * Vec2::new(texel, -texel)
}

/// A distance on a triangle's plane where rounding alone has it cover a point outside: behind what
/// rounding may have brought it forward.
pub fn dpsm_triangle_behind<T: Float>(triangle: DpsmTriangle<T>, l: T) -> T {
    let farthest = triangle.face.w.max(T::lit(DPSM_EDGE_NEAREST));
    let steepness = l * triangle.face.xyz().length() / farthest;
    let share = T::lit(1.0) - T::lit(2.0 * DPSM_EDGE_ROUNDING) * steepness;
    (l / share.max(T::lit(DPSM_EDGE_NEAREST))).min(triangle.face.w)
}

/// The fragment of a prepared triangle at uv: its depth, and whether it is kept.
pub fn dpsm_triangle_fragment<T: Float>(
    triangle: DpsmTriangle<T>,
    uv: Vec2<T>,
    light: DpsmLight<T>,
    bias: T,
) -> DpsmCasterFragment<T> {
    let one = T::lit(1.0);
    let mut l = dpsm_triangle_distance(triangle.face, uv);
    if dpsm_triangle_inside(triangle, uv) < T::lit(0.0) {
        l = dpsm_triangle_behind(triangle, l);
    }
    let stored = uv.dot(uv) <= (one + light.guard) * (one + light.guard);
    let keep = stored && dpsm_triangle_covers(triangle, uv);
    let depth = dpsm_depth_stored(dpsm_depth(l, light.near, light.far) + bias, light.reversed);
    DpsmCasterFragment { depth, keep: keep && dpsm_within(l, light.near, light.far) }
}

/// Barycentric weights of the vertices where the direction of uv meets the triangle's plane.
pub fn dpsm_triangle_weights<T: Float>(a: Vec3<T>, b: Vec3<T>, c: Vec3<T>, uv: Vec2<T>) -> Vec3<T> {
    let d = dpsm_edge_terms(uv).xyz();
    let volumes = Vec3::new(b.cross(c - b).dot(d), c.cross(a - c).dot(d), a.cross(b - a).dot(d));
    let sum = volumes.x + volumes.y + volumes.z;
    if sum.abs() < T::lit(1.0 / (1u128 << 120) as f64) {
        return Vec3::new(T::lit(1.0), T::lit(0.0), T::lit(0.0));
    }
    volumes / sum
}

/// A triangle on the disk that surrounds another one, for the rasterizer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmHull<T> {
    /// First corner.
    pub a: Vec2<T>,
    /// Second corner.
    pub b: Vec2<T>,
    /// Third corner.
    pub c: Vec2<T>,
}

/// The hull of a triangle: three lines, each parallel to a chord and tangent to its arc where the
/// arc lies outside, with a margin for the rasterizer.
pub fn dpsm_triangle_hull<T: Float>(
    a: Vec3<T>,
    b: Vec3<T>,
    c: Vec3<T>,
    light: DpsmLight<T>,
) -> DpsmHull<T> {
    let (zero, one) = (T::lit(0.0), T::lit(1.0));
    let disk_a = dpsm_project(a);
    let disk_b = dpsm_project(b);
    let disk_c = dpsm_project(c);
    let ab = disk_b - disk_a;
    let bc = disk_c - disk_b;
    let ca = disk_a - disk_c;
    let area = ca.x * ab.y - ca.y * ab.x;
    let squares = Vec3::new(ab.dot(ab), bc.dot(bc), ca.dot(ca));
    let longest = squares.x.max(squares.y).max(squares.z);
    let small = longest <= T::lit(DPSM_TRIANGLE_CHORD * DPSM_TRIANGLE_CHORD);
    if !small {
        let rim = one + light.guard;
        let far = T::lit(3.0) * rim;
        return DpsmHull { a: Vec2::splat(-rim), b: Vec2::new(far, -rim), c: Vec2::new(-rim, far) };
    }
    let sagitta = Vec3::new(
        dpsm_edge_sagitta(dpsm_edge_normal(a, b).z, ab),
        dpsm_edge_sagitta(dpsm_edge_normal(b, c).z, bc),
        dpsm_edge_sagitta(dpsm_edge_normal(c, a).z, ca),
    );
    let margin = T::lit(DPSM_TRIANGLE_MARGIN) * dpsm_texel_width(light.size, light.guard);
    let bow = margin + dpsm_edge_largest(sagitta);
    // thinner than its bows are wide: the tips would be long, and the chords may turn another way
    // than the triangle does
    let thin = T::lit(DPSM_TRIANGLE_SINE) * longest;
    if area.abs() <= thin.max(T::lit(2.0) * bow * longest.sqrt()) {
        let mut along = ab;
        if squares.y == longest {
            along = bc;
        } else if squares.z == longest {
            along = ca;
        }
        return dpsm_triangle_needle(disk_a, disk_b, disk_c, along, bow);
    }
    // the arc lies outside where it is on the right of a chord of a counter-clockwise triangle
    let side = select(-one, one, area > zero);
    let outward = Vec3::splat(margin) + (sagitta * side).max(Vec3::splat(zero));
    let unit_ab = ab / ab.length();
    let unit_bc = bc / bc.length();
    let unit_ca = ca / ca.length();
    DpsmHull {
        a: disk_a + dpsm_triangle_tip(unit_ca, unit_ab, outward.z, outward.x),
        b: disk_b + dpsm_triangle_tip(unit_ab, unit_bc, outward.x, outward.y),
        c: disk_c + dpsm_triangle_tip(unit_bc, unit_ca, outward.y, outward.z),
    }
}

/// From a corner to where two lines meet that lie so far on the right of the edges before and
/// after it.
pub fn dpsm_triangle_tip<T: Float>(
    before: Vec2<T>,
    after: Vec2<T>,
    bow_before: T,
    bow_after: T,
) -> Vec2<T> {
    let sine = before.x * after.y - before.y * after.x;
    (before * bow_after - after * bow_before) / sine.abs()
}

/// A right triangle around the rectangle that holds three disk points and `bow` around them.
pub fn dpsm_triangle_needle<T: Float>(
    a: Vec2<T>,
    b: Vec2<T>,
    c: Vec2<T>,
    along: Vec2<T>,
    bow: T,
) -> DpsmHull<T> {
    let (zero, one) = (T::lit(0.0), T::lit(1.0));
    let smallest = T::lit(1.0 / (1u64 << 60) as f64);
    let size = along.length();
    let right = select(Vec2::new(one, zero), along / size.max(smallest), size > zero);
    let up = Vec2::new(-right.y, right.x);
    let to_b = b - a;
    let to_c = c - a;
    let x = Vec2::new(right.dot(to_b), right.dot(to_c));
    let y = Vec2::new(up.dot(to_b), up.dot(to_c));
    let low = Vec2::new(x.x.min(x.y).min(zero), y.x.min(y.y).min(zero)) - Vec2::splat(bow);
    let high = Vec2::new(x.x.max(x.y).max(zero), y.x.max(y.y).max(zero)) + Vec2::splat(bow);
    let sides = high - low;
    let corner = a + right * low.x + up * low.y;
    DpsmHull {
        a: corner,
        b: corner + right * (sides.x + sides.x),
        c: corner + up * (sides.y + sides.y),
    }
}
