//! Links modules into one plain WGSL text.
//!
//! A module is plain WGSL with leading imports, `import super::paraboloid::{dpsm_project};`, each
//! name by itself. Linking resolves the imports, keeps the declarations that are reachable from
//! what was asked for, and remembers which line came from where.

mod condition;
mod emit;
mod error;
mod foreign;
mod names;
mod package;
mod parse;
mod placeholder;
mod program;
mod read;
mod source;
pub(crate) mod token;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use condition::Features;
pub use emit::{Linked, Origin};
pub use error::{LinkError, Place};
pub use foreign::Note;

use crate::{MODULES, Module};
use names::Rules;
use package::Package;
use parse::File;
use program::{Id, Program};
use token::Source;

/// A set of modules to link from.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    files: Vec<Arc<File>>,
    /// A user's modules: path and text.
    named: Vec<(PathBuf, String)>,
    features: Features,
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

/// As [`link_source`], of a file: what it imports by `super::` and `package::` is looked up in its
/// folder too.
///
/// # Errors
///
/// Any [`LinkError`], with the file and line at fault.
pub fn link_file(path: impl AsRef<Path>) -> Result<Linked, LinkError> {
    Catalogue::dpsm()?.link_file(path)
}

/// Links one function of dpsm's modules, named without its module, with what it needs.
///
/// # Errors
///
/// [`LinkError::UnknownFunction`] with the nearest name.
pub fn link_function(name: &str) -> Result<Linked, LinkError> {
    let catalogue = Catalogue::dpsm()?;
    let holds = |file: &&Arc<File>| {
        let item = file.names.get(name).map(|item| &file.items[*item]);
        item.is_some_and(|item| item.kind == "fn")
    };
    match catalogue.files.iter().find(holds).and_then(|file| file.module.as_deref()) {
        Some(module) => catalogue.link(&[&format!("{module}::{name}")]),
        None => Err(no_function(&catalogue.files, name)),
    }
}

/// Says what a name is that is no function's, or which functions there are.
fn no_function(files: &[Arc<File>], name: &str) -> LinkError {
    let functions = |file: &Arc<File>| {
        let items = file.items.iter().filter(|item| item.kind == "fn");
        items.filter_map(|item| item.name.clone()).collect::<Vec<_>>()
    };
    let other = |what: String, instead: String| {
        let name = name.to_owned();
        LinkError::OtherKind { name, what, instead }
    };
    for file in files {
        let module = file.module.as_deref().unwrap_or_default();
        if module == name {
            let names = functions(file).join("`, `");
            let what = "a module, not a function".to_owned();
            let instead = match names.is_empty() {
                true => "it has no functions".to_owned(),
                false => format!("its functions are `{names}`"),
            };
            return other(what, instead);
        }
        if let Some(item) = file.names.get(name) {
            let what = format!("a `{}` of the module `{module}`", file.items[*item].kind);
            return other(what, "name a function".to_owned());
        }
        if let Some(function) = parse::strip_root(name).strip_prefix(&format!("{module}::"))
            && functions(file).iter().any(|one| one == function)
        {
            let what = "a function with its module".to_owned();
            return other(what, format!("write `{function}` alone"));
        }
    }
    let all: Vec<_> = files.iter().flat_map(functions).collect();
    let name_only = name.rsplit("::").next().unwrap_or(name);
    LinkError::UnknownFunction {
        name: name.to_owned(),
        near: names::nearest(name_only, all.iter().map(String::as_str)),
        present: names::by_nearness(name_only, all.iter().map(String::as_str)).into(),
    }
}

/// Reads a file as a module or a shader, decides its conditions, and says which features these ask
/// for.
fn parse_decided(
    module: Option<&str>,
    path: &str,
    text: &str,
    features: &Features,
) -> Result<(File, BTreeSet<String>), LinkError> {
    let source = Arc::new(Source::new(path, text));
    let (source, asked) = condition::translate(&source, features)?;
    Ok((parse::parse_source(module, source)?, asked))
}

/// A file with its conditions decided, and the features that these ask for.
fn decided(
    file: &Arc<File>,
    features: &Features,
) -> Result<(Arc<File>, BTreeSet<String>), LinkError> {
    let (source, asked) = condition::translate(&file.source, features)?;
    if Arc::ptr_eq(&source, &file.source) {
        return Ok((Arc::clone(file), asked));
    }
    Ok((Arc::new(parse::parse_source(file.module.as_deref(), source)?), asked))
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
        let same = |file: &&Arc<File>| file.module.as_deref() == Some(name);
        if let Some(other) = self.files.iter().find(same) {
            return Err(LinkError::DuplicateModule {
                place,
                name: name.to_owned(),
                other: other.source.path.clone(),
            });
        }
        let file = parse::parse(Some(name), path, text)?;
        names::check(&file, rules)?;
        self.files.push(Arc::new(file));
        Ok(self)
    }

    /// Decides the conditions of everything that is linked from here on; see [`Features`].
    pub fn features(self, features: Features) -> Self {
        Self { features, ..self }
    }

    /// Adds a module of the user's own from a file; imports find it by `super::` or `package::` and
    /// the file's name without its extension. Its names follow no rule of dpsm's.
    ///
    /// # Errors
    ///
    /// [`LinkError::Unreadable`]; what is wrong with its text is found when something is linked.
    pub fn with_file(mut self, path: impl AsRef<Path>) -> Result<Self, LinkError> {
        let path = path.as_ref();
        self.named.push((path.to_owned(), read::read(path, None)?));
        Ok(self)
    }

    /// As [`link`](link()), from this catalogue and the modules of files.
    ///
    /// # Errors
    ///
    /// As [`link`](link()), and whatever is wrong between the modules: [`LinkError::Cycle`],
    /// [`LinkError::NameClash`], [`LinkError::Captured`].
    pub fn link(&self, names: &[&str]) -> Result<Linked, LinkError> {
        let package = self.package(None)?.0;
        let program = Program::new(&package);
        let mut whole = BTreeSet::new();
        let mut roots = BTreeSet::new();
        for request in names {
            let place = || Place { file: (*request).to_owned(), line: 0 };
            let (module, item) = match parse::strip_root(request).split_once("::") {
                None => (parse::strip_root(request), None),
                Some((module, item)) => (module, Some(item)),
            };
            let file = match package.named.get(module) {
                Some(file) => *file,
                None => program.module(module, place)?,
            };
            match item {
                None => {
                    whole.insert(file);
                }
                Some(item) => {
                    roots.insert(program.declaration(file, item, place)?);
                }
            }
        }
        let kept = program.select(&whole, roots)?;
        let requests: BTreeSet<_> = names.iter().copied().collect();
        let name = requests.into_iter().collect::<Vec<_>>().join(", ");
        Ok(self.emitted(&program, &kept, &whole, name, &package.asked))
    }

    /// As [`link_source`](link_source()), from this catalogue.
    ///
    /// # Errors
    ///
    /// As [`link_source`](link_source()).
    pub fn link_source(&self, path: &str, text: &str) -> Result<Linked, LinkError> {
        let user = parse_decided(None, path, text, &self.features)?;
        self.link_user(path, self.package(Some(user))?)
    }

    /// As [`link_file`](link_file()), from this catalogue and the modules of files.
    ///
    /// # Errors
    ///
    /// As [`link_file`](link_file()).
    pub fn link_file(&self, path: impl AsRef<Path>) -> Result<Linked, LinkError> {
        let path = path.as_ref();
        let text = read::read(path, None)?;
        let mut package = Package::new(&self.files, &self.features)?;
        let name = path.display().to_string();
        let shader = package.shader(&name, &text)?;
        for (path, text) in &self.named {
            package.module(path, text)?;
        }
        package.load()?;
        self.link_user(&name, (package, shader))
    }

    /// The catalogue's files, the modules of files, and a shader that no file holds.
    fn package(
        &self,
        shader: Option<(File, BTreeSet<String>)>,
    ) -> Result<(Package, usize), LinkError> {
        let mut package = Package::new(&self.files, &self.features)?;
        for (path, text) in &self.named {
            package.module(path, text)?;
        }
        let shader = shader.map(|(file, asked)| package.text(file, asked));
        package.load()?;
        Ok((package, shader.unwrap_or_default()))
    }

    fn link_user(
        &self,
        name: &str,
        (package, user): (Package, usize),
    ) -> Result<Linked, LinkError> {
        let program = Program::new(&package);
        let whole = BTreeSet::from([user]);
        let imports = 0..program.files[user].imports.len();
        let roots: Result<BTreeSet<Id>, _> =
            imports.map(|index| program.imported(user, index)).collect();
        let kept = program.select(&whole, roots?)?;
        Ok(self.emitted(&program, &kept, &whole, name.to_owned(), &package.asked))
    }

    fn emitted(
        &self,
        program: &Program,
        kept: &program::Kept,
        whole: &BTreeSet<usize>,
        name: String,
        asked: &BTreeSet<String>,
    ) -> Linked {
        let mut linked = emit::emit(program, kept, whole, name);
        for feature in self.features.names().filter(|name| !asked.contains(*name)) {
            let near = names::nearest(feature, asked.iter().map(String::as_str));
            let remedy = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => "leave it out, or check its name".to_owned(),
            };
            linked.notes.push(Note {
                place: Place { file: linked.name().to_owned(), line: 0 },
                what: format!("no condition asks for the feature `{feature}`"),
                remedy,
                unfinished: false,
            });
        }
        linked
    }

    /// What each module is and holds, in the catalogue's order.
    ///
    /// ```
    /// let modules = dpsm::Catalogue::dpsm()?.describe();
    /// assert!(modules.iter().any(|module| module.name == "paraboloid"));
    /// # Ok::<(), dpsm::LinkError>(())
    /// ```
    pub fn describe(&self) -> Vec<ModuleInfo> {
        self.files.iter().map(|file| describe(file)).collect()
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
