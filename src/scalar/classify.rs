//! Port of `wgsl/classify.wesl`.

use super::caster::dpsm_caster_border;
use super::edge::{
    DPSM_EDGE_ROUNDING, DPSM_EDGE_SNAP, dpsm_edge_flat, dpsm_edge_terms, dpsm_edge_unit,
};
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::hemisphere::{DPSM_BACK, DPSM_FRONT, dpsm_flip};
use super::light::DpsmLight;
use super::paraboloid::{DPSM_SMALLEST, dpsm_project, dpsm_texel_width};
use super::triangle::{DPSM_TRIANGLE_CHORD, DpsmHull, dpsm_triangle_plane};

/// Not drawn: outside the clipping spheres, without area, not finite, or between texel centres.
pub const DPSM_CULLED: u32 = 0;

/// As it is, with no fragment stage: inside one stored disk and touching no other.
pub const DPSM_FLAT: u32 = 1;

/// As it is, but with the plane's distance at each fragment.
pub const DPSM_STEEP: u32 = 5;

/// As it is, in both maps, cut at the stored disk's border by the fragment stage.
pub const DPSM_STRADDLING: u32 = 2;

/// By its hull, with module triangle in the fragment stage.
pub const DPSM_CURVED: u32 = 3;

/// As a curved one, but by the hulls of its parts.
pub const DPSM_LARGE: u32 = 4;

/// Bit of the front hemisphere, whose stored disk a triangle may touch.
pub const DPSM_IN_FRONT: u32 = 1;

/// Bit of the back hemisphere.
pub const DPSM_IN_BACK: u32 = 2;

/// What becomes of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DpsmClass {
    /// DPSM_CULLED, DPSM_FLAT, DPSM_STRADDLING, DPSM_CURVED or DPSM_LARGE.
    pub kind: u32,
    /// DPSM_IN_FRONT, DPSM_IN_BACK or both; 0 for a culled one.
    pub hemispheres: u32,
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

/// The least height of a steep triangle's plane, as a share of the farthest vertex's distance.
pub const DPSM_CLASSIFY_EDGE_ON: f64 = 1.0 / 1024.0;

/// True where every component is a number up to 2^62.
pub fn dpsm_classify_usable<T: Float>(p: Vec3<T>) -> bool {
    [p.x, p.y, p.z].iter().all(|c| c.abs() <= T::lit(DPSM_CLASSIFY_LARGEST))
}

/// The class of a triangle of light-space vertices, not flipped.
pub fn dpsm_classify<T: Float>(
    a: Vec3<T>,
    b: Vec3<T>,
    c: Vec3<T>,
    light: DpsmLight<T>,
    tau: T,
    depth_tolerance: T,
) -> DpsmClass {
    let zero = T::lit(0.0);
    let culled = DpsmClass { kind: DPSM_CULLED, hemispheres: 0 };
    if ![a, b, c].into_iter().all(dpsm_classify_usable) {
        return culled;
    }
    let lengths = Vec3::new(a.length(), b.length(), c.length());
    let farthest = lengths.x.max(lengths.y).max(lengths.z);
    if farthest < light.near {
        return culled;
    }
    // in the map that shows more of it
    let own = select(DPSM_BACK, DPSM_FRONT, a.z + b.z + c.z >= zero);
    let p = dpsm_flip(a, own);
    let q = dpsm_flip(b, own);
    let r = dpsm_flip(c, own);
    let disk_p = dpsm_project(p);
    let disk_q = dpsm_project(q);
    let disk_r = dpsm_project(r);
    let pq = disk_q - disk_p;
    let qr = disk_r - disk_q;
    let rp = disk_p - disk_r;
    let longest = pq.dot(pq).max(qr.dot(qr)).max(rp.dot(rp));
    let small = longest <= T::lit(DPSM_TRIANGLE_CHORD * DPSM_TRIANGLE_CHORD);
    let outer = disk_p.dot(disk_p).max(disk_q.dot(disk_q)).max(disk_r.dot(disk_r));
    // no point of a small triangle is farther on the disk from a corner than its longest chord
    let reach = (outer.sqrt() + longest.sqrt()) * (T::lit(1.0) + light.guard);
    let both = !small || reach >= T::lit(DPSM_CLASSIFY_RIM);
    if !both && dpsm_classify_misses(disk_p, disk_q, disk_r, light) {
        return culled;
    }
    let plane = dpsm_triangle_plane(p, q, r);
    let height = plane.w.abs();
    // a plane that holds the light is seen edge-on; rounding of the height is far below 1/1024
    let seen = height > zero;
    if !seen || height > light.far + T::lit(1.0 / 1024.0) * farthest {
        return culled;
    }
    let own_bit = select(DPSM_IN_BACK, DPSM_IN_FRONT, own == DPSM_FRONT);
    let hemispheres = select(own_bit, DPSM_IN_FRONT | DPSM_IN_BACK, both);
    if small
        && dpsm_edge_flat(p, q, light, tau)
        && dpsm_edge_flat(q, r, light, tau)
        && dpsm_edge_flat(r, p, light, tau)
    {
        let disks = DpsmHull { a: disk_p, b: disk_q, c: disk_r };
        let error = dpsm_classify_flat_error(disks, lengths, plane);
        if error <= depth_tolerance {
            return DpsmClass { kind: select(DPSM_FLAT, DPSM_STRADDLING, both), hemispheres };
        }
        // clear of the clipping spheres, at which interpolated distances would be cut, and not so
        // edge-on that its plane runs off beside it
        let clear = height > light.near.max(T::lit(DPSM_CLASSIFY_EDGE_ON) * farthest);
        if !both && clear && farthest < light.far {
            return DpsmClass { kind: DPSM_STEEP, hemispheres };
        }
    }
    DpsmClass { kind: select(DPSM_CURVED, DPSM_LARGE, both), hemispheres }
}

/// Largest relative error of a plane's distance when it is interpolated between three disk points.
pub fn dpsm_classify_flat_error<T: Float>(
    hull: DpsmHull<T>,
    distances: Vec3<T>,
    plane: Vec4<T>,
) -> T {
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
    T::lit(1.5) * errors.x.abs().max(errors.y.abs()).max(errors.z.abs()) / unit + unseen
}

/// The distance of a plane (unit normal, height) in the direction of uv; below 0 behind.
pub fn dpsm_classify_distance<T: Float>(plane: Vec4<T>, uv: Vec2<T>) -> T {
    let facing = plane.xyz().dot(dpsm_edge_terms(uv).xyz());
    let least = T::lit(DPSM_CLASSIFY_FACING);
    let seen = select(facing, least, facing.abs() < least);
    plane.w * (T::lit(1.0) + uv.dot(uv)) / seen
}

/// True where a triangle of disk corners covers no texel centre, whether its edges are drawn as
/// chords or as arcs.
pub fn dpsm_classify_misses<T: Float>(
    a: Vec2<T>,
    b: Vec2<T>,
    c: Vec2<T>,
    light: DpsmLight<T>,
) -> bool {
    let one = T::lit(1.0);
    let half = T::lit(0.5);
    let ab = b - a;
    let bc = c - b;
    let ca = a - c;
    let longest = ab.dot(ab).max(bc.dot(bc)).max(ca.dot(ca));
    let texel = dpsm_texel_width(light.size, light.guard);
    // no arc lies farther from its chord than c^2 / 4
    let outside =
        T::lit(DPSM_EDGE_SNAP) * texel + T::lit(DPSM_EDGE_ROUNDING) + T::lit(0.25) * longest;
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

/// A part of a triangle: unit vectors to its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmPart<T> {
    /// First corner.
    pub a: Vec3<T>,
    /// Second corner.
    pub b: Vec3<T>,
    /// Third corner.
    pub c: Vec3<T>,
}

/// A part of a triangle, by halving it over and over at its longest edge.
pub fn dpsm_classify_part<T: Float>(a: Vec3<T>, b: Vec3<T>, c: Vec3<T>, path: u32) -> DpsmPart<T> {
    let mut part = DpsmPart { a: dpsm_edge_unit(a), b: dpsm_edge_unit(b), c: dpsm_edge_unit(c) };
    for bit in (0..(path | 1).ilog2()).rev() {
        part = dpsm_classify_half(part, (path >> bit) & 1 != 0);
    }
    part
}

/// One half of a part: its longest edge's middle takes the place of that edge's first or, for
/// `second`, last corner.
pub fn dpsm_classify_half<T: Float>(part: DpsmPart<T>, second: bool) -> DpsmPart<T> {
    let ab = part.b - part.a;
    let bc = part.c - part.b;
    let ca = part.a - part.c;
    let squares = Vec3::new(ab.dot(ab), bc.dot(bc), ca.dot(ca));
    // turned so that the edge from a to b is the longest
    let mut turned = part;
    if squares.y > squares.x && squares.y >= squares.z {
        turned = DpsmPart { a: part.b, b: part.c, c: part.a };
    } else if squares.z > squares.x {
        turned = DpsmPart { a: part.c, b: part.a, c: part.b };
    }
    let middle = dpsm_edge_unit(turned.a + turned.b);
    if second {
        return DpsmPart { a: turned.a, b: middle, c: turned.c };
    }
    DpsmPart { a: middle, b: turned.b, c: turned.c }
}

/// What becomes of a part: DPSM_CULLED where it does not touch the stored disk, DPSM_CURVED where
/// a hull surrounds it well, DPSM_LARGE where it must be halved.
pub fn dpsm_classify_kind<T: Float>(part: DpsmPart<T>, light: DpsmLight<T>) -> u32 {
    // beyond the border is at most a hemisphere: convex, so that its corners speak for a part
    let top = part.a.z.max(part.b.z).max(part.c.z) + T::lit(DPSM_EDGE_ROUNDING);
    if top < dpsm_caster_border(light.guard) {
        return DPSM_CULLED;
    }
    let disk_a = dpsm_project(part.a);
    let disk_b = dpsm_project(part.b);
    let disk_c = dpsm_project(part.c);
    let disk_ab = disk_b - disk_a;
    let disk_ca = disk_a - disk_c;
    let chord = disk_ab.length().max((disk_c - disk_b).length()).max(disk_ca.length());
    let area = (disk_ca.x * disk_ab.y - disk_ca.y * disk_ab.x).abs();
    // arcs bow by up to c^2 / 8: more than a texel and the part's own width wastes fragments
    let bow = T::lit(0.125) * chord * chord;
    let wide = bow > dpsm_texel_width(light.size, light.guard) && bow * chord > area;
    select(DPSM_CURVED, DPSM_LARGE, chord > T::lit(DPSM_TRIANGLE_CHORD) || wide)
}
