//! [`Auditor`]: the true error of a run against the reference solution of its scene.
//!
//! The reference is the Taylor solution in double-double ([`crate::propagation::taylor::reference_solution`]), without
//! the audited run's method and periodic folding. Long runs use the Taylor method at 1e-16 in plain doubles, as noted
//! in the row ([`AuditValue::Tolerance`]). The audited run is repeated with the states of the comparison; the
//! campaign's row stays unchanged. Under a control law the reference is the same loop at a tighter tolerance and in
//! shorter arcs ([`crate::ensemble::pilots`]).
//!
//! Bodies that turn too fast for a reference solution in reasonable time are not audited ([`NoAudit`]); the limit
//! counts the motion's units of time, not seconds.
//!
//! The stream `audit` selects samples, independently of threads, parts and other draws.

use crate::campaign::Plan;
use crate::dynamics::debris;
use crate::dynamics::effects::ForceModel;
use crate::dynamics::gyrostat::Gyrostat;
use crate::ensemble::event_finder::RunEnd;
use crate::ensemble::flights::{Runs, nominal_attitude};
use crate::ensemble::loop_errors::LoopErrors;
use crate::ensemble::pilots::{TRUTH, Wanted, compared, outcomes};
use crate::ensemble::settings::propagator;
use crate::math::Isa;
use crate::observables::headlines::{DEBRIS_STATE_ERROR_ESTIMATE, STATE_ERROR_ESTIMATE};
use crate::observables::nominal_attitude::NominalAttitude;
use crate::observables::{Group, Observer, Request};
use crate::ode::{Control, Tolerance};
use crate::propagation::settings::observes_debris_rotation;
use crate::propagation::taylor::reference_solution::{self, ReferenceSolution};
use crate::propagation::{
    CompletedRun, Engine, Method, PropagationSettings, RotationError, debris_rotation_errors, rotation_errors,
};
use crate::run::{Grid, LocalErrors, Outcome, Quantity, StateFields, StateTable, Status, StepStatistics};
use crate::sampling::{SampleId, Stream};
use crate::scene::Scene;
use thiserror::Error;

/// Runs of more units of time ([`Gyrostat::time_unit`]) are audited in plain doubles: double-double takes five steps of
/// 40 us per unit, so an audit takes at most a second.
const MOST_UNITS: f64 = 4096.0;

/// Debris is not audited beyond this, four seconds: an audit would take hours where the campaign has a closed form or a
/// cheap method.
const MOST_UNITS_OF_DEBRIS: f64 = 16_384.0;

/// The smallest tolerance of campaigns.
const PLAIN_TOLERANCE: f64 = 1e-16;

/// Declares the columns of audits: a variant, name, unit, meaning.
macro_rules! audit_values {
    ($($Value:ident $name:literal $unit:literal $meaning:literal)*) => {
        /// A column of audits; null in other rows.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum AuditValue { $( #[doc = $meaning] $Value, )* }

        static COLUMNS: &[Quantity] = &[$(Quantity::new($name, $unit, $meaning)),*];

        impl AuditValue {
            /// In the order of the columns.
            pub const ALL: &[AuditValue] = &[$(AuditValue::$Value),*];
        }
    };
}

audit_values! {
    State "audit_state_error" "" "True largest error of the body's rotation on the grid, which state_error_estimate \
        estimates: the larger of the next two."
    Omega "audit_omega_error" "" "True largest error of omega on the grid, relative to the largest |omega|, or to one \
        radian over the duration where that is more."
    Attitude "audit_attitude_error_rad" "rad" "True largest error of the attitude on the grid, twice the distance of \
        the quaternions: the angle where the norm is kept."
    Debris "audit_debris_error" "" "True largest error of the debris's rotation on the grid: of its omega relative to \
        the largest |omega| (or to one radian over the duration where that is more), or of its attitude in rad, \
        whichever is larger."
    Tolerance "audit_truth_tolerance" "" "Tolerance of the reference solution that the run was compared with: 1e-31 in \
        double-double, 1e-17 there with drag or sunlight, 1e-16 in plain doubles where the run was too long for \
        double-double. Under a control law: of the loop that was flown again, in thirds of its arcs."
    Estimate "audit_state_error_estimate" "" "What the run estimates audit_state_error to be: state_error_estimate, \
        whether it is observed or not."
    DebrisEstimate "audit_debris_state_error_estimate" "" "What the run estimates audit_debris_error to be: \
        debris_state_error_estimate, whether it is observed or not."
}

impl AuditValue {
    /// The values for scenes with or without debris, in the order of the columns.
    pub fn of_scenes(has_debris: bool) -> impl Iterator<Item = AuditValue> + Clone {
        Self::ALL.iter().copied().filter(move |value| has_debris || !value.is_of_debris())
    }

    pub fn is_of_debris(self) -> bool {
        matches!(self, AuditValue::Debris | AuditValue::DebrisEstimate)
    }

    pub fn quantity(self) -> &'static Quantity {
        &COLUMNS[self as usize]
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Audit {
    /// In the order of [`AuditValue::ALL`]; NaN without debris.
    pub values: Vec<f64>,
    /// |observed - true| in the order of the request's columns; NaN without a reference, as for step statistics.
    pub observables: Vec<f64>,
}

impl Audit {
    pub fn value(&self, value: AuditValue) -> f64 {
        self.values[value as usize]
    }

    pub fn state(&self) -> f64 {
        self.value(AuditValue::State)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NoAudit {
    #[error("the run ended with {}", .0.name())]
    Run(Status),
    #[error("the reference solution ended with {}", .0.name())]
    Reference(Status),
    #[error(
        "the {body} turns for {units:e} units of time (powers of two near the inverse of its rate), more than the \
        {most} that an audit integrates in double-double"
    )]
    Limit {
        /// Debris, or a spacecraft without a Taylor series.
        body: &'static str,
        most: f64,
        units: f64,
    },
}

#[derive(Debug)]
pub struct Selection {
    stream: Stream,
    fraction: f64,
}

impl Selection {
    pub fn new(plan: &Plan) -> Self {
        Selection { stream: Stream::new(plan.seed, "audit"), fraction: plan.audit_fraction }
    }

    pub fn contains(&mut self, sample: SampleId) -> bool {
        self.fraction > 0.0 && self.stream.uniform(sample) < self.fraction
    }
}

pub struct Auditor<'p> {
    plan: &'p Plan,
    errors: LoopErrors,
    isa: Isa,
    grid: Grid,
    most_steps: u64,
    request: Request,
    engine: Box<dyn Engine>,
    observer: Observer,
    row: Vec<f64>,
    /// Without step statistics and constraints.
    reference_request: Request,
    reference_observer: Observer,
    reference_row: Vec<f64>,
    /// Indices of each observable in the two rows.
    indices: Vec<(usize, Option<usize>)>,
    estimate: usize,
    debris_estimate: Option<usize>,
    /// Of a plan with a law: the plan of its truth, and the nominal attitudes of both.
    of_loop: Option<(Plan, [Option<NominalAttitude>; 2])>,
}

impl<'p> Auditor<'p> {
    pub fn new(plan: &'p Plan, isa: Isa, grid: &Grid) -> Self {
        let campaign = plan.request();
        let groups = plan.groups.iter().copied();
        let request = Request { groups: groups.clone().chain([Group::Numerics]).collect(), ..campaign };
        let of_motion =
            groups.filter(|group| !matches!(group, Group::StepStatistics | Group::Numerics | Group::Constraints));
        let reference_request = Request { groups: of_motion.collect(), constrained: false, ..campaign };
        let indices = campaign
            .columns()
            .into_iter()
            .filter_map(|column| Some((request.position(column.id())?, reference_request.position(column.id()))))
            .collect();
        let nominal = nominal_attitude(plan, &request, grid, isa);
        let of_loop = plan.law.as_ref().map(|_| {
            let finer = TRUTH.plan(plan);
            let truth = nominal_attitude(&finer, &request, grid, isa);
            (finer, [nominal.clone(), truth])
        });
        Auditor {
            plan,
            of_loop,
            errors: LoopErrors::default(),
            isa,
            grid: grid.clone(),
            most_steps: plan.max_steps.max(reference_solution::MOST_STEPS),
            engine: propagator(plan, grid.clone(), compared(&request).union(request.fields())).engine(isa),
            observer: Observer::new(request, grid).with_nominal(nominal.clone()),
            row: vec![f64::NAN; request.columns().len()],
            reference_observer: Observer::new(reference_request, grid).with_nominal(nominal),
            reference_row: vec![f64::NAN; reference_request.columns().len()],
            indices,
            estimate: request.position(STATE_ERROR_ESTIMATE).expect("the group numerics has its column"),
            debris_estimate: request.position(DEBRIS_STATE_ERROR_ESTIMATE),
            request,
            reference_request,
        }
    }

    /// With what the loop does to errors.
    #[must_use]
    pub fn under(self, errors: LoopErrors) -> Self {
        Auditor { errors, ..self }
    }

    #[must_use]
    pub fn with_most_steps(self, most_steps: u64) -> Self {
        Auditor { most_steps, ..self }
    }

    /// # Errors
    /// A failure of the run or its reference solution, or the limit of work.
    pub fn audit(&mut self, scene: &Scene) -> Result<Audit, NoAudit> {
        self.compare(scene, scene)
    }

    /// Audits runs that ended with `statuses`, at `end` if an event ended them. Under a law the loop is flown again, at
    /// a tighter tolerance and in shorter arcs.
    pub fn audit_flown(
        &mut self,
        runs: Runs<'_>,
        end: Option<RunEnd>,
        statuses: &[Status],
    ) -> Vec<Result<Audit, NoAudit>> {
        // an engine, which an audit flies, does not find these ends
        let is_refused = |status: Status| matches!(status, Status::Surface | Status::Diverged);
        let refused = |status: &Status| if is_refused(*status) { Err(NoAudit::Run(*status)) } else { Ok(()) };
        let Some((finer, nominals)) = &self.of_loop else {
            let each = runs.scenes.iter().zip(statuses);
            return each.map(|(scene, status)| refused(status).and_then(|()| self.audit(scene))).collect();
        };
        let fly = |plan: &Plan, parts: u32, request: Request, nominal: &Option<NominalAttitude>| {
            let (grid, nominal, errors) = (&self.grid, nominal.clone(), self.errors);
            outcomes(plan, parts, self.isa, runs, &Wanted { request, grid, end, nominal, errors })
        };
        let own = fly(self.plan, 1, self.request, &nominals[0]);
        let truths = fly(finer, TRUTH.parts, self.reference_request, &nominals[1]);
        let tolerance = finer.tolerance.relative;
        let mut found = Vec::with_capacity(statuses.len());
        for ((own, truth), status) in own.into_iter().zip(truths).zip(statuses) {
            let audited = refused(status).and(match (own.status, truth.status) {
                (Status::Done, Status::Done) => Ok(()),
                (Status::Done, of_truth) => Err(NoAudit::Reference(of_truth)),
                (of_run, _) => Err(NoAudit::Run(of_run)),
            });
            found.push(audited.map(|()| {
                let rotation = own.error(&truth, self.grid.times());
                let low = StateTable::new(truth.table.fields(), truth.table.wheels(), truth.table.points());
                let reference = ReferenceSolution { high: truth.table, low };
                let debris = || RotationError::largest(debris_rotation_errors(&reference, &self.grid, &own.table));
                let debris = self.request.debris.then(debris);
                self.found(rotation, debris, tolerance, [&own.row, &truth.row])
            }));
        }
        found
    }

    /// Audits `run` against the reference solution of `scene`, which differs only in tests of a wrong kernel.
    ///
    /// # Errors
    /// As [`Auditor::audit`].
    pub fn compare(&mut self, run: &Scene, scene: &Scene) -> Result<Audit, NoAudit> {
        let fields = compared(&self.reference_request).union(self.reference_request.fields());
        let (reference, reference_tolerance) = self.reference_solution(scene, fields)?;
        let done = Outcome {
            status: Status::Done,
            time: self.grid.duration(),
            points: self.grid.points(),
            effort: StepStatistics::default(),
            local_errors: LocalErrors::default(),
            debris_errors: LocalErrors::NONE,
        };
        self.reference_observer.observe(self.isa, scene, &reference.high, &done, &mut self.reference_row);
        let (isa, observer, row) = (self.isa, &mut self.observer, &mut self.row);
        let (mut errors, has_debris) = (Err(NoAudit::Run(Status::InternalError)), self.request.debris);
        self.engine.propagate(std::slice::from_ref(run), &mut |CompletedRun { table, outcome, .. }| {
            errors = Err(NoAudit::Run(outcome.status));
            if outcome.status == Status::Done {
                observer.observe(isa, run, table, outcome, row);
                let debris =
                    has_debris.then(|| RotationError::largest(debris_rotation_errors(&reference, &self.grid, table)));
                errors = Ok((RotationError::largest(rotation_errors(&reference, &self.grid, table)), debris));
            }
        });
        let (rotation, debris) = errors?;
        Ok(self.found(rotation, debris, reference_tolerance, [&self.row, &self.reference_row]))
    }

    fn found(
        &self,
        rotation: RotationError,
        debris: Option<RotationError>,
        tolerance: f64,
        [row, reference]: [&[f64]; 2],
    ) -> Audit {
        let error = |(own, of_reference): &(usize, Option<usize>)| match of_reference {
            Some(of_reference) => (row[*own] - reference[*of_reference]).abs(),
            None => f64::NAN,
        };
        let value = |value: &AuditValue| match value {
            AuditValue::State => rotation.state(),
            AuditValue::Omega => rotation.omega,
            AuditValue::Attitude => rotation.attitude,
            AuditValue::Debris => debris.map_or(f64::NAN, |error| error.state()),
            AuditValue::Tolerance => tolerance,
            AuditValue::Estimate => row[self.estimate],
            AuditValue::DebrisEstimate => self.debris_estimate.map_or(f64::NAN, |index| row[index]),
        };
        let values = AuditValue::ALL.iter().map(value).collect();
        Audit { values, observables: self.indices.iter().map(error).collect() }
    }

    fn reference_solution(&self, scene: &Scene, fields: StateFields) -> Result<(ReferenceSolution, f64), NoAudit> {
        let (duration, model) = (self.grid.duration(), ForceModel::of(scene));
        let unit = Gyrostat::new(0.0, scene, duration).time_unit();
        if duration <= MOST_UNITS * unit {
            let mut debris = Gyrostat::blank(0.0);
            if debris::set_rotation(&mut debris, scene) && observes_debris_rotation(fields) {
                let units = duration / debris.time_unit();
                if units > MOST_UNITS_OF_DEBRIS {
                    return Err(NoAudit::Limit { body: "debris", most: MOST_UNITS_OF_DEBRIS, units });
                }
            }
            let solution = ReferenceSolution::new(self.isa, scene, &self.grid, fields, reference_solution::TOLERANCE);
            return Ok((solution.map_err(NoAudit::Reference)?, ReferenceSolution::tolerance(model)));
        }
        if !Method::Taylor.integrates(model) {
            return Err(NoAudit::Limit { body: "spacecraft", most: MOST_UNITS, units: duration / unit });
        }
        let tolerance = Tolerance { relative: PLAIN_TOLERANCE, absolute: PLAIN_TOLERANCE };
        let control = Control { tolerance, step: None, max_steps: self.most_steps };
        let mut found = Err(NoAudit::Reference(Status::InternalError));
        PropagationSettings::new(Method::Taylor, control, self.grid.clone(), fields, scene).engine(self.isa).propagate(
            std::slice::from_ref(scene),
            &mut |CompletedRun { table, outcome, .. }| {
                found = if outcome.status == Status::Done {
                    Ok(table.clone())
                } else {
                    Err(NoAudit::Reference(outcome.status))
                };
            },
        );
        let high = found?;
        let low = StateTable::new(high.fields(), high.wheels(), high.points());
        Ok((ReferenceSolution { high, low }, PLAIN_TOLERANCE))
    }
}
