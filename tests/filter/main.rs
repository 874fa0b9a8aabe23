//! Filters: the seam, the receiver's plane, the guard band, and each form against the others.

#[cfg(feature = "gpu")]
mod adapter;
#[path = "../common/mod.rs"]
mod common;
mod horizon;
mod seam;
mod soft;
mod support;

use common::{EPS, rng, uniform, unit};
use dpsm::scalar::bias::dpsm_receiver;
use dpsm::scalar::filter::*;
use dpsm::scalar::float::{Vec2, Vec3, Vec4};
use dpsm::scalar::kernel::*;
use dpsm::scalar::light::{DPSM_ATLAS, DPSM_HEMISPHERICAL, DpsmLight};
use dpsm::scalar::lights::{dpsm_lights_four, dpsm_lights_visibility};
use dpsm::scalar::maps::{DepthMaps, Maps, Sampling};
use dpsm::scalar::pcss::dpsm_pcss;
use dpsm::scalar::plane::dpsm_visibility_plane;
use dpsm::scalar::raw::*;
use support::{first, hard, light, maps, narrow, narrow_taps, rotated, to_world};

/// Both kinds of taps with the sampling that they need.
const KINDS: [(u32, Sampling); 2] =
    [(DPSM_TAP_HARD, Sampling::Nearest), (DPSM_TAP_LINEAR, Sampling::Linear)];

#[test]
fn lit_plane_is_lit_at_any_incidence_with_any_kernel() {
    let mut rng = rng("plane");
    let (mut receivers, mut steepest) = (0, 0.0_f64);
    for round in 0..60 {
        let light = rotated(light(64), &mut rng);
        let normal = unit(&mut rng).widen();
        let normal = normal / normal.length();
        let plane = |d: Vec3<f64>| {
            let along = d.dot(normal) / d.length();
            (along > 1e-3).then(|| 1.0 / along)
        };
        let (kind, sampling) = KINDS[round % 2];
        let maps = maps(light, plane, sampling);
        for _ in 0..200 {
            let (d, tangent) = (unit(&mut rng).widen(), uniform(&mut rng, 0.0, 0.3));
            let along = d.dot(normal) / d.length();
            if along < 0.05 {
                continue;
            }
            receivers += 1;
            steepest = steepest.max(along.acos());
            // the f32 port: its rounding is what the slack is for
            let wide = support::to_light(light, d / (along * d.length()));
            let p = wide.narrow();
            let receiver = dpsm_receiver(p, support::to_light(light, normal).narrow(), 0.0);
            let taps = DpsmTaps { kind, ..narrow_taps(hard(16)) };
            let light = narrow(light);
            let lit = dpsm_filter_disk(&maps, p, receiver, tangent, light, taps, first());
            assert_eq!(lit, 1.0, "{p:?}, {tangent}");
            let soft = dpsm_pcss(&maps, p, receiver, light, taps, 4.0 * tangent, 0.2, first());
            assert_eq!(soft, 1.0, "{p:?}, {tangent}");
            let single = dpsm_visibility_plane(&maps, p, receiver, light, 0.0, 0.0);
            assert_eq!(single, 1.0, "{p:?}");
            let lit = dpsm_filter_reproject(&maps, p, tangent, receiver, light, taps, first());
            assert!((lit - 1.0).abs() <= 16.0 * EPS as f32, "{lit} at {p:?}, {tangent}, {kind}");
            let lit = dpsm_filter_hardware(&maps, p, receiver, light, taps);
            assert!((lit - 1.0).abs() <= 4.0 * EPS as f32, "{lit} at {p:?}, {kind}");
        }
    }
    println!("{receivers} receivers, up to {:.1} degrees", steepest.to_degrees());
    assert!(receivers > 4000 && steepest > 1.5);
}

#[test]
fn guard_band_keeps_taps_on_the_rim_clear_of_what_is_not_stored() {
    // whatever is not inside the stored disk is in shadow
    let fringe = |side: f64, kind: u32, sampling| {
        let size = 64;
        let light = DpsmLight { guard: dpsm_kernel_guard(size.into(), side), ..light(size) };
        let mut maps = maps(light, |_| Some(19.0), sampling);
        for stored in &mut maps.depths {
            *stored = if *stored == 1.0 { 0.0 } else { *stored };
        }
        let mut darkest = 1.0_f64;
        for i in 0..10_000 {
            let (sin, cos) = (f64::from(i) * 6.2832e-4).sin_cos();
            let p = Vec3::new(cos, sin, 0.0);
            let receiver = dpsm_receiver(p, p, 0.0);
            let taps = DpsmTaps { kind, ..hard(16) };
            darkest = darkest.min(dpsm_filter_hardware(&maps, p, receiver, light, taps));
            let disk = dpsm_filter_disk(&maps, p, receiver, 0.1, light, taps, first());
            darkest = darkest.min(disk);
            let pcf = dpsm_filter_pcf(&maps, p, light, 4, 0.0);
            if side >= 4.0 + f64::from(kind) {
                darkest = darkest.min(pcf);
            }
        }
        darkest
    };
    for (kind, sampling) in KINDS {
        let needed = 1.0 + f64::from(kind);
        let [enough, naive, narrow] =
            [needed, needed + 3.0, 0.7 * needed].map(|side| fringe(side, kind, sampling));
        println!("kind {kind}: darkest {enough}, naive 4 x 4 {naive}, too narrow {narrow}");
        assert!(1.0 - enough <= 16.0 * 1e-16 && 1.0 - naive <= 16.0 * 1e-16);
        assert!(narrow < 1.0);
    }
}

#[test]
fn hemispherical_light_darkens_taps_beyond_its_rim_and_no_others() {
    let light = DpsmLight { hemispheres: DPSM_HEMISPHERICAL, ..light(128) };
    let tangent = 0.1;
    for (kind, sampling) in KINDS {
        // the floor of the front half alone is stored: as a hemispherical light's only layer
        let mut maps = maps(light, |_| Some(5.0), sampling);
        maps.layers = 1;
        maps.depths.truncate(128 * 128);
        let taps = DpsmTaps { kind, ..hard(64) };
        for step in -20..=20 {
            let off: f64 = f64::from(step) * 0.01;
            let p = Vec3::new(0.6 * off.cos(), 0.8 * off.cos(), off.sin());
            let receiver = dpsm_receiver(p, p, 0.0);
            let lit = dpsm_filter_disk(&maps, p, receiver, tangent, light, taps, first());
            let old = dpsm_filter_reproject(&maps, p, tangent, receiver, light, taps, first());
            if off < -tangent.atan() {
                assert_eq!(old, 0.0, "light fringe at {off}");
            }
            if off > tangent.atan() {
                assert!((lit - 1.0).abs() <= 1e-13, "dark fringe at {off}: {lit}");
            }
            if off < -tangent.atan() {
                assert!(lit.abs() <= 1e-13, "light fringe at {off}: {lit}");
            }
        }
    }
}

#[test]
fn hardware_is_the_footprint_test_or_the_texel_centre_one() {
    let mut rng = rng("hardware");
    for (kind, sampling) in KINDS {
        let mut maps = DepthMaps::empty(64, 2, sampling);
        maps.depths.fill_with(|| rng.f32());
        for _ in 0..20_000 {
            let light = light(64);
            let p = unit(&mut rng).widen() * f64::from(uniform(&mut rng, 0.1, 19.0));
            // facing the light its own distance is the plane's, up to the taps' curvature
            let receiver = dpsm_receiver(p, p, 0.0);
            let taps = DpsmTaps { kind, ..hard(1) };
            let ours = dpsm_filter_hardware(&maps, p, receiver, light, taps);
            let own = DpsmTap {
                uv: dpsm::scalar::paraboloid::dpsm_project_own(p),
                hemisphere: dpsm::scalar::hemisphere::dpsm_hemisphere(p),
            };
            let at = dpsm_filter_lookup(dpsm_filter_reader(receiver, light, taps), own, light);
            assert_eq!(ours, maps.compare(at.coordinates, at.layer, at.depth));
            let plain = dpsm::scalar::visibility::dpsm_lookup(p, light);
            assert_eq!((at.layer, at.mapped), (plain.layer, plain.mapped));
            let apart = (at.coordinates - plain.coordinates) * light.size;
            let most = if kind == DPSM_TAP_HARD { 0.5 + 1e-9 } else { 1e-9 };
            assert!(apart.x.abs() <= most && apart.y.abs() <= most, "{apart:?}");
            assert!(at.depth < plain.depth + (1e-3 * p.length()) / 19.9, "{p:?}");
        }
    }
}

#[test]
fn naive_kernel_is_the_mean_of_its_texels() {
    let mut rng = rng("pcf");
    let light = light(64);
    let mut maps = DepthMaps::empty(64, 2, Sampling::Nearest);
    maps.depths.fill_with(|| rng.f32());
    for _ in 0..2_000 {
        let p = unit(&mut rng).widen() * 10.0;
        let at = dpsm::scalar::visibility::dpsm_lookup(p, light);
        let own = at.coordinates * 64.0;
        let mut lit = 0;
        for (x, y) in (-1..=1).flat_map(|y| (-1..=1).map(move |x| (x, y))) {
            let index = maps.index(own.x as i64 + x, own.y as i64 + y, at.layer);
            lit += u32::from(f64::from(maps.depths[index]) >= at.depth - 0.01);
        }
        let pcf = dpsm_filter_pcf(&maps, p, light, 3, 0.01);
        assert!((pcf - f64::from(lit) / 9.0).abs() <= 1e-15, "{p:?}");
    }
}

#[test]
fn loads_give_what_the_comparison_sampler_gives() {
    let mut rng = rng("raw");
    for (kind, sampling) in KINDS {
        let mut maps = DepthMaps::empty(64, 2, sampling);
        maps.depths.fill_with(|| rng.f32());
        let light = light(64);
        for _ in 0..2_000 {
            let p = unit(&mut rng).widen() * f64::from(uniform(&mut rng, 0.5, 15.0));
            let receiver = dpsm_receiver(p, unit(&mut rng).widen(), 0.0);
            let (taps, tangent) = (DpsmTaps { kind, ..hard(16) }, 0.1);
            let kernel = dpsm_kernel(p, tangent);
            let pairs = [
                (
                    dpsm_filter_hardware(&maps, p, receiver, light, taps),
                    dpsm_raw_hardware(&maps, p, receiver, light, taps),
                ),
                (
                    dpsm_filter_pcf(&maps, p, light, 4, 0.01),
                    dpsm_raw_pcf(&maps, p, light, 4, 0.01, kind),
                ),
                (
                    dpsm_filter_disk(&maps, p, receiver, tangent, light, taps, first()),
                    dpsm_raw_disk(&maps, p, receiver, tangent, light, taps, first()),
                ),
                (
                    dpsm_visibility_plane(&maps, p, receiver, light, 0.0, 0.0),
                    dpsm_raw_plane(&maps, p, receiver, light, 0.0, 0.0),
                ),
                (
                    dpsm_filter_mirror(&maps, receiver, kernel, light, taps, first()),
                    dpsm_raw_mirror(&maps, receiver, kernel, light, taps, first()),
                ),
                (
                    dpsm_filter_reproject(&maps, p, tangent, receiver, light, taps, first()),
                    dpsm_raw_reproject(&maps, p, tangent, receiver, light, taps, first()),
                ),
                (
                    dpsm_pcss(&maps, p, receiver, light, taps, 0.2, 0.5, first()),
                    dpsm_raw_pcss(&maps, p, receiver, light, taps, 0.2, 0.5, first()),
                ),
            ];
            for (index, (sampled, loaded)) in pairs.into_iter().enumerate() {
                assert!((sampled - loaded).abs() <= 1e-12, "{index}: {sampled} {loaded}");
            }
        }
    }
}

#[test]
fn atlas_filters_like_layers() {
    let mut rng = rng("atlas");
    let layers = light(64);
    let mut two = DepthMaps::empty(64, 2, Sampling::Nearest);
    two.depths.fill_with(|| rng.f32());
    // side by side in the upper half of a square of 128 texels
    let mut one = DepthMaps::empty(128, 1, Sampling::Nearest);
    for (x, y) in (0..128).flat_map(|y| (0..64).map(move |x| (x, y % 64))) {
        for layer in 0..2 {
            let index = one.index(x + 64 * i64::from(layer), y, 0);
            one.depths[index] = two.depths[two.index(x, y, layer)];
        }
    }
    let atlas =
        DpsmLight { placement: DPSM_ATLAS, rectangle: Vec4::new(0.0, 0.0, 0.5, 0.5), ..layers };
    for _ in 0..5_000 {
        let p = unit(&mut rng).widen() * f64::from(uniform(&mut rng, 0.5, 15.0));
        let receiver = dpsm_receiver(p, unit(&mut rng).widen(), 0.0);
        let value =
            |maps, light| dpsm_filter_disk(maps, p, receiver, 0.1, light, hard(16), first());
        assert_eq!(value(&two, layers), value(&one, atlas));
        let value =
            |maps, light| dpsm_filter_reproject(maps, p, 0.1, receiver, light, hard(16), first());
        assert_eq!(value(&two, layers), value(&one, atlas));
        let value = |maps, light| dpsm_visibility_plane(maps, p, receiver, light, 0.0, 0.0);
        assert_eq!(value(&two, layers), value(&one, atlas));
    }
}

#[test]
fn four_lights_read_their_own_layers() {
    let mut rng = rng("lights");
    let mut maps = DepthMaps::empty(32, 8, Sampling::Nearest);
    maps.depths.fill_with(|| rng.f32());
    let lights: [DpsmLight<f64>; 4] = std::array::from_fn(|i| DpsmLight {
        first_layer: 2 * i as u32,
        position: unit(&mut rng).widen(),
        ..rotated(light(32), &mut rng)
    });
    for _ in 0..2_000 {
        let (world, normal) = (unit(&mut rng).widen() * 4.0, unit(&mut rng).widen());
        for radius in [0.0, 0.3] {
            let each = lights.map(|light| {
                dpsm_lights_visibility(&maps, world, normal, light, hard(8), radius, first())
            });
            let four = |count| {
                let all =
                    dpsm_lights_four(&maps, world, normal, lights, count, hard(8), radius, first());
                [all.x, all.y, all.z, all.w]
            };
            assert_eq!(four(4), each);
            assert_eq!(four(2), [each[0], each[1], 0.0, 0.0]);
            // one light by hand, through light space
            let light = lights[1];
            let p = support::to_light(light, world - light.position);
            let receiver = dpsm_receiver(p, support::to_light(light, normal), 0.0);
            if radius > 0.0 {
                let tangent = radius / p.length();
                let own = dpsm_filter_disk(&maps, p, receiver, tangent, light, hard(8), first());
                assert_eq!(own, each[1]);
            }
        }
    }
}

#[test]
fn frames_of_the_tests_are_rotations() {
    let mut rng = rng("frames");
    let light = rotated(light(64), &mut rng);
    let d = Vec3::new(1.0, 2.0, 3.0);
    assert!((to_world(light, support::to_light(light, d)) - d).length() <= 1e-14);
    assert_eq!(first::<f64>(), Vec2::new(1.0, 0.0));
}
