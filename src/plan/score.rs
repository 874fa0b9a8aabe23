//! A plan put to the proof: how far points that a frame's maps light wrongly are from the true
//! shadow edge.

use std::f64::consts::TAU;
use std::sync::OnceLock;

use fastrand::Rng;
use glam::DVec3;
use rayon::prelude::*;

use super::sight::{Ends, turned};
use super::{Sight, Target};
use crate::measure::{Bench, Point};
use crate::render::{Bias, Frame};
use crate::scalar::bias::dpsm_receiver;
use crate::scalar::float::Vec2;
use crate::scalar::maps::Sampling;
use crate::scalar::paraboloid::{dpsm_disk_to_texture, dpsm_texture_to_disk};
use crate::scalar::plane::{DPSM_PLANE_SHIFT, dpsm_plane, dpsm_plane_four};

/// Azimuths in which an edge is looked for: the nearest is at most 1 / cos(pi / 32) as far as in
/// the best direction, 0.5%.
const AZIMUTHS: u32 = 32;

/// Rings, in allowed angles: the first that meets an edge ends the search.
const RINGS: [f64; 7] = [0.2, 0.4, 0.7, 1.0, 1.25, 2.0, 8.0];

/// Error of a point with no edge within the widest ring.
const NO_EDGE: f64 = 8.0;

/// Azimuths and rings that tell which points are beside an edge.
const BESIDE: (u32, [f64; 2]) = (8, [0.5, 1.5]);

/// Points made around each point beside an edge, where wrong ones are.
const AROUND: usize = 64;

/// Points, and the truth about them, for any number of frames with the same light.
#[derive(Debug)]
pub struct Proof<'a> {
    sight: Sight<'a>,
    casters: Sight<'a>,
    target: Target,
    points: Vec<Point>,
    lit: Vec<bool>,
    edges: Vec<OnceLock<f64>>,
}

/// The points that a frame lights wrongly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrong {
    /// Points.
    pub points: usize,
    /// Wrong ones.
    pub wrong: usize,
    /// Those beyond the target.
    pub beyond: usize,
    /// The largest distance from the true edge, as a share of the target.
    pub share: f64,
    /// Where.
    pub place: Option<DVec3>,
}

impl<'a> Proof<'a> {
    /// Casts a ray to each point.
    ///
    /// `sights` are the light among all triangles, and among those of the meshes that maps hold: a
    /// wall that none holds ends a shadow in the one, while in the other it goes on behind it.
    pub fn new(sights: [Sight<'a>; 2], target: Target, points: Vec<Point>) -> Self {
        let [sight, casters] = sights;
        let lit = points.par_iter().map(|point| sight.is_lit(point)).collect();
        let edges = points.iter().map(|_| OnceLock::new()).collect();
        Self { sight, casters, target, points, lit, edges }
    }

    /// As `new`, with more points beside shadow edges, where a map can be wrong: on the triangles
    /// of those points that are beside one, as far from it as the target allows. `eye` must see
    /// them; without one they only need to lie on the triangle. What lies behind a hemispherical
    /// light's `axis` is dark by definition and left out.
    pub fn beside_edges(
        sights: [Sight<'a>; 2],
        target: Target,
        mut points: Vec<Point>,
        eye: Option<DVec3>,
        axis: Option<DVec3>,
        seed: u64,
    ) -> Self {
        let (azimuths, rings) = BESIDE;
        let sight = sights[0];
        let around = |(seed, point): (u64, &Point)| {
            let mut rng = Rng::with_seed(seed);
            let to_point = point.world - sight.origin;
            let allowed = target.angle(to_point.length());
            let edge = sight.edge(point, &rings.map(|ring| ring * allowed), azimuths, Ends::Pass);
            let count = if edge.is_finite() { AROUND } else { 0 };
            let direction = to_point.normalize_or_zero();
            let beside = (0..count).filter_map(|_| {
                let angle = rng.f64() * (edge + allowed);
                let turned = turned(direction, rng.f64() * TAU, angle);
                sight.on_triangle(point, turned, eye)
            });
            beside.collect::<Vec<_>>()
        };
        let numbered: Vec<(u64, &Point)> = (seed..).zip(&points).collect();
        let more: Vec<Vec<Point>> = numbered.into_par_iter().map(around).collect();
        points.extend(more.into_iter().flatten());
        let front = |p: &Point| axis.is_none_or(|axis| (p.world - sight.origin).dot(axis) >= 0.0);
        points.retain(front);
        Self::new(sights, target, points)
    }

    /// The points.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Judges a frame's maps.
    pub fn wrong(&self, bench: &Bench<'_>) -> Wrong {
        let all = 0..self.points.len();
        let found = all.into_par_iter().filter_map(|index| self.is_wrong(bench, index));
        let mut wrong = Wrong { points: self.points.len(), ..Wrong::default() };
        for (index, share) in found.collect::<Vec<_>>() {
            wrong.wrong += 1;
            wrong.beyond += usize::from(share > 1.0);
            if share > wrong.share {
                wrong.share = share;
                wrong.place = Some(self.points[index].world);
            }
        }
        wrong
    }

    /// True where no point that the maps light wrongly is farther from the true edge than the
    /// target; as `wrong`, but ends with the first that is.
    pub fn holds(&self, bench: &Bench<'_>) -> bool {
        let all = 0..self.points.len();
        !all.into_par_iter()
            .any(|index| self.is_wrong(bench, index).is_some_and(|(_, share)| share > 1.0))
    }

    /// True where a lit point has no map in a frame.
    pub fn needs_other_half(&self, frame: &Frame) -> bool {
        let [x, y, z] = [frame.light.forward.x, frame.light.forward.y, frame.light.forward.z];
        let forward = DVec3::new(x.into(), y.into(), z.into());
        let behind = |point: &Point| (point.world - self.sight.origin).dot(forward) < 0.0;
        frame.light.hemispheres == 1
            && self.points.iter().zip(&self.lit).any(|(point, lit)| *lit && behind(point))
    }

    fn is_wrong(&self, bench: &Bench<'_>, index: usize) -> Option<(usize, f64)> {
        let point = &self.points[index];
        let (map, _) = bench.place(point);
        let mapped = map < bench.frame.light.hemispheres;
        let shown = mapped && bench.visibility(point) >= 0.5;
        if shown == self.lit[index] {
            return None;
        }
        let mut share = *self.edges[index].get_or_init(|| self.edge(point));
        if share > 1.0 {
            share = share.min(self.edge_at_centres(bench, point));
        }
        Some((index, share))
    }

    /// The same for an edge so narrow that no ring meets it: one that a texel's centre lies behind.
    fn edge_at_centres(&self, bench: &Bench<'_>, point: &Point) -> f64 {
        let (map, uv) = bench.place(point);
        let (light, guard) = (bench.light, bench.light.guard);
        let settings = &bench.frame.settings;
        let (first, side) = match (settings.bias_taken(), bench.maps.sampling) {
            (Bias::Plane, _) => {
                // the four around the receiver that is moved along its normal
                let (p, normal) = bench.receiver(point);
                let receiver = dpsm_receiver(p.widen(), normal.widen(), 0.0);
                let at = dpsm_plane(p.widen(), receiver, DPSM_PLANE_SHIFT, light, 0.0, 0.0);
                (dpsm_plane_four(at, light).xy(), 2)
            }
            (_, Sampling::Nearest) => ((dpsm_disk_to_texture(uv, guard) * light.size).floor(), 1),
            (_, Sampling::Linear) => {
                let half = Vec2::splat(0.5);
                ((dpsm_disk_to_texture(uv, guard) * light.size - half).floor(), 2)
            }
        };
        let centres = (0..side).flat_map(|y| (0..side).map(move |x| [x, y].map(f64::from)));
        let allowed = self.allowed(point);
        let shares = centres.map(|[x, y]| {
            let centre = (first + Vec2::new(x + 0.5, y + 0.5)) / light.size;
            let direction = bench.direction(dpsm_texture_to_disk(centre, guard), map);
            let towards = |sight: Sight<'_>| sight.edge_towards(point, direction.normalize());
            towards(self.sight).min(towards(self.casters)) / allowed
        });
        shares.fold(NO_EDGE, f64::min)
    }

    fn allowed(&self, point: &Point) -> f64 {
        self.target.angle((point.world - self.sight.origin).length())
    }

    /// The distance from the true edge as a share of the target.
    fn edge(&self, point: &Point) -> f64 {
        let allowed = self.allowed(point);
        let rings = RINGS.map(|ring| ring * allowed);
        let edge = |sight: Sight<'_>| sight.edge(point, &rings, AZIMUTHS, Ends::Count);
        (edge(self.sight).min(edge(self.casters)) / allowed).min(NO_EDGE)
    }
}
