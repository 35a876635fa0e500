//! [`simulation_figure`]: one run over time: rates, attitude, wheel rates, momenta, energies, errors.
//!
//! The panels of the energies are Figures 3 to 5 of the paper (body by body, total and its error).

use crate::observables::Series;
use crate::report::axis::ROUNDING;
use crate::report::figure::{Axis, Dash, Figure, Hue, Mark};
use crate::report::number::short;
use crate::report::relative_errors;
use crate::report::sheet::Sheet;
use crate::run::StateField;
use crate::scene::Name;
use crate::storage::timeseries::{TimeColumn, TimeSeries};

/// Column and label of a curve.
type Column = (TimeColumn, &'static str);

/// Title, unit, curves.
type States = (&'static str, &'static str, &'static [Column]);

/// Panels of states.
const STATES: [States; 4] = [
    (
        "Angular velocity of the body, in F_s",
        "rad/s",
        &[
            (TimeColumn::State(StateField::Rate, 0), "x"),
            (TimeColumn::State(StateField::Rate, 1), "y"),
            (TimeColumn::State(StateField::Rate, 2), "z"),
        ],
    ),
    (
        "Attitude quaternion of the body, F_s to F_e",
        "",
        &[
            (TimeColumn::State(StateField::Attitude, 0), "w"),
            (TimeColumn::State(StateField::Attitude, 1), "x"),
            (TimeColumn::State(StateField::Attitude, 2), "y"),
            (TimeColumn::State(StateField::Attitude, 3), "z"),
        ],
    ),
    (
        "Angular velocity of the debris, in F_d",
        "rad/s",
        &[
            (TimeColumn::State(StateField::DebrisRate, 0), "x"),
            (TimeColumn::State(StateField::DebrisRate, 1), "y"),
            (TimeColumn::State(StateField::DebrisRate, 2), "z"),
        ],
    ),
    (
        "Attitude quaternion of the debris, F_d to F_e",
        "",
        &[
            (TimeColumn::State(StateField::DebrisAttitude, 0), "w"),
            (TimeColumn::State(StateField::DebrisAttitude, 1), "x"),
            (TimeColumn::State(StateField::DebrisAttitude, 2), "y"),
            (TimeColumn::State(StateField::DebrisAttitude, 3), "z"),
        ],
    ),
];

/// Magnitudes of the momenta of the spacecraft: title, unit, curve.
const MOMENTA: [(&str, &str, Column); 2] = [
    (
        "Angular momentum about the centre of mass",
        "N m s",
        (TimeColumn::Series(Series::AngularMomentumSquare), "spacecraft"),
    ),
    ("Linear momentum in F_e", "N s", (TimeColumn::Series(Series::LinearMomentumSquare), "spacecraft")),
];

/// Relative errors of the balances.
const ERRORS: [Column; 3] = [
    (TimeColumn::Series(Series::EnergyError), "energy minus work"),
    (TimeColumn::Series(Series::LinearMomentumError), "linear momentum"),
    (TimeColumn::Series(Series::AngularMomentumError), "angular momentum"),
];

/// Label and values.
type Curve = (String, Vec<f64>);

/// The figure of a run with this relative tolerance, if it follows one. A state or an energy that is zero throughout, as those of a part
/// that the scene does not have, has no curve; where no wheel turns, there is no panel of the transfer of energy.
pub fn simulation_figure(title: String, series: &TimeSeries, tolerance: Option<f64>) -> Sheet {
    let times = series.column(TimeColumn::Time).map(|(_, times)| times.to_vec()).unwrap_or_default();
    let curves = |columns: &[Column]| -> Vec<Curve> {
        let curve = |(key, label): &Column| Some(((*label).to_owned(), series.column(*key)?.1.to_vec()));
        let found = columns.iter().filter_map(curve);
        found.filter(|(_, values)| values.iter().any(|value| *value != 0.0)).collect()
    };
    let of_wheels = |prefix: &str, key: &dyn Fn(usize) -> TimeColumn| -> Vec<Curve> {
        let curve =
            |(wheel, name): (usize, &Name)| Some((format!("{prefix}{name}"), series.column(key(wheel))?.1.to_vec()));
        series.wheels().iter().enumerate().filter_map(curve).collect()
    };
    let panel = |title: &str, unit: &str, curves: Vec<Curve>| {
        let is_alone = curves.len() == 1; // the title names it
        let mark = |(index, (label, values)): (usize, Curve)| {
            let label = if is_alone { String::new() } else { label };
            Mark::line(label, Hue::Curve(index), Dash::of_curve(index), times.clone(), values)
        };
        let marks = curves.into_iter().enumerate().map(mark).collect();
        Figure { is_over_time: true, ..Figure::new(title, Axis::linear("time", "s"), Axis::linear("", unit), marks) }
    };
    // bodies keep their colour
    let in_colors = |mut panel: Figure, hues: &mut dyn Iterator<Item = Hue>| {
        for (mark, own) in panel.marks.iter_mut().zip(hues) {
            if let Mark::Line { hue, .. } = mark {
                *hue = own;
            }
        }
        panel
    };
    let wheels = || (0..series.wheels().len()).map(Hue::Wheel);
    let mut panels: Vec<Figure> =
        STATES.iter().map(|(title, unit, columns)| panel(title, unit, curves(columns))).collect();
    let rates = of_wheels("", &|wheel| TimeColumn::State(StateField::WheelRates, wheel));
    let turns = rates.iter().flat_map(|(_, values)| values).any(|rate| *rate != 0.0);
    panels.push(in_colors(panel("Wheel rates", "rad/s", rates), &mut wheels()));
    panels.extend(MOMENTA.map(|(title, unit, column)| panel(title, unit, curves(&[column]))));
    let bodies: Vec<Curve> = curves(&[(TimeColumn::Series(Series::EnergyBody), "body")])
        .into_iter()
        .chain(of_wheels("wheel ", &|wheel| TimeColumn::Series(Series::EnergyWheel.of_wheel(wheel))))
        .chain(curves(&[(TimeColumn::Series(Series::EnergyDebris), "debris")]))
        .collect();
    let hue_of = |body: &Curve| match body.0.as_str() {
        "body" => Hue::Body,
        "debris" => Hue::Debris,
        wheel => {
            let is_it = |name: &Name| wheel.strip_prefix("wheel ") == Some(&name.to_string());
            Hue::Wheel(series.wheels().iter().position(is_it).unwrap_or(0))
        }
    };
    let energy = |body: &Curve| {
        let panel = panel(&format!("Kinetic energy, {}", body.0), "J", vec![body.clone()]);
        in_colors(panel, &mut std::iter::once(hue_of(body)))
    };
    panels.extend(bodies.iter().map(energy));
    if bodies.len() > 1 {
        let sum = |point: usize| bodies.iter().map(|(_, values)| values[point]).sum();
        let total = (0..series.points()).map(sum).collect();
        panels.push(panel("Kinetic energy, total", "J", vec![(String::new(), total)]));
    }
    if turns {
        let about_center: Vec<Curve> = curves(&[(TimeColumn::Series(Series::ComBody), "body")])
            .into_iter()
            .chain(of_wheels("wheel ", &|wheel| TimeColumn::Series(Series::ComWheel.of_wheel(wheel))))
            .collect();
        let change = |(label, values): &Curve| (label.clone(), values.iter().map(|value| value - values[0]).collect());
        let transfer = panel(
            "Energy transfer: change of kinetic energy about the centre of mass since the start",
            "J",
            about_center.iter().map(change).collect(),
        );
        let mut transfer = in_colors(transfer, &mut about_center.iter().map(hue_of));
        let size =
            about_center.iter().flat_map(|(_, values)| values).fold(0.0, |size: f64, value| value.abs().max(size));
        if transfer.marks.iter().all(|mark| mark.largest() < ROUNDING * size) {
            // what rounding makes of constants looks constant
            transfer.y = transfer.y.within(-100.0 * ROUNDING * size, 100.0 * ROUNDING * size);
        }
        panels.push(transfer);
    }
    let mut errors = panel("Relative errors of the balances", "", curves(&ERRORS));
    let largest = errors.marks.iter().map(Mark::largest).fold(0.0, f64::max);
    errors.title += &format!(" (maximum {})", short(largest));
    errors.y = relative_errors::limited(&mut errors.marks, tolerance, true);
    panels.push(errors);
    panels.retain(Figure::is_visible);
    if panels.len() % 2 == 1
        && let Some(last) = panels.last_mut()
    {
        last.columns = 12;
    }
    let width = if panels.len() > 1 { 1280.0 } else { 720.0 };
    Sheet { title, width, panel_height: 320.0, has_common_legend: false, panels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::{Overrides, Plan};
    use crate::ensemble::SingleRun;
    use crate::math::Isa;
    use crate::sampling::SampleId;

    /// Law: every curve is the column that its panel and its label name: states and energies as they are, their sum, and changes that are zero
    /// at the start and in balance throughout.
    #[test]
    fn curves_are_their_columns() {
        let text = include_str!("../../campaigns/spin_sweep.toml");
        let plan = Plan::from_text("spin_sweep", text, Overrides::default()).expect("valid");
        let run = SingleRun::new(&plan, SampleId(0), plan.grid.clone(), Isa::best()).expect("a run");
        let series = TimeSeries::new(&plan, SampleId(0), &run, |_| true);
        let column = |name: String| -> Vec<f64> {
            let found = series.columns().find(|(quantity, _)| quantity.name() == name);
            found.unwrap_or_else(|| panic!("no column {name}")).1.to_vec()
        };
        let sum = |names: &[String]| -> Vec<f64> {
            let columns: Vec<Vec<f64>> = names.iter().cloned().map(column).collect();
            (0..series.points()).map(|point| columns.iter().map(|values| values[point]).sum()).collect()
        };
        let bodies = ["body", "w1", "w2", "debris"].map(|body| format!("energy_{body}_j"));
        let mut seen = 0;
        for panel in simulation_figure("x".to_owned(), &series, None).panels {
            let title = panel.title.split(" (").next().expect("a title").to_owned();
            let mut balance = vec![0.0; series.points()];
            for mark in &panel.marks {
                let Mark::Line { label, x, y, .. } = mark else { continue };
                assert_eq!(*x, column("time_s".to_owned()), "{title}");
                let of_wheel = label.strip_prefix("wheel ").unwrap_or(label);
                let known = match title.as_str() {
                    "Angular velocity of the body, in F_s" => column(format!("omega_se_s_{label}_rad_s")),
                    "Attitude quaternion of the body, F_s to F_e" => column(format!("q_es_{label}")),
                    "Angular velocity of the debris, in F_d" => column(format!("omega_de_d_{label}_rad_s")),
                    "Attitude quaternion of the debris, F_d to F_e" => column(format!("q_ed_{label}")),
                    "Wheel rates" => column(format!("rate_{label}_rad_s")),
                    "Kinetic energy, total" => sum(&bodies),
                    "Relative errors of the balances" => {
                        let errors = ["energy minus work", "linear momentum", "angular momentum"];
                        let names = ["energy_error", "linear_momentum_error", "angular_momentum_error"];
                        match errors.iter().position(|error| error == label) {
                            Some(place) => column(names[place].to_owned()),
                            None => continue, // the tolerance, the rounding
                        }
                    }
                    title if title.starts_with("Kinetic energy, ") => {
                        let body = title.trim_start_matches("Kinetic energy, ").trim_start_matches("wheel ");
                        column(format!("energy_{body}_j"))
                    }
                    title if title.starts_with("Energy transfer") => {
                        let values = column(format!("energy_com_{of_wheel}_j"));
                        balance.iter_mut().zip(y).for_each(|(balance, change)| *balance += change);
                        values.iter().map(|value| value - values[0]).collect()
                    }
                    _ => continue, // momenta are not columns of a file
                };
                assert_eq!(*y, known, "{label} of {title}");
                seen += 1;
            }
            let largest = panel.marks.iter().map(Mark::largest).fold(0.0, f64::max);
            assert!(balance.iter().all(|balance| balance.abs() <= 1e-6 * largest), "{title}");
        }
        assert!(seen > 20, "{seen} curves");
    }
}
