//! Input of a module at a tick, as little-endian numbers in its memory.

use crate::loops::attitude_law::{KnownBody, LawInput};
use crate::loops::estimate::Estimate;
use crate::loops::flight_code::WantedSensor;
use crate::loops::measurement::MAX_VALUES;
use crate::scene::MAX_WHEELS;

pub const NUMBERS: usize = 50;
/// Numbers of each sensor: `struct spindrift_measurement`.
pub const MEASURED: usize = 1 + MAX_VALUES;
/// Age of the measurement of a sensor that has not delivered any.
const NONE_YET: f64 = -1.0;

/// The input of a tick `elapsed` seconds after the phase's last one (zero at the first); `times` are control period and
/// delay. The order is that of `docs/flight-code.md` and of `struct spindrift_input` in
/// `examples/flight_code/spindrift.h`.
pub fn bytes(body: &KnownBody, input: &LawInput<'_>, elapsed: f64, times: [f64; 2]) -> Vec<u8> {
    let estimated = match input.estimate {
        Some(Estimate { q_es, gyro_bias_s, r_co_e, v_co_e, wheel_rates, .. }) => {
            [&q_es[..], gyro_bias_s, r_co_e, v_co_e, wheel_rates].concat()
        }
        None => [&[1.0, 0.0, 0.0, 0.0][..], &[0.0; 9 + MAX_WHEELS]].concat(),
    };
    let target = [&input.q_ts[..], &input.omega_se_s, &input.omega_te_s, &input.acceleration_te_s];
    let momentum = [&input.momentum_s[..], body.inertia.as_flattened(), &estimated];
    let numbers = [&[input.time, elapsed][..], &times, &target.concat(), &momentum.concat()].concat();
    numbers.into_iter().flat_map(f64::to_le_bytes).collect()
}

/// Last measurements of the sensors `wanted`: age, then values as in telemetry, 0 beyond those of the kind.
pub fn measured(wanted: &[WantedSensor], input: &LawInput<'_>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(8 * MEASURED * wanted.len());
    for wanted in wanted {
        let mut numbers = [0.0; MEASURED];
        let last = input.readings.iter().find(|(sensor, _)| sensor.name.as_str() == wanted.name);
        match last.filter(|(_, reading)| !reading.time.is_nan()) {
            Some((sensor, reading)) => {
                let width = sensor.width();
                numbers[0] = input.time - reading.time;
                numbers[1..=width].copy_from_slice(&sensor.telemetry(reading.values)[..width]);
            }
            None => numbers[0] = NONE_YET,
        }
        numbers.iter().for_each(|number| bytes.extend_from_slice(&number.to_le_bytes()));
    }
    bytes
}
