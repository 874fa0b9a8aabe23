//! Soft shadows that harden towards contact.

use dpsm::scalar::bias::dpsm_receiver;
use dpsm::scalar::filter::{DPSM_FILTER_SMALLEST, DPSM_FILTER_WIDEST};
use dpsm::scalar::float::{Vec3, Vec4};
use dpsm::scalar::kernel::{dpsm_kernel, dpsm_kernel_tangent};
use dpsm::scalar::light::{DPSM_HEMISPHERICAL, DpsmLight};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::pcss::*;

use crate::common::{EPS, EPS_DOUBLE, Worst, rng, uniform};
use crate::support::{FLOOR, LID, LID_DISTANCE, Lid, first, hard, light, maps, rotated};

#[test]
fn blocker_asks_for_the_lights_own_size() {
    // similar triangles: halfway, the penumbra's half-width is the light's radius
    assert_eq!(dpsm_pcss_tangent(2.0, 1.0, 0.25), 0.125);
    assert_eq!(dpsm_pcss_tangent(2.0, 2.0, 0.25), 0.0);
    assert_eq!(dpsm_pcss_tangent(2.0, 3.0, 0.25), 0.0);
    assert_eq!(dpsm_pcss_tangent(2.0, 0.0, 0.25), DPSM_FILTER_WIDEST);
    assert_eq!(dpsm_pcss_tangent(0.0, 0.0, 0.25), 0.0);
    let mut rng = rng("blocker");
    let mut worst = Worst::default();
    for _ in 0..100_000 {
        let distance = uniform(&mut rng, 0.1, 10.0);
        let (blocker, radius) = (distance * rng.f32(), uniform(&mut rng, 0.001, 0.1));
        let tangent = f64::from(dpsm_pcss_tangent(distance, blocker, radius));
        let [l, b, r] = [distance, blocker, radius].map(f64::from);
        let exact = (r * (l - b) / (l * b)).min(1.0);
        let bound = EPS * (6.5 + l / (l - b)) * exact;
        worst.note((tangent - exact).abs(), bound, (distance, blocker));
    }
    worst.check("dpsm_pcss_tangent");
}

#[test]
fn without_blockers_it_is_lit_and_deep_in_shadow_dark() {
    let lid = Lid { axis: Vec3::new(0.6, 0.0, 0.8) };
    let light = light(256);
    let maps = maps(light, |d| lid.distance(d), Sampling::Nearest);
    let value = |off| {
        let (p, receiver) = lid.receiver(light, off, 1.0);
        dpsm_pcss(&maps, p, receiver, light, hard(32), 0.1, 1.0, first())
    };
    assert_eq!([value(0.0), value(LID - 0.2), value(LID + 0.2)], [0.0, 0.0, 1.0]);
}

#[test]
fn penumbra_is_as_wide_as_the_lights_size_and_the_gap_ask_under_any_rotation() {
    // a lid at b on the way to the floor: the tangent is R (l - b) / (l b) at the floor point
    let mut rng = rng("penumbra");
    for radius in [0.05, 0.1, 0.2] {
        for _ in 0..6 {
            let lid = Lid { axis: Vec3::new(0.6, 0.0, 0.8) };
            let light = rotated(light(512), &mut rng);
            let maps = maps(light, |d| lid.distance(d), Sampling::Nearest);
            let l = FLOOR / LID.cos();
            let asked = radius * (l - LID_DISTANCE) / (l * LID_DISTANCE);
            let step = asked / 40.0;
            // where 16% and 84% arrive: in a disk, 0.5 of its radius on either side, as the share
            // beyond a chord at x is (acos x - x sqrt(1 - x^2)) / pi
            let share = |x: f64| (x.acos() - x * (1.0 - x * x).sqrt()) / std::f64::consts::PI;
            let (low, high) = (share(0.5), share(-0.5));
            let within = (-80..=80).filter(|i| {
                let (p, receiver) = lid.receiver(light, LID + f64::from(*i) * step, 0.3);
                let value = dpsm_pcss(&maps, p, receiver, light, hard(256), radius, 1.0, first());
                value > low && value < high
            });
            let width = within.count() as f64 * step;
            // a texel either side, and steps of the scan
            let texel = 4.0 * (1.0 + light.guard) / light.size;
            let bound = texel * std::f64::consts::SQRT_2 + 2.0 * step;
            println!("radius {radius}: {width:.4} rad for {asked:.4}, within {bound:.4}");
            assert!((width - asked).abs() <= bound, "{width} {asked}");
        }
    }
}

#[test]
fn farthest_blocker_sets_the_kernel_and_contact_hardens_it_to_half_a_texels_diagonal() {
    let light = light(128);
    let depth = |distance: f64| (distance - light.near) / (light.far - light.near);
    let found = |farthest| DpsmBlockers { farthest, all: [false; 4] };
    let width = |farthest| dpsm_pcss_width(found(farthest), 2.0, 0.01, 0.25, light);
    // of blockers at 1/2, 1 and 1.5 the last: R (l - b) / (l b)
    let each = Vec4::new(depth(0.5), depth(1.0), -1.0, depth(1.5));
    let asked = 0.25 * 0.5 / 3.0;
    assert!((width(each) - asked).abs() <= 1e-12, "{}", width(each));
    let least = DPSM_FILTER_SMALLEST * 0.01;
    assert_eq!(width(Vec4::splat(-1.0)), least);
    assert_eq!(width(Vec4::splat(depth(1.9999))), least);
    assert_eq!(width(Vec4::splat(0.0)), DPSM_FILTER_WIDEST);
}

#[test]
fn missing_half_of_a_hemispherical_light_is_no_blocker_and_no_light() {
    let light = DpsmLight { hemispheres: DPSM_HEMISPHERICAL, ..light(128) };
    let maps = DepthMaps::empty(128, 1, Sampling::Nearest);
    let value = |z: f64| {
        let p = Vec3::new(1.0, 0.0, z);
        dpsm_pcss(&maps, p, dpsm_receiver(p, p, 0.0), light, hard(32), 0.2, 0.3, first())
    };
    // the search reaches the rim from 0.2; the kernel, a texel wide, does not
    assert_eq!([value(0.2), value(0.06), value(-0.06), value(-0.5)], [1.0, 1.0, 0.0, 0.0]);
}

#[test]
fn world_radius_and_tangent_agree() {
    let p = Vec3::new(0.0_f64, 3.0, 4.0);
    let kernel = dpsm_kernel(p, dpsm_kernel_tangent(p, 0.25));
    let same = dpsm_kernel(p, 0.05);
    assert!((kernel.reach - same.reach).abs() <= 8.0 * EPS_DOUBLE);
}
