//! The lines of OBJ and MTL files.

use std::borrow::Cow;

use glam::DVec3;

/// One statement, which may take several lines.
pub(super) struct Statement<'a> {
    /// Its first line, from 1.
    pub line: usize,
    pub keyword: &'a str,
    /// What follows, with a comment if there is one: only names may have its sign in them.
    pub rest: &'a str,
}

/// Longest part of a line in a message.
const SHOWN: usize = 60;

/// Lines with their numbers, from 1. A `\` at a line's end continues it, but for comments.
pub(super) fn statements(text: &str) -> Vec<(usize, Cow<'_, str>)> {
    // as old Macs end lines
    let separator = if text.contains('\n') { '\n' } else { '\r' };
    let mut lines: Vec<(usize, Cow<str>)> = Vec::new();
    let mut is_continued = false;
    for (i, line) in text.split(separator).enumerate() {
        let line = line.trim();
        let (part, continues) = match line.strip_suffix('\\') {
            Some(part) if is_continued || !line.starts_with('#') => (part, true),
            _ => (line, false),
        };
        match lines.last_mut() {
            Some((_, last)) if is_continued => {
                let last = last.to_mut();
                last.push(' ');
                last.push_str(part);
            }
            _ => lines.push((i + 1, part.into())),
        }
        is_continued = continues;
    }
    lines
}

/// A line's keyword and the rest; `None` for an empty one or a comment.
pub(super) fn statement<'a>((line, text): &'a (usize, Cow<'a, str>)) -> Option<Statement<'a>> {
    let text = text.trim();
    if text.is_empty() || text.starts_with('#') {
        return None;
    }
    let (keyword, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    Some(Statement { line: *line, keyword, rest: rest.trim() })
}

impl Statement<'_> {
    /// A message that says where the statement is.
    pub fn fault(&self, what: &str) -> String {
        let Self { line, keyword, rest } = self;
        message(*line, &format!("{keyword} {rest}"), what)
    }
}

/// The same for a line whose statement is gone.
pub(super) fn fault(text: &str, line: usize, what: &str) -> String {
    let separator = if text.contains('\n') { '\n' } else { '\r' };
    message(line, text.split(separator).nth(line - 1).unwrap_or_default(), what)
}

fn message(line: usize, text: &str, what: &str) -> String {
    let text = text.trim();
    let shown: String = text.chars().take(SHOWN).collect();
    let more = if shown.len() < text.len() { "…" } else { "" };
    format!("line {line}, `{shown}{more}`: {what}")
}

/// Up to the sign of a comment.
pub(super) fn without_comment(text: &str) -> &str {
    text.split('#').next().unwrap_or_default().trim_end()
}

/// A name up to a comment, whose sign stands alone: names may have it in them.
pub(super) fn name(text: &str) -> &str {
    let comment = text.find(" #").or_else(|| text.find("\t#"));
    text[..comment.unwrap_or(text.len())].trim_end()
}

/// The first three numbers; others may follow, as a vertex may have a weight, a colour and alpha.
pub(super) fn numbers(text: &str) -> Option<DVec3> {
    let mut parts = without_comment(text).split_whitespace().map(|part| part.parse().ok());
    let mut next = || parts.next().flatten();
    Some(DVec3::new(next()?, next()?, next()?))
}
