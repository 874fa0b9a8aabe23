//! The linker and naga's validation: a user's file, or a first line that says what else to link.
#![no_main]

mod common;

use std::sync::LazyLock;

use dpsm::{Catalogue, Linked};
use libfuzzer_sys::fuzz_target;

static DPSM: LazyLock<Catalogue> = LazyLock::new(|| Catalogue::dpsm().unwrap());

fn init() {
    common::keep_panics();
    LazyLock::force(&DPSM);
}

fuzz_target!(init: init(), |bytes: &[u8]| {
    // what is no UTF-8 would be mostly words of strange letters: ASCII instead
    let ascii = || bytes.iter().map(|byte| char::from(byte & 0x7f)).collect();
    let text = std::str::from_utf8(bytes).map_or_else(|_| ascii(), String::from);
    common::no_panic(|| run(&text));
});

fn run(input: &str) {
    let (first, text) = input.split_once('\n').unwrap_or((input, ""));
    let words: Vec<&str> = first.split(' ').collect();
    look_at(match words.as_slice() {
        // reads all modules again, as every call does
        ["all", names @ ..] => {
            let linked = dpsm::link(names);
            assert_eq!(linked.is_ok(), DPSM.link(names).is_ok());
            linked
        }
        ["link", names @ ..] => DPSM.link(names),
        ["function", name] => dpsm::link::link_function(name),
        ["source", path] => dpsm::link_source(path, text),
        // a module of the user's own, whole or imported
        ["mine", names @ ..] => match DPSM.clone().with("mine", "mine.wesl", text) {
            Ok(catalogue) if names.is_empty() => {
                let _ = catalogue.describe();
                catalogue.link(&["mine"])
            }
            Ok(catalogue) => catalogue.link_source("my.wesl", IMPORTING),
            Err(error) => return drop(error.to_string()),
        },
        _ => DPSM.link_source("my.wesl", input),
    });
}

const IMPORTING: &str = "import super::mine::{f};\nfn g() -> f32 { return f(); }";

/// Every line has an origin or is the linker's own, and naga accepts the text or we say why not.
fn look_at(linked: Result<Linked, dpsm::LinkError>) {
    let linked = match linked {
        Ok(linked) => linked,
        Err(error) => return drop(error.to_string()),
    };
    for line in 0..=linked.text.lines().count() + 1 {
        assert_eq!(linked.origin(line).is_some(), linked.source_line(line).is_some());
    }
    if let Err(error) = dpsm::validate(&linked) {
        drop(error.to_string());
    }
}
