//! Filters in their steady state, against the Riccati equation solved in another form.

use nalgebra::{Matrix2, Matrix3, Vector3};
use spindrift::control::estimators::{
    attitude_filter::AttitudeObservation,
    delayed::Filter,
    rigid_body_filter::{BodyObservation, BodyStep, MeasuredMotion, RigidBodyFilter},
    translation_filter::{MotionObservation, TranslationFilter, TranslationStep},
};
use spindrift::loops::measurement::PointMotion;

const AGREED: f64 = 1e-12;

const UPDATES: usize = 4000;

/// The covariance after an update in the steady state of position and velocity, whose velocity walks by `walk` sqrt(T)
/// and which are measured every T seconds with the informations `seen`.
fn steady(walk: f64, t: f64, seen: Matrix2<f64>) -> Matrix2<f64> {
    let transition = Matrix2::new(1.0, t, 0.0, 1.0);
    let noise = walk * walk * Matrix2::new(t * t * t / 3.0, t * t / 2.0, t * t / 2.0, t);
    let mut after = Matrix2::identity();
    for _ in 0..UPDATES {
        let before = transition * after * transition.transpose() + noise;
        after = (before.try_inverse().unwrap() + seen).try_inverse().unwrap();
    }
    after
}

fn information(sigma: f64) -> f64 {
    if sigma.is_finite() { 1.0 / (sigma * sigma) } else { 0.0 }
}

fn assert_same(found: [[f64; 2]; 2], expected: Matrix2<f64>) {
    for i in 0..2 {
        for j in 0..2 {
            let size = (expected[(i, i)] * expected[(j, j)]).sqrt();
            assert!((found[i][j] - expected[(i, j)]).abs() < AGREED * size, "{found:?} for {expected}");
        }
    }
}

/// Law: the covariance of position and velocity converges to the solution of the Riccati equation.
#[test]
fn translation_converges_to_the_riccati_solution() {
    for (walk, t, sigmas) in [(2e-3, 0.5, [0.3, 0.05]), (0.1, 2.0, [0.5, 5.0]), (1e-4, 1.0, [10.0, 0.001])] {
        let zero = PointMotion { r_e: [0.0; 3], v_e: [0.0; 3] };
        let mut filter = TranslationFilter::new(zero, [1.0, 1.0], walk, None);
        for _ in 0..UPDATES {
            filter.propagate(&TranslationStep { acceleration_e: [0.0; 3], interval: t });
            filter.update(&MotionObservation { motion: zero, sigmas }).unwrap();
        }
        let seen = Matrix2::new(information(sigmas[0]), 0.0, 0.0, information(sigmas[1]));
        assert_same(filter.covariance, steady(walk, t, seen));
    }
}

/// Law: so does that of attitude and rate of a body at rest about each axis, with and without a measured rate.
#[test]
fn a_body_at_rest_converges_to_the_riccati_solution() {
    let diagonal = |x: f64| [[x, 0.0, 0.0], [0.0, x, 0.0], [0.0, 0.0, x]];
    let rest = [1.0, 0.0, 0.0, 0.0];
    for (walk, t, sigma, of_rate) in
        [(1e-4, 0.5, 2e-3, f64::INFINITY), (1e-3, 1.0, 1e-3, 2e-3), (1e-5, 2.0, 5e-3, 1e-4)]
    {
        let inertia = [[30.0, 0.0, 0.0], [0.0, 36.0, 0.0], [0.0, 0.0, 24.0]];
        let mut filter = RigidBodyFilter::new(inertia, rest, [0.0; 3], [0.01, 0.01], walk);
        let covariance = diagonal(sigma * sigma);
        let observation = if of_rate.is_finite() {
            BodyObservation::AttitudeAndRate(MeasuredMotion {
                q: rest,
                attitude_covariance: covariance,
                omega: [0.0; 3],
                rate_covariance: diagonal(of_rate * of_rate),
            })
        } else {
            BodyObservation::Attitude(AttitudeObservation::whole(rest, covariance))
        };
        for _ in 0..UPDATES {
            filter.propagate(&BodyStep { torque: [0.0; 3], momentum: [0.0; 3], interval: t });
            filter.update(&observation).unwrap();
        }
        let expected = steady(walk, t, Matrix2::new(information(sigma), 0.0, 0.0, information(of_rate)));
        for axis in 0..3 {
            let p = filter.covariance;
            let found = [[p[axis][axis], p[axis][axis + 3]], [p[axis + 3][axis], p[axis + 3][axis + 3]]];
            assert_same(found, expected);
        }
    }
}

#[test]
fn a_spinning_body_carries_its_covariance() {
    let inertia = [[300.0, 10.0, -20.0], [10.0, 420.0, 15.0], [-20.0, 15.0, 180.0]];
    let (q, omega, h) = ([0.5, 0.5, -0.5, 0.5], [0.3, -0.2, 0.25], 1e-5);
    let step = BodyStep { torque: [1.0, -2.0, 0.5], momentum: [5.0, -12.0, 8.0], interval: 0.1 };
    let moved = |rate: [f64; 3]| {
        let mut filter = RigidBodyFilter::new(inertia, q, rate, [0.0; 2], 0.0);
        for _ in 0..10 {
            filter.propagate(&step);
        }
        Vector3::from(filter.omega)
    };
    let columns = [0, 1, 2].map(|i| {
        let apart = |by: f64| moved(std::array::from_fn(|j| omega[j] + if i == j { by } else { 0.0 }));
        (apart(h) - apart(-h)) / (2.0 * h)
    });
    let transition = Matrix3::from_columns(&columns);
    let sigma = 1e-3;
    let mut filter = RigidBodyFilter::new(inertia, q, omega, [0.0, sigma], 0.0);
    for _ in 0..10 {
        filter.propagate(&step);
    }
    let expected = sigma * sigma * transition * transition.transpose();
    let found = Matrix3::from_fn(|i, j| filter.covariance[i + 3][j + 3]);
    // a transition of second order: the third order of a step of 0.044 rad is 0.044^3/6 = 1.4e-5
    let off = (found - expected).abs().max() / expected.abs().max();
    assert!(off < 3e-5, "{off:e}: {found} for {expected}");
    assert!((transition - Matrix3::identity()).abs().max() > 0.05, "the body turns over: {transition}");
}
