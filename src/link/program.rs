//! Files that import each other: resolution of names, order, and what is reachable.

use std::collections::{BTreeMap, BTreeSet};

use super::error::{LinkError, Place};
use super::names::{by_nearness, nearest, without_prefix};
use super::package::Package;
use super::parse::{File, Item, Root};

/// A file and a declaration in it, by index.
pub(crate) type Id = (usize, usize);

/// What a file's words mean: its own declarations and its imports.
type Scope<'a> = BTreeMap<&'a str, Id>;

pub(crate) struct Program<'a> {
    pub files: Vec<&'a File>,
    modules: BTreeMap<&'a str, usize>,
    package: &'a Package,
}

/// The declarations to keep, and the files in dependency order.
pub(crate) struct Kept {
    pub order: Vec<usize>,
    pub items: BTreeSet<Id>,
}

impl<'a> Program<'a> {
    pub fn new(package: &'a Package) -> Self {
        let files: Vec<_> = package.files.iter().map(|file| &**file).collect();
        let names = files.iter().enumerate().filter(|(_, file)| !file.on_disk);
        let modules = names.filter_map(|(index, file)| Some((file.module.as_deref()?, index)));
        Self { modules: modules.collect(), files, package }
    }

    fn get(&self, (file, item): Id) -> &'a Item {
        &self.files[file].items[item]
    }

    fn place(&self, id: Id) -> Place {
        self.files[id.0].source.place(self.get(id).at)
    }

    /// Index of a module of the catalogue.
    pub fn module(&self, name: &str, place: impl Fn() -> Place) -> Result<usize, LinkError> {
        if let Some(found) = self.modules.get(name) {
            return Ok(*found);
        }
        if let Some(module) = self.declaring(name) {
            let instead = format!("write `{module}::{name}`");
            let what = format!("an item of the module `{module}`, not a module");
            return Err(LinkError::OtherKind { name: name.to_owned(), what, instead });
        }
        let modules = || {
            let named = self.package.named.keys().map(String::as_str);
            self.modules.keys().copied().chain(named)
        };
        let items = self.modules.values().flat_map(|file| self.files[*file].names.keys());
        let near = nearest(name, modules()).or_else(|| {
            let item = nearest(name, items.map(String::as_str))?;
            Some(format!("{}::{item}", self.declaring(&item)?))
        });
        // who writes dpsm's prefix is after an item
        let present = match without_prefix(name) {
            Some(_) => self.items_by_nearness(name),
            None => by_nearness(name, modules()),
        };
        let (name, present) = (name.to_owned(), present.into());
        Err(LinkError::UnknownModule { place: place(), name, near, present })
    }

    /// Every item of the catalogue with its module.
    fn items_by_nearness(&self, name: &str) -> Vec<String> {
        let items = self.modules.values().flat_map(|file| self.files[*file].names.keys());
        let items = by_nearness(name, items.map(String::as_str)).into_iter();
        items.filter_map(|item| Some(format!("{}::{item}", self.declaring(&item)?))).collect()
    }

    /// The catalogue's module that declares a name.
    fn declaring(&self, name: &str) -> Option<&'a str> {
        let declares = |file: &usize| self.files[*file].names.contains_key(name);
        self.modules.iter().find(|(_, file)| declares(file)).map(|(module, _)| *module)
    }

    /// What a file's import names.
    pub fn imported(&self, file: usize, index: usize) -> Result<Id, LinkError> {
        let import = &self.files[file].imports[index];
        let place = || self.files[file].source.place(import.at);
        let to = match self.package.links.get(&(file, index)) {
            Some(to) => *to,
            None => match (self.package.named.get(&import.module), import.root) {
                (Some(named), root) if root != Root::Dpsm => *named,
                _ => self.module(&import.module, place)?,
            },
        };
        self.declaration(to, &import.item, place)
    }

    /// A file's declaration.
    pub fn declaration(
        &self,
        file: usize,
        name: &str,
        place: impl Fn() -> Place,
    ) -> Result<Id, LinkError> {
        let names = &self.files[file].names;
        if let Some(item) = names.get(name) {
            return Ok((file, *item));
        }
        let elsewhere = self.declaring(name).map(|module| format!("{module}::{name}"));
        let present = match elsewhere {
            Some(_) => Vec::new(),
            None => by_nearness(name, names.keys().map(String::as_str)),
        };
        Err(LinkError::UnknownItem {
            place: place(),
            module: self.name(file),
            name: name.to_owned(),
            near: elsewhere.or_else(|| nearest(name, names.keys().map(String::as_str))),
            present: present.into(),
        })
    }

    /// A file's name in messages.
    fn name(&self, file: usize) -> String {
        let file = self.files[file];
        file.module.clone().unwrap_or_else(|| file.source.path.clone())
    }

    /// What is reachable from whole files and single declarations; checks the files for cycles,
    /// and the result for names that would not mean what they mean in their own file.
    pub fn select(
        &self,
        whole: &BTreeSet<usize>,
        mut items: BTreeSet<Id>,
    ) -> Result<Kept, LinkError> {
        let starts = whole.iter().copied().chain(items.iter().map(|id| id.0));
        let order = self.order(starts.collect())?;
        let mut scopes = BTreeMap::new();
        for file in &order {
            scopes.insert(*file, self.scope(*file)?);
        }
        for file in whole {
            items.extend((0..self.files[*file].items.len()).map(|item| (*file, item)));
        }
        let mut todo: Vec<Id> = items.iter().copied().collect();
        while let Some(id) = todo.pop() {
            let item = self.get(id);
            let used = item.words.keys().filter_map(|word| scopes[&id.0].get(word.as_str()));
            let mates = item.mates.iter().map(|mate| (id.0, *mate));
            for used in used.copied().chain(mates) {
                if items.insert(used) {
                    todo.push(used);
                }
            }
        }
        for file in &order {
            if items.range((*file, 0)..(*file + 1, 0)).next().is_some() {
                let asserts = self.asserts(*file, &scopes[file], &items);
                items.extend(asserts);
            }
        }
        self.check_names(&order, &items, &scopes)?;
        Ok(Kept { order, items })
    }

    /// Dependencies first; else by where a file stands in the catalogue.
    fn order(&self, starts: BTreeSet<usize>) -> Result<Vec<usize>, LinkError> {
        let mut order = Vec::new();
        let mut done = vec![false; self.files.len()];
        for start in starts {
            // Each file on the way down, with the index of its next import.
            let mut path = vec![(start, 0)];
            while let Some((file, next)) = path.last_mut() {
                let (file, index) = (*file, *next);
                let import = self.files[file].imports.get(index);
                *next += 1;
                let Some(import) = import.filter(|_| !done[file]) else {
                    if !done[file] {
                        done[file] = true;
                        order.push(file);
                    }
                    path.pop();
                    continue;
                };
                let place = || self.files[file].source.place(import.at);
                let to = self.imported(file, index)?.0;
                if let Some(from) = path.iter().position(|(file, _)| *file == to) {
                    let chain = path[from..].iter().map(|(file, _)| *file).chain([to]);
                    let chain = chain.map(|file| self.name(file)).collect();
                    return Err(LinkError::Cycle { place: place(), chain });
                }
                if !done[to] {
                    path.push((to, 0));
                }
            }
        }
        Ok(order)
    }

    fn scope(&self, file: usize) -> Result<Scope<'a>, LinkError> {
        let names = self.files[file].names.iter();
        let own = names.map(|(name, item)| (name.as_str(), (file, *item)));
        let mut scope: Scope = own.collect();
        for (index, import) in self.files[file].imports.iter().enumerate() {
            let place = || self.files[file].source.place(import.at);
            let id = self.imported(file, index)?;
            match scope.insert(&import.item, id) {
                Some(other) if other != id && import.conditional => {
                    let what = format!(
                        "`{}` is another declaration under another condition; give the features, so \
                         that it is decided here which",
                        import.item
                    );
                    return Err(LinkError::Condition { place: place(), what });
                }
                Some(other) if other != id => {
                    return Err(LinkError::NameClash {
                        place: if other.0 == file { self.place(other) } else { place() },
                        name: import.item.clone(),
                        other: self.place(if other.0 == file { id } else { other }),
                    });
                }
                _ => {}
            }
        }
        Ok(scope)
    }

    /// The assertions of a file about nothing but what is kept.
    fn asserts(&self, file: usize, scope: &Scope, kept: &BTreeSet<Id>) -> Vec<Id> {
        let items = self.files[file].items.iter().enumerate();
        let asserts = items.filter(|(_, item)| {
            let mut named = item.words.keys().filter_map(|word| scope.get(word.as_str()));
            item.kind == "const_assert" && named.all(|id| kept.contains(id))
        });
        asserts.map(|(index, _)| (file, index)).collect()
    }

    fn check_names(
        &self,
        order: &[usize],
        items: &BTreeSet<Id>,
        scopes: &BTreeMap<usize, Scope>,
    ) -> Result<(), LinkError> {
        let in_order = || {
            let files = order.iter();
            files.flat_map(|file| items.range((*file, 0)..(*file + 1, 0)).copied())
        };
        let mut declared: Scope = BTreeMap::new();
        for id in in_order() {
            let Some(name) = &self.get(id).name else {
                continue;
            };
            // in one file they are alternatives
            if let Some(other) = declared.insert(name, id).filter(|other| other.0 != id.0) {
                return Err(LinkError::NameClash {
                    place: self.place(id),
                    name: name.clone(),
                    other: self.place(other),
                });
            }
        }
        for id in in_order() {
            let (file, item) = (self.files[id.0], self.get(id));
            let own = file.module.is_none() || file.on_disk;
            // a text may hold dpsm's own declarations, as those of dist/
            if let Some(name) = item.name.as_ref().filter(|_| own)
                && let Some(rest) = without_prefix(name)
                && self.declaring(name).is_none()
            {
                return Err(LinkError::ReservedPrefix {
                    place: self.place(id),
                    name: name.clone(),
                    near: super::token::is_word(rest).then(|| rest.to_owned()),
                });
            }
            for (word, at) in &item.words {
                let known = scopes[&id.0].contains_key(word.as_str()) || file.locals.contains(word);
                if let Some(other) = declared.get(word.as_str()).filter(|_| !known) {
                    return Err(self.captured(file, word, *at, *other));
                }
            }
        }
        Ok(())
    }

    fn captured(&self, file: &File, word: &str, at: usize, other: Id) -> LinkError {
        let to = self.files[other.0];
        let root = match (file.module.is_some() && !file.on_disk, to.on_disk) {
            (true, _) => "super",
            (false, false) => "dpsm",
            (false, true) => "package",
        };
        LinkError::Captured {
            place: file.source.place(at),
            name: word.to_owned(),
            other: self.place(other),
            fix: match &to.module {
                Some(module) => format!("add `import {root}::{module}::{{{word}}};` or rename it"),
                None => "rename that declaration".to_owned(),
            },
        }
    }
}
