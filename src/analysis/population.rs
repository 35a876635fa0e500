//! [`Population`]: how the samples of a design represent the population of runs, and so which intervals hold.

use crate::campaign::Plan;
use crate::sampling::{Design, SampleId};

/// Stands for a design where `campaign.only` lists the samples.
pub const LISTED: &str = "campaign.only";

/// How samples represent the population.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Population {
    /// Independent samples of it.
    Independent,
    /// So many independent replicates of a design whose samples are not independent of each other.
    Replicated(u64),
    /// Samples of it that are not independent of each other.
    Dependent(&'static str),
    /// Chosen samples: not one of a population.
    Chosen(&'static str),
    /// The nominal sample alone.
    Nominal,
}

impl Population {
    /// That of the samples of `plan`.
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

    /// Number of groups of samples that are independent of each other; one where there are no replicates.
    pub fn groups(self) -> usize {
        match self {
            Population::Replicated(replicates) => usize::try_from(replicates).unwrap_or(1).max(1),
            _ => 1,
        }
    }

    /// Whether statistics have intervals.
    pub fn has_intervals(self) -> bool {
        matches!(self, Population::Independent | Population::Replicated(_))
    }

    /// The group of a dispersed sample.
    pub fn group(self, sample: SampleId) -> usize {
        (sample.0.saturating_sub(1) % self.groups() as u64) as usize
    }

    /// Whether `sample` is one of those that statistics are about.
    pub fn contains(self, sample: SampleId) -> bool {
        self == Population::Nominal || sample.0 > 0
    }

    /// What the intervals of statistics are, or why there are none, in words.
    pub fn intervals(self) -> String {
        match self {
            Population::Independent => {
                "of independent samples: quantiles by order statistics, mean by Student's t and, if wider, by Hall's for skewed numbers".to_owned()
            }
            Population::Replicated(replicates) => {
                format!("of {replicates} independent replicates, by Student's t and, for means, by Hall's if wider")
            }
            Population::Dependent(design) => format!(
                "none: samples of design \"{design}\" are not independent of each other; [design] replicates = 16 gives intervals"
            ),
            Population::Chosen(LISTED) => {
                "none: the samples that run are chosen (campaign.only), not drawn from a population".to_owned()
            }
            Population::Chosen(design) => {
                format!("none: samples of design \"{design}\" are chosen, not drawn from a population")
            }
            Population::Nominal => "none: the nominal sample alone".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: statistics are about the dispersed samples, about the nominal one only where it is all there is; each sample is in one group.
    #[test]
    fn the_nominal_sample_is_no_part_of_a_population() {
        let [nominal, first] = [SampleId(0), SampleId(1)];
        for population in [Population::Independent, Population::Replicated(4), Population::Dependent("sobol")] {
            assert!(!population.contains(nominal) && population.contains(first), "{population:?}");
        }
        assert!(Population::Nominal.contains(nominal));
        let groups = |population: Population| [1, 2, 3, 4, 5].map(|sample| population.group(SampleId(sample)));
        assert_eq!(groups(Population::Replicated(4)), [0, 1, 2, 3, 0]);
        assert_eq!(groups(Population::Independent), [0; 5]);
    }
}
