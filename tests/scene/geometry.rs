//! What moves or copies the triangles of a glTF: copies, morph targets, skins, hidden nodes,
//! quantised and sparse numbers. Shadows are told by rays.

use glam::{DMat4, DVec3, dvec3};
use serde_json::{Value, json};

use crate::model::{F32, I8, I16, Model, PLATE, U8, U16, bounds, bytes, lit};

/// A plate of 2 x 2 at y = 2, halfway to the light, shadows the floor up to 2 from its middle.
const MIDDLE: [f64; 2] = [0.5, 0.5];
const RIGHT: [f64; 2] = [6.5, 0.5];
const LEFT: [f64; 2] = [-6.5, 0.5];

fn over(mut model: Model, node: Value, mesh: usize) -> Model {
    let mut node = node;
    node["mesh"] = json!(mesh);
    model.node(node);
    model
}

#[test]
fn copies_of_a_mesh_are_where_their_attributes_say_and_the_mesh_itself_is_not() {
    let mut model = Model::new();
    let plate = model.plate("crate", &PLATE);
    let places = model.vectors(&[[3.0, 0.0, 0.0], [-3.0, 0.0, 0.0]]);
    let attributes = json!({ "TRANSLATION": places, "_ID": 99 });
    let extensions = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    model.requires("EXT_mesh_gpu_instancing");
    let model = over(model, json!({ "translation": [0, 2, 0], "extensions": extensions }), plate);
    let scene = model.read("copies.glb");
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!(scene.meshes[1].triangles.len(), 4);
    assert_eq!(lit(&scene, [MIDDLE, RIGHT, LEFT]), [true, false, false]);
}

#[test]
fn copies_are_scaled_then_turned_then_moved_and_then_the_node_is_placed() {
    let mut model = Model::new();
    let plate = model.plate("crate", &PLATE);
    let translation = model.vectors(&[[1.0, 0.0, 0.0]]);
    let scale = model.vectors(&[[3.0, 1.0, 0.5]]);
    // a quarter turn around y, as normalised bytes: 0.709 each, made unit length
    let rotation = model.accessor(I8, "VEC4", &[0.0, 90.0, 0.0, 90.0]);
    model.json["accessors"][rotation]["normalized"] = json!(true);
    let attributes = json!({ "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale });
    let extensions = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    let node = json!({ "translation": [0, 2, 0], "scale": [2, 1, 1], "extensions": extensions });
    let scene = over(model, node, plate).read("turned_copy.glb");
    let corners = &scene.meshes[1].positions;
    let extent = |axis: fn(&glam::Vec3) -> f32| {
        let values = corners.iter().map(axis);
        (values.clone().fold(f32::MAX, f32::min), values.fold(f32::MIN, f32::max))
    };
    // 0.5 wide in x, which the node doubles, around 1, and 3 long in z
    let near = |(a, b): (f32, f32), (c, d): (f32, f32)| (a - c).abs() + (b - d).abs() < 1e-5;
    assert!(near(extent(|p| p.x), (1.0, 3.0)), "{corners:?}");
    assert!(near(extent(|p| p.z), (-3.0, 3.0)), "{corners:?}");
}

#[test]
fn copies_that_cannot_be_read_are_named_and_the_mesh_is_shown_once() {
    for (attributes, fault) in [
        (json!({ "TRANSLATION": 0, "SCALE": 1 }), "its instances have attributes of different"),
        (json!({ "TRANSLATION": 77 }), "accessors[77] is not there"),
        (json!({ "ROTATION": 0 }), "its instances' rotations have an unexpected type"),
        (json!(7), "EXT_mesh_gpu_instancing"),
    ] {
        let mut model = Model::new();
        let plate = model.plate("crate", &PLATE);
        let extensions = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
        let node = json!({ "translation": [0, 2, 0], "extensions": extensions });
        let scene = over(model, node, plate).read("bad_copies.glb");
        let [warning] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
        let start = "mesh `crate`: copies ignored, shown once: ";
        assert!(warning.starts_with(start) && warning.contains(fault), "{warning}");
        assert_eq!(lit(&scene, [MIDDLE, RIGHT]), [false, true]);
    }
}

/// A plate whose targets move it to the right and to the left, by 3 each.
fn morphing(mesh_weights: Value, node_weights: Value) -> Model {
    let mut model = Model::new();
    let plate = model.plate("lid", &PLATE);
    let by = |x: f32| [[x, 0.0, 0.0]; 4];
    let targets = [model.vectors(&by(3.0)), model.vectors(&by(-3.0))];
    let targets = targets.map(|target| json!({ "POSITION": target }));
    model.json["meshes"][plate]["primitives"][0]["targets"] = json!(targets);
    model.json["meshes"][plate]["weights"] = mesh_weights;
    over(model, json!({ "translation": [0, 2, 0], "weights": node_weights }), plate)
}

#[test]
fn morph_targets_move_a_mesh_by_its_weights_and_the_nodes_win() {
    let points = [MIDDLE, RIGHT, LEFT];
    for (mesh, node, expected) in [
        (json!(null), json!(null), [false, true, true]),
        (json!([1, 0]), json!(null), [true, false, true]),
        (json!([1, 0]), json!([0, 1]), [true, true, false]),
        (json!([1, 0]), json!([0, 0]), [false, true, true]),
        (json!([1, 1]), json!(null), [false, true, true]),
        (json!([0.5, 0.5]), json!([1]), [true, false, true]),
    ] {
        let scene = morphing(mesh.clone(), node.clone()).read("morph.glb");
        assert_eq!(scene.warnings, [""; 0]);
        assert_eq!(lit(&scene, points), expected, "{mesh} {node}");
    }
}

#[test]
fn morph_targets_may_be_sparse_quantised_and_turn_normals() {
    let mut model = morphing(json!([1, 0]), json!(null));
    // the second corner alone, by (0, 1, 0)
    let (index, value) = (model.view(&[1, 0]), model.view(&bytes(F32, &[0.0, 1.0, 0.0])));
    let sparse = json!({ "count": 1, "indices": { "bufferView": index, "componentType": 5123 },
        "values": { "bufferView": value } });
    let target = json!({ "componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse });
    let target = model.add("accessors", target);
    let up = model.vectors(&[[0.0, 1.0, 0.0]; 4]);
    let turn = model.accessor(I8, "VEC3", &[127.0, -127.0, 0.0].repeat(4));
    model.json["accessors"][turn]["normalized"] = json!(true);
    let primitive = &mut model.json["meshes"][1]["primitives"][0];
    primitive["attributes"]["NORMAL"] = json!(up);
    primitive["targets"][0] = json!({ "POSITION": target, "NORMAL": turn });
    let scene = model.read("sparse_morph.glb");
    let mesh = &scene.meshes[1];
    let raised = mesh.positions.iter().filter(|position| position.y == 3.0).count();
    assert_eq!((raised, mesh.positions.len()), (1, 4));
    assert!(mesh.normals.iter().all(|normal| normal.x == 1.0), "{:?}", mesh.normals);
}

#[test]
fn morph_targets_that_cannot_be_read_are_named_and_ignored() {
    let broken = |change: fn(&mut Model)| {
        let mut model = morphing(json!([1, 0]), json!(null));
        change(&mut model);
        let scene = model.read("bad_morph.glb");
        assert_eq!(lit(&scene, [MIDDLE, RIGHT]), [false, true]);
        let [warning] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
        assert!(warning.starts_with("mesh `lid`: morph targets ignored: "), "{warning}");
        warning.clone()
    };
    let few = broken(|model| model.json["accessors"][4]["count"] = json!(3));
    assert!(few.ends_with("a morph target has another number of vertices"), "{few}");
    broken(|model| model.json["meshes"][1]["weights"] = json!("x"));
    broken(|model| model.json["meshes"][1]["primitives"][0]["targets"] = json!({}));
    broken(|model| model.json["accessors"][4]["type"] = json!("VEC2"));
    // no memory for what a sparse target without a view claims
    broken(|model| {
        model.json["accessors"][4] =
            json!({ "componentType": 5126, "count": 4_000_000_000u32, "type": "VEC3" })
    });
}

/// A plate at the origin, held by two joints: one that stays, one that is moved.
struct Skinned {
    model: Model,
    node: usize,
    joints: [usize; 2],
}

/// The weights of the second joint for all corners, and the inverse bind matrices.
fn skinned(weight: f64, inverse: Option<[DMat4; 2]>) -> Skinned {
    let mut model = Model::new();
    let plate = model.plate("actor", &PLATE);
    let numbers = model.accessor(U8, "VEC4", &[0.0, 1.0, 0.0, 0.0].repeat(4));
    let weights = model.accessor(F32, "VEC4", &[1.0 - weight, weight, 0.0, 0.0].repeat(4));
    let attributes = &mut model.json["meshes"][plate]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(numbers);
    attributes["WEIGHTS_0"] = json!(weights);
    let joints = [json!({ "translation": [0, 2, 0] }), json!({ "translation": [6, 2, 0] })];
    let joints = joints.map(|joint| model.node(joint));
    let mut skin = json!({ "joints": joints });
    if let Some(inverse) = inverse {
        let numbers = inverse.map(|matrix| matrix.to_cols_array()).concat();
        skin["inverseBindMatrices"] = json!(model.accessor(F32, "MAT4", &numbers));
    }
    model.add("skins", skin);
    // the node's own transform is no use
    let node = json!({ "mesh": plate, "skin": 0, "translation": [-3, 1, 0], "scale": [9, 9, 9] });
    let node = model.node(node);
    Skinned { model, node, joints }
}

#[test]
fn skinned_meshes_are_posed_by_their_joints_and_not_placed_by_their_node() {
    for (weight, expected) in
        [(0.0, [false, true, true]), (1.0, [true, true, true]), (0.5, [true, false, true])]
    {
        let scene = skinned(weight, None).model.read("skin.glb");
        assert_eq!(scene.warnings, [""; 0]);
        assert_eq!(lit(&scene, [MIDDLE, RIGHT, LEFT]), expected, "{weight}");
        let middle = bounds(&scene);
        assert!(middle[1].x >= 6.0 * weight + 1.0);
    }
}

#[test]
fn inverse_bind_matrices_come_before_the_joints() {
    let matrices = [DVec3::ZERO, dvec3(-3.0, 0.0, 0.0)].map(DMat4::from_translation);
    let Skinned { mut model, joints, .. } = skinned(1.0, Some(matrices));
    assert_eq!(lit(&model.read("bind.glb"), [MIDDLE, RIGHT, LEFT]), [true, false, true]);
    model.json["nodes"][joints[1]]["scale"] = json!([2, 1, 2]);
    let scene = model.read("scaled_bind.glb");
    let xs = scene.meshes[1].positions.iter().map(|position| position.x);
    assert_eq!((xs.clone().reduce(f32::min), xs.reduce(f32::max)), (Some(-2.0), Some(2.0)));
}

#[test]
fn joints_may_be_under_other_nodes_hidden_or_outside_the_scene() {
    let points = [MIDDLE, RIGHT, LEFT];
    let Skinned { mut model, joints, .. } = skinned(1.0, None);
    model.json["nodes"][joints[1]]["extensions"] =
        json!({ "KHR_node_visibility": { "visible": false } });
    model.json["nodes"][joints[1]]["translation"] = json!([3, 2, 0]);
    assert_eq!(lit(&model.read("hidden_joint.glb"), points), [true, false, true]);

    let Skinned { mut model, joints, .. } = skinned(1.0, None);
    let parent = model.add("nodes", json!({ "children": [joints[1]], "translation": [-9, 0, 0] }));
    let nodes = model.json["scenes"][0]["nodes"].as_array_mut().unwrap();
    nodes.retain(|node| *node != json!(joints[1]));
    assert_eq!(parent, 5);
    assert_eq!(lit(&model.read("joint_outside.glb"), points), [true, true, false]);
}

#[test]
fn weights_of_any_sum_type_and_number_of_sets_are_scaled_to_one() {
    let points = [MIDDLE, RIGHT, LEFT];
    // half and half, as bytes that are no multiple of a half, in two sets
    let Skinned { mut model, .. } = skinned(0.0, None);
    let halves = model.accessor(U8, "VEC4", &[60.0, 0.0, 0.0, 0.0].repeat(4));
    let shorts = model.accessor(U16, "VEC4", &[15420.0, 0.0, 0.0, 0.0].repeat(4));
    for accessor in [halves, shorts] {
        model.json["accessors"][accessor]["normalized"] = json!(true);
    }
    let second = model.accessor(U16, "VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(4));
    let attributes = &mut model.json["meshes"][1]["primitives"][0]["attributes"];
    attributes["WEIGHTS_0"] = json!(halves);
    attributes["JOINTS_1"] = json!(second);
    attributes["WEIGHTS_1"] = json!(shorts);
    let scene = model.read("two_sets.glb");
    assert_eq!(lit(&scene, points), [true, false, true]);
    let xs = scene.meshes[1].positions.iter().map(|position| position.x);
    let (low, high) = (xs.clone().reduce(f32::min).unwrap(), xs.reduce(f32::max).unwrap());
    assert!((low - 2.0).abs() < 1e-5 && (high - 4.0).abs() < 1e-5, "{low} {high}");

    // without any weight the first joint holds the vertex
    let Skinned { mut model, .. } = skinned(0.0, None);
    let none = model.accessor(F32, "VEC4", &[0.0; 16]);
    model.json["meshes"][1]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(none);
    assert_eq!(lit(&model.read("no_weights.glb"), points), [false, true, true]);
}

#[test]
fn skins_that_mirror_keep_the_visible_side_and_turn_normals() {
    let Skinned { mut model, joints, .. } = skinned(0.0, None);
    model.json["nodes"][joints[0]]["scale"] = json!([-1, 1, 1]);
    let normals = model.vectors(&[[1.0, 1.0, 0.0]; 4]);
    model.json["meshes"][1]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    let scene = model.read("mirrored_skin.glb");
    let mesh = &scene.meshes[1];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        assert!((b - a).cross(c - a).y > 0.0);
    }
    assert!(mesh.normals.iter().all(|normal| normal.x < -0.7 && normal.y > 0.7));
}

#[test]
fn skins_that_cannot_be_used_are_named_and_shown_in_their_bind_pose() {
    let broken = |change: fn(&mut Skinned), fault: &str| {
        let mut skinned = skinned(0.5, None);
        change(&mut skinned);
        skinned.model.json["nodes"][skinned.node]["translation"] = json!([-3, 2, 0]);
        skinned.model.json["nodes"][skinned.node]["scale"] = json!([1, 1, 1]);
        let scene = skinned.model.read("bad_skin.glb");
        let [warning] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
        let start = "mesh `actor`: skin ignored, shown in its bind pose: ";
        assert!(warning.starts_with(start) && warning.contains(fault), "{warning}");
        assert_eq!(lit(&scene, [MIDDLE, LEFT]), [true, false]);
    };
    broken(|it| it.model.json["skins"][0]["joints"] = json!([3]), "there is no joint 1");
    broken(|it| it.model.json["skins"][0]["joints"] = json!([3, 99]), "there is no node 99");
    broken(|it| it.model.json["skins"] = json!([]), "skins[0] is not there");
    broken(
        |it| it.model.json["skins"][0]["inverseBindMatrices"] = json!(0),
        "its inverse bind matrices have an unexpected type",
    );
    broken(
        |it| {
            let attributes = &mut it.model.json["meshes"][1]["primitives"][0]["attributes"];
            attributes.as_object_mut().unwrap().remove("WEIGHTS_0");
        },
        "it has no joints and weights",
    );
}

#[test]
fn hidden_nodes_and_all_below_them_cast_no_shadow_and_shine_not() {
    let hidden = json!({ "KHR_node_visibility": { "visible": false } });
    let shown = json!({ "KHR_node_visibility": { "visible": true } });
    for (parent, child, expected) in [
        (json!({}), json!({}), false),
        (hidden.clone(), json!({}), true),
        (hidden.clone(), shown.clone(), true),
        (json!({}), hidden.clone(), true),
        (shown.clone(), shown, false),
        (json!({}), json!({ "KHR_node_visibility": {} }), false),
        (json!({}), json!({ "KHR_node_visibility": 3 }), false),
    ] {
        let mut model = Model::new();
        model.uses("KHR_node_visibility");
        let plate = model.plate("lid", &PLATE);
        let lid = model.add("nodes", json!({ "mesh": plate, "extensions": child }));
        model.node(
            json!({ "children": [lid], "translation": [0, 2, 0], "extensions": parent.clone() }),
        );
        let scene = model.read("hidden.glb");
        assert_eq!(lit(&scene, [MIDDLE]), [expected], "{parent} {child}");
        assert_eq!(scene.warnings, [""; 0]);
    }
    // lights are hidden too, cameras are not
    let mut model = Model::new();
    model.json["nodes"][1]["extensions"]["KHR_node_visibility"] = json!({ "visible": false });
    model.json["nodes"][1]["camera"] = json!(0);
    model.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1.0 } }]);
    let scene = model.read("hidden_light.glb");
    assert!(scene.lights.is_empty() && scene.camera.is_some());
}

#[test]
fn quantised_positions_of_every_type_cast_the_same_shadow() {
    for (component, normalized, unit) in [
        (I8, true, 127.0),
        (U8, true, 255.0),
        (I16, true, 32767.0),
        (U16, true, 65535.0),
        (I8, false, 1.0),
        (U8, false, 1.0),
        (I16, false, 1.0),
        (U16, false, 1.0),
        (5130, false, 1.0),
    ] {
        let mut model = Model::new();
        let plate = model.plate("box", &PLATE);
        // unsigned ones from 0 to 2 by way of the node
        let (low, scale, shift) = match component {
            U8 | U16 => (0.0, if normalized { 2.0 } else { 1.0 }, -1.0),
            _ => (-1.0, 1.0, 0.0),
        };
        let high = if low == 0.0 && !normalized { 2.0 } else { 1.0 };
        let place = |c: f32| if c > 0.0 { high * unit } else { low * unit };
        let mut elements = Vec::new();
        for [x, _, z] in PLATE {
            // elements begin at multiples of four bytes
            elements.extend(bytes(component, &[place(x), 0.0, place(z)]));
            elements.resize(elements.len().next_multiple_of(4), 0);
        }
        let view = model.view(&elements);
        model.json["bufferViews"][view]["byteStride"] = json!(elements.len() / 4);
        let accessor = json!({ "bufferView": view, "componentType": component, "count": 4,
            "type": "VEC3", "normalized": normalized });
        let accessor = model.add("accessors", accessor);
        let primitive = &mut model.json["meshes"][plate]["primitives"][0];
        primitive["attributes"]["POSITION"] = json!(accessor);
        model.requires("KHR_mesh_quantization");
        let node = json!({ "translation": [shift, 2, shift], "scale": [scale, 1, scale] });
        let scene = over(model, node, plate).read("quantised.glb");
        assert_eq!(scene.warnings, [""; 0]);
        let corner = scene.meshes[1].positions.iter().fold(glam::Vec3::MIN, |a, b| a.max(*b));
        assert!((corner - glam::vec3(1.0, 2.0, 1.0)).length() < 1e-6, "{component} {corner}");
        let points = [[1.9, 1.9], [2.1, 0.0], [-1.9, -1.9], [0.0, -2.1]];
        assert_eq!(lit(&scene, points), [false, true, false, true], "{component}");
    }
}

#[test]
fn normalised_integers_are_no_less_than_minus_one() {
    let mut model = Model::new();
    let plate = model.plate("box", &PLATE);
    let corners =
        PLATE.as_flattened().iter().map(|&c| if c < 0.0 { -128.0 } else { c as f64 * 127.0 });
    let corners: Vec<f64> = corners.collect();
    let accessor = model.accessor(I8, "VEC3", &corners);
    model.json["accessors"][accessor]["normalized"] = json!(true);
    let primitive = &mut model.json["meshes"][plate]["primitives"][0];
    primitive["attributes"]["POSITION"] = json!(accessor);
    let scene = over(model, json!({ "translation": [0, 2, 0] }), plate).read("least.glb");
    assert!(scene.meshes[1].positions.iter().all(|p| p.x.abs() == 1.0 && p.z.abs() == 1.0));
}

#[test]
fn positions_without_a_view_are_zeros_that_sparse_ones_replace() {
    let zeros = json!({ "componentType": 5126, "count": 4, "type": "VEC3" });
    let mut model = Model::new();
    let plate = model.plate("placeholder", &PLATE);
    model.json["accessors"][2] = zeros.clone();
    let scene = over(model, json!({ "translation": [0, 2, 0] }), plate).read("zeros.glb");
    assert_eq!(scene.meshes[1].triangles.len(), 2);
    assert_eq!(lit(&scene, [MIDDLE, RIGHT]), [true, true]);

    for component in [U8, U16, 5125] {
        let mut model = Model::new();
        let plate = model.plate("sparse", &PLATE);
        let all = model.view(&bytes(component, &[0.0, 1.0, 2.0, 3.0]));
        let values: Vec<f64> = PLATE.as_flattened().iter().map(|&c| c.into()).collect();
        let values = model.view(&bytes(F32, &values));
        model.json["accessors"][2] = zeros.clone();
        model.json["accessors"][2]["sparse"] = json!({ "count": 4, "values": { "bufferView": values },
            "indices": { "bufferView": all, "componentType": component } });
        let scene = over(model, json!({ "translation": [0, 2, 0] }), plate).read("sparse0.glb");
        assert_eq!(lit(&scene, [MIDDLE, RIGHT]), [false, true], "{component}");
    }
}

#[test]
fn sparse_indices_out_of_range_are_an_error() {
    let mut model = Model::new();
    let (indices, values) = (model.view(&[4, 0]), model.view(&[0; 12]));
    model.json["accessors"][0]["sparse"] = json!({ "count": 1, "values": { "bufferView": values },
        "indices": { "bufferView": indices, "componentType": 5123 } });
    let message = model.error("sparse_range.glb");
    let fault = "mesh `floor`: its positions have a sparse index out of range; ";
    assert!(message.contains(fault), "{message}");
}
