//! Results of runs that events end: extended, verified, repaired and audited. Shards and threads are in `run_ends`.

use crate::support::scratch_folder::{ScratchFolder, column};

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

/// Law: files of rows are the same bytes where the campaign is run at once and where it is extended, and every one of
/// them is made again bit for bit; damage of one is repaired to the same bytes.
#[test]
fn results_of_ended_runs_are_those_of_one_campaign() {
    let scratch = ScratchFolder::new("ended-runs");
    scratch.file("c.toml", TIPPING);
    scratch.prints("campaign c.toml --out whole --no-report", 0);
    let whole = scratch.parts("whole");
    assert!(whole.len() > 1, "{} parts", whole.len());
    let ended = column(&scratch.rows("whole"), "ended_by").iter().filter(|by| **by == 1.0).count();
    assert!(ended > 300 && ended < 600, "{ended} of 600 end early");
    scratch.prints("campaign c.toml --samples 100 --out grown --no-report", 0);
    scratch.prints("campaign c.toml --out grown --no-report", 0);
    assert!(scratch.parts("grown") == whole, "extended");
    scratch.prints("verify grown --fraction 1", 0);
    let damaged = scratch.part_files("grown").swap_remove(0);
    let mut bytes = std::fs::read(&damaged).expect("a part");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    std::fs::write(&damaged, bytes).expect("a part");
    scratch.prints("verify grown", 4);
    scratch.prints("verify grown --repair", 0);
    assert!(scratch.parts("grown") == whole, "repaired");
}

/// Law: the reference solution of an audit is that of the run as it ended: true errors are rounding, and estimates
/// cover them in at least 95% of the runs.
#[test]
fn audits_know_where_a_run_has_ended() {
    let scratch = ScratchFolder::new("ended-audits");
    scratch.file("c.toml", TIPPING);
    scratch.prints("campaign c.toml --samples 200 --audit 1 --out r --no-report", 0);
    let audit = &scratch.summary("r")["audit"];
    assert_eq!((audit["audited"].as_u64(), audit["failed"].as_u64()), (Some(199), Some(0)));
    assert!(audit["estimate"]["coverage"].as_f64().expect("a share") >= 0.95, "{audit}");
    assert!(audit["state_error"]["max"].as_f64().expect("an error") < 5e-14, "{audit}");
}
