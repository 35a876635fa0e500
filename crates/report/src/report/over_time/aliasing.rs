//! Envelopes in place of bands whose times are too few for the motion: a band never aliases.

use crate::analysis::envelope::{swing, turns, within};
use crate::ensemble::SingleRun;
use crate::observables::Series;
use crate::report::figure::{Hue, Mark};
use crate::report::over_time::curves::{Curves, FEWEST, TimeBands};

/// Fewest band times per oscillation.
const PER_TURN: usize = 4;
/// A swing is visible above this fraction of the bands' width.
const SEEN_SWING: f64 = 0.05;

impl<'a> Curves<'a> {
    /// True if the nominal run oscillates visibly, but too fast for the times of the bands.
    pub(super) fn is_aliased(&self, bands: &TimeBands, nominal: &[f64]) -> bool {
        let ends = bands.quantiles[0].iter().zip(&bands.quantiles[4]);
        let width = ends.map(|(low, high)| high - low).fold(0.0, f64::max);
        let is_seen = is_coarse(turns(nominal), bands.times.len()) && swing(nominal) > SEEN_SWING * width;
        is_seen && self.run.is_some_and(|run| run.grid.points() > bands.times.len())
    }

    /// Replaces bands that would alias: the extremes of the nominal run, and of all replayed runs, between the times of
    /// the bands.
    pub(super) fn envelopes(
        &self,
        name: &str,
        bands: &TimeBands,
        nominal: &[f64],
        hue: Hue,
        label: &dyn Fn(&str) -> String,
    ) -> Vec<Mark> {
        let times = self.times();
        let ends = whole_swings(&bands.times, nominal);
        let last = times.partition_point(|time| *time <= bands.times.last().copied().unwrap_or(0.0));
        let area = |curves: &[&[f64]], label: String, opacity: f64, hue: Hue| {
            let [x, low, high] = within(&times[..last], curves, &ends);
            Mark::area(label, (hue, opacity), x, [low, high])
        };
        let all = self.flown_values(name);
        let mut marks = Vec::new();
        if all.len() > 1 {
            let curves: Vec<&[f64]> = all.iter().map(Vec::as_slice).collect();
            marks.push(area(&curves, label(&format!("envelope of {} runs", all.len())), 0.2, hue));
        }
        marks.push(area(&[nominal], label("envelope of the nominal run"), 0.4, Hue::Nominal));
        marks
    }

    /// The series `name`, or the change of an energy, of each replayed run.
    fn flown_values(&self, name: &str) -> Vec<Vec<f64>> {
        let energy = name.replace("exchange_", "energy_com_");
        let is_of_it = |(series, _): &&(Series, Vec<f64>)| {
            series.quantity(self.wheels).is_some_and(|quantity| quantity.name() == energy)
        };
        let of_run = |run: &&'a SingleRun| {
            let (_, values) = run.series.iter().find(is_of_it)?;
            let values = &values[..values.len().min(run.outcome.points)];
            Some(if energy == name { values.to_vec() } else { changes(values) })
        };
        self.flown.iter().filter_map(of_run).collect()
    }

    pub(super) fn caption_of(&self, name: &str, nominal: &[f64]) -> String {
        let Some(bands) = self.band(name) else { return "The nominal run.".to_owned() };
        if self.is_aliased(bands, nominal) {
            return format!(
                "Envelopes: smallest to largest value in each of {} intervals, of the nominal run and of the {} runs \
                 flown for this page, the worst ones. Quantiles at fewer than {PER_TURN} instants in an oscillation \
                 would miss it: raise [bands] points.",
                whole_swings(&bands.times, nominal).len().saturating_sub(1),
                self.flown.len(),
            );
        }
        let left = match bands.in_flight.last() {
            Some(left) if *left < bands.runs => {
                format!(" Bands end where fewer than {FEWEST} runs are left.")
            }
            _ => String::new(),
        };
        let of = if bands.counted < bands.runs {
            let error = |p: f64| 100.0 * libm::sqrt(p * (1.0 - p) / bands.counted as f64);
            format!(
                "the first {} of {} dispersed runs that were computed (standard error of these shares {:.2} and \
                {:.2}%, of the median {:.2}%; bands.runs counts more)",
                bands.counted,
                bands.runs,
                error(0.05),
                error(0.25),
                error(0.5)
            )
        } else {
            format!("{} dispersed runs that were computed", bands.runs)
        };
        format!("Bands: 5 to 95% and 25 to 75% of {of}, at each of {} times.{left}", bands.times.len())
    }
}

/// True if `times` samples give fewer than [`PER_TURN`] per oscillation (two turns).
fn is_coarse(turns: usize, times: usize) -> bool {
    PER_TURN * turns > 2 * times.saturating_sub(1)
}

/// The members of `times` between which `values` swing at least once: shorter intervals would have parts of a swing in
/// turns.
fn whole_swings(times: &[f64], values: &[f64]) -> Vec<f64> {
    let intervals = times.len().saturating_sub(1);
    // three turns are one and a half oscillations
    let each = intervals.div_ceil((turns(values) / 3).max(1)).max(1);
    let last = times.last().filter(|_| !intervals.is_multiple_of(each));
    times.iter().step_by(each).chain(last).copied().collect()
}

/// Changes since the start.
pub(super) fn changes(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| value - values[0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::replays::GROUPS;
    use crate::ensemble::single::SingleRuns;
    use crate::findings::shipped;
    use crate::math::Isa;
    use crate::run::Grid;
    use crate::sampling::SampleId;

    /// Law: sampling is too coarse if and only if an oscillation has fewer than four samples, for any number of
    /// oscillations.
    #[test]
    fn four_times_show_an_oscillation() {
        for oscillations in [1, 5, 20, 50] {
            let wave =
                |k: u32| libm::sin(core::f64::consts::TAU * f64::from(oscillations) * f64::from(k) / 10_000.0 + 0.1);
            let turns = turns(&(0..=10_000).map(wave).collect::<Vec<f64>>());
            let intervals = 4 * oscillations as usize;
            assert_eq!(
                [intervals, intervals + 1].map(|times| is_coarse(turns, times)),
                [true, false],
                "{oscillations}: {turns}"
            );
        }
        assert!(!is_coarse(0, 2));
    }

    /// Law: an envelope of a steady oscillation is as steady, whatever its period is to the times of the bands.
    #[test]
    fn an_envelope_has_whole_swings() {
        let times: Vec<f64> = (0..=2000).map(|k| f64::from(k) / 200.0).collect();
        let bands: Vec<f64> = (0..=32).map(|k| f64::from(k) / 3.2).collect();
        for period in [0.06, 0.3, 0.45, 0.7, 1.1] {
            let wave: Vec<f64> = times.iter().map(|time| libm::sin(core::f64::consts::TAU * time / period)).collect();
            let ends = whole_swings(&bands, &wave);
            assert!(ends.len() > 4 && ends[0] == 0.0 && ends.last() == Some(&10.0), "{period}: {ends:?}");
            let [_, low, high] = within(&times, &[&wave], &ends[..ends.len() - 1]);
            let is_whole = low.iter().chain(&high).all(|end| end.abs() > 0.9);
            assert!(is_whole, "{period}: {low:?} {high:?}");
        }
    }

    /// Law: if the nominal run oscillates faster than the bands' times, envelopes replace the bands and contain all
    /// values of their runs; with dense times, bands are drawn.
    #[test]
    fn a_band_never_aliases() {
        let plan = shipped::plan("spin_sweep");
        let grid = Grid::uniform(plan.grid.duration(), 601);
        let mut runs = SingleRuns::new(&plan, grid, Isa::best(), &GROUPS, true);
        let flown: Vec<SingleRun> =
            runs.run_all(&[0, 1, 2].map(SampleId)).into_iter().map(|run| run.expect("physical")).collect();
        let (series, nominal) = &flown[0].series[flown[0]
            .series
            .iter()
            .position(|(series, values)| {
                is_coarse(turns(values), 33) && swing(values) > 0.0 && series.quantity(&[]).is_some()
            })
            .expect("a series that oscillates")];
        let name = series.quantity(&[]).expect("a name").name().to_owned();
        let band = |points: usize| {
            let times = (0..points).map(|k| plan.grid.duration() * k as f64 / (points - 1) as f64).collect::<Vec<_>>();
            let quantiles = std::array::from_fn(|_| vec![nominal[0]; points]);
            TimeBands { name: name.clone(), times, quantiles, runs: 99, counted: 99, in_flight: vec![99; points] }
        };
        for (points, is_envelope) in [(33, true), (601, false)] {
            let bands = [band(points)];
            let curves = Curves::of_page(&plan, Some(&flown[0]), &bands, &[]).among(flown.iter().collect());
            let marks = curves.marks(&name, nominal.clone(), Hue::Total, "");
            let is_instant = marks.iter().any(|mark| ["median", "5 to 95%"].contains(&mark.legend()));
            assert_eq!(is_instant, !is_envelope, "{points}");
            assert_eq!(curves.caption_of(&name, nominal).starts_with("Envelopes: "), is_envelope, "{points}");
            if !is_envelope {
                continue;
            }
            for (label, runs) in [("envelope of 3 runs", &flown[..]), ("envelope of the nominal run", &flown[..1])] {
                let of_it = marks.iter().find(|mark| mark.legend() == label);
                let Some(Mark::Band { x, low, high, .. }) = of_it else { panic!("no {label}: {marks:?}") };
                for run in runs {
                    let (_, values) = run.series.iter().find(|(other, _)| other == series).expect("the same series");
                    for (time, value) in run.grid.times().iter().zip(values) {
                        let at = x.partition_point(|end| end < time).clamp(1, x.len() - 1);
                        assert!((low[at]..=high[at]).contains(value), "{label} at {time}: {value}");
                    }
                }
            }
        }
    }
}
