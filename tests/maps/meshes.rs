//! Closed meshes around the origin: their directions cut the sphere into triangles, so that every
//! direction meets one, whatever the radii.

use std::collections::{HashMap, VecDeque};

use dpsm::scene::Mesh;
use fastrand::Rng;
use glam::{DVec3, dvec3};

use crate::support::mesh;

/// A cut of the sphere: unit vectors and triangles.
pub struct Shell {
    directions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Shell {
    /// The icosahedron.
    pub fn icosahedron() -> Self {
        let t = (1.0 + 5f64.sqrt()) / 2.0;
        let directions = [
            (-1.0, t, 0.0),
            (1.0, t, 0.0),
            (-1.0, -t, 0.0),
            (1.0, -t, 0.0),
            (0.0, -1.0, t),
            (0.0, 1.0, t),
            (0.0, -1.0, -t),
            (0.0, 1.0, -t),
            (t, 0.0, -1.0),
            (t, 0.0, 1.0),
            (-t, 0.0, -1.0),
            (-t, 0.0, 1.0),
        ]
        .map(|(x, y, z)| dvec3(x, y, z).normalize())
        .to_vec();
        let triangles = vec![
            [0, 11, 5],
            [0, 5, 1],
            [0, 1, 7],
            [0, 7, 10],
            [0, 10, 11],
            [1, 5, 9],
            [5, 11, 4],
            [11, 10, 2],
            [10, 7, 6],
            [7, 1, 8],
            [3, 9, 4],
            [3, 4, 2],
            [3, 2, 6],
            [3, 6, 8],
            [3, 8, 9],
            [4, 9, 5],
            [2, 4, 11],
            [6, 2, 10],
            [8, 6, 7],
            [9, 8, 1],
        ];
        Self { directions, triangles }
    }

    /// Cuts every triangle into four.
    pub fn cut(&mut self) {
        let mut middles = HashMap::new();
        let directions = &mut self.directions;
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum = directions[a as usize] + directions[b as usize];
                directions.push(sum.normalize());
                directions.len() as u32 - 1
            })
        };
        let cut = |&[a, b, c]: &[u32; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        self.triangles = self.triangles.iter().flat_map(cut).collect();
    }

    /// Cuts a triangle into three at a random point inside; the first takes its place.
    pub fn split(&mut self, triangle: usize, rng: &mut Rng) {
        let [a, b, c] = self.triangles[triangle];
        let mut weight = || 0.2 + rng.f64();
        let sum = self.directions[a as usize] * weight()
            + self.directions[b as usize] * weight()
            + self.directions[c as usize] * weight();
        let d = self.directions.len() as u32;
        self.directions.push(sum.normalize());
        self.triangles[triangle] = [a, b, d];
        self.triangles.extend([[b, c, d], [c, a, d]]);
    }

    /// Splits random triangles until there are so many, those that came of a split more often, so
    /// that sizes vary; none whose longest edge is below `finest` radians.
    pub fn split_up_to(&mut self, count: usize, finest: f64, rng: &mut Rng) {
        while self.triangles.len() < count {
            let len = self.triangles.len();
            let triangle = match rng.bool() {
                true => rng.usize(0..len),
                false => len - 1 - rng.usize(0..len.min(2048)),
            };
            if self.longest(triangle) >= finest {
                self.split(triangle, rng);
            }
        }
    }

    /// Splits a triangle and what comes of it, the largest first, until there are `count` more.
    pub fn patch(&mut self, patch: usize, count: usize, rng: &mut Rng) {
        let mut queue = VecDeque::from([patch]);
        let end = self.triangles.len() + count;
        while self.triangles.len() < end {
            let Some(triangle) = queue.pop_front() else { return };
            let len = self.triangles.len();
            self.split(triangle, rng);
            queue.extend([triangle, len, len + 1]);
        }
    }

    fn longest(&self, triangle: usize) -> f64 {
        let [a, b, c] = self.triangles[triangle].map(|i| self.directions[i as usize]);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    /// Triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// The largest angle that a triangle spans over the smallest.
    pub fn spread(&self) -> f64 {
        let sizes = || (0..self.len()).map(|triangle| self.longest(triangle));
        sizes().fold(0.0, f64::max) / sizes().fold(f64::INFINITY, f64::min)
    }

    /// The mesh with each vertex at its own distance.
    pub fn mesh(&self, mut distance: impl FnMut(DVec3) -> f64) -> Mesh {
        let positions = self.directions.iter().map(|&d| (d * distance(d)).as_vec3()).collect();
        mesh(positions, self.triangles.clone())
    }
}
