//! [`simulation_figure`]: one run over time: rates, attitude, wheel rates, momenta, energies, errors.
//!
//! The panels of the energies are the report's Figures 3 to 5 (body by body, total and its error).

use crate::observables::Series;
use crate::report::plot::{Curve, Figure, Panel};
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

/// The figure of a run with this relative tolerance, if it follows one. A state or an energy that is zero throughout, as those of a part
/// that the scene does not have, has no curve; where no wheel turns, there is no panel of the transfer of energy.
pub fn simulation_figure(title: &str, series: &TimeSeries, tolerance: Option<f64>) -> Figure {
    let curves = |columns: &[Column]| -> Vec<Curve> {
        let curve = |(key, label): &Column| {
            let values = series.column(*key)?.1.to_vec();
            values.iter().any(|value| *value != 0.0).then(|| Curve { label: (*label).to_owned(), values })
        };
        columns.iter().filter_map(curve).collect()
    };
    let panel = |title: String, unit: &str, curves: Vec<Curve>| Panel {
        title,
        unit: unit.to_owned(),
        curves,
        size: 0.0,
        has_errors: false,
        tolerance: None,
    };
    let states = STATES.map(|(title, unit, columns)| panel(title.to_owned(), unit, curves(columns)));
    let of_wheels = |key: &dyn Fn(usize) -> TimeColumn| -> Vec<Curve> {
        let curve = |(wheel, name): (usize, &Name)| {
            Some(Curve { label: format!("wheel {name}"), values: series.column(key(wheel))?.1.to_vec() })
        };
        series.wheels().iter().enumerate().filter_map(curve).collect()
    };
    let mut rates = of_wheels(&|wheel| TimeColumn::State(StateField::WheelRates, wheel));
    for (rate, name) in rates.iter_mut().zip(series.wheels()) {
        rate.label = name.to_string(); // the title says that these are wheels
    }
    let turns = rates.iter().flat_map(|rate| &rate.values).any(|rate| *rate != 0.0);
    let states = states.into_iter().chain([panel("Wheel rates".to_owned(), "rad/s", rates)]);
    let bodies: Vec<Curve> = curves(&[(TimeColumn::Series(Series::EnergyBody), "body")])
        .into_iter()
        .chain(of_wheels(&|wheel| TimeColumn::Series(Series::EnergyWheel.of_wheel(wheel))))
        .chain(curves(&[(TimeColumn::Series(Series::EnergyDebris), "debris")]))
        .collect();
    let energy = |body: &Curve| panel(format!("Kinetic energy, {}", body.label), "J", vec![body.clone()]);
    let sum = |point: usize| bodies.iter().map(|body| body.values[point]).sum();
    let total = Curve { label: "total".to_owned(), values: (0..series.points()).map(sum).collect() };
    let transfer = |body: &Curve| Curve {
        label: body.label.clone(),
        values: body.values.iter().map(|value| value - body.values[0]).collect(),
    };
    let transfers = bodies.iter().map(transfer).collect();
    let momenta = MOMENTA.map(|(title, unit, column)| panel(title.to_owned(), unit, curves(&[column])));
    let mut panels: Vec<Panel> = states.chain(momenta).chain(bodies.iter().map(energy)).collect();
    if bodies.len() > 1 {
        panels.push(panel("Kinetic energy, total".to_owned(), "J", vec![total]));
    }
    if turns {
        let size = bodies.iter().flat_map(|body| &body.values).fold(0.0, |size: f64, value| value.abs().max(size));
        let title = "Energy transfer: change of kinetic energy since the start".to_owned();
        panels.push(Panel { size, ..panel(title, "J", transfers) });
    }
    let errors = "Relative errors of the balances".to_owned();
    panels.push(Panel { has_errors: true, tolerance, ..panel(errors, "", curves(&ERRORS)) });
    panels.retain(|panel| !panel.curves.is_empty());
    Figure {
        title: title.to_owned(),
        abscissa_label: "time / s".to_owned(),
        abscissa: series.column(TimeColumn::Time).map(|(_, times)| times.to_vec()).unwrap_or_default(),
        panels,
    }
}
