//! Runs through [`PropagationSettings`], as in a campaign, and the distances that the tests compare.

use super::prelude::*;

#[derive(Clone, Debug)]
pub struct Run {
    pub table: StateTable,
    pub outcome: Outcome,
}

/// Outcome, then the table column by column.
pub type Bits = Vec<u64>;

impl Run {
    pub fn bits(&self) -> Bits {
        self.bits_of(self.table.fields())
    }

    pub fn bits_of(&self, blocks: StateFields) -> Bits {
        let mut bits = self.outcome_bits();
        for block in StateField::ALL.into_iter().filter(|block| blocks.contains(*block)) {
            for component in 0..self.table.width(block) {
                bits.extend(self.column_bits(block, component));
            }
        }
        bits
    }

    pub fn outcome_bits(&self) -> Bits {
        let Outcome { status, time, points, effort, .. } = self.outcome;
        vec![status as u64, time.to_bits(), points as u64, effort.steps, effort.rejected, effort.evaluations]
    }

    pub fn column_bits(&self, block: StateField, component: usize) -> impl Iterator<Item = u64> {
        self.table.column(block, component)[..self.table.points()].iter().map(|x| x.to_bits())
    }
}

pub fn hash(bits: impl IntoIterator<Item = u64>) -> String {
    let mut digest = Sha256::new();
    for word in bits {
        digest.update(word.to_le_bytes());
    }
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

pub fn blocks(list: impl IntoIterator<Item = StateField>) -> StateFields {
    list.into_iter().fold(StateFields::NONE, StateFields::with)
}

pub const DORMAND_PRINCE: Method = Method::Gyrostat(Integrator::DormandPrince);
pub const DOP853: Method = Method::Gyrostat(Integrator::Dop853);
pub const RUNGE_KUTTA: Method = Method::Gyrostat(Integrator::RungeKutta4);
pub const GAUSS_LEGENDRE: Method = Method::Gyrostat(Integrator::GaussLegendre);

/// All blocks that `method` can fill.
pub fn everything(method: Method) -> StateFields {
    let constrained =
        |block: &StateField| matches!(block, StateField::Dcm | StateField::Residuals | StateField::KineticEnergies);
    blocks(StateField::ALL.into_iter().filter(|block| method == Method::NullSpace || !constrained(block)))
}

pub const fn adaptive(tolerance: f64) -> Control {
    Control { tolerance: Tolerance { relative: tolerance, absolute: tolerance }, step: None, max_steps: 10_000_000 }
}

pub const fn fixed(step: f64) -> Control {
    Control { step: Some(step), ..adaptive(1e-10) }
}

pub const METHODS: [(Method, Control); 7] = [
    (Method::Auto, adaptive(1e-12)),
    (Method::Taylor, adaptive(1e-12)),
    (DORMAND_PRINCE, adaptive(1e-8)),
    (DOP853, adaptive(1e-8)),
    (RUNGE_KUTTA, fixed(0.01)),
    (GAUSS_LEGENDRE, fixed(0.01)),
    (Method::NullSpace, adaptive(1e-5)),
];

pub fn control_of(method: Method) -> Control {
    METHODS.into_iter().find(|(known, _)| *known == method).unwrap().1
}

pub fn propagate_on(isa: Isa, plan: &PropagationSettings, scenes: &[Scene]) -> Vec<Run> {
    let mut runs: Vec<Option<Run>> = vec![None; scenes.len()];
    plan.engine(isa).propagate(scenes, &mut |CompletedRun { index, table, outcome, .. }| {
        let before = runs[index].replace(Run { table: table.clone(), outcome: *outcome });
        assert!(before.is_none(), "run {index} was completed twice");
    });
    runs.into_iter().map(|run| run.unwrap()).collect()
}

pub fn propagate(method: Method, control: Control, grid: &Grid, scenes: &[Scene]) -> Vec<Run> {
    let plan = PropagationSettings::new(method, control, grid.clone(), everything(method), &scenes[0]);
    propagate_on(Isa::best(), &plan, scenes)
}

pub fn propagate_one(method: Method, control: Control, grid: &Grid, scene: &Scene) -> Run {
    propagate(method, control, grid, std::slice::from_ref(scene)).remove(0)
}

pub fn rotational() -> StateFields {
    blocks([StateField::Rate, StateField::Attitude])
}

/// One run to its end.
pub fn done(method: Method, control: Control, grid: &Grid, fields: StateFields, scene: &Scene) -> Run {
    let plan = PropagationSettings::new(method, control, grid.clone(), fields, scene);
    let run = propagate_on(Isa::best(), &plan, std::slice::from_ref(scene)).remove(0);
    assert_eq!(run.outcome.status, Status::Done, "{method:?}");
    run
}

pub fn relative<const N: usize>(found: [f64; N], expected: [f64; N]) -> f64 {
    relative_of(&found, &expected)
}

pub fn relative_field(found: &StateTable, expected: &StateTable, field: StateField, point: usize) -> f64 {
    let at = |table: &StateTable| -> Vec<f64> {
        (0..table.width(field)).map(|component| table.column(field, component)[point]).collect()
    };
    relative_of(&at(found), &at(expected))
}

fn relative_of(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len(), "vectors of the same space");
    let mut off = 0.0;
    let mut size = 0.0;
    for (a, b) in found.iter().zip(expected) {
        off += (a - b) * (a - b);
        size += b * b;
    }
    let error = off.sqrt() / size.sqrt().max(1.0);
    if error.is_nan() { f64::INFINITY } else { error }
}

pub fn up_to_sign(found: [f64; 4], expected: [f64; 4]) -> f64 {
    relative(found, expected).min(relative(found, expected.map(|x| -x)))
}

pub fn base_point(scene: &Scene, table: &StateTable, point: usize) -> [[f64; 3]; 2] {
    let c_es = dcm_from_quaternion(table.at::<4>(StateField::Attitude, point));
    let center = scene.mass.center;
    let spin = cross(table.at::<3>(StateField::Rate, point), center);
    [
        difference(table.at(StateField::ComPosition, point), product(c_es, center)),
        difference(table.at(StateField::ComVelocity, point), product(c_es, spin)),
    ]
}

pub fn rotation_distance(found: &StateTable, expected: &StateTable) -> [f64; 2] {
    let points = 0..expected.points();
    let size = points.clone().map(|point| norm(expected.at::<3>(StateField::Rate, point))).fold(0.0, f64::max);
    let mut worst = [0.0_f64; 2];
    for point in points {
        let off = norm(difference(found.at::<3>(StateField::Rate, point), expected.at::<3>(StateField::Rate, point)));
        let off = if size > 0.0 { off / size } else { off };
        let turned = up_to_sign(found.at(StateField::Attitude, point), expected.at(StateField::Attitude, point));
        worst = [worst[0].max(if off.is_nan() { f64::INFINITY } else { off }), worst[1].max(turned)];
    }
    worst
}
