//! A summary on the screen: the verdicts first, then what was found, then how well it was computed, with all that is
//! known of it: what `--verbose` prints.

use super::audit_summary::{Numerics, shorts};
use super::observable_lines::{ObservableLine, table};
use super::summary::{LISTED, Summary};
use super::{failure_text, mission_text, requirements, warnings};
use crate::analysis::assessment::Assessment;
use crate::analysis::outcomes::OF_MOTION;
use crate::analysis::statuses::Ended;
use crate::findings::number::short;
use crate::table::Table;
use crate::table::text::Align;
use crate::table::wrapped::{message, wrapped};

/// Most observables in the table beside those that the file names.
const MOST_MAIN: usize = 6;

/// The observables of the table after those of the motion.
const MAIN: [&str; 4] =
    ["angular_momentum_error_max", "linear_momentum_error_max", "state_error_estimate", "dcm_orthonormality_max"];

/// The errors in the sentence on numerics, each with what it is of.
const ERRORS: [(&str, &str); 5] = [
    ("energy_error_max", "energy"),
    ("angular_momentum_error_max", "angular momentum"),
    ("linear_momentum_error_max", "linear momentum"),
    ("state_error_estimate", "estimated state error"),
    ("debris_state_error_estimate", "that of the debris"),
];

impl Summary {
    /// The text for lines of `width` characters. `drivers` are what drives the outcomes, `file` is the campaign as a
    /// word of the commands that show a run.
    pub fn text(&self, drivers: &str, file: &str, width: usize) -> String {
        let mut text = wrapped(&warnings::text(&self.warnings), width);
        text += &wrapped(&requirements::text(&self.verdicts), width);
        if let Some((_, stop)) = &self.stopping {
            text += &wrapped(&format!("\n  stop: {stop}\n"), width);
        }
        text += &wrapped(&self.ended(), width);
        text += &wrapped(&mission_text::text(&self.missions), width);
        text += &wrapped(&self.noted(), width);
        text += &wrapped(&self.found(width), width);
        text += &wrapped(&self.brackets(), width);
        text += &wrapped(drivers, width);
        text += &wrapped(&self.numerics(width), width);
        text + &self.replay(file, width)
    }

    /// Whether a run was computed.
    pub(super) fn is_computed(&self) -> bool {
        self.statuses.ok() > 0
    }

    /// Why runs were not computed, a line for each reason, or for each way in which they ended where no reason is
    /// known; nothing where all were.
    pub(super) fn why_failed(&self) -> String {
        let groups = self.statuses.reasons().groups();
        if groups.is_empty() { self.failures() } else { format!("{WHY}{}", failure_text::text(&groups)) }
    }

    /// How many runs ended in each way but well, and which were the first.
    fn failures(&self) -> String {
        let mut text = String::new();
        for Ended { status, count, first, .. } in self.statuses.failed() {
            let listed: Vec<String> = first.iter().take(LISTED).map(|(sample, _)| sample.to_string()).collect();
            let more = if *count > listed.len() as u64 { ", ..." } else { "" };
            text += &format!("  {:<16}{count:>12}   samples {}{more}\n", status.name(), listed.join(", "));
        }
        text
    }

    /// The observables that the file requires, names or derives; those of the motion where it does none of that.
    pub(super) fn outcomes(&self) -> Vec<&ObservableLine> {
        if self.named.is_empty() {
            return self.shown();
        }
        self.named.iter().filter_map(|name| self.lines.iter().find(|line| line.name == *name)).collect()
    }

    /// A line for each note.
    pub(super) fn noted(&self) -> String {
        self.notes.iter().map(|note| format!("  {note}\n")).collect()
    }

    fn ended(&self) -> String {
        let (runs, good) = (self.statuses.runs(), self.statuses.ok());
        if runs == good {
            return if runs == 1 {
                "\n  the run was computed\n".to_owned()
            } else {
                format!("\n  all {runs} runs were computed\n")
            };
        }
        let mut text = format!("\n  {good} of {runs} runs were computed\n{}", self.failures());
        let groups = self.statuses.reasons().groups();
        if !groups.is_empty() {
            text += &format!("  why runs failed:\n{}", failure_text::text(&groups));
        }
        text
    }

    /// The observables of the table: those that the file requires, names or derives, then the main ones.
    fn shown(&self) -> Vec<&ObservableLine> {
        let line = |name: &str| self.lines.iter().find(|line| line.name == name);
        let mut shown: Vec<&ObservableLine> = self.named.iter().filter_map(|name| line(name)).collect();
        let others = OF_MOTION.iter().chain(&MAIN).filter(|name| !self.named.iter().any(|named| named == *name));
        shown.extend(others.filter_map(|name| line(name)).take(MOST_MAIN));
        shown
    }

    /// The table of what was found.
    fn found(&self, width: usize) -> String {
        let shown = self.shown();
        if shown.is_empty() {
            return String::new();
        }
        if shown.iter().all(|line| line.is_empty()) {
            return format!(
                "\n  no {} was computed: no statistics\n",
                if self.is_computed() { "dispersed run" } else { "run" }
            );
        }
        let title = if self.without_nominal { "dispersed runs" } else { "nominal run" };
        let mut text = table(&shown, title, width);
        if self.treatment != EVERY_RUN_IS_OK {
            text += &format!("  {}\n", self.treatment);
        }
        for line in shown.iter().filter(|line| line.without_value > 0) {
            let said = match line.without_value {
                1 => "1 run that was computed has no value and is left out".to_owned(),
                runs => format!("{runs} runs that were computed have no value and are left out"),
            };
            text += &format!("  {}: {said}\n", line.name);
        }
        if self.intervals.starts_with("none") {
            text += &format!("  intervals: {}\n", self.intervals);
        }
        match self.columns.saturating_sub(shown.len()) {
            0 => {}
            more => text += &format!("  {more} more in statistics.parquet\n"),
        }
        text
    }

    /// What the intervals in brackets are, once for all of them.
    fn brackets(&self) -> String {
        let of_missions = self.missions.iter().any(|one| one.interval[0].is_finite());
        let of_lines = self.shown().iter().any(|line| line.has_interval());
        if !(of_missions || of_lines || self.verdicts.list.iter().any(Assessment::has_interval)) {
            return String::new();
        }
        format!("\n  in brackets: {}; ?: not bounded by so few runs\n", requirements::intervals(self.confidence))
    }

    /// How well it was computed: a sentence, and the audits.
    fn numerics(&self, width: usize) -> String {
        let largest = |(name, of): &(&str, &str)| {
            let line = self.lines.iter().find(|line| line.name == *name)?;
            Some(format!("{of} {}", short(line.max?)))
        };
        let errors: Vec<String> = ERRORS.iter().filter_map(largest).collect();
        let mut text = String::new();
        if !errors.is_empty() {
            text += &format!("\n  largest errors, relative: {}\n", errors.join(", "));
        }
        let Some(audit) = &self.audit else { return text };
        text += &format!("\n{}", audit.text(width));
        let shown = self.shown();
        let audited: Vec<(&&ObservableLine, &Numerics)> =
            shown.iter().filter_map(|line| Some((line, line.numerical_error.as_ref()?))).collect();
        if audited.is_empty() {
            return text;
        }
        text += "\n  numerical error, and how much of the spread (p95 - p5) it is\n";
        let heads = ["unit", "median", "p95", "max", "share"].map(|head| (head, Align::Right));
        let mut table = Table::with([("", Align::Title)].into_iter().chain(heads));
        for (line, numerics) in audited {
            let unit = if line.unit.is_empty() { "-" } else { &line.unit };
            let values = shorts([numerics.median, numerics.p95, numerics.max, numerics.share_of_spread]);
            table.row([line.name.clone(), unit.to_owned()].into_iter().chain(values));
        }
        text + &table.text(width)
    }

    /// The runs with the greatest errors and the first that failed, with the command that shows one; `file` is the
    /// campaign as a word of that command. Empty where there are none.
    fn replay(&self, file: &str, width: usize) -> String {
        let mut text = String::new();
        let worst =
            self.worst.iter().filter_map(|worst| Some((format!("worst {}", worst.name), worst.list.runs.first()?)));
        for (why, (sample, error)) in worst {
            text += &format!("  {why} {}: spindrift simulate {file} --sample {sample}\n", short(*error));
        }
        text = message(&text, width) + &self.first_failures(file, width);
        if text.is_empty() { text } else { format!("\n{text}") }
    }

    /// The first run with each status that is not `ok`, with the command that shows it, which stays whole, to be
    /// copied.
    pub(super) fn first_failures(&self, file: &str, width: usize) -> String {
        let line = |ended: &Ended| {
            let (sample, _) = ended.first.first()?;
            Some(format!("  the first {}: spindrift simulate {file} --sample {sample}\n", ended.status.name()))
        };
        message(&self.statuses.failed().filter_map(line).collect::<String>(), width)
    }
}

/// The title of the reasons of failures.
const WHY: &str = "\n  why runs failed:\n";

/// The reasons of failures without their title.
pub(super) fn untitled(reasons: &str) -> &str {
    reasons.strip_prefix(WHY).unwrap_or(reasons)
}

/// What [`crate::analysis::statistics::Statistics::treatment`] says where nothing is left out.
const EVERY_RUN_IS_OK: &str = "every run was computed";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::population::Population;
    use crate::analysis::statuses::Statuses;
    use crate::analysis::verdicts::Verdicts;
    use crate::campaign::ShownUnit;
    use crate::run::Status;
    use crate::sampling::SampleId;

    /// Five runs are ok and eight are not, without observables.
    fn summary() -> Summary {
        let mut statuses = Statuses::none(Population::Independent);
        let ended = [(Status::Done, 5..10), (Status::StepLimit, 3..5), (Status::Inaccurate, 10..16)];
        for (status, samples) in ended {
            samples.for_each(|sample| statuses.add(SampleId(sample), status, ""));
        }
        Summary {
            missions: Vec::new(),
            warnings: Vec::new(),
            notes: Vec::new(),
            name: "x".to_owned(),
            seed: 1,
            samples: 13,
            plan_hash: String::new(),
            without_nominal: true,
            statuses,
            worst: Vec::new(),
            lines: Vec::new(),
            named: Vec::new(),
            columns: 0,
            verdicts: Verdicts::default(),
            intervals: String::new(),
            treatment: String::new(),
            confidence: 0.95,
            quantile_error: 0.0,
            audit: None,
            replaced: Vec::new(),
            stopping: None,
        }
    }

    /// Law: the screen counts the runs of each status that occurs, and names the first samples of those that are not
    /// ok.
    #[test]
    fn statuses_are_counted_and_failures_named() {
        let summary = summary();
        let lines = ["  5 of 13 runs were computed", "  step_limit                 2   samples 3, 4"];
        let more = "  inaccurate                 6   samples 10, 11, 12, ...";
        assert_eq!(summary.ended(), format!("\n{}\n{}\n{more}\n", lines[0], lines[1]));
        // the command that shows the first of each
        let text = summary.text("", "plan.toml", 100);
        for (status, sample) in [("step_limit", 3), ("inaccurate", 10)] {
            assert!(
                text.contains(&format!("the first {status}: spindrift simulate plan.toml --sample {sample}\n")),
                "{text}"
            );
        }
    }

    /// Law: where no run is ok there is one line in place of a table of dashes.
    #[test]
    fn without_runs_that_are_ok_there_is_no_table() {
        let line = |count: u64| ObservableLine {
            name: "energy_error_max".to_owned(),
            unit: String::new(),
            shown: ShownUnit::own(""),
            count,
            without_value: 0,
            mean: None,
            mean_interval: [None; 2],
            standard_deviation: None,
            standard_deviation_interval: [None; 2],
            mean_note: None,
            skewness: None,
            min: None,
            max: None,
            quantiles: Vec::new(),
            numerical_error: None,
        };
        let text = |lines: Vec<ObservableLine>| Summary { lines, ..summary() }.found(100);
        let none = text(vec![line(0)]);
        assert!(none.ends_with("\n  no dispersed run was computed: no statistics\n"), "{none}");
        let some = text(vec![line(5)]);
        assert!(some.contains("energy_error_max") && !some.contains("no statistics"), "{some}");
    }
}
