//! [`Kernel`]: the right-hand side x-dot = f(x) (41).

use super::forces::{self, Drive};
use super::kinematics::{WheelMotion, dcm_rate};
use super::mass_matrix::{Factor, SpacecraftMass, cholesky, solved};
use super::parameters::Parameters;
use super::state::{COMPONENTS, State, rotated};
use crate::math::vector::{cross, product, scaled, sum};
use crate::scene::{Actuation, Scene};

/// The right-hand side for one scene and one arc of constant actuation.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    parameters: Parameters,
    drive: Drive,
    debris_factor: Factor<3>,
    /// J_d - J_d,11 1: a multiple of the unit matrix causes no torque, and so the rate of a cube is constant to the last bit.
    debris_deviator: [[f64; 3]; 3],
}

impl Kernel {
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

    /// Starts an arc: what acts from here on.
    pub fn drive(&mut self, actuation: &Actuation) {
        self.drive = Drive::of(&self.parameters, actuation);
    }

    /// The constants.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The derivative of all components. No allocation, no branch on the data; 0.56 us on one core with AVX2
    /// (`cargo bench --bench kernels`), inside [`crate::math::Isa::run`].
    ///
    /// Tests: `block_form_equals_the_matrices_as_printed`, `agrees_with_the_gyrostat`.
    #[inline(always)]
    pub fn derivative(&self, x: &[f64; COMPONENTS]) -> [f64; COMPONENTS] {
        let state = &State::from_components(x);
        let parameters = &self.parameters;
        let wheels =
            [WheelMotion::of(&parameters.wheels[0], state, 0), WheelMotion::of(&parameters.wheels[1], state, 1)];

        // f-hat_non + f-hat = Pi^T (...), spacecraft rows
        let inertial = forces::fuselage_inertial(parameters, state);
        let applied = forces::fuselage_applied(parameters, state, &self.drive);
        let mut force = sum(inertial.force, applied.force);
        let mut omega_row = sum(inertial.torque, applied.torque);
        let mut wheel_row = [0.0; 2];
        for w in 0..2 {
            let wheel = &parameters.wheels[w];
            let wrench = forces::wheel_wrench(wheel, &wheels[w], self.drive.motors[w]);
            let (torque, axial) = wheels[w].reduced(wrench.force, wrench.torque, wheel.axis);
            force = sum(force, wrench.force);
            omega_row = sum(omega_row, torque);
            wheel_row[w] = axial;
        }
        let mass = SpacecraftMass::of(parameters, state, &wheels);
        let free_row = [parameters.wheels[0].free * wheel_row[0], parameters.wheels[1].free * wheel_row[1]];
        let (v_dot, rotation) =
            mass.solution(force, [omega_row[0], omega_row[1], omega_row[2], free_row[0], free_row[1]]);
        let omega_s_dot = [rotation[0], rotation[1], rotation[2]];
        let mut motors = self.drive.motors;
        for w in 0..2 {
            let wheel = &parameters.wheels[w];
            let holding = forces::holding_torque(wheel, &wheels[w], omega_s_dot, wheel_row[w]);
            motors[w] = (1.0 - wheel.free).mul_add(holding, motors[w]);
        }

        // debris rows: free
        let momentum = product(self.debris_deviator, state.omega_d);
        let omega_d_dot = solved(&self.debris_factor, scaled(-1.0, cross(state.omega_d, momentum)));

        let c_es = state.dcm[0];
        State {
            position: [state.v_p, wheels[0].velocity, wheels[1].velocity, state.v_gd],
            dcm: [
                dcm_rate(c_es, state.omega_s),
                dcm_rate(state.dcm[1], wheels[0].omega),
                dcm_rate(state.dcm[2], wheels[1].omega),
                dcm_rate(state.dcm[3], state.omega_d),
            ],
            v_p: v_dot,
            omega_s: omega_s_dot,
            wheel_rates: [rotation[3], rotation[4]],
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
