//! Named hard cases: inputs at which a function is most likely to go wrong, each with what is
//! promised of it. Tests, docs/hard-cases.md and `dpsm eval` share them.

mod bias;
mod domain;
mod exact;
mod filters;
pub mod values;

use crate::scalar::float::{Vec2, Vec3, Vec4};
use crate::scalar::hemisphere::DPSM_BACK;
use crate::scalar::light::{DPSM_FORWARD, DPSM_REVERSED, DpsmLight};
use crate::scalar::ports::{Flat, PORTS, Word};
use crate::scalar::shade::DpsmCorner;
use domain::{Finite, Outside, all as any, finite, numbers, projected, sized, up_to, when};
use values::*;

pub use domain::Promise;

/// One input record of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// What is hard about it: the name of its value, and what else is particular.
    pub name: String,
    /// The value's name.
    pub value: &'static str,
    /// The table that the value is from.
    pub table: &'static str,
    /// What is promised of the function's result.
    pub promise: Promise,
    /// The record's words.
    pub words: Vec<Word<f32>>,
}

/// A light with an oblique rotation, far from the origin, in layers or in an atlas.
pub fn light(placement: u32) -> DpsmLight<f32> {
    DpsmLight { placement, ..LIGHT }
}

/// The named cases of a function; none for an unknown one.
pub fn of(function: &str) -> Vec<Case> {
    let [ahead, behind] = [POINTS.rows[0].1, POINTS.rows[1].1].map(point);
    let unit = point(DIRECTIONS.rows[0].1);
    let mut cases = Cases::default();
    match function {
        "dpsm_to_light" => {
            let moved = |p| LIGHT.position + point(p);
            cases.each(&POINTS, |p| up_to(63, p), |p| (moved(p), LIGHT));
            cases.each(&LIGHTS, any, |light| (light.position + ahead, light));
        }
        "dpsm_hemisphere" => cases.each(&POINTS, numbers, point),
        "dpsm_project" | "dpsm_project_own" => cases.each(&POINTS, projected, point),
        "dpsm_flip" => cases.each(&POINTS, finite, |p| (point(p), DPSM_BACK)),
        "dpsm_invert" => cases.each(&DISKS, |uv| up_to(63, uv), disk),
        "dpsm_unproject" => cases.each(&DISKS, |uv| up_to(62, uv), disk),
        "dpsm_texel_pitch" => {
            // size (1 + r^2) up to 2^126
            cases.each(&DISKS, |uv| up_to(58, uv), |uv| (disk(uv), 512.0, GUARD));
            cases.each(&SIZES, any, |size| (disk(DISKS.rows[1].1), size, GUARD));
            cases.each(&GUARDS, any, |guard| (disk(DISKS.rows[1].1), 512.0, guard));
        }
        "dpsm_texel_solid_angle" => {
            // pitches of at least 2^-51; smaller ones are finite
            let pitches = |uv| up_to(58, uv).min(up_to(21, uv).max(Finite));
            cases.each(&DISKS, pitches, |uv| (disk(uv), 512.0, GUARD));
            cases.each(&SIZES, any, |size| (disk(DISKS.rows[1].1), size, GUARD));
        }
        "dpsm_texel_width" => {
            cases.each(&SIZES, any, |size| (size, GUARD));
            cases.each(&GUARDS, any, |guard| (512.0, guard));
        }
        "dpsm_disk_to_texture" => {
            cases.each(&DISKS, |uv| up_to(63, uv), |uv| (disk(uv), GUARD));
            cases.each(&GUARDS, any, |guard| (disk(DISKS.rows[2].1), guard));
        }
        "dpsm_texture_to_disk" => cases.each(&DISKS, |st| up_to(62, st), |st| (disk(st), GUARD)),
        "dpsm_light_layer" => cases.each(&LIGHTS, any, |light| (light, DPSM_BACK)),
        "dpsm_light_coordinates" => {
            cases.each(&LIGHTS, any, |light| (light, DPSM_BACK, Vec2::new(0.5, 1.0)));
        }
        "dpsm_depth" | "dpsm_receiver_depth" => {
            cases.each(&DISTANCES, |l| up_to(63, [l[0]]), |[l, near, far]| (l, near, far));
        }
        "dpsm_depth_stored" => {
            for reversed in [DPSM_FORWARD, DPSM_REVERSED] {
                let behind = format!(", {reversed}");
                let domain = |depth: f32| when((0.0..=1.0).contains(&depth));
                cases.named(&DEPTHS, &behind, domain, |depth| (depth, reversed));
            }
        }
        "dpsm_depth_stored_four" => {
            let domain = |depth: f32| when((0.0..=1.0).contains(&depth));
            let four = |depth| Vec4::new(depth, 0.0_f32, 0.25, 1.0);
            cases.each(&DEPTHS, domain, |depth| (four(depth), DPSM_REVERSED));
        }
        "dpsm_within" => cases.each(&DISTANCES, numbers, |[l, near, far]| (l, near, far)),
        "dpsm_distance" => {
            cases.each(&DEPTHS, |depth| up_to(24, [depth]), |depth| (depth, 0.1, 10.0));
        }
        "dpsm_caster_border" => cases.each(&GUARDS, any, |guard| guard),
        "dpsm_caster_keep" => cases.each(&HEIGHTS, |value| numbers([value]), |value| value),
        "dpsm_caster_vertex" => {
            cases.each(&POINTS, projected, |p| (point(p), LIGHT, 0.01));
            cases.each(&LIGHTS, any, |light| (ahead, light, 0.01));
        }
        "dpsm_caster_fragment" => {
            cases.each(&POINTS, |p| up_to(63, p), |p| (point(p), LIGHT, 0.01));
            cases.each(&LIGHTS, any, |light| (behind, light, 0.01));
        }
        "dpsm_lookup" | "dpsm_receiver_vertex" => {
            cases.each(&POINTS, projected, |p| (point(p), LIGHT));
            cases.each(&LIGHTS, any, |light| (behind, light));
        }
        "dpsm_tessellate_weights" => {
            cases.each(&SUB_VERTICES, any, |[level, index]| (level, index))
        }
        "dpsm_tessellate_point" => {
            let [a, b, c] = [[0.1, -2.0, 3e3], [0.3, 7.0, -1e-3], [-5.0, 0.7, 1e-9]].map(point);
            cases.each(&WEIGHTS, any, |weights| (a, b, c, weights));
            let domain = |t: [[f32; 3]; 3]| when(t.iter().all(|&p| sized(-126, 126, p) > Outside));
            cases.each(&TRIANGLES, domain, |[a, b, c]| (point(a), point(b), point(c), [2, 3, 4]));
        }
        "dpsm_tessellate_level" => {
            let domain = |[edge, ..]: [f32; 3]| up_to(63, [edge]);
            cases.each(&LEVELS, domain, |[edge, distance, tau]| (edge, distance, LIGHT, tau, 64));
            cases.each(&LIGHTS, any, |light| (4.0, 2.0, light, 0.1, 1 << 15));
        }
        "dpsm_cube_face" => {
            // subnormal components may be flushed: finite all the same
            cases.each(&POINTS, |p| numbers(p).min(sized(-126, 128, p).max(Finite)), point);
            cases.each(&TIES, any, point);
        }
        "dpsm_cube_view" | "dpsm_cube_unview" => {
            cases.each(&FACES, any, |face| (Vec3::new(1.0, 2.0, 3.0), face));
            cases.each(&POINTS, finite, |p| (point(p), 0));
        }
        "dpsm_cube_guard" => cases.each(&SIZES, any, |size| size),
        "dpsm_cube_vertex" => {
            cases.each(&FACES, any, |face| (Vec3::new(1.0, 2.0, 3.0), face, LIGHT));
            cases.each(&POINTS, |p| sized(-126, 62, p), |p| (point(p), 5, LIGHT));
            cases.each(&LIGHTS, any, |light| (ahead, 4, light));
        }
        "dpsm_cube_depth" => {
            cases.each(&DISTANCES, |l| up_to(63, [l[0]]), |[l, near, far]| (l, near, far));
        }
        "dpsm_cube_receiver_depth" => {
            cases.each(&POINTS, projected, |p| (point(p), 5, LIGHT, 0.01));
            cases.each(&LIGHTS, any, |light| (ahead, 4, light, 0.01));
        }
        "dpsm_cube_lookup" => {
            cases.each(&POINTS, projected, |p| (point(p), LIGHT));
            cases.each(&TIES, any, |p| (point(p), LIGHT));
            cases.each(&LIGHTS, any, |light| (behind, light));
        }
        "dpsm_cube_direction" => {
            cases.each(&FACES, any, |face| (Vec2::new(0.25, 1.0), face, GUARD));
            cases.each(&DISKS, |st| up_to(62, st), |st| (disk(st), 0, GUARD));
        }
        "dpsm_cube_distance" => {
            let direction = Vec3::new(1.0, 0.5, -0.25);
            let domain = |depth: f32| when((0.0..=1.0).contains(&depth));
            cases.each(&DEPTHS, domain, |depth| (depth, direction, 0.1, 10.0));
        }
        "dpsm_cube_outside" => {
            cases.each(&CUBE_TRIANGLES, any, |[a, b, c]| (point(a), point(b), point(c), 4, GUARD));
            // components below 2^-100 may be flushed: a decision all the same
            let domain =
                |t: [[f32; 3]; 3]| t.map(|p| sized(-100, 63, p)).into_iter().min().unwrap();
            cases.each(&TRIANGLES, domain, |[a, b, c]| (point(a), point(b), point(c), 4, GUARD));
        }
        "dpsm_shade" => cases.each(&VISIBILITIES, any, |share| (unit, unit, unit, share)),
        "dpsm_blend" => {
            cases.each(&VISIBILITIES, any, |share| (unit, Vec3::splat(0.1), share));
        }
        "dpsm_lambert" => cases.each(&DIRECTIONS, any, |to_light| (unit, point(to_light))),
        "dpsm_highlight" => cases.each(&DIRECTIONS, any, |to_light| (unit, point(to_light), unit)),
        "dpsm_spot" => {
            let inside = |cosine: f32| when((-1.0..=1.0).contains(&cosine));
            cases.each(&COSINES, inside, |cosine| (cosine, 0.75, 0.5));
            cases.named(&COSINES, ", no cone", inside, |cosine| (cosine, -2.0, -3.0));
            cases.named(&COSINES, ", a sharp one", inside, |cosine| (cosine, 0.5, 0.5));
        }
        "dpsm_range" => {
            let inside = |[l, _, far]: [f32; 3]| up_to(62, [l]).min(up_to(62, [far]));
            cases.each(&DISTANCES, inside, |[l, _, far]| (l, far));
        }
        "dpsm_shadow_terminator" => {
            let third = Vec3::splat(1.0 / 3.0);
            let corner = |position, normal| DpsmCorner { position, normal };
            let [a, b, c] = [[1.0, 2.0, 3.0], [2.0, 2.0, 3.5], [1.5, 3.0, 2.0]].map(point);
            let far = |p| up_to(60, p);
            cases.each(&POINTS, far, |p| {
                (point(p), third, corner(a, unit), corner(b, unit), corner(c, unit))
            });
            cases.named(&POINTS, ", a corner", far, |p| {
                (point([1.0; 3]), third, corner(point(p), unit), corner(b, unit), corner(c, unit))
            });
            cases.each(&DIRECTIONS, any, |normal| {
                let normal = point(normal);
                let weights = point([0.0, 1.0, 0.0]);
                (b, weights, corner(a, normal), corner(b, normal), corner(c, normal))
            });
        }
        _ => {
            bias::add(function, &mut cases);
            exact::add(function, &mut cases);
            filters::add(function, &mut cases);
        }
    }
    cases.0
}

/// The worst inputs that searches found, a function's name and its words' bits each: regression
/// cases. `tools/accuracy --write` writes them.
pub fn worst() -> impl Iterator<Item = (&'static str, Vec<u32>)> {
    include_str!("cases/worst.txt").lines().filter_map(|line| {
        let mut parts = line.split_whitespace();
        let function = parts.next()?;
        Some((function, parts.filter_map(|bits| u32::from_str_radix(bits, 16).ok()).collect()))
    })
}

/// Every function with its cases, in the ports' order.
pub fn all() -> impl Iterator<Item = (&'static str, Vec<Case>)> {
    PORTS.iter().map(|(_, function)| (*function, of(function)))
}

#[derive(Default)]
struct Cases(Vec<Case>);

impl Cases {
    /// Adds a case for each value of a table, its words those of the arguments made from it.
    fn each<V: Copy, A: Flat<f32>>(
        &mut self,
        values: &Values<V>,
        promise: impl Fn(V) -> Promise,
        arguments: impl Fn(V) -> A,
    ) {
        self.named(values, "", promise, arguments);
    }

    /// The same, with what else is particular behind each name.
    fn named<V: Copy, A: Flat<f32>>(
        &mut self,
        values: &Values<V>,
        behind: &str,
        promise: impl Fn(V) -> Promise,
        arguments: impl Fn(V) -> A,
    ) {
        for &(name, value, _) in values.rows {
            let mut words = Vec::new();
            arguments(value).write(&mut words);
            let full = format!("{name}{behind}");
            let (table, promise) = (values.name, promise(value));
            self.0.push(Case { name: full, value: name, table, promise, words });
        }
    }
}

fn point([x, y, z]: [f32; 3]) -> Vec3<f32> {
    Vec3::new(x, y, z)
}

fn disk([x, y]: [f32; 2]) -> Vec2<f32> {
    Vec2::new(x, y)
}
