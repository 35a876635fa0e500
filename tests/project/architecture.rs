//! The walls of the house, read off the source: who may import whom, and what nobody may call.

use std::path::{Path, PathBuf};

/// Floors: a module imports only from floors below its own (and from itself).
const FLOORS: [(&str, u32); 15] = [
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

/// Elementary functions whose last digits are the platform's own: rows take them from `libm`.
const UNPORTABLE: [&str; 24] = [
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
    "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "cbrt",
];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn files_below(folder: &Path, list: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder).expect("a readable folder").map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            files_below(&path, list);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            list.push(path);
        }
    }
}

/// A source file: its path from `src/`, its module on the ground plan, its code without comments.
struct Source {
    path: String,
    module: String,
    code: String,
}

/// The code of `text` up to its unit tests, without comments. Text in quotes stays: nothing here looks for what stands there.
fn code(text: &str) -> String {
    let shipped = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let code = |line: &str| line.split("//").next().unwrap_or_default().to_owned();
    shipped.lines().map(code).collect::<Vec<_>>().join("\n")
}

fn sources() -> Vec<Source> {
    let folder = root().join("src");
    let mut list = Vec::new();
    files_below(&folder, &mut list);
    let sources = list.into_iter().map(|file| {
        let path = file.strip_prefix(&folder).expect("below src").to_string_lossy().replace('\\', "/");
        let module = path.split('/').next().unwrap_or_default().trim_end_matches(".rs").to_owned();
        let text = std::fs::read_to_string(&file).expect("a source file");
        Source { path, module, code: code(&text) }
    });
    // declared under cfg(test) where their modules are declared: scenes for unit tests, and checks of tableaus
    sources.filter(|source| !is_for_tests_only(&source.path)).collect()
}

/// Whether the file's module is declared under `#[cfg(test)]`.
fn is_for_tests_only(path: &str) -> bool {
    let path = Path::new(path);
    let (Some(folder), Some(name)) = (path.parent(), path.file_stem()) else { return false };
    let parent = root().join("src").join(folder).join("mod.rs");
    let Ok(text) = std::fs::read_to_string(parent) else { return false };
    let name = name.to_string_lossy();
    let mut lines = text.lines().zip(text.lines().skip(1));
    lines.any(|(before, line)| before.trim() == "#[cfg(test)]" && line.trim().ends_with(&format!("mod {name};")))
}

fn floor(module: &str) -> Option<u32> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|(_, floor)| *floor)
}

/// The modules of the crate that `code` names, whether in a `use` or in a path.
fn imports(code: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for start in ["crate::", "spindrift::"] {
        for (at, _) in code.match_indices(start) {
            let rest = &code[at + start.len()..];
            match rest.strip_prefix('{') {
                // use crate::{a::b, c}: the first word of each item at the outer level
                Some(list) => {
                    let (mut depth, mut item) = (0, String::new());
                    for letter in list.chars() {
                        match letter {
                            '{' => depth += 1,
                            '}' if depth == 0 => break,
                            '}' => depth -= 1,
                            ',' if depth == 0 => found.push(std::mem::take(&mut item)),
                            _ if depth == 0 => item.push(letter),
                            _ => {}
                        }
                    }
                    found.push(item);
                }
                None => {
                    found.push(rest.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect())
                }
            }
        }
    }
    let first = |item: String| item.trim().split("::").next().unwrap_or_default().trim().to_owned();
    found.into_iter().map(first).filter(|module| !module.is_empty()).collect()
}

/// What is wrong with the imports of a file.
fn trespasses(path: &str, module: &str, code: &str) -> Vec<String> {
    let Some(own) = floor(module) else { return vec![format!("{path}: {module} has no floor")] };
    let wrong = |other: &String| *other != module && floor(other).is_none_or(|floor| floor >= own);
    imports(code).into_iter().filter(wrong).map(|other| format!("{path} imports {other}")).collect()
}

/// The elementary functions of the standard library that `code` calls.
fn unportable(code: &str) -> Vec<&'static str> {
    let calls = |name: &&&str| code.contains(&format!(".{name}(")) || code.contains(&format!("f64::{name}("));
    UNPORTABLE.iter().filter(calls).copied().collect()
}

#[test]
fn modules_import_only_from_floors_below() {
    let sources = sources();
    assert!(sources.len() > 80, "the source was found: {} files", sources.len());
    let wrong: Vec<String> = sources
        .iter()
        .filter(|source| source.module != "lib")
        .flat_map(|source| trespasses(&source.path, &source.module, &source.code))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
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
            [".unwrap()", "todo!(", "unimplemented!(", "dbg!("].iter().any(|call| source.code.contains(call))
        })
        .map(|source| source.path.clone())
        .collect();
    assert!(wrong.is_empty(), "unwrap, todo or dbg in what is shipped: {wrong:?}");
}

/// One portable binary: nothing asks the compiler for the processor at hand.
#[test]
fn nothing_is_built_for_one_processor() {
    let mut files = Vec::new();
    for folder in ["src", "benches"] {
        files_below(&root().join(folder), &mut files);
    }
    let settings = ["Cargo.toml", ".cargo/config.toml", ".cargo/config", "build.rs"].map(|name| root().join(name));
    files.extend(settings.into_iter().filter(|file| file.exists()));
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a readable file");
        for flag in ["target-cpu", "target_cpu"] {
            assert!(!text.contains(flag), "{} names {flag}", file.display());
        }
    }
}

/// Counter-test: each reader finds what it is there to find.
#[test]
fn the_readers_can_fail() {
    let upward = "use crate::math::Real;\nuse crate::campaign::Plan;\n";
    assert_eq!(trespasses("scene/x.rs", "scene", upward), ["scene/x.rs imports campaign"]);
    let grouped = "use crate::{math::{Real, Isa}, dataset::Folder, scene::Scene};";
    assert_eq!(trespasses("dynamics/x.rs", "dynamics", grouped), ["dynamics/x.rs imports dataset"]);
    let beside = "fn f() -> crate::observables::Request { todo() }";
    assert_eq!(trespasses("propagation/x.rs", "propagation", beside), ["propagation/x.rs imports observables"]);
    assert!(
        trespasses("propagation/x.rs", "propagation", &code("// see crate::cli\nuse crate::dynamics::debris;"))
            .is_empty()
    );
    assert_eq!(trespasses("new/x.rs", "new", "").len(), 1, "a module without a floor");
    assert_eq!(unportable("let y = x.sin() + f64::exp(x) + libm::cos(x);"), ["sin", "exp"]);
    assert_eq!(code("a\n#[cfg(test)]\nmod tests {\n x.unwrap()"), "a");
    assert!(is_for_tests_only("scene/samples.rs") && !is_for_tests_only("scene/mass.rs"));
}
