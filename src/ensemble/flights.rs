//! [`Flights`]: propagates runs of a plan, each under the control law of the plan where it has one; nothing else of the ensemble flies a run.

use crate::campaign::{Plan, event_columns};
use crate::control::loop_record::SharedRecord;
use crate::control::{LawContext, LawRuns};
use crate::dynamics::actuation::{ActuationLaw, BodyState, Laws, WheelState};
use crate::dynamics::effects::beside_arcs;
use crate::ensemble::settings::{nominal, propagator};
use crate::math::Isa;
use crate::math::vector::dot;
use crate::observables::nominal_attitude::NominalAttitude;
use crate::observables::{Group, LawSeries, Observer, Request};
use crate::propagation::{CompletedRun, Engine};
use crate::run::{Grid, StateField, StateFields, StateTable, Status, Telemetry};
use crate::sampling::SampleId;
use crate::scene::{Arc, ControlInput, Scene};

/// What the law of a run depends on beside its scene.
#[derive(Clone, Debug)]
pub struct LawDraw {
    pub sample: SampleId,
    /// The parameters of the law as drawn.
    pub parameters: ControlInput,
}

impl LawDraw {
    /// Of the nominal run of `plan`; `None` where the plan has no law.
    pub fn nominal(plan: &Plan) -> Option<Self> {
        plan.law.as_ref().map(|_| LawDraw { sample: SampleId(0), parameters: plan.nominal.control.clone() })
    }
}

/// An engine, and the laws of its runs.
pub struct Flights<'p> {
    plan: &'p Plan,
    engine: Box<dyn Engine>,
    /// The laws, and the nominal scene that they know; where the plan has a law.
    laws: Option<(LawRuns, Scene)>,
    /// What the loops of the runs record over time; empty where nothing is.
    over_time: Vec<SharedRecord>,
    times: Vec<f64>,
    end: f64,
    records: bool,
}

/// Receives a run that has ended, and what its law has recorded at the observation points ([`crate::observables::LawSeries`]).
pub type FlightCallback<'a> = dyn FnMut(CompletedRun<'_>, &[f64]) + 'a;

impl<'p> Flights<'p> {
    /// Runs of `plan` by `engine`, which is for its settings, observed on `grid`.
    pub fn new(plan: &'p Plan, engine: Box<dyn Engine>, grid: &Grid) -> Self {
        Flights {
            plan,
            engine,
            times: grid.times().to_vec(),
            end: grid.duration(),
            laws: plan.law.as_ref().map(|law| (law.runs(), nominal(plan))),
            over_time: Vec::new(),
            records: false,
        }
    }

    /// The same, with laws that record what they do.
    pub fn recording(self) -> Self {
        Flights { records: true, ..self }
    }

    /// What the law of run `run` of the last flight has recorded.
    pub fn telemetry(&self, run: usize) -> Option<Telemetry> {
        self.laws.as_ref()?.0.telemetry(run)
    }

    /// Flies `scenes` and passes each to `finish`. `draws` are those of the laws, one for each scene, and nothing where the plan has no law.
    pub fn fly(&mut self, scenes: &[Scene], draws: &[LawDraw], finish: &mut FlightCallback<'_>) {
        let Some((laws, nominal)) = &mut self.laws else {
            return self.engine.propagate(scenes, &mut |run| finish(run, &[]));
        };
        assert_eq!(scenes.len(), draws.len(), "each run has a law");
        let is_recorded = self.plan.law.as_ref().is_some_and(|law| law.columns().over_time != LawSeries::NONE);
        while is_recorded && self.over_time.len() < scenes.len() {
            self.over_time.push(SharedRecord::new(&self.times));
        }
        for (run, (drawn, LawDraw { sample, parameters })) in scenes.iter().zip(draws).enumerate() {
            let nominal_parameters = &self.plan.nominal.control;
            let (sample, seed, records) = (*sample, self.plan.seed, self.records);
            let (duration, end) = (self.plan.grid.duration(), self.end);
            laws.begin(
                run,
                &LawContext {
                    nominal,
                    drawn,
                    parameters,
                    nominal_parameters,
                    sample,
                    seed,
                    duration,
                    end,
                    record: self.over_time.get(run),
                    records,
                },
            );
        }
        let over_time = &self.over_time;
        let mut flown = laws.shared();
        self.engine.propagate_under(Laws::Feedback(laws), scenes, &mut |run| {
            // before the run is observed: what the loop knows at the end belongs to it
            if run.outcome.status == Status::Done {
                let (body, wheels) = state_at_end(&scenes[run.index], run.table);
                flown[run.index].end(run.outcome.time, &body, &wheels);
            }
            match over_time.get(run.index) {
                Some(record) => finish(run, record.lock().values()),
                None => finish(run, &[]),
            }
        });
    }

    /// Writes what the law of run `run` of the last flight reports, where the plan has a law.
    pub fn report(&self, run: usize, values: &mut [f64]) {
        if let Some((laws, _)) = &self.laws {
            laws.report(run, values);
        }
    }

    pub fn fly_nominal(&mut self, finish: &mut FlightCallback<'_>) {
        let draw = LawDraw::nominal(self.plan);
        self.fly(&[nominal(self.plan)], draw.as_slice(), finish);
    }
}

/// The motion of the body and of the wheels at the last point of `table`, of a run of `scene` under a law.
fn state_at_end(scene: &Scene, table: &StateTable) -> (BodyState, WheelState) {
    let last = table.points() - 1;
    let body = BodyState {
        omega_se_s: table.at(StateField::Rate, last),
        q_es: table.at(StateField::Attitude, last),
        r_co_e: table.at(StateField::ComPosition, last),
        v_co_e: table.at(StateField::ComVelocity, last),
    };
    let mut wheels = WheelState::AT_REST;
    for (i, wheel) in scene.mass.wheels.iter().enumerate() {
        wheels.rates[i] = table.column(StateField::WheelRates, i)[last];
        wheels.angles[i] = table.column(StateField::WheelAngles, i)[last];
        wheels.momenta[i] = wheel.axial * (wheels.rates[i] + dot(wheel.axis, body.omega_se_s));
    }
    (body, wheels)
}

/// The attitude of the nominal run at the times of `grid`, where `request` compares runs with it.
pub fn nominal_attitude(plan: &Plan, request: &Request, grid: &Grid, isa: Isa) -> Option<NominalAttitude> {
    if !request.groups.contains(Group::Motion) {
        return None;
    }
    let mut found = None;
    let attitude = StateFields::NONE.with(StateField::Attitude);
    let engine = propagator(plan, grid.clone(), attitude).engine(isa);
    Flights::new(plan, engine, grid).fly_nominal(&mut |run, _| {
        found = Some(NominalAttitude::of(run.table, run.outcome));
    });
    found
}

/// Observes a run of `plan` into `row`: what acted on it are the arcs that it has flown, where they followed a law, or its schedule; and which of its
/// devices have failed.
pub fn observe(
    plan: &Plan,
    observer: &mut Observer,
    isa: Isa,
    scene: &Scene,
    (run, of_law): (&CompletedRun<'_>, &[f64]),
    row: &mut [f64],
) -> Status {
    let status = match plan.law {
        None => observer.observe(isa, scene, run.table, run.outcome, row),
        Some(_) => observer.observe_flown(isa, (scene, run.arcs, of_law), run.table, run.outcome, row),
    };
    if !scene.failures.is_empty() {
        let request = observer.request();
        let start = row.len() - request.windows.len() - request.of_law.of_events;
        let reaches_end = matches!(status, Status::Done | Status::Inaccurate);
        let end = if reaches_end { end_of(run) } else { f64::NAN };
        for (failure, columns) in scene.failures.iter().zip(row[start..].chunks_exact_mut(event_columns::EACH)) {
            let time = if failure.at_s < end { failure.at_s } else { f64::NAN };
            let happened = if reaches_end { f64::from(u8::from(failure.at_s < end)) } else { f64::NAN };
            columns.copy_from_slice(&[time, happened]);
        }
    }
    status
}

/// When a run has ended, s: at the end of the campaign's grid, or where its law has ended it.
pub fn end_of(run: &CompletedRun<'_>) -> f64 {
    let of_law = run.arcs.last().filter(|arc| arc.applied.ends_run).map(|arc| arc.start);
    of_law.map_or(run.outcome.time, |end| end.min(run.outcome.time))
}

/// The scene whose schedule is what a run of `scene` under a law has flown, constant effects included: its open loop is that run, bit for
/// bit. Effects that change within an arc act on it as on the run.
pub fn replayed(scene: &Scene, arcs: &[Arc]) -> Scene {
    Scene {
        schedule: arcs.to_vec(),
        environment: beside_arcs(scene.environment),
        commands_thrust: true,
        commands_torque: true,
        ..scene.clone()
    }
}
