//! Integers at their extremes: exact in the ports, and the same words from the adapter.

mod common;

use common::rng;
use dpsm::cases::light;
use dpsm::scalar::edge::dpsm_edge_unit;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::dpsm_hemisphere;
use dpsm::scalar::light::{DPSM_ATLAS, DPSM_LAYERS, DpsmLight, dpsm_light_layer};
use dpsm::scalar::part::{DpsmPart, dpsm_part, dpsm_part_half};
use dpsm::scalar::ports::{self, Flat, Word};

/// A record of these arguments.
fn record(arguments: impl Flat<f32>) -> Vec<Word<f32>> {
    let mut words = Vec::new();
    arguments.write(&mut words);
    words
}

fn bits(words: &[Word<f32>]) -> Vec<u32> {
    let bits = |word: &Word<f32>| match *word {
        Word::Float(value) => value.to_bits(),
        Word::Integer(value) => value,
    };
    words.iter().map(bits).collect()
}

/// What the port gives for each record; the adapter must give the same integers, and lavapipe the
/// same bits.
fn both(function: &str, records: &[Vec<Word<f32>>]) -> Vec<Vec<Word<f32>>> {
    let ports: Vec<_> =
        records.iter().map(|record| ports::call(function, record).unwrap()).collect();
    #[cfg(feature = "gpu")]
    if let Some(device) = common::device() {
        let evaluator = dpsm::gpu::Evaluator::new(&device, function).unwrap();
        let words: Vec<u32> = records.iter().flat_map(|record| bits(record)).collect();
        let answers = evaluator.run(&words, None).unwrap().words;
        let exact = device.info.name.contains("llvmpipe");
        for (index, (port, answer)) in ports.iter().zip(answers.chunks(ports[0].len())).enumerate()
        {
            for (port, &answer) in port.iter().zip(answer) {
                let same = match *port {
                    Word::Integer(port) => port == answer,
                    Word::Float(port) => !exact || port.to_bits() == answer,
                };
                assert!(same, "{function} {:?}: {port:?}, {answer:08x}", records[index]);
            }
        }
    }
    ports
}

fn integers(words: &[Word<f32>]) -> Vec<u32> {
    let integer = |word: &Word<f32>| match *word {
        Word::Integer(value) => Some(value),
        Word::Float(_) => None,
    };
    words.iter().filter_map(integer).collect()
}

#[test]
fn hemispheres_are_exact_down_to_the_smallest_float() {
    let heights: [(f32, u32); 8] = [
        (0.0, 0),
        (-0.0, 0),
        (f32::MIN_POSITIVE, 0),
        (-f32::MIN_POSITIVE, 1),
        (f32::MAX, 0),
        (f32::MIN, 1),
        (f32::INFINITY, 0),
        (f32::NEG_INFINITY, 1),
    ];
    let records: Vec<_> = heights.iter().map(|&(z, _)| record(Vec3::new(1.0, 2.0, z))).collect();
    for (result, (z, expected)) in both("dpsm_hemisphere", &records).iter().zip(heights) {
        assert_eq!(integers(result), [expected], "{z}");
    }
    // subnormals in the port alone: adapters may flush them
    assert_eq!(dpsm_hemisphere(Vec3::new(0.0, 0.0, -1e-45_f32)), 1);
}

#[test]
fn layers_are_exact_up_to_the_last() {
    let mut records = Vec::new();
    let mut expected = Vec::new();
    for first_layer in [0, 6, (1 << 24) + 1, (1 << 31) - 1, 1 << 31, u32::MAX - 1] {
        for (placement, beside) in [(DPSM_LAYERS, 1), (DPSM_ATLAS, 0)] {
            for hemisphere in [0, 1] {
                let light = DpsmLight { first_layer, ..light(placement) };
                records.push(record((light, hemisphere)));
                expected.push(first_layer + beside * hemisphere);
                assert_eq!(dpsm_light_layer(light.widen(), hemisphere), *expected.last().unwrap());
            }
        }
    }
    for (result, expected) in both("dpsm_light_layer", &records).iter().zip(&expected) {
        assert_eq!(integers(result), [*expected]);
    }
}

#[test]
fn texel_of_a_texels_centre_is_that_texel_at_every_size() {
    for size in [1_u32, 2, 3, 300, 511, 512, 4096, 16384] {
        let light = DpsmLight { size: size as f32, ..light(DPSM_LAYERS) };
        let guard = f64::from(light.guard);
        // along the map's diagonal: each index once in x and once in y
        let centre = |index: u32| {
            let along = (f64::from(index) + 0.5) / f64::from(size) - 0.5;
            (2.0 * along * (1.0 + guard)) as f32
        };
        let at = |index: u32| Vec2::new(centre(index), centre(size - 1 - index));
        let records: Vec<_> = (0..size).map(|index| record((at(index), light))).collect();
        let centres = both("dpsm_texel_centre", &records);
        let looked: Vec<_> =
            centres.iter().map(|result| [result.clone(), record(light.guard)].concat()).collect();
        let coordinates = both("dpsm_disk_to_texture", &looked);
        for (index, st) in (0..size).zip(coordinates) {
            for coordinate in bits(&st) {
                let texel = f64::from(f32::from_bits(coordinate)) * f64::from(size);
                assert_eq!(texel.floor(), f64::from(index), "{size}");
                // the sampler's own steps of 1/256 texel stay away from the borders
                assert!((texel - texel.floor() - 0.5).abs() < 0.25, "{size}: {texel}");
            }
        }
    }
}

#[test]
fn weights_of_a_triangle_are_exact_up_to_the_largest_level() {
    let mut rng = rng("weights");
    for level in [1_u32, 2, 3, 100, (1 << 15) - 1, 1 << 15] {
        let vertices = 3 * u64::from(level) * u64::from(level);
        let mut indices: Vec<u32> = (0..10_000).map(|_| rng.u64(0..vertices) as u32).collect();
        indices.extend((0..vertices.min(300)).map(|index| index as u32));
        indices.extend((0..vertices.min(300)).map(|index| (vertices - 1 - index) as u32));
        let records: Vec<_> = indices.iter().map(|&index| record((level, index))).collect();
        for (result, &index) in both("dpsm_tessellate_weights", &records).iter().zip(&indices) {
            // the row and the place in it of the sub-triangle's cell, mirrored in the upper half
            let cell = u64::from(index) / 3;
            let (row, place) = (cell / u64::from(level), cell % u64::from(level));
            let [right, up] = [[0, 0], [1, 0], [0, 1]][index as usize % 3];
            let (mut b, mut c) = (row + right, place + up);
            if row + place >= u64::from(level) {
                (b, c) = (u64::from(level) - b, u64::from(level) - c);
            }
            let expected = [u64::from(level) - b - c, b, c].map(|weight| weight as u32);
            assert_eq!(integers(result), expected, "level {level}, vertex {index}");
        }
        let beyond = record((level, vertices as u32));
        assert_eq!(integers(&both("dpsm_tessellate_weights", &[beyond])[0]), [level, 0, 0]);
    }
}

#[test]
fn level_is_at_most_the_largest_for_any_edge() {
    let record = record((1e9_f32, 1e-9_f32, light(DPSM_LAYERS), (1e-6_f32, 1_u32 << 15)));
    assert_eq!(integers(&both("dpsm_tessellate_level", &[record])[0]), [1 << 15]);
}

#[test]
fn every_bit_of_the_longest_path_chooses_a_half() {
    let corners: [Vec3<f32>; 3] =
        [Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.4, 0.0, 2.0), Vec3::new(0.0, 0.3, 2.5)];
    let mut paths = vec![1, 2, 3, 1 << 31, u32::MAX, 0xaaaa_aaaa, (1 << 31) + 1];
    paths.extend((1..32).map(|bit| (1 << 31) | (1 << (bit - 1))));
    let records: Vec<_> = paths.iter().map(|&path| record((corners, path))).collect();
    for (result, path) in both("dpsm_part", &records).iter().zip(&paths) {
        let [a, b, c] = corners.map(dpsm_edge_unit);
        let digits = format!("{path:b}");
        let part = digits
            .bytes()
            .skip(1)
            .fold(DpsmPart { a, b, c }, |part, digit| dpsm_part_half(part, digit == b'1'));
        assert_eq!(bits(result), bits(&record(part)), "{path:b}");
    }
    // a path's last bit tells its end from its neighbour's until rounding does not: 24 halvings
    let [near, beside] = [1 << 20, (1 << 20) + 1];
    assert_ne!(
        dpsm_part(corners[0], corners[1], corners[2], near),
        dpsm_part(corners[0], corners[1], corners[2], beside)
    );
}

#[test]
fn counts_are_exact_up_to_two_to_the_24() {
    let counts = [1_u32, 2, 16, (1 << 23) + 1, (1 << 24) - 1, 1 << 24];
    // rings of four, rounded up
    let records: Vec<_> = counts.iter().map(|&count| record((count,))).collect();
    for (result, count) in both("dpsm_kernel_rings", &records).iter().zip(counts) {
        assert_eq!(bits(result), [count.div_ceil(4)], "{count}");
    }
    // sums of up to 1020 taps in shadow, or lit, are told apart
    let sums = |dark: u32, lit: u32| [(1024 * dark + lit) as f32, 0.0, 0.0, 0.0];
    let shares = [(0, 1020, 1.0_f32), (1020, 0, 0.0), (510, 510, 0.5), (1, 0, 0.0), (0, 1, 1.0)];
    let records: Vec<_> = shares.iter().map(|&(dark, lit, _)| record((sums(dark, lit),))).collect();
    for (result, (_, _, share)) in both("dpsm_filter_share", &records).iter().zip(shares) {
        assert_eq!(bits(result), [share.to_bits()]);
    }
    // of each ring the first is below the last, which is at most 1
    let rings: Vec<_> =
        counts.iter().flat_map(|&n| [record((0_u32, n)), record((n - 1, n))]).collect();
    for pair in both("dpsm_kernel_ring", &rings).chunks(2) {
        let [first, last] = [&pair[0], &pair[1]].map(|word| f32::from_bits(bits(word)[0]));
        assert!(0.0 < first && first <= last && last <= 1.0, "{first} {last}");
    }
}
