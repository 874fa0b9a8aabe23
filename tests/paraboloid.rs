//! The projection: bounds of docs/paraboloid.md, and the geometry that they presuppose.

mod common;

use std::f64::consts::PI;

use common::{CASES, EPS, EPS_DOUBLE, Worst, angle, point, rng, unit};
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::DPSM_POLE_RADIUS;
use dpsm::scalar::paraboloid::*;

#[test]
fn project_stays_within_its_bound_over_its_whole_domain() {
    let mut rng = rng("project");
    let (mut front, mut back) = (Worst::default(), Worst::default());
    for _ in 0..CASES {
        let p = point(&mut rng, -51, 62);
        let (uv, exact) = (dpsm_project(p).widen(), dpsm_project(p.widen()));
        if exact.length() >= DPSM_POLE_RADIUS / 2.0 {
            continue; // the next test's
        }
        for (value, exact) in [(uv.x, exact.x), (uv.y, exact.y)] {
            // below 2^-126 / eps a result may lose bits to subnormals: count it from there
            let scale = exact.abs().max((-103.0_f64).exp2());
            match p.z >= 0.0 {
                true => front.note((value - exact).abs() / scale, 9.5 * EPS, p),
                false => back.note((value - exact).abs() / scale, 19.0 * EPS, p),
            }
        }
    }
    front.check("dpsm_project, z >= 0");
    back.check("dpsm_project, z < 0");
}

#[test]
fn directions_near_the_back_pole_stay_within_one_rounding_of_it() {
    let mut rng = rng("pole");
    for _ in 0..CASES {
        let xy = point(&mut rng, -126, -20);
        let p = Vec3::new(xy.x, xy.y, -1.0);
        let uv = dpsm_project(p);
        assert!(uv.x.is_finite() && uv.y.is_finite(), "{p:?} gives {uv:?}");
        let off = angle(dpsm_unproject(uv.widen()), p.widen());
        // the pole's own radius 2^-24 rad, and the 2^-24 rad at which it begins
        assert!(off <= EPS, "{p:?} is {off:e} rad off");
    }
}

#[test]
fn light_position_and_back_pole_have_defined_results() {
    let zero = Vec2::new(0.0_f32, 0.0);
    assert_eq!(dpsm_project(Vec3::new(0.0, 0.0, 0.0)), zero);
    assert_eq!(dpsm_project(Vec3::new(-0.0, -0.0, -0.0)), zero);
    let pole = Vec2::new(DPSM_POLE_RADIUS as f32, 0.0);
    assert_eq!(dpsm_project(Vec3::new(0.0, 0.0, -5.0)), pole);
    assert_eq!(dpsm_unproject(pole).z, -1.0);
}

#[test]
fn radius_is_the_tangent_of_half_the_angle() {
    let mut rng = rng("stereographic");
    for _ in 0..CASES {
        let p = unit(&mut rng).widen();
        let theta = angle(p, Vec3::new(0.0, 0.0, 1.0));
        let r = dpsm_project(p).length();
        // 19 eps for the projection, as much again for the two functions of the angle
        let bound = 38.0 * EPS_DOUBLE * r * (1.0 + r * r);
        assert!((r - (theta / 2.0).tan()).abs() <= bound, "{p:?}");
    }
}

#[test]
fn unproject_stays_within_its_bound() {
    let mut rng = rng("unproject");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let p = point(&mut rng, -30, 61);
        let uv = Vec2::new(p.x, p.y);
        let (d, exact) = (dpsm_unproject(uv).widen(), dpsm_unproject(uv.widen()));
        for (value, exact) in [(d.x, exact.x), (d.y, exact.y), (d.z, exact.z)] {
            worst.note((value - exact).abs(), 5.0 * EPS, uv);
        }
    }
    worst.check("dpsm_unproject");
}

#[test]
fn unproject_takes_project_back_to_the_direction() {
    let mut rng = rng("round trip");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let p = unit(&mut rng);
        let back = dpsm_unproject(dpsm_project(p)).widen();
        // project: 19 eps relative in uv is at most 19 eps rad; unproject: 5 eps a component
        let bound = (19.0 + 5.0 * 3.0_f64.sqrt()) * EPS;
        worst.note(angle(back, p.widen()), bound, p);
    }
    worst.check("round trip, radians");
}

#[test]
fn texel_pitch_is_the_angle_across_a_texel_in_both_directions() {
    let mut rng = rng("pitch");
    for _ in 0..CASES {
        let size = f64::from(rng.u32(64..4096));
        let guard = rng.f64() * 0.1;
        let uv = dpsm_project(unit(&mut rng).widen());
        if uv.length() > 2.0 {
            continue;
        }
        let half = (1.0 + guard) / size;
        let pitch = dpsm_texel_pitch(uv, size, guard);
        for step in [Vec2::new(half, 0.0), Vec2::new(0.0, half)] {
            let across = angle(dpsm_unproject(uv - step), dpsm_unproject(uv + step));
            // first-order formula, docs/paraboloid.md
            let bound = pitch * pitch * pitch / 3.0;
            assert!((across - pitch).abs() <= bound, "{uv:?} at {size}: {across} and {pitch}");
        }
    }
}

#[test]
fn solid_angles_of_a_hemisphere_add_up_to_half_the_sphere() {
    let size = 512;
    let mut sum = 0.0;
    for y in 0..size {
        for x in 0..size {
            let centre = |c: i32| (f64::from(c) + 0.5) / f64::from(size);
            let uv = dpsm_texture_to_disk(Vec2::new(centre(x), centre(y)), 0.0);
            if uv.length() <= 1.0 {
                sum += dpsm_texel_solid_angle(uv, f64::from(size), 0.0);
            }
        }
    }
    // the rim crosses fewer than 4 N texels, each at most half miscounted, 4 / N^2 sr each
    let bound = 4.0 * 0.5 * 4.0 / f64::from(size);
    assert!((sum - 2.0 * PI).abs() <= bound, "{sum}");
}

#[test]
fn solid_angle_varies_four_to_one_over_the_hemisphere() {
    let at = |r: f64| dpsm_texel_solid_angle(Vec2::new(r, 0.0), 512.0, 0.0);
    assert_eq!(at(0.0) / at(1.0), 4.0);
}

#[test]
fn pitch_and_solid_angle_stay_within_their_bounds() {
    let mut rng = rng("pitch bound");
    let (mut pitch, mut solid) = (Worst::default(), Worst::default());
    for _ in 0..CASES {
        let p = point(&mut rng, -60, 55); // size (1 + r^2) <= 2^14 2^111
        let (uv, size, guard) = (Vec2::new(p.x, p.y), rng.u32(1..16385) as f32, rng.f32());
        let wide = (uv.widen(), f64::from(size), f64::from(guard));
        let exact = dpsm_texel_pitch(wide.0, wide.1, wide.2);
        let value = f64::from(dpsm_texel_pitch(uv, size, guard));
        pitch.note((value - exact).abs() / exact, 8.5 * EPS, uv);
        if exact < (-51.0_f64).exp2() {
            continue;
        }
        let exact = exact * exact;
        let value = f64::from(dpsm_texel_solid_angle(uv, size, guard));
        solid.note((value - exact).abs() / exact, 18.0 * EPS, uv);
    }
    pitch.check("dpsm_texel_pitch");
    solid.check("dpsm_texel_solid_angle");
}

#[test]
fn stored_disk_fills_the_texture_and_y_points_down() {
    let guard = 0.25;
    let at = |u, v| dpsm_disk_to_texture(Vec2::new(u, v), guard);
    assert_eq!(at(0.0, 0.0), Vec2::new(0.5, 0.5));
    assert_eq!(at(1.0 + guard, 0.0), Vec2::new(1.0, 0.5));
    assert_eq!(at(0.0, 1.0 + guard), Vec2::new(0.5, 0.0));
}

#[test]
fn texture_coordinates_and_back_stay_within_their_bounds() {
    let mut rng = rng("texture");
    let (mut forth, mut back) = (Worst::default(), Worst::default());
    for _ in 0..CASES {
        let guard = rng.f32();
        let p = Vec2::new(rng.f32() * 2.0 - 1.0, rng.f32() * 2.0 - 1.0) * (1.0 + guard);
        let (st, exact) =
            (dpsm_disk_to_texture(p, guard), dpsm_disk_to_texture(p.widen(), guard.into()));
        forth.note((f64::from(st.x) - exact.x).abs(), 3.0 * EPS, p);
        forth.note((f64::from(st.y) - exact.y).abs(), 3.0 * EPS, p);
        let (uv, exact) =
            (dpsm_texture_to_disk(st, guard), dpsm_texture_to_disk(st.widen(), guard.into()));
        let bound = 6.0 * EPS * f64::from(1.0 + guard);
        back.note((f64::from(uv.x) - exact.x).abs(), bound, st);
        // a round trip adds what the first step's error becomes on the way back, times 2 (1 + g)
        let trip = bound + 2.0 * f64::from(1.0 + guard) * 3.0 * EPS;
        back.note((f64::from(uv.y) - f64::from(p.y)).abs(), trip, p);
    }
    forth.check("dpsm_disk_to_texture");
    back.check("dpsm_texture_to_disk");
}
