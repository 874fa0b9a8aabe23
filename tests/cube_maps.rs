//! A cube's maps by the ports, and the measures of them.

#![cfg(feature = "scene")]

mod common;
#[path = "common/scenes.rs"]
mod scenes;

use common::EPS;
use dpsm::cpu;
use dpsm::measure::*;
use dpsm::render::{Bias, Format, Frame, FrameError, Lookup, Method, Passes, Settings};
use dpsm::scalar::float::Vec2;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::{dpsm_disk_to_texture, dpsm_texture_to_disk};
use dpsm::scene::{self, Mask, Mesh, Options};
use dpsm::truth::Truth;
use glam::{DVec3, Vec3, vec3};
use scenes::{exact_maps, frame_of, room, square};

/// Faces of 128 x 128 texels.
fn settings() -> Settings {
    Settings { size: 256, method: Method::Cube, ..scenes::settings() }
}

fn cornell(settings: Settings) -> Frame {
    let scene = scene::open("cornell", &Options { walls: 1, ..Options::default() }).unwrap();
    let light = scene.default_light();
    let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
    Frame::new(&scene, light.position, Vec3::NEG_Y, false, &camera, settings).unwrap()
}

/// The six faces' maps by the ports.
fn cube_maps(frame: &Frame) -> DepthMaps {
    let size = frame.settings.map_size();
    let mut maps = DepthMaps::empty(size, frame.light.hemispheres, frame.settings.sampling);
    let layers = maps.depths.chunks_mut((size * size) as usize);
    (0..).zip(layers).for_each(|(face, layer)| cpu::cube::map_pass(frame, face, layer));
    maps
}

/// What a face's distance may be off by, relatively, in the ports' IEEE arithmetic, whose
/// operations err by half an eps: docs/cube.md, "What a map stores".
fn bound(frame: &Frame, worst: &WorstTexel) -> f64 {
    let light = frame.light.widen();
    let reach = |v: &dpsm::render::Vertex| (v.position.as_dvec3() - origin(frame)).length();
    let farthest = frame.vertices.iter().map(reach).fold(0.0, f64::max);
    let depth = (2.0 * (farthest + light.near) + 0.5 * light.far) / light.near;
    // places in light space 2 eps, x and y of clip space 1 eps of the farthest vertex
    let place = 3.0 * farthest / worst.hit / worst.incidence.cos();
    EPS * (depth + place)
}

/// The direction, of length 1 along the axis, of the centre of the texel that holds a place.
fn centre(frame: &Frame, [u, v]: [f64; 2]) -> DVec3 {
    let light = frame.light.widen();
    let st = dpsm_disk_to_texture(Vec2::new(u, v), light.guard) * light.size;
    let middle = Vec2::new(st.x.floor(), st.y.floor()) + Vec2::splat(0.5);
    let uv = dpsm_texture_to_disk(middle / light.size, light.guard);
    DVec3::new(uv.x, uv.y, 1.0)
}

fn origin(frame: &Frame) -> DVec3 {
    let p = frame.light.position.widen();
    DVec3::new(p.x, p.y, p.z)
}

#[test]
fn cube_maps_have_no_faults_and_err_by_no_more_than_their_depth_does() {
    for frame in [room(1, settings()), cornell(settings())] {
        let (maps, truth) = (cube_maps(&frame), truth_of(&frame));
        let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
        println!("{error:?}");
        assert_eq!(error.all.faults(), 0, "{error:?}");
        // 126 of a face's 128 columns lie inside its edges, one texel is the guard band
        assert_eq!(error.all.texels, 6 * 126 * 126);
        assert_eq!((error.all.missing, error.all.extra, error.all.excused), (0, 0, 0), "{error:?}");
        // outside 0.9 of the half width: 6 or 7 columns at each edge
        assert_eq!(error.rim.texels, 6 * (126 * 126 - 114 * 114), "seams");
        let bound = bound(&frame, &error.worst.unwrap());
        println!("largest of the rest {:e}, bound {bound:e}", error.all.largest_rest);
        assert!(error.all.largest_rest <= bound, "{error:?} above {bound}");
    }
}

#[test]
fn culled_triangles_leave_the_faces_as_they_are() {
    for frame in [room(1, settings()), room(8, settings())] {
        let all = Settings { cull_faces: false, ..frame.settings.clone() };
        let all = Frame { settings: all, ..frame.clone() };
        assert_eq!(cube_maps(&frame), cube_maps(&all));
    }
}

#[test]
fn cube_shadows_differ_from_those_of_exact_faces_only_where_depth_decides_by_a_hair() {
    let settings = Settings { bias: Bias::Constant(None), ..settings() };
    for frame in [room(1, settings.clone()), cornell(settings)] {
        let truth = truth_of(&frame);
        let (cube, exact) = (cube_maps(&frame), exact_maps(&frame, &truth));
        let [cube, exact] = [&cube, &exact].map(|maps| Bench::new(&frame, maps, &truth));
        let share = bound(&frame, &map_error(&cube, 0.0, || ()).worst.unwrap());
        let points = cube.points_scattered(5_000, 1);
        let error = shadow_error(&cube, &points, || ());
        println!("{error:?}");
        assert!(error.edge_points > 100 && error.seam_points > 100);
        let bias = f64::from(frame.bias) * (cube.light.far - cube.light.near);
        for point in points {
            let [made, exact] = [&cube, &exact].map(|bench| judge(bench, &point));
            // both depths along the axis: the receiver's after the bias, and the texel's
            let axis = |distance: f64| distance / cube.clip(point.world - cube.origin)[0];
            let receiver = axis(made.own - bias) * cube.light.near;
            let texel = exact.stored / centre(&frame, made.uv).length();
            let by_a_hair = (receiver - texel).abs() <= share * texel;
            assert!(made.visibility == exact.visibility || by_a_hair, "{made:?} {exact:?}");
        }
    }
}

#[test]
fn exact_faces_have_no_error_and_spoilt_ones_do() {
    for format in [Format::D16, Format::D24, Format::D32] {
        let frame = room(1, Settings { format, ..settings() });
        let truth = truth_of(&frame);
        let maps = exact_maps(&frame, &truth);
        let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ()).all;
        assert_eq!((error.missing, error.extra), (0, 0));
        // half a step, and the rounding to f32: of a depth whose step is z / near of the distance
        let light = frame.light.widen();
        let off = 0.5 * f64::from(format.quantum()) + 0.5 * EPS;
        let share = off * light.far * (light.far - light.near) / (light.far * light.near);
        // one step on, z itself is larger by as much
        assert!(error.largest <= share / (1.0 - share), "{format:?}: {error:?}");
    }
    let frame = room(1, settings());
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let face = maps.depths.len() / 6;
    maps.depths.rotate_left(face);
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ()).all;
    // floor and ceiling are as far as walls, and the room is longer one way only
    assert!(error.faults() > error.texels / 6, "{error:?}");
}

/// The angle from a direction to the nearest side of a polygon.
fn to_sides(d: DVec3, corners: &[DVec3]) -> f64 {
    let arc = |(a, b): (&DVec3, &DVec3)| {
        let normal = a.cross(*b).normalize();
        let inside = normal.cross(*a).dot(d) >= 0.0 && b.cross(normal).dot(d) >= 0.0;
        match inside {
            true => d.dot(normal).abs().asin(),
            false => d.angle_between(*a).min(d.angle_between(*b)),
        }
    };
    corners.iter().zip(corners.iter().cycle().skip(1)).map(arc).fold(f64::INFINITY, f64::min)
}

/// A room with no two walls equally far.
fn walls() -> Mesh {
    let (low, high) = (vec3(-1.5, -2.0, -2.6), vec3(1.7, 2.3, 2.9));
    let pick = |i: u32, bit: u32| if i >> bit & 1 == 1 { high } else { low };
    let corner = |i| vec3(pick(i, 0).x, pick(i, 1).y, pick(i, 2).z);
    let quads =
        [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
    Mesh {
        name: "walls".into(),
        positions: (0..8).map(corner).collect(),
        normals: vec![Vec3::Y; 8],
        triangles: quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
        albedo: Vec3::ONE,
        ..Mesh::default()
    }
}

#[test]
fn outline_across_the_edges_of_faces_is_a_silhouette_and_nothing_else_is() {
    // its sides reach from the face below onto two others
    let cover = square("cover", 0.3, -0.5, 0.7);
    let corners: Vec<DVec3> = cover.positions.iter().map(|p| p.as_dvec3()).collect();
    let frame = frame_of(vec![walls(), cover], Settings { size: 128, ..settings() });
    let truth = truth_of(&frame);
    let exact = exact_maps(&frame, &truth);
    let bench = Bench::new(&frame, &exact, &truth);
    let size = frame.settings.map_size();
    let places: Vec<(usize, f64)> = (0..exact.depths.len())
        .filter_map(|index| {
            let (row, side) = (index / size as usize, size as usize);
            let centre = Vec2::new((index % side) as f64 + 0.5, (row % side) as f64 + 0.5);
            let uv = dpsm_texture_to_disk(centre / f64::from(size), bench.light.guard);
            let direction = bench.direction(uv, (row / side) as u32).normalize();
            let inside = bench.projection.radius(uv) <= 1.0;
            inside.then(|| (index, to_sides(direction, &corners) / bench.pitch(uv)))
        })
        .collect();
    // with l^2 = 1 + |uv|^2 <= 3 a texel spans 1 / sqrt(l) of its pitch along the radius and
    // sqrt(l) across; over a grown texel l changes by up to its width, relatively
    let (stretch, margin) = (3.0_f64.powf(0.25), 2.0 * bench.texel());
    for tau in [0.0, 0.1] {
        let judge = |chosen: &[usize]| {
            let mut maps = exact.clone();
            let off = |depth: f32| if depth < 1.0 { depth * 0.99 } else { 0.9 };
            chosen.iter().for_each(|&index| maps.depths[index] = off(maps.depths[index]));
            map_error(&Bench::new(&frame, &maps, &truth), tau, || ()).all
        };
        let inner = (0.5 + tau) / stretch * (1.0 - margin);
        let outer = (0.5 + tau) * 2.0_f64.sqrt() * stretch * (1.0 + margin);
        let chosen = |keep: &dyn Fn(f64) -> bool| -> Vec<usize> {
            places.iter().filter(|(_, off)| keep(*off)).map(|(index, _)| *index).collect()
        };
        let (passed, clear) = (chosen(&|off| off < inner), chosen(&|off| off > outer));
        let faces =
            |face: usize| passed.iter().filter(|i| *i / exact.layer(0).len() == face).count();
        assert!((0..6).filter(|face| faces(*face) > 0).count() >= 3, "one face alone");
        let error = judge(&passed);
        assert_eq!((error.excused, error.faults()), (passed.len(), 0), "tau {tau}: {error:?}");
        let error = judge(&clear);
        assert_eq!((error.excused, error.faults()), (0, clear.len()), "tau {tau}: {error:?}");
    }
}

#[test]
fn holes_of_a_steep_mask_are_where_the_truth_has_them() {
    // from 0.6 to 6 units away, so that weights of the image alone would be far off
    let corners = [
        vec3(-0.5, -0.6, -0.5),
        vec3(0.5, -0.6, -0.5),
        vec3(3.0, -1.5, 6.0),
        vec3(-3.0, -1.5, 6.0),
    ];
    let texcoords = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let chequered = (0..64u32).map(|i| if (i + i / 8) % 2 == 0 { 255 } else { 0 }).collect();
    let mesh = Mesh {
        name: "leaf".into(),
        positions: corners.to_vec(),
        normals: vec![Vec3::Y; 4],
        texcoords: texcoords.map(|(s, t)| glam::vec2(s, t)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        albedo: Vec3::ONE,
        mask: Some(Mask { width: 8, height: 8, alpha: chequered, cutoff: 0.5 }),
    };
    let frame = frame_of(vec![square("floor", 0.0, -2.0, 50.0), mesh], settings());
    let (maps, truth) = (cube_maps(&frame), truth_of(&frame));
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
    assert_eq!(error.all.faults(), 0, "{error:?}");
}

#[test]
fn casters_between_the_near_plane_and_the_near_sphere_are_drawn_as_the_truth_says() {
    let shield = square("shield", 0.0, -0.5, 3.0);
    let floor = square("floor", 0.0, -2.0, 50.0);
    for (near, drawn) in [(0.49, true), (0.51 * 1.8, false)] {
        let frame = frame_of(
            vec![floor.clone(), shield.clone()],
            Settings { near: Some(near), ..settings() },
        );
        let (maps, truth) = (cube_maps(&frame), truth_of(&frame));
        assert_eq!(frame.light.near < 0.5, drawn);
        let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ()).all;
        assert_eq!(error.faults(), 0, "near {near}: {error:?}");
    }
}

#[test]
fn sources_of_a_cube_stay_within_their_bounds_and_leave_disks_out() {
    for format in [Format::D16, Format::D24, Format::D32] {
        let frame = room(8, Settings { format, ..settings() });
        let (maps, truth) = (cube_maps(&frame), truth_of(&frame));
        let bench = Bench::new(&frame, &maps, &truth);
        let points = bench.points_scattered(3_000, 2);
        let sources = attribute(&bench, &points, &PenumbraError::default());
        let names: Vec<_> = sources.iter().map(|source| source.name).collect();
        assert_eq!(names, ["f32 arithmetic", "storage format", "resolution", "bias", "filter"]);
        for source in &sources[..4] {
            let predicted = source.predicted.unwrap();
            assert!(source.measured > 0.0 && source.measured <= predicted, "{format:?} {source:?}");
        }
    }
}

#[test]
fn texels_solid_angles_and_finest_pitch_are_those_of_the_sphere() {
    let frame = room(1, settings());
    let truth = Truth::new(&[], []);
    let maps = DepthMaps::empty(128, 6, Sampling::Nearest);
    let bench = Bench::new(&frame, &maps, &truth);
    let (mut sum, w) = (0.0, bench.texel());
    for y in 0..128 {
        for x in 0..128 {
            let centre = Vec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / 128.0;
            let uv = dpsm_texture_to_disk(centre, bench.light.guard);
            let along = |a: Vec2<f64>, b: Vec2<f64>| {
                bench.direction(a, 0).angle_between(bench.direction(b, 0))
            };
            let out = uv * (w / uv.length());
            let radial = along(uv - out * 0.5, uv + out * 0.5);
            assert!(bench.projection.finest_pitch(bench.light) <= radial);
            if bench.projection.radius(uv) <= 1.0 {
                sum += bench.pitch(uv).powi(2);
            }
        }
    }
    // a sixth of the sphere; the midpoint rule errs by w^2 / 24 of a second derivative of at most 3
    // in either direction, over an area of 4
    let sixth = 4.0 * std::f64::consts::PI / 6.0;
    assert!((sum - sixth).abs() <= w * w, "{sum} {sixth}");
}

#[test]
fn what_a_cube_does_not_have_is_refused() {
    let scene = scene::open("cornell", &Options::default()).unwrap();
    let light = scene.default_light();
    let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
    let made = |settings| Frame::new(&scene, light.position, Vec3::NEG_Y, false, &camera, settings);
    let lookup = made(Settings { lookup: Lookup::Vertex, ..settings() }).unwrap_err();
    assert!(matches!(lookup, FrameError::Cube { what: "lookup by vertex", .. }), "{lookup}");
    let atlas = made(Settings { passes: Passes::Atlas, ..settings() }).unwrap_err();
    assert!(matches!(atlas, FrameError::Cube { what: "atlas", .. }), "{atlas}");
    let multiview = made(Settings { passes: Passes::Multiview, ..settings() }).unwrap_err();
    assert!(matches!(multiview, FrameError::Cube { what: "multiview", .. }), "{multiview}");
}
