//! Figures of what happened over time: the nominal run, bands of the ensemble, energy transfer.

use crate::ensemble::SingleRun;
use crate::observables::Series;
use crate::observables::request::NutationAxis;
use crate::report::figure::{Axis, Dash, Figure, FigureSection, Hue, Mark};
use crate::report::number::short;
use crate::report::page::envelope::{envelope, turns};
use crate::report::page::spectrum::{amplitudes, dominant};
use crate::report::relative_errors;
use crate::scene::Name;

/// Quantiles of a series over time, of the runs that are ok.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeBands {
    /// The series, as the columns of a time series name it.
    pub name: String,
    /// Times, s.
    pub times: Vec<f64>,
    /// The 5, 25, 50, 75 and 95% quantiles at these times.
    pub quantiles: [Vec<f64>; 5],
    /// How many runs they are of.
    pub runs: u64,
    /// How many of them are left at the last time: those that a mission has ended before are not.
    pub left: u64,
}

/// Curves of the nominal run.
#[derive(Clone, Copy, Debug)]
pub struct Curves<'a> {
    run: Option<&'a SingleRun>,
    bands: &'a [TimeBands],
    wheels: &'a [Name],
}

/// Angles that are rounding, rad: some hundred roundings of a turn.
const NO_ANGLE_RAD: f64 = 1e-12;
/// The fraction of the width of the bands from which on a swing is seen beside them.
const SEEN_SWING: f64 = 0.05;

/// A series with the title of its figure, its quantity, and whose colour it has.
type Shown = (Series, &'static str, &'static str, Hue);

/// The series of the motion, and those that a control loop records.
const MOTION: [Shown; 10] = [
    (Series::RateSquare, "Angular rate of the body", "|omega|", Hue::Body),
    (Series::SpinAxisAngle, "Angle of s3 from its initial direction", "angle", Hue::Body),
    (Series::Nutation, "Nutation angle: s3 from the angular momentum", "angle", Hue::Body),
    (Series::FromNominal, "Attitude relative to the nominal run", "angle", Hue::Body),
    (Series::DebrisDirection, "Angle between s3 and the line to the debris", "angle", Hue::Debris),
    (Series::PointingError, "Pointing error", "angle", Hue::Body),
    (Series::AttitudeEstimateError, "Error of the estimated attitude", "angle", Hue::Body),
    (Series::RateEstimateError, "Error of the estimated angular velocity", "rate", Hue::Body),
    (Series::PositionEstimateError, "Error of the estimated position relative to the debris", "distance", Hue::Debris),
    (Series::VelocityEstimateError, "Error of the estimated velocity relative to the debris", "speed", Hue::Debris),
];

impl<'a> Curves<'a> {
    /// Of the nominal run, where it could be run, and bands of the ensemble; `wheels` are those that turn.
    pub fn new(run: Option<&'a SingleRun>, bands: &'a [TimeBands], wheels: &'a [Name]) -> Self {
        Curves { run, bands, wheels }
    }

    /// Times that the nominal run reached, s.
    pub fn times(&self) -> Vec<f64> {
        self.run.map_or_else(Vec::new, |run| run.grid.times()[..run.outcome.points.min(run.grid.points())].to_vec())
    }

    /// A series of the nominal run; empty where it has none.
    pub fn nominal(&self, series: Series) -> Vec<f64> {
        let Some(run) = self.run else { return Vec::new() };
        let values = run.series.iter().find(|(other, _)| *other == series).map(|(_, values)| values.as_slice());
        let values = values.unwrap_or_default();
        values[..values.len().min(run.outcome.points)].to_vec()
    }

    fn band(&self, name: &str) -> Option<&'a TimeBands> {
        self.bands.iter().find(|bands| bands.name == name)
    }

    /// Bands and median of the quantity `name`, and its values in the nominal run; `of` comes before the names in the legend.
    fn marks(&self, name: &str, nominal: Vec<f64>, hue: Hue, of: &str) -> Vec<Mark> {
        let label = |text: &str| if of.is_empty() { text.to_owned() } else { format!("{of}, {text}") };
        let mut marks = Vec::new();
        if let Some(bands) = self.band(name) {
            let [p05, p25, p50, p75, p95] = &bands.quantiles;
            let area = |text: &str, low: &Vec<f64>, high: &Vec<f64>, opacity| Mark::Band {
                label: label(text),
                hue,
                opacity,
                x: bands.times.clone(),
                low: low.clone(),
                high: high.clone(),
                stacked: false,
            };
            marks.push(area("5 to 95%", p05, p95, 0.15));
            marks.push(area("25 to 75%", p25, p75, 0.3));
            let (x, y) = (bands.times.clone(), p50.clone());
            marks.push(Mark::Line { label: label("median"), hue, dash: Dash::Solid, x, y });
        }
        let floor = if name.ends_with("_rad") { NO_ANGLE_RAD } else { 0.0 };
        if nominal.iter().any(|value| value.abs() > floor) {
            let (hue, dash) = if marks.is_empty() { (hue, Dash::Solid) } else { (Hue::Nominal, Dash::Dashed) };
            let times = self.times();
            marks.push(match envelope(&times, &nominal) {
                Some([x, low, high]) => {
                    let label = label("nominal run, its envelope");
                    Mark::Band { label, hue, opacity: 0.4, x, low, high, stacked: false }
                }
                None => Mark::Line { label: label("nominal run"), hue, dash, x: times, y: nominal },
            });
        }
        marks
    }

    /// What the bands of a quantity mean.
    fn caption(&self, name: &str) -> String {
        let Some(bands) = self.band(name) else { return "The nominal run.".to_owned() };
        let points = self.run.map_or(0, |run| run.grid.points());
        let swings = self.run.and_then(|run| {
            let wheels = self.wheels;
            let of = |series: &&(Series, Vec<f64>)| {
                series.0.quantity(wheels).is_some_and(|quantity| quantity.name() == name)
            };
            let ends = |values: &[f64]| {
                values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
            };
            let swing = |values: &[f64]| {
                let [low, high] = ends(values);
                high - low
            };
            run.series.iter().find(of).map(|(_, values)| (turns(values), swing(values)))
        });
        let width =
            bands.quantiles[0].iter().zip(&bands.quantiles[4]).map(|(low, high)| high - low).fold(0.0, f64::max);
        let is_seen = swings.is_some_and(|(turns, swing)| turns + 1 >= bands.times.len() && swing > SEEN_SWING * width);
        let aliased = if is_seen && points > bands.times.len() {
            format!(
                " The nominal run turns back more often than there are times with bands ({}): what the bands do in between is not seen; more [bands] points show it.",
                bands.times.len()
            )
        } else {
            String::new()
        };
        let left = if bands.left < bands.runs {
            format!(" A run leaves the bands where its mission ends: {} are left at the last time.", bands.left)
        } else {
            String::new()
        };
        format!(
            "Bands: 5 to 95% and 25 to 75% of {} dispersed runs that were computed, at each of {} times; solid line: median; dashed: nominal run.{left}{aliased}",
            bands.runs,
            bands.times.len()
        )
    }

    fn name(&self, series: Series) -> (String, String) {
        let quantity = series.quantity(self.wheels);
        quantity.map_or_else(Default::default, |quantity| (quantity.name().to_owned(), quantity.unit().to_owned()))
    }

    /// Every figure of the section.
    pub fn figures(&self) -> Vec<Figure> {
        // the nominal run does not differ from itself
        let is_shown =
            |(series, ..): &&Shown| *series != Series::FromNominal || self.band(&self.name(*series).0).is_some();
        let mut figures: Vec<Figure> = MOTION.iter().filter(is_shown).map(|shown| self.single(shown)).collect();
        figures.extend(self.of_wheels(Series::WheelSpeed, "Speed", "speed"));
        figures.extend(self.of_wheels(Series::MotorTorque, "Torque", "torque"));
        figures.extend(self.energies());
        figures.extend(self.transfer());
        figures
    }

    fn single(&self, (series, title, quantity, hue): &Shown) -> Figure {
        let (name, unit) = self.name(*series);
        let mut marks = self.marks(&name, self.nominal(*series), *hue, "");
        if unit == "rad" && marks.iter().all(|mark| mark.largest() < NO_ANGLE_RAD) {
            // an angle below rounding is none
            marks.clear();
        }
        let axis = self.run.map(|run| run.request.nutation_axis).filter(|_| *series == Series::Nutation);
        let title = match axis {
            Some(NutationAxis::Principal) => "Nutation angle: the principal axis nearest s3 from the angular momentum",
            Some(NutationAxis::Along(_)) => "Nutation angle: observe.nutation_axis from the angular momentum",
            _ => *title,
        };
        over_time(&name, title, self.caption(&name), Axis::linear(*quantity, &unit).showing(&name), marks)
    }

    /// The figure of `series` for each wheel.
    fn of_wheels(&self, series: Series, title: &str, quantity: &str) -> Vec<Figure> {
        let figure = |(index, wheel): (usize, &Name)| {
            let (name, unit) = self.name(series.of_wheel(index));
            let marks = self.marks(&name, self.nominal(series.of_wheel(index)), Hue::Wheel(index), "");
            over_time(
                &name,
                &format!("{title} of wheel {wheel}"),
                self.caption(&name),
                Axis::linear(quantity, &unit).showing(&name),
                marks,
            )
        };
        self.wheels.iter().enumerate().map(figure).collect()
    }

    /// The energy of each body, and its change about the spacecraft's centre of mass.
    fn energies(&self) -> Vec<Figure> {
        let bodies = || {
            let wheels = self.wheels.iter().enumerate();
            let wheels = wheels.map(|(index, name)| (Some(index), format!("wheel {name}"), Hue::Wheel(index)));
            std::iter::once((None, "the body".to_owned(), Hue::Body)).chain(wheels)
        };
        let place =
            |series: [Series; 2], wheel: Option<usize>| wheel.map_or(series[0], |wheel| series[1].of_wheel(wheel));
        let energy = |(wheel, of, hue): (Option<usize>, String, Hue)| {
            let series = place([Series::EnergyBody, Series::EnergyWheel], wheel);
            let (name, unit) = self.name(series);
            let marks = self.marks(&name, self.nominal(series), hue, "");
            let caption = format!("Kinetic energy in F_e. {}", self.caption(&name));
            over_time(&name, &format!("Energy of {of}"), caption, Axis::linear("energy", &unit), marks)
        };
        let change = |(wheel, of, hue): (Option<usize>, String, Hue)| {
            let series = place([Series::ComBody, Series::ComWheel], wheel);
            let (name, unit) = self.name(series);
            let name = name.replace("energy_com_", "exchange_");
            // without bands the figure of all bodies together shows as much
            let has_bands = self.band(&name).is_some();
            let marks = if has_bands { self.marks(&name, changes(&self.nominal(series)), hue, "") } else { Vec::new() };
            let caption =
                format!("Change of kinetic energy about the spacecraft's centre of mass. {}", self.caption(&name));
            over_time(
                &name,
                &format!("Energy transfer of {of}"),
                caption,
                Axis::linear("change of energy", &unit),
                marks,
            )
        };
        let (debris, unit) = self.name(Series::EnergyDebris);
        let debris = over_time(
            &debris,
            "Energy of the debris",
            format!("Kinetic energy in F_e. {}", self.caption(&debris)),
            Axis::linear("energy", &unit),
            self.marks(&debris, self.nominal(Series::EnergyDebris), Hue::Debris, ""),
        );
        let transfer = bodies().filter(|_| !self.wheels.is_empty()).map(change);
        bodies().map(energy).chain([debris]).chain(transfer).collect()
    }

    /// Energy transfer between body and wheels in the nominal run: over time, as a phase plot, and its spectrum.
    fn transfer(&self) -> Vec<Figure> {
        let (times, body) = (self.times(), changes(&self.nominal(Series::ComBody)));
        let wheels: Vec<Vec<f64>> =
            (0..self.wheels.len()).map(|index| changes(&self.nominal(Series::ComWheel.of_wheel(index)))).collect();
        if body.len() < 2 || wheels.is_empty() || is_constant(&body) {
            return Vec::new();
        }
        let named = || self.wheels.iter().enumerate().zip(&wheels);
        let bodies = named().map(|((index, name), y)| (format!("wheel {name}"), Hue::Wheel(index), y));
        let mut marks = stacked(&times, bodies.chain([("body".to_owned(), Hue::Body, &body)]));
        // how far other runs are from the nominal one
        if let Some(bands) = self.band("exchange_body_j") {
            for (label, quantile) in [("body, 5% of runs", 0), ("body, 95% of runs", 4)] {
                let (x, y) = (bands.times.clone(), bands.quantiles[quantile].clone());
                marks.push(Mark::Line { label: label.to_owned(), hue: Hue::Body, dash: Dash::Dashed, x, y });
            }
        }
        let change = || Axis::linear("change of energy", "J");
        let caption = "Change of kinetic energy about the centre of mass since the start, of the nominal run: gains are on top of each other above \
                       zero, losses below. Without motor torque and thrust both heights are equal at all times.";
        let transfer = over_time(
            "energy_transfer",
            "Energy transfer between wheels and body",
            caption.to_owned(),
            change(),
            marks,
        );

        let phase = named().map(|((index, name), y)| Mark::Line {
            label: format!("wheel {name}"),
            hue: Hue::Wheel(index),
            dash: Dash::Solid,
            x: body.clone(),
            y: y.clone(),
        });
        let phase = Figure {
            name: "energy_phase".to_owned(),
            section: FigureSection::Time,
            title: "Energy of each wheel against that of the body".to_owned(),
            caption: "Changes since the start, nominal run: a straight line of slope -1 is a transfer between this wheel and the body alone."
                .to_owned(),
            columns: 6,
            is_over_time: false,
            x: Axis::linear("change of energy of the body", "J"),
            y: Axis::linear("change of energy of the wheel", "J"),
            marks: phase.collect(),
        };
        [transfer, phase].into_iter().chain(spectrum(&times, &body)).collect()
    }

    /// Drift of the balances over time: relative errors, with the tolerance, of a method that follows one, and the rounding of doubles.
    pub fn drift(&self, tolerance: Option<f64>) -> Vec<Figure> {
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
                self.caption(&self.name(list[0].0).0)
            );
            Figure { section: FigureSection::Numerics, ..over_time(name, title, caption, axis, marks) }
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

fn over_time(name: &str, title: &str, caption: String, y: Axis, marks: Vec<Mark>) -> Figure {
    Figure {
        name: name.to_owned(),
        section: FigureSection::Time,
        title: title.to_owned(),
        caption,
        columns: 6,
        is_over_time: true,
        x: Axis::linear("time", "s"),
        y,
        marks,
    }
}

/// The values of several bodies on top of each other: positive ones above zero, negative ones below.
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

/// Differences from the first value.
fn changes(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| value - values[0]).collect()
}

fn is_constant(values: &[f64]) -> bool {
    values.iter().all(|value| *value == values[0])
}

/// The spectrum of the energy of the body, with its dominant frequency.
fn spectrum(times: &[f64], body: &[f64]) -> Option<Figure> {
    let (frequencies, amplitudes) = amplitudes(times, body)?;
    let peak = dominant(&frequencies, &amplitudes)?;
    let marks = vec![
        Mark::Line { label: "amplitude".to_owned(), hue: Hue::Body, dash: Dash::Solid, x: frequencies, y: amplitudes },
        Mark::Limit { label: format!("dominant: {} Hz", short(peak)), at: peak, vertical: true },
    ];
    Some(Figure {
        name: "energy_spectrum".to_owned(),
        section: FigureSection::Time,
        title: "Spectrum of the energy transfer".to_owned(),
        caption: "Amplitude of the energy of the body, nominal run (Hann window; the mean is removed).".to_owned(),
        columns: 6,
        is_over_time: false,
        x: Axis::linear("frequency", "Hz"),
        y: Axis::linear("amplitude", "J"),
        marks,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: what a body has gained is above zero.
    #[test]
    fn a_gain_is_positive() {
        assert_eq!(changes(&[2.0, 5.0, 1.0]), [0.0, 3.0, -1.0]);
    }

    /// Law: a curve of the drift has the name of its quantity.
    #[test]
    fn drifts_have_their_names() {
        let series = [Series::AngularMomentumError, Series::LinearMomentumError];
        let curves = Curves::new(None, &[], &[]);
        let band = |(k, series): (usize, &Series)| TimeBands {
            name: curves.name(*series).0,
            times: vec![0.0, 1.0],
            quantiles: [1, 2, 3, 4, 5].map(|p| vec![0.0, f64::from(p) * (1.0 + k as f64)]),
            runs: 9,
            left: 9,
        };
        let bands: Vec<TimeBands> = series.iter().enumerate().map(band).collect();
        let figures = Curves::new(None, &bands, &[]).drift(None);
        let figure = figures.iter().find(|figure| figure.name == "drift_momentum").expect("the figure");
        for (word, median) in [("angular", 3.0), ("linear", 6.0)] {
            let label = format!("{word}, median");
            let mark = figure.marks.iter().find(|mark| mark.legend() == label).expect("its median");
            assert!(matches!(mark, Mark::Line { y, .. } if y[1] == median), "{mark:?}");
        }
    }

    /// Law: gains are on top of each other, losses below each other, and the height of each is its value.
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
