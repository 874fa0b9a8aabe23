//! The filters on the adapter beside their ports.

use dpsm::gpu::{Device, Evaluator, Resources, Texels, comparison_sampler, point_sampler};
use dpsm::render::Format;
use dpsm::scalar::bias::{DpsmReceiver, dpsm_receiver};
use dpsm::scalar::filter::*;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::kernel::*;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::lights::{dpsm_lights_four, dpsm_lights_visibility};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::pcss::dpsm_pcss;
use dpsm::scalar::plane::{dpsm_visibility_normal, dpsm_visibility_plane};
use dpsm::scalar::ports::{Flat, Word};
use dpsm::scalar::raw::*;

use crate::KINDS;
use crate::common::{device, rng, uniform, unit};
use crate::support::{first, hard, light, narrow, narrow_taps};

/// Records of each function.
const RECORDS: usize = 20_000;

/// Taps of each filter.
const COUNT: u32 = 16;

/// A record's words.
fn words(write: impl FnOnce(&mut Vec<Word<f32>>)) -> Vec<u32> {
    let mut words = Vec::new();
    write(&mut words);
    let bits = |word| match word {
        Word::Float(value) => f32::to_bits(value),
        Word::Integer(value) => value,
    };
    words.into_iter().map(bits).collect()
}

/// Evaluates a function and compares it with its port: the mean and the largest difference.
fn compare(
    device: &Device,
    function: &str,
    resources: Resources<'_>,
    records: Vec<Vec<u32>>,
    port: impl Fn(usize) -> Vec<f32>,
) -> (f32, f32) {
    let count = records.len();
    let evaluator = Evaluator::new(device, function).unwrap();
    let records: Vec<u32> = records.into_iter().flatten().collect();
    let answers = evaluator.run(&records, Some(resources)).unwrap().words;
    let (mut sum, mut most) = (0.0, 0.0_f32);
    let width = answers.len() / count;
    for (i, answer) in answers.chunks(width).enumerate() {
        let port = port(i);
        assert_eq!(port.len(), width);
        for (answer, port) in answer.iter().zip(port) {
            let off = (f32::from_bits(*answer) - port).abs();
            sum += off;
            most = most.max(off);
        }
    }
    let mean = sum / (count * width) as f32;
    println!("{function:<24} {mean:.2e} on average, {most:.2e} at most");
    (mean, most)
}

#[test]
fn filters_agree_with_their_ports_on_the_adapter() {
    let Some(device) = device() else { return };
    let texels = Texels::new(&device).unwrap();
    // lavapipe computes as the ports do, so hard taps read the same texels' centres
    let exact = device.info.name.contains("llvmpipe");
    for (kind, sampling) in KINDS {
        let mut rng = rng("adapter");
        let light = DpsmLight { first_layer: 0, ..narrow(light(64)) };
        let mut maps = DepthMaps::empty(64, 2, sampling);
        maps.depths.fill_with(|| rng.f32());
        let texture = texels.upload(&device, &maps, Format::D32).unwrap();
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let sampler = comparison_sampler(&device, sampling, false).unwrap();
        let point = point_sampler(&device).unwrap();
        let resources = Resources { texture: &view, sampler: &sampler, point: &point };
        let taps = DpsmTaps { kind, ..narrow_taps(hard(COUNT)) };
        let given: Vec<(Vec3<f32>, DpsmReceiver<f32>, f32)> = (0..RECORDS)
            .map(|_| {
                let p = unit(&mut rng) * uniform(&mut rng, 0.5, 19.0);
                (p, dpsm_receiver(p, unit(&mut rng), 0.0), uniform(&mut rng, 0.0, 0.3))
            })
            .collect();
        // a 2 x 2 comparison's weights have at least 8 bits on every adapter: 1/256 each way
        let check = |(mean, most): (f32, f32)| match (kind, exact) {
            (DPSM_TAP_HARD, true) => assert_eq!(most, 0.0),
            (DPSM_TAP_HARD, false) => assert!(mean <= 1e-4, "{mean}"),
            _ => assert!(mean <= 2.0 / 256.0, "{mean}"),
        };
        type Write<'a> = &'a dyn Fn(usize, &mut Vec<Word<f32>>);
        let records =
            |write: Write<'_>| (0..RECORDS).map(|i| words(|to| write(i, to))).collect::<Vec<_>>();
        let first: Vec2<f32> = first();
        let of_kernel = records(&|i, to| {
            let (p, receiver, tangent) = given[i];
            (receiver, dpsm_kernel(p, tangent), light, taps, first).write(to);
        });
        check(compare(&device, "dpsm_filter_mirror", resources, of_kernel, |i| {
            let (p, receiver, tangent) = given[i];
            let kernel = dpsm_kernel(p, tangent);
            vec![dpsm_filter_mirror(&maps, receiver, kernel, light, taps, first)]
        }));
        let of_point = records(&|i, to| {
            let (p, receiver, tangent) = given[i];
            (p, tangent, receiver).write(to);
            (light, taps, first).write(to);
        });
        let of_disk = records(&|i, to| {
            let (p, receiver, tangent) = given[i];
            (p, receiver, tangent).write(to);
            (light, taps, first).write(to);
        });
        // these read the nearest texels whatever the sampler
        let nearest = |(mean, most): (f32, f32)| match exact {
            true => assert_eq!(most, 0.0),
            false => assert!(mean <= 1e-4, "{mean}"),
        };
        nearest(compare(&device, "dpsm_filter_disk", resources, of_disk, |i| {
            let (p, receiver, tangent) = given[i];
            vec![dpsm_filter_disk(&maps, p, receiver, tangent, light, taps, first)]
        }));
        let of_plane = records(&|i, to| {
            (given[i].0, given[i].1, light).write(to);
            (taps.quantum, taps.tolerance).write(to);
        });
        let [quantum, tolerance] = [taps.quantum, taps.tolerance];
        nearest(compare(&device, "dpsm_visibility_plane", resources, of_plane.clone(), |i| {
            let (p, receiver, _) = given[i];
            vec![dpsm_visibility_plane(&maps, p, receiver, light, quantum, tolerance)]
        }));
        if kind == DPSM_TAP_LINEAR {
            check(compare(&device, "dpsm_visibility_normal", resources, of_plane, |i| {
                let (p, receiver, _) = given[i];
                vec![dpsm_visibility_normal(&maps, p, receiver, light, quantum, tolerance)]
            }));
        }
        check(compare(&device, "dpsm_filter_reproject", resources, of_point, |i| {
            let (p, receiver, tangent) = given[i];
            vec![dpsm_filter_reproject(&maps, p, tangent, receiver, light, taps, first)]
        }));
        let of_one = records(&|i, to| (given[i].0, given[i].1, light, taps).write(to));
        check(compare(&device, "dpsm_filter_hardware", resources, of_one, |i| {
            vec![dpsm_filter_hardware(&maps, given[i].0, given[i].1, light, taps)]
        }));
        let of_soft = records(&|i, to| {
            (given[i].0, given[i].1, light, taps).write(to);
            (0.2_f32, 0.5_f32, first).write(to);
        });
        nearest(compare(&device, "dpsm_pcss", resources, of_soft, |i| {
            let (p, receiver, _) = given[i];
            vec![dpsm_pcss(&maps, p, receiver, light, taps, 0.2, 0.5, first)]
        }));
        let of_light = records(&|i, to| {
            (light.position + given[i].0, given[i].1.plane.xyz(), light, taps).write(to);
            (given[i].2, first).write(to);
        });
        nearest(compare(&device, "dpsm_lights_visibility", resources, of_light, |i| {
            let (p, receiver, radius) = given[i];
            let world = light.position + p;
            let normal = receiver.plane.xyz();
            vec![dpsm_lights_visibility(&maps, world, normal, light, taps, radius, first)]
        }));
        // the naive kernel's places lie anywhere in a texel, also on its borders
        let of_naive = records(&|i, to| (given[i].0, light, 4, 0.01_f32).write(to));
        let (mean, _) = compare(&device, "dpsm_filter_pcf", resources, of_naive, |i| {
            vec![dpsm_filter_pcf(&maps, given[i].0, light, 4, 0.01)]
        });
        assert!(mean <= 2.0 / 256.0, "{mean}");
    }
}

#[test]
fn loads_agree_with_their_ports_on_the_adapter() {
    let Some(device) = device() else { return };
    let mut rng = rng("loads");
    let light = DpsmLight { first_layer: 0, ..narrow(light(64)) };
    let mut maps = DepthMaps::empty(64, 2, Sampling::Nearest);
    maps.depths.fill_with(|| rng.f32());
    let texture = device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("raw depths"),
        size: wgpu::Extent3d { width: 64, height: 64, depth_or_array_layers: 2 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    device.queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(&maps.depths),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(64 * 4),
            rows_per_image: Some(64),
        },
        texture.size(),
    );
    let view = texture.create_view(&Default::default());
    let sampler = comparison_sampler(&device, Sampling::Nearest, false).unwrap();
    let point = point_sampler(&device).unwrap();
    let resources = Resources { texture: &view, sampler: &sampler, point: &point };
    let exact = device.info.name.contains("llvmpipe");
    for (kind, _) in KINDS {
        let taps = DpsmTaps { kind, ..narrow_taps(hard(COUNT)) };
        let given: Vec<(Vec3<f32>, DpsmReceiver<f32>)> = (0..RECORDS)
            .map(|_| {
                let p = unit(&mut rng) * uniform(&mut rng, 0.5, 19.0);
                (p, dpsm_receiver(p, unit(&mut rng), 0.0))
            })
            .collect();
        let first: Vec2<f32> = first();
        let disks = given.iter().map(|&(p, receiver)| {
            words(|to| {
                (p, receiver, 0.1_f32).write(to);
                (light, taps, first).write(to);
            })
        });
        let off = compare(&device, "dpsm_raw_disk", resources, disks.collect(), |i| {
            let (p, receiver) = given[i];
            vec![dpsm_raw_disk(&maps, p, receiver, 0.1, light, taps, first)]
        });
        assert!(if exact { off.1 <= 1e-6 } else { off.0 <= 1e-4 }, "{off:?}");
        let planes = given.iter().map(|&(p, receiver)| {
            words(|to| {
                (p, receiver, light).write(to);
                (taps.quantum, taps.tolerance).write(to);
            })
        });
        let off = compare(&device, "dpsm_raw_plane", resources, planes.collect(), |i| {
            let (p, receiver) = given[i];
            vec![dpsm_raw_plane(&maps, p, receiver, light, taps.quantum, taps.tolerance)]
        });
        assert!(if exact { off.1 <= 1e-6 } else { off.0 <= 1e-4 }, "{off:?}");
        let soft = given.iter().map(|&(p, receiver)| {
            words(|to| {
                (p, receiver, light, taps).write(to);
                (0.2_f32, 0.5_f32, first).write(to);
            })
        });
        let off = compare(&device, "dpsm_raw_pcss", resources, soft.collect(), |i| {
            let (p, receiver) = given[i];
            vec![dpsm_raw_pcss(&maps, p, receiver, light, taps, 0.2, 0.5, first)]
        });
        assert!(if exact { off.1 <= 1e-6 } else { off.0 <= 1e-4 }, "{off:?}");
    }
}

#[test]
fn four_lights_by_value_agree_with_their_port() {
    let Some(device) = device() else { return };
    let mut rng = rng("four");
    let mut maps = DepthMaps::empty(32, 8, Sampling::Nearest);
    maps.depths.fill_with(|| rng.f32());
    let texels = Texels::new(&device).unwrap();
    let texture = texels.upload(&device, &maps, Format::D32).unwrap();
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let sampler = comparison_sampler(&device, Sampling::Nearest, false).unwrap();
    let point = point_sampler(&device).unwrap();
    let resources = Resources { texture: &view, sampler: &sampler, point: &point };
    let of = |i: u32| DpsmLight { first_layer: 2 * i, ..narrow(light(32)) };
    let lights: [DpsmLight<f32>; 4] = std::array::from_fn(|i| of(i as u32));
    let taps = narrow_taps(hard(8));
    let given: Vec<(Vec3<f32>, Vec3<f32>)> =
        (0..RECORDS).map(|_| (unit(&mut rng) * 4.0, unit(&mut rng))).collect();
    let records = given.iter().map(|&(world, normal)| {
        words(|to| {
            (world, normal).write(to);
            lights.into_iter().for_each(|light| light.write(to));
            (3_u32, taps, 0.3_f32, first::<f32>()).write(to);
        })
    });
    let (_, most) = compare(&device, "dpsm_lights_four", resources, records.collect(), |i| {
        let (world, normal) = given[i];
        let all = dpsm_lights_four(&maps, world, normal, lights, 3, taps, 0.3, first());
        vec![all.x, all.y, all.z, all.w]
    });
    assert!(!device.info.name.contains("llvmpipe") || most == 0.0, "{most}");
}
