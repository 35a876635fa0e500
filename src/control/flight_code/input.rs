//! [`bytes`]: what a module is given at a tick, as it stands in its memory.

use crate::control::laws::{KnownBody, LawInput};
use crate::scene::MAX_WHEELS;

/// How many numbers it is given.
pub const NUMBERS: usize = 50;

/// The numbers of a tick `elapsed` seconds after the last one of the phase (zero at the first), in a loop of the control period and the delay `times`, s.
/// Little-endian, in this order, which is that of the table in `docs/flight-code.md` and of `struct spindrift_input` in `examples/flight_code/spindrift.h`.
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
