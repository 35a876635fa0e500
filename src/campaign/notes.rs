//! [`Plan::notes`]: what is allowed in a campaign file, and is probably not what was meant.

use super::plan::Plan;
use crate::observables::accuracy::Accuracy;
use crate::sampling::design::Size;

impl Plan {
    /// What about this plan a person should know before it is run, one sentence each.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let (unvaried, incomplete) = (self.dispersions.unvaried(), self.dispersions.incomplete());
        if self.samples > 1 && !(unvaried.is_empty() && incomplete.is_empty()) {
            let points = match self.design.size(self.dispersions.dimensions().len()) {
                Size::Points(points) => format!(" ({} of {points} points)", self.samples - 1),
                Size::Any | Size::TooMany => String::new(),
            };
            let lack = [
                (!unvaried.is_empty()).then(|| format!("{} never varied", listed(&unvaried))),
                (!incomplete.is_empty()).then(|| format!("some levels of {} never occur", incomplete.join(", "))),
            ];
            notes.push(format!(
                "{} samples are a part of the {} design{points}: {}; leave campaign.samples out for all points",
                self.samples,
                self.design.name(),
                lack.into_iter().flatten().collect::<Vec<_>>().join(", and "),
            ));
        }
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
}

/// Names with the verb that follows them.
fn listed(names: &[&str]) -> String {
    format!("{} {}", names.join(", "), if names.len() == 1 { "is" } else { "are" })
}
