//! [`parts`]: a plan's parts, sized by the cost of its runs: the counted work of the nominal run times the time of a
//! unit on a slow core, since a clock would give different parts elsewhere.

use crate::campaign::Plan;
use crate::ensemble::flights::Flights;
use crate::ensemble::parts::Parts;
use crate::ensemble::settings::{Engines, propagator};
use crate::loops::callback::is_law_of;
use crate::math::Isa;
use crate::ode::{Control, PACE_STEPS};
use crate::propagation::Method;
use crate::run::{Grid, Outcome};

/// Most work that a stopped thread loses, s.
const LOST_S: f64 = 10.0;
/// Most counted steps; the cost of a longer run is extrapolated.
const COUNTED_STEPS: u64 = PACE_STEPS;
/// Time of an evaluation, s: three times that alone in its vector on the reference machine (`cargo bench -p
/// spindrift-benches --bench kernels`).
const fn evaluation_seconds(method: Method) -> f64 {
    match method {
        Method::NullSpace => 6e-6,
        Method::Auto | Method::Taylor | Method::Gyrostat(_) => 3e-6,
    }
}
const POINTS: usize = 101;
/// Time of a control tick, s (`detumble_magnetic`: 1.4e-5).
const TICK_S: f64 = 1.5e-5;
/// Time of an observed point, s.
const POINT_S: f64 = 5e-7;
/// Work of an audit over its run's: double-double at a tolerance of 1e-28.
const AUDIT: f64 = 300.0;
/// The same under a law: the loop, and again in thirds of its arcs.
const AUDIT_OF_LOOP: f64 = 6.0;

/// Work of the pilots that judge the loop of a campaign ([`crate::ensemble::pilots`]), in runs.
const PILOTS: f64 = 24.0;

/// Samples of a part under a callback that serves many runs at once: more parts make larger calls.
const SERVED: u64 = 64;

/// True if the law is a callback of unknown work.
pub fn has_callback(plan: &Plan) -> bool {
    plan.loop_spec().is_some_and(is_law_of)
}

/// Time of a campaign of `plan` on `cores`, s, by that of a run on one core, s; its pilots are flown on one core.
pub fn campaign_seconds(plan: &Plan, run_seconds: f64, cores: usize) -> f64 {
    let pilots = if plan.law.is_some() { PILOTS } else { 0.0 };
    run_seconds * (plan.rows() as f64 / cores as f64 + pilots)
}

/// The parts of `plan` by the time of a run, `seconds()`.
pub fn parts(plan: &Plan, seconds: impl FnOnce() -> f64) -> Parts {
    if has_callback(plan) { Parts::up_to(plan.rows(), SERVED) } else { parts_of_runs(plan, seconds()) }
}

pub fn parts_of_runs(plan: &Plan, seconds: f64) -> Parts {
    Parts::up_to(plan.rows(), if has_callback(plan) { SERVED } else { (LOST_S / seconds) as u64 })
}

/// The longest time of a run on one core, s: a function of the plan alone.
pub fn run_seconds(plan: &Plan, isa: Isa) -> f64 {
    // the limit of steps does not count ticks
    let counted = plan.loop_spec().map_or(f64::NAN, |spec| spec.period * COUNTED_STEPS as f64);
    let duration = if plan.grid.duration() > 2.0 * counted { counted } else { plan.grid.duration() };
    // points would only take memory
    let grid = Grid::uniform(duration, plan.grid.points().min(POINTS));
    let mut settings = propagator(plan, grid, plan.request().fields());
    settings.control = Control { max_steps: plan.max_steps.min(COUNTED_STEPS), ..settings.control };
    let mut found: Option<Outcome> = None;
    Flights::new(plan, &settings, Engines::of(isa)).fly_nominal(&mut |run, _| found = Some(*run.outcome));
    let evaluations = found.map_or(COUNTED_STEPS as f64, |outcome| {
        let share = (outcome.time / plan.grid.duration()).clamp(1e-9, 1.0);
        outcome.effort.evaluations as f64 / share
    });
    // a run stops at the limit of steps
    let most = plan.max_steps.saturating_mul(16) as f64;
    let each = evaluation_seconds(plan.method);
    let ticks = plan.loop_spec().map_or(0.0, |spec| plan.grid.duration() / spec.period);
    let run = evaluations.min(most) * each + ticks * TICK_S + plan.grid.points() as f64 * POINT_S;
    let audit = if plan.law.is_some() { AUDIT_OF_LOOP } else { AUDIT };
    run * (1.0 + audit * plan.audit_fraction)
}

/// Time of a page, s, besides a tenth of its campaign.
const PAGE_S: f64 = 0.15;
/// Time of an evaluation beside other runs, with law and observation, s: 5e-6 in `net_launch_orbit`, 1.6e-5 in
/// `spin_sweep`.
const EVALUATION_BESIDE_OTHERS_S: f64 = 1e-5;

/// Number of runs that may be flown again for the page of `rows` runs with this mean number of `evaluations`: a tenth,
/// and those of `PAGE_S`. Counted work makes the page a function of the result.
pub fn replays(rows: u64, evaluations: f64) -> usize {
    let each = evaluations.max(1.0) * EVALUATION_BESIDE_OTHERS_S;
    (0.1 * rows as f64 + PAGE_S / each) as usize
}

/// CPU time of this thread, s.
#[cfg(unix)]
pub fn thread_seconds() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// Elapsed time, s: the standard library has no CPU time.
#[cfg(not(unix))]
pub fn thread_seconds() -> f64 {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}
