//! Colour on the terminal: verdicts, headings of help, notes. Pipes get none unless requested.

use std::io::IsTerminal;

use clap::ValueEnum;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Colour {
    /// On a terminal, unless NO_COLOR is set or the terminal is dumb.
    Auto,
    Always,
    Never,
}

/// Valid before and after the command.
const OPTION: &str = "--color";

const RED: &str = "\x1b[31m";
const GREEN: &str = "\x1b[32m";
const YELLOW: &str = "\x1b[33m";
const BOLD: &str = "\x1b[1m";
const DIM: &str = "\x1b[2m";
const RESET: &str = "\x1b[0m";

const VERDICTS: [(&str, &str); 7] = [
    ("PASS", GREEN),
    ("FAIL", RED),
    ("FAILED", RED),
    ("FAILS", RED),
    ("WORSE", RED),
    ("BETTER", GREEN),
    ("UNDECIDED", YELLOW),
];

const HEADINGS: [&str; 6] = ["Usage:", "Arguments:", "Options:", "Commands:", "Examples:", "Exit codes:"];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A result, or help.
    Result,
    /// A note or an error.
    Note,
}

impl Colour {
    /// Reads the option even from invalid arguments, so that their error message is coloured too.
    fn asked(arguments: impl Iterator<Item = String>) -> Self {
        let mut asked = Colour::Auto;
        let mut arguments = arguments.peekable();
        while let Some(argument) = arguments.next() {
            let value = match argument.strip_prefix(OPTION) {
                Some("") => arguments.peek().cloned(),
                Some(rest) => rest.strip_prefix('=').map(str::to_owned),
                None => None,
            };
            if let Some(colour) = value.and_then(|value| Colour::from_str(&value, false).ok()) {
                asked = colour;
            }
        }
        asked
    }

    /// True if a stream gets colour; `variable` reads the environment.
    fn is_on(self, is_terminal: bool, variable: impl Fn(&str) -> Option<String>) -> bool {
        let is_set = |name: &str| variable(name).is_some_and(|value| !value.is_empty());
        match self {
            Colour::Always => true,
            Colour::Never => false,
            Colour::Auto => {
                is_terminal && !is_set("NO_COLOR") && is_set("TERM") && variable("TERM").as_deref() != Some("dumb")
            }
        }
    }
}

pub fn is_on(stream: &impl IsTerminal) -> bool {
    let arguments = std::env::args_os().map(|argument| argument.to_string_lossy().into_owned());
    Colour::asked(arguments).is_on(stream.is_terminal(), |name| std::env::var(name).ok())
}

pub fn coloured(text: &str, kind: Kind) -> String {
    // later lines of an error matter as much as the first
    let kind = if text.starts_with("error:") { Kind::Result } else { kind };
    text.split_inclusive('\n').map(|line| of_line(line, kind)).collect()
}

fn of_line(line: &str, kind: Kind) -> String {
    let content = line.trim_end_matches('\n');
    let end = &line[content.len()..];
    if content.is_empty() {
        return line.to_owned();
    }
    if let Some(rest) = content.strip_prefix("error:") {
        return format!("{RED}{BOLD}error:{RESET}{rest}{end}");
    }
    if kind == Kind::Note {
        return format!("{DIM}{content}{RESET}{end}");
    }
    if let Some((heading, rest)) = HEADINGS.iter().find_map(|heading| Some((heading, content.strip_prefix(heading)?))) {
        return format!("{BOLD}{heading}{RESET}{rest}{end}");
    }
    words(content) + end
}

fn words(text: &str) -> String {
    let is_between = |letter: char| !letter.is_alphanumeric() && letter != '_';
    let painted = |piece: &str| {
        let (word, after) = piece.split_at(piece.trim_end_matches(is_between).len());
        match VERDICTS.iter().find(|(verdict, _)| *verdict == word) {
            Some((_, colour)) => format!("{colour}{BOLD}{word}{RESET}{after}"),
            None => piece.to_owned(),
        }
    };
    text.split_inclusive(is_between).map(painted).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: with `auto` terminals get colour and pipes do not; a non-empty NO_COLOR or a dumb terminal disables it;
    /// `always` and `never` override both.
    #[test]
    fn a_pipe_has_no_colour() {
        let on = |colour: Colour, is_terminal: bool, no_color: Option<&str>, term: Option<&str>| {
            colour.is_on(is_terminal, |name| if name == "NO_COLOR" { no_color } else { term }.map(str::to_owned))
        };
        assert!(on(Colour::Auto, true, None, Some("xterm")) && on(Colour::Auto, true, Some(""), Some("xterm")));
        assert!(!on(Colour::Auto, false, None, Some("xterm")) && !on(Colour::Auto, true, Some("1"), Some("xterm")));
        assert!(!on(Colour::Auto, true, None, Some("dumb")) && !on(Colour::Auto, true, None, None));
        assert!(on(Colour::Always, false, Some("1"), None) && !on(Colour::Never, true, None, Some("xterm")));
    }
}
