//! What the caster pass computes.

mod common;

use common::{CASES, EPS, Worst, light, point, rng, uniform, unit};
use dpsm::scalar::caster::*;
use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::DPSM_POLE_RADIUS;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::paraboloid::dpsm_unproject;

fn at_depth_unit(light: DpsmLight<f32>) -> DpsmLight<f32> {
    DpsmLight { near: 0.5, far: 2.0, ..light }
}

#[test]
fn border_is_the_height_of_the_guard_bands_edge() {
    let mut rng = rng("border");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let guard = rng.f32();
        let r = 1.0 + f64::from(guard);
        // the same circle through the other formula: z of the disk point (r, 0)
        let exact = dpsm_unproject(Vec2::new(r, 0.0)).z;
        worst.note((f64::from(dpsm_caster_border(guard)) - exact).abs(), 4.5 * EPS, guard);
    }
    worst.check("dpsm_caster_border");
    assert_eq!(dpsm_caster_border(0.0_f32), 0.0);
}

#[test]
fn vertex_stays_within_its_bounds() {
    let mut rng = rng("vertex");
    let [mut place, mut depth, mut value] = [(); 3].map(|()| Worst::default());
    for _ in 0..CASES {
        let light = light(&mut rng);
        let (p, bias) = (point(&mut rng, -20, 8), rng.f32() * 0.1);
        let v = dpsm_caster_vertex(p, light, bias);
        let exact = dpsm_caster_vertex(p.widen(), light.widen(), bias.into());
        let (near, far) = (f64::from(light.near), f64::from(light.far));
        let l = p.widen().length();
        let r = exact.clip.xy().length() * (1.0 + f64::from(light.guard));
        if r < DPSM_POLE_RADIUS / 2.0 {
            for (value, exact) in [(v.clip.x, exact.clip.x), (v.clip.y, exact.clip.y)] {
                place.note((f64::from(value) - exact).abs() / exact.abs(), 22.5 * EPS, p);
            }
        }
        let bound = EPS * ((11.5 * l + 5.5 * near) / (far - near) + f64::from(bias));
        depth.note((f64::from(v.clip.z) - exact.clip.z).abs(), bound, (p, near, far));
        let error = (f64::from(v.hemisphere_value) - exact.hemisphere_value).abs();
        value.note(error, EPS * (8.0 * l / far + 1.0), (p, far));
        assert_eq!(v.clip.w, 1.0);
    }
    place.check("dpsm_caster_vertex, position");
    depth.check("dpsm_caster_vertex, depth");
    value.check("dpsm_caster_vertex, hemisphere value");
}

#[test]
fn fragment_stays_within_its_bound_and_agrees_with_the_vertex() {
    let mut rng = rng("fragment");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let light = light(&mut rng);
        let (p, bias) = (point(&mut rng, -20, 8), rng.f32() * 0.1);
        let fragment = dpsm_caster_fragment(p, light, bias);
        let exact = dpsm_caster_fragment(p.widen(), light.widen(), bias.into());
        let (near, far) = (f64::from(light.near), f64::from(light.far));
        let l = p.widen().length();
        let bound = EPS * ((11.5 * l + 5.5 * near) / (far - near) + f64::from(bias));
        worst.note((f64::from(fragment.depth) - exact.depth).abs(), bound, (p, near, far));
        assert_eq!(fragment.depth, dpsm_caster_vertex(p, light, bias).clip.z);
    }
    worst.check("dpsm_caster_fragment");
}

#[test]
fn stored_disk_ends_at_the_guard_band() {
    let mut rng = rng("guard");
    for _ in 0..CASES {
        let light = at_depth_unit(light(&mut rng));
        let p = unit(&mut rng);
        let v = dpsm_caster_vertex(p, light, 0.0);
        let kept = dpsm_caster_keep(v.hemisphere_value);
        let r = v.clip.xy().widen().length();
        // off the border by more than the bounds of place (22.5 eps) and value (9 eps of 1, over
        // the slope 1 / (2 far) dz/dr >= 0.16 / 2 for r <= 2): either answer is right
        let band = (22.5 + 9.0 / 0.08) * EPS;
        if (r - 1.0).abs() > band {
            assert_eq!(kept, r < 1.0, "{p:?} at r = {r}");
        }
        let fragment = dpsm_caster_fragment(p, light, 0.0);
        if (r - 1.0).abs() > band {
            assert_eq!(fragment.keep, r < 1.0, "{p:?} at r = {r}");
        }
    }
}

#[test]
fn without_a_guard_band_the_seam_is_kept_on_both_sides() {
    let light = DpsmLight { guard: 0.0, ..dpsm::cases::light(0) };
    for p in [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, -1.0, -0.0)] {
        assert!(dpsm_caster_keep(dpsm_caster_vertex(p, light, 0.0).hemisphere_value));
        assert!(dpsm_caster_fragment(p, light, 0.0).keep);
    }
}

#[test]
fn fragments_outside_the_clipping_spheres_are_discarded() {
    let mut rng = rng("spheres");
    for _ in 0..CASES {
        let light = DpsmLight { guard: 1.0, ..at_depth_unit(light(&mut rng)) };
        let l = uniform(&mut rng, 0.1, 3.0);
        let p = Vec3::new(0.0, 0.0, l);
        let kept = dpsm_caster_fragment(p, light, 0.0).keep;
        assert_eq!(kept, (light.near..=light.far).contains(&l), "{l}");
    }
}

#[test]
fn bias_moves_the_stored_depth_away_from_the_light() {
    let light = at_depth_unit(dpsm::cases::light(0));
    let p = Vec3::new(0.3, 0.4, 0.9);
    let (plain, biased) = (dpsm_caster_vertex(p, light, 0.0), dpsm_caster_vertex(p, light, 0.125));
    // one rounding of the sum
    let moved = f64::from(biased.clip.z - plain.clip.z);
    assert!((moved - 0.125).abs() <= EPS, "{moved}");
    assert_eq!(plain.clip.z, dpsm_depth(p.length(), light.near, light.far));
}
