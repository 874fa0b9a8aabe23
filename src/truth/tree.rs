//! A tree of boxes over triangles.
//!
//! The crate obvhs chooses the tree, in f32. Its boxes are not used: ours are the exact bounds of
//! the f64 corners.

use glam::DVec3;
use obvhs::aabb::Aabb;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::Ray;
use super::sheared::Sheared;

#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// The root first; children after their parent.
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: [DVec3; 2],
    content: Content,
}

#[derive(Clone, Copy, Debug)]
enum Content {
    Triangle(u32),
    /// The first of two neighbouring nodes.
    Children(u32),
}

impl Tree {
    /// Over triangles and their corners, all finite.
    pub(super) fn new(triangles: &[(u32, [DVec3; 3])]) -> Self {
        let boxes: Vec<_> = triangles.iter().map(|(_, corners)| bounds(*corners)).collect();
        let Some(scene) = boxes.iter().copied().reduce(union) else {
            return Self { nodes: Vec::new() };
        };
        // In units of the scene, so that f32 can hold them.
        let size = (scene[1] - scene[0]).max_element().max(f64::MIN_POSITIVE);
        let rough = |p: DVec3| ((p - scene[0]) / size).as_vec3a();
        let rough: Vec<_> = boxes.iter().map(|b| Aabb::new(rough(b[0]), rough(b[1]))).collect();
        let chosen = PlocBuilder::new().build(
            PlocSearchDistance::Medium,
            &rough,
            (0..rough.len() as u32).collect(),
            SortPrecision::U64,
            0,
        );
        let blank = Node { bounds: scene, content: Content::Triangle(0) };
        let mut nodes = vec![blank; chosen.nodes.len()];
        for (i, node) in chosen.nodes.iter().enumerate().rev() {
            let first = node.first_index as usize;
            nodes[i] = if node.is_leaf() {
                Node { bounds: boxes[first], content: Content::Triangle(triangles[first].0) }
            } else {
                assert!(first > i, "a child's bounds are made before its parent's");
                let bounds = union(nodes[first].bounds, nodes[first + 1].bounds);
                Node { bounds, content: Content::Children(node.first_index) }
            };
        }
        Self { nodes }
    }

    /// Calls `test` with every triangle that the ray may meet, near ones first; it returns the
    /// distance beyond which no more are wanted.
    pub(super) fn visit(&self, sheared: &Sheared, ray: &Ray, mut test: impl FnMut(u32) -> f64) {
        let Some(root) = self.nodes.first() else { return };
        let padding = sheared.padding(root.bounds[0], root.bounds[1]);
        let mut range = sheared.depths(ray.near, ray.far);
        let enter = |node: u32, range| {
            let entry = sheared.enter(self.nodes[node as usize].bounds, padding, range)?;
            Some((entry, node))
        };
        let mut open = Vec::with_capacity(64);
        open.extend(enter(0, range));
        while let Some((entry, node)) = open.pop() {
            if entry > range[1] {
                continue;
            }
            match self.nodes[node as usize].content {
                Content::Triangle(triangle) => {
                    range = sheared.depths(ray.near, test(triangle));
                }
                Content::Children(first) => {
                    let [near, far] = [first, first + 1].map(|child| enter(child, range));
                    let swap = matches!((near, far), (Some(a), Some(b)) if b.0 < a.0);
                    let (near, far) = if swap { (far, near) } else { (near, far) };
                    open.extend(far);
                    open.extend(near);
                }
            }
        }
    }
}

fn bounds([a, b, c]: [DVec3; 3]) -> [DVec3; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

fn union(a: [DVec3; 2], b: [DVec3; 2]) -> [DVec3; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}
