//! Loops whose law or allocation decides the outcome.

use crate::prelude::*;

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

#[test]
fn canted_thrusters_stop_a_body() {
    for (count, more) in [(4, ""), (5, ""), (4, "hold_force = true\n"), (3, "")] {
        let text = stop(count, more);
        let found = single(&plan(&text), 0);
        let last = found.grid.points() - 1;
        let rate =
            [0, 1, 2].map(|i| found.table.column(StateField::Rate, i)[last].abs()).into_iter().fold(0.0, f64::max);
        let pushed = found.table.column(StateField::ComVelocity, 2)[last];
        assert!(pushed > 0.01, "a net force came with it: {pushed}");
        let scratch = ScratchFolder::new("canted");
        scratch.file("c.toml", &text);
        let said = scratch.prints_wide("check c.toml", 0);
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
