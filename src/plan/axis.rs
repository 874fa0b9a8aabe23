//! Where the seam goes: the axis around which the maps lie.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

use super::Sample;
use super::choose::reach;
use super::cost::{Load, Seen, loads};

/// The least cosine between a receiver that shows and the axis of a single map, so that receivers
/// between the samples are in it as well: two degrees.
const RIM_MARGIN: f64 = 0.035;

/// Steps towards the axis with the widest margin.
const CENTRING: u32 = 256;

/// Steps of the local search in radians: halved from the first until below the last.
const STEPS: [f64; 2] = [0.4, 0.01];

/// An axis, its maps' loads, and how fine they must be.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Where it comes from.
    pub name: String,
    /// Unit, world space.
    pub axis: DVec3,
    /// Maps around it: 1 or 2.
    pub maps: u32,
    /// What each holds, the mean over the lights.
    pub loads: Vec<Load>,
    /// Texels along a side, guard band left out, that the shadow edges ask for.
    pub demand: f64,
    /// Triangles that the seam cuts.
    pub straddling: usize,
}

/// What axes are judged by.
pub struct Judge<'a> {
    /// Receivers of all lights.
    pub samples: &'a [Sample],
    /// Casters, as each light sees them.
    pub seen: &'a [Vec<Seen>],
    /// What an axis costs.
    pub cost: &'a dyn Fn(&Axis) -> f64,
}

impl Judge<'_> {
    /// An axis with its figures.
    pub fn axis(&self, name: &str, axis: DVec3, maps: u32) -> Axis {
        let mut sum = vec![Load::default(); maps as usize];
        for seen in self.seen {
            for (sum, load) in sum.iter_mut().zip(loads(seen, axis)) {
                sum.add(&load, 1.0 / self.seen.len() as f64);
            }
        }
        let straddling = self.seen.iter().flatten().filter(|t| t.straddles(axis)).count();
        let straddling = straddling / self.seen.len().max(1);
        Axis { name: name.into(), axis, maps, loads: sum, demand: self.demand(axis), straddling }
    }

    /// A texel spans 2 (1 + |cos|) (1 + guard) / N at a direction, and a lookup errs by `reach`
    /// texels: their share of the room there.
    fn demand(&self, axis: DVec3) -> f64 {
        let texel = |sample: &Sample| 2.0 * (1.0 + sample.direction.dot(axis).abs());
        let of = |sample: &Sample| reach(sample.incidence()) * texel(sample) / sample.room;
        self.samples.iter().map(of).fold(0.0, f64::max)
    }

    /// The cheapest of some axes, and what a local search makes of it.
    pub fn best(&self, candidates: &[(String, DVec3)], maps: u32) -> Vec<Axis> {
        let fits = |axis: DVec3| maps == 2 || self.holds_all(axis);
        let mut found: Vec<Axis> = candidates
            .iter()
            .filter(|(_, axis)| fits(*axis))
            .map(|(name, axis)| self.axis(name, *axis, maps))
            .collect();
        let cheapest = found.iter().min_by(|a, b| (self.cost)(a).total_cmp(&(self.cost)(b)));
        let Some(mut best) = cheapest.cloned() else { return found };
        let mut step = STEPS[0];
        while step > STEPS[1] {
            let (side, other) = best.axis.any_orthonormal_pair();
            let around = (0..8).map(|k| (TAU * f64::from(k) / 8.0).sin_cos());
            let turned = around.map(|(sin, cos)| {
                (best.axis * step.cos() + (side * cos + other * sin) * step.sin()).normalize()
            });
            let nearby = turned.filter(|axis| fits(*axis));
            let nearby = nearby.map(|axis| self.axis("a local search", axis, maps));
            let better = nearby.min_by(|a, b| (self.cost)(a).total_cmp(&(self.cost)(b)));
            match better.filter(|better| (self.cost)(better) < (self.cost)(&best)) {
                Some(better) => best = better,
                None => step *= 0.5,
            }
        }
        found.push(best);
        found
    }

    /// True where all receivers lie well inside the hemisphere around an axis.
    fn holds_all(&self, axis: DVec3) -> bool {
        self.samples.iter().all(|sample| sample.direction.dot(axis) >= RIM_MARGIN)
    }

    /// The axis whose farthest receiver is as far from the rim as can be; `None` where none holds
    /// all of them.
    pub fn centre(&self) -> Option<DVec3> {
        let sum: DVec3 = self.samples.iter().map(|sample| sample.direction).sum();
        let mut axis = sum.try_normalize()?;
        let mut best = (f64::NEG_INFINITY, axis);
        for step in 0..CENTRING {
            let outermost = self.samples.iter().map(|sample| sample.direction);
            let outermost = outermost.min_by(|a, b| a.dot(axis).total_cmp(&b.dot(axis)))?;
            if outermost.dot(axis) > best.0 {
                best = (outermost.dot(axis), axis);
            }
            axis = (axis + outermost / f64::from(step + 2)).try_normalize()?;
        }
        (best.0 >= RIM_MARGIN).then_some(best.1)
    }

    /// The principal axes of the receivers' directions, weighted by how fine they must be.
    pub fn principal(&self) -> [DVec3; 3] {
        let outer = |v: DVec3| DMat3::from_cols(v * v.x, v * v.y, v * v.z);
        let moment = self.samples.iter().fold(DMat3::ZERO, |sum, sample| {
            sum + outer(sample.direction) * (sample.allowed / sample.room).powi(2)
        });
        eigenvectors(moment)
    }
}

/// The eigenvectors of a symmetric matrix, by Jacobi's rotations.
fn eigenvectors(mut m: DMat3) -> [DVec3; 3] {
    const SWEEPS: usize = 16;
    let mut vectors = DMat3::IDENTITY;
    for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(3 * SWEEPS) {
        let off = m.col(q)[p];
        if off == 0.0 {
            continue;
        }
        let angle = 0.5 * (2.0 * off).atan2(m.col(q)[q] - m.col(p)[p]);
        let angle = if angle.abs() > PI / 4.0 { angle - angle.signum() * PI / 2.0 } else { angle };
        let (sin, cos) = angle.sin_cos();
        let mut turn = DMat3::IDENTITY;
        turn.col_mut(p)[p] = cos;
        turn.col_mut(q)[q] = cos;
        turn.col_mut(q)[p] = sin;
        turn.col_mut(p)[q] = -sin;
        m = turn.transpose() * m * turn;
        vectors *= turn;
    }
    [vectors.x_axis, vectors.y_axis, vectors.z_axis].map(|v| v.normalize_or(DVec3::X))
}
