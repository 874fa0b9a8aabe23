//! A text's tokens with their brackets in pairs, and its comments aside.

use std::ops::Range;
use std::sync::Arc;

use super::super::error::LinkError;
use super::super::token::{Kind, Source, Token, tokenize};

/// The attributes by which WESL's features keep or remove what they stand before.
pub(crate) const CONDITIONS: [&str; 3] = ["if", "elif", "else"];

pub(crate) struct Tokens {
    pub source: Arc<Source>,
    pub all: Vec<Token>,
    pub comments: Vec<Range<usize>>,
    /// Lines and tags of other tools, which are passed on as they are.
    pub foreign: Vec<Range<usize>>,
    /// For each opening bracket its closing one.
    pub pairs: Vec<usize>,
}

/// The attributes before a declaration, a member or a statement.
pub(crate) struct Attributes {
    /// The token after them.
    pub head: usize,
    /// The `@` of each that is a condition, with the token after it.
    pub conditions: Vec<Range<usize>>,
}

impl Tokens {
    /// The tokens, with no brackets in pairs yet.
    pub fn read(source: Arc<Source>) -> Result<Self, LinkError> {
        let mut tokens = Self {
            all: Vec::new(),
            comments: Vec::new(),
            foreign: Vec::new(),
            pairs: Vec::new(),
            source,
        };
        for token in tokenize(&tokens.source)? {
            match token.kind {
                Kind::Comment => tokens.comments.push(token.span),
                Kind::Foreign => tokens.foreign.push(token.span),
                _ => tokens.all.push(token),
            }
        }
        Ok(tokens)
    }

    /// A token's text; empty past the end.
    pub fn text(&self, at: usize) -> &str {
        let token = self.all.get(at);
        token.map_or("", |token| &self.source.text[token.span.clone()])
    }

    pub fn is_word(&self, at: usize) -> bool {
        self.all.get(at).is_some_and(|token| token.kind == Kind::Word)
    }

    /// Offset of a token; of the last one past the end.
    pub fn offset(&self, at: usize) -> usize {
        let token = self.all.get(at).or(self.all.last());
        token.map_or(0, |token| token.span.start)
    }

    /// True of a token that is the first on its line.
    pub fn starts_line(&self, at: usize) -> bool {
        let end = at.checked_sub(1).map(|before| self.all[before].span.end);
        end.is_none_or(|end| self.source.breaks_between(end, self.offset(at)) > 0)
    }

    /// True of a token that ends where the next begins.
    pub fn touch(&self, at: usize) -> bool {
        self.all.get(at).is_some_and(|token| token.span.end == self.offset(at + 1))
    }

    pub fn span(&self, from: usize, to: usize) -> Range<usize> {
        self.all[from].span.start..self.all[to].span.end
    }

    pub fn malformed(&self, at: usize, what: String) -> LinkError {
        LinkError::Malformed { place: self.source.place(self.offset(at)), what }
    }

    /// Finds each bracket's other half.
    pub fn pair(&mut self) -> Result<(), LinkError> {
        self.pairs = vec![0; self.all.len()];
        let mut open = Vec::new();
        for at in 0..self.all.len() {
            let expected = match self.text(at) {
                "(" | "[" | "{" => {
                    open.push(at);
                    continue;
                }
                ")" => "(",
                "]" => "[",
                "}" => "{",
                _ => continue,
            };
            match open.pop() {
                Some(start) if self.text(start) == expected => self.pairs[start] = at,
                _ => return Err(self.malformed(at, format!("unbalanced `{}`", self.text(at)))),
            }
        }
        match open.pop() {
            Some(at) => Err(self.malformed(at, format!("`{}` is not closed", self.text(at)))),
            None => Ok(()),
        }
    }

    /// True of the `@` of a condition.
    pub fn is_condition(&self, at: usize) -> bool {
        self.text(at) == "@" && CONDITIONS.contains(&self.text(at + 1))
    }

    /// True where a condition is among the attributes at a token.
    pub fn is_conditional(&self, first: usize) -> bool {
        !self.attributes(first).conditions.is_empty()
    }

    /// The attributes from a token on.
    pub fn attributes(&self, first: usize) -> Attributes {
        let (mut at, mut conditions) = (first, Vec::new());
        while self.text(at) == "@" {
            let start = at;
            at += 2;
            // what follows in brackets is the statement's: `@else (x)++`
            if self.text(start + 1) != "else" && self.text(at) == "(" {
                at = self.pairs[at] + 1;
            }
            if self.is_condition(start) {
                conditions.push(start..at);
            }
        }
        Attributes { head: at.min(self.all.len()), conditions }
    }

    /// The `;` or closing brace that ends the declaration or statement at a token, which has no
    /// attributes before it; the last token where nothing ends it.
    pub fn end(&self, head: usize) -> usize {
        let block = matches!(
            self.text(head),
            "{" | "fn"
                | "struct"
                | "if"
                | "switch"
                | "for"
                | "while"
                | "loop"
                | "continuing"
                | "case"
                | "default"
        );
        let import = self.text(head) == "import";
        let mut at = head;
        while at < self.all.len() {
            match self.text(at) {
                "{" if block => {
                    let end = self.pairs[at];
                    if self.text(end + 1) != "else" || self.text(head) != "if" {
                        return end;
                    }
                    at = end;
                }
                "{" if import => at = self.pairs[at],
                "(" | "[" => at = self.pairs[at],
                ";" => return at,
                // the end of the block or list that the statement is in
                "}" | ")" | "]" => return at - 1,
                _ => {}
            }
            at += 1;
        }
        self.all.len() - 1
    }
}
