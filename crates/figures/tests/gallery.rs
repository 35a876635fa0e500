//! `docs/gallery.md`: each of its pictures is the figure that spindrift draws of the campaign, of all its runs.
//!
//! `SPINDRIFT_WRITE_DOCS=1 cargo test --release -p spindrift-figures --test gallery` writes those that differ.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde_json::{Value, json};
use spindrift::report::figure_files::draw_by;
use spindrift::workflow::session::{Quiet, Session};
use spindrift::workflow::{Campaign, Outputs};

/// With this variable pictures that differ are written.
const WRITE: &str = "SPINDRIFT_WRITE_DOCS";

/// The name of the one figure of a campaign that is drawn; to draw all of them takes longer than the runs.
static WANTED: Mutex<String> = Mutex::new(String::new());

/// Draws the wanted figure of a list, and nothing for the others.
fn draw(figures: &str) -> Result<Vec<String>, String> {
    let list: Vec<Value> = serde_json::from_str(figures).map_err(|error| error.to_string())?;
    let wanted = WANTED.lock().map_err(|error| error.to_string())?;
    let drawn = |figure: &Value| {
        let is_wanted = figure["name"] == wanted.as_str();
        match is_wanted {
            true => spindrift_figures::draw(&json!([figure]).to_string()).map(|one| one.concat()),
            false => Ok(String::new()),
        }
    };
    list.iter().map(drawn).collect()
}

/// The campaigns of a gallery, each with the figure of its entry (after it: settings of the campaign, KEY=VALUE) and
/// its picture.
fn entries(gallery: &str) -> Vec<[&str; 3]> {
    let (mut list, mut name, mut figure) = (Vec::new(), "", "");
    for line in gallery.lines() {
        let comment = line.strip_prefix("<!-- picture: ").and_then(|rest| rest.strip_suffix(" -->"));
        let picture = line.strip_prefix("![").and_then(|rest| rest.split_once("](")).map(|(_, rest)| rest);
        if let Some(campaign) = line.strip_prefix("### ") {
            (name, figure) = (campaign, "");
        } else if let Some(known) = comment {
            figure = known;
        } else if let Some(picture) = picture {
            list.push([name, figure, picture.trim_end_matches(')')]);
        }
    }
    list
}

/// Law: every picture of the gallery is what the program draws of that campaign today.
#[test]
fn pictures_are_those_that_the_program_draws() {
    draw_by(draw);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let gallery = fs::read_to_string(root.join("docs/gallery.md")).expect("a gallery");
    let scratch = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("gallery");
    let (watch, mut stale, mut missing, mut count) = (Quiet::default(), Vec::new(), Vec::new(), 0);
    for [campaign, figure, picture] in entries(&gallery) {
        let (file, settings) = figure.split_once(' ').unwrap_or((figure, ""));
        let figure = file.trim_end_matches(".svg");
        figure.clone_into(&mut WANTED.lock().expect("a name"));
        let _ = fs::remove_dir_all(&scratch);
        let folder = scratch.join("figures");
        let outputs = Outputs { figures: Some(folder.clone()), ..Outputs::default() };
        let session = Session::new(&watch).expect("a session");
        let file = root.join("campaigns").join(campaign);
        let mut flown = Campaign::from_file(file, session).store(scratch.join("result")).outputs(outputs);
        for (key, value) in settings.split_whitespace().filter_map(|setting| setting.split_once('=')) {
            flown = flown.set(key, value);
        }
        let flown = flown.results();
        flown.unwrap_or_else(|error| panic!("{campaign}: {error}"));
        let drawn = fs::read_to_string(folder.join(format!("{figure}.svg"))).unwrap_or_default();
        if !drawn.starts_with("<svg") {
            missing.push(format!("{campaign}: no figure {figure:?} is drawn; there are {:?}", names(&folder)));
            continue;
        }
        let shown = root.join("docs").join(picture);
        if fs::read_to_string(&shown).ok().as_ref() != Some(&drawn) {
            if std::env::var_os(WRITE).is_some() {
                fs::write(&shown, drawn).expect("written");
            } else {
                stale.push(picture);
            }
        }
        count += 1;
    }
    assert!(missing.is_empty(), "{missing:#?}");
    assert!(stale.is_empty(), "{stale:?} are not what the program draws: {WRITE}=1 writes them");
    assert_eq!(count, gallery.matches("\n### ").count(), "a picture for each campaign");
}

/// The names of the files in `folder`, in order.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Counter-test: the figure of an entry is the one that stands in it, and an entry without one is not given that of
/// another.
#[test]
fn the_figures_of_entries_are_found() {
    let text = "### a.toml\n\n<!-- picture: rate.svg -->\n\n![A](figures/gallery/a.svg)\n### b.toml\n![B](b.svg)\n";
    assert_eq!(entries(text), [["a.toml", "rate.svg", "figures/gallery/a.svg"], ["b.toml", "", "b.svg"]]);
}
