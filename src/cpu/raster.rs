//! A small rasterizer with WebGPU's rules: pixel centres, top-left fill rule, depth linear in the
//! image, attributes perspective-correct, triangles clipped where w < the smallest w.

use crate::scalar::float::Vec4;

/// One covered pixel.
#[derive(Clone, Copy, Debug)]
pub struct Fragment {
    /// Column.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// Weights of the triangle's vertices.
    pub weights: [f32; 3],
    /// z / w.
    pub depth: f32,
}

/// A corner after clipping: clip-space position and weights of the original vertices.
#[derive(Clone, Copy)]
struct Corner {
    clip: [f64; 4],
    weights: [f64; 3],
}

/// Calls `emit` for each pixel of a `width` x `height` image that a triangle covers.
///
/// clip: clip-space vertices; nothing is drawn where w < `smallest_w` (> 0), and a triangle with a
/// coordinate that is not finite is not drawn.
pub fn triangle(
    clip: [Vec4<f32>; 3],
    [width, height]: [u32; 2],
    smallest_w: f32,
    emit: &mut impl FnMut(Fragment),
) {
    let mut corners = Vec::with_capacity(4);
    for (i, v) in clip.iter().enumerate() {
        let clip = [v.x, v.y, v.z, v.w].map(f64::from);
        if clip.iter().any(|c| !c.is_finite()) {
            return;
        }
        let mut weights = [0.0; 3];
        weights[i] = 1.0;
        corners.push(Corner { clip, weights });
    }
    let polygon = clip_w(&corners, f64::from(smallest_w));
    for i in 1..polygon.len().saturating_sub(1) {
        fill([polygon[0], polygon[i], polygon[i + 1]], width, height, emit);
    }
}

/// Sutherland and Hodgman's clip against w >= smallest.
fn clip_w(corners: &[Corner], smallest: f64) -> Vec<Corner> {
    let mut kept = Vec::with_capacity(4);
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (da, db) = (a.clip[3] - smallest, b.clip[3] - smallest);
        if da >= 0.0 {
            kept.push(a);
        }
        if (da >= 0.0) != (db >= 0.0) {
            let t = da / (da - db);
            let mix = |a: f64, b: f64| a + (b - a) * t;
            kept.push(Corner {
                clip: std::array::from_fn(|k| mix(a.clip[k], b.clip[k])),
                weights: std::array::from_fn(|k| mix(a.weights[k], b.weights[k])),
            });
        }
    }
    kept
}

fn fill(mut corners: [Corner; 3], width: u32, height: u32, emit: &mut impl FnMut(Fragment)) {
    let place = |c: Corner| {
        let [x, y, _, w] = c.clip;
        let (width, height) = (f64::from(width), f64::from(height));
        [(x / w * 0.5 + 0.5) * width, (0.5 - y / w * 0.5) * height]
    };
    // positive on the left of a -> b in an image whose y points down
    let edge = |a: [f64; 2], b: [f64; 2], p: [f64; 2]| {
        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
    };
    let mut at = corners.map(place);
    let mut area = edge(at[0], at[1], at[2]);
    if area < 0.0 {
        corners.swap(1, 2);
        at.swap(1, 2);
        area = -area;
    }
    if area == 0.0 || !area.is_finite() {
        return;
    }
    let bounds = |axis: usize, limit: u32| {
        let coordinates = at.map(|p| p[axis]);
        let low = coordinates.into_iter().fold(f64::INFINITY, f64::min);
        let high = coordinates.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let clamp = |c: f64| c.clamp(0.0, f64::from(limit)) as u32;
        clamp((low - 0.5).ceil())..clamp((high + 0.5).floor())
    };
    let top_left = |a: [f64; 2], b: [f64; 2]| b[1] < a[1] || (b[1] == a[1] && b[0] > a[0]);
    let rules = [top_left(at[1], at[2]), top_left(at[2], at[0]), top_left(at[0], at[1])];
    for y in bounds(1, height) {
        for x in bounds(0, width) {
            let p = [f64::from(x) + 0.5, f64::from(y) + 0.5];
            let edges = [edge(at[1], at[2], p), edge(at[2], at[0], p), edge(at[0], at[1], p)];
            let covers = |(&e, &rule): (&f64, &bool)| e > 0.0 || (e == 0.0 && rule);
            if !edges.iter().zip(&rules).all(covers) {
                continue;
            }
            let linear = edges.map(|e| e / area);
            let sum = |value: &dyn Fn(&Corner) -> f64| -> f64 {
                linear.iter().zip(&corners).map(|(k, c)| k * value(c)).sum()
            };
            let depth = sum(&|c| c.clip[2] / c.clip[3]) as f32;
            let inverse_w = sum(&|c| 1.0 / c.clip[3]);
            let weight = |i: usize| (sum(&|c| c.weights[i] / c.clip[3]) / inverse_w) as f32;
            emit(Fragment { x, y, weights: std::array::from_fn(weight), depth });
        }
    }
}
