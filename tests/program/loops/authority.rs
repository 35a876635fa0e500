//! Loops of campaign files whose law or allocation decides the outcome: torque with a net force, slews under a torque
//! limit, integrals against friction.

use crate::loops::closed_loops::{angles, hold, plan, run, small_craft, value};
use crate::support::campaigns::SMALL_BODY;
use crate::support::scratch_folder::ScratchFolder;
use spindrift::run::StateField;

/// A tumbling body without wheels, with the first `count` of five thrusters: four that push along s3, canted to either
/// side in turn, and a straight one.
fn stop(count: usize, more: &str) -> String {
    let names: Vec<String> = (0..count).map(|index| format!("\"t{index}\"")).collect();
    let mut text = format!(
        "[campaign]\nname = \"canted\"\nsamples = 2\nseed = 1\nduration_s = 200\n[integrator]\nmethod = \
        \"auto\"\ntolerance = 1e-12\n\
         [observe]\npoints = 101\ngroups = [\"final_state\", \"numerics\"]\n\
         {SMALL_BODY}\
         [initial]\nangular_velocity_rad_s = [0.02, -0.03, 0.025]\n\
         [control]\nperiod_s = 0.5\nthrusters = [{}]\n{more}\
         [[guidance]]\nphase = \"stop\"\nlaw = \"rate_damping\"\ngain_n_m_s = 3.0\n",
        names.join(", ")
    );
    let canted = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
        .map(|[x, y]| (x, y, [1.0, -1.0][usize::from(x == 0.0)] * 0.3));
    for (index, (x, y, side)) in canted.into_iter().chain([(0.1, 0.0, 0.0)]).take(count).enumerate() {
        text += &format!(
            "\n[[thrusters]]\nname = \"t{index}\"\nposition_m = [{x}, {y}, -0.5]\ndirection = [{}, {}, \
            0.95]\nmax_thrust_n = 0.5\n",
            -side * y,
            side * x
        );
    }
    text
}

/// Law: thrusters whose torques span all directions stop a body, although only with a net force: four canted ones, and
/// with a fifth; also where the force is held, since torque comes first. Three cannot. `check` says about which axes
/// they have torque in both directions, and about which there is none.
#[test]
fn canted_thrusters_stop_a_body() {
    for (count, more) in [(4, ""), (5, ""), (4, "hold_force = true\n"), (3, "")] {
        let text = stop(count, more);
        let found = run(&plan(&text), 0);
        let last = found.grid.points() - 1;
        let rate =
            [0, 1, 2].map(|i| found.table.column(StateField::Rate, i)[last].abs()).into_iter().fold(0.0, f64::max);
        let pushed = found.table.column(StateField::ComVelocity, 2)[last];
        assert!(pushed > 0.01, "a net force came with it: {pushed}");
        let scratch = ScratchFolder::new("canted");
        scratch.file("c.toml", &text);
        let output = scratch.command("check c.toml").env("COLUMNS", "1000").output().expect("the program starts");
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let has =
            |axis: &str| said.contains(&format!("thrusters: torque in both directions about {axis}; 1 N m takes "));
        let is_free = said.contains("neither wheels nor thrusters of the loop have torque in both directions about");
        if count == 3 {
            assert!(rate > 1e-3 && is_free && !["s1", "s2", "s3"].into_iter().all(has), "{rate} {said}");
        } else {
            assert!(rate < 1e-6 && !is_free && said.contains("and a net force of"), "{rate} {said}");
            assert!(["s1", "s2", "s3"].into_iter().all(has), "{said}");
        }
    }
}

/// Law: an eigenaxis slew of 90 degrees under a torque limit, flown by wheels with the delay of a loop, takes the
/// textbook's time 2 sqrt(theta/a) within 3% at every bandwidth, with an overshoot of less than 0.05 degrees; with a
/// limit of the rate theta/v + v/a.
#[test]
fn slews_brake_in_time() {
    let start = std::f64::consts::FRAC_PI_2;
    let (torque, inertia) = (0.225, 35.99);
    let most = torque / inertia;
    let initial = format!("attitude = [{:?}, 0, {:?}, 0]", (0.5 * start).cos(), (0.5 * start).sin());
    for bandwidth in [0.05, 0.3, 2.0] {
        for (limit, book) in [(0.0, 2.0 * (start / most).sqrt()), (0.04, start / 0.04 + 0.04 / most)] {
            let law = format!("max_torque_n_m = {torque:?}\nmax_rate_rad_s = {limit:?}\n");
            let text =
                hold(bandwidth, 0.9, 0.125, "delay_s = 0.05\n").replace("quaternion_feedback", "eigenaxis") + &law;
            let text = small_craft(&text, &initial).replace("points = 401", "points = 801");
            let found = angles(&run(&plan(&text), 0));
            let last = found.iter().rposition(|angle| angle.abs() > 0.1_f64.to_radians()).expect("it begins beyond");
            let time = 0.125 * (last + 1) as f64;
            assert!((time / book - 1.0).abs() < 0.03, "{bandwidth} {limit}: {time} for {book}");
            let overshoot = found.iter().fold(0.0_f64, |most, angle| most.max(-angle));
            assert!(overshoot < 0.05_f64.to_radians(), "{bandwidth} {limit}: {}", overshoot.to_degrees());
        }
    }
}

/// Law: friction of a wheel leaves an offset of 2 sin(theta/2) = C/(w^2 K) without an integral, and none with one; K =
/// 36 kg m^2 less 0.01 of the wheel.
#[test]
fn an_integral_removes_what_friction_leaves() {
    let law = |more: &str| {
        let text = hold(0.1, 0.9, 0.25, "") + more;
        // the wheel turns, so that its friction is constant
        let text = small_craft(&text, "attitude = [1, 0, 0, 0]")
            .replace("duration_s = 100", "duration_s = 1000")
            .replace("axis = [0, 1, 0]", "axis = [0, 1, 0]\nrate_rad_s = 500\ncoulomb_friction_n_m = 0.002");
        let run = run(&plan(&text), 0);
        (*angles(&run).last().expect("points"), value(&run, "pointing_error_final_rad"))
    };
    let (without, _) = law("");
    let expected = 0.002 / (0.1 * 0.1 * 35.99);
    assert!((2.0 * (0.5 * without.abs()).sin() / expected - 1.0).abs() < 1e-9, "{without}");
    let (with, error) = law("integral_1_s = 0.02\nintegral_limit = 0.1\n");
    assert!(with.abs() < 1e-6 * without.abs() && error < 1e-8, "{with} {error}");
}
