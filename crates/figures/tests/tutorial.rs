//! The pictures of `docs/tutorial.md` are those that its commands draw: its files are written and its commands run,
//! by the program with figures.
//!
//! `SPINDRIFT_WRITE_DOCS=1 cargo test --release -p spindrift-figures --test tutorial` writes those that differ.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Command;

/// With this variable pictures that differ are written.
const WRITE: &str = "SPINDRIFT_WRITE_DOCS";

/// The text between `<!-- name` and ` -->` of a line.
fn mark<'l>(line: &'l str, name: &str) -> Option<&'l str> {
    line.strip_prefix("<!-- ")?.strip_suffix(" -->")?.strip_prefix(name)
}

/// Law: a reader who does what the tutorial says gets its pictures.
#[test]
fn pictures_are_those_of_the_commands() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let document = fs::read_to_string(docs.join("tutorial.md")).expect("a tutorial");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tutorial");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    let (mut file, mut figure, mut count, mut stale) = ("", "", 0, Vec::new());
    let mut lines = document.lines();
    while let Some(line) = lines.next() {
        if let Some(name) = mark(line, "file: ") {
            file = name;
        } else if let Some(name) = mark(line, "picture: ") {
            figure = name;
        } else if line == "```toml" {
            let text: String =
                lines.by_ref().take_while(|line| *line != "```").map(|line| format!("{line}\n")).collect();
            let mut out = fs::File::options().create(true).append(true).open(folder.join(file)).expect("a file");
            out.write_all(format!("{text}\n").as_bytes()).expect("written");
        } else if line == "```sh" {
            for line in lines.by_ref().take_while(|line| *line != "```") {
                let words = line.split('#').next().unwrap_or_default().split_whitespace().skip(1);
                let program = env!("CARGO_BIN_EXE_spindrift-figures");
                let done = Command::new(program).args(words).current_dir(&folder).output().expect("it starts");
                assert!(done.status.code().is_some_and(|code| code != 2), "{line}: {done:?}");
            }
        } else if let Some((_, picture)) = line.strip_prefix("![").and_then(|rest| rest.split_once("]("))
            && !figure.is_empty()
        {
            let drawn = fs::read_to_string(folder.join(figure)).unwrap_or_default();
            assert!(drawn.starts_with("<svg"), "no command draws {figure}");
            let shown = docs.join(picture.trim_end_matches(')'));
            if fs::read_to_string(&shown).ok().as_ref() != Some(&drawn) {
                match std::env::var_os(WRITE) {
                    Some(_) => fs::write(&shown, drawn).expect("written"),
                    None => stale.push(shown),
                }
            }
            (figure, count) = ("", count + 1);
        }
    }
    assert!(count >= 3, "{count} pictures");
    assert!(stale.is_empty(), "not what the program draws: {stale:#?}; {WRITE}=1 writes them");
}
