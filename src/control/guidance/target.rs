//! [`Target`]: the attitude that a phase wants.

use crate::control::net_launch::geometry::LaunchGeometry;
use crate::control::rotation::quaternion_of;
use crate::control::vector::{conjugate, cross, dcm_from_quaternion, dot, hamilton, norm, scaled, transposed_product};
use crate::dynamics::environment::sun::sun_after;
use crate::dynamics::gravity::Gravity;
use crate::math::vector::quaternion_from_dcm;
use crate::scene::Orbit;

/// The attitude that a phase wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// None: the rate is controlled alone.
    None,
    /// The attitude q_et of a frame fixed in F_e, F_t -> F_e, scalar first.
    Attitude([f64; 4]),
    /// The attitude q_os of the body relative to the local orbital frame, F_s -> F_o, scalar first.
    Orbital([f64; 4]),
    /// s3 points at the central body.
    Nadir,
    /// s3 along the velocity of the orbit.
    OrbitalVelocity,
    /// s3 points at the Sun.
    Sun,
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
pub const TARGETS: [(&str, Target); 11] = [
    ("none", Target::None),
    ("attitude", Target::Attitude([1.0, 0.0, 0.0, 0.0])),
    ("orbital_attitude", Target::Orbital([1.0, 0.0, 0.0, 0.0])),
    ("nadir", Target::Nadir),
    ("orbital_velocity", Target::OrbitalVelocity),
    ("sun", Target::Sun),
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

/// Motion of the spacecraft relative to the central body, in F_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitMotion {
    /// Position of its centre of mass, m.
    pub r_e: [f64; 3],
    /// Velocity, m/s.
    pub v_e: [f64; 3],
    /// Acceleration by gravity, m/s^2.
    pub a_e: [f64; 3],
    /// The unit vector to the Sun; zero where the orbit has no date.
    pub sun_e: [f64; 3],
}

impl OrbitMotion {
    /// The motion at the position `r_e` and the velocity `v_e` on `orbit` at `time`, s.
    pub fn of(orbit: &Orbit, time: f64, r_e: [f64; 3], v_e: [f64; 3]) -> Self {
        OrbitMotion {
            r_e,
            v_e,
            a_e: Gravity::of(orbit).acceleration(r_e, norm(r_e)),
            sun_e: orbit.epoch.map_or([0.0; 3], |epoch| sun_after(epoch, time).direction),
        }
    }

    /// The attitude q_eo of the local orbital frame ([`crate::scene::LocalFrame`]), F_o -> F_e, and its angular
    /// velocity in F_e, rad/s. By plain sums, like everything that flight software computes: those of `LocalFrame` are
    /// fused, and would be other bits.
    fn local_frame(&self) -> ([f64; 4], [f64; 3]) {
        let normal = cross(self.r_e, self.v_e);
        let o3 = scaled(-1.0 / norm(self.r_e), self.r_e);
        let o2 = scaled(-1.0 / norm(normal), normal);
        let o1 = cross(o2, o3);
        let c_eo = std::array::from_fn(|i| [o1[i], o2[i], o3[i]]);
        (quaternion_from_dcm(c_eo), scaled(1.0 / dot(self.r_e, self.r_e), normal))
    }
}

/// The definition of a target, besides the attitude.
#[derive(Clone, Copy, Debug)]
pub struct TargetInput<'a> {
    /// Geometry of the launch; `None` without debris.
    pub geometry: Option<&'a LaunchGeometry>,
    /// The impulse of the maneuver.
    pub to_go: &'a VelocityToGo,
    /// The orbit; `None` without one.
    pub orbit: Option<OrbitMotion>,
}

/// The impulse per mass that is left of a maneuver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VelocityToGo {
    /// In F_e, m/s.
    pub velocity_e: [f64; 3],
    /// Its derivative without thrust, in F_e, m/s^2.
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
    /// True if it is defined by the debris.
    pub fn needs_debris(self) -> bool {
        !matches!(self, Target::None | Target::Attitude(_)) && !self.needs_orbit()
    }

    /// True if it is defined by the orbit.
    pub fn needs_orbit(self) -> bool {
        matches!(self, Target::Orbital(_) | Target::Nadir | Target::OrbitalVelocity | Target::Sun)
    }

    /// The attitude `q_es` relative to the target, which `input` defines.
    pub fn error(self, q_es: [f64; 4], input: &TargetInput<'_>) -> AttitudeError {
        let TargetInput { geometry, to_go, orbit } = *input;
        // fixed in F_e, or on an orbit to the axis
        let fixed = |geometry: &LaunchGeometry, direction: [f64; 3]| pointing(q_es, direction, geometry.turn());
        match (self, geometry) {
            (Target::Attitude(q_et), _) => {
                AttitudeError { q_ts: hamilton(conjugate(q_et), q_es), ..AttitudeError::NONE }
            }
            (Target::Orbital(q_os), _) => orbit.map_or(AttitudeError::NONE, |orbit| {
                let (q_eo, omega_oe_e) = orbit.local_frame();
                AttitudeError {
                    q_ts: hamilton(conjugate(hamilton(q_eo, q_os)), q_es),
                    omega_te_s: transposed_product(dcm_from_quaternion(q_es), omega_oe_e),
                }
            }),
            (Target::Nadir, _) => orbit.map_or(AttitudeError::NONE, |OrbitMotion { r_e, v_e, .. }| {
                pointing(q_es, scaled(-1.0, r_e), turn_of(r_e, v_e))
            }),
            (Target::OrbitalVelocity, _) => {
                orbit.map_or(AttitudeError::NONE, |OrbitMotion { v_e, a_e, .. }| pointing(q_es, v_e, turn_of(v_e, a_e)))
            }
            // it turns by 2e-7 rad/s
            (Target::Sun, _) => orbit.map_or(AttitudeError::NONE, |orbit| pointing(q_es, orbit.sun_e, [0.0; 3])),
            (Target::LineToDebris, Some(geometry)) => {
                let line = geometry.to_debris;
                // the spacecraft moves with the relative velocity, and the line against it
                let change = geometry.inertial_change(line, scaled(-1.0, geometry.relative_velocity));
                pointing(q_es, line, turn_of(line, change))
            }
            (Target::LaunchAxis, Some(geometry)) => fixed(geometry, geometry.axis),
            (Target::Transfer | Target::Stop, Some(_)) => {
                pointing(q_es, to_go.velocity_e, turn_of(to_go.velocity_e, to_go.change_e))
            }
            (Target::Velocity, Some(geometry)) => fixed(geometry, geometry.relative_velocity),
            _ => AttitudeError::NONE,
        }
    }
}

/// The angular velocity of the direction of `vector`, whose derivative is `change`, rad/s.
fn turn_of(vector: [f64; 3], change: [f64; 3]) -> [f64; 3] {
    let square = dot(vector, vector);
    if square == 0.0 { [0.0; 3] } else { scaled(1.0 / square, cross(vector, change)) }
}

/// The attitude relative to the one that points s3 along `direction` (F_e, any length) by the shortest rotation, and
/// turns at `turn` (rad/s, F_e).
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
    use crate::control::rotation::vector_of;
    use crate::control::vector::{difference, product, sum};
    use crate::scene::Epoch;

    const NO_IMPULSE: VelocityToGo = VelocityToGo { velocity_e: [0.0; 3], change_e: [0.0; 3] };
    const NOTHING: TargetInput<'_> = TargetInput { geometry: None, to_go: &NO_IMPULSE, orbit: None };

    /// Law: without error s3 points at the central body and, where the whole attitude is wanted, the axes are those of
    /// the orbital frame as turned; what the target turns by is how its attitude changes along the orbit.
    #[test]
    fn targets_of_an_orbit_turn_with_it() {
        let mu = 3.986e14;
        let (r_e, v_e) = ([7e6, 1e5, -2e5], [200.0, 5_000.0, 5_700.0]);
        let pull = scaled(-mu / norm(r_e).powi(3), r_e);
        // two-body motion to second order
        let at = |time: f64| {
            let r_e = sum(sum(r_e, scaled(time, v_e)), scaled(0.5 * time * time, pull));
            let epoch = Epoch::parse("2026-06-21T09:00:00Z");
            let scene = Orbit { mu, position: r_e, velocity: v_e, body_radius: 0.0, j2: None, epoch };
            TargetInput { orbit: Some(OrbitMotion::of(&scene, time, r_e, sum(v_e, scaled(time, pull)))), ..NOTHING }
        };
        // at the solstice the Sun is over the tropic, where the ecliptic is highest
        let solstice = [0.0, libm::cos(0.40909), libm::sin(0.40909)];
        let q_os = quaternion_of([0.2, -0.5, 0.3]);
        for (target, q_es) in [
            (Target::Orbital(q_os), [1.0, 0.0, 0.0, 0.0]),
            (Target::Nadir, quaternion_of([0.5, 2.0, 0.1])),
            (Target::OrbitalVelocity, quaternion_of([-0.5, 0.3, 0.1])),
            (Target::Sun, quaternion_of([-0.5, 1.3, 0.1])),
        ] {
            let error = target.error(q_es, &at(0.0));
            let q_et = hamilton(q_es, conjugate(error.q_ts));
            // at the target there is no error, and s3 points where it must
            assert!(target.error(q_et, &at(0.0)).angle() < 1e-14);
            let wished = match target {
                Target::OrbitalVelocity => scaled(1.0 / norm(v_e), v_e),
                Target::Sun => at(0.0).orbit.expect("an orbit").sun_e,
                _ => scaled(-1.0 / norm(r_e), r_e),
            };
            let in_target = transposed_product(dcm_from_quaternion(q_et), wished);
            let wanted = match target {
                Target::Orbital(q_os) => transposed_product(dcm_from_quaternion(q_os), [0.0, 0.0, 1.0]),
                _ => [0.0, 0.0, 1.0],
            };
            assert!(norm(difference(in_target, wanted)) < 1e-14, "{in_target:?}");
            // q_et(t)' q_et(t + h) is the rotation by omega_te h; of nadir the part across it
            let h = 1e-2;
            let moved = [-h, h].map(|time| target.error(q_et, &at(time)).q_ts);
            let slope = scaled(-0.5 / h, difference(vector_of(moved[1]), vector_of(moved[0])));
            let rate = target.error(q_et, &at(0.0)).omega_te_s;
            // a year's turn of the Sun, 2e-7 rad/s, is left out
            let bound = if target == Target::Sun { 2.1e-7 } else { 1e-9 };
            assert!(norm(difference(slope, rate)) < bound, "{target:?}: {slope:?} for {rate:?}");
            assert_eq!(norm(rate) > 1e-4, target != Target::Sun);
        }
        // within a day of the solstice: 1 deg along the ecliptic
        assert!(norm(difference(at(0.0).orbit.expect("an orbit").sun_e, solstice)) < 0.02);
        let orbit = at(0.0).orbit.expect("an orbit");
        let (q_eo, _) = orbit.local_frame();
        let [ahead, across] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|axis| product(dcm_from_quaternion(q_eo), axis));
        assert!(dot(ahead, v_e) > 0.9 * norm(v_e) && dot(across, cross(r_e, v_e)) < 0.0);
        assert!(dot(across, r_e).abs() < 1e-8 && dot(across, v_e).abs() < 1e-11);
    }
}
