//! [`Population`]: how the samples of a design represent the population of runs, and which intervals apply.

use crate::campaign::Plan;
use crate::run::Status;
use crate::sampling::{Design, SampleId};

/// Stands for a design if `campaign.only` lists the samples.
pub const LISTED: &str = "campaign.only";

/// Runs without numbers: not computed to their end, or inaccurate. Unphysical samples are outside of the population.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Loss {
    pub missing: u64,
    pub runs: u64,
    /// Unphysical samples.
    pub outside: u64,
}

impl Loss {
    /// Minimum share of missing runs of a big loss: the others do not bound the 95%-quantile, which all missing ones
    /// may exceed. Below, intervals treat the loss as random.
    pub const BIG: f64 = 0.05;

    /// From counts in the order of [`Status::ALL`].
    pub fn of(statuses: &[u64; Status::ALL.len()]) -> Self {
        let counts = Status::ALL.iter().zip(statuses);
        counts.fold(Loss::default(), |loss, (status, count)| match status {
            Status::InvalidSample => Loss { outside: count + loss.outside, ..loss },
            Status::Done => Loss { runs: loss.runs + count, ..loss },
            _ => Loss { runs: loss.runs + count, missing: loss.missing + count, ..loss },
        })
    }

    pub fn counts(self) -> String {
        let which = if self.outside > 0 { " that are physical" } else { "" };
        format!("{} of {} dispersed runs{which}", self.missing, self.runs)
    }

    /// True if the remaining runs say little about all.
    pub fn is_big(self) -> bool {
        self.missing > 0 && self.missing as f64 >= Self::BIG * self.runs as f64
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Population {
    Independent,
    /// Independent replicates of a design with dependent samples.
    Replicated(u64),
    /// Dependent samples of the population.
    Dependent(&'static str),
    /// Chosen samples, from no population.
    Chosen(&'static str),
    Nominal,
    /// After a big loss.
    Incomplete(Loss),
}

impl Population {
    pub fn of(plan: &Plan) -> Self {
        let name = plan.design.name();
        match &plan.design {
            _ if plan.chosen.is_some() => Population::Chosen(LISTED),
            _ if plan.samples < 2 => Population::Nominal,
            design if design.replicates() > 1 => Population::Replicated(design.replicates()),
            Design::Random(_) => Population::Independent,
            Design::LatinHypercube(_) | Design::Sobol(_) | Design::Halton(_) => Population::Dependent(name),
            Design::Grid(_) | Design::OneAtATime(_) | Design::Saltelli(_) | Design::Table(_) => {
                Population::Chosen(name)
            }
        }
    }

    #[must_use]
    pub fn after(self, loss: Loss) -> Self {
        if loss.is_big() && self.has_intervals() { Population::Incomplete(loss) } else { self }
    }

    /// Number of independent groups of samples; one without replicates.
    pub fn groups(self) -> usize {
        match self {
            Population::Replicated(replicates) => usize::try_from(replicates).unwrap_or(1).max(1),
            _ => 1,
        }
    }

    pub fn has_intervals(self) -> bool {
        matches!(self, Population::Independent | Population::Replicated(_))
    }

    pub fn group(self, sample: SampleId) -> usize {
        (sample.0.saturating_sub(1) % self.groups() as u64) as usize
    }

    pub fn contains(self, sample: SampleId) -> bool {
        self == Population::Nominal || sample.0 > 0
    }

    /// [`Population::intervals`] as a clause.
    pub fn about_intervals(self) -> String {
        let text = self.intervals();
        text.strip_prefix("none: ").map_or_else(|| format!("intervals: {text}"), |why| format!("no intervals: {why}"))
    }

    /// The kind of intervals, or why there are none.
    pub fn intervals(self) -> String {
        match self {
            Population::Independent => {
                "of independent samples: quantiles by order statistics, mean by Student's t and, if wider, by Hall's \
                for skewed numbers"
                    .to_owned()
            }
            Population::Replicated(replicates) => {
                format!("of {replicates} independent replicates, by Student's t and, for means, by Hall's if wider")
            }
            Population::Dependent(design) => format!(
                "none: samples of design \"{design}\" are not independent of each other; [design] replicates = 16 \
                gives intervals"
            ),
            Population::Chosen(LISTED) => {
                "none: the samples that run are chosen (campaign.only), not drawn from a population".to_owned()
            }
            Population::Chosen(design) => {
                format!("none: samples of design \"{design}\" are chosen, not drawn from a population")
            }
            Population::Nominal => "none: the nominal sample alone".to_owned(),
            Population::Incomplete(loss) => {
                format!("none: {} have no numbers, and need not be like the others", loss.counts())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a loss is big from a twentieth of the physical runs on; only then an independent population loses its
    /// intervals.
    #[test]
    fn a_big_loss_leaves_no_intervals() {
        let place = |status: Status| Status::ALL.iter().position(|one| *one == status).expect("a status");
        for status in Status::ALL.into_iter().filter(|status| *status != Status::Done) {
            for lost in [0_u64, 1, 4, 5, 6, 90] {
                let mut statuses = [0; Status::ALL.len()];
                (statuses[place(Status::Done)], statuses[place(status)]) = (100 - lost, lost);
                let is_run = status != Status::InvalidSample;
                let loss = Loss::of(&statuses);
                let known = if is_run { (lost, 100) } else { (0, 100 - lost) };
                assert_eq!((loss.missing, loss.runs), known, "{status:?}");
                let left = Population::Independent.after(loss);
                assert_eq!(left.has_intervals(), !(is_run && lost >= 5), "{status:?} {lost}");
                assert_eq!(left.intervals().contains("90 of 100"), is_run && lost == 90);
                assert_eq!(Population::Nominal.after(loss), Population::Nominal);
            }
        }
    }
}
