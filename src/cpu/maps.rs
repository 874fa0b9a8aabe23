//! The map passes of the paraboloid methods.

use std::ops::Range;

use super::refined::leaves;
use super::{mix, opaque, pick, triangle, vector, words};
use crate::render::{Frame, FrameError, Method, Projection, Vertex, common, float};
use crate::scalar::caster::{dpsm_caster_fragment, dpsm_caster_keep, dpsm_caster_vertex};
use crate::scalar::classify::{DPSM_IN_BACK, DPSM_IN_FRONT, dpsm_classify, dpsm_projected};
use crate::scalar::depth::{dpsm_depth, dpsm_depth_stored};
use crate::scalar::float::{Vec2, Vec3, Vec4};
use crate::scalar::hemisphere::{DPSM_BACK, DPSM_FRONT, dpsm_flip, dpsm_to_light};
use crate::scalar::paraboloid::dpsm_texel_width;
use crate::scalar::part::{DPSM_PART_DRAWN, DPSM_PART_LARGE, dpsm_part, dpsm_part_kind};
use crate::scalar::refine::dpsm_refine_clip;
use crate::scalar::tessellate::{dpsm_tessellate_point, dpsm_tessellate_weights};
use crate::scalar::triangle::{
    dpsm_triangle, dpsm_triangle_disk, dpsm_triangle_distance, dpsm_triangle_fragment,
    dpsm_triangle_hull, dpsm_triangle_plane, dpsm_triangle_span, dpsm_triangle_weights,
};

/// The maps store true distances; the bias is the receiver's, so that it may differ by receiver.
const NO_BIAS: f32 = 0.0;

/// Paths of more halvings than this are given up for a hull around the whole map.
const DEEPEST: u32 = 1 << 24;

/// One map: stored depths of all casters, each by its method.
pub fn map_pass(frame: &Frame, map: u32, layer: &mut [f32]) -> Result<(), FrameError> {
    if frame.settings.method.projection() == Projection::Cube {
        super::cube::map_pass(frame, map, layer);
        return Ok(());
    }
    let mut target = Target { frame, map, layer };
    for (triangles, method) in frame.drawn() {
        match method {
            Method::Vertex | Method::FragmentDepth => target.straight(triangles, method),
            Method::Tessellated => target.tessellated(triangles)?,
            Method::Exact => target.exact(triangles),
            Method::Refined => target.refined(triangles),
            // `Frame::new` lets none in
            Method::Cube => {}
        }
    }
    Ok(())
}

struct Target<'a> {
    frame: &'a Frame,
    map: u32,
    layer: &'a mut [f32],
}

impl Target<'_> {
    fn store(&mut self, x: u32, y: u32, depth: f32) {
        if (0.0..=1.0).contains(&depth) {
            let texel = &mut self.layer[(y * self.frame.settings.size + x) as usize];
            let stored = self.frame.settings.format.store(depth);
            *texel = match self.frame.settings.reversed {
                false => texel.min(stored),
                true => texel.max(stored),
            };
        }
    }

    fn place(&self, vertex: &Vertex) -> Vec3<f32> {
        dpsm_flip(dpsm_to_light(float(vertex.position), self.frame.light), self.map)
    }

    /// Brabec's method and the blog's: straight edges between the vertices.
    fn straight(&mut self, triangles: Range<u32>, method: Method) {
        let Frame { light, settings, .. } = self.frame;
        let place = |vertex: &Vertex| {
            let p = self.place(vertex);
            (p, dpsm_caster_vertex(p, *light, NO_BIAS))
        };
        let placed: Vec<_> = self.frame.vertices.iter().map(place).collect();
        for index in triangles {
            let corners = &self.frame.triangles[index as usize];
            let Some(corners) = pick(&placed, *corners) else { continue };
            let clip = corners.map(|(_, vertex)| vertex.clip);
            triangle(clip, [settings.size; 2], 1.0, &mut |fragment| {
                let (keep, depth) = if method == Method::Vertex {
                    let value = |(_, vertex): (_, crate::scalar::caster::DpsmCasterVertex<f32>)| {
                        [vertex.hemisphere_value]
                    };
                    let [value] = mix(fragment.weights, corners, value);
                    (dpsm_caster_keep(value), fragment.depth)
                } else {
                    let p = vector(mix(fragment.weights, corners, |(p, _)| words(p)));
                    let stored = dpsm_caster_fragment(p, *light, NO_BIAS);
                    (stored.keep, stored.depth)
                };
                if keep && opaque(self.frame, index, &fragment) {
                    self.store(fragment.x, fragment.y, depth);
                }
            });
        }
    }

    /// Brabec's method on subdivided triangles.
    fn tessellated(&mut self, triangles: Range<u32>) -> Result<(), FrameError> {
        let Frame { light, settings, .. } = self.frame;
        let extents = self.frame.tessellated();
        let levels = self.frame.levels(&extents, light)?;
        for (extent, level) in extents.into_iter().zip(levels) {
            if !extent.is_seen(light, Some(self.map)) {
                continue;
            }
            for index in common(&extent.triangles, &triangles) {
                let corners = self.frame.triangles[index as usize];
                let Some(corners) = pick(&self.frame.vertices, corners) else { continue };
                let [a, b, c] = corners.map(|vertex| float(vertex.position));
                for first in (0..3 * level * level).step_by(3) {
                    let weights = [0, 1, 2].map(|i| dpsm_tessellate_weights(level, first + i));
                    let corners = weights.map(|weights| {
                        let p = dpsm_to_light(dpsm_tessellate_point(a, b, c, weights), *light);
                        dpsm_caster_vertex(dpsm_flip(p, self.map), *light, NO_BIAS)
                    });
                    let clip = corners.map(|vertex| vertex.clip);
                    triangle(clip, [settings.size; 2], 1.0, &mut |fragment| {
                        let value = |vertex: crate::scalar::caster::DpsmCasterVertex<f32>| {
                            [vertex.hemisphere_value]
                        };
                        let [value] = mix(fragment.weights, corners, value);
                        let whole = mix(fragment.weights, weights, |w| {
                            w.map(|numerator| numerator as f32 / level as f32)
                        });
                        let seen = self.frame.opaque(index, whole.map(f64::from));
                        if dpsm_caster_keep(value) && seen {
                            self.store(fragment.x, fragment.y, fragment.depth);
                        }
                    });
                }
            }
        }
        Ok(())
    }

    /// The exact method: as parts.wesl cuts and caster.wesl draws.
    fn exact(&mut self, triangles: Range<u32>) {
        let light = self.frame.light;
        let bit = if self.map == DPSM_FRONT { DPSM_IN_FRONT } else { DPSM_IN_BACK };
        let place = |vertex: &Vertex| dpsm_to_light(float(vertex.position), light);
        let placed: Vec<_> = self.frame.vertices.iter().map(place).collect();
        for index in triangles {
            let corners = &self.frame.triangles[index as usize];
            let Some(corners) = pick(&placed, *corners) else { continue };
            let z = corners[0].z + corners[1].z + corners[2].z;
            let own = if z >= 0.0 { DPSM_FRONT } else { DPSM_BACK };
            let [a, b, c] = corners.map(|p| dpsm_projected(dpsm_flip(p, own)));
            let height = dpsm_triangle_plane(a.p, b.p, c.p).w;
            let maps = dpsm_classify(a, b, c, height, own, light);
            let flipped = corners.map(|p| dpsm_flip(p, self.map));
            match maps & bit {
                0 => {}
                _ if maps == DPSM_IN_FRONT | DPSM_IN_BACK => self.parts(index, flipped),
                _ => self.part(index, flipped, Some(1)),
            }
        }
    }

    /// The refined method: as refine.wesl refines and caster.wesl draws.
    fn refined(&mut self, triangles: Range<u32>) {
        let Frame { light, settings, .. } = self.frame;
        for leaf in leaves(self.frame, self.map, triangles) {
            let clip = leaf.corners.map(|corner| {
                let clip = dpsm_refine_clip(corner.uv, corner.distance, *light);
                match leaf.face {
                    Some(_) => Vec4::new(clip.x, clip.y, 0.5, 1.0),
                    None => clip,
                }
            });
            let corners = self.frame.triangles[leaf.triangle as usize];
            let masked = self.frame.mask(leaf.triangle).is_some();
            triangle(clip, [settings.size; 2], 1.0, &mut |fragment| {
                let uv = self.disk(fragment.x, fragment.y);
                let Some(face) = leaf.face else {
                    return self.store(fragment.x, fragment.y, fragment.depth);
                };
                let l = dpsm_triangle_distance(face, uv).max(leaf.nearest);
                let weights = || {
                    let place = |index: u32| {
                        let vertex = &self.frame.vertices[index as usize];
                        dpsm_flip(dpsm_to_light(float(vertex.position), *light), self.map)
                    };
                    let [a, b, c] = corners.map(place);
                    let weights = dpsm_triangle_weights(a, b, c, uv);
                    [weights.x, weights.y, weights.z].map(f64::from)
                };
                if l >= light.near && (!masked || self.frame.opaque(leaf.triangle, weights())) {
                    let depth = dpsm_depth(l, light.near, light.far);
                    self.store(fragment.x, fragment.y, dpsm_depth_stored(depth, light.reversed));
                }
            });
        }
    }

    /// The parts of a large triangle.
    fn parts(&mut self, index: u32, corners: [Vec3<f32>; 3]) {
        let [a, b, c] = corners;
        let mut path = 1;
        loop {
            let part = dpsm_part(a, b, c, path);
            let kind = dpsm_part_kind(part, self.frame.light);
            if kind == DPSM_PART_LARGE {
                if path >= DEEPEST {
                    return self.part(index, corners, None);
                }
                path *= 2;
                continue;
            }
            if kind == DPSM_PART_DRAWN {
                self.part(index, corners, Some(path));
            }
            path = (path + 1) >> (path + 1).trailing_zeros();
            if path == 1 {
                return;
            }
        }
    }

    /// A part of a triangle, or for `None` all of it by every texel.
    fn part(&mut self, index: u32, corners: [Vec3<f32>; 3], path: Option<u32>) {
        let Frame { light, settings, .. } = self.frame;
        let [a, b, c] = corners;
        let mut prepared = dpsm_triangle(a, b, c, *light);
        let rim = 1.0 + light.guard;
        let hull = match path {
            Some(path) => {
                let part = dpsm_part(a, b, c, path);
                prepared.span = dpsm_triangle_span(part.a, part.b, part.c, *light);
                let hull = dpsm_triangle_hull(part.a, part.b, part.c, *light);
                [hull.a, hull.b, hull.c]
            }
            None => {
                [[-rim, -rim], [3.0 * rim, -rim], [-rim, 3.0 * rim]].map(|[x, y]| Vec2::new(x, y))
            }
        };
        let clip = hull.map(|uv| Vec4::new(uv.x / rim, uv.y / rim, 0.5, 1.0));
        triangle(clip, [settings.size; 2], 1.0, &mut |fragment| {
            let uv = self.disk(fragment.x, fragment.y);
            let stored = dpsm_triangle_fragment(prepared, uv, *light, NO_BIAS);
            let weights = || {
                let weights = dpsm_triangle_weights(a, b, c, uv);
                [weights.x, weights.y, weights.z].map(f64::from)
            };
            let masked = self.frame.mask(index).is_some();
            if stored.keep && (!masked || self.frame.opaque(index, weights())) {
                self.store(fragment.x, fragment.y, stored.depth);
            }
        });
    }

    /// The disk coordinates of a texel's centre.
    fn disk(&self, x: u32, y: u32) -> Vec2<f32> {
        let light = &self.frame.light;
        let middle = Vec2::splat(0.5 * light.size);
        let position = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        dpsm_triangle_disk(position, middle, dpsm_texel_width(light.size, light.guard))
    }
}
