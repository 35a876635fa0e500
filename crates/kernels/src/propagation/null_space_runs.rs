//! [`NullSpaceRuns`]: runs of the null-space formulation, one at a time.

use crate::dynamics::actuation::Laws;
use crate::dynamics::applied::next_arc;
use crate::dynamics::arc_record::ArcRecord;
use crate::dynamics::null_space::{Kernel, State, observed_state, sigma};
use crate::ode::{Runs, System, Tolerance};
use crate::scene::Scene;

/// Runs of the scenes of a batch with at most `W` wheels; `f64`, one lane.
pub struct NullSpaceRuns<'a, const W: usize> {
    scenes: &'a [Scene],
    laws: Laws<'a>,
    duration: f64,
    run: usize,
    kernel: Kernel<W>,
    /// Attitude quaternion at the start of the arc, which decides the sign of the next one.
    q_es: [f64; 4],
    arcs: ArcRecord,
}

impl<'a, const W: usize> NullSpaceRuns<'a, W> {
    /// Runs of `scenes` under `laws` from zero to `duration`, s; `arcs` is memory.
    ///
    /// # Panics
    /// If there is no scene.
    pub fn new(scenes: &'a [Scene], laws: Laws<'a>, duration: f64, arcs: ArcRecord) -> Self {
        let kernel = Kernel::new(scenes.first().expect("a batch has at least one scene"));
        NullSpaceRuns { scenes, laws, duration, run: 0, kernel, q_es: [1.0, 0.0, 0.0, 0.0], arcs }
    }

    /// Arcs of the run in the lane so far.
    pub fn arcs(&self) -> &ArcRecord {
        &self.arcs
    }

    /// Returns the memory of the arcs.
    pub fn into_arcs(self) -> ArcRecord {
        self.arcs
    }
}

impl<const W: usize, const N: usize> System<f64, N> for NullSpaceRuns<'_, W> {
    #[inline(always)]
    fn derivative(&self, _time: f64, state: &[f64; N]) -> [f64; N] {
        self.kernel.derivative(state)
    }

    /// The norm of MATLAB's ode45, max |e_i| / (rtol max(|y_i|, |y_i new|, atol / rtol)) over the states without
    /// quadratures (Shampine & Reichelt 1997); NaN if any component is not finite.
    #[inline(always)]
    fn error_ratio(&self, error: &[f64; N], old: &[f64; N], new: &[f64; N], tolerance: Tolerance) -> f64 {
        let threshold = tolerance.absolute / tolerance.relative;
        let (mut largest, mut poison) = (0.0_f64, 0.0_f64);
        for i in 0..State::<W>::STATES {
            let ratio = error[i].abs() / old[i].abs().max(new[i].abs()).max(threshold);
            poison = (error[i] + new[i]).mul_add(0.0, poison);
            largest = largest.max(ratio);
        }
        largest / tolerance.relative + poison
    }
}

impl<const W: usize, const N: usize> Runs<f64, N> for NullSpaceRuns<'_, W> {
    fn count(&self) -> usize {
        self.scenes.len()
    }

    fn load(&mut self, _lane: usize, run: usize) -> [f64; N] {
        self.run = run;
        self.kernel = Kernel::new(&self.scenes[run]);
        self.q_es = self.scenes[run].initial.q_es;
        self.arcs.clear();
        sigma::<W>(&self.scenes[run]).components()
    }

    fn next_arc(&mut self, _lane: usize, time: f64, state: &[f64; N]) -> Option<f64> {
        if time >= self.duration {
            return None;
        }
        let scene = &self.scenes[self.run];
        let (kernel, q_es) = (&self.kernel, &mut self.q_es);
        let observed = || {
            let (body, wheels) = observed_state(kernel.parameters(), &State::<W>::from_components(state), *q_es);
            *q_es = body.q_es;
            (body, wheels)
        };
        let arc = next_arc(scene, self.laws.of(self.run), time, observed, self.duration);
        self.kernel.drive(&arc.applied);
        self.arcs.push(&arc);
        Some(arc.end())
    }
}
