//! [`Target`]: the attitude that a phase wants; [`AttitudeError`]: the attitude relative to it.

use super::vector::norm;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Rate control only.
    None,
    /// Inertial attitude q_et, F_t -> F_e, scalar first.
    Attitude([f64; 4]),
    /// Attitude q_os relative to the local orbital frame, F_s -> F_o, scalar first.
    Orbital([f64; 4]),
    /// s3 to the central body.
    Nadir,
    /// s3 along the orbital velocity.
    OrbitalVelocity,
    /// s3 to the Sun.
    Sun,
    /// s3 to the debris.
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

/// Names of the targets in campaign files; an attitude has its own key.
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

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeError {
    /// Attitude of F_s relative to the target, scalar first.
    pub q_ts: [f64; 4],
    /// Angular velocity of the target relative to F_e, in F_s.
    pub omega_te_s: [f64; 3],
}

impl AttitudeError {
    pub const NONE: AttitudeError = AttitudeError { q_ts: [1.0, 0.0, 0.0, 0.0], omega_te_s: [0.0; 3] };

    /// Angle of the shorter rotation to the target, rad.
    pub fn angle(&self) -> f64 {
        let [w, x, y, z] = self.q_ts;
        2.0 * libm::atan2(norm([x, y, z]), w.abs())
    }
}

impl Target {
    /// True if the debris defines it.
    pub fn needs_debris(self) -> bool {
        !matches!(self, Target::None | Target::Attitude(_)) && !self.needs_orbit()
    }

    /// True if the orbit defines it.
    pub fn needs_orbit(self) -> bool {
        matches!(self, Target::Orbital(_) | Target::Nadir | Target::OrbitalVelocity | Target::Sun)
    }
}
