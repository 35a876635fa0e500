//! Relative errors of the balances over time.

use crate::observables::Series;
use crate::report::figure::{Axis, Figure, FigureSection, Hue, Mark};
use crate::report::over_time::curves::{Curves, over_time};

/// Minimum range of the axis: rounding errors must not look like drift.
const ROUNDING: f64 = 10.0 * f64::EPSILON;
/// Limits beyond this multiple of the errors are named at the edge of the axis.
const FAR: f64 = 3.0;

impl Curves<'_> {
    fn tolerance(&self) -> Option<f64> {
        (!self.plan.method.has_fixed_step()).then_some(self.plan.tolerance.relative)
    }

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
            let axis = limited(&mut marks, tolerance, is_signed);
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

/// Adds the limits to the curves `marks` and returns the axis. `is_signed`: errors may be negative.
fn limited(marks: &mut Vec<Mark>, tolerance: Option<f64>, is_signed: bool) -> Axis {
    let largest = marks.iter().map(Mark::largest).fold(0.0, f64::max);
    let own = largest.max(ROUNDING);
    let shown = tolerance.filter(|tolerance| *tolerance <= FAR * own).map_or(own, |tolerance| tolerance.max(own));
    let tolerance = tolerance.map(|tolerance| (format!("tolerance {tolerance:e}"), tolerance));
    // invisible among larger errors
    let rounding = (shown <= FAR * f64::EPSILON).then(|| ("rounding of a double".to_owned(), f64::EPSILON / 2.0));
    for (label, at) in tolerance.into_iter().chain(rounding) {
        marks.push(Mark::Limit { label, at, vertical: false });
        if is_signed {
            marks.push(Mark::Limit { label: String::new(), at: -at, vertical: false });
        }
    }
    let axis = Axis::linear("relative error", "");
    if largest > 0.0 { axis.within(if is_signed { -1.1 * shown } else { 0.0 }, 1.1 * shown) } else { axis }
}
