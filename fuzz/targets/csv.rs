//! CSV files as `dpsm eval` and `dpsm probe` read them: the first byte chooses the reader.
#![no_main]

#[allow(dead_code)] // the commands themselves
#[path = "../../src/cli/mod.rs"]
mod cli;
mod common;

use std::sync::LazyLock;

use cli::check;
use dpsm::reflect::{Component, Signature};
use libfuzzer_sys::fuzz_target;

/// Functions with arguments of every kind: vectors, structs, integers, bools.
const FUNCTIONS: [&str; 4] =
    ["dpsm_project", "dpsm_depth", "dpsm_to_light", "dpsm_tessellate_weights"];

static INPUTS: LazyLock<Vec<Vec<Component>>> = LazyLock::new(|| {
    let inputs = |function: &&str| {
        let linked = dpsm::link::link_function(function).unwrap();
        Signature::of(&dpsm::validate(&linked).unwrap().module, function).unwrap().inputs()
    };
    FUNCTIONS.iter().map(inputs).collect()
});

fn init() {
    common::keep_panics();
    LazyLock::force(&INPUTS);
}

fuzz_target!(init: init(), |bytes: &[u8]| {
    let Some((&reader, file)) = bytes.split_first() else { return };
    common::no_panic(|| {
        let inputs = INPUTS.get(usize::from(reader.wrapping_sub(b'0')));
        let read = match inputs {
            Some(inputs) => check::records(file, inputs),
            None => check::points(file),
        };
        match read {
            Ok(count) => assert!(count <= file.len()),
            Err(error) => drop(error.to_string()),
        }
    });
});
