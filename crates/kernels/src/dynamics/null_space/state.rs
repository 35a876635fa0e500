//! Layout of the state, and Sigma (59), the full state from the measurable one.

use crate::math::prelude::*;
use crate::scene::Scene;

/// A DCM by columns: `columns[j]` is C e_j.
pub type Columns = [[f64; 3]; 3];

/// Coordinates of a body: position and DCM.
pub const PER_BODY: usize = 12;

/// Number of coordinates q with `wheels` wheels: fuselage, wheels, debris.
pub const fn coordinates(wheels: usize) -> usize {
    PER_BODY * (2 + wheels)
}

/// Number of reduced speeds nu-hat with `wheels` wheels.
pub const fn speeds(wheels: usize) -> usize {
    12 + wheels
}

/// Number of states x = [q; nu-hat] (41) with `wheels` wheels; 62 with Berdoz's two.
pub const fn states(wheels: usize) -> usize {
    coordinates(wheels) + speeds(wheels)
}

/// Number of integrated components with `wheels` wheels: states, work of thrusters and motors, impulse (3), angular
/// impulse (3), wheel angles.
pub const fn components(wheels: usize) -> usize {
    states(wheels) + 8 + wheels
}

/// Position and attitude of a body, or their rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position of the body's point (p, g_i, g_d) in F_e, m.
    pub position: [f64; 3],
    /// C_eb by columns.
    pub dcm: Columns,
}

/// The state with `W` wheels. Frames and units as in [`crate::scene::InitialState`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const W: usize> {
    /// The fuselage: p and C_es.
    pub fuselage: Pose,
    /// The wheels: g_i and C_ew.
    pub wheels: [Pose; W],
    /// The debris: g_d and C_ed.
    pub debris: Pose,
    /// v_p in F_e, m/s.
    pub v_p: [f64; 3],
    /// omega^se in F_s, rad/s.
    pub omega_s: [f64; 3],
    /// Wheel rates, rad/s.
    pub wheel_rates: [f64; W],
    /// v_gd in F_e, m/s.
    pub v_gd: [f64; 3],
    /// omega^de in F_d, rad/s.
    pub omega_d: [f64; 3],
    /// Work of the thrusters and of the wheel motors, J.
    pub work: [f64; 2],
    /// Impulse in F_e, N s.
    pub impulse: [f64; 3],
    /// Angular impulse about c in F_e, N m s.
    pub angular_impulse: [f64; 3],
    /// Wheel angles, not wrapped, rad; the wheels' DCMs lack whole turns.
    pub wheel_angles: [f64; W],
}

#[inline(always)]
fn part<const K: usize>(x: &[f64], start: usize) -> [f64; K] {
    let mut part = [0.0; K];
    part.copy_from_slice(&x[start..start + K]);
    part
}

impl Pose {
    #[inline(always)]
    fn read(x: &[f64], body: usize) -> Self {
        let start = PER_BODY * body;
        Pose { position: part(x, start), dcm: [part(x, start + 3), part(x, start + 6), part(x, start + 9)] }
    }

    #[inline(always)]
    fn write(&self, x: &mut [f64], body: usize) {
        let start = PER_BODY * body;
        x[start..start + 3].copy_from_slice(&self.position);
        for j in 0..3 {
            x[start + 3 + 3 * j..start + 6 + 3 * j].copy_from_slice(&self.dcm[j]);
        }
    }
}

impl<const W: usize> State<W> {
    /// Number of bodies.
    pub const BODIES: usize = 2 + W;
    /// Number of states.
    pub const STATES: usize = states(W);
    /// Index of v_p, omega_s, the wheel rates, v_gd and omega_d.
    const SPEED: [usize; 5] = {
        let first = coordinates(W);
        [first, first + 3, first + 6, first + 6 + W, first + 9 + W]
    };
    const INTEGRAL: [usize; 4] = [states(W), states(W) + 2, states(W) + 5, states(W) + 8];

    /// From the vector of components.
    #[inline(always)]
    pub fn from_components<const N: usize>(x: &[f64; N]) -> Self {
        const { assert!(N == components(W), "as many components as the wheels make") }
        let [v_p, omega_s, wheel_rates, v_gd, omega_d] = Self::SPEED;
        let [work, impulse, angular_impulse, wheel_angles] = Self::INTEGRAL;
        let fuselage = Pose::read(x, 0);
        let mut wheels = [fuselage; W];
        for (w, wheel) in wheels.iter_mut().enumerate() {
            *wheel = Pose::read(x, 1 + w);
        }
        State {
            fuselage,
            wheels,
            debris: Pose::read(x, 1 + W),
            v_p: part(x, v_p),
            omega_s: part(x, omega_s),
            wheel_rates: part(x, wheel_rates),
            v_gd: part(x, v_gd),
            omega_d: part(x, omega_d),
            work: part(x, work),
            impulse: part(x, impulse),
            angular_impulse: part(x, angular_impulse),
            wheel_angles: part(x, wheel_angles),
        }
    }

    /// The vector of components; also of a derivative.
    #[inline(always)]
    pub fn components<const N: usize>(&self) -> [f64; N] {
        const { assert!(N == components(W), "as many components as the wheels make") }
        let [v_p, omega_s, wheel_rates, v_gd, omega_d] = Self::SPEED;
        let [work, impulse, angular_impulse, wheel_angles] = Self::INTEGRAL;
        let mut x = [0.0; N];
        self.fuselage.write(&mut x, 0);
        for (w, wheel) in self.wheels.iter().enumerate() {
            wheel.write(&mut x, 1 + w);
        }
        self.debris.write(&mut x, 1 + W);
        macro_rules! write {
            ($($field:ident)+) => { $(x[$field..$field + self.$field.len()].copy_from_slice(&self.$field);)+ };
        }
        write!(v_p omega_s wheel_rates v_gd omega_d work impulse angular_impulse wheel_angles);
        x
    }
}

/// Sigma (59): the full state from the measurable one. C_ew = C_es C_sw(angle) (42), (43); wheel centres r_p + C_es
/// z_i. A missing wheel is at p and moves with the fuselage.
pub fn sigma<const W: usize>(scene: &Scene) -> State<W> {
    let initial = &scene.initial;
    let c_es = transposed(dcm_from_quaternion(initial.q_es));
    let fuselage = Pose { position: initial.r_po_e, dcm: c_es };
    let mut state = State {
        fuselage,
        wheels: [fuselage; W],
        debris: Pose { position: initial.r_gdo_e, dcm: transposed(dcm_from_quaternion(initial.q_ed)) },
        v_p: initial.v_po_e,
        omega_s: initial.omega_se_s,
        wheel_rates: part(&initial.wheel_rates, 0),
        v_gd: initial.v_gdo_e,
        omega_d: initial.omega_de_d,
        work: [0.0; 2],
        impulse: [0.0; 3],
        angular_impulse: [0.0; 3],
        wheel_angles: part(&initial.wheel_angles, 0),
    };
    for (i, wheel) in scene.mass.wheels.iter().enumerate() {
        let c_sw = wheel_columns(wheel.axis, initial.wheel_angles[i]);
        state.wheels[i] = Pose {
            position: sum(initial.r_po_e, transposed_product(c_es, wheel.center)),
            dcm: c_sw.map(|column| transposed_product(c_es, column)),
        };
    }
    state
}

/// C_sw of a wheel turned by `angle` about the unit axis `axis`, by columns: transposes of C_2 and C_3 in (42), (43).
fn wheel_columns(axis: [f64; 3], angle: f64) -> Columns {
    let (sine, cosine) = libm::sincos(angle);
    let [x, y, z] = axis;
    let rows = [[cosine, -(sine * z), sine * y], [sine * z, cosine, -(sine * x)], [-(sine * y), sine * x, cosine]];
    let versine = 1.0 - cosine;
    std::array::from_fn(|j| std::array::from_fn(|i| (versine * axis[i]).mul_add(axis[j], rows[i][j])))
}

#[inline(always)]
pub(super) fn transposed(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [[m[0][0], m[1][0], m[2][0]], [m[0][1], m[1][1], m[2][1]], [m[0][2], m[1][2], m[2][2]]]
}

#[inline(always)]
pub(super) fn rotated(c: Columns, v: [f64; 3]) -> [f64; 3] {
    transposed_product(c, v)
}

#[inline(always)]
pub(super) fn rotated_back(c: Columns, v: [f64; 3]) -> [f64; 3] {
    product(c, v)
}
