//! Input of a module at a tick, as little-endian numbers in its memory.

use super::module::WantedSensor;
use crate::control::laws::interface::{KnownBody, LawInput};
use crate::control::measurement::MAX_VALUES;
use crate::scene::MAX_WHEELS;

/// Numbers of the input.
pub const NUMBERS: usize = 50;
/// Numbers of each sensor: `struct spindrift_measurement`.
pub const MEASURED: usize = 1 + MAX_VALUES;
/// Age of the measurement of a sensor that has not delivered any.
const NONE_YET: f64 = -1.0;

/// The input of a tick `elapsed` seconds after the phase's last one (zero at the first); `times` are control period and
/// delay. The order is that of `docs/flight-code.md` and of `struct spindrift_input` in
/// `examples/flight_code/spindrift.h`.
pub fn bytes(body: &KnownBody, input: &LawInput<'_>, elapsed: f64, times: [f64; 2]) -> [u8; 8 * NUMBERS] {
    let mut bytes = [0; 8 * NUMBERS];
    let mut places = bytes.chunks_exact_mut(8);
    let mut write = |numbers: &[f64]| {
        for number in numbers {
            if let Some(place) = places.next() {
                place.copy_from_slice(&number.to_le_bytes());
            }
        }
    };
    write(&[input.time, elapsed]);
    write(&times);
    write(&input.q_ts);
    write(&input.omega_se_s);
    write(&input.omega_te_s);
    write(&input.acceleration_te_s);
    write(&input.momentum_s);
    write(body.inertia.as_flattened());
    match input.estimate {
        Some(estimate) => {
            write(&estimate.q_es);
            write(&estimate.gyro_bias_s);
            write(&estimate.r_co_e);
            write(&estimate.v_co_e);
            write(&estimate.wheel_rates);
        }
        None => {
            write(&[1.0, 0.0, 0.0, 0.0]);
            write(&[0.0; 9 + MAX_WHEELS]);
        }
    }
    bytes
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
