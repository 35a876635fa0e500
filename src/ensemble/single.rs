//! [`SingleRun`]: one sample of a campaign with all its states, as `simulate` shows it.
//!
//! The scene is drawn and propagated by the code that runs campaigns, so that the states are those behind the row.

use crate::campaign::{Plan, draw};
use crate::ensemble::settings::{nominal_attitude, propagator, request};
use crate::math::Isa;
use crate::observables::{Group, Observer, Request, Series};
use crate::propagation::CompletedRun;
use crate::run::Outcome;
use crate::run::{Grid, StateField, StateFields, StateTable};
use crate::sampling::SampleId;
use crate::scene::{Scene, SceneError};

/// The groups whose series a time series shows.
const GROUPS: [Group; 5] =
    [Group::EnergyConservation, Group::MomentumConservation, Group::Attitude, Group::Constraints, Group::Energies];

/// One run with its states.
#[derive(Clone, Debug)]
pub struct SingleRun {
    /// The scene that was run.
    pub scene: Scene,
    /// The times of the table's points; the first is zero, whether it was asked for or not.
    pub grid: Grid,
    /// The states.
    pub table: StateTable,
    /// How the run ended.
    pub outcome: Outcome,
    /// Why it is not `ok`; empty where it is.
    pub reason: String,
    /// Energies and conservation errors at the points that were reached.
    pub series: Vec<(Series, Vec<f64>)>,
    /// The row of the sample, as a campaign on this grid has it, with the columns of [`SingleRun::request`].
    pub row: Vec<f64>,
    /// What the row holds.
    pub request: Request,
}

impl SingleRun {
    /// Runs sample `sample` of `plan`, observed at the times of `grid` (which may reach beyond the campaign's duration).
    ///
    /// # Errors
    /// Why the drawn scene is not physical.
    pub fn new(plan: &Plan, sample: SampleId, grid: Grid, isa: Isa) -> Result<Self, Vec<SceneError>> {
        let scene = draw(plan, sample)?;

        let request = request(plan);
        let shown = Request { groups: GROUPS.into_iter().collect(), ..request };
        let fields = states(&request).union(shown.fields()).union(request.fields());
        let mut engine = propagator(plan, grid.clone(), fields).engine(isa);
        let nominal = nominal_attitude(plan, &request, &grid, isa);
        let mut observer = Observer::new(request, &grid).with_nominal(nominal);
        let mut series_observer = Observer::new(shown, &grid);
        let mut row = vec![f64::NAN; request.columns().len()];
        let mut ignored = vec![f64::NAN; shown.columns().len()];
        let (mut result, mut reason) = (None, String::new());
        engine.propagate(std::slice::from_ref(&scene), &mut |CompletedRun { table, outcome, .. }| {
            let status = observer.observe(isa, &scene, table, outcome, &mut row);
            series_observer.observe(isa, &scene, table, outcome, &mut ignored);
            reason = observer.reason(status, outcome, &row);
            result = Some((table.clone(), Outcome { status, ..*outcome }));
        });
        let (table, outcome) = result.expect("the propagator finishes every scene that it is given");
        let series = series_observer.series().map(|(series, values)| (series, values.collect())).collect();
        Ok(SingleRun { scene, grid, table, outcome, reason, series, row, request })
    }
}

/// Every state of scenes of the kind of `request`.
pub fn states(request: &Request) -> StateFields {
    let spacecraft = [
        StateField::Rate,
        StateField::Attitude,
        StateField::WheelRates,
        StateField::WheelAngles,
        StateField::ComPosition,
        StateField::ComVelocity,
    ];
    let debris =
        [StateField::DebrisPosition, StateField::DebrisVelocity, StateField::DebrisAttitude, StateField::DebrisRate];
    let constrained: &[StateField] = if request.constrained { &[StateField::Dcm] } else { &[] };
    let debris: &[StateField] = if request.debris { &debris } else { &[] };
    spacecraft.iter().chain(debris).chain(constrained).fold(StateFields::NONE, |fields, field| fields.with(*field))
}
