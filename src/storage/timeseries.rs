//! [`TimeSeries`]: one run as a table over time, for Parquet, CSV, the screen and the plot.
//!
//! The state table has the spacecraft's centre of mass c; the series gives the point p (the origin of F_s), as the paper's
//! state does: r_p = r_c - C_es c, v_p = v_c - C_es (omega x c).

use std::collections::HashMap;
use std::io::{self, Write};
use std::path::Path;

use parquet::errors::ParquetError;

use crate::campaign::Plan;
use crate::ensemble::SingleRun;
use crate::math::vector::{cross, dcm_from_quaternion, difference, product};
use crate::observables::Series;
use crate::run::{Quantity, StateField};
use crate::sampling::SampleId;
use crate::scene::Name;
use crate::storage::atomic;
use crate::storage::columnar::{Cells, Content, Heading, Layout, Packing};
use crate::storage::identity::provenance;
use crate::storage::table::{TableError, TableFormat, write_csv, write_number};

/// A series of the observables that is not a column here: the total is the sum of its bodies.
const LEFT_OUT: Series = Series::EnergyTotal;

/// What a column of a table over time shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeColumn {
    /// The time since the start.
    Time,
    /// A component of a state; position and velocity of the spacecraft are those of the point p.
    State(StateField, usize),
    /// A series of the observables.
    Series(Series),
    /// What a control law has recorded: the place among its quantities.
    Recorded(usize),
}

#[derive(Clone, Debug)]
pub struct TimeSeries {
    headings: Vec<Heading>,
    keys: Vec<TimeColumn>,
    columns: Vec<Vec<f64>>,
    wheels: Vec<Name>,
    origin: HashMap<String, String>,
}

impl TimeSeries {
    /// The points of `run` (sample `sample` of `plan`) that the run reached and whose time `shown` accepts.
    pub fn new(plan: &Plan, sample: SampleId, run: &SingleRun, shown: impl Fn(f64) -> bool) -> Self {
        let points: Vec<usize> = (0..run.outcome.points).filter(|point| shown(run.grid.times()[*point])).collect();
        let mut table = SeriesColumns { points: &points, headings: Vec::new(), keys: Vec::new(), columns: Vec::new() };
        let time = Quantity::new("time_s", "s", "Time since the start.");
        table.push(TimeColumn::Time, time, |point| run.grid.times()[point]);
        spacecraft(run, &mut table);
        if run.request.debris {
            debris(run, &mut table);
        }
        for (series, values) in &run.series {
            if let Some(quantity) = series.quantity(&run.request.wheels).filter(|_| *series != LEFT_OUT) {
                table.push(TimeColumn::Series(*series), quantity, |point| values[point]);
            }
        }
        let recorded = run.telemetry.held_at(run.grid.times());
        for (place, (quantity, values)) in run.telemetry.quantities.iter().zip(&recorded).enumerate() {
            table.push(TimeColumn::Recorded(place), quantity.clone(), |point| values[point]);
        }
        let mut origin = provenance(plan);
        origin.insert("spindrift.sample_id".to_owned(), sample.to_string());
        origin.insert("spindrift.status".to_owned(), run.outcome.status.name().to_owned());
        TimeSeries {
            headings: table.headings,
            keys: table.keys,
            columns: table.columns,
            wheels: run.request.wheels.to_vec(),
            origin,
        }
    }

    /// The names of the wheels that turn.
    pub fn wheels(&self) -> &[Name] {
        &self.wheels
    }

    pub fn headings(&self) -> &[Heading] {
        &self.headings
    }

    /// The column that shows `key`: what it is, and its values.
    pub fn column(&self, key: TimeColumn) -> Option<(&Quantity, &[f64])> {
        let index = self.keys.iter().position(|known| *known == key)?;
        Some((&self.headings[index].quantity, &self.columns[index]))
    }

    /// Every column, in order: what it is, and its values.
    pub fn columns(&self) -> impl Iterator<Item = (&Quantity, &[f64])> {
        self.headings.iter().map(|heading| &heading.quantity).zip(self.columns.iter().map(Vec::as_slice))
    }

    pub fn points(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Writes the table to `path`, in the format of its extension; the file is whole or absent.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn save(&self, path: &Path) -> Result<(), TableError> {
        match TableFormat::of(path)? {
            TableFormat::Csv => atomic::write(path, |file| self.write_csv(file)).map_err(TableError::Io),
            TableFormat::Parquet => atomic::write(path, |file| self.write_parquet(file)).map_err(TableError::Parquet),
        }
    }

    /// The table as a Parquet file: the bytes that [`TimeSeries::save`] writes.
    ///
    /// # Errors
    /// Where encoding fails.
    pub fn encoded(&self) -> Result<Vec<u8>, ParquetError> {
        let mut bytes = Vec::new();
        self.write_parquet(&mut bytes)?;
        Ok(bytes)
    }

    fn write_parquet<W: Write + Send>(&self, out: W) -> Result<(), ParquetError> {
        let layout = Layout::new(&self.headings, self.origin.clone(), Packing::Lz4)?;
        layout.write(out, &[], self.columns.iter().map(|column| Cells::Real(column, None)))
    }

    /// Writes the table as CSV.
    ///
    /// # Errors
    /// What `out` returns.
    pub fn write_csv(&self, out: &mut impl Write) -> io::Result<()> {
        write_csv(out, &self.headings, self.points(), |out, point| {
            self.columns.iter().enumerate().try_for_each(|(index, column)| {
                out.write_all(if index == 0 { b"" } else { b"," })?;
                write_number(out, column[point])
            })
        })
    }
}

/// A table built column by column.
struct SeriesColumns<'a> {
    points: &'a [usize],
    headings: Vec<Heading>,
    keys: Vec<TimeColumn>,
    columns: Vec<Vec<f64>>,
}

impl SeriesColumns<'_> {
    fn push(&mut self, key: TimeColumn, quantity: Quantity, value: impl Fn(usize) -> f64) {
        self.headings.push(Heading::new(quantity, Content::Real));
        self.keys.push(key);
        self.columns.push(self.points.iter().map(|point| value(*point)).collect());
    }

    /// Components of `field`; the name of a component comes before the unit.
    fn push_vector<const N: usize>(
        &mut self,
        field: StateField,
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
            let quantity = Quantity::named(name, unit.0.to_owned(), meaning.to_owned());
            self.headings.push(Heading::new(quantity, Content::Real));
            self.keys.push(TimeColumn::State(field, component));
            self.columns.push(values.iter().map(|value| value[component]).collect());
        }
    }
}

fn spacecraft(run: &SingleRun, table: &mut SeriesColumns<'_>) {
    let (states, center) = (&run.table, run.scene.mass.center);
    let rotated = |point, vector| product(dcm_from_quaternion(states.at(StateField::Attitude, point)), vector);
    table.push_vector::<3>(
        StateField::ComPosition,
        "r_po_e",
        ("m", "m"),
        "Position of p, the origin of F_s, in F_e.",
        |point| difference(states.at(StateField::ComPosition, point), rotated(point, center)),
    );
    table.push_vector::<3>(
        StateField::ComVelocity,
        "v_po_e",
        ("m/s", "m_s"),
        "Velocity of p, the origin of F_s, in F_e.",
        |point| {
            let relative = cross(states.at(StateField::Rate, point), center);
            difference(states.at(StateField::ComVelocity, point), rotated(point, relative))
        },
    );
    table.push_vector::<4>(
        StateField::Attitude,
        "q_es",
        ("", ""),
        "Attitude quaternion of the body, F_s to F_e.",
        |point| states.at(StateField::Attitude, point),
    );
    table.push_vector::<3>(
        StateField::Rate,
        "omega_se_s",
        ("rad/s", "rad_s"),
        "Angular velocity of the body, in F_s.",
        |point| states.at(StateField::Rate, point),
    );
    for (wheel, name) in run.request.wheels.iter().enumerate() {
        for (field, what, unit, suffix, meaning) in [
            (StateField::WheelAngles, "angle", "rad", "rad", "Angle of wheel {} relative to the body, unbounded."),
            (StateField::WheelRates, "rate", "rad/s", "rad_s", "Rate of wheel {} relative to the body."),
        ] {
            let meaning = meaning.replace("{}", name.as_str());
            let quantity = Quantity::named(format!("{what}_{name}_{suffix}"), unit.to_owned(), meaning);
            table.push(TimeColumn::State(field, wheel), quantity, |point| states.column(field, wheel)[point]);
        }
    }
}

fn debris(run: &SingleRun, table: &mut SeriesColumns<'_>) {
    let states = &run.table;
    table.push_vector::<3>(
        StateField::DebrisPosition,
        "r_gdo_e",
        ("m", "m"),
        "Position of the debris's centre, in F_e.",
        |point| states.at(StateField::DebrisPosition, point),
    );
    table.push_vector::<3>(
        StateField::DebrisVelocity,
        "v_gdo_e",
        ("m/s", "m_s"),
        "Velocity of the debris's centre, in F_e.",
        |point| states.at(StateField::DebrisVelocity, point),
    );
    table.push_vector::<4>(
        StateField::DebrisAttitude,
        "q_ed",
        ("", ""),
        "Attitude quaternion of the debris, F_d to F_e.",
        |point| states.at(StateField::DebrisAttitude, point),
    );
    table.push_vector::<3>(
        StateField::DebrisRate,
        "omega_de_d",
        ("rad/s", "rad_s"),
        "Angular velocity of the debris, in F_d.",
        |point| states.at(StateField::DebrisRate, point),
    );
}
