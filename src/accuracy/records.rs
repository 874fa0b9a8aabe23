//! Random records over a function's domain, by its arguments' names.

use crate::reflect::{Kind, Shape, Signature};
use crate::scalar::bias::{DPSM_RECEIVER_ROUNDING, dpsm_receiver};
use crate::scalar::classify::dpsm_projected;
use crate::scalar::filter::{DpsmTaps, dpsm_filter_cone, dpsm_filter_reader};
use crate::scalar::float::{Vec2, Vec3};
use crate::scalar::kernel::dpsm_kernel;
use crate::scalar::part::dpsm_part;
use crate::scalar::plane::{DpsmPlane, dpsm_plane};
use crate::scalar::ports::{Flat, Word};
use crate::scalar::triangle::{dpsm_triangle, dpsm_triangle_face};
use fastrand::Rng;

use super::random::{light, nearby, point, spread, uniform, unit};

/// Makes a function's records.
#[derive(Clone, Debug)]
pub struct Records {
    /// The arguments' names and components.
    arguments: Vec<(String, Vec<Kind>)>,
    /// The terms of a texel's centre and widths may be grouped so that guards beyond 2^126 overflow.
    centred: bool,
    /// Its index counts taps.
    counted: bool,
    /// It has to do with triangles or edges.
    cornered: bool,
}

impl Records {
    /// Records of a function.
    pub fn of(signature: &Signature) -> Self {
        let kinds = |(name, shape): &(String, Shape)| {
            (name.clone(), shape.components(name).iter().map(|c| c.kind).collect())
        };
        let named = |name: &str| name == "receiver" || name == "cosine";
        Self {
            arguments: signature.arguments.iter().map(kinds).collect(),
            centred: signature.arguments.iter().any(|(name, _)| named(name)),
            counted: signature.arguments.iter().any(|(name, _)| name == "count"),
            cornered: signature.arguments.iter().any(|(name, _)| {
                ["a", "b", "triangle", "part", "first", "start"].contains(&name.as_str())
            }),
        }
    }

    /// One record as the function is used, or where `wild` mostly any finite bits at all.
    pub fn record(&self, wild: bool, rng: &mut Rng) -> Vec<Word<f32>> {
        let mut words = Vec::with_capacity(64);
        let [corner_a, corner_b, corner_c] = match self.cornered {
            true => corners(rng),
            false => [Vec3::new(0.0, 0.0, 0.0); 3],
        };
        let disk_a = disk(rng);
        let near = spread(rng, -10, 4).abs();
        let map = [512.0, 1.0, 3.0, 16384.0][rng.usize(..4)];
        for (name, kinds) in &self.arguments {
            let integers = kinds.iter().all(|kind| *kind != Kind::Float);
            match (name.as_str(), kinds.len()) {
                ("face", 1) => words.push(Word::Integer(rng.u32(0..8))),
                ("level" | "most", 1) => words.push(Word::Integer(rng.u32(0..70))),
                ("index", 1) if self.counted => words.push(Word::Integer(rng.u32(0..1024))),
                ("index", 1) => words.push(Word::Integer(rng.u32(0..15_000))),
                // as many halvings as it has binary digits behind the first, evenly
                // one of a triangle's edges' seven sets, a part's number, a corner's
                ("split" | "halves", 1) => words.push(Word::Integer(rng.u32(1..8))),
                ("part", 1) => words.push(Word::Integer(rng.u32(0..4))),
                ("a" | "b" | "corner", 1) => words.push(Word::Integer(rng.u32(0..6))),
                ("path", 1) => words.push(Word::Integer(1 + (rng.u32(0..4095) >> rng.u32(0..12)))),
                ("weights", 3) if integers => {
                    words.extend([0; 3].map(|_| Word::Integer(rng.u32(0..9))))
                }
                ("pixel", 2) => words.extend([0; 2].map(|_| Word::Integer(rng.u32(..)))),
                ("count", 1) => words.push(Word::Integer(rng.u32(1024..1 << 20))),
                _ if integers => words.push(Word::Integer(rng.u32(0..2))),
                ("light", _) if self.centred => light(rng).write(&mut words),
                _ if wild => words.extend(kinds.iter().map(|kind| any(*kind, rng))),
                ("light", _) => {
                    let mut light = light(rng);
                    if rng.bool() {
                        light.near = near;
                        light.far = near * (1.0 + spread(rng, -10, 12).abs());
                        light.size = map;
                        light.first_layer = rng.u32(..) >> rng.u32(0..32);
                    }
                    light.write(&mut words);
                }
                ("normal" | "to_light" | "to_eye", 3) => unit(rng).write(&mut words),
                ("guard" | "visibility" | "bias" | "tau" | "depth_tolerance", 1)
                | ("cosine" | "inner" | "window" | "quantum" | "tolerance", 1) => {
                    words.push(Word::Float(rng.f32()));
                }
                ("outer", 1) => words.push(Word::Float(-rng.f32())),
                ("texels" | "chord_square", 1) => {
                    spread(rng, -24, 1).abs().write(&mut words);
                }
                ("error", 1) => error(rng).write(&mut words),
                ("rounding", 1) => {
                    (DPSM_RECEIVER_ROUNDING as f32 + rng.f32() * rng.f32()).write(&mut words)
                }
                ("near", 1) => near.write(&mut words),
                ("far", 1) => (near * (1.0 + spread(rng, -10, 12).abs())).write(&mut words),
                ("size", 1) => match rng.bool() {
                    true => map.write(&mut words),
                    false => spread(rng, 2, 24).abs().write(&mut words),
                },
                ("side", 1) => spread(rng, 0, 2).abs().write(&mut words),
                ("texel", 1) => ((1.0 + rng.f32()) * 2.0 / map).write(&mut words),
                ("middle", 2) => Vec2::splat(0.5 * map).write(&mut words),
                ("position", 2) => Vec2::new(map * rng.f32(), map * rng.f32()).write(&mut words),
                ("st", 2) => Vec2::new(rng.f32(), rng.f32()).write(&mut words),
                ("depth", 1) => rng.f32().write(&mut words),
                ("depths", 4) => [0; 4].map(|_| rng.f32()).write(&mut words),
                // seldom below 0: nothing is promised there
                // of a cube's slack, near is the light's
                ("z", 1) => spread(rng, 0, 12).abs().write(&mut words),
                ("l" | "limit" | "rise" | "height" | "pitch" | "farthest" | "range", 1)
                | ("distance" | "blocker" | "radius" | "tangent" | "longest_edge", 1) => {
                    spread(rng, -24, 10).abs().write(&mut words);
                }
                ("uv", 2) if rng.u8(0..4) > 0 => disk_a.write(&mut words),
                ("plane", 4) => {
                    (unit(rng), spread(rng, -24, 24).abs()).write(&mut words);
                }
                ("chord", 2) => (disk_a * 0.5).write(&mut words),
                ("direction", 3) => (unit(rng) * uniform(rng, 1.0, 1.75)).write(&mut words),
                ("ambient" | "diffuse" | "specular" | "full", 3) => {
                    Vec3::new(rng.f32(), rng.f32(), rng.f32()).write(&mut words);
                }
                ("receiver", 6) => {
                    let (p, normal) = (point(rng, -24, 24), unit(rng) * spread(rng, -24, 24));
                    dpsm_receiver(p, normal, error(rng)).write(&mut words);
                }
                ("offset", 2) => (disk(rng) * 0.6).write(&mut words),
                ("direction" | "lean", 2) => disk(rng).write(&mut words),
                ("tap", 3) => (disk_a, rng.u32(0..2)).write(&mut words),
                ("kernel", 4) => {
                    dpsm_kernel(unit(rng) * 0.999, spread(rng, -8, 1).abs()).write(&mut words);
                }
                ("taps", 4) => {
                    (rng.u32(1..64), rng.u32(0..2), rng.f32(), rng.f32()).write(&mut words);
                }
                ("reader", 17) => {
                    let taps = DpsmTaps {
                        count: 16,
                        kind: rng.u32(0..2),
                        quantum: 1e-5,
                        tolerance: 1e-3 * rng.f32(),
                    };
                    let receiver = dpsm_receiver(point(rng, -24, 24), unit(rng), error(rng));
                    dpsm_filter_reader(receiver, light(rng), taps).write(&mut words);
                }
                ("found", 8) => {
                    let each = |rng: &mut Rng| if rng.bool() { rng.f32() } else { -1.0 };
                    let farthest = [0; 4].map(|_| each(rng));
                    (farthest, [0; 4].map(|_| rng.bool())).write(&mut words);
                }
                ("found", 5) => {
                    let sum = [0; 4].map(|_| (rng.u32(0..4) * 1024 + rng.u32(0..4)) as f32);
                    (sum, rng.f32()).write(&mut words);
                }
                ("at", 11) => plane(rng).write(&mut words),
                ("disk", 14) => {
                    let rotation = unit(rng).xy();
                    let rotation = rotation / rotation.length().max(0.5);
                    dpsm_filter_cone(plane(rng), spread(rng, -12, 0).abs(), rng.f32(), rotation)
                        .write(&mut words);
                }
                ("four", 4) => {
                    [map * rng.f32(), map * rng.f32()].map(f32::floor).write(&mut words);
                    [rng.f32(), rng.f32()].write(&mut words);
                }
                ("sum", 4) => {
                    [0; 4].map(|_| (rng.u32(0..4) * 1024 + rng.u32(0..4)) as f32).write(&mut words);
                }
                ("stored" | "reach" | "own", 4) => {
                    [0; 4].map(|_| rng.f32()).write(&mut words);
                }
                ("ring" | "share" | "other", 1) => rng.f32().write(&mut words),
                ("shift", 1) => uniform(rng, 0.0, 1.5).write(&mut words),
                ("light_tangent", 1) => spread(rng, -12, 4).abs().write(&mut words),
                ("rotation", 2) => {
                    let turn = unit(rng).xy();
                    (turn / turn.length().max(0.5)).write(&mut words);
                }
                ("normal_z", 1) => uniform(rng, -1.0, 1.0).write(&mut words),
                ("bow" | "bow_before" | "bow_after", 1) => {
                    spread(rng, -20, 0).abs().write(&mut words)
                }
                ("reach", 1) => spread(rng, -20, -4).abs().write(&mut words),
                ("face", 4) => {
                    let farthest = spread(rng, -24, 24).abs();
                    let height = farthest * spread(rng, -20, 0).abs().min(1.0);
                    dpsm_triangle_face(unit(rng).extend(height), farthest).write(&mut words);
                }
                ("first" | "start", 6) => dpsm_projected(corner_a).write(&mut words),
                ("second" | "end", 6) => dpsm_projected(corner_b).write(&mut words),
                ("third", 6) => dpsm_projected(corner_c).write(&mut words),
                ("a", 3) => corner_a.write(&mut words),
                ("b", 3) => corner_b.write(&mut words),
                ("weights", 3) => {
                    let [s, t] = [rng.f32(), rng.f32()];
                    let [s, t] = if s + t > 1.0 { [1.0 - s, 1.0 - t] } else { [s, t] };
                    Vec3::new((1.0 - s) - t, s, t).write(&mut words);
                }
                ("a", 6) => (corner_a, unit(rng)).write(&mut words),
                ("b", 6) => (corner_b, unit(rng)).write(&mut words),
                ("c", 6) => (corner_c, unit(rng)).write(&mut words),
                ("c", 3) => corner_c.write(&mut words),
                ("triangle", 19) => {
                    let light = light(rng);
                    dpsm_triangle(corner_a, corner_b, corner_c, light).write(&mut words);
                }
                ("part", 9) => {
                    dpsm_part(corner_a, corner_b, corner_c, rng.u32(1..4096)).write(&mut words);
                }
                ("a", 2) => disk_a.write(&mut words),
                ("b" | "c", 2) => beside(disk_a, rng).write(&mut words),
                ("hull", 6) => {
                    let mut near =
                        || disk_a + Vec2::new(spread(rng, -14, -4), spread(rng, -14, -4));
                    [disk_a, near(), near()].write(&mut words);
                }
                ("distances", 3) => {
                    let p = point(rng, -24, 24);
                    Vec3::new(p.x.abs(), p.y.abs(), p.z.abs()).write(&mut words);
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
}

/// Of receivers at the world's origin, and anywhere.
fn error(rng: &mut Rng) -> f32 {
    if rng.bool() { 0.0 } else { spread(rng, -40, 4).abs() }
}

/// A receiver in its map.
fn plane(rng: &mut Rng) -> DpsmPlane<f32> {
    let p = point(rng, -24, 24);
    let receiver = dpsm_receiver(p, unit(rng), error(rng));
    dpsm_plane(p, receiver, rng.f32(), light(rng), 1e-5 * rng.f32(), 1e-3 * rng.f32())
}

/// Any finite bits of a component of that type.
fn any(kind: Kind, rng: &mut Rng) -> Word<f32> {
    match kind {
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
