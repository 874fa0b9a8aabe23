//! The seam: error beside it, the same shadow under any rotation of the light, and the filters
//! against each other.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use dpsm::scalar::bias::{DpsmReceiver, dpsm_texel_centre};
use dpsm::scalar::filter::*;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::dpsm_flip;
use dpsm::scalar::kernel::*;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::{dpsm_project_own, dpsm_texel_pitch, dpsm_unproject};
use dpsm::scalar::plane::dpsm_plane;

use crate::common::{angle, rng, unit};
use crate::support::{LID, Lid, first, hard, light, maps, rotated, to_world};

const SIZE: u32 = 256;

/// Taps enough that the kernel's discreteness is far below the map's.
const TAPS: u32 = 256;

/// The cone's half-angle as its tangent: about 6 texels at the rim, 3 in the middle.
const TANGENT: f64 = 0.05;

/// The share of an even cone around a floor point that the lid leaves: the fan of two spheres'
/// caps, by its own integral over the cone's rings.
fn truth(off: f64) -> f64 {
    let half = TANGENT.atan();
    let rings = 400;
    let mut lit = 0.0;
    for ring in 0..rings {
        // even in the disk tan(angle / 2), as the taps are
        let share = ((f64::from(ring) + 0.5) / f64::from(rings)).sqrt();
        let rho = 2.0 * (share * (half / 2.0).tan()).atan();
        // the azimuths at which the ring is outside the lid's cone, by the law of cosines
        let cosine = (LID.cos() - rho.cos() * off.cos()) / (rho.sin() * off.sin());
        lit += 1.0 - cosine.clamp(-1.0, 1.0).acos() / PI;
    }
    lit / f64::from(rings)
}

/// What a filter is given.
struct Given<'a> {
    maps: &'a DepthMaps,
    p: Vec3<f64>,
    receiver: DpsmReceiver<f64>,
    light: DpsmLight<f64>,
}

type Filter = fn(&Given<'_>) -> f64;

fn disk(g: &Given<'_>) -> f64 {
    let at = dpsm_plane(g.p, g.receiver, DPSM_FILTER_SHIFT, g.light, 0.0, 0.0);
    let disk = dpsm_filter_cone(at, TANGENT, TANGENT, first());
    dpsm_filter_sum(g.maps, disk, g.light, dpsm_kernel_rings(TAPS))
}

fn mirror(g: &Given<'_>) -> f64 {
    let kernel = dpsm_kernel(g.p, TANGENT);
    dpsm_filter_mirror(g.maps, g.receiver, kernel, g.light, hard(TAPS), first())
}

fn reproject(g: &Given<'_>) -> f64 {
    dpsm_filter_reproject(g.maps, g.p, TANGENT, g.receiver, g.light, hard(TAPS), first())
}

/// As many texels across as the cone has at the rim, by area.
fn naive(g: &Given<'_>) -> f64 {
    let rim = dpsm_texel_pitch(Vec2::new(1.0, 0.0), g.light.size, g.light.guard);
    let side = (TANGENT * PI.sqrt() / rim).round() as u32;
    // the lid is half as far as the floor: any bias between will do
    dpsm_filter_pcf(g.maps, g.p, g.light, side, 0.02)
}

const FILTERS: [(&str, Filter); 4] =
    [("disk", disk), ("mirror", mirror), ("reproject", reproject), ("naive", naive)];

/// Calls back for receivers beside the lid's shadow edge under many rotations of the light, half
/// of them with the seam through the edge: the index of the point, what is given, the angle from
/// the lid's axis, and the distance from the seam in texels.
fn each_receiver(mut call: impl FnMut(usize, &Given<'_>, f64, f64)) {
    let mut rng = rng("seam");
    let lid = Lid { axis: Vec3::new(2.0, -1.0, 2.0) / 3.0 };
    let points: Vec<(f64, f64)> = (0..400)
        .map(|_| (LID + (2.0 * rng.f64() - 1.0) * 1.2 * TANGENT, TAU * rng.f64()))
        .collect();
    for round in 0..24 {
        let light = loop {
            let light = rotated(light(SIZE), &mut rng);
            // the plane of the seam passes the axis within the lid's angle
            let from_seam = light.forward.dot(lid.axis).asin().abs();
            if round % 2 == 1 || from_seam < LID {
                break light;
            }
        };
        let maps = maps(light, |d| lid.distance(d), Sampling::Nearest);
        for (index, &(off, azimuth)) in points.iter().enumerate() {
            let (p, receiver) = lid.receiver(light, off, azimuth);
            let rim = dpsm_texel_pitch(Vec2::new(1.0, 0.0), light.size, light.guard);
            let texels = (p.z / p.length()).asin().abs() / rim;
            call(index, &Given { maps: &maps, p, receiver, light }, off, texels);
        }
    }
}

#[test]
fn error_beside_the_seam_is_not_above_the_interiors() {
    // squares and counts, seam band and interior
    let mut sums = [[(0.0, 0); 2]; 4];
    each_receiver(|_, given, off, texels| {
        let truth = truth(off);
        for ((_, filter), sums) in FILTERS.iter().zip(&mut sums) {
            let error = filter(given) - truth;
            let (sum, count) = &mut sums[usize::from(texels > 5.0)];
            *sum += error * error;
            *count += 1;
        }
    });
    println!("{:<10}{:>12}{:>12}{:>8}{:>10}", "filter", "seam RMSE", "interior", "ratio", "points");
    let mut ratios = Vec::new();
    for ((name, _), [seam, interior]) in FILTERS.iter().zip(sums) {
        let rmse = |(sum, count): (f64, i32)| (sum / f64::from(count)).sqrt();
        let ratio = rmse(seam) / rmse(interior);
        println!(
            "{name:<10}{:>12.5}{:>12.5}{ratio:>8.3}{:>10}",
            rmse(seam),
            rmse(interior),
            seam.1
        );
        assert!(seam.1 > 300 && interior.1 > 300);
        ratios.push(ratio);
    }
    assert!(ratios[0] <= 1.05 && ratios[2] <= 1.05, "{ratios:?}");
    // the measure sees what the others do wrong
    assert!(ratios[3] > 1.05, "{ratios:?}");
}

#[test]
fn rotating_the_light_changes_a_shadow_by_the_resolution_alone() {
    let mut seen: Vec<[(f64, f64); 4]> = vec![[(f64::INFINITY, f64::NEG_INFINITY); 4]; 400];
    let mut spread = 0.0_f64;
    each_receiver(|index, given, off, _| {
        let kernel = dpsm_kernel(given.p, TANGENT);
        // taps whose texel's centre may lie on the other side of the lid's edge than they do
        let mut direction = first();
        let (mut open, mut unsure, mut each) = (0, 0, 0.0);
        let reader = dpsm_filter_reader(given.receiver, given.light, hard(TAPS));
        for tap in 0..TAPS {
            let offset = direction * dpsm_kernel_ring::<f64>(tap, TAPS);
            let tap = dpsm_kernel_tap(kernel, offset);
            each += dpsm_filter_tap(given.maps, reader, tap, given.light);
            let d = to_world(given.light, dpsm_flip(dpsm_unproject(tap.uv), tap.hemisphere));
            let beyond = angle(d, Vec3::new(2.0, -1.0, 2.0)) - LID;
            let centre = dpsm_texel_centre(tap.uv, given.light);
            // half a texel's diagonal, in radians at the end nearer to the map's middle
            let inner = if centre.length() < tap.uv.length() { centre } else { tap.uv };
            let pitch = dpsm_texel_pitch(inner, given.light.size, given.light.guard);
            open += u32::from(beyond >= 0.0);
            unsure += u32::from(beyond.abs() <= FRAC_1_SQRT_2 * pitch);
            direction = dpsm_kernel_turn(direction);
        }
        let [exact, bound] = [open, unsure].map(|n| f64::from(n) / f64::from(TAPS));
        for value in [disk(given), each / f64::from(TAPS)] {
            assert!((value - exact).abs() <= bound + 1e-12, "{value} {exact} {bound} at {off}");
        }
        spread = spread.max(bound);
        for ((_, filter), (low, high)) in FILTERS.iter().zip(&mut seen[index]) {
            let value = filter(given);
            *low = low.min(value);
            *high = high.max(value);
        }
    });
    println!("resolution: up to {spread:.4}");
    for (filter, (name, _)) in FILTERS.iter().enumerate() {
        let ranges: Vec<f64> = seen.iter().map(|each| each[filter].1 - each[filter].0).collect();
        let mean = ranges.iter().sum::<f64>() / ranges.len() as f64;
        let most = ranges.iter().copied().fold(0.0, f64::max);
        println!("{name:<10} changes by {mean:.4} on average, at most {most:.4}");
    }
}

#[test]
fn disk_decides_as_osmans_reprojection_but_for_taps_at_texels_borders() {
    let mut rng = rng("decisions");
    let light = light(SIZE);
    for tangent in [0.01, 0.05, 0.2] {
        let (mut taps, mut other_texel) = (0, 0);
        let mut farthest = 0.0_f64;
        for _ in 0..5_000 {
            let p = unit(&mut rng).widen();
            let receiver = dpsm::scalar::bias::dpsm_receiver(p, unit(&mut rng).widen(), 0.0);
            let reader = dpsm_filter_reader(receiver, light, hard(16));
            let kernel = dpsm_kernel(p, tangent);
            let mut direction = first();
            for index in 0..16 {
                let offset = direction * dpsm_kernel_ring::<f64>(index, 16);
                let even = dpsm_kernel_tap(kernel, offset);
                let osman = dpsm_kernel_projected(p, tangent, offset);
                let [a, b] = [even, osman].map(|tap| dpsm_filter_lookup(reader, tap, light));
                let away = |tap: DpsmTap<f64>| dpsm_flip(dpsm_unproject(tap.uv), tap.hemisphere);
                farthest = farthest.max(angle(away(even), away(osman)));
                let same = (a.coordinates, a.layer) == (b.coordinates, b.layer);
                // the same texel is compared with the same depth
                assert!(!same || a.depth == b.depth);
                taps += 1;
                other_texel += u32::from(!same);
                direction = dpsm_kernel_turn(direction);
            }
        }
        let share = |n: u32| f64::from(n) / f64::from(taps);
        // a tap that moves by m radians crosses a border of its texel with the odds
        // (|x| + |y|) / pitch <= sqrt(2) m / pitch, finest at the rim; twice that for the chance
        let moved = 0.1 * f64::powi(tangent, 3);
        let rim = dpsm_texel_pitch(Vec2::new(1.0, 0.0), light.size, light.guard);
        let bound = 2.0 * moved / FRAC_1_SQRT_2 / rim;
        println!(
            "tangent {tangent}: other texel {:.5} of {taps} taps (bound {bound:.5}), {farthest:.2e} \
             rad apart at most",
            share(other_texel)
        );
        assert!(share(other_texel) <= bound);
        assert!(farthest <= moved + 1e-12);
    }
}

#[test]
fn kernel_is_as_wide_at_the_rim_as_in_the_middle() {
    // where an edge's penumbra begins and ends, in radians, by the disk and by the naive kernel
    let lid = Lid { axis: Vec3::new(0.0, 0.0, 1.0) };
    let width = |forward: Vec3<f64>, filter: Filter| {
        let right = Vec3::new(0.0, 1.0, 0.0);
        let up = crate::common::cross(forward, right);
        // a guard band that holds the naive kernel too: here only its width is looked at
        let guard = dpsm_kernel_guard(512.0, 32.0);
        let light = DpsmLight { right, up, forward, guard, ..light(512) };
        let maps = maps(light, |d| lid.distance(d), Sampling::Nearest);
        let partly = (0..400).filter(|step| {
            let off = LID + (f64::from(*step) - 200.0) * 0.0005;
            let (p, receiver) = lid.receiver(light, off, 0.0);
            let value = filter(&Given { maps: &maps, p, receiver, light });
            value > 0.05 && value < 0.95
        });
        partly.count() as f64 * 0.0005
    };
    // the edge's point at azimuth 0: side = cross(axis, x) = y
    let edge = Vec3::new(0.0, LID.sin(), LID.cos());
    for (name, filter) in [("disk", disk as Filter), ("naive", naive)] {
        // a light that looks at the lid's middle, and one whose seam passes through the edge
        let lights = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 0.0)];
        let widths = lights.map(|forward| width(forward, filter));
        let near = dpsm_project_own(edge).length();
        println!("{name}: {widths:?} rad, seen at r = {near:.3} and at the rim");
        let ratio = widths[1] / widths[0];
        match name {
            "disk" => assert!((ratio - 1.0).abs() <= 0.1, "{ratio}"),
            _ => assert!(ratio < 0.7, "{ratio}"),
        }
    }
}
