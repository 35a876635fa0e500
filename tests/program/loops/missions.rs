//! The ends of missions on screen, summary and page, against the rows.

use crate::prelude::*;
use spindrift::statistics::binomial::interval;

#[test]
fn ends_are_those_of_the_rows() {
    let scratch = ScratchFolder::new("missions");
    scratch.file("c.toml", &DETUMBLE.replace("timeout_s = 500.0", "timeout_s = 40.0"));
    let mut command = scratch.command("campaign c.toml --samples 40 --out r --verbose --no-report");
    let output = command.env("COLUMNS", "200").output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let rows = scratch.rows("r");
    let (failures, ended) = (column(&rows, "failure"), ended(&rows));
    let ok: Vec<usize> = (1..40).filter(|row| ended[*row].1 == "ok").collect();
    let missions = scratch.summary("r")["missions"].as_array().unwrap().clone();
    assert_eq!(missions.len(), 2);
    let mut all = 0;
    for (end, code, words) in
        [("not_failed", 0.0, "did not fail"), ("timeout", 1.0, "failed: a phase took too long (detumble)")]
    {
        let count = ok.iter().filter(|row| failures[**row] == code).count() as u64;
        let one = missions.iter().find(|one| one["end"] == end).expect(end);
        assert_eq!([&one["count"], &one["runs"]].map(|number| number.as_u64()), [Some(count), Some(ok.len() as u64)]);
        if code == 1.0 {
            assert_eq!(one["phases"], serde_json::json!([{ "phase": "detumble", "count": count }]));
        }
        let [low, high] = interval(count, ok.len() as u64, 0.95);
        let percents = [count as f64 / ok.len() as f64, low, high].map(|share| 100.0 * share);
        let counted = [&[count as f64, ok.len() as f64][..], &percents].concat();
        says(&said, &format!("# of # missions {words}: #% [#, #]"), &counted);
        all += count;
    }
    assert_eq!(all, ok.len() as u64);
}
