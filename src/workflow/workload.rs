//! [`Workload`]: estimated work, files and memory of a command.
//!
//! Impossible work is refused with its numbers, large work without `--yes`. No result depends on an estimate.

use std::num::NonZeroUsize;
use std::path::Path;

use crate::campaign::{Plan, Retention};
use crate::ensemble::Ensemble;
use crate::ensemble::probe::{AuditProbe, LongRun, RunProbe};
use crate::ensemble::run_cost::{parts_of_runs, run_seconds};
use crate::ensemble::runner::threads;
use crate::findings::number::{bytes, short};
use crate::observables::band_series::band_series;
use crate::ode::{PACE_STEPS, is_out_of_reach};
use crate::sampling::SampleId;
use crate::storage::claim::Shard;
use crate::storage::found::contents;
use crate::storage::rows_file;
use crate::storage::store::Store;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::machine::{free_disk, free_memory};

/// Limit of CPU time without `--yes`, s.
const LONG_S: f64 = 24.0 * 3600.0;
/// Limit of the fraction of the free disk without `--yes`.
const LARGE: f64 = 0.5;

/// Bytes of a number in a file: random digits do not compress. A 146-column campaign of 4096 runs has 8.2
/// (`spin_sweep`).
const NUMBER: f64 = 8.5;
/// Bytes of a part that do not depend on its rows: of each column (`spin_sweep` with one row: 180), and of each point
/// of a quantity with bands (at most 961 of `spin_sweep`; of a part of few runs a byte for each).
const PART: [f64; 2] = [200.0, 1000.0];
/// Bytes of the page and of the tables of the end, and of each column in them: 1.09 MB of 64 columns
/// (`single_wheel`), 1.87 MB of 88 with a control loop (`nadir_pointing`) and of 141 (`spin_sweep`), of 50 runs; of
/// 400 runs a tenth more.
const END: [f64; 2] = [5.5e5, 1e4];
/// Bytes of two extremes as text, and what is said of runs without a value.
const EXTREMES: f64 = 50.0;
/// Memory of the program, bytes, and of each part: its samples, record, and manifest line.
const PROGRAM: [f64; 2] = [3e7, 1000.0];
/// Most memory of a thread per observation point, bytes: of runs with debris and actuation, and what audits add.
/// Measured are 1600 to 7000, and 2200 to 7300 (tests/program/commands/memory.rs).
const POINT: [f64; 2] = [8500.0, 7500.0];
/// Columns of a time series, of its states and of what is observed of them: at most.
const SERIES: f64 = 80.0;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Workload {
    /// Description: "9 runs of small".
    what: String,
    /// Bytes of files.
    pub disk: f64,
    /// Bytes of memory.
    pub memory: f64,
    /// CPU time, s.
    seconds: f64,
    /// Assumed time of a run, s.
    run_seconds: f64,
    /// A sample out of reach at the pace of a probe, which leaves the time unknown.
    too_long: Option<SampleId>,
}

/// Most numbers in a figure, some 100 bytes each.
const PLOTTED: u64 = 2_000_000;

/// Number of first dispersed samples of `plan` in a figure, which bounds its memory.
pub fn plotted_samples(plan: &Plan) -> u64 {
    let columns = plan.dispersions.columns().len().max(1) as u64;
    (PLOTTED / columns).min(plan.samples.saturating_sub(1))
}

impl Workload {
    /// The first `samples` samples of the campaign of `ensemble` missing in `store` (`None`: all), or the share of
    /// `shard`, on at most `asked` threads.
    pub fn of_campaign(
        (ensemble, samples): (&Ensemble<'_>, u64),
        store: Option<&dyn Store>,
        shard: Option<Shard>,
        asked: Option<NonZeroUsize>,
    ) -> Self {
        let plan = ensemble.plan();
        let run_seconds = ensemble.run_seconds();
        let whole = parts_of_runs(plan, run_seconds).with_samples(samples);
        let there = match store.map(contents) {
            Some(Ok(found)) => found.rows(whole).min(samples),
            _ => 0,
        };
        let share = shard.map_or(1.0, |shard| 1.0 / shard.of as f64);
        let runs = (samples - there) as f64 * share;
        let parts = whole.count() as f64 * runs / samples as f64;
        let (columns, points) = (rows_file::columns(ensemble).len() as f64, plan.grid.points() as f64);
        let bands = (band_series(ensemble.request()).len() * plan.band_points) as f64;
        let series = points * SERIES * NUMBER;
        let retained = match plan.retention {
            Retention::All => samples as f64 * share,
            Retention::Worst { count, .. } | Retention::Sample(count) => count as f64,
            Retention::None | Retention::Failed => 0.0,
        };
        // bands have only the extremes of uncounted runs
        let counted = (plan.last_counted().0 as f64 / samples as f64).min(1.0);
        let of_bands = bands * (counted * PART[1].min(runs / parts.max(1.0)) + (1.0 - counted) * EXTREMES);
        let of_part = PART[0] * columns + of_bands;
        // a shard makes neither
        let of_end = if shard.is_some() { 0.0 } else { END[0] + END[1] * columns };
        let rows = whole.largest().min(samples) as f64 * columns * NUMBER;
        let point = POINT[0] + if plan.audit_fraction > 0.0 { POINT[1] } else { 0.0 };
        let threads = threads(asked, usize::try_from(whole.count()).unwrap_or(usize::MAX)) as f64;
        let stopping = if plan.analysis.stop.is_some() { 8.0 * samples as f64 } else { 0.0 };
        Workload {
            what: format!("{} of {}", count(runs, "run"), plan.name),
            disk: runs * columns * NUMBER + parts * of_part + retained * series + of_end,
            memory: PROGRAM[0] + PROGRAM[1] * whole.count() as f64 + threads * (points * point + 2.0 * rows) + stopping,
            seconds: runs * run_seconds,
            run_seconds,
            ..Workload::default()
        }
    }

    /// Drawing the samples of `plan`, with a table and a plot or without.
    pub fn of_samples(plan: &Plan, has_table: bool, has_plot: bool) -> Self {
        let (samples, columns) = (plan.samples as f64, plan.dispersions.columns().len() as f64);
        // numbers of CSV have some 20 characters; those of Parquet, and those of the mass properties, have fewer
        let disk = if has_table { samples * (columns + 9.0) * 20.0 } else { 0.0 };
        // the values, their ranks, and the points of the figure
        let plotted = if has_plot { plotted_samples(plan) as f64 * columns * 100.0 } else { 0.0 };
        Workload {
            what: format!("{} of {}", count(samples, "sample"), plan.name),
            disk,
            memory: PROGRAM[0] + plotted,
            seconds: samples * (1e-6 + columns * 3e-7),
            ..Workload::default()
        }
    }

    /// Drawing to a table in memory.
    pub fn of_drawn_table(plan: &Plan) -> Self {
        let work = Self::of_samples(plan, false, false);
        // number, status (ten bytes) and masses besides the values
        let numbers = plan.samples as f64 * (plan.dispersions.columns().len() as f64 + 9.5);
        Workload { memory: work.memory + numbers * 8.0, ..work }
    }

    /// Reference solutions of `samples` samples of the plan of `ensemble`, and the compared runs.
    pub fn of_precision(ensemble: &Ensemble<'_>, samples: u64) -> Self {
        let plan = ensemble.plan();
        let samples = samples.min(plan.samples) as f64;
        let points = plan.grid.points() as f64;
        let run_seconds = run_seconds(&Plan { audit_fraction: 1.0, ..plan.clone() }, ensemble.isa());
        Workload {
            what: format!("reference solutions of {} of {}", count(samples, "sample"), plan.name),
            // in double-double
            memory: PROGRAM[0] + samples * points * SERIES * 16.0,
            seconds: samples * run_seconds,
            run_seconds,
            ..Workload::default()
        }
    }

    /// With the measured CPU time of runs, if that decides.
    #[must_use]
    pub fn measured(self, ensemble: &Ensemble<'_>) -> Self {
        if self.seconds <= LONG_S {
            return self;
        }
        let (plan, probe) = (ensemble.plan(), RunProbe::new(ensemble));
        let fraction = plan.audit_fraction;
        let audit = if fraction > 0.0 { AuditProbe::new(ensemble).map(|probe| probe.seconds) } else { Ok(0.0) };
        match (probe.too_long, audit) {
            // the run ends before its assumed time
            (Some(LongRun { sample, reached }), _)
                if is_out_of_reach(plan.max_steps, reached, plan.grid.duration()) =>
            {
                Workload { too_long: Some(sample), ..self }
            }
            (None, Ok(audit)) => {
                let run_seconds = probe.seconds + fraction * audit;
                Workload { seconds: self.seconds * run_seconds / self.run_seconds, ..self }
            }
            // the assumed time exceeds that of a probe
            _ => self,
        }
    }

    /// Refuses impossible work, and without `yes` long work or most of the disk of `root`; not the time of a shard,
    /// which its scheduler limits.
    ///
    /// # Errors
    /// The refusal, with the numbers and the remedy.
    pub fn check(&self, root: &Path, yes: bool, is_shard: bool) -> Result<()> {
        self.refusal([free_disk(root), free_memory()], root, yes, is_shard)
            .map_or(Ok(()), |why| Err(WorkflowError::Input(why)))
    }

    /// Refuses without `yes`, for a campaign that may end earlier, what [`Workload::check`] always refuses.
    ///
    /// # Errors
    /// The refusal, with the numbers and the remedy.
    pub fn check_limit(&self, root: &Path, yes: bool) -> Result<()> {
        match self.check(root, false, false) {
            Err(WorkflowError::Input(why)) if !yes => {
                Err(WorkflowError::Input(format!("at most {why}; with --yes it starts, and may end earlier ([stop])")))
            }
            _ => Ok(()),
        }
    }

    /// The refusal with `disk` and `memory` bytes free, if known.
    fn refusal(&self, [disk, memory]: [Option<u64>; 2], root: &Path, yes: bool, is_shard: bool) -> Option<String> {
        let size = |size: f64| if size < u64::MAX as f64 { bytes(size as u64) } else { format!("{} B", short(size)) };
        let seconds = match self.too_long {
            None => format!("about {} of CPU time", time(self.seconds)),
            Some(sample) => {
                format!("the CPU time cannot be estimated: sample {sample} needs more than {PACE_STEPS} steps")
            }
        };
        let files = if self.disk > 0.0 {
            format!(", {} of files in `{}`", size(self.disk), root.display())
        } else {
            String::new()
        };
        let text = format!("{}: {seconds}{files}, {} of memory", self.what, size(self.memory));
        let fewer = "ask for fewer samples or points";
        if let Some(free) = disk.map(|free| free as f64).filter(|free| self.disk > *free) {
            return Some(format!("{text}: the disk has {} left; {fewer}, or choose another disk", size(free)));
        }
        if let Some(free) = memory.map(|free| free as f64).filter(|free| self.memory > *free) {
            return Some(format!("{text}: the machine has {} left; {fewer}, or fewer --threads", size(free)));
        }
        let why = if !is_shard && self.seconds > LONG_S {
            if self.too_long.is_some() { "" } else { ": that is more than 24 hours of CPU time" }
        } else if disk.is_some_and(|free| self.disk > LARGE * free as f64) {
            ": that is more than half of what the disk has left"
        } else {
            return None;
        };
        (!yes).then(|| format!("{text}{why}; --yes starts it"))
    }
}

fn count(number: f64, thing: &str) -> String {
    let end = if number == 1.0 { "" } else { "s" };
    if number < 1e15 { format!("{} {thing}{end}", number as u64) } else { format!("{} {thing}s", short(number)) }
}

/// In the largest unit of which there are two: "10 minutes".
pub fn time(seconds: f64) -> String {
    let units = [(120.0, 1.0, "s"), (7200.0, 60.0, "minutes"), (172_800.0, 3600.0, "hours"), (8.64e7, 86400.0, "days")];
    let found = units.into_iter().find(|(below, ..)| seconds < *below);
    let (_, unit, name) = found.unwrap_or((0.0, 365.25 * 86400.0, "years"));
    format!("{} {name}", short(seconds / unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: impossible work is always refused; long work, or half of the disk, without `--yes`.
    #[test]
    fn what_cannot_be_done_is_refused() {
        let free = [Some(1_000_000_000), Some(2_000_000_000)];
        let work = |disk, memory, seconds| Workload { disk, memory, seconds, ..Workload::default() };
        let refusal = |work: Workload, yes, is_shard| work.refusal(free, Path::new("r"), yes, is_shard);
        let unknown = Workload { too_long: Some(SampleId(3)), ..work(1.0, 1.0, 2.0 * LONG_S) };
        let day = "that is more than 24 hours of CPU time; --yes starts it";
        let half = "half of what the disk has left; --yes starts it";
        let years = "19013 years of CPU time, 6000000.0 TB of files in `r`, 1.0 GB of memory: the disk has 1.0 GB left";
        // what is refused with `--yes`, without it, and of a shard without it
        for (work, says) in [
            (work(4e8, 1e9, LONG_S), [None; 3]),
            (work(6e18, 1e9, 6e11), [Some(years); 3]),
            (work(0.0, 3e9, 60.0), [Some("about 60 s of CPU time, 3.0 GB of memory: the machine has 2.0 GB left"); 3]),
            (work(1.0, 1.0, 2.0 * LONG_S), [None, Some(day), None]),
            (work(6e8, 1.0, 1.0), [None, Some(half), Some(half)]),
            (unknown, [None, Some("cannot be estimated: sample 3 needs more than 20000 steps"), None]),
        ] {
            for ((yes, is_shard), says) in [(true, false), (false, false), (false, true)].into_iter().zip(says) {
                let found = refusal(work.clone(), yes, is_shard);
                let fits = found.as_ref().map_or(says.is_none(), |found| says.is_some_and(|says| found.contains(says)));
                assert!(fits, "{work:?}: {found:?}, not {says:?}");
            }
        }
        // unknown free space: only time counts
        assert_eq!(work(1e30, 1e30, 1.0).refusal([None; 2], Path::new("r"), false, false), None);
    }
}
