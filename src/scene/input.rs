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

/// The debris: a solid homogeneous cube or box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DebrisInput {
    /// Shape and size.
    pub shape: DebrisShape,
    /// Density, kg/m^3.
    pub density_kg_m3: f64,
}

/// How the size of the debris was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DebrisShape {
    /// A cube, by its side.
    Cube {
        /// Side l_d, m.
        side_m: f64,
    },
    /// A box, by its three sides along d1, d2, d3.
    Box {
        /// Sides, m.
        size_m: [f64; 3],
    },
}

impl DebrisShape {
    /// The three sides along d1, d2, d3, m.
    pub fn size_m(self) -> [f64; 3] {
        match self {
            DebrisShape::Cube { side_m } => [side_m; 3],
            DebrisShape::Box { size_m } => size_m,
        }
    }
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
