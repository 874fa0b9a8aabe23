//! Scenes: built in, read from files, and the light and camera of those that have none.

#![cfg(feature = "scene")]

mod built_in;
mod far;
mod geometry;
mod gltf_faults;
mod gltf_files;
mod kinds;
mod legal;
mod lights;
mod mask_faults;
mod masks;
mod model;
mod named_files;
mod obj_files;
mod obj_odd;
mod packed;
mod view;

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use dpsm::scene::{BUILT_IN, Camera, Cone, Mesh, Options, Scene, open};
use glam::{DVec3, Vec3};

fn built_in(name: &str, walls: u32) -> Scene {
    open(name, &Options { walls, ..Options::default() }).unwrap()
}

fn every_built_in() -> impl Iterator<Item = Scene> {
    BUILT_IN.into_iter().map(|(name, _)| built_in(name, 8))
}

/// Built-in scenes without walls.
const OPEN: [&str; 2] = ["hills", "boulder"];

fn every_room() -> impl Iterator<Item = Scene> {
    every_built_in().filter(|scene| !OPEN.contains(&scene.name.as_str()))
}

fn is_wall(mesh: &Mesh) -> bool {
    ["wall", "floor", "ceiling"].iter().any(|part| mesh.name.contains(part))
}

fn corners(mesh: &Mesh) -> impl Iterator<Item = [Vec3; 3]> {
    mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize]))
}

/// How often each directed edge occurs, vertices with equal positions being one.
fn edges<'a>(meshes: impl IntoIterator<Item = &'a Mesh>) -> HashMap<[[u32; 3]; 2], u32> {
    // Adding 0 makes -0 a 0.
    let key = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut edges = HashMap::new();
    for [a, b, c] in meshes.into_iter().flat_map(corners) {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([key(from), key(to)]).or_default() += 1;
        }
    }
    edges
}

/// Every edge belongs to two triangles that wind the same way.
fn is_watertight<'a>(meshes: impl IntoIterator<Item = &'a Mesh>) -> bool {
    let edges = edges(meshes);
    edges.iter().all(|([from, to], count)| *count == 1 && edges.contains_key(&[*to, *from]))
}

/// Positive when the triangles face outward.
fn volume<'a>(meshes: impl IntoIterator<Item = &'a Mesh>) -> f64 {
    let triangles = meshes.into_iter().flat_map(corners);
    triangles.map(|t| t.map(Vec3::as_dvec3)).map(|[a, b, c]| a.cross(b).dot(c) / 6.0).sum()
}

/// How often a closed mesh encloses a point: the solid angle it covers over the sphere's
/// (van Oosterom and Strackee 1983).
fn enclosures(mesh: &Mesh, point: Vec3) -> i32 {
    let solid_angle = |triangle: [Vec3; 3]| {
        let [a, b, c] = triangle.map(|corner| (corner - point).as_dvec3().normalize());
        2.0 * a.cross(b).dot(c).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    let sum: f64 = corners(mesh).map(solid_angle).sum();
    (sum / (4.0 * std::f64::consts::PI)).round() as i32
}

/// Ray parameter and mesh of the nearest hit beyond `from`.
fn hit(scene: &Scene, origin: Vec3, direction: Vec3, from: f64) -> Option<(f64, &Mesh)> {
    let (origin, direction) = (origin.as_dvec3(), direction.as_dvec3());
    let along = |[a, b, c]: [DVec3; 3]| {
        let normal = (b - a).cross(c - a);
        let t = (a - origin).dot(normal) / direction.dot(normal);
        let p = origin + direction * t;
        let left = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(normal) >= 0.0;
        (t > from && left(a, b) && left(b, c) && left(c, a)).then_some(t)
    };
    let hits = scene.meshes.iter().flat_map(|mesh| {
        corners(mesh).filter_map(move |t| Some((along(t.map(Vec3::as_dvec3))?, mesh)))
    });
    hits.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Metres to the nearest surface along a camera's central ray.
fn free_ahead(scene: &Scene, camera: &Camera) -> f64 {
    let forward = (camera.target - camera.eye).normalize();
    hit(scene, camera.eye, forward, 0.0).map_or(f64::INFINITY, |(t, _)| t)
}

/// Writes a file of its own for a test.
fn file(name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("scene");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    // Ext4 writes a file that is truncated and written again to the disk at once.
    _ = std::fs::remove_file(&path);
    std::fs::write(&path, content).unwrap();
    path
}

fn read(path: &Path) -> Scene {
    open(path.to_str().unwrap(), &Options::default()).unwrap()
}

/// The error's text, with the file's path shortened to its name.
fn error(path: &Path) -> String {
    let error = open(path.to_str().unwrap(), &Options::default()).unwrap_err().to_string();
    let name = path.file_name().unwrap().to_str().unwrap();
    assert!(error.contains(path.to_str().unwrap()), "{error}");
    error.replace(path.to_str().unwrap(), name)
}

/// A mesh made by others, if this checkout lies beside some.
fn shared(name: &str) -> Option<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes").join(name);
    if !path.exists() {
        println!("skipped: no file {}", path.display());
        return None;
    }
    Some(read(&path))
}

/// What every scene promises, however bad its file.
fn assert_valid(scene: &Scene) {
    assert!(scene.triangle_count() > 0);
    assert!(scene.origin.is_finite());
    for mesh in &scene.meshes {
        assert_eq!(mesh.positions.len(), mesh.normals.len());
        assert!(mesh.positions.iter().all(|p| p.is_finite()));
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6), "{}", mesh.name);
        assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.positions.len()));
        let texcoords = if mesh.mask.is_some() { mesh.positions.len() } else { 0 };
        assert_eq!(mesh.texcoords.len(), texcoords, "{}", mesh.name);
        assert!(mesh.albedo.cmpge(Vec3::ZERO).all() && mesh.albedo.cmple(Vec3::ONE).all());
    }
    for light in &scene.lights {
        assert!(light.position.is_finite() && light.color.max_element() == 1.0);
        assert!(light.axis.is_none_or(|axis| axis.is_normalized()));
        if let Some(Cone { inner, outer }) = light.cone {
            assert!(light.axis.is_some() && inner >= 0.0 && inner < outer);
            assert!(outer <= std::f32::consts::FRAC_PI_2);
        }
        assert!(light.range.is_none_or(|range| range > 0.0 && range.is_finite()));
    }
    let light = scene.default_light().position;
    let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light));
    assert!(camera.eye != camera.target && camera.vertical_fov > 0.0);
}
