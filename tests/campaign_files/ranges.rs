//! Each end of a range is accepted, and the next number beyond it refused by its key.

use crate::prelude::*;

use spindrift::scene::schema::Limit;

const TINY: f64 = 5e-324;

fn is_refused(text: &str, key: &str) -> bool {
    parsed(text).err().is_some_and(|error| error.problems.iter().any(|problem| problem.key == key))
}

fn ends(limit: Limit, width: usize) -> Vec<(Vec<f64>, bool)> {
    let each = |ends: &[(f64, bool)]| -> Vec<(Vec<f64>, bool)> {
        let with = |x: f64, component: usize| (0..width).map(|i| if i == component { x } else { 1.0 }).collect();
        ends.iter().flat_map(|(x, passes)| (0..width).map(move |component| (with(*x, component), *passes))).collect()
    };
    let infinite = [f64::INFINITY, f64::NEG_INFINITY].map(|x| (x, false));
    let diagonal = |[a, b, c]: [f64; 3]| vec![a, 0.0, 0.0, b, 0.0, c];
    // beyond the slack of 16 roundings of the trace that docs/campaign-files.md allows
    let beyond = 6000.0 * 17.0 * f64::EPSILON;
    let bodies = [
        ([1000.0, 2000.0, 3000.0], true),
        ([1000.0, 2000.0, 3000.0 + beyond], false),
        ([3000.0 + beyond, 1000.0, 2000.0], false),
        ([1000.0, 3000.0 + beyond, 2000.0], false),
        ([0.0, 2000.0, 2000.0], false),
        ([2000.0, 0.0, 2000.0], false),
        ([2000.0, 2000.0, -0.0], false),
    ];
    let (short, long) = (libm::pow(2.0, -511.0), libm::pow(2.0, 512.0).next_down());
    match limit {
        Limit::Finite => each(&infinite),
        Limit::Positive => each(&[(0.0, false), (-0.0, false), (-TINY, false), (TINY, true), (f64::INFINITY, false)]),
        Limit::NotNegative | Limit::Thrust(_) => {
            each(&[(-TINY, false), (-0.0, true), (0.0, true), (TINY, true), (f64::INFINITY, false)])
        }
        Limit::Direction => {
            [(short, true), (short.next_down(), false), (long, true), (long.next_up(), false), (0.0, false)]
                .into_iter()
                .flat_map(|(x, passes)| {
                    (0..3).map(move |i| ((0..3).map(|j| if i == j { -x } else { 0.0 }).collect(), passes))
                })
                .collect()
        }
        Limit::UnitQuaternion => {
            [(1.000001, true), (1.000001f64.next_up(), false), (0.999999, false), (0.999999f64.next_up(), true)]
                .into_iter()
                .flat_map(|(x, passes)| {
                    (0..4).map(move |i| ((0..4).map(|j| if i == j { -x } else { 0.0 }).collect(), passes))
                })
                .collect()
        }
        Limit::Inertia => bodies.into_iter().map(|(moments, passes)| (diagonal(moments), passes)).collect(),
        Limit::PrincipalMoments => bodies.into_iter().map(|(moments, passes)| (moments.to_vec(), passes)).collect(),
    }
}

#[test]
fn each_row_of_the_schema_holds_its_limit() {
    let (mut wrong, mut counts) = (Vec::new(), [0; 2]);
    for text in every_scene() {
        let plan = parsed(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        for parameter in Parameter::all(&plan.nominal) {
            let relative = ["debris_attitude", "debris_relative_angular_velocity_rad_s"];
            let is_inertial = plan.nominal.initial.debris_attitude_inertial.is_some();
            if parameter.value(&plan.nominal, 0).is_none() || is_inertial && relative.contains(&parameter.facts().key) {
                continue;
            }
            if plan.nominal.orbit.is_some()
                && ["initial.position_m", "initial.velocity_m_s"].contains(&&*parameter.name())
                || plan.nominal.initial.attitude_orbital.is_some()
                    && ["initial.attitude", "initial.angular_velocity_rad_s"].contains(&&*parameter.name())
            {
                continue;
            }
            for (values, passes) in ends(parameter.facts().limit, parameter.width()) {
                let mut other = plan.clone();
                values.iter().enumerate().for_each(|(i, x)| parameter.set(&mut other.nominal, i, *x));
                let key = parameter
                    .name()
                    .replace("actuation.burn", "actuation[0]")
                    .replace("actuation.later", "actuation[1]");
                if is_refused(&other.text(), &key) == passes {
                    wrong.push(format!("{key} = {values:?}: refused {passes}"));
                }
                counts[usize::from(passes)] += 1;
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

const SMALL: &str = r#"[campaign]
name = "small"
samples = 11
seed = 1
duration_s = 10.0
[integrator]
method = "auto"
[observe]
points = 11
groups = ["effort"]
[body]
mass_kg = 10
inertia_kg_m2 = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]
[initial]
velocity_m_s = [1, 2, 3]
angular_velocity_rad_s = [0, 0, 1]
"#;

fn with(from: &str, to: &str) -> String {
    assert!(from.is_empty() || SMALL.contains(from), "{from}");
    if from.is_empty() { format!("{SMALL}{to}") } else { SMALL.replace(from, to) }
}

/// A file with `@` for a number that no row of the schema has, its key, the values at the ends, and the next beyond.
struct Range {
    file: String,
    key: &'static str,
    accepted: Vec<String>,
    refused: Vec<String>,
}

fn whole(file: String, key: &'static str, range: [u64; 2]) -> Range {
    let below = range[0].checked_sub(1).map_or("-1".to_owned(), |x| x.to_string());
    let beyond = (u128::from(range[1]) + 1).to_string();
    Range { file, key, accepted: range.map(|x| x.to_string()).to_vec(), refused: vec![below, beyond] }
}

fn closed(file: String, key: &'static str, [low, high]: [f64; 2]) -> Range {
    let text = |x: f64| format!("{x:?}");
    Range {
        file,
        key,
        accepted: vec![text(low), text(high)],
        refused: vec![text(low.next_down()), text(high.next_up()), "nan".to_owned()],
    }
}

fn open(file: String, key: &'static str, [low, high]: [f64; 2]) -> Range {
    closed(file, key, [low.next_up(), high.next_down()])
}

fn ranges() -> Vec<Range> {
    let of = |distribution: &str, keys: &str| {
        let table =
            format!("[[disperse]]\nparameter = \"initial.velocity_m_s.x\"\ndistribution = {distribution:?}\n{keys}\n");
        with("", &table)
    };
    let rate = |distribution: &str, keys: &str| of(distribution, keys).replace("velocity_m_s.x", "velocity_m_s");
    let design = |samples: &str, keys: &str| {
        let dispersed = "[[disperse]]\nparameter = \"initial.velocity_m_s.x\"\ndistribution = \"normal\"\nstd = 0.1\n";
        with("", &format!("{dispersed}[design]\n{keys}\n")).replace("samples = 11\n", samples)
    };
    let integrator = |keys: &str| with("method = \"auto\"\n", keys);
    let require = |keys: &str| with("", &format!("[[require]]\nobservable = \"steps\"\nat_most = 1000\n{keys}\n"));
    let stop = |keys: &str| {
        let keys = format!("[stop]\nobservable = \"steps\"\n{keys}\n");
        let missing = [("quantile", "0.5"), ("half_width", "1.0"), ("max_samples", "100")]
            .map(|(key, value)| if keys.contains(key) { String::new() } else { format!("{key} = {value}\n") });
        with("", &format!("{keys}{}", missing.concat()))
    };
    let most = 1 << 53;
    vec![
        whole(with("samples = 11", "samples = @"), "campaign.samples", [1, most]),
        whole(with("seed = 1", "seed = @"), "campaign.seed", [0, i64::MAX as u64]),
        open(with("duration_s = 10.0", "duration_s = @"), "campaign.duration_s", [0.0, f64::INFINITY]),
        whole(integrator("max_steps = @\n"), "integrator.max_steps", [1, i64::MAX as u64]),
        closed(integrator("tolerance = @\n"), "integrator.tolerance", [1e-16, 1e-2]),
        closed(integrator("relative_tolerance = @\n"), "integrator.relative_tolerance", [1e-16, 1e-2]),
        closed(integrator("absolute_tolerance = @\n"), "integrator.absolute_tolerance", [1e-16, 1e-2]),
        closed(integrator("method = \"runge_kutta_4\"\nstep_s = @\n"), "integrator.step_s", [TINY, 10.0]),
        whole(with("points = 11", "points = @"), "observe.points", [2, 1_000_000]),
        whole(with("", "[bands]\npoints = @\n"), "bands.points", [2, 11]),
        whole(with("points = 11", "points = 1001") + "[bands]\npoints = @\n", "bands.points", [2, 257]),
        closed(with("", "[audit]\nfraction = @\n"), "audit.fraction", [0.0, 1.0]),
        closed(with("", "[statistics]\nconfidence = @\n"), "statistics.confidence", [0.5, 1f64.next_down()]),
        open(with("", "[statistics]\nquantiles = [@]\n"), "statistics.quantiles", [0.0, 1.0]),
        open(require("quantile = @"), "require[0].quantile", [0.0, 1.0]),
        open(require("fraction = @"), "require[0].fraction", [0.0, 1.0]),
        closed(require("quantile = 0.9\nconfidence = @"), "require[0].confidence", [0.5, 1f64.next_down()]),
        open(stop("quantile = @"), "stop.quantile", [0.0, 1.0]),
        closed(stop("confidence = @"), "stop.confidence", [0.5, 1f64.next_down()]),
        open(stop("half_width = @"), "stop.half_width", [0.0, f64::INFINITY]),
        whole(stop("max_samples = @"), "stop.max_samples", [11, most]),
        whole(with("", "[retain]\ntrajectories = \"sample:@\"\n"), "retain.trajectories", [1, 1_000_000]),
        whole(with("", "[retain]\ntrajectories = \"worst:@ by steps\"\n"), "retain.trajectories", [1, 1_000_000]),
        whole(with("seed = 1\n", "seed = 1\nonly = [@]\n"), "campaign.only", [0, 10]),
        whole(design("samples = 1\n", "kind = \"sobol\"\nreplicates = @"), "design.replicates", [1, 1024]),
        open(design("", "kind = \"grid\"\nquantiles = [@]"), "design.quantiles", [0.0, 1.0]),
        closed(of("bernoulli", "value = 1\nprobability = @"), "disperse[0].probability", [0.0, 1.0]),
        closed(of("beta", "min = 0\nmax = 1\nalpha = 2\nbeta = @"), "disperse[0].beta", [0.01, 1e4]),
        closed(of("beta", "min = 0\nmax = 1\nbeta = 2\nalpha = @"), "disperse[0].alpha", [0.01, 1e4]),
        closed(of("gamma", "scale = 1\nshape = @"), "disperse[0].shape", [0.01, 1e4]),
        closed(of("weibull", "scale = 1\nshape = @"), "disperse[0].shape", [0.05, 1e4]),
        closed(of("student_t", "scale = 1\ndegrees_of_freedom = @"), "disperse[0].degrees_of_freedom", [0.5, 1e4]),
        closed(rate("cone", "half_angle_rad = @"), "disperse[0].half_angle_rad", [f64::MIN_POSITIVE, PI]),
        closed(
            rate("von_mises_fisher", "concentration = @"),
            "disperse[0].concentration",
            [f64::MIN_POSITIVE, f64::MAX],
        ),
    ]
}

#[test]
fn each_end_of_each_range_is_accepted_and_the_next_number_refused() {
    let mut wrong = Vec::new();
    for Range { file, key, accepted, refused } in ranges() {
        for value in accepted {
            if is_refused(&file.replace('@', &value), key) {
                wrong.push(format!("{key} = {value} is refused"));
            }
        }
        for value in refused {
            if !is_refused(&file.replace('@', &value), key) {
                wrong.push(format!("{key} = {value} is not refused"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn lists_and_names_have_their_lengths() {
    let quantiles =
        |count: u32| (1..=count).map(|k| format!("{:?}", f64::from(k) / 128.0)).collect::<Vec<_>>().join(", ");
    let derived =
        |length: usize| format!("[[observable]]\nname = \"{}\"\nexpression = \"2 * steps\"\n", "a".repeat(length));
    type Written<'a> = &'a dyn Fn(usize) -> String;
    let cases: [(&str, Written<'_>, usize); 4] = [
        ("campaign.name", &|length| with("\"small\"", &format!("\"{}\"", "a".repeat(length))), 100),
        (
            "campaign.description",
            &|length| with("seed = 1\n", &format!("seed = 1\ndescription = \"{}\"\n", "a".repeat(length))),
            1000,
        ),
        ("observable[0].name", &|length| with("", &derived(length)), 60),
        (
            "statistics.quantiles",
            &|count| with("", &format!("[statistics]\nquantiles = [{}]\n", quantiles(count as u32))),
            100,
        ),
    ];
    for (key, file, most) in cases {
        for (length, passes) in [(0, false), (1, true), (most, true), (most + 1, false)] {
            let text = file(length);
            assert_eq!(parsed(&text).is_ok(), passes, "{key} of length {length}");
            assert_eq!(is_refused(&text, key), !passes, "{key} of length {length}");
        }
    }
}

#[test]
fn overrides_have_the_ranges_of_the_file() {
    let passes = |overrides: Overrides| Plan::from_text("ranges.toml", SMALL, overrides).is_ok();
    for (samples, expected) in [(0, false), (1, true), (1 << 53, true), ((1 << 53) + 1, false)] {
        assert_eq!(
            passes(Overrides { samples: Some(samples), ..Overrides::default() }),
            expected,
            "--samples {samples}"
        );
    }
    for (seed, expected) in [(0, true), (i64::MAX as u64, true), (i64::MAX as u64 + 1, false)] {
        assert_eq!(passes(Overrides { seed: Some(seed), ..Overrides::default() }), expected, "--seed {seed}");
    }
    for (fraction, expected) in [(-TINY, false), (0.0, true), (1.0, true), (1f64.next_up(), false), (f64::NAN, false)] {
        let overrides = Overrides { audit_fraction: Some(fraction), ..Overrides::default() };
        assert_eq!(passes(overrides), expected, "--audit {fraction:?}");
    }
}
