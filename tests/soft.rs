//! Soft shadows: the truth in closed form, creases, and what is counted.

#![cfg(feature = "scene")]

#[path = "common/scenes.rs"]
mod scenes;

use std::f64::consts::PI;

use dpsm::measure::*;
use dpsm::render::{Filter, Frame, Kernel, Settings, Taps};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scene::Mesh;
use glam::{DVec3, dvec3, vec3};
use scenes::{SIZE, frame_of, half_covered, settings, square};

/// The light's radius.
const RADIUS: f32 = 0.25;

fn soft() -> Settings {
    let filter = Filter::Soft { taps: 16, radius: Some(RADIUS), nearest: None };
    Settings { filter, ..settings() }
}

fn with<T>(frame: &Frame, depth: f32, wanted: impl Fn(&Bench<'_>) -> T) -> T {
    let (truth, mut maps) = (truth_of(frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    maps.depths.fill(depth);
    wanted(&Bench::new(frame, &maps, &truth))
}

/// The share of a disk of radius 1 on one side of a line that passes its centre at a distance.
fn segment(distance: f64) -> f64 {
    let d = distance.clamp(-1.0, 1.0);
    (d.acos() - d * (1.0 - d * d).sqrt()) / PI
}

#[test]
fn half_plane_covers_the_segment_of_the_light_beyond_its_edge() {
    // a cover from x = 0 on, halfway between light and floor: a line over the light's disk
    let frame = half_covered(soft());
    with(&frame, 1.0, |bench| {
        for step in -12..=12 {
            let x = f64::from(step) / 10.0 * f64::from(RADIUS);
            let point = bench.point_at(dvec3(x, -2.0, 0.0), None);
            // the disk faces the point: turned by the angle whose tangent is x / 2
            let [sin, cos] = [x, 2.0].map(|side| side / (x * x + 4.0_f64).sqrt());
            // the disk's place u is (u cos, u sin); its ray to (x, -2) passes the cover's height at
            // the edge where u (cos + x sin) = -x
            let edge = -x / (cos + x * sin);
            let expected = 1.0 - segment(edge / f64::from(RADIUS));
            let found = soft_coverage(bench, &point, RADIUS.into());
            // 128 rays of a spiral, split by a line: fewer than 3 sqrt(128) / 8 are on the wrong side
            assert!((found - expected).abs() <= 4.0 / 128.0, "{x}: {found} for {expected}");
            assert_eq!(bench.true_visibility(&point), found);
        }
    });
}

#[test]
fn what_lies_below_the_receivers_plane_is_no_shadow() {
    // a floor whose plane passes the light closer than its radius, and a dark side below it
    let floor = square("floor", 3.0, -0.1, 2.0);
    let below = square("below", 0.0, -0.2, 0.5);
    let frame = frame_of(vec![floor, below], soft());
    with(&frame, 1.0, |bench| {
        let point = bench.point_at(dvec3(2.0, -0.1, 0.2), None);
        // rays from below the plane would meet what is there
        assert_eq!(soft_coverage(bench, &point, RADIUS.into()), 1.0);
    });
}

#[test]
fn what_lies_inside_the_light_casts_no_shadow() {
    // a plate that cuts the light in two, and one just in front of it that hides a part of it
    let found = [0.2, 0.26].map(|below: f32| {
        let plate = square("plate", 0.0, -below, 0.1);
        let frame = frame_of(vec![square("floor", 0.0, -2.0, 2.0), plate], soft());
        with(&frame, 1.0, |bench| {
            let point = bench.point_at(dvec3(0.3, -2.0, 0.1), None);
            soft_coverage(bench, &point, RADIUS.into())
        })
    });
    assert_eq!(found[0], 1.0);
    // 0.2 x 0.2 of the light's disk, 2 / 1.74 times as large there
    let hidden = (0.2 * 2.0 / 1.74_f64).powi(2) / (PI * f64::from(RADIUS * RADIUS));
    assert!((1.0 - found[1] - hidden).abs() <= 12.0 / 128.0, "{} for {hidden}", 1.0 - found[1]);
}

#[test]
fn kernels_stand_for_a_light_as_wide_as_they_are_at_the_receiver() {
    let disk = |kernel| Filter::Disk(Taps { count: 16, kernel });
    let radius = |filter| {
        let frame = half_covered(Settings { filter, ..settings() });
        with(&frame, 1.0, |bench| bench.light_radius(&bench.point_at(dvec3(-1.5, -2.0, 0.0), None)))
    };
    let near = |found: Option<f64>, wanted: f64| (found.unwrap() - wanted).abs() < 1e-6;
    // the point is 2.5 away
    assert!(near(radius(disk(Kernel::Tangent(0.04))), 0.1));
    assert!(near(radius(disk(Kernel::Radius(0.04))), 0.04));
    assert!(near(radius(soft().filter), 0.25));
    assert_eq!(radius(Filter::Single), None);
    // casters halfway: the kernel's penumbra and the light's are as wide
    let frame = half_covered(Settings { filter: disk(Kernel::Tangent(0.05)), ..settings() });
    with(&frame, 1.0, |bench| {
        let at = |x: f64| bench.true_visibility(&bench.point_at(dvec3(x, -2.0, 0.0), None));
        assert_eq!((at(-0.102), at(0.102)), (1.0, 0.0));
        assert!(at(-0.08) < 1.0 && at(0.08) > 0.0);
    });
}

#[test]
fn creases_are_found_on_one_mesh_and_where_meshes_touch() {
    let wall = |name: &str, x: f32| Mesh {
        positions: [(-2.0, -5.0), (-2.0, 5.0), (3.0, 5.0), (3.0, -5.0)]
            .map(|(y, z)| vec3(x, y, z))
            .to_vec(),
        ..square(name, 0.0, 0.0, 1.0)
    };
    // a roof ridge along x = -2, and a wall on the floor at x = 1.5
    let mut ridge = square("ridge", -4.0, -1.0, 2.0);
    ridge.positions.extend([vec3(0.0, -1.8, -2.0), vec3(0.0, -1.8, 2.0)]);
    ridge.normals.extend([glam::Vec3::Y; 2]);
    ridge.triangles.extend([[3, 2, 5], [3, 5, 4]]);
    let flat = ridge.positions.iter().filter(|p| p.y == -1.0).count();
    assert_eq!(flat, 4);
    let meshes = vec![square("floor", 0.0, -2.0, 50.0), wall("wall", 1.5), ridge];
    let frame = frame_of(meshes, soft());
    with(&frame, 1.0, |bench| {
        let at = |p: DVec3| at_crease(bench, &bench.point_at(p, None), 0.25);
        let floor = |x: f64| at(dvec3(x, -2.0, 0.3));
        assert!(floor(1.3) && !floor(1.2), "beside the wall");
        assert!(at(dvec3(1.5, -1.8, 0.3)) && !at(dvec3(1.5, -1.7, 0.3)), "above the floor");
        // the ridge leans by 22 degrees: too little
        assert!(!at(dvec3(-2.1, -1.0, 0.3)));
    });
    // a box's edge, whose faces are one mesh
    let mut corner = square("corner", -4.0, -1.0, 2.0);
    corner.positions.extend([vec3(-2.0, -3.0, -2.0), vec3(-2.0, -3.0, 2.0)]);
    corner.normals.extend([glam::Vec3::X; 2]);
    corner.triangles.extend([[3, 2, 5], [3, 5, 4]]);
    let frame = frame_of(vec![corner], soft());
    with(&frame, 1.0, |bench| {
        let at = |x: f64| at_crease(bench, &bench.point_at(dvec3(x, -1.0, 0.3), None), 0.25);
        assert!(at(-2.2) && !at(-2.3));
    });
}

#[test]
fn soft_figures_are_those_of_maps_that_are_all_light_or_all_dark() {
    let frame = half_covered(soft());
    let places = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0];
    let error = |depth: f32| {
        with(&frame, depth, |bench| {
            let points = places.map(|x| bench.point_at(dvec3(x, -2.0, 0.3), None));
            soft_error(bench, &points, || ()).unwrap()
        })
    };
    // three see all of the light, one half of it, two nothing
    let [light, dark] = [1.0, 0.0].map(error);
    assert_eq!((light.all.points, light.all.fully_lit, light.all.umbra), (6, 3, 2));
    assert_eq!((light.all.darkness, light.all.light), (0.0, 1.0));
    assert_eq!((dark.all.darkness, dark.all.light), (1.0, 0.0));
    let half = 0.5 * 0.5;
    let near = |found: f64, squares: f64| (found - (squares / 6.0_f64).sqrt()).abs() < 0.01;
    assert!(
        near(light.all.rmse, 2.0 + half) && near(dark.all.rmse, 3.0 + half),
        "{light:?} {dark:?}"
    );
    assert_eq!((light.creases.points, light.elsewhere), (0, light.all));
    assert_eq!(light.radius, f64::from(RADIUS));
    // a point light has no soft shadow
    let hard = half_covered(settings());
    let none = with(&hard, 1.0, |bench| {
        soft_error(bench, &[bench.point_at(dvec3(1.0, -2.0, 0.3), None)], || ())
    });
    assert_eq!(none, None);
}
