//! Construction of flight software from nominal numbers and the loop's own drawn ones.

use std::sync::Arc;

use super::under_way::CommandsUnderWay;
use super::{FlightSoftware, NO_IMPULSE};
use crate::control::actuators::{PulseState, modulation};
use crate::control::allocation::rods::RodAllocation;
use crate::control::allocation::{ThrustAllocation, WheelTorque};
use crate::control::bus::Commanded;
use crate::control::context::LawContext;
use crate::control::declared::limit;
use crate::control::estimators::{EstimatorContext, KnownSensor};
use crate::control::guidance::Guidance;
use crate::control::guidance::phase::Phase;
use crate::control::guidance::target::Target;
use crate::control::laws::callback::is_law_of;
use crate::control::laws::interface::NoTorque;
use crate::control::laws::rod_law::{MeasuredField, RodLaw};
use crate::control::laws::{AttitudeLaw, KnownBody, LawSettings, MomentumUnloading};
use crate::control::measurement::Reading;
use crate::control::net_launch::geometry::LaunchState;
use crate::control::net_launch::parameters::{DebrisNumbers, TransferNumbers};
use crate::control::parameters::{AttitudeNumbers, ConditionNumbers, LoopNumbers, PhaseNumbers, UnloadingNumbers};
use crate::control::sensor_spec::SensorSpec;
use crate::control::spec::{LoopSpec, PhaseSpec};
use crate::control::tick_times::TickTimes;
use crate::dynamics::orbit_path::OrbitPath;
use crate::scene::{DeclaredTable, MAX_THRUSTERS};

fn phase((phase, table): (&PhaseSpec, &DeclaredTable)) -> Phase {
    Phase {
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
    }
}

impl FlightSoftware {
    /// Flight software of the run of `context`, on a loop with ticks of `tick` seconds.
    pub fn new(spec: &Arc<LoopSpec>, context: &LawContext<'_>, tick: f64) -> Self {
        let numbers = &context.parameters.law;
        let believed = spec.believed(context.nominal);
        let known = |(sensor, parameters): (&SensorSpec, _)| KnownSensor {
            observes: sensor.observes(),
            period: sensor.period,
            latency: sensor.latency,
            parameters,
        };
        let sensors: Vec<_> = spec.sensors.iter().zip(&context.nominal_parameters.sensors).map(known).collect();
        let parameters = &context.nominal_parameters.law;
        let of_run = EstimatorContext { nominal: &believed, parameters, sensors: &sensors, tick };
        let (estimator, estimate) = ((spec.estimator_kind().make)(&of_run), of_run.start());
        let (period, delay) = (spec.period, LoopNumbers::of(numbers).delay);
        let tables = || spec.phases.iter().zip(&context.parameters.guidance);
        let law = |(phase, table): (&PhaseSpec, _)| {
            let settings = LawSettings { table, gyroscopic: phase.gyroscopic, period, delay, sample: context.sample };
            phase.law.map_or_else(|| AttitudeLaw::new(NoTorque), |law| (law.make)(&settings))
        };
        let (laws, phases): (Vec<_>, Vec<_>) = (tables().map(law).collect(), tables().map(phase).collect());
        let wheels = (!spec.wheels.is_empty()).then(|| WheelTorque::of_loop(&believed, &spec.wheels));
        let by_wheels = wheels.map_or([[0.0; 3]; 3], |wheels| wheels.reachable);
        let thrusters =
            (!spec.thrusters.is_empty()).then(|| ThrustAllocation::of_loop(&believed, &spec.thrusters, by_wheels));
        let reads_sensors = is_law_of(spec) || spec.code().is_some_and(|code| !code.sensors().is_empty());
        FlightSoftware {
            body: KnownBody::of(&believed.mass),
            estimator,
            estimate,
            guidance: Guidance::new(&phases),
            law: AttitudeLaw::clone(&laws[0]),
            laws,
            phases,
            wheels,
            two_sided: thrusters.as_ref().map_or([[0.0; 3]; 3], |all| all.two_sided_torques(spec.holds_force)),
            thrusters,
            rods: (!spec.rods.is_empty()).then(|| RodAllocation::of_loop(&believed, &spec.rods)),
            field: MeasuredField::NONE,
            readings: if reads_sensors { vec![Reading::NONE; spec.sensors.len()] } else { Vec::new() },
            thrust_mode: modulation::mode(spec.modulation, numbers),
            pulses: [PulseState::default(); MAX_THRUSTERS],
            launch: LaunchState::of(numbers, believed.orbit.as_ref()),
            orbit: believed.orbit.as_ref().map(OrbitPath::new),
            geometry: None,
            lost_target_timeout: limit(DebrisNumbers::of(numbers).lost_target_timeout),
            is_recorded: context.records,
            delay,
            under_way: CommandsUnderWay::new(delay, period, !spec.rods.is_empty()),
            latest: Commanded::NOTHING,
            commanded: NO_IMPULSE,
            debris_seen: 0.0,
            has_camera: spec.has_camera(),
            started: false,
            last_update: 0.0,
            believed,
            ticks: TickTimes::new(period, spec.ticks_per_period()),
            spec: spec.clone(),
        }
    }
}
