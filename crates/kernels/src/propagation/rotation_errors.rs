//! [`rotation_errors`]: errors of a run's rotation against its reference solution, in all digits of the latter.

use super::taylor::reference_solution::ReferenceSolution;
use crate::math::vector::{difference, norm};
use crate::run::{Grid, StateField, StateTable, rate_scale, rate_scale_of};

/// Error of the rotation at one observation point, or the largest of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotationError {
    /// omega - reference| over the largest |omega| of the run, at least one radian per duration ([`rate_scale`]).
    pub omega: f64,
    /// Twice the distance of the attitude quaternions of nearer sign, rad; zero without a reference attitude.
    pub attitude: f64,
}

impl RotationError {
    /// The larger of both errors; NaN if either is NaN.
    pub fn state(&self) -> f64 {
        larger_or_nan(self.omega, self.attitude)
    }

    /// The largest errors over all points of a run; NaN if an error is NaN at any point.
    pub fn largest(errors: impl Iterator<Item = RotationError>) -> Self {
        errors.fold(RotationError { omega: 0.0, attitude: 0.0 }, |largest, error| RotationError {
            omega: larger_or_nan(largest.omega, error.omega),
            attitude: larger_or_nan(largest.attitude, error.attitude),
        })
    }
}

fn larger_or_nan(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}

/// The largest difference of `table` from `truth` over the first `filled` of `times`.
pub fn rotation_difference(truth: &StateTable, table: &StateTable, times: &[f64], filled: usize) -> RotationError {
    let scale = rate_scale_of(truth, times, filled);
    RotationError::largest((0..filled).map(|point| {
        let rate = |table: &StateTable| table.at::<3>(StateField::Rate, point);
        let [a, b] = [truth, table].map(|table| table.at::<4>(StateField::Attitude, point));
        let turned = |sign: f64| {
            let squares = a.iter().zip(b).map(|(a, b)| (a - sign * b) * (a - sign * b));
            2.0 * squares.sum::<f64>().sqrt()
        };
        let omega = norm(difference(rate(truth), rate(table))) / scale;
        RotationError { omega, attitude: turned(1.0).min(turned(-1.0)) }
    }))
}

/// The error at each point of `table` on `grid`.
pub fn rotation_errors<'a>(
    reference: &'a ReferenceSolution,
    grid: &Grid,
    table: &'a StateTable,
) -> impl Iterator<Item = RotationError> + 'a {
    errors_of(reference, grid, table, [StateField::Rate, StateField::Attitude])
}

/// The errors of the debris.
pub fn debris_rotation_errors<'a>(
    reference: &'a ReferenceSolution,
    grid: &Grid,
    table: &'a StateTable,
) -> impl Iterator<Item = RotationError> + 'a {
    errors_of(reference, grid, table, [StateField::DebrisRate, StateField::DebrisAttitude])
}

fn errors_of<'a>(
    reference: &'a ReferenceSolution,
    grid: &Grid,
    table: &'a StateTable,
    [rate, attitude]: [StateField; 2],
) -> impl Iterator<Item = RotationError> + 'a {
    let square = |omega: [f64; 3]| omega.iter().map(|x| x * x).sum::<f64>();
    let squares = (0..table.points()).map(|point| square(reference.high.at(rate, point)));
    let scale = rate_scale(squares.fold(0.0, f64::max).sqrt(), grid.duration());
    let has_attitude = reference.high.has(attitude);
    (0..table.points()).map(move |point| {
        let turned = |sign| 2.0 * reference.distance::<4>(table, attitude, point, sign);
        RotationError {
            omega: reference.distance::<3>(table, rate, point, 1.0) / scale,
            attitude: if has_attitude { turned(1.0).min(turned(-1.0)) } else { 0.0 },
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::StateFields;

    /// Rates and attitudes at three points; the middle one is off by `rate` and `turn`, with the quaternion's sign
    /// `sign`.
    fn table([rate, turn, sign]: [f64; 3]) -> StateTable {
        let mut table = StateTable::new(StateFields::NONE.with(StateField::Rate).with(StateField::Attitude), 0, 3);
        for point in 0..3 {
            let (rate, turn, sign) = if point == 1 { (rate, turn, sign) } else { (0.0, 0.0, 1.0) };
            table.set(StateField::Rate, point, [0.0, 2.0 + rate, 0.0]);
            let (sin, cos) = (libm::sin(0.5 * turn), libm::cos(0.5 * turn));
            table.set(StateField::Attitude, point, [sign * cos, 0.0, 0.0, sign * sin]);
        }
        table
    }

    fn largest(run: [f64; 3]) -> RotationError {
        let high = table([0.0, 0.0, 1.0]);
        let low = StateTable::new(high.fields(), 0, 3);
        RotationError::largest(rotation_errors(&ReferenceSolution { high, low }, &Grid::uniform(4.0, 3), &table(run)))
    }

    /// Law: the error of a run is its maximum over the grid, at any point.
    #[test]
    fn the_error_in_the_middle_of_a_run_counts() {
        let found = largest([0.5, 1e-3, 1.0]);
        assert_eq!(found.omega, 0.25);
        // twice the distance of the quaternions, 4 sin(a/4), is a^3/96 = 1.04e-11 shorter than the angle
        assert!((found.attitude - 1e-3).abs() < 2e-11, "{:e}", found.attitude);
        assert_eq!(found.state(), 0.25);
    }

    #[test]
    fn an_error_that_is_nan_is_not_skipped() {
        let found = largest([f64::NAN, 0.0, 1.0]);
        assert!(found.omega.is_nan() && found.state().is_nan() && found.attitude == 0.0);
    }
}
