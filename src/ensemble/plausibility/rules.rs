//! [`RULES`]: what is noted, one row each: what is looked at, the size from which on it is noted with the source of
//! that number, what is usual, and the remedy.
//!
//! A limit is beyond what real spacecraft have, so that a note is rarely false; it is below what the wrong unit makes
//! of a usual value.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use super::looked::{Found, Looked, digits};
use super::measures;
use crate::scene::Parameter;

/// What a rule looks at.
pub enum Look {
    /// The numbers of these keys, `table.key`; `table.*` has all keys of the table in the unit of the rule. Nominal
    /// values are judged, and how far one draw in a hundred is from them.
    Keys(&'static [&'static str]),
    /// Sizes that follow from several numbers, where the limit is this.
    Sizes(fn(&Looked<'_>, f64) -> Vec<Found>),
}

/// From which size on there is a note.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    From(f64),
    Below(f64),
}

/// A row of the list.
pub struct Rule {
    /// What is looked at, for the documents.
    pub subject: &'static str,
    pub look: Look,
    /// In `unit`.
    pub limit: Limit,
    /// The SI unit, `1` of a pure number; the unit in which people know the number, and how many of it are one of SI.
    pub unit: &'static str,
    pub known: (&'static str, f64),
    /// Where the limit comes from.
    pub source: &'static str,
    pub usual: &'static str,
    pub remedy: &'static str,
}

/// Of a number of which people know no other unit.
const SAME: (&str, f64) = ("", 1.0);
const DEG: (&str, f64) = ("deg", 360.0 / TAU);
const DEG_S: (&str, f64) = ("deg/s", 360.0 / TAU);
const RPM: (&str, f64) = ("rpm", 60.0 / TAU);
/// The same turn, written in degrees, has another last bit.
const BEYOND_A_TURN: f64 = TAU * (1.0 + 1e-9);
/// Seconds in ten years of 365.25 days.
const TEN_YEARS: f64 = 315_576_000.0;

impl Rule {
    /// The notes on what breaks the rule; parameters that are judged already are left out.
    pub fn notes(&self, looked: &Looked<'_>, judged: &mut BTreeSet<String>) -> Vec<String> {
        let found = match self.look {
            Look::Sizes(sizes) => {
                let (Limit::From(limit) | Limit::Below(limit)) = self.limit;
                sizes(looked, limit)
                    .into_iter()
                    .filter(|found| self.is_broken_by(found.size))
                    .map(|found| found.what)
                    .collect()
            }
            Look::Keys(keys) => {
                let own: Vec<Parameter> = looked.parameters().filter(|parameter| self.has(keys, *parameter)).collect();
                own.into_iter()
                    .filter(|parameter| judged.insert(parameter.name()))
                    .filter_map(|parameter| self.of_parameter(looked, parameter))
                    .collect::<Vec<String>>()
            }
        };
        found.into_iter().map(|what| format!("{what}; {}; {}", self.usual, self.remedy)).collect()
    }

    fn is_broken_by(&self, size: f64) -> bool {
        match self.limit {
            Limit::From(limit) => size >= limit,
            Limit::Below(limit) => size < limit,
        }
    }

    fn has(&self, keys: &[&str], parameter: Parameter) -> bool {
        let (name, facts) = (parameter.name(), parameter.facts());
        let table = name.split('.').next().unwrap_or_default();
        keys.iter().any(|pattern| {
            let (of, key) = pattern.split_once('.').unwrap_or((pattern, "*"));
            of == table && (key == facts.key || key == "*" && facts.unit == self.unit)
        })
    }

    fn of_parameter(&self, looked: &Looked<'_>, parameter: Parameter) -> Option<String> {
        let nominal = looked.nominal(parameter);
        let (size, how) = if self.is_broken_by(nominal) {
            (nominal, "")
        } else {
            // what a spread may be has no lower limit
            let spread = looked.spread(parameter).filter(|_| matches!(self.limit, Limit::From(_)));
            (spread.filter(|size| self.is_broken_by(*size))?, ", as dispersed, is off by so much in 1 draw of 100")
        };
        let (unit, factor) = self.known;
        let known = if unit.is_empty() { String::new() } else { format!(" is {} {unit}", digits(size * factor)) };
        Some(format!("{}{how}: {} {}{known}", parameter.name(), digits(size), self.unit))
    }
}

/// What is noted, in the order in which it is shown.
pub const RULES: &[Rule] = &[
    Rule {
        subject: "`campaign.duration_s`",
        look: Look::Sizes(measures::duration),
        limit: Limit::From(TEN_YEARS),
        unit: "s",
        known: ("years", 10.0 / TEN_YEARS),
        source: "the longest missions in low orbits are planned for ten years",
        usual: "usual durations are seconds to days",
        remedy: "times are written with their unit, \"10 min\"",
    },
    Rule {
        subject: "angular velocity of the body",
        look: Look::Keys(&["initial.angular_velocity_rad_s", "initial.angular_velocity_orbital_rad_s"]),
        limit: Limit::From(1.0),
        unit: "rad/s",
        known: DEG_S,
        source: "satellites leave their launcher with less than 10 deg/s",
        usual: "usual values are below 0.1 rad/s, or a few turns a minute for a spinning body",
        remedy: "degrees are written with their unit, \"30 deg/s\"",
    },
    Rule {
        subject: "angular velocity of debris",
        look: Look::Keys(&["initial.debris_relative_angular_velocity_rad_s", "initial.debris_angular_velocity_rad_s"]),
        limit: Limit::From(1.0),
        unit: "rad/s",
        known: DEG_S,
        source: "light curves of tumbling satellites and stages",
        usual: "tumbling debris turns at most some tenths of a radian a second",
        remedy: "degrees are written with their unit, \"30 deg/s\"",
    },
    Rule {
        subject: "rate or speed limit of a wheel",
        look: Look::Keys(&["wheels.rate_rad_s", "wheels.speed_limit_rad_s"]),
        limit: Limit::From(12_000.0 * TAU / 60.0),
        unit: "rad/s",
        known: RPM,
        source: "twice the 6000 rpm of reaction wheels' data sheets",
        usual: "usual values are up to 6000 rpm",
        remedy: "revolutions are written with their unit, \"3000 rpm\"",
    },
    Rule {
        subject: "alignment error",
        look: Look::Keys(&["wheels.tilt_rad", "thrusters.tilt_rad", "torque_rods.tilt_rad", "plates.tilt_rad"]),
        limit: Limit::From(0.1),
        unit: "rad",
        known: DEG,
        source: "mechanical tolerances are below 1 deg",
        usual: "usual values are below 0.02 rad",
        remedy: "degrees are written with their unit, \"0.1 deg\"",
    },
    Rule {
        subject: "angle of a wheel",
        look: Look::Keys(&["wheels.angle_rad"]),
        limit: Limit::From(BEYOND_A_TURN),
        unit: "rad",
        known: DEG,
        source: "one turn",
        usual: "usual values are 0 to 2 pi",
        remedy: "degrees are written with their unit, \"30 deg\"",
    },
    Rule {
        subject: "angle of the orbit",
        look: Look::Keys(&["orbit.*"]),
        limit: Limit::From(BEYOND_A_TURN),
        unit: "rad",
        known: DEG,
        source: "one turn; other programs write degrees",
        usual: "usual values are 0 to 2 pi",
        remedy: "degrees are written with their unit, \"97.4 deg\"",
    },
    Rule {
        subject: "size of the orbit",
        look: Look::Keys(&["orbit.semi_major_axis_m", "orbit.position_m"]),
        limit: Limit::From(4e8),
        unit: "m",
        known: ("km", 1e-3),
        source: "the distance of the Moon",
        usual: "usual values are 6.6e6 m to 4.2e7 m",
        remedy: "kilometres are written with their unit, \"7000 km\"",
    },
    Rule {
        subject: "third component of a quaternion",
        look: Look::Sizes(measures::scalar_last),
        limit: Limit::From(0.95),
        unit: "1",
        known: SAME,
        source: "a turn of less than 36 deg whose scalar is in the last place; the identity has 1",
        usual: "quaternions have their scalar first, and no rotation is [1, 0, 0, 0]",
        remedy: "of a quaternion with the scalar last, as in 42 and GMAT, write the last number first; leave it \
                 if this turn is meant",
    },
    Rule {
        subject: "turn in 1 draw of 100 of a quaternion whose components have distributions of their own",
        look: Look::Sizes(measures::drawn_by_components),
        limit: Limit::From(0.2),
        unit: "rad",
        known: DEG,
        source: "of smaller turns the components are half a rotation vector, to 1%",
        usual: "the draw is divided by its length, so that neither its components nor its angle have what is written",
        remedy: "write distribution = \"attitude_error\" or \"uniform_attitude\"",
    },
    Rule {
        subject: "`std_rad` of an attitude error",
        look: Look::Sizes(measures::attitude_error),
        limit: Limit::From(1.0),
        unit: "rad",
        known: DEG,
        source: "with 1 rad about each axis, 2% of the rotation vectors are longer than half a turn",
        usual: "usual values are below 0.2 rad",
        remedy: "degrees are written with their unit, \"5 deg\"; for any attitude write distribution = \
                 \"uniform_attitude\"",
    },
    Rule {
        subject: "noise and bias of a magnetometer",
        look: Look::Keys(&["sensors.noise_t", "sensors.bias_t"]),
        limit: Limit::From(1e-4),
        unit: "T",
        known: ("nT", 1e9),
        source: "the field of the Earth is at most 6.7e-5 T (IGRF)",
        usual: "usual values are below 1000 nT",
        remedy: "nanoteslas are written with their unit, \"100 nT\"",
    },
    Rule {
        subject: "bias of a gyro",
        look: Look::Keys(&["sensors.bias_rad_s"]),
        limit: Limit::From(0.02),
        unit: "rad/s",
        known: DEG_S,
        source: "uncalibrated MEMS gyros have up to 1 deg/s",
        usual: "usual values are below 0.001 rad/s, which is 206 deg/h",
        remedy: "degrees are written with their unit, \"5 deg/h\"",
    },
    Rule {
        subject: "random walk of a gyro's angle",
        look: Look::Keys(&["sensors.angular_random_walk_rad_sqrt_s"]),
        limit: Limit::From(3e-3),
        unit: "rad/sqrt(s)",
        known: ("deg/sqrt(h)", 60.0 * 360.0 / TAU),
        source: "ten times the 1 deg/sqrt(h) of the noisiest gyros",
        usual: "usual values are below 1 deg/sqrt(h)",
        remedy: "degrees are written with their unit, \"0.15 deg/sqrt(h)\"",
    },
    Rule {
        subject: "random walk of a gyro's bias",
        look: Look::Keys(&["sensors.bias_random_walk_rad_s_sqrt_s"]),
        limit: Limit::From(1e-4),
        unit: "rad/s/sqrt(s)",
        known: SAME,
        source: "a hundred times that of MEMS gyros",
        usual: "usual values are 1e-10 to 1e-6",
        remedy: "a value in degrees is multiplied by 0.01745",
    },
    Rule {
        subject: "noise of tachometers and of a camera's rate",
        look: Look::Keys(&["sensors.noise_rad_s", "sensors.rate_noise_rad_s"]),
        limit: Limit::From(10.0),
        unit: "rad/s",
        known: RPM,
        source: "a tenth of the speed of a slow wheel",
        usual: "usual values are below 1 rad/s",
        remedy: "revolutions are written with their unit, \"5 rpm\"",
    },
    Rule {
        subject: "noise, bias and alignment error of a sensor; settling band",
        look: Look::Keys(&[
            "sensors.noise_rad",
            "sensors.attitude_noise_rad",
            "sensors.bias_rad",
            "sensors.misalignment_rad",
            "control.settling_band_rad",
        ]),
        limit: Limit::From(1.0),
        unit: "rad",
        known: DEG,
        source: "coarse Sun sensors have errors of 10 deg",
        usual: "usual values are below 0.1 rad",
        remedy: "degrees are written with their unit, \"0.3 deg\", \"10 arcsec\"",
    },
    Rule {
        subject: "half angle of a field of view or of a plume",
        look: Look::Keys(&["sensors.half_field_of_view_rad", "control.plume_half_angle_rad"]),
        limit: Limit::From(PI * (1.0 + 1e-9)),
        unit: "rad",
        known: DEG,
        source: "half a turn is every direction",
        usual: "usual values are 0 to pi / 2",
        remedy: "degrees are written with their unit, \"60 deg\"",
    },
    Rule {
        subject: "any other angle of a control loop",
        look: Look::Keys(&["control.*", "sensors.*", "guidance.*"]),
        limit: Limit::From(BEYOND_A_TURN),
        unit: "rad",
        known: DEG,
        source: "one turn",
        usual: "usual values are below 2 pi",
        remedy: "degrees are written with their unit, \"5 deg\"",
    },
    Rule {
        subject: "rate of a slew",
        look: Look::Keys(&["guidance.max_rate_rad_s"]),
        limit: Limit::From(1.0),
        unit: "rad/s",
        known: DEG_S,
        source: "agile satellites slew at up to 5 deg/s",
        usual: "usual values are below 0.1 rad/s",
        remedy: "degrees are written with their unit, \"1 deg/s\"",
    },
    Rule {
        subject: "`scale` of a sensor, less one",
        look: Look::Sizes(measures::sensor_scale),
        limit: Limit::From(0.5 * (1.0 + 1e-9)),
        unit: "1",
        known: SAME,
        source: "scale errors are below 10%",
        usual: "scale is measured over true; a sensor without error has 1",
        remedy: "one with an error of 1% has 1.01",
    },
    Rule {
        subject: "period or latency of a control loop",
        look: Look::Sizes(measures::periods),
        limit: Limit::From(60.0),
        unit: "s",
        known: ("min", 1.0 / 60.0),
        source: "a minute is 4 deg of a low orbit",
        usual: "usual values are 0.01 s to 10 s",
        remedy: "milliseconds are written with their unit, \"100 ms\"",
    },
    Rule {
        subject: "delay or shortest firing of a thruster",
        look: Look::Keys(&["thrusters.min_on_time_s", "actuators.switch_on_delay_s", "actuators.switch_off_delay_s"]),
        limit: Limit::From(5.0),
        unit: "s",
        known: ("ms", 1e3),
        source: "valves open in 5 ms to 100 ms",
        usual: "usual values are below 0.5 s",
        remedy: "milliseconds are written with their unit, \"20 ms\"",
    },
    Rule {
        subject: "rate to which the schedule drives a wheel",
        look: Look::Sizes(measures::driven_wheels),
        limit: Limit::From(12_000.0 * TAU / 60.0),
        unit: "rad/s",
        known: RPM,
        source: "twice the 6000 rpm of reaction wheels' data sheets",
        usual: "usual values are up to 6000 rpm",
        remedy: "write a smaller torque or a shorter arc",
    },
    Rule {
        subject: "mass of the spacecraft",
        look: Look::Sizes(measures::mass),
        limit: Limit::From(3000.0),
        unit: "kg",
        known: ("t", 1e-3),
        source: "most satellites are lighter; Envisat had 8 t",
        usual: "usual values are 1 kg to some tons: check densities and sizes",
        remedy: "grams and millimetres are written with their unit, \"50 g\", \"20 mm\"",
    },
    Rule {
        subject: "radius of gyration over the cube root of the mass",
        look: Look::Sizes(measures::radius_of_gyration),
        limit: Limit::From(3.0),
        unit: "m/kg^(1/3)",
        known: SAME,
        source: "six times that of satellites with long booms (0.5), ten times that of the space station (0.3)",
        usual: "a satellite of 4 kg has a radius of gyration of 0.1 m, one of 100 kg of 0.5 m",
        remedy: "check mass and moments; moments in another unit are written with it, \"1200 kg cm^2\"",
    },
    Rule {
        subject: "the same of a dense body",
        look: Look::Sizes(measures::radius_of_gyration),
        limit: Limit::Below(0.0146),
        unit: "m/kg^(1/3)",
        known: SAME,
        source: "a ball of gold: sqrt(2/5) (3 / (4 pi 19,300 kg/m^3))^(1/3)",
        usual: "so small a body is denser than gold",
        remedy: "check mass and moments; masses in another unit are written with it, \"500 g\"",
    },
    Rule {
        subject: "how much the two smaller principal moments together exceed the largest, relative to it",
        look: Look::Sizes(measures::flatness),
        limit: Limit::Below(0.01),
        unit: "1",
        known: SAME,
        source: "a sheet has 0; a plate whose thickness is a tenth of its side has 0.01",
        usual: "so flat is a sheet alone, and dispersed moments beyond the limit make samples that are no body",
        remedy: "check which moment belongs to which axis, and their units",
    },
    Rule {
        subject: "length of the spacecraft",
        look: Look::Keys(&["body.*", "wheels.*", "thrusters.*", "plates.*"]),
        limit: Limit::From(30.0),
        unit: "m",
        known: ("mm", 1e3),
        source: "few satellites are longer than 30 m",
        usual: "usual values are 0.01 m to 10 m",
        remedy: "millimetres are written with their unit, \"340 mm\"",
    },
    Rule {
        subject: "density",
        look: Look::Keys(&["body.density_kg_m3", "wheels.density_kg_m3", "debris.density_kg_m3"]),
        limit: Limit::From(25_000.0),
        unit: "kg/m^3",
        known: ("g/cm^3", 1e-3),
        source: "osmium has 22,600 kg/m^3",
        usual: "aluminium has 2700 kg/m^3, a whole satellite 50 to 500",
        remedy: "grams are written with their unit, \"2.7 g/cm^3\"",
    },
    Rule {
        subject: "area of the plates over the mass",
        look: Look::Sizes(measures::area),
        limit: Limit::From(20.0),
        unit: "m^2/kg",
        known: SAME,
        source: "solar sails have up to 7 m^2/kg",
        usual: "usual values are 0.005 to 0.1 m^2/kg",
        remedy: "areas are in m^2: 100 cm^2 are 0.01",
    },
    Rule {
        subject: "torque limit of a wheel over the smallest moment of the spacecraft",
        look: Look::Sizes(measures::wheel_torque),
        limit: Limit::From(5.0),
        unit: "rad/s^2",
        known: SAME,
        source: "the most agile satellites have 0.5 rad/s^2",
        usual: "usual values are below 0.1 rad/s^2",
        remedy: "millinewton metres are written with their unit, \"2 mN m\"",
    },
    Rule {
        subject: "relative spread",
        look: Look::Sizes(measures::wide_spreads),
        limit: Limit::From(0.5),
        unit: "1",
        known: ("%", 100.0),
        source: "a normal value with 50% is negative in 2% of draws",
        usual: "that is a spread of half the nominal value or more",
        remedy: "percentages are written with their unit, \"2 %\"",
    },
    Rule {
        subject: "distance of a nominal value from the range of its draws, over that range",
        look: Look::Sizes(measures::nominal_outside),
        limit: Limit::From(0.25),
        unit: "1",
        known: SAME,
        source: "a value about which samples are drawn is within their range, one at an end of it close to that end",
        usual: "sample 0 is the nominal scene, and nothing like it is drawn",
        remedy: "write a nominal value within its distribution, or check the unit of the distribution",
    },
    Rule {
        subject: "angle between the local orbital frames of the true orbit and of the nominal one, until the \
                 end of a run, in 1 draw of 100",
        look: Look::Sizes(measures::unknown_orbit),
        limit: Limit::From(0.5 * TAU / 360.0),
        unit: "rad",
        known: DEG,
        source: "above the errors of star trackers and most requirements on pointing",
        usual: "flight software knows the nominal orbit alone, so that targets and filters that use it are \
                 wrong by as much",
        remedy: "disperse the orbit by the error of its navigation, and fly other orbits as campaigns of their \
                 own, for instance with --set orbit.ascending_node_rad=\"40 deg\"; estimator = \"perfect\" \
                 knows the true orbit",
    },
    Rule {
        subject: "angle of the principal axis from s3, where nutation is measured from s3",
        look: Look::Sizes(measures::nutation),
        limit: Limit::From(0.1),
        unit: "deg",
        known: SAME,
        source: "requirements on nutation are some tenths of a degree",
        usual: "a steady spin about it has that nutation angle",
        remedy: "observe.nutation_axis = \"principal\" measures from the axis itself",
    },
    Rule {
        subject: "turn of the body from one observation point to the next",
        look: Look::Sizes(measures::coarse_grid),
        limit: Limit::From(PI),
        unit: "rad",
        known: ("turns", 1.0 / TAU),
        source: "a sine needs two points a period",
        usual: "extremes in between are missed",
        remedy: "write eight points to a turn",
    },
    Rule {
        subject: "turn of the body over the lag of B-dot, at the largest initial rate of 1000 draws",
        look: Look::Sizes(measures::late_rods),
        limit: Limit::From(PI / 2.0),
        unit: "rad",
        known: ("turns", 1.0 / TAU),
        source: "the mean power of the rods has the sign of the cosine of that turn",
        usual: "between a quarter and three quarters of a turn the rods speed the body up",
        remedy: "write shorter periods of the magnetometer and of the loop",
    },
    Rule {
        subject: "distance of the nominal orbit beyond the ends of environment.air_heights_m",
        look: Look::Sizes(measures::beyond_air),
        limit: Limit::From(0.0),
        unit: "m",
        known: SAME,
        source: "the table has no density there",
        usual: "the density is extrapolated",
        remedy: "extend the table",
    },
    Rule {
        subject: "time from the end of the run to the start of an arc",
        look: Look::Sizes(measures::late_arcs),
        limit: Limit::From(0.0),
        unit: "s",
        known: SAME,
        source: "such an arc is never flown",
        usual: "it starts at the end of the run or later",
        remedy: "write an earlier start_s, or a longer campaign.duration_s",
    },
];
