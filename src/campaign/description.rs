//! `campaign.description`: the question that a campaign answers, for people. No row depends on it.

use crate::sampling::keys::TextLimit;

/// Most characters of a description.
const LONGEST: usize = 1000;

pub(super) const LIMIT: TextLimit = TextLimit {
    allowed: "a text of 1 to 1000 characters",
    remedy: "write the question that the campaign answers, or delete the key",
    test: |text| {
        let text = in_one_line(text);
        !text.is_empty() && text.chars().count() <= LONGEST && !text.chars().any(char::is_control)
    },
};

/// The words of a text with one space between them.
pub(super) fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The first sentence of the comments that a file begins with, without "Question:"; `None` where it begins with something else. Lines that
/// are indented continue a sentence.
pub(super) fn of_comment(text: &str) -> Option<String> {
    let comments = text.lines().map_while(|line| line.trim_start().strip_prefix('#'));
    let mut found = String::new();
    for line in comments {
        let is_continued = line.starts_with("  ");
        if !found.is_empty() && !is_continued {
            break;
        }
        found = format!("{found} {}", line.trim()).trim().to_owned();
    }
    let found = found.strip_prefix("Question:").unwrap_or(&found);
    let found: String = found.chars().filter(|letter| !letter.is_control()).take(LONGEST).collect();
    let found = in_one_line(&found);
    (!found.is_empty()).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a question over several indented lines is one text; what follows it, and files without a comment, are not.
    #[test]
    fn the_first_comment_is_the_question() {
        let text = "# Question: how large\n#   is the drift?\n# Source: ours.\n\n[campaign]\n";
        assert_eq!(of_comment(text).as_deref(), Some("how large is the drift?"));
        assert_eq!(of_comment("# A campaign.\n").as_deref(), Some("A campaign."));
        assert_eq!(of_comment("[campaign]\n# no\n"), None);
        assert_eq!(of_comment("#\n"), None);
    }
}
