//! A run as a table over time, for Parquet, CSV, the screen and Python.
//!
//! The state table has the centre of mass c, the series the point p (origin of F_s): r_p = r_c - C_es c, v_p = v_c -
//! C_es (omega x c).

use crate::ensemble::SingleRun;
use crate::math::vector::{cross, dcm_from_quaternion, difference, product};
use crate::observables::Series;
use crate::run::{Quantity, StateField};
use crate::sampling::SampleId;
use crate::table::{Column, Content, Table, Values};

/// A series without a column here: the total is the sum of its bodies.
const LEFT_OUT: Series = Series::EnergyTotal;

/// The reached points of `run`, sample `sample`, at times accepted by `shown`.
pub fn time_series(sample: SampleId, run: &SingleRun, shown: impl Fn(f64) -> bool) -> Table<'static> {
    let points: Vec<usize> = (0..run.outcome.points).filter(|point| shown(run.grid.times()[*point])).collect();
    let mut table = SeriesColumns { points: &points, table: Table::default() };
    table.push(Quantity::new("time_s", "s", "Time since the start."), |point| run.grid.times()[point]);
    spacecraft(run, &mut table);
    if run.request.debris {
        debris(run, &mut table);
    }
    for (series, values) in &run.series {
        if let Some(quantity) = series.quantity(&run.request.wheels).filter(|_| *series != LEFT_OUT) {
            table.push(quantity, |point| values[point]);
        }
    }
    let recorded = run.telemetry.held_at(run.grid.times());
    for (quantity, values) in run.telemetry.quantities.iter().zip(&recorded) {
        table.push(quantity.clone(), |point| values[point]);
    }
    let (id, status) = (sample.to_string(), run.outcome.status.name().to_owned());
    table.table.notes.extend([("spindrift.sample_id".to_owned(), id), ("spindrift.status".to_owned(), status)]);
    table.table
}

struct SeriesColumns<'a> {
    points: &'a [usize],
    table: Table<'static>,
}

impl SeriesColumns<'_> {
    fn push(&mut self, quantity: Quantity, value: impl Fn(usize) -> f64) {
        let values: Vec<f64> = self.points.iter().map(|point| value(*point)).collect();
        self.table.push(Column::new(quantity, Content::Real), Values::Real(values.into()));
    }

    fn push_vector<const N: usize>(
        &mut self,
        stem: &str,
        unit: (&str, &str),
        meaning: &str,
        value: impl Fn(usize) -> [f64; N],
    ) {
        let names = if N == 4 { ["w", "x", "y", "z"] } else { ["x", "y", "z", ""] };
        let values: Vec<[f64; N]> = self.points.iter().map(|point| value(*point)).collect();
        for component in 0..N {
            let suffix = if unit.1.is_empty() { String::new() } else { format!("_{}", unit.1) };
            let name = format!("{stem}_{}{suffix}", names[component]);
            let values: Vec<f64> = values.iter().map(|value| value[component]).collect();
            let quantity = Quantity::named(name, unit.0.to_owned(), meaning.to_owned());
            self.table.push(Column::new(quantity, Content::Real), Values::Real(values.into()));
        }
    }
}

fn spacecraft(run: &SingleRun, table: &mut SeriesColumns<'_>) {
    let (states, center) = (&run.table, run.scene.mass.center);
    let rotated = |point, vector| product(dcm_from_quaternion(states.at(StateField::Attitude, point)), vector);
    table.push_vector::<3>("r_po_e", ("m", "m"), "Position of p, the origin of F_s, in F_e.", |point| {
        difference(states.at(StateField::ComPosition, point), rotated(point, center))
    });
    table.push_vector::<3>("v_po_e", ("m/s", "m_s"), "Velocity of p, the origin of F_s, in F_e.", |point| {
        let relative = cross(states.at(StateField::Rate, point), center);
        difference(states.at(StateField::ComVelocity, point), rotated(point, relative))
    });
    table.push_vector::<4>("q_es", ("", ""), "Attitude quaternion of the body, F_s to F_e.", |point| {
        states.at(StateField::Attitude, point)
    });
    table.push_vector::<3>("omega_se_s", ("rad/s", "rad_s"), "Angular velocity of the body, in F_s.", |point| {
        states.at(StateField::Rate, point)
    });
    for (wheel, name) in run.request.wheels.iter().enumerate() {
        for (field, what, unit, suffix, meaning) in [
            (StateField::WheelAngles, "angle", "rad", "rad", "Angle of wheel {} relative to the body, unbounded."),
            (StateField::WheelRates, "rate", "rad/s", "rad_s", "Rate of wheel {} relative to the body."),
        ] {
            let meaning = meaning.replace("{}", name.as_str());
            let quantity = Quantity::named(format!("{what}_{name}_{suffix}"), unit.to_owned(), meaning);
            table.push(quantity, |point| states.column(field, wheel)[point]);
        }
    }
}

fn debris(run: &SingleRun, table: &mut SeriesColumns<'_>) {
    let states = &run.table;
    table.push_vector::<3>("r_gdo_e", ("m", "m"), "Position of the debris's centre, in F_e.", |point| {
        states.at(StateField::DebrisPosition, point)
    });
    table.push_vector::<3>("v_gdo_e", ("m/s", "m_s"), "Velocity of the debris's centre, in F_e.", |point| {
        states.at(StateField::DebrisVelocity, point)
    });
    table.push_vector::<4>("q_ed", ("", ""), "Attitude quaternion of the debris, F_d to F_e.", |point| {
        states.at(StateField::DebrisAttitude, point)
    });
    table.push_vector::<3>("omega_de_d", ("rad/s", "rad_s"), "Angular velocity of the debris, in F_d.", |point| {
        states.at(StateField::DebrisRate, point)
    });
}
