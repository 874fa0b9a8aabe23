//! The sizes, formats and filters that an axis allows, with their costs and errors.

use super::Sample;
use super::axis::Axis;
use super::cost::{EXACT, Rates, generation};
use crate::render::{Format, guard_band};
use crate::scalar::bias::{
    DPSM_RECEIVER_ROUNDING, dpsm_bias_footprint, dpsm_bias_slack, dpsm_receiver,
};
use crate::scalar::float::{self as scalar, Vec2};
use crate::scalar::light::DpsmLight;
use crate::scalar::maps::Sampling;

/// How far from the true edge a point that is lit wrongly may be, in texels: half a texel's diagonal,
/// to its texel's centre. 2 x 2 texels compared together err by half a texel along a straight edge,
/// but by nearly as much as one at the corner of a shadow (docs/plan.md).
pub const REACH: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// How far the texels are, in texels, that 2 x 2 comparisons read, but for those of less weight.
const HARDWARE_WINDOW: f64 = 1.0;

/// Footprint biases that 2 x 2 comparisons must leave of a gap: a strip beside a concave edge is
/// seldom met by a sample, and the thinner the gap the narrower it is.
const BIASES: f64 = 8.0;

/// Sizes from what the edges ask for to so many times as much are tried: finer maps leave more of
/// a gap to be forgiven.
const FINER: f64 = 2.0;

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
    /// Hard test or 2 x 2.
    pub sampling: Sampling,
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

/// Format and sampling.
pub type How = (Format, Sampling);

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
        let plain = axis.demand * REACH;
        // the guard band is part of the side
        plain * f64::from(1.0 + guard_band(plain.clamp(1.0, f64::from(MOST_SIZE)) as u32))
    }

    /// All candidates of an axis, from the size that the edges ask for upwards.
    pub fn candidates(&self, index: usize, axis: &Axis) -> Vec<Candidate> {
        let least = ladder(self.edge_size(axis));
        let most = (f64::from(least) * FINER).min(f64::from(MOST_SIZE)) as u32;
        let next = |size: &u32| Some(size + step(*size)).filter(|size| *size <= most);
        let mut found = Vec::new();
        for size in std::iter::successors(Some(least), next) {
            for sampling in [Sampling::Nearest, Sampling::Linear] {
                for format in [Format::D16, Format::D32] {
                    found.push(self.candidate(index, axis, size, (format, sampling)));
                }
            }
        }
        found
    }

    /// One candidate, whatever its error.
    pub fn candidate(
        &self,
        index: usize,
        axis: &Axis,
        size: u32,
        (format, sampling): How,
    ) -> Candidate {
        let gap_share = self.gaps(axis, size, (format, sampling));
        let edge_share = self.edge_size(axis) / f64::from(size);
        let maps = u64::from(axis.maps);
        Candidate {
            axis: index,
            size,
            format,
            sampling,
            generation: EXACT * generation(self.rates, &axis.loads, self.sorted, size),
            lookup: self.pixels as f64
                * match sampling {
                    Sampling::Nearest => self.rates.hard,
                    Sampling::Linear => self.rates.hardware,
                },
            bytes: maps * u64::from(size) * u64::from(size) * texel_bytes(format),
            share: edge_share.max(gap_share),
        }
    }

    /// The error as a share of the target where a lookup forgives a gap that must hold.
    fn gaps(&self, axis: &Axis, size: u32, (format, sampling): How) -> f64 {
        let light = self.light(size);
        let range = light.far - light.near;
        let quantum = f64::from(format.quantum());
        let left = |sample: &Sample| {
            let cosine = sample.direction.dot(axis.axis);
            let pitch = 2.0 * (1.0 + cosine.abs()) * (1.0 + light.guard) / light.size;
            let l = sample.distance;
            let lean = DPSM_RECEIVER_ROUNDING * l / sample.incidence().max(f64::MIN_POSITIVE);
            // what is stored may be the neighbour above
            let slack = (dpsm_bias_slack(l, light, quantum, 0.0) + quantum) * range + lean;
            match sampling {
                Sampling::Nearest => sample.gap_within(REACH * pitch) - slack,
                // the receiver's own distance less the bias is compared
                Sampling::Linear => {
                    let bias = BIASES * range * footprint(sample, cosine, &light);
                    sample.behind_within(HARDWARE_WINDOW * pitch) - slack - bias
                }
            }
        };
        let held = self.samples.iter().filter(|sample| sample.gap[0].is_finite());
        let forgiven = held.filter(|sample| left(sample) <= 0.0);
        forgiven.map(|sample| sample.edge / sample.allowed).fold(0.0, f64::max)
    }

    /// A light with maps of a size, as the biases need it.
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
            padding: 0,
        }
    }
}

/// The footprint's bias of a sample whose direction has a cosine with the axis.
fn footprint(sample: &Sample, cosine: f64, light: &DpsmLight<f64>) -> f64 {
    // only the distance from the axis counts, and the incidence
    let c = cosine.abs().min(1.0);
    let r = ((1.0 - c) / (1.0 + c)).sqrt();
    let incidence = sample.incidence();
    let l = sample.distance;
    let p = scalar::Vec3::new(0.0, 0.0, l);
    let normal = scalar::Vec3::new((1.0 - incidence * incidence).sqrt(), 0.0, incidence);
    dpsm_bias_footprint(dpsm_receiver(p, normal), Vec2::new(r, 0.0), 1.0, *light)
}
