//! [`Curves`]: the nominal run and the bands of the ensemble as the figures of a scene.

use std::ops::Range;

use crate::analysis::envelope::envelope;
use crate::campaign::Plan;
use crate::ensemble::SingleRun;
use crate::observables::Series;
use crate::observables::request::NutationAxis;
use crate::report::figure::{Axis, Dash, Figure, FigureSection, Hue, Mark};
use crate::report::over_time::figure_list::{ListedFigure, Place, Shows, Traits, figures_of};
use crate::report::over_time::limits;
use crate::scene::Name;

/// Quantiles of a series over time, over the ok runs.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeBands {
    pub name: String,
    pub times: Vec<f64>,
    /// The 5, 25, 50, 75 and 95% quantiles at these times.
    pub quantiles: [Vec<f64>; 5],
    pub runs: u64,
    /// Number of runs behind the quantiles: all, or the first ones.
    pub counted: u64,
    /// Runs in flight at each time, with or without a value.
    pub in_flight: Vec<u64>,
}

/// Fewest runs for a band: the 5% quantile of fewer is their minimum.
pub const FEWEST: u64 = 20;
/// The time axis ends when this share of the runs is left.
const LEFT: f64 = 0.01;

#[derive(Clone, Debug)]
pub struct Curves<'a> {
    pub(super) plan: &'a Plan,
    pub(super) run: Option<&'a SingleRun>,
    bands: &'a [TimeBands],
    pub(super) wheels: &'a [Name],
    pub(super) traits: Traits,
    place: Place,
    order: Vec<String>,
    pub(super) flown: Vec<&'a SingleRun>,
}

/// Angles below this are rounding errors, rad.
const NO_ANGLE_RAD: f64 = 1e-12;

impl<'a> Curves<'a> {
    /// For the page of `plan`: the nominal run, if it ran, and bands; `wheels` are those that turn.
    pub fn of_page(plan: &'a Plan, run: Option<&'a SingleRun>, bands: &'a [TimeBands], wheels: &'a [Name]) -> Self {
        let (traits, place) = (Traits::of(plan, wheels), Place::Page);
        Curves { plan, run, bands, wheels, traits, place, order: Vec::new(), flown: Vec::new() }
    }

    /// Puts the figures of the observables and series `asked` first.
    #[must_use]
    pub fn ordered_by(self, asked: &[String]) -> Self {
        Curves { order: asked.to_vec(), ..self }
    }

    #[must_use]
    pub fn among(self, flown: Vec<&'a SingleRun>) -> Self {
        Curves { flown, ..self }
    }

    pub fn of_plot(plan: &'a Plan, run: &'a SingleRun) -> Self {
        Curves { place: Place::Plot, ..Curves::of_page(plan, Some(run), &[], &run.request.wheels) }
    }

    pub(super) fn is_plot(&self) -> bool {
        self.place == Place::Plot
    }

    /// Times reached by the nominal run, s.
    pub fn times(&self) -> Vec<f64> {
        self.run.map_or_else(Vec::new, |run| run.grid.times()[..run.outcome.points.min(run.grid.points())].to_vec())
    }

    pub fn nominal(&self, series: Series) -> Vec<f64> {
        let Some(run) = self.run else { return Vec::new() };
        let values = run.series.iter().find(|(other, _)| *other == series).map(|(_, values)| values.as_slice());
        let values = values.unwrap_or_default();
        values[..values.len().min(run.outcome.points)].to_vec()
    }

    pub(super) fn band(&self, name: &str) -> Option<&'a TimeBands> {
        self.bands.iter().find(|bands| bands.name == name)
    }

    /// Bands, median and nominal values of the quantity `name`; `of` prefixes the labels.
    pub(super) fn marks(&self, name: &str, nominal: Vec<f64>, hue: Hue, of: &str) -> Vec<Mark> {
        let label = |text: &str| if of.is_empty() { text.to_owned() } else { format!("{of}, {text}") };
        let mut marks = Vec::new();
        if let Some(bands) = self.band(name).filter(|bands| self.is_aliased(bands, &nominal)) {
            return self.envelopes(name, bands, &nominal, hue, &label);
        }
        if let Some(bands) = self.band(name) {
            let [p05, p25, p50, p75, p95] = &bands.quantiles;
            marks.extend(areas(&label("5 to 95%"), (hue, 0.15), &bands.times, [p05, p95]));
            marks.extend(areas(&label("25 to 75%"), (hue, 0.3), &bands.times, [p25, p75]));
            marks.extend(lines(&label("median"), (hue, Dash::Solid), &bands.times, p50));
        }
        let floor = if name.ends_with("_rad") { NO_ANGLE_RAD } else { 0.0 };
        if nominal.iter().any(|value| value.abs() > floor) {
            let (hue, dash) = if marks.is_empty() { (hue, Dash::Solid) } else { (Hue::Nominal, Dash::Dashed) };
            let name = if self.is_plot() { of.to_owned() } else { label("nominal run") };
            marks.extend(self.of_run(&name, (hue, dash), &nominal));
        }
        marks
    }

    /// The values of the run; on the page, dense oscillations become their envelope.
    pub(super) fn of_run(&self, label: &str, (hue, dash): (Hue, Dash), values: &[f64]) -> Vec<Mark> {
        let times = self.times();
        let piece = |piece: Range<usize>| {
            let (x, y) = (times[piece.clone()].to_vec(), values[piece].to_vec());
            match envelope(&x, &y).filter(|_| self.place == Place::Page) {
                Some([x, low, high]) => Mark::area(format!("{label}, its envelope"), (hue, 0.4), x, [low, high]),
                None => Mark::line(label, hue, dash, x, y),
            }
        };
        pieces(times.len().min(values.len()), |point| values[point].is_finite()).into_iter().map(piece).collect()
    }

    pub(super) fn caption(&self, name: &str) -> String {
        let of = |series: &&(Series, Vec<f64>)| {
            series.0.quantity(self.wheels).is_some_and(|quantity| quantity.name() == name)
        };
        let nominal = self.run.and_then(|run| run.series.iter().find(of)).map_or(&[][..], |(_, values)| values);
        self.caption_of(name, nominal)
    }

    pub(super) fn name(&self, series: Series) -> (String, String) {
        let quantity = series.quantity(self.wheels);
        quantity.map_or_else(Default::default, |quantity| (quantity.name().to_owned(), quantity.unit().to_owned()))
    }

    pub(super) fn recorded(&self, name: &str) -> Option<Vec<f64>> {
        let telemetry = &self.run?.telemetry;
        let place = telemetry.quantities.iter().position(|quantity| quantity.name() == name)?;
        telemetry.held_at(&self.times()).into_iter().nth(place)
    }

    /// All figures of the scene, those of requirements first; empty ones are invisible.
    pub fn figures(&self) -> Vec<Figure> {
        let mut listed: Vec<&ListedFigure> = figures_of(&self.traits, self.place).collect();
        let place = |listed: &&ListedFigure| {
            let bears_on = |asked: &String| self.traits.judged(listed.judged_by).any(|name| name == *asked);
            self.order.iter().position(bears_on).unwrap_or(usize::MAX)
        };
        listed.sort_by_key(place);
        let figures = listed.into_iter().flat_map(|listed| self.listed(listed));
        figures.map(|figure| self.in_flight(figure)).collect()
    }

    /// Adds the runs in flight; the axis ends with the nominal run or when all but one in a hundred have ended.
    pub(super) fn in_flight(&self, mut figure: Figure) -> Figure {
        if let (true, [first, .., last]) = (self.is_plot() && figure.is_over_time, &self.times()[..]) {
            // common time axis for all panels
            figure.x = figure.x.within(*first, *last);
        }
        let Some(bands) = self.bands.first().filter(|_| figure.is_over_time) else { return figure };
        let runs = bands.runs as f64;
        if bands.in_flight.last().is_none_or(|left| *left == bands.runs) {
            return figure;
        }
        let counts: Vec<f64> = bands.in_flight.iter().map(|count| *count as f64).collect();
        let place = counts.iter().position(|count| *count <= LEFT * runs).unwrap_or(counts.len() - 1);
        let end = self.times().last().copied().unwrap_or(0.0).max(bands.times[place]);
        if end > 0.0 {
            figure.x = figure.x.within(0.0, end);
        }
        let (label, x) = ("runs in flight".to_owned(), bands.times.clone());
        figure.marks.push(Mark::Flight { label, x, counts, runs });
        figure
    }

    fn listed(&self, listed: &ListedFigure) -> Vec<Figure> {
        match listed.shows {
            Shows::One(series) => self.single(listed, series).into_iter().collect(),
            Shows::Estimated(series, expected) => self.estimated(listed, series, expected).into_iter().collect(),
            Shows::Wheels(series, limit) if self.traits.has_loop => vec![self.all_wheels(listed, series, limit)],
            Shows::Wheels(series, _) => self.each(listed, self.each_wheel(series), ""),
            Shows::State(field, components) => vec![self.state(listed, field, components)],
            Shows::GroundTrack => self.ground_track(listed).into_iter().collect(),
            Shows::Phases => self.phases(listed).into_iter().collect(),
            Shows::Thrust => self.thrust(listed).into_iter().collect(),
            Shows::Impulse => self.impulse(listed).into_iter().collect(),
            Shows::Propellant => self.propellant(listed).into_iter().collect(),
            Shows::Energies => self.energies(listed),
            Shows::Changes => self.changes(listed),
            Shows::Transfer => self.transfer(listed),
            Shows::Drift => self.drift(),
        }
    }

    fn single(&self, listed: &ListedFigure, series: Series) -> Option<Figure> {
        let (name, unit) = self.name(series);
        // zero by definition
        if series == Series::FromNominal && self.band(&name).is_none() {
            return None;
        }
        let mut marks = self.marks(&name, self.nominal(series), listed.hue, "");
        if unit == "rad" && marks.iter().all(|mark| mark.largest() < NO_ANGLE_RAD) {
            marks.clear();
        }
        if series == Series::DebrisDistance {
            marks.extend(self.distances(&name, &unit));
        }
        let axis = self.run.map(|run| run.request.nutation_axis).filter(|_| series == Series::Nutation);
        let title = match axis {
            Some(NutationAxis::Principal) => {
                "Nutation angle: the principal axis nearest s3 from the angular momentum".to_owned()
            }
            Some(NutationAxis::Along(axis)) => {
                let name = axis.iter().position(|component| *component == 1.0);
                let name = name.map_or("the axis of the file".to_owned(), |component| format!("s{}", component + 1));
                format!("Nutation angle: {name} from the angular momentum")
            }
            _ => listed.title.to_owned(),
        };
        let caption = self.caption(&name);
        Some(self.judged(listed, (&name, &unit), (&title, caption), marks))
    }

    /// A figure called `name` with the limits of its requirements and an axis that includes the near ones.
    pub(super) fn judged(
        &self,
        listed: &ListedFigure,
        (name, unit): (&str, &str),
        (title, caption): (&str, String),
        mut marks: Vec<Mark>,
    ) -> Figure {
        marks.extend(limits::required(self.plan, self.traits.judged(listed.judged_by), unit));
        let shown_as = self.shown_as(listed, name);
        if let Some([low, high]) = limits::decades(&marks) {
            let axis = Axis::log(listed.quantity, unit).showing(shown_as).within(low, high);
            return over_time(name, title, caption, axis, marks);
        }
        let axis = Axis::linear(listed.quantity, unit).showing(shown_as);
        let axis = match limits::range(&marks, self.traits.has_loop) {
            // a share is at most 1
            Some([low, high]) => axis.within(low, if listed.quantity == "share" { high.min(1.0) } else { high }),
            None => axis,
        };
        over_time(name, title, caption, axis, marks)
    }

    /// The column that determines the unit: a required one, else `name`.
    pub(super) fn shown_as(&self, listed: &ListedFigure, name: &str) -> String {
        let mut judged = self.traits.judged(listed.judged_by);
        let asked = judged.find(|one| self.plan.analysis.requirements.iter().any(|asked| asked.name() == one));
        asked.unwrap_or_else(|| name.to_owned())
    }

    /// A figure for each of `bodies`: series, name, colour. `lead` begins the caption.
    pub(super) fn each(
        &self,
        listed: &ListedFigure,
        bodies: impl Iterator<Item = (Series, String, Hue)>,
        lead: &str,
    ) -> Vec<Figure> {
        let figure = |(series, of, hue): (Series, String, Hue)| {
            let (name, unit) = self.name(series);
            let marks = self.marks(&name, self.nominal(series), hue, "");
            let (title, caption) = (format!("{} of {of}", listed.title), lead.to_owned() + &self.caption(&name));
            over_time(&name, &title, caption, Axis::linear(listed.quantity, &unit).showing(&name), marks)
        };
        bodies.map(figure).collect()
    }

    pub(super) fn each_wheel(&self, series: Series) -> impl Iterator<Item = (Series, String, Hue)> {
        let wheels = self.wheels.iter().enumerate();
        wheels.map(move |(index, name)| (series.of_wheel(index), format!("wheel {name}"), Hue::Wheel(index)))
    }
}

fn pieces(count: usize, is_there: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for point in (0..count).filter(|point| is_there(*point)) {
        match found.last_mut() {
            Some(last) if last.end == point => last.end += 1,
            _ => found.push(point..point + 1),
        }
    }
    found
}

pub(super) fn lines(label: &str, (hue, dash): (Hue, Dash), x: &[f64], y: &[f64]) -> Vec<Mark> {
    let line = |piece: Range<usize>| Mark::line(label, hue, dash, x[piece.clone()].to_vec(), y[piece].to_vec());
    pieces(x.len().min(y.len()), |point| y[point].is_finite()).into_iter().map(line).collect()
}

/// An area, split at missing values.
pub(super) fn areas(label: &str, (hue, opacity): (Hue, f64), x: &[f64], [low, high]: [&Vec<f64>; 2]) -> Vec<Mark> {
    let area = |piece: Range<usize>| {
        let ends = [low, high].map(|end| end[piece.clone()].to_vec());
        Mark::area(label, (hue, opacity), x[piece].to_vec(), ends)
    };
    pieces(x.len(), |point| low[point].is_finite() && high[point].is_finite()).into_iter().map(area).collect()
}

pub(super) fn over_time(name: &str, title: &str, caption: String, y: Axis, marks: Vec<Mark>) -> Figure {
    let said = [name.to_owned(), title.to_owned(), caption];
    let figure = Figure::of(FigureSection::Time, said, [Axis::linear("time", "s"), y], marks);
    Figure { is_over_time: true, ..figure }
}
