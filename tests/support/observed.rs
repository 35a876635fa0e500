//! Runs as an observer sees them.

use super::prelude::*;
use spindrift::observables::{
    LawColumns,
    request::{NutationAxis, wheel_names},
    window::NO_WINDOWS,
};

const NAMES: [&str; 8] = ["w1", "w2", "w3", "w4", "w5", "w6", "w7", "w8"];

pub fn request(groups: Groups, wheels: usize, debris: bool, actuated: bool, constrained: bool) -> Request {
    let actuated = if actuated { Actuated::ALL } else { Actuated::NONE };
    Request {
        groups,
        debris,
        actuated,
        effects: spindrift::dynamics::effects::ForceModel::NONE,
        constrained,
        wheels: wheel_names(&NAMES[..wheels]),
        nutation_axis: NutationAxis::SpinAxis,
        of_law: LawColumns::NONE,
        windows: NO_WINDOWS,
    }
}

pub fn observed(
    isa: Isa,
    request: Request,
    grid: &Grid,
    scene: &Scene,
    (table, outcome): (&StateTable, &Outcome),
    nominal: Option<NominalAttitude>,
) -> (HashMap<String, f64>, Observer) {
    let mut observer = Observer::new(request, grid).with_nominal(nominal);
    let mut row = vec![0.0; request.columns().len()];
    observer.observe(isa, scene, table, outcome, &mut row);
    let names = request.columns().iter().map(|column| column.quantity.name().to_owned()).collect::<Vec<_>>();
    (names.into_iter().zip(row).collect(), observer)
}
