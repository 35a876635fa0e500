//! Control loops of campaign files: arcs flown are the run, loops follow linear theory, missions end with a reason.

use crate::prelude::*;
use std::fmt::Write as _;

use spindrift::scene::Arc;

use crate::support::campaigns::small_wheel;

pub(crate) fn plan(text: &str) -> Plan {
    planned(text)
}

/// A spacecraft at rest with one wheel about each axis and the inertia diag(30, 36, 24) kg m^2.
pub(crate) fn small_craft(control: &str, initial: &str) -> String {
    const HEAD: &str = "[campaign]\nname = \"loop\"\nsamples = 2\nseed = 1\nduration_s = 100\n\
        [integrator]\nmethod = \"auto\"\ntolerance = 1e-14\n[observe]\npoints = 401\n\
        groups = [\"final_state\", \"motion\", \"numerics\", \"energy_conservation\", \"momentum_conservation\"]\n";
    let wheels = [("w1", [1, 0, 0]), ("w2", [0, 1, 0]), ("w3", [0, 0, 1])].map(|(name, axis)| small_wheel(name, axis));
    [HEAD, SMALL_BODY, &wheels.concat(), "[initial]\n", initial, "\n", control].concat()
}

pub(crate) fn without(text: &str, headers: &[&str]) -> String {
    let mut keeps = true;
    let is_kept = |line: &&str| {
        if line.starts_with('[') {
            keeps = !headers.contains(&line.split('#').next().unwrap_or("").trim());
        }
        keeps
    };
    text.lines().filter(is_kept).fold(String::new(), |text, line| text + line + "\n")
}

fn schedule(arcs: &[Arc], wheels: &[&str], thrusters: &[&str]) -> String {
    let mut text = String::new();
    for arc in arcs.iter().filter(|arc| arc.applied.acts()) {
        let table = |names: &[&str], values: &[f64]| {
            let entries: Vec<_> = names.iter().zip(values).map(|(name, value)| format!("{name} = {value:?}")).collect();
            format!("{{ {} }}", entries.join(", "))
        };
        let _ = writeln!(text, "[[actuation]]\nstart_s = {:?}\nend_s = {:?}", arc.start, arc.end());
        let _ = writeln!(text, "torque_n_m = {}", table(wheels, &arc.applied.motor_torque));
        if !thrusters.is_empty() {
            let _ = writeln!(text, "thrust_n = {}", table(thrusters, &arc.applied.thrust));
        }
    }
    text
}

#[test]
fn the_arcs_flown_are_the_run() {
    for (text, wheels, thrusters) in
        [(SLEW_CLOSED, &["w1", "w2", "w3", "w4"][..], &[][..]), (DETUMBLE, &["w1", "w2"][..], &["p1", "p2", "p3"][..])]
    {
        let plan_of_loop = plan(text);
        for sample in [0, 3] {
            let flown = single(&plan_of_loop, sample);
            assert!(flown.arcs.len() > 500, "{} arcs", flown.arcs.len());
            let audit = flown.audit(&plan_of_loop, Isa::best()).unwrap();
            assert!(audit.state() < 1e-12, "sample {sample}: {:e}", audit.state());
            for name in ["energy_error_max", "angular_momentum_error_max"] {
                assert!(value(&flown, name).abs() < 1e-12, "{name} of sample {sample}: {:e}", value(&flown, name));
            }
            if sample > 0 {
                continue;
            }
            let mut open = without(text, &["[control]", "[[sensors]]", "[[guidance]]", "[[disperse]]", "[[require]]"]);
            open = open.replace("viscous_friction_n_m_s", "# ").replace("coulomb_friction_n_m", "# ");
            for key in ["torque_limit_n_m", "speed_limit_rad_s", "max_thrust_n", "min_on_time_s"] {
                open = open.replace(key, "# ");
            }
            let replayed = single(&plan(&(open + &schedule(&flown.arcs, wheels, thrusters))), 0);
            for field in [StateField::Rate, StateField::Attitude, StateField::WheelRates, StateField::ComVelocity] {
                for component in 0..2 {
                    let [a, b] = [&flown, &replayed].map(|run| run.table.column(field, component));
                    assert!(a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()), "{field:?} {component}");
                }
            }
        }
    }
}

pub(crate) fn hold(bandwidth: f64, damping: f64, period: f64, more: &str) -> String {
    format!(
        "[control]\nperiod_s = {period:?}\nwheels = [\"w1\", \"w2\", \"w3\"]\n{more}[[guidance]]\nphase = \
        \"hold\"\nlaw = \"quaternion_feedback\"\n\
         bandwidth_rad_s = {bandwidth:?}\ndamping = {damping:?}\ntarget = \"attitude\"\nattitude = [1, 0, 0, 0]\n"
    )
}

pub(crate) fn angles(run: &SingleRun) -> Vec<f64> {
    let [w, y] = [0, 2].map(|component| run.table.column(StateField::Attitude, component));
    let points = run.grid.points();
    w[..points].iter().zip(&y[..points]).map(|(w, y)| 2.0 * y.atan2(*w)).collect()
}

/// Law: a small angle follows the exact discrete solution of theta'' = -2 z w theta' - w^2 theta under a held torque.
#[test]
fn a_small_angle_loop_is_its_discrete_solution() {
    let (w, z, period, start) = (0.4, 0.7, 0.25, 1e-5_f64);
    let initial = format!("attitude = [{:?}, 0, {:?}, 0]", (0.5 * start).cos(), (0.5 * start).sin());
    for delay in [false, true] {
        let more = if delay { "delay_s = 0.25\n" } else { "" };
        let found = angles(&single(&plan(&small_craft(&hold(w, z, period, more), &initial)), 0));
        let (mut angle, mut rate, mut last) = (start, 0.0_f64, 0.0_f64);
        for (tick, found) in found.iter().enumerate() {
            assert!((angle - found).abs() < 1e-9 * start, "tick {tick}, delay {delay}: {angle:e} for {found:e}");
            let wanted = -2.0 * w * w * (0.5 * angle).sin() - 2.0 * z * w * rate;
            let acceleration = if delay { std::mem::replace(&mut last, wanted) } else { wanted };
            angle += rate * period + 0.5 * acceleration * period * period;
            rate += acceleration * period;
        }
    }
}

#[test]
fn hostile_loops_end() {
    let cases = [
        ("gain_n_m_s = 200.0", "gain_n_m_s = 1e12"),
        ("gain_n_m_s = 200.0", "gain_n_m_s = 1e300"),
        ("bandwidth_rad_s = 0.06", "bandwidth_rad_s = 1e8"),
        ("period_s = 0.5\ndelay_s = 0.1", "period_s = 5000.0\ndelay_s = 0.1"),
        ("delay_s = 0.1", "delay_s = 1e6"),
        ("max_rate_rad_s = \"3 deg/s\"", "max_rate_rad_s = 1e-300"),
        ("position_noise_m = 0.3", "position_noise_m = 1e200"),
        ("isp_s = 220.0", "isp_s = 1e-300"),
        ("min_on_time_s = 0.02", "min_on_time_s = 0.5"),
    ];
    for (from, to) in cases {
        assert!(NET_LAUNCH.contains(from), "{from}");
        let mut text = NET_LAUNCH.replace(from, to).replace("duration_s = 2400.0", "duration_s = 100.0");
        if to.starts_with("period_s = 5000") {
            for line in ["latency_s = 0.5\n", "latency_s = 1.0\n", "period_s = 2.0\n", "period_s = 1.0\n"] {
                text = text.replace(line, "");
            }
        }
        text = text.replace("tolerance = 1e-12", "tolerance = 1e-12\nmax_steps = 100000");
        let plan = plan(&text);
        for sample in [0, 1] {
            let run = single_on(&plan, sample, Grid::uniform(100.0, 11));
            assert!(run.outcome.status == Status::Done || !run.reason.is_empty(), "{to}: {:?}", run.outcome);
        }
    }
}

#[test]
fn what_acts_in_a_loop_alone_is_refused() {
    let open = without(NET_LAUNCH, &["[control]", "[[guidance]]", "[[disperse]]", "[[require]]"]);
    let error = parsed(&open).expect_err("no loop").to_string();
    for key in ["sensors", "wheels.w1.torque_limit_n_m", "thrusters.p3.max_thrust_n"] {
        assert!(error.lines().any(|line| line.contains(key) && line.contains("without [control]")), "{key}: {error}");
    }
}

#[test]
fn debris_at_rest_can_be_pointed_at() {
    let text = include_str!("../../../campaigns/point_at_debris.toml")
        .replace("debris_velocity_m_s = [0.2, 0.0, 0.0]", "debris_velocity_m_s = [0, 0, 0]");
    let run = single(&plan(&text), 0);
    assert_eq!(value(&run, "failure"), 0.0);
    assert!(value(&run, "pointing_error_final_rad") < 0.02, "{}", value(&run, "pointing_error_final_rad"));
}
