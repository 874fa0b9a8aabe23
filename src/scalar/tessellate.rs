//! Port of `wgsl/tessellate.wesl`.

use super::float::{Float, Vec3, select};
use super::light::DpsmLight;
use super::paraboloid::DPSM_SMALLEST;

/// eps: a sagitta of so much of the disk is one rounding of its coordinates.
pub const DPSM_TESSELLATE_FINEST: f64 = 1.0 / (1u64 << 23) as f64;

/// Barycentric numerators, of the sum `level`, of vertex `index` of a triangle cut into level^2.
pub fn dpsm_tessellate_weights(level: u32, index: u32) -> [u32; 3] {
    let cut = level.max(1);
    let cell = [index / 3 / cut, index / 3 % cut];
    if cell[0] >= cut {
        return [cut, 0, 0];
    }
    let corner = index % 3;
    let forth = [cell[0] + select(0, 1, corner == 1), cell[1] + select(0, 1, corner == 2)];
    let back = forth.map(|weight| cut.wrapping_sub(weight));
    let at = select(forth, back, cell[0] + cell[1] >= cut);
    [cut - at[0] - at[1], at[0], at[1]]
}

/// The point of a triangle with these barycentric numerators, of any sum.
pub fn dpsm_tessellate_point<T: Float>(
    a: Vec3<T>,
    b: Vec3<T>,
    c: Vec3<T>,
    weights: [u32; 3],
) -> Vec3<T> {
    let mut w = weights;
    let mut points = [a, b, c];
    // largest weight first: an edge's third corner comes last, with the weight 0
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if w[i] < w[j] {
            w.swap(i, j);
            points.swap(i, j);
        }
    }
    let [p, q, r] = points;
    // equal weights: the order is that of the values themselves
    let middle = w[0] == w[1];
    let low = Vec3::new(p.x.min(q.x), p.y.min(q.y), p.z.min(q.z));
    let high = Vec3::new(p.x.max(q.x), p.y.max(q.y), p.z.max(q.z));
    let first = select(p, low, middle);
    let second = select(q, high, middle);
    let number = |weight: u32| T::lit(f64::from(weight));
    let sum = number(w[0].wrapping_add(w[1]).wrapping_add(w[2]).max(1));
    first + (second - first) * (number(w[1]) / sum) + (r - first) * (number(w[2]) / sum)
}

/// The level, from 1 to most, at which no edge of a mesh bows by more than tau texels.
pub fn dpsm_tessellate_level<T: Float>(
    longest_edge: T,
    distance: T,
    light: DpsmLight<T>,
    tau: T,
    most: u32,
) -> u32 {
    let one = T::lit(1.0);
    let square = (one + light.guard) * (one + light.guard);
    let bow = T::lit(4.0) * tau / (light.size + light.size * square);
    let allowed = bow.max(T::lit(DPSM_TESSELLATE_FINEST)).min(T::lit(0.25) / square);
    let sine_square = allowed * (T::lit(2.0) - square * allowed);
    let half = T::lit(0.5) * longest_edge / distance.max(T::lit(DPSM_SMALLEST));
    let cuts = half * (one / sine_square - one).sqrt();
    T::lit(1.0).max(cuts.ceil().min(T::lit(f64::from(most)))).to_integer()
}
