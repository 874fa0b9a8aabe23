//! The tree against trying every triangle, on random and degenerate meshes.

use crate::common::rng;
use crate::*;

/// Rays at a mesh: at random, along axes, from corners and faces of boxes, at edges and corners.
fn rays(rng: &mut Rng, triangles: &[[DVec3; 3]], count: usize) -> Vec<Ray> {
    let corner = |rng: &mut Rng| triangles[rng.usize(0..triangles.len())][rng.usize(0..3)];
    let mut rays = Vec::with_capacity(count);
    for _ in 0..count {
        let origin = match rng.u32(0..4) {
            0 => within(rng, 2.0),
            1 => corner(rng),
            2 => corner(rng).with_y(2.0),
            // On the planes of two faces of the triangles' boxes.
            _ => DVec3::from([corner(rng).x, corner(rng).y, 2.0 * rng.f64() - 1.0]),
        };
        let [a, b, c] = triangles[rng.usize(0..triangles.len())];
        let direction = match rng.u32(0..5) {
            0 => direction(rng),
            1 => {
                [DVec3::X, -DVec3::Y, dvec3(0.0, -0.0, 1.0), dvec3(1.0, -1.0, 0.0)][rng.usize(0..4)]
            }
            2 => a - origin,
            3 => a.lerp(b, rng.f64()) - origin,
            _ => (a + b + c) / 3.0 - origin,
        };
        let except = rng.bool().then(|| rng.u32(0..triangles.len() as u32));
        let near = if rng.bool() { 0.0 } else { rng.f64() };
        let far = if rng.bool() { f64::INFINITY } else { 3.0 * rng.f64() };
        rays.push(Ray { origin, direction, near, far, except });
    }
    rays
}

fn assert_same(name: &str, rng: &mut Rng, triangles: &[[DVec3; 3]]) {
    let truth = soup(triangles);
    let rays = rays(rng, triangles, 20_000);
    let found = truth.first_hits(&rays);
    let hits = found.iter().flatten().count();
    println!("{name}: {hits} of {} rays hit", rays.len());
    assert!(hits > rays.len() / 100, "{name}");
    for (ray, found) in rays.iter().zip(found) {
        assert_eq!(found, brute(&truth, triangles.len(), ray), "{name}: {ray:?}");
        assert_eq!(found, truth.first_hit(ray), "{name}: order");
    }
}

#[test]
fn the_tree_finds_what_trying_every_triangle_finds() {
    let mut rng = rng("tree");
    let rng = &mut rng;
    let near = |rng: &mut Rng, at: DVec3, size: f64| [0; 3].map(|_| at + within(rng, size));
    let random: Vec<_> = (0..200).map(|_| near(rng, DVec3::ZERO, 1.0)).collect();
    let small: Vec<_> = (0..200)
        .map(|_| {
            let at = within(rng, 1.0);
            near(rng, at, 0.1)
        })
        .collect();
    let flat: Vec<_> = small.iter().map(|t| t.map(|corner| corner.with_z(0.25))).collect();
    let layers =
        (0..5).flat_map(|i| flat.iter().map(move |t| t.map(|c| c.with_z(f64::from(i) / 3.0))));
    let needle =
        |t: &[DVec3; 3]| [t[0], t[1], t[0].lerp(t[1], 0.3) + within(&mut Rng::with_seed(1), 1e-12)];
    let needles: Vec<_> = random.iter().map(needle).collect();
    let lines: Vec<_> =
        random.iter().map(|&[a, b, _]| [a, b, a.lerp(b, 0.5)]).chain(random.clone()).collect();
    let points = random.iter().map(|t| [t[0]; 3]).chain(small.clone()).collect::<Vec<_>>();
    let twins: Vec<_> = small.iter().chain(&small).chain(&small).copied().collect();
    let grid: Vec<_> =
        small.iter().map(|t| t.map(|c| (c * 4.0).round() / 4.0)).chain(random.clone()).collect();
    let far: Vec<_> = small.iter().map(|t| t.map(|c| (c * 8.0).round() / 8.0)).collect();
    let scales =
        (0..200).map(|i| random[i].map(|c| c * 0.5_f64.powi(i as i32 / 4))).collect::<Vec<_>>();
    assert_same("random", rng, &random);
    assert_same("small", rng, &small);
    assert_same("flat", rng, &flat);
    assert_same("layers", rng, &layers.collect::<Vec<_>>());
    assert_same("needles", rng, &needles);
    assert_same("lines", rng, &lines);
    assert_same("points", rng, &points);
    assert_same("twins", rng, &twins);
    assert_same("grid", rng, &grid);
    assert_same("coarse grid", rng, &far);
    assert_same("scales", rng, &scales);
    assert_same("cuboid", rng, &cuboid(DVec3::splat(-1.0), DVec3::ONE));
    assert_same("ball", rng, &ball(1.0, 2));
}

#[test]
fn of_coincident_triangles_the_lowest_index_is_hit() {
    let triangle = [dvec3(-1.0, 0.1, -1.0), dvec3(1.0, 0.3, -1.0), dvec3(0.0, 0.2, 1.0)];
    for count in [2, 7, 3000] {
        let truth = soup(&vec![triangle; count]);
        let ray = Ray::new(dvec3(0.1, 2.0, 0.0), DVec3::NEG_Y);
        assert_eq!(truth.first_hit(&ray).unwrap().triangle, 0);
        assert_eq!(truth.first_hit(&Ray { except: Some(0), ..ray }).unwrap().triangle, 1);
    }
}

#[test]
fn a_scene_is_searched_as_its_triangles_in_order() {
    let scene =
        dpsm::scene::open("cornell", &dpsm::scene::Options { walls: 3, around: None }).unwrap();
    let triangles: Vec<_> = scene.triangles().map(|t| t.map(|corner| corner.as_dvec3())).collect();
    let light = scene.default_light().position.as_dvec3();
    let mut rng = rng("scene");
    for _ in 0..1000 {
        let ray = Ray::new(light, direction(&mut rng));
        assert_eq!(
            Truth::from(&scene).first_hit(&ray),
            brute(&soup(&triangles), triangles.len(), &ray)
        );
    }
}

#[test]
fn hits_outside_near_and_far_do_not_count() {
    let truth = soup(
        &[1.0, 2.0, 3.0].map(|z| [dvec3(-1.0, -1.0, z), dvec3(3.0, -1.0, z), dvec3(-1.0, 3.0, z)]),
    );
    let hit = |near, far| {
        let ray = Ray { near, far, ..Ray::new(DVec3::ZERO, DVec3::Z * 7.0) };
        truth.first_hit(&ray).map(|hit| (hit.triangle, hit.distance))
    };
    assert_eq!(hit(0.0, 9.0), Some((0, 1.0)));
    assert_eq!(hit(1.0, 9.0), Some((1, 2.0)), "near itself is excluded");
    assert_eq!(hit(1.0 - f64::EPSILON, 9.0), Some((0, 1.0)));
    assert_eq!(hit(1.5, 2.0), None, "far itself is excluded");
    assert_eq!(hit(1.5, 2.0 + 2.0 * f64::EPSILON), Some((1, 2.0)));
    assert_eq!(hit(3.0, f64::INFINITY), None);
    assert_eq!(hit(2.0, 1.0), None);
    assert_eq!(hit(f64::NAN, 9.0), None);
    assert_eq!(hit(0.0, f64::NAN), None);
}

#[test]
fn what_cannot_be_used_is_never_hit() {
    let good = [dvec3(-1.0, -1.0, 1.0), dvec3(3.0, -1.0, 1.0), dvec3(-1.0, 3.0, 1.0)];
    let ray = Ray::new(DVec3::ZERO, DVec3::Z);
    assert!(soup(&[good]).first_hit(&ray).is_some());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
        let mut broken = good;
        broken[1].x = bad;
        assert_eq!(soup(&[broken]).first_hit(&ray), None);
        assert_eq!(soup(&[broken, good]).first_hit(&ray).unwrap().triangle, 1);
        assert_eq!(soup(&[good]).first_hit(&Ray { origin: DVec3::splat(bad), ..ray }), None);
        if bad != f64::MAX {
            let direction = dvec3(0.0, bad, 1.0);
            assert_eq!(soup(&[good]).first_hit(&Ray { direction, ..ray }), None);
        }
    }
    assert_eq!(soup(&[good]).first_hit(&Ray { direction: DVec3::ZERO, ..ray }), None);
    assert_eq!(soup(&[good]).hit(&ray, 1), None);
    assert_eq!(soup(&[]).first_hit(&ray), None);
    let out_of_range = Truth::new(&good, [[0, 1, 3], [0, 1, 2], [u32::MAX; 3]]);
    assert_eq!(out_of_range.first_hit(&ray).unwrap().triangle, 1);
    assert!(soup(&[good]).sees(DVec3::NAN, DVec3::Z, None, 0.0));
}

#[test]
fn the_length_of_a_direction_does_not_matter() {
    let mut rng = rng("length");
    let truth = soup(&ball(1.0, 2));
    for _ in 0..10_000 {
        let ray = Ray::new(within(&mut rng, 0.5), direction(&mut rng));
        let hit = truth.first_hit(&ray).unwrap();
        for scale in [0.5_f64.powi(900), 2_f64.powi(900)] {
            assert_eq!(
                truth.first_hit(&Ray { direction: ray.direction * scale, ..ray }),
                Some(hit)
            );
        }
        let reached = ray.origin + ray.direction.normalize() * hit.distance;
        // The ball's faces are met at up to 65 degrees from points within 0.87 of its middle.
        assert!(reached.distance(truth.point(&hit).unwrap()) < 100.0 * f64::EPSILON);
    }
}
