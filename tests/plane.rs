//! Lookups against the receiver's plane: which texels, and what each says.

mod common;

use common::{rng, uniform, unit};
use dpsm::scalar::bias::dpsm_receiver;
use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::filter::*;
use dpsm::scalar::float::{Vec2, Vec3, Vec4};
use dpsm::scalar::hemisphere::{dpsm_flip, dpsm_hemisphere};
use dpsm::scalar::light::{DPSM_HEMISPHERICAL, DpsmLight};
use dpsm::scalar::maps::{DepthMaps, Maps, Sampling};
use dpsm::scalar::paraboloid::*;
use dpsm::scalar::plane::*;

const SIZE: u32 = 128;

fn light() -> DpsmLight<f64> {
    DpsmLight {
        near: 0.1,
        far: 10.0,
        guard: 0.03,
        size: SIZE.into(),
        first_layer: 0,
        hemispheres: 2,
        ..dpsm::cases::light(0).widen()
    }
}

/// Both maps of distances by direction.
fn maps(light: DpsmLight<f64>, scene: impl Fn(Vec3<f64>) -> f64, sampling: Sampling) -> DepthMaps {
    let mut maps = DepthMaps::empty(SIZE, 2, sampling);
    for layer in 0..2 {
        for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
            let st = Vec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / light.size;
            let d = dpsm_flip(dpsm_unproject(dpsm_texture_to_disk(st, light.guard)), layer);
            let index = maps.index(x.into(), y.into(), layer);
            maps.depths[index] = dpsm_depth(scene(d), light.near, light.far).min(1.0) as f32;
        }
    }
    maps
}

/// A receiver that faces the light: its own distance is its plane's, but for curvature.
fn facing(light: DpsmLight<f64>, p: Vec3<f64>, maps: &DepthMaps) -> f64 {
    dpsm_visibility_plane(maps, p, dpsm_receiver(p, p, 0.0), light, 0.0, 0.0)
}

#[test]
fn plane_is_where_its_receiver_is_and_leans_as_the_directions_turn() {
    let mut rng = rng("plane");
    let light = light();
    for _ in 0..20_000 {
        let p = unit(&mut rng).widen() * f64::from(uniform(&mut rng, 0.5, 9.0));
        let normal = unit(&mut rng).widen();
        let receiver = dpsm_receiver(p, normal, 0.0);
        let at = dpsm_plane(p, receiver, 0.0, light, 0.0, 0.0);
        assert_eq!(at.hemisphere, dpsm_hemisphere(p));
        assert!((at.uv - dpsm_project_own(p)).length() <= 1e-14);
        let sine = (1.0 - at.cosine * at.cosine).sqrt();
        assert!((at.lean.length() - sine).abs() <= 1e-7, "{p:?} {normal:?}");
        // n . d a small step away, by the direction itself
        let step = Vec2::new(f64::from(uniform(&mut rng, -1.0, 1.0)), 0.5) * 1e-4;
        let d = dpsm_flip(dpsm_unproject(at.uv + step), at.hemisphere);
        let exact = receiver.plane.xyz().dot(d) / receiver.plane.xyz().length();
        let turn = step * (2.0 / (1.0 + at.uv.dot(at.uv)));
        let linear = at.cosine + at.lean.dot(turn);
        // the square of the turn, as docs/plane.md bounds it, and the cosine's own
        let t = turn.length();
        assert!((linear - exact).abs() <= t * t * (0.5 * sine + 0.6) + 1e-12, "{linear} {exact}");
        // in units of the range
        let range = light.far - light.near;
        assert!((at.height * range / receiver.plane.w - 1.0).abs() <= 1e-5);
        assert!((at.distance * range / p.length() - 1.0).abs() <= 1e-5);
    }
}

#[test]
fn moved_receiver_lies_above_its_plane_by_the_shift_times_the_sine() {
    let mut rng = rng("moved");
    let light = light();
    for _ in 0..20_000 {
        let p = unit(&mut rng).widen() * f64::from(uniform(&mut rng, 0.5, 9.0));
        let receiver = dpsm_receiver(p, unit(&mut rng).widen(), 0.0);
        let [still, moved] =
            [0.0, 0.35].map(|shift| dpsm_plane(p, receiver, shift, light, 0.0, 0.0));
        let sine = (1.0 - still.cosine * still.cosine).sqrt();
        let pitch = dpsm_texel_pitch(dpsm_project_own(p), light.size, light.guard);
        assert!((still.pitch - pitch).abs() <= 1e-14);
        // the point itself, moved in space and projected again
        let q = p - receiver.plane.xyz() * (0.35 * pitch * p.length() * sine);
        let width = dpsm_texel_width(light.size, light.guard);
        if dpsm_hemisphere(q) == still.hemisphere {
            let apart = (moved.uv - dpsm_project_own(q)).length() / width;
            assert!(apart <= 0.35 * pitch, "{apart} texels");
        }
        // where it is read, n . d of the plane is larger by so much of a texel
        let along = still.lean.dot(moved.uv - still.uv) * (2.0 / (1.0 + still.uv.dot(still.uv)));
        let raised = moved.facing - (still.facing + along);
        assert!((raised - 0.35 * pitch * sine).abs() <= 1e-7 * pitch + 1e-9, "{raised}");
        let own = q.length() / (light.far - light.near);
        assert!((moved.distance - own).abs() <= own * (pitch * pitch + 1e-5));
    }
}

#[test]
fn texels_around_the_receiver_are_weighted_by_their_nearness() {
    let light = light();
    let open = maps(light, |_| 9.0, Sampling::Linear);
    let mut rng = rng("four");
    for _ in 0..2_000 {
        let p = unit(&mut rng).widen() * 5.0;
        let at = dpsm_plane(p, dpsm_receiver(p, p, 0.0), DPSM_PLANE_SHIFT, light, 0.0, 0.0);
        let four = dpsm_plane_four(at, light);
        let mut sum = 0.0;
        for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let mut one = open.clone();
            let (column, row) = (four.x as i64 + x, four.y as i64 + y);
            let index = one.index(column, row, at.hemisphere);
            one.depths[index] = 0.1;
            let dark = 1.0 - facing(light, p, &one);
            // as the hardware's comparison weighs it
            let st = dpsm_disk_to_texture(at.uv, light.guard);
            let hardware = 1.0 - Maps::<f64>::compare(&one, st, at.hemisphere, 0.3);
            assert!((dark - hardware).abs() <= 1e-9, "{dark} {hardware}");
            sum += dark;
        }
        assert!((sum - 1.0).abs() <= 1e-9, "{sum}");
    }
}

#[test]
fn what_is_less_than_half_a_texel_in_front_says_nothing_and_more_is_shadow() {
    let light = light();
    let p = Vec3::new(1.0, 2.0, 4.0);
    let l = p.length();
    let pitch = dpsm_texel_pitch(dpsm_project_own(p), light.size, light.guard);
    for sampling in [Sampling::Nearest, Sampling::Linear] {
        let in_front = |texels: f64| {
            let maps = maps(light, |_| l - texels * pitch * l, sampling);
            let receiver = dpsm_receiver(p, p, 0.0);
            (facing(light, p, &maps), dpsm_visibility_normal(&maps, p, receiver, light, 0.0, 0.0))
        };
        assert_eq!(in_front(0.0), (1.0, 1.0));
        assert_eq!(in_front(0.25).1, 1.0, "lit by its own distance");
        assert_eq!(in_front(0.45), (1.0, 0.0), "nothing is decided");
        assert_eq!(in_front(0.55), (0.0, 0.0));
    }
}

#[test]
fn own_distance_is_lit_to_three_tenths_of_a_texel_and_dark_from_a_whole_one() {
    let light = light();
    let mut rng = rng("depths");
    for _ in 0..2_000 {
        let p = unit(&mut rng).widen() * 5.0;
        let receiver = dpsm_receiver(p, unit(&mut rng).widen(), 0.0);
        let at = dpsm_plane(p, receiver, DPSM_PLANE_DIAGONAL, light, 0.0, 0.0);
        let depths = dpsm_plane_depths(at, receiver, light, 0.0, 0.0);
        let texel = at.pitch * receiver.distance / (light.far - light.near);
        assert!((depths.x - depths.y - 0.7 * texel).abs() <= 1e-12, "{depths:?}");
        // no farther than the moved receiver's own
        let own = at.distance - at.near;
        assert!((own - depths.x - 0.3 * texel).abs() <= 2e-5, "{own} {depths:?}");
    }
}

#[test]
fn undecided_texels_are_left_out_of_the_mean() {
    let light = light();
    let p = Vec3::new(1.0, 2.0, 4.0);
    let at = dpsm_plane(p, dpsm_receiver(p, p, 0.0), DPSM_PLANE_SHIFT, light, 0.0, 0.0);
    let four = Vec4::new(10.0, 20.0, 0.25, 0.25);
    let [lit, undecided, dark] =
        [1.0, 1.0 - 0.25 * at.pitch, 0.5].map(|k| k * at.distance - at.near);
    // lower left, lower right, upper right, upper left: 3/16, 1/16, 3/16, 9/16
    let share = |stored: [f64; 4]| dpsm_plane_share(at, four, Vec4::from_array(stored));
    assert!((share([lit, lit, dark, lit]) - 13.0 / 16.0).abs() <= 1e-12);
    assert!((share([undecided, undecided, dark, lit]) - 9.0 / 12.0).abs() <= 1e-12);
    assert_eq!(share([undecided; 4]), 1.0);
    assert_eq!(share([undecided, dark, undecided, undecided]), 0.0);
}

#[test]
fn empty_maps_light_receivers_beyond_far_and_a_missing_map_darkens() {
    let light = light();
    let empty = DepthMaps::empty(SIZE, 2, Sampling::Linear);
    let half = DpsmLight { hemispheres: DPSM_HEMISPHERICAL, ..light };
    let mut rng = rng("empty");
    for _ in 0..2_000 {
        let p = unit(&mut rng).widen() * f64::from(uniform(&mut rng, 0.01, 100.0));
        assert_eq!(facing(light, p, &empty), 1.0, "{p:?}");
        let normal = unit(&mut rng).widen();
        let receiver = dpsm_receiver(p, normal, 0.0);
        assert_eq!(dpsm_visibility_normal(&empty, p, receiver, light, 0.0, 0.0), 1.0, "{p:?}");
        let front = f64::from(u8::from(p.z >= 0.0));
        assert_eq!(facing(half, p, &empty), front, "{p:?}");
        assert_eq!(dpsm_visibility_normal(&empty, p, receiver, half, 0.0, 0.0), front, "{p:?}");
    }
}

#[test]
fn taps_read_the_directions_that_they_stand_for_on_either_side_of_the_rim() {
    let mut rng = rng("places");
    let light = light();
    let mut crossed = 0;
    for _ in 0..20_000 {
        let p = unit(&mut rng).widen() * 5.0;
        let at = dpsm_plane(p, dpsm_receiver(p, p, 0.0), 0.0, light, 0.0, 0.0);
        let turn = f64::from(uniform(&mut rng, 0.0, std::f32::consts::TAU));
        let rotation = Vec2::new(turn.cos(), turn.sin());
        let tangent = f64::from(uniform(&mut rng, 0.01, 0.5));
        let disk = dpsm_filter_cone(at, tangent, tangent, rotation);
        let own = dpsm_filter_map(light, at.hemisphere);
        let other = dpsm_filter_map(light, 1 - at.hemisphere).x;
        let offset = Vec2::new(0.3, -0.6);
        let four = dpsm_filter_places(disk, own, other, offset);
        let radius = tangent * 0.5 * (1.0 + at.uv.dot(at.uv));
        let turned = |o: Vec2<f64>| {
            let x = rotation.x * o.x - rotation.y * o.y;
            let y = rotation.y * o.x + rotation.x * o.y;
            at.uv + Vec2::new(x, y) * radius
        };
        let offsets = [offset, Vec2::new(0.6, 0.3), Vec2::new(-0.3, 0.6), Vec2::new(-0.6, -0.3)];
        for (i, o) in offsets.into_iter().enumerate() {
            let d = dpsm_flip(dpsm_unproject(turned(o)), at.hemisphere);
            // the direction's own map and place
            let beyond = dpsm_hemisphere(d) != at.hemisphere;
            let st = dpsm_disk_to_texture(dpsm_project_own(d), light.guard);
            let read = Vec2::new(four.s.to_array()[i], four.t.to_array()[i]);
            assert!((read - st).length() <= 1e-12, "{read:?} {st:?}");
            assert_eq!(four.crossed[i], beyond);
            crossed += usize::from(beyond);
        }
    }
    assert!(crossed > 2_000, "{crossed}");
}

#[test]
fn wall_beside_the_receiver_is_no_blocker_and_one_on_the_way_is() {
    let light = light();
    let p = Vec3::new(0.0, 0.0, 4.0);
    let at = dpsm_plane(p, dpsm_receiver(p, p, 0.0), DPSM_FILTER_SHIFT, light, 0.0, 0.0);
    let disk = dpsm_filter_cone(at, 0.05, 0.05, Vec2::new(1.0, 0.0));
    let says = |distance: f64, ring: f64| {
        let stored = dpsm_depth(distance, light.near, light.far);
        let offset = Vec2::new(ring, 0.0);
        dpsm_filter_even(disk, offset, ring, Vec4::splat(stored)).x
    };
    // at the border of a kernel of 0.05 a cone of 0.1 asks for 4 / 1.5
    assert_eq!([says(4.0, 1.0), says(3.0, 1.0), says(2.5, 1.0)], [1.0, 0.0, DPSM_FILTER_DARK]);
    // in the middle for no more than the half texel that is lit
    assert_eq!([says(4.0, 0.0), says(3.8, 0.0)], [1.0, DPSM_FILTER_DARK]);
    // and a wider light asks for less
    let wide = dpsm_filter_cone(at, 0.05, 0.3, Vec2::new(1.0, 0.0));
    let reach = Vec4::splat(dpsm_depth(3.0, light.near, light.far) + wide.near);
    assert_eq!(dpsm_filter_within(wide, 1.0, reach), [true; 4]);
}

#[test]
fn kernel_of_fixed_size_narrows_towards_contact() {
    // a half plane's edge over a floor: the share of light beside it
    let light = light();
    let floor = |d: Vec3<f64>| 4.0 * d.length() / d.z.max(1e-9);
    let lit = |height: f64, off: f64| {
        let scene = |d: Vec3<f64>| match d.x < 0.0 && d.z > 0.0 {
            true => (4.0 - height) * d.length() / d.z,
            false => floor(d),
        };
        let maps = maps(light, scene, Sampling::Nearest);
        let p = Vec3::new(off, 0.0, 4.0);
        let receiver = dpsm_receiver(p, Vec3::new(0.0, 0.0, 1.0), 0.0);
        let taps = DpsmTaps { count: 256, kind: DPSM_TAP_HARD, quantum: 0.0, tolerance: 0.0 };
        dpsm_filter_disk(&maps, p, receiver, 0.2, light, taps, Vec2::new(1.0, 0.0))
    };
    // halfway the penumbra reaches 0.2 rad; at a sixteenth of the way a fifteenth of that
    let halfway = lit(2.0, 0.4);
    assert!(halfway > 0.5 && halfway < 0.99, "{halfway}");
    assert_eq!(lit(0.5, 0.4), 1.0);
    assert_eq!(lit(0.5, -0.4), 0.0);
    assert!(lit(2.0, -0.4) > 0.01, "{}", lit(2.0, -0.4));
}
