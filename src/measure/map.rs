//! Map error: every texel's stored distance against the first hit along its direction.

use rayon::prelude::*;
use serde::Serialize;

use super::{Bench, percentile};
use crate::scalar::depth::dpsm_distance;
use crate::scalar::float::Vec2;
use crate::scalar::paraboloid::dpsm_texture_to_disk;

/// Where the rim band begins: r above this.
const RIM: f64 = 0.9;

/// Texels of one part of the maps, and what is wrong with them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Band {
    /// Texels whose centre lies in the band.
    pub texels: usize,
    /// Of those, texels where a surface is hit and one is stored.
    pub covered: usize,
    /// Texels where a surface is hit and none is stored.
    pub missing: usize,
    /// Texels where none is hit and one is stored.
    pub extra: usize,
    /// Covered texels off by more than 1% of the distance.
    pub off_1e2: usize,
    /// Covered texels off by more than 0.1% of the distance.
    pub off_1e3: usize,
    /// Largest relative error of the covered texels.
    pub largest: f64,
    /// 99th percentile of the covered texels' relative error.
    pub percentile_99: f64,
}

/// The error of all maps of a light.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MapError {
    /// Every texel whose centre lies inside the rim, r <= 1.
    pub all: Band,
    /// Those with r > 0.9.
    pub rim: Band,
    /// The others.
    pub centre: Band,
}

/// One texel inside the rim: its radius, and the stored and the true distance.
struct Texel {
    r: f64,
    stored: Option<f64>,
    hit: Option<f64>,
}

/// Compares every texel whose centre lies inside the rim; `row_done` is called after each row.
///
/// A stored depth of 1 is an empty texel.
pub fn map_error(bench: &Bench<'_>, row_done: impl Fn() + Sync) -> MapError {
    let rows: Vec<(u32, u32)> = (0..bench.maps.layers)
        .flat_map(|layer| (0..bench.maps.size).map(move |y| (layer, y)))
        .collect();
    let texels: Vec<Texel> = rows
        .into_par_iter()
        .flat_map_iter(|(layer, y)| {
            let texels: Vec<Texel> =
                (0..bench.maps.size).filter_map(|x| texel(bench, layer, x, y)).collect();
            row_done();
            texels
        })
        .collect();
    let rim = |texel: &&Texel| texel.r > RIM;
    MapError {
        all: band(texels.iter()),
        rim: band(texels.iter().filter(rim)),
        centre: band(texels.iter().filter(|texel| !rim(texel))),
    }
}

fn texel(bench: &Bench<'_>, layer: u32, x: u32, y: u32) -> Option<Texel> {
    let size = f64::from(bench.maps.size);
    let st = Vec2::new((f64::from(x) + 0.5) / size, (f64::from(y) + 0.5) / size);
    let uv = dpsm_texture_to_disk(st, bench.light.guard);
    let r = uv.length();
    if r > 1.0 {
        return None;
    }
    let depth = bench.maps.depths[bench.maps.index(x.into(), y.into(), layer)];
    let distance = dpsm_distance(f64::from(depth), bench.light.near, bench.light.far);
    let stored = (depth < 1.0).then_some(distance);
    Some(Texel { r, stored, hit: bench.first_distance(uv, layer) })
}

fn band<'t>(texels: impl Iterator<Item = &'t Texel>) -> Band {
    let mut band = Band::default();
    let mut errors = Vec::new();
    for texel in texels {
        band.texels += 1;
        match (texel.stored, texel.hit) {
            (Some(stored), Some(hit)) => errors.push((stored - hit).abs() / hit),
            (None, Some(_)) => band.missing += 1,
            (Some(_), None) => band.extra += 1,
            (None, None) => {}
        }
    }
    errors.sort_by(f64::total_cmp);
    let above = |limit: f64| errors.len() - errors.partition_point(|&error| error <= limit);
    band.covered = errors.len();
    band.off_1e2 = above(1e-2);
    band.off_1e3 = above(1e-3);
    band.largest = errors.last().copied().unwrap_or(0.0);
    band.percentile_99 = percentile(&errors, 0.99);
    band
}
