//! The built-in scenes.

use glam::{Quat, Vec3, vec3};

use super::shapes::{ball, cuboid, prism, quads, revolve, ring, rod};
use super::{Camera, Light, Mesh, Options, Scene, SceneError};

/// Name and one line about each scene that [`open`](super::open) builds.
pub const BUILT_IN: [(&str, &str); 3] = [
    (
        "brabec-room",
        "closed room with solids, omnidirectional light in its middle (Brabec 2002, figure 3)",
    ),
    (
        "brabec-ceiling",
        "the same room, hemispherical light under the ceiling (Brabec 2002, figure 4)",
    ),
    ("cornell", "the Cornell box, omnidirectional light under its ceiling"),
];

/// `name` is one of [`BUILT_IN`].
pub(super) fn build(name: &str, walls: u32) -> Result<Scene, SceneError> {
    if !(1..=Options::MAX_WALLS).contains(&walls) {
        return Err(SceneError::Walls { walls });
    }
    let (meshes, position, axis, camera) = match name {
        "cornell" => (cornell(walls), CORNELL_LIGHT, None, cornell_camera()),
        "brabec-ceiling" => {
            let under_ceiling = vec3(0.0, ROOM_MAX.y - 0.1, 0.0);
            (room(walls), under_ceiling, Some(Vec3::NEG_Y), room_camera())
        }
        _ => {
            let middle = (ROOM_MIN + ROOM_MAX) / 2.0;
            (room(walls), middle, None, room_camera())
        }
    };
    Ok(Scene {
        name: name.into(),
        meshes,
        lights: vec![Light { position, axis, color: Vec3::ONE }],
        camera: Some(camera),
        warnings: Vec::new(),
    })
}

// A cube: with 8 x 8 quads a wall's quad nearest to the light is a quarter as wide as it is far.
const ROOM_MIN: Vec3 = vec3(-2.0, 0.0, -2.0);
const ROOM_MAX: Vec3 = vec3(2.0, 4.0, 2.0);

/// In the +x +z corner: shows the floor, the -x and -z walls and the objects before them.
fn room_camera() -> Camera {
    Camera {
        eye: vec3(1.9, 3.0, 1.9),
        target: vec3(-0.4, 1.5, -0.5),
        up: Vec3::Y,
        vertical_fov: 82f32.to_radians(),
    }
}

/// A closed room, its inside visible, with objects in all directions from its middle.
fn room(walls: u32) -> Vec<Mesh> {
    let (min, max) = (ROOM_MIN, ROOM_MAX);
    let base = [(min.x, min.z), (min.x, max.z), (max.x, max.z), (max.x, min.z)];
    let faces = prism(base.map(|(x, z)| vec3(x, min.y, z)), max.y - min.y);
    let plaster = vec3(0.75, 0.73, 0.68);
    let inside = [
        ("ceiling", vec3(0.8, 0.8, 0.8)),
        ("floor", vec3(0.55, 0.45, 0.35)),
        ("wall -x", vec3(0.45, 0.55, 0.7)),
        ("wall +z", plaster),
        ("wall +x", plaster),
        ("wall -z", plaster),
    ];
    let mut meshes: Vec<Mesh> = inside
        .into_iter()
        .zip(faces)
        .map(|((name, albedo), [a, b, c, d])| quads(name, albedo, &[[d, c, b, a]], walls))
        .collect();

    let upright = Quat::IDENTITY;
    // Seen neither edge-on nor face-on, by camera and light alike.
    let tilted = Quat::from_rotation_arc(Vec3::Y, vec3(0.6, -0.3, 0.74).normalize());
    let red = vec3(0.7, 0.2, 0.15);
    let green = vec3(0.25, 0.6, 0.3);
    let blue = vec3(0.2, 0.35, 0.7);
    let yellow = vec3(0.75, 0.65, 0.2);
    let white = vec3(0.75, 0.75, 0.75);
    // Each solid in a fine and a coarse tessellation. Heights put the lowest point on the floor.
    meshes.extend([
        revolve("sphere, fine", red, 64, &ball(0.45, 32)).placed(upright, vec3(-0.7, 0.45, -1.2)),
        revolve("sphere, coarse", yellow, 10, &ball(0.35, 6)).placed(upright, vec3(0.4, 0.35, 0.9)),
        revolve("column, fine", white, 48, &rod(0.15, 4.0)).placed(upright, vec3(-1.7, 0.0, -1.6)),
        revolve("drum, coarse", green, 8, &rod(0.35, 0.7)).placed(upright, vec3(1.4, 0.0, -0.1)),
        revolve("torus, fine, hanging", blue, 64, &ring(0.4, 0.13, 24))
            .placed(tilted, vec3(-0.9, 3.0, 0.4)),
        revolve("torus, coarse", yellow, 12, &ring(0.35, 0.12, 6))
            .placed(upright, vec3(-0.9, 0.12, 1.1)),
        revolve("sphere, coarse, hanging", green, 8, &ball(0.25, 5))
            .placed(upright, vec3(0.7, 3.1, -0.9)),
        cuboid("box", blue, vec3(0.8, 0.8, 0.8), 0.5).placed(upright, vec3(0.7, 0.0, -1.3)),
        cuboid("box, tall", red, vec3(0.45, 1.7, 0.45), 0.3).placed(upright, vec3(-1.5, 0.0, 0.4)),
    ]);
    meshes
}

// The Cornell box: measured geometry and camera as published by Cornell University's Program of
// Computer Graphics ("Cornell Box Data", https://www.graphics.cornell.edu/online/box/data.html),
// millimetres there. The albedos are RGB roundings of the measured spectra.
const CORNELL_LIGHT: Vec3 = vec3(0.278, 0.5, 0.2795);

fn cornell_camera() -> Camera {
    // The published film is 25 mm high behind a focal length of 35 mm.
    let (film, focal_length) = (0.025, 0.035);
    let eye = vec3(0.278, 0.273, -0.8);
    Camera {
        eye,
        target: eye + Vec3::Z,
        up: Vec3::Y,
        vertical_fov: 2.0 * f32::atan2(film / 2.0, focal_length),
    }
}

fn cornell(walls: u32) -> Vec<Mesh> {
    let metres = |corners: [[f32; 3]; 4]| corners.map(|corner| Vec3::from(corner) / 1000.0);
    let white = vec3(0.75, 0.75, 0.73);
    let red = vec3(0.63, 0.06, 0.05);
    let green = vec3(0.14, 0.45, 0.09);
    let floor = [[552.8, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 559.2], [549.6, 0.0, 559.2]];
    let ceiling =
        [[556.0, 548.8, 0.0], [556.0, 548.8, 559.2], [0.0, 548.8, 559.2], [0.0, 548.8, 0.0]];
    let back = [floor[3], floor[2], ceiling[2], ceiling[1]];
    let right = [floor[2], floor[1], ceiling[3], ceiling[2]];
    let left = [floor[0], floor[3], ceiling[1], ceiling[0]];
    // The published blocks have no bottoms; ours are closed, so that they are solids.
    let block = |name, base: [[f32; 2]; 4], height: f32| {
        let base = metres(base.map(|[x, z]| [x, 0.0, z]));
        quads(name, white, &prism(base, height / 1000.0), 1)
    };
    vec![
        quads("floor", white, &[metres(floor)], walls),
        quads("ceiling", white, &[metres(ceiling)], walls),
        quads("back wall", white, &[metres(back)], walls),
        quads("right wall", green, &[metres(right)], walls),
        quads("left wall", red, &[metres(left)], walls),
        block("short block", [[130.0, 65.0], [82.0, 225.0], [240.0, 272.0], [290.0, 114.0]], 165.0),
        block(
            "tall block",
            [[423.0, 247.0], [265.0, 296.0], [314.0, 456.0], [472.0, 406.0]],
            330.0,
        ),
    ]
}
