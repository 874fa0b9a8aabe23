//! The room of most built-in scenes, and what stands in it.

use glam::{Quat, Vec3, vec3};

use crate::scene::shapes::{ball, cuboid, faces, quads, revolve, ring, rod};
use crate::scene::{Camera, Mesh};

// A cube: with 8 x 8 quads a wall's quad nearest to the light is a quarter as wide as it is far.
pub(super) const MIN: Vec3 = vec3(-2.0, 0.0, -2.0);
pub(super) const MAX: Vec3 = vec3(2.0, 4.0, 2.0);

pub(super) const RED: Vec3 = vec3(0.7, 0.2, 0.15);
pub(super) const GREEN: Vec3 = vec3(0.25, 0.6, 0.3);
pub(super) const BLUE: Vec3 = vec3(0.2, 0.35, 0.7);
pub(super) const YELLOW: Vec3 = vec3(0.75, 0.65, 0.2);
pub(super) const WHITE: Vec3 = vec3(0.75, 0.75, 0.75);

/// In the +x +z corner: shows the floor, the -x and -z walls and the objects before them.
pub(super) fn camera() -> Camera {
    Camera {
        eye: vec3(1.9, 3.0, 1.9),
        target: vec3(-0.4, 1.5, -0.5),
        up: Vec3::Y,
        vertical_fov: 82f32.to_radians(),
    }
}

/// A closed room, its inside visible.
pub(super) fn shell(walls: u32) -> Vec<Mesh> {
    let plaster = vec3(0.75, 0.73, 0.68);
    let inside = [
        ("ceiling", vec3(0.8, 0.8, 0.8)),
        ("floor", vec3(0.55, 0.45, 0.35)),
        ("wall -x", vec3(0.45, 0.55, 0.7)),
        ("wall +z", plaster),
        ("wall +x", plaster),
        ("wall -z", plaster),
    ];
    inside
        .into_iter()
        .zip(faces(MIN, MAX))
        .map(|((name, albedo), [a, b, c, d])| quads(name, albedo, &[[d, c, b, a]], walls))
        .collect()
}

/// The paper's: objects in all directions from the middle.
pub(super) fn solids(walls: u32) -> Vec<Mesh> {
    let mut meshes = shell(walls);
    let upright = Quat::IDENTITY;
    // Seen neither edge-on nor face-on, by camera and light alike.
    let tilted = Quat::from_rotation_arc(Vec3::Y, vec3(0.6, -0.3, 0.74).normalize());
    // Each solid in a fine and a coarse tessellation. Heights put the lowest point on the floor.
    meshes.extend([
        revolve("sphere, fine", RED, 64, &ball(0.45, 32)).placed(upright, vec3(-0.7, 0.45, -1.2)),
        revolve("sphere, coarse", YELLOW, 10, &ball(0.35, 6)).placed(upright, vec3(0.4, 0.35, 0.9)),
        revolve("column, fine", WHITE, 48, &rod(0.15, 4.0)).placed(upright, vec3(-1.7, 0.0, -1.6)),
        revolve("drum, coarse", GREEN, 8, &rod(0.35, 0.7)).placed(upright, vec3(1.4, 0.0, -0.1)),
        revolve("torus, fine, hanging", BLUE, 64, &ring(0.4, 0.13, 24))
            .placed(tilted, vec3(-0.9, 3.0, 0.4)),
        revolve("torus, coarse", YELLOW, 12, &ring(0.35, 0.12, 6))
            .placed(upright, vec3(-0.9, 0.12, 1.1)),
        revolve("sphere, coarse, hanging", GREEN, 8, &ball(0.25, 5))
            .placed(upright, vec3(0.7, 3.1, -0.9)),
        cuboid("box", BLUE, vec3(0.8, 0.8, 0.8), 0.5).placed(upright, vec3(0.7, 0.0, -1.3)),
        cuboid("box, tall", RED, vec3(0.45, 1.7, 0.45), 0.3).placed(upright, vec3(-1.5, 0.0, 0.4)),
    ]);
    meshes
}

/// A box that the plane between the light's hemispheres cuts, for a main axis along y, and one
/// that it does not.
pub(super) fn seam_box(walls: u32) -> Vec<Mesh> {
    let upright = Quat::IDENTITY;
    let mut meshes = shell(walls);
    meshes.extend([
        // the light is 2 m up: the box reaches as far below as above
        cuboid("box, across the seam", RED, Vec3::splat(0.8), 0.4)
            .placed(upright, vec3(-0.9, 1.6, -0.7)),
        cuboid("box, below", BLUE, Vec3::splat(0.8), 0.4).placed(upright, vec3(0.9, 0.0, -0.9)),
    ]);
    meshes
}

/// Of the bars from the light.
const CAGE: f32 = 0.3;

/// Thickness of a bar.
const BAR: f32 = 0.01;

/// Bars in a side of the cage.
const BARS: u32 = 4;

/// A cube of bars around the light, and what they cast their shadows on.
pub(super) fn cage(walls: u32) -> Vec<Mesh> {
    let middle = (MIN + MAX) / 2.0;
    let mut bars = Vec::new();
    // An axis' bars lie twice their thickness outside those of the one before: none touch.
    for (axis, half) in [CAGE, CAGE + 2.0 * BAR, CAGE + 4.0 * BAR].into_iter().enumerate() {
        let at = |i: u32| half * (2.0 * i as f32 / (BARS - 1) as f32 - 1.0);
        let outside = |i: u32| i == 0 || i == BARS - 1;
        for (i, j) in (0..BARS * BARS).map(|k| (k % BARS, k / BARS)) {
            if outside(i) || outside(j) {
                let mut from = Vec3::ZERO;
                from[(axis + 1) % 3] = at(i) - BAR / 2.0;
                from[(axis + 2) % 3] = at(j) - BAR / 2.0;
                let mut to = from + BAR;
                (from[axis], to[axis]) = (-CAGE, CAGE);
                bars.push(quads("bar", WHITE, &faces(middle + from, middle + to), 1));
            }
        }
    }
    let mut meshes = shell(walls);
    meshes.extend([
        Mesh::joined("cage", WHITE, bars),
        revolve("sphere", RED, 32, &ball(0.45, 16)).placed(Quat::IDENTITY, vec3(-0.7, 0.45, -1.2)),
        cuboid("box", BLUE, vec3(0.8, 0.8, 0.8), 0.5).placed(Quat::IDENTITY, vec3(0.7, 0.0, -1.3)),
    ]);
    meshes
}
