//! What half precision would do: the ports with every operation rounded to f16.

use std::ops::{Add, Div, Mul, Neg, Sub};

use dpsm::scalar::depth::dpsm_depth;
use dpsm::scalar::float::{Float, Vec3};
use dpsm::scalar::paraboloid::{dpsm_project, dpsm_texel_width};

mod common;

use common::{CASES, point, rng};

/// A number of f16, held in f64.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Half(f64);

/// eps of f16 by WGSL's rules, as 2^-23 for f32.
const EPS: f64 = 1.0 / 1024.0;

/// The nearest f16: 11 bits, at least 2^-24 apart, infinite from 65520 on.
fn rounded(value: f64) -> Half {
    if !value.is_finite() || value == 0.0 {
        return Half(value);
    }
    let exponent = (value.abs().log2().floor() as i32).max(-14);
    let step = 2f64.powi(exponent - 10);
    let nearest = (value / step).round_ties_even() * step;
    Half(if nearest.abs() > 65504.0 { f64::INFINITY.copysign(value) } else { nearest })
}

macro_rules! operator {
    ($($op:ident $function:ident),+) => {
        $(impl $op for Half {
            type Output = Self;
            fn $function(self, other: Self) -> Self {
                rounded(self.0.$function(other.0))
            }
        })+
    };
}
operator!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Half {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Float for Half {
    fn lit(value: f64) -> Self {
        rounded(value)
    }
    fn value(self) -> f64 {
        self.0
    }
    fn sqrt(self) -> Self {
        rounded(self.0.sqrt())
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
    fn floor(self) -> Self {
        Self(self.0.floor())
    }
    fn ceil(self) -> Self {
        Self(self.0.ceil())
    }
}

#[test]
fn half_precision_misses_texels_and_sixteen_bits_of_depth() {
    let mut rng = rng("half");
    // near and far for points of 1/2 to 4
    let (near, far) = (0.125, 8.0);
    let (mut place, mut deep) = (0.0_f64, 0.0_f64);
    for _ in 0..CASES {
        let p = point(&mut rng, -3, 2).widen();
        let p = Vec3::new(p.x, p.y, p.z.abs());
        // the input itself is exact: what is measured is the arithmetic's own error
        let half = Vec3::new(rounded(p.x), rounded(p.y), rounded(p.z));
        let exact = Vec3::new(half.x.0, half.y.0, half.z.0);
        let (uv, own) = (dpsm_project(exact), dpsm_project(half));
        place = place.max((uv.x - own.x.0).abs()).max((uv.y - own.y.0).abs());
        let depth = dpsm_depth(exact.length(), near, far);
        let own = dpsm_depth(half.length(), rounded(near), rounded(far)).0;
        deep = deep.max((depth - own).abs());
    }
    println!("disk: {place:.2e}, {:.2} eps; depth: {deep:.2e}, {:.2} eps", place / EPS, deep / EPS);
    for size in [128.0, 512.0, 4096.0] {
        let texel = dpsm_texel_width(size, 0.0);
        println!("{size} texels: {:.2} of one, bound {:.2}", place / texel, 9.5 * EPS / texel);
    }
    println!("depth: {:.0} steps of 16 bits, bound {:.0}", deep * 65535.0, 10.5 * EPS * 65535.0);
    // the bounds of f32 with the eps of f16, |uv| and depth at most 1
    assert!(place <= 9.5 * EPS && deep <= 10.5 * EPS);
    // what a lookup may miss: half a texel of 512, and a step of 16 bits
    assert!(place > 0.25 * dpsm_texel_width(512.0, 0.0) && deep > 16.0 / 65535.0);
}

#[test]
fn half_precision_has_no_distance_beyond_255() {
    let p = Vec3::new(rounded(256.0), rounded(0.0), rounded(1.0));
    assert_eq!(p.length().0, f64::INFINITY);
    // and directions within 1/4096 of the back pole are it, since 2^25 is infinite
    assert_eq!(rounded(2f64.powi(25)).0, f64::INFINITY);
}
