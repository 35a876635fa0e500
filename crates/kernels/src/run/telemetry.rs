//! [`Telemetry`]: records of a control law at times of its own.

use crate::run::quantity::Quantity;

/// Recorded quantities over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Telemetry {
    /// The columns.
    pub quantities: Vec<Quantity>,
    /// The times, ascending, s.
    pub times: Vec<f64>,
    /// One value per column for each time; NaN if there is none.
    pub rows: Vec<Vec<f64>>,
    /// Tolerance of equal times, s, for the rounding of ticks and grid points.
    pub same: f64,
}

impl Telemetry {
    /// Each column at `times`: the last recorded value, NaN before the first.
    pub fn held_at(&self, times: &[f64]) -> Vec<Vec<f64>> {
        let row = |time: &f64| self.times.partition_point(|recorded| *recorded <= time + self.same).checked_sub(1);
        let rows: Vec<Option<usize>> = times.iter().map(row).collect();
        let value = |row: &Option<usize>, column: usize| row.map_or(f64::NAN, |row| self.rows[row][column]);
        (0..self.quantities.len()).map(|column| rows.iter().map(|row| value(row, column)).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a value holds until the next is recorded.
    #[test]
    fn values_are_held() {
        let telemetry = Telemetry {
            quantities: vec![Quantity::new("phase", "", "Phase.")],
            times: vec![0.5, 1.0],
            rows: vec![vec![1.0], vec![2.0]],
            same: 0.0,
        };
        let held = telemetry.held_at(&[0.0, 0.5, 0.75, 1.0, 9.0]);
        assert!(held[0][0].is_nan());
        assert_eq!(held[0][1..], [1.0, 1.0, 2.0, 2.0]);
    }

    /// Law: tick k of a period of 0.1 s holds at the grid point of the same decimal time; without the tolerance some
    /// points show the tick before.
    #[test]
    fn rounding_shows_no_tick_before() {
        let ticks = 400;
        let telemetry = |same: f64| Telemetry {
            quantities: vec![Quantity::new("phase", "", "Phase.")],
            times: (0..=ticks).map(|tick| f64::from(tick) * 0.1).collect(),
            rows: (0..=ticks).map(|tick| vec![f64::from(tick)]).collect(),
            same,
        };
        let grid: Vec<f64> = (0..=ticks).map(|point| 40.0 * f64::from(point) / f64::from(ticks)).collect();
        let late = |same: f64| {
            let held = telemetry(same).held_at(&grid);
            held[0].iter().enumerate().filter(|(point, tick)| **tick != *point as f64).count()
        };
        assert_eq!(late(1e-10), 0);
        assert!(late(0.0) > 10, "{} points", late(0.0));
    }
}
