//! Good glTF files with wrong values in them: most changes of a byte only break their JSON.

use std::sync::LazyLock;

use serde_json::{Value, json};

/// Each behind the byte that says its kind: a masked mesh, lights and a camera; copies, morph
/// targets, a skin, quantised and sparse numbers; compressed views.
const GOOD: [&[u8]; 3] = [
    include_bytes!("../seeds/gltf/masked.glb"),
    include_bytes!("../seeds/gltf/moving.glb"),
    include_bytes!("../seeds/gltf/meshopt.glb"),
];

/// Bytes before the JSON of a binary file, and before the buffer behind the JSON.
const HEADERS: [usize; 2] = [20, 8];

/// What may stand anywhere: small numbers, types and component types, lengths at the edges of
/// integers, strings, and nothing.
static VALUES: LazyLock<Vec<Value>> = LazyLock::new(|| {
    let mut values: Vec<Value> = (0..16).map(Value::from).collect();
    let lengths = [24, 32, 36, 48, 64, 96, 128, 252, 1 << 20, 1 << 31, u32::MAX.into(), 1 << 32];
    values.extend((5120..5131).chain(lengths).map(|value: i64| Value::from(value)));
    let wrapping = [u64::MAX, 1 << 63, 1 << 62, 732_013_653_718_633_002];
    values.extend(wrapping.map(Value::from));
    values.extend([0.5, -0.5, 1e-45, 1e38, -1e38, 1e300].map(Value::from));
    let words =
        ["SCALAR", "VEC2", "VEC3", "VEC4", "MAT4", "MASK", "BLEND", "OPAQUE", "spot", "point"];
    values.extend(words.map(Value::from));
    let more =
        ["directional", "perspective", "", "a.glb", "data:;base64,AAAA", "ATTRIBUTES", "TRIANGLES"];
    values.extend(more.map(Value::from));
    values.extend([json!(null), json!([]), json!({}), json!([0]), json!([0, 0]), json!(-1)]);
    values
});

/// JSON pointers of all values of each good file.
static PLACES: LazyLock<[Vec<String>; 3]> =
    LazyLock::new(|| GOOD.map(|file| places(parts(file).0)));

fn places(json: Value) -> Vec<String> {
    let mut places = Vec::new();
    let mut todo = vec![(String::new(), json)];
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
}

/// A good file's JSON and buffer.
fn parts(file: &'static [u8]) -> (Value, &'static [u8]) {
    let file = &file[1..];
    let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    let (json, rest) = file[HEADERS[0]..].split_at(length);
    (serde_json::from_slice(json).unwrap(), &rest[HEADERS[1]..])
}

/// A binary file. The first byte says which file, the second how many changes follow, of a place in
/// the JSON, two bytes, and a value; then places in the buffer, two bytes each, and what stands there.
pub fn glb(input: &[u8]) -> Vec<u8> {
    let (&file, input) = input.split_first().unwrap_or((&0, &[]));
    let file = usize::from(file) % GOOD.len();
    let (mut json, buffer) = parts(GOOD[file]);
    let places = &PLACES[file];
    let mut buffer = buffer.to_vec();
    let (&count, input) = input.split_first().unwrap_or((&0, &[]));
    let (changes, patches) = input.split_at(input.len().min(3 * usize::from(count % 32)));
    for change in changes.chunks_exact(3) {
        let place = usize::from(u16::from_le_bytes([change[0], change[1]]));
        let place = &places[place % places.len()];
        if let Some(value) = json.pointer_mut(place).filter(|_| !place.is_empty()) {
            *value = VALUES[usize::from(change[2]) % VALUES.len()].clone();
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
