//! [`Measurement`]: what a sensor delivers at a tick.

use crate::scene::MAX_WHEELS;

/// What a sensor delivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measurement {
    /// Of a rate-integrating gyro: the rotation vector of F_s over the last `interval` seconds, rad, in F_s. It is the same in F_s before and after.
    Rotation {
        /// The rotation vector, rad.
        rotation_s: [f64; 3],
        /// The interval over which it was measured, s.
        interval: f64,
    },
    /// Of a star tracker: attitude quaternion F_s -> F_e, scalar first, `age` seconds ago.
    Attitude {
        /// The measured attitude.
        q_es: [f64; 4],
        /// How long ago, s.
        age: f64,
    },
    /// Of a ground radar: positions and velocities in F_e, m and m/s, of the base point p and of the debris's centre of mass.
    Radar {
        /// Position of p.
        r_po_e: [f64; 3],
        /// Velocity of p.
        v_po_e: [f64; 3],
        /// Position of the debris.
        r_gdo_e: [f64; 3],
        /// Velocity of the debris.
        v_gdo_e: [f64; 3],
        /// How long ago, s.
        age: f64,
    },
    /// Of a camera on the spacecraft: attitude of the debris relative to the spacecraft F_d -> F_s, scalar first, and its angular velocity relative to the
    /// spacecraft in F_d, rad/s.
    Camera {
        /// The relative attitude.
        q_sd: [f64; 4],
        /// The relative rate.
        omega_ds_d: [f64; 3],
        /// How long ago, s.
        age: f64,
    },
    /// Of the wheels' tachometers: rates relative to the body, rad/s.
    WheelRates {
        /// The rates, in the order of the wheels that turn.
        rates: [f64; MAX_WHEELS],
    },
}
