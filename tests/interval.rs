//! The intervals hold what WGSL allows, no more, and leave decisions open only at their edges.

mod common;

use std::cell::Cell;

use common::{EPS, rng, spread};
use dpsm::scalar::float::{Float, Vec2, Vec3};
use dpsm::scalar::hemisphere::{DPSM_BACK, DPSM_FRONT, dpsm_hemisphere, dpsm_invert};
use dpsm::scalar::interval::{Interval, answers};
use dpsm::scalar::paraboloid::dpsm_project_own;

const CASES: usize = 100_000;

/// The f32s at or next to a number.
fn around(x: f64) -> [f32; 2] {
    let nearest = x as f32;
    match f64::from(nearest) {
        same if same == x => [nearest; 2],
        above if above > x => [nearest.next_down(), nearest],
        _ => [nearest, nearest.next_up()],
    }
}

fn exact(x: f32) -> Interval {
    Interval::exact(x)
}

#[test]
fn sums_and_products_hold_both_roundings_and_nothing_else() {
    let mut rng = rng("sums");
    for _ in 0..CASES {
        let (a, b) = (spread(&mut rng, -20, 20), spread(&mut rng, -20, 20));
        // exact in f64: the exponents are at most 40 apart
        let (wide_a, wide_b) = (f64::from(a), f64::from(b));
        for (interval, value) in [
            (exact(a) + exact(b), wide_a + wide_b),
            (exact(a) - exact(b), wide_a - wide_b),
            (exact(a) * exact(b), wide_a * wide_b),
        ] {
            let [low, high] = around(value).map(f64::from);
            assert_eq!((interval.low, interval.high, interval.value), (low, high, value));
        }
    }
}

#[test]
fn sums_beyond_f64_are_rounded_either_way_too() {
    let tiny = f32::MIN_POSITIVE;
    let sum = exact(1.0) + exact(tiny);
    assert_eq!((sum.low, sum.high), (1.0, f64::from(1.0_f32.next_up())));
    let sum = exact(1.0) - exact(tiny);
    assert_eq!((sum.low, sum.high), (f64::from(1.0_f32.next_down()), 1.0));
}

#[test]
fn fused_products_lie_inside() {
    let mut rng = rng("fused");
    for _ in 0..CASES {
        let [a, b, c, d] = [0; 4].map(|_| spread(&mut rng, -3, 3));
        let sum = exact(a) * exact(b) + exact(c) * exact(d);
        // one product kept exactly, as a fused multiply-add does
        assert!(sum.holds(a.mul_add(b, c * d)) && sum.holds(c.mul_add(d, a * b)));
        assert!(sum.holds(a * b + c * d));
    }
}

#[test]
fn dot_products_hold_every_order() {
    let mut rng = rng("order");
    let mut wider = 0;
    for _ in 0..CASES {
        let [a, b, c] = [0; 3].map(|_| spread(&mut rng, -3, 3));
        let sum = Interval::sum([a, b, c].map(exact));
        assert!([(a + b) + c, (b + c) + a, (c + a) + b].iter().all(|&x| sum.holds(x)));
        let fixed = exact(a) + exact(b) + exact(c);
        wider += usize::from(!(fixed.holds((b + c) + a) && fixed.holds((c + a) + b)));
    }
    // the order matters, or this test shows nothing
    assert!(wider > CASES / 100, "{wider}");
}

#[test]
fn quotients_are_within_two_and_a_half_ulp_and_roots_within_their_inverses() {
    let mut rng = rng("quotients");
    for _ in 0..CASES {
        let (a, b) = (spread(&mut rng, -20, 20), spread(&mut rng, -20, 20));
        let quotient = exact(a) / exact(b);
        let nearest = a / b;
        let two_up = nearest.next_up().next_up();
        let ulp = f64::from(nearest.abs().next_up()) - f64::from(nearest.abs());
        assert!(quotient.holds(nearest) && quotient.high - quotient.low <= 5.0 * ulp);
        assert!(
            quotient.holds(two_up) == ((f64::from(two_up) - quotient.value).abs() <= 2.5 * ulp)
        );
        let root = exact(a.abs()).sqrt();
        assert!(root.holds(a.abs().sqrt()) && root.holds(1.0 / (1.0 / a.abs().sqrt())));
        // 2 ULP and 2.5 ULP, each up to twice as much relative to the value
        assert!((root.high - root.low) / root.value <= 2.0 * (2.0 + 2.5) * EPS);
    }
}

#[test]
fn subnormal_numbers_may_be_flushed() {
    let subnormal = f32::MIN_POSITIVE / 2.0;
    let read = exact(subnormal);
    assert!(read.holds(0.0) && read.holds(subnormal));
    let product = exact(1e-20) * exact(1e-20);
    assert!(product.holds(0.0) && product.holds(1e-20 * 1e-20));
    let product = exact(1e-20) * exact(-1e-20);
    assert!(product.holds(0.0) && product.holds(1e-20 * -1e-20) && !product.holds(1e-44));
}

#[test]
fn nothing_is_promised_of_overflow_zero_divisors_and_negative_roots() {
    let anything = [
        exact(3e38) * exact(2.0),
        exact(3e38) + exact(3e38),
        exact(1.0) / exact(0.0),
        exact(1.0) / (exact(1.0) / exact(3.0) - exact(1.0) / exact(3.0)),
        exact(1.0) / exact(2e38),
        exact(-1.0).sqrt(),
        exact(f32::NAN),
        exact(f32::INFINITY),
        exact(1e30) / exact(1e-30),
    ];
    for interval in anything {
        assert!(interval.is_anything() && interval.holds(f32::NAN), "{interval:?}");
        // and of nothing that is computed from it
        assert!((interval + exact(1.0)).is_anything());
        assert!(interval.max(exact(0.0)).is_anything());
    }
}

#[test]
fn squares_are_not_below_zero() {
    let third = || exact(1.0) / exact(3.0);
    let around_zero = third() - third();
    assert!(around_zero.low < 0.0 && around_zero.high > 0.0);
    assert!((around_zero * around_zero).low >= 0.0);
    assert!(Vec2::new(around_zero, around_zero).length().low >= 0.0);
}

/// How often each answer of a decision is given.
fn decided(port: impl Fn() -> bool) -> [bool; 2] {
    let seen = [Cell::new(false), Cell::new(false)];
    let all = answers(port, |answer| {
        seen[usize::from(answer)].set(true);
        false
    });
    assert_eq!(all, Some(false));
    seen.map(|answer| answer.get())
}

#[test]
fn decisions_are_open_where_intervals_overlap_and_only_there() {
    let third = exact(1.0) / exact(3.0);
    let below = exact((third.low as f32).next_down());
    assert_eq!(decided(|| third > below), [false, true]);
    assert_eq!(decided(|| third < below), [true, false]);
    assert_eq!(decided(|| third > exact(third.low as f32)), [true, true]);
    assert_eq!(decided(|| third >= exact(third.low as f32)), [false, true]);
    assert_eq!(decided(|| third == exact(1.0 / 3.0)), [true, true]);
    assert_eq!(decided(|| exact(0.5) == exact(0.5)), [false, true]);
    assert_eq!(decided(|| third < third), [true, false]);
}

#[test]
fn ways_to_decide_are_all_tried() {
    let third = exact(1.0) / exact(3.0);
    let edge = exact(third.value as f32);
    let mut found = Vec::new();
    answers(
        || [0; 3].map(|_| third > edge),
        |way| {
            found.push(way);
            false
        },
    );
    found.sort();
    found.dedup();
    assert_eq!(found.len(), 8);
    // more of them than are tried is no answer
    assert_eq!(answers(|| [0; 20].map(|_| third > edge), |_| false), None);
}

#[test]
fn whole_numbers_are_chosen_and_then_known() {
    let near_three = exact(9.0) / exact(3.0);
    let mut found = Vec::new();
    answers(
        || near_three.floor(),
        |whole| {
            assert_eq!((whole.low, whole.high), (whole.value, whole.value));
            found.push(whole.value);
            false
        },
    );
    assert_eq!(found, [3.0, 2.0]);
    let mut levels = Vec::new();
    answers(
        || near_three.ceil().to_integer(),
        |level| {
            levels.push(level);
            false
        },
    );
    assert_eq!(levels, [3, 4]);
}

#[test]
fn hemisphere_of_a_subnormal_z_is_open_and_no_other() {
    let hemisphere = |z: f32| {
        let p = Vec3::new(exact(1.0), exact(1.0), exact(z));
        decided(|| dpsm_hemisphere(p) == DPSM_FRONT)
    };
    assert_eq!(hemisphere(-1e-40), [true, true]);
    assert_eq!(hemisphere(-1e-37), [true, false]);
    assert_eq!(hemisphere(0.0), [false, true]);
    assert_eq!(hemisphere(-0.0), [false, true]);
    assert_eq!(DPSM_BACK, 1);
}

#[test]
fn ports_run_on_intervals_and_hold_their_f32_results() {
    let mut rng = rng("ports");
    for _ in 0..CASES {
        let [x, y, z] = [0; 3].map(|_| spread(&mut rng, -30, 30));
        let wide = Vec3::new(exact(x), exact(y), exact(z));
        let uv = dpsm_project_own(Vec3::new(x, y, z));
        let held = dpsm_project_own(wide);
        assert!(held.x.holds(uv.x) && held.y.holds(uv.y), "{x} {y} {z}");
        // 9.5 eps each way, and the roundings to f32s at the ends
        assert!((held.x.high - held.x.low) / held.x.value.abs() <= 21.0 * EPS, "{x} {y} {z}");
        let other = answers(
            || dpsm_invert(Vec2::new(exact(x), exact(y))),
            |held| {
                let uv = dpsm_invert(Vec2::new(x, y));
                held.x.holds(uv.x) && held.y.holds(uv.y)
            },
        );
        assert_eq!(other, Some(true), "{x} {y}");
    }
}
