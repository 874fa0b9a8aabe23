//! What the biases do to receivers that are no planes: close occluders, curved ones, creases, and
//! the faces of a cube.

mod common;

use common::planes::*;
use common::{CASES, rng, uniform, unit};
use dpsm::scalar::bias::*;
use dpsm::scalar::cube::*;
use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::dpsm_flip;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::maps::Maps;
use dpsm::scalar::paraboloid::*;

/// A map whose texel stores what a function of its direction gives, in f64.
struct Map<F> {
    light: DpsmLight<f64>,
    distance: F,
}

impl<F: Fn(Vec3<f64>) -> Option<f64>> Map<F> {
    fn stored(&self, st: Vec2<f64>, layer: u32) -> f64 {
        let centre = (st * self.light.size).floor() + Vec2::splat(0.5);
        let uv = dpsm_texture_to_disk(centre / self.light.size, self.light.guard);
        let l = (self.distance)(dpsm_flip(dpsm_unproject(uv), layer));
        l.map_or(1.0, |l| dpsm_depth(l, self.light.near, self.light.far))
    }
}

impl<F: Fn(Vec3<f64>) -> Option<f64>> Maps<f64> for Map<F> {
    fn compare(&self, st: Vec2<f64>, layer: u32, reference: f64) -> f64 {
        f64::from(u8::from(reference <= self.stored(st, layer)))
    }

    fn size(&self) -> Vec2<f64> {
        Vec2::splat(self.light.size)
    }

    fn load(&self, texel: Vec2<f64>, layer: u32) -> f64 {
        self.stored((texel + Vec2::splat(0.5)) / self.light.size, layer)
    }
}

#[test]
fn occluder_just_above_the_plane_shadows_along_the_texels_centre() {
    let mut rng = rng("contact");
    let [mut approaching, mut receding] = [0, 0];
    for _ in 0..CASES {
        let size = SIZES[rng.usize(0..6)];
        let light = plain_light(size).widen();
        let (p, normal) = grazing(&mut rng, size);
        let p = p.widen();
        let receiver = dpsm_receiver(p, normal, 0.0);
        let at = dpsm_lookup_texel_centre(p, receiver, light, 0.0, 0.0);
        let uv = dpsm_texel_centre(dpsm_project_own(p), light);
        let d = dpsm_flip(dpsm_unproject(uv), at.hemisphere);
        let Some(plane) = met(p, normal, d) else { continue };
        let depth = |l: f64| dpsm_depth(l, light.near, light.far).clamp(0.0, 1.0);
        // rounding's part of the distance, 64 eps over the cosine there
        let rounding = plane * DPSM_RECEIVER_ROUNDING / normal.dot(d);
        let slack = dpsm_bias_slack(plane.min(light.far), light, 0.0, 0.0);
        let allowed = slack + rounding / (light.far - light.near);
        assert!(at.depth >= depth(plane) - allowed, "{size} {p:?} {normal:?}");
        match plane > p.length() {
            true => receding += 1,
            false => approaching += 1,
        }
    }
    assert!(approaching > CASES / 4 && receding > CASES / 4);
}

/// A sphere's nearest, or farthest, meeting with a direction.
fn sphere(centre: Vec3<f64>, radius: f64, d: Vec3<f64>, far: bool) -> Option<f64> {
    let along = centre.dot(d);
    let square = along * along - centre.dot(centre) + radius * radius;
    let l = along + if far { square.sqrt() } else { -square.sqrt() };
    (l > 0.0).then_some(l) // NaN is none
}

#[test]
fn balls_never_shadow_their_lit_side() {
    let mut rng = rng("ball");
    for _ in 0..CASES {
        let light = plain_light(SIZES[rng.usize(0..6)]).widen();
        let centre = (unit(&mut rng) * uniform(&mut rng, 1.0, 6.0)).widen();
        let radius = centre.length() * f64::from(uniform(&mut rng, 0.05, 0.9));
        let normal = unit(&mut rng).widen();
        let p = centre + normal * radius;
        if normal.dot(p) > -0.002 * p.length() {
            continue; // turned away, or beyond 89.9 degrees
        }
        let map = Map { light, distance: |d| sphere(centre, radius, d, false) };
        let receiver = dpsm_receiver(p, normal, 0.0);
        let lit = dpsm_visibility_texel_centre(&map, p, receiver, light, 0.0, 0.0);
        assert_eq!(lit, 1.0, "texel centre: {p:?} of {centre:?}, {radius}");
        let lit = dpsm_visibility_footprint(&map, p, receiver, light, 0.5, 0.0, 0.0);
        assert_eq!(lit, 1.0, "footprint: {p:?} of {centre:?}, {radius}");
    }
}

#[test]
fn bowls_shadow_themselves_by_no_more_than_their_curvature() {
    let mut rng = rng("bowl");
    let mut shadowed = 0;
    for _ in 0..CASES {
        let light = plain_light(SIZES[rng.usize(0..6)]).widen();
        let radius = f64::from(uniform(&mut rng, 1.0, 9.0));
        // the light inside, so that incidence stays below 30 degrees
        let centre = (unit(&mut rng) * uniform(&mut rng, 0.0, 0.5)).widen() * radius;
        let p = centre + unit(&mut rng).widen() * radius;
        let l = p.length();
        let normal = p - centre;
        let map = Map { light, distance: |d| sphere(centre, radius, d, true) };
        let receiver = dpsm_receiver(p, normal, 0.0);
        let lit = dpsm_visibility_texel_centre(&map, p, receiver, light, 0.0, 0.0);
        shadowed += usize::from(lit == 0.0);
        // docs/bias.md: l^2 psi^2 / (2 R cos^3 a), psi half a texel's diagonal; to first order,
        // so an eighth more, as a tolerance
        let psi = dpsm_bias_window(dpsm_project_own(p), 0.5, light).sqrt();
        let cosine = normal.dot(p) / (normal.length() * l);
        let curvature = 1.125 * l * psi * psi / (2.0 * radius * cosine * cosine * cosine);
        let lit = dpsm_visibility_texel_centre(&map, p, receiver, light, 0.0, curvature);
        assert_eq!(lit, 1.0, "{p:?} of {centre:?}, {radius}");
    }
    assert!(shadowed > CASES / 100, "{shadowed}");
}

#[test]
fn creases_shadow_themselves_within_half_a_texels_diagonal_alone() {
    let mut rng = rng("crease");
    let [mut beside, mut plane] = [0, 0];
    for _ in 0..CASES {
        let light = plain_light(SIZES[rng.usize(0..6)]).widen();
        // two planes at right angles, both facing the light
        let d = unit(&mut rng).widen();
        let one = unit(&mut rng).widen();
        let other = one.cross(d) / one.cross(d).length();
        let other = if rng.bool() { other } else { other.cross(one) };
        let other = other - one * one.dot(other);
        let other = other / other.length();
        let heights = [0; 2].map(|_| f64::from(uniform(&mut rng, 0.5, 3.0)));
        let crease = one * heights[0] + other * heights[1];
        let along = one.cross(other) * f64::from(uniform(&mut rng, -3.0, 3.0));
        let size = light.size;
        let off = (crease + along).length() * f64::from(uniform(&mut rng, 0.0, 4.0)) / size;
        let p = crease + along - other * off;
        let distance = |d: Vec3<f64>| {
            let by = |n: Vec3<f64>, h: f64| {
                let facing = n.dot(d);
                if facing > 0.0 { h / facing } else { f64::INFINITY }
            };
            let l = by(one, heights[0]).min(by(other, heights[1]));
            l.is_finite().then_some(l)
        };
        let map = Map { light, distance };
        let receiver = dpsm_receiver(p, one, 0.0);
        let lit = dpsm_visibility_texel_centre(&map, p, receiver, light, 0.0, 0.0);
        // the nearest of the crease, by the angle
        let psi = dpsm_bias_window(dpsm_project_own(p), 0.5, light).sqrt();
        let near = (0..=64).any(|i| {
            let q = crease + along + one.cross(other) * ((f64::from(i) - 32.0) / 32.0 * 8.0 * off);
            (q / q.length() - p / p.length()).length() <= psi
        });
        beside += usize::from(near);
        plane += usize::from(lit == 0.0);
        assert!(lit == 1.0 || near, "{p:?} {one:?} {other:?}");
    }
    println!("{beside} beside the crease: {plane} shadowed by the plane's distance");
    assert!(plane > 0);
}

#[test]
fn cubes_faces_shadow_no_plane_either() {
    let mut rng = rng("cube");
    for size in SIZES {
        for steps in FORMATS {
            let light = DpsmLight { guard: dpsm_cube_guard(size as f32), ..plain_light(size) };
            for _ in 0..2000 {
                let (p, normal) = grazing(&mut rng, size);
                let stored = |at: Vec2<f32>, by: [i32; 2], face: u32| {
                    let texel =
                        |c: f32, by: i32| (c * light.size).floor() as f64 + f64::from(by) + 0.5;
                    let st = Vec2::new(texel(at.x, by[0]), texel(at.y, by[1])) / f64::from(size);
                    let d = dpsm_cube_direction(st, face, f64::from(light.guard));
                    let (near, far) = (f64::from(light.near), f64::from(light.far));
                    // along the axis, where a direction has length 1
                    match met(p.widen(), normal, d) {
                        Some(z) if z >= near && z <= far => {
                            stored_below(dpsm_cube_depth(z, near, far), steps)
                        }
                        _ => 1.0,
                    }
                };
                let receiver = dpsm_receiver(p, normal.narrow(), 0.0);
                let q = quantum(steps);
                let at = dpsm_cube_lookup_texel_centre(p, receiver, light, q);
                let lit = at.depth <= stored(at.coordinates, [0, 0], at.hemisphere);
                assert!(lit, "texel centre: {size} {steps:?} {p:?} {normal:?}");
                let tap = tap(&mut rng, 1);
                let at = dpsm_cube_lookup_footprint(p, receiver, 1.5, light, q);
                let lit = at.depth <= stored(at.coordinates, tap, at.hemisphere);
                assert!(lit, "footprint: {size} {steps:?} {tap:?} {p:?} {normal:?}");
            }
        }
    }
}
