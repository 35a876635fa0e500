//! [`GuidanceInput`]: input of guidance at a tick; [`Condition`]: expressions over it.

use super::launch_geometry::LaunchGeometry;
use super::target::AttitudeError;
use super::vector::norm;
use crate::sampling::expression::Expression;

/// Estimated input of guidance at a tick, by the meanings of [`QUANTITIES`]; NaN without debris or transfer.
#[derive(Clone, Copy, Debug)]
pub struct GuidanceInput {
    pub time: f64,
    pub time_in_phase: f64,
    pub body_rate: f64,
    pub error: AttitudeError,
    pub wheel_speed: f64,
    pub wheel_momentum: f64,
    /// Relative to the launch state, if there is debris.
    pub geometry: Option<LaunchGeometry>,
    /// In F_e, like s3.
    pub velocity_to_go: [f64; 3],
    pub s3_e: [f64; 3],
    pub time_to_station: f64,
    pub debris_age: f64,
    pub debris_rate: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuantityRange {
    Any,
    NotNegative,
    /// Zero to pi.
    Angle,
    /// Within the run.
    Time,
}

/// A quantity for conditions.
pub struct GuidanceQuantity {
    /// Name with unit suffix.
    pub name: &'static str,
    pub meaning: &'static str,
    pub needs_debris: bool,
    pub range: QuantityRange,
    value: fn(&GuidanceInput) -> f64,
}

/// A value of the launch geometry; NaN without one, which meets no condition.
fn with_geometry(input: &GuidanceInput, of: impl Fn(&LaunchGeometry) -> f64) -> f64 {
    input.geometry.as_ref().map_or(f64::NAN, of)
}

const fn own(name: &'static str, meaning: &'static str, value: fn(&GuidanceInput) -> f64) -> GuidanceQuantity {
    GuidanceQuantity { name, meaning, needs_debris: false, range: QuantityRange::NotNegative, value }
}

const fn of_debris(name: &'static str, meaning: &'static str, value: fn(&GuidanceInput) -> f64) -> GuidanceQuantity {
    GuidanceQuantity { name, meaning, needs_debris: true, range: QuantityRange::NotNegative, value }
}

impl GuidanceQuantity {
    const fn within(self, range: QuantityRange) -> Self {
        GuidanceQuantity { range, ..self }
    }
}

/// The quantities of conditions, all estimated.
pub static QUANTITIES: [GuidanceQuantity; 16] = [
    own("time_s", "Time since the start of the run", |s| s.time).within(QuantityRange::Time),
    own("time_in_phase_s", "Time since the phase began", |s| s.time_in_phase).within(QuantityRange::Time),
    own("body_rate_rad_s", "Magnitude of the angular velocity of the body relative to F_e", |s| s.body_rate),
    own("pointing_error_rad", "Rotation angle to the target of the phase", |s| s.error.angle())
        .within(QuantityRange::Angle),
    own("wheel_speed_rad_s", "Largest magnitude of the rate of a wheel relative to the body", |s| s.wheel_speed),
    own("wheel_momentum_n_m_s", "Magnitude of the momentum of the wheels relative to the body", |s| s.wheel_momentum),
    of_debris("debris_distance_m", "Distance from the debris", |s| with_geometry(s, |g| norm(g.to_debris))),
    of_debris("axis_offset_m", "Distance from the line through the debris along its velocity", |s| {
        with_geometry(s, LaunchGeometry::axis_offset)
    }),
    of_debris("distance_error_m", "Distance behind the debris along that line, less control.launch_distance_m", |s| {
        with_geometry(s, LaunchGeometry::distance_error)
    })
    .within(QuantityRange::Any),
    of_debris("position_error_m", "Distance from the station", |s| with_geometry(s, LaunchGeometry::position_error)),
    of_debris("relative_speed_m_s", "Speed relative to the debris", |s| {
        with_geometry(s, |g| norm(g.relative_velocity))
    }),
    of_debris(
        "velocity_to_go_m_s",
        "Magnitude of the velocity change that the maneuver of the phase has still to make",
        |s| norm(s.velocity_to_go),
    ),
    of_debris(
        "velocity_to_go_along_m_s",
        "Component along s3 of the velocity change that the maneuver of the phase has still to make",
        |s| super::vector::dot(s.velocity_to_go, s.s3_e),
    )
    .within(QuantityRange::Any),
    of_debris("time_to_station_s", "Time until the current transfer reaches the station", |s| s.time_to_station)
        .within(QuantityRange::Any),
    of_debris("debris_age_s", "Time since the debris was last measured", |s| s.debris_age),
    of_debris("debris_rate_rad_s", "Magnitude of the angular velocity of the debris relative to F_e", |s| {
        s.debris_rate
    }),
];

/// A condition of a phase: an expression over [`QUANTITIES`], met if nonzero.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    pub text: String,
    expression: Expression,
    /// Index in [`QUANTITIES`] of each variable.
    quantities: Vec<usize>,
}

impl Condition {
    /// Parses `text` for a scene with or without debris.
    ///
    /// # Errors
    /// The allowed text, to follow "must be".
    pub fn parse(text: &str, has_debris: bool) -> Result<Self, String> {
        let expression = Expression::parse(text)?;
        let is_there = |quantity: &GuidanceQuantity| has_debris || !quantity.needs_debris;
        let place = |name: &String| {
            QUANTITIES.iter().position(|quantity| quantity.name == name && is_there(quantity)).ok_or_else(|| {
                let names: Vec<_> =
                    QUANTITIES.iter().filter(|quantity| is_there(quantity)).map(|quantity| quantity.name).collect();
                format!("an expression of estimated quantities ({}), not {name:?}", names.join(", "))
            })
        };
        let quantities = expression.variables().iter().map(place).collect::<Result<_, _>>()?;
        if !expression.is_condition() {
            return Err("a comparison, or several with `and` and `or`: a number alone says nothing".to_owned());
        }
        Ok(Condition { text: text.to_owned(), expression, quantities })
    }

    /// True if it uses the quantity `name`.
    pub fn asks_for(&self, name: &str) -> bool {
        self.quantities.iter().any(|quantity| QUANTITIES[*quantity].name == name)
    }

    /// Range of its value in runs of `duration` seconds, whatever the motion: 0 to 0 if it is never met, 1 to 1 if
    /// always.
    pub fn range(&self, duration: f64) -> [f64; 2] {
        self.expression.range(|variable| match QUANTITIES[self.quantities[variable]].range {
            QuantityRange::Any => [f64::NEG_INFINITY, f64::INFINITY],
            QuantityRange::NotNegative => [0.0, f64::INFINITY],
            QuantityRange::Angle => [0.0, core::f64::consts::PI],
            QuantityRange::Time => [0.0, duration],
        })
    }

    /// True if it is met; NaN meets no condition.
    pub fn is_met(&self, input: &GuidanceInput) -> bool {
        let value = self.expression.value(|variable| (QUANTITIES[self.quantities[variable]].value)(input));
        value != 0.0 && !value.is_nan()
    }
}
