//! First-order and total Sobol indices from whole blocks of a `saltelli` design.

use crate::analysis::input_sensitivity::InputSensitivity;
use crate::campaign::Plan;
use crate::statistics::sensitivity::{Block, saltelli_indices};

/// Fewest `saltelli` blocks with 95% intervals that cover at least 93%
/// (`indices_from_blocks_of_any_two_dimensions_are_covered`).
const ENOUGH_BLOCKS: usize = 64;

fn factor_names(plan: &Plan) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (factor, dimension) in plan.dispersions.factors().into_iter().zip(plan.dispersions.dimensions()) {
        if factor == names.len() {
            // a trailing number counts the dimensions of a distribution; "row" is a bootstrap of several parameters
            let numbered = dimension.rsplit_once('/').filter(|(_, last)| last.parse::<usize>().is_ok());
            names.push(numbered.map_or(dimension.as_str(), |(name, _)| name).to_owned());
        }
    }
    names
}

pub(super) fn of_blocks(
    plan: &Plan,
    names: &[&str],
    samples: &[u64],
    observables: &[Vec<f64>],
) -> Vec<InputSensitivity> {
    let factors = factor_names(plan);
    let members = factors.len() + 2;
    let confidence = plan.analysis.confidence;
    let mut found = Vec::new();
    for (observable, y) in names.iter().zip(observables) {
        // skip incomplete blocks
        let mut blocks: Vec<&[f64]> = Vec::new();
        let mut row = 0;
        while row + members <= y.len() {
            let first = samples[row] - 1;
            let is_whole = first.is_multiple_of(members as u64)
                && samples[row + members - 1] == first + members as u64
                && y[row..row + members].iter().all(|value| value.is_finite());
            if is_whole {
                blocks.push(&y[row..row + members]);
            }
            row += if is_whole { members } else { 1 };
        }
        for (factor, name) in factors.iter().enumerate() {
            let of_block = |block: &&[f64]| Block { a: block[0], b: block[members - 1], mixed: block[factor + 1] };
            let of_factor: Vec<Block> = blocks.iter().map(of_block).collect();
            let indices = if of_factor.len() > 1 { saltelli_indices(&of_factor, confidence) } else { None };
            let note = match indices {
                Some(_) if blocks.len() < ENOUGH_BLOCKS => {
                    "fewer than 64 blocks: the intervals cover less often than stated"
                }
                Some(_) => "intervals are those of independent blocks",
                None => "the observable does not vary, or there are fewer than two whole blocks",
            };
            found.push(InputSensitivity {
                observable: (*observable).to_owned(),
                input: name.clone(),
                rows: (blocks.len() * members) as u64,
                first_order: indices.map(|[first, _]| first),
                total: indices.map(|[_, total]| total),
                note: Some(note.to_owned()),
                ..InputSensitivity::default()
            });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::small_plan::small_plan;

    /// Law: only whole blocks count, with one index per distribution. Known: y = x_1 + x_2 at A, A with x_1 of B, A
    /// with x_2 of B, and B.
    #[test]
    fn indices_are_of_whole_blocks() {
        let plan = small_plan(13, "design = { kind = \"saltelli\" }");
        // A = (0, 1), B = (1, 4); the second block lacks sample 6; A = (3, 1), B = (2, 0)
        let rows = [1.0, 2.0, 4.0, 5.0, 9.0, 9.0, 9.0, 4.0, 3.0, 3.0, 2.0];
        let samples: Vec<u64> = (1..=12).filter(|sample| *sample != 6).collect();
        let found = of_blocks(&plan, &["x"], &samples, &[rows.to_vec()]);
        let inputs: Vec<(&str, u64)> = found.iter().map(|one| (one.input.as_str(), one.rows)).collect();
        let parameter = |axis: &str| format!("initial.angular_velocity_rad_s.{axis}");
        assert_eq!(inputs, [(parameter("x").as_str(), 8), (parameter("y").as_str(), 8)]);
        // variance (4 + 1)/2; half the mean square of A - mixed: 1/2 and 5/2
        let total = found.iter().map(|one| one.total.map(|total| total.value)).collect::<Vec<_>>();
        assert_eq!(total, [Some(0.2), Some(1.0)]);
    }
}
