//! Where conditions may stand, and what each removes.

use std::collections::BTreeSet;
use std::ops::Range;

use super::super::error::{LinkError, condition};
use super::super::parse::Tokens;
use super::Features;
use super::expression::Expression;

/// What stands between two tokens.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Siblings {
    Declarations,
    /// Of a structure or of a function's parameters, with commas between.
    Members,
    Statements,
}

struct Walker<'a> {
    tokens: &'a Tokens,
    features: &'a Features,
    /// What goes, in bytes.
    cuts: Vec<Range<usize>>,
    /// The same in tokens.
    gone: Vec<Range<usize>>,
    names: BTreeSet<String>,
    todo: Vec<(Range<usize>, Siblings)>,
}

/// What to cut out of a text, and the features that its conditions ask for.
pub(super) fn walk(
    tokens: &Tokens,
    features: &Features,
) -> Result<(Vec<Range<usize>>, BTreeSet<String>), LinkError> {
    let mut walker = Walker {
        tokens,
        features,
        cuts: Vec::new(),
        gone: Vec::new(),
        names: BTreeSet::new(),
        todo: vec![(0..tokens.all.len(), Siblings::Declarations)],
    };
    while let Some((range, kind)) = walker.todo.pop() {
        walker.siblings(range, kind)?;
    }
    walker.gone.sort_by_key(|range| range.start);
    let mut end = 0;
    let mut gone = walker.gone.iter().peekable();
    for at in (0..tokens.all.len()).filter(|at| tokens.is_condition(*at)) {
        while let Some(range) = gone.next_if(|range| range.start <= at) {
            end = end.max(range.end);
        }
        if at >= end {
            let what = format!(
                "`@{}` cannot stand here: it goes before an import, directive, declaration, \
                 parameter, member, statement or `case`",
                tokens.text(at + 1)
            );
            return Err(condition(tokens, at, what));
        }
    }
    Ok((walker.cuts, walker.names))
}

impl Walker<'_> {
    fn siblings(&mut self, range: Range<usize>, kind: Siblings) -> Result<(), LinkError> {
        // whether one of the `@if` and `@elif` so far was true; none where no `@else` may follow
        let mut taken = None;
        let mut at = range.start;
        while at < range.end {
            if self.tokens.text(at) == ";" && kind != Siblings::Members {
                at += 1;
                continue;
            }
            let attributes = self.tokens.attributes(at);
            let keep = match attributes.conditions.as_slice() {
                [] => {
                    taken = None;
                    true
                }
                [one] => self.keeps(one, &mut taken)?,
                [_, other, ..] => {
                    let what = "two conditions on one thing; join them by `&&`".to_owned();
                    return Err(condition(self.tokens, other.start, what));
                }
            };
            let head = attributes.head;
            let end = match kind {
                Siblings::Members => self.member_end(head, range.end),
                _ => self.tokens.end(head),
            };
            if head >= range.end || end < head {
                let Some(one) = attributes.conditions.first() else { return Ok(()) };
                let what = format!("nothing follows `@{}`", self.tokens.text(one.start + 1));
                return Err(condition(self.tokens, one.start, what));
            }
            if keep {
                for one in attributes.conditions {
                    self.cuts.push(self.tokens.span(one.start, one.end - 1));
                    self.gone.push(one);
                }
                self.inside(head, end, kind);
            } else {
                self.cuts.push(self.with_comments(at, end));
                self.gone.push(at..end + 1);
            }
            at = end + 1;
        }
        Ok(())
    }

    fn keeps(&mut self, one: &Range<usize>, taken: &mut Option<bool>) -> Result<bool, LinkError> {
        let word = self.tokens.text(one.start + 1);
        let before = match word {
            "if" => Some(false),
            "elif" => *taken,
            _ => taken.take(),
        };
        let Some(before) = before else {
            let what = format!("`@{word}` does not follow what has `@if` or `@elif`");
            return Err(condition(self.tokens, one.start, what));
        };
        if word == "else" {
            return Ok(!before);
        }
        if one.len() < 3 {
            let what = format!("`@{word}` lacks its condition; write `@{word}(FEATURE)`");
            return Err(condition(self.tokens, one.start, what));
        }
        let (from, to) = (one.start + 3, one.end - 1);
        let expression = Expression::between(self.tokens, self.features, &mut self.names, from, to);
        let value = expression.value()?;
        *taken = Some(before || value);
        Ok(value && !before)
    }

    /// The comma after a member, or its last token.
    fn member_end(&self, head: usize, to: usize) -> usize {
        let mut templates = 0usize;
        let mut at = head;
        while at < to {
            match self.tokens.text(at) {
                "(" | "[" | "{" => at = self.tokens.pairs[at],
                // `<<` and `<=` are operators
                "<" if self.tokens.touch(at) && matches!(self.tokens.text(at + 1), "<" | "=") => {
                    at += 1;
                }
                "<" => templates += 1,
                ">" => templates = templates.saturating_sub(1),
                "," if templates == 0 => return at,
                _ => {}
            }
            at += 1;
        }
        to - 1
    }

    /// What is left to walk in something that is kept.
    fn inside(&mut self, head: usize, end: usize, kind: Siblings) {
        let text = self.tokens.text(head);
        match kind {
            Siblings::Members => return,
            Siblings::Declarations if !matches!(text, "fn" | "struct") => return,
            _ => {}
        }
        let mut at = head;
        let mut parameters = kind == Siblings::Declarations && text == "fn";
        while at < end {
            match self.tokens.text(at) {
                "(" | "[" => {
                    if std::mem::take(&mut parameters) {
                        self.todo.push((at + 1..self.tokens.pairs[at], Siblings::Members));
                    }
                    at = self.tokens.pairs[at];
                }
                "{" => {
                    let of = match (kind, text) {
                        (Siblings::Declarations, "struct") => Siblings::Members,
                        _ => Siblings::Statements,
                    };
                    self.todo.push((at + 1..self.tokens.pairs[at], of));
                    at = self.tokens.pairs[at];
                }
                _ => {}
            }
            at += 1;
        }
    }

    /// Tokens with the doc comments right above them and the comment that ends their last line.
    fn with_comments(&self, first: usize, last: usize) -> Range<usize> {
        let tokens = self.tokens;
        let span = tokens.span(first, last);
        let mut start = span.start;
        if tokens.starts_line(first) {
            let above = tokens.leading_comments(first);
            let below = tokens.comments.partition_point(|comment| comment.start < start);
            let doc = |comment: &&Range<usize>| {
                let text = &tokens.source.text[(*comment).clone()];
                text.starts_with("///") || text.starts_with("/**")
            };
            let docs = tokens.comments[above..below].iter().rev().take_while(doc);
            start = docs.last().map_or(start, |comment| comment.start);
        }
        let end = if tokens.starts_line(last + 1) || last + 1 == tokens.all.len() {
            tokens.end_of_line_comment(span.end)
        } else {
            span.end
        };
        start..end
    }
}
