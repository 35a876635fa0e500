//! Laws of attitude: from what is known of the attitude to a wanted torque on the body.
//!
//! All of them know the nominal spacecraft only: [`KnownBody`] has its constants. The equation of motion is K omega' = H x omega + u, with K = J* where
//! free wheels are driven by motors, H the angular momentum with the wheels, and u the torque on the body, F_s.

mod eigenaxis;
mod mrp_feedback;
mod quaternion_feedback;
mod rate_damping;

pub use eigenaxis::Eigenaxis;
pub use mrp_feedback::{MrpFeedback, MrpReference};
pub use quaternion_feedback::QuaternionFeedback;
pub use rate_damping::rate_damping;

use crate::math::vector::{product, scaled, sum};
use crate::scene::MassProperties;

/// The constants of the spacecraft that a law knows: of the nominal scene.
#[derive(Clone, Copy, Debug)]
pub struct KnownBody {
    /// K = J*: the inertia without the axial ones of free wheels, in F_s, kg m^2.
    pub inertia: [[f64; 3]; 3],
}

impl KnownBody {
    /// Those of `mass`.
    pub fn of(mass: &MassProperties) -> Self {
        KnownBody { inertia: mass.inertia_rotating() }
    }

    /// H = K omega + sum h_i a_i, in F_s, N m s: of the body at the rate `omega` (rad/s), with the wheels of `mass` at the momenta `momenta` relative to
    /// F_e.
    pub fn momentum(&self, mass: &MassProperties, omega: [f64; 3], momenta: &[f64]) -> [f64; 3] {
        let of_wheels = mass.wheels.iter().zip(momenta).map(|(wheel, momentum)| scaled(*momentum, wheel.axis));
        of_wheels.fold(product(self.inertia, omega), sum)
    }
}

#[cfg(test)]
pub(super) mod plant {
    //! A rigid body in small steps: what the laws are tested on.

    use crate::control::rotation::quaternion_of;
    use crate::math::vector::{cross, hamilton, product, scaled, sum};

    /// A body with the diagonal inertia `inertia`, kg m^2.
    #[derive(Clone, Copy, Debug)]
    pub struct Body {
        pub inertia: [f64; 3],
        pub q_es: [f64; 4],
        pub omega: [f64; 3],
    }

    impl Body {
        pub fn matrix(&self) -> [[f64; 3]; 3] {
            let [a, b, c] = self.inertia;
            [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]
        }

        fn acceleration(&self, omega: [f64; 3], torque: [f64; 3]) -> [f64; 3] {
            let total = sum(cross(product(self.matrix(), omega), omega), torque);
            std::array::from_fn(|i| total[i] / self.inertia[i])
        }

        /// Moves on by `time` seconds under a constant torque, in `steps` steps (RK4 of the rate, exponentials of its mean).
        pub fn step(&mut self, torque: [f64; 3], time: f64, steps: usize) {
            let h = time / steps as f64;
            for _ in 0..steps {
                let w = self.omega;
                let k1 = self.acceleration(w, torque);
                let k2 = self.acceleration(sum(w, scaled(0.5 * h, k1)), torque);
                let k3 = self.acceleration(sum(w, scaled(0.5 * h, k2)), torque);
                let k4 = self.acceleration(sum(w, scaled(h, k3)), torque);
                let slope = std::array::from_fn(|i| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0);
                let after = sum(w, scaled(h, slope));
                // midpoint of the rate, with the error of a commutator
                let turn = sum(scaled(0.5 * h, sum(w, after)), scaled(h * h / 12.0, cross(w, after)));
                self.q_es = hamilton(self.q_es, quaternion_of(turn));
                let length = self.q_es.iter().map(|x| x * x).sum::<f64>().sqrt();
                self.q_es = self.q_es.map(|x| x / length);
                self.omega = after;
            }
        }
    }
}
