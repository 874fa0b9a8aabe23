//! Which meshes the vertex method draws as well as the hybrid one: their triangles are so small that
//! edges bow little, and distances err by less than the footprint's bias forgives.

use glam::DVec3;

use super::cost::{Load, Rates, Seen, loads};

/// How far the straight edges of such meshes may bow, in texels; lookups may be off by as much more.
pub const BOW: f64 = 1.0 / 16.0;

/// The least 1 + cos of the angle between a corner and a map's axis: a triangle that reaches farther
/// behind the map is not drawn straight.
const BEHIND: f64 = 0.75;

/// A mesh as an axis sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshLoad {
    /// Its place among the scene's meshes.
    pub mesh: usize,
    /// Its triangles.
    pub triangles: f64,
    /// What each map holds of it, the mean over the lights.
    pub loads: Vec<Load>,
    /// The largest maps that the vertex method draws it into, texels along a side.
    pub largest: f64,
}

/// The meshes that are kept, for all lights.
pub fn meshes(seen: &[Vec<Seen>], axis: DVec3, maps: usize) -> Vec<MeshLoad> {
    let last = seen.iter().flatten().map(|triangle| triangle.mesh).max();
    let share = 1.0 / seen.len().max(1) as f64;
    let of_mesh = |mesh: usize| {
        let mut of_mesh = MeshLoad {
            mesh,
            triangles: 0.0,
            loads: vec![Load::default(); maps],
            largest: f64::INFINITY,
        };
        for light in seen {
            // triangles come mesh by mesh
            let first = light.partition_point(|triangle| triangle.mesh < mesh);
            let end = light.partition_point(|triangle| triangle.mesh <= mesh);
            let triangles = &light[first..end];
            of_mesh.triangles += triangles.len() as f64 * share;
            for (sum, load) in of_mesh.loads.iter_mut().zip(loads(triangles, axis)) {
                sum.add(&load, share);
            }
            let largest = triangles.iter().map(|triangle| largest(triangle, axis, maps));
            of_mesh.largest = largest.fold(of_mesh.largest, f64::min);
        }
        of_mesh
    };
    let all = (0..last.map_or(0, |last| last + 1)).map(of_mesh);
    all.filter(|mesh| mesh.triangles > 0.0).collect()
}

impl MeshLoad {
    /// Milliseconds that the mesh alone takes, passes and cleared texels left out.
    fn cost(&self, rates: &Rates, size: f64) -> f64 {
        let of_map = |load: &Load| {
            rates.triangle * load.triangles
                + rates.outline * load.outline * size
                + rates.inside * load.inside * size * size
        };
        rates.sort * self.triangles + self.loads.iter().map(of_map).sum::<f64>()
    }

    /// Milliseconds that drawing it by the vertex method saves at a size; `None` where it may not be,
    /// or saves nothing.
    pub fn saves(&self, sorted: &Rates, straight: &Rates, size: u32) -> Option<f64> {
        let size = f64::from(size);
        let saved = self.cost(sorted, size) - self.cost(straight, size);
        (size <= self.largest && saved > 0.0).then_some(saved)
    }
}

/// The largest maps in which a triangle may be drawn straight.
fn largest(triangle: &Seen, axis: DVec3, maps: usize) -> f64 {
    let sides = [axis, -axis];
    let both = triangle.straddles(axis);
    let own = triangle.corners.iter().map(|corner| corner.dot(axis)).sum::<f64>() < 0.0;
    let drawn = |map: usize| both || (map == 1) == own;
    let of_map = |map: usize| in_map(triangle, sides[map]);
    (0..maps).filter(|map| drawn(*map)).map(of_map).fold(f64::INFINITY, f64::min)
}

fn in_map(triangle: &Seen, axis: DVec3) -> f64 {
    let up = triangle.corners.map(|corner| 1.0 + corner.dot(axis));
    let least = up.into_iter().fold(f64::INFINITY, f64::min);
    if least < BEHIND {
        return 0.0;
    }
    // the sagitta of an edge whose chord on the disk is |a - b| / sqrt(up up) of its ends: docs/edge.md
    let bow = |i: usize, j: usize| {
        let (a, b) = (triangle.corners[i], triangle.corners[j]);
        let lean = a.cross(b).normalize_or_zero().dot(axis).abs();
        (a - b).length_squared() / (up[i] * up[j]) * lean / 16.0
    };
    let bow = bow(0, 1).max(bow(1, 2)).max(bow(2, 0));
    // r^2 = (1 - cos) / (1 + cos), 1 + r^2 = 2 / up
    let [inner, outer] = [up.into_iter().fold(0.0, f64::max), least].map(|up| 2.0 / up);
    let r = (outer - 1.0).max(0.0).sqrt();
    let cosine = triangle.steepest;
    let square = (cosine * cosine).max(f64::MIN_POSITIVE);
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    // affine depth: docs/measure.md; no distance is beyond the corners'
    let affine = triangle.widest * triangle.widest / 6.0
        * ((2.0 - square) / square + r * sine / square.sqrt());
    let affine = affine.min(triangle.spread);
    // the footprint's bias is drop / (cos + drop) of the distance, drop = sin c - cos c^2 / 2 for
    // the chord c to the corner of its window: docs/bias.md
    let drop = affine * cosine / (1.0 - affine).max(f64::MIN_POSITIVE);
    let root = sine * sine - 2.0 * cosine * drop;
    if affine >= 1.0 || root < 0.0 {
        return 0.0;
    }
    let chord = 2.0 * drop / (sine + root.sqrt()).max(f64::MIN_POSITIVE);
    // of a window of one texel, sqrt(2) texels of 2 / N: c = 4 sqrt(2) / (N (1 + r^2))
    let by_depth = 4.0 * std::f64::consts::SQRT_2 / (outer.max(inner) * chord);
    by_depth.min(BOW / bow.max(f64::MIN_POSITIVE))
}
