//! The one table of observables: every series, direct value and column of a row.
//!
//! A row of [`Series`] has the source of a series, its needs of the state table, and its column in a time series. A row
//! of the columns has group, kinds of scene, value, name, unit and meaning. Names, order, documentation and the Parquet
//! schema follow. A new observable needs its rows here, and its series in the file of its `SeriesSource`. Handles
//! ([`ColumnId`], [`Series`]) are in this file since rows and handles refer to each other.
//!
//! An error column belongs to a signed series e(t) (energy) or the norm e(t) of an error vector (momenta), measured
//! from observation point 0. Errors are relative to the largest sum on the grid of the magnitudes of the balance's
//! terms: energies of the bodies and work, momenta of body and wheels and impulse. The sum does not vanish if the terms
//! cancel, at rest or with counter-rotating wheels; if it is exactly zero nothing moves, and the error is zero.

use core::ops::Range;

use super::group::Group;
use super::reduction::{ChangeStatistic, ErrorStatistic, OrderStatistic, Reduction, Stored, ValueStatistic};
use super::rows::{ColumnKind, Need, Scenes, SeriesSource};
use crate::run::Quantity;
use crate::scene::{MAX_WHEELS, Name};

/// A column of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// Its group.
    pub group: Group,
    /// Number or count.
    pub kind: ColumnKind,
    /// The kinds of scene that have it.
    pub(super) scenes: Scenes,
    pub(super) value: Value,
    /// Its wheel, in the columns of a request.
    pub(super) wheel: Option<u8>,
}

impl Column {
    /// The kinds of scene that have the column, in words; empty for all.
    pub const fn scenes(&self) -> &'static str {
        match self.scenes {
            Scenes::All => "",
            Scenes::Debris => "with debris",
            Scenes::Actuated => "with actuation",
            Scenes::Thrusters => "with thrusters that act",
            Scenes::ExternalTorque => "with thrusters that act or a torque on the body",
            Scenes::Motors => "with motors that act",
            Scenes::Free => "without actuation",
            Scenes::Constrained => "null-space method",
            Scenes::ConstrainedBodies => "null-space method, with wheels that turn or debris",
            Scenes::ConstrainedDebris => "null-space method, with debris",
            Scenes::IntegratedVelocity => "with thrusters that act, or null-space method",
            Scenes::Unconstrained => "not the null-space method",
            Scenes::Wheels => "with wheels that turn",
            Scenes::SeveralWheels => "with several wheels",
            Scenes::Orbit => "on an orbit",
            Scenes::GravityGradient => "with a gravity gradient",
            Scenes::MagneticTorque => "with a magnetic dipole or torque rods",
            Scenes::Drag => "with drag",
            Scenes::SolarPressure => "with solar pressure",
        }
    }

    /// True if there is one such column per turning wheel.
    pub fn is_of_wheel(&self) -> bool {
        self.quantity.name().contains(WHEEL)
    }

    pub(super) fn of_wheel(&self, index: usize, name: Name) -> Column {
        let value = self.value.of_wheel(index);
        Column { quantity: named(&self.quantity, name), value, wheel: Some(index as u8), ..self.clone() }
    }

    /// The handle of the column.
    pub const fn id(&self) -> ColumnId {
        ColumnId { group: self.group, value: self.value }
    }
}

/// Content of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// A series, reduced to a number.
    Of(Series, Reduction),
    /// A number that is not reduced from a single series, of a wheel if it is of wheels.
    Direct(DirectValue, u8),
    /// The extreme of a series in an interval of time; index among those of the request.
    Window(Series, u8),
    /// A report of a control law; index among its columns. Not from the observer.
    Law(u8),
}

/// Handle of a column: a value of a group. [`super::Request::position`] is its position in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColumnId {
    pub(super) group: Group,
    pub(super) value: Value,
}

impl ColumnId {
    /// True if there is one such column per wheel.
    pub(super) fn is_of_wheel(self) -> bool {
        all().any(|column| column.id() == self && column.is_of_wheel())
    }

    /// The handle for wheel `wheel` if it is of wheels, else itself.
    #[must_use]
    pub fn of_wheel(self, wheel: usize) -> Self {
        let value = match self.value {
            Value::Direct(..) if !self.is_of_wheel() => self.value,
            of_wheel => of_wheel.of_wheel(wheel),
        };
        ColumnId { value, ..self }
    }

    /// The name of a column that is not of wheels.
    ///
    /// # Panics
    /// If the table has no such column.
    pub fn name(self) -> &'static str {
        let column = all().find(|column| column.id() == self);
        column.expect("a handle is that of a column").quantity.name()
    }
}

/// Placeholder of a wheel's name in the name or meaning of a column.
const WHEEL: &str = "{wheel}";

fn named(quantity: &Quantity, name: Name) -> Quantity {
    let of_wheel = |text: &str| text.replace(WHEEL, name.as_str());
    Quantity::named(of_wheel(quantity.name()), quantity.unit().to_owned(), of_wheel(quantity.meaning()))
}

/// A quantity at every observation point, of a wheel if it is of wheels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Series(u8);

impl Series {
    /// Number of series, one per possible wheel.
    pub(super) const COUNT: usize = {
        let (mut count, mut kind) = (0, 0);
        while kind < PLACES.len() {
            count += PLACES[kind];
            kind += 1;
        }
        count
    };

    /// Every series, in order of a time series.
    pub fn all() -> impl Iterator<Item = Series> {
        (0..Self::COUNT).map(|index| Series(index as u8))
    }

    const fn first(kind: usize) -> Series {
        let (mut first, mut other) = (0, 0);
        while other < kind {
            first += PLACES[other];
            other += 1;
        }
        Series(first as u8)
    }

    /// Index among all series.
    #[inline(always)]
    pub(super) const fn index(self) -> usize {
        self.0 as usize
    }

    /// Indices of the series and its successors, `count` in all: of the first wheels.
    pub(super) const fn block(self, count: usize) -> Range<usize> {
        self.index()..self.index() + count
    }

    /// The series of wheel `wheel` if it is of wheels, else itself.
    pub const fn of_wheel(self, wheel: usize) -> Series {
        let (kind, _) = self.place();
        if PLACES[kind] > 1 { Series(Series::first(kind).0 + wheel as u8) } else { self }
    }

    /// Row, and place within it.
    const fn place(self) -> (usize, usize) {
        let (mut kind, mut place) = (0, self.0 as usize);
        while place >= PLACES[kind] {
            place -= PLACES[kind];
            kind += 1;
        }
        (kind, place)
    }

    pub(super) fn wheel(self) -> Option<usize> {
        let (kind, place) = self.place();
        (PLACES[kind] > 1).then_some(place)
    }

    pub(super) fn row(self) -> &'static SeriesRow {
        &SERIES[self.place().0]
    }

    /// Column of a time series with the wheels `wheels`; `None` for the scale of another series.
    pub fn quantity(self, wheels: &[Name]) -> Option<Quantity> {
        let shown = self.row().shown.as_ref()?;
        match self.wheel() {
            Some(wheel) => wheels.get(wheel).map(|name| named(shown, *name)),
            None => Some(shown.clone()),
        }
    }
}

/// Change of a body's energy about the centre of mass since the start: series, name and meaning.
pub(super) const CHANGES: [(Series, &str, &str); 2] = [
    (
        Series::ComBody,
        "exchange_body_j",
        "Change since the start in the kinetic energy of the body about the spacecraft's centre of mass.",
    ),
    (
        Series::ComWheel,
        "exchange_{wheel}_j",
        "Change since the start in the kinetic energy of wheel {wheel} about the spacecraft's centre of mass.",
    ),
];

impl Series {
    /// [`Series::quantity`], or that of its change since the start, if any.
    pub(super) fn over_time(self, is_change: bool, wheels: &[Name]) -> Option<Quantity> {
        let shown = self.quantity(wheels)?;
        if !is_change {
            return Some(shown);
        }
        let (_, name, meaning) = CHANGES.iter().find(|(series, ..)| series.place().0 == self.place().0)?;
        let change = Quantity::named((*name).to_owned(), shown.unit().to_owned(), (*meaning).to_owned());
        self.wheel().map_or(Some(change.clone()), |wheel| wheels.get(wheel).map(|wheel| named(&change, *wheel)))
    }
}

/// Handle of a reduced series.
pub const fn series_id(group: Group, series: Series, reduction: Reduction) -> ColumnId {
    ColumnId { group, value: Value::Of(series, reduction) }
}

/// Handle of a statistic of an error.
pub const fn error_id(group: Group, series: Series, statistic: ErrorStatistic) -> ColumnId {
    series_id(group, series, Reduction::Error(statistic))
}

/// Handle of a direct value.
pub const fn direct_id(group: Group, value: DirectValue) -> ColumnId {
    ColumnId { group, value: Value::Direct(value, 0) }
}

pub(super) struct SeriesRow {
    /// Its computation.
    pub(super) source: SeriesSource,
    /// Form of its numbers.
    pub(super) stored: Stored,
    /// Series and statistic by which its values are divided.
    pub(super) scale: Option<(Series, Reduction)>,
    /// Source of its values.
    pub(super) needs: &'static [&'static [Need]],
    /// Its column in a time series, if any.
    pub(super) shown: Option<Quantity>,
}

pub(super) struct DirectRow {
    /// Needs in addition to those of its series.
    pub(super) needs: &'static [Need],
    /// Statistics from which it is computed.
    pub(super) inputs: &'static [(Series, Reduction)],
    /// True if known after a failure.
    pub(super) after_failure: bool,
}

const MAX: Reduction = Reduction::Order(OrderStatistic::Max);
const SWING: Reduction = Reduction::Value(ValueStatistic::PeakToPeak);
const MEAN: Reduction = Reduction::Value(ValueStatistic::Mean);

pub(super) const FRACTION_SCALE: (Series, Reduction) = (Series::ComTotal, MAX);

const CORRELATION: &[(Series, Reduction)] = &[
    FRACTION_SCALE,
    (Series::ComBody, SWING),
    (Series::ComBody, MEAN),
    (Series::ComWheel, SWING),
    (Series::ComWheel, MEAN),
];
const FREQUENCY: &[(Series, Reduction)] = &[FRACTION_SCALE, (Series::ComBody, SWING), (Series::ComBody, MEAN)];

#[rustfmt::skip]
mod needs {
    //! Needs of values, with purposes.

    use crate::observables::rows::{Need, Scenes, need};
    use crate::run::StateField;

    pub(super) const SPIN: &[Need] = &[
        need(StateField::Rate, Scenes::All, "rotation of the body"),
        need(StateField::WheelRates, Scenes::All, "rotation of the wheels"),
    ];
    pub(super) const BODIES: &[Need] = &[
        need(StateField::ComVelocity, Scenes::All, "energies in F_e"),
        need(StateField::Dcm, Scenes::Constrained, "velocities of bodies off the centre of mass"),
        need(StateField::Attitude, Scenes::Unconstrained, "velocities of bodies off the centre of mass"),
    ];
    pub(super) const TOTAL: &[Need] = &[need(StateField::ComVelocity, Scenes::All, "total energy in F_e")];
    pub(super) const REDUNDANT: &[Need] = &[need(StateField::KineticEnergies, Scenes::Constrained,
        "energies of the redundant states")];
    pub(super) const DEBRIS_ENERGY: &[Need] = &[
        need(StateField::DebrisVelocity, Scenes::Debris, "energy of the debris"),
        need(StateField::DebrisRate, Scenes::Debris, "energy of the debris"),
    ];
    pub(super) const WORK: &[Need] = &[need(StateField::Work, Scenes::Actuated,
        "work of actuators and torques on the body")];
    pub(super) const LINEAR: &[Need] = &[
        need(StateField::ComVelocity, Scenes::All, "linear momentum"),
        need(StateField::Impulse, Scenes::Thrusters, "impulse of the thrusters"),
        need(StateField::Rate, Scenes::Constrained, "velocity of p about the centre of mass"),
        need(StateField::Dcm, Scenes::Constrained, "velocity of p about the centre of mass"),
    ];
    pub(super) const ANGULAR: &[Need] = &[
        need(StateField::Dcm, Scenes::Constrained, "angular momentum in F_e"),
        need(StateField::Attitude, Scenes::Unconstrained, "angular momentum in F_e"),
        need(StateField::AngularImpulse, Scenes::ExternalTorque,
            "angular impulse of thrusters and torques on the body"),
    ];
    pub(super) const DEBRIS_LINEAR: &[Need] = &[need(StateField::DebrisVelocity, Scenes::Debris,
        "linear momentum of the debris")];
    pub(super) const DEBRIS_ANGULAR: &[Need] = &[
        need(StateField::DebrisRate, Scenes::Debris, "angular momentum of the debris"),
        need(StateField::DebrisAttitude, Scenes::Debris, "angular momentum of the debris in F_e"),
    ];
    pub(super) const ORTHONORMALITY: &[Need] = &[
        need(StateField::Dcm, Scenes::Constrained, "departure from a rotation"),
        need(StateField::Attitude, Scenes::Unconstrained, "departure from a rotation"),
    ];
    pub(super) const SPIN_AXIS: &[Need] = &[
        need(StateField::Dcm, Scenes::Constrained, "direction of s3"),
        need(StateField::Attitude, Scenes::Unconstrained, "direction of s3"),
    ];
    pub(super) const RATE: &[Need] = &[need(StateField::Rate, Scenes::All, "angular rate")];
    pub(super) const FROM_NOMINAL: &[Need] = &[need(StateField::Attitude, Scenes::All,
        "attitude relative to the nominal run")];
    pub(super) const FROM_INITIAL: &[Need] = &[need(StateField::Attitude, Scenes::All,
        "attitude relative to the initial one")];
    pub(super) const DEBRIS_DIRECTION: &[Need] = &[
        need(StateField::ComPosition, Scenes::Debris, "direction of the debris"),
        need(StateField::DebrisPosition, Scenes::Debris, "direction of the debris"),
    ];
    pub(super) const ORBIT: &[Need] = &[
        need(StateField::ComPosition, Scenes::Orbit, "place on the orbit"),
        need(StateField::Dcm, Scenes::Constrained, "direction of nadir in the body"),
        need(StateField::Attitude, Scenes::Unconstrained, "direction of nadir in the body"),
    ];
    pub(super) const MAGNETISM: &[Need] = &[
        need(StateField::ComPosition, Scenes::MagneticTorque, "place in the magnetic field"),
        need(StateField::Attitude, Scenes::MagneticTorque, "direction of the magnetic field in the body"),
    ];
    pub(super) const AIR: &[Need] = &[
        need(StateField::ComPosition, Scenes::Drag, "density of the air"),
        need(StateField::ComVelocity, Scenes::Drag, "velocity relative to the air"),
        need(StateField::Attitude, Scenes::Drag, "plates in the flow"),
    ];
    pub(super) const LIGHT: &[Need] = &[
        need(StateField::ComPosition, Scenes::SolarPressure, "shadow of the Earth"),
        need(StateField::Attitude, Scenes::SolarPressure, "plates in the light"),
    ];
    pub(super) const RESIDUALS: &[Need] = &[need(StateField::Residuals, Scenes::Constrained,
        "residuals of the constraints")];
    pub(super) const FINAL_STATE: &[Need] = &[
        need(StateField::Attitude, Scenes::All, "attitude at the end"),
        need(StateField::Rate, Scenes::All, "angular velocity at the end"),
        need(StateField::WheelRates, Scenes::All, "wheel rates at the end"),
    ];
    pub(super) const DEBRIS_NUMERICS: &[Need] = &[
        need(StateField::DebrisRate, Scenes::Debris, "how the motion amplifies errors"),
        need(StateField::DebrisAttitude, Scenes::Debris, "errors of the attitude"),
    ];
    // a method's own errors of the attitude are known only if it is integrated
    pub(super) const NUMERICS: &[Need] = &[
        need(StateField::Rate, Scenes::All, "how the motion amplifies errors"),
        need(StateField::WheelRates, Scenes::All, "how the motion amplifies errors"),
        need(StateField::Attitude, Scenes::All, "errors of the attitude"),
    ];
}
use needs::{
    AIR, ANGULAR, BODIES, DEBRIS_ANGULAR, DEBRIS_DIRECTION, DEBRIS_ENERGY, DEBRIS_LINEAR, DEBRIS_NUMERICS, FINAL_STATE,
    FROM_INITIAL, FROM_NOMINAL, LIGHT, LINEAR, MAGNETISM, NUMERICS, ORBIT, ORTHONORMALITY, RATE, REDUNDANT, RESIDUALS,
    SPIN, SPIN_AXIS, TOTAL, WORK,
};

#[rustfmt::skip]
series! {
    EnergyBody [1]: Energies, Quantity, None, [SPIN, BODIES, REDUNDANT], Some(("energy_body_j", "J")),
        "Kinetic energy of the body in F_e.";
    EnergyWheel [MAX_WHEELS]: Energies, Quantity, None, [SPIN, BODIES, REDUNDANT], Some(("energy_{wheel}_j", "J")),
        "Kinetic energy of wheel {wheel} in F_e.";
    EnergyDebris [1]: Energies, Quantity, None, [SPIN, DEBRIS_ENERGY], Some(("energy_debris_j", "J")),
        "Kinetic energy of the debris in F_e.";
    EnergyTotal [1]: Energies, Quantity, None, [SPIN, TOTAL, REDUNDANT, DEBRIS_ENERGY], Some(("energy_total_j",
        "J")), "Total kinetic energy (including the debris) in F_e.";
    ComBody [1]: Energies, Quantity, None, [SPIN], Some(("energy_com_body_j", "J")),
        "Kinetic energy of the body about the spacecraft's centre of mass.";
    ComWheel [MAX_WHEELS]: Energies, Quantity, None, [SPIN], Some(("energy_com_{wheel}_j", "J")),
        "Kinetic energy of wheel {wheel} about the spacecraft's centre of mass.";
    ComWheels [1]: Energies, Quantity, None, [SPIN], Some(("energy_com_wheels_j", "J")),
        "Kinetic energy of all wheels together about the spacecraft's centre of mass.";
    ComTotal [1]: Energies, Quantity, None, [SPIN], Some(("energy_com_total_j", "J")),
        "Kinetic energy of the spacecraft about its centre of mass.";
    EnergyError [1]: Energies, Quantity, Some((Series::EnergyTerms, MAX)), [SPIN, TOTAL, REDUNDANT, DEBRIS_ENERGY,
        WORK], Some(("energy_error", "")), "Change in total kinetic energy minus the work of actuators and torques on \
            the body, relative to the largest sum of their magnitudes.";
    EnergyTerms [1]: Energies, Quantity, None, [SPIN, TOTAL, REDUNDANT, DEBRIS_ENERGY, WORK], NOT_SHOWN,
        "Total kinetic energy plus the magnitudes of all work, J.";
    ComError [1]: Energies, Quantity, Some((Series::ComTotal, MAX)), [SPIN], Some(("energy_com_error", "")),
        "Change in the kinetic energy about the centre of mass, relative to its largest value (without actuators).";
    LinearMomentumError [1]: LinearMomentum, Quantity, Some((Series::LinearMomentumTerms, MAX)), [LINEAR],
        Some(("linear_momentum_error", "")), "Change in the spacecraft's linear momentum minus the impulse, relative \
            to the largest sum of their magnitudes.";
    LinearMomentumTerms [1]: LinearMomentum, Quantity, None, [LINEAR], NOT_SHOWN,
        "Magnitudes of the terms of linear momentum and of the impulse added, N s.";
    LinearMomentumSquare [1]: LinearMomentum, Square, None, [LINEAR], Some(("linear_momentum_n_s", "N s")),
        "Magnitude of the spacecraft's linear momentum in F_e.";
    AngularMomentumError [1]: AngularMomentum, Quantity, Some((Series::AngularMomentumTerms, MAX)), [SPIN, ANGULAR],
        Some(("angular_momentum_error", "")), "Change in the spacecraft's angular momentum about its centre of mass in \
            F_e minus the angular impulse of thrusters and torques on the body, relative to the largest sum of the \
            magnitudes of the momenta of body and wheels and of the impulse.";
    AngularMomentumTerms [1]: AngularMomentum, Quantity, None, [SPIN, ANGULAR], NOT_SHOWN,
        "Magnitudes of the angular momenta of body and wheels and of the angular impulse added, N m s.";
    AngularMomentumSquare [1]: AngularMomentum, Square, None, [SPIN, ANGULAR], Some(("angular_momentum_n_m_s",
        "N m s")), "Magnitude of the spacecraft's angular momentum about its centre of mass.";
    DebrisLinearError [1]: DebrisMomenta, Quantity, Some((Series::DebrisLinearSquare, MAX)), [DEBRIS_LINEAR,
        DEBRIS_ANGULAR], Some(("debris_linear_momentum_error", "")),
            "Change in the debris's linear momentum, relative to the largest.";
    DebrisLinearSquare [1]: DebrisMomenta, Square, None, [DEBRIS_LINEAR, DEBRIS_ANGULAR], NOT_SHOWN,
        "Square of the debris's linear momentum, N^2 s^2.";
    DebrisAngularError [1]: DebrisMomenta, Quantity, Some((Series::DebrisAngularSquare, MAX)), [DEBRIS_LINEAR,
        DEBRIS_ANGULAR], Some(("debris_angular_momentum_error", "")),
            "Change in the debris's angular momentum about its centre in F_e, relative to the largest.";
    DebrisAngularSquare [1]: DebrisMomenta, Square, None, [DEBRIS_LINEAR, DEBRIS_ANGULAR], NOT_SHOWN,
        "Square of the debris's angular momentum about its centre, N^2 m^2 s^2.";
    Orthonormality [1]: Attitude, Quantity, None, [ORTHONORMALITY], Some(("dcm_orthonormality", "")),
        "Largest entry of |C_es^T C_es - 1|.";
    SpinAxisAngle [1]: Attitude, HalfTangentSquare, None, [SPIN_AXIS], Some(("spin_axis_angle_rad", "rad")),
        "Angle of s3 from its initial direction in F_e.";
    ResidualKinematic [1]: Residuals, Quantity, None, [RESIDUALS], Some(("residual_kinematic_m_s", "m/s")),
        "Residual of the kinematic constraints (angular components in rad/s).";
    ResidualCollocation [1]: Residuals, Quantity, None, [RESIDUALS], Some(("residual_collocation_m", "m")),
        "Residual of the collocation constraints (tilts of wheel axes as sines).";
    ResidualAttitude [1]: Residuals, Quantity, None, [RESIDUALS], Some(("residual_attitude", "")),
        "Residual of the attitude constraints.";
    RateSquare [1]: Motion, Square, None, [RATE], Some(("angular_rate_rad_s", "rad/s")),
        "Magnitude of the angular velocity of the body relative to F_e.";
    Nutation [1]: Motion, Quantity, None, [SPIN], Some(("nutation_angle_rad", "rad")), "Angle between s3 (or \
        observe.nutation_axis) and the angular momentum of the spacecraft about its centre of mass.";
    FromNominal [1]: Motion, HalfTangentSquare, None, [FROM_NOMINAL], Some(("attitude_from_nominal_rad", "rad")),
        "Rotation angle between the attitude and that of the nominal run at the same time.";
    FromInitial [1]: Motion, HalfTangentSquare, None, [FROM_INITIAL], Some(("attitude_from_initial_rad", "rad")),
        "Rotation angle between the attitude and the initial attitude of the run.";
    WheelSpeed [MAX_WHEELS]: Motion, Square, None, [SPIN], Some(("speed_{wheel}_rad_s", "rad/s")),
        "Magnitude of the rate of wheel {wheel} relative to the body.";
    WheelMomentum [MAX_WHEELS]: Motion, Square, None, [SPIN], Some(("momentum_{wheel}_n_m_s", "N m s")),
        "Magnitude of the angular momentum of wheel {wheel} about its axis relative to F_e.";
    DebrisDirection [1]: Motion, Quantity, None, [SPIN_AXIS, DEBRIS_DIRECTION], Some(("spin_axis_debris_angle_rad",
        "rad")), "Angle between s3 and the line from the spacecraft's centre of mass to the debris (0 where they \
        coincide).";
    OrbitDistance [1]: Orbit, Quantity, None, [ORBIT], Some(("orbit_distance_m", "m")),
        "Distance of the spacecraft's centre of mass from the centre of the central body.";
    NadirAngle [1]: Orbit, Quantity, None, [ORBIT], Some(("nadir_angle_rad", "rad")),
        "Angle between s3 and nadir, the direction from the spacecraft's centre of mass to the central body.";
    GradientTorqueSquare [1]: Orbit, Square, None, [ORBIT], Some(("gravity_gradient_torque_n_m", "N m")),
        "Magnitude of the torque of the gravity gradient on the spacecraft.";
    FieldStrength [1]: Orbit, Quantity, None, [MAGNETISM], Some(("magnetic_field_t", "T")),
        "Magnitude of the Earth's magnetic field at the spacecraft.";
    MagneticTorqueSquare [1]: Orbit, Square, None, [MAGNETISM], Some(("magnetic_torque_n_m", "N m")),
        "Magnitude of the torque of the magnetic field on the residual dipole and the torque rods of the spacecraft.";
    AirDensity [1]: Surroundings, Quantity, None, [AIR], Some(("air_density_kg_m3", "kg/m^3")),
        "Air density at the spacecraft.";
    DragTorqueSquare [1]: Surroundings, Square, None, [AIR], Some(("drag_torque_n_m", "N m")),
        "Magnitude of the torque of the air on the spacecraft.";
    SunHidden [1]: Surroundings, Quantity, None, [LIGHT], Some(("sun_hidden_fraction", "")),
        "Fraction of the Sun's disc that the Earth hides: 0 in full light, 1 in full shadow.";
    SolarTorqueSquare [1]: Surroundings, Square, None, [LIGHT], Some(("solar_pressure_torque_n_m", "N m")),
        "Magnitude of the torque of sunlight on the spacecraft.";
    PointingError [1]: Law, Quantity, None, [], Some(("pointing_error_rad", "rad")), "Rotation angle from the true \
        attitude to the target of the phase, at the last tick of the control loop; null in a phase without a target.";
    AttitudeEstimateError [1]: Law, Quantity, None, [], Some(("attitude_estimate_error_rad", "rad")),
        "Angle between estimated and true attitude, at the last tick of the control loop.";
    RateEstimateError [1]: Law, Quantity, None, [], Some(("rate_estimate_error_rad_s", "rad/s")),
        "Magnitude of the error in the estimated angular velocity, at the last tick of the control loop.";
    PositionEstimateError [1]: Law, Quantity, None, [], Some(("relative_position_estimate_error_m", "m")),
        "Distance between estimated and true position relative to the debris, at the last tick of the control loop.";
    VelocityEstimateError [1]: Law, Quantity, None, [], Some(("relative_velocity_estimate_error_m_s", "m/s")),
        "Magnitude of the error in the estimated velocity relative to the debris, at the last tick of the control \
        loop.";
    DebrisDistance [1]: Law, Quantity, None, [], Some(("debris_distance_m", "m")),
        "Distance from the spacecraft's centre of mass to the debris's, at the last tick of the control loop.";
    DebrisSpeed [1]: Law, Quantity, None, [], Some(("debris_relative_speed_m_s", "m/s")),
        "Speed of the spacecraft's centre of mass relative to the debris's, at the last tick of the control loop.";
    Impulse [1]: Law, Quantity, None, [], Some(("impulse_n_s", "N s")),
        "Sum of the impulses of all thrusters since the start, at the last tick of the control loop.";
    MotorTorque [MAX_WHEELS]: Law, Quantity, None, [], Some(("torque_{wheel}_n_m", "N m")),
        "Torque of motor and bearing on wheel {wheel} along its axis, within limits, as the control loop applies it.";
}

/// No column in a time series: a scale.
const NOT_SHOWN: Option<(&str, &str)> = None;

#[rustfmt::skip]
direct_values! {
    WorkThrusters: WORK, &[], false, "Work of the thrusters and of torques on the body, J.";
    WorkMotors: WORK, &[], false, "Work of the wheel motors, J.";
    Correlation: &[], CORRELATION, false, "Correlation of the energies of body and wheel.";
    ExchangeFrequency: &[], FREQUENCY, false, "Dominant frequency of the body's energy, Hz.";
    TimeReached: &[], &[], true, "Time that the integration reached, s.";
    TimeFinal: FINAL_STATE, &[], true, "Time of the last finite state, s.";
    AttitudeW: FINAL_STATE, &[], true, "Scalar part of the attitude quaternion at the final time.";
    AttitudeX: FINAL_STATE, &[], true, "First vector part of the attitude quaternion at the final time.";
    AttitudeY: FINAL_STATE, &[], true, "Second vector part of the attitude quaternion at the final time.";
    AttitudeZ: FINAL_STATE, &[], true, "Third vector part of the attitude quaternion at the final time.";
    RateX: FINAL_STATE, &[], true, "Angular velocity about s1 at the final time, rad/s.";
    RateY: FINAL_STATE, &[], true, "Angular velocity about s2 at the final time, rad/s.";
    RateZ: FINAL_STATE, &[], true, "Angular velocity about s3 at the final time, rad/s.";
    WheelRate: FINAL_STATE, &[], true, "Rate of a wheel at the final time, rad/s.";
    Steps: &[], &[], true, "Accepted steps.";
    Rejected: &[], &[], true, "Rejected steps.";
    Evaluations: &[], &[], true, "Evaluations of the right-hand side.";
    StateError: NUMERICS, &[], false, "Estimated error of the rotational state.";
    Amplification: NUMERICS, &[], false, "Estimated factor by which the motion amplifies errors.";
    IllConditioned: NUMERICS, &[], false, "1 where the rounding of the input alone makes the result meaningless.";
    DebrisStateError: DEBRIS_NUMERICS, &[], false, "Estimated error of the rotation of the debris.";
    DebrisAmplification: DEBRIS_NUMERICS, &[], false,
        "Estimated factor by which the motion of the debris amplifies errors.";
    DebrisIllConditioned: DEBRIS_NUMERICS, &[], false,
        "1 where the rounding of the input alone makes the rotation of the debris meaningless.";
    Mass: &[], &[], true, "Mass of the spacecraft, kg.";
    CenterX: &[], &[], true, "Centre of mass of the spacecraft from p along s1, m.";
    CenterY: &[], &[], true, "Centre of mass of the spacecraft from p along s2, m.";
    CenterZ: &[], &[], true, "Centre of mass of the spacecraft from p along s3, m.";
    SmallestMoment: &[], &[], true, "Smallest principal moment of inertia of the spacecraft about its centre of mass, \
        kg m^2.";
    MiddleMoment: &[], &[], true, "Middle principal moment of inertia of the spacecraft about its centre of mass, kg \
        m^2.";
    LargestMoment: &[], &[], true, "Largest principal moment of inertia of the spacecraft about its centre of mass, kg \
        m^2.";
}

/// The columns by family, in order of a row.
#[rustfmt::skip]
static FAMILIES: &[&[Column]] = &[
    errors!(EnergyConservation, All, EnergyError, "energy_error", "the error in total kinetic energy minus the work of \
        actuators and torques on the body, relative to the largest sum of the energies of all bodies and the \
        magnitudes of the work."),
    scales!(EnergyConservation, All, EnergyTotal, "energy_total", ["J", "_j"],
        "total kinetic energy (including the debris) in F_e"),
    &[
        direct!(EnergyConservation, ExternalTorque, Float, WorkThrusters, "work_thrusters_final_j", "J", "Work done up \
            to the last point by the thrusters and by the torques on the body that the environment or a control law \
            applies; on an orbit also by gravity, including its work on the debris."),
        direct!(EnergyConservation, Motors, Float, WorkMotors, "work_motors_final_j", "J",
            "Work done by the wheel motors up to the last point."),
    ],
    errors!(MomentumConservation, IntegratedVelocity, LinearMomentumError, "linear_momentum_error", "the error vector \
        of the spacecraft's linear momentum minus the impulse, relative to the largest sum of the magnitudes of its \
        terms and the impulse."),
    scales!(MomentumConservation, All, LinearMomentumSquare, "linear_momentum", ["N s", "_n_s"],
        "|p| of the spacecraft"),
    errors!(MomentumConservation, All, AngularMomentumError, "angular_momentum_error", "the error vector of the \
        spacecraft's angular momentum about its centre of mass in F_e minus the angular impulse of thrusters and \
        torques on the body, relative to the largest sum of the magnitudes of the momenta of body (|J omega|) and \
        wheels (|J_i Omega_i|) and of the impulse."),
    scales!(MomentumConservation, All, AngularMomentumSquare, "angular_momentum", ["N m s", "_n_m_s"],
        "|L| of the spacecraft about its centre of mass"),
    errors!(MomentumConservation, ConstrainedDebris, DebrisLinearError, "debris_linear_momentum_error",
        "the error vector of the debris's linear momentum, relative to the largest |p|."),
    scales!(MomentumConservation, Debris, DebrisLinearSquare, "debris_linear_momentum", ["N s", "_n_s"],
        "|p| of the debris"),
    errors!(MomentumConservation, Debris, DebrisAngularError, "debris_angular_momentum_error",
        "the error vector of the debris's angular momentum about its centre in F_e, relative to the largest |L|."),
    scales!(MomentumConservation, Debris, DebrisAngularSquare, "debris_angular_momentum", ["N m s", "_n_m_s"],
        "|L| of the debris about its centre"),
    errors!(Attitude, All, Orthonormality, "dcm_orthonormality", "the largest entry of |C_es^T C_es - 1|."),
    &[
        of!(Attitude, All, SpinAxisAngle, Order(OrderStatistic::Max), ["spin_axis_angle_max_rad"], "rad",
            ["Maximum angle of s3 from its initial direction in F_e."]),
        of!(Attitude, All, SpinAxisAngle, Order(OrderStatistic::Final), ["spin_axis_angle_final_rad"], "rad",
            ["Angle of s3 from its initial direction in F_e at the last point."]),
    ],
    errors!(Constraints, ConstrainedBodies, ResidualKinematic, "residual_kinematic", ["m/s", "_m_s"], ["m/s^2",
        "_m_s2"], "the residual of the kinematic constraints (angular components in rad/s)."),
    errors!(Constraints, ConstrainedBodies, ResidualCollocation, "residual_collocation", ["m", "_m"], ["m/s",
        "_m_s"], "the residual of the collocation constraints (tilts of wheel axes as sines)."),
    errors!(Constraints, Constrained, ResidualAttitude, "residual_attitude",
        "the residual of the attitude constraints."),
    energies!(Energies, All, EnergyBody, "energy_body", "kinetic energy of the body in F_e"),
    energies!(Energies, Wheels, EnergyWheel, "energy_{wheel}", "kinetic energy of wheel {wheel} in F_e"),
    energies!(Energies, Debris, EnergyDebris, "energy_debris", "kinetic energy of the debris in F_e"),
    energies!(EnergiesCom, All, ComBody, "energy_com_body",
        "kinetic energy of the body about the spacecraft's centre of mass"),
    energies!(EnergiesCom, Wheels, ComWheel, "energy_com_{wheel}",
        "kinetic energy of wheel {wheel} about the spacecraft's centre of mass"),
    energies!(EnergiesCom, SeveralWheels, ComWheels, "energy_com_wheels",
        "kinetic energy of all wheels together about the spacecraft's centre of mass"),
    scales!(EnergiesCom, All, ComTotal, "energy_com_total", ["J", "_j"],
        "kinetic energy of the spacecraft about its centre of mass"),
    errors!(EnergiesCom, Free, ComError, "energy_com_error", "the change in the kinetic energy about the centre of \
        mass, relative to its largest value (only without actuation)."),
    exchange!(ComBody, Wheels, "body", "the body"),
    exchange!(ComWheel, Wheels, "{wheel}", "wheel {wheel}"),
    exchange!(ComWheels, SeveralWheels, "wheels", "all wheels together"),
    &[direct!(Exchange, Wheels, Float, Correlation, "exchange_{wheel}_correlation", "", "Correlation over the points \
        between the energies of the body and of wheel {wheel} about the centre of mass (0 if one of them is \
        constant).")],
    &[
        direct!(Exchange, Wheels, Float, ExchangeFrequency, "exchange_frequency_hz", "Hz", "Dominant frequency of the \
            body's energy about the centre of mass (null if it is constant, if its spectrum has no peak, or if the \
            grid is uneven)."),
        direct!(FinalState, All, Float, TimeReached, "time_reached_s", "s", "Time up to which the run was integrated."),
        direct!(FinalState, All, Float, TimeFinal, "time_final_s", "s",
            "Time of the last finite state at an observation point; the other columns of this group show that state."),
        direct!(FinalState, All, Float, AttitudeW, "q_es_w_final", "",
            "Attitude quaternion, scalar part, at the final time."),
        direct!(FinalState, All, Float, AttitudeX, "q_es_x_final", "",
            "Attitude quaternion, first vector part, at the final time."),
        direct!(FinalState, All, Float, AttitudeY, "q_es_y_final", "",
            "Attitude quaternion, second vector part, at the final time."),
        direct!(FinalState, All, Float, AttitudeZ, "q_es_z_final", "",
            "Attitude quaternion, third vector part, at the final time."),
        direct!(FinalState, All, Float, RateX, "omega_se_s_x_final_rad_s", "rad/s",
            "Angular velocity of the body about s1 at the final time."),
        direct!(FinalState, All, Float, RateY, "omega_se_s_y_final_rad_s", "rad/s",
            "Angular velocity of the body about s2 at the final time."),
        direct!(FinalState, All, Float, RateZ, "omega_se_s_z_final_rad_s", "rad/s",
            "Angular velocity of the body about s3 at the final time."),
    ],
    &[direct!(FinalState, Wheels, Float, WheelRate, "rate_{wheel}_final_rad_s", "rad/s",
    "Rate of wheel {wheel} relative to the body at the final time.")],
    &[
        direct!(StepStatistics, All, Count, Steps, "steps", "", "Accepted steps."),
        direct!(StepStatistics, All, Count, Rejected, "steps_rejected", "", "Rejected steps."),
        direct!(StepStatistics, All, Count, Evaluations, "evaluations", "",
            "Evaluations of the right-hand side (for Taylor methods: jets)."),
        direct!(Numerics, All, Float, StateError, "state_error_estimate", "", "Estimated largest error in the body's \
            rotation on the grid: in omega relative to the largest |omega| (or to one radian over the duration if that \
            is more), or in the attitude in rad, whichever is larger."),
        direct!(Numerics, All, Float, Amplification, "error_amplification", "", "Estimated factor by which the motion \
            amplifies relative errors in the rotational state that arise evenly along the run."),
        direct!(Numerics, All, Count, IllConditioned, "ill_conditioned", "", "1 if the rounding of the input alone may \
            move the state by more than 1e-3 (error_amplification times 2^-52), else 0."),
        direct!(Numerics, Debris, Float, DebrisStateError, "debris_state_error_estimate", "", "Estimated largest error \
            in the debris's rotation on the grid: in omega relative to the largest |omega| (or to one radian over the \
            duration if that is more), or in the attitude in rad, whichever is larger."),
        direct!(Numerics, Debris, Float, DebrisAmplification, "debris_error_amplification", "", "Estimated factor by \
            which the motion of the debris amplifies relative errors in its rotational state that arise evenly along \
            the run."),
        direct!(Numerics, Debris, Count, DebrisIllConditioned, "debris_ill_conditioned", "", "1 if the rounding of the \
            input alone may move the rotation of the debris by more than 1e-3 (debris_error_amplification times \
            2^-52), else 0."),
    ],
    &[
        of!(Motion, All, RateSquare, Order(OrderStatistic::Max), ["angular_rate_max_rad_s"], "rad/s",
            ["Maximum magnitude of the angular velocity of the body relative to F_e."]),
        of!(Motion, All, RateSquare, Order(OrderStatistic::Final), ["angular_rate_final_rad_s"], "rad/s",
            ["Magnitude of the angular velocity of the body relative to F_e at the last point."]),
        of!(Motion, All, Nutation, Value(ValueStatistic::Max), ["nutation_angle_max_rad"], "rad", ["Maximum angle \
            between s3 (or observe.nutation_axis) and the angular momentum of the spacecraft about its centre of \
            mass."]),
        of!(Motion, All, Nutation, Value(ValueStatistic::Min), ["nutation_angle_min_rad"], "rad", ["Minimum angle \
            between s3 (or observe.nutation_axis) and the angular momentum of the spacecraft about its centre of \
            mass."]),
        of!(Motion, All, Nutation, Value(ValueStatistic::Mean), ["nutation_angle_mean_rad"], "rad", ["Mean over the \
            points of the angle between s3 (or observe.nutation_axis) and the angular momentum of the spacecraft about \
            its centre of mass."]),
        of!(Motion, All, FromNominal, Order(OrderStatistic::Max), ["attitude_from_nominal_max_rad"], "rad",
            ["Maximum rotation angle between the attitude and that of the nominal run at the same time."]),
        of!(Motion, All, FromNominal, Order(OrderStatistic::Final), ["attitude_from_nominal_final_rad"], "rad",
            ["Rotation angle between the attitude and that of the nominal run at the last point."]),
        of!(Motion, All, FromInitial, Order(OrderStatistic::Max), ["attitude_from_initial_max_rad"], "rad",
            ["Maximum rotation angle between the attitude and the initial attitude of the run."]),
        of!(Motion, All, FromInitial, Order(OrderStatistic::Final), ["attitude_from_initial_final_rad"], "rad",
            ["Rotation angle between the attitude at the last point and the initial attitude of the run."]),
    ],
    &[of!(Motion, Wheels, WheelSpeed, Order(OrderStatistic::Max), ["speed_{wheel}_max_rad_s"], "rad/s",
    ["Maximum magnitude of the rate of wheel {wheel} relative to the body."])],
    &[of!(Motion, Wheels, WheelMomentum, Order(OrderStatistic::Max), ["momentum_{wheel}_max_n_m_s"], "N m s",
    ["Maximum magnitude of the angular momentum of wheel {wheel} about its axis relative to F_e."])],
    &[
        of!(Motion, Debris, DebrisDirection, Value(ValueStatistic::Max), ["spin_axis_debris_angle_max_rad"], "rad",
            ["Maximum angle between s3 and the line from the spacecraft's centre of mass to the debris."]),
        of!(Motion, Debris, DebrisDirection, Value(ValueStatistic::Min), ["spin_axis_debris_angle_min_rad"], "rad",
            ["Minimum angle between s3 and the line from the spacecraft's centre of mass to the debris."]),
        of!(Motion, Debris, DebrisDirection, Value(ValueStatistic::Final), ["spin_axis_debris_angle_final_rad"],
            "rad", ["Angle between s3 and the line from the spacecraft's centre of mass to the debris at the last \
            point."]),
    ],
    &[
        direct!(MassProperties, All, Float, Mass, "mass_kg", "kg", "Mass of the spacecraft with its wheels."),
        direct!(MassProperties, All, Float, CenterX, "center_of_mass_x_m", "m",
            "Centre of mass of the spacecraft from p, component along s1."),
        direct!(MassProperties, All, Float, CenterY, "center_of_mass_y_m", "m",
            "Centre of mass of the spacecraft from p, component along s2."),
        direct!(MassProperties, All, Float, CenterZ, "center_of_mass_z_m", "m",
            "Centre of mass of the spacecraft from p, component along s3."),
        direct!(MassProperties, All, Float, SmallestMoment, "principal_moment_smallest_kg_m2", "kg m^2",
            "Smallest principal moment of inertia of the spacecraft about its centre of mass, with locked wheels."),
        direct!(MassProperties, All, Float, MiddleMoment, "principal_moment_middle_kg_m2", "kg m^2",
            "Middle principal moment of inertia of the spacecraft about its centre of mass, with locked wheels."),
        direct!(MassProperties, All, Float, LargestMoment, "principal_moment_largest_kg_m2", "kg m^2",
            "Largest principal moment of inertia of the spacecraft about its centre of mass, with locked wheels."),
    ],
    &[
        of!(Orbit, Orbit, OrbitDistance, Value(ValueStatistic::Min), ["orbit_distance_min_m"], "m",
            ["Minimum distance of the spacecraft's centre of mass from the centre of the central body on the grid."]),
        of!(Orbit, Orbit, OrbitDistance, Value(ValueStatistic::Max), ["orbit_distance_max_m"], "m",
            ["Maximum distance of the spacecraft's centre of mass from the centre of the central body on the grid."]),
        of!(Orbit, Orbit, NadirAngle, Value(ValueStatistic::Max), ["nadir_angle_max_rad"], "rad",
            ["Maximum angle between s3 and nadir on the grid."]),
        of!(Orbit, Orbit, NadirAngle, Value(ValueStatistic::Mean), ["nadir_angle_mean_rad"], "rad",
            ["Mean over the points of the angle between s3 and nadir."]),
        of!(Orbit, Orbit, NadirAngle, Value(ValueStatistic::Final), ["nadir_angle_final_rad"], "rad",
            ["Angle between s3 and nadir at the last point."]),
        of!(Orbit, GravityGradient, GradientTorqueSquare, Order(OrderStatistic::Max),
            ["gravity_gradient_torque_max_n_m"], "N m",
            ["Maximum magnitude of the gravity-gradient torque on the grid."]),
        of!(Orbit, MagneticTorque, FieldStrength, Value(ValueStatistic::Max), ["magnetic_field_max_t"], "T",
            ["Maximum magnitude of the Earth's magnetic field on the grid."]),
        of!(Orbit, MagneticTorque, FieldStrength, Value(ValueStatistic::Mean), ["magnetic_field_mean_t"], "T",
            ["Mean over the points of the magnitude of the Earth's magnetic field."]),
        of!(Orbit, MagneticTorque, MagneticTorqueSquare, Order(OrderStatistic::Max), ["magnetic_torque_max_n_m"], "N \
            m", ["Maximum magnitude of the magnetic torque on the residual dipole and the torque rods, on the grid."]),
        of!(Orbit, Drag, AirDensity, Value(ValueStatistic::Max), ["air_density_max_kg_m3"], "kg/m^3",
            ["Maximum air density at the spacecraft on the grid."]),
        of!(Orbit, Drag, AirDensity, Value(ValueStatistic::Mean), ["air_density_mean_kg_m3"], "kg/m^3",
            ["Mean over the points of the air density at the spacecraft."]),
        of!(Orbit, Drag, DragTorqueSquare, Order(OrderStatistic::Max), ["drag_torque_max_n_m"], "N m",
            ["Maximum magnitude of the drag torque on the grid."]),
        of!(Orbit, SolarPressure, SunHidden, Value(ValueStatistic::Mean), ["eclipse_fraction"], "",
            ["Mean over the points of the fraction of the Sun's disc that the Earth hides."]),
        of!(Orbit, SolarPressure, SolarTorqueSquare, Order(OrderStatistic::Max), ["solar_pressure_torque_max_n_m"],
            "N m", ["Maximum magnitude of the torque from sunlight on the grid."]),
    ],
];

/// Families of columns in order of a row: a family of wheels has its columns for each wheel.
pub(super) fn families() -> impl Iterator<Item = &'static [Column]> {
    FAMILIES.iter().copied()
}

/// Every column in order of a row, those of wheels once.
pub fn all() -> impl Iterator<Item = &'static Column> {
    FAMILIES.iter().copied().flatten()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    /// Laws: names and handles are unique, a name ends with its unit, a meaning is a sentence, columns are ordered by
    /// group.
    #[test]
    fn columns_follow_the_rules() {
        let (mut names, mut ids, mut groups) = (HashSet::new(), HashSet::new(), Vec::new());
        for column in all() {
            let Column { quantity, group, .. } = &column;
            let (name, meaning) = (quantity.name(), quantity.meaning());
            assert!(ids.insert(format!("{:?}", column.id())), "two columns of a group show one number: {column:?}");
            let suffix = match quantity.unit() {
                "" => String::new(),
                "1/s" => "_per_s".to_owned(),
                unit => format!("_{}", unit.to_lowercase().replace([' ', '/'], "_").replace('^', "")),
            };
            assert!(name.ends_with(&suffix), "{column:?}");
            assert!(meaning.len() > 10 && meaning.ends_with('.') && !meaning.ends_with(".."), "{column:?}");
            assert!(names.insert(name.to_owned()), "{name} appears twice");
            groups.push(*group as usize);
        }
        assert!(groups.is_sorted());
        assert!(Group::ALL.into_iter().all(|group| groups.contains(&(group as usize))));
    }
}
