//! Against exact integer arithmetic.

use crate::common::{CASES, rng};
use crate::*;
use glam::{I64Vec3, ivec3};

/// Integers times the ray's parameter: numerator and denominator of the hit, and the signs of the
/// three edges.
struct Exact {
    numerator: i128,
    denominator: i128,
    edges: [i128; 3],
}

impl Exact {
    fn new(origin: IVec3, direction: IVec3, corners: [IVec3; 3]) -> Self {
        let [a, b, c] = corners.map(|corner| (corner - origin).as_i64vec3());
        let direction = direction.as_i64vec3();
        let normal = (b - a).cross(c - a);
        let volume = |p: I64Vec3, q: I64Vec3| dot(p.cross(q), direction);
        Self {
            numerator: dot(normal, a),
            denominator: dot(normal, direction),
            edges: [volume(b, c), volume(c, a), volume(a, b)],
        }
    }

    fn meets(&self) -> bool {
        let positive = self.edges.iter().all(|&edge| edge >= 0);
        let negative = self.edges.iter().all(|&edge| edge <= 0);
        self.denominator != 0 && (positive || negative) && self.parameter() > 0.0
    }

    fn parameter(&self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }

    /// Distance between the ray's line and the nearest edge's line.
    fn to_edge(&self, origin: IVec3, direction: IVec3, corners: [IVec3; 3]) -> f64 {
        let [a, b, c] = corners.map(|corner| (corner - origin).as_dvec3());
        let spans = [c - b, a - c, b - a].map(|edge| edge.cross(direction.as_dvec3()).length());
        let distance = |(&edge, span): (&i128, f64)| (edge as f64 / span).abs();
        self.edges.iter().zip(spans).map(distance).fold(f64::INFINITY, f64::min)
    }
}

fn dot(p: I64Vec3, q: I64Vec3) -> i128 {
    (0..3).map(|i| i128::from(p[i]) * i128::from(q[i])).sum()
}

fn cast(origin: IVec3, direction: IVec3, corners: [IVec3; 3]) -> Option<Hit> {
    let ray = Ray::new(origin.as_dvec3(), direction.as_dvec3());
    soup(&[corners.map(|corner| corner.as_dvec3())]).first_hit(&ray)
}

#[test]
fn small_integers_are_decided_exactly_edges_and_corners_included() {
    let mut rng = rng("small integers");
    let (mut hits, mut on_edge) = (0, 0);
    for _ in 0..CASES {
        let corners = [0; 3].map(|_| integers(&mut rng, 4));
        let origin = integers(&mut rng, 4);
        let mut direction = integers(&mut rng, 4);
        // A power of two on the longest axis: all of the test's arithmetic is then exact.
        direction[rng.usize(0..3)] = if rng.bool() { 4 } else { -4 };
        let exact = Exact::new(origin, direction, corners);
        if exact.numerator == 0 {
            continue; // begins on the triangle's plane: a weight of 1/3 rounds to either side
        }
        let hit = cast(origin, direction, corners);
        assert_eq!(hit.is_some(), exact.meets(), "{origin} {direction} {corners:?}");
        if let Some(hit) = hit {
            hits += 1;
            on_edge += u32::from(exact.edges.contains(&0));
            let sum = exact.edges.iter().sum::<i128>() as f64;
            for (weight, edge) in hit.weights.into_iter().zip(exact.edges) {
                assert!((weight - edge as f64 / sum).abs() <= f64::EPSILON);
            }
        }
    }
    println!("{hits} hits, {on_edge} of them on an edge");
    assert!(hits > 5_000 && on_edge > 1_000);
}

#[test]
fn distances_keep_their_bound_from_needles_to_grazing_rays() {
    let mut rng = rng("distances");
    let (mut hits, mut worst) = (0, 0.0_f64);
    for case in 0..2 * CASES {
        let mut corners = [0; 3].map(|_| integers(&mut rng, 1 << 20));
        if case % 4 == 0 {
            // A needle: the third corner beside the edge.
            let along = rng.f64();
            let edge = (corners[1] - corners[0]).as_dvec3();
            corners[2] = corners[0] + (edge * along).as_ivec3() + integers(&mut rng, 3);
        }
        let origin = integers(&mut rng, 1 << 20);
        let weights = [0; 3].map(|_| rng.f64());
        let inside = corners.iter().zip(weights).map(|(corner, w)| corner.as_dvec3() * w);
        let inside = inside.sum::<DVec3>() / weights.iter().sum::<f64>();
        let mut direction = inside.round().as_ivec3() - origin;
        if case % 3 == 0 {
            // Nearly in the plane.
            direction = (corners[1] - corners[0]) + integers(&mut rng, 40);
        }
        let exact = Exact::new(origin, direction, corners);
        let Some(hit) = cast(origin, direction, corners) else { continue };
        let corners = corners.map(|corner| corner.as_dvec3());
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        let cos = normal.dot(direction.as_dvec3().normalize()).abs();
        let expected = exact.parameter() * direction.as_dvec3().length();
        let bound = DISTANCE * reach(corners, origin.as_dvec3()) / cos;
        let error = (hit.distance - expected).abs();
        assert!(error <= bound, "{error} of {bound}: {origin} {direction} {corners:?}");
        worst = worst.max(error / bound);
        hits += 1;
    }
    println!("{hits} hits, largest error {worst:.3} of the bound");
    assert!(hits > CASES && worst > 0.02);
}

#[test]
fn only_rays_within_rounding_of_an_edge_may_be_decided_either_way() {
    let mut rng = rng("edges");
    let (mut either, mut near) = (0, 0);
    for _ in 0..2 * CASES {
        let corners = [0; 3].map(|_| integers(&mut rng, 1 << 20) * 2);
        let origin = integers(&mut rng, 1 << 20);
        // Exactly through an edge, or one unit in 2^23 beside it.
        let part = rng.i32(0..=8);
        let through = corners[0] * part + corners[1] * (8 - part) - origin * 8;
        let beside = if rng.bool() { integers(&mut rng, 1) } else { ivec3(0, 0, 0) };
        let direction = through + beside;
        let exact = Exact::new(origin, direction, corners);
        if exact.denominator == 0 {
            continue;
        }
        let to_edge = exact.to_edge(origin, direction, corners);
        let reach = reach(corners.map(|c| c.as_dvec3()), origin.as_dvec3());
        // The rounding of `to_edge` itself is far below one part in a hundred.
        let close = to_edge <= 1.01 * EDGE * reach;
        near += u32::from(close);
        if cast(origin, direction, corners).is_some() != exact.meets() {
            assert!(close, "{to_edge} from the edge: {origin} {direction} {corners:?}");
            either += 1;
        }
    }
    println!("{near} rays within rounding of an edge, {either} decided the other way");
    assert!(near > 1000 && either > 0);
}
