//! [`Limit`]: the condition on the numbers of one key.

use crate::math::symmetric::{is_positive_definite, principal_axes};
use crate::scene::error::Problems;
use crate::scene::tensor::extremes;
use std::borrow::Cow;

/// Largest deviation from one of the norm of a written attitude quaternion: six digits make 1e-6.
pub const UNIT_NORM_TOLERANCE: f64 = 1e-6;

/// Slack of symmetry and triangle inequality, relative to the trace: the rounding of a tensor computed elsewhere.
pub const INERTIA_SLACK: f64 = 16.0 * f64::EPSILON;

/// A condition on the numbers of a key; all must be finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// Nothing else.
    Finite,
    /// Above zero.
    Positive,
    /// Zero or above.
    NotNegative,
    /// A thrust or a factor on one: zero or above; with the remedy.
    Thrust(&'static str),
    /// A direction: not all zero.
    Direction,
    /// A quaternion of norm one, to [`UNIT_NORM_TOLERANCE`].
    UnitQuaternion,
    /// An inertia tensor about a centre of mass: symmetric, positive definite, triangle inequality, to
    /// [`INERTIA_SLACK`].
    Inertia,
    /// Principal moments of inertia: above zero, none above the sum of the other two.
    PrincipalMoments,
}

impl Limit {
    /// The limit in words, after "must be".
    pub const fn words(self) -> &'static str {
        match self {
            Limit::Finite => "finite",
            Limit::Positive => "above zero",
            Limit::NotNegative | Limit::Thrust(_) => "zero or above",
            Limit::Direction => "not all zero",
            Limit::UnitQuaternion => "a quaternion of norm 1",
            Limit::Inertia => "symmetric, positive definite, no principal moment above the sum of the other two",
            Limit::PrincipalMoments => "above zero, no moment above the sum of the other two",
        }
    }

    /// `count` numbers within the limit, as in a campaign file.
    pub fn example(self, count: usize) -> String {
        match (self, count) {
            (Limit::UnitQuaternion, _) => "[1, 0, 0, 0]".to_owned(),
            (Limit::Direction, _) => "[0, 0, 1]".to_owned(),
            (Limit::PrincipalMoments, _) => "[3, 3, 2]".to_owned(),
            (Limit::Inertia, _) | (_, 9) => "[[3, 0, 0], [0, 3, 0], [0, 0, 2]]".to_owned(),
            (Limit::Positive, _) => format!("[{}]", vec!["1"; count].join(", ")),
            _ => format!("[{}]", vec!["0"; count].join(", ")),
        }
    }

    /// Notes what is wrong with the numbers of `key`.
    #[inline(always)]
    pub(in crate::scene) fn check(self, key: impl Fn() -> Cow<'static, str>, numbers: &[f64], problems: &mut Problems) {
        if !numbers.iter().all(|number| number.is_finite()) {
            return not_finite(key(), numbers, problems);
        }
        match self {
            Limit::Finite => {}
            Limit::Positive => {
                if !numbers.iter().all(|number| *number > 0.0) {
                    signs(self, key(), numbers, problems);
                }
            }
            Limit::NotNegative | Limit::Thrust(_) => {
                if !numbers.iter().all(|number| *number >= 0.0) {
                    signs(self, key(), numbers, problems);
                }
            }
            Limit::Direction => {
                // a length whose square neither vanishes nor overflows, so that it can be divided by
                let square = numbers.iter().map(|x| x * x).sum::<f64>();
                if !(f64::MIN_POSITIVE..f64::INFINITY).contains(&square) {
                    let allowed = "a direction: three numbers, not all zero, with a length between 1e-150 and 1e150";
                    problems.add(key(), shown(numbers), allowed, "write an axis such as [0, 0, 1]");
                }
            }
            Limit::UnitQuaternion => unit_quaternion(&key, numbers, problems),
            Limit::Inertia => inertia(&key, numbers, problems),
            Limit::PrincipalMoments => principal_moments(&key, numbers, problems),
        }
    }
}

/// Out of line, so that a valid draw runs straight through.
#[cold]
#[inline(never)]
fn signs(limit: Limit, key: Cow<'static, str>, numbers: &[f64], problems: &mut Problems) {
    let (allowed, remedy) = match (limit, numbers.len()) {
        (Limit::Thrust(remedy), _) => ("zero or above, each: a thruster does not pull", remedy),
        (Limit::Positive, 1) => ("above zero", "write a positive number"),
        (Limit::Positive, _) => ("above zero, each", "write positive numbers"),
        (_, 1) => ("zero or above", "write zero or a positive number"),
        _ => ("zero or above, each", "write zero or positive numbers"),
    };
    problems.add(key, shown(numbers), allowed, remedy);
}

#[cold]
#[inline(never)]
fn not_finite(key: Cow<'static, str>, numbers: &[f64], problems: &mut Problems) {
    let (allowed, remedy) = match numbers.len() {
        1 => ("a finite number", "write a finite number"),
        9 => ("nine finite numbers", "write finite numbers"),
        _ => ("finite numbers", "write finite numbers"),
    };
    problems.add(key, shown(numbers), allowed, remedy);
}

/// The numbers as in a campaign file: one, a list, or for nine of them three rows.
pub fn shown(numbers: &[f64]) -> String {
    match numbers {
        [number] => format!("{number:?}"),
        [_, _, _, _, _, _, _, _, _] => format!("{:?}", numbers.chunks(3).collect::<Vec<_>>()),
        list => format!("{list:?}"),
    }
}

#[inline(always)]
fn unit_quaternion(key: &dyn Fn() -> Cow<'static, str>, q: &[f64], problems: &mut Problems) {
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    if (norm - 1.0).abs() > UNIT_NORM_TOLERANCE {
        let allowed = format!("a quaternion of norm 1 within {UNIT_NORM_TOLERANCE:?} (its norm is {norm:?})");
        let remedy = if norm > 0.0 && norm.is_finite() {
            "divide the four numbers by the norm"
        } else {
            "write [1, 0, 0, 0] for the identity"
        };
        problems.add(key(), shown(q), allowed, remedy);
    }
}

fn principal_moments(key: &dyn Fn() -> Cow<'static, str>, numbers: &[f64], problems: &mut Problems) {
    let &[a, b, c] = numbers else { return };
    if numbers.iter().any(|moment| *moment <= 0.0) {
        return signs(Limit::Positive, key(), numbers, problems);
    }
    let [_, largest] = extremes([a, b, c]);
    let slack = INERTIA_SLACK * (a + b + c);
    if a > b + c + slack || b > a + c + slack || c > a + b + slack {
        let otherwise =
            "no distribution of mass has these moments; principal_second_moments_kg_m2 cannot fail in this way";
        let (excess, remedy) = excess([a, b, c], largest, otherwise);
        let allowed = format!("such that no moment exceeds the sum of the other two ({excess})");
        problems.add(key(), shown(numbers), allowed, remedy);
    }
}

/// Excesses up to this fraction of the trace are taken for rounding of written digits.
const WRITTEN_ROUNDING: f64 = 1e-4;

/// The excess of the `largest` of three moments over the sum of the other two, and its remedy.
fn excess(moments: [f64; 3], largest: f64, otherwise: &'static str) -> (String, &'static str) {
    let trace = moments[0] + moments[1] + moments[2];
    let beyond = largest - (trace - largest);
    let is_rounding = beyond <= WRITTEN_ROUNDING * trace;
    let remedy = if is_rounding { "write more digits, or make the largest moment smaller by that" } else { otherwise };
    (format!("{largest:?} exceeds it by {beyond:.1e} kg m^2, {:.1e} of the trace", beyond / trace), remedy)
}

fn inertia(key: &dyn Fn() -> Cow<'static, str>, numbers: &[f64], problems: &mut Problems) {
    let &[xx, xy, xz, yx, yy, yz, zx, zy, zz] = numbers else { return };
    let tensor = [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]];
    let slack = INERTIA_SLACK * (xx.abs() + yy.abs() + zz.abs());
    let pairs = [("xy", xy, yx), ("xz", xz, zx), ("yz", yz, zy)];
    let apart = |(_, upper, lower): &(&str, f64, f64)| (upper - lower).abs();
    let wrong = pairs.iter().filter(|pair| apart(pair) > slack);
    if let Some((name, upper, lower)) = wrong.max_by(|one, other| apart(one).total_cmp(&apart(other))) {
        let allowed = format!("symmetric ({name} is {upper:?} above the diagonal and {lower:?} below)");
        let remedy = "write products of inertia equal on both sides of the diagonal";
        return problems.add(key(), shown(numbers), allowed, remedy);
    }
    let (moments, _) = principal_axes(tensor);
    let [smallest, largest] = extremes(moments);
    if smallest <= 0.0 || !is_positive_definite(tensor) {
        let allowed = format!("positive definite (its principal moments are {moments:?})");
        let remedy = "check signs; products of inertia are minus the integrals of x y";
        problems.add(key(), shown(numbers), allowed, remedy);
    } else if largest > (moments[0] + moments[1] + moments[2] - largest) + slack {
        let otherwise = "no distribution of mass has these moments; check units and the point they refer to";
        let (excess, remedy) = excess(moments, largest, otherwise);
        let allowed =
            format!("such that no principal moment exceeds the sum of the other two (they are {moments:?}: {excess})");
        problems.add(key(), shown(numbers), allowed, remedy);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: examples in messages satisfy their limits.
    #[test]
    fn examples_satisfy_their_limits() {
        for (limit, example) in [
            (Limit::Finite, vec![0.0; 2]),
            (Limit::NotNegative, vec![0.0; 3]),
            (Limit::Positive, vec![1.0; 3]),
            (Limit::Direction, vec![0.0, 0.0, 1.0]),
            (Limit::UnitQuaternion, vec![1.0, 0.0, 0.0, 0.0]),
            (Limit::PrincipalMoments, vec![3.0, 3.0, 2.0]),
            (Limit::Inertia, vec![3.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 2.0]),
        ] {
            assert_eq!(limit.example(example.len()), shown(&example).replace(".0", ""), "{limit:?}");
            let mut problems = Problems::default();
            limit.check(|| Cow::Borrowed("key"), &example, &mut problems);
            assert!(problems.0.is_empty(), "{limit:?}: {:?}", problems.0);
        }
    }
}
