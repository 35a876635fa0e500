//! Rows of a file drawn together: every draw is a row, each as often as the others, in every design.

use crate::prelude::*;

const HEAD: &str = "[campaign]\nname = \"rows\"\nsamples = 4097\nseed = 11\nduration_s = 1.0\n";
const INITIAL: &str = "[initial]\nangular_velocity_rad_s = [0, 3, 31]\n";
const LENGTH: &str =
    "[[disperse]]\nparameter = \"body.parts.fuselage.length_m\"\ndistribution = \"uniform\"\nhalf_width = 0.1\n";

const ROWS: usize = 32;
const DRAWS: u64 = 4096;
/// 99.9% quantile with 31 degrees of freedom (scipy.stats.chi2.ppf(0.999, 31)).
const CHI_SQUARED: f64 = 61.098;

/// Rates on an arc of a circle, and a position that follows them; every cell of a column is another number.
fn measured() -> Vec<[f64; 3]> {
    let row = |k: usize| {
        let angle = 0.05 * k as f64;
        let (sine, cosine) = libm::sincos(angle);
        [0.1 * cosine, 3.0 + 0.1 * sine, 1e-3 * k as f64 + sine / 3.0]
    };
    (0..ROWS).map(row).collect()
}

fn csv(rows: &[[f64; 3]]) -> String {
    let line = |(k, [a, b, c]): (usize, &[f64; 3])| format!("{k},{a:?},{b:?},{c:?},run {k}\n");
    format!("case,wx,wy,x,remark\n{}", rows.iter().enumerate().map(line).collect::<String>())
}

const BOOTSTRAP: &str = "[[disperse]]\ndistribution = \"bootstrap\"\nfile = \"insertion.csv\"\n\
    parameters = [\"initial.angular_velocity_rad_s.x\", \"initial.angular_velocity_rad_s.y\", \
    \"initial.position_m.x\"]\n\
    columns = [\"wx\", \"wy\", \"x\"]\n";

fn apart() -> String {
    let one = |(parameter, column)| {
        format!(
            "[[disperse]]\nparameter = \"initial.{parameter}\"\ndistribution = \"empirical\"\nfile = \
            \"insertion.csv\"\ncolumn = \"{column}\"\n"
        )
    };
    [("angular_velocity_rad_s.x", "wx"), ("angular_velocity_rad_s.y", "wy"), ("position_m.x", "x")].map(one).concat()
}

fn plan_of(scratch: &ScratchFolder, text: &str) -> Result<Plan, String> {
    let text = [HEAD, FUSELAGE, WHEEL1_AT_REST, INITIAL, text].concat();
    Plan::from_text_in(&scratch.0, "rows.toml", &text, Overrides::default()).map_err(|error| error.to_string())
}

fn plan(scratch: &ScratchFolder, text: &str) -> Plan {
    plan_of(scratch, text).unwrap()
}

fn drawn<const N: usize>(plan: &Plan, names: [&str; N], samples: std::ops::Range<u64>) -> Vec<[f64; N]> {
    let known = draws::names(plan);
    let place =
        |name: &str| known.iter().position(|other| other == name).unwrap_or_else(|| panic!("{name} is a column"));
    let places = names.map(place);
    draws::seen(plan, samples, |_, applied| places.map(|place| applied[place]))
}

const NAMES: [&str; 3] =
    ["initial.angular_velocity_rad_s.x", "initial.angular_velocity_rad_s.y", "initial.position_m.x"];

/// Number of draws of each row, and of draws that are no row.
fn counts(rows: &[[f64; 3]], drawn: &[[f64; 3]]) -> (Vec<u64>, usize) {
    let bits = |row: &[f64; 3]| row.map(f64::to_bits);
    let index: BTreeMap<[u64; 3], usize> = rows.iter().enumerate().map(|(k, row)| (bits(row), k)).collect();
    let (mut counts, mut others) = (vec![0; rows.len()], 0);
    for row in drawn {
        match index.get(&bits(row)) {
            Some(k) => counts[*k] += 1,
            None => others += 1,
        }
    }
    (counts, others)
}

fn chi_squared(counts: &[u64], draws: u64) -> f64 {
    let expected = draws as f64 / counts.len() as f64;
    counts.iter().map(|count| (*count as f64 - expected).powi(2) / expected).sum()
}

fn correlation(rows: &[[f64; 3]], a: usize, b: usize) -> f64 {
    let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<f64>>();
    draws::correlation(&column(a), &column(b))
}

/// H0: each row is equally likely; alpha = 0.001 for each design.
#[test]
fn every_draw_is_a_row_of_the_file_in_every_design() {
    let scratch = ScratchFolder::new("bootstrap-designs");
    let rows = measured();
    scratch.file("insertion.csv", &csv(&rows));
    for (kind, is_even) in [("random", false), ("latin_hypercube", true), ("sobol", true), ("halton", false)] {
        let plan = plan(&scratch, &format!("[design]\nkind = {kind:?}\n{LENGTH}{BOOTSTRAP}"));
        assert_eq!(plan.dispersions.dimensions().len(), 2, "{kind}: one dimension for the row");
        let drawn = drawn(&plan, NAMES, 1..DRAWS + 1);
        let (counts, others) = counts(&rows, &drawn);
        assert_eq!(others, 0, "{kind}: draws that are no row");
        let chi = chi_squared(&counts, DRAWS);
        assert!(chi < CHI_SQUARED, "{kind}: {chi}");
        // rows follow each other in no order of the file
        assert!(drawn.windows(2).filter(|pair| pair[0][0] <= pair[1][0]).count() < 3 * drawn.len() / 4, "{kind}");
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            let (found, asked) = (correlation(&drawn, a, b), correlation(&rows, a, b));
            assert!(asked.abs() > 0.8, "columns that depend on each other: {asked}");
            // equal counts: rounding; else three standard errors of a correlation of normal numbers
            let bound = if is_even { 1e-12 } else { 3.0 * (1.0 - asked * asked) / (DRAWS as f64).sqrt() };
            assert!((found - asked).abs() < bound, "{kind} {a} {b}: {found} for {asked}");
        }
        if is_even {
            assert!(counts.iter().all(|count| *count == DRAWS / ROWS as u64), "{kind}: {counts:?}");
        }
    }
}

/// Counter-test: columns drawn one by one lose their rows and correlation, and a row that is twice as likely is seen.
#[test]
fn columns_that_are_drawn_apart_are_no_rows() {
    let scratch = ScratchFolder::new("bootstrap-apart");
    let rows = measured();
    scratch.file("insertion.csv", &csv(&rows));
    let drawn = drawn(&plan(&scratch, &apart()), NAMES, 1..DRAWS + 1);
    let (_, others) = counts(&rows, &drawn);
    assert!(others > 4000, "{others}");
    assert!(correlation(&drawn, 0, 1).abs() < 0.1 && correlation(&rows, 0, 1).abs() > 0.8);
    let mut twice = rows.clone();
    twice[1] = twice[0];
    scratch.file("insertion.csv", &csv(&twice));
    let (counts, _) = counts(&rows, &self::drawn(&plan(&scratch, BOOTSTRAP), NAMES, 1..DRAWS + 1));
    assert!(chi_squared(&counts, DRAWS) > CHI_SQUARED, "{counts:?}");
}

/// Law: with the random design and a Latin hypercube rows do not depend on other tables; two tables of one file are
/// independent.
#[test]
fn rows_do_not_depend_on_other_dispersions() {
    let scratch = ScratchFolder::new("bootstrap-company");
    let rows = measured();
    scratch.file("insertion.csv", &csv(&rows));
    for kind in ["random", "latin_hypercube"] {
        let head = format!("[design]\nkind = {kind:?}\n");
        let alone = drawn(&plan(&scratch, &format!("{head}{BOOTSTRAP}")), NAMES, 0..65);
        assert_eq!(alone[0], [0.0, 3.0, 0.0], "sample 0 is nominal");
        for text in [format!("{LENGTH}{BOOTSTRAP}"), format!("{BOOTSTRAP}{LENGTH}")] {
            assert_eq!(drawn(&plan(&scratch, &format!("{head}{text}")), NAMES, 0..65), alone, "{kind}");
        }
    }
    let half = |parameter: &str, column: &str| {
        format!(
            "[[disperse]]\ndistribution = \"bootstrap\"\nfile = \"insertion.csv\"\nparameters = \
            [{parameter:?}]\ncolumns = [{column:?}]\n"
        )
    };
    let text = format!("{}{}", half(NAMES[0], "wx"), half(NAMES[1], "wy"));
    let pairs: Vec<[f64; 3]> = drawn(&plan(&scratch, &text), [NAMES[0], NAMES[1]], 1..DRAWS + 1)
        .into_iter()
        .map(|[a, b]| [a, b, 0.0])
        .collect();
    let r = correlation(&pairs, 0, 1);
    // alpha = 0.001
    assert!(r.abs() < 3.29 / (DRAWS as f64).sqrt(), "{r}");
}

/// Law: a unit quaternion keeps its bits, another is normalised; columns are named like their components.
#[test]
fn attitudes_and_vectors_are_drawn_as_a_whole() {
    let scratch = ScratchFolder::new("bootstrap-attitude");
    let file = "initial.attitude.w,initial.attitude.x,initial.attitude.y,initial.attitude.z,\
                initial_angular_velocity_x_rad_s,initial_angular_velocity_y_rad_s,initial_angular_velocity_z_rad_s\n\
                0.6,0,0.8,0,1,2,3\n0.8,0,0,0.6,4,5,6\n3,4,0,0,7,8,9\n";
    scratch.file("states.csv", file);
    let text = "[[disperse]]\ndistribution = \"bootstrap\"\nfile = \"states.csv\"\n";
    let whole =
        plan(&scratch, &format!("{text}parameters = [\"initial.attitude\", \"initial.angular_velocity_rad_s\"]\n"));
    assert_eq!(whole, plan(&scratch, text), "without parameters: all columns");
    let names = ["w", "x", "y", "z"].map(|component| format!("initial.attitude.{component}"));
    let rate = "initial.angular_velocity_rad_s.x";
    let rows = drawn(&whole, [&names[0], &names[1], &names[2], &names[3], rate], 1..100);
    for row in &rows {
        let expected = match row[4] {
            1.0 => [0.6, 0.0, 0.8, 0.0],
            4.0 => [0.8, 0.0, 0.0, 0.6],
            7.0 => [0.6, 0.8, 0.0, 0.0],
            other => panic!("{other} is in no row"),
        };
        let bits = |q: &[f64]| q.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&row[..4]), bits(&expected));
    }
    assert!([1.0, 4.0, 7.0].iter().all(|rate| rows.iter().any(|row| row[4] == *rate)));
}

#[test]
fn a_row_is_one_factor() {
    let scratch = ScratchFolder::new("bootstrap-factor");
    let rows = measured();
    scratch.file("insertion.csv", &csv(&rows));
    let head = HEAD.replace("samples = 4097\n", "");
    for (design, samples) in [("grid", ROWS as u64 * 2 + 1), ("one_at_a_time", ROWS as u64 + 3)] {
        let text = format!("[design]\nkind = {design:?}\nlevels = [2, {ROWS}]\n{LENGTH}{BOOTSTRAP}");
        let text = [&head, FUSELAGE, WHEEL1_AT_REST, INITIAL, &text].concat();
        let plan = Plan::from_text_in(&scratch.0, "rows.toml", &text, Overrides::default());
        let plan = plan.unwrap();
        assert_eq!(plan.samples, samples, "{design}");
        let (counts, others) = counts(&rows, &drawn(&plan, NAMES, 1..samples));
        let nominal = if design == "grid" { 0 } else { 2 };
        assert_eq!((counts, others), (vec![if design == "grid" { 2 } else { 1 }; ROWS], nominal), "{design}");
    }
    let saltelli = plan(&scratch, &format!("[design]\nkind = \"saltelli\"\n{LENGTH}{BOOTSTRAP}"));
    assert_eq!(saltelli.dispersions.factors(), [0, 1]);
    // A, A with the length of B, A with the row of B, B
    let block = drawn(&saltelli, NAMES, 1..5);
    assert!(block[0] == block[1] && block[2] == block[3] && block[0] != block[3]);
}

#[test]
fn one_sample_is_shown_with_its_row() {
    let scratch = ScratchFolder::new("bootstrap-shown");
    let rows = measured();
    scratch.file("insertion.csv", &csv(&rows));
    let text = [HEAD, FUSELAGE, WHEEL1_AT_REST, INITIAL, LENGTH, BOOTSTRAP].concat();
    scratch.file("rows.toml", &text);
    let drawn = drawn(&plan(&scratch, &format!("{LENGTH}{BOOTSTRAP}")), NAMES, 0..65);
    for sample in [1, 7, 64] {
        let shown = scratch.prints(&format!("sample rows.toml --sample {sample}"), 0);
        for (name, value) in NAMES.iter().zip(drawn[sample]) {
            let line = shown.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("{name}: {shown}"));
            assert_eq!(line.split_whitespace().nth(1), Some(format!("{value:?}").as_str()), "{sample}: {shown}");
        }
    }
    let checked = scratch.prints_wide("check rows.toml --verbose", 0);
    let told = "one of the 32 rows of insertion.csv, 3 numbers together";
    assert_eq!(checked.matches(told).count(), 3, "{checked}");
}
