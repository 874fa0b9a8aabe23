//! glTF files with something wrong or missing.

use crate::gltf_files::{NODE, STRIP, buffer, glb, json};
use crate::{assert_valid, error, file, read};

#[test]
fn text_file_reads_its_buffer_from_beside_it() {
    file("square.bin", buffer());
    let with_uri = |uri: &str| {
        let member = format!(r#"{{"uri": "{uri}", "byteLength": 164}}"#);
        json(STRIP, NODE, "").replace(r#"{"byteLength": 164}"#, &member)
    };
    assert_eq!(read(&file("external.gltf", with_uri("square.bin"))).triangle_count(), 2);

    let missing = error(&file("missing.gltf", with_uri("gone.bin")));
    assert!(missing.starts_with("`missing.gltf` needs the buffer `gone.bin`: "), "{missing}");
    assert!(missing.ends_with("or export a .glb, which holds its buffers"), "{missing}");
    file("short.bin", &buffer()[..40]);
    let short = error(&file("short.gltf", with_uri("short.bin")));
    assert!(short.contains("`short.bin`: it has 40 bytes of 164; "), "{short}");
    let odd = error(&file("odd.gltf", with_uri("%ff.bin")));
    assert!(odd.contains("the buffer `%ff.bin`: "), "{odd}");
}

#[test]
fn broken_files_are_errors_that_name_the_fault() {
    let text = error(&file("text.gltf", r#"{"asset": "#));
    assert!(text.starts_with("`text.gltf`: EOF while parsing"), "{text}");
    let required = r#", "extensionsRequired": ["FOO_packed"]"#;
    let packed = STRIP.replace(r#"{"att"#, r#"{"extensions": {"FOO_packed": {}}, "att"#);
    assert_eq!(
        error(&file("packed.glb", glb(&json(&packed, NODE, required)))),
        "`packed.glb` requires the glTF extension `FOO_packed`, which is not supported; \
         export it without"
    );
    for (name, from, to, what) in [
        (
            "far.glb",
            r#""byteOffset": 0,"#,
            r#""byteOffset": 120,"#,
            "`x`: its positions lie outside",
        ),
        (
            "type.glb",
            r#"5123, "count": 4"#,
            r#"5126, "count": 4"#,
            "`x`: its indices have an unexpected",
        ),
        (
            "count.glb",
            r#"5126, "count": 4"#,
            r#"5126, "count": 0"#,
            "`x`: its positions have the length 0",
        ),
        ("node.glb", r#""nodes": [0]"#, r#""nodes": [7]"#, "nodes[7] is not there: there are 1"),
    ] {
        let broken = json(STRIP, NODE, "").replacen(from, to, 1);
        let message = error(&file(name, glb(&broken)));
        assert!(message.contains(what), "{message}");
        assert!(message.ends_with("; export it again, or check it with a validator"), "{message}");
    }
    let empty = error(&file("no_mesh.glb", glb(&json(STRIP, "{}", ""))));
    assert_eq!(
        empty,
        "`no_mesh.glb` has no triangles, only 1 meshes and 0 nodes that use one; \
         export its meshes as triangles"
    );
}

#[test]
fn every_truncation_is_an_error() {
    let whole = glb(&json(STRIP, NODE, ""));
    for length in 1..whole.len() {
        let message = error(&file("truncated.glb", &whole[..length]));
        assert!(message.starts_with("`truncated.glb`: "), "{length}: {message}");
    }
}

#[test]
fn every_changed_byte_gives_an_error_or_a_valid_scene() {
    let whole = glb(&json(STRIP, NODE, ""));
    let mut read = 0;
    for i in 0..whole.len() {
        let mut changed = whole.clone();
        // A digit for a digit keeps the JSON readable and its numbers wrong.
        changed[i] = if changed[i] == b'9' { b'0' } else { b'9' };
        let path = file("changed.glb", changed);
        if let Ok(scene) = dpsm::scene::open(path.to_str().unwrap(), &Default::default()) {
            assert_valid(&scene);
            read += 1;
        }
    }
    assert!(read > 0 && read < whole.len());
}
