//! A magnetometer: the field of `[environment]` at the true position in F_s, with noise, bias, scale errors and
//! misalignment, without the fields of rods and wheels. Filters compare it with the field on the nominal orbit.

use std::sync::{Arc, Mutex, PoisonError};

use super::sensor::{AXES, NormalErrors, Sensor, SensorMaker, XYZ, axes};
use crate::control::truth::Truth;
use crate::dynamics::magnetic_field::MagneticField;
use crate::dynamics::surroundings::Window;
use crate::loops::declared::declared;
use crate::loops::kinds::{MeasuredQuantity, Need, SensorKind};
use crate::loops::measurement::{Values, part, values};
use crate::loops::observes::{AttitudeInnovation, AttitudeSensor, Innovation, Observes};
use crate::loops::vector::{
    cross, dcm_from_quaternion, diagonal, dot, from_s3_to, multiplied, quaternion_of, sum, transposed,
    transposed_product,
};
use crate::scene::schema::Limit;

pub(super) const KIND: SensorMaker = SensorMaker {
    kind: SensorKind {
        name: "magnetometer",
        parameters: &PARAMETERS,
        quantities: &[MeasuredQuantity::new(
            "measured_field_s",
            XYZ,
            ["T", "t"],
            "Magnetic field measured by a magnetometer, in F_s",
        )],
        observes: Observes::Field(|table, nominal| {
            let field = MagneticField::of(nominal).and_then(|_| Window::of(nominal)).map(Mutex::new);
            Arc::new(Believed { field, noise: MagnetometerNumbers::of(table).noise })
        }),
        needs: Some(Need {
            is_met: |scene| scene.environment.magnetic_field.is_some(),
            refusal: [
                "another kind where [environment] has no magnetic_field",
                "add magnetic_field = \"igrf\" to [environment], or delete this table",
            ],
        }),
        replaced_by_epoch: None,
    },
    make: |context| {
        let numbers = MagnetometerNumbers::of(context.parameters);
        Box::new(Magnetometer {
            field: MagneticField::of(context.drawn),
            along: Window::of(context.drawn).filter(|_| context.drawn.offsets.is_none()),
            numbers,
            c_sm: dcm_from_quaternion(quaternion_of(numbers.misalignment)),
            noise: context.normal("noise", AXES),
        })
    },
};

declared! {
    MagnetometerNumbers = PARAMETERS {
        noise: [f64; 3] = axes("noise_t", "T", "Standard deviation of each component", Limit::NotNegative);
        bias: [f64; 3] = axes("bias_t", "T", "Constant error of each component", Limit::Finite);
        scale: [f64; 3] = axes("scale", "1", "Ratio of measured to true component along each of its axes",
            Limit::Finite).or(&[1.0; 3]);
        misalignment: [f64; 3] = axes("misalignment_rad", "rad", "Rotation vector from the body to its axes, in F_s",
            Limit::Finite);
    }
}

/// A filter's magnetometer: the field on the nominal orbit, without fixed errors.
#[derive(Debug)]
struct Believed {
    /// `None` without a field: no information.
    field: Option<Mutex<Window>>,
    noise: [f64; 3],
}

impl AttitudeSensor for Believed {
    /// The innovation across the measured field m, as in [`super::two_angles`]: e_i = b_i . (m - B) = -b_i . B for two
    /// unit vectors b across m and the estimated field B in F_s, whose length does not depend on the attitude. With B'
    /// = B x d for a small attitude error d, b . (B x d) = (b x B) . d.
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation {
        let at = |field: &Mutex<Window>| field.lock().unwrap_or_else(PoisonError::into_inner).field(time);
        let field_e = self.field.as_ref().map_or([0.0; 3], at);
        let field_s = transposed_product(dcm_from_quaternion(q_es), field_e);
        let [across, other, _] = transposed(&from_s3_to(part(values, 0)));
        let across = [across, other];
        let variances = diagonal(self.noise.map(|sigma| sigma * sigma));
        AttitudeInnovation::Two(Innovation {
            value: across.map(|b| -dot(b, field_s)),
            sensitivity: across.map(|b| cross(b, field_s)),
            covariance: multiplied(&multiplied(&across, &variances), &transposed(&across)),
        })
    }
}

struct Magnetometer {
    field: Option<MagneticField<f64>>,
    /// The field along an orbit that the spacecraft does not leave.
    along: Option<Window>,
    numbers: MagnetometerNumbers,
    /// Its axes -> F_s.
    c_sm: [[f64; 3]; 3],
    noise: NormalErrors<3>,
}

impl Sensor for Magnetometer {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let field = self.field?;
        let field_e = match &mut self.along {
            Some(along) => along.field(truth.time),
            None => field.at_point(truth.time, truth.body.r_co_e),
        };
        let field_s = transposed_product(dcm_from_quaternion(truth.body.q_es), field_e);
        let [x, y, z] = transposed_product(self.c_sm, field_s);
        let [along_x, along_y, along_z] = self.numbers.scale;
        let errors = sum(self.numbers.bias, self.noise.scaled(count, self.numbers.noise));
        Some(values(&[&sum([along_x * x, along_y * y, along_z * z], errors)]))
    }
}
