//! A ground radar: positions and velocities in F_e of the base point p and of the debris's centre of mass.

use super::sensor::{AXES, NormalErrors, Sensor, SensorMaker, XYZ, optional};
use crate::control::truth::Truth;
use crate::loops::declared::declared;
use crate::loops::kinds::{MeasuredQuantity, SensorKind};
use crate::loops::measurement::{Values, values};
use crate::loops::observes::Observes;
use crate::loops::vector::sum;

pub(super) const KIND: SensorMaker = SensorMaker {
    kind: SensorKind {
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
    },
    make: |context| {
        let noise = |point: &str| PointNoise {
            position: context.normal(&format!("{point}_position"), AXES),
            velocity: context.normal(&format!("{point}_velocity"), AXES),
        };
        let numbers = RadarNumbers::of(context.parameters);
        Box::new(GroundRadar { numbers, base: noise("base"), debris: noise("debris") })
    },
};

declared! {
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

struct PointNoise {
    position: NormalErrors<3>,
    velocity: NormalErrors<3>,
}

struct GroundRadar {
    numbers: RadarNumbers,
    base: PointNoise,
    debris: PointNoise,
}

impl Sensor for GroundRadar {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let (position, velocity) = ([self.numbers.position; 3], [self.numbers.velocity; 3]);
        let measured = |noise: &mut PointNoise, r_e, v_e| {
            [sum(r_e, noise.position.scaled(count, position)), sum(v_e, noise.velocity.scaled(count, velocity))]
        };
        let point = truth.base_point();
        let base = measured(&mut self.base, point.r_e, point.v_e);
        let debris = truth.debris.map(|debris| measured(&mut self.debris, debris.r_gdo_e, debris.v_gdo_e));
        Some(values(&[base.as_flattened(), debris.as_ref().map_or(&[], |debris| debris.as_flattened())]))
    }
}
