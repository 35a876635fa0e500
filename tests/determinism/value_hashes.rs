//! Every shipped campaign keeps its values, bit for bit: hashes of each column of its first 257 rows (of a CubeSat in
//! orbit 17) in `golden/value_hashes.json`.
//!
//! A renamed column is renamed there by hand. Any other difference is a defect, unless CHANGELOG.md records its
//! decision; then `SPINDRIFT_WRITE_HASHES=1 cargo test --release --test determinism value_hashes` writes the file.

use crate::prelude::*;

use arrow_schema::DataType;
use rayon::prelude::*;

const SAMPLES: u64 = 257;
/// Of campaigns with thousands of ticks in orbit.
const FEW_SAMPLES: u64 = 17;

const AUDITED: [&str; 3] = ["spin_sweep", "burn", "inertia"];

const FAILS: [&str; 2] = ["acceptance", "cubesat_detumble"];

const UNDECIDED: [&str; 7] =
    ["slew", "slew_closed", "net_launch", "cubesat_nadir", "cubesat_slew", "cubesat_wheel_failure", "cubesat_day"];

/// Columns that measure the machine and not the run.
const OF_THE_MACHINE: [&str; 2] = ["cpu_s", "wall_s"];

/// FNV-1a, 64 bits (RFC 9923).
struct Fnv(u64);

impl Fnv {
    fn new() -> Self {
        Fnv(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn text(&self) -> String {
        format!("{:016x}", self.0)
    }
}

fn add_values(hash: &mut Fnv, column: &dyn Array) {
    let each = |hash: &mut Fnv, value: &dyn Fn(usize) -> Vec<u8>| {
        for row in 0..column.len() {
            if column.is_null(row) { hash.add(b"null") } else { hash.add(&value(row)) }
        }
    };
    match column.data_type() {
        DataType::Float64 => {
            let values = column.as_primitive::<Float64Type>();
            each(hash, &|row| values.value(row).to_bits().to_le_bytes().to_vec());
        }
        DataType::Int64 => {
            let values = column.as_primitive::<Int64Type>();
            each(hash, &|row| values.value(row).to_le_bytes().to_vec());
        }
        DataType::Utf8 => {
            let values = column.as_string::<i32>();
            each(hash, &|row| values.value(row).as_bytes().to_vec());
        }
        other => panic!("a column of type {other}"),
    }
}

fn hashes(parts: &[RecordBatch]) -> BTreeMap<String, String> {
    let schema = parts[0].schema();
    let names = schema.fields().iter().map(|field| field.name().clone());
    let hash = |(index, name): (usize, String)| {
        let mut hash = Fnv::new();
        parts.iter().for_each(|part| add_values(&mut hash, part.column(index)));
        (name, hash.text())
    };
    names.enumerate().map(hash).filter(|(name, _)| !OF_THE_MACHINE.contains(&name.as_str())).collect()
}

fn of_nothing(audited: &[bool]) -> [String; 3] {
    let of = |is_zero: &dyn Fn(bool) -> bool| {
        let mut hash = Fnv::new();
        for audited in audited {
            hash.add(if is_zero(*audited) { &[0; 8] } else { b"null" });
        }
        hash.text()
    };
    [of(&|_| true), of(&|_| false), of(&|audited| audited)]
}

fn audited(parts: &[RecordBatch]) -> Vec<bool> {
    let of_part = |part: &RecordBatch| {
        let audit = part.column_by_name("audit_omega_error").cloned();
        (0..part.num_rows()).map(|row| audit.as_ref().is_some_and(|audit| audit.is_valid(row))).collect::<Vec<_>>()
    };
    parts.iter().flat_map(of_part).collect()
}

struct Found {
    rows: usize,
    columns: BTreeMap<String, String>,
    nothing: [String; 3],
}

fn run(scratch: &ScratchFolder, file: &Path) -> Found {
    let name = file.file_stem().unwrap().to_string_lossy().into_owned();
    let text = fs::read_to_string(file).unwrap();
    let count = if name.starts_with("cubesat") { FEW_SAMPLES } else { SAMPLES };
    let samples = if text.contains("kind = \"table\"") { String::new() } else { format!("--samples {count}") };
    let samples = format!("{samples} {}", shortened(&name));
    let audit = if AUDITED.contains(&name.as_str()) { "--audit 0.04" } else { "" };
    let campaign = file.file_name().unwrap().to_string_lossy().into_owned();
    let code = match name.as_str() {
        name if FAILS.contains(&name) => 3,
        name if UNDECIDED.contains(&name) => 5,
        _ => 0,
    };
    scratch.says("campaign", &campaign, &format!("{samples} {audit} --no-report --out {name}"), code);
    let parts = scratch.rows(&name);
    let audited = audited(&parts);
    Found { rows: audited.len(), columns: hashes(&parts), nothing: of_nothing(&audited) }
}

fn differences(
    campaign: &str,
    then: &BTreeMap<String, String>,
    now: &BTreeMap<String, String>,
    nothing: &[String; 3],
) -> Vec<String> {
    let mut wrong = Vec::new();
    for (name, hash) in then {
        match now.get(name) {
            Some(other) if other == hash => {}
            Some(other) => wrong.push(format!("{campaign}: {name} was {hash} and is {other}")),
            None if nothing.contains(hash) => {}
            None => wrong.push(format!("{campaign}: {name} is gone and was not empty")),
        }
    }
    wrong
}

#[test]
fn shipped_campaigns_keep_their_bits() {
    let golden = root().join("tests/golden/value_hashes.json");
    let scratch = ScratchFolder::new("value-hashes");
    let now: BTreeMap<String, Found> = files()
        .par_iter()
        .map(|file| (file.file_stem().unwrap().to_string_lossy().into_owned(), run(&scratch, file)))
        .collect();
    if std::env::var_os("SPINDRIFT_WRITE_HASHES").is_some() {
        let written: BTreeMap<&String, (usize, &BTreeMap<String, String>)> =
            now.iter().map(|(name, found)| (name, (found.rows, &found.columns))).collect();
        fs::write(&golden, serde_json::to_string_pretty(&written).unwrap() + "\n").unwrap();
    }
    let then: BTreeMap<String, (usize, BTreeMap<String, String>)> =
        serde_json::from_str(&fs::read_to_string(&golden).unwrap()).unwrap();
    let mut wrong = Vec::new();
    for (campaign, (rows, columns)) in &then {
        let Some(found) = now.get(campaign) else {
            wrong.push(format!("{campaign} is no longer shipped"));
            continue;
        };
        if found.rows != *rows {
            wrong.push(format!("{campaign}: {} rows, not {rows}", found.rows));
        }
        wrong.extend(differences(campaign, columns, &found.columns, &found.nothing));
    }
    assert!(wrong.is_empty(), "{} differences:\n{}", wrong.len(), wrong.join("\n"));
    assert!(then.len() >= 18, "every campaign that was shipped then: {}", then.len());
}
