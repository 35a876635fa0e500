//! Campaigns that stop when they are precise enough.

use crate::prelude::*;

use spindrift::statistics::binomial::at_most;

use crate::commands::screen_numbers::{junit_counts, numbers};

fn stopping(half_width: &str) -> String {
    let stop = format!(
        "\n[stop]\nobservable = \"exchange_w1_peak_to_peak_j\"\nquantile = 0.5\nhalf_width = {half_width}\nmax_samples \
        = 2400\n"
    );
    sized(300) + &stop
}

fn half_width(summary: &Value) -> f64 {
    let end = |index: usize| summary["stop"]["interval"][index].as_f64().unwrap();
    0.5 * (end(1) - end(0))
}

fn median(scratch: &ScratchFolder, result: &str) -> f64 {
    let rows = scratch.rows(result);
    let values = column(&rows, "exchange_w1_peak_to_peak_j").into_iter().zip(ended(&rows));
    let counted = values.filter(|(_, (sample, status))| *sample > 0 && status == "ok");
    let mut values: Vec<f64> = counted.map(|(value, _)| value).collect();
    assert!(values.len() % 2 == 1);
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Law: a campaign stops at the first look whose interval is narrow enough, with the confidence of one of four looks.
#[test]
fn a_campaign_stops_when_it_is_precise_enough() {
    let scratch = folder("stop");
    scratch.file("never.toml", &stopping("1e-30"));
    let mut command = scratch.command("campaign never.toml --out never --junit never.xml");
    let said = scratch.outputs(command.env("COLUMNS", "250"), 5);
    assert_says(&said, ["not precise enough"]);
    let junit = |name: &str| fs::read_to_string(scratch.path(name)).unwrap();
    let missed = junit("never.xml");
    assert!(junit_counts(&missed) == [2, 0, 1] && missed.contains("<error type=\"stop\""), "{missed}");
    let never = scratch.summary("never");
    assert_eq!((&never["samples"], &never["stop"]["look"]), (&Value::from(2400), &Value::from(4)));
    assert_eq!(never["stop"]["precise_enough"], false);
    for said in [&said, &missed] {
        let at = |key: &str| never["stop"][key].as_f64().unwrap();
        let found = numbers(said, "look # of at most #, # samples: p50 of ");
        assert_eq!(found, ["look", "looks", "samples"].map(at));
        let [low, high] = [0, 1].map(|end| never["stop"]["interval"][end].as_f64().unwrap());
        let known = [at("estimate"), low, high, 100.0 * at("confidence"), 1e-30];
        says(said, " = # [#, #] J at #% confidence, wanted half width # J", &known);
    }
    assert!((never["stop"]["confidence"].as_f64().unwrap() - (1.0 - 0.05 / 4.0)).abs() < 1e-12);

    let wanted = 2.05 * half_width(&never);
    scratch.file("stop.toml", &stopping(&format!("{wanted:?}")));
    scratch.prints("campaign stop.toml --out stopped --junit stopped.xml", 0);
    let reached = junit("stopped.xml");
    assert!(junit_counts(&reached) == [2, 0, 0] && reached.contains("[stop] reaches its goal\"/>"), "{reached}");
    let stopped = scratch.summary("stopped");
    let samples = stopped["samples"].as_u64().unwrap();
    assert!([600, 1200].contains(&samples), "{samples} samples");
    assert!(half_width(&stopped) <= wanted && stopped["stop"]["precise_enough"] == true);

    for (result, found) in [("never", &never), ("stopped", &stopped)] {
        assert_eq!(found["stop"]["estimate"].as_f64(), Some(median(&scratch, result)), "{result}");
    }

    scratch.small(&format!("--samples {samples} --out fixed"), 0);
    assert_eq!(scratch.parts("stopped"), scratch.parts("fixed"));
    let said = scratch.prints("campaign stop.toml --out stopped", 0);
    assert!(said.contains("already complete") && said.contains(&format!("({samples} samples")), "{said}");
    assert!(scratch.prints("finish stopped", 0).contains("already finished"));
    let page = scratch.text("stopped/report.html");
    let dispersed = if samples > 1000 { "1199" } else { "599" };
    for said in [format!("{samples} samples: p50"), format!("{dispersed} dispersed runs")] {
        assert!(page.contains(&said), "the page says how many samples the look had: {said}");
    }
    let checked = scratch.prints("verify stopped --fraction 0", 0);
    assert!(checked.contains(&format!(" {samples} rows: checksums compared")), "the manifest: {checked}");
    let manifest = scratch.text("stopped/manifest.json");
    fs::remove_file(scratch.path("stopped/manifest.json")).unwrap();
    assert_says(scratch.prints("finish stopped", 4), ["spindrift campaign"]);
    scratch.prints("campaign stop.toml --out stopped", 0);
    assert_eq!(scratch.text("stopped/manifest.json"), manifest);
    assert!(scratch.prints("campaign never.toml --out never", 5).contains("already complete"));
    scratch.prints("verify stopped --fraction 1", 0);
    let before = fs::read(scratch.path("stopped/report.html")).unwrap();
    scratch.prints("report stopped", 0);
    assert!(before == fs::read(scratch.path("stopped/report.html")).unwrap(), "the page is made again, the same");

    scratch.prints("campaign never.toml --out stopped", 5);
    assert_eq!(scratch.parts("stopped"), scratch.parts("never"));
    scratch.shows("campaign stop.toml --shard 1/2 --out shard", 2, "[stop]");
}

/// Law: with `when = "decided"` a campaign ends at the first look at which the exact test decides.
#[test]
fn a_campaign_stops_when_its_requirements_are_decided() {
    const NAME: &str = "exchange_w1_peak_to_peak_j";
    let scratch = folder("decided");
    scratch.small("--samples 2400 --out all --no-report", 0);
    let values: Vec<f64> = column(&scratch.rows("all"), NAME).into_iter().skip(1).collect();
    let mut ascending = values.clone();
    ascending.sort_by(f64::total_cmp);
    let looks = [300_u64, 600, 1200, 2400];
    let campaign = |limit: f64| {
        let tables = format!(
            "\n[[require]]\nobservable = \"{NAME}\"\nquantile = 0.5\nat_most = {limit:?}\n[stop]\nwhen = \
            \"decided\"\nmax_samples = 2400\n"
        );
        sized(300) + &tables
    };
    // limits that 54% to 75% of the runs keep, and 25% to 46%: each side is decided at other looks
    let mut ends = Vec::new();
    for share in [0.46, 0.54, 0.75, 0.40] {
        let limit = ascending[(share * 2399.0) as usize];
        let decides = |samples: u64| {
            let trials = samples - 1;
            let within = values[..trials as usize].iter().filter(|value| **value <= limit).count() as u64;
            let [missed, met] = [within, trials - within].map(|count| at_most(count, trials, 0.5) <= 0.05 / 4.0);
            met.then_some("PASS").or(missed.then_some("FAIL"))
        };
        let expected = looks.iter().find_map(|samples| Some((*samples, decides(*samples)?)));
        let (samples, word) = expected.unwrap_or((2400, "UNDECIDED"));
        scratch.file("decided.toml", &campaign(limit));
        let code = ["PASS", "", "", "FAIL", "", "UNDECIDED"].iter().position(|known| *known == word).unwrap() as i32;
        scratch.prints("campaign decided.toml --out decided --no-report --overwrite", code);
        let found = scratch.summary("decided");
        assert_eq!((&found["samples"], &found["stop"]["samples"]), (&Value::from(samples), &Value::from(samples)));
        assert_eq!(found["requirements"]["list"][0]["verdict"], word, "{found}");
        assert_eq!(found["stop"]["reached"], word != "UNDECIDED");
        assert!(scratch.prints("campaign decided.toml --out decided --no-report", code).contains("already complete"));
        ends.push(samples);
    }
    ends.sort_unstable();
    ends.dedup();
    assert!(ends.len() >= 2, "the limits are decided at several looks: {ends:?}");
    scratch.file("decided.toml", &campaign(0.5 * (ascending[1198] + ascending[1199])));
    scratch.prints("campaign decided.toml --out undecided --no-report", 5);
    let found = scratch.summary("undecided");
    assert_eq!((&found["samples"], &found["stop"]["reached"]), (&Value::from(2400), &Value::from(false)));
}
