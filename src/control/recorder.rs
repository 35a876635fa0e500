//! [`Recorder`]: telemetry of a run under a loop at its control ticks: phase, estimates, commands, measurements and
//! module telemetry.

use super::bus::Commanded;
use super::estimate::{DebrisState, Estimate};
use super::flight_code::module::FlightCode;
use super::measurement::Measurement;
use super::outcome::estimation::Consistency;
use super::sensors::{Components, KINDS as SENSORS};
use super::spec::LoopSpec;
use super::tick_times::SAME_TIME;
use super::vector::difference;
use crate::run::{Quantity, Telemetry};
use crate::scene::Name;

/// Component names of vectors and quaternions.
const XYZ: &[&str] = &["x", "y", "z"];
const WXYZ: &[&str] = &["w", "x", "y", "z"];

pub struct Recorder {
    pub telemetry: Telemetry,
    groups: Vec<Group>,
}

/// Columns recorded together.
struct Group {
    quantities: Vec<Quantity>,
    /// Appends a value for each of them.
    values: Values,
}

type Values = Box<dyn Fn(&Tick<'_>, &mut Vec<f64>) + Send + Sync>;

#[derive(Clone, Copy, Debug)]
pub struct Tick<'a> {
    pub time: f64,
    pub phase: usize,
    /// Angle of the estimated attitude to the target, rad.
    pub pointing_error: f64,
    pub estimate: &'a Estimate,
    pub consistency: &'a Consistency,
    pub commanded: Commanded,
    pub measurements: &'a [Measurement],
    /// Telemetry of the module; empty if it did not step.
    pub telemetry: &'a [f64],
}

impl Recorder {
    pub fn new(spec: &LoopSpec) -> Self {
        let groups = groups(spec);
        let quantities = groups.iter().flat_map(|group| group.quantities.clone()).collect();
        let same = SAME_TIME * spec.period;
        Recorder { telemetry: Telemetry { quantities, times: Vec::new(), rows: Vec::new(), same }, groups }
    }

    pub fn tick(&mut self, tick: &Tick<'_>) {
        let mut row = Vec::with_capacity(self.telemetry.quantities.len());
        for group in &self.groups {
            let end = row.len() + group.quantities.len();
            (group.values)(tick, &mut row);
            assert_eq!(row.len(), end, "a value for each column");
        }
        self.telemetry.times.push(tick.time);
        self.telemetry.rows.push(row);
    }
}

/// The columns of a loop in their order, by groups.
fn groups(spec: &LoopSpec) -> Vec<Group> {
    let mut list = Vec::new();
    let mut add = |name: &str, components: &[&str], [unit, suffix]: [&str; 2], meaning: &str, values: Values| {
        let column = |component: &&str| {
            let parts = [name, component, suffix].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>();
            Quantity::named(parts.join("_"), unit.to_owned(), meaning.to_owned())
        };
        list.push(Group { quantities: components.iter().map(column).collect(), values });
    };
    let one = |value: fn(&Tick<'_>) -> f64| -> Values { Box::new(move |tick, row| row.push(value(tick))) };
    fn estimated<const N: usize>(value: fn(&Estimate) -> [f64; N]) -> Values {
        Box::new(move |tick, row| row.extend(value(tick.estimate)))
    }
    fn of_debris<const N: usize>(value: fn(&DebrisState, &Estimate) -> [f64; N]) -> Values {
        let of =
            move |estimate: &Estimate| estimate.debris.as_ref().map_or([f64::NAN; N], |debris| value(debris, estimate));
        Box::new(move |tick, row| row.extend(of(tick.estimate)))
    }
    let rate = ["rad/s", "rad_s"];
    fn names<'a>(places: &[usize], names: &'a [Name]) -> Vec<&'a str> {
        places.iter().map(|place| names[*place].as_str()).collect()
    }
    let wheels = &spec.wheels;
    let wheel_names = names(wheels, &spec.wheel_names);
    add("phase", &[""], [""; 2], "Place of the phase of guidance.", one(|tick| tick.phase as f64));
    let meaning = "Angle of the rotation from the estimated attitude to the target.";
    add("estimated_pointing_error", &[""], ["rad"; 2], meaning, one(|tick| tick.pointing_error));
    let meaning = "Estimated attitude quaternion, F_s -> F_e.";
    add("estimated_q_es", WXYZ, [""; 2], meaning, estimated(|estimate| estimate.q_es));
    let meaning = "Estimated angular velocity of F_s relative to F_e, in F_s.";
    add("estimated_omega_se_s", XYZ, rate, meaning, estimated(|estimate| estimate.omega_se_s));
    let meaning = "Estimated bias of the gyro, in F_s.";
    add("estimated_gyro_bias_s", XYZ, rate, meaning, estimated(|estimate| estimate.gyro_bias_s));
    fn of_places<const N: usize>(places: &[usize], value: fn(&Tick<'_>) -> [f64; N]) -> Values {
        let places = places.to_vec();
        Box::new(move |tick, row| row.extend(places.iter().map(|place| value(tick)[*place])))
    }
    let meaning = "Estimated rate of this wheel relative to the body.";
    add("estimated_rate", &wheel_names, rate, meaning, of_places(wheels, |tick| tick.estimate.wheel_rates));
    if spec.has_debris {
        let meaning = "Estimated position of the debris relative to the centre of mass, in F_e.";
        let value = of_debris(|debris, estimate| difference(debris.r_gdo_e, estimate.r_co_e));
        add("estimated_to_debris_e", XYZ, ["m"; 2], meaning, value);
        let meaning = "Estimated velocity relative to the debris, in F_e.";
        let value = of_debris(|debris, estimate| difference(estimate.v_co_e, debris.v_gdo_e));
        add("estimated_relative_velocity_e", XYZ, ["m/s", "m_s"], meaning, value);
        let meaning = "Estimated attitude quaternion of the debris, F_d -> F_e.";
        add("estimated_q_ed", WXYZ, [""; 2], meaning, of_debris(|debris, _| debris.q_ed));
        let meaning = "Estimated angular velocity of the debris relative to F_e, in F_d.";
        add("estimated_omega_de_d", XYZ, rate, meaning, of_debris(|debris, _| debris.omega_de_d));
    }
    if spec.has_filter() {
        let meaning = "Normalised square of an estimation error, or of the innovation of this tick, divided by its \
            degrees of freedom; null if there is none.";
        let filters =
            [("attitude", true), ("motion", true), ("debris_motion", spec.has_debris), ("debris", spec.has_camera())];
        for (place, (name, _)) in filters.into_iter().enumerate().filter(|(_, (_, is_there))| *is_there) {
            let values: Values = Box::new(move |tick, row| row.extend(&tick.consistency.squares[place][..2]));
            add(name, &["nees", "innovation_square"], [""; 2], meaning, values);
        }
        let meaning = "Root mean square of the magnitude of this estimation error by the filter's covariance: the root \
            of the sum of three variances.";
        let errors = [
            ("attitude", true, ["rad"; 2]),
            ("rate", true, rate),
            ("relative_position", spec.has_debris, ["m"; 2]),
            ("relative_velocity", spec.has_debris, ["m/s", "m_s"]),
        ];
        for (place, (name, _, unit)) in errors.into_iter().enumerate().filter(|(_, (_, is_there, _))| *is_there) {
            add(
                &format!("{name}_expected_error"),
                &[""],
                unit,
                meaning,
                Box::new(move |tick, row| row.push(tick.consistency.expected[place])),
            );
        }
    }
    for (place, sensor) in spec.sensors.iter().enumerate() {
        // prefixed by its name if the loop has several of its kind
        let is_alone = spec.sensors.iter().filter(|other| other.kind == sensor.kind).count() == 1;
        let prefix = if is_alone { String::new() } else { format!("{}_", sensor.name) };
        let mut next = 0;
        for quantity in SENSORS[sensor.kind].quantities {
            let (components, places): (_, Vec<usize>) = match quantity.components {
                Components::Named(list) => (list, (next..next + list.len()).collect()),
                Components::Wheels => (&wheel_names[..], wheels.iter().map(|wheel| next + wheel).collect()),
            };
            next += quantity.components.width();
            let sensor = sensor.clone();
            let values: Values = Box::new(move |tick, row| {
                let last = tick.measurements.iter().rev().find(|measurement| measurement.sensor == place);
                let shown = last.map(|last| sensor.telemetry(last.values));
                row.extend(places.iter().map(|at| shown.map_or(f64::NAN, |shown| shown[*at])));
            });
            let meaning = format!("{}; null if none was delivered.", quantity.meaning);
            add(&format!("{prefix}{}", quantity.name), components, quantity.unit, &meaning, values);
        }
    }
    let meaning = "Commanded torque of the motor of this wheel.";
    let values = of_places(wheels, |tick| tick.commanded.motor_torque);
    add("commanded_torque", &wheel_names, ["N m", "n_m"], meaning, values);
    let meaning = "Commanded mean thrust of this thruster over the control period.";
    let values = of_places(&spec.thrusters, |tick| tick.commanded.thrust);
    add("commanded_thrust", &names(&spec.thrusters, &spec.thruster_names), ["N", "n"], meaning, values);
    let meaning = "Commanded dipole of this torque rod.";
    let values = of_places(&spec.rods, |tick| tick.commanded.dipoles);
    add("commanded_dipole", &names(&spec.rods, &spec.rod_names), ["A m^2", "a_m2"], meaning, values);
    for (place, declared) in spec.code().map_or(&[][..], FlightCode::telemetry).iter().enumerate() {
        let value: Values = Box::new(move |tick, row| row.push(tick.telemetry.get(place).map_or(f64::NAN, |one| *one)));
        let meaning = format!(
            "{}: telemetry of the module; null if it is not asked, or does not report a finite number.",
            declared.meaning
        );
        add(&declared.column(""), &[""], [declared.unit_of_column(), ""], &meaning, value);
    }
    list
}
