//! Control loops of campaign files: rows are functions of plan and sample, arcs flown are the run, loops follow linear
//! theory, missions end with a reason.

use std::fmt::Write as _;
use std::num::NonZeroUsize;

use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::SingleRun;
use spindrift::math::Isa;
use spindrift::run::{Grid, StateField, Status};
use spindrift::sampling::SampleId;
use spindrift::scene::Arc;
use spindrift::workflow::{Campaign, Quiet, Session};

use crate::support::campaigns::{SMALL_BODY, small_wheel};
use crate::support::scratch_folder::ScratchFolder;

pub const NET_LAUNCH: &str = include_str!("../../../campaigns/net_launch.toml");
pub(crate) const SLEW_CLOSED: &str = include_str!("../../../campaigns/slew_closed.toml");
const DETUMBLE: &str = include_str!("../../../campaigns/detumble.toml");

pub(crate) fn plan(text: &str) -> Plan {
    Plan::from_text("loop.toml", text, Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn run(plan: &Plan, sample: u64) -> SingleRun {
    SingleRun::new(plan, SampleId(sample), plan.grid.clone(), Isa::best()).expect("a physical scene")
}

/// The value of the column `name` of the row of `run`.
pub(crate) fn value(run: &SingleRun, name: &str) -> f64 {
    let columns = run.request.columns();
    let place = columns.iter().position(|column| column.quantity.name() == name);
    run.row[place.unwrap_or_else(|| panic!("no column {name}"))]
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// `text` without the tables that only a loop or a file of results needs.
fn without(text: &str, headers: &[&str]) -> String {
    let mut kept = String::new();
    let mut keeps = true;
    for line in text.lines() {
        if line.starts_with('[') {
            let header = line.split('#').next().unwrap_or("").trim();
            keeps = !headers.contains(&header);
        }
        if keeps {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    kept
}

/// A spacecraft at rest with one wheel about each axis, of the inertia diag(30, 36, 24) kg m^2 with wheels that add
/// nothing to K.
pub(crate) fn small_craft(control: &str, initial: &str) -> String {
    const HEAD: &str = "[campaign]\nname = \"loop\"\nsamples = 2\nseed = 1\nduration_s = 100\n\
        [integrator]\nmethod = \"auto\"\ntolerance = 1e-14\n[observe]\npoints = 401\n\
        groups = [\"final_state\", \"motion\", \"numerics\", \"energy_conservation\", \"momentum_conservation\"]\n";
    let wheels = [("w1", [1, 0, 0]), ("w2", [0, 1, 0]), ("w3", [0, 0, 1])].map(|(name, axis)| small_wheel(name, axis));
    [HEAD, SMALL_BODY, &wheels.concat(), "[initial]\n", initial, "\n", control].concat()
}

/// Law: one and two threads give the same rows, and a sample simulated alone is its row, bit for bit, with sensors,
/// filters and pulses.
#[test]
fn rows_are_functions_of_plan_and_sample() {
    let scratch = ScratchFolder::new("loop-rows");
    let short = NET_LAUNCH.replace("duration_s = 2400.0", "duration_s = 200.0");
    for (name, text) in [("slew", SLEW_CLOSED), ("net", &short[..])] {
        let text = text.replace("samples = 1024", "samples = 24");
        let quiet = Quiet::default();
        let session = Session::new(&quiet).unwrap();
        let results = |threads: usize| {
            let folder = scratch.path(&format!("{name}{threads}"));
            Campaign::from_text("loop.toml", &text, session.on_threads(NonZeroUsize::new(threads)))
                .store(&folder)
                .results()
                .unwrap()
        };
        let (one, two) = (results(1), results(2));
        let columns = one.plan().request().columns();
        for column in &columns {
            let name = column.quantity.name();
            let (a, b) = (one.column(name).unwrap(), two.column(name).unwrap());
            assert!(a.iter().zip(&b).all(|(a, b)| same(*a, *b)), "{name}");
        }
        for sample in [0, 1, 9, 23] {
            let alone = run(one.plan(), sample);
            assert_eq!(alone.outcome.status, Status::Done, "{}", alone.reason);
            for (column, value) in columns.iter().zip(&alone.row) {
                let name = column.quantity.name();
                assert!(same(one.column(name).unwrap()[sample as usize], *value), "{name} of sample {sample}");
            }
        }
        // runs have errors of their own
        let errors = one.column("attitude_estimate_error_final_rad").unwrap();
        assert!(errors[1] != errors[2] && errors[0] < errors[1], "{errors:?}");
    }
}

/// The arcs of a run as a schedule of a campaign file.
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

/// Law: the arcs that a loop has flown, as a schedule of a campaign without a loop, give the same states, bit for bit;
/// in double-double they give them to 1e-12; balances with the work of the actuators close to 1e-12.
#[test]
fn the_arcs_flown_are_the_run() {
    for (text, wheels, thrusters) in
        [(SLEW_CLOSED, &["w1", "w2", "w3", "w4"][..], &[][..]), (DETUMBLE, &["w1", "w2"][..], &["p1", "p2", "p3"][..])]
    {
        let plan_of_loop = plan(text);
        for sample in [0, 3] {
            let flown = run(&plan_of_loop, sample);
            assert!(flown.arcs.len() > 500, "{} arcs", flown.arcs.len());
            let audit = flown.audit(&plan_of_loop, Isa::best()).expect("an audit");
            assert!(audit.state() < 1e-12, "sample {sample}: {:e}", audit.state());
            for name in ["energy_error_max", "angular_momentum_error_max"] {
                assert!(value(&flown, name).abs() < 1e-12, "{name} of sample {sample}: {:e}", value(&flown, name));
            }
            if sample > 0 {
                continue;
            }
            // the nominal scene is what the file says
            let mut open = without(text, &["[control]", "[[sensors]]", "[[guidance]]", "[[disperse]]", "[[require]]"]);
            for key in [
                "torque_limit_n_m",
                "speed_limit_rad_s",
                "viscous_friction",
                "coulomb_friction",
                "max_thrust_n",
                "min_on_time_s",
            ] {
                open = open.lines().filter(|line| !line.starts_with(key)).collect::<Vec<_>>().join("\n") + "\n";
            }
            let replayed = run(&plan(&(open + &schedule(&flown.arcs, wheels, thrusters))), 0);
            for field in [StateField::Rate, StateField::Attitude, StateField::WheelRates, StateField::ComVelocity] {
                for component in 0..2 {
                    let [a, b] = [&flown, &replayed].map(|run| run.table.column(field, component));
                    assert!(a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()), "{field:?} {component}");
                }
            }
        }
    }
}

/// A loop that holds F_e with the wheels by quaternion feedback.
pub(crate) fn hold(bandwidth: f64, damping: f64, period: f64, more: &str) -> String {
    format!(
        "[control]\nperiod_s = {period:?}\nwheels = [\"w1\", \"w2\", \"w3\"]\n{more}[[guidance]]\nphase = \
        \"hold\"\nlaw = \"quaternion_feedback\"\n\
         bandwidth_rad_s = {bandwidth:?}\ndamping = {damping:?}\ntarget = \"attitude\"\nattitude = [1, 0, 0, 0]\n"
    )
}

/// The angle about s2 of a small rotation at each point.
pub(crate) fn angles(run: &SingleRun) -> Vec<f64> {
    let [w, y] = [0, 2].map(|component| run.table.column(StateField::Attitude, component));
    let points = run.grid.points();
    w[..points].iter().zip(&y[..points]).map(|(w, y)| 2.0 * y.atan2(*w)).collect()
}

/// Law: a small angle about one axis follows the exact discrete solution of theta'' = -2 z w theta' - w^2 theta under a
/// torque that is held, with the wheels' J* as inertia, to 1e-9 of the initial angle; and with a delay of one period
/// that of the delayed loop.
#[test]
fn a_small_angle_loop_is_its_discrete_solution() {
    let (w, z, period, start) = (0.4, 0.7, 0.25, 1e-5_f64);
    let initial = format!("attitude = [{:?}, 0, {:?}, 0]", (0.5 * start).cos(), (0.5 * start).sin());
    for delay in [false, true] {
        let more = if delay { "delay_s = 0.25\n" } else { "" };
        let found = angles(&run(&plan(&small_craft(&hold(w, z, period, more), &initial)), 0));
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

/// Law: a held torque u/J = -k sin(theta/2) - c theta' loses stability within 1% of c T = 2 and of k T = 4 c.
#[test]
fn stability_ends_where_theory_says() {
    let start = 1e-5_f64;
    let initial = format!("attitude = [{:?}, 0, {:?}, 0]", (0.5 * start).cos(), (0.5 * start).sin());
    let period = 0.25;
    let grows = |k: f64, c: f64, duration: f64| {
        let w = (0.5 * k).sqrt();
        let text = small_craft(&hold(w, 0.5 * c / w, period, ""), &initial)
            .replace("duration_s = 100", &format!("duration_s = {duration:?}"))
            .replace("points = 401", &format!("points = {}", (duration / period) as usize + 1));
        let flown = run(&plan(&text), 0);
        if flown.outcome.status == Status::Diverged {
            return true;
        }
        let found = angles(&flown);
        let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, angle| most.max(angle.abs()));
        let eighth = found.len() / 8;
        largest(&found[7 * eighth..]) > largest(&found[3 * eighth..4 * eighth])
    };
    for (factor, unstable) in [(0.99, false), (1.01, true)] {
        let c = factor * 2.0 / period;
        assert_eq!(grows(1e-3 * c / period, c, 400.0), unstable, "c T = {}", factor * 2.0);
        let c = 0.1 / period;
        assert_eq!(grows(factor * 4.0 * c / period, c, 1500.0), unstable, "k T = {} c", factor * 4.0);
    }
}

/// Law: an eigenaxis slew from rest by wheels follows theta'' = -c theta' - k sin(theta/2), with an error of first
/// order in the period.
#[test]
fn an_eigenaxis_slew_is_its_equation() {
    let (w, z) = (0.1_f64, 0.8_f64);
    let (k, c) = (2.0 * w * w, 2.0 * z * w);
    let start = 2.0_f64;
    let axis = [0.48, -0.6, 0.64];
    let half = (0.5 * start).sin();
    let initial = format!(
        "attitude = [{:?}, {:?}, {:?}, {:?}]",
        (0.5 * start).cos(),
        half * axis[0],
        half * axis[1],
        half * axis[2]
    );
    let error = |period: f64| {
        let control = hold(w, z, period, "").replace("quaternion_feedback", "eigenaxis");
        let run = run(&plan(&small_craft(&control, &initial)), 0);
        let q = [0, 1, 2, 3].map(|component| run.table.column(StateField::Attitude, component));
        // signed, since the slew overshoots
        let along = |point: usize| (0..3).map(|i| q[i + 1][point] * axis[i]).sum::<f64>();
        let (mut theta, mut rate, steps) = (start, 0.0_f64, 1000);
        let h = 0.25 / f64::from(steps);
        let mut worst = 0.0_f64;
        for (point, w) in q[0][..run.grid.points()].iter().enumerate() {
            worst = worst.max((2.0 * along(point).atan2(*w) - theta).abs());
            for _ in 0..steps {
                let slope = |theta: f64, rate: f64| -c * rate - k * (0.5 * theta).sin();
                let middle = (theta + 0.5 * h * rate, rate + 0.5 * h * slope(theta, rate));
                theta += h * middle.1;
                rate += h * slope(middle.0, middle.1);
            }
        }
        worst
    };
    let (coarse, fine) = (error(0.25), error(0.125));
    let order = (coarse / fine).log2();
    assert!((0.9..1.1).contains(&order) && coarse < 0.05, "order {order}, error {coarse:e}");
}

/// Law: missions end with the reason that is theirs, at the tick at which it occurs.
#[test]
fn missions_end_with_a_reason() {
    let codes = ["none", "timeout", "wheel_saturated", "lost_target", "keep_out", "no_axis", "diverged"];
    let case = |changes: &[(&str, &str)], failure: &str, end: std::ops::Range<f64>| {
        let mut text = NET_LAUNCH.to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        let run = run(&plan(&text), 0);
        assert_eq!(run.outcome.status, Status::Done, "{failure}: {}", run.reason);
        let expected = codes.iter().position(|code| *code == failure).expect(failure) as f64;
        assert_eq!(value(&run, "failure"), expected, "{failure}");
        assert_eq!(value(&run, "launched"), f64::from(u8::from(failure == "none")));
        let time = value(&run, "end_time_s");
        assert!(end.contains(&time), "{failure} at {time} s");
        assert_eq!((time / 0.5).fract(), 0.0, "ends are ticks");
        // nothing after it is observed
        assert!(value(&run, "time_reached_s") <= time && run.grid.times()[run.outcome.points - 1] <= time);
        assert_eq!(value(&run, "pointing_error_launch_rad").is_nan(), failure != "none");
    };
    case(&[], "none", 300.0..2400.0);
    case(
        &[
            (
                "timeout_s = 600.0\n\n[[guidance]]                # s3 along",
                "timeout_s = 20.0\n\n[[guidance]]                # s3 along",
            ),
            (
                "body_rate_rad_s < 0.002\"\nhold_s = 5.0\ntimeout_s = 20.0",
                "body_rate_rad_s < 1e-9\"\nhold_s = 5.0\ntimeout_s = 20.0",
            ),
        ],
        "timeout",
        20.0..20.1,
    );
    case(&[("keep_out_m = 5.0", "keep_out_m = 30.0")], "keep_out", 0.0..600.0);
    case(
        &[
            ("debris_velocity_m_s = [0.04, 0.03, 0.0]", "debris_velocity_m_s = [0, 0, 0]"),
            ("approach_axis = [1, 0, 0]\n", ""),
        ],
        "no_axis",
        0.0..60.0,
    );
    case(
        &[
            ("period_s = 2.0\nlatency_s = 1.0", "period_s = 2000.0\nlatency_s = 1.0"),
            ("max_range_m = 100.0", "max_range_m = 1.0"),
        ],
        "lost_target",
        60.0..62.0,
    );
}

/// Law: hostile loops end as rows with a reason, not as a hang or a panic.
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
            for (from, to) in [
                ("latency_s = 0.5\n", ""),
                ("latency_s = 1.0\n", ""),
                ("period_s = 2.0\n", ""),
                ("period_s = 1.0\n", ""),
            ] {
                text = text.replace(from, to);
            }
        }
        text = text.replace("tolerance = 1e-12", "tolerance = 1e-12\nmax_steps = 100000");
        let plan = plan(&text);
        for sample in [0, 1] {
            let run = SingleRun::new(&plan, SampleId(sample), Grid::uniform(100.0, 11), Isa::best()).expect("physical");
            assert!(run.outcome.status == Status::Done || !run.reason.is_empty(), "{to}: {:?}", run.outcome);
        }
    }
}

/// Law: without a loop, what acts in a loop alone is refused.
#[test]
fn what_acts_in_a_loop_alone_is_refused() {
    // without a loop, what acts in a loop alone
    let open = without(NET_LAUNCH, &["[control]", "[[guidance]]", "[[disperse]]", "[[require]]"]);
    let error = Plan::from_text("loop.toml", &open, Overrides::default()).expect_err("no loop").to_string();
    for key in ["sensors", "wheels.w1.torque_limit_n_m", "thrusters.p3.max_thrust_n"] {
        assert!(error.lines().any(|line| line.contains(key) && line.contains("without [control]")), "{key}: {error}");
    }
}

/// Law: a thruster's drawn thrust acts, and not the believed one; what flight software commands stays.
#[test]
fn drawn_actuators_act() {
    let weak = DETUMBLE.to_owned()
        + "\n[[disperse]]\nparameter = \"thrusters.p3.max_thrust_n\"\ndistribution = \"offset\"\noffset = -5.0\n";
    let level = |text: &str| {
        let arcs = run(&plan(text), 1).arcs;
        arcs.iter().map(|arc| arc.applied.thrust[2]).fold(0.0, f64::max)
    };
    let scale = |text: &str| run(&plan(text), 1).scene.actuators.thrusters[2].thrust_scale;
    assert!((level(DETUMBLE) / (10.0 * scale(DETUMBLE)) - 1.0).abs() < 1e-12);
    assert!((level(&weak) / (5.0 * scale(&weak)) - 1.0).abs() < 1e-12);
}

/// Law: debris at rest has no axis, but can be pointed at.
#[test]
fn debris_at_rest_can_be_pointed_at() {
    let text = include_str!("../../../campaigns/point_at_debris.toml")
        .replace("debris_velocity_m_s = [0.2, 0.0, 0.0]", "debris_velocity_m_s = [0, 0, 0]");
    let run = run(&plan(&text), 0);
    assert_eq!(value(&run, "failure"), 0.0);
    assert!(value(&run, "pointing_error_final_rad") < 0.02, "{}", value(&run, "pointing_error_final_rad"));
}
