//! Logarithmic axes on which zero has a place.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use super::super::html::number;

/// An axis from its smallest to its largest value, in powers of ten.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    low: f64,
    high: f64,
    zero: bool,
}

impl Axis {
    /// The axis that holds the values; what is below zero or no number stands with zero.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let (mut low, mut high, mut zero) = (f64::INFINITY, f64::NEG_INFINITY, false);
        for value in values {
            if value > 0.0 && value.is_finite() {
                (low, high) = (low.min(value.log10()), high.max(value.log10()));
            } else {
                zero = true;
            }
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // at least a third of a decade, so that noise does not fill the plot
        let slack = 0.06 * (high - low) + (0.34 - (high - low)).max(0.0) / 2.0;
        Self { low: low - slack, high: high + slack, zero }
    }

    /// The least value of the logarithmic part, if zero has a place before it.
    pub fn edge(&self) -> Option<f64> {
        self.zero.then(|| 10f64.powf(self.low))
    }

    /// Where a value stands.
    fn place(&self, value: f64) -> f64 {
        if value > 0.0 && value.is_finite() { value.log10() } else { self.low - self.gap() }
    }

    /// All places.
    fn places(&self) -> Range<f64> {
        let low = if self.zero { self.low - 1.8 * self.gap() } else { self.low };
        low..self.high
    }

    fn gap(&self) -> f64 {
        0.1 * (self.high - self.low)
    }

    /// Values with labels: powers of ten, or also their multiples where there are few.
    fn ticks(&self) -> Vec<f64> {
        let steps: &[f64] = match self.high - self.low {
            span if span > 2.2 => &[1.0],
            span if span > 0.9 => &[1.0, 2.0, 5.0],
            span if span > 0.5 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
            _ => &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0],
        };
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        let all = decades.flat_map(|d| steps.iter().map(move |s| (f64::from(d) + s.log10(), d, s)));
        let inside = |place: f64| (self.low..=self.high).contains(&place);
        let ticks: Vec<f64> =
            all.filter(|tick| inside(tick.0)).map(|t| t.2 * 10f64.powi(t.1)).collect();
        let every = ticks.len().div_ceil(8).max(1);
        ticks.into_iter().step_by(every).chain(self.zero.then_some(0.0)).collect()
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let Range { start, end } = self.places();
        let share = (self.place(*value) - start) / (end - start);
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks() }
    }

    fn range(&self) -> Range<f64> {
        10f64.powf(self.low)..10f64.powf(self.high)
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        let text = number(*value);
        match text.split_once('.') {
            Some((_, tail)) if !tail.contains('e') => {
                text.trim_end_matches('0').trim_end_matches('.').to_string()
            }
            Some((head, tail)) => {
                let (digits, power) = tail.split_once('e').unwrap_or((tail, "0"));
                let digits = format!(".{digits}");
                format!("{head}{}e{power}", digits.trim_end_matches('0').trim_end_matches('.'))
            }
            None => text,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_stands_apart_on_the_left() {
        let axis = Axis::of([0.0, 0.01, 10.0].into_iter());
        let [zero, edge, least, most] =
            [0.0, axis.edge().unwrap(), 0.01, 10.0].map(|value| axis.map(&value, (0, 1000)));
        assert!(0 < zero && zero < edge && edge < least && least < most && most < 1000);
        let labels: Vec<_> = axis.ticks().iter().map(|tick| axis.format_ext(tick)).collect();
        assert_eq!(labels, ["0.01", "0.1", "1", "10", "0"]);
        assert_eq!(Axis::of([1.0, 2.0].into_iter()).edge(), None);
    }

    #[test]
    fn any_values_make_an_axis() {
        let hard: [&[f64]; 5] =
            [&[], &[0.0], &[f64::NAN, f64::INFINITY, -1.0], &[5.0], &[1e-300, 1e300]];
        for values in hard {
            let axis = Axis::of(values.iter().copied());
            let inside = |value: &f64| (0..=1000).contains(&axis.map(value, (0, 1000)));
            assert!(values.iter().all(inside), "{values:?}");
            assert!(axis.ticks().len() < 12, "{values:?}");
        }
    }
}
