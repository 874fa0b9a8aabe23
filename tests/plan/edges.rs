//! Shadow edges: how far a lookup may be off, and how far planned maps are.

use dpsm::cpu;
use dpsm::measure::{Bench, Point, truth_of, truth_of_casters};
use dpsm::plan::axis::Judge;
use dpsm::plan::choose::REACH;
use dpsm::plan::cost::{self, loads};
use dpsm::plan::{Plan, Proof, Request, Sample, Sight, Wrong, plan, shows};
use dpsm::render::{Casting, Frame, Method, Settings};
use dpsm::scalar::float::Vec2;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::dpsm_texel_pitch;
use dpsm::scene::{Options, Scene, open};
use fastrand::Rng;
use glam::{DVec3, Vec3, dvec3, vec3};
use std::f64::consts::{FRAC_PI_4, TAU};

use super::{built_in, floor_and_board, square, target};

/// A point at random between four texels' centres, and a shadow at random beside it, bounded by one
/// edge or by two at a right angle: how far it is from the shadow's border where a lookup lights it
/// wrongly.
fn wrong_by(rng: &mut Rng, sampling: Sampling, corner: bool) -> Option<f64> {
    let (sin, cos) = (rng.f64() * TAU).sin_cos();
    let p = [rng.f64(), rng.f64()];
    let [along, across] = [rng.f64() * 1.6 - 0.8, rng.f64() * 1.6 - 0.8];
    // distances from both edges, above 0 on the shadow's side
    let sides = |[x, y]: [f64; 2]| {
        let [x, y] = [x - p[0], y - p[1]];
        let across = if corner { across } else { f64::INFINITY };
        [x * cos + y * sin + along, y * cos - x * sin + across]
    };
    let dark = |at: [f64; 2]| sides(at).into_iter().all(|side| side >= 0.0);
    let centres = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let share: f64 = match sampling {
        Sampling::Nearest => f64::from(u8::from(dark(p.map(f64::round)))),
        Sampling::Linear => {
            let weight = |[x, y]: [f64; 2]| (1.0 - (p[0] - x).abs()) * (1.0 - (p[1] - y).abs());
            centres.into_iter().filter(|at| dark(*at)).map(weight).sum()
        }
    };
    let [a, b] = sides(p);
    // inside the nearer edge; outside the corner, or the one edge whose side is wrong
    let distance = match dark(p) {
        true => a.min(b),
        false => a.min(0.0).hypot(b.min(0.0)),
    };
    ((share > 0.5) != dark(p)).then_some(distance)
}

#[test]
fn no_wrong_point_is_beyond_half_a_diagonal_and_some_come_near_it() {
    const POINTS: usize = 4_000_000;
    let mut rng = Rng::with_seed(11);
    let mut wrong = |sampling, corner| -> Vec<f64> {
        (0..POINTS).filter_map(|_| wrong_by(&mut rng, sampling, corner)).collect()
    };
    let hard = wrong(Sampling::Nearest, false);
    // half a diagonal; along an edge 2 x 2 texels err by half a texel, at corners by as much as one
    let diagonal = REACH;
    let most = |wrong: Vec<f64>| wrong.into_iter().fold(0.0, f64::max);
    for (name, largest, bound) in [
        ("hard", most(hard), diagonal),
        ("hard, corners", most(wrong(Sampling::Nearest, true)), diagonal),
        ("2 x 2", most(wrong(Sampling::Linear, false)), 0.5),
        ("2 x 2, corners", most(wrong(Sampling::Linear, true)), diagonal),
    ] {
        println!("{name}: {largest:.4} of {bound:.4}");
        // wrong points thin out towards the bound: of so many the largest is within a tenth
        assert!(largest <= bound && largest > 0.9 * bound, "{name}: {largest} of {bound}");
    }
}

/// A sample that needs an angle in a direction.
fn sample(direction: DVec3, room: f64) -> Sample {
    let gap = [f64::INFINITY; 2];
    Sample {
        direction,
        distance: 1.0,
        normal: DVec3::ZERO,
        allowed: room,
        room,
        edge: 0.0,
        gap,
        behind: gap,
    }
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
fn a_local_search_finds_an_axis_between_the_named_ones() {
    // what must be fine lies along one direction, so the best axis is any across it
    let samples = [sample(dvec3(0.6, 0.48, 0.64), 0.01)];
    let judge = Judge { samples: &samples, seen: &[], cost: &|axis| axis.demand };
    let named = [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)];
    let found = judge.best(&named.map(|(name, axis)| (name.to_string(), axis)), 2);
    let searched = found.last().unwrap();
    // 2 (1 + cos) / room: the last step leaves less than itself of the angle
    assert!(searched.demand <= 200.0 * (1.0 + 0.02), "{searched:?}");
    assert!(found[..3].iter().all(|axis| axis.demand > 200.0 * 1.4), "{found:?}");
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
    let request = Request {
        lights: vec![light],
        axis: scene.default_light().axis,
        camera: scene.camera,
        ..Request::new(scene, target(error))
    };
    let plan = plan(&request).unwrap();
    (proof(scene, light, &request, &plan), plan.explanation())
}

fn proof(scene: &Scene, light: Vec3, request: &Request<'_>, plan: &Plan) -> Wrong {
    assert!(plan.meets, "{}", plan.explanation());
    let camera = scene.camera.unwrap();
    let settings = plan.settings(&Settings::default()).unwrap();
    let forward = Vec3::from_array(plan.axis);
    let frame =
        Frame::new(scene, light, forward, plan.is_hemispherical(), &camera, settings).unwrap();
    let truth = truth_of(&frame);
    let casters = truth_of_casters(&frame);
    let sights = [&truth, &casters].map(|truth| Sight { truth, origin: light.as_dvec3() });
    let empty = DepthMaps::empty(1, frame.light.hemispheres, Sampling::Nearest);
    let mut points = Bench::new(&frame, &empty, &truth).points_from_camera(6_000, 17);
    let eye = camera.eye.as_dvec3();
    points.retain(|point| shows(point, light.as_dvec3(), eye));
    let axis = request.axis.map(|axis| axis.as_dvec3());
    let proof = Proof::beside_edges(sights, request.error, points, Some(eye), axis, 18);
    let maps = cpu::make_maps(&frame).unwrap();
    let bench = Bench::new(&frame, &maps, &truth);
    let wrong = proof.wrong(&bench);
    assert_eq!(proof.holds(&bench), wrong.share <= 1.0);
    wrong
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

#[test]
fn a_shadow_edge_behind_a_wall_that_no_map_holds_counts() {
    // the board's shadow ends at x = 1; a low wall at 0.99 keeps the light from what is behind it
    let mut scene = floor_and_board(None);
    let mut wall = square("wall", 1.0, 0.0);
    for position in &mut wall.positions {
        *position = vec3(0.99, 0.15 * (1.0 + position.x), 4.0 * position.z);
    }
    scene.meshes.push(wall);
    let light = vec3(0.0, 2.0, 0.0);
    let [drawn, out] = [Casting::By(Method::Exact), Casting::LeftOut];
    let casting = vec![drawn, drawn, out];
    let settings = Settings { method: Method::Exact, casting, ..Settings::default() };
    let camera = scene.camera.unwrap();
    let frame = Frame::new(&scene, light, Vec3::NEG_Y, false, &camera, settings).unwrap();
    let (truth, casters) = (truth_of(&frame), truth_of_casters(&frame));
    let sights = [&truth, &casters].map(|truth| Sight { truth, origin: light.as_dvec3() });
    // maps that hold nothing light all
    let empty = DepthMaps::empty(64, 2, Sampling::Nearest);
    let bench = Bench::new(&frame, &empty, &truth);
    let point = bench.point_at(dvec3(0.98, 0.0, 0.0), Some(DVec3::Y));
    let floor = frame.meshes.iter().find(|(name, _)| name == "floor").unwrap();
    let triangle = floor.1.clone().next();
    let point = Point { triangle, ..point };
    let wrong = Proof::new(sights, target("0.5deg"), vec![point]).wrong(&bench);
    // atan(1 / 2) - atan(0.98 / 2) is 0.461 degrees; rings and azimuths find it up to 5% farther
    assert_eq!(wrong.wrong, 1);
    assert!((0.92..0.97).contains(&wrong.share), "{wrong:?}");
}
