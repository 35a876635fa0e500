//! Distributions of one number: quantiles against a published implementation, draws against distribution functions.

use crate::support::{draws::distance, prelude::*};
use spindrift::sampling::{
    Distribution, Stream,
    distribution::{
        beta::Beta,
        choice::Choice,
        empirical::{Empirical, Interpolation},
        exponential::Exponential,
        gamma::Gamma,
        log_normal::LogNormal,
        log_uniform::LogUniform,
        normal::Normal,
        pert::Pert,
        rayleigh::Rayleigh,
        student_t::StudentT,
        triangular::Triangular,
        truncated_normal::TruncatedNormal,
        uniform::Uniform,
        weibull::Weibull,
    },
};

fn law(name: &str, p: &[f64]) -> Distribution {
    match name {
        "normal" => Distribution::Normal(Normal { mean: p[0], std: p[1] }),
        "uniform" => Distribution::Uniform(Uniform { min: p[0], max: p[1] }),
        "log_normal" => Distribution::LogNormal(LogNormal { median: p[0], log_std: p[1] }),
        "log_uniform" => Distribution::LogUniform(LogUniform::new(p[0], p[1])),
        "triangular" => Distribution::Triangular(Triangular { min: p[0], mode: p[1], max: p[2] }),
        "beta" => Distribution::Beta(Beta::new(p[0], p[1], p[2], p[3])),
        "pert" => Distribution::Pert(Pert::new(p[0], p[1], p[2])),
        "truncated_normal" => Distribution::TruncatedNormal(TruncatedNormal::new(p[0], p[1], p[2], p[3]).unwrap()),
        other => panic!("{other}"),
    }
}

/// Relative; a normal value near its mean is measured against the width of its distribution.
const AGREEMENT: f64 = 1e-12;

#[test]
fn quantiles_are_those_of_scipy() {
    let golden: Value = serde_json::from_str(include_str!("../golden/quantiles.json")).unwrap();
    let rows = golden["rows"].as_array().unwrap();
    assert!(rows.len() > 250);
    let mut wrong = Vec::new();
    for row in rows {
        let name = row["law"].as_str().unwrap();
        let parameters: Vec<f64> = row["parameters"].as_array().unwrap().iter().map(number).collect();
        let (u, value) = (number(&row["u"]), number(&row["value"]));
        let law = law(name, &parameters);
        let ours = law.quantile(u);
        let scale = match name {
            "normal" | "truncated_normal" => value.abs().max(parameters[1]),
            _ => value.abs(),
        };
        let error = (ours - value).abs() / scale;
        if error > AGREEMENT {
            wrong.push(format!("{name} {parameters:?} at {u:e}: {ours:e}, scipy {value:e}, relative {error:.1e}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}\n{}", wrong.len(), rows.len(), wrong.join("\n"));
}

fn laws_of(name: &str, p: &[f64]) -> Vec<Distribution> {
    let beta = |min, max| Distribution::Beta(Beta::new(p[0], p[1], min, max));
    match name {
        "beta" => vec![beta(0.0, 1.0), beta(-1.0, 0.0)],
        "gamma" => vec![Distribution::Gamma(Gamma::new(p[0], 1.0, 0.0))],
        "student_t" => vec![Distribution::StudentT(StudentT::new(p[0], 0.0, 1.0))],
        "weibull" => vec![Distribution::Weibull(Weibull { shape: p[0], scale: 1.0, min: 0.0 })],
        "truncated_normal" => {
            TruncatedNormal::new(0.0, 1.0, p[0], p[1]).map(Distribution::TruncatedNormal).into_iter().collect()
        }
        "exponential" => vec![Distribution::Exponential(Exponential { scale: 1.0, min: 0.0 })],
        other => panic!("{other}"),
    }
}

/// 30 digits (mpmath).
#[test]
fn quantiles_are_those_of_mpmath() {
    let golden: Value = serde_json::from_str(include_str!("../golden/quantiles_mpmath.json")).unwrap();
    let rows = golden["rows"].as_array().unwrap();
    let mut worst: std::collections::BTreeMap<String, f64> = Default::default();
    let mut made: Option<(String, Vec<Distribution>)> = None;
    for row in rows {
        let p: Vec<f64> = row[1].as_array().unwrap().iter().map(number).collect();
        let (name, u, value) = (row[0].as_str().unwrap(), number(&row[2]), number(&row[3]));
        let key = format!("{name} {p:?}");
        if made.as_ref().is_none_or(|(other, _)| *other != key) {
            made = Some((key.clone(), laws_of(name, &p)));
        }
        let ours: Vec<f64> = made.iter().flat_map(|(_, laws)| laws.iter().map(|law| law.quantile(u))).collect();
        // a median of zero is compared with 1
        let pairs = match name {
            "beta" => vec![(ours[0], value), (-ours[1], number(&row[4]))],
            _ if value == 0.0 => vec![(1.0 + ours[0], 1.0)],
            _ => vec![(ours[0], value)],
        };
        for (ours, theirs) in pairs {
            let error = (ours / theirs - 1.0).abs();
            let most = worst.entry(key.clone()).or_default();
            *most = most.max(error);
        }
    }
    assert!(rows.len() > 270, "{}", rows.len());
    let wrong: Vec<_> = worst.iter().filter(|(_, error)| **error > 1e-12).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::INFINITY)
}

/// Kolmogorov and Smirnov: alpha = 1e-3 gives sqrt(n) D < 1.949. A distribution function off by 0.01 gives 4.5, with a
/// standard deviation of at most 0.5.
const N: usize = 200_000;
const CRITICAL: f64 = 1.949;

fn draws(law: &Distribution) -> Vec<f64> {
    let mut stream = Stream::new(11, "laws");
    let mut values: Vec<f64> = (0..N as u64).map(|k| law.quantile(stream.uniform(SampleId(k)))).collect();
    values.sort_by(f64::total_cmp);
    values
}

#[test]
fn draws_follow_their_distributions() {
    let rayleigh = |scale: f64| move |x: f64| 1.0 - (-0.5 * (x / scale).powi(2)).exp();
    let values = draws(&Distribution::Rayleigh(Rayleigh { scale: 0.02 }));
    assert!(distance(values.iter().copied(), rayleigh(0.02)) < CRITICAL);
    assert!(distance(values.iter().copied(), rayleigh(0.0204)) > CRITICAL, "a scale off by 2% is found");

    let lines = Empirical::new(&[0.0, 1.0, 3.0], Interpolation::Linear);
    let values = draws(&Distribution::Empirical(lines));
    assert!(distance(values.iter().copied(), |x| if x < 1.0 { x / 2.0 } else { 0.5 + (x - 1.0) / 4.0 }) < CRITICAL);
}

/// H0: each value is drawn with its weight; chi-square with 3 degrees of freedom, alpha = 1e-3. A weight of 0.41 in
/// place of 0.4 shifts the statistic by 50.
#[test]
fn listed_values_come_in_proportion() {
    let counted = |weights: &[f64; 4]| {
        let values = draws(&Distribution::Choice(Choice::new(&[4.0, 1.0, 3.0, 2.0], weights)));
        let count = |value: f64| values.iter().filter(|x| **x == value).count() as f64;
        let expected = [0.1, 0.4, 0.2, 0.3].map(|weight| weight * N as f64);
        let counts = [count(4.0), count(1.0), count(3.0), count(2.0)];
        assert_eq!(counts.iter().sum::<f64>(), N as f64);
        counts.iter().zip(expected).map(|(count, expected)| (count - expected).powi(2) / expected).sum::<f64>()
    };
    const CRITICAL: f64 = 16.27;
    assert!(counted(&[1.0, 4.0, 2.0, 3.0]) < CRITICAL);
    assert!(counted(&[1.0, 4.1, 2.0, 2.9]) > CRITICAL, "a weight that is off is found");
    let values = draws(&Distribution::Empirical(Empirical::new(&[1.0, 2.0, 2.0, 5.0], Interpolation::None)));
    let twos = values.iter().filter(|x| **x == 2.0).count() as f64;
    // 3.29 standard errors: alpha = 1e-3
    assert!((twos / N as f64 - 0.5).abs() < 3.29 * 0.5 / (N as f64).sqrt());
}

/// Law: every quantile rises with u and is finite at both ends.
#[test]
fn quantiles_rise() {
    let mut laws: Vec<Distribution> = vec![
        Distribution::LogNormal(LogNormal { median: 2.5, log_std: 0.4 }),
        Distribution::LogUniform(LogUniform::new(0.1, 10.0)),
        Distribution::Rayleigh(Rayleigh { scale: 0.02 }),
        Distribution::Triangular(Triangular { min: 1.0, mode: 4.0, max: 4.0 }),
        Distribution::Choice(Choice::new(&[4.0, 1.0], &[0.25, 0.75])),
        Distribution::Empirical(Empirical::new(&[3.0, 1.0, 2.0], Interpolation::None)),
    ];
    for (a, b) in [(0.01, 0.01), (0.01, 1e4), (1e4, 0.01), (1e4, 1e4), (1.0, 3.0), (0.5, 0.02)] {
        laws.push(Distribution::Beta(Beta::new(a, b, -1.0, 2.0)));
    }
    // numbers near the largest
    let extreme = [
        law("log_uniform", &[1e-300, 1e300]),
        law("triangular", &[-1e160, 0.0, 1e160]),
        law("triangular", &[-1.7e308, 0.0, 1.7e308]),
        law("uniform", &[-1.7e308, 1.7e308]),
        law("beta", &[2.0, 3.0, -1.7e308, 1.7e308]),
        law("pert", &[-1.7e308, 0.0, 1.7e308]),
        Distribution::Empirical(Empirical::new(&[-1.7e308, 1.7e308], Interpolation::Linear)),
    ];
    assert!(
        extreme.iter().all(|law| law.quantile(1e-3) < law.quantile(0.3) && law.quantile(0.7) < law.quantile(0.999))
    );
    for law in laws.into_iter().chain(extreme) {
        let ends = [f64::EPSILON / 2.0, 1e-12, 1e-3];
        let u: Vec<f64> = ends.into_iter().chain((1..100).map(|k| f64::from(k) / 100.0)).collect();
        let mut values: Vec<f64> = u.iter().map(|u| law.quantile(*u)).collect();
        values.extend(ends.iter().rev().map(|end| law.quantile(1.0 - end)));
        assert!(values.iter().all(|x| x.is_finite()), "{law:?}: {values:?}");
        assert!(values.is_sorted(), "{law:?}: {values:?}");
    }
}
