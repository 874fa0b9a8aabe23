//! Texts that others finish, conditions, and a user's modules in files.

#![cfg(feature = "naga")]

mod conditions;
mod files;
mod foreign;
#[cfg(feature = "cli")]
mod program;

use std::path::{Path, PathBuf};

use dpsm::link::Features;
use dpsm::{Catalogue, Linked};

/// A folder of its own, with these files in it.
fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("link-forms-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    for (name, text) in files {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

/// The shader of an end user, with its maps and its light.
const HEAD: &str = "\
import dpsm::light::{DpsmLight};
import dpsm::visibility::{dpsm_visibility};
@group(0) @binding(0) var<uniform> light: DpsmLight;
@group(0) @binding(1) var maps: texture_depth_2d_array;
@group(0) @binding(2) var comparison: sampler_comparison;
";

fn features(given: &[(&str, bool)]) -> Features {
    given.iter().fold(Features::new(), |features, (name, on)| features.with(name, *on))
}

fn with_features(text: &str, given: &[(&str, bool)]) -> Result<Linked, dpsm::LinkError> {
    Catalogue::dpsm().unwrap().features(features(given)).link_source("my.wesl", text)
}

/// Every line that a file gave is a line of it, but for what a condition has taken out of it: in its
/// place there are blanks.
fn check_origins(linked: &Linked, file: &str, text: &str) -> usize {
    let (mut checked, whole_lines) = (0, text.lines().collect::<Vec<_>>());
    for (index, line) in linked.text.lines().enumerate() {
        let Some(origin) = linked.origin(index + 1).filter(|origin| origin.file == file) else {
            continue;
        };
        let whole = whole_lines[origin.line - 1];
        assert_eq!(linked.source_line(index + 1), Some(whole));
        let fits = line.chars().zip(whole.chars()).all(|(new, old)| new == old || new == ' ');
        assert!(fits && line.chars().count() <= whole.chars().count(), "`{line}` of `{whole}`");
        checked += 1;
    }
    checked
}
