//! [`Expected`]: the expected distribution of a dispersed column, from evenly spread draws that differ from the
//! campaign's; components of vectors have no closed form in general.

use crate::campaign::Plan;
use crate::sampling::design::replicates::Sequence;
use crate::sampling::design::sobol::Sobol;
use crate::sampling::{Joint, Transform};

/// Draws of a scalar, or of a joint distribution by a Sobol design: finer than a picture resolves.
const DRAWS: u32 = 1 << 13;
/// Fewer distinct values than one in this many draws are discrete.
const SHARED: usize = 8;

#[derive(Clone, Debug)]
pub struct Expected(Vec<f64>);

impl Expected {
    /// `None` for derived numbers and tables.
    pub fn of_column(plan: &Plan, index: usize) -> Option<Self> {
        if let Some(distribution) = plan.dispersions.scalar_of(index) {
            return Some(Expected::of_quantile(|u| distribution.quantile(u)));
        }
        let assigned = plan.dispersions.assigned_to(index)?;
        let Transform::Joint(joint) = &assigned.map else { return None };
        let place = assigned.columns.iter().position(|other| *other == index)?;
        let mut values = vec![0.0; assigned.columns.len()];
        if let Joint::Bootstrap(rows) = joint {
            let of_row = |row: usize| {
                rows.values_of(row, &mut values);
                values[place]
            };
            let all: Vec<f64> = (0..rows.rows()).map(of_row).collect();
            return Some(Expected::of(all.repeat((DRAWS as usize).div_ceil(all.len().max(1)))));
        }
        let names: Vec<String> = (0..joint.dimensions()).map(|axis| axis.to_string()).collect();
        let sobol = Sobol::new(0, &names);
        let draw = |point: u64| {
            let u: Vec<f64> = (0..names.len()).map(|axis| sobol.number(axis, point)).collect();
            joint.values(&u, &mut values);
            values[place]
        };
        Some(Expected::of((0..u64::from(DRAWS)).map(draw).collect()))
    }

    pub fn of_quantile(quantile: impl Fn(f64) -> f64) -> Self {
        Expected::of((0..DRAWS).map(|k| quantile((f64::from(k) + 0.5) / f64::from(DRAWS))).collect())
    }

    fn of(mut draws: Vec<f64>) -> Self {
        draws.sort_by(f64::total_cmp);
        Expected(draws)
    }

    /// Mean (NaN if empty) and expected number, out of `count`, of the values between neighbouring `edges`, ascending;
    /// a value at an edge counts in the bar above, at the last edge in the last bar, as in the histograms.
    pub fn bars(&self, edges: &[f64], count: usize) -> Vec<[f64; 2]> {
        let below = |edge: &f64| self.0.partition_point(|draw| draw < edge);
        let mut below: Vec<usize> = edges.iter().map(below).collect();
        if let (Some(last), Some(edge)) = (below.last_mut(), edges.last()) {
            *last = self.0.partition_point(|draw| draw <= edge);
        }
        let each = count as f64 / self.0.len().max(1) as f64;
        let bar = |pair: &[usize]| {
            let draws = &self.0[pair[0]..pair[1]];
            [draws.iter().sum::<f64>() / draws.len() as f64, each * draws.len() as f64]
        };
        below.windows(2).map(bar).collect()
    }

    /// Values and probabilities of a discrete distribution, ascending; `None` if continuous.
    pub fn values(&self) -> Option<Vec<(f64, f64)>> {
        let of = |same: &[f64]| (same[0], same.len() as f64 / self.0.len() as f64);
        let values: Vec<(f64, f64)> = self.0.chunk_by(|one, other| one == other).map(of).collect();
        (values.len() * SHARED < self.0.len()).then_some(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::distribution::Quantile;
    use crate::sampling::distribution::choice::Choice;
    use spindrift_control::control::tables::Overrides;

    fn plan(dispersion: &str) -> Plan {
        let (nominal, _) = include_str!("../../../../campaigns/no_debris.toml").split_once("[[disperse]]").unwrap();
        Plan::from_text("x.toml", &format!("{nominal}\n[[disperse]]\n{dispersion}\n"), Overrides::default()).unwrap()
    }

    fn counts(expected: &Expected, edges: &[f64], count: usize) -> Vec<f64> {
        expected.bars(edges, count).into_iter().map(|[_, count]| count).collect()
    }

    /// Known: components of a uniform direction on the sphere are uniform (Archimedes), as is that along the axis of a
    /// cone, from the cosine of its half-angle to 1. Discrete values count in their bars, including both ends of the
    /// axis; values beyond it do not count.
    #[test]
    fn counts_are_those_of_the_distribution() {
        let parameter = "parameter = \"initial.angular_velocity_rad_s\"\n";
        let sphere = plan(&format!(
            "{parameter}distribution = \"uniform_direction\"\nmagnitude = {{ distribution = \"offset\", offset = 2.0 }}"
        ));
        let length = sphere.dispersions.columns().iter().map(|column| column.nominal.powi(2)).sum::<f64>().sqrt();
        let cone = plan(&format!("{parameter}distribution = \"cone\"\nhalf_angle_rad = 1.0\naxis = [0, 0, 3]"));
        let [long, cosine] = [length + 2.0, libm::cos(1.0) * length];
        let of_sphere = [0, 1, 2].map(|component| (&sphere, component, -long, long));
        for (plan, component, low, high) in of_sphere.into_iter().chain([(&cone, 2, cosine, length)]) {
            let edges: Vec<f64> = (0..=10).map(|k| low + 0.1 * f64::from(k) * (high - low)).collect();
            let expected = Expected::of_column(plan, component).unwrap();
            let found = counts(&expected, &edges, 1000);
            // 8,192 even draws: 2.0 of 100 is measured
            assert!(found.iter().all(|count| (count - 100.0).abs() < 3.0), "{component}: {found:?}");
            assert_eq!(expected.values(), None);
        }
        let choice = Choice::new(&[0.05, 0.01, 0.02, 7.0], &[1.0, 2.0, 1.0, 0.0]);
        let expected = Expected::of_quantile(|u| choice.quantile(u));
        assert_eq!(counts(&expected, &[0.01, 0.02, 0.03, 0.04, 0.05], 100), [50.0, 25.0, 0.0, 25.0]);
        assert_eq!(counts(&expected, &[0.015, 0.03], 100), [25.0]);
        assert_eq!(expected.values(), Some(vec![(0.01, 0.5), (0.02, 0.25), (0.05, 0.25)]));
    }
}
