//! Tables of the commands at every width of a terminal.

use crate::prelude::*;

const LONGEST_WORD: usize = 60;

/// Law: at every width each number of the wide output is there, whole, and a longer line is a single word.
#[test]
fn numbers_stand_whole_at_every_width() {
    let scratch = folder("widths");
    for seed in [1, 2] {
        scratch.small(&format!("--samples 40 --no-report --seed {seed} --out r{seed}"), 0);
    }
    let numbers = |text: &str| -> BTreeSet<String> {
        let is_number =
            |word: &&str| word.trim_start_matches(['-', '[', '(']).starts_with(|x: char| x.is_ascii_digit());
        text.split_whitespace().filter(is_number).map(str::to_owned).collect()
    };
    for command in ["sample small.toml", "compare r1 r2 --verbose", "index .", "columns nutation"] {
        let at = |width: usize| scratch.prints_at(command, 0, width);
        let all = numbers(&at(1000));
        for width in (40..=200).step_by(16) {
            let text = at(width);
            let shown = numbers(&text);
            let missing: Vec<&String> = all.difference(&shown).collect();
            assert!(missing.is_empty(), "{command} at {width}: {missing:?}\n{text}");
            for line in text.lines().filter(|line| line.chars().count() > width) {
                let is_word = line.split_whitespace().count() == 1 && line.trim().len() <= LONGEST_WORD;
                assert!(is_word, "{command} at {width}: {line}");
            }
        }
    }
}
