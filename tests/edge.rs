//! Arcs and chords of edges: docs/edge.md.

mod common;

use common::exact::{arc, arc_bound, direction, right_of};
use common::{CASES, EPS, Worst, nearby, point, rng, spread, unit};
use dpsm::scalar::edge::*;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::paraboloid::dpsm_project;
use fastrand::Rng;

/// An edge: near ends, far ends, or ends far apart in distance.
fn edge(rng: &mut Rng) -> [Vec3<f32>; 2] {
    match rng.u8(0..3) {
        0 => [point(rng, -8, 8), point(rng, -8, 8)],
        1 => [0; 2].map(|_| unit(rng) * spread(rng, -6, 6)),
        _ => {
            let a = unit(rng) * spread(rng, -6, 6);
            [a, nearby(rng, a, -12, 0)]
        }
    }
}

#[test]
fn largest_component_order_and_unit_vector_are_as_stated() {
    let mut rng = rng("unit");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let [a, b] = [0; 2].map(|_| point(&mut rng, -100, 125));
        assert_eq!(dpsm_edge_largest(a), a.x.abs().max(a.y.abs()).max(a.z.abs()));
        assert!(dpsm_edge_ordered(a, b) != dpsm_edge_ordered(b, a));
        let length = a.widen().length();
        let (value, exact) = (dpsm_edge_unit(a).widen(), a.widen() / length);
        for (value, exact) in [(value.x, exact.x), (value.y, exact.y), (value.z, exact.z)] {
            worst.note((value - exact).abs(), 11.0 * EPS, a);
        }
    }
    worst.check("dpsm_edge_unit");
    assert_eq!(dpsm_edge_unit(Vec3::splat(1e-31_f32)), Vec3::splat(0.0));
}

#[test]
fn lines_of_a_shared_edge_are_exactly_negated() {
    let mut rng = rng("negated");
    for _ in 0..CASES {
        let [a, b] = edge(&mut rng);
        assert_eq!(dpsm_edge_normal(a, b), -dpsm_edge_normal(b, a));
        let (wide_a, wide_b) = (a.widen(), b.widen());
        assert_eq!(dpsm_edge_normal(wide_a, wide_b), -dpsm_edge_normal(wide_b, wide_a));
        let (forth, back) = (dpsm_edge_line(a, b), dpsm_edge_line(b, a));
        // without a direction there is no line
        let some = forth.w >= 0.0;
        assert_eq!(forth.xyz(), if some { -back.xyz() } else { back.xyz() });
        let uv = dpsm_project(a + (b - a) * rng.f32());
        let terms = dpsm_edge_terms(uv);
        let covered = forth.dot(terms) >= 0.0 || back.dot(terms) >= 0.0;
        assert!(covered || !some, "{a:?} {b:?} leaves a hole at {uv:?}");
    }
}

#[test]
fn arc_stays_within_its_bound_of_the_great_circle() {
    let mut rng = rng("arc");
    let mut worst = Worst::default();
    let mut wide = 0;
    for _ in 0..CASES {
        let [a, b] = edge(&mut rng);
        let normal = dpsm_edge_normal(a, b).widen();
        let (from, to) = (a.widen(), b.widen());
        let bound = arc_bound(from, to);
        for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let p = from + (to - from) * share;
            let off = normal.dot(p).abs() / (normal.length() * p.length());
            worst.note(off, bound, (a, b, share));
        }
        wide += usize::from(0.5 * bound > DPSM_EDGE_ROUNDING);
    }
    println!("{wide} of {CASES} edges may move by more than DPSM_EDGE_ROUNDING");
    worst.check("dpsm_edge_normal, radians");
}

#[test]
fn normal_points_along_the_cross_product() {
    let normal = dpsm_edge_normal(Vec3::new(1.0_f32, 0.0, 0.0), Vec3::new(0.0, 2.0, 0.0));
    assert_eq!(normal, Vec3::new(0.0, 0.0, 1.0));
    let line = dpsm_edge_line(Vec3::new(0.0_f32, -1.0, 1.0), Vec3::new(0.0, 1.0, 1.0));
    // going up, the left has u < 0
    assert!(line.dot(dpsm_edge_terms(Vec2::new(-0.1, 0.0))) > 0.0);
    assert!(line.dot(dpsm_edge_terms(Vec2::new(0.1, 0.0))) < 0.0);
}

#[test]
fn sagitta_is_how_far_the_arc_lies_on_the_chords_right() {
    let mut rng = rng("sagitta");
    let (steps, mut signs) = (512, [0; 2]);
    for _ in 0..CASES / 200 {
        let [a, b] = edge(&mut rng).map(|p| Vec3::new(p.x, p.y, p.z.abs()).widen());
        let (from, to) = (dpsm_project(a), dpsm_project(b));
        let chord = to - from;
        if chord.length() < 1e-5 {
            continue;
        }
        let sagitta = dpsm_edge_sagitta(dpsm_edge_normal(a, b).z, chord);
        let offsets: Vec<_> = arc(a, b, steps).map(|p| right_of(from, to, p)).collect();
        let most = offsets
            .into_iter()
            .fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most });
        // samples are at most 4 / steps of the arc apart for a tangent step over at most a right
        // angle, so the largest misses the top by at most that square; f64's rounding beside it
        let allowed = sagitta.abs() * (4.0 / f64::from(steps)).powi(2) + 1e-13;
        assert!((most - sagitta).abs() <= allowed, "{a:?} {b:?}: {most:e} and {sagitta:e}");
        signs[usize::from(sagitta > 0.0)] += 1;
    }
    assert!(signs.iter().all(|&count| count > 100), "{signs:?}");
}

#[test]
fn sagitta_stays_within_its_bound() {
    let mut rng = rng("sagitta bound");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let p = unit(&mut rng);
        let chord = Vec2::new(p.x, p.y) * spread(&mut rng, -20, 0);
        let exact = dpsm_edge_sagitta(f64::from(p.z), chord.widen());
        let error = f64::from(dpsm_edge_sagitta(p.z, chord)) - exact;
        worst.note(error.abs(), 5.0 * EPS * chord.widen().dot(chord.widen()), (p, chord));
    }
    worst.check("dpsm_edge_sagitta");
}

#[test]
fn a_line_weighs_the_distance_on_the_disk() {
    let mut rng = rng("weigh");
    for _ in 0..CASES / 10 {
        let [a, b] = edge(&mut rng).map(Vec3::widen);
        let [a, b] = [a, b].map(|p| Vec3::new(p.x, p.y, p.z.abs() + 1e-3 * p.length()));
        let (from, to) = (dpsm_project(a), dpsm_project(b));
        if (to - from).length() < 1e-6 {
            continue;
        }
        let uv = Vec2::new(rng.f64() - 0.5, rng.f64() - 0.5);
        // an arc: sine of the angle times (1 + r^2) / 2, the map's scale
        let arc = dpsm_edge_line(a, b).dot(dpsm_edge_terms(uv));
        let normal = a.cross(b) / a.cross(b).length();
        let scale = 0.5 * (1.0 + uv.dot(uv));
        let sine = normal.dot(direction(uv));
        assert!((arc - scale * sine).abs() < 1e-9, "{a:?} {b:?} {uv:?}");
    }
}

#[test]
fn edges_without_a_direction_cover_nothing() {
    let p = Vec3::new(1.0_f32, 2.0, 3.0);
    let zero = Vec3::splat(0.0);
    for (a, b) in [(p, p), (p, p + p), (p, -p), (zero, p), (zero, zero), (p, zero)] {
        let line = dpsm_edge_line(a, b);
        let there = line.dot(dpsm_edge_terms(dpsm_project(p)));
        assert!(there < 0.0, "{a:?} {b:?}: {there}");
    }
}
