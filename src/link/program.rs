//! Files that import each other: resolution of names, order, and what is reachable.

use std::collections::{BTreeMap, BTreeSet};

use super::error::{LinkError, Place};
use super::names::{nearest, without_prefix};
use super::parse::{File, Item};

/// A file and a declaration in it, by index.
pub(crate) type Id = (usize, usize);

/// What a file's words mean: its own declarations and its imports.
type Scope<'a> = BTreeMap<&'a str, Id>;

pub(crate) struct Program<'a> {
    pub files: Vec<&'a File>,
    modules: BTreeMap<&'a str, usize>,
}

/// The declarations to keep, and the files in dependency order.
pub(crate) struct Kept {
    pub order: Vec<usize>,
    pub items: BTreeSet<Id>,
}

impl<'a> Program<'a> {
    pub fn new(files: impl Iterator<Item = &'a File>) -> Self {
        let files: Vec<_> = files.collect();
        let names = files.iter().enumerate();
        let modules = names.filter_map(|(index, file)| Some((file.module.as_deref()?, index)));
        Self { modules: modules.collect(), files }
    }

    fn get(&self, (file, item): Id) -> &'a Item {
        &self.files[file].items[item]
    }

    fn place(&self, id: Id) -> Place {
        self.files[id.0].source.place(self.get(id).at)
    }

    /// Index of a module.
    pub fn module(&self, name: &str, place: impl Fn() -> Place) -> Result<usize, LinkError> {
        let found = self.modules.get(name).copied();
        found.ok_or_else(|| LinkError::UnknownModule {
            place: place(),
            name: name.to_owned(),
            near: nearest(name, self.modules.keys().copied()),
        })
    }

    /// A module's declaration.
    pub fn item(
        &self,
        module: &str,
        name: &str,
        place: impl Fn() -> Place,
    ) -> Result<Id, LinkError> {
        let index = self.module(module, &place)?;
        let names = &self.files[index].names;
        if let Some(item) = names.get(name) {
            return Ok((index, *item));
        }
        let elsewhere =
            self.modules.iter().find(|(_, file)| self.files[**file].names.contains_key(name));
        Err(LinkError::UnknownItem {
            place: place(),
            module: module.to_owned(),
            name: name.to_owned(),
            near: match elsewhere {
                Some((module, _)) => Some(format!("{module}::{name}")),
                None => nearest(name, names.keys().map(String::as_str)),
            },
        })
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
            let words = self.get(id).words.keys();
            for used in words.filter_map(|word| scopes[&id.0].get(word.as_str())) {
                if items.insert(*used) {
                    todo.push(*used);
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
                let (file, import) = (*file, self.files[*file].imports.get(*next));
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
                let to = self.item(&import.module, &import.item, place)?.0;
                if let Some(from) = path.iter().position(|(file, _)| *file == to) {
                    let chain = path[from..].iter().map(|(file, _)| *file).chain([to]);
                    let name = |file: usize| self.files[file].module.clone().unwrap_or_default();
                    return Err(LinkError::Cycle {
                        place: place(),
                        chain: chain.map(name).collect(),
                    });
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
        for import in &self.files[file].imports {
            let place = || self.files[file].source.place(import.at);
            let id = self.item(&import.module, &import.item, place)?;
            match scope.insert(&import.item, id) {
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
            item.name.is_none() && named.all(|id| kept.contains(id))
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
            if let Some(other) = declared.insert(name, id) {
                return Err(LinkError::NameClash {
                    place: self.place(id),
                    name: name.clone(),
                    other: self.place(other),
                });
            }
        }
        for id in in_order() {
            let (file, item) = (self.files[id.0], self.get(id));
            if let Some(name) = item.name.as_ref().filter(|_| file.module.is_none())
                && let Some(rest) = without_prefix(name)
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
        let root = if file.module.is_some() { "super" } else { "dpsm" };
        LinkError::Captured {
            place: file.source.place(at),
            name: word.to_owned(),
            other: self.place(other),
            fix: match &self.files[other.0].module {
                Some(module) => format!("add `import {root}::{module}::{{{word}}};` or rename it"),
                None => "rename that declaration".to_owned(),
            },
        }
    }
}
