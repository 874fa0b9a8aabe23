//! What is left out of the maps, and that nothing is missing.

use dpsm::measure::{Bench, truth_of};
use dpsm::plan::casters::{Reason, casters};
use dpsm::plan::{Request, plan};
use dpsm::render::{Casting, Frame, Method, Settings, View};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scene::{BUILT_IN, Scene};
use dpsm::truth::Truth;
use fastrand::Rng;
use glam::{Vec3, vec3};

use super::{built_in, floor_and_board, planned, square, target};

fn names(scene: &Scene, left_out: &[Option<Reason>]) -> Vec<String> {
    let out = scene.meshes.iter().zip(left_out).filter(|(_, reason)| reason.is_some());
    out.map(|(mesh, _)| mesh.name.clone()).collect()
}

#[test]
fn walls_of_a_convex_room_are_left_out_and_nothing_else() {
    let scene = built_in("brabec-room");
    let found = casters(&scene, &[], &[scene.default_light().position], &[]);
    let walls: Vec<String> = scene.meshes[..6].iter().map(|mesh| mesh.name.clone()).collect();
    assert_eq!(names(&scene, &found.left_out), walls);
}

#[test]
fn no_ray_to_a_receiver_meets_what_is_left_out() {
    let mut rng = Rng::with_seed(3);
    let mut rays = 0;
    let mut counted = 0;
    for (name, _) in BUILT_IN {
        let scene = built_in(name);
        let camera = scene.camera.unwrap();
        for _ in 0..4 {
            let bounds = scene.bounds();
            let random = vec3(rng.f32(), rng.f32(), rng.f32());
            let light = bounds.min + bounds.extent() * (0.05 + 0.9 * random);
            let settings = Settings::default();
            let view = View::new(&camera, settings.image).unwrap();
            let left_out = casters(&scene, &[], &[light], &[view]).left_out;
            counted += left_out.iter().flatten().count();
            let frame = Frame::new(&scene, light, Vec3::NEG_Y, false, &camera, settings).unwrap();
            let truth = truth_of(&frame);
            let empty = DepthMaps::empty(1, 2, Sampling::Nearest);
            let points = Bench::new(&frame, &empty, &truth).points_from_camera(2_000, rng.u64(..));
            // only what is left out, at the places of the whole frame's triangles
            let casting = left_out.iter().map(|reason| match reason {
                Some(_) => Casting::By(Method::Refined),
                None => Casting::Unseen,
            });
            let alone = Settings { casting: casting.collect(), ..Settings::default() };
            let alone = Frame::new(&scene, light, Vec3::NEG_Y, false, &camera, alone).unwrap();
            let drawn = alone.drawn();
            let corners = |range: &std::ops::Range<u32>| {
                alone.triangles[range.start as usize..range.end as usize].to_vec()
            };
            let positions: Vec<_> =
                alone.vertices.iter().map(|vertex| vertex.position.as_dvec3()).collect();
            let triangles = drawn.iter().flat_map(|(range, _)| corners(range));
            let walls = Truth::new(&positions, triangles);
            for point in points {
                let hit = walls.occluder(light.as_dvec3(), point.world, None, 0.0);
                assert!(hit.is_none(), "{name}: light {light}, {point:?}");
                rays += 1;
            }
        }
    }
    // walls are left out in most of these, so the rays did try something
    assert!(rays > 50_000 && counted > 100, "{rays} rays, {counted} meshes left out");
}

#[test]
fn a_mesh_beyond_all_that_shows_is_left_out() {
    let mut scene = floor_and_board(None);
    // far above, and out of the camera's sight
    scene.meshes.push(square("cloud", 1.0, 40.0));
    let camera = View::new(&scene.camera.unwrap(), [960, 720]).unwrap();
    let light = scene.default_light().position;
    let found = casters(&scene, &[], &[light], &[camera]).left_out;
    // the floor bounds all that shows; the board does not: the floor is behind it
    assert_eq!(found, [Some(Reason::Bounds), None, Some(Reason::Beyond)]);
    // where all surfaces count it is a receiver itself, and all that shows lies below it
    assert_eq!(casters(&scene, &[], &[light], &[]).left_out[2], Some(Reason::Bounds));
}

#[test]
fn a_path_leaves_out_what_each_position_leaves_out() {
    let mut scene = floor_and_board(None);
    scene.meshes.push(square("shelf", 1.0, 3.0));
    let [below, above] = [vec3(0.1, 2.0, 0.2), vec3(0.1, 5.0, 0.2)];
    let out = |lights: &[Vec3]| names(&scene, &casters(&scene, &[], lights, &[]).left_out);
    assert_eq!(out(&[below]), ["floor", "shelf"]);
    assert_eq!(out(&[above]), ["floor"]);
    assert_eq!(out(&[below, above]), ["floor"]);
}

#[test]
fn spheres_hold_every_caster_that_is_kept_and_every_receiver() {
    for (name, _) in BUILT_IN {
        let scene = built_in(name);
        let light = scene.default_light().position;
        let found = casters(&scene, &[], &[light], &[]);
        for (mesh, reason) in scene.meshes.iter().zip(&found.left_out) {
            for position in &mesh.positions {
                let distance = position.distance(light);
                assert!(distance < found.far, "{name}: {}", mesh.name);
                assert!(reason.is_some() || distance > found.near, "{name}: {}", mesh.name);
            }
        }
    }
}

#[test]
fn one_map_is_enough_where_nothing_that_shows_is_behind_the_light() {
    let plan = planned(&floor_and_board(None), "0.5deg");
    assert_eq!(plan.hemispheres, 1);
    let why = &plan.choices.iter().find(|choice| choice.what == "hemispheres").unwrap().why;
    assert!(why.contains("back hemisphere left out: no receiver that shows is in it"), "{why}");
    // a lid over the light that the camera sees needs the other map
    let with_lid = planned(&floor_and_board(Some(2.3)), "0.5deg");
    assert_eq!(with_lid.hemispheres, 2, "{}", with_lid.explanation());
}

#[test]
fn a_hemispherical_light_keeps_its_axis() {
    let scene = built_in("brabec-ceiling");
    let plan = planned(&scene, "0.5deg");
    assert_eq!((plan.hemispheres, plan.axis), (1, [0.0, -1.0, 0.0]));
}

#[test]
fn a_path_is_planned_for_all_of_its_positions() {
    let scene = built_in("brabec-room");
    let lights = [vec3(0.0, 2.0, 0.0), vec3(1.0, 3.0, -1.0), vec3(-1.2, 1.0, 1.0)];
    let request = |lights: &[Vec3]| Request {
        lights: lights.to_vec(),
        camera: scene.camera,
        ..Request::new(&scene, target("0.01"))
    };
    let whole = plan(&request(&lights)).unwrap();
    assert!(whole.meets && whole.lights.len() == 3);
    for light in lights {
        let one = plan(&request(&[light])).unwrap();
        assert!(whole.near <= one.near && whole.far >= one.far);
        assert!(one.left_out.len() >= whole.left_out.len());
    }
}
