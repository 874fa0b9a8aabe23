//! Shadow error at surface points.

use std::f64::consts::TAU;

use rayon::prelude::*;
use serde::Serialize;

use super::footprint::{FEWEST_RAYS, Footprint, texel_place};
use super::{Bench, Point, percentile};
use crate::scalar::float::Vec2;

/// Radii in texels at which the true shadow edge is looked for.
const RINGS: [f64; 8] = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0];

/// Azimuths of each ring.
const AZIMUTHS: u32 = 16;

/// Halvings of a ring's gap: the edge is found to 1/1024 of it.
const HALVINGS: u32 = 10;

/// What the map says of a point, what is true, and why they may differ.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Judgement {
    /// Visibility by the map, in [0, 1].
    pub visibility: f32,
    /// The point's map: hemisphere or face.
    pub hemisphere: u32,
    /// Place in that map: disk coordinates, or the face's plane at distance 1.
    pub uv: [f64; 2],
    /// Stored distance of the texel that holds the point; infinite where it is empty.
    pub stored: f64,
    /// The point's own distance.
    pub own: f64,
    /// True where the point lies between near and far.
    pub inside: bool,
    /// True where ray casting sees the light.
    pub lit: bool,
    /// True where the rays over the footprint do not all agree.
    pub edge: bool,
    /// Distance from the point to what keeps the light from it; infinite where nothing does.
    pub gap: f64,
}

/// Judges one point.
pub fn judge(bench: &Bench<'_>, point: &Point) -> Judgement {
    let p = bench.to_light(point.world);
    let light = bench.frame.light;
    let at = bench.projection.lookup(p.narrow(), light);
    let (hemisphere, uv) = bench.place(point);
    let size = f64::from(bench.maps.size);
    let texel = |c: f32| (f64::from(c) * size).floor();
    let (x, y) = (texel(at.coordinates.x), texel(at.coordinates.y));
    let depth = match at.mapped {
        true => bench.maps.depth(bench.maps.index(x as i64, y as i64, at.layer)),
        false => 1.0,
    };
    let stored = match depth < 1.0 {
        true => bench.distance(f64::from(depth), texel_place(bench, [x + 0.5, y + 0.5])),
        false => f64::INFINITY,
    };
    let unmapped = !bench.is_mapped(point); // dark by definition, and so in truth
    let occluder = bench.occluder(point);
    let own = p.length();
    let [near, far] = bench.clip(point.world - bench.origin);
    Judgement {
        visibility: bench.visibility(point),
        hemisphere,
        uv: [uv.x, uv.y],
        stored,
        own,
        inside: (near..=far).contains(&own),
        lit: occluder.is_none() && !unmapped,
        edge: edge_point(bench, point),
        gap: occluder.map_or(f64::INFINITY, |hit| own - hit.distance),
    }
}

/// True of an edge point: the rays over the texels that its lookup reads do not all agree, or miss
/// the point's plane.
pub fn edge_point(bench: &Bench<'_>, point: &Point) -> bool {
    let Some(footprint) = Footprint::of(bench, point) else { return false };
    let sees = bench.sees(point);
    let rays = FEWEST_RAYS;
    (0..rays * rays).any(|i| {
        let uv = footprint.place(bench, i, rays);
        bench.reaches(point, uv, footprint.map).is_none_or(|reaches| reaches != sees)
    })
}

/// Distance in the map from a point to the nearest place where its plane's light changes, in
/// texels; `None` beyond the widest ring.
fn edge_distance(bench: &Bench<'_>, point: &Point) -> Option<f64> {
    let (hemisphere, uv) = bench.place(point);
    let sees = bench.sees(point);
    let differs = |azimuth: f64, texels: f64| {
        let step = Vec2::new(azimuth.cos(), azimuth.sin()) * (texels * bench.texel());
        bench.reaches(point, uv + step, hemisphere).is_some_and(|reaches| reaches != sees)
    };
    nearest_change(&RINGS, AZIMUTHS, HALVINGS, differs)
}

/// How far away something differs that is asked by azimuth and distance: on the first of some
/// ascending rings where it does on any of so many azimuths, the nearest place, found to a ring's gap
/// halved so often. `None` beyond the widest ring.
pub(crate) fn nearest_change(
    rings: &[f64],
    azimuths: u32,
    halvings: u32,
    differs: impl Fn(f64, f64) -> bool,
) -> Option<f64> {
    let mut inner = 0.0;
    for &outer in rings {
        let nearest = (0..azimuths)
            .map(|k| TAU * f64::from(k) / f64::from(azimuths))
            .filter(|&azimuth| differs(azimuth, outer))
            .map(|azimuth| {
                let (mut same, mut other) = (inner, outer);
                for _ in 0..halvings {
                    let middle = 0.5 * (same + other);
                    match differs(azimuth, middle) {
                        true => other = middle,
                        false => same = middle,
                    }
                }
                other
            })
            .min_by(f64::total_cmp);
        if nearest.is_some() {
            return nearest;
        }
        inner = outer;
    }
    None
}

/// Misclassified points, split by kind and by cause.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ShadowError {
    /// Points judged.
    pub points: usize,
    /// Points inside near or beyond far: compared there.
    pub outside_spheres: usize,
    /// Points in the hemisphere that a hemispherical light has no map for: dark by definition, in
    /// the map as in truth.
    pub unmapped: usize,
    /// Edge points.
    pub edge_points: usize,
    /// Lit points that the map shadows.
    pub false_shadow: usize,
    /// Shadowed points that the map lights.
    pub false_light: usize,
    /// Misclassified points that are not edge points: false shadow.
    pub faults_shadow: usize,
    /// Misclassified points that are not edge points: false light.
    pub faults_light: usize,
    /// Largest distance from a falsely lit point to its occluder, where the map does hold something
    /// nearer than the point and the bias alone lights it; edge points left out.
    pub contact_gap: f64,
    /// Misclassified points whose true shadow edge lies within 32 texels.
    pub near_edge: usize,
    /// Their distance from it in texels: median.
    pub edge_texels_median: f64,
    /// The same: largest.
    pub edge_texels_largest: f64,
    /// Their distance from it in radians: largest.
    pub edge_radians_largest: f64,
    /// Points within five texels of the seam between hemispheres, or of a face's edge.
    pub seam_points: usize,
    /// Of those, misclassified.
    pub seam_misclassified: usize,
}

impl ShadowError {
    /// Misclassified points.
    pub fn misclassified(&self) -> usize {
        self.false_shadow + self.false_light
    }

    /// Misclassified points that resolution does not explain; the goal is none.
    pub fn faults(&self) -> usize {
        self.faults_shadow + self.faults_light
    }
}

/// Judges all points; `point_done` is called after each.
pub fn shadow_error(
    bench: &Bench<'_>,
    points: &[Point],
    point_done: impl Fn() + Sync,
) -> ShadowError {
    let judged: Vec<(Judgement, Option<f64>)> = points
        .par_iter()
        .map(|point| {
            let judgement = judge(bench, point);
            let wrong = (judgement.visibility >= 0.5) != judgement.lit;
            let distance = if wrong { edge_distance(bench, point) } else { None };
            point_done();
            (judgement, distance)
        })
        .collect();
    let mut error = ShadowError { points: points.len(), ..ShadowError::default() };
    let mut texels = Vec::new();
    for (judgement, distance) in judged {
        let [u, v] = judgement.uv;
        let uv = Vec2::new(u, v);
        let seam = bench.at_seam(uv);
        error.seam_points += usize::from(seam);
        error.unmapped += usize::from(judgement.hemisphere >= bench.frame.light.hemispheres);
        error.edge_points += usize::from(judgement.edge);
        error.outside_spheres += usize::from(!judgement.inside);
        if (judgement.visibility >= 0.5) == judgement.lit {
            continue;
        }
        error.seam_misclassified += usize::from(seam);
        match judgement.lit {
            true => {
                error.false_shadow += 1;
                error.faults_shadow += usize::from(!judgement.edge);
            }
            false => {
                error.false_light += 1;
                error.faults_light += usize::from(!judgement.edge);
                // the texel holds the occluder, not the receiver that lies behind it
                let occluder = judgement.own - judgement.gap;
                let by_bias =
                    (judgement.stored - occluder).abs() < judgement.own - judgement.stored;
                if !judgement.edge && by_bias && judgement.gap.is_finite() {
                    error.contact_gap = error.contact_gap.max(judgement.gap);
                }
            }
        }
        if let Some(distance) = distance {
            texels.push(distance);
            let radians = distance * bench.pitch(uv);
            error.edge_radians_largest = error.edge_radians_largest.max(radians);
        }
    }
    texels.sort_by(f64::total_cmp);
    error.near_edge = texels.len();
    error.edge_texels_median = percentile(&texels, 0.5);
    error.edge_texels_largest = texels.last().copied().unwrap_or(0.0);
    error
}
