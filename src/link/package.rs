//! A user's own modules in files: which file an import names, from the folder of the file that
//! holds it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::condition::Features;
use super::error::{LinkError, Place};
use super::parse::{File, Import, Root};
use super::read::{listed, read, shaders};

/// Files that import each other: first those of the catalogue, then those of the user.
pub(super) struct Package {
    pub files: Vec<Arc<File>>,
    /// For a file's import by index the file that it names, where that is one of the user's.
    pub links: BTreeMap<(usize, usize), usize>,
    /// Features that conditions ask for.
    pub asked: BTreeSet<String>,
    /// How many files are the catalogue's.
    own: usize,
    features: Features,
    /// What `package::` stands for.
    root: PathBuf,
    homes: Vec<Home>,
    /// Modules that were named by path: they are beside every file.
    pub named: BTreeMap<String, usize>,
}

/// Where a user's file is.
struct Home {
    /// The same for every way to write the path.
    key: PathBuf,
    /// None of a text that is in no file.
    folder: Option<PathBuf>,
    /// Folders between the root of the package and the file's.
    depth: usize,
}

impl Package {
    /// The catalogue's modules alone.
    pub fn new(files: &[Arc<File>], features: &Features) -> Result<Self, LinkError> {
        let mut package = Self {
            files: Vec::new(),
            links: BTreeMap::new(),
            asked: BTreeSet::new(),
            own: files.len(),
            features: features.clone(),
            root: PathBuf::new(),
            homes: Vec::new(),
            named: BTreeMap::new(),
        };
        for file in files {
            let (decided, asked) = super::decided(file, features)?;
            package.files.push(decided);
            package.asked.extend(asked);
        }
        Ok(package)
    }

    /// Adds the shader to link; `package::` is its folder.
    pub fn shader(&mut self, path: &str, text: &str) -> Result<usize, LinkError> {
        self.root = folder(Path::new(path));
        self.add(None, Path::new(path), text, 0)
    }

    /// Adds a shader that no file holds, beside the modules that were named by path.
    pub fn text(&mut self, file: File, asked: BTreeSet<String>) -> usize {
        self.asked.extend(asked);
        let name = PathBuf::from(&file.source.path);
        self.files.push(Arc::new(file));
        self.homes.push(Home { key: name, folder: None, depth: 0 });
        self.files.len() - 1
    }

    /// Adds a module that imports find under its file's name wherever they stand.
    pub fn module(&mut self, path: &Path, text: &str) -> Result<(), LinkError> {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let place = || Place { file: path.display().to_string(), line: 1 };
        if !super::parse::is_module_name(&stem) {
            let what = format!("`{stem}` cannot be the name of a module; rename the file");
            return Err(LinkError::Malformed { place: place(), what });
        }
        if let Some(other) = self.named.get(&stem) {
            let other = self.files[*other].source.path.clone();
            return Err(LinkError::DuplicateModule { place: place(), name: stem, other });
        }
        if self.root.as_os_str().is_empty() {
            self.root = folder(path);
        }
        let index = match self.find(&key(path)) {
            Some(index) => index,
            None => self.add(Some(&stem), path, text, 0)?,
        };
        self.named.insert(stem, index);
        Ok(())
    }

    fn add(
        &mut self,
        module: Option<&str>,
        path: &Path,
        text: &str,
        depth: usize,
    ) -> Result<usize, LinkError> {
        let name = path.display().to_string();
        let (mut file, asked) = super::parse_decided(module, &name, text, &self.features)?;
        file.on_disk = true;
        self.asked.extend(asked);
        self.files.push(Arc::new(file));
        self.homes.push(Home { key: key(path), folder: Some(folder(path)), depth });
        Ok(self.files.len() - 1)
    }

    fn find(&self, key: &Path) -> Option<usize> {
        self.homes.iter().position(|home| home.key == key).map(|at| self.own + at)
    }

    /// Reads every file that the user's files import, and finds out which file each import names.
    pub fn load(&mut self) -> Result<(), LinkError> {
        let mut file = self.own;
        while file < self.files.len() {
            for index in 0..self.files[file].imports.len() {
                let import = self.files[file].imports[index].clone();
                if let Some(to) = self.target(file, &import)? {
                    self.links.insert((file, index), to);
                }
            }
            file += 1;
        }
        Ok(())
    }

    /// The user's file that an import names; none where it is one of the catalogue's modules.
    fn target(&mut self, file: usize, import: &Import) -> Result<Option<usize>, LinkError> {
        let place = self.files[file].source.place(import.at);
        let known = |known: &&Arc<File>| known.module.as_deref() == Some(import.module.as_str());
        let catalogue = self.files[..self.own].iter().find(known);
        if import.root == Root::Dpsm
            || catalogue.is_some_and(|known| known.names.contains_key(&import.item))
        {
            return Ok(None);
        }
        if let Some(named) = self.named.get(&import.module) {
            return Ok(Some(*named));
        }
        let catalogue = catalogue.is_some();
        if self.homes[file - self.own].folder.is_none() {
            return Ok(None);
        }
        let (folder, depth) = self.start(file, import, &place)?;
        let steps: Vec<_> = import.module.split("::").collect();
        let stem = folder.join(steps.join("/"));
        for extension in ["wesl", "wgsl"] {
            let path = stem.with_extension(extension);
            if !path.is_file() {
                continue;
            }
            if let Some(index) = self.find(&key(&path)) {
                return Ok(Some(index));
            }
            let text = read(&path, Some(place))?;
            let depth = depth + steps.len() - 1;
            let name = match depth {
                0 => steps.join("::"),
                _ => self.name_of(&path).unwrap_or_else(|| steps.join("::")),
            };
            return self.add(Some(&name), &path, &text, depth).map(Some);
        }
        // the catalogue's module knows best what it does not hold
        if catalogue { Ok(None) } else { Err(self.no_file(&stem, import, place)) }
    }

    /// A file's path from the root, with `::`.
    fn name_of(&self, path: &Path) -> Option<String> {
        let inside = path.with_extension("");
        let inside = inside.strip_prefix(&self.root).ok()?;
        let steps = inside.components().map(|step| step.as_os_str().to_string_lossy());
        Some(steps.collect::<Vec<_>>().join("::"))
    }

    /// The folder that an import starts from, and how deep it is.
    fn start(
        &self,
        file: usize,
        import: &Import,
        place: &Place,
    ) -> Result<(PathBuf, usize), LinkError> {
        let home = &self.homes[file - self.own];
        let Root::Super(ups) = import.root else {
            return Ok((self.root.clone(), 0));
        };
        if ups > home.depth + 1 {
            let what = format!(
                "`{}` leads out of {}, the folder of the shader that is linked; name the file by \
                 `--module PATH`",
                vec!["super"; ups].join("::"),
                shown(&self.root)
            );
            return Err(LinkError::NoFile {
                place: place.clone(),
                name: import.module.clone(),
                what,
            });
        }
        let mut folder = home.folder.clone().unwrap_or_default();
        for _ in 1..ups {
            folder.pop();
        }
        Ok((folder, home.depth + 1 - ups))
    }

    fn no_file(&self, stem: &Path, import: &Import, place: Place) -> LinkError {
        let name = stem.file_name().unwrap_or_default().to_string_lossy();
        let folder = folder(stem);
        let files = shaders(&folder, &format!("{name}.wesl"));
        let there = if !folder.as_os_str().is_empty() && !folder.is_dir() {
            format!("there is no folder {}", shown(&folder))
        } else if files.is_empty() {
            format!("{} holds no .wesl or .wgsl", shown(&folder))
        } else {
            format!("{} holds {}", shown(&folder), listed(&files))
        };
        let modules = self.files[..self.own].iter().filter_map(|file| file.module.as_deref());
        let near = super::names::nearest(&import.module, modules);
        let near = near.map_or_else(String::new, |near| format!("; dpsm has `dpsm::{near}`"));
        let what = format!(
            "no file {}.wesl or .wgsl, and {there}; write the name that it has, or give its path by \
             `--module PATH`{near}",
            stem.display()
        );
        LinkError::NoFile { place, name: import.module.clone(), what }
    }
}

fn folder(path: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).to_owned()
}

fn shown(folder: &Path) -> String {
    match folder.as_os_str().is_empty() {
        true => "this folder".to_owned(),
        false => folder.display().to_string(),
    }
}

fn key(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}
