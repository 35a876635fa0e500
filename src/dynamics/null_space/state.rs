//! The layout of the state, and Sigma (59), which makes it from the measurable state.

use crate::math::vector::{dcm_from_quaternion, product, sum, transposed_product};
use crate::scene::Scene;

/// A DCM by columns: `columns[j]` is C e_j.
pub type Columns = [[f64; 3]; 3];

/// Coordinates q.
pub const COORDINATES: usize = 48;
/// Reduced speeds nu-hat.
pub const SPEEDS: usize = 14;
/// States x = [q; nu-hat] (41).
pub const STATES: usize = COORDINATES + SPEEDS;
/// Quadrature states: thruster work, motor work, impulse (3), angular impulse (3), alpha, beta.
pub const INTEGRALS: usize = 10;
/// Everything that is integrated.
pub const COMPONENTS: usize = STATES + INTEGRALS;

/// The bodies, in the order of q.
pub const BODIES: usize = 4;
/// Coordinates per body: position and DCM.
pub const PER_BODY: usize = 12;

/// The state by its parts. Frames and units as in [`crate::scene::InitialState`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Positions of p, g1, g2, g_d in F_e, m.
    pub position: [[f64; 3]; BODIES],
    /// C_es, C_ea, C_eb, C_ed by columns.
    pub dcm: [Columns; BODIES],
    /// v_p in F_e, m/s.
    pub v_p: [f64; 3],
    /// omega^se in F_s, rad/s.
    pub omega_s: [f64; 3],
    /// alpha-dot, beta-dot, rad/s.
    pub wheel_rates: [f64; 2],
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
    /// alpha, beta, not wrapped, rad: the wheels' DCMs determine them only up to whole turns.
    pub wheel_angles: [f64; 2],
}

#[inline(always)]
fn three(x: &[f64; COMPONENTS], start: usize) -> [f64; 3] {
    [x[start], x[start + 1], x[start + 2]]
}

impl State {
    /// From the vector of components.
    #[inline(always)]
    pub fn from_components(x: &[f64; COMPONENTS]) -> Self {
        let column = |body: usize, j: usize| three(x, PER_BODY * body + 3 + 3 * j);
        let body = |b: usize| [column(b, 0), column(b, 1), column(b, 2)];
        State {
            position: [three(x, 0), three(x, PER_BODY), three(x, 2 * PER_BODY), three(x, 3 * PER_BODY)],
            dcm: [body(0), body(1), body(2), body(3)],
            v_p: three(x, 48),
            omega_s: three(x, 51),
            wheel_rates: [x[54], x[55]],
            v_gd: three(x, 56),
            omega_d: three(x, 59),
            work: [x[62], x[63]],
            impulse: three(x, 64),
            angular_impulse: three(x, 67),
            wheel_angles: [x[70], x[71]],
        }
    }

    /// The vector of components; also of a derivative, which has the same layout.
    #[inline(always)]
    pub fn components(&self) -> [f64; COMPONENTS] {
        let mut x = [0.0; COMPONENTS];
        for body in 0..BODIES {
            let start = PER_BODY * body;
            x[start..start + 3].copy_from_slice(&self.position[body]);
            for j in 0..3 {
                x[start + 3 + 3 * j..start + 6 + 3 * j].copy_from_slice(&self.dcm[body][j]);
            }
        }
        x[48..51].copy_from_slice(&self.v_p);
        x[51..54].copy_from_slice(&self.omega_s);
        x[54..56].copy_from_slice(&self.wheel_rates);
        x[56..59].copy_from_slice(&self.v_gd);
        x[59..62].copy_from_slice(&self.omega_d);
        x[62..64].copy_from_slice(&self.work);
        x[64..67].copy_from_slice(&self.impulse);
        x[67..70].copy_from_slice(&self.angular_impulse);
        x[70..72].copy_from_slice(&self.wheel_angles);
        x
    }
}

/// Sigma (59): the full state from the measurable one.
///
/// C_es and C_ed from their quaternions; C_ea = C_es C_sa(alpha), C_eb = C_es C_sb(beta) (42), (43); wheel centres
/// r_p + C_es z_i; the integrals start at zero, the angles at their initial values.
pub fn sigma(scene: &Scene) -> State {
    let initial = &scene.initial;
    let c_es = transposed(dcm_from_quaternion(initial.q_es));
    let mut state = State {
        position: [initial.r_po_e, initial.r_po_e, initial.r_po_e, initial.r_gdo_e],
        dcm: [c_es, c_es, c_es, transposed(dcm_from_quaternion(initial.q_ed))],
        v_p: initial.v_po_e,
        omega_s: initial.omega_se_s,
        wheel_rates: initial.wheel_rates,
        v_gd: initial.v_gdo_e,
        omega_d: initial.omega_de_d,
        work: [0.0; 2],
        impulse: [0.0; 3],
        angular_impulse: [0.0; 3],
        wheel_angles: initial.wheel_angles,
    };
    for (i, wheel) in scene.mass.wheels.iter().enumerate() {
        state.position[i + 1] = sum(initial.r_po_e, transposed_product(c_es, wheel.center));
        let c_sw = wheel_columns(wheel.axis, initial.wheel_angles[i]);
        state.dcm[i + 1] = c_sw.map(|column| transposed_product(c_es, column));
    }
    state
}

/// C_sw of a wheel that has turned by `angle` about the unit axis `axis`, by columns: the transposes of C_2 and C_3 in (42), (43).
///
/// At angle zero the wheel's frame is F_s, whatever the alignment error of the axis: so the axis has the same components in both
/// frames at any angle.
fn wheel_columns(axis: [f64; 3], angle: f64) -> Columns {
    let (sine, cosine) = libm::sincos(angle);
    let [x, y, z] = axis;
    let rows = [[cosine, -(sine * z), sine * y], [sine * z, cosine, -(sine * x)], [-(sine * y), sine * x, cosine]];
    let versine = 1.0 - cosine;
    std::array::from_fn(|j| std::array::from_fn(|i| (versine * axis[i]).mul_add(axis[j], rows[i][j])))
}

/// Rows to columns and back.
#[inline(always)]
pub(super) fn transposed(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [[m[0][0], m[1][0], m[2][0]], [m[0][1], m[1][1], m[2][1]], [m[0][2], m[1][2], m[2][2]]]
}

/// C v of a DCM by columns.
#[inline(always)]
pub(super) fn rotated(c: Columns, v: [f64; 3]) -> [f64; 3] {
    transposed_product(c, v)
}

/// C^T v of a DCM by columns.
#[inline(always)]
pub(super) fn rotated_back(c: Columns, v: [f64; 3]) -> [f64; 3] {
    product(c, v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::samples;

    #[test]
    fn components_and_state_are_the_same_thing() {
        let x: [f64; COMPONENTS] = std::array::from_fn(|i| i as f64 + 0.5);
        assert_eq!(State::from_components(&x).components(), x);
    }

    #[test]
    fn sigma_turns_wheels_as_the_report_has_it() {
        let mut input = samples::table_two();
        input.initial.wheel_angles_rad = [0.3, -0.7];
        let scene = Scene::resolve(&input).expect("a legal scene");
        let state = sigma(&scene);
        let (sa, ca) = libm::sincos(0.3);
        let (sb, cb) = libm::sincos(-0.7);
        // C_as = C_2(alpha) by rows is C_sa by columns
        let c2 = [[ca, 0.0, -sa], [0.0, 1.0, 0.0], [sa, 0.0, ca]];
        let c3 = [[cb, sb, 0.0], [-sb, cb, 0.0], [0.0, 0.0, 1.0]];
        for (columns, expected) in [(state.dcm[1], c2), (state.dcm[2], c3)] {
            for i in 0..3 {
                for j in 0..3 {
                    assert!((columns[i][j] - expected[i][j]).abs() < 1e-15);
                }
            }
        }
        assert_eq!(state.position[1], [0.0, 0.0, 1.0]);
        assert_eq!(state.position[2], [0.0, 0.0, 2.0]);
    }
}
