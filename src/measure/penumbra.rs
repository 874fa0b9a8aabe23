//! Penumbra error: filtered visibility against the true coverage of a cone.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

use super::{Bench, Point};
use crate::scalar::maps::Sampling;

/// Error of a filtered visibility against the true coverage of the kernel's cone.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PenumbraError {
    /// Half-angle of the cone in texels at each point.
    pub cone_texels: f64,
    /// Points.
    pub points: usize,
    /// Root of the mean squared error over all points.
    pub rmse: f64,
    /// Points whose true coverage is neither 0 nor 1.
    pub penumbra_points: usize,
    /// Root of the mean squared error over those.
    pub penumbra_rmse: f64,
}

/// Rays of a cone.
const CONE_RAYS: u32 = 64;

/// The share of a cone's rays that reach the receiver's plane unhindered: Vogel's spiral over the
/// spherical cap of half-angle `half_angle` around the point's direction.
pub fn coverage(bench: &Bench<'_>, point: &Point, half_angle: f64) -> f64 {
    let axis = (point.world - bench.origin).normalize_or_zero();
    let (side, other) = axis.any_orthonormal_pair();
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let (mut taken, mut lit) = (0, 0);
    for k in 0..CONE_RAYS {
        let share = (f64::from(k) + 0.5) / f64::from(CONE_RAYS);
        // even in solid angle: 1 - cos grows with the share
        let cosine = 1.0 - share * (1.0 - half_angle.min(FRAC_PI_2).cos());
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        let direction: DVec3 = axis * cosine + (side * cos + other * sin) * sine;
        let p = bench.to_light(bench.origin + direction);
        let (map, uv) = bench.projection.place(p);
        if let Some(reaches) = bench.reaches(point, uv, map) {
            taken += 1;
            lit += u32::from(reaches);
        }
    }
    f64::from(lit) / f64::from(taken.max(1))
}

/// Compares the map's visibility with the true coverage of a cone as large as the filter's
/// kernel: the texel, or the 2 x 2 texels, that a lookup reads.
pub fn penumbra_error(
    bench: &Bench<'_>,
    points: &[Point],
    point_done: impl Fn() + Sync,
) -> PenumbraError {
    let side = match bench.maps.sampling {
        Sampling::Nearest => 1.0,
        Sampling::Linear => 2.0,
    };
    let cone_texels = side / PI.sqrt(); // a disk of the kernel's area
    let errors: Vec<(f64, f64)> = points
        .par_iter()
        .filter_map(|point| {
            let (hemisphere, uv) = bench.place(point);
            let visibility = bench.visibility(point);
            let truth = coverage(bench, point, cone_texels * bench.pitch(uv));
            point_done();
            (hemisphere < bench.frame.light.hemispheres)
                .then(|| (f64::from(visibility) - truth, truth))
        })
        .collect();
    let rmse = |errors: &mut dyn Iterator<Item = f64>| {
        let (mut sum, mut count) = (0.0, 0_usize);
        errors.for_each(|error| {
            sum += error * error;
            count += 1;
        });
        ((sum / count.max(1) as f64).sqrt(), count)
    };
    let partial = |&&(_, truth): &&(f64, f64)| truth > 0.0 && truth < 1.0;
    let (rmse_all, count) = rmse(&mut errors.iter().map(|(error, _)| *error));
    let (penumbra_rmse, penumbra_points) =
        rmse(&mut errors.iter().filter(partial).map(|(error, _)| *error));
    PenumbraError { cone_texels, points: count, rmse: rmse_all, penumbra_points, penumbra_rmse }
}
