//! `[initial]`: the state at time zero.

use super::rows::rows;

rows! {
    /// The measurable state at time zero, from which Berdoz's Sigma (59) builds the full state.
    pub struct InitialInput in InitialInput [table => table] {
    position_m: [f64; 3] = [0.0; 3], "m",
        "Position of p from the inertial origin, in F_e; on an orbit, position of the centre of mass from the \
        reference point of the orbit", Finite;
    velocity_m_s: [f64; 3] = [0.0; 3], "m/s",
        "Velocity of p relative to F_e, in F_e; on an orbit, velocity of the centre of mass relative to the reference \
        point of the orbit", Finite;
    attitude: [f64; 4] = [1.0, 0.0, 0.0, 0.0], "1",
        "Attitude quaternion q_es, F_s -> F_e, scalar first", UnitQuaternion;
    angular_velocity_rad_s: [f64; 3] = [0.0; 3], "rad/s", "Angular velocity omega^se, in F_s", Finite;
    attitude_orbital: Option<[f64; 4]> = None, "1",
        "Attitude quaternion q_os, F_s -> F_o, the local orbital frame of the spacecraft at time zero (o3 towards the \
        central body, o2 opposite to the orbit normal), scalar first, in place of attitude", UnitQuaternion;
    angular_velocity_orbital_rad_s: Option<[f64; 3]> = None, "rad/s",
        "Angular velocity omega^so relative to the local orbital frame, in F_s, in place of angular_velocity_rad_s",
        Finite;
    debris_position_m: [f64; 3] = [0.0; 3], "m",
        "Position of the debris's centre from the inertial origin, in F_e; on an orbit, from the reference point of \
        the orbit", Finite, with debris;
    debris_velocity_m_s: [f64; 3] = [0.0; 3], "m/s",
        "Velocity of the debris's centre relative to F_e, in F_e; on an orbit, relative to the reference point of the \
        orbit", Finite, with debris;
    debris_attitude: [f64; 4] = [1.0, 0.0, 0.0, 0.0], "1",
        "Attitude quaternion q_sd of the debris, F_d -> F_s, scalar first", UnitQuaternion, with debris;
    debris_relative_angular_velocity_rad_s: [f64; 3] = [0.0; 3], "rad/s",
        "Angular velocity omega^ds of the debris relative to the spacecraft, in F_d", Finite, with debris;
    debris_attitude_inertial: Option<[f64; 4]> = None, "1",
        "Attitude quaternion q_ed of the debris, F_d -> F_e, scalar first, in place of debris_attitude",
        UnitQuaternion, with debris;
    debris_angular_velocity_rad_s: Option<[f64; 3]> = None, "rad/s",
        "Angular velocity omega^de of the debris relative to F_e, in F_d, in place of \
        debris_relative_angular_velocity_rad_s", Finite, with debris;
    } others {}
}
