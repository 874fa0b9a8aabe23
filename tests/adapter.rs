//! The adapter against the f32 ports: bit for bit where the driver is known to round to nearest
//! (lavapipe), and for the sampling functions through their own harness.

#![cfg(feature = "gpu")]

mod common;

use common::{device, rng, unit};
use dpsm::accuracy::bits;
use dpsm::gpu::{Evaluator, GpuError, Resources, Texels, comparison_sampler, point_sampler};
use dpsm::render::Format;
use dpsm::scalar::bias::*;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::light::{DPSM_LAYERS, DpsmLight};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::dpsm_project_own;
use dpsm::scalar::ports::{Flat, PORTS, Word};
use dpsm::scalar::visibility::*;
use fastrand::Rng;

/// Inputs of each function.
const INPUTS: usize = 1 << 20;

#[test]
fn ports_and_modules_declare_the_same_functions_in_the_same_order() {
    for module in dpsm::MODULES {
        let path = format!("{}/src/scalar/{}.rs", env!("CARGO_MANIFEST_DIR"), module.name);
        let port = std::fs::read_to_string(path).unwrap();
        let names = |text: &str, keyword: &str| -> Vec<String> {
            let lines = text.lines().filter_map(|line| line.strip_prefix(keyword));
            let end = |c: char| !(c.is_alphanumeric() || c == '_');
            lines.map(|line| line.split(end).next().unwrap_or_default().to_string()).collect()
        };
        for (wgsl, rust) in
            [("fn ", "pub fn "), ("const ", "pub const "), ("struct ", "pub struct ")]
        {
            assert_eq!(names(module.text, wgsl), names(&port, rust), "{}", module.name);
        }
        // those that take a texture
        let samples = |name: &str| {
            let start = module.text.find(&format!("fn {name}(")).unwrap();
            module.text[start..].split(") ->").next().unwrap().contains(": texture_")
        };
        let listed = PORTS.iter().filter(|(name, _)| *name == module.name);
        let listed: Vec<_> = listed.map(|(_, function)| *function).collect();
        let declared = names(module.text, "fn ");
        let plain = declared.iter().filter(|name| !samples(name));
        assert_eq!(plain.collect::<Vec<_>>(), listed, "{}", module.name);
    }
}

#[test]
fn evaluate_moves_typed_arrays_in_any_number_of_chunks() {
    let Some(mut device) = device() else { return };
    let mut rng = rng("chunks");
    let points: Vec<glam::Vec3> =
        (0..10_001).map(|_| unit(&mut rng)).map(|p| glam::Vec3::new(p.x, p.y, p.z)).collect();
    let whole: Vec<glam::Vec2> = device.evaluate("dpsm_project", &points).unwrap();
    device.chunk_bytes = 12 * 1000;
    let split: Vec<glam::Vec2> = device.evaluate("dpsm_project", &points).unwrap();
    assert_eq!(whole.len(), points.len());
    assert_eq!(whole, split);
    let words: Vec<u32> = bytemuck::cast_slice(&points).to_vec();
    let evaluator = Evaluator::new(&device, "dpsm_project").unwrap();
    assert_eq!(evaluator.run(&words, None).unwrap().chunks, 11);
    assert_eq!(device.evaluate::<glam::Vec3, glam::Vec2>("dpsm_project", &[]).unwrap(), []);
}

#[test]
fn wrong_records_and_unknown_functions_are_named() {
    let Some(device) = device() else { return };
    let error = device.evaluate::<f32, glam::Vec2>("dpsm_project", &[1.0]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`dpsm_project` takes 3 words a record (p.x: f32, p.y: f32, p.z: f32), not 4 bytes"
    );
    let error = device.evaluate::<glam::Vec3, f32>("dpsm_project", &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`dpsm_project` cannot be evaluated: a result has 8 bytes, not 4"
    );
    let error = device.evaluate::<f32, f32>("dpsm_projct", &[]).unwrap_err();
    let message = error.to_string();
    let wanted = "unknown function `dpsm_projct`; did you mean `dpsm_project`? There are ";
    assert!(message.starts_with(wanted), "{message}");
    let error = Evaluator::new(&device, "dpsm_visibility").unwrap().run(&[0; 28], None);
    assert_eq!(
        error.unwrap_err().to_string(),
        "`dpsm_visibility` cannot be evaluated: it takes a texture, and none was given"
    );
}

#[test]
fn values_far_apart_in_one_struct_keep_their_places() {
    let Some(device) = device() else { return };
    let text = "struct Inner { a: array<vec2<i32>, 2>, flag: u32 }
        struct Outer { m: mat2x3<f32>, inner: Inner, last: f32 }
        fn shuffle(o: Outer, yes: bool) -> Outer {
            var r = o;
            r.m[0] = o.m[1];
            r.m[1] = o.m[0];
            r.inner.a[0] = -o.inner.a[1];
            r.inner.flag = select(7u, o.inner.flag, yes);
            return r;
        }";
    let linked = dpsm::link_source("shuffle.wgsl", text).unwrap();
    let evaluator = Evaluator::of(&device, &linked, "shuffle").unwrap();
    let float = |x: f32| x.to_bits();
    let input: Vec<u32> =
        (1..=6).map(|i| float(i as f32)).chain([10, 20, 30, 40, 99, float(0.5), 0]).collect();
    let minus = |i: i32| (-i) as u32;
    let expected: Vec<u32> = [4, 5, 6, 1, 2, 3]
        .map(|i| float(i as f32))
        .into_iter()
        .chain([minus(30), minus(40), 30, 40, 7, float(0.5)])
        .collect();
    assert_eq!(evaluator.run(&input, None).unwrap().words, expected);
}

/// Maps of random depths, as the format stores them.
fn random_maps(rng: &mut Rng, size: u32, format: Format, sampling: Sampling) -> DepthMaps {
    let mut maps = DepthMaps::empty(size, 2, sampling);
    maps.depths.fill_with(|| format.store(rng.f32()));
    maps
}

#[test]
fn depths_survive_upload_and_download_in_each_format() {
    let Some(device) = device() else { return };
    let texels = Texels::new(&device).unwrap();
    let mut rng = rng("formats");
    for format in [Format::D16, Format::D24, Format::D32] {
        let maps = random_maps(&mut rng, 33, format, Sampling::Nearest);
        let texture = texels.upload(&device, &maps, format).unwrap();
        let view = array_view(&texture);
        let back = texels.download(&device, &view, &texture).unwrap();
        let steps = maps.depths.iter().zip(&back).map(|(a, b)| (a - b).abs());
        let most = steps.fold(0.0, f32::max);
        println!("{format:?}: {most:e} apart, quantum {:e}", format.quantum());
        // storage may give either neighbour, and a 24-bit unorm is itself rounded to f32
        let allowed = match format {
            Format::D16 => 1.0 / 65535.0,
            Format::D24 => 1.0 / 16777215.0 + f32::EPSILON,
            Format::D32 => 0.0,
        };
        assert!(most <= allowed, "{format:?}: {most:e}");
    }
}

fn array_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// Texel of a coordinate, unless it lies so close to a border that the adapter may take the next:
/// WebGPU leaves the precision of coordinates to the device; 1/256 texel is D3D's least.
fn clear_of_borders(st: Vec2<f32>, size: u32) -> bool {
    [st.x, st.y].iter().all(|c| {
        let at = f64::from(*c) * f64::from(size);
        (at - at.round()).abs() > 1.0 / 256.0
    })
}

#[test]
fn sampling_functions_agree_with_their_ports() {
    let Some(device) = device() else { return };
    let texels = Texels::new(&device).unwrap();
    let sampler = comparison_sampler(&device, Sampling::Nearest, false).unwrap();
    let point = point_sampler(&device).unwrap();
    let size = 64;
    for format in [Format::D16, Format::D24, Format::D32] {
        let mut rng = rng("sampling");
        let maps = random_maps(&mut rng, size, format, Sampling::Nearest);
        let texture = texels.upload(&device, &maps, format).unwrap();
        let view = array_view(&texture);
        let resources = Resources { texture: &view, sampler: &sampler, point: &point };
        let light = DpsmLight {
            near: 0.1,
            far: 4.0,
            size: size as f32,
            first_layer: 0,
            placement: DPSM_LAYERS,
            ..dpsm::cases::light(0)
        };
        let points: Vec<Vec3<f32>> =
            (0..INPUTS).map(|_| unit(&mut rng) * (4.0 * rng.f32())).collect();
        let by_pixel = |&p: &Vec3<f32>| {
            let mut words = Vec::new();
            (p, light, 0.001_f32).write(&mut words);
            words
        };
        let by_vertex = |&p: &Vec3<f32>| {
            let mut words = Vec::new();
            dpsm_receiver_vertex(p, light).write(&mut words);
            (light, 0.001_f32).write(&mut words);
            words
        };
        // where the function looks, and the depth that it compares
        type Looks<'a> = &'a dyn Fn(usize) -> DpsmLookup<f32>;
        let check = |function: &str,
                     records: Vec<Vec<Word<f32>>>,
                     looks: Looks<'_>,
                     port: &dyn Fn(usize) -> f32| {
            let words: Vec<u32> = records.iter().flatten().map(|&word| bits(word)).collect();
            let evaluator = Evaluator::new(&device, function).unwrap();
            let answers = evaluator.run(&words, Some(resources)).unwrap().words;
            let (mut compared, mut lit) = (0, 0);
            for (i, (&p, answer)) in points.iter().zip(&answers).enumerate() {
                let at = looks(i);
                let texel = at.coordinates * size as f32;
                let stored = maps.depths[maps.index(texel.x as i64, texel.y as i64, at.layer)];
                // a depth within one quantum of the stored one may compare either way
                let quantum = format.quantum().max(f32::EPSILON);
                let clear = (at.depth - stored).abs() > quantum;
                if clear_of_borders(at.coordinates, size) && clear {
                    compared += 1;
                    lit += usize::from(port(i) == 1.0);
                    assert_eq!(f32::from_bits(*answer), port(i), "{function} {format:?} {p:?}");
                }
            }
            println!("{function} {format:?}: {compared} of {INPUTS} compared, {lit} lit");
            assert!(compared > INPUTS * 9 / 10 && lit > INPUTS / 10 && lit < compared * 9 / 10);
        };
        let plain = |i: usize| {
            let at = dpsm_lookup(points[i], light);
            DpsmLookup { depth: at.depth - 0.001, ..at }
        };
        check("dpsm_visibility", points.iter().map(by_pixel).collect(), &plain, &|i| {
            dpsm_visibility(&maps, points[i], light, 0.001)
        });
        check("dpsm_visibility_vertex", points.iter().map(by_vertex).collect(), &plain, &|i| {
            dpsm_visibility_vertex(&maps, dpsm_receiver_vertex(points[i], light), light, 0.001)
        });
        let normals: Vec<Vec3<f32>> = (0..INPUTS).map(|_| unit(&mut rng)).collect();
        let receiver = |i: usize| dpsm_receiver(points[i], normals[i], 0.0);
        let (quantum, tolerance) = (format.quantum(), 1e-3_f32);
        let records = |rest: &dyn Fn(usize, &mut Vec<Word<f32>>)| -> Vec<Vec<Word<f32>>> {
            let record = |i: usize| {
                let mut words = Vec::new();
                points[i].write(&mut words);
                rest(i, &mut words);
                words
            };
            (0..INPUTS).map(record).collect()
        };
        check(
            "dpsm_visibility_texel_centre",
            records(&|i, words| (receiver(i), light, quantum, tolerance).write(words)),
            &|i| dpsm_lookup_texel_centre(points[i], receiver(i), light, quantum, tolerance),
            &|i| {
                let (p, receiver) = (points[i], receiver(i));
                dpsm_visibility_texel_centre(&maps, p, receiver, light, quantum, tolerance)
            },
        );
        let footprint = |i: usize| {
            let uv = dpsm_project_own(points[i]);
            dpsm_bias_footprint(receiver(i), uv, 0.5, light)
        };
        check(
            "dpsm_visibility_footprint",
            records(&|i, words| {
                (receiver(i), light, 0.5_f32).write(words);
                (quantum, tolerance).write(words);
            }),
            &|i| dpsm_lookup_biased(points[i], footprint(i), light, quantum, tolerance),
            &|i| {
                let (p, receiver) = (points[i], receiver(i));
                dpsm_visibility_footprint(&maps, p, receiver, light, 0.5, quantum, tolerance)
            },
        );
    }
}

#[test]
fn sizes_above_the_adapters_limits_are_refused_by_name() {
    let Some(device) = device() else { return };
    let limit = device.device.limits().max_texture_dimension_2d;
    let maps = DepthMaps {
        size: limit + 1,
        layers: 1,
        depths: vec![],
        sampling: Sampling::Nearest,
        reversed: false,
    };
    let error = Texels::new(&device).unwrap().upload(&device, &maps, Format::D32).unwrap_err();
    assert!(matches!(&error, GpuError::Limit { what: "--size", .. }), "{error}");
    assert_eq!(
        error.to_string(),
        format!(
            "--size {} is outside this adapter's range 1 to {limit}; choose one inside it",
            limit + 1
        )
    );
}
