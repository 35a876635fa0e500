//! [`FIGURES`]: the figures over time of a scene, on the page and in `simulate --plot`; `simulate` prints their
//! columns. A figure appears if the scene or a requirement calls for it.

use crate::campaign::Plan;
use crate::observables::Series;
use crate::report::figure::Hue;
use crate::run::StateField;
use crate::scene::{Name, WheelModel};

#[derive(Clone, Debug)]
pub struct Traits {
    pub has_loop: bool,
    pub changes_phase: bool,
    pub points: bool,
    pub estimates: bool,
    pub approaches: bool,
    pub debris: bool,
    pub orbit: bool,
    pub dated_orbit: bool,
    pub cells: bool,
    pub wheels: bool,
    pub drives: bool,
    pub fires: bool,
    asked: Vec<String>,
    wheel_names: Vec<Name>,
}

impl Traits {
    /// The traits of `plan` with the turning `wheels`.
    pub fn of(plan: &Plan, wheels: &[Name]) -> Self {
        let spec = plan.loop_spec();
        let is = |what: fn(&crate::loops::LoopSpec) -> bool| spec.is_some_and(what);
        Traits {
            has_loop: spec.is_some(),
            changes_phase: is(|spec| spec.phases.len() > 1),
            points: is(|spec| spec.points()),
            estimates: is(|spec| !spec.knows_the_truth()),
            approaches: is(|spec| spec.approaches()),
            debris: plan.nominal.debris.is_some(),
            orbit: plan.nominal.orbit.is_some(),
            dated_orbit: plan.nominal.orbit.as_ref().is_some_and(|orbit| orbit.epoch.is_some()),
            cells: plan.nominal.plates.iter().any(|plate| plate.cell_efficiency > 0.0),
            wheels: !wheels.is_empty(),
            drives: is(|spec| !spec.wheels.is_empty()),
            fires: is(|spec| !spec.thrusters.is_empty()),
            asked: plan.analysis.requirements.iter().map(|one| one.name().to_owned()).collect(),
            wheel_names: wheels.to_vec(),
        }
    }

    /// True if a requirement is on one of `names` (see [`Traits::judged`]).
    fn asked(&self, names: &[&str]) -> bool {
        self.judged(names).any(|name| self.asked.contains(&name))
    }

    /// Expands `{wheel}` in `names` to each wheel.
    pub fn judged<'t>(&'t self, names: &[&'t str]) -> impl Iterator<Item = String> {
        let of = |name: &&'t str| match name.contains("{wheel}") {
            true => self.wheel_names.iter().map(|wheel| name.replace("{wheel}", wheel.as_str())).collect(),
            false => vec![(*name).to_owned()],
        };
        names.iter().flat_map(of).collect::<Vec<_>>().into_iter()
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Page,
    Plot,
}

/// The limit of driven wheels that a figure shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WheelLimit {
    /// Motor torque, N m, both signs.
    Torque,
    /// Speed, rad/s, magnitude.
    Speed,
}

impl WheelLimit {
    /// The limit of `wheel`, N m or rad/s; may be infinite.
    pub fn of(self, wheel: &WheelModel) -> f64 {
        match self {
            WheelLimit::Torque => wheel.torque_limit,
            WheelLimit::Speed => wheel.speed_limit,
        }
    }

    pub const fn unit(self) -> &'static str {
        match self {
            WheelLimit::Torque => "N m",
            WheelLimit::Speed => "rad/s",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    One(Series),
    /// An estimation error, with the telemetry column of the filter's standard deviation.
    Estimated(Series, &'static str),
    /// A series of wheels: with a loop one figure with limits, else a figure per wheel.
    Wheels(Series, WheelLimit),
    State(StateField, &'static [&'static str]),
    GroundTrack,
    Phases,
    Thrust,
    Impulse,
    Propellant,
    Energies,
    Changes,
    Transfer,
    Drift,
}

#[derive(Clone, Copy, Debug)]
pub struct ListedFigure {
    pub shows: Shows,
    /// Title, or its beginning if there is one per wheel or body.
    pub title: &'static str,
    pub quantity: &'static str,
    pub hue: Hue,
    called: fn(&Traits, Place) -> bool,
    /// Observables whose requirements call for it too; their limits are drawn.
    pub judged_by: &'static [&'static str],
}

impl ListedFigure {
    pub fn is_asked(&self, traits: &Traits) -> bool {
        traits.asked(self.judged_by)
    }
}

pub fn figures_of(traits: &Traits, place: Place) -> impl Iterator<Item = &'static ListedFigure> {
    FIGURES.iter().filter(move |figure| (figure.called)(traits, place) || figure.is_asked(traits))
}

const XYZ: &[&str] = &["x", "y", "z"];
const WXYZ: &[&str] = &["w", "x", "y", "z"];
/// Energies with requirements; a loop has no other energy figures.
const ENERGIES: &[&str] = &[
    "energy_body_j",
    "energy_body_initial_j",
    "energy_body_final_j",
    "energy_body_min_j",
    "energy_body_max_j",
    "energy_body_mean_j",
    "energy_body_peak_to_peak_j",
    "energy_{wheel}_j",
    "energy_{wheel}_final_j",
    "energy_{wheel}_min_j",
    "energy_{wheel}_max_j",
    "energy_{wheel}_mean_j",
    "energy_{wheel}_peak_to_peak_j",
];
const CHANGES: &[&str] = &["exchange_body_j", "exchange_{wheel}_j"];
const FREE: fn(&Traits, Place) -> bool = |scene, _| !scene.has_loop;
const FREE_ON_PAGE: fn(&Traits, Place) -> bool = |scene, place| !scene.has_loop && place == Place::Page;
const FREE_IN_PLOT: fn(&Traits, Place) -> bool = |scene, place| !scene.has_loop && place == Place::Plot;
const ON_ORBIT: fn(&Traits, Place) -> bool = |scene, _| scene.orbit;
const ESTIMATED_DEBRIS: fn(&Traits, Place) -> bool = |scene, _| scene.estimates && scene.approaches;

type Called = fn(&Traits, Place) -> bool;

const fn figure(
    shows: Shows,
    (title, quantity, hue): (&'static str, &'static str, Hue),
    called: Called,
    judged_by: &'static [&'static str],
) -> ListedFigure {
    ListedFigure { shows, title, quantity, hue, called, judged_by }
}

#[rustfmt::skip]
pub const FIGURES: &[ListedFigure] = {
    use Shows::*;
    &[
        // a control loop
        figure(One(Series::PointingError), ("Pointing error", "angle", Hue::Body), |scene, _| scene.points,
            &["pointing_error_rad", "pointing_error_final_rad"]),
        figure(Phases, ("Phases", "", Hue::Body), |scene, _| scene.changes_phase, &[]),
        figure(Estimated(Series::AttitudeEstimateError, "attitude_expected_error_rad"),
            ("Error of the estimated attitude", "angle", Hue::Body), |scene, _| scene.estimates,
            &["attitude_estimate_error_rad", "attitude_estimate_error_final_rad", "attitude_estimate_error_max_rad"]),
        figure(Estimated(Series::RateEstimateError, "rate_expected_error_rad_s"),
            ("Error of the estimated angular velocity", "rate", Hue::Body), |scene, _| scene.estimates,
            &["rate_estimate_error_rad_s"]),
        figure(Estimated(Series::PositionEstimateError, "relative_position_expected_error_m"),
            ("Error of the estimated position relative to the debris", "distance", Hue::Debris),
            ESTIMATED_DEBRIS, &["relative_position_estimate_error_m", "relative_position_estimate_error_final_m"]),
        figure(Estimated(Series::VelocityEstimateError, "relative_velocity_expected_error_m_s"),
            ("Error of the estimated velocity relative to the debris", "speed", Hue::Debris),
            ESTIMATED_DEBRIS, &["relative_velocity_estimate_error_m_s", "relative_velocity_estimate_error_final_m_s"]),
        figure(One(Series::DebrisDistance), ("Distance to the debris", "distance", Hue::Debris),
            |scene, _| scene.approaches, &["debris_distance_m", "debris_distance_min_m"]),
        figure(One(Series::DebrisSpeed), ("Speed relative to the debris", "speed", Hue::Debris),
            |scene, _| scene.approaches, &["debris_relative_speed_m_s", "relative_speed_launch_m_s"]),
        // the motion
        figure(One(Series::DebrisDirection), ("Angle between s3 and the line to the debris", "angle", Hue::Debris),
            |scene, place| scene.debris && (scene.has_loop || place == Place::Page),
            &["spin_axis_debris_angle_rad", "pointing_error_launch_rad", "spin_axis_debris_angle_final_rad",
            "spin_axis_debris_angle_max_rad", "spin_axis_debris_angle_min_rad"]),
        figure(One(Series::RateSquare), ("Angular rate of the body", "|omega|", Hue::Body),
            |scene, place| scene.has_loop || place == Place::Page,
            &["angular_rate_rad_s", "angular_rate_final_rad_s", "angular_rate_max_rad_s", "body_rate_launch_rad_s"]),
        figure(One(Series::SpinAxisAngle), ("Angle of s3 from its initial direction", "angle", Hue::Body), FREE_ON_PAGE,
            &["spin_axis_angle_rad", "spin_axis_angle_final_rad", "spin_axis_angle_max_rad"]),
        figure(One(Series::Nutation), ("Nutation angle: s3 from the angular momentum", "angle", Hue::Body),
            FREE_ON_PAGE,
            &["nutation_angle_rad", "nutation_angle_final_rad", "nutation_angle_max_rad", "nutation_angle_min_rad"]),
        figure(One(Series::FromNominal), ("Attitude relative to the nominal run", "angle", Hue::Body), FREE_ON_PAGE,
            &["attitude_from_nominal_rad", "attitude_from_nominal_final_rad", "attitude_from_nominal_max_rad"]),
        figure(State(StateField::Rate, XYZ), ("Angular velocity of the body, in F_s", "angular velocity",
            Hue::Curve(0)), FREE_IN_PLOT, &[]),
        figure(State(StateField::Attitude, WXYZ), ("Attitude quaternion of the body, F_s to F_e", "component",
            Hue::Curve(0)), FREE_IN_PLOT, &[]),
        figure(State(StateField::DebrisRate, XYZ), ("Angular velocity of the debris, in F_d", "angular velocity",
            Hue::Curve(0)), |scene, place| FREE_IN_PLOT(scene, place) && scene.debris, &[]),
        figure(State(StateField::DebrisAttitude, WXYZ), ("Attitude quaternion of the debris, F_d to F_e",
            "component", Hue::Curve(0)), |scene, place| FREE_IN_PLOT(scene, place) && scene.debris, &[]),
        // the orbit and what is around it
        figure(One(Series::NadirAngle), ("Angle between s3 and nadir", "angle", Hue::Body), ON_ORBIT,
            &["nadir_angle_rad", "nadir_angle_max_rad", "nadir_angle_mean_rad", "nadir_angle_final_rad"]),
        figure(One(Series::OrbitDistance), ("Distance from the centre of the Earth", "distance", Hue::Total), ON_ORBIT,
            &["orbit_distance_m", "orbit_distance_min_m", "orbit_distance_max_m"]),
        figure(One(Series::FieldStrength), ("Magnetic field at the spacecraft", "field", Hue::Total), ON_ORBIT,
            &["magnetic_field_t", "magnetic_field_max_t", "magnetic_field_mean_t"]),
        figure(One(Series::AirDensity), ("Density of the air at the spacecraft", "density", Hue::Total), ON_ORBIT,
            &["air_density_kg_m3", "air_density_max_kg_m3", "air_density_mean_kg_m3"]),
        figure(One(Series::SunHidden), ("Share of the Sun that the Earth hides", "share", Hue::Total), ON_ORBIT,
            &["sun_hidden_fraction", "eclipse_fraction"]),
        figure(One(Series::SolarPower), ("Power of the solar cells", "power", Hue::Total), |scene, _| scene.cells,
            &["solar_power_w", "solar_power_mean_w"]),
        figure(GroundTrack, ("Ground track", "latitude", Hue::Total), |scene, _| scene.dated_orbit, &[]),
        // actuators
        figure(Wheels(Series::MotorTorque, WheelLimit::Torque), ("Torque", "torque", Hue::Wheel(0)),
            |scene, _| scene.drives, &["torque_{wheel}_n_m"]),
        figure(Wheels(Series::WheelSpeed, WheelLimit::Speed), ("Speed", "speed", Hue::Wheel(0)),
            |scene, place| scene.wheels && (scene.has_loop || place == Place::Page),
            &["speed_{wheel}_rad_s", "speed_{wheel}_max_rad_s", "speed_peak_{wheel}_rad_s"]),
        figure(State(StateField::WheelRates, &[]), ("Wheel rates", "rate", Hue::Wheel(0)),
            |scene, place| FREE_IN_PLOT(scene, place) && scene.wheels, &[]),
        figure(Thrust, ("Thrust", "thrust", Hue::Curve(0)), |scene, _| scene.fires, &[]),
        figure(Impulse, ("Impulse of the thrusters", "impulse", Hue::Curve(0)), |scene, _| scene.fires,
            &["impulse_n_s", "impulse_total_n_s"]),
        figure(Propellant, ("Propellant used", "mass", Hue::Total), |scene, _| scene.fires, &["propellant_kg"]),
        // energies: for free motion or by requirement
        figure(One(Series::AngularMomentumSquare), ("Angular momentum about the centre of mass", "momentum",
            Hue::Body), FREE_IN_PLOT, &[]),
        figure(One(Series::LinearMomentumSquare), ("Linear momentum in F_e", "momentum", Hue::Body), FREE_IN_PLOT, &[]),
        figure(One(Series::EnergyTotal), ("Kinetic energy, total", "energy", Hue::Curve(0)), FREE_IN_PLOT, &[]),
        figure(Energies, ("Kinetic energy", "energy", Hue::Body), FREE, ENERGIES),
        figure(Changes, ("Energy transfer", "change of energy", Hue::Body), |scene, place| FREE_ON_PAGE(scene,
            place) && scene.wheels, CHANGES),
        figure(Transfer, ("Energy transfer between wheels and body", "change of energy", Hue::Body),
            |scene, _| !scene.has_loop && scene.wheels, CHANGES),
        figure(Drift, ("Drift", "relative error", Hue::Body), |_, place| place == Place::Plot, &[]),
    ]
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: titles are unique, and the limit of a wheel row has the unit of its series.
    #[test]
    fn rows_say_what_they_show() {
        let names = [Name::new("w1").expect("a name")];
        let mut wheels = 0;
        for (place, row) in FIGURES.iter().enumerate() {
            assert!(FIGURES[..place].iter().all(|other| other.title != row.title), "{} is there twice", row.title);
            let Shows::Wheels(series, limit) = row.shows else { continue };
            let quantity = series.of_wheel(0).quantity(&names).expect("a quantity");
            assert_eq!(quantity.unit(), limit.unit(), "{}", row.title);
            wheels += 1;
        }
        assert!(wheels > 1, "{wheels}");
    }
}
