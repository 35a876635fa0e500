//! [`Gathered`]: the results of one fold over the parts, from rows in memory ([`RunningFold`]) or from files
//! ([`Gathered::of_files`]), with the same bits.

use super::accumulator::{Accumulator, of_files};
use super::observed::Observed;
use super::population::Population;
use crate::analysis::column_counts::{Collected, Collector, REFERENCE_ROWS, batches, is_exact, references};
use crate::analysis::first_rows::{FirstRows, RowTable};
use crate::analysis::missions::{MissionCounter, Missions};
use crate::analysis::part_columns::RowNames;
use crate::analysis::stopping::{ObservedValues, StopValues};
use crate::analysis::survey::{Survey, Surveyor};
use crate::analysis::tally::{Tally, TallyColumns};
use crate::analysis::trajectories::Retained;
use crate::analysis::verdicts::{RequirementCounter, RequirementCounts};
use crate::campaign::Plan;
use crate::ensemble::threads::{Threads, unpoisoned};
use crate::ensemble::{Bands, Ensemble, Part, PartId, Parts, Rows, Supervision};
use crate::sampling::SampleId;
use crate::storage::bands_file;
use crate::storage::part_sink::CountRows;
use crate::storage::rows_reader::{Result, RowsReader};
use std::collections::BTreeMap;
use std::sync::Mutex;

type Everything = (
    ((TallyColumns, Collector), (RequirementCounter, ObservedValues)),
    ((FirstRows, Retained), (Surveyor, MissionCounter)),
);

#[derive(Debug)]
pub struct RowsFold(Everything);

#[derive(Clone, Debug)]
pub struct Gathered {
    pub tally: Tally,
    /// Observables of the first of the [`batches`].
    pub columns: Collected,
    pub requirements: RequirementCounts,
    /// Values of the observable of `[stop]`, if any.
    pub stop_values: StopValues,
    pub first_rows: RowTable,
    pub retained: Vec<SampleId>,
    pub survey: Survey,
    pub missions: Missions,
    pub bands: Option<Bands>,
}

impl RowsFold {
    /// `references`: values about which observables are sketched, if not kept.
    fn new(ensemble: &Ensemble<'_>, references: Option<Vec<f64>>) -> Self {
        let plan = ensemble.plan();
        let columns = Collector::new(first_batch(plan), Population::of(plan), references);
        RowsFold((
            (
                (TallyColumns::new(ensemble), columns),
                (RequirementCounter::new(plan), ObservedValues::of_stop(plan, plan.samples)),
            ),
            ((FirstRows::new(plan), Retained::new(plan)), (Surveyor::new(ensemble), MissionCounter::new(plan))),
        ))
    }

    fn gathered(self, whole: <Everything as Accumulator>::Whole, bands: Option<Bands>) -> Gathered {
        let (((tally, columns), (requirements, stop_values)), ((first_rows, retained), (survey, missions))) = whole;
        let (((_, collector), _), ((_, retention), (_, counter))) = self.0;
        Gathered {
            survey: survey.finished(tally.statuses.clone()),
            tally,
            columns: collector.finish(columns),
            requirements,
            stop_values,
            first_rows,
            retained: retention.chosen(retained),
            missions: counter.finished(&missions),
            bands,
        }
    }
}

fn first_batch(plan: &Plan) -> Vec<Observed> {
    batches(plan).into_iter().next().unwrap_or_default()
}

impl Gathered {
    /// Reads the rows and bands of `ensemble`, on `threads` threads.
    pub fn of_files(ensemble: &Ensemble<'_>, reader: &RowsReader, threads: Threads) -> Result<Gathered> {
        let plan = ensemble.plan();
        let bands = bands_file::read(reader.store(), reader.bands(), threads)?;
        // plus the nominal row
        let first = || references(&first_batch(plan), Population::of(plan), reader.first_parts(REFERENCE_ROWS + 1));
        let fold = RowsFold::new(ensemble, (!is_exact(plan)).then(first).transpose()?);
        let whole = of_files(&fold.0, reader, threads)?;
        Ok(fold.gathered(whole, bands))
    }
}

/// Folds rows in memory, part by part in any order, instead of reading them again at the end: only in a campaign that
/// one process runs from start to end.
#[derive(Debug)]
pub struct RunningFold {
    names: RowNames,
    fold: RowsFold,
    bands: Mutex<Option<Bands>>,
    merging: Mutex<Merging>,
}

#[derive(Debug)]
struct Merging {
    whole: <Everything as Accumulator>::Whole,
    merged: u64,
    /// Counted parts that wait for an earlier one.
    waiting: BTreeMap<u64, <Everything as Accumulator>::OfPart>,
}

impl RunningFold {
    /// `None` if the first rows cannot be computed.
    pub fn of(ensemble: &Ensemble<'_>) -> Option<Self> {
        let plan = ensemble.plan();
        let names = RowNames::new(ensemble);
        let first = || {
            // computed separately: the first part may come late
            let count = (plan.rows() as usize).min(REFERENCE_ROWS + 1);
            let mut rows = ensemble.rows(count);
            let part = Part { id: PartId(0), first: SampleId(0), count };
            ensemble.worker().run(part, &mut rows, Supervision::progress(&|_| {}));
            references(&first_batch(plan), Population::of(plan), [Ok(names.of(&rows))])
        };
        let fold = RowsFold::new(ensemble, (!is_exact(plan)).then(first).transpose().ok()?);
        let merging = Merging { whole: fold.0.nothing(), merged: 0, waiting: BTreeMap::new() };
        Some(RunningFold { names, fold, bands: Mutex::new(None), merging: Mutex::new(merging) })
    }

    /// The results, if all `parts` were counted.
    pub fn whole(self, parts: Parts) -> Option<Gathered> {
        let merging = unpoisoned(self.merging.into_inner());
        let bands = unpoisoned(self.bands.into_inner());
        (merging.merged == parts.count()).then(|| self.fold.gathered(merging.whole, bands))
    }
}

impl CountRows for RunningFold {
    fn add(&self, rows: &Rows) {
        // an incomplete fold is discarded and the rows are read again
        let Ok(of_part) = self.fold.0.count(&self.names.of(rows)) else { return };
        if let Some(part) = rows.bands() {
            let mut bands = unpoisoned(self.bands.lock());
            bands.get_or_insert_with(|| Bands::new(part.layout().clone())).add(part);
        }
        let mut merging = unpoisoned(self.merging.lock());
        merging.waiting.insert(rows.part().id.0, of_part);
        while let Some(next) = {
            let next = merging.merged;
            merging.waiting.remove(&next)
        } {
            self.fold.0.merge(&mut merging.whole, next);
            merging.merged += 1;
        }
    }
}
