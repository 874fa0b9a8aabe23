//! Which maps a triangle is drawn into: nothing that covers a texel is lost. docs/classify.md.

mod common;

use common::exact::{Corners, direction, meet, triangle};
use common::{CASES, EPS, light, nearby, rng, spread, unit};
use dpsm::scalar::classify::*;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::{DPSM_BACK, DPSM_FRONT, dpsm_flip};
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::paraboloid::{dpsm_project, dpsm_texture_to_disk};
use dpsm::scalar::triangle::*;
use fastrand::Rng;

/// A light whose texels are large enough for triangles to fall between their centres.
fn coarse(rng: &mut Rng) -> DpsmLight<f32> {
    let light = light(rng);
    DpsmLight { near: 0.125, far: 16.0, size: rng.u32(8..33) as f32, ..light }
}

/// Centres of a map's texels within the stored disk.
fn centres(light: DpsmLight<f32>) -> impl Iterator<Item = Vec2<f64>> {
    let (size, guard) = (light.size as u32, f64::from(light.guard));
    let share = move |i: u32| (f64::from(i) + 0.5) / f64::from(size);
    (0..size * size)
        .map(move |i| dpsm_texture_to_disk(Vec2::new(share(i % size), share(i / size)), guard))
        .filter(move |uv| uv.length() <= 1.0 + guard)
}

fn flipped(corners: [Vec3<f32>; 3], hemisphere: u32) -> Corners {
    corners.map(|p| dpsm_flip(p, hemisphere).widen())
}

/// The maps of a triangle.
fn classify(corners: [Vec3<f32>; 3], light: DpsmLight<f32>) -> u32 {
    let z = corners[0].z + corners[1].z + corners[2].z;
    let own = if z >= 0.0 { DPSM_FRONT } else { DPSM_BACK };
    let [a, b, c] = corners.map(|p| dpsm_projected(dpsm_flip(p, own)));
    let height = dpsm_triangle_plane(a.p, b.p, c.p).w;
    dpsm_classify(a, b, c, height, own, light)
}

/// Twice the signed area of three disk points.
fn turn(a: Vec2<f64>, b: Vec2<f64>, p: Vec2<f64>) -> f64 {
    (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)
}

/// True where the direction of uv certainly meets the triangle, by arcs or by chords, between the
/// clipping spheres.
fn covers(corners: Corners, uv: Vec2<f64>, light: DpsmLight<f32>, chords: bool) -> bool {
    let Some(truth) = meet(corners, direction(uv)) else { return false };
    let (near, far) = (f64::from(light.near), f64::from(light.far));
    let within = truth.distance > near * 1.001 && truth.distance < far * 0.999;
    let [a, b, c] = corners.map(dpsm_project);
    let sides = [turn(a, b, uv), turn(b, c, uv), turn(c, a, uv)];
    // 32 eps for the corners
    let clear =
        32.0 * EPS * [b - a, c - b, a - c].map(|e| e.length()).into_iter().fold(0.0, f64::max);
    let by_chords = sides.iter().all(|&s| s > clear) || sides.iter().all(|&s| s < -clear);
    within && (truth.inside > truth.band || chords && by_chords)
}

#[test]
fn no_triangle_is_culled_that_covers_a_texel_centre() {
    let mut rng = rng("culled");
    let (mut culled, mut between, mut kinds) = (0, 0, [0; 4]);
    for _ in 0..CASES / 8 {
        let (mut corners, light) = (triangle(&mut rng), coarse(&mut rng));
        if rng.bool() {
            // about as large as a texel
            let a = unit(&mut rng) * spread(&mut rng, -2, 3);
            corners = [a, nearby(&mut rng, a, -7, -1), nearby(&mut rng, a, -7, -1)];
        }
        let [a, b, c] = corners;
        let maps = classify(corners, light);
        kinds[maps as usize] += 1;
        // by chords too where they are short
        let own = u32::from(a.z + b.z + c.z < 0.0);
        let [p, q, r] = flipped(corners, own).map(dpsm_project);
        let chords = [q - p, r - q, p - r].iter().all(|side| side.length() <= 0.25);
        for (hemisphere, bit) in [(DPSM_FRONT, DPSM_IN_FRONT), (DPSM_BACK, DPSM_IN_BACK)] {
            if maps & bit != 0 {
                continue;
            }
            // a chord on the other map is nobody's
            let own = (a.z + b.z + c.z >= 0.0) == (hemisphere == DPSM_FRONT);
            let flipped = flipped(corners, hemisphere);
            for uv in centres(light) {
                assert!(
                    !covers(flipped, uv, light, chords && own),
                    "{corners:?} covers {uv:?} of map {hemisphere}, {light:?}: {maps}"
                );
            }
        }
        if maps == DPSM_CULLED {
            culled += 1;
            let plane = dpsm_triangle_plane(a, b, c);
            let farthest = a.length().max(b.length()).max(c.length());
            let near = farthest < light.near || plane.w.abs() > light.far;
            between += usize::from(!near && plane.w != 0.0);
        }
    }
    println!("{culled} culled, {between} of them between texel centres; kinds {kinds:?}");
    assert!(between > CASES / 100 && kinds.iter().all(|&count| count >= 10));
}

/// Distance of a plane (unit normal, height) in the direction of uv.
fn plane_distance(normal: Vec3<f64>, height: f64, uv: Vec2<f64>) -> f64 {
    height / normal.dot(direction(uv))
}

/// Largest relative errors of distances interpolated on the disk over a triangle's inside: too near,
/// and too far.
fn measured([a, b, c]: Corners) -> [f64; 2] {
    let disks = [a, b, c].map(dpsm_project);
    let lengths = [a, b, c].map(|p| p.length());
    let normal = (b - a).cross(c - a);
    let normal = normal / normal.length();
    let height = normal.dot(a);
    let steps = 12;
    let mut worst = [0.0_f64; 2];
    for i in 0..=steps {
        for j in 0..=steps - i {
            let w = [i, j, steps - i - j].map(|k| f64::from(k) / f64::from(steps));
            let uv = disks[0] * w[0] + disks[1] * w[1] + disks[2] * w[2];
            let drawn = lengths[0] * w[0] + lengths[1] * w[1] + lengths[2] * w[2];
            let exact = plane_distance(normal, height, uv);
            if exact <= 0.0 {
                return [f64::INFINITY; 2]; // the plane is not there at all
            }
            let error = (drawn - exact) / exact;
            worst = [worst[0].max(-error), worst[1].max(error)];
        }
    }
    worst
}

/// A triangle of chords up to DPSM_TRIANGLE_CHORD in the front map, on any plane.
fn small(rng: &mut Rng) -> Corners {
    loop {
        let a = unit(rng);
        let a = Vec3::new(a.x, a.y, a.z.abs());
        let (b, c) = (nearby(rng, a, -8, 0), nearby(rng, a, -8, 0));
        let corners = [a, b, c].map(Vec3::widen);
        let [p, q, r] = corners.map(dpsm_project);
        let longest = [q - p, r - q, p - r].map(|e| e.length()).into_iter().fold(0.0, f64::max);
        if longest <= DPSM_TRIANGLE_CHORD {
            return corners;
        }
    }
}

#[test]
fn flat_error_is_an_upper_bound_up_to_a_tenth() {
    let mut rng = rng("flat error");
    let limits = [1e-4, 1e-3, 1e-2, 3e-2, 1e-1];
    let mut worst = [[0.0_f64; 5]; 2];
    for _ in 0..4 * CASES {
        let corners = small(&mut rng);
        let [a, b, c] = corners;
        let [p, q, r] = corners.map(dpsm_project);
        let lengths = Vec3::new(a.length(), b.length(), c.length());
        let bound = dpsm_classify_flat_error(
            DpsmHull { a: p, b: q, c: r },
            lengths,
            dpsm_triangle_plane(a, b, c),
        );
        let measured = measured(corners);
        for (side, bound) in [bound.x, bound.y].into_iter().enumerate() {
            // errors relative to the nearest corner's distance, and no more than a tenth in all
            let within = |limit: &f64| bound <= *limit && measured[1 - side] < 0.1;
            if let Some(at) = limits.iter().position(within) {
                worst[side][at] = worst[side][at].max(measured[side] / bound);
            }
        }
    }
    println!("measured over stated, too near and too far, for up to {limits:?}: {worst:.3?}");
    assert!(worst.as_flattened().iter().all(|&ratio| ratio <= 1.0), "{worst:?}");
    // and no wild overestimate
    assert!(worst.as_flattened().iter().all(|&ratio| ratio > 0.5), "{worst:?}");
}

#[test]
fn degenerate_triangles_are_culled() {
    let light = DpsmLight { near: 0.1, far: 10.0, ..dpsm::cases::light(0) };
    let [a, b, c] =
        [[0.0, 0.0, 2.0], [0.4, 0.0, 2.0], [0.0, 0.3, 2.5]].map(|[x, y, z]| Vec3::new(x, y, z));
    let kind = |a, b, c| classify([a, b, c], light);
    assert_ne!(kind(a, b, c), DPSM_CULLED);
    let nan = Vec3::new(0.0, f32::NAN, 1.0);
    assert!(dpsm_classify_usable(a) && !dpsm_classify_usable(nan));
    let zero = Vec3::splat(0.0);
    let aside = Vec3::new(0.0, 0.0, 3.0);
    let off = |x| Vec3::new(x, 0.0, 2.0);
    let degenerate = [
        [a, a, a],
        [a, a, b],
        [a, b, b],
        [zero, a, b],
        [zero, zero, zero],
        [a, aside, off(1.0)],
        [a, b, off(f32::NAN)],
        [a, b, off(f32::INFINITY)],
        [off(f32::NEG_INFINITY), b, c],
        [a, b, off(9.3e18)],
        [a * 0.01, b * 0.01, c * 0.01],
        [aside * 4.0, off(1.0) * 6.0, (a + Vec3::new(0.0, 1.0, 0.0)) * 6.0],
    ];
    for [a, b, c] in degenerate {
        assert_eq!(kind(a, b, c), DPSM_CULLED, "{a:?} {b:?} {c:?}");
        assert_eq!(kind(c, a, b), DPSM_CULLED, "{a:?} {b:?} {c:?}");
    }
}
