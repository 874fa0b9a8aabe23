//! What these tests share: frames with a light anywhere and turned anyhow, and made meshes.

use std::ops::Deref;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use dpsm::gpu::Device;

use dpsm::render::{Frame, Settings};
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::maps::DepthMaps;
use dpsm::scene::{self, Camera, Mesh, Options, Scene};
use dpsm::truth::{Ray, Truth};
use fastrand::Rng;
use glam::{DVec3, Vec3, vec3};

use crate::common::{cross, unit};

/// A camera for frames whose picture nobody looks at.
pub const CAMERA: Camera =
    Camera { eye: vec3(0.0, 5.0, 0.1), target: Vec3::ZERO, up: Vec3::NEG_Z, vertical_fov: 1.0 };

/// Maps alone: the smallest image.
pub fn settings() -> Settings {
    Settings { size: 256, image: [16, 16], ..Settings::default() }
}

/// A built-in scene with walls of two triangles.
pub fn built_in(name: &str) -> Scene {
    scene::open(name, &Options { walls: 1, ..Options::default() }).unwrap()
}

/// A scene made by others, if this checkout lies beside some.
pub fn shared(name: &str) -> Option<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes").join(name);
    if !path.exists() {
        println!("skipped: no file {}", path.display());
        return None;
    }
    Some(scene::open(path.to_str()?, &Options::default()).unwrap())
}

/// A scene of these meshes alone.
pub fn scene_of(meshes: Vec<Mesh>) -> Scene {
    let (origin, lights, camera, warnings) = Default::default();
    Scene { name: "made".into(), origin, meshes, lights, camera, warnings }
}

/// A frame with an omnidirectional light, not turned.
pub fn frame(scene: &Scene, position: Vec3, settings: Settings) -> Frame {
    Frame::new(scene, position, Vec3::NEG_Y, false, &CAMERA, settings).unwrap()
}

/// Turns a light anyhow.
pub fn turn(light: &mut DpsmLight<f32>, rng: &mut Rng) {
    let (forward, other) = (unit(rng).widen(), unit(rng).widen());
    let right = cross(forward, other);
    let right = right / right.length();
    light.forward = forward.narrow();
    light.right = right.narrow();
    light.up = cross(forward, right).narrow();
}

/// A random place inside a room whose first surfaces all show their front: in no object.
pub fn place(scene: &Scene, rng: &mut Rng) -> Vec3 {
    if scene.name == "cage" {
        // between the bars
        let middle = scene.default_light().position;
        return middle + vec3(rng.f32(), rng.f32(), rng.f32()) * 0.2 - 0.1;
    }
    let bounds = scene.bounds();
    let (low, size) = match scene.name.as_str() {
        // the open court
        "sponza" => (vec3(-8.0, 1.0, -1.5), vec3(16.0, 8.0, 3.0)),
        _ => (bounds.min + 0.05 * bounds.extent(), 0.9 * bounds.extent()),
    };
    let truth = Truth::from(scene);
    let corners: Vec<[Vec3; 3]> = scene.triangles().collect();
    loop {
        let position = low + size * vec3(rng.f32(), rng.f32(), rng.f32());
        let clear = (0..64).all(|_| {
            let d = unit(rng);
            let direction = DVec3::new(d.x.into(), d.y.into(), d.z.into());
            let hit = truth.first_hit(&Ray::new(position.as_dvec3(), direction));
            hit.is_none_or(|hit| {
                let [a, b, c] = corners[hit.triangle as usize].map(Vec3::as_dvec3);
                let is_front = (b - a).cross(c - a).dot(direction) < 0.0;
                // a light much nearer to a surface than to the rest is a case of its own
                (is_front || scene.name == "sponza") && hit.distance > 0.02 * f64::from(size.x)
            })
        });
        if clear {
            return position;
        }
    }
}

/// Texels whose depths differ.
pub fn differing(a: &DepthMaps, b: &DepthMaps) -> usize {
    assert_eq!((a.size, a.layers, a.depths.len()), (b.size, b.layers, b.depths.len()));
    a.depths.iter().zip(&b.depths).filter(|(a, b)| a.to_bits() != b.to_bits()).count()
}

/// True where every stored depth is a number from 0 to 1.
pub fn is_whole(maps: &DepthMaps) -> bool {
    maps.depths.iter().all(|depth| (0.0..=1.0).contains(depth))
}

/// Texels that store something.
pub fn stored(maps: &DepthMaps) -> usize {
    maps.depths.iter().filter(|&&depth| depth < 1.0).count()
}

/// A mesh of positions and triangles alone.
pub fn mesh(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    let normals = vec![Vec3::Y; positions.len()];
    Mesh {
        name: "made".into(),
        positions,
        normals,
        triangles,
        albedo: Vec3::ONE,
        ..Mesh::default()
    }
}

/// The adapter, for one test at a time: lavapipe has been seen to hang with two devices at work.
pub struct Adapter {
    device: Device,
    _alone: MutexGuard<'static, ()>,
}

impl Deref for Adapter {
    type Target = Device;

    fn deref(&self) -> &Device {
        &self.device
    }
}

/// Opens the adapter, or prints why not.
pub fn device() -> Option<Adapter> {
    static ALONE: Mutex<()> = Mutex::new(());
    // a test that failed leaves nothing behind
    let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    crate::common::device().map(|device| Adapter { device, _alone: alone })
}
