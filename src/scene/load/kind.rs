//! What a file is whose name says something else.

use std::path::Path;

use crate::scene::SceneError;

/// First bytes, what they are the beginning of, and what to do about it.
const KINDS: &[(&[u8], &str, &str)] = &[
    (b"version https://git-lfs", "a Git LFS pointer", "fetch the file with `git lfs pull`"),
    (b"\x1f\x8b", "a gzip archive", "unpack it"),
    (b"PK\x03\x04", "a ZIP archive", "unpack it and name the scene in it"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", "unpack it"),
    (b"\xfd7zXZ\0", "an xz archive", "unpack it"),
    (b"\x28\xb5\x2f\xfd", "a Zstandard archive", "unpack it"),
    (b"BZh", "a bzip2 archive", "unpack it"),
    (b"Rar!", "a RAR archive", "unpack it"),
    (b"Kaydara FBX Binary", "an FBX file", CONVERT),
    (b"; FBX", "an FBX file", CONVERT),
    (b"BLENDER", "a Blender file", "export it from Blender as .glb"),
    (b"ply\n", "a PLY file", CONVERT),
    (b"ply\r", "a PLY file", CONVERT),
    (b"solid ", "an STL file", CONVERT),
    (b"#usda", "a USD file", CONVERT),
    (b"PXR-USDC", "a USD file", CONVERT),
    (b"DRACO", "a bare Draco mesh", CONVERT),
    (b"b3dm", "a 3D Tiles model", CONVERT),
    (b"i3dm", "a 3D Tiles model", CONVERT),
    (b"cmpt", "a 3D Tiles composite", CONVERT),
    (b"pnts", "a 3D Tiles point cloud", CONVERT),
    (b"\x89PNG", "a PNG picture", MODEL),
    (b"\xff\xd8\xff", "a JPEG picture", MODEL),
    (b"GIF8", "a GIF picture", MODEL),
    (b"RIFF", "a RIFF file, as WebP pictures are", MODEL),
    (b"\xabKTX", "a KTX texture", MODEL),
    (b"DDS ", "a DDS texture", MODEL),
    (b"%PDF", "a PDF document", MODEL),
];

const CONVERT: &str = "convert it to .glb";
const MODEL: &str = "give the model's own file";
const DOWNLOAD: &str = "download the file itself, not the page that shows it";

/// Refuses content that is of another kind than the name says, and names the kind.
pub(super) fn check(path: &Path, bytes: &[u8], extension: &str) -> Result<(), SceneError> {
    match other_kind(bytes, extension) {
        None => Ok(()),
        Some((kind, remedy)) => {
            let expected = if extension == "obj" { "an OBJ file" } else { "a glTF file" };
            Err(SceneError::OtherKind { path: path.into(), kind, expected, remedy })
        }
    }
}

fn other_kind(bytes: &[u8], extension: &str) -> Option<(&'static str, &'static str)> {
    let known = KINDS.iter().find(|(start, ..)| bytes.starts_with(start));
    if let Some((_, kind, remedy)) = known {
        return Some((kind, remedy));
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let begins = |start: &str| {
        text.get(..start.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(start.as_bytes()))
    };
    let gltf = bytes.starts_with(b"glTF") || begins("{");
    match extension {
        _ if begins("<!doctype html") || begins("<html") || begins("<head") => {
            Some(("a web page", DOWNLOAD))
        }
        _ if begins("<?xml") && contains(text, b"<COLLADA") => Some(("a COLLADA file", CONVERT)),
        _ if begins("<") => Some(("an XML or HTML file", DOWNLOAD)),
        "obj" if gltf => Some(("a glTF file", "rename it to .glb or .gltf")),
        "obj" if text.starts_with(b"\x4c\x01") || text.starts_with(b"\x64\x86") => {
            Some(("a compiler's object file", MODEL))
        }
        "obj" | "" => None,
        _ if !gltf && has_vertices(text) => Some(("an OBJ file", "rename it to .obj")),
        _ => None,
    }
}

fn contains(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).take(4096).any(|window| window == word)
}

/// True where one of the first lines is a vertex of OBJ.
fn has_vertices(text: &[u8]) -> bool {
    text.split(|&byte| byte == b'\n').take(100).any(|line| line.starts_with(b"v "))
}
