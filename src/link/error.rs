//! What can be wrong with a text that is to be linked.

use std::fmt;

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
    /// No module has this name.
    #[error("{place}: unknown module `{name}`{}", did_you_mean(near))]
    UnknownModule { place: Place, name: String, near: Option<String> },

    /// The module does not declare this name.
    #[error("{place}: unknown item `{name}` in module `{module}`{}", did_you_mean(near))]
    UnknownItem { place: Place, module: String, name: String, near: Option<String> },

    /// No module declares a function of this name.
    #[error("unknown function `{name}`{}", did_you_mean(near))]
    UnknownFunction { name: String, near: Option<String> },

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

fn did_you_mean(near: &Option<String>) -> String {
    near.as_ref().map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

fn use_instead(near: &Option<String>) -> String {
    near.as_ref().map_or_else(String::new, |near| format!("; use `{near}`"))
}
