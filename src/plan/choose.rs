//! The sizes and formats that an axis allows, with their costs and errors.

use std::f64::consts::FRAC_1_SQRT_2;

use super::Sample;
use super::axis::Axis;
use super::cost::{EXACT, Rates, generation};
use crate::render::{Format, guard_band};
use crate::scalar::bias::{DPSM_RECEIVER_ROUNDING, dpsm_bias_slack};
use crate::scalar::float as scalar;
use crate::scalar::light::{DPSM_FORWARD, DpsmLight};
use crate::scalar::plane::{DPSM_PLANE_DARK, DPSM_PLANE_ROUNDING, DPSM_PLANE_SHIFT};

/// Sizes from what the edges ask for to so many times as much are tried: a finer map sees what is
/// nearer in front of a receiver.
const FINER: f64 = 4.0;

/// Sizes per octave.
const SIZES: u32 = 32;

/// Smallest map.
pub const LEAST_SIZE: u32 = 16;

/// Largest map: WebGPU's limit without asking for more.
pub const MOST_SIZE: u32 = 8192;

/// A way to make and read maps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Index of the axis.
    pub axis: usize,
    /// Texels along a side.
    pub size: u32,
    /// Storage.
    pub format: Format,
    /// Making the maps, ms.
    pub generation: f64,
    /// Reading them for all pixels, ms.
    pub lookup: f64,
    /// Bytes of all maps.
    pub bytes: u64,
    /// Predicted error as a share of the target.
    pub share: f64,
}

impl Candidate {
    /// What it costs.
    pub fn cost(&self) -> f64 {
        self.generation + self.lookup
    }

    /// By cost, and of what costs the same by memory.
    pub fn order(&self, other: &Self) -> std::cmp::Ordering {
        self.cost().total_cmp(&other.cost()).then(self.bytes.cmp(&other.bytes))
    }
}

/// What candidates are made for.
pub struct Case<'a> {
    /// Receivers of all lights.
    pub samples: &'a [Sample],
    /// Near and far sphere's radii.
    pub spheres: [f32; 2],
    /// Triangles that are sorted.
    pub sorted: usize,
    /// Pixels that look.
    pub pixels: u64,
    /// What steps cost.
    pub rates: &'a Rates,
}

/// How far a receiver's move along its normal takes it across the light's ray, in texels, by the
/// cosine of its incidence.
pub fn moved(incidence: f64) -> f64 {
    DPSM_PLANE_SHIFT * (1.0 - incidence * incidence)
}

/// How far from the true edge a point that is lit wrongly may be, in texels, by the cosine of its
/// incidence: 2 x 2 texels decide where the receiver is moved to, and those that are wrong weigh half
/// or more, however the shadow's border runs (docs/plan.md).
pub fn reach(incidence: f64) -> f64 {
    let moved = moved(incidence);
    // all but the nearest texel, from where that one weighs half
    let three = (1.0 + moved) * FRAC_1_SQRT_2;
    // two at one side, from the middle of the four
    three.hypot(1.0 - three).max((0.5 + moved).hypot(0.5))
}

/// How near in front of a receiver's plane what a texel holds may be without being in shadow for
/// certain, and how little nearer than the receiver itself, as shares of its distance. By the cosine
/// of its incidence and the angle of a texel.
pub fn undecided(incidence: f64, pitch: f64) -> [f64; 2] {
    let cosine = incidence.max(f64::MIN_POSITIVE);
    let sine = (1.0 - cosine * cosine).sqrt();
    // n . d grows by the move and by half a texel; the plane is nearer in inverse proportion
    let rounding = DPSM_RECEIVER_ROUNDING + DPSM_PLANE_ROUNDING;
    let grown = pitch * (DPSM_PLANE_DARK + DPSM_PLANE_SHIFT * sine / cosine) + rounding / cosine;
    [1.0 - 1.0 / (1.0 + grown), 1.0 - 1.0 / (1.0 + DPSM_PLANE_DARK * pitch)]
}

/// Bytes of a texel.
pub fn texel_bytes(format: Format) -> u64 {
    match format {
        Format::D16 => 2,
        Format::D24 | Format::D32 => 4,
    }
}

/// The smallest size of the ladder that is at least `size`.
pub fn ladder(size: f64) -> u32 {
    let size = size.clamp(f64::from(LEAST_SIZE), f64::from(MOST_SIZE)).ceil() as u32;
    size.next_multiple_of(step(size)).min(MOST_SIZE)
}

/// The largest size of the ladder that is at most `size`; `None` below the smallest.
pub fn ladder_below(size: f64) -> Option<u32> {
    let size = size.min(f64::from(MOST_SIZE)) as u32;
    (size >= LEAST_SIZE).then(|| size - size % step(size))
}

/// From one size of the ladder to the next.
fn step(size: u32) -> u32 {
    ((1 << size.ilog2()) / SIZES).max(8)
}

impl Case<'_> {
    /// The size that the shadow edges ask for.
    pub fn edge_size(&self, axis: &Axis) -> f64 {
        // the guard band is part of the side
        let guard = guard_band(axis.demand.clamp(1.0, f64::from(MOST_SIZE)) as u32);
        axis.demand * f64::from(1.0 + guard)
    }

    /// All candidates of an axis, from the size that the edges ask for upwards.
    pub fn candidates(&self, index: usize, axis: &Axis) -> Vec<Candidate> {
        let least = ladder(self.edge_size(axis));
        let most = (f64::from(least) * FINER).min(f64::from(MOST_SIZE)) as u32;
        let next = |size: &u32| Some(size + step(*size)).filter(|size| *size <= most);
        let mut found = Vec::new();
        for size in std::iter::successors(Some(least), next) {
            let formats = [Format::D16, Format::D32].into_iter();
            let fine = formats.filter(|format| self.is_fine(size, *format));
            found.extend(fine.map(|format| self.candidate(index, axis, size, format)));
        }
        found
    }

    /// True where a step of a format is no wider than a texel at the nearest caster.
    pub fn is_fine(&self, size: u32, format: Format) -> bool {
        let light = self.light(size);
        let texel = 2.0 * (1.0 + light.guard) / light.size;
        f64::from(format.quantum()) * (light.far - light.near) <= texel * light.near
    }

    /// One candidate, whatever its error.
    pub fn candidate(&self, index: usize, axis: &Axis, size: u32, format: Format) -> Candidate {
        let gap_share = self.gaps(axis, size, format);
        let edge_share = self.edge_size(axis) / f64::from(size);
        let maps = u64::from(axis.maps);
        Candidate {
            axis: index,
            size,
            format,
            generation: EXACT * generation(self.rates, &axis.loads, self.sorted, size),
            lookup: self.pixels as f64 * self.rates.lookup,
            bytes: maps * u64::from(size) * u64::from(size) * texel_bytes(format),
            share: edge_share.max(gap_share),
        }
    }

    /// The error as a share of the target where a lookup misses an occluder that is no farther in
    /// front of a shadowed receiver than it can tell.
    fn gaps(&self, axis: &Axis, size: u32, format: Format) -> f64 {
        let light = self.light(size);
        let range = light.far - light.near;
        let quantum = f64::from(format.quantum());
        let missed = |sample: &&Sample| {
            let cosine = sample.direction.dot(axis.axis);
            let pitch = 2.0 * (1.0 + cosine.abs()) * (1.0 + light.guard) / light.size;
            let (l, incidence) = (sample.distance, sample.incidence());
            // what is stored may be the neighbour above
            let slack = (dpsm_bias_slack(l, light, quantum, 0.0) + quantum) * range;
            let within = reach(incidence) * pitch;
            let [gap, behind] = undecided(incidence, pitch).map(|share| share * l + slack);
            sample.gap_within(within) <= gap || sample.behind_within(within) <= behind
        };
        let held = self.samples.iter().filter(|sample| sample.gap[0].is_finite());
        held.filter(missed).map(|sample| sample.edge / sample.allowed).fold(0.0, f64::max)
    }

    /// A light with maps of a size, as the slack needs it.
    fn light(&self, size: u32) -> DpsmLight<f64> {
        let [near, far] = self.spheres.map(f64::from);
        let none = scalar::Vec3::splat(0.0);
        DpsmLight {
            position: none,
            near,
            right: none,
            far,
            up: none,
            guard: f64::from(guard_band(size)),
            forward: none,
            size: f64::from(size),
            rectangle: scalar::Vec4::new(0.0, 0.0, 1.0, 1.0),
            first_layer: 0,
            placement: 0,
            hemispheres: 2,
            reversed: DPSM_FORWARD,
        }
    }
}
