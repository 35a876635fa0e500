//! [`ArcSource`]: the arcs of the runs of a batch, one at a time.

use crate::dynamics::actuation::Laws;
use crate::dynamics::applied::law_arc;
use crate::dynamics::gyrostat::observed::observed_state;
use crate::dynamics::gyrostat::{Gyrostat, WITH_THRUST};
use crate::run::Grid;
use crate::scene::Scene;

pub struct ArcSource<'a> {
    /// The scene of each run; empty for bodies without actuators.
    scenes: &'a [Scene],
    laws: Laws<'a>,
    duration: f64,
    /// Observation times of runs under laws, s.
    times: &'a [f64],
}

impl<'a> ArcSource<'a> {
    pub fn new(scenes: &'a [Scene], laws: Laws<'a>, grid: &'a Grid) -> Self {
        ArcSource { scenes, laws, duration: grid.duration(), times: grid.times() }
    }

    /// Runs of bodies without actuators: one arc each.
    pub fn free(duration: f64) -> Self {
        ArcSource { scenes: &[], laws: Laws::OpenLoop, duration, times: &[] }
    }

    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Sets the time scale of `gyrostat` before its first arc, from its schedule if it follows one.
    pub fn prepare(&self, run: usize, gyrostat: &mut Gyrostat<f64>) {
        if let (Some(scene), Laws::OpenLoop) = (self.scenes.get(run), &self.laws) {
            gyrostat.expect_schedule(scene, self.duration);
        }
    }

    /// Starts the next arc of run `run` at `time`. `components` evaluates the integrated components, SI.
    ///
    /// # Panics
    /// If a law's arc ends before it starts.
    #[inline(always)]
    pub fn begin_arc(
        &mut self,
        run: usize,
        gyrostat: &mut Gyrostat<f64>,
        time: f64,
        components: impl FnOnce() -> [f64; WITH_THRUST],
    ) {
        let Some(scene) = self.scenes.get(run) else {
            gyrostat.begin_free_arc(self.duration);
            return;
        };
        let Some(law) = self.laws.of(run) else {
            // set before the run
            return gyrostat.begin_scheduled_arc(scene, time, self.duration);
        };
        let wheels = gyrostat.wheels_at(time);
        let (body, rates) = observed_state(gyrostat, time, &components(), &wheels);
        let arc = law_arc(scene, law, time, &body, &rates, self.duration);
        gyrostat.begin_flown_arc(scene, arc, wheels, self.times);
        gyrostat.note_rate();
    }
}
