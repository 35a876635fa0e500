//! [`DrawnColumns`]: what a figure shows of drawn samples: the dispersed numbers, and angles in place of the components
//! of attitudes.

use crate::campaign::Plan;
use crate::ensemble::DrawnScenes;
use crate::report::expected_counts::Asked;
use crate::report::marginal;
use crate::sampling::{Joint, Transform};

/// Components of a quaternion, the only parameter with so many.
const QUATERNION: usize = 4;

/// Angles are rounding where none is larger, deg: an axis of their own would make noise look like a distribution.
const ROUNDING_DEG: f64 = 1e-6;

/// Columns of drawn samples. An attitude has the angle of its rotation from the nominal one and the tilt of its axis 3,
/// each only where it is more than rounding.
#[derive(Clone, Debug)]
pub struct DrawnColumns<'p> {
    pub names: Vec<String>,
    /// The parameter that each is of, with its unit; both empty of an angle, which its name has.
    pub parameters: Vec<(String, String)>,
    pub nominal: Vec<f64>,
    /// The distribution that was asked for, where a column has one that is known.
    pub asked: Vec<Option<Asked<'p>>>,
    pub drawn: DrawnScenes,
}

impl<'p> DrawnColumns<'p> {
    /// Those of the samples `drawn` of `plan`.
    pub fn new(plan: &'p Plan, drawn: &DrawnScenes) -> Self {
        let empty = DrawnScenes { columns: Vec::new(), mass: Vec::new(), ..drawn.clone() };
        let mut shown = DrawnColumns {
            names: Vec::new(),
            parameters: Vec::new(),
            nominal: Vec::new(),
            asked: Vec::new(),
            drawn: empty,
        };
        let columns = plan.dispersions.columns();
        let mut index = 0;
        while let Some(column) = columns.get(index) {
            let group = columns[index..].iter().take_while(|other| other.parameter == column.parameter).count();
            if column.parameter.width() == QUATERNION && group == QUATERNION {
                let nominal: [f64; QUATERNION] = std::array::from_fn(|k| columns[index + k].nominal);
                let of_sample =
                    |sample: usize| angles(nominal, std::array::from_fn(|k| drawn.columns[index + k][sample]));
                let [turn, tilt]: [Vec<f64>; 2] =
                    [0, 1].map(|which| (0..drawn.count()).map(|sample| of_sample(sample)[which]).collect());
                let name = column.parameter.name();
                let is_uniform = matches!(
                    plan.dispersions.distribution_of(index),
                    Some(Transform::Joint(Joint::UniformAttitude(_)))
                );
                let [of_turn, of_tilt] = if is_uniform {
                    [Asked::UniformRotation, Asked::UniformTilt].map(Some)
                } else {
                    let columns: [usize; QUATERNION] = std::array::from_fn(|k| index + k);
                    [0, 1].map(|which| {
                        marginal::of_columns(plan, &columns, |q| angles(nominal, [q[0], q[1], q[2], q[3]])[which])
                    })
                };
                for (what, asked, values) in
                    [("rotation from nominal", of_turn, turn), ("tilt of axis 3", of_tilt, tilt)]
                {
                    if values.iter().any(|angle| *angle >= ROUNDING_DEG) {
                        shown.push(format!("{name}: {what} / deg"), Default::default(), 0.0, asked, values);
                    }
                }
                index += QUATERNION;
                continue;
            }
            let name = column.parameter.component_name(column.component);
            let unit = if column.parameter.unit() == "1" { "" } else { column.parameter.unit() };
            let parameter = (column.parameter.name(), unit.to_owned());
            shown.push(name, parameter, column.nominal, marginal::of_column(plan, index), drawn.columns[index].clone());
            index += 1;
        }
        shown
    }

    fn push(
        &mut self,
        name: String,
        parameter: (String, String),
        nominal: f64,
        asked: Option<Asked<'p>>,
        values: Vec<f64>,
    ) {
        self.names.push(name);
        self.parameters.push(parameter);
        self.nominal.push(nominal);
        self.asked.push(asked);
        self.drawn.columns.push(values);
    }
}

/// The angle of the rotation from the attitude `from` to `to`, and the angle between their third axes, deg. Quaternions
/// with the scalar first.
fn angles(from: [f64; QUATERNION], to: [f64; QUATERNION]) -> [f64; 2] {
    let ([a, b, c, d], [w, x, y, z]) = (from, to);
    // from^-1 to
    let scalar = a * w + b * x + c * y + d * z;
    let [x, y, z] = [a * x - b * w - c * z + d * y, a * y - c * w - d * x + b * z, a * z - d * w - b * y + c * x];
    let turn = 2.0 * libm::atan2(libm::sqrt(x * x + y * y + z * z), scalar.abs());
    let tilt = 2.0 * libm::atan2(libm::sqrt(x * x + y * y), libm::sqrt(scalar * scalar + z * z));
    [turn.to_degrees(), tilt.to_degrees()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Overrides;
    use crate::sampling::SampleId;

    /// Law: an attitude that is turned about its axis 3 has no column of tilts, which are rounding; one turned by
    /// nothing has none at all.
    #[test]
    fn what_is_rounding_has_no_column() {
        let names = |axis: &str, std: &str| {
            let text = format!(
                "[campaign]\nname = \"x\"\nsamples = 20\nseed = 1\nduration_s = 1\n[body]\nmass_kg = \
                1\ncenter_of_mass_m = [0, 0, 0]\n\
                 inertia_kg_m2 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n[initial]\nattitude = [0.5, 0.5, -0.5, \
                 0.5]\nangular_velocity_rad_s = [0, 0, 1]\n\
                 [[disperse]]\nparameter = \"initial.attitude\"\ndistribution = \"about_axis\"\naxis = {axis}\n\
                 angle_rad = {{ distribution = \"normal\", std = {std} }}\n"
            );
            let plan = Plan::from_text("x.toml", &text, Overrides::default()).expect("a campaign");
            DrawnColumns::new(&plan, &DrawnScenes::new(&plan, SampleId(1), plan.samples)).names
        };
        let [turn, tilt] =
            ["rotation from nominal", "tilt of axis 3"].map(|what| format!("initial.attitude: {what} / deg"));
        assert_eq!(names("[0, 0, 1]", "0.1"), std::slice::from_ref(&turn));
        assert_eq!(names("[0, 1, 1]", "0.1"), [turn.clone(), tilt.clone()]);
        assert_eq!(names("[0, 1, 1]", "1e-7"), [turn, tilt], "small, and no rounding");
        assert!(names("[0, 0, 1]", "1e-12").is_empty());
    }

    /// Known: a rotation by 60 degrees about the third axis does not tilt it; one about the first axis does, from any
    /// attitude; the sign of a quaternion is none of the attitude.
    #[test]
    fn known_angles() {
        let (half, root) = (0.5, libm::sqrt(0.75));
        for (to, tilt) in
            [([root, 0.0, 0.0, half], 0.0), ([root, half, 0.0, 0.0], 60.0), ([-root, -half, 0.0, 0.0], 60.0)]
        {
            for from in [[1.0, 0.0, 0.0, 0.0], [half, -half, half, half]] {
                let ([a, b, c, d], [w, x, y, z]) = (from, to);
                let product = [
                    a * w - b * x - c * y - d * z,
                    a * x + b * w + c * z - d * y,
                    a * y + c * w + d * x - b * z,
                    a * z + d * w + b * y - c * x,
                ];
                let [turned, tilted] = angles(from, product);
                // a few roundings of degrees; none is measured
                assert!((turned - 60.0).abs() < 1e-13 * 60.0 && (tilted - tilt).abs() < 1e-12, "{turned} {tilted}");
            }
        }
    }
}
