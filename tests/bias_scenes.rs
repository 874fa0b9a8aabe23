//! The biases on scenes, maps of the ports against ray casting: no faults over random light poses.

#![cfg(feature = "scene")]

#[path = "../benches/maps/place.rs"]
mod place;

use dpsm::cpu;
use dpsm::measure::{Bench, ShadowError, judge, shadow_error, truth_of};
use dpsm::render::{Bias, Format, Frame, Method, Settings, depth_tolerance, guard_band};
use dpsm::scalar::maps::Sampling;
use fastrand::Rng;
use glam::Quat;
use place::{Place, posed, position, rotation};

const SCENES: [&str; 6] = ["cornell", "seam-box", "grazing", "gaps", "contact", "seam-edge"];

/// Light poses of each scene; a format in turn.
const POSES: usize = 6;

/// Points of each pose, over all surfaces.
const POINTS: usize = 500;

/// The sum of the errors over random poses in all scenes.
fn errors(settings: &Settings) -> ShadowError {
    let mut sum = ShadowError::default();
    for name in SCENES {
        let place = Place::built_in(name, 1);
        let truth = truth_of(&place.frame(settings.clone()));
        let mut rng = Rng::with_seed(5);
        for pose in 0..POSES {
            let format = [Format::D16, Format::D24, Format::D32][pose % 3];
            let settings = Settings { format, ..settings.clone() };
            let (light, turn) = (position(&place, &truth, &mut rng), rotation(&mut rng));
            let frame = posed(&place, settings, light, turn);
            let maps = cpu::make_maps(&frame).unwrap();
            let bench = Bench::new(&frame, &maps, &truth);
            let points = bench.points_scattered(POINTS, pose as u64);
            let error = shadow_error(&bench, &points, || ());
            sum.points += error.points;
            sum.edge_points += error.edge_points;
            sum.faults_shadow += error.faults_shadow;
            sum.faults_light += error.faults_light;
            sum.false_shadow += error.false_shadow;
            sum.false_light += error.false_light;
        }
    }
    println!("{:?} {:?}: {sum:?}", settings.bias, settings.sampling);
    assert!(sum.edge_points > 100 && sum.points > 2 * sum.edge_points);
    sum
}

fn settings() -> Settings {
    Settings { size: 128, method: Method::Exact, image: [64, 48], ..Settings::default() }
}

#[test]
fn texel_centre_has_no_fault() {
    let settings = || Settings { bias: Bias::TexelCentre, ..settings() };
    let error = errors(&settings());
    assert_eq!((error.faults_shadow, error.faults_light), (0, 0));
    // a step of a cube's perspective depth is thicker than the thin gaps
    let cube = errors(&Settings { method: Method::Cube, ..settings() });
    assert_eq!(cube.faults_shadow, 0);
}

#[test]
fn footprint_has_no_acne_and_a_constant_has() {
    for sampling in [Sampling::Nearest, Sampling::Linear] {
        for method in [Method::Exact, Method::Cube] {
            let of = |bias| errors(&Settings { bias, sampling, method, ..settings() });
            assert_eq!(of(Bias::Footprint).faults_shadow, 0, "{method:?} {sampling:?}");
            assert!(of(Bias::Constant(None)).faults_shadow > 0, "{method:?} {sampling:?}");
        }
    }
}

#[test]
fn two_by_two_comparisons_leave_lit_surfaces_wholly_lit() {
    for method in [Method::Exact, Method::Cube] {
        let settings =
            Settings { method, bias: Bias::TexelCentre, sampling: Sampling::Linear, ..settings() };
        let frame = Place::built_in("cornell", 1).frame(settings);
        let (maps, truth) = (cpu::make_maps(&frame).unwrap(), truth_of(&frame));
        let bench = Bench::new(&frame, &maps, &truth);
        let points = bench.points_scattered(4 * POINTS, 3);
        let judged = points.iter().map(|point| judge(&bench, point));
        let lit: Vec<_> = judged.filter(|at| at.lit && !at.edge).collect();
        assert!(lit.len() > POINTS);
        let dimmed = lit.iter().find(|at| at.visibility < 1.0);
        assert!(dimmed.is_none(), "{method:?}: {dimmed:?}");
    }
}

#[test]
fn light_that_is_turned_sees_the_same_normals() {
    let place = Place::built_in("cornell", 1);
    let light = place.light;
    let turn = Quat::from_rotation_x(0.7) * Quat::from_rotation_z(2.0);
    let frame = posed(&place, settings(), light, turn);
    for triangle in 0..frame.triangles.len() as u32 {
        let corners = frame.triangles[triangle as usize];
        let [a, b, c] = corners.map(|i| frame.vertices[i as usize].position);
        let normal = (turn.inverse() * (b - a).cross(c - a)).normalize();
        let found = frame.light_normal(triangle);
        let along = (normal.x * found.x + normal.y * found.y + normal.z * found.z).abs();
        assert!((along - 1.0).abs() < 1e-5, "triangle {triangle}: {found:?}, {normal}");
    }
    let none = Frame { triangles: vec![[0, 1, 99_999]], ..frame };
    assert_eq!([none.light_normal(0), none.light_normal(1)].map(|n| n.length()), [0.0, 0.0]);
}

#[test]
fn depth_tolerance_is_half_the_finest_texel_of_maps_of_any_size() {
    for size in [64, 256, 2048, 4096, 16384] {
        // a texel at the rim spans 4 (1 + guard) / (N (1 + 1))
        let rim = 2.0 * (1.0 + guard_band(size)) / size as f32;
        assert_eq!(depth_tolerance(size), 0.5 * rim);
    }
    assert_eq!(depth_tolerance(4), 1.0 / 16.0);
    let frame = Place::built_in("cornell", 1).frame(Settings { size: 4096, ..Settings::default() });
    assert_eq!(frame.settings.tolerances()[1], depth_tolerance(4096));
    // an eighth of it may be too near, which is all that receivers allow for
    assert_eq!(frame.settings.too_near(), 0.125 * depth_tolerance(4096));
}
