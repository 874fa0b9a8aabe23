//! What the clipping spheres and the format take from the maps.

use std::ops::Range;

use glam::{DVec3, Vec3};

use super::spheres::corner;
use super::{Frame, Method};
use crate::scene::nearest_of;

/// How many meshes a warning names.
const NAMED: usize = 3;

/// How far from the light a mesh's triangles are.
struct Reach<'a> {
    mesh: &'a str,
    nearest: f64,
    farthest: f64,
}

impl Frame {
    /// What the clipping spheres and the format take from the maps, a sentence each: casters that
    /// near or far cut off, and steps of depth that are wider than a texel.
    pub fn warnings(&self) -> Vec<String> {
        let reaches = self.reaches();
        let [near, far] = self.radii();
        // what lies beyond the range needs no shadow
        let range = f64::from(self.shine.range);
        let step = self.step();
        let texels = f64::from(self.light.size) / (2.0 * (1.0 + f64::from(self.light.guard)));
        let wide = step * texels;
        let at = |mesh: &str, distance: f64| format!("`{mesh}` at {distance:.3e}");
        let nearer =
            named(reaches.iter().filter(|r| r.nearest < near).map(|r| at(r.mesh, r.nearest)));
        let farther = named(
            reaches
                .iter()
                .filter(|r| r.farthest > far && far < range)
                .map(|r| at(r.mesh, r.farthest)),
        );
        let coarse =
            named(reaches.iter().filter(|r| r.nearest < wide).map(|r| at(r.mesh, r.nearest)));
        let none = "what is cut off casts no shadow";
        let nearer = nearer.map(|meshes| {
            format!("near {near:.3e} cuts off casters at the light: {meshes}; {none}: give a smaller --near")
        });
        let farther = farther.map(|meshes| {
            format!(
                "far {far:.3e} cuts off casters beyond it: {meshes}; {none}: give a larger --far"
            )
        });
        let coarse = coarse.map(|meshes| {
            format!(
                "a step of the format is {step:.3e} world units, wider than a texel nearer than {wide:.3e} \
                 to the light: {meshes}; give --format d32"
            )
        });
        [nearer, farther, coarse].into_iter().flatten().collect()
    }

    /// Near and far as radii: a cube's struct has its near plane, which lies inside.
    fn radii(&self) -> [f64; 2] {
        let corner = match self.settings.method {
            Method::Cube => f64::from(corner(self.light.guard)),
            _ => 1.0,
        };
        // up to the rounding of that factor
        let near = f64::from(self.light.near) * corner * (1.0 - f64::from(f32::EPSILON));
        [near, self.light.far.into()]
    }

    /// A unorm's step of radial depth in world units; 0 for floats and for a cube's perspective depth.
    fn step(&self) -> f64 {
        match self.settings.method {
            Method::Cube => 0.0,
            _ => {
                f64::from(self.settings.format.quantum())
                    * f64::from(self.light.far - self.light.near)
            }
        }
    }

    /// The meshes that cast, but for what touches the light, which shadows nothing.
    fn reaches(&self) -> Vec<Reach<'_>> {
        let light = self.light_position().as_dvec3();
        let touch = f64::from(f32::EPSILON) * light.abs().max_element();
        let drawn = self.drawn();
        let casts =
            |of: &&(String, Range<u32>)| drawn.iter().any(|(range, _)| range.contains(&of.1.start));
        let corner = |index: u32| self.vertices[index as usize].position.as_dvec3() - light;
        let reach = |triangles: &[[u32; 3]]| {
            let (mut nearest, mut farthest) = (f64::INFINITY, 0.0_f64);
            for triangle in triangles {
                let corners = triangle.map(corner);
                let distance = nearest_of(corners);
                nearest = if distance > touch { nearest.min(distance) } else { nearest };
                farthest = corners.map(DVec3::length).into_iter().fold(farthest, f64::max);
            }
            (nearest, farthest)
        };
        let reaches = self.meshes.iter().filter(casts).map(|(mesh, range)| {
            let triangles = &self.triangles[range.start as usize..range.end as usize];
            let (nearest, farthest) = reach(triangles);
            Reach { mesh, nearest, farthest }
        });
        reaches.collect()
    }

    fn light_position(&self) -> Vec3 {
        let position = self.light.position;
        Vec3::new(position.x, position.y, position.z)
    }
}

/// The first of some meshes and how many more there are; `None` of none.
fn named(mut meshes: impl Iterator<Item = String>) -> Option<String> {
    let first: Vec<String> = meshes.by_ref().take(NAMED).collect();
    let text = first.join(", ");
    match (first.is_empty(), meshes.count()) {
        (true, _) => None,
        (false, 0) => Some(text),
        (false, more) => Some(format!("{text} and {more} more")),
    }
}
