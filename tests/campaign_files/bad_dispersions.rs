//! Impossible and contradictory dispersions: each is refused with file, line, key, value, what is allowed and a remedy.
//!
//! The messages are in tests/golden/bad_dispersions.txt; `SPINDRIFT_WRITE_SNAPSHOT=1 cargo test --release --test
//! bad_dispersions` writes it again.

use spindrift::campaign::{Overrides, Plan};
use std::fmt::Write as _;
use std::path::Path;

use crate::support::campaigns::{FUSELAGE, WHEEL1_AT_REST};

const HEAD: &str = r#"[campaign]
name = "bad"
samples = 10
seed = 1
duration_s = 10.0
"#;

const INITIAL: &str = "[initial]\nangular_velocity_rad_s = [0, 3, 31]\n";

/// A valid campaign of 22 lines; a case follows from line 23 on.
fn start() -> String {
    [HEAD, FUSELAGE, WHEEL1_AT_REST, INITIAL].concat()
}

/// The density of the fuselage with a law.
macro_rules! density {
    ($law:literal) => {
        concat!("[[disperse]]\nparameter = \"body.parts.fuselage.density_kg_m3\"\n", $law, "\n")
    };
}

/// Two distributions that can be correlated, three components in all, on lines 23 to 30.
macro_rules! pair {
    ($rest:literal) => {
        concat!(
            "[[disperse]]\nparameter = \"body.parts.fuselage.density_kg_m3\"\ndistribution = \"uniform\"\nhalf_width = 10\n",
            "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"normal\"\nstd = 0.01\n",
            $rest,
            "\n"
        )
    };
}

/// A table with rows of a file.
macro_rules! rows {
    ($rest:literal) => {
        concat!("[[disperse]]\ndistribution = \"bootstrap\"\n", $rest, "\n")
    };
}

const CASES: &[&str] = &[
    // the table itself
    "[disperse]\nparameter = \"body.parts.fuselage.density_kg_m3\"\n",
    "[[disperse]]\ndistribution = \"normal\"\nstd = 1\n",
    "[[disperse]]\nparameter = 3\ndistribution = \"normal\"\nstd = 1\n",
    "[[disperse]]\nparameter = \"body.parts.fuselage.densty_kg_m3\"\ndistribution = \"normal\"\nstd = 1\n",
    "[[disperse]]\nparameter = \"initial.angular_velocity_rads\"\ndistribution = \"normal\"\nstd = [\"5 deg/s\", 0.1, \"1 rad/s\"]\n",
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s[3]\"\ndistribution = \"normal\"\nstd = 1\n",
    "[[disperse]]\nparameter = \"wheels.w2.radius_m\"\ndistribution = \"normal\"\nstd = 1\n",
    "[[disperse]]\nparameter = \"wheels.w1.rate_rad\"\ndistribution = \"normal\"\nstd = 1\n",
    "[[disperse]]\nparameter = \"body.mass_kg\"\ndistribution = \"normal\"\nstd = 1\n",
    density!("std = 1"),
    density!("distribution = \"Normal\"\nstd = 1"),
    density!("distribution = \"normal\"\nstd = 1\nsigma = 1"),
    density!(
        "distribution = \"normal\"\nstd = 1\n[[disperse]]\nparameter = \"body.parts.fuselage.density_kg_m3\"\ndistribution = \"uniform\"\nhalf_width = 1"
    ),
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"normal\"\nstd = 1\n[[disperse]]\nparameter = \"initial.angular_velocity_rad_s.y\"\ndistribution = \"normal\"\nstd = 1\n",
    // normal and truncated normal
    density!("distribution = \"normal\"\nstd = -1"),
    density!("distribution = \"normal\"\nstd = nan"),
    density!("distribution = \"normal\"\nstd = \"5\""),
    density!("distribution = \"normal\"\nstd = [1, 2]"),
    density!("distribution = \"normal\"\nstd = 1\nrelative_std = 0.1"),
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s.x\"\ndistribution = \"normal\"\nrelative_std = 0.1\n",
    density!("distribution = \"truncated_normal\"\nstd = 1"),
    density!("distribution = \"truncated_normal\"\nstd = 1\nsigmas = -3"),
    density!("distribution = \"truncated_normal\"\nstd = 1\nlower = 2800\nupper = 2600"),
    density!("distribution = \"truncated_normal\"\nstd = 1\nlower = 2800"),
    density!("distribution = \"truncated_normal\"\nstd = 1\nlower = 2600\nlower_sigmas = 2"),
    density!("distribution = \"truncated_normal\"\nstd = 1\nupper_sigmas = 0"),
    density!("distribution = \"truncated_normal\"\nrelative_std = 0.1\nrelative_lower = 0.1\nrelative_upper = -0.1"),
    density!("distribution = \"truncated_normal\"\nstd = 0\nlower = 2800"),
    // uniform
    density!("distribution = \"uniform\""),
    density!("distribution = \"uniform\"\nmin = 2800\nmax = 2600"),
    density!("distribution = \"uniform\"\nmin = 2600"),
    density!("distribution = \"uniform\"\nrelative_half_width = -0.1"),
    density!("distribution = \"uniform\"\nhalf_width = 1\nmin = 2600\nmax = 2800"),
    // logarithms
    density!("distribution = \"log_normal\""),
    density!("distribution = \"log_normal\"\nlog_std = -0.1"),
    density!("distribution = \"log_normal\"\nlog_std = 0.1\nmedian = 0"),
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s.x\"\ndistribution = \"log_normal\"\nlog_std = 0.1\n",
    density!("distribution = \"log_uniform\"\nmin = -1\nmax = 1"),
    density!("distribution = \"log_uniform\"\nfactor = 1"),
    density!("distribution = \"log_uniform\"\nmax = 3000"),
    // bounded
    density!("distribution = \"triangular\"\nmin = 2600"),
    density!("distribution = \"triangular\"\nmin = 2800\nmax = 2900"),
    density!("distribution = \"pert\"\nmin = 2600\nmax = 2800\nmode = 3000"),
    density!("distribution = \"beta\"\nalpha = 0\nbeta = 2\nmin = 2600\nmax = 2800"),
    density!("distribution = \"beta\"\nalpha = 2\nmin = 2600\nmax = 2800"),
    // listed
    density!("distribution = \"choice\"\nvalues = []"),
    density!("distribution = \"choice\"\nvalues = [1, \"2\"]"),
    density!("distribution = \"choice\"\nvalues = [2600, 2700]\nweights = [1]"),
    density!("distribution = \"choice\"\nvalues = [2600, 2700]\nweights = [1, -1]"),
    density!("distribution = \"choice\"\nvalues = [2600, 2700]\nweights = [0, 0]"),
    density!("distribution = \"bernoulli\"\nvalue = 2600\nprobability = 1.5"),
    density!("distribution = \"bernoulli\"\nprobability = 0.5"),
    density!("distribution = \"offset\""),
    density!("distribution = \"offset\"\noffset = \"ten\""),
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s.x\"\ndistribution = \"offset\"\nrelative_offset = 0.1\n",
    // files
    density!("distribution = \"empirical\"\ncolumn = \"density\""),
    density!("distribution = \"empirical\"\nfile = \"absent.csv\"\ncolumn = \"density\""),
    density!("distribution = \"empirical\"\nfile = \"data.txt\"\ncolumn = \"density\""),
    density!("distribution = \"empirical\"\nfile = \"data.csv\"\ncolumn = \"densty\""),
    density!("distribution = \"empirical\"\nfile = \"data.csv\"\ncolumn = \"name\""),
    density!("distribution = \"empirical\"\nfile = \"data.csv\"\ncolumn = \"density\"\nsha256 = \"00\""),
    density!("distribution = \"empirical\"\nfile = \"data.csv\"\ncolumn = \"density\"\ninterpolation = \"cubic\""),
    density!("distribution = \"empirical\"\nfile = \"empty.csv\"\ncolumn = \"density\""),
    density!("distribution = \"empirical\"\nfile = \"ragged.csv\"\ncolumn = \"density\""),
    // rows of a file
    rows!(""),
    rows!("file = \"data.csv\""),
    rows!("file = \"empty.csv\"\nparameters = [\"wheels.w1.radius_m\"]\ncolumns = [\"density\"]"),
    rows!("file = \"ragged.csv\"\nparameters = [\"wheels.w1.radius_m\"]\ncolumns = [\"density\"]"),
    rows!("file = \"data.csv\"\nparameters = []"),
    rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\", \"wheels.w1.length_m\"]"),
    rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\", \"wheels.w2.radius_m\"]"),
    rows!(
        "file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\", \"body.mass_kg\"]\ncolumns = [\"density\", \"density\"]"
    ),
    rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\", \"wheels.w1.radius_m\"]"),
    rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]\nsha256 = \"00\""),
    rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]\ninterpolation = \"linear\""),
    rows!("file = \"data.csv\"\nparameter = \"wheels.w1.radius_m\"\nparameters = [\"wheels.w1.radius_m\"]"),
    rows!("file = \"data.csv\"\ncolumns = [\"density\"]"),
    rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]\ncolumns = [\"densty\"]"),
    rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]\ncolumns = [\"name\"]"),
    rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]\ncolumns = [\"infinite\"]"),
    rows!("file = \"data.csv\"\nparameters = [\"initial.angular_velocity_rad_s\"]\ncolumns = [\"density\"]"),
    concat!(rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]"), pair!("")),
    concat!(pair!(""), rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]")),
    concat!(
        rows!("file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]"),
        "[design]\nkind = \"table\"\nfile = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]\n"
    ),
    concat!(
        rows!(
            "file = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\", \"wheels.w1.length_m\"]\ncolumns = [\"density\", \"density\"]"
        ),
        "[[correlate]]\nparameters = [\"wheels.w1.radius_m\", \"wheels.w1.length_m\"]\ncorrelation = 0.5\n"
    ),
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"uniform_direction\"\nmagnitude = { distribution = \"bootstrap\", file = \"data.csv\", parameters = [\"wheels.w1.radius_m\"] }\n",
    // attitude
    density!("distribution = \"uniform_attitude\""),
    "[[disperse]]\nparameter = \"initial.attitude.w\"\ndistribution = \"uniform_attitude\"\n",
    // designs
    "[design]\nkind = \"sobel\"\n",
    "[design]\nseed = 3\n",
    "[design]\nkind = \"sobol\"\nlevels = 3\n",
    "[design]\nkind = \"grid\"\n",
    "[design]\nkind = \"grid\"\nlevels = 0\n",
    "[design]\nkind = \"grid\"\nlevels = 100000000000000000\n",
    "[design]\nkind = \"sobol\"\nreplicates = 0\n",
    "[design]\nkind = \"grid\"\nlevels = 3\nquantiles = [0.5]\n",
    "[design]\nkind = \"one_at_a_time\"\nquantiles = [0.0, 0.5]\n",
    concat!("[design]\nkind = \"grid\"\nlevels = [3, 3, 3]\n", pair!("")),
    concat!("[design]\nkind = \"grid\"\nlevels = 2\n", pair!("")),
    concat!("[design]\nkind = \"saltelli\"\n", pair!("")),
    "[design]\nkind = \"table\"\n",
    "[design]\nkind = \"table\"\nfile = \"data.csv\"\n",
    "[design]\nkind = \"table\"\nfile = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\", \"wheels.w1.length_m\"]\n",
    "[design]\nkind = \"table\"\nfile = \"data.csv\"\nparameters = [\"wheels.w2.radius_m\"]\n",
    concat!("[design]\nkind = \"table\"\nfile = \"data.csv\"\nparameters = [\"wheels.w1.radius_m\"]\n", pair!("")),
    // distributions with a shape; ends beyond the largest number
    "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"gamma\"\nshape = 0.001\nscale = 1\n",
    "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"weibull\"\nshape = 2\nscale = 0\n",
    "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"exponential\"\nmin = 0.1\n",
    "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"student_t\"\ndegrees_of_freedom = 0.1\nscale = 1\n",
    "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"student_t\"\ndegrees_of_freedom = 3\n",
    "[[disperse]]\nparameter = \"body.parts.fuselage.density_kg_m3\"\ndistribution = \"log_uniform\"\nfactor = 1e308\n",
    "[[disperse]]\nparameter = \"body.parts.fuselage.density_kg_m3\"\ndistribution = \"uniform\"\nrelative_half_width = 1e307\n",
    // correlation
    pair!("[[correlate]]\ncorrelation = [[1, 0], [0, 1]]"),
    pair!("[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]"),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.length_m\"]\ncorrelation = [[1, 0], [0, 1]]"
    ),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radios_m\"]\ncorrelation = [[1, 0], [0, 1]]"
    ),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[1, 0], [0]]"
    ),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[1]]"
    ),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[1, 0.5], [0.4, 1]]"
    ),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[1, 1.5], [1.5, 1]]"
    ),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[2, 0.5], [0.5, 2]]"
    ),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncovariance = [[100, 0.1], [0.1, 1e-4]]"
    ),
    pair!("[[correlate]]\nparameters = [\"wheels.w1.radius_m\"]\ncovariance = [[2e-4]]"),
    pair!(
        "[[correlate]]\nparameters = [\"wheels.w1.radius_m\", \"wheels.w1.radius_m\"]\ncorrelation = [[1, 0], [0, 1]]"
    ),
    pair!("[[correlate]]\nparameters = [\"wheels.w1.radius_m\"]\ncorrelation = [[1]]\nrank_correlation = [[1]]"),
    pair!("[[correlate]]\nparameters = [\"wheels.w1.radius_m\"]\ncorrelation = [[1]]\nnearest_psd = \"yes\""),
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"normal\"\nstd = 1\n[[correlate]]\nparameters = [\"initial.angular_velocity_rad_s\"]\ncorrelation = [[1, 0.9, 0.9], [0.9, 1, -0.9], [0.9, -0.9, 1]]\n",
    concat!(
        "[design]\nkind = \"one_at_a_time\"\nlevels = 5\n",
        pair!(
            "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[1, 0.5], [0.5, 1]]"
        )
    ),
    concat!(
        "[design]\nkind = \"grid\"\nlevels = 5\n",
        pair!(
            "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[1, 0.5], [0.5, 1]]"
        )
    ),
    concat!(
        "[design]\nkind = \"latin_hypercube\"\n",
        pair!(
            "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[1, 0.5], [0.5, 1]]"
        )
    ),
    concat!(
        "[design]\nkind = \"saltelli\"\n",
        pair!(
            "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = [[1, 0.5], [0.5, 1]]"
        )
    ),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = 1.5"
    ),
    pair!("[[correlate]]\nparameters = [\"wheels.w1.radius_m\"]\ncorrelation = 0.5"),
    pair!(
        "[[correlate]]\nparameters = [\"body.parts.fuselage.density_kg_m3\", \"wheels.w1.radius_m\"]\ncorrelation = 0.5\n[[correlate]]\nparameters = [\"wheels.w1.radius_m\", \"body.parts.fuselage.density_kg_m3\"]\nrank_correlation = 0.4"
    ),
    "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"offset\"\noffset = 0.01\n[[disperse]]\nparameter = \"wheels.w1.density_kg_m3\"\ndistribution = \"normal\"\nstd = 10\n[[correlate]]\nparameters = [\"wheels.w1.radius_m\", \"wheels.w1.density_kg_m3\"]\ncorrelation = 0.5\n",
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"uniform_direction\"\n[[disperse]]\nparameter = \"wheels.w1.density_kg_m3\"\ndistribution = \"normal\"\nstd = 10\n[[correlate]]\nparameters = [\"initial.angular_velocity_rad_s.x\", \"wheels.w1.density_kg_m3\"]\ncorrelation = 0.5\n",
    "[[disperse]]\nparameter = \"initial.attitude\"\ndistribution = \"attitude_error\"\nstd_rad = 0.01\n[[disperse]]\nparameter = \"wheels.w1.density_kg_m3\"\ndistribution = \"normal\"\nstd = 10\n[[correlate]]\nparameters = [\"initial.attitude.w\", \"wheels.w1.density_kg_m3\"]\ncorrelation = 0.5\n",
    // derived
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"0.25 / initial.position_m.x\"\n",
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\n",
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"2 *\"\n",
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"wheels.w1.radius\"\n",
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"cosh(wheels.w1.length_m)\"\n",
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"wheels.w2.radius_m\"\n",
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"initial.angular_velocity_rad_s\"\n",
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"wheels.w1.length_m\"\n",
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"wheels.w1.radius_m\"\n",
    "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"wheels.w1.length_m * 2.5\"\n[[derive]]\nparameter = \"wheels.w1.length_m\"\nexpression = \"wheels.w1.radius_m / 2.5\"\n",
    "[[derive]]\nparameter = \"initial.attitude.w\"\nexpression = \"1\"\n",
    pair!("[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"wheels.w1.length_m * 2.5\""),
];

/// The folder with the files that cases name.
fn folder() -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!("spindrift-bad-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    for (name, text) in [
        (
            "data.csv",
            "density,name,wheels.w1.radius_m,wheels.w2.radius_m,infinite\n2600,a,0.25,0.25,1\n2700,b,0.26,0.26,inf\n",
        ),
        ("data.txt", "density\n2600\n"),
        ("empty.csv", "density\n"),
        ("ragged.csv", "density,name\n1,2,3\n"),
    ] {
        std::fs::write(folder.join(name), text).expect("written");
    }
    folder
}

#[test]
fn every_error_gives_line_key_value_range_and_remedy() {
    let start = start();
    assert_eq!(start.lines().count(), 22);
    assert!(CASES.len() >= 60);
    let folder = folder();
    assert!(Plan::from_text_in(&folder, "bad.toml", &start, Overrides::default()).is_ok(), "the start is good");
    let (mut snapshot, mut wrong) = (String::new(), Vec::new());
    for case in CASES {
        let plan = Plan::from_text_in(&folder, "bad.toml", &format!("{start}{case}"), Overrides::default());
        let Err(error) = plan else {
            wrong.push(format!("accepted:\n{case}"));
            continue;
        };
        for problem in &error.problems {
            let said = !problem.key.is_empty() && !problem.allowed.is_empty() && !problem.remedy.is_empty();
            if problem.file != "bad.toml" || problem.line.is_none() || !said {
                wrong.push(error.to_string());
            }
        }
        if error.problems.len() != 1 {
            wrong.push(format!("{} problems, not one:\n{case}{error}", error.problems.len()));
        }
        let said = error.to_string().replace(&format!("{}/", folder.display()), "");
        let lines = case.lines().enumerate().map(|(k, line)| format!("{:>3} {line}\n", k + 23));
        let _ = writeln!(snapshot, "{}{said}\n", lines.collect::<String>()); // writing to a String does not fail
    }
    std::fs::remove_dir_all(&folder).expect("removed");
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n\n"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/bad_dispersions.txt");
    if std::env::var_os("SPINDRIFT_WRITE_SNAPSHOT").is_some() {
        std::fs::write(&path, &snapshot).expect("written");
    }
    let golden = std::fs::read_to_string(&path).expect("the snapshot");
    for (found, expected) in snapshot.split("\n\n").zip(golden.split("\n\n")) {
        assert_eq!(found, expected);
    }
    assert_eq!(snapshot.len(), golden.len());
}
