//! What `@if(...)` asks: features with `!`, `&&`, `||`, parentheses, `true` and `false`.

use std::collections::BTreeSet;

use super::super::error::{LinkError, condition};
use super::super::parse::Tokens;
use super::Features;

/// Parentheses and `!` in one another; no condition for people needs more.
const DEEPEST: usize = 64;

pub(super) struct Expression<'a> {
    pub tokens: &'a Tokens,
    pub features: &'a Features,
    /// Every feature that was asked for.
    pub names: &'a mut BTreeSet<String>,
    at: usize,
    end: usize,
}

impl<'a> Expression<'a> {
    /// The expression between two tokens.
    pub fn between(
        tokens: &'a Tokens,
        features: &'a Features,
        names: &'a mut BTreeSet<String>,
        from: usize,
        to: usize,
    ) -> Self {
        Self { tokens, features, names, at: from, end: to }
    }

    /// Its value. Every feature in it must be given, also where the rest decides.
    pub fn value(mut self) -> Result<bool, LinkError> {
        let value = self.operators(0)?;
        if self.next() == "," {
            self.at += 1;
        }
        match self.next() {
            "" => Ok(value),
            other => Err(self.wrong(format!("`{other}` is not expected here"))),
        }
    }

    fn next(&self) -> &'a str {
        if self.at < self.end { self.tokens.text(self.at) } else { "" }
    }

    fn wrong(&self, what: String) -> LinkError {
        let what =
            format!("{what}; a condition is made of features, `!`, `&&`, `||` and parentheses");
        condition(self.tokens, self.at.min(self.end), what)
    }

    /// `a && b && c` or `a || b || c`: WGSL takes no mixture without parentheses.
    fn operators(&mut self, depth: usize) -> Result<bool, LinkError> {
        let mut value = self.operand(depth)?;
        let mut operator = "";
        loop {
            let next = match self.next() {
                text @ ("&" | "|")
                    if self.at + 1 < self.end
                        && self.tokens.text(self.at + 1) == text
                        && self.tokens.touch(self.at) =>
                {
                    text
                }
                text @ ("&" | "|") => {
                    return Err(
                        self.wrong(format!("`{text}` is not expected here; write `{text}{text}`"))
                    );
                }
                _ => return Ok(value),
            };
            if !operator.is_empty() && operator != next {
                let what = "`&&` and `||` side by side need parentheses around one of them";
                return Err(condition(self.tokens, self.at, what.to_owned()));
            }
            operator = next;
            self.at += 2;
            let other = self.operand(depth)?;
            value = if next == "&" { value && other } else { value || other };
        }
    }

    fn operand(&mut self, depth: usize) -> Result<bool, LinkError> {
        if depth > DEEPEST {
            return Err(
                self.wrong(format!("more than {DEEPEST} `!` and parentheses in each other"))
            );
        }
        let text = self.next();
        let here = self.at;
        self.at += 1;
        match text {
            "!" => Ok(!self.operand(depth + 1)?),
            "(" => {
                let value = self.operators(depth + 1)?;
                match self.next() {
                    ")" => {
                        self.at += 1;
                        Ok(value)
                    }
                    other => Err(self.wrong(format!("expected `)`, found `{other}`"))),
                }
            }
            "true" => Ok(true),
            "false" => Ok(false),
            name if self.tokens.is_word(here) && super::super::token::is_word(name) => {
                self.names.insert(name.to_owned());
                self.features.get(name).ok_or_else(|| self.not_given(here, name))
            }
            other => {
                self.at = here;
                Err(self.wrong(match other {
                    "" => "a feature is missing".to_owned(),
                    other => format!("`{other}` is no feature"),
                }))
            }
        }
    }

    fn not_given(&self, at: usize, name: &str) -> LinkError {
        LinkError::FeatureNotGiven {
            place: self.tokens.source.place(self.tokens.offset(at)),
            name: name.to_owned(),
            near: super::super::names::nearest(name, self.features.names()),
        }
    }
}
