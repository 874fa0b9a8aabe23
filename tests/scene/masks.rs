//! Alpha masks: of glTF materials, and read at texture coordinates.

use std::io::Cursor;

use dpsm::scene::{Mask, Mesh, Scene};
use glam::{Vec2, vec2};
use image::{DynamicImage, ImageFormat, RgbaImage};

use crate::gltf_files::glb_with;
use crate::{assert_valid, error, file, read};

/// A picture of these alphas, row by row.
fn picture(width: u32, alpha: &[u8]) -> DynamicImage {
    let bytes = alpha.iter().flat_map(|&alpha| [10, 20, 30, alpha]).collect();
    RgbaImage::from_raw(width, alpha.len() as u32 / width, bytes).unwrap().into()
}

fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

pub(crate) fn png(width: u32, alpha: &[u8]) -> Vec<u8> {
    encoded(&picture(width, alpha), ImageFormat::Png)
}

/// Texture coordinates of the square's corners, set 0.
const CORNERS: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// A square with two sets of texture coordinates, and then an image; a multiple of 4 bytes.
pub(crate) fn buffer(image: &[u8]) -> Vec<u8> {
    let square = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let floats = square.into_iter().flatten().chain(CORNERS.into_iter().flatten());
    let mut bytes: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
    // set 1: bytes that stand for 0, 0.2, 0.4, ... of 1, each pair filled up to four bytes
    bytes.extend((0..4u8).flat_map(|i| [102 * (i % 3), 51 * i, 0, 0]));
    bytes.extend(image);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes
}

/// What varies in the file.
pub(crate) struct File<'a> {
    pub attributes: &'a str,
    pub material: &'a str,
    pub image: &'a str,
    pub sampler: &'a str,
    pub bytes: &'a [u8],
}

pub(crate) const EMBEDDED: &str = r#""bufferView": 3, "mimeType": "image/png""#;
pub(crate) const MASKED: &str =
    r#""alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}"#;

pub(crate) fn masked(bytes: &[u8]) -> File<'_> {
    File { attributes: r#""TEXCOORD_0": 1"#, material: MASKED, image: EMBEDDED, sampler: "", bytes }
}

impl File<'_> {
    pub fn json(&self) -> String {
        let Self { attributes, material, image, sampler, bytes } = self;
        let length = buffer(bytes).len();
        let image_length = bytes.len().max(1);
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}],
"extensionsUsed": ["KHR_texture_transform"],
"buffers": [{{"byteLength": {length}}}],
"bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 32}},
  {{"buffer": 0, "byteOffset": 80, "byteLength": 16, "byteStride": 4}},
  {{"buffer": 0, "byteOffset": 96, "byteLength": {image_length}}}],
"accessors": [
  {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}},
  {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}},
  {{"bufferView": 2, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC2"}}],
"meshes": [{{"name": "x", "primitives": [{{"attributes": {{"POSITION": 0, {attributes}}}, "mode": 6, "material": 0}}]}}],
"materials": [{{{material}}}], "textures": [{{"source": 0, "sampler": 0}}],
"samplers": [{{{sampler}}}], "images": [{{{image}}}]}}"#
        )
    }

    pub fn read(&self, name: &str) -> Scene {
        let scene = read(&file(name, glb_with(&self.json(), &buffer(self.bytes))));
        assert_valid(&scene);
        scene
    }

    pub fn error(&self, name: &str) -> String {
        error(&file(name, glb_with(&self.json(), &buffer(self.bytes))))
    }
}

/// The only mesh.
pub(crate) fn mesh(scene: &Scene) -> &Mesh {
    assert_eq!(scene.meshes.len(), 1);
    &scene.meshes[0]
}

fn base64(bytes: &[u8]) -> String {
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let groups = bytes.chunks(3).flat_map(|group| {
        let bits = (0..3).fold(0u32, |bits, i| bits << 8 | u32::from(*group.get(i).unwrap_or(&0)));
        (0..4).map(move |i| match i <= group.len() {
            true => char::from(digits[(bits >> (18 - 6 * i) & 63) as usize]),
            false => '=',
        })
    });
    groups.collect()
}

#[test]
fn embedded_linked_and_inlined_images_give_the_same_mask() {
    let alpha = [255, 0, 127, 128, 200, 3];
    let image = png(2, &alpha);
    let embedded = masked(&image).read("embedded.glb");
    assert_eq!(embedded.warnings, [""; 0]);
    let mask = mesh(&embedded).mask.clone().unwrap();
    // the default cutoff, 0.5, lies between 127 / 255 and 128 / 255
    assert_eq!((mask.width, mask.height, &mask.alpha[..]), (2, 3, &alpha[..]));
    assert_eq!(mask.cutoff, 127.5 / 255.0);
    file("a mask.png", &image);
    let data = format!(r#""uri": "data:image/png;base64,{}""#, base64(&image));
    for (name, image) in [("linked.glb", r#""uri": "a%20mask.png""#), ("inlined.glb", &data)] {
        let scene = File { image, ..masked(&[]) }.read(name);
        assert_eq!(scene.meshes, embedded.meshes, "{name}");
    }
}

#[test]
fn masked_meshes_keep_their_texture_coordinates_and_others_have_none() {
    let image = png(2, &[255, 0, 0, 255]);
    let scene = masked(&image).read("kept.glb");
    let mesh = mesh(&scene);
    for (position, texcoord) in mesh.positions.iter().zip(&mesh.texcoords) {
        assert_eq!(position.truncate(), *texcoord);
    }
    // near a corner its own texel decides: those off the diagonal are holes
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        for (corner, at) in triangle.iter().enumerate() {
            let mut weights = [0.1; 3];
            weights[corner] = 0.8;
            let texcoord = mesh.texcoords[*at as usize];
            assert_eq!(mesh.opaque(index, weights), texcoord.x == texcoord.y, "{texcoord}");
        }
    }

    let opaque = MASKED.replace("MASK", "OPAQUE");
    for (name, material) in [("opaque.glb", &opaque[..]), ("whole.glb", MASKED)] {
        let image =
            png(2, if name == "whole.glb" { &[255, 128, 128, 255] } else { &[255, 0, 0, 255] });
        let scene = File { material, ..masked(&image) }.read(name);
        assert_eq!((mesh_of(&scene), &scene.warnings[..]), ((true, 0), &[][..]), "{name}");
    }
    // an opaque mesh's texture coordinates and image may be anything: nobody reads them
    let broken =
        File { material: &opaque, attributes: r#""TEXCOORD_0": 9"#, ..masked(b"no image") };
    assert_eq!(mesh_of(&broken.read("unread.glb")), (true, 0));
}

/// Whether the only mesh has no mask, and how many texture coordinates.
pub(crate) fn mesh_of(scene: &Scene) -> (bool, usize) {
    (mesh(scene).mask.is_none(), mesh(scene).texcoords.len())
}

#[test]
fn alpha_equal_to_the_cutoff_is_opaque_for_every_byte_and_with_a_factor() {
    let all: Vec<u8> = (0..=255).collect();
    let image = png(256, &all);
    // a power of two as a factor scales without rounding
    for factor in [1.0, 0.5] {
        for byte in 1..=255u8 {
            let cutoff = f64::from(byte) / 255.0 * factor;
            let material = format!(
                r#""alphaMode": "MASK", "alphaCutoff": {cutoff}, "pbrMetallicRoughness":
                {{"baseColorFactor": [1, 1, 1, {factor}], "baseColorTexture": {{"index": 0}}}}"#
            );
            let scene = File { material: &material, ..masked(&image) }.read("cutoff.glb");
            let mask = mesh(&scene).mask.as_ref().unwrap();
            let opaque = all.iter().filter(|&&alpha| {
                let center = (f32::from(alpha) + 0.5) / 256.0;
                mask.opaque(vec2(center, 0.5))
            });
            assert!(opaque.copied().eq(byte..=255), "{byte} times {factor}");
        }
    }
}

#[test]
fn factor_alone_keeps_or_removes_the_whole_mesh() {
    let material = |alpha: f32, cutoff: f32| {
        format!(
            r#""alphaMode": "MASK", "alphaCutoff": {cutoff},
            "pbrMetallicRoughness": {{"baseColorFactor": [1, 1, 1, {alpha}]}}"#
        )
    };
    for (alpha, cutoff) in [(0.25, 0.25), (0.3, 0.3), (1.0, 1.0), (0.0, 0.0)] {
        let scene = File { material: &material(alpha, cutoff), ..masked(&[]) }.read("factor.glb");
        assert_eq!(
            (mesh_of(&scene), &scene.warnings[..]),
            ((true, 0), &[][..]),
            "{alpha} {cutoff}"
        );
    }
    for (alpha, cutoff) in [(0.25, 0.26), (0.0, 0.1), (1.0, 1.5)] {
        let message = File { material: &material(alpha, cutoff), ..masked(&[]) }.error("gone.glb");
        let expected = "mesh `x`: its alpha is below the cutoff everywhere, so it is left out";
        assert!(message.contains(expected), "{message}");
    }
    // the same where no texel is opaque
    let message = masked(&png(1, &[127])).error("gone.glb");
    assert!(message.contains("below the cutoff everywhere"), "{message}");
}

#[test]
fn jpeg_has_no_holes_but_its_factor_counts() {
    let image = encoded(&DynamicImage::new_rgb8(8, 8), ImageFormat::Jpeg);
    file("mask.jpg", &image);
    for (name, image, bytes) in
        [("linked.glb", r#""uri": "mask.jpg""#, &[][..]), ("embedded.glb", EMBEDDED, &image[..])]
    {
        let scene = File { image, ..masked(bytes) }.read(name);
        assert_eq!(mesh_of(&scene), (true, 0), "{name}");
        let material = MASKED.replace("{\"base", "{\"baseColorFactor\": [1, 1, 1, 0.4], \"base");
        let message = File { image, material: &material, ..masked(bytes) }.error(name);
        assert!(message.contains("below the cutoff everywhere"), "{message}");
    }
}

/// Texture coordinates of the square's corners, in the order of [`CORNERS`].
fn at_corners(scene: &Scene) -> [Vec2; 4] {
    CORNERS.map(|corner| {
        let found = mesh(scene).positions.iter().position(|p| p.truncate() == Vec2::from(corner));
        mesh(scene).texcoords[found.unwrap()]
    })
}

#[test]
fn other_sets_and_transforms_of_texture_coordinates_are_honoured() {
    let image = png(2, &[255, 0, 0, 255]);
    let with = |member: &str, name| {
        let index = format!("\"index\": 0, {member}");
        let attributes = r#""TEXCOORD_0": 1, "TEXCOORD_1": 2"#;
        let material = MASKED.replace("\"index\": 0", &index);
        File { attributes, material: &material, ..masked(&image) }.read(name)
    };
    let second = [vec2(0.0, 0.0), vec2(0.4, 0.2), vec2(0.8, 0.4), vec2(0.0, 0.6)];
    // bytes over 255, where the reader may multiply by a rounded inverse
    let is_second = |scene: &Scene| {
        at_corners(scene).iter().zip(second).all(|(a, b)| a.distance(b) < f32::EPSILON)
    };
    assert!(is_second(&with(r#""texCoord": 1"#, "set.glb")));

    let transform = |members: &str| {
        format!(r#""texCoord": 0, "extensions": {{"KHR_texture_transform": {{{members}}}}}"#)
    };
    assert!(is_second(&with(&transform(r#""texCoord": 1"#), "moved_set.glb")));
    // the extension's own two examples: the image's lower left quarter, turned clockwise ...
    let quarter = r#""offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5]"#;
    let expected = [vec2(0.0, 1.0), vec2(0.0, 0.5), vec2(0.5, 0.5), vec2(0.5, 1.0)];
    for (found, expected) in
        at_corners(&with(&transform(quarter), "turned.glb")).into_iter().zip(expected)
    {
        // the angle is pi / 2 up to 2^-24 of itself
        assert!(found.distance(expected) < 2.0 * f32::EPSILON, "{found} {expected}");
    }
    // ... and the origin at the bottom
    let flipped = r#""offset": [0, 1], "scale": [1, -1]"#;
    let expected = CORNERS.map(|[u, v]| vec2(u, 1.0 - v));
    assert_eq!(at_corners(&with(&transform(flipped), "flipped.glb")), expected);
}

#[test]
fn mask_repeats_in_both_directions_and_on_both_sides_of_zero() {
    let (width, height) = (4, 2);
    for opaque in 0..8 {
        let alpha = (0..8).map(|i| if i == opaque { 255 } else { 0 }).collect();
        let mask = Mask { width, height, alpha, cutoff: 1.0 };
        for (x, y) in (0..8).flat_map(|x| (0..4).map(move |y| (x, y))) {
            // eighths and quarters: borders and middles of texels
            let at = vec2(x as f32 / 8.0, y as f32 / 4.0);
            let expected = opaque == y / 2 * 4 + x / 2;
            for around in [(0.0, 0.0), (1.0, 0.0), (-1.0, 3.0), (5.0, -1.0), (-7.0, -2.0)] {
                let there = at + Vec2::from(around);
                assert_eq!(mask.opaque(there), expected, "{there} of texel {opaque}");
            }
        }
        // rounds to the next whole number when it is wrapped, but lies in the last texel
        let below = vec2(-1e-9, -1e-9);
        assert_eq!(mask.opaque(below), opaque == 7);
        assert_eq!(mask.opaque(vec2(-0.0, 1e30)), opaque == 0, "whole numbers");
        for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert!(mask.opaque(vec2(odd, 0.0)) && mask.opaque(vec2(0.0, odd)));
        }
    }
}

/// The file's texture by other members than a source.
fn with_texture(bytes: &[u8], texture: &str, image: &str, name: &str) -> Scene {
    let json = File { image, ..masked(bytes) }.json();
    let json = json.replace(r#"{"source": 0, "sampler": 0}"#, texture);
    let scene = read(&file(name, glb_with(&json, &buffer(bytes))));
    assert_valid(&scene);
    scene
}

const WEBP: &str = r#"{"extensions": {"EXT_texture_webp": {"source": 0}}}"#;

#[test]
fn webp_is_read_as_png_is_and_a_source_of_the_core_format_comes_first() {
    let alpha = [255, 0, 127, 128, 200, 3];
    let expected = masked(&png(2, &alpha)).read("png.glb");
    let webp = encoded(&picture(2, &alpha), ImageFormat::WebP);
    let image = r#""bufferView": 3, "mimeType": "image/webp""#;
    let scene = with_texture(&webp, WEBP, image, "webp.glb");
    assert_eq!((&scene.meshes, &scene.warnings), (&expected.meshes, &expected.warnings));
    // as some write it, without the extension
    let core = r#"{"source": 0, "sampler": 0}"#;
    assert_eq!(with_texture(&webp, core, image, "webp_core.glb").meshes, expected.meshes);
    // a PNG beside one that is not even there
    let both = r#"{"source": 0, "extensions": {"EXT_texture_webp": {"source": 9},
        "KHR_texture_basisu": {"source": 8}}}"#;
    let scene = with_texture(&png(2, &alpha), both, EMBEDDED, "both.glb");
    assert_eq!(scene.meshes, expected.meshes);
}

#[test]
fn masks_in_images_that_nobody_here_decodes_are_opaque_and_named() {
    let opaque = "which is not read, so it is opaque: convert the image to PNG";
    for (texture, what) in [
        (
            r#"{"extensions": {"KHR_texture_basisu": {"source": 0}}}"#,
            "an image of the extension `KHR_texture_basisu`",
        ),
        (
            r#"{"extensions": {"EXT_texture_avif": {"source": 0}}}"#,
            "an image of the extension `EXT_texture_avif`",
        ),
        ("{}", "a texture without an image"),
    ] {
        let scene = with_texture(b"x", texture, EMBEDDED, "unread.glb");
        assert_eq!(mesh_of(&scene), (true, 0));
        assert_eq!(scene.warnings, [format!("mesh `x`: its mask is {what}, {opaque}")]);
    }
    for (start, what) in [
        (&b"\xabKTX 20\xbb\r\n\x1a\n"[..], "a KTX2 image"),
        (b"\0\0\0\x1cftypavif\0\0\0\0", "an AVIF image"),
        (b"DDS |\0\0\0", "a DDS image"),
        (b"\xff\x0a\0\0", "a JPEG XL image"),
    ] {
        let core = r#"{"source": 0, "sampler": 0}"#;
        let scene = with_texture(start, core, EMBEDDED, "unread_core.glb");
        assert_eq!(mesh_of(&scene), (true, 0));
        assert_eq!(scene.warnings, [format!("mesh `x`: its mask is {what}, {opaque}")]);
    }
}

#[test]
fn required_texture_transforms_are_honoured_without_a_warning() {
    let image = png(2, &[255, 0, 0, 255]);
    let transform = r#""index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}}"#;
    let material = MASKED.replace("\"index\": 0", transform);
    let json = File { material: &material, ..masked(&image) }.json();
    let json = json.replace("extensionsUsed", "extensionsRequired");
    let scene = read(&file("required_transform.glb", glb_with(&json, &buffer(&image))));
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!(at_corners(&scene), CORNERS.map(|[u, v]| vec2(u + 0.5, v)));
}

#[test]
fn unknown_alpha_modes_are_opaque_and_named() {
    let material = MASKED.replace("MASK", "DITHER");
    let scene = File { material: &material, ..masked(b"x") }.read("dither.glb");
    assert_eq!(mesh_of(&scene), (true, 0));
    let what = "mesh `x`: alphaMode `DITHER` is not known, so it is opaque";
    assert_eq!(scene.warnings, [what]);
}
