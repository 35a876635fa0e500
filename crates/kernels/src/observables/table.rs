//! The table of observables: every series, direct value and column of a row, with its kind of scene, needs of the state
//! table, name, unit and meaning.
//!
//! A new observable needs its rows here, and its series in the file of its `SeriesSource`. An error column belongs to a
//! signed series e(t) (energy) or the norm e(t) of an error vector (momenta), measured from observation point 0,
//! relative to the largest sum on the grid of the magnitudes of the balance's terms: energies and work, momenta of body
//! and wheels and impulse. This sum does not cancel with counter-rotating wheels; if it is zero, nothing moves.

use core::ops::Range;

use super::group::Group;
use super::reduction::{ChangeStatistic, ErrorStatistic, OrderStatistic, Reduction, Stored, ValueStatistic};
use super::rows::{ColumnKind, Need, Scenes, SeriesSource};
use crate::run::{Quantity, StateField};
use crate::scene::{MAX_WHEELS, Name};

/// A column of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// Group by which a campaign requests it.
    pub group: Group,
    /// Real number or count.
    pub kind: ColumnKind,
    pub(super) scenes: Scenes,
    pub(super) value: Value,
    /// Index of the wheel, in the columns of a request.
    pub(super) wheel: Option<u8>,
}

impl Column {
    /// The kinds of scene that have the column, in words; empty for all.
    pub const fn scenes(&self) -> &'static str {
        self.scenes.words()
    }

    /// True if there is one such column per turning wheel.
    pub fn is_of_wheel(&self) -> bool {
        self.quantity.name().contains(WHEEL)
    }

    pub(super) fn of_wheel(&self, index: usize, name: Name) -> Column {
        let value = self.value.of_wheel(index);
        Column { quantity: named(&self.quantity, name), value, wheel: Some(index as u8), ..self.clone() }
    }

    /// Handle of the column.
    pub const fn id(&self) -> ColumnId {
        ColumnId { group: self.group, value: self.value }
    }
}

/// Content of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// A series reduced to a number.
    Of(Series, Reduction),
    /// A number not reduced from a single series, with the index of its wheel if there is one per wheel.
    Direct(DirectValue, u8),
    /// Extreme of a series in an interval of time, with its index in the request.
    Window(Series, u8),
    /// Report of a control law, by index among its columns; not filled by the observer.
    Law(u8),
}

/// Handle of a column; [`super::Request::position`] gives its position in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColumnId {
    pub(super) group: Group,
    pub(super) value: Value,
}

impl ColumnId {
    pub(super) fn is_of_wheel(self) -> bool {
        all().any(|column| column.id() == self && column.is_of_wheel())
    }

    /// The handle for wheel `wheel`; itself if it does not depend on wheels.
    #[must_use]
    pub fn of_wheel(self, wheel: usize) -> Self {
        let value = match self.value {
            Value::Direct(..) if !self.is_of_wheel() => self.value,
            of_wheel => of_wheel.of_wheel(wheel),
        };
        ColumnId { value, ..self }
    }

    /// Name of a column that does not depend on a wheel.
    ///
    /// # Panics
    /// If the table has no such column.
    pub fn name(self) -> &'static str {
        all().find(|column| column.id() == self).expect("every handle has a column").quantity.name()
    }
}

/// Placeholder of a wheel's name.
const WHEEL: &str = "{wheel}";

fn named(quantity: &Quantity, name: Name) -> Quantity {
    let of_wheel = |text: &str| text.replace(WHEEL, name.as_str());
    Quantity::named(of_wheel(quantity.name()), quantity.unit().to_owned(), of_wheel(quantity.meaning()))
}

/// A quantity at every observation point; a quantity of wheels has a series per possible wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Series(u8);

impl Series {
    pub(super) const COUNT: usize = Self::first(PLACES.len()).index();

    /// Every series, in the order of columns of a time series.
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

    #[inline(always)]
    pub(super) const fn index(self) -> usize {
        self.0 as usize
    }

    /// Indices of `count` series from this one on: those of the first wheels.
    pub(super) const fn block(self, count: usize) -> Range<usize> {
        self.index()..self.index() + count
    }

    /// The series of wheel `wheel`; itself if it does not depend on wheels.
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

    /// Column of a time series with these wheels; `None` for the scale of another series.
    pub fn quantity(self, wheels: &[Name]) -> Option<Quantity> {
        let shown = self.row().shown.as_ref()?;
        match self.wheel() {
            Some(wheel) => wheels.get(wheel).map(|name| named(shown, *name)),
            None => Some(shown.clone()),
        }
    }
}

/// Changes since the start that have bands: series, name and meaning.
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
    /// [`Series::quantity`], or the quantity of the change since the start, if any.
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
    pub(super) source: SeriesSource,
    pub(super) stored: Stored,
    /// Statistic by which the values are divided.
    pub(super) scale: Option<(Series, Reduction)>,
    pub(super) needs: &'static [&'static [Need]],
    pub(super) shown: Option<Quantity>,
}

pub(super) struct DirectRow {
    pub(super) needs: &'static [Need],
    pub(super) inputs: &'static [(Series, Reduction)],
    /// True if a failed run has it.
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
needs! {
    SPIN: Rate All "rotation of the body", WheelRates All "rotation of the wheels";
    BODIES:
        ComVelocity All "energies in F_e",
        Dcm Constrained "velocities of bodies off the centre of mass",
        Attitude Unconstrained "velocities of bodies off the centre of mass";
    TOTAL: ComVelocity All "total energy in F_e";
    REDUNDANT: KineticEnergies Constrained "energies of the redundant states";
    DEBRIS_ENERGY: DebrisVelocity Debris "energy of the debris", DebrisRate Debris "energy of the debris";
    WORK: Work Actuated "work of actuators and torques on the body";
    LINEAR:
        ComVelocity All "linear momentum",
        Impulse Thrusters "impulse of the thrusters",
        Rate Constrained "velocity of p about the centre of mass",
        Dcm Constrained "velocity of p about the centre of mass";
    ANGULAR:
        Dcm Constrained "angular momentum in F_e",
        Attitude Unconstrained "angular momentum in F_e",
        AngularImpulse ExternalTorque "angular impulse of thrusters and torques on the body";
    DEBRIS_LINEAR: DebrisVelocity Debris "linear momentum of the debris";
    DEBRIS_ANGULAR:
        DebrisRate Debris "angular momentum of the debris",
        DebrisAttitude Debris "angular momentum of the debris in F_e";
    ORTHONORMALITY: Dcm Constrained "departure from a rotation", Attitude Unconstrained "departure from a rotation";
    SPIN_AXIS: Dcm Constrained "direction of s3", Attitude Unconstrained "direction of s3";
    RATE: Rate All "angular rate";
    FROM_NOMINAL: Attitude All "attitude relative to the nominal run";
    FROM_INITIAL: Attitude All "attitude relative to the initial one";
    DEBRIS_DIRECTION: ComPosition Debris "direction of the debris", DebrisPosition Debris "direction of the debris";
    ORBIT:
        ComPosition Orbit "place on the orbit",
        Dcm Constrained "direction of nadir in the body",
        Attitude Unconstrained "direction of nadir in the body";
    MAGNETISM:
        ComPosition MagneticTorque "place in the magnetic field",
        Attitude MagneticTorque "direction of the magnetic field in the body";
    AIR:
        ComPosition Drag "density of the air",
        ComVelocity Drag "velocity relative to the air",
        Attitude Drag "plates in the flow";
    LIGHT: ComPosition SolarPressure "shadow of the Earth", Attitude SolarPressure "plates in the light";
    RESIDUALS: Residuals Constrained "residuals of the constraints";
    FINAL_STATE:
        Attitude All "attitude at the end",
        Rate All "angular velocity at the end",
        WheelRates All "wheel rates at the end";
    DEBRIS_NUMERICS:
        DebrisRate Debris "how the motion amplifies errors",
        DebrisAttitude Debris "errors of the attitude";
    // a method knows the errors of the attitude only if it integrates it
    NUMERICS:
        Rate All "how the motion amplifies errors",
        WheelRates All "how the motion amplifies errors",
        Attitude All "errors of the attitude";
}

#[rustfmt::skip]
series! {
    Energies {
        EnergyBody [1] Quantity [SPIN, BODIES, REDUNDANT] ["energy_body_j" "J"] "Kinetic energy of the body in F_e.";
        EnergyWheel [MAX_WHEELS] Quantity [SPIN, BODIES, REDUNDANT] ["energy_{wheel}_j" "J"]
            "Kinetic energy of wheel {wheel} in F_e.";
        EnergyDebris [1] Quantity [SPIN, DEBRIS_ENERGY] ["energy_debris_j" "J"] "Kinetic energy of the debris in F_e.";
        EnergyTotal [1] Quantity [SPIN, TOTAL, REDUNDANT, DEBRIS_ENERGY] ["energy_total_j" "J"]
            "Total kinetic energy (including the debris) in F_e.";
        ComBody [1] Quantity [SPIN] ["energy_com_body_j" "J"]
            "Kinetic energy of the body about the spacecraft's centre of mass.";
        ComWheel [MAX_WHEELS] Quantity [SPIN] ["energy_com_{wheel}_j" "J"]
            "Kinetic energy of wheel {wheel} about the spacecraft's centre of mass.";
        ComWheels [1] Quantity [SPIN] ["energy_com_wheels_j" "J"]
            "Kinetic energy of all wheels together about the spacecraft's centre of mass.";
        ComTotal [1] Quantity [SPIN] ["energy_com_total_j" "J"]
            "Kinetic energy of the spacecraft about its centre of mass.";
        EnergyError [1] Quantity / EnergyTerms [SPIN, TOTAL, REDUNDANT, DEBRIS_ENERGY, WORK] ["energy_error" ""]
            "Change in total kinetic energy minus the work of actuators and torques on the body, relative to the \
                largest sum of their magnitudes.";
        EnergyTerms [1] Quantity [SPIN, TOTAL, REDUNDANT, DEBRIS_ENERGY, WORK] []
            "Total kinetic energy plus the magnitudes of all work, J.";
        ComError [1] Quantity / ComTotal [SPIN] ["energy_com_error" ""]
            "Change in the kinetic energy about the centre of mass, relative to its largest value (without actuators).";
    }
    LinearMomentum {
        LinearMomentumError [1] Quantity / LinearMomentumTerms [LINEAR] ["linear_momentum_error" ""]
            "Change in the spacecraft's linear momentum minus the impulse, relative to the largest sum of their \
                magnitudes.";
        LinearMomentumTerms [1] Quantity [LINEAR] []
            "Magnitudes of the terms of linear momentum and of the impulse added, N s.";
        LinearMomentumSquare [1] Square [LINEAR] ["linear_momentum_n_s" "N s"]
            "Magnitude of the spacecraft's linear momentum in F_e.";
    }
    AngularMomentum {
        AngularMomentumError [1] Quantity / AngularMomentumTerms [SPIN, ANGULAR] ["angular_momentum_error" ""]
            "Change in the spacecraft's angular momentum about its centre of mass in F_e minus the angular impulse of \
                thrusters and torques on the body, relative to the largest sum of the magnitudes of the momenta of \
                body and wheels and of the impulse.";
        AngularMomentumTerms [1] Quantity [SPIN, ANGULAR] []
            "Magnitudes of the angular momenta of body and wheels and of the angular impulse added, N m s.";
        AngularMomentumSquare [1] Square [SPIN, ANGULAR] ["angular_momentum_n_m_s" "N m s"]
            "Magnitude of the spacecraft's angular momentum about its centre of mass.";
    }
    DebrisMomenta {
        DebrisLinearError [1] Quantity / DebrisLinearSquare [DEBRIS_LINEAR, DEBRIS_ANGULAR]
            ["debris_linear_momentum_error" ""]
            "Change in the debris's linear momentum, relative to the largest.";
        DebrisLinearSquare [1] Square [DEBRIS_LINEAR, DEBRIS_ANGULAR] []
            "Square of the debris's linear momentum, N^2 s^2.";
        DebrisAngularError [1] Quantity / DebrisAngularSquare [DEBRIS_LINEAR, DEBRIS_ANGULAR]
            ["debris_angular_momentum_error" ""]
            "Change in the debris's angular momentum about its centre in F_e, relative to the largest.";
        DebrisAngularSquare [1] Square [DEBRIS_LINEAR, DEBRIS_ANGULAR] []
            "Square of the debris's angular momentum about its centre, N^2 m^2 s^2.";
    }
    Attitude {
        Orthonormality [1] Quantity [ORTHONORMALITY] ["dcm_orthonormality" ""] "Largest entry of |C_es^T C_es - 1|.";
        SpinAxisAngle [1] HalfTangentSquare [SPIN_AXIS] ["spin_axis_angle_rad" "rad"]
            "Angle of s3 from its initial direction in F_e.";
    }
    Residuals {
        ResidualKinematic [1] Quantity [RESIDUALS] ["residual_kinematic_m_s" "m/s"]
            "Residual of the kinematic constraints (angular components in rad/s).";
        ResidualCollocation [1] Quantity [RESIDUALS] ["residual_collocation_m" "m"]
            "Residual of the collocation constraints (tilts of wheel axes as sines).";
        ResidualAttitude [1] Quantity [RESIDUALS] ["residual_attitude" ""] "Residual of the attitude constraints.";
    }
    Motion {
        RateSquare [1] Square [RATE] ["angular_rate_rad_s" "rad/s"]
            "Magnitude of the angular velocity of the body relative to F_e.";
        Nutation [1] Quantity [SPIN] ["nutation_angle_rad" "rad"]
            "Angle between s3 (or observe.nutation_axis) and the angular momentum of the spacecraft about its centre \
                of mass.";
        FromNominal [1] HalfTangentSquare [FROM_NOMINAL] ["attitude_from_nominal_rad" "rad"]
            "Rotation angle between the attitude and that of the nominal run at the same time.";
        FromInitial [1] HalfTangentSquare [FROM_INITIAL] ["attitude_from_initial_rad" "rad"]
            "Rotation angle between the attitude and the initial attitude of the run.";
        WheelSpeed [MAX_WHEELS] Square [SPIN] ["speed_{wheel}_rad_s" "rad/s"]
            "Magnitude of the rate of wheel {wheel} relative to the body.";
        WheelMomentum [MAX_WHEELS] Square [SPIN] ["momentum_{wheel}_n_m_s" "N m s"]
            "Magnitude of the angular momentum of wheel {wheel} about its axis relative to F_e.";
        DebrisDirection [1] Quantity [SPIN_AXIS, DEBRIS_DIRECTION] ["spin_axis_debris_angle_rad" "rad"]
            "Angle between s3 and the line from the spacecraft's centre of mass to the debris (0 where they coincide).";
    }
    Orbit {
        OrbitDistance [1] Quantity [ORBIT] ["orbit_distance_m" "m"]
            "Distance of the spacecraft's centre of mass from the centre of the central body.";
        NadirAngle [1] Quantity [ORBIT] ["nadir_angle_rad" "rad"]
            "Angle between s3 and nadir, the direction from the spacecraft's centre of mass to the central body.";
        GradientTorqueSquare [1] Square [ORBIT] ["gravity_gradient_torque_n_m" "N m"]
            "Magnitude of the torque of the gravity gradient on the spacecraft.";
        FieldStrength [1] Quantity [MAGNETISM] ["magnetic_field_t" "T"]
            "Magnitude of the Earth's magnetic field at the spacecraft.";
        MagneticTorqueSquare [1] Square [MAGNETISM] ["magnetic_torque_n_m" "N m"]
            "Magnitude of the torque of the magnetic field on the residual dipole and the torque rods of the \
                spacecraft.";
    }
    Surroundings {
        AirDensity [1] Quantity [AIR] ["air_density_kg_m3" "kg/m^3"] "Air density at the spacecraft.";
        DragTorqueSquare [1] Square [AIR] ["drag_torque_n_m" "N m"]
            "Magnitude of the torque of the air on the spacecraft.";
        SunHidden [1] Quantity [LIGHT] ["sun_hidden_fraction" ""]
            "Fraction of the Sun's disc that the Earth hides: 0 in full light, 1 in full shadow.";
        SolarTorqueSquare [1] Square [LIGHT] ["solar_pressure_torque_n_m" "N m"]
            "Magnitude of the torque of sunlight on the spacecraft.";
        SolarPower [1] Quantity [LIGHT] ["solar_power_w" "W"]
            "Electrical power of the solar cells: 1361 W/m^2 at one astronomical unit, times efficiency, area and \
                cosine of the angle of incidence, in the light.";
    }
    Law {
        PointingError [1] Quantity [] ["pointing_error_rad" "rad"]
            "Rotation angle from the true attitude to the target of the phase, at the last tick of the control loop; \
                null in a phase without a target.";
        AttitudeEstimateError [1] Quantity [] ["attitude_estimate_error_rad" "rad"]
            "Angle between estimated and true attitude, at the last tick of the control loop.";
        RateEstimateError [1] Quantity [] ["rate_estimate_error_rad_s" "rad/s"]
            "Magnitude of the error in the estimated angular velocity, at the last tick of the control loop.";
        PositionEstimateError [1] Quantity [] ["relative_position_estimate_error_m" "m"]
            "Distance between estimated and true position relative to the debris, at the last tick of the control \
                loop.";
        VelocityEstimateError [1] Quantity [] ["relative_velocity_estimate_error_m_s" "m/s"]
            "Magnitude of the error in the estimated velocity relative to the debris, at the last tick of the control \
                loop.";
        DebrisDistance [1] Quantity [] ["debris_distance_m" "m"]
            "Distance from the spacecraft's centre of mass to the debris's, at the last tick of the control loop.";
        DebrisSpeed [1] Quantity [] ["debris_relative_speed_m_s" "m/s"]
            "Speed of the spacecraft's centre of mass relative to the debris's, at the last tick of the control loop.";
        Impulse [1] Quantity [] ["impulse_n_s" "N s"]
            "Sum of the impulses of all thrusters since the start, at the last tick of the control loop.";
        MotorTorque [MAX_WHEELS] Quantity [] ["torque_{wheel}_n_m" "N m"]
            "Torque of motor and bearing on wheel {wheel} along its axis, within limits, as the control loop applies \
                it.";
    }
}

#[rustfmt::skip]
direct_values! {
    EnergyConservation [WORK, &[], false] {
        WorkThrusters ExternalTorque Float "work_thrusters_final_j" "J"
            "Work done up to the last point by the thrusters and by the torques on the body that the environment or a \
                control law applies; on an orbit also by gravity, including its work on the debris.";
        WorkMotors Motors Float "work_motors_final_j" "J" "Work done by the wheel motors up to the last point.";
    }
    Exchange [&[], CORRELATION, false] {
        Correlation Wheels Float "exchange_{wheel}_correlation" ""
            "Correlation over the points between the energies of the body and of wheel {wheel} about the centre of \
                mass (0 if one of them is constant).";
    }
    Exchange [&[], FREQUENCY, false] {
        ExchangeFrequency Wheels Float "exchange_frequency_hz" "Hz"
            "Dominant frequency of the body's energy about the centre of mass (null if it is constant, if its spectrum \
                has no peak, or if the grid is uneven).";
    }
    FinalState [&[], &[], true] {
        TimeReached All Float "time_reached_s" "s" "Time up to which the run was integrated.";
    }
    FinalState [FINAL_STATE, &[], true] {
        TimeFinal All Float "time_final_s" "s"
            "Time of the last finite state at an observation point; the other columns of this group show that state.";
        AttitudeW All Float "q_es_w_final" "" "Attitude quaternion, scalar part, at the final time.";
        AttitudeX All Float "q_es_x_final" "" "Attitude quaternion, first vector part, at the final time.";
        AttitudeY All Float "q_es_y_final" "" "Attitude quaternion, second vector part, at the final time.";
        AttitudeZ All Float "q_es_z_final" "" "Attitude quaternion, third vector part, at the final time.";
        RateX All Float "omega_se_s_x_final_rad_s" "rad/s" "Angular velocity of the body about s1 at the final time.";
        RateY All Float "omega_se_s_y_final_rad_s" "rad/s" "Angular velocity of the body about s2 at the final time.";
        RateZ All Float "omega_se_s_z_final_rad_s" "rad/s" "Angular velocity of the body about s3 at the final time.";
        WheelRate Wheels Float "rate_{wheel}_final_rad_s" "rad/s"
            "Rate of wheel {wheel} relative to the body at the final time.";
    }
    StepStatistics [&[], &[], true] {
        Steps All Count "steps" "" "Accepted steps.";
        Rejected All Count "steps_rejected" "" "Rejected steps.";
        Evaluations All Count "evaluations" "" "Evaluations of the right-hand side (for Taylor methods: jets).";
    }
    Numerics [NUMERICS, &[], false] {
        StateError All Float "state_error_estimate" ""
            "Estimated largest error in the body's rotation on the grid: in omega relative to the largest |omega| (or \
                to one radian over the duration if that is more), or in the attitude in rad, whichever is larger. \
                Under a control law it is measured by runs that are flown twice.";
        Amplification All Float "error_amplification" ""
            "Estimated factor by which the motion, under a control law the loop, amplifies relative errors in the \
                rotational state that arise evenly along the run.";
        IllConditioned All Count "ill_conditioned" ""
            "1 if the rounding of the input alone may move the state by more than 1e-3 (error_amplification times \
                2^-52), else 0.";
    }
    Numerics [DEBRIS_NUMERICS, &[], false] {
        DebrisStateError Debris Float "debris_state_error_estimate" ""
            "Estimated largest error in the debris's rotation on the grid: in omega relative to the largest |omega| \
                (or to one radian over the duration if that is more), or in the attitude in rad, whichever is \
                larger.";
        DebrisAmplification Debris Float "debris_error_amplification" ""
            "Estimated factor by which the motion of the debris amplifies relative errors in its rotational state that \
                arise evenly along the run.";
        DebrisIllConditioned Debris Count "debris_ill_conditioned" ""
            "1 if the rounding of the input alone may move the rotation of the debris by more than 1e-3 \
                (debris_error_amplification times 2^-52), else 0.";
    }
    MassProperties [&[], &[], true] {
        Mass All Float "mass_kg" "kg" "Mass of the spacecraft with its wheels.";
        CenterX All Float "center_of_mass_x_m" "m" "Centre of mass of the spacecraft from p, component along s1.";
        CenterY All Float "center_of_mass_y_m" "m" "Centre of mass of the spacecraft from p, component along s2.";
        CenterZ All Float "center_of_mass_z_m" "m" "Centre of mass of the spacecraft from p, component along s3.";
        SmallestMoment All Float "principal_moment_smallest_kg_m2" "kg m^2"
            "Smallest principal moment of inertia of the spacecraft about its centre of mass, with locked wheels.";
        MiddleMoment All Float "principal_moment_middle_kg_m2" "kg m^2"
            "Middle principal moment of inertia of the spacecraft about its centre of mass, with locked wheels.";
        LargestMoment All Float "principal_moment_largest_kg_m2" "kg m^2"
            "Largest principal moment of inertia of the spacecraft about its centre of mass, with locked wheels.";
    }
}

/// The columns by family, in order of a row.
#[rustfmt::skip]
static FAMILIES: &[&[Column]] = &[
    errors!(EnergyConservation, All, EnergyError, "energy_error", "the error in total kinetic energy minus the work of \
        actuators and torques on the body, relative to the largest sum of the energies of all bodies and the \
        magnitudes of the work."),
    scales!(EnergyConservation, All, EnergyTotal, "energy_total", ["J", "_j"],
        "total kinetic energy (including the debris) in F_e"),
    direct![WorkThrusters, WorkMotors],
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
    columns! { Attitude All:
        SpinAxisAngle [Order Max] "spin_axis_angle_max_rad" "rad"
            "Maximum angle of s3 from its initial direction in F_e.";
        SpinAxisAngle [Order Final] "spin_axis_angle_final_rad" "rad"
            "Angle of s3 from its initial direction in F_e at the last point.";
    },
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
    direct![Correlation],
    direct![ExchangeFrequency, TimeReached, TimeFinal, AttitudeW, AttitudeX, AttitudeY, AttitudeZ, RateX, RateY, RateZ],
    direct![WheelRate],
    direct![
        Steps, Rejected, Evaluations, StateError, Amplification, IllConditioned, DebrisStateError,
        DebrisAmplification, DebrisIllConditioned
    ],
    columns! { Motion All:
        RateSquare [Order Max] "angular_rate_max_rad_s" "rad/s"
            "Maximum magnitude of the angular velocity of the body relative to F_e.";
        RateSquare [Order Final] "angular_rate_final_rad_s" "rad/s"
            "Magnitude of the angular velocity of the body relative to F_e at the last point.";
        Nutation [Value Max] "nutation_angle_max_rad" "rad"
            "Maximum angle between s3 (or observe.nutation_axis) and the angular momentum of the spacecraft about its \
                centre of mass.";
        Nutation [Value Min] "nutation_angle_min_rad" "rad"
            "Minimum angle between s3 (or observe.nutation_axis) and the angular momentum of the spacecraft about its \
                centre of mass.";
        Nutation [Value Mean] "nutation_angle_mean_rad" "rad"
            "Mean over the points of the angle between s3 (or observe.nutation_axis) and the angular momentum of the \
                spacecraft about its centre of mass.";
        FromNominal [Order Max] "attitude_from_nominal_max_rad" "rad"
            "Maximum rotation angle between the attitude and that of the nominal run at the same time.";
        FromNominal [Order Final] "attitude_from_nominal_final_rad" "rad"
            "Rotation angle between the attitude and that of the nominal run at the last point.";
        FromInitial [Order Max] "attitude_from_initial_max_rad" "rad"
            "Maximum rotation angle between the attitude and the initial attitude of the run.";
        FromInitial [Order Final] "attitude_from_initial_final_rad" "rad"
            "Rotation angle between the attitude at the last point and the initial attitude of the run.";
    },
    columns! { Motion Wheels:
        WheelSpeed [Order Max] "speed_{wheel}_max_rad_s" "rad/s"
            "Maximum magnitude of the rate of wheel {wheel} relative to the body.";
    },
    columns! { Motion Wheels:
        WheelMomentum [Order Max] "momentum_{wheel}_max_n_m_s" "N m s"
            "Maximum magnitude of the angular momentum of wheel {wheel} about its axis relative to F_e.";
    },
    columns! { Motion Debris:
        DebrisDirection [Value Max] "spin_axis_debris_angle_max_rad" "rad"
            "Maximum angle between s3 and the line from the spacecraft's centre of mass to the debris.";
        DebrisDirection [Value Min] "spin_axis_debris_angle_min_rad" "rad"
            "Minimum angle between s3 and the line from the spacecraft's centre of mass to the debris.";
        DebrisDirection [Value Final] "spin_axis_debris_angle_final_rad" "rad"
            "Angle between s3 and the line from the spacecraft's centre of mass to the debris at the last point.";
    },
    direct![Mass, CenterX, CenterY, CenterZ, SmallestMoment, MiddleMoment, LargestMoment],
    columns! { Orbit Orbit:
        OrbitDistance [Value Min] "orbit_distance_min_m" "m"
            "Minimum distance of the spacecraft's centre of mass from the centre of the central body on the grid.";
        OrbitDistance [Value Max] "orbit_distance_max_m" "m"
            "Maximum distance of the spacecraft's centre of mass from the centre of the central body on the grid.";
        NadirAngle [Value Max] "nadir_angle_max_rad" "rad" "Maximum angle between s3 and nadir on the grid.";
        NadirAngle [Value Mean] "nadir_angle_mean_rad" "rad" "Mean over the points of the angle between s3 and nadir.";
        NadirAngle [Value Final] "nadir_angle_final_rad" "rad" "Angle between s3 and nadir at the last point.";
    },
    columns! { Orbit GravityGradient:
        GradientTorqueSquare [Order Max] "gravity_gradient_torque_max_n_m" "N m"
            "Maximum magnitude of the gravity-gradient torque on the grid.";
    },
    columns! { Orbit MagneticTorque:
        FieldStrength [Value Max] "magnetic_field_max_t" "T"
            "Maximum magnitude of the Earth's magnetic field on the grid.";
        FieldStrength [Value Mean] "magnetic_field_mean_t" "T"
            "Mean over the points of the magnitude of the Earth's magnetic field.";
        MagneticTorqueSquare [Order Max] "magnetic_torque_max_n_m" "N m"
            "Maximum magnitude of the magnetic torque on the residual dipole and the torque rods, on the grid.";
    },
    columns! { Orbit Drag:
        AirDensity [Value Max] "air_density_max_kg_m3" "kg/m^3" "Maximum air density at the spacecraft on the grid.";
        AirDensity [Value Mean] "air_density_mean_kg_m3" "kg/m^3"
            "Mean over the points of the air density at the spacecraft.";
        DragTorqueSquare [Order Max] "drag_torque_max_n_m" "N m" "Maximum magnitude of the drag torque on the grid.";
    },
    columns! { Orbit SolarPressure:
        SunHidden [Value Mean] "eclipse_fraction" ""
            "Mean over the points of the fraction of the Sun's disc that the Earth hides.";
        SolarTorqueSquare [Order Max] "solar_pressure_torque_max_n_m" "N m"
            "Maximum magnitude of the torque from sunlight on the grid.";
        SolarPower [Value Mean] "solar_power_mean_w" "W"
            "Mean over the points of the electrical power of the solar cells.";
    },
];

/// The families; one with columns per wheel is repeated for each wheel.
pub(super) fn families() -> impl Iterator<Item = &'static [Column]> {
    FAMILIES.iter().copied()
}

/// Every column in order of a row, without repetition for wheels.
pub fn all() -> impl Iterator<Item = &'static Column> {
    FAMILIES.iter().copied().flatten()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    /// Law: names and handles are unique, names end with the unit, meanings are sentences, groups are in order.
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
