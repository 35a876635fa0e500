use crate::prelude::*;

const LARGEST: u64 = 600_000;

fn problem(gallery: &str, name: &str, question: &str, samples: u64) -> Option<String> {
    let Some((_, entry)) = gallery.split_once(&format!("\n### {name}.toml\n\n")) else {
        return Some("there is no entry".to_owned());
    };
    let entry = entry.split("\n#").next().unwrap_or_default();
    let mut paragraphs = entry.trim().split("\n\n");
    let asked = paragraphs.next().unwrap_or_default();
    let asked = asked.trim_matches('*');
    if !asked.eq_ignore_ascii_case(question) {
        return Some(format!("it asks {asked:?} for {question:?}"));
    }
    let answer = paragraphs.next().unwrap_or_default();
    let grouped =
        if samples >= 1000 { format!("{},{:03}", samples / 1000, samples % 1000) } else { samples.to_string() };
    let runs = if samples == 1 { " 1 run, ".to_owned() } else { format!(" {grouped} runs, ") };
    let time = answer.split_once(&runs).and_then(|(_, rest)| rest.strip_suffix(" s."));
    if time.and_then(|time| time.parse::<f64>().ok()).is_none_or(|time| time <= 0.0) || answer.len() < 30 {
        return Some(format!("no answer with {runs:?} and a time: {answer:?}"));
    }
    let picture = format!("figures/gallery/{name}.svg");
    // the figure that it is: crates/figures/tests/gallery.rs draws it again
    let shown = paragraphs.next().unwrap_or_default();
    if !shown.starts_with("<!-- picture: ") || !shown.ends_with(&format!("]({picture})")) {
        return Some("there is no picture".to_owned());
    }
    let size = fs::metadata(root().join("docs").join(&picture)).map_or(0, |found| found.len());
    (!(1..LARGEST).contains(&size)).then(|| format!("{picture} is missing or too large: {size} bytes"))
}

#[test]
fn every_campaign_is_in_the_gallery() {
    let gallery = fs::read_to_string(root().join("docs/gallery.md")).unwrap();
    let files = files();
    for file in &files {
        let text = fs::read_to_string(file).unwrap();
        let plan = Plan::from_text_in(&root().join("campaigns"), "c.toml", &text, Overrides::default()).unwrap();
        let question = plan.description.clone().unwrap();
        let name = file.file_stem().unwrap().to_string_lossy();
        let found = problem(&gallery, &name, &question, plan.samples);
        assert!(found.is_none(), "{name}: {}", found.unwrap_or_default());
        // another question, another number of runs or no entry would be seen
        assert!(problem(&gallery, &name, "Is it?", plan.samples).is_some());
        assert!(problem(&gallery, &name, &question, plan.samples + 1).is_some());
        assert!(problem(&gallery.replace(&format!("### {name}.toml"), ""), &name, &question, plan.samples).is_some());
    }
    assert_eq!(gallery.matches("\n### ").count(), files.len(), "an entry for each campaign");
    let pictures = fs::read_dir(root().join("docs/figures/gallery")).unwrap().count();
    assert_eq!(pictures, files.len(), "a picture for each campaign");
}
