//! Replicates of a design: each is a design of its kind, and independent of the others.

use crate::prelude::*;
use spindrift::sampling::design::BLOCK;

const DIMENSIONS: usize = 4;

fn names() -> Vec<String> {
    (0..DIMENSIONS).map(|dimension| format!("x{dimension}")).collect()
}

fn designs(replicates: u64) -> [Design; 3] {
    let written = || Written::NONE.with("replicates", replicates);
    [Design::LatinHypercube(written()), Design::Sobol(written()), Design::Halton(written())]
}

fn numbers(design: &Design, seed: u64, points: u64) -> Vec<[f64; DIMENSIONS]> {
    let names = names();
    let mut source = design.points(Dimensions { seed, samples: points + 1, names: &names, factors: &[0, 1, 2, 3] });
    let (mut u, mut found) = (vec![[0.0; BLOCK]; DIMENSIONS], Vec::new());
    for block in 0..=points / BLOCK as u64 {
        source.fill(block, &mut u);
        let lanes = (0..BLOCK).filter(|lane| (1..=points).contains(&(block * BLOCK as u64 + *lane as u64)));
        found.extend(lanes.map(|lane| from_fn(|dimension| u[dimension][lane])));
    }
    found
}

fn replicates(design: &Design, seed: u64, count: u64) -> Vec<Vec<[f64; DIMENSIONS]>> {
    let mut found = vec![Vec::new(); design.replicates() as usize];
    for (index, numbers) in numbers(design, seed, count * design.replicates()).into_iter().enumerate() {
        let replicate = design.replicate_of(SampleId(index as u64 + 1)).unwrap();
        found[replicate as usize].push(numbers);
    }
    found
}

fn is_stratified(points: &[[f64; DIMENSIONS]], dimensions: usize) -> bool {
    (0..dimensions).all(|dimension| {
        let mut counts = vec![0; points.len()];
        points.iter().for_each(|point| counts[(point[dimension] * points.len() as f64) as usize] += 1);
        counts.iter().all(|count| *count == 1)
    })
}

/// Law: each replicate is a hypercube, a net, a sequence; all together, and points of several replicates mixed, are
/// none.
#[test]
fn each_replicate_is_a_design_of_its_kind() {
    let [latin, sobol, halton] = designs(16);
    for (design, dimensions) in [(&latin, DIMENSIONS), (&sobol, DIMENSIONS), (&halton, 1)] {
        let all = replicates(design, 3, 64);
        assert_eq!(all.len(), 16);
        for (index, replicate) in all.iter().enumerate() {
            assert_eq!(replicate.len(), 64);
            assert!(is_stratified(replicate, dimensions), "{} {index}", design.name());
        }
        assert!(!is_stratified(&all.concat(), dimensions), "{}", design.name());
        let mixed: Vec<_> = (0..64).map(|point| all[point % 16][point]).collect();
        assert!(!is_stratified(&mixed, dimensions), "{}", design.name());
    }
    for replicate in replicates(&sobol, 3, 64) {
        for wide in 0..=6 {
            let mut counts = [0; 64];
            for point in &replicate {
                let (column, row) = (point[0] * f64::from(1 << wide), point[1] * f64::from(1 << (6 - wide)));
                counts[((column as usize) << (6 - wide)) + row as usize] += 1;
            }
            assert_eq!(counts, [1; 64], "boxes of 2^{wide} columns");
        }
    }
    for replicate in replicates(&halton, 3, 125) {
        let mut counts = [0; 125];
        replicate.iter().for_each(|point| counts[(point[2] * 125.0) as usize] += 1);
        assert_eq!(counts, [1; 125]);
    }
}

/// Law: one replicate changes no bit, and more samples leave earlier ones where the design does.
#[test]
fn one_replicate_is_the_design() {
    for (one, many) in designs(1).into_iter().zip(designs(4)) {
        assert_eq!(one.replicates(), 1);
        assert_ne!(numbers(&one, 3, 64), numbers(&many, 3, 64));
        if one.facts().depends_on_samples.is_none() {
            assert_eq!(numbers(&many, 3, 64), numbers(&many, 3, 128)[..64]);
        }
    }
    let text = |design: &str| format!("{HEAD}{design}{DISPERSION}");
    for kind in ["latin_hypercube", "sobol", "halton"] {
        let plan = |extra: &str| read(&text(&format!("[design]\nkind = {kind:?}\n{extra}"))).unwrap();
        assert_eq!(plan(""), plan("replicates = 1\n"));
        let many = plan("replicates = 16\n");
        let replicates = [0, 1, 16, 17].map(|sample| many.design.replicate_of(SampleId(sample)));
        assert_eq!(replicates, [None, Some(0), Some(15), Some(0)]);
    }
}

fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt())
}

/// Of the product over dimensions of 1 + (x - 1/2).
fn means(design: &Design) -> Vec<f64> {
    let function = |point: &[f64; DIMENSIONS]| point.iter().map(|x| 0.5 + x).product::<f64>();
    let mean = |points: &Vec<[f64; DIMENSIONS]>| points.iter().map(function).sum::<f64>() / points.len() as f64;
    replicates(design, 3, 64).iter().map(mean).collect()
}

/// Law: replicates are independent and without bias, and their means vary less than those of random samples: the mean
/// of 256 means and the correlation of neighbours are within 3.9 standard errors (alpha = 1e-4). of their scrambling
/// correlate by 0.5, which is 8.
#[test]
fn means_of_replicates_are_independent_and_vary_little() {
    const COUNT: u64 = 256;
    const ERRORS: f64 = 3.9;
    let random = numbers(&Design::DEFAULT, 3, 64 * COUNT);
    let random: Vec<f64> = random
        .chunks_exact(64)
        .map(|points| points.iter().map(|p| p.iter().map(|x| 0.5 + x).product::<f64>()).sum::<f64>() / 64.0)
        .collect();
    let (_, of_random) = mean_and_deviation(&random);
    for design in designs(COUNT) {
        let means = means(&design);
        let (mean, deviation) = mean_and_deviation(&means);
        let root = (COUNT as f64).sqrt();
        let pairs = means.iter().zip(&means[1..]).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>();
        let correlation = pairs / (deviation * deviation * (COUNT as f64 - 1.0));
        assert!((mean - 1.0).abs() < ERRORS * deviation / root, "{}: {mean} {deviation}", design.name());
        assert!(correlation.abs() < ERRORS / root, "{}: {correlation}", design.name());
        // the spread of random means has a relative error of 4%
        assert!(deviation < 0.5 * of_random, "{}: {deviation} {of_random}", design.name());
    }
}

const HEAD: &str = r#"
[campaign]
name = "test"
samples = 65
seed = 7
duration_s = 1.0
[body]
mass_kg = 500.0
center_of_mass_m = [0, 0, 0]
inertia_kg_m2 = [[120, 0, 0], [0, 150, 0], [0, 0, 90]]
[initial]
angular_velocity_rad_s = [0, 0.1, 0.5]
"#;

const DISPERSION: &str =
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"normal\"\nstd = 0.1\n";

fn read(text: &str) -> Result<Plan, CampaignError> {
    Plan::from_text("t.toml", text, Overrides::default())
}
