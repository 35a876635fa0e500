//! The words of the glossary in ARCHITECTURE.md: what they replace is nowhere where a user reads.

use crate::prelude::*;

fn words(architecture: &str) -> Vec<(String, String)> {
    let table = architecture.split_once("| say | not |").unwrap().1;
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let pair = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        (cells[0].to_owned(), cells[1].to_owned())
    };
    rows.map(pair).collect()
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        if path.is_dir() {
            files(&path, found);
        } else if ["rs", "md", "js"].contains(&ending) {
            found.push(path);
        }
    }
}

fn line_with<'t>(text: &'t str, phrase: &str) -> Option<&'t str> {
    text.lines().find(|line| !line.trim_start().starts_with("//") && line.to_lowercase().contains(phrase))
}

#[test]
fn words_are_those_of_the_glossary() {
    let words = words(&fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap());
    assert!(words.len() > 6, "{words:?}");
    let mut list = vec![root().join("README.md"), root().join("CHANGELOG.md")];
    for folder in ["docs", "src", "crates", "assets"] {
        files(&root().join(folder), &mut list);
    }
    for file in &list {
        let text = fs::read_to_string(file).unwrap();
        for (say, not) in &words {
            let found = line_with(&text, &not.to_lowercase());
            assert!(found.is_none(), "{}: say {say:?}, not {not:?}: {}", file.display(), found.unwrap_or_default());
        }
    }
    assert!(list.len() > 200, "{} files", list.len());
    assert!(
        line_with("a\n// runs up to a value\nRuns up to a value: b", "runs up to a value").is_some(),
        "it can fail"
    );
}
