//! A command line, one argument a line or one of the dictionary a byte, and what its command checks
//! before it opens an adapter.
#![no_main]

#[allow(dead_code)] // the commands themselves
#[path = "../../src/cli/mod.rs"]
mod cli;
mod common;

use std::fs;

use clap::Parser;
use libfuzzer_sys::fuzz_target;

/// Options and values, a line each in quotes.
const DICTIONARY: &str = include_str!("../dictionaries/arguments");

fuzz_target!(init: init(), |bytes: &[u8]| {
    let words: Vec<&str> = DICTIONARY.lines().map(|line| line.trim_matches('"')).collect();
    let input = match bytes.split_first() {
        Some((0, bytes)) => {
            let words = bytes.iter().map(|&byte| words[usize::from(byte) % words.len()]);
            words.collect::<Vec<_>>().join("\n")
        }
        _ => String::from_utf8_lossy(bytes).into_owned(),
    };
    common::no_panic(|| run(&input));
});

/// Works in a folder with a file of each kind, which command lines may name.
fn init() {
    common::keep_panics();
    let folder = std::env::temp_dir().join(format!("dpsm-fuzz-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    std::env::set_current_dir(&folder).unwrap();
    fs::write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    fs::write("a.csv", "x,y,z\n0,1,2\n").unwrap();
    fs::write("p.csv", "p.x,p.y,p.z\n0,1,2\n").unwrap();
    let shader = "import dpsm::paraboloid::{dpsm_project};\n\
        fn f(p: vec3<f32>) -> vec2<f32> { return dpsm_project(p); }\n";
    fs::write("a.wesl", shader).unwrap();
}

fn run(input: &str) {
    let arguments: Vec<&str> = input.split('\n').collect();
    // fine walls take seconds and gigabytes by design; other folders are not ours to read
    let big = |text: &str| text.parse().is_ok_and(|walls: u32| (17..=1024).contains(&walls));
    let walls = |pair: &[&str]| pair[0] == "--walls" && big(pair[1]);
    let equals = |text: &&str| text.strip_prefix("--walls=").is_some_and(big);
    let outside =
        |text: &&str| text.contains("/dev") || text.contains("..") || text.contains("/proc");
    if arguments.windows(2).any(walls)
        || arguments.iter().any(equals)
        || arguments.iter().any(outside)
    {
        return;
    }
    let checked = cli::Arguments::try_parse_from(std::iter::once("dpsm").chain(arguments));
    match checked.map(|arguments| cli::check::arguments(&arguments)) {
        Ok(Ok(())) => {}
        Ok(Err(error)) => assert_eq!(error.code(), 2, "{error}"),
        Err(error) => drop(error.to_string()),
    }
}
