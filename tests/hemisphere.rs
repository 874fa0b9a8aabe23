//! Hemispheres and the seam.

mod common;

use common::{CASES, EPS, Widen, Worst, point, rng, widen_light};
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::*;
use dpsm::scalar::paraboloid::dpsm_project;

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
        let front = dpsm_project(p);
        let other = dpsm_project(dpsm_flip(p, DPSM_BACK));
        let crossed = dpsm_invert(front);
        // each side projects (20 eps at most) and one inverts (5.5 eps, and carries 20 over)
        let bound = (20.0 + 5.5 + 20.0) * f64::EPSILON * other.length();
        worst.note((crossed - other).length(), bound, p);
    }
    worst.check("dpsm_invert against dpsm_project of the flipped point");
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
        once.note((value.x - exact.x).abs() / exact.x.abs(), 5.5 * EPS, uv);
        once.note((value.y - exact.y).abs() / exact.y.abs(), 5.5 * EPS, uv);
        let again = dpsm_invert(dpsm_invert(uv)).widen() - uv.widen();
        twice.note(again.length() / uv.widen().length(), 11.0 * EPS, uv);
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
        let wide = widen_light(light);
        let (p, exact) = (dpsm_to_light(world, light).widen(), dpsm_to_light(world.widen(), wide));
        let bound = 4.0 * EPS * (world.widen() - wide.position).length();
        for (value, exact) in [(p.x, exact.x), (p.y, exact.y), (p.z, exact.z)] {
            worst.note((value - exact).abs(), bound, world);
        }
    }
    worst.check("dpsm_to_light");
}

#[test]
fn forward_goes_to_the_front_pole_and_right_to_the_right() {
    let light = dpsm::cases::light(0);
    let p = dpsm_to_light(light.position + light.forward * 2.0, light);
    // 4 eps times the distance, and as much for the struct's own rounded rotation
    let close = |a: f32, b: f32| f64::from((a - b).abs()) <= 8.0 * 100.0 * EPS;
    assert!(close(p.x, 0.0) && close(p.y, 0.0) && close(p.z, 2.0), "{p:?}");
    let p = dpsm_to_light(light.position + light.right, light);
    assert!(close(p.x, 1.0) && close(p.y, 0.0) && close(p.z, 0.0), "{p:?}");
}
