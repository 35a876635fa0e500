//! The distribution of one number that is drawn together with others, as of a component of a vector.
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
    let assigned = plan.dispersions.assigned_to(index)?;
    let Transform::Joint(joint) = &assigned.map else { return None };
    let place = assigned.columns.iter().position(|other| *other == index)?;
    let mut values = vec![0.0; joint.components()];
    if let Joint::Bootstrap(rows) = joint {
        let of_row = |row: usize| {
            rows.values_of(row, &mut values);
            values[place]
        };
        let mut list: Vec<f64> = (0..rows.rows()).map(of_row).collect();
        list.sort_by(f64::total_cmp);
        let weight = |values: &[f64]| (values[0], values.len() as f64 / list.len() as f64);
        return Some(Asked::Values(list.chunk_by(|one, other| one == other).map(weight).collect()));
    }
    let names: Vec<String> = (0..joint.dimensions()).map(|axis| axis.to_string()).collect();
    let sobol = Sobol::new(0, &names);
    let draw = |point: u64| {
        let u: Vec<f64> = (0..names.len()).map(|axis| sobol.number(axis, point)).collect();
        joint.values(&u, &mut values);
        values[place]
    };
    let mut drawn: Vec<f64> = (0..DRAWS).map(draw).collect();
    drawn.sort_by(f64::total_cmp);
    Some(Asked::Drawn(Arc::from(drawn)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Overrides;

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
}
