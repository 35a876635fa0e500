//! The distribution of one number that is drawn together with others: of a component of a vector, of an angle of an
//! attitude.
//!
//! It has no closed form in general: it is that of many evenly spread draws, which are not those of the campaign. The
//! rows of a table are taken one by one.

use std::sync::Arc;

use crate::campaign::Plan;
use crate::report::expected_counts::Asked;
use crate::sampling::design::sobol::Sobol;
use crate::sampling::distribution::Map;
use crate::sampling::{Joint, Transform};

/// Draws of a distribution without rows, as a Sobol design has them: beyond the resolution of a picture.
const DRAWS: u64 = 1 << 16;

/// The distribution of the column `index` of `plan`; `None` where it is not known: of a derived number, or one of a
/// table.
pub fn of_column(plan: &Plan, index: usize) -> Option<Asked<'_>> {
    if let Some(distribution) = plan.dispersions.scalar_of(index) {
        return Some(Asked::Number(distribution));
    }
    of_columns(plan, &[index], |values| values[0])
}

/// The distribution of a function of the numbers in the columns `columns` of `plan`, which are drawn together; `None`
/// where they are not.
pub fn of_columns<'p>(plan: &'p Plan, columns: &[usize], of: impl Fn(&[f64]) -> f64) -> Option<Asked<'p>> {
    let assigned = plan.dispersions.assigned_to(*columns.first()?)?;
    let Transform::Joint(joint) = &assigned.map else { return None };
    let place = |column: &usize| assigned.columns.iter().position(|other| other == column);
    let places: Vec<usize> = columns.iter().map(place).collect::<Option<_>>()?;
    Some(of_joint(joint, |values| {
        let chosen: Vec<f64> = places.iter().map(|place| values[*place]).collect();
        of(&chosen)
    }))
}

/// The distribution of a function of the values of `joint`.
fn of_joint<'p>(joint: &Joint, of: impl Fn(&[f64]) -> f64) -> Asked<'p> {
    let mut values = vec![0.0; joint.components()];
    if let Joint::Bootstrap(rows) = joint {
        let mut of_row = |row: usize| {
            rows.values_of(row, &mut values);
            of(&values)
        };
        let mut list: Vec<f64> = (0..rows.rows()).map(&mut of_row).collect();
        list.sort_by(f64::total_cmp);
        let equal = list.chunk_by(|one, other| one == other);
        let weight = |values: &[f64]| (values[0], values.len() as f64 / list.len() as f64);
        return Asked::Values(equal.map(weight).collect());
    }
    let names: Vec<String> = (0..joint.dimensions()).map(|axis| axis.to_string()).collect();
    let sobol = Sobol::new(0, &names);
    let draw = |point: u64| {
        let u: Vec<f64> = (0..names.len()).map(|axis| sobol.number(axis, point)).collect();
        joint.values(&u, &mut values);
        of(&values)
    };
    let mut drawn: Vec<f64> = (0..DRAWS).map(draw).collect();
    drawn.sort_by(f64::total_cmp);
    Asked::Drawn(Arc::from(drawn))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Overrides;

    /// Known: of rows drawn with replacement each value has the share of the rows that have it, wherever these stand in
    /// the file.
    #[test]
    fn values_of_rows_have_their_shares() {
        let folder = std::env::temp_dir().join(format!("spindrift-rows-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("walls.csv"), "body.parts.fuselage.wall_thickness_m\n0.02\n0.03\n0.02\n0.02\n")
            .unwrap();
        let (nominal, _) = include_str!("../../campaigns/no_debris.toml").split_once("[[disperse]]").unwrap();
        let rows = "distribution = \"bootstrap\"\nfile = \"walls.csv\"";
        let text = format!("{nominal}\n[[disperse]]\n{rows}\n");
        let plan = Plan::from_text_in(&folder, "c.toml", &text, Overrides::default());
        std::fs::remove_dir_all(&folder).unwrap();
        let plan = plan.unwrap();
        let Some(Asked::Values(found)) = of_column(&plan, 0) else { panic!("values") };
        assert_eq!(*found, [(0.02, 0.75), (0.03, 0.25)]);
    }

    /// Edges of ten bars, and how many of a thousand values are expected in each.
    fn expected(asked: &Asked<'_>, low: f64, high: f64) -> Vec<f64> {
        let edges: Vec<f64> = (0..=10).map(|k| low + 0.1 * f64::from(k) * (high - low)).collect();
        asked.expected(&edges, 1000)
    }

    fn plan(dispersion: &str) -> Plan {
        let (nominal, _) = include_str!("../../campaigns/no_debris.toml").split_once("[[disperse]]").unwrap();
        Plan::from_text("x.toml", &format!("{nominal}\n[[disperse]]\n{dispersion}\n"), Overrides::default()).unwrap()
    }

    /// Known: a component of a direction that is uniform over the sphere is uniform (Archimedes); so is the component
    /// along the axis of a cone, from the cosine of its half-angle to 1.
    #[test]
    fn components_of_directions() {
        let sphere = plan(
            "parameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"uniform_direction\"\n\
             magnitude = { distribution = \"offset\", offset = 2.0 }",
        );
        let length = sphere.dispersions.columns().iter().map(|column| column.nominal.powi(2)).sum::<f64>().sqrt() + 2.0;
        for component in 0..3 {
            let found = expected(&of_column(&sphere, component).unwrap(), -length, length);
            // 65,536 even draws: 0.6 of 100 is measured
            assert!(found.iter().all(|count| (count - 100.0).abs() < 2.0), "{component}: {found:?}");
        }
        let cone = plan(
            "parameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"cone\"\nhalf_angle_rad = 1.0\naxis = [0, \
            0, 3]",
        );
        let length = length - 2.0;
        let found = expected(&of_column(&cone, 2).unwrap(), libm::cos(1.0) * length, length);
        assert!(found.iter().all(|count| (count - 100.0).abs() < 2.0), "{found:?}");
    }

    /// Known: the rotation angle of a normal rotation vector of three equal standard deviations has Maxwell's
    /// distribution: 19.87% of angles are below one standard deviation, 73.85% below two (chi-squared of three degrees
    /// of freedom at 1 and 4).
    #[test]
    fn angles_of_attitude_errors() {
        let plan = plan("parameter = \"initial.attitude\"\ndistribution = \"attitude_error\"\nstd_rad = 0.1");
        let turn = |q: &[f64]| 2.0 * libm::atan2((q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt(), q[0].abs());
        assert_eq!(plan.nominal.initial.attitude, [1.0, 0.0, 0.0, 0.0]);
        let asked = of_columns(&plan, &[0, 1, 2, 3], turn).unwrap();
        let found = asked.expected(&[0.0, 0.1, 0.2, 3.0], 1000);
        let known = [198.75, 738.54 - 198.75, 1000.0 - 738.54];
        // measured: within 0.1
        assert!(found.iter().zip(known).all(|(found, known)| (found - known).abs() < 1.0), "{found:?}");
        assert!(of_columns(&plan, &[0, 1, 2, 3, 4], turn).is_none());
    }
}
