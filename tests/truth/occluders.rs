//! What keeps the light from a point, and what only touches it.

use crate::common::rng;
use crate::*;

/// A square in the plane that `right` and `up` span around `at`, its diagonal shared.
fn square(at: DVec3, right: DVec3, up: DVec3) -> [[DVec3; 3]; 2] {
    let [a, b, c, d] = [-right - up, right - up, right + up, up - right].map(|v| at + v);
    [[a, b, c], [a, c, d]]
}

/// Three orthogonal unit vectors.
fn basis(rng: &mut Rng) -> [DVec3; 3] {
    let forward = direction(rng).normalize();
    let right = forward.cross(direction(rng)).normalize();
    [right, forward.cross(right), forward]
}

#[test]
fn a_convex_body_does_not_shadow_the_faces_that_see_the_light() {
    let mut rng = rng("convex");
    let tilted = {
        let [right, up, forward] = basis(&mut rng);
        let turn = |v: DVec3| dvec3(7.0, -3.0, 30.0) + right * v.x + up * v.y + forward * v.z;
        cuboid(DVec3::splat(-1.0), dvec3(1.0, 2.0, 3.0)).into_iter().map(|t| t.map(turn)).collect()
    };
    for triangles in [ball(1.0, 3), cuboid(DVec3::splat(-1.0), DVec3::ONE), tilted] {
        let truth = soup(&triangles);
        let middle = triangles.iter().flatten().sum::<DVec3>() / (3 * triangles.len()) as f64;
        let (mut lit, mut dark) = (0, 0);
        for _ in 0..100_000 {
            let light = middle + direction(&mut rng).normalize() * (4.0 + 4.0 * rng.f64());
            let triangle = rng.u32(0..triangles.len() as u32);
            let [a, b, c] = triangles[triangle as usize];
            // On edges, corners and right beside them.
            let u = [0.0, 1.0, 1e-9, rng.f64()][rng.usize(0..4)];
            let v = [0.0, 1.0, 1e-12, rng.f64()][rng.usize(0..4)] * (1.0 - u);
            let weights = [1.0 - u - v, u, v];
            let hit = Hit { distance: 0.0, triangle, weights };
            let point = truth.point(&hit).unwrap();
            let normal = (b - a).cross(c - a).normalize();
            let normal = normal * normal.dot(a - middle).signum();
            let cos = normal.dot((light - point).normalize());
            let sees = truth.sees(light, point, Some(triangle), 0.0);
            if cos > 0.0 {
                assert!(sees, "{light} {hit:?}");
                lit += 1;
            } else if weights.iter().all(|&w| w > 1e-3) && cos < -1e-3 {
                assert!(!sees, "{light} {hit:?}");
                dark += 1;
            }
        }
        println!("{lit} lit, {dark} dark");
        assert!(lit > 10_000 && dark > 1000);
    }
}

#[test]
fn a_twin_touches_its_point_and_a_lifted_one_shadows_it() {
    let mut rng = rng("twin");
    for _ in 0..10_000 {
        let [right, up, forward] = basis(&mut rng);
        let at = within(&mut rng, 8.0);
        let own = square(at, right, up);
        let light = at + forward * 3.0 + right * 20.0 * rng.f64();
        let point = at + right * 0.3 + up * 0.1;
        // The same place triangulated otherwise.
        let twin = square(at, up, -right);
        let truth = soup(&[own, twin].concat());
        assert!(truth.sees(light, point, Some(0), 0.0));
        let exempt = Ray { except: Some(0), ..Ray::new(light, point - light) };
        let seen = truth.first_hit(&exempt).unwrap();
        assert!(seen.triangle >= 2, "by identity, so the twin is still there: {seen:?}");
        // 100 times what the rounding of coordinates up to 32 allows.
        let lifted = square(at + forward * 100.0 * 32.0 * TOUCH, up, -right);
        let truth = soup(&[own, lifted].concat());
        assert!(truth.occluder(light, point, Some(0), 0.0).unwrap().triangle >= 2);
        let sunk = square(at - forward * 100.0 * 32.0 * TOUCH, up, -right);
        assert!(soup(&[own, sunk].concat()).sees(light, point, Some(0), 0.0));
    }
}

#[test]
fn the_receivers_own_triangle_is_excluded_by_identity() {
    let mut rng = rng("identity");
    let mut crossed = 0;
    for _ in 0..10_000 {
        let corners = [0; 3].map(|_| within(&mut rng, 1.0));
        let truth = soup(&[corners]);
        let light = within(&mut rng, 3.0);
        let inside = corners.iter().sum::<DVec3>() / 3.0;
        let beyond = inside + (inside - light);
        assert!(truth.sees(light, beyond, Some(0), 0.0), "it never shadows its own points");
        crossed += u32::from(!truth.sees(light, beyond, None, 0.0));
    }
    assert!(crossed > 9990, "but any others");
}

#[test]
fn a_light_exactly_on_a_surface_is_not_shadowed_by_it() {
    let mut rng = rng("light on a surface");
    for _ in 0..10_000 {
        let [right, up, forward] = basis(&mut rng);
        let at = within(&mut rng, 8.0);
        let truth = soup(&square(at, right, up));
        let weights = [0.25, 0.5, 0.25];
        let light = truth.point(&Hit { distance: 0.0, triangle: 0, weights }).unwrap();
        let tilt = right * rng.f64() + up * rng.f64();
        for point in [light + forward + tilt, light - forward + tilt] {
            assert!(truth.sees(light, point, None, 0.0));
        }
        let wall = square(at + forward * 0.5, right * 3.0, up * 3.0);
        let behind = soup(&[square(at, right, up), wall].concat());
        let shadow = behind.occluder(light, light + forward + tilt, None, 0.0);
        assert!(shadow.is_some_and(|hit| hit.triangle >= 2), "but by the next");
        let before = light + forward * 100.0 * 16.0 * TOUCH;
        assert!(!truth.sees(before, light - forward, None, 0.0));
        assert!(truth.sees(light, light, None, 0.0), "a point at the light");
    }
}

#[test]
fn what_lies_nearer_than_near_does_not_shadow() {
    let [near, far] = [1.0, 2.0].map(|z| square(DVec3::Z * z, DVec3::X, DVec3::Y));
    let truth = soup(&[near, far].concat());
    let first = |near| truth.occluder(DVec3::ZERO, DVec3::Z * 4.0, None, near);
    assert_eq!(first(0.0).unwrap().distance, 1.0);
    assert_eq!(first(1.0).unwrap().distance, 2.0);
    assert!(first(2.0).is_none());
    assert!(truth.sees(DVec3::ZERO, DVec3::Z, None, 0.0), "the segment ends at the first");
}

#[test]
fn many_receivers_give_what_each_gives_alone_in_order() {
    let mut rng = rng("many receivers");
    let truth = soup(&ball(1.0, 3));
    let light = dvec3(0.0, 3.0, 0.0);
    let receivers =
        (0..20_000).map(|_| (within(&mut rng, 3.0), rng.bool().then(|| rng.u32(0..512))));
    let receivers: Vec<_> = receivers.collect();
    let alone = receivers.iter().map(|&(point, own)| truth.occluder(light, point, own, 0.5));
    let alone: Vec<_> = alone.collect();
    assert!(alone.iter().flatten().count() > 100);
    assert_eq!(truth.occluders(light, &receivers, 0.5), alone);
}
