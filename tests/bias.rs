//! The biases: no plane that the light sees is shadowed by itself, and what that costs.

mod common;

use common::planes::*;
use common::{CASES, EPS, Worst, light, point, rng, spread, uniform, unit};
use dpsm::scalar::bias::*;
use dpsm::scalar::filter::{DPSM_TAP_HARD, DpsmTaps, dpsm_filter_disk};
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::{dpsm_flip, dpsm_to_light};
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::paraboloid::*;
use dpsm::scalar::plane::dpsm_visibility_plane;

/// Planes for each configuration: with 3 formats, 6 sizes and 3 radii over 1e5 in all.
const PLANES: usize = 2000;

#[test]
fn no_plane_shadows_itself_along_the_texels_centre() {
    let mut rng = rng("texel centre");
    for size in SIZES {
        for steps in FORMATS {
            let light = plain_light(size);
            for _ in 0..3 * PLANES {
                let (p, normal) = grazing(&mut rng, size);
                let map = PlaneMap { p: p.widen(), normal, light, steps, tap: [0, 0] };
                let receiver = dpsm_receiver(p, normal.narrow(), 0.0);
                let lit =
                    dpsm_visibility_texel_centre(&map, p, receiver, light, quantum(steps), 0.0);
                assert_eq!(lit, 1.0, "{size} {steps:?} {p:?} {normal:?}");
            }
        }
    }
}

#[test]
fn no_plane_shadows_itself_at_any_texel_of_the_footprints_window() {
    let mut rng = rng("footprint");
    for size in SIZES {
        for steps in FORMATS {
            for radius in [0, 1, 3] {
                let light = plain_light(size);
                for _ in 0..PLANES {
                    let (p, normal) = grazing(&mut rng, size);
                    let tap = tap(&mut rng, radius);
                    let map = PlaneMap { p: p.widen(), normal, light, steps, tap };
                    let receiver = dpsm_receiver(p, normal.narrow(), 0.0);
                    let texels = radius as f32 + 0.5;
                    let q = quantum(steps);
                    let lit = dpsm_visibility_footprint(&map, p, receiver, light, texels, q, 0.0);
                    assert_eq!(lit, 1.0, "{size} {steps:?} {radius} {tap:?} {p:?} {normal:?}");
                }
            }
        }
    }
}

#[test]
fn footprint_is_tight_where_the_plane_rises_towards_the_windows_corner() {
    let mut rng = rng("tight");
    for size in SIZES.into_iter().filter(|size| *size >= 256) {
        for radius in [0, 1, 3] {
            let most = (0..PLANES).map(|_| {
                let (p, normal) = worst(&mut rng, size, radius);
                let light = plain_light(size).widen();
                let receiver = dpsm_receiver(p.widen(), normal, 0.0);
                let uv = dpsm_project_own(p.widen());
                let bias = dpsm_bias_footprint(receiver, uv, f64::from(radius) + 0.5, light);
                needed(p, normal, plain_light(size), radius) / bias
            });
            let most = most.fold(0.0, f64::max);
            println!("{size}, radius {radius}: {most:.4}");
            assert!((0.98..=1.0).contains(&most), "{size}, radius {radius}: {most}");
        }
    }
}

#[test]
fn receivers_plane_is_that_of_either_side_and_any_length() {
    let mut rng = rng("receiver");
    let [mut plane, mut height, mut distance, mut cosine] = [(); 4].map(|()| Worst::default());
    for _ in 0..CASES {
        let p = point(&mut rng, -30, 30);
        let normal = unit(&mut rng) * spread(&mut rng, -49, 60);
        let receiver = dpsm_receiver(p, normal, 0.0);
        assert_eq!(receiver, dpsm_receiver(p, -normal, 0.0));
        assert!(receiver.plane.w >= 0.0);
        let l = p.widen().length();
        let given = normal.widen() / normal.widen().length();
        let facing = given.dot(p.widen());
        // edge-on rounding may turn it either way, and both are the same plane
        if facing.abs() > 14.0 * EPS * l {
            let off = receiver.plane.xyz().widen() - given * facing.signum();
            plane.note(off.x.abs().max(off.y.abs()).max(off.z.abs()), 11.0 * EPS, (p, normal));
        }
        height.note((f64::from(receiver.plane.w) - facing.abs()).abs(), 14.0 * EPS * l, p);
        distance.note((f64::from(receiver.distance) - l).abs(), 6.0 * EPS * l, p);
        let off = f64::from(dpsm_receiver_cosine(receiver)) - facing.abs() / l;
        cosine.note(off.abs(), 23.0 * EPS, p);
    }
    plane.check("dpsm_receiver, normal");
    height.check("dpsm_receiver, height");
    distance.check("dpsm_receiver, distance");
    cosine.check("dpsm_receiver_cosine");
}

#[test]
fn receiver_without_a_normal_faces_the_light() {
    let mut rng = rng("no normal");
    for _ in 0..CASES {
        let p = point(&mut rng, -20, 20);
        let receiver = dpsm_receiver(p, Vec3::splat(0.0), 0.0);
        let d = p.widen() / p.widen().length();
        assert!((receiver.plane.xyz().widen() - d).length() <= 16.0 * EPS, "{p:?}");
        assert_eq!(receiver.plane.w, receiver.distance);
    }
    let nowhere: DpsmReceiver<f32> = dpsm_receiver(Vec3::splat(0.0), Vec3::splat(0.0), 0.0);
    assert_eq!((nowhere.plane.w, nowhere.distance), (0.0, 0.0));
}

#[test]
fn plane_is_met_no_farther_than_it_is_and_within_its_bound() {
    let mut rng = rng("plane's distance");
    let mut worst = Worst::default();
    let [mut met_by, mut missed] = [0, 0];
    for _ in 0..CASES {
        let p = point(&mut rng, -8, 8);
        let normal = unit(&mut rng);
        let uv = Vec2::new(uniform(&mut rng, -1.2, 1.2), uniform(&mut rng, -1.2, 1.2));
        let hemisphere = rng.u32(0..2);
        let d = dpsm_flip(dpsm_unproject(uv.widen()), hemisphere);
        let receiver = dpsm_receiver(p, normal, 0.0);
        let l = f64::from(dpsm_receiver_distance(receiver, uv, hemisphere));
        assert!(l > 0.0 && l.is_finite());
        // of the receiver as it was rounded: its own bounds are another test's
        let plane = receiver.plane.widen();
        let cosine = plane.xyz().dot(d) / plane.xyz().length();
        if cosine <= 8.0 * EPS {
            missed += usize::from(cosine < -8.0 * EPS);
            assert!(cosine > -8.0 * EPS || l == DPSM_SMALLEST, "{p:?} {normal:?} {uv:?}");
            continue;
        }
        met_by += 1;
        let exact = plane.w / plane.xyz().dot(d);
        assert!(l <= exact * (1.0 + EPS), "{l} beyond {exact}: {p:?} {normal:?} {uv:?}");
        worst.note(exact - l, exact * (96.0 * EPS / cosine), (p, normal, uv));
    }
    worst.check("dpsm_receiver_distance");
    assert!(met_by > CASES / 4 && missed > CASES / 4);
}

#[test]
fn slack_is_the_sum_of_its_named_terms() {
    let mut rng = rng("slack");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let light = light(&mut rng);
        let (near, far) = (f64::from(light.near), f64::from(light.far));
        let l = light.near + (light.far - light.near) * rng.f32();
        let (quantum, tolerance) = (rng.f32() / 65536.0, rng.f32() / 1024.0);
        let slack = f64::from(dpsm_bias_slack(l, light, quantum, tolerance));
        // a receiver's 10.5 l + 4.5 near (docs/visibility.md), a stored one's 11.5 l + 5.5 near
        // (docs/caster.md), 2 of the depth itself for its storing and the difference
        let l = f64::from(l);
        let rounding = EPS * (24.0 * l + 10.0 * near) / (far - near);
        let exact = f64::from(quantum) + rounding + f64::from(tolerance) * l / (far - near);
        worst.note((slack - exact).abs(), 7.0 * EPS * exact, (light, l));
    }
    worst.check("dpsm_bias_slack");
}

#[test]
fn slack_of_a_float_is_in_proportion_to_the_distance_whatever_far_is() {
    for far in [10.0, 1e4, 2e7, 1e12] {
        let light = DpsmLight { near: far / (1 << 20) as f32, far, ..plain_light(1024) };
        for l in [light.near, 2.0 * light.near, 1e-3 * far, far] {
            let slack = f64::from(dpsm_bias_slack(l, light, 0.0, 0.0));
            let distance = slack * f64::from(light.far - light.near);
            assert!(distance <= 35.0 * EPS * f64::from(l), "{far} {l} {distance}");
        }
    }
}

#[test]
fn world_positions_far_from_the_origin_shadow_no_plane() {
    let mut rng = rng("world");
    let mut needed = [0; 4];
    for size in [256, 1024, 4096] {
        for offset in [0.0_f32, 100.0, 8192.0, 1e5] {
            let position = Vec3::new(offset, 0.75 * offset, -offset) + unit(&mut rng);
            let light = DpsmLight { position, ..plain_light(size) };
            let exact = light.widen();
            for _ in 0..3 * PLANES {
                let (p, normal) = grazing(&mut rng, size);
                let p = p.widen();
                let to_world =
                    |v: Vec3<f64>| exact.right * v.x + exact.up * v.y + exact.forward * v.z;
                // the world position as the vertex stage interpolates it: rounded, up to an eps more
                let world = exact.position + to_world(p);
                let loose = |c: f64| (c * (1.0 + EPS * (2.0 * rng.f64() - 1.0))) as f32;
                let world = [world.x, world.y, world.z].map(loose);
                let world = Vec3::new(world[0], world[1], world[2]);
                let seen = dpsm_to_light(world, light);
                let map = PlaneMap { p, normal, light, steps: None, tap: [0, 0] };
                let share = |error: f32| {
                    let receiver = dpsm_receiver(seen, normal.narrow(), error);
                    [
                        dpsm_visibility_texel_centre(&map, seen, receiver, light, 0.0, 0.0),
                        dpsm_visibility_footprint(&map, seen, receiver, light, 0.5, 0.0, 0.0),
                        dpsm_visibility_plane(&map, seen, receiver, light, 0.0, 0.0),
                        dpsm_filter_disk(
                            &map,
                            seen,
                            receiver,
                            0.01,
                            light,
                            taps(),
                            Vec2::new(1.0, 0.0),
                        ),
                    ]
                };
                let error = dpsm_position_error(world);
                // seen so edge-on that its position may lie on either side, it may be dark
                if normal.dot(p) <= f64::from(error) {
                    continue;
                }
                let lit = share(error);
                assert_eq!(lit, [1.0; 4], "{size} {offset} {p:?} {normal:?}");
                for (needed, share) in needed.iter_mut().zip(share(0.0)) {
                    *needed += usize::from(share < 1.0);
                }
            }
        }
    }
    println!("shadowed without the term: {needed:?}");
    assert!(needed.iter().all(|&count| count > 100), "{needed:?}");
}

fn taps() -> DpsmTaps<f32> {
    DpsmTaps { count: 16, kind: DPSM_TAP_HARD, quantum: 0.0, tolerance: 0.0 }
}

#[test]
fn window_reaches_its_farthest_corner_and_no_farther() {
    let mut rng = rng("window");
    for _ in 0..CASES {
        let light = plain_light(SIZES[rng.usize(0..6)]).widen();
        let uv = Vec2::new(uniform(&mut rng, -1.0, 1.0), uniform(&mut rng, -1.0, 1.0)).widen();
        let texels = f64::from(uniform(&mut rng, 0.0, 4.0));
        let square = dpsm_bias_window(uv, texels, light);
        let half = texels * dpsm_texel_width(light.size, light.guard);
        let d = dpsm_unproject(uv);
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let far = corners.map(|(x, y)| (dpsm_unproject(uv + Vec2::new(x, y) * half) - d).length());
        let most = far.into_iter().fold(0.0, f64::max);
        assert!(most <= square.sqrt() + 1e-15, "{most} {}", square.sqrt());
        // one corner at least is turned inward, so no farther out than r^2 + 2 half^2
        let r = uv.length();
        let inner = (r - std::f64::consts::SQRT_2 * half).max(0.0);
        let outer = 1.0 + r * r + 2.0 * half * half;
        let spread = (outer / (1.0 + inner * inner)).sqrt();
        assert!(square.sqrt() <= most * spread * (1.0 + 1e-5), "{most} {}", square.sqrt());
    }
    let wide = dpsm_bias_window(Vec2::new(0.0, 0.0), 1e6, plain_light(128).widen());
    assert_eq!(wide, 2.0);
}

#[test]
fn plane_bias_is_the_drop_to_the_nearest_point_within_the_cone() {
    let mut rng = rng("plane bias");
    let light = plain_light(256).widen();
    for _ in 0..CASES {
        let incidence = 89.9_f64.to_radians() * rng.f64();
        let psi = std::f64::consts::FRAC_PI_2 * f64::from(spread(&mut rng, -14, 0).abs());
        let l = f64::from(uniform(&mut rng, 0.1, 9.0));
        let chord = 2.0 * (psi / 2.0).sin();
        let bias =
            dpsm_bias_plane(incidence.cos(), l, chord * chord, DPSM_RECEIVER_ROUNDING, light);
        let nearest = (incidence - psi).max(0.0).cos();
        let exact = l * (1.0 - incidence.cos() / nearest) / (light.far - light.near);
        // the planes' rounding is allowed for: 64 eps of the distance over the cosine there
        let allowed = DPSM_RECEIVER_ROUNDING * l / nearest / (light.far - light.near);
        assert!(
            bias >= exact && bias <= exact + 1.001 * allowed,
            "{incidence} {psi} {bias} {exact}"
        );
    }
}

#[test]
fn texels_centre_is_that_of_the_texel_which_is_read() {
    let mut rng = rng("centre");
    for _ in 0..CASES {
        let size = SIZES[rng.usize(0..6)];
        let light = plain_light(size);
        let mut uv = Vec2::new(uniform(&mut rng, -1.0, 1.0), uniform(&mut rng, -1.0, 1.0));
        if rng.bool() {
            // on a border, or within rounding of one
            let border = (f64::from(size) * rng.f64()).floor() / f64::from(size);
            uv.x = dpsm_texture_to_disk(Vec2::new(border, 0.5), f64::from(light.guard)).x as f32;
        }
        let centre = dpsm_texel_centre(uv, light);
        let at = |uv: Vec2<f32>| dpsm_disk_to_texture(uv, light.guard) * light.size;
        let off = at(centre) - Vec2::splat(0.5);
        let rounding = 9.0 * EPS * f64::from(size);
        for (off, from) in [(off.x, (uv - centre).x), (off.y, (uv - centre).y)] {
            assert!(f64::from((off - off.round()).abs()) <= rounding, "{size} {uv:?}");
            let texels = f64::from(from) / dpsm_texel_width(f64::from(size), light.guard.into());
            assert!(texels.abs() <= 0.5 + rounding, "{size} {uv:?}: {texels}");
        }
        let again = dpsm_texel_centre(centre, light);
        assert!((again - centre).widen().length() <= 12.0 * EPS, "{size} {uv:?}");
    }
    // outside the map the nearest texel's
    let light = plain_light(128);
    let last = 1.0 - 0.5 / 128.0;
    let corner = dpsm_texture_to_disk(Vec2::new(last, 0.5 / 128.0), light.guard);
    assert_eq!(dpsm_texel_centre(Vec2::new(9.0, 9.0), light), corner);
}
