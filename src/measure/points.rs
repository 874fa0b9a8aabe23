//! Which points are judged: what the camera sees, surfaces at random, or given places.

use fastrand::Rng;
use glam::DVec3;

use super::{Bench, Point};
use crate::truth::{Hit, Ray};

impl Bench<'_> {
    /// The points that the camera sees through `count` random places of the image, `seed` the same
    /// points again; fewer where it sees nothing.
    pub fn points_from_camera(&self, count: usize, seed: u64) -> Vec<Point> {
        let view = &self.frame.view;
        let [eye, right, up, forward] =
            [view.eye, view.right, view.up, view.forward].map(|v| v.as_dvec3());
        let mut rng = Rng::with_seed(seed);
        let rays: Vec<Ray> = (0..count)
            .map(|_| {
                let [x, y] = view.scale.map(|scale| (rng.f64() * 2.0 - 1.0) / f64::from(scale));
                Ray::new(eye, right * x + up * y + forward)
            })
            .collect();
        let hits = self.truth.first_hits(&rays).into_iter().flatten();
        let point = |hit: Hit| Some(self.on_triangle(hit.triangle, self.truth.point(&hit)?));
        hits.filter_map(point).collect()
    }

    /// What the camera sees through the middle of each pixel, row by row from the top.
    pub fn points_of_image(&self) -> Vec<Option<Point>> {
        self.points_of_grid(self.frame.settings.image)
    }

    /// What the camera sees through the middle of each of so many columns and rows of cells that fill
    /// the image.
    pub fn points_of_grid(&self, [width, height]: [u32; 2]) -> Vec<Option<Point>> {
        let view = &self.frame.view;
        let [eye, right, up, forward] =
            [view.eye, view.right, view.up, view.forward].map(|v| v.as_dvec3());
        let middle = |at: u32, of: u32| (2.0 * f64::from(at) + 1.0) / f64::from(of) - 1.0;
        let ray = |pixel: u32| {
            let x = middle(pixel % width, width) / f64::from(view.scale[0]);
            let y = -middle(pixel / width, height) / f64::from(view.scale[1]);
            Ray::new(eye, right * x + up * y + forward)
        };
        let rays: Vec<Ray> = (0..width * height).map(ray).collect();
        let point = |hit: Hit| Some(self.on_triangle(hit.triangle, self.truth.point(&hit)?));
        self.truth.first_hits(&rays).into_iter().map(|hit| hit.and_then(point)).collect()
    }

    /// `count` points scattered evenly over the area of all triangles, less those in a hole.
    pub fn points_scattered(&self, count: usize, seed: u64) -> Vec<Point> {
        let mut rng = Rng::with_seed(seed);
        let mut total = 0.0;
        let areas: Vec<f64> = (0..self.frame.triangles.len() as u32)
            .map(|triangle| {
                total += self.normal(triangle).length();
                total
            })
            .collect();
        let scatter = |_| {
            let at = rng.f64() * total;
            let triangle = areas.partition_point(|&area| area <= at).min(areas.len() - 1) as u32;
            let [a, b, c] = self.corners(triangle);
            let (mut s, mut t) = (rng.f64(), rng.f64());
            if s + t > 1.0 {
                (s, t) = (1.0 - s, 1.0 - t);
            }
            let opaque = self.frame.opaque(triangle, [1.0 - s - t, s, t]);
            opaque.then(|| self.on_triangle(triangle, a + (b - a) * s + (c - a) * t))
        };
        if areas.is_empty() { Vec::new() } else { (0..count).filter_map(scatter).collect() }
    }

    /// A point given by its coordinates: its triangle is the one that the light's ray through it
    /// meets nearest to it, up to the rounding of coordinates to f32.
    pub fn point_at(&self, position: DVec3, normal: Option<DVec3>) -> Point {
        let to_point = position - self.origin;
        let distance = to_point.length();
        // eight roundings to f32: of the coordinates, and of what made them
        let slack = 8.0 * f64::from(f32::EPSILON) * (distance + position.abs().max_element());
        let ray = Ray {
            near: (distance - slack).max(0.0),
            far: distance + slack,
            ..Ray::new(self.origin, to_point)
        };
        let found = self.truth.first_hit(&ray);
        let on = found.map(|hit| self.on_triangle(hit.triangle, position));
        Point {
            world: position,
            triangle: on.and_then(|point| point.triangle),
            normal: normal.or(on.and_then(|point| point.normal)),
        }
    }
}
