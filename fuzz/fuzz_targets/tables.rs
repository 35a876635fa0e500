//! Any bytes as a table of samples (CSV or Parquet) and as a file of rows: errors, or numbers; never a panic that is not caught.

#![no_main]

use std::path::PathBuf;
use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use spindrift::campaign::{Overrides, Plan};
use spindrift::dataset::rows_reader::PartReader;
use spindrift::sampling::SampleId;

/// A campaign whose samples are the rows of a table.
const CAMPAIGN: &str = r#"
[campaign]
name = "table"
seed = 1
duration_s = 1.0
[body]
mass_kg = 10.0
center_of_mass_m = [0, 0, 0]
inertia_kg_m2 = [[2, 0, 0], [0, 3, 0], [0, 0, 4]]
includes_wheels = false
[initial]
angular_velocity_rad_s = [0.01, 1.0, 0.01]
[design]
kind = "table"
file = "FILE"
parameters = ["initial.angular_velocity_rad_s[0]"]
"#;

static FOLDER: OnceLock<PathBuf> = OnceLock::new();

fuzz_target!(
    init: {
        // the Parquet reader panics on some damaged files, which the program catches; the hook of the loop would end it before
        std::panic::set_hook(Box::new(|_| {}));
        let folder = std::env::temp_dir().join(format!("spindrift-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let _ = FOLDER.set(folder);
    },
    |data: &[u8]| {
        let folder = FOLDER.get().expect("set at the start");
        let name = if data.starts_with(b"PAR1") { "t.parquet" } else { "t.csv" };
        std::fs::write(folder.join(name), data).expect("written");
        if let Ok(plan) = Plan::from_text_in(folder, "fuzz.toml", &CAMPAIGN.replace("FILE", name), Overrides::default()) {
            let last = SampleId(plan.samples - 1);
            let _ = spindrift::campaign::draw(&plan, last);
        }
        if name == "t.parquet" && let Ok(part) = PartReader::open(&folder.join(name)) {
            let _ = part.samples();
            let _ = part.statuses();
            let _ = part.reasons();
            for column in part.names() {
                let _ = part.numbers(&column);
            }
        }
    }
);
