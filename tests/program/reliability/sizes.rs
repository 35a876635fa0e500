//! The impossible is refused with numbers before anything is written, and the long needs `--yes`.

use crate::prelude::*;

use crate::reliability::failing_store::contents;

/// Law: counts beyond any disk and memory are refused at once with rows, bytes and time.
#[test]
fn what_no_machine_can_do_is_refused() {
    let scratch = folder("sizes");
    scratch.file("points.toml", &campaign().replace("points = 11", "points = 10000000"));
    scratch.file("more.toml", &sized(1000000000000000000));
    let stop = "[stop]\nobservable = \"energy_error_max\"\nquantile = 0.5\nhalf_width = 1e-30\nmax_samples = \
        9007199254740992\n";
    scratch.file("stop.toml", &format!("{}{stop}", campaign()));
    scratch.file("precise.toml", &sized(900000000000));
    for (command, said) in [
        ("campaign small.toml --out r --samples 9007199254740992", "9.007e15 runs of small: about"),
        ("campaign small.toml --out r --samples 9007199254740992", "of files in `r`"),
        ("campaign small.toml --out r --samples 9007199254740992", "the disk has"),
        ("campaign small.toml --out r --samples 9007199254740992 --yes --overwrite", "the disk has"),
        ("campaign small.toml --out r --samples 9007199254740992 --shard 1/1000000", "of memory"),
        (
            "campaign small.toml --out r --samples 1e7",
            "must be a whole number without decimal point or exponent; write 10000000",
        ),
        (
            "campaign more.toml --out r",
            "campaign.samples = 1000000000000000000: must be a whole number from 1 to 9007199254740992",
        ),
        ("campaign points.toml --out r", "observe.points = 10000000: must be a whole number from 2 to 1000000"),
        ("sample small.toml --samples 1e7", "write 10000000"),
        ("sample small.toml --samples 9007199254740992", "that is more than 24 hours of CPU time; --yes starts it"),
        ("sample small.toml --samples 9007199254740992 --out s.csv --yes", "9.007e15 samples of small"),
        (
            "sample small.toml --samples 9007199254740992 --plot s.svg",
            "that is more than 24 hours of CPU time; --yes starts it",
        ),
        (
            "precision precise.toml --samples 9007199254740992 --out r",
            "reference solutions of 900000000000 samples of small",
        ),
        ("campaign stop.toml --out r", "with --yes it starts, and may end earlier ([stop])"),
    ] {
        let found = scratch.prints(command, 2);
        assert!(found.contains(said), "{command}: {found}");
    }
    let entries: Vec<String> =
        fs::read_dir(&scratch.0).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert!(entries.iter().all(|name| name.ends_with(".toml") || name == "campaigns"), "{entries:?}");
}

/// Law: a slip in the address of a store is refused with the right form; a folder of that name is still possible.
#[test]
fn a_slip_in_an_address_makes_no_folder() {
    let scratch = folder("addresses");
    for out in ["s3:/bucket/x", "s3:bucket/x", "S3://bucket/x", "gs:/bucket/x", "s3:"] {
        let said = scratch.small(&format!("--samples 2 --out {out}"), 2);
        assert!(said.contains("s3://bucket/name"), "{out}: {said}");
    }
    assert!(fs::read_dir(&scratch.0).unwrap().all(|entry| !entry.unwrap().file_name().to_string_lossy().contains(':')));
    scratch.small("--samples 2 --no-report --out ./s3:/x", 0);
    assert!(scratch.path("s3:/x/dataset.json").exists());
}

/// Law: a long campaign needs `--yes`; the small rest of one does not.
#[test]
fn what_is_long_is_asked_for() {
    let scratch = folder("long");
    let long =
        campaign().replace("duration_s = 1.0", "duration_s = 1000.0").replace("tolerance = 1e-10", "tolerance = 1e-14");
    scratch.file("long.toml", &long.replace("method = \"auto\"", "method = \"null_space\"").replace("1e-14", "1e-10"));
    scratch.shows(
        "campaign long.toml --out r --samples 20000",
        2,
        "that is more than 24 hours of CPU time; --yes starts it",
    );
    assert!(!scratch.path("r").exists());
    scratch.small("--out r --samples 600", 0);
    scratch.small("--out r --samples 700 --yes", 0);
}

/// Law: replacing a complete result needs `--yes` as an empty folder does; continuing it needs `--yes` for the rest
/// only.
#[test]
fn what_is_replaced_is_asked_for() {
    let scratch = folder("long-again");
    let method = "method = \"null_space\"\nmax_steps = 1000000000";
    let long = campaign_without_debris()
        .replace("duration_s = 1.0", "duration_s = 1e9")
        .replace("method = \"auto\"", method)
        .replace("samples = 600", "samples = 2");
    scratch.file("long.toml", &long);
    let asks = "cannot be estimated: sample 0 needs more than 20000 steps";
    let said = scratch.prints("campaign long.toml --out r", 2);
    assert!(said.contains(asks) && said.contains("2 runs of small") && !scratch.path("r").exists(), "{said}");
    scratch.prints("campaign long.toml --out r --yes", 1);
    let before = contents(&scratch.path("r"));
    assert!(before.contains_key("summary.json"));

    assert_says(scratch.prints("campaign long.toml --out r --overwrite", 2), [asks, "2 runs of small"]);
    assert!(contents(&scratch.path("r")) == before, "refused, and the result is another");
    scratch.shows("campaign long.toml --out r", 1, "already complete");
    assert!(contents(&scratch.path("r")) == before);
    let entries = fs::read_dir(&scratch.0).unwrap().count();
    assert_eq!(entries, 4, "a folder of a replacement is left");

    assert_says(scratch.prints("campaign long.toml --out r --samples 4", 2), [asks, "2 runs of small"]);
    scratch.prints("campaign long.toml --out r --overwrite --yes", 1);
}
