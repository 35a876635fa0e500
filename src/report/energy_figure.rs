//! [`energy_figure`]: energies against time, as the report's Figures 3, 4 (total and its error) and 5 (body by body).

use crate::dataset::timeseries::{TimeColumn, TimeSeries};
use crate::observables::Series;
use crate::report::plot::{Curve, Figure, Panel};

/// Energy and name of each body.
const BODIES: [(Series, &str); 4] = [
    (Series::EnergyFuselage, "fuselage"),
    (Series::EnergyWheel1, "wheel 1"),
    (Series::EnergyWheel2, "wheel 2"),
    (Series::EnergyDebris, "debris"),
];

/// A panel for the energy of each body, one for the changes of all since the start, one for the error of the total.
pub fn energy_figure(title: &str, series: &TimeSeries) -> Figure {
    let values = |key| series.column(key).map(|(_, values)| values);
    let bodies: Vec<(&str, &[f64])> =
        BODIES.into_iter().filter_map(|(energy, body)| Some((body, values(TimeColumn::Series(energy))?))).collect();
    let mut panels: Vec<Panel> = bodies
        .iter()
        .map(|(body, values)| Panel {
            title: format!("Kinetic energy, {body}"),
            unit: "J".to_owned(),
            curves: vec![Curve { label: (*body).to_owned(), values: values.to_vec() }],
        })
        .collect();
    if !bodies.is_empty() {
        let points = series.points();
        let total: Vec<f64> = (0..points).map(|k| bodies.iter().map(|(_, values)| values[k]).sum()).collect();
        panels.push(Panel {
            title: "Kinetic energy, total".to_owned(),
            unit: "J".to_owned(),
            curves: vec![Curve { label: "total".to_owned(), values: total }],
        });
        let change = |(body, values): &(&str, &[f64])| Curve {
            label: (*body).to_owned(),
            values: values.iter().map(|value| value - values[0]).collect(),
        };
        panels.push(Panel {
            title: "Exchange: change of kinetic energy since the first point".to_owned(),
            unit: "J".to_owned(),
            curves: bodies.iter().map(change).collect(),
        });
    }
    if let Some(values) = values(TimeColumn::Series(Series::EnergyError)) {
        panels.push(Panel {
            title: "Relative error of the total energy minus the work of the actuators".to_owned(),
            unit: String::new(),
            curves: vec![Curve { label: "error".to_owned(), values: values.to_vec() }],
        });
    }
    Figure {
        title: title.to_owned(),
        abscissa_label: "time / s".to_owned(),
        abscissa: values(TimeColumn::Time).map(<[f64]>::to_vec).unwrap_or_default(),
        panels,
    }
}
