//! Which comments belong to what.

use super::Parser;

impl Parser {
    /// Index of the first comment of those that stand above a token with no blank line between.
    pub(super) fn leading_comments(&self, token: usize) -> usize {
        let source = &self.file.source;
        let before = token.checked_sub(1).map(|token| self.tokens[token].span.end);
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

    pub(super) fn end_of_line_comment(&self, end: usize) -> usize {
        let index = self.comments.partition_point(|comment| comment.start < end);
        let comment = self.comments.get(index).filter(|comment| {
            let text = &self.file.source.text[end..comment.start];
            text.trim().is_empty() && self.file.source.breaks_between(end, comment.start) == 0
        });
        comment.map_or(end, |comment| comment.end)
    }

    /// The text of the doc comments from an index up to an offset.
    pub(super) fn doc(&self, from: usize, to: usize) -> String {
        let comments = self.comments[from..].iter();
        let comments = comments.take_while(|comment| comment.end <= to);
        let mut lines = Vec::new();
        for comment in comments {
            let text = &self.file.source.text[comment.clone()];
            if let Some(line) = text.strip_prefix("///") {
                lines.push(line.strip_prefix(' ').unwrap_or(line).trim_end());
            } else if let Some(block) = text.strip_prefix("/**") {
                let block = block.strip_suffix("*/").unwrap_or(block);
                lines.extend(block.lines().map(|line| line.trim().trim_start_matches("* ")));
            }
        }
        lines.join("\n").trim().to_owned()
    }

    pub(super) fn header(&mut self) {
        let mut end = self.comments.len();
        if !self.tokens.is_empty() {
            let first = self.offset(0);
            let declares = self.file.import_spans.first().map(|span| span.start) != Some(first)
                && self.file.directives.first().map(|(_, span)| span.start) != Some(first);
            end = match declares {
                true => self.leading_comments(0),
                false => self.comments.partition_point(|comment| comment.start < first),
            };
        }
        let Some(last) = end.checked_sub(1) else {
            return;
        };
        self.file.header = Some(self.comments[0].start..self.comments[last].end);
        let doc = self.doc(0, self.comments[last].end);
        self.file.summary = doc.lines().next().unwrap_or("").to_owned();
    }
}
