//! The light and camera that a scene gets when it has none.

use std::f32::consts::PI;

use glam::{Vec3, vec3};

use crate::{built_in, free_ahead, hit, shared};

#[test]
fn default_light_stands_above_the_geometry_or_is_the_scenes_first() {
    let mut scene = built_in("brabec-room", 1);
    assert_eq!(scene.default_light(), scene.lights[0]);
    scene.lights.clear();
    // The room is a cube of 4 m.
    assert_eq!(scene.default_light().position, vec3(0.0, 4.0 + 4.0 / 2.0, 0.0));
    assert_eq!(scene.default_light().axis, None);
}

#[test]
fn default_camera_outside_frames_the_bounding_sphere_from_the_lights_side() {
    let scene = built_in("cornell", 1);
    let bounds = scene.bounds();
    let camera = scene.default_camera(vec3(-3.0, 1.0, -2.0));
    let from_center = camera.eye - bounds.center();
    assert!(from_center.x < 0.0 && from_center.y > 0.0 && from_center.z < 0.0);
    assert_eq!(camera.target, bounds.center());
    let sphere = (bounds.extent().length() / 2.0 / from_center.length()).asin();
    assert!((2.0 * sphere - camera.vertical_fov).abs() < 1e-4);
}

#[test]
fn default_camera_inside_stands_free_and_sees_the_light() {
    let mut scenes = vec![
        (built_in("brabec-room", 1), Vec3::new(0.0, 2.0, 0.0), 2.0),
        (built_in("brabec-room", 1), Vec3::new(1.2, 1.0, 0.6), 2.0),
    ];
    if let Some(sponza) = shared("sponza.obj") {
        scenes.push((sponza, Vec3::new(0.0, 4.0, 0.0), 20.0));
    }
    for (scene, light, free) in scenes {
        let camera = scene.default_camera(light);
        assert!(scene.bounds().contains(camera.eye), "{}", scene.name);
        assert!(camera.eye.distance(light) > 0.2 * scene.bounds().extent().max_element());
        assert!(free_ahead(&scene, &camera) > free, "{}: {camera:?}", scene.name);
        let to_light = hit(&scene, camera.eye, light - camera.eye, 0.0);
        assert!(to_light.is_none_or(|(t, _)| t > 1.0), "{}", scene.name);
        // Nothing right beside the eye either: the view is no crack between two surfaces.
        let right = (camera.target - camera.eye).cross(camera.up).normalize();
        for side in [right, -right, camera.up] {
            let wall = hit(&scene, camera.eye, side, 0.0);
            assert!(wall.is_none_or(|(metres, _)| metres > 0.3), "{}", scene.name);
        }
        assert!(camera.vertical_fov > 0.0 && camera.vertical_fov < PI);
    }
}
