//! Kernels: cones as disks, and taps across the seam.

mod common;

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use common::{CASES, EPS, EPS_DOUBLE, Worst, angle, point, rng, spread, uniform, unit};
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::{DPSM_BACK, DPSM_FRONT, dpsm_flip, dpsm_hemisphere};
use dpsm::scalar::kernel::*;
use dpsm::scalar::paraboloid::dpsm_unproject;
use fastrand::Rng;

/// The light-space direction of a tap.
fn direction(tap: DpsmTap<f64>) -> Vec3<f64> {
    dpsm_flip(dpsm_unproject(tap.uv), tap.hemisphere)
}

/// An offset at a radius in the unit disk.
fn offset(rng: &mut Rng, radius: f64) -> Vec2<f64> {
    let (sin, cos) = (TAU * rng.f64()).sin_cos();
    Vec2::new(cos, sin) * radius
}

/// Tangents from a thousandth of a texel to 84 degrees.
fn tangent(rng: &mut Rng) -> f64 {
    f64::from(spread(rng, -20, 3).abs())
}

/// What rounding turns a tap's direction by: axis and reach 9.5 eps each, at most doubled by the
/// turn, 32 of the tap, two radians a unit of the disk; and 5 eps a component to come back.
fn turned(eps: f64) -> f64 {
    eps * (2.0 * (4.0 * 9.5 + 32.0) + 5.0 * 3.0_f64.sqrt())
}

#[test]
fn cone_is_exactly_the_disk() {
    let mut rng = rng("cone");
    let [mut border, mut taps] = [(); 2].map(|()| Worst::default());
    for _ in 0..CASES {
        let (p, tangent) = (point(&mut rng, -8, 8).widen(), tangent(&mut rng));
        let disk = dpsm_kernel_disk(p, tangent);
        // 18 eps of the disk, two radians a unit, and back
        let reach = disk.xy().length() + disk.z;
        let bound = EPS_DOUBLE * (36.0 * reach + 5.0 * 3.0_f64.sqrt());
        let uv = disk.xy() + offset(&mut rng, disk.z);
        let off = angle(dpsm_flip(dpsm_unproject(uv), dpsm_hemisphere(p)), p) - tangent.atan();
        border.note(off.abs(), bound, (p, tangent));
        // the taps fill the same disk
        let kernel = dpsm_kernel(p, tangent);
        assert_eq!(kernel.hemisphere, dpsm_hemisphere(p));
        let tap = dpsm_kernel_tap(kernel, offset(&mut rng, 1.0));
        taps.note(
            (angle(direction(tap), p) - tangent.atan()).abs(),
            turned(EPS_DOUBLE),
            (p, tangent),
        );
    }
    border.check("angle from the axis to the disk's border, less the half-angle");
    taps.check("the same of taps with an offset of 1");
}

#[test]
fn kernel_of_a_world_radius_is_seen_at_its_own_size() {
    let p = Vec3::new(3.0_f64, 4.0, -12.0);
    assert_eq!(dpsm_kernel_tangent(p, 0.65), 0.05);
    assert_eq!(dpsm_kernel_tangent(Vec3::splat(0.0_f64), 0.0), 0.0);
}

#[test]
fn kernel_stays_within_its_bound() {
    let mut rng = rng("kernel bound");
    let [mut whole, mut disks, mut taps] = [(); 3].map(|()| Worst::default());
    for _ in 0..CASES {
        let (p, tangent) = (point(&mut rng, -24, 24), tangent(&mut rng) as f32);
        let (wide, tangent_wide) = (p.widen(), f64::from(tangent));
        let (kernel, exact) = (dpsm_kernel(p, tangent), dpsm_kernel(wide, tangent_wide));
        let off = (kernel.axis.widen() - exact.axis).length();
        whole.note(off, 9.5 * EPS * exact.axis.length(), (p, tangent));
        whole.note((f64::from(kernel.reach) - exact.reach).abs(), 9.5 * EPS * exact.reach, tangent);
        let (disk, exact) = (dpsm_kernel_disk(p, tangent), dpsm_kernel_disk(wide, tangent_wide));
        let off = (disk.xy().widen() - exact.xy()).length();
        disks.note(off, 18.0 * EPS * exact.xy().length(), (p, tangent));
        disks.note((f64::from(disk.z) - exact.z).abs(), 18.0 * EPS * exact.z, (p, tangent));
        let offset = {
            let radius = rng.f64();
            offset(&mut rng, radius).narrow()
        };
        let given = DpsmKernel {
            axis: kernel.axis.widen(),
            reach: kernel.reach.into(),
            hemisphere: kernel.hemisphere,
        };
        let (tap, exact) =
            (dpsm_kernel_tap(kernel, offset), dpsm_kernel_tap(given, offset.widen()));
        // on the rim either hemisphere will do
        if exact.uv.length() < 1.0 - 32.0 * EPS {
            assert_eq!(tap.hemisphere, exact.hemisphere, "{p:?}, {tangent}");
            taps.note((tap.uv.widen() - exact.uv).length(), 32.0 * EPS, (p, tangent));
        }
    }
    whole.check("dpsm_kernel");
    disks.check("dpsm_kernel_disk");
    taps.check("dpsm_kernel_tap");
}

#[test]
fn light_itself_and_wide_cones_give_finite_kernels() {
    for p in [Vec3::splat(0.0_f32), Vec3::new(1e15, 1e15, 0.0), Vec3::new(0.0, 0.0, -1.0)] {
        for tangent in [0.0, 1.0, 1024.0] {
            let kernel = dpsm_kernel(p, tangent);
            let tap = dpsm_kernel_tap(kernel, Vec2::new(0.6, 0.8));
            assert!(tap.uv.length() <= 1.0 + 1e-6, "{p:?}, {tangent}: {tap:?}");
            let tap = dpsm_kernel_projected(p, tangent, Vec2::new(0.6, 0.8));
            assert!(tap.uv.length() <= 1.0 + 1e-6, "{p:?}, {tangent}: {tap:?}");
        }
    }
}

#[test]
fn tap_beyond_the_rim_reads_the_same_direction_in_the_other_hemisphere() {
    let mut rng = rng("beyond the rim");
    let mut worst = Worst::default();
    let mut crossed = 0;
    for _ in 0..CASES {
        let p = unit(&mut rng).widen();
        let p = Vec3::new(p.x, p.y, p.z * 0.1);
        let kernel = dpsm_kernel(p, f64::from(uniform(&mut rng, 0.01, 0.3)));
        let offset = offset(&mut rng, 1.0);
        let tap = dpsm_kernel_tap(kernel, offset);
        // the quotient itself, in the axis's own hemisphere, wherever it lies
        let w = offset * kernel.reach;
        let (above, axis) = (kernel.axis + w, kernel.axis);
        let below = Vec2::new(1.0 - axis.dot(w), -(axis.x * w.y - axis.y * w.x));
        let uv = Vec2::new(above.dot(below), above.y * below.x - above.x * below.y);
        let seen = dpsm_flip(dpsm_unproject(uv / below.dot(below)), kernel.hemisphere);
        assert_eq!(tap.hemisphere, dpsm_hemisphere(seen), "{p:?}");
        assert!(tap.uv.length() <= 1.0 + 32.0 * EPS_DOUBLE, "{tap:?}");
        crossed += usize::from(tap.hemisphere != kernel.hemisphere);
        worst.note(angle(direction(tap), seen), turned(EPS_DOUBLE), (p, offset));
    }
    worst.check("direction after the seam");
    assert!(crossed > CASES / 10, "{crossed}");
}

#[test]
fn mirror_is_off_by_the_square_of_what_is_beyond_the_rim() {
    let mut rng = rng("mirror");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        // from the rim outwards: (1 + h) / (1 - h)
        let reach = 0.3 * rng.f64();
        let axis = offset(&mut rng, 1.0 - 1e-9);
        let kernel = DpsmKernel { axis, reach, hemisphere: rng.u32(0..2) };
        let outwards = axis / axis.length();
        let (mirrored, tap) =
            (dpsm_kernel_mirrored(kernel, outwards), dpsm_kernel_tap(kernel, outwards));
        if tap.hemisphere == kernel.hemisphere {
            continue;
        }
        assert_eq!(mirrored.hemisphere, tap.hemisphere);
        let r = 1.0 / tap.uv.length();
        // 1 / r - (2 - r)
        let off = (mirrored.uv - tap.uv).length() - (r - 1.0) * (r - 1.0) / r;
        worst.note(off.abs(), 64.0 * EPS_DOUBLE, r);
    }
    worst.check("mirrored against inverted");
}

#[test]
fn taps_lie_as_far_from_the_axis_as_their_offsets_say() {
    let mut rng = rng("even");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let p = point(&mut rng, -4, 4).widen();
        let tangent = f64::from(spread(&mut rng, -12, 0).abs());
        let kernel = dpsm_kernel(p, tangent);
        let radius = rng.f64();
        let tap = dpsm_kernel_tap(kernel, offset(&mut rng, radius));
        let off = angle(direction(tap), p) - 2.0 * (radius * kernel.reach).atan();
        worst.note(off.abs(), turned(EPS_DOUBLE), (p, tangent, radius));
    }
    worst.check("angle from the axis, less that of the offset");
}

#[test]
fn taps_are_osmans_up_to_the_tangents_cube() {
    let mut rng = rng("osman");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let p = unit(&mut rng).widen();
        let tangent = f64::from(spread(&mut rng, -10, -1).abs());
        let offset = {
            let radius = rng.f64().sqrt();
            offset(&mut rng, radius)
        };
        let tap = dpsm_kernel_tap(dpsm_kernel(p, tangent), offset);
        let osman = dpsm_kernel_projected(p, tangent, offset);
        let bound = 0.1 * tangent.powi(3) + turned(EPS_DOUBLE) + 110.0 * EPS_DOUBLE;
        worst.note(angle(direction(tap), direction(osman)), bound, (p, tangent, offset));
    }
    worst.check("turned against reprojected, radians");
}

#[test]
fn uneven_taps_would_lean_by_the_reach() {
    // what scaling the offsets to the disk itself would cost: b (1 - o^2) / (1 - b o)
    let mut rng = rng("lean");
    let [mut worst, mut least] = [0.0_f64, 1.0];
    for _ in 0..CASES {
        let p = unit(&mut rng).widen();
        let tangent = f64::from(uniform(&mut rng, 0.01, 0.5));
        let (disk, kernel) = (dpsm_kernel_disk(p, tangent), dpsm_kernel(p, tangent));
        let tap = dpsm_kernel_tap(kernel, Vec2::splat(0.0));
        let lean = (tap.uv - disk.xy()).length() / disk.z;
        let exact = kernel.axis.length() * kernel.reach;
        worst = worst.max((lean - exact).abs());
        least = least.min(exact);
    }
    println!("axis off the disk's centre, in radii, less |axis| reach: {worst:e}");
    // 18 eps of a disk that may be 1 / 0.005 of its radius away
    assert!(worst <= 400.0 * 18.0 * EPS_DOUBLE && least < 0.005);
}

#[test]
fn spiral_fills_the_unit_disk_evenly() {
    // each annulus of the disk and each sector hold their share of the taps
    let count = 4096;
    let mut direction = Vec2::new(1.0_f64, 0.0);
    let mut sum = Vec2::new(0.0, 0.0);
    let mut sectors = [0; 16];
    for index in 0..count {
        let ring: f64 = dpsm_kernel_ring(index, count);
        let square = (f64::from(index) + 0.5) / f64::from(count);
        assert!((ring * ring - square).abs() <= 4.0 * EPS_DOUBLE);
        let azimuth = direction.y.atan2(direction.x).rem_euclid(TAU);
        sectors[(azimuth / TAU * 16.0) as usize] += 1;
        sum = sum + direction * ring;
        direction = dpsm_kernel_turn(direction);
    }
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let expected = (f64::from(count) * golden).sin_cos();
    // the constants to 1e-16, and 4 eps a turn
    let drift = f64::from(count) * 4.0 * EPS_DOUBLE;
    assert!((direction.y - expected.0).abs() <= drift && (direction.x - expected.1).abs() <= drift);
    // the golden angle's sequence: a sector's count is off by at most a few (three distances)
    assert!(sectors.iter().all(|&taps: &i32| (taps - 256).abs() <= 3), "{sectors:?}");
    assert!(sum.length() <= 2.0, "{sum:?}");
}

#[test]
fn rotations_of_pixels_are_unit_vectors_spread_evenly() {
    let mut sectors = [0; 16];
    let mut worst = Worst::default();
    for pixel in (0..256).flat_map(|y| (0..256).map(move |x| [x, y])) {
        let turned: Vec2<f32> = dpsm_kernel_rotation(pixel);
        worst.note((turned.widen().length() - 1.0).abs(), 152.0 * EPS, pixel);
        let azimuth = f64::from(turned.y).atan2(turned.x.into()).rem_euclid(TAU);
        sectors[((azimuth / TAU * 16.0) as usize).min(15)] += 1;
    }
    worst.check("dpsm_kernel_rotation");
    // 4096 each but for 4%, and four standard deviations of 64
    assert!(sectors.iter().all(|&n: &i32| (n - 4096).abs() <= 164 + 256), "{sectors:?}");
}

#[test]
fn guard_band_holds_what_a_tap_on_the_rim_reads() {
    for side in 1..=8_u32 {
        for size in [32_u32, 512, 4096] {
            let guard: f64 = dpsm_kernel_guard(size.into(), side.into());
            // from a tap on the rim to the far corner of side x side texels, half of side each way
            let texel = 2.0 * (1.0 + guard) / f64::from(size);
            let far = 1.0 + f64::from(side) * FRAC_1_SQRT_2 * texel;
            assert!((1.0 + guard - far).abs() <= 10.0 * EPS_DOUBLE, "{size}, {side}: {guard}");
        }
    }
    assert_eq!(dpsm_kernel_guard(1.0_f32, 2.0), 1.0);
    #[cfg(feature = "scene")]
    for size in 1..=4096 {
        let guard: f32 = dpsm_kernel_guard(size as f32, 2.0);
        assert_eq!(guard.to_bits(), dpsm::render::guard_band(size).to_bits(), "{size}");
    }
}

#[test]
fn taps_of_hemispheres_are_front_and_back() {
    let kernel = DpsmKernel { axis: Vec2::new(0.9, 0.0), reach: 0.25, hemisphere: DPSM_FRONT };
    assert_eq!(dpsm_kernel_tap(kernel, Vec2::new(1.0, 0.0)).hemisphere, DPSM_BACK);
    assert_eq!(dpsm_kernel_tap(kernel, Vec2::new(-1.0, 0.0)).hemisphere, DPSM_FRONT);
    let kernel = DpsmKernel { hemisphere: DPSM_BACK, ..kernel };
    assert_eq!(dpsm_kernel_tap(kernel, Vec2::new(1.0, 0.0)).hemisphere, DPSM_FRONT);
}
