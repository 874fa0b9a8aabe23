//! Validation by naga, with errors in terms of the files that were linked.

use std::any::Any;
use std::error::Error;
use std::fmt;
use std::panic::catch_unwind;
use std::thread;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Expression, Function, SampleLevel, Span, Statement};

use crate::link::token::{Source, tokenize};
use crate::link::{Catalogue, Linked, ModuleInfo, Note};

/// A module that naga accepts.
#[derive(Debug)]
pub struct Validated {
    /// naga's module.
    pub module: naga::Module,
    /// What validation found out about it.
    pub info: naga::valid::ModuleInfo,
}

/// Why naga does not accept a linked text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum ValidateError {
    /// The text is not WGSL.
    #[error("{0}")]
    Parse(Report),

    /// The text is WGSL that breaks a rule.
    #[error("{0}")]
    Rule(Report),

    /// Another tool must finish the text before a compiler can read it.
    #[error("{}: no WGSL yet: {}; {}", .0.place, .0.what, .0.remedy)]
    Unfinished(Note),

    /// naga panicked.
    #[error("naga failed on {file}: {message}")]
    Panic { file: String, message: String },

    /// An expression or a chain of `else` that is too long for naga, which would overflow its
    /// stack.
    #[error(
        "{file}: more than {limit} operators in a row, or branches in a function; split the expression \
         or the function"
    )]
    TooDeep { file: String, limit: usize },

    /// So many declarations that, if each used the next, naga would overflow its stack.
    #[error("{file}: more than {limit} declarations; leave out what is not used")]
    TooMany { file: String, limit: usize },
}

/// What is wrong, and where. Displays in the style of a compiler.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// What was linked.
    pub name: String,
    /// What is wrong.
    pub message: String,
    /// The places, the main one first.
    pub labels: Vec<Label>,
    /// Inner causes and hints.
    pub notes: Vec<String>,
}

/// A place in a file and what naga says about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The user's file, or the name of the linked text for a line that the linker wrote.
    pub file: String,
    /// 1-based.
    pub line: usize,
    /// 1-based, in characters.
    pub column: usize,
    /// In characters, up to the end of the line.
    pub length: usize,
    /// The source line.
    pub source: String,
    /// What naga says here.
    pub text: String,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.labels.iter().map(|label| label.line);
        let width = lines.max().unwrap_or(0).to_string().len();
        match self.labels.first() {
            Some(Label { file, line, column, .. }) => write!(f, "{file}:{line}:{column}")?,
            None => write!(f, "{}", self.name)?,
        }
        write!(f, ": {}", self.message)?;
        for (index, label) in self.labels.iter().enumerate() {
            if index > 0 {
                let Label { file, line, column, .. } = label;
                write!(f, "\n{:width$}--> {file}:{line}:{column}", "")?;
            }
            // A tab stays one, so that the caret stands where the text does.
            let before = label.source.chars().take(label.column - 1);
            let before: String = before.map(|c| if c == '\t' { c } else { ' ' }).collect();
            let carets = "^".repeat(label.length.max(1));
            writeln!(f, "\n{:width$} |", "")?;
            writeln!(f, "{:width$} | {}", label.line, label.source)?;
            write!(f, "{:width$} | {}", "", format!("{before}{carets} {}", label.text).trim_end())?;
        }
        for note in &self.notes {
            write!(f, "\n{:width$} = {note}", "")?;
        }
        Ok(())
    }
}

/// Stack for naga, which recurses by the depth of an expression: it reaches [`DEEPEST`] in half
/// of it without optimisation. Pages that are not used are not allocated.
const STACK: usize = 256 << 20;

/// Operators in a row, or `else` in a function; shaders people write stay far below.
const DEEPEST: usize = 2000;

/// Declarations of a text. naga follows them from use to use, one inside the other; without
/// optimisation that takes 840 bytes at most for each (docs/fuzzing.md), a third of the stack for
/// all.
const MOST_DECLARATIONS: usize = 100_000;

/// Parses and validates a linked text by all of naga's rules.
///
/// Every capability is allowed: which of them a device has is known only where it is opened, and
/// wgpu checks it there.
///
/// # Errors
///
/// [`ValidateError`], with the lines and columns of the files that were linked.
///
/// ```
/// let linked = dpsm::link_source("my.wesl", "fn f() -> f32 {\n    return g();\n}")?;
/// let error = dpsm::validate(&linked).unwrap_err();
/// assert!(error.to_string().starts_with("my.wesl:2:12: no definition in scope"));
/// # Ok::<(), dpsm::LinkError>(())
/// ```
pub fn validate(linked: &Linked) -> Result<Validated, ValidateError> {
    let file = || linked.name().to_owned();
    if let Some(note) = linked.notes().iter().find(|note| note.unfinished) {
        return Err(ValidateError::Unfinished(note.clone()));
    }
    let (depth, declarations) = extent(&linked.text);
    if depth > DEEPEST {
        let limit = DEEPEST;
        return Err(ValidateError::TooDeep { file: file(), limit });
    }
    if declarations > MOST_DECLARATIONS {
        let limit = MOST_DECLARATIONS;
        return Err(ValidateError::TooMany { file: file(), limit });
    }
    let run = || catch_unwind(|| check(linked));
    let result = thread::scope(|scope| {
        let thread = thread::Builder::new().stack_size(STACK);
        match thread.spawn_scoped(scope, run) {
            Ok(thread) => thread.join().flatten(),
            // No threads here, as in a browser.
            Err(_) => run(),
        }
    });
    result.unwrap_or_else(|panic| {
        let message = panic_message(panic.as_ref());
        Err(ValidateError::Panic { file: file(), message })
    })
}

fn check(linked: &Linked) -> Result<Validated, ValidateError> {
    let module = naga::front::wgsl::parse_str(&linked.text).map_err(|error| {
        let labels = error.labels().map(|(span, text)| (span, text.to_owned()));
        let notes = error.notes().map(|note| format!("note: {note}"));
        let notes =
            notes.chain(missing_import(error.message())).chain(other_compiler(error.message()));
        ValidateError::Parse(Report {
            name: linked.name().to_owned(),
            message: error.message().to_owned(),
            labels: self::labels(linked, labels),
            notes: notes.collect(),
        })
    })?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let info = validator.validate(&module).map_err(|error| {
        let labels = error.spans().cloned();
        let mut notes = Vec::new();
        let mut cause = error.as_inner().source();
        while let Some(inner) = cause {
            notes.push(format!("because: {inner}"));
            cause = inner.source();
        }
        ValidateError::Rule(Report {
            name: linked.name().to_owned(),
            message: error.as_inner().to_string(),
            labels: self::labels(linked, labels),
            notes,
        })
    })?;
    Ok(Validated { module, info })
}

impl Validated {
    /// What WGSL allows in uniform control flow only and naga accepts anywhere: derivatives, samples
    /// whose level comes from derivatives, barriers and subgroup operations.
    ///
    /// ```
    /// let text = "fn f(x: f32) -> f32 { if x > 0.0 { return dpdx(x); } return 0.0; }";
    /// let linked = dpsm::link_source("my.wesl", text)?;
    /// let places = dpsm::validate(&linked)?.unchecked(&linked);
    /// assert_eq!((places[0].file.as_str(), places[0].line), ("my.wesl", 1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn unchecked(&self, linked: &Linked) -> Vec<Label> {
        let functions = self.module.functions.iter().map(|(_, function)| function);
        let functions =
            functions.chain(self.module.entry_points.iter().map(|point| &point.function));
        let spans: Vec<_> = functions.flat_map(unchecked).collect();
        let spans = spans.into_iter().map(|span| (span, String::new()));
        let mut places = labels(linked, spans);
        places.sort_by(|a, b| (&a.file, a.line, a.column).cmp(&(&b.file, b.line, b.column)));
        places.dedup();
        places
    }
}

fn unchecked(function: &Function) -> Vec<Span> {
    let asks = |expression: &Expression| match expression {
        Expression::ImageSample { level, .. } => {
            matches!(level, SampleLevel::Auto | SampleLevel::Bias(_))
        }
        Expression::Derivative { .. }
        | Expression::SubgroupBallotResult
        | Expression::SubgroupOperationResult { .. } => true,
        _ => false,
    };
    let all = function.expressions.iter().filter(|(_, expression)| asks(expression));
    let mut spans: Vec<_> = all.map(|(handle, _)| function.expressions.get_span(handle)).collect();
    let mut blocks = vec![&function.body];
    while let Some(block) = blocks.pop() {
        for (statement, span) in block.span_iter() {
            match statement {
                Statement::ControlBarrier(_) | Statement::WorkGroupUniformLoad { .. } => {
                    spans.push(*span);
                }
                Statement::Block(inner) => blocks.push(inner),
                Statement::If { accept, reject, .. } => blocks.extend([accept, reject]),
                Statement::Loop { body, continuing, .. } => blocks.extend([body, continuing]),
                Statement::Switch { cases, .. } => {
                    blocks.extend(cases.iter().map(|case| &case.body))
                }
                _ => {}
            }
        }
    }
    spans
}

/// Where naga does not know an extension, another compiler may.
fn other_compiler(message: &str) -> Option<String> {
    let extension = message.contains("enable-extension") || message.contains("language extension");
    let hint = "note: another compiler may know it: `dpsm link` passes it on without asking naga";
    extension.then(|| hint.to_owned())
}

/// The import to add, where an unknown identifier is one of dpsm's own.
fn missing_import(message: &str) -> Option<String> {
    let name = message.split('`').nth(1)?;
    let modules = Catalogue::dpsm().ok()?.describe();
    let declares = |module: &&ModuleInfo| module.items.iter().any(|item| item.name == name);
    let module = &modules.iter().find(declares)?.name;
    Some(format!("note: add `import dpsm::{module}::{{{name}}};` at the top"))
}

fn labels(linked: &Linked, spans: impl Iterator<Item = (Span, String)>) -> Vec<Label> {
    spans.filter_map(|(span, text)| label(linked, span, &text)).collect()
}

/// A span of the linked text as a place in the file that it came from; columns are the same.
fn label(linked: &Linked, span: Span, text: &str) -> Option<Label> {
    let range = span.to_range()?;
    let (before, after) = linked.text.split_at_checked(range.start)?;
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    let inside = linked.text.get(range).unwrap_or("").lines().next().unwrap_or("");
    let whole = linked.text[start..].lines().next().unwrap_or(after);
    let origin = linked.origin(line);
    Some(Label {
        file: origin.map_or(linked.name(), |origin| origin.file).to_owned(),
        line: origin.map_or(line, |origin| origin.line),
        column: linked.text[start..before.len()].chars().count() + 1,
        length: inside.chars().count(),
        source: linked.source_line(line).unwrap_or(whole).to_owned(),
        // naga names its own types, such as `naga::ir::Function [0]`.
        text: text.strip_prefix("naga::ir::").unwrap_or(text).to_owned(),
    })
}

/// How deep naga could recurse: operators in a row, brackets included, or branches in a function;
/// and how many declarations there are.
fn extent(text: &str) -> (usize, usize) {
    let source = Source::new("", text);
    let (mut deepest, mut branches, mut braces, mut declarations) = (0, 0, 0usize, 0);
    // For each open bracket the operators so far in its argument, and the most in one argument.
    let mut open = vec![(0, 0)];
    for token in tokenize(&source).unwrap_or_default() {
        let (now, most) = open.last().copied().unwrap_or_default();
        let text = &source.text[token.span];
        match text {
            "(" | "[" => {
                open.push((0, 0));
                continue;
            }
            ")" | "]" => {
                open.pop();
                let (outer, outer_most) = open.pop().unwrap_or_default();
                open.push((outer + now.max(most) + 1, outer_most));
            }
            "," => *open.last_mut().unwrap_or(&mut (0, 0)) = (0, most.max(now)),
            ";" | "{" | "}" => {
                open = vec![(0, 0)];
                match text {
                    "{" => braces += 1,
                    "}" => braces = braces.saturating_sub(1),
                    _ => {}
                }
                if braces == 0 {
                    branches = 0;
                    declarations += 1;
                }
            }
            "else" => branches += 1,
            "+" | "-" | "*" | "/" | "%" | "&" | "|" | "^" | "<" | ">" | "!" | "~" | "=" | "." => {
                *open.last_mut().unwrap_or(&mut (0, 0)) = (now + 1, most);
            }
            _ => {}
        }
        let (now, most) = open.last().copied().unwrap_or_default();
        deepest = deepest.max(now).max(most).max(branches);
    }
    (deepest, declarations)
}

fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "a panic without a message".to_owned())
}
