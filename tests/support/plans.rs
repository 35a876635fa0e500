//! Campaigns run in memory: rows by column name.

use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::{Ensemble, Parts, Rows, Sink, Supervision, run};
use spindrift::math::Isa;
use spindrift::run::Status;

/// The files of the shipped campaigns.
pub fn files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files
}

/// The shipped campaign `name`, with other samples where asked for.
pub fn shipped(name: &str, samples: Option<u64>) -> Plan {
    shipped_with(name, samples, "")
}

/// The same with more tables.
pub fn shipped_with(name: &str, samples: Option<u64>, tables: &str) -> Plan {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns");
    let text = std::fs::read_to_string(folder.join(format!("{name}.toml"))).expect("a shipped campaign") + tables;
    let overrides = Overrides { samples, ..Overrides::default() };
    Plan::from_text_in(&folder, name, &text, overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// A wheel of `spin_sweep` that is sometimes impossible.
pub const SOMETIMES_IMPOSSIBLE: &str =
    "\n[[disperse]]\nparameter = \"wheels.w2.length_m\"\ndistribution = \"uniform\"\nmin = -0.05\nmax = 0.1\n";

/// The rows of a campaign, in the order of samples.
pub struct Table {
    names: Vec<String>,
    pub statuses: Vec<Status>,
    /// Column by column.
    values: Vec<Vec<f64>>,
}

impl Table {
    /// The observables called `name`, sample by sample; `None` where the campaign has no such column.
    pub fn find(&self, name: &str) -> Option<&[f64]> {
        self.names.iter().position(|known| *known == name).map(|place| self.values[place].as_slice())
    }

    /// The same.
    ///
    /// # Panics
    /// Where there is no such column.
    pub fn column(&self, name: &str) -> &[f64] {
        self.find(name).unwrap_or_else(|| panic!("no column {name} in {:?}", self.names))
    }

    /// Names and values of all columns.
    pub fn columns(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.names.iter().map(String::as_str).zip(self.values.iter().map(Vec::as_slice))
    }
}

#[derive(Default)]
struct Memory(Mutex<Vec<(u64, Status, Vec<f64>)>>);

impl Sink for Memory {
    type Error = Infallible;

    fn take(&self, rows: &Rows) -> Result<(), Infallible> {
        let observables = rows.shape().observables;
        let mut kept = self.0.lock().expect("no other thread panicked");
        kept.extend(rows.part().samples().enumerate().map(|(row, sample)| {
            (sample.0, rows.statuses()[row], (0..observables).map(|index| rows.observable(index)[row]).collect())
        }));
        Ok(())
    }
}

/// Runs `plan` on all cores.
pub fn rows(plan: &Plan) -> Table {
    let campaign = Ensemble::new(plan, Isa::best());
    let names = campaign.request().columns().iter().map(|column| column.quantity.name().to_owned()).collect::<Vec<_>>();
    let sink = Memory::default();
    run(&campaign, Parts::of(plan.samples), None, &sink, Supervision::progress(&|_| {})).expect("threads");
    let mut kept = sink.0.into_inner().expect("no thread panicked");
    kept.sort_by_key(|(sample, ..)| *sample);
    let values = (0..names.len()).map(|place| kept.iter().map(|(.., row)| row[place]).collect()).collect();
    Table { names, statuses: kept.iter().map(|(_, status, _)| *status).collect(), values }
}
