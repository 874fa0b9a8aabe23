//! How wrong shadows are, and why: maps and lookups against ray casting.
//!
//! Three measures (map, shadow, penumbra) and the attribution of the error to its sources;
//! `docs/measure.md` says what each figure means.

mod attribution;
mod map;
mod penumbra;
mod shadow;

pub use attribution::{Source, affine_depth, attribute, bowed_edges, left_out};
pub use map::{Band, MapError, map_error};
pub use penumbra::{PenumbraError, coverage, penumbra_error};
pub use shadow::{Judgement, ShadowError, judge, shadow_error};

use fastrand::Rng;
use glam::{DMat3, DVec3};

use crate::render::Frame;
use crate::scalar::float::{Vec2, Vec3};
use crate::scalar::hemisphere::{dpsm_flip, dpsm_to_light};
use crate::scalar::light::DpsmLight;
use crate::scalar::maps::DepthMaps;
use crate::scalar::paraboloid::{dpsm_project, dpsm_texel_pitch, dpsm_unproject};
use crate::truth::{Ray, Truth};

/// A frame, its maps and the truth about its scene.
#[derive(Debug)]
pub struct Bench<'a> {
    /// The frame whose shadows are measured.
    pub frame: &'a Frame,
    /// The maps that a method made of it.
    pub maps: &'a DepthMaps,
    /// The frame's triangles to cast rays at.
    pub truth: &'a Truth,
    /// The light in f64.
    pub light: DpsmLight<f64>,
    /// The light's world position.
    pub origin: DVec3,
    /// Light space to world space: the inverse of the struct's own rotation as rounded to f32.
    to_world: DMat3,
}

/// A surface point to be lit or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// World position.
    pub world: DVec3,
    /// The triangle that it lies on, where known.
    pub triangle: Option<u32>,
    /// Unit normal, where known.
    pub normal: Option<DVec3>,
}

/// The frame's triangles to cast rays at.
pub fn truth_of(frame: &Frame) -> Truth {
    let positions: Vec<DVec3> = frame.vertices.iter().map(|v| v.position.as_dvec3()).collect();
    Truth::new(&positions, frame.triangles.iter().copied())
}

impl<'a> Bench<'a> {
    /// Puts a frame, its maps and its truth together.
    pub fn new(frame: &'a Frame, maps: &'a DepthMaps, truth: &'a Truth) -> Self {
        let light = frame.light.widen();
        let [right, up, forward] = [light.right, light.up, light.forward].map(world);
        let to_light = DMat3::from_cols(right, up, forward).transpose();
        let to_world = to_light.inverse();
        Self { frame, maps, truth, light, origin: world(light.position), to_world }
    }

    /// A world position in light space.
    pub fn to_light(&self, position: DVec3) -> Vec3<f64> {
        dpsm_to_light(Vec3::new(position.x, position.y, position.z), self.light)
    }

    /// The world direction of disk coordinates in a hemisphere's map, of about unit length.
    pub fn direction(&self, uv: Vec2<f64>, hemisphere: u32) -> DVec3 {
        self.to_world * world(dpsm_flip(dpsm_unproject(uv), hemisphere))
    }

    /// The first hit of a texel's direction between the clipping spheres: its distance.
    pub fn first_distance(&self, uv: Vec2<f64>, hemisphere: u32) -> Option<f64> {
        let ray = Ray {
            near: self.light.near,
            far: self.light.far,
            ..Ray::new(self.origin, self.direction(uv, hemisphere))
        };
        self.truth.first_hit(&ray).map(|hit| hit.distance)
    }

    /// True where nothing between the near sphere and the point keeps the light from it.
    pub fn sees(&self, point: &Point) -> bool {
        self.truth.sees(self.origin, point.world, point.triangle, self.light.near)
    }

    /// True where a direction of the light reaches the plane of a receiver, or `None` where it
    /// misses the plane. A receiver without a normal is taken as a sphere around the light.
    pub fn reaches(&self, point: &Point, uv: Vec2<f64>, hemisphere: u32) -> Option<bool> {
        let direction = self.direction(uv, hemisphere).normalize();
        let to_point = point.world - self.origin;
        let distance = match point.normal {
            Some(normal) => normal.dot(to_point) / normal.dot(direction),
            None => to_point.length(),
        };
        let ahead = distance.is_finite() && distance > 0.0;
        let on_plane = Point { world: self.origin + direction * distance, ..*point };
        ahead.then(|| self.sees(&on_plane))
    }

    /// The width of a texel on the disk.
    pub fn texel(&self) -> f64 {
        2.0 * (1.0 + self.light.guard) / self.light.size
    }

    /// The hemisphere of a point and its disk coordinates there.
    pub fn place(&self, point: &Point) -> (u32, Vec2<f64>) {
        let p = self.to_light(point.world);
        let hemisphere = crate::scalar::hemisphere::dpsm_hemisphere(p);
        (hemisphere, dpsm_project(dpsm_flip(p, hemisphere)))
    }

    /// The angle that a texel spans at disk coordinates.
    pub fn pitch(&self, uv: Vec2<f64>) -> f64 {
        dpsm_texel_pitch(uv, self.light.size, self.light.guard)
    }

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
        let point =
            |hit: crate::truth::Hit| Some(self.on_triangle(hit.triangle, self.truth.point(&hit)?));
        hits.filter_map(point).collect()
    }

    /// `count` points scattered evenly over the area of all triangles.
    pub fn points_scattered(&self, count: usize, seed: u64) -> Vec<Point> {
        let mut rng = Rng::with_seed(seed);
        let mut total = 0.0;
        let areas: Vec<f64> = (0..self.frame.triangles.len() as u32)
            .map(|triangle| {
                let [a, b, c] = self.corners(triangle);
                total += (b - a).cross(c - a).length();
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
            self.on_triangle(triangle, a + (b - a) * s + (c - a) * t)
        };
        if areas.is_empty() { Vec::new() } else { (0..count).map(scatter).collect() }
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

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let corner = |index: u32| self.frame.vertices[index as usize].position.as_dvec3();
        self.frame.triangles[triangle as usize].map(corner)
    }

    fn on_triangle(&self, triangle: u32, position: DVec3) -> Point {
        let [a, b, c] = self.corners(triangle);
        let normal = (b - a).cross(c - a).try_normalize();
        Point { world: position, triangle: Some(triangle), normal }
    }
}

/// The ports' vector as glam's.
fn world(v: Vec3<f64>) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

/// The value below which `share` of the sorted values lie; 0 of none.
fn percentile(sorted: &[f64], share: f64) -> f64 {
    let index = (sorted.len() as f64 * share).ceil() as usize;
    sorted.get(index.saturating_sub(1)).copied().unwrap_or(0.0)
}
