//! Compressed meshes of glTF files. What is in the folder `packed` was written by the formats' own
//! encoder, meshoptimizer 1.3.

use std::path::Path;

use dpsm::scene::Scene;
use glam::{Vec3, vec3};
use serde_json::{Value, json};

use crate::model::Model;

const WIDTH: usize = 30;
const HEIGHT: usize = 20;

fn packed(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene/packed");
    std::fs::read(folder.join(name)).unwrap()
}

/// Corners of a field, exact in f32.
fn position(i: usize) -> Vec3 {
    let (x, z) = (i % WIDTH, i / WIDTH);
    vec3(x as f32 / 4.0, ((x * 7 + z * 13) % 11) as f32 / 8.0, z as f32 / 4.0)
}

/// Its triangles.
fn indices() -> Vec<usize> {
    let cells = (0..HEIGHT - 1).flat_map(|z| (0..WIDTH - 1).map(move |x| z * WIDTH + x));
    let cell = |i: usize| [i, i + WIDTH, i + 1, i + 1, i + WIDTH, i + WIDTH + 1];
    cells.flat_map(cell).collect()
}

/// Adds a view whose bytes are compressed, and no others of it.
fn view(model: &mut Model, name: &str, stride: usize, count: usize, more: Value) -> usize {
    let stream = packed(name);
    let view = model.view(&stream);
    let placeholder = json!({ "byteLength": 1 << 20 });
    if model.json["buffers"].is_null() {
        model.json["buffers"] = json!([{}, placeholder]);
    }
    let found = &mut model.json["bufferViews"][view];
    let mut object = json!({ "buffer": 0, "byteOffset": found["byteOffset"],
        "byteLength": stream.len(), "byteStride": stride, "count": count });
    for (key, value) in more.as_object().unwrap() {
        object[key] = value.clone();
    }
    let extension = object["extension"].take();
    let extension = extension.as_str().unwrap_or("EXT_meshopt_compression").to_string();
    *found = json!({ "buffer": 1, "byteLength": stride * count,
        "extensions": { extension: object } });
    view
}

/// The field with compressed positions and indices.
fn field(positions: (&str, usize, Value), indices: (&str, &str)) -> Model {
    let count = 6 * (WIDTH - 1) * (HEIGHT - 1);
    let mut model = Model::empty();
    let (name, stride, mut more) = positions;
    more["mode"] = json!("ATTRIBUTES");
    let view_of = view(&mut model, name, stride, WIDTH * HEIGHT, more);
    let component = if stride == 12 { 5126 } else { 5122 };
    let accessor = json!({ "bufferView": view_of, "componentType": component,
        "count": WIDTH * HEIGHT, "type": "VEC3" });
    model.json["bufferViews"][view_of]["byteStride"] = json!(stride);
    let positions = model.add("accessors", accessor);
    let view_of = view(&mut model, indices.0, 2, count, json!({ "mode": indices.1 }));
    let accessor = json!({ "bufferView": view_of, "componentType": 5123,
        "count": count, "type": "SCALAR" });
    let indices = model.add("accessors", accessor);
    let primitive = json!({ "attributes": { "POSITION": positions }, "indices": indices });
    model.add("meshes", json!({ "name": "field", "primitives": [primitive] }));
    model.node(json!({ "mesh": 0 }));
    model.requires("EXT_meshopt_compression");
    model
}

/// The corners of all triangles, in order.
fn corners(scene: &Scene) -> Vec<Vec3> {
    scene.triangles().flatten().collect()
}

/// Whether two lists have the same triangles, whichever corner is first.
fn assert_same(found: &[Vec3], expected: &[Vec3], error: f32, name: &str) {
    assert_eq!(found.len(), expected.len(), "{name}");
    for (found, expected) in found.as_chunks::<3>().0.iter().zip(expected.as_chunks::<3>().0) {
        let near =
            |turn: usize| (0..3).all(|i| found[i].distance(expected[(i + turn) % 3]) <= error);
        assert!((0..3).any(near), "{name}: {found:?} {expected:?}");
    }
}

#[test]
fn meshopt_decodes_what_its_own_encoder_wrote_to_the_bit() {
    let expected: Vec<Vec3> = indices().into_iter().map(position).collect();
    for (name, stride, more, error) in [
        ("positions0.meshopt", 12, json!({}), 0.0),
        ("positions1.meshopt", 12, json!({ "extension": "KHR_meshopt_compression" }), 0.0),
        ("positions1_best.meshopt", 12, json!({ "extension": "KHR_meshopt_compression" }), 0.0),
        ("exponential.meshopt", 12, json!({ "filter": "EXPONENTIAL" }), 0.0),
    ] {
        for indices in [("triangles.meshopt", "TRIANGLES"), ("indices.meshopt", "INDICES")] {
            let scene = field((name, stride, more.clone()), indices).read("field.glb");
            assert_eq!(scene.warnings, [""; 0]);
            assert_same(&corners(&scene), &expected, error, name);
        }
    }
    // quantised to hundredths
    let scene = field(("shorts1.meshopt", 8, json!({})), ("indices.meshopt", "INDICES"));
    let scene = scene.read("shorts.glb");
    let hundredths: Vec<Vec3> =
        expected.iter().map(|p| (p * 100.0).map(f32::round_ties_even)).collect();
    assert_same(&corners(&scene), &hundredths, 0.0, "shorts");
}

#[test]
fn meshopt_decodes_every_kind_of_triangle_code() {
    let expected = packed("mixed.indices");
    let expected: Vec<usize> =
        expected.as_chunks().0.iter().map(|pair| u16::from_le_bytes(*pair).into()).collect();
    let mut model = field(("positions0.meshopt", 12, json!({})), ("mixed.meshopt", "TRIANGLES"));
    let stride = 2 * expected.len();
    model.json["bufferViews"][1]["byteLength"] = json!(stride);
    model.json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"]["count"] =
        json!(expected.len());
    model.json["accessors"][1]["count"] = json!(expected.len());
    let scene = model.read("mixed.glb");
    let expected: Vec<Vec3> = expected.into_iter().map(position).collect();
    assert_same(&corners(&scene), &expected, 0.0, "mixed");
}

#[test]
fn meshopt_filters_give_unit_vectors_and_quaternions_back() {
    for (name, stride, component, error) in
        [("octahedral4.meshopt", 4, 5120, 0.02), ("octahedral8.meshopt", 8, 5122, 0.002)]
    {
        let mut model =
            field(("positions0.meshopt", 12, json!({})), ("indices.meshopt", "INDICES"));
        let more = json!({ "mode": "ATTRIBUTES", "filter": "OCTAHEDRAL" });
        let view = view(&mut model, name, stride, WIDTH * HEIGHT, more);
        model.json["bufferViews"][view]["byteStride"] = json!(stride);
        let accessor = json!({ "bufferView": view, "componentType": component, "normalized": true,
            "count": WIDTH * HEIGHT, "type": "VEC3" });
        let normals = model.add("accessors", accessor);
        model.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
        let scene = model.read("octahedral.glb");
        assert_eq!(scene.warnings, [""; 0]);
        let mesh = &scene.meshes[0];
        for (normal, at) in mesh.normals.iter().zip(&mesh.positions) {
            let i = (at.z * 4.0) as usize * WIDTH + (at.x * 4.0) as usize;
            let (sin, cos) = (i as f32 * 0.1).sin_cos();
            let expected = vec3(0.6 * cos, 0.6 * sin, if i.is_multiple_of(2) { 0.8 } else { -0.8 });
            assert!(normal.distance(expected) < error, "{name} {i}: {normal} {expected}");
        }
    }
    // as rotations of copies, around y by 0.35 each
    let mut model = Model::empty();
    let plate = model.plate("plate", &crate::model::PLATE);
    let more = json!({ "mode": "ATTRIBUTES", "filter": "QUATERNION" });
    let view = view(&mut model, "quaternion.meshopt", 8, 16, more);
    let accessor = json!({ "bufferView": view, "componentType": 5122, "normalized": true,
        "count": 16, "type": "VEC4" });
    let rotation = model.add("accessors", accessor);
    let copies = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "ROTATION": rotation } } });
    model.node(json!({ "mesh": plate, "extensions": copies }));
    let scene = model.read("quaternion.glb");
    assert_eq!(scene.warnings, [""; 0]);
    let corners = corners(&scene);
    for (i, copy) in corners.as_chunks::<6>().0.iter().enumerate() {
        let turn = glam::Quat::from_rotation_y(i as f32 * 0.35);
        let expected = turn * vec3(-1.0, 0.0, 1.0);
        assert!(copy[0].distance(expected) < 1e-3, "{i}: {} {expected}", copy[0]);
    }
}

#[test]
fn compressed_views_that_are_broken_fall_back_or_are_named() {
    let broken = |change: fn(&mut Value), fault: &str| {
        let mut model =
            field(("positions0.meshopt", 12, json!({})), ("indices.meshopt", "INDICES"));
        change(&mut model.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]);
        let message = model.error("broken.glb");
        assert!(message.contains(&format!("EXT_meshopt_compression: {fault}")), "{message}");
    };
    broken(|it| it["byteLength"] = json!(100), "its compressed bytes are broken");
    broken(|it| it["byteOffset"] = json!(4), "its compressed bytes are broken");
    broken(|it| it["count"] = json!(1u64 << 40), "its compressed bytes are too few");
    broken(|it| it["mode"] = json!("LATER"), "its mode `LATER` is not known");
    broken(|it| it["filter"] = json!("LATER"), "its filter `LATER` is not known for 12 bytes");
    broken(|it| it["byteStride"] = json!(0), "its elements have 0 bytes");
    broken(|it| it["byteLength"] = json!(1 << 30), "lie outside their buffer");

    // with the data beside it
    let mut model = field(("positions0.meshopt", 12, json!({})), ("indices.meshopt", "INDICES"));
    let floats: Vec<u8> = (0..WIDTH * HEIGHT)
        .flat_map(|i| position(i).to_array())
        .flat_map(f32::to_le_bytes)
        .collect();
    let plain = model.view(&floats);
    let offset = model.json["bufferViews"][plain]["byteOffset"].clone();
    let found = &mut model.json["bufferViews"][0];
    found["buffer"] = json!(0);
    found["byteOffset"] = offset;
    found["extensions"]["EXT_meshopt_compression"]["mode"] = json!("LATER");
    let expected: Vec<Vec3> = indices().into_iter().map(position).collect();
    assert_same(&corners(&model.read("fallback.glb")), &expected, 0.0, "fallback");
}

#[test]
fn every_changed_byte_of_a_stream_gives_an_error_or_a_valid_scene() {
    let model = field(("positions1.meshopt", 12, json!({})), ("triangles.meshopt", "TRIANGLES"));
    for i in (0..model.bin.len()).step_by(17) {
        let mut changed = Model { json: model.json.clone(), bin: model.bin.clone() };
        changed.bin[i] ^= 0x41;
        let path = crate::file("changed_stream.glb", changed.glb());
        if let Ok(scene) = dpsm::scene::open(path.to_str().unwrap(), &Default::default()) {
            crate::assert_valid(&scene);
        }
    }
}

/// The field as Draco has it; attributes by their numbers there.
fn draco() -> Model {
    let mut model = Model::empty();
    let view = model.view(b"DRACO, of which nothing is read");
    let count = 6 * (WIDTH - 1) * (HEIGHT - 1);
    let accessor = |shape: &str, component: u32, count: usize| json!({ "componentType": component, "count": count, "type": shape });
    let positions = model.add("accessors", accessor("VEC3", 5126, WIDTH * HEIGHT));
    let normals = model.add("accessors", accessor("VEC3", 5126, WIDTH * HEIGHT));
    let indices = model.add("accessors", accessor("SCALAR", 5123, count));
    let numbers = json!({ "POSITION": 2, "NORMAL": 1 });
    let extension = json!({ "bufferView": view, "attributes": numbers });
    let primitive = json!({ "attributes": { "POSITION": positions, "NORMAL": normals },
        "indices": indices, "extensions": { "KHR_draco_mesh_compression": extension } });
    model.add("meshes", json!({ "name": "field", "primitives": [primitive] }));
    model.node(json!({ "mesh": 0 }));
    model.requires("KHR_draco_mesh_compression");
    model
}

#[test]
fn draco_is_named_with_the_remedy_or_its_fallback_used() {
    let mut model = draco();
    let message = model.error("draco.glb");
    assert!(message.contains("mesh `field`: KHR_draco_mesh_compression is not decoded: "));
    assert!(message.contains("decompress it with `gltf-transform copy IN.glb OUT.glb`; "));
    // with the data beside it
    let plate = model.plate("plate", &crate::model::PLATE);
    let plain = model.json["meshes"][plate]["primitives"][0].clone();
    model.json["meshes"][0]["primitives"][0]["indices"] = plain["indices"].clone();
    model.json["meshes"][0]["primitives"][0]["attributes"] = plain["attributes"].clone();
    assert_eq!(model.read("draco_fallback.glb").triangle_count(), 2);
}
