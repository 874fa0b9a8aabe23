//! Map error: every texel's stored distance against the first hit along its direction.

use rayon::prelude::*;
use serde::Serialize;

use super::Bench;
use super::band::{Band, Part, larger};
use super::silhouette::{JUMP, Marks, Search};
use crate::scalar::float::Vec2;
use crate::scalar::paraboloid::dpsm_texture_to_disk;

/// Where the rim band begins: r above this; on a cube's face r = max(|u|, |v|).
const RIM: f64 = 0.9;

/// Largest tolerance in texels: each examined texel costs 16 (1 + 2 tau)^2 rays.
pub const MAX_TAU: f64 = 4.0;

/// The covered texel with the largest error of those that no silhouette passes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WorstTexel {
    /// Layer: the hemisphere, or the face.
    pub layer: u32,
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// Place of its centre in the map.
    pub uv: [f64; 2],
    /// Stored distance.
    pub stored: f64,
    /// True distance.
    pub hit: f64,
    /// Relative error.
    pub error: f64,
    /// Angle in radians between the texel's direction and the normal of what it hits.
    pub incidence: f64,
    /// eps tan(incidence): what turning the direction by the f32 eps changes the distance by,
    /// relatively.
    pub conditioning: f64,
}

/// The error of all maps of a light.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MapError {
    /// How far outside a texel a silhouette excuses it, in texels.
    pub tau: f64,
    /// Every texel whose centre lies inside the rim, r <= 1; on a face r = max(|u|, |v|).
    pub all: Band,
    /// Those with r > 0.9.
    pub rim: Band,
    /// The others.
    pub centre: Band,
    /// The texel of `largest_rest`; `None` where no texel is covered or all are excused.
    pub worst: Option<WorstTexel>,
}

/// One texel: its place, and the stored and the true distance.
#[derive(Clone, Copy)]
pub struct Texel {
    pub index: usize,
    pub layer: u32,
    pub x: u32,
    pub y: u32,
    pub uv: Vec2<f64>,
    pub stored: Option<f64>,
    pub hit: Option<f64>,
}

/// Compares every texel whose centre lies inside the rim; `row_done` is called after each row.
///
/// A stored depth of 1 is an empty texel. `tau` is a tolerance in texels, 0 to [`MAX_TAU`]; what
/// lies outside counts as the nearer of the two, and what is not a number as 0.
pub fn map_error(bench: &Bench<'_>, tau: f64, row_done: impl Fn() + Sync) -> MapError {
    let tau = if tau.is_nan() { 0.0 } else { tau.clamp(0.0, MAX_TAU) };
    let rows: Vec<(u32, u32)> = (0..bench.maps.layers)
        .flat_map(|layer| (0..bench.maps.size).map(move |y| (layer, y)))
        .collect();
    let rows: Vec<[Part; 2]> = rows
        .into_par_iter()
        .map(|(layer, y)| {
            let mut parts = <[Part; 2]>::default();
            for x in 0..bench.maps.size {
                let index = bench.maps.index(x.into(), y.into(), layer);
                let r = bench.projection.radius(place(bench, index).3);
                if r <= 1.0 {
                    parts[usize::from(r <= RIM)].add(bench, &Texel::at(bench, index));
                }
            }
            row_done();
            parts
        })
        .collect();
    let [mut rim, mut centre] = <[Part; 2]>::default();
    for [in_rim, in_centre] in rows {
        rim.join(in_rim);
        centre.join(in_centre);
    }
    let search = Search { bench, tau, jump: JUMP, from_light: false };
    let marks = Marks::new(bench.maps.depths.len());
    rim.ask(&marks);
    centre.ask(&marks);
    search.mark_edges(&marks);
    let worst = [&mut rim, &mut centre].map(|part| part.judge(&search, &marks));
    let worst = worst.into_iter().fold(None, larger);
    let (in_rim, in_centre) = (rim.finish(), centre.finish());
    rim.join(centre);
    MapError {
        tau,
        all: rim.finish(),
        rim: in_rim,
        centre: in_centre,
        worst: worst.and_then(|off| Texel::at(bench, off.index).describe(bench)),
    }
}

/// Layer, column, row and the centre's place of a texel.
fn place(bench: &Bench<'_>, index: usize) -> (u32, u32, u32, Vec2<f64>) {
    let side = bench.maps.size as usize;
    let (layer, y, x) = (index / side / side, index / side % side, index % side);
    let st = Vec2::new(x as f64 + 0.5, y as f64 + 0.5) / side as f64;
    (layer as u32, x as u32, y as u32, dpsm_texture_to_disk(st, bench.light.guard))
}

impl Texel {
    /// The texel of an index in the maps.
    pub fn at(bench: &Bench<'_>, index: usize) -> Self {
        let (layer, x, y, uv) = place(bench, index);
        let depth = bench.maps.depth(index);
        let stored = (depth < 1.0).then(|| bench.distance(f64::from(depth), uv));
        Self { index, layer, x, y, uv, stored, hit: bench.first_distance(uv, layer) }
    }

    /// Relative error; infinite where only one of both is there, 0 where neither is.
    pub fn error(&self) -> f64 {
        match (self.stored, self.hit) {
            (Some(stored), Some(hit)) => (stored - hit).abs() / hit,
            (None, None) => 0.0,
            _ => f64::INFINITY,
        }
    }

    /// True where a silhouette passes through the grown texel.
    pub fn is_excused(&self, search: &Search<'_>, marks: &Marks) -> bool {
        marks.is_passed(self.index) || search.passes(self.layer, self.x, self.y)
    }

    fn describe(&self, bench: &Bench<'_>) -> Option<WorstTexel> {
        let direction = bench.direction(self.uv, self.layer);
        let normal = bench.normal(bench.first_hit(direction, false)?.triangle);
        // by sine and cosine, accurate at 0 and at 90 degrees
        let tangent = normal.cross(direction).length() / normal.dot(direction).abs();
        Some(WorstTexel {
            layer: self.layer,
            x: self.x,
            y: self.y,
            uv: [self.uv.x, self.uv.y],
            stored: self.stored?,
            hit: self.hit?,
            error: self.error(),
            incidence: tangent.atan(),
            conditioning: f64::from(f32::EPSILON) * tangent,
        })
    }
}
