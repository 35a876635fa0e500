//! [`Tally`]: statistics of a campaign, counted part by part.
//!
//! Only counts are kept and no floating-point sums, so that the statistics do not depend on the order of the parts.

use crate::dataset::audit_tally::AuditTally;
use crate::ensemble::{Ensemble, Rows};
use crate::observables::table::HEADLINES;
use crate::observables::{ColumnId, Kind};
use crate::run::{Quantity, Status};
use crate::statistics::sketch::Sketch;

/// An observable with statistics in the summary.
#[derive(Clone, Debug)]
pub struct Headline {
    /// Index among the observables of a row.
    index: usize,
    /// Name, unit and meaning.
    pub quantity: &'static Quantity,
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
        let headline = |id: &ColumnId| {
            let index = ensemble.request().position(*id)?;
            let column = columns[index];
            Some(Headline { index, quantity: &column.quantity, kind: column.kind, sketch: Sketch::default() })
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
