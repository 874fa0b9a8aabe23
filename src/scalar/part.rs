//! Port of `wgsl/part.wesl`.

use super::caster::dpsm_caster_border;
use super::edge::{DPSM_EDGE_ROUNDING, dpsm_edge_unit};
use super::float::{Float, Vec3, select};
use super::light::DpsmLight;
use super::paraboloid::{dpsm_project, dpsm_texel_width};
use super::triangle::DPSM_TRIANGLE_CHORD;

/// Not drawn: it does not touch the stored disk.
pub const DPSM_PART_OUTSIDE: u32 = 0;

/// Drawn by its hull.
pub const DPSM_PART_DRAWN: u32 = 1;

/// To be halved.
pub const DPSM_PART_LARGE: u32 = 2;

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
pub fn dpsm_part<T: Float>(a: Vec3<T>, b: Vec3<T>, c: Vec3<T>, path: u32) -> DpsmPart<T> {
    let mut part = DpsmPart { a: dpsm_edge_unit(a), b: dpsm_edge_unit(b), c: dpsm_edge_unit(c) };
    for bit in (0..(path | 1).ilog2()).rev() {
        part = dpsm_part_half(part, (path >> bit) & 1 != 0);
    }
    part
}

/// One half of a part: its longest edge's middle takes the place of that edge's first or, for
/// `second`, last corner.
pub fn dpsm_part_half<T: Float>(part: DpsmPart<T>, second: bool) -> DpsmPart<T> {
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

/// What becomes of a part: DPSM_PART_OUTSIDE, DPSM_PART_DRAWN where a hull surrounds it well, or
/// DPSM_PART_LARGE.
pub fn dpsm_part_kind<T: Float>(part: DpsmPart<T>, light: DpsmLight<T>) -> u32 {
    // beyond the border is at most a hemisphere: convex, so that its corners speak for a part
    let top = part.a.z.max(part.b.z).max(part.c.z) + T::lit(DPSM_EDGE_ROUNDING);
    if top < dpsm_caster_border(light.guard) {
        return DPSM_PART_OUTSIDE;
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
    select(DPSM_PART_DRAWN, DPSM_PART_LARGE, chord > T::lit(DPSM_TRIANGLE_CHORD) || wide)
}
