//! OBJ files; behind a NUL follows the material library `a.mtl`.
#![no_main]

mod common;
mod look;

use libfuzzer_sys::fuzz_target;

fuzz_target!(init: common::keep_panics(), |bytes: &[u8]| {
    common::no_panic(|| {
        // UTF-16 has a NUL for every other byte
        let is_wide = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
        let end = bytes.iter().position(|byte| *byte == 0 && !is_wide).unwrap_or(bytes.len());
        let (object, materials) = bytes.split_at(end);
        let materials = materials.get(1..).unwrap_or_default();
        std::fs::write(look::FOLDER.join("a.mtl"), materials).unwrap();
        look::read("a.obj", object);
    });
});
