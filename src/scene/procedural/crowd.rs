//! Many small casters, spread evenly, in a room of large ones.

use glam::{Quat, Vec3, vec3};

use super::room::{GREEN, MAX, MIN, RED, camera, shell};
use super::scene;
use crate::scene::shapes::{ball, faces, quads, revolve};
use crate::scene::{Mesh, Scene};

/// Triangles of the built-in scene.
pub(super) const BUILT_IN: usize = 40_000;

/// Segments and profile chords of a sphere.
const SPHERE: (u32, u32) = (16, 8);

/// Its triangles: two for each quad, one for each at a pole.
const SPHERE_TRIANGLES: usize = (SPHERE.0 * (2 * SPHERE.1 - 2)) as usize;

/// Cells along a box's edge, the usual ones first; the others make the count right.
const BOXES: [u32; 3] = [4, 2, 1];

/// Triangles of a box: two for each cell of its faces.
const fn box_triangles(cells: u32) -> usize {
    (6 * 2 * cells * cells) as usize
}

/// Half an object's size, in units of its cell: less than half of 1 / sqrt(3), so that a box stays
/// in its cell whichever way it is turned.
const HALF_SIZE: f32 = 0.28;

/// Free space around the light and before the camera in metres.
const FREE: [f32; 2] = [0.5, 1.0];

#[derive(Clone, Copy)]
enum Object {
    Sphere,
    Box(u32),
}

/// A closed room of two triangles a wall and as many spheres and boxes as make up the wanted
/// number of triangles, spread evenly; an omnidirectional light in the middle. The number is met
/// within a box's 12 triangles, from 1,000 to 2,000,000 (fewer and more are taken for these).
pub fn crowd(triangles: usize) -> Scene {
    let light = (MIN + MAX) / 2.0;
    scene("crowd", meshes(triangles.clamp(1_000, 2_000_000), 1), light, None, camera())
}

/// A closed room of two triangles a wall and twelve solids in it, eight spheres and four boxes, all
/// as finely cut as makes up the wanted number of triangles, within a few percent from 1,000 to
/// 2,000,000; an omnidirectional light in the middle.
pub fn dozen(triangles: usize) -> Scene {
    let each = (triangles.clamp(1_000, 2_000_000) - box_triangles(1)) / 12;
    // a sphere of n chords and 2 n segments has 4 n (n - 1) triangles, a box 12 n^2
    let chords = (0.5 + (0.25 + each as f64 / 4.0).sqrt()).round() as u32;
    let cells = (each as f64 / 12.0).sqrt().round() as u32;
    let (mut spheres, mut boxes) = (Vec::new(), Vec::new());
    let radius = 0.3;
    for i in 0..12u32 {
        // four at each of three heights, every level turned, two thirds of the way to the walls
        let angle = 0.4 + std::f32::consts::FRAC_PI_2 * (i % 4) as f32 + 0.6 * (i / 4) as f32;
        let middle = (MIN + MAX) / 2.0;
        let height = (MAX.y - MIN.y) * 0.3 * ((i / 4) as f32 - 1.0);
        let place = middle + vec3(1.3 * angle.cos(), height, 1.3 * angle.sin());
        let turn = Quat::from_rotation_y(i as f32) * Quat::from_rotation_x(0.7 * i as f32);
        if i % 3 == 2 {
            let half = Vec3::splat(radius * 0.7);
            boxes.push(quads("box", GREEN, &faces(-half, half), cells).placed(turn, place));
        } else {
            let profile = ball(radius, chords);
            spheres.push(revolve("sphere", RED, 2 * chords, &profile).placed(turn, place));
        }
    }
    let mut meshes = shell(1);
    meshes.extend([Mesh::joined("spheres", RED, spheres), Mesh::joined("boxes", GREEN, boxes)]);
    scene("dozen", meshes, (MIN + MAX) / 2.0, None, camera())
}

/// Meshes of so many triangles; cutting the walls finer comes on top.
pub(super) fn meshes(triangles: usize, walls: u32) -> Vec<Mesh> {
    let objects = objects(triangles - box_triangles(1));
    let (mut spheres, mut boxes) = (Vec::new(), Vec::new());
    let (cell, places) = places(objects.len());
    let half = HALF_SIZE * cell;
    for (i, (object, place)) in objects.iter().zip(places).enumerate() {
        // All different, and none edge-on to the light for long.
        let turn = Quat::from_rotation_y(i as f32) * Quat::from_rotation_x(0.7 * i as f32);
        match object {
            Object::Sphere => {
                let profile = ball(half, SPHERE.1);
                spheres.push(revolve("sphere", RED, SPHERE.0, &profile).placed(turn, place));
            }
            Object::Box(cells) => {
                let faces = faces(Vec3::splat(-half), Vec3::splat(half));
                boxes.push(quads("box", GREEN, &faces, *cells).placed(turn, place));
            }
        }
    }
    let mut meshes = shell(walls);
    meshes.extend([Mesh::joined("spheres", RED, spheres), Mesh::joined("boxes", GREEN, boxes)]);
    meshes
}

/// Spheres and boxes in turn, then smaller boxes as long as one fits.
fn objects(triangles: usize) -> Vec<Object> {
    let mut objects = Vec::new();
    let mut left = triangles;
    while left >= SPHERE_TRIANGLES {
        let (object, count) = match objects.len() % 2 {
            0 => (Object::Sphere, SPHERE_TRIANGLES),
            _ => (Object::Box(BOXES[0]), box_triangles(BOXES[0])),
        };
        objects.push(object);
        left -= count;
    }
    for cells in BOXES {
        while left >= box_triangles(cells) {
            objects.push(Object::Box(cells));
            left -= box_triangles(cells);
        }
    }
    objects
}

/// The side of a cell of the coarsest grid with room for all, and the middles of as many cells.
fn places(objects: usize) -> (f32, Vec<Vec3>) {
    let size = MAX - MIN;
    let mut side = 2;
    loop {
        let cell = size.min_element() / side as f32;
        let middle = |i: u32| {
            let index = [i % side, i / side % side, i / side / side].map(|k| k as f32);
            MIN + cell * (Vec3::from(index) + 0.5)
        };
        // A cube's corner is sqrt(3) half sizes from its middle.
        let reach = 3f32.sqrt() * HALF_SIZE * cell;
        let ends = [(MIN + MAX) / 2.0, camera().eye].into_iter().zip(FREE);
        let is_free =
            |place: &Vec3| ends.clone().all(|(end, free)| place.distance(end) >= free + reach);
        let free: Vec<Vec3> = (0..side.pow(3)).map(middle).filter(is_free).collect();
        if free.len() >= objects {
            let spread = (0..objects).map(|i| free[i * free.len() / objects]).collect();
            return (cell, spread);
        }
        side += 1;
    }
}
