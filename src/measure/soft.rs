//! Soft shadows against rays to a spherical light.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

use super::{Bench, Point, turned_away};
use crate::render::Filter;
use crate::truth::Ray;

/// Rays to a light.
const RAYS: u32 = 128;

/// Cosine of the angle, 30 degrees, by which normals differ at a crease.
const CREASE: f64 = 0.866_025_403_784_438_6;

/// Directions along a receiver's plane in which something that touches it is looked for.
const AROUND: u32 = 16;

/// How far those rays run above the plane, as a share of their length.
const LIFT: f64 = 0.01;

/// Soft shadows of some points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SoftFigures {
    /// Points.
    pub points: usize,
    /// Root of the mean squared error of the visibility.
    pub rmse: f64,
    /// Points that see the whole light.
    pub fully_lit: usize,
    /// The mean of 1 - visibility over those.
    pub darkness: f64,
    /// Points that see nothing of it.
    pub umbra: usize,
    /// The mean of the visibility over those.
    pub light: f64,
}

/// Soft shadows against rays to a spherical light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SoftError {
    /// The light's radius, the mean over the points.
    pub radius: f64,
    /// All points.
    pub all: SoftFigures,
    /// All but those on sides of solids that are turned away from the light ([`turned_away`]), which
    /// shading leaves dark.
    pub facing: SoftFigures,
    /// Of these, points with a crease within that radius.
    pub creases: SoftFigures,
    /// The others of these.
    pub elsewhere: SoftFigures,
}

impl Bench<'_> {
    /// The radius of the spherical light that the frame's filter stands for at a point: the light's
    /// own for soft shadows. A kernel of tangent t at the distance l stands for one of t l: its
    /// penumbra is as wide as that light's where casters are halfway. `None` for other filters.
    pub fn light_radius(&self, point: &Point) -> Option<f64> {
        let distance = (point.world - self.origin).length();
        match self.frame.settings.filter {
            Filter::Soft { .. } => Some(f64::from(self.frame.soft()[0])),
            Filter::Disk(taps) | Filter::Mirror(taps) | Filter::Reproject(taps) => {
                Some(f64::from(taps.kernel.tangent(distance as f32)) * distance)
            }
            Filter::Single | Filter::Naive(_) => None,
        }
    }

    /// What a point should get of the light: the share that it sees of the sphere that the filter
    /// stands for, or all or nothing of a point. Nothing behind a hemispherical light.
    pub fn true_visibility(&self, point: &Point) -> f64 {
        match self.light_radius(point) {
            Some(radius) if self.is_mapped(point) => soft_coverage(self, point, radius),
            Some(_) => 0.0,
            None => f64::from(u8::from(self.is_lit(point))),
        }
    }
}

/// The share of a spherical light that a point sees: rays from Vogel's spiral over the disk through
/// the light's centre that faces the point. What of it lies below the receiver's plane, on the other
/// side than the centre, is left out: shading, not shadow, dims the light there. What lies inside the
/// sphere casts no shadow: a lamp shines out of its fitting.
pub fn soft_coverage(bench: &Bench<'_>, point: &Point, radius: f64) -> f64 {
    let axis = (point.world - bench.origin).normalize_or_zero();
    let (side, other) = axis.any_orthonormal_pair();
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let height = |from: DVec3| point.normal.map_or(1.0, |normal| normal.dot(from - point.world));
    let centre = height(bench.origin);
    let (mut taken, mut lit) = (0, 0);
    for k in 0..RAYS {
        let ring = ((f64::from(k) + 0.5) / f64::from(RAYS)).sqrt() * radius;
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        let from = bench.origin + (side * cos + other * sin) * ring;
        if height(from) * centre >= 0.0 {
            taken += 1;
            let inside = within_sphere(from - bench.origin, point.world - from, radius);
            lit += u32::from(bench.casters().sees(from, point.world, point.triangle, inside));
        }
    }
    f64::from(lit) / f64::from(taken.max(1))
}

/// How far a ray from a place in a sphere around the origin runs inside it.
fn within_sphere(from: DVec3, along: DVec3, radius: f64) -> f64 {
    let inward = -from.dot(along.normalize_or_zero());
    inward + (inward * inward + radius * radius - from.length_squared()).max(0.0).sqrt()
}

/// True where a crease is within a radius: a triangle that is connected with the point's there and
/// leans against it by more than 30 degrees, or something that touches it, met by rays along the
/// point's plane on the light's side.
pub fn at_crease(bench: &Bench<'_>, point: &Point, radius: f64) -> bool {
    let (Some(triangle), Some(normal)) = (point.triangle, point.normal) else { return false };
    let leans = |other: u32| {
        let other = bench.normal(other).try_normalize();
        other.is_some_and(|other| other.dot(normal).abs() < CREASE)
    };
    if bench.truth.connected(triangle, point.world, radius).into_iter().any(leans) {
        return true;
    }
    let up = normal * normal.dot(bench.origin - point.world).signum();
    let origin = point.world + up * (LIFT * radius);
    let (side, other) = normal.any_orthonormal_pair();
    (0..AROUND).any(|k| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(AROUND)).sin_cos();
        let ray = Ray::new(origin, side * cos + other * sin);
        bench.truth.first_hit(&Ray { far: radius, except: Some(triangle), ..ray }).is_some()
    })
}

/// Judges the soft shadows of all points; `point_done` is called after each. `None` for filters that
/// stand for no spherical light.
pub fn soft_error(
    bench: &Bench<'_>,
    points: &[Point],
    point_done: impl Fn() + Sync,
) -> Option<SoftError> {
    let judge = |(point, turned): (&Point, bool)| {
        let radius = bench.light_radius(point)?;
        let truth = bench.true_visibility(point);
        let visibility = f64::from(bench.visibility(point));
        let crease = at_crease(bench, point, radius);
        point_done();
        Some(Judged { radius, truth, visibility, crease, turned })
    };
    let judged: Option<Vec<Judged>> =
        points.par_iter().zip(turned_away(bench, points)).map(judge).collect();
    let judged = judged.filter(|judged| !judged.is_empty())?;
    let radii: f64 = judged.iter().map(|judged| judged.radius).sum();
    Some(SoftError {
        radius: radii / judged.len() as f64,
        all: figures(&judged, |_| true),
        facing: figures(&judged, |judged| !judged.turned),
        creases: figures(&judged, |judged| !judged.turned && judged.crease),
        elsewhere: figures(&judged, |judged| !judged.turned && !judged.crease),
    })
}

/// One point.
struct Judged {
    radius: f64,
    truth: f64,
    visibility: f64,
    crease: bool,
    turned: bool,
}

fn figures(judged: &[Judged], wanted: impl Fn(&Judged) -> bool) -> SoftFigures {
    let mean = |of: &dyn Fn(&Judged) -> Option<f64>| {
        let values = judged.iter().filter(|judged| wanted(judged)).filter_map(of);
        let (sum, count) = values.fold((0.0, 0_usize), |(sum, n), value| (sum + value, n + 1));
        (sum / count.max(1) as f64, count)
    };
    let (square, points) = mean(&|j| Some((j.visibility - j.truth).powi(2)));
    let (darkness, fully_lit) = mean(&|j| (j.truth == 1.0).then_some(1.0 - j.visibility));
    let (light, umbra) = mean(&|j| (j.truth == 0.0).then_some(j.visibility));
    SoftFigures { points, rmse: square.sqrt(), fully_lit, darkness, umbra, light }
}
