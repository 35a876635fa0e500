//! From input to [`Scene`]: check, derive, normalise; Berdoz's Sigma (59) in quaternions.

use super::alignment::aligned;
use super::error::Problems;
use super::input::SceneInput;
use super::mass::MassProperties;
use super::schema::{Device, InitialInput, MAX_WHEELS};
use super::unit_quaternion::unit_quaternion;
use super::{
    ActuatorModels, InitialState, LocalFrame, Offsets, Orbit, Scene, SceneError, TorqueRod, check, failures, plate,
    schedule,
};
use crate::math::prelude::*;

impl Scene {
    /// The scene that `input` describes.
    ///
    /// # Errors
    /// All problems of `input`.
    pub fn resolve(input: &SceneInput) -> Result<Self, Vec<SceneError>> {
        let mass = checked(input)?;
        let mut scene = Scene {
            mass,
            initial: initial_state(input, None),
            thrusters: Vec::new(),
            torque_rods: Vec::new(),
            schedule: Vec::with_capacity(input.actuation.len()),
            orbit: None,
            plates: Vec::new(),
            offsets: None,
            environment: input.environment,
            commands_thrust: false,
            commands_torque: false,
            actuators: ActuatorModels::IDEAL,
            failures: Vec::new(),
        };
        scene.take(input, &mass);
        Ok(scene)
    }

    /// [`Scene::resolve`] into the memory of a scene: no allocation unless the schedule is longer than ever before.
    ///
    /// # Errors
    /// All problems of `input`; the scene is then unchanged.
    pub fn resolve_into(&mut self, input: &SceneInput) -> Result<(), Vec<SceneError>> {
        let mass = checked(input)?;
        self.take(input, &mass);
        Ok(())
    }

    fn take(&mut self, input: &SceneInput, mass: &MassProperties) {
        self.mass = *mass;
        self.orbit = input.orbit.as_ref().map(Orbit::of);
        self.offsets = Offsets::of(input);
        let of_craft = match (&self.orbit, &self.offsets) {
            (Some(orbit), Some(offsets)) => Some(orbit.displaced(&offsets.spacecraft)),
            (orbit, _) => *orbit,
        };
        self.initial = initial_state(input, of_craft.as_ref());
        self.thrusters.clear();
        self.thrusters.extend(schedule::thrusters(input));
        self.torque_rods.clear();
        self.torque_rods.extend(input.torque_rods.iter().map(|rod| TorqueRod {
            axis: aligned(rod.axis, rod.tilt_rad, 1.0),
            limit: rod.max_dipole_a_m2,
            scale: rod.dipole_scale,
        }));
        self.schedule.clear();
        self.schedule.extend((0..input.actuation.len()).map(|index| schedule::applied(input, index)));
        if let (Some(orbit), Some(of_craft)) = (&self.orbit, of_craft) {
            if let Some(offsets) = self.offsets.as_ref().filter(|_| mass.debris.is_some()) {
                let of_debris = orbit.displaced(&offsets.debris);
                (self.initial.r_gdo_e, self.initial.v_gdo_e) = (of_debris.position, of_debris.velocity);
            }
            // p from the centre of mass, on the orbit or near it
            let c_es = dcm_from_quaternion(self.initial.q_es);
            let spin = cross(self.initial.omega_se_s, mass.center);
            self.initial.r_po_e = difference(of_craft.position, product(c_es, mass.center));
            self.initial.v_po_e = difference(of_craft.velocity, product(c_es, spin));
        }
        plate::resolve_into(input, &mut self.plates);
        self.environment = input.environment;
        self.commands_thrust = input.actuation.iter().any(|arc| arc.thrust_n.iter().any(|thrust| *thrust != 0.0));
        self.commands_torque = input.actuation.iter().any(|arc| arc.torque_n_m.iter().any(|torque| *torque != 0.0));
        self.actuators = ActuatorModels::of(input);
        self.failures.clone_from(&input.failures);
        failures::apply(&self.failures, input.control.has_loop(), &mut self.schedule);
        self.commands_thrust |= self.failures.iter().any(|failure| matches!(failure.device, Device::Thruster(_)));
    }
}

/// Mass properties of a checked `input`.
fn checked(input: &SceneInput) -> Result<MassProperties, Vec<SceneError>> {
    let mut problems = Problems::default();
    check::written(input, &mut problems);
    if problems.0.is_empty() {
        let mass = MassProperties::of(input, 1.0);
        check::derived(input, &mass, &mut problems);
        if problems.0.is_empty() {
            return Ok(mass);
        }
    }
    Err(problems.0)
}

/// The state at time zero (59): q_ed = q_es (x) q_sd, omega^de = omega^ds + C_ds omega^se for debris, unless given;
/// relative to the local orbital frame on `orbit`: q_es = q_eo (x) q_os, omega^se = omega^so + C_es^T omega^oe.
fn initial_state(input: &SceneInput, orbit: Option<&Orbit>) -> InitialState {
    let InitialInput {
        position_m,
        velocity_m_s,
        attitude,
        attitude_orbital,
        angular_velocity_rad_s,
        angular_velocity_orbital_rad_s,
        debris_position_m,
        debris_velocity_m_s,
        debris_attitude,
        debris_relative_angular_velocity_rad_s,
        debris_attitude_inertial,
        debris_angular_velocity_rad_s,
    } = input.initial;
    let (mut wheel_angles, mut wheel_rates) = ([0.0; MAX_WHEELS], [0.0; MAX_WHEELS]);
    for (i, wheel) in input.turning().enumerate() {
        (wheel_angles[i], wheel_rates[i]) = (wheel.angle_rad, wheel.rate_rad_s);
    }
    let frame = || orbit.map(|orbit| LocalFrame::at(orbit.position, orbit.velocity));
    let q_es = match attitude_orbital.and_then(|q_os| Some((q_os, frame()?))) {
        Some((q_os, frame)) => hamilton(frame.q_eo, unit_quaternion(q_os)),
        None => unit_quaternion(attitude),
    };
    let angular_velocity_rad_s = match angular_velocity_orbital_rad_s
        .and_then(|omega_so_s| Some((omega_so_s, frame()?)))
    {
        Some((omega_so_s, frame)) => sum(omega_so_s, transposed_product(dcm_from_quaternion(q_es), frame.omega_oe_e)),
        None => angular_velocity_rad_s,
    };
    let mut state = InitialState {
        r_po_e: position_m,
        v_po_e: velocity_m_s,
        q_es,
        omega_se_s: angular_velocity_rad_s,
        wheel_angles,
        wheel_rates,
        r_gdo_e: [0.0; 3],
        v_gdo_e: [0.0; 3],
        q_ed: [1.0, 0.0, 0.0, 0.0],
        omega_de_d: [0.0; 3],
    };
    if input.debris.is_some() {
        let (q_sd, q_ed) = match debris_attitude_inertial.map(unit_quaternion) {
            None => {
                let q_sd = unit_quaternion(debris_attitude);
                (q_sd, hamilton(q_es, q_sd))
            }
            Some(q_ed) => (hamilton(conjugate(q_es), q_ed), q_ed),
        };
        state.r_gdo_e = debris_position_m;
        state.v_gdo_e = debris_velocity_m_s;
        state.q_ed = q_ed;
        state.omega_de_d = debris_angular_velocity_rad_s.unwrap_or_else(|| {
            let omega_se_d = transposed_product(dcm_from_quaternion(q_sd), angular_velocity_rad_s);
            sum(debris_relative_angular_velocity_rad_s, omega_se_d)
        });
    }
    state
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::samples;
    use crate::scene::schema::OrbitInput;

    /// Law: without rotation in the local orbital frame s3 points down and s1 ahead, and without rate the body turns
    /// once per orbit; offsets count. Truth: line of sight, direction of motion, central difference of the line of
    /// sight.
    #[test]
    fn the_local_orbital_frame_is_that_of_the_motion() {
        for offset in [[0.0; 3], [4.0e5, -2.0e5, 1.0e5]] {
            let mut input = samples::table_two();
            let orbit = OrbitInput {
                semi_major_axis_m: Some(8.0e6),
                eccentricity: Some(0.1),
                inclination_rad: Some(0.9),
                true_anomaly_rad: Some(1.3),
                ..OrbitInput::DEFAULT
            };
            input.orbit = Some(orbit);
            input.initial.position_m = offset;
            input.initial.velocity_m_s = [0.0; 3];
            input.initial.attitude = [1.0, 0.0, 0.0, 0.0];
            input.initial.angular_velocity_rad_s = [0.0; 3];
            input.initial.attitude_orbital = Some([1.0, 0.0, 0.0, 0.0]);
            input.initial.angular_velocity_orbital_rad_s = Some([0.0; 3]);
            let scene = Scene::resolve(&input).expect("a scene on an orbit");
            let own = scene.orbit.expect("an orbit");
            let [r, v] = [sum(own.position, offset), own.velocity];
            let unit = |vector: [f64; 3]| scaled(1.0 / norm(vector), vector);
            let c_es = dcm_from_quaternion(scene.initial.q_es);
            let axis = |k: usize| [c_es[0][k], c_es[1][k], c_es[2][k]];
            let near = |a: [f64; 3], b: [f64; 3], bound: f64| {
                assert!(norm(difference(a, b)) < bound, "{a:?} {b:?}");
            };
            near(axis(2), unit(r).map(|x| -x), 1e-15);
            near(axis(1), unit(cross(r, v)).map(|x| -x), 1e-15);
            assert!(dot(axis(0), v) > 0.0);
            // s3 follows the line of sight: d(r/|r|)/dt = omega x r/|r|
            let step = 0.01;
            let at = |time: f64| unit(sum(r, scaled(time, v)));
            let slope = difference(at(step), at(-step)).map(|x| x / (2.0 * step));
            let omega_e = product(c_es, scene.initial.omega_se_s);
            near(cross(omega_e, unit(r)), slope, 1e-12);
            near(cross(omega_e, unit(cross(r, v))), [0.0; 3], 1e-18);
            // turned by q_os, with the rate added in F_s
            let q_os = unit_quaternion([0.5, 0.5, -0.5, 0.5]);
            input.initial.attitude_orbital = Some(q_os);
            input.initial.angular_velocity_orbital_rad_s = Some([0.1, -0.2, 0.3]);
            let turned = Scene::resolve(&input).expect("a scene on an orbit").initial;
            let c_os = dcm_from_quaternion(q_os);
            let wanted = product(c_es, product(c_os, [0.0, 0.0, 1.0]));
            near(product(dcm_from_quaternion(turned.q_es), [0.0, 0.0, 1.0]), wanted, 1e-15);
            let rate = sum([0.1, -0.2, 0.3], transposed_product(c_os, scene.initial.omega_se_s));
            near(turned.omega_se_s, rate, 1e-15);
        }
    }
}
