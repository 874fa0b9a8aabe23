//! Stored depth and the clipping spheres.

mod common;

use common::{CASES, EPS, Worst, rng, uniform};
use dpsm::scalar::depth::*;

/// Distance, near, far with near < far over six orders of magnitude.
fn spheres(rng: &mut fastrand::Rng) -> (f32, f32, f32) {
    let far = uniform(rng, 1.0, 1000.0);
    let near = far * 10.0_f32.powf(uniform(rng, -6.0, -0.05));
    (uniform(rng, near, far), near, far)
}

#[test]
fn depth_stays_within_its_bound() {
    let mut rng = rng("depth");
    let (mut forth, mut back) = (Worst::default(), Worst::default());
    for _ in 0..CASES {
        let (l, near, far) = spheres(&mut rng);
        let wide = [l, near, far].map(f64::from);
        let exact = dpsm_depth(wide[0], wide[1], wide[2]);
        let depth = dpsm_depth(l, near, far);
        let bound = 4.5 * EPS * (wide[0] + wide[1]) / (wide[2] - wide[1]);
        forth.note((f64::from(depth) - exact).abs(), bound, (l, near, far));
        let distance = f64::from(dpsm_distance(depth, near, far));
        let exact = dpsm_distance(f64::from(depth), wide[1], wide[2]);
        let bound = 3.0 * EPS * (wide[1] + f64::from(depth) * wide[2]);
        back.note((distance - exact).abs(), bound, (depth, near, far));
    }
    forth.check("dpsm_depth");
    back.check("dpsm_distance");
}

#[test]
fn distance_of_a_depth_is_the_distance_again() {
    let mut rng = rng("inverse");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let (l, near, far) = spheres(&mut rng);
        let back = dpsm_distance(dpsm_depth(l, near, far), near, far);
        // depth's bound times far - near, and distance's own
        let (l, near, far) = (f64::from(l), f64::from(near), f64::from(far));
        let depth = (l - near) / (far - near);
        let bound = 4.5 * EPS * (l + near) + 3.0 * EPS * (near + depth * far);
        worst.note((f64::from(back) - l).abs(), bound, (l, near, far));
    }
    worst.check("dpsm_distance of dpsm_depth");
}

#[test]
fn spheres_store_zero_and_one_exactly() {
    let mut rng = rng("spheres");
    for _ in 0..CASES {
        let (_, near, far) = spheres(&mut rng);
        assert_eq!(dpsm_depth(near, near, far), 0.0);
        assert_eq!(dpsm_depth(far, near, far), 1.0);
    }
}

#[test]
fn a_farther_point_never_stores_a_smaller_depth() {
    let mut rng = rng("monotone");
    for _ in 0..CASES {
        let (l, near, far) = spheres(&mut rng);
        assert!(dpsm_depth(l.next_up(), near, far) >= dpsm_depth(l, near, far), "{l} {near} {far}");
    }
}

#[test]
fn both_spheres_are_within() {
    assert!(dpsm_within(0.1_f32, 0.1, 10.0) && dpsm_within(10.0_f32, 0.1, 10.0));
    assert!(!dpsm_within(0.1_f32.next_down(), 0.1, 10.0));
    assert!(!dpsm_within(10.0_f32.next_up(), 0.1, 10.0));
}

#[test]
fn receivers_outside_the_spheres_compare_at_the_spheres() {
    assert_eq!(dpsm_receiver_depth(0.05_f32, 0.1, 10.0), 0.0);
    assert_eq!(dpsm_receiver_depth(11.0_f32, 0.1, 10.0), 1.0);
    assert_eq!(dpsm_receiver_depth(5.0_f32, 0.1, 10.0), dpsm_depth(5.0, 0.1, 10.0));
}
