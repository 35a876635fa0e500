//! Any bytes as a table of samples (CSV or Parquet) and as a file of rows: errors, or numbers; never a panic that is
//! not caught.

#![no_main]

use std::path::PathBuf;
use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use spindrift::campaign::{Overrides, Plan};
use spindrift::storage::rows_reader::PartReader;
use spindrift::storage::disk::Disk;
use spindrift::sampling::SampleId;
use spindrift_fuzz::campaign;

/// The samples are the rows of a table.
const DESIGN: &str = r#"
[design]
kind = "table"
file = "FILE"
parameters = ["initial.angular_velocity_rad_s[0]"]
"#;

static FOLDER: OnceLock<PathBuf> = OnceLock::new();

fuzz_target!(
    init: {
        // the Parquet reader panics on some damaged files, which the program catches; the hook of the loop would end it
        // before
        std::panic::set_hook(Box::new(|_| {}));
        let folder = std::env::temp_dir().join(format!("spindrift-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let _ = FOLDER.set(folder);
    },
    |data: &[u8]| {
        let folder = FOLDER.get().expect("set at the start");
        let name = if data.starts_with(b"PAR1") { "t.parquet" } else { "t.csv" };
        std::fs::write(folder.join(name), data).expect("written");
        let text = campaign("name = \"table\"") + &DESIGN.replace("FILE", name);
        if let Ok(plan) = Plan::from_text_in(folder, "fuzz.toml", &text, Overrides::default()) {
            let last = SampleId(plan.samples - 1);
            let _ = spindrift::campaign::draw(&plan, last);
        }
        if name == "t.parquet" && let Ok(part) = PartReader::open(&Disk, &folder.join(name)) {
            let _ = part.samples();
            let _ = part.statuses();
            let _ = part.reasons();
            for column in part.names() {
                let _ = part.numbers(&column);
            }
        }
    }
);
