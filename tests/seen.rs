//! What a person sees first: which points are smoothly lit or deep in shadow, and what is counted
//! of them.

#![cfg(feature = "scene")]

#[path = "common/scenes.rs"]
mod scenes;

use dpsm::cpu;
use dpsm::measure::*;
use dpsm::render::{Filter, Frame, Kernel, Settings, Taps};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scene::Mesh;
use glam::{DVec3, Vec3, dvec3, vec3};
use scenes::{SIZE, frame_of, half_covered, settings, square};

/// What a texel at the map's centre is wide 2 below the light: 4 / N rad.
const TEXEL: f64 = 2.0 * 4.0 / SIZE as f64;

/// The surroundings of points in a frame whose maps are sampled somehow.
fn all(frame: &Frame, sampling: Sampling, at: &[DVec3]) -> Vec<Surroundings> {
    let (truth, maps) = (truth_of(frame), DepthMaps::empty(SIZE, 2, sampling));
    let bench = Bench::new(frame, &maps, &truth);
    let of = |at: &DVec3| {
        let point = bench.point_at(*at, None);
        surroundings(&bench, &point, bench.is_lit(&point))
    };
    at.iter().map(of).collect()
}

fn count(of: &[Surroundings], wanted: Surroundings) -> usize {
    of.iter().filter(|found| **found == wanted).count()
}

fn mesh(name: &str, positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    let normals = vec![Vec3::Y; positions.len()];
    Mesh { name: name.into(), positions, normals, triangles, ..Mesh::default() }
}

/// An upright wall of half-width 5 from y = -2 to y = 3 at x = `x`, across the z axis.
fn wall(x: f32) -> Mesh {
    let corners = [(-2.0, -5.0), (-2.0, 5.0), (3.0, 5.0), (3.0, -5.0)];
    let positions = corners.map(|(y, z)| vec3(x, y, z)).to_vec();
    mesh("wall", positions, vec![[0, 1, 2], [0, 2, 3]])
}

/// A grid of `cells` x `cells` around (0, -2, 0), `half` to each side, of this height.
fn field(cells: u32, half: f32, height: impl Fn(f32, f32) -> f32) -> Mesh {
    let place = |i: u32| half * (2.0 * i as f32 / cells as f32 - 1.0);
    let row = cells + 1;
    let positions = (0..row * row).map(|i| {
        let [x, z] = [i % row, i / row].map(place);
        vec3(x, -2.0 + height(x, z), z)
    });
    let cell = |i: u32| {
        let [a, b] = [i / cells * row + i % cells, i / cells * row + i % cells + row];
        [[a, b, b + 1], [a, b + 1, a + 1]]
    };
    mesh("field", positions.collect(), (0..cells * cells).flat_map(cell).collect())
}

/// A ball of so many rings at a place.
fn ball(middle: Vec3, radius: f32, rings: u32) -> Mesh {
    let segments = 2 * rings;
    let at = |ring: u32, segment: u32| {
        let [polar, around] =
            [ring, segment].map(|k| std::f32::consts::PI * k as f32 / rings as f32);
        middle + radius * vec3(polar.sin() * around.cos(), polar.cos(), polar.sin() * around.sin())
    };
    let index = |ring: u32, segment: u32| ring * segments + segment % segments;
    let positions = (0..=rings).flat_map(|r| (0..segments).map(move |s| (r, s)));
    let cells = (0..rings).flat_map(|r| (0..segments).map(move |s| (r, s)));
    let triangles = cells.flat_map(|(r, s)| {
        let [a, b, c, d] =
            [(r, s), (r, s + 1), (r + 1, s + 1), (r + 1, s)].map(|(r, s)| index(r, s));
        [[a, b, c], [a, c, d]]
    });
    mesh("ball", positions.map(|(r, s)| at(r, s)).collect(), triangles.collect())
}

const BOTH: [Sampling; 2] = [Sampling::Nearest, Sampling::Linear];

#[test]
fn all_of_a_plane_is_smoothly_lit() {
    let frame = frame_of(vec![square("floor", 0.0, -2.0, 50.0)], settings());
    let at: Vec<DVec3> = (0..200).map(|k| dvec3(0.031 * f64::from(k), -2.0, 0.7)).collect();
    for sampling in BOTH {
        assert_eq!(count(&all(&frame, sampling, &at), Surroundings::SmoothlyLit), at.len());
    }
}

#[test]
fn a_crease_of_two_meshes_that_touch_is_smoothly_lit() {
    // the wall's foot lies within the floor's triangles: no corner in common
    let frame = frame_of(vec![square("floor", 0.0, -2.0, 50.0), wall(1.5)], settings());
    let floor = (0..60).map(|k| dvec3(1.5 - 0.05 * TEXEL * f64::from(k), -2.0, 0.3));
    let wall = (0..60).map(|k| dvec3(1.5, -2.0 + 0.05 * TEXEL * f64::from(k), 0.3));
    let at: Vec<DVec3> = floor.chain(wall).collect();
    for sampling in BOTH {
        assert_eq!(count(&all(&frame, sampling, &at), Surroundings::SmoothlyLit), at.len());
    }
}

#[test]
fn a_dense_ball_is_smoothly_lit_but_for_its_outline() {
    // triangles of about a third of a texel
    let middle = vec3(0.3, -2.0, 0.2);
    let ball = ball(middle, 0.8, 128);
    let frame = frame_of(vec![ball, square("floor", 0.0, -4.0, 3.0)], settings());
    let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    let bench = Bench::new(&frame, &maps, &truth);
    let (mut inner, mut outline) = (0, 0);
    for point in bench.points_scattered(20_000, 1) {
        let from_middle = point.world - middle.as_dvec3();
        if from_middle.length() > 0.9 || !bench.is_lit(&point) {
            continue;
        }
        let cosine = from_middle.normalize().dot(-point.world.normalize());
        let found = surroundings(&bench, &point, true);
        if cosine > 0.6 {
            inner += 1;
            assert_eq!(found, Surroundings::SmoothlyLit, "{point:?}");
        } else if cosine < 0.05 {
            outline += 1;
            assert_eq!(found, Surroundings::Mixed, "{point:?}");
        }
    }
    assert!(inner > 100 && outline > 5, "{inner} and {outline} points");
}

#[test]
fn nothing_is_smoothly_lit_or_deep_in_shadow_beside_an_outline() {
    // the cover's shadow begins in a texel's middle, 0.4 texels from where the light is overhead
    let cover = square("cover", 50.0 + 0.2 * TEXEL as f32, -1.0, 50.0);
    let frame = frame_of(vec![square("floor", 0.0, -2.0, 50.0), cover], settings());
    for (sampling, texels) in [(Sampling::Nearest, 1.0), (Sampling::Linear, 2.0)] {
        let cover = |x: f64| dvec3(x * 0.5 * TEXEL, -1.0, 0.3);
        let floor = |x: f64| dvec3(x * TEXEL, -2.0, 0.3);
        // under the cover, on the floor beside it, on the cover; texels end at whole numbers
        let place = |x: f64| [floor(x), floor(1.0 - x), cover(x)];
        let near = place(texels - 0.1).map(|at| all(&frame, sampling, &[at])[0]);
        assert_eq!(near, [Surroundings::Mixed; 3], "{sampling:?}");
        let far = place(texels + 0.1).map(|at| all(&frame, sampling, &[at])[0]);
        let [shadow, lit] = [Surroundings::DeepInShadow, Surroundings::SmoothlyLit];
        assert_eq!(far, [shadow, lit, lit], "{sampling:?}");
    }
}

#[test]
fn a_kernel_asks_for_as_much_around_it() {
    // a kernel of 8 texels' radius
    let kernel = Kernel::Tangent(8.0 * 4.0 / SIZE as f32);
    let filter = Filter::Disk(Taps { count: 16, kernel });
    let frame = half_covered(Settings { filter, ..settings() });
    let at = [7.5, 9.5].map(|x| dvec3(x * TEXEL, -2.0, 0.3));
    let found = all(&frame, Sampling::Nearest, &at);
    assert_eq!(found, [Surroundings::Mixed, Surroundings::DeepInShadow]);
}

#[test]
fn what_a_thin_gap_shadows_is_deep_in_shadow_and_a_small_fold_is_not() {
    // a board a fiftieth of a texel above the floor
    let board = square("board", 0.0, -2.0 + 0.02 * TEXEL as f32, 1.0);
    let frame = frame_of(vec![square("floor", 0.0, -2.0, 50.0), board], settings());
    let at: Vec<DVec3> = (0..50).map(|k| dvec3(0.017 * f64::from(k), -2.0, 0.3)).collect();
    for sampling in BOTH {
        assert_eq!(count(&all(&frame, sampling, &at), Surroundings::DeepInShadow), at.len());
    }
    // a dense surface in folds a third of a texel high: its shadows are within itself; in folds of
    // six they are deep
    for (height, waves, deep) in [(0.3, 60.0, 0.0..0.01), (6.0, 4.0, 0.3..0.95)] {
        let fold = |x: f32, _| height * TEXEL as f32 * (waves * x).sin();
        let frame = frame_of(vec![field(400, 3.0, fold)], settings());
        let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
        let bench = Bench::new(&frame, &maps, &truth);
        let points = bench.points_scattered(5_000, 1);
        let dark = points.iter().filter(|point| !bench.is_lit(point));
        let found: Vec<_> = dark.map(|point| surroundings(&bench, point, false)).collect();
        assert!(found.len() > 300, "{} points in shadow", found.len());
        let share = count(&found, Surroundings::DeepInShadow) as f64 / found.len() as f64;
        println!("folds of {height} texels: {share} of {} points in shadow are deep", found.len());
        assert!(deep.contains(&share), "{share} of {}", found.len());
    }
}

#[test]
fn empty_maps_leak_everywhere_and_full_ones_are_acne_everywhere() {
    let cover = square("cover", 50.0 + 0.2 * TEXEL as f32, -1.0, 50.0);
    let frame = frame_of(vec![square("floor", 0.0, -2.0, 50.0), cover], settings());
    let truth = truth_of(&frame);
    let mut maps = DepthMaps::empty(SIZE, 2, Sampling::Nearest);
    let at = |x: f64| dvec3(x * TEXEL, -2.0, 0.3);
    let error = |maps: &DepthMaps| {
        let bench = Bench::new(&frame, maps, &truth);
        let places = [-8.0, -6.0, -4.0, 0.1, 0.6, 3.0, 5.0];
        let points = places.map(|x| bench.point_at(at(x), None));
        seen_error(&bench, &points, &surroundings_of(&bench, &points, || ()))
    };
    let empty = error(&maps);
    let counts =
        |e: &SeenError| [e.points, e.wrong, e.smoothly_lit, e.acne, e.deep_in_shadow, e.leak];
    assert_eq!(counts(&empty), [7, 3, 3, 0, 2, 2]);
    assert_eq!((empty.acne_mean, empty.leak_mean), (0.0, 1.0));
    assert_eq!(
        [empty.wrong_share(), empty.acne_share(), empty.leak_share()],
        [3.0 / 7.0, 0.0, 1.0]
    );
    assert!((empty.rmse - (3.0_f64 / 7.0).sqrt()).abs() < 1e-12, "{empty:?}");
    maps.depths.fill(0.0);
    let full = error(&maps);
    assert_eq!(counts(&full), [7, 4, 3, 3, 2, 0]);
    assert_eq!((full.acne_mean, full.leak_mean), (1.0, 0.0));
}

#[test]
fn triangles_are_connected_over_what_is_within_the_ball() {
    // cells of 1; the second mesh's corners coincide with the first one's at x = 2
    let mut right = field(4, 2.0, |_, _| 0.0);
    right.positions.iter_mut().for_each(|p| p.x += 4.0);
    let frame = frame_of(vec![field(4, 2.0, |_, _| 0.0), right], settings());
    let truth = truth_of(&frame);
    let of = |x: f64, radius: f64| {
        let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
        let bench = Bench::new(&frame, &maps, &truth);
        let point = bench.point_at(dvec3(x, -2.0, 0.4), None);
        truth.connected(point.triangle.unwrap(), point.world, radius).len()
    };
    // within a triangle, away from its edges; over the cell's diagonal; both meshes
    assert_eq!(of(0.2, 0.1), 1);
    assert_eq!(of(0.2, 0.15), 2);
    assert_eq!(of(0.2, 100.0), 2 * 32);
    assert_eq!(of(1.95, 0.06), 2);
    assert!(truth.connected(1_000_000, DVec3::ZERO, 1.0).is_empty());
}

/// The errors of a picture of letters, a row a line: `X` is off by -1, `x` by 0.4, `.` by nothing, and
/// a space shows no surface.
fn drawn(rows: &[&str]) -> Vec<Option<f64>> {
    let off = |letter: char| match letter {
        'X' => Some(-1.0),
        'x' => Some(0.4),
        '.' => Some(0.0),
        _ => None,
    };
    rows.iter().flat_map(|row| row.chars().map(off)).collect()
}

#[test]
fn patches_and_dots_of_a_drawn_picture_are_counted() {
    let rows = [
        "X......X", // two dots in corners of the picture, not beside each other
        "..X....x", ".X.X.. .", "..X... .", // a ring of four, joined diagonally
        "......xX", // pixels that are nearly right part nothing off
        "XX......", "........", ".....X.X",
    ];
    let errors = drawn(&rows);
    let hard = picture_error(&errors, 8, 0.5);
    assert_eq!((hard.size, hard.pixels), ([8, 8], 62));
    assert_eq!((hard.wrong, hard.largest_patch, hard.dots), (11, 4, 5));
    assert_eq!(hard.wrong_share(), 11.0 / 62.0);
    assert!((hard.rmse - ((11.0 + 2.0 * 0.16) / 62.0_f64).sqrt()).abs() < 1e-12, "{hard:?}");
    // what is off by 0.4 counts as well, and joins the corner's dot below it
    let soft = picture_error(&errors, 8, 0.1);
    assert_eq!((soft.wrong, soft.largest_patch, soft.dots), (13, 4, 3));
    // a row does not go on in the next one
    let turned = picture_error(&drawn(&["...X", "X...", "...."]), 4, 0.5);
    assert_eq!((turned.wrong, turned.largest_patch, turned.dots), (2, 1, 2));
    // a patch that is joined at its foot alone, and what is too dark
    let joined = picture_error(&drawn(&["X.X", "X.X", "XXX"]), 3, 0.5);
    assert_eq!((joined.wrong, joined.largest_patch), (7, 7));
    assert_eq!(picture_error(&[Some(-1.0), Some(-0.4)], 2, 0.5).wrong, 1);
    assert_eq!(picture_error(&[], 8, 0.5).wrong_share(), 0.0);
    assert_eq!(picture_error(&drawn(&["X"]), 0, 0.5).wrong, 1);
}

#[test]
fn every_pixel_of_a_picture_is_judged() {
    let cover = square("cover", 1.0, -1.0, 0.5);
    let frame = frame_of(vec![square("floor", 0.0, -2.0, 50.0), cover], settings());
    let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
    let bench = Bench::new(&frame, &maps, &truth);
    let seen = bench.points_of_grid([40, 30]);
    let errors = errors_of_image(&bench, &seen, 40, || ());
    let error = picture_error(&errors, 40, 0.5);
    // the camera looks straight down from 5, so a part of the shadow shows beside the cover
    assert_eq!((error.size, error.pixels), ([40, 30], 1200));
    let dark = seen.iter().flatten().filter(|point| !bench.sees(point)).count();
    assert!(dark > 10, "{dark} pixels");
    assert_eq!((error.wrong, error.largest_patch, error.dots), (dark, dark, 0));
    assert_eq!(bench.points_of_image().len(), 64 * 48);
}

#[test]
fn sides_turned_away_from_the_light_are_right_whatever_the_maps_say() {
    // the light at the origin, above the floor; the camera at 5 above both
    let frame = frame_of(vec![square("ceiling", 0.0, 1.0, 50.0)], settings());
    let truth = truth_of(&frame);
    let mut maps = DepthMaps::empty(SIZE, 2, Sampling::Nearest);
    for depth in [0.0, 1.0] {
        maps.depths.fill(depth);
        let bench = Bench::new(&frame, &maps, &truth);
        let seen = bench.points_of_grid([40, 30]);
        let errors = errors_of_image(&bench, &seen, 40, || ());
        assert_eq!((picture_error(&errors, 40, 0.5).wrong, errors.len()), (0, 1200), "{depth}");
    }
}

#[test]
fn kernels_are_judged_with_the_noise_of_their_pixels() {
    let cover = square("cover", 1.0, -1.0, 0.5);
    let filter = Filter::Disk(Taps { count: 4, kernel: Kernel::Tangent(0.2) });
    let frame =
        frame_of(vec![square("floor", 0.0, -2.0, 50.0), cover], Settings { filter, ..settings() });
    let truth = truth_of(&frame);
    let maps = cpu::make_maps(&frame).unwrap();
    let bench = Bench::new(&frame, &maps, &truth);
    // every pixel sees the same point of the penumbra
    let point = bench.point_at(dvec3(1.0, -2.0, 0.1), None);
    let penumbra = vec![Some(point); 64];
    let errors = errors_of_image(&bench, &penumbra, 8, || ());
    let values: std::collections::HashSet<u64> =
        errors.iter().flatten().map(|error| error.to_bits()).collect();
    assert!(values.len() > 1, "{values:?}");
}

/// A box around (0, y, 0), seen from outside or from inside.
fn solid(y: f32, half: f32, outside: bool) -> Mesh {
    let corner = |i: u32| {
        let side = |bit: u32| if i >> bit & 1 == 1 { half } else { -half };
        vec3(side(0), y + side(1), side(2))
    };
    let faces: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    let turned = |[a, b, c]: [u32; 3]| if outside { [a, b, c] } else { [c, b, a] };
    Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: faces.into_iter().flat_map(halves).map(turned).collect(),
        normals: vec![Vec3::Y; 8],
        ..square("solid", 0.0, 0.0, 1.0)
    }
}

#[test]
fn sides_of_solids_are_turned_away_and_no_others() {
    // the light is at the origin; top, bottom and side of a box below it
    let points = [dvec3(0.1, -1.5, 0.0), dvec3(0.1, -2.5, 0.0), dvec3(0.5, -2.2, 0.1)];
    let of = |mesh: Mesh, at: &[DVec3]| {
        let frame = frame_of(vec![mesh], settings());
        let (truth, maps) = (truth_of(&frame), DepthMaps::empty(SIZE, 2, Sampling::Nearest));
        let bench = Bench::new(&frame, &maps, &truth);
        let on = |p: &DVec3| {
            let on_it = |t: &u32| {
                let [a, b, c] = frame.triangles[*t as usize]
                    .map(|i| frame.vertices[i as usize].position.as_dvec3());
                (b - a).cross(c - a).dot(*p - a).abs() < 1e-6
            };
            let triangle = (0..frame.triangles.len() as u32).find(on_it);
            Point { triangle, ..bench.point_at(*p, None) }
        };
        turned_away(&bench, &at.iter().map(on).collect::<Vec<_>>())
    };
    assert_eq!(of(solid(-2.0, 0.5, true), &points), [false, true, true]);
    // inside out, or open: which side is seen is not known
    assert_eq!(of(solid(-2.0, 0.5, false), &points), [false; 3]);
    let mut open = solid(-2.0, 0.5, true);
    open.triangles.pop();
    assert_eq!(of(open, &points), [false; 3]);
    // a room's walls all face a light in it, whichever way they are wound
    let walls = [dvec3(0.1, -1.0, 0.0), dvec3(1.0, 0.5, 0.1)];
    assert_eq!(of(solid(0.0, 1.0, false), &walls), [false; 2]);
    assert_eq!(of(solid(0.0, 1.0, true), &walls), [false; 2]);
}

#[test]
fn pictures_by_rays_and_by_maps_differ_at_outlines_alone() {
    let cover = square("cover", 1.0, -1.0, 0.5);
    let bare = Settings { exposure: Some(1.0), ..settings() };
    let frame = frame_of(vec![square("floor", 0.0, -2.0, 50.0), cover], bare.clone());
    let by_rays = picture_by_rays(&frame).picture(1.0);
    let by_maps = cpu::render(&frame).unwrap().lit;
    let levels = |[a, b]: [&[u8; 4]; 2]| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max();
    let apart = |i: usize| levels([&by_rays.pixels[i], &by_maps.pixels[i]]).unwrap();
    let lit = cpu::render(&frame_of(vec![square("floor", 0.0, -2.0, 50.0)], bare)).unwrap().lit;
    let dark = (0..lit.pixels.len())
        .filter(|i| lit.pixels[*i][1] > by_rays.pixels[*i][1].saturating_add(20));
    let dark = dark.count();
    let far = (0..by_rays.pixels.len()).filter(|i| apart(*i) > 8).count();
    println!("{far} of {} pixels apart, {dark} dark", by_rays.pixels.len());
    assert!(far > 0 && dark > 50 && far < dark / 2, "{far} {dark}");
}
