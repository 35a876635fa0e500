//! [`TimeTable`]: the main states of one run at some of its points, as text that fits a terminal.

use std::collections::BTreeSet;

use crate::campaign::Plan;
use crate::observables::Series;
use crate::report::number::{short, significant, trimmed};
use crate::report::over_time::figure_list::{ListedFigure, Place, Shows, Traits, figures_of};
use crate::report::text_table::{Align, TextTable};
use crate::report::wrapped::fitted;
use crate::run::StateField;
use crate::scene::Name;
use crate::storage::timeseries::{TimeColumn, TimeSeries};

/// At most this many points; the first and the last are among them.
const MOST_LINES: usize = 21;

/// Letters of the name of a phase.
const LONGEST_PHASE: usize = 10;
/// The share of the largest component of a vector, in the whole run, below which another is rounding: some hundred roundings.
const ROUNDING: f64 = 1e-14;
/// A header is shortened to this many letters, or to as many as tell it from the others.
const SHORTEST_HEADER: usize = 10;

/// How the numbers of a column are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Digits {
    Short,
    /// Six, without zeros at the end: times of a grid.
    Time,
    /// Four decimals, of numbers from -1 to 1.
    Decimals,
    Magnitude,
}

/// A column: what it shows, its name, and its numbers.
type Listed = (TimeColumn, &'static str, Digits);

/// Main columns.
const COLUMNS: [Listed; 10] = [
    (TimeColumn::Time, "time", Digits::Time),
    (TimeColumn::State(StateField::Rate, 0), "omega_x", Digits::Short),
    (TimeColumn::State(StateField::Rate, 1), "omega_y", Digits::Short),
    (TimeColumn::State(StateField::Rate, 2), "omega_z", Digits::Short),
    (TimeColumn::State(StateField::Attitude, 0), "q_es_w", Digits::Decimals),
    (TimeColumn::State(StateField::Attitude, 1), "q_es_x", Digits::Decimals),
    (TimeColumn::State(StateField::Attitude, 2), "q_es_y", Digits::Decimals),
    (TimeColumn::State(StateField::Attitude, 3), "q_es_z", Digits::Decimals),
    (TimeColumn::Series(Series::EnergyError), "energy error", Digits::Magnitude),
    (TimeColumn::Series(Series::AngularMomentumError), "ang.mom. error", Digits::Magnitude),
];

/// The same of what a control loop records.
const OF_LOOPS: [Listed; 5] = [
    (TimeColumn::Series(Series::PointingError), "pointing", Digits::Short),
    (TimeColumn::Series(Series::AttitudeEstimateError), "att.err.", Digits::Magnitude),
    (TimeColumn::Series(Series::RateEstimateError), "rate err.", Digits::Magnitude),
    (TimeColumn::Series(Series::PositionEstimateError), "pos.err.", Digits::Magnitude),
    (TimeColumn::Series(Series::VelocityEstimateError), "vel.err.", Digits::Magnitude),
];

/// The columns of scenes of `plan`: the time, those that requirements are about, then those of the figures that the scene calls for, in their order.
fn columns_of(plan: &Plan, wheels: &[Name]) -> Vec<Listed> {
    let traits = Traits::of(plan, wheels);
    let shows = |listed: &ListedFigure, column: &TimeColumn| match (listed.shows, column) {
        // of |omega| the components
        (Shows::One(Series::RateSquare), TimeColumn::State(field, _)) => *field == StateField::Rate,
        (Shows::One(series) | Shows::Estimated(series, _), TimeColumn::Series(of)) => series == *of,
        (Shows::State(of, _), TimeColumn::State(field, _)) => of == *field,
        (Shows::Balances, TimeColumn::Series(of)) => [Series::EnergyError, Series::AngularMomentumError].contains(of),
        _ => false,
    };
    let all: Vec<&'static ListedFigure> = figures_of(&traits, Place::Plot).collect();
    let (asked, others): (Vec<_>, Vec<_>) = all.into_iter().partition(|listed| listed.is_asked(&traits));
    let known = || COLUMNS[1..].iter().chain(&OF_LOOPS).copied();
    let mut found = vec![COLUMNS[0]];
    for listed in asked.into_iter().chain(others) {
        let more: Vec<_> = known().filter(|(column, ..)| shows(listed, column)).collect();
        found.extend(
            more.into_iter().filter(|more| found.iter().all(|(column, ..)| *column != more.0)).collect::<Vec<_>>(),
        );
    }
    found
}

/// The table, and what is not in it.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeTable {
    /// Two lines of headers, then one line for each point.
    pub text: String,
    pub points: usize,
    /// The columns that are too many for the width, in words; empty where none is.
    pub left_out: String,
}

impl TimeTable {
    /// The table of `series`, a run of `plan`, in lines of at most `width` letters: what the requirements are about, what the scene calls for, the phase of a
    /// loop, and the rates of as many wheels as there is space for.
    pub fn new(plan: &Plan, series: &TimeSeries, width: usize) -> Self {
        let points = shown_points(series.points());
        let column = |key: TimeColumn, name: &str, digits: Digits| -> Option<TimeTableColumn> {
            let (quantity, values) = series.column(key)?;
            let shown = plan.analysis.display.of(quantity.name(), quantity.unit());
            // what is left of components that cancel is not shown as a number
            let rounding = match key {
                TimeColumn::State(StateField::Rate, _) => ROUNDING * largest_rate(series),
                _ => 0.0,
            };
            let value = |value: f64| if value.abs() < rounding { 0.0 } else { shown.value(value) };
            let cells = points.iter().map(|point| digits.text(value(values[*point]))).collect();
            // a pure number has the end of its name where others have their unit
            let (name, below) = match name.split_once(' ').filter(|_| shown.unit.is_empty()) {
                Some((name, end)) => (name.to_owned(), end.to_owned()),
                None => (name.to_owned(), shown.unit),
            };
            Some(TimeTableColumn { name, below, cells })
        };
        let phase = series.columns().find(|(quantity, _)| quantity.name() == "phase").map(|(_, values)| {
            let name = |phase: f64| {
                let spec = plan.law.as_ref().and_then(|law| law.spec())?;
                Some(fitted(spec.phases.get(phase as usize)?.name.as_str(), LONGEST_PHASE, |text| text.chars().count()))
            };
            let text = |point: &usize| match values[*point] {
                none if none.is_nan() => String::new(),
                phase => name(phase).unwrap_or_else(|| short(phase)),
            };
            TimeTableColumn { name: "phase".to_owned(), below: String::new(), cells: points.iter().map(text).collect() }
        });
        let main = columns_of(plan, series.wheels());
        let main = main.into_iter().filter_map(|(key, name, digits)| column(key, name, digits));
        let wheels = series.wheels().iter().enumerate();
        let wheels = wheels.filter_map(|(wheel, name)| {
            column(TimeColumn::State(StateField::WheelRates, wheel), name.as_str(), Digits::Short)
        });
        let mut main: Vec<TimeTableColumn> = main.collect();
        main.splice(main.len().min(1)..main.len().min(1), phase);
        TimeTable::of(main, wheels.collect(), points.len(), width)
    }

    fn of(main: Vec<TimeTableColumn>, mut wheels: Vec<TimeTableColumn>, points: usize, width: usize) -> Self {
        let names = wheels.iter().map(|wheel| wheel.name.clone()).collect::<Vec<_>>();
        let headers = distinct(&names.iter().map(|name| format!("rate {name}")).collect::<Vec<_>>());
        wheels.iter_mut().zip(headers).for_each(|(wheel, header)| wheel.name = header);
        let table = |columns: &[&TimeTableColumn]| {
            let mut table =
                TextTable::new(columns.iter().map(|column| (column.name.as_str(), Align::Right))).spaced(0, 1);
            table.row(columns.iter().map(|column| column.below.as_str()));
            (0..points).for_each(|point| table.row(columns.iter().map(|column| column.cells[point].as_str())));
            table
        };
        let of_main = main.len();
        let all: Vec<&TimeTableColumn> = main.iter().chain(&wheels).collect();
        // the time is always shown, and wheels where all others are
        let fits = |count: &usize| table(&all[..*count]).width() <= width;
        let shown = (1..=all.len()).take_while(fits).last().unwrap_or(1).min(all.len());
        let mut left_out: Vec<String> = all[shown.min(of_main)..of_main].iter().map(|column| column.title()).collect();
        left_out.extend(of_wheels(&names[shown.saturating_sub(of_main)..], names.len()));
        TimeTable { text: table(&all[..shown]).text(width), points, left_out: left_out.join(", ") }
    }
}

/// The largest magnitude of a component of the angular velocity in the run, rad/s.
fn largest_rate(series: &TimeSeries) -> f64 {
    let of = |axis| series.column(TimeColumn::State(StateField::Rate, axis)).map_or(&[][..], |(_, values)| values);
    (0..3).flat_map(of).fold(0.0, |most: f64, value| most.max(value.abs()))
}

#[derive(Clone, Debug)]
struct TimeTableColumn {
    name: String,
    /// The second line of the header: the unit in which the numbers are.
    below: String,
    cells: Vec<String>,
}

impl TimeTableColumn {
    /// Its name where it is not shown.
    fn title(&self) -> String {
        if self.below == "error" { format!("{} error", self.name) } else { self.name.clone() }
    }
}

impl Digits {
    fn text(self, value: f64) -> String {
        match self {
            // what does not exist at this point
            _ if value.is_nan() => "-".to_owned(),
            Digits::Short => short(value),
            Digits::Time => trimmed(value, 6),
            Digits::Decimals => {
                let text = format!("{value:.4}");
                if text == "-0.0000" { "0.0000".to_owned() } else { text }
            }
            Digits::Magnitude => significant(value, 2),
        }
    }
}

/// The wheels whose rates are not shown, the last ones of `all`.
fn of_wheels(names: &[String], all: usize) -> Option<String> {
    match names {
        [] => None,
        [one] => Some(format!("rate of wheel {one}")),
        [first, .., last] => Some(format!("rates of wheels {first} to {last}, {} of {all}", names.len())),
    }
}

/// `headers` as short as they can be told apart.
fn distinct(headers: &[String]) -> Vec<String> {
    let letters = |text: &str| text.chars().count();
    let longest = headers.iter().map(|header| letters(header)).max().unwrap_or(0);
    let shortened = |width: usize| headers.iter().map(|header| fitted(header, width, letters)).collect::<Vec<_>>();
    let is_distinct = |headers: &Vec<String>| headers.iter().collect::<BTreeSet<_>>().len() == headers.len();
    (SHORTEST_HEADER..longest).map(shortened).find(is_distinct).unwrap_or_else(|| headers.to_vec())
}

/// At most [`MOST_LINES`] of `points` points, evenly distributed, with the first and the last.
fn shown_points(points: usize) -> Vec<usize> {
    let lines = points.min(MOST_LINES);
    (0..lines).map(|line| line * (points - 1) / (lines - 1).max(1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of the main columns, with numbers as long as they become, and of wheels with these names.
    fn table(names: &[&str], width: usize) -> TimeTable {
        let main = COLUMNS.map(|(_, name, digits)| TimeTableColumn {
            name: name.split(' ').next().expect("a name").to_owned(),
            below: if name.ends_with(" error") { "error" } else { "deg/s" }.to_owned(),
            cells: [0.0, -0.012_345].map(|value| digits.text(value)).to_vec(),
        });
        let wheels = names.iter().map(|name| TimeTableColumn {
            name: (*name).to_owned(),
            below: "rpm".to_owned(),
            cells: vec!["209.4".to_owned(), "-1047.2".to_owned()],
        });
        TimeTable::of(main.to_vec(), wheels.collect(), 2, width)
    }

    #[test]
    fn the_screen_shows_the_first_and_the_last_point() {
        assert_eq!(shown_points(3), [0, 1, 2]);
        assert_eq!(shown_points(1), [0]);
        assert!(shown_points(0).is_empty());
        let shown = shown_points(1201);
        assert_eq!((shown.len(), shown[0], shown[20]), (21, 0, 1200));
    }

    /// Law: no line is longer than the width, headers differ, and each column is shown or named, however many wheels there are.
    #[test]
    fn a_table_fits_its_width() {
        let names: Vec<String> = (0..8).map(|k| format!("wheel_number_{k}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        for width in [40, 80, 100, 120, 200] {
            let found = table(&names, width);
            let lines: Vec<&str> = found.text.lines().collect();
            assert_eq!(lines.len(), 4);
            assert!(lines.iter().all(|line| line.chars().count() <= width), "{width}:\n{}", found.text);
            let shown = lines[3].split_whitespace().count();
            let missing = (COLUMNS.len() + names.len()).saturating_sub(shown);
            assert_eq!(found.left_out.is_empty(), missing == 0, "{width}: {}", found.left_out);
            let wheels = shown.saturating_sub(COLUMNS.len());
            assert!((0..wheels).all(|wheel| lines[0].contains(&format!("rate...r_{wheel}"))), "{}", found.text);
            if missing > 1 {
                let count = names.len() - wheels;
                let expected = format!("rates of wheels wheel_number_{wheels} to wheel_number_7, {count} of 8");
                assert!(found.left_out.ends_with(&expected), "{width}: {}", found.left_out);
            }
        }
        let narrow = table(&[], 40).left_out;
        assert!(narrow.contains("q_es_w") && narrow.ends_with("ang.mom. error"), "{narrow}");
        assert_eq!(table(&["a", "b"], 200).left_out, "");
        assert_eq!(table(&["a", "b"], 95).left_out, "rate of wheel b");
    }

    /// Law: names that differ in one letter keep different headers.
    #[test]
    fn headers_can_be_told_apart() {
        let headers = |names: [&str; 3]| distinct(&names.map(str::to_owned));
        assert_eq!(headers(["rate a", "rate b", "rate c"]), ["rate a", "rate b", "rate c"]);
        let found = headers(["rate left_1_outer", "rate left_2_outer", "rate left_3_outer"]);
        assert_eq!(found.iter().collect::<BTreeSet<_>>().len(), 3, "{found:?}");
        assert_eq!(headers(["rate wheel_number_1", "rate wheel_number_2", "rate wheel_number_3"])[2], "rate...r_3");
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(Digits::Decimals.text(-1e-18), "0.0000");
        let all = [Digits::Short, Digits::Time, Digits::Decimals, Digits::Magnitude];
        assert_eq!(all.map(|digits| digits.text(f64::NAN)), ["-"; 4], "what does not exist is no number");
        assert_eq!([0.0, -1.234e-16].map(|value| Digits::Magnitude.text(value)), ["0", "-1.2e-16"]);
    }
}
