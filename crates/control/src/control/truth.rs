//! [`Truth`]: the true state of a run at a tick, for models of sensors and actuators only.

use crate::dynamics::actuation::BodyState;
use crate::dynamics::debris::is_isotropic;
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::relative_orbit::RelativeOrbit;
use crate::loops::estimate::{DebrisState, Estimate};
use crate::loops::measurement::PointMotion;
use crate::loops::vector::{cross, dcm_from_quaternion, difference, hamilton, product, quaternion_of, scaled, sum};
use crate::scene::{MAX_WHEELS, Offsets, Scene};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    pub time: f64,
    pub body: BodyState,
    /// Position of c relative to the base point p, in F_s.
    pub r_cp_s: [f64; 3],
    pub wheel_rates: [f64; MAX_WHEELS],
    pub debris: Option<DebrisState>,
}

/// Motion of the debris over time, as a free rigid body in uniform translation or near an orbit, read at ascending
/// times.
#[derive(Clone, Debug)]
pub struct DebrisMotion {
    inertia: [[f64; 3]; 3],
    inverse: [[f64; 3]; 3],
    is_isotropic: bool,
    start: DebrisState,
    /// Motion relative to an orbit, if any.
    orbit: Option<Box<RelativeOrbit>>,
    time: f64,
    now: DebrisState,
}

/// Order of the series of the free rotation, and largest |omega| h of a step: the first neglected term, (1/4)^13/13!,
/// is far below rounding.
const ORDER: usize = 12;
const LARGEST_TURN: f64 = 0.25;
/// Most steps between two readings, a hundred thousand radians.
const MOST_STEPS: f64 = 4e5;

impl DebrisMotion {
    /// The motion of the debris of `scene`, if any.
    pub fn of(scene: &Scene) -> Option<Self> {
        let body = scene.mass.debris.as_ref()?;
        let start = DebrisState::start(&scene.initial);
        let inverse = crate::loops::vector::inverse(body.inertia);
        let is_isotropic = is_isotropic(body);
        let orbit = scene.orbit.as_ref().zip(scene.offsets.as_ref());
        let orbit = orbit.map(|(orbit, Offsets { debris, .. })| RelativeOrbit::new(&OrbitPath::new(orbit), *debris));
        let orbit = orbit.map(Box::new);
        Some(DebrisMotion { inertia: body.inertia, inverse, is_isotropic, start, orbit, time: 0.0, now: start })
    }

    /// The state at `time`, not before the last call's.
    pub fn at(&mut self, time: f64) -> DebrisState {
        let start = self.start;
        if self.is_isotropic {
            let turn = quaternion_of(scaled(time, start.omega_de_d));
            self.now.q_ed = hamilton(start.q_ed, turn);
        } else {
            while self.time < time {
                let rate = crate::loops::vector::norm(self.now.omega_de_d);
                let longest = if rate > 0.0 { LARGEST_TURN / rate } else { f64::INFINITY };
                let left = time - self.time;
                let steps = (left / longest).ceil().max(1.0);
                if steps.is_nan() || steps > MOST_STEPS {
                    // too fast to follow: everything that depends on it diverges
                    (self.now.omega_de_d, self.now.q_ed, self.time) = ([f64::NAN; 3], [f64::NAN; 4], time);
                    break;
                }
                self.step(left / steps);
                self.time = if steps > 1.0 { self.time + left / steps } else { time };
            }
        }
        if let Some(orbit) = &mut self.orbit {
            let (place, offset) = orbit.at(time);
            let place = place.displaced([offset.position, offset.velocity]);
            (self.now.r_gdo_e, self.now.v_gdo_e) = (place.position, place.velocity);
        } else {
            self.now.r_gdo_e = sum(start.r_gdo_e, scaled(time, start.v_gdo_e));
        }
        self.now
    }

    /// A step of the series of I omega' = I omega x omega and q' = q (x) omega/2.
    fn step(&mut self, h: f64) {
        let mut omega = [[0.0; 3]; ORDER + 1];
        let mut q = [[0.0; 4]; ORDER + 1];
        (omega[0], q[0]) = (self.now.omega_de_d, self.now.q_ed);
        for n in 0..ORDER {
            let (mut torque, mut slope) = ([0.0; 3], [0.0; 4]);
            for k in 0..=n {
                torque = sum(torque, cross(product(self.inertia, omega[k]), omega[n - k]));
                let [x, y, z] = omega[n - k];
                let part = hamilton(q[k], [0.0, x, y, z]);
                slope = std::array::from_fn(|i| slope[i] + part[i]);
            }
            omega[n + 1] = scaled(1.0 / (n + 1) as f64, product(self.inverse, torque));
            q[n + 1] = slope.map(|x| 0.5 * x / (n + 1) as f64);
        }
        let (mut rate, mut turned) = (omega[ORDER], q[ORDER]);
        for n in (0..ORDER).rev() {
            rate = sum(scaled(h, rate), omega[n]);
            turned = std::array::from_fn(|i| turned[i].mul_add(h, q[n][i]));
        }
        let length = turned.iter().map(|x| x * x).sum::<f64>().sqrt();
        self.now.omega_de_d = rate;
        self.now.q_ed = turned.map(|x| x / length);
    }
}

impl Truth {
    /// The state as an ideal sensor delivers it.
    pub fn state(&self) -> Estimate {
        Estimate {
            q_es: self.body.q_es,
            omega_se_s: self.body.omega_se_s,
            gyro_bias_s: [0.0; 3],
            r_co_e: self.body.r_co_e,
            v_co_e: self.body.v_co_e,
            wheel_rates: self.wheel_rates,
            debris: self.debris,
        }
    }

    /// Motion of the base point p.
    pub fn base_point(&self) -> PointMotion {
        let (body, c_es) = (&self.body, dcm_from_quaternion(self.body.q_es));
        PointMotion {
            r_e: difference(body.r_co_e, product(c_es, self.r_cp_s)),
            v_e: difference(body.v_co_e, product(c_es, cross(body.omega_se_s, self.r_cp_s))),
        }
    }
}
