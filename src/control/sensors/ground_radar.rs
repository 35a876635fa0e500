//! A radar on the ground: positions and velocities in F_e of the base point p and, where there is one, of the debris's
//! centre of mass.

use crate::control::declared::declared;
use crate::control::measurement::{Values, values};
use crate::control::observes::Observes;
use crate::control::sensors::sensor::{
    AXES, MeasuredQuantity, NormalErrors, Sensor, SensorContext, SensorKind, XYZ, optional,
};
use crate::control::truth::Truth;
use crate::control::vector::sum;

pub(super) const KIND: SensorKind = SensorKind {
    name: "ground_radar",
    parameters: &PARAMETERS,
    quantities: &[
        position("measured_r_po_e", "Position of p measured by the radar, in F_e"),
        velocity("measured_v_po_e", "Velocity of p measured by the radar, in F_e"),
        position("measured_r_gdo_e", "Position of the debris measured by the radar, in F_e"),
        velocity("measured_v_gdo_e", "Velocity of the debris measured by the radar, in F_e"),
    ],
    observes: Observes::Motion(|table| {
        let RadarNumbers { position, velocity } = RadarNumbers::of(table);
        [position, velocity]
    }),
    needs: None,
    replaced_by_epoch: None,
    make: |context| Box::new(GroundRadar::new(context)),
};

declared! {
    /// Its numbers in campaign files.
    RadarNumbers = PARAMETERS {
    position: f64 = optional("position_noise_m", "m", "Standard deviation of each component of a position");
    velocity: f64 = optional("velocity_noise_m_s", "m/s", "Standard deviation of each component of a velocity");
    }
}

const fn position(name: &'static str, meaning: &'static str) -> MeasuredQuantity {
    MeasuredQuantity::new(name, XYZ, ["m", "m"], meaning)
}

const fn velocity(name: &'static str, meaning: &'static str) -> MeasuredQuantity {
    MeasuredQuantity::new(name, XYZ, ["m/s", "m_s"], meaning)
}

/// Noise of one point.
struct PointNoise {
    position: NormalErrors<3>,
    velocity: NormalErrors<3>,
}

struct GroundRadar {
    /// Standard deviations of positions, m, and of velocities, m/s.
    position: f64,
    velocity: f64,
    base: PointNoise,
    debris: PointNoise,
}

impl GroundRadar {
    fn new(context: &SensorContext<'_>) -> Self {
        let noise = |point: &str| PointNoise {
            position: context.normal(&format!("{point}_position"), AXES),
            velocity: context.normal(&format!("{point}_velocity"), AXES),
        };
        let RadarNumbers { position, velocity } = RadarNumbers::of(context.parameters);
        GroundRadar { position, velocity, base: noise("base"), debris: noise("debris") }
    }
}

impl Sensor for GroundRadar {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let (position, velocity) = ([self.position; 3], [self.velocity; 3]);
        let measured = |noise: &mut PointNoise, r_e, v_e| {
            [sum(r_e, noise.position.scaled(count, position)), sum(v_e, noise.velocity.scaled(count, velocity))]
        };
        let point = truth.base_point();
        let base = measured(&mut self.base, point.r_e, point.v_e);
        let debris = truth.debris.map(|debris| measured(&mut self.debris, debris.r_gdo_e, debris.v_gdo_e));
        Some(values(&[base.as_flattened(), debris.as_ref().map_or(&[], |debris| debris.as_flattened())]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, sensor, truth};
    use crate::control::measurement::PointMotion;
    use crate::control::truth::DebrisState;
    use crate::control::vector::difference;

    /// Law: all twelve errors are normal with their deviations, and each is independent of the one before it: 4,000
    /// samples, alpha 1e-4 each, seed 5.
    #[test]
    fn the_noise_of_each_component_is_its_own() {
        let mut at = truth(0.0, [1.0, 0.0, 0.0, 0.0], [0.0; 3]);
        (at.body.r_co_e, at.body.v_co_e) = ([1.0, 2.0, 3.0], [0.1, 0.2, 0.3]);
        let debris = DebrisState {
            r_gdo_e: [30.0, 0.0, 0.0],
            v_gdo_e: [0.0, 1.0, 0.0],
            q_ed: [1.0, 0.0, 0.0, 0.0],
            omega_de_d: [0.0; 3],
        };
        at.debris = Some(debris);
        let mut radar =
            sensor("ground_radar", &[("position_noise_m", &[0.5]), ("velocity_noise_m_s", &[0.01])], 1.0, 3);
        let mut errors: [Vec<f64>; 12] = Default::default();
        for count in 0..4_000 {
            let all = radar.measure(count, &at).expect("a measurement");
            let (base, seen) = (PointMotion::of(&all, 0), PointMotion::of(&all, 6));
            let (base, seen) = (base.expect("p is seen"), seen.expect("the debris is seen"));
            let parts = [
                scaled_errors(base.r_e, at.body.r_co_e, 0.5),
                scaled_errors(base.v_e, at.body.v_co_e, 0.01),
                scaled_errors(seen.r_e, debris.r_gdo_e, 0.5),
                scaled_errors(seen.v_e, debris.v_gdo_e, 0.01),
            ];
            for (list, error) in errors.iter_mut().zip(parts.concat()) {
                list.push(error);
            }
        }
        for (index, list) in errors.iter().enumerate() {
            assert_normal(list, 1.0, 1e-4);
            let both: Vec<f64> = list.iter().zip(&errors[(index + 1) % 12]).map(|(a, b)| a + b).collect();
            assert_normal(&both, std::f64::consts::SQRT_2, 1e-4);
        }
        at.debris = None;
        let alone = radar.measure(0, &at).expect("a measurement");
        assert!(PointMotion::of(&alone, 0).is_some() && PointMotion::of(&alone, 6).is_none());
    }

    fn scaled_errors(measured: [f64; 3], real: [f64; 3], deviation: f64) -> [f64; 3] {
        difference(measured, real).map(|error| error / deviation)
    }
}
