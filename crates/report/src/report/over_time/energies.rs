//! Energies of the bodies over time, and the transfer between them.

use crate::analysis::spectrum::{amplitudes, dominant};
use crate::findings::number::short;
use crate::observables::Series;
use crate::report::figure::{Axis, Dash, Figure, FigureSection, Hue, Mark};
use crate::report::over_time::aliasing::changes;
use crate::report::over_time::curves::{Curves, over_time};
use crate::report::over_time::figure_list::ListedFigure;

/// Relative changes below this are the rounding errors of thousands of operations.
const ROUNDING: f64 = 1e-12;

impl Curves<'_> {
    fn bodies(&self, series: [Series; 2]) -> impl Iterator<Item = (Series, String, Hue)> {
        core::iter::once((series[0], "the body".to_owned(), Hue::Body)).chain(self.each_wheel(series[1]))
    }

    pub(super) fn energies(&self, listed: &ListedFigure) -> Vec<Figure> {
        let debris = (Series::EnergyDebris, "the debris".to_owned(), Hue::Debris);
        let bodies = self.bodies([Series::EnergyBody, Series::EnergyWheel]).chain([debris]);
        self.each(listed, bodies, "Kinetic energy in F_e. ")
    }

    /// The change of each energy; without bands, the transfer figure suffices.
    pub(super) fn changes(&self, listed: &ListedFigure) -> Vec<Figure> {
        let figure = |(series, of, hue): (Series, String, Hue)| {
            let (name, unit) = self.name(series);
            let name = name.replace("energy_com_", "exchange_");
            self.band(&name)?;
            let nominal = changes(&self.nominal(series));
            let caption = format!(
                "Change of kinetic energy about the spacecraft's centre of mass. {}",
                self.caption_of(&name, &nominal)
            );
            let marks = self.marks(&name, nominal, hue, "");
            let axis = Axis::linear(listed.quantity, &unit);
            Some(over_time(&name, &format!("{} of {of}", listed.title), caption, axis, marks))
        };
        self.bodies([Series::ComBody, Series::ComWheel]).filter_map(figure).collect()
    }

    pub(super) fn transfer(&self, listed: &ListedFigure) -> Vec<Figure> {
        let (times, body) = (self.times(), changes(&self.nominal(Series::ComBody)));
        let wheels: Vec<Vec<f64>> =
            (0..self.wheels.len()).map(|index| changes(&self.nominal(Series::ComWheel.of_wheel(index)))).collect();
        let size = self.nominal(Series::ComBody).iter().fold(0.0, |size: f64, value| value.abs().max(size));
        let is_constant = body.iter().all(|change| change.abs() <= ROUNDING * size);
        let named = || self.wheels.iter().enumerate().zip(&wheels);
        let bodies = named().map(|((index, name), y)| (format!("wheel {name}"), Hue::Wheel(index), y));
        let mut marks = stacked(&times, bodies.chain([("body".to_owned(), Hue::Body, &body)]));
        // the spread of the other runs, unless its times are too few for the motion
        if let Some(bands) = self.band("exchange_body_j").filter(|bands| !self.is_aliased(bands, &body)) {
            for (label, quantile) in [("body, 5% of runs", 0), ("body, 95% of runs", 4)] {
                let (x, y) = (bands.times.clone(), bands.quantiles[quantile].clone());
                marks.push(Mark::line(label, Hue::Body, Dash::Dashed, x, y));
            }
        }
        if is_constant {
            marks.clear();
        }
        let caption = "Change of kinetic energy about the centre of mass since the start, of the nominal run: gains \
            are on top of each other above \
                       zero, losses below. Without motor torque and thrust both heights are equal at all times.";
        let spectrum = if is_constant || self.is_plot() { None } else { spectrum(&times, &body) };
        let transfer =
            over_time("energy_transfer", listed.title, caption.to_owned(), Axis::linear(listed.quantity, "J"), marks);
        [transfer].into_iter().chain(spectrum).collect()
    }
}

/// Stacks the values of several bodies: gains above zero, losses below.
fn stacked<'v>(times: &[f64], bodies: impl Iterator<Item = (String, Hue, &'v Vec<f64>)>) -> Vec<Mark> {
    let mut ends = vec![[0.0; 2]; times.len()];
    let mut mark = |(label, hue, values): (String, Hue, &Vec<f64>)| {
        let (mut low, mut high) = (Vec::with_capacity(values.len()), Vec::with_capacity(values.len()));
        for ([below, above], value) in ends.iter_mut().zip(values) {
            let (from, to) = if *value < 0.0 { (*below + value, *below) } else { (*above, *above + value) };
            (*below, *above) = (below.min(from), above.max(to));
            low.push(from);
            high.push(to);
        }
        Mark::Band { label, hue, opacity: 0.5, x: times.to_vec(), low, high, stacked: true }
    };
    bodies.map(&mut mark).collect()
}

fn spectrum(times: &[f64], body: &[f64]) -> Option<Figure> {
    let (frequencies, amplitudes) = amplitudes(times, body)?;
    let peak = dominant(&frequencies, &amplitudes)?;
    let marks = vec![
        Mark::line("amplitude", Hue::Body, Dash::Solid, frequencies, amplitudes),
        Mark::Limit { label: format!("dominant: {} Hz", short(peak)), at: peak, vertical: true },
    ];
    let caption = "Amplitude of the energy of the body, nominal run (Hann window; the mean is removed).";
    let said = ["energy_spectrum", "Spectrum of the energy transfer", caption];
    let axes = [Axis::linear("frequency", "Hz"), Axis::linear("amplitude", "J")];
    Some(Figure::of(FigureSection::Time, said, axes, marks))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: gains stack upward, losses downward, each with the height of its value.
    #[test]
    fn gains_and_losses_are_stacked() {
        let values = [vec![1.0, -2.0], vec![3.0, 5.0], vec![-4.0, -3.0]];
        let names = ["a", "b", "c"].map(str::to_owned);
        let marks =
            stacked(&[0.0, 1.0], names.into_iter().zip(&values).map(|(name, values)| (name, Hue::Body, values)));
        let ends: Vec<[Vec<f64>; 2]> = marks
            .into_iter()
            .map(|mark| match mark {
                Mark::Band { low, high, stacked: true, .. } => [low, high],
                _ => panic!("{mark:?}"),
            })
            .collect();
        let expected = [[[0.0, -2.0], [1.0, 0.0]], [[1.0, 0.0], [4.0, 5.0]], [[-4.0, -5.0], [0.0, -2.0]]];
        assert_eq!(ends, expected.map(|ends| ends.map(|end| end.to_vec())));
    }
}
