//! [`Tally`]: statistics of a campaign, counted part by part.
//!
//! Only counts are kept and no floating-point sums, so that the statistics do not depend on the order of the parts.

use crate::dataset::audit_tally::AuditTally;
use crate::ensemble::{Ensemble, Rows};
use crate::observables::Kind;
use crate::run::Status;
use crate::statistics::sketch::Sketch;

/// The observables with statistics in the summary, where the campaign has them.
pub const HEADLINES: &[&str] = &[
    "energy_error_max",
    "energy_error_rate_per_s",
    "linear_momentum_error_max",
    "angular_momentum_error_max",
    "debris_linear_momentum_error_max",
    "debris_angular_momentum_error_max",
    "dcm_orthonormality_max",
    "residual_kinematic_max_m_s",
    "residual_collocation_max_m",
    "residual_attitude_max",
    "energy_com_error_max",
    "exchange_fuselage_peak_to_peak_j",
    "exchange_wheel1_peak_to_peak_j",
    "exchange_wheel2_peak_to_peak_j",
    "exchange_fuselage_fraction",
    "exchange_wheel1_fraction",
    "exchange_wheel2_fraction",
    "exchange_wheel1_gross_j",
    "exchange_wheel2_gross_j",
    "steps",
    "state_error_estimate",
    "error_amplification",
    "ill_conditioned",
];

/// An observable with statistics in the summary.
#[derive(Clone, Debug)]
pub struct Headline {
    /// Index among the observables of a row.
    index: usize,
    /// Column name.
    pub name: &'static str,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
    kind: Kind,
    /// Its values over the runs that are `ok`.
    pub sketch: Sketch,
}

impl Headline {
    /// The value of rank ceil(p n). A count is rounded to a whole number, which the middle of a bucket need not be.
    pub fn quantile(&self, p: f64) -> Option<f64> {
        let value = self.sketch.quantile(p)?;
        Some(if self.kind == Kind::Count { libm::round(value) } else { value })
    }
}

/// Counts of statuses, and of values of the main observables over the runs that are `ok`.
#[derive(Clone, Debug)]
pub struct Tally {
    statuses: [u64; Status::ALL.len()],
    headlines: Vec<Headline>,
    /// `None` where the campaign has no audits.
    audits: Option<AuditTally>,
}

impl Tally {
    /// Nothing counted yet.
    pub fn new(ensemble: &Ensemble<'_>) -> Self {
        let columns = ensemble.request().columns();
        let headline = |name: &&'static str| {
            let index = columns.iter().position(|column| column.name == *name)?;
            let column = columns[index];
            Some(Headline { index, name, unit: column.unit, kind: column.kind, sketch: Sketch::default() })
        };
        let headlines: Vec<Headline> = HEADLINES.iter().filter_map(headline).collect();
        let audits = (ensemble.plan().audit_fraction > 0.0).then(|| AuditTally::new(headlines.len()));
        Tally { statuses: [0; Status::ALL.len()], headlines, audits }
    }

    /// Counts the rows of a part.
    pub fn add(&mut self, rows: &Rows) {
        for status in rows.statuses() {
            self.statuses[status_index(*status)] += 1;
        }
        for headline in &mut self.headlines {
            for (value, status) in rows.observable(headline.index).iter().zip(rows.statuses()) {
                if *status == Status::Done {
                    headline.sketch.add(*value);
                }
            }
        }
        if let Some(audits) = &mut self.audits {
            audits.add(rows, self.headlines.iter().map(|headline| headline.index));
        }
    }

    /// The statistics of the observables in the order of [`HEADLINES`], without those that the campaign does not have.
    pub fn headlines(&self) -> &[Headline] {
        &self.headlines
    }

    /// The statistics of the audits, where the campaign has audits.
    pub fn audits(&self) -> Option<&AuditTally> {
        self.audits.as_ref()
    }

    /// How many samples ended with `status`.
    pub fn count(&self, status: Status) -> u64 {
        self.statuses[status_index(status)]
    }

    /// How many runs failed.
    pub fn failed(&self) -> u64 {
        self.statuses.iter().sum::<u64>() - self.count(Status::Done)
    }
}

fn status_index(status: Status) -> usize {
    Status::ALL.iter().position(|known| *known == status).expect("every status is in the list of all")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: every headline is an observable; a name that changes there must change here.
    #[test]
    fn headlines_are_observables() {
        use crate::observables::{Groups, Request};
        let request = |debris, actuated, constrained| Request { groups: Groups::ALL, debris, actuated, constrained };
        let mut names: Vec<&str> = request(true, false, true).columns().iter().map(|column| column.name).collect();
        names.extend(request(true, true, false).columns().iter().map(|column| column.name));
        for headline in HEADLINES {
            assert!(names.contains(headline), "{headline} is not among {names:?}");
        }
    }
}
