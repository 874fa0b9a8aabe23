//! Shadow edges: how far a lookup may be off, and how far planned maps are.

use dpsm::cpu;
use dpsm::measure::{Bench, truth_of, truth_of_casters};
use dpsm::plan::axis::Judge;
use dpsm::plan::choose::reach;
use dpsm::plan::cost::{self, loads};
use dpsm::plan::{Proof, Request, Sample, Sight, Wrong, plan, shows};
use dpsm::render::{Frame, Settings};
use dpsm::scalar::float::Vec2;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::dpsm_texel_pitch;
use dpsm::scene::{Options, Scene, open};
use fastrand::Rng;
use glam::{DVec3, Vec3, dvec3, vec3};
use std::f64::consts::{FRAC_PI_4, TAU};

use super::{built_in, target};

/// A point at random in a texel, or between four centres, and a straight edge at random beside it:
/// how far it is from the edge where the lookup lights it wrongly.
fn wrong_by(rng: &mut Rng, sampling: Sampling) -> Option<f64> {
    let (sin, cos) = (rng.f64() * TAU).sin_cos();
    let [x, y] = [rng.f64(), rng.f64()];
    let lit_by = rng.f64() * 1.5 - 0.75;
    let lit_at = |cx: f64, cy: f64| (cx - x) * cos + (cy - y) * sin + lit_by >= 0.0;
    let share = match sampling {
        Sampling::Nearest => f64::from(u8::from(lit_at(0.5, 0.5))),
        Sampling::Linear => {
            let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
            let weight = |cx: f64, cy: f64| (1.0 - (x - cx).abs()) * (1.0 - (y - cy).abs());
            corners
                .iter()
                .filter(|(cx, cy)| lit_at(*cx, *cy))
                .map(|(cx, cy)| weight(*cx, *cy))
                .sum()
        }
    };
    ((share >= 0.5) != (lit_by >= 0.0)).then_some(lit_by.abs())
}

/// The wrong ones of many such points.
fn wrong(sampling: Sampling) -> Vec<f64> {
    const POINTS: usize = 4_000_000;
    let mut rng = Rng::with_seed(11);
    (0..POINTS).filter_map(|_| wrong_by(&mut rng, sampling)).collect()
}

#[test]
fn few_wrong_points_are_beyond_the_reach_and_none_beyond_the_bound() {
    let bound = 0.5_f64.sqrt();
    for (sampling, bound, few) in [(Sampling::Nearest, bound, 1e-3), (Sampling::Linear, 0.5, 1e-4)]
    {
        let (wrong, reach) = (wrong(sampling), reach(sampling));
        let beyond = wrong.iter().filter(|by| **by > reach).count() as f64;
        let share = beyond / wrong.len() as f64;
        println!("{sampling:?}: {} wrong, {share:.2e} beyond {reach}", wrong.len());
        // a count of k is off by its root, taken four times; the reach has three digits, whose half
        // a thousandth changes the share by at most 8% of it
        assert!((share / few - 1.0).abs() < 4.0 / beyond.sqrt() + 0.08, "{share:.3e}");
        assert!(wrong.iter().all(|by| *by <= bound));
    }
}

/// A sample that needs an angle in a direction.
fn sample(direction: DVec3, room: f64) -> Sample {
    let gap = [f64::INFINITY; 2];
    Sample { direction, distance: 1.0, normal: DVec3::ZERO, allowed: room, room, edge: 0.0, gap }
}

#[test]
fn the_demand_is_the_size_whose_texel_is_as_wide_as_the_room() {
    let mut rng = Rng::with_seed(5);
    let mut unit = || loop {
        let v = dvec3(rng.f64(), rng.f64(), rng.f64()) * 2.0 - 1.0;
        if (0.1..1.0).contains(&v.length()) {
            return v.normalize();
        }
    };
    for _ in 0..1_000 {
        let (axis, direction) = (unit(), unit());
        let samples = [sample(direction, 0.003)];
        let judge = Judge { samples: &samples, seen: &[], cost: &|_| 0.0 };
        let demand = judge.axis("any", axis, 2).demand;
        let c = direction.dot(axis).abs();
        let r = ((1.0 - c) / (1.0 + c)).sqrt();
        let pitch = dpsm_texel_pitch(Vec2::new(r, 0.0), demand, 0.0);
        // a dozen roundings
        assert!((pitch / 0.003 - 1.0).abs() < 12.0 * f64::EPSILON, "{pitch}");
    }
}

#[test]
fn principal_axes_are_orthonormal_and_lead_along_the_receivers() {
    let along = dvec3(0.6, 0.0, 0.8);
    let beside = dvec3(0.0, 1.0, 0.0);
    let samples: Vec<Sample> = (0..100)
        .map(|k| sample((along + beside * (0.2 * f64::from(k % 5 - 2))).normalize(), 0.01))
        .collect();
    let judge = Judge { samples: &samples, seen: &[], cost: &|_| 0.0 };
    let axes = judge.principal();
    for (i, a) in axes.iter().enumerate() {
        for (j, b) in axes.iter().enumerate() {
            let expected = f64::from(u8::from(i == j));
            assert!((a.dot(*b) - expected).abs() < 1e-12, "{axes:?}");
        }
    }
    let nearest = axes.iter().map(|axis| axis.dot(along).abs()).fold(0.0, f64::max);
    assert!(nearest > 1.0 - 1e-12, "{axes:?}");
}

#[test]
fn a_closed_room_fills_both_maps() {
    // the walls alone: the solids inside cover them
    let mut scene = open("seam-box", &Options { walls: 64 }).unwrap();
    scene.meshes.truncate(6);
    let kept = vec![true; scene.meshes.len()];
    let seen = cost::seen(&scene, &kept, scene.default_light().position.as_dvec3());
    for axis in [DVec3::Y, dvec3(0.48, -0.6, 0.64)] {
        let [front, back] = loads(&seen, axis);
        for load in [front, back] {
            // a disk of diameter N has pi / 4 of N^2 texels. A triangle counts as a whole, in each
            // map that it touches, with the texels of its middle: both are off by its size, and
            // 64 quads along a wall are 0.03 rad at most
            assert!((load.inside / FRAC_PI_4 - 1.0).abs() < 0.06, "{load:?}");
        }
    }
}

/// The largest error of a plan's maps by the ports, as a share of the target.
fn proven(scene: &Scene, light: Vec3, error: &str) -> (Wrong, String) {
    let camera = scene.camera.unwrap();
    let request = Request {
        lights: vec![light],
        axis: scene.default_light().axis,
        camera: Some(camera),
        ..Request::new(scene, target(error))
    };
    let plan = plan(&request).unwrap();
    assert!(plan.meets, "{}", plan.explanation());
    let settings = plan.settings(&Settings::default()).unwrap();
    let axis = Vec3::from_array(plan.axis);
    let frame = Frame::new(scene, light, axis, plan.is_hemispherical(), &camera, settings).unwrap();
    let truth = truth_of(&frame);
    let casters = truth_of_casters(&frame);
    let sights = [&truth, &casters].map(|truth| Sight { truth, origin: light.as_dvec3() });
    let empty = DepthMaps::empty(1, frame.light.hemispheres, Sampling::Nearest);
    let mut points = Bench::new(&frame, &empty, &truth).points_from_camera(6_000, 17);
    let eye = camera.eye.as_dvec3();
    points.retain(|point| shows(point, light.as_dvec3(), eye));
    if let Some(axis) = request.axis {
        points.retain(|p| (p.world - light.as_dvec3()).dot(axis.as_dvec3()) >= 0.0);
    }
    let proof = Proof::beside_edges(sights, request.error, points, Some(eye), 18);
    let maps = cpu::make_maps(&frame).unwrap();
    let bench = Bench::new(&frame, &maps, &truth);
    let wrong = proof.wrong(&bench);
    assert_eq!(proof.holds(&bench), wrong.share <= 1.0);
    (wrong, plan.explanation())
}

#[test]
fn planned_maps_keep_shadow_edges_within_the_target() {
    for (name, light, error) in [
        ("brabec-room", vec3(0.5, 2.2, 0.3), "1texel"),
        ("brabec-room", vec3(-1.0, 1.0, 1.2), "0.02"),
        ("brabec-ceiling", vec3(0.0, 3.9, 0.0), "0.3deg"),
        ("cornell", vec3(0.2, 0.45, 0.3), "0.3deg"),
        ("seam-box", vec3(0.3, 2.0, -0.2), "0.3deg"),
        ("cage", vec3(0.01, 2.02, 0.0), "0.4deg"),
        ("gaps", vec3(0.2, 2.0, 0.1), "0.3deg"),
        ("contact", vec3(0.2, 2.0, 0.1), "0.3deg"),
    ] {
        let scene = built_in(name);
        let (wrong, explanation) = proven(&scene, light, error);
        println!("{name}, {error}: {} wrong of {}, {:.3}", wrong.wrong, wrong.points, wrong.share);
        assert!(wrong.wrong > 20, "{name}: {wrong:?}");
        assert!(wrong.share <= 1.0, "{name}: {wrong:?}\n{explanation}");
    }
}
