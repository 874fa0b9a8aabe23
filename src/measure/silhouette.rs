//! Silhouettes: where the first hit's distance jumps as a ray's direction turns.
//!
//! Along the chord between two directions the inverse of a plane's distance is linear: 1 / t =
//! n . d / (n . p). So two planes differ nowhere by more than at the ends, and as a gap is halved a
//! crease's planes come together in it, while a silhouette's keep apart; docs/measure.md.

use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

use glam::DVec3;
use rayon::prelude::*;

use super::{Bench, world};
use crate::scalar::float::{Vec2, Vec3};
use crate::scalar::paraboloid::{dpsm_disk_to_texture, dpsm_texture_to_disk};
use crate::truth::Hit;

/// Smallest jump that counts, of the distance: a hundredth of what makes a texel wrong.
pub const JUMP: f64 = 1e-5;

/// Rays over a texel are at most this far apart, in texels.
const SPACING: f64 = 0.25;

/// An edge is looked at from this far on either side, in texels: farther than the cracks that f32
/// coordinates leave where a corner lies on a neighbour's edge, up to N = 4096.
const BESIDE: f64 = 1.0 / 1024.0;

/// Halvings of the gap between two rays before what is left of it is a jump. From a quarter of a
/// texel at N = 512, 2e-3 rad, they lead to 1e-10 rad, where slopes up to 1e5 stay below `JUMP`.
const HALVINGS: i32 = 24;

/// Which texels are asked about, and which of them an edge's silhouette passes through.
pub struct Marks(Vec<AtomicU8>);

const ASKED: u8 = 1;
const PASSED: u8 = 2;

impl Marks {
    /// Nothing asked yet.
    pub fn new(texels: usize) -> Self {
        Self((0..texels).map(|_| AtomicU8::new(0)).collect())
    }

    /// Asks about a texel, by its index in the maps.
    pub fn ask(&self, texel: usize) {
        self.0[texel].store(ASKED, Relaxed);
    }

    /// True where an edge's silhouette passes through a texel asked about.
    pub fn is_passed(&self, texel: usize) -> bool {
        self.0[texel].load(Relaxed) == PASSED
    }

    fn are_open(&self) -> bool {
        self.0.iter().any(|mark| mark.load(Relaxed) == ASKED)
    }

    fn is_open(&self, texel: usize) -> bool {
        self.0[texel].load(Relaxed) == ASKED
    }

    fn pass(&self, texel: usize) {
        self.0[texel].store(PASSED, Relaxed);
    }
}

/// A direction, its first hit, and the hit triangle's plane.
#[derive(Clone, Copy)]
pub struct Sample {
    /// Of unit length.
    pub direction: DVec3,
    /// The hit and the triangle's normal, of any length.
    pub hit: Option<(Hit, DVec3)>,
}

/// The search for silhouettes through texels grown by `tau` texels on each side.
pub struct Search<'b> {
    pub bench: &'b Bench<'b>,
    /// What texels are grown by.
    pub tau: f64,
    /// Smallest jump that counts, of the distance: [`JUMP`] where maps are judged.
    pub jump: f64,
    /// Where rays begin: at near where maps are judged, at the light where shadows are.
    pub from_light: bool,
}

impl Search<'_> {
    /// Marks the texels asked about that a silhouette along a triangle's edge passes through,
    /// however thin the triangle; `BESIDE` of a texel is the limit.
    pub fn mark_edges(&self, marks: &Marks) {
        if !marks.are_open() {
            return;
        }
        (0..self.bench.frame.triangles.len() as u32).into_par_iter().for_each(|triangle| {
            let [a, b, c] =
                self.bench.corners(triangle).map(|corner| world(self.bench.to_light(corner)));
            for [start, end] in [[a, b], [b, c], [c, a]] {
                self.mark_edge(start, end, marks);
            }
        });
    }

    /// Walks an edge, given in light space, in steps of half a `SPACING`.
    fn mark_edge(&self, start: DVec3, end: DVec3, marks: &Marks) {
        let normal = start.cross(end);
        // an edge that the light sees as a point has no sides
        let Some(across) = normal.try_normalize() else { return };
        let angle = normal.length().atan2(start.dot(end));
        let start = start.normalize();
        let along = across.cross(start);
        let bench = self.bench;
        let finest = bench.projection.finest_pitch(bench.light);
        let steps = (angle / (0.5 * SPACING * finest)).ceil().max(1.0);
        for step in 0..steps as u32 {
            let (sin, cos) = (angle * (f64::from(step) + 0.5) / steps).sin_cos();
            let on_edge = start * cos + along * sin;
            let mut jumps = None;
            let p = Vec3::new(on_edge.x, on_edge.y, on_edge.z);
            for layer in 0..bench.maps.layers {
                let Some(uv) = bench.projection.place_in(p, layer) else { continue };
                self.each_texel(uv, layer, |texel| {
                    if marks.is_open(texel) {
                        let aside = across * (BESIDE * bench.pitch(uv));
                        let jumps = *jumps.get_or_insert_with(|| self.jumps_across(on_edge, aside));
                        if jumps {
                            marks.pass(texel);
                        }
                    }
                });
            }
        }
    }

    /// Calls `visit` with every texel that, grown, holds a place.
    fn each_texel(&self, uv: Vec2<f64>, layer: u32, mut visit: impl FnMut(usize)) {
        let (maps, light) = (self.bench.maps, self.bench.light);
        let last = light.size - 1.0;
        let st = dpsm_disk_to_texture(uv, light.guard) * light.size;
        let range = |c: f64| {
            let [from, to] = [c - self.tau, c + self.tau].map(f64::floor);
            // an empty range outside the map, and for what is not a number
            (from <= last && to >= 0.0).then(|| from.max(0.0) as i64..=to.min(last) as i64)
        };
        let (Some(columns), Some(rows)) = (range(st.x), range(st.y)) else { return };
        for y in rows {
            for x in columns.clone() {
                visit(maps.index(x, y, layer));
            }
        }
    }

    fn jumps_across(&self, on_edge: DVec3, aside: DVec3) -> bool {
        let [a, b] = [on_edge - aside, on_edge + aside]
            .map(|direction| self.sample(self.bench.to_world * direction));
        // the gap is 2^-7 of what lies between two rays over the texel
        !self.is_joined(&a, &b, HALVINGS - 7)
    }

    /// True where the rays over the grown texel, its corners and its centre among them, find a
    /// silhouette.
    pub fn passes(&self, layer: u32, x: u32, y: u32) -> bool {
        let bench = self.bench;
        let reach = 0.5 + self.tau;
        let half = (reach / SPACING).ceil() as i32;
        let cast = |i: i32, j: i32| {
            let place =
                |c: u32, k: i32| f64::from(c) + 0.5 + reach * f64::from(k) / f64::from(half);
            let st = Vec2::new(place(x, i), place(y, j)) / bench.light.size;
            let uv = dpsm_texture_to_disk(st, bench.light.guard);
            self.sample(bench.direction(uv, layer).normalize())
        };
        let joined = |a: &Sample, b: &Sample| self.is_joined(a, b, HALVINGS);
        let mut above: Option<Vec<Sample>> = None;
        for j in -half..=half {
            let row: Vec<Sample> = (-half..=half).map(|i| cast(i, j)).collect();
            let along = row.windows(2).all(|pair| joined(&pair[0], &pair[1]));
            let down = above.iter().flatten().zip(&row).all(|(a, b)| joined(a, b));
            if !(along && down) {
                return true;
            }
            above = Some(row);
        }
        false
    }

    /// The first hit along a unit direction.
    pub fn sample(&self, direction: DVec3) -> Sample {
        let bench = self.bench;
        let hit = bench
            .first_hit(direction, self.from_light)
            .map(|hit| (hit, bench.normal(hit.triangle)));
        Sample { direction, hit }
    }

    /// True where the first hit's distance changes from one direction to the other without a jump,
    /// as far as rays tell.
    pub fn is_joined(&self, a: &Sample, b: &Sample, halvings: i32) -> bool {
        let (Some((hit_a, _)), Some((hit_b, _))) = (a.hit, b.hit) else {
            return a.hit.is_none() && b.hit.is_none();
        };
        // how far the two planes are apart at either end, of the distance there
        let at_a = (a.inverse(a.direction) - b.inverse(a.direction)) * hit_a.distance;
        let at_b = (a.inverse(b.direction) - b.inverse(b.direction)) * hit_b.distance;
        if hit_a.triangle == hit_b.triangle || (at_a.abs() <= self.jump && at_b.abs() <= self.jump)
        {
            return true;
        }
        if halvings <= 0 {
            return false;
        }
        let middle = self.sample((a.direction + b.direction).normalize());
        self.is_joined(a, &middle, halvings - 1) && self.is_joined(&middle, b, halvings - 1)
    }
}

impl Sample {
    /// The inverse distance of the hit plane along a unit direction; 0 or less where the plane is
    /// not ahead, NaN without a hit.
    fn inverse(&self, direction: DVec3) -> f64 {
        self.hit.map_or(f64::NAN, |(hit, normal)| {
            normal.dot(direction) / (normal.dot(self.direction) * hit.distance)
        })
    }
}
