//! How distributions of directions, attitudes and inertias are written: what is refused, the way to a plan's text and
//! back, and what is said of each.

use crate::geometric::campaign;
use crate::support::campaigns::WHEEL1;
use spindrift::campaign::{Overrides, Plan};

#[test]
fn what_cannot_be_drawn_is_refused() {
    let refused = |disperse: &str| {
        let text = campaign(&format!("[[disperse]]\n{disperse}"));
        Plan::from_text("test.toml", &text, Overrides::default()).expect_err(disperse).to_string()
    };
    const ATTITUDE: &str = "initial.attitude";
    const SPEED: &str = "initial.velocity_m_s";
    const RATES: &str = "initial.angular_velocity_rad_s";
    let axis = format!("magnitude = {{ distribution = \"uniform\", min = 0, max = 1 }}\n{WHEEL1}");
    let cone = |keys: &str| format!("half_angle_rad = 1\n{keys}");
    let [zero, negative, nested, misspelt, number] = [
        "axis = [0, 0, 0]",
        "magnitude = { distribution = \"normal\", std = -1 }",
        "magnitude = { distribution = \"cone\", half_angle_rad = 1 }",
        "magnitude = { distribution = \"normal\", sd = 1 }",
        "magnitude = 3",
    ]
    .map(cone);
    // parameter, distribution and its keys; the key that is refused, and what is said of it
    for (parameter, distribution, keys, key, says) in [
        (ATTITUDE, "cone", "half_angle_rad = 0.1", "parameter", "a vector (x, y, z) as a whole"),
        (RATES, "attitude_error", "std_rad = 0.1", "parameter", "an attitude (w, x, y, z)"),
        ("initial.velocity_m_s.x", "cone", "half_angle_rad = 0.1", "parameter", "write \"initial.velocity_m_s\""),
        ("body.parts.fuselage.length_m", "uniform_direction", "", "parameter", "a vector"),
        ("body.shear", "uniform_direction", "", "parameter", "a vector"),
        ("wheels.w1.axis", "uniform_direction", &axis, "magnitude", "the length of wheels.w1.axis has no effect"),
        (RATES, "cone", "", "half_angle_rad", "given"),
        (RATES, "cone", "half_angle_rad = 0", "half_angle_rad", "at most pi"),
        (RATES, "cone", "half_angle_rad = 3.2", "half_angle_rad", "at most pi"),
        (RATES, "cone", &zero, "axis", "other than zero"),
        (RATES, "von_mises_fisher", "concentration = -1", "concentration", "above 0"),
        (SPEED, "cone", "half_angle_rad = 1", "axis", "nominal vector is zero"),
        (SPEED, "uniform_direction", "", "magnitude", "nominal vector is zero"),
        (RATES, "cone", &negative, "magnitude", ">= 0"),
        (RATES, "cone", &nested, "magnitude", "a distribution of one number"),
        (RATES, "cone", &misspelt, "magnitude.sd", "std"),
        (RATES, "cone", &number, "magnitude", "a table"),
        (ATTITUDE, "attitude_error", "std_rad = [0.1, 0.1]", "std_rad", "3 in an array"),
        (ATTITUDE, "attitude_error", "std_rad = -0.1", "std_rad", ">= 0"),
        (
            ATTITUDE,
            "attitude_error",
            "covariance_rad2 = [[1, 2, 0], [2, 1, 0], [0, 0, 1]]",
            "covariance_rad2",
            "positive semidefinite",
        ),
        (
            ATTITUDE,
            "attitude_error",
            "std_rad = 1\ncovariance_rad2 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
            "covariance_rad2",
            "the only one",
        ),
        (ATTITUDE, "about_axis", "axis = [0, 0, 1]", "angle_rad", "given"),
        (
            ATTITUDE,
            "about_axis",
            "axis = [0, 0, 0]\nangle_rad = { distribution = \"normal\", std = 1 }",
            "axis",
            "other than zero",
        ),
    ] {
        let disperse = format!("parameter = {parameter:?}\ndistribution = {distribution:?}\n{keys}\n");
        let message = refused(&disperse);
        assert!(message.contains(&format!("disperse[0].{key}")) && message.contains(says), "{disperse}\n{message}");
        assert!(message.contains("test.toml:"), "the line is said: {message}");
    }
}
