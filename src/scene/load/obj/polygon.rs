//! Polygons cut into triangles.

use earcut::{Earcut, deviation, utils3d::project3d_to_2d};
use glam::DVec3;

/// Of the areas, relative. Polygons that cross themselves are far beyond it.
const MAX_DEVIATION: f64 = 1e-6;

/// Corner numbers of triangles that wind like the polygon, and whether they cover it once.
pub(super) fn triangulate(polygon: &[DVec3]) -> (Vec<[usize; 3]>, bool) {
    let corners = polygon.len();
    let fan = || (2..corners).map(|i| [0, i - 1, i]).collect();
    // What is not finite will be dropped: any cut will do.
    if corners == 3 || !polygon.iter().all(|point| point.is_finite()) {
        return (fan(), true);
    }
    // from a corner of its own, as it may be far from the file's origin
    let points: Vec<[f64; 3]> = polygon.iter().map(|p| (p - polygon[0]).to_array()).collect();
    let (mut flat, mut cut) = (Vec::new(), Vec::new());
    if !project3d_to_2d(&points, corners, &mut flat) {
        return (fan(), false);
    }
    Earcut::new().earcut_slice(&flat, &[], &mut cut);
    if deviation(flat, &[], &cut) > MAX_DEVIATION {
        return (fan(), false);
    }
    (cut.as_chunks().0.to_vec(), true)
}
