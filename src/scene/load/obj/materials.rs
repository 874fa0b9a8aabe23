//! Material libraries: the diffuse colours of the materials.

use std::collections::HashMap;
use std::fmt::Display;
use std::path::Path;

use glam::Vec3;

use super::statements::{name, statement, statements, without_comment};
use crate::scene::load::{albedo, named, text};

/// Diffuse colours by name; `None` for a material that gives none.
#[derive(Default)]
pub(super) struct Materials(HashMap<String, Option<Vec3>>);

impl Materials {
    pub fn read(folder: &Path, libraries: &[String], warnings: &mut Vec<String>) -> Self {
        let mut materials = Self::default();
        for names in libraries {
            for file in files(folder, names) {
                let mut warn = |error: &dyn Display| {
                    warnings.push(format!(
                        "material library `{file}` cannot be read ({error}): its materials are grey"
                    ));
                };
                match named::read(&folder.join(file)) {
                    Ok(bytes) => materials.add(&text::decoded(&bytes), &mut warn),
                    Err(error) => warn(&error),
                }
            }
        }
        materials
    }

    fn add(&mut self, text: &str, warn: &mut dyn FnMut(&dyn Display)) {
        let mut current = String::new();
        let lines = statements(text);
        for statement in lines.iter().filter_map(statement) {
            match statement.keyword {
                "newmtl" => {
                    current = statement.rest.into();
                    self.0.insert(current.clone(), None);
                }
                "Kd" => match color(statement.rest) {
                    Some(color) => _ = self.0.insert(current.clone(), Some(color)),
                    None => warn(&statement.fault("no colour of one or three numbers")),
                },
                _ => {}
            }
        }
    }

    /// A material by the name that `usemtl` gives, which may end in a comment.
    pub fn get(&self, used: &str) -> Option<(&str, Option<Vec3>)> {
        let found = self.0.get_key_value(used).or_else(|| self.0.get_key_value(name(used)));
        found.filter(|(name, _)| !name.is_empty()).map(|(name, color)| (name.as_str(), *color))
    }
}

/// The one file, possibly with spaces in its name, or several.
fn files<'a>(folder: &Path, names: &'a str) -> Vec<&'a str> {
    let is_file = |name: &&str| !name.is_empty() && folder.join(name).exists();
    match [names, name(names)].into_iter().find(is_file) {
        Some(one) => vec![one],
        None => name(names).split_whitespace().collect(),
    }
}

/// Three numbers, or one of a grey.
fn color(text: &str) -> Option<Vec3> {
    let numbers: Vec<f32> = without_comment(text)
        .split_whitespace()
        .take(3)
        .map(str::parse)
        .collect::<Result<_, _>>()
        .ok()?;
    match numbers[..] {
        [grey] => Some(albedo([grey; 3])),
        [red, green, blue] => Some(albedo([red, green, blue])),
        _ => None,
    }
}
