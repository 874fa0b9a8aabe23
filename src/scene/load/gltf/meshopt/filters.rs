//! Filters of attributes: unit vectors, quaternions and floats in fewer bits.

/// Undoes a filter on elements of a stride.
pub(super) fn apply(filter: &str, stride: usize, bytes: &mut [u8]) -> Result<(), String> {
    match (filter, stride) {
        ("NONE", _) => {}
        ("OCTAHEDRAL", 4) => {
            for element in bytes.as_chunks_mut().0 {
                let filtered = octahedral(element.map(|byte| byte as i8 as f32), 127.0);
                *element = filtered.map(|value| value as i8 as u8);
            }
        }
        ("OCTAHEDRAL", 8) => of_words(bytes, |words| octahedral(words.map(f32::from), 32767.0)),
        ("QUATERNION", 8) => of_words(bytes, quaternion),
        ("EXPONENTIAL", _) if stride.is_multiple_of(4) => {
            for number in bytes.as_chunks_mut().0 {
                *number = exponential(i32::from_le_bytes(*number)).to_le_bytes();
            }
        }
        // colours are never asked for
        _ => return Err(format!("its filter `{filter}` is not known for {stride} bytes")),
    }
    Ok(())
}

fn of_words(bytes: &mut [u8], filter: impl Fn([i16; 4]) -> [f32; 4]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let word = |i: usize| i16::from_le_bytes([element[2 * i], element[2 * i + 1]]);
        let filtered = filter(std::array::from_fn(word));
        for (i, value) in filtered.into_iter().enumerate() {
            element[2 * i..][..2].copy_from_slice(&(value as i16).to_le_bytes());
        }
    }
}

/// A point of the octahedron, whose third number is what stands for 1, as a unit vector; the fourth
/// stays.
fn octahedral([x, y, one, w]: [f32; 4], largest: f32) -> [f32; 4] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // the lower half is folded outward
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    let [x, y, z] = [x, y, z].map(|value| (value / length * largest).round());
    [x, y, z, w]
}

/// The three smaller components of a unit quaternion, times the root of 2, and which the largest is.
fn quaternion([x, y, z, last]: [i16; 4]) -> [f32; 4] {
    let one = f32::from(last | 3);
    let [x, y, z] = [x, y, z].map(|value| f32::from(value) / one * std::f32::consts::FRAC_1_SQRT_2);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let largest = usize::from(last.cast_unsigned() & 3);
    let mut out = [0.0; 4];
    for (i, value) in [w, x, y, z].into_iter().enumerate() {
        out[(largest + i) % 4] = (value * 32767.0).round();
    }
    out
}

/// An exponent in the top eight bits, a whole number in the others.
fn exponential(number: i32) -> f32 {
    let (exponent, mantissa) = (number >> 24, (number << 8) >> 8);
    (2.0_f64.powi(exponent) * f64::from(mantissa)) as f32
}
