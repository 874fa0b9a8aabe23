//! The two shapes that the built-in scenes are made of: grids of quads and solids of revolution.

use std::collections::HashMap;
use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use super::Mesh;

/// The outward faces over a base (counter-clockwise seen from above): top, bottom, sides.
pub(super) fn prism(base: [Vec3; 4], height: f32) -> [[Vec3; 4]; 6] {
    let [a, b, c, d] = base;
    let [ta, tb, tc, td] = base.map(|corner| corner + Vec3::Y * height);
    [[ta, tb, tc, td], [d, c, b, a], [a, b, tb, ta], [b, c, tc, tb], [c, d, td, tc], [d, a, ta, td]]
}

/// The outward faces of an upright box: top, bottom, -x, +z, +x, -z.
pub(super) fn faces(min: Vec3, max: Vec3) -> [[Vec3; 4]; 6] {
    let base = [(min.x, min.z), (min.x, max.z), (max.x, max.z), (max.x, min.z)];
    prism(base.map(|(x, z)| vec3(x, min.y, z)), max.y - min.y)
}

/// A box on the plane y = 0, turned about the y axis by `angle` radians.
pub(super) fn cuboid(name: &str, albedo: Vec3, size: Vec3, angle: f32) -> Mesh {
    let corner = |x: f32, z: f32| vec3(x * size.x / 2.0, 0.0, z * size.z / 2.0);
    let base = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    quads(name, albedo, &prism(base, size.y), 1).placed(Quat::from_rotation_y(angle), Vec3::ZERO)
}

/// Flat quads, corners counter-clockwise, each cut into `cells` x `cells`.
pub(super) fn quads(name: &str, albedo: Vec3, quads: &[[Vec3; 4]], cells: u32) -> Mesh {
    // Neighbouring quads run along a shared edge in opposite directions and must still get equal
    // vertices: the sum is symmetric in the ends, and the ends are exact.
    let between = |a: Vec3, b: Vec3, i: u32| match i {
        0 => a,
        i if i == cells => b,
        i => (a * (cells - i) as f32 + b * i as f32) / cells as f32,
    };
    let mut mesh = Mesh::named(name, albedo);
    for &[a, b, c, d] in quads {
        let first = mesh.positions.len() as u32;
        let normal = (c - a).cross(d - b).normalize();
        for row in 0..=cells {
            let (from, to) = (between(a, d, row), between(b, c, row));
            mesh.positions.extend((0..=cells).map(|i| between(from, to, i)));
        }
        mesh.normals.resize(mesh.positions.len(), normal);
        for row in 0..cells {
            for column in 0..cells {
                let i = first + row * (cells + 1) + column;
                let above = i + cells + 1;
                mesh.triangles.extend([[i, i + 1, above + 1], [i, above + 1, above]]);
            }
        }
    }
    mesh
}

/// A point (radius, height) and its normal.
pub(super) type ProfilePoint = (Vec2, Vec2);

/// A ball around the origin, its profile in `parts` chords from pole to pole.
pub(super) fn ball(radius: f32, parts: u32) -> Vec<ProfilePoint> {
    (0..=parts)
        .map(|i| match i {
            // Exactly on the axis, where rounding would leave a hole.
            0 => Vec2::NEG_Y,
            i if i == parts => Vec2::Y,
            i => Vec2::from_angle(PI * i as f32 / parts as f32 - FRAC_PI_2),
        })
        .map(|normal| (radius * normal, normal))
        .collect()
}

/// A ring around the origin, its tube's section in `parts` chords.
pub(super) fn ring(radius: f32, tube: f32, parts: u32) -> Vec<ProfilePoint> {
    (0..=parts)
        .map(|i| Vec2::from_angle(TAU * (i % parts) as f32 / parts as f32))
        .map(|normal| (vec2(radius, 0.0) + tube * normal, normal))
        .collect()
}

/// A capped cylinder on the plane y = 0; each hard edge has a point for either side's normal.
pub(super) fn rod(radius: f32, height: f32) -> Vec<ProfilePoint> {
    let (bottom, top) = (vec2(radius, 0.0), vec2(radius, height));
    vec![
        (Vec2::ZERO, Vec2::NEG_Y),
        (bottom, Vec2::NEG_Y),
        (bottom, Vec2::X),
        (top, Vec2::X),
        (top, Vec2::Y),
        (vec2(0.0, height), Vec2::Y),
    ]
}

/// Turns a profile, which has the solid on its left, around the y axis.
pub(super) fn revolve(name: &str, albedo: Vec3, segments: u32, profile: &[ProfilePoint]) -> Mesh {
    let mut mesh = Mesh::named(name, albedo);
    let turned = |v: Vec2, j: u32| {
        let around = Vec2::from_angle(TAU * j as f32 / segments as f32);
        vec3(v.x * around.x, v.y, v.x * around.y)
    };
    for &(point, normal) in profile {
        mesh.positions.extend((0..segments).map(|j| turned(point, j)));
        mesh.normals.extend((0..segments).map(|j| turned(normal, j).normalize()));
    }
    for (i, pair) in (0u32..).zip(profile.windows(2)) {
        let [low, high] = [pair[0].0, pair[1].0];
        for j in 0..segments {
            let [a, b] = [j, (j + 1) % segments].map(|j| i * segments + j);
            let [d, c] = [a, b].map(|below| below + segments);
            // On the axis and between the two sides of a hard edge triangles have no area.
            if low != high && high.x > 0.0 {
                mesh.triangles.push([a, d, c]);
            }
            if low != high && low.x > 0.0 {
                mesh.triangles.push([a, c, b]);
            }
        }
    }
    mesh
}

impl Mesh {
    fn named(name: &str, albedo: Vec3) -> Self {
        Self { name: name.into(), albedo, ..Self::default() }
    }

    /// Several meshes as one.
    pub(super) fn joined(name: &str, albedo: Vec3, parts: impl IntoIterator<Item = Self>) -> Self {
        let mut whole = Self::named(name, albedo);
        for part in parts {
            let first = whole.positions.len() as u32;
            whole.triangles.extend(part.triangles.iter().map(|t| t.map(|i| first + i)));
            whole.positions.extend(part.positions);
            whole.normals.extend(part.normals);
        }
        whole
    }

    /// With the normals of a smooth surface: at each position the mean of the triangles around it,
    /// weighted by area, whether they share the vertex or not.
    pub(super) fn smoothed(mut self) -> Self {
        // adding 0 makes -0 a 0
        let key = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
        let mut sums: HashMap<[u32; 3], Vec3> = HashMap::with_capacity(self.positions.len());
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|i| self.positions[i as usize]);
            for corner in [a, b, c] {
                *sums.entry(key(corner)).or_default() += (b - a).cross(c - a);
            }
        }
        for (normal, position) in self.normals.iter_mut().zip(&self.positions) {
            let sum = sums.get(&key(*position)).copied().unwrap_or_default();
            *normal = sum.try_normalize().unwrap_or(*normal);
        }
        self
    }

    /// Rotates, then moves.
    pub(super) fn placed(mut self, rotation: Quat, to: Vec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p = rotation * *p + to);
        self.normals.iter_mut().for_each(|n| *n = rotation * *n);
        self
    }
}
