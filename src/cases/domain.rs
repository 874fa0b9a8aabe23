//! The functions' domains, as their WGSL headers state them, for the hard cases.

/// What is promised of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Promise {
    /// Outside the domain: anything may come out, also no number.
    Outside,
    /// Outside the domain, but what comes out is finite and within the function's range.
    Finite,
    /// Inside the domain: finite, within the function's range, and within its bound.
    Inside,
}

pub use Promise::{Finite, Inside, Outside};

/// 2 to the power of this.
fn power(exponent: i32) -> f64 {
    f64::from(exponent).exp2()
}

/// Inside where the condition holds.
pub fn when(condition: bool) -> Promise {
    if condition { Inside } else { Outside }
}

/// Every value of a table.
pub fn all<V>(_: V) -> Promise {
    Inside
}

/// Components that are no NaN; infinity is a number here.
pub fn numbers<const N: usize>(v: [f32; N]) -> Promise {
    when(v.iter().all(|c| !c.is_nan()))
}

/// Numbers other than infinity.
pub fn finite<const N: usize>(v: [f32; N]) -> Promise {
    when(v.iter().all(|c| c.is_finite()))
}

/// Vectors up to 2^high long.
pub fn up_to<const N: usize>(high: i32, v: [f32; N]) -> Promise {
    let square: f64 = v.iter().map(|&c| f64::from(c) * f64::from(c)).sum();
    when(square.sqrt() <= power(high))
}

/// Largest |component| in [2^low, 2^high], or 0; smaller ones are finite.
pub fn sized<const N: usize>(low: i32, high: i32, v: [f32; N]) -> Promise {
    let largest = v.iter().map(|&c| f64::from(c).abs()).fold(0.0, f64::max);
    match largest {
        _ if numbers(v) == Outside || largest > power(high) => Outside,
        _ if largest > 0.0 && largest < power(low) => Finite,
        _ => Inside,
    }
}

/// The points that dpsm_project takes.
pub fn projected(p: [f32; 3]) -> Promise {
    sized(-51, 63, p)
}

/// The points that a receiver may be at.
pub fn received(p: [f32; 3]) -> Promise {
    sized(-51, 62, p)
}

/// Normals of receivers: 0 or in [2^-50, 2^61]; smaller ones count as 0.
pub fn normals(v: [f32; 3]) -> Promise {
    sized(-50, 61, v)
}

/// Vertices of edges and triangles, in [2^-50, 2^62] each: nearer ones are finite, the light's
/// own position among them.
pub fn vertices<const N: usize>(corners: [[f32; 3]; N]) -> Promise {
    let promise = corners.map(|p| match sized(-50, 62, p) {
        Inside if p == [0.0; 3] => Finite,
        promise => promise,
    });
    promise.into_iter().min().unwrap_or(Inside)
}
