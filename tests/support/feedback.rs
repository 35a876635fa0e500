//! A control law for tests, and runs under it.

use super::prelude::*;
use spindrift::dynamics::actuation::{Actuation, ActuationLaw, Arc, LawSource, ZeroOrderHold, actuation_at};

/// Control period, s.
pub const PERIOD: f64 = 0.25;

/// Torque on the body -k q_v - d omega, with the sign of the shorter way; wheels are braked, and P1 pushes while the
/// body is slow.
#[derive(Clone, Copy, Debug)]
pub struct ProportionalDerivative {
    /// N m.
    pub stiffness: f64,
    /// N m s.
    pub damping: f64,
    /// N m s.
    pub braking: f64,
}

impl ActuationLaw for ProportionalDerivative {
    fn arc(&mut self, _time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        let sign = if body.q_es[0] < 0.0 { -1.0 } else { 1.0 };
        let torque = |i: usize| -self.stiffness * sign * body.q_es[i + 1] - self.damping * body.omega_se_s[i];
        let speed = body.v_co_e.iter().map(|v| v * v).sum::<f64>().sqrt();
        // smooth in the state: a switch would tell rounding errors apart
        let thrust = 20.0 / (1.0 + speed);
        Actuation {
            motor_torque: wheels.rates.map(|rate| -self.braking * rate),
            body_torque: [torque(0), torque(1), torque(2)],
            ..Actuation::none(f64::INFINITY).with_thrust(&[thrust, 0.0, 0.5 * thrust])
        }
    }
}

pub fn law(scene: &Scene) -> ZeroOrderHold<ProportionalDerivative> {
    let inertia = scene.mass.inertia;
    let smallest = inertia[0][0].min(inertia[1][1]).min(inertia[2][2]);
    let lightest =
        scene.mass.wheels.iter().map(|wheel| wheel.axial).filter(|axial| *axial > 0.0).fold(smallest, f64::min);
    ZeroOrderHold::new(
        PERIOD,
        ProportionalDerivative { stiffness: 0.5 * smallest, damping: 0.6 * smallest, braking: 0.2 * lightest },
    )
}

#[derive(Clone, Debug)]
pub struct Flight {
    pub run: Run,
    pub arcs: Vec<Arc>,
}

fn flights(count: usize, propagate: impl FnOnce(&mut dyn FnMut(CompletedRun<'_>))) -> Vec<Flight> {
    let mut flights: Vec<Option<Flight>> = vec![None; count];
    propagate(&mut |CompletedRun { index, table, outcome, arcs }| {
        let run = Run { table: table.clone(), outcome: *outcome };
        flights[index] = Some(Flight { run, arcs: arcs.to_vec() });
    });
    flights.into_iter().map(|flight| flight.unwrap()).collect()
}

pub fn fly_under(laws: &mut dyn LawSource, isa: Isa, settings: &PropagationSettings, scenes: &[Scene]) -> Vec<Flight> {
    flights(scenes.len(), |finish| {
        settings.engine(isa).propagate_under(Laws::Feedback(laws), scenes, &mut |run| finish(run));
    })
}

pub fn fly(isa: Isa, settings: &PropagationSettings, scenes: &[Scene]) -> Vec<Flight> {
    fly_under(&mut scenes.iter().map(law).collect::<Vec<_>>(), isa, settings, scenes)
}

pub fn fly_recorded(isa: Isa, settings: &PropagationSettings, scenes: &[Scene], records: &[Vec<Arc>]) -> Vec<Flight> {
    let law_of = |schedule| move |time: f64, _: &BodyState, _: &WheelState| actuation_at(schedule, time);
    let mut laws: Vec<_> = records.iter().map(Vec::as_slice).map(law_of).collect();
    fly_under(&mut laws, isa, settings, scenes)
}

pub fn fly_schedules(isa: Isa, settings: &PropagationSettings, scenes: &[Scene]) -> Vec<Flight> {
    flights(scenes.len(), |finish| settings.engine(isa).propagate(scenes, &mut |run| finish(run)))
}
