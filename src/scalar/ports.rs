//! The ports by name, callable on flat words, as the evaluator and `dpsm eval` need them.

use super::bias::*;
use super::caster::*;
use super::classify::*;
use super::cube::*;
use super::depth::*;
use super::edge::*;
use super::filter::*;
use super::float::{Float, Vec2, Vec3, Vec4};
use super::hemisphere::*;
use super::interval::Interval;
use super::kernel::*;
use super::light::*;
use super::lights::*;
use super::paraboloid::*;
use super::part::*;
use super::pcss::*;
use super::plane::*;
use super::refine::*;
use super::shade::*;
use super::tessellate::*;
use super::triangle::*;
use super::visibility::*;

/// One 32-bit component of an argument or a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Word<T> {
    /// A component of type f32 in the shader.
    Float(T),
    /// A component of type u32 or bool in the shader.
    Integer(u32),
}

/// A value that is a fixed list of words, in the order of the shader's members.
pub trait Flat<T>: Sized {
    /// Takes the value's words from the list; `None` when one is missing or of the other kind.
    fn read(words: &mut dyn Iterator<Item = Word<T>>) -> Option<Self>;
    /// Appends the value's words.
    fn write(self, words: &mut Vec<Word<T>>);
}

macro_rules! float {
    ($t:ty) => {
        impl Flat<$t> for $t {
            fn read(words: &mut dyn Iterator<Item = Word<$t>>) -> Option<Self> {
                match words.next()? {
                    Word::Float(value) => Some(value),
                    Word::Integer(_) => None,
                }
            }
            fn write(self, words: &mut Vec<Word<$t>>) {
                words.push(Word::Float(self));
            }
        }
    };
}
float!(f32);
float!(f64);
float!(Interval);

impl<T> Flat<T> for u32 {
    fn read(words: &mut dyn Iterator<Item = Word<T>>) -> Option<Self> {
        match words.next()? {
            Word::Integer(value) => Some(value),
            Word::Float(_) => None,
        }
    }
    fn write(self, words: &mut Vec<Word<T>>) {
        words.push(Word::Integer(self));
    }
}

impl<T, V: Flat<T>> Flat<T> for [V; 2] {
    fn read(words: &mut dyn Iterator<Item = Word<T>>) -> Option<Self> {
        Some([V::read(words)?, V::read(words)?])
    }
    fn write(self, words: &mut Vec<Word<T>>) {
        for part in self {
            part.write(words);
        }
    }
}

impl<T, V: Flat<T>> Flat<T> for [V; 3] {
    fn read(words: &mut dyn Iterator<Item = Word<T>>) -> Option<Self> {
        Some([V::read(words)?, V::read(words)?, V::read(words)?])
    }
    fn write(self, words: &mut Vec<Word<T>>) {
        for part in self {
            part.write(words);
        }
    }
}

impl<T, V: Flat<T>> Flat<T> for [V; 4] {
    fn read(words: &mut dyn Iterator<Item = Word<T>>) -> Option<Self> {
        Some([V::read(words)?, V::read(words)?, V::read(words)?, V::read(words)?])
    }
    fn write(self, words: &mut Vec<Word<T>>) {
        for part in self {
            part.write(words);
        }
    }
}

impl<T> Flat<T> for bool {
    fn read(words: &mut dyn Iterator<Item = Word<T>>) -> Option<Self> {
        u32::read(words).map(|value| value != 0)
    }
    fn write(self, words: &mut Vec<Word<T>>) {
        u32::from(self).write(words);
    }
}

macro_rules! flat {
    ($($name:ident { $($member:ident),+ })+) => {$(
        impl<T: Float + Flat<T>> Flat<T> for $name<T> {
            fn read(words: &mut dyn Iterator<Item = Word<T>>) -> Option<Self> {
                Some(Self { $($member: Flat::read(words)?),+ })
            }
            fn write(self, words: &mut Vec<Word<T>>) {
                $( self.$member.write(words); )+
            }
        }
    )+};
}
flat! {
    Vec2 { x, y }
    Vec3 { x, y, z }
    Vec4 { x, y, z, w }
    DpsmLight {
        position, near, right, far, up, guard, forward, size, rectangle,
        first_layer, placement, hemispheres, reversed
    }
    DpsmCasterVertex { clip, hemisphere_value }
    DpsmCasterFragment { depth, keep }
    DpsmLookup { coordinates, depth, layer, hemisphere, mapped }
    DpsmReceiverVertex { front, back, depth, hemisphere_value }
    DpsmTriangle { first, second, third, face, span }
    DpsmProjected { p, distance, uv }
    DpsmHull { a, b, c }
    DpsmPart { a, b, c }
    DpsmCorner { position, normal }
    DpsmReceiver { plane, distance, rounding }
    DpsmKernel { axis, reach, hemisphere }
    DpsmReader { receiver, kind, scale, unscale, middle, texel, depth }
    DpsmTap { uv, hemisphere }
    DpsmTaps { count, kind, quantum, tolerance }
    DpsmBlockers { farthest, all }
    DpsmPlane { uv, lean, facing, cosine, pitch, height, distance, near, hemisphere }
    DpsmDisk {
        place, right, hemisphere, facing, lean, rest, height, distance, near, steep, least
    }
    DpsmFour { s, t, crossed }
    DpsmContact { sum, farthest }
}

macro_rules! tuple {
    ($($part:ident: $t:ident),+) => {
        /// Values one after the other, as a function's arguments.
        impl<T, $($t: Flat<T>),+> Flat<T> for ($($t,)+) {
            fn read(words: &mut dyn Iterator<Item = Word<T>>) -> Option<Self> {
                Some(($($t::read(words)?,)+))
            }
            fn write(self, words: &mut Vec<Word<T>>) {
                let ($($part,)+) = self;
                $( $part.write(words); )+
            }
        }
    };
}
tuple!(a: A);
tuple!(a: A, b: B);
tuple!(a: A, b: B, c: C);
tuple!(a: A, b: B, c: C, d: D);
tuple!(a: A, b: B, c: C, d: D, e: E);
tuple!(a: A, b: B, c: C, d: D, e: E, f: G);

/// A function of flat arguments.
trait Callable<T, Arguments> {
    fn apply(&self, words: &[Word<T>], out: &mut Vec<Word<T>>) -> Option<()>;
}

/// A port on flat words: appends its result's words; `None` for words that do not fit.
pub type Port<T> = fn(&[Word<T>], &mut Vec<Word<T>>) -> Option<()>;

/// Calls a port on flat words; `None` for an unknown name or words that do not fit.
pub fn call<T: Float + Flat<T>>(function: &str, words: &[Word<T>]) -> Option<Vec<Word<T>>> {
    let mut out = Vec::new();
    find(function)?(words, &mut out)?;
    Some(out)
}

macro_rules! callable {
    ($($part:ident: $t:ident),+) => {
        impl<T: Copy, F, R: Flat<T>, $($t: Flat<T>),+> Callable<T, ($($t,)+)> for F
        where
            F: Fn($($t),+) -> R,
        {
            fn apply(&self, words: &[Word<T>], out: &mut Vec<Word<T>>) -> Option<()> {
                let mut words = words.iter().copied();
                let ($($part,)+) = Flat::read(&mut words)?;
                if words.next().is_some() {
                    return None;
                }
                self($($part),+).write(out);
                Some(())
            }
        }
    };
}
callable!(a: A);
callable!(a: A, b: B);
callable!(a: A, b: B, c: C);
callable!(a: A, b: B, c: C, d: D);
callable!(a: A, b: B, c: C, d: D, e: E);
callable!(a: A, b: B, c: C, d: D, e: E, f: G);

/// A port as a function on T; `integers` marks one that has no float to be generic over.
macro_rules! port {
    ($function:ident) => {
        $function::<T>
    };
    ($function:ident integers) => {
        $function
    };
}

macro_rules! ports {
    ($($module:ident { $($function:ident $($integers:ident)?),+ $(,)? })+) => {
        /// The functions that have a port here: module and name, in the modules' order.
        pub const PORTS: &[(&str, &str)] = &[$($((stringify!($module), stringify!($function)),)+)+];

        /// The port of that name on flat words.
        pub fn find<T: Float + Flat<T>>(function: &str) -> Option<Port<T>> {
            match function {
                $($( stringify!($function) => {
                    Some(|words, out| port!($function $($integers)?).apply(words, out))
                } )+)+
                _ => None,
            }
        }
    };
}
ports! {
    hemisphere { dpsm_to_light, dpsm_hemisphere, dpsm_flip, dpsm_invert }
    paraboloid {
        dpsm_project, dpsm_project_own, dpsm_unproject, dpsm_texel_pitch, dpsm_texel_width,
        dpsm_texel_solid_angle, dpsm_disk_to_texture, dpsm_texture_to_disk,
    }
    light { dpsm_light_layer, dpsm_light_coordinates }
    depth {
        dpsm_depth, dpsm_distance, dpsm_depth_stored, dpsm_depth_stored_four, dpsm_within,
        dpsm_receiver_depth,
    }
    caster {
        dpsm_caster_border, dpsm_caster_vertex, dpsm_caster_keep, dpsm_caster_fragment,
    }
    tessellate {
        dpsm_tessellate_weights integers, dpsm_tessellate_point, dpsm_tessellate_level,
    }
    edge {
        dpsm_edge_largest, dpsm_edge_unit, dpsm_edge_ordered, dpsm_edge_normal,
        dpsm_edge_sagitta, dpsm_edge_terms, dpsm_edge_line,
    }
    triangle {
        dpsm_triangle_plane, dpsm_triangle_face, dpsm_triangle, dpsm_triangle_span, dpsm_triangle_inside,
        dpsm_triangle_covers, dpsm_triangle_distance, dpsm_triangle_disk, dpsm_triangle_behind,
        dpsm_triangle_fragment, dpsm_triangle_weights, dpsm_triangle_hull, dpsm_triangle_tip,
        dpsm_triangle_needle,
    }
    classify {
        dpsm_classify_usable, dpsm_projected, dpsm_classify, dpsm_classify_flat_error,
        dpsm_classify_distance, dpsm_classify_misses,
    }
    refine {
        dpsm_refine_point, dpsm_refine_reach, dpsm_refine_long, dpsm_refine_splits,
        dpsm_refine_corners integers, dpsm_refine_turned integers, dpsm_refine_edge integers, dpsm_refine_fat, dpsm_refine_foot, dpsm_refine_outside,
        dpsm_refine_flat,
        dpsm_refine_clip,
    }
    part { dpsm_part, dpsm_part_half, dpsm_part_kind }
    visibility { dpsm_lookup, dpsm_receiver_vertex }
    bias {
        dpsm_position_error, dpsm_receiver, dpsm_receiver_cosine, dpsm_receiver_distance, dpsm_bias_slack,
        dpsm_bias_window, dpsm_bias_plane, dpsm_bias_footprint, dpsm_texel_centre,
        dpsm_lookup_texel_centre, dpsm_lookup_biased,
    }
    plane { dpsm_plane, dpsm_plane_four, dpsm_plane_share, dpsm_plane_depths }
    cube {
        dpsm_cube_face, dpsm_cube_view, dpsm_cube_unview, dpsm_cube_guard, dpsm_cube_vertex,
        dpsm_cube_depth, dpsm_cube_receiver_depth, dpsm_cube_lookup, dpsm_cube_slack,
        dpsm_cube_lookup_texel_centre, dpsm_cube_lookup_footprint,
        dpsm_cube_direction, dpsm_cube_distance, dpsm_cube_outside,
    }
    kernel {
        dpsm_kernel_tangent, dpsm_kernel, dpsm_kernel_disk, dpsm_kernel_tap,
        dpsm_kernel_mirrored, dpsm_kernel_projected, dpsm_kernel_ring, dpsm_kernel_turn,
        dpsm_kernel_rings integers, dpsm_kernel_next, dpsm_kernel_rotation, dpsm_kernel_guard,
    }
    filter {
        dpsm_filter_reader, dpsm_filter_lookup, dpsm_filter_cone, dpsm_filter_map,
        dpsm_filter_places, dpsm_filter_step, dpsm_filter_layers, dpsm_filter_lit,
        dpsm_filter_within, dpsm_filter_share, dpsm_filter_even, dpsm_filter_dense,
        dpsm_filter_contact,
    }
    pcss { dpsm_pcss_tangent, dpsm_pcss_ring, dpsm_pcss_found, dpsm_pcss_width }
    lights { dpsm_lights_turn }
    shade {
        dpsm_shade, dpsm_blend, dpsm_lambert, dpsm_highlight, dpsm_spot, dpsm_range,
        dpsm_shadow_terminator,
    }
}
