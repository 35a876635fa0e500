//! Conditions on a scene beyond the limits of single keys ([`super::schema`]): `written` checks the input, `derived`
//! its consequences (masses and inertias that overflow, vanish or are not positive definite).

use super::Name;
use super::error::Problems;
use super::input::SceneInput;
use super::mass::{Body, MassProperties};
use super::schedule::applied;
use super::schema::limit::{INERTIA_SLACK, shown};
use super::schema::{ArcErrors, FieldModel, InitialInput, PartInput, WheelInput, WheelMode};
use super::surroundings::{self, ADD_ORBIT};
use super::table::Table;
use super::tensor::extremes;
use crate::math::prelude::*;
use crate::math::symmetric::{is_positive_definite, principal_axes};

/// Largest mass (kg) and moment of inertia (kg m^2): products of two, in sums over pairs and determinants, are finite.
const LARGEST: f64 = 1e150;

fn magnetic_field(input: &SceneInput, problems: &mut Problems) {
    const KEY: &str = "environment.magnetic_field";
    let Some(model) = input.environment.magnetic_field else {
        let remedy = "add magnetic_field = \"igrf\" to [environment]";
        if let Some(dipole) = input.environment.magnetic_dipole_a_m2 {
            let allowed = "left out without a magnetic_field";
            problems.add("environment.magnetic_dipole_a_m2", shown(&dipole), allowed, remedy);
        }
        if !input.torque_rods.is_empty() {
            problems.add(KEY, "missing", "given where there are [[torque_rods]]", remedy);
        }
        return;
    };
    let Some(orbit) = &input.orbit else {
        return problems.add(KEY, format!("{:?}", model.name()), "left out without an [orbit]", ADD_ORBIT);
    };
    let [first, last] = FieldModel::YEARS;
    let Some(epoch) = orbit.epoch else {
        let allowed = "given where there is a magnetic_field, which depends on the date";
        let remedy = "add epoch = \"2026-11-24T00:00:00Z\" to [orbit]";
        return problems.add("orbit.epoch", "missing", allowed, remedy);
    };
    if !(first..last).contains(&epoch.decimal_year()) {
        let allowed = format!("a date of the years {first} to {}, which IGRF-14 covers here", last - 1.0);
        let remedy = "write another date, or delete magnetic_field";
        problems.add("orbit.epoch", format!("{:?}", epoch.to_string()), allowed, remedy);
    }
}

pub(super) fn written(input: &SceneInput, problems: &mut Problems) {
    let has_debris = input.debris.is_some();
    macro_rules! check {
        ($rows:expr, $Table:ident) => {
            check!($rows, $Table, Name::NONE)
        };
        ($rows:expr, $Table:ident, $name:expr) => {
            $rows.check(has_debris, problems, |key| Table::$Table.name($name, key).into())
        };
    }
    input.body.check_all(problems);
    for part in &input.parts {
        check!(part, Part, part.name);
        check!(part.errors, PartErrors, part.name);
        walls(part, problems);
    }
    for wheel in &input.wheels {
        check!(wheel, Wheel, wheel.name);
        wheel_inertia(wheel, problems);
    }
    for rod in &input.torque_rods {
        check!(rod, TorqueRod, rod.name);
    }
    for thruster in &input.thrusters {
        check!(thruster, Thruster, thruster.name);
    }
    for plate in &input.plates {
        check!(plate, Plate, plate.name);
        surroundings::check_plate(plate, problems);
    }
    if let Some(debris) = &input.debris {
        debris.check(problems);
    }
    check!(input.initial, Initial);
    initial_states(&input.initial, input.orbit.is_some(), has_debris, problems);
    if let Some(orbit) = &input.orbit {
        let before = problems.0.len();
        check!(orbit, Orbit);
        if problems.0.len() == before {
            super::orbit::check(input, orbit, problems);
        }
    }
    if input.environment.gravity_gradient && input.orbit.is_none() {
        let allowed = "false, or left out, without an [orbit]";
        problems.add("environment.gravity_gradient", "true", allowed, ADD_ORBIT);
    }
    magnetic_field(input, problems);
    surroundings::check_keys(&input.environment, problems);
    if input.environment.acts_on_plates() {
        surroundings::check(input, problems);
    }
    check!(input.environment, Environment);
    input.control.check(problems);
    for failure in &input.failures {
        check!(failure, Failure, failure.name);
    }
    if input.actuation.is_empty() {
        return;
    }
    let before = problems.0.len();
    arcs(input, problems);
    check!(input.actuators, Actuators);
    if problems.0.len() == before {
        switches(input, problems);
    }
}

/// Refuses states given twice, and states relative to a missing orbit.
fn initial_states(initial: &InitialInput, has_orbit: bool, has_debris: bool, problems: &mut Problems) {
    const DEFAULT: InitialInput = InitialInput::DEFAULT;
    macro_rules! refuse_twice {
        ($key:ident, $other:ident) => {
            if initial.$other.is_some() && initial.$key != DEFAULT.$key {
                let (key, allowed) = (stringify!($key), concat!("left out where ", stringify!($other), " is written"));
                problems.add(format!("initial.{key}"), shown(&initial.$key), allowed, "write one of both");
            }
        };
    }
    refuse_twice!(attitude, attitude_orbital);
    refuse_twice!(angular_velocity_rad_s, angular_velocity_orbital_rad_s);
    if has_debris {
        refuse_twice!(debris_attitude, debris_attitude_inertial);
        refuse_twice!(debris_relative_angular_velocity_rad_s, debris_angular_velocity_rad_s);
    }
    if has_orbit {
        return;
    }
    let mut refuse = |key: &'static str, numbers: &[f64]| {
        problems.add(key, shown(numbers), "left out without an [orbit]", ADD_ORBIT);
    };
    if let Some(attitude) = &initial.attitude_orbital {
        refuse("initial.attitude_orbital", attitude);
    }
    if let Some(rate) = &initial.angular_velocity_orbital_rad_s {
        refuse("initial.angular_velocity_orbital_rad_s", rate);
    }
}

/// Checks that the walls of a hollow cylinder enclose a volume.
fn walls(part: &PartInput, problems: &mut Problems) {
    let (Some(wall), Some(radius), Some(length)) = (part.wall_thickness_m, part.outer_radius_m, part.length_m) else {
        return;
    };
    let passed = |value: f64| value.is_finite() && value > 0.0;
    let key = || Table::Part.name(part.name, "wall_thickness_m");
    if passed(wall) && passed(radius) && wall >= radius {
        let allowed = format!("below outer_radius_m = {radius:?} of that part");
        problems.add(key(), shown(&[wall]), allowed, "make the wall thinner or the radius larger");
    }
    if passed(wall) && passed(length) && 2.0 * wall >= length {
        let allowed = format!("below half of length_m = {length:?} of that part");
        problems.add(key(), shown(&[wall]), allowed, "make the end plates thinner or the part longer");
    }
}

/// Checks that the axial moment of a wheel is at most twice the transverse one.
fn wheel_inertia(wheel: &WheelInput, problems: &mut Problems) {
    let (Some(axial), Some(transverse)) = (wheel.axial_inertia_kg_m2, wheel.transverse_inertia_kg_m2) else { return };
    if transverse > 0.0 && axial > 2.0 * transverse * (1.0 + INERTIA_SLACK) {
        problems.add(
            Table::Wheel.name(wheel.name, "axial_inertia_kg_m2"),
            shown(&[axial]),
            format!("at most twice transverse_inertia_kg_m2 = {transverse:?}"),
            "no distribution of mass has these moments; a thin disk has twice",
        );
    }
}

fn arcs(input: &SceneInput, problems: &mut Problems) {
    let mut previous_end = 0.0;
    for (i, arc) in input.actuation.iter().enumerate() {
        let before = problems.0.len();
        let key = |name: &str| format!("actuation[{i}].{name}");
        arc.check(false, problems, |name| key(name).into());
        arc.errors.check(false, problems, |name| key(name).into());
        if problems.0.len() > before {
            continue;
        }
        if arc.start_s < previous_end {
            let (allowed, remedy) = if i == 0 {
                ("zero or later".to_owned(), "a run starts at time zero")
            } else {
                let allowed = format!("no earlier than actuation[{}].end_s = {previous_end:?}", i - 1);
                (allowed, "put the arcs in order, not overlapping")
            };
            problems.add(key("start_s"), shown(&[arc.start_s]), allowed, remedy);
        }
        if arc.end_s <= arc.start_s {
            let allowed = format!("later than its start_s = {:?}", arc.start_s);
            problems.add(key("end_s"), shown(&[arc.end_s]), allowed, "end the arc after its start, or leave it out");
        }
        previous_end = arc.end_s.max(previous_end);
        commands(input, i, problems);
    }
}

/// Refuses negative thrusts, and motor torques on wheels that take none.
fn commands(input: &SceneInput, index: usize, problems: &mut Problems) {
    let arc = &input.actuation[index];
    for (thruster, thrust) in input.thrusters.iter().zip(arc.thrust_n) {
        let key = || format!("actuation[{index}].thrust_n.{}", thruster.name);
        if !thrust.is_finite() {
            problems.add(key(), shown(&[thrust]), "a finite number", "write a finite number");
        } else if thrust < 0.0 {
            let allowed = "zero or above: a thruster does not pull";
            problems.add(key(), shown(&[thrust]), allowed, "use the opposite thruster");
        }
    }
    for (wheel, torque) in input.wheels.iter().zip(arc.torque_n_m) {
        let key = || format!("actuation[{index}].torque_n_m.{}", wheel.name);
        if !torque.is_finite() {
            problems.add(key(), shown(&[torque]), "a finite number", "write a finite number");
            continue;
        }
        let why = match wheel.mode {
            WheelMode::SpeedHeld => "whose speed its motor holds",
            WheelMode::Locked => "which is locked",
            WheelMode::Free => continue,
        };
        if torque != 0.0 {
            let allowed = format!("zero for {}, {why}", wheel.name);
            let remedy = "leave that torque out, or set the wheel's mode to \"free\"";
            problems.add(key(), shown(&[torque]), allowed, remedy);
        }
    }
}

/// Checks for arcs that end before they start, or overlap, because of delays. Only the first is reported, under the key
/// of the arc if its own delays, or the next arc's, are the cause.
fn switches(input: &SceneInput, problems: &mut Problems) {
    let delays = &input.actuators;
    let commanded = |index: usize| {
        let command = &input.actuation[index];
        format!("such that actuation[{index}], commanded from {:?} to {:?},", command.start_s, command.end_s)
    };
    for index in 0..input.actuation.len() {
        let arc = applied(input, index);
        let next = (index + 1 < input.actuation.len()).then(|| applied(input, index + 1).start);
        let allowed = if arc.end() <= arc.start {
            format!("{} ends after it starts", commanded(index))
        } else if next.is_some_and(|next| arc.end() > next) {
            format!("{} ends before the next starts", commanded(index))
        } else {
            continue;
        };
        let with = |errors: &ArcErrors| {
            (delays.switch_on_delay_s + errors.switch_on_delay_s, delays.switch_off_delay_s + errors.switch_off_delay_s)
        };
        let [own, common] = [&input.actuation[index].errors, &ArcErrors::DEFAULT].map(with);
        let of_next = input.actuation.get(index + 1).map_or(common, |next| with(&next.errors));
        let key = if own == common && of_next == common {
            "actuators.switch_off_delay_s".to_owned()
        } else {
            format!("actuation[{index}].switch_off_delay_s")
        };
        let written = if of_next.0 == own.0 { format!("{own:?}") } else { format!("{own:?}, then {of_next:?}") };
        let remedy = "make the delays (on, off) smaller, or nearer to each other";
        problems.add(key, written, allowed, remedy);
        return;
    }
}

/// Checks the consequences of an input whose numbers are valid.
pub(super) fn derived(input: &SceneInput, mass: &MassProperties, problems: &mut Problems) {
    let is_normal = |value: f64| (f64::MIN_POSITIVE..=LARGEST).contains(&value);
    let mut body = |key: &dyn Fn() -> String, mass: f64, moments: [f64; 3]| {
        let passed = is_normal(mass) && moments.into_iter().all(is_normal);
        if !passed {
            let allowed = format!(
                "of a mass (kg) and moments of inertia (kg m^2) that are positive and finite numbers, at most \
                {LARGEST:e}"
            );
            problems.add(key(), format!("{:?}", (mass, moments)), allowed, "check the units of sizes and densities");
        }
        passed
    };
    let diagonal = |tensor: [[f64; 3]; 3]| [tensor[0][0], tensor[1][1], tensor[2][2]];
    let Body { mass: own, inertia, .. } = mass.body;
    let mut passed = true;
    let is_large = own > LARGEST || diagonal(inertia).into_iter().any(|moment| moment > LARGEST);
    if !input.body.includes_wheels || is_large {
        passed &= body(&|| "body".to_owned(), own, diagonal(inertia));
    }
    for (written, wheel) in input.turning().zip(&mass.wheels) {
        let name = || format!("wheels.{}", written.name);
        passed &= body(&name, wheel.mass, [wheel.axial, wheel.transverse, wheel.transverse]);
    }
    if let Some(debris) = mass.debris {
        passed &= body(&|| "debris".to_owned(), debris.mass, diagonal(debris.inertia));
    }
    if passed && input.body.includes_wheels {
        passed &= without_wheels(input, own, inertia, problems);
    }
    if passed {
        free_inertia(input.body.inertia_kg_m2.is_some(), mass, problems);
    }
}

/// Checks that mass properties with the wheels leave a body.
fn without_wheels(input: &SceneInput, own: f64, inertia: [[f64; 3]; 3], problems: &mut Problems) -> bool {
    if !(own.is_finite() && own > 0.0) {
        let allowed = "such that the body without its wheels has a mass above zero (the value shown, kg)";
        let remedy = "check the masses of body and wheels, or set body.includes_wheels = false";
        problems.add("body.mass_kg", shown(&[own]), allowed, remedy);
        return false;
    }
    let (moments, _) = principal_axes(inertia);
    let [smallest, largest] = extremes(moments);
    let total = moments.iter().sum::<f64>();
    if !(smallest > 0.0 && largest <= (total - largest) + 2.0 * INERTIA_SLACK * total) {
        if let Some((centre, arm)) = distant_centre(input) {
            let allowed = format!(
                "within a body's size of the wheels: it is {arm:.3} m from one of them, and what is left without the \
                wheels is not the inertia of a body"
            );
            let remedy = "check its unit (\"12 mm\"), the positions of the wheels, or set body.includes_wheels = false";
            problems.add("body.center_of_mass_m", shown(&centre), allowed, remedy);
            return false;
        }
        let allowed =
            "such that what is left without the wheels is the inertia of a body (the principal moments shown, kg m^2)";
        let remedy = "check the inertias of body and wheels and the positions of the wheels, or set \
            body.includes_wheels = false";
        problems.add("body.inertia_kg_m2", format!("{moments:?}"), allowed, remedy);
        return false;
    }
    true
}

/// Centre of mass and its distance from the farthest wheel, m, if beyond any body of that mass and inertia: three times
/// the largest radius of gyration.
fn distant_centre(input: &SceneInput) -> Option<([f64; 3], f64)> {
    let (centre, mass, tensor) = (input.body.center_of_mass_m?, input.body.mass_kg?, input.body.inertia_kg_m2?);
    let (moments, _) = principal_axes(tensor);
    let gyration = (extremes(moments)[1] / mass).sqrt();
    let arms = input.wheels.iter().map(|wheel| norm(difference(wheel.position_m, centre)));
    let arm = arms.fold(0.0, f64::max);
    (arm > 3.0 * gyration).then_some((centre, arm))
}

/// Checks that J* is positive definite, or the motion is undetermined.
fn free_inertia(overridden: bool, mass: &MassProperties, problems: &mut Problems) {
    let finite = mass.inertia.iter().flatten().all(|entry| entry.is_finite()) && mass.total.is_finite();
    if !finite || !is_positive_definite(mass.inertia_free) {
        problems.add(
            if overridden { "body.inertia_kg_m2" } else { "body" },
            format!("{:?}", mass.inertia_free),
            "such that the spacecraft's inertia with freely turning wheels, J* (the value shown, kg m^2), is positive \
            definite",
            "check the inertia override, and the units of sizes and densities",
        );
    }
}
