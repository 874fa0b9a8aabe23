//! Adapters that have less: fewer features, lower limits.

use dpsm::gpu::{self, Device, GpuError, Texels};
use dpsm::render::{Format, Frame, Method, Passes, Rendering};
use dpsm::scalar::maps::{DepthMaps, Sampling};

use crate::lost::frame;
use crate::support::adapter;

/// The adapter that the tests use, to open again with less.
fn wgpu_adapter(device: &Device) -> wgpu::Adapter {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::PRIMARY;
    let instance = wgpu::Instance::new(descriptor);
    let all = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    all.into_iter().find(|adapter| adapter.get_info().name == device.info.name).unwrap()
}

/// What is the same however it is computed.
fn picture(rendering: &Rendering) -> (Vec<[u8; 4]>, Option<DepthMaps>) {
    (rendering.lit.pixels.clone(), rendering.maps.clone())
}

/// Pixels and texels that differ by more than a tenth, and than the tolerance that the maps have.
fn differing(
    a: &(Vec<[u8; 4]>, Option<DepthMaps>),
    b: &(Vec<[u8; 4]>, Option<DepthMaps>),
) -> usize {
    let far = |(a, b): &(&[u8; 4], &[u8; 4])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 24);
    let pixels = a.0.iter().zip(&b.0).filter(far).count();
    let (Some(a), Some(b)) = (&a.1, &b.1) else { return pixels };
    let side = a.size as usize;
    let apart = |&index: &usize| {
        // beyond the stored disk there is whatever there is
        let at = |place: usize| (place % side) as f64 + 0.5 - side as f64 / 2.0;
        let is_read = at(index).hypot(at(index / side)) < 0.45 * side as f64;
        is_read && (a.depths[index] - b.depths[index]).abs() > 0.05
    };
    pixels + (0..a.depths.len()).filter(apart).count()
}

#[test]
fn adapter_without_features_renders_the_same_and_times_by_the_clock() {
    let Some((device, _alone)) = adapter() else { return };
    let adapter = wgpu_adapter(&device);
    let none = wgpu::Features::empty();
    let plain = Device::with_features(&adapter, none, adapter.limits()).unwrap();
    assert_eq!(plain.device.features() & Device::FEATURES, none);
    let [with, without] =
        [&device, &plain].map(|device| gpu::render(device, &frame(Method::Refined)).unwrap());
    assert_eq!(picture(&with), picture(&without));
    assert!(without.timings.iter().all(|(_, time)| !time.is_zero()), "{:?}", without.timings);
    let mut frame = frame(Method::Vertex);
    frame.settings.passes = Passes::Multiview;
    let refused = gpu::make_maps(&plain, &frame).unwrap_err();
    assert!(matches!(refused, GpuError::Multiview { .. }), "{refused}");
    assert!(refused.to_string().contains("--passes atlas"), "{refused}");
}

/// One limit lowered.
type Lower = fn(&mut wgpu::Limits, u32);

const BYTES: [(&str, Lower); 2] = [
    ("max_buffer_size", |limits, value| limits.max_buffer_size = value.into()),
    ("max_storage_buffer_binding_size", |limits, value| {
        limits.max_storage_buffer_binding_size = value.into();
    }),
];

/// Renders with a limit lowered to powers of two: the same picture, or an error that says which size
/// is above it. The names of those sizes.
fn lowered(name: &str, lower: Lower, powers: std::ops::Range<u32>, frame: &Frame) -> Vec<String> {
    let Some((device, _alone)) = adapter() else { return Vec::new() };
    let whole = picture(&gpu::render(&device, frame).unwrap());
    let adapter = wgpu_adapter(&device);
    let method = frame.settings.method;
    let mut refused = Vec::new();
    for power in powers.step_by(2) {
        let mut limits = adapter.limits();
        lower(&mut limits, 1 << power);
        let device = Device::with_limits(&adapter, limits).unwrap();
        match gpu::render(&device, frame) {
            Ok(rendering) => {
                let off = differing(&picture(&rendering), &whole);
                println!("{name} 2^{power}: {off} texels differ");
                // without room for refined triangles maps are drawn exactly, within the tolerance
                assert!(
                    off == 0 || method == Method::Refined && off < 40,
                    "{name} 2^{power}: {off}"
                );
            }
            Err(error @ GpuError::Limit { .. }) => refused.push(error.to_string()),
            Err(other) => panic!("{name} 2^{power}: {other}"),
        }
    }
    println!("{name}:\n  {}", refused.join("\n  "));
    refused
}

#[test]
fn sizes_above_a_lowered_limit_on_bytes_are_named_or_split() {
    for ((name, lower), method) in BYTES.into_iter().zip([Method::Refined, Method::Cube]) {
        let refused = lowered(name, lower, 8..20, &frame(method));
        if adapter().is_some() {
            assert!(!refused.is_empty(), "{name}");
        }
        for message in refused {
            assert!(message.contains("bytes") && message.contains("use a smaller"), "{message}");
            // lists are made for as many triangles at once as fit
            let of_list = ["list ", "record ", "plane "].iter().any(|part| message.contains(part));
            assert!(!of_list, "{message}");
        }
    }
}

#[test]
fn maps_and_pictures_above_a_lowered_limit_on_textures_are_named() {
    let frame = frame(Method::Refined);
    let side: Lower = |limits, value| limits.max_texture_dimension_2d = value;
    let refused = lowered("max_texture_dimension_2d", side, 3..6, &frame);
    let layers: Lower = |limits, value| limits.max_texture_array_layers = value;
    let layers = lowered("max_texture_array_layers", layers, 0..2, &frame);
    if adapter().is_none() {
        return;
    }
    // maps of 32 x 32, a picture of 16 x 16, two layers
    for part in ["--image side 16 ", "range 1 to 8;"] {
        assert!(refused.iter().any(|message| message.contains(part)), "{part}: {refused:?}");
    }
    assert_eq!(layers.len(), 1, "{layers:?}");
    assert!(layers[0].starts_with("number of maps 2 is outside"), "{layers:?}");
}

#[test]
fn evaluations_above_a_lowered_limit_are_split_and_the_same() {
    let Some((device, _alone)) = adapter() else { return };
    let records: Vec<[f32; 3]> = (0..1000).map(|i| [i as f32, 0.5, 2000.0]).collect();
    let whole: Vec<f32> = device.evaluate("dpsm_depth", &records).unwrap();
    let adapter = wgpu_adapter(&device);
    for (name, lower) in BYTES {
        let mut limits = adapter.limits();
        lower(&mut limits, 1024);
        let small = Device::with_limits(&adapter, limits).unwrap();
        assert_eq!(small.evaluate::<_, f32>("dpsm_depth", &records).unwrap(), whole, "{name}");
    }
}

#[test]
fn stored_maps_above_a_lowered_limit_are_named() {
    let Some((device, _alone)) = adapter() else { return };
    let adapter = wgpu_adapter(&device);
    let (depths, sampling) = (vec![0.5; 64 * 64], Sampling::Nearest);
    let maps = DepthMaps { size: 64, layers: 1, depths, sampling, reversed: false };
    for (name, lower) in BYTES {
        let mut limits = adapter.limits();
        lower(&mut limits, 1024);
        let small = Device::with_limits(&adapter, limits).unwrap();
        let error = Texels::new(&small).unwrap().upload(&small, &maps, Format::D32).unwrap_err();
        assert!(matches!(error, GpuError::Limit { .. }), "{name}: {error}");
    }
}

#[test]
fn adapter_without_storage_buffers_is_refused_in_words() {
    let Some((device, _alone)) = adapter() else { return };
    let adapter = wgpu_adapter(&device);
    let limits = wgpu::Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits());
    let small = Device::with_limits(&adapter, limits).unwrap();
    for made in [
        gpu::render(&small, &frame(Method::Refined)).map(drop),
        gpu::make_maps(&small, &frame(Method::Refined)).map(drop),
        small.evaluate::<_, f32>("dpsm_depth", &[[1.0_f32, 0.1, 10.0]]).map(drop),
    ] {
        let error = made.unwrap_err();
        let typed = matches!(error, GpuError::Limit { .. } | GpuError::Rejected { .. });
        assert!(typed && error.to_string().contains("--adapter cpu"), "{error}");
    }
}
