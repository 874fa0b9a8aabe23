//! What the tests of the measures share: small scenes, and maps that are exact.
#![allow(dead_code)] // each test file uses its part

use dpsm::measure::Bench;
use dpsm::render::{Frame, Method, Settings};
use dpsm::scalar::float::Vec2;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::dpsm_texture_to_disk;
use dpsm::scene::{self, Camera, Mesh, Options, Scene};
use dpsm::truth::Truth;
use glam::{Vec3, vec3};

/// Texels along a side of the tests' maps.
pub const SIZE: u32 = 128;

/// Small maps by the vertex method, and a small image.
pub fn settings() -> Settings {
    Settings { size: SIZE, method: Method::Vertex, image: [64, 48], ..Settings::default() }
}

/// Brabec's room around its own light.
pub fn room(walls: u32, settings: Settings) -> Frame {
    let scene = scene::open("brabec-room", &Options { walls, ..Options::default() }).unwrap();
    let light = scene.default_light();
    let camera = scene.camera.unwrap();
    Frame::new(&scene, light.position, Vec3::NEG_Y, false, &camera, settings).unwrap()
}

/// Maps whose every texel stores the truth along its centre.
pub fn exact_maps(frame: &Frame, truth: &Truth) -> DepthMaps {
    let size = frame.settings.map_size();
    let empty = DepthMaps::empty(size, frame.light.hemispheres, Sampling::Nearest);
    let mut maps = empty.clone();
    let bench = Bench::new(frame, &empty, truth);
    for map in 0..maps.layers {
        for y in 0..size {
            for x in 0..size {
                let st = Vec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / f64::from(size);
                let uv = dpsm_texture_to_disk(st, bench.light.guard);
                if let Some(distance) = bench.first_distance(uv, map) {
                    let direction = bench.projection.direction(uv, map);
                    let p = direction * (distance / direction.length());
                    let depth = bench.projection.depth(p, map, bench.light);
                    let index = maps.index(x.into(), y.into(), map);
                    maps.depths[index] = frame.settings.format.store(depth as f32);
                }
            }
        }
    }
    maps
}

/// A horizontal square of half-width `half` at height `y`, its centre at x = `x`.
pub fn square(name: &str, x: f32, y: f32, half: f32) -> Mesh {
    Mesh {
        name: name.into(),
        positions: [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
            .map(|(s, t)| vec3(x + s * half, y, t * half))
            .to_vec(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        albedo: Vec3::ONE,
        ..Mesh::default()
    }
}

/// A light at the origin, a floor 2 below, and half a floor 1 below whose border is x = 0, right
/// under the light.
pub fn half_covered(settings: Settings) -> Frame {
    frame_of(vec![square("floor", 0.0, -2.0, 50.0), square("cover", 50.0, -1.0, 50.0)], settings)
}

/// Meshes around a light at the origin.
pub fn frame_of(meshes: Vec<Mesh>, settings: Settings) -> Frame {
    let scene = Scene {
        name: "made".into(),
        origin: Default::default(),
        meshes,
        lights: Vec::new(),
        camera: None,
        warnings: Vec::new(),
    };
    let camera = Camera {
        eye: vec3(0.0, 5.0, 0.1),
        target: vec3(0.0, -2.0, 0.0),
        up: Vec3::NEG_Z,
        vertical_fov: 1.0,
    };
    Frame::new(&scene, Vec3::ZERO, Vec3::NEG_Y, false, &camera, settings).unwrap()
}
