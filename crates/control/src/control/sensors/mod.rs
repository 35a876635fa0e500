//! Models of sensors: from the true state to measurements. Each kind has one file and one entry in [`KINDS`].
//!
//! [`SampledSensor`] times a sensor by its own period and delivers each measurement after the latency; a [`failing`]
//! sensor wraps one that fails. Noise is addressed by the sensor's own count, hence independent of other sensors and of
//! lost measurements. The nominal run has biases, scales and misalignments but no noise.

pub mod failing;
mod ground_radar;
mod horizon_sensor;
mod magnetometer;
mod rate_gyro;
mod relative_camera;
mod sampled;
pub mod sensor;
mod star_tracker;
mod sun_sensor;
mod tachometers;
mod two_angles;

pub use sampled::SampledSensor;

pub use sensor::{NormalErrors, Sensor, SensorContext, SensorMaker};

pub static KINDS: [SensorMaker; 8] = [
    rate_gyro::KIND,
    star_tracker::KIND,
    sun_sensor::KIND,
    horizon_sensor::KIND,
    magnetometer::KIND,
    ground_radar::KIND,
    relative_camera::KIND,
    tachometers::KIND,
];
/// The names of all kinds.
pub const NAMES: [&str; KINDS.len()] = {
    let mut names = [""; KINDS.len()];
    let mut place = 0;
    while place < names.len() {
        names[place] = KINDS[place].kind.name;
        place += 1;
    }
    names
};

pub fn maker(name: &str) -> Option<&'static SensorMaker> {
    KINDS.iter().find(|maker| maker.kind.name == name)
}

#[cfg(test)]
pub(super) mod bench {
    //! Scenes, sensors and statistics for tests of sensors and estimators.

    use super::*;
    use crate::control::estimators;
    use crate::control::truth::Truth;
    use crate::dynamics::actuation::BodyState;
    use crate::math::normal;
    use crate::sampling::SampleId;
    use crate::scene::{
        DeclaredTable, EnvironmentInput, Epoch, FieldModel, MAX_WHEELS, Name, OrbitInput, Scene, SceneInput,
    };

    /// The table of a sensor or estimator of the kind `kind` with these numbers, else defaults.
    pub fn table(kind: &str, values: &[(&str, &[f64])]) -> DeclaredTable {
        let of_estimator = || estimators::maker(kind).map(|maker| maker.kind.parameters);
        let declared = super::maker(kind).map(|maker| maker.kind.parameters).or_else(of_estimator).expect("a kind");
        let mut table = DeclaredTable::of(Name::of("unit"), declared);
        for (key, numbers) in values {
            let index = declared.iter().position(|parameter| parameter.facts.key == *key).expect("a declared key");
            table.numbers_mut(index).expect("numbers").copy_from_slice(numbers);
        }
        table
    }

    /// A sensor of the kind `kind` in the run `sample`.
    pub fn sensor(kind: &str, values: &[(&str, &[f64])], period: f64, sample: u64) -> Box<dyn Sensor> {
        let (drawn, parameters) = (&on_orbit(), &table(kind, values));
        let context = SensorContext { parameters, drawn, period, sample: SampleId(sample), seed: 5 };
        (super::maker(kind).expect("a kind").make)(&context)
    }

    pub fn on_orbit() -> Scene {
        Scene::resolve(&input_on_orbit()).expect("a valid scene")
    }

    pub fn input_on_orbit() -> SceneInput {
        let epoch = Epoch::parse("2026-11-24T00:00:00Z");
        let orbit =
            OrbitInput { semi_major_axis_m: Some(7e6), inclination_rad: Some(1.7), epoch, ..OrbitInput::DEFAULT };
        let environment = EnvironmentInput { magnetic_field: Some(FieldModel::Igrf), ..EnvironmentInput::DEFAULT };
        SceneInput { orbit: Some(orbit), environment, ..SceneInput::report() }
    }

    /// A body at `time` whose centre of mass rests at the origin; no debris.
    pub fn truth(time: f64, q_es: [f64; 4], omega_se_s: [f64; 3]) -> Truth {
        Truth {
            time,
            body: BodyState { omega_se_s, q_es, r_co_e: [0.0; 3], v_co_e: [0.0; 3] },
            r_cp_s: [0.0; 3],
            wheel_rates: [0.0; MAX_WHEELS],
            debris: None,
        }
    }

    /// The quantile of chi-square with `degrees` degrees of freedom at `p`: E. B. Wilson & M. M. Hilferty, 1931; to
    /// 1e-4 above 100 degrees.
    pub fn chi_square(p: f64, degrees: f64) -> f64 {
        let spread = 2.0 / (9.0 * degrees);
        degrees * (1.0 - spread + normal::quantile(p) * spread.sqrt()).powi(3)
    }

    /// Tests that `numbers` are independent and normal with zero mean and this standard deviation, by mean and mean
    /// square at a level `alpha` each. With 4,000 numbers and alpha = 1e-3 a deviation wrong by 10% is detected with a
    /// probability above 0.999.
    pub fn assert_normal(numbers: &[f64], deviation: f64, alpha: f64) {
        let n = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / n;
        let bound = -normal::quantile(0.5 * alpha) * deviation / n.sqrt();
        assert!(mean.abs() <= bound, "mean {mean} beyond {bound}");
        let square = numbers.iter().map(|x| (x / deviation).powi(2)).sum::<f64>();
        let (low, high) = (chi_square(0.5 * alpha, n), chi_square(1.0 - 0.5 * alpha, n));
        assert!((low..=high).contains(&square), "sum of squares {square} not in {low} to {high}");
    }
}

#[cfg(test)]
mod tests {
    use super::bench::{on_orbit, sensor, table, truth};
    use super::*;
    use crate::dynamics::orbit_path::OrbitPath;
    use crate::loops::measurement::part;
    use crate::loops::observes::{AttitudeInnovation, Observes};
    use crate::loops::vector::{hamilton, norm, quaternion_of};

    /// Law: noise depends on a sample's count alone, not on lost or later samples; each run has its own noise, the
    /// nominal one none.
    #[test]
    fn noise_is_addressed_by_count() {
        let noise: [(&str, &[f64]); 1] = [("noise_rad", &[1e-3, 2e-3, 3e-3])];
        let at = truth(0.0, [1.0, 0.0, 0.0, 0.0], [0.0; 3]);
        let seen = |run, count| -> [f64; 4] {
            part(&sensor("star_tracker", &noise, 0.5, run).measure(count, &at).expect("an attitude"), 0)
        };
        let mut late = sensor("star_tracker", &noise, 0.5, 3);
        for count in [7, 19, 2, 2] {
            assert_eq!(part(&late.measure(count, &at).expect("an attitude"), 0), seen(3, count));
        }
        assert!((0..20).all(|count| seen(4, count) != seen(3, count)));
        assert_eq!(seen(0, 7), at.body.q_es);
    }

    /// Law: for every attitude sensor, the innovation at an estimate wrong by a small rotation d is H d to second
    /// order, on the nominal orbit at the time of the measurement.
    #[test]
    fn sensitivities_are_derivatives() {
        let (nominal, size) = (on_orbit(), 1e-6);
        let orbit = OrbitPath::new(nominal.orbit.as_ref().expect("an orbit"));
        let turns =
            [[0.2, -0.3, 0.1], [1.4, 0.3, 0.0], [-1.2, 0.2, 0.5], [0.3, 1.5, 0.2], [0.1, -1.3, 0.4], [2.6, 0.2, 0.1]];
        for kind in KINDS.iter().map(|maker| &maker.kind) {
            let numbers = table(kind.name, &[]);
            let model = match kind.observes {
                Observes::Attitude(model) => model(&numbers),
                Observes::Direction(model) | Observes::Field(model) => model(&numbers, &nominal),
                _ => continue,
            };
            let mut compared = 0;
            for (turn, time) in turns.iter().flat_map(|turn| [0.0, 2_000.0, 4_000.0].map(|time| (*turn, time))) {
                let q = quaternion_of(turn);
                for axis in 0..3 {
                    let mut d = [0.0; 3];
                    d[axis] = size;
                    let mut at = truth(time, hamilton(q, quaternion_of(d)), [0.0; 3]);
                    at.body.r_co_e = orbit.state(time).position;
                    let Some(seen) = sensor(kind.name, &[], 1.0, 0).measure(0, &at) else { continue };
                    let rows: Vec<(f64, [f64; 3])> = match model.innovation(&seen, q, time) {
                        AttitudeInnovation::Two(two) => two.value.into_iter().zip(two.sensitivity).collect(),
                        AttitudeInnovation::Three(three) => three.value.into_iter().zip(three.sensitivity).collect(),
                    };
                    for (value, row) in rows {
                        assert!(
                            (value / size - row[axis]).abs() < 1e-5 * norm(row),
                            "{} {turn:?} {value} {row:?}",
                            kind.name
                        );
                        compared += 1;
                    }
                }
            }
            assert!(compared >= 12, "{}: {compared}", kind.name);
        }
    }
}
