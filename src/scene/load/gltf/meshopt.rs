//! Views compressed with EXT_meshopt_compression or KHR_meshopt_compression, by the bit streams that
//! those extensions' specifications define in their appendices A and B. No kept crate decodes them
//! without a C++ compiler.

mod attributes;
mod filters;
mod indices;

use serde::Deserialize;

/// The extension's object: which bytes are compressed, and what they become.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Packed {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    byte_stride: usize,
    count: usize,
    mode: String,
    filter: Option<String>,
}

/// Elements that a byte of a stream may stand for at most: a group of 16 elements without change
/// takes two bits. A stream of triangles has a byte for each.
const MOST_PER_BYTE: usize = 64;

/// The bytes of all elements.
pub(super) fn unpack(packed: &Packed, stream: &[u8]) -> Result<Vec<u8>, String> {
    let Packed { byte_stride: stride, count, mode, filter, .. } = packed;
    if *count > stream.len().saturating_mul(MOST_PER_BYTE) {
        return Err("its compressed bytes are too few".into());
    }
    let wide = |indices: Vec<u32>| match stride {
        2 => Ok(indices.into_iter().flat_map(|index| (index as u16).to_le_bytes()).collect()),
        4 => Ok(indices.into_iter().flat_map(u32::to_le_bytes).collect()),
        _ => Err(format!("its indices have {stride} bytes")),
    };
    let found = match mode.as_str() {
        "ATTRIBUTES" if stride.is_multiple_of(4) && (4..=256).contains(stride) => {
            attributes::unpack(stream, *count, *stride)
        }
        "ATTRIBUTES" => return Err(format!("its elements have {stride} bytes")),
        "TRIANGLES" => indices::triangles(stream, *count).map(wide).transpose()?,
        "INDICES" => indices::sequence(stream, *count).map(wide).transpose()?,
        _ => return Err(format!("its mode `{mode}` is not known")),
    };
    let mut bytes = found.ok_or("its compressed bytes are broken")?;
    filters::apply(filter.as_deref().unwrap_or("NONE"), *stride, &mut bytes)?;
    Ok(bytes)
}

/// A stream's bytes, one after the other.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn byte(&mut self) -> Option<u8> {
        self.take(1).map(|byte| byte[0])
    }

    /// A number of seven bits a byte, the last of which has its top bit clear.
    fn number(&mut self) -> Option<u32> {
        let mut number = 0;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= u32::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(number);
            }
        }
        None
    }
}

/// A signed difference from a code whose lowest bit is the sign, in arithmetic that wraps.
fn zigzag(code: u32) -> u32 {
    if code & 1 == 1 { !(code >> 1) } else { code >> 1 }
}
