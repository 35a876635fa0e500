//! Every column of a control loop, recomputed from true states, arcs and estimates.

use crate::prelude::*;

use spindrift::{
    dynamics::environment::sun::sun,
    loops::{phase::Maneuver, target::Target},
    math::vector::quaternion_from_dcm,
};

use crate::loops::{
    actuators::driven_wheels,
    cases::{Case, cases},
    flown_loop::{State, angle_between},
};

const AGREED: f64 = 1e-11;

/// Standard gravity, m/s^2 (ISO 80000-3).
const STANDARD_GRAVITY: f64 = 9.80665;

/// The reasons of docs/control.md in the order of their codes; the last two, of modules, have tests of their own.
const FAILURES: [&str; 7] = ["none", "timeout", "wheel_saturated", "lost_target", "keep_out", "no_axis", "diverged"];

fn axis(flown: &FlownLoop, state: &State) -> [f64; 3] {
    let velocity = state.debris().v_gdo_e;
    if norm(velocity) >= flown.control("least_debris_speed_m_s") {
        return scaled(1.0 / norm(velocity), velocity);
    }
    let named = flown.plan.nominal.control.named("approach_axis").unwrap();
    let named = [named[0], named[1], named[2]];
    scaled(1.0 / norm(named), named)
}

fn to_station(flown: &FlownLoop, state: &State) -> [f64; 3] {
    let station = difference(state.debris().r_gdo_e, scaled(flown.control("launch_distance_m"), axis(flown, state)));
    difference(station, state.r_co_e)
}

fn to_debris(state: &State) -> [f64; 3] {
    difference(state.debris().r_gdo_e, state.r_co_e)
}

fn relative_velocity(state: &State) -> [f64; 3] {
    difference(state.v_co_e, state.debris().v_gdo_e)
}

fn error_vector(flown: &FlownLoop, place: usize, state: &State, arrival: f64) -> Option<[f64; 3]> {
    let phase = &flown.spec().phases[place];
    let direction = match phase.target {
        Target::None => return None,
        Target::Attitude(_) => {
            let Some(&[w, x, y, z]) = flown.guidance(place, "attitude") else { panic!("an attitude") };
            return Some(rotation_vector(hamilton(conjugate([w, x, y, z]), state.q_es)));
        }
        Target::Orbital(_) => {
            let Some(&[w, x, y, z]) = flown.guidance(place, "attitude") else { panic!("an attitude") };
            // the columns of C_eo are the axes of the orbital frame
            let o3 = scaled(-1.0 / norm(state.r_co_e), state.r_co_e);
            let normal = cross(state.r_co_e, state.v_co_e);
            let o2 = scaled(-1.0 / norm(normal), normal);
            let o1 = cross(o2, o3);
            let c_eo = from_fn(|i| [o1[i], o2[i], o3[i]]);
            let q_et = hamilton(quaternion_from_dcm(c_eo), [w, x, y, z]);
            return Some(rotation_vector(hamilton(conjugate(q_et), state.q_es)));
        }
        Target::Nadir => scaled(-1.0, state.r_co_e),
        Target::OrbitalVelocity => state.v_co_e,
        Target::Sun => {
            let epoch = flown.plan.nominal.orbit.and_then(|orbit| orbit.epoch).unwrap();
            sun(epoch.days_since_j2000() + state.time / 86_400.0).direction
        }
        Target::LineToDebris => to_debris(state),
        Target::LaunchAxis => axis(flown, state),
        Target::Velocity => relative_velocity(state),
        Target::Stop => scaled(-1.0, relative_velocity(state)),
        Target::Transfer => {
            let left = match phase.thrust {
                Maneuver::Transfer => arrival - state.time,
                _ => flown.guidance(place, "transfer_time_s").unwrap()[0],
            };
            if left < flown.spec().period {
                return Some([0.0; 3]);
            }
            difference(scaled(1.0 / left, to_station(flown, state)), relative_velocity(state))
        }
    };
    let s3 = state.s3_e();
    let angle = angle_between(s3, direction);
    let across = cross(direction, s3);
    let back = scaled(angle / norm(across), across);
    Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| dot(back, state.to_e(axis))))
}

type Columns = BTreeMap<String, f64>;

fn mission(case: &Case, found: &mut Columns) {
    let (flown, phases) = (&case.flown, case.phases());
    let code = FAILURES.iter().position(|name| *name == case.failure).unwrap();
    found.insert("failure".into(), code as f64);
    found.insert("launched".into(), if code == 0 && flown.end.is_some() { 1.0 } else { 0.0 });
    found.insert("phase_final".into(), *phases.last().unwrap() as f64);
    found.insert("end_time_s".into(), flown.end.unwrap_or(f64::NAN));
    for (place, phase) in flown.spec().phases.iter().enumerate() {
        let first = phases.iter().position(|other| *other == place).map(|tick| flown.ticks[tick].time);
        found.insert(format!("phase_{}_begin_s", phase.name), first.unwrap_or(f64::NAN));
    }
}

fn pointing(case: &Case, found: &mut Columns) {
    let (flown, phases) = (&case.flown, case.phases());
    let (mut arrival, mut since, mut errors, mut all) = (f64::NAN, f64::NAN, Vec::new(), Vec::new());
    for (tick, (place, state)) in phases.iter().zip(&flown.ticks).enumerate() {
        let begins = tick == 0 || phases[tick - 1] != *place;
        if begins && flown.spec().phases[*place].thrust == Maneuver::Transfer {
            arrival = state.time + flown.guidance(*place, "transfer_time_s").unwrap()[0];
        }
        let error = error_vector(flown, *place, state, arrival);
        all.push((state.time, error));
        let Some(error) = error else { continue };
        if begins {
            (since, errors) = (state.time, Vec::new());
        }
        errors.push((state.time, error));
    }
    stability(flown, &all, found);
    let band = flown.control("settling_band_rad");
    let last_outside = errors.iter().rposition(|(_, error)| norm(*error) > band);
    let settled = errors.get(last_outside.map_or(0, |last| last + 1)).map(|(time, _)| time - since);
    found.insert("settling_time_s".into(), settled.unwrap_or(f64::NAN));
    let first = errors.iter().map(|(_, error)| *error).find(|error| norm(*error) > 0.0);
    let beyond =
        |first: [f64; 3]| errors.iter().map(|(_, error)| -dot(first, *error) / norm(first)).fold(0.0, f64::max);
    found.insert("overshoot_rad".into(), if since.is_nan() { f64::NAN } else { first.map_or(0.0, beyond) });
    found.insert("pointing_error_final_rad".into(), errors.last().map_or(f64::NAN, |(_, error)| norm(*error)));
}

/// The settling time, and the relative performance error over the window that begins then or at a time of the file.
fn stability(flown: &FlownLoop, errors: &[(f64, Option<[f64; 3]>)], found: &mut Columns) {
    let band = flown.control("settling_band_rad");
    let last_outside = errors.iter().rposition(|(_, error)| error.is_none_or(|error| norm(error) > band));
    let settled = errors.get(last_outside.map_or(0, |last| last + 1)).map_or(f64::NAN, |(time, _)| *time);
    found.insert("mission_settling_time_s".into(), settled);
    let [from, length] = ["stability_from_s", "stability_window_s"].map(|key| flown.control(key));
    let (start, near) = (if from > 0.0 { from } else { settled }, 1e-6 * flown.spec().period);
    let is_within = |time: f64| time > start - near && (length == 0.0 || time < start + length - near);
    let window: Vec<Option<[f64; 3]>> =
        errors.iter().filter(|(time, _)| is_within(*time)).map(|(_, error)| *error).collect();
    let end = errors.last().map_or(f64::NAN, |(time, _)| time + flown.spec().period + near);
    let is_complete = if length == 0.0 { window.len() > 1 } else { !window.is_empty() && end > start + length };
    let [rms, swing] = match window.into_iter().collect::<Option<Vec<[f64; 3]>>>() {
        Some(errors) if is_complete => {
            let count = errors.len() as f64;
            let mean = scaled(1.0 / count, errors.iter().fold([0.0; 3], |total, error| sum(total, *error)));
            let square: f64 = errors.iter().map(|error| norm(difference(*error, mean)).powi(2)).sum();
            let swing = |axis: usize| {
                let of_axis = || errors.iter().map(|error| error[axis]);
                of_axis().fold(f64::NEG_INFINITY, f64::max) - of_axis().fold(f64::INFINITY, f64::min)
            };
            [(square / count).sqrt(), swing(0).max(swing(1)).max(swing(2))]
        }
        _ => [f64::NAN; 2],
    };
    found.insert("relative_performance_error_rms_rad".into(), rms);
    found.insert("relative_performance_error_peak_to_peak_rad".into(), swing);
}

fn approach(case: &Case, found: &mut Columns) {
    let flown = &case.flown;
    if flown.run.scene.mass.debris.is_none() {
        return;
    }
    let nearest = flown.ticks.iter().map(|state| norm(to_debris(state))).fold(f64::INFINITY, f64::min);
    found.insert("debris_distance_min_m".into(), nearest);
    let launched = (case.failure == "none" && flown.end.is_some()).then(|| flown.ticks.last().unwrap());
    let mut at = |name: &str, value: &dyn Fn(&State) -> f64| {
        found.insert(name.to_owned(), launched.map_or(f64::NAN, value));
    };
    at("pointing_error_launch_rad", &|state| angle_between(state.s3_e(), to_debris(state)));
    at("axis_offset_launch_m", &|state| norm(cross(to_debris(state), axis(flown, state))));
    at("distance_error_launch_m", &|state| {
        dot(to_debris(state), axis(flown, state)) - flown.control("launch_distance_m")
    });
    at("relative_speed_launch_m_s", &|state| norm(relative_velocity(state)));
    at("body_rate_launch_rad_s", &|state| norm(state.omega_se_s));
    at("tumble_axis_angle_launch_rad", &|state| {
        let (debris, body) = (state.debris(), flown.run.scene.mass.debris.unwrap());
        let momentum = hamilton_turned(debris.q_ed, product(body.inertia, debris.omega_de_d));
        let angle = angle_between(momentum, axis(flown, state));
        angle.min(std::f64::consts::PI - angle)
    });
    at("wheel_speed_margin_launch_rad_s", &|state| {
        let limits = flown.run.scene.actuators.wheels.iter().map(|model| model.speed_limit);
        limits.zip(&state.wheel_rates).map(|(limit, rate)| limit - rate.abs()).fold(f64::INFINITY, f64::min)
    });
}

fn hamilton_turned(q: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let [_, x, y, z] = hamilton(hamilton(q, [0.0, v[0], v[1], v[2]]), conjugate(q));
    [x, y, z]
}

fn thrust(case: &Case, found: &mut Columns) {
    let flown = &case.flown;
    let (spec, scene) = (flown.spec(), &flown.run.scene);
    let (mut total, mut change, mut plume) = (0.0, 0.0, 0.0);
    let mut impulses = vec![0.0; scene.thrusters.len()];
    for (arc, state) in &flown.arcs {
        let length = arc.end() - arc.start;
        let (mut force, mut hits) = ([0.0; 3], false);
        for (place, thruster) in scene.thrusters.iter().enumerate() {
            let thrust = arc.applied.thrust[place];
            impulses[place] += thrust * length;
            total += thrust * length;
            force = sum(force, scaled(thrust, thruster.direction));
            if thrust > 0.0 && state.debris.is_some() {
                let line = to_debris(state);
                let plume = scaled(-1.0, state.to_e(thruster.direction));
                hits |= norm(line) < flown.control("plume_range_m")
                    && angle_between(plume, line) < flown.control("plume_half_angle_rad");
            }
        }
        change += norm(force) * length / scene.mass.total;
        plume += if hits { length } else { 0.0 };
    }
    for place in spec.thrusters.iter().copied() {
        found.insert(format!("impulse_{}_n_s", spec.thruster_names[place]), impulses[place]);
    }
    found.insert("impulse_total_n_s".into(), total);
    found.insert("delta_v_m_s".into(), change);
    let specific_impulse = flown.control("isp_s");
    let propellant = if specific_impulse > 0.0 { total / specific_impulse / STANDARD_GRAVITY } else { f64::NAN };
    found.insert("propellant_kg".into(), propellant);
    found.insert("plume_time_s".into(), plume);
}

fn wheels(case: &Case, found: &mut Columns) {
    let flown = &case.flown;
    let (spec, scene) = (flown.spec(), &flown.run.scene);
    for place in spec.wheels.iter().copied() {
        let peak = flown.ticks.iter().map(|state| state.wheel_rates[place].abs()).fold(0.0, f64::max);
        found.insert(format!("speed_peak_{}_rad_s", spec.wheel_names[place]), peak);
    }
    let stored = |state: &State| {
        let wheels = scene.mass.wheels.iter().zip(&state.wheel_rates);
        norm(wheels.fold([0.0; 3], |total, (wheel, rate)| sum(total, scaled(wheel.axial * rate, wheel.axis))))
    };
    found.insert("wheel_momentum_peak_n_m_s".into(), flown.ticks.iter().map(stored).fold(0.0, f64::max));
    let (mut by_torque, mut by_speed, mut excess) = (0.0, 0.0, 0.0_f64);
    for ((arc, _), wheels) in flown.arcs.iter().zip(driven_wheels(flown)) {
        let length = arc.end() - arc.start;
        by_torque += if wheels.iter().any(|driven| driven.is_torque_limited) { length } else { 0.0 };
        by_speed += if wheels.iter().any(|driven| driven.is_speed_limited) { length } else { 0.0 };
        excess = wheels.iter().fold(excess, |most, driven| most.max(driven.excess));
    }
    found.insert("torque_saturated_s".into(), by_torque);
    found.insert("speed_saturated_s".into(), by_speed);
    found.insert("torque_excess_max_n_m".into(), excess);
}

fn estimation(case: &Case, found: &mut Columns) {
    let ticks = &case.flown.ticks;
    let attitudes = case.told_vector::<4>("estimated_q_es_#");
    let errors: Vec<f64> = attitudes
        .iter()
        .zip(ticks)
        .map(|(q, state)| norm(rotation_vector(hamilton(conjugate(*q), state.q_es))))
        .collect();
    found.insert("attitude_estimate_error_final_rad".into(), *errors.last().unwrap());
    found.insert("attitude_estimate_error_max_rad".into(), errors.iter().copied().fold(0.0, f64::max));
    if let Some(state) = ticks.last().filter(|state| state.debris.is_some()) {
        let last = |name: &str| *case.told_vector::<3>(name).last().unwrap();
        let position = difference(last("estimated_to_debris_e_#_m"), to_debris(state));
        found.insert("relative_position_estimate_error_final_m".into(), norm(position));
        let velocity = difference(last("estimated_relative_velocity_e_#_m_s"), relative_velocity(state));
        found.insert("relative_velocity_estimate_error_final_m_s".into(), norm(velocity));
    }
    if !case.flown.spec().has_filter() {
        return;
    }
    let of_debris = [("debris_motion", "debris_motion"), ("debris_attitude", "debris")];
    let has_debris = case.flown.run.scene.mass.debris.is_some();
    let named = [("attitude", "attitude"), ("motion", "motion")]
        .into_iter()
        .chain(of_debris.into_iter().filter(|_| has_debris));
    for (column, recorded) in named {
        if recorded == "debris" && !case.flown.spec().has_camera() {
            // without a camera the attitude of the debris is predicted but not recorded
            found.insert(format!("{column}_innovation_mean"), f64::NAN);
            continue;
        }
        found.insert(format!("{column}_nees_final"), *case.told(&format!("{recorded}_nees")).last().unwrap());
        let squares = case.told(&format!("{recorded}_innovation_square"));
        let known: Vec<f64> = squares.into_iter().filter(|square| !square.is_nan()).collect();
        let mean = known.iter().sum::<f64>() / known.len() as f64;
        found.insert(format!("{column}_innovation_mean"), mean);
    }
}

fn recomputed(case: &Case) -> Columns {
    let mut found = Columns::new();
    for part in [mission, pointing, approach, thrust, wheels, estimation] {
        part(case, &mut found);
    }
    found
}

/// Law: every column of a loop in the program's list is recomputed from true states, arcs flown and estimates.
#[test]
fn every_column_is_what_the_run_says() {
    let mut unseen = BTreeSet::new();
    let mut seen = BTreeSet::new();
    for (name, case) in cases() {
        let flown = &case.flown;
        let expected = recomputed(&case);
        let columns = flown.run.request.columns();
        for place in flown.run.request.places_of_law() {
            let column = columns[place].quantity.name();
            if column == "debris_attitude_nees_final" && !flown.spec().has_camera() {
                continue;
            }
            let found = flown.run.row[place];
            let expected =
                *expected.get(column).unwrap_or_else(|| panic!("{column} has no recomputation: add one above"));
            let off = (found - expected).abs() / expected.abs().max(1.0);
            assert!(
                off < AGREED || (found.is_nan() && expected.is_nan()),
                "{name}: {column} is {found:e}, not {expected:e}"
            );
            let is_start = column.starts_with("phase_") && expected == 0.0;
            if is_start || (expected.is_finite() && expected.abs() > 1e-9) {
                seen.insert(column.to_owned());
                unseen.remove(column);
            } else if !seen.contains(column) {
                unseen.insert(column.to_owned());
            }
        }
    }
    assert!(unseen.is_empty(), "no run tells these from zero: {unseen:?}");
    assert!(seen.len() > 50, "{}", seen.len());
}
