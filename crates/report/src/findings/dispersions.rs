//! The dispersions of a plan in words and numbers, for `check` and `sample`.

use crate::campaign::{Plan, SceneDraws, ShownUnit};
use crate::ensemble::drawn::{MASS_COLUMNS, Magnitude, magnitudes, mass_properties};
use crate::ensemble::{DrawnScenes, Percentiles};
use crate::findings::finding::{Finding, Kind};
use crate::findings::names::unit_of_input;
use crate::findings::number::{counted, short, trimmed, with_unit};
use crate::findings::origin::origin;
use crate::sampling::{Design, Replaced, SampleId};
use crate::table::Table;
use crate::table::text::Align;

/// Draws behind the percentiles: places the 1% and 99% within a tenth of the distribution's width.
const DRAWS: u64 = 10_000;

/// Fewer draws get a range instead of percentiles.
const FEW: u64 = 100;

fn about(sentence: String) -> Finding {
    Finding::new(Kind::Note, "dispersions", "Dispersions", sentence)
}

fn nothing() -> Vec<Finding> {
    vec![about("none: every sample is the nominal scene".to_owned())]
}

/// Distribution and nominal value of each dispersed parameter; components with one distribution share a line.
pub fn list(plan: &Plan) -> Vec<Finding> {
    let columns = plan.dispersions.columns();
    let (mut first, mut list) = (0, if columns.is_empty() { nothing() } else { Vec::new() });
    while first < columns.len() {
        let (parameter, said) = (columns[first].parameter, origin(plan, first));
        let is_alike = |index: &usize| columns[*index].parameter == parameter && origin(plan, *index) == said;
        let count = (first..columns.len()).take_while(is_alike).count();
        let of_group = &columns[first..first + count];
        let suffix = |index: usize| parameter.components()[of_group[index].component];
        let name = match count == parameter.width() {
            true => parameter.name(),
            false => format!("{}.{}", parameter.name(), (0..count).map(suffix).collect::<Vec<_>>().join(", ")),
        };
        let shown = unit_of_input(plan, first);
        let mut nominal: Vec<String> = of_group.iter().map(|one| trimmed(shown.value(one.nominal), 6)).collect();
        if nominal.iter().all(|one| *one == nominal[0]) {
            nominal.truncate(1);
        }
        let nominal = if nominal.len() == 1 { nominal.concat() } else { format!("[{}]", nominal.join(", ")) };
        // omit the unit if the distribution has it
        let (unit, ends) = (format!(" {}", shown.unit), |rest: &str| rest.is_empty() || rest.starts_with([' ', ',']));
        let is_said = said.match_indices(&unit).any(|(at, _)| ends(&said[at + unit.len()..]));
        let unit = if is_said { "" } else { unit.trim_end() };
        list.push(about(format!("  {name}  {said}, nominal {nominal}{unit}")));
        first += count;
    }
    list.extend(correlations(plan));
    list
}

/// Nominal value, percentiles and distribution of each dispersed number, from fresh draws.
pub fn drawn(plan: &Plan) -> Vec<Finding> {
    let mut percentiles = Percentiles::new(plan);
    percentiles.add(&DrawnScenes::spread(plan, DRAWS));
    of_percentiles(plan, &percentiles)
}

pub fn of_percentiles(plan: &Plan, drawn: &Percentiles) -> Vec<Finding> {
    let columns = plan.dispersions.columns();
    if columns.is_empty() {
        return nothing();
    }
    let mut list = Vec::new();
    if *plan.dispersions.design() != Design::DEFAULT {
        let dimensions = plan.dispersions.dimensions().len();
        let (design, samples) = (plan.design.name(), plan.samples);
        list.push(about(format!("design: {design}, {samples} samples, {dimensions} random dimensions")));
    }
    let of_columns = columns.iter().map(|column| column.parameter.component_name(column.component));
    let magnitudes = magnitudes(plan);
    let names: Vec<String> = of_columns.chain(magnitudes.iter().map(|magnitude| magnitude.name())).collect();
    let column_of = |magnitude: &Magnitude| columns.iter().position(|column| column.parameter == magnitude.parameter);
    let of_magnitude = |magnitude: &Magnitude| match column_of(magnitude) {
        Some(column) if magnitude.unit() == magnitude.parameter.unit() => unit_of_input(plan, column),
        _ => plan.analysis.display.of(&magnitude.name(), magnitude.unit()),
    };
    let of_columns = (0..columns.len()).map(|column| unit_of_input(plan, column));
    let units: Vec<ShownUnit> = of_columns.chain(magnitudes.iter().map(of_magnitude)).collect();
    let (what, heads, ps): (_, &[_], &[_]) = match drawn.count() < FEW {
        true => ("range", &["least", "largest"], &[0.0, 1.0]),
        false => ("percentiles", &["1%", "50%", "99%"], &[0.01, 0.5, 0.99]),
    };
    let ends = [("parameter", Align::Title), ("unit", Align::Left), ("nominal", Align::Right)].into_iter();
    let heads = ends.chain(heads.iter().map(|head| (*head, Align::Right))).chain([("distribution", Align::Sentence)]);
    let mut table = Table::with(heads);
    let percentiles = drawn.quantiles(ps);
    for row in order(plan, &magnitudes) {
        let shown = &units[row];
        let unit = if shown.unit.is_empty() { "-".to_owned() } else { shown.unit.clone() };
        let number = |value: &f64| short(shown.value(*value));
        let values = percentiles[row]
            .as_ref()
            .map_or(vec!["-".to_owned(); ps.len()], |values| values.iter().map(number).collect());
        let origin = if row < columns.len() { origin(plan, row) } else { "of the components".to_owned() };
        let cells = [names[row].clone(), unit, short(shown.value(drawn.nominal()[row]))];
        table.row(cells.into_iter().chain(values).chain([origin]));
    }
    let said = about(format!("{what} of {} (sample 0 is nominal)", counted(drawn.count(), "draw")));
    list.push(Finding { table: Some(table), ..said });
    if !drawn.is_exact() {
        let said = "percentiles of so many draws are within 0.05% of their distance from the nominal value";
        list.push(about(said.to_owned()));
    }
    list.extend(correlations(plan));
    list
}

/// Correlated parameters, and the positive semidefinite matrices that replace impossible ones.
fn correlations(plan: &Plan) -> Vec<Finding> {
    let of = |correlation: &crate::sampling::correlation::Correlation| {
        let name = |(parameter, component): &(crate::scene::Parameter, Option<usize>)| match component {
            Some(component) => parameter.component_name(*component),
            None => parameter.name().to_owned(),
        };
        about(format!("correlated: {}", correlation.parameters.iter().map(name).collect::<Vec<_>>().join(", ")))
    };
    plan.correlated.iter().map(of).chain(plan.dispersions.replaced_correlations().iter().map(nearest)).collect()
}

/// Row order of the table: columns in order, each magnitude below the last component of its parameter. Magnitudes are
/// indexed after the columns.
fn order(plan: &Plan, magnitudes: &[Magnitude]) -> Vec<usize> {
    let columns = plan.dispersions.columns();
    let mut rows = Vec::with_capacity(columns.len() + magnitudes.len());
    for (index, column) in columns.iter().enumerate() {
        rows.push(index);
        let is_last = columns[index + 1..].iter().all(|other| other.parameter != column.parameter);
        let magnitude = magnitudes.iter().position(|magnitude| magnitude.parameter == column.parameter);
        rows.extend(magnitude.filter(|_| is_last).map(|magnitude| columns.len() + magnitude));
    }
    rows
}

const SHOWN_DIGITS: usize = 6;

/// The dispersed numbers of `sample` with their nominal values. If `is_exact`, in SI units with all digits, followed by
/// the derived mass properties unless unphysical.
pub fn applied(plan: &Plan, sample: SampleId, is_exact: bool) -> Table<'static> {
    let mut draws = SceneDraws::new(plan);
    let scene = draws.scene(sample);
    let number = if is_exact { Align::Right } else { Align::Whole };
    let mut table = Table::with([Align::Left, number, Align::Whole].map(|align| ("", align)));
    for (index, (column, value)) in plan.dispersions.columns().iter().zip(draws.applied()).enumerate() {
        let shown = unit_of_input(plan, index);
        let number = |value: f64| match is_exact {
            true => format!("{value:?}"),
            false => with_unit(trimmed(shown.value(value), SHOWN_DIGITS), &shown.unit),
        };
        let nominal = format!("nominal {}", number(column.nominal));
        table.row([column.parameter.component_name(column.component), number(*value), nominal]);
    }
    let masses = scene.iter().filter(|_| is_exact).flat_map(mass_properties);
    MASS_COLUMNS.iter().zip(masses).for_each(|([name, ..], value)| table.row([name.to_string(), format!("{value:?}")]));
    table
}

fn nearest(replaced: &Replaced) -> Finding {
    let change = replaced.written.iter().flatten().zip(replaced.used.iter().flatten());
    let largest = change.fold(0.0f64, |most, (asked, used)| most.max((asked - used).abs()));
    let mut table = Table::with(replaced.names.iter().map(|_| ("", Align::Right)));
    replaced.used.iter().for_each(|row| table.row(row.iter().map(|r| format!("{r:.6}"))));
    let said = format!(
        "nearest_psd: correlations of the normal scores changed by up to {}; used for {}:",
        short(largest),
        replaced.names.join(", ")
    );
    Finding { table: Some(table), ..about(said) }
}
