//! glTF files, text and binary.

use dpsm::scene::Light;
use glam::{Vec3, vec3};

use crate::{assert_valid, error, file, read, shared};

/// A binary file of the given JSON and the buffer that [`ACCESSORS`] describes.
pub(crate) fn glb(json: &str) -> Vec<u8> {
    glb_with(json, &buffer())
}

/// A binary file; the buffer's length must be a multiple of 4.
pub(crate) fn glb_with(json: &str, bin: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut out = b"glTF".to_vec();
    let number = |n: usize, out: &mut Vec<u8>| out.extend((n as u32).to_le_bytes());
    number(2, &mut out);
    number(12 + 8 + json.len() + 8 + bin.len(), &mut out);
    number(json.len(), &mut out);
    out.extend(b"JSON");
    out.extend(json);
    number(bin.len(), &mut out);
    out.extend(b"BIN\0");
    out.extend(bin);
    out
}

pub(crate) fn buffer() -> Vec<u8> {
    let square = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let normals = [[0.0f32, 0.0, 2.0], [0.0, 0.0, 0.0], [0.0, 0.6, 0.8], [f32::NAN, 0.0, 0.0]];
    let broken = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f32::INFINITY, 0.0, 0.0]];
    let floats = [square, normals, broken].into_iter().flatten().flatten();
    let strip = [0u16, 1, 3, 2];
    let list = [0u16, 1, 2, 0, 2, 9];
    let indices = strip.into_iter().chain(list);
    floats.flat_map(f32::to_le_bytes).chain(indices.flat_map(u16::to_le_bytes)).collect()
}

/// 0: a square's corners; 1: normals, the second and fourth unusable; 2: positions, the fourth
/// infinite; 3: a strip's indices; 4: a list's, the last out of range.
const ACCESSORS: &str = r#""bufferViews": [
  {"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48},
  {"buffer": 0, "byteOffset": 96, "byteLength": 48}, {"buffer": 0, "byteOffset": 144, "byteLength": 8},
  {"buffer": 0, "byteOffset": 152, "byteLength": 12}],
"accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
  {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
  {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
  {"bufferView": 3, "componentType": 5123, "count": 4, "type": "SCALAR"},
  {"bufferView": 4, "componentType": 5123, "count": 6, "type": "SCALAR"}]"#;

/// A document with one mesh of these primitives; `more` are further members.
pub(crate) fn json(primitives: &str, nodes: &str, more: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"buffers": [{{"byteLength": 164}}], {ACCESSORS},
"meshes": [{{"name": "x", "primitives": [{primitives}]}}], "nodes": [{nodes}]{more}}}"#
    )
}

pub(crate) const STRIP: &str = r#"{"attributes": {"POSITION": 0}, "indices": 3, "mode": 5}"#;
pub(crate) const NODE: &str = r#"{"mesh": 0}"#;

#[test]
fn lists_strips_and_fans_become_triangles_and_the_rest_is_counted() {
    let primitives = format!(
        r#"{STRIP}, {{"attributes": {{"POSITION": 0}}, "mode": 6}},
        {{"attributes": {{"POSITION": 0, "_CUSTOM": 1}}, "mode": 4, "indices": 4}},
        {{"attributes": {{"POSITION": 0}}, "mode": 0}}, {{"attributes": {{"POSITION": 0}}, "mode": 3}}"#
    );
    let scene = read(&file("modes.glb", glb(&json(&primitives, NODE, ""))));
    assert_valid(&scene);
    let counts: Vec<_> =
        scene.meshes.iter().map(|m| (m.name.as_str(), m.triangles.len())).collect();
    assert_eq!(counts, [("x/0", 2), ("x/1", 2), ("x/2", 1)]);
    assert!(scene.triangles().all(|[a, b, c]| (b - a).cross(c - a) == Vec3::Z));
    assert_eq!(
        scene.warnings,
        [
            "2 point or line primitives skipped",
            "mesh `x/2`: 1 vertex indices out of range (first: 9, of 4 vertices), 1 triangles dropped",
        ]
    );
}

#[test]
fn unusable_vertices_and_normals_are_counted_and_named() {
    let primitives = r#"{"attributes": {"POSITION": 2}, "mode": 6}"#;
    let scene = read(&file("nan.glb", glb(&json(primitives, NODE, ""))));
    assert_valid(&scene);
    assert_eq!(scene.triangle_count(), 1);
    assert_eq!(
        scene.warnings,
        ["mesh `x`: 1 non-finite vertices (first: number 3, from 0), 1 triangles dropped"]
    );
}

#[test]
fn sparse_positions_are_read_and_cannot_claim_any_number_of_zeros() {
    // One value replaced: the index is the strip's first, 0, the value the first normal.
    let sparse = r#", "sparse": {"count": 1, "values": {"bufferView": 1},
        "indices": {"bufferView": 3, "componentType": 5123}}}"#;
    let base = json(STRIP, NODE, "").replacen(
        "\"max\": [1, 1, 0]}",
        &format!("\"max\": [1, 1, 0]{sparse}"),
        1,
    );
    let scene = read(&file("sparse.glb", glb(&base)));
    assert_eq!(scene.triangles().next().unwrap()[0], vec3(0.0, 0.0, 2.0));

    // Not as many zeros as the file likes to claim.
    let claimed = base.replacen(r#"{"bufferView": 0, "#, "{", 1).replacen(
        "\"count\": 4",
        "\"count\": 4194305",
        1,
    );
    let message = error(&file("claimed.glb", glb(&claimed)));
    assert!(
        message.contains(
            "mesh `x`: its positions have no buffer view: a file may claim 4194304 zeros, and this one claims 4194305"
        ),
        "{message}"
    );
}

#[test]
fn given_normals_are_normalised_and_unusable_ones_are_the_faces() {
    let primitives = r#"{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 3, "mode": 5}"#;
    let scene = read(&file("normals.glb", glb(&json(primitives, NODE, ""))));
    assert_valid(&scene);
    assert_eq!(scene.warnings, ["mesh `x`: 4 corners have no usable normal and got their face's"]);
    let mesh = &scene.meshes[0];
    assert!(mesh.normals.iter().any(|normal| normal.distance(vec3(0.0, 0.6, 0.8)) < 1e-6));
}

#[test]
fn node_transforms_apply_and_mirroring_keeps_the_visible_side() {
    let nodes = r#"{"children": [1], "translation": [0, 0, 5]},
        {"mesh": 0, "scale": [-2, 1, 1], "translation": [1, 0, 0]}"#;
    let primitives = r#"{"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0}"#;
    let more =
        r#", "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]}}]"#;
    let scene = read(&file("mirror.glb", glb(&json(primitives, nodes, more))));
    let bounds = scene.bounds();
    assert_eq!((bounds.min, bounds.max), (vec3(-1.0, 0.0, 5.0), vec3(1.0, 1.0, 5.0)));
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.albedo, vec3(0.5, 0.25, 1.0));
    assert!(scene.triangles().all(|[a, b, c]| (b - a).cross(c - a).z > 0.0));
    assert!(mesh.normals.iter().all(|normal| normal.z > 0.0));
}

#[test]
fn point_lights_are_omnidirectional_and_spots_hemispherical() {
    let light = |i| format!(r#", "extensions": {{"KHR_lights_punctual": {{"light": {i}}}}}"#);
    let nodes = format!(
        r#"{{"mesh": 0, "children": [1, 2, 3, 4]}}, {{"translation": [1, 2, 3]{}}},
        {{"rotation": [-0.70710678, 0, 0, 0.70710678]{}}}, {{"translation": [0, 9, 0]{}}}, {{"translation": [0, 0, 0]{}}}"#,
        light(0),
        light(1),
        light(2),
        light(3)
    );
    let more = r#", "extensionsRequired": ["KHR_lights_punctual", "KHR_materials_unlit"],
        "extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "point", "color": [0.5, 0.25, 0], "intensity": 40}, {"type": "spot", "spot": {}},
        {"type": "directional"}, {"type": "point", "color": [0, 0, 0]}]}}"#;
    let scene = read(&file("lights.glb", glb(&json(STRIP, &nodes, more))));
    assert_valid(&scene);
    let point = Light {
        position: vec3(1.0, 2.0, 3.0),
        axis: None,
        color: vec3(1.0, 0.5, 0.0),
        cone: None,
        range: None,
    };
    assert_eq!(scene.lights.len(), 2);
    assert_eq!(scene.lights[0], point);
    assert_eq!(scene.default_light(), point);
    assert!(scene.lights[1].axis.unwrap().distance(Vec3::NEG_Y) < 1e-6);
    assert_eq!(
        scene.warnings,
        [
            "1 directional lights skipped: they have no position",
            "1 lights without colour, position or direction skipped",
        ]
    );
}

#[test]
fn first_perspective_camera_is_used() {
    let nodes = r#"{"mesh": 0, "children": [1, 2, 3]}, {"camera": 0},
        {"camera": 1, "translation": [0, 0, 4]}, {"camera": 1}"#;
    let more = r#", "cameras": [
        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 1}},
        {"type": "perspective", "perspective": {"yfov": 0.75, "znear": 1}}]"#;
    let scene = read(&file("camera.glb", glb(&json(STRIP, nodes, more))));
    let camera = scene.camera.unwrap();
    assert_eq!((camera.eye, camera.target), (vec3(0.0, 0.0, 4.0), vec3(0.0, 0.0, 3.0)));
    assert_eq!((camera.up, camera.vertical_fov), (Vec3::Y, 0.75));
    assert_eq!(scene.warnings, ["a camera without a usable perspective was skipped"]);
}

#[test]
fn nodes_in_a_circle_or_in_no_scene_are_read_once() {
    let nodes = r#"{"mesh": 0, "children": [1]}, {"children": [0]}"#;
    let circle = read(&file("circle.glb", glb(&json(STRIP, nodes, ""))));
    assert_eq!(circle.meshes.len(), 1);
    let no_scene = json(STRIP, NODE, "").replace(r#""scene": 0, "scenes": [{"nodes": [0]}],"#, "");
    assert_eq!(read(&file("no_scene.glb", glb(&no_scene))).meshes.len(), 1);
}

#[test]
fn meshes_made_by_others_are_read_whole() {
    for (name, triangles) in [("golf-ball.glb", 356), ("primitives.glb", 12)] {
        if let Some(scene) = shared(name) {
            assert_valid(&scene);
            assert_eq!(scene.triangle_count(), triangles, "{name}");
            assert_eq!(scene.warnings, [""; 0], "{name}");
        }
    }
}
