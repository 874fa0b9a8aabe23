//! Random records over a function's domain, by its arguments' names.

use dpsm::reflect::{Component, Kind, Signature};
use dpsm::scalar::bias::dpsm_receiver;
use dpsm::scalar::classify::dpsm_classify_part;
use dpsm::scalar::filter::{DpsmTaps, dpsm_filter_reader};
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::kernel::dpsm_kernel;
use dpsm::scalar::ports::{Flat, Word};
use dpsm::scalar::triangle::dpsm_triangle;
use fastrand::Rng;

use super::common::{light, nearby, point, spread, uniform, unit};

/// One record over the function's domain, and now and then any finite bits at all.
pub fn record(signature: &Signature, rng: &mut Rng) -> Vec<Word<f32>> {
    let wild = rng.u8(0..8) == 0;
    let mut words = Vec::new();
    let [corner_a, corner_b, corner_c] = corners(rng);
    let disk_a = disk(rng);
    // the terms of a texel's centre and widths may be grouped so that guards beyond 2^126 overflow
    let centred =
        signature.arguments.iter().any(|(name, _)| name == "receiver" || name == "cosine");
    for (name, shape) in &signature.arguments {
        let components = shape.components(name);
        let integers = components.iter().all(|c| c.kind != Kind::Float);
        match (name.as_str(), components.len()) {
            ("face", 1) => words.push(Word::Integer(rng.u32(0..8))),
            ("level" | "most", 1) => words.push(Word::Integer(rng.u32(0..70))),
            ("index", 1) => words.push(Word::Integer(rng.u32(0..15_000))),
            // as many halvings as it has binary digits behind the first, evenly
            ("path", 1) => words.push(Word::Integer(1 + (rng.u32(0..4095) >> rng.u32(0..12)))),
            ("weights", 3) => words.extend([0; 3].map(|_| Word::Integer(rng.u32(0..9)))),
            ("pixel", 2) => words.extend([0; 2].map(|_| Word::Integer(rng.u32(..)))),
            ("count", 1) => words.push(Word::Integer(rng.u32(1..4096))),
            _ if integers => words.push(Word::Integer(rng.u32(0..2))),
            ("light", _) if centred => light(rng).write(&mut words),
            _ if wild => words.extend(components.iter().map(|component| any(component, rng))),
            ("light", _) => light(rng).write(&mut words),
            ("normal" | "to_light" | "to_eye", 3) => unit(rng).write(&mut words),
            ("guard" | "visibility" | "bias" | "tau" | "depth_tolerance", 1)
            | ("cosine" | "window" | "quantum" | "tolerance", 1) => {
                words.push(Word::Float(rng.f32()));
            }
            ("texels" | "chord_square", 1) => {
                spread(rng, -24, 8).abs().write(&mut words);
            }
            ("receiver", 5) => {
                let (p, normal) = (point(rng, -24, 24), unit(rng) * spread(rng, -24, 24));
                dpsm_receiver(p, normal).write(&mut words);
            }
            ("offset" | "direction" | "lean", 2) => disk(rng).write(&mut words),
            ("tap", 3) => (disk_a, rng.u32(0..2)).write(&mut words),
            ("kernel", 4) => {
                dpsm_kernel(unit(rng), spread(rng, -8, 1).abs()).write(&mut words);
            }
            ("taps", 4) => {
                (rng.u32(1..64), rng.u32(0..2), rng.f32(), rng.f32()).write(&mut words);
            }
            ("reader", 16) => {
                let taps = DpsmTaps {
                    count: 16,
                    kind: rng.u32(0..2),
                    quantum: 1e-5,
                    tolerance: 1e-3 * rng.f32(),
                };
                let receiver = dpsm_receiver(point(rng, -24, 24), unit(rng));
                dpsm_filter_reader(receiver, light(rng), taps).write(&mut words);
            }
            ("found", 3) => (rng.f32(), rng.u32(0..64), rng.u32(0..64)).write(&mut words),
            ("at", 6) => {
                let (layer, mapped) = (rng.u32(0..2), rng.u32(0..4) > 0);
                (disk_a, rng.f32(), layer, layer, mapped).write(&mut words);
            }
            ("normal_z", 1) => uniform(rng, -1.0, 1.0).write(&mut words),
            ("bow" | "bow_before" | "bow_after", 1) => spread(rng, -20, 0).abs().write(&mut words),
            ("a", 3) => corner_a.write(&mut words),
            ("b", 3) => corner_b.write(&mut words),
            ("c", 3) => corner_c.write(&mut words),
            ("triangle", 19) => {
                let light = light(rng);
                dpsm_triangle(corner_a, corner_b, corner_c, light, rng.f32()).write(&mut words);
            }
            ("part", 9) => {
                dpsm_classify_part(corner_a, corner_b, corner_c, rng.u32(1..4096))
                    .write(&mut words);
            }
            ("a", 2) => disk_a.write(&mut words),
            ("b" | "c", 2) => beside(disk_a, rng).write(&mut words),
            ("hull", 6) => {
                [disk_a, beside(disk_a, rng), beside(disk_a, rng)].write(&mut words);
            }
            ("before" | "after", 2) => {
                let (sine, cosine) = (std::f64::consts::TAU * rng.f64()).sin_cos();
                Vec2::new(cosine, sine).narrow().write(&mut words);
            }
            (_, 3) => point(rng, -24, 24).write(&mut words),
            (_, count) => {
                words.extend((0..count).map(|_| Word::Float(spread(rng, -24, 24))));
            }
        }
    }
    words
}

/// Any finite bits of the component's type.
fn any(component: &Component, rng: &mut Rng) -> Word<f32> {
    match component.kind {
        Kind::Float => Word::Float(any_float(rng)),
        _ => Word::Integer(rng.u32(..)),
    }
}

/// Any finite float, by its bits.
fn any_float(rng: &mut Rng) -> f32 {
    loop {
        let value = f32::from_bits(rng.u32(..));
        if value.is_finite() {
            return value;
        }
    }
}

/// Three vertices: anywhere, or near each other.
fn corners(rng: &mut Rng) -> [Vec3<f32>; 3] {
    match rng.bool() {
        true => [0; 3].map(|_| point(rng, -24, 24)),
        false => {
            let a = unit(rng) * spread(rng, -8, 8);
            [a, nearby(rng, a, -14, 1), nearby(rng, a, -14, 1)]
        }
    }
}

/// A point of the disk, beyond the rim too.
fn disk(rng: &mut Rng) -> Vec2<f32> {
    Vec2::new(uniform(rng, -1.2, 1.2), uniform(rng, -1.2, 1.2))
}

/// Another point of the disk, anywhere or near.
fn beside(a: Vec2<f32>, rng: &mut Rng) -> Vec2<f32> {
    match rng.bool() {
        true => disk(rng),
        false => a + Vec2::new(spread(rng, -14, -2), spread(rng, -14, -2)),
    }
}
