//! [`Telemetry`]: what a control law has recorded of a run, at times of its own.

use super::Quantity;

/// Quantities over the times at which a law recorded them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Telemetry {
    /// The columns.
    pub quantities: Vec<Quantity>,
    /// The times, ascending, s.
    pub times: Vec<f64>,
    /// For each time one value of each column; NaN where there is none.
    pub rows: Vec<Vec<f64>>,
}

impl Telemetry {
    /// Each column at `times`: the value recorded last, NaN before the first.
    pub fn held_at(&self, times: &[f64]) -> Vec<Vec<f64>> {
        let row = |time: &f64| self.times.partition_point(|recorded| recorded <= time).checked_sub(1);
        let rows: Vec<Option<usize>> = times.iter().map(row).collect();
        let value = |row: &Option<usize>, column: usize| row.map_or(f64::NAN, |row| self.rows[row][column]);
        (0..self.quantities.len()).map(|column| rows.iter().map(|row| value(row, column)).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a value holds from the time at which it was recorded until the next.
    #[test]
    fn values_are_held() {
        let telemetry = Telemetry {
            quantities: vec![Quantity::new("phase", "", "Phase.")],
            times: vec![0.5, 1.0],
            rows: vec![vec![1.0], vec![2.0]],
        };
        let held = telemetry.held_at(&[0.0, 0.5, 0.75, 1.0, 9.0]);
        assert!(held[0][0].is_nan());
        assert_eq!(held[0][1..], [1.0, 1.0, 2.0, 2.0]);
    }
}
