//! [`ObservedRuns`]: runs of a plan, flown and observed into rows on one grid.

use crate::campaign::Plan;
use crate::ensemble::flights::{Flights, Runs, nominal_attitude, observe};
use crate::ensemble::settings::{Engines, propagator};
use crate::observables::nominal_attitude::NominalAttitude;
use crate::observables::{Observer, Request};
use crate::propagation::CompletedRun;
use crate::run::{Grid, StateFields, Status};

/// The plan, columns and engines of runs.
#[derive(Clone, Copy, Debug)]
pub struct Means<'p> {
    pub plan: &'p Plan,
    pub request: Request,
    pub engines: Engines,
}

impl<'p> Means<'p> {
    /// For the columns of the campaign.
    pub fn new(plan: &'p Plan, engines: Engines) -> Self {
        Means { plan, request: plan.request(), engines }
    }

    pub fn runs(self, grid: &Grid) -> ObservedRuns<'p> {
        let nominal = nominal_attitude(self.plan, &self.request, grid, self.engines.isa);
        self.runs_with(grid, self.request.fields(), nominal)
    }

    /// Runs with the states `fields`, compared with the attitude of the `nominal` run, if known.
    pub fn runs_with(self, grid: &Grid, fields: StateFields, nominal: Option<NominalAttitude>) -> ObservedRuns<'p> {
        let settings = propagator(self.plan, grid.clone(), fields);
        ObservedRuns {
            means: self,
            flights: Flights::new(self.plan, &settings, self.engines),
            observer: Observer::new(self.request, grid).with_nominal(nominal),
            row: vec![f64::NAN; self.request.columns().len()],
        }
    }
}

/// Runs of one plan on one grid. Earlier runs have no influence.
pub struct ObservedRuns<'p> {
    pub means: Means<'p>,
    pub flights: Flights<'p>,
    observer: Observer,
    row: Vec<f64>,
}

pub struct ObservedRun<'a> {
    pub run: CompletedRun<'a>,
    pub of_law: &'a [f64],
    pub status: Status,
    pub observer: &'a Observer,
    pub row: &'a [f64],
}

impl ObservedRuns<'_> {
    pub fn fly(&mut self, runs: Runs<'_>, finish: &mut dyn FnMut(ObservedRun<'_>)) {
        let ObservedRuns { means: Means { plan, engines, .. }, flights, observer, row } = self;
        flights.fly(runs, &mut |run, of_law| {
            let status = observe(plan, observer, engines.isa, &runs.scenes[run.index], (&run, of_law), row);
            finish(ObservedRun { run, of_law, status, observer, row });
        });
    }
}
