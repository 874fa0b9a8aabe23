//! Which meshes can shadow anything that shows, and how far they and the receivers are.

use std::collections::HashSet;

use glam::{DVec3, Vec3};

use crate::render::{SMALLEST, View};
use crate::scene::{Mesh, Scene, nearest_of};

/// Coordinates, of the largest one, by which a vertex may be behind a wall that it stands on: they
/// are f32.
const ON_PLANE: f64 = 4.0 * f32::EPSILON as f64;

/// Far's distance beyond the farthest receiver and near's share of the nearest caster's distance,
/// so that rounding never clips either.
const FAR_SLACK: f64 = 1.001;
const NEAR_SHARE: f64 = 0.99;

/// Near as a share of far, where no caster is left.
const NO_CASTER: f64 = 1e-3;

/// Why a mesh is left out of the maps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// All that shows lies on the light's side of each of its triangles.
    Bounds,
    /// It is farther from the light than everything that shows.
    Beyond,
    /// It is asked to cast no shadow.
    Switched,
}

/// The casters of some lights.
#[derive(Clone, Debug, PartialEq)]
pub struct Casters {
    /// For each of the scene's meshes, why it is left out; `None` where it is kept.
    pub left_out: Vec<Option<Reason>>,
    /// Near sphere's radius: in front of the nearest caster that is kept.
    pub near: f32,
    /// Far sphere's radius: behind the farthest receiver that may show.
    pub far: f32,
}

/// Finds them, `no_cast` those of the scene's meshes that are asked to cast no shadow. Only a mesh that
/// no view can see is no receiver; without views all are.
pub fn casters(scene: &Scene, no_cast: &[bool], lights: &[Vec3], views: &[View]) -> Casters {
    let shows = |mesh: &&Mesh| views.is_empty() || views.iter().any(|view| may_see(view, mesh));
    let receivers: Vec<&Mesh> = scene.meshes.iter().filter(shows).collect();
    let points = || receivers.iter().flat_map(|mesh| &mesh.positions).map(|p| p.as_dvec3());
    let lights: Vec<DVec3> = lights.iter().map(|light| light.as_dvec3()).collect();
    let farthest = |light: &DVec3| points().map(|point| point.distance(*light)).fold(0.0, f64::max);
    let reaches: Vec<f64> = lights.iter().map(farthest).collect();
    let largest = points().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    let reason = |(index, mesh): (usize, &Mesh)| {
        if no_cast.get(index) == Some(&true) {
            return Some(Reason::Switched);
        }
        let beyond = |(light, reach): (&DVec3, &f64)| nearest(mesh, *light) > *reach;
        if lights.iter().zip(&reaches).all(beyond) {
            return Some(Reason::Beyond);
        }
        let bounds = |light: &DVec3| bounds(mesh, *light, &receivers, ON_PLANE * largest);
        lights.iter().all(bounds).then_some(Reason::Bounds)
    };
    let left_out: Vec<Option<Reason>> = scene.meshes.iter().enumerate().map(reason).collect();
    let kept = || scene.meshes.iter().zip(&left_out).filter(|(_, out)| out.is_none());
    let smallest = f64::from(SMALLEST);
    let far = reaches.iter().fold(2.0 * smallest, |far, reach| reach.max(far)) * FAR_SLACK;
    let nearest = kept()
        .flat_map(|(mesh, _)| lights.iter().map(|light| nearest(mesh, *light)))
        .fold(f64::INFINITY, f64::min);
    let near = if nearest.is_finite() { nearest * NEAR_SHARE } else { far * NO_CASTER };
    let near = near.clamp(smallest, far * NEAR_SHARE);
    Casters { left_out, near: near as f32, far: far as f32 }
}

/// True unless all of a mesh lies outside one of the planes of a view's pyramid.
fn may_see(view: &View, mesh: &Mesh) -> bool {
    let [eye, right, up, forward] =
        [view.eye, view.right, view.up, view.forward].map(|v| v.as_dvec3());
    let [across, high] = view.scale.map(f64::from);
    let sides = [
        forward + right * across,
        forward - right * across,
        forward + up * high,
        forward - up * high,
        forward,
    ];
    // a point's rounding, so that what touches a plane counts as seen
    sides.iter().all(|side| {
        let inside = |p: &Vec3| {
            let d = p.as_dvec3() - eye;
            side.dot(d) >= -ON_PLANE * side.length() * (d.length() + eye.length())
        };
        mesh.positions.iter().any(inside)
    })
}

/// Distance of a mesh's nearest point from a light.
fn nearest(mesh: &Mesh, light: DVec3) -> f64 {
    let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize].as_dvec3() - light);
    mesh.triangles.iter().map(|t| nearest_of(corners(t))).fold(f64::INFINITY, f64::min)
}

/// True where all receivers lie on the light's side of each of the mesh's triangles, so that none
/// of them shadows any.
fn bounds(mesh: &Mesh, light: DVec3, receivers: &[&Mesh], slack: f64) -> bool {
    let mut known = HashSet::new();
    mesh.triangles.iter().all(|t| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { return true };
        let towards = normal.dot(light - a);
        if towards.abs() <= slack {
            return false;
        }
        let normal = normal * towards.signum();
        // a wall of many triangles is one plane
        let place = [normal.x, normal.y, normal.z, normal.dot(a)].map(|c| (c / slack) as i64);
        if !known.insert(place) {
            return true;
        }
        let in_front = |p: &Vec3| normal.dot(p.as_dvec3() - a) >= -slack;
        receivers.iter().all(|mesh| mesh.positions.iter().all(in_front))
    })
}
