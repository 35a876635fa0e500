//! State tables of known motions, and their observed rows.

use crate::prelude::*;

use crate::support::observed;

/// A few roundings of a state, doubled by squares, and dozens of operations. Measured: 3.5e-16.
pub const ROUNDING: f64 = 3e-15;

/// q_es, omega, wheel rates and v_c at a time.
pub type Motion<'a> = &'a dyn Fn(f64) -> ([f64; 4], [f64; 3], [f64; 2], [f64; 3]);

pub fn table1() -> (Golden, Scene) {
    let golden = Golden::load("table1");
    let scene = resolved(&golden.scene);
    (golden, scene)
}

pub fn request(groups: Groups, debris: bool, actuated: bool) -> Request {
    observed::request(groups, 2, debris, actuated, false)
}

pub fn done(points: usize, time: f64) -> Outcome {
    let effort = StepStatistics { steps: 12, rejected: 3, evaluations: 91 };
    Outcome {
        status: Status::Done,
        time,
        points,
        effort,
        local_errors: LocalErrors::default(),
        debris_errors: spindrift::run::LocalErrors::NONE,
    }
}

pub fn everything() -> StateFields {
    StateField::ALL
        .into_iter()
        .filter(|block| !matches!(block, StateField::Dcm | StateField::Residuals | StateField::KineticEnergies))
        .fold(StateFields::NONE, StateFields::with)
}

pub fn golden_table(golden: &Golden, scene: &Scene) -> (Grid, StateTable) {
    let grid = Grid::at(golden.times());
    let mut table = StateTable::new(everything(), 2, grid.points());
    for (point, truth) in golden.truth.iter().enumerate() {
        let turning = product(dcm_from_quaternion(truth.q_es), cross(truth.omega_se_s, scene.mass.center));
        table.set(StateField::Rate, point, truth.omega_se_s);
        table.set(StateField::Attitude, point, truth.q_es);
        table.set(StateField::WheelRates, point, truth.wheel_rates);
        table.set(StateField::ComVelocity, point, sum(truth.v_po_e, turning));
        table.set(StateField::DebrisVelocity, point, truth.v_gdo_e);
        table.set(StateField::DebrisAttitude, point, truth.q_ed);
        table.set(StateField::DebrisRate, point, truth.omega_de_d);
    }
    table.pad();
    (grid, table)
}

pub fn motion_table(grid: &Grid, motion: Motion<'_>) -> StateTable {
    let mut table = StateTable::new(everything(), 2, grid.points());
    for (point, time) in grid.times().iter().enumerate() {
        let (q, omega, rates, v_c) = motion(*time);
        table.set(StateField::Attitude, point, q);
        table.set(StateField::Rate, point, omega);
        table.set(StateField::WheelRates, point, rates);
        table.set(StateField::ComVelocity, point, v_c);
        table.set(StateField::DebrisAttitude, point, [1.0, 0.0, 0.0, 0.0]);
    }
    table.pad();
    table
}

pub fn row(isa: Isa, request: Request, grid: &Grid, scene: &Scene, table: &StateTable) -> HashMap<String, f64> {
    observation(isa, request, grid, scene, table).0
}

pub fn observation(
    isa: Isa,
    request: Request,
    grid: &Grid,
    scene: &Scene,
    table: &StateTable,
) -> (HashMap<String, f64>, Observer) {
    let outcome = done(grid.points(), grid.duration());
    let nominal = table.has(StateField::Attitude).then(|| NominalAttitude::of(table, &outcome));
    observed::observed(isa, request, grid, scene, (table, &outcome), nominal)
}

pub fn free_row(grid: &Grid, scene: &Scene, table: &StateTable) -> HashMap<String, f64> {
    row(Isa::best(), request(Groups::ALL, false, false), grid, scene, table)
}

#[track_caller]
pub fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found} != {expected}");
}

pub fn rotation(axis: [f64; 3], angle: f64) -> [f64; 4] {
    let s = libm::sin(0.5 * angle);
    [libm::cos(0.5 * angle), s * axis[0], s * axis[1], s * axis[2]]
}
