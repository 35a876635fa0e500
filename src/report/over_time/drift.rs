//! The relative errors of the balances over time: on the page with bands, in plots together.

use crate::findings::number::short;
use crate::observables::Series;
use crate::report::figure::Dash;
use crate::report::figure::{Figure, FigureSection, Hue, Mark};
use crate::report::over_time::curves::{Curves, over_time};
use crate::report::over_time::figure_list::ListedFigure;
use crate::report::over_time::relative_errors;

/// Relative errors of the balances, in one figure.
const ERRORS: [(Series, &str); 3] = [
    (Series::EnergyError, "energy minus work"),
    (Series::LinearMomentumError, "linear momentum"),
    (Series::AngularMomentumError, "angular momentum"),
];

impl Curves<'_> {
    /// The errors of one run.
    pub(super) fn balances(&self, listed: &ListedFigure) -> Figure {
        let curve = |(index, (series, label)): (usize, &(Series, &str))| {
            let values = self.nominal(*series);
            let is_there = values.iter().any(|value| *value != 0.0);
            is_there.then(|| Mark::line(*label, Hue::Curve(index), Dash::of_curve(index), self.times(), values))
        };
        let mut marks: Vec<Mark> = ERRORS.iter().enumerate().filter_map(curve).collect();
        let largest = marks.iter().map(Mark::largest).fold(0.0, f64::max);
        let title = format!("{} (maximum {})", listed.title, short(largest));
        let axis = relative_errors::limited(&mut marks, self.tolerance(), true);
        over_time("balances", &title, String::new(), axis, marks)
    }

    /// The relative tolerance of a step, of a method that follows one.
    fn tolerance(&self) -> Option<f64> {
        (!self.plan.method.has_fixed_step()).then_some(self.plan.tolerance.relative)
    }

    /// Drift of the balances over time: relative errors, with the tolerance, of a method that follows one, and the
    /// rounding of doubles.
    pub fn drift(&self) -> Vec<Figure> {
        let tolerance = self.tolerance();
        let energy = [(Series::EnergyError, "", Hue::Body)];
        let momenta = [
            (Series::AngularMomentumError, "angular", Hue::Wheel(0)),
            (Series::LinearMomentumError, "linear", Hue::Wheel(1)),
        ];
        let debris = [
            (Series::DebrisAngularError, "angular", Hue::Debris),
            (Series::DebrisLinearError, "linear", Hue::Wheel(2)),
        ];
        let figure = |name: &str, title: &str, what: &str, list: &[(Series, &str, Hue)]| {
            let of = |(series, of, hue): &(Series, &str, Hue)| {
                self.marks(&self.name(*series).0, self.nominal(*series), *hue, of)
            };
            let mut marks: Vec<Mark> = list.iter().flat_map(of).collect();
            let is_signed = list.iter().all(|(series, ..)| *series == Series::EnergyError);
            let axis = relative_errors::limited(&mut marks, tolerance, is_signed);
            let of_step = tolerance.map_or(String::new(), |tolerance| format!("Tolerance of a step: {tolerance:e}; "));
            let caption = format!(
                "{what}, relative to the largest. {} {of_step}rounding of a double: 1.1e-16.",
                self.caption_of(&self.name(list[0].0).0, &[])
            );
            let figure = over_time(name, title, caption, axis, marks);
            self.in_flight(Figure { section: FigureSection::Numerics, ..figure })
        };
        vec![
            figure("drift_energy", "Drift of energy", "Change of energy minus work", &energy),
            figure(
                "drift_momentum",
                "Drift of momentum",
                "Change of momentum minus impulse (magnitude of the vector)",
                &momenta,
            ),
            figure(
                "drift_debris",
                "Drift of the debris's momentum",
                "Change of momentum (magnitude of the vector)",
                &debris,
            ),
        ]
    }
}
