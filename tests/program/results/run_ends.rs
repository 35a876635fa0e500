//! A campaign whose runs end at events, from outside.

use crate::prelude::*;

const ENDS: &str = r#"[campaign]
name = "ends"
samples = 600
seed = 3
duration_s = 60.0
[observe]
points = 121
groups = ["attitude", "motion", "final_state", "effort"]
[body]
mass_kg = 10.0
center_of_mass_m = [0, 0, 0]
principal_moments_kg_m2 = [30, 26, 20]
[initial]
angular_velocity_rad_s = [0.3, 0.0, 0.6]
[[event]]
name = "tipped"
quantity = "spin_axis_angle_rad"
value = 0.7
ends_run = true
[[extreme]]
name = "angular_rate_late_max_rad_s"
quantity = "angular_rate_rad_s"
delay_s = 2.0
[[disperse]]
parameter = "initial.angular_velocity_rad_s"
distribution = "normal"
std = 0.1
[[require]]
observable = "ended_by"
fraction = 0.5
at_most = 0
[[require]]
observable = "time_reached_s"
fraction = 0.01
at_least = 30
[[require]]
observable = "angular_rate_late_max_rad_s"
fraction = 0.5
at_most = "100 deg/s"
"#;

fn campaign(name: &str, arguments: &str) -> ScratchFolder {
    let scratch = ScratchFolder::new(&format!("run-ends-{name}"));
    scratch.file("c.toml", ENDS);
    scratch.command(&format!("campaign c.toml --out r {arguments}")).output().unwrap();
    scratch
}

#[test]
fn everything_ends_where_the_row_does() {
    let found = Found::read(campaign("everything", ""), String::new());
    let names =
        ["ended_by", "tipped_time_s", "time_reached_s", "spin_axis_angle_final_rad", "angular_rate_late_max_rad_s"];
    let [ended_by, tipped, reached, angle, rate] = names.map(|name| found.all(&[name]).remove(0));
    let ended: Vec<usize> = (0..600).filter(|row| ended_by[*row] == 1.0).collect();
    assert!(ended.len() > 300 && ended.len() < 600, "{}", ended.len());
    for row in 0..600 {
        let end = if ended_by[row] == 1.0 { tipped[row] } else { 60.0 };
        assert_eq!(reached[row], end, "{row}");
        assert!(tipped[row].is_nan() || (angle[row] - 0.7).abs() < 1e-9, "{row}: {}", angle[row]);
        assert_eq!(rate[row].is_nan(), end < 2.0, "{row}");
    }
    for sample in [0, ended[0], ended[200], (0..600).find(|row| ended_by[*row] == 0.0).unwrap()] {
        found.scratch.prints(&format!("simulate c.toml --sample {sample} --out s.parquet"), 0);
        let times = floats(&found.scratch.table("s.parquet"), "time_s");
        let before = (0..121).filter(|point| f64::from(*point) * 0.5 < reached[sample]).count();
        assert_eq!((times.last(), times.len()), (Some(&reached[sample]), before + 1), "sample {sample}");
    }
    for run in found.shown_runs() {
        let sample = run["sample"].as_u64().unwrap() as usize;
        let last = *found.array(&run["times"]).last().unwrap();
        assert!((last - reached[sample]).abs() < 1e-5 * reached[sample], "sample {sample}: {last}");
        let marks: Vec<&str> =
            run["marks"].as_array().unwrap().iter().filter_map(|mark| mark["name"].as_str()).collect();
        assert_eq!(marks, if ended_by[sample] == 1.0 { vec!["ended by tipped"] } else { vec![] });
    }
    let summary = found.scratch.summary("r");
    let verdicts: Vec<&str> =
        summary["requirements"]["list"].as_array().unwrap().iter().filter_map(|one| one["verdict"].as_str()).collect();
    let share = |is_met: &dyn Fn(usize) -> bool| (1..600).filter(|row| is_met(*row)).count() as f64 / 599.0;
    assert!(share(&|row| ended_by[row] < 1.0) < 0.4 && share(&|row| reached[row] >= 30.0) > 0.05);
    assert_eq!(verdicts, ["FAIL", "PASS", "PASS"], "{summary}");
    let strip = found.mark("spin_axis_angle_rad", "runs in flight");
    let [times, counts] = ["x", "counts"].map(|key| found.array(&strip[key]));
    assert!(times.len() > 30);
    for (time, count) in times.into_iter().zip(counts) {
        let left = (1..600).filter(|row| reached[*row] >= time).count() as f64;
        assert_eq!(count, left, "{time} s");
    }
}

#[test]
fn audits_know_where_a_run_has_ended() {
    let audit = &campaign("audits", "--samples 200 --audit 1 --no-report").summary("r")["audit"];
    assert_eq!((audit["audited"].as_u64(), audit["failed"].as_u64()), (Some(199), Some(0)));
    assert!(audit["estimate"]["coverage"].as_f64().unwrap() >= 0.95, "{audit}");
    assert!(audit["state_error"]["max"].as_f64().unwrap() < 5e-14, "{audit}");
}
