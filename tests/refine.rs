//! Refinement: edges within their reach, parts that tile their triangle, nothing lost at the rim, and
//! no more work than is bounded. docs/refine.md.

#![cfg(feature = "scene")]

mod common;

use common::exact::{direction, triangle};
use common::{CASES, EPS, light, nearby, rng, spread, unit};
use dpsm::cpu::{Leaf, leaves};
use dpsm::render::{Frame, Method, Settings, refinement_levels};
use dpsm::scalar::classify::{DpsmProjected, dpsm_projected};
use dpsm::scalar::edge::DPSM_EDGE_SNAP;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::paraboloid::{dpsm_project, dpsm_texel_width};
use dpsm::scalar::refine::*;
use dpsm::scalar::triangle::{DPSM_TRIANGLE_CHORD, DpsmHull, dpsm_triangle_plane};
use dpsm::scene::{Camera, Mesh, Scene};
use fastrand::Rng;
use glam::vec3;

/// A light with a map of any usual size.
fn sized(rng: &mut Rng) -> DpsmLight<f32> {
    DpsmLight { size: (1 << rng.u32(6..13)) as f32, guard: 0.25 * rng.f32(), ..light(rng) }
}

/// An edge in the front map, of any length.
fn edge(rng: &mut Rng) -> [Vec3<f32>; 2] {
    let a = unit(rng) * spread(rng, -4, 4).abs();
    let b = if rng.bool() { nearby(rng, a, -10, 0) } else { unit(rng) * spread(rng, -4, 4).abs() };
    [a, b].map(|p| Vec3::new(p.x, p.y, p.z.abs() + 1e-3 * p.length()))
}

#[test]
fn the_point_of_an_edge_halves_its_angle_and_is_the_same_for_swapped_ends() {
    let mut rng = rng("point");
    for _ in 0..CASES {
        let [a, b] = edge(&mut rng);
        let p = dpsm_refine_point(a, b);
        let bits = |v: Vec3<f32>| [v.x, v.y, v.z].map(f32::to_bits);
        assert_eq!(bits(p), bits(dpsm_refine_point(b, a)), "{a:?} {b:?}");
        let (a, b) = (a.widen(), b.widen());
        let exact = dpsm_refine_point(a, b);
        let allowed = 28.0 * EPS * a.length().min(b.length());
        let off = (p.widen() - exact).length();
        assert!(off <= 3f64.sqrt() * allowed, "{a:?} {b:?}: {off:e} of {allowed:e}");
        let angle = |v: Vec3<f64>, w: Vec3<f64>| v.cross(w).length().atan2(v.dot(w));
        let (left, right) = (angle(a, exact), angle(exact, b));
        assert!((left - right).abs() < 1e-6, "{a:?} {b:?}: {left} {right}");
    }
}

/// How far an edge's arc goes from its chord on the disk, at 64 points of it.
fn bow([a, b]: [Vec3<f64>; 2]) -> f64 {
    let (from, to) = (dpsm_project(a), dpsm_project(b));
    let along = to - from;
    let (a, b) = (a / a.length(), b / b.length());
    let away = |i: i32| {
        let t = f64::from(i) / 64.0;
        let p = dpsm_project(a * (1.0 - t) + b * t) - from;
        (p.x * along.y - p.y * along.x).abs() / along.length()
    };
    (1..64).map(away).fold(0.0, f64::max)
}

#[test]
fn edges_that_are_not_split_are_within_tau_of_their_arcs() {
    let mut rng = rng("reach");
    let (mut kept, mut split, mut near) = (0, 0, 0.0_f64);
    for _ in 0..CASES {
        let ([a, b], light) = (edge(&mut rng), sized(&mut rng));
        let tau = 0.02 + rng.f32();
        let reach = dpsm_refine_reach(light, tau);
        let [from, to] = [a, b].map(dpsm_projected);
        let is_split = dpsm_refine_splits(from, to, reach);
        assert_eq!(is_split, dpsm_refine_splits(to, from, reach), "{a:?} {b:?}");
        let chord = (to.uv - from.uv).widen().length();
        if is_split {
            split += 1;
            // for a reason
            let most = bow([a.widen(), b.widen()]);
            let half = f64::from(reach) * 0.999 - 64.0 * EPS;
            assert!(chord > DPSM_TRIANGLE_CHORD * 0.999 || most > half, "{a:?} {b:?} {tau}");
            continue;
        }
        assert!(chord <= DPSM_TRIANGLE_CHORD * 1.001);
        if chord > 1e-5 {
            kept += 1;
            let texel = f64::from(dpsm_texel_width(light.size, light.guard));
            let allowed = (f64::from(tau) - DPSM_EDGE_SNAP) * texel;
            let bow = bow([a.widen(), b.widen()]);
            assert!(bow <= allowed + 64.0 * EPS, "{a:?} {b:?} {tau}: {bow:e} of {allowed:e}");
            near = near.max(bow / allowed);
        }
    }
    println!("{kept} kept, up to {near:.3} of tau, {split} split");
    assert!(kept > CASES / 10 && split > CASES / 10 && near > 0.9);
}

#[test]
fn parts_tile_their_triangle_and_their_edges_are_known() {
    let corner = [[0.0, 0.0], [1.0, 0.1], [0.2, 0.9]].map(|[x, y]| Vec2::new(x, y));
    let at = |corner_number: u32| match corner_number {
        number @ 0..3 => corner[number as usize],
        number => {
            let edge = number as usize - 3;
            (corner[edge] + corner[(edge + 1) % 3]) * 0.5
        }
    };
    let area = |[a, b, c]: [Vec2<f64>; 3]| {
        let (ab, ac) = (b - a, c - a);
        ab.x * ac.y - ab.y * ac.x
    };
    for split in 1..8_u32 {
        for crossed in [false, true] {
            let count = split.count_ones() + 1;
            let mut covered = 0.0;
            let mut sides = Vec::new();
            for part in 0..count {
                let corners = dpsm_refine_corners(split, part, crossed);
                let own = area(corners.map(at));
                assert!(own > 0.0, "{split} {part} {crossed}: {corners:?} turns");
                covered += own;
                for k in 0..3 {
                    let (a, b) = (corners[k], corners[(k + 1) % 3]);
                    let edge = dpsm_refine_edge(a, b);
                    assert_eq!(edge, dpsm_refine_edge(b, a));
                    match edge {
                        0..3 => assert!(split >> edge & 1 == 0, "{edge} is split"),
                        3..6 => assert!(split >> (edge - 3) & 1 == 1, "{edge} is not split"),
                        _ => {}
                    }
                    sides.push((a.min(b), a.max(b), edge));
                }
            }
            assert!((covered - area(corner)).abs() < 1e-12, "{split} {crossed}: {covered}");
            // inner edges have two parts, others one
            for &(a, b, edge) in &sides {
                let times = sides.iter().filter(|(c, d, _)| (*c, *d) == (a, b)).count();
                let inner = edge == DPSM_REFINE_INNER;
                assert_eq!(times, if inner { 2 } else { 1 }, "{split} {crossed}: {a} {b}");
            }
        }
    }
}

#[test]
fn needles_are_not_fat_and_wide_parts_are() {
    let seen = |corners: [[f32; 3]; 3]| corners.map(|[x, y, z]| dpsm_projected(Vec3::new(x, y, z)));
    let fat = |[a, b, c]: [DpsmProjected<f32>; 3], halves| dpsm_refine_fat(a, b, c, halves);
    let wide = seen([[0.0, 0.0, 1.0], [0.2, 0.0, 1.0], [0.0, 0.2, 1.0]]);
    let needle = seen([[0.0, 0.0, 1.0], [0.4, 0.0, 1.0], [0.2, 0.001, 1.0]]);
    assert!(fat(wide, 1) && fat(wide, 7) && fat(needle, 0));
    assert!(!fat(needle, 1) && !fat(needle, 2));
    // wide as it is, a side spans 130 degrees
    let vast = seen([[1.0, 0.0, 0.0], [-0.643, 0.766, 0.0], [0.0, 0.0, 1.0]]);
    assert!(!fat(vast, 1));
    let less = seen([[1.0, 0.0, 0.0], [-0.5, 0.866, 0.0], [0.0, 0.0, 1.0]]);
    assert!(fat(less, 1));
    // along one great circle, but for a hundredth
    let circle = seen([[1.0, 0.0, 0.01], [0.643, 0.766, 0.01], [-0.174, 0.985, 0.01]]);
    assert!(!fat(circle, 1) && !fat(circle, 4));
}

#[test]
fn what_is_outside_the_stored_disk_touches_no_texel() {
    let mut rng = rng("outside");
    let mut outside = 0;
    for _ in 0..CASES {
        let light = sized(&mut rng);
        let corners = triangle(&mut rng);
        let [a, b, c] = corners.map(dpsm_project);
        if !dpsm_refine_outside(a, b, c, light) {
            continue;
        }
        outside += 1;
        let rim = 1.0 + f64::from(light.guard);
        let rim = rim + f64::from(dpsm_texel_width(light.size, light.guard));
        // the arcs, and chords that are not split
        for (p, q) in [(0, 1), (1, 2), (2, 0)] {
            let (a, b) = (corners[p].widen(), corners[q].widen());
            let (from, to) = (dpsm_project(a), dpsm_project(b));
            for i in 0..=16 {
                let t = f64::from(i) / 16.0;
                let mixed = a / a.length() * (1.0 - t) + b / b.length() * t;
                assert!(dpsm_project(mixed).length() > rim, "{corners:?} {light:?}");
                let drawn = from * (1.0 - t) + to * t;
                if (to - from).length() <= DPSM_TRIANGLE_CHORD {
                    assert!(drawn.length() > rim, "{corners:?} {light:?}");
                }
            }
        }
    }
    assert!(outside > CASES / 50, "{outside}");
}

/// A frame of one mesh around a light at the origin that looks along -z or z.
fn frame(triangles: &[[Vec3<f32>; 3]], settings: Settings) -> Frame {
    let positions: Vec<_> = triangles.iter().flatten().map(|p| vec3(p.x, p.y, p.z)).collect();
    let count = positions.len() as u32 / 3;
    let mesh = Mesh {
        name: "made".into(),
        normals: vec![glam::Vec3::Y; positions.len()],
        positions,
        triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..Mesh::default()
    };
    let (name, origin, lights, camera, warnings) = Default::default();
    let scene = Scene { name, origin, meshes: vec![mesh], lights, camera, warnings };
    let camera = Camera {
        eye: vec3(0.0, 5.0, 0.1),
        target: glam::Vec3::ZERO,
        up: glam::Vec3::Z,
        vertical_fov: 1.0,
    };
    let settings = Settings { method: Method::Refined, image: [16, 16], ..settings };
    // some are so small that far would be nearer than near
    let settings = Settings { far: settings.far.or(Some(1e3)), ..settings };
    Frame::new(&scene, glam::Vec3::ZERO, glam::Vec3::Z, false, &camera, settings).unwrap()
}

/// Where a frame's light sees its triangle from.
fn placed(frame: &Frame) -> [Vec3<f64>; 3] {
    let light = frame.light;
    std::array::from_fn(|i| {
        let p = frame.vertices[i].position;
        let p = Vec3::new(p.x, p.y, p.z) - light.position;
        Vec3::new(light.right.dot(p), light.up.dot(p), light.forward.dot(p)).widen()
    })
}

fn covers(leaf: &Leaf, uv: Vec2<f64>, slack: f64) -> bool {
    let [a, b, c] = leaf.corners.map(|corner| corner.uv.widen());
    let side = |p: Vec2<f64>, q: Vec2<f64>| {
        let (along, to) = (q - p, uv - p);
        (along.x * to.y - along.y * to.x) / along.length().max(1e-30)
    };
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|&s| s >= -slack) || sides.iter().all(|&s| s <= slack)
}

#[test]
fn leaves_cover_their_triangle_and_little_more() {
    let mut rng = rng("leaves");
    let (mut inside, mut outside, mut all) = (0, 0, 0);
    for round in 0..600 {
        let corners = match round % 4 {
            0 => triangle(&mut rng),
            // walls: seen at wide angles
            1 => [0; 3].map(|_| unit(&mut rng) * spread(&mut rng, -1, 1).abs()),
            // planes that pass close to the light, with its foot inside or outside
            2 => {
                let (up, height) = (unit(&mut rng), spread(&mut rng, -18, -5));
                let aside = unit(&mut rng) * if rng.bool() { 0.0 } else { 1.5 };
                let flat = |p: Vec3<f32>| p - up * up.dot(p) + up * height;
                let size = spread(&mut rng, -1, 2).abs();
                [0; 3].map(|_| flat((unit(&mut rng) + aside) * size))
            }
            // needles
            _ => {
                let [a, b] = [0; 2].map(|_| unit(&mut rng));
                let middle = a + (b - a) * rng.f32();
                [a, b, middle + unit(&mut rng) * spread(&mut rng, -10, -6).abs()]
            }
        };
        let size = 1 << rng.u32(6..11);
        let frame = frame(&[corners], Settings { size, tau: 0.25, ..Settings::default() });
        let light = frame.light;
        let texel = f64::from(dpsm_texel_width(light.size, light.guard));
        let placed = placed(&frame);
        for map in 0..2 {
            let leaves = leaves(&frame, map, 0..1);
            all += leaves.len();
            let flip = |p: Vec3<f64>| if map == 0 { p } else { Vec3::new(p.x, p.y, -p.z) };
            let [a, b, c] = placed.map(flip);
            let normal = (b - a).cross(c - a);
            let sign = normal.dot(a).signum();
            let edges = [(a, b), (b, c), (c, a)];
            for _ in 0..200 {
                // texel centres alone are drawn
                let pick = |rng: &mut Rng| (f64::from(rng.u32(0..size)) + 0.5) * texel;
                let half = 0.5 * f64::from(light.size) * texel;
                let uv = Vec2::new(pick(&mut rng) - half, pick(&mut rng) - half);
                if uv.length() > 1.0 + f64::from(light.guard) {
                    continue;
                }
                // how far inside on the disk, to first order
                let d = direction(uv);
                let scale = 0.5 * (1.0 + uv.dot(uv));
                let side = |(p, q): (Vec3<f64>, Vec3<f64>)| {
                    let n = p.cross(q);
                    sign * scale * n.dot(d) / n.length()
                };
                let least = edges.into_iter().map(side).fold(f64::INFINITY, f64::min);
                let in_front = sign * normal.dot(d) > 0.0;
                let tau = 0.25 * texel + 1e-5;
                if least > 1.05 * tau && in_front {
                    inside += 1;
                    let hit = leaves.iter().any(|leaf| covers(leaf, uv, 1e-6));
                    assert!(hit, "{corners:?} map {map} {uv:?} {size}: a hole, {least:e}");
                }
                let far = least < -1.1 * tau - 1e-4;
                if far && (least > -0.2 || !in_front) {
                    outside += 1;
                    let hit = leaves.iter().find(|leaf| covers(leaf, uv, -1e-6));
                    // at an acute corner chords that are moved by tau meet farther out
                    let close = placed.map(flip).map(dpsm_project);
                    let corner = close.iter().any(|p| (*p - uv).length() < 64.0 * texel);
                    assert!(hit.is_none() || corner, "{corners:?} {map} {uv:?} {size}: {least:e}");
                }
            }
        }
    }
    println!("{inside} inside, {outside} outside, {all} leaves");
    assert!(inside > 2000 && outside > 10_000);
}

/// The least distance of a triangle's points.
fn nearest_point([a, b, c]: [Vec3<f64>; 3]) -> f64 {
    let steps = 64;
    let at = |i: i32, j: i32| {
        let [s, t] = [i, j].map(|k| f64::from(k) / f64::from(steps));
        (a * (1.0 - s - t) + b * s + c * t).length()
    };
    let all = (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| (i, j)));
    all.map(|(i, j)| at(i, j)).fold(f64::INFINITY, f64::min)
}

#[test]
fn planes_seen_edge_on_are_no_nearer_than_their_triangles() {
    let mut rng = rng("edge-on");
    let mut stored = 0;
    for _ in 0..3000 {
        // in a plane that passes beside the light by 1/1000, all of it on one side
        let across = unit(&mut rng);
        let along = across.cross(unit(&mut rng));
        let along = along / along.length();
        let aside = across.cross(along);
        let point = |rng: &mut Rng| {
            across * 1e-3 + along * (2.0 + rng.f32()) + aside * (2.0 * rng.f32() - 1.0)
        };
        let corners = [0; 3].map(|_| point(&mut rng));
        let frame = frame(&[corners], Settings { size: 64, far: Some(8.0), ..Settings::default() });
        let least = nearest_point(placed(&frame)) * 0.98;
        let maps = dpsm::cpu::make_maps(&frame).unwrap();
        for depth in maps.depths.iter().filter(|&&depth| depth < 1.0) {
            stored += 1;
            let l = f64::from(*depth) * f64::from(frame.light.far);
            assert!(l >= least, "{corners:?}: {l} of {least}");
        }
    }
    println!("{stored} texels");
    assert!(stored > 100, "{stored}");
}

#[test]
fn lights_close_to_a_surface_see_it_on_its_side_alone() {
    let mut rng = rng("flush");
    let (mut seen, mut over) = (0, 0);
    for _ in 0..300 {
        let (up, height) = (unit(&mut rng), spread(&mut rng, -20, -8).abs());
        // around the light
        let right = up.cross(unit(&mut rng));
        let right = right / right.length();
        let other = up.cross(right);
        let corner = |turn: f32| {
            let angle = turn * std::f32::consts::TAU;
            right * angle.cos() + other * angle.sin() + up * height
        };
        let turn = rng.f32();
        let corners = [0.0, 1.0 / 3.0, 2.0 / 3.0]
            .map(|third| corner(turn + third + 0.1 * rng.f32()) * (0.5 + rng.f32()));
        let corners = corners.map(|p| p - up * up.dot(p) + up * height);
        let frame = frame(&[corners], Settings { size: 128, ..Settings::default() });
        let texel = f64::from(dpsm_texel_width(frame.light.size, frame.light.guard));
        let placed = placed(&frame);
        let normal = (placed[1] - placed[0]).cross(placed[2] - placed[0]);
        let normal = normal / normal.length() * normal.dot(placed[0]).signum();
        for map in 0..2 {
            let leaves = leaves(&frame, map, 0..1);
            for i in 0..128 * 128 {
                let at = |k: i32| (f64::from(k) - 63.5) * texel;
                let uv = Vec2::new(at(i % 128), at(i / 128));
                if uv.length() > 1.0 {
                    continue;
                }
                let d = direction(uv);
                let d = if map == 0 { d } else { Vec3::new(d.x, d.y, -d.z) };
                // how far above the plane's horizon, in texels
                let above = normal.dot(d) * 0.5 * (1.0 + uv.dot(uv)) / texel;
                let hit = leaves.iter().any(|leaf| covers(leaf, uv, 0.0));
                seen += usize::from(hit);
                over += usize::from(hit && above < -1.0);
                assert!(hit || above < 4.0, "{corners:?} {map} {uv:?}: a hole {above} above");
            }
        }
    }
    println!("{seen} texels, {over} below the horizon");
    assert!(seen > 1_000_000 && over == 0, "{seen} {over}");
}

#[test]
fn neighbours_share_the_points_that_split_their_edge() {
    let mut rng = rng("shared");
    let mut shared = 0;
    for _ in 0..200 {
        let [a, b, c] = [0; 3].map(|_| unit(&mut rng) * spread(&mut rng, -1, 1).abs());
        let d = a + b - c;
        let frame = frame(&[[a, b, c], [b, a, d]], Settings { size: 512, ..Settings::default() });
        for map in 0..2 {
            let all = leaves(&frame, map, 0..2);
            let on_edge = |triangle: u32| {
                let mut points: Vec<[u32; 3]> = all
                    .iter()
                    .filter(|leaf| leaf.triangle == triangle)
                    .flat_map(|leaf| leaf.corners)
                    .filter(|at| {
                        // on the segment from a to b, in light space
                        let [p, q] = [0, 1].map(|i| {
                            let light = frame.light;
                            let p = frame.vertices[i].position;
                            let p = Vec3::new(p.x, p.y, p.z) - light.position;
                            let z = light.forward.dot(p);
                            let z = if map == 0 { z } else { -z };
                            Vec3::new(light.right.dot(p), light.up.dot(p), z)
                        });
                        let (along, to) = (q - p, at.p - p);
                        let off = along.cross(to).length() / along.length();
                        off < 1e-6 * (p.length() + q.length())
                    })
                    .map(|at| [at.p.x, at.p.y, at.p.z].map(f32::to_bits))
                    .collect();
                points.sort();
                points.dedup();
                points
            };
            let (here, there) = (on_edge(0), on_edge(1));
            // a triangle that reaches the disk elsewhere may have dropped parts that another kept:
            // what both have is the same
            let both = here.iter().filter(|point| there.contains(point)).count();
            shared += both;
            let fewer = here.len().min(there.len());
            assert!(both + 2 >= fewer, "{a:?} {b:?} {c:?}: {both} of {fewer}");
        }
    }
    assert!(shared > 1000, "{shared}");
}

#[test]
fn flat_leaves_are_within_their_tolerance_or_tau_along_their_plane() {
    let mut rng = rng("flat");
    let mut flat = 0;
    for _ in 0..CASES / 4 {
        let a = unit(&mut rng);
        let a = Vec3::new(a.x, a.y, a.z.abs());
        let corners = [a, nearby(&mut rng, a, -9, -1), nearby(&mut rng, a, -9, -1)];
        let seen = corners.map(dpsm_projected);
        let hull = DpsmHull { a: seen[0].uv, b: seen[1].uv, c: seen[2].uv };
        let plane = dpsm_triangle_plane(corners[0], corners[1], corners[2]);
        let distances = Vec3::new(seen[0].distance, seen[1].distance, seen[2].distance);
        let [reach, tolerance] = [1e-3 * rng.f32(), spread(&mut rng, -13, -8).abs()];
        if !dpsm_refine_flat(hull, distances, plane, reach, tolerance) || plane.w.abs() < 1e-3 {
            continue;
        }
        flat += 1;
        let normal = plane.xyz().widen();
        let there = |uv: Vec2<f64>| f64::from(plane.w) / normal.dot(direction(uv));
        for _ in 0..8 {
            let (s, t) = (rng.f64(), rng.f64());
            let w = if s + t > 1.0 { [s + t - 1.0, 1.0 - s, 1.0 - t] } else { [1.0 - s - t, s, t] };
            let uv = hull.a.widen() * w[0] + hull.b.widen() * w[1] + hull.c.widen() * w[2];
            let drawn = (0..3).map(|i| w[i] * f64::from(seen[i].distance)).sum::<f64>();
            let exact = there(uv);
            // the plane's own steepest slope there, along the disk
            let step = 1e-6;
            let gradient = Vec2::new(
                (there(uv + Vec2::new(step, 0.0)) - exact) / step,
                (there(uv + Vec2::new(0.0, step)) - exact) / step,
            );
            let along = f64::from(reach) * gradient.length() * 1.05;
            let allowed = f64::from(tolerance) * exact + along + 1e-5 * exact;
            let off = drawn - exact;
            assert!(off <= allowed, "{corners:?}: {off:e} of {allowed:e}");
            let nearer = DPSM_REFINE_NEARER * f64::from(tolerance) * exact + 1e-5 * exact;
            assert!(-off <= nearer, "{corners:?}: {off:e} of {nearer:e}");
        }
    }
    println!("{flat} flat");
    assert!(flat > CASES / 100);
}

#[test]
fn degenerate_triangles_end_in_few_leaves() {
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let tiny = 1e-30;
    for corners in [
        [p(0.0, 0.0, 1.0); 3],
        [p(1.0, 0.0, 0.0), p(-1.0, 0.0, 0.0), p(0.0, tiny, 0.0)],
        [p(1.0, 1e-7, 0.0), p(-1.0, 1e-7, 0.0), p(0.0, 1e-7, 1.0)],
        [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)],
        [p(1e-20, 0.0, 0.0), p(0.0, 1e-20, 0.0), p(0.0, 0.0, 1e-20)],
        [p(1e17, 0.0, 0.0), p(0.0, 1e17, 0.0), p(0.0, 0.0, -1e17)],
        // around the pole behind each map
        [p(0.1, 0.0, -1.0), p(-0.1, 0.1, -1.0), p(-0.1, -0.1, -1.0)],
        [p(9.0, 0.0, 1.0), p(-9.0, 9.0, 1.0), p(-9.0, -9.0, 1.0)],
        // through the light, but for rounding
        [p(1.0, 1.0, 1.0), p(-1.0, -1.0, -1.0), p(1.0, -1.0, 0.0)],
        [p(1.0, 2.0, 3.0), p(2.0, 4.0, 6.0), p(3.0, 6.0, 9.0)],
    ] {
        for size in [1, 64, 4096] {
            let frame = frame(&[corners], Settings { size, ..Settings::default() });
            for map in 0..2 {
                let leaves = leaves(&frame, map, 0..1);
                assert!(leaves.len() < 20_000, "{corners:?} {size}: {}", leaves.len());
                let finite = |leaf: &Leaf| {
                    leaf.corners.iter().all(|c| c.uv.x.is_finite() && c.uv.y.is_finite())
                };
                assert!(leaves.iter().all(finite), "{corners:?}");
            }
        }
    }
}

#[test]
fn levels_are_enough_and_bounded() {
    for size in [1, 64, 1024, 16384] {
        for tau in [1.0 / 64.0, 0.125, 0.25, 4.0] {
            let levels = refinement_levels(size, tau);
            assert!((7..=24).contains(&levels), "{size} {tau}: {levels}");
        }
    }
    // the counts that the shader keeps of each level
    assert!(refinement_levels(16384, 1.0 / 64.0) + 8 < 40);
}
