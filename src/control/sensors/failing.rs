//! [`FailingSensor`]: a sensor that fails at a time of the run.

use crate::control::measurement::Values;
use crate::control::sensors::sensor::{Sensor, SensorContext, SensorKind};
use crate::control::tick_times::SAME_TIME;
use crate::control::truth::Truth;
use crate::scene::{DeclaredTable, FailureInput, SensorOutput};

/// A sensor that is as it was until it fails. From the first sample at or after that time on it delivers nothing, or
/// its last measurement, or it measures with another bias and the same noise.
pub struct FailingSensor {
    sensor: Box<dyn Sensor>,
    /// The same with the bias that it has in the end, which measures from the start, so that it remembers the same.
    biased: Option<Box<dyn Sensor>>,
    at: f64,
    output: Option<SensorOutput>,
    last: Option<Values>,
    has_failed: bool,
}

impl FailingSensor {
    /// The sensor of `kind` in the run of `context`, which fails as `failure` says.
    pub fn new(kind: &SensorKind, context: &SensorContext<'_>, failure: &FailureInput) -> Self {
        let biased = failure.output.is_none().then(|| {
            let parameters = &biased(context.parameters, failure);
            (kind.make)(&SensorContext { parameters, ..*context })
        });
        FailingSensor {
            sensor: (kind.make)(context),
            biased,
            at: failure.at_s - SAME_TIME * context.period,
            output: failure.output,
            last: None,
            has_failed: false,
        }
    }
}

/// The parameters `healthy` with what `failure` adds to their bias.
fn biased(healthy: &DeclaredTable, failure: &FailureInput) -> DeclaredTable {
    let mut table = healthy.clone();
    for (key, change) in [("bias_rad_s", failure.bias_rad_s), ("bias_rad", failure.bias_rad)] {
        let place = table.declared.0.iter().position(|parameter| parameter.facts.key == key);
        if let (Some(numbers), Some(change)) = (place.and_then(|place| table.numbers_mut(place)), change) {
            numbers.iter_mut().zip(change).for_each(|(number, change)| *number += change);
        }
    }
    table
}

impl Sensor for FailingSensor {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let healthy = self.sensor.measure(count, truth);
        let biased = self.biased.as_mut().and_then(|sensor| sensor.measure(count, truth));
        self.has_failed = truth.time >= self.at;
        if !self.has_failed {
            self.last = healthy.or(self.last);
            return healthy;
        }
        match self.output {
            Some(SensorOutput::Silent) => None,
            Some(SensorOutput::Frozen) => self.last,
            None => biased,
        }
    }

    fn bias_s(&self) -> Option<[f64; 3]> {
        self.biased.as_ref().filter(|_| self.has_failed).unwrap_or(&self.sensor).bias_s()
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{table, truth};
    use super::*;
    use crate::control::measurement::part;
    use crate::control::rotation::quaternion_of;
    use crate::sampling::SampleId;
    use crate::scene::{Scene, SceneInput};

    /// What a gyro with noise measures over 20 samples about x, where it fails as `failure` says: a body that turns
    /// faster and faster.
    fn measured(failure: Option<&FailureInput>) -> Vec<Option<f64>> {
        let kind = super::super::kind("rate_gyro").expect("a kind");
        let noise: [(&str, &[f64]); 3] = [
            ("angular_random_walk_rad_sqrt_s", &[1e-3]),
            ("bias_random_walk_rad_s_sqrt_s", &[1e-4]),
            ("bias_rad_s", &[0.01, 0.02, 0.03]),
        ];
        let parameters = &table("gyro", kind.parameters, &noise);
        let drawn = &Scene::resolve(&SceneInput::report()).expect("a valid scene");
        let context = SensorContext { parameters, drawn, period: 0.1, sample: SampleId(3), seed: 5 };
        let mut sensor: Box<dyn Sensor> = match failure {
            Some(failure) => Box::new(FailingSensor::new(kind, &context, failure)),
            None => (kind.make)(&context),
        };
        let angle = |count: u64| 1e-3 * (count * count) as f64;
        let at = |count: u64| truth(0.1 * count as f64, quaternion_of([angle(count), 0.0, 0.0]), [0.0; 3]);
        (0..20).map(|count| sensor.measure(count, &at(count)).map(|values| part::<3>(&values, 0)[0])).collect()
    }

    /// Law: before its failure a sensor measures what it would have measured, bit for bit, noise included; from the
    /// first sample at that time on it is silent, or repeats the sample before, or differs by the bias over its period
    /// alone.
    #[test]
    fn a_sensor_fails_at_its_time() {
        let healthy = measured(None);
        // 0.7 is not 7 * 0.1 in binary
        for (at_s, first) in [(0.7, 7), (0.701, 8), (0.0, 0), (5.0, 20)] {
            let failure = FailureInput { at_s, ..FailureInput::DEFAULT };
            let of = |output| measured(Some(&FailureInput { output: Some(output), ..failure }));
            let [silent, frozen] = SensorOutput::ALL.map(of);
            let biased = measured(Some(&FailureInput { bias_rad_s: Some([0.5, 0.0, 0.0]), ..failure }));
            for count in 0..20 {
                if count < first {
                    assert_eq!([silent[count], frozen[count], biased[count]], [healthy[count]; 3]);
                    continue;
                }
                assert_eq!(silent[count], None);
                assert_eq!(frozen[count], if first == 0 { None } else { healthy[first - 1] });
                // none at the first sample; two ulp of the sums
                let change = healthy[count].zip(biased[count]).map(|(before, after)| after - before);
                assert!(change.is_none_or(|change| (change - 0.05).abs() < 1e-15), "{change:?}");
                assert_eq!(change.is_none(), count == 0);
            }
        }
    }
}
