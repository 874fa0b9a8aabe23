//! Links modules into one plain WGSL text.
//!
//! A module is plain WGSL with leading imports, `import super::paraboloid::{dpsm_project};`, each
//! name by itself. Linking resolves the imports, keeps the declarations that are reachable from
//! what was asked for, and remembers which line came from where.

mod emit;
mod error;
mod names;
mod parse;
mod program;
pub(crate) mod token;

use std::collections::BTreeSet;

pub use emit::{Linked, Origin};
pub use error::{LinkError, Place};

use crate::{MODULES, Module};
use names::Rules;
use parse::File;
use program::{Id, Program};

/// A set of modules to link from.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    files: Vec<File>,
}

/// What a module is and holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModuleInfo {
    /// The name that imports use.
    pub name: String,
    /// Path in the source tree.
    pub path: String,
    /// First line of the module's header.
    pub summary: String,
    /// Names of the modules it imports from, each once.
    pub imports: Vec<String>,
    /// Its declarations, in the file's order.
    pub items: Vec<ItemInfo>,
}

/// A declaration of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ItemInfo {
    /// Its keyword: `fn`, `struct`, `const`, `override`, `alias` or `var`.
    pub kind: &'static str,
    /// Its name.
    pub name: String,
    /// Its doc comment, without the slashes.
    pub doc: String,
    /// 1-based line of its name.
    pub line: usize,
}

/// Links dpsm's own modules: `"paraboloid"` is a whole module, `"paraboloid::dpsm_project"` one
/// declaration with what it needs.
///
/// The order of the names does not matter, and naming something twice is the same as once.
///
/// # Errors
///
/// [`LinkError::UnknownModule`] and [`LinkError::UnknownItem`] for a wrong name.
///
/// ```
/// let linked = dpsm::link(&["paraboloid::dpsm_project"])?;
/// assert!(linked.text.contains("fn dpsm_project("));
/// # Ok::<(), dpsm::LinkError>(())
/// ```
pub fn link(names: &[&str]) -> Result<Linked, LinkError> {
    Catalogue::dpsm()?.link(names)
}

/// Links a shader of the user's own with what it imports from dpsm's modules.
///
/// The result ends with the shader itself, whole and line for line, without its imports; its
/// directives (`enable` and the like) move to the top. `path` only names it in messages.
///
/// # Errors
///
/// Any [`LinkError`], with the line of the shader at fault.
///
/// ```
/// let text = "import dpsm::paraboloid::{dpsm_project};
/// fn front(p: vec3<f32>) -> vec2<f32> { return dpsm_project(p); }";
/// let linked = dpsm::link_source("my.wesl", text)?;
/// assert!(linked.text.ends_with("fn front(p: vec3<f32>) -> vec2<f32> { return dpsm_project(p); }\n"));
/// # Ok::<(), dpsm::LinkError>(())
/// ```
pub fn link_source(path: &str, text: &str) -> Result<Linked, LinkError> {
    Catalogue::dpsm()?.link_source(path, text)
}

/// Links one function of dpsm's modules, named without its module, with what it needs.
///
/// # Errors
///
/// [`LinkError::UnknownFunction`] with the nearest name.
pub fn link_function(name: &str) -> Result<Linked, LinkError> {
    let catalogue = Catalogue::dpsm()?;
    let functions = |file: &File| {
        let items = file.items.iter().filter(|item| item.kind == "fn");
        items.filter_map(|item| item.name.clone()).collect::<Vec<_>>()
    };
    let holds = |file: &&File| functions(file).iter().any(|function| function == name);
    let Some(module) = catalogue.files.iter().find(holds).and_then(|f| f.module.as_deref()) else {
        let all: Vec<_> = catalogue.files.iter().flat_map(functions).collect();
        return Err(LinkError::UnknownFunction {
            name: name.to_owned(),
            near: names::nearest(name, all.iter().map(String::as_str)),
        });
    };
    catalogue.link(&[&format!("{module}::{name}")])
}

impl Catalogue {
    /// No modules.
    pub fn new() -> Self {
        Self::default()
    }

    /// dpsm's own modules.
    ///
    /// # Errors
    ///
    /// None for a released dpsm, whose tests read every module; else as [`Catalogue::of`].
    pub fn dpsm() -> Result<Self, LinkError> {
        Self::of(MODULES)
    }

    /// Modules that follow dpsm's naming rules: functions and variables are `dpsm_*`, types
    /// `Dpsm*`, constants `DPSM_*`, and no name is one that naga's back-ends would change.
    ///
    /// # Errors
    ///
    /// As [`Catalogue::with`].
    pub fn of(modules: &[Module]) -> Result<Self, LinkError> {
        modules.iter().try_fold(Self::new(), |catalogue, module| {
            catalogue.add(module.name, module.path, module.text, Rules::Builtin)
        })
    }

    /// Adds a module of the user's own; other modules and shaders import it by `name`. `path`
    /// only names it in messages. Its names need no prefix, but must survive translation.
    ///
    /// # Errors
    ///
    /// [`LinkError::Malformed`], [`LinkError::UnsupportedImport`], [`LinkError::Duplicate`],
    /// [`LinkError::DuplicateModule`] and [`LinkError::BadName`]. What it imports is looked up
    /// later, when something is linked, so modules can be added in any order.
    ///
    /// ```
    /// let catalogue = dpsm::Catalogue::new().with("tone", "tone.wesl", "fn tone(x: f32) -> f32 { return x; }")?;
    /// assert!(catalogue.link(&["tone"])?.text.contains("fn tone"));
    /// # Ok::<(), dpsm::LinkError>(())
    /// ```
    pub fn with(self, name: &str, path: &str, text: &str) -> Result<Self, LinkError> {
        self.add(name, path, text, Rules::Library)
    }

    fn add(mut self, name: &str, path: &str, text: &str, rules: Rules) -> Result<Self, LinkError> {
        let place = Place { file: path.to_owned(), line: 1 };
        if !parse::is_module_name(name) {
            let what = format!("`{name}` cannot be the name of a module");
            return Err(LinkError::Malformed { place, what });
        }
        let same = |file: &&File| file.module.as_deref() == Some(name);
        if let Some(other) = self.files.iter().find(same) {
            return Err(LinkError::DuplicateModule {
                place,
                name: name.to_owned(),
                other: other.source.path.clone(),
            });
        }
        let file = parse::parse(Some(name), path, text)?;
        names::check(&file, rules)?;
        self.files.push(file);
        Ok(self)
    }

    /// As [`link`](link()), from this catalogue.
    ///
    /// # Errors
    ///
    /// As [`link`](link()), and whatever is wrong between the modules: [`LinkError::Cycle`],
    /// [`LinkError::NameClash`], [`LinkError::Captured`].
    pub fn link(&self, names: &[&str]) -> Result<Linked, LinkError> {
        let program = Program::new(self.files.iter());
        let mut whole = BTreeSet::new();
        let mut roots = BTreeSet::new();
        for request in names {
            let place = || Place { file: (*request).to_owned(), line: 0 };
            match parse::strip_root(request).split_once("::") {
                None => {
                    whole.insert(program.module(parse::strip_root(request), place)?);
                }
                Some((module, item)) => {
                    roots.insert(program.item(module, item, place)?);
                }
            }
        }
        let kept = program.select(&whole, roots)?;
        let requests: BTreeSet<_> = names.iter().copied().collect();
        let name = requests.into_iter().collect::<Vec<_>>().join(", ");
        Ok(emit::emit(&program, &kept, &whole, name))
    }

    /// As [`link_source`](link_source()), from this catalogue.
    ///
    /// # Errors
    ///
    /// As [`link_source`](link_source()).
    pub fn link_source(&self, path: &str, text: &str) -> Result<Linked, LinkError> {
        let user = parse::parse(None, path, text)?;
        names::check(&user, Rules::User)?;
        let program = Program::new(self.files.iter().chain([&user]));
        let whole = BTreeSet::from([self.files.len()]);
        let roots: Result<BTreeSet<Id>, _> = user
            .imports
            .iter()
            .map(|import| {
                let place = || user.source.place(import.at);
                program.item(&import.module, &import.item, place)
            })
            .collect();
        let kept = program.select(&whole, roots?)?;
        Ok(emit::emit(&program, &kept, &whole, path.to_owned()))
    }

    /// What each module is and holds, in the catalogue's order.
    ///
    /// ```
    /// let modules = dpsm::Catalogue::dpsm()?.describe();
    /// assert!(modules.iter().any(|module| module.name == "paraboloid"));
    /// # Ok::<(), dpsm::LinkError>(())
    /// ```
    pub fn describe(&self) -> Vec<ModuleInfo> {
        self.files.iter().map(describe).collect()
    }
}

fn describe(file: &File) -> ModuleInfo {
    let mut imports: Vec<String> = Vec::new();
    for import in &file.imports {
        if !imports.contains(&import.module) {
            imports.push(import.module.clone());
        }
    }
    let items = file.items.iter().filter_map(|item| {
        Some(ItemInfo {
            kind: item.kind,
            name: item.name.clone()?,
            doc: item.doc.clone(),
            line: file.source.line_at(item.at),
        })
    });
    ModuleInfo {
        name: file.module.clone().unwrap_or_default(),
        path: file.source.path.clone(),
        summary: file.summary.clone(),
        imports,
        items: items.collect(),
    }
}
