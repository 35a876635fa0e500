//! [`Workspace`]: the memory of a Taylor integration, reused from batch to batch.

use super::brief::BriefRule;
use super::fold_buffer::FoldBuffer;
use super::jet::{Reciprocals, Scratch};
use super::point_rows::PointRows;
use super::series_ring::SeriesRing;
use super::step::StepRule;
use super::thrust::Quadrature;
use crate::dynamics::arc_record::ArcRecord;
use crate::dynamics::effects::ChangingSeries;
use crate::math::Real;
use crate::run::Trajectory;

/// What is asked of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Relative tolerance.
    pub tolerance: f64,
    /// Whether arcs without actuation are propagated by their period.
    pub periodic: bool,
    /// Steps after which a run is given up.
    pub max_steps: u64,
}

/// The reusable memory of runs of `N` components; the first `J` have series.
#[derive(Clone, Debug)]
pub struct Workspace<R, const J: usize> {
    /// Order and step size.
    pub rule: StepRule,
    /// The order of brief arcs.
    pub(super) brief: BriefRule,
    /// What is asked for.
    pub settings: Settings,
    /// Nodes of the integrals of thrust.
    pub quadrature: Quadrature<R>,
    /// 1/n.
    pub reciprocals: Reciprocals<R>,
    /// Intermediate series of the recurrences.
    pub scratch: Scratch<R>,
    /// Series of the effects that change within an arc; of order zero where none acts.
    pub effects: ChangingSeries<R>,
    /// Series of the last steps.
    pub ring: SeriesRing<R, J>,
    /// The last points of the run in each lane.
    pub(super) points: PointRows,
    /// The run in each lane at its points.
    pub trajectories: Vec<Trajectory>,
    /// Memory of the arcs that the run in each lane flies.
    pub records: Vec<ArcRecord>,
    /// Points of runs whose period is known.
    pub folds: FoldBuffer,
}

impl<R: Real, const J: usize> Workspace<R, J> {
    /// Memory for runs of `components` components observed at `points` points; `zero` says how many lanes.
    pub fn new(zero: R, settings: Settings, components: usize, points: usize) -> Self {
        let rule = StepRule::in_f64(settings.tolerance);
        Workspace {
            rule,
            brief: BriefRule::new(settings.tolerance, rule.order),
            settings,
            quadrature: Quadrature::new(zero, &rule, settings.tolerance),
            reciprocals: Reciprocals::new(zero, rule.order),
            scratch: Scratch::new(zero),
            effects: ChangingSeries::new(zero, 0),
            ring: SeriesRing::new(zero, rule.order),
            points: PointRows::new(R::LANES, components),
            trajectories: (0..R::LANES).map(|_| Trajectory::new(components, points)).collect(),
            records: vec![ArcRecord::default(); R::LANES],
            folds: FoldBuffer::new(R::LANES, J, points),
        }
    }
}
