//! The built-in scenes.

use std::collections::BTreeSet;

use dpsm::scene::{Mesh, Options, Scene, SceneError, crowd, dozen, open};
use dpsm::truth::{Ray, Truth};
use glam::{Vec2, Vec3};

use crate::{
    OPEN, built_in, corners, enclosures, every_built_in, every_room, hit, is_wall, is_watertight,
    volume,
};

#[test]
fn walls_are_grids_of_as_many_quads_as_asked() {
    let count = |scene: &Scene| -> usize {
        let walls = scene.meshes.iter().filter(|mesh| is_wall(mesh));
        walls.map(|mesh| mesh.triangles.len()).sum()
    };
    for name in every_room().map(|scene| scene.name) {
        let name = name.as_str();
        let sides = if name == "cornell" { 5 } else { 6 };
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
        for name in every_room().map(|scene| scene.name).filter(|name| name != "cornell") {
            let scene = built_in(&name, walls);
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
    for scene in every_room() {
        let is_solid = |mesh: &&Mesh| !is_wall(mesh) && mesh.mask.is_none();
        let objects: Vec<&Mesh> = scene.meshes.iter().filter(is_solid).collect();
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
    for scene in every_room() {
        let light = scene.lights[0].position;
        assert!(scene.bounds().contains(light), "{}", scene.name);
        // the bars of the cage are 0.3 m away on purpose
        let reach = (0.1 * scene.bounds().extent().min_element()).min(0.29);
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
    for scene in every_room() {
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

/// The share of a scene's triangles that the light sees as smaller than the texel that holds them.
fn smaller_than_texels(scene: &Scene, size: u32) -> f64 {
    let light = scene.lights[0].position;
    let (mut small, mut all) = (0.0, 0.0);
    for [a, b, c] in scene.meshes.iter().filter(|mesh| mesh.name != "ground").flat_map(corners) {
        let middle = (a + b + c) / 3.0 - light;
        let direction = middle.normalize().as_dvec3();
        let area = 0.5 * (b - a).cross(c - a).as_dvec3().dot(direction).abs();
        let angle = area / f64::from(middle.length_squared());
        // seen from a light whose axis points down
        let square = (1.0 - direction.y.abs()) / (1.0 + direction.y.abs());
        let pitch = 4.0 / (f64::from(size) * (1.0 + square));
        small += f64::from(u8::from(angle < pitch * pitch));
        all += 1.0;
    }
    small / all
}

#[test]
fn triangles_of_rough_scenes_are_smaller_than_texels() {
    for (name, count) in [("hills", 204_800), ("boulder", 80_688 + 2)] {
        let scene = built_in(name, 1);
        assert_eq!(scene.triangle_count(), count, "{name}");
        assert_eq!(scene, built_in(name, 1), "the same each time");
        // all but some on slopes that face the light
        let small = smaller_than_texels(&scene, 1024);
        println!("{name}: {small}");
        assert!(small > 0.9, "{name}: {small}");
    }
}

#[test]
fn boulder_is_a_solid_that_reaches_into_the_ground() {
    let scene = built_in("boulder", 8);
    let [ground, boulder] = &scene.meshes[..] else { panic!("two meshes") };
    assert!(is_watertight([boulder]) && volume([boulder]) > 0.0);
    assert_eq!(ground.triangles.len(), 2 * 8 * 8);
    assert!(ground.positions.iter().all(|p| p.y == 0.0));
    let below = boulder.positions.iter().filter(|p| p.y < 0.0).count();
    assert!(below > 0 && below * 5 < boulder.positions.len(), "{below} vertices");
    // as far from the boulder's middle as the scene is wide
    let away = scene.lights[0].position.distance(Vec3::Y * 0.7);
    assert!((away - scene.bounds().extent().max_element()).abs() < 1e-5);
}

#[test]
fn cameras_of_rough_scenes_show_light_and_shadow() {
    for (name, shadowed) in [("hills", 0.1), ("boulder", 0.1)] {
        assert!(OPEN.contains(&name));
        let scene = built_in(name, 8);
        let truth = Truth::from(&scene);
        let (light, camera) = (scene.lights[0].position.as_dvec3(), scene.camera.unwrap());
        let eye = camera.eye.as_dvec3();
        let forward = (camera.target.as_dvec3() - eye).normalize();
        let right = forward.cross(camera.up.as_dvec3()).normalize();
        let half = f64::from(camera.vertical_fov / 2.0).tan();
        const SIDE: usize = 64;
        let (mut seen, mut dark) = (0.0, 0.0);
        for pixel in 0..SIDE * SIDE {
            let [x, y] = [pixel % SIDE, pixel / SIDE]
                .map(|i| half * ((i as f64 + 0.5) / SIDE as f64 * 2.0 - 1.0));
            let ray = Ray::new(eye, forward + right * x + right.cross(forward) * y);
            let Some(hit) = truth.first_hit(&ray) else { continue };
            let point = truth.point(&hit).unwrap();
            seen += 1.0;
            dark += f64::from(u8::from(!truth.sees(light, point, Some(hit.triangle), 0.0)));
        }
        assert!(seen > 0.6 * (SIDE * SIDE) as f64, "{name}: {seen} pixels");
        assert!(dark > shadowed * seen && dark < 0.6 * seen, "{name}: {dark} of {seen}");
    }
}

#[test]
fn box_of_the_seam_reaches_into_both_hemispheres() {
    let scene = built_in("seam-box", 1);
    let light = scene.lights[0];
    assert_eq!((light.axis, light.position), (None, scene.bounds().center()));
    let sides = |part: &str| {
        let mesh = scene.meshes.iter().find(|mesh| mesh.name.contains(part)).unwrap();
        let above = |p: &&Vec3| p.y > light.position.y;
        (mesh.positions.iter().filter(above).count(), mesh.positions.len())
    };
    assert_eq!(sides("across"), (12, 24), "half its vertices");
    assert_eq!(sides("below").0, 0);
    assert_eq!(scene.triangle_count(), 12 + 2 * 12);
}

#[test]
fn cage_has_bars_that_keep_apart_on_all_sides() {
    let scene = built_in("cage", 1);
    let light = scene.lights[0].position;
    let cage = scene.meshes.iter().find(|mesh| mesh.name == "cage").unwrap();
    // 12 triangles and 24 vertices a bar, 4 x 4 - 2 x 2 bars an axis
    assert_eq!((cage.triangles.len(), cage.positions.len()), (3 * 12 * 12, 3 * 12 * 24));
    let bars: Vec<[Vec3; 2]> = cage
        .positions
        .chunks(24)
        .map(|bar| [Vec3::min, Vec3::max].map(|f| bar.iter().copied().reduce(f).unwrap() - light))
        .collect();
    for (i, [min, max]) in bars.iter().enumerate() {
        // the nearest point of the bar, in the largest norm
        let nearest = min.max(-max).max(Vec3::ZERO).max_element();
        assert!((0.29..0.35).contains(&nearest), "bar {i} at {nearest}");
        let apart = |[low, high]: &[Vec3; 2]| low.cmpgt(*max).any() || high.cmplt(*min).any();
        assert!(bars[i + 1..].iter().all(apart), "bar {i}");
    }
    for side in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]) {
        let beyond = bars.iter().filter(|bar| bar.iter().all(|p| p.dot(side) > 0.29)).count();
        assert_eq!(beyond, 8, "{side}: four bars each way");
    }
}

#[test]
fn masks_of_the_fence_have_holes_and_their_edges_repeat() {
    let scene = built_in("fence", 1);
    let masked: Vec<&Mesh> = scene.meshes.iter().filter(|mesh| mesh.mask.is_some()).collect();
    assert_eq!(masked.iter().map(|mesh| mesh.triangles.len()).sum::<usize>(), 4);
    for mesh in masked {
        assert_eq!(mesh.texcoords.len(), mesh.positions.len());
        assert!(mesh.texcoords.iter().all(|texcoord| texcoord.max_element() <= 5.0));
        let mask = mesh.mask.as_ref().unwrap();
        assert_eq!(mask.alpha.len() as u32, mask.width * mask.height);
        let opaque = mask.alpha.iter().filter(|&&alpha| alpha == 255).count();
        let share = opaque as f32 / mask.alpha.len() as f32;
        assert!((0.2..0.8).contains(&share), "{}: {share} of it", mesh.name);
        // point symmetric, so that neighbours meet alike
        assert!(mask.alpha.iter().eq(mask.alpha.iter().rev()), "{}", mesh.name);
        let [low, high] = [Vec2::splat(0.01), Vec2::splat(0.99)];
        assert_eq!(mask.opaque(low), mask.opaque(high), "{}", mesh.name);
    }
}

#[test]
fn dozen_has_about_as_many_triangles_as_asked() {
    for asked in [1_000, 6_000, 40_000, 550_000] {
        let count = dozen(asked).triangle_count();
        // rounding a cut of n rows to a whole number changes n^2 by up to 1 / n of it
        let rows = (asked as f64 / 12.0 / 12.0).sqrt();
        assert!((count as f64 / asked as f64 - 1.0).abs() <= 1.0 / rows, "{count} of {asked}");
    }
}

#[test]
fn crowd_has_as_many_triangles_as_asked_and_its_objects_keep_apart() {
    // a twelfth of a percent and less from 15,000 on, 1.2% at 1,000
    for asked in [1_000, 1_001, 4_321, 40_000, 123_456, 600_000, 2_000_000] {
        let count = crowd(asked).triangle_count();
        assert!(count <= asked && count + 12 > asked, "{count} instead of {asked}");
    }
    assert_eq!((crowd(0), crowd(usize::MAX)), (crowd(1_000), crowd(2_000_000)));
    let scene = crowd(40_000);
    assert_eq!(scene, built_in("crowd", 1), "the same each time");
    let light = scene.lights[0].position;
    let mut balls: Vec<(Vec3, f32)> = Vec::new();
    for (part, vertices) in [("spheres", 9 * 16), ("boxes", 6 * 25)] {
        let mesh = scene.meshes.iter().find(|mesh| mesh.name == part).unwrap();
        // what is left are the smaller boxes that end the list
        for object in mesh.positions.chunks_exact(vertices) {
            let middle = object.iter().sum::<Vec3>() / vertices as f32;
            let radius = object.iter().map(|p| p.distance(middle)).fold(0.0, f32::max);
            balls.push((middle, radius));
        }
    }
    for (i, (middle, radius)) in balls.iter().enumerate() {
        assert!(middle.distance(light) > radius + 0.49);
        let apart = |(other, reach): &(Vec3, f32)| middle.distance(*other) > radius + reach;
        assert!(balls[i + 1..].iter().all(apart), "object {i}");
    }
    // evenly: each eighth of the room holds an eighth of them, within a quarter; the camera's own,
    // part of which is kept free for its view, at least half as many
    let eighth = balls.len() / 8;
    for octant in 0..8 {
        let in_octant = |(middle, _): &&(Vec3, f32)| {
            (0..3).all(|k| (middle[k] > light[k]) == (octant >> k & 1 == 1))
        };
        let count = balls.iter().filter(in_octant).count();
        let least = if octant == 7 { eighth / 2 } else { eighth * 3 / 4 };
        let most = eighth * 5 / 4;
        assert!((least..=most).contains(&count), "{count} of {eighth} in octant {octant}");
    }
}

#[test]
fn names_with_typing_errors_get_a_suggestion() {
    let message = |name| open(name, &Options::default()).unwrap_err().to_string();
    let help = "(built in: brabec-room, brabec-ceiling, cornell, seam-box, cage, fence, crowd, grazing, gaps, contact, seam-edge, hills, boulder; \
                or give the path of a .obj, .gltf or .glb file)";
    for (typed, meant) in
        [("brabec-rom", "brabec-room"), ("brabec-c", "brabec-ceiling"), ("Cornel", "cornell")]
    {
        let expected = format!("no scene is called `{typed}`; did you mean `{meant}`? {help}");
        assert_eq!(message(typed), expected);
    }
    // of a name as short as `cage`, half a word is not a typing error
    assert_eq!(message("bad"), format!("no scene is called `bad` {help}"));
    assert_eq!(message("teapot"), format!("no scene is called `teapot` {help}"));
    assert_eq!(message(""), format!("no scene is called `` {help}"));
}

#[test]
fn impossible_walls_are_an_error() {
    for walls in [0, Options::MAX_WALLS + 1] {
        let error = open("cornell", &Options { walls, ..Options::default() }).unwrap_err();
        assert!(matches!(error, SceneError::Walls { .. }));
        assert_eq!(error.to_string(), format!("walls of {walls} x {walls} quads: use 1 to 1024"));
    }
}
