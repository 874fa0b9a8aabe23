//! The rows. A measure gets the input's words `i`, the exact result `r` and the actual one `a`.

use super::Unit::{Absolute, Angle, Exact, Interval, Relative};
use super::{Bound, EPS, Error};
use crate::scalar::float::{Vec2, Vec3};
use crate::scalar::kernel::{DpsmKernel, dpsm_kernel_tap};

/// Scales below 2^-126 / eps count as that: what is flushed is eps of it.
const FLOOR: f64 = 1.0 / (1u128 << 103) as f64;

/// 2^n.
fn two(n: i32) -> f64 {
    f64::from(n).exp2()
}

/// The largest error of the words in eps of a scale.
fn absolute(r: &[f64], a: &[f64], bound: f64, scale: f64) -> Error {
    let scale = EPS * scale.max(FLOOR);
    let each = r.iter().zip(a).map(|(r, a)| Error { eps: (a - r).abs() / scale, bound });
    each.fold(Error { eps: 0.0, bound }, Error::or)
}

fn relative(r: &[f64], a: &[f64], bound: f64) -> Error {
    let each = r.iter().zip(a).map(|(r, a)| absolute(&[*r], &[*a], bound, r.abs()));
    each.fold(Error { eps: 0.0, bound }, Error::or)
}

/// The error of dpsm_project, with more behind it.
fn projected(p: &[f64], r: &[f64], a: &[f64], more: f64) -> Error {
    if p[2] >= 0.0 {
        return relative(r, a, 9.5 + more);
    }
    // the own hemisphere's coordinate is 1 / r^2 of it
    let floor = FLOOR * length(r).powi(2);
    let each = |k: usize| absolute(&r[k..=k], &a[k..=k], 19.0 + more, r[k].abs().max(floor));
    each(0).or(each(1))
}

/// The same f32, or a flushed one.
fn exact(r: &[f64], a: &[f64]) -> Error {
    let same = |(r, a): (&f64, &f64)| *r as f32 == *a as f32 || (a - r).abs() < two(-126);
    let broken = !r.iter().zip(a).all(same);
    Error { eps: if broken { f64::INFINITY } else { 0.0 }, bound: 1.0 }
}

/// Stands where the interval is the bound.
fn none(_: &[f64], _: &[f64], _: &[f64]) -> Error {
    Error::default()
}

fn any(_: &[f64]) -> bool {
    true
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

fn largest(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |most, c| most.max(c.abs()))
}

/// A largest component between two powers of two, or the light's own position.
fn point(p: &[f64], low: i32, high: i32) -> bool {
    (two(low)..=two(high)).contains(&largest(p)) || largest(p) == 0.0
}

fn within(v: &[f64], low: f64, high: f64) -> bool {
    v.iter().all(|c| (low..=high).contains(c))
}

/// Near and far of clipping spheres.
fn spheres(near: f64, far: f64) -> bool {
    two(-51) <= near && near < far && far <= two(62)
}

/// Views of a light's words.
struct Light<'a>(&'a [f64]);

impl Light<'_> {
    fn near(&self) -> f64 {
        self.0[3]
    }
    fn far(&self) -> f64 {
        self.0[7]
    }
    fn range(&self) -> f64 {
        self.far() - self.near()
    }
    fn guard(&self) -> f64 {
        self.0[11]
    }
    /// 1 where 1 less the depth is stored, which rounds once more.
    fn reversed(&self) -> f64 {
        self.0[23]
    }
    fn atlas(&self) -> bool {
        self.0[21] == 1.0
    }
    fn inside(&self) -> bool {
        let rows = [&self.0[4..7], &self.0[8..11], &self.0[12..15]];
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // orthonormal up to 1e-3 a row
        let straight = (0..3)
            .all(|i| (0..3).all(|j| (dot(rows[i], rows[j]) - f64::from(i == j)).abs() <= 2.5e-3));
        straight
            && spheres(self.near(), self.far())
            && within(&[self.guard()], 0.0, 1.0)
            && within(&self.0[15..16], 1.0, two(24))
            && within(&self.0[16..20], 0.0, 1.0)
            && largest(&self.0[..3]) <= two(62)
            && self.0[20] <= two(32) - 2.0
            && self.0[21] <= 1.0
            && (1.0..=2.0).contains(&self.0[22])
    }
}

fn light(i: &[f64], at: usize) -> Light<'_> {
    Light(&i[at..at + 24])
}

/// The z of a face's view space.
fn axis(p: &[f64], face: f64) -> f64 {
    match face as u32 {
        0 => p[0],
        1 => -p[0],
        2 => p[1],
        3 => -p[1],
        4 => p[2],
        _ => -p[2],
    }
}

/// A dpsm_plane's words.
fn plane(i: &[f64]) -> bool {
    on_disk(&[0.8 * i[0], 0.8 * i[1]])
        && length(&i[2..4]) <= 1.0 + 1e-4
        && within(&i[4..5], 0.0, 4.0)
        && within(&i[5..6], 0.0, 1.0)
        && within(&i[6..7], 0.0, 4.0)
        && within(&i[7..10], 0.0, two(60))
        && i[10] <= 1.0
}

/// A dpsm_filter_cone's words.
fn disk(i: &[f64]) -> bool {
    largest(&i[..4]) <= 4.0
        && i[4] <= 1.0
        && within(&i[5..6], 0.0, 8.0)
        && largest(&i[6..8]) <= 2.0
        && within(&i[8..9], 0.0, 16.0)
        && within(&i[9..12], 0.0, two(60))
        && within(&i[12..13], 0.0, 16.0)
        && within(&i[13..14], 0.0, two(30))
}

/// Within the unit disk, or on its rim up to rounding.
fn on_disk(uv: &[f64]) -> bool {
    length(uv) <= 1.0 + 8.0 * EPS
}

/// A unit vector up to rounding.
fn unit(v: &[f64]) -> bool {
    (length(v) - 1.0).abs() <= 32.0 * EPS
}

/// No two of the disk's points farther apart.
fn chords(points: &[f64], most: f64) -> bool {
    let apart = |a: &[f64], b: &[f64]| length(&[a[0] - b[0], a[1] - b[1]]);
    let (a, b, c) = (&points[..2], &points[2..4], &points[4..6]);
    apart(a, b) <= most && apart(b, c) <= most && apart(c, a) <= most
}

/// A triangle's plane as dpsm_triangle_face gives it.
fn face(i: &[f64]) -> bool {
    // its height is at least 2^-20 of the farthest vertex's distance
    (two(-50)..=two(62)).contains(&i[3]) && (1.0 - 32.0 * EPS..=two(21)).contains(&length(&i[..3]))
}

/// A prepared triangle as dpsm_triangle gives it: lines, plane and span.
fn prepared(i: &[f64]) -> bool {
    let line = |k: usize| length(&i[k..k + 3]) <= 1.0 && i[k + 3].abs() <= 1.0;
    line(0) && line(4) && line(8) && face(&i[12..]) && largest(&i[16..19]) <= two(40)
}

/// A receiver as dpsm_receiver gives it.
fn receiver(i: &[f64]) -> bool {
    unit(&i[..3])
        && i[4] >= two(-51)
        && i[4] <= two(62)
        && (0.0..=i[4] * (1.0 + 32.0 * EPS)).contains(&i[3])
        && within(&i[5..6], two(-17), 2.0)
}

fn triangle(i: &[f64]) -> bool {
    i.chunks(3).all(|p| point(p, -50, 61) && largest(p) > 0.0)
}

/// How far an arc's plane has turned along the arc from a to b, in eps rad.
fn turned(i: &[f64], r: &[f64], a: &[f64]) -> Error {
    let unit = |v: &[f64]| Vec3::new(v[0], v[1], v[2]) * (1.0 / length(v));
    let (from, to) = (unit(&i[..3]), unit(&i[3..6]));
    let cosine = from.dot(to).clamp(-1.0, 1.0);
    let bound = 4.5 / ((1.0 + cosine) / 2.0).sqrt() + 5.0;
    if length(r) < 0.5 || length(a) < 0.5 {
        return Error { eps: if length(r) == length(a) { 0.0 } else { f64::INFINITY }, bound };
    }
    let (exact, actual) = (unit(r), unit(a));
    let off = |share: f64| {
        let at = from * (1.0 - share) + to * share;
        let at = at / at.length();
        (actual.dot(at) - exact.dot(at)).abs()
    };
    let most = (0..=8).map(|step| off(f64::from(step) / 8.0)).fold(0.0, f64::max);
    let stretched = Error { eps: (length(a) - 1.0).abs() / EPS, bound: 19.0 }; // 11 sqrt 3
    Error { eps: most / EPS, bound }.or(stretched)
}

macro_rules! bounds {
    ($($module:ident { $($function:ident $unit:ident $inside:expr, $measure:expr;)+ })+) => {
        /// Every bound, in the ports' order.
        pub(super) const BOUNDS: &[Bound] = &[$($(Bound {
            function: stringify!($function),
            module: stringify!($module),
            unit: $unit,
            inside: $inside,
            measure: $measure,
        },)+)+];
    };
}

bounds! {
hemisphere {
    dpsm_to_light Absolute
        |i| light(i, 3).inside() && largest(&i[..3]) <= two(62),
        |i, r, a| absolute(r, a, 4.0, length(&[i[0] - i[3], i[1] - i[4], i[2] - i[5]]));
    dpsm_hemisphere Exact any, |_, r, a| exact(r, a);
    dpsm_flip Exact any, |_, r, a| exact(r, a);
    dpsm_invert Relative |i| largest(i) <= two(62), |_, r, a| relative(r, a, 4.5);
}
paraboloid {
    dpsm_project Relative
        |i| point(i, -51, 63),
        |i, r, a| projected(i, r, a, 0.0);
    dpsm_project_own Relative |i| point(i, -51, 63), |_, r, a| relative(r, a, 9.5);
    dpsm_unproject Absolute |i| largest(i) <= two(61), |_, r, a| absolute(r, a, 5.0, 1.0);
    dpsm_texel_pitch Relative
        |i| i[2] >= 1.0 && i[2] * (1.0 + length(&i[..2]).powi(2)) <= two(126) && within(&i[3..], 0.0, 1.0),
        |_, r, a| relative(r, a, 8.5);
    dpsm_texel_width Relative
        |i| i[0] >= 1.0 && i[0] <= two(126) && within(&i[1..], 0.0, 1.0),
        |_, r, a| relative(r, a, 3.5);
    dpsm_texel_solid_angle Relative
        |i| {
            let whole = i[2] * (1.0 + length(&i[..2]).powi(2));
            i[2] >= 1.0 && whole <= two(53) && within(&i[3..], 0.0, 1.0)
        },
        |_, r, a| relative(r, a, 18.0);
    dpsm_disk_to_texture Absolute
        |i| within(&i[2..], 0.0, 1.0) && largest(&i[..2]) <= 1.0 + i[2],
        |_, r, a| absolute(r, a, 3.0, 1.0);
    dpsm_texture_to_disk Absolute
        |i| within(i, 0.0, 1.0),
        |i, r, a| absolute(r, a, 6.0, 1.0 + i[2]);
}
light {
    dpsm_light_layer Exact |i| light(i, 0).inside() && i[24] <= 1.0, |_, r, a| exact(r, a);
    dpsm_light_coordinates Absolute
        |i| light(i, 0).inside() && i[24] <= 1.0 && within(&i[25..], 0.0, 1.0),
        |i, r, a| if light(i, 0).atlas() { absolute(r, a, 3.0, 1.0) } else { exact(r, a) };
}
depth {
    dpsm_depth Absolute
        |i| spheres(i[1], i[2]) && within(&i[..1], 0.0, two(62)),
        |i, r, a| absolute(r, a, 4.5, (i[0] + i[1]) / (i[2] - i[1]));
    dpsm_distance Absolute
        |i| spheres(i[1], i[2]) && i[0].abs() <= two(24),
        |i, r, a| absolute(r, a, 3.0, i[1] + i[0].abs() * i[2]);
    dpsm_depth_stored Absolute
        |i| within(&i[..1], 0.0, 1.0) && i[1] <= 1.0, |_, r, a| absolute(r, a, 1.0, 1.0);
    dpsm_depth_stored_four Absolute
        |i| within(&i[..4], 0.0, 1.0) && i[4] <= 1.0, |_, r, a| absolute(r, a, 1.0, 1.0);
    dpsm_within Exact any, |_, r, a| exact(r, a);
    dpsm_receiver_depth Absolute
        |i| spheres(i[1], i[2]) && within(&i[..1], 0.0, two(62)),
        |i, r, a| absolute(r, a, 4.5, (i[0] + i[1]) / (i[2] - i[1]));
}
caster {
    dpsm_caster_border Absolute |i| within(i, 0.0, 1.0), |_, r, a| absolute(r, a, 4.5, 1.0);
    dpsm_caster_vertex Absolute
        |i| point(&i[..3], -51, 62) && light(i, 3).inside() && within(&i[27..], 0.0, 1.0),
        |i, r, a| {
            let (l, light) = (length(&i[..3]), light(i, 3));
            let depth = (11.5 * l + 5.5 * light.near()) / light.range() + i[27] + light.reversed();
            projected(i, &r[..2], &a[..2], 3.5)
                .or(absolute(&r[2..3], &a[2..3], 1.0, depth))
                .or(exact(&r[3..4], &a[3..4]))
                .or(absolute(&r[4..], &a[4..], 1.0, 8.0 * l / light.far() + 1.0))
        };
    dpsm_caster_keep Exact any, |_, r, a| exact(r, a);
    dpsm_caster_fragment Absolute
        |i| point(&i[..3], -51, 62) && light(i, 3).inside() && within(&i[27..], 0.0, 1.0),
        |i, r, a| {
            let (l, light) = (length(&i[..3]), light(i, 3));
            let depth = (11.5 * l + 5.5 * light.near()) / light.range() + i[27] + light.reversed();
            absolute(&r[..1], &a[..1], 1.0, depth)
        };
}
tessellate {
    dpsm_tessellate_weights Exact any, |_, r, a| exact(r, a);
    dpsm_tessellate_point Absolute
        |i| largest(&i[..9]) <= two(125) && i[9..].iter().sum::<f64>() <= two(24),
        |i, r, a| {
            let along = |k: usize| absolute(&r[k..=k], &a[k..=k], 8.0, largest(&[i[k], i[k + 3], i[k + 6]]));
            along(0).or(along(1)).or(along(2))
        };
    dpsm_tessellate_level Exact
        |i| {
            light(i, 2).inside()
                && within(&i[..2], 0.0, two(62))
                && within(&i[26..27], 0.0, two(24))
                && within(&i[27..], 1.0, two(15))
        },
        |_, r, a| exact(r, a);
}
edge {
    dpsm_edge_largest Exact any, |_, r, a| exact(r, a);
    dpsm_edge_unit Absolute |i| largest(i) <= two(126), |_, r, a| absolute(r, a, 11.0, 1.0);
    dpsm_edge_ordered Exact any, |_, r, a| exact(r, a);
    dpsm_edge_normal Angle triangle, turned;
    dpsm_edge_sagitta Absolute
        |i| i[0].abs() <= 1.0 && length(&i[1..]) <= 1.0,
        |i, r, a| absolute(r, a, 5.0, length(&i[1..]).powi(2));
    dpsm_edge_terms Absolute
        |i| largest(i) <= two(61),
        |i, r, a| absolute(r, a, 3.0, 1.0 + length(i).powi(2));
    dpsm_edge_line Interval triangle, none;
}
triangle {
    dpsm_triangle_plane Interval triangle, none;
    dpsm_triangle_face Interval
        |i| unit(&i[..3]) && i[3].abs() <= two(62) && within(&i[4..], two(-50), two(62)), none;
    dpsm_triangle Interval |i| triangle(&i[..9]) && light(i, 9).inside(), none;
    dpsm_triangle_span Interval |i| triangle(&i[..9]) && light(i, 9).inside(), none;
    dpsm_triangle_inside Interval |i| prepared(i) && length(&i[19..]) <= 4.0, none;
    dpsm_triangle_covers Interval |i| prepared(i) && length(&i[19..]) <= 4.0, none;
    dpsm_triangle_distance Interval |i| face(i) && length(&i[4..]) <= 4.0, none;
    dpsm_triangle_disk Absolute
        |i| {
            // half the map's width is 1 + guard
            i[2] >= 0.5
                && (1.0..=2.0).contains(&(i[2] * i[4]))
                && (i[0] - i[2]).abs() <= i[2]
                && (i[1] - i[3]).abs() <= i[2]
        },
        |i, r, a| absolute(r, a, 5.0, i[2] * i[4]);
    dpsm_triangle_behind Interval |i| prepared(i) && within(&i[19..], two(-50), i[15]), none;
    dpsm_triangle_fragment Interval |i| prepared(i) && length(&i[19..21]) <= 4.0 && light(i, 21).inside(), none;
    dpsm_triangle_weights Interval |i| triangle(&i[..9]) && length(&i[9..]) <= 4.0, none;
    dpsm_triangle_hull Interval |i| triangle(&i[..9]) && light(i, 9).inside(), none;
    dpsm_triangle_tip Absolute
        |i| {
            (length(&i[..2]) - 1.0).abs() <= 8.0 * EPS
                && (length(&i[2..4]) - 1.0).abs() <= 8.0 * EPS
                && (i[0] * i[3] - i[1] * i[2]).abs() >= two(-6)
                && within(&i[4..], 0.0, 4.0)
        },
        |i, r, a| {
            let sine = i[0] * i[3] - i[1] * i[2];
            absolute(r, a, 12.0, (i[4] + i[5]).max(FLOOR) / (sine * sine))
        };
    dpsm_triangle_needle Interval
        |i| largest(&i[..8]) <= 4.0 && within(&i[8..], 0.0, 4.0), none;
}
classify {
    dpsm_classify_usable Exact any, |_, r, a| exact(r, a);
    dpsm_projected Interval |i| point(i, -51, 62), none;
    dpsm_classify Interval |i| light(i, 20).inside(), none;
    dpsm_classify_flat_error Interval
        |i| {
            largest(&i[..6]) <= 4.0
                && chords(i, 0.25)
                && within(&i[6..9], two(-50), two(62))
                && unit(&i[9..12])
                && i[12].abs() <= two(62)
        },
        none;
    dpsm_classify_distance Interval
        |i| {
            unit(&i[..3]) && i[3].abs() <= two(62) && length(&i[4..]) <= 4.0
        },
        none;
    dpsm_classify_misses Interval
        |i| chords(i, 0.5) && light(i, 6).inside() && within(&i[30..], 0.0, two(-4)), none;
}
refine {
    dpsm_refine_point Absolute
        triangle,
        |i, r, a| absolute(r, a, 28.0, length(&i[..3]).min(length(&i[3..])));
    dpsm_refine_reach Interval |i| light(i, 0).inside() && within(&i[24..], 0.0, two(16)), none;
    dpsm_refine_long Interval |i| largest(i) <= two(60), none;
    dpsm_refine_splits Interval
        |i| triangle(&i[..3]) && triangle(&i[6..9]) && largest(i) <= two(60) && i[12] >= 0.0, none;
    dpsm_refine_corners Exact any, |_, r, a| exact(r, a);
    dpsm_refine_turned Exact |i| i[0] < 8.0 && i[1] < 8.0, |_, r, a| exact(r, a);
    dpsm_refine_edge Exact any, |_, r, a| exact(r, a);
    dpsm_refine_fat Interval
        |i| triangle(&i[..3]) && triangle(&i[6..9]) && triangle(&i[12..15]), none;
    dpsm_refine_foot Interval
        |i| triangle(&i[..9]) && unit(&i[9..12]) && i[12].abs() <= two(62), none;
    dpsm_refine_outside Interval |i| largest(&i[..6]) <= two(60) && light(i, 6).inside(), none;
    dpsm_refine_flat Interval
        |i| {
            largest(&i[..6]) <= 4.0
                && chords(i, 0.25)
                && within(&i[6..9], two(-50), two(62))
                && unit(&i[9..12])
                && i[12].abs() <= two(62)
                && within(&i[13..], 0.0, 1.0)
        },
        none;
    dpsm_refine_clip Interval
        |i| largest(&i[..2]) <= two(61) && within(&i[2..3], 0.0, two(62)) && light(i, 3).inside(), none;
}
part {
    dpsm_part Interval |i| triangle(&i[..9]) && i[9] >= 1.0, none;
    dpsm_part_half Interval |i| i[..9].chunks(3).all(unit), none;
    dpsm_part_kind Interval |i| i[..9].chunks(3).all(unit) && light(i, 9).inside(), none;
}
visibility {
    dpsm_lookup Absolute
        |i| point(&i[..3], -51, 62) && light(i, 3).inside(),
        |i, r, a| {
            let light = light(i, 3);
            let depth = (10.5 * length(&i[..3]) + 4.5 * light.near()) / light.range();
            absolute(&r[..2], &a[..2], if light.atlas() { 11.0 } else { 8.0 }, 1.0)
                .or(absolute(&r[2..3], &a[2..3], 1.0, depth))
        };
    dpsm_receiver_vertex Absolute
        |i| point(&i[..3], -51, 62) && light(i, 3).inside(),
        |i, r, a| {
            let light = light(i, 3);
            let l = length(&i[..3]);
            let depth = (10.5 * l + 4.5 * light.near()) / light.range();
            let (own, other) = if i[2] >= 0.0 { (0, 2) } else { (2, 0) };
            let far_off = |k: usize| absolute(&r[k..=k], &a[k..=k], 1.0, 23.5 * (r[k] - 0.5).abs() + 1.0);
            absolute(&r[own..own + 2], &a[own..own + 2], 8.0, 1.0)
                .or(far_off(other))
                .or(far_off(other + 1))
                .or(absolute(&r[4..5], &a[4..5], 1.0, depth))
                .or(absolute(&r[5..], &a[5..], 1.0, 8.0 * l / light.far() + 1.0))
        };
}
bias {
    dpsm_position_error Exact |i| largest(i) <= two(127), |_, r, a| exact(r, a);
    dpsm_receiver Absolute
        |i| point(&i[..3], -51, 62) && point(&i[3..6], -50, 61) && within(&i[6..], 0.0, two(62)),
        |i, r, a| {
            let l = length(&i[..3]);
            absolute(&r[..3], &a[..3], 11.0, 1.0)
                .or(absolute(&r[3..4], &a[3..4], 14.0, l))
                .or(relative(&r[4..5], &a[4..5], 6.0))
                .or(relative(&r[5..], &a[5..], 10.0))
        };
    dpsm_receiver_cosine Absolute |i| receiver(i), |_, r, a| absolute(r, a, 23.0, 1.0);
    dpsm_receiver_distance Interval |i| receiver(&i[..6]) && largest(&i[6..8]) <= two(61), none;
    dpsm_bias_slack Relative
        |i| within(&i[..1], 0.0, two(62)) && light(i, 1).inside() && within(&i[25..], 0.0, 1.0),
        |_, r, a| relative(r, a, 7.0);
    dpsm_bias_window Relative
        |i| largest(&i[..2]) <= two(29) && within(&i[2..3], 0.0, two(24)) && light(i, 3).inside(),
        |i, r, a| relative(r, a, 19.0 + 12.0 * length(&i[..2]));
    dpsm_bias_plane Absolute
        |i| {
            within(&i[..1], 0.0, 1.0)
                && within(&i[1..2], 0.0, two(62))
                && within(&i[2..3], 0.0, 2.0)
                && within(&i[3..4], two(-17), 2.0)
                && light(i, 4).inside()
        },
        |i, r, a| absolute(r, a, 12.0, i[1] / light(i, 4).range());
    dpsm_bias_footprint Interval
        |i| {
            receiver(&i[..6])
                && largest(&i[6..8]) <= two(29)
                && within(&i[8..9], 0.0, two(24))
                && light(i, 9).inside()
        },
        none;
    dpsm_texel_centre Absolute
        |i| largest(&i[..2]) <= two(62) && light(i, 2).inside() && i[17] <= two(20) && i[17].fract() == 0.0,
        |i, r, a| absolute(r, a, 6.0, 1.0 + light(i, 2).guard());
    dpsm_lookup_texel_centre Interval
        |i| point(&i[..3], -51, 61) && receiver(&i[3..9]) && light(i, 9).inside(), none;
    dpsm_lookup_biased Interval |i| point(&i[..3], -51, 61) && light(i, 4).inside(), none;
}
plane {
    dpsm_plane Interval
        |i| {
            point(&i[..3], -51, 60)
                && receiver(&i[3..9])
                && within(&i[9..10], 0.0, 2.0)
                && light(i, 10).inside()
                && light(i, 10).far() <= two(60)
                && within(&i[34..], 0.0, 1.0)
        },
        none;
    dpsm_plane_four Interval |i| plane(&i[..11]) && light(i, 11).inside() && light(i, 11).0[15] >= 2.0, none;
    dpsm_plane_share Interval
        |i| plane(&i[..11]) && within(&i[11..13], 0.0, two(24)) && within(&i[13..], 0.0, 1.0), none;
    dpsm_plane_depths Interval
        |i| {
            plane(&i[..11])
                && receiver(&i[11..17])
                && light(i, 17).inside()
                && within(&i[41..], 0.0, 1.0)
        },
        none;
}
cube {
    dpsm_cube_face Exact
        |i| i.iter().all(|c| *c == 0.0 || c.abs() >= two(-126)), |_, r, a| exact(r, a);
    dpsm_cube_view Exact any, |_, r, a| exact(r, a);
    dpsm_cube_unview Exact any, |_, r, a| exact(r, a);
    dpsm_cube_guard Relative |i| within(i, 1.0, two(24)), |_, r, a| relative(r, a, 3.5);
    dpsm_cube_vertex Absolute
        |i| largest(&i[..3]) <= two(62) && light(i, 4).inside(),
        |i, r, a| {
            let light = light(i, 4);
            let scale = light.far() * ((r[3].abs() + light.near()) / light.range());
            relative(&r[..2], &a[..2], 3.5)
                .or(absolute(&r[2..3], &a[2..3], 5.5, scale))
                .or(exact(&r[3..], &a[3..]))
        };
    dpsm_cube_depth Absolute
        |i| spheres(i[1], i[2]) && i[0].abs() <= two(62),
        |i, r, a| absolute(r, a, 10.5, i[2] / (i[2] - i[1]));
    dpsm_cube_receiver_depth Absolute
        |i| point(&i[..3], -51, 62) && light(i, 4).inside() && within(&i[28..], 0.0, 1.0),
        |i, r, a| {
            let light = light(i, 4);
            let z = axis(&i[..3], i[3]);
            let share = i[28] * light.range() / length(&i[..3]).max(two(-51));
            let moved = (z - z * share).max(light.near());
            let more = 13.0 * light.near() * z.abs() / (moved * moved);
            absolute(r, a, 10.5 + more, light.far() / light.range())
        };
    dpsm_cube_lookup Absolute
        |i| point(&i[..3], -51, 62) && light(i, 3).inside(),
        |i, r, a| {
            let light = light(i, 3);
            absolute(&r[..2], &a[..2], 4.5, 1.0)
                .or(absolute(&r[2..3], &a[2..3], 10.5, light.far() / light.range()))
        };
    dpsm_cube_slack Relative
        |i| light(i, 1).inside() && within(&i[..1], i[4], two(62)) && within(&i[25..], 0.0, 1.0),
        |_, r, a| relative(r, a, 11.0);
    dpsm_cube_lookup_texel_centre Interval
        |i| point(&i[..3], -51, 61) && receiver(&i[3..9]) && light(i, 9).inside(), none;
    dpsm_cube_lookup_footprint Interval
        |i| {
            point(&i[..3], -51, 61)
                && receiver(&i[3..9])
                && within(&i[9..10], 0.0, two(24))
                && light(i, 10).inside()
        },
        none;
    dpsm_cube_direction Absolute
        |i| within(&i[..2], 0.0, 1.0) && within(&i[3..], 0.0, 1.0),
        |i, r, a| absolute(r, a, 6.0, 1.0 + i[3]);
    dpsm_cube_distance Relative
        |i| {
            within(&i[..1], 0.0, 1.0) && (1.0..=3.0).contains(&length(&i[1..4])) && spheres(i[4], i[5])
        },
        |i, r, a| relative(r, a, 10.5 + 4.0 * r[0] / (length(&i[1..4]) * i[4]));
    dpsm_cube_outside Interval
        |i| i[..9].iter().all(|c| *c == 0.0 || (two(-100)..=two(62)).contains(&c.abs())) && within(&i[10..], 0.0, 1.0),
        none;
}
kernel {
    dpsm_kernel_tangent Relative
        |i| point(&i[..3], -51, 62) && within(&i[3..], 0.0, two(10) * length(&i[..3])),
        |_, r, a| relative(r, a, 9.5);
    dpsm_kernel Relative
        |i| point(&i[..3], -51, 50) && within(&i[3..], 0.0, two(10)),
        |_, r, a| relative(&r[..3], &a[..3], 9.5);
    dpsm_kernel_disk Relative
        |i| point(&i[..3], -51, 50) && within(&i[3..], 0.0, two(10)),
        |_, r, a| {
            // k of up to 2^10 comes last
            let each = |k: usize| absolute(&r[k..=k], &a[k..=k], 18.0, r[k].abs().max(two(-93)));
            each(0).or(each(1)).or(each(2))
        };
    dpsm_kernel_tap Absolute
        |i| on_disk(&i[..2]) && within(&i[2..3], 0.0, 1.0) && on_disk(&i[4..]) && i[3] <= 1.0,
        |_, r, a| absolute(&r[..2], &a[..2], 32.0, 1.0);
    dpsm_kernel_mirrored Absolute
        |i| {
            let kernel = DpsmKernel {
                axis: Vec2::new(i[0], i[1]),
                reach: i[2],
                hemisphere: i[3] as u32,
            };
            // r < 2 before it is mirrored
            let tap = || dpsm_kernel_tap(kernel, Vec2::new(i[4], i[5]));
            on_disk(&i[..2])
                && within(&i[2..3], 0.0, 1.0)
                && on_disk(&i[4..])
                && i[3] <= 1.0
                && (tap().hemisphere == kernel.hemisphere || tap().uv.length() > 0.5)
        },
        |_, r, a| absolute(&r[..2], &a[..2], 64.0, 1.0);
    dpsm_kernel_projected Absolute
        |i| point(&i[..3], -51, 50) && within(&i[3..4], 0.0, two(10)) && on_disk(&i[4..]),
        |_, r, a| absolute(&r[..2], &a[..2], 55.0, 1.0);
    dpsm_kernel_ring Relative |i| i[0] < i[1] && i[1] <= two(24), |_, r, a| relative(r, a, 7.5);
    dpsm_kernel_turn Absolute
        |i| length(i) <= 1.0 + 8.0 * EPS, |_, r, a| absolute(r, a, 2.5, 1.0);
    dpsm_kernel_rings Exact any, |_, r, a| exact(r, a);
    dpsm_kernel_next Absolute
        |i| length(i) <= 1.0 + 8.0 * EPS, |_, r, a| absolute(r, a, 2.5, 1.0);
    dpsm_kernel_rotation Absolute any, |_, _, a| absolute(&[1.0], &[length(a)], 152.0, 1.0);
    dpsm_kernel_guard Relative
        |i| within(&i[..1], 3.0 * std::f64::consts::SQRT_2 * i[1], two(24)) && within(&i[1..], 1.0, two(10)),
        |_, r, a| relative(r, a, 10.0);
}
filter {
    dpsm_filter_reader Relative
        |i| receiver(&i[..6]) && light(i, 6).inside() && within(&i[32..], 0.0, 1.0),
        |_, r, a| {
            exact(&r[..7], &a[..7])
                .or(relative(&r[7..16], &a[7..16], 6.0))
                .or(relative(&r[16..], &a[16..], 12.0))
        };
    dpsm_filter_lookup Interval
        |i| receiver(&i[..6]) && on_disk(&i[17..19]) && i[19] <= 1.0 && light(i, 20).inside(), none;
    dpsm_filter_cone Interval
        |i| {
            plane(&i[..11])
                && within(&i[11..12], two(-24), 1.0)
                && within(&i[12..13], 0.0, two(24))
                && length(&i[13..]) <= 1.0 + 8.0 * EPS
        },
        none;
    dpsm_filter_map Interval |i| light(i, 0).inside() && i[24] <= 1.0, none;
    dpsm_filter_places Interval
        |i| disk(&i[..14]) && within(&i[14..19], 0.0, 1.0) && on_disk(&i[19..]), none;
    dpsm_filter_step Absolute
        |i| disk(&i[..14]) && on_disk(&i[14..]),
        |i, r, a| absolute(r, a, 3.0, length(&i[2..4]));
    dpsm_filter_layers Exact |i| light(i, 0).inside() && i[24] <= 1.0, |_, r, a| exact(r, a);
    dpsm_filter_lit Interval
        |i| disk(&i[..14]) && on_disk(&i[14..16]) && within(&i[16..], 0.0, 2.0), none;
    dpsm_filter_within Interval |i| disk(&i[..14]) && within(&i[14..], 0.0, 2.0), none;
    dpsm_filter_share Interval
        |i| i.iter().all(|sum| sum.fract() == 0.0 && (0.0..=two(18)).contains(sum)), none;
    dpsm_filter_even Interval
        |i| disk(&i[..14]) && on_disk(&i[14..16]) && within(&i[16..], 0.0, 1.0), none;
    dpsm_filter_dense Relative |i| within(i, 0.0, 1.0), |_, r, a| relative(r, a, 4.0);
    dpsm_filter_contact Interval
        |i| {
            within(&i[..5], 0.0, two(18))
                && disk(&i[5..19])
                && on_disk(&i[19..21])
                && within(&i[21..], 0.0, 1.0)
        },
        none;
}
pcss {
    dpsm_pcss_tangent Relative
        |i| within(&i[..2], two(-51), two(62)) && within(&i[2..], 0.0, two(62)),
        |i, r, a| {
            // none at contact, where the difference is exact
            let cancelled = if i[0] == i[1] { 0.0 } else { i[0] / (i[0] - i[1]).abs() };
            relative(r, a, 6.5 + cancelled)
        };
    dpsm_pcss_ring Relative |i| within(i, 0.0, 1.0), |_, r, a| relative(r, a, 1.0);
    dpsm_pcss_found Interval
        |i| {
            // found, disk, offset, ring, stored
            within(&i[..4], -1.0, 1.0)
                && within(&i[4..8], 0.0, 1.0)
                && disk(&i[8..22])
                && on_disk(&i[22..24])
                && within(&i[24..], 0.0, 1.0)
        },
        none;
    dpsm_pcss_width Interval
        |i| {
            // found, distance, pitch, radius, light
            within(&i[..4], -1.0, 1.0)
                && within(&i[4..8], 0.0, 1.0)
                && within(&i[8..9], two(-51), two(60))
                && within(&i[9..10], 0.0, 4.0)
                && within(&i[10..11], 0.0, two(60))
                && light(i, 11).inside()
        },
        none;
}
lights {
    dpsm_lights_turn Absolute
        |i| light(i, 3).inside() && largest(&i[..3]) <= two(62),
        |i, r, a| absolute(r, a, 3.0, length(&i[..3]));
}
shade {
    dpsm_shade Absolute
        |i| within(&i[..9], 0.0, two(62)) && within(&i[9..], 0.0, 1.0),
        |i, r, a| {
            let each = |k: usize| absolute(&r[k..=k], &a[k..=k], 3.0, i[k] + i[k + 3] + i[k + 6]);
            each(0).or(each(1)).or(each(2))
        };
    dpsm_blend Absolute
        |i| within(&i[..6], 0.0, two(62)) && within(&i[6..], 0.0, 1.0),
        |i, r, a| {
            let each = |k: usize| absolute(&r[k..=k], &a[k..=k], 3.0, i[k] + i[k + 3]);
            each(0).or(each(1)).or(each(2))
        };
    dpsm_lambert Absolute
        |i| i.chunks(3).all(|v| (length(v) - 1.0).abs() <= 8.0 * EPS),
        |_, r, a| absolute(r, a, 3.0, 1.0);
    dpsm_highlight Absolute
        |i| i.chunks(3).all(|v| (length(v) - 1.0).abs() <= 8.0 * EPS),
        |_, r, a| absolute(r, a, 470.0, 1.0);
    dpsm_spot Absolute
        |i| within(&i[..1], -1.0, 1.0) && within(&i[2..], -4.0, i[1]) && i[1] <= 1.0,
        |_, r, a| absolute(r, a, 10.0, 1.0);
    dpsm_range Absolute
        |i| within(&i[..1], 0.0, two(62)) && within(&i[1..], two(-62), two(127)),
        |_, r, a| absolute(r, a, 14.0, 1.0);
    dpsm_shadow_terminator Absolute
        |i| {
            // p, weights, three times position and normal
            let unit = |v: &[f64]| (length(v) - 1.0).abs() <= 8.0 * EPS;
            let corner = |c: &[f64]| largest(&c[..3]) <= two(60) && unit(&c[3..]);
            let sum: f64 = i[3..6].iter().sum();
            largest(&i[..3]) <= two(60)
                && within(&i[3..6], 0.0, 1.0)
                && (sum - 1.0).abs() <= 8.0 * EPS
                && i[6..].chunks(6).all(corner)
        },
        |i, r, a| {
            let p = &i[..3];
            let away = |c: &[f64]| length(&[p[0] - c[0], p[1] - c[1], p[2] - c[2]]);
            let farthest = i[6..].chunks(6).map(away).fold(0.0, f64::max);
            absolute(r, a, 1.0, length(p) + 9.0 * farthest)
        };
}
}
