//! The linker and naga's validation: a user's file, or a first line that says what else to link.
#![no_main]

mod common;

use std::sync::LazyLock;

use dpsm::link::Features;
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
        // conditions of a shader and of a module, decided as the line says
        ["features", given @ ..] => {
            let all = DPSM.clone().features(features(given));
            match all.clone().with("mine", "mine.wesl", text) {
                Ok(all) => look_at(all.link(&["mine"])),
                Err(error) => drop(error.to_string()),
            }
            all.link_source("my.wesl", text)
        }
        _ => DPSM.link_source("my.wesl", input),
    });
}

/// `A`, `B=false`, `*=false`.
fn features(given: &[&str]) -> Features {
    given.iter().fold(Features::new(), |features, word| {
        let (name, value) = word.split_once('=').unwrap_or((word, "true"));
        let on = value == "true";
        if name == "*" { features.others(on) } else { features.with(name, on) }
    })
}

const IMPORTING: &str = "import super::mine::{f};\nfn g() -> f32 { return f(); }";

/// Every line has an origin or is the linker's own, nothing is in it but its source line's
/// characters, and naga accepts the text or we say why not.
fn look_at(linked: Result<Linked, dpsm::LinkError>) {
    let linked = match linked {
        Ok(linked) => linked,
        Err(error) => return drop(error.to_string()),
    };
    for line in 0..=linked.text.split('\n').count() + 1 {
        assert_eq!(linked.origin(line).is_some(), linked.source_line(line).is_some());
    }
    for (index, line) in linked.text.split('\n').enumerate() {
        let Some(whole) = linked.source_line(index + 1) else { continue };
        // behind the thousandth column a part of a line starts there
        if whole.len() < 1000 {
            let fits = |(new, old): (char, char)| new == old || new == ' ' || new == '\t';
            assert!(line.chars().zip(whole.chars()).all(fits), "{line:?} of {whole:?}");
            assert!(line.chars().count() <= whole.chars().count());
        }
    }
    for note in linked.notes() {
        drop(note.to_string());
    }
    if let Err(error) = dpsm::validate(&linked) {
        drop(error.to_string());
    }
}
