//! README and `docs/`: every name is documented, every campaign file is valid, and every command exists.

use crate::prelude::*;

use clap::{CommandFactory, Parser};
use spindrift::campaign::find;
use spindrift::cli::arguments::{Arguments, Command};
use spindrift::ensemble::plausibility::implausible;

const README_LINES: usize = 200;

/// The mark above a TOML block that is a part of a campaign file.
const FRAGMENT: &str = "<!-- fragment -->";

const OTHER_PROGRAMS: [&str; 8] = ["sha256sum", "git", "cd", "rustup", "cp", "pip", "clang", "rustc"];

fn text(file: &Path) -> String {
    std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

fn documents() -> Vec<PathBuf> {
    let mut files = Vec::new();
    for folder in ["", "docs", "benches"] {
        let entries = std::fs::read_dir(root().join(folder)).unwrap();
        files.extend(entries.map(|entry| entry.unwrap().path()));
    }
    files.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    files.sort();
    files
}

struct Block {
    language: String,
    text: String,
    is_fragment: bool,
}

fn blocks(document: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let (mut is_open, mut before) = (false, "");
    for line in document.lines() {
        match line.strip_prefix("```") {
            Some(_) if is_open => is_open = false,
            Some(language) => {
                is_open = true;
                let (language, is_fragment) = (language.to_owned(), before == FRAGMENT);
                blocks.push(Block { language, text: String::new(), is_fragment });
            }
            None if is_open => {
                let block = blocks.last_mut().unwrap();
                block.text.push_str(line);
                block.text.push('\n');
            }
            None => before = if line.is_empty() { before } else { line },
        }
    }
    blocks
}

fn base_of_fragments() -> String {
    text(&root().join("campaigns/spin_sweep.toml"))
}

fn campaign_problem(block: &Block, base: &str) -> Option<String> {
    let folder = root().join("campaigns");
    let base = if block.is_fragment { base } else { "" };
    let whole = format!("{base}\n{}", block.text);
    match Plan::from_text_in(&folder, "block.toml", &whole, Overrides::default()) {
        Err(error) => Some(error.to_string()),
        Ok(plan) => Scene::resolve(&plan.nominal).err().map(|errors| format!("{errors:?}")),
    }
}

fn cargo_problem(words: &[&str]) -> Option<String> {
    let folders = [("--test", "tests"), ("--bench", "benches"), ("--example", "examples")];
    for (option, folder) in folders {
        let Some(at) = words.iter().position(|word| *word == option) else { continue };
        let name = words.get(at + 1).copied().unwrap_or_default();
        let folder = root().join(folder);
        if !folder.join(format!("{name}.rs")).is_file() && !folder.join(name).join("main.rs").is_file() {
            return Some(format!("there is no {option} {name}"));
        }
    }
    match words.split(|word| *word == "--").nth(1) {
        Some(arguments) if words.first() == Some(&"run") && !words.contains(&"--example") => program_problem(arguments),
        _ => None,
    }
}

fn program_problem(words: &[&str]) -> Option<String> {
    let arguments = match Arguments::try_parse_from([&["spindrift"], words].concat()) {
        Ok(arguments) => arguments,
        Err(error) => return Some(error.to_string()),
    };
    let file = match &arguments.command {
        Command::Campaign(options) => &options.file,
        Command::Check(options) => &options.file,
        Command::Simulate(options) => &options.file,
        Command::Sample(options) => &options.file,
        Command::Precision(options) => &options.file,
        Command::Compare(_)
        | Command::CompleteResult(_)
        | Command::Index(_)
        | Command::New(_)
        | Command::Report(_)
        | Command::Schema
        | Command::Show(_)
        | Command::Verify(_) => return None,
        Command::Columns(options) => options.campaign.as_ref()?,
    };
    let shipped = || root().join("campaigns").join(file).is_file() || find(file).is_ok();
    let is_known = ["my_sweep.toml", "satellite.toml", "calibrated.toml", "orbit.toml", "FILE"]
        .iter()
        .any(|name| Path::new(name) == file)
        || shipped();
    (!is_known).then(|| format!("there is no {}", file.display()))
}

fn command_problem(line: &str) -> Option<String> {
    let line = line.split(" #").next().unwrap_or_default().replace('"', "");
    let words: Vec<&str> = line.split_whitespace().skip_while(|word| is_setting(word)).collect();
    match words.split_first() {
        None => None,
        Some((&"cargo", arguments)) => cargo_problem(arguments),
        Some((&"spindrift" | &"target/release/spindrift", arguments)) => program_problem(arguments),
        Some((&"python3", arguments)) => {
            let script = arguments.first().copied().unwrap_or_default();
            (!root().join(script).is_file()).then(|| format!("no script {script:?}"))
        }
        Some((program, _)) if OTHER_PROGRAMS.contains(program) || root().join(program).is_file() => None,
        Some((program, _)) => Some(format!("unknown program {program}")),
    }
}

fn is_setting(word: &str) -> bool {
    word.split_once('=')
        .is_some_and(|(name, _)| name.chars().all(|letter| letter.is_ascii_uppercase() || letter == '_'))
}

fn links(document: &str) -> Vec<&str> {
    let targets = document.match_indices("](").map(|(at, _)| document[at + 2..].split(')').next().unwrap_or_default());
    targets.filter(|target| !target.starts_with("http") && !target.starts_with('#')).collect()
}

fn anchors(document: &str) -> Vec<String> {
    let headings = document.lines().filter(|line| line.starts_with('#'));
    headings
        .map(|line| {
            let title = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
            title.chars().filter(|letter| letter.is_alphanumeric() || "-_".contains(*letter)).collect()
        })
        .collect()
}

#[test]
fn the_readme_is_short() {
    let lines = text(&root().join("README.md")).lines().count();
    assert!(lines <= README_LINES, "README.md has {lines} lines; move what is long to docs/");
}

#[test]
fn the_readme_shows_what_new_writes() {
    let readme = text(&root().join("README.md"));
    let shown = blocks(&readme);
    let start = text(&root().join("assets/start.toml"));
    assert!(shown.iter().any(|block| block.language == "toml" && block.text == start), "not the file of `new`");
    let output = shown.iter().find(|block| block.language == "text").unwrap();
    assert!(output.text.lines().count() <= 10, "{}", output.text);
    let first = shown.iter().find(|block| block.language == "sh").unwrap();
    assert!(first.text.starts_with("git clone") && first.text.lines().count() == 4, "{}", first.text);
    let picture = std::fs::read(root().join("docs/figures/replay.png")).unwrap();
    assert!(readme.contains("(docs/figures/replay.png)") && picture.len() < 1_500_000, "{}", picture.len());
    assert!(picture.windows(4).any(|four| four == b"acTL"), "it does not move");
}

#[test]
fn every_campaign_file_is_valid() {
    let mut count = 0;
    for file in documents().into_iter().filter(|file| !file.ends_with("tutorial.md")) {
        for block in blocks(&text(&file)).into_iter().filter(|block| block.language == "toml") {
            count += 1;
            let problem = campaign_problem(&block, &base_of_fragments());
            assert!(problem.is_none(), "{}: {}\n{}", file.display(), problem.unwrap_or_default(), block.text);
        }
    }
    assert!(count >= 4, "{count} blocks were found");
}

#[test]
fn the_complete_example_raises_no_note() {
    let document = text(&root().join("docs/campaign-files.md"));
    let example = blocks(&document).into_iter().find(|block| block.language == "toml").unwrap().text;
    let notes = |text: &str| {
        let plan = planned(text);
        [plan.notes(), implausible(&plan)].concat()
    };
    assert_eq!(notes(&example), Vec::<String>::new());
    let fast = example.replacen("= [0, 0.05, 0.5]", "= [0, 0.05, 31.6]", 1);
    assert_eq!(notes(&fast).len(), 2, "its rate, and the angle between two points: {:?}", notes(&fast));
}

#[test]
fn every_command_exists() {
    let mut count = 0;
    for file in documents() {
        for block in blocks(&text(&file)).iter().filter(|block| block.language == "sh") {
            for line in block.text.lines() {
                count += 1;
                let problem = command_problem(line);
                assert!(problem.is_none(), "{}: `{line}`: {}", file.display(), problem.unwrap_or_default());
            }
        }
    }
    assert!(count >= 10, "{count} commands were found");
}

#[test]
fn every_queried_column_exists() {
    let columns = text(&root().join("docs/columns.md"));
    let keys = text(&root().join("docs/parameters.md"));
    let mut count = 0;
    for file in documents() {
        for block in blocks(&text(&file)).iter().filter(|block| block.language == "python") {
            let names = block.text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
            for name in names.filter(|name| name.matches('_').count() >= 2) {
                count += 1;
                // a column of wheels is listed once, with the place of the name
                let listed = [name.to_owned(), name.replace("_w1_", "_{wheel}_")];
                let is_listed = listed.iter().any(|name| columns.contains(&format!("`{name}`")));
                let is_key = ["`", "."].iter().any(|before| keys.contains(&format!("{before}{name}`")));
                assert!(is_listed || is_key, "{}: there is no column {name}", file.display());
            }
        }
    }
    assert!(count >= 4, "{count} names were found");
}

#[test]
fn every_link_leads_somewhere() {
    for file in documents() {
        let document = text(&file);
        for link in links(&document) {
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = file.parent().unwrap().join(path);
            assert!(target.exists(), "{}: there is no {link}", file.display());
            let known = || anchors(&text(&target)).iter().any(|known| known == anchor);
            assert!(anchor.is_empty() || known(), "{}: {path} has no heading #{anchor}", file.display());
        }
    }
}

#[test]
fn every_name_is_documented() {
    let readme = text(&root().join("README.md"));
    let command = Arguments::command();
    let mut names: Vec<String> = vec![".ci/run".to_owned(), "cargo test --release".to_owned()];
    for command in command.get_subcommands() {
        names.push(format!("`{}", command.get_name()));
        for argument in command.get_arguments() {
            assert!(argument.get_help().is_some(), "{}: no help of {argument}", command.get_name());
        }
    }
    names.retain(|name| !readme.contains(name.as_str()));
    assert!(names.is_empty(), "README.md does not mention {names:?}");
    let model = text(&root().join("docs/model.md"));
    let unknown: Vec<_> =
        Method::ALL.into_iter().filter(|method| !model.contains(&format!("`{}`", method.name()))).collect();
    assert!(unknown.is_empty(), "docs/model.md does not mention {unknown:?}");

    let page = text(&root().join("docs/campaign-files.md"));
    let unknown: Vec<_> =
        Status::ALL.into_iter().filter(|status| !page.contains(&format!("`{}`", status.name()))).collect();
    assert!(unknown.is_empty(), "docs/campaign-files.md does not mention {unknown:?}");
    let files = std::fs::read_dir(root().join("campaigns")).unwrap();
    let names = files.map(|file| file.unwrap().file_name().to_string_lossy().into_owned());
    let unknown: Vec<String> = names.filter(|name| !page.contains(name.as_str())).collect();
    assert!(unknown.is_empty(), "docs/campaign-files.md does not mention {unknown:?}");
}

#[test]
fn the_flight_code_is_that_of_the_example() {
    let document = text(&root().join("docs/flight-code.md"));
    let shown = blocks(&document).into_iter().find(|block| block.language == "c").unwrap();
    let example = root().join("examples/flight_code");
    assert_eq!(shown.text, text(&example.join("mrp_feedback.c")));
    let header = text(&example.join("spindrift.h"));
    let rows = document.lines().filter_map(|line| line.strip_prefix("| ")?.split_once(" | `"));
    let names: Vec<&str> =
        rows.filter_map(|(_, rest)| rest.split('`').next()).filter(|name| header.contains(name)).collect();
    let fields = header.lines().filter_map(|line| line.trim().strip_prefix("double ")?.split([';', '[']).next());
    assert_eq!(names, fields.collect::<Vec<_>>());
}

/// Law: each line that a worked example adds stands in the sources, however it is wrapped there; only the effect is in
/// no tree.
#[test]
fn worked_examples_quote_the_sources() {
    let letters = |text: &str| text.replace("///", "").split_whitespace().collect::<String>().replace('\\', "");
    let mut sources = String::new();
    let mut open = vec![root().join("src"), root().join("crates")];
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|found| found == "rs") {
            sources += &letters(&text(&path));
        }
    }
    let document = text(&root().join("CONTRIBUTING.md"));
    let mut quoted = 0;
    for section in document.split("\n### ").filter(|section| !section.starts_with("Worked example: an effect")) {
        let examples = blocks(section).into_iter().filter(|block| block.language == "diff");
        for line in examples.flat_map(|block| block.text.lines().map(str::to_owned).collect::<Vec<_>>()) {
            let Some(added) = line.strip_prefix('+') else { continue };
            for piece in added.split("...").map(letters).filter(|piece| !piece.is_empty()) {
                assert!(sources.contains(&piece), "CONTRIBUTING.md: no source has `{added}`");
                quoted += 1;
            }
        }
    }
    assert!(quoted > 30, "{quoted}");
}
