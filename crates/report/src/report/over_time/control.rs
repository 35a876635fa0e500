//! Figures of a control loop: estimation errors, phases, wheels, thrusters, approach to the debris.

use crate::ensemble::SingleRun;
use crate::loops::STANDARD_GRAVITY;
use crate::observables::Series;
use crate::report::figure::{Axis, Dash, Figure, Hue, Mark, Scale};
use crate::report::over_time::curves::{Curves, areas, lines, over_time};
use crate::report::over_time::figure_list::{ListedFigure, WheelLimit};
use crate::report::over_time::limits;
use crate::report::page::readable::with_unit;
use crate::scene::Arc;

/// Multiple of the filter's standard deviation shown with an error.
const SIGMAS: f64 = 3.0;
/// Half the height of a phase strip, relative to its row.
const HALF: f64 = 0.32;

impl Curves<'_> {
    pub(super) fn estimated(&self, listed: &ListedFigure, series: Series, expected: &str) -> Option<Figure> {
        let (name, unit) = self.name(series);
        let mut marks = self.marks(&name, self.nominal(series), listed.hue, "");
        let bound: Vec<f64> = self.recorded(expected)?.iter().map(|error| SIGMAS * error).collect();
        let mut caption = self.caption(&name);
        if self.is_plot() {
            for mark in &mut marks {
                if let Mark::Line { label, .. } = mark {
                    *label = "the error".to_owned();
                }
            }
        }
        if !self.is_plot() || !marks.is_empty() {
            marks.extend(lines("3 sigma of the filter", (Hue::Reference, Dash::Long), &self.times(), &bound));
            caption += " 3 sigma: covariance of the filter in the nominal run.";
        }
        let mut figure = self.judged(listed, (&name, &unit), (listed.title, caption), marks);
        // errors shrink by decades
        let least = bound.into_iter().filter(|bound| *bound > 0.0).fold(f64::INFINITY, f64::min);
        let largest = figure.marks.iter().map(Mark::largest).fold(0.0, f64::max);
        if least < largest {
            figure.y.scale = Scale::Log;
            figure.y.range = Some([0.03 * least, 1.5 * largest]);
        }
        Some(figure)
    }

    pub(super) fn phases(&self, listed: &ListedFigure) -> Option<Figure> {
        let spec = self.plan.law.as_ref()?.spec()?;
        let (times, phase) = (self.times(), self.recorded("phase")?);
        let mut visits: Vec<(usize, [f64; 2])> = Vec::new();
        for (time, phase) in times.iter().zip(&phase).filter(|(_, phase)| phase.is_finite()) {
            let row = *phase as usize;
            if let Some((_, span)) = visits.last_mut() {
                span[1] = *time;
            }
            if visits.last().is_none_or(|(last, _)| *last != row) {
                visits.push((row, [*time, *time]));
            }
        }
        // skip unvisited phases
        let rows: Vec<usize> = (0..spec.phases.len()).filter(|row| visits.iter().any(|(of, _)| of == row)).collect();
        let names = rows.iter().map(|row| spec.phases[*row].name.to_string()).collect();
        let strip = |(row, span): (usize, [f64; 2])| {
            let at = rows.iter().position(|other| *other == row).unwrap_or(0) as f64;
            let [low, high] = [at - HALF, at + HALF].map(|end| vec![end; 2]);
            Mark::area("", (listed.hue, 0.6), span.to_vec(), [low, high])
        };
        let marks = visits.into_iter().map(strip).collect();
        let caption = "Phases of guidance in the nominal run.".to_owned();
        Some(over_time("phases", listed.title, caption, Axis::names(names), marks))
    }

    pub(super) fn all_wheels(&self, listed: &ListedFigure, series: Series, limit: WheelLimit) -> Figure {
        let mut marks = Vec::new();
        for (index, wheel) in self.wheels.iter().enumerate() {
            let (name, _) = self.name(series.of_wheel(index));
            let hue = Hue::Wheel(index);
            match self.band(&name) {
                Some(bands) => {
                    let [p05, _, p50, _, p95] = &bands.quantiles;
                    marks.extend(areas(&format!("{wheel}, 5 to 95%"), (hue, 0.15), &bands.times, [p05, p95]));
                    marks.extend(lines(&format!("{wheel}, median"), (hue, Dash::Solid), &bands.times, p50));
                }
                None => {
                    let values = self.nominal(series.of_wheel(index));
                    // identical curves stay visible
                    let dash = if self.is_plot() { Dash::of_curve(index) } else { Dash::Solid };
                    marks.extend(lines(wheel.as_str(), (hue, dash), &self.times(), &values));
                }
            }
        }
        let (name, unit) = self.name(series);
        let caption = self.caption(&name);
        if let Some(run) = self.run {
            let models = self.wheels.iter().zip(&run.scene.actuators.wheels);
            let limits: Vec<_> = models.map(|(wheel, model)| (wheel.to_string(), limit.of(model))).collect();
            let shown = self.plan.analysis.display.of(&self.shown_as(listed, &name), &unit);
            marks.extend(limits::of_actuators(&limits, &shown, limit == WheelLimit::Torque));
        }
        let title = format!("{} of the wheels", listed.title);
        let file = format!("wheel_{}", listed.title.to_lowercase().replace(' ', "_"));
        let figure = self.judged(listed, (&name, &unit), (&title, caption), marks);
        Figure { name: file, ..figure }
    }

    fn impulses(&self) -> Option<Vec<(String, Vec<f64>)>> {
        let (run, spec) = (self.run?, self.plan.law.as_ref()?.spec()?);
        let of = |place: &usize| {
            let impulse = impulse(run, &self.times(), |arc| arc.applied.thrust[*place]);
            (spec.thruster_names[*place].to_string(), impulse)
        };
        Some(spec.thrusters.iter().map(of).collect())
    }

    /// Mean thrust between points, with the maximum thrusts.
    pub(super) fn thrust(&self, listed: &ListedFigure) -> Option<Figure> {
        let (times, run) = (self.times(), self.run?);
        let impulses = self.impulses()?;
        let mut marks = Vec::new();
        for (index, (name, impulse)) in impulses.iter().enumerate() {
            // constant between points
            let (mut x, mut y) = (Vec::new(), Vec::new());
            for (time, sum) in times.windows(2).zip(impulse.windows(2)) {
                x.extend(time);
                y.extend([(sum[1] - sum[0]) / (time[1] - time[0]); 2]);
            }
            marks.push(Mark::line(named(name, &y), Hue::Curve(index), Dash::of_curve(index), x, y));
        }
        if marks.iter().all(|mark| mark.largest() == 0.0) {
            marks.clear();
        }
        let thrusters = &self.plan.law.as_ref()?.spec()?.thrusters;
        let models = thrusters.iter().map(|place| run.scene.actuators.thrusters[*place].max_thrust);
        let limits: Vec<(String, f64)> = impulses.iter().map(|(name, _)| name.clone()).zip(models).collect();
        marks.extend(limits::of_actuators(&limits, &self.plan.analysis.display.of("thrust", "N"), false));
        let caption =
            "Mean thrust between points in the nominal run; single pulses are shorter and stronger.".to_owned();
        Some(self.judged(listed, ("thrust", "N"), (listed.title, caption), marks))
    }

    pub(super) fn impulse(&self, listed: &ListedFigure) -> Option<Figure> {
        let impulses = self.impulses()?;
        let (name, unit) = self.name(Series::Impulse);
        if self.band(&name).is_some() {
            let marks = self.marks(&name, self.nominal(Series::Impulse), listed.hue, "");
            return Some(self.judged(listed, (&name, &unit), (listed.title, self.caption(&name)), marks));
        }
        let line = |(index, (name, sum)): (usize, &(String, Vec<f64>))| {
            Mark::line(named(name, sum), Hue::Curve(index), Dash::of_curve(index), self.times(), sum.clone())
        };
        let mut marks: Vec<Mark> = impulses.iter().enumerate().map(line).collect();
        if marks.iter().all(|mark| mark.largest() == 0.0) {
            marks.clear();
        }
        if marks.len() > 1 {
            marks.push(Mark::line("all", Hue::Nominal, Dash::Dashed, self.times(), total(&impulses)));
        }
        let caption = "Impulse since the start in the nominal run.".to_owned();
        Some(self.judged(listed, (&name, &unit), (listed.title, caption), marks))
    }

    pub(super) fn propellant(&self, listed: &ListedFigure) -> Option<Figure> {
        let isp = self.constant("isp_s").filter(|isp| *isp > 0.0)?;
        let mass =
            total(&self.impulses()?).iter().map(|impulse| impulse / (STANDARD_GRAVITY * isp)).collect::<Vec<_>>();
        let marks = if mass.iter().any(|mass| *mass > 0.0) {
            self.of_run(if self.is_plot() { "" } else { "nominal run" }, (listed.hue, Dash::Solid), &mass)
        } else {
            Vec::new()
        };
        let caption = "Propellant used since the start in the nominal run.".to_owned();
        Some(self.judged(listed, ("propellant", "kg"), (listed.title, caption), marks))
    }

    fn constant(&self, key: &str) -> Option<f64> {
        self.plan.nominal.control.law.named(key).and_then(|numbers| numbers.first().copied())
    }

    pub(super) fn distances(&self, name: &str, unit: &str) -> Vec<Mark> {
        let launches = self.plan.law.as_ref().and_then(|law| law.spec()).is_some_and(|spec| spec.launches());
        let station = self.constant("launch_distance_m").filter(|_| launches);
        let shown = self.plan.analysis.display.of(name, unit);
        let limit = |(what, at): (&str, Option<f64>)| {
            let at = at.filter(|at| *at > 0.0)?;
            let label = format!("{what} {}", with_unit(shown.written(at), &shown.unit));
            Some(Mark::Limit { label, at, vertical: false })
        };
        [("keep-out", self.constant("keep_out_m")), ("station", station)].into_iter().filter_map(limit).collect()
    }
}

/// Accumulated impulse of a `force` at each of `times`, N s.
pub fn impulse(run: &SingleRun, times: &[f64], force: impl Fn(&Arc) -> f64) -> Vec<f64> {
    let (mut sum, mut next) = (0.0, 0);
    let at = |time: &f64| {
        while let Some(arc) = run.arcs.get(next).filter(|arc| arc.applied.until <= *time) {
            sum += force(arc) * (arc.applied.until - arc.start);
            next += 1;
        }
        // the current arc
        let part = run.arcs.get(next).filter(|arc| arc.start < *time && !arc.applied.ends_run);
        sum + part.map_or(0.0, |arc| force(arc) * (time - arc.start))
    };
    times.iter().map(at).collect()
}

/// The label of a thruster; an idle one is marked, since a dead thruster may decide the run.
fn named(name: &str, values: &[f64]) -> String {
    if values.iter().all(|value| *value == 0.0) { format!("{name}: none") } else { name.to_owned() }
}

fn total(impulses: &[(String, Vec<f64>)]) -> Vec<f64> {
    let points = impulses.first().map_or(0, |(_, sum)| sum.len());
    (0..points).map(|point| impulses.iter().map(|(_, sum)| sum[point]).sum()).collect()
}
