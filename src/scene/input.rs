//! [`SceneInput`]: a scene as a person writes it, number by number, before anything is derived or checked.
//!
//! This is what a campaign file holds and what a dispersion changes: plain SI numbers, no serde. [`super::Scene::resolve`]
//! turns it into a [`super::Scene`] or says why it is not physical.

/// A scene as written: bodies, initial state, actuation.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneInput {
    /// The fuselage S.
    pub fuselage: FuselageInput,
    /// The wheels W1 (axis s2) and W2 (axis s3); `None` where the spacecraft has no such wheel.
    pub wheels: [Option<WheelInput>; 2],
    /// The debris body D, if there is one.
    pub debris: Option<DebrisInput>,
    /// The state at time zero.
    pub initial: InitialInput,
    /// Stretches of constant thrust and torque, in order and not overlapping.
    pub actuation: Vec<ActuationInput>,
    /// What the actuators make of it.
    pub actuators: ActuatorsInput,
}

impl SceneInput {
    /// Whether anything does work on the spacecraft: a schedule, or a motor that holds its wheel's speed.
    pub fn is_actuated(&self) -> bool {
        let is_held = |wheel: &Option<WheelInput>| wheel.is_some_and(|wheel| wheel.mode == WheelMode::SpeedHeld);
        !self.actuation.is_empty() || self.wheels.iter().any(is_held)
    }
}

/// The fuselage: a hollow cylinder with closed ends, axis s3, base centre at the origin p of F_s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FuselageInput {
    /// Wall thickness t_s of shell and end plates, m.
    pub wall_thickness_m: f64,
    /// Outer radius rho_o, m.
    pub outer_radius_m: f64,
    /// Outer length l_s, m.
    pub length_m: f64,
    /// Density sigma_s of the wall, kg/m^3.
    pub density_kg_m3: f64,
    /// Distance rho_p of the thrusters P2 and P3 from the axis, m.
    pub thruster_offset_m: f64,
    /// Mass instead of the one that geometry gives, kg.
    pub mass_kg: Option<f64>,
    /// Centre of mass from p in F_s instead of the one that geometry gives, m.
    pub center_of_mass_m: Option<[f64; 3]>,
    /// Inertia tensor about the fuselage's own centre of mass in F_s instead of the one that geometry gives, kg m^2, by rows.
    pub inertia_kg_m2: Option<[[f64; 3]; 3]>,
    /// The same inertia by principal moments and axes; at most one of the two is given.
    pub principal: Option<PrincipalInertia>,
    /// How the true distribution of mass differs from all of the above.
    pub errors: MassErrors,
}

/// An inertia about the centre of mass by principal moments and axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalInertia {
    /// The moments.
    pub moments: PrincipalMoments,
    /// Attitude of the principal frame: quaternion that maps its components to the body's, scalar first.
    pub axes: [f64; 4],
}

/// How principal moments were written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PrincipalMoments {
    /// Moments of inertia J_1, J_2, J_3, kg m^2: none above the sum of the other two.
    Inertia([f64; 3]),
    /// Second moments of mass P_i, the integrals of x_i^2 dm, kg m^2: J_1 = P_2 + P_3 and so on, so that any positive three are
    /// the inertia of some body.
    Second([f64; 3]),
}

/// How a distribution of mass differs from the nominal one: the same matter, moved by a linear map about the centre of mass, with another
/// mass, at another place.
///
/// The second moments of mass about the centre become S' = k A S A^T with k = `mass_scale` and A lower triangular, exp(`stretch_log`)
/// on its diagonal and `shear` below: positive definite whatever the numbers, and so is always the inertia of a body. If S = L L^T
/// then S' = k (A L)(A L)^T: these are the coordinates of the log-Cholesky form (C. Rucker & P. M. Wensing, *Smooth
/// Parameterization of Rigid-Body Inertia*, IEEE Robotics and Automation Letters 7(2), 2022) about the nominal body, and with
/// mass and centre of mass they couple all ten numbers of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassErrors {
    /// Factor k of all masses, pure.
    pub mass_scale: f64,
    /// Logarithms of the stretches along s1, s2, s3, pure.
    pub stretch_log: [f64; 3],
    /// Shears xy, xz, yz, pure: what stands at x moves by xy x along s2 and by xz x along s3, what stands at y by yz y along s3.
    pub shear: [f64; 3],
    /// Offset of the centre of mass, in F_s, m.
    pub center_offset_m: [f64; 3],
}

impl MassErrors {
    /// No difference.
    pub const NONE: MassErrors =
        MassErrors { mass_scale: 1.0, stretch_log: [0.0; 3], shear: [0.0; 3], center_offset_m: [0.0; 3] };
}

impl Default for MassErrors {
    fn default() -> Self {
        Self::NONE
    }
}

/// A wheel: a solid balanced cylinder that spins about an axis through its centre, which is fixed in the fuselage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelInput {
    /// Radius, m.
    pub radius_m: f64,
    /// Length along the spin axis, m.
    pub length_m: f64,
    /// Station z of the wheel's centre along s3, from p, m.
    pub station_m: f64,
    /// Density, kg/m^3.
    pub density_kg_m3: f64,
    /// Offset of the wheel's centre from the axis s3, along s1 and s2, m.
    pub offset_m: [f64; 2],
    /// Alignment error of the spin axis: the rotation vector, in F_s, rad, that turns the nominal axis (s2 of W1, s3 of W2) into
    /// the true one; its two components across the nominal axis, (s1, s3) of W1, (s1, s2) of W2.
    pub tilt_rad: [f64; 2],
    /// What the wheel does when no torque is scheduled for it.
    pub mode: WheelMode,
}

/// What a wheel does when no torque is scheduled for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WheelMode {
    /// It turns freely in its bearing: its absolute axial momentum h_i is constant, and J* resists a change of omega.
    #[default]
    Free,
    /// Its motor keeps its rate relative to the fuselage at the initial value with whatever torque that takes: its momentum
    /// relative to the fuselage, J_i Omega_i, is constant, and its axial inertia resists a change of omega with the rest.
    SpeedHeld,
}

impl WheelMode {
    /// All values.
    pub const ALL: [WheelMode; 2] = [WheelMode::Free, WheelMode::SpeedHeld];

    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        match self {
            WheelMode::Free => "free",
            WheelMode::SpeedHeld => "speed_held",
        }
    }

    /// The mode called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.name() == name)
    }
}

/// The debris: a solid homogeneous cube or box, or any rigid body; its centre of mass is the origin of F_d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DebrisInput {
    /// A cube, by its side.
    Cube {
        /// Side l_d, m.
        side_m: f64,
        /// Density, kg/m^3.
        density_kg_m3: f64,
    },
    /// A box, by its three sides along d1, d2, d3.
    Box {
        /// Sides, m.
        size_m: [f64; 3],
        /// Density, kg/m^3.
        density_kg_m3: f64,
    },
    /// An irregular body, by its inertia tensor.
    Tensor {
        /// Mass, kg.
        mass_kg: f64,
        /// Inertia tensor about the centre of mass in F_d, kg m^2, by rows.
        inertia_kg_m2: [[f64; 3]; 3],
    },
    /// An irregular body, by its principal moments and axes.
    Principal {
        /// Mass, kg.
        mass_kg: f64,
        /// Moments, and the attitude of the principal frame in F_d.
        principal: PrincipalInertia,
    },
}

/// The measurable state at time zero (the report's Sigma, (59), builds the full state from it).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialInput {
    /// Position of p from the inertial origin, in F_e, m.
    pub position_m: [f64; 3],
    /// Velocity of p relative to F_e, in F_e, m/s.
    pub velocity_m_s: [f64; 3],
    /// Attitude quaternion q_es, F_s -> F_e, scalar first.
    pub attitude: [f64; 4],
    /// Angular velocity omega^se, in F_s, rad/s.
    pub angular_velocity_rad_s: [f64; 3],
    /// Wheel angles alpha, beta, rad.
    pub wheel_angles_rad: [f64; 2],
    /// Wheel rates alpha-dot, beta-dot relative to the fuselage, rad/s.
    pub wheel_rates_rad_s: [f64; 2],
    /// Position of the debris's centre from the inertial origin, in F_e, m.
    pub debris_position_m: [f64; 3],
    /// Velocity of the debris's centre relative to F_e, in F_e, m/s.
    pub debris_velocity_m_s: [f64; 3],
    /// Attitude quaternion q_sd of the debris, F_d -> F_s, scalar first.
    pub debris_attitude: [f64; 4],
    /// Angular velocity omega^ds of the debris relative to the spacecraft, in F_d, rad/s.
    pub debris_relative_angular_velocity_rad_s: [f64; 3],
}

/// What the actuators make of what the schedule commands; as a whole, for all of its stretches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorsInput {
    /// Factors of the thrusts P1, P2, P3, pure; never negative.
    pub thrust_scale: [f64; 3],
    /// Misalignment of P1: components along s1 and s2 of the rotation vector that turns the nominal direction of its thrust into
    /// the true one, rad.
    pub thruster1_tilt_rad: [f64; 2],
    /// The same of P2.
    pub thruster2_tilt_rad: [f64; 2],
    /// The same of P3.
    pub thruster3_tilt_rad: [f64; 2],
    /// How much later than commanded stretches start, s. One that would start before the run starts with it.
    pub switch_on_delay_s: f64,
    /// How much later than commanded stretches end, s. Where one stretch starts as another ends there is one switch, which is late
    /// by `switch_on_delay_s`.
    pub switch_off_delay_s: f64,
    /// Factors of the motor torques, pure.
    pub torque_scale: [f64; 2],
    /// What a motor gives beyond that while a torque other than zero is commanded, N m.
    pub torque_bias_n_m: [f64; 2],
}

impl ActuatorsInput {
    /// Actuators that do as they are told.
    pub const IDEAL: ActuatorsInput = ActuatorsInput {
        thrust_scale: [1.0; 3],
        thruster1_tilt_rad: [0.0; 2],
        thruster2_tilt_rad: [0.0; 2],
        thruster3_tilt_rad: [0.0; 2],
        switch_on_delay_s: 0.0,
        switch_off_delay_s: 0.0,
        torque_scale: [1.0; 2],
        torque_bias_n_m: [0.0; 2],
    };

    /// The misalignments of P1, P2, P3, rad.
    pub fn tilts_rad(&self) -> [[f64; 2]; 3] {
        [self.thruster1_tilt_rad, self.thruster2_tilt_rad, self.thruster3_tilt_rad]
    }
}

impl Default for ActuatorsInput {
    fn default() -> Self {
        Self::IDEAL
    }
}

/// A stretch of constant thrust and torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuationInput {
    /// Start, s.
    pub start_s: f64,
    /// End, s.
    pub end_s: f64,
    /// Thrusts P1, P2, P3, N; never negative.
    pub thrust_n: [f64; 3],
    /// Motor torques tau^W1, tau^W2 on the wheels, N m.
    pub torque_n_m: [f64; 2],
}
