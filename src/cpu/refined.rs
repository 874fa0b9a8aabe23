//! Refinement, as refine.wesl does it.

use std::ops::Range;

use super::pick;
use crate::render::{Frame, Method, float, refinement_levels};
use crate::scalar::classify::{
    DPSM_IN_BACK, DPSM_IN_FRONT, DpsmProjected, dpsm_classify, dpsm_classify_misses, dpsm_projected,
};
use crate::scalar::float::{Vec3, Vec4};
use crate::scalar::hemisphere::{DPSM_BACK, DPSM_FRONT, dpsm_flip, dpsm_to_light};
use crate::scalar::refine::{
    DPSM_REFINE_INNER, dpsm_refine_corners, dpsm_refine_edge, dpsm_refine_fat, dpsm_refine_flat,
    dpsm_refine_foot, dpsm_refine_long, dpsm_refine_outside, dpsm_refine_point, dpsm_refine_reach,
    dpsm_refine_splits,
};
use crate::scalar::triangle::{DpsmHull, dpsm_triangle_face, dpsm_triangle_plane};

/// A triangle that is drawn in a map.
#[derive(Clone, Copy, Debug)]
pub struct Leaf {
    /// Its corners as the map sees them.
    pub corners: [DpsmProjected<f32>; 3],
    /// The plane that its fragments take their distance from (`dpsm_triangle_face`); for `None`
    /// the corners' distances are interpolated.
    pub face: Option<Vec4<f32>>,
    /// The least distance that they take.
    pub nearest: f32,
    /// The triangle of the mesh that it is a part of.
    pub triangle: u32,
}

/// What triangles fall into, in one map.
pub fn leaves(frame: &Frame, map: u32, triangles: Range<u32>) -> Vec<Leaf> {
    let light = frame.light;
    let [tau, depth_tolerance] = frame.settings.tolerances_of(Method::Refined);
    let mut refiner = Refiner {
        frame,
        map,
        depth_tolerance,
        reach: dpsm_refine_reach(light, tau),
        levels: refinement_levels(frame.settings.size, tau),
        leaves: Vec::new(),
    };
    let place = |p| dpsm_to_light(float(p), light);
    let placed: Vec<_> = frame.vertices.iter().map(|vertex| place(vertex.position)).collect();
    for triangle in triangles {
        if let Some(corners) = pick(&placed, frame.triangles[triangle as usize]) {
            refiner.root(triangle, corners);
        }
    }
    refiner.leaves
}

struct Refiner<'a> {
    frame: &'a Frame,
    map: u32,
    depth_tolerance: f32,
    reach: f32,
    levels: u32,
    leaves: Vec<Leaf>,
}

/// What the parts of one triangle share.
#[derive(Clone, Copy)]
struct Root {
    triangle: u32,
    plane: Vec4<f32>,
    /// The largest distance of its corners: chords may leave a part, to where its plane is farther
    /// away than the part's own.
    farthest: f32,
}

/// Edges that are split, and those that need not follow their arcs.
#[derive(Clone, Copy)]
struct Edges {
    split: u32,
    free: u32,
}

/// The least distance of a part's points: at the light's foot where that is inside, else on an edge.
fn nearest_of(corners: [Vec3<f32>; 3], plane: Vec4<f32>) -> f32 {
    let (normal, foot) = (plane.xyz(), plane.xyz() * plane.w);
    let edges = [0, 1, 2].map(|k| (corners[k], corners[(k + 1) % 3]));
    let inside = |(a, b): &(Vec3<f32>, Vec3<f32>)| normal.dot((*b - *a).cross(foot - *a)) >= 0.0;
    if edges.iter().all(inside) {
        return plane.w.abs();
    }
    edges.into_iter().map(|(a, b)| nearest_between(a, b)).fold(f32::INFINITY, f32::min)
}

/// The least distance of an edge's points.
fn nearest_between(a: Vec3<f32>, b: Vec3<f32>) -> f32 {
    let ab = b - a;
    let smallest = 1.0 / (1u128 << 120) as f32;
    let along = (-a.dot(ab) / ab.dot(ab).max(smallest)).clamp(0.0, 1.0);
    (a + ab * along).length()
}

impl Refiner<'_> {
    fn root(&mut self, triangle: u32, corners: [Vec3<f32>; 3]) {
        let light = self.frame.light;
        let z = corners[0].z + corners[1].z + corners[2].z;
        let own = if z >= 0.0 { DPSM_FRONT } else { DPSM_BACK };
        let [a, b, c] = corners.map(|p| dpsm_projected(dpsm_flip(p, own)));
        let bit = if self.map == DPSM_FRONT { DPSM_IN_FRONT } else { DPSM_IN_BACK };
        let height = dpsm_triangle_plane(a.p, b.p, c.p).w;
        if dpsm_classify(a, b, c, height, own, light) & bit == 0 {
            return;
        }
        let seen = corners.map(|p| dpsm_projected(dpsm_flip(p, self.map)));
        let [a, b, c] = seen;
        let plane = dpsm_triangle_plane(a.p, b.p, c.p);
        let farthest = a.distance.max(b.distance).max(c.distance);
        let root = Root { triangle, plane, farthest };
        let splits = |a, b, bit| if dpsm_refine_splits(a, b, self.reach) { bit } else { 0 };
        let split = splits(a, b, 1) | splits(b, c, 2) | splits(c, a, 4);
        if dpsm_refine_foot(a.p, b.p, c.p, plane) {
            self.split_at_foot(root, seen, split);
        } else if split == 0 {
            self.draw(root, seen, false);
        } else if !dpsm_refine_outside(a.uv, b.uv, c.uv, light) {
            self.split(root, seen, Edges { split, free: 0 }, 1);
        }
    }

    /// Three parts around the foot; the triangle's own edges stay as they are.
    fn split_at_foot(&mut self, root: Root, corners: [DpsmProjected<f32>; 3], split: u32) {
        let foot = dpsm_projected(root.plane.xyz() * root.plane.w);
        for i in 0..3 {
            let [from, to] = [corners[i], corners[(i + 1) % 3]];
            let splits = |a, b| u32::from(dpsm_refine_splits(a, b, self.reach));
            let own = (split >> i & 1) | splits(to, foot) << 1 | splits(foot, from) << 2;
            let part = [from, to, foot];
            if own == 0 {
                self.leaf(root, part, false);
            } else if !dpsm_refine_outside(from.uv, to.uv, foot.uv, self.frame.light) {
                self.split(root, part, Edges { split: own, free: 0 }, 2);
            }
        }
    }

    fn leaf(&mut self, root: Root, corners: [DpsmProjected<f32>; 3], loose: bool) {
        let light = self.frame.light;
        let [a, b, c] = corners;
        let is_outside = dpsm_refine_outside(a.uv, b.uv, c.uv, light);
        if !is_outside && !dpsm_classify_misses(a.uv, b.uv, c.uv, light, 0.0) {
            self.draw(root, corners, loose);
        }
    }

    fn draw(&mut self, root: Root, corners: [DpsmProjected<f32>; 3], loose: bool) {
        let Root { triangle, plane, farthest } = root;
        let [a, b, c] = corners;
        let distances = Vec3::new(a.distance, b.distance, c.distance);
        let hull = DpsmHull { a: a.uv, b: b.uv, c: c.uv };
        // chords of inner edges may leave the part, to where its plane is farther away or nearer
        let (nearest, farthest) = match loose {
            true => (0.0, farthest),
            false => {
                let own = distances.x.max(distances.y).max(distances.z);
                (nearest_of(corners.map(|corner| corner.p), plane), own)
            }
        };
        let is_flat = dpsm_refine_flat(hull, distances, plane, self.reach, self.depth_tolerance);
        let face = match is_flat && self.frame.mask(triangle).is_none() {
            true => None,
            false => Some(dpsm_triangle_face(plane, farthest)),
        };
        self.leaves.push(Leaf { corners, face, nearest, triangle });
    }

    fn split(&mut self, root: Root, corners: [DpsmProjected<f32>; 3], edges: Edges, level: u32) {
        let mut points = [corners[0]; 6];
        points[..3].copy_from_slice(&corners);
        for i in (0..3).filter(|i| edges.split >> i & 1 != 0) {
            points[3 + i] = dpsm_projected(dpsm_refine_point(corners[i].p, corners[(i + 1) % 3].p));
        }
        // of the four sides that two split edges leave, the shorter diagonal
        let crossed = edges.split.count_ones() == 2 && {
            // the corner between the split edges is the one that both have
            let between = match edges.split {
                3 => 1,
                6 => 2,
                _ => 0,
            };
            let [before, after] = [(between + 2) % 3, (between + 1) % 3];
            let straight = points[3 + between].uv - points[before].uv;
            let other = points[after].uv - points[3 + before].uv;
            other.dot(other) < straight.dot(straight)
        };
        let children = 0..=edges.split.count_ones();
        let part = |i| dpsm_refine_corners(edges.split, i, crossed).map(|corner| corner as usize);
        let of = |corners: [usize; 3]| corners.map(|corner| points[corner]);
        let fat = children.clone().all(|i| {
            let chosen = part(i);
            let half = |k: usize| {
                let edge = dpsm_refine_edge(chosen[k] as u32, chosen[(k + 1) % 3] as u32);
                u32::from((3..DPSM_REFINE_INNER).contains(&edge)) << k
            };
            let [a, b, c] = of(chosen);
            dpsm_refine_fat(a, b, c, half(0) | half(1) | half(2))
        });
        for i in children {
            let chosen = part(i);
            let [a, b, c] = of(chosen);
            if dpsm_refine_outside(a.uv, b.uv, c.uv, self.frame.light) {
                continue;
            }
            let mut own = Edges { split: 0, free: 0 };
            for k in 0..3 {
                let (a, b) = (chosen[k], chosen[(k + 1) % 3]);
                let edge = dpsm_refine_edge(a as u32, b as u32);
                let free = match edge {
                    DPSM_REFINE_INNER => fat,
                    _ => edges.free >> (edge % 3) & 1 != 0,
                };
                // one that was not split before is not asked again
                let is_split = edge >= 3
                    && (dpsm_refine_long(points[a].uv, points[b].uv)
                        || !free && dpsm_refine_splits(points[a], points[b], self.reach));
                own.split |= u32::from(is_split) << k;
                own.free |= u32::from(free) << k;
            }
            match own.split == 0 || level >= self.levels {
                true => self.leaf(root, of(chosen), own.free != 0),
                false => self.split(root, of(chosen), own, level + 1),
            }
        }
    }
}
