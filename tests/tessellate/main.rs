//! Sub-triangles tile, and triangles that share an edge share its points.

#[path = "../common/mod.rs"]
mod common;
mod fused;
mod level;

use common::{CASES, EPS, Worst, point, rng};
use dpsm::scalar::float::{Float, Vec3};
use dpsm::scalar::tessellate::*;
use fused::Fused;

/// The sub-triangles of a level, each by its corners' numerators.
pub fn sub_triangles(level: u32) -> impl Iterator<Item = [[u32; 3]; 3]> {
    let corners = move |k| [0, 1, 2].map(|corner| dpsm_tessellate_weights(level, 3 * k + corner));
    (0..level * level).map(corners)
}

/// Twice the area in the lattice of (b, c), 1 for a sub-triangle of the triangle's orientation.
fn area([p, q, r]: [[u32; 3]; 3]) -> i64 {
    let at = |w: [u32; 3]| (i64::from(w[1]), i64::from(w[2]));
    let ((px, py), (qx, qy), (rx, ry)) = (at(p), at(q), at(r));
    (qx - px) * (ry - py) - (qy - py) * (rx - px)
}

#[test]
pub fn sub_triangles_are_alike_and_their_areas_add_up() {
    for level in 1..=64 {
        let mut total = 0;
        for triangle in sub_triangles(level) {
            assert!(triangle.iter().all(|w| w.iter().sum::<u32>() == level), "{triangle:?}");
            assert_eq!(area(triangle), 1, "level {level}: {triangle:?}");
            let spans = [0, 1, 2].map(|axis| {
                let values = triangle.map(|w| w[axis]);
                values.iter().max().unwrap() - values.iter().min().unwrap()
            });
            assert_eq!(spans, [1; 3], "congruent: {triangle:?}");
            total += area(triangle);
        }
        assert_eq!(total, i64::from(level).pow(2));
    }
}

#[test]
fn every_point_lies_in_exactly_one_sub_triangle() {
    let mut rng = rng("tiling");
    for level in 1..=24 {
        for _ in 0..100 {
            let (s, t) = (rng.f64(), rng.f64());
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            let at = [s * f64::from(level), t * f64::from(level)];
            let holds = |corners: &[[u32; 3]; 3]| {
                let place = |w: [u32; 3]| [f64::from(w[1]), f64::from(w[2])];
                (0..3).all(|i| {
                    let (p, q) = (place(corners[i]), place(corners[(i + 1) % 3]));
                    (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]) >= 0.0
                })
            };
            assert_eq!(sub_triangles(level).filter(holds).count(), 1, "level {level}, {at:?}");
        }
    }
}

#[test]
fn indices_out_of_range_and_level_zero_have_a_defined_corner() {
    assert_eq!([0, 1, 2].map(|i| dpsm_tessellate_weights(1, i)), [[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    assert_eq!([0, 1, 2].map(|i| dpsm_tessellate_weights(0, i)), [[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    for level in [1, 7, 1 << 15, u32::MAX] {
        let beyond = level.checked_mul(level).and_then(|square| square.checked_mul(3));
        for index in beyond.into_iter().chain([u32::MAX]) {
            let weights = dpsm_tessellate_weights(level, index);
            match beyond {
                Some(_) => assert_eq!(weights, [level, 0, 0]),
                None => assert_eq!(weights.map(u64::from).iter().sum::<u64>(), u64::from(level)),
            }
        }
    }
}

/// The bits of a point in an arithmetic.
fn bits<T: Float>(corners: [Vec3<f32>; 3], weights: [u32; 3]) -> [u32; 3] {
    let [a, b, c] = corners.map(|p| {
        let [x, y, z] = [p.x, p.y, p.z].map(|value| T::lit(value.into()));
        Vec3::new(x, y, z)
    });
    let p = dpsm_tessellate_point(a, b, c, weights);
    [p.x, p.y, p.z].map(|value| (value.value() as f32).to_bits())
}

/// Checks that two triangles on one edge, their corners in any order, agree on its points.
fn edges_agree<T: Float>(name: &str) {
    let mut rng = rng(name);
    for _ in 0..CASES {
        let [p, q, x, y] = [(); 4].map(|()| point(&mut rng, -8, 8));
        let level = rng.u32(1..100);
        let along = rng.u32(0..=level);
        let both = [x, y].map(|third| {
            let corners = [(p, level - along), (q, along), (third, 0)];
            let order = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
            let corners = order[rng.usize(0..6)].map(|i| corners[i]);
            bits::<T>(corners.map(|c| c.0), corners.map(|c| c.1))
        });
        assert_eq!(both[0], both[1], "{p:?} {q:?} {along} of {level}, {name}");
    }
}

#[test]
fn triangles_that_share_an_edge_share_its_points_to_the_bit() {
    edges_agree::<f32>("rounded");
}

#[test]
fn shared_points_agree_also_where_products_and_sums_are_fused() {
    edges_agree::<Fused<true>>("fused, left");
    edges_agree::<Fused<false>>("fused, right");
}

#[test]
fn corners_are_the_corners_themselves() {
    let mut rng = rng("corners");
    for _ in 0..CASES {
        let [a, b, c] = [(); 3].map(|()| point(&mut rng, -60, 60));
        let level = rng.u32(1..1 << 15);
        assert_eq!(dpsm_tessellate_point(a, b, c, [level, 0, 0]), a);
        assert_eq!(dpsm_tessellate_point(a, b, c, [0, level, 0]), b);
        assert_eq!(dpsm_tessellate_point(a, b, c, [0, 0, level]), c);
    }
}

#[test]
fn points_are_the_weighted_mean_within_their_bound() {
    let mut rng = rng("mean");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let corners = [(); 3].map(|()| point(&mut rng, -8, 8));
        let level = rng.u32(1..40);
        let weights = dpsm_tessellate_weights(level, rng.u32(0..3 * level * level));
        let [a, b, c] = corners;
        let p = dpsm_tessellate_point(a, b, c, weights);
        let mean = |values: [f32; 3]| {
            let terms = values.iter().zip(weights).map(|(&v, w)| f64::from(v) * f64::from(w));
            terms.sum::<f64>() / f64::from(level)
        };
        for (value, values) in
            [(p.x, corners.map(|p| p.x)), (p.y, corners.map(|p| p.y)), (p.z, corners.map(|p| p.z))]
        {
            let largest = values.iter().fold(0.0, |m: f32, v| m.max(v.abs()));
            let error = (f64::from(value) - mean(values)).abs();
            worst.note(error, 8.0 * EPS * f64::from(largest), (corners, weights));
        }
    }
    worst.check("dpsm_tessellate_point");
}
