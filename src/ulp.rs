//! Distances between floats.

/// How many f32 values lie between two, counted across zero; two NaNs are 0 apart, a NaN and a
/// number u32::MAX.
pub fn ulps_apart(a: f32, b: f32) -> u32 {
    let place = |x: f32| {
        let magnitude = i64::from(x.to_bits() & 0x7fff_ffff);
        if x.is_sign_negative() { -magnitude } else { magnitude }
    };
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0,
        (false, false) => place(a).abs_diff(place(b)) as u32,
        _ => u32::MAX,
    }
}

/// How far a value is from an exact one, in units in the last place of the exact one (that of the
/// smallest normal number below it); 0 where both are the same infinity or both are NaN.
pub fn ulps_off(value: f32, exact: f64) -> f64 {
    if f64::from(value) == exact || (value.is_nan() && exact.is_nan()) {
        return 0.0;
    }
    let smallest = f64::from(f32::MIN_POSITIVE);
    let exponent = exact.abs().max(smallest).log2().floor();
    (f64::from(value) - exact).abs() / (exponent - 23.0).exp2()
}
