//! Each texel's stored distance against a bound that is derived for it.

use dpsm::measure::{Bench, WorstTexel};
use dpsm::scalar::depth::dpsm_distance;
use dpsm::scalar::edge::{DPSM_EDGE_ROUNDING, DPSM_EDGE_SNAP};
use dpsm::scalar::float::Vec2;
use dpsm::scalar::paraboloid::dpsm_texture_to_disk;
use dpsm::truth::{Hit, Ray};
use glam::DVec3;

use crate::common::EPS;

/// A texel whose stored distance the bounds of the modules do not explain by more than this is
/// judged by `map_error`.
const WRONG: f64 = 1e-3;

/// A map's texels beside the truth.
#[derive(Debug, Default)]
pub struct Texels {
    /// Texels compared: those of one triangle with all around them.
    pub calm: usize,
    /// Their largest relative error.
    pub largest: f64,
    /// Their largest error over its bound, and where.
    pub ratio: f64,
    pub at: String,
    /// Of those where the bound is below 1e-5, the largest error.
    pub conditioned: f64,
    /// Texels off by more than 0.1% but within the bound there.
    pub within: usize,
}

/// The disk coordinates of a texel's centre.
pub fn centre(bench: &Bench<'_>, x: u32, y: u32) -> Vec2<f64> {
    let st = Vec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / f64::from(bench.maps.size);
    dpsm_texture_to_disk(st, bench.light.guard)
}

/// The first hit along each texel's direction.
pub fn hits(bench: &Bench<'_>) -> Vec<Option<Hit>> {
    let (near, far) = (bench.light.near, bench.light.far);
    let side = bench.maps.size;
    let ray = |layer: u32, x, y| {
        let direction = bench.direction(centre(bench, x, y), layer);
        Ray { near, far, ..Ray::new(bench.origin, direction) }
    };
    let rays: Vec<Ray> = (0..bench.maps.layers)
        .flat_map(|layer| (0..side * side).map(move |i| (layer, i % side, i / side)))
        .map(|(layer, x, y)| ray(layer, x, y))
        .collect();
    bench.truth.first_hits(&rays)
}

/// What a texel's direction meets: the tangent of the incidence, and the bound for the exact method.
///
/// docs of module triangle: the distance is within 40 eps / cos relative of the plane's, the plane within 24 eps of the largest
/// distance L, its vertices within 4 eps sqrt(3) L (dpsm_to_light), each moving the distance by
/// 1 / cos of itself; the stored depth is within 4.5 eps (l + near) of l, and half a step.
fn bound(bench: &Bench<'_>, direction: DVec3, hit: &Hit) -> (f64, f64) {
    let corner = |i: u32| bench.frame.vertices[i as usize].position.as_dvec3();
    let [a, b, c] = bench.frame.triangles[hit.triangle as usize].map(corner);
    let normal = (b - a).cross(c - a).normalize();
    let d = direction.normalize();
    let cosine = normal.dot(d).abs();
    let tangent = normal.cross(d).length() / cosine;
    let largest = [a, b, c].map(|p| p.distance(bench.origin)).into_iter().fold(0.0, f64::max);
    let (l, near) = (hit.distance, bench.light.near);
    let moved = (40.0 + (24.0 + 4.0 * 3f64.sqrt()) * largest / l) / cosine;
    let step = f64::from(bench.frame.settings.format.quantum()) * (bench.light.far - near) / l;
    (tangent, EPS * (moved + 4.5 * (1.0 + near / l)) + step)
}

/// The bound of one texel, and that of one at a crease; `around` are the hits there.
///
/// An interpolated depth is off by the method's depth tolerance, and by tau and what rasterizers move
/// vertices, a step in x and y at most, times the slope; an edge by tau and its rounding, where
/// either side's plane may be seen: the slopes of both.
fn bounds(bench: &Bench<'_>, uv: Vec2<f64>, layer: u32, around: &[Option<Hit>]) -> (f64, f64) {
    let [tau, depth_tolerance] = bench.frame.settings.tolerances().map(f64::from);
    let direction = bench.direction(uv, layer);
    let (tangent, own) = bound(bench, direction, around[4].as_ref().unwrap());
    let angle = 2.0 / (1.0 + uv.dot(uv));
    let snapped = match tau > 0.0 {
        true => depth_tolerance + (tau + DPSM_EDGE_SNAP) * bench.texel() * angle * tangent,
        false => 0.0,
    };
    let steepest = around.iter().flatten().map(|hit| {
        let corner = |i: u32| bench.frame.vertices[i as usize].position.as_dvec3();
        let [a, b, c] = bench.frame.triangles[hit.triangle as usize].map(corner);
        let (normal, d) = ((b - a).cross(c - a), direction);
        normal.cross(d).length() / normal.dot(d).abs()
    });
    let steepest = steepest.fold(0.0, f64::max);
    let shift = (tau * bench.texel() + DPSM_EDGE_ROUNDING) * angle;
    (own + snapped, own + snapped + shift * 2.0 * steepest)
}

fn around(hits: &[Option<Hit>], side: u32, layer: u32, x: u32, y: u32) -> Vec<Option<Hit>> {
    let inside = |c: u32, d: u32| (c + d).clamp(1, side) - 1;
    let at = |i: u32| (layer * side + inside(y, i / 3)) * side + inside(x, i % 3);
    (0..9).map(|i| hits[at(i) as usize]).collect()
}

/// Compares every texel inside the rim.
pub fn compare(bench: &Bench<'_>, hits: &[Option<Hit>]) -> Texels {
    let side = bench.maps.size;
    let mut texels = Texels::default();
    let (near, far) = (bench.light.near, bench.light.far);
    for (index, (&depth, hit)) in bench.maps.depths.iter().zip(hits).enumerate() {
        let (x, y, layer) =
            (index as u32 % side, index as u32 / side % side, index as u32 / side / side);
        let uv = centre(bench, x, y);
        let Some(hit) = hit.filter(|_| uv.length() <= 1.0) else { continue };
        let error =
            (dpsm_distance(f64::from(depth), near, far) - hit.distance).abs() / hit.distance;
        let around = around(hits, side, layer, x, y);
        let is_calm = around.iter().all(|other| other.is_some_and(|o| o.triangle == hit.triangle));
        if !is_calm && error <= WRONG {
            continue;
        }
        let (calm, crease) = bounds(bench, uv, layer, &around);
        if !is_calm {
            texels.within += usize::from(error <= crease);
            continue;
        }
        texels.calm += 1;
        texels.within += usize::from(error > WRONG && error <= calm);
        texels.largest = texels.largest.max(error);
        if calm <= 1e-5 {
            texels.conditioned = texels.conditioned.max(error);
        }
        if error / calm > texels.ratio {
            texels.ratio = error / calm;
            texels.at = format!(
                "layer {layer}, texel {x}, {y}, uv {} {}, triangle {}, stored {depth}, \
                 hit {}, error {error:.3e}, bound {calm:.3e}",
                uv.x, uv.y, hit.triangle, hit.distance
            );
        }
    }
    texels
}

/// The bound at the worst texel that no silhouette excuses, creases included.
pub fn worst_bound(bench: &Bench<'_>, hits: &[Option<Hit>], worst: &WorstTexel) -> f64 {
    let around = around(hits, bench.maps.size, worst.layer, worst.x, worst.y);
    bounds(bench, Vec2::new(worst.uv[0], worst.uv[1]), worst.layer, &around).1
}
