//! Input that is wrong: none hangs, panics, or stores what is not a depth.

use dpsm::gpu::GpuError;
use dpsm::render::{Frame, FrameError, Level, Method, Passes, Settings};
use dpsm::scalar::maps::DepthMaps;
use dpsm::scene::Mesh;
use dpsm::{cpu, gpu};
use glam::{Vec3, vec3};

use crate::support::{CAMERA, built_in, device, frame, is_whole, mesh, scene_of, settings, stored};

const METHODS: [Method; 5] =
    [Method::Vertex, Method::FragmentDepth, Method::Tessellated, Method::Exact, Method::Refined];

fn small(method: Method) -> Settings {
    Settings { size: 64, method, level: Level::Mesh(4), ..settings() }
}

/// The maps of adapter and ports, each of them whole.
fn maps(frame: &Frame) -> Vec<DepthMaps> {
    let adapter = device().map(|device| gpu::make_maps(&device, frame).unwrap());
    let all: Vec<_> = adapter.into_iter().chain([cpu::make_maps(frame).unwrap()]).collect();
    assert!(all.iter().all(is_whole), "{:?}", frame.settings.method);
    all
}

/// A room, and a mesh in it that is changed past every check.
fn patched(method: Method, change: impl Fn(&mut Frame)) -> Frame {
    let mut scene = built_in("seam-box");
    let position = scene.default_light().position;
    let corners = vec![vec3(-0.5, 1.0, 1.0), vec3(0.5, 1.0, 1.0), vec3(0.0, 1.6, 1.2)];
    scene.meshes.push(mesh(corners, vec![[0, 1, 2]]));
    let mut frame = frame(&scene, position, small(method));
    change(&mut frame);
    frame
}

#[test]
fn vertices_that_are_no_numbers_are_refused_by_name_and_else_not_drawn() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let triangle = mesh(vec![Vec3::X, vec3(1.0, bad, 0.0), Vec3::Z], vec![[0, 1, 2]]);
        let scene = scene_of(vec![triangle]);
        let made = Frame::new(&scene, Vec3::ZERO, Vec3::NEG_Y, false, &CAMERA, settings());
        assert!(matches!(made, Err(FrameError::Vertex { index: 1, .. })), "{made:?}");
        for method in METHODS {
            let whole = patched(method, |_| ());
            let broken = patched(method, |frame| {
                let last = frame.vertices.len() - 1;
                frame.vertices[last].position.y = bad;
            });
            let without = patched(method, |frame| {
                let last = frame.triangles.len() - 1;
                frame.triangles[last] = [0; 3];
            });
            for ((broken, without), whole) in
                maps(&broken).iter().zip(&maps(&without)).zip(&maps(&whole))
            {
                assert_eq!(broken, without, "{method:?} {bad}");
                assert_ne!(broken, whole);
            }
        }
    }
}

#[test]
fn indices_out_of_range_are_refused_by_name_and_else_harmless() {
    let scene = scene_of(vec![mesh(vec![Vec3::X, Vec3::Y, Vec3::Z], vec![[0, 1, 3]])]);
    let made = Frame::new(&scene, Vec3::ZERO, Vec3::NEG_Y, false, &CAMERA, settings());
    assert!(matches!(made, Err(FrameError::Index { index: 3, .. })), "{made:?}");
    for method in METHODS {
        for index in [1 << 20, u32::MAX] {
            let frame = patched(method, |frame| {
                let last = frame.triangles.len() - 1;
                frame.triangles[last][1] = index;
            });
            // an adapter may read any vertex in its place, but the room is there
            for maps in maps(&frame) {
                assert!(stored(&maps) > 64 * 64 / 2, "{method:?}");
            }
        }
    }
}

#[test]
fn triangles_without_area_or_seen_edge_on_store_nothing() {
    let edge_on = vec![vec3(0.2, 0.0, 1.0), vec3(0.4, 0.0, 2.0), vec3(0.8, 0.0, 1.5)];
    for corners in [vec![Vec3::X; 3], vec![Vec3::X, Vec3::Y, (Vec3::X + Vec3::Y) / 2.0], edge_on] {
        let scene = scene_of(vec![mesh(corners, vec![[0, 1, 2], [0, 0, 1], [2, 2, 2]])]);
        for method in [Method::Exact, Method::Refined] {
            let frame = frame(&scene, Vec3::ZERO, small(method));
            assert!(maps(&frame).iter().all(|maps| stored(maps) == 0), "{method:?}");
        }
        for method in METHODS {
            maps(&frame(&scene, Vec3::ZERO, small(method)));
        }
    }
}

#[test]
fn lights_on_a_vertex_an_edge_or_a_wall_give_whole_maps() {
    let scene = built_in("seam-box");
    let corner = scene.meshes[0].positions[0];
    let other = scene.meshes[0].positions[1];
    let far = scene.meshes[0].positions[3];
    for position in [corner, (corner + other) / 2.0, (corner + other + far) / 3.0] {
        for method in METHODS {
            let frame = frame(&scene, position, small(method));
            for maps in maps(&frame) {
                assert!(stored(&maps) > 0, "{method:?} at {position}");
            }
        }
    }
}

#[test]
fn coincident_faces_store_what_one_does() {
    let square = |count: usize| -> Mesh {
        let at = |x, z| vec3(x, -1.0, z);
        let corners = vec![at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
        // the second time turned, and begun elsewhere
        let triangles = [[0, 1, 2], [0, 2, 3], [2, 1, 0], [2, 0, 3]];
        mesh(corners, triangles[..2 * count].to_vec())
    };
    for method in [Method::Exact, Method::FragmentDepth] {
        let [one, two] = [1, 2].map(|count| {
            maps(&frame(&scene_of(vec![square(count)]), vec3(0.1, 0.0, 0.2), small(method)))
        });
        for (one, two) in one.iter().zip(&two) {
            let apart = one.depths.iter().zip(&two.depths).map(|(a, b)| (a - b).abs());
            // the order of corners may move a depth by its bound, 40 eps / cos(72 degrees)
            assert!(apart.fold(0.0, f32::max) <= 130.0 * f32::EPSILON, "{method:?}");
            assert!(stored(one) > 64);
        }
    }
}

#[test]
fn nothing_at_all_gives_empty_maps() {
    for method in METHODS {
        for scene in [scene_of(Vec::new()), scene_of(vec![mesh(Vec::new(), Vec::new())])] {
            let maps = maps(&frame(&scene, Vec3::ZERO, small(method)));
            assert!(maps.iter().all(|maps| stored(maps) == 0));
        }
    }
}

#[test]
fn level_too_large_is_refused_by_adapter_and_ports() {
    let mut settings = small(Method::Tessellated);
    settings.level = Level::Constant(1 << 20);
    let frame = frame(&built_in("seam-box"), vec3(0.0, 2.0, 0.0), settings);
    assert!(matches!(cpu::make_maps(&frame), Err(FrameError::Level { level: 1048576, .. })));
    let Some(device) = device() else { return };
    let refused = gpu::make_maps(&device, &frame).unwrap_err().to_string();
    assert!(refused.contains("level 1048576") && refused.contains("--level"), "{refused}");
}

#[test]
fn multiview_is_refused_by_the_cube() {
    let scene = built_in("seam-box");
    let position = scene.default_light().position;
    for method in [Method::Cube] {
        let passes = Passes::Multiview;
        let settings = Settings { passes, ..small(method) };
        let made = Frame::new(&scene, position, Vec3::NEG_Y, false, &CAMERA, settings).unwrap_err();
        let message = made.to_string();
        assert!(message.contains("multiview") && message.contains("--passes"), "{message}");
        // and where the settings were changed past that check
        let mut frame = frame(&scene, position, small(method));
        frame.settings.passes = passes;
        let Some(device) = device() else { continue };
        match gpu::make_maps(&device, &frame) {
            Err(GpuError::Frame(error)) => assert_eq!(error, made),
            other => panic!("{other:?}"),
        }
    }
}
