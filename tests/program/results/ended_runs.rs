//! Results of runs that events end: extended, verified, repaired and audited.

use crate::prelude::*;

/// A free body that tips over, most of the runs before their minute is over.
const TIPPING: &str = r#"[campaign]
name = "tipping"
samples = 600
seed = 3
duration_s = 60.0
[observe]
points = 61
[body]
mass_kg = 10.0
center_of_mass_m = [0, 0, 0]
principal_moments_kg_m2 = [30, 28, 20]
[initial]
angular_velocity_rad_s = [0.3, 0.0, 0.6]
[[disperse]]
parameter = "initial.angular_velocity_rad_s"
distribution = "normal"
std = 0.2
[[event]]
name = "tipped"
quantity = "spin_axis_angle_rad"
value = 0.7
ends_run = true
"#;

#[test]
fn audits_know_where_a_run_has_ended() {
    let scratch = ScratchFolder::new("ended-audits");
    scratch.file("c.toml", TIPPING);
    scratch.prints("campaign c.toml --samples 200 --audit 1 --out r --no-report", 0);
    let audit = &scratch.summary("r")["audit"];
    assert_eq!((audit["audited"].as_u64(), audit["failed"].as_u64()), (Some(199), Some(0)));
    assert!(audit["estimate"]["coverage"].as_f64().unwrap() >= 0.95, "{audit}");
    assert!(audit["state_error"]["max"].as_f64().unwrap() < 5e-14, "{audit}");
}
