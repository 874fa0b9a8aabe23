//! What can be wrong with a text that is to be linked.

use std::fmt;

use super::parse::Tokens;

/// A line of a file, both as the user knows them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file's path, or the request itself where [`link`](super::link) was asked for it.
    pub file: String,
    /// 1-based line; 0 for a request, which has no lines.
    pub line: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => f.write_str(&self.file),
            line => write!(f, "{}:{line}", self.file),
        }
    }
}

/// Why texts cannot be linked. Each message starts with the place to look at.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum LinkError {
    /// No module has this name; `present` are those that there are, the nearest first.
    #[error("{place}: unknown module `{name}`{}{}", did_you_mean(near), there_is(near, present))]
    UnknownModule { place: Place, name: String, near: Option<String>, present: Box<[String]> },

    /// The module does not declare this name; `present` are those that it does.
    #[error(
        "{place}: unknown item `{name}` in module `{module}`{}{}",
        did_you_mean(near),
        there_is(near, present)
    )]
    UnknownItem {
        place: Place,
        module: String,
        name: String,
        near: Option<String>,
        present: Box<[String]>,
    },

    /// No module declares a function of this name.
    #[error("unknown function `{name}`{}{}", did_you_mean(near), there_is(near, present))]
    UnknownFunction { name: String, near: Option<String>, present: Box<[String]> },

    /// A name that stands for something else than what was asked for.
    #[error("`{name}` is {what}; {instead}")]
    OtherKind { name: String, what: String, instead: String },

    /// An import of a file that there is not.
    #[error("{place}: no module `{name}`: {what}")]
    NoFile { place: Place, name: String, what: String },

    /// A file that is no text to link.
    #[error("{}{path}: {what}", imported_at(place))]
    Unreadable { place: Option<Place>, path: String, what: String },

    /// A condition in a wrong form or place.
    #[error("{place}: {what}")]
    Condition { place: Place, what: String },

    /// Features were given, but not this one, which a condition asks for.
    #[error(
        "{place}: the feature `{name}` is not given{}; add `--feature {name}` or \
         `--feature {name}=false`",
        did_you_mean(near)
    )]
    FeatureNotGiven { place: Place, name: String, near: Option<String> },

    /// Another tool's import of one of dpsm's modules, which would be missing.
    #[error(
        "{place}: `{what}` is another tool's line, by which dpsm links nothing; write `{instead}`"
    )]
    ForeignImport { place: Place, what: String, instead: String },

    /// A line of another tool between a module's declarations, of which only some are taken.
    #[error(
        "{place}: `{what}` is a line of {tool} between declarations of a module, of which only those \
         are taken that are needed; run that tool on the module first, or write `@if(NAME)`"
    )]
    ForeignLine { place: Place, what: String, tool: &'static str },

    /// Modules import each other in a ring; the place is the import that closes it.
    #[error("{place}: import cycle: {}", chain.join(" -> "))]
    Cycle { place: Place, chain: Vec<String> },

    /// Two files give the linked text the same name.
    #[error("{place}: name clash: `{name}` is also declared at {other}")]
    NameClash { place: Place, name: String, other: Place },

    /// One file declares a name twice.
    #[error("{place}: `{name}` is declared twice, first at {first}")]
    Duplicate { place: Place, name: String, first: Place },

    /// Two modules of a catalogue have the same name.
    #[error("{place}: module `{name}` is already in the catalogue, as {other}")]
    DuplicateModule { place: Place, name: String, other: String },

    /// A module's identifier breaks the naming rules.
    #[error("{place}: `{name}` {rule}{}", use_instead(near))]
    BadName { place: Place, name: String, rule: &'static str, near: Option<String> },

    /// A user's shader declares a name with a prefix of dpsm's own.
    #[error(
        "{place}: `{name}` has a prefix that is reserved for dpsm's modules{}",
        use_instead(near)
    )]
    ReservedPrefix { place: Place, name: String, near: Option<String> },

    /// A name without an import that the linked text would bind to another file's declaration.
    #[error(
        "{place}: `{name}` is not imported here but would bind to the declaration at {other}; {fix}"
    )]
    Captured { place: Place, name: String, other: Place, fix: String },

    /// An import in a form that is outside the subset.
    #[error("{place}: {what} not supported; write `{instead}`")]
    UnsupportedImport { place: Place, what: &'static str, instead: String },

    /// The text is not a sequence of imports, directives and declarations.
    #[error("{place}: {what}")]
    Malformed { place: Place, what: String },
}

pub(crate) fn condition(tokens: &Tokens, at: usize, what: String) -> LinkError {
    LinkError::Condition { place: tokens.source.place(tokens.offset(at)), what }
}

fn did_you_mean(near: &Option<String>) -> String {
    near.as_ref().map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

/// Names that a message lists at the most.
const LISTED: usize = 24;

/// What there is, after [`did_you_mean`].
fn there_is(near: &Option<String>, present: &[String]) -> String {
    let said = match near {
        Some(near) if present == [near.as_str()] => return String::new(),
        Some(_) => " There",
        None => "; there",
    };
    let names: Vec<_> = present.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    let more = match present.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    match present {
        [] => String::new(),
        [_] => format!("{said} is {}", names.join(", ")),
        _ => format!("{said} are {}{more}", names.join(", ")),
    }
}

fn imported_at(place: &Option<Place>) -> String {
    place.as_ref().map_or_else(String::new, |place| format!("{place}: "))
}

fn use_instead(near: &Option<String>) -> String {
    near.as_ref().map_or_else(String::new, |near| format!("; use `{near}`"))
}
