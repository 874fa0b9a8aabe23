//! Files that a scene's file names: buffers, images and material libraries.

use std::fs;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::alphabet::{STANDARD, URL_SAFE};
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

/// A regular file's bytes. Others are refused: a device or a pipe may never end.
pub(super) fn read(path: &Path) -> Result<Vec<u8>> {
    match fs::metadata(path)?.is_file() {
        true => fs::read(path),
        false => Err(Error::other("it is no regular file")),
    }
}

/// The bytes behind a glTF URI, which may be a data URI or a file's name.
pub(super) fn of_uri(uri: &str, folder: Option<&Path>) -> std::result::Result<Vec<u8>, String> {
    match uri.split_once(':') {
        None => of_file(&decoded(uri), folder),
        Some(("file", path)) => of_file(path.strip_prefix("//").unwrap_or(path).as_bytes(), folder),
        Some(("data", data)) => of_data(data),
        Some((scheme, _)) => Err(format!("`{scheme}:` is neither a file nor data; download it")),
    }
}

fn of_file(name: &[u8], folder: Option<&Path>) -> std::result::Result<Vec<u8>, String> {
    let name = PathBuf::from(String::from_utf8_lossy(name).as_ref());
    read(&folder.unwrap_or(Path::new("")).join(name)).map_err(|error| error.to_string())
}

/// The part of a data URI behind `data:`, in base64 of either alphabet, padded or not, or as it is
/// with escapes (RFC 2397).
fn of_data(data: &str) -> std::result::Result<Vec<u8>, String> {
    let (kind, data) = data.split_once(',').ok_or("a data URI without a comma")?;
    let bytes = decoded(data);
    if !kind.ends_with(";base64") {
        return Ok(bytes);
    }
    let padding = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true);
    let alphabet = if data.contains(['-', '_']) { URL_SAFE } else { STANDARD };
    GeneralPurpose::new(&alphabet, padding).decode(bytes).map_err(|error| error.to_string())
}

/// The bytes of a text whose `%20` and the like are the characters that they stand for; what stands
/// for none stays.
fn decoded(text: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
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
    bytes
}
