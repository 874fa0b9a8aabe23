//! The span of a triangle: all of it is within, and nothing far beyond its tips.

use dpsm::scalar::edge::{DPSM_EDGE_ROUNDING, dpsm_edge_line, dpsm_edge_terms};
use dpsm::scalar::float::Vec3;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::paraboloid::{dpsm_project, dpsm_texel_width};
use dpsm::scalar::triangle::*;
use fastrand::Rng;

use crate::common::exact::{arc, triangle};
use crate::common::{CASES, EPS, light, nearby, rng, spread, unit};

/// A light with maps of 16 to 4096 texels a side.
fn sized(rng: &mut Rng) -> DpsmLight<f32> {
    DpsmLight { size: (1 << rng.u32(4..13)) as f32, ..light(rng) }
}

#[test]
fn arcs_stay_within_the_span() {
    let mut rng = rng("span");
    let mut compared = 0;
    for _ in 0..CASES / 2 {
        let corners = triangle(&mut rng);
        let [a, b, c] = corners;
        let light = sized(&mut rng);
        let span = dpsm_triangle_span(a, b, c, light);
        if span == Vec3::splat(0.0) {
            continue;
        }
        let wide = corners.map(Vec3::widen);
        for (from, to) in [(wide[0], wide[1]), (wide[1], wide[2]), (wide[2], wide[0])] {
            for uv in arc(from, to, 8).filter(|uv| uv.length() <= 1.5) {
                let at = span.dot(Vec3::new(uv.x, uv.y, 1.0).narrow()).abs();
                assert!(at <= 1.0, "{corners:?} at {uv:?}: {at}");
                compared += 1;
            }
        }
    }
    assert!(compared > CASES, "{compared}");
}

#[test]
fn needles_end_at_their_tips() {
    let mut rng = rng("needle");
    let (mut beyond, mut lines) = (0, 0);
    for _ in 0..CASES {
        let a = unit(&mut rng) * spread(&mut rng, -2, 3);
        let b = nearby(&mut rng, a, -5, -3);
        // of nearly no width: rounding alone decides where its lines meet
        let c = nearby(&mut rng, a + (b - a) * 0.75, -24, -16);
        let light = sized(&mut rng);
        let t = dpsm_triangle(a, b, c, light);
        let (tip, end) = (dpsm_project(a.widen()), dpsm_project(b.widen()));
        let texel = f64::from(dpsm_texel_width(light.size, light.guard));
        // beyond the margin, and the rounding that the span has more, twice
        let margin = DPSM_TRIANGLE_MARGIN * texel + 2.0 * DPSM_EDGE_ROUNDING;
        let out = (tip - end) / (tip - end).length();
        let uv = tip + out * (margin + texel * rng.f64());
        if t.span == Vec3::splat(0.0) || uv.length() > 1.5 {
            continue;
        }
        beyond += 1;
        assert!(!dpsm_triangle_covers(t, uv.narrow()), "{a:?} {b:?} {c:?} at {uv:?}");
        let open = DpsmTriangle { span: Vec3::splat(0.0), ..t };
        lines += usize::from(dpsm_triangle_covers(open, uv.narrow()));
    }
    println!("{beyond} points beyond a tip, {lines} within its lines");
    assert!(beyond > CASES / 2 && lines > CASES / 50, "{beyond} {lines}");
}

#[test]
fn what_rounding_covers_is_behind_the_neighbour() {
    let mut rng = rng("behind");
    let (mut rounded, mut in_front) = (0, 0);
    for _ in 0..CASES {
        let a = unit(&mut rng) * 4.0;
        let b = nearby(&mut rng, a, -6, -4);
        // nearly edge-on: the third corner towards the light from the edge
        let c = (a + (b - a) * rng.f32()) * (0.5 + 0.4 * rng.f32());
        let corners = [a, b, nearby(&mut rng, c, -18, -10), nearby(&mut rng, a, -6, -4)];
        let [a, b, c, d] = corners.map(Vec3::widen);
        let light = sized(&mut rng).widen();
        // in f64, where the planes are exact beside what DPSM_EDGE_ROUNDING allows
        let t = dpsm_triangle(a, b, c, light);
        let neighbour = dpsm_triangle(b, a, d, light);
        let along = a + (b - a) * rng.f64();
        let aside = unit(&mut rng).widen() * (along.length() * 32.0 * EPS);
        let uv = dpsm_project(along + aside);
        // outside of the shared edge, not of one that ends the triangle in front of all
        let shared = dpsm_edge_line(b, a).dot(dpsm_edge_terms(uv));
        let rounds = dpsm_triangle_covers(t, uv) && dpsm_triangle_inside(t, uv) < 0.0;
        let is_outside = shared > 0.0 && dpsm_triangle_inside(t, uv) >= -shared - 1e-14;
        if !rounds || !is_outside || uv.length() > 1.0 || dpsm_triangle_inside(neighbour, uv) < 0.0
        {
            continue;
        }
        rounded += 1;
        let there = dpsm_triangle_distance(neighbour.face, uv);
        let l = dpsm_triangle_distance(t.face, uv);
        // as far as the neighbour's own plane changes over as much
        let normal = (b - a).cross(d - a);
        let cosine = (normal.dot(a) / (normal.length() * a.length())).abs();
        let allowed = 2.0 * DPSM_EDGE_ROUNDING * there / cosine + 1e-12;
        in_front += usize::from(l < there - allowed);
        let behind = dpsm_triangle_behind(t, l);
        assert!(behind >= there - allowed, "{corners:?} {uv:?}: {behind} before {there}");
    }
    println!("{rounded} points by rounding, {in_front} of them in front of the neighbour");
    assert!(in_front > 100, "{rounded} {in_front}");
}
