//! [`EndFinder`]: finds the event that ends a run, one run at a time.

use std::slice::from_ref;

use crate::campaign::Plan;
use crate::ensemble::event_finder::EventFinder;
use crate::ensemble::flights::{Flights, LawDraw, nominal_attitude, observe};
use crate::ensemble::run_end::RunEnd;
use crate::ensemble::settings::{EngineMaker, propagator};
use crate::math::Isa;
use crate::observables::Observer;
use crate::scene::Scene;

/// Finds the ends of runs of one plan as its campaign does, at its observation points.
pub struct EndFinder<'p> {
    plan: &'p Plan,
    isa: Isa,
    flights: Flights<'p>,
    observer: Observer,
    events: EventFinder<'p>,
    ignored: Vec<f64>,
}

impl<'p> EndFinder<'p> {
    /// Of runs of `plan`; `None` where no event ends them.
    pub fn new(plan: &'p Plan, (isa, own_engines): (Isa, Option<EngineMaker>)) -> Option<Self> {
        if !plan.events.iter().any(|event| event.ends_run) {
            return None;
        }
        let (request, grid) = (plan.request(), &plan.grid);
        let settings = propagator(plan, grid.clone(), request.fields());
        Some(EndFinder {
            plan,
            isa,
            flights: Flights::new(plan, &settings, (isa, own_engines)),
            observer: Observer::new(request, grid).with_nominal(nominal_attitude(plan, &request, grid, isa)),
            events: EventFinder::new(plan, grid, (isa, own_engines))?,
            ignored: vec![f64::NAN; request.columns().len()],
        })
    }

    /// What ends the run of `scene` under the law of `draw`; `None` where it goes on to the end.
    pub fn end(&mut self, scene: &Scene, draw: &[LawDraw]) -> Option<RunEnd> {
        let EndFinder { plan, isa, flights, observer, events, ignored } = self;
        events.restart(1);
        let mut is_ended = false;
        flights.fly(from_ref(scene), draw, &mut |run, of_law| {
            let status = observe(plan, observer, *isa, scene, (&run, of_law), ignored);
            is_ended = events.look(&run, observer, status);
        });
        if !is_ended {
            return None;
        }
        events.locate(from_ref(scene), draw);
        events.end(0)
    }
}
