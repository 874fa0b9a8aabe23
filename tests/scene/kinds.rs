//! Files that are something else than their name says.

use crate::model::Model;
use crate::{error, file, read};

#[test]
fn text_saved_as_glb_and_binary_saved_as_gltf_are_read_as_what_they_are() {
    let model = Model::new();
    assert_eq!(read(&file("binary.gltf", model.glb())).triangle_count(), 2);
    file("beside.bin", &model.bin);
    let mut json = model.json.clone();
    let length = model.bin.len();
    json["buffers"] = serde_json::json!([{ "uri": "beside.bin", "byteLength": length }]);
    let text = format!("\u{feff}\r\n {json}");
    assert_eq!(read(&file("text.glb", &text)).triangle_count(), 2);
    assert_eq!(read(&file("text.gltf", &text)).triangle_count(), 2);
}

#[test]
fn other_kinds_of_files_are_named_with_a_remedy() {
    let glb = Model::new().glb();
    for (start, kind, remedy) in [
        (&b"<!DOCTYPE html>\n<html>"[..], "a web page", "download the file itself"),
        (b"\n  <HTML><body>404", "a web page", "download the file itself"),
        (b"<?xml version=\"1.0\"?><Error/>", "an XML or HTML file", "download the file itself"),
        (b"<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"\">", "a COLLADA file", "convert it"),
        (b"version https://git-lfs.github.com/spec/v1\noid", "a Git LFS pointer", "`git lfs pull`"),
        (b"\x1f\x8b\x08\0", "a gzip archive", "unpack it"),
        (b"PK\x03\x04\x14", "a ZIP archive", "unpack it"),
        (b"\x28\xb5\x2f\xfd", "a Zstandard archive", "unpack it"),
        (b"Kaydara FBX Binary  \0", "an FBX file", "convert it to .glb"),
        (b"; FBX 7.3.0 project file", "an FBX file", "convert it to .glb"),
        (b"BLENDER-v300", "a Blender file", "export it from Blender"),
        (b"ply\nformat ascii 1.0", "a PLY file", "convert it to .glb"),
        (b"solid cube\nfacet", "an STL file", "convert it to .glb"),
        (b"#usda 1.0", "a USD file", "convert it to .glb"),
        (b"b3dm\x01\0\0\0", "a 3D Tiles model", "convert it to .glb"),
        (b"\x89PNG\r\n\x1a\n", "a PNG picture", "give the model's own file"),
        (b"\xff\xd8\xff\xe0", "a JPEG picture", "give the model's own file"),
        (b"%PDF-1.7", "a PDF document", "give the model's own file"),
    ] {
        for (name, expected) in
            [("kind.glb", "a glTF file"), ("kind.gltf", "a glTF file"), ("kind.obj", "an OBJ file")]
        {
            let message = error(&file(name, start));
            let begin = format!("`{name}` is {kind}, not {expected}; ");
            assert!(message.starts_with(&begin), "{message}");
            assert!(message.contains(remedy), "{message}");
        }
    }
    let obj = error(&file("glb.obj", glb));
    assert_eq!(obj, "`glb.obj` is a glTF file, not an OBJ file; rename it to .glb or .gltf");
    let gltf = error(&file("obj.gltf", "# c\no a\nv 0 0 0\n"));
    assert_eq!(gltf, "`obj.gltf` is an OBJ file, not a glTF file; rename it to .obj");
}

#[test]
fn files_of_no_known_kind_are_shown_by_their_beginning() {
    for (content, shown) in [("hello, world", "\"hello, world\""), ("[1, 2]", "\"[1, 2]\"")] {
        let message = error(&file("unknown.glb", content));
        let expected =
            format!("`unknown.glb`: it is neither binary glTF nor JSON: it begins with {shown}; ");
        assert!(message.starts_with(&expected), "{message}");
    }
    let utf16 = [0xff, 0xfe, b'{', 0, b'}', 0];
    let message = error(&file("utf16.gltf", utf16));
    assert!(message.contains("it is text in UTF-16, and glTF is UTF-8"), "{message}");
    let object = error(&file("object.gltf", "{\"a\": 1}"));
    assert!(object.contains("it has no `asset`, so it is no glTF"), "{object}");
}
