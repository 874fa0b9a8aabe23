//! Whether two figures differ by more than their noise; docs/report.md derives each formula.

use std::f64::consts::{FRAC_PI_2, PI};

use super::data::Times;

/// Chance that any of a report's comparisons finds a change where there is none.
pub const FALSE_ALARM: f64 = 0.01;
/// Fewer runs than this say nothing of their own spread.
pub const FEWEST_RUNS: u32 = 5;
/// Changes smaller than this are drift of the machine between two runs, which no run shows.
pub const SMALLEST_CHANGE: f64 = 0.01;

/// Distance of a normal distribution's quartiles in standard deviations.
const QUARTILES: f64 = 1.349;
/// Degrees of freedom of a standard deviation that is taken from the quartiles, a run.
const FREEDOM: f64 = 0.367;

/// The variance of a median.
fn variance(times: &Times) -> f64 {
    let sigma = (times.high - times.low) / QUARTILES;
    FRAC_PI_2 * sigma * sigma / f64::from(times.runs)
}

/// The chance that two medians of the same distribution differ by as much; `None` of too few runs.
pub fn chance_of_times(a: &Times, b: &Times) -> Option<f64> {
    if a.runs.min(b.runs) < FEWEST_RUNS {
        return None;
    }
    let gap = (a.median - b.median).abs();
    if gap <= SMALLEST_CHANGE * a.median.abs().min(b.median.abs()) {
        return Some(1.0);
    }
    let (va, vb) = (variance(a), variance(b));
    if va + vb == 0.0 {
        return Some(0.0);
    }
    let freedom = |times: &Times| FREEDOM * f64::from(times.runs);
    let both = (va + vb).powi(2) / (va * va / freedom(a) + vb * vb / freedom(b));
    Some(student(gap / (va + vb).sqrt(), both))
}

/// Two tails of Student's distribution beyond t.
fn student(t: f64, freedom: f64) -> f64 {
    // t = sqrt(freedom) cot(x) makes the density sin(x)^(freedom - 1)
    let power = (freedom - 1.0).clamp(0.0, 500.0);
    let integral = |end: f64| {
        const STEPS: u32 = 600;
        let h = end / f64::from(STEPS);
        let weight = |i: u32| if i == 0 || i == STEPS { 1.0 } else { f64::from(2 + i % 2 * 2) };
        (0..=STEPS).map(|i| weight(i) * (f64::from(i) * h).sin().powf(power)).sum::<f64>() * h / 3.0
    };
    integral(freedom.sqrt().atan2(t)) / integral(FRAC_PI_2)
}

/// The chance that two samples of the same share differ by as much, given how many there are in
/// both: twice the smaller tail of the binomial distribution.
pub fn chance_of_counts(a: (u64, u64), b: (u64, u64)) -> f64 {
    let (found, share) = (a.0 + b.0, a.1 as f64 / (a.1 + b.1) as f64);
    if found == 0 || !(share > 0.0 && share < 1.0) {
        return 1.0;
    }
    let term = |k: u64| {
        let ways = log_factorial(found) - log_factorial(k) - log_factorial(found - k);
        (ways + k as f64 * share.ln() + (found - k) as f64 * (1.0 - share).ln()).exp()
    };
    let (below, above): (f64, f64) = ((0..=a.0).map(term).sum(), (a.0..=found).map(term).sum());
    (2.0 * below.min(above)).min(1.0)
}

/// Stirling's series, exact to 1e-9 from 10 on.
fn log_factorial(n: u64) -> f64 {
    if n < 10 {
        return (2..=n).map(|i| (i as f64).ln()).sum();
    }
    let x = n as f64;
    let series = 1.0 / (12.0 * x) - 1.0 / (360.0 * x.powi(3)) + 1.0 / (1260.0 * x.powi(5));
    x * x.ln() - x + 0.5 * (2.0 * PI * x).ln() + series
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs around a median, with noise of a shape: normal, or skewed as a busy machine's is.
    fn sample(rng: &mut fastrand::Rng, runs: u32, median: f64, noise: f64, skewed: bool) -> Times {
        let mut normal = || (-2.0 * (1.0 - rng.f64()).ln()).sqrt() * (2.0 * PI * rng.f64()).cos();
        let value =
            |z: f64| if skewed { median * (noise * z).exp() } else { median * (1.0 + noise * z) };
        let mut all: Vec<f64> = (0..runs).map(|_| value(normal())).collect();
        all.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = share * f64::from(runs - 1);
            let (low, part) = (place.floor() as usize, place.fract());
            all[low] + part * (all[(low + 1).min(all.len() - 1)] - all[low])
        };
        Times { runs, least: all[0], low: at(0.25), median: at(0.5), high: at(0.75) }
    }

    #[test]
    fn equal_times_seem_to_differ_as_rarely_as_stated() {
        let mut rng = fastrand::Rng::with_seed(1);
        for (runs, skewed) in [(5, false), (9, true), (15, false), (31, true)] {
            const PAIRS: u32 = 10_000;
            let mut chance = || {
                let [a, b] = [(), ()].map(|()| sample(&mut rng, runs, 10.0, 0.2, skewed));
                chance_of_times(&a, &b).unwrap()
            };
            let chances: Vec<f64> = (0..PAIRS).map(|_| chance()).collect();
            for level in [1e-2, 1e-3] {
                let alarms = chances.iter().filter(|chance| **chance < level).count() as f64;
                let most = f64::from(PAIRS) * level;
                // 4 standard deviations of a count; and not so cautious that nothing is seen
                assert!(alarms <= most + 4.0 * most.sqrt(), "{runs} runs, {level}: {alarms}");
                assert!(level < 1e-2 || alarms > most / 4.0, "{runs} runs, {level}: {alarms}");
            }
        }
    }

    #[test]
    fn changes_above_the_noise_are_seen_among_many() {
        let mut rng = fastrand::Rng::with_seed(2);
        let mut seen = || {
            let [a, b] = [10.0, 12.0].map(|median| sample(&mut rng, 15, median, 0.02, true));
            chance_of_times(&a, &b).unwrap() < FALSE_ALARM / 500.0
        };
        assert_eq!((0..200).filter(|_| seen()).count(), 200);
        let steady =
            |median: f64| Times { runs: 9, least: median, low: median, median, high: median };
        assert_eq!(chance_of_times(&steady(10.0), &steady(10.05)), Some(1.0), "drift");
        assert_eq!(chance_of_times(&steady(10.0), &steady(12.0)), Some(0.0));
        assert_eq!(chance_of_times(&steady(10.0), &Times { runs: 4, ..steady(12.0) }), None);
    }

    #[test]
    fn students_tails_are_the_tables() {
        // two-sided 5% and 0.1% of 5, 10 and 30 degrees of freedom, from any table
        for (t, freedom, tail) in
            [(2.571, 5.0, 0.05), (6.869, 5.0, 0.001), (2.228, 10.0, 0.05), (3.646, 30.0, 0.001)]
        {
            let off = student(t, freedom) / tail;
            assert!((0.998..1.002).contains(&off), "{t} {freedom}: {off}");
        }
    }

    #[test]
    fn counts_differ_by_the_binomial_distribution() {
        // 3 of 10 fair coins or fewer: 176 / 1024, twice
        assert!((chance_of_counts((3, 100), (7, 100)) - 352.0 / 1024.0).abs() < 1e-9);
        assert_eq!(chance_of_counts((0, 100), (0, 50)), 1.0);
        assert_eq!(chance_of_counts((5, 100), (5, 100)), 1.0);
        assert!(chance_of_counts((150, 20_000), (260, 20_000)) < 1e-6);
        assert!(chance_of_counts((150, 20_000), (160, 20_000)) > 0.5);
        assert!((log_factorial(20).exp() / 2_432_902_008_176_640_000.0 - 1.0).abs() < 1e-8);
    }
}
