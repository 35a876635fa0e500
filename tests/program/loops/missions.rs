//! How missions ended: on the screen, in the summary and on the page, against the rows.

use crate::commands::screen_numbers::says;
use crate::page::answers::between;
use crate::page::numbers::Found;
use crate::support::scratch_folder::{ScratchFolder, column, ended};
use spindrift::statistics::binomial::interval;

const DETUMBLE: &str = include_str!("../../../campaigns/detumble.toml");

/// Law: the dispersed runs that are ok are counted by how their mission ended, each with its share in percent and the
/// interval of the share, of which the bar of the page is drawn.
#[test]
fn ends_are_those_of_the_rows() {
    let scratch = ScratchFolder::new("missions");
    // some runs are at rest by then, and the nominal one is not
    let text = DETUMBLE.replace("timeout_s = 500.0", "timeout_s = 40.0");
    scratch.file("c.toml", &text);
    let mut command = scratch.command("campaign c.toml --samples 40 --out r --verbose");
    let output = command.env("COLUMNS", "200").output().expect("the program starts");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let rows = scratch.rows("r");
    let (failures, ended) = (column(&rows, "failure"), ended(&rows));
    let ok: Vec<usize> = (1..40).filter(|row| ended[*row].1 == "ok").collect();
    let runs = ok.len() as f64;
    let missions = scratch.summary("r")["missions"].as_array().expect("missions").clone();
    let found = Found::read(scratch, String::new());
    let page = found.visible();
    let list = between(&page, "<ul class=\"missions\">", "</ul>");
    let mut all = 0.0;
    for (end, code, words) in
        [("not_failed", 0.0, "did not fail"), ("timeout", 1.0, "failed: a phase took too long (detumble)")]
    {
        let count = ok.iter().filter(|row| failures[**row] == code).count() as u64;
        let [low, high] = interval(count, ok.len() as u64, 0.95);
        let share = count as f64 / runs;
        let one = missions.iter().find(|one| one["end"] == end).expect(end);
        if end == "timeout" {
            let phases = column(&rows, "phase_final");
            assert!(
                ok.iter().all(|row| failures[*row] != code || phases[*row] == 0.0),
                "the first phase is `detumble`"
            );
            assert_eq!(one["phases"], serde_json::json!([{ "phase": "detumble", "count": count }]));
        }
        assert_eq!([&one["count"], &one["runs"]].map(|number| number.as_u64()), [Some(count), Some(ok.len() as u64)]);
        let percents = [share, low, high].map(|share| 100.0 * share);
        let counted = [&[count as f64, runs][..], &percents].concat();
        says(&said, &format!("# of # missions {words}: #% [#, #]"), &counted);
        let row = list.split("<li").find(|row| row.contains(words)).expect("a row");
        says(row, &format!("# of # missions {words}: #% [#, #]"), &counted);
        let bar: f64 = between(row, "--share: ", "\"").parse().expect("a share");
        assert!((bar - share).abs() < 6e-4, "{bar} for {share}: {row}");
        all += count as f64;
    }
    assert!(all == runs && missions.len() == 2, "{missions:?}");
    // a figure counts the runs that have a value; those that failed never came to rest
    let began = found.rows(&["phase_rest_begin_s"]);
    let known = began.iter().filter(|(_, row)| row[0].is_finite()).count();
    let scatter = found.figure("scatter_phase_rest_begin_s_initial_angular_velocity_y_rad_s");
    let caption = format!("{known} of {} runs have this value.", ok.len());
    assert!(known < began.len() && scatter["caption"] == caption, "{scatter}");
    // what failed is the mission, and not its computation
    let worst = between(&page, "id=\"worst\"", "</section>");
    for row in worst.split("<tr>").skip(3) {
        let sample = between(row, "<th scope=\"row\">", "</th>").parse::<usize>().expect("a sample");
        let is_said = row.contains("<p class=\"ended\">Mission failed: a phase took too long</p>");
        assert_eq!(is_said, failures[sample] == 1.0, "{row}");
    }
    assert!(said.contains("all 40 runs were computed") && page.contains("All 40 runs were computed."), "{said}");
    for (end, class) in [("did not fail", "mission_not_failed"), ("failed: a phase took too long", "mission_timeout")] {
        let row = list.split("<li").find(|row| row.contains(end)).expect("a row");
        assert!(row.contains(&format!("class=\"{class}\"")), "{row}");
    }
    assert!(failures[0] == 1.0 || failures[0] == 0.0);
}
