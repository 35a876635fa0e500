//! [`Measurement`]: numbers whose meaning the kind of the sensor owns ([`super::sensors::SensorKind::quantities`]).

/// Most numbers of a measurement.
pub const MAX_VALUES: usize = 12;

/// The numbers of a measurement, in the order of its kind's quantities; NaN beyond them, and where one is not known.
pub type Values = [f64; MAX_VALUES];

/// `parts`, one after another.
///
/// # Panics
/// If they are more than [`MAX_VALUES`].
pub fn values(parts: &[&[f64]]) -> Values {
    let mut all = [f64::NAN; MAX_VALUES];
    let mut at = 0;
    for part in parts {
        all[at..at + part.len()].copy_from_slice(part);
        at += part.len();
    }
    all
}

/// The N numbers of `values` from `first` on.
///
/// # Panics
/// If there are not so many.
pub fn part<const N: usize>(values: &Values, first: usize) -> [f64; N] {
    std::array::from_fn(|i| values[first + i])
}

/// A measurement as delivered at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// The sensor, by its place in the loop.
    pub sensor: usize,
    /// Its numbers.
    pub values: Values,
    /// Time since it was measured, s.
    pub age: f64,
}

/// The last measurement that a sensor has delivered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Its numbers; NaN before the first.
    pub values: Values,
    /// When it was measured, s since the start of the run; NaN before the first.
    pub time: f64,
}

impl Reading {
    /// Before the first.
    pub const NONE: Reading = Reading { values: [f64::NAN; MAX_VALUES], time: f64::NAN };
}

/// Position and velocity of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMotion {
    /// Position in F_e, m.
    pub r_e: [f64; 3],
    /// Velocity relative to F_e, in F_e, m/s.
    pub v_e: [f64; 3],
}

impl PointMotion {
    /// The six numbers of `values` from `first` on; `None` if they are not known.
    pub fn of(values: &Values, first: usize) -> Option<Self> {
        let motion = PointMotion { r_e: part(values, first), v_e: part(values, first + 3) };
        (!motion.r_e[0].is_nan()).then_some(motion)
    }
}
