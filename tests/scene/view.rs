//! The light and camera that a scene gets when it has none.

use std::f32::consts::PI;

use dpsm::scene::{Camera, Mesh, Scene};
use glam::{Vec3, vec3};

use crate::{built_in, free_ahead, hit, shared};

/// A closed sphere of unit radius around a point, seen from outside or, turned over, from inside.
fn ball(center: Vec3, inside_out: bool) -> Scene {
    const SIDES: u32 = 24;
    let at = |ring: u32, side: u32| {
        let [polar, around] =
            [(ring, SIDES), (2 * side, SIDES)].map(|(step, of)| PI * step as f32 / of as f32);
        vec3(polar.sin() * around.sin(), polar.cos(), polar.sin() * around.cos())
    };
    let index = |ring: u32, side: u32| ring * SIDES + side % SIDES;
    let normals: Vec<Vec3> =
        (0..=SIDES).flat_map(|ring| (0..SIDES).map(move |side| at(ring, side))).collect();
    let quads = (0..SIDES).flat_map(|ring| (0..SIDES).map(move |side| (ring, side)));
    let triangles = quads.flat_map(|(ring, side)| {
        let [a, b] = [index(ring, side), index(ring, side + 1)];
        let [c, d] = [index(ring + 1, side), index(ring + 1, side + 1)];
        [[a, c, d], [a, d, b]].map(|[a, b, c]| if inside_out { [a, c, b] } else { [a, b, c] })
    });
    let mesh = Mesh {
        name: "ball".into(),
        positions: normals.iter().map(|normal| *normal + center).collect(),
        triangles: triangles.collect(),
        normals,
        albedo: Vec3::ONE,
        ..Mesh::default()
    };
    let (origin, lights, camera, warnings) = Default::default();
    Scene { name: "ball".into(), origin, meshes: vec![mesh], lights, camera, warnings }
}

/// Where a point is in a square image, from -1 to 1; the distance along the view comes last.
fn projected(camera: &Camera, point: Vec3) -> Vec3 {
    let forward = (camera.target - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let d = point - camera.eye;
    let depth = d.dot(forward);
    let slope = (0.5 * camera.vertical_fov).tan();
    vec3(d.dot(right), d.dot(up), 0.0) / (depth * slope) + Vec3::Z * depth
}

#[test]
fn default_light_is_the_scenes_first_or_hangs_in_the_open_of_a_room() {
    let scene = built_in("brabec-room", 1);
    assert_eq!(scene.default_light(), scene.lights[0]);
    let mut scenes =
        ["brabec-room", "cornell", "cage", "fence"].map(|name| built_in(name, 1)).to_vec();
    scenes.push(ball(vec3(5.0, 6.0, 7.0), true));
    scenes.extend(shared("sponza.obj"));
    for mut scene in scenes {
        scene.lights.clear();
        let light = scene.default_light();
        assert_eq!((light.axis, light.color), (None, Vec3::ONE));
        let position = light.position;
        let (bounds, size) = (scene.bounds(), scene.bounds().extent());
        assert!(bounds.contains(position), "{}: {position}", scene.name);
        // halfway up, and nothing near
        let up = (position - bounds.min).y / size.y;
        assert!((0.3..0.7).contains(&up), "{}: {position}", scene.name);
        let near = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z]
            .map(|way| hit(&scene, position, way, 0.0).map_or(f64::INFINITY, |(metres, _)| metres));
        let nearest = near.into_iter().fold(f64::INFINITY, f64::min);
        assert!(nearest > 0.08 * f64::from(size.min_element()), "{}: {nearest}", scene.name);
        // short enough to be typed
        let text = format!("{}", position.x);
        assert!(text.len() <= 7, "{}: {text}", scene.name);
    }
}

#[test]
fn default_light_of_an_object_stands_outside_and_on_the_cameras_side() {
    let mut scenes = vec![ball(vec3(5.0, 6.0, 7.0), false)];
    for name in ["marble-bust.glb", "golf-ball.glb", "primitives.glb"] {
        scenes.extend(shared(name));
    }
    for scene in scenes {
        let light = scene.default_light().position;
        let (bounds, center) = (scene.bounds(), scene.bounds().center());
        assert!(!bounds.contains(light) && light.y > bounds.max.y, "{}: {light}", scene.name);
        let camera = scene.default_camera(light);
        let angle = (light - center).angle_between(camera.eye - center).to_degrees();
        assert!((20.0..70.0).contains(&angle), "{}: {angle} degrees", scene.name);
    }
}

#[test]
fn default_camera_outside_fills_the_image_with_the_object() {
    let mut scenes = vec![ball(vec3(5.0, 6.0, 7.0), false), ball(Vec3::ZERO, false)];
    for name in ["marble-bust.glb", "golf-ball.glb", "primitives.glb"] {
        scenes.extend(shared(name));
    }
    for scene in scenes {
        let camera = scene.default_camera(scene.default_light().position);
        let vertices = scene.meshes.iter().flat_map(|mesh| &mesh.positions);
        let seen: Vec<Vec3> = vertices.map(|point| projected(&camera, *point)).collect();
        let low = seen.iter().copied().reduce(Vec3::min).unwrap();
        let high = seen.iter().copied().reduce(Vec3::max).unwrap();
        println!("{}: {low} to {high}", scene.name);
        assert!(low.z > 0.0, "{}: behind the eye", scene.name);
        let largest = low.truncate().abs().max(high.truncate().abs());
        // nine tenths of the way to the border, and the middle is the middle
        assert!((largest.max_element() - 0.9).abs() < 0.01, "{}: {low} to {high}", scene.name);
        let middle = (low + high).truncate();
        assert!(middle.abs().max_element() < 0.02, "{}: {low} to {high}", scene.name);
    }
}

#[test]
fn default_camera_inside_stands_free_and_sees_the_light() {
    let mut scenes = vec![
        (built_in("brabec-room", 1), Vec3::new(0.0, 2.0, 0.0), 2.0),
        (built_in("brabec-room", 1), Vec3::new(1.2, 1.0, 0.6), 2.0),
    ];
    if let Some(sponza) = shared("sponza.obj") {
        let own = sponza.default_light().position;
        scenes.push((sponza.clone(), own, 10.0));
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

#[test]
fn scenes_of_a_single_point_or_of_enormous_size_have_a_light_and_a_camera() {
    for scale in [0.0, 1e-30, 1e30] {
        let mut scene = ball(Vec3::ZERO, false);
        scene.meshes[0].positions.iter_mut().for_each(|p| *p *= scale);
        let light = scene.default_light().position;
        let camera = scene.default_camera(light);
        assert!(light.is_finite() && camera.eye.is_finite() && camera.target.is_finite());
        assert_ne!(camera.eye, camera.target, "{scale}");
    }
}
