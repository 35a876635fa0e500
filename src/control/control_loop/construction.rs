//! The loop of a run from its specification and the numbers that the run has drawn.

use std::sync::Arc;

use super::ControlLoop;
use super::effectors::NO_PULSES;
use crate::control::actuators::wheel_drive::relative_inertia;
use crate::control::actuators::{DelayQueue, PulseState, ThrusterDrive, WheelDrive, modulation};
use crate::control::allocation::thrust::ThrustAllocation;
use crate::control::allocation::wheel_torque::WheelTorque;
use crate::control::context::LawContext;
use crate::control::estimators::{EstimatorContext, KINDS as ESTIMATORS, KnownSensor};
use crate::control::guidance::Guidance;
use crate::control::guidance::geometry::LaunchState;
use crate::control::guidance::phase::Phase;
use crate::control::guidance::target::Target;
use crate::control::laws::{AttitudeLaw, KnownBody, LawSettings, MomentumUnloading};
use crate::control::loop_record::NOTHING_KNOWN;
use crate::control::outcome::columns::OutcomeColumns;
use crate::control::outcome::{Judgement, MissionOutcome};
use crate::control::recorder::Recorder;
use crate::control::sensors::{Instrument, KINDS as SENSORS, SensorContext};
use crate::control::small_matrix::inverse;
use crate::control::spec::{LoopSpec, PhaseSpec, SensorSpec, ticks_per_period};
use crate::control::truth::DebrisMotion;
use crate::control::vector::{norm, scaled};
use crate::scene::{DeclaredTable, MAX_THRUSTERS, MAX_WHEELS, Scene};

/// The number called `key` of `table`; `otherwise` where it has none.
fn number_or(table: &DeclaredTable, key: &str, otherwise: f64) -> f64 {
    table.named(key).map_or(otherwise, |numbers| numbers[0])
}

/// The same, where zero stands for no limit.
fn limit(table: &DeclaredTable, key: &str) -> f64 {
    let number = number_or(table, key, 0.0);
    if number > 0.0 { number } else { f64::INFINITY }
}

/// The motors and bearings of the wheels of `scene`.
fn wheel_drives(scene: &Scene) -> [WheelDrive; MAX_WHEELS] {
    let inverse = inverse(scene.mass.inertia_rotating());
    std::array::from_fn(|i| {
        let Some(wheel) = scene.mass.wheels.get(i) else { return WheelDrive::ideal(1.0) };
        let model = &scene.actuators.wheels[i];
        WheelDrive {
            inertia: relative_inertia(wheel.axial, wheel.axis, inverse),
            torque_limit: model.torque_limit,
            speed_limit: model.speed_limit,
            coulomb: model.coulomb_friction,
            viscous: model.viscous_friction,
            torque_scale: model.torque_scale,
            torque_bias: model.torque_bias,
        }
    })
}

/// The launch state of the numbers of `[control]`.
fn launch_state(table: &DeclaredTable) -> LaunchState {
    let axis = match table.named("approach_axis") {
        Some(&[x, y, z]) => [x, y, z],
        _ => [0.0; 3],
    };
    let length = norm(axis);
    LaunchState {
        distance: number_or(table, "launch_distance_m", 0.0),
        least_speed: number_or(table, "least_debris_speed_m_s", 0.0),
        approach_axis: if length > 0.0 { scaled(1.0 / length, axis) } else { axis },
    }
}

/// The phases of `spec` with the numbers of `tables`.
fn phases(spec: &LoopSpec, tables: &[DeclaredTable]) -> Vec<Phase> {
    let phase = |(phase, table): (&PhaseSpec, &DeclaredTable)| Phase {
        until: phase.until.clone(),
        next: phase.next,
        otherwise: phase.otherwise,
        hold: number_or(table, "hold_s", 0.0),
        timeout: limit(table, "timeout_s"),
        target: match (phase.target, table.named("attitude")) {
            (Target::Attitude(_), Some(&[w, x, y, z])) => Target::Attitude([w, x, y, z]),
            (target, _) => target,
        },
        thrust: phase.thrust,
        transfer_time: number_or(table, "transfer_time_s", 0.0),
        unloading: Some(MomentumUnloading {
            dead_band: number_or(table, "unloading_dead_band_n_m_s", 0.0),
            time_constant: number_or(table, "unloading_time_s", 0.0),
        })
        .filter(|unloading| unloading.time_constant > 0.0),
    };
    spec.phases.iter().zip(tables).map(phase).collect()
}

impl ControlLoop {
    /// The loop of the run of `context`, which reports `columns`.
    pub fn new(spec: &Arc<LoopSpec>, columns: &Arc<OutcomeColumns>, context: &LawContext<'_>) -> Self {
        let (drawn, numbers) = (context.drawn.clone(), &context.parameters.law);
        let believed = spec.believed(context.nominal);
        let ticks_per_period =
            ticks_per_period(spec.period, spec.sensors.iter().map(|sensor| sensor.period)).unwrap_or(1);
        let tick_period = spec.period / ticks_per_period as f64;
        let instrument = |(sensor, parameters): (&SensorSpec, &DeclaredTable)| {
            let of_run = SensorContext {
                parameters,
                drawn: &drawn,
                period: sensor.period,
                sample: context.sample,
                seed: context.seed,
            };
            let ticks = |time: f64| (time / tick_period).round() as u64;
            let made = (SENSORS[sensor.kind].make)(&of_run);
            Instrument::new(made, ticks(sensor.period).max(1), ticks(sensor.latency), tick_period)
        };
        let instruments = spec.sensors.iter().zip(&context.parameters.sensors).map(instrument).collect();
        let tables = spec.sensors.iter().zip(&context.nominal_parameters.sensors);
        let known = |(sensor, parameters): (&SensorSpec, _)| KnownSensor {
            kind: SENSORS[sensor.kind].name,
            period: sensor.period,
            latency: sensor.latency,
            parameters,
        };
        let sensors: Vec<KnownSensor<'_>> = tables.map(known).collect();
        let estimator = (ESTIMATORS[spec.estimator].make)(&EstimatorContext {
            nominal: &believed,
            parameters: &context.nominal_parameters.law,
            sensors: &sensors,
            tick: tick_period,
        });
        let phases = phases(spec, &context.parameters.guidance);
        let delay = number_or(numbers, "delay_s", 0.0);
        let law = |(phase, table): (&PhaseSpec, &DeclaredTable)| {
            let settings = LawSettings { table, gyroscopic: phase.gyroscopic, period: spec.period, delay };
            phase.law.map_or(AttitudeLaw::None, |law| (law.make)(&settings))
        };
        let laws: Vec<AttitudeLaw> = spec.phases.iter().zip(&context.parameters.guidance).map(law).collect();
        let launch = launch_state(numbers);
        let wheels = (!spec.wheels.is_empty()).then(|| WheelTorque::of_loop(&believed, &spec.wheels));
        let by_wheels = wheels.map_or([[0.0; 3]; 3], |wheels| wheels.reachable);
        let thrusters =
            (!spec.thrusters.is_empty()).then(|| ThrustAllocation::of_loop(&believed, &spec.thrusters, by_wheels));
        ControlLoop {
            debris: DebrisMotion::of(&drawn),
            instruments,
            wheel_drives: wheel_drives(&drawn),
            known: KnownBody::of(&believed.mass),
            estimator,
            guidance: Guidance::new(&phases),
            law: laws[0].clone(),
            laws,
            phases,
            wheels,
            two_sided: thrusters.as_ref().map_or([[0.0; 3]; 3], |all| all.two_sided_torques(spec.holds_force)),
            thrusters,
            thruster_drives: believed.actuators.thrusters.map(|model| ThrusterDrive {
                mode: modulation::mode(spec.modulation, numbers),
                most: model.max_thrust,
                least_on: model.min_on_time,
            }),
            pulses: [PulseState::default(); MAX_THRUSTERS],
            is_on_off: modulation::is_on_off(spec.modulation),
            timeouts: [limit(numbers, "saturation_timeout_s"), limit(numbers, "lost_target_timeout_s")],
            delay,
            duration: context.duration,
            tick: 0,
            ticks_per_period,
            tick_period,
            next_tick: 0.0,
            measurements: Vec::with_capacity(spec.sensors.len()),
            motor_commands: DelayQueue::new([0.0; MAX_WHEELS], delay, spec.period),
            thrust_commands: DelayQueue::new(NO_PULSES, delay, spec.period),
            latest: ([0.0; MAX_WHEELS], [0.0; MAX_THRUSTERS]),
            commanded: [[0.0; 3]; 2],
            commanded_motors: [0.0; MAX_WHEELS],
            debris_seen: 0.0,
            has_camera: spec.has_camera(),
            saturated_since: f64::NAN,
            last_update: 0.0,
            judgement: Judgement {
                launch,
                keep_out: number_or(numbers, "keep_out_m", 0.0),
                plume: [number_or(numbers, "plume_range_m", 0.0), number_or(numbers, "plume_half_angle_rad", 0.0)],
                settling_band: number_or(numbers, "settling_band_rad", 0.0),
                stability: ["stability_from_s", "stability_window_s"].map(|key| number_or(numbers, key, 0.0)),
                period: spec.period,
                isp: number_or(numbers, "isp_s", 0.0),
            },
            launch,
            outcome: MissionOutcome::new(),
            recorder: context.records.then(|| Recorder::new(spec)),
            over_time: NOTHING_KNOWN,
            record: context.record.cloned().inspect(|record| record.lock().restart()),
            has_ended: false,
            believed,
            drawn,
            spec: spec.clone(),
            columns: columns.clone(),
        }
    }
}
