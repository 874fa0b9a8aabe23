//! Polygons into triangles.

use glam::DVec3;

/// Cuts a flat simple polygon into triangles of the same winding (corner numbers) by clipping
/// ears: triangles of three consecutive corners that stick out and hold no other corner.
/// The flag is false for a polygon without ears (it crosses itself), which gets a fan.
pub(super) fn triangulate(points: &[DVec3]) -> (Vec<[usize; 3]>, bool) {
    /// Squared area, of the polygon's: coordinates rounded to f32 bend a straight line this much.
    const FLAT: f64 = 1e-12;
    let doubled_area = |[a, b, c]: [usize; 3]| {
        let [a, b, c] = [points[a], points[b], points[c]];
        (b - a).cross(c - a)
    };
    let corners = points.len();
    let fan: Vec<[usize; 3]> = (2..corners).map(|i| [0, i - 1, i]).collect();
    let normal: DVec3 = fan.iter().copied().map(doubled_area).sum();
    let turns_left = |triangle: [usize; 3]| doubled_area(triangle).dot(normal) > 0.0;
    // Most polygons are convex, and a fan from the first corner covers them.
    if fan.iter().all(|&triangle| turns_left(triangle)) {
        return (fan, true);
    }

    let inside = |p: usize, [a, b, c]: [usize; 3]| {
        // A polygon may touch itself: a corner at the same place is not inside.
        let apart = [a, b, c].into_iter().all(|i| points[i] != points[p]);
        apart
            && [[a, b, p], [b, c, p], [c, a, p]].into_iter().all(|t| {
                // On the edge counts as inside: clipping there would leave an overlap.
                doubled_area(t).dot(normal) >= 0.0
            })
    };
    let mut rest: Vec<usize> = (0..corners).collect();
    let mut triangles = Vec::with_capacity(corners.saturating_sub(2));
    while rest.len() > 3 {
        let around = |i: usize| [0, 1, 2].map(|k| rest[(i + k) % rest.len()]);
        let ear = (0..rest.len()).find(|&i| {
            let triangle = around(i);
            turns_left(triangle) && !rest.iter().any(|&p| inside(p, triangle))
        });
        // What sticks out nowhere has corners on a straight line left, to be cut off.
        let flat = || {
            let most = FLAT * normal.length_squared();
            (0..rest.len()).find(|&i| doubled_area(around(i)).length_squared() <= most)
        };
        let Some(i) = ear.or_else(flat) else {
            return (fan, false);
        };
        triangles.push(around(i));
        rest.remove((i + 1) % rest.len());
    }
    triangles.extend(<[usize; 3]>::try_from(rest));
    (triangles, true)
}
