//! Scenes far from their file's origin.

use dpsm::scene::{Options, Scene, open};
use glam::{DVec3, dvec3};
use serde_json::json;

use crate::model::{Model, PLATE, lit};
use crate::{assert_valid, file, read};

/// The floor, a post's lid at y = 2 and the light, all under one node that takes them away.
fn moved(by: [f64; 3]) -> Model {
    let mut model = Model::new();
    let lid = model.plate("lid", &PLATE);
    model.node(json!({ "mesh": lid, "translation": [0, 2, 0] }));
    model.json["scenes"][0]["nodes"] = json!([3]);
    model.add("nodes", json!({ "children": [0, 1, 2], "translation": by }));
    model
}

const POINTS: [[f64; 2]; 4] = [[0.5, 0.5], [1.9, -1.9], [2.1, 0.0], [-5.0, 3.0]];

/// What a light sees of the same points.
fn seen(scene: &Scene, by: [f64; 3]) -> [bool; 4] {
    let truth = dpsm::truth::Truth::from(scene);
    let light = scene.lights[0].position.as_dvec3();
    POINTS.map(|[x, z]| {
        let point = DVec3::from(by) + dvec3(x, 1e-3, z) - scene.origin;
        truth.sees(light, point, None, 0.0)
    })
}

#[test]
fn scenes_far_from_their_origin_cast_the_shadows_of_near_ones() {
    let near = moved([0.0; 3]).read("near.glb");
    assert_eq!(near.origin, DVec3::ZERO);
    assert_eq!(lit(&near, POINTS), [false, false, true, true]);
    for by in [
        [6_378_137.25, 0.0, 0.0],
        [-2_694_892.5, -4_297_405.125, 3_854_579.75],
        [1e9, 1.0, -3e8],
        [1e12, -1e12, 2.5e11],
        [500.0, 0.0, 300.0],
    ] {
        let scene = moved(by).read("far.glb");
        assert_ne!(scene.origin, DVec3::ZERO);
        assert_eq!(scene.warnings, [""; 0]);
        assert_eq!(seen(&scene, by), [false, false, true, true], "{by:?}");
        // as near to the light as f64 has numbers
        let light = scene.lights[0].position.as_dvec3() + scene.origin;
        let expected = DVec3::from(by) + dvec3(0.0, 4.0, 0.0);
        assert!(light.distance(expected) <= 2e-16 * expected.length(), "{light} {expected}");
        // the same shape to the bit, as all of it is a multiple of a 256th
        let moved = |scene: &Scene| -> Vec<DVec3> {
            let corners = scene.meshes.iter().flat_map(|mesh| &mesh.positions);
            corners.map(|p| (*p - scene.lights[0].position).as_dvec3()).collect()
        };
        if by[0].abs() < 1e11 {
            assert_eq!(moved(&scene), moved(&near), "{by:?}");
        }
    }
}

#[test]
fn ordinary_scenes_stay_where_they_are() {
    for by in [[0.0; 3], [100.0, 0.0, 0.0], [-64.0, 64.0, 127.0]] {
        let scene = moved(by).read("ordinary.glb");
        assert_eq!(scene.origin, DVec3::ZERO, "{by:?}");
        assert_eq!(seen(&scene, by), [false, false, true, true], "{by:?}");
    }
    // without a light, and with a triangle right through the middle
    let floor = "v 3 0 3\nv 5 0 3\nv 5 0 5\nf 1 2 3\n";
    assert_eq!(read(&file("no_light.obj", floor)).origin, DVec3::ZERO);
}

#[test]
fn origin_moves_from_64_times_the_distance_of_the_nearest_triangle_on() {
    // the lid is 2 below the light
    for (x, moves) in [(127.0, false), (128.0, false), (128.5, true), (129.0, true)] {
        let scene = moved([x, 0.0, 0.0]).read("limit.glb");
        assert_eq!(scene.origin != DVec3::ZERO, moves, "{x}");
    }
    // x, y and z alike, of either sign
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let mut by = [0.0; 3];
            by[axis] = 140.0 * sign;
            assert_ne!(moved(by).read("axis.glb").origin, DVec3::ZERO, "{by:?}");
        }
    }
}

#[test]
fn origin_is_a_short_number_and_the_light_lies_near_it() {
    let by = [6_378_137.123_456_789, 0.1, -1_234_567.891];
    let mut model = moved(by);
    model.json["nodes"][2]["translation"] = json!([0, 1.5, 0]);
    let scene = model.read("short.glb");
    // 2.5 from the lid: whole multiples of 2
    assert_eq!(scene.origin, dvec3(6_378_138.0, 4.0, -1_234_568.0));
    assert!(scene.lights[0].position.abs().max_element() <= 1.0);
    // where the light almost touches a triangle, 33 bits are left
    let mut model = moved(by);
    model.json["nodes"][2]["translation"] = json!([0, 3.999_999_9, 0]);
    let scene = model.read("touching.glb");
    let step = 2.0_f64.powi(22 - 33);
    let offset = scene.lights[0].position.as_dvec3() / step;
    assert!(offset.abs().max_element() <= 0.5, "{offset}");
    assert_eq!((scene.origin / step).fract(), DVec3::ZERO);
    assert_ne!((scene.origin * 16.0).fract(), DVec3::ZERO);
}

#[test]
fn point_that_is_asked_for_decides_and_not_the_files_light() {
    let near = moved([0.0; 3]).glb();
    let path = file("around.glb", near);
    let around = |point: Option<DVec3>| {
        let options = Options { around: point, ..Options::default() };
        open(path.to_str().unwrap(), &options).unwrap()
    };
    // beside the lid's edge, by a thousandth
    let corner = dvec3(1.001, 2.0, 0.0);
    let scene = around(Some(corner));
    assert_ne!(scene.origin, DVec3::ZERO);
    assert!((scene.origin - corner).abs().max_element() <= 0.0005);
    assert_eq!(around(Some(dvec3(3.0, 9.0, 0.0))).origin, DVec3::ZERO);
    for odd in [DVec3::NAN, dvec3(f64::INFINITY, 0.0, 0.0)] {
        assert_eq!(around(Some(odd)).origin, DVec3::ZERO);
    }
    assert_eq!(around(None).origin, DVec3::ZERO);
    // what is no point leaves the decision to the light
    let path = file("around_far.glb", moved([6_378_137.0, 0.0, 0.0]).glb());
    let options = Options { around: Some(DVec3::NAN), ..Options::default() };
    assert_ne!(open(path.to_str().unwrap(), &options).unwrap().origin, DVec3::ZERO);
}

#[test]
fn coordinates_of_obj_files_are_read_in_f64() {
    let far = |x: f64, y: f64| {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let line = |(dx, dy): (f64, f64)| format!("v {} 12.25 {}\n", x + dx, y + dy);
        corners.map(line).concat()
    };
    // as UTM has them: half a metre would be lost
    let (x, y) = (4_429_529.812_5, 5_820_128.437_5);
    let scene = read(&file("utm.obj", format!("{}f 1 2 3 4\n", far(x, y))));
    assert_valid(&scene);
    assert_ne!(scene.origin, DVec3::ZERO);
    let bounds = scene.bounds();
    assert_eq!(bounds.min.as_dvec3() + scene.origin, dvec3(x, 12.25, y));
    assert_eq!(bounds.extent(), glam::vec3(1.0, 0.0, 1.0));
    assert_eq!(scene.warnings, [""; 0]);
    let cut = read(&file("polygon_utm.obj", format!("{}f 1 2 3 4 1\n", far(x, y))));
    assert_valid(&cut);
}

#[test]
fn what_f32_cannot_hold_is_dropped_as_what_is_not_finite() {
    let scene = read(&file(
        "huge.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1e300 0 0\nv 1e39 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n",
    ));
    assert_valid(&scene);
    assert_eq!(scene.triangle_count(), 1);
    let mut model = Model::new();
    model.json["nodes"][1]["translation"] = json!([1e300, 0, 0]);
    let scene = model.read("huge_light.glb");
    assert_eq!((scene.origin, scene.lights.len()), (DVec3::ZERO, 0));
    let mut model = Model::new();
    let light = model.json["nodes"][1].clone();
    model.node(light);
    model.json["nodes"][1]["translation"] = json!([0, 4, 0]);
    model.json["nodes"][2]["translation"] = json!([1e300, 0, 0]);
    let scene = model.read("second_light.glb");
    assert_eq!(scene.lights.len(), 1);
    assert_eq!(scene.warnings, ["1 lights beyond the range of numbers skipped"]);
}

#[test]
fn cameras_move_with_the_scene() {
    let by = [6_378_137.0, 0.0, 0.0];
    let mut model = moved(by);
    model.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1.0 } }]);
    model.json["nodes"][3]["camera"] = json!(0);
    let scene = model.read("camera_far.glb");
    let camera = scene.camera.unwrap();
    assert_eq!(camera.eye.as_dvec3() + scene.origin, DVec3::from(by));
    assert_eq!(camera.target - camera.eye, glam::Vec3::NEG_Z);
}
