//! A method for each mesh, and meshes left out of the maps.

#![cfg(feature = "gpu")]

mod common;
#[path = "common/scenes.rs"]
mod scenes;

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use dpsm::gpu::{self, Device, GpuError, MeshBuffers, Parts, ShadowMaps, Texels};
use dpsm::render::Casting::{self, By, LeftOut};
use dpsm::render::{Frame, FrameError, Level, Method, Passes, Settings, depth_tolerance};
use dpsm::scalar::maps::DepthMaps;
use dpsm::scene::{self, Camera, Mask, Mesh, Options, Scene};
use dpsm::{cpu, render};
use glam::{Vec3, vec3};

const CAMERA: Camera =
    Camera { eye: vec3(0.0, 2.0, 3.0), target: Vec3::ONE, up: Vec3::Y, vertical_fov: 1.0 };

/// Castings that are dealt out to a scene's meshes in turn.
const VERTEX_AND_REFINED: &[Casting] = &[By(Method::Vertex), By(Method::Refined), LeftOut];
const REFINED_AND_VERTEX: &[Casting] = &[By(Method::Refined), By(Method::Vertex)];
const EXACT_AND_REFINED: &[Casting] = &[By(Method::Exact), By(Method::Refined)];
const EVERYTHING: &[Casting] = &[
    By(Method::Tessellated),
    By(Method::Exact),
    By(Method::FragmentDepth),
    By(Method::Refined),
    LeftOut,
    By(Method::Vertex),
];

const METHODS: [Method; 6] = [
    Method::Vertex,
    Method::FragmentDepth,
    Method::Tessellated,
    Method::Exact,
    Method::Refined,
    Method::Cube,
];

/// Small maps between spheres that do not depend on the meshes.
fn settings() -> Settings {
    Settings {
        size: 128,
        level: Level::Constant(2),
        image: [16, 16],
        near: Some(0.01),
        far: Some(8.0),
        ..Settings::default()
    }
}

/// The adapter, for one test at a time: lavapipe has been seen to hang with two devices at work.
fn device() -> Option<(Device, MutexGuard<'static, ()>)> {
    static ALONE: Mutex<()> = Mutex::new(());
    let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    common::device().map(|device| (device, alone))
}

/// The built-in scenes that are cast: one with masks and one of solids.
fn built_in() -> [Scene; 2] {
    ["fence", "brabec-room"]
        .map(|name| scene::open(name, &Options { walls: 1, ..Options::default() }).unwrap())
}

fn frame(scene: &Scene, settings: Settings) -> Result<Frame, FrameError> {
    let position = scene.default_light().position;
    Frame::new(scene, position, vec3(0.3, -1.0, 0.2), false, &CAMERA, settings)
}

/// Castings for all meshes of a scene.
fn dealt(scene: &Scene, castings: &[Casting]) -> Vec<Casting> {
    castings.iter().copied().cycle().take(scene.meshes.len()).collect()
}

/// A frame of a scene whose meshes are dealt castings.
fn cast(scene: &Scene, castings: &[Casting], settings: Settings) -> Frame {
    frame(scene, Settings { casting: dealt(scene, castings), ..settings }).unwrap()
}

/// A frame of those meshes alone that are dealt this method, all by it.
fn part(scene: &Scene, castings: &[Casting], method: Method, settings: Settings) -> Frame {
    let castings = dealt(scene, castings);
    let own = scene.meshes.iter().zip(&castings).filter(|(_, casting)| **casting == By(method));
    let meshes = own.map(|(mesh, _)| mesh.clone()).collect();
    frame(&Scene { meshes, ..scene.clone() }, Settings { method, ..settings }).unwrap()
}

/// What each method makes of its meshes alone, texel by texel the nearest.
fn nearest(
    scene: &Scene,
    castings: &[Casting],
    settings: &Settings,
    make: impl Fn(&Frame) -> DepthMaps,
) -> DepthMaps {
    let methods = METHODS.into_iter().filter(|method| castings.contains(&By(*method)));
    let maps = methods.map(|method| make(&part(scene, castings, method, settings.clone())));
    let min = |a: DepthMaps, b: DepthMaps| DepthMaps {
        depths: a.depths.iter().zip(&b.depths).map(|(a, b)| a.min(*b)).collect(),
        ..a
    };
    maps.reduce(min).unwrap()
}

/// Texels whose depths differ.
fn differing(a: &DepthMaps, b: &DepthMaps) -> usize {
    assert_eq!((a.size, a.layers), (b.size, b.layers));
    a.depths.iter().zip(&b.depths).filter(|(a, b)| a.to_bits() != b.to_bits()).count()
}

/// Texels that store something.
fn stored(maps: &DepthMaps) -> usize {
    maps.depths.iter().filter(|&&depth| depth < 1.0).count()
}

fn by_ports(frame: &Frame) -> DepthMaps {
    cpu::make_maps(frame).unwrap()
}

#[test]
fn meshes_of_a_method_are_few_ranges_and_masked_ones_still_last() {
    let masked = |name| Mesh {
        texcoords: vec![glam::Vec2::ZERO; 4],
        mask: Some(Mask { width: 1, height: 1, alpha: [255].into(), cutoff: 0.5 }),
        ..scenes::square(name, 0.0, -1.0, 1.0)
    };
    let plain = |name| scenes::square(name, 0.0, -1.0, 1.0);
    let meshes = [
        (masked("vertex, masked"), By(Method::Vertex)),
        (plain("refined"), By(Method::Refined)),
        (masked("out, masked"), LeftOut),
        (plain("vertex"), By(Method::Vertex)),
        (plain("out"), LeftOut),
        (masked("refined, masked"), By(Method::Refined)),
        (plain("vertex too"), By(Method::Vertex)),
    ];
    let (meshes, casting): (Vec<Mesh>, Vec<Casting>) = meshes.into_iter().unzip();
    let frame = scenes::frame_of(meshes, Settings { casting, ..settings() });
    let names: Vec<_> = frame.meshes.iter().map(|(name, _)| &name[..]).collect();
    let masked = ["refined, masked", "vertex, masked", "out, masked"];
    assert_eq!(names, [&["out", "vertex", "vertex too", "refined"][..], &masked[..]].concat());
    assert_eq!((frame.first_masked(), frame.masks.len()), (8, 3));
    let [vertex, refined] = [Method::Vertex, Method::Refined];
    assert_eq!(frame.drawn(), [(2..6, vertex), (6..10, refined), (10..12, vertex)]);
    // what lies between ranges of a method is not drawn with them
    let mut frame = frame;
    frame.castings[1].1 = By(Method::Refined);
    frame.castings[2].1 = LeftOut;
    assert_eq!(frame.drawn(), [(2..4, refined), (6..10, refined), (10..12, vertex)]);
    // without castings all are drawn, by the method that the settings have by then
    let mut frame = scenes::frame_of(vec![plain("a"), plain("b")], settings());
    frame.settings.method = Method::Exact;
    assert_eq!(frame.drawn(), [(0..4, Method::Exact)]);
    assert_eq!(scenes::frame_of(Vec::new(), settings()).drawn(), []);
}

#[test]
fn mixed_castings_are_the_nearest_of_each_methods_own_maps() {
    let device = device();
    for scene in built_in() {
        for castings in [VERTEX_AND_REFINED, REFINED_AND_VERTEX, EXACT_AND_REFINED, EVERYTHING] {
            let what = format!("{}, {castings:?}", scene.name);
            let mixed = by_ports(&cast(&scene, castings, settings()));
            let apart = nearest(&scene, castings, &settings(), by_ports);
            assert_eq!(differing(&mixed, &apart), 0, "ports: {what}");
            assert!(stored(&mixed) > 1000, "{what}");
            let Some((device, _alone)) = &device else { continue };
            for (passes, keep_lists) in
                [(Passes::Single, false), (Passes::Atlas, false), (Passes::Single, true)]
            {
                let settings = Settings { passes, keep_lists, ..settings() };
                let make = |frame: &Frame| gpu::make_maps(device, frame).unwrap();
                let mixed = make(&cast(&scene, castings, settings.clone()));
                let apart = nearest(&scene, castings, &settings, make);
                assert_eq!(differing(&mixed, &apart), 0, "adapter: {what}, {passes:?}");
                assert!(stored(&mixed) > 1000, "{what}");
            }
        }
    }
}

#[test]
fn exact_meshes_among_those_left_out_are_the_same_by_adapter_and_ports() {
    let Some((device, _alone)) = device() else { return };
    // the driver that rounds as the ports do, as in tests/maps/ports.rs
    if !device.info.name.contains("llvmpipe") {
        println!("skipped: {} may round otherwise", device.describe());
        return;
    }
    for scene in built_in() {
        for castings in [&[By(Method::Exact), LeftOut][..], &[LeftOut, By(Method::Exact)]] {
            let frame = cast(&scene, castings, settings());
            let maps = gpu::make_maps(&device, &frame).unwrap();
            assert_eq!(differing(&maps, &by_ports(&frame)), 0, "{}", scene.name);
            assert!(stored(&maps) > 100, "{}", scene.name);
        }
    }
}

#[test]
fn meshes_left_out_are_as_if_the_scene_had_none_of_them() {
    let device = device();
    for scene in built_in() {
        for method in METHODS {
            for cull_faces in [true, false] {
                let settings = Settings { method, cull_faces, ..settings() };
                let castings = [By(method), LeftOut, By(method)];
                let left_out = cast(&scene, &castings, settings.clone());
                let without = part(&scene, &castings, method, settings);
                assert!(without.triangles.len() < left_out.triangles.len());
                let what = format!("{}, {method:?}", scene.name);
                let [a, b] = [&left_out, &without].map(by_ports);
                assert_eq!(differing(&a, &b), 0, "ports: {what}");
                assert!(stored(&a) > 1000, "{what}");
                let Some((device, _alone)) = &device else { continue };
                let [a, b] = [&left_out, &without].map(|of| gpu::make_maps(device, of).unwrap());
                assert_eq!(differing(&a, &b), 0, "adapter: {what}");
            }
        }
    }
}

#[test]
fn castings_by_one_method_are_that_method() {
    let device = device();
    for scene in built_in() {
        for method in METHODS {
            // whatever the settings' own
            let own = if method == Method::Cube { method } else { Method::FragmentDepth };
            let all = cast(&scene, &[By(method)], Settings { method: own, ..settings() });
            let plain = frame(&scene, Settings { method, ..settings() }).unwrap();
            assert_eq!((&all.triangles, all.drawn()), (&plain.triangles, plain.drawn()));
            let [a, b] = [&all, &plain].map(by_ports);
            assert_eq!(differing(&a, &b), 0, "ports: {}, {method:?}", scene.name);
            let Some((device, _alone)) = &device else { continue };
            let [a, b] = [&all, &plain].map(|of| gpu::make_maps(device, of).unwrap());
            assert_eq!(differing(&a, &b), 0, "adapter: {}, {method:?}", scene.name);
        }
    }
}

#[test]
fn mixed_castings_by_multiview_are_those_one_by_one() {
    let Some((device, _alone)) = device() else { return };
    let castings = [Method::Tessellated, Method::Vertex, Method::Refined].map(By);
    for scene in built_in() {
        let frame = |passes| cast(&scene, &castings, Settings { passes, ..settings() });
        let has = device.device.features().contains(wgpu::Features::MULTIVIEW);
        match gpu::make_maps(&device, &frame(Passes::Multiview)) {
            Ok(maps) => {
                let single = gpu::make_maps(&device, &frame(Passes::Single)).unwrap();
                assert_eq!(differing(&maps, &single), 0, "{}", scene.name);
            }
            // docs/maps.md says what is wrong with lavapipe's
            Err(error @ GpuError::Multiview { .. }) if !has || device.info.driver == "llvmpipe" => {
                println!("skipped: {error}");
            }
            Err(error) => panic!("{error}"),
        }
    }
}

/// Render passes of a frame's maps, whose recording is timed.
fn passes(device: &Device, frame: &Frame) -> usize {
    let mesh = MeshBuffers::new(device, frame).unwrap();
    let maps = ShadowMaps::new(device, frame, &mesh).unwrap();
    let start = Instant::now();
    // the first and the last pass write the times: else the difference is none, or any
    let time = device.time("maps", |encoder, stamps| maps.record(encoder, &mesh, stamps));
    let time = time.unwrap().unwrap();
    assert!(!time.is_zero() && time <= start.elapsed(), "{time:?}");
    maps.passes()
}

#[test]
fn mixed_castings_cost_no_pass_but_for_a_second_list() {
    let Some((device, _alone)) = device() else { return };
    let [scene, _] = built_in();
    let of = |castings, passes_by| {
        let settings = Settings { passes: passes_by, ..settings() };
        passes(&device, &cast(&scene, castings, settings))
    };
    for castings in [&[By(Method::Refined)], VERTEX_AND_REFINED, REFINED_AND_VERTEX, &[LeftOut]] {
        assert_eq!(of(castings, Passes::Single), 2, "{castings:?}");
        assert_eq!(of(castings, Passes::Atlas), 1, "{castings:?}");
    }
    // exact, refined, and exact ones with masks
    assert_eq!([Passes::Single, Passes::Atlas].map(|passes| of(EVERYTHING, passes)), [6, 3]);
    let cube = Settings { method: Method::Cube, ..settings() };
    assert_eq!(passes(&device, &cast(&scene, &[By(Method::Cube), LeftOut], cube)), 6);
}

#[test]
fn kept_lists_of_mixed_castings_draw_the_maps_again() {
    let Some((device, _alone)) = device() else { return };
    let [scene, _] = built_in();
    for castings in [VERTEX_AND_REFINED, EVERYTHING] {
        let frame = cast(&scene, castings, Settings { keep_lists: true, ..settings() });
        let mut second = frame.light;
        second.position.x += 0.2;
        let mesh = MeshBuffers::new(&device, &frame).unwrap();
        let lights = [frame.light, second];
        let maps = ShadowMaps::with_lights(&device, &frame, &mesh, &lights).unwrap();
        let [sort, draw] = [true, false].map(|sort| Parts { sort, draw: !sort, ..Parts::ALL });
        let [at_once, again] = [vec![Parts::ALL], vec![sort, draw, draw]].map(|all| {
            let record = |encoder: &mut wgpu::CommandEncoder| {
                all.iter().for_each(|&parts| maps.record_parts(encoder, &mesh, None, parts));
            };
            device.submit("maps", device.encode("maps", record).unwrap()).unwrap();
            Texels::new(&device).unwrap().download(&device, &maps.view, &maps.texture).unwrap()
        });
        assert!(at_once == again && at_once.iter().any(|&depth| depth < 1.0), "{castings:?}");
    }
}

#[test]
fn chunks_of_mixed_castings_make_the_maps_of_one() {
    let Some((device, _alone)) = device() else { return };
    // room for a part of the 10,000 at once
    let bytes = 1_100_000;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let open = |adapter: &wgpu::Adapter| {
        let limits = wgpu::Limits {
            max_storage_buffer_binding_size: bytes,
            max_buffer_size: bytes,
            ..adapter.limits()
        };
        Device::with_limits(adapter, limits).ok()
    };
    let limited = adapters.iter().find_map(open).unwrap();
    let crowd = |from: f32| {
        let mut scene = scene::crowd(20_000);
        let places = scene.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions);
        places.for_each(|position| *position += vec3(from, 0.0, 0.0));
        scene
    };
    let mut scene = crowd(0.0);
    scene.meshes.extend(crowd(0.05).meshes);
    let half = scene.meshes.len() / 2;
    let methods = [Method::Vertex, Method::Refined];
    let casting = (0..2 * half).map(|index| By(methods[index / half])).collect();
    let frame = frame(&scene, Settings { casting, ..settings() }).unwrap();
    let [one, many] = [&device, &limited].map(|of| gpu::make_maps(of, &frame).unwrap());
    assert_eq!(differing(&one, &many), 0);
    let [one, many] = [&device, &limited].map(|of| passes(of, &frame));
    assert!(one == 2 && many >= 4, "{one}, {many}");
}

#[test]
fn scenes_left_out_altogether_have_empty_maps_and_render() {
    let device = device();
    for scene in built_in() {
        for method in METHODS {
            for passes in [Passes::Single, Passes::Atlas] {
                if (method, passes) == (Method::Cube, Passes::Atlas) {
                    continue;
                }
                let settings = Settings { method, passes, keep_lists: true, ..settings() };
                let frame = cast(&scene, &[LeftOut], Settings { views: true, ..settings });
                assert_eq!(frame.drawn(), []);
                let is_empty = |rendering: render::Rendering| {
                    stored(&rendering.maps.unwrap()) == 0 && rendering.lit.pixels.len() == 256
                };
                assert!(is_empty(cpu::render(&frame).unwrap()), "ports: {method:?}");
                let Some((device, _alone)) = &device else { continue };
                assert!(is_empty(gpu::render(device, &frame).unwrap()), "adapter: {method:?}");
            }
        }
    }
}

#[test]
fn slack_is_that_of_the_largest_tolerance_of_any_mesh() {
    let refined = [0.25, depth_tolerance(128)];
    let of = |method, castings: &[Casting]| {
        Settings { method, casting: castings.to_vec(), ..settings() }.tolerances()
    };
    assert_eq!(of(Method::Refined, &[]), refined);
    assert_eq!(of(Method::Vertex, VERTEX_AND_REFINED), refined);
    assert_eq!(of(Method::Refined, &[By(Method::Exact), LeftOut]), [0.0; 2]);
    assert_eq!(of(Method::Vertex, &[]), [0.0; 2]);
    // the slack of taps is that of lookups
    let [scene, _] = built_in();
    let settings = Settings { method: Method::Exact, ..settings() };
    assert_eq!(cast(&scene, VERTEX_AND_REFINED, settings).taps().tolerance, 0.125 * refined[1]);
}

#[test]
fn castings_that_do_not_fit_are_refused_by_name() {
    let [scene, _] = built_in();
    let count = scene.meshes.len();
    let refused = |method, passes, casting: Vec<Casting>| {
        let settings = Settings { method, passes, casting, ..settings() };
        frame(&scene, settings).unwrap_err().to_string()
    };
    for wrong in [1, count - 1, count + 1] {
        assert_eq!(
            refused(Method::Refined, Passes::Single, vec![LeftOut; wrong]),
            format!(
                "{wrong} castings for the {count} meshes of the scene; \
                 give each mesh one, or give none"
            )
        );
    }
    let one = |by| {
        let mut castings = vec![LeftOut; count];
        castings[6] = By(by);
        castings
    };
    assert_eq!(
        refused(Method::Cube, Passes::Single, one(Method::Refined)),
        "mesh `lattice` is cast by Refined, but the light's maps are the faces of a cube; \
         cast it by Cube, or leave it out"
    );
    assert_eq!(
        refused(Method::Vertex, Passes::Single, one(Method::Cube)),
        "mesh `lattice` is cast by Cube, but the light's maps are paraboloid; \
         cast it by Vertex, FragmentDepth, Tessellated, Exact or Refined, or leave it out"
    );
}
