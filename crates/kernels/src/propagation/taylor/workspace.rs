//! [`Workspace`]: reusable memory of a Taylor integration.

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

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    pub tolerance: f64,
    /// True to propagate arcs without actuation by their period.
    pub periodic: bool,
    /// Limit of steps of a run.
    pub max_steps: u64,
}

#[derive(Clone, Debug)]
pub struct Workspace<R, const J: usize> {
    pub rule: StepRule,
    pub(super) brief: BriefRule,
    pub settings: Settings,
    /// Nodes of the integrals of thrust.
    pub quadrature: Quadrature<R>,
    /// 1/n.
    pub reciprocals: Reciprocals<R>,
    /// Intermediate series of the recurrences.
    pub scratch: Scratch<R>,
    /// Series of the effects that change within an arc; of order zero if none acts.
    pub effects: ChangingSeries<R>,
    /// Series of the last steps.
    pub ring: SeriesRing<R, J>,
    /// Last points of the run in each lane.
    pub(super) points: PointRows,
    /// Points of the run in each lane.
    pub trajectories: Vec<Trajectory>,
    /// Memory for the arcs of the run in each lane.
    pub records: Vec<ArcRecord>,
    /// Points of runs with a known period.
    pub folds: FoldBuffer,
}

impl<R: Real, const J: usize> Workspace<R, J> {
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
