//! The shadow test on the adapter, beside its port and beside the hardware's own cube maps.

use dpsm::gpu::{Evaluator, Resources, Texels, comparison_sampler, point_sampler};
use dpsm::render::Format;
use dpsm::scalar::cube::*;
use dpsm::scalar::float::Vec3;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::ports::{Flat, Word};

use crate::common::{CASES, EPS, device, rng, unit};

#[test]
fn adapter_agrees_with_the_port_and_a_texture_cube_samples_alike() {
    let Some(device) = device() else { return };
    let size = 64;
    let mut rng = rng("texture_cube");
    let mut maps = DepthMaps::empty(size, 6, Sampling::Nearest);
    maps.depths.fill_with(|| rng.f32());
    let texture = Texels::new(&device).unwrap().upload(&device, &maps, Format::D32).unwrap();
    let sampler = comparison_sampler(&device, Sampling::Nearest, false).unwrap();
    let point = point_sampler(&device).unwrap();
    let view = |dimension| {
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(dimension),
            ..Default::default()
        })
    };
    let light = DpsmLight { guard: 0.0, first_layer: 0, ..dpsm::cases::light(0) };
    let bias = 0.001_f32;
    let points: Vec<_> = (0..CASES).map(|_| unit(&mut rng) * (4.0 * rng.f32())).collect();
    let run = |evaluator: &Evaluator, words: &[Word<f32>], view: &wgpu::TextureView| {
        let bits = |word: &Word<f32>| match *word {
            Word::Float(value) => value.to_bits(),
            Word::Integer(value) => value,
        };
        let words: Vec<u32> = words.iter().map(bits).collect();
        let resources = Resources { texture: view, sampler: &sampler, point: &point };
        evaluator.run(&words, Some(resources)).unwrap().words
    };
    let mut words = Vec::new();
    points.iter().for_each(|&p| (p, light, bias).write(&mut words));
    let evaluator = Evaluator::new(&device, "dpsm_cube_visibility").unwrap();
    let ours = run(&evaluator, &words, &view(wgpu::TextureViewDimension::D2Array));
    let text = "fn whole(maps: texture_depth_cube, s: sampler_comparison, p: vec3<f32>, d: f32)
        -> f32 { return textureSampleCompareLevel(maps, s, p, d); }";
    let linked = dpsm::link_source("whole.wgsl", text).unwrap();
    let mut words = Vec::new();
    let own = |&p: &Vec3<f32>| dpsm_cube_receiver_depth(p, dpsm_cube_face(p), light, bias);
    points.iter().for_each(|p| (*p, own(p)).write(&mut words));
    let evaluator = Evaluator::of(&device, &linked, "whole").unwrap();
    let whole = run(&evaluator, &words, &view(wgpu::TextureViewDimension::Cube));
    let [mut compared, mut lit] = [0, 0];
    for ((&p, &ours), &whole) in points.iter().zip(&ours).zip(&whole) {
        let at = dpsm_cube_lookup(p, light);
        // WebGPU leaves the precision of coordinates to the device; 1/256 texel is D3D's least
        let clear = [at.coordinates.x, at.coordinates.y].iter().all(|c| {
            let texels = f64::from(*c) * f64::from(size);
            (texels - texels.round()).abs() > 1.0 / 256.0
        });
        let texel = at.coordinates * size as f32;
        let stored = maps.depths[maps.index(texel.x as i64, texel.y as i64, at.layer)];
        // own depth: the bias moves a point by 0.01, a tenth of near, so near z / z'^2 <= 1.1 and
        // (10.5 + 13 * 1.1) far / (far - near) < 26
        let sure = (own(&p) - stored).abs() > 26.0 * EPS as f32;
        if clear && sure {
            compared += 1;
            lit += usize::from(f32::from_bits(ours) == 1.0);
            assert_eq!(f32::from_bits(ours), dpsm_cube_visibility(&maps, p, light, bias), "{p:?}");
            assert_eq!(ours, whole, "{p:?}");
        }
    }
    println!("{compared} of {CASES} compared, {lit} lit");
    assert!(compared > CASES * 9 / 10 && lit > CASES / 50 && lit < compared * 49 / 50);
}
