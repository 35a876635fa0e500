//! Wrapping of text for terminals.

/// Wraps the lines of `text` at spaces. Continuations align with the text after the last gap of several spaces in the
/// left half, else are indented by two more characters.
pub fn wrapped(text: &str, width: usize) -> String {
    let mut lines = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (content, end) = line.strip_suffix('\n').map_or((line, ""), |content| (content, "\n"));
        if content.chars().count() <= width {
            lines += line;
            continue;
        }
        let indent = content.len() - content.trim_start().len();
        let gap =
            content.char_indices().filter(|(at, _)| *at > indent && *at <= width / 2 && content[..*at].ends_with("  "));
        let column = gap.filter(|(_, letter)| *letter != ' ').map(|(at, _)| at).next_back();
        let hanging = " ".repeat(column.unwrap_or(indent + 2).min(width / 2));
        let mut current = content[..indent].to_owned();
        let mut is_empty = true;
        for word in content[indent..].split(' ') {
            if !is_empty && current.chars().count() + 1 + word.chars().count() > width {
                lines += current.trim_end();
                lines.push('\n');
                current.clone_from(&hanging);
                is_empty = true;
            }
            if !is_empty {
                current.push(' ');
            }
            current += word;
            is_empty = false;
        }
        lines += &current;
        lines += end;
    }
    lines
}

/// Wraps a message. Marked lines of a file stay as they are; a command at the end of a line moves whole to a line of
/// its own, for copying.
pub fn message(text: &str, width: usize) -> String {
    let of_line = |line: &str| {
        let is_long = line.trim_end_matches('\n').chars().count() > width;
        if !is_long || line.trim_start().starts_with('|') {
            return line.to_owned();
        }
        match line.find(COMMAND) {
            Some(at) => {
                let (before, command) = line.split_at(at + 1);
                let indent = before.len() - before.trim_start().len() + 2;
                format!("{}\n{:indent$}{}", wrapped(before, width), "", command.trim_start())
            }
            None => wrapped(line, width),
        }
    };
    text.split_inclusive('\n').map(of_line).collect()
}

const COMMAND: &str = ": spindrift ";

const ELLIPSIS: &str = "...";

/// Shortens `text` in the middle to `width`, so that names with different numbers at the end stay distinct.
pub fn fitted(text: &str, width: usize, measure: impl Fn(&str) -> usize) -> String {
    if measure(text) <= width {
        return text.to_owned();
    }
    let letters: Vec<char> = text.chars().collect();
    let shortened = |kept: usize| {
        let (head, tail) = letters.split_at(kept - kept / 2);
        let tail = &tail[tail.len() - kept / 2..];
        head.iter().copied().chain(ELLIPSIS.chars()).chain(tail.iter().copied()).collect::<String>()
    };
    (0..letters.len()).rev().map(shortened).find(|text| measure(text) <= width).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: all words of a message stay in order; only marked lines, commands and single words exceed the width.
    #[test]
    fn messages_are_broken_and_marks_stay() {
        let marked = "    | colour = \"a colour that nobody has seen on any spacecraft\"\n    | ^^^^^^";
        let command = "spindrift simulate 'a folder/plan.toml' --sample 1234567 --set campaign.duration_s=20";
        let text = format!(
            "error: bad.toml:12: colour = 1: must be a number from 1 to 9 or none at all; delete it\n{marked}\n  that \
            run again: {command}\nshort\n"
        );
        for width in 20..200 {
            let broken = message(&text, width);
            let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
            assert_eq!(words(&broken), words(&text), "{width}");
            assert!(broken.contains(marked) && broken.contains(command), "{width}:\n{broken}");
            let may_be_long =
                |line: &str| line.contains('|') || line.trim_start() == command || !line.trim_start().contains(' ');
            let is_fit = |line: &str| line.chars().count() <= width || may_be_long(line);
            assert!(broken.lines().all(is_fit), "{width}:\n{broken}");
        }
        assert_eq!(message(&text, 200), text);
    }
}
