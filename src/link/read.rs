//! Reads a file that should be WGSL, and says what it is where it is something else.

use std::io::ErrorKind;
use std::path::Path;

use super::error::{LinkError, Place};
use super::names::by_nearness;

/// Names of files that a message lists at the most.
const LISTED: usize = 6;

/// A file's text; `from` is the import that asks for it.
pub(crate) fn read(path: &Path, from: Option<Place>) -> Result<String, LinkError> {
    text(path).map_err(|what| LinkError::Unreadable {
        place: from,
        path: path.display().to_string(),
        what,
    })
}

fn text(path: &Path) -> Result<String, String> {
    if path.is_dir() {
        let files = shaders(path, "");
        let list = listed(&files);
        return Err(match files.is_empty() {
            true => "it is a folder, with no .wesl or .wgsl file in it; name one file".to_owned(),
            false => format!("it is a folder; name one of its files, {list}"),
        });
    }
    let bytes = std::fs::read(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => missing(path),
        ErrorKind::PermissionDenied => "it cannot be read; give yourself the permission".to_owned(),
        _ => format!("it cannot be read: {error}"),
    })?;
    match what_else(&bytes) {
        Some(what) => Err(what.to_owned()),
        None => {
            String::from_utf8(bytes).map_err(|error| not_utf(error.as_bytes(), error.utf8_error()))
        }
    }
}

fn missing(path: &Path) -> String {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return format!("no such file: there is no folder {}; check the path", folder.display());
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let files = shaders(folder, &name);
    match files.is_empty() {
        true => format!(
            "no such file, and {} holds no .wesl or .wgsl; check the path",
            folder.display()
        ),
        false => format!("no such file; {} holds {}", folder.display(), listed(&files)),
    }
}

/// Shaders in a folder, the nearest to a name first.
pub(crate) fn shaders(folder: &Path, name: &str) -> Vec<String> {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(here).into_iter().flatten().flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let names: Vec<_> =
        names.filter(|name| name.ends_with(".wesl") || name.ends_with(".wgsl")).collect();
    by_nearness(name, names.iter().map(String::as_str))
}

/// The first names of a list, for a message.
pub(crate) fn listed(names: &[String]) -> String {
    let first: Vec<_> = names.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    let more = match names.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    first.join(", ") + &more
}

/// What a file is that holds no UTF-8 text, or text of another kind.
fn what_else(bytes: &[u8]) -> Option<&'static str> {
    let rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let start = rest.trim_ascii_start();
    let nothing = |at: usize| bytes.iter().skip(at).step_by(2).take(16).all(|byte| *byte == 0);
    let tag = start.get(..14).unwrap_or(start).to_ascii_lowercase();
    Some(match bytes {
        _ if start.is_empty() => "the file is empty; write a shader into it",
        [0x03, 0x02, 0x23, 0x07, ..] | [0x07, 0x23, 0x02, 0x03, ..] => {
            "it is SPIR-V, compiled already; name the WGSL that it was made of"
        }
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => "it is UTF-32; save it as UTF-8",
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "it is UTF-16; save it as UTF-8",
        [_, _, _, _, ..] if nothing(0) != nothing(1) => "it is UTF-16; save it as UTF-8",
        _ if start.starts_with(b"version https://git-lfs") => {
            "it is a Git LFS pointer, not the file; fetch it by `git lfs pull`"
        }
        _ if tag.starts_with(b"<!doctype html") || tag.starts_with(b"<html") => {
            "it is a web page, saved under the name of a shader; download the file itself"
        }
        _ if bytes.contains(&0) => "it is binary, no text; name a WGSL or WESL file",
        _ => return None,
    })
}

fn not_utf(bytes: &[u8], error: std::str::Utf8Error) -> String {
    let at = error.valid_up_to();
    let line = bytes[..at].iter().filter(|byte| **byte == b'\n').count() + 1;
    let byte = bytes[at];
    // a text in an old encoding has few such bytes, other data has many
    let odd = bytes.iter().filter(|byte| byte.is_ascii_control() && !byte.is_ascii_whitespace());
    match odd.count() * 20 > bytes.len() {
        true => "it is binary, no text; name a WGSL or WESL file".to_owned(),
        false => format!("line {line} is no UTF-8 (byte 0x{byte:02x}); save the file as UTF-8"),
    }
}
