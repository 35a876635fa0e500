//! [`Target`]: the attitude that a phase wants.

use crate::control::net_launch::geometry::LaunchGeometry;
use crate::control::rotation::quaternion_of;
use crate::control::vector::{conjugate, cross, dcm_from_quaternion, dot, hamilton, norm, scaled, transposed_product};

/// The attitude that a phase wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// None: the rate is controlled alone.
    None,
    /// The attitude q_et of a frame fixed in F_e, F_t -> F_e, scalar first.
    Attitude([f64; 4]),
    /// s3 points at the debris.
    LineToDebris,
    /// s3 along the axis A_d.
    LaunchAxis,
    /// s3 along the first impulse of a transfer to the station.
    Transfer,
    /// s3 against the velocity relative to the debris.
    Stop,
    /// s3 along the velocity relative to the debris.
    Velocity,
}

/// The names of the targets in campaign files; an attitude has a key of its own.
pub const TARGETS: [(&str, Target); 7] = [
    ("none", Target::None),
    ("attitude", Target::Attitude([1.0, 0.0, 0.0, 0.0])),
    ("line_to_debris", Target::LineToDebris),
    ("launch_axis", Target::LaunchAxis),
    ("transfer", Target::Transfer),
    ("stop", Target::Stop),
    ("velocity", Target::Velocity),
];

/// The attitude relative to a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeError {
    /// Attitude of F_s relative to the target, scalar first.
    pub q_ts: [f64; 4],
    /// Angular velocity of the target relative to F_e, in F_s, rad/s.
    pub omega_te_s: [f64; 3],
}

/// The impulse per mass that is left of a maneuver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VelocityToGo {
    /// In F_e, m/s.
    pub velocity_e: [f64; 3],
    /// How it changes without thrust, in F_e, m/s^2.
    pub change_e: [f64; 3],
}

impl AttitudeError {
    /// None.
    pub const NONE: AttitudeError = AttitudeError { q_ts: [1.0, 0.0, 0.0, 0.0], omega_te_s: [0.0; 3] };

    /// The angle of the rotation to the target, rad, by the shorter way.
    pub fn angle(&self) -> f64 {
        let [w, x, y, z] = self.q_ts;
        2.0 * libm::atan2(norm([x, y, z]), w.abs())
    }
}

impl Target {
    /// Whether it is defined by the debris.
    pub fn needs_debris(self) -> bool {
        !matches!(self, Target::None | Target::Attitude(_))
    }

    /// The attitude `q_es` relative to the target, where the spacecraft is at `geometry`; `to_go` is the impulse of the maneuver.
    pub fn error(self, q_es: [f64; 4], geometry: Option<&LaunchGeometry>, to_go: &VelocityToGo) -> AttitudeError {
        let fixed = |direction: [f64; 3]| pointing(q_es, direction, [0.0; 3]);
        match (self, geometry) {
            (Target::Attitude(q_et), _) => {
                AttitudeError { q_ts: hamilton(conjugate(q_et), q_es), ..AttitudeError::NONE }
            }
            (Target::LineToDebris, Some(geometry)) => {
                let line = geometry.to_debris;
                // the spacecraft moves with the relative velocity, and the line against it
                pointing(q_es, line, turn_of(line, scaled(-1.0, geometry.relative_velocity)))
            }
            (Target::LaunchAxis, Some(geometry)) => fixed(geometry.axis),
            (Target::Transfer | Target::Stop, Some(_)) => {
                pointing(q_es, to_go.velocity_e, turn_of(to_go.velocity_e, to_go.change_e))
            }
            (Target::Velocity, Some(geometry)) => fixed(geometry.relative_velocity),
            _ => AttitudeError::NONE,
        }
    }
}

/// How fast the direction of `vector` turns that changes by `change` a second, rad/s.
fn turn_of(vector: [f64; 3], change: [f64; 3]) -> [f64; 3] {
    let square = dot(vector, vector);
    if square == 0.0 { [0.0; 3] } else { scaled(1.0 / square, cross(vector, change)) }
}

/// The attitude relative to the one that points s3 along `direction` (F_e, any length) by the shortest rotation, and turns at `turn` (rad/s, F_e).
fn pointing(q_es: [f64; 4], direction: [f64; 3], turn: [f64; 3]) -> AttitudeError {
    let length = norm(direction);
    if length == 0.0 {
        return AttitudeError::NONE;
    }
    let c_es = dcm_from_quaternion(q_es);
    let d_s = transposed_product(c_es, scaled(1.0 / length, direction));
    // s3 x d: the axis of the rotation from s3 to the direction
    let across = [-d_s[1], d_s[0], 0.0];
    let sine = norm(across);
    let angle = libm::atan2(sine, d_s[2]);
    let vector = match (sine > 0.0, d_s[2] > 0.0) {
        (true, _) => scaled(angle / sine, across),
        (false, true) => [0.0; 3],
        // the other way: any axis across is as good
        (false, false) => [angle, 0.0, 0.0],
    };
    AttitudeError { q_ts: quaternion_of(scaled(-1.0, vector)), omega_te_s: transposed_product(c_es, turn) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::vector::{difference, product, sum};

    fn geometry(to_debris: [f64; 3], relative_velocity: [f64; 3]) -> LaunchGeometry {
        LaunchGeometry { axis: [0.0, 0.0, 1.0], to_debris, from_station: [0.0; 3], relative_velocity }
    }

    /// Law: after the rotation back by the error, s3 points at the target, and the angle of the error is that between s3 and the target.
    #[test]
    fn the_error_leads_to_the_target() {
        for q_es in [[1.0, 0.0, 0.0, 0.0], quaternion_of([0.3, -1.0, 2.0]), quaternion_of([3.0, 0.5, 0.0])] {
            for line in [[1.0, 2.0, -0.5], [0.0, 0.0, -3.0], [0.0, 0.0, 4.0], [-1.0, 1e-9, 0.0]] {
                let error = Target::LineToDebris.error(q_es, Some(&geometry(line, [0.0; 3])), &VelocityToGo::default());
                let q_et = hamilton(q_es, conjugate(error.q_ts));
                let s3 = product(dcm_from_quaternion(q_et), [0.0, 0.0, 1.0]);
                let wanted = scaled(1.0 / norm(line), line);
                assert!(norm(difference(s3, wanted)) < 4e-15, "{s3:?} for {wanted:?}");
                let before = product(dcm_from_quaternion(q_es), [0.0, 0.0, 1.0]);
                let angle = libm::atan2(norm(cross(before, wanted)), dot(before, wanted));
                assert!((error.angle() - angle).abs() < 1e-14);
            }
        }
    }

    /// Law: the line to the debris turns as the difference of two lines says.
    #[test]
    fn the_line_turns_with_the_relative_velocity() {
        let (line, velocity, h) = ([3.0, 4.0, 1.0], [0.1, -0.05, 0.2], 1e-4);
        let error =
            Target::LineToDebris.error([1.0, 0.0, 0.0, 0.0], Some(&geometry(line, velocity)), &VelocityToGo::default());
        let unit = |v: [f64; 3]| scaled(1.0 / norm(v), v);
        // the spacecraft moves with the velocity, so that the line changes against it
        let slope =
            scaled(0.5 / h, difference(unit(sum(line, scaled(-h, velocity))), unit(sum(line, scaled(h, velocity)))));
        assert!(norm(difference(cross(error.omega_te_s, unit(line)), slope)) < 1e-9);
    }

    /// Law: an attitude is reached by its own quaternion; without a target there is no error.
    #[test]
    fn an_attitude_is_its_own_target() {
        let q = quaternion_of([0.2, 0.1, -0.4]);
        assert!(Target::Attitude(q).error(q, None, &VelocityToGo::default()).angle() < 1e-15);
        let off =
            Target::Attitude(q).error(hamilton(q, quaternion_of([0.0, 0.01, 0.0])), None, &VelocityToGo::default());
        assert!((off.angle() - 0.01).abs() < 1e-15 && off.q_ts[2] > 0.0);
        assert_eq!(Target::None.error(q, None, &VelocityToGo::default()), AttitudeError::NONE);
    }
}
