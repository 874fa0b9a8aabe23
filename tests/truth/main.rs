//! The ground truth against closed forms, exact integers and itself; tolerances are derived in
//! docs/truth.md.

#![cfg(feature = "scene")]

#[path = "../common/mod.rs"]
mod common;

mod closed_forms;
mod integers;
mod occluders;
mod opacity;
mod search;
mod watertight;

use dpsm::truth::{Hit, Ray, Truth};
use fastrand::Rng;
use glam::{DVec3, IVec3, dvec3};

/// Relative to the largest coordinate and the cosine of incidence (docs/truth.md, "Distance").
const DISTANCE: f64 = 16.0 * f64::EPSILON;

/// Relative to the largest coordinate, across the ray (docs/truth.md, "Edges").
const EDGE: f64 = 4.0 * f64::EPSILON;

/// Relative to the largest coordinate, across a triangle's plane (docs/truth.md, "Ends").
const TOUCH: f64 = 64.0 * f64::EPSILON;

/// Uniform over the sphere.
fn direction(rng: &mut Rng) -> DVec3 {
    loop {
        let v = DVec3::from([0; 3].map(|_| 2.0 * rng.f64() - 1.0));
        if (1e-4..1.0).contains(&v.length_squared()) {
            return v;
        }
    }
}

/// Uniform in a cube around the origin.
fn within(rng: &mut Rng, half: f64) -> DVec3 {
    DVec3::from([0; 3].map(|_| half * (2.0 * rng.f64() - 1.0)))
}

fn integers(rng: &mut Rng, largest: i32) -> IVec3 {
    IVec3::from([0; 3].map(|_| rng.i32(-largest..=largest)))
}

/// Corners of separate triangles and their indices.
fn soup(corners: &[[DVec3; 3]]) -> Truth {
    Truth::new(
        corners.as_flattened(),
        (0..corners.len() as u32).map(|i| [0, 1, 2].map(|j| 3 * i + j)),
    )
}

/// The first hit by trying every triangle.
fn brute(truth: &Truth, triangles: usize, ray: &Ray) -> Option<Hit> {
    let hits = (0..triangles as u32).filter_map(|i| truth.hit(ray, i));
    hits.min_by(|a, b| a.distance.total_cmp(&b.distance).then(a.triangle.cmp(&b.triangle)))
}

/// The faces of the cuboid from `min` to `max`, two triangles each, in the order -x +x -y +y -z +z.
fn cuboid(min: DVec3, max: DVec3) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [min, max] {
            let corner = |u: DVec3, v: DVec3| {
                let mut corner = DVec3::ZERO;
                corner[axis] = side[axis];
                corner[(axis + 1) % 3] = u[(axis + 1) % 3];
                corner[(axis + 2) % 3] = v[(axis + 2) % 3];
                corner
            };
            let [a, b] = [corner(min, min), corner(max, min)];
            let [c, d] = [corner(max, max), corner(min, max)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

/// A ball of 8 * 4^levels triangles around the origin: an octahedron halved and pushed out.
fn ball(radius: f64, levels: u32) -> Vec<[DVec3; 3]> {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let mut triangles = Vec::new();
    for [a, b] in [[x, y], [y, -x], [-x, -y], [-y, x]] {
        triangles.extend([[a, b, z], [b, a, -z]]);
    }
    for _ in 0..levels {
        let halved = |[a, b, c]: [DVec3; 3]| {
            // The sum is symmetric, so neighbours get equal middles.
            let [d, e, f] = [a + b, b + c, c + a].map(DVec3::normalize);
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        triangles = triangles.into_iter().flat_map(halved).collect();
    }
    triangles.into_iter().map(|t| t.map(|corner| corner * radius)).collect()
}

/// The largest coordinate relative to the ray's origin.
fn reach(corners: [DVec3; 3], origin: DVec3) -> f64 {
    corners.map(|corner| (corner - origin).abs().max_element()).into_iter().fold(0.0, f64::max)
}
