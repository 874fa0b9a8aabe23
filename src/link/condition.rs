//! WESL's conditional translation: `@if`, `@elif` and `@else` keep or remove what they stand before,
//! by features that are on or off.
//!
//! What is removed, and the attributes of what is kept, become blanks, and lines of nothing but
//! those go: every line that is left keeps its columns, and [`Source`] knows which line it was.

mod expression;
mod walk;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use super::error::LinkError;
use super::parse::Tokens;
use super::token::Source;

/// Features that are on or off: what WESL's `@if(NAME)` asks for.
///
/// With none given, `@if` and its like are passed on as they are. With any, each that a text asks for
/// must be given.
///
/// ```
/// use dpsm::{Catalogue, link::Features};
/// let features = Features::new().with("SOFT", true);
/// let text = "@if(SOFT) const TAPS = 16; @else const TAPS = 1;";
/// let linked = Catalogue::dpsm()?.features(features).link_source("my.wesl", text)?;
/// assert_eq!(linked.text.trim(), "const TAPS = 16;");
/// # Ok::<(), dpsm::LinkError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Features {
    given: BTreeMap<String, bool>,
    others: Option<bool>,
}

impl Features {
    /// None given.
    pub fn new() -> Self {
        Self::default()
    }

    /// Turns a feature on or off; the last word on a name counts.
    pub fn with(mut self, name: &str, on: bool) -> Self {
        self.given.insert(name.to_owned(), on);
        self
    }

    /// What every feature is that is not given by name.
    pub fn others(self, on: bool) -> Self {
        Self { others: Some(on), ..self }
    }

    /// True where nothing is given, so that conditions are left to another tool.
    pub fn is_empty(&self) -> bool {
        self.given.is_empty() && self.others.is_none()
    }

    /// Whether a feature is on, if that is given.
    pub fn get(&self, name: &str) -> Option<bool> {
        self.given.get(name).copied().or(self.others)
    }

    /// The names that were given.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.given.keys().map(String::as_str)
    }
}

/// A text without its conditions, if it has any, and the features that these ask for.
pub(crate) fn translate(
    source: &Arc<Source>,
    features: &Features,
) -> Result<(Arc<Source>, BTreeSet<String>), LinkError> {
    let undecided = || (Arc::clone(source), BTreeSet::new());
    if features.is_empty() || !source.text.contains('@') {
        return Ok(undecided());
    }
    let mut tokens = Tokens::read(Arc::clone(source))?;
    if !(0..tokens.all.len()).any(|at| tokens.is_condition(at)) {
        return Ok(undecided());
    }
    tokens.pair()?;
    let (cuts, names) = walk::walk(&tokens, features)?;
    Ok((Arc::new(without(source, cuts)), names))
}

/// The text with blanks for its cuts, less the lines that are nothing else.
fn without(source: &Arc<Source>, mut cuts: Vec<Range<usize>>) -> Source {
    cuts.sort_by_key(|cut| (cut.start, cut.end));
    let mut cuts = cuts.into_iter().peekable();
    let (mut text, mut lines) = (String::new(), Vec::new());
    let mut start = 0;
    for (index, line) in source.text.split('\n').enumerate() {
        let end = start + line.len();
        let mut left = String::new();
        let mut at = start;
        while let Some(cut) = cuts.peek().filter(|cut| cut.start < end.max(start + 1)) {
            let (from, to) = (cut.start.max(at), cut.end.min(end).max(at));
            left.push_str(&source.text[at..from]);
            left.extend(source.text[from..to].chars().map(|c| if c == '\t' { c } else { ' ' }));
            at = to;
            if cut.end > end {
                break;
            }
            cuts.next();
        }
        left.push_str(&source.text[at..end]);
        start = end + 1;
        if left == line {
            text.push_str(line);
        } else if left.trim().is_empty() {
            continue;
        } else {
            text.push_str(left.trim_end());
        }
        text.push('\n');
        lines.push(index + 1);
    }
    text.pop();
    Source::left_of(source, text, lines)
}
