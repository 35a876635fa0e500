//! The absence of a group changes no bit of the others.

use crate::support::{
    prelude::*,
    runs::{Bits, control_of},
    scenes::WHEELS,
};
use rayon::prelude::*;

const HORIZON: f64 = 6.0;

fn requests(method: Method) -> Vec<StateFields> {
    use StateField::*;
    let spin = [Rate, WheelRates];
    let mut list = vec![
        blocks([Rate]),
        blocks(spin),
        blocks([Rate, Attitude]),
        blocks([Rate, Attitude, WheelRates, WheelAngles]),
        blocks([Rate, WheelAngles]),
        blocks([Rate, WheelRates, Work]),
        blocks([Attitude, ComVelocity]),
        blocks([Rate, ComPosition, Impulse]),
        blocks([DebrisAttitude, DebrisRate]),
        blocks([DebrisPosition, AngularImpulse]),
    ];
    if method == Method::NullSpace {
        list.push(blocks([Dcm, Residuals, KineticEnergies]));
    }
    list
}

fn skipping_changes_nothing(method: Method) {
    let grid = Grid::uniform(HORIZON, 29);
    for forced in [false, true] {
        let scenes = mixed(13, forced, HORIZON);
        let run = |blocks: StateFields| {
            let plan = PropagationSettings::new(method, control_of(method), grid.clone(), blocks, &scenes[0]);
            propagate_on(Isa::best(), &plan, &scenes)
        };
        let whole = run(everything(method));
        for request in requests(method) {
            for (scene, (found, whole)) in run(request).iter().zip(&whole).enumerate() {
                let names: Vec<StateField> =
                    StateField::ALL.into_iter().filter(|block| request.contains(*block)).collect();
                let same = found.bits() == whole.bits_of(request);
                assert!(same, "{}, forced {forced}, scene {scene}: {names:?}", method.name());
            }
        }
    }
}

#[test]
fn what_is_not_requested_changes_nothing() {
    Method::ALL.par_iter().for_each(|method| skipping_changes_nothing(*method));
}

#[test]
fn less_is_integrated() {
    let free = &mixed(1, false, HORIZON)[0];
    let forced = &mixed(1, true, HORIZON)[0];
    let components = |scene: &Scene, list: &[StateField]| {
        let blocks = blocks(list.iter().copied());
        PropagationSettings::new(Method::Auto, adaptive(1e-12), Grid::uniform(HORIZON, 3), blocks, scene).components()
    };
    use StateField::*;
    assert_eq!(components(free, &[Rate, WheelRates]), 3);
    assert_eq!(components(free, &[Rate, Attitude, ComVelocity, DebrisAttitude, Work]), 7);
    assert_eq!(components(free, &[Rate, WheelAngles]), 10);
    assert_eq!(components(forced, &[Rate, WheelRates]), 3);
    assert_eq!(components(forced, &[Rate, Work]), 21);
}

#[test]
fn debris_changes_nothing_of_the_spacecraft() {
    use StateField::*;
    let list =
        blocks([Rate, Attitude, WheelRates, WheelAngles, ComPosition, ComVelocity, Work, Impulse, AngularImpulse]);
    let grid = Grid::uniform(HORIZON, 29);
    for forced in [false, true] {
        let with = mixed(13, forced, HORIZON);
        let mut without = with.clone();
        for scene in &mut without {
            scene.mass.debris = None;
        }
        for method in [Method::Auto, Method::Taylor, DORMAND_PRINCE] {
            let states = |scenes: &[Scene]| -> Vec<Bits> {
                let plan =
                    PropagationSettings::new(method, control_of(method), grid.clone(), everything(method), &scenes[0]);
                propagate_on(Isa::best(), &plan, scenes).iter().map(|run| run.bits_of(list)).collect()
            };
            assert!(states(&with) == states(&without), "{}, forced {forced}", method.name());
        }
    }
}

#[test]
fn groups_do_not_reach_each_other() {
    let grid = Grid::uniform(HORIZON, 29);
    for (forced, method) in
        [(false, Method::Auto), (true, Method::Auto), (true, Method::Taylor), (true, DORMAND_PRINCE)]
    {
        let scenes = mixed(13, forced, HORIZON);
        let rows = |groups: Groups| {
            let request = request(groups, WHEELS.len(), true, forced, false);
            let plan = PropagationSettings::new(method, control_of(method), grid.clone(), request.fields(), &scenes[0]);
            let mut observer = Observer::new(request, &grid);
            let names: Vec<String> = request.columns().iter().map(|column| column.quantity.name().to_owned()).collect();
            let mut rows = vec![vec![0.0; names.len()]; scenes.len()];
            plan.engine(Isa::best()).propagate(&scenes, &mut |CompletedRun { index, table, outcome, .. }| {
                observer.observe(Isa::best(), &scenes[index], table, outcome, &mut rows[index]);
            });
            let bits = rows.iter().map(|row| row.iter().map(|x| x.to_bits()).collect()).collect();
            (names, bits)
        };
        let (all_names, all): (Vec<String>, Vec<Bits>) = rows(Groups::ALL);
        for group in Group::ALL {
            let (names, some): (Vec<String>, Vec<Bits>) = rows(Groups::NONE.with(group));
            for (row, whole) in some.iter().zip(&all) {
                for (name, value) in names.iter().zip(row) {
                    let at = all_names.iter().position(|other| other == name).unwrap();
                    assert_eq!(*value, whole[at], "{}: {name} of {}", method.name(), group.name());
                }
            }
        }
    }
}
