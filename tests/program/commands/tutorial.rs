//! `docs/tutorial.md`, done as it stands: its files are written, its commands run, and their output compared.

use crate::prelude::*;

#[derive(Debug, PartialEq)]
enum Step<'d> {
    Write { file: &'d str, text: String },
    Run { command: &'d str, code: i32 },
    Prints(Vec<&'d str>),
    Picture { figure: &'d str, picture: &'d str },
}

fn steps(document: &str) -> Vec<Step<'_>> {
    let (mut steps, mut file, mut figure) = (Vec::new(), None, None);
    let mut lines = document.lines();
    while let Some(line) = lines.next() {
        let mark = |name: &str| line.strip_prefix("<!-- ")?.strip_suffix(" -->")?.strip_prefix(name);
        if let Some(name) = mark("file: ") {
            file = Some(name);
        } else if let Some(name) = mark("picture: ") {
            figure = Some(name);
        } else if let Some(figure) = figure.take_if(|_| line.starts_with("![")) {
            let picture = line.split("](").nth(1).and_then(|rest| rest.strip_suffix(')')).unwrap();
            steps.push(Step::Picture { figure, picture });
        } else if let Some(language) = line.strip_prefix("```") {
            let block: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
            match language {
                "toml" => {
                    let file = file.unwrap();
                    steps.push(Step::Write { file, text: block.join("\n") + "\n\n" });
                }
                "sh" => steps.extend(block.into_iter().map(|line| {
                    let (command, code) = line.split_once("# exit code ").unwrap_or((line, "0"));
                    Step::Run { command: command.trim(), code: code.parse().unwrap() }
                })),
                "text" => steps.push(Step::Prints(block)),
                other => panic!("a block in {other:?} is not tested"),
            }
        }
    }
    steps
}

fn missing<'d>(printed: &str, expected: &[&'d str]) -> Option<&'d str> {
    let (mut rest, mut is_free) = (printed.lines(), true);
    for line in expected {
        if *line != "..." {
            let is_found = |printed: &str| printed.starts_with(line);
            let found = if is_free { rest.any(is_found) } else { rest.next().is_some_and(is_found) };
            if !found {
                return Some(line);
            }
        }
        is_free = *line == "...";
    }
    None
}

#[test]
fn the_tutorial_does_what_it_says() {
    let docs = root().join("docs");
    let document = std::fs::read_to_string(docs.join("tutorial.md")).unwrap();
    let scratch = ScratchFolder::new("tutorial");
    let (mut printed, mut counts) = (String::new(), [0; 4]);
    for step in steps(&document) {
        match step {
            Step::Write { file, text } => {
                let path = scratch.path(file);
                let before = std::fs::read_to_string(&path).unwrap_or_default();
                std::fs::write(path, before + &text).unwrap();
                counts[0] += 1;
            }
            Step::Run { command, code } => {
                let arguments = command.strip_prefix("spindrift ").unwrap();
                printed = scratch.prints(arguments, code);
                counts[1] += 1;
            }
            Step::Prints(expected) => {
                let missing = missing(&printed, &expected);
                assert!(missing.is_none(), "not printed: {}\n{printed}", missing.unwrap_or_default());
                counts[2] += 1;
            }
            Step::Picture { .. } => counts[3] += 1,
        }
    }
    assert!(counts[..3].iter().zip([5, 6, 5]).all(|(count, least)| *count >= least), "{counts:?} steps were done");
    let pictures = document.lines().filter(|line| line.starts_with("![") && !line.ends_with(".png)")).count();
    assert!(counts[3] == pictures && pictures >= 3, "{} of {pictures} pictures have a figure", counts[3]);
}
