//! How distributions of directions, attitudes and inertias are written: what is refused, the way to a plan's text and back, and what is
//! said of each.

use crate::geometric::{RATE, campaign, plan};
use crate::support::campaigns::WHEEL1;
use spindrift::campaign::{Overrides, Plan};

#[test]
fn what_cannot_be_drawn_is_refused() {
    let refused = |disperse: &str| {
        let text = campaign(&format!("[[disperse]]\n{disperse}"));
        Plan::from_text("test.toml", &text, Overrides::default()).expect_err(disperse).to_string()
    };
    let attitude = "parameter = \"initial.attitude\"\n";
    let speed = "parameter = \"initial.velocity_m_s\"\n";
    for (disperse, key, says) in [
        (
            format!("{attitude}distribution = \"cone\"\nhalf_angle_rad = 0.1\n"),
            "parameter",
            "a vector (x, y, z) as a whole",
        ),
        (format!("{RATE}distribution = \"attitude_error\"\nstd_rad = 0.1\n"), "parameter", "an attitude (w, x, y, z)"),
        (
            "parameter = \"initial.velocity_m_s.x\"\ndistribution = \"cone\"\nhalf_angle_rad = 0.1\n".to_owned(),
            "parameter",
            "as a whole with distribution \"cone\"; write \"initial.velocity_m_s\", or",
        ),
        (
            "parameter = \"body.parts.fuselage.length_m\"\ndistribution = \"uniform_direction\"\n".to_owned(),
            "parameter",
            "a vector",
        ),
        ("parameter = \"body.shear\"\ndistribution = \"uniform_direction\"\n".to_owned(), "parameter", "a vector"),
        (
            format!(
                "parameter = \"wheels.w1.axis\"\ndistribution = \"uniform_direction\"\nmagnitude = {{ distribution = \"uniform\", min = 0, max = 1 }}\n{WHEEL1}"
            ),
            "magnitude",
            "left out: the length of wheels.w1.axis has no effect; delete it",
        ),
        (format!("{RATE}distribution = \"cone\"\n"), "half_angle_rad", "given"),
        (format!("{RATE}distribution = \"cone\"\nhalf_angle_rad = 0\n"), "half_angle_rad", "at most pi"),
        (format!("{RATE}distribution = \"cone\"\nhalf_angle_rad = 3.2\n"), "half_angle_rad", "at most pi"),
        (format!("{RATE}distribution = \"cone\"\nhalf_angle_rad = 1\naxis = [0, 0, 0]\n"), "axis", "other than zero"),
        (format!("{RATE}distribution = \"von_mises_fisher\"\nconcentration = -1\n"), "concentration", "above 0"),
        (format!("{speed}distribution = \"cone\"\nhalf_angle_rad = 1\n"), "axis", "nominal vector is zero"),
        (format!("{speed}distribution = \"uniform_direction\"\n"), "magnitude", "nominal vector is zero"),
        (
            format!(
                "{RATE}distribution = \"cone\"\nhalf_angle_rad = 1\nmagnitude = {{ distribution = \"normal\", std = -1 }}\n"
            ),
            "magnitude",
            ">= 0",
        ),
        (
            format!(
                "{RATE}distribution = \"cone\"\nhalf_angle_rad = 1\nmagnitude = {{ distribution = \"cone\", half_angle_rad = 1 }}\n"
            ),
            "magnitude",
            "a distribution of one number",
        ),
        (
            format!(
                "{RATE}distribution = \"cone\"\nhalf_angle_rad = 1\nmagnitude = {{ distribution = \"normal\", sd = 1 }}\n"
            ),
            "magnitude.sd",
            "std",
        ),
        (format!("{RATE}distribution = \"cone\"\nhalf_angle_rad = 1\nmagnitude = 3\n"), "magnitude", "a table"),
        (
            format!("{RATE}distribution = \"cone\"\nhalf_angle_rad = 1\nmagnitude = 3\n"),
            "magnitude",
            "write magnitude = { distribution = \"uniform\", min = 0, max = 1 }",
        ),
        (format!("{speed}distribution = \"uniform_direction\"\n"), "magnitude", "is missing: must be given"),
        (format!("{attitude}distribution = \"attitude_error\"\nstd_rad = [0.1, 0.1]\n"), "std_rad", "3 in an array"),
        (format!("{attitude}distribution = \"attitude_error\"\nstd_rad = -0.1\n"), "std_rad", ">= 0"),
        (
            format!(
                "{attitude}distribution = \"attitude_error\"\ncovariance_rad2 = [[1, 2, 0], [2, 1, 0], [0, 0, 1]]\n"
            ),
            "covariance_rad2",
            "positive semidefinite",
        ),
        (
            format!(
                "{attitude}distribution = \"attitude_error\"\nstd_rad = 1\ncovariance_rad2 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n"
            ),
            "covariance_rad2",
            "the only one",
        ),
        (format!("{attitude}distribution = \"about_axis\"\naxis = [0, 0, 1]\n"), "angle_rad", "given"),
        (
            format!(
                "{attitude}distribution = \"about_axis\"\naxis = [0, 0, 0]\nangle_rad = {{ distribution = \"normal\", std = 1 }}\n"
            ),
            "axis",
            "other than zero",
        ),
    ] {
        let message = refused(&disperse);
        assert!(message.contains(&format!("disperse[0].{key}")) && message.contains(says), "{disperse}\n{message}");
        assert!(message.contains("test.toml:"), "the line is said: {message}");
    }
}

/// Law: the text of a geometric distribution gives magnitude, axis and covariance.
#[test]
fn texts_say_magnitude_axis_and_covariance() {
    let text = |disperse: &str| {
        let plan = plan(disperse);
        let short = |x: f64| format!("{x:.4}");
        plan.dispersions.distribution_of(0).expect("a distribution").text(&short)
    };
    let said = text(&format!("{RATE}distribution = \"uniform_direction\"\n"));
    assert!(said.contains("magnitude 3.0000"), "{said}");
    let said = text(&format!("{RATE}distribution = \"cone\"\nhalf_angle_rad = 0.1\naxis = [0, 3, 4]\n"));
    assert!(said.contains("0.1000 rad about [0.0000, 0.6000, 0.8000], magnitude 3.0000"), "{said}");
    let error = "parameter = \"initial.attitude\"\ndistribution = \"attitude_error\"\n";
    let said = text(&format!("{error}std_rad = [0.1, 0.2, 0.3]\n"));
    assert!(said.contains("std (rad) [0.1000, 0.2000, 0.3000]") && !said.contains("covariance"), "{said}");
    let said = text(&format!("{error}covariance_rad2 = [[0.01, 0.01, 0], [0.01, 0.04, 0], [0, 0, 0.09]]\n"));
    assert!(
        said.contains("std (rad) [0.1000, 0.2000, 0.3000], correlations xy 0.5000, xz 0.0000, yz 0.0000"),
        "{said}"
    );
}
