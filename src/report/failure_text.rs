//! Why runs failed, as lines of text.

use crate::ensemble::FailureReason;
use crate::ensemble::failure_reasons::with_numbers;
use crate::findings::number::trimmed;
use crate::run::Status;

/// Most reasons that are listed.
const MOST: usize = 8;

/// What can be done about runs that end with a status; `None` where the reason says it.
pub fn remedy(status: Status) -> Option<&'static str> {
    match status {
        Status::StepLimit => Some("to fix: increase integrator.max_steps or integrator.tolerance"),
        Status::StepFloor => Some("to fix: increase integrator.tolerance"),
        Status::Inaccurate => Some("to fix: decrease integrator.tolerance or integrator.step_s"),
        Status::Surface => {
            Some("to fix: raise the orbit, or end such runs before by an [[event]] with ends_run = true")
        }
        _ => None,
    }
}

/// A reason as people read it: its numbers, which are those of the run bit for bit, in six digits.
pub fn readable(reason: &str) -> String {
    with_numbers(reason, |number| {
        // a sentence may end with it
        let digits = number.trim_end_matches('.');
        match digits.parse::<f64>() {
            Ok(value) if digits.contains('.') && digits.len() > 8 => trimmed(value, 6) + &number[digits.len()..],
            _ => number.to_owned(),
        }
    })
}

/// A line for each of `groups`, as many as are listed: how many runs, how they ended, and the reason of the first.
pub fn text(groups: &[&FailureReason]) -> String {
    let line = |one: &&FailureReason| {
        let (status, which) = (one.status.name(), if one.count == 1 { "" } else { "first " });
        let remedy = remedy(one.status).map_or(String::new(), |remedy| format!("{:14}{remedy}\n", ""));
        format!("  {:>10}  {status}: {} ({which}sample {})\n{remedy}", one.count, readable(&one.text), one.first)
    };
    let mut text: String = groups.iter().take(MOST).map(line).collect();
    if groups.len() > MOST {
        let rest: u64 = groups[MOST..].iter().map(|one| one.count).sum();
        text += &format!("  {rest:>10}  for {} other reasons\n", groups.len() - MOST);
    }
    text
}

/// What each status is called, in words.
pub fn status_words(status: Status) -> &'static str {
    match status {
        Status::Done => "computed",
        Status::StepLimit => "computation failed: too many steps",
        Status::StepFloor => "computation failed: step too small",
        Status::NonFinite => "computation failed: not finite",
        Status::InvalidSample => "invalid: not physical",
        Status::Inaccurate => "inaccurate",
        Status::InternalError => "internal error",
        Status::Surface => "reached the surface",
        Status::Diverged => "the control loop diverged",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::SampleId;

    /// Known: long numbers are rounded; names, counts, short numbers and points at the end of a sentence stay.
    #[test]
    fn long_numbers_are_rounded() {
        for (reason, said) in [
            ("the run reached 0.6315175779453478 s", "the run reached 0.631518 s"),
            ("at -1.2345678901234567e-7.", "at -1.23457e-7."),
            ("wheels.w1.mass_kg is 12.5; 1000000000 steps. 2.", "wheels.w1.mass_kg is 12.5; 1000000000 steps. 2."),
            ("sha 0123456789abc.5", "sha 0123456789abc.5"),
        ] {
            assert_eq!(readable(reason), said);
        }
    }

    /// Law: every run is counted once, in the line of its reason or in that of the others; a run that is alone is not
    /// the first of several.
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

    /// Law: steps that are too many or too small ask for a looser tolerance, numbers that are not accurate for a
    /// tighter one; what a scene is has its own reason.
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

    /// Law: every status has words of its own, a reason or a remedy that does not send a reader to the wrong key, and
    /// a line in the documents.
    #[test]
    fn every_status_is_explained() {
        let keys = include_str!("../../docs/campaign-files.md");
        let columns = include_str!("../../docs/columns.md");
        for (place, status) in Status::ALL.into_iter().enumerate() {
            let name = status.name();
            assert!(keys.contains(&format!("\n| `{name}` |")), "{name} is not in campaign-files.md");
            assert!(columns.contains(&format!(" {name},")) || columns.contains(&format!(" {name}. |")), "{name}");
            let others = Status::ALL[..place].iter().map(|other| (other.name(), status_words(*other)));
            assert!(others.into_iter().all(|(other, words)| other != name && words != status_words(status)), "{name}");
            let of_run =
                [Status::Done, Status::InvalidSample, Status::InternalError, Status::Inaccurate, Status::Diverged];
            assert_eq!(status.reason(1.0).is_none(), of_run.contains(&status), "{name}");
            let is_of_steps = remedy(status).is_some_and(|remedy| remedy.contains("max_steps"));
            assert_eq!(is_of_steps, status == Status::StepLimit, "{name}");
        }
    }
}
