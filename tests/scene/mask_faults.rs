//! Masks of glTF materials with something wrong or missing.

use crate::gltf_files::glb_with;
use crate::masks::{EMBEDDED, File, MASKED, buffer, masked, mesh, mesh_of, png};
use crate::{assert_valid, error, file, read};

#[test]
fn images_that_cannot_be_had_are_named_with_the_remedy() {
    let message = File { image: r#""uri": "gone.png""#, ..masked(&[]) }.error("gone.glb");
    let start = "`gone.glb` needs the image `gone.png` for the mask of mesh `x`: ";
    assert!(message.starts_with(start), "{message}");
    let end = "; put a PNG, JPEG or WebP where the file expects it, or export a .glb, which holds its images";
    assert!(message.ends_with(end), "{message}");

    let no_picture = masked(b"no picture").error("text.glb");
    assert!(no_picture.contains("the image `0` for the mask of mesh `x`: "), "{no_picture}");
    let named = format!(r#"{EMBEDDED}, "name": "holes""#);
    let image = png(64, &[7; 64 * 64]);
    let cut = File { image: &named, ..masked(&image[..image.len() / 2]) }.error("cut.glb");
    assert!(cut.contains("the image `holes` for"), "{cut}");
    let outside = masked(&image).json().replace("\"byteOffset\": 96", "\"byteOffset\": 1e9");
    let outside = outside.replace("1e9", "1000000000");
    let outside = error(&file("outside.glb", glb_with(&outside, &buffer(&image))));
    assert!(outside.contains("it lies outside its buffer"), "{outside}");
    let inline = r#""uri": "data:image/png;base64,!""#;
    let inline = File { image: inline, ..masked(&[]) }.error("inline.glb");
    assert!(inline.contains("the image `0` for"), "{inline}");
}

#[test]
fn every_cut_and_changed_byte_of_an_image_gives_an_error_or_a_valid_scene() {
    let image = png(4, &[255, 0, 1, 254, 9, 90, 190, 250]);
    for i in 0..image.len() {
        let mut changed = image.clone();
        changed[i] ^= 0x41;
        for bytes in [&image[..i], &changed] {
            let path = file("changed.glb", glb_with(&masked(bytes).json(), &buffer(bytes)));
            if let Ok(scene) = dpsm::scene::open(path.to_str().unwrap(), &Default::default()) {
                assert_valid(&scene);
            }
        }
    }
}

#[test]
fn what_is_not_honoured_is_a_warning() {
    let image = png(2, &[255, 0, 0, 255]);
    let blend = MASKED.replace("MASK", "BLEND");
    let scene = File { material: &blend, ..masked(&image) }.read("blend.glb");
    assert_eq!(mesh_of(&scene), (true, 0));
    assert_eq!(scene.warnings, ["mesh `x`: alphaMode BLEND is not supported, so it is opaque"]);

    let clamped = r#""wrapS": 33071"#;
    let scene = File { sampler: clamped, ..masked(&image) }.read("clamped.glb");
    let what = "mesh `x`: its mask repeats, although the file wraps it another way";
    assert_eq!(scene.warnings, [what]);

    let scene = File { attributes: r#""TEXCOORD_1": 2"#, ..masked(&image) }.read("no_set.glb");
    assert_eq!(mesh_of(&scene), (true, 0));
    let what = "mesh `x`: its mask has no texture coordinates, so it is opaque";
    assert_eq!(scene.warnings, [what]);

    let colors = r#""TEXCOORD_0": 1, "COLOR_0": 0"#;
    let scene = File { attributes: colors, ..masked(&image) }.read("colors.glb");
    assert!(mesh(&scene).mask.is_some());
    let what = "1 masked primitives have vertex colours, whose alpha is ignored";
    assert_eq!(scene.warnings, [what]);
}

#[test]
fn unusable_texture_coordinates_are_counted_or_refused() {
    let image = png(2, &[255, 0, 0, 255]);
    let mut bytes = buffer(&image);
    bytes[48..52].copy_from_slice(&f32::NAN.to_le_bytes());
    let scene = read(&file("nan.glb", glb_with(&masked(&image).json(), &bytes)));
    assert_valid(&scene);
    // the corner belongs to both triangles, which have face normals and so vertices of their own
    let what = "mesh `x`: 2 vertices have no usable texture coordinates: opaque around them";
    assert_eq!(scene.warnings, [what]);
    assert!(mesh(&scene).opaque(0, [0.9, 0.05, 0.05]) && mesh(&scene).opaque(1, [0.1, 0.1, 0.8]));

    let positions = File { attributes: r#""TEXCOORD_0": 0"#, ..masked(&image) };
    let message = positions.error("type.glb");
    let what = "mesh `x`: its texture coordinates have an unexpected type";
    assert!(message.contains(what), "{message}");
    let few = masked(&image)
        .json()
        .replace("\"count\": 4, \"type\": \"VEC2\"}", "\"count\": 9, \"type\": \"VEC2\"}");
    let message = error(&file("far.glb", glb_with(&few, &buffer(&image))));
    assert!(message.contains("its texture coordinates lie outside their buffer"), "{message}");
}
