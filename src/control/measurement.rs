//! [`Measurement`]: what a sensor delivers at a tick.

use crate::scene::MAX_WHEELS;

/// Position and velocity of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMotion {
    /// Position in F_e, m.
    pub r_e: [f64; 3],
    /// Velocity relative to F_e, in F_e, m/s.
    pub v_e: [f64; 3],
}

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
    /// Of a ground radar: motion in F_e of the base point p, and of the debris's centre of mass where there is one.
    Radar {
        /// Of p.
        base: PointMotion,
        /// Of the debris.
        debris: Option<PointMotion>,
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

impl Measurement {
    /// The same of `age` seconds ago; rotations of gyros and rates of wheels are delivered at once.
    #[must_use]
    pub fn aged(mut self, new: f64) -> Self {
        match &mut self {
            Measurement::Attitude { age, .. } | Measurement::Radar { age, .. } | Measurement::Camera { age, .. } => {
                *age = new;
            }
            Measurement::Rotation { .. } | Measurement::WheelRates { .. } => {}
        }
        self
    }
}
