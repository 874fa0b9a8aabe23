//! Where the error comes from: one source at a time, measured beside the predicted bound.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

use super::{Bench, PenumbraError, Point};
use crate::render::{Bias, Format, Method, Projection};
use crate::scalar::float::{Vec2, Vec3};
use crate::scalar::hemisphere::dpsm_flip;
use crate::scalar::light::DpsmLight;
use crate::scalar::paraboloid::{dpsm_disk_to_texture, dpsm_project, dpsm_texture_to_disk};

/// One source of error, all others turned off.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Source {
    /// The source.
    pub name: &'static str,
    /// Largest error measured.
    pub measured: f64,
    /// The bound, or the formula's prediction, at that place; `None` where there is none.
    pub predicted: Option<f64>,
    /// Unit of both.
    pub unit: &'static str,
    /// Where: a mesh, or a point.
    pub place: String,
}

/// Points along an arc or a side of a triangle at which errors are looked for.
const STEPS: u32 = 32;

/// Every source of the frame's method; the filter's is the penumbra error measured before. Bowed
/// edges and affine depth are sources of the methods that draw a mesh's triangles with straight
/// edges on a disk, `vertex` and `fragment-depth`, alone.
pub fn attribute(bench: &Bench<'_>, points: &[Point], penumbra: &PenumbraError) -> Vec<Source> {
    let all = 0..bench.frame.triangles.len() as u32;
    let mut sources = vec![
        arithmetic(bench, points),
        storage(bench, points, bench.frame.settings.format),
        resolution(bench, points),
    ];
    if draws_straight(bench.frame.settings.method) {
        sources.extend([bowed_edges(bench, all.clone()), affine_depth(bench, all)]);
    }
    sources.push(bias(bench, points));
    sources.push(Source {
        name: "filter",
        measured: penumbra.penumbra_rmse,
        predicted: None,
        unit: "RMSE of the visibility in the penumbra",
        place: String::new(),
    });
    sources
}

/// True of the methods that draw a mesh's own triangles with straight edges on a disk.
pub fn draws_straight(method: Method) -> bool {
    matches!(method, Method::Vertex | Method::FragmentDepth)
}

/// The source with the largest measured value.
fn largest(sources: impl ParallelIterator<Item = Source>, empty: Source) -> Source {
    sources.reduce(|| empty.clone(), |a, b| if b.measured > a.measured { b } else { a })
}

/// f32 arithmetic: a receiver's own depth by the f32 port against f64, in world units.
fn arithmetic(bench: &Bench<'_>, points: &[Point]) -> Source {
    let DpsmLight { near, far, .. } = bench.light;
    let source = |measured, predicted, place| Source {
        name: "f32 arithmetic",
        measured,
        predicted: Some(predicted),
        unit: "world units of distance",
        place,
    };
    let at = |point: &Point| {
        let p = bench.to_light(point.world).narrow();
        let exact = bench.projection.lookup(p.widen(), bench.light).depth;
        let depth = bench.projection.lookup(p, bench.frame.light).depth;
        let (_, uv) = bench.projection.place(p.widen());
        // docs/visibility.md, docs/cube.md
        let bound = match bench.projection {
            Projection::Paraboloid => 10.5 * p.widen().length() + 4.5 * near,
            Projection::Cube => 10.5 * far,
        };
        let bound = f64::from(f32::EPSILON) * bound / (far - near);
        let measured = bench.distance(depth.into(), uv) - bench.distance(exact, uv);
        source(
            measured.abs(),
            bench.spread(exact, bound, uv),
            format!("{}", point.world + bench.frame.origin),
        )
    };
    largest(points.par_iter().map(at), source(0.0, 0.0, String::new()))
}

/// Storage: what the format makes of exact depths, in world units; the bound is one quantum.
fn storage(bench: &Bench<'_>, points: &[Point], format: Format) -> Source {
    // a depth is rounded to f32 before it is stored: half an eps of at most 1
    let off = f64::from(format.quantum()) + 0.5 * f64::from(f32::EPSILON);
    let source = |measured, predicted, place| Source {
        name: "storage format",
        measured,
        predicted: Some(predicted),
        unit: "world units of distance",
        place,
    };
    let at = |point: &Point| {
        let (map, uv) = bench.place(point);
        let exact = bench.projection.depth(bench.to_light(point.world), map, bench.light);
        let stored = format.store(exact as f32);
        let measured = bench.distance(stored.into(), uv) - bench.distance(exact, uv);
        source(
            measured.abs(),
            bench.spread(exact, off, uv),
            format!("{}", point.world + bench.frame.origin),
        )
    };
    largest(points.par_iter().map(at), source(0.0, 0.0, String::new()))
}

/// Resolution: the truth along the texel's centre in place of the point's own, everything else
/// exact. How far a point that this decides wrongly can be from the true edge, in texels: half a
/// texel's diagonal.
fn resolution(bench: &Bench<'_>, points: &[Point]) -> Source {
    let source = |measured, place| Source {
        name: "resolution",
        measured,
        predicted: Some(std::f64::consts::FRAC_1_SQRT_2),
        unit: "texels from the true edge",
        place,
    };
    let at = |point: &Point| {
        let (hemisphere, uv) = bench.place(point);
        let size = bench.light.size;
        let st = dpsm_disk_to_texture(uv, bench.light.guard) * size;
        let centre = Vec2::new(st.x.floor() + 0.5, st.y.floor() + 0.5);
        let centre_uv = dpsm_texture_to_disk(centre / size, bench.light.guard);
        let sees = bench.sees(point);
        if bench.reaches(point, centre_uv, hemisphere).is_none_or(|reaches| reaches == sees) {
            return source(0.0, String::new());
        }
        // the edge lies between the point and the centre: find it there
        let (mut same, mut other) = (0.0, 1.0);
        for _ in 0..STEPS {
            let middle = 0.5 * (same + other);
            let on_way = uv + (centre_uv - uv) * middle;
            match bench.reaches(point, on_way, hemisphere) {
                Some(reaches) if reaches != sees => other = middle,
                _ => same = middle,
            }
        }
        let texels = (centre_uv - uv).length() * other / bench.texel();
        source(texels, format!("{}", point.world + bench.frame.origin))
    };
    largest(points.par_iter().map(at), source(0.0, String::new()))
}

/// Bias: with exact distances, a point less than the bias behind its occluder is lit. The largest
/// such distance, the contact gap; it cannot exceed the bias. Both along the direction that is
/// compared: the point's own, or the centre of its texel, where the point's plane takes its place.
fn bias(bench: &Bench<'_>, points: &[Point]) -> Source {
    let source = |measured, predicted, place| Source {
        name: "bias",
        measured,
        predicted: Some(predicted),
        unit: "world units of contact gap",
        place,
    };
    let at = |point: &Point| {
        let (p, normal) = bench.receiver(point);
        let at = bench.frame.lookup(p, normal);
        let (map, own) = bench.place(point);
        let (compared, uv) = match (bench.frame.settings.bias_taken(), point.normal) {
            (Bias::TexelCentre, Some(normal)) => {
                let centre = dpsm_texture_to_disk(at.coordinates.widen(), bench.light.guard);
                let direction = bench.direction(centre, map).normalize();
                let to_point = point.world - bench.origin;
                let distance = normal.dot(to_point) / normal.dot(direction);
                if !(distance.is_finite() && distance > 0.0) {
                    return source(0.0, 0.0, String::new());
                }
                (Point { world: bench.origin + direction * distance, ..*point }, centre)
            }
            _ => (*point, own),
        };
        let distance = (compared.world - bench.origin).length();
        let bias = distance - bench.distance(f64::from(at.depth), uv);
        let gap = bench.occluder(&compared).map(|hit| distance - hit.distance);
        let gap = gap.filter(|gap| *gap <= bias);
        source(gap.unwrap_or(0.0), bias, format!("{}", point.world + bench.frame.origin))
    };
    largest(points.par_iter().map(at), source(0.0, 0.0, String::new()))
}

/// Bowed edges: how far the straight edges of triangles are from the arcs that they stand for, in
/// texels. Predicted: the sagitta c^2 |m_z| N / 16 of a chord c whose plane through the light has
/// the unit normal m, divided by 1 + guard.
///
/// Edges with both ends in the stored disk of a hemisphere. What straight edges would do to the
/// meshes, whatever the method; a cube's map has no disk.
pub fn bowed_edges(bench: &Bench<'_>, triangles: Range<u32>) -> Source {
    let source = |measured, predicted, place| Source {
        name: "bowed edges",
        measured,
        predicted: Some(predicted),
        unit: "texels",
        place,
    };
    let scale = 0.5 * bench.light.size / (1.0 + bench.light.guard);
    let of_edge = |hemisphere: u32, a: Vec3<f64>, b: Vec3<f64>, triangle: u32| {
        let (start, end) = (dpsm_project(a), dpsm_project(b));
        let chord = (end - start).length();
        let outside = start.length().max(end.length()) > 1.0 + bench.light.guard;
        let normal = cross(a, b);
        if outside || chord == 0.0 || normal.length() == 0.0 || hemisphere >= bench.maps.layers {
            return source(0.0, 0.0, String::new());
        }
        let along = (end - start) / chord;
        let bow = (0..=STEPS)
            .map(|k| {
                let t = f64::from(k) / f64::from(STEPS);
                let on_arc = dpsm_project(a / a.length() * (1.0 - t) + b / b.length() * t);
                let off = on_arc - start;
                (off.x * along.y - off.y * along.x).abs()
            })
            .fold(0.0, f64::max);
        let lean = (normal.z / normal.length()).abs();
        source(bow * scale, chord * chord * lean / 8.0 * scale, place(bench, triangle))
    };
    let of_triangle = |triangle: u32| {
        let corners = bench.corners(triangle).map(|corner| bench.to_light(corner));
        let edges = [(0, 1), (1, 2), (2, 0)];
        let both = (0..2).flat_map(|h| edges.map(|(i, j)| (h, corners[i], corners[j])));
        both.map(|(h, a, b)| of_edge(h, dpsm_flip(a, h), dpsm_flip(b, h), triangle))
            .max_by(|a, b| a.measured.total_cmp(&b.measured))
            .unwrap_or_else(|| source(0.0, 0.0, String::new()))
    };
    largest(triangles.into_par_iter().map(of_triangle), source(0.0, 0.0, String::new()))
}

/// Affine interpolation: how far the distance that is stored over a triangle's image is from that
/// of the triangle there, as a share of it; the distance of the interpolated position for the
/// fragment-depth method, the interpolated distance, as the vertex method stores it, for all
/// others. Predicted, for the former:
/// phi^2 / 6 ((1 + sin^2 a) / cos^2 a + r tan a), for the triangle's angular size phi, and the
/// steepest incidence a and largest r of its corners (docs/measure.md).
///
/// Triangles with all corners in the stored disk of a hemisphere.
pub fn affine_depth(bench: &Bench<'_>, triangles: Range<u32>) -> Source {
    let method = bench.frame.settings.method;
    let source = |measured, predicted, place| Source {
        name: match method {
            Method::FragmentDepth => "affine position",
            _ => "affine depth",
        },
        measured,
        predicted: (method != Method::FragmentDepth).then_some(predicted),
        unit: "of the distance",
        place,
    };
    let of_hemisphere = |triangle: u32, hemisphere: u32| {
        let corners = bench.corners(triangle).map(|c| dpsm_flip(bench.to_light(c), hemisphere));
        let disk = corners.map(dpsm_project);
        let [a, b, c] = corners;
        let normal = cross(b - a, c - a);
        let cosines = corners.map(|p| (normal.dot(p) / (normal.length() * p.length())).abs());
        let steepest = cosines.into_iter().fold(1.0, f64::min);
        let unseen = !is_inside(bench, corners, hemisphere) || steepest.is_nan() || steepest == 0.0;
        if unseen {
            return source(0.0, 0.0, String::new());
        }
        let mut worst: f64 = 0.0;
        for i in 0..=STEPS {
            for j in 0..=STEPS - i {
                let weights = [i, j, STEPS - i - j].map(|k| f64::from(k) / f64::from(STEPS));
                // a point of the triangle, and the weights of its place in the straight image
                let p = a * weights[0] + b * weights[1] + c * weights[2];
                let Some([s, t, u]) = image_weights(disk, dpsm_project(p)) else { continue };
                let affine = match method {
                    Method::FragmentDepth => (a * s + b * t + c * u).length(),
                    _ => s * a.length() + t * b.length() + u * c.length(),
                };
                worst = worst.max((affine - p.length()).abs() / p.length());
            }
        }
        let angle = |p: Vec3<f64>, q: Vec3<f64>| cross(p, q).length().atan2(p.dot(q));
        let phi = angle(a, b).max(angle(b, c)).max(angle(c, a));
        let square = steepest * steepest;
        let tangent = ((1.0 - square) / square).sqrt();
        let r = disk.map(|uv| uv.length()).into_iter().fold(0.0, f64::max);
        let predicted = phi * phi / 6.0 * ((2.0 - square) / square + r * tangent);
        source(worst, predicted, place(bench, triangle))
    };
    let of_triangle = |triangle: u32| {
        let [front, back] = [0, 1].map(|hemisphere| of_hemisphere(triangle, hemisphere));
        if back.measured > front.measured { back } else { front }
    };
    largest(triangles.into_par_iter().map(of_triangle), source(0.0, 0.0, String::new()))
}

/// Triangles that lie in no map's stored disk with all corners: they cross its border, or belong to
/// the hemisphere that has no map. Bowed edges and affine depth leave them out.
pub fn left_out(bench: &Bench<'_>, triangles: Range<u32>) -> usize {
    let crosses = |triangle: &u32| {
        (0..2).all(|hemisphere| {
            let corners =
                bench.corners(*triangle).map(|c| dpsm_flip(bench.to_light(c), hemisphere));
            !is_inside(bench, corners, hemisphere)
        })
    };
    triangles.into_par_iter().filter(crosses).count()
}

/// True where all corners of a triangle lie in a map's stored disk.
fn is_inside(bench: &Bench<'_>, corners: [Vec3<f64>; 3], hemisphere: u32) -> bool {
    let border = 1.0 + bench.light.guard;
    hemisphere < bench.maps.layers && corners.iter().all(|p| dpsm_project(*p).length() <= border)
}

/// Barycentric weights of a place in a triangle on the disk; `None` outside it.
fn image_weights(disk: [Vec2<f64>; 3], at: Vec2<f64>) -> Option<[f64; 3]> {
    let doubled = |a: Vec2<f64>, b: Vec2<f64>, c: Vec2<f64>| {
        let (ab, ac) = (b - a, c - a);
        ab.x * ac.y - ab.y * ac.x
    };
    let [a, b, c] = disk;
    let area = doubled(a, b, c);
    let weights = [doubled(at, b, c), doubled(a, at, c), doubled(a, b, at)].map(|k| k / area);
    weights.iter().all(|weight| *weight >= 0.0).then_some(weights)
}

fn place(bench: &Bench<'_>, triangle: u32) -> String {
    let [a, b, c] = bench.corners(triangle);
    let middle: DVec3 = (a + b + c) / 3.0 + bench.frame.origin;
    let holds = |(_, triangles): &&(String, Range<u32>)| triangles.contains(&triangle);
    let mesh = bench.frame.meshes.iter().find(holds).map_or("", |(name, _)| name);
    format!("mesh `{mesh}` around {middle:.3}")
}

fn cross(a: Vec3<f64>, b: Vec3<f64>) -> Vec3<f64> {
    Vec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}
