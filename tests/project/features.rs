//! The library is compiled once for the program and its tests.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use crate::source::root;

/// The features that Cargo chooses for each crate, with the dependencies of tests or without; without a package for those that `cargo test`
/// tests.
fn features(edges: &[&str]) -> BTreeMap<String, BTreeSet<String>> {
    let listing = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--prefix", "none", "--format", "{p}|{f}"])
        .args(edges)
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(listing.status.success(), "{}", String::from_utf8_lossy(&listing.stderr));
    let mut features: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    // an empty line ends the list of a package
    for line in String::from_utf8_lossy(&listing.stdout).lines().filter(|line| !line.is_empty()) {
        let (package, list) = line.split_once('|').expect("the format has a bar");
        let list = list.trim_end_matches(" (*)").split(',').map(str::to_owned);
        features.entry(package.to_owned()).or_default().extend(list);
    }
    features
}

/// Cargo compiles a crate once per set of features, and all that depends on it. A crate of the program from which tests or benches
/// ask for more has those features in the program too; otherwise `cargo test` compiles the library a second time, for minutes.
#[test]
fn tests_and_benches_ask_for_no_further_features() {
    let program = features(&["--package", "spindrift", "--edges", "no-dev"]);
    for (name, edges) in [("tests", &[][..]), ("benches", &["--package", "spindrift-benches"])] {
        let others = features(edges);
        assert!(program.len() > 50 && others.len() > program.len(), "{name}");
        let differing = program.iter().filter(|(package, features)| others.get(*package) != Some(features));
        let differing: Vec<_> = differing.map(|(package, _)| (package, &program[package], &others[package])).collect();
        assert!(differing.is_empty(), "with other features in {name} (program, {name}): {differing:#?}");
    }
}
