//! [`WheelDrive`]: motor torque within limits, and friction, on a wheel over an arc.
//!
//! Torques are constant over the arc, so that friction and limits are exact to first order in its length. The final
//! rate is predicted from the torque on the wheel alone; other rotation of the body is seen at the next arc.

use crate::control::small_matrix::inverse;
use crate::control::vector::{dot, product};
use crate::scene::{FailureInput, Scene, WheelModel};

/// A wheel's motor and bearing. Torques are about its axis and act on the wheel; the body takes the opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelDrive {
    /// Torque over the change of the rate relative to the body, kg m^2: `relative_inertia`.
    pub inertia: f64,
    pub model: WheelModel,
}

/// Torques on a wheel over an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driven {
    /// Motor and friction.
    pub torque: f64,
    pub motor: f64,
    /// Magnitude of the torque cut by limits.
    pub excess: f64,
    pub is_torque_limited: bool,
    pub is_speed_limited: bool,
}

/// J/(1 + J a.K^-1 a) of a wheel with the axial inertia J = `axial` about a = `axis` in F_s: its motor also turns the
/// body, omega' = -K^-1 a tau, so that Omega' = tau (1/J + a.K^-1 a). `inverse` is K^-1, F_s.
fn relative_inertia(axial: f64, axis: [f64; 3], inverse: [[f64; 3]; 3]) -> f64 {
    axial / (1.0 + axial * dot(axis, product(inverse, axis)))
}

impl WheelDrive {
    /// The drives of all turning wheels of `scene`.
    pub fn of(scene: &Scene) -> Vec<Self> {
        let inverse = inverse(scene.mass.inertia_rotating());
        let wheels = scene.mass.wheels.iter().zip(scene.actuators.wheels);
        wheels
            .map(|(wheel, model)| WheelDrive { inertia: relative_inertia(wheel.axial, wheel.axis, inverse), model })
            .collect()
    }

    /// The drive after `failure`, whose factor scales torque and torque limit.
    #[must_use]
    pub fn failed(self, failure: &FailureInput) -> Self {
        let (scale, model) = (failure.torque_scale.unwrap_or(1.0), self.model);
        let torque_limit = model.torque_limit;
        let model = WheelModel {
            torque_scale: scale * model.torque_scale,
            torque_bias: scale * model.torque_bias,
            // an infinite limit stays: zero times infinity is NaN
            torque_limit: if torque_limit.is_finite() { scale.abs() * torque_limit } else { torque_limit },
            coulomb_friction: failure.coulomb_friction_n_m.unwrap_or(model.coulomb_friction),
            viscous_friction: failure.viscous_friction_n_m_s.unwrap_or(model.viscous_friction),
            ..model
        };
        WheelDrive { model, ..self }
    }

    /// Torques over an arc of `length` > 0 seconds from the relative rate `rate` on, under the command `commanded`.
    ///
    /// The motor accelerates the wheel up to the speed limit; beyond it, it only brakes. Friction has its initial value
    /// but never reverses the wheel: at most it stops the wheel at the end. If the motor reverses the wheel, Coulomb
    /// friction opposes the final motion and viscous friction is zero. A wheel at rest stays so under a motor weaker
    /// than Coulomb friction.
    pub fn over(&self, commanded: f64, rate: f64, length: f64) -> Driven {
        let WheelModel { torque_limit, speed_limit, coulomb_friction, viscous_friction, .. } = self.model;
        let bias = if commanded == 0.0 { 0.0 } else { self.model.torque_bias };
        let wanted = self.model.torque_scale * commanded + bias;
        let within = wanted.clamp(-torque_limit, torque_limit);
        // the torque that changes the rate by 1 rad/s over the arc
        let per_rate = self.inertia / length;
        // largest motor torque in a direction with the rate `along`: up to the speed limit, against friction
        let friction = |along: f64| if along > 0.0 { coulomb_friction + viscous_friction * along } else { 0.0 };
        let most = |along: f64| (per_rate * (speed_limit - along) + friction(along)).max(0.0);
        let motor = within.clamp(-most(-rate), most(rate));
        // if the motor reverses the wheel, viscous friction changes sign on the way
        let to_stop = rate * per_rate + motor;
        let viscous =
            if to_stop * rate > 0.0 { (viscous_friction * rate).abs().min(to_stop.abs()).copysign(-rate) } else { 0.0 };
        let friction = viscous - (to_stop + viscous).clamp(-coulomb_friction, coulomb_friction);
        Driven {
            torque: motor + friction,
            motor,
            excess: (wanted - motor).abs(),
            is_torque_limited: within != wanted,
            is_speed_limited: motor != within,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive(model: WheelModel) -> WheelDrive {
        WheelDrive { inertia: 0.5, model }
    }

    /// Rates after each of `arcs` arcs of `length` seconds under the commands `command`.
    fn rates(
        wheel: &WheelDrive,
        start: f64,
        length: f64,
        arcs: usize,
        mut command: impl FnMut(f64) -> f64,
    ) -> Vec<f64> {
        let mut rate = start;
        let mut next = || {
            rate += wheel.over(command(rate), rate, length).torque * length / wheel.inertia;
            rate
        };
        (0..arcs).map(|_| next()).collect()
    }

    /// Law: Coulomb friction slows a wheel linearly, stops it from either side and holds it, also against a weaker
    /// motor.
    #[test]
    fn coulomb_friction_stops_a_wheel() {
        let wheel = drive(WheelModel { coulomb_friction: 0.02, ..WheelModel::IDEAL });
        for start in [3.0, -3.0, 2.9997] {
            // 3 rad/s at 0.04 rad/s^2: 75 s
            let found = rates(&wheel, start, 0.7, 200, |_| 0.0);
            assert!((found[99].abs() - (start.abs() - 0.04 * 70.0)).abs() < 1e-13);
            assert!(found[..106].iter().all(|rate| rate * start > 0.0), "{start}");
            // rounding of the stopping torque
            assert!(found[108..].iter().all(|rate| rate.abs() < 1e-15), "{:?}", &found[104..110]);
        }
        let at_rest = rates(&wheel, 0.0, 0.7, 10, |_| 0.0199);
        assert!(at_rest.iter().all(|rate| *rate == 0.0));
        let pushed = rates(&wheel, 0.0, 0.7, 10, |_| 0.03);
        assert!((pushed[9] - 0.01 / 0.5 * 7.0).abs() < 1e-15, "{pushed:?}");
        // if the motor reverses it, friction opposes the final motion
        let through = wheel.over(-2.0, 0.4, 0.7);
        assert!((through.torque + 1.98).abs() < 1e-15);
    }

    /// Law: under any command the motor and the rate stay within their limits, the excess is the missing torque, and
    /// commands within both limits are met.
    #[test]
    fn limits_hold() {
        let friction = WheelModel { coulomb_friction: 0.01, viscous_friction: 0.004, ..WheelModel::IDEAL };
        let wheel = drive(WheelModel { torque_limit: 0.3, speed_limit: 2.0, ..friction });
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let (mut rate, mut met) = (0.0, [0_u32; 4]);
        for _ in 0..20_000 {
            let (commanded, length) = (0.5 * random() + 0.1, 0.05 + 2.0 * random().abs());
            let found = wheel.over(commanded, rate, length);
            assert!(found.motor.abs() <= 0.3 && (found.excess - (commanded - found.motor).abs()).abs() < 1e-16);
            assert_eq!(found.is_torque_limited || found.is_speed_limited, found.motor != commanded);
            assert!(found.motor * commanded >= 0.0, "a limit turns no torque round");
            rate += found.torque * length / wheel.inertia;
            assert!(rate.abs() <= 2.0 * (1.0 + 1e-15), "{rate}");
            met[usize::from(found.is_torque_limited) + 2 * usize::from(found.is_speed_limited)] += 1;
        }
        assert!(met.iter().all(|count| *count > 300), "{met:?}");
        // held at the limit against friction; left to friction above it
        let at_limit = wheel.over(0.3, 2.0, 0.1);
        assert!(at_limit.torque.abs() < 1e-16 && (at_limit.motor - 0.018).abs() < 1e-16, "{at_limit:?}");
        assert_eq!(wheel.over(0.3, 3.0, 0.1).motor, 0.0);
        assert_eq!(wheel.over(-0.3, 3.0, 0.1).motor, -0.3);
    }
}
