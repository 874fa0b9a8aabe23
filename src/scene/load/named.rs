//! Files that a scene's file names: buffers, images and material libraries.

use std::fs;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};

use ::gltf::buffer;

/// A regular file's bytes. Others are refused: a device or a pipe may never end.
pub(super) fn read(path: &Path) -> Result<Vec<u8>> {
    match fs::metadata(path)?.is_file() {
        true => fs::read(path),
        false => Err(Error::other("it is no regular file")),
    }
}

/// The bytes behind a glTF URI, which may be a data URI or a file's name.
pub(super) fn of_uri(uri: &str, folder: Option<&Path>) -> std::result::Result<Vec<u8>, String> {
    match path(uri) {
        Some(path) => {
            read(&folder.unwrap_or(Path::new("")).join(path)).map_err(|error| error.to_string())
        }
        None => buffer::Data::from_source(buffer::Source::Uri(uri), folder)
            .map(|data| data.0)
            .map_err(|error| error.to_string()),
    }
}

/// The path of a file's URI; `None` for data and what is no file.
fn path(uri: &str) -> Option<PathBuf> {
    match uri.split_once(':') {
        None => Some(decoded(uri).into()),
        Some(("file", path)) => Some(path.strip_prefix("//").unwrap_or(path).into()),
        Some(_) => None,
    }
}

/// A text whose `%20` and the like are the characters that they stand for; what stands for none
/// stays.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let Some((&first, others)) = rest.split_first() {
        let digits = others.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        let digits = digits.filter(|two| two.bytes().all(|byte| byte.is_ascii_hexdigit()));
        let escaped = digits.and_then(|two| u8::from_str_radix(two, 16).ok());
        match escaped.filter(|_| first == b'%') {
            Some(byte) => {
                bytes.push(byte);
                rest = &others[2..];
            }
            None => {
                bytes.push(first);
                rest = others;
            }
        }
    }
    String::from_utf8(bytes).unwrap_or_else(|_| text.into())
}
