//! No ray escapes from a closed mesh.

use crate::common::rng;
use crate::*;

const RAYS: usize = 1_000_000;

fn escaped(truth: &Truth, rays: &[Ray]) -> usize {
    truth.first_hits(rays).iter().filter(|hit| hit.is_none()).count()
}

/// A closed mesh whose corners lie anywhere between 1 and 2 from the origin, and its corners.
fn rock() -> Vec<[DVec3; 3]> {
    let bump = |corner: DVec3| {
        let bits = corner.to_array().map(|c| (c + 0.0).to_bits()).into_iter();
        let seed = bits.fold(7_u64, |seed, bits| seed.rotate_left(21) ^ bits);
        corner * (1.0 + Rng::with_seed(seed).f64())
    };
    ball(1.0, 5).into_iter().map(|triangle| triangle.map(bump)).collect()
}

#[test]
fn no_ray_escapes_from_a_closed_mesh() {
    let mut rng = rng("escape");
    let triangles = rock();
    let truth = soup(&triangles);
    let rays = |_| Ray::new(within(&mut rng, 0.3), direction(&mut rng));
    let rays: Vec<Ray> = (0..RAYS).map(rays).collect();
    assert_eq!(escaped(&truth, &rays), 0);
}

#[test]
fn no_ray_escapes_between_triangles_that_share_an_edge_or_a_corner() {
    let mut rng = rng("edges and corners");
    for triangles in [rock(), ball(1.0, 4), cuboid(DVec3::splat(-1.0), DVec3::splat(1.0))] {
        let truth = soup(&triangles);
        let mut rays = Vec::new();
        for _ in 0..RAYS / 4 {
            let [a, b, _] = triangles[rng.usize(0..triangles.len())];
            let origin = if rng.bool() { DVec3::ZERO } else { within(&mut rng, 0.3) };
            let part = [0.0, 0.5, 0.25, rng.f64()][rng.usize(0..4)];
            rays.push(Ray::new(origin, a.lerp(b, part) - origin));
        }
        assert_eq!(escaped(&truth, &rays), 0);
    }
}

#[test]
fn no_ray_escapes_from_the_closed_room() {
    let scene = dpsm::scene::open("brabec-room", &dpsm::scene::Options::default()).unwrap();
    let truth = Truth::from(&scene);
    let light = scene.default_light().position.as_dvec3();
    let mut rng = rng("room");
    let mut rays: Vec<Ray> = (0..RAYS / 10).map(|_| Ray::new(light, direction(&mut rng))).collect();
    rays.extend(scene.triangles().flatten().map(|to| Ray::new(light, to.as_dvec3() - light)));
    assert_eq!(escaped(&truth, &rays), 0);
}

#[test]
fn both_sides_of_a_triangle_count() {
    let mut rng = rng("sides");
    for _ in 0..10_000 {
        let corners = [0; 3].map(|_| within(&mut rng, 1.0));
        let inside = corners.iter().sum::<DVec3>() / 3.0;
        let away = direction(&mut rng);
        let flipped = [corners[0], corners[2], corners[1]];
        for triangle in [corners, flipped] {
            assert!(soup(&[triangle]).first_hit(&Ray::new(inside + away, -away)).is_some());
        }
    }
}
