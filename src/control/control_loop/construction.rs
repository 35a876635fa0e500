//! Construction of a run's loop from its specification and drawn numbers.

use std::sync::Arc;

use super::growth::Growth;
use super::mission::Mission;
use super::{Clock, ControlLoop};
use crate::control::context::LawContext;
use crate::control::flight_software::FlightSoftware;
use crate::control::outcome::columns::OutcomeColumns;
use crate::control::plant::Plant;
use crate::control::sensor_spec::SensorSpec;
use crate::control::sensors::failing::FailingSensor;
use crate::control::sensors::{KINDS as SENSORS, SampledSensor, Sensor, SensorContext};
use crate::control::spec::LoopSpec;
use crate::scene::{DeclaredTable, Device};

fn sensors(spec: &LoopSpec, context: &LawContext<'_>, tick_period: f64) -> Vec<SampledSensor> {
    let sampled = |(place, (sensor, parameters)): (usize, (&SensorSpec, &DeclaredTable))| {
        let of_run = SensorContext {
            parameters,
            drawn: context.drawn,
            period: sensor.period,
            sample: context.sample,
            seed: context.seed,
        };
        let ticks = |time: f64| (time / tick_period).round() as u64;
        let kind = &SENSORS[sensor.kind];
        let mut failures = context.drawn.failures.iter();
        let made: Box<dyn Sensor> = match failures.find(|failure| failure.device == Device::Sensor(place)) {
            Some(failure) => Box::new(FailingSensor::new(kind, &of_run, failure)),
            None => (kind.make)(&of_run),
        };
        SampledSensor::new(made, ticks(sensor.period).max(1), ticks(sensor.latency), tick_period)
    };
    spec.sensors.iter().zip(&context.parameters.sensors).enumerate().map(sampled).collect()
}

impl ControlLoop {
    pub fn new(spec: &Arc<LoopSpec>, columns: &Arc<OutcomeColumns>, context: &LawContext<'_>) -> Self {
        let ticks_per_period = spec.ticks_per_period();
        let tick_period = spec.period / ticks_per_period as f64;
        let sensors = sensors(spec, context, tick_period);
        ControlLoop {
            plant: Plant::new(spec, context.drawn.clone(), sensors, [context.duration, context.end]),
            flight_software: FlightSoftware::new(spec, context, tick_period),
            mission: Mission::new(spec, context),
            clock: Clock { tick: 0, ticks_per_period, tick_period, next: 0.0, period: spec.period, end: context.end },
            columns: columns.clone(),
            has_ended: false,
            growth: Growth::new(context.drawn, spec.period),
            divergence: None,
        }
    }
}
