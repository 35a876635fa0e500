//! `[orbit]`: the orbit of the spacecraft's centre of mass about the Earth.

use super::rows::rows;
use crate::scene::epoch::Epoch;

rows! {
    /// An orbit, given by position and velocity or by Keplerian elements at time zero.
    pub struct OrbitInput in OrbitInput [table => table] {
    mu_m3_s2: f64 = 3.986004418e14, "m^3/s^2", "Gravitational parameter of the central body", Positive;
    body_radius_m: f64 = 6_378_137.0, "m", "Radius of the central body; the orbit must stay above it", NotNegative;
    j2: Option<f64> = None, "1",
        "Second zonal harmonic of the central body, relative to body_radius_m; if omitted, the body is a point mass",
        NotNegative;
    position_m: Option<[f64; 3]> = None, "m", "Position of the centre of mass from the central body, in F_e", Finite;
    velocity_m_s: Option<[f64; 3]> = None, "m/s", "Velocity of the centre of mass relative to F_e, in F_e", Finite;
    semi_major_axis_m: Option<f64> = None, "m", "Semi-major axis", Positive;
    eccentricity: Option<f64> = None, "1", "Eccentricity; 0 if omitted", NotNegative;
    inclination_rad: Option<f64> = None, "rad", "Inclination to the e1-e2 plane; 0 if omitted", Finite;
    ascending_node_rad: Option<f64> = None, "rad", "Angle from e1 to the ascending node; 0 if omitted", Finite;
    argument_of_periapsis_rad: Option<f64> = None, "rad",
        "Angle from the ascending node to the periapsis; 0 if omitted", Finite;
    true_anomaly_rad: Option<f64> = None, "rad", "Angle from the periapsis to the spacecraft; 0 if omitted", Finite;
    } others {
        /// The date at time zero, UTC.
        epoch: Option<Epoch> = None,
    }
}

impl OrbitInput {
    /// The keys of position and velocity.
    pub const VECTORS: [&'static str; 2] = ["position_m", "velocity_m_s"];

    /// The keys of Keplerian elements, of which the first is required.
    pub const ELEMENTS: [&'static str; 6] = [
        "semi_major_axis_m",
        "eccentricity",
        "inclination_rad",
        "ascending_node_rad",
        "argument_of_periapsis_rad",
        "true_anomaly_rad",
    ];
}
