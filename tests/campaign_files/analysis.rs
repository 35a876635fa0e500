//! The tables that say what is made of the rows; no row depends on them.

use crate::{refusals::good, support::prelude::*};
use spindrift::campaign::{
    Analysis, Display, Requirement, Statement,
    requirement::{BandSubject, Subject},
    stop::When,
};

fn plan(more: &str) -> Plan {
    planned(&(good() + more))
}

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
    let stop = stop.as_ref().unwrap();
    let When::Precise { goal, .. } = &stop.when else { panic!("{stop:?}") };
    assert_eq!((goal.half_width, goal.confidence, stop.max_samples), (1e-12, 0.95, 5000));
    let again = planned(&plan.text());
    assert_eq!((&again, again.text()), (&plan, plan.text()));
}

#[test]
fn units_that_are_written_come_back() {
    let text = "[[observable]]\nname = \"rate_deg_s\"\nunit = \"deg/s\"\nexpression = \"57.29577951308232 * \
        omega_se_s_x_final_rad_s\"\n\
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
    assert_eq!(shown("omega_se_s_z_final_rad_s", "rad/s"), "deg/s");
    assert_eq!(shown("spin_axis_angle_max_rad", "rad"), "arcsec");
    assert_eq!(shown("wheels.w1.rate_rad_s", "rad/s"), "rpm");
    let written = plan.analysis.display.of("omega_se_s_x_final_rad_s", "rad/s").written(limits[1]);
    assert_eq!(written, 2.5);
    let std =
        plan.text().lines().rfind(|line| line.starts_with("std = ")).and_then(|line| line[6..].parse::<f64>().ok());
    assert!((std.unwrap() - core::f64::consts::PI / 3.0).abs() < 1e-15);
    let again = planned(&plan.text());
    assert_eq!((&again, again.text()), (&plan, plan.text()));
    let other = self::plan(&text.replace("arcsec", "deg"));
    assert_eq!((other.row_hash(), other.hash() == plan.hash()), (plan.row_hash(), false));
}
