//! The cases of `bad_campaigns.rs`: a valid campaign file, what is changed in it, and the message.

use crate::support::campaigns::{DEBRIS, FUSELAGE, WHEEL1};

/// The valid file up to its scene.
const HEAD: &str = r#"[campaign]
name = "bad"
samples = 10
seed = 1
duration_s = 10.0
[integrator]
method = "dormand_prince"
tolerance = 1e-10
[observe]
points = 11
"#;

/// The rest of the file, after its bodies.
const REST: &str = r#"[initial]
attitude = [1, 0, 0, 0]
angular_velocity_rad_s = [0, 3, 31]
[[thrusters]]
name = "p1"
position_m = [0, 0, 0]
direction = [0, 0, 1]
[[actuation]]
start_s = 0.0
end_s = 3.0
thrust_n = { p1 = 100 }
[[disperse]]
parameter = "body.parts.fuselage.density_kg_m3"
distribution = "truncated_normal"
relative_std = 0.02
sigmas = 3
"#;

/// A valid file; each case changes some of its lines.
pub fn good() -> String {
    [HEAD, FUSELAGE, WHEEL1, DEBRIS, REST].concat()
}

/// What is changed, to what, and the whole message: exactly one problem each.
pub const CASES: &[(&str, &str, &str)] = &[
    // campaign
    (
        "name = \"bad\"\n",
        "",
        "bad.toml:1: campaign.name is missing: must be 1 to 100 letters, digits, _, - or . (the first one a letter, a digit or _); add name = \"my_campaign\" to [campaign]",
    ),
    (
        "name = \"bad\"",
        "name = \"a/b\"",
        "bad.toml:2: campaign.name = \"a/b\": must be 1 to 100 letters, digits, _, - or . (the first one a letter, a digit or _); it names the folder of results, and is a word of commands: write it without spaces and slashes",
    ),
    (
        "name = \"bad\"",
        "name = \"-rf\"",
        "bad.toml:2: campaign.name = \"-rf\": must be 1 to 100 letters, digits, _, - or . (the first one a letter, a digit or _); it names the folder of results, and is a word of commands: write it without spaces and slashes",
    ),
    ("name = \"bad\"", "name = 3", "bad.toml:2: campaign.name = 3: must be text; write it in quotes"),
    (
        "name = \"bad\"",
        "name = \"bad\"\ndescription = \" \"",
        "bad.toml:3: campaign.description = \" \": must be a text of 1 to 1000 characters; write the question that the campaign answers, or delete the key",
    ),
    (
        "name = \"bad\"",
        "name = \"bad\"\ndescription = 3",
        "bad.toml:3: campaign.description = 3: must be text; write it in quotes",
    ),
    (
        "samples = 10",
        "samples = 0",
        "bad.toml:3: campaign.samples = 0: must be a whole number from 1 to 9007199254740992; write a number within this range",
    ),
    (
        "samples = 10",
        "samples = 1e3",
        "bad.toml:3: campaign.samples = 1e3: must be a whole number from 1 to 9007199254740992; write it without a decimal point or exponent",
    ),
    (
        "samples = 10",
        "sampels = 10\nsamples = 10",
        "bad.toml:3: campaign.sampels = 10: must be a key of [campaign] (name, description, samples, only, seed, duration_s); did you mean samples?",
    ),
    (
        "seed = 1\n",
        "seed = -1\n",
        "bad.toml:4: campaign.seed = -1: must be a whole number from 0 to 9223372036854775807; write a number within this range",
    ),
    (
        "seed = 1\n",
        "",
        "bad.toml:1: campaign.seed is missing: must be a whole number of at least 0; add seed = 1 to [campaign]",
    ),
    (
        "duration_s = 10.0",
        "duration_s = 0",
        "bad.toml:5: campaign.duration_s = 0: must be a number > 0; write a positive number",
    ),
    (
        "duration_s = 10.0",
        "duration_s = inf",
        "bad.toml:5: campaign.duration_s = inf: must be a number > 0; write a positive number",
    ),
    (
        "duration_s = 10.0",
        "duration_s = \"10\"",
        "bad.toml:5: campaign.duration_s = \"10\": must be a finite number, or one with a unit (s, ms, min, h, day); write it without quotes, or add the unit",
    ),
    // integrator
    (
        "\"dormand_prince\"",
        "\"dormand_price\"",
        "bad.toml:7: integrator.method = \"dormand_price\": must be one of auto, taylor, dormand_prince, dop853, runge_kutta_4, gauss_legendre_6, null_space; did you mean \"dormand_prince\"?",
    ),
    (
        "\"dormand_prince\"",
        "\"runge_kutta_4\"",
        "bad.toml:6: integrator.step_s is missing: must be the step of method \"runge_kutta_4\", a number > 0; add step_s = 0.001 to [integrator]",
    ),
    (
        "tolerance = 1e-10",
        "step_s = 0.1",
        "bad.toml:8: integrator.step_s = 0.1: must be left out with method \"dormand_prince\", which chooses its steps itself; delete it, or choose a method with a fixed step",
    ),
    (
        "tolerance = 1e-10",
        "tolerance = 1e-20",
        "bad.toml:8: integrator.tolerance = 1e-20: must be a number from 1e-16 to 1e-2; 1e-10 is a good start",
    ),
    (
        "tolerance = 1e-10",
        "tolerance = [1e-10]",
        "bad.toml:8: integrator.tolerance = [1e-10]: must be a number from 1e-16 to 1e-2; write one number, without brackets",
    ),
    (
        "tolerance = 1e-10",
        "max_steps = 0",
        "bad.toml:8: integrator.max_steps = 0: must be a whole number from 1 to 9223372036854775807; write a number within this range",
    ),
    // observe, output, tables
    (
        "points = 11",
        "points = 1",
        "bad.toml:10: observe.points = 1: must be a whole number from 2 to 10000000; write a number within this range",
    ),
    ("points = 11", "groups = [\"enrgies\"]", "did you mean \"energies\"?"),
    (
        "points = 11",
        "groups = []",
        "bad.toml:10: observe.groups = []: must be at least one name; leave the key out for all of them but motion and mass_properties",
    ),
    ("points = 11", "groups = \"effort\"", "must be an array of names; write it like ["),
    (
        "[observe]\npoints = 11",
        "[output]\ncompression = \"zip\"",
        "bad.toml:10: output.compression = \"zip\": must be one of lz4, zstd, none; choose one of these",
    ),
    ("[observe]", "[observ]", "bad.toml:9: observ = "),
    (
        "[[actuation]]",
        "[actuation]",
        "bad.toml:37: actuation = [actuation]: must be a list of tables; write [[actuation]] with two brackets",
    ),
    // scene
    (
        "wall_thickness_m = 0.03",
        "wall_thickness_m = 1.2",
        "bad.toml:14: body.parts.fuselage.wall_thickness_m = 1.2: must be below outer_radius_m = 1.0 of that part; make the wall thinner or the radius larger",
    ),
    (
        "wall_thickness_m = 0.03",
        "wall_thickness_m = \"thin\"",
        "bad.toml:14: body.parts.fuselage.wall_thickness_m = \"thin\": must be a finite number, or one with a unit (m, mm, cm, km); write a number, or a number with its unit in quotes, such as \"5 mm\"",
    ),
    (
        "length_m = 3.0\n",
        "",
        "bad.toml:11: body.parts.fuselage.length_m is missing: must be given; add length_m = 1.0 to the table [[body.parts]] with name = \"fuselage\"",
    ),
    (
        "length_m = 3.0",
        "length_m = nan",
        "bad.toml:16: body.parts.fuselage.length_m = nan: must be a finite number; write a number such as 1.5",
    ),
    (
        "density_kg_m3 = 2700.0",
        "density_kg_m3 = -1",
        "bad.toml:17: body.parts.fuselage.density_kg_m3 = -1.0: must be above zero; write a positive number",
    ),
    (
        "position_m = [0, 0, 0]\n",
        "",
        "bad.toml:33: thrusters.p1.position_m is missing: must be an array of 3 finite numbers; add position_m = [0, 0, 0] to the table [[thrusters]] with name = \"p1\"",
    ),
    (
        "[[body.parts]]",
        "[body]\ninertia_kg_m2 = [[1, 0, 0], [0, 1, 0], [0, 0, 3]]\n[[body.parts]]",
        "bad.toml:12: body.inertia_kg_m2 = ",
    ),
    (
        "[[body.parts]]",
        "[body]\ninertia_kg_m2 = [1, 1, 2]\n[[body.parts]]",
        "bad.toml:12: body.inertia_kg_m2 = [1, 1, 2]: must be three rows of three finite numbers; write it like [[3, 0, 0], [0, 3, 0], [0, 0, 2]]",
    ),
    (
        "radius_m = 0.25",
        "radius_m = 0",
        "bad.toml:23: wheels.w1.radius_m = 0.0: must be above zero; write a positive number",
    ),
    (
        "radius_m = 0.25",
        "radius = 0.25\nradius_m = 0.25",
        "bad.toml:23: wheels.w1.radius = 0.25: must be a key of [[wheels]] with name = \"w1\" (name, axis, position_m, radius_m, length_m, density_kg_m3, mass_kg, axial_inertia_kg_m2, transverse_inertia_kg_m2, tilt_rad, rate_rad_s, angle_rad, torque_scale, torque_bias_n_m, mode); did you mean radius_m?",
    ),
    (
        "side_m = 0.2",
        "side_m = 0.2\nsize_m = [1, 1, 1]",
        "bad.toml:29: debris.size_m = [1, 1, 1]: must be left out where side_m is given; delete side_m or size_m",
    ),
    (
        "side_m = 0.2",
        "size_m = [1, 1]",
        "bad.toml:28: debris.size_m = [1, 1]: must be an array of 3 finite numbers; write it like [1, 1, 1]",
    ),
    // initial
    (
        "attitude = [1, 0, 0, 0]",
        "attitude = [1, 1, 0, 0]",
        "bad.toml:31: initial.attitude = [1.0, 1.0, 0.0, 0.0]: must be a quaternion of norm 1",
    ),
    (
        "angular_velocity_rad_s = [0, 3, 31]\n",
        "",
        "bad.toml:30: initial.angular_velocity_rad_s is missing: must be an array of 3 finite numbers; add angular_velocity_rad_s = [0.0, 0.0, 1.0] to [initial]",
    ),
    (
        "angular_velocity_rad_s = [0, 3, 31]",
        "angular_velocity_rad_s = [0, 3, inf]",
        "bad.toml:32: initial.angular_velocity_rad_s = [0, 3, inf]: must be an array of 3 finite numbers; write it like [0, 0, 0]",
    ),
    (
        "rate_rad_s = 314.1592653589793",
        "rate_rad_s = 314.1592653589793\nmode = \"locked\"",
        "bad.toml:26: wheels.w1.rate_rad_s = 314.1592653589793: must be left out (or 0) where mode is \"locked\"; delete it, or choose another mode",
    ),
    (
        "[debris]\nside_m = 0.2\ndensity_kg_m3 = 2700.0\n[initial]",
        "[initial]\ndebris_position_m = [0, 0, 0]",
        "bad.toml:28: initial.debris_position_m = [0, 0, 0]: must be left out where there is no debris; delete this line, or add a [debris] table",
    ),
    // actuation
    (
        "end_s = 3.0",
        "end_s = 0.0",
        "bad.toml:39: actuation[0].end_s = 0.0: must be later than its start_s = 0.0; end the arc after its start, or leave it out",
    ),
    (
        "thrust_n = { p1 = 100 }",
        "thrust_n = { p1 = -100 }",
        "bad.toml:40: actuation[0].thrust_n.p1 = -100.0: must be zero or above: a thruster does not pull; use the opposite thruster",
    ),
    (
        "thrust_n = { p1 = 100 }",
        "torque_n_m = { w2 = 1 }",
        "bad.toml:40: actuation[0].torque_n_m.w2 = 1: must be a key of [actuation[0].torque_n_m] (w1); did you mean w1?",
    ),
    (
        "thrust_n = { p1 = 100 }",
        "thrust_n = { p1 = 100 }\n[[actuation]]\nstart_s = 2.0\nend_s = 4.0",
        "bad.toml:42: actuation[1].start_s = 2.0: must be no earlier than actuation[0].end_s = 3.0; put the arcs in order, not overlapping",
    ),
    // disperse
    (
        "\"body.parts.fuselage.density_kg_m3\"",
        "\"body.parts.fuselage.density\"",
        "bad.toml:42: disperse[0].parameter = \"body.parts.fuselage.density\": must be a numeric key of scene or initial state, as a whole or with a component ([0] or .x); did you mean \"body.parts.fuselage.density_kg_m3\"?",
    ),
    (
        "\"body.parts.fuselage.density_kg_m3\"",
        "\"body.mass_kg\"",
        "bad.toml:42: disperse[0].parameter = \"body.mass_kg\": must be a key that the scene has; give body.mass_kg a nominal value, or disperse the parts that it would come from",
    ),
    (
        "\"body.parts.fuselage.density_kg_m3\"",
        "\"wheels.w2.radius_m\"",
        "bad.toml:42: disperse[0].parameter = \"wheels.w2.radius_m\": must be a numeric key of scene or initial state, as a whole or with a component ([0] or .x); did you mean \"wheels.w1.radius_m\"?",
    ),
    (
        "\"body.parts.fuselage.density_kg_m3\"",
        "\"debris.size_m\"",
        "bad.toml:42: disperse[0].parameter = \"debris.size_m.x\": must be a key that the scene has; describe the debris by debris.size_m",
    ),
    (
        "\"truncated_normal\"",
        "\"gaussian\"",
        "bad.toml:43: disperse[0].distribution = \"gaussian\": must be one of normal, truncated_normal, uniform, log_normal, log_uniform, triangular, beta, pert, choice, bernoulli, empirical, offset, rayleigh, exponential, gamma, weibull, student_t, uniform_attitude, uniform_direction, cone, von_mises_fisher, attitude_error, about_axis, bootstrap; choose one of these",
    ),
    (
        "\"truncated_normal\"",
        "\"normal\"",
        "bad.toml:45: disperse[0].sigmas = 3: must be a key of [disperse[0]] (parameter, distribution, std, relative_std); delete it",
    ),
    (
        "relative_std = 0.02",
        "relative_std = -0.02",
        "bad.toml:44: disperse[0].relative_std = -0.02: must be >= 0; drop the minus sign",
    ),
    (
        "relative_std = 0.02",
        "relative_std = \"2 deg\"",
        "bad.toml:44: disperse[0].relative_std = \"2 deg\": must be a finite number, or one with a unit (%); deg is a unit of other quantities (rad); check key and unit",
    ),
    (
        "relative_std = 0.02",
        "relative_std = [0.1, 0.2]",
        "bad.toml:44: disperse[0].relative_std = [0.1, 0.2]: must be 1 number; give one for each component",
    ),
    (
        "relative_std = 0.02",
        "std = 1\nrelative_std = 0.02",
        "bad.toml:45: disperse[0].relative_std = 0.02: must be the only one of std, relative_std; delete all but one of them",
    ),
    (
        "relative_std = 0.02\n",
        "",
        "bad.toml:41: disperse[0].std is missing: must be given (std or relative_std); add std = 0.1 to this table",
    ),
    (
        "\"body.parts.fuselage.density_kg_m3\"",
        "\"initial.position_m\"",
        "bad.toml:44: disperse[0].relative_std = 0.02: must be relative to a nominal value other than 0; use std in the parameter's unit",
    ),
    (
        "sigmas = 3",
        "sigmas = 0",
        "bad.toml:45: disperse[0].sigmas = 0.0: must be > 0; 3 cuts off 0.27% of the normal distribution",
    ),
    (
        "sigmas = 3",
        "sigmas = 3\nupper = 3000",
        "bad.toml:46: disperse[0].upper = 3000: must be the only one of sigmas, upper; delete all but one of them",
    ),
    (
        "sigmas = 3",
        "lower = 3000\nupper = 2000",
        "bad.toml:45: disperse[0].lower = 3000.0: must be < upper (2000.0); swap lower and upper",
    ),
    (
        "sigmas = 3",
        "lower = 9000",
        "must be bounds with some of the normal distribution of mean 2700.0 and standard deviation 54.0 between them; move the bounds to the nominal, or widen them",
    ),
    (
        "\"truncated_normal\"\nrelative_std = 0.02\nsigmas = 3",
        "\"uniform\"\nmin = 3000\nmax = 2000",
        "bad.toml:44: disperse[0].min = 3000.0: must be < max (2000.0); swap min and max",
    ),
    (
        "\"truncated_normal\"\nrelative_std = 0.02\nsigmas = 3",
        "\"uniform\"\nmin = 3000\nmax = 3000",
        "bad.toml:44: disperse[0].min = 3000.0: must be < max (3000.0); make max larger, or delete this table",
    ),
    (
        "sigmas = 3",
        "lower = 3000\nupper = 3000",
        "bad.toml:45: disperse[0].lower = 3000.0: must be < upper (3000.0); make upper larger, or delete this table",
    ),
    (
        "\"truncated_normal\"\nrelative_std = 0.02\nsigmas = 3",
        "\"choice\"\nvalues = [2600, 2700]\nweights = [1e308, 1e308]",
        "disperse[0].weights = [1e308, 1e308]: must be numbers with a finite sum; divide all by the same number: their proportions count",
    ),
    (
        "\"truncated_normal\"\nrelative_std = 0.02\nsigmas = 3",
        "\"uniform\"\nmax = 2000",
        "bad.toml:41: disperse[0].min is missing: must be given together with max; add min = 0.0 to this table",
    ),
    (
        "\"truncated_normal\"\nrelative_std = 0.02\nsigmas = 3",
        "\"uniform\"\nhalf_width = -1",
        "bad.toml:44: disperse[0].half_width = -1.0: must be >= 0; drop the minus sign",
    ),
    (
        "sigmas = 3\n",
        "sigmas = 3\n[[disperse]]\nparameter = \"body.parts.fuselage.density_kg_m3\"\ndistribution = \"normal\"\nstd = 1\n",
        "bad.toml:47: disperse[1].parameter = \"body.parts.fuselage.density_kg_m3\": must be dispersed once; delete one of the two [[disperse]] tables, or address different components",
    ),
    // bands and retained runs
    (
        "points = 11\n",
        "points = 11\n[bands]\npoints = 12\n",
        "bad.toml:12: bands.points = 12: must be 0 (no bands), or 2 to 11: the grid has 11 points; write fewer points, or more in observe.points",
    ),
    (
        "points = 11\n",
        "points = 11\n[bands]\npoints = 1\n",
        "bad.toml:12: bands.points = 1: must be 0 (no bands), or 2 to 11: the grid has 11 points; write fewer points, or more in observe.points",
    ),
    (
        "points = 11\n",
        "points = 11\n[bands]\npoints = 1000\n",
        "bad.toml:12: bands.points = 1000: must be a whole number from 0 to 257; write a number within this range",
    ),
    (
        "points = 11\n",
        "points = 11\n[bands]\npoint = 3\n",
        "bad.toml:12: bands.point = 3: must be a key of [bands] (points); did you mean points?",
    ),
    (
        "points = 11\n",
        "points = 11\n[retain]\ntrajectories = \"faild\"\n",
        "bad.toml:12: retain.trajectories = \"faild\": must be \"none\", \"all\", \"failed\", \"worst:20 by energy_error_max\" or \"sample:100\"; did you mean \"failed\"?",
    ),
    (
        "points = 11\n",
        "points = 11\n[retain]\ntrajectories = \"sample\"\n",
        "\"sample:100\"; write how many: \"sample:100\"",
    ),
    (
        "points = 11\n",
        "points = 11\n[retain]\ntrajectories = \"worst:20\"\n",
        "name the observable: \"worst:20 by energy_error_max\"",
    ),
    (
        "points = 11\n",
        "points = 11\n[retain]\ntrajectories = \"worst:0 by energy_error_max\"\n",
        "write a whole number of runs from 1 to 1000000",
    ),
    (
        "points = 11\n",
        "points = 11\n[retain]\ntrajectories = \"worst:20 by energy_eror_max\"\n",
        "did you mean \"energy_error_max\"?",
    ),
    (
        "points = 11\n",
        "points = 11\n[retain]\ntrajectories = \"worst:20 by nutation_angle_max_rad\"\n",
        "it is in the group motion: add \"motion\" to observe.groups",
    ),
    (
        "points = 11\n",
        "points = 11\n[retain]\ntrajectories = 3\n",
        "bad.toml:12: retain.trajectories = 3: must be text; write it in quotes",
    ),
    // TOML itself
    ("seed = 1\n", "seed = = 1\n", "bad.toml:4: line = "),
    ("seed = 1\n", "seed = 1\nseed = 2\n", "bad.toml:5: line = "),
];
