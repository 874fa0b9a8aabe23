//! glTF files: the first byte says whether the rest is text or binary, or alters a good file.
#![no_main]

mod altered;
mod common;
mod look;

use libfuzzer_sys::fuzz_target;

fuzz_target!(init: common::keep_panics(), |bytes: &[u8]| {
    let Some((&kind, file)) = bytes.split_first() else { return };
    common::no_panic(|| match kind {
        b't' => look::read("a.gltf", file),
        b'b' => look::read("a.glb", file),
        b'a' => look::read("a.glb", &altered::glb(file)),
        _ => {}
    });
});
