//! Which comments belong to what.

use super::Parser;
use super::tokens::Tokens;

impl Tokens {
    /// Index of the first comment of those that stand above a token with no blank line between.
    pub fn leading_comments(&self, token: usize) -> usize {
        let source = &self.source;
        let before = token.checked_sub(1).map(|token| self.all[token].span.end);
        let mut below = self.offset(token);
        let mut index = self.comments.partition_point(|comment| comment.start < below);
        while let Some(comment) = index.checked_sub(1).map(|index| &self.comments[index]) {
            let trails = before.is_some_and(|end| {
                comment.start < end || source.breaks_between(end, comment.start) == 0
            });
            if trails || source.breaks_between(comment.end, below) > 1 {
                break;
            }
            below = comment.start;
            index -= 1;
        }
        index
    }

    pub fn end_of_line_comment(&self, end: usize) -> usize {
        let index = self.comments.partition_point(|comment| comment.start < end);
        let comment = self.comments.get(index).filter(|comment| {
            let text = &self.source.text[end..comment.start];
            text.trim().is_empty() && self.source.breaks_between(end, comment.start) == 0
        });
        comment.map_or(end, |comment| comment.end)
    }

    /// The text of the doc comments from an index up to an offset.
    pub fn doc(&self, from: usize, to: usize) -> String {
        let comments = self.comments[from..].iter();
        let comments = comments.take_while(|comment| comment.end <= to);
        let mut lines = Vec::new();
        for comment in comments {
            let text = &self.source.text[comment.clone()];
            if let Some(line) = text.strip_prefix("///") {
                lines.push(line.strip_prefix(' ').unwrap_or(line).trim_end());
            } else if let Some(block) = text.strip_prefix("/**") {
                let block = block.strip_suffix("*/").unwrap_or(block);
                lines.extend(block.lines().map(|line| line.trim().trim_start_matches("* ")));
            }
        }
        lines.join("\n").trim().to_owned()
    }
}

impl Parser {
    pub(super) fn header(&mut self) {
        let mut end = self.tokens.comments.len();
        if !self.tokens.all.is_empty() {
            let first = self.tokens.offset(0);
            let declares = self.file.import_spans.first().map(|span| span.start) != Some(first)
                && self.file.directives.first().map(|(_, span)| span.start) != Some(first);
            end = match declares {
                true => self.tokens.leading_comments(0),
                false => self.tokens.comments.partition_point(|comment| comment.start < first),
            };
        }
        let Some(last) = end.checked_sub(1) else {
            return;
        };
        self.file.header = Some(self.tokens.comments[0].start..self.tokens.comments[last].end);
        let doc = self.tokens.doc(0, self.tokens.comments[last].end);
        self.file.summary = doc.lines().next().unwrap_or("").to_owned();
    }
}
