//! Hemispheres and the seam.

mod common;

use common::{CASES, EPS, EPS_DOUBLE, Worst, angle, point, rng};
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::*;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::paraboloid::{dpsm_project, dpsm_unproject};

#[test]
fn seam_itself_is_in_front_with_either_sign_of_zero() {
    assert_eq!(dpsm_hemisphere(Vec3::new(1.0_f32, 0.0, 0.0)), DPSM_FRONT);
    assert_eq!(dpsm_hemisphere(Vec3::new(1.0_f32, 0.0, -0.0)), DPSM_FRONT);
    assert_eq!(dpsm_hemisphere(Vec3::new(1.0_f32, 0.0, -f32::MIN_POSITIVE)), DPSM_BACK);
}

#[test]
fn flip_mirrors_the_back_alone_and_undoes_itself() {
    let p = Vec3::new(1.0_f32, 2.0, -3.0);
    assert_eq!(dpsm_flip(p, DPSM_FRONT), p);
    assert_eq!(dpsm_flip(p, DPSM_BACK), Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(dpsm_flip(dpsm_flip(p, DPSM_BACK), DPSM_BACK), p);
}

#[test]
fn inversion_is_the_same_direction_in_the_other_map() {
    let mut rng = rng("inversion");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let p = point(&mut rng, -8, 8).widen();
        let crossed = dpsm_unproject(dpsm_invert(dpsm_project(p)));
        // relative errors in uv are at most as many radians: 19 eps to project, 4.5 to invert;
        // 5 eps a component to come back
        let bound = (23.5 + 5.0 * 3.0_f64.sqrt()) * EPS_DOUBLE;
        worst.note(angle(dpsm_flip(crossed, DPSM_BACK), p), bound, p);
    }
    worst.check("direction after dpsm_invert, radians");
}

#[test]
fn inversion_stays_within_its_bound_and_undoes_itself() {
    let mut rng = rng("invert");
    let (mut once, mut twice) = (Worst::default(), Worst::default());
    for _ in 0..CASES {
        let p = point(&mut rng, -24, 24);
        let uv = Vec2::new(p.x, p.y);
        if uv.length() >= DPSM_POLE_RADIUS as f32 / 2.0 {
            continue;
        }
        let (value, exact) = (dpsm_invert(uv).widen(), dpsm_invert(uv.widen()));
        once.note((value.x - exact.x).abs() / exact.x.abs(), 4.5 * EPS, uv);
        once.note((value.y - exact.y).abs() / exact.y.abs(), 4.5 * EPS, uv);
        let again = dpsm_invert(dpsm_invert(uv)).widen() - uv.widen();
        twice.note(again.length() / uv.widen().length(), 9.0 * EPS, uv);
    }
    once.check("dpsm_invert");
    twice.check("dpsm_invert, twice");
}

#[test]
fn centre_goes_to_the_other_pole() {
    let pole = Vec2::new(DPSM_POLE_RADIUS as f32, 0.0);
    assert_eq!(dpsm_invert(Vec2::new(0.0_f32, -0.0)), pole);
    assert_eq!(dpsm_invert(Vec2::new(1e-30_f32, 1e-30)), pole);
}

#[test]
fn light_space_stays_within_its_bound_far_from_the_origin() {
    let mut rng = rng("light space");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let light = common::light(&mut rng);
        let world = light.position + point(&mut rng, -10, 10);
        let wide = light.widen();
        let (p, exact) = (dpsm_to_light(world, light).widen(), dpsm_to_light(world.widen(), wide));
        let bound = 4.0 * EPS * (world.widen() - wide.position).length();
        for (value, exact) in [(p.x, exact.x), (p.y, exact.y), (p.z, exact.z)] {
            worst.note((value - exact).abs(), bound, world);
        }
    }
    worst.check("dpsm_to_light");
}

#[test]
fn light_space_is_a_rotation_about_the_light() {
    let mut rng = rng("rotation");
    let third = 1.0 / 3.0;
    let light = DpsmLight {
        right: Vec3::new(2.0 * third, 2.0 * third, -third),
        up: Vec3::new(-third, 2.0 * third, 2.0 * third),
        forward: Vec3::new(2.0 * third, -third, 2.0 * third),
        ..dpsm::cases::light(0).widen()
    };
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let d = point(&mut rng, -4, 4).widen();
        let p = dpsm_to_light(light.position + d, light);
        // the world point's own rounding, eps / 2 of its length, and the function's 4 eps
        let reach = (light.position + d).length();
        let bound = EPS_DOUBLE * (0.5 * reach + 4.0 * d.length());
        for (value, row) in [(p.x, light.right), (p.y, light.up), (p.z, light.forward)] {
            worst.note((value - row.dot(d)).abs(), bound, d);
        }
    }
    worst.check("dpsm_to_light, rotation");
}
