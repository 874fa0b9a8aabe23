//! What a frame makes of a scene: order, masks, and what is wrong with scenes made by hand.

#![cfg(feature = "scene")]

use dpsm::cpu;
use dpsm::measure::{Bench, attribute, map_error, penumbra_error, shadow_error, truth_of};
use dpsm::render::{BACKGROUND, Frame, FrameError, Method, Settings, srgb};
use dpsm::scalar::depth::dpsm_distance;
use dpsm::scalar::float::Vec2 as Uv;
use dpsm::scalar::paraboloid::dpsm_texture_to_disk;
use dpsm::scene::{Camera, Mask, Mesh, Options, Scene, open};
use dpsm::truth::{Ray, Truth};
use glam::{Vec2, Vec3, vec2, vec3};

const CAMERA: Camera =
    Camera { eye: vec3(0.0, 0.0, 3.0), target: Vec3::ZERO, up: Vec3::Y, vertical_fov: 1.0 };

fn settings() -> Settings {
    Settings { size: 256, image: [96, 96], ..Settings::default() }
}

fn scene(meshes: Vec<Mesh>) -> Scene {
    let (origin, lights, camera, warnings) = Default::default();
    Scene { name: "made".into(), origin, meshes, lights, camera, warnings }
}

fn frame(meshes: Vec<Mesh>, settings: Settings) -> Result<Frame, FrameError> {
    Frame::new(&scene(meshes), Vec3::ZERO, Vec3::NEG_Y, false, &CAMERA, settings)
}

/// A level square of half-width `half` below the light, facing it.
fn square(name: &str, height: f32, half: f32) -> Mesh {
    Mesh {
        name: name.into(),
        positions: CORNERS.map(|corner| vec3(corner.x * half, height, corner.y * half)).to_vec(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        albedo: Vec3::ONE,
        ..Mesh::default()
    }
}

const CORNERS: [Vec2; 4] = [vec2(-1.0, -1.0), vec2(-1.0, 1.0), vec2(1.0, 1.0), vec2(1.0, -1.0)];

/// The same with a checkerboard of 2 x 2: opaque where x and z have the same sign.
fn masked(name: &str, height: f32, half: f32) -> Mesh {
    let mask = Mask { width: 2, height: 2, alpha: [255, 0, 0, 255].into(), cutoff: 0.5 };
    let texcoords = CORNERS.map(|corner| corner * 0.5 + 0.5).to_vec();
    Mesh { texcoords, mask: Some(mask), ..square(name, height, half) }
}

#[test]
fn masked_meshes_come_last_and_ranges_follow() {
    let meshes = vec![
        masked("leaves", -1.0, 1.0),
        square("floor", -2.0, 2.0),
        Mesh { positions: Vec::new(), normals: Vec::new(), ..square("", 0.0, 0.0) },
        masked("grille", -1.5, 1.0),
        square("roof", 2.0, 2.0),
    ];
    let mut meshes = meshes;
    meshes[2].triangles.clear();
    let frame = frame(meshes, settings()).unwrap();
    let names: Vec<_> =
        frame.meshes.iter().map(|(name, range)| (&name[..], range.clone())).collect();
    let expected =
        [("floor", 0..2), ("", 2..2), ("roof", 2..4), ("leaves", 4..6), ("grille", 6..8)];
    assert_eq!(names, expected);
    assert_eq!((frame.first_masked(), frame.triangles.len()), (4, 8));
    assert_eq!(
        frame.masks.iter().map(|(range, _)| range.clone()).collect::<Vec<_>>(),
        [4..6, 6..8]
    );
    for triangle in 0..8 {
        assert_eq!(frame.mask(triangle).is_some(), triangle >= 4);
        for index in frame.triangles[triangle as usize] {
            let vertex = frame.vertices[index as usize];
            let height = [-2.0, 2.0, -1.0, -1.5][triangle as usize / 2];
            assert_eq!(vertex.position.y, height);
            let at = vec2(vertex.position.x, vertex.position.z) * 0.5 + 0.5;
            assert_eq!(vertex.texcoord, if triangle < 4 { Vec2::ZERO } else { at });
        }
    }
    // near the corners off the diagonal, which each triangle has one of, are the holes
    assert!(frame.opaque(4, [0.8, 0.1, 0.1]) && !frame.opaque(4, [0.1, 0.8, 0.1]));
    assert!(frame.opaque(7, [0.8, 0.1, 0.1]) && !frame.opaque(7, [0.1, 0.1, 0.8]));
    assert!(frame.opaque(0, [0.1, 0.8, 0.1]) && frame.mask(8).is_none());
}

#[test]
fn frames_without_masks_have_none_of_their_triangles_masked() {
    let frame = frame(vec![square("floor", -2.0, 2.0)], settings()).unwrap();
    assert_eq!((frame.first_masked(), frame.masks.len()), (2, 0));
}

/// The message about one mesh that is a good masked one but for a change.
fn refused(change: impl Fn(&mut Mesh)) -> String {
    let mut mesh = masked("x", -1.0, 1.0);
    change(&mut mesh);
    frame(vec![square("good", -2.0, 1.0), mesh], settings()).unwrap_err().to_string()
}

#[test]
fn meshes_that_do_not_fit_together_are_refused_by_name() {
    assert_eq!(
        refused(|mesh| mesh.triangles[1][2] = 4),
        "mesh `x`: triangle 1 has the vertex 4, but there are 4, counted from 0; give it one of those"
    );
    assert_eq!(
        refused(|mesh| mesh.normals.truncate(3)),
        "mesh `x` has 3 normals for 4 positions; give it as many"
    );
    assert!(refused(|mesh| mesh.normals.push(Vec3::X)).contains("5 normals"));
    assert_eq!(
        refused(|mesh| mesh.texcoords.clear()),
        "mesh `x` has 0 texture coordinates for 4 positions; give it as many"
    );
    let unread = |mesh: &mut Mesh| {
        mesh.mask = None;
        mesh.texcoords.pop();
    };
    assert!(refused(unread).contains("3 texture coordinates"));
    let mask = |change: fn(&mut Mask)| refused(|mesh| mesh.mask.iter_mut().for_each(change));
    assert_eq!(
        mask(|mask| mask.width = 3),
        "mesh `x`: a mask of 3 x 2 texels has 4 alphas and the cutoff 0.5; \
         give each texel one, at least one texel, and a number for the cutoff"
    );
    let nothing = |mask: &mut Mask| (mask.width, mask.alpha) = (0, [].into());
    assert!(mask(nothing).contains("0 x 2 texels"));
    assert!(mask(|mask| mask.cutoff = f32::NAN).contains("the cutoff NaN"));
    assert!(mask(|mask| (mask.width, mask.height) = (1 << 31, 1 << 31)).contains("has 4 alphas"));
    assert!(refused(|mesh| mesh.positions[1].x = f32::NAN).contains("vertex 1"));
}

#[test]
fn scene_with_an_index_out_of_range_has_no_such_triangle_for_the_truth() {
    let mut broken = masked("x", -1.0, 1.0);
    broken.triangles[0][1] = 9;
    broken.texcoords.clear();
    let truth = Truth::from(&scene(vec![broken, square("floor", -2.0, 2.0)]));
    let hit = |x, z| truth.first_hit(&Ray::new(Vec3::ZERO.into(), vec3(x, -1.0, z).into()));
    // the other triangle has no texture coordinates, so it is opaque
    assert_eq!(hit(-0.5, 0.4).unwrap().triangle, 2);
    assert_eq!(hit(0.5, -0.4).unwrap().triangle, 1);
}

#[test]
fn empty_scenes_give_empty_frames_that_render_and_measure() {
    let unused = Mesh { triangles: Vec::new(), ..square("unused", -1.0, 1.0) };
    for meshes in [vec![], vec![Mesh::default()], vec![unused]] {
        for (near, far) in [(None, None), (Some(2.0), None), (None, Some(5.0))] {
            let settings = Settings { near, far, views: true, ..settings() };
            let frame = frame(meshes.clone(), settings).unwrap();
            assert_eq!((frame.triangles.len(), frame.first_masked()), (0, 0));
            let light = frame.light;
            assert!(light.near > 0.0 && light.far >= 999.0 * light.near, "{light:?}");
            assert!(near.is_none_or(|near| light.near == near));
            assert!(far.is_none_or(|far| light.far == far));
            let rendering = cpu::render(&frame).unwrap();
            let grey = srgb(BACKGROUND);
            let background = [grey, grey, grey, 255];
            assert!(rendering.lit.pixels.iter().all(|pixel| *pixel == background));
            let (maps, truth) = (rendering.maps.unwrap(), truth_of(&frame));
            assert!(maps.depths.iter().all(|depth| *depth == 1.0));
            let bench = Bench::new(&frame, &maps, &truth);
            let error = map_error(&bench, 0.0, || ());
            assert_eq!((error.all.missing, error.all.extra), (0, 0));
            let points = bench.points_scattered(10, 1);
            assert!(points.is_empty() && bench.points_from_camera(10, 1).is_empty());
            assert_eq!(shadow_error(&bench, &points, || ()).points, 0);
            let penumbra = penumbra_error(&bench, &points, || ());
            assert!(
                attribute(&bench, &points, &penumbra).iter().all(|source| source.measured == 0.0)
            );
        }
    }
}

#[test]
fn holes_of_a_mask_are_holes_of_the_map() {
    const HALF: f32 = 0.05;
    for method in [Method::Vertex, Method::FragmentDepth] {
        let settings = Settings { size: 2048, method, ..settings() };
        let frame =
            frame(vec![square("floor", -2.0, 9.0), masked("x", -1.0, HALF)], settings).unwrap();
        let maps = cpu::make_maps(&frame).unwrap();
        let truth = truth_of(&frame);
        let bench = Bench::new(&frame, &maps, &truth);
        let (mut compared, mut holes) = (0, 0);
        for (x, y) in (0..maps.size).flat_map(|x| (0..maps.size).map(move |y| (x, y))) {
            let st = Uv::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / f64::from(maps.size);
            let uv = dpsm_texture_to_disk(st, bench.light.guard);
            let direction = bench.direction(uv, 0);
            let at = direction / -direction.y / f64::from(HALF);
            // within 5% of a border, and outside, either may be right: the map takes the square's
            // edges for straight, and is off by its 0.07^2 / 4 at most, 0.13% of the half-width
            let clear = |t: f64| (0.05..0.95).contains(&t.abs());
            if !(clear(at.x) && clear(at.z)) {
                continue;
            }
            let depth = f64::from(maps.depths[maps.index(x.into(), y.into(), 0)]);
            let stored = dpsm_distance(depth, bench.light.near, bench.light.far);
            let opaque = at.x * at.z > 0.0;
            assert_eq!(stored < 1.5, opaque, "{method:?}: {at} at {stored}");
            let true_distance = bench.first_distance(uv, 0).unwrap();
            assert_eq!(true_distance < 1.5, opaque, "{at}");
            compared += 1;
            holes += usize::from(!opaque);
        }
        println!("{method:?}: {compared} texels, {holes} of them holes");
        assert!(compared > 1000 && (0.4..0.6).contains(&(holes as f64 / compared as f64)));
    }
}

#[test]
fn wholly_transparent_meshes_are_not_there_and_wholly_opaque_ones_are_like_unmasked_ones() {
    let render = |more: Option<Mesh>, method| {
        // darker than the floor: the light sees both face-on
        let more = more.map(|mesh| Mesh { albedo: Vec3::splat(0.5), ..mesh });
        let meshes = [square("floor", -2.0, 9.0)].into_iter().chain(more).collect();
        let settings = Settings { far: Some(20.0), views: true, method, ..settings() };
        let rendering = cpu::render(&frame(meshes, settings).unwrap()).unwrap();
        (rendering.lit, rendering.maps, rendering.views)
    };
    let with = |alpha| {
        let mut mesh = masked("x", -1.0, 1.0);
        mesh.mask.iter_mut().for_each(|mask| mask.alpha = [alpha; 4].into());
        Some(mesh)
    };
    for method in [Method::Vertex, Method::FragmentDepth] {
        let [none, solid] = [None, Some(square("x", -1.0, 1.0))].map(|mesh| render(mesh, method));
        assert!(none.0 != solid.0 && none.1 != solid.1 && none.2 != solid.2);
        assert_eq!(render(with(127), method), none);
        assert_eq!(render(with(128), method), solid);
    }
}

#[test]
fn camera_sees_through_holes_and_points_lie_on_no_hole() {
    let scene = open("fence", &Options { walls: 1, ..Options::default() }).unwrap();
    let light = scene.default_light();
    let (position, camera) = (light.position, scene.camera.unwrap());
    const SIDE: usize = 384;
    let settings = Settings { image: [SIDE as u32; 2], ..settings() };
    let frame = Frame::new(&scene, position, Vec3::NEG_Y, false, &camera, settings).unwrap();
    let truth = truth_of(&frame);
    let [eye, right, up, forward] =
        [frame.view.eye, frame.view.right, frame.view.up, frame.view.forward].map(Vec3::as_dvec3);
    let [across, along] = frame.view.scale.map(f64::from);
    let through = |pixel: usize| {
        let center = |i: usize| (2 * i + 1) as f64 / SIDE as f64 - 1.0;
        let (s, t) = (center(pixel % SIDE), center(pixel / SIDE));
        Ray::new(eye, right * (s / across) - up * (t / along) + forward)
    };
    let rays: Vec<Ray> = (0..SIDE * SIDE).map(through).collect();
    let triangles = |truth: &Truth| -> Vec<Option<u32>> {
        truth.first_hits(&rays).into_iter().map(|hit| Some(hit?.triangle)).collect()
    };
    let (hits, whole) = (triangles(&truth), triangles(&truth.clone().with_opacity(|_, _| true)));
    let is_masked = |hit: &Option<u32>| hit.is_some_and(|hit| hit >= frame.first_masked());
    let seen = cpu::surface_points(&frame);
    let (mut compared, mut masked, mut through_holes) = (0, 0, 0);
    for (x, y) in (1..SIDE - 1).flat_map(|x| (1..SIDE - 1).map(move |y| (x, y))) {
        let pixel = y * SIDE + x;
        // a pixel whose neighbours' rays end elsewhere is too near to a border to tell
        let around = (0..9).map(|i| (y + i / 3 - 1) * SIDE + x + i % 3 - 1);
        if around.into_iter().any(|other| hits[other] != hits[pixel]) {
            continue;
        }
        assert_eq!(seen[pixel].map(|point| point.triangle), hits[pixel], "pixel {x}, {y}");
        compared += 1;
        masked += usize::from(is_masked(&hits[pixel]));
        through_holes += usize::from(is_masked(&whole[pixel]) && !is_masked(&hits[pixel]));
    }
    println!("{compared} pixels, {masked} on masked triangles, {through_holes} behind holes");
    assert!(compared > SIDE * SIDE / 2 && masked > 1000 && through_holes > 1000);

    let maps = cpu::make_maps(&frame).unwrap();
    let bench = Bench::new(&frame, &maps, &truth);
    let all = 20_000;
    let points = bench.points_scattered(all, 3);
    let lost = all - points.len();
    // a panel's point is one that its mask keeps; the holes cost the rest
    assert!(lost > all / 100, "{lost}");
    for point in points.iter().filter(|point| point.triangle >= Some(frame.first_masked())) {
        let normal = point.normal.unwrap();
        let above = Ray::new(point.world + normal * 1e-3, -normal);
        let hit = truth.first_hit(&above);
        assert_eq!(hit.map(|hit| hit.triangle), point.triangle, "{point:?}");
    }
}
