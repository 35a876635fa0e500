//! [`RULES`]: limits with their source, usual values and the remedy. They lie beyond real spacecraft, so that notes are
//! rarely false, and below the effect of a wrong unit on a usual value.

use std::f64::consts::{PI, TAU};

use super::measures;
use super::rule::Limit::{Below, From};
use super::rule::Look::{Keys, Sizes};
use super::rule::Rule;

/// An SI unit, with the usual unit and its number in one SI unit.
type Units = (&'static str, (&'static str, f64));

const SAME: (&str, f64) = ("", 1.0);
const ONE: Units = ("1", SAME);
const RAD: Units = ("rad", ("deg", 360.0 / TAU));
const TURNS: Units = ("rad", ("turns", 1.0 / TAU));
const DEG_S: Units = ("rad/s", ("deg/s", 360.0 / TAU));
const RPM: Units = ("rad/s", ("rpm", 60.0 / TAU));
/// One turn written in degrees has a different last bit.
const BEYOND_A_TURN: f64 = TAU * (1.0 + 1e-9);
const TEN_YEARS: f64 = 315_576_000.0;

/// Remedy: the unit's name, and an example.
macro_rules! in_unit {
    ($unit:literal, $example:literal) => {
        concat!($unit, " are written with their unit, \"", $example, "\"")
    };
}

/// Rows of rules: subject, size, limit, units; source of the limit, usual values, remedy.
macro_rules! rules {
    ($($subject:expr, $look:expr, $limit:expr, $units:expr; $source:expr, $usual:expr, $remedy:expr;)*) => {
        /// In the order of the notes.
        pub const RULES: &[Rule] = &[$(Rule {
            subject: $subject,
            look: $look,
            limit: $limit,
            unit: $units.0,
            known: $units.1,
            source: $source,
            usual: $usual,
            remedy: $remedy,
        }),*];
    };
}

rules! {
    "`campaign.duration_s`", Sizes(measures::duration), From(TEN_YEARS), ("s", ("years", 10.0 / TEN_YEARS));
        "the longest missions in low orbits are planned for ten years", "usual durations are seconds to days",
        in_unit!("times", "10 min");
    "angular velocity of the body",
        Keys(&["initial.angular_velocity_rad_s", "initial.angular_velocity_orbital_rad_s"]), From(1.0), DEG_S;
        "satellites leave their launcher with less than 10 deg/s",
        "usual values are below 0.1 rad/s, or a few turns a minute for a spinning body",
        in_unit!("degrees", "30 deg/s");
    "angular velocity of debris",
        Keys(&["initial.debris_relative_angular_velocity_rad_s", "initial.debris_angular_velocity_rad_s"]),
        From(1.0), DEG_S;
        "light curves of tumbling satellites and stages",
        "tumbling debris turns at most some tenths of a radian a second", in_unit!("degrees", "30 deg/s");
    "rate or speed limit of a wheel",
        Keys(&["wheels.rate_rad_s", "wheels.speed_limit_rad_s"]), From(12_000.0 * TAU / 60.0), RPM;
        "twice the 6000 rpm of reaction wheels' data sheets", "usual values are up to 6000 rpm",
        in_unit!("revolutions", "3000 rpm");
    "alignment error",
        Keys(&["wheels.tilt_rad", "thrusters.tilt_rad", "torque_rods.tilt_rad", "plates.tilt_rad"]), From(0.1), RAD;
        "mechanical tolerances are below 1 deg", "usual values are below 0.02 rad", in_unit!("degrees", "0.1 deg");
    "angle of a wheel", Keys(&["wheels.angle_rad"]), From(BEYOND_A_TURN), RAD;
        "one turn", "usual values are 0 to 2 pi", in_unit!("degrees", "30 deg");
    "angle of the orbit", Keys(&["orbit.*"]), From(BEYOND_A_TURN), RAD;
        "one turn; other programs write degrees", "usual values are 0 to 2 pi", in_unit!("degrees", "97.4 deg");
    "size of the orbit", Keys(&["orbit.semi_major_axis_m", "orbit.position_m"]), From(4e8), ("m", ("km", 1e-3));
        "the distance of the Moon", "usual values are 6.6e6 m to 4.2e7 m", in_unit!("kilometres", "7000 km");
    "third component of a quaternion", Sizes(measures::scalar_last), From(0.95), ONE;
        "a turn of less than 36 deg whose scalar is in the last place; the identity has 1",
        "quaternions have their scalar first, and no rotation is [1, 0, 0, 0]",
        "of a quaternion with the scalar last, as in 42 and GMAT, write the last number first; leave it if this turn \
            is meant";
    "turn in 1 draw of 100 of a quaternion whose components have distributions of their own",
        Sizes(measures::drawn_by_components), From(0.2), RAD;
        "of smaller turns the components are half a rotation vector, to 1%",
        "the draw is divided by its length, so that neither its components nor its angle have what is written",
        "write distribution = \"attitude_error\" or \"uniform_attitude\"";
    "`std_rad` of an attitude error", Sizes(measures::attitude_error), From(1.0), RAD;
        "with 1 rad about each axis, 2% of the rotation vectors are longer than half a turn",
        "usual values are below 0.2 rad",
        "degrees are written with their unit, \"5 deg\"; for any attitude write distribution = \"uniform_attitude\"";
    "noise and bias of a magnetometer", Keys(&["sensors.noise_t", "sensors.bias_t"]), From(1e-4), ("T", ("nT", 1e9));
        "the field of the Earth is at most 6.7e-5 T (IGRF)", "usual values are below 1000 nT",
        in_unit!("nanoteslas", "100 nT");
    "bias of a gyro", Keys(&["sensors.bias_rad_s"]), From(0.02), DEG_S;
        "uncalibrated MEMS gyros have up to 1 deg/s", "usual values are below 0.001 rad/s, which is 206 deg/h",
        in_unit!("degrees", "5 deg/h");
    "random walk of a gyro's angle",
        Keys(&["sensors.angular_random_walk_rad_sqrt_s"]),
        From(3e-3), ("rad/sqrt(s)", ("deg/sqrt(h)", 60.0 * 360.0 / TAU));
        "ten times the 1 deg/sqrt(h) of the noisiest gyros", "usual values are below 1 deg/sqrt(h)",
        in_unit!("degrees", "0.15 deg/sqrt(h)");
    "random walk of a gyro's bias",
        Keys(&["sensors.bias_random_walk_rad_s_sqrt_s"]), From(1e-4), ("rad/s/sqrt(s)", SAME);
        "a hundred times that of MEMS gyros", "usual values are 1e-10 to 1e-6",
        "a value in degrees is multiplied by 0.01745";
    "noise of tachometers and of a camera's rate",
        Keys(&["sensors.noise_rad_s", "sensors.rate_noise_rad_s"]), From(10.0), RPM;
        "a tenth of the speed of a slow wheel", "usual values are below 1 rad/s", in_unit!("revolutions", "5 rpm");
    "noise, bias and alignment error of a sensor; settling band",
        Keys(&["sensors.noise_rad", "sensors.attitude_noise_rad", "sensors.bias_rad", "sensors.misalignment_rad",
            "control.settling_band_rad"]),
        From(1.0), RAD;
        "coarse Sun sensors have errors of 10 deg", "usual values are below 0.1 rad",
        "degrees are written with their unit, \"0.3 deg\", \"10 arcsec\"";
    "half angle of a field of view or of a plume",
        Keys(&["sensors.half_field_of_view_rad", "control.plume_half_angle_rad"]), From(PI * (1.0 + 1e-9)), RAD;
        "half a turn is every direction", "usual values are 0 to pi / 2", in_unit!("degrees", "60 deg");
    "any other angle of a control loop", Keys(&["control.*", "sensors.*", "guidance.*"]), From(BEYOND_A_TURN), RAD;
        "one turn", "usual values are below 2 pi", in_unit!("degrees", "5 deg");
    "rate of a slew", Keys(&["guidance.max_rate_rad_s"]), From(1.0), DEG_S;
        "agile satellites slew at up to 5 deg/s", "usual values are below 0.1 rad/s", in_unit!("degrees", "1 deg/s");
    "`scale` of a sensor, less one", Sizes(measures::sensor_scale), From(0.5 * (1.0 + 1e-9)), ONE;
        "scale errors are below 10%", "scale is measured over true; a sensor without error has 1",
        "one with an error of 1% has 1.01";
    "period or latency of a control loop", Sizes(measures::periods), From(60.0), ("s", ("min", 1.0 / 60.0));
        "a minute is 4 deg of a low orbit", "usual values are 0.01 s to 10 s", in_unit!("milliseconds", "100 ms");
    "delay or shortest firing of a thruster",
        Keys(&["thrusters.min_on_time_s", "actuators.switch_on_delay_s", "actuators.switch_off_delay_s"]),
        From(5.0), ("s", ("ms", 1e3));
        "valves open in 5 ms to 100 ms", "usual values are below 0.5 s", in_unit!("milliseconds", "20 ms");
    "rate to which the schedule drives a wheel", Sizes(measures::driven_wheels), From(12_000.0 * TAU / 60.0), RPM;
        "twice the 6000 rpm of reaction wheels' data sheets", "usual values are up to 6000 rpm",
        "write a smaller torque or a shorter arc";
    "mass of the spacecraft", Sizes(measures::mass), From(3000.0), ("kg", ("t", 1e-3));
        "most satellites are lighter; Envisat had 8 t", "usual values are 1 kg to some tons: check densities and sizes",
        "grams and millimetres are written with their unit, \"50 g\", \"20 mm\"";
    "radius of gyration over the cube root of the mass",
        Sizes(measures::radius_of_gyration), From(3.0), ("m/kg^(1/3)", SAME);
        "six times that of satellites with long booms (0.5), ten times that of the space station (0.3)",
        "a satellite of 4 kg has a radius of gyration of 0.1 m, one of 100 kg of 0.5 m",
        "check mass and moments; moments in another unit are written with it, \"1200 kg cm^2\"";
    "the same of a dense body", Sizes(measures::radius_of_gyration), Below(0.0146), ("m/kg^(1/3)", SAME);
        "a ball of gold: sqrt(2/5) (3 / (4 pi 19,300 kg/m^3))^(1/3)", "so small a body is denser than gold",
        "check mass and moments; masses in another unit are written with it, \"500 g\"";
    "how much the two smaller principal moments together exceed the largest, relative to it",
        Sizes(measures::flatness), Below(0.01), ONE;
        "a sheet has 0; a plate whose thickness is a tenth of its side has 0.01",
        "so flat is a sheet alone, and dispersed moments beyond the limit make samples that are no body",
        "check which moment belongs to which axis, and their units";
    "length of the spacecraft",
        Keys(&["body.*", "wheels.*", "thrusters.*", "plates.*"]), From(30.0), ("m", ("mm", 1e3));
        "few satellites are longer than 30 m", "usual values are 0.01 m to 10 m", in_unit!("millimetres", "340 mm");
    "density",
        Keys(&["body.density_kg_m3", "wheels.density_kg_m3", "debris.density_kg_m3"]),
        From(25_000.0), ("kg/m^3", ("g/cm^3", 1e-3));
        "osmium has 22,600 kg/m^3", "aluminium has 2700 kg/m^3, a whole satellite 50 to 500",
        in_unit!("grams", "2.7 g/cm^3");
    "area of the plates over the mass", Sizes(measures::area), From(20.0), ("m^2/kg", SAME);
        "solar sails have up to 7 m^2/kg", "usual values are 0.005 to 0.1 m^2/kg",
        "areas are in m^2: 100 cm^2 are 0.01";
    "torque limit of a wheel over the smallest moment of the spacecraft",
        Sizes(measures::wheel_torque), From(5.0), ("rad/s^2", SAME);
        "the most agile satellites have 0.5 rad/s^2", "usual values are below 0.1 rad/s^2",
        in_unit!("millinewton metres", "2 mN m");
    "relative spread", Sizes(measures::wide_spreads), From(0.5), ("1", ("%", 100.0));
        "a normal value with 50% is negative in 2% of draws", "that is a spread of half the nominal value or more",
        in_unit!("percentages", "2 %");
    "distance of a nominal value from the range of its draws, over that range",
        Sizes(measures::nominal_outside), From(0.25), ONE;
        "a value about which samples are drawn is within their range, one at an end of it close to that end",
        "sample 0 is the nominal scene, and nothing like it is drawn",
        "write a nominal value within its distribution, or check the unit of the distribution";
    "angle between the local orbital frames of the true orbit and of the nominal one, until the end of a run, \
        in 1 draw of 100",
        Sizes(measures::unknown_orbit), From(0.5 * TAU / 360.0), RAD;
        "above the errors of star trackers and most requirements on pointing",
        "flight software knows the nominal orbit alone, so that targets and filters that use it are wrong by as much",
        "disperse the orbit by the error of its navigation, and fly other orbits as campaigns of their own, for \
            instance with --set orbit.ascending_node_rad=\"40 deg\"; estimator = \"perfect\" knows the true orbit";
    "angle of the principal axis from s3, where nutation is measured from s3",
        Sizes(measures::nutation), From(0.1), ("deg", SAME);
        "requirements on nutation are some tenths of a degree", "a steady spin about it has that nutation angle",
        "observe.nutation_axis = \"principal\" measures from the axis itself";
    "turn of the body from one observation point to the next", Sizes(measures::coarse_grid), From(PI), TURNS;
        "a sine needs two points a period", "extremes in between are missed", "write eight points to a turn";
    "turn of the body over the lag of B-dot, at the largest initial rate of 1000 draws",
        Sizes(measures::late_rods), From(PI / 2.0), TURNS;
        "the mean power of the rods has the sign of the cosine of that turn",
        "between a quarter and three quarters of a turn the rods speed the body up",
        "write shorter periods of the magnetometer and of the loop";
    "distance of the nominal orbit beyond the ends of environment.air_heights_m",
        Sizes(measures::beyond_air), From(0.0), ("m", SAME);
        "the table has no density there", "the density is extrapolated", "extend the table";
    "time from the end of the run to the start of an arc", Sizes(measures::late_arcs), From(0.0), ("s", SAME);
        "such an arc is never flown", "it starts at the end of the run or later",
        "write an earlier start_s, or a longer campaign.duration_s";
}
