//! What can be checked of the supply chain without a network: the lock file, the banned crates, the oldest compiler, unsafe code.

use std::path::Path;

/// The registry that every dependency comes from.
const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// Those of this repository.
const PACKAGES: [&str; 4] = [env!("CARGO_PKG_NAME"), "spindrift-benches", "spindrift-kernels", "spindrift-unit-tests"];

fn text(file: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn table(file: &str) -> toml::Table {
    text(file).parse().unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// The crates that `deny.toml` bans.
fn banned(rules: &toml::Table) -> Vec<String> {
    let list = rules["bans"]["deny"].as_array().expect("a list");
    list.iter().map(|one| one["crate"].as_str().expect("a name").to_owned()).collect()
}

/// What is wrong with the packages of a lock file: banned, of another source, or without a checksum.
fn problems(lock: &toml::Table, banned: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    for package in lock["package"].as_array().expect("packages") {
        let name = package["name"].as_str().expect("a name");
        if banned.iter().any(|banned| banned == name) {
            found.push(format!("{name} is banned"));
        }
        match package.get("source").and_then(toml::Value::as_str) {
            None if PACKAGES.contains(&name) => {}
            Some(REGISTRY) if package.get("checksum").is_some() => {}
            source => found.push(format!("{name} is from {source:?}, or has no checksum")),
        }
    }
    found
}

/// Checked: the lock file is committed, and names no banned crate; every package has a checksum and is from the registry.
#[test]
fn the_lock_file_is_clean() {
    let (lock, banned) = (table("Cargo.lock"), banned(&table("deny.toml")));
    assert!(banned.len() >= 4 && lock["package"].as_array().expect("packages").len() > 50);
    assert_eq!(problems(&lock, &banned), Vec::<String>::new());
    assert!(!text(".gitignore").lines().any(|line| line.contains("Cargo.lock")));
}

/// Checked: manifest, README and workflow name the same oldest compiler.
#[test]
fn the_oldest_compiler_is_the_same_everywhere() {
    let oldest = env!("CARGO_PKG_RUST_VERSION");
    assert!(text("README.md").contains(&format!("Rust {oldest} or newer")), "README.md: {oldest}");
    assert!(
        text(".github/workflows/ci.yml").contains(&format!("RUSTUP_TOOLCHAIN: \"{oldest}\"")),
        "workflow: {oldest}"
    );
}

/// Checked: library and program forbid unsafe code, so that no module can allow it.
#[test]
fn unsafe_code_is_forbidden() {
    for file in ["src/lib.rs", "src/main.rs", "kernels/src/lib.rs"] {
        assert!(text(file).lines().any(|line| line == "#![forbid(unsafe_code)]"), "{file}");
    }
}

/// Counter-test: a banned crate, another source and a missing checksum are found.
#[test]
fn the_checks_can_fail() {
    let lock = "[[package]]\nname = \"arrow2\"\nsource = \"registry+https://github.com/rust-lang/crates.io-index\"\nchecksum = \"0\"\n\
        [[package]]\nname = \"a\"\nsource = \"git+https://example.org/a\"\n\
        [[package]]\nname = \"b\"\nsource = \"registry+https://github.com/rust-lang/crates.io-index\"\n";
    assert_eq!(problems(&lock.parse().expect("TOML"), &["arrow2".to_owned()]).len(), 3);
}
