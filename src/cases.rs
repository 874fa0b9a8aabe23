//! Named hard cases: inputs at which a function is most likely to go wrong. Tests and `dpsm eval`
//! share them.

use crate::scalar::float::{Vec2, Vec3, Vec4};
use crate::scalar::hemisphere::DPSM_POLE_RADIUS;
use crate::scalar::light::{DPSM_ATLAS, DPSM_LAYERS, DPSM_OMNIDIRECTIONAL, DpsmLight};
use crate::scalar::ports::{Flat, PORTS, Word};

/// One input record of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// What is hard about it.
    pub name: String,
    /// The record's words.
    pub words: Vec<Word<f32>>,
}

/// Light-space points.
pub const POINTS: &[(&str, [f32; 3])] = &[
    ("ordinary in front", [1.0, 2.0, 3.0]),
    ("ordinary behind", [1.0, -2.0, -3.0]),
    ("front pole", [0.0, 0.0, 1.0]),
    ("back pole", [0.0, 0.0, -1.0]),
    ("1e-7 rad from the back pole", [1e-7, 0.0, -1.0]),
    ("1e-30 rad from the back pole", [1e-30, 1e-30, -1.0]),
    ("rim", [0.6, 0.8, 0.0]),
    ("rim at minus zero", [0.6, -0.8, -0.0]),
    ("just behind the rim", [3.0, 4.0, -1e-7]),
    ("the light's own position", [0.0, 0.0, 0.0]),
    ("the light's own position, minus zero", [-0.0, -0.0, -0.0]),
    ("farthest", [1e18, -1e18, 1e18]),
    ("nearest", [1e-15, 1e-15, -1e-15]),
    ("mixed magnitudes", [1e-10, 1e10, -1.0]),
];

/// Disk coordinates.
pub const DISKS: &[(&str, [f32; 2])] = &[
    ("centre", [0.0, 0.0]),
    ("inside", [0.3, -0.4]),
    ("rim", [0.6, 0.8]),
    ("in the guard band", [-1.01, 0.0]),
    ("near the other pole", [1e4, -1e4]),
    ("the other pole", [DPSM_POLE_RADIUS as f32, 0.0]),
    ("near the centre", [1e-9, 2e-9]),
];

/// Distances with near and far.
pub const DISTANCES: &[(&str, [f32; 3])] = &[
    ("on the near sphere", [0.1, 0.1, 10.0]),
    ("on the far sphere", [10.0, 0.1, 10.0]),
    ("between", [3.0, 0.1, 10.0]),
    ("inside the near sphere", [0.05, 0.1, 10.0]),
    ("beyond the far sphere", [11.0, 0.1, 10.0]),
    ("near a millionth of far", [0.5, 1e-5, 10.0]),
    ("next float above near", [0.100_000_01, 0.1, 10.0]),
];

/// A light with an oblique rotation, far from the origin, in layers or in an atlas.
pub fn light(placement: u32) -> DpsmLight<f32> {
    DpsmLight {
        position: Vec3::new(100.25, -3.5, 7.0),
        near: 0.1,
        right: Vec3::new(2.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0),
        far: 10.0,
        up: Vec3::new(-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0),
        guard: 1.0 / 64.0,
        forward: Vec3::new(2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0),
        size: 512.0,
        rectangle: Vec4::new(0.25, 0.5, 0.25, 0.5),
        first_layer: 6,
        placement,
        hemispheres: DPSM_OMNIDIRECTIONAL,
        padding: 0,
    }
}

/// The named cases of a function; none for an unknown one.
pub fn of(function: &str) -> Vec<Case> {
    let layers = light(DPSM_LAYERS);
    let atlas = light(DPSM_ATLAS);
    let unit = Vec3::new(0.6_f32, 0.0, 0.8);
    let both =
        |name: &str| [(format!("{name}, layers"), layers), (format!("{name}, atlas"), atlas)];
    let mut cases = Cases::default();
    match function {
        "dpsm_to_light" => {
            for (name, [x, y, z]) in POINTS {
                let world = layers.position + Vec3::new(*x, *y, *z);
                cases.add(*name, |words| (world.write(words), layers.write(words)));
            }
        }
        "dpsm_hemisphere" | "dpsm_project" => {
            for (name, p) in POINTS {
                cases.add(*name, |words| point(p).write(words));
            }
        }
        "dpsm_flip" => {
            for (name, p) in POINTS {
                cases.add(*name, |words| (point(p).write(words), 1_u32.write(words)));
            }
        }
        "dpsm_invert" | "dpsm_unproject" => {
            for (name, uv) in DISKS {
                cases.add(*name, |words| disk(uv).write(words));
            }
        }
        "dpsm_texel_pitch" | "dpsm_texel_solid_angle" => {
            for (name, uv) in DISKS {
                cases.add(*name, |words| {
                    disk(uv).write(words);
                    (512.0_f32.write(words), (1.0_f32 / 64.0).write(words));
                });
            }
        }
        "dpsm_disk_to_texture" | "dpsm_texture_to_disk" => {
            for (name, uv) in DISKS {
                cases.add(*name, |words| (disk(uv).write(words), (1.0_f32 / 64.0).write(words)));
            }
        }
        "dpsm_light_layer" => {
            for (name, light) in both("back map") {
                cases.add(name, |words| (light.write(words), 1_u32.write(words)));
            }
        }
        "dpsm_light_coordinates" => {
            for (name, light) in both("back map") {
                cases.add(name, |words| {
                    (light.write(words), 1_u32.write(words), Vec2::new(0.5_f32, 1.0).write(words));
                });
            }
        }
        "dpsm_depth" | "dpsm_within" | "dpsm_receiver_depth" => {
            for (name, [l, near, far]) in DISTANCES {
                cases.add(*name, |words| (l.write(words), near.write(words), far.write(words)));
            }
        }
        "dpsm_distance" => {
            for (name, depth) in
                [("near", 0.0_f32), ("far", 1.0), ("between", 0.3), ("beyond", 1.5)]
            {
                cases.add(name, |words| {
                    (depth.write(words), 0.1_f32.write(words), 10.0_f32.write(words));
                });
            }
        }
        "dpsm_caster_border" => {
            for (name, guard) in [("no guard", 0.0_f32), ("narrow", 1.0 / 64.0), ("widest", 1.0)] {
                cases.add(name, |words| guard.write(words));
            }
        }
        "dpsm_caster_keep" => {
            let below = 0.5_f32.next_down();
            for (name, value) in [("border", 0.5), ("just outside", below), ("far behind", -3.0)] {
                cases.add(name, |words| value.write(words));
            }
        }
        "dpsm_caster_vertex" | "dpsm_caster_fragment" => {
            for (name, p) in POINTS {
                cases.add(*name, |words| {
                    (point(p).write(words), layers.write(words), 0.01_f32.write(words));
                });
            }
        }
        "dpsm_lookup" | "dpsm_receiver_vertex" => {
            for (name, p) in POINTS {
                for (name, light) in both(name) {
                    cases.add(name, |words| (point(p).write(words), light.write(words)));
                }
            }
        }
        "dpsm_shade" => {
            for (name, visibility) in [("lit", 1.0_f32), ("in shadow", 0.0), ("half", 0.5)] {
                cases.add(name, |words| {
                    (unit.write(words), unit.write(words), unit.write(words));
                    visibility.write(words);
                });
            }
        }
        "dpsm_blend" => {
            for (name, visibility) in [("lit", 1.0_f32), ("in shadow", 0.0), ("half", 0.5)] {
                cases.add(name, |words| {
                    (unit.write(words), Vec3::splat(0.1_f32).write(words));
                    visibility.write(words);
                });
            }
        }
        "dpsm_lambert" => {
            for (name, to_light) in DIRECTIONS {
                cases.add(*name, |words| (unit.write(words), point(to_light).write(words)));
            }
        }
        "dpsm_highlight" => {
            for (name, to_light) in DIRECTIONS {
                cases.add(*name, |words| {
                    (unit.write(words), point(to_light).write(words), unit.write(words));
                });
            }
        }
        _ => {}
    }
    cases.0
}

/// Unit vectors beside (0.6, 0, 0.8).
const DIRECTIONS: &[(&str, [f32; 3])] = &[
    ("head on", [0.6, 0.0, 0.8]),
    ("grazing", [0.8, 0.0, -0.6]),
    ("opposite", [-0.6, 0.0, -0.8]),
    ("across", [0.0, 1.0, 0.0]),
];

/// Every function with its cases, in the ports' order.
pub fn all() -> impl Iterator<Item = (&'static str, Vec<Case>)> {
    PORTS.iter().map(|(_, function)| (*function, of(function)))
}

#[derive(Default)]
struct Cases(Vec<Case>);

impl Cases {
    fn add<R>(&mut self, name: impl Into<String>, write: impl FnOnce(&mut Vec<Word<f32>>) -> R) {
        let mut words = Vec::new();
        write(&mut words);
        self.0.push(Case { name: name.into(), words });
    }
}

fn point(&[x, y, z]: &[f32; 3]) -> Vec3<f32> {
    Vec3::new(x, y, z)
}

fn disk(&[x, y]: &[f32; 2]) -> Vec2<f32> {
    Vec2::new(x, y)
}
