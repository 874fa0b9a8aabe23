//! What is wrong with a part of a glTF, before it is known whether anything depends on it.

use std::path::Path;

use crate::scene::SceneError;
use crate::scene::load::malformed;

pub(super) enum Fault {
    /// In words that follow the part's name.
    Text(String),
    /// A required extension that is not read, and that a mesh depends on.
    Extension(String),
    /// An error that names file and remedy itself.
    Scene(SceneError),
}

impl Fault {
    /// The error of a file that cannot do without the part.
    pub fn error(self, path: &Path, part: &str) -> SceneError {
        match self {
            Self::Text(what) if part.is_empty() => malformed(path, what),
            Self::Text(what) => malformed(path, format!("{part}: {what}")),
            Self::Extension(extension) => {
                let remedy = super::extensions::remedy(&extension);
                SceneError::RequiredExtension { path: path.into(), extension, remedy }
            }
            Self::Scene(error) => error,
        }
    }
}

impl From<String> for Fault {
    fn from(what: String) -> Self {
        Self::Text(what)
    }
}

impl From<&str> for Fault {
    fn from(what: &str) -> Self {
        Self::Text(what.into())
    }
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Text(what) => f.write_str(what),
            Self::Extension(extension) => write!(f, "it needs the extension `{extension}`"),
            Self::Scene(error) => write!(f, "{error}"),
        }
    }
}
