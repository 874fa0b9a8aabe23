//! The six faces: layout, guard band, stored depth and the shadow test.

#[cfg(feature = "gpu")]
mod adapter;
#[path = "../common/mod.rs"]
mod common;
mod cull;

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use common::{CASES, EPS, EPS_DOUBLE, Worst, angle, light, point, rng, spread, uniform, unit};
use dpsm::scalar::cube::*;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::dpsm_texel_pitch;

/// Vulkan's table: for each face s, t and the major axis, as (component, sign).
const TABLE: [[(usize, f64); 3]; 6] = [
    [(2, -1.0), (1, -1.0), (0, 1.0)],
    [(2, 1.0), (1, -1.0), (0, -1.0)],
    [(0, 1.0), (2, 1.0), (1, 1.0)],
    [(0, 1.0), (2, -1.0), (1, -1.0)],
    [(0, 1.0), (1, -1.0), (2, 1.0)],
    [(0, -1.0), (1, -1.0), (2, -1.0)],
];

#[test]
fn face_is_that_of_the_largest_component_and_ties_go_to_z_then_y() {
    let face = |x: f32, y, z| dpsm_cube_face(Vec3::new(x, y, z));
    let axes = [(2.0, 1.0, -1.0), (-2.0, 1.0, 1.0), (1.0, 2.0, 1.0)];
    assert_eq!(axes.map(|(x, y, z)| face(x, y, z)), [0, 1, 2]);
    let axes = [(1.0, -2.0, 1.0), (1.0, -1.0, 2.0), (1.0, 1.0, -2.0)];
    assert_eq!(axes.map(|(x, y, z)| face(x, y, z)), [3, 4, 5]);
    assert_eq!([face(1.0, 1.0, 1.0), face(1.0, -1.0, -1.0)], [4, 5]);
    assert_eq!([face(1.0, 1.0, 0.5), face(-1.0, -1.0, 0.5)], [2, 3]);
    assert_eq!([face(0.0, 0.0, 0.0), face(-0.0, -0.0, -0.0)], [4, 4]);
}

#[test]
fn faces_are_laid_out_as_in_vulkans_table() {
    let mut rng = rng("table");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let p = point(&mut rng, -8, 8).widen();
        let at = dpsm_cube_lookup(p, DpsmLight { guard: 0.0, ..light(&mut rng).widen() });
        let components = [p.x, p.y, p.z];
        let [s, t, major] =
            TABLE[at.hemisphere as usize].map(|(axis, sign)| sign * components[axis]);
        assert!(components.iter().all(|c| c.abs() <= major), "{p:?}");
        // two roundings a side of numbers up to 1, and this formula's own two
        let error = at.coordinates - Vec2::new(s / major + 1.0, t / major + 1.0) * 0.5;
        worst.note(error.x.abs().max(error.y.abs()), 4.0 * EPS_DOUBLE, p);
    }
    worst.check("dpsm_cube_lookup against the table");
}

#[test]
fn view_space_is_a_rotation_with_the_faces_axis_forward_and_back_again() {
    for face in 0..DPSM_CUBE_FACES {
        let p = Vec3::new(2.0_f64, 3.0, 5.0);
        let rows = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)];
        let [x, y, z] = rows.map(|(x, y, z)| dpsm_cube_unview(Vec3::new(x, y, z), face));
        assert_eq!(common::cross(x, y), z, "mirrored face {face}");
        assert_eq!(dpsm_cube_face(z), face);
        assert_eq!(dpsm_cube_view(p, face), Vec3::new(x.dot(p), y.dot(p), z.dot(p)));
        assert_eq!(dpsm_cube_unview(dpsm_cube_view(p, face), face), p);
    }
}

#[test]
fn guard_band_is_one_texel_and_a_comparison_at_the_edge_stays_inside() {
    for size in 1..=4096_u32 {
        let (guard, n) = (f64::from(dpsm_cube_guard(size as f32)), f64::from(size));
        assert!((0.0..=1.0).contains(&guard));
        let texels = guard / (2.0 * (1.0 + guard) / n);
        if size >= 4 {
            // 3.5 eps of the guard, twice for its place in the texel's width
            assert!((texels - 1.0).abs() <= 7.0 * EPS, "{size}: {texels}");
        }
        // 2 x 2 texels around a coordinate reach their far centres, less than a texel away
        let edge = n * (0.5 + 0.5 / (1.0 + guard));
        assert!(size == 1 || edge <= n - 0.5, "{size}: {edge}");
    }
}

#[test]
fn vertex_after_the_division_is_the_lookups_place_and_depth() {
    let mut rng = rng("vertex");
    let [mut place, mut depth] = [(); 2].map(|()| Worst::default());
    for _ in 0..CASES {
        let light = light(&mut rng).widen();
        let p = unit(&mut rng).widen() * f64::from(uniform(&mut rng, 0.0, 2.0)) * light.far;
        let at = dpsm_cube_lookup(p, light);
        let clip = dpsm_cube_vertex(p, at.hemisphere, light);
        let st = Vec2::new(clip.x / clip.w + 1.0, 1.0 - clip.y / clip.w) * 0.5;
        let error = st - at.coordinates;
        place.note(error.x.abs().max(error.y.abs()), 9.0 * EPS_DOUBLE, p);
        if clip.w >= light.near && clip.w <= light.far {
            let scale = light.far / (light.far - light.near);
            // 5.5 (1 + near / w) and the division's 2.5, and 10.5
            depth.note((clip.z / clip.w - at.depth).abs(), 24.0 * EPS_DOUBLE * scale, p);
        }
    }
    place.check("dpsm_cube_vertex, place");
    depth.check("dpsm_cube_vertex, depth");
}

#[test]
fn vertex_stays_within_its_bound() {
    let mut rng = rng("vertex bound");
    let [mut plane, mut depth] = [(); 2].map(|()| Worst::default());
    for _ in 0..CASES {
        let (light, p, face) = (light(&mut rng), point(&mut rng, -20, 8), rng.u32(0..6));
        let (clip, exact) =
            (dpsm_cube_vertex(p, face, light), dpsm_cube_vertex(p.widen(), face, light.widen()));
        for (value, exact) in [(clip.x, exact.x), (clip.y, exact.y)] {
            plane.note((f64::from(value) - exact).abs(), 3.5 * EPS * exact.abs(), p);
        }
        let (near, far) = (f64::from(light.near), f64::from(light.far));
        let bound = 5.5 * EPS * far * (exact.w.abs() + near) / (far - near);
        depth.note((f64::from(clip.z) - exact.z).abs(), bound, (p, near, far));
        assert_eq!(f64::from(clip.w), exact.w);
    }
    plane.check("dpsm_cube_vertex, x and y");
    depth.check("dpsm_cube_vertex, z");
}

#[test]
fn depth_is_zero_to_near_and_one_from_far_on_exactly() {
    let mut rng = rng("depth ends");
    for _ in 0..CASES {
        let light = light(&mut rng);
        let depth = |z| dpsm_cube_depth(z, light.near, light.far);
        assert_eq!([depth(light.near), depth(0.5 * light.near), depth(-1.0)], [0.0; 3]);
        assert_eq!([depth(light.far), depth(2.0 * light.far)], [1.0; 2]);
        let z = uniform(&mut rng, light.near, light.far);
        assert!((0.0..=1.0).contains(&depth(z)));
    }
}

#[test]
fn lookup_and_receiver_depth_stay_within_their_bounds() {
    let mut rng = rng("lookup");
    let [mut place, mut depth, mut biased] = [(); 3].map(|()| Worst::default());
    for _ in 0..CASES {
        let light = light(&mut rng);
        let (p, bias) = (point(&mut rng, -20, 8), spread(&mut rng, -16, -3).abs());
        let (at, exact) = (dpsm_cube_lookup(p, light), dpsm_cube_lookup(p.widen(), light.widen()));
        let error = at.coordinates.widen() - exact.coordinates;
        place.note(error.x.abs().max(error.y.abs()), 4.5 * EPS, p);
        let (near, far) = (f64::from(light.near), f64::from(light.far));
        let scale = EPS * far / (far - near);
        depth.note((f64::from(at.depth) - exact.depth).abs(), 10.5 * scale, p);
        assert_eq!(
            (at.layer, at.hemisphere),
            (light.first_layer + at.hemisphere, exact.hemisphere)
        );
        let face = at.hemisphere;
        let own = dpsm_cube_receiver_depth(p, face, light, bias);
        let exact = dpsm_cube_receiver_depth(p.widen(), face, light.widen(), bias.into());
        let z = dpsm_cube_view(p.widen(), face).z;
        let moved = z - z * f64::from(bias) * (far - near) / p.widen().length();
        let bound = scale * (10.5 + 13.0 * near * z / moved.max(near).powi(2));
        biased.note((f64::from(own) - exact).abs(), bound, (p, bias));
        assert_eq!(dpsm_cube_receiver_depth(p, face, light, 0.0), at.depth);
    }
    place.check("dpsm_cube_lookup, coordinates");
    depth.check("dpsm_cube_lookup, depth");
    biased.check("dpsm_cube_receiver_depth");
}

#[test]
fn bias_is_a_radial_depth_towards_the_light() {
    let light = DpsmLight { near: 0.5, far: 8.5, ..dpsm::cases::light(0).widen() };
    // 3-4-12: the length 13 is 13/12 of the distance along +z
    let p = Vec3::new(3.0, 4.0, 12.0) / 13.0 * 6.5;
    let own = dpsm_cube_receiver_depth(p, 4, light, 0.25);
    // 0.25 of 8 units closer: 4.5 from the light, and a rounding or two
    let exact = dpsm_cube_depth(4.5 * 12.0 / 13.0, 0.5, 8.5);
    assert!((own - exact).abs() <= 13.0 * EPS_DOUBLE, "{own} {exact}");
    assert_eq!(dpsm_cube_receiver_depth(p, 4, light, 1.0), 0.0);
    assert_eq!(dpsm_cube_receiver_depth(Vec3::splat(0.0), 4, light, 0.25), 0.0);
}

#[test]
fn direction_and_distance_take_a_lookup_back_to_the_point() {
    let mut rng = rng("back");
    let [mut direction, mut distance, mut back] = [(); 3].map(|()| Worst::default());
    for _ in 0..CASES {
        let light = light(&mut rng);
        let wide = light.widen();
        let (near, far) = (wide.near, wide.far);
        let p = unit(&mut rng) * uniform(&mut rng, 2.0 * light.near, light.far);
        let at = dpsm_cube_lookup(p.widen(), wide);
        let d = dpsm_cube_direction(at.coordinates, at.hemisphere, wide.guard);
        let z = dpsm_cube_view(p.widen(), at.hemisphere).z;
        // coordinates 4.5 eps, 2 (1 + guard) of the plane each, and 6 (1 + guard) back
        back.note((d * z - p.widen()).length(), EPS_DOUBLE * 15.0 * 2.0 * 2.0 * z, p);
        let l = dpsm_cube_distance(at.depth, d, near, far);
        let length = p.widen().length();
        // a depth's 10.5 eps is 10.5 z / near of the distance
        let bound = EPS_DOUBLE * (10.5 + 15.0 * 2.0 * 2.0 + (4.0 + 10.5) * z / near) * length;
        if z >= near {
            back.note((l - length).abs(), bound, p);
        }
        let (st, depth) = (Vec2::new(rng.f32(), rng.f32()), rng.f32());
        let d = dpsm_cube_direction(st, at.hemisphere, light.guard);
        let exact = dpsm_cube_direction(st.widen(), at.hemisphere, wide.guard);
        let error = d.widen() - exact;
        for error in [error.x, error.y, error.z] {
            direction.note(error.abs(), 6.0 * EPS * (1.0 + wide.guard), st);
        }
        let value = f64::from(dpsm_cube_distance(depth, d, light.near, light.far));
        let exact = dpsm_cube_distance(depth.into(), d.widen(), near, far);
        let z = exact / d.widen().length();
        distance.note((value - exact).abs(), EPS * (10.5 + 4.0 * z / near) * exact, depth);
    }
    back.check("dpsm_cube_direction and dpsm_cube_distance after dpsm_cube_lookup");
    direction.check("dpsm_cube_direction");
    distance.check("dpsm_cube_distance");
}

/// Half of a cube around the light shadows what is behind it; the other half is open.
#[test]
fn points_behind_half_a_cube_are_in_shadow_and_no_others() {
    const SIZE: u32 = 128;
    let axis = Vec3::new(0.8, 0.1, 0.3);
    let light = DpsmLight {
        near: 0.1,
        far: 10.0,
        guard: dpsm_cube_guard(SIZE as f32),
        first_layer: 1,
        ..dpsm::cases::light(0)
    };
    let wide = light.widen();
    let mut maps = DepthMaps::empty(SIZE, 7, Sampling::Nearest);
    for face in 0..DPSM_CUBE_FACES {
        for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
            let centre = |c| (f64::from(c) + 0.5) / f64::from(SIZE);
            let d = dpsm_cube_direction(Vec2::new(centre(x), centre(y)), face, wide.guard);
            if angle(d, axis) <= 1.0 {
                let index = maps.index(x.into(), y.into(), 1 + face);
                maps.depths[index] = dpsm_cube_depth(3.0, wide.near, wide.far) as f32;
            }
        }
    }
    // a texel's half-diagonal, seen from the light: widest in the middle of a face
    let texel = 2.0 * (1.0 + wide.guard) / f64::from(SIZE) * FRAC_1_SQRT_2;
    let mut rng = rng("half a cube");
    let [mut shadowed, mut lit] = [0, 0];
    for i in 0..CASES {
        let p = unit(&mut rng) * uniform(&mut rng, 0.3, 9.0);
        let bias = if i % 2 == 0 { 0.0 } else { 0.1 * rng.f32() };
        let l = p.widen().length();
        let closer = 1.0 - f64::from(bias) * (wide.far - wide.near) / l;
        let z = dpsm_cube_view(p.widen(), dpsm_cube_face(p)).z;
        let off = angle(p.widen(), axis);
        let scale = EPS * wide.far / (wide.far - wide.near);
        let moved = (closer * z).max(wide.near);
        // own depth's bound, and the stored one's rounding; a depth's change is scale near / z^2
        let bound = scale * (11.5 + 13.0 * wide.near * z / (moved * moved));
        let depth = dpsm_cube_depth(moved, wide.near, wide.far);
        let clear = (depth - dpsm_cube_depth(3.0, wide.near, wide.far)).abs() > bound;
        if (off - 1.0).abs() <= texel || !clear {
            continue;
        }
        let truth = off > 1.0 || closer * z < 3.0;
        let visibility = dpsm_cube_visibility(&maps, p, light, bias);
        assert_eq!(visibility, f32::from(u8::from(truth)), "{p:?}, bias {bias}");
        match truth {
            true => lit += 1,
            false => shadowed += 1,
        }
    }
    assert!(shadowed > CASES / 20 && lit > CASES / 20, "{shadowed} in shadow, {lit} lit");
}

#[test]
fn faces_of_half_the_maps_size_have_the_same_coarsest_texel() {
    let size = 512.0;
    let across = |x: f64| dpsm_cube_direction(Vec2::new(0.5 + x, 0.5), 2, 0.0);
    let half_texel = 0.5 / (size / 2.0);
    let face = angle(across(-half_texel), across(half_texel));
    let map = dpsm_texel_pitch(Vec2::new(0.0, 0.0), size, 0.0);
    // both are first-order: the texel's pitch cubed over 3 (docs/paraboloid.md)
    assert!((face - map).abs() <= map.powi(3) / 3.0, "{face} {map}");
    // at a face's corner, plane distance sqrt 3: a third of it along the diagonal
    let corner = |x: f64| dpsm_cube_direction(Vec2::new(1.0 - x, 1.0 - x), 2, 0.0);
    let diagonal = angle(corner(0.0), corner(2.0 * half_texel)) / SQRT_2;
    // to first order in the texel's width at the corner: it grows by 2 rho dr / (1 + rho^2)
    assert!((diagonal - map / 3.0).abs() <= map * map, "{diagonal} {map}");
}
