//! Dependence between parameters: [`Correlation`] and [`Derivation`] as written, and their way to a [`Copula`] and to
//! [`Derived`] columns.

use super::copula::{Copula, Matrix, nearest_correlation, score_correlation, smallest_negative_eigenvalue};
use super::dispersions::{Dispersions, Transform};
use super::distribution::{Distribution, Quantile};
use super::error::{DispersionError, Table, error_of};
use super::expression::Expression;
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, SceneInput};

/// How a dependence is written.
#[derive(Clone, Debug, PartialEq)]
pub enum Dependence {
    /// Correlations of the normal scores: of the values where these are normal (`correlation`).
    Scores(Matrix),
    /// Spearman's rank correlations (`rank_correlation`).
    Ranks(Matrix),
    /// Covariances of normal values, whose variances must be those of their distributions (`covariance`).
    Covariance(Matrix),
}

/// A `[[correlate]]` table as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// The parameters, whole or by component.
    pub parameters: Vec<(Parameter, Option<usize>)>,
    /// Their dependence, in the order of the parameters and their components.
    pub dependence: Dependence,
    /// Whether a matrix that is not positive semidefinite is replaced by the nearest that is.
    pub nearest_psd: bool,
}

/// A `[[derive]]` table as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivation {
    /// The parameter.
    pub parameter: Parameter,
    /// The component that is meant, if not all are.
    pub component: Option<usize>,
    /// The expression.
    pub expression: String,
}

/// A column that is computed from others.
#[derive(Clone, Debug, PartialEq)]
pub struct Derived {
    /// The column.
    pub column: usize,
    /// How.
    expression: Expression,
    /// What each variable of the expression is.
    sources: Vec<Source>,
    /// The expression as written.
    pub text: String,
}

/// Where a variable's value comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    /// A column of the draw.
    Column(usize),
    /// A value that is the same in every sample.
    Nominal(f64),
}

impl Derived {
    /// The value, where `column` gives the values of other columns.
    #[inline]
    pub fn value(&self, column: impl Fn(usize) -> f64) -> f64 {
        self.expression.value(|index| match self.sources[index] {
            Source::Column(index) => column(index),
            Source::Nominal(value) => value,
        })
    }
}

/// A diagonal or a pair of mirror images that differ by more are two different numbers, not one in two roundings.
const SAME: f64 = 1e-9;
/// How far the value of an expression at the nominal scene may be from the nominal value, relative to the larger of the two.
const NOMINAL_SLACK: f64 = 1e-9;

impl Correlation {
    /// The dependence of the dimensions of `drawn`.
    #[expect(clippy::needless_range_loop, reason = "entries of a matrix are known by two indices")]
    pub(super) fn copula(&self, index: usize, drawn: &Dispersions) -> Result<Copula, DispersionError> {
        let refused = |key, value: String, allowed: String, remedy: &str| {
            Err(error_of(Table::Correlate(index), key, value, allowed, remedy))
        };
        let components: Vec<(Parameter, usize)> = self
            .parameters
            .iter()
            .flat_map(|(parameter, component)| match component {
                Some(component) => vec![(*parameter, *component)],
                None => (0..parameter.width()).map(|component| (*parameter, component)).collect(),
            })
            .collect();
        let name = |(parameter, component): (Parameter, usize)| format!("{:?}", parameter.component_name(component));
        let mut dimensions: Vec<usize> = Vec::with_capacity(components.len());
        let mut distributions: Vec<&Distribution> = Vec::with_capacity(components.len());
        for component in &components {
            let assigned = drawn.distribution_at(*component).filter(|assigned| assigned.map.dimensions() == 1);
            let Some((first, Transform::Scalar(distribution))) = assigned.map(|one| (one.first, &one.map)) else {
                let allowed =
                    "made of parameters that a [[disperse]] table gives a distribution of one number each".to_owned();
                return refused("parameters", name(*component), allowed, "disperse it, or take it out of the list");
            };
            let earlier = drawn.copulas.iter().any(|copula| copula.dimensions.contains(&first));
            if earlier || dimensions.contains(&first) {
                let allowed = "correlated in one table".to_owned();
                return refused("parameters", name(*component), allowed, "put all of its correlations into one matrix");
            }
            dimensions.push(first);
            distributions.push(distribution);
        }
        let (key, matrix) = match &self.dependence {
            Dependence::Scores(matrix) => ("correlation", matrix),
            Dependence::Ranks(matrix) => ("rank_correlation", matrix),
            Dependence::Covariance(matrix) => ("covariance", matrix),
        };
        let n = components.len();
        if matrix.len() != n {
            let (value, allowed) = (format!("{0} x {0}", matrix.len()), format!("{n} x {n}, as there are components"));
            return refused(key, value, allowed, "give one row and column for each component, in their order");
        }
        for i in 0..n {
            for j in 0..i {
                let (a, b) = (matrix[i][j], matrix[j][i]);
                if (a - b).abs() > SAME * a.abs().max(b.abs()) {
                    let value = format!("{b:?} and {a:?} in rows {} and {}", j + 1, i + 1);
                    return refused(key, value, "symmetric".to_owned(), "write each pair's number twice");
                }
            }
        }
        let scales = match &self.dependence {
            Dependence::Covariance(matrix) => deviations(&distributions, matrix).map_err(|(place, allowed)| {
                let remedy = "give it a normal distribution of that standard deviation, or use correlation";
                error_of(
                    Table::Correlate(index),
                    key,
                    format!("{:?} of {}", matrix[place][place], name(components[place])),
                    allowed,
                    remedy,
                )
            })?,
            _ => vec![1.0; n],
        };
        let mut scores: Matrix = (0..n)
            .map(|i| (0..n).map(|j| 0.5 * (matrix[i][j] + matrix[j][i]) / (scales[i] * scales[j])).collect())
            .collect();
        for i in 0..n {
            if (scores[i][i] - 1.0).abs() > SAME {
                let (value, allowed) = (format!("{:?}", matrix[i][i]), "1 on the diagonal".to_owned());
                let remedy = "a parameter is correlated with itself by 1; for covariances write the key covariance";
                return refused(key, value, allowed, remedy);
            }
            scores[i][i] = 1.0;
            if let Some(j) = (0..n).find(|j| scores[i][*j].abs() > 1.0 + SAME) {
                let allowed = "made of correlations from -1 to 1".to_owned();
                let (value, remedy) = match &self.dependence {
                    Dependence::Covariance(_) => {
                        let r = scores[i][j];
                        (
                            format!("{:?} (a correlation of {r:?})", matrix[i][j]),
                            "at most the product of the two standard deviations",
                        )
                    }
                    _ => (format!("{:?}", matrix[i][j]), "for covariances write the key covariance"),
                };
                return refused(key, value, allowed, remedy);
            }
        }
        if matches!(self.dependence, Dependence::Ranks(_)) {
            for i in 0..n {
                for j in (0..n).filter(|j| *j != i) {
                    scores[i][j] = score_correlation(scores[i][j]);
                }
            }
        }
        if let Some(smallest) = smallest_negative_eigenvalue(&scores) {
            if !self.nearest_psd {
                let allowed = format!(
                    "positive semidefinite (the smallest eigenvalue of the scores' correlation is {smallest:.6})"
                );
                let remedy = "no numbers have these correlations: change them, or add nearest_psd = true for the nearest that exist";
                return refused(key, format!("{matrix:?}"), allowed, remedy);
            }
            scores = nearest_correlation(&scores);
        }
        Ok(Copula::new(dimensions, &scores))
    }
}

/// The standard deviations of normal distributions whose variances are on the diagonal of `matrix`; the index of one that is not,
/// and what it must be.
fn deviations(distributions: &[&Distribution], matrix: &Matrix) -> Result<Vec<f64>, (usize, String)> {
    distributions
        .iter()
        .enumerate()
        .map(|(index, distribution)| match distribution.normal_std() {
            Some(std) if (matrix[index][index] - std * std).abs() <= SAME * std * std && std > 0.0 => Ok(std),
            Some(std) if std > 0.0 => Err((index, format!("the variance of its distribution ({:?})", std * std))),
            _ => Err((index, "the variance of a normal distribution".to_owned())),
        })
        .collect()
}

impl Dispersions {
    /// Adds the columns of `list` in an order in which each comes after what it is made of.
    pub(super) fn derive(&mut self, list: &[Derivation], nominal: &SceneInput) -> Vec<DispersionError> {
        let mut errors = Vec::new();
        // what is to be computed: index of the table, parameter and component, expression
        let mut open: Vec<(usize, (Parameter, usize), Expression, &str)> = Vec::new();
        for (index, derivation) in list.iter().enumerate() {
            let parameter = derivation.parameter;
            let components: Vec<usize> = match derivation.component {
                Some(component) => vec![component],
                None => (0..parameter.width()).collect(),
            };
            let mut refuse = |key, value: String, allowed: String, remedy: &str| {
                errors.push(error_of(Table::Derive(index), key, value, allowed, remedy));
            };
            let expression = match Expression::parse(&derivation.expression) {
                Ok(expression) => expression,
                Err(allowed) => {
                    let remedy = "operators are + - * / ^ and comparisons; names are those of parameters";
                    refuse("expression", format!("{:?}", derivation.expression), allowed, remedy);
                    continue;
                }
            };
            for component in components {
                let shown = format!("{:?}", parameter.component_name(component));
                let is_taken = self.distribution_at((parameter, component)).is_some()
                    || open.iter().any(|(_, target, ..)| *target == (parameter, component));
                if !parameter.exists(nominal, component) {
                    refuse("parameter", shown, "a key that the scene has".to_owned(), parameter.remedy());
                } else if parameter.shape() == Shape::Quaternion {
                    let allowed = "other than an attitude, which changes as a whole".to_owned();
                    refuse("parameter", shown, allowed, "disperse the attitude");
                } else if is_taken {
                    refuse(
                        "parameter",
                        shown,
                        "given a value once".to_owned(),
                        "delete one of the tables that give it one",
                    );
                } else {
                    open.push((index, (parameter, component), expression.clone(), &derivation.expression));
                    continue;
                }
                break;
            }
        }
        // variables as parameters; what is wrong with them
        open.retain(|(index, _, expression, _)| {
            let wrong =
                expression.variables().iter().find_map(|name| variable(name, nominal).err().map(|why| (name, why)));
            if let Some((name, (allowed, remedy))) = &wrong {
                errors.push(error_of(
                    Table::Derive(*index),
                    "expression",
                    format!("{name:?}"),
                    allowed.clone(),
                    remedy.clone(),
                ));
            }
            wrong.is_none()
        });
        while !open.is_empty() && errors.is_empty() {
            let waits = |target: &(Parameter, usize)| open.iter().any(|(_, other, ..)| other == target);
            let ready = open.iter().position(|(_, _, expression, _)| {
                !expression
                    .variables()
                    .iter()
                    .any(|name| variable(name, nominal).is_ok_and(|(target, _)| waits(&target)))
            });
            let Some(ready) = ready else {
                let (index, target, _, text) = &open[0];
                let allowed =
                    format!("made of values that do not depend on {} themselves", target.0.component_name(target.1));
                let remedy = "break the cycle: one of them needs a value of its own";
                errors.push(error_of(Table::Derive(*index), "expression", format!("{text:?}"), allowed, remedy));
                break;
            };
            let (index, (parameter, component), expression, text) = open.remove(ready);
            let sources = expression
                .variables()
                .iter()
                .filter_map(|name| variable(name, nominal).ok())
                .map(|(target, value)| match self.column_of(target) {
                    Some(column) => Source::Column(column),
                    None => Source::Nominal(value),
                })
                .collect();
            let column = self.column(parameter, component, nominal);
            let derived = Derived { column, expression, sources, text: text.to_owned() };
            let at_nominal = derived.value(|column| self.columns[column].nominal);
            let written = self.columns[column].nominal;
            let near = (at_nominal - written).abs() <= NOMINAL_SLACK * at_nominal.abs().max(written.abs());
            // a nominal that is not a number is the scene's error
            if !at_nominal.is_finite() && written.is_finite() {
                let allowed = "a finite number in the nominal scene".to_owned();
                let remedy = "a division by zero, or a root or logarithm of a negative number: change the expression";
                errors.push(error_of(Table::Derive(index), "expression", format!("{at_nominal:?}"), allowed, remedy));
            } else if !near && written.is_finite() {
                let allowed = format!(
                    "equal to the nominal {} = {written:?} in the nominal scene",
                    parameter.component_name(component)
                );
                let remedy = format!("write the nominal value {at_nominal:?}, or change the expression");
                errors.push(error_of(Table::Derive(index), "expression", format!("{at_nominal:?}"), allowed, remedy));
            }
            self.derived.push(derived);
        }
        errors
    }
}

/// The parameter that a name in an expression means, and its nominal value; or what it must be and the remedy.
fn variable(name: &str, nominal: &SceneInput) -> Result<((Parameter, usize), f64), (String, String)> {
    let Some((parameter, component)) = Parameter::find(name) else {
        let allowed = "a numeric key of scene or initial state, one component of it".to_owned();
        return Err((allowed, "write names as in this file, wheel1.radius_m or initial.position_m.x".to_owned()));
    };
    if parameter.shape() == Shape::Quaternion {
        let allowed = "other than an attitude, whose components are normalised after they were drawn".to_owned();
        return Err((allowed, "leave it out".to_owned()));
    }
    let component = match component {
        Some(component) => component,
        None if parameter.width() == 1 => 0,
        None => {
            let remedy = format!("write {} or another", parameter.component_name(0));
            return Err(("one component of a parameter".to_owned(), remedy));
        }
    };
    match parameter.value(nominal, component).filter(|_| parameter.exists(nominal, component)) {
        Some(value) => Ok(((parameter, component), value)),
        None => Err(("a key that the scene has".to_owned(), parameter.remedy().to_owned())),
    }
}
