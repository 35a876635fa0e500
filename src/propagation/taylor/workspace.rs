//! [`Workspace`]: the memory of a march, reused from batch to batch.

use super::dense::Segment;
use super::jet::{Reciprocals, Scratch};
use super::step::StepRule;
use super::thrust::Quadrature;
use crate::math::Real;
use crate::math::lanes::WIDTH;
use crate::run::Trajectory;

/// Steps whose series are kept at first; a period within them is found without any allocation.
const RING: usize = 24;
/// Steps whose series are kept at most; a run that takes more without a period goes on as plain Taylor integration.
pub const LARGEST_RING: usize = 192;

/// What a march is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Relative tolerance.
    pub tolerance: f64,
    /// Whether stretches free of torque are propagated by their period.
    pub periodic: bool,
    /// Steps after which a run is given up.
    pub max_steps: u64,
}

/// The reusable memory of a march of `N` components, of which the first `J` have series.
#[derive(Clone, Debug)]
pub struct Workspace<R, const J: usize> {
    /// Order and step size.
    pub rule: StepRule,
    /// What is asked for.
    pub settings: Settings,
    /// Nodes of the integrals of thrust.
    pub quadrature: Quadrature,
    /// 1/n.
    pub reciprocals: Reciprocals<R>,
    /// What the recurrences need on their way.
    pub scratch: Scratch<R>,
    /// Series of the last steps; step k lies in slot k modulo the length.
    pub ring: Vec<Segment<R, J>>,
    /// The run in each lane at its points.
    pub trajectories: Vec<Trajectory>,
    /// Points of runs whose period is known.
    pub folds: PeriodFolding,
}

impl<R: Real, const J: usize> Workspace<R, J> {
    /// Memory for runs of `components` components observed at `points` points; `zero` says how many lanes.
    pub fn new(zero: R, settings: Settings, components: usize, points: usize) -> Self {
        let rule = StepRule::in_f64(settings.tolerance);
        Workspace {
            rule,
            settings,
            quadrature: Quadrature::new(&rule, settings.tolerance),
            reciprocals: Reciprocals::new(zero, rule.order),
            scratch: Scratch::new(zero),
            ring: (0..RING).map(|_| Segment::new(zero, rule.order)).collect(),
            trajectories: (0..R::LANES).map(|_| Trajectory::new(components, points)).collect(),
            folds: PeriodFolding::new(R::LANES, J, points),
        }
    }

    /// Doubles the ring, keeping the series of the steps before step `clock`; false where it is at its largest already.
    pub fn grow_ring(&mut self, zero: R, clock: usize) -> bool {
        let old = self.ring.len();
        if old >= LARGEST_RING {
            return false;
        }
        let mut ring: Vec<Segment<R, J>> = (0..2 * old).map(|_| Segment::new(zero, self.rule.order)).collect();
        for step in clock.saturating_sub(old)..clock {
            core::mem::swap(&mut ring[step % (2 * old)], &mut self.ring[step % old]);
        }
        self.ring = ring;
        true
    }
}

/// Observation points of the runs in the lanes that wait with a known period: where each lies within the period, and
/// the components there. Rows are lane by lane or vector by vector, as said.
#[derive(Clone, Debug)]
pub struct PeriodFolding {
    /// Points of a lane with padding: the length of a row of `rest`, `whole`, `segment`, `vector`.
    pub stride: usize,
    /// Most vectors of `x` and `values`.
    pub capacity: usize,
    /// Time since the start of the stretch less whole periods, a row per lane.
    pub rest: Vec<f64>,
    /// Whole periods before each point, a row per lane.
    pub whole: Vec<f64>,
    /// The series a point lies in, counted from the oldest of all lanes, a row per lane.
    pub segment: Vec<u32>,
    /// The vector of `values` that holds a point (at first: its number within its series), a row per lane.
    pub vector: Vec<u32>,
    /// Points of a lane in a series, series by series.
    pub count: Vec<u32>,
    /// First vector of each series.
    pub first: Vec<u32>,
    /// Starts of the series, high and low part, series by series.
    pub start: [Vec<f64>; 2],
    /// Time since the start of the series, vector by vector.
    pub x: Vec<f64>,
    /// Components, lane by lane, vector by vector.
    pub values: Vec<f64>,
}

impl PeriodFolding {
    fn new(lanes: usize, components: usize, points: usize) -> Self {
        let stride = points.next_multiple_of(WIDTH) + WIDTH;
        // one lane alone never needs more than a vector a point
        let capacity = 2 * points + 64;
        let series = 2 * LARGEST_RING;
        PeriodFolding {
            stride,
            capacity,
            rest: vec![0.0; lanes * stride],
            whole: vec![0.0; lanes * stride],
            segment: vec![0; lanes * stride],
            vector: vec![0; lanes * stride],
            count: vec![0; lanes * series],
            first: vec![0; series + 1],
            start: [vec![0.0; lanes * series], vec![0.0; lanes * series]],
            x: vec![0.0; lanes * capacity],
            values: vec![0.0; lanes * capacity * components],
        }
    }
}
