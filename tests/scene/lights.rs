//! Cones and ranges of a glTF's lights.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use dpsm::scene::{Cone, Light};
use glam::Vec3;
use serde_json::{Value, json};

use crate::model::Model;

/// The light of a file, and the warnings.
fn light(light: Value) -> (Light, Vec<String>) {
    let mut model = Model::new();
    model.json["extensions"]["KHR_lights_punctual"]["lights"][0] = light;
    // looks down, and a scale changes neither angles nor range
    let half = std::f64::consts::FRAC_1_SQRT_2;
    model.json["nodes"][1]["rotation"] = json!([-half, 0.0, 0.0, half]);
    model.json["nodes"][1]["scale"] = json!([2, 2, 2]);
    let scene = model.read("light.glb");
    (scene.lights[0], scene.warnings)
}

#[test]
fn cones_and_ranges_are_read_whatever_the_nodes_scale() {
    let spot = json!({ "innerConeAngle": 0.1, "outerConeAngle": 0.35 });
    let (found, warnings) = light(json!({ "type": "spot", "spot": spot, "range": 7.5 }));
    assert!(found.axis.unwrap().distance(Vec3::NEG_Y) < 1e-6);
    assert_eq!(found.cone, Some(Cone { inner: 0.1, outer: 0.35 }));
    assert_eq!(found.range, Some(7.5));
    assert_eq!(warnings, [""; 0]);
    let (point, _) = light(json!({ "type": "point", "range": 3, "spot": { "outerConeAngle": 1 } }));
    assert_eq!((point.axis, point.cone, point.range), (None, None, Some(3.0)));
}

#[test]
fn angles_that_are_left_out_are_none_and_45_degrees() {
    for spot in [json!(null), json!({}), json!({ "innerConeAngle": 0 })] {
        let (found, warnings) = light(json!({ "type": "spot", "spot": spot }));
        assert_eq!(found.cone, Some(Cone { inner: 0.0, outer: FRAC_PI_4 }));
        assert_eq!((found.range, warnings.len()), (None, 0));
    }
    let spot = json!({ "outerConeAngle": 0.5 });
    let (found, _) = light(json!({ "type": "spot", "spot": spot }));
    assert_eq!(found.cone, Some(Cone { inner: 0.0, outer: 0.5 }));
}

#[test]
fn angles_of_a_hard_edge_or_a_whole_hemisphere_are_no_fault() {
    for (inner, outer) in
        [(0.5, 0.5), (0.0, std::f64::consts::FRAC_PI_2), (1.0, f64::from(FRAC_PI_2))]
    {
        let spot = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
        let (found, warnings) = light(json!({ "type": "spot", "spot": spot }));
        let cone = found.cone.unwrap();
        assert_eq!(warnings, [""; 0], "{inner} {outer}");
        assert!(cone.inner < cone.outer && cone.outer <= FRAC_PI_2, "{cone:?}");
        assert!((f64::from(cone.inner) - inner).abs() < 1e-7, "{cone:?}");
        assert!((f64::from(cone.outer) - outer).abs() < 2e-7, "{cone:?}");
    }
}

#[test]
fn impossible_angles_and_ranges_are_cut_with_a_warning() {
    for (inner, outer, expected) in [
        (0.0, 3.0, Cone { inner: 0.0, outer: FRAC_PI_2 }),
        (-1.0, 0.5, Cone { inner: 0.0, outer: 0.5 }),
        (0.6, 0.5, Cone { inner: 0.5_f32.next_down(), outer: 0.5 }),
        (0.0, 0.0, Cone { inner: 0.0, outer: FRAC_PI_4 }),
        (0.2, -0.5, Cone { inner: 0.2, outer: FRAC_PI_4 }),
    ] {
        let spot = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
        let (found, warnings) = light(json!({ "type": "spot", "spot": spot }));
        assert_eq!(found.cone, Some(expected), "{inner} {outer}");
        let warning = format!("a spot's cone of {inner} to {outer} rad is not possible: cut");
        assert_eq!(warnings, [warning]);
    }
    for range in [0.0, -2.0] {
        let (found, warnings) = light(json!({ "type": "point", "range": range }));
        assert_eq!(found.range, None);
        let warning = format!("a light's range of {range} is not possible: without limit");
        assert_eq!(warnings, [warning]);
    }
    // beyond f32 is without limit
    assert_eq!(
        light(json!({ "type": "point", "range": 1e40 })),
        (Light { range: None, ..light(json!({ "type": "point" })).0 }, Vec::new(),)
    );
}
