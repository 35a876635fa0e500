//! How the missions of a control loop ended, in words.

use crate::analysis::missions::{MissionShare, Missions};
use crate::control::failure::Failure;
use crate::findings::number::trimmed;
use crate::report::share_text::with_interval;

/// How a mission ended, in words that follow "mission".
pub fn words(end: &str) -> &str {
    match end {
        "flying" => "still flying at the end of the run",
        "not_failed" => "did not fail",
        "timeout" => "failed: a phase took too long",
        "wheel_saturated" => "failed: a wheel was saturated",
        "lost_target" => "failed: the debris was lost",
        "keep_out" => "failed: too close to the debris",
        "no_axis" => "failed: the debris has no axis",
        "diverged" => "failed: diverged",
        "module_trap" => "failed: the module trapped",
        "module_fuel" => "failed: the module used up its fuel",
        other => other,
    }
}

/// How missions ended, in words that follow "mission", with the phases that took too long.
pub fn ended(one: &MissionShare) -> String {
    let words = words(one.end);
    match &one.phases[..] {
        [] => words.to_owned(),
        [(name, count)] if *count == one.count => format!("{words} ({name})"),
        several => {
            let each: Vec<String> = several.iter().map(|(name, count)| format!("{name} {count}")).collect();
            format!("{words} ({})", each.join(", "))
        }
    }
}

/// How the mission of a run ended, by the columns of its row; `None` where the row has none, or the mission did neither
/// fail nor launch.
pub fn of_row(row: &[(String, f64)]) -> Option<String> {
    let value = |name: &str| row.iter().find(|(column, _)| column == name).map(|(_, value)| *value);
    if value("launched") == Some(1.0) {
        return Some("mission launched".to_owned());
    }
    let failure = value("failure").filter(|code| *code >= 1.0)?;
    Some(format!("mission {}", words(Failure::NAMES.get(failure as usize)?)))
}

/// The same with the time at which it ended: "mission failed at 812 s: a phase took too long".
pub fn of_run(row: &[(String, f64)]) -> Option<String> {
    let end = of_row(row)?;
    let time = row.iter().find(|(column, _)| column == "end_time_s").map(|(_, time)| *time);
    let Some(time) = time.filter(|time| time.is_finite()) else { return Some(end) };
    let (what, why) =
        end.split_once(": ").map_or((end.as_str(), String::new()), |(what, why)| (what, format!(": {why}")));
    Some(format!("{what} at {} s{why}", trimmed(time, 6)))
}

/// The share in per cent, between bounds where runs are missing, and its interval where there is one.
pub fn share(share: &MissionShare) -> String {
    with_interval(share.shares(), share.interval)
}

/// What runs that were not computed mean for the shares; `None` where there are none.
pub fn missing(missions: &Missions) -> Option<String> {
    let MissionShare { missing, runs, .. } = missions.first()?;
    (*missing > 0).then(|| {
        format!("{missing} of {runs} dispersed runs were not computed: each share is between none and all of them")
    })
}

/// What drives failures where no mission does anything else: no input can be told from the others by them. `None` where
/// one mission did not fail.
pub fn all_failed(missions: &Missions) -> Option<String> {
    let is_failed = |one: &MissionShare| words(one.end).starts_with("failed") && one.missing == 0;
    let runs = missions.first()?.runs;
    let all_do = missions.iter().filter(|one| one.count > 0).all(is_failed);
    (runs > 1 && all_do).then(|| format!("all {runs} missions fail, so no input decides which do"))
}

/// How missions ended in one sentence: the share that launched or did not fail, unless `is_stated` (a verdict says it),
/// and how many ended in another way. `is_said`: a warning says how many were not computed.
pub fn brief(missions: &Missions, is_stated: bool, is_said: bool) -> String {
    let Some(MissionShare { missing, .. }) = missions.first() else { return String::new() };
    let is_good = |one: &&MissionShare| ["launched", "not_failed"].contains(&one.end);
    let good = missions.iter().find(is_good).filter(|_| !is_stated || *missing > 0 && !is_said);
    let good = good.map(|one| {
        let word = if one.end == "launched" { "launched" } else { "did not fail" };
        format!("{} of {} {word}", share(one), one.runs)
    });
    let of_others = |one: &MissionShare| {
        let words = ended(one);
        format!("{} {}", one.count, words.strip_suffix(" at the end of the run").unwrap_or(&words))
    };
    let others = missions.iter().filter(|one| !is_good(one)).map(of_others);
    let not_computed = (*missing > 0 && !is_said).then(|| format!("{missing} not computed"));
    if let [MissionShare { end: "not_failed", runs, missing: 0, .. }] = missions[..] {
        return format!("  missions: none of {runs} failed\n");
    }
    let said: Vec<String> = good.into_iter().chain(others).chain(not_computed).collect();
    if said.is_empty() { String::new() } else { format!("  missions: {}\n", said.join("; ")) }
}

/// A line for each way in which missions ended; nothing without a loop.
pub fn text(missions: &Missions) -> String {
    let mut text = String::new();
    for one in missions {
        text += &format!("  {:>8} of {} missions {}: {}\n", one.count, one.runs, ended(one), share(one));
    }
    if let Some(note) = missing(missions) {
        text += &format!("  {note}\n");
    }
    if text.is_empty() { text } else { format!("\n{text}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Name;

    /// Law: each way is named with its count, its share and the ends of its interval in order.
    #[test]
    fn ends_are_counted() {
        let share =
            |end, count, interval| MissionShare { end, phases: Vec::new(), count, runs: 200, missing: 0, interval };
        let found = text(&vec![share("launched", 190, [0.91, 0.975]), share("keep_out", 10, [f64::NAN; 2])]);
        assert!(found.contains("190 of 200 missions launched: 95% [91, 97.5]"), "{found}");
        assert!(found.contains("10 of 200 missions failed: too close to the debris: 5%\n"), "{found}");
        assert_eq!(text(&Missions::new()), "");
        // 82 of 300 launched, 214 were not computed: from 27% to 99%
        let bounds = MissionShare { runs: 300, missing: 214, ..share("launched", 82, [0.223, 0.997]) };
        let found = text(&vec![bounds]);
        assert!(found.contains("82 of 300 missions launched: 27.3% to 98.7% [22.3, 99.7]"), "{found}");
        // which phase took too long
        let phase = |name: &str, count| (Name::of(name), count);
        let late = MissionShare { phases: vec![phase("coast", 7)], ..share("timeout", 7, [f64::NAN; 2]) };
        assert_eq!(ended(&late), "failed: a phase took too long (coast)");
        let late = MissionShare { phases: vec![phase("coast", 4), phase("align", 3)], ..late };
        assert_eq!(brief(&vec![late], true, false), "  missions: 7 failed: a phase took too long (coast 4, align 3)\n");
        assert!(found.contains("214 of 300 dispersed runs were not computed"), "{found}");
        // no input decides which fail where all do, in whatever way
        let failed = vec![share("timeout", 150, [f64::NAN; 2]), share("keep_out", 50, [f64::NAN; 2])];
        assert_eq!(all_failed(&failed).as_deref(), Some("all 200 missions fail, so no input decides which do"));
        for other in ["launched", "flying", "not_failed"] {
            assert_eq!(all_failed(&[failed.clone(), vec![share(other, 1, [f64::NAN; 2])]].concat()), None);
            assert!(all_failed(&[failed.clone(), vec![share(other, 0, [f64::NAN; 2])]].concat()).is_some());
        }
        assert_eq!(all_failed(&vec![MissionShare { missing: 1, ..share("timeout", 199, [f64::NAN; 2]) }]), None);
    }

    /// Law: the code of a row is that of the list of failures, and a launched mission did not fail.
    #[test]
    fn rows_say_how_their_mission_ended() {
        let row =
            |launched: f64, failure: f64| of_row(&[("launched".to_owned(), launched), ("failure".to_owned(), failure)]);
        for (code, name) in Failure::NAMES.iter().enumerate().skip(1) {
            assert_eq!(row(0.0, code as f64), Some(format!("mission {}", words(name))));
            assert!(words(name).starts_with("failed: "), "{name}");
        }
        assert_eq!(row(1.0, 0.0).as_deref(), Some("mission launched"));
        assert_eq!([row(0.0, 0.0), of_row(&[])], [None, None]);
        // of one run also when
        let at = |launched: f64, failure: f64, end: f64| {
            of_run(
                &[("launched", launched), ("failure", failure), ("end_time_s", end)]
                    .map(|(name, value)| (name.to_owned(), value)),
            )
        };
        assert_eq!(at(0.0, 1.0, 812.5).as_deref(), Some("mission failed at 812.5 s: a phase took too long"));
        assert_eq!(at(1.0, 0.0, 900.0).as_deref(), Some("mission launched at 900 s"));
        assert_eq!([at(0.0, 0.0, f64::NAN), at(f64::NAN, f64::NAN, f64::NAN)], [None, None]);
    }
}
