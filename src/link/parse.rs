//! A file as imports, directives and declarations.

mod comments;
mod import;
mod item;
mod loose;
mod tokens;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use super::error::{LinkError, condition as wrong_condition};
use super::foreign::{Mark, Tool};
use super::token::Source;
pub(crate) use import::{Root, is_module_name, strip_root};
pub(crate) use tokens::Tokens;

pub(crate) type Offsets = BTreeMap<String, usize>;

/// One imported name.
#[derive(Clone, Debug)]
pub(crate) struct Import {
    pub root: Root,
    /// The module's path, with `::`.
    pub module: String,
    pub item: String,
    pub at: usize,
    /// Whether a condition stands before it.
    pub conditional: bool,
}

/// A declaration at module scope.
#[derive(Clone, Debug)]
pub(crate) struct Item {
    /// Its keyword: `fn`, `struct`, ...; `text` for what is no declaration of WGSL.
    pub kind: &'static str,
    /// None for `const_assert` and `text`.
    pub name: Option<String>,
    /// Offset of the name, or of the keyword.
    pub at: usize,
    /// From the comments above it to the comment that ends its last line.
    pub span: Range<usize>,
    pub doc: String,
    /// What it may refer to, and where first.
    pub words: Offsets,
    /// Parameters, locals and members.
    pub locals: Vec<(String, usize)>,
    /// Whether a condition stands before it.
    pub conditional: bool,
    /// Declarations that come with it: alternatives under conditions.
    pub mates: Vec<usize>,
}

#[derive(Clone, Debug)]
pub(crate) struct File {
    /// None for a user's shader.
    pub module: Option<String>,
    /// True of a user's file, whose names follow no rule of dpsm's.
    pub on_disk: bool,
    pub source: Arc<Source>,
    /// The comments that introduce the file, not its first declaration.
    pub header: Option<Range<usize>>,
    pub summary: String,
    pub imports: Vec<Import>,
    /// Normalised text of each directive, and where it is.
    pub directives: Vec<(String, Range<usize>)>,
    pub import_spans: Vec<Range<usize>>,
    pub items: Vec<Item>,
    /// Index of each named item.
    pub names: BTreeMap<String, usize>,
    /// Names of all parameters, locals and members.
    pub locals: BTreeSet<String>,
    /// What another tool must finish.
    pub marks: Vec<Mark>,
}

const DECLARATIONS: [&str; 7] =
    ["fn", "struct", "const", "override", "alias", "var", "const_assert"];
const DIRECTIVES: [&str; 3] = ["enable", "requires", "diagnostic"];

/// Reads a module (with its name) or a user's shader (without), which may hold what only another
/// tool understands.
pub(crate) fn parse(module: Option<&str>, path: &str, text: &str) -> Result<File, LinkError> {
    parse_source(module, Arc::new(Source::new(path, text)))
}

pub(crate) fn parse_source(module: Option<&str>, source: Arc<Source>) -> Result<File, LinkError> {
    let tokens = Tokens::read(Arc::clone(&source))?;
    let marks = super::foreign::marks(&tokens)?;
    let mut parser = Parser {
        before: None,
        finished_by_another: module.is_none()
            && marks.iter().any(|mark| mark.tool.is_preprocessor()),
        file: File {
            module: module.map(str::to_owned),
            on_disk: false,
            source,
            header: None,
            summary: String::new(),
            imports: Vec::new(),
            directives: Vec::new(),
            import_spans: Vec::new(),
            items: Vec::new(),
            names: BTreeMap::new(),
            locals: BTreeSet::new(),
            marks,
        },
        tokens,
    };
    match parser.tokens.pair() {
        // other tools choose between brackets
        Err(_) if parser.finished_by_another => parser.loose()?,
        paired => {
            paired?;
            parser.run()?;
        }
    }
    parser.header();
    if module.is_some() {
        super::foreign::check_module(&parser.file)?;
    }
    Ok(parser.file)
}

/// What a condition may go on from.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Before {
    Import,
    Directive,
    Item(usize),
}

struct Parser {
    tokens: Tokens,
    /// True of a user's shader that a tool acts on before a compiler.
    finished_by_another: bool,
    before: Option<Before>,
    file: File,
}

impl Parser {
    fn run(&mut self) -> Result<(), LinkError> {
        let mut at = 0;
        while at < self.tokens.all.len() {
            at = if self.tokens.text(at) == ";" { at + 1 } else { self.node(at)? };
        }
        Ok(())
    }

    /// Reads what is at a token and returns the token after it.
    fn node(&mut self, first: usize) -> Result<usize, LinkError> {
        let attributes = self.tokens.attributes(first);
        let head = attributes.head;
        let condition = attributes.conditions.first().map(|one| one.start);
        let text = self.tokens.text(head);
        let import = text == "import";
        if !import && !DIRECTIVES.contains(&text) {
            let count = self.file.items.len();
            let end = self.item_or_text(first)?;
            if self.file.items.len() > count {
                self.goes_on(condition, Before::Item(count))?;
            }
            return Ok(end);
        }
        if self.file.items.iter().any(|item| item.kind != "text") {
            let what = format!("`{text}` must come before all declarations");
            return Err(self.tokens.malformed(head, what));
        }
        let end = self.statement_end(head + 1)?;
        match import {
            true => self.import(first, head, end)?,
            false => self.directive(first, end),
        }
        let what = if import { Before::Import } else { Before::Directive };
        self.goes_on(condition, what)?;
        Ok(end + 1)
    }

    /// Keeps what `@elif` or `@else` stands before with what it goes on from.
    fn goes_on(&mut self, condition: Option<usize>, what: Before) -> Result<(), LinkError> {
        let before = self.before.replace(what);
        let Some(at) = condition.filter(|at| self.tokens.text(at + 1) != "if") else {
            return Ok(());
        };
        match (before, what) {
            (Some(Before::Item(one)), Before::Item(other)) => {
                self.mates(one, other);
                Ok(())
            }
            (Some(Before::Import), Before::Import)
            | (Some(Before::Directive), Before::Directive) => Ok(()),
            _ => {
                // imports go and directives move to the top: what follows would lose its `@if`
                let what = format!(
                    "`@{}` goes on from an import or a directive; give the features, so that it is \
                     decided here",
                    self.tokens.text(at + 1)
                );
                Err(wrong_condition(&self.tokens, at, what))
            }
        }
    }

    fn mates(&mut self, one: usize, other: usize) {
        self.file.items[one].mates.push(other);
        self.file.items[other].mates.push(one);
    }

    /// The `;` that ends the statement going on at a token.
    fn statement_end(&self, from: usize) -> Result<usize, LinkError> {
        let mut at = from;
        loop {
            let text = self.tokens.text(at);
            let starts_next = text == "@" || text == "import" || DECLARATIONS.contains(&text);
            match text {
                ";" => return Ok(at),
                "(" | "[" => at = self.tokens.pairs[at],
                // Only an import has braces.
                "{" if self.tokens.text(from - 1) == "import" => at = self.tokens.pairs[at],
                "" | "{" => return Err(self.missing_end(at)),
                _ if starts_next => return Err(self.missing_end(at)),
                _ => {}
            }
            at += 1;
        }
    }

    fn missing_end(&self, at: usize) -> LinkError {
        self.tokens.malformed(at.max(1) - 1, "missing `;`".to_owned())
    }

    fn directive(&mut self, first: usize, end: usize) {
        let words: Vec<_> = (first..=end).map(|at| self.tokens.text(at)).collect();
        let words = words.join(" ");
        let span = self.tokens.span(first, end);
        self.file.directives.push((words, span));
    }
}

/// Marks what is no declaration of WGSL.
fn unknown(tokens: &Tokens, at: usize) -> Mark {
    Mark { tool: Tool::Unknown, at: tokens.offset(at), text: item::clip(tokens.text(at)) }
}
