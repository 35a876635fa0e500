//! Tests of the rankings on runs whose causes are known.

use crate::prelude::*;
use spindrift::{
    Plan,
    analysis::{
        drivers::{Question, rankings},
        effects::{Dependence, Direction, TestedInput, on_event, on_spread},
        event::{Event, Occurs},
        input_sensitivity::InputSensitivity,
        observed::Observed,
        sensitivity::Prepared,
    },
    statistics::{contingency::Occurrence, correlation::ascending_order},
};

const ALPHA: f64 = 0.05;
const MISSED: Occurs = Occurs::Missed { requirement: 0, is_only: true };

fn small_plan(line: &str) -> Plan {
    let disperse = |axis: &str| {
        let parameter = format!("initial.angular_velocity_rad_s.{axis}");
        format!("[[disperse]]\nparameter = \"{parameter}\"\ndistribution = \"normal\"\nstd = 0.05\n")
    };
    let text = format!(
        "{line}\ninitial = {{ angular_velocity_rad_s = [0.0, 0.1, 0.5] }}\nobserve = {{ points = 11 }}\n[campaign]\n\
         name = \"small\"\nseed = 1\nduration_s = 1.0\nsamples = 7\n[body]\nmass_kg = 500.0\n\
         inertia_kg_m2 = [[120.0, 0.0, 0.0], [0.0, 150.0, 0.0], [0.0, 0.0, 90.0]]\n{}{}",
        disperse("x"),
        disperse("y")
    );
    planned(&text)
}

fn plan(has_limit: bool) -> (Plan, String) {
    let name = Observed::all(&small_plan(""))[0].quantity.name().to_owned();
    let limit = format!("require = [{{ observable = \"{name}\", at_most = 1.0, fraction = 0.95 }}]");
    (small_plan(if has_limit { &limit } else { "" }), name)
}

fn explained(inputs: &[Vec<f64>], y: &[f64], has_limit: bool) -> (Vec<InputSensitivity>, String) {
    let (plan, name) = plan(has_limit);
    let names: Vec<String> = (0..inputs.len()).map(|input| format!("x{input}")).collect();
    (Prepared::new((&plan, &names), inputs.to_vec(), None).explained(&name, y), name)
}

fn drivers(inputs: &[Vec<f64>], y: &[f64], has_limit: bool) -> [Option<Vec<String>>; 2] {
    let (all, name) = explained(inputs, y, has_limit);
    let rankings = rankings(&all, &name, ALPHA);
    [true, false].map(|is_event| {
        let ranking = rankings.iter().find(|one| matches!(one.question, Question::Event(_)) == is_event)?;
        Some(ranking.drivers().map(|ranked| ranked.input.input.clone()).collect())
    })
}

fn inputs(random: &mut Uniform) -> Vec<Vec<f64>> {
    let mut inputs: Vec<Vec<f64>> = (0..4).map(|_| (0..1000).map(|_| random.uniform()).collect()).collect();
    inputs.extend((0..2).map(|_| (0..1000).map(|_| f64::from(random.uniform() > 0.014)).collect::<Vec<f64>>()));
    inputs
}

#[test]
fn causes_are_named() {
    type Case =
        (&'static str, fn(&[f64], f64) -> f64, bool, Option<&'static [&'static str]>, Option<&'static [&'static str]>);
    let cases: [Case; 11] = [
        (
            "a rare yes or no decides a 0/1 outcome",
            |x, e| f64::from(x[4] > 0.5 && e > 0.002),
            false,
            Some(&["x4"]),
            None,
        ),
        ("two of them", |x, e| f64::from(x[4] * x[5] > 0.5 && e > 0.002), false, Some(&["x4", "x5"]), None),
        ("no cause of a rare failure", |_, e| f64::from(e > 0.016), false, Some(&[]), None),
        ("a number decides a rare failure", |x, e| f64::from(x[1] < 0.97 || e < 0.5), false, Some(&["x1"]), None),
        ("both ends of a number do", |x, _| f64::from((x[1] - 0.5).abs() < 0.49), false, Some(&["x1"]), None),
        ("one number", |x, e| x[2] + 0.2 * e, false, None, Some(&["x2"])),
        ("a V", |x, e| (x[3] - 0.5).abs() + 0.1 * e, false, None, Some(&["x3"])),
        ("noise", |_, e| e, false, None, Some(&[])),
        ("a product of numbers about zero", |x, _| (x[0] - 0.5) * (x[1] - 0.5), false, Some(&["x0", "x1"]), Some(&[])),
        (
            "the limit is missed where a part is dead",
            |x, e| e + 2.0 * x[0] * (1.0 - x[4]) + 0.3 * (1.0 - x[4]) - 0.1,
            true,
            Some(&["x4"]),
            Some(&["x4"]),
        ),
        (
            "only the tail is of a dead part",
            |x, e| x[0] + 0.1 * e + 0.7 * (1.0 - x[5]) * f64::from(x[1] > 0.3),
            false,
            Some(&["x0", "x5"]),
            Some(&["x0"]),
        ),
    ];
    let mut random = Uniform::new(3);
    let inputs = inputs(&mut random);
    for (what, of, has_limit, event, spread) in cases {
        let row = |row: usize| inputs.iter().map(|input| input[row]).collect::<Vec<f64>>();
        let y: Vec<f64> = (0..1000).map(|at| of(&row(at), random.uniform())).collect();
        let [mut on_event, on_spread] = drivers(&inputs, &y, has_limit);
        on_event.iter_mut().for_each(|names| names.sort());
        let listed =
            |names: Option<&[&str]>| names.map(|names| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>());
        assert_eq!((on_event, on_spread), (listed(event), listed(spread)), "{what}");
    }
}

#[test]
fn levels_are_counts() {
    let mut random = Uniform::new(8);
    let inputs = inputs(&mut random);
    let y: Vec<f64> = inputs[5].iter().map(|x| f64::from(*x > 0.5 && random.uniform() > 0.002)).collect();
    let (all, name) = explained(&inputs, &y, false);
    let ranking = rankings(&all, &name, ALPHA).remove(0);
    let first = ranking.inputs[0].input;
    let effect = first.on_events.first().unwrap();
    let Dependence::Levels { levels, most, ratio } = &effect.dependence else { panic!("{effect:?}") };
    let count = |value: f64, failed: bool| {
        (0..1000).filter(|row| inputs[5][*row] == value && (!failed || y[*row] == 0.0)).count() as u64
    };
    for (level, value) in levels.iter().zip([0.0, 1.0]) {
        assert_eq!(
            (level.value, level.of.events, level.of.runs),
            (Some(value), count(value, true), count(value, false))
        );
    }
    assert_eq!((first.input.as_str(), *most), ("x5", 0));
    let share = |value: f64| count(value, true) as f64 / count(value, false) as f64;
    assert!((ratio.value * share(1.0) / share(0.0) - 1.0).abs() < 1e-12 && ratio.lower > 10.0, "{ratio:?}");
}

#[test]
fn few_values_have_a_share_and_a_direction() {
    let mut random = Uniform::new(21);
    let levels: Vec<f64> = (0..1200).map(|_| (3.0 * random.uniform()).floor() - 1.0).collect();
    let smooth: Vec<f64> = (0..1200).map(|_| 2.0 * random.uniform() - 1.0).collect();
    for (of, share, direction) in [
        ((|x| x) as fn(f64) -> f64, (2.0 / 3.0) / (2.0 / 3.0 + 1.0 / 12.0), Direction::Rises),
        (|x| -x, (2.0 / 3.0) / (2.0 / 3.0 + 1.0 / 12.0), Direction::Falls),
        (|x| x * x, (2.0 / 9.0) / (2.0 / 9.0 + 1.0 / 12.0), Direction::NotMonotonic),
    ] {
        for (x, share) in [(&levels, Some(share)), (&smooth, None)] {
            let y: Vec<f64> = x.iter().map(|x| of(*x) + random.uniform()).collect();
            let (all, name) = explained(&[smooth.iter().rev().copied().collect(), x.clone()], &y, false);
            let rankings = rankings(&all, &name, ALPHA);
            let spread = rankings.last().unwrap();
            let names: Vec<&str> = spread.drivers().map(|ranked| ranked.input.input.as_str()).collect();
            assert_eq!(names, ["x1"]);
            let first = &spread.inputs[0];
            assert_eq!(first.input.direction, Some(direction));
            // four standard errors of 0.01
            let found = first.share.unwrap();
            assert!(share.is_none_or(|share| (found.value - share).abs() < 0.04), "{found:?} {share:?}");
        }
    }
}

#[test]
fn limits_that_all_meet_have_no_causes() {
    let mut random = Uniform::new(4);
    let inputs = inputs(&mut random);
    let y: Vec<f64> = inputs[0].iter().map(|x| 0.5 * x + 0.01 * random.uniform()).collect();
    assert_eq!(drivers(&inputs, &y, true), [None, Some(vec!["x0".to_owned()])]);
    let few: Vec<Vec<f64>> = inputs.iter().map(|input| input[..70].to_vec()).collect();
    let noise: Vec<f64> = (0..70).map(|_| random.uniform()).collect();
    assert_eq!(drivers(&few, &noise, false), [None, Some(Vec::new())]);
}

#[test]
fn effects_on_an_event_are_seldom_false() {
    const CASES: usize = 2000;
    const ROWS: usize = 150;
    let draw = |kind: usize, u: f64| match kind {
        0..=2 => (u * [2.0, 3.0, 5.0][kind]).floor(),
        3 => (u - 0.7).max(0.0),
        _ => u,
    };
    let mut random = Uniform::new(11);
    for kind in 0..5 {
        let mut found = 0;
        for _ in 0..CASES {
            let values: Vec<f64> = (0..ROWS).map(|_| draw(kind, random.uniform())).collect();
            let marked: Vec<bool> = (0..ROWS).map(|_| random.uniform() < 0.2).collect();
            let events = marked.iter().filter(|is_marked| **is_marked).count() as u64;
            let of = Occurrence { events, runs: ROWS as u64 };
            let event = Event { occurs: MISSED, of, has_few_values: false };
            let inputs = [TestedInput::new(&values, &ascending_order(&values))];
            let share = |_| None;
            let effects = on_event(&inputs, (event, &marked), share, 1, 0.95);
            found += usize::from(effects[0].as_ref().is_some_and(|effect| effect.p_value <= ALPHA));
        }
        let most = CASES as f64 * ALPHA + 6.0 * (CASES as f64 * ALPHA * (1.0 - ALPHA)).sqrt();
        assert!(found as f64 <= most, "kind {kind}: {found} of {CASES}");
        assert!(found > CASES / 200, "kind {kind}: {found} of {CASES}: a test that never finds anything is none");
    }
}

/// Law: a shift is the medians of the runs with and without the event, and the chance that an input with it is larger.
#[test]
fn shifts_are_medians_and_chances() {
    let mut random = Uniform::new(5);
    let values: Vec<f64> = (0..301).map(|_| random.uniform()).collect();
    for is_large in [true, false] {
        let marked: Vec<bool> =
            values.iter().map(|x| random.uniform() < 0.1 + 0.6 * if is_large { *x } else { 1.0 - x }).collect();
        let events = marked.iter().filter(|is_marked| **is_marked).count() as u64;
        let of = Occurrence { events, runs: 301 };
        let event = Event { occurs: MISSED, of, has_few_values: false };
        let share = |_| None;
        let inputs = [TestedInput::new(&values, &ascending_order(&values))];
        let effects = on_event(&inputs, (event, &marked), share, 1, 0.95);
        let found = &effects[0].as_ref().unwrap().dependence;
        let Dependence::Shift { chance, medians } = found else { panic!("{found:?}") };
        let of = |wanted: bool| {
            let mut of: Vec<f64> =
                values.iter().zip(&marked).filter(|(_, is)| **is == wanted).map(|(x, _)| *x).collect();
            of.sort_by(f64::total_cmp);
            of
        };
        let [with, without] = [of(true), of(false)];
        let median = |of: &[f64]| 0.5 * (of[(of.len() - 1) / 2] + of[of.len() / 2]);
        assert_eq!(*medians, [median(&with), median(&without)]);
        let wins = with.iter().map(|a| without.iter().filter(|b| a > b).count()).sum::<usize>();
        let expected = wins as f64 / (with.len() * without.len()) as f64;
        assert!((chance - expected).abs() < 1e-12 && (*chance > 0.6) == is_large, "{chance} {expected}");
    }
}

/// Law: one p-value of several questions is that of one times their number (C. Bonferroni, 1936).
#[test]
fn questions_are_counted() {
    let mut random = Uniform::new(6);
    let values: Vec<f64> = (0..200).map(|_| random.uniform()).collect();
    let y: Vec<f64> = values.iter().map(|x| 0.25 * x + random.uniform()).collect();
    let marked: Vec<bool> = y.iter().map(|y| *y > 0.9).collect();
    let of = Occurrence { events: marked.iter().filter(|is_marked| **is_marked).count() as u64, runs: 200 };
    let event = Event { occurs: MISSED, of, has_few_values: false };
    let share = |_| None;
    let inputs = [TestedInput::new(&values, &ascending_order(&values))];
    let found = |asked: usize| {
        let of_event = on_event(&inputs, (event, &marked), share, asked, 0.95)[0].as_ref().unwrap().p_value;
        [of_event, on_spread(&inputs, &y, asked)[0].unwrap()]
    };
    let one = found(1);
    assert!(one.iter().all(|p| *p > 0.0 && *p < 0.1), "{one:?}");
    for asked in [2, 9, 1000] {
        for (of_many, of_one) in found(asked).into_iter().zip(one) {
            assert!((of_many - (asked as f64 * of_one).min(1.0)).abs() < 1e-15, "{asked}: {of_many} {of_one}");
        }
    }
}

#[test]
fn events_are_the_violations_of_requirements() {
    let name = Observed::all(&small_plan(""))[0].quantity.name().to_owned();
    let limit = |words: &str| format!("{{ observable = \"{name}\", {words} }}");
    let list = [
        limit("at_most = 0.75, fraction = 0.5"),
        limit("at_least = 0.2, fraction = 0.5"),
        limit("at_least = 0.2, fraction = 0.9, never = \"meets\""),
        limit("at_least = 0.2, quantile = 0.5"),
        limit("at_most = 0.5, mean = true"),
    ];
    let plan = small_plan(&format!("require = [{}]", list.join(", ")));
    let mut random = Uniform::new(4);
    let y: Vec<f64> = (0..300).map(|_| random.uniform()).map(|y| if y < 0.1 { f64::NAN } else { y }).collect();
    let is_missed: [fn(f64) -> bool; 3] =
        [|y| y.is_nan() || y > 0.75, |y| y.is_nan() || y < 0.2, |y| !y.is_nan() && y < 0.2];
    for is_ok in [vec![true; 300], (0..300).map(|row| row % 7 != 0).collect()] {
        let found = Event::missed(&plan, &name, &y, &is_ok);
        assert_eq!(found.len(), 3);
        for (place, ((event, marked), is_missed)) in found.into_iter().zip(is_missed).enumerate() {
            assert_eq!(event.occurs, Occurs::Missed { requirement: place, is_only: false });
            let expected: Vec<bool> = y.iter().zip(&is_ok).map(|(y, is_ok)| !is_ok || is_missed(*y)).collect();
            assert_eq!((event.of.events as usize, marked), (expected.iter().filter(|is| **is).count(), expected));
        }
    }
    let one = small_plan(&format!("require = [{}]", list[2]));
    assert_eq!(Event::missed(&one, &name, &y, &[true; 300])[0].0.occurs, MISSED);
}

/// Law: where no limit is missed, the worst runs are the twentieth nearest to it.
#[test]
fn the_worst_runs_are_on_the_side_of_the_limit() {
    let name = Observed::all(&small_plan(""))[0].quantity.name().to_owned();
    let mut random = Uniform::new(9);
    let y: Vec<f64> = (0..400).map(|_| random.uniform()).collect();
    let mut sorted = y.clone();
    sorted.sort_by(f64::total_cmp);
    for (words, is_worst) in [
        ("at_most = 5.0", (|y, sorted| y >= sorted[380]) as fn(f64, &[f64]) -> bool),
        ("at_least = -5.0", |y, sorted| y <= sorted[19]),
    ] {
        let plan = small_plan(&format!("require = [{{ observable = \"{name}\", {words}, fraction = 0.95 }}]"));
        let (event, marked) = Event::of_values(&plan, &name, &y).remove(0);
        assert!(matches!(event.occurs, Occurs::Worst(share) if (share - 0.05).abs() < 1e-12), "{event:?}");
        assert!(y.iter().zip(marked).all(|(y, is_marked)| is_worst(*y, &sorted) == is_marked), "{words}");
    }
}
