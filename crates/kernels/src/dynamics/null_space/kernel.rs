//! [`Kernel`]: the right-hand side x-dot = f(x) (41).

use super::forces::{self, Drive};
use super::kinematics::{WheelMotion, dcm_rate, for_each_wheel};
use super::mass_matrix::{Factor, SpacecraftMass, cholesky, solved};
use super::parameters::Parameters;
use super::state::{Pose, State, rotated};
use crate::math::prelude::*;
use crate::scene::{Actuation, Scene};

/// Right-hand side for a scene with at most `W` wheels and one arc of constant actuation.
#[derive(Clone, Copy, Debug)]
pub struct Kernel<const W: usize> {
    parameters: Parameters<W>,
    drive: Drive<W>,
    debris_factor: Factor<3>,
    /// J_d - J_d,11 1: a multiple of the unit matrix causes no torque, and a cube's rate is constant to the last bit.
    debris_deviator: [[f64; 3]; 3],
}

impl<const W: usize> Kernel<W> {
    /// The kernel of `scene`, without actuation.
    pub fn new(scene: &Scene) -> Self {
        let parameters = Parameters::of(scene);
        let mut debris_deviator = parameters.debris_inertia;
        for (i, row) in debris_deviator.iter_mut().enumerate() {
            row[i] -= parameters.debris_inertia[0][0];
        }
        Kernel {
            drive: Drive::of(&parameters, &Actuation::none(0.0)),
            debris_factor: cholesky(parameters.debris_inertia),
            debris_deviator,
            parameters,
        }
    }

    /// Starts an arc.
    pub fn drive(&mut self, actuation: &Actuation) {
        self.drive = Drive::of(&self.parameters, actuation);
    }

    /// The constants.
    pub fn parameters(&self) -> &Parameters<W> {
        &self.parameters
    }

    /// Derivative of all components. No allocation, no branch on data; 0.56 us per core with AVX2 (`cargo bench -p
    /// spindrift-benches --bench kernels`).
    #[inline(always)]
    pub fn derivative<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let state = &State::<W>::from_components(x);
        let parameters = &self.parameters;
        let mut wheels = [WheelMotion::AT_REST; W];
        for_each_wheel::<W>(
            #[inline(always)]
            |w| wheels[w] = WheelMotion::of(&parameters.wheels[w], state, w),
        );

        // f-hat_non + f-hat = Pi^T (...), spacecraft rows
        let inertial = forces::fuselage_inertial(parameters, state);
        let applied = forces::fuselage_applied(parameters, state, &self.drive);
        let mut force = sum(inertial.force, applied.force);
        let mut omega_row = sum(inertial.torque, applied.torque);
        let mut wheel_row = [0.0; W];
        for w in 0..W {
            let wheel = &parameters.wheels[w];
            let wrench = forces::wheel_wrench(wheel, &wheels[w], self.drive.motors[w]);
            let (torque, axial) = wheels[w].reduced(wrench.force, wrench.torque, wheel.axis);
            force = sum(force, wrench.force);
            omega_row = sum(omega_row, torque);
            wheel_row[w] = axial;
        }
        let mass = SpacecraftMass::of(parameters, state, &wheels);
        let mut free_row = wheel_row;
        for w in 0..W {
            free_row[w] = parameters.wheels[w].free * wheel_row[w];
        }
        let (v_dot, omega_s_dot, wheel_rates_dot) = mass.solution(force, omega_row, free_row);
        let mut motors = self.drive.motors;
        for w in 0..W {
            let wheel = &parameters.wheels[w];
            let holding = forces::holding_torque(wheel, &wheels[w], omega_s_dot, wheel_row[w]);
            motors[w] = (1.0 - wheel.free).mul_add(holding, motors[w]);
        }

        // debris rows: free
        let momentum = product(self.debris_deviator, state.omega_d);
        let omega_d_dot = solved(&self.debris_factor, scaled(-1.0, cross(state.omega_d, momentum)));

        let c_es = state.fuselage.dcm;
        let mut poses = state.wheels;
        for w in 0..W {
            poses[w] = Pose { position: wheels[w].velocity, dcm: dcm_rate(state.wheels[w].dcm, wheels[w].omega) };
        }
        State {
            fuselage: Pose { position: state.v_p, dcm: dcm_rate(c_es, state.omega_s) },
            wheels: poses,
            debris: Pose { position: state.v_gd, dcm: dcm_rate(state.debris.dcm, state.omega_d) },
            v_p: v_dot,
            omega_s: omega_s_dot,
            wheel_rates: wheel_rates_dot,
            v_gd: [0.0; 3],
            omega_d: omega_d_dot,
            work: forces::power(state, &self.drive, motors),
            impulse: rotated(c_es, self.drive.force_s),
            angular_impulse: rotated(c_es, self.drive.torque_c_s),
            wheel_angles: state.wheel_rates,
        }
        .components()
    }
}
