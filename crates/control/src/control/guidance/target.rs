//! [`TargetInput`]: the attitude of the spacecraft relative to the target of a phase.

use crate::dynamics::environment::sun::sun_after;
use crate::dynamics::gravity::Gravity;
use crate::loops::launch_geometry::LaunchGeometry;
use crate::loops::target::{AttitudeError, Target};
use crate::loops::vector::{
    conjugate, cross, dcm_from_quaternion, dot, hamilton, norm, quaternion_of, scaled, transposed_product,
};
use crate::math::vector::quaternion_from_dcm;
use crate::scene::Orbit;

/// Motion relative to the central body, in F_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitMotion {
    /// Position of the centre of mass.
    pub r_e: [f64; 3],
    pub v_e: [f64; 3],
    /// Acceleration by gravity, for the target that needs it, else zero.
    pub a_e: [f64; 3],
    /// Unit vector to the Sun, likewise; zero without a date.
    pub sun_e: [f64; 3],
}

impl OrbitMotion {
    /// Motion at `r_e`, `v_e` on `orbit` at `time`, for `target`.
    pub fn of(orbit: &Orbit, target: Target, time: f64, [r_e, v_e]: [[f64; 3]; 2]) -> Self {
        let (mut a_e, mut sun_e) = ([0.0; 3], [0.0; 3]);
        match target {
            Target::OrbitalVelocity => a_e = Gravity::of(orbit).acceleration(r_e, norm(r_e)),
            Target::Sun => sun_e = orbit.epoch.map_or(sun_e, |epoch| sun_after(epoch, time).direction),
            _ => {}
        }
        OrbitMotion { r_e, v_e, a_e, sun_e }
    }

    /// Attitude q_eo of the local orbital frame ([`crate::scene::LocalFrame`]), F_o -> F_e, and its angular velocity in
    /// F_e, without the fused operations of `LocalFrame`, whose bits differ.
    fn local_frame(&self) -> ([f64; 4], [f64; 3]) {
        let normal = cross(self.r_e, self.v_e);
        let o3 = scaled(-1.0 / norm(self.r_e), self.r_e);
        let o2 = scaled(-1.0 / norm(normal), normal);
        let o1 = cross(o2, o3);
        let c_eo = std::array::from_fn(|i| [o1[i], o2[i], o3[i]]);
        (quaternion_from_dcm(c_eo), scaled(1.0 / dot(self.r_e, self.r_e), normal))
    }
}

/// Input that defines a target.
#[derive(Clone, Copy, Debug)]
pub struct TargetInput<'a> {
    /// Launch geometry; `None` without debris.
    pub geometry: Option<&'a LaunchGeometry>,
    pub to_go: &'a VelocityToGo,
    pub orbit: Option<OrbitMotion>,
}

/// Remaining impulse per mass of a maneuver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VelocityToGo {
    /// In F_e.
    pub velocity_e: [f64; 3],
    /// Its derivative without thrust, in F_e.
    pub change_e: [f64; 3],
}

impl TargetInput<'_> {
    pub fn error(&self, target: Target, q_es: [f64; 4]) -> AttitudeError {
        let TargetInput { geometry, to_go, orbit } = *self;
        // s3 to a direction that rotates at a rate
        let aim = match target {
            Target::None => None,
            Target::Attitude(q_et) => {
                return AttitudeError { q_ts: hamilton(conjugate(q_et), q_es), ..AttitudeError::NONE };
            }
            Target::Orbital(q_os) => {
                let Some(orbit) = orbit else { return AttitudeError::NONE };
                let (q_eo, omega_oe_e) = orbit.local_frame();
                return AttitudeError {
                    q_ts: hamilton(conjugate(hamilton(q_eo, q_os)), q_es),
                    omega_te_s: transposed_product(dcm_from_quaternion(q_es), omega_oe_e),
                };
            }
            Target::Nadir => orbit.map(|orbit| (scaled(-1.0, orbit.r_e), turn_of(orbit.r_e, orbit.v_e))),
            Target::OrbitalVelocity => orbit.map(|orbit| (orbit.v_e, turn_of(orbit.v_e, orbit.a_e))),
            // the Sun turns by 2e-7 rad/s
            Target::Sun => orbit.map(|orbit| (orbit.sun_e, [0.0; 3])),
            Target::LineToDebris => geometry.map(|geometry| {
                let line = geometry.to_debris;
                // the line moves against the spacecraft's relative velocity
                let change = geometry.inertial_change(line, scaled(-1.0, geometry.relative_velocity));
                (line, turn_of(line, change))
            }),
            // fixed in F_e, or on an orbit to the axis
            Target::LaunchAxis => geometry.map(|geometry| (geometry.axis, geometry.turn())),
            Target::Velocity => geometry.map(|geometry| (geometry.relative_velocity, geometry.turn())),
            Target::Transfer | Target::Stop => {
                geometry.map(|_| (to_go.velocity_e, turn_of(to_go.velocity_e, to_go.change_e)))
            }
        };
        aim.map_or(AttitudeError::NONE, |(direction, turn)| pointing(q_es, direction, turn))
    }
}

/// Angular velocity of the direction of `vector` with the derivative `change`.
fn turn_of(vector: [f64; 3], change: [f64; 3]) -> [f64; 3] {
    let square = dot(vector, vector);
    if square == 0.0 { [0.0; 3] } else { scaled(1.0 / square, cross(vector, change)) }
}

/// Attitude relative to the one that turns s3 the shortest way to `direction` (F_e, any length) and rotates at `turn`
/// (F_e).
fn pointing(q_es: [f64; 4], direction: [f64; 3], turn: [f64; 3]) -> AttitudeError {
    let length = norm(direction);
    if length == 0.0 {
        return AttitudeError::NONE;
    }
    let c_es = dcm_from_quaternion(q_es);
    let d_s = transposed_product(c_es, scaled(1.0 / length, direction));
    // s3 x d, the axis of the rotation from s3 to the direction
    let across = [-d_s[1], d_s[0], 0.0];
    let sine = norm(across);
    let angle = libm::atan2(sine, d_s[2]);
    let vector = match (sine > 0.0, d_s[2] > 0.0) {
        (true, _) => scaled(angle / sine, across),
        (false, true) => [0.0; 3],
        // opposite: any axis across will do
        (false, false) => [angle, 0.0, 0.0],
    };
    AttitudeError { q_ts: quaternion_of(scaled(-1.0, vector)), omega_te_s: transposed_product(c_es, turn) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loops::vector::{difference, product, sum, vector_of};
    use crate::scene::Epoch;

    const NO_IMPULSE: VelocityToGo = VelocityToGo { velocity_e: [0.0; 3], change_e: [0.0; 3] };
    const NOTHING: TargetInput<'_> = TargetInput { geometry: None, to_go: &NO_IMPULSE, orbit: None };

    /// Law: at zero error s3 points at the target, orbital attitudes have the axes of the rotated orbital frame, and
    /// the target's rate is the derivative of its attitude along the orbit.
    #[test]
    fn targets_of_an_orbit_turn_with_it() {
        let mu = 3.986e14;
        let (r_e, v_e) = ([7e6, 1e5, -2e5], [200.0, 5_000.0, 5_700.0]);
        let pull = scaled(-mu / norm(r_e).powi(3), r_e);
        // two-body motion to second order
        let at = |time: f64, target: Target| {
            let r_e = sum(sum(r_e, scaled(time, v_e)), scaled(0.5 * time * time, pull));
            let epoch = Epoch::parse("2026-06-21T09:00:00Z");
            let scene = Orbit { mu, position: r_e, velocity: v_e, body_radius: 0.0, j2: None, epoch };
            let orbit = OrbitMotion::of(&scene, target, time, [r_e, sum(v_e, scaled(time, pull))]);
            TargetInput { orbit: Some(orbit), ..NOTHING }
        };
        // at the solstice the Sun is over the tropic
        let solstice = [0.0, libm::cos(0.40909), libm::sin(0.40909)];
        let q_os = quaternion_of([0.2, -0.5, 0.3]);
        for (target, q_es) in [
            (Target::Orbital(q_os), [1.0, 0.0, 0.0, 0.0]),
            (Target::Nadir, quaternion_of([0.5, 2.0, 0.1])),
            (Target::OrbitalVelocity, quaternion_of([-0.5, 0.3, 0.1])),
            (Target::Sun, quaternion_of([-0.5, 1.3, 0.1])),
        ] {
            let error = at(0.0, target).error(target, q_es);
            let q_et = hamilton(q_es, conjugate(error.q_ts));
            // on target there is no error, and s3 points along the wanted direction
            assert!(at(0.0, target).error(target, q_et).angle() < 1e-14);
            let wished = match target {
                Target::OrbitalVelocity => scaled(1.0 / norm(v_e), v_e),
                Target::Sun => at(0.0, Target::Sun).orbit.expect("an orbit").sun_e,
                _ => scaled(-1.0 / norm(r_e), r_e),
            };
            let in_target = transposed_product(dcm_from_quaternion(q_et), wished);
            let wanted = match target {
                Target::Orbital(q_os) => transposed_product(dcm_from_quaternion(q_os), [0.0, 0.0, 1.0]),
                _ => [0.0, 0.0, 1.0],
            };
            assert!(norm(difference(in_target, wanted)) < 1e-14, "{in_target:?}");
            // q_et(t)' q_et(t + h) is the rotation by omega_te h; for nadir, the part across
            let h = 1e-2;
            let moved = [-h, h].map(|time| at(time, target).error(target, q_et).q_ts);
            let slope = scaled(-0.5 / h, difference(vector_of(moved[1]), vector_of(moved[0])));
            let rate = at(0.0, target).error(target, q_et).omega_te_s;
            // neglects the Sun's motion, 2e-7 rad/s
            let bound = if target == Target::Sun { 2.1e-7 } else { 1e-9 };
            assert!(norm(difference(slope, rate)) < bound, "{target:?}: {slope:?} for {rate:?}");
            assert_eq!(norm(rate) > 1e-4, target != Target::Sun);
        }
        // within a day of the solstice: 1 deg along the ecliptic
        assert!(norm(difference(at(0.0, Target::Sun).orbit.expect("an orbit").sun_e, solstice)) < 0.02);
        let orbit = at(0.0, Target::Nadir).orbit.expect("an orbit");
        let (q_eo, _) = orbit.local_frame();
        let [ahead, across] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|axis| product(dcm_from_quaternion(q_eo), axis));
        assert!(dot(ahead, v_e) > 0.9 * norm(v_e) && dot(across, cross(r_e, v_e)) < 0.0);
        assert!(dot(across, r_e).abs() < 1e-8 && dot(across, v_e).abs() < 1e-11);
    }
}
