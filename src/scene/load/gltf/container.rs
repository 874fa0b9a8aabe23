//! The two containers of glTF, told apart by content: text, and binary with the text in a chunk.

/// A file's JSON, and the bytes that follow it in a binary file.
pub(super) struct Parts<'a> {
    pub json: &'a [u8],
    pub bin: Option<&'a [u8]>,
}

const HEADER: usize = 12;
const VERSION: u32 = 2;

pub(super) fn parts(bytes: &[u8]) -> Result<Parts<'_>, String> {
    if bytes.starts_with(b"glTF") {
        return binary(bytes);
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match text.trim_ascii_start().first() {
        Some(b'{') => Ok(Parts { json: text, bin: None }),
        _ if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") => {
            Err("it is text in UTF-16, and glTF is UTF-8".into())
        }
        _ => {
            let start: String = String::from_utf8_lossy(bytes).chars().take(16).collect();
            Err(format!("it is neither binary glTF nor JSON: it begins with {start:?}"))
        }
    }
}

/// A header and chunks (glTF 2.0, 4.4), of which unknown ones are skipped.
fn binary(bytes: &[u8]) -> Result<Parts<'_>, String> {
    let version = word(bytes, 4).ok_or("its header ends early")?;
    if version != VERSION {
        return Err(format!("it is glTF {version}.0: convert it to glTF 2.0"));
    }
    let length = word(bytes, 8).ok_or("its header ends early")? as usize;
    let whole = bytes.get(HEADER..length).ok_or_else(|| {
        format!("it has {} bytes, and its header says {length}: it was cut", bytes.len())
    })?;
    let (mut json, mut bin, mut rest) = (None, None, whole);
    while let (Some(length), Some(kind)) = (word(rest, 0), word(rest, 4)) {
        let chunk = rest[8..].get(..length as usize).ok_or("a chunk is longer than the file")?;
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if bin.is_none() => bin = Some(chunk),
            _ => {}
        }
        // a length that is no multiple of 4 is common at the file's end
        rest = rest[8..].get((length as usize).next_multiple_of(4)..).unwrap_or_default();
    }
    let json = json.ok_or("it has no chunk of JSON")?;
    Ok(Parts { json: json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json), bin })
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..)?.first_chunk()?;
    Some(u32::from_le_bytes(*four))
}
