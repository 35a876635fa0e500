//! Errors of single arcs of the schedule do what another command would do, bit for bit, and to that arc only.

use crate::prelude::*;
use spindrift::scene::Arc;

use crate::effect::{dispersed, plan_over};

const HORIZON: f64 = 4.0;
const CASES: u64 = 40;

/// Three arcs, the second starting as the first ends, with errors of every thruster and wheel.
fn scene(seed: u64) -> SceneInput {
    let kind = Kind { wheels: [true; 2], debris: 1, products: true, offset: true, forced: true };
    let mut input = random(kind, seed, HORIZON);
    let mut u = Uniform::new(seed + 1);
    let mut last = input.actuation[1];
    (last.start_s, last.end_s) = (0.8 * HORIZON, 0.9 * HORIZON);
    input.actuation.push(last);
    input.thrusters.iter_mut().for_each(|thruster| thruster.thrust_scale = u.between(0.8, 1.2));
    for wheel in &mut input.wheels {
        (wheel.torque_scale, wheel.torque_bias_n_m) = (u.between(0.8, 1.2), u.between(-0.1, 0.1));
    }
    input
}

fn schedule(input: &SceneInput) -> Vec<Arc> {
    resolved(input).schedule
}

fn bits(arc: &Arc) -> Vec<u64> {
    let applied = &arc.applied;
    let numbers = [arc.start, applied.until].into_iter().chain(applied.thrust).chain(applied.motor_torque);
    numbers.map(f64::to_bits).collect()
}

fn all_bits(arcs: &[Arc]) -> Vec<Vec<u64>> {
    arcs.iter().map(bits).collect()
}

fn runs(scenes: &[SceneInput]) -> Vec<Run> {
    let scenes: Vec<Scene> = scenes.iter().map(resolved).collect();
    propagate(Method::Taylor, adaptive(1e-12), &Grid::uniform(HORIZON, 41), &scenes)
}

/// Law: a scale of an arc is its command multiplied; delays are the arc as much later.
#[test]
fn an_error_of_an_arc_is_another_command() {
    for seed in 0..CASES {
        let (nominal, mut u) = (scene(seed), Uniform::new(1000 + seed));
        let arc = (u.bits() % 3) as usize;
        let (thrust, torque) = (u.between(0.5, 1.5), u.between(-1.5, 1.5));
        let mut scaled = nominal.clone();
        (scaled.actuation[arc].errors.thrust_scale, scaled.actuation[arc].errors.torque_scale) = (thrust, torque);
        let mut commanded = nominal.clone();
        commanded.actuation[arc].thrust_n.iter_mut().for_each(|x| *x *= thrust);
        commanded.actuation[arc].torque_n_m.iter_mut().for_each(|x| *x *= torque);
        assert_eq!(all_bits(&schedule(&scaled)), all_bits(&schedule(&commanded)), "{seed}");
        let (on, off) = (u.between(-0.1, 0.1), u.between(-0.1, 0.1));
        let mut late = nominal.clone();
        (late.actuation[2].errors.switch_on_delay_s, late.actuation[2].errors.switch_off_delay_s) = (on, off);
        let mut moved = nominal.clone();
        (moved.actuation[2].start_s, moved.actuation[2].end_s) =
            (nominal.actuation[2].start_s + on, nominal.actuation[2].end_s + off);
        assert_eq!(all_bits(&schedule(&late)), all_bits(&schedule(&moved)), "{seed}");
        // where two meet there is one switch
        let mut one = nominal.clone();
        (one.actuation[0].errors.switch_off_delay_s, one.actuation[1].errors.switch_on_delay_s) = (7.0, on);
        let arcs = schedule(&one);
        assert_eq!((arcs[0].end(), arcs[1].start), (arcs[1].start, nominal.actuation[1].start_s + on), "{seed}");
        if seed < 4 {
            let found = runs(&[scaled, commanded, late, moved, nominal]);
            assert_eq!((found[0].bits(), found[2].bits()), (found[1].bits(), found[3].bits()), "{seed}");
            assert!(found[0].bits() != found[4].bits() && found[2].bits() != found[4].bits(), "{seed}: an effect");
        }
    }
}

/// Law: the same errors of all arcs are those of all thrusters, wheels and delays; of all arcs but one they are not.
#[test]
fn the_same_error_of_all_arcs_is_that_of_the_actuators() {
    for seed in 0..CASES {
        let (mut of_arcs, mut u) = (scene(seed), Uniform::new(2000 + seed));
        of_arcs.thrusters.iter_mut().for_each(|thruster| thruster.thrust_scale = 1.0);
        of_arcs.wheels.iter_mut().for_each(|wheel| wheel.torque_scale = 1.0);
        let mut of_all = of_arcs.clone();
        let (thrust, torque, delay) = (u.between(0.5, 1.5), u.between(0.5, 1.5), u.between(0.0, 0.1));
        for arc in &mut of_arcs.actuation {
            (arc.errors.thrust_scale, arc.errors.torque_scale) = (thrust, torque);
            (arc.errors.switch_on_delay_s, arc.errors.switch_off_delay_s) = (delay, 2.0 * delay);
        }
        of_all.thrusters.iter_mut().for_each(|thruster| thruster.thrust_scale = thrust);
        of_all.wheels.iter_mut().for_each(|wheel| wheel.torque_scale = torque);
        (of_all.actuators.switch_on_delay_s, of_all.actuators.switch_off_delay_s) = (delay, 2.0 * delay);
        assert_eq!(all_bits(&schedule(&of_arcs)), all_bits(&schedule(&of_all)), "{seed}");
        of_arcs.actuation[1].errors.thrust_scale = 1.0;
        assert_ne!(all_bits(&schedule(&of_arcs)), all_bits(&schedule(&of_all)), "{seed}");
    }
}

/// Law: an error of an arc changes no other arc, and the motion only after its start.
#[test]
fn an_error_changes_its_arc_only() {
    for (k, (key, value)) in
        [("thrust_scale", 1.1), ("torque_scale", 0.9), ("switch_on_delay_s", 0.05)].iter().enumerate()
    {
        let nominal = scene(k as u64);
        let changed = nominal.clone().with(&format!("actuation.2.{key}"), &[*value]);
        let (before, after) = (schedule(&nominal), schedule(&changed));
        assert_eq!(all_bits(&before[..2]), all_bits(&after[..2]), "{key}");
        assert_ne!(bits(&before[2]), bits(&after[2]), "{key}");
        let grid = Grid::uniform(HORIZON, 41);
        let found = runs(&[nominal.clone(), changed]);
        let mut seen = [0, 0];
        for (point, time) in grid.times().iter().enumerate() {
            let at = |run: &Run| -> Vec<u64> {
                let column = |component| run.table.column(StateField::Rate, component)[point].to_bits();
                (0..3).map(column).collect()
            };
            let is_same = at(&found[0]) == at(&found[1]);
            if *time <= nominal.actuation[2].start_s {
                assert!(is_same, "{key} at {time}");
                seen[0] += 1;
            } else if *time > nominal.actuation[2].start_s + 0.1 {
                assert!(!is_same, "{key} at {time}");
                seen[1] += 1;
            }
        }
        assert!(seen[0] > 20 && seen[1] > 3, "{seen:?}");
    }
}

/// Thrust, an arc that meets it with a torque, one that does nothing, one with a name, one after the end.
const ARCS: &str = "[[actuation]]\nstart_s = 0.0\nend_s = 1.0\nthrust_n = { p1 = 10 }\n\
    [[actuation]]\nstart_s = 1.0\nend_s = 2.0\ntorque_n_m = { w1 = 1 }\n\
    [[actuation]]\nstart_s = 3.0\nend_s = 4.0\n\
    [[actuation]]\nname = \"trim\"\nstart_s = 4.5\nend_s = 5.0\nthrust_n = { p2 = 5, p3 = 5 }\ntorque_n_m = { w1 = -1 \
    }\n\
    [[actuation]]\nname = \"late\"\nstart_s = 6.0\nend_s = 7.0\nthrust_n = { p1 = 10 }\n";

fn plan(text: &str) -> Result<Plan, String> {
    plan_over(6.0, text)
}

/// Law: names and errors read back, and are not in a plan without them; what is recorded is applied.
#[test]
fn errors_are_drawn_recorded_and_written() {
    let ideal = plan(ARCS).unwrap();
    assert!(!ideal.text().contains("torque_scale = 1.0\nswitch_on"), "{}", ideal.text());
    let text = format!(
        "{}{}{}[[derive]]\nparameter = \"actuation.trim.switch_off_delay_s\"\nexpression = \
        \"actuation.trim.switch_on_delay_s\"\n",
        ARCS.replace("end_s = 1.0\n", "end_s = 1.0\nthrust_scale = 0.98\n"),
        dispersed("actuation.0.thrust_scale"),
        dispersed("actuation.trim.switch_on_delay_s"),
    );
    let plan = plan(&text).unwrap();
    let again = planned(&plan.text());
    assert_eq!((&again, again.text()), (&plan, plan.text()));
    assert_ne!(plan.hash(), ideal.hash());
    let columns = plan.dispersions.columns();
    let names: Vec<String> = columns.iter().map(|column| column.parameter.column_name(column.component)).collect();
    let expected =
        ["actuation_0_thrust_scale", "actuation_trim_switch_on_delay_s", "actuation_trim_switch_off_delay_s"];
    assert_eq!(names, expected);
    assert_eq!(columns[0].nominal, 0.98);
    let mut draws = SceneDraws::new(&plan);
    for sample in 1..plan.samples {
        let arcs = draws.scene(SampleId(sample)).unwrap().schedule;
        let applied = draws.applied();
        assert!(applied[0] != 0.98 && applied[1] == applied[2] && applied[1] != 0.0);
        assert_eq!(arcs[0].applied.thrust[0], applied[0] * 10.0);
        assert_eq!((arcs[3].start, arcs[3].end()), (4.5 + applied[1], 5.0 + applied[1]));
        assert_eq!((arcs[0].start, arcs[1].start, arcs[4].applied.thrust[0]), (0.0, 1.0, 10.0));
    }
}
