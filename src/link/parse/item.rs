//! Declarations: where they end, what they declare inside and what they may refer to.

use std::ops::Range;

use super::super::error::LinkError;
use super::super::placeholder::plain;
use super::super::token::is_word;
use super::import::ROOTS;
use super::tokens::CONDITIONS;
use super::{DECLARATIONS, DIRECTIVES, Item, Offsets, Parser};

/// Names, and where each is.
pub(super) type Locals = Vec<(String, usize)>;

impl Parser {
    /// Reads the declaration at a token, or in a user's shader whatever else another compiler may
    /// know, and returns the token after it.
    pub(super) fn item_or_text(&mut self, first: usize) -> Result<usize, LinkError> {
        let head = self.tokens.attributes(first).head;
        let unknown =
            !DECLARATIONS.contains(&self.tokens.text(head)) && head < self.tokens.all.len();
        let own = self.file.module.is_some();
        match self.item(first) {
            // what is plainly WGSL is told here and now what is wrong with it
            Err(LinkError::Malformed { .. }) if !own && (unknown || self.finished_by_another) => {
                self.other_text(first)
            }
            result => result,
        }
    }

    /// Reads the declaration at a token and returns the token after it.
    fn item(&mut self, first: usize) -> Result<usize, LinkError> {
        let at = self.tokens.attributes(first).head;
        let Some(kind) = DECLARATIONS.into_iter().find(|kind| *kind == self.tokens.text(at)) else {
            let what = match self.tokens.text(at) {
                "" => "a declaration is missing after its attributes".to_owned(),
                text => format!("expected a declaration, found `{}`", clip(text)),
            };
            return Err(self.tokens.malformed(at, what));
        };
        let mut name = at;
        if kind != "const_assert" {
            name = if kind == "var" { self.after_template(at + 1) } else { at + 1 };
            if !self.tokens.is_word(name) {
                return Err(self.tokens.malformed(at, format!("expected a name after `{kind}`")));
            }
        }
        let (members, last) = match kind {
            "fn" if self.tokens.text(name + 1) == "(" => {
                let close = self.tokens.pairs[name + 1];
                (name + 1..close, self.body(close + 1)?)
            }
            "struct" if self.tokens.text(name + 1) == "{" => {
                let close = self.tokens.pairs[name + 1];
                (name + 1..close, close)
            }
            "fn" | "struct" => {
                let bracket = if kind == "fn" { "(" } else { "{" };
                let what =
                    format!("expected `{bracket}` after `{kind} {}`", clip(self.tokens.text(name)));
                return Err(self.tokens.malformed(name, what));
            }
            _ => (0..0, self.statement_end(at + 1)?),
        };

        let (words, locals) = self.words(first, last, name, &members)?;
        // a placeholder is no name yet
        let named = kind != "const_assert" && is_word(self.tokens.text(name));
        self.add(kind, named, name, first..last, (words, locals))?;
        Ok(last + 1)
    }

    fn add(
        &mut self,
        kind: &'static str,
        named: bool,
        name: usize,
        tokens: Range<usize>,
        (words, locals): (Offsets, Locals),
    ) -> Result<(), LinkError> {
        let (first, start) = (self.tokens.offset(tokens.start), tokens.start);
        let above = self.tokens.leading_comments(start);
        let comment = self.tokens.comments.get(above).map(|comment| comment.start.min(first));
        let end = self.tokens.end_of_line_comment(self.tokens.all[tokens.end].span.end);
        let item = Item {
            kind,
            name: named.then(|| self.tokens.text(name).to_owned()),
            at: self.tokens.offset(name),
            span: comment.unwrap_or(first)..end,
            doc: self.tokens.doc(above, first),
            words,
            locals,
            conditional: self.tokens.is_conditional(start),
            mates: Vec::new(),
        };
        let index = self.file.items.len();
        let same = item.name.as_ref().and_then(|name| self.file.names.get(name).copied());
        if let Some(first) = same {
            // which of them stays is decided later
            let open = item.conditional && self.file.items[first].conditional;
            if !open && !self.finished_by_another {
                return Err(LinkError::Duplicate {
                    place: self.file.source.place(item.at),
                    name: item.name.unwrap_or_default(),
                    first: self.file.source.place(self.file.items[first].at),
                });
            }
        } else if let Some(name) = &item.name {
            self.file.names.insert(name.clone(), index);
        }
        let locals = item.locals.iter().map(|(name, _)| name.clone());
        self.file.locals.extend(locals);
        self.file.items.push(item);
        if let Some(first) = same {
            self.mates(first, index);
        }
        Ok(())
    }

    /// What is no declaration of WGSL: up to its `;` or braces, or to the declaration on the next
    /// line.
    fn other_text(&mut self, first: usize) -> Result<usize, LinkError> {
        let tokens = &self.tokens;
        let starts_next = |at: usize| {
            let text = tokens.text(at);
            let known = text == "@" || text == "import" || DECLARATIONS.contains(&text);
            tokens.starts_line(at) && (known || DIRECTIVES.contains(&text))
        };
        let head = tokens.attributes(first).head.min(tokens.all.len() - 1);
        let mut last = head;
        loop {
            match tokens.text(last) {
                "{" => {
                    last = tokens.pairs[last];
                    break;
                }
                "(" | "[" => last = tokens.pairs[last],
                ";" => break,
                _ => {}
            }
            if last + 1 >= tokens.all.len() || starts_next(last + 1) {
                break;
            }
            last += 1;
        }
        if is_word(tokens.text(head)) || !tokens.is_word(head) {
            let mark = super::unknown(tokens, head);
            self.file.marks.push(mark);
        }
        let (words, mut locals) = self.words(first, last, usize::MAX, &(0..0))?;
        locals.extend(self.declared(first..last + 1));
        self.add("text", false, head, first..last, (words, locals))?;
        Ok(last + 1)
    }

    /// The names that follow the keywords of declarations, or stand before a type.
    pub(super) fn declared(&self, range: Range<usize>) -> Locals {
        let tokens = &self.tokens;
        let named = |at: &usize| {
            let before = at.checked_sub(1).map_or("", |before| tokens.text(before));
            let typed = tokens.text(at + 1) == ":" && tokens.text(at + 2) != ":";
            tokens.is_word(*at) && (before == "let" || DECLARATIONS.contains(&before) || typed)
        };
        let name = |at: usize| (tokens.text(at).to_owned(), tokens.offset(at));
        range.filter(named).map(name).collect()
    }

    /// The `}` that ends the function whose signature goes on at a token.
    fn body(&self, from: usize) -> Result<usize, LinkError> {
        let mut at = from;
        loop {
            match self.tokens.text(at) {
                "{" => return Ok(self.tokens.pairs[at]),
                "(" | "[" => at = self.tokens.pairs[at],
                text if text.is_empty() || text == ";" || DECLARATIONS.contains(&text) => {
                    return Err(self
                        .tokens
                        .malformed(from - 1, "the function has no body".to_owned()));
                }
                _ => {}
            }
            at += 1;
        }
    }

    /// The token after the template list of `var`, if it has one.
    fn after_template(&self, at: usize) -> usize {
        if self.tokens.text(at) != "<" {
            return at;
        }
        let end = (at..self.tokens.all.len()).find(|at| matches!(self.tokens.text(*at), ">" | ";"));
        match end {
            Some(end) if self.tokens.text(end) == ">" => end + 1,
            _ => self.tokens.all.len(),
        }
    }

    /// The words of a declaration that may be references, and those that it declares inside.
    fn words(
        &self,
        first: usize,
        last: usize,
        name: usize,
        members: &Range<usize>,
    ) -> Result<(Offsets, Locals), LinkError> {
        let unknown = name == usize::MAX;
        let mut words = Offsets::new();
        let mut locals = Vec::new();
        let mut at = first;
        while at <= last {
            let here = at;
            at += 1;
            match self.tokens.text(here) {
                "@" => {
                    // The arguments of these are no expressions.
                    let word = self.tokens.text(at);
                    let named = matches!(word, "builtin" | "interpolate" | "diagnostic")
                        || CONDITIONS.contains(&word) && word != "else";
                    at += 1;
                    if named && self.tokens.text(at) == "(" {
                        at = self.tokens.pairs[at];
                    }
                }
                "." if self.tokens.is_word(at) => at += 1,
                // a tool's own paths are its own matter
                ":" if self.tokens.text(at) == ":"
                    && (self.finished_by_another || unknown)
                    && !ROOTS.contains(&self.tokens.text(here.max(1) - 1)) => {}
                ":" if self.tokens.text(at) == ":" => {
                    let module = match self.tokens.text(here - 1) {
                        root if ROOTS.contains(&root) => self.tokens.text(here + 2),
                        module => module,
                    };
                    return Err(self.instead(here, "paths within a declaration are", module));
                }
                keyword @ ("var" | "let" | "const") => {
                    if keyword == "var" {
                        at = self.after_template(at);
                    }
                    if at != name && self.tokens.is_word(at) {
                        locals.push((self.tokens.text(at).to_owned(), self.tokens.offset(at)));
                        at += 1;
                    }
                }
                text if self.tokens.is_word(here) => {
                    if members.contains(&here) && self.tokens.text(at) == ":" {
                        locals.push((text.to_owned(), self.tokens.offset(here)));
                    } else if here != name {
                        words.entry(plain(text).to_owned()).or_insert(self.tokens.offset(here));
                    }
                }
                _ => {}
            }
        }
        words.remove(self.tokens.text(name));
        Ok((words, locals))
    }
}

/// The start of a text that may be very long.
pub(super) fn clip(text: &str) -> String {
    text.chars().take(40).collect()
}
