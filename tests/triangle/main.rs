//! Coverage, distance and hulls of triangles against rays and planes in f64: docs/triangle.md.

#[path = "../common/mod.rs"]
mod common;
mod span;

use common::exact::{about, direction, inside, meet, triangle};
use common::{CASES, EPS, Worst, light, nearby, rng, spread, uniform, unit};
use dpsm::scalar::caster::dpsm_caster_border;
use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::edge::DPSM_EDGE_ROUNDING;
use dpsm::scalar::float::{Float, Vec2, Vec3};
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::paraboloid::{dpsm_project, dpsm_texel_width};
use dpsm::scalar::triangle::*;

/// Where a direction is on the disk, within r = 2, rounded to f32.
fn on_disk(p: Vec3<f64>) -> Option<Vec2<f32>> {
    let uv = dpsm_project(p).narrow();
    (uv.length() <= 2.0).then_some(uv)
}

/// Where and how the port's coverage differs from the exact one, beyond rounding.
fn coverage<T: Float>(convert: impl Fn(f32) -> T, name: &str) {
    let mut rng = rng(name);
    let light = dpsm::cases::light(0);
    let light = DpsmLight {
        position: Vec3::splat(convert(0.0)),
        near: convert(light.near),
        right: Vec3::splat(convert(0.0)),
        far: convert(light.far),
        up: Vec3::splat(convert(0.0)),
        guard: convert(light.guard),
        forward: Vec3::splat(convert(0.0)),
        size: convert(light.size),
        rectangle: Vec3::splat(convert(0.0)).extend(convert(0.0)),
        first_layer: 0,
        placement: 0,
        hemispheres: 2,
        reversed: 0,
    };
    let (mut compared, mut covered, mut mismatches) = (0, 0, 0);
    for _ in 0..2 * CASES {
        let corners = triangle(&mut rng);
        let [a, b, c] = corners.map(|p| Vec3::new(convert(p.x), convert(p.y), convert(p.z)));
        let wide = corners.map(Vec3::widen);
        let p = about(&mut rng, wide);
        let Some(uv) = on_disk(if rng.u8(0..8) == 0 { unit(&mut rng).widen() } else { p }) else {
            continue;
        };
        let Some(truth) = meet(wide, direction(uv.widen())) else { continue };
        // from radians to the disk, the growth, and 6 eps (1 + r^2) for the three products
        let scale = 0.5 * (1.0 + uv.widen().dot(uv.widen()));
        let band = scale * (truth.band + 12.0 * EPS) + DPSM_EDGE_ROUNDING;
        if (scale * truth.inside).abs() <= band {
            continue;
        }
        let prepared = dpsm_triangle(a, b, c, light);
        let found = dpsm_triangle_covers(prepared, Vec2::new(convert(uv.x), convert(uv.y)));
        compared += 1;
        covered += usize::from(truth.inside > 0.0);
        let same = found == (truth.inside > 0.0);
        if !same {
            println!("{corners:?} at {uv:?}: {found:?}, {truth:?}");
        }
        mismatches += usize::from(!same);
    }
    println!("{name}: {mismatches} of {compared} differ, {covered} covered");
    assert_eq!(mismatches, 0);
    assert!(compared > CASES && covered > CASES / 4 && covered < compared * 3 / 4);
}

#[test]
fn coverage_is_that_of_rays_in_single_precision() {
    coverage(|x| x, "coverage");
}

#[test]
fn coverage_is_that_of_rays_in_double_precision() {
    coverage(f64::from, "coverage in double precision");
}

#[test]
fn distance_stays_within_its_bound_of_the_plane() {
    let mut rng = rng("distance");
    let mut worst = Worst::default();
    let mut compared = 0;
    for _ in 0..CASES {
        let corners = triangle(&mut rng);
        let [a, b, c] = corners;
        let wide = corners.map(Vec3::widen);
        let Some(uv) = on_disk(inside(&mut rng, wide)) else { continue };
        let Some(truth) = meet(wide, direction(uv.widen())) else { continue };
        let farthest = wide.iter().map(|p| p.length()).fold(0.0, f64::max);
        // beyond the farthest vertex the distance is held there
        if truth.inside <= 0.0 || truth.cosine < 1e-4 || truth.distance > farthest {
            continue;
        }
        let sine = sine_of(wide);
        let t = dpsm_triangle(a, b, c, dpsm::cases::light(0));
        let error = f64::from(dpsm_triangle_distance(t.face, uv)) - truth.distance;
        let bound = distance_bound(sine, farthest, truth.distance, truth.cosine);
        if bound > 0.1 * truth.distance {
            continue; // first order no more
        }
        worst.note(error.abs(), bound, (corners, uv));
        compared += 1;
    }
    println!("{compared} of {CASES} compared");
    assert!(compared > CASES / 3);
    worst.check("dpsm_triangle_distance");
}

/// docs/triangle.md: the plane's 24 eps of the farthest vertex over the sine of the angle between
/// the shorter edges, and the 16 eps of the two products, all over the cosine.
fn distance_bound(sine: f64, farthest: f64, distance: f64, cosine: f64) -> f64 {
    (24.0 * farthest / sine + 16.0 * distance) * EPS / cosine
}

/// Sine of the angle between the two shorter edges.
fn sine_of([a, b, c]: [Vec3<f64>; 3]) -> f64 {
    let mut lengths = [(b - a).length(), (c - b).length(), (a - c).length()];
    lengths.sort_by(f64::total_cmp);
    (b - a).cross(c - a).length() / (lengths[0] * lengths[1])
}

#[test]
fn fragments_are_cut_by_the_disk_and_the_spheres_and_carry_the_depth() {
    let mut rng = rng("fragment");
    let mut kept = 0;
    for _ in 0..CASES {
        let ([a, b, c], light) = (triangle(&mut rng), light(&mut rng));
        let Some(uv) = on_disk(about(&mut rng, [a, b, c].map(Vec3::widen))) else { continue };
        let (t, bias) = (dpsm_triangle(a, b, c, light), rng.f32());
        let fragment = dpsm_triangle_fragment(t, uv, light, bias);
        let mut l = dpsm_triangle_distance(t.face, uv);
        if dpsm_triangle_inside(t, uv) < 0.0 {
            l = dpsm_triangle_behind(t, l);
        }
        assert_eq!(fragment.depth, dpsm_depth(l, light.near, light.far) + bias);
        let r = uv.widen().length();
        let rim = 1.0 + f64::from(light.guard);
        // 4 eps for the squares
        if (r - rim).abs() > 4.0 * EPS * rim {
            let clipped = l < light.near || l > light.far || r > rim;
            assert_eq!(fragment.keep, !clipped && dpsm_triangle_covers(t, uv));
        }
        kept += usize::from(fragment.keep);
    }
    assert!(kept > CASES / 20, "{kept}");
}

#[test]
fn disk_coordinates_of_a_fragment_are_those_of_its_texel() {
    let light = dpsm::cases::light(0);
    let texel = dpsm_texel_width(light.size, light.guard);
    let at = |x, y| dpsm_triangle_disk(Vec2::new(x, y), Vec2::splat(0.5 * light.size), texel);
    assert_eq!(at(256.0, 256.0), Vec2::new(0.0, 0.0));
    let corner = at(0.0, 0.0);
    let rim = f64::from(1.0 + light.guard);
    assert!((f64::from(corner.x) + rim).abs() <= 5.0 * EPS * rim, "{corner:?}");
    assert!(corner.y > 0.0, "up is up");
}

#[test]
fn neighbours_leave_no_hole_between_them() {
    let mut rng = rng("watertight");
    let light = dpsm::cases::light(0);
    for _ in 0..CASES {
        let [a, b, c] = triangle(&mut rng);
        let (wide_a, wide_b, wide_c) = (a.widen(), b.widen(), c.widen());
        let d = a + b - c;
        let along = wide_a + (wide_b - wide_a) * (0.1 + 0.8 * rng.f64());
        let Some(uv) = on_disk(along) else { continue };
        let direction = direction(uv.widen());
        let Some(here) = meet([wide_a, wide_b, wide_c], direction) else { continue };
        let Some(there) = meet([wide_b, wide_a, d.widen()], direction) else { continue };
        // clear of the other edges: the shared one alone decides
        let far = |p: Vec3<f64>, q: Vec3<f64>, m: &common::exact::Meeting| {
            let plane = p.cross(q - p);
            (plane.dot(direction) / plane.length()).abs() > m.band + 2.0 * DPSM_EDGE_ROUNDING
        };
        let clear = far(wide_b, wide_c, &here)
            && far(wide_c, wide_a, &here)
            && far(wide_a, d.widen(), &there)
            && far(d.widen(), wide_b, &there);
        if !clear {
            continue;
        }
        let first = dpsm_triangle_covers(dpsm_triangle(a, b, c, light), uv);
        let second = dpsm_triangle_covers(dpsm_triangle(b, a, d, light), uv);
        assert!(first || second, "{a:?} {b:?} {c:?} at {uv:?}");
    }
}

#[test]
fn weights_find_the_point_of_the_plane() {
    let mut rng = rng("weights");
    for _ in 0..CASES {
        let corners = triangle(&mut rng).map(Vec3::widen);
        let p = inside(&mut rng, corners);
        let Some(truth) = meet(corners, p / p.length()) else { continue };
        let uv = dpsm_project(p);
        if uv.length() > 4.0 || truth.cosine < 1e-4 {
            continue;
        }
        let [a, b, c] = corners;
        let w = dpsm_triangle_weights(a, b, c, uv);
        let found = a * w.x + b * w.y + c * w.z;
        // f64's share of the bound at heights of 2^-16 of the triangle, with room for its size
        let allowed = 1e-6 * p.length() / truth.cosine;
        assert!((w.x + w.y + w.z - 1.0).abs() < 1e-9, "{corners:?}: {w:?}");
        assert!((found - p).length() <= allowed, "{corners:?}: {found:?} for {p:?}");
    }
    let (a, b) = (Vec3::new(1.0_f32, 0.0, 1.0), Vec3::new(0.0, 0.0, 2.0));
    let edge_on = dpsm_triangle_weights(a, b, a + b, Vec2::new(0.5, 0.0));
    assert_eq!(edge_on, Vec3::new(1.0, 0.0, 0.0));
}

/// Twice the signed area of three disk points.
fn turn(a: Vec2<f64>, b: Vec2<f64>, p: Vec2<f64>) -> f64 {
    (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)
}

fn holds(hull: DpsmHull<f32>, p: Vec2<f64>) -> bool {
    let [a, b, c] = [hull.a, hull.b, hull.c].map(Vec2::widen);
    let sides = [turn(a, b, p), turn(b, c, p), turn(c, a, p)];
    sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
}

#[test]
fn hull_holds_every_covered_point() {
    let mut rng = rng("hull");
    let (mut compared, mut wasted) = (0, 0.0);
    for _ in 0..CASES {
        let corners = triangle(&mut rng);
        let [a, b, c] = corners;
        let size = (1 << rng.u32(5..13)) as f32;
        let light = DpsmLight { size, ..light(&mut rng) };
        let hull = dpsm_triangle_hull(a, b, c, light);
        // edges and corners show it first
        let on_edge = a.widen() + (b.widen() - a.widen()) * rng.f64();
        for p in [inside(&mut rng, corners.map(Vec3::widen)), on_edge, a.widen()] {
            let uv = dpsm_project(p);
            let stored = p.z >= p.length() * dpsm_caster_border(f64::from(light.guard));
            if !stored {
                continue;
            }
            compared += 1;
            assert!(holds(hull, uv), "{corners:?} at {uv:?}, size {size}: {hull:?}");
        }
        let [p, q, r] = [a, b, c].map(|p| dpsm_project(p.widen()));
        let longest = [q - p, r - q, p - r].map(|e| e.length()).into_iter().fold(0.0, f64::max);
        let texel = f64::from(dpsm_texel_width(light.size, light.guard));
        if longest <= DPSM_TRIANGLE_CHORD && longest > texel {
            let [i, j, k] = [hull.a, hull.b, hull.c].map(Vec2::widen);
            let area = 0.5 * turn(i, j, k).abs();
            // a rectangle around the longest chord, doubled, each side widened by the bows
            wasted = f64::max(wasted, area / (longest * longest));
        }
    }
    println!("{compared} points, hulls up to {wasted:.2} times the longest chord's square");
    assert!(compared > CASES && wasted < 1.0, "{compared} {wasted}");
}

#[test]
fn degenerate_triangles_are_finite_and_cover_next_to_nothing() {
    let mut rng = rng("degenerate");
    let light = dpsm::cases::light(0);
    let zero = Vec3::splat(0.0_f32);
    for _ in 0..CASES / 20 {
        let a = unit(&mut rng) * spread(&mut rng, -4, 4);
        let b = nearby(&mut rng, a, -6, 1);
        let flat = [[a, a, a], [a, a, b], [zero, a, b], [zero, zero, a], [a, a + a, b], [zero; 3]];
        for [a, b, c] in flat {
            let t = dpsm_triangle(a, b, c, light);
            let uv = Vec2::new(uniform(&mut rng, -1.0, 1.0), uniform(&mut rng, -1.0, 1.0));
            assert!(dpsm_triangle_distance(t.face, uv).is_finite(), "{a:?} {b:?} {c:?}: {t:?}");
            let hull = dpsm_triangle_hull(a, b, c, light);
            for corner in [hull.a, hull.b, hull.c] {
                assert!(corner.length().is_finite(), "{a:?} {b:?} {c:?}: {hull:?}");
            }
            let weights = dpsm_triangle_weights(a, b, c, uv);
            assert!(weights.length().is_finite(), "{a:?} {b:?} {c:?}: {weights:?}");
        }
    }
}
