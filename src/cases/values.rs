//! The values of the hard cases, each with what is expected of it; docs/hard-cases.md is made from
//! them, and the wiring beside this file says which function takes which.

use crate::scalar::float::{Vec3, Vec4};
use crate::scalar::light::{
    DPSM_ATLAS, DPSM_FORWARD, DPSM_LAYERS, DPSM_OMNIDIRECTIONAL, DPSM_REVERSED, DpsmLight,
};

/// One row: the value's name, the value, and what comes out of it.
pub type Row<V> = (&'static str, V, &'static str);

/// A table of values of one kind.
#[derive(Debug)]
pub struct Values<V: 'static> {
    /// The table's name.
    pub name: &'static str,
    /// What its values are.
    pub about: &'static str,
    /// The rows.
    pub rows: &'static [Row<V>],
}

macro_rules! values {
    ($($name:ident: $t:ty, $about:literal [$($row:expr,)+])+) => {
        $(
            #[doc = $about]
            pub const $name: Values<$t> = Values {
                name: stringify!($name),
                about: $about,
                rows: &[$($row),+],
            };
        )+

        /// Every table's name, what its values are, and its rows with the values as text.
        pub fn tables() -> Vec<(&'static str, &'static str, Vec<Row<String>>)> {
            vec![$((stringify!($name), $about, text($name.rows)),)+]
        }
    };
}

/// 2^63, 2^62 and 2^-51: the ends of most domains.
const MOST: f32 = (1u64 << 63) as f32;
const HALF: f32 = (1u64 << 62) as f32;
const LEAST: f32 = 1.0 / (1u64 << 51) as f32;
/// 1 and one float more; 1 / sqrt(2).
const NEXT: f32 = 1.000_000_1;
const ROOT: f32 = std::f32::consts::FRAC_1_SQRT_2;
const NAN: f32 = f32::NAN;
const INFINITE: f32 = f32::INFINITY;
/// Width of the guard band of most cases, and the disk radius of the opposite pole.
pub const GUARD: f32 = 1.0 / 64.0;
const POLE: f32 = (1u64 << 25) as f32;

/// The light of most cases: an oblique rotation, far from the origin, in layers.
pub const LIGHT: DpsmLight<f32> = DpsmLight {
    position: Vec3 { x: 100.25, y: -3.5, z: 7.0 },
    near: 0.1,
    right: Vec3 { x: 2.0 / 3.0, y: 2.0 / 3.0, z: -1.0 / 3.0 },
    far: 10.0,
    up: Vec3 { x: -1.0 / 3.0, y: 2.0 / 3.0, z: 2.0 / 3.0 },
    guard: GUARD,
    forward: Vec3 { x: 2.0 / 3.0, y: -1.0 / 3.0, z: 2.0 / 3.0 },
    size: 512.0,
    rectangle: Vec4 { x: 0.25, y: 0.5, z: 0.25, w: 0.5 },
    first_layer: 6,
    placement: DPSM_LAYERS,
    hemispheres: DPSM_OMNIDIRECTIONAL,
    reversed: DPSM_FORWARD,
};

const fn at(distance: f32) -> DpsmLight<f32> {
    DpsmLight { position: Vec3 { x: distance, y: -distance, z: distance }, ..LIGHT }
}

const fn sized(size: f32) -> DpsmLight<f32> {
    DpsmLight { size, ..LIGHT }
}

/// Columns of 1.001 times their length and 1e-3 out of square.
const SKEWED: DpsmLight<f32> = DpsmLight {
    right: Vec3 { x: 0.667_333_3, y: 0.667_333_3, z: -0.333_666_7 },
    up: Vec3 { x: -0.332_333_3, y: 0.666_666_7, z: 0.665_666_7 },
    ..LIGHT
};

values! {
    POINTS: [f32; 3], "Light-space points." [
        ("ordinary in front", [1.0, 2.0, 3.0], "in front"),
        ("ordinary behind", [1.0, -2.0, -3.0], "behind"),
        ("front pole", [0.0, 0.0, 1.0], "in front, at the map's centre"),
        ("back pole", [0.0, 0.0, -1.0], "behind; in the front map the pole's radius stands for it"),
        ("back pole, minus zero", [-0.0, -0.0, -1.0], "as the back pole"),
        ("1e-4 rad from the back pole", [6e-5, -8e-5, -1.0], "in the front map at r = 20000"),
        ("1e-7 rad from the back pole", [1e-7, 0.0, -1.0], "in the front map at r = 2e7"),
        ("5e-8 rad from the back pole", [0.0, 5e-8, -1.0], "the back pole: within 2^-24 rad of it"),
        ("1e-20 rad from the back pole", [1e-20, 0.0, -1.0], "the back pole"),
        ("1e-30 rad from the back pole", [1e-30, 1e-30, -1.0], "the back pole"),
        ("1e-38 rad from the back pole", [-1e-38, 1e-38, -1.0], "the back pole, flushed or not"),
        ("rim", [0.6, 0.8, 0.0], "in front, r = 1"),
        ("rim at minus zero", [0.6, -0.8, -0.0], "in front: -0 is 0"),
        ("just behind the rim", [3.0, 4.0, -1e-7], "behind, r = 1 in both maps but for rounding"),
        ("just in front of the rim", [3.0, 4.0, 1e-7], "in front, r = 1 but for rounding"),
        ("1e-38 behind the rim", [1.0, 0.0, -1e-38], "behind, unless flushed where it is told"),
        ("the light's own position", [0.0, 0.0, 0.0], "in front, the disk's centre"),
        ("its own position, minus zero", [-0.0, -0.0, -0.0], "as the light's own position"),
        ("on the near sphere", [0.0, 0.1, 0.0], "depth 0"),
        ("on the far sphere", [6.0, 0.0, -8.0], "depth 1"),
        ("a floor at 89.999 degrees", [5.0, 0.0, 8.726_65e-5], "in front, by 17 microradians"),
        ("farthest", [MOST, -1.0, MOST], "the end of the domain: squares of up to 2^127"),
        ("far", [1e18, -1e18, 1e18], "within every domain"),
        ("nearest", [LEAST, 0.0, -LEAST], "the end of the domain: squares are normal floats"),
        ("near", [1e-15, 1e-15, -1e-15], "within every domain"),
        ("nearer", [1e-16, 0.0, 1e-17], "below 2^-51: finite, like the light's own position"),
        ("mixed magnitudes", [1e-10, 1e10, -1.0], "behind, on the rim but for 1e-10"),
        ("smallest beside largest", [1e-38, MOST, -1e-15], "as mixed magnitudes"),
        ("subnormal", [1e-40, -1e-41, 1e-45], "in front; finite, as the light's own position"),
        ("a subnormal behind", [0.0, 0.0, -1e-45], "either hemisphere where it is flushed"),
        ("1e19", [1e19, 0.0, -1e19], "beyond 2^63: finite or not"),
        ("3e38", [3e38, 3e38, 3e38], "beyond 2^63: its square overflows"),
        ("x not a number", [NAN, 0.0, 1.0], "anything, as adapters may assume that there is none"),
        ("y not a number", [0.0, NAN, 1.0], "anything"),
        ("z not a number", [1.0, 0.0, NAN], "anything"),
        ("x infinite", [INFINITE, 0.0, 1.0], "anything; not culled by its hemisphere, z >= 0"),
        ("y infinite", [0.0, -INFINITE, -1.0], "anything, behind"),
        ("z infinite", [1.0, 0.0, -INFINITE], "anything, behind"),
    ]
    DISKS: [f32; 2], "Disk coordinates." [
        ("centre", [0.0, 0.0], "the pole; inverted, the opposite one"),
        ("inside", [0.3, -0.4], "in the hemisphere"),
        ("rim", [0.6, 0.8], "in the seam, the same in both maps"),
        ("rim by rounding", [ROOT, ROOT], "r = 1 but for rounding"),
        ("in the guard band", [-1.01, 0.0], "stored beyond the rim"),
        ("corner of the map", [1.0 + GUARD, -1.0 - GUARD], "outside the stored disk"),
        ("outside the map", [-2.0, 3.0], "the nearest texel where one is asked for"),
        ("near the other pole", [1e4, -1e4], "0.14 mrad from it"),
        ("the other pole", [POLE, 0.0], "what the back pole is projected to"),
        ("near the centre", [1e-9, 2e-9], "below 2^-25: the other pole when inverted"),
        ("subnormal", [1e-40, -1e-42], "as the centre"),
        ("farthest", [HALF, 0.0], "the end of the domain"),
        ("1e19", [0.0, 1e19], "outside: finite or not"),
        ("3e38", [3e38, -3e38], "outside: its square overflows"),
        ("not a number", [NAN, 0.0], "anything"),
        ("infinite", [0.0, INFINITE], "anything"),
    ]
    DISTANCES: [f32; 3], "Radial distance, near and far." [
        ("on the near sphere", [0.1, 0.1, 10.0], "within, depth 0"),
        ("on the far sphere", [10.0, 0.1, 10.0], "within, depth 1"),
        ("between", [3.0, 0.1, 10.0], "within, depth in (0, 1)"),
        ("inside the near sphere", [0.05, 0.1, 10.0], "not within, depth below 0"),
        ("beyond the far sphere", [11.0, 0.1, 10.0], "not within, depth above 1"),
        ("next float above near", [0.100_000_01, 0.1, 10.0], "within, the smallest depth above 0"),
        ("nothing", [0.0, 0.1, 10.0], "not within"),
        ("near a millionth of far", [0.5, 1e-5, 10.0], "within"),
        ("near = a millionth of far", [1e-5, 1e-5, 10.0], "within, depth 0"),
        ("spheres a float apart", [1.0, 1.0, NEXT], "within, depth 0 of a single step"),
        ("1e8", [5e7, 1.0, 1e8], "within"),
        ("farthest", [MOST, 1.0, MOST], "within, depth 1"),
        ("subnormal", [1e-40, 0.1, 10.0], "as nothing"),
        ("3e38", [3e38, 0.1, 10.0], "outside: not within, the depth overflows or not"),
        ("infinite", [INFINITE, 0.1, 10.0], "not within"),
        ("not a number", [NAN, 0.1, 10.0], "anything"),
    ]
    DEPTHS: f32, "Stored depths, with near 0.1 and far 10." [
        ("near", 0.0, "the near sphere"),
        ("far", 1.0, "the far sphere"),
        ("between", 0.3, "between the spheres"),
        ("just off far", 0.9999, "between the spheres"),
        ("subnormal", 1e-40, "as near"),
        ("beyond far", 1.5, "beyond the far sphere, where not clamped"),
        ("infinite", INFINITE, "anything"),
        ("not a number", NAN, "anything"),
    ]
    GUARDS: f32, "Widths of guard bands." [
        ("no guard", 0.0, "the border is the rim"),
        ("narrow", GUARD, "the border is just behind the rim"),
        ("subnormal", 1e-40, "as no guard"),
        ("widest", 1.0, "the border is r = 2"),
    ]
    SIZES: f32, "Map sizes in texels." [
        ("1", 1.0, "one texel"),
        ("2", 2.0, "2 x 2 texels"),
        ("3", 3.0, "an odd number"),
        ("300", 300.0, "no power of 2"),
        ("512", 512.0, "ordinary"),
        ("16384", 16384.0, "the most that adapters take"),
    ]
    LIGHTS: DpsmLight<f32>, "Lights: what differs from the first." [
        ("layers", LIGHT, "the light of the other cases"),
        ("atlas", DpsmLight { placement: DPSM_ATLAS, ..LIGHT }, "coordinates in its rectangle"),
        ("one hemisphere", DpsmLight { hemispheres: 1, ..LIGHT }, "no map behind: not mapped"),
        ("layer 2^31", DpsmLight { first_layer: 1 << 31, ..LIGHT }, "layers are exact"),
        ("last layers", DpsmLight { first_layer: u32::MAX - 5, ..LIGHT }, "layers are exact"),
        ("reversed", DpsmLight { reversed: DPSM_REVERSED, ..LIGHT }, "1 less each depth"),
        ("1e4 from the origin", at(1e4), "positions round to 1e-3"),
        ("1e6 from the origin", at(1e6), "positions round to 0.06"),
        ("1e8 from the origin", at(1e8), "positions round to 8; finite"),
        ("near = a millionth of far", DpsmLight { near: 1e-5, ..LIGHT }, "depths in [0, 1]"),
        ("spheres close", DpsmLight { near: 3.7, far: 3.75, ..LIGHT }, "depths in [0, 1]"),
        ("off orthonormal by 1e-3", SKEWED, "finite; lengths off by as much"),
        ("no guard band", DpsmLight { guard: 0.0, ..LIGHT }, "the stored disk ends at the rim"),
        ("widest guard band", DpsmLight { guard: 1.0, ..LIGHT }, "the stored disk ends at r = 2"),
        ("1 texel", sized(1.0), "one texel for a hemisphere"),
        ("2 texels", sized(2.0), "four texels for a hemisphere"),
        ("16384 texels", sized(16384.0), "finite"),
    ]
    TIES: [f32; 3], "Points that lie on two or three faces of a cube, or beside an edge." [
        ("corner of three faces", [1.0, 1.0, 1.0], "+z"),
        ("opposite corner", [-1.0, -1.0, -1.0], "-z"),
        ("edge of x and y", [1.0, -1.0, 0.5], "-y"),
        ("edge of x and z", [-1.0, 0.25, 1.0], "+z"),
        ("one float off an edge", [NEXT, 1.0, 0.0], "+x"),
    ]
    FACES: u32, "Faces of a cube." [
        ("+x", 0, "face 0"),
        ("-x", 1, "face 1"),
        ("+y", 2, "face 2"),
        ("-y", 3, "face 3"),
        ("+z", 4, "face 4"),
        ("-z", 5, "face 5"),
        ("no face", 6, "counts as face 5"),
        ("largest", u32::MAX, "counts as face 5"),
    ]
    HEIGHTS: f32, "Hemisphere values, kept from 1/2 on." [
        ("border", 0.5, "kept"),
        ("just outside", 0.499_999_97, "discarded"),
        ("far behind", -3.0, "discarded"),
        ("infinite", INFINITE, "kept"),
        ("not a number", NAN, "anything"),
    ]
    SUB_VERTICES: [u32; 2], "Level and index of a sub-triangle's vertex." [
        ("whole triangle, b", [1, 1], "(0, 1, 0)"),
        ("first down triangle of 2 x 2, its first", [2, 9], "exact"),
        ("last vertex of 3 x 3", [3, 26], "exact"),
        ("one too many", [3, 27], "the corner a"),
        ("level 0", [0, 2], "counts as level 1"),
        ("largest level, last vertex", [1 << 15, 3_221_225_471], "exact"),
        ("largest level, one too many", [1 << 15, 3_221_225_472], "the corner a"),
        ("largest index", [7, u32::MAX], "the corner a"),
        ("both largest", [u32::MAX, u32::MAX], "exact"),
    ]
    WEIGHTS: [u32; 3], "Barycentric numerators." [
        ("corner", [0, 5, 0], "the corner b"),
        ("on an edge", [0, 2, 3], "a point between b and c"),
        ("middle of an edge", [2, 0, 2], "the middle of a and c"),
        ("centre", [1, 1, 1], "the centre"),
        ("inside", [1, 3, 2], "inside"),
        ("largest sum", [1 << 22, 1 << 23, 1 << 22], "2^24: on the line through b"),
        ("nothing", [0, 0, 0], "a point of the triangle's edge"),
    ]
    LEVELS: [f32; 3], "Longest edge, nearest distance and tolerance in texels." [
        ("wall", [4.0, 2.0, 0.5], "a level of 1 or more"),
        ("flat enough", [0.01, 2.0, 0.5], "level 1"),
        ("light on the triangle", [4.0, 0.0, 0.5], "the most"),
        ("no tolerance", [0.001, 2.0, 0.0], "at most the most"),
        ("huge tolerance", [4.0, 2.0, 1e9], "a level of 1 or more"),
        ("no edge", [0.0, 2.0, 0.5], "level 1"),
        ("farthest", [MOST, 1e-30, 0.5], "the most"),
        ("subnormal", [1e-40, 1e-40, 1e-40], "level 1"),
        ("3e38", [3e38, 1e-3, 0.5], "outside; a level all the same"),
    ]
    VISIBILITIES: f32, "Shares of the light that arrive." [
        ("lit", 1.0, "full illumination"),
        ("in shadow", 0.0, "ambient illumination"),
        ("half", 0.5, "the mean"),
    ]
    DIRECTIONS: [f32; 3], "Unit vectors beside (0.6, 0, 0.8)." [
        ("head on", [0.6, 0.0, 0.8], "cosine 1"),
        ("grazing", [0.8, 0.0, -0.6], "cosine 0 but for rounding"),
        ("grazing at 89.999 degrees", [0.800_010_5, 0.0, -0.599_986], "cosine 1.7e-5"),
        ("opposite", [-0.6, 0.0, -0.8], "faces away: 0"),
        ("across", [0.0, 1.0, 0.0], "cosine 0"),
    ]
    NORMALS: [f32; 3], "Normals at the point (1, 2, 3)." [
        ("facing", [1.0, 2.0, 3.0], "cosine 1"),
        ("turned away", [-3.0, -6.0, -9.0], "cosine 1: either side"),
        ("oblique and long", [0.0, 1e20, 0.0], "a unit normal"),
        ("longest", [3e37, -3e37, 3e37], "a unit normal"),
        ("short", [1e-20, 0.0, 1e-20], "a unit normal"),
        ("shortest", [1e-30, 0.0, 0.0], "a unit normal: 2^-100 and more"),
        ("edge-on", [3.0, 0.0, -1.0], "cosine 0"),
        ("nearly edge-on", [3.0, 0.0, -0.999], "cosine 3e-4"),
        ("edge-on by 1e-7", [3.0, 1e-7, -1.0], "cosine 2e-8"),
        ("grazing at 89.999 degrees", [3.000_014_8, 2.95e-5, -0.999_955_7], "cosine 1.7e-5"),
        ("none", [0.0, 0.0, 0.0], "the plane that faces the light"),
        ("subnormal", [1e-40, 0.0, 0.0], "as none"),
        ("not a number", [NAN, 0.0, 1.0], "anything"),
        ("infinite", [0.0, INFINITE, 1.0], "anything"),
    ]
    COSINES: f32, "Cosines of incidence." [
        ("facing", 1.0, "no plane's term but for rounding"),
        ("oblique", 0.5, "finite"),
        ("grazing", 0.001_745, "finite"),
        ("grazing at 89.999 degrees", 1.745_329_3e-5, "finite"),
        ("subnormal", 1e-40, "as edge-on"),
        ("edge-on", 0.0, "at most the whole distance"),
    ]
    CHORDS: f32, "Squares of chords on the unit sphere." [
        ("chord 1/64", 1.0 / 4096.0, "finite"),
        ("none", 0.0, "no plane's term but for rounding"),
        ("90 degrees", 2.0, "at most the whole distance"),
    ]
    WINDOWS: f32, "Half sides of windows in texels." [
        ("nearest texel", 0.5, "finite"),
        ("radius 3", 3.5, "finite"),
        ("nothing", 0.0, "no window"),
        ("subnormal", 1e-40, "as nothing"),
        ("whole map", 1024.0, "counts as 90 degrees"),
    ]
    ENDS: [[f32; 3]; 2], "Two ends of an edge." [
        ("ordinary", [[1.0, 2.0, 3.0], [2.0, 1.0, 3.5]], "an arc"),
        ("ends swapped", [[2.0, 1.0, 3.5], [1.0, 2.0, 3.0]], "the same arc, negated"),
        ("across the seam", [[1.0, 0.0, 0.25], [1.0, 0.5, -0.25]], "an arc in both maps"),
        ("both ends one", [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]], "no arc: the normal is 0"),
        ("in line with the light", [[1.0, 2.0, 3.0], [2.0, 4.0, 6.0]], "no arc: the normal is 0"),
        ("light between the ends", [[1.0, 2.0, 3.0], [-1.0, -2.0, -3.0]], "180 degrees: no arc"),
        ("180 degrees less a rounding", [[1.0, 2.0, 3.0], [-1.0, -2.0, -2.999_999_8]],
            "an arc or none"),
        ("180 degrees and a rounding", [[1.0, 2.0, 3.0], [-1.0, -2.0, -3.000_000_2]],
            "an arc or none"),
        ("180 degrees in the seam", [[1.0, 0.0, 0.0], [-1.0, 1e-38, 0.0]], "an arc or none"),
        ("an end at the light", [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]], "no arc: the normal is 0"),
        ("through the pole", [[-0.1, 0.0, 1.0], [0.1, 0.0, 1.0]], "a straight arc"),
        ("through the back pole", [[-0.1, 0.0, -1.0], [0.2, 0.0, -1.0]], "a straight arc"),
        ("beside the back pole", [[-0.1, 1e-9, -1.0], [0.1, 1e-9, -1.0]], "a straight arc"),
        ("in the seam", [[0.6, 0.8, 0.0], [0.8, 0.6, -0.0]], "an arc of the rim"),
        ("an end far away", [[1e-3, 2e-3, 1e-3], [-1e9, 3e9, 2e9]], "an arc"),
        ("ends farthest", [[HALF, 0.0, 1.0], [0.0, HALF, 1.0]], "an arc of the seam"),
        ("ends nearest", [[2.0 * LEAST, 0.0, 0.0], [0.0, 0.0, 2.0 * LEAST]], "an arc"),
        ("ends nearer", [[LEAST, 0.0, 0.0], [0.0, LEAST, LEAST]], "no arc: counts as one point"),
        ("1e-6 apart", [[1.0, 2.0, 3.0], [1.000_001, 2.0, 3.0]], "an arc"),
        ("subnormal", [[1e-40, 0.0, 0.0], [0.0, 1e-40, 0.0]], "no arc: the normal is 0"),
        ("3e38", [[3e38, 0.0, 0.0], [0.0, 3e38, 1.0]], "outside: anything"),
        ("not a number", [[1.0, NAN, 3.0], [2.0, 1.0, 3.5]], "anything"),
    ]
    TRIANGLES: [[f32; 3]; 3], "Triangles around the light." [
        ("seen counter-clockwise", [[0.0, 0.0, 2.0], [0.4, 0.0, 2.0], [0.0, 0.3, 2.5]], "drawn"),
        ("seen clockwise", [[0.0, 0.0, 2.0], [0.0, 0.3, 2.5], [0.4, 0.0, 2.0]], "drawn alike"),
        ("a texel wide", [[0.3, 0.2, 1.0], [0.308, 0.2, 1.0], [0.3, 0.208, 1.0]], "drawn"),
        ("smaller than a texel", [[0.3, 0.2, 1.0], [0.3005, 0.2, 1.0], [0.3, 0.2005, 1.0]],
            "culled between texel centres"),
        ("a wall", [[-9.0, -9.0, 1.0], [9.0, -9.0, 1.0], [0.0, 9.0, 1.0]], "in parts"),
        ("a needle", [[-0.2, 0.001, 1.0], [0.2, 0.0, 1.0], [0.0, 0.0005, 1.1]], "drawn"),
        ("a needle of aspect 1e6", [[-0.1, 0.0, 1.0], [0.1, 0.0, 1.0], [0.0, 2e-7, 1.0]],
            "drawn or culled; its hull is a rectangle's"),
        ("such a needle along a ray", [[0.1, 0.0, 1.0], [1.0, 1e-6, 9.0], [0.1, 1e-6, 1.0]],
            "drawn or culled"),
        ("across the seam", [[1.0, 0.0, 0.05], [1.0, 0.1, -0.05], [1.0, -0.1, -0.05]], "both maps"),
        ("behind", [[0.3, 0.0, -2.0], [0.5, 0.1, -2.0], [0.4, 0.3, -2.0]], "in the back map"),
        ("around the light", [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [0.0, 1.0, 1.0]],
            "culled: its plane holds the light"),
        ("around the back pole", [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [0.0, 1.0, -1.0]],
            "in parts"),
        ("an edge through the back pole", [[-0.1, 0.0, -1.0], [0.1, 0.0, -1.0], [0.0, 0.1, -1.0]],
            "in the back map"),
        ("edge-on", [[1.0, 0.0, 1.0], [1.0, 0.0, 2.0], [2.0, 0.0, 1.0]], "culled"),
        ("edge-on by 1e-7", [[0.1, 1e-7, 1.0], [0.1, 1e-7, 1.1], [0.2, 1e-7, 1.0]],
            "drawn or culled; no distance beyond the farthest vertex"),
        ("edge-on at 89.999 degrees", [[-0.1, 1.7e-5, 1.0], [0.1, 1.7e-5, 1.0], [0.0, 1.7e-5, 1.2]],
            "drawn or culled"),
        ("a vertex at the light", [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]], "culled"),
        ("no area", [[1.0, 1.0, 1.0], [1.0, 1.0, 2.0], [1.0, 1.0, 3.0]], "culled"),
        ("one point", [[1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.0]], "culled"),
        ("all at the light", [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [-0.0, 0.0, 0.0]], "culled"),
        ("inside the near sphere", [[0.0, 0.0, 0.05], [0.01, 0.0, 0.05], [0.0, 0.01, 0.05]],
            "culled"),
        ("beyond the far sphere", [[0.0, 0.0, 11.0], [3.0, 0.0, 11.0], [0.0, 3.0, 11.0]], "culled"),
        ("mixed magnitudes", [[1e-10, 1.0, 1e3], [-1e7, 1e-20, 1.0], [1.0, 1e12, -1e-5]],
            "both maps"),
        ("largest", [[HALF, 0.0, HALF], [0.0, HALF, HALF], [0.0, 0.0, HALF]], "culled"),
        ("subnormal", [[1e-40, 0.0, 0.0], [0.0, 1e-40, 0.0], [0.0, 0.0, 1e-40]], "culled"),
        ("1e19", [[1e19, 0.0, 2.0], [0.4, 0.0, 2.0], [0.0, 0.3, 2.5]], "culled"),
        ("3e38", [[3e38, 0.0, 2.0], [0.4, 3e38, 2.0], [0.0, 0.3, 3e38]], "culled"),
        ("not a number", [[0.0, 0.0, NAN], [0.4, 0.0, 2.0], [0.0, 0.3, 2.5]], "culled"),
        ("infinite", [[0.0, 0.0, 2.0], [INFINITE, 0.0, 2.0], [0.0, 0.3, 2.5]], "culled"),
    ]
    CUBE_TRIANGLES: [[f32; 3]; 3], "Triangles before the face +z." [
        ("in the middle", [[0.0, 0.0, 1.0], [0.1, 0.0, 1.0], [0.0, 0.1, 1.0]], "not outside"),
        ("larger than the face", [[-9.0, -9.0, 1.0], [9.0, -9.0, 1.0], [0.0, 9.0, 1.0]],
            "not outside"),
        ("touches the widened edge", [[1.015_625, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0]],
            "not outside"),
        ("beyond the right side", [[1.016, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0]], "outside"),
        ("behind", [[0.0, 0.0, -1.0], [0.1, 0.0, -1.0], [0.0, 0.1, -0.0]], "outside"),
        ("around the light", [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [0.0, 1.0, 1.0]],
            "not outside"),
    ]
    PATHS: u32, "Paths of halvings." [
        ("itself", 1, "the triangle"),
        ("first half", 2, "a half"),
        ("deep", 0b1101_0111, "a 128th"),
        ("longest, all second halves", u32::MAX, "31 halvings: unit vectors"),
        ("longest, all first halves", 1 << 31, "31 halvings: unit vectors"),
        ("no path", 0, "the triangle"),
    ]
    TANGENTS: f32, "Tangents of half-angles." [
        ("nothing", 0.0, "a cone of one direction"),
        ("subnormal", 1e-40, "as nothing"),
        ("a texel", 1.0 / 256.0, "a cone"),
        ("45 degrees", 1.0, "a cone"),
        ("nearly flat", 1024.0, "nearly a hemisphere"),
    ]
    OFFSETS: [f32; 2], "Offsets in the unit disk, or directions." [
        ("middle", [0.0, 0.0], "the axis itself"),
        ("outwards", [0.6, 0.8], "across the seam where the kernel reaches so far"),
        ("inwards", [-0.6, -0.8], "in the axis's hemisphere"),
        ("along the rim", [-0.8, 0.6], "on the rim for an axis on it: either hemisphere, r = 1"),
    ]
    TAPS: [f32; 2], "Places of taps." [
        ("middle", [0.0, 0.0], "mapped"),
        ("rim", [0.6, 0.8], "mapped"),
        ("exactly on the rim", [-1.0, 0.0], "mapped: the guard band holds its texel"),
        ("between two texels", [0.0, -0.5], "either texel"),
        ("behind the plane", [-0.6, -0.8], "compares the receiver's own depth"),
    ]
    RINGS: [u32; 2], "Index and count of taps." [
        ("first of one", [0, 1], "sqrt(1/2)"),
        ("first", [0, 16], "in (0, 1)"),
        ("last", [15, 16], "in (0, 1)"),
        ("last of 2^24", [(1 << 24) - 1, 1 << 24], "1 but for rounding"),
    ]
    PIXELS: [u32; 2], "Pixels." [
        ("first", [0, 0], "a unit vector"),
        ("other", [959, 719], "a unit vector"),
        ("largest", [u32::MAX, u32::MAX], "a unit vector"),
    ]
    SIDES: [f32; 2], "Map size and texels that a tap reads along a side." [
        ("one texel", [1.0, 2.0], "1: the widest band"),
        ("512", [512.0, 2.0], "a narrow band"),
        ("wide", [512.0, 7.0], "a wider band"),
        ("largest", [16384.0, 2.0], "the narrowest band"),
    ]
    GAPS: [f32; 2], "Distances of receivers and blockers." [
        ("halfway", [2.0, 1.0], "a tangent up to 1"),
        ("contact", [2.0, 2.0], "0"),
        ("a float apart", [NEXT, 1.0], "a rounding"),
        ("behind", [2.0, 3.0], "0"),
        ("at the light", [2.0, 0.0], "1: the widest"),
        ("both at the light", [0.0, 0.0], "0"),
        ("subnormal", [1e-40, 1e-41], "finite"),
        ("farthest", [HALF, LEAST], "1: the widest"),
    ]
    COUNTS: u32, "Taps asked for." [
        ("none", 0, "a ring of four"),
        ("two", 2, "a ring of four"),
        ("2^24", 1 << 24, "2^22 rings"),
        ("largest", u32::MAX, "wraps around: one ring"),
    ]
    SINES: f32, "Sines of a hull's angles, beside cosines of 1/2." [
        ("right angle", 1.0, "a corner"),
        ("narrow", 1.0 / 64.0, "a corner: the end of the domain"),
        ("none", 0.0, "outside: infinite"),
    ]
}

/// A value as the page shows it.
trait Shown {
    fn shown(&self) -> String;
}

macro_rules! shown {
    ($($t:ty),+) => {
        $(impl Shown for $t {
            fn shown(&self) -> String {
                format!("{self:?}")
            }
        })+
    };
}
shown!(u32, f32, [u32; 2], [u32; 3], [f32; 2], [f32; 3], [[f32; 3]; 2], [[f32; 3]; 3]);

impl Shown for DpsmLight<f32> {
    /// What differs from the light of most cases.
    fn shown(&self) -> String {
        let mut parts = Vec::new();
        macro_rules! differs {
            ($($member:ident),+) => {
                $(if self.$member != LIGHT.$member {
                    parts.push(format!("{}: {:?}", stringify!($member), self.$member));
                })+
            };
        }
        differs!(near, far, guard, size, first_layer, placement, hemispheres, reversed);
        for (name, own, other) in [
            ("position", self.position, LIGHT.position),
            ("right", self.right, LIGHT.right),
            ("up", self.up, LIGHT.up),
        ] {
            if own != other {
                parts.push(format!("{name}: {:?}", [own.x, own.y, own.z]));
            }
        }
        parts.join(", ")
    }
}

/// Rows with the values as text.
fn text<V: Shown>(rows: &[Row<V>]) -> Vec<Row<String>> {
    rows.iter().map(|(name, value, expected)| (*name, value.shown(), *expected)).collect()
}
