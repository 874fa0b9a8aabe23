//! Scenes that benchmarks run on, and random lights in them.
#![allow(dead_code)] // each benchmark uses its part

use dpsm::render::{Frame, Settings};
use dpsm::scalar::float::Vec3 as Row;
use dpsm::scene::{self, Options, Scene};
use dpsm::truth::{Ray, Truth};
use fastrand::Rng;
use glam::{DVec3, Quat, Vec3};

/// A scene to time: its name and a light in it.
pub struct Place {
    pub name: String,
    pub scene: Scene,
    pub light: Vec3,
}

impl Place {
    pub fn of(scene: Scene, name: &str) -> Self {
        let light = scene.default_light().position;
        Self { name: format!("{name}, {} triangles", scene.triangle_count()), scene, light }
    }

    pub fn built_in(name: &str, walls: u32) -> Self {
        let scene =
            scene::open(name, &Options { walls, ..Options::default() }).expect("a built-in scene");
        Self::of(scene, &format!("{name}, {walls} x {walls} walls"))
    }

    /// The atrium, where its file lies beside the repository.
    pub fn sponza() -> Option<Self> {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/scenes/sponza.obj");
        let scene = scene::open(path, &Options::default()).ok()?;
        Some(Self { light: Vec3::new(0.0, 4.0, 0.0), ..Self::of(scene, "sponza") })
    }

    pub fn frame(&self, settings: Settings) -> Frame {
        let camera = self.scene.default_camera(self.light);
        // a little off the axes, so that nothing is aligned by chance
        let axis = Vec3::new(0.05, -1.0, 0.03);
        let light = self.light + Vec3::new(0.013, 0.017, -0.011);
        Frame::new(&self.scene, light, axis, false, &camera, settings).expect("a usable frame")
    }
}

/// A random place in the scene's box, at least a twentieth of its size from every surface; for the
/// cage, near its middle.
pub fn position(place: &Place, truth: &Truth, rng: &mut Rng) -> Vec3 {
    let bounds = place.scene.bounds();
    loop {
        let random = Vec3::new(rng.f32(), rng.f32(), rng.f32());
        let light = match place.scene.name.as_str() {
            "cage" => place.light + (random - 0.5) * 0.1,
            _ => bounds.min + bounds.extent() * (0.1 + 0.8 * random),
        };
        let clearance = match place.scene.name.as_str() {
            "cage" => 0.1,
            _ => f64::from(bounds.extent().min_element()) / 20.0,
        };
        let directions = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|d| [d, -d]);
        let clear = |direction| {
            let ray = Ray { far: clearance, ..Ray::new(light.as_dvec3(), direction) };
            truth.first_hit(&ray).is_none()
        };
        if directions.clone().all(clear) {
            return light;
        }
    }
}

pub fn rotation(rng: &mut Rng) -> Quat {
    loop {
        let q = [(); 4].map(|()| rng.f32() * 2.0 - 1.0);
        let q = Quat::from_array(q);
        if (0.1..1.0).contains(&q.length_squared()) {
            return q.normalize();
        }
    }
}

/// A frame whose light has a rotation of its own.
pub fn posed(place: &Place, settings: Settings, light: Vec3, turn: Quat) -> Frame {
    let camera = place.scene.default_camera(light);
    let mut frame = Frame::new(&place.scene, light, Vec3::NEG_Y, false, &camera, settings)
        .expect("a usable frame");
    let row = |v: Vec3| Row::new(v.x, v.y, v.z);
    frame.light.right = row(turn * Vec3::X);
    frame.light.up = row(turn * Vec3::Y);
    frame.light.forward = row(turn * Vec3::Z);
    frame
}
