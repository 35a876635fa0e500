//! A star tracker: the attitude, with noise about each axis of the body; nothing above a rate of the body.

use super::{AXES, NormalErrors, Sensor, SensorContext, SensorKind, axes, optional};
use crate::control::measurement::Measurement;
use crate::control::rotation::quaternion_of;
use crate::control::truth::Truth;
use crate::control::vector::{hamilton, norm};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

pub(super) const KIND: SensorKind = SensorKind {
    name: "star_tracker",
    has_latency: true,
    at_most_one: false,
    parameters: &PARAMETERS,
    make: |context| Box::new(StarTracker::new(context)),
};

static PARAMETERS: [LawParameter; 3] = [
    axes("noise_rad", "rad", "Standard deviation about each axis of the body", Limit::NotNegative),
    axes("bias_rad", "rad", "Constant rotation vector from the body to the body as measured", Limit::Finite),
    optional("max_rate_rad_s", "rad/s", "Rate of the body above which it gives nothing; 0: no limit"),
];

struct StarTracker {
    deviations: [f64; 3],
    /// The constant error as a quaternion.
    bias: [f64; 4],
    max_rate: f64,
    noise: NormalErrors<3>,
}

impl StarTracker {
    fn new(context: &SensorContext<'_>) -> Self {
        StarTracker {
            deviations: context.vector("noise_rad"),
            bias: quaternion_of(context.vector("bias_rad")),
            max_rate: context.number("max_rate_rad_s"),
            noise: context.normal("noise", AXES),
        }
    }
}

impl Sensor for StarTracker {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Measurement> {
        if self.max_rate > 0.0 && norm(truth.body.omega_se_s) > self.max_rate {
            return None;
        }
        let error = hamilton(self.bias, quaternion_of(self.noise.scaled(count, self.deviations)));
        Some(Measurement::Attitude { q_es: hamilton(truth.body.q_es, error), age: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, sensor, truth};
    use super::*;
    use crate::control::rotation::vector_of;
    use crate::control::vector::conjugate;

    const NOISE: [f64; 3] = [1e-5, 2e-5, 2e-4];

    /// The error of sample `count` about the axes of the body.
    fn error(tracker: &mut dyn Sensor, count: u64, q: [f64; 4], rate: f64) -> Option<[f64; 3]> {
        match tracker.measure(count, &truth(0.0, q, [0.0, rate, 0.0])) {
            Some(Measurement::Attitude { q_es, .. }) => Some(vector_of(hamilton(conjugate(q), q_es))),
            _ => None,
        }
    }

    /// Law: the error about each axis of the body is normal with its deviation, at any attitude, and axes are independent: 4,000 samples, alpha 1e-3
    /// each, seed 5.
    #[test]
    fn the_noise_is_about_the_axes_of_the_body() {
        let mut tracker = sensor("star_tracker", &[("noise_rad", &NOISE)], 0.5, 6);
        let all: Vec<[f64; 3]> = (0..4_000)
            .filter_map(|count| error(&mut *tracker, count, quaternion_of([0.01 * count as f64, 0.4, -0.3]), 0.0))
            .collect();
        assert_eq!(all.len(), 4_000);
        for axis in 0..3 {
            assert_normal(&all.iter().map(|error| error[axis]).collect::<Vec<_>>(), NOISE[axis], 1e-3);
            let next = (axis + 1) % 3;
            let both: Vec<f64> =
                all.iter().map(|error| error[axis] / NOISE[axis] + error[next] / NOISE[next]).collect();
            assert_normal(&both, std::f64::consts::SQRT_2, 1e-3);
        }
    }

    /// Law: above the largest rate nothing is measured; the noise of later samples is that without the loss. The nominal run has the bias alone.
    #[test]
    fn a_fast_body_is_not_seen() {
        let values: [(&str, &[f64]); 2] = [("noise_rad", &NOISE), ("max_rate_rad_s", &[0.03])];
        let (mut lost, mut all) = (sensor("star_tracker", &values, 0.5, 6), sensor("star_tracker", &values, 0.5, 6));
        let q = quaternion_of([0.2, 0.1, 0.0]);
        for count in 0..10 {
            let is_fast = count % 3 == 1;
            let seen = error(&mut *lost, count, q, if is_fast { 0.031 } else { 0.029 });
            let expected = error(&mut *all, count, q, 0.0);
            assert_eq!(seen, if is_fast { None } else { expected });
        }
        let mut nominal = sensor("star_tracker", &[("noise_rad", &NOISE), ("bias_rad", &[1e-3, 0.0, -2e-3])], 0.5, 0);
        let bias = error(&mut *nominal, 4, q, 0.0).expect("a measurement");
        assert!(bias.iter().zip([1e-3, 0.0, -2e-3]).all(|(a, b)| (a - b).abs() < 4e-16), "{bias:?}");
    }
}
