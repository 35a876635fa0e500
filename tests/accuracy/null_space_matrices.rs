//! Berdoz's matrices as printed (and corrected), dense and slow. Rows of nu are, per body, [velocity in F_e, angular
//! velocity in the body's frame]; of nu-hat [v_p, omega_s, alpha-dot, beta-dot, v_gd, omega_d].

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use spindrift::dynamics::null_space::{
    self,
    state::{PER_BODY, coordinates, speeds},
};

const WHEELS: usize = 2;
pub type State = null_space::State<WHEELS>;
pub type Parameters = null_space::Parameters<WHEELS>;
pub type Kernel = null_space::Kernel<WHEELS>;

pub const BODIES: usize = State::BODIES;
pub const COORDINATES: usize = coordinates(WHEELS);
pub const SPEEDS: usize = speeds(WHEELS);
pub const COMPONENTS: usize = null_space::components(WHEELS);
pub const FULL_SPEEDS: usize = 24;

pub fn reduced_speeds(state: &State) -> SVector<f64, SPEEDS> {
    SVector::from_column_slice(&state.components::<COMPONENTS>()[COORDINATES..COORDINATES + SPEEDS])
}

pub fn skew(r: Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -r.z, r.y, r.z, 0.0, -r.x, -r.y, r.x, 0.0)
}

fn dcm(state: &State, body: usize) -> Matrix3<f64> {
    let pose = match body {
        0 => &state.fuselage,
        body if body <= WHEELS => &state.wheels[body - 1],
        _ => &state.debris,
    };
    Matrix3::from_columns(&pose.dcm.map(Vector3::from))
}

fn rows(m: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| m[i][j])
}

fn omega(state: &State, parameters: &Parameters, body: usize) -> Vector3<f64> {
    let nu = pi(parameters, state) * reduced_speeds(state);
    nu.fixed_rows::<3>(6 * body + 3).into_owned()
}

/// Gamma (9), (51)-(54): q-dot = Gamma nu; per body 1 over the position and S (68) over the columns of the DCM.
pub fn gamma(state: &State) -> SMatrix<f64, COORDINATES, FULL_SPEEDS> {
    let mut gamma: SMatrix<f64, COORDINATES, FULL_SPEEDS> = SMatrix::zeros();
    for body in 0..BODIES {
        let (row, column) = (PER_BODY * body, 6 * body);
        gamma.fixed_view_mut::<3, 3>(row, column).fill_with_identity();
        for j in 0..3 {
            // C (omega x e_j) = -C e_j^x omega
            let s = -dcm(state, body) * skew(Matrix3::identity().column(j).into_owned());
            gamma.fixed_view_mut::<3, 3>(row + 3 + 3 * j, column + 3).copy_from(&s);
        }
    }
    gamma
}

/// Pi (58): nu = Pi nu-hat.
pub fn pi(parameters: &Parameters, state: &State) -> SMatrix<f64, FULL_SPEEDS, SPEEDS> {
    let mut pi: SMatrix<f64, FULL_SPEEDS, SPEEDS> = SMatrix::zeros();
    let one = Matrix3::identity();
    let c_es = dcm(state, 0);
    pi.fixed_view_mut::<3, 3>(0, 0).copy_from(&one);
    pi.fixed_view_mut::<3, 3>(3, 3).copy_from(&one);
    for (w, wheel) in parameters.wheels.iter().enumerate() {
        let row = 6 * (w + 1);
        pi.fixed_view_mut::<3, 3>(row, 0).copy_from(&one);
        pi.fixed_view_mut::<3, 3>(row, 3).copy_from(&(-c_es * skew(wheel.center.into())));
        pi.fixed_view_mut::<3, 3>(row + 3, 3).copy_from(&(dcm(state, w + 1).transpose() * c_es));
        pi.fixed_view_mut::<3, 1>(row + 3, 6 + w).copy_from(&Vector3::from(wheel.axis));
    }
    pi.fixed_view_mut::<3, 3>(18, 8).copy_from(&one);
    pi.fixed_view_mut::<3, 3>(21, 11).copy_from(&one);
    pi
}

/// Pi-dot: C_es-dot = C_es omega_s^x, C_ws-dot = -(Omega a)^x C_ws.
pub fn pi_dot(parameters: &Parameters, state: &State) -> SMatrix<f64, FULL_SPEEDS, SPEEDS> {
    let mut pi_dot: SMatrix<f64, FULL_SPEEDS, SPEEDS> = SMatrix::zeros();
    let c_es = dcm(state, 0);
    for (w, wheel) in parameters.wheels.iter().enumerate() {
        let row = 6 * (w + 1);
        let c_es_dot = c_es * skew(state.omega_s.into());
        let turning = skew(Vector3::from(wheel.axis) * state.wheel_rates[w]);
        pi_dot.fixed_view_mut::<3, 3>(row, 3).copy_from(&(-c_es_dot * skew(wheel.center.into())));
        pi_dot.fixed_view_mut::<3, 3>(row + 3, 3).copy_from(&(-turning * dcm(state, w + 1).transpose() * c_es));
    }
    pi_dot
}

/// M: the four 6x6 blocks; the fuselage's has the first moment c_s beside its diagonal.
pub fn mass(parameters: &Parameters, state: &State) -> SMatrix<f64, FULL_SPEEDS, FULL_SPEEDS> {
    let mut m: SMatrix<f64, FULL_SPEEDS, FULL_SPEEDS> = SMatrix::zeros();
    let c = skew(parameters.fuselage_first.into());
    let c_es = dcm(state, 0);
    m.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-c_es * c));
    m.fixed_view_mut::<3, 3>(3, 0).copy_from(&(c * c_es.transpose()));
    let blocks = [
        (parameters.fuselage_mass, parameters.fuselage_inertia),
        (parameters.wheels[0].mass, parameters.wheels[0].inertia),
        (parameters.wheels[1].mass, parameters.wheels[1].inertia),
        (parameters.debris_mass, parameters.debris_inertia),
    ];
    for (body, (mass, inertia)) in blocks.into_iter().enumerate() {
        let at = 6 * body;
        m.fixed_view_mut::<3, 3>(at, at).copy_from(&(Matrix3::identity() * mass));
        m.fixed_view_mut::<3, 3>(at + 3, at + 3).copy_from(&rows(inertia));
    }
    m
}

/// M-dot: only the fuselage's first moment turns.
pub fn mass_dot(parameters: &Parameters, state: &State) -> SMatrix<f64, FULL_SPEEDS, FULL_SPEEDS> {
    let mut m: SMatrix<f64, FULL_SPEEDS, FULL_SPEEDS> = SMatrix::zeros();
    let c = skew(parameters.fuselage_first.into());
    let c_es_dot = dcm(state, 0) * skew(state.omega_s.into());
    m.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-c_es_dot * c));
    m.fixed_view_mut::<3, 3>(3, 0).copy_from(&(c * c_es_dot.transpose()));
    m
}

/// Omega: diag(0, omega_b^x) per body.
pub fn omega_matrix(parameters: &Parameters, state: &State) -> SMatrix<f64, FULL_SPEEDS, FULL_SPEEDS> {
    let mut m: SMatrix<f64, FULL_SPEEDS, FULL_SPEEDS> = SMatrix::zeros();
    for body in 0..BODIES {
        m.fixed_view_mut::<3, 3>(6 * body + 3, 6 * body + 3).copy_from(&skew(omega(state, parameters, body)));
    }
    m
}

/// a_non = Gamma^T (dT/dq)^T: the fuselage's `sign` (C_es^T v_p)^x c_s^x omega_s; the correct sign is +1.
pub fn a_non(parameters: &Parameters, state: &State, sign: f64) -> SVector<f64, FULL_SPEEDS> {
    let mut a: SVector<f64, FULL_SPEEDS> = SVector::zeros();
    let w = dcm(state, 0).transpose() * Vector3::from(state.v_p);
    let c_omega = skew(parameters.fuselage_first.into()) * Vector3::from(state.omega_s);
    a.fixed_rows_mut::<3>(3).copy_from(&(skew(w) * c_omega * sign));
    a
}

/// B (26), (72)-(74): forces and torques per unit of (P1, P2, P3, tau^W1, tau^W2).
pub fn actuation(parameters: &Parameters, state: &State) -> SMatrix<f64, FULL_SPEEDS, 5> {
    let mut b: SMatrix<f64, FULL_SPEEDS, 5> = SMatrix::zeros();
    for (thruster, applied) in parameters.thrusters.iter().enumerate() {
        let direction = Vector3::from(applied.direction);
        let torque = skew(applied.position.into()) * direction;
        b.fixed_view_mut::<3, 1>(0, thruster).copy_from(&(dcm(state, 0) * direction));
        b.fixed_view_mut::<3, 1>(3, thruster).copy_from(&torque);
    }
    for (w, wheel) in parameters.wheels.iter().enumerate() {
        let axis = Vector3::from(wheel.axis);
        b.fixed_view_mut::<3, 1>(3, 3 + w).copy_from(&-axis);
        b.fixed_view_mut::<3, 1>(6 * (w + 1) + 3, 3 + w).copy_from(&axis);
    }
    b
}

/// M-hat = Pi^T M Pi (25), with unit rows and columns for a missing or speed-held wheel.
pub fn reduced_mass(parameters: &Parameters, state: &State) -> SMatrix<f64, SPEEDS, SPEEDS> {
    let pi = pi(parameters, state);
    let mut m = pi.transpose() * mass(parameters, state) * pi;
    for (w, wheel) in parameters.wheels.iter().enumerate() {
        m.row_mut(6 + w).scale_mut(wheel.free);
        m.column_mut(6 + w).scale_mut(wheel.free);
        m[(6 + w, 6 + w)] += wheel.idle;
    }
    m
}

/// f-hat_non + f-hat (39) under u = (P1, P2, P3, tau^W1, tau^W2); zero for a held wheel.
pub fn reduced_force(parameters: &Parameters, state: &State, inputs: [f64; 5], sign: f64) -> SVector<f64, SPEEDS> {
    let (pi, nu_hat) = (pi(parameters, state), reduced_speeds(state));
    let nu = pi * nu_hat;
    let m = mass(parameters, state);
    let inertial = mass_dot(parameters, state) * nu
        + m * (pi_dot(parameters, state) * nu_hat)
        + omega_matrix(parameters, state) * (m * nu);
    let applied = actuation(parameters, state) * SVector::from(inputs);
    let mut force = pi.transpose() * (a_non(parameters, state, sign) - inertial + applied);
    for (w, wheel) in parameters.wheels.iter().enumerate() {
        force[6 + w] *= wheel.free;
    }
    force
}

/// The derivative `rate` of `state` with a-hat_non,s of the sign printed in section XVIII.
pub fn with_printed_sign(parameters: &Parameters, state: &State, rate: &State) -> State {
    let change = a_non(parameters, state, -1.0) - a_non(parameters, state, 1.0);
    let force = pi(parameters, state).transpose() * change;
    let speeds = reduced_mass(parameters, state).cholesky().unwrap().solve(&force);
    let mut components: [f64; COMPONENTS] = rate.components();
    for (component, change) in components[COORDINATES..COORDINATES + SPEEDS].iter_mut().zip(speeds.iter()) {
        *component += change;
    }
    State::from_components(&components)
}
