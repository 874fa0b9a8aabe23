//! Files that others name, and what a small file may ask for.

use std::sync::Arc;

use crate::gltf_files::{NODE, STRIP, glb, glb_with, json};
use crate::masks::{EMBEDDED, File, MASKED, buffer, masked, png};
use crate::{assert_valid, error, file, read};

#[test]
#[cfg(unix)]
fn devices_and_folders_that_a_file_names_are_refused() {
    // read to its end, either would take all memory
    let zeros = "mtllib /dev/zero\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let scene = read(&file("zeros.obj", zeros));
    let warning = "material library `/dev/zero` cannot be read (it is no regular file): \
                   its materials are grey";
    assert_eq!(scene.warnings, [warning]);
    for uri in ["/dev/zero", "file:///dev/zero", "file:/dev/zero", "%2fdev%2fzero", "."] {
        let member = format!(r#"{{"uri": "{uri}", "byteLength": 164}}"#);
        let buffer = json(STRIP, NODE, "").replace(r#"{"byteLength": 164}"#, &member);
        let message = error(&file("zeros.gltf", buffer));
        assert!(message.contains(&format!("`{uri}`: it is no regular file; ")), "{message}");
        let image = format!(r#""uri": "{uri}""#);
        let message = File { image: &image, ..masked(&[]) }.error("zeros.glb");
        assert!(message.contains("mesh `x`: it is no regular file; "), "{message}");
    }
}

#[test]
fn names_with_a_percent_sign_that_escapes_nothing_are_names() {
    let image = png(2, &[255, 0, 0, 255]);
    file("50%.png", &image);
    let scene = File { image: r#""uri": "50%.png""#, ..masked(&[]) }.read("percent.glb");
    assert!(scene.meshes[0].mask.is_some());
}

/// (10 2^62 + 23) / 63 elements beyond the first, 252 bytes apart, end at byte 92 in arithmetic that
/// wraps at 2^64, as release builds' does. The crate would reserve room for them all, and abort.
#[test]
fn sparse_accessors_of_more_elements_than_bytes_lie_outside_their_buffer() {
    let sparse = r#", "sparse": {"count": 1, "values": {"bufferView": 1},
        "indices": {"bufferView": 3, "componentType": 5123}}}"#;
    let claimed = json(STRIP, NODE, "")
        .replacen("\"max\": [1, 1, 0]}", &format!("\"max\": [1, 1, 0]{sparse}"), 1)
        .replacen("\"byteLength\": 48}", "\"byteLength\": 164, \"byteStride\": 252}", 1)
        .replacen("\"count\": 4", "\"count\": 732013653718633002", 1);
    let message = error(&file("wrapped.glb", glb(&claimed)));
    assert!(message.contains("mesh `x`: its positions lie outside their buffer"), "{message}");
}

#[test]
fn images_beyond_the_largest_texture_are_refused() {
    let wide = |width: u32| {
        let alpha: Vec<u8> = (0..width).map(|x| if x % 2 == 0 { 255 } else { 0 }).collect();
        png(width, &alpha)
    };
    assert!(masked(&wide(8192)).read("wide.glb").meshes[0].mask.is_some());
    let message = masked(&wide(8193)).error("wider.glb");
    assert!(message.contains("the image `0` for the mask of mesh `x`: "), "{message}");
}

/// The start of a PNG of 8192 x 8192 texels, enough to tell its size.
fn huge() -> Vec<u8> {
    let mut bytes = png(2, &[255, 0, 0, 255]);
    bytes[16..24].copy_from_slice(&[0, 0, 32, 0, 0, 0, 32, 0]);
    // the checksum of PNG's second edition, annex D, a bit at a time
    let crc = bytes[12..29].iter().fold(u32::MAX, |crc, &byte| {
        let step = |crc: u32, _| (crc >> 1) ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 };
        (0..8).fold(crc ^ u32::from(byte), step)
    });
    bytes[29..33].copy_from_slice(&(!crc).to_be_bytes());
    bytes
}

#[test]
fn masks_of_more_texels_in_all_than_sixteen_of_the_largest_are_refused() {
    let huge = huge();
    let with = |count: usize| {
        let image = format!(r#""images": [{{{EMBEDDED}}}"#);
        let texture = r#""textures": [{"source": 0, "sampler": 0}"#;
        let material = format!(r#""materials": [{{{MASKED}}}"#);
        let mut json = masked(&huge).json();
        for i in 1..count {
            let more = |json: &str, first: &str, another: &str| {
                assert!(json.contains(first), "{first}");
                json.replace(first, &format!("{first}, {another}"))
            };
            json = more(&json, &image, &format!("{{{EMBEDDED}}}"));
            json = more(&json, texture, &format!(r#"{{"source": {i}, "sampler": 0}}"#));
            let other = MASKED.replace("\"index\": 0", &format!("\"index\": {}", count - i));
            json = more(&json, &material, &format!("{{{other}}}"));
        }
        error(&file("texels.glb", glb_with(&json, &buffer(&huge))))
    };
    // there is no more of the image than its start, which is said where it is needed
    assert!(with(16).contains("the image `0` for the mask of mesh `x`: "), "{}", with(16));
    let message = with(17);
    let what = "its masks have 1140850688 texels, and may have 1073741824";
    assert!(message.contains(what), "{message}");
}

#[test]
fn meshes_of_one_image_share_its_alphas() {
    let image = png(2, &[255, 0, 0, 255]);
    let one = r#"{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "mode": 6, "material": 0}"#;
    let file_of = File { material: MASKED, ..masked(&image) };
    let two = file_of.json().replace(one, &format!("{one}, {one}"));
    let scene = read(&file("two.glb", glb_with(&two, &buffer(&image))));
    assert_valid(&scene);
    let [a, b] = &scene.meshes[..] else { panic!("{} meshes", scene.meshes.len()) };
    assert!(Arc::ptr_eq(&a.mask.as_ref().unwrap().alpha, &b.mask.as_ref().unwrap().alpha));
}
