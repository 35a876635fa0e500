//! Retained runs: which they are follows from the rows, and their files are those of `simulate`.

use std::collections::BTreeSet;
use std::fs;
use std::num::NonZeroUsize;

use spindrift::campaign::{Overrides, Plan};
use spindrift::dataset::rows_reader::RowsReader;
use spindrift::dataset::trajectories::{file_name, retained, sample_of, save};
use spindrift::math::Isa;
use spindrift::run::Status;
use spindrift::sampling::SampleId;

use super::small_campaign::{NEGATIVE_WALLS, campaign, folder};
use crate::support::scratch_folder::ScratchFolder;

/// A third of the samples is not physical, and one in some runs needs more steps than it may make.
fn file(retain: &str) -> String {
    let few_steps = campaign().replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 28");
    format!("{few_steps}{NEGATIVE_WALLS}\n[retain]\ntrajectories = \"{retain}\"\n")
}

fn plan(retain: &str) -> Plan {
    Plan::from_text("small.toml", &file(retain), Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn rows(scratch: &ScratchFolder) -> RowsReader {
    RowsReader::new(scratch.part_files("r"))
}

/// Sample, status and maximum energy error of every row.
fn all(reader: &RowsReader) -> Vec<(u64, Status, f64)> {
    let mut all = Vec::new();
    for part in (0..).map_while(|index| reader.part(index)) {
        let part = part.unwrap();
        let rows = part.samples().unwrap().into_iter().zip(part.statuses().unwrap());
        let errors = part.numbers("energy_error_max").unwrap();
        all.extend(rows.zip(errors).map(|((sample, status), error)| (sample.0, status, error)));
    }
    all
}

/// Law: each rule chooses the runs that it says, whatever the threads: none, all that were run, the failed, the worst by magnitude, as
/// many as asked for, without the nominal one.
#[test]
fn rules_choose_what_they_say() {
    let scratch = folder("retained");
    scratch.file("small.toml", &file("none"));
    scratch.prints("campaign small.toml --out r", 1);
    let reader = rows(&scratch);
    let all = all(&reader);
    let chosen = |retain: &str| -> Vec<u64> {
        let plan = plan(retain);
        let found = retained(&plan, &reader, None).unwrap();
        assert_eq!(found, retained(&plan, &reader, NonZeroUsize::new(1)).unwrap(), "{retain}");
        found.into_iter().map(|sample| sample.0).collect()
    };
    let those = |is_meant: &dyn Fn(&Status) -> bool| -> Vec<u64> {
        all.iter().filter(|(_, status, _)| is_meant(status)).map(|(sample, ..)| *sample).collect()
    };
    assert!(chosen("none").is_empty());
    assert_eq!(chosen("all"), those(&|status| *status != Status::InvalidSample));
    let failed = those(&|status| *status == Status::StepLimit);
    assert!(failed.len() > 3 && failed.len() < 300, "{} runs reach the limit", failed.len());
    assert_eq!(chosen("failed"), failed);
    let mut errors: Vec<(f64, u64)> = all
        .iter()
        .filter(|(sample, _, error)| *sample > 0 && !error.is_nan())
        .map(|(sample, _, error)| (-error.abs(), *sample))
        .collect();
    errors.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut worst: Vec<u64> = errors[..20].iter().map(|(_, sample)| *sample).collect();
    worst.sort_unstable();
    assert_eq!(chosen("worst:20 by energy_error_max"), worst);
    assert_eq!(chosen("worst:100000 by energy_error_max").len(), errors.len());
    let physical: BTreeSet<u64> = those(&|status| *status != Status::InvalidSample).into_iter().collect();
    let some = chosen("sample:100");
    assert!(
        some.len() < 100 && some.len() > 40 && !some.contains(&0),
        "two thirds of 100 are physical: {}",
        some.len()
    );
    assert!(some.iter().all(|sample| physical.contains(sample)));
    assert!(some.iter().any(|sample| *sample > 400), "they are not the first");
    assert_eq!(chosen("sample:599").len(), physical.len() - 1);
}

/// Law: the file of a retained run is that of `simulate --sample K --out`, byte for byte, also of a run that failed, for any number of
/// threads. Counter-test: that of another sample differs.
#[test]
fn files_are_those_of_simulate() {
    let scratch = folder("trajectories");
    let retain = "failed";
    scratch.file("small.toml", &file(retain));
    scratch.prints("campaign small.toml --out r", 1);
    let (plan, isa) = (plan(retain), Isa::best());
    let failed = retained(&plan, &rows(&scratch), None).unwrap();
    let samples: Vec<SampleId> = [0, 2].into_iter().map(SampleId).chain(failed.into_iter().take(2)).collect();
    let [one, two] = ["one", "two"].map(|name| scratch.path(name));
    for (path, threads) in [(&one, 1), (&two, 2)] {
        fs::create_dir(path).unwrap();
        save(&plan, &samples, path, isa, NonZeroUsize::new(threads)).unwrap();
    }
    let mut seen = BTreeSet::new();
    for sample in &samples {
        let name = file_name(*sample);
        assert_eq!(sample_of(&name), Some(*sample));
        let bytes = fs::read(one.join(&name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let code = i32::from(sample.0 > 2);
        scratch.prints(&format!("simulate small.toml --sample {sample} --out s.parquet"), code);
        assert!(bytes == fs::read(scratch.path("s.parquet")).unwrap(), "{name}");
        assert!(bytes == fs::read(two.join(&name)).unwrap(), "{name}, two threads");
        assert!(seen.insert(bytes), "{name} is like another");
    }
    assert_eq!(fs::read_dir(&one).unwrap().count(), samples.len());
    let refused = save(&plan, &samples, &scratch.path("missing"), isa, None).unwrap_err().to_string();
    assert!(refused.contains("missing") && refused.contains("sample-00000"), "{refused}");
}

#[test]
fn names_of_files() {
    assert_eq!(file_name(SampleId(12)), "sample-000012.parquet");
    assert_eq!(sample_of("sample-1234567.parquet"), Some(SampleId(1_234_567)));
    for other in ["sample-12.parquet", "sample-000012.csv", "part-000012.parquet", "sample-+00012.parquet"] {
        assert_eq!(sample_of(other), None, "{other}");
    }
}
