//! Where a scene's own origin lies, so that f32 holds its positions.
//!
//! A position of size |p| is a whole number of steps of up to |p| 2^-23. At 6.4e6 m, the radius of
//! the earth, that is half a metre: a post is no post any more. So a scene whose light is far from
//! the file's origin and near its casters is moved.

use glam::DVec3;

use super::Contents;
use crate::scene::nearest_of;

/// A scene is moved where the light's coordinates are more than so many times its distance from the
/// nearest triangle: an f32 position is then wrong by more than 2^-18 of that distance.
const TOO_FAR: f64 = 64.0;

/// The most bits of an origin's coordinates. A file's coordinates have 53, so that 20 at least are
/// left for where a position lies between the origin's steps: origin and local position, added in
/// f64, are exact.
const BITS: i32 = 33;

/// Zero where f32 holds the positions around a point well, else near that point.
///
/// The point is the one that is asked for, else the first light's position. Without a light it is
/// the middle of the bounds, where no light need be: half the longest side then stands for the
/// distance from the nearest triangle.
pub(super) fn of(contents: &Contents, around: Option<DVec3>) -> DVec3 {
    let light = contents.lights.first().map(|(position, _)| *position);
    let point = around.filter(|point| point.is_finite()).or(light);
    let (point, distance) = match point {
        Some(point) => (point, nearest(contents, point)),
        None => middle(contents),
    };
    let largest = point.abs().max_element();
    match largest > TOO_FAR * distance {
        true => rounded(point, largest, distance),
        false => DVec3::ZERO,
    }
}

/// The whole multiple of a power of two that is nearest to a point.
///
/// The step is no more than the light's distance from its casters, so that the rounding of its own
/// coordinates is small beside that, and no less than leaves [`BITS`] bits: short numbers to print,
/// exact to subtract from the file's.
fn rounded(point: DVec3, largest: f64, distance: f64) -> DVec3 {
    let step = (exponent(largest) - BITS).max(exponent(distance));
    let step = 2.0_f64.powi(step);
    // beyond f64's range there is nothing to choose
    let rounded = (point / step).round() * step;
    if rounded.is_finite() { rounded } else { DVec3::ZERO }
}

/// Of the largest power of two that is not above a number.
fn exponent(number: f64) -> i32 {
    number.log2().floor().clamp(f64::from(f64::MIN_EXP), f64::from(f64::MAX_EXP)) as i32
}

/// Distance of the nearest triangle; infinite if there is none.
fn nearest(contents: &Contents, point: DVec3) -> f64 {
    let triangles = contents.drafts.iter().flat_map(|draft| draft.world());
    triangles
        .map(|corners| nearest_of(corners.map(|corner| corner - point)))
        .filter(|distance| !distance.is_nan())
        .fold(f64::INFINITY, f64::min)
}

/// The middle of the bounds, and half their longest side.
fn middle(contents: &Contents) -> (DVec3, f64) {
    let corners = || {
        let triangles = contents.drafts.iter().flat_map(|draft| draft.world());
        triangles.flatten().filter(|corner| corner.is_finite())
    };
    let Some(low) = corners().reduce(DVec3::min) else { return (DVec3::ZERO, f64::INFINITY) };
    let high = corners().fold(low, DVec3::max);
    let half = high * 0.5 - low * 0.5;
    (low + half, half.max_element())
}
