//! [`Measurement`]: numbers with the meaning that the sensor's kind gives them
//! ([`super::kinds::SensorKind::quantities`]).

/// Largest number of values in a measurement.
pub const MAX_VALUES: usize = 12;

/// Values in the order of their kind's quantities; NaN if unknown or absent.
pub type Values = [f64; MAX_VALUES];

/// Concatenates `parts`.
///
/// # Panics
/// Above [`MAX_VALUES`] numbers.
pub fn values(parts: &[&[f64]]) -> Values {
    let mut all = [f64::NAN; MAX_VALUES];
    let mut at = 0;
    for part in parts {
        all[at..at + part.len()].copy_from_slice(part);
        at += part.len();
    }
    all
}

/// The N values from `first` on.
///
/// # Panics
/// Beyond [`MAX_VALUES`].
pub fn part<const N: usize>(values: &Values, first: usize) -> [f64; N] {
    std::array::from_fn(|i| values[first + i])
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Index of the sensor in the loop.
    pub sensor: usize,
    pub values: Values,
    pub age: f64,
}

/// The last measurement delivered by a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Its values; NaN before the first.
    pub values: Values,
    /// Time of the measurement since the start of the run, s; NaN before the first.
    pub time: f64,
}

impl Reading {
    pub const NONE: Reading = Reading { values: [f64::NAN; MAX_VALUES], time: f64::NAN };
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMotion {
    pub r_e: [f64; 3],
    pub v_e: [f64; 3],
}

impl PointMotion {
    /// Six values from `first` on; `None` if unknown.
    pub fn of(values: &Values, first: usize) -> Option<Self> {
        let motion = PointMotion { r_e: part(values, first), v_e: part(values, first + 3) };
        (!motion.r_e[0].is_nan()).then_some(motion)
    }
}
