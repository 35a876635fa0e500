//! [`RunningCounts`]: counts rows while they are in memory, so that they need not be read again when a campaign ends.
//!
//! Only of a large campaign that one process runs from its start: what a resumed one, or shards, have made before is on the disk, and then
//! everything is read from there. The bits are the same: the same functions count, and parts are merged in the same order.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use crate::analysis::column_counts::{Collected, Collector, PartCounts, REFERENCE_ROWS, references};
use crate::analysis::observed::Observed;
use crate::analysis::part_columns::RowNames;
use crate::analysis::population::Population;
use crate::analysis::statistics::is_exact;
use crate::analysis::tally::Tally;
use crate::ensemble::bands::BandSums;
use crate::ensemble::{Bands, CountedBands, Ensemble, Part, PartId, Parts, Rows, Supervision};
use crate::sampling::SampleId;
use crate::storage::part_sink::CountRows;

/// Counts rows part by part, in any order.
#[derive(Debug)]
pub struct RunningCounts {
    names: RowNames,
    collector: Collector,
    tally: Mutex<Tally>,
    bands: Mutex<Option<BandSums>>,
    merging: Mutex<Merging>,
}

/// What was counted of all parts of a campaign.
#[derive(Clone, Debug)]
pub struct Counted {
    /// The observables.
    pub columns: Collected,
    /// Statuses, worst runs, audits.
    pub tally: Tally,
    /// Quantities over time, where the campaign has bands.
    pub bands: Option<Bands>,
}

/// The parts that were counted.
#[derive(Debug)]
struct Merging {
    collected: Collected,
    /// Number of parts, from the first, that are merged.
    merged: u64,
    /// Parts that were counted before an earlier one.
    waiting: BTreeMap<u64, PartCounts>,
}

impl RunningCounts {
    /// Counts of the campaign `ensemble`; `None` where reading the rows again costs little, or where more than one sketch of each column
    /// would have to be held.
    pub fn of(ensemble: &Ensemble<'_>) -> Option<Self> {
        let plan = ensemble.plan();
        let population = Population::of(plan);
        if is_exact(plan) || population.groups() > 1 {
            return None;
        }
        let (observed, names) = (Observed::all(plan), RowNames::new(ensemble));
        // run once more: the first part may be counted after others
        let count = (plan.rows() as usize).min(REFERENCE_ROWS + 1);
        let mut rows = ensemble.rows(count);
        let part = Part { id: PartId(0), first: SampleId(0), count };
        ensemble.worker().run(part, &mut rows, Supervision::progress(&|_| {}));
        let references = references(&observed, population, [Ok(names.of(&rows))]).ok()?;
        let collector = Collector::new(observed, population, Some(references));
        let merging = Merging { collected: collector.nothing(), merged: 0, waiting: BTreeMap::new() };
        Some(RunningCounts {
            names,
            collector,
            tally: Mutex::new(Tally::new(ensemble)),
            bands: Mutex::new(None),
            merging: Mutex::new(merging),
        })
    }

    /// What was counted, where that is all of `parts`.
    pub fn whole(self, parts: Parts) -> Option<Counted> {
        let merging = self.merging.into_inner().unwrap_or_else(PoisonError::into_inner);
        (merging.merged == parts.count()).then(|| Counted {
            columns: self.collector.finish(merging.collected),
            tally: self.tally.into_inner().unwrap_or_else(PoisonError::into_inner),
            bands: self.bands.into_inner().unwrap_or_else(PoisonError::into_inner).map(|sums| sums.bands()),
        })
    }
}

impl CountRows for RunningCounts {
    /// Counts the rows of a part and its bands, each part once.
    fn add(&self, rows: &Rows) {
        // without the part the counts are not whole: the rows are then read again
        let Ok(counts) = self.collector.count(&self.names.of(rows)) else { return };
        if let Some(bands) = rows.bands() {
            let mut sums = self.bands.lock().unwrap_or_else(PoisonError::into_inner);
            if sums.get_or_insert_with(|| BandSums::new(bands.layout().clone())).add(bands).is_err() {
                return;
            }
        }
        self.tally.lock().unwrap_or_else(PoisonError::into_inner).add(rows);
        let mut merging = self.merging.lock().unwrap_or_else(PoisonError::into_inner);
        merging.waiting.insert(rows.part().id.0, counts);
        loop {
            let next = merging.merged;
            let Some(counts) = merging.waiting.remove(&next) else { return };
            merging.collected.merge(counts);
            merging.merged += 1;
        }
    }
}
