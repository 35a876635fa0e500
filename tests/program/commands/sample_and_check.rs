//! `spindrift sample`, `check`, and the errors that all commands share.

use crate::prelude::*;

use crate::page::numbers::quantile;

#[test]
fn sample_draws_the_rows_of_the_campaign() {
    let scratch = folder("drawn");
    scratch.file("thin.toml", &(campaign() + NEGATIVE_WALLS));
    let said = scratch.prints("sample thin.toml --out s.csv --plot s.html", 0);
    for expected in
        ["of 599 draws", "body.parts.fuselage.wall_thickness_m", "uniform, -0.02", "initial.angular_velocity_rad_s.z"]
    {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
    scratch.prints("sample thin.toml --out s.parquet", 0);
    let text = scratch.text("s.csv");
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    assert_eq!(names[..3], ["sample_id", "status", "initial_angular_velocity_x_rad_s"]);
    assert_eq!(text.lines().count(), 601);
    let parquet = &scratch.table("s.parquet");
    scratch.prints("campaign thin.toml --out r", 1);
    let rows = scratch.rows("r");
    assert_eq!(names[names.len() - 7..][..2], ["mass_kg", "center_of_mass_x_m"]);
    for name in &names[2..names.len() - 7] {
        let run: Vec<u64> = rows.iter().flat_map(|batch| floats(batch, name)).map(f64::to_bits).collect();
        let drawn: Vec<u64> = floats(parquet, name).into_iter().map(f64::to_bits).collect();
        let column = names.iter().position(|other| other == name).unwrap();
        let written =
            text.lines().skip(1).map(|line| line.split(',').nth(column).unwrap().parse::<f64>().unwrap().to_bits());
        assert_eq!(drawn, run, "{name}");
        assert!(written.eq(run), "{name}");
    }
    let invalid = text.lines().filter(|line| line.contains(",invalid_sample,")).count();
    assert!((100..300).contains(&invalid), "a third is thinner than nothing: {invalid}");
    let shown = Found::shown_on(&scratch.text("s.html"));
    assert!(shown.iter().any(|(title, _)| title.starts_with("Rank correlation")), "{shown:?}");
    let statuses: Vec<&str> = text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap()).collect();
    // one sample in all digits; rounded in `simulate`, in the unit of the screen
    let sample = (1..600).find(|row| statuses[*row] != "invalid_sample").unwrap();
    let line = text.lines().nth(sample + 1).unwrap().split(',').nth(2).unwrap();
    let value: f64 = line.parse().unwrap();
    for (options, shown, factor) in
        [("", "rad/s", 1.0), (" --set display.units=[\"deg/s\"]", "deg/s", 180.0 / std::f64::consts::PI)]
    {
        let said = scratch.prints(&format!("sample thin.toml --sample {sample}{options}"), 0);
        assert!(said.contains("initial.angular_velocity_rad_s.x") && said.contains(line), "{line} in:\n{said}");
        let said = scratch.prints(&format!("simulate thin.toml --sample {sample}{options}"), 0);
        let of_row = said.lines().find(|line| line.starts_with("initial.angular_velocity_rad_s.x")).unwrap();
        let words: Vec<&str> = of_row.split_whitespace().collect();
        assert!(words[1].len() <= 11 && words[2] == shown && words[3..] == ["nominal", "0", shown], "{of_row}");
        let found: f64 = words[1].parse().unwrap();
        assert!((found / (value * factor) - 1.0).abs() < 1e-5, "{found} of {value}");
    }
    scratch.shows(&format!("sample thin.toml --sample {sample}"), 0, "principal_moment_largest_kg_m2");
    scratch.prints("sample thin.toml --sample 600", 2);
    scratch.prints("sample thin.toml --out s.txt", 2);
    scratch.prints("sample thin.toml --samples 0", 2);
}

#[test]
fn check_has_no_line_about_what_is_not_there() {
    let scratch = folder("check-bare");
    let bare = "[campaign]\nname = \"bare\"\nsamples = 1\nseed = 0\nduration_s = 2\n[body]\nmass_kg = 10\n\
                inertia_kg_m2 = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]\n[initial]\nangular_velocity_rad_s = [0, 0, 1]\n";
    scratch.file("bare.toml", bare);
    let said = scratch.prints_wide("check bare.toml --verbose", 0);
    assert_says(
        &said,
        [
            "inertia of the spacecraft about its centre of mass",
            "angular velocity of the body: ",
            "attitude quaternion: ",
        ],
    );
    let listed = said.split("== Mass properties").nth(1).unwrap();
    for absent in ["wheel", "debris", "thrust", "actuat", "impulse", "null_space", "there is no"] {
        let line = listed.lines().find(|line| line.contains(absent) && !line.starts_with("observed groups"));
        assert_eq!(line, None, "{said}");
    }
    let thruster = "[[thrusters]]\nname = \"p1\"\nposition_m = [0.1, 0, 0]\ndirection = [0, 0, 1]\n";
    let arc = |keys: &str| format!("{bare}{thruster}[[actuation]]\nend_s = 9\nthrust_n = {{ p1 = 1.0 }}\n{keys}\n");
    let says_work = |keys: &str| {
        scratch.file("bare.toml", &arc(keys));
        let said = scratch.prints_wide("check bare.toml --verbose", 0);
        let is_computed = !said.contains("not computed: no command of the schedule acts");
        assert_eq!(said.contains("work of actuators") || said.contains("impulse"), is_computed, "{said}");
        is_computed
    };
    assert!(says_work("start_s = 1"));
    assert!(!says_work("start_s = 2"));
}

/// Law: below a dispersed rate, attitude or alignment error are the percentiles of the magnitudes drawn.
#[test]
fn check_shows_magnitudes_and_implausible_numbers() {
    let scratch = folder("check-magnitudes");
    let more = "[[disperse]]\nparameter = \"initial.attitude\"\ndistribution = \"attitude_error\"\nstd_rad = 0.1\n\
                [[disperse]]\nparameter = \"wheels.w1.tilt_rad\"\ndistribution = \"normal\"\nstd = 5\n\
                [[disperse]]\nparameter = \"wheels.w2.rate_rad_s\"\ndistribution = \"normal\"\nstd = 5\n";
    scratch.file("more.toml", &(campaign() + more));
    let said = scratch.prints_wide("check more.toml --verbose", 0);
    let row = |name: &str| {
        let line = said
            .lines()
            .position(|line| line.trim_start().starts_with(name))
            .unwrap_or_else(|| panic!("{name} in:\n{said}"));
        let text = said.lines().nth(line).unwrap().trim_start().strip_prefix(name).unwrap();
        let numbers: Vec<f64> = text.split_whitespace().skip(1).map_while(|word| word.parse().ok()).collect();
        (line, numbers)
    };
    let (above, _) = row("initial.angular_velocity_rad_s.z");
    let (below, rates) = row("|initial.angular_velocity_rad_s|");
    assert_eq!(below, above + 1, "{said}");
    scratch.prints("sample more.toml --out drawn.csv", 0);
    scratch.prints("sample more.toml --out drawn.parquet", 0);
    let table = scratch.table("drawn.parquet");
    let axes = ["x", "y", "z"].map(|axis| floats(&table, &format!("initial_angular_velocity_{axis}_rad_s")));
    let size = |row: usize| axes.iter().map(|axis| axis[row].powi(2)).sum::<f64>().sqrt();
    let sizes: Vec<f64> = (1..600).map(size).collect();
    for (p, shown) in [0.01, 0.5, 0.99].into_iter().zip(&rates[1..]) {
        let expected = quantile(&sizes, p);
        assert!((shown / expected - 1.0).abs() < 1e-3, "{shown} {expected}");
    }
    let (_, angles) = row("initial.attitude, angle from nominal");
    // three deviations of 0.1 rad: quantiles of the chi distribution with three degrees of freedom, within a fifth
    for (shown, chi) in angles[1..].iter().zip([0.0339, 0.1538, 0.3368]) {
        assert!(angles[0] == 0.0 && (0.5..1.3).contains(&(shown / chi)), "{angles:?}");
    }
    row("|wheels.w1.tilt_rad|");
    // equal components of a nominal value are one number
    let brief = scratch.prints_wide("check more.toml", 0);
    assert_says(brief, ["  wheels.w1.tilt_rad  normal, std 5 rad, nominal 0\n"]);
    assert!(!said.contains("|wheels.w2") && !said.contains("|initial.debris"), "{said}");
    let notes = said.split("== Notes\n").nth(1).unwrap_or_else(|| panic!("{said}"));
    assert!(notes.lines().any(|note| note.starts_with("wheels.w1.tilt_rad, as dispersed")), "{notes}");
}

/// Law: `check` of a shipped campaign takes at most 48 lines of 80 characters and has every dispersed parameter.
#[test]
fn check_fits_a_screen() {
    let scratch = folder("check-screen");
    for name in ["net_launch", "spin_sweep", "slew_closed", "pyramid", "nadir_pointing", "correlated"] {
        let file = root().join(format!("campaigns/{name}.toml"));
        let said = scratch.prints_at(&format!("check {}", file.display()), 0, 80);
        assert_fits(&said, 48, 80);
        assert!(said.lines().take(4).any(|line| line.starts_with(&format!("{name}: "))), "{said}");
        assert!(said.lines().last().is_some_and(|line| line.starts_with("--verbose: ")), "{said}");
        let plan = Plan::load(&file, Overrides::default()).unwrap();
        let mut columns = plan.dispersions.columns().iter().peekable();
        assert!(columns.peek().is_some(), "{name}");
        for column in columns {
            let parameter = column.parameter.name();
            let is_of = |line: &str| {
                let word = line.trim_start().split([' ', ',']).next().unwrap_or_default();
                let rest = word.strip_prefix(&parameter);
                rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.') && rest.matches('.').count() == 1)
            };
            assert!(said.lines().any(is_of), "{parameter} in:\n{said}");
        }
    }
}

#[test]
fn bad_input_ends_with_code_2_and_says_everything() {
    let scratch = folder("bad");
    let bad = campaign().replace("outer_radius_m = 1.0", "outer_radius_m = -1.0").replace("seed = 7", "sead = 7");
    scratch.file("bad.toml", &bad);
    for command in ["campaign", "check", "simulate"] {
        let said = scratch.prints(&format!("{command} bad.toml"), 2);
        assert_says(&said, ["bad.toml:5", "sead", "outer_radius_m"]);
        scratch.shows(&format!("{command} missing"), 2, "campaigns/missing.toml");
    }
    scratch.small("--samples 0", 2);
    scratch.small("--threads 0", 2);
    let cores = std::thread::available_parallelism().unwrap().get();
    let many = 4 * cores + 1;
    for command in ["campaign small.toml", "finish r", "verify r", "compare r r", "report r"] {
        let said = scratch.prints(&format!("{command} --threads {many}"), 2);
        let allowed =
            format!("must be a whole number from 1 to {}: 4 for each core that this process has ({cores})", 4 * cores);
        assert!(said.contains(&allowed), "{command}: {said}");
    }
    scratch.small("--samples many", 2);
    scratch.prints("", 2);
    assert!(!scratch.path("results").exists(), "nothing is written for bad input");
    assert!(scratch.prints("--help", 0).contains("Exit codes"));
}

#[test]
#[cfg(unix)]
fn a_closed_pipe_is_no_panic() {
    let scratch = folder("pipe");
    for arguments in ["simulate small.toml", "check small.toml", "--help"] {
        let mut child = scratch.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{arguments}: {said}");
        assert_eq!(output.status.code(), Some(0), "{arguments}: {said}");
    }
}

#[test]
fn a_file_of_the_current_folder_comes_first() {
    let scratch = folder("find");
    let with_seed = |seed: u32| campaign().replace("seed = 7", &format!("seed = {seed}"));
    let is_meant = |name: &str, seed: u32| {
        let line = format!("\nseed = {seed}\n");
        let said = scratch.prints(&format!("check {name} --plan"), 0);
        assert!(said.contains(&line), "check {name}, {seed}: {said}");
        scratch.prints(&format!("campaign {name} --samples 3 --out r{seed}{name} --no-report"), 0);
        let plan = scratch.text(&format!("r{seed}{name}/plan.toml"));
        assert!(plan.contains(&line), "campaign {name}, {seed}: {plan}");
    };
    scratch.file("campaigns/x.toml", &with_seed(101));
    is_meant("x", 101);
    is_meant("x.toml", 101);
    scratch.file("x.toml", &with_seed(102));
    is_meant("x", 102);
    is_meant("x.toml", 102);
    scratch.file("x", &with_seed(103));
    is_meant("x", 103);
    is_meant("x.toml", 102);
    scratch.file("campaigns/x", &with_seed(104));
    is_meant("x", 103);
}

#[test]
fn a_figure_of_samples_is_without_the_nominal_one() {
    let scratch = folder("drawn-nominal");
    let rate = |axis: &str| {
        format!(
            "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s.{axis}\"\ndistribution = \"uniform\"\n\
             min = 1.0\nmax = 2.0\n"
        )
    };
    let drawn = rate("x") + &rate("y");
    let scene = campaign_without_debris();
    for (name, nominal) in [("near", "[-20.0, -30.0, 31.0]"), ("far", "[-2000.0, -500.0, 31.0]")] {
        let text = scene.replace("[0, 3.141592653589793, 31.41592653589793]", nominal).replace(SPIN_DISPERSION, &drawn);
        assert!(text.contains(nominal) && text.contains(&drawn));
        scratch.file(&format!("{name}.toml"), &text);
    }
    let figure = |name: &str, options: &str| {
        scratch.prints(&format!("sample {name}.toml --plot {name}.html {options}"), 0);
        let found = Found::of_page(&scratch.text(&format!("{name}.html")));
        let figures = found.figures().to_vec();
        let marks = figures.iter().flat_map(|figure| figure["marks"].as_array().unwrap().clone());
        let is_nominal = |mark: &Value| mark["label"].as_str().is_some_and(|label| label.starts_with("nominal"));
        let (nominal, others): (Vec<Value>, Vec<Value>) = marks.partition(is_nominal);
        assert_eq!(nominal.len(), 2);
        let numbers = |mark: &Value| {
            ["x", "y", "edges", "heights", "values"].map(|key| mark.get(key).map(|place| found.array(place)))
        };
        (nominal, others.iter().map(numbers).collect::<Vec<_>>())
    };
    for samples in [3, 40, 600] {
        let options = format!("--samples {samples}");
        let [near, far] = ["near", "far"].map(|name| figure(name, &options));
        assert_ne!(near.0, far.0);
        assert_eq!(format!("{:?}", near.1), format!("{:?}", far.1), "{samples} samples");
        let other = figure("near", &format!("{options} --seed 8"));
        assert_ne!(format!("{:?}", near.1), format!("{:?}", other.1), "{samples} samples");
    }
}

/// Law: the torque of a thruster in `check --verbose` is r x F about the centre of mass.
#[test]
fn torques_of_thrusters_have_their_sign() {
    let scratch = folder("torques");
    let said = scratch.says("check", "net_launch.toml", "--verbose", 0);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    for (name, torque) in [("p1", "[0, 0, 0]"), ("p2", "[0.5, 0, 0]"), ("p3", "[-0.5, 0, 0]")] {
        let (_, rest) = said.split_once(&format!("thruster {name}: ")).unwrap_or_else(|| panic!("no {name}: {said}"));
        assert!(rest.split("thruster ").next().unwrap().contains(&format!("torque {torque} N m")), "{name}: {rest}");
    }
}
