//! Where meshes are: what a light may leave out of a map, and how finely it must subdivide.

use std::ops::Range;

use glam::{DVec3, Vec3 as Position};

use super::{Frame, FrameError, Level, Method, check};
use crate::scalar::caster::dpsm_caster_border;
use crate::scalar::float::Vec3;
use crate::scalar::hemisphere::{dpsm_flip, dpsm_to_light};
use crate::scalar::light::DpsmLight;
use crate::scalar::tessellate::dpsm_tessellate_level;
use crate::scene::nearest_of;

/// What two ranges have in common.
pub(crate) fn common(a: &Range<u32>, b: &Range<u32>) -> Range<u32> {
    a.start.max(b.start)..a.end.min(b.end)
}

/// A mesh's triangles and the sphere around them.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// Its triangles.
    pub triangles: Range<u32>,
    /// Centre of a sphere around it, world space.
    pub centre: DVec3,
    /// The sphere's radius.
    pub radius: f64,
    /// Longest edge of its triangles.
    pub longest_edge: f32,
}

impl Extent {
    /// The extent of a frame's triangles, but for those that cannot be drawn: a corner that is not
    /// there, or no number.
    pub fn of(frame: &Frame, triangles: &Range<u32>) -> Self {
        let corner = |index: u32| {
            let found = frame.vertices.get(index as usize).map(|vertex| vertex.position);
            found.filter(|position| check("", *position).is_ok())
        };
        let list: Vec<[Position; 3]> = frame.triangles
            [triangles.start as usize..triangles.end as usize]
            .iter()
            .filter_map(|&[a, b, c]| Some([corner(a)?, corner(b)?, corner(c)?]))
            .collect();
        let corners = || list.iter().flatten().map(|position| position.as_dvec3());
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let centre = (low + high) / 2.0;
        let edge = |&[a, b, c]: &[Position; 3]| a.distance(b).max(b.distance(c)).max(c.distance(a));
        Self {
            triangles: triangles.clone(),
            centre,
            radius: corners().map(|p| p.distance(centre)).fold(0.0, f64::max),
            longest_edge: list.iter().map(edge).fold(0.0, f32::max),
        }
    }

    /// The light-space centre.
    fn place(&self, light: &DpsmLight<f32>) -> Vec3<f64> {
        let DVec3 { x, y, z } = self.centre;
        dpsm_to_light(Vec3::new(x, y, z), light.widen())
    }

    /// True where the sphere, grown by what f32 rounds away, lies between the clipping spheres and
    /// touches the hemisphere's stored disk, a cone around its axis; `None` for all directions.
    pub fn is_seen(&self, light: &DpsmLight<f32>, hemisphere: Option<u32>) -> bool {
        let p = self.place(light);
        let distance = p.length();
        let radius = self.radius + 1e-5 * (distance + self.radius);
        let between =
            distance - radius <= f64::from(light.far) && distance + radius >= f64::from(light.near);
        let Some(hemisphere) = hemisphere else { return between };
        let angle = (dpsm_flip(p, hemisphere).z / distance).clamp(-1.0, 1.0).acos();
        let border = dpsm_caster_border(f64::from(light.guard)).acos();
        between && (distance <= radius || angle - (radius / distance).asin() <= border)
    }
}

impl Frame {
    /// Each mesh's extent, in the order of their triangles.
    pub fn extents(&self) -> Vec<Extent> {
        self.meshes.iter().map(|(_, range)| Extent::of(self, range)).collect()
    }

    /// The extents of the meshes that the tessellated method draws.
    pub(crate) fn tessellated(&self) -> Vec<Extent> {
        let drawn = self.drawn();
        let is_drawn = |(_, range): &&(String, Range<u32>)| {
            let by = |(drawn, method): &(Range<u32>, Method)| {
                *method == Method::Tessellated && !common(drawn, range).is_empty()
            };
            drawn.iter().any(by)
        };
        self.meshes.iter().filter(is_drawn).map(|(_, range)| Extent::of(self, range)).collect()
    }

    /// Each mesh's level of tessellation for a light, from its longest edge and its distance. The
    /// vertices that it makes must be countable in 32 bits.
    pub fn levels(
        &self,
        extents: &[Extent],
        light: &DpsmLight<f32>,
    ) -> Result<Vec<u32>, FrameError> {
        let level = |extent: &Extent| {
            let level = match self.settings.level {
                Level::Constant(level) => level.max(1),
                Level::Mesh(most) => {
                    let distance = self.nearest(extent, light).max(light.near.into()) as f32;
                    dpsm_tessellate_level(extent.longest_edge, distance, *light, LEVEL_TAU, most)
                }
            };
            let level64 = u64::from(level);
            let vertices =
                level64.saturating_mul(level64).saturating_mul(3 * u64::from(extent.triangles.end));
            match u32::try_from(vertices) {
                Ok(_) => Ok(level),
                Err(_) => Err(FrameError::Level { level, vertices }),
            }
        };
        extents.iter().map(level).collect()
    }

    /// Distance of the nearest point of a mesh's triangles from a light.
    fn nearest(&self, extent: &Extent, light: &DpsmLight<f32>) -> f64 {
        let Vec3 { x, y, z } = light.position.widen();
        let origin = DVec3::new(x, y, z);
        let corner = |index: u32| {
            let vertex = self.vertices.get(index as usize);
            vertex.map_or(DVec3::NAN, |vertex| vertex.position.as_dvec3() - origin)
        };
        let range = extent.triangles.start as usize..extent.triangles.end as usize;
        let triangles = self.triangles[range].iter().map(|t| t.map(corner));
        triangles.map(nearest_of).fold(f64::INFINITY, f64::min)
    }
}

/// Sagitta in texels that the level of a mesh allows: half a texel, as rasterizing rounds to that.
const LEVEL_TAU: f32 = 0.5;
