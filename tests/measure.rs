//! The measures: they find nothing where nothing is wrong, and each deliberate fault where it is.

#![cfg(feature = "scene")]

mod common;
#[path = "common/scenes.rs"]
mod scenes;

use common::EPS;
use dpsm::cpu;
use dpsm::measure::*;
use dpsm::render::{Bias, Format, Frame, Method, Settings};
use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scene::Mesh;
use glam::{DVec3, Vec3, vec3};
use scenes::{SIZE, exact_maps, frame_of, half_covered, room, settings, square};

#[test]
fn exact_maps_have_no_map_error() {
    for format in [Format::D16, Format::D24, Format::D32] {
        let frame = room(1, Settings { format, ..settings() });
        let truth = truth_of(&frame);
        let maps = exact_maps(&frame, &truth);
        let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
        assert_eq!((error.all.missing, error.all.extra), (0, 0));
        // half a step of the format and the rounding to f32, over the nearest distance
        let range = f64::from(frame.light.far - frame.light.near);
        let nearest = 0.3; // metres: the light is farther than that from everything
        let bound = (0.5 * f64::from(format.quantum()) + 0.5 * EPS) * range / nearest;
        assert!(error.all.largest <= bound, "{format:?}: {} above {bound}", error.all.largest);
        assert_eq!(error.all.texels, error.rim.texels + error.centre.texels);
        // texels inside the rim: pi / 4 of the square, less the guard band; the rim's own texels,
        // fewer than 4 N, may count either way
        let side = f64::from(SIZE) / (1.0 + f64::from(frame.light.guard));
        let disk = 2.0 * std::f64::consts::FRAC_PI_4 * side * side;
        assert!((error.all.texels as f64 - disk).abs() <= 4.0 * f64::from(SIZE) * 2.0);
    }
}

#[test]
fn swapped_hemispheres_are_seen() {
    let frame = room(1, settings());
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let half = maps.depths.len() / 2;
    maps.depths.rotate_left(half);
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
    assert!(error.all.off_1e2 > error.all.covered / 20, "{error:?}");
}

#[test]
fn maps_upside_down_are_seen() {
    let frame = room(1, settings());
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let size = SIZE as usize;
    for layer in maps.depths.chunks_mut(size * size) {
        let rows: Vec<Vec<f32>> = layer.chunks(size).rev().map(<[f32]>::to_vec).collect();
        layer.copy_from_slice(&rows.concat());
    }
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
    assert!(error.all.off_1e2 > error.all.covered / 20, "{error:?}");
}

#[test]
fn near_left_out_of_the_depth_is_seen() {
    let frame = room(1, Settings { near: Some(0.2), ..settings() });
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let (near, far) = (frame.light.near, frame.light.far);
    for depth in maps.depths.iter_mut().filter(|depth| **depth < 1.0) {
        *depth = (near + *depth * (far - near)) / far;
    }
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
    assert!(error.all.off_1e3 > error.all.covered / 2, "{error:?}");
}

#[test]
fn texels_are_counted_by_how_far_they_are_off() {
    let frame = room(1, settings());
    let truth = truth_of(&frame);
    let exact = exact_maps(&frame, &truth);
    let (near, far) = (frame.light.near, frame.light.far);
    for (factor, above_1e2, above_1e3) in [(0.9995, 0, 0), (0.995, 0, 1), (0.98, 1, 1)] {
        let mut maps = exact.clone();
        for depth in maps.depths.iter_mut().filter(|depth| **depth < 1.0) {
            *depth = dpsm_depth((near + *depth * (far - near)) * factor, near, far);
        }
        let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ()).all;
        let expected = (error.covered * above_1e2, error.covered * above_1e3);
        assert_eq!((error.off_1e2, error.off_1e3), expected, "factor {factor}");
        // rounding to f32 of depths up to 1, over distances from 0.3 m of a range of about 3.5 m
        let off = f64::from(1.0_f32 - factor);
        assert!((error.largest - off).abs() <= 20.0 * EPS, "{}", error.largest);
        assert!((error.percentile_99 - off).abs() <= 20.0 * EPS, "{}", error.percentile_99);
    }
}

#[test]
fn missing_and_extra_texels_are_counted() {
    let frame = half_covered(settings());
    let truth = truth_of(&frame);
    let mut maps = exact_maps(&frame, &truth);
    let centre = maps.index(64, 64, 0);
    assert!(maps.depths[centre] < 1.0);
    maps.depths[centre] = 1.0;
    let up = maps.index(64, 64, 1);
    assert_eq!(maps.depths[up], 1.0, "nothing is above the light");
    maps.depths[up] = 0.5;
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
    assert_eq!((error.all.missing, error.all.extra), (1, 1));
    assert_eq!((error.rim.missing, error.rim.extra), (0, 0));
}

#[test]
fn vertex_method_fails_on_walls_of_two_triangles_and_most_texels_are_off() {
    let frame = room(1, Settings { size: 512, ..settings() });
    let (maps, truth) = (cpu::make_maps(&frame).unwrap(), truth_of(&frame));
    let error = map_error(&Bench::new(&frame, &maps, &truth), 0.0, || ());
    assert!(error.all.off_1e2 * 2 > error.all.covered, "{error:?}");
    assert!(error.all.missing * 20 > error.all.texels, "{error:?}");
}

#[test]
fn walls_of_8_x_8_quads_bow_half_a_texel_and_err_by_one_and_a_half_percent() {
    let frame = room(8, Settings { size: 512, ..settings() });
    let (maps, truth) = (cpu::make_maps(&frame).unwrap(), truth_of(&frame));
    let bench = Bench::new(&frame, &maps, &truth);
    let floor = frame.meshes.iter().find(|(name, _)| name == "floor").unwrap().1.clone();
    let bow = bowed_edges(&bench, floor.clone());
    assert_eq!(format!("{:.2}", bow.measured), "0.48");
    // the formula is the first term of a series in the chord, which is at most an eighth here
    let predicted = bow.predicted.unwrap();
    assert!((bow.measured - predicted).abs() <= predicted / 64.0, "{bow:?}");
    let affine = affine_depth(&bench, floor);
    assert_eq!(format!("{:.1}", 100.0 * affine.measured), "1.5");
    assert!(affine.measured <= affine.predicted.unwrap(), "{affine:?}");
}

#[test]
fn affine_depth_of_small_triangles_stays_within_its_bound() {
    let mut rng = common::rng("affine");
    let mut worst = common::Worst::default();
    for _ in 0..300 {
        // a triangle of up to 0.1 rad anywhere around the light, not steeper than 73 degrees
        let middle = common::unit(&mut rng);
        let corner = |rng: &mut fastrand::Rng| {
            let off = common::unit(rng);
            vec3(middle.x + 0.05 * off.x, middle.y + 0.05 * off.y, middle.z + 0.05 * off.z) * 2.0
        };
        let positions = vec![corner(&mut rng), corner(&mut rng), corner(&mut rng)];
        let normal = (positions[1] - positions[0]).cross(positions[2] - positions[0]).normalize();
        if positions.iter().any(|p| normal.dot(p.normalize()).abs() < 0.3) {
            continue;
        }
        let mesh = Mesh {
            name: "triangle".into(),
            positions,
            normals: vec![normal; 3],
            triangles: vec![[0, 1, 2]],
            albedo: Vec3::ONE,
            ..Mesh::default()
        };
        let frame = frame_of(vec![mesh], settings());
        let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
        let bench = Bench::new(&frame, &maps, &truth);
        if left_out(&bench, 0..1) == 0 {
            let source = affine_depth(&bench, 0..1);
            worst.note(source.measured, source.predicted.unwrap(), frame.vertices);
        }
    }
    worst.check("affine depth");
}

#[test]
fn measures_of_a_box_agree_with_its_closed_form() {
    // walls at different distances on all six sides, so that no mirror image agrees, and a shield
    // inside the near sphere that must not count
    let walls = [(-1.0, 1.5), (-2.0, 2.5), (-3.0, 3.5)];
    let low = Vec3::from_array(walls.map(|wall| wall.0));
    let high = Vec3::from_array(walls.map(|wall| wall.1));
    let corner = |i: u32| {
        let pick = |bit: u32, k: usize| if i >> bit & 1 == 1 { high[k] } else { low[k] };
        vec3(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    let quads =
        [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let room = Mesh {
        name: "box".into(),
        positions: (0..8).map(corner).collect(),
        normals: vec![Vec3::Y; 8],
        triangles,
        albedo: Vec3::ONE,
        ..Mesh::default()
    };
    let shield = square("shield", 0.0, -0.1, 0.05);
    let frame = frame_of(vec![room, shield], Settings { near: Some(0.2), ..settings() });
    let light = frame.light;
    // the first wall along a direction of the light's space, by formula
    let distance = |d: [f64; 3]| {
        let rows = [light.right, light.up, light.forward];
        let axis = |k: usize| -> f64 {
            let component =
                |row: dpsm::scalar::float::Vec3<f32>| f64::from([row.x, row.y, row.z][k]);
            rows.iter().zip(d).map(|(row, d)| component(*row) * d).sum()
        };
        (0..3)
            .map(|k| {
                let along = axis(k);
                f64::from(if along > 0.0 { high[k] } else { low[k] }) / along
            })
            .filter(|t| t.is_finite())
            .fold(f64::INFINITY, f64::min)
    };
    let size = f64::from(SIZE);
    let mut maps = DepthMaps::empty(SIZE, 2, Sampling::Nearest);
    for hemisphere in 0..2 {
        for y in 0..SIZE {
            for x in 0..SIZE {
                let scale = 2.0 * (1.0 + f64::from(light.guard));
                let u = ((f64::from(x) + 0.5) / size - 0.5) * scale;
                let v = (0.5 - (f64::from(y) + 0.5) / size) * scale;
                let square = u * u + v * v;
                let z = (1.0 - square) / (1.0 + square);
                let z = if hemisphere == 0 { z } else { -z };
                let d = [2.0 * u / (1.0 + square), 2.0 * v / (1.0 + square), z];
                let (near, far) = (f64::from(light.near), f64::from(light.far));
                let index = maps.index(x.into(), y.into(), hemisphere);
                maps.depths[index] = ((distance(d) - near) / (far - near)) as f32;
            }
        }
    }
    let truth = truth_of(&frame);
    let bench = Bench::new(&frame, &maps, &truth);
    let error = map_error(&bench, 0.0, || ()).all;
    assert_eq!((error.missing, error.extra), (0, 0));
    // half an eps of depths up to 1 of a range below 5 over distances from 1, and the rotation's
    // rounding to f32, eps / 2 in each of three terms
    assert!(error.largest <= 5.0 * EPS, "{}", error.largest);
    // every point of the walls sees the light past the shield, which is inside near
    for point in bench.points_scattered(500, 4) {
        let judgement = judge(&bench, &point);
        let shielded = judgement.own < 0.2;
        let at_shield = point.world * (-0.1 / point.world.y);
        let behind = at_shield.x.abs().max(at_shield.z.abs()) <= 0.05 && point.world.y < -0.1;
        assert_eq!(judgement.lit, shielded || !behind, "{point:?}");
        assert!(shielded || (judgement.own - point.world.length()).abs() <= 5.0 * EPS);
    }
}

#[test]
fn faults_are_sorted_by_seam_angle_and_bias() {
    let bias = Bias::Constant(None);
    let frame = half_covered(Settings { near: Some(0.5), far: Some(5.0), bias, ..settings() });
    let truth = truth_of(&frame);
    // a texel stores the cover just in front of the receiver: the bias alone lights it
    let mut maps = exact_maps(&frame, &truth);
    let point = Bench::new(&frame, &maps, &truth).point_at(DVec3::new(3.0, -2.0, 0.0), None);
    let (near, far) = (f64::from(frame.light.near), f64::from(frame.light.far));
    let own = point.world.length();
    let bias = f64::from(frame.bias) * (far - near);
    for depth in &mut maps.depths {
        *depth = ((own - 0.9 * bias - near) / (far - near)) as f32;
    }
    let bench = Bench::new(&frame, &maps, &truth);
    let judgement = judge(&bench, &point);
    assert_eq!((judgement.visibility, judgement.lit, judgement.edge), (1.0, false, false));
    // what the texel holds is the receiver's surroundings, not the occluder: no contact gap
    assert_eq!(shadow_error(&bench, &[point], || ()).contact_gap, 0.0);
    // below the horizon by four texels' angle: within the seam band; straight down is not
    let edge = 4.0 * bench.texel();
    let low = |angle: f64| DVec3::new(-angle.cos(), -angle.sin(), 0.0) * 2.0;
    let seam = bench.point_at(low(edge), None);
    let down = bench.point_at(DVec3::new(-0.5, -2.0, 0.0), None);
    assert_eq!(shadow_error(&bench, &[seam, down], || ()).seam_points, 1);
    // radians are texels times the pitch where the point is
    let empty = DepthMaps::empty(SIZE, 2, Sampling::Nearest);
    let bench = Bench::new(&frame, &empty, &truth);
    let error = shadow_error(&bench, &[bench.point_at(DVec3::new(0.4, -2.0, 0.0), None)], || ());
    let angle = 0.2_f64.atan();
    // the pitch at the point stands for all of the way: it changes by less than theta^2 / 4 of itself
    let bound = error.edge_radians_largest * (angle * angle / 4.0 + 2.0 / 1024.0);
    assert!((error.edge_radians_largest - angle).abs() <= bound, "{error:?} {angle}");
}

#[test]
fn contact_gap_is_the_distance_to_the_occluder_that_the_bias_forgives() {
    let settings = Settings {
        near: Some(0.5),
        far: Some(6.0),
        bias: Bias::Constant(Some(0.4)),
        size: 512,
        ..settings()
    };
    let frame = half_covered(settings);
    let truth = truth_of(&frame);
    let maps = exact_maps(&frame, &truth);
    let bench = Bench::new(&frame, &maps, &truth);
    // the cover lies halfway: gaps of half the distance, below and above the bias of 0.4 x 5.5
    let at = |own: f64| bench.point_at(DVec3::new((own * own - 4.0).sqrt(), -2.0, 0.0), None);
    let points = [at(4.0), at(4.2), at(4.6)];
    let error = shadow_error(&bench, &points, || ());
    assert_eq!((error.false_light, error.faults_light), (2, 2));
    assert!((error.contact_gap - 2.1).abs() <= 1e-9, "{error:?}");
    let sources = attribute(&bench, &points, &PenumbraError::default());
    let bias = sources.iter().find(|source| source.name == "bias").unwrap();
    assert!((bias.measured - 2.1).abs() <= 1e-9, "{bias:?}");
}

#[test]
fn footprint_of_linear_sampling_is_wider_than_that_of_the_hard_test() {
    let frame = half_covered(settings());
    let truth = truth_of(&frame);
    let texel = 2.0 * 4.0 / f64::from(SIZE);
    let edges = |sampling| {
        let maps = DepthMaps::empty(SIZE, 2, sampling);
        let bench = Bench::new(&frame, &maps, &truth);
        let steps = (-400..400).map(|k| f64::from(k) / 100.0 * texel);
        steps
            .filter(|x| judge(&bench, &bench.point_at(DVec3::new(*x, -2.0, 0.3), None)).edge)
            .count()
    };
    // hard: the texels on either side of the border, which lies between two; linear: one more each
    let (hard, linear) = (edges(Sampling::Nearest), edges(Sampling::Linear));
    assert!(linear > hard + 100, "{hard} and {linear} of 800");
}

#[test]
fn doubling_every_stored_value_lights_some_shadows_and_darkens_nothing() {
    let frame = room(8, Settings { format: Format::D32, ..settings() });
    let truth = truth_of(&frame);
    let maps = cpu::make_maps(&frame).unwrap();
    let mut doubled = maps.clone();
    doubled.depths.iter_mut().for_each(|depth| *depth *= 2.0);
    let (plain, twice) = (Bench::new(&frame, &maps, &truth), Bench::new(&frame, &doubled, &truth));
    let mut lit = 0;
    for point in plain.points_scattered(5_000, 1) {
        let [before, after] = [&plain, &twice].map(|bench| judge(bench, &point).visibility);
        assert!(after >= before, "{point:?} was lit and is shadowed");
        lit += usize::from(after > before);
    }
    assert!(lit > 0, "no shadowed point turned lit");
}

#[test]
fn point_under_the_covers_border_is_an_edge_point_and_others_are_not() {
    let frame = half_covered(settings());
    let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    let bench = Bench::new(&frame, &maps, &truth);
    let at = |x: f64| judge(&bench, &bench.point_at(DVec3::new(x, -2.0, 0.3), None));
    // a texel at the map's centre spans 4 / N rad, and the floor is 2 below
    let texel = 2.0 * 4.0 / f64::from(SIZE);
    assert!(at(0.01 * texel).edge || at(-0.01 * texel).edge);
    for x in [-3.0 * texel, 3.0 * texel] {
        let judgement = at(x);
        assert!(!judgement.edge, "{x}");
        assert_eq!(judgement.lit, x < 0.0);
    }
    let under = at(3.0 * texel);
    // the cover lies halfway between the light and the floor
    assert!((under.gap - under.own / 2.0).abs() <= 1e-12);
}

#[test]
fn misclassified_points_are_as_far_from_the_true_edge_as_they_were_put() {
    let frame = half_covered(settings());
    // empty maps light every point: those under the cover are false light
    let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    let bench = Bench::new(&frame, &maps, &truth);
    let texels = 2.5;
    let r = texels * bench.texel();
    // stereographic: r = tan(theta / 2), and the border is the plane x = 0 through the light
    let x = 2.0 * (2.0 * r.atan()).tan();
    let point = bench.point_at(DVec3::new(x, -2.0, 0.0), None);
    let error = shadow_error(&bench, &[point], || ());
    assert_eq!((error.false_light, error.false_shadow), (1, 0));
    assert_eq!(error.faults(), 1);
    // the edge is found to 1/1024 of a ring's gap of 2 texels, on the nearest of 16 azimuths
    assert!((error.edge_texels_largest - texels).abs() <= 2.0 / 1024.0, "{error:?}");
}

#[test]
fn coverage_of_a_cone_that_the_border_halves_is_one_half() {
    let frame = half_covered(settings());
    let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    let bench = Bench::new(&frame, &maps, &truth);
    let at = |x: f64| coverage(&bench, &bench.point_at(DVec3::new(x, -2.0, 0.0), None), 0.05);
    // 64 rays of Vogel's spiral: a line through the centre splits them to within the rays beside
    // it, fewer than 4 sqrt(64) / 8 on either side
    assert!((at(0.0) - 0.5).abs() <= 4.0 / 64.0, "{}", at(0.0));
    assert_eq!((at(-0.5), at(0.5)), (1.0, 0.0));
}

#[test]
fn sources_stay_within_their_bounds() {
    for format in [Format::D16, Format::D24, Format::D32] {
        let frame = room(8, Settings { format, method: Method::FragmentDepth, ..settings() });
        let (maps, truth) = (cpu::make_maps(&frame).unwrap(), truth_of(&frame));
        let bench = Bench::new(&frame, &maps, &truth);
        let points = bench.points_scattered(3_000, 2);
        let sources = attribute(&bench, &points, &PenumbraError::default());
        for name in ["f32 arithmetic", "storage format", "resolution", "bias"] {
            let source = sources.iter().find(|source| source.name == name).unwrap();
            let predicted = source.predicted.unwrap();
            assert!(source.measured > 0.0 && source.measured <= predicted, "{format:?} {source:?}");
        }
    }
}

#[test]
fn linear_sampling_comes_nearer_to_the_coverage_than_the_hard_test() {
    let footprint = Settings { bias: Bias::Footprint, ..settings() };
    let hard = room(8, footprint.clone());
    let linear = room(8, Settings { sampling: Sampling::Linear, ..footprint });
    let truth = truth_of(&hard);
    let error = |frame: &Frame| {
        let maps = cpu::make_maps(frame).unwrap();
        let bench = Bench::new(frame, &maps, &truth);
        penumbra_error(&bench, &bench.points_from_camera(4_000, 3), || ())
    };
    let (hard, linear) = (error(&hard), error(&linear));
    assert!(hard.penumbra_points > 50 && linear.penumbra_points > 50);
    assert!(linear.penumbra_rmse < hard.penumbra_rmse, "{hard:?} {linear:?}");
}

#[test]
fn same_seed_gives_the_same_points() {
    let frame = room(8, settings());
    let (maps, truth) = (DepthMaps::empty(SIZE, 2, Sampling::Nearest), truth_of(&frame));
    let bench = Bench::new(&frame, &maps, &truth);
    assert_eq!(bench.points_scattered(50, 7), bench.points_scattered(50, 7));
    assert_ne!(bench.points_scattered(50, 7), bench.points_scattered(50, 8));
    assert_eq!(bench.points_from_camera(50, 7), bench.points_from_camera(50, 7));
}
