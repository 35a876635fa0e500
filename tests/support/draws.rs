//! Draws of a plan, and statistics of them.

use super::prelude::*;

pub fn seen<T>(
    plan: &Plan,
    ids: impl IntoIterator<Item = u64>,
    mut see: impl FnMut(&SceneInput, &[f64]) -> T,
) -> Vec<T> {
    let (mut sampler, mut scene) = (plan.dispersions.sampler(), plan.nominal.clone());
    let mut applied = vec![0.0; plan.dispersions.columns().len()];
    let draw = |id| {
        sampler.draw(SampleId(id), &mut scene, &mut applied);
        see(&scene, &applied)
    };
    ids.into_iter().map(draw).collect()
}

/// Slope of the least-squares line through `points`.
pub fn slope(points: &[[f64; 2]]) -> f64 {
    let mean = |i: usize| points.iter().map(|p| p[i]).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let covariance: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    covariance / points.iter().map(|p| (p[0] - x) * (p[0] - x)).sum::<f64>()
}

pub fn applied(plan: &Plan, ids: impl IntoIterator<Item = u64>) -> Vec<Vec<f64>> {
    seen(plan, ids, |_, applied| applied.to_vec())
}

pub fn scenes(plan: &Plan, ids: impl IntoIterator<Item = u64>) -> Vec<Scene> {
    seen(plan, ids, |input, _| resolved(input))
}

pub fn names(plan: &Plan) -> Vec<String> {
    plan.dispersions.columns().iter().map(|column| column.parameter.component_name(column.component)).collect()
}

pub fn column(plan: &Plan, name: &str, ids: impl IntoIterator<Item = u64>) -> Vec<f64> {
    let index = names(plan).iter().position(|known| known == name).unwrap_or_else(|| panic!("{name} is not dispersed"));
    seen(plan, ids, |_, applied| applied[index])
}

pub fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let (ma, mb) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(a, b)| f(a - ma, b - mb)).sum::<f64>();
    sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt()
}

/// Kolmogorov and Smirnov's sqrt(n) D: the largest distance between the empirical distribution function and `law`.
pub fn distance(values: impl IntoIterator<Item = f64>, law: impl Fn(f64) -> f64) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    let far = values.iter().enumerate().fold(0.0f64, |far, (k, x)| {
        let p = law(*x);
        far.max((p - k as f64 / n).abs()).max(((k + 1) as f64 / n - p).abs())
    });
    far * n.sqrt()
}
