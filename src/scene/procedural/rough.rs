//! Rough surfaces whose triangles are smaller than a map's texels.

use std::f32::consts::FRAC_PI_4;

use glam::{Quat, Vec3, vec3};

use super::room::{GREEN, WHITE};
use crate::scene::shapes::{faces, quads};
use crate::scene::{Camera, Light, Mesh};

/// Octaves of the relief; each is half as high and half as long as the one before.
const OCTAVES: u32 = 6;

/// Side of the hills and of the boulder's ground in metres.
const SIDE: f32 = 4.0;

/// Cells along a side of the hills.
const HILL_CELLS: u32 = 320;

/// Height and length of the widest hills in metres.
const HILL: [f32; 2] = [0.4, 1.0];

/// Cells along an edge of the cube that becomes the boulder.
const BOULDER_CELLS: u32 = 82;

/// The boulder's mean radius and the height of its middle in metres: its foot is in the ground.
const BOULDER: [f32; 2] = [0.8, 0.7];

/// Relief of the boulder as a share of its radius, and the length of its widest bumps in radii.
const BUMPS: [f32; 2] = [0.2, 0.7];

/// A height field.
pub(super) fn hills() -> Vec<Mesh> {
    let half = SIDE / 2.0;
    let corner = |x: f32, z: f32| vec3(x * half, 0.0, z * half);
    let square = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    let mut mesh = quads("hills", GREEN, &[square], HILL_CELLS);
    let [height, length] = HILL;
    for p in &mut mesh.positions {
        p.y = height * relief(*p / length);
    }
    vec![mesh.smoothed()]
}

/// Beside the hills, so that they shadow each other.
pub(super) fn hills_light() -> Light {
    Light { position: vec3(-2.6, 2.4, 1.0), axis: None, color: Vec3::ONE, cone: None, range: None }
}

/// Looks over the hills with the light on its left.
pub(super) fn hills_camera() -> Camera {
    Camera {
        eye: vec3(0.9, 1.7, 2.7),
        target: vec3(-0.1, -0.35, 0.1),
        up: Vec3::Y,
        vertical_fov: 50f32.to_radians(),
    }
}

/// A closed boulder whose foot is in the ground, which it touches without a vertex in common.
pub(super) fn boulder(walls: u32) -> Vec<Mesh> {
    let half = vec3(SIDE / 2.0, 0.0, SIDE / 2.0);
    let [top, ..] = faces(-half, half);
    let mut mesh = quads("boulder", WHITE, &faces(Vec3::NEG_ONE, Vec3::ONE), BOULDER_CELLS);
    let [radius, middle] = BOULDER;
    let [height, length] = BUMPS;
    for p in &mut mesh.positions {
        // evener cells than those of the plain cube
        let direction = p.map(|c| (c * FRAC_PI_4).tan()).normalize();
        *p = direction * radius * (1.0 + height * relief(direction / length)) + middle * Vec3::Y;
    }
    vec![quads("ground", vec3(0.55, 0.45, 0.35), &[top], walls), mesh.smoothed()]
}

/// As far from the boulder as the scene is wide, diagonally above.
pub(super) fn boulder_light() -> Light {
    let position = BOULDER[1] * Vec3::Y + SIDE * Vec3::ONE.normalize();
    Light { position, axis: None, color: Vec3::ONE, cone: None, range: None }
}

/// Shows the lit side, the dark side and the shadow on the ground.
pub(super) fn boulder_camera() -> Camera {
    Camera {
        eye: vec3(2.7, 1.8, -1.3),
        target: vec3(-0.3, 0.4, -0.3),
        up: Vec3::Y,
        vertical_fov: 50f32.to_radians(),
    }
}

/// Octaves of smooth noise about 0, each turned against the one before, so that no direction shows.
fn relief(p: Vec3) -> f32 {
    let turn = Quat::from_axis_angle(vec3(0.48, 0.6, 0.64), 1.1);
    let mut at = p + vec3(0.37, 0.71, 0.19);
    let (mut sum, mut height) = (0.0, 1.0);
    for octave in 0..OCTAVES {
        sum += height * noise(at, octave);
        height *= 0.5;
        at = turn * (at * 2.0);
    }
    sum
}

/// Random values in [-1, 1] at the corners of a grid of cells of side 1, and between them a smooth
/// interpolation.
fn noise(p: Vec3, seed: u32) -> f32 {
    let cell = p.floor();
    let at = p - cell;
    let weight = at * at * at * (at * (at * 6.0 - 15.0) + 10.0);
    let corner = |i: u32| {
        let bits = [i & 1, i >> 1 & 1, i >> 2 & 1];
        let value = random((cell + Vec3::from(bits.map(|bit| bit as f32))).to_array(), seed);
        let share = |k: usize| if bits[k] == 1 { weight[k] } else { 1.0 - weight[k] };
        value * share(0) * share(1) * share(2)
    };
    (0..8).map(corner).sum()
}

/// A value in [-1, 1] of whole coordinates: their bits, mixed by multiplications and shifts.
fn random(cell: [f32; 3], seed: u32) -> f32 {
    let mix = |bits: u32, c: f32| {
        let mixed = (bits ^ c as i32 as u32).wrapping_mul(0x9E37_79B1);
        (mixed ^ mixed >> 15).wrapping_mul(0x85EB_CA6B)
    };
    let bits = cell.into_iter().fold(seed.wrapping_add(1).wrapping_mul(0x9E37_79B1), mix);
    // 24 bits, which f32 holds exactly
    ((bits ^ bits >> 16) >> 8) as f32 / (1 << 23) as f32 - 1.0
}
