//! What biases find hard: surfaces seen edge-on, thin gaps, contact, and edges along the seam.

use glam::{Quat, Vec3, vec3};

use super::room::{BLUE, GREEN, MAX, MIN, RED, WHITE, YELLOW, shell};
use crate::scene::Mesh;
use crate::scene::shapes::{ball, cuboid, revolve};

/// How far the light is from the planes of the grazed faces.
const GRAZING: f32 = 0.01;

/// A table just below the light and a screen just beside it, both seen at up to 89.7 degrees, with
/// what shadows them, and a ball.
pub(super) fn grazing(walls: u32) -> Vec<Mesh> {
    let light = (MIN + MAX) / 2.0;
    let mut meshes = shell(walls);
    let upright = Quat::IDENTITY;
    let table = light.y - GRAZING;
    meshes.extend([
        // from 0.45 m to 1.85 m from the light
        cuboid("table", YELLOW, vec3(1.4, 0.05, 2.4), 0.0)
            .placed(upright, vec3(-1.15, table - 0.05, -0.3)),
        cuboid("post on the table", RED, vec3(0.1, 0.3, 0.1), 0.3)
            .placed(upright, vec3(-0.9, table, -0.3)),
        cuboid("screen", GREEN, vec3(0.05, 2.4, 1.4), 0.0)
            .placed(upright, vec3(GRAZING + 0.025, 0.3, -1.15)),
        cuboid("knob of the screen", BLUE, vec3(0.1, 0.1, 0.1), 0.0)
            .placed(upright, vec3(GRAZING - 0.05, 1.2, -0.7)),
        revolve("sphere", WHITE, 48, &ball(0.4, 24)).placed(upright, vec3(1.0, 0.4, -0.8)),
    ]);
    meshes
}

/// Boards that hover over the floor, from a millimetre to a decimetre, and one high up.
pub(super) fn gaps(walls: u32) -> Vec<Mesh> {
    let mut meshes = shell(walls);
    let boards = [
        ("board 1 mm up", 0.001, vec3(-1.3, 0.0, -1.3)),
        ("board 3 mm up", 0.003, vec3(-0.3, 0.0, -1.3)),
        ("board 1 cm up", 0.01, vec3(0.9, 0.0, -1.3)),
        ("board 3 cm up", 0.03, vec3(-1.3, 0.0, 0.2)),
        ("board 10 cm up", 0.1, vec3(-0.9, 0.0, 1.2)),
        ("board 80 cm up", 0.8, vec3(0.2, 0.0, -0.4)),
    ];
    meshes.extend(boards.into_iter().map(|(name, up, at)| {
        cuboid(name, YELLOW, vec3(0.7, 0.01, 0.7), 0.3).placed(Quat::IDENTITY, at.with_y(up))
    }));
    meshes
}

/// Boxes that touch the floor, from a step of 1 cm to a pillar.
pub(super) fn contact(walls: u32) -> Vec<Mesh> {
    let mut meshes = shell(walls);
    let boxes = [
        ("step", vec3(0.8, 0.01, 0.8), vec3(-0.2, 0.0, -0.2)),
        ("low box", vec3(0.6, 0.05, 0.6), vec3(-1.3, 0.0, -1.1)),
        ("box", vec3(0.5, 0.5, 0.5), vec3(0.5, 0.0, -1.3)),
        ("small box", vec3(0.1, 0.1, 0.1), vec3(-0.5, 0.0, -1.4)),
        ("pillar", vec3(0.2, 2.5, 0.2), vec3(-1.5, 0.0, 0.4)),
    ];
    meshes.extend(
        boxes
            .into_iter()
            .map(|(name, size, at)| cuboid(name, RED, size, 0.3).placed(Quat::IDENTITY, at)),
    );
    meshes
}

/// Boxes with edges in the plane between the hemispheres, for a main axis along y: a top, and a
/// bottom, each seen edge-on, and a top a millimetre above the plane.
pub(super) fn seam_edge(walls: u32) -> Vec<Mesh> {
    let seam = (MIN.y + MAX.y) / 2.0;
    let mut meshes = shell(walls);
    let boxes = [
        ("box up to the seam", seam - 0.8, 0.8, vec3(-1.0, 0.0, -0.4)),
        ("box down to the seam", seam, 0.8, vec3(-0.3, 0.0, -1.2)),
        ("box over the seam by 1 mm", 0.0, seam + 0.001, vec3(0.7, 0.0, -1.1)),
    ];
    meshes.extend(boxes.into_iter().map(|(name, from, height, at): (_, f32, f32, Vec3)| {
        let size = vec3(0.5, height, 0.5);
        cuboid(name, BLUE, size, 0.4).placed(Quat::IDENTITY, at.with_y(from))
    }));
    meshes
}
