//! Sizes computed from several numbers of the nominal scene, draws or the file.

use super::looked::{Looked, digits, most_of};
use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::drawn::{magnitudes, mass_properties};
use crate::loops::observes::Observes;
use crate::loops::rod_law::RodLaw;
use crate::loops::sensor_spec::SensorSpec;
use crate::loops::target::Target;
use crate::math::vector::{conjugate, dot, hamilton, norm};
use crate::observables::Group;
use crate::observables::request::{NutationAxis, nearest_principal_axis};
use crate::sampling::keys::{Value, Written};
use crate::sampling::{Dispersion, SampleId};
use crate::scene::parameter::Shape;
use crate::scene::{LocalFrame, Orbit, OrbitInput, Parameter, WheelMode};
use std::f64::consts::{PI, TAU};

const YEAR: f64 = 365.25 * 86_400.0;
const MANY_POINTS: f64 = 1e7;
const RANGE_DRAWS: usize = 30;
const RATES: u64 = 1000;
const ORBITS: u64 = 200;

/// Takes a size and the start of its note.
pub type Note<'a> = dyn FnMut(f64, String) + 'a;

pub fn duration(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let duration = looked.plan.grid.duration();
    note(duration, format!("campaign.duration_s = {}: that is {} years", digits(duration), digits(duration / YEAR)));
}

pub fn scalar_last(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    for parameter in looked.parameters().filter(|parameter| parameter.shape() == Shape::Quaternion) {
        let values: Vec<f64> =
            (0..4).filter_map(|component| parameter.value(&looked.plan.nominal, component)).collect();
        let turn = 2.0 * libm::atan2(norm([values[1], values[2], values[3]]), values[0].abs()).to_degrees();
        let shown: Vec<String> = values.iter().map(|value| digits(*value)).collect();
        let what = format!("{} = [{}]: a turn of {} deg", parameter.name(), shown.join(", "), digits(turn));
        note(values[3].abs() / values.iter().fold(0.0, |size, value| libm::hypot(size, *value)), what);
    }
}

/// The turn in one draw of a hundred, rad, of quaternions dispersed by components.
pub fn drawn_by_components(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let turns: Vec<_> = magnitudes(looked.plan).into_iter().zip(&looked.drawn.magnitudes).collect();
    for Dispersion { parameter, distribution, .. } in &looked.plan.dispersed {
        if parameter.shape() != Shape::Quaternion || !distribution.kind.is_of_one_number() {
            continue;
        }
        let turns = turns.iter().find(|(magnitude, _)| magnitude.parameter == *parameter);
        if let Some(size) = turns.and_then(|(_, turns)| most_of((*turns).clone())) {
            let (name, kind, angle) = (parameter.name(), distribution.kind.name(), digits(size.to_degrees()));
            note(
                size,
                format!(
                    "{name}: distribution = {kind:?} draws each component by itself, {angle} deg off in 1 draw of 100"
                ),
            );
        }
    }
}

pub fn attitude_error(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    for dispersion in &looked.plan.dispersed {
        if let Some(std) = dispersion.distribution.written.numbers("std_rad") {
            let size = largest(std.iter().copied());
            let (name, degrees) = (dispersion.parameter.name(), digits(size * 360.0 / TAU));
            note(size, format!("{name}: std_rad = {} is {degrees} deg", digits(size)));
        }
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| most.max(value.abs()))
}

pub fn sensor_scale(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    for table in &looked.plan.nominal.control.sensors {
        let off = |scale: &&f64| (**scale - 1.0).abs();
        let scales = table.named("scale").into_iter().flatten();
        if let Some(scale) = scales.max_by(|a, b| off(a).total_cmp(&off(b))) {
            note(off(&scale), format!("sensors.{}.scale: {scale:?}", table.name));
        }
    }
}

pub fn periods(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let Some(spec) = looked.spec() else { return };
    let mut noted = |name: String, time: f64| {
        note(time, format!("{name} = {time:?}: that is {} min", digits(time / 60.0)));
    };
    noted("control.period_s".to_owned(), spec.period);
    if let Some(delay) = looked.plan.nominal.control.named("delay_s") {
        noted("control.delay_s".to_owned(), delay[0]);
    }
    for sensor in &spec.sensors {
        // the period of the loop is judged once
        if sensor.period != spec.period {
            noted(format!("sensors.{}.period_s", sensor.name), sensor.period);
        }
        noted(format!("sensors.{}.latency_s", sensor.name), sensor.latency);
    }
}

/// Rates to which the schedule drives wheels that start below `limit`, rad/s.
pub fn driven_wheels(looked: &Looked<'_>, limit: f64, note: &mut Note<'_>) {
    let Ok(scene) = &looked.scene else { return };
    let turning = looked.plan.nominal.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked).enumerate();
    for (place, wheel) in turning.filter(|(_, wheel)| wheel.rate_rad_s.abs() < limit) {
        let (mut rate, mut most) = (wheel.rate_rad_s, 0.0_f64);
        for arc in &scene.schedule {
            rate += arc.applied.motor_torque[place] * (arc.end() - arc.start) / scene.mass.wheels[place].axial;
            most = most.max(rate.abs());
        }
        let rpm = digits(most * 60.0 / TAU);
        note(most, format!("wheels.{}: the torques of [[actuation]] bring it to about {rpm} rpm", wheel.name));
    }
}

/// Mass, kg, and principal moments, ascending, kg m^2.
fn inertia(looked: &Looked<'_>) -> Option<(f64, [f64; 3])> {
    let [mass, _, _, _, a, b, c] = mass_properties(looked.scene.as_ref().ok()?);
    Some((mass, [a, b, c]))
}

pub fn mass(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    if let Some((mass, _)) = inertia(looked) {
        note(mass, format!("the spacecraft has a mass of {} kg", digits(mass)));
    }
}

/// Largest radius of gyration over the cube root of the mass, m/kg^(1/3).
pub fn radius_of_gyration(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let Some((mass, [_, _, largest])) = inertia(looked) else { return };
    let radius = libm::sqrt(largest / mass);
    let (kilograms, moment, metres) = (digits(mass), digits(largest), digits(radius));
    let what = format!(
        "the spacecraft has {kilograms} kg and a principal moment of {moment} kg m^2: its radius of gyration is \
        {metres} m"
    );
    note(radius / libm::cbrt(mass), what);
}

/// Relative excess of the two smaller principal moments over the largest.
pub fn flatness(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let Some((_, moments @ [a, b, c])) = inertia(looked) else { return };
    let excess = (a + b - c) / c;
    let (shown, almost) = (moments.map(digits).join(", "), if excess.abs() > 1e-12 { "almost " } else { "" });
    note(excess, format!("principal moments [{shown}] kg m^2: the largest is {almost}the sum of the others"));
}

/// The area of all plates over the mass, m^2/kg.
pub fn area(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let area: f64 = looked.plan.nominal.plates.iter().map(|plate| plate.area_m2).sum();
    if let Some((mass, _)) = inertia(looked) {
        note(area / mass, format!("[[plates]] have {} m^2 for {} kg", digits(area), digits(mass)));
    }
}

/// Torque limit of each wheel over the smallest principal moment, rad/s^2.
pub fn wheel_torque(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let Some((_, [smallest, ..])) = inertia(looked) else { return };
    for wheel in &looked.plan.nominal.wheels {
        if let Some(torque) = wheel.torque_limit_n_m {
            let (name, turned) = (wheel.name, digits(torque / smallest));
            let what = format!("wheels.{name}.torque_limit_n_m = {torque:?} turns the spacecraft by {turned} rad/s^2");
            note(torque / smallest, what);
        }
    }
}

/// Relative spreads, also of nested distributions.
pub fn wide_spreads(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    fn of(name: &str, written: &Written, note: &mut Note<'_>) {
        for (key, value) in written.entries() {
            match value {
                Value::Distribution(_, within) => of(name, within, note),
                Value::Numbers(values) if key.starts_with("relative_") => {
                    note(largest(values.flat().into_iter()), format!("{name}, {key} = {values:?}"));
                }
                _ => {}
            }
        }
    }
    for dispersion in &looked.plan.dispersed {
        of(&dispersion.parameter.name(), &dispersion.distribution.written, note);
    }
}

/// Distance of a nominal value outside the range of its draws, over that range; the largest of each parameter.
pub fn nominal_outside(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let mut notes: Vec<(Parameter, f64, String)> = Vec::new();
    if looked.drawn.count() < RANGE_DRAWS {
        return;
    }
    let written: Vec<_> = looked.plan.dispersed.iter().flat_map(|dispersion| dispersion.components()).collect();
    for (column, values) in looked.plan.dispersions.columns().iter().zip(&looked.drawn.columns) {
        let (parameter, nominal) = (column.parameter, column.nominal);
        let [low, high] = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
        let beyond = (low - nominal).max(nominal - high);
        if beyond <= 0.0 || !written.contains(&(parameter, column.component)) {
            continue;
        }
        let (name, shown) = (parameter.component_name(column.component), [nominal, low, high].map(digits));
        let [value, low_end, high_end] = shown;
        let what = format!("{name}: its nominal value {value} is outside of its draws, {low_end} to {high_end}");
        let found = (parameter, beyond / (high - low), what);
        match notes.iter_mut().find(|(of, ..)| *of == parameter) {
            Some(other) if other.1 < found.1 => *other = found,
            Some(_) => {}
            None => notes.push(found),
        }
    }
    notes.into_iter().for_each(|(_, size, what)| note(size, what));
}

/// Angle between the local orbital frames of drawn orbits and the nominal one, plus the drift of their mean motions, if
/// flight software uses the nominal one; rad.
pub fn unknown_orbit(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let plan = looked.plan;
    let columns = plan.dispersions.columns().iter().map(|column| column.parameter.name());
    let mut dispersed: Vec<String> = columns.filter(|name| name.starts_with("orbit.")).collect();
    dispersed.dedup();
    let is_used = looked.spec().is_some_and(|spec| {
        let is_orbital = |target| matches!(target, Target::Orbital(_) | Target::Nadir | Target::OrbitalVelocity);
        // its measurement is predicted at the believed place
        let is_of_place = |sensor: &SensorSpec| sensor.kind.needs.is_some();
        let is_measured = spec.has_filter() && spec.sensors.iter().any(is_of_place);
        !spec.knows_the_truth() && (is_measured || spec.phases.iter().any(|phase| is_orbital(phase.target)))
    });
    let (Some(nominal), false, true) = (plan.nominal.orbit.as_ref().map(flown), dispersed.is_empty(), is_used) else {
        return;
    };
    let mut draws = SceneDraws::new(plan);
    let angle = |sample: u64| {
        let (q_eo, motion) = flown(draws.input(SampleId(sample)).orbit.as_ref()?);
        let [w, x, y, z] = hamilton(conjugate(nominal.0), q_eo);
        let turn = 2.0 * libm::atan2(norm([x, y, z]), w.abs());
        let parted = (motion - nominal.1).abs() * plan.grid.duration();
        Some((turn + parted).min(PI)).filter(|angle| angle.is_finite())
    };
    let size = most_of((1..plan.samples.min(ORBITS + 1)).filter_map(angle).collect()).unwrap_or(0.0);
    let what = format!(
        "{}: drawn orbits are off the nominal one by {} deg in 1 draw of 100",
        dispersed.join(", "),
        digits(size.to_degrees())
    );
    note(size, what);
}

fn flown(orbit: &OrbitInput) -> ([f64; 4], f64) {
    let Orbit { mu, position, velocity, .. } = Orbit::of(orbit);
    let inverse_axis = 2.0 / norm(position) - dot(velocity, velocity) / mu;
    (LocalFrame::at(position, velocity).q_eo, libm::sqrt(mu * inverse_axis.powi(3)))
}

/// Angle of the principal axis from s3, deg, if nutation is measured from s3.
pub fn nutation(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let plan = looked.plan;
    let is_observed = plan.groups.contains(&Group::Motion) && plan.nutation_axis == NutationAxis::SpinAxis;
    let Some(scene) = looked.scene.as_ref().ok().filter(|_| is_observed) else { return };
    let [x, y, z] = nearest_principal_axis(scene.mass.inertia);
    let angle = libm::atan2(libm::hypot(x, y), z).to_degrees();
    note(angle, format!("the principal axis is {} deg off s3", digits(angle)));
}

/// Turn of the body between observation points, rad.
pub fn coarse_grid(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let (grid, initial) = (&looked.plan.grid, &looked.plan.nominal.initial);
    let step = grid.duration() / (grid.points().max(2) - 1) as f64;
    let rate = norm(initial.angular_velocity_rad_s);
    let turn = rate * step;
    let enough = libm::ceil(rate * grid.duration() / PI * 4.0) + 1.0;
    let enough = if enough < MANY_POINTS { format!(" ({enough} points are eight to a turn)") } else { String::new() };
    let (points, turns) = (grid.points(), digits(turn / TAU));
    note(turn, format!("observe.points = {points}: the body makes {turns} turns from one point to the next{enough}"));
}

/// Turn of the body over the lag of B-dot at the largest initial rate, rad. The held dipole opposes the field's change
/// half a measurement interval before, so that its mean power is that of a prompt dipole times the cosine of the turn.
pub fn late_rods(looked: &Looked<'_>, most: f64, note: &mut Note<'_>) {
    let rods = looked.spec().and_then(|spec| {
        let phase = spec.phases.iter().find(|phase| matches!(phase.rods, RodLaw::BDot { .. }))?;
        let is_field = |sensor: &&SensorSpec| matches!(sensor.kind.observes, Observes::Field(_));
        Some((spec, phase, spec.sensors.iter().find(is_field)?))
    });
    let Some((spec, phase, sensor)) = rods else { return };
    let plan = looked.plan;
    let delay = sensor.latency + plan.nominal.control.named("delay_s").map_or(0.0, |numbers| numbers[0]);
    let lag = 0.5 * (sensor.period + sensor.period.max(spec.period)) + delay;
    let nominal = (norm(plan.nominal.initial.angular_velocity_rad_s), "the nominal initial rate");
    let mut draws = SceneDraws::new(plan);
    let drawn = (1..plan.samples.min(RATES + 1)).map(|sample| {
        let rate = norm(draws.input(SampleId(sample)).initial.angular_velocity_rad_s);
        (rate, "the largest initial rate that was drawn")
    });
    let (rate, whose) = drawn.fold(nominal, |largest, one| if one.0 > largest.0 { one } else { largest });
    let (name, degrees, turns) = (sensor.name, digits(rate.to_degrees()), digits(rate * lag / TAU));
    let enough = match most / rate - delay {
        period if period > 0.0 => format!("sensors.{name}.period_s and control.period_s below {} s", digits(period)),
        _ => "no period with this latency and delay".to_owned(),
    };
    let what = format!(
        "guidance.{}: at {degrees} deg/s, {whose}, the body makes {turns} turns over the lag of B-dot, {} s ({enough} \
         are short enough)",
        phase.name,
        digits(lag)
    );
    note(rate * lag, what);
}

/// Ends of the air table, as distances from the centre, m.
pub fn ends_of_air(plan: &Plan) -> Option<[f64; 2]> {
    let heights = plan.nominal.environment.air_heights_m.filter(|_| plan.nominal.environment.drag)?;
    let surface = plan.nominal.orbit.as_ref()?.body_radius_m;
    Some([heights.first()?, heights.last()?].map(|height| surface + height))
}

/// Distance of the nominal orbit beyond the air table, m.
pub fn beyond_air(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let ends = ends_of_air(looked.plan).zip(looked.plan.nominal.orbit.as_ref());
    let Some(([low, high], orbit)) = ends else { return };
    let shape = Orbit::of(orbit).shape();
    let beyond = (low - shape.periapsis).max(shape.semi_major_axis * (1.0 + shape.eccentricity) - high);
    if beyond > 0.0 {
        let kilometres = digits(beyond / 1e3);
        note(beyond, format!("environment.air_heights_m: the nominal orbit is up to {kilometres} km beyond"));
    }
}

/// Start of the first arc after the end of the run, s, from that end.
pub fn late_arcs(looked: &Looked<'_>, _: f64, note: &mut Note<'_>) {
    let duration = looked.plan.grid.duration();
    let mut arcs = looked.plan.nominal.actuation.iter().map(|arc| arc.start_s).enumerate();
    if let Some((place, start)) = arcs.find(|(_, start)| *start >= duration) {
        let what = format!("actuation[{place}].start_s = {start:?} (campaign.duration_s = {duration:?})");
        note(start - duration, what);
    }
}
