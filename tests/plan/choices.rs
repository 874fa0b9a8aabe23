//! Size, format, budget, and plans as files.

use dpsm::plan::axis::Axis;
use dpsm::plan::choose::{Case, LEAST_SIZE, MOST_SIZE, ladder, ladder_below};
use dpsm::plan::cost::{Load, Rates};
use dpsm::plan::{Plan, PlanError, Request, Sample, Target, plan};
use dpsm::render::{Bias, Casting, Filter, Format, Method, Settings};
use dpsm::scene::Camera;
use glam::{DVec3, Vec3, vec3};

use super::{built_in, floor_and_board, planned, square, target};

/// A plan from its file. serde_json may round the last digit of a number of 17, such as a time.
fn read_back(plan: &Plan) -> Plan {
    let read: Plan = serde_json::from_str(&serde_json::to_string(plan).unwrap()).unwrap();
    for (a, b) in read.milliseconds.into_iter().zip(plan.milliseconds) {
        assert!((a - b).abs() <= b * f64::EPSILON, "{a} {b}");
    }
    read
}

#[test]
fn targets_are_angles() {
    // rounded once or twice each
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 4.0 * f64::EPSILON;
    assert!(near(target("0.1deg").angle(7.0), 0.1_f64.to_radians()));
    assert!(near(target("0.002").angle(0.5), 0.004_f64.atan()));
    let texel = target("0.5texel");
    assert_eq!(texel, target("0.5texels"));
    let whole = f64::from(1.0 + dpsm::render::guard_band(1024));
    assert!(near(texel.angle(3.0), 0.5 * 4.0 * whole / 1024.0));
    for text in ["", "x", "-1", "0", "inf", "nan", "1rad", "deg", "0.1 deg deg"] {
        let error = text.parse::<Target>().unwrap_err();
        assert!(error.contains("0.5texel") && error.contains(&format!("`{text}`")), "{error}");
    }
    assert_eq!(target("0.0123456").short(), "0.0123");
    assert_eq!(target("123.4deg").short(), "123deg");
}

#[test]
fn sizes_ascend_by_a_thirtysecond_of_an_octave_or_eight() {
    let mut size = LEAST_SIZE;
    let mut steps = 0;
    while size < MOST_SIZE {
        let next = ladder(f64::from(size) + 0.5);
        assert!(
            next > size
                && f64::from(next) <= (f64::from(size) * 33.0 / 32.0).max(f64::from(size) + 8.0)
        );
        assert_eq!(ladder(next.into()), next);
        assert_eq!(ladder_below(f64::from(next) - 0.5), Some(size));
        (size, steps) = (next, steps + 1);
    }
    assert_eq!((size, ladder(1e9), ladder_below(15.9)), (MOST_SIZE, MOST_SIZE, None));
    assert!(steps > 5 * 32);
}

#[test]
fn finer_targets_ask_for_larger_maps() {
    let scene = built_in("cornell");
    let sizes = ["1deg", "0.5deg", "0.25deg"].map(|error| planned(&scene, error).size);
    // twice as fine a target asks for twice the size, and a thin gap for up to as much again
    assert!(sizes[0] < sizes[1] && sizes[1] < sizes[2], "{sizes:?}");
}

#[test]
fn a_budget_that_is_too_small_gives_the_finest_maps_in_it_and_says_so() {
    let scene = built_in("brabec-room");
    let request = Request { camera: scene.camera, ..Request::new(&scene, target("0.1deg")) };
    let free = plan(&request).unwrap();
    assert!(free.meets);
    let budget = free.bytes / 4;
    let tight = plan(&Request { budget: Some(budget), ..request.clone() }).unwrap();
    assert!(!tight.meets && tight.bytes <= budget && tight.size < free.size);
    assert!(tight.predicted.value() > 0.1);
    assert!(
        tight.explanation().contains("0.1deg is not met: raise --budget"),
        "{}",
        tight.explanation()
    );
    // half as wide a map errs twice as much, but for the ladder's step
    let none = plan(&Request { budget: Some(100), ..request });
    assert_eq!(none.unwrap_err(), PlanError::Budget);
}

#[test]
fn thin_gaps_ask_for_finer_maps() {
    // of all surfaces, the floor under the board as well: 2 away, where a texel of the map that the
    // edges ask for is 0.03 wide and half of it is not seen
    let mut scene = floor_and_board(None);
    let [far, near, touching] = [0.5, 0.0075, 1e-4].map(|height| {
        for position in &mut scene.meshes[1].positions {
            position.y = height;
        }
        plan(&Request::new(&scene, target("0.5deg"))).unwrap()
    });
    assert!(far.meets && near.meets, "{}", near.explanation());
    assert!(near.size > far.size + far.size / 4, "{}", near.explanation());
    assert!(!touching.meets, "{}", touching.explanation());
}

/// The predicted share of the target, in maps of 1024, of one shadowed receiver that faces the light
/// two allowed angles from an edge.
fn share(distance: f64, gap: [f64; 2], behind: [f64; 2], format: Format) -> f64 {
    let sample = Sample {
        direction: DVec3::X,
        distance,
        normal: DVec3::X,
        allowed: 0.01,
        room: 0.01,
        edge: 0.02,
        gap,
        behind,
    };
    let rates = &Rates::LLVMPIPE;
    let case = Case { samples: &[sample], spheres: [0.01, 10.0], sorted: 0, pixels: 1, rates };
    let axis = Axis {
        name: "any".into(),
        axis: DVec3::X,
        maps: 1,
        loads: vec![Load::default()],
        demand: 1.0,
        straddling: 0,
    };
    case.candidate(0, &axis, 1024, format).share
}

#[test]
fn thin_gaps_forbid_coarse_formats() {
    // near the light a texel is thinner than a step of d16
    let gap = [3e-4; 2];
    assert!(share(0.03, gap, gap, Format::D32) < 1.0);
    assert_eq!(share(0.03, gap, gap, Format::D16), 2.0);
}

#[test]
fn steps_wider_than_a_texel_at_the_nearest_caster_ask_for_floats() {
    // a hood 5 cm from the light over a floor of 2 km: no gap must hold, but a step of d16 is 2 cm
    let scene = |far: f32| {
        let mut scene = built_in("cornell");
        scene.meshes = vec![square("floor", far, -2.0), square("hood", 0.05, -0.05)];
        scene.lights[0].position = Vec3::ZERO;
        scene.camera = None;
        scene
    };
    let format = |far| {
        let plan = plan(&Request::new(&scene(far), target("0.5texel"))).unwrap();
        let line = plan.choices.iter().find(|choice| choice.what == "format").unwrap();
        (plan.format.clone(), line.why.contains("wider than a texel at the nearest caster"))
    };
    assert_eq!(format(1000.0), ("d32".to_string(), true));
    assert_eq!(format(2.0), ("d16".to_string(), false));
}

#[test]
fn errors_as_large_as_the_scene_are_refused() {
    let scene = built_in("cornell");
    let size = f64::from(scene.bounds().extent().length());
    let refused = |error: Target| plan(&Request::new(&scene, error));
    for error in [Target::Units(1.01 * size), Target::Degrees(46.0), Target::Texels(400.0)] {
        let Err(wrong @ PlanError::Target { .. }) = refused(error) else { panic!("{error}") };
        assert!(wrong.to_string().contains("give a smaller --error"), "{wrong}");
    }
    assert!(refused(Target::Units(0.2 * size)).is_ok());
}

#[test]
fn small_gaps_beside_a_receiver_count_as_its_own() {
    // half a texel is 0.01 wide here, and what may decide a third of the allowed angle away
    let wide = [0.1; 2];
    let share = |gap, behind| share(5.0, gap, behind, Format::D32);
    assert!(share(wide, wide) < 1.0);
    assert_eq!(share([0.0125, 0.0], wide), 2.0);
    assert_eq!(share(wide, [0.0125, 0.0]), 2.0);
    assert!(share([0.02, 0.0], [0.02, 0.0]) < 1.0);
}

#[test]
fn a_gap_that_no_map_holds_is_said_and_the_plan_still_reads_back() {
    let mut scene = floor_and_board(None);
    for position in &mut scene.meshes[1].positions {
        // more than what stands on the floor, less than what f32 rounds away
        position.y = 8e-6;
    }
    let plan = plan(&Request::new(&scene, target("0.5deg"))).unwrap();
    assert!(!plan.meets && plan.predicted.value() > 0.5, "{}", plan.explanation());
    let read = read_back(&plan);
    assert_eq!(read, Plan { milliseconds: read.milliseconds, ..plan.clone() });
}

#[test]
fn every_choice_has_its_line_and_the_whole_is_the_largest() {
    let plan = planned(&built_in("brabec-room"), "0.2deg");
    let whats: Vec<&str> = plan.choices.iter().map(|choice| choice.what.as_str()).collect();
    let expected = [
        "hemispheres",
        "axis",
        "near and far",
        "meshes",
        "size",
        "format",
        "method",
        "filter and bias",
        "whole",
    ];
    assert_eq!(whats, expected);
    let errors: Vec<f64> = plan.choices.iter().filter_map(|choice| choice.error).collect();
    let whole = plan.choices.last().unwrap().error.unwrap();
    assert!(errors.iter().all(|error| *error <= whole) && whole <= 0.2);
    assert_eq!(plan.predicted, Target::Degrees(whole));
}

#[test]
fn the_axis_is_no_dearer_than_looking_down() {
    for name in ["brabec-room", "cornell", "cage"] {
        let plan = planned(&built_in(name), "0.01");
        let axis = &plan.choices[1].why;
        let share = axis.split("looking down would be ").nth(1);
        let percent = share.and_then(|text| text.split('%').next()?.parse::<u32>().ok());
        assert!(percent.is_none_or(|percent| percent >= 100), "{name}: {axis}");
    }
}

#[test]
fn plans_survive_a_file_and_become_settings() {
    let scene = built_in("brabec-room");
    let plan = planned(&scene, "0.2deg");
    let read = read_back(&plan);
    assert_eq!(read, Plan { milliseconds: read.milliseconds, ..plan.clone() });
    assert_eq!(read.check(&scene), Ok(()));
    let settings = read.settings(&Settings::default()).unwrap();
    let (size, near, far) = (settings.size, settings.near.unwrap(), settings.far.unwrap());
    assert_eq!((size, near, far), (plan.size, plan.near, plan.far));
    assert_eq!(settings.format, Format::D16);
    assert_eq!(settings.method, Method::Exact);
    assert_eq!((settings.filter, settings.bias), (Filter::Single, Bias::Plane));
    let out = settings.casting.iter().filter(|casting| **casting == Casting::Unseen).count();
    assert_eq!((out, settings.casting.len()), (6, scene.meshes.len()));
    assert_eq!(settings.casting[14], Casting::By(Method::Exact));
}

#[test]
fn plans_that_do_not_fit_are_refused() {
    let (scene, other) = (built_in("brabec-room"), built_in("cornell"));
    let plan = planned(&scene, "0.2deg");
    assert!(matches!(plan.check(&other), Err(PlanError::Scene { .. })));
    let renamed = |mesh: usize| {
        let mut plan = plan.clone();
        plan.left_out[0].mesh = mesh;
        plan.check(&scene)
    };
    assert!(matches!(renamed(1), Err(PlanError::Scene { .. })));
    assert!(matches!(renamed(1_000), Err(PlanError::Scene { .. })));
    assert_eq!(Plan { version: 9, ..plan.clone() }.check(&scene), Err(PlanError::Version(9)));
    let base = Settings::default();
    for (changed, what) in [
        (Plan { filter: "hard".into(), ..plan.clone() }, "filter"),
        (Plan { filter: "hardware".into(), ..plan.clone() }, "filter"),
        (Plan { format: "d64".into(), ..plan.clone() }, "format"),
        (Plan { method: "vertex".into(), ..plan.clone() }, "method"),
    ] {
        let error = changed.settings(&base).unwrap_err();
        assert!(error.to_string().contains(&format!("the plan's {what} `")), "{error}");
    }
}

#[test]
fn what_cannot_be_planned_says_why() {
    let scene = floor_and_board(None);
    let request = Request::new(&scene, target("0.2deg"));
    let none = plan(&Request { lights: Vec::new(), ..request.clone() });
    assert_eq!(none.unwrap_err(), PlanError::NoLight);
    let away = Camera { target: vec3(6.0, 9.0, 6.0), ..scene.camera.unwrap() };
    let unseen = plan(&Request { camera: Some(away), ..request.clone() });
    assert_eq!(unseen.unwrap_err(), PlanError::NothingSeen);
    for light in [Vec3::NAN, Vec3::splat(1e30)] {
        let wrong = plan(&Request { lights: vec![light], ..request.clone() });
        assert!(matches!(wrong.unwrap_err(), PlanError::Frame(_)));
    }
    let mut broken = scene.clone();
    broken.meshes[0].triangles[0] = [0, 1, 99];
    let wrong = plan(&Request::new(&broken, target("0.2deg")));
    assert!(matches!(wrong.unwrap_err(), PlanError::Frame(_)));
    let mut empty = scene.clone();
    empty.meshes.clear();
    assert!(plan(&Request::new(&empty, target("0.2deg"))).is_err());
    // on a surface, and in a corner: a plan all the same
    for light in [vec3(0.0, 0.0, 0.0), vec3(4.0, 0.0, 4.0)] {
        assert!(plan(&Request { lights: vec![light], ..request.clone() }).is_ok());
    }
}
