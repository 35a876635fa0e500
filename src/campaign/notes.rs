//! [`Plan::notes`]: what is allowed in a campaign file, and is probably not what was meant.

use super::plan::Plan;
use crate::observables::accuracy::Accuracy;
use crate::sampling::design::{MAX_SAMPLES, Size};

impl Plan {
    /// What about this plan a person should know before it is run, one sentence each.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.samples > 1 && self.dispersions.columns().is_empty() {
            notes.push(format!("nothing is dispersed: all {} samples are the nominal scene", self.samples));
        }
        let constant = self.dispersions.constant();
        if !constant.is_empty() {
            notes.push(format!(
                "{} never varied: every draw is the nominal value (a spread of 0, or one relative to a nominal value of 0)",
                listed(&constant)
            ));
        }
        notes.extend(self.part_of_a_design());
        for replaced in self.dispersions.replaced_correlations() {
            notes.push(format!(
                "nearest_psd: the correlations of {} cannot be had; `check`, plan.toml and summary.json state those used",
                replaced.names.join(", ")
            ));
        }
        if Accuracy::new(&self.request()).is_blind() {
            notes.push(
                "no requested column says how accurate a run is, so none can end as inaccurate; add \"energy_conservation\", \"momentum_conservation\" or \"numerics\" to observe.groups"
                    .to_owned(),
            );
        }
        notes
    }

    /// That there are fewer samples than the design has points, and what these do not vary.
    fn part_of_a_design(&self) -> Option<String> {
        let points = match self.design.size(self.dispersions.dimensions().len()) {
            Size::Points(points) if points < MAX_SAMPLES => Some(points),
            Size::Points(_) | Size::TooMany => None,
            Size::Any => return None,
        };
        let drawn = self.samples - 1;
        if drawn == 0 || points == Some(drawn) {
            return None;
        }
        let (all, remedy) = match points {
            Some(points) => (format!("{points} points"), "leave campaign.samples out for all points"),
            None => ("more points than a campaign may have".to_owned(), "write fewer levels for all points"),
        };
        let (unvaried, incomplete) = (self.dispersions.unvaried(), self.dispersions.incomplete());
        let lack = [
            (!unvaried.is_empty()).then(|| format!("{} never varied", listed(&unvaried))),
            (!incomplete.is_empty()).then(|| format!("some levels of {} never occur", incomplete.join(", "))),
        ];
        let lack: Vec<String> = lack.into_iter().flatten().collect();
        Some(format!(
            "{} samples are a part of the {} design ({drawn} of {all}){}{}; {remedy}",
            self.samples,
            self.design.name(),
            if lack.is_empty() { "" } else { ": " },
            lack.join(", and "),
        ))
    }
}

/// Names with the verb that follows them.
fn listed(names: &[&str]) -> String {
    format!("{} {}", names.join(", "), if names.len() == 1 { "is" } else { "are" })
}
