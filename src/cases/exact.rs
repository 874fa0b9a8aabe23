//! The cases of the exact path's modules: edge, triangle and classify.

use super::{Cases, POINTS, disk, light, point};
use crate::scalar::classify::*;
use crate::scalar::edge::dpsm_edge_unit;
use crate::scalar::float::{Vec2, Vec3, Vec4};
use crate::scalar::light::DPSM_LAYERS;
use crate::scalar::triangle::*;

/// Two ends of an edge.
const EDGES: &[(&str, [[f32; 3]; 2])] = &[
    ("ordinary", [[1.0, 2.0, 3.0], [2.0, 1.0, 3.5]]),
    ("ends swapped", [[2.0, 1.0, 3.5], [1.0, 2.0, 3.0]]),
    ("across the seam", [[1.0, 0.0, 0.25], [1.0, 0.5, -0.25]]),
    ("both ends one", [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]]),
    ("in line with the light", [[1.0, 2.0, 3.0], [2.0, 4.0, 6.0]]),
    ("light between the ends", [[1.0, 2.0, 3.0], [-1.0, -2.0, -3.0]]),
    ("an end at the light", [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]),
    ("through the pole", [[-0.1, 0.0, 1.0], [0.1, 0.0, 1.0]]),
    ("in the seam", [[0.6, 0.8, 0.0], [0.8, 0.6, -0.0]]),
    ("an end far away", [[1e-3, 2e-3, 1e-3], [-1e9, 3e9, 2e9]]),
];

/// Triangles around the light.
const TRIANGLES: &[(&str, [[f32; 3]; 3])] = &[
    ("seen counter-clockwise", [[0.0, 0.0, 2.0], [0.4, 0.0, 2.0], [0.0, 0.3, 2.5]]),
    ("seen clockwise", [[0.0, 0.0, 2.0], [0.0, 0.3, 2.5], [0.4, 0.0, 2.0]]),
    ("smaller than a texel", [[0.3, 0.2, 1.0], [0.3005, 0.2, 1.0], [0.3, 0.2005, 1.0]]),
    ("a wall", [[-9.0, -9.0, 1.0], [9.0, -9.0, 1.0], [0.0, 9.0, 1.0]]),
    ("a needle", [[-0.2, 0.001, 1.0], [0.2, 0.0, 1.0], [0.0, 0.0005, 1.1]]),
    ("across the seam", [[1.0, 0.0, 0.05], [1.0, 0.1, -0.05], [1.0, -0.1, -0.05]]),
    ("behind", [[0.3, 0.0, -2.0], [0.5, 0.1, -2.0], [0.4, 0.3, -2.0]]),
    ("around the light", [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [0.0, 1.0, 1.0]]),
    ("around the back pole", [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [0.0, 1.0, -1.0]]),
    ("plane through the light", [[1.0, 0.0, 1.0], [1.0, 0.0, 2.0], [2.0, 0.0, 1.0]]),
    ("a vertex at the light", [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]]),
    ("no area", [[1.0, 1.0, 1.0], [1.0, 1.0, 2.0], [1.0, 1.0, 3.0]]),
    ("one point", [[1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.0]]),
    ("all at the light", [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
    ("inside the near sphere", [[0.0, 0.0, 0.05], [0.01, 0.0, 0.05], [0.0, 0.01, 0.05]]),
    ("beyond the far sphere", [[0.0, 0.0, 11.0], [3.0, 0.0, 11.0], [0.0, 3.0, 11.0]]),
    ("not a number", [[0.0, 0.0, f32::NAN], [0.4, 0.0, 2.0], [0.0, 0.3, 2.5]]),
    ("infinite", [[0.0, 0.0, 2.0], [f32::INFINITY, 0.0, 2.0], [0.0, 0.3, 2.5]]),
];

/// Tolerance of edges in texels, and of distances.
const TAU: f32 = 0.5;
const DEPTH: f32 = 1.0 / 1024.0;

/// Adds the cases of one of these functions.
pub fn add(function: &str, cases: &mut Cases) {
    let light = light(DPSM_LAYERS);
    let ends = |[a, b]: [[f32; 3]; 2]| (point(a), point(b));
    let corners = |abc: [[f32; 3]; 3]| abc.map(point);
    let disks = |abc: [[f32; 3]; 3]| abc.map(|[x, y, z]| Vec2::new(x, y) / (z.abs() + 1.0));
    let unit = |abc: [[f32; 3]; 3]| {
        let [a, b, c] = corners(abc).map(dpsm_edge_unit);
        DpsmPart { a, b, c }
    };
    let prepared = |abc| {
        let [a, b, c] = corners(abc);
        dpsm_triangle(a, b, c, light, TAU)
    };
    let at = Vec2::new(0.0625_f32, 0.03125);
    match function {
        "dpsm_edge_largest" | "dpsm_edge_unit" | "dpsm_classify_usable" => {
            cases.each(POINTS, point);
            let odd = [("not a number", f32::NAN), ("infinite", f32::INFINITY), ("2^63", 9.3e18)];
            if function == "dpsm_classify_usable" {
                cases.each(&odd, |x| Vec3::new(x, 0.0, 1.0));
            }
        }
        "dpsm_edge_ordered" | "dpsm_edge_normal" => cases.each(EDGES, ends),
        "dpsm_edge_sagitta" => {
            let chords = [("across the disk", 2.0), ("short", 1e-3), ("none", 0.0)];
            cases.each(&chords, |x| (-0.75_f32, Vec2::new(x, 0.0)));
        }
        "dpsm_edge_flat" | "dpsm_edge_line" => {
            cases.each(EDGES, |e| (ends(e), (light, TAU)));
            cases.each(&EDGES[..1], |e| (ends(e), (light, 1e3)));
        }
        "dpsm_edge_bow" => cases.each(EDGES, |e| (ends(e), light)),
        "dpsm_edge_terms" => cases.each(super::DISKS, disk),
        "dpsm_triangle_plane" => cases.each(TRIANGLES, corners),
        "dpsm_triangle" => cases.each(TRIANGLES, |t| (corners(t), (light, TAU))),
        "dpsm_triangle_inside" | "dpsm_triangle_covers" | "dpsm_triangle_distance" => {
            cases.each(TRIANGLES, |t| (prepared(t), at));
        }
        "dpsm_triangle_behind" => cases.each(TRIANGLES, |t| (prepared(t), 0.75_f32)),
        "dpsm_triangle_disk" => {
            let positions = [("first texel", 0.5), ("middle", 256.0), ("last", 511.5)];
            cases.each(&positions, |x| (Vec2::new(x, 10.5), Vec2::splat(256.0), 1.0 / 252.0));
        }
        "dpsm_triangle_fragment" => cases.each(TRIANGLES, |t| (prepared(t), at, light, 0.01)),
        "dpsm_triangle_weights" => cases.each(TRIANGLES, |t| (corners(t), at)),
        "dpsm_triangle_hull" | "dpsm_triangle_span" => {
            cases.each(TRIANGLES, |t| (corners(t), light));
        }
        "dpsm_triangle_tip" => {
            let sines = [("right angle", 1.0), ("narrow", 1.0 / 64.0), ("none", 0.0)];
            cases.each(&sines, |y| (Vec2::new(1.0, 0.0), Vec2::new(0.5, y), 0.01, 0.02));
        }
        "dpsm_triangle_needle" => {
            cases.each(TRIANGLES, |t| (disks(t), Vec2::new(0.75, -0.5), 0.01));
            cases.each(&TRIANGLES[..1], |t| (disks(t), Vec2::new(0.0, 0.0), 0.01));
        }
        "dpsm_classify" => {
            cases.each(TRIANGLES, |t| (corners(t), (light, TAU, DEPTH)));
            cases.each(&TRIANGLES[..1], |t| (corners(t), (light, 1e3, 1.0)));
        }
        "dpsm_classify_flat_error" => cases.each(TRIANGLES, |t| {
            let [a, b, c] = corners(t);
            let distances = Vec3::new(a.length(), b.length(), c.length());
            (disks(t), distances, dpsm_triangle_plane(a, b, c))
        }),
        "dpsm_classify_distance" => {
            let planes = [("facing", 1.0), ("oblique", 0.125), ("edge-on", 0.0)];
            cases.each(&planes, |z| (Vec4::new(0.0, 0.0, z, 2.0), at));
        }
        "dpsm_classify_misses" => cases.each(TRIANGLES, |t| (disks(t), light)),
        "dpsm_classify_part" => {
            let paths = [("itself", 1), ("first half", 2), ("deep", 0b1101_0111), ("no path", 0)];
            for (name, path) in paths {
                cases.each(&[(name, path)], |path| (corners(TRIANGLES[0].1), path));
            }
            cases.each(TRIANGLES, |t| (corners(t), 5));
        }
        "dpsm_classify_half" => cases.each(TRIANGLES, |t| (unit(t), true)),
        "dpsm_classify_kind" => cases.each(TRIANGLES, |t| (unit(t), light)),
        _ => {}
    }
}
