//! Source text and its tokens.

use std::ops::Range;

use super::error::{LinkError, Place};

/// A text with its path and the offsets at which its lines start.
#[derive(Debug)]
pub(crate) struct Source {
    pub path: String,
    pub text: String,
    starts: Vec<usize>,
}

impl Source {
    /// Drops a byte order mark and turns `\r\n` into `\n`, so that a checkout's line endings
    /// change neither the linked text nor any column.
    pub fn new(path: &str, text: &str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let text = text.replace("\r\n", "\n");
        let breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        let starts = std::iter::once(0).chain(breaks).collect();
        Self { path: path.to_owned(), text, starts }
    }

    /// The 1-based line of a byte offset.
    pub fn line_at(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset)
    }

    /// Offset at which the line of a byte offset starts.
    pub fn line_start(&self, offset: usize) -> usize {
        self.starts[self.line_at(offset) - 1]
    }

    /// A line's text, without its end.
    pub fn line(&self, line: usize) -> Option<&str> {
        let start = *self.starts.get(line.checked_sub(1)?)?;
        self.text[start..].split('\n').next()
    }

    pub fn place(&self, offset: usize) -> Place {
        Place { file: self.path.clone(), line: self.line_at(offset) }
    }

    /// The number of line breaks between two offsets.
    pub fn breaks_between(&self, from: usize, to: usize) -> usize {
        self.line_at(to) - self.line_at(from)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Word,
    Number,
    /// One character of punctuation: `>>` is two tokens, since it may close two templates.
    Mark,
    Comment,
}

#[derive(Clone, Debug)]
pub(crate) struct Token {
    pub kind: Kind,
    pub span: Range<usize>,
}

/// WGSL's blankspace, which holds its line breaks.
fn is_blank(c: char) -> bool {
    matches!(c, ' ' | '\t'..='\r' | '\u{85}' | '\u{200e}' | '\u{200f}' | '\u{2028}' | '\u{2029}')
}

fn ends_line(c: char) -> bool {
    matches!(c, '\n'..='\r' | '\u{85}' | '\u{2028}' | '\u{2029}')
}

/// Any non-ASCII character counts as a letter here: which of them are is the validator's matter.
pub(crate) fn is_word_char(c: char) -> bool {
    c == '_' || c.is_ascii_alphanumeric() || (!c.is_ascii() && !is_blank(c))
}

pub(crate) fn is_word(text: &str) -> bool {
    !text.starts_with(|c: char| c.is_ascii_digit())
        && !text.is_empty()
        && text.chars().all(is_word_char)
}

/// Cuts a text into tokens. Fails only on a comment that is not closed.
pub(crate) fn tokenize(source: &Source) -> Result<Vec<Token>, LinkError> {
    let text = source.text.as_str();
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let next = rest[c.len_utf8()..].chars().next().unwrap_or(' ');
        let (kind, length) = match (c, next) {
            (c, _) if is_blank(c) => {
                at += c.len_utf8();
                continue;
            }
            ('/', '/') => (Kind::Comment, rest.find(ends_line).unwrap_or(rest.len())),
            ('/', '*') => match block_comment(rest) {
                Some(length) => (Kind::Comment, length),
                None => {
                    let what = "unterminated comment".to_owned();
                    return Err(LinkError::Malformed { place: source.place(at), what });
                }
            },
            ('0'..='9', _) | ('.', '0'..='9') => (Kind::Number, number(rest)),
            (c, _) if is_word_char(c) => {
                let end = rest.find(|c| !is_word_char(c));
                (Kind::Word, end.unwrap_or(rest.len()))
            }
            (c, _) => (Kind::Mark, c.len_utf8()),
        };
        let span = at..at + length;
        at = span.end;
        tokens.push(Token { kind, span });
    }
    Ok(tokens)
}

/// Length of the block comment at the start of a text; they nest.
fn block_comment(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0usize, 0);
    loop {
        match bytes.get(at..at + 2)? {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return Some(at);
        }
    }
}

/// Length of the number at the start of a text; the sign of an exponent belongs to it.
fn number(text: &str) -> usize {
    let hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    let mut before = ' ';
    let end = text.find(|c: char| {
        let exponent = match before {
            'e' | 'E' => !hexadecimal,
            'p' | 'P' => hexadecimal,
            _ => false,
        };
        before = c;
        !(c.is_ascii_alphanumeric() || c == '.' || (exponent && (c == '+' || c == '-')))
    });
    end.unwrap_or(text.len())
}
