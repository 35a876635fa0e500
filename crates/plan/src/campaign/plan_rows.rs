//! The rows of a [`Plan`]: all samples in order, or those of `campaign.only`. Parts count rows; draws depend on sample
//! numbers.

use super::chosen::MOST_CHOSEN;
use super::plan::Plan;
use crate::sampling::SampleId;
use crate::statistics::looks::looks;

impl Plan {
    pub fn rows(&self) -> u64 {
        self.chosen.as_ref().map_or(self.samples, |chosen| chosen.len() as u64)
    }

    /// The sample of an existing row.
    pub fn sample(&self, row: u64) -> SampleId {
        let of_list = |chosen: &[u64]| usize::try_from(row).ok().and_then(|row| chosen.get(row).copied());
        SampleId(self.chosen.as_ref().map_or(row, |chosen| of_list(chosen).unwrap_or(u64::MAX)))
    }

    /// Number of rows without the nominal sample.
    pub fn dispersed_rows(&self) -> u64 {
        self.rows() - u64::from(self.rows() > 0 && self.sample(0) == SampleId(0))
    }

    /// The last sample in quantiles over time: of the first ones if these represent all, else the last of all.
    pub fn last_counted(&self) -> SampleId {
        let are_alike = self.chosen.is_none() && self.design.begins_as_it_goes_on();
        SampleId(if are_alike { self.band_runs } else { u64::MAX })
    }

    /// The numbers of samples, sample 0 included, at which `[stop]` may end the campaign; the last one ends it.
    pub fn looks(&self) -> Vec<u64> {
        match &self.analysis.stop {
            Some(stop) => looks(self.first_samples(), stop.max_samples),
            None => vec![self.rows()],
        }
    }

    /// The plan that runs only `samples`, ascending, of this plan.
    ///
    /// # Errors
    /// A plan with `[stop]`, a missing sample, or too many samples.
    pub fn only(self, samples: Vec<u64>) -> Result<Plan, String> {
        let count = samples.len();
        if self.analysis.stop.is_some() {
            return Err("[stop] must be left out where the samples that run are chosen".to_owned());
        }
        if samples.last().is_some_and(|last| *last >= self.samples) {
            return Err(format!("sample {} is none of the plan's {}", samples[count - 1], self.samples));
        }
        if !(1..=MOST_CHOSEN).contains(&count) || !samples.windows(2).all(|pair| pair[0] < pair[1]) {
            let remedy = "run all samples under the changed plan";
            return Err(format!("{count} samples; a plan lists at most {MOST_CHOSEN}: {remedy}"));
        }
        Ok(Plan { chosen: Some(samples.into()), ..self })
    }
}
