//! Runs of control loops with every kind of sensor, estimator, actuator and end, for `columns`.

use crate::loops::actuators::limited_slew;
use crate::prelude::*;

const POINT_AT_DEBRIS: &str = include_str!("../../../campaigns/point_at_debris.toml");

pub struct Case {
    pub flown: FlownLoop,
    going_on: FlownLoop,
    pub failure: &'static str,
}

impl Case {
    fn new(text: &str, sample: u64, failure: &'static str, beyond: &[(&str, &str)]) -> Self {
        let flown = FlownLoop::new(text, sample);
        let going_on = FlownLoop::new(&changed(text, beyond), sample);
        let before = flown.run.telemetry.rows.len() - usize::from(flown.end.is_some());
        for (row, other) in flown.run.telemetry.rows[..before].iter().zip(&going_on.run.telemetry.rows) {
            let same = row.iter().zip(other).all(|(a, b)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()));
            assert!(same, "the runs differ before the end");
        }
        let last = flown.ticks.len();
        assert!(going_on.told("phase").len() >= last, "it goes on: {failure}");
        Case { flown, going_on, failure }
    }

    pub fn told(&self, name: &str) -> Vec<f64> {
        let mut told = self.going_on.told(name);
        told.truncate(self.flown.ticks.len());
        told
    }

    pub fn told_vector<const N: usize>(&self, name: &str) -> Vec<[f64; N]> {
        let mut told = self.going_on.told_vector(name);
        told.truncate(self.flown.ticks.len());
        told
    }

    pub fn phases(&self) -> Vec<usize> {
        let mut phases: Vec<usize> = self.told("phase").into_iter().map(|place| place as usize).collect();
        let last = phases.len() - 1;
        if self.flown.end.is_some() && last > 0 {
            phases[last] = phases[last - 1];
        }
        phases
    }
}

fn launch(changes: &[(&str, &str)]) -> String {
    let plumes = [
        ("side_m = 0.2", "size_m = [0.2, 0.5, 0.9]"),
        ("plume_range_m = 15.0", "plume_range_m = 25.0"),
        ("plume_half_angle_rad = \"20 deg\"", "plume_half_angle_rad = 0.7"),
    ];
    changed(&changed(NET_LAUNCH, &plumes), changes)
}

const NO_LAUNCH: (&str, &str) = (
    "next = \"launch\"\n",
    "next = \"after\"\n\n[[guidance]]\nphase = \"after\"\nlaw = \"rate_damping\"\ngain_n_m_s = 1.0\n",
);

fn saturated(timeout: f64) -> String {
    changed(
        &limited_slew(),
        &[("estimator = \"mekf\"\n", &format!("estimator = \"mekf\"\nsaturation_timeout_s = {timeout:?}\n"))],
    )
}

fn without_gyro() -> String {
    let gyro = SLEW_CLOSED.find("[[sensors]]\nname = \"gyro\"").unwrap();
    let tracker = SLEW_CLOSED.find("[[sensors]]\nname = \"tracker\"").unwrap();
    let text = format!("{}{}", &SLEW_CLOSED[..gyro], &SLEW_CLOSED[tracker..]);
    let draws: Vec<&str> = text.split("\n\n").filter(|table| !table.contains("sensors.gyro")).collect();
    changed(
        &draws.join("\n\n"),
        &[("initial_bias_sigma_rad_s = \"5 deg/h\"\n", ""), ("duration_s = \"3 min\"", "duration_s = 100.1")],
    )
}

fn disturbed() -> String {
    let text = without_filters(SLEW_CLOSED, "perfect");
    let text = changed(
        &text,
        &[
            ("duration_s = \"3 min\"", "duration_s = 120.1"),
            ("until = \"time_s >= 30\"", "until = \"time_s >= 3000\""),
            ("delay_s = 0.05", "delay_s = 0.05\nsettling_band_rad = 0.02"),
        ],
    );
    text + "\n[[actuation]]\nstart_s = 20\nend_s = 30\ntorque_n_m = { w1 = 0.015 }\n"
}

pub fn cases() -> Vec<(&'static str, Case)> {
    let none: &[(&str, &str)] = &[];
    let for_a_minute = ("duration_s = 2400.0", "duration_s = 60.2");
    let one =
        |name, text: &str, sample, failure, beyond: &[(&str, &str)]| (name, Case::new(text, sample, failure, beyond));
    vec![
        one("a launch", &launch(none), 1, "none", &[NO_LAUNCH]),
        one("the nominal launch", &launch(none), 0, "none", &[NO_LAUNCH]),
        one("within the burn", &launch(&[("duration_s = 2400.0", "duration_s = 260.2")]), 2, "none", none),
        one("raw measurements", &without_filters(&launch(&[for_a_minute]), "raw"), 3, "none", none),
        one(
            "too near",
            &launch(&[("keep_out_m = 5.0", "keep_out_m = 35.0")]),
            4,
            "keep_out",
            &[("keep_out_m = 35.0", "keep_out_m = 0.0")],
        ),
        one(
            "too slow",
            &changed(DETUMBLE, &[("timeout_s = 500.0", "timeout_s = 20.0")]),
            5,
            "timeout",
            &[("timeout_s = 20.0", "timeout_s = 500.0")],
        ),
        one(
            "the debris is not seen",
            &launch(&[
                ("max_range_m = 100.0", "max_range_m = 1.0"),
                ("lost_target_timeout_s = 60.0", "lost_target_timeout_s = 20.0"),
            ]),
            2,
            "lost_target",
            &[("lost_target_timeout_s = 20.0", "lost_target_timeout_s = 0.0")],
        ),
        one(
            "wheels and thrusters",
            &changed(DETUMBLE, &[("duration_s = \"10 min\"", "duration_s = 120.2")]),
            3,
            "none",
            none,
        ),
        one("limits", &limited_slew(), 3, "none", none),
        one(
            "settled",
            &changed(
                SLEW_CLOSED,
                &[
                    ("duration_s = \"3 min\"", "duration_s = 120.1"),
                    ("[control]\n", "[control]\nstability_from_s = 90\nstability_window_s = 20\n"),
                ],
            ),
            2,
            "none",
            none,
        ),
        one("perfect knowledge", &without_filters(&launch(none), "perfect"), 5, "none", &[NO_LAUNCH]),
        one(
            "thrusts of any size",
            &launch(&[
                ("modulation = \"pulse_width\"", "modulation = \"throttled\""),
                ("duration_s = 2400.0", "duration_s = 400.2"),
            ]),
            6,
            "none",
            none,
        ),
        one(
            "no axis",
            &launch(&[
                ("debris_velocity_m_s = [0.04, 0.03, 0.0]", "debris_velocity_m_s = [0, 0, 0.001]"),
                ("approach_axis = [1, 0, 0]", "approach_axis = [0, 0, 0]"),
            ]),
            0,
            "no_axis",
            &[("approach_axis = [0, 0, 0]", "approach_axis = [0, 2, 0]")],
        ),
        one(
            "an axis of the file",
            &launch(&[
                ("debris_velocity_m_s = [0.04, 0.03, 0.0]", "debris_velocity_m_s = [0, 0, 0.001]"),
                ("approach_axis = [1, 0, 0]", "approach_axis = [3, 0, 4]"),
            ]),
            0,
            "none",
            &[NO_LAUNCH],
        ),
        one(
            "perfect knowledge within the burn",
            &without_filters(&launch(&[("duration_s = 2400.0", "duration_s = 150.2")]), "perfect"),
            0,
            "none",
            none,
        ),
        one(
            "a wheel at its limit",
            &saturated(10.0),
            3,
            "wheel_saturated",
            &[("saturation_timeout_s = 10.0", "saturation_timeout_s = 0.0")],
        ),
        one("without a gyro", &without_gyro(), 2, "none", none),
        one("at the target from the start", &disturbed(), 0, "none", none),
        one(
            "a passing debris",
            &changed(POINT_AT_DEBRIS, &[("duration_s = \"10 min\"", "duration_s = 150.2")]),
            1,
            "none",
            none,
        ),
    ]
}
