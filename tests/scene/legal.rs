//! glTF files whose other parts shadows never read, whatever these are, and warnings about what
//! would change the geometry.

use serde_json::{Value, json};

use crate::model::{Model, PLATE, lit};
use crate::{error, file};

/// What a test does to a document.
type Change = fn(&mut Value);

/// A part of a document.
type Part = fn(&mut Value) -> &mut Value;

/// A floor and a lid under a light, and how the lid's shadow lies.
fn model() -> Model {
    let mut model = Model::new();
    let lid = model.plate("lid", &PLATE);
    model.node(json!({ "mesh": lid, "translation": [0, 2, 0] }));
    model
}

fn assert_shadow(model: &Model, name: &str, warnings: &[&str]) {
    let scene = model.read(name);
    assert_eq!(scene.warnings, warnings, "{name}");
    assert_eq!(lit(&scene, [[0.5, 0.5], [6.5, 0.5]]), [false, true], "{name}");
}

#[test]
fn parts_that_shadows_never_read_may_be_anything() {
    let cases: [(&str, Change); 26] = [
        ("texture_without_source", |it| it["textures"] = json!([{}, { "sampler": 9 }])),
        ("texture_of_later", |it| {
            it["textures"] = json!([{ "extensions": { "KHR_texture_basisu": { "source": 0 } } }])
        }),
        ("image_type", |it| it["images"] = json!([{ "mimeType": "image/ktx2", "bufferView": 77 }])),
        ("image_gone", |it| it["images"] = json!([{ "uri": "gone.avif" }, { "uri": 7 }])),
        ("sampler", |it| it["samplers"] = json!([{ "wrapS": 1, "magFilter": "x" }])),
        ("animation", |it| {
            it["animations"] = json!([{ "channels": [{ "sampler": 0, "target": {
                "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": "/x" } } } }],
                "samplers": [{ "input": 99, "output": 98, "interpolation": "LATER" }] }])
        }),
        ("animation_object", |it| it["animations"] = json!({ "run": 1 })),
        ("camera", |it| it["cameras"] = json!([{ "type": "fisheye" }, 7])),
        ("material", |it| it["materials"] = json!([{ "alphaMode": 4, "extensions": 7 }, "x"])),
        ("skin", |it| it["skins"] = json!([{ "joints": "all" }])),
        ("other_mesh", |it| {
            let meshes = it["meshes"].as_array_mut().unwrap();
            meshes.push(json!({ "primitives": [{ "attributes": { "POSITION": 99 } }] }))
        }),
        ("other_node", |it| it["nodes"].as_array_mut().unwrap().push(json!({ "mesh": "none" }))),
        ("accessor", |it| {
            let accessors = it["accessors"].as_array_mut().unwrap();
            accessors.push(json!({ "componentType": 5131, "count": -1, "type": "VEC9" }))
        }),
        ("view", |it| {
            it["bufferViews"].as_array_mut().unwrap().push(json!({ "buffer": 5, "target": 1 }))
        }),
        ("buffer_gone", |it| {
            it["buffers"] =
                json!([{}, { "uri": "gone.bin", "byteLength": 9 }, { "byteLength": 1e30 }])
        }),
        ("buffer_short", |it| {
            it["buffers"] = json!([{}, { "uri": "data:;base64,AAAA", "byteLength": 1000 }])
        }),
        ("extras", |it| {
            it["extras"] = json!([1, "x", null]);
            it["nodes"][0]["extras"] = json!(7);
            it["asset"]["extras"] = json!(false)
        }),
        ("attribute", |it| {
            let attributes = &mut it["meshes"][0]["primitives"][0]["attributes"];
            attributes["TEXCOORD_9"] = json!(1000);
            attributes["TANGENT"] = json!(0);
            attributes["COLOR_77"] = json!(1);
            attributes["FEATURE_ID_0"] = json!(2);
            attributes["_x"] = json!(3)
        }),
        ("extension_objects", |it| {
            it["extensions"]["FOO"] = json!([[]]);
            it["meshes"][0]["primitives"][0]["extensions"] = json!({ "KHR_materials_variants": 1 });
            it["meshes"][0]["extensions"] = json!({ "FOO": 1 });
            it["bufferViews"][0]["extensions"] = json!({ "FOO": 1 });
            it["accessors"][0]["extensions"] = json!({ "FOO": 1 });
            it["nodes"][0]["extensions"] = json!({ "FOO": 1 })
        }),
        ("bounds", |it| {
            it["accessors"][0]["min"] = json!(["x"]);
            it["accessors"][1]["max"] = json!([])
        }),
        ("target", |it| it["bufferViews"][0]["target"] = json!("x")),
        ("name", |it| it["scenes"][0]["name"] = json!(7)),
        ("version", |it| it["asset"] = json!({ "version": "2.1", "minVersion": "2.0" })),
        ("light", |it| {
            let lights = &mut it["extensions"]["KHR_lights_punctual"]["lights"];
            lights.as_array_mut().unwrap().push(json!({ "type": 3 }))
        }),
        ("no_scene_name", |it| it["scene"] = json!(null)),
        ("top_level", |it| it["somethingElse"] = json!({ "a": [1, { "b": null }] })),
    ];
    for (name, change) in cases {
        let mut model = model();
        change(&mut model.json);
        assert_shadow(&model, &format!("legal_{name}.glb"), &[]);
    }
}

#[test]
fn extras_may_be_nested_as_deep_as_they_like() {
    let mut model = model();
    model.json["extras"] = json!("deep");
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    let text = model.json.to_string().replace("\"deep\"", &deep);
    let glb = crate::gltf_files::glb_with(
        &text.replace(
            "\"asset\"",
            &format!("\"buffers\":[{{\"byteLength\":{}}}],\"asset\"", model.bin.len()),
        ),
        &model.bin,
    );
    let scene = crate::read(&file("deep.glb", glb));
    assert_eq!(scene.triangle_count(), 4);
}

#[test]
fn primitives_without_triangles_are_skipped_and_counted() {
    let mut model = model();
    let mesh = &mut model.json["meshes"][0]["primitives"];
    let primitives = mesh.as_array_mut().unwrap();
    primitives.push(json!({ "attributes": {} }));
    primitives.push(json!({ "attributes": { "NORMAL": 0 }, "indices": 1 }));
    primitives.push(json!({}));
    primitives.push(json!({ "attributes": { "POSITION": 99 }, "mode": 7 }));
    primitives.push(json!({ "attributes": { "POSITION": 99 }, "mode": 1 }));
    primitives.push(json!({ "attributes": { "POSITION": 99 }, "mode": 0,
        "extensions": { "KHR_gaussian_splatting": {} } }));
    let warnings = [
        "2 point or line primitives skipped",
        "1 primitives of an unknown mode skipped",
        "3 primitives without positions skipped",
    ];
    assert_shadow(&model, "skipped.glb", &warnings);
}

#[test]
fn unknown_kinds_of_lights_and_odd_cameras_are_named() {
    let mut model = model();
    let lights = model.json["extensions"]["KHR_lights_punctual"]["lights"].as_array_mut().unwrap();
    lights.push(json!({ "type": "area", "width": 2 }));
    lights.push(json!({ "type": "tube" }));
    lights.push(json!({ "colour": [1, 1, 1] }));
    for light in 1..=4 {
        model.node(json!({ "extensions": { "KHR_lights_punctual": { "light": light } } }));
    }
    model.json["cameras"] = json!([{ "type": "fisheye" }]);
    model.node(json!({ "camera": 0 }));
    model.node(json!({ "camera": 12 }));
    let warnings = [
        "a light was skipped: missing field `type`",
        "a light was skipped: there is no light 4",
        "a camera without a usable perspective was skipped",
        "a camera without a usable perspective was skipped",
        "2 lights of an unknown kind, as `area`, skipped",
    ];
    assert_shadow(&model, "unknown_lights.glb", &warnings);
}

#[test]
fn unread_extensions_that_may_change_geometry_are_named_once() {
    let mut model = model();
    for name in [
        "KHR_materials_unlit",
        "KHR_texture_basisu",
        "EXT_texture_avif",
        "KHR_animation_pointer",
        "KHR_xmp_json_ld",
        "EXT_structural_metadata",
        "FOO_bent_space",
        "KHR_materials_displacement",
        "EXT_mesh_primitive_restart",
        "FOO_bent_space",
    ] {
        model.uses(name);
    }
    let warnings = ["FOO_bent_space", "KHR_materials_displacement", "EXT_mesh_primitive_restart"]
        .map(|name| format!("extension `{name}` is not read: what it changes is not shown"));
    let warnings = warnings.each_ref().map(String::as_str);
    assert_shadow(&model, "extensions.glb", &warnings);
    // required is no error where the meshes can be had
    model.json["extensionsRequired"] = json!(["FOO_bent_space", "KHR_texture_basisu"]);
    assert_shadow(&model, "required.glb", &warnings);
}

#[test]
fn required_extensions_that_a_mesh_needs_are_an_error() {
    let place: [(&str, Part); 4] = [
        ("primitive", |it| &mut it["meshes"][1]["primitives"][0]),
        ("accessor", |it| &mut it["accessors"][2]),
        ("view", |it| &mut it["bufferViews"][2]),
        ("buffer", |it| &mut it["buffers"][1]),
    ];
    for (name, part) in place {
        let mut model = model();
        model.requires("FOO_packed");
        if name == "buffer" {
            model.json["buffers"] = json!([{}, { "uri": "gone.bin", "byteLength": 48 }]);
            model.json["bufferViews"][2]["buffer"] = json!(1);
        }
        part(&mut model.json)["extensions"] = json!({ "FOO_packed": { "bufferView": 0 } });
        let message = model.error(&format!("needs_{name}.glb"));
        let expected = "requires the glTF extension `FOO_packed`, which is not supported; \
                        export it without";
        assert!(message.ends_with(expected), "{message}");
    }
}

#[test]
fn parts_that_a_mesh_needs_are_named_when_they_are_broken() {
    let cases: [(&str, Change); 12] = [
        ("mesh `lid`: accessors[9] is not there: there are 4", |it| {
            it["meshes"][1]["primitives"][0]["attributes"]["POSITION"] = json!(9)
        }),
        ("mesh `lid`: accessors[2]: missing field `count`", |it| {
            it["accessors"][2].as_object_mut().unwrap().remove("count");
        }),
        ("mesh `lid`: accessors[2]: invalid value: integer `-1`, expected usize", |it| {
            it["accessors"][2]["count"] = json!(-1)
        }),
        ("mesh `lid`: bufferViews[7] is not there: there are 4", |it| {
            it["accessors"][2]["bufferView"] = json!(7)
        }),
        ("mesh `lid`: its positions have an unexpected type", |it| {
            it["accessors"][2]["type"] = json!("VEC4")
        }),
        ("mesh `lid`: its positions have an unexpected type", |it| {
            it["accessors"][2]["componentType"] = json!(5131)
        }),
        ("mesh `lid`: its indices have an unexpected type", |it| {
            it["accessors"][3]["componentType"] = json!(5122)
        }),
        ("mesh `lid`: its indices lie outside their buffer", |it| {
            it["accessors"][3]["byteOffset"] = json!(2)
        }),
        ("mesh `lid`: buffers[3] is not there: there are 1", |it| {
            it["bufferViews"][2]["buffer"] = json!(3)
        }),
        ("mesh `lid`: materials[0] is not there: there are 0", |it| {
            it["meshes"][1]["primitives"][0]["material"] = json!(0)
        }),
        ("meshes[8] is not there: there are 2", |it| it["nodes"][2]["mesh"] = json!(8)),
        ("scenes[4] is not there: there are 1", |it| it["scene"] = json!(4)),
    ];
    for (i, (fault, change)) in cases.into_iter().enumerate() {
        let mut model = model();
        change(&mut model.json);
        let message = model.error(&format!("broken_{i}.glb"));
        let expected =
            format!("`broken_{i}.glb`: {fault}; export it again, or check it with a validator");
        assert_eq!(message, expected);
    }
}

#[test]
fn older_and_later_versions_are_named() {
    for (version, name) in [("1.0", "one.gltf"), ("3.0", "three.gltf")] {
        let text = format!(r#"{{"asset": {{"version": "{version}"}}, "meshes": {{"a": {{}}}}}}"#);
        let message = error(&file(name, text));
        let fault = format!("`{name}`: it is glTF {version}: convert it to glTF 2.0; ");
        assert!(message.starts_with(&fault), "{message}");
    }
    let mut glb = model().glb();
    glb[4] = 1;
    let message = error(&file("one.glb", glb));
    assert!(
        message.starts_with("`one.glb`: it is glTF 1.0: convert it to glTF 2.0; "),
        "{message}"
    );
}
