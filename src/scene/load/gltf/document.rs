//! The JSON of a glTF, typed no earlier than it is needed.
//!
//! Each element of a list stays text until a mesh asks for it. So whatever else a file holds, as
//! animations, samplers, compressed pictures or extensions of the future, cannot make it unreadable.

use std::collections::HashMap;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::extensions;
use super::fault::Fault;

pub(super) struct Document<'a> {
    lists: HashMap<String, Vec<&'a RawValue>>,
    pub scene: Option<usize>,
    pub extensions: Extensions<'a>,
    pub used: Vec<String>,
    pub required: Vec<String>,
}

/// An object's extensions by name, not yet read.
pub(super) type Extensions<'a> = HashMap<String, &'a RawValue>;

#[derive(Deserialize)]
struct Asset {
    version: String,
}

impl<'a> Document<'a> {
    pub fn new(json: &'a [u8]) -> Result<Self, Fault> {
        let text = std::str::from_utf8(json).map_err(|error| format!("its JSON: {error}"))?;
        let members: HashMap<String, &RawValue> =
            serde_json::from_str(text).map_err(|error| error.to_string())?;
        let asset = members.get("asset").ok_or("it has no `asset`, so it is no glTF")?;
        let version = of_text::<Asset>(asset).map_err(|what| format!("asset: {what}"))?.version;
        if version.split('.').next() != Some("2") {
            return Err(format!("it is glTF {version}: convert it to glTF 2.0").into());
        }
        let list = |(name, value): (&String, &&'a RawValue)| {
            // what is no list is no part of the format
            serde_json::from_str(value.get()).ok().map(|list| (name.clone(), list))
        };
        fn member<'a, T: Deserialize<'a> + Default>(
            members: &Extensions<'a>,
            name: &str,
        ) -> Result<T, String> {
            let value = members.get(name).map(|value| of_text(value));
            value
                .transpose()
                .map(Option::unwrap_or_default)
                .map_err(|what| format!("{name}: {what}"))
        }
        Ok(Self {
            lists: members.iter().filter_map(list).collect(),
            scene: member(&members, "scene")?,
            extensions: member(&members, "extensions")?,
            used: member(&members, "extensionsUsed")?,
            required: member(&members, "extensionsRequired")?,
        })
    }

    /// How many elements a list has.
    pub fn count(&self, list: &str) -> usize {
        self.lists.get(list).map_or(0, Vec::len)
    }

    /// An element of a list.
    pub fn get<T: Deserialize<'a>>(&self, list: &str, index: usize) -> Result<T, Fault> {
        let element = self.lists.get(list).and_then(|list| list.get(index));
        let element = element.ok_or_else(|| {
            format!("{list}[{index}] is not there: there are {}", self.count(list))
        })?;
        Ok(of_text(element).map_err(|what| format!("{list}[{index}]: {what}"))?)
    }

    /// Refuses what a mesh cannot be had from without an extension that is required and not read.
    pub fn check(&self, extensions: &Extensions) -> Result<(), Fault> {
        let unread = |name: &&String| {
            extensions.contains_key(*name) && !extensions::is_read_or_harmless(name)
        };
        match self.required.iter().find(unread) {
            Some(extension) => Err(Fault::Extension(extension.clone())),
            None => Ok(()),
        }
    }
}

/// A part of the document, typed; an error says what is wrong with it.
pub(super) fn of_text<'a, T: Deserialize<'a>>(text: &'a RawValue) -> Result<T, String> {
    serde_json::from_str(text.get()).map_err(|error| {
        // the line and column are the part's, not the file's
        let what = error.to_string();
        what.split(" at line ").next().unwrap_or_default().into()
    })
}

/// One of an object's extensions, if it has it.
pub(super) fn extension<'a, T: Deserialize<'a>>(
    extensions: &Extensions<'a>,
    name: &str,
) -> Result<Option<T>, String> {
    let found = extensions.get(name).map(|text| of_text(text));
    found.transpose().map_err(|what| format!("{name}: {what}"))
}
