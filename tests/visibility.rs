//! The hard shadow test, on maps whose truth is known in closed form.

mod common;

use common::{CASES, EPS, Worst, angle, light, point, rng, uniform, unit};
use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::{dpsm_flip, dpsm_hemisphere};
use dpsm::scalar::light::*;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::{dpsm_texel_pitch, dpsm_texture_to_disk, dpsm_unproject};
use dpsm::scalar::visibility::*;

const SIZE: u32 = 256;

fn plain_light(guard: f32) -> DpsmLight<f32> {
    DpsmLight {
        near: 0.1,
        far: 10.0,
        guard,
        size: SIZE as f32,
        first_layer: 0,
        ..dpsm::cases::light(DPSM_LAYERS)
    }
}

/// Direction of the cap that shadows, oblique to the seam so that both maps hold a part.
fn cap_axis() -> Vec3<f64> {
    let axis = Vec3::new(0.8, 0.1, 0.3);
    axis / axis.length()
}

/// Half-angle of the cap.
const CAP: f64 = 0.7;

/// Distance of the cap, which is a piece of a sphere around the light.
const CAP_DISTANCE: f64 = 3.0;

/// The maps of the cap, each texel from its own direction.
fn cap_maps(light: DpsmLight<f32>) -> DepthMaps {
    let mut maps = DepthMaps::empty(SIZE, 2, Sampling::Nearest);
    for hemisphere in 0..2 {
        for y in 0..SIZE {
            for x in 0..SIZE {
                let centre = |c| (f64::from(c) + 0.5) / f64::from(SIZE);
                let st = Vec2::new(centre(x), centre(y));
                let d = dpsm_unproject(dpsm_texture_to_disk(st, light.guard.into()));
                if angle(dpsm_flip(d, hemisphere), cap_axis()) <= CAP {
                    let depth = dpsm_depth(CAP_DISTANCE, light.near.into(), light.far.into());
                    let index = maps.index(x.into(), y.into(), hemisphere);
                    maps.depths[index] = depth as f32;
                }
            }
        }
    }
    maps
}

#[test]
fn points_behind_the_cap_are_in_shadow_and_no_others() {
    let light = plain_light(0.05);
    let maps = cap_maps(light);
    let mut rng = rng("cap");
    let [mut shadowed, mut lit] = [0, 0];
    for _ in 0..CASES {
        let d = unit(&mut rng);
        let l = uniform(&mut rng, 0.2, 9.0);
        let p = d * l;
        let off = angle(d.widen(), cap_axis());
        // a texel's centre decides for all its directions, half a diagonal away at most: the pitch
        // at the map's centre, the largest, times sqrt(2) / 2
        let texel = dpsm_texel_pitch(Vec2::new(0.0, 0.0), f64::from(SIZE), light.guard.into());
        let near_edge = (off - CAP).abs() <= texel * std::f64::consts::FRAC_1_SQRT_2;
        // own and stored depth: docs/visibility.md, in world units, and the stored one's rounding
        let bound = EPS * (10.5 * f64::from(l) + 4.5 * 0.1 + 10.0);
        let near_cap = (f64::from(l) - CAP_DISTANCE).abs() <= bound;
        if near_edge || near_cap {
            continue;
        }
        let truth = off > CAP || f64::from(l) < CAP_DISTANCE;
        assert_eq!(dpsm_visibility(&maps, p, light, 0.0), f32::from(u8::from(truth)), "{p:?}");
        match truth {
            true => lit += 1,
            false => shadowed += 1,
        }
    }
    assert!(shadowed > CASES / 50 && lit > CASES / 50, "{shadowed} in shadow, {lit} lit");
}

#[test]
fn back_of_a_hemispherical_light_is_always_in_shadow() {
    let light = DpsmLight { hemispheres: DPSM_HEMISPHERICAL, ..plain_light(0.0) };
    let maps = DepthMaps::empty(SIZE, 1, Sampling::Nearest);
    let mut rng = rng("hemispherical");
    for _ in 0..CASES {
        let p = unit(&mut rng) * 2.0;
        let expected = f32::from(u8::from(p.z >= 0.0));
        assert_eq!(dpsm_visibility(&maps, p, light, 0.0), expected, "{p:?}");
        let at = dpsm_receiver_vertex(p, light);
        if p.z != 0.0 && at.hemisphere_value != 0.5 {
            assert_eq!(dpsm_visibility_vertex(&maps, at, light, 0.0), expected, "{p:?}");
        }
    }
}

#[test]
fn equal_depth_is_lit_and_one_float_less_in_the_map_is_shadow() {
    let light = plain_light(0.0);
    let p = Vec3::new(0.5, -0.25, 2.0);
    let own = dpsm_lookup(p, light).depth;
    let mut maps = DepthMaps::empty(SIZE, 2, Sampling::Nearest);
    maps.depths.fill(own);
    assert_eq!(dpsm_visibility(&maps, p, light, 0.0), 1.0);
    maps.depths.fill(own.next_down());
    assert_eq!(dpsm_visibility(&maps, p, light, 0.0), 0.0);
    // a bias of one float's width makes up for it
    assert_eq!(dpsm_visibility(&maps, p, light, own - own.next_down()), 1.0);
}

#[test]
fn empty_maps_shadow_nothing_even_beyond_far() {
    let light = plain_light(0.02);
    let maps = DepthMaps::empty(SIZE, 2, Sampling::Nearest);
    let mut rng = rng("empty");
    for _ in 0..CASES {
        let p = point(&mut rng, -10, 10);
        assert_eq!(dpsm_visibility(&maps, p, light, 0.0), 1.0, "{p:?}");
    }
}

#[test]
fn lookup_stays_within_its_bounds() {
    let mut rng = rng("lookup");
    let [mut layers, mut atlas, mut depth] = [(); 3].map(|()| Worst::default());
    for _ in 0..CASES {
        let light = light(&mut rng);
        let p = point(&mut rng, -20, 8);
        let at = dpsm_lookup(p, light);
        let exact = dpsm_lookup(p.widen(), light.widen());
        let error = at.coordinates.widen() - exact.coordinates;
        for error in [error.x.abs(), error.y.abs()] {
            match light.placement == DPSM_LAYERS {
                true => layers.note(error, 8.0 * EPS, p),
                false => atlas.note(error, 11.0 * EPS, p),
            }
        }
        let (near, far) = (f64::from(light.near), f64::from(light.far));
        let bound = EPS * (10.5 * p.widen().length() + 4.5 * near) / (far - near);
        depth.note((f64::from(at.depth) - exact.depth).abs(), bound, (p, near, far));
        assert_eq!(at.hemisphere, dpsm_hemisphere(p));
        assert_eq!(at.layer, dpsm_light_layer(light, at.hemisphere));
    }
    layers.check("dpsm_lookup in layers");
    atlas.check("dpsm_lookup in an atlas");
    depth.check("dpsm_lookup, depth");
}

#[test]
fn lookup_by_vertex_is_the_lookup_by_pixel_at_the_vertices() {
    let mut rng = rng("by vertex");
    let mut worst = Worst::default();
    for _ in 0..CASES {
        let light = DpsmLight { placement: DPSM_LAYERS, ..light(&mut rng) };
        let p = point(&mut rng, -4, 4);
        let (at, by_vertex) = (dpsm_lookup(p, light), dpsm_receiver_vertex(p, light));
        let own = if at.hemisphere == 0 { by_vertex.front } else { by_vertex.back };
        // the same formula on the same side: nothing may differ
        worst.note((own - at.coordinates).widen().length(), f64::MIN_POSITIVE, p);
        let exact = dpsm_receiver_vertex(p.widen(), light.widen());
        for (value, exact) in [(by_vertex.front, exact.front), (by_vertex.back, exact.back)] {
            for (value, exact) in [(value.x, exact.x), (value.y, exact.y)] {
                // the sum with 0.5 is rounded at its own size
                let bound = EPS * (23.5 * (exact - 0.5).abs() + exact.abs().max(1.0));
                worst.note((f64::from(value) - exact).abs(), bound, p);
            }
        }
    }
    worst.check("dpsm_receiver_vertex");
}

#[test]
fn linear_sampling_weighs_the_four_comparisons() {
    let mut maps = DepthMaps::empty(2, 1, Sampling::Linear);
    maps.depths = vec![0.2, 0.8, 0.8, 0.8];
    use dpsm::scalar::maps::Maps;
    let at = |s: f64, t: f64| maps.compare(Vec2::new(s, t), 0, 0.5);
    assert_eq!(at(0.25, 0.25), 0.0);
    assert_eq!(at(0.5, 0.25), 0.5);
    assert_eq!(at(0.5, 0.5), 0.75);
    assert_eq!(at(0.0, 0.0), 0.0);
}
