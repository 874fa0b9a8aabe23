//! The cases of the map-making modules: edge, triangle, classify, refine and part.

use super::domain::{Finite, Inside, Outside, all as any, numbers, sized, up_to, vertices, when};
use super::domain::{Promise, finite};
use super::values::*;
use super::{Cases, disk, point};
use crate::scalar::classify::*;
use crate::scalar::edge::dpsm_edge_unit;
use crate::scalar::float::{Vec2, Vec3, Vec4};
use crate::scalar::part::*;
use crate::scalar::triangle::*;

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
        dpsm_triangle(a, b, c, LIGHT)
    };
    let seen = |abc| corners(abc).map(dpsm_projected);
    let height = |abc| {
        let [a, b, c] = corners(abc);
        dpsm_triangle_plane(a, b, c).w
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
        "dpsm_edge_normal" | "dpsm_edge_line" | "dpsm_refine_point" => {
            cases.each(&ENDS, vertices, ends)
        }
        "dpsm_edge_sagitta" => {
            // chords up to 2
            cases.each(&OFFSETS, any, |chord| (-0.75_f32, disk(chord)));
            let both = |uv: [f32; 2]| up_to(1, uv).max(up_to(62, uv).min(Finite));
            cases.each(&DISKS, both, |chord| (1.0, disk(chord)));
        }
        "dpsm_edge_terms" => cases.each(&DISKS, |uv| up_to(62, uv), disk),
        "dpsm_triangle_plane" => cases.each(&TRIANGLES, vertices, corners),
        "dpsm_triangle" => {
            cases.each(&TRIANGLES, vertices, |t| (corners(t), LIGHT));
            cases.each(&LIGHTS, any, |light| (corners(ordinary), light));
        }
        "dpsm_triangle_face" => {
            let plane = |z| Vec4::new(0.0, 0.6, 0.8, z);
            cases.each(&COSINES, any, |z| (plane(z), 2.0_f32));
        }
        "dpsm_triangle_distance" => {
            cases.each(&TRIANGLES, vertices, |t| (prepared(t).face, at));
            cases.each(&DISKS, |uv| up_to(2, uv), |uv| (prepared(ordinary).face, disk(uv)));
        }
        "dpsm_triangle_inside" | "dpsm_triangle_covers" => {
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
            cases.each(&TRIANGLES, any, |t| (seen(t), height(t), (0_u32, LIGHT)));
            cases.named(&TRIANGLES, ", back", any, |t| (seen(t), height(t), (1_u32, LIGHT)));
            cases.each(&LIGHTS, any, |light| (seen(ordinary), height(ordinary), (0_u32, light)));
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
            cases.each(&TRIANGLES, |t| chords(0.5, t), |t| (disks(t), (LIGHT, 0.01)));
            let small = disks(TRIANGLES.rows[3].1);
            cases.each(&LIGHTS, any, |light| (small, (light, 0.0)));
        }
        "dpsm_projected" => cases.each(&POINTS, |p| sized(-51, 62, p), point),
        "dpsm_refine_reach" => {
            for tau in [0.0_f32, 0.125, 0.25, 65536.0] {
                cases.named(&LIGHTS, &format!(", {tau}"), any, move |light| (light, tau));
            }
        }
        "dpsm_refine_long" => {
            let both = |uv: [f32; 2]| up_to(60, uv);
            cases.each(&DISKS, both, |uv| (at, disk(uv)));
        }
        "dpsm_refine_splits" => {
            let seen = |e: [[f32; 3]; 2]| e.map(|p| dpsm_projected(point(p)));
            cases.each(&ENDS, vertices, |e| (seen(e), 1e-4_f32));
            cases.named(&ENDS, ", nothing allowed", vertices, |e| (seen(e), 0.0_f32));
        }
        "dpsm_refine_corners" => {
            let all = |paths: u32| (paths % 8, paths % 5, paths % 2 == 1);
            cases.each(&PATHS, any, all);
        }
        "dpsm_refine_turned" => cases.each(&PATHS, any, |path| (path % 6, path % 3)),
        "dpsm_refine_edge" => cases.each(&PATHS, any, |path| (path % 7, path / 7 % 7)),
        "dpsm_refine_fat" => {
            cases.each(&TRIANGLES, vertices, |t| (seen(t), 1_u32));
            cases.named(&TRIANGLES, ", halves", vertices, |t| (seen(t), 7_u32));
        }
        "dpsm_refine_foot" => cases.each(&TRIANGLES, vertices, |t| {
            let [a, b, c] = corners(t);
            ([a, b, c], dpsm_triangle_plane(a, b, c))
        }),
        "dpsm_refine_outside" => {
            cases.each(&TRIANGLES, |t| chords(8.0, t), |t| (disks(t), LIGHT));
            cases.each(&LIGHTS, any, |light| (disks(ordinary), light));
        }
        "dpsm_refine_flat" => cases.each(&TRIANGLES, vertices, |t| {
            let [a, b, c] = corners(t);
            let distances = Vec3::new(a.length(), b.length(), c.length());
            (disks(t), distances, dpsm_triangle_plane(a, b, c), (1e-4_f32, 1e-3_f32))
        }),
        "dpsm_refine_clip" => {
            cases.each(&DISKS, |uv| up_to(61, uv), |uv| (disk(uv), 2.0_f32, LIGHT));
            cases.each(&LIGHTS, any, |light| (at, 2.0_f32, light));
        }
        "dpsm_part" => {
            cases.each(&PATHS, any, |path| (corners(ordinary), path));
            cases.each(&TRIANGLES, vertices, |t| (corners(t), 5));
        }
        "dpsm_part_half" => {
            cases.named(&TRIANGLES, ", first", directed, |t| (unit(t), false));
            cases.named(&TRIANGLES, ", second", directed, |t| (unit(t), true));
        }
        "dpsm_part_kind" => {
            cases.each(&TRIANGLES, directed, |t| (unit(t), LIGHT));
            cases.each(&LIGHTS, any, |light| (unit(ordinary), light));
        }
        _ => {}
    }
}
