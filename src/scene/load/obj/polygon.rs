//! Polygons cut into triangles.

use earcut::{Earcut, deviation, utils3d::project3d_to_2d};
use glam::DVec3;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation as Delaunay, Point2, Triangulation};

/// Of the areas, relative. Polygons that cross themselves are far beyond it.
const MAX_DEVIATION: f64 = 1e-6;

/// From so many corners on ears take longer to find than a Delaunay triangulation takes: for saws,
/// their time is as the square of the corners.
const MANY: usize = 1000;

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
    let mut flat = Vec::new();
    if !project3d_to_2d(&points, corners, &mut flat) {
        return (fan(), false);
    }
    let covers = |cut: &[[usize; 3]]| {
        deviation(flat.iter().copied(), &[] as &[usize], cut.as_flattened()) <= MAX_DEVIATION
    };
    if corners >= MANY
        && let Some(cut) = delaunay(&flat).filter(|cut| covers(cut))
    {
        return (cut, true);
    }
    let mut cut = Vec::new();
    Earcut::new().earcut_slice(&flat, &[], &mut cut);
    let cut = cut.as_chunks().0.to_vec();
    if covers(&cut) { (cut, true) } else { (fan(), false) }
}

/// The triangles of a Delaunay triangulation with the polygon's edges in it that lie inside; `None`
/// for a polygon that crosses or touches itself. Its corners turn left, as the projection along
/// their own normal leaves them: inside is to the left of every edge.
fn delaunay(polygon: &[[f64; 2]]) -> Option<Vec<[usize; 3]>> {
    let corners = polygon.len();
    let points = polygon.iter().map(|&[x, y]| Point2::new(x, y)).collect();
    let edges = (0..corners).map(|i| [i, (i + 1) % corners]).collect();
    let mut conflicts = 0;
    let whole = Delaunay::<Point2<f64>>::try_bulk_load_cdt(points, edges, |_| conflicts += 1);
    let whole = whole.ok().filter(|whole| whole.num_vertices() == corners && conflicts == 0)?;
    // inside is what lies beside an edge, and what lies beside that without an edge between
    let mut inside = vec![false; whole.num_all_faces()];
    let mut stack = Vec::new();
    for i in 0..corners {
        let [from, to] = [i, (i + 1) % corners].map(FixedVertexHandle::from_index);
        stack.push(whole.get_edge_from_neighbors(from, to)?.fix());
    }
    while let Some(edge) = stack.pop() {
        let edge = whole.directed_edge(edge);
        let face = edge.face().as_inner()?.fix();
        if std::mem::replace(&mut inside[face.index()], true) {
            continue;
        }
        for side in [edge.next(), edge.prev()] {
            if !side.is_constraint_edge() {
                stack.push(side.rev().fix());
            }
        }
    }
    let faces = whole.inner_faces().filter(|face| inside[face.fix().index()]);
    let cut = faces.map(|face| face.vertices().map(|vertex| vertex.index()));
    let cut: Vec<_> = cut.collect();
    (cut.len() == corners - 2).then_some(cut)
}
