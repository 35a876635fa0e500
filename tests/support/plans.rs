//! Campaigns run in memory: rows by column name.

use super::prelude::*;
use std::convert::Infallible;

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub fn parsed(text: &str) -> Result<Plan, CampaignError> {
    Plan::from_text("c.toml", text, Overrides::default())
}

pub fn planned(text: &str) -> Plan {
    parsed(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The text of a shipped campaign.
pub fn campaign_text(name: &str) -> String {
    std::fs::read_to_string(root().join(format!("campaigns/{name}.toml"))).unwrap()
}

/// The files of the shipped campaigns.
pub fn files() -> Vec<PathBuf> {
    let folder = root().join("campaigns");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files
}

pub fn shipped(name: &str, samples: Option<u64>) -> Plan {
    shipped_with(name, samples, "")
}

pub fn shipped_with(name: &str, samples: Option<u64>, tables: &str) -> Plan {
    let overrides = Overrides { samples, ..Overrides::default() };
    Plan::from_text_in(&root().join("campaigns"), name, &(campaign_text(name) + tables), overrides).unwrap()
}

/// A wheel of `spin_sweep` that is sometimes impossible.
pub const SOMETIMES_IMPOSSIBLE: &str =
    "\n[[disperse]]\nparameter = \"wheels.w2.length_m\"\ndistribution = \"uniform\"\nmin = -0.05\nmax = 0.1\n";

pub struct Table {
    names: Vec<String>,
    pub statuses: Vec<Status>,
    values: Vec<Vec<f64>>,
}

impl Table {
    pub fn find(&self, name: &str) -> Option<&[f64]> {
        self.names.iter().position(|known| *known == name).map(|place| self.values[place].as_slice())
    }

    /// # Panics
    /// Without such a column.
    pub fn column(&self, name: &str) -> &[f64] {
        self.find(name).unwrap_or_else(|| panic!("no column {name} in {:?}", self.names))
    }

    pub fn columns(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.names.iter().map(String::as_str).zip(self.values.iter().map(Vec::as_slice))
    }
}

pub fn seen<T: Send>(
    campaign: &Ensemble<'_>,
    threads: Option<usize>,
    see: impl Fn(&Rows, usize) -> T + Sync,
) -> Vec<(u64, T)> {
    let seen = Mutex::new(Vec::new());
    let sink = |rows: &Rows| {
        let of_row = |(row, sample): (usize, SampleId)| (sample.0, see(rows, row));
        seen.lock().unwrap().extend(rows.part().samples().enumerate().map(of_row));
        Ok::<(), Infallible>(())
    };
    let threads = threads.and_then(NonZeroUsize::new);
    run(campaign, Parts::of(campaign.plan().samples), threads, &sink, Supervision::progress(&|_| {})).unwrap();
    let mut seen = seen.into_inner().unwrap();
    seen.sort_by_key(|(sample, _)| *sample);
    seen
}

/// Status, dispersed values, observables.
pub type RowBits = (Status, Vec<u64>);

pub fn row_bits(rows: &Rows, row: usize) -> RowBits {
    let shape = rows.shape();
    let parameters = (0..shape.parameters).map(|index| rows.parameter(index)[row]);
    let observables = (0..shape.observables).map(|index| rows.observable(index)[row]);
    (rows.statuses()[row], parameters.chain(observables).map(f64::to_bits).collect())
}

pub fn rows(plan: &Plan) -> Table {
    let campaign = Ensemble::new(plan, Isa::best());
    let names = campaign.request().columns().iter().map(|column| column.quantity.name().to_owned()).collect::<Vec<_>>();
    let kept = seen(&campaign, None, |rows, row| {
        let values = (0..rows.shape().observables).map(|index| rows.observable(index)[row]);
        (rows.statuses()[row], values.collect::<Vec<f64>>())
    });
    let values = (0..names.len()).map(|place| kept.iter().map(|(_, (_, row))| row[place]).collect()).collect();
    Table { names, statuses: kept.iter().map(|(_, (status, _))| *status).collect(), values }
}

pub fn single(plan: &Plan, sample: u64) -> SingleRun {
    single_on(plan, sample, plan.grid.clone())
}

pub fn single_on(plan: &Plan, sample: u64, grid: Grid) -> SingleRun {
    SingleRun::new(plan, SampleId(sample), grid, Isa::best()).unwrap()
}

/// A number of the row of `run`.
pub fn value(run: &SingleRun, name: &str) -> f64 {
    let place = run.request.columns().iter().position(|column| column.quantity.name() == name);
    run.row[place.unwrap_or_else(|| panic!("no column {name}"))]
}

/// Settings for tests of a shipped campaign whose runs have tens of thousands of ticks.
pub fn shortened(name: &str) -> &'static str {
    match name {
        "cubesat_day" => "--set campaign.duration_s=5700",
        "cubesat_detumble" => "--set campaign.duration_s=3000",
        _ => "",
    }
}
