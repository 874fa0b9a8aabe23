//! The built-in scenes.

use std::collections::BTreeSet;

use dpsm::scene::{Mesh, Options, Scene, SceneError, open};
use glam::Vec3;

use crate::{built_in, corners, enclosures, every_built_in, hit, is_wall, is_watertight, volume};

#[test]
fn walls_are_grids_of_as_many_quads_as_asked() {
    let count = |scene: &Scene| -> usize {
        let walls = scene.meshes.iter().filter(|mesh| is_wall(mesh));
        walls.map(|mesh| mesh.triangles.len()).sum()
    };
    for (name, sides) in [("brabec-room", 6), ("brabec-ceiling", 6), ("cornell", 5)] {
        let [coarse, fine] = [1, 8].map(|walls| built_in(name, walls));
        assert_eq!(count(&coarse), sides * 2, "{name}");
        assert_eq!(count(&fine), sides * 2 * 64, "{name}");
        let objects = coarse.triangle_count() - count(&coarse);
        assert_eq!(fine.triangle_count() - count(&fine), objects, "{name}");
        assert_eq!(fine.triangles().count(), fine.triangle_count(), "{name}");
    }
    assert_eq!(built_in("cornell", 1).triangle_count(), 5 * 2 + 2 * 12);
}

#[test]
fn closed_room_is_watertight_and_faces_inward() {
    for walls in [1, 3, 8] {
        for name in ["brabec-room", "brabec-ceiling"] {
            let scene = built_in(name, walls);
            let room: Vec<&Mesh> = scene.meshes.iter().filter(|mesh| is_wall(mesh)).collect();
            assert_eq!(room.len(), 6);
            assert!(is_watertight(room.iter().copied()), "{name}, walls {walls}");
            let inside = -scene.bounds().extent().element_product();
            assert!((volume(room) as f32 / inside - 1.0).abs() < 1e-5, "{name}, walls {walls}");
        }
    }
}

#[test]
fn objects_are_watertight_solids_that_face_outward_and_keep_apart() {
    for scene in every_built_in() {
        let objects: Vec<&Mesh> = scene.meshes.iter().filter(|mesh| !is_wall(mesh)).collect();
        assert!(objects.len() >= 2);
        for mesh in objects {
            assert!(is_watertight([mesh]), "{}: {}", scene.name, mesh.name);
            assert!(volume([mesh]) > 0.0, "{}: {}", scene.name, mesh.name);
        }
    }
    let room = built_in("brabec-room", 1);
    let objects: Vec<&Mesh> = room.meshes.iter().filter(|mesh| !is_wall(mesh)).collect();
    for (i, one) in objects.iter().enumerate() {
        for other in &objects[i + 1..] {
            let into =
                |from: &Mesh, to: &Mesh| to.positions.iter().any(|p| enclosures(from, *p) != 0);
            assert!(!into(one, other) && !into(other, one), "{} and {}", one.name, other.name);
        }
    }
}

#[test]
fn normals_are_unit_and_agree_with_the_winding() {
    for scene in every_built_in() {
        for mesh in &scene.meshes {
            assert_eq!(mesh.normals.len(), mesh.positions.len());
            assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-6));
            for (triangle, [a, b, c]) in mesh.triangles.iter().zip(corners(mesh)) {
                let face = (b - a).cross(c - a);
                assert!(face.length() > 0.0, "{}", mesh.name);
                let agrees = |i: &u32| mesh.normals[*i as usize].dot(face) > 0.0;
                assert!(triangle.iter().all(agrees), "{}: {}", scene.name, mesh.name);
            }
        }
    }
}

#[test]
fn no_light_is_inside_or_near_an_object() {
    for scene in every_built_in() {
        let light = scene.lights[0].position;
        assert!(scene.bounds().contains(light), "{}", scene.name);
        let reach = 0.1 * scene.bounds().extent().min_element();
        for mesh in scene.meshes.iter().filter(|mesh| !is_wall(mesh)) {
            assert_eq!(enclosures(mesh, light), 0, "{}: {}", scene.name, mesh.name);
            let near = mesh.positions.iter().any(|p| p.distance(light) < reach);
            assert!(!near, "{}: {}", scene.name, mesh.name);
        }
    }
}

#[test]
fn lights_are_the_papers_and_both_hemispheres_see_casters() {
    let room = built_in("brabec-room", 8);
    let light = room.lights[0];
    assert_eq!((light.position, light.axis), (room.bounds().center(), None));
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for side in [axis, -axis] {
            let on_side =
                |mesh: &&Mesh| mesh.positions.iter().all(|p| (*p - light.position).dot(side) > 0.0);
            let objects = room.meshes.iter().filter(|mesh| !is_wall(mesh));
            assert!(objects.filter(on_side).count() >= 2, "{side}");
        }
    }
    let ceiling = built_in("brabec-ceiling", 8);
    let light = ceiling.lights[0];
    assert_eq!(light.axis, Some(Vec3::NEG_Y));
    let below = ceiling.bounds().max.y - light.position.y;
    assert!(below > 0.0 && below < 0.2);
    assert_eq!(built_in("cornell", 8).lights[0].axis, None);
}

#[test]
fn built_in_cameras_show_floor_walls_objects_and_shadows() {
    for scene in every_built_in() {
        let camera = scene.camera.unwrap();
        let light = scene.lights[0].position;
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let half = (camera.vertical_fov / 2.0).tan();
        let (mut seen, mut shadowed) = (BTreeSet::new(), 0);
        const SIDE: i32 = 16;
        for pixel in 0..SIDE * SIDE {
            let [x, y] = [pixel % SIDE, pixel / SIDE]
                .map(|i| half * ((i as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0));
            let ray = forward + right * x + right.cross(forward) * y;
            let Some((t, mesh)) = hit(&scene, camera.eye, ray, 0.0) else {
                continue;
            };
            seen.insert(&mesh.name);
            let to_light = light - (camera.eye + ray * t as f32);
            let blocker = hit(&scene, light - to_light, to_light, 1e-4);
            shadowed += i32::from(is_wall(mesh) && blocker.is_some_and(|(t, _)| t < 0.999));
        }
        let count = |part| seen.iter().filter(|name| name.contains(part)).count();
        assert_eq!(count("floor"), 1, "{}", scene.name);
        assert!(count("wall") >= 2, "{}: {seen:?}", scene.name);
        assert!(seen.len() >= 2 + 1 + 2, "{}: {seen:?}", scene.name);
        assert!(shadowed * 50 > SIDE * SIDE, "{}: {shadowed} pixels", scene.name);
    }
}

#[test]
fn names_with_typing_errors_get_a_suggestion() {
    let message = |name| open(name, &Options::default()).unwrap_err().to_string();
    let help = "(built in: brabec-room, brabec-ceiling, cornell; \
                or give the path of a .obj, .gltf or .glb file)";
    for (typed, meant) in
        [("brabec-rom", "brabec-room"), ("brabec-c", "brabec-ceiling"), ("Cornel", "cornell")]
    {
        let expected = format!("no scene is called `{typed}`; did you mean `{meant}`? {help}");
        assert_eq!(message(typed), expected);
    }
    assert_eq!(message("teapot"), format!("no scene is called `teapot` {help}"));
    assert_eq!(message(""), format!("no scene is called `` {help}"));
}

#[test]
fn impossible_walls_are_an_error() {
    for walls in [0, Options::MAX_WALLS + 1] {
        let error = open("cornell", &Options { walls }).unwrap_err();
        assert!(matches!(error, SceneError::Walls { .. }));
        assert_eq!(error.to_string(), format!("walls of {walls} x {walls} quads: use 1 to 1024"));
    }
}
