//! A text whose brackets another tool must choose between: its imports and directives, and all the
//! rest as it is.

use super::super::error::LinkError;
use super::super::foreign::{Mark, Tool};
use super::super::placeholder::plain;
use super::{DIRECTIVES, Item, Offsets, Parser};

impl Parser {
    pub(super) fn loose(&mut self) -> Result<(), LinkError> {
        let count = self.tokens.all.len();
        let (mut words, mut at) = (Offsets::new(), 0);
        while at < count {
            let text = self.tokens.text(at);
            let starts = at == 0 || matches!(self.tokens.text(at - 1), ";" | "}");
            let import = text == "import";
            if starts && (import || DIRECTIVES.contains(&text)) {
                let end = (at..count).find(|at| self.tokens.text(*at) == ";");
                let end = end.ok_or_else(|| self.missing_end(count))?;
                match import {
                    true => self.import(at, at, end)?,
                    false => self.directive(at, end),
                }
                at = end + 1;
                continue;
            }
            if self.tokens.is_word(at) && (at == 0 || self.tokens.text(at - 1) != ".") {
                words.entry(plain(text).to_owned()).or_insert(self.tokens.offset(at));
            }
            at += 1;
        }
        let locals = self.declared(0..count);
        self.file.locals.extend(locals.iter().map(|(name, _)| name.clone()));
        let at = self.tokens.offset(0);
        self.file.marks.push(Mark { tool: Tool::Brackets, at, text: String::new() });
        self.file.items.push(Item {
            kind: "text",
            name: None,
            at,
            span: 0..self.file.source.text.len(),
            doc: String::new(),
            words,
            locals,
            conditional: false,
            mates: Vec::new(),
        });
        Ok(())
    }
}
