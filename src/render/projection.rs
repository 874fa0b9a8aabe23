//! What the maps of a light are: two disks, or six faces of a cube; one interface to both.

use super::{Bias, Filter, Frame, Method};
use crate::scalar::bias::{
    DpsmReceiver, dpsm_bias_footprint, dpsm_lookup_biased, dpsm_lookup_texel_centre,
    dpsm_position_error, dpsm_receiver,
};
use crate::scalar::cube::{
    dpsm_cube_depth, dpsm_cube_distance, dpsm_cube_face, dpsm_cube_lookup,
    dpsm_cube_lookup_footprint, dpsm_cube_lookup_texel_centre, dpsm_cube_receiver_depth,
    dpsm_cube_unview, dpsm_cube_view,
};
use crate::scalar::depth::{dpsm_depth_stored, dpsm_distance, dpsm_receiver_depth};
use crate::scalar::float::{Float, Vec2, Vec3};
use crate::scalar::hemisphere::{dpsm_flip, dpsm_hemisphere};
use crate::scalar::light::DpsmLight;
use crate::scalar::maps::{DepthMaps, Maps};
use crate::scalar::paraboloid::{
    dpsm_project, dpsm_project_own, dpsm_texel_pitch, dpsm_texture_to_disk, dpsm_unproject,
};
use crate::scalar::plane::{dpsm_visibility_normal, dpsm_visibility_plane};
use crate::scalar::visibility::{DpsmLookup, dpsm_lookup};

/// How a method's maps hold the directions around a light.
///
/// A *place* in a map is `uv`: disk coordinates, or a face's plane at distance 1. Both become
/// texture coordinates by `dpsm_disk_to_texture`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// A disk for each hemisphere, radial depth.
    Paraboloid,
    /// A square for each face, depth along the face's axis in perspective.
    Cube,
}

impl Method {
    /// What the method's maps are.
    pub fn projection(self) -> Projection {
        match self {
            Method::Cube => Projection::Cube,
            _ => Projection::Paraboloid,
        }
    }
}

impl Frame {
    /// The share of the light with the frame's filter and bias: 1 lit, 0 in shadow.
    ///
    /// `p`: light-space position; `normal`: the surface's own there, in light space, of any length
    /// and side; zero where it is not known.
    pub fn visibility(&self, maps: &DepthMaps, p: Vec3<f32>, normal: Vec3<f32>) -> f32 {
        self.visibility_turned(maps, p, normal, Vec2::new(1.0, 0.0))
    }

    /// The receiver at a light-space position, which the world's rounding may have moved.
    pub fn receiver(&self, p: Vec3<f32>, normal: Vec3<f32>) -> DpsmReceiver<f32> {
        let DpsmLight { position, right, up, forward, .. } = self.light;
        let world = position + right * p.x + up * p.y + forward * p.z;
        dpsm_receiver(p, normal, dpsm_position_error(world))
    }

    /// The same where a kernel's first tap has a direction of its own, a unit vector.
    pub fn visibility_turned(
        &self,
        maps: &DepthMaps,
        p: Vec3<f32>,
        normal: Vec3<f32>,
        rotation: Vec2<f32>,
    ) -> f32 {
        if self.settings.filter != Filter::Single {
            return self.filtered(maps, p, normal, rotation);
        }
        let (light, quantum) = (self.light, self.settings.quantum());
        let tolerance = self.settings.too_near();
        let receiver = self.receiver(p, normal);
        match self.settings.bias_taken() {
            Bias::Plane => {
                return dpsm_visibility_plane(maps, p, receiver, light, quantum, tolerance);
            }
            Bias::Normal => {
                return dpsm_visibility_normal(maps, p, receiver, light, quantum, tolerance);
            }
            _ => {}
        }
        let at = self.lookup(p, normal);
        match at.mapped {
            true => {
                let reference = dpsm_depth_stored(at.depth, light.reversed);
                maps.compare(at.coordinates, at.layer, reference)
            }
            false => 0.0,
        }
    }

    /// Where the shadow test looks, and the depth that it compares, less the frame's bias; for `Plane`
    /// and `Normal`, which compare several, that of their texels' footprint.
    pub fn lookup(&self, p: Vec3<f32>, normal: Vec3<f32>) -> DpsmLookup<f32> {
        let (settings, light) = (&self.settings, self.light);
        let quantum = settings.quantum();
        let tolerance = settings.too_near();
        let receiver = self.receiver(p, normal);
        let texels = settings.window();
        match settings.method.projection() {
            Projection::Paraboloid => {
                let uv = dpsm_project_own(p);
                let window = match settings.bias_taken() {
                    Bias::Constant(_) => {
                        let at = dpsm_lookup(p, light);
                        return DpsmLookup { depth: at.depth - self.bias, ..at };
                    }
                    Bias::TexelCentre => {
                        return dpsm_lookup_texel_centre(p, receiver, light, quantum, tolerance);
                    }
                    Bias::Footprint | Bias::Plane | Bias::Normal => {
                        dpsm_bias_footprint(receiver, uv, texels, light)
                    }
                };
                dpsm_lookup_biased(p, window, light, quantum, tolerance)
            }
            Projection::Cube => match settings.bias_taken() {
                Bias::Constant(_) => {
                    let at = dpsm_cube_lookup(p, light);
                    let depth = dpsm_cube_receiver_depth(p, at.hemisphere, light, self.bias);
                    DpsmLookup { depth, ..at }
                }
                Bias::TexelCentre => dpsm_cube_lookup_texel_centre(p, receiver, light, quantum),
                Bias::Footprint | Bias::Plane | Bias::Normal => {
                    dpsm_cube_lookup_footprint(p, receiver, texels, light, quantum)
                }
            },
        }
    }

    /// The distances that a layer stores, row by row from the top; infinite where it is empty.
    pub fn distances(&self, maps: &DepthMaps, layer: u32) -> impl Iterator<Item = f32> {
        let (size, light) = (maps.size as usize, self.light);
        let projection = self.settings.method.projection();
        (0..size * size).map(move |index| {
            let depth = maps.depth(layer as usize * size * size + index);
            if depth >= 1.0 {
                return f32::INFINITY;
            }
            let centre = Vec2::new((index % size) as f32, (index / size) as f32) + Vec2::splat(0.5);
            let uv = dpsm_texture_to_disk(centre / size as f32, light.guard);
            projection.distance(depth, uv, light)
        })
    }
}

impl Projection {
    /// The maps' names, in the order of their layers.
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Self::Paraboloid => &["front", "back"],
            Self::Cube => &["+x", "-x", "+y", "-y", "+z", "-z"],
        }
    }

    /// Where a receiver looks: `dpsm_lookup`, `dpsm_cube_lookup`.
    pub fn lookup<T: Float>(self, p: Vec3<T>, light: DpsmLight<T>) -> DpsmLookup<T> {
        match self {
            Self::Paraboloid => dpsm_lookup(p, light),
            Self::Cube => dpsm_cube_lookup(p, light),
        }
    }

    /// The map that holds a light-space point, hemisphere or face, and the place in it.
    pub fn place<T: Float>(self, p: Vec3<T>) -> (u32, Vec2<T>) {
        let map = match self {
            Self::Paraboloid => dpsm_hemisphere(p),
            Self::Cube => dpsm_cube_face(p),
        };
        (map, self.place_in(p, map).unwrap_or(Vec2::splat(T::lit(0.0))))
    }

    /// The place of a light-space point in a given map, which may lie outside it; `None` behind a
    /// face.
    pub fn place_in<T: Float>(self, p: Vec3<T>, map: u32) -> Option<Vec2<T>> {
        match self {
            Self::Paraboloid => Some(dpsm_project(dpsm_flip(p, map))),
            Self::Cube => {
                let v = dpsm_cube_view(p, map);
                (v.z > T::lit(0.0)).then(|| v.xy() / v.z)
            }
        }
    }

    /// The light-space direction of a place: of unit length on a disk, of length 1 along a face's
    /// axis.
    pub fn direction<T: Float>(self, uv: Vec2<T>, map: u32) -> Vec3<T> {
        match self {
            Self::Paraboloid => dpsm_flip(dpsm_unproject(uv), map),
            Self::Cube => dpsm_cube_unview(Vec3::new(uv.x, uv.y, T::lit(1.0)), map),
        }
    }

    /// How far out a place is: 1 at the rim of a disk, and at a face's edge.
    pub fn radius<T: Float>(self, uv: Vec2<T>) -> T {
        match self {
            Self::Paraboloid => uv.length(),
            Self::Cube => uv.x.abs().max(uv.y.abs()),
        }
    }

    /// The depth of a light-space point in a map, in [0, 1].
    pub fn depth<T: Float>(self, p: Vec3<T>, map: u32, light: DpsmLight<T>) -> T {
        match self {
            Self::Paraboloid => dpsm_receiver_depth(p.length(), light.near, light.far),
            Self::Cube => dpsm_cube_depth(dpsm_cube_view(p, map).z, light.near, light.far),
        }
    }

    /// The radial distance of a depth stored at a place.
    pub fn distance<T: Float>(self, depth: T, uv: Vec2<T>, light: DpsmLight<T>) -> T {
        match self {
            Self::Paraboloid => dpsm_distance(depth, light.near, light.far),
            Self::Cube => dpsm_cube_distance(depth, self.direction(uv, 0), light.near, light.far),
        }
    }

    /// How many times as far as its nearest point a clipping surface is in a direction: 1 for a
    /// sphere; a face's plane is farther off its axis.
    pub fn stretch<T: Float>(self, p: Vec3<T>) -> T {
        match self {
            Self::Paraboloid => T::lit(1.0),
            Self::Cube => {
                let (face, uv) = self.place(p);
                self.direction(uv, face).length()
            }
        }
    }
}

impl Projection {
    /// The angle that a texel spans: the root of its solid angle. On a disk it is the same in all
    /// directions; on a face, with l^2 = 1 + |uv|^2, w / l across and w / l^2 along the radius for
    /// a texel w wide on the plane, so w / l^1.5.
    pub fn pitch(self, uv: Vec2<f64>, light: DpsmLight<f64>) -> f64 {
        match self {
            Self::Paraboloid => dpsm_texel_pitch(uv, light.size, light.guard),
            Self::Cube => texel(light) / (1.0 + uv.dot(uv)).powf(0.75),
        }
    }

    /// The smallest angle that a texel spans in any direction: at the rim, or along the radius at
    /// a corner of a stored face, where l^2 = 1 + 2 (1 + guard)^2.
    pub fn finest_pitch(self, light: DpsmLight<f64>) -> f64 {
        match self {
            Self::Paraboloid => dpsm_texel_pitch(Vec2::new(1.0, 0.0), light.size, light.guard),
            Self::Cube => texel(light) / (1.0 + 2.0 * (1.0 + light.guard).powi(2)),
        }
    }
}

/// The width of a texel in a map's places.
pub fn texel(light: DpsmLight<f64>) -> f64 {
    2.0 * (1.0 + light.guard) / light.size
}
