//! Campaigns that stop when they are precise enough.

use std::fs;

use serde_json::Value;

use super::small_campaign::{campaign, folder};
use crate::support::scratch_folder::ScratchFolder;

/// The campaign of 300 samples with `[stop]`: the median of the energy transfer of wheel 1 to within `half_width` J, with at most 2,400 samples.
fn stopping(half_width: &str) -> String {
    let stop = format!(
        "\n[stop]\nobservable = \"exchange_w1_peak_to_peak_j\"\nquantile = 0.5\nhalf_width = {half_width}\nmax_samples = 2400\n"
    );
    campaign().replace("samples = 600", "samples = 300") + &stop
}

fn summary(scratch: &ScratchFolder, result: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(scratch.path(&format!("{result}/summary.json"))).unwrap()).unwrap()
}

/// The half width of the interval of the summary's `stop`.
fn half_width(summary: &Value) -> f64 {
    let end = |index: usize| summary["stop"]["interval"][index].as_f64().unwrap();
    0.5 * (end(1) - end(0))
}

/// Law: a campaign stops at the first look whose interval is narrow enough, its rows are those of a campaign of so many samples, and the interval has
/// the confidence of one of four looks.
#[test]
fn a_campaign_stops_when_it_is_precise_enough() {
    let scratch = folder("stop");
    // the interval of all four looks, from a campaign that never stops
    scratch.file("never.toml", &stopping("1e-30"));
    let said = scratch.prints("campaign never.toml --out never", 0);
    assert!(said.contains("not precise enough with stop.max_samples"), "{said}");
    let never = summary(&scratch, "never");
    assert_eq!((&never["samples"], &never["stop"]["look"]), (&Value::from(2400), &Value::from(4)));
    assert_eq!(never["stop"]["precise_enough"], false);
    assert!((never["stop"]["confidence"].as_f64().unwrap() - (1.0 - 0.05 / 4.0)).abs() < 1e-12);

    // twice the last width is reached after about a quarter of the samples, at the second look
    let wanted = 2.05 * half_width(&never);
    scratch.file("stop.toml", &stopping(&format!("{wanted:?}")));
    scratch.prints("campaign stop.toml --out stopped", 0);
    let stopped = summary(&scratch, "stopped");
    let samples = stopped["samples"].as_u64().unwrap();
    assert!([600, 1200].contains(&samples), "{samples} samples");
    assert!(half_width(&stopped) <= wanted && stopped["stop"]["precise_enough"] == true);

    scratch.prints(&format!("campaign small.toml --samples {samples} --out fixed"), 0);
    assert_eq!(scratch.parts("stopped"), scratch.parts("fixed"));
    assert!(scratch.prints("campaign stop.toml --out stopped", 0).contains("already complete"));
    scratch.prints("verify stopped --fraction 1", 0);
    let before = fs::read(scratch.path("stopped/report.html")).unwrap();
    scratch.prints("report stopped", 0);
    assert!(before == fs::read(scratch.path("stopped/report.html")).unwrap(), "the page is made again, the same");

    // the rows of a narrower goal contain those of a wider one
    scratch.prints("campaign never.toml --out stopped", 0);
    assert_eq!(scratch.parts("stopped"), scratch.parts("never"));
    let said = scratch.prints("campaign stop.toml --shard 1/2 --out shard", 2);
    assert!(said.contains("[stop]"), "{said}");
}
