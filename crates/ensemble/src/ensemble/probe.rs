//! [`RunProbe`], [`AuditProbe`]: times of a run and an audit, from the first samples.

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::audit::{Audit, Auditor, NoAudit};
use crate::ensemble::failure_reasons::FailureReasons;
use crate::ensemble::flights::{LawDraw, Runs};
use crate::ensemble::parts::{Part, PartId};
use crate::ensemble::rows::Rows;
use crate::ensemble::run_cost::has_callback;
use crate::ensemble::single::SingleRuns;
use crate::ensemble::supervision::Supervision;
use crate::ensemble::worker::Ensemble;
use crate::math::lanes::WIDTH;
use crate::ode::PACE_STEPS;
use crate::run::{Grid, Status};
use crate::sampling::SampleId;
use std::time::Instant;

/// Duration of a probe, s.
const DURATION_S: f64 = 0.5;

const GROWTH: usize = 8;

const MOST_SAMPLES: usize = 512;

const MOST_POINTS: usize = 20_001;

/// Most ticks of a probe's run, some half a second; of a longer run only the first [`FEW_TICKS`] are flown.
const MOST_TICKS: f64 = 25_000.0;
const FEW_TICKS: f64 = 2000.0;

/// Duration of a probe's run, s, if the plan's has too many ticks.
pub fn part_of_run(plan: &Plan) -> Option<f64> {
    let period = plan.law.as_ref()?.spec()?.period;
    (plan.grid.duration() > MOST_TICKS * period).then_some(FEW_TICKS * period)
}

/// `plan` with steps, ticks and points limited for a probe, without audits.
pub fn limited(plan: &Plan) -> Plan {
    let points = plan.grid.points().min(MOST_POINTS);
    let grid = Grid::uniform(part_of_run(plan).unwrap_or(plan.grid.duration()), points);
    // a tick may take two steps
    let ticks = plan.loop_spec().map_or(0.0, |spec| grid.duration() / spec.period);
    Plan { max_steps: plan.max_steps.min(PACE_STEPS + 2 * ticks as u64), grid, audit_fraction: 0.0, ..plan.clone() }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LongRun {
    pub sample: SampleId,
    /// The time reached in [`PACE_STEPS`] steps, s.
    pub reached: f64,
}

#[derive(Clone, Debug)]
pub struct RunProbe {
    /// Time of a run on one core without audit, s; meaningless after a run that is too long.
    pub seconds: f64,
    pub rows: Rows,
    /// A run that is too long, with a failed row.
    pub too_long: Option<LongRun>,
}

impl RunProbe {
    /// Runs growing numbers of first samples for half a second, under a loop from one for each lane on.
    pub fn new(ensemble: &Ensemble<'_>) -> Self {
        let (whole, isa) = (ensemble.plan(), ensemble.isa());
        let plan = limited(whole);
        let ensemble = Ensemble::new(&plan, isa).unjudged();
        let most = usize::try_from(plan.rows()).unwrap_or(usize::MAX).min(MOST_SAMPLES);
        let mut rows = ensemble.rows(most);
        let mut worker = ensemble.worker();
        let points = whole.grid.points() as f64 / plan.grid.points() as f64;
        let longer = whole.grid.duration() / plan.grid.duration();
        // the time of a run of a campaign is that of a run in lanes, a fraction of that of a run alone
        let first = if plan.loop_spec().is_some() && !has_callback(&plan) { WIDTH } else { 1 };
        let (mut count, mut total) = (first.min(most), 0.0);
        loop {
            let start = Instant::now();
            let part = Part { id: PartId(0), first: SampleId(0), count };
            worker.run(part, &mut rows, Supervision::progress(&|_| {}));
            let taken = start.elapsed().as_secs_f64();
            total += taken;
            let seconds = taken / count as f64;
            let long = rows.statuses().iter().position(|status| *status == Status::StepLimit);
            if let Some(row) = long.filter(|_| plan.max_steps < whole.max_steps) {
                let sample = rows.samples()[row];
                let grid = Grid::uniform(plan.grid.duration(), 2);
                let run = SingleRuns::new(&plan, grid, isa, &[], false).run(sample);
                let reached = run.map_or(0.0, |run| run.outcome.time);
                return RunProbe { seconds, rows, too_long: Some(LongRun { sample, reached }) };
            }
            let affordable = (DURATION_S - total) / seconds.max(1e-7);
            let next = most.min(count * GROWTH).min(affordable as usize);
            if next <= count {
                return RunProbe { seconds: seconds * points * longer, rows, too_long: None };
            }
            count = next;
        }
    }

    pub fn count(&self) -> usize {
        self.rows.part().count
    }

    /// 0 if a run is too long to know its end.
    pub fn failed(&self) -> usize {
        let failed = self.rows.statuses().iter().filter(|status| **status != Status::Done).count();
        if self.too_long.is_some() { 0 } else { failed }
    }

    /// True if all runs failed, or all but the nominal.
    pub fn is_hopeless(&self) -> bool {
        self.failed() == self.count()
            || self.failed() > 0
                && self.count() > 1
                && self.rows.statuses()[1..].iter().all(|status| *status != Status::Done)
    }

    pub fn reasons(&self) -> FailureReasons {
        let (mut reasons, rows) = (FailureReasons::default(), &self.rows);
        rows.reasons().iter().for_each(|(row, text)| reasons.add(rows.samples()[*row], rows.statuses()[*row], text));
        reasons
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AuditProbe {
    pub seconds: f64,
    pub count: u32,
}

impl AuditProbe {
    /// Audits the first samples for half a second.
    ///
    /// # Errors
    /// A sample whose audit takes longer.
    pub fn new(ensemble: &Ensemble<'_>) -> Result<Self, SampleId> {
        let whole = ensemble.plan();
        let plan = &Plan { grid: whole.grid.clone(), ..limited(whole) };
        let mut auditor = Auditor::new(plan, ensemble.isa(), &plan.grid).with_most_steps(PACE_STEPS);
        let mut draws = SceneDraws::new(plan);
        let start = Instant::now();
        let (mut count, mut sample) = (0_u32, 0);
        while sample < plan.samples && start.elapsed().as_secs_f64() < DURATION_S {
            if let Ok(scene) = draws.scene(SampleId(sample)) {
                let draw = LawDraw::of(plan, SampleId(sample), draws.drawn());
                let audits = auditor.audit_flown(Runs::one(&scene, draw.as_slice()), None, &[Status::Done]);
                let is_too_long = |audit: &Result<Audit, NoAudit>| {
                    matches!(audit, Err(NoAudit::Run(Status::StepLimit) | NoAudit::Reference(Status::StepLimit)))
                };
                if audits.iter().any(is_too_long) {
                    return Err(SampleId(sample));
                }
                count += 1;
            }
            sample += 1;
        }
        Ok(AuditProbe { seconds: start.elapsed().as_secs_f64() / f64::from(count.max(1)), count })
    }
}
