//! Names of quantities on the page: unique words in customary units; technical names are in tooltips and commands.

use crate::prelude::*;

const SYMBOLS: [&str; 10] = ["F_s", "F_e", "F_d", "F_o", "C_es", "q_es", "omega_se", "A_d", "H_s", "n_d"];

fn texts(page: &str) -> Vec<String> {
    let mut text = page.to_owned();
    for (start, end) in [
        ("<style", "</style>"),
        ("<code", "</code>"),
        ("<pre", "</pre>"),
        ("<h1", "</h1>"),
        ("<title>", "</title>"),
        ("<p class=\"facts\"", "</p>"),
        ("<p class=\"question\"", "</p>"),
        ("<span class=\"quiet\"", "</span>"),
    ] {
        while let Some(from) = text.find(start) {
            let Some(length) = text[from..].find(end) else { break };
            text.replace_range(from..from + length + end.len(), " ");
        }
    }
    text.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text.trim().to_owned()).collect()
}

fn technical(text: &str) -> Vec<String> {
    let words = text.split(|letter: char| !(letter.is_ascii_alphanumeric() || letter == '_' || letter == '.'));
    let is_name = |word: &&str| word.contains('_') && !SYMBOLS.iter().any(|symbol| word.starts_with(symbol));
    words.filter(is_name).map(str::to_owned).collect()
}

fn names_of(figure: &Value) -> Vec<String> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let mut names = vec![text(&figure["title"]), text(&figure["x"]["quantity"]), text(&figure["y"]["quantity"])];
    for axis in ["x", "y"] {
        names.extend(figure[axis]["names"].as_array().into_iter().flatten().map(text));
    }
    names.extend(figure["marks"].as_array().into_iter().flatten().map(|mark| text(&mark["label"])));
    names
}

/// Law: no name has an underscore or two meanings, and angles are in degrees unless the file says otherwise.
#[test]
fn shown_names_are_words_and_unique() {
    let scratch = ScratchFolder::new("page-names");
    let mut seen = 0;
    for path in files() {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let command = format!("campaign {} --samples 12 --out {name}", path.display());
        let output = scratch.command(&command).output().unwrap();
        assert!(matches!(output.status.code(), Some(0 | 1 | 3 | 5)), "{name}: {output:?}");
        let page = scratch.text(&format!("{name}/report.html"));
        let data = Found::data_of(&page);
        let file = format!("{}{}", fs::read_to_string(&path).unwrap(), scratch.text(&format!("{name}/plan.toml")));
        let is_phase = |word: &String| file.contains(&format!("phase = \"{word}\""));

        let mut wrong: Vec<String> = Vec::new();
        let figures = data["figures"].as_array().unwrap();
        let mut titles: BTreeMap<String, String> = BTreeMap::new();
        for figure in figures {
            let of = figure["name"].as_str().unwrap();
            wrong.extend(names_of(figure).iter().flat_map(|name| technical(name)).map(|word| format!("{of}: {word}")));
            let title = figure["title"].as_str().unwrap().to_owned();
            if let Some(other) = titles.insert(title.clone(), of.to_owned()) {
                wrong.push(format!("{other} and {of} are both called {title}"));
            }
            for axis in ["x", "y"] {
                let unit = figure[axis]["unit"].as_str().unwrap_or_default();
                if ["rad", "rad/s"].contains(&unit) && !file.contains(&format!("\"{unit}\"")) {
                    wrong.push(format!("{of} is in {unit}"));
                }
            }
        }
        let columns = data["pairs"]["columns"].as_array().cloned().unwrap_or_default();
        let mut called: BTreeMap<String, String> = BTreeMap::new();
        for column in &columns {
            let [name, of] = ["name", "column"].map(|key| column[key].as_str().expect(key).to_owned());
            wrong.extend(technical(&name));
            if let Some(other) = called.insert(name.clone(), of.clone()) {
                wrong.push(format!("{other} and {of} are both called {name}"));
            }
        }
        for run in data["replay"]["runs"].as_array().into_iter().flatten() {
            for number in run["live"].as_array().into_iter().flatten() {
                wrong.extend(technical(number["name"].as_str().unwrap_or_default()));
            }
        }
        let visible = page.split_once("<script").unwrap().0;
        let (_, statistics) = visible.split_once("id=\"statistics\"").unwrap();
        let mut rows: BTreeMap<&str, &str> = BTreeMap::new();
        for row in statistics.split("<th scope=\"row\" title=\"").skip(1) {
            let Some((title, rest)) = row.split_once("\">") else { continue };
            let (column, shown) =
                (title.split(':').next().unwrap_or_default(), rest.split('<').next().unwrap_or_default());
            if let Some(other) = rows.insert(shown, column) {
                wrong.push(format!("{other} and {column} are both called {shown}"));
            }
        }
        let sentences = visible.split("<section id=\"provenance\"").next().unwrap();
        wrong.extend(texts(sentences).iter().flat_map(|text| technical(text)));
        wrong.retain(|word| !is_phase(&word.rsplit(' ').next().unwrap_or_default().to_owned()));
        assert!(wrong.is_empty(), "{name}: {wrong:#?}");
        seen += rows.len();
    }
    assert!(seen > 1000, "{seen} rows of statistics");
}
