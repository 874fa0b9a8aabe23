//! What a text holds that another tool must finish, and which tool that is.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use super::error::{LinkError, Place};
use super::parse::{File, Tokens};
use super::placeholder::placeholder;
use super::source::Source;
use super::token::is_word_char;

/// Whose text it is that a compiler cannot read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Tool {
    /// `@if` and its like, without features.
    Wesl,
    /// `#import` and `#define_import_path`.
    NagaOil,
    /// `#include`.
    Include,
    /// `#ifdef`, `#define` and the like.
    Preprocessor,
    /// Any other line that starts with `#`, `{% %}`, `<% %>`.
    Lines,
    /// `#version` and the like.
    Glsl,
    /// `#{NAME}`, `$NAME`.
    Placeholder,
    /// Brackets that lines of another tool choose between.
    Brackets,
    /// What starts no declaration of WGSL.
    Unknown,
    /// A comment that another tool may act on.
    Comment,
}

impl Tool {
    /// True of a line or tag, which stands where it likes.
    fn is_line(self) -> bool {
        use Tool::{Glsl, Include, Lines, NagaOil, Preprocessor};
        matches!(self, NagaOil | Include | Preprocessor | Lines | Glsl)
    }

    /// True where the text is no WGSL before that tool has run.
    pub fn is_preprocessor(self) -> bool {
        !matches!(self, Tool::Wesl | Tool::Unknown | Tool::Comment)
    }
}

/// A place that another tool must act on.
#[derive(Clone, Debug)]
pub(crate) struct Mark {
    pub tool: Tool,
    pub at: usize,
    pub text: String,
}

/// Something that a linked text holds and that dpsm passes on as it is, for another tool to finish.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Where it is first.
    pub place: Place,
    /// What it is, and which tool it is for.
    pub what: String,
    /// What to do.
    pub remedy: String,
    /// True where no compiler of WGSL can read the text before that tool has run.
    pub unfinished: bool,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}; {}", self.place, self.what, self.remedy)
    }
}

/// Everything that another tool must finish.
pub(crate) fn marks(tokens: &Tokens) -> Result<Vec<Mark>, LinkError> {
    let mut marks = Vec::new();
    for span in &tokens.foreign {
        let line = &tokens.source.text[span.clone()];
        let mark = Mark { tool: of_line(line), at: span.start, text: clip(line) };
        let place = || tokens.source.place(span.start);
        if let Some(instead) = import_of_dpsm(line) {
            return Err(LinkError::ForeignImport { place: place(), what: mark.text, instead });
        }
        marks.push(mark);
    }
    for (index, token) in tokens.all.iter().enumerate() {
        let text = &tokens.source.text[token.span.clone()];
        if text.contains(['#', '$', '{', '<']) && text.len() > 1 {
            let start = text.find(['#', '$', '{', '<']).unwrap_or_default();
            let length = placeholder(&text[start..]).unwrap_or(text.len() - start);
            let text = clip(&text[start..start + length]);
            marks.push(Mark { tool: Tool::Placeholder, at: token.span.start, text });
        } else if text == "@" && tokens.is_condition(index) {
            marks.push(Mark {
                tool: Tool::Wesl,
                at: token.span.start,
                text: condition(tokens, index),
            });
        }
    }
    for span in &tokens.comments {
        let comment = &tokens.source.text[span.clone()];
        if let Some(line) = include_in_comment(comment) {
            let text = clip(line.lines().next().unwrap_or_default());
            marks.push(Mark { tool: Tool::Comment, at: span.start, text });
        }
    }
    Ok(marks)
}

/// Refuses another tool's lines between the declarations of a module: of those some are taken, and
/// the lines would be lost.
pub(crate) fn check_module(file: &File) -> Result<(), LinkError> {
    let mut items = file.items.iter().peekable();
    for mark in file.marks.iter().filter(|mark| mark.tool.is_line()) {
        while items.next_if(|item| item.span.end <= mark.at).is_some() {}
        if items.peek().is_none_or(|item| item.span.start > mark.at) {
            return Err(LinkError::ForeignLine {
                place: file.source.place(mark.at),
                what: mark.text.clone(),
                tool: mark.tool.name(),
            });
        }
    }
    Ok(())
}

/// `@if(NAME)` as it stands, on one line.
fn condition(tokens: &Tokens, at: usize) -> String {
    let end = if tokens.text(at + 2) == "(" && tokens.text(at + 1) != "else" {
        // brackets may not be in pairs yet
        (at..tokens.all.len()).take(64).find(|at| tokens.text(*at) == ")").unwrap_or(at + 1)
    } else {
        at + 1
    };
    let span = tokens.span(at, end);
    let words: Vec<_> = tokens.source.text[span].split_whitespace().collect();
    clip(&words.join(" "))
}

fn of_line(line: &str) -> Tool {
    let word = line.trim_start_matches('#').trim_start();
    let word = word.split(|c| !is_word_char(c)).next().unwrap_or_default();
    match word {
        _ if !line.starts_with('#') => Tool::Lines,
        "import" | "define_import_path" => Tool::NagaOil,
        "include" => Tool::Include,
        "version" | "extension" => Tool::Glsl,
        "if" | "ifdef" | "ifndef" | "elif" | "elifdef" | "else" | "endif" | "define" | "undef"
        | "pragma" | "line" | "error" | "warning" => Tool::Preprocessor,
        _ => Tool::Lines,
    }
}

/// The import to write where another tool's names dpsm: dpsm would not be in the linked text.
fn import_of_dpsm(line: &str) -> Option<String> {
    if !matches!(of_line(line), Tool::NagaOil | Tool::Include)
        || line.contains("define_import_path")
    {
        return None;
    }
    let words: Vec<_> = line.split(|c| !is_word_char(c)).filter(|word| !word.is_empty()).collect();
    let at = words.iter().position(|word| *word == "dpsm")?;
    let module = words.get(at + 1).copied().unwrap_or("module");
    let item = words.get(at + 2).filter(|word| crate::link::names::without_prefix(word).is_some());
    Some(format!("import dpsm::{module}::{{{}}};", item.copied().unwrap_or("name")))
}

/// The line of a comment such as `//!include "file"`, without what makes it a comment.
fn include_in_comment(comment: &str) -> Option<&str> {
    let text = comment.trim_start_matches('/').trim_start_matches('*').trim_start();
    let rest = text.strip_prefix(['!', '#', '@'])?.trim_start();
    let verbs = ["include", "import", "use", "require"];
    let verb = verbs.iter().find(|verb| rest.starts_with(**verb))?;
    let name = &rest[verb.len()..];
    let sign = name.trim_start().starts_with(['"', '\'', '<', '(', '{']);
    let path = name.starts_with([' ', '\t']) && name.contains(['.', '/', ':']);
    (sign || path).then_some(text)
}

impl Tool {
    fn name(self) -> &'static str {
        match self {
            Tool::Wesl => "WESL",
            Tool::NagaOil => "naga_oil (the shader preprocessor of Bevy)",
            Tool::Include => "a C preprocessor or a bundler's plugin",
            Tool::Preprocessor => "a C preprocessor or naga_oil (the shader preprocessor of Bevy)",
            Tool::Glsl => "GLSL",
            _ => "another preprocessor",
        }
    }

    fn what(self, text: &str) -> String {
        let tool = self.name();
        match self {
            Tool::Wesl => format!("`{text}` is WESL's, and no feature is given"),
            Tool::Placeholder if text.starts_with("#{") => {
                format!("`{text}` is a placeholder of naga_oil or another preprocessor")
            }
            Tool::Placeholder => format!("`{text}` is a placeholder of another preprocessor"),
            Tool::Brackets => format!("the brackets do not pair before {tool} has run"),
            Tool::Unknown => format!("`{text}` starts no declaration that dpsm knows"),
            Tool::Comment => {
                format!("`{text}` is a comment to dpsm, which another tool may act on")
            }
            _ => format!("`{text}` is a line of {tool}"),
        }
    }

    fn remedy(self, text: &str) -> String {
        let run = "run that tool on the linked text, into which it is passed on as it is";
        match self {
            Tool::Wesl => {
                let name = text.split(|c| !is_word_char(c)).filter(|word| !word.is_empty()).nth(1);
                let name = name.unwrap_or("NAME");
                format!(
                    "decide it by `--feature {name}` or `--feature {name}=false`, or let another \
                     compiler of WESL: it is passed on as it is"
                )
            }
            Tool::NagaOil if text.starts_with("#import") => format!("{run}; {IMPORTS}"),
            Tool::Include => format!("{run}; {IMPORTS}"),
            Tool::Preprocessor => {
                format!("{run}; or write WESL's `@if(NAME)`, which dpsm decides by `--feature`")
            }
            Tool::Glsl => "dpsm links WGSL: translate the shader to WGSL first".to_owned(),
            Tool::Brackets => format!("only imports were read; {run}"),
            Tool::Unknown => "it is passed on as it is; `dpsm validate` asks naga".to_owned(),
            Tool::Comment => IMPORTS.to_owned(),
            _ => run.to_owned(),
        }
    }
}

/// What dpsm does where another tool imports.
const IMPORTS: &str = "dpsm itself links what `import module::{name};` names";

/// One note for each kind of mark in the parts of a file that were taken, in the file's order.
pub(crate) fn notes(source: &Source, marks: &[Mark], parts: &[Range<usize>]) -> Vec<Note> {
    let mut first: BTreeMap<Tool, (&Mark, usize)> = BTreeMap::new();
    let taken =
        |mark: &&Mark| parts.iter().any(|part| part.contains(&mark.at) || part.start == mark.at);
    for mark in marks.iter().filter(taken) {
        let entry = first.entry(mark.tool).or_insert((mark, 0));
        entry.1 += 1;
        if mark.at < entry.0.at {
            entry.0 = mark;
        }
    }
    let mut first: Vec<_> = first.into_iter().collect();
    first.sort_by_key(|(_, (mark, _))| mark.at);
    let note = |(tool, (mark, count)): (Tool, (&Mark, usize))| {
        let more =
            if count > 1 { format!(" ({} more of its kind)", count - 1) } else { String::new() };
        Note {
            place: source.place(mark.at),
            what: tool.what(&mark.text) + &more,
            remedy: tool.remedy(&mark.text),
            unfinished: tool.is_preprocessor() || tool == Tool::Wesl,
        }
    };
    first.into_iter().map(note).collect()
}

/// The first line of a text that may be very long.
fn clip(text: &str) -> String {
    text.lines().next().unwrap_or_default().trim_end().chars().take(60).collect()
}
