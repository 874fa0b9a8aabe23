//! Tokens of a text.

use std::ops::Range;

use super::error::LinkError;
use super::placeholder::{line_or_tag, placeholder};
pub(crate) use super::source::Source;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// An identifier or keyword, which may hold placeholders: `light_#{NAME}`.
    Word,
    Number,
    /// One character of punctuation: `>>` is two tokens, since it may close two templates.
    Mark,
    Comment,
    /// A line or tag of another tool: `#ifdef NAME`.
    Foreign,
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
            _ => {
                let foreign = match c {
                    '#' | '{' | '<' => line_or_tag(rest, starts_line(text, at)),
                    _ => None,
                };
                match (foreign, word(rest)) {
                    (Some(length), _) => (Kind::Foreign, length),
                    (None, 0) => (Kind::Mark, c.len_utf8()),
                    (None, length) => (Kind::Word, length),
                }
            }
        };
        let span = at..at + length;
        at = span.end;
        tokens.push(Token { kind, span });
    }
    Ok(tokens)
}

fn starts_line(text: &str, at: usize) -> bool {
    let before = text[..at].trim_end_matches([' ', '\t']);
    before.is_empty() || before.ends_with('\n')
}

/// Length of the word at the start of a text, with the placeholders in it; 0 if there is none.
fn word(text: &str) -> usize {
    let mut end = 0;
    while let Some(c) = text[end..].chars().next() {
        end += match c {
            c if is_word_char(c) => c.len_utf8(),
            '#' | '$' | '{' | '<' => match placeholder(&text[end..]) {
                Some(length) => length,
                None => break,
            },
            _ => break,
        };
    }
    end
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
