//! A good glTF file with wrong values in it: most changes of a byte only break its JSON.

use std::sync::LazyLock;

use serde_json::{Value, json};

/// A masked mesh, lights and a camera; behind the byte that says its kind.
const GOOD: &[u8] = include_bytes!("../seeds/scene/masked.glb");

/// Bytes before the JSON of a binary file, and before the buffer behind the JSON.
const HEADERS: [usize; 2] = [20, 8];

/// What may stand anywhere: small numbers, types and component types, lengths at the edges of
/// integers, strings, and nothing.
static VALUES: LazyLock<Vec<Value>> = LazyLock::new(|| {
    let mut values: Vec<Value> = (0..16).map(Value::from).collect();
    let lengths = [24, 32, 36, 48, 64, 96, 128, 252, 1 << 20, 1 << 31, u32::MAX.into(), 1 << 32];
    values.extend((5120..5127).chain(lengths).map(|value: i64| Value::from(value)));
    let wrapping = [u64::MAX, 1 << 63, 1 << 62, 732_013_653_718_633_002];
    values.extend(wrapping.map(Value::from));
    values.extend([0.5, -0.5, 1e-45, 1e38, -1e38, 1e300].map(Value::from));
    let words =
        ["SCALAR", "VEC2", "VEC3", "VEC4", "MAT4", "MASK", "BLEND", "OPAQUE", "spot", "point"];
    values.extend(words.map(Value::from));
    let more = ["directional", "perspective", "", "a.glb", "data:;base64,AAAA", "image/jpeg"];
    values.extend(more.map(Value::from));
    values.extend([json!(null), json!([]), json!({}), json!([0]), json!([0, 0]), json!(-1)]);
    values
});

/// JSON pointers of all values of the good file.
static PLACES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let mut places = Vec::new();
    let mut todo = vec![(String::new(), parts().0)];
    while let Some((place, value)) = todo.pop() {
        match &value {
            Value::Array(items) => {
                let items = items.iter().enumerate();
                todo.extend(items.map(|(i, item)| (format!("{place}/{i}"), item.clone())));
            }
            Value::Object(members) => {
                let members = members.iter();
                todo.extend(
                    members.map(|(name, member)| (format!("{place}/{name}"), member.clone())),
                );
            }
            _ => {}
        }
        places.push(place);
    }
    places
});

/// The good file's JSON and buffer.
fn parts() -> (Value, &'static [u8]) {
    let file = &GOOD[1..];
    let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    let (json, rest) = file[HEADERS[0]..].split_at(length);
    (serde_json::from_slice(json).unwrap(), &rest[HEADERS[1]..])
}

/// A binary file. The first byte says how many pairs follow, of a place in the JSON and a value; then
/// places in the buffer, two bytes each, and what stands there.
pub fn glb(input: &[u8]) -> Vec<u8> {
    let (mut json, buffer) = parts();
    let mut buffer = buffer.to_vec();
    let (&count, input) = input.split_first().unwrap_or((&0, &[]));
    let (pairs, patches) = input.split_at(input.len().min(2 * usize::from(count % 32)));
    for pair in pairs.chunks_exact(2) {
        let place = &PLACES[usize::from(pair[0]) % PLACES.len()];
        if let Some(value) = json.pointer_mut(place).filter(|_| !place.is_empty()) {
            *value = VALUES[usize::from(pair[1]) % VALUES.len()].clone();
        }
    }
    for patch in patches.chunks_exact(3) {
        let at = usize::from(u16::from_le_bytes([patch[0], patch[1]])) % buffer.len();
        buffer[at] = patch[2];
    }
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let number = |n: usize| (n as u32).to_le_bytes();
    let length = HEADERS[0] + json.len() + HEADERS[1] + buffer.len();
    let parts: [&[u8]; 9] = [
        b"glTF",
        &number(2),
        &number(length),
        &number(json.len()),
        b"JSON",
        &json,
        &number(buffer.len()),
        b"BIN\0",
        &buffer,
    ];
    parts.concat()
}
