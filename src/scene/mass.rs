//! Mass properties of the bodies and of the spacecraft as a whole.

/// Mass properties of a rigid body in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass from the frame's origin, m (for the fuselage from p in F_s; zero for the debris).
    pub center: [f64; 3],
    /// Inertia tensor about the centre of mass, in the body's frame, kg m^2, by rows.
    pub inertia: [[f64; 3]; 3],
}

/// A balanced axisymmetric wheel, fixed with its centre and axis in the fuselage. A missing wheel has mass and inertia zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheel {
    /// Mass, kg.
    pub mass: f64,
    /// Centre from p in F_s, m.
    pub center: [f64; 3],
    /// Unit spin axis in F_s.
    pub axis: [f64; 3],
    /// Moment of inertia about the spin axis, kg m^2.
    pub axial: f64,
    /// Moment of inertia about any axis through the centre across the spin axis, kg m^2.
    pub transverse: f64,
}

/// Mass properties of all bodies and of the spacecraft S + W1 + W2 as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// The fuselage S.
    pub fuselage: Body,
    /// The wheels W1, W2.
    pub wheels: [Wheel; 2],
    /// The debris D, if present.
    pub debris: Option<Body>,
    /// Mass m of the spacecraft, kg.
    pub total: f64,
    /// Centre of mass c of the spacecraft from p in F_s, m.
    pub center: [f64; 3],
    /// Inertia J of the spacecraft about c with wheels locked, F_s, kg m^2, by rows.
    pub inertia: [[f64; 3]; 3],
    /// J* = J - J_1 a1 a1^T - J_2 a2 a2^T, kg m^2, by rows: what resists a change of omega when the wheels turn freely.
    pub inertia_free: [[f64; 3]; 3],
}
