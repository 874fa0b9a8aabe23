//! The filters in the host: adapter and ports give the same pictures, several lights their mean.

#![cfg(feature = "gpu")]

mod common;

use common::device;
use dpsm::render::{Filter, Frame, FrameError, Kernel, Method, Picture, Settings, Taps};
use dpsm::scalar::maps::Sampling;
use dpsm::scene::{self, Options};
use dpsm::{cpu, gpu};
use glam::Vec3;

fn frame(position: Option<Vec3>, settings: Settings) -> Result<Frame, FrameError> {
    let scene = scene::open("brabec-room", &Options::default()).unwrap();
    let light = scene.default_light();
    let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
    let position = position.unwrap_or(light.position);
    Frame::new(&scene, position, Vec3::NEG_Y, false, &camera, settings)
}

fn settings(filter: Filter) -> Settings {
    // the same exposure for all, so that a mean of pictures is one of light
    let exposure = Some(1.0);
    Settings {
        size: 128,
        image: [96, 72],
        samples: 1,
        exposure,
        terminator: false,
        filter,
        ..Settings::default()
    }
}

fn taps(kernel: Kernel) -> Taps {
    Taps { count: 16, kernel }
}

/// Pixels of two pictures that differ by more than two steps of a byte: those at edges, where the
/// two rasterizers see different triangles.
fn apart(a: &Picture, b: &Picture) -> usize {
    let differs = |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 2);
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| differs((a, b))).count()
}

#[test]
fn adapter_and_ports_filter_alike() {
    let Some(device) = device() else { return };
    let soft = Filter::Soft { taps: 16, radius: Some(0.1), nearest: None };
    let filters = [
        Filter::Naive(4),
        Filter::Disk(taps(Kernel::Tangent(0.05))),
        Filter::Disk(taps(Kernel::Radius(0.1))),
        Filter::Mirror(taps(Kernel::Tangent(0.05))),
        Filter::Reproject(taps(Kernel::Tangent(0.05))),
        soft,
    ];
    let mut pictures = Vec::new();
    for sampling in [Sampling::Nearest, Sampling::Linear] {
        for filter in filters {
            let frame = frame(None, Settings { sampling, ..settings(filter) }).unwrap();
            let [ours, ports] =
                [gpu::render(&device, &frame).unwrap().lit, cpu::render(&frame).unwrap().lit];
            let apart = apart(&ours, &ports);
            println!("{filter:?}, {sampling:?}: {apart} of {} pixels apart", ours.pixels.len());
            // a hundredth: what the hard test's pictures may differ by too
            assert!(apart <= ours.pixels.len() / 100, "{filter:?}, {sampling:?}: {apart}");
            pictures.push(ours);
        }
    }
    // and no filter is another one
    let other = |a: &Picture, b: &Picture| apart(a, b) > 20;
    assert!(other(&pictures[0], &pictures[1]) && other(&pictures[1], &pictures[2]));
    assert!(other(&pictures[1], &pictures[5]));
    // the disk's taps read the nearest texels whatever the sampler
    assert_eq!(apart(&pictures[1], &pictures[7]), 0);
}

#[test]
fn several_lights_are_the_mean_of_each_and_read_their_own_layers() {
    let Some(device) = device() else { return };
    let disk = settings(Filter::Disk(taps(Kernel::Radius(0.1))));
    let one = frame(None, disk.clone()).unwrap();
    let single = gpu::render(&device, &one).unwrap().lit;
    // the same light thrice is that light
    let thrice = one.clone().with_lights([one.light; 2]).unwrap();
    let picture = gpu::render(&device, &thrice).unwrap().lit;
    assert!(apart(&single, &picture) <= single.pixels.len() / 1000);
    let other = frame(Some(Vec3::new(1.0, 2.0, 1.0)), disk.clone()).unwrap();
    let both = one.clone().with_lights([other.light]).unwrap();
    let picture = gpu::render(&device, &both).unwrap().lit;
    let alone = gpu::render(&device, &other).unwrap().lit;
    // linear light of the bytes, and their mean; a byte's step is at most 1/100 of the light
    let linear = |byte: u8| {
        let c = f64::from(byte) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    let mut off = 0;
    for ((both, a), b) in picture.pixels.iter().zip(&single.pixels).zip(&alone.pixels) {
        let mean = |i: usize| 0.5 * (linear(a[i]) + linear(b[i]));
        // channels that are not clipped
        let whole = |i: usize| a[i] == 255 || b[i] == 255;
        off += usize::from((0..3).any(|i| !whole(i) && (linear(both[i]) - mean(i)).abs() > 0.01));
    }
    println!("{off} of {} pixels are not the mean", picture.pixels.len());
    assert!(off <= picture.pixels.len() / 100, "{off}");
    let ports = cpu::render(&both).unwrap().lit;
    assert!(apart(&picture, &ports) <= picture.pixels.len() / 100);
}

#[test]
fn filters_that_cannot_be_are_refused() {
    let fault = |settings: Settings| frame(None, settings).unwrap_err().to_string();
    assert!(fault(settings(Filter::Naive(0))).contains("0 taps"));
    let kernel = Kernel::Tangent(f32::NAN);
    assert!(fault(settings(Filter::Disk(taps(kernel)))).contains("NaN"));
    let cube = Settings { method: Method::Cube, ..settings(Filter::Naive(4)) };
    assert!(fault(cube).contains("another --method"));
    let naive = frame(None, settings(Filter::Naive(4))).unwrap();
    let light = naive.light;
    let error = naive.with_lights([light]).unwrap_err().to_string();
    assert!(error.contains("--filter hard, hardware or disk"), "{error}");
}
