//! Screens and pages as approved by a reader: `tests/golden/views`. A view that changes on purpose is written again
//! with `SPINDRIFT_WRITE_VIEWS=1`, and its difference is read before it is committed.

use crate::prelude::*;
use std::fmt::Write;

const WRITE: &str = "SPINDRIFT_WRITE_VIEWS";

const BLOCKS: &str = "title h1 h2 h3 p div section li tr summary figcaption pre nav header details dl dt article";
const MOST_ALIKE: usize = 6;

fn text_of_page(page: &str) -> String {
    let markup = page.split_once("<script").unwrap().0;
    let body = markup.split_once("<body").unwrap().1;
    let (mut out, mut line) = (String::new(), String::new());
    let mut rest = &body[body.find('>').unwrap() + 1..];
    let (mut hidden, mut alike) = (None, 0);
    while let Some((text, after)) = rest.split_once('<') {
        if hidden.is_none() {
            line.push_str(text.trim_matches('\n'));
        }
        let (tag, after) = after.split_once('>').unwrap();
        let name = tag.trim_start_matches('/').split([' ', '/', '\n']).next().unwrap_or_default();
        match hidden {
            None if ["svg", "pre"].contains(&name) => hidden = Some(name),
            Some(one) if tag == format!("/{one}") => hidden = None,
            _ => {}
        }
        if BLOCKS.split(' ').any(|block| block == name) && !line.trim().is_empty() {
            alike = if ["tr", "dt"].contains(&name) { alike + 1 } else { 0 };
            if alike <= MOST_ALIKE {
                writeln!(out, "{}", line.trim()).unwrap();
            } else if alike == MOST_ALIKE + 1 {
                writeln!(out, "...").unwrap();
            }
            line.clear();
        }
        if ["td", "th", "button", "a", "dd"].contains(&name) && !line.ends_with(['|', ' ']) {
            line.push('|');
        }
        rest = after;
    }
    out + line.trim() + "\n"
}

fn text_of_figures(data: &Value) -> String {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let (mut out, mut before) = (String::new(), String::new());
    for figure in data["figures"].as_array().unwrap() {
        let axis = |axis: &Value| match text(&axis["unit"]) {
            unit if unit.is_empty() => text(&axis["quantity"]),
            unit => format!("{}, {unit}", text(&axis["quantity"])),
        };
        let marks = figure["marks"].as_array().unwrap();
        let mut labels: Vec<String> = marks.iter().map(|mark| text(&mark["label"])).collect();
        labels.dedup();
        let [x, y] = [axis(&figure["x"]), axis(&figure["y"])];
        writeln!(out, "figure {}: {x} | {y} | {}", text(&figure["title"]), labels.join("; ")).unwrap();
        let caption = text(&figure["caption"]);
        if caption != before {
            writeln!(out, "  {caption}").unwrap();
            before = caption;
        }
    }
    for run in data["replay"]["runs"].as_array().into_iter().flatten().take(2) {
        writeln!(out, "replay of {}: {}, {}", text(&run["name"]), text(&run["why"]), run["numbers"]).unwrap();
    }
    out
}

fn steady(text: &str, scratch: &ScratchFolder) -> String {
    let folder = scratch.0.to_string_lossy().into_owned();
    let is_identity =
        |word: &str| [8, 12, 64].contains(&word.len()) && word.bytes().all(|byte| byte.is_ascii_hexdigit());
    let mut out = String::new();
    let is_timed = |line: &&str| {
        line.starts_with("== Estimate, from") || line.contains(" on one core") || line.contains("memory: at most")
    };
    let text = text.replace(&folder, "FOLDER").replace(env!("CARGO_PKG_VERSION"), "VERSION");
    for line in text.lines().filter(|line| !is_timed(line)) {
        let mut word = String::new();
        for letter in line.chars().chain(['\n']) {
            if letter.is_ascii_alphanumeric() {
                word.push(letter);
                continue;
            }
            let has = |is: fn(&u8) -> bool| word.bytes().any(|byte| is(&byte));
            let is_id = is_identity(&word) && has(u8::is_ascii_digit) && has(u8::is_ascii_lowercase);
            out.push_str(if is_id { "ID" } else { &word });
            word.clear();
            out.push(letter);
        }
    }
    let (mut steady, mut rest) = (String::new(), out.as_str());
    while let Some((before, after)) = rest.split_once("computed in ") {
        let end = after.find(')').map_or(0, |end| end + 1);
        steady += &format!("{before}computed in TIME");
        rest = &after[end..];
    }
    steady + rest
}

fn approved(name: &str, view: &str, different: &mut Vec<String>) {
    let path = root().join("tests/golden/views").join(format!("{name}.txt"));
    let before = fs::read_to_string(&path).unwrap_or_default();
    if before == view {
        return;
    }
    if std::env::var_os(WRITE).is_some() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        return fs::write(&path, view).unwrap();
    }
    let (mut old, mut new) = (before.lines(), view.lines());
    let (at, was, is) =
        (1..).map(|line| (line, old.next(), new.next())).find(|(_, was, is)| was != is || was.is_none()).unwrap();
    different.push(format!("{name}.txt:{at}\n  was {}\n  is  {}", was.unwrap_or("-"), is.unwrap_or("-")));
}

/// Law: screens and pages of campaigns of free bodies, of a loop, on an orbit and with failures are those approved.
#[test]
fn what_a_reader_sees_was_approved() {
    let scratch = folder("views");
    scratch.file("mixed.toml", &mixed_failures());
    scratch.file("base.toml", &campaign());
    let shipped = root().join("campaigns");
    let of = |name: &str| shipped.join(name).to_string_lossy().into_owned();
    let mut different = Vec::new();
    for (name, file, options, code) in [
        ("spin_sweep", of("spin_sweep.toml"), "--samples 150", 0),
        ("net_launch", of("net_launch.toml"), "--samples 60", 5),
        ("nadir_pointing", of("nadir_pointing.toml"), "--samples 40", 5),
        ("mixed", "mixed.toml".to_owned(), "--samples 200", 1),
    ] {
        let run = |arguments: &str, code: i32| {
            let (command, rest) = arguments.split_once(' ').unwrap_or((arguments, ""));
            let mut program = scratch.command(command);
            let program = program.arg(&file).args(rest.split_whitespace()).env("COLUMNS", "100");
            steady(&scratch.outputs(program, code), &scratch)
        };
        let brief = run(&format!("campaign {options} --out {name}"), code);
        let verbose = run(&format!("campaign {options} --verbose --out {name}-again"), code);
        approved(&format!("{name}_screen"), &format!("{brief}\n---- verbose\n{verbose}"), &mut different);
        if ["spin_sweep", "mixed"].contains(&name) {
            approved(&format!("{name}_check"), &run("check", 0), &mut different);
        }
        if name == "spin_sweep" {
            continue;
        }
        let page = scratch.text(&format!("{name}/report.html"));
        let data = Found::data_of(&page);
        let said = text_of_page(&page) + &text_of_figures(&data);
        approved(&format!("{name}_page"), &steady(&said, &scratch), &mut different);
    }
    let wide = |arguments: &str, code: i32| steady(&scratch.prints_at(arguments, code, 100), &scratch);
    scratch.prints("campaign base.toml --samples 300 --out before", 0);
    scratch.prints("campaign base.toml --samples 300 --set campaign.seed=8 --out after", 0);
    let rest = [
        wide("compare before after", 0),
        wide("sample base.toml --samples 5", 0),
        wide("simulate before/plan.toml --sample 3", 0),
        wide("simulate spin_sweep/plan.toml --sample 3", 0),
    ];
    approved("other_commands", &rest.join("\n----\n"), &mut different);
    assert!(different.is_empty(), "{}\nread the differences, then set {WRITE}=1", different.join("\n"));
}
