//! Lighting with a visibility, and where it is tested.

mod common;

use common::{CASES, EPS, Worst, rng, uniform, unit};
use dpsm::scalar::bounds::Bound;
use dpsm::scalar::float::{Float, Vec3};
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

/// A triangle inscribed in a unit sphere around the origin, its normals those of the sphere.
fn inscribed<T: Float>(rng: &mut fastrand::Rng) -> [DpsmCorner<T>; 3] {
    let center = unit(rng).widen();
    [(); 3].map(|()| {
        let other = unit(rng).widen();
        let p = center + other * 0.4;
        let p = p / p.length();
        let position = Vec3::new(T::lit(p.x), T::lit(p.y), T::lit(p.z));
        DpsmCorner { position, normal: position }
    })
}

fn weights(rng: &mut fastrand::Rng) -> Vec3<f64> {
    let [s, t] = [rng.f64(), rng.f64()];
    let [s, t] = if s + t > 1.0 { [1.0 - s, 1.0 - t] } else { [s, t] };
    Vec3::new(1.0 - s - t, s, t)
}

fn inside(corners: [DpsmCorner<f64>; 3], w: Vec3<f64>) -> Vec3<f64> {
    let [a, b, c] = corners.map(|corner| corner.position);
    a * w.x + b * w.y + c * w.z
}

#[test]
fn terminator_lifts_points_of_a_coarse_sphere_towards_the_sphere_and_never_far_beyond() {
    let mut rng = rng("terminator");
    let mut most = 0.0_f64;
    for _ in 0..CASES {
        let corners = inscribed(&mut rng);
        let w = weights(&mut rng);
        let p = inside(corners, w);
        let [a, b, c] = corners;
        let moved = dpsm_shadow_terminator(p, w, a, b, c);
        // the chord's point is 1 - |p| below the sphere; the planes lie above it
        let (before, after) = (1.0 - p.length(), moved.length() - 1.0);
        assert!(after >= -1e-12, "{after:e} above the sphere, {before:e} below it before");
        most = most.max(after / before.max(1e-9));
    }
    println!("at most {most:.3} times as far above as it was below");
    // for triangles of up to 47 degrees: a plane is as far above as the chord is below, or less
    assert!(most <= 1.2, "{most}");
}

#[test]
fn terminator_leaves_corners_flat_triangles_and_hollows_alone() {
    let mut rng = rng("terminator at rest");
    for _ in 0..1000 {
        let corners: [DpsmCorner<f64>; 3] = inscribed(&mut rng);
        let [a, b, c] = corners;
        // each corner with the weight of one
        let at = dpsm_shadow_terminator(b.position, Vec3::new(0.0, 1.0, 0.0), a, b, c);
        assert_eq!(at, b.position);
        let w = weights(&mut rng);
        let p = inside(corners, w);
        // seen from inside, the surface is hollow
        let turned = corners.map(|corner| DpsmCorner { normal: corner.normal * -1.0, ..corner });
        let [a, b, c] = turned;
        assert!((dpsm_shadow_terminator(p, w, a, b, c) - p).length() <= 1e-15);
        let up = Vec3::new(0.0, 0.0, 1.0);
        let flat = corners.map(|corner| {
            let Vec3 { x, y, .. } = corner.position;
            DpsmCorner { position: Vec3::new(x, y, 0.25), normal: up }
        });
        let p = Vec3 { z: 0.25, ..inside(flat, w) };
        let [a, b, c] = flat;
        assert_eq!(dpsm_shadow_terminator(p, w, a, b, c), p);
    }
}

#[test]
fn terminator_meets_neighbours_on_their_common_edge_at_one_point() {
    let mut rng = rng("terminator edge");
    for _ in 0..1000 {
        let [a, b, c]: [DpsmCorner<f64>; 3] = inscribed(&mut rng);
        let [d, ..] = inscribed(&mut rng);
        let s = rng.f64();
        let p = a.position * (1.0 - s) + b.position * s;
        let one = dpsm_shadow_terminator(p, Vec3::new(1.0 - s, s, 0.0), a, b, c);
        let other = dpsm_shadow_terminator(p, Vec3::new(s, 1.0 - s, 0.0), b, a, d);
        assert!((one - other).length() <= 1e-15, "{one:?} {other:?}");
    }
}

#[test]
fn terminator_stays_within_its_bound() {
    let mut rng = rng("terminator bound");
    let bound = Bound::of("dpsm_shadow_terminator").unwrap();
    let mut worst = Worst::default();
    let words = |v: Vec3<f32>| [v.x, v.y, v.z].map(f64::from);
    for _ in 0..CASES {
        let corners: [DpsmCorner<f32>; 3] = inscribed(&mut rng).map(|corner: DpsmCorner<f32>| {
            let scale = 2.0_f32.powi(rng.i32(-8..8));
            DpsmCorner { position: corner.position * scale, ..corner }
        });
        let w = weights(&mut rng).narrow();
        let [a, b, c] = corners;
        let p = a.position * w.x + b.position * w.y + c.position * w.z;
        let wide = corners.map(|corner| DpsmCorner {
            position: corner.position.widen(),
            normal: corner.normal.widen(),
        });
        let actual = words(dpsm_shadow_terminator(p, w, a, b, c));
        let [a, b, c] = wide;
        let exact = dpsm_shadow_terminator(p.widen(), w.widen(), a, b, c);
        let mut input = [words(p), words(w)].concat();
        for corner in corners {
            input.extend([words(corner.position), words(corner.normal)].concat());
        }
        let error = bound.error(&input, &[exact.x, exact.y, exact.z], &actual).unwrap();
        worst.note(error.eps, error.bound, (p, w, corners));
    }
    worst.check("dpsm_shadow_terminator");
}

#[test]
fn spots_fade_between_their_angles() {
    let mut rng = rng("spot");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let outer = uniform(&mut rng, -1.0, 0.9);
        let inner = uniform(&mut rng, outer, 1.0);
        let cosine = uniform(&mut rng, -1.0, 1.0);
        let share = dpsm_spot(cosine, inner, outer);
        let [c, i, o] = [cosine, inner, outer].map(f64::from);
        let linear = ((c - o) / (i - o).max(1e-3)).clamp(0.0, 1.0);
        worst.note((f64::from(share) - linear * linear).abs(), 10.0 * EPS, (cosine, inner, outer));
    }
    worst.check("dpsm_spot");
    assert_eq!([dpsm_spot(0.9, 0.8, 0.5), dpsm_spot(0.4, 0.8, 0.5)], [1.0, 0.0]);
    // angles that are one
    assert_eq!([dpsm_spot(0.6, 0.5, 0.5), dpsm_spot(0.5, 0.5, 0.5)], [1.0, 0.0]);
    // and angles that hardly differ: the fade is a thousandth wide
    let narrow = dpsm_spot(0.5005_f64, 0.5001, 0.5);
    assert!((narrow - 0.25).abs() < 1e-6, "{narrow}");
    // no cone at all
    assert_eq!([-1.0, 0.0, 1.0].map(|cosine| dpsm_spot(cosine, -2.0, -3.0)), [1.0; 3]);
}

#[test]
fn ranges_leave_nothing_at_their_end() {
    let mut rng = rng("range");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let (distance, range) = (uniform(&mut rng, 0.0, 20.0), uniform(&mut rng, 0.1, 20.0));
        let exact = 1.0 - (f64::from(distance) / f64::from(range)).min(1.0).powi(4);
        let share = f64::from(dpsm_range(distance, range));
        worst.note((share - exact).abs(), 14.0 * EPS, (distance, range));
    }
    worst.check("dpsm_range");
    assert_eq!(
        [dpsm_range(0.0, 5.0), dpsm_range(5.0, 5.0), dpsm_range(50.0, 5.0)],
        [1.0, 0.0, 0.0]
    );
    assert_eq!(dpsm_range(1e18, f32::MAX), 1.0);
}
