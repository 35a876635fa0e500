//! The tables that say what is made of the rows: what they mean, what is refused and how, and that no row depends on them.

use crate::refusals::good;
use spindrift::campaign::requirement::{BandSubject, Subject};
use spindrift::campaign::stop::When;
use spindrift::campaign::{Analysis, Display, Overrides, Plan, Requirement, Statement};
use spindrift::statistics::gate::GateLimit;

fn plan(more: &str) -> Plan {
    Plan::from_text("good.toml", &(good() + more), Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Every key.
const FULL: &str = r#"
[statistics]
quantiles = [0.05, 0.5, "99.87 %"]
confidence = 0.9
[summary]
columns = ["steps", "margin_deg"]
[[observable]]
name = "margin_deg"
unit = "deg"
expression = "57.29577951308232 * abs(energy_error_max) / body.parts.fuselage.density_kg_m3"
[[require]]
observable = "energy_body_max_j"
quantile = 0.99
at_most = "5 J"
[[require]]
observable = "margin_deg"
fraction = 0.999
at_most = "1.5 deg"
confidence = 0.99
[[require]]
observable = "steps"
mean = true
at_least = 3
[[require]]
band = "energy_body_j"
quantile = 0.9
at_most = "5 J"
to_s = 5
[stop]
observable = "energy_error_max"
quantile = 0.95
half_width = 1e-12
max_samples = 5000
"#;

#[test]
fn every_key_is_read_and_written() {
    let plan = plan(FULL);
    let Analysis { quantiles, confidence, summary_columns, derived, requirements, stop, display } = &plan.analysis;
    // the limit in joules is one of a column in joules: nothing to convert
    assert_eq!(*display, Display::default());
    assert_eq!((quantiles.as_slice(), *confidence), (&[0.05, 0.5, 0.9987][..], 0.9));
    assert_eq!((summary_columns.len(), derived.len(), requirements.len()), (2, 1, 4));
    let expected = Requirement {
        subject: Subject::Observable("margin_deg".to_owned()),
        statement: Statement::Fraction(0.999),
        limit: GateLimit::AtMost(1.5),
        bounded: None,
        never_meets: false,
        confidence: 0.99,
    };
    assert_eq!(requirements[1], expected);
    assert_eq!((requirements[0].limit, requirements[0].confidence), (GateLimit::AtMost(5.0), 0.95));
    assert_eq!((requirements[2].statement, requirements[2].limit), (Statement::Mean, GateLimit::AtLeast(3.0)));
    let band = BandSubject { series: "energy_body_j".to_owned(), from_s: None, to_s: Some(5.0) };
    assert_eq!((requirements[3].band(), requirements[3].observable()), (Some(&band), None));
    let stop = stop.as_ref().expect("a goal");
    let When::Precise { goal, .. } = &stop.when else { panic!("{stop:?}") };
    assert_eq!((goal.half_width, goal.confidence, stop.max_samples), (1e-12, 0.95, 5000));
    let again = Plan::from_text("plan.toml", &plan.text(), Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((&again, again.text()), (&plan, plan.text()));
}

/// Law: nothing of this changes what is drawn or observed.
#[test]
fn rows_do_not_depend_on_it() {
    let (with, without) = (plan(FULL), plan(""));
    assert_eq!(with.request(), without.request());
    assert_eq!(Plan { analysis: without.analysis.clone(), ..with }, without);
    assert_eq!(without.analysis, Analysis::default());
}

const REQUIRE: &str = "[[require]]\nobservable = \"energy_error_max\"\nquantile = 0.99\nat_most = 1e-9\n";
const BAND: &str = "[[require]]\nband = \"energy_body_j\"\nquantile = 0.99\nat_most = 1e9\nfrom_s = 1\n";
const MEAN: &str =
    "[[require]]\nobservable = \"energy_error_max\"\nmean = true\nat_most = 1e-9\nbounded = [0.0, 1.0]\n";
const ALL_TIMES: &str =
    "[[require]]\nband = \"energy_body_j\"\nquantile = 0.99\nat_most = 1e9\nat_all_times = true\nfrom_s = 1\n";
const OBSERVABLE: &str = "[[observable]]\nname = \"twice\"\nexpression = \"2 * energy_error_max\"\n";
const STOP: &str =
    "[stop]\nobservable = \"energy_error_max\"\nquantile = 0.95\nhalf_width = 1e-12\nmax_samples = 5000\n";

const DECIDED: &str = "[[require]]\nobservable = \"energy_error_max\"\nfraction = 0.9\nat_most = 1e-9\n[stop]\nwhen = \"decided\"\nmax_samples = 5000\n";

/// A table, what is changed in it, to what, and a part of the only message.
const CASES: &[(&str, &str, &str, &str)] = &[
    (
        REQUIRE,
        "energy_error_max",
        "energy_eror_max",
        "require[0].observable = \"energy_eror_max\": must be an observable of this campaign: a column of its rows, or a [[observable]] of this file; did you mean \"energy_error_max\"?",
    ),
    (
        REQUIRE,
        "energy_error_max",
        "nutation_angle_max_rad",
        "it is in the group motion: add \"motion\" to observe.groups",
    ),
    (
        OBSERVABLE,
        "2 * energy_error_max",
        "body.parts.fuselage.density_kg_m3 / 0",
        "observable[0].expression = inf: must be a finite number in the nominal scene; a division by zero",
    ),
    (OBSERVABLE, "2 * energy_error_max", "ln(0 - 1)", "observable[0].expression = NaN: must be a finite number"),
    (REQUIRE, "energy_error_max", "residual_collocation_max_m", "this scene or method does not have it"),
    (
        REQUIRE,
        "observable = \"energy_error_max\"\n",
        "",
        "require[0].observable is missing: must be given (observable or band); add observable = \"energy_error_max\" to this table",
    ),
    (
        REQUIRE,
        "quantile = 0.99\n",
        "",
        "require[0].quantile is missing: must be given (quantile or fraction or mean); add quantile = 0.99 to this table",
    ),
    (
        REQUIRE,
        "at_most = 1e-9\n",
        "",
        "require[0].at_most is missing: must be given (at_most or at_least); add at_most = 1e-9 to this table",
    ),
    (
        REQUIRE,
        "quantile = 0.99",
        "quantile = 99",
        "require[0].quantile = 99: must be a number between 0 and 1, neither included; write it like 0.99",
    ),
    (
        REQUIRE,
        "quantile = 0.99",
        "fraction = 1.0",
        "require[0].fraction = 1.0: must be a number between 0 and 1, neither included",
    ),
    (
        REQUIRE,
        "quantile = 0.99",
        "mean = false",
        "require[0].mean = false: must be true where it is written; delete it, or write mean = true",
    ),
    (REQUIRE, "quantile = 0.99", "mean = 1", "require[0].mean = 1: must be true or false"),
    (
        REQUIRE,
        "quantile = 0.99",
        "quantile = 0.99\nmean = true",
        "require[0].mean = true: must be the only one of quantile, fraction, mean; write a [[require]] table for each",
    ),
    (
        REQUIRE,
        "at_most = 1e-9",
        "at_most = 1e-9\nat_least = 0",
        "require[0].at_least = 0: must be the only one of at_most, at_least; write a [[require]] table for each",
    ),
    (REQUIRE, "at_most = 1e-9", "at_most = nan", "require[0].at_most = nan: must be a finite number"),
    (
        REQUIRE,
        "at_most = 1e-9",
        "at_most = \"5 deg\"",
        "require[0].at_most = \"5 deg\": must be a finite number, or one with a unit (%); deg is a unit of other quantities",
    ),
    (
        REQUIRE,
        "at_most = 1e-9",
        "at_most = 1e-9\nconfidence = 95",
        "require[0].confidence = 95: must be a number from 0.5 to below 1; 0.95 is usual",
    ),
    (
        REQUIRE,
        "at_most = 1e-9",
        "at_most = 1e-9\nat_mots = 1",
        "require[0].at_mots = 1: not a key of [require[0]]; did you mean at_most?",
    ),
    (
        BAND,
        "energy_body_j",
        "energy_bodi_j",
        "require[0].band = \"energy_bodi_j\": must be a quantity over time with bands: a column of bands.parquet; did you mean \"energy_body_j\"?",
    ),
    (
        BAND,
        "energy_body_j",
        "nutation_angle_rad",
        "require[0].band = \"nutation_angle_rad\": must be a quantity over time with bands: a column of bands.parquet; it is in a group that is not observed: add its group to observe.groups (`spindrift columns` lists them)",
    ),
    (
        BAND,
        "band =",
        "observable = \"steps\"\nband =",
        "require[0].band = \"energy_body_j\": must be the only one of observable, band; write a [[require]] table for each",
    ),
    (
        BAND,
        "quantile = 0.99",
        "mean = true",
        "require[0].mean = true: must be left out with `band`: a requirement over time is about a share of the runs; write quantile or fraction",
    ),
    (
        BAND,
        "from_s = 1",
        "from_s = 1e6",
        "require[0].from_s = 1000000: must be part of an interval with a point of the bands: there are",
    ),
    (
        BAND,
        "from_s = 1",
        "[bands]\npoints = 0",
        "require[0].band = \"energy_body_j\": must be left out where there are no bands: bands.points is 0; delete bands.points",
    ),
    (
        REQUIRE,
        "at_most = 1e-9",
        "at_most = 1e-9\nto_s = 1",
        "require[0].to_s = 1: must be left out with `observable`, which is one number of a run; delete it, or write `band`",
    ),
    (
        OBSERVABLE,
        "twice",
        "Twice",
        "observable[0].name = \"Twice\": must be 1 to 60 lower-case letters, digits and underscores, the first a letter; write it like pointing_error_deg",
    ),
    (
        OBSERVABLE,
        "\"twice\"",
        "\"steps\"",
        "observable[0].name = \"steps\": must be a name that no column has; choose another name",
    ),
    (OBSERVABLE, "\"twice\"", "\"body_parts_fuselage_density_kg_m3\"", "must be a name that no column has"),
    (OBSERVABLE, "name = \"twice\"\n", "", "observable[0].name is missing"),
    (
        OBSERVABLE,
        "2 * energy_error_max",
        "2 *",
        "observable[0].expression = \"2 *\": must be an expression: a number, a name, \"(\" or \"-\" instead of the end at character 4; correct the expression",
    ),
    (
        OBSERVABLE,
        "2 * energy_error_max",
        "2 * energy_eror_max",
        "observable[0].expression = \"energy_eror_max\": must be made of columns of the rows and of dispersed parameters; did you mean \"energy_error_max\"?",
    ),
    (
        OBSERVABLE,
        "energy_error_max",
        "wheels.w1.radius_m",
        "observable[0].expression = \"wheels.w1.radius_m\": must be made of columns of the rows and of dispersed parameters; disperse it, or write its number",
    ),
    (OBSERVABLE, "name = \"twice\"", "name = \"twice\"\nunit = 3", "observable[0].unit = 3: must be text"),
    (STOP, "energy_error_max", "energy", "stop.observable = \"energy\": must be an observable of this campaign"),
    (
        STOP,
        "quantile = 0.95\n",
        "",
        "stop.quantile is missing: must be a number between 0 and 1, neither included; add quantile = 0.95 to [stop]",
    ),
    (STOP, "half_width = 1e-12", "half_width = 0", "stop.half_width = 0: must be a number > 0"),
    (ALL_TIMES, "true", "1", "require[0].at_all_times = 1: must be true or false"),
    (
        REQUIRE,
        "at_most = 1e-9",
        "at_most = 1e-9\nbounded = [0, 1]",
        "require[0].bounded = [0, 1]: must be left out without mean = true: shares and quantiles need no bounds; delete it",
    ),
    (
        MEAN,
        "[0.0, 1.0]",
        "[1.0, 0.0]",
        "require[0].bounded = [1.0, 0.0]: must be two numbers, the smaller one first: no run has a value outside of them; write it like [0.0, 1.0]",
    ),
    (MEAN, "[0.0, 1.0]", "[0.0]", "require[0].bounded = [0.0]: must be two numbers"),
    (MEAN, "[0.0, 1.0]", "\"wide\"", "require[0].bounded = \"wide\": must be an array of finite numbers"),
    (
        ALL_TIMES,
        "from_s = 1\n",
        "from_s = 9.97\nto_s = 9.98\n",
        "require[0].from_s = 9.97: must be part of an interval with a point of the grid",
    ),
    (
        REQUIRE,
        "at_most = 1e-9",
        "at_most = 1e-9\nat_all_times = true",
        "require[0].at_all_times = true: must be left out with `observable`",
    ),
    (STOP, "[stop]", "[stop]\nwhen = \"soon\"", "stop.when = \"soon\": must be one of precise, decided"),
    (DECIDED, "max_samples = 5000\n", "", "stop.max_samples is missing"),
    (DECIDED, "[stop]", "[stop]\nconfidence = 0.9", "stop.confidence = 0.9: must be left out with when = \"decided\""),
    (
        DECIDED,
        "[[require]]\nobservable = \"energy_error_max\"\nfraction = 0.9\nat_most = 1e-9\n",
        "",
        "stop.when = \"decided\": must be \"precise\" where there is no [[require]] table to decide; write a [[require]] table",
    ),
    (
        STOP,
        "max_samples = 5000",
        "max_samples = 9",
        "stop.max_samples = 9: must be a whole number from campaign.samples (10) to 9007199254740992; write at least the samples of the first look",
    ),
    (
        STOP,
        "max_samples = 5000\n",
        "max_samples = 5000\n[design]\nkind = \"sobol\"\n",
        "stop = [stop]: must be left out with design \"sobol\": its samples are not independent",
    ),
    (
        "[statistics]\nquantiles = [0.5]\n",
        "[0.5]",
        "[0.5, 0.05]",
        "statistics.quantiles = [0.5, 0.05]: must be 1 to 100 numbers between 0 and 1, neither included, in ascending order; write it like [0.05, 0.5, 0.95]",
    ),
    ("[statistics]\nquantiles = [0.5]\n", "[0.5]", "[]", "statistics.quantiles = []: must be 1 to 100 numbers"),
    ("[statistics]\nquantiles = [0.5]\n", "[0.5]", "[1.0]", "statistics.quantiles = [1.0]: must be 1 to 100 numbers"),
    (
        "[statistics]\nconfidence = 0.9\n",
        "0.9",
        "1.0",
        "statistics.confidence = 1.0: must be a number from 0.5 to below 1",
    ),
    (
        "[summary]\ncolumns = [\"steps\"]\n",
        "steps",
        "stepps",
        "summary.columns = \"stepps\": must be made of names, each an observable of this campaign: a column of its rows, or a [[observable]] of this file; did you mean \"steps\"?",
    ),
    (
        "[summary]\ncolumns = [\"steps\"]\n",
        "\"steps\"",
        "\"steps\", \"steps\"",
        "must be different names; delete the second \"steps\"",
    ),
];

#[test]
fn what_is_wrong_is_told() {
    let mut wrong = Vec::new();
    for (table, from, to, expected) in CASES {
        assert!(table.contains(from), "{from} in {table}");
        plan(table);
        let text = good() + &table.replacen(from, to, 1);
        let said = match Plan::from_text("bad.toml", &text, Overrides::default()) {
            Ok(_) => "accepted".to_owned(),
            Err(error) if error.problems.len() > 1 => format!("{} problems: {error}", error.problems.len()),
            Err(error) => error.to_string(),
        };
        if !said.contains(expected) || !said.starts_with("bad.toml:") {
            wrong.push(format!("{to:?}\n  expected {expected}\n  said     {said}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), CASES.len(), wrong.join("\n"));
}

/// Law: two observables have two names.
#[test]
fn an_observable_is_derived_once() {
    let error = Plan::from_text("bad.toml", &(good() + OBSERVABLE + OBSERVABLE), Overrides::default());
    let said = error.expect_err("twice").to_string();
    assert!(said.contains("observable[1].name = \"twice\": must be a name of its own"), "{said}");
}

/// Law: the unit in which a limit or a dispersion is written is that in which it is shown, after `[display]`; the limit itself is in the unit of
/// the column, whatever unit it is written in.
#[test]
fn units_that_are_written_come_back() {
    let text = "[[observable]]\nname = \"rate_deg_s\"\nunit = \"deg/s\"\nexpression = \"57.29577951308232 * omega_se_s_x_final_rad_s\"\n\
        [[require]]\nobservable = \"rate_deg_s\"\nfraction = 0.9\nat_most = \"0.1 rad/s\"\n\
        [[require]]\nobservable = \"omega_se_s_x_final_rad_s\"\nfraction = 0.9\nat_most = \"5 deg/s / 2\"\n\
        [[require]]\nobservable = \"spin_axis_angle_max_rad\"\nfraction = 0.9\nat_most = 0.5\n\
        [[disperse]]\nparameter = \"wheels.w1.rate_rad_s\"\ndistribution = \"normal\"\nthree_sigma = \"30 rpm\"\n\
        [display]\nunits = [\"arcsec\"]\ncolumns = { omega_se_s_y_final_rad_s = \"rpm\" }\n";
    let plan = plan(text);
    let degrees = core::f64::consts::PI / 180.0;
    let limits: Vec<f64> = plan.analysis.requirements.iter().map(|one| one.limit.value()).collect();
    assert!((limits[0] - 0.1 / degrees).abs() < 1e-14 && (limits[1] - 2.5 * degrees).abs() < 1e-16, "{limits:?}");
    let shown = |name: &str, unit: &str| plan.analysis.display.of(name, unit).unit;
    assert_eq!(shown("rate_deg_s", "deg/s"), "rad/s");
    assert_eq!(shown("omega_se_s_x_final_rad_s", "rad/s"), "deg/s");
    assert_eq!(shown("omega_se_s_y_final_rad_s", "rad/s"), "rpm");
    // angles and rates are in degrees where nothing is said
    assert_eq!(shown("omega_se_s_z_final_rad_s", "rad/s"), "deg/s");
    assert_eq!(shown("spin_axis_angle_max_rad", "rad"), "arcsec");
    assert_eq!(shown("wheels.w1.rate_rad_s", "rad/s"), "rpm");
    let written = plan.analysis.display.of("omega_se_s_x_final_rad_s", "rad/s").written(limits[1]);
    assert_eq!(written, 2.5);
    // a third of three sigma
    let std =
        plan.text().lines().rfind(|line| line.starts_with("std = ")).and_then(|line| line[6..].parse::<f64>().ok());
    assert!((std.expect("a standard deviation") - core::f64::consts::PI / 3.0).abs() < 1e-15);
    // in the plan, and in no row
    let again = Plan::from_text("plan.toml", &plan.text(), Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((&again, again.text()), (&plan, plan.text()));
    let other = self::plan(&text.replace("arcsec", "deg"));
    assert_eq!((other.row_hash(), other.hash() == plan.hash()), (plan.row_hash(), false));
}

/// Law: a unit of another kind, a column that is not there, and a second unit of one kind are refused.
#[test]
fn units_that_show_nothing_are_refused() {
    for (text, told) in [
        ("units = [\"degs\"]", "must be one of deg"),
        ("units = [\"deg\", \"arcsec\"]", "of different quantities"),
        ("columns = { energy_error_max = \"deg\" }", "a unit in place of 1"),
        ("columns = { omega_se_s_x_final_rad_s = \"deg\" }", "a unit in place of rad/s"),
        ("columns = { omega_se_s_q = \"deg\" }", "a unit of a column of the rows"),
    ] {
        let text = format!("{}[display]\n{text}\n", good());
        let error = Plan::from_text("x.toml", &text, Overrides::default()).expect_err(&text).to_string();
        assert!(error.contains(told), "{text}: {error}");
    }
}
