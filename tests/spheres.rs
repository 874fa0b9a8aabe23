//! Near and far: what they may cut off, what they cost, and what is said of it.

#![cfg(feature = "scene")]

mod common;
#[path = "common/scenes.rs"]
mod scenes;

use dpsm::cpu;
use dpsm::measure::{Bench, Point, judge, truth_of};
use dpsm::render::{Bias, Casting, Filter, Format, Frame, Method, Settings};
use glam::{DVec3, dvec3};
use scenes::{SIZE, frame_of, square};

const METHODS: [Method; 6] = [
    Method::Vertex,
    Method::FragmentDepth,
    Method::Tessellated,
    Method::Exact,
    Method::Refined,
    Method::Cube,
];

fn settings(method: Method) -> Settings {
    Settings { size: SIZE, method, image: [16, 16], ..Settings::default() }
}

/// A floor of 2 km, 2 m below the light, and a hood of 2 cm right under it.
fn hood(settings: Settings) -> Frame {
    frame_of(vec![square("floor", 0.0, -2.0, 1000.0), square("hood", 0.0, -0.02, 0.01)], settings)
}

/// What maps and rays say of points of a frame's first mesh.
fn lit(frame: &Frame, points: &[DVec3]) -> Vec<(bool, bool)> {
    let maps = cpu::make_maps(frame).unwrap();
    let truth = truth_of(frame);
    let bench = Bench::new(frame, &maps, &truth);
    let point = |world: &DVec3| bench.point_at(*world, Some(DVec3::Y));
    let judged = points.iter().map(|world| judge(&bench, &point(world)));
    judged.map(|judged| (judged.visibility >= 0.5, judged.lit)).collect()
}

/// Below the hood, and beside its shadow.
const BELOW: [DVec3; 2] = [dvec3(0.3, -2.0, 0.2), dvec3(1.5, -2.0, 0.2)];

#[test]
fn casters_a_hundredthousandth_of_far_from_the_light_cast() {
    for method in METHODS {
        let frame = hood(settings(method));
        assert!(frame.light.far > 1000.0);
        assert_eq!(lit(&frame, &BELOW), [(false, false), (true, true)], "{method:?}");
        assert_eq!(frame.warnings(), [""; 0], "{method:?}");
    }
}

#[test]
fn near_that_cuts_a_caster_off_makes_false_light_and_names_it() {
    for method in METHODS {
        let frame = hood(Settings { near: Some(0.5), ..settings(method) });
        assert_eq!(lit(&frame, &BELOW), [(true, false), (true, true)], "{method:?}");
        let warnings = frame.warnings();
        assert_eq!(warnings.len(), 1, "{method:?}: {warnings:?}");
        assert!(
            warnings[0].contains("near 5.000e-1") && warnings[0].contains("`hood` at 2.000e-2")
        );
        assert!(!warnings[0].contains("floor"), "{warnings:?}");
    }
}

#[test]
fn far_that_cuts_a_caster_off_names_it() {
    let frame = hood(Settings { far: Some(10.0), ..settings(Method::Exact) });
    let warnings = frame.warnings();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("far 1.000e1") && warnings[0].contains("`floor` at 1.414e3"));
    assert!(warnings[0].contains("--far") && !warnings[0].contains("hood"), "{warnings:?}");
}

#[test]
fn unorm_steps_wider_than_a_texel_are_named_in_world_units() {
    let frame = hood(Settings { format: Format::D16, ..settings(Method::Exact) });
    let step = f64::from(frame.light.far) / 65535.0;
    let warnings = frame.warnings();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains(&format!("{step:.3e}")), "{warnings:?}");
    assert!(warnings[0].contains("`hood`") && warnings[0].contains("--format d32"), "{warnings:?}");
    // D24's are a thousandth of a texel there
    let fine = hood(Settings { format: Format::D24, ..settings(Method::Exact) });
    assert_eq!(fine.warnings(), [""; 0]);
}

#[test]
fn meshes_that_the_light_lies_on_are_not_said_to_be_cut_off() {
    let frame = frame_of(vec![square("on", 0.0, 0.0, 1.0)], settings(Method::Exact));
    assert_eq!(frame.warnings(), [""; 0]);
}

#[test]
fn many_meshes_that_are_cut_off_are_counted() {
    let hoods = (0..5).map(|i| square(&format!("hood {i}"), 0.0, -0.02 - 0.01 * i as f32, 0.01));
    let meshes = hoods.chain([square("floor", 0.0, -2.0, 3.0)]).collect();
    let frame = frame_of(meshes, Settings { near: Some(0.5), ..settings(Method::Exact) });
    let warnings = frame.warnings();
    assert!(warnings[0].contains("`hood 2` at 4.000e-2 and 2 more;"), "{warnings:?}");
}

#[test]
fn cubes_near_is_as_near_as_its_casters_but_no_nearer_than_its_depths_allow() {
    let near = |y: f32, format| {
        let meshes = vec![square("floor", 0.0, -2.0, 7.0), square("hood", 0.0, y, 0.01)];
        let frame = frame_of(meshes, Settings { format, ..settings(Method::Cube) });
        let corner = (1.0 + 2.0 * (1.0 + frame.light.guard).powi(2)).sqrt();
        frame.light.near * corner / frame.light.far
    };
    // far is 10
    let thousandth = 1e-3;
    assert!((near(-1.0, Format::D32) / thousandth - 1.0).abs() < 1e-5, "as far out as it was");
    let at_caster = 0.99 * 0.005 / 10.12;
    assert!(
        (near(-0.005, Format::D32) / at_caster - 1.0).abs() < 1e-2,
        "{}",
        near(-0.005, Format::D32)
    );
    let least = 64.0 / (1u32 << 24) as f32;
    assert!((near(-1e-7, Format::D32) / least - 1.0).abs() < 1e-5, "a step at far is a texel wide");
    assert!((near(-0.005, Format::D16) / (64.0 / 65535.0) - 1.0).abs() < 1e-5, "or as it was");
}

#[test]
fn floors_of_huge_ranges_are_lit_and_what_stands_on_them_casts() {
    // a tile 5 mm above the floor; at far = 2e7 two roundings of the range are 4.8 m
    for (method, filter, bias) in [
        (Method::Exact, Filter::Single, Bias::Plane),
        (Method::Exact, Filter::Single, Bias::TexelCentre),
        (
            Method::Refined,
            Filter::Soft { taps: 16, radius: Some(1e-4), nearest: Some(0.5) },
            Bias::Plane,
        ),
    ] {
        let meshes = vec![square("floor", 0.0, -2.0, 3.0), square("tile", 0.0, -1.995, 0.5)];
        let settings = Settings { far: Some(2e7), size: 2048, filter, bias, ..settings(method) };
        let frame = frame_of(meshes, settings);
        let points = [dvec3(0.02, -2.0, 0.01), dvec3(0.9, -2.0, 0.3), dvec3(1.5, -2.0, -1.2)];
        let lit = lit(&frame, &points);
        assert_eq!(lit, [(false, false), (true, true), (true, true)], "{method:?} {filter:?}");
    }
}

#[test]
fn what_is_to_cast_no_shadow_casts_none_by_maps_or_rays() {
    for method in METHODS {
        let mut settings = settings(method);
        settings.leave_out(&[false, true]);
        assert_eq!(settings.casting, [Casting::By(method), Casting::LeftOut]);
        let frame = hood(Settings { near: Some(0.5), ..settings });
        assert_eq!(lit(&frame, &BELOW), [(true, true); 2], "{method:?}");
        assert_eq!(frame.warnings(), [""; 0], "what is left out is not cut off");
    }
    // what is only not seen shadows by rays
    let casting = vec![Casting::By(Method::Exact), Casting::Unseen];
    let frame = hood(Settings { casting, ..settings(Method::Exact) });
    assert_eq!(lit(&frame, &BELOW), [(true, false), (true, true)]);
}

#[test]
fn nothing_is_left_out_where_nothing_is_named() {
    let mut plain = settings(Method::Exact);
    plain.leave_out(&[false, false]);
    assert!(plain.casting.is_empty());
}

#[test]
fn what_casts_no_shadow_is_seen_and_shadowed() {
    // the cover is left out, and the tile above it shadows it
    let mut settings = settings(Method::Exact);
    settings.leave_out(&[true, false]);
    let meshes = vec![square("cover", 0.0, -1.0, 2.0), square("tile", 0.0, -0.5, 0.2)];
    let frame = frame_of(meshes, settings);
    let maps = cpu::make_maps(&frame).unwrap();
    let truth = truth_of(&frame);
    let bench = Bench::new(&frame, &maps, &truth);
    let seen: Vec<Point> = bench.points_from_camera(2000, 1);
    assert!(
        seen.iter().any(|point| point.triangle.is_some_and(|triangle| frame.is_left_out(triangle)))
    );
    let below = bench.point_at(dvec3(0.1, -1.0, 0.1), Some(DVec3::Y));
    assert_eq!((bench.visibility(&below), bench.is_lit(&below)), (0.0, false));
}
