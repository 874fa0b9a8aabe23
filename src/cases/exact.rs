//! The cases of the exact path's modules: edge, triangle and classify.

use super::domain::{Finite, Inside, Outside, all as any, numbers, sized, up_to, vertices, when};
use super::domain::{Promise, finite};
use super::values::*;
use super::{Cases, disk, point};
use crate::scalar::classify::*;
use crate::scalar::edge::dpsm_edge_unit;
use crate::scalar::float::{Vec2, Vec3, Vec4};
use crate::scalar::triangle::*;

/// Tolerance of edges in texels, and of distances.
const TAU: f32 = 0.5;
const DEPTH: f32 = 1.0 / 1024.0;

/// A triangle's corners on the disk, more or less.
fn disks(abc: [[f32; 3]; 3]) -> [Vec2<f32>; 3] {
    abc.map(|[x, y, z]| Vec2::new(x, y) / (z.abs() + 1.0))
}

/// Disk points with chords up to the given length; longer ones are finite.
fn chords(most: f32, abc: [[f32; 3]; 3]) -> Promise {
    let [a, b, c] = disks(abc);
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    match numbers(abc.as_flattened().try_into().unwrap_or([0.0; 9])) {
        Inside if longest <= most => Inside,
        Inside if longest < f32::INFINITY => Finite,
        _ => Outside,
    }
}

/// Adds the cases of one of these functions.
pub fn add(function: &str, cases: &mut Cases) {
    let ends = |[a, b]: [[f32; 3]; 2]| (point(a), point(b));
    let corners = |abc: [[f32; 3]; 3]| abc.map(point);
    let unit = |abc: [[f32; 3]; 3]| {
        let [a, b, c] = corners(abc).map(dpsm_edge_unit);
        DpsmPart { a, b, c }
    };
    // triangles whose corners have directions; others are finite
    let directed = |abc: [[f32; 3]; 3]| match abc.map(|p| sized(-100, 126, p)) {
        promises if promises.contains(&Outside) => Outside,
        _ if corners(abc).map(dpsm_edge_unit).iter().all(|u| u.dot(*u) > 0.5) => Inside,
        _ => Finite,
    };
    let prepared = |abc| {
        let [a, b, c] = corners(abc);
        dpsm_triangle(a, b, c, LIGHT, TAU)
    };
    let at = Vec2::new(0.0625_f32, 0.03125);
    let ordinary = TRIANGLES.rows[0].1;
    match function {
        "dpsm_edge_largest" => {
            cases.each(&POINTS, finite, point);
        }
        "dpsm_edge_unit" => cases.each(&POINTS, |p| sized(-100, 126, p), point),
        "dpsm_classify_usable" => cases.each(&POINTS, any, point),
        "dpsm_edge_ordered" => {
            cases.each(
                &ENDS,
                |e| numbers([e[0], e[1]].concat().try_into().unwrap_or([0.0; 6])),
                ends,
            );
        }
        "dpsm_edge_normal" => cases.each(&ENDS, vertices, ends),
        "dpsm_edge_sagitta" => {
            // chords up to 2
            cases.each(&OFFSETS, any, |chord| (-0.75_f32, disk(chord)));
            let both = |uv: [f32; 2]| up_to(1, uv).max(up_to(62, uv).min(Finite));
            cases.each(&DISKS, both, |chord| (1.0, disk(chord)));
        }
        "dpsm_edge_flat" | "dpsm_edge_line" => {
            cases.each(&ENDS, vertices, |e| (ends(e), (LIGHT, TAU)));
            cases.named(&ENDS, ", any bow", vertices, |e| (ends(e), (LIGHT, 32.0)));
            cases.each(&LIGHTS, any, |light| (ends(ENDS.rows[0].1), (light, TAU)));
        }
        "dpsm_edge_bow" => {
            cases.each(&ENDS, vertices, |e| (ends(e), LIGHT));
            cases.each(&LIGHTS, any, |light| (ends(ENDS.rows[0].1), light));
        }
        "dpsm_edge_terms" => cases.each(&DISKS, |uv| up_to(62, uv), disk),
        "dpsm_triangle_plane" => cases.each(&TRIANGLES, vertices, corners),
        "dpsm_triangle" => {
            cases.each(&TRIANGLES, vertices, |t| (corners(t), (LIGHT, TAU)));
            cases.each(&LIGHTS, any, |light| (corners(ordinary), (light, TAU)));
        }
        "dpsm_triangle_inside" | "dpsm_triangle_covers" | "dpsm_triangle_distance" => {
            cases.each(&TRIANGLES, vertices, |t| (prepared(t), at));
            cases.each(&DISKS, |uv| up_to(2, uv), |uv| (prepared(ordinary), disk(uv)));
        }
        "dpsm_triangle_behind" => cases.each(&TRIANGLES, vertices, |t| (prepared(t), 0.75_f32)),
        "dpsm_triangle_disk" => cases.each(&SIZES, any, |size| {
            let (middle, texel) = (0.5 * size, 2.0 * (1.0 + GUARD) / size);
            (Vec2::new(0.5, size - 0.5), Vec2::splat(middle), texel)
        }),
        "dpsm_triangle_fragment" => {
            cases.each(&TRIANGLES, vertices, |t| (prepared(t), at, LIGHT, 0.01));
            let on = prepared(ordinary);
            cases.each(&DISKS, |uv| up_to(2, uv), |uv| (on, disk(uv), LIGHT, 0.01));
            cases.each(&LIGHTS, any, |light| (on, at, light, 0.01));
        }
        "dpsm_triangle_weights" => cases.each(&TRIANGLES, vertices, |t| (corners(t), at)),
        "dpsm_triangle_hull" | "dpsm_triangle_span" => {
            cases.each(&TRIANGLES, vertices, |t| (corners(t), LIGHT));
            cases.each(&LIGHTS, any, |light| (corners(ordinary), light));
        }
        "dpsm_triangle_tip" => {
            // a sine of at least 1/64
            let domain = |sine: f32| when(sine >= 1.0 / 64.0);
            let after = |y: f32| Vec2::new((1.0 - y * y).sqrt(), y);
            cases.each(&SINES, domain, |y| (Vec2::new(1.0, 0.0), after(y), 0.01, 0.02));
        }
        "dpsm_triangle_needle" => {
            let domain = |t| chords(8.0, t);
            cases.each(&TRIANGLES, domain, |t| (disks(t), Vec2::new(0.75, -0.5), 0.01));
            cases.named(&TRIANGLES, ", no edge", domain, |t| (disks(t), Vec2::splat(0.0), 0.01));
        }
        "dpsm_classify" => {
            cases.each(&TRIANGLES, any, |t| (corners(t), (LIGHT, TAU, DEPTH)));
            cases.named(&TRIANGLES, ", any bow", any, |t| (corners(t), (LIGHT, 1e3, 1.0)));
            cases.each(&LIGHTS, any, |light| (corners(ordinary), (light, TAU, DEPTH)));
        }
        "dpsm_classify_flat_error" => cases.each(&TRIANGLES, vertices, |t| {
            let [a, b, c] = corners(t);
            let distances = Vec3::new(a.length(), b.length(), c.length());
            (disks(t), distances, dpsm_triangle_plane(a, b, c))
        }),
        "dpsm_classify_distance" => {
            let plane = |z| Vec4::new(0.0, 0.0, z, 2.0);
            cases.each(&COSINES, any, |z| (plane(z), at));
            cases.each(&DISKS, |uv| up_to(2, uv), |uv| (Vec4::new(0.8, 0.0, 0.6, 2.0), disk(uv)));
        }
        "dpsm_classify_misses" => {
            cases.each(&TRIANGLES, |t| chords(0.5, t), |t| (disks(t), LIGHT));
            let small = disks(TRIANGLES.rows[3].1);
            cases.each(&LIGHTS, any, |light| (small, light));
        }
        "dpsm_classify_part" => {
            cases.each(&PATHS, any, |path| (corners(ordinary), path));
            cases.each(&TRIANGLES, vertices, |t| (corners(t), 5));
        }
        "dpsm_classify_half" => {
            cases.named(&TRIANGLES, ", first", directed, |t| (unit(t), false));
            cases.named(&TRIANGLES, ", second", directed, |t| (unit(t), true));
        }
        "dpsm_classify_kind" => {
            cases.each(&TRIANGLES, directed, |t| (unit(t), LIGHT));
            cases.each(&LIGHTS, any, |light| (unit(ordinary), light));
        }
        _ => {}
    }
}
