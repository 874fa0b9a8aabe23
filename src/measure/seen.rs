//! What a person sees first: acne, leaks, and how much is wrong, nothing excused.

use rayon::prelude::*;
use serde::Serialize;

use super::{Bench, Point, Surroundings, surroundings, turned_away};

/// Acne, leaks, and all that is wrong, against the hard truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SeenError {
    /// Points judged.
    pub points: usize,
    /// Points whose visibility, at least 1/2 or not, disagrees with the truth.
    pub wrong: usize,
    /// Of these, points on sides of solids that are turned away from the light ([`turned_away`]):
    /// shading leaves them dark.
    pub wrong_turned_away: usize,
    /// Root of the mean squared difference of the visibility from the truth, 0 or 1.
    pub rmse: f64,
    /// Points that are smoothly lit.
    pub smoothly_lit: usize,
    /// Of these, points of a visibility below 1/2.
    pub acne: usize,
    /// The mean of 1 - visibility over the smoothly lit points.
    pub acne_mean: f64,
    /// Points that are deep in shadow.
    pub deep_in_shadow: usize,
    /// Of these, points of a visibility of at least 1/2.
    pub leak: usize,
    /// The mean of the visibility over the points that are deep in shadow.
    pub leak_mean: f64,
}

impl SeenError {
    /// Wrong points, share of all.
    pub fn wrong_share(&self) -> f64 {
        share(self.wrong as f64, self.points)
    }

    /// Acne, share of the smoothly lit points.
    pub fn acne_share(&self) -> f64 {
        share(self.acne as f64, self.smoothly_lit)
    }

    /// Leaks, share of the points that are deep in shadow.
    pub fn leak_share(&self) -> f64 {
        share(self.leak as f64, self.deep_in_shadow)
    }
}

fn share(part: f64, whole: usize) -> f64 {
    part / whole.max(1) as f64
}

/// Whether each point is lit and what shows around it: depends on the light, the maps' size and how
/// they are sampled and filtered, not on what they hold. `point_done` is called after each.
pub fn surroundings_of(
    bench: &Bench<'_>,
    points: &[Point],
    point_done: impl Fn() + Sync,
) -> Vec<(bool, Surroundings)> {
    let judge = |point: &Point| {
        let lit = bench.is_lit(point);
        point_done();
        (lit, surroundings(bench, point, lit))
    };
    points.par_iter().map(judge).collect()
}

/// Judges all points, given what [`surroundings_of`] says of them.
pub fn seen_error(
    bench: &Bench<'_>,
    points: &[Point],
    surroundings: &[(bool, Surroundings)],
) -> SeenError {
    let seen: Vec<f64> =
        points.par_iter().map(|point| f64::from(bench.visibility(point))).collect();
    let mut error = SeenError { points: points.len(), ..SeenError::default() };
    let (mut squares, mut dark, mut light) = (0.0, 0.0, 0.0);
    let turned = turned_away(bench, points);
    for ((visibility, turned), (lit, surroundings)) in
        seen.into_iter().zip(turned).zip(surroundings)
    {
        let off = visibility - f64::from(u8::from(*lit));
        squares += off * off;
        let wrong = usize::from((visibility >= 0.5) != *lit);
        error.wrong += wrong;
        error.wrong_turned_away += if turned { wrong } else { 0 };
        match surroundings {
            Surroundings::SmoothlyLit => {
                error.smoothly_lit += 1;
                error.acne += wrong;
                dark += 1.0 - visibility;
            }
            Surroundings::DeepInShadow => {
                error.deep_in_shadow += 1;
                error.leak += wrong;
                light += visibility;
            }
            Surroundings::Mixed => {}
        }
    }
    error.rmse = share(squares, error.points).sqrt();
    error.acne_mean = share(dark, error.smoothly_lit);
    error.leak_mean = share(light, error.deep_in_shadow);
    error
}
