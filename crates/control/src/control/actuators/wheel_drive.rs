//! [`WheelDrive`]: motor torque within limits, and friction, on a wheel over an arc.
//!
//! Torques are constant over the arc, so that friction and limits are exact to first order in its length. The final
//! rate is predicted from the torque on the wheel alone; other rotation of the body is seen at the next arc.

use crate::loops::vector::{dot, inverse, product};
use crate::scene::{FailureInput, Scene, WheelModel};

/// A wheel's motor and bearing. Torques are about its axis and act on the wheel; the body takes the opposite.
#[derive(Clone, Copy)]
pub struct WheelDrive {
    /// Torque over the change of the rate relative to the body, kg m^2: J/(1 + J a.K^-1 a) with the axial inertia J
    /// about a in F_s, since the motor also turns the body: omega' = -K^-1 a tau, Omega' = tau (1/J + a.K^-1 a).
    inertia: f64,
    model: WheelModel,
}

pub struct Driven {
    /// Motor and friction.
    pub torque: f64,
    /// Magnitude of the torque cut by limits.
    pub excess: f64,
    pub is_torque_limited: bool,
    pub is_speed_limited: bool,
}

impl WheelDrive {
    /// The drives of all turning wheels of `scene`.
    pub fn of(scene: &Scene) -> Vec<Self> {
        let inverse = inverse(scene.mass.inertia_rotating());
        let wheels = scene.mass.wheels.iter().zip(scene.actuators.wheels);
        let drives = wheels.map(|(wheel, model)| {
            let across = dot(wheel.axis, product(inverse, wheel.axis));
            WheelDrive { inertia: wheel.axial / (1.0 + wheel.axial * across), model }
        });
        drives.collect()
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
            excess: (wanted - motor).abs(),
            is_torque_limited: within != wanted,
            is_speed_limited: motor != within,
        }
    }
}
