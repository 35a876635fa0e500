//! Why runs failed, as lines of text.

use crate::ensemble::FailureReason;
use crate::run::Status;

/// Most reasons that are listed.
const MOST: usize = 8;

/// What can be done about runs that end with a status; `None` where the reason says it.
pub fn remedy(status: Status) -> Option<&'static str> {
    match status {
        Status::StepLimit => Some("to fix: increase integrator.max_steps or integrator.tolerance"),
        Status::StepFloor => Some("to fix: increase integrator.tolerance"),
        Status::Inaccurate => Some("to fix: decrease integrator.tolerance or integrator.step_s"),
        _ => None,
    }
}

/// A line for each of `groups`, as many as are listed: how many runs, how they ended, and the reason of the first.
pub fn text(groups: &[&FailureReason]) -> String {
    let line = |one: &&FailureReason| {
        let (status, which) = (one.status.name(), if one.count == 1 { "" } else { "first " });
        let remedy = remedy(one.status).map_or(String::new(), |remedy| format!("{:14}{remedy}\n", ""));
        format!("  {:>10}  {status}: {} ({which}sample {})\n{remedy}", one.count, one.text, one.first)
    };
    let mut text: String = groups.iter().take(MOST).map(line).collect();
    if groups.len() > MOST {
        let rest: u64 = groups[MOST..].iter().map(|one| one.count).sum();
        text += &format!("  {rest:>10}  for {} other reasons\n", groups.len() - MOST);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::SampleId;

    /// Law: every run is counted once, in the line of its reason or in that of the others; a run that is alone is not the first of several.
    #[test]
    fn every_run_is_counted() {
        for groups in [1, 8, 9, 12] {
            let of = |k: u64| FailureReason {
                status: Status::StepLimit,
                count: k,
                first: SampleId(100 + k),
                text: "too many".to_owned(),
            };
            let all: Vec<FailureReason> = (1..=groups).map(of).collect();
            let text = text(&all.iter().collect::<Vec<_>>());
            let counts = text
                .lines()
                .filter(|line| !line.contains("to fix"))
                .map(|line| line.split_whitespace().next().and_then(|word| word.parse::<u64>().ok()));
            assert_eq!(counts.map(Option::unwrap_or_default).sum::<u64>(), groups * (groups + 1) / 2, "{text}");
            assert_eq!(text.contains(&format!("for {} other reasons", groups.saturating_sub(8))), groups > 8, "{text}");
            assert_eq!(text.matches("to fix: increase integrator.max_steps ").count() as u64, groups.min(8), "{text}");
            let first = text.lines().filter(|line| line.contains("(first sample ")).count() as u64;
            assert!(text.contains("(sample 101)") && first == groups.min(8) - 1, "{text}");
        }
    }

    /// Law: steps that are too many or too small ask for a looser tolerance, numbers that are not accurate for a tighter one; what a scene is has its own reason.
    #[test]
    fn remedies_point_the_right_way() {
        for status in Status::ALL {
            let said = remedy(status).unwrap_or_default();
            let ways = ["increase", "decrease"].map(|way| said.contains(&format!("to fix: {way}")));
            let expected = match status {
                Status::StepLimit | Status::StepFloor => [true, false],
                Status::Inaccurate => [false, true],
                _ => [false, false],
            };
            assert_eq!(ways, expected, "{}: {said}", status.name());
            assert_eq!(said.contains("integrator.tolerance"), expected != [false, false], "{said}");
        }
    }
}
