//! [`Auditor`]: a run once more, exactly, and what the campaign's own run of it is off.
//!
//! The truth is the double-double Taylor solution of the scene ([`crate::propagation::taylor::reference_solution`]), which shares neither
//! method nor periodic folding with what it judges. Where the run is too long for that, it is the Taylor method at 1e-16 in plain doubles,
//! and the row says so ([`Audit::truth_tolerance`]). The audited run itself is made again with the states that a comparison
//! needs; the rows of a campaign do not know that they are audited.
//!
//! Which samples are audited is drawn from a stream of its own, `audit`, so that neither threads nor parts nor the other draws
//! have a part in it.

use crate::campaign::Plan;
use crate::dynamics::gyrostat::Gyrostat;
use crate::ensemble::worker::{propagator, request};
use crate::math::Isa;
use crate::observables::table::STATE_ERROR_ESTIMATE;
use crate::observables::{Group, Observer, Request};
use crate::ode::Control;
use crate::ode::Tolerance;
use crate::propagation::Method;
use crate::propagation::PropagationSettings;
use crate::propagation::taylor::reference_solution::{self, ReferenceSolution};
use crate::propagation::{CompletedRun, Engine};
use crate::run::LocalErrors;
use crate::run::Outcome;
use crate::run::Quantity;
use crate::run::Status;
use crate::run::StepStatistics;
use crate::run::{Grid, StateField, StateFields, StateTable};
use crate::sampling::{SampleId, Stream};
use crate::scene::Scene;

/// A run of more units of time ([`Gyrostat::time_unit`]) than this is audited in plain doubles: double-double takes some
/// five steps a unit of some 40 us each, so that an audit lasts a second at most.
const MOST_UNITS: f64 = 4096.0;

/// Tolerance of the truth in plain doubles: the last that a campaign may ask for.
const PLAIN_TOLERANCE: f64 = 1e-16;

/// A value that an audit adds to a row; null in the rows that were not audited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum AuditValue {
    /// The larger of the next two.
    State,
    /// Error of omega.
    Omega,
    /// Error of the attitude.
    Attitude,
    /// Tolerance of the reference solution.
    Tolerance,
}

static COLUMNS: [Quantity; AuditValue::ALL.len()] = [
    Quantity::new(
        "audit_state_error",
        "",
        "True largest error of the fuselage's rotation on the grid, which state_error_estimate estimates: the larger of the next two.",
    ),
    Quantity::new("audit_omega_error", "", "True largest error of omega on the grid, relative to the largest |omega|."),
    Quantity::new(
        "audit_attitude_error_rad",
        "rad",
        "True largest error of the attitude on the grid, twice the distance of the quaternions: the angle where the norm is kept.",
    ),
    Quantity::new(
        "audit_truth_tolerance",
        "",
        "Tolerance of the reference solution that the run was compared with: 1e-31 in double-double, 1e-16 in plain doubles where the run was too long for double-double.",
    ),
];

impl AuditValue {
    /// Every value, in the order of the columns.
    pub const ALL: [AuditValue; 4] =
        [AuditValue::State, AuditValue::Omega, AuditValue::Attitude, AuditValue::Tolerance];

    /// Name, unit and meaning of the column.
    pub fn quantity(self) -> &'static Quantity {
        &COLUMNS[self as usize]
    }
}

/// What an audit found of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Audit {
    /// Largest error of omega on the grid, over the largest |omega|.
    pub omega: f64,
    /// Largest error of the attitude on the grid, rad.
    pub attitude: f64,
    /// The estimate of the larger of the two: `state_error_estimate`, whether it is observed or not.
    pub estimate: f64,
    /// Tolerance of the truth.
    pub truth_tolerance: f64,
    /// |observed - true| of each observable, in the order of the request's columns; not a number where there is no truth of it.
    pub observables: Vec<f64>,
}

impl Audit {
    /// The larger of both errors.
    pub fn state(&self) -> f64 {
        self.omega.max(self.attitude)
    }

    /// The value of a column.
    pub fn value(&self, value: AuditValue) -> f64 {
        match value {
            AuditValue::State => self.state(),
            AuditValue::Omega => self.omega,
            AuditValue::Attitude => self.attitude,
            AuditValue::Tolerance => self.truth_tolerance,
        }
    }
}

/// Which samples are audited.
#[derive(Debug)]
pub struct Selection {
    stream: Stream,
    fraction: f64,
}

impl Selection {
    /// The selection of `plan`.
    pub fn new(plan: &Plan) -> Self {
        Selection { stream: Stream::new(plan.seed, "audit"), fraction: plan.audit_fraction }
    }

    /// Whether `sample` is audited.
    pub fn holds(&mut self, sample: SampleId) -> bool {
        self.fraction > 0.0 && self.stream.uniform(sample) < self.fraction
    }
}

/// Memory and code to audit runs of one plan on one grid.
pub struct Auditor {
    isa: Isa,
    grid: Grid,
    max_steps: u64,
    /// What the campaign observes, and what is compared beside.
    request: Request,
    engine: Box<dyn Engine>,
    observer: Observer,
    row: Vec<f64>,
    /// The same of the truth, which has no method and no constraints.
    true_request: Request,
    true_observer: Observer,
    true_row: Vec<f64>,
    /// For each observable of the campaign its places in the two rows.
    places: Vec<(usize, Option<usize>)>,
    estimate: usize,
}

impl Auditor {
    /// For runs of `plan` observed at the times of `grid`.
    pub fn new(plan: &Plan, isa: Isa, grid: &Grid) -> Self {
        let campaign = request(plan);
        let groups = plan.groups.iter().copied();
        let request = Request { groups: groups.clone().chain([Group::Numerics]).collect(), ..campaign };
        let of_motion =
            groups.filter(|group| !matches!(group, Group::StepStatistics | Group::Numerics | Group::Constraints));
        let true_request = Request { groups: of_motion.collect(), constrained: false, ..campaign };
        let places = campaign
            .columns()
            .into_iter()
            .filter_map(|column| Some((request.position(column.id())?, true_request.position(column.id()))))
            .collect();
        Auditor {
            isa,
            grid: grid.clone(),
            max_steps: plan.max_steps,
            engine: propagator(plan, grid.clone(), compared().union(request.fields())).engine(isa),
            observer: Observer::new(request, grid),
            row: vec![f64::NAN; request.columns().len()],
            true_observer: Observer::new(true_request, grid),
            true_row: vec![f64::NAN; true_request.columns().len()],
            places,
            estimate: request.position(STATE_ERROR_ESTIMATE).expect("the group numerics has its column"),
            request,
            true_request,
        }
    }

    /// Audits the run of `scene`; `None` where it does not arrive, or its truth does not.
    pub fn audit(&mut self, scene: &Scene) -> Option<Audit> {
        self.compare(scene, scene)
    }

    /// Audits the run of `run` against the truth of `scene`: the same scene, but where a test wants a kernel that is wrong.
    pub fn compare(&mut self, run: &Scene, scene: &Scene) -> Option<Audit> {
        let blocks = compared().union(self.true_request.fields());
        let (truth, truth_tolerance) = self.truth(scene, blocks)?;
        let arrived = Outcome {
            status: Status::Done,
            time: self.grid.duration(),
            points: self.grid.points(),
            effort: StepStatistics::default(),
            local_errors: LocalErrors::default(),
        };
        self.true_observer.observe(self.isa, scene, &truth.high, &arrived, &mut self.true_row);
        let (isa, observer, row) = (self.isa, &mut self.observer, &mut self.row);
        let mut errors = None;
        self.engine.propagate(std::slice::from_ref(run), &mut |CompletedRun { table, outcome, .. }| {
            if outcome.status == Status::Done {
                observer.observe(isa, run, table, outcome, row);
                errors = Some(rotation_errors(&truth, table));
            }
        });
        let [omega, attitude] = errors?;
        let off = |(own, of_truth): &(usize, Option<usize>)| match of_truth {
            Some(of_truth) => (self.row[*own] - self.true_row[*of_truth]).abs(),
            None => f64::NAN,
        };
        let observables = self.places.iter().map(off).collect();
        Some(Audit { omega, attitude, estimate: self.row[self.estimate], truth_tolerance, observables })
    }

    /// What the audited run's row is, with the columns of the campaign and of the group of numerics.
    pub fn request(&self) -> &Request {
        &self.request
    }

    fn truth(&self, scene: &Scene, blocks: StateFields) -> Option<(ReferenceSolution, f64)> {
        let duration = self.grid.duration();
        let unit = Gyrostat::new(0.0, scene, duration).time_unit();
        if duration <= MOST_UNITS * unit {
            let truth =
                ReferenceSolution::new(self.isa, scene, &self.grid, blocks, reference_solution::TOLERANCE).ok()?;
            return Some((truth, reference_solution::TOLERANCE));
        }
        let tolerance = Tolerance { relative: PLAIN_TOLERANCE, absolute: PLAIN_TOLERANCE };
        let control = Control { tolerance, step: None, max_steps: self.max_steps.max(reference_solution::MOST_STEPS) };
        let mut found = None;
        PropagationSettings::new(Method::Taylor, control, self.grid.clone(), blocks, scene)
            .engine(self.isa)
            .propagate(std::slice::from_ref(scene), &mut |CompletedRun { table, outcome, .. }| {
                found = (outcome.status == Status::Done).then(|| table.clone())
            });
        let high = found?;
        let low = StateTable::new(high.fields(), high.points());
        Some((ReferenceSolution { high, low }, PLAIN_TOLERANCE))
    }
}

/// What is compared whatever is observed.
fn compared() -> StateFields {
    StateFields::NONE.with(StateField::Rate).with(StateField::Attitude)
}

/// Largest error of omega over the largest |omega|, and of the attitude, rad.
fn rotation_errors(truth: &ReferenceSolution, table: &StateTable) -> [f64; 2] {
    let points = 0..table.points();
    let square = |omega: [f64; 3]| omega.iter().map(|x| x * x).sum::<f64>();
    let largest = points.clone().map(|point| square(truth.high.at(StateField::Rate, point))).fold(0.0, f64::max).sqrt();
    let largest = if largest > 0.0 { largest } else { 1.0 };
    let mut worst = [0.0_f64; 2];
    for point in points {
        let turned = |sign| 2.0 * truth.distance::<4>(table, StateField::Attitude, point, sign);
        let found = [truth.distance::<3>(table, StateField::Rate, point, 1.0) / largest, turned(1.0).min(turned(-1.0))];
        for (worst, found) in worst.iter_mut().zip(found) {
            // what is not a number is not to be passed over
            *worst = if found.is_nan() || found > *worst { found } else { *worst };
        }
    }
    worst
}
