//! Correlated and derived parameters: the applied values have the dependence of the file.

use crate::prelude::*;
use spindrift::math::normal::probability;

use crate::support::campaigns::WHEEL2_AT_REST;
use crate::support::draws::correlation;

const HEAD: &str = r#"
[campaign]
name = "test"
samples = 20001
seed = 3
duration_s = 1.0
"#;

const DISPERSED: &str = r#"
[initial]
angular_velocity_rad_s = [0, 3, 31]
[[disperse]]
parameter = "wheels.w1.density_kg_m3"
distribution = "uniform"
half_width = 100
[[disperse]]
parameter = "wheels.w2.density_kg_m3"
distribution = "log_normal"
log_std = 0.3
[[disperse]]
parameter = "wheels.w1.radius_m"
distribution = "truncated_normal"
std = 0.01
sigmas = 2
[[disperse]]
parameter = "initial.angular_velocity_rad_s"
distribution = "normal"
std = [0.5, 1.0, 2.0]
"#;

fn campaign(text: &str) -> String {
    [HEAD, FUSELAGE, WHEEL1_AT_REST, WHEEL2_AT_REST, DISPERSED, text].concat()
}

fn plan(text: &str) -> Plan {
    planned(&campaign(text))
}

const N: usize = 20_000;

fn column(plan: &Plan, name: &str) -> Vec<f64> {
    draws::column(plan, name, 1..=N as u64)
}

fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    order.into_iter().enumerate().for_each(|(rank, place)| ranks[place] = rank as f64);
    ranks
}

fn rank_correlation(a: &[f64], b: &[f64]) -> f64 {
    correlation(&ranks(a), &ranks(b))
}

/// Half the band in Fisher's transform at alpha = 1e-3; for rank correlations the variance is 1 + rho^2/2 times as
/// large (D. G. Bonett & T. A. Wright, *Psychometrika* 65 (2000) 23). A value off by 0.05 is 6 standard deviations
/// away.
fn band(expected: f64) -> f64 {
    3.29 * (1.0 + 0.5 * expected * expected).sqrt() / 141.4
}

fn in_band(sample: f64, expected: f64) -> bool {
    (sample.atanh() - expected.atanh()).abs() < band(expected)
}

#[test]
fn rank_correlations_are_those_of_the_file() {
    let pair = |r: f64| {
        format!(
            "[[correlate]]\nparameters = [\"wheels.w1.density_kg_m3\", \"wheels.w2.density_kg_m3\", \
            \"wheels.w1.radius_m\"]\n\
             rank_correlation = [[1, {r}, 0.3], [{r}, 1, -0.2], [0.3, -0.2, 1]]\n"
        )
    };
    for kind in ["random", "sobol", "halton"] {
        let plan = plan(&format!("[design]\nkind = {kind:?}\n{}", pair(-0.7)));
        let [a, b, c] = ["wheels.w1.density_kg_m3", "wheels.w2.density_kg_m3", "wheels.w1.radius_m"]
            .map(|name| column(&plan, name));
        let found = [rank_correlation(&a, &b), rank_correlation(&a, &c), rank_correlation(&b, &c)];
        for (found, expected) in found.into_iter().zip([-0.7, 0.3, -0.2]) {
            assert!(in_band(found, expected), "{kind}: {found} for {expected}");
        }
        assert!(!in_band(found[0], -0.65), "a correlation off by 0.05 is found");
        let z = column(&plan, "initial.angular_velocity_rad_s.z");
        assert!(in_band(rank_correlation(&a, &z), 0.0));
    }
}

fn mid_ranks(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = |x: &f64| (sorted.partition_point(|y| y < x) + sorted.partition_point(|y| y <= x)) as f64 / 2.0;
    values.iter().map(rank).collect()
}

const DISCRETE: &str = "[[disperse]]\nparameter = \"body.parts.fuselage.density_kg_m3\"\ndistribution = \"choice\"\n\
     values = [2600, 2700, 2800]\nweights = [1, 2, 7]\n\
     [[disperse]]\nparameter = \"wheels.w2.radius_m\"\ndistribution = \"bernoulli\"\nvalue = 0.3\nprobability = 0.5\n";

fn discrete(parameters: [&str; 2], rank: f64) -> String {
    format!("{DISCRETE}[[correlate]]\nparameters = {parameters:?}\nrank_correlation = {rank}\n")
}

/// The formula for continuous values gives 0.42 in place of 0.6 (band: 0.03).
#[test]
fn rank_correlations_of_discrete_values_are_those_of_the_file() {
    for (names, rank) in [
        (["body.parts.fuselage.density_kg_m3", "wheels.w2.radius_m"], 0.6),
        (["body.parts.fuselage.density_kg_m3", "wheels.w2.radius_m"], -0.5),
        (["body.parts.fuselage.density_kg_m3", "wheels.w1.radius_m"], 0.7),
    ] {
        let plan = plan(&discrete(names, rank));
        let [a, b] = names.map(|name| mid_ranks(&column(&plan, name)));
        let found = correlation(&a, &b);
        assert!(in_band(found, rank), "{names:?}: {found} for {rank}");
        assert!(!in_band(found, 0.9 * rank), "a tenth less is found");
    }
    let text = campaign(&discrete(["body.parts.fuselage.density_kg_m3", "wheels.w2.radius_m"], 0.8));
    let refused = parsed(&text).expect_err("more than can be reached");
    assert_says(refused.to_string(), ["correlate[0].rank_correlation = 0.8: must be from -0.6", "discrete"]);
}

/// Law: one number, blocks of pairs of parameters, and the square matrix of all say the same.
#[test]
fn blocks_and_numbers_are_the_matrix_that_they_make() {
    let all = plan(
        "[[correlate]]\nparameters = [\"wheels.w1.density_kg_m3\", \"initial.angular_velocity_rad_s\", \
        \"wheels.w1.radius_m\"]\n\
         correlation = [[1, 0.5, 0, 0.25, 0.125], [0.5, 1, 0, 0, 0], [0, 0, 1, 0, 0], [0.25, 0, 0, 1, 0], [0.125, 0, \
         0, 0, 1]]\n",
    );
    let blocks = plan(
        "[[correlate]]\nparameters = [\"wheels.w1.density_kg_m3\", \"initial.angular_velocity_rad_s\"]\n\
         correlation = [[0.5, 0, 0.25]]\n\
         [[correlate]]\nparameters = [\"wheels.w1.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = 0.125\n",
    );
    for name in ["wheels.w1.density_kg_m3", "wheels.w1.radius_m", "initial.angular_velocity_rad_s.z"] {
        assert_eq!(column(&all, name), column(&blocks, name), "{name}");
    }
    assert_ne!(column(&all, "wheels.w1.radius_m"), column(&plan(""), "wheels.w1.radius_m"));
    assert_eq!(planned(&blocks.text()).hash(), blocks.hash());
    // covariances are those of normal distributions
    let normal = "[[disperse]]\nparameter = \"initial.position_m.x\"\ndistribution = \"normal\"\nstd = 3\n\
         [[correlate]]\nparameters = [\"initial.angular_velocity_rad_s.z\", \"initial.position_m.x\"]\ncovariance = \
         3.0\n";
    let plan = plan(normal);
    let (z, x) = (column(&plan, "initial.angular_velocity_rad_s.z"), column(&plan, "initial.position_m.x"));
    assert!(in_band(correlation(&z, &x), 0.5));
}

/// H0: each value keeps its law inside a block.
#[test]
fn correlation_preserves_the_distributions() {
    /// Kolmogorov's constant for alpha = 1e-3: sqrt(-ln(alpha/2)/2).
    const CRITICAL: f64 = 1.949;
    let plan = plan(
        "[[correlate]]\nparameters = [\"wheels.w2.density_kg_m3\", \"wheels.w1.density_kg_m3\", \
        \"wheels.w1.radius_m\"]\n\
         correlation = [[1, 0.95, 0.5], [0.95, 1, 0.5], [0.5, 0.5, 1]]\n",
    );
    let distance = |name: &str, law: &dyn Fn(f64) -> f64| draws::distance(column(&plan, name), law);
    assert!(distance("wheels.w1.density_kg_m3", &|x| (x - 2600.0) / 200.0) < CRITICAL);
    assert!(distance("wheels.w2.density_kg_m3", &|x| probability((x / 2700.0).ln() / 0.3)) < CRITICAL);
    let (low, high) = (probability(-2.0), probability(2.0));
    assert!(distance("wheels.w1.radius_m", &|x| (probability((x - 0.25) / 0.01) - low) / (high - low)) < CRITICAL);
    assert!(distance("wheels.w1.density_kg_m3", &|x| (x - 2606.0) / 200.0) > CRITICAL, "a law off by 0.03 is found");
    for (row, x) in column(&plan, "wheels.w1.radius_m").into_iter().enumerate() {
        assert!((0.23..=0.27).contains(&x), "row {row}: the bounds hold: {x}");
    }
}

/// The standard deviation of a sample variance is sqrt(2/n) = 1% of it; alpha = 1e-3 each.
#[test]
fn covariances_are_those_of_the_file() {
    let plan = plan(
        "[[correlate]]\nparameters = [\"initial.angular_velocity_rad_s\"]\n\
         covariance = [[0.25, 0.3, 0.0], [0.3, 1.0, -1.2], [0.0, -1.2, 4.0]]\n",
    );
    let [x, y, z] = ["x", "y", "z"].map(|c| column(&plan, &format!("initial.angular_velocity_rad_s.{c}")));
    for (found, expected) in [(correlation(&x, &y), 0.6), (correlation(&y, &z), -0.6), (correlation(&x, &z), 0.0)] {
        assert!(in_band(found, expected), "{found} for {expected}");
    }
    let variance = z.iter().map(|z| (z - 31.0).powi(2)).sum::<f64>() / N as f64;
    // measured: a third of that
    assert!((variance / 4.0 - 1.0).abs() < 3.29 * (2.0 / N as f64).sqrt());
}

#[test]
fn a_singular_matrix_ties_values_and_an_impossible_one_is_repaired_on_request() {
    let tied = plan(
        "[[correlate]]\nparameters = [\"wheels.w1.density_kg_m3\", \"wheels.w2.density_kg_m3\"]\ncorrelation = [[1, \
        1], [1, 1]]\n",
    );
    let (a, b) = (column(&tied, "wheels.w1.density_kg_m3"), column(&tied, "wheels.w2.density_kg_m3"));
    // measured: no rounding at all
    assert!((rank_correlation(&a, &b) - 1.0).abs() < 1e-15);
    let matrix = "[[correlate]]\nparameters = [\"initial.angular_velocity_rad_s\"]\ncorrelation = [[1, 1, 0], [1, 1, \
        1], [0, 1, 1]]\n";
    assert_says(parsed(&campaign(matrix)).expect_err("refused").to_string(), ["smallest eigenvalue", "-0.414214"]);
    let repaired = plan(&format!("{matrix}nearest_psd = true\n"));
    let [x, y] = ["x", "y"].map(|c| column(&repaired, &format!("initial.angular_velocity_rad_s.{c}")));
    assert!(in_band(correlation(&x, &y), 0.7607), "the nearest matrix of Higham (2002)");
    let [replaced] = repaired.dispersions.replaced_correlations() else { panic!("one matrix was replaced") };
    // half a unit of the last digit of the paper; measured: 0.76069
    assert!((replaced.used[0][1] - 0.7607).abs() < 5e-5 && replaced.written[0][1] == 1.0);
    assert!(repaired.text().contains("# nearest correlation of the normal scores, which is used: [[1.0, 0.76"));
    assert_eq!(planned(&repaired.text()).hash(), repaired.hash());
}

/// Law: a derived value is its expression of the values as applied, in sample 0 too.
#[test]
fn derived_values_follow_their_expressions() {
    let plan = plan(
        "[[derive]]\nparameter = \"wheels.w2.radius_m\"\nexpression = \"wheels.w2.length_m * 2.5\"\n\
         [[derive]]\nparameter = \"wheels.w2.length_m\"\nexpression = \"0.4 * wheels.w1.radius_m\"\n\
         [[derive]]\nparameter = \"initial.velocity_m_s.x\"\n\
         expression = \"if(wheels.w1.density_kg_m3 > 2700, sqrt(wheels.w1.density_kg_m3 - 2700), 0) * \
         body.parts.fuselage.length_m\"\n",
    );
    let [r1, r2, l2, v, d] = [
        "wheels.w1.radius_m",
        "wheels.w2.radius_m",
        "wheels.w2.length_m",
        "initial.velocity_m_s.x",
        "wheels.w1.density_kg_m3",
    ]
    .map(|name| column(&plan, name));
    for k in 0..N {
        assert_eq!(l2[k], 0.4 * r1[k]);
        assert_eq!(r2[k], l2[k] * 2.5);
        assert_eq!(v[k], if d[k] > 2700.0 { (d[k] - 2700.0).sqrt() } else { 0.0 } * 3.0);
    }
    assert!(v.contains(&0.0) && v.iter().any(|v| *v > 0.0));
    let scene = draws::seen(&plan, [3, 0], |scene, _| scene.clone()).remove(1);
    assert_eq!(scene, plan.nominal);
}

#[test]
fn correlation_does_not_touch_other_draws() {
    let alone = plan("");
    let tied = plan(
        "[[correlate]]\nparameters = [\"wheels.w1.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[1, 0.5], \
        [0.5, 1]]\n\
         [[derive]]\nparameter = \"wheels.w2.radius_m\"\nexpression = \"wheels.w1.radius_m\"\n",
    );
    for name in ["wheels.w2.density_kg_m3", "initial.angular_velocity_rad_s.x", "initial.angular_velocity_rad_s.z"] {
        assert_eq!(column(&alone, name), column(&tied, name), "{name}");
    }
    assert_ne!(column(&alone, "wheels.w1.radius_m"), column(&tied, "wheels.w1.radius_m"));
}

/// H0: neighbouring samples, and components of one sample, are uncorrelated. alpha = 1e-3 each; a correlation of 0.02
/// is found with power 0.998.
#[test]
fn components_and_samples_are_independent() {
    const DRAWS: u64 = 100_000;
    const CRITICAL: f64 = 3.29;
    let plan = plan("");
    let [x, y, z] =
        ["x", "y", "z"].map(|c| draws::column(&plan, &format!("initial.angular_velocity_rad_s.{c}"), 1..=DRAWS));
    let size = |a: &[f64], b: &[f64]| correlation(a, b).abs() * (a.len() as f64).sqrt();
    let neighbours = size(&x[1..], &x[..x.len() - 1]);
    assert!([size(&x, &y), size(&y, &z), neighbours].iter().all(|size| *size < CRITICAL));
    let mixed: Vec<f64> = x.iter().zip(&y).map(|(x, y)| y + 0.04 * x).collect();
    assert!(size(&x, &mixed) > CRITICAL, "a correlation of 0.02 is found");
}
