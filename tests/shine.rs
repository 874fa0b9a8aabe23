//! What a light reaches: spots and ranges, in pictures and in what is measured.

#![cfg(feature = "scene")]

#[path = "common/scenes.rs"]
mod scenes;

use dpsm::cpu;
use dpsm::measure::{Bench, judge, truth_of};
use dpsm::render::{Filter, Frame, Method, Settings, Shine};
use dpsm::scene::{Cone, Light};
use glam::{DVec3, Vec3, dvec3};

/// A floor 2 below a spot of 30 and 45 degrees with a range of 5.
fn spot(settings: Settings) -> Frame {
    let frame = scenes::frame_of(vec![scenes::square("floor", 0.0, -2.0, 50.0)], settings);
    let light = Light {
        position: Vec3::ZERO,
        axis: Some(Vec3::NEG_Y),
        color: Vec3::ONE,
        cone: Some(Cone { inner: 30_f32.to_radians(), outer: 45_f32.to_radians() }),
        range: Some(5.0),
    };
    frame.shining(&light)
}

fn settings() -> Settings {
    Settings { size: 128, method: Method::Exact, image: [64, 48], ..Settings::default() }
}

#[test]
fn points_outside_a_spots_cone_are_dark_in_truth_and_map() {
    let soft = Filter::Soft { taps: 16, radius: Some(0.1), nearest: Some(0.5) };
    for filter in [Filter::Single, soft] {
        let frame = spot(Settings { filter, ..settings() });
        let maps = cpu::make_maps(&frame).unwrap();
        let truth = truth_of(&frame);
        let bench = Bench::new(&frame, &maps, &truth);
        // 0, 42 and 48 degrees; and 3.5 degrees, but beyond a range of 5
        let points = [0.0, 1.8, 2.22].map(|x| dvec3(x, -2.0, 0.0));
        let lit = points.map(|at| {
            let point = bench.point_at(at, Some(DVec3::Y));
            let judged = judge(&bench, &point);
            (judged.visibility, judged.lit, bench.true_visibility(&point))
        });
        assert_eq!(lit, [(1.0, true, 1.0), (1.0, true, 1.0), (0.0, false, 0.0)], "{filter:?}");
    }
    let near = Frame { shine: Shine { range: 1.9, ..Shine::EVERYWHERE }, ..spot(settings()) };
    let maps = cpu::make_maps(&near).unwrap();
    let truth = truth_of(&near);
    let bench = Bench::new(&near, &maps, &truth);
    let judged = judge(&bench, &bench.point_at(dvec3(0.1, -2.0, 0.0), Some(DVec3::Y)));
    assert_eq!((judged.visibility, judged.lit), (0.0, false));
}

#[test]
fn pictures_are_dark_outside_a_spots_cone_and_beyond_the_range() {
    let frame = spot(settings());
    let everywhere = Frame { shine: Shine::EVERYWHERE, ..frame.clone() };
    let light = |frame: &Frame| {
        let lit = cpu::lit_by(frame, |_| 1.0);
        let dark = cpu::lit_by(frame, |_| 0.0);
        let both = lit.pixels.iter().zip(&dark.pixels);
        both.map(|(lit, dark)| lit[0] - dark[0]).collect::<Vec<f32>>()
    };
    let (spot, all) = (light(&frame), light(&everywhere));
    let seen = cpu::surface_points(&frame);
    let mut counts = [0; 3];
    for (pixel, at) in seen.iter().enumerate() {
        let Some(at) = at else { continue };
        let share = frame.shine.share(at.p);
        // a pixel's samples are near its middle
        match share {
            0.0 if at.p.z < 0.65 * at.p.length() => {
                counts[0] += 1;
                assert_eq!(spot[pixel], 0.0);
            }
            _ if share > 0.9 => {
                counts[1] += 1;
                assert!(spot[pixel] > 0.8 * all[pixel]);
            }
            _ => counts[2] += 1,
        }
    }
    assert!(counts.iter().all(|count| *count > 20), "{counts:?}");
}

#[test]
fn far_is_no_farther_than_the_range_and_cuts_off_what_is_dark_without_a_word() {
    let frame = spot(settings());
    assert_eq!(frame.light.far, 5.0);
    assert_eq!(frame.warnings(), [""; 0]);
    // a far that is asked for stays
    assert_eq!(spot(Settings { far: Some(20.0), ..settings() }).light.far, 20.0);
    let shorter = spot(Settings { far: Some(3.0), ..settings() });
    assert_eq!((shorter.light.far, shorter.warnings().len()), (3.0, 1));
}
