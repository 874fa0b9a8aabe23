//! More triangles than fit at once, and more than fit at all.

use dpsm::gpu::{self, Device, GpuError};
use dpsm::render::{Method, Passes, Settings};
use dpsm::scalar::light::DPSM_HEMISPHERICAL;
use dpsm::scene;
use glam::{Vec3, vec3};

use crate::support::{device, differing, frame, is_whole, mesh, scene_of, settings, stored};

/// The same adapter with smaller buffers.
fn limited(bytes: u64) -> Device {
    with(|limits| wgpu::Limits {
        max_storage_buffer_binding_size: bytes,
        max_buffer_size: bytes,
        ..limits
    })
}

/// The same adapter with other limits.
fn with(change: impl Fn(wgpu::Limits) -> wgpu::Limits) -> Device {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let limits = |adapter: &wgpu::Adapter| change(adapter.limits());
    let open = |adapter: &wgpu::Adapter| Device::with_limits(adapter, limits(adapter)).ok();
    adapters.iter().find_map(open).unwrap()
}

#[test]
fn many_chunks_make_the_maps_of_one() {
    let Some(device) = device() else { return };
    // room for a part of the 40,000 at once
    let limited = limited((10_000 + (1 << 14)) * 224);
    let scene = scene::crowd(40_000);
    let position = scene.default_light().position;
    for method in [Method::Exact, Method::Refined, Method::Vertex] {
        let frame = frame(&scene, position, Settings { method, ..settings() });
        let [one, many] = [&*device, &limited].map(|d| gpu::make_maps(d, &frame).unwrap());
        assert_eq!(differing(&one, &many), 0, "{method:?}");
    }
}

#[test]
fn buffers_above_the_adapters_limit_are_refused_by_name() {
    let Some(_alone) = device() else { return };
    let limited = limited(1 << 18);
    let scene = scene::crowd(40_000);
    let frame = frame(&scene, scene.default_light().position, settings());
    let refused = gpu::make_maps(&limited, &frame).unwrap_err().to_string();
    assert!(refused.contains("bytes") && refused.contains("262144"), "{refused}");
}

#[test]
fn ten_million_triangles_are_drawn_in_chunks() {
    let Some(device) = device() else { return };
    // a wavy floor
    const SIDE: u32 = 2237;
    let at = |i: u32| {
        let [x, z] = [i % SIDE, i / SIDE].map(|c| c as f32 / SIDE as f32 - 0.5);
        vec3(4.0 * x, -1.0 + 0.01 * (50.0 * x).sin(), 4.0 * z)
    };
    let positions: Vec<Vec3> = (0..SIDE * SIDE).map(at).collect();
    let quad = |i: u32| [[i, i + 1, i + SIDE + 1], [i, i + SIDE + 1, i + SIDE]];
    let inside = |i: &u32| i % SIDE < SIDE - 1 && i / SIDE < SIDE - 1;
    let triangles = (0..SIDE * SIDE).filter(inside).flat_map(quad).collect();
    let frame = frame(&scene_of(vec![mesh(positions, triangles)]), Vec3::ZERO, settings());
    assert!(frame.triangles.len() > 9_990_000);
    match gpu::make_maps(&device, &frame) {
        // the floor's half-width is 2 of a height of 1: its disk holds most of the front map
        Ok(maps) => assert!(is_whole(&maps) && stored(&maps) > 10_000, "{}", stored(&maps)),
        Err(error) => assert!(error.to_string().contains("bytes"), "{error}"),
    }
}

#[test]
fn multiview_beyond_the_adapters_views_is_refused_by_name() {
    let Some(_alone) = device() else { return };
    let scene = scene::crowd(100);
    let settings = Settings { method: Method::Vertex, passes: Passes::Multiview, ..settings() };
    let mut frame = frame(&scene, scene.default_light().position, settings);
    let limited = with(|limits| wgpu::Limits { max_multiview_view_count: 0, ..limits });
    let refused = gpu::make_maps(&limited, &frame).unwrap_err();
    assert!(matches!(refused, GpuError::Multiview { .. }), "{refused}");
    let message = refused.to_string();
    assert!(message.contains("at most 0 views") && message.contains("--passes atlas"), "{message}");
    // one map needs none
    frame.light.hemispheres = DPSM_HEMISPHERICAL;
    assert!(stored(&gpu::make_maps(&limited, &frame).unwrap()) > 0);
}
