//! [`Correlation`]: a `[[correlate]]` table; `copulas`: the dependence that all tables specify.
//!
//! A table correlates all components of its parameters (a square matrix), or each component of one with each of another
//! (a block, or one number). Tables with a common component form one matrix; other pairs are independent.

use super::columns::Component;
use super::copula::{Copula, Matrix, nearest_correlation, smallest_negative_eigenvalue};
use super::distribution::Distribution;
use super::error::{DispersionError, Result, Table, error_of};
use super::keys::{Values, Written};
use super::rank::scores_of_ranks;
use crate::scene::Parameter;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    Scores,
    Ranks,
    Covariance,
}

impl Measure {
    pub const ALL: [Measure; 3] = [Measure::Scores, Measure::Ranks, Measure::Covariance];

    pub const fn key(self) -> &'static str {
        match self {
            Measure::Scores => "correlation",
            Measure::Ranks => "rank_correlation",
            Measure::Covariance => "covariance",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// Index of its table in the file.
    pub table: usize,
    pub parameters: Vec<(Parameter, Option<usize>)>,
    pub measure: Measure,
    /// In the order of the parameters and their components.
    pub numbers: Values,
    /// True to replace a matrix that is not positive semidefinite by the nearest one.
    pub nearest_psd: bool,
    /// The table as in canonical text.
    pub written: Written,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Replaced {
    pub names: Vec<String>,
    pub written: Matrix,
    pub used: Matrix,
}

/// Relative difference of equal numbers.
const SAME: f64 = 1e-9;

type Drawn<'d> = (usize, &'d Distribution);

struct Pairs<'l> {
    of: &'l Correlation,
    components: Vec<(usize, String)>,
    /// Pairs of dimensions with the correlation of their normal scores.
    scores: Vec<(usize, usize, f64)>,
}

/// The dependence, the replaced matrices and the errors of `list`. `drawn`: dimension and distribution of a component
/// with a distribution of one number.
pub(super) fn copulas<'d>(
    list: &[Correlation],
    drawn: impl Fn(Component) -> Option<Drawn<'d>>,
) -> (Vec<Copula>, Vec<Replaced>, Vec<DispersionError>) {
    let (mut groups, mut errors): (Vec<Vec<Pairs<'_>>>, Vec<_>) = (Vec::new(), Vec::new());
    for correlation in list {
        match correlation.pairs(&drawn) {
            Ok(pairs) => {
                let shares = |group: &mut Vec<Pairs<'_>>| {
                    let of_group = || group.iter().flat_map(|other| &other.components);
                    pairs.components.iter().any(|(dimension, _)| of_group().any(|(other, _)| other == dimension))
                };
                let mut joined: Vec<Pairs<'_>> = groups.extract_if(.., shares).flatten().collect();
                errors.extend(pairs.named_twice(&joined));
                joined.push(pairs);
                groups.push(joined);
            }
            Err(error) => errors.push(error),
        }
    }
    let (mut copulas, mut replaced) = (Vec::new(), Vec::new());
    for group in &groups {
        match copula(group) {
            Ok((copula, other)) => {
                copulas.push(copula);
                replaced.extend(other);
            }
            Err(error) => errors.push(error),
        }
    }
    (copulas, replaced, errors)
}

/// The dependence of a group of tables with common components, and the replaced matrix.
fn copula(group: &[Pairs<'_>]) -> Result<(Copula, Option<Replaced>)> {
    let mut components: Vec<&(usize, String)> = Vec::new();
    for component in group.iter().flat_map(|pairs| &pairs.components) {
        if !components.iter().any(|(dimension, _)| *dimension == component.0) {
            components.push(component);
        }
    }
    let place = |dimension: usize| components.iter().position(|(other, _)| *other == dimension).unwrap_or(0);
    let n = components.len();
    let mut matrix: Matrix = (0..n).map(|i| (0..n).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect();
    for (a, b, score) in group.iter().flat_map(|pairs| &pairs.scores) {
        let (i, j) = (place(*a), place(*b));
        matrix[i][j] = *score;
        matrix[j][i] = *score;
    }
    let dimensions = components.iter().map(|(dimension, _)| *dimension).collect();
    let Some(smallest) = smallest_negative_eigenvalue(&matrix) else {
        return Ok((Copula::new(dimensions, &matrix), None));
    };
    let Some(last) = group.last().filter(|_| !group.iter().any(|pairs| pairs.of.nearest_psd)) else {
        let used = nearest_correlation(&matrix);
        let names = components.iter().map(|(_, name)| name.clone()).collect();
        return Ok((Copula::new(dimensions, &used), Some(Replaced { names, written: matrix, used })));
    };
    let together = if group.len() > 1 { ", with the other tables of its parameters" } else { "" };
    let allowed = format!(
        "positive semidefinite{together} (the smallest eigenvalue of the scores' correlation is {smallest:.6})"
    );
    let remedy =
        "no numbers have these correlations: change them, or add nearest_psd = true for the nearest that exist";
    last.of.refused(format!("{:?}", last.of.numbers), allowed, remedy)
}

impl Pairs<'_> {
    /// A pair that an earlier table correlates too.
    fn named_twice(&self, earlier: &[Pairs<'_>]) -> Option<DispersionError> {
        let same =
            |(a, b, _): &(usize, usize, f64), (c, d, _): &(usize, usize, f64)| (a, b) == (c, d) || (a, b) == (d, c);
        let mut others = earlier.iter().flat_map(|pairs| &pairs.scores);
        let twice = self.scores.iter().find(|pair| others.clone().any(|other| same(pair, other)))?;
        others.next()?;
        let name = |dimension: usize| {
            let found = self.components.iter().find(|(other, _)| *other == dimension);
            found.map_or(String::new(), |(_, name)| name.clone())
        };
        let (value, allowed) =
            (format!("{:?}", [name(twice.0), name(twice.1)]), "pairs that are correlated in one table only");
        let remedy = "take the pair out of one of the two tables";
        Some(error_of(Table::Correlate(self.of.table), "parameters", value, allowed, remedy))
    }
}

impl Correlation {
    pub fn components(&self) -> Vec<Component> {
        self.parameters.iter().flat_map(components_of).collect()
    }

    fn refused<T>(&self, value: String, allowed: String, remedy: &str) -> Result<T> {
        Err(error_of(Table::Correlate(self.table), self.measure.key(), value, allowed, remedy))
    }

    fn pairs<'d>(&self, drawn: &impl Fn(Component) -> Option<Drawn<'d>>) -> Result<Pairs<'_>> {
        let components = self.components();
        let drawn = self.drawn(&components, drawn)?;
        let names: Vec<String> = components.iter().map(|(parameter, k)| parameter.component_name(*k)).collect();
        let n = components.len();
        let first = self.parameters.first().map_or(0, |parameter| components_of(parameter).len());
        let is_pair = self.parameters.len() == 2;
        let (rows, matrix) = match &self.numbers {
            Values::One(number) if n == 2 => (0..1, vec![vec![*number]]),
            number @ (Values::One(_) | Values::Each(_)) => {
                let allowed = format!("rows of numbers: one number is for two components, and here are {n}");
                let remedy = "write a square matrix, or for two parameters a row for each component of the first";
                return self.refused(format!("{number:?}"), allowed, remedy);
            }
            Values::Rows(rows) if rows.len() == n && rows.iter().all(|row| row.len() == n) => (0..n, rows.clone()),
            Values::Rows(rows)
                if is_pair && n > 2 && rows.len() == first && rows.iter().all(|row| row.len() == n - first) =>
            {
                (0..first, rows.clone())
            }
            Values::Rows(rows) => {
                let value = format!("{} x {}", rows.len(), rows.first().map_or(0, Vec::len));
                let block = if is_pair && n > 2 {
                    format!(", or {first} x {} of the one with the other", n - first)
                } else {
                    String::new()
                };
                let allowed = format!("{n} x {n}, as there are components{block}");
                let remedy = if n == 2 {
                    "give one row and column for each component, in their order; or one number without brackets"
                } else {
                    "give one row and column for each component, in their order"
                };
                return self.refused(value, allowed, remedy);
            }
        };
        let is_square = rows.len() == n && n > 0;
        let scales = self.scales(&drawn, &names, is_square.then_some(&matrix))?;
        let mut scores = Vec::new();
        for i in rows {
            for j in if is_square { 0..i } else { first..n } {
                let written = matrix[i][if is_square { j } else { j - first }];
                let mirror = if is_square { matrix[j][i] } else { written };
                if (written - mirror).abs() > SAME * written.abs().max(mirror.abs()) {
                    let value = format!("{mirror:?} and {written:?} in rows {} and {}", j + 1, i + 1);
                    return self.refused(value, "symmetric".to_owned(), "write each pair's number twice");
                }
                let r = 0.5 * (written + mirror) / (scales[i] * scales[j]);
                let score = self.score(r, drawn[i].1, drawn[j].1).or_else(|(allowed, remedy)| {
                    let of = match self.measure {
                        Measure::Covariance => format!(" (a correlation of {r:?})"),
                        _ => String::new(),
                    };
                    self.refused(format!("{written:?}{of}"), allowed, remedy)
                })?;
                scores.push((drawn[i].0, drawn[j].0, score));
            }
        }
        let components = drawn.iter().map(|(dimension, _)| *dimension).zip(names).collect();
        Ok(Pairs { of: self, components, scores })
    }

    fn drawn<'d>(
        &self,
        components: &[Component],
        drawn: &impl Fn(Component) -> Option<Drawn<'d>>,
    ) -> Result<Vec<Drawn<'d>>> {
        let mut found: Vec<Drawn<'d>> = Vec::with_capacity(components.len());
        for (parameter, component) in components {
            let refused = |allowed: &str, remedy: &str| {
                let name = format!("{:?}", parameter.component_name(*component));
                Err(error_of(Table::Correlate(self.table), "parameters", name, allowed, remedy))
            };
            let Some(one) = drawn((*parameter, *component)) else {
                let allowed = "made of numbers that a [[disperse]] table draws each for itself: not together with \
                    others (directions, attitudes, rows of a table), and not at a fixed offset";
                let remedy = "give it a distribution of its own such as \"normal\", or take it out of the list";
                return refused(allowed, remedy);
            };
            if found.iter().any(|(dimension, _)| *dimension == one.0) {
                return refused("named once", "take it out of the list, where it is twice");
            }
            found.push(one);
        }
        Ok(found)
    }

    /// The divisors that turn numbers into correlations; checks the diagonal of a `square` matrix.
    fn scales(&self, drawn: &[Drawn<'_>], names: &[String], square: Option<&Matrix>) -> Result<Vec<f64>> {
        let mut scales = vec![1.0; drawn.len()];
        for (place, (_, distribution)) in drawn.iter().enumerate() {
            let diagonal = square.map(|matrix| matrix[place][place]);
            let Measure::Covariance = self.measure else {
                if let Some(value) = diagonal.filter(|value| (value - 1.0).abs() > SAME) {
                    let remedy = "a parameter is correlated with itself by 1; for covariances write the key covariance";
                    return self.refused(format!("{value:?}"), "1 on the diagonal".to_owned(), remedy);
                }
                continue;
            };
            let std = distribution.normal_std().filter(|std| *std > 0.0);
            let is_variance = |std: f64| diagonal.is_none_or(|value| (value - std * std).abs() <= SAME * std * std);
            let allowed = match std {
                Some(std) if is_variance(std) => {
                    scales[place] = std;
                    continue;
                }
                Some(std) => format!("the variance of its distribution ({:?})", std * std),
                None if diagonal.is_some() => "the variance of a normal distribution".to_owned(),
                None => "a covariance of normal distributions".to_owned(),
            };
            let value = match diagonal {
                Some(value) => format!("{value:?} of {}", names[place]),
                None => format!("with {}", names[place]),
            };
            let remedy = "give it a normal distribution of that standard deviation, or use correlation";
            return self.refused(value, allowed, remedy);
        }
        Ok(scales)
    }

    /// The correlation of the normal scores for the number `r`; or its allowed values and the remedy.
    fn score(&self, r: f64, a: &Distribution, b: &Distribution) -> Result<f64, (String, &'static str)> {
        if r.abs() > 1.0 + SAME {
            let remedy = match self.measure {
                Measure::Covariance => "at most the product of the two standard deviations",
                _ => "for covariances write the key covariance",
            };
            return Err(("made of correlations from -1 to 1".to_owned(), remedy));
        }
        if self.measure != Measure::Ranks {
            return Ok(r);
        }
        scores_of_ranks(r, a, b).map_err(|[low, high]| {
            let allowed = format!("from {low:.6} to {high:.6}, which these two discrete distributions can have");
            (allowed, "write a number in this range; 1 needs the same probabilities in both")
        })
    }
}

/// All components of a parameter, or one.
pub(super) fn components_of((parameter, component): &(Parameter, Option<usize>)) -> Vec<Component> {
    match component {
        Some(component) => vec![(*parameter, *component)],
        None => (0..parameter.width()).map(|component| (*parameter, component)).collect(),
    }
}
