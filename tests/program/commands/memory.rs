//! Memory of commands: the peak that Linux reports.
#![cfg(target_os = "linux")]

use crate::prelude::*;
use std::cell::Cell;

fn peak(scratch: &ScratchFolder, arguments: &str) -> u64 {
    let program = env!("CARGO_BIN_EXE_spindrift");
    let said = fs::File::create(scratch.0.join("said.txt")).unwrap();
    let mut command = Command::new(program);
    command.args(arguments.split_whitespace()).current_dir(&scratch.0).stdout(said.try_clone().unwrap()).stderr(said);
    let mut child = command.spawn().unwrap();
    let status = Path::new("/proc").join(child.id().to_string()).join("status");
    let mut peak = 0;
    while child.try_wait().unwrap().is_none() {
        let status = fs::read_to_string(&status).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let now = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok());
        peak = now.unwrap_or(peak);
        std::thread::sleep(Duration::from_millis(5));
    }
    peak
}

fn peaks<const N: usize>(measure: impl Fn(usize) -> u64, holds: impl Fn(&[u64; N]) -> bool) -> [u64; N] {
    let mut peaks = [0; N];
    for _ in 0..4 {
        for (command, peak) in peaks.iter_mut().enumerate() {
            *peak = (*peak).max(measure(command));
        }
        if holds(&peaks) {
            break;
        }
    }
    peaks
}

#[test]
fn sample_holds_no_draws() {
    let scratch = ScratchFolder::new("stream");
    let small = root().join("campaigns/attitude.toml");
    let small = small.display();
    let draw = |samples: u64| peak(&scratch, &format!("sample {small} --samples {samples}"));
    let is_flat = |[few, many]: &[u64; 2]| *many < few + 8_000;
    let [few, many] = peaks(|command| draw([100_000, 500_000][command]), is_flat);
    assert!(is_flat(&[few, many]), "kB: {few} for 1e5 samples, {many} for 5e5");
    assert!(scratch.text("said.txt").contains("of 499999 draws"));
    let written = peak(&scratch, &format!("sample {small} --samples 400000 --out s.parquet"));
    assert!(written < few + 40_000, "kB: {written}");
    let plotted = peak(&scratch, &format!("sample {small} --samples 500000 --plot s.html"));
    assert!(plotted < few + 400_000, "kB: {plotted}");
    assert!(scratch.text("s.html").contains("first "));
}

#[test]
fn a_campaign_holds_no_rows() {
    let scratch = ScratchFolder::new("flat");
    let text = campaign_text("spin_sweep");
    assert!(text.contains("points = ") && !text.contains("[bands]"));
    fs::write(scratch.0.join("flat.toml"), text).unwrap();
    let of = |samples: u64| {
        let said = format!("campaign flat.toml --samples {samples} --threads 1 --no-report --overwrite");
        (peak(&scratch, &said), scratch.0.join("results/spin_sweep/runs").read_dir().unwrap().count())
    };
    let is_flat = |[few, many]: &[u64; 2]| *many < few + 2 * (few / 5);
    let files = Cell::new([0; 2]);
    let [few, many] = peaks(
        |command| {
            let (peak, count) = of([60_000, 120_000][command]);
            let mut counts = files.get();
            counts[command] = count;
            files.set(counts);
            peak
        },
        is_flat,
    );
    let [few_files, many_files] = files.get();
    assert!(many_files > few_files + 12, "{few_files} and {many_files} files");
    assert!(is_flat(&[few, many]), "kB: {few} for 6e4 samples, {many} for 1.2e5");
}

fn table_with_texts(path: &Path, rows: usize) {
    use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
    let schema = "message m { required double x; required binary text (UTF8); }";
    let schema = std::sync::Arc::new(parquet::schema::parser::parse_message_type(schema).unwrap());
    let zstd = parquet::basic::Compression::ZSTD(parquet::basic::ZstdLevel::default());
    // without a dictionary: one page, decompressed as a whole
    let properties = parquet::file::properties::WriterProperties::builder().set_compression(zstd);
    let properties = properties.set_dictionary_enabled(false).build();
    let file = fs::File::create(path).unwrap();
    let mut writer = parquet::file::writer::SerializedFileWriter::new(file, schema, properties.into()).unwrap();
    let mut group = writer.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    let numbers: Vec<f64> = (0..rows).map(|row| 0.25 + 1e-3 * row as f64).collect();
    column.typed::<DoubleType>().write_batch(&numbers, None, None).unwrap();
    column.close().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    let text = ByteArray::from("a".repeat(1_000_000).into_bytes());
    column.typed::<ByteArrayType>().write_batch(&vec![text; rows], None, None).unwrap();
    column.close().unwrap();
    group.close().unwrap();
    writer.close().unwrap();
}

/// Address space of a command on a small file, kB.
const LIMIT_KB: u64 = 150_000;

#[test]
fn small_files_take_little_memory() {
    let scratch = ScratchFolder::new("bombs");
    let text = campaign_text("spin_sweep");
    let at = text.find("[[disperse]]").unwrap();
    let says = |file: &str, column: &str, code: i32| {
        let draw = format!(
            "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"empirical\"\nfile = \"{file}\"\ncolumn \
            = \"{column}\"\n"
        );
        fs::write(scratch.0.join("draw.toml"), format!("{}{draw}", &text[..at])).unwrap();
        let limited =
            format!("ulimit -v {LIMIT_KB}; exec {} sample draw.toml --samples 10", env!("CARGO_BIN_EXE_spindrift"));
        scratch.outputs(Command::new("sh").args(["-c", &limited]), code)
    };
    table_with_texts(&scratch.0.join("texts.parquet"), 300);
    assert!(fs::metadata(scratch.0.join("texts.parquet")).unwrap().len() < 200_000);
    fs::write(scratch.0.join("header.csv"), format!("x,{}\n0.25,0\n0.26,0\n", "a".repeat(20_000_000))).unwrap();
    for (file, column, code, expected) in [
        ("texts.parquet", "x", 0, "of 9 draws"),
        ("texts.parquet", "text", 2, "text or bytes: must be a column of finite numbers (\"text\")"),
        ("header.csv", "y", 2, "must be a file with rows of at most 1048576 bytes"),
    ] {
        let said = says(file, column, code);
        assert!(said.contains(expected), "{file} {column}: {said}");
    }
}

/// Memory of a thread for each observation point, bytes, in the estimate of a campaign, and the addition of audits.
const POINT: [u64; 2] = [8500, 7500];

/// Law: observation points take at most their estimated memory, and at least a fifth of it.
#[test]
fn memory_of_points_is_what_is_estimated() {
    let scratch = ScratchFolder::new("points");
    let burn = campaign_text("burn");
    let of = |method: &str, groups: &[Group], more: &str| {
        let mut text = String::new();
        let nominal = burn.lines().take_while(|line| !line.starts_with("[[disperse]]"));
        for line in nominal.filter(|line| !line.starts_with("groups")) {
            text += &match line.split(" = ").next() {
                Some("method") => format!("method = {method:?}\n"),
                Some("points") => {
                    let names: Vec<&str> = groups.iter().map(|group| group.name()).collect();
                    format!("points = POINTS\ngroups = {names:?}\n")
                }
                Some("duration_s") => "duration_s = 0.05\n".to_owned(),
                _ => format!("{line}\n"),
            };
        }
        assert!(text.contains("points = POINTS\n") && text.contains(&format!("method = {method:?}\n")));
        text + more
    };
    let (default, audits) = (&Group::DEFAULT[..], "\n[audit]\nfraction = 1.0\n");
    for (method, groups, more) in
        [("auto", default, ""), ("auto", &Group::ALL[..], ""), ("dop853", default, audits), ("null_space", default, "")]
    {
        let text = of(method, groups, more);
        let stated = POINT[0] + if more.is_empty() { 0 } else { POINT[1] };
        // three batches of eight lanes; an audit takes a hundred times as long, and null-space runs are not batched
        let samples = if more.is_empty() && method == "auto" { 17 } else { 3 };
        let measure = |command: usize| {
            let points: u64 = [20_001, 70_001][command];
            fs::write(scratch.0.join("burn.toml"), text.replace("POINTS", &points.to_string())).unwrap();
            peak(&scratch, &format!("campaign burn.toml --samples {samples} --threads 1 --overwrite --no-report"))
        };
        let each = |[few, many]: &[u64; 2]| many.saturating_sub(*few) * 1024 / 50_000;
        let is_stated = |each: u64| each <= stated && 5 * each >= stated;
        let each = each(&peaks(measure, |peaks| is_stated(each(peaks))));
        assert!(is_stated(each), "{method} {more:?}: {each} bytes a point, stated {stated}");
    }
}
