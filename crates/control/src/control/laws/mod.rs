//! Attitude laws: from the estimated attitude to a wanted torque on the body.
//!
//! All know the nominal spacecraft only ([`KnownBody`]). The equation of motion is K omega' = H x omega + u, with K the
//! inertia J less the axial inertias of free wheels, H the angular momentum with the wheels, and u the torque on the
//! body, F_s. Relative to the target, omega_st is the rate, q the attitude, and e = q_v sign(q_0).

mod eigenaxis;
mod integral;
pub mod momentum_unloading;
mod mrp_feedback;
mod quaternion_feedback;
mod rate_damping;
pub mod rod_law;
mod slew;

use std::sync::LazyLock;

pub use crate::loops::attitude_law::{AttitudeLaw, KnownBody, LawInput, LawKind, LawSettings, PhaseLaw, wheel_momenta};

/// Built-in attitude laws.
pub static KINDS: LazyLock<[LawKind; 4]> =
    LazyLock::new(|| [rate_damping::kind(), quaternion_feedback::kind(), mrp_feedback::kind(), eigenaxis::kind()]);

#[cfg(test)]
pub(super) mod plant {
    //! A rigid body with the diagonal inertia `inertia`, for tests of laws.

    use super::{KnownBody, LawInput};
    use crate::control::estimators::delayed::Filter;
    use crate::control::estimators::rigid_body_filter::{BodyStep, RigidBodyFilter};
    use crate::loops::vector::{diagonal, product};

    #[derive(Clone)]
    pub struct Body(pub RigidBodyFilter, pub KnownBody);

    impl Body {
        pub fn new(inertia: [f64; 3], q_es: [f64; 4], omega: [f64; 3]) -> Self {
            let inertia = diagonal(inertia);
            Body(RigidBodyFilter::new(inertia, q_es, omega, [0.0; 2], 0.0), KnownBody { inertia })
        }

        /// Input of a law with F_e as target.
        pub fn input(&self) -> LawInput<'static> {
            let momentum_s = product(self.1.inertia, self.0.omega);
            LawInput { q_ts: self.0.q, omega_se_s: self.0.omega, momentum_s, ..LawInput::AT_TARGET }
        }

        /// Moves by `interval` seconds under a constant torque.
        pub fn step(&mut self, torque: [f64; 3], interval: f64) {
            self.0.propagate(&BodyStep { torque, momentum: [0.0; 3], interval });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::plant::Body;
    use super::*;
    use crate::loops::vector::{
        conjugate, dcm_from_quaternion, difference, hamilton, norm, product, quaternion_of, scaled, sum,
        transposed_product, vector_of,
    };
    use crate::sampling::SampleId;
    use crate::scene::{DeclaredTable, Name, Scene, SceneInput};

    /// The law of `kind` with the numbers that `number` gives to its keys, by default theirs.
    fn law_of(kind: &LawKind, period: f64, number: impl Fn(&str) -> Option<f64>) -> AttitudeLaw {
        let mut table = DeclaredTable::of(Name::NONE, kind.parameters);
        for (value, parameter) in table.values.iter_mut().zip(kind.parameters) {
            let default = parameter.default.map(|default| default[0]);
            *value = number(parameter.facts.key).or(default).expect(parameter.facts.key);
        }
        kind.make(&LawSettings { table: &table, gyroscopic: false, period, delay: 0.0, sample: SampleId(0) })
    }

    /// Law: laws track a target that accelerates, to first order in the period; without its rate and acceleration they
    /// lag.
    #[test]
    fn a_target_that_turns_is_followed() {
        let follow = |mut law: AttitudeLaw, period: f64, is_told: bool| {
            let mut body = Body::new([30.0, 45.0, 20.0], [1.0, 0.0, 0.0, 0.0], [0.0; 3]);
            let axis = [0.48, -0.6, 0.64];
            for tick in 0..(60.0 / period).round() as usize {
                // about an axis fixed in F_e by 0.1 t + 0.0005 t^2
                let time = tick as f64 * period;
                let q_et = quaternion_of(scaled(0.1 * time + 0.0005 * time * time, axis));
                let c_es = dcm_from_quaternion(body.0.q);
                let [rate, acceleration] = [0.1 + 0.001 * time, 0.001].map(|size| if is_told { size } else { 0.0 });
                let input = LawInput {
                    q_ts: hamilton(conjugate(q_et), body.0.q),
                    omega_te_s: transposed_product(c_es, scaled(rate, axis)),
                    acceleration_te_s: transposed_product(c_es, scaled(acceleration, axis)),
                    ..body.input()
                };
                body.step(law.torque(&body.1, &input, period), period);
            }
            let q_et = quaternion_of(scaled(0.1 * 60.0 + 0.0005 * 3600.0, axis));
            norm(vector_of(hamilton(conjugate(q_et), body.0.q)))
        };
        for kind in KINDS.iter().filter(|kind| kind.name != "rate_damping") {
            let law = law_of(kind, 0.1, |key| match key {
                "bandwidth_rad_s" => Some(0.4),
                "damping" => Some(0.9),
                "stiffness_n_m" => Some(20.0),
                "damping_n_m_s" => Some(25.0),
                _ => None,
            });
            let (coarse, fine) = (follow(law.clone(), 0.1, true), follow(law.clone(), 0.05, true));
            assert!(fine < 1e-4 && (coarse / fine - 2.0).abs() < 0.1, "{coarse} {fine}");
            assert!(follow(law, 0.1, false) > 0.1);
        }
    }

    /// Law: a constant torque leaves an error (for rate damping, a rate) without an integral and none with it; a limit
    /// below the balancing integral leaves a part.
    #[test]
    fn the_integral_of_every_law_removes_the_offset() {
        for kind in &*KINDS {
            let left = |gain: f64, limit: f64| {
                let mut law = law_of(kind, 0.2, |key| match key {
                    _ if key.starts_with("integral_limit") => Some(limit),
                    _ if key.starts_with("integral_1") => Some(gain),
                    "bandwidth_rad_s" => Some(0.2),
                    "damping" => Some(0.9),
                    "gain_n_m_s" | "stiffness_n_m" | "damping_n_m_s" => Some(5.0),
                    _ => None,
                });
                let mut body = Body::new([30.0, 45.0, 20.0], [1.0, 0.0, 0.0, 0.0], [0.0; 3]);
                for tick in 0..6000 {
                    let torque = law.torque(&body.1, &body.input(), if tick == 0 { 0.0 } else { 0.2 });
                    body.step(sum(torque, [0.02, -0.01, 0.015]), 0.2);
                }
                if kind.name == "rate_damping" { norm(body.0.omega) } else { norm(vector_of(body.0.q)) }
            };
            let (without, with) = (left(0.0, 0.0), left(0.03, 0.0));
            assert!(without > 1e-3 && with < 1e-6 * without, "{}: {without:e} and {with:e}", kind.name);
            // part of the balancing integral: for MRP P Ki times the limit, else of the error itself
            let limited = left(0.03, if kind.name == "mrp_feedback" { 0.05 } else { 1e-3 });
            assert!(limited > 0.1 * without && limited < 0.97 * without, "{}: {limited:e} of {without:e}", kind.name);
        }
    }

    /// Law: H is that of the whole spacecraft, J omega + sum J_i Omega_i a_i, for free, held and locked wheels.
    #[test]
    fn momentum_is_that_of_the_whole_spacecraft() {
        let omega = [0.3, -0.2, 0.5];
        for modes in 0..9 {
            let mut input = SceneInput::report();
            let mode = |k: usize| {
                [crate::scene::WheelMode::Free, crate::scene::WheelMode::SpeedHeld, crate::scene::WheelMode::Locked][k]
            };
            for (wheel, k) in input.wheels.iter_mut().zip([modes % 3, modes / 3]) {
                (wheel.mode, wheel.axis) = (mode(k), [0.48, -0.6, 0.64]);
            }
            let mass = Scene::resolve(&input).expect("a physical scene").mass;
            let rates = [70.0, -40.0];
            let found = KnownBody::of(&mass).momentum(&mass, omega, &rates[..mass.wheels.len()]);
            let mut expected = product(mass.inertia, omega);
            for (wheel, rate) in mass.wheels.iter().zip(rates) {
                expected = sum(expected, scaled(wheel.axial * rate, wheel.axis));
            }
            assert!(norm(difference(found, expected)) < 1e-15 * norm(expected), "{modes}: {found:?} {expected:?}");
        }
    }
}
