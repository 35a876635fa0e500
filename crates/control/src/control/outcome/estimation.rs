//! Estimation errors ([`EstimateErrors`]), and their ratio to the filters' covariances ([`Consistency`]).

use crate::control::estimators::delayed::Innovations;
use crate::control::estimators::estimator::{Confidence, Covariance, FILTERS, Filters};
use crate::control::estimators::kalman::{NormalizedSquare, corners, normalized_square};
use crate::control::truth::Truth;
use crate::loops::estimate::{DebrisState, Estimate};
use crate::loops::vector::{conjugate, difference, hamilton, norm, vector_of};

/// The relative ones are NaN without debris.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimateErrors {
    pub attitude: f64,
    pub rate: f64,
    /// Magnitude of the error in position relative to the debris, m.
    pub relative_position: f64,
    /// Magnitude of the error in velocity relative to the debris, m/s.
    pub relative_velocity: f64,
}

impl EstimateErrors {
    pub const NONE: EstimateErrors =
        EstimateErrors { attitude: 0.0, rate: 0.0, relative_position: 0.0, relative_velocity: 0.0 };

    pub fn of(estimate: &Estimate, truth: &Truth) -> Self {
        let body = &truth.body;
        let relative = |own: [[f64; 3]; 2], debris: fn(&DebrisState) -> [f64; 3]| {
            let pair = estimate.debris.as_ref().zip(truth.debris.as_ref());
            pair.map_or(f64::NAN, |(believed, actual)| {
                norm(difference(difference(own[0], own[1]), difference(debris(believed), debris(actual))))
            })
        };
        EstimateErrors {
            attitude: norm(vector_of(hamilton(conjugate(estimate.q_es), body.q_es))),
            rate: norm(difference(estimate.omega_se_s, body.omega_se_s)),
            relative_position: relative([estimate.r_co_e, body.r_co_e], |debris| debris.r_gdo_e),
            relative_velocity: relative([estimate.v_co_e, body.v_co_e], |debris| debris.v_gdo_e),
        }
    }
}

/// Squares are per degree of freedom, 1 on average for a consistent filter; NaN without one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Consistency {
    /// By filter: normalised squares of errors (NEES) and of this tick's innovations, and the mean of the latter since
    /// the start.
    pub squares: [[f64; 3]; FILTERS],
    /// Root mean square errors expected from the covariances: attitude (rad), rate (rad/s), and position (m) and
    /// velocity (m/s) relative to the debris.
    pub expected: [f64; 4],
}

impl Consistency {
    pub const NONE: Consistency = Consistency { squares: [[f64::NAN; 3]; FILTERS], expected: [f64::NAN; 4] };

    /// Consistency of `filters` and `estimate` with `truth` at one tick; `gyro_bias_s` is the true bias, rad/s, if
    /// there is a gyro.
    pub fn of(filters: &Filters, estimate: &Estimate, truth: &Truth, gyro_bias_s: Option<[f64; 3]>) -> Self {
        let per_degree = |square: NormalizedSquare| square.value / square.degrees as f64;
        let squares = std::array::from_fn(|place| match &filters[place] {
            None => [f64::NAN; 3],
            Some(Confidence { covariance, innovations: Innovations { of_tick, sum, count } }) => {
                let error = error_square(covariance, place, estimate, (truth, gyro_bias_s));
                let [error, innovation] = [error, *of_tick].map(|square| square.map_or(f64::NAN, per_degree));
                [error, innovation, if *count > 0.0 { sum / count } else { f64::NAN }]
            }
        });
        Consistency { squares, expected: expected(filters) }
    }
}

/// NEES of the filter at `place` in [`Filters`]; `None` without debris or if the covariance is not positive definite.
fn error_square(
    covariance: &Covariance,
    place: usize,
    estimate: &Estimate,
    (truth, gyro_bias_s): (&Truth, Option<[f64; 3]>),
) -> Option<NormalizedSquare> {
    // attitude, rate, position and velocity
    let of_debris = |debris: &DebrisState| (debris.q_ed, [debris.omega_de_d, debris.r_gdo_e, debris.v_gdo_e]);
    let of_body = |body: &Estimate| (body.q_es, [body.omega_se_s, body.r_co_e, body.v_co_e]);
    let (believed, actual) = if place >= FILTERS / 2 {
        (of_debris(estimate.debris.as_ref()?), of_debris(truth.debris.as_ref()?))
    } else {
        (of_body(estimate), of_body(&truth.state()))
    };
    let turn = vector_of(hamilton(conjugate(believed.0), actual.0));
    let [rate, r, v] = std::array::from_fn(|i| difference(actual.1[i], believed.1[i]));
    let joined = |[x, y, z]: [f64; 3], [u, v, w]: [f64; 3]| [x, y, z, u, v, w];
    match covariance {
        Covariance::AttitudeAndBias { covariance, .. } => match gyro_bias_s {
            Some(bias) => normalized_square(covariance, joined(turn, difference(bias, estimate.gyro_bias_s))),
            None => normalized_square(&corners(covariance)[0], turn),
        },
        Covariance::AttitudeAndRate(covariance) => normalized_square(covariance, joined(turn, rate)),
        Covariance::Motion(covariance) => {
            NormalizedSquare::sum((0..3).map(|axis| normalized_square(covariance, [r[axis], v[axis]])))
        }
    }
}

/// [`Consistency::expected`]: variances of spacecraft and debris add.
fn expected(filters: &Filters) -> [f64; 4] {
    let covariance = |place: usize| filters[place].as_ref().map(|filter| &filter.covariance);
    let root = |covariance: [[f64; 3]; 3], more: f64| (0..3).map(|i| covariance[i][i] + more).sum::<f64>().sqrt();
    let [attitude, rate] = match covariance(0) {
        Some(Covariance::AttitudeAndBias { covariance, rate_variance }) => {
            let [of_turn, _, of_bias] = corners(covariance);
            [root(of_turn, 0.0), root(of_bias, *rate_variance)]
        }
        Some(Covariance::AttitudeAndRate(covariance)) => {
            let [of_turn, _, of_rate] = corners(covariance);
            [root(of_turn, 0.0), root(of_rate, 0.0)]
        }
        _ => [f64::NAN; 2],
    };
    let [position, velocity] = match (covariance(1), covariance(2)) {
        (Some(Covariance::Motion(own)), Some(Covariance::Motion(other))) => {
            [0, 1].map(|part| (3.0 * (own[part][part] + other[part][part])).sqrt())
        }
        _ => [f64::NAN; 2],
    };
    [attitude, rate, position, velocity]
}
