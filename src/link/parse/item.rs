//! Declarations: where they end, what they declare inside and what they may refer to.

use std::ops::Range;

use super::super::error::LinkError;
use super::import::ROOTS;
use super::{DECLARATIONS, Item, Offsets, Parser};

impl Parser {
    /// Reads the declaration at a token and returns the token after it.
    pub(super) fn item(&mut self, first: usize) -> Result<usize, LinkError> {
        let mut at = first;
        while self.text(at) == "@" {
            at += if self.text(at + 2) == "(" { self.pairs[at + 2] - at + 1 } else { 2 };
        }
        let Some(kind) = DECLARATIONS.into_iter().find(|kind| *kind == self.text(at)) else {
            let what = match self.text(at) {
                "" => "a declaration is missing after its attributes".to_owned(),
                text => format!("expected a declaration, found `{}`", clip(text)),
            };
            return Err(self.malformed(at, what));
        };
        let mut name = at;
        if kind != "const_assert" {
            name = if kind == "var" { self.after_template(at + 1) } else { at + 1 };
            if !self.is_word(name) {
                return Err(self.malformed(at, format!("expected a name after `{kind}`")));
            }
        }
        let (members, last) = match kind {
            "fn" if self.text(name + 1) == "(" => {
                let close = self.pairs[name + 1];
                (name + 1..close, self.body(close + 1)?)
            }
            "struct" if self.text(name + 1) == "{" => {
                let close = self.pairs[name + 1];
                (name + 1..close, close)
            }
            "fn" | "struct" => {
                let bracket = if kind == "fn" { "(" } else { "{" };
                let what = format!("expected `{bracket}` after `{kind} {}`", clip(self.text(name)));
                return Err(self.malformed(name, what));
            }
            _ => (0..0, self.statement_end(at + 1)?),
        };

        let (words, locals) = self.words(first, last, name, &members)?;
        let start = self.leading_comments(first);
        let item = Item {
            kind,
            name: (kind != "const_assert").then(|| self.text(name).to_owned()),
            at: self.offset(name),
            span: self
                .comments
                .get(start)
                .map_or(self.offset(first), |comment| comment.start.min(self.offset(first)))
                ..self.end_of_line_comment(self.tokens[last].span.end),
            doc: self.doc(start, self.offset(first)),
            words,
            locals,
        };
        self.add(item)?;
        Ok(last + 1)
    }

    fn add(&mut self, item: Item) -> Result<(), LinkError> {
        let index = self.file.items.len();
        if let Some(name) = &item.name
            && let Some(first) = self.file.names.insert(name.clone(), index)
        {
            return Err(LinkError::Duplicate {
                place: self.file.source.place(item.at),
                name: name.clone(),
                first: self.file.source.place(self.file.items[first].at),
            });
        }
        let locals = item.locals.iter().map(|(name, _)| name.clone());
        self.file.locals.extend(locals);
        self.file.items.push(item);
        Ok(())
    }

    /// The `}` that ends the function whose signature goes on at a token.
    fn body(&self, from: usize) -> Result<usize, LinkError> {
        let mut at = from;
        loop {
            match self.text(at) {
                "{" => return Ok(self.pairs[at]),
                "(" | "[" => at = self.pairs[at],
                text if text.is_empty() || text == ";" || DECLARATIONS.contains(&text) => {
                    return Err(self.malformed(from - 1, "the function has no body".to_owned()));
                }
                _ => {}
            }
            at += 1;
        }
    }

    /// The token after the template list of `var`, if it has one.
    fn after_template(&self, at: usize) -> usize {
        if self.text(at) != "<" {
            return at;
        }
        let end = (at..self.tokens.len()).find(|at| matches!(self.text(*at), ">" | ";"));
        match end {
            Some(end) if self.text(end) == ">" => end + 1,
            _ => self.tokens.len(),
        }
    }

    /// The words of a declaration that may be references, and those that it declares inside.
    fn words(
        &self,
        first: usize,
        last: usize,
        name: usize,
        members: &Range<usize>,
    ) -> Result<(Offsets, Vec<(String, usize)>), LinkError> {
        let mut words = Offsets::new();
        let mut locals = Vec::new();
        let mut at = first;
        while at <= last {
            let here = at;
            at += 1;
            match self.text(here) {
                "@" => {
                    // The arguments of these are no expressions.
                    let named = matches!(self.text(at), "builtin" | "interpolate" | "diagnostic");
                    at += 1;
                    if named && self.text(at) == "(" {
                        at = self.pairs[at];
                    }
                }
                "." if self.is_word(at) => at += 1,
                ":" if self.text(at) == ":" => {
                    let module = match self.text(here - 1) {
                        root if ROOTS.contains(&root) => self.text(here + 2),
                        module => module,
                    };
                    return Err(self.instead(here, "paths within a declaration are", module));
                }
                keyword @ ("var" | "let" | "const") => {
                    if keyword == "var" {
                        at = self.after_template(at);
                    }
                    if at != name && self.is_word(at) {
                        locals.push((self.text(at).to_owned(), self.offset(at)));
                        at += 1;
                    }
                }
                text if self.is_word(here) => {
                    if members.contains(&here) && self.text(at) == ":" {
                        locals.push((text.to_owned(), self.offset(here)));
                    } else if here != name {
                        words.entry(text.to_owned()).or_insert(self.offset(here));
                    }
                }
                _ => {}
            }
        }
        words.remove(self.text(name));
        Ok((words, locals))
    }
}

/// The start of a text that may be very long.
fn clip(text: &str) -> String {
    text.chars().take(40).collect()
}
