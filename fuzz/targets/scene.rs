//! Files of scenes: the first byte says which kind, the rest is the file; `.mtl` of an OBJ follows
//! it after a NUL. Or the rest alters a good file.
#![no_main]

mod altered;
mod common;

use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

use dpsm::scene::{Options, Scene, open};
use libfuzzer_sys::fuzz_target;

/// The loader takes paths, so each process has a folder; tools/fuzz sets one in memory.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("dpsm-fuzz-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    folder
});

fuzz_target!(init: common::keep_panics(), |bytes: &[u8]| {
    let Some((&kind, file)) = bytes.split_first() else { return };
    common::no_panic(|| run(kind, file));
});

fn run(kind: u8, file: &[u8]) {
    let altered = if kind == b'a' { altered::glb(file) } else { Vec::new() };
    let (name, bytes) = match kind {
        b'o' => {
            let mut parts = file.splitn(2, |byte| *byte == 0);
            let obj = parts.next().unwrap_or_default();
            fs::write(FOLDER.join("a.mtl"), parts.next().unwrap_or_default()).unwrap();
            ("a.obj", obj)
        }
        b't' => ("a.gltf", file),
        b'b' => ("a.glb", file),
        b'a' => ("a.glb", altered.as_slice()),
        _ => return,
    };
    let path = FOLDER.join(name);
    fs::write(&path, bytes).unwrap();
    match open(&path.to_string_lossy(), &Options::default()) {
        Ok(scene) => look_at(&scene),
        Err(error) => drop(error.to_string()),
    }
}

/// What the fields' documentation promises.
fn look_at(scene: &Scene) {
    assert!(scene.triangle_count() > 0);
    for mesh in &scene.meshes {
        assert!(mesh.positions.iter().all(|p| p.is_finite()), "a position");
        assert_eq!(mesh.positions.len(), mesh.normals.len());
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5), "a normal");
        let corners = mesh.triangles.iter().flatten();
        assert!(corners.clone().all(|&i| (i as usize) < mesh.positions.len()), "an index");
        assert!(mesh.albedo.cmpge(glam::Vec3::ZERO).all(), "an albedo");
        assert!(mesh.albedo.cmple(glam::Vec3::ONE).all(), "an albedo");
        match &mesh.mask {
            None => assert!(mesh.texcoords.is_empty()),
            Some(mask) => {
                assert_eq!(mesh.texcoords.len(), mesh.positions.len());
                assert_eq!(mask.alpha.len(), (mask.width * mask.height) as usize);
                let _ = mesh.opaque(0, [0.3, 0.3, 0.4]);
            }
        }
    }
    for light in &scene.lights {
        assert!(light.position.is_finite(), "a light");
        assert!((light.color.max_element() - 1.0).abs() < 1e-6, "a colour");
        assert!(light.axis.is_none_or(|axis| (axis.length() - 1.0).abs() < 1e-5), "an axis");
    }
    let light = scene.default_light();
    let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
    let axis = light.axis.unwrap_or(glam::Vec3::NEG_Y);
    let settings = dpsm::render::Settings::default();
    let hemispherical = light.axis.is_some();
    let frame =
        dpsm::render::Frame::new(scene, light.position, axis, hemispherical, &camera, settings);
    if let Err(error) = frame {
        drop(error.to_string());
    }
}
