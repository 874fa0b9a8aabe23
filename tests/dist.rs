//! `dist/` holds each module linked with what it needs, to be pasted where there is no Rust.

#![cfg(feature = "naga")]

/// Set to write the files anew.
const WRITE: &str = "DPSM_WRITE_DIST";

#[test]
fn dist_is_what_the_linker_makes_of_the_modules() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/dist");
    for module in dpsm::MODULES {
        let text = dpsm::link(&[module.name]).unwrap().text;
        let path = format!("{folder}/{}.wgsl", module.name);
        if std::env::var_os(WRITE).is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        let stored = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
        assert!(stored == text, "{path} is stale: run the tests with {WRITE}=1 and commit it");
    }
    let files = std::fs::read_dir(folder).unwrap().count();
    assert_eq!(files, dpsm::MODULES.len() + 1, "only modules and their licence are in {folder}");
}
