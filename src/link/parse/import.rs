//! Imports, and what to write instead of a form that is outside the subset.

use super::super::error::LinkError;
use super::super::token::is_word;
use super::{Import, Parser};

pub(super) const ROOTS: [&str; 3] = ["super", "dpsm", "package"];

/// Where the path of an import starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Root {
    /// dpsm's modules.
    Dpsm,
    /// The folder of the shader that is linked.
    Package,
    /// The folder so many steps up from the file: one is its own.
    Super(usize),
}

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
    /// Reads the import at `head`, whose attributes start at `first`.
    pub(super) fn import(
        &mut self,
        first: usize,
        head: usize,
        end: usize,
    ) -> Result<(), LinkError> {
        let words: Vec<_> = (head + 1..end).map(|at| self.tokens.text(at)).collect();
        let Some(path) = Path::of(&words) else { return Err(self.unsupported(head, &words)) };
        let items = path.items.iter().enumerate().filter(|(_, item)| **item != ",");
        let imports: Vec<_> = items
            .map(|(index, item)| Import {
                root: path.root,
                module: path.module.join("::"),
                item: (*item).to_owned(),
                at: self.tokens.offset(head + 1 + path.first + index),
                conditional: self.tokens.is_conditional(first),
            })
            .collect();
        self.file.imports.extend(imports);
        let span = self.tokens.span(first, end);
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
            place: self.tokens.source.place(self.tokens.offset(at)),
            what,
            instead: format!("import {root}::{module}::{{name}};"),
        }
    }
}

/// An import's words: `super::module::{a, b}` or `super::folder::module::a`.
struct Path<'a> {
    root: Root,
    module: Vec<&'a str>,
    /// Names and commas, and which word is the first.
    items: Vec<&'a str>,
    first: usize,
}

impl<'a> Path<'a> {
    fn of(words: &[&'a str]) -> Option<Self> {
        let (list, mut at) = match words.iter().position(|word| *word == "{") {
            Some(open) => match &words[open..] {
                ["{", list @ .., "}"] if is_list(list) => (Some(list), open),
                _ => return None,
            },
            None => (None, words.len()),
        };
        let first = list.map_or(words.len().checked_sub(1)?, |_| at + 1);
        if list.is_some() {
            // `::` before the brace
            at = at.checked_sub(2).filter(|at| words[*at..at + 2] == [":", ":"])?;
        }
        let mut segments = Vec::new();
        for part in words[..at].chunks(3) {
            match part {
                [word] | [word, ":", ":"] if is_word(word) => segments.push(*word),
                _ => return None,
            }
        }
        if at % 3 != 1 {
            return None;
        }
        let ups = segments.iter().take_while(|word| **word == "super").count();
        let root = match *segments.first()? {
            "super" => Root::Super(ups),
            "package" => Root::Package,
            "dpsm" => Root::Dpsm,
            _ => return None,
        };
        let mut module = segments.split_off(ups.max(1));
        let items = match list {
            Some(list) => list.to_vec(),
            None => vec![module.pop()?],
        };
        let own = module.iter().any(|word| ROOTS.contains(word));
        let deep = root == Root::Dpsm && module.len() > 1;
        (!module.is_empty() && !own && !deep).then_some(Self { root, module, items, first })
    }
}

/// Words with commas between, and perhaps one at the end.
fn is_list(words: &[&str]) -> bool {
    words.iter().enumerate().all(|(index, word)| match index % 2 {
        0 => is_word(word),
        _ => *word == ",",
    })
}
