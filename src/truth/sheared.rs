//! One ray against a triangle and against a box.
//!
//! The triangle test is that of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection"
//! (2013): shear space so that the ray becomes an axis, then decide in the plane across it. Ours
//! takes the signs of the edge functions exactly, by fused multiply-add.

use glam::{DVec3, Vec3Swizzles as _, dvec3};

use super::{Ray, is_usable};

/// A ray, ready for many tests. Along it, lengths are measured on its longest axis ("depth");
/// depth times `stretch` is distance.
pub(super) struct Sheared {
    origin: DVec3,
    /// The ray's longest axis.
    axis: usize,
    /// The direction over the magnitude of its longest component.
    slope: DVec3,
    /// 1 / slope, infinite where the slope is zero.
    inverse: DVec3,
    stretch: f64,
}

impl Sheared {
    /// `None` for a zero direction or numbers that cannot be used.
    pub(super) fn new(ray: &Ray) -> Option<Self> {
        let Ray { origin, direction, .. } = *ray;
        let longest = direction.abs().max_element();
        if !(is_usable(origin) && direction.is_finite() && longest > 0.0) {
            return None;
        }
        let axis = direction.abs().max_position();
        let slope = direction / longest;
        Some(Self { origin, axis, slope, inverse: slope.recip(), stretch: slope.length() })
    }

    /// Moves the longest axis to z; the rotation keeps orientation.
    fn turned(&self, v: DVec3) -> DVec3 {
        [v.yzx(), v.zxy(), v][self.axis]
    }

    /// Distance and weights of the ray's line through a triangle, edges and corners included.
    pub(super) fn meet(&self, corners: [DVec3; 3]) -> Option<(f64, [f64; 3])> {
        let slope = self.turned(self.slope);
        let [a, b, c] = corners.map(|corner| {
            let v = self.turned(corner - self.origin);
            let depth = v.z * slope.z;
            dvec3((-slope.x).mul_add(depth, v.x), (-slope.y).mul_add(depth, v.y), depth)
        });
        // Zero counts as inside, so that a ray through a shared edge meets both triangles.
        let edges = [cross(b, c), cross(c, a), cross(a, b)];
        let inside = edges.iter().all(|&edge| edge >= 0.0) || edges.iter().all(|&edge| edge <= 0.0);
        let sum = edges[0] + edges[1] + edges[2];
        // A sum of zero is a triangle seen edge-on.
        (inside && sum != 0.0).then(|| {
            let weights = edges.map(|edge| edge / sum);
            let depth = weights[0] * a.z + weights[1] * b.z + weights[2] * c.z;
            (depth * self.stretch, weights)
        })
    }

    /// The depths between two distances, widened by more than their rounding.
    pub(super) fn depths(&self, near: f64, far: f64) -> [f64; 2] {
        const SLACK: f64 = 4.0 * f64::EPSILON;
        let [low, high] = [near, far].map(|distance| distance / self.stretch);
        [low - low.abs() * SLACK, high + high.abs() * SLACK]
    }

    /// What a box must grow by so that no hit of `meet` lies outside (docs/truth.md, "Boxes");
    /// `min` and `max` bound all triangles.
    pub(super) fn padding(&self, min: DVec3, max: DVec3) -> f64 {
        let reach = (min - self.origin).abs().max((max - self.origin).abs()).max_element();
        32.0 * f64::EPSILON * reach
    }

    /// The least depth inside the box grown by `padding`, if it has a depth in the range.
    pub(super) fn enter(
        &self,
        [min, max]: [DVec3; 2],
        padding: f64,
        [low, high]: [f64; 2],
    ) -> Option<f64> {
        let from = (min - self.origin - padding) * self.inverse;
        let to = (max - self.origin + padding) * self.inverse;
        // Chosen by the slope's sign: of 0 x infinity, a ray within a padded face, comes a NaN,
        // and f64::max and min pass over it.
        let mask = self.inverse.cmpge(DVec3::ZERO);
        let (near, far) = (DVec3::select(mask, from, to), DVec3::select(mask, to, from));
        let low = low.max(near.x).max(near.y).max(near.z);
        let high = high.min(far.x).min(far.y).min(far.z);
        (low <= high).then_some(low)
    }
}

/// p.x q.y - p.y q.x with a relative error of 2^-52 at most, so with the exact sign (Kahan's
/// algorithm; Jeannerod, Louvet and Muller 2013).
fn cross(p: DVec3, q: DVec3) -> f64 {
    let product = p.y * q.x;
    let lost = (-p.y).mul_add(q.x, product);
    p.x.mul_add(q.y, -product) + lost
}
