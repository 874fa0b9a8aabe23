//! Map error: silhouettes against closed forms, and what they excuse.
//!
//! Texels are spoilt on purpose, so that each is off and has to be excused or not. Whether an
//! outline passes through a texel follows from its distance to the texel's centre: below half a
//! texel's side it does, above half its diagonal it does not.

#![cfg(feature = "scene")]

mod common;
#[path = "common/scenes.rs"]
mod scenes;

use common::EPS;
use dpsm::measure::*;
use dpsm::render::{Format, Frame, Settings};
use dpsm::scalar::depth::{dpsm_depth, dpsm_distance};
use dpsm::scalar::float::Vec2;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::dpsm_texture_to_disk;
use dpsm::scene::Mesh;
use glam::{DVec3, Vec3, dvec3, vec3};
use scenes::{SIZE, exact_maps, frame_of, half_covered, room, settings, square};

/// A texel inside the rim: layer, column, row, disk coordinates.
type Texel = (u32, u32, u32, Vec2<f64>);

fn texels(bench: &Bench<'_>) -> Vec<Texel> {
    let size = bench.light.size;
    let all = (0..bench.maps.layers)
        .flat_map(|layer| (0..SIZE).flat_map(move |y| (0..SIZE).map(move |x| (layer, x, y))));
    let place = |(layer, x, y): (u32, u32, u32)| {
        let st = Vec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / size;
        (layer, x, y, dpsm_texture_to_disk(st, bench.light.guard))
    };
    all.map(place).filter(|(.., uv)| uv.length() <= 1.0).collect()
}

/// Makes a texel wrong: 10% nearer where it is covered, extra where it is not.
fn spoil(maps: &mut DepthMaps, frame: &Frame, &(layer, x, y, _): &Texel) {
    let index = maps.index(x.into(), y.into(), layer);
    let (near, far) = (frame.light.near, frame.light.far);
    maps.depths[index] = match maps.depths[index] < 1.0 {
        true => dpsm_depth(dpsm_distance(maps.depths[index], near, far) * 0.9, near, far),
        false => 0.5,
    };
}

/// Spoils all texels; the closed form `distance` gives a direction's angle from the nearest
/// outline. Those that it passes are excused, and no others.
fn check(frame: &Frame, tau: f64, distance: impl Fn(DVec3) -> f64) {
    let truth = truth_of(frame);
    let exact = exact_maps(frame, &truth);
    let bench = Bench::new(frame, &exact, &truth);
    // across a texel grown to twice its width the pitch changes by up to this, relatively
    let margin = 2.0 * bench.texel();
    let inner = (0.5 + tau) * (1.0 - margin);
    let outer = (0.5 + tau) * 2.0_f64.sqrt() * (1.0 + margin);
    let off = |(layer, _, _, uv): &Texel| {
        distance(bench.direction(*uv, *layer).normalize()) / bench.pitch(*uv)
    };
    let all = texels(&bench);
    let judge = |chosen: &[&Texel]| {
        let mut maps = exact.clone();
        chosen.iter().for_each(|texel| spoil(&mut maps, frame, texel));
        map_error(&Bench::new(frame, &maps, &truth), tau, || ()).all
    };
    let passed: Vec<&Texel> = all.iter().filter(|texel| off(texel) < inner).collect();
    let error = judge(&passed);
    assert_eq!((error.excused, error.faults()), (passed.len(), 0), "tau {tau}: {error:?}");
    let clear: Vec<&Texel> = all.iter().filter(|texel| off(texel) > outer).collect();
    let error = judge(&clear);
    assert_eq!((error.excused, error.faults()), (0, clear.len()), "tau {tau}: {error:?}");
    assert!(clear.len() > all.len() / 2);
}

/// The angle from a direction to the nearest point of an arc between two positions.
fn arc_distance(d: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let normal = a.cross(b).normalize();
    let inside = normal.cross(a).dot(d) >= 0.0 && b.cross(normal).dot(d) >= 0.0;
    match inside {
        true => d.dot(normal).abs().asin(),
        false => d.angle_between(a).min(d.angle_between(b)),
    }
}

/// The angle to the nearest of the sides of a polygon.
fn to_sides(d: DVec3, corners: &[DVec3]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next).map(|(a, b)| arc_distance(d, [*a, *b]));
    sides.fold(f64::INFINITY, f64::min)
}

fn mesh(name: &str, positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    let normals = vec![Vec3::Y; positions.len()];
    Mesh { name: name.into(), positions, normals, triangles, albedo: Vec3::ONE, ..Mesh::default() }
}

fn quad(name: &str, corners: [Vec3; 4]) -> Mesh {
    mesh(name, corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]])
}

fn cuboid(low: Vec3, high: Vec3) -> Mesh {
    let corner = |i: u32| {
        let pick = |bit: u32, k: usize| if i >> bit & 1 == 1 { high[k] } else { low[k] };
        vec3(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    let quads =
        [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    mesh("cuboid", (0..8).map(corner).collect(), triangles)
}

/// A room with no two walls equally far.
fn walls() -> Mesh {
    cuboid(vec3(-1.5, -2.0, -2.6), vec3(1.7, 2.3, 2.9))
}

/// A globe of `rows` x `2 rows` quads; `radius` may depend on the corner's number.
fn globe(centre: Vec3, rows: u32, radius: impl Fn(u32) -> f32) -> Mesh {
    let columns = 2 * rows;
    let position = |i: u32| {
        let (row, column) = (i / columns, i % columns);
        let (sin, cos) = (std::f32::consts::PI * row as f32 / rows as f32).sin_cos();
        let (east, north) = (std::f32::consts::TAU * column as f32 / columns as f32).sin_cos();
        // one radius at each pole, whose corners coincide
        let i = if row == 0 || row == rows { row } else { i };
        centre + vec3(sin * east, cos, sin * north) * radius(i)
    };
    let triangles = (0..rows * columns).flat_map(|i| {
        let east = i / columns * columns + (i + 1) % columns;
        [[i, i + columns, east], [east, i + columns, east + columns]]
    });
    mesh("globe", (0..(rows + 1) * columns).map(position).collect(), triangles.collect())
}

#[test]
fn creases_of_a_room_are_no_silhouettes() {
    check(&frame_of(vec![walls()], settings()), 0.1, |_| f64::MAX);
}

#[test]
fn fine_and_rough_surfaces_around_the_light_are_no_silhouettes() {
    // around a point near its middle a globe with bumps of 2% is star-shaped: slopes up to
    // 0.02 / (pi / 80) in either direction, so 36 degrees, and 6 degrees for the light's place
    for bumps in [0.0, 0.02] {
        let radius = |i: u32| 2.0 + 2.0 * bumps * fastrand::Rng::with_seed(i.into()).f32();
        let frame = frame_of(vec![globe(vec3(0.2, 0.0, 0.1), 80, radius)], settings());
        let truth = truth_of(&frame);
        let mut maps = exact_maps(&frame, &truth);
        texels(&Bench::new(&frame, &maps.clone(), &truth))
            .iter()
            .filter(|(_, x, y, _)| x % 3 == 0 && y % 3 == 0)
            .for_each(|texel| spoil(&mut maps, &frame, texel));
        let error = map_error(&Bench::new(&frame, &maps, &truth), 0.1, || ()).all;
        assert!(error.faults() * 10 > error.texels, "{error:?}");
        assert_eq!(error.excused, 0, "bumps {bumps}");
    }
}

#[test]
fn sides_of_a_plane_before_a_wall_are_silhouettes() {
    let cover = square("cover", 0.3, -1.0, 0.7);
    let corners: Vec<DVec3> = cover.positions.iter().map(|p| p.as_dvec3()).collect();
    let frame = frame_of(vec![walls(), cover], settings());
    for tau in [0.0, 0.1, 0.4] {
        check(&frame, tau, |d| to_sides(d, &corners));
    }
}

#[test]
fn outline_of_a_cuboid_is_a_silhouette_and_the_creases_inside_are_not() {
    let (low, high) = (vec3(0.5, -1.6, 0.4), vec3(1.2, -0.8, 1.3));
    // in front of nothing: texels outside are extra
    let frame = frame_of(vec![cuboid(low, high)], settings());
    let corner = |x: u8, y: u8, z: u8| {
        let pick = |c: u8, k: usize| f64::from(if c == 1 { high[k] } else { low[k] });
        dvec3(pick(x, 0), pick(y, 1), pick(z, 2))
    };
    // the light sees the corner (low, high, low): around it go the sides of the three faces
    let outline = [(0, 1, 1), (1, 1, 1), (1, 1, 0), (1, 0, 0), (0, 0, 0), (0, 0, 1)]
        .map(|(x, y, z)| corner(x, y, z));
    for tau in [0.0, 0.1] {
        check(&frame, tau, |d| to_sides(d, &outline));
    }
}

#[test]
fn outline_of_a_globe_is_a_silhouette() {
    let (centre, radius) = (vec3(0.9, -1.0, 0.7), 0.6);
    let globe = globe(centre, 64, |_| radius);
    let half_angle = (f64::from(radius) / centre.as_dvec3().length()).asin();
    let frame = frame_of(vec![walls(), globe], settings());
    // the tessellated outline is up to 1 - cos(pi / 64) of the radius inside the true one, 5e-4
    // rad, of a texel's 0.02
    check(&frame, 0.1, |d| (d.angle_between(centre.as_dvec3()) - half_angle).abs());
}

#[test]
fn foot_of_a_wall_is_a_crease_and_its_foot_in_the_air_a_silhouette() {
    for (lift, tau) in [(0.0, 0.1), (0.02, 0.0), (0.02, 0.1)] {
        let at = |x: f32, y: f32| vec3(x, y, 0.8);
        let corners = [at(-0.6, -2.0 + lift), at(0.9, -2.0 + lift), at(0.9, -1.1), at(-0.6, -1.1)];
        let frame = frame_of(vec![walls(), quad("screen", corners)], settings());
        let [a, b, c, d] = corners.map(|corner| corner.as_dvec3());
        let sides: &[[DVec3; 2]] = match lift > 0.0 {
            true => &[[b, c], [c, d], [d, a], [a, b]],
            false => &[[b, c], [c, d], [d, a]],
        };
        check(&frame, tau, |direction| {
            sides.iter().map(|side| arc_distance(direction, *side)).fold(f64::INFINITY, f64::min)
        });
    }
}

#[test]
fn cut_of_the_near_sphere_is_a_silhouette() {
    // a wall, and a floor, that alone come nearer than 1.6
    let low = cuboid(vec3(-1.8, -1.4, -2.6), vec3(1.7, 2.3, 2.9));
    for (walls, towards, distance) in [(walls(), DVec3::NEG_X, 1.5), (low, DVec3::NEG_Y, 1.4)] {
        let frame = frame_of(vec![walls], Settings { near: Some(1.6), ..settings() });
        let near = f64::from(frame.light.near);
        for tau in [0.0, 0.3] {
            check(&frame, tau, |d| (d.angle_between(towards) - f64::acos(distance / near)).abs());
        }
    }
}

#[test]
fn cut_of_a_fifth_of_a_texel_around_a_point_is_a_silhouette() {
    // a plane one unit away, whose nearest point lies a quarter of a texel right of and below a
    // texel's centre: rays half a texel apart miss the cut, the nearest by 0.35 texel
    let plain = frame_of(vec![walls()], settings());
    let (truth, maps) = (truth_of(&plain), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    let bench = Bench::new(&plain, &maps, &truth);
    let (x, y) = (70, 60);
    let st = Vec2::new(f64::from(x) + 0.75, f64::from(y) + 0.75) / f64::from(SIZE);
    let uv = dpsm_texture_to_disk(st, bench.light.guard);
    let towards = bench.direction(uv, 0).normalize();
    let (side, other) = towards.any_orthonormal_pair();
    let at = |s: f64, t: f64| (towards + side * s + other * t).as_vec3();
    let plane = quad("plane", [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]);
    let near = (1.0 / (0.2 * bench.pitch(uv)).cos()) as f32;
    let frame = frame_of(vec![plane], Settings { near: Some(near), ..settings() });
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    for (column, excused) in [(x, 1), (x + 1, 0)] {
        let index = maps.index(column.into(), y.into(), 0);
        let kept = std::mem::replace(&mut maps.depths[index], 0.9);
        let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ()).all;
        assert_eq!((error.excused, error.faults()), (excused, 1 - excused));
        maps.depths[index] = kept;
    }
}

/// A floor and rods above it, each one fiftieth of a texel wide and along the columns of the front
/// map, their left sides this many texels right of its middle.
fn rods(places: &[f64]) -> Frame {
    let floor = || square("floor", 0.0, -2.0, 50.0);
    let plain = frame_of(vec![floor()], settings());
    let guard = f64::from(plain.light.guard);
    let x_of = |texels: f64| {
        let u = texels * 2.0 * (1.0 + guard) / f64::from(SIZE);
        // tan of the direction's angle, one unit below the light
        (2.0 * u / (1.0 - u * u)) as f32
    };
    // light space's axes in the world: the rod runs along `up`
    let right = plain.light.right;
    let up = plain.light.up;
    let [right, up] = [right, up].map(|v| vec3(v.x, v.y, v.z));
    let at = |s: f64, t: f32| right * x_of(s) + up * t + Vec3::NEG_Y;
    let rod = |&left: &f64| {
        let right = left + 0.02;
        quad("rod", [at(left, -0.5), at(right, -0.5), at(right, 0.5), at(left, 0.5)])
    };
    frame_of(std::iter::once(floor()).chain(places.iter().map(rod)).collect(), settings())
}

#[test]
fn rods_far_thinner_than_a_texel_are_seen() {
    let (layer, x, y) = (0, SIZE / 2, SIZE / 2 - 1);
    // beside the centre: the map may hold the rod where the truth's ray just misses it
    let frame = rods(&[0.6]);
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let index = maps.index(x.into(), y.into(), layer);
    maps.depths[index] = dpsm_depth(1.0, frame.light.near, frame.light.far);
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ()).all;
    assert_eq!((error.off_1e2, error.excused, error.faults()), (1, 1, 0));
    // through the centre: the map may miss what the truth's ray hits
    let frame = rods(&[0.49]);
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    maps.depths[index] = dpsm_depth(2.0, frame.light.near, frame.light.far);
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ()).all;
    assert_eq!((error.off_1e2, error.excused, error.faults()), (1, 1, 0));
    // in the next texel: only within tau
    let frame = rods(&[1.2]);
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    maps.depths[index] = dpsm_depth(1.0, frame.light.near, frame.light.far);
    for (tau, excused) in [(0.0, 0), (0.15, 0), (0.25, 1)] {
        let error = map_error(&Bench::new(&frame, &maps, &truth), tau, || ()).all;
        assert_eq!((error.excused, error.faults()), (excused, 1 - excused), "tau {tau}");
    }
}

#[test]
fn search_for_the_worst_texel_passes_over_any_number_of_excused_ones() {
    // one rod in each of 90 columns, between the rays a quarter of a texel apart
    let places: Vec<f64> = (-45..45).map(|column| f64::from(column) + 0.6).collect();
    let frame = rods(&places);
    let truth = truth_of(&frame);
    let exact = exact_maps(&frame, &truth);
    let bench = Bench::new(&frame, &exact, &truth);
    let corners: Vec<DVec3> = frame.vertices.iter().map(|v| v.position.as_dvec3()).collect();
    let sides: Vec<&[DVec3]> = corners[4..].chunks(4).collect();
    let is_passed = |uv: Vec2<f64>| {
        let direction = bench.direction(uv, 0).normalize();
        sides.iter().any(|side| to_sides(direction, side) < 0.4 * bench.pitch(uv))
    };
    let mut maps = exact.clone();
    let mut passed = 0;
    for (layer, x, y, uv) in texels(&bench).into_iter().filter(|texel| texel.0 == 0) {
        let is_worst = (x, y) == (64, 10);
        if is_worst || is_passed(uv) {
            let index = maps.index(x.into(), y.into(), layer);
            let (near, far) = (frame.light.near, frame.light.far);
            let distance = dpsm_distance(maps.depths[index], near, far);
            maps.depths[index] =
                dpsm_depth(distance * if is_worst { 0.9995 } else { 0.9991 }, near, far);
            passed += u32::from(!is_worst);
        }
    }
    assert!(passed > 2000, "{passed}");
    let worst = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ()).worst.unwrap();
    assert_eq!((worst.layer, worst.x, worst.y), (0, 64, 10));
}

#[test]
fn exact_maps_have_no_faults_and_nothing_in_the_rest() {
    for (format, walls) in [(Format::D32, 1), (Format::D32, 8), (Format::D16, 8)] {
        let frame = room(walls, Settings { format, ..settings() });
        let truth = truth_of(&frame);
        let maps = exact_maps(&frame, &truth);
        let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
        assert_eq!((error.all.excused, error.all.faults()), (0, 0));
        // half a step of the format and the rounding to f32, over the nearest distance
        let range = f64::from(frame.light.far - frame.light.near);
        let bound = (0.5 * f64::from(format.quantum()) + 0.5 * EPS) * range / 0.3;
        assert!(error.all.largest_rest <= bound, "{format:?}: {error:?}");
        assert_eq!(error.worst.map(|worst| worst.error), Some(error.all.largest_rest));
    }
}

#[test]
fn maps_shifted_by_one_texel_are_faults_inside_and_excused_along_outlines() {
    let frame = room(8, settings());
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    maps.depths.rotate_right(1);
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
    // the distance changes by the pitch times tan(incidence): above 1e-3 beyond 4 degrees
    assert!(error.all.faults() * 2 > error.all.covered, "{error:?}");
    assert!(error.all.excused > 0 && error.all.largest_rest > 1e-3);
    let both = |count: fn(&Band) -> usize| count(&error.rim) + count(&error.centre);
    assert_eq!(both(Band::faults), error.all.faults());
    assert_eq!(both(|band| band.excused), error.all.excused);
    let wrong = error.all.off_1e3 + error.all.missing + error.all.extra;
    assert_eq!(error.all.excused + error.all.faults(), wrong);
}

#[test]
fn wall_pushed_back_by_two_thousandths_is_faults_all_over() {
    let high = vec3(1.7, 2.3, 2.9);
    let made = |scale: f32| {
        let high = vec3(high.x * scale, high.y, high.z);
        frame_of(vec![cuboid(vec3(-1.5, -2.0, -2.6), high)], settings())
    };
    let (stored, frame) = (made(1.0), made(1.002));
    // the spheres of the frame that is measured, and of the maps, must be the same
    let spheres =
        Settings { near: Some(frame.light.near), far: Some(frame.light.far), ..settings() };
    let stored = Frame { settings: spheres, light: frame.light, ..stored };
    let maps = exact_maps(&stored, &truth_of(&stored));
    let truth = truth_of(&frame);
    let bench = Bench::new(&frame, &maps, &truth);
    let error = map_error(&bench, 0.0, || ());
    // by closed form: the texels that see the wall at x = 1.7 x 1.002
    let behind = |d: DVec3| {
        let other = |along: f64, low: f64, high: f64| if along > 0.0 { high } else { low } / along;
        let wall = 1.7 * 1.002 / d.x;
        d.x > 0.0 && wall < other(d.y, -2.0, 2.3) && wall < other(d.z, -2.6, 2.9)
    };
    let seen = texels(&bench)
        .iter()
        .filter(|(layer, _, _, uv)| behind(bench.direction(*uv, *layer)))
        .count();
    assert_eq!(error.all.excused, 0);
    assert!(error.all.faults_off >= seen && seen > 1000, "{seen} of {error:?}");
    // 0.002 / 1.002, and the rounding of the wall's place to f32
    let off = 0.002 / 1.002;
    assert!((error.all.largest_rest - off).abs() <= 2.0 * EPS, "{}", error.all.largest_rest);
    assert_eq!(error.all.largest_rest, error.rim.largest_rest.max(error.centre.largest_rest));
}

#[test]
fn emptied_texel_is_a_hole_and_a_filled_one_is_extra() {
    let frame = half_covered(settings());
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let (down, up) = (maps.index(80, 70, 0), maps.index(64, 64, 1));
    (maps.depths[down], maps.depths[up]) = (1.0, 0.5);
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ()).all;
    assert_eq!((error.holes, error.faults_extra, error.faults_off), (1, 1, 0));
    assert_eq!((error.faults(), error.excused), (2, 0));
}

#[test]
fn outline_moved_by_less_than_tau_is_excused_with_tau_alone() {
    let made = |x: f32| {
        let at = |x: f32, z: f32| vec3(x, -1.0, z);
        let cover = quad("cover", [at(x, -0.7), at(x, 0.7), at(1.0, 0.7), at(1.0, -0.7)]);
        frame_of(vec![walls(), cover], settings())
    };
    let frame = made(0.1);
    // near the middle a texel is 2 x 2 (1 + guard) / N wide, one unit below the light
    let texel = 4.0 * (1.0 + frame.light.guard) / SIZE as f32;
    let stored = made(0.1 + 0.8 * texel);
    assert_eq!(stored.light, frame.light);
    let maps = exact_maps(&stored, &truth_of(&stored));
    let truth = truth_of(&frame);
    let judge = |tau| map_error(&Bench::new(&frame, &maps, &truth), tau, || ()).all;
    // centres are up to 0.8 texel from the outline, so it is up to 0.3 from their texels
    let (strict, tolerant) = (judge(0.0), judge(0.35));
    assert!(strict.excused > 0 && strict.faults() > 0, "{strict:?}");
    assert_eq!(tolerant.excused, strict.excused + strict.faults());
    assert_eq!(tolerant.faults(), 0, "{tolerant:?}");
}

#[test]
fn worst_texel_is_the_one_of_the_rest_with_the_largest_error() {
    let cover = square("cover", 0.3, -1.0, 0.7);
    let corners: Vec<DVec3> = cover.positions.iter().map(|p| p.as_dvec3()).collect();
    let frame = frame_of(vec![walls(), cover], settings());
    let truth = truth_of(&frame);
    let exact = exact_maps(&frame, &truth);
    let bench = Bench::new(&frame, &exact, &truth);
    let (near, far) = (frame.light.near, frame.light.far);
    let mut maps = exact.clone();
    let scale = |maps: &mut DepthMaps, (layer, x, y, _): Texel, factor: f32| {
        let index = maps.index(x.into(), y.into(), layer);
        let distance = dpsm_distance(maps.depths[index], near, far);
        maps.depths[index] = dpsm_depth(distance * factor, near, far);
    };
    // both below 1e-3; the larger error on the outline
    let texels = texels(&bench);
    let off = |(layer, _, _, uv): &Texel| {
        to_sides(bench.direction(*uv, *layer).normalize(), &corners) / bench.pitch(*uv)
    };
    let outline = *texels.iter().find(|texel| off(texel) < 0.4).unwrap();
    let inside = *texels.iter().find(|(layer, x, y, _)| (*layer, *x, *y) == (1, 50, 70)).unwrap();
    scale(&mut maps, outline, 0.9991);
    scale(&mut maps, inside, 0.9995);
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
    let worst = error.worst.unwrap();
    assert_eq!((worst.layer, worst.x, worst.y), (1, 50, 70));
    assert_eq!((error.all.excused, error.all.faults()), (0, 0), "all are below 1e-3");
    assert_eq!(worst.error, error.all.largest_rest);
    // rounding to f32 of the depth, below 1 of a range of 4, and of the factor
    assert!((worst.error - 5e-4).abs() <= 8.0 * EPS, "{worst:?}");
    // up there is the ceiling
    let direction = bench.direction(inside.3, 1).normalize();
    assert_eq!([inside.3.x, inside.3.y], worst.uv);
    assert!((worst.hit - 2.3 / direction.y).abs() <= 4.0 * EPS);
    assert!((worst.incidence - direction.y.acos()).abs() <= EPS);
    assert!((worst.conditioning - EPS * worst.incidence.tan()).abs() <= EPS * EPS);
    // a fault goes before it
    scale(&mut maps, texels[200], 0.99);
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
    assert_eq!((error.all.faults_off, error.all.faults()), (1, 1));
    assert!((error.all.largest_rest - 1e-2).abs() <= 8.0 * EPS);
}
