//! What a lookup's footprint holds of the surface that a point lies on.

use std::collections::HashSet;

use super::footprint::Footprint;
use super::silhouette::{Sample, Search};
use super::{Bench, Point};

/// Smallest jump of the distance that parts two surfaces, in texels: what is less shows nowhere.
const JUMP: f64 = 0.01;

/// Halvings of the gap between two rays before what is left of it is a jump: from a quarter of a
/// texel to 1.5e-5 of one, where slopes up to 600 stay below `JUMP`.
const HALVINGS: i32 = 14;

/// How much nearer than the receiver's plane an occluder is at the least, of the distance: rounding
/// in f64 stays far below.
const NEARER: f64 = 1e-9;

/// How far from the point its surface is followed over triangles that are connected, in texels.
const CONNECTED: f64 = 1.0;

/// What shows where a lookup of a point reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surroundings {
    /// The point is lit, and so is all around it: each first hit is on its own surface, or on one
    /// that touches it.
    SmoothlyLit,
    /// The point is in shadow, and so is all around it: each first hit is nearer than its plane and
    /// not on its own surface.
    DeepInShadow,
    /// An outline passes through, or the light has no map there.
    Mixed,
}

/// What the first hits over a point's footprint say; `lit` is what ray casting says of the point.
pub fn surroundings(bench: &Bench<'_>, point: &Point, lit: bool) -> Surroundings {
    let (Some(footprint), Some(triangle)) = (Footprint::of(bench, point), point.triangle) else {
        return Surroundings::Mixed;
    };
    let neighbourhood = Neighbourhood::new(bench, point, triangle, &footprint);
    match lit {
        true if neighbourhood.is_smooth() => Surroundings::SmoothlyLit,
        false if neighbourhood.is_hidden() => Surroundings::DeepInShadow,
        _ => Surroundings::Mixed,
    }
}

/// A point, and the first hits over its footprint.
struct Neighbourhood<'b> {
    search: Search<'b>,
    point: &'b Point,
    /// Row by row.
    rays: Vec<Sample>,
    /// Rays along a side.
    side: usize,
    /// Of the ball in which triangles are connected.
    radius: f64,
    /// The point's own triangle, and what is connected with it there.
    own: HashSet<u32>,
}

impl<'b> Neighbourhood<'b> {
    fn new(bench: &'b Bench<'b>, point: &'b Point, triangle: u32, footprint: &Footprint) -> Self {
        let (_, uv) = bench.place(point);
        let pitch = bench.pitch(uv);
        let search = Search { bench, tau: 0.0, jump: JUMP * pitch, from_light: true };
        let side = footprint.rays();
        let cast = |i| search.sample(footprint.direction(bench, i, side).normalize());
        let rays = (0..side * side).map(cast).collect();
        let texel = (point.world - bench.origin).length() * pitch;
        let radius = CONNECTED * texel;
        let own = bench.truth.connected(triangle, point.world, radius);
        Self { search, point, rays, side, radius, own }
    }

    /// True where the surface that is first hit goes on without a jump from the point to all rays,
    /// but for jumps between triangles that are connected.
    fn is_smooth(&self) -> bool {
        let bench = self.search.bench;
        let mut own = self.own.clone();
        let mut reached: Vec<bool> = self.rays.iter().map(|ray| is_on(ray, &own)).collect();
        let centre = self.search.sample((self.point.world - bench.origin).normalize());
        loop {
            let before = reached.iter().filter(|reached| **reached).count();
            if before == self.rays.len() {
                return true;
            }
            for i in 0..self.rays.len() {
                if reached[i] {
                    continue;
                }
                let ray = &self.rays[i];
                let Some((hit, _)) = ray.hit else { return false };
                let beside = self.beside(i);
                let mut from = beside.filter(|j| reached[*j]).map(|j| &self.rays[j]);
                let joined = |from: &Sample| self.search.is_joined(from, ray, HALVINGS);
                // a footprint that the point's own surface hardly fills has no ray on it
                reached[i] = is_on(ray, &own) || from.any(joined) || joined(&centre);
                if reached[i] && !own.contains(&hit.triangle) {
                    own.extend(bench.truth.connected(hit.triangle, self.point.world, self.radius));
                }
            }
            if reached.iter().filter(|reached| **reached).count() == before {
                return false;
            }
        }
    }

    /// The rays beside one, along rows and columns.
    fn beside(&self, i: usize) -> impl Iterator<Item = usize> {
        let (side, column, row) = (self.side, i % self.side, i / self.side);
        let left = (column > 0).then(|| i - 1);
        let right = (column + 1 < side).then(|| i + 1);
        let above = (row > 0).then(|| i - side);
        let below = (row + 1 < side).then(|| i + side);
        [left, right, above, below].into_iter().flatten()
    }

    /// True where each ray first hits something that is nearer than the point's plane and not
    /// connected with the point.
    fn is_hidden(&self) -> bool {
        let to_point = self.point.world - self.search.bench.origin;
        let hides = |ray: &Sample| {
            let Some((hit, _)) = ray.hit else { return false };
            let plane = match self.point.normal {
                Some(normal) => normal.dot(to_point) / normal.dot(ray.direction),
                None => to_point.length(),
            };
            // where the plane is not ahead, everything is nearer
            let nearer = plane <= 0.0 || hit.distance < plane * (1.0 - NEARER);
            nearer && !self.own.contains(&hit.triangle)
        };
        self.rays.iter().all(hides)
    }
}

fn is_on(ray: &Sample, triangles: &HashSet<u32>) -> bool {
    ray.hit.is_some_and(|(hit, _)| triangles.contains(&hit.triangle))
}
