//! Reversed depth: maps of 1 less each depth, compared with greater-equal, light the same.

#![cfg(feature = "gpu")]

mod common;
#[path = "common/scenes.rs"]
mod scenes;

use dpsm::gpu::{self, PointTests, ShadowMaps};
use dpsm::measure::{Bench, Point, truth_of};
use dpsm::render::{
    Bias, Filter, Format, Frame, FrameError, Kernel, Method, Passes, Settings, Taps,
};
use dpsm::scalar::depth::{dpsm_depth_stored, dpsm_depth_stored_four};
use dpsm::scalar::filter::{DPSM_TAP_HARD, DpsmTaps, dpsm_filter_disk, dpsm_filter_hardware};
use dpsm::scalar::float::{Vec2, Vec4};
use dpsm::scalar::light::{DPSM_FORWARD, DPSM_REVERSED};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::pcss::dpsm_pcss;
use dpsm::scalar::plane::dpsm_visibility_plane;
use dpsm::scalar::raw::{dpsm_raw_disk, dpsm_raw_hardware, dpsm_raw_pcss, dpsm_raw_plane};
use dpsm::{cpu, scene};
use glam::Vec3;

const METHODS: [Method; 5] =
    [Method::Vertex, Method::FragmentDepth, Method::Tessellated, Method::Exact, Method::Refined];

/// Half of what 1 less a depth is rounded by, twice.
const STEP: f32 = 1.0 / (1 << 24) as f32;

fn room(settings: Settings) -> Frame {
    scenes::room(8, Settings { size: 256, image: [16, 16], ..settings })
}

/// Every lookup, with a name.
fn lookups() -> Vec<(&'static str, Settings)> {
    let of = |filter, bias, sampling| Settings { filter, bias, sampling, ..Settings::default() };
    let taps = Taps { count: 16, kernel: Kernel::Tangent(0.02) };
    let soft = Filter::Soft { taps: 16, radius: Some(0.1), nearest: Some(0.5) };
    use Sampling::{Linear, Nearest};
    vec![
        ("plane", of(Filter::Single, Bias::Plane, Nearest)),
        ("normal", of(Filter::Single, Bias::Normal, Nearest)),
        ("texel centre", of(Filter::Single, Bias::TexelCentre, Nearest)),
        ("footprint", of(Filter::Single, Bias::Footprint, Linear)),
        ("constant", of(Filter::Single, Bias::Constant(None), Nearest)),
        ("pcf", of(Filter::Naive(3), Bias::Footprint, Linear)),
        ("disk", of(Filter::Disk(taps), Bias::Plane, Nearest)),
        ("mirror", of(Filter::Mirror(taps), Bias::Plane, Nearest)),
        ("reproject", of(Filter::Reproject(taps), Bias::Plane, Linear)),
        ("pcss", of(soft, Bias::Plane, Nearest)),
    ]
}

fn points(frame: &Frame) -> Vec<Point> {
    let truth = truth_of(frame);
    let empty = DepthMaps::empty(1, 1, Sampling::Nearest);
    Bench::new(frame, &empty, &truth).points_scattered(3000, 5)
}

fn shares(frame: &Frame, maps: &DepthMaps, points: &[Point]) -> Vec<f32> {
    let truth = truth_of(frame);
    let bench = Bench::new(frame, maps, &truth);
    points.iter().map(|point| bench.visibility(point)).collect()
}

#[test]
fn stored_depths_are_their_own_inverse() {
    for reversed in [DPSM_FORWARD, DPSM_REVERSED] {
        for depth in [0.0_f32, 0.25, 0.5, 1.0] {
            let stored = dpsm_depth_stored(depth, reversed);
            assert_eq!(dpsm_depth_stored(stored, reversed), depth);
            let four = dpsm_depth_stored_four(Vec4::splat(depth), reversed);
            assert_eq!(four, Vec4::splat(stored));
        }
    }
    assert_eq!(dpsm_depth_stored(0.25_f32, DPSM_REVERSED), 0.75);
}

#[test]
fn reversed_maps_are_1_less_the_others() {
    for method in METHODS {
        for format in [Format::D16, Format::D32] {
            let plain = cpu::make_maps(&room(Settings { method, format, ..Settings::default() }));
            let reversed = Settings { method, format, reversed: true, ..Settings::default() };
            let reversed = cpu::make_maps(&room(reversed)).unwrap();
            let plain = plain.unwrap();
            assert!(reversed.reversed && plain.depths.iter().any(|depth| *depth < 1.0));
            for index in 0..plain.depths.len() {
                let off = (plain.depth(index) - reversed.depth(index)).abs();
                assert!(off <= format.quantum() + 4.0 * STEP, "{method:?} {format:?} {off:e}");
                assert_eq!(plain.depth(index) < 1.0, reversed.depth(index) < 1.0);
            }
        }
    }
}

#[test]
fn every_lookup_lights_the_same_points_by_reversed_maps() {
    for (name, settings) in lookups() {
        let settings = Settings { method: Method::Exact, ..settings };
        let plain = room(settings.clone());
        let reversed = room(Settings { reversed: true, ..settings });
        let points = points(&plain);
        let of = |frame: &Frame| shares(frame, &cpu::make_maps(frame).unwrap(), &points);
        let (plain, reversed) = (of(&plain), of(&reversed));
        let lit = plain.iter().filter(|share| **share > 0.5).count();
        assert!((300..2700).contains(&lit), "{name}: {lit}");
        // what a rounding decides: none in a thousand
        let apart = plain.iter().zip(&reversed).filter(|(a, b)| (*a - *b).abs() > 0.25).count();
        assert!(apart <= 3, "{name}: {apart}");
    }
}

#[test]
fn loads_read_reversed_maps_as_samplers_do() {
    let frame = room(Settings { method: Method::Exact, reversed: true, ..Settings::default() });
    let maps = cpu::make_maps(&frame).unwrap();
    let nearest = DepthMaps { sampling: Sampling::Nearest, ..maps.clone() };
    let (light, quantum) = (frame.light, frame.settings.quantum());
    let taps = DpsmTaps { count: 16, kind: DPSM_TAP_HARD, quantum, tolerance: 0.0 };
    let first = Vec2::new(1.0, 0.0);
    let truth = truth_of(&frame);
    let bench = Bench::new(&frame, &maps, &truth);
    let mut sums = [0.0; 4];
    for point in points(&frame) {
        let (p, normal) = bench.receiver(&point);
        let receiver = frame.receiver(p, normal);
        let loaded = [
            dpsm_raw_plane(&maps, p, receiver, light, quantum, 0.0),
            dpsm_raw_hardware(&maps, p, receiver, light, taps),
            dpsm_raw_disk(&maps, p, receiver, 0.02, light, taps, first),
            dpsm_raw_pcss(&maps, p, receiver, light, taps, 0.1, 0.5, first),
        ];
        let sampled = [
            dpsm_visibility_plane(&maps, p, receiver, light, quantum, 0.0),
            dpsm_filter_hardware(&nearest, p, receiver, light, taps),
            dpsm_filter_disk(&maps, p, receiver, 0.02, light, taps, first),
            dpsm_pcss(&maps, p, receiver, light, taps, 0.1, 0.5, first),
        ];
        assert_eq!(loaded, sampled, "{p:?}");
        for (sum, share) in sums.iter_mut().zip(loaded) {
            *sum += share;
        }
    }
    assert!(sums.iter().all(|lit| (300.0..2700.0).contains(lit)), "{sums:?}");
}

#[test]
fn adapters_draw_and_read_reversed_maps_as_the_ports_do() {
    let Some(device) = common::device() else { return };
    let tests = PointTests::new(&device).unwrap();
    for (name, settings) in lookups() {
        for (method, passes) in [
            (Method::Exact, Passes::Single),
            (Method::Refined, Passes::Atlas),
            (Method::Vertex, Passes::Single),
        ] {
            let settings = Settings { method, passes, reversed: true, ..settings.clone() };
            let frame = room(settings);
            let mesh = gpu::MeshBuffers::new(&device, &frame).unwrap();
            let maps = ShadowMaps::new(&device, &frame, &mesh).unwrap();
            gpu_make(&device, &maps, &mesh);
            let stored = maps.download(&device, frame.settings.sampling_taken()).unwrap();
            assert!(stored.reversed && stored.depths.iter().any(|depth| *depth > 0.0));
            let points = points(&frame);
            let truth = truth_of(&frame);
            let bench = Bench::new(&frame, &stored, &truth);
            let receivers: Vec<_> = points.iter().map(|point| bench.receiver(point)).collect();
            let given: Vec<_> = receivers.iter().map(|&(p, normal)| [p, normal]).collect();
            let buffer = PointTests::upload(&device, &given).unwrap();
            let shown = tests.of(&device, &frame, &maps, &buffer).unwrap().run(&device).unwrap();
            let expected =
                receivers.iter().map(|&(p, normal)| frame.visibility(&stored, p, normal));
            let apart = expected.zip(shown).filter(|(a, b)| (a - b).abs() > 0.26).count();
            assert!(apart <= 3, "{name} {method:?}: {apart}");
        }
    }
}

fn gpu_make(device: &gpu::Device, maps: &ShadowMaps, mesh: &gpu::MeshBuffers) {
    let encoder = device.encode("maps", |encoder| maps.record(encoder, mesh, None)).unwrap();
    device.submit("maps", encoder).unwrap();
}

#[test]
fn cubes_are_not_reversed() {
    let scene = scene::open("brabec-room", &scene::Options::default()).unwrap();
    let settings = Settings { method: Method::Cube, reversed: true, ..Settings::default() };
    let camera = scene.camera.unwrap();
    let frame = Frame::new(&scene, Vec3::Y, Vec3::NEG_Y, false, &camera, settings);
    assert!(matches!(frame, Err(FrameError::Cube { what: "reversed depth", .. })));
}
