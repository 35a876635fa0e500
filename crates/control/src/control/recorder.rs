//! [`Recorder`]: telemetry of a run under a loop at its control ticks: phase, estimates, commands, measurements and
//! module telemetry.

use super::bus::Commanded;
use super::outcome::estimation::Consistency;
use super::tick_times::SAME_TIME;
use crate::loops::estimate::{DebrisState, Estimate};
use crate::loops::kinds::Components;
use crate::loops::measurement::Measurement;
use crate::loops::spec::LoopSpec;
use crate::loops::vector::difference;
use crate::run::{Quantity, Telemetry};
use crate::scene::Name;

/// Component names of vectors and quaternions.
const XYZ: [&str; 3] = ["x", "y", "z"];
const WXYZ: [&str; 4] = ["w", "x", "y", "z"];

pub struct Recorder {
    pub telemetry: Telemetry,
    groups: Vec<Group>,
}

/// The value at a tick of the column with this index in its group.
type ValueAt = Box<dyn Fn(&Tick<'_>, usize) -> f64 + Send + Sync>;

/// Columns recorded together.
struct Group {
    quantities: Vec<Quantity>,
    value: ValueAt,
}

pub struct Tick<'a> {
    pub spec: &'a LoopSpec,
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
        let columns = self.groups.iter().flat_map(|group| (0..group.quantities.len()).map(move |index| (group, index)));
        self.telemetry.times.push(tick.time);
        self.telemetry.rows.push(columns.map(|(group, index)| (group.value)(tick, index)).collect());
    }
}

fn add(
    list: &mut Vec<Group>,
    name: &str,
    components: &[&str],
    [unit, suffix]: [&str; 2],
    meaning: &str,
    value: impl Fn(&Tick<'_>, usize) -> f64 + Send + Sync + 'static,
) {
    let column = |component: &&str| {
        let parts = [name, component, suffix].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>();
        Quantity::named(parts.join("_"), unit.to_owned(), meaning.to_owned())
    };
    list.push(Group { quantities: components.iter().map(column).collect(), value: Box::new(value) });
}

/// Components of the debris's estimated state; NaN without one.
fn add_debris<const N: usize>(
    list: &mut Vec<Group>,
    name: &str,
    components: &[&str; N],
    unit: [&str; 2],
    meaning: &str,
    value: fn(&DebrisState, &Estimate) -> [f64; N],
) {
    add(list, name, components, unit, meaning, move |tick, index| {
        tick.estimate.debris.as_ref().map_or(f64::NAN, |debris| value(debris, tick.estimate)[index])
    });
}

/// The columns of a loop in their order, by groups.
fn groups(spec: &LoopSpec) -> Vec<Group> {
    let mut groups = Vec::new();
    let list = &mut groups;
    let rate = ["rad/s", "rad_s"];
    fn names<'a>(places: &[usize], names: &'a [Name]) -> Vec<&'a str> {
        places.iter().map(|place| names[*place].as_str()).collect()
    }
    let wheels = names(&spec.wheels, &spec.wheel_names);
    add(list, "phase", &[""], [""; 2], "Place of the phase of guidance.", |tick, _| tick.phase as f64);
    let meaning = "Angle of the rotation from the estimated attitude to the target.";
    add(list, "estimated_pointing_error", &[""], ["rad"; 2], meaning, |tick, _| tick.pointing_error);
    let meaning = "Estimated attitude quaternion, F_s -> F_e.";
    add(list, "estimated_q_es", &WXYZ, [""; 2], meaning, |tick, i| tick.estimate.q_es[i]);
    let meaning = "Estimated angular velocity of F_s relative to F_e, in F_s.";
    add(list, "estimated_omega_se_s", &XYZ, rate, meaning, |tick, i| tick.estimate.omega_se_s[i]);
    let meaning = "Estimated bias of the gyro, in F_s.";
    add(list, "estimated_gyro_bias_s", &XYZ, rate, meaning, |tick, i| tick.estimate.gyro_bias_s[i]);
    let meaning = "Estimated rate of this wheel relative to the body.";
    add(list, "estimated_rate", &wheels, rate, meaning, |tick, i| tick.estimate.wheel_rates[tick.spec.wheels[i]]);
    if spec.has_debris {
        let meaning = "Estimated position of the debris relative to the centre of mass, in F_e.";
        add_debris(list, "estimated_to_debris_e", &XYZ, ["m"; 2], meaning, |debris, estimate| {
            difference(debris.r_gdo_e, estimate.r_co_e)
        });
        let meaning = "Estimated velocity relative to the debris, in F_e.";
        add_debris(list, "estimated_relative_velocity_e", &XYZ, ["m/s", "m_s"], meaning, |debris, estimate| {
            difference(estimate.v_co_e, debris.v_gdo_e)
        });
        let meaning = "Estimated attitude quaternion of the debris, F_d -> F_e.";
        add_debris(list, "estimated_q_ed", &WXYZ, [""; 2], meaning, |debris, _| debris.q_ed);
        let meaning = "Estimated angular velocity of the debris relative to F_e, in F_d.";
        add_debris(list, "estimated_omega_de_d", &XYZ, rate, meaning, |debris, _| debris.omega_de_d);
    }
    if spec.has_filter() {
        let meaning = "Normalised square of an estimation error, or of the innovation of this tick, divided by its \
            degrees of freedom; null if there is none.";
        let filters =
            [("attitude", true), ("motion", true), ("debris_motion", spec.has_debris), ("debris", spec.has_camera())];
        for (place, (name, _)) in filters.into_iter().enumerate().filter(|(_, (_, is_there))| *is_there) {
            add(list, name, &["nees", "innovation_square"], [""; 2], meaning, move |tick, i| {
                tick.consistency.squares[place][i]
            });
        }
        let meaning = "Root mean square of the magnitude of this estimation error by the filter's covariance: the \
            root of the sum of three variances.";
        let errors = [
            ("attitude", true, ["rad"; 2]),
            ("rate", true, rate),
            ("relative_position", spec.has_debris, ["m"; 2]),
            ("relative_velocity", spec.has_debris, ["m/s", "m_s"]),
        ];
        for (place, (name, _, unit)) in errors.into_iter().enumerate().filter(|(_, (_, is_there, _))| *is_there) {
            let name = format!("{name}_expected_error");
            add(list, &name, &[""], unit, meaning, move |tick, _| tick.consistency.expected[place]);
        }
    }
    for (place, sensor) in spec.sensors.iter().enumerate() {
        // prefixed by its name if the loop has several of its kind
        let is_alone = spec.sensors.iter().filter(|other| other.kind == sensor.kind).count() == 1;
        let prefix = if is_alone { String::new() } else { format!("{}_", sensor.name) };
        let mut next = 0;
        for quantity in sensor.kind.quantities {
            let (components, places): (_, Vec<usize>) = match quantity.components {
                Components::Named(list) => (list, (next..next + list.len()).collect()),
                Components::Wheels => (&wheels[..], spec.wheels.iter().map(|wheel| next + wheel).collect()),
            };
            next += quantity.components.width();
            let meaning = format!("{}; null if none was delivered.", quantity.meaning);
            let name = format!("{prefix}{}", quantity.name);
            add(list, &name, components, quantity.unit, &meaning, move |tick, i| {
                let last = tick.measurements.iter().rev().find(|measurement| measurement.sensor == place);
                last.map_or(f64::NAN, |last| tick.spec.sensors[place].telemetry(last.values)[places[i]])
            });
        }
    }
    let meaning = "Commanded torque of the motor of this wheel.";
    add(list, "commanded_torque", &wheels, ["N m", "n_m"], meaning, |tick, i| {
        tick.commanded.motor_torque[tick.spec.wheels[i]]
    });
    let meaning = "Commanded mean thrust of this thruster over the control period.";
    let thrusters = names(&spec.thrusters, &spec.thruster_names);
    add(list, "commanded_thrust", &thrusters, ["N", "n"], meaning, |tick, i| {
        tick.commanded.thrust[tick.spec.thrusters[i]]
    });
    let meaning = "Commanded dipole of this torque rod.";
    let rods = names(&spec.rods, &spec.rod_names);
    add(list, "commanded_dipole", &rods, ["A m^2", "a_m2"], meaning, |tick, i| {
        tick.commanded.dipoles[tick.spec.rods[i]]
    });
    for (place, declared) in spec.telemetry().iter().enumerate() {
        let meaning = format!(
            "{}: telemetry of the module; null if it is not asked, or does not report a finite number.",
            declared.meaning
        );
        add(list, &declared.column(""), &[""], [declared.unit_of_column(), ""], &meaning, move |tick, _| {
            tick.telemetry.get(place).copied().unwrap_or(f64::NAN)
        });
    }
    groups
}
