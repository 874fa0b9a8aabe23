//! Mode 0, attributes: differences from element to element, byte by byte, in groups of 16.

use super::{Bytes, zigzag};

const GROUP: usize = 16;
const MOST_BLOCK_BYTES: usize = 8192;
const MOST_BLOCK_ELEMENTS: usize = 256;
const VERSION_0: u8 = 0xa0;
const VERSION_1: u8 = 0xa1;

/// How the differences of one byte of all elements of a block are stored.
#[derive(Clone, Copy)]
enum Control {
    /// Bits of a difference by the two bits of its group's header.
    Groups([u32; 4]),
    Zeros,
    Literal,
}

/// Version 0 has the first of these and no control header.
const CONTROLS_0: Control = Control::Groups([0, 2, 4, 8]);
const CONTROLS_1: [Control; 4] = [
    Control::Groups([0, 1, 2, 4]),
    Control::Groups([1, 2, 4, 8]),
    Control::Zeros,
    Control::Literal,
];

/// `None` for a stream that ends early or cannot be.
pub(super) fn unpack(stream: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let (version, rest) = stream.split_first()?;
    let channels = stride / 4;
    let has_controls = match *version {
        VERSION_0 => false,
        VERSION_1 => true,
        _ => return None,
    };
    // the tail is padded in front
    let tail = if has_controls { (stride + channels).max(24) } else { stride.max(32) };
    let (body, tail) = rest.split_at_checked(rest.len().checked_sub(tail)?)?;
    let used = if has_controls { stride + channels } else { stride };
    let (base, modes) = tail[tail.len() - used..].split_at(stride);
    let mode = |channel: usize| modes.get(channel).copied().unwrap_or(0);

    let mut bytes = Bytes(body);
    let mut out = Vec::with_capacity(count * stride);
    let mut last = base.to_vec();
    let block = ((MOST_BLOCK_BYTES / stride) & !(GROUP - 1)).min(MOST_BLOCK_ELEMENTS);
    while out.len() < count * stride {
        let elements = block.min(count - out.len() / stride);
        let controls = if has_controls { bytes.take(channels)? } else { &[] };
        let control = |byte: usize| match controls.get(byte / 4) {
            None => CONTROLS_0,
            Some(packed) => CONTROLS_1[usize::from(packed >> (2 * (byte % 4)) & 3)],
        };
        let columns = (0..stride).map(|byte| column(&mut bytes, elements, control(byte)));
        let columns: Vec<Vec<u8>> = columns.collect::<Option<_>>()?;
        for element in 0..elements {
            let (columns, values) = (columns.as_chunks::<4>().0, last.as_chunks_mut().0);
            for (channel, (columns, value)) in columns.iter().zip(values).enumerate() {
                let codes = columns.each_ref().map(|column| column[element]);
                step(value, codes, mode(channel))?;
            }
            out.extend(&last);
        }
    }
    bytes.0.is_empty().then_some(out)
}

/// The codes of one byte of each element of a block.
fn column(bytes: &mut Bytes, elements: usize, control: Control) -> Option<Vec<u8>> {
    let bits = match control {
        Control::Zeros => return Some(vec![0; elements]),
        Control::Literal => return bytes.take(elements).map(Into::into),
        Control::Groups(bits) => bits,
    };
    let groups = elements.div_ceil(GROUP);
    let header = bytes.take(groups.div_ceil(4))?;
    let mut codes = Vec::with_capacity(groups * GROUP);
    for group in 0..groups {
        let kind = header[group / 4] >> (2 * (group % 4)) & 3;
        codes.extend(self::group(bytes, bits[usize::from(kind)])?);
    }
    codes.truncate(elements);
    Some(codes)
}

/// Sixteen codes of so many bits; one with all bits set is a byte behind the others.
fn group(bytes: &mut Bytes, bits: u32) -> Option<[u8; GROUP]> {
    match bits {
        0 => return Some([0; GROUP]),
        8 => return bytes.take(GROUP)?.try_into().ok(),
        _ => {}
    }
    let packed = bytes.take(GROUP * bits as usize / 8)?;
    let sentinel = (1 << bits) - 1;
    let per_byte = 8 / bits;
    let mut codes = [0; GROUP];
    for (i, code) in codes.iter_mut().enumerate() {
        let (byte, place) = (i / per_byte as usize, i as u32 % per_byte);
        // from the top bits down, but for single bits
        let shift = if bits == 1 { place } else { 8 - bits * (place + 1) };
        let small = packed[byte] >> shift & sentinel;
        *code = if small == sentinel { bytes.byte()? } else { small };
    }
    Some(codes)
}

/// The next value of four bytes.
fn step(value: &mut [u8; 4], codes: [u8; 4], mode: u8) -> Option<()> {
    match (mode & 0xf, mode >> 4) {
        (0, 0) => {
            for (byte, code) in value.iter_mut().zip(codes) {
                *byte = byte.wrapping_add(zigzag(code.into()) as u8);
            }
        }
        (1, 0) => {
            for (pair, code) in value.as_chunks_mut().0.iter_mut().zip(codes.as_chunks().0) {
                let by = zigzag(u16::from_le_bytes(*code).into()) as u16;
                *pair = u16::from_le_bytes(*pair).wrapping_add(by).to_le_bytes();
            }
        }
        (2, rotation) => {
            let by = u32::from_le_bytes(codes).rotate_right(rotation.into());
            *value = (u32::from_le_bytes(*value) ^ by).to_le_bytes();
        }
        _ => return None,
    }
    Some(())
}
