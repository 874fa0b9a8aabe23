//! Named hard cases: inputs at which a function is most likely to go wrong. Tests and `dpsm eval`
//! share them.

mod bias;
mod exact;
mod filters;

use crate::scalar::float::{Vec2, Vec3, Vec4};
use crate::scalar::hemisphere::{DPSM_BACK, DPSM_POLE_RADIUS};
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
        guard: GUARD,
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
        "dpsm_to_light" => cases.each(POINTS, |p| (layers.position + point(p), layers)),
        "dpsm_hemisphere" | "dpsm_project" | "dpsm_project_own" => cases.each(POINTS, point),
        "dpsm_flip" => cases.each(POINTS, |p| (point(p), DPSM_BACK)),
        "dpsm_invert" | "dpsm_unproject" => cases.each(DISKS, disk),
        "dpsm_texel_pitch" | "dpsm_texel_solid_angle" => {
            cases.each(DISKS, |uv| (disk(uv), 512.0, GUARD));
        }
        "dpsm_texel_width" => {
            cases.each(&[("smallest", 1.0), ("512", 512.0)], |size| (size, GUARD));
        }
        "dpsm_disk_to_texture" | "dpsm_texture_to_disk" => {
            cases.each(DISKS, |uv| (disk(uv), GUARD));
        }
        "dpsm_light_layer" => cases.each(&both("back map"), |light| (light, DPSM_BACK)),
        "dpsm_light_coordinates" => {
            cases.each(&both("back map"), |light| (light, DPSM_BACK, Vec2::new(0.5, 1.0)));
        }
        "dpsm_depth" | "dpsm_within" | "dpsm_receiver_depth" => {
            cases.each(DISTANCES, |[l, near, far]| (l, near, far));
        }
        "dpsm_distance" => {
            let depths = [("near", 0.0), ("far", 1.0), ("between", 0.3), ("beyond far", 1.5)];
            cases.each(&depths, |depth| (depth, 0.1, 10.0));
        }
        "dpsm_caster_border" => {
            cases.each(&[("no guard", 0.0), ("narrow", GUARD), ("widest", 1.0)], |guard| guard);
        }
        "dpsm_caster_keep" => {
            let outside = 0.5_f32.next_down();
            let values = [("border", 0.5), ("just outside", outside), ("far behind", -3.0)];
            cases.each(&values, |value| value);
        }
        "dpsm_caster_vertex" | "dpsm_caster_fragment" => {
            cases.each(POINTS, |p| (point(p), layers, 0.01));
        }
        "dpsm_lookup" | "dpsm_receiver_vertex" => {
            for (name, p) in POINTS {
                cases.each(&both(name), |light| (point(*p), light));
            }
        }
        "dpsm_tessellate_weights" => {
            cases.each(SUB_VERTICES, |[level, index]| (level, index));
        }
        "dpsm_tessellate_point" => {
            let [a, b, c] = [[0.1, -2.0, 3e3], [0.3, 7.0, -1e-3], [-5.0, 0.7, 1e-9]].map(point);
            cases.each(WEIGHTS, |weights| (a, b, c, weights));
        }
        "dpsm_tessellate_level" => {
            cases.each(EDGES, |[edge, distance, tau]| (edge, distance, layers, tau, 64));
        }
        "dpsm_cube_face" => {
            cases.each(POINTS, point);
            cases.each(TIES, point);
        }
        "dpsm_cube_view" | "dpsm_cube_unview" => {
            cases.each(FACES, |face| (Vec3::new(1.0, 2.0, 3.0), face));
        }
        "dpsm_cube_guard" => {
            cases.each(&[("smallest", 1.0), ("widest", 4.0), ("512", 512.0)], |size| size);
        }
        "dpsm_cube_vertex" => {
            cases.each(FACES, |face| (Vec3::new(1.0, 2.0, 3.0), face, layers));
            cases.each(POINTS, |p| (point(p), 5, layers));
        }
        "dpsm_cube_depth" => cases.each(DISTANCES, |[l, near, far]| (l, near, far)),
        "dpsm_cube_receiver_depth" => cases.each(POINTS, |p| (point(p), 5, layers, 0.01)),
        "dpsm_cube_lookup" => {
            cases.each(POINTS, |p| (point(p), layers));
            cases.each(TIES, |p| (point(p), layers));
        }
        "dpsm_cube_direction" => cases.each(FACES, |face| (Vec2::new(0.25, 1.0), face, GUARD)),
        "dpsm_cube_distance" => {
            let depths = [("near", 0.0), ("far", 1.0), ("between", 0.3), ("just off far", 0.9999)];
            cases.each(&depths, |depth| (depth, Vec3::new(1.0, 0.5, -0.25), 0.1, 10.0));
        }
        "dpsm_cube_outside" => {
            cases.each(TRIANGLES, |[a, b, c]| (point(a), point(b), point(c), 4, GUARD))
        }
        "dpsm_shade" => cases.each(VISIBILITIES, |visibility| (unit, unit, unit, visibility)),
        "dpsm_blend" => {
            cases.each(VISIBILITIES, |visibility| (unit, Vec3::splat(0.1), visibility));
        }
        "dpsm_lambert" => cases.each(DIRECTIONS, |to_light| (unit, point(to_light))),
        "dpsm_highlight" => cases.each(DIRECTIONS, |to_light| (unit, point(to_light), unit)),
        _ => {
            bias::add(function, &mut cases);
            exact::add(function, &mut cases);
            filters::add(function, &mut cases);
        }
    }
    cases.0
}

/// Width of the guard band in the cases.
const GUARD: f32 = 1.0 / 64.0;

/// Points that lie on two or three faces of a cube, or beside an edge.
const TIES: &[(&str, [f32; 3])] = &[
    ("corner of three faces", [1.0, 1.0, 1.0]),
    ("opposite corner", [-1.0, -1.0, -1.0]),
    ("edge of x and y", [1.0, -1.0, 0.5]),
    ("edge of x and z", [-1.0, 0.25, 1.0]),
    ("one float off an edge", [1.000_000_1, 1.0, 0.0]),
];

/// Faces of a cube, and one beyond.
const FACES: &[(&str, u32)] =
    &[("+x", 0), ("-x", 1), ("+y", 2), ("-y", 3), ("+z", 4), ("-z", 5), ("no face", 6)];

/// Triangles before the face +z.
const TRIANGLES: &[(&str, [[f32; 3]; 3])] = &[
    ("in the middle", [[0.0, 0.0, 1.0], [0.1, 0.0, 1.0], [0.0, 0.1, 1.0]]),
    ("larger than the face", [[-9.0, -9.0, 1.0], [9.0, -9.0, 1.0], [0.0, 9.0, 1.0]]),
    ("touches the widened edge", [[1.015_625, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0]]),
    ("beyond the right side", [[1.016, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0]]),
    ("behind", [[0.0, 0.0, -1.0], [0.1, 0.0, -1.0], [0.0, 0.1, -0.0]]),
    ("around the light", [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [0.0, 1.0, 1.0]]),
];

/// Level and index of a sub-triangle's vertex.
const SUB_VERTICES: &[(&str, [u32; 2])] = &[
    ("whole triangle, b", [1, 1]),
    ("first down triangle of 2 x 2, its first", [2, 9]),
    ("last vertex of 3 x 3", [3, 26]),
    ("one too many", [3, 27]),
    ("level 0", [0, 2]),
    ("largest level, last vertex", [1 << 15, 3_221_225_471]),
    ("largest index", [7, u32::MAX]),
];

/// Barycentric numerators.
const WEIGHTS: &[(&str, [u32; 3])] = &[
    ("corner", [0, 5, 0]),
    ("on an edge", [0, 2, 3]),
    ("middle of an edge", [2, 0, 2]),
    ("centre", [1, 1, 1]),
    ("inside", [1, 3, 2]),
    ("nothing", [0, 0, 0]),
];

/// Longest edge, nearest distance and tolerance.
const EDGES: &[(&str, [f32; 3])] = &[
    ("wall", [4.0, 2.0, 0.5]),
    ("flat enough", [0.01, 2.0, 0.5]),
    ("light on the triangle", [4.0, 0.0, 0.5]),
    ("no tolerance", [0.001, 2.0, 0.0]),
    ("huge tolerance", [4.0, 2.0, 1e9]),
    ("no edge", [0.0, 2.0, 0.5]),
];

/// Shares of the light that arrive.
const VISIBILITIES: &[(&str, f32)] = &[("lit", 1.0), ("in shadow", 0.0), ("half", 0.5)];

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
    /// Adds a case for each named value, its words those of the arguments made from it.
    fn each<V: Copy, A: Flat<f32>>(
        &mut self,
        named: &[(impl AsRef<str>, V)],
        arguments: impl Fn(V) -> A,
    ) {
        for (name, value) in named {
            let mut words = Vec::new();
            arguments(*value).write(&mut words);
            self.0.push(Case { name: name.as_ref().to_string(), words });
        }
    }
}

fn point([x, y, z]: [f32; 3]) -> Vec3<f32> {
    Vec3::new(x, y, z)
}

fn disk([x, y]: [f32; 2]) -> Vec2<f32> {
    Vec2::new(x, y)
}
