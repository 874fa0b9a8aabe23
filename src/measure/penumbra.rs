//! Penumbra error: filtered visibility against the true coverage of a cone.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

use super::{Bench, Point};
use crate::render::Filter;
use crate::scalar::maps::Sampling;

/// Error of a filtered visibility against the true coverage of the kernel's cone.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PenumbraError {
    /// Half-angle of the cone in texels, the mean over the points; for soft shadows the light's.
    pub cone_texels: f64,
    /// Points.
    pub points: usize,
    /// Root of the mean squared error over all points.
    pub rmse: f64,
    /// Points whose true coverage is neither 0 nor 1.
    pub penumbra_points: usize,
    /// Root of the mean squared error over those.
    pub penumbra_rmse: f64,
    /// Penumbra points within five texels of the seam, or of a face's edge.
    pub seam_points: usize,
    /// Root of the mean squared error over those.
    pub seam_rmse: f64,
    /// The same over the other penumbra points.
    pub interior_rmse: f64,
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

/// The half-angle of the cone that stands for a filter's kernel at a point: its own, or that of a
/// disk of the area that a lookup or a naive kernel reads. For a soft light, the light's.
fn cone(bench: &Bench<'_>, distance: f64, pitch: f64) -> f64 {
    let side = match bench.maps.sampling {
        Sampling::Nearest => 1.0,
        Sampling::Linear => 2.0,
    };
    match bench.frame.settings.filter {
        Filter::Single => side / PI.sqrt() * pitch,
        Filter::Naive(texels) => (f64::from(texels) + (side - 1.0)) / PI.sqrt() * pitch,
        Filter::Disk(taps) | Filter::Mirror(taps) | Filter::Reproject(taps) => {
            f64::from(taps.kernel.tangent(distance as f32)).atan()
        }
        Filter::Soft { .. } => (f64::from(bench.frame.soft()[0]) / distance).atan(),
    }
}

impl Bench<'_> {
    /// How far the frame's filter reaches from a point's own texel, in texels: 0 for one lookup.
    pub fn kernel_texels(&self, point: &Point) -> f64 {
        if self.frame.settings.filter == Filter::Single {
            return 0.0;
        }
        let (_, uv) = self.place(point);
        let pitch = self.pitch(uv);
        cone(self, (point.world - self.origin).length(), pitch) / pitch
    }
}

/// Compares the map's visibility with the true coverage of a cone as large as the filter's
/// kernel, for a single lookup the texel, or the 2 x 2 texels, that it reads; and soft shadows with
/// the share of the light that is seen.
pub fn penumbra_error(
    bench: &Bench<'_>,
    points: &[Point],
    point_done: impl Fn() + Sync,
) -> PenumbraError {
    let errors: Vec<Judged> = points
        .par_iter()
        .filter_map(|point| {
            let (_, uv) = bench.place(point);
            let visibility = bench.visibility(point);
            let (distance, pitch) = ((point.world - bench.origin).length(), bench.pitch(uv));
            let half_angle = cone(bench, distance, pitch);
            let truth = match bench.frame.settings.filter {
                Filter::Soft { .. } => bench.true_visibility(point),
                _ => coverage(bench, point, half_angle),
            };
            point_done();
            bench.is_mapped(point).then(|| Judged {
                error: f64::from(visibility) - truth,
                partial: truth > 0.0 && truth < 1.0,
                seam: bench.at_seam(uv),
                texels: half_angle / pitch,
            })
        })
        .collect();
    let rmse = |wanted: &dyn Fn(&Judged) -> bool| {
        let wanted = errors.iter().filter(|judged| wanted(judged));
        let (sum, count) = wanted.fold((0.0, 0_usize), |(sum, count), judged| {
            (sum + judged.error * judged.error, count + 1)
        });
        ((sum / count.max(1) as f64).sqrt(), count)
    };
    let (rmse_all, count) = rmse(&|_| true);
    let (penumbra_rmse, penumbra_points) = rmse(&|judged| judged.partial);
    let (seam_rmse, seam_points) = rmse(&|judged| judged.partial && judged.seam);
    let (interior_rmse, _) = rmse(&|judged| judged.partial && !judged.seam);
    let texels: f64 = errors.iter().map(|judged| judged.texels).sum();
    PenumbraError {
        cone_texels: texels / count.max(1) as f64,
        points: count,
        rmse: rmse_all,
        penumbra_points,
        penumbra_rmse,
        seam_points,
        seam_rmse,
        interior_rmse,
    }
}

/// One point's error.
struct Judged {
    error: f64,
    partial: bool,
    seam: bool,
    texels: f64,
}
