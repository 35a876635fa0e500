//! The rules of the architecture, checked on the source: layers, cycles, external crates, calls that are not allowed.

use std::collections::BTreeSet;

use crate::source::{Crate, FOLDERS, Source, code, files_below, is_for_tests_only, paths, root, sources, sources_of};

/// Layers: a module imports only from layers below its own (and from itself).
const LAYERS: [(&str, u32); 15] = [
    ("math", 0),
    ("scene", 1),
    ("run", 1),
    ("ode", 1),
    ("dynamics", 2),
    ("sampling", 2),
    ("statistics", 2),
    ("propagation", 3),
    ("observables", 3),
    ("campaign", 4),
    ("ensemble", 5),
    ("dataset", 6),
    ("report", 7),
    ("cli", 8),
    ("main", 9),
];

/// Where each dependency may be used: modules, or single files. An empty list means everywhere.
const CRATES: [(&str, &[&str]); 27] = [
    ("arrow_ipc", &["dataset/arrow_metadata.rs"]),
    ("arrow_schema", &["dataset"]),
    ("base64", &["report/page", "dataset/arrow_metadata.rs"]),
    ("bytes", &["dataset/identity.rs", "dataset/parquet_source.rs"]),
    ("clap", &["cli"]),
    ("crc32fast", &["dataset"]),
    ("csv", &["campaign/data_columns.rs"]),
    (FOR_ITS_FEATURES, &["no file"]),
    ("fearless_simd", &["math", "dynamics", "ode", "propagation", "observables", "statistics"]),
    ("flate2", &["report/page"]),
    ("indicatif", &["cli"]),
    ("libm", &[]),
    ("nalgebra", &["statistics"]),
    ("parquet", &["dataset", "campaign/data_columns.rs"]),
    ("plotters", &["report"]),
    ("plotters_backend", &["report/bitmap.rs"]),
    ("png", &["report"]),
    ("rand", &["sampling"]),
    ("rayon", &["ensemble"]),
    ("rustix", &["campaign/input_file.rs", "cli/machine.rs", "dataset/storage.rs", "ensemble/cpu_clock.rs"]),
    ("serde", &["dataset", "report"]),
    ("serde_json", &["cli/finish_campaign.rs", "dataset", "report"]),
    ("sha2", &["campaign", "dataset"]),
    ("signal_hook", &["cli/signals.rs"]),
    (KERNELS, &["lib.rs"]),
    ("thiserror", &[]),
    ("toml", &["campaign"]),
];

/// The dependency that is there for its features alone (`Cargo.toml` says why).
const FOR_ITS_FEATURES: &str = "either";

/// The package whose modules the library exports as its own, so that nothing else names it.
const KERNELS: &str = "spindrift_kernels";

/// Elementary functions whose last digits are the platform's own: rows take them from `libm`.
const UNPORTABLE: [&str; 24] = [
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
    "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "cbrt",
];

fn layer(module: &str) -> Option<u32> {
    LAYERS.iter().find(|(name, _)| *name == module).map(|(_, layer)| *layer)
}

/// The imports of a file that its layer does not allow.
fn forbidden_imports(source: &Source, all: &Crate<'_>) -> Vec<String> {
    let path = &source.path;
    let Some(own) = layer(source.layer()) else { return vec![format!("{path}: {} has no layer", source.layer())] };
    let module = |file: &str| file.split('/').next().unwrap_or_default().trim_end_matches(".rs").to_owned();
    let imported = all.dependencies(source).into_iter().map(|file| (file, module(file)));
    imported
        .filter(|(_, other)| other != source.layer() && layer(other).is_none_or(|layer| layer >= own))
        .map(|(file, _)| format!("{path} imports {file}"))
        .collect()
}

/// The names of the external crates that `code` uses.
fn external(code: &str) -> Vec<&'static str> {
    let paths = paths(code);
    let uses = |name: &str| paths.iter().any(|(path, _)| path[0] == name) || code.contains(&format!("use {name};"));
    CRATES.iter().map(|(name, _)| *name).filter(|name| uses(name)).collect()
}

/// The external crates that a file uses and may not use.
fn forbidden_crates(source: &Source) -> Vec<String> {
    let allowed = |name: &str| {
        let places = CRATES.iter().find(|(known, _)| *known == name).map_or(&[][..], |(_, places)| places);
        let is_in = |place: &&str| source.path == **place || source.path.starts_with(&format!("{place}/"));
        places.is_empty() || places.iter().any(is_in)
    };
    let names = external(&source.code).into_iter().filter(|name| !allowed(name));
    names.map(|name| format!("{} uses {name}", source.path)).collect()
}

/// The names in the tables `[dependencies]` of a manifest, as the code writes them.
fn dependencies(manifest: &str) -> Vec<String> {
    let manifest: toml::Table = manifest.parse().expect("a manifest");
    let names = |table: Option<&toml::Value>| -> Vec<String> {
        let table = table.and_then(toml::Value::as_table).cloned().unwrap_or_default();
        table.keys().map(|name| name.replace('-', "_")).collect()
    };
    let targets = manifest.get("target").and_then(toml::Value::as_table).cloned().unwrap_or_default();
    let of_targets = targets.values().flat_map(|target| names(target.get("dependencies"))).collect::<Vec<_>>();
    let mut all = names(manifest.get("dependencies"));
    all.extend(of_targets);
    all.sort();
    all
}

/// The elementary functions of the standard library that `code` calls.
fn unportable(code: &str) -> Vec<&'static str> {
    let calls = |name: &&&str| code.contains(&format!(".{name}(")) || code.contains(&format!("f64::{name}("));
    UNPORTABLE.iter().filter(calls).copied().collect()
}

#[test]
fn modules_import_only_from_layers_below() {
    let sources = sources();
    assert!(sources.len() > 80, "the source was found: {} files", sources.len());
    let all = Crate::new(&sources);
    let library = sources.iter().filter(|source| source.layer() != "lib");
    let wrong: Vec<String> = library.flat_map(|source| forbidden_imports(source, &all)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn files_of_a_module_do_not_depend_on_each_other_in_circles() {
    let sources = sources();
    let all = Crate::new(&sources);
    let cyclic: Vec<(&str, Vec<Vec<&str>>)> = LAYERS
        .map(|(module, _)| (module, all.cycles(module)))
        .into_iter()
        .filter(|(_, found)| !found.is_empty())
        .collect();
    assert!(cyclic.is_empty(), "files that depend on each other: {cyclic:#?}");
}

#[test]
fn external_crates_stay_in_their_layers() {
    let wrong: Vec<String> = sources().iter().flat_map(forbidden_crates).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Law: the table of crates lists exactly the dependencies of the manifests, and each package uses its own, but for the one that is there
/// for its features.
#[test]
fn every_dependency_is_in_the_table_and_used() {
    let mut all = BTreeSet::new();
    for folder in FOLDERS {
        let manifest = root().join(folder).join("../Cargo.toml");
        let names = dependencies(&std::fs::read_to_string(manifest).expect("the manifest"));
        let sources = sources_of(folder);
        for name in names.iter().filter(|name| *name != FOR_ITS_FEATURES) {
            assert!(
                sources.iter().any(|source| external(&source.code).contains(&name.as_str())),
                "{folder}: {name} is not used"
            );
        }
        all.extend(names);
    }
    assert_eq!(Vec::from_iter(all), CRATES.map(|(name, _)| name));
}

#[test]
fn elementary_functions_are_portable() {
    let wrong: Vec<String> = sources()
        .iter()
        .flat_map(|source| unportable(&source.code).into_iter().map(|name| format!("{} calls .{name}()", source.path)))
        .collect();
    assert!(wrong.is_empty(), "the platform's own functions differ from machine to machine; use libm: {wrong:#?}");
}

#[test]
fn failures_are_values() {
    let wrong: Vec<String> = sources()
        .iter()
        .filter(|source| {
            [".unwrap()", "todo!(", "unimplemented!(", "dbg!(", "print!(", "println!("]
                .iter()
                .any(|call| source.code.contains(call))
        })
        .map(|source| source.path.clone())
        .collect();
    assert!(
        wrong.is_empty(),
        "unwrap, todo, dbg or a printing macro (which panics where the pipe is closed) outside tests: {wrong:?}"
    );
}

/// The binary is portable: no setting asks the compiler for the processor of the build machine.
#[test]
fn nothing_is_built_for_one_processor() {
    let mut files = Vec::new();
    for folder in FOLDERS.into_iter().chain(["benches"]) {
        files_below(&root().join(folder), &mut files);
    }
    let settings = ["Cargo.toml", "kernels/Cargo.toml", ".cargo/config.toml", ".cargo/config", "build.rs"]
        .map(|name| root().join(name));
    files.extend(settings.into_iter().filter(|file| file.exists()));
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a readable file");
        for flag in ["target-cpu", "target_cpu"] {
            assert!(!text.contains(flag), "{} names {flag}", file.display());
        }
    }
}

/// Counter-test: the layers are checked in `use`, in paths, in groups, through `super` and through re-exports.
#[test]
fn the_layer_check_can_fail() {
    let found = |path: &str, text: &str| {
        let sources = [
            Source::new("math/mod.rs", "mod real;\npub use real::Real;"),
            Source::new("math/real.rs", "pub struct Real;"),
            Source::new("scene/mod.rs", "pub struct Scene;"),
            Source::new("campaign/mod.rs", "pub mod plan;\npub use plan::Plan;"),
            Source::new("campaign/plan.rs", "pub struct Plan;"),
            Source::new("observables/mod.rs", "pub struct Request;"),
            Source::new(path, text),
        ];
        forbidden_imports(&sources[6], &Crate::new(&sources))
    };
    let plan = ["scene/x.rs imports campaign/plan.rs"];
    assert_eq!(found("scene/x.rs", "use crate::math::Real;\nuse crate::campaign::Plan;"), plan);
    assert_eq!(found("scene/x.rs", "use crate::{math::{self, Real}, campaign::{Plan}, scene::Scene};"), plan);
    assert_eq!(found("scene/x.rs", "fn f() { super::super::campaign::Plan }"), plan);
    assert_eq!(found("scene/x.rs", "use super::super::campaign as c;\nfn f() -> c::Plan {}"), plan);
    assert_eq!(
        found("propagation/x.rs", "fn f() -> crate::observables::Request {}"),
        ["propagation/x.rs imports observables/mod.rs"]
    );
    assert!(
        found("dynamics/x.rs", "// see crate::cli\nuse crate::math::Real; const X: &str = \"crate::campaign::Plan\";")
            .is_empty()
    );
    assert_eq!(found("new/x.rs", ""), ["new/x.rs: new has no layer"]);
}

/// Counter-test: cycles are found through `use`, through names of modules, through `super`, and across three files; a
/// re-export alone is none.
#[test]
fn the_cycle_check_can_fail() {
    let cycles = |files: &[(&str, &str)]| -> Vec<String> {
        let sources: Vec<Source> = files.iter().map(|(path, text)| Source::new(path, text)).collect();
        Crate::new(&sources).cycles("ode").iter().map(|cycle| cycle.join(" ")).collect()
    };
    let parent = ("ode/mod.rs", "mod a;\nmod b;\nmod c;\npub use a::{A, f};\npub use b::B;");
    let of = |a, b, c| cycles(&[parent, ("ode/a.rs", a), ("ode/b.rs", b), ("ode/c.rs", c)]);
    assert_eq!(of("use crate::ode::B;", "use crate::ode::{A};", ""), ["ode/a.rs ode/b.rs"]);
    assert_eq!(of("use super::b;\nfn f() { b::g() }", "fn g() { super::a::f() }", ""), ["ode/a.rs ode/b.rs"]);
    assert_eq!(of("use super::b::B;", "use super::c::C;", "use super::A;"), ["ode/a.rs ode/b.rs ode/c.rs"]);
    assert!(of("use super::b::B;", "use super::c::C;", "pub(in super::a) struct C;").is_empty());
    let used = ("ode/mod.rs", "mod a;\npub struct M;\nfn g() { a::f() }");
    assert_eq!(cycles(&[used, ("ode/a.rs", "use super::M;")]), ["ode/a.rs ode/mod.rs"]);
}

/// Counter-test: external crates are found in `use` and in paths, and not in comments and strings.
#[test]
fn the_crate_check_can_fail() {
    let found = |path: &str, text: &str| forbidden_crates(&Source::new(path, text));
    assert_eq!(found("scene/x.rs", "use parquet::errors::Result;"), ["scene/x.rs uses parquet"]);
    assert_eq!(found("ensemble/x.rs", "#[derive(clap::Args)]\nstruct X;"), ["ensemble/x.rs uses clap"]);
    assert_eq!(found("campaign/x.rs", "use fearless_simd;"), ["campaign/x.rs uses fearless_simd"]);
    assert_eq!(found("campaign/plan.rs", "use csv::Reader;"), ["campaign/plan.rs uses csv"]);
    assert!(found("campaign/data_columns.rs", "use csv::Reader; use parquet::file;").is_empty());
    assert!(found("scene/x.rs", "// clap::Args\nconst X: &str = r#\"plotters::x\"#; /* rand::x */").is_empty());
    let manifest =
        "[dependencies]\na-b = \"1\"\n[target.'cfg(unix)'.dependencies]\nc = \"1\"\n[dev-dependencies]\nd = \"1\"";
    assert_eq!(dependencies(manifest), ["a_b", "c"]);
}

/// Counter-test of the other readers.
#[test]
fn the_readers_can_fail() {
    assert_eq!(unportable("let y = x.sin() + f64::exp(x) + libm::cos(x);"), ["sin", "exp"]);
    assert_eq!(code("a // b\n#[cfg(test)]\nmod tests {\n x.unwrap()"), "a \n");
    assert_eq!(code(r##"f("//", '"', '\'', 'a', r#"""#) /* x */ + <'a>"##), r#"f("", ' ', ' ', ' ', "")  + <'a>"#);
    assert!(is_for_tests_only("scene/samples.rs") && !is_for_tests_only("scene/mass.rs"));
}
