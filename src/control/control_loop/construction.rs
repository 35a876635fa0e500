//! Construction of a run's loop from its specification and drawn numbers.

use std::sync::Arc;

use super::growth::Growth;
use super::mission::Mission;
use super::{Clock, ControlLoop};
use crate::control::actuators::wheel_drive::relative_inertia;
use crate::control::actuators::{ThrusterDrive, WheelDrive, modulation};
use crate::control::context::LawContext;
use crate::control::declared::limit;
use crate::control::estimators::{EstimatorContext, KINDS as ESTIMATORS, KnownSensor};
use crate::control::flight_software::{FlightSoftware, Parts};
use crate::control::guidance::phase::Phase;
use crate::control::guidance::target::Target;
use crate::control::laws::interface::{LawSettings, NoTorque};
use crate::control::laws::rod_law::RodLaw;
use crate::control::laws::{AttitudeLaw, MomentumUnloading};
use crate::control::net_launch::geometry::LaunchState;
use crate::control::net_launch::launch::PlumeCone;
use crate::control::net_launch::parameters::{DebrisNumbers, TransferNumbers};
use crate::control::outcome::columns::OutcomeColumns;
use crate::control::outcome::criteria::MissionCriteria;
use crate::control::parameters::{
    AttitudeNumbers, ConditionNumbers, LoopNumbers, PhaseNumbers, ThrusterNumbers, UnloadingNumbers,
};
use crate::control::plant::Plant;
use crate::control::recorder::Recorder;
use crate::control::sensor_spec::SensorSpec;
use crate::control::sensors::failing::FailingSensor;
use crate::control::sensors::{KINDS as SENSORS, SampledSensor, Sensor, SensorContext};
use crate::control::small_matrix::inverse;
use crate::control::spec::{LoopSpec, PhaseSpec};
use crate::scene::{DeclaredTable, Device, Scene};

fn wheel_drives(scene: &Scene) -> Vec<WheelDrive> {
    let inverse = inverse(scene.mass.inertia_rotating());
    let wheels = scene.mass.wheels.iter().zip(&scene.actuators.wheels);
    let drives = wheels.map(|(wheel, model)| WheelDrive {
        inertia: relative_inertia(wheel.axial, wheel.axis, inverse),
        torque_limit: model.torque_limit,
        speed_limit: model.speed_limit,
        coulomb: model.coulomb_friction,
        viscous: model.viscous_friction,
        torque_scale: model.torque_scale,
        torque_bias: model.torque_bias,
    });
    drives.collect()
}

fn phases(spec: &LoopSpec, tables: &[DeclaredTable]) -> Vec<Phase> {
    let phase = |(phase, table): (&PhaseSpec, &DeclaredTable)| Phase {
        until: phase.until.clone(),
        next: phase.next,
        otherwise: phase.otherwise,
        hold: ConditionNumbers::of(table).hold,
        timeout: limit(PhaseNumbers::of(table).timeout),
        target: match phase.target {
            Target::Attitude(_) => Target::Attitude(AttitudeNumbers::of(table).attitude),
            Target::Orbital(_) => Target::Orbital(AttitudeNumbers::of(table).attitude),
            target => target,
        },
        thrust: phase.thrust,
        transfer_time: TransferNumbers::of(table).time,
        rods: RodLaw::new(phase.rods, table),
        unloading: {
            let UnloadingNumbers { time, dead_band } = UnloadingNumbers::of(table);
            (time > 0.0).then_some(MomentumUnloading { dead_band, time_constant: time })
        },
    };
    spec.phases.iter().zip(tables).map(phase).collect()
}

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

/// Flight software of a run, from nominal numbers and the loop's own drawn ones.
fn flight_software(spec: &Arc<LoopSpec>, context: &LawContext<'_>, tick_period: f64) -> FlightSoftware {
    let numbers = &context.parameters.law;
    let believed = spec.believed(context.nominal);
    let tables = spec.sensors.iter().zip(&context.nominal_parameters.sensors);
    let known = |(sensor, parameters): (&SensorSpec, _)| KnownSensor {
        observes: sensor.observes(),
        period: sensor.period,
        latency: sensor.latency,
        parameters,
    };
    let sensors: Vec<KnownSensor<'_>> = tables.map(known).collect();
    let of_run = EstimatorContext {
        nominal: &believed,
        parameters: &context.nominal_parameters.law,
        sensors: &sensors,
        tick: tick_period,
    };
    let delay = LoopNumbers::of(numbers).delay;
    let law = |(phase, table): (&PhaseSpec, &DeclaredTable)| {
        let settings =
            LawSettings { table, gyroscopic: phase.gyroscopic, period: spec.period, delay, sample: context.sample };
        phase.law.map_or_else(|| AttitudeLaw::new(NoTorque), |law| (law.make)(&settings))
    };
    let laws = spec.phases.iter().zip(&context.parameters.guidance).map(law);
    let parts = Parts {
        estimator: (ESTIMATORS[spec.estimator].make)(&of_run),
        start: of_run.start(),
        is_recorded: context.records,
        phases: phases(spec, &context.parameters.guidance).into_iter().zip(laws).collect(),
        launch: LaunchState::of(numbers, believed.orbit.as_ref()),
        thruster_drives: believed.actuators.thrusters.map(|model| ThrusterDrive {
            mode: modulation::mode(spec.modulation, numbers),
            most: model.max_thrust,
            least_on: model.min_on_time,
        }),
        lost_target_timeout: limit(DebrisNumbers::of(numbers).lost_target_timeout),
        delay,
        believed: believed.clone(),
    };
    FlightSoftware::new(spec, parts)
}

fn mission(spec: &Arc<LoopSpec>, context: &LawContext<'_>) -> Mission {
    let numbers = &context.parameters.law;
    let (of_loop, near_debris) = (LoopNumbers::of(numbers), DebrisNumbers::of(numbers));
    let criteria = MissionCriteria {
        launch: LaunchState::of(numbers, context.drawn.orbit.as_ref()),
        keep_out: near_debris.keep_out,
        plume: PlumeCone { range: near_debris.plume_range, half_angle: near_debris.plume_half_angle },
        settling_band: of_loop.settling_band,
        stability: [of_loop.stability_from, of_loop.stability_window],
        period: spec.period,
        isp: ThrusterNumbers::of(numbers).isp,
    };
    let recorder = context.records.then(|| Recorder::new(spec));
    let record = context.record.cloned().inspect(|record| record.lock().restart());
    Mission::new(spec, criteria, limit(of_loop.saturation_timeout), (recorder, record))
}

impl ControlLoop {
    pub fn new(spec: &Arc<LoopSpec>, columns: &Arc<OutcomeColumns>, context: &LawContext<'_>) -> Self {
        let ticks_per_period = spec.ticks_per_period();
        let tick_period = spec.period / ticks_per_period as f64;
        let parts = (sensors(spec, context, tick_period), wheel_drives(context.drawn));
        ControlLoop {
            plant: Plant::new(spec, context.drawn.clone(), parts, [context.duration, context.end]),
            flight_software: flight_software(spec, context, tick_period),
            mission: mission(spec, context),
            clock: Clock { tick: 0, ticks_per_period, tick_period, next: 0.0, period: spec.period, end: context.end },
            columns: columns.clone(),
            has_ended: false,
            growth: Growth::new(context.drawn, spec.period),
            divergence: None,
        }
    }
}
