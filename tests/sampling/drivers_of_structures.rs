//! What is said of drivers, over a list of causal structures of known truth, designs and numbers of runs.
//!
//! Each campaign is put into words as on the screen. H0 of each structure, design and number of runs, at alpha 1e-3 by
//! the binomial distribution: an interval of a share that is said covers the truth in 95%; what is not a cause is named
//! in 5% of the campaigns; and a cause that explains more than half is named first in 95% of those in which a test at
//! 1e-4 sees it. Shares are known in closed form, unless the structure says how. Seeds are fixed. `cargo test --release
//! --test sampling -- --ignored drivers_of_all_structures` has all designs and 300 campaigns of each.

use core::f64::consts::{E, PI};

use spindrift::Overrides;
use spindrift::Plan;
use spindrift::analysis::drivers::{Question, rankings};
use spindrift::analysis::sensitivity::Prepared;
use spindrift::findings::names;
use spindrift::math::normal::quantile;
use spindrift::report::drivers_text;
use spindrift::sampling::design::halton::Halton;
use spindrift::sampling::design::latin::Permutation;
use spindrift::sampling::design::sobol::Sobol;
use spindrift::statistics::binomial;

use crate::support::scenes::Uniform;

const OUTCOME: &str = "energy_body_max_j";
/// Probability of each of the tests under H0.
const ALPHA: f64 = 1e-3;

/// An outcome of inputs, from numbers uniform in (0, 1), one for each input.
struct Structure {
    name: &'static str,
    inputs: usize,
    /// Turns the numbers into the inputs, and gives the outcome.
    of: fn(&mut [f64]) -> f64,
    /// The causes, each with its first-order share; NaN if that is not known.
    causes: &'static [(usize, f64)],
    /// The shares of inputs that are no cause, but are correlated with one.
    others: &'static [(usize, f64)],
    /// Limit of a requirement on the outcome; the shares are those of whether it is missed.
    limit: Option<f64>,
    /// Whether most campaigns do not see the tail that gives the main cause its share: in their rows another cause is
    /// the main one.
    is_hidden: bool,
}

const fn structure(
    name: &'static str,
    inputs: usize,
    of: fn(&mut [f64]) -> f64,
    causes: &'static [(usize, f64)],
) -> Structure {
    Structure { name, inputs, of, causes, others: &[], limit: None, is_hidden: false }
}

/// Turns the first numbers into standard normal ones.
fn normal<const N: usize>(u: &mut [f64]) -> [f64; N] {
    u.iter_mut().take(N).for_each(|u| *u = quantile(*u));
    core::array::from_fn(|input| u[input])
}

fn step(is: bool) -> f64 {
    f64::from(u8::from(is))
}

/// 20 in 2% of the runs.
fn jump(u: &mut f64) -> f64 {
    *u = 20.0 * step(*u < 0.02);
    *u
}

/// x + Pareto numbers of this index, of variance a/((a - 1)^2 (a - 2)).
fn with_pareto(u: &mut [f64], index: f64) -> f64 {
    let [x] = normal(u);
    u[1] = u[1].powf(-1.0 / index);
    x + u[1]
}

/// Student's t of 3 degrees, by its quantile: the root of p = 1/2 + (t/(3 + t^2) sqrt(3) + atan(t/sqrt(3)))/pi.
fn student(p: f64) -> f64 {
    let root = 3.0_f64.sqrt();
    let mut ends = [-1e6, 1e6];
    for _ in 0..80 {
        let t: f64 = 0.5 * (ends[0] + ends[1]);
        let below = 0.5 + (root * t / (3.0 + t * t) + (t / root).atan()) / PI < p;
        ends[usize::from(!below)] = t;
    }
    ends[0]
}

fn ishigami(u: &mut [f64]) -> f64 {
    u.iter_mut().take(3).for_each(|u| *u = PI * (2.0 * *u - 1.0));
    u[0].sin() * (1.0 + 0.1 * u[2].powi(4)) + 7.0 * u[1].sin() * u[1].sin()
}

/// z = 0.8 x + 0.6 e, at the places 0 and 1.
fn correlated(u: &mut [f64]) -> [f64; 2] {
    let [x, e] = normal(u);
    u[1] = 0.8 * x + 0.6 * e;
    [x, u[1]]
}

fn structures() -> Vec<Structure> {
    const LOG: f64 = E * (E - 1.0);
    // 3^2 p (1 - p) of P(x > 1.5)
    const STEP: f64 = 9.0 * 0.066_807_201_268_858_1 * 0.933_192_798_731_141_9;
    vec![
        structure(
            "x + rare jump",
            2,
            |u| {
                let [x] = normal(u);
                x + jump(&mut u[1])
            },
            &[(0, 1.0 / 8.84), (1, 7.84 / 8.84)],
        ),
        structure(
            "x + dead part",
            2,
            |u| {
                let [x] = normal(u);
                u[1] = step(u[1] < 0.04);
                x + 3.0 * u[1]
            },
            &[(0, 1.0 / 1.3456), (1, 0.3456 / 1.3456)],
        ),
        Structure {
            is_hidden: true,
            ..structure(
                "x + Pareto 2.2",
                2,
                |u| with_pareto(u, 2.2),
                &[(0, 1.0 / 8.638_888_9), (1, 7.638_888_9 / 8.638_888_9)],
            )
        },
        Structure {
            is_hidden: true,
            ..structure("x + Pareto 2.5", 2, |u| with_pareto(u, 2.5), &[(0, 9.0 / 29.0), (1, 20.0 / 29.0)])
        },
        structure("x + Pareto 4", 2, |u| with_pareto(u, 4.0), &[(0, 9.0 / 11.0), (1, 2.0 / 11.0)]),
        structure(
            "x + Student 3",
            2,
            |u| {
                let [x] = normal(u);
                u[1] = student(u[1]);
                x + u[1]
            },
            &[(0, 0.25), (1, 0.75)],
        ),
        structure(
            "|x|",
            2,
            |u| {
                let [x, _] = normal(u);
                x.abs()
            },
            &[(0, 1.0)],
        ),
        structure(
            "x^2",
            2,
            |u| {
                let [x, _] = normal(u);
                x * x
            },
            &[(0, 1.0)],
        ),
        structure(
            "x^2 + z",
            3,
            |u| {
                let [x, z, _] = normal(u);
                x * x + z
            },
            &[(0, 2.0 / 3.0), (1, 1.0 / 3.0)],
        ),
        structure(
            "none of 50",
            51,
            |u| {
                normal::<50>(u);
                quantile(u[50])
            },
            &[(50, 1.0)],
        ),
        structure(
            "one of 300",
            300,
            |u| {
                normal::<300>(u);
                u[7] + u[11]
            },
            &[(7, 0.5), (11, 0.5)],
        ),
        structure(
            "XOR",
            4,
            |u| {
                let [x, _, _, z] = normal(u);
                step((x > 0.0) != (z > 0.0))
            },
            &[(0, 0.0), (3, 0.0)],
        ),
        structure(
            "x z",
            3,
            |u| {
                let [x, z, _] = normal(u);
                x * z
            },
            &[(0, 0.0), (1, 0.0)],
        ),
        structure(
            "product of the third and fourth of five",
            5,
            |u| {
                let [_, _, x, z, _] = normal(u);
                x * z
            },
            &[(2, 0.0), (3, 0.0)],
        ),
        structure(
            "x + x z",
            3,
            |u| {
                let [x, z, _] = normal(u);
                x + x * z
            },
            &[(0, 0.5), (1, 0.0)],
        ),
        structure(
            "3x + z",
            3,
            |u| {
                let [x, z, _] = normal(u);
                3.0 * x + z
            },
            &[(0, 0.9), (1, 0.1)],
        ),
        structure(
            "x^3 + z",
            3,
            |u| {
                let [x, z, _] = normal(u);
                x.powi(3) + z
            },
            &[(0, 15.0 / 16.0), (1, 1.0 / 16.0)],
        ),
        structure(
            "e^x + z",
            3,
            |u| {
                let [x, z, _] = normal(u);
                x.exp() + z
            },
            &[(0, LOG / (LOG + 1.0)), (1, 1.0 / (LOG + 1.0))],
        ),
        structure(
            "e^(x + z)",
            3,
            |u| {
                let [x, z, _] = normal(u);
                (x + z).exp()
            },
            &[(0, 1.0 / (E + 1.0)), (1, 1.0 / (E + 1.0))],
        ),
        structure(
            "x^2 + z^2",
            3,
            |u| {
                let [x, z, _] = normal(u);
                x * x + z * z
            },
            &[(0, 0.5), (1, 0.5)],
        ),
        structure(
            "sum of five",
            6,
            |u| normal::<6>(u)[..5].iter().sum(),
            &[(0, 0.2), (1, 0.2), (2, 0.2), (3, 0.2), (4, 0.2)],
        ),
        structure(
            "five levels + z",
            3,
            |u| {
                let level = (5.0 * u[2]).floor();
                let [_, z] = normal(u);
                u[2] = level;
                level + z
            },
            &[(2, 2.0 / 3.0), (1, 1.0 / 3.0)],
        ),
        structure("five steps", 2, |u| (5.0 * u[0]).floor(), &[(0, 1.0)]),
        structure(
            "a step + z",
            2,
            |u| {
                let [x, z] = normal(u);
                3.0 * step(x > 1.5) + z
            },
            &[(0, STEP / (STEP + 1.0)), (1, 1.0 / (STEP + 1.0))],
        ),
        structure("two waves", 2, |u| (4.0 * PI * u[0]).sin(), &[(0, 1.0)]),
        structure("Ishigami", 4, ishigami, &[(0, 0.313_905_191_147_811_46), (1, 0.442_411_144_790_040_73), (2, 0.0)]),
        structure(
            "x + 2|x| z",
            3,
            |u| {
                let [x, z, _] = normal(u);
                x + 2.0 * x.abs() * z
            },
            &[(0, 0.2), (1, 1.6 / PI)],
        ),
        Structure {
            others: &[(1, 0.64)],
            ..structure(
                "x, and z correlated",
                3,
                |u| {
                    let [x, _] = correlated(u);
                    u[2] = quantile(u[2]);
                    x
                },
                &[(0, 1.0)],
            )
        },
        Structure {
            others: &[(1, 0.512)],
            ..structure(
                "x + e, and z correlated",
                3,
                |u| {
                    let [x, _] = correlated(u);
                    u[2] = quantile(u[2]);
                    x + 0.5 * u[2]
                },
                &[(0, 0.8), (2, 0.2)],
            )
        },
        Structure {
            others: &[(1, 0.409_6)],
            ..structure(
                "x^2, and z correlated",
                3,
                |u| {
                    let [x, _] = correlated(u);
                    x * x
                },
                &[(0, 1.0)],
            )
        },
        Structure {
            limit: Some(1.0),
            ..structure(
                "x > 1",
                2,
                |u| {
                    let [x, _] = normal(u);
                    x
                },
                &[(0, 1.0)],
            )
        },
        Structure {
            limit: Some(1.0),
            ..structure(
                "|x| > 1",
                2,
                |u| {
                    let [x, _] = normal(u);
                    x.abs()
                },
                &[(0, 1.0)],
            )
        },
        Structure {
            limit: Some(1.0),
            others: &[(1, f64::NAN)],
            ..structure(
                "x > 1, and z correlated",
                3,
                |u| {
                    let [x, _] = correlated(u);
                    u[2] = quantile(u[2]);
                    x
                },
                &[(0, 1.0)],
            )
        },
    ]
}

fn plan(structure: &Structure, design: &str, runs: u64) -> Plan {
    let require = structure.limit.map_or_else(String::new, |limit| {
        format!("[[require]]\nobservable = \"{OUTCOME}\"\nat_most = {limit:?}\nfraction = 0.9\n")
    });
    let correlate = if structure.others.is_empty() {
        ""
    } else {
        "[[correlate]]\nparameters = [\"initial.velocity_m_s.x\", \"initial.velocity_m_s.y\"]\ncorrelation = 0.8\n"
    };
    let disperse = |axis: &str| {
        format!("[[disperse]]\nparameter = \"initial.velocity_m_s.{axis}\"\ndistribution = \"normal\"\nstd = 1\n")
    };
    let text = format!(
        "[campaign]\nname = \"structure\"\nsamples = {}\nseed = 1\nduration_s = 0.001\n[design]\nkind = \"{design}\"\n\
         [observe]\npoints = 2\n[body]\nmass_kg = 100.0\ninertia_kg_m2 = [[10.0,0,0],[0,10.0,0],[0,0,20.0]]\n\
         [initial]\nangular_velocity_rad_s = [0.0, 0.0, 0.1]\n{}{}{correlate}{require}\n\
         [summary]\ncolumns = [\"{OUTCOME}\"]\n",
        runs + 1,
        disperse("x"),
        disperse("y")
    );
    Plan::from_text("structure.toml", &text, Overrides::default()).expect("a plan")
}

const DESIGNS: [&str; 4] = ["random", "latin_hypercube", "sobol", "halton"];

/// The points of a design: for each run a number for each input.
fn points(design: &str, seed: u64, inputs: usize, runs: u64) -> Vec<Vec<f64>> {
    let names: Vec<String> = (0..inputs).map(|input| format!("x{input}")).collect();
    let mut random = Uniform::new(seed);
    let all = |of: &dyn Fn(usize, u64) -> f64| {
        (0..runs).map(|run| (0..inputs).map(|input| of(input, run)).collect()).collect()
    };
    match design {
        "random" => (0..runs).map(|_| (0..inputs).map(|_| random.uniform()).collect()).collect(),
        "latin_hypercube" => {
            let strata: Vec<_> = (0..inputs).map(|_| Permutation::new(runs, random.bits())).collect();
            let places: Vec<Vec<f64>> = all(&|input, run| strata[input].image(run) as f64);
            places
                .into_iter()
                .map(|row| row.into_iter().map(|at| (at + random.uniform()) / runs as f64).collect())
                .collect()
        }
        "sobol" => {
            let sobol = Sobol::new(seed, &names);
            all(&|input, run| sobol.number(input, run))
        }
        _ => {
            let halton = Halton::new(seed, &names);
            all(&|input, run| halton.number(input, run))
        }
    }
}

fn is_yes_or_no(y: &[f64]) -> bool {
    y.iter().all(|y| [0.0, 1.0].contains(y))
}

/// The interval of the share of `name` in a sentence, as shares.
fn interval(said: &str, name: &str) -> Option<[f64; 2]> {
    let rest = &said[said.find(&format!("{name} "))? + name.len() + 1..];
    let (value, rest) = rest.strip_prefix("explains ").unwrap_or(rest).split_once("% [")?;
    value.parse::<f64>().ok()?;
    let (low, high) = rest.split_once(']')?.0.split_once(", ")?;
    Some([low, high].map(|end| end.parse::<f64>().expect("a number") / 100.0))
}

/// The count under H0, of `all` cases with the probability `p`, that is passed with the probability [`ALPHA`] at most.
fn most(all: u64, p: f64) -> u64 {
    (0..all).find(|count| binomial::at_least(count + 1, all, p) <= ALPHA).unwrap_or(all)
}

#[derive(Default)]
struct Counts {
    /// Intervals that were said, and those that miss.
    said: [u64; 2],
    /// Campaigns in which what is no cause is named.
    wrong: u64,
    /// Campaigns in which a test sees the main cause, and those of them in which it is not first.
    seen: [u64; 2],
}

fn count(structure: &Structure, design: &str, runs: u64, campaigns: u64, seed: u64) -> Counts {
    let plan = plan(structure, design, runs);
    let columns = ["x", "y"].map(|axis| format!("initial_velocity_{axis}_m_s"));
    let inputs: Vec<String> = (0..structure.inputs)
        .map(|input| columns.get(input).cloned().unwrap_or_else(|| format!("input_{input}")))
        .collect();
    let said_names: Vec<String> = inputs.iter().map(|column| names::of_input_column(&plan, column)).collect();
    let truth = |input: usize| {
        structure.causes.iter().chain(structure.others).find(|(one, _)| *one == input).map_or(0.0, |(_, share)| *share)
    };
    let is_cause = |input: usize| structure.causes.iter().any(|(one, _)| *one == input);
    let main = structure.causes.iter().find(|(_, share)| *share > 0.5 && !structure.is_hidden);
    let mut counts = Counts::default();
    for campaign in 0..campaigns {
        let rows = points(design, seed + 7919 * campaign, structure.inputs, runs);
        let (mut values, mut y) = (vec![Vec::new(); structure.inputs], Vec::new());
        for mut row in rows {
            y.push((structure.of)(&mut row));
            values.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
        }
        let found = Prepared::new(values, None).explained(&plan, &inputs, OUTCOME, &y);
        let rankings = rankings(&found, OUTCOME, 0.05);
        let mut is_wrong = false;
        for ranking in &rankings {
            // the shares are those of the outcome; of a yes or no, and of a limit, those of the event
            let is_event = structure.limit.is_some() || is_yes_or_no(&y);
            let is_of_truth = is_event == matches!(ranking.question, Question::Event(_));
            let said = drivers_text::sentence(&plan, OUTCOME, ranking);
            // the screen names two
            let mut named = ranking
                .drivers()
                .take(2)
                .filter_map(|driver| inputs.iter().position(|name| *name == driver.input.input));
            is_wrong |= named.any(|input| !is_cause(input));
            for driver in ranking.drivers().filter(|_| is_of_truth) {
                let Some(input) = inputs.iter().position(|name| *name == driver.input.input) else { continue };
                // the share of an event is in its chart
                let of_chart =
                    || driver.share.filter(|_| driver.effect.is_some()).map(|share| [share.lower, share.upper]);
                let Some([low, high]) = interval(&said, &said_names[input]).or_else(of_chart) else { continue };
                let truth = truth(input);
                counts.said[0] += u64::from(truth.is_finite());
                counts.said[1] += u64::from(low > truth + 1e-9 || high < truth - 1e-9);
            }
            if let (true, Some((main, _))) = (is_of_truth, main) {
                let p = |input: &spindrift::analysis::drivers::Ranked<'_>| {
                    input.effect.map_or(input.input.p_value, |effect| Some(effect.p_value))
                };
                let ranked = ranking.inputs.iter().find(|one| one.input.input == inputs[*main]);
                if ranked.and_then(p).is_some_and(|p| p <= 1e-4) {
                    counts.seen[0] += 1;
                    let is_first = ranking.drivers().next().is_some_and(|first| first.input.input == inputs[*main]);
                    counts.seen[1] += u64::from(!(is_first && said.starts_with(&said_names[*main])));
                }
            }
        }
        counts.wrong += u64::from(is_wrong);
    }
    counts
}

fn hold(designs: &[&str], sizes: &[(u64, u64)]) {
    let mut broken = Vec::new();
    for (place, structure) in structures().iter().enumerate() {
        for design in designs {
            for (runs, campaigns) in sizes {
                let campaigns = if structure.inputs > 100 { campaigns.div_ceil(5) } else { *campaigns };
                let seed = 1_000_003 * place as u64 + 10_007 * runs;
                let found = count(structure, design, *runs, campaigns, seed);
                let Counts { said: [said, missed], wrong, seen: [seen, not_first] } = found;
                let line = format!(
                    "{}, {design}, {runs} runs: {said} said, {missed} miss; {wrong} of {campaigns} name no cause; \
                     {seen} seen, {not_first} not first",
                    structure.name
                );
                println!("{line}");
                if missed > most(said, 0.05) || wrong > most(campaigns, 0.05) || not_first > most(seen, 0.05) {
                    broken.push(line);
                }
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Law: intervals that are said cover, no other inputs than causes are named, and the main cause first.
#[test]
fn drivers_of_structures() {
    hold(&["random"], &[(40, 30), (100, 30), (300, 10)]);
}

#[test]
#[ignore = "minutes"]
fn drivers_of_all_structures() {
    hold(&DESIGNS, &[(30, 300), (50, 300), (64, 300), (100, 300), (300, 300), (1000, 300)]);
}
