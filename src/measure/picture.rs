//! The errors of a picture's pixels, and how they lie: large patches, and dots.

use rayon::prelude::*;
use serde::Serialize;

use super::{Bench, Point, truth_of, world};
use crate::cpu;
use crate::render::{Filter, Frame, Linear, rotation_at};
use crate::scalar::maps::{DepthMaps, Sampling};

/// How far off a pixel's visibility is at the least where it counts as wrong, if the truth is 0 or 1.
pub const WRONG_HARD: f64 = 0.5;

/// The same for a spherical light: a tenth of it shows.
pub const WRONG_SOFT: f64 = 0.1;

/// A picture's errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PictureError {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Pixels that show a surface.
    pub pixels: usize,
    /// Pixels off by more than this are wrong.
    pub threshold: f64,
    /// Wrong pixels.
    pub wrong: usize,
    /// Root of the mean squared error over all that show a surface.
    pub rmse: f64,
    /// Pixels of the largest patch of wrong ones, each beside the next or diagonally so.
    pub largest_patch: usize,
    /// Wrong pixels without a wrong one among the eight around them.
    pub dots: usize,
}

impl PictureError {
    /// Wrong pixels, share of those that show a surface.
    pub fn wrong_share(&self) -> f64 {
        self.wrong as f64 / self.pixels.max(1) as f64
    }
}

/// Judges an image of errors, row by row, `width` of them in each; `None` where it shows nothing. What
/// is left of a row that is not whole counts like a row.
///
/// ```
/// use dpsm::measure::picture_error;
///
/// let errors = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, -1.0].map(Some);
/// let error = picture_error(&errors, 3, 0.5);
/// assert_eq!((error.wrong, error.largest_patch, error.dots), (3, 2, 1));
/// ```
pub fn picture_error(errors: &[Option<f64>], width: u32, threshold: f64) -> PictureError {
    let wrong: Vec<bool> =
        errors.iter().map(|error| error.is_some_and(|error| error.abs() > threshold)).collect();
    let seen = || errors.iter().flatten();
    let pixels = seen().count();
    let squares: f64 = seen().map(|error| error * error).sum();
    let patches = patches(&wrong, width.max(1) as usize);
    PictureError {
        size: [width, (errors.len() as u32).div_ceil(width.max(1))],
        pixels,
        threshold,
        wrong: patches.iter().sum(),
        rmse: (squares / pixels.max(1) as f64).sqrt(),
        largest_patch: patches.iter().copied().max().unwrap_or(0),
        dots: patches.iter().filter(|pixels| **pixels == 1).count(),
    }
}

/// How many pixels each patch has.
fn patches(wrong: &[bool], width: usize) -> Vec<usize> {
    let mut taken = vec![false; wrong.len()];
    let mut patches = Vec::new();
    for start in 0..wrong.len() {
        if !wrong[start] || taken[start] {
            continue;
        }
        taken[start] = true;
        let (mut open, mut pixels) = (vec![start], 0);
        while let Some(at) = open.pop() {
            pixels += 1;
            for next in around(at, width) {
                if wrong.get(next) == Some(&true) && !taken[next] {
                    taken[next] = true;
                    open.push(next);
                }
            }
        }
        patches.push(pixels);
    }
    patches
}

/// The pixels around one; those below the last row are there too.
fn around(at: usize, width: usize) -> impl Iterator<Item = usize> {
    let (column, row) = (at % width, at / width);
    let columns = column.saturating_sub(1)..=(column + 1).min(width - 1);
    let rows = row.saturating_sub(1)..=row + 1;
    rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
        .filter(move |next| *next != at)
}

/// Visibility less truth at what the camera sees through each pixel of a picture, row by row from the
/// top, `width` of them in each: the mean over the frame's samples, each with its own noise. None is
/// wrong where the camera sees the side that is turned away from the light: shading leaves it dark.
pub fn errors_of_image(
    bench: &Bench<'_>,
    seen: &[Option<Point>],
    width: u32,
    pixel_done: impl Fn() + Sync,
) -> Vec<Option<f64>> {
    let error = |index: usize, point: &Point| {
        if bench.shows_unlit_side(point) {
            return 0.0;
        }
        let pixel = [index as u32 % width.max(1), index as u32 / width.max(1)];
        f64::from(bench.visibility_at(point, pixel)) - bench.true_visibility(point)
    };
    let pixels = seen.par_iter().enumerate().map(|(index, point)| {
        pixel_done();
        point.as_ref().map(|point| error(index, point))
    });
    pixels.collect()
}

/// The frame's picture by rays in place of maps: to its light as a point, or to the sphere that its
/// filter stands for; the mean over its lights.
pub fn picture_by_rays(frame: &Frame) -> Linear {
    let truth = truth_of(frame);
    let none = DepthMaps::empty(1, frame.light.hemispheres, Sampling::Nearest);
    let more = frame.more.iter().map(|light| Frame { light: *light, ..frame.clone() });
    let lights: Vec<Frame> = std::iter::once(frame.clone()).chain(more).collect();
    let mut sum = Linear::empty(frame.settings.image);
    for frame in &lights {
        let bench = Bench::new(frame, &none, &truth);
        sum.add(&cpu::lit_by(frame, |at| {
            let world = bench.origin + bench.to_world * world(at.p.widen());
            bench.true_visibility(&bench.on_triangle(at.triangle, world)) as f32
        }));
    }
    sum.divided(lights.len() as u32)
}

impl Bench<'_> {
    /// The visibility of a point as a pixel shows it: the mean over the samples, each with a kernel
    /// turned by the noise of its own place.
    fn visibility_at(&self, point: &Point, pixel: [u32; 2]) -> f32 {
        let settings = &self.frame.settings;
        if matches!(settings.filter, Filter::Single | Filter::Naive(_)) {
            return self.visibility(point);
        }
        let (p, normal) = self.receiver(point);
        if self.frame.shine.share(p) <= 0.0 {
            return 0.0;
        }
        let places = settings.places();
        let of = |place: &[f32; 2]| {
            let shift = self.frame.view.sampled(*place, settings.image).shift;
            self.frame.visibility_turned(self.maps, p, normal, rotation_at(pixel, shift))
        };
        places.iter().map(of).sum::<f32>() / places.len() as f32
    }

    /// True where the camera sees the side of a point's surface that is turned away from the light,
    /// by the triangle's plane and by the normals of its corners, which shading interpolates.
    fn shows_unlit_side(&self, point: &Point) -> bool {
        let (Some(plane), Some(triangle)) = (point.normal, point.triangle) else { return false };
        let eye = self.frame.view.eye.as_dvec3() - point.world;
        let seen = plane * plane.dot(eye).signum();
        let light = self.origin - point.world;
        let corners = self.frame.triangles.get(triangle as usize).into_iter().flatten();
        let mut normals =
            corners.map(|corner| self.frame.vertices[*corner as usize].normal.as_dvec3());
        seen.dot(light) < 0.0
            && normals.all(|normal| (normal * normal.dot(seen).signum()).dot(light) < 0.0)
    }
}
