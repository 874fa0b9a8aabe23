//! Naming rules, and the nearest name to a wrong one.

use super::error::LinkError;
use super::parse::{File, Item};

/// Whose text it is decides which rules its names follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rules {
    /// dpsm's own modules: names that survive translation, and the prefix as a namespace.
    Builtin,
    /// Modules that a user adds: names that survive translation.
    Library,
    /// A user's shader: anything but the prefix, which is checked when it is linked.
    User,
}

/// The `dpsm` prefixes of functions and variables, types, constants.
const PREFIXES: [&str; 3] = ["dpsm_", "Dpsm", "DPSM_"];

/// Checks every name that a file declares.
pub(crate) fn check(file: &File, rules: Rules) -> Result<(), LinkError> {
    if rules == Rules::User {
        return Ok(());
    }
    for item in &file.items {
        let own = item.name.iter().map(|name| (name.as_str(), item.at, true));
        let inner = item.locals.iter();
        let inner = inner.map(|(name, at)| (name.as_str(), *at, false));
        for (name, at, outer) in own.chain(inner) {
            let prefix = (outer && rules == Rules::Builtin).then(|| prefix(item));
            if let Some((rule, near)) = fault(name, prefix) {
                return Err(LinkError::BadName {
                    place: file.source.place(at),
                    name: name.to_owned(),
                    rule,
                    near,
                });
            }
        }
    }
    Ok(())
}

/// The broken rule and the corrected name.
fn fault(name: &str, prefix: Option<&str>) -> Option<(&'static str, Option<String>)> {
    if !name.is_ascii() {
        return Some(("is not ASCII, so naga's back-ends rename it", None));
    }
    let rule = if name.ends_with(|c: char| c.is_ascii_digit()) {
        "ends in a digit, so naga's back-ends rename it"
    } else if name.contains("__") {
        "holds `__`, so naga's back-ends rename it"
    } else if name.ends_with('_') {
        "ends in `_`, so naga's back-ends rename it"
    } else {
        match prefix? {
            prefix if name.starts_with(prefix) => return None,
            "dpsm_" => "lacks the prefix `dpsm_` of functions and variables",
            "Dpsm" => "lacks the prefix `Dpsm` of types",
            _ => "lacks the prefix `DPSM_` of constants",
        }
    };
    let plain = name.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
    let mut near = String::new();
    for c in plain.chars() {
        if !(c == '_' && near.ends_with('_')) {
            near.push(c);
        }
    }
    if let Some(prefix) = prefix.filter(|prefix| !near.starts_with(prefix)) {
        near = prefixed(prefix, &near);
    }
    let usable = near.len() > prefix.map_or(0, str::len);
    Some((rule, usable.then_some(near)))
}

fn prefix(item: &Item) -> &'static str {
    match item.kind {
        "fn" | "var" => PREFIXES[0],
        "struct" | "alias" => PREFIXES[1],
        _ => PREFIXES[2],
    }
}

/// A name in the case of its prefix: `maxSteps` -> `DPSM_MAX_STEPS`.
fn prefixed(prefix: &str, name: &str) -> String {
    let mut words: Vec<String> = Vec::new();
    let mut after_lower = false;
    for c in name.chars() {
        if words.is_empty() || c == '_' || (after_lower && c.is_ascii_uppercase()) {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| c != '_') {
            word.push(c.to_ascii_lowercase());
        }
        after_lower = c.is_ascii_lowercase();
    }
    words.retain(|word| !word.is_empty() && word != "dpsm");
    match prefix {
        "dpsm_" => format!("{prefix}{}", words.join("_")),
        "DPSM_" => format!("{prefix}{}", words.join("_").to_ascii_uppercase()),
        _ => words.iter().fold(prefix.to_owned(), |name, word| {
            name + &word[..1].to_ascii_uppercase() + &word[1..]
        }),
    }
}

/// For a name with one of dpsm's prefixes, what is left without it.
pub(crate) fn without_prefix(name: &str) -> Option<&str> {
    PREFIXES.iter().find_map(|prefix| name.strip_prefix(prefix))
}

/// Longer names are no slips, and the distance takes time by the product of the lengths.
const LONGEST: usize = 64;

/// Candidates, those nearest to a name first; each once.
pub(crate) fn by_nearness<'a>(
    name: &str,
    candidates: impl Iterator<Item = &'a str>,
) -> Vec<String> {
    let distance = |candidate: &str| match name.len().max(candidate.len()) > LONGEST {
        true => usize::MAX,
        false => strsim::damerau_levenshtein(name, candidate),
    };
    let all: std::collections::BTreeSet<_> =
        candidates.map(|candidate| (distance(candidate), candidate)).collect();
    all.into_iter().map(|(_, candidate)| candidate.to_owned()).collect()
}

/// The candidate nearest to a name, if a slip of the keyboard could have made one of the other.
pub(crate) fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<String> {
    let limit = (name.chars().count() / 3).max(1);
    candidates
        .filter(|candidate| name.len() <= LONGEST && candidate.len() <= LONGEST)
        .map(|candidate| (strsim::damerau_levenshtein(name, candidate), candidate))
        .filter(|(distance, _)| *distance <= limit)
        .min()
        .map(|(_, candidate)| candidate.to_owned())
}
