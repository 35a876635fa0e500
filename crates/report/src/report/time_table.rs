//! [`time_table`]: the main states of one run at some points, fitted to a terminal.

use std::collections::BTreeSet;

use crate::campaign::Plan;
use crate::findings::number::{short, significant, trimmed};
use crate::observables::Series;
use crate::report::over_time::figure_list::{ListedFigure, Place, Shows, Traits, figures_of};
use crate::run::{Quantity, StateField};
use crate::scene::Name;
use crate::table::text::{Align, Text};
use crate::table::wrapped::fitted;
use crate::table::{Column, Content, Table, Values};

const MOST_LINES: usize = 21;

const LONGEST_PHASE: usize = 10;
/// Vector components below this share of the largest in the run are rounding errors.
const ROUNDING: f64 = 1e-14;
const SHORTEST_HEADER: usize = 10;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Digits {
    Short,
    /// Six, without trailing zeros.
    Time,
    /// Four decimals, for numbers from -1 to 1.
    Decimals,
    Magnitude,
}

/// Column of the run's table, head, format.
type Listed = (&'static str, &'static str, Digits);

const COLUMNS: [Listed; 10] = [
    ("time_s", "time", Digits::Time),
    ("omega_se_s_x_rad_s", "omega_x", Digits::Short),
    ("omega_se_s_y_rad_s", "omega_y", Digits::Short),
    ("omega_se_s_z_rad_s", "omega_z", Digits::Short),
    ("q_es_w", "q_es_w", Digits::Decimals),
    ("q_es_x", "q_es_x", Digits::Decimals),
    ("q_es_y", "q_es_y", Digits::Decimals),
    ("q_es_z", "q_es_z", Digits::Decimals),
    ("energy_error", "energy error", Digits::Magnitude),
    ("angular_momentum_error", "ang.mom. error", Digits::Magnitude),
];

const OF_LOOPS: [Listed; 5] = [
    ("pointing_error_rad", "pointing", Digits::Short),
    ("attitude_estimate_error_rad", "att.err.", Digits::Magnitude),
    ("rate_estimate_error_rad_s", "rate err.", Digits::Magnitude),
    ("relative_position_estimate_error_m", "pos.err.", Digits::Magnitude),
    ("relative_velocity_estimate_error_m_s", "vel.err.", Digits::Magnitude),
];

/// The columns of a scene: time, required ones, then those of its figures in order.
fn columns_of(plan: &Plan, wheels: &[Name]) -> Vec<Listed> {
    let traits = Traits::of(plan, wheels);
    let is_of = |series: Series, name: &str| series.quantity(wheels).is_some_and(|quantity| quantity.name() == name);
    let shows = |listed: &ListedFigure, name: &str| match listed.shows {
        // components instead of |omega|
        Shows::One(Series::RateSquare) | Shows::State(StateField::Rate, _) => name.starts_with("omega_se_s_"),
        Shows::State(StateField::Attitude, _) => name.starts_with("q_es_"),
        Shows::One(series) | Shows::Estimated(series, _) => is_of(series, name),
        Shows::Drift => is_of(Series::EnergyError, name) || is_of(Series::AngularMomentumError, name),
        _ => false,
    };
    let all: Vec<&'static ListedFigure> = figures_of(&traits, Place::Plot).collect();
    let (asked, others): (Vec<_>, Vec<_>) = all.into_iter().partition(|listed| listed.is_asked(&traits));
    let known = || COLUMNS[1..].iter().chain(&OF_LOOPS).copied();
    let mut found = vec![COLUMNS[0]];
    for listed in asked.into_iter().chain(others) {
        let more: Vec<_> = known().filter(|(name, ..)| shows(listed, name)).collect();
        found
            .extend(more.into_iter().filter(|more| found.iter().all(|(name, ..)| *name != more.0)).collect::<Vec<_>>());
    }
    found
}

type Shown = (Column, Values<'static>);

/// Cells below a head and a unit.
fn shown(head: String, below: String, cells: impl Iterator<Item = String>) -> Shown {
    let quantity = Quantity::named(head, below, String::new());
    (Column { align: Align::Right, ..Column::new(quantity, Content::Word) }, Values::words(cells))
}

/// `series` of a run of `plan` at some points, in at most `width` characters: required columns, those of the scene, the
/// phase, and as many wheel rates as fit. Also names the omitted columns.
pub fn time_table(plan: &Plan, wheels: &[Name], series: &Table<'_>, width: usize) -> (Table<'static>, String) {
    let points = shown_points(series.rows());
    let column = |key: &str, name: &str, digits: Digits| -> Option<Shown> {
        let (quantity, values) = series.numbers(key)?;
        let unit = plan.analysis.display.of(quantity.name(), quantity.unit());
        let rounding = if key.starts_with("omega_se_s_") { ROUNDING * largest_rate(series) } else { 0.0 };
        let value = |value: f64| if value.abs() < rounding { 0.0 } else { unit.value(value) };
        let cells = points.iter().map(|point| digits.text(value(values[*point])));
        // the second word of the head replaces the unit of a pure number
        Some(match name.split_once(' ').filter(|_| unit.unit.is_empty()) {
            Some((name, end)) => shown(name.to_owned(), end.to_owned(), cells),
            None => shown(name.to_owned(), unit.unit.clone(), cells),
        })
    };
    let phase = series.numbers("phase").map(|(_, values)| {
        let name = |phase: f64| {
            let spec = plan.loop_spec()?;
            Some(fitted(spec.phases.get(phase as usize)?.name.as_str(), LONGEST_PHASE, |text| text.chars().count()))
        };
        let text = |point: &usize| match values[*point] {
            none if none.is_nan() => String::new(),
            phase => name(phase).unwrap_or_else(|| short(phase)),
        };
        shown("phase".to_owned(), String::new(), points.iter().map(text))
    });
    let main = columns_of(plan, wheels).into_iter();
    let mut main: Vec<Shown> = main.filter_map(|(key, name, digits)| column(key, name, digits)).collect();
    main.splice(main.len().min(1)..main.len().min(1), phase);
    let wheels = wheels.iter().map(Name::as_str);
    let wheels = wheels.filter_map(|name| column(&format!("rate_{name}_rad_s"), name, Digits::Short));
    fitting(main, wheels.collect(), width)
}

/// The columns that fit: time always, wheels only after all others; and the names of the rest.
fn fitting(main: Vec<Shown>, mut wheels: Vec<Shown>, width: usize) -> (Table<'static>, String) {
    let names: Vec<String> = wheels.iter().map(|(column, _)| column.quantity.name().to_owned()).collect();
    let headers = distinct(&names.iter().map(|name| format!("rate {name}")).collect::<Vec<_>>());
    for ((column, _), header) in wheels.iter_mut().zip(headers) {
        column.quantity = Quantity::named(header, column.quantity.unit().to_owned(), String::new());
    }
    let title = |(column, _): &Shown| match column.quantity.unit() {
        "error" => format!("{} error", column.quantity.name()),
        _ => column.quantity.name().to_owned(),
    };
    let titles: Vec<String> = main.iter().map(title).collect();
    let mut table = Table::default();
    for (column, values) in main.into_iter().chain(wheels) {
        table.push(column, values);
        if Text::of(&table).spaced(0, 1).width() > width && table.columns.len() > 1 {
            table.columns.pop();
            table.values.pop();
            break;
        }
    }
    let shown = table.columns.len();
    let mut left_out = titles[shown.min(titles.len())..].to_vec();
    left_out.extend(of_wheels(&names[shown.saturating_sub(titles.len())..], names.len()));
    (table, left_out.join(", "))
}

/// Largest component of the angular velocity in the run, rad/s.
fn largest_rate(series: &Table<'_>) -> f64 {
    let of = |axis| series.numbers(&format!("omega_se_s_{axis}_rad_s")).map_or(&[][..], |(_, values)| values);
    ["x", "y", "z"].into_iter().flat_map(of).fold(0.0, |most: f64, value| most.max(value.abs()))
}

impl Digits {
    fn text(self, value: f64) -> String {
        match self {
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

/// The omitted wheels, the last ones of `all`.
fn of_wheels(names: &[String], all: usize) -> Option<String> {
    match names {
        [] => None,
        [one] => Some(format!("rate of wheel {one}")),
        [first, .., last] => Some(format!("rates of wheels {first} to {last}, {} of {all}", names.len())),
    }
}

/// Shortens `headers` as far as they stay distinct.
fn distinct(headers: &[String]) -> Vec<String> {
    let letters = |text: &str| text.chars().count();
    let longest = headers.iter().map(|header| letters(header)).max().unwrap_or(0);
    let shortened = |width: usize| headers.iter().map(|header| fitted(header, width, letters)).collect::<Vec<_>>();
    let is_distinct = |headers: &Vec<String>| headers.iter().collect::<BTreeSet<_>>().len() == headers.len();
    (SHORTEST_HEADER..longest).map(shortened).find(is_distinct).unwrap_or_else(|| headers.to_vec())
}

/// At most [`MOST_LINES`] of `points` points, evenly spaced, with both ends.
fn shown_points(points: usize) -> Vec<usize> {
    let lines = points.min(MOST_LINES);
    (0..lines).map(|line| line * (points - 1) / (lines - 1).max(1)).collect()
}
