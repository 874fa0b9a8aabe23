//! The shadow test of given points on the adapter, alone.

#![cfg(feature = "gpu")]

use dpsm::gpu::{self, Device, MeshBuffers, Parts, PointTests, ShadowMaps};
use dpsm::measure::{Bench, truth_of};
use dpsm::render::{Bias, Filter, Frame, Kernel, Method, Settings, Taps};
use dpsm::scalar::maps::Sampling;
use dpsm::scene::{self, Options};
use glam::Vec3;

fn frame(settings: Settings) -> Frame {
    let scene = scene::open("brabec-room", &Options::default()).unwrap();
    let light = scene.default_light();
    let camera = scene.camera.unwrap();
    Frame::new(&scene, light.position, Vec3::NEG_Y, false, &camera, settings).unwrap()
}

#[test]
fn points_are_judged_as_by_the_ports_and_take_time() {
    let Ok(device) = Device::open() else { return println!("skipped: no adapter") };
    let kernel = Kernel::Tangent(0.02);
    let usual = Settings { size: 128, image: [160, 120], ..Settings::default() };
    let cases = [
        usual.clone(),
        Settings { bias: Bias::Normal, ..usual.clone() },
        Settings { bias: Bias::TexelCentre, ..usual.clone() },
        Settings { bias: Bias::Footprint, sampling: Sampling::Linear, ..usual.clone() },
        Settings { bias: Bias::Constant(None), ..usual.clone() },
        Settings { filter: Filter::Naive(3), ..usual.clone() },
        Settings { filter: Filter::Disk(Taps { count: 8, kernel }), ..usual.clone() },
        Settings { filter: Filter::Reproject(Taps { count: 8, kernel }), ..usual.clone() },
        Settings { method: Method::Vertex, ..usual.clone() },
        Settings { method: Method::Cube, bias: Bias::Footprint, ..usual.clone() },
        Settings { method: Method::Cube, ..usual },
    ];
    let frames = cases.map(frame);
    let truth = truth_of(&frames[0]);
    let mesh = MeshBuffers::new(&device, &frames[0]).unwrap();
    let maps: Vec<ShadowMaps> =
        frames.iter().map(|frame| ShadowMaps::new(&device, frame, &mesh).unwrap()).collect();
    let tests = PointTests::new(&device).unwrap();
    for maps in &maps {
        let encoder = device.encode("maps", |encoder| maps.record(encoder, &mesh, None)).unwrap();
        device.submit("maps", encoder).unwrap();
    }
    let mut at_work = Vec::new();
    for (frame, maps) in frames.iter().zip(&maps) {
        let stored = maps.download(&device, frame.settings.sampling_taken()).unwrap();
        let bench = Bench::new(frame, &stored, &truth);
        let seen = bench.points_of_image();
        let receivers: Vec<_> = seen.iter().flatten().map(|p| bench.receiver(p)).collect();
        assert!(receivers.len() > 10_000, "{}", receivers.len());
        let both: Vec<_> = receivers.iter().map(|&(p, normal)| [p, normal]).collect();
        let points = PointTests::upload(&device, &both).unwrap();
        let test = tests.of(&device, frame, maps, &points).unwrap();
        let shares = test.run(&device).unwrap();
        let expected = receivers.iter().map(|&(p, normal)| frame.visibility(&stored, p, normal));
        // a 2 x 2 comparison's weights have at least 8 bits, 1/256 each way; a quotient of two is
        // off by the more the less is decided: more than 1/16 below an eighth
        let step = match (frame.settings.bias_taken(), frame.settings.sampling_taken()) {
            (Bias::Normal, _) => 1.0 / 16.0,
            (Bias::Plane, _) | (_, Sampling::Nearest) => 1e-3,
            (_, Sampling::Linear) => 1.0 / 128.0,
        };
        let off = shares.iter().zip(expected).filter(|(share, port)| (*share - port).abs() > step);
        let off = off.count();
        let lit = shares.iter().filter(|share| **share >= 0.5).count();
        println!("{:?}: {off} of {} differ, {lit} lit", frame.settings.filter, shares.len());
        assert!(off * 1000 < shares.len(), "{:?}: {off}", frame.settings);
        assert!(lit > shares.len() / 10 && lit < shares.len());
        at_work.push((test, receivers.len()));
    }
    let records: Vec<_> = at_work
        .iter()
        .map(|(test, _)| {
            |encoder: &mut wgpu::CommandEncoder, stamps: gpu::Stamps<'_>| {
                test.record(encoder, stamps);
            }
        })
        .collect();
    let timed: Vec<gpu::Timed<'_>> = records.iter().map(|record| ("test", record as _)).collect();
    let times = device.time_in_turn(&timed, 1, 5).unwrap();
    for (times, (_, points)) in times.iter().zip(&at_work) {
        let [_, _, median, _] = gpu::quartiles(times);
        let ns = median * 1e9 / *points as f64;
        println!("{ns} ns a point");
        // a thousand cores of a GHz do a test of ten instructions in 10 ps; one core of a software
        // adapter in nanoseconds
        let software = device.describe().contains("a software adapter");
        assert!(times.len() == 5 && ns > if software { 2.0 } else { 1e-3 }, "{ns} ns a point");
    }
}

#[test]
fn times_include_compute_passes_before_draws() {
    let Ok(device) = Device::open() else { return println!("skipped: no adapter") };
    let scene = scene::dozen(100_000);
    let light = scene.default_light();
    let camera = scene.default_camera(light.position);
    let settings = Settings { size: 256, ..Settings::default() };
    let frame = Frame::new(&scene, light.position, Vec3::NEG_Y, false, &camera, settings).unwrap();
    let mesh = MeshBuffers::new(&device, &frame).unwrap();
    // llvmpipe errs where others have drawn in between
    let all_maps = [(); 2].map(|()| ShadowMaps::new(&device, &frame, &mesh).unwrap());
    let parts =
        [Parts::ALL, Parts { draw: false, ..Parts::ALL }, Parts { sort: false, ..Parts::ALL }];
    let record = |(maps, parts)| {
        let (maps, mesh): (&ShadowMaps, _) = (maps, &mesh);
        move |encoder: &mut wgpu::CommandEncoder, stamps: gpu::Stamps<'_>| {
            maps.record_parts(encoder, mesh, stamps, parts);
        }
    };
    let records: Vec<_> =
        all_maps.iter().flat_map(|maps| parts.map(|parts| (maps, parts))).map(record).collect();
    let timed: Vec<gpu::Timed<'_>> =
        records.iter().map(|record| ("sorting and drawing", record as _)).collect();
    let times = device.time_in_turn(&timed, 1, 9).unwrap();
    let [all, sort, draw] = [0, 1, 2].map(|i| gpu::quartiles(&times[i])[2] * 1e3);
    println!("{all} ms for {sort} and {draw}");
    // what is sorted is needed to draw: nothing overlaps
    assert!(all > 0.75 * (sort + draw), "{all} ms for {sort} and {draw}");
}

#[test]
fn quartiles_are_those_of_the_sorted_times() {
    let times = [5, 1, 4, 2, 3].map(std::time::Duration::from_secs);
    assert_eq!(gpu::quartiles(&times), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(gpu::quartiles(&times[..1]), [5.0; 4]);
    assert_eq!(gpu::quartiles(&[]), [0.0; 4]);
}
