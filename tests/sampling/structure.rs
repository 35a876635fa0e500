//! Which numbers a block of Saltelli's replaces together, and which digits Halton's have.

use crate::prelude::*;

fn draws(folder: &Path, text: &str) -> (Vec<Vec<f64>>, Vec<String>) {
    let plan = Plan::from_text_in(folder, "structure.toml", text, Overrides::default());
    let plan = plan.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let columns = plan.dispersions.columns().iter().map(|column| column.parameter.name()).collect();
    (draws::applied(&plan, 1..plan.samples), columns)
}

/// Law: of the members of a block, that of a distribution has all its numbers from the last, and others from the first.
#[test]
fn saltelli_replaces_the_numbers_of_one_distribution_together() {
    const BLOCKS: usize = 8;
    let scratch = ScratchFolder::new("saltelli-blocks");
    scratch.file("data.csv", "a,b\n0.21,0.11\n0.24,0.12\n0.27,0.14\n0.23,0.13\n0.22,0.15\n");
    let plain = without_draws();
    let head = &plain[..plain.find("[stop]").unwrap()];
    let head = head.replace("\nvelocity_m_s = [10, 0, 0]", "\nvelocity_m_s = [0.25, 0.25, 0.25]");
    let scalar = |parameter: &str| {
        format!("[[disperse]]\nparameter = {parameter:?}\ndistribution = \"uniform\"\nhalf_width = 0.01\n")
    };
    let (first, last) = (scalar("body.parts.fuselage.length_m"), scalar("debris.side_m"));
    let mut names = BTreeSet::new();
    for (name, table) in distribution_tables() {
        let radius = "parameter = \"wheels.w1.radius_m\"";
        let factors = match name {
            "offset" => 2,
            _ if table.contains(radius) => 5,
            _ => 3,
        };
        let table = table.replace(radius, "parameter = \"initial.velocity_m_s\"");
        let head = head.replace("samples = 10\n", &format!("samples = {}\n", 1 + BLOCKS * (factors + 2)));
        let (rows, columns) = draws(&scratch.0, &format!("{head}{first}{table}{last}[design]\nkind = \"saltelli\"\n"));
        assert_eq!(rows.len(), BLOCKS * (factors + 2));
        let factor = |column: usize| match column {
            0 => 0,
            _ if column == columns.len() - 1 => factors - 1,
            component if factors == 5 => component,
            _ if factors == 2 => usize::MAX,
            _ => 1,
        };
        let mut replaced = BTreeSet::new();
        for block in rows.chunks(factors + 2) {
            let (a, b) = (&block[0], &block[factors + 1]);
            for (column, parameter) in columns.iter().enumerate() {
                for member in 0..factors {
                    let expected = if member == factor(column) { b[column] } else { a[column] };
                    let found = block[member + 1][column];
                    let what = format!("{name}: {parameter} in member {member}\n{table}");
                    assert_eq!(found.to_bits(), expected.to_bits(), "{what}");
                }
                if a[column] != b[column] {
                    replaced.insert(column);
                }
            }
        }
        let has_few = ["offset", "bernoulli", "choice"].contains(&name);
        assert!(replaced.len() == columns.len() || has_few, "{name}: {replaced:?}");
        names.insert(name);
    }
    assert_eq!(names, DistributionKind::NAMES.iter().copied().collect(), "every distribution is here");
}

fn digits(mut point: u64, base: u64, count: usize) -> Vec<u64> {
    let mut digit = || {
        let lowest = point % base;
        point /= base;
        lowest
    };
    (0..count).map(|_| digit()).collect()
}

/// Law: number n of dimension d is the radical inverse of n in the d-th prime (J. H. Halton, 1960), with a permutation
/// of the values of each digit and dimension (A. B. Owen, 2017).
#[test]
fn halton_permutes_the_digits_of_the_radical_inverse() {
    const PRIMES: [u64; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    let uniform = |parameter: &str| {
        format!("[[disperse]]\nparameter = \"initial.{parameter}\"\ndistribution = \"uniform\"\nmin = 0.0\nmax = 1.0\n")
    };
    let plain = without_draws();
    let head = plain[..plain.find("[stop]").unwrap()].replace("samples = 10\n", "samples = 4097\n");
    let vectors = ["position_m", "velocity_m_s", "debris_position_m", "debris_velocity_m_s"].map(uniform).concat();
    let (rows, columns) = draws(Path::new(""), &format!("{head}{vectors}[design]\nkind = \"halton\"\n"));
    assert_eq!((rows.len(), columns.len()), (4096, PRIMES.len()));
    let mut found = BTreeSet::new();
    for (dimension, base) in PRIMES.into_iter().enumerate() {
        let count = (0..).take_while(|k| base.pow(*k) <= 1 << 26).count() - 1;
        let mut images = vec![BTreeMap::new(); count];
        for (point, row) in rows.iter().enumerate() {
            let u = row[dimension];
            let mut drawn = digits((u * base.pow(count as u32) as f64) as u64, base, count);
            drawn.reverse();
            for (place, (digit, image)) in digits(point as u64, base, count).into_iter().zip(drawn).enumerate() {
                let known = *images[place].entry(digit).or_insert(image);
                assert_eq!(known, image, "digit {place} of point {point} in base {base}: another image of {digit}");
            }
        }
        for (place, images) in images.into_iter().enumerate() {
            let values: BTreeSet<u64> = images.values().copied().collect();
            assert_eq!(values.len(), images.len(), "two values of digit {place} in base {base} have one image");
            if base >= 23 && images.len() as u64 == base {
                assert!(images.iter().any(|(digit, image)| digit != image), "digit {place} in base {base}");
                assert!(found.insert(images.into_iter().take(23).collect::<Vec<_>>()), "digit {place} in base {base}");
            }
        }
    }
    assert_eq!(found.len(), 8);
}
