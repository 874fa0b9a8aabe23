//! A file as imports, directives and declarations.

mod comments;
mod import;
mod item;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use super::error::LinkError;
use super::token::{Kind, Source, Token, tokenize};
pub(crate) use import::{is_module_name, strip_root};

pub(crate) type Offsets = BTreeMap<String, usize>;

/// One imported name.
#[derive(Clone, Debug)]
pub(crate) struct Import {
    pub module: String,
    pub item: String,
    pub at: usize,
}

/// A declaration at module scope.
#[derive(Clone, Debug)]
pub(crate) struct Item {
    /// Its keyword: `fn`, `struct`, ...
    pub kind: &'static str,
    /// None for `const_assert`.
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
}

#[derive(Clone, Debug)]
pub(crate) struct File {
    /// None for a user's shader.
    pub module: Option<String>,
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
}

const DECLARATIONS: [&str; 7] =
    ["fn", "struct", "const", "override", "alias", "var", "const_assert"];
const DIRECTIVES: [&str; 3] = ["enable", "requires", "diagnostic"];
/// Reads a module (with its name) or a user's shader (without).
pub(crate) fn parse(module: Option<&str>, path: &str, text: &str) -> Result<File, LinkError> {
    let source = Arc::new(Source::new(path, text));
    let all = tokenize(&source)?;
    let (comments, tokens): (Vec<_>, Vec<_>) =
        all.into_iter().partition(|token| token.kind == Kind::Comment);
    let mut parser = Parser {
        pairs: Vec::new(),
        comments: comments.into_iter().map(|token| token.span).collect(),
        tokens,
        file: File {
            module: module.map(str::to_owned),
            source,
            header: None,
            summary: String::new(),
            imports: Vec::new(),
            directives: Vec::new(),
            import_spans: Vec::new(),
            items: Vec::new(),
            names: BTreeMap::new(),
            locals: BTreeSet::new(),
        },
    };
    parser.pair()?;
    parser.run()?;
    parser.header();
    Ok(parser.file)
}

struct Parser {
    tokens: Vec<Token>,
    comments: Vec<Range<usize>>,
    /// For each opening bracket its closing one.
    pairs: Vec<usize>,
    file: File,
}

impl Parser {
    /// A token's text; empty past the end.
    fn text(&self, at: usize) -> &str {
        let token = self.tokens.get(at);
        token.map_or("", |token| &self.file.source.text[token.span.clone()])
    }

    fn is_word(&self, at: usize) -> bool {
        self.tokens.get(at).is_some_and(|token| token.kind == Kind::Word)
    }

    /// Offset of a token; of the last one past the end.
    fn offset(&self, at: usize) -> usize {
        let token = self.tokens.get(at).or(self.tokens.last());
        token.map_or(0, |token| token.span.start)
    }

    fn malformed(&self, at: usize, what: String) -> LinkError {
        LinkError::Malformed { place: self.file.source.place(self.offset(at)), what }
    }

    fn pair(&mut self) -> Result<(), LinkError> {
        self.pairs = vec![0; self.tokens.len()];
        let mut open = Vec::new();
        for at in 0..self.tokens.len() {
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

    fn run(&mut self) -> Result<(), LinkError> {
        let mut at = 0;
        while at < self.tokens.len() {
            let text = self.text(at);
            let import = text == "import";
            at = if text == ";" {
                at + 1
            } else if import || DIRECTIVES.contains(&text) {
                if !self.file.items.is_empty() {
                    let what = format!("`{text}` must come before all declarations");
                    return Err(self.malformed(at, what));
                }
                let end = self.statement_end(at + 1)?;
                match import {
                    true => self.import(at, end)?,
                    false => self.directive(at, end),
                }
                end + 1
            } else {
                self.item(at)?
            };
        }
        Ok(())
    }

    /// The `;` that ends the statement going on at a token.
    fn statement_end(&self, from: usize) -> Result<usize, LinkError> {
        let mut at = from;
        loop {
            let text = self.text(at);
            let starts_next = text == "@" || text == "import" || DECLARATIONS.contains(&text);
            match text {
                ";" => return Ok(at),
                "(" | "[" => at = self.pairs[at],
                // Only an import has braces.
                "{" if self.text(from - 1) == "import" => at = self.pairs[at],
                "" | "{" => return Err(self.malformed(at.max(1) - 1, "missing `;`".to_owned())),
                _ if starts_next => {
                    return Err(self.malformed(at.max(1) - 1, "missing `;`".to_owned()));
                }
                _ => {}
            }
            at += 1;
        }
    }

    fn span(&self, from: usize, to: usize) -> Range<usize> {
        self.tokens[from].span.start..self.tokens[to].span.end
    }

    fn directive(&mut self, at: usize, end: usize) {
        let words: Vec<_> = (at..=end).map(|at| self.text(at)).collect();
        let words = words.join(" ");
        let span = self.span(at, end);
        self.file.directives.push((words, span));
    }
}
