//! What the targets of scenes share: files are read from a folder, and what comes is looked at.

use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

use dpsm::scene::{Options, Scene, open};
use glam::DVec3;

/// The loader takes paths, so each process has a folder; tools/fuzz sets one in memory.
pub static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("dpsm-fuzz-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    folder
});

/// Reads a file as it is, and around a point far from it.
pub fn read(name: &str, bytes: &[u8]) {
    let path = FOLDER.join(name);
    fs::write(&path, bytes).unwrap();
    for around in [None, Some(DVec3::new(4_429_529.812_5, 0.1, -5_820_128.437_5))] {
        let options = Options { around, ..Options::default() };
        match open(&path.to_string_lossy(), &options) {
            Ok(scene) => look_at(&scene),
            Err(error) => drop(error.to_string()),
        }
    }
}

/// What the fields' documentation promises.
fn look_at(scene: &Scene) {
    assert!(scene.triangle_count() > 0);
    assert!(scene.origin.is_finite(), "an origin");
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
        if let Some(cone) = light.cone {
            assert!(light.axis.is_some() && cone.inner >= 0.0 && cone.inner < cone.outer, "a cone");
            assert!(cone.outer <= std::f32::consts::FRAC_PI_2, "a cone");
        }
        assert!(light.range.is_none_or(|range| range > 0.0 && range.is_finite()), "a range");
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
