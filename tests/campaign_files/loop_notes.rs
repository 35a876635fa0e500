//! What looks like a mistake in a control loop is noted, not refused: each note has a file that gets it and a neighbour
//! that does not.

use spindrift::campaign::{Overrides, Plan};

use super::loops::{LOOP, plan};

/// Changes of a loop without notes: what is changed, into what, parts of the notes that this gets (one each), and a
/// neighbour without any.
const CASES: &[(&str, &str, &[&str], &str)] = &[
    // order of the phases
    (
        "next = \"hold\"",
        "next = \"slew\"",
        &["guidance.slew follows itself", "guidance.hold is never reached"],
        "next = \"hold\" # and not \"slew\"",
    ),
    (
        "next = \"hold\"",
        "next = \"damp\"",
        &["guidance.hold is never reached", "damp, slew follow one another for ever"],
        "next = \"damp\"\notherwise = \"hold\"",
    ),
    (
        "timeout_s = 100.0",
        "timeout_s = 100.0\nnext = \"hold\"",
        &["guidance.slew is never reached"],
        "timeout_s = 100.0\nnext = \"slew\"",
    ),
    // times
    (
        "hold_s = 1.0",
        "hold_s = 100.5",
        &["guidance.damp.hold_s = 100.5 is beyond its timeout_s = 100.0"],
        "hold_s = 100.0",
    ),
    (
        "hold_s = 2.0",
        "hold_s = 301.0",
        &["guidance.slew.hold_s = 301.0 is beyond campaign.duration_s = 300.0"],
        "hold_s = 300.0",
    ),
    (
        "settling_band_rad = 0.01",
        "settling_band_rad = 0.01\nstability_from_s = 299.9\nstability_window_s = 0.2",
        &["stability_from_s = 299.9, stability_window_s = 0.2 is not over at campaign.duration_s = 300.0"],
        "settling_band_rad = 0.01\nstability_from_s = 299.9\nstability_window_s = 0.1",
    ),
    (
        "settling_band_rad = 0.01",
        "settling_band_rad = 0.01\nstability_window_s = 300.5",
        &["from the start, stability_window_s = 300.5 is not over"],
        "settling_band_rad = 0.01\nstability_window_s = 300",
    ),
    (
        "settling_band_rad = 0.01",
        "settling_band_rad = 0.01\nstability_from_s = 300",
        &["stability_from_s = 300.0 is not over"],
        "settling_band_rad = 0.01\nstability_from_s = 299.5",
    ),
    // the environment
    (
        "[initial]",
        "[environment]\nbody_torque_n_m = [1e-4, 0, 0]\n[initial]",
        &["filters and laws of the loop do not model environment.body_torque_n_m"],
        "[environment]\n[initial]",
    ),
    (
        "[initial]",
        "[orbit]\nsemi_major_axis_m = 7e6\n[environment]\ngravity_gradient = true\n[initial]",
        &["filters and laws of the loop do not model environment.gravity_gradient"],
        "[orbit]\nsemi_major_axis_m = 7e6\n[initial]",
    ),
    (
        "[initial]",
        "[orbit]\nsemi_major_axis_m = 7e6\n[environment]\ndrag = true\n[[plates]]\nname = \"a\"\narea_m2 = 1\nnormal = \
        [1, 0, 0]\ncenter_m = [0, 1, 0]\n[initial]",
        &["filters and laws of the loop do not model environment.drag"],
        "[orbit]\nsemi_major_axis_m = 7e6\n[initial]",
    ),
    (
        "[initial]",
        "[orbit]\nsemi_major_axis_m = 7e6\n[environment]\ndrag = true\n[[plates]]\nname = \"a\"\narea_m2 = 1\nnormal = \
        [1, 0, 0]\ncenter_m = [0, 1, 0]\n[integrator]\ntolerance = 1e-13\n[initial]",
        &[
            "at tolerances below 1e-12 the rounding of environment.drag counts",
            "filters and laws of the loop do not model environment.drag",
        ],
        "[orbit]\nsemi_major_axis_m = 7e6\n[initial]",
    ),
    // conditions
    (
        "body_rate_rad_s < 0.01",
        "body_rate_rad_s < 0",
        &["is never met, whatever the motion: the mission fails"],
        "body_rate_rad_s <= 0",
    ),
    (
        "pointing_error_rad < 0.01",
        "pointing_error_rad < 0.01 and time_s > 300",
        &["is never met, whatever the motion: the phase never ends"],
        "pointing_error_rad < 0.01 and time_s >= 300",
    ),
    ("pointing_error_rad < 0.01", "pointing_error_rad - 0.1 > 3.1", &["is never met"], "pointing_error_rad - 0.1 > 3"),
    (
        "pointing_error_rad < 0.01",
        "pointing_error_rad < 5",
        &["is always met: angles are 0 to pi"],
        "pointing_error_rad < 3",
    ),
    // the limit of the gain is 2.5 K/T: gain (0.4 + 0.6 z) + K/T z (z - 1) = 0 at a delay of 0.4 T, with the smallest K
    // of 23.99 kg m^2
    (
        "gain_n_m_s = 5.0",
        "gain_n_m_s = 241",
        &["guidance.damp: small errors grow under rate_damping", "the limit is gain_n_m_s = 239.9"],
        "gain_n_m_s = 239",
    ),
    (
        "damping = 0.7",
        "damping = 0",
        &["guidance.hold: small errors grow under quaternion_feedback", "too little damping"],
        "damping = 0.1",
    ),
    // rates and angles
    (
        "max_rate_rad_s = \"1 deg/s\"",
        "max_rate_rad_s = \"2.1 deg/s\"",
        &["is above sensors.tracker.max_rate_rad_s"],
        "max_rate_rad_s = \"2 deg/s\"",
    ),
    (
        "max_rate_rad_s = \"2 deg/s\"",
        "max_rate_rad_s = \"0.9 deg/s\"",
        &["is above sensors.tracker.max_rate_rad_s"],
        "max_rate_rad_s = 0",
    ),
    (
        "rate_rad_s = 10.0",
        "rate_rad_s = -601",
        &["wheels.w1.rate_rad_s = -601.0 is above its speed_limit_rad_s = 600.0"],
        "rate_rad_s = -600",
    ),
    (
        "kind = \"star_tracker\"\nperiod_s = 0.5\nlatency_s = 0.25\nnoise_rad = [1e-4, 1e-4, 5e-4]\nmax_rate_rad_s = \
        \"2 deg/s\"",
        "kind = \"sun_sensor\"",
        &["no sensor measures the whole attitude"],
        "kind = \"star_tracker\"\n[[sensors]]\nname = \"sun\"\nkind = \"sun_sensor\"",
    ),
    // keys of another kind
    (
        "estimator = \"mekf\"",
        "estimator = \"perfect\"",
        &["control.initial_attitude_sigma_rad has no effect: a key of estimator = \"mekf\""],
        "estimator = \"mekf\" # \"perfect\"",
    ),
    (
        "law = \"rate_damping\"\ngain_n_m_s = 5.0",
        "law = \"mrp_feedback\"\nstiffness_n_m = 1.0\ndamping_n_m_s = 5.0\ngain_n_m_s = 5.0",
        &["guidance.damp.gain_n_m_s has no effect: a key of law = \"rate_damping\""],
        "law = \"mrp_feedback\"\nstiffness_n_m = 1.0\ndamping_n_m_s = 5.0",
    ),
];

/// Law: each case gets the notes that are listed, and none else; its neighbour gets none, nor does the loop as it is.
#[test]
fn each_note_has_a_file_that_gets_it_and_a_neighbour_that_does_not() {
    assert_eq!(plan(LOOP).notes(), [""; 0]);
    for (from, wrong, says, right) in CASES {
        assert_eq!(LOOP.matches(from).count(), 1, "{from}");
        let found = plan(&LOOP.replacen(from, wrong, 1)).notes();
        let is_said = |text: &&str| found.iter().any(|note| note.contains(*text));
        let notes =
            says.iter().filter(|text| !text.starts_with("the limit") && !text.starts_with("too little")).count();
        assert!(says.iter().all(is_said) && found.len() == notes, "{wrong}: {found:#?}");
        let neighbour = plan(&LOOP.replacen(from, right, 1)).notes();
        assert!(neighbour.is_empty(), "{right}: {neighbour:#?}");
    }
}

/// Law: down to 1e-12, where runs with plates are unless the file says otherwise, nothing is noted of rounding.
#[test]
fn the_tolerance_of_plates_is_the_one_down_to_which_estimates_cover() {
    let drag = CASES.iter().find(|(_, wrong, ..)| wrong.contains("tolerance = 1e-13")).expect("a case").1;
    for tolerance in ["tolerance = 1e-12", ""] {
        let found = plan(&LOOP.replacen("[initial]", &drag.replace("tolerance = 1e-13", tolerance), 1));
        assert_eq!(found.tolerance.relative, 1e-12);
        assert!(found.notes().iter().all(|note| !note.contains("rounding")), "{:?}", found.notes());
    }
}

/// Law: the plan as text is without what has no effect, and reads back without a note.
#[test]
fn keys_without_effect_are_not_in_the_plan() {
    let settings = vec![("control.estimator".to_owned(), "perfect".to_owned())];
    let tried = Plan::from_text("loop.toml", LOOP, Overrides { settings, ..Overrides::default() }).expect("a plan");
    assert_eq!(tried.notes().len(), 1);
    assert!(!tried.text().contains("initial_attitude_sigma_rad"));
    let removed = LOOP.replacen("initial_attitude_sigma_rad = 0.1\n", "", 1).replacen("\"mekf\"", "\"perfect\"", 1);
    assert_eq!(plan(&removed).hash(), tried.hash());
    assert!(plan(&tried.text()).notes().is_empty());
    // a key that no kind has is refused as before
    let misspelt = LOOP.replacen("initial_attitude_sigma_rad", "initial_attitude_sigma", 1);
    assert!(Plan::from_text("loop.toml", &misspelt, Overrides::default()).is_err());
}
