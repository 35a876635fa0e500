//! [`Telemetry`]: records of a control law at times of its own.

use crate::run::quantity::Quantity;

/// Recorded quantities over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Telemetry {
    /// The columns.
    pub quantities: Vec<Quantity>,
    /// The times, ascending, s.
    pub times: Vec<f64>,
    /// One value per column for each time, or NaN.
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
