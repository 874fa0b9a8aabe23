//! The measures: they find nothing where nothing is wrong, and each deliberate fault where it is.

#![cfg(feature = "scene")]

mod common;

use common::EPS;
use dpsm::cpu;
use dpsm::measure::*;
use dpsm::render::{Format, Frame, Method, Settings};
use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::float::Vec2;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::dpsm_texture_to_disk;
use dpsm::scene::{self, Camera, Mesh, Options, Scene};
use dpsm::truth::Truth;
use glam::{DVec3, Vec3, vec3};

const SIZE: u32 = 128;

fn settings() -> Settings {
    Settings { size: SIZE, image: [64, 48], ..Settings::default() }
}

fn room(walls: u32, settings: Settings) -> Frame {
    let scene = scene::open("brabec-room", &Options { walls }).unwrap();
    let light = scene.default_light();
    let camera = scene.camera.unwrap();
    Frame::new(&scene, light.position, Vec3::NEG_Y, false, &camera, settings).unwrap()
}

/// Maps whose every texel stores the truth along its centre.
fn exact_maps(frame: &Frame, truth: &Truth) -> DepthMaps {
    let size = frame.settings.size;
    let empty = DepthMaps::empty(size, frame.light.hemispheres, Sampling::Nearest);
    let mut maps = empty.clone();
    let bench = Bench::new(frame, &empty, truth);
    for hemisphere in 0..maps.layers {
        for y in 0..size {
            for x in 0..size {
                let st = Vec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / f64::from(size);
                let uv = dpsm_texture_to_disk(st, bench.light.guard);
                if let Some(distance) = bench.first_distance(uv, hemisphere) {
                    let depth = dpsm_depth(distance, bench.light.near, bench.light.far);
                    let index = maps.index(x.into(), y.into(), hemisphere);
                    maps.depths[index] = frame.settings.format.store(depth as f32);
                }
            }
        }
    }
    maps
}

/// A horizontal square of half-width `half` at height `y`, its centre at x = `x`.
fn square(name: &str, x: f32, y: f32, half: f32) -> Mesh {
    Mesh {
        name: name.into(),
        positions: [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
            .map(|(s, t)| vec3(x + s * half, y, t * half))
            .to_vec(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        albedo: Vec3::ONE,
    }
}

/// A light at the origin, a floor 2 below, and half a floor 1 below whose border is x = 0, right
/// under the light.
fn half_covered(settings: Settings) -> Frame {
    let scene = Scene {
        name: "half covered".into(),
        meshes: vec![square("floor", 0.0, -2.0, 50.0), square("cover", 50.0, -1.0, 50.0)],
        lights: Vec::new(),
        camera: None,
        warnings: Vec::new(),
    };
    let camera = Camera {
        eye: vec3(0.0, 5.0, 0.1),
        target: vec3(0.0, -2.0, 0.0),
        up: Vec3::NEG_Z,
        vertical_fov: 1.0,
    };
    Frame::new(&scene, Vec3::ZERO, Vec3::NEG_Y, false, &camera, settings).unwrap()
}

#[test]
fn exact_maps_have_no_map_error() {
    for format in [Format::D16, Format::D24, Format::D32] {
        let frame = room(1, Settings { format, ..settings() });
        let truth = truth_of(&frame);
        let maps = exact_maps(&frame, &truth);
        let error = map_error(&Bench::new(&frame, &maps, &truth), || ());
        assert_eq!((error.all.missing, error.all.extra), (0, 0));
        // half a step of the format and the rounding to f32, over the nearest distance
        let range = f64::from(frame.light.far - frame.light.near);
        let nearest = 0.3; // metres: the light is farther than that from everything
        let bound = (0.5 * f64::from(format.quantum()) + 0.5 * EPS) * range / nearest;
        assert!(error.all.largest <= bound, "{format:?}: {} above {bound}", error.all.largest);
        assert_eq!(error.all.texels, error.rim.texels + error.centre.texels);
        // texels inside the rim: pi / 4 of the square, less the guard band; the rim's own texels,
        // fewer than 4 N, may count either way
        let side = f64::from(SIZE) / (1.0 + f64::from(frame.light.guard));
        let disk = 2.0 * std::f64::consts::FRAC_PI_4 * side * side;
        assert!((error.all.texels as f64 - disk).abs() <= 4.0 * f64::from(SIZE) * 2.0);
    }
}

#[test]
fn swapped_hemispheres_are_seen() {
    let frame = room(1, settings());
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let half = maps.depths.len() / 2;
    maps.depths.rotate_left(half);
    let error = map_error(&Bench::new(&frame, &maps, &truth), || ());
    assert!(error.all.off_1e2 > error.all.covered / 20, "{error:?}");
}

#[test]
fn maps_upside_down_are_seen() {
    let frame = room(1, settings());
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let size = SIZE as usize;
    for layer in maps.depths.chunks_mut(size * size) {
        let rows: Vec<Vec<f32>> = layer.chunks(size).rev().map(<[f32]>::to_vec).collect();
        layer.copy_from_slice(&rows.concat());
    }
    let error = map_error(&Bench::new(&frame, &maps, &truth), || ());
    assert!(error.all.off_1e2 > error.all.covered / 20, "{error:?}");
}

#[test]
fn near_left_out_of_the_depth_is_seen() {
    let frame = room(1, Settings { near: Some(0.2), ..settings() });
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let (near, far) = (frame.light.near, frame.light.far);
    for depth in maps.depths.iter_mut().filter(|depth| **depth < 1.0) {
        *depth = (near + *depth * (far - near)) / far;
    }
    let error = map_error(&Bench::new(&frame, &maps, &truth), || ());
    assert!(error.all.off_1e3 > error.all.covered / 2, "{error:?}");
}

#[test]
fn texels_are_counted_by_how_far_they_are_off() {
    let frame = room(1, settings());
    let truth = truth_of(&frame);
    let exact = exact_maps(&frame, &truth);
    let (near, far) = (frame.light.near, frame.light.far);
    for (factor, above_1e2, above_1e3) in [(0.9995, 0, 0), (0.995, 0, 1), (0.98, 1, 1)] {
        let mut maps = exact.clone();
        for depth in maps.depths.iter_mut().filter(|depth| **depth < 1.0) {
            *depth = dpsm_depth((near + *depth * (far - near)) * factor, near, far);
        }
        let error = map_error(&Bench::new(&frame, &maps, &truth), || ()).all;
        let expected = (error.covered * above_1e2, error.covered * above_1e3);
        assert_eq!((error.off_1e2, error.off_1e3), expected, "factor {factor}");
        // rounding to f32 of depths up to 1, over distances from 0.3 m of a range of about 3.5 m
        let off = f64::from(1.0_f32 - factor);
        assert!((error.largest - off).abs() <= 20.0 * EPS, "{}", error.largest);
        assert!((error.percentile_99 - off).abs() <= 20.0 * EPS, "{}", error.percentile_99);
    }
}

#[test]
fn missing_and_extra_texels_are_counted() {
    let frame = half_covered(settings());
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let centre = maps.index(64, 64, 0);
    assert!(maps.depths[centre] < 1.0);
    maps.depths[centre] = 1.0;
    let up = maps.index(64, 64, 1);
    assert_eq!(maps.depths[up], 1.0, "nothing is above the light");
    maps.depths[up] = 0.5;
    let error = map_error(&Bench::new(&frame, &maps, &truth), || ());
    assert_eq!((error.all.missing, error.all.extra), (1, 1));
    assert_eq!((error.rim.missing, error.rim.extra), (0, 0));
}

#[test]
fn vertex_method_fails_on_walls_of_two_triangles_and_most_texels_are_off() {
    let frame = room(1, Settings { size: 512, ..settings() });
    let (maps, truth) = (cpu::make_maps(&frame).unwrap(), truth_of(&frame));
    let error = map_error(&Bench::new(&frame, &maps, &truth), || ());
    assert!(error.all.off_1e2 * 2 > error.all.covered, "{error:?}");
    assert!(error.all.missing * 20 > error.all.texels, "{error:?}");
}

#[test]
fn walls_of_8_x_8_quads_bow_half_a_texel_and_err_by_one_and_a_half_percent() {
    let frame = room(8, Settings { size: 512, ..settings() });
    let (maps, truth) = (cpu::make_maps(&frame).unwrap(), truth_of(&frame));
    let bench = Bench::new(&frame, &maps, &truth);
    let floor = frame.meshes.iter().find(|(name, _)| name == "floor").unwrap().1.clone();
    let bow = bowed_edges(&bench, floor.clone());
    assert_eq!(format!("{:.2}", bow.measured), "0.48");
    // the formula is the first term of a series in the chord, which is at most an eighth here
    let predicted = bow.predicted.unwrap();
    assert!((bow.measured - predicted).abs() <= predicted / 64.0, "{bow:?}");
    let affine = affine_depth(&bench, floor);
    assert_eq!(format!("{:.1}", 100.0 * affine.measured), "1.5");
    assert!(affine.measured <= affine.predicted.unwrap(), "{affine:?}");
}

#[test]
fn doubling_every_stored_value_lights_some_shadows_and_darkens_nothing() {
    let frame = room(8, Settings { format: Format::D32, ..settings() });
    let truth = truth_of(&frame);
    let maps = cpu::make_maps(&frame).unwrap();
    let mut doubled = maps.clone();
    doubled.depths.iter_mut().for_each(|depth| *depth *= 2.0);
    let (plain, twice) = (Bench::new(&frame, &maps, &truth), Bench::new(&frame, &doubled, &truth));
    let mut lit = 0;
    for point in plain.points_scattered(5_000, 1) {
        let [before, after] = [&plain, &twice].map(|bench| judge(bench, &point).visibility);
        assert!(after >= before, "{point:?} was lit and is shadowed");
        lit += usize::from(after > before);
    }
    assert!(lit > 0, "no shadowed point turned lit");
}

#[test]
fn point_under_the_covers_border_is_an_edge_point_and_others_are_not() {
    let frame = half_covered(settings());
    let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    let bench = Bench::new(&frame, &maps, &truth);
    let at = |x: f64| judge(&bench, &bench.point_at(DVec3::new(x, -2.0, 0.3), None));
    // a texel at the map's centre spans 4 / N rad, and the floor is 2 below
    let texel = 2.0 * 4.0 / f64::from(SIZE);
    assert!(at(0.01 * texel).edge || at(-0.01 * texel).edge);
    for x in [-3.0 * texel, 3.0 * texel] {
        let judgement = at(x);
        assert!(!judgement.edge, "{x}");
        assert_eq!(judgement.lit, x < 0.0);
    }
    let under = at(3.0 * texel);
    // the cover lies halfway between the light and the floor
    assert!((under.gap - under.own / 2.0).abs() <= 1e-12);
}

#[test]
fn misclassified_points_are_as_far_from_the_true_edge_as_they_were_put() {
    let frame = half_covered(settings());
    // empty maps light every point: those under the cover are false light
    let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    let bench = Bench::new(&frame, &maps, &truth);
    let texels = 2.5;
    let r = texels * bench.texel();
    // stereographic: r = tan(theta / 2), and the border is the plane x = 0 through the light
    let x = 2.0 * (2.0 * r.atan()).tan();
    let point = bench.point_at(DVec3::new(x, -2.0, 0.0), None);
    let error = shadow_error(&bench, &[point], || ());
    assert_eq!((error.false_light, error.false_shadow), (1, 0));
    assert_eq!(error.faults(), 1);
    // the edge is found to 1/1024 of a ring's gap of 2 texels, on the nearest of 16 azimuths
    assert!((error.edge_texels_largest - texels).abs() <= 2.0 / 1024.0, "{error:?}");
}

#[test]
fn coverage_of_a_cone_that_the_border_halves_is_one_half() {
    let frame = half_covered(settings());
    let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    let bench = Bench::new(&frame, &maps, &truth);
    let at = |x: f64| coverage(&bench, &bench.point_at(DVec3::new(x, -2.0, 0.0), None), 0.05);
    // 64 rays of Vogel's spiral: a line through the centre splits them to within the rays beside
    // it, fewer than 4 sqrt(64) / 8 on either side
    assert!((at(0.0) - 0.5).abs() <= 4.0 / 64.0, "{}", at(0.0));
    assert_eq!((at(-0.5), at(0.5)), (1.0, 0.0));
}

#[test]
fn sources_stay_within_their_bounds() {
    for format in [Format::D16, Format::D24, Format::D32] {
        let frame = room(8, Settings { format, method: Method::FragmentDepth, ..settings() });
        let (maps, truth) = (cpu::make_maps(&frame).unwrap(), truth_of(&frame));
        let bench = Bench::new(&frame, &maps, &truth);
        let points = bench.points_scattered(3_000, 2);
        let sources = attribute(&bench, &points, &PenumbraError::default());
        for name in ["f32 arithmetic", "storage format", "resolution", "bias"] {
            let source = sources.iter().find(|source| source.name == name).unwrap();
            let predicted = source.predicted.unwrap();
            assert!(source.measured > 0.0 && source.measured <= predicted, "{format:?} {source:?}");
        }
    }
}

#[test]
fn linear_sampling_comes_nearer_to_the_coverage_than_the_hard_test() {
    let hard = room(8, settings());
    let linear = room(8, Settings { sampling: Sampling::Linear, ..settings() });
    let truth = truth_of(&hard);
    let error = |frame: &Frame| {
        let maps = cpu::make_maps(frame).unwrap();
        let bench = Bench::new(frame, &maps, &truth);
        penumbra_error(&bench, &bench.points_from_camera(4_000, 3), || ())
    };
    let (hard, linear) = (error(&hard), error(&linear));
    assert!(hard.penumbra_points > 50 && linear.penumbra_points > 50);
    assert!(linear.penumbra_rmse < hard.penumbra_rmse, "{hard:?} {linear:?}");
}

#[test]
fn same_seed_gives_the_same_points() {
    let frame = room(8, settings());
    let (maps, truth) = (DepthMaps::empty(SIZE, 2, Sampling::Nearest), truth_of(&frame));
    let bench = Bench::new(&frame, &maps, &truth);
    assert_eq!(bench.points_scattered(50, 7), bench.points_scattered(50, 7));
    assert_ne!(bench.points_scattered(50, 7), bench.points_scattered(50, 8));
    assert_eq!(bench.points_from_camera(50, 7), bench.points_from_camera(50, 7));
}
