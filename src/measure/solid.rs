//! Sides of solids that are turned away from the light: shading leaves them dark whatever maps say.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::ops::Range;

use glam::DVec3;

use super::{Bench, Point};

/// How far the share of the sphere that a closed mesh fills around the light may be off a whole.
const WHOLE: f64 = 0.01;

/// Which points lie on a side that is turned away from the light, for certain: their mesh is closed,
/// its triangles agree on its outside, and the light is outside of it; or it is a room, seen from
/// inside, and the light is in it.
pub fn turned_away(bench: &Bench<'_>, points: &[Point]) -> Vec<bool> {
    let frame = bench.frame;
    let all = 0..frame.triangles.len() as u32;
    // a frame without names is one mesh
    let whole = [(String::new(), all)];
    let meshes = if frame.meshes.is_empty() { &whole[..] } else { &frame.meshes };
    let mut sided = vec![false; frame.triangles.len()];
    for (_, range) in meshes {
        if is_sided(bench, range) {
            sided[range.start as usize..range.end as usize].fill(true);
        }
    }
    let of = |point: &Point| {
        let Some(triangle) = point.triangle else { return false };
        sided.get(triangle as usize) == Some(&true)
            && bench.normal(triangle).dot(bench.origin - point.world) < 0.0
    };
    points.iter().map(of).collect()
}

fn is_sided(bench: &Bench<'_>, range: &Range<u32>) -> bool {
    let corners: Vec<[DVec3; 3]> = range.clone().map(|triangle| bench.corners(triangle)).collect();
    if corners.is_empty() || !is_closed(&corners) {
        return false;
    }
    let volume: f64 = corners
        .iter()
        .map(|[a, b, c]| (*a - corners[0][0]).dot((*b - corners[0][0]).cross(*c - corners[0][0])))
        .sum();
    let around = corners.iter().map(|t| t.map(|corner| corner - bench.origin)).map(solid_angle);
    let filled = around.sum::<f64>() / (2.0 * TAU);
    match volume > 0.0 {
        true => filled.abs() < WHOLE,
        false => (filled + 1.0).abs() < WHOLE,
    }
}

/// True where each edge is passed as often in one direction as in the other; corners at equal
/// positions are one.
fn is_closed(corners: &[[DVec3; 3]]) -> bool {
    let mut passes: HashMap<[[u64; 3]; 2], [u32; 2]> = HashMap::new();
    let key = |p: DVec3| (p + 0.0).to_array().map(f64::to_bits); // -0 is 0
    for t in corners {
        for (from, to) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let ends = [key(from), key(to)];
            match ends[0].cmp(&ends[1]) {
                std::cmp::Ordering::Less => passes.entry(ends).or_default()[0] += 1,
                std::cmp::Ordering::Greater => {
                    passes.entry([ends[1], ends[0]]).or_default()[1] += 1;
                }
                std::cmp::Ordering::Equal => {}
            }
        }
    }
    passes.values().all(|[there, back]| there == back)
}

/// The solid angle of a triangle, positive where its front is turned away (van Oosterom and Strackee
/// 1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let [x, y, z] = [a.length(), b.length(), c.length()];
    let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    2.0 * a.dot(b.cross(c)).atan2(below)
}
