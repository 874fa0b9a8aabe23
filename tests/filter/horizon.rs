//! Taps whose direction does not meet the receiver's plane.

use dpsm::scalar::bias::{dpsm_bias_slack, dpsm_receiver};
use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::filter::*;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::dpsm_hemisphere;
use dpsm::scalar::kernel::DpsmTap;

use crate::KINDS;
use dpsm::scalar::maps::Sampling;
use dpsm::scalar::paraboloid::dpsm_project_own;

use crate::common::{EPS, rng, unit};
use crate::support::{first, hard, light, maps, narrow, narrow_taps, rotated};

#[test]
fn grazing_receivers_behind_a_wall_all_around_are_in_shadow() {
    let mut rng = rng("horizon");
    let light = rotated(light(64), &mut rng);
    // nearer than the receivers' planes within the kernel: 0.05 / sin(5.6 degrees)
    let maps = maps(light, |_| Some(0.2), Sampling::Nearest);
    let light = narrow(light);
    for _ in 0..2000 {
        let p = unit(&mut rng) * 5.0;
        // 89.4 degrees: half of a kernel of 5 degrees is beyond the plane's horizon
        let across = p.cross(unit(&mut rng));
        let normal = across / across.length() + p * (0.01 / 5.0);
        let receiver = dpsm_receiver(p, normal, 0.0);
        let taps = narrow_taps(hard(16));
        let lit = dpsm_filter_disk(&maps, p, receiver, 0.087, light, taps, first());
        assert_eq!(lit, 0.0, "{p:?}, {normal:?}");
        let lit = dpsm_filter_reproject(&maps, p, 0.087, receiver, light, taps, first());
        assert_eq!(lit, 0.0, "{p:?}, {normal:?}");
    }
}

#[test]
fn taps_beyond_the_horizon_compare_the_receivers_own_distance() {
    let mut rng = rng("beyond");
    let light = narrow(light(64));
    for (kind, _) in KINDS {
        let taps = DpsmTaps { kind, ..narrow_taps(hard(1)) };
        for _ in 0..1000 {
            let p = unit(&mut rng) * 5.0;
            let receiver = dpsm_receiver(p, p, 0.0);
            let reader = dpsm_filter_reader(receiver, light, taps);
            let tap = DpsmTap { uv: dpsm_project_own(-p), hemisphere: dpsm_hemisphere(-p) };
            let at = dpsm_filter_lookup(reader, tap, light);
            let own = dpsm_depth(receiver.distance, light.near, light.far);
            // the slack, and the reciprocal's 4 eps
            let slack = dpsm_bias_slack(receiver.distance, light, 0.0, 0.0);
            assert!((own - at.depth).abs() <= slack + 8.0 * EPS as f32, "{at:?}, {own}");
        }
    }
}

#[test]
fn taps_at_the_maps_border_compare_with_the_texel_that_is_read() {
    let light = narrow(light(64));
    let bare = dpsm::scalar::light::DpsmLight { guard: 0.0, ..light };
    let receiver = dpsm_receiver(Vec3::new(3.0_f32, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0), 0.0);
    let reader = dpsm_filter_reader(receiver, bare, narrow_taps(hard(1)));
    let tap = DpsmTap { uv: Vec2::new(1.0, 0.0), hemisphere: 0 };
    let at = dpsm_filter_lookup(reader, tap, bare);
    assert_eq!(at.coordinates.x, 63.5 / 64.0);
}
