//! Parts of large triangles: together the whole, each with a hull that holds it.
//! docs/classify.md.

mod common;

use common::exact::{Corners, direction, inside, meet, triangle};
use common::{CASES, EPS, light, rng};
use dpsm::scalar::caster::dpsm_caster_border;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::paraboloid::dpsm_project;
use dpsm::scalar::part::*;
use dpsm::scalar::triangle::*;

fn corners(part: DpsmPart<f32>) -> Corners {
    [part.a, part.b, part.c].map(Vec3::widen)
}

/// Least angle inside a part's planes, in its own turn; `None` where it has no area.
fn depth_inside([a, b, c]: Corners, d: Vec3<f64>) -> f64 {
    let turn = a.cross(b).dot(c).signum();
    let side = |p: Vec3<f64>, q: Vec3<f64>| turn * p.cross(q).dot(d) / p.cross(q).length();
    side(a, b).min(side(b, c)).min(side(c, a))
}

#[test]
fn halves_partition_their_triangle() {
    let mut rng = rng("halves");
    let (mut compared, mut corners_seen) = (0, 0);
    for _ in 0..CASES / 10 {
        let [a, b, c] = triangle(&mut rng);
        let wide = [a, b, c].map(Vec3::widen);
        let p = inside(&mut rng, wide);
        let Some(truth) = meet(wide, p / p.length()) else { continue };
        // as many halvings as corners stay accurate for: 12 eps each, over edges of 2^-6
        let deep = rng.u32(1..7);
        let whole = dpsm_part(a, b, c, 1);
        let narrow = corners(whole);
        let [i, j, k] = narrow;
        let small = i.cross(j).dot(k).abs() < 1e-3;
        if small || truth.inside < 1e-3 {
            continue;
        }
        let d = p / p.length();
        let band = 1e-4;
        let holders: Vec<_> = ((1 << deep)..(2 << deep))
            .filter_map(|path| {
                let depth = depth_inside(corners(dpsm_part(a, b, c, path)), d);
                (depth > -band).then_some(depth)
            })
            .collect();
        assert!(!holders.is_empty(), "{a:?} {b:?} {c:?}: no part holds {d:?} at {deep}");
        let certain = holders.iter().filter(|&&depth| depth > band).count();
        assert!(certain <= 1, "{a:?} {b:?} {c:?}: {certain} parts hold {d:?}");
        compared += 1;
        corners_seen += certain;
    }
    println!("{compared} directions, {corners_seen} in one part alone");
    assert!(compared > CASES / 100 && corners_seen > compared / 2);
}

#[test]
fn a_half_has_half_of_the_longest_edge() {
    let mut rng = rng("half");
    for _ in 0..CASES {
        let [a, b, c] = triangle(&mut rng);
        let part = dpsm_part(a, b, c, 1);
        let square = |p: Vec3<f32>, q: Vec3<f32>| (q - p).dot(q - p);
        let longest =
            square(part.a, part.b).max(square(part.b, part.c)).max(square(part.c, part.a));
        let (first, second) = (dpsm_part_half(part, false), dpsm_part_half(part, true));
        assert_eq!((first.a, first.c), (second.b, second.c), "the middle is shared");
        assert_eq!(square(second.a, first.b), longest, "{part:?}");
        let [from, to, middle] = [second.a, first.b, first.a].map(Vec3::widen);
        let cosine = 0.5 * (from + to).length();
        if cosine > 0.01 {
            let apart = ((middle - from).length() - (middle - to).length()).abs();
            assert!(apart <= 24.0 * EPS / cosine, "{part:?}: {apart:e}");
        }
    }
}

#[test]
fn no_part_is_culled_that_touches_the_stored_disk() {
    let mut rng = rng("kind");
    let mut kinds = [0; 5];
    for _ in 0..CASES {
        let ([a, b, c], light) = (triangle(&mut rng), light(&mut rng));
        let part = dpsm_part(a, b, c, rng.u32(1..64));
        let kind = dpsm_part_kind(part, light);
        kinds[kind as usize] += 1;
        if kind == DPSM_PART_OUTSIDE {
            let border = f64::from(dpsm_caster_border(light.guard));
            let p = inside(&mut rng, corners(part));
            let [on_edge, to, corner] = corners(part);
            let on_edge = on_edge + (to - on_edge) * rng.f64();
            for p in [p, on_edge, corner] {
                assert!(p.z / p.length() < border + 8.0 * EPS, "{part:?} {light:?} at {p:?}");
            }
        }
    }
    println!("{kinds:?}");
    assert!(
        [DPSM_PART_OUTSIDE, DPSM_PART_DRAWN, DPSM_PART_LARGE]
            .iter()
            .all(|&k| kinds[k as usize] > CASES / 50)
    );
}

fn holds(hull: DpsmHull<f32>, p: Vec2<f64>) -> bool {
    let [a, b, c] = [hull.a, hull.b, hull.c].map(Vec2::widen);
    let turn = |a: Vec2<f64>, b: Vec2<f64>| (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    let sides = [turn(a, b), turn(b, c), turn(c, a)];
    sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
}

/// Hulls of the parts that a map draws, and whether the halvings ran out.
fn hulls([a, b, c]: [Vec3<f32>; 3], light: DpsmLight<f32>) -> (Vec<DpsmHull<f32>>, bool) {
    let (mut paths, mut found) = (vec![1], Vec::new());
    while let Some(path) = paths.pop() {
        let part = dpsm_part(a, b, c, path);
        match dpsm_part_kind(part, light) {
            DPSM_PART_LARGE if path >= 1 << 20 => return (found, true),
            DPSM_PART_LARGE => paths.extend([2 * path, 2 * path + 1]),
            DPSM_PART_DRAWN => found.push(dpsm_triangle_hull(part.a, part.b, part.c, light)),
            _ => {}
        }
    }
    (found, false)
}

#[test]
fn hulls_of_the_parts_hold_every_covered_point() {
    let mut rng = rng("hulls");
    let (mut compared, mut parts, mut given_up) = (0, 0, 0);
    for _ in 0..CASES / 100 {
        let triangle = triangle(&mut rng);
        let light = DpsmLight { size: 256.0, ..light(&mut rng) };
        let (hulls, deepest) = hulls(triangle, light);
        given_up += usize::from(deepest);
        parts += hulls.len();
        let border = f64::from(dpsm_caster_border(light.guard));
        let wide = triangle.map(Vec3::widen);
        for _ in 0..if deepest { 0 } else { 200 } {
            let p = inside(&mut rng, wide);
            let clear = meet(wide, p / p.length()).is_some_and(|m| m.inside > m.band);
            if !clear || p.z / p.length() < border {
                continue;
            }
            compared += 1;
            let uv = dpsm_project(direction(dpsm_project(p)));
            let held = hulls.iter().any(|&hull| holds(hull, uv));
            assert!(held, "{triangle:?} {light:?}: {uv:?} is in no hull of {}", hulls.len());
        }
    }
    println!("{compared} points, {parts} parts, {given_up} triangles given up");
    assert!(compared > CASES / 10 && given_up < CASES / 10_000, "{compared} {given_up}");
}
