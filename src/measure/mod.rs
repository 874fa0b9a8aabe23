//! How wrong shadows are, and why: maps and lookups against ray casting.
//!
//! Three measures (map, shadow, penumbra) and the attribution of the error to its sources;
//! `docs/measure.md` says what each figure means.

mod attribution;
mod band;
mod footprint;
mod map;
mod penumbra;
mod picture;
mod points;
mod seen;
mod shadow;
mod silhouette;
mod soft;
mod solid;
mod surface;

pub use attribution::{Source, affine_depth, attribute, bowed_edges, draws_straight, left_out};
pub use band::Band;
pub use map::{MAX_TAU, MapError, WorstTexel, map_error};
pub use penumbra::{PenumbraError, coverage, penumbra_error};
pub use picture::{
    PictureError, WRONG_HARD, WRONG_SOFT, errors_of_image, picture_by_rays, picture_error,
};
pub use seen::{SeenError, seen_error, surroundings_of};
pub(crate) use shadow::nearest_change;
pub use shadow::{Judgement, ShadowError, edge_point, judge, shadow_error};
pub use soft::{SoftError, SoftFigures, at_crease, soft_coverage, soft_error};
pub use solid::turned_away;
pub use surface::{Surroundings, surroundings};

use glam::{DMat3, DVec3};

use crate::render::{Frame, Projection, texel};
use crate::scalar::float::{Vec2, Vec3};
use crate::scalar::hemisphere::dpsm_to_light;
use crate::scalar::light::DpsmLight;
use crate::scalar::maps::DepthMaps;
use crate::truth::{Hit, Ray, TOUCH, Truth};

/// Width of the seam band in texels on either side.
const SEAM_TEXELS: f64 = 5.0;

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
    /// What the maps are.
    pub projection: Projection,
    /// The light's world position.
    pub origin: DVec3,
    /// Of the triangles, those that cast shadows, where some do not.
    casters: Option<Truth>,
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

/// The frame's triangles to cast rays at, with the holes of their masks.
pub fn truth_of(frame: &Frame) -> Truth {
    truth_of_some(frame, |_| true)
}

/// The same without the meshes that cast no shadow: nothing meets their triangles.
pub fn truth_of_casters(frame: &Frame) -> Truth {
    truth_of_some(frame, |triangle| !frame.is_left_out(triangle))
}

/// The same with those alone that are drawn into the maps.
pub fn truth_of_drawn(frame: &Frame) -> Truth {
    let drawn = frame.drawn();
    truth_of_some(frame, |triangle| drawn.iter().any(|(range, _)| range.contains(&triangle)))
}

fn truth_of_some(frame: &Frame, wanted: impl Fn(u32) -> bool) -> Truth {
    let positions: Vec<DVec3> = frame.vertices.iter().map(|v| v.position.as_dvec3()).collect();
    let triangles = (0..).zip(&frame.triangles);
    // no position has that index
    let triangles = triangles.map(|(index, t)| if wanted(index) { *t } else { [u32::MAX; 3] });
    let truth = Truth::new(&positions, triangles);
    if frame.masks.is_empty() {
        return truth;
    }
    let frame = frame.clone();
    truth.with_opacity(move |triangle, weights| frame.opaque(triangle, weights))
}

impl<'a> Bench<'a> {
    /// Puts a frame, its maps and its truth together.
    pub fn new(frame: &'a Frame, maps: &'a DepthMaps, truth: &'a Truth) -> Self {
        let light = frame.light.widen();
        let [right, up, forward] = [light.right, light.up, light.forward].map(world);
        let to_light = DMat3::from_cols(right, up, forward).transpose();
        let to_world = to_light.inverse();
        let projection = frame.settings.method.projection();
        let origin = world(light.position);
        let casters = frame.has_left_out().then(|| truth_of_casters(frame));
        Self { frame, maps, truth, light, projection, origin, casters, to_world }
    }

    /// A world position in light space.
    pub fn to_light(&self, position: DVec3) -> Vec3<f64> {
        dpsm_to_light(Vec3::new(position.x, position.y, position.z), self.light)
    }

    /// The world direction of a map's place: of about unit length on a disk, of length 1 along the
    /// axis on a face.
    pub fn direction(&self, uv: Vec2<f64>, map: u32) -> DVec3 {
        self.to_world * world(self.projection.direction(uv, map))
    }

    /// A point as the shader gets it: light-space position and normal, zero where it has none.
    pub fn receiver(&self, point: &Point) -> (Vec3<f32>, Vec3<f32>) {
        let turn = |v: DVec3| {
            let DpsmLight { right, up, forward, .. } = self.light;
            let v = Vec3::new(v.x, v.y, v.z);
            Vec3::new(right.dot(v), up.dot(v), forward.dot(v))
        };
        let normal = point.normal.map_or(Vec3::splat(0.0), turn);
        (self.to_light(point.world).narrow(), normal.narrow())
    }

    /// The visibility of a point by the frame's maps and bias.
    pub fn visibility(&self, point: &Point) -> f32 {
        let (p, normal) = self.receiver(point);
        match self.frame.shine.share(p) > 0.0 {
            true => self.frame.visibility(self.maps, p, normal),
            false => 0.0,
        }
    }

    /// The first hit of a texel's direction between near and far: its distance.
    pub fn first_distance(&self, uv: Vec2<f64>, map: u32) -> Option<f64> {
        self.first_hit(self.direction(uv, map), false).map(|hit| hit.distance)
    }

    /// The first hit along a world direction between near and far, as maps are to hold it, or
    /// between the light and far: what near cuts off shadows all the same. What the light lies on
    /// is not hit.
    fn first_hit(&self, direction: DVec3, from_light: bool) -> Option<Hit> {
        let [near, far] = self.clip(direction);
        let touch = TOUCH * (self.origin.abs().max_element() + far);
        let near = if from_light { touch } else { near.max(touch) };
        self.casters().first_hit(&Ray { near, far, ..Ray::new(self.origin, direction) })
    }

    /// Where near and far clip along a world direction: spheres, or a cube's planes.
    pub fn clip(&self, direction: DVec3) -> [f64; 2] {
        let stretch = match self.projection {
            Projection::Paraboloid => 1.0,
            Projection::Cube => self.projection.stretch(self.to_light(self.origin + direction)),
        };
        [self.light.near * stretch, self.light.far * stretch]
    }

    /// What keeps the light from a point, wherever near and far are.
    pub fn occluder(&self, point: &Point) -> Option<Hit> {
        self.casters().occluder(self.origin, point.world, point.triangle, 0.0)
    }

    /// What casts shadows.
    pub(crate) fn casters(&self) -> &Truth {
        self.casters.as_ref().unwrap_or(self.truth)
    }

    /// True where nothing keeps the light from the point.
    pub fn sees(&self, point: &Point) -> bool {
        self.occluder(point).is_none()
    }

    /// True where the light has a map of a point's direction, and reaches it.
    pub fn is_mapped(&self, point: &Point) -> bool {
        let p = self.to_light(point.world).narrow();
        self.projection.lookup(p, self.frame.light).mapped && self.frame.shine.share(p) > 0.0
    }

    /// True where the light reaches a point: nothing keeps it away, and the light has a map there.
    /// Behind a hemispherical light, outside a spot's cone and beyond the range all is dark by definition.
    pub fn is_lit(&self, point: &Point) -> bool {
        self.is_mapped(point) && self.sees(point)
    }

    /// True where a direction of the light reaches the plane of a receiver, or `None` where it
    /// misses the plane. A receiver without a normal is taken as a sphere around the light.
    pub fn reaches(&self, point: &Point, uv: Vec2<f64>, map: u32) -> Option<bool> {
        let direction = self.direction(uv, map).normalize();
        let to_point = point.world - self.origin;
        let distance = match point.normal {
            Some(normal) => normal.dot(to_point) / normal.dot(direction),
            None => to_point.length(),
        };
        let ahead = distance.is_finite() && distance > 0.0;
        let on_plane = Point { world: self.origin + direction * distance, ..*point };
        ahead.then(|| self.sees(&on_plane))
    }

    /// The width of a texel in a map's places.
    pub fn texel(&self) -> f64 {
        texel(self.light)
    }

    /// The map that holds a point, hemisphere or face, and the place in it.
    pub fn place(&self, point: &Point) -> (u32, Vec2<f64>) {
        self.projection.place(self.to_light(point.world))
    }

    /// True within five texels of the seam between hemispheres, or of a face's edge.
    pub fn at_seam(&self, uv: Vec2<f64>) -> bool {
        self.projection.radius(uv) >= 1.0 - SEAM_TEXELS * self.texel()
    }

    /// The angle that a texel spans at a place.
    pub fn pitch(&self, uv: Vec2<f64>) -> f64 {
        self.projection.pitch(uv, self.light)
    }

    /// The distance of a depth stored at a place.
    pub fn distance(&self, depth: f64, uv: Vec2<f64>) -> f64 {
        self.projection.distance(depth, uv, self.light)
    }

    /// The largest change of the distance at a place where its depth is off by up to `off`: depth
    /// stays in [0, 1], and the distance grows with it.
    pub fn spread(&self, depth: f64, off: f64, uv: Vec2<f64>) -> f64 {
        let at = self.distance(depth, uv);
        let change = |depth: f64| (self.distance(depth, uv) - at).abs();
        change((depth - off).max(0.0)).max(change((depth + off).min(1.0)))
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let corner = |index: u32| self.frame.vertices[index as usize].position.as_dvec3();
        self.frame.triangles[triangle as usize].map(corner)
    }

    fn on_triangle(&self, triangle: u32, position: DVec3) -> Point {
        let normal = self.normal(triangle).try_normalize();
        Point { world: position, triangle: Some(triangle), normal }
    }

    /// A triangle's normal, as long as twice its area.
    fn normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
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
