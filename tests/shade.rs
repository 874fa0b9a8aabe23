//! Lighting with a visibility.

mod common;

use common::{CASES, EPS, Worst, rng, unit};
use dpsm::scalar::float::Vec3;
use dpsm::scalar::shade::*;

fn color(rng: &mut fastrand::Rng) -> Vec3<f32> {
    Vec3::new(rng.f32(), rng.f32(), rng.f32())
}

#[test]
fn shadow_leaves_the_ambient_light_alone() {
    let (ambient, full) = (Vec3::new(0.1_f32, 0.2, 0.3), Vec3::new(0.5, 0.25, 1.0));
    assert_eq!(dpsm_shade(ambient, full, full, 0.0), ambient);
    assert_eq!(dpsm_shade(ambient, full, full, 1.0), ambient + full + full);
    assert_eq!(dpsm_blend(full, ambient, 0.0), ambient);
    assert_eq!(dpsm_blend(full, ambient, 1.0), full);
}

#[test]
fn blend_of_full_light_is_the_lighting_equation() {
    let mut rng = rng("blend");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let [ambient, diffuse, specular] = [(); 3].map(|()| color(&mut rng).widen());
        let visibility = rng.f64();
        let shaded = dpsm_shade(ambient, diffuse, specular, visibility);
        let blended = dpsm_blend(ambient + diffuse + specular, ambient, visibility);
        // 3 eps of at most 3 for one, of at most 4 for the other, in f64; three components
        let bound = 21.0 * f64::EPSILON * 3.0_f64.sqrt();
        worst.note((shaded - blended).length(), bound, visibility);
    }
    worst.check("dpsm_shade against dpsm_blend");
}

#[test]
fn lighting_stays_within_its_bounds() {
    let mut rng = rng("lighting");
    let [mut shade, mut blend, mut lambert, mut highlight] = [(); 4].map(|()| Worst::default());
    for _ in 0..CASES {
        let [a, d, s] = [(); 3].map(|()| color(&mut rng));
        let visibility = rng.f32();
        let value = dpsm_shade(a, d, s, visibility);
        let exact = dpsm_shade(a.widen(), d.widen(), s.widen(), visibility.into());
        let bound = 3.0 * EPS * f64::from(a.x + d.x + s.x);
        shade.note((f64::from(value.x) - exact.x).abs(), bound, (a, d, s));
        let value = dpsm_blend(d, a, visibility);
        let exact = dpsm_blend(d.widen(), a.widen(), visibility.into());
        let bound = 3.0 * EPS * f64::from(a.y + d.y);
        blend.note((f64::from(value.y) - exact.y).abs(), bound, (a, d));
        let [n, l, e] = [(); 3].map(|()| unit(&mut rng));
        let exact = dpsm_lambert(n.widen(), l.widen());
        lambert.note((f64::from(dpsm_lambert(n, l)) - exact).abs(), 3.0 * EPS, (n, l));
        let exact = dpsm_highlight(n.widen(), l.widen(), e.widen());
        highlight.note((f64::from(dpsm_highlight(n, l, e)) - exact).abs(), 470.0 * EPS, (n, l, e));
    }
    shade.check("dpsm_shade");
    blend.check("dpsm_blend");
    lambert.check("dpsm_lambert");
    highlight.check("dpsm_highlight");
}

#[test]
fn surfaces_that_face_away_catch_no_light() {
    let up = Vec3::new(0.0_f32, 0.0, 1.0);
    assert_eq!(dpsm_lambert(up, Vec3::new(0.6, 0.0, -0.8)), 0.0);
    assert_eq!(dpsm_lambert(up, up), 1.0);
}

#[test]
fn highlight_is_the_32nd_power_of_the_halfway_cosine() {
    let (n, e) = (Vec3::new(0.0_f64, 0.0, 1.0), Vec3::new(0.0, 0.0, 1.0));
    let theta = 0.3_f64;
    let l = Vec3::new(theta.sin(), 0.0, theta.cos());
    let exact = (theta / 2.0).cos().powi(32);
    // 470 eps of the formula, a few more for the sines and the power
    assert!((dpsm_highlight(n, l, e) - exact).abs() <= 500.0 * f64::EPSILON);
    assert_eq!(dpsm_highlight(n, l, Vec3::new(-l.x, 0.0, -l.z)), 0.0);
}
