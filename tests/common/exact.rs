//! Triangles around the light, and what of the sphere they cover, by ray and plane in f64.

use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::paraboloid::dpsm_project;
use fastrand::Rng;

use super::{EPS, angle, nearby, point, spread, unit};

/// A triangle of vertices in f64.
pub type Corners = [Vec3<f64>; 3];

/// A random triangle: small, middle-sized, huge, a needle, around the light, or anywhere.
pub fn triangle(rng: &mut Rng) -> [Vec3<f32>; 3] {
    let a = unit(rng) * spread(rng, -2, 3);
    let b = nearby(rng, a, -10, 0);
    let (s, t) = (rng.f32(), rng.f32());
    match rng.u8(0..6) {
        0 => [a, nearby(rng, a, -12, -6), nearby(rng, a, -12, -6)],
        1 => [a, nearby(rng, a, -5, 0), nearby(rng, a, -5, 0)],
        2 => [0; 3].map(|_| Vec3::new(rng.f32(), rng.f32(), rng.f32()) * 20.0 - Vec3::splat(10.0)),
        3 => [a, b, nearby(rng, a + (b - a) * s, -16, -8)],
        4 => [a, b, nearby(rng, -(a * s + b * t), -8, -1)],
        _ => [0; 3].map(|_| point(rng, -6, 6)),
    }
}

/// A point of a triangle's plane, inside or somewhat outside.
pub fn about(rng: &mut Rng, [a, b, c]: Corners) -> Vec3<f64> {
    let (u, v) = (1.4 * rng.f64() - 0.2, 1.4 * rng.f64() - 0.2);
    a + (b - a) * u + (c - a) * v
}

/// A point of a triangle.
pub fn inside(rng: &mut Rng, [a, b, c]: Corners) -> Vec3<f64> {
    let (u, v) = (rng.f64(), rng.f64());
    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
    a + (b - a) * u + (c - a) * v
}

/// 2u, 2v, 1 - r^2 over 1 + r^2.
pub fn direction(uv: Vec2<f64>) -> Vec3<f64> {
    let square = uv.dot(uv);
    Vec3::new(2.0 * uv.x, 2.0 * uv.y, 1.0 - square) / (1.0 + square)
}

/// How far rounding may move an edge's arc, in radians (docs/edge.md).
pub fn arc_bound(a: Vec3<f64>, b: Vec3<f64>) -> f64 {
    let half = 0.5 * angle(a, b);
    (4.5 / half.cos().max(1e-9) + 5.0) * EPS
}

/// What a direction meets.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    /// Least angle in radians inside an edge's plane, less than 0 outside.
    pub inside: f64,
    /// How far rounding may move that edge, and any of the three.
    pub band: f64,
    /// Distance of the plane along the direction; negative behind.
    pub distance: f64,
    /// Cosine of the angle of incidence.
    pub cosine: f64,
}

/// Where a direction is in a triangle; `None` where the triangle has no area or its height is so
/// small a share of its size that rounding may turn it.
pub fn meet([a, b, c]: Corners, d: Vec3<f64>) -> Option<Meeting> {
    let edges = [(a, b), (b, c), (c, a)];
    let normal = (b - a).cross(c - a);
    let height = normal.dot(a) / normal.length();
    let farthest = edges.iter().map(|(v, _)| v.length()).fold(0.0, f64::max);
    let lengths = edges.map(|(v, w)| (w - v).length());
    let longest = lengths.into_iter().fold(0.0, f64::max);
    // the sine of the angle between the shorter two
    let sine = normal.length() * longest / (lengths[0] * lengths[1] * lengths[2]);
    let clear = height.abs() > 24.0 * EPS * farthest / sine;
    if !clear {
        return None;
    }
    let turn = height.signum();
    let mut inside = f64::INFINITY;
    for (v, w) in edges {
        let plane = v.cross(w - v);
        inside = inside.min(turn * plane.dot(d) / plane.length());
    }
    let band = edges.iter().map(|&(v, w)| arc_bound(v, w)).fold(0.0, f64::max);
    let unit = normal / normal.length();
    Some(Meeting { inside, band, distance: height / unit.dot(d), cosine: unit.dot(d).abs() })
}

/// Points of the great circle arc between two directions, on the disk.
pub fn arc(a: Vec3<f64>, b: Vec3<f64>, steps: u32) -> impl Iterator<Item = Vec2<f64>> {
    let (a, b) = (a / a.length(), b / b.length());
    let angle = angle(a, b);
    (0..=steps).map(move |i| {
        let share = f64::from(i) / f64::from(steps);
        dpsm_project(a * ((1.0 - share) * angle).sin() + b * (share * angle).sin())
    })
}

/// Signed distance from the line through two points, positive on its right.
pub fn right_of(from: Vec2<f64>, to: Vec2<f64>, p: Vec2<f64>) -> f64 {
    let (along, at) = (to - from, p - from);
    (along.y * at.x - along.x * at.y) / along.length()
}
