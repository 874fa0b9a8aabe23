//! How near triangles come to a point.

use glam::DVec3;

/// Distance of a triangle's nearest point from the origin: the foot of the plane's normal where it
/// lies inside, else the nearest point of an edge.
pub(crate) fn nearest_of([a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = |p: DVec3, q: DVec3| p.cross(q).dot(normal);
    let sides = [inside(a, b), inside(b, c), inside(c, a)];
    if sides.iter().all(|&side| side > 0.0) {
        return normal.dot(a).abs() / normal.length();
    }
    let of_edge = |p: DVec3, q: DVec3| {
        let along = q - p;
        let t = (-p.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        (p + along * if t.is_nan() { 0.0 } else { t }).length()
    };
    of_edge(a, b).min(of_edge(b, c)).min(of_edge(c, a))
}
