//! The built-in scenes.

mod contact;
mod crowd;
mod fence;
mod room;
mod rough;

use glam::{DVec3, Vec3, vec3};

use super::shapes::{prism, quads};
use super::{Camera, Light, Mesh, Options, Scene, SceneError};

pub use crowd::{crowd, dozen};

/// Name and one line about each scene that [`open`](super::open) builds.
pub const BUILT_IN: [(&str, &str); 13] = [
    (
        "brabec-room",
        "closed room with solids, omnidirectional light in its middle (Brabec 2002, figure 3)",
    ),
    (
        "brabec-ceiling",
        "the same room, hemispherical light under the ceiling (Brabec 2002, figure 4)",
    ),
    ("cornell", "the Cornell box, omnidirectional light under its ceiling"),
    (
        "seam-box",
        "closed room, omnidirectional light, a box across the plane between its hemispheres",
    ),
    ("cage", "closed room, omnidirectional light in a cage of thin bars"),
    ("fence", "closed room, omnidirectional light between alpha-masked lattice and leaves"),
    ("crowd", "closed room of large triangles, 40,000 small ones of spheres and boxes in it"),
    ("grazing", "closed room, a table and a screen that the light sees at up to 89.7 degrees"),
    ("gaps", "closed room, boards that hover 1 mm to 10 cm over the floor"),
    ("contact", "closed room, boxes 1 cm to 2.5 m high that touch the floor"),
    ("seam-edge", "closed room, boxes with edges in the plane between the hemispheres"),
    ("hills", "rough height field of triangles smaller than a texel, light above and beside it"),
    (
        "boulder",
        "rough closed mesh of 80,688 small triangles on the ground, light diagonally above",
    ),
];

/// `name` is one of [`BUILT_IN`].
pub(super) fn build(name: &str, walls: u32) -> Result<Scene, SceneError> {
    if !(1..=Options::MAX_WALLS).contains(&walls) {
        return Err(SceneError::Walls { walls });
    }
    let middle = (room::MIN + room::MAX) / 2.0;
    Ok(match name {
        "cornell" => scene(name, cornell(walls), CORNELL_LIGHT, None, cornell_camera()),
        "brabec-ceiling" => {
            let under_ceiling = middle.with_y(room::MAX.y - 0.1);
            let axis = Some(Vec3::NEG_Y);
            scene(name, room::solids(walls), under_ceiling, axis, room::camera())
        }
        "hills" => lit(name, rough::hills(), rough::hills_light(), rough::hills_camera()),
        "boulder" => {
            let (light, camera) = (rough::boulder_light(), rough::boulder_camera());
            lit(name, rough::boulder(walls), light, camera)
        }
        _ => {
            let meshes = match name {
                "seam-box" => room::seam_box(walls),
                "cage" => room::cage(walls),
                "fence" => fence::fence(walls),
                "grazing" => contact::grazing(walls),
                "gaps" => contact::gaps(walls),
                "contact" => contact::contact(walls),
                "seam-edge" => contact::seam_edge(walls),
                "crowd" => crowd::meshes(crowd::BUILT_IN, walls),
                _ => room::solids(walls),
            };
            scene(name, meshes, middle, None, room::camera())
        }
    })
}

fn scene(
    name: &str,
    meshes: Vec<Mesh>,
    position: Vec3,
    axis: Option<Vec3>,
    camera: Camera,
) -> Scene {
    lit(name, meshes, Light { position, axis, color: Vec3::ONE, cone: None, range: None }, camera)
}

fn lit(name: &str, meshes: Vec<Mesh>, light: Light, camera: Camera) -> Scene {
    Scene {
        name: name.into(),
        origin: DVec3::ZERO,
        meshes,
        lights: vec![light],
        camera: Some(camera),
        warnings: Vec::new(),
    }
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
