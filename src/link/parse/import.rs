//! Imports, and what to write instead of a form that is outside the subset.

use super::super::error::LinkError;
use super::super::token::is_word;
use super::{Import, Parser};

pub(super) const ROOTS: [&str; 3] = ["super", "dpsm", "package"];

/// Removes the root of a module path.
pub(crate) fn strip_root(path: &str) -> &str {
    let mut roots = ROOTS.iter();
    let stripped = roots.find_map(|root| path.strip_prefix(root)?.strip_prefix("::"));
    stripped.unwrap_or(path)
}

/// Whether imports can name a module so.
pub(crate) fn is_module_name(name: &str) -> bool {
    is_word(name) && !ROOTS.contains(&name)
}

impl Parser {
    pub(super) fn import(&mut self, at: usize, end: usize) -> Result<(), LinkError> {
        let words: Vec<_> = (at + 1..end).map(|at| self.text(at)).collect();
        let (module, items, first) = match words.as_slice() {
            [root, ":", ":", module, ":", ":", item]
                if ROOTS.contains(root) && is_word(module) && is_word(item) =>
            {
                (*module, vec![*item], at + 7)
            }
            [root, ":", ":", module, ":", ":", "{", list @ .., "}"]
                if ROOTS.contains(root) && is_word(module) && is_list(list) =>
            {
                (*module, list.to_vec(), at + 8)
            }
            _ => return Err(self.unsupported(at, &words)),
        };
        let items = items.iter().enumerate().filter(|(_, item)| **item != ",");
        let imports: Vec<_> = items
            .map(|(index, item)| Import {
                module: module.to_owned(),
                item: (*item).to_owned(),
                at: self.offset(first + index),
            })
            .collect();
        self.file.imports.extend(imports);
        let span = self.span(at, end);
        self.file.import_spans.push(span);
        Ok(())
    }

    fn unsupported(&self, at: usize, words: &[&str]) -> LinkError {
        let what = match words {
            words if words.contains(&"as") => "renames by `as` are",
            words if words.contains(&"*") => "wildcard imports are",
            [root, ":", ":", module] if ROOTS.contains(root) && is_word(module) => {
                "imports of a whole module are"
            }
            [root, ":", ":", ..] if ROOTS.contains(root) => "this form of import is",
            _ => "imports from other roots than `dpsm`, `super` and `package` are",
        };
        self.instead(at, what, words.get(3).unwrap_or(&""))
    }

    pub(super) fn instead(&self, at: usize, what: &'static str, module: &str) -> LinkError {
        let module = if is_word(module) { module } else { "module" };
        let root = if self.file.module.is_some() { "super" } else { "dpsm" };
        LinkError::UnsupportedImport {
            place: self.file.source.place(self.offset(at)),
            what,
            instead: format!("import {root}::{module}::{{name}};"),
        }
    }
}

/// Words with commas between, and perhaps one at the end.
fn is_list(words: &[&str]) -> bool {
    words.iter().enumerate().all(|(index, word)| match index % 2 {
        0 => is_word(word),
        _ => *word == ",",
    })
}
