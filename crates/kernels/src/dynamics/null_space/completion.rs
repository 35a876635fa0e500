//! Physical states from integrated components.

use super::energy::kinetic_energies;
use super::parameters::{Parameters, WheelParameters};
use super::residuals::residuals;
use super::state::{Columns, State, rotated, transposed};
use crate::dynamics::actuation::{BodyState, WheelState};
use crate::math::prelude::*;
use crate::run::{Grid, StateField, StateTable, Trajectory};
use crate::scene::Scene;

/// Fills and pads the fields of `table` from the integrated components of a run of `scene`. Quaternions belong to the
/// integrated DCMs, with unit norm and a continuous sign. Missing debris is at rest.
#[inline(always)]
pub fn complete<const W: usize, const N: usize>(
    scene: &Scene,
    trajectory: &Trajectory,
    grid: &Grid,
    table: &mut StateTable,
) {
    debug_assert!(trajectory.points() == grid.points() && table.points() == grid.points());
    let parameters = Parameters::<W>::of(scene);
    let wheels = table.wheels();
    let (mut q_es, mut q_ed) = (scene.initial.q_es, scene.initial.q_ed);
    for point in 0..table.points() {
        let state = State::<W>::from_components(&trajectory.at::<N>(point));
        let c_es = state.fuselage.dcm;
        let mut set = |field: StateField, values: &[f64]| {
            if table.has(field) {
                for (component, value) in values.iter().enumerate() {
                    table.column_mut(field, component)[point] = *value;
                }
            }
        };
        q_es = quaternion(c_es, q_es);
        q_ed = quaternion(state.debris.dcm, q_ed);
        set(StateField::Rate, &state.omega_s);
        set(StateField::Attitude, &q_es);
        set(StateField::WheelRates, &state.wheel_rates[..wheels]);
        set(StateField::WheelAngles, &state.wheel_angles[..wheels]);
        set(StateField::ComPosition, &sum(state.fuselage.position, rotated(c_es, parameters.center)));
        set(StateField::ComVelocity, &sum(state.v_p, rotated(c_es, cross(state.omega_s, parameters.center))));
        set(StateField::Work, &state.work);
        set(StateField::Impulse, &state.impulse);
        set(StateField::AngularImpulse, &state.angular_impulse);
        set(StateField::DebrisPosition, &state.debris.position);
        set(StateField::DebrisVelocity, &state.v_gd);
        set(StateField::DebrisAttitude, &q_ed);
        set(StateField::DebrisRate, &state.omega_d);
        set(StateField::Dcm, c_es.as_flattened());
        if table.has(StateField::KineticEnergies) {
            let energies = kinetic_energies(&parameters, &state);
            let all = [energies.fuselage]
                .into_iter()
                .chain(energies.wheels.into_iter().take(wheels))
                .chain([energies.debris]);
            for (component, energy) in all.enumerate() {
                table.column_mut(StateField::KineticEnergies, component)[point] = energy;
            }
        }
        if table.has(StateField::Residuals) {
            table.set(StateField::Residuals, point, residuals(scene, &parameters, &state));
        }
    }
    table.pad();
}

/// The state observed by an actuation law.
#[inline(always)]
pub fn observed_state<const W: usize>(
    parameters: &Parameters<W>,
    state: &State<W>,
    near: [f64; 4],
) -> (BodyState, WheelState) {
    let c_es = state.fuselage.dcm;
    let mut wheels = WheelState::AT_REST;
    for (i, WheelParameters { axis, inertia, .. }) in parameters.wheels.into_iter().enumerate() {
        let rate = state.wheel_rates[i];
        wheels.rates[i] = rate;
        wheels.momenta[i] = dot(axis, product(inertia, axis)) * (rate + dot(axis, state.omega_s));
        wheels.angles[i] = state.wheel_angles[i];
    }
    let body = BodyState {
        omega_se_s: state.omega_s,
        q_es: quaternion(c_es, near),
        r_co_e: sum(state.fuselage.position, rotated(c_es, parameters.center)),
        v_co_e: sum(state.v_p, rotated(c_es, cross(state.omega_s, parameters.center))),
    };
    (body, wheels)
}

/// Unit quaternion of a DCM by columns, of the sign nearer to `near`, by Shepperd's method.
#[inline(always)]
pub fn quaternion(c: Columns, near: [f64; 4]) -> [f64; 4] {
    let (_, q) = scaled_quaternion_from_dcm(transposed(c));
    let dot = |p: [f64; 4]| q[0].mul_add(p[0], q[1].mul_add(p[1], q[2].mul_add(p[2], q[3] * p[3])));
    let norm = if dot(near) < 0.0 { -dot(q).sqrt() } else { dot(q).sqrt() };
    q.map(|component| component / norm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_quaternion_survives_its_dcm(q in prop::array::uniform4(-1.0f64..1.0), small in 0usize..5) {
            let mut q = q;
            if small < 4 {
                q[small] *= 1e-9; // near the borders of Shepperd's cases
            }
            let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            prop_assume!(norm > 0.1);
            let q = q.map(|x| x / norm);
            let back = quaternion(transposed(dcm_from_quaternion(q)), q);
            for i in 0..4 {
                // some roundings of entries of size one; measured: an ulp
                prop_assert!((back[i] - q[i]).abs() < 4.0 * f64::EPSILON, "{:?} {:?}", q, back);
            }
            let other = quaternion(transposed(dcm_from_quaternion(q)), q.map(|x| -x));
            prop_assert_eq!(other, back.map(|x| -x));
        }
    }
}
