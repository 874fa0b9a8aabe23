//! The plan: what it leaves out, how fine it makes maps, and whether shadow edges are where it says.

#![cfg(feature = "scene")]

mod choices;
mod edges;
mod left_out;

use dpsm::plan::{Plan, Request, Target, plan};
use dpsm::scene::{Camera, Light, Mesh, Options, Scene, open};
use glam::{Vec3, vec3};

fn built_in(name: &str) -> Scene {
    open(name, &Options::default()).unwrap()
}

fn target(text: &str) -> Target {
    text.parse().unwrap()
}

/// The plan for a scene's own light and camera.
fn planned(scene: &Scene, error: &str) -> Plan {
    plan(&Request { camera: scene.camera, ..Request::new(scene, target(error)) }).unwrap()
}

/// A horizontal square around the y axis, facing up.
fn square(name: &str, half: f32, y: f32) -> Mesh {
    let at = |x: f32, z: f32| vec3(x * half, y, z * half);
    Mesh {
        name: name.into(),
        positions: vec![at(-1.0, -1.0), at(-1.0, 1.0), at(1.0, 1.0), at(1.0, -1.0)],
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        albedo: Vec3::splat(0.5),
        ..Mesh::default()
    }
}

/// A floor, a board over it, a light over both, and a lid over the light where one is asked for.
fn floor_and_board(lid: Option<f32>) -> Scene {
    let mut meshes = vec![square("floor", 4.0, 0.0), square("board", 0.5, 1.0)];
    meshes.extend(lid.map(|y| square("lid", 0.5, y)));
    Scene {
        name: "board".into(),
        origin: Default::default(),
        meshes,
        lights: vec![Light {
            position: vec3(0.1, 2.0, 0.2),
            axis: None,
            color: Vec3::ONE,
            cone: None,
            range: None,
        }],
        camera: Some(Camera {
            eye: vec3(3.0, 1.6, 3.0),
            target: vec3(0.0, 0.2, 0.0),
            up: Vec3::Y,
            vertical_fov: 1.0,
        }),
        warnings: Vec::new(),
    }
}
