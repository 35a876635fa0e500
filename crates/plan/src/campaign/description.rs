//! `campaign.description`: the question that a campaign answers.

use super::sources::Sources;
use crate::sampling::keys::TextLimit;
use toml::de::DeTable;

const LONGEST: usize = 1000;

pub(super) const LIMIT: TextLimit = TextLimit {
    allowed: "a text of 1 to 1000 characters",
    remedy: "write the question that the campaign answers, or delete the key",
    test: |text| {
        let text = in_one_line(text);
        !text.is_empty() && text.chars().count() <= LONGEST && !text.chars().any(char::is_control)
    },
};

pub(super) fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The question of a campaign: the setting `campaign.description`, else the key or first comment of the first file that
/// has one, the extending file first.
pub(super) fn of_sources(sources: &Sources, written: Option<String>) -> Option<String> {
    if sources.list.iter().any(|source| source.key.as_deref() == Some("campaign.description")) {
        return written;
    }
    let files = sources.list.iter().filter(|source| source.key.is_none());
    files.map(|source| &sources.text[source.range.clone()]).find_map(|text| of_key(text).or_else(|| of_comment(text)))
}

fn of_key(text: &str) -> Option<String> {
    let (table, _) = DeTable::parse_recoverable(text);
    let campaign = table.get_ref().get("campaign")?.get_ref().as_table()?;
    Some(in_one_line(campaign.get("description")?.get_ref().as_str()?))
}

/// The first comment of a file, after blank lines and `extends`, without "Question:"; indented lines continue it.
fn of_comment(text: &str) -> Option<String> {
    let is_before = |line: &&str| line.trim().is_empty() || line.starts_with("extends") || line.starts_with("#:schema");
    let comments = text.lines().skip_while(is_before).map_while(|line| line.trim_start().strip_prefix('#'));
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

    /// Law: the first comment, over indented lines, is the question; later comments and tables are not.
    #[test]
    fn the_first_comment_is_the_question() {
        let text = "# Question: how large\n#   is the drift?\n# Source: ours.\n\n[campaign]\n";
        assert_eq!(of_comment(text).as_deref(), Some("how large is the drift?"));
        assert_eq!(of_comment("# A campaign.\n").as_deref(), Some("A campaign."));
        assert_eq!(of_comment("[campaign]\n# no\n"), None);
        assert_eq!(of_comment("#\n"), None);
        assert_eq!(of_comment("\nextends = \"b.toml\"\n\n# Question: and faster?\n").as_deref(), Some("and faster?"));
    }

    /// Law: a setting takes precedence over the file's key, its comment, and the file that it extends.
    #[test]
    fn a_variant_has_its_own_question() {
        let folder = std::env::temp_dir().join(format!("spindrift-question-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let key = "[campaign]\ndescription = \"parent by key\"\n";
        for (parent, child, set, asked) in [
            ("# Question: parent?\n", "# Question: child?\n", None, Some("child?")),
            ("# Question: parent?\n", "", None, Some("parent?")),
            (key, "# Question: child?\n", None, Some("child?")),
            (key, "", None, Some("parent by key")),
            (
                "# Question: parent?\n",
                "# A comment.\n[campaign]\ndescription = \"child by key\"\n",
                None,
                Some("child by key"),
            ),
            (key, "# Question: child?\n", Some("set"), Some("set")),
            ("", "", None, None),
        ] {
            std::fs::write(folder.join("parent.toml"), parent).unwrap();
            let (comment, table) = child.split_at(child.find('[').unwrap_or(child.len()));
            let text = format!("{comment}extends = \"parent.toml\"\n{table}");
            let settings: Vec<_> =
                set.map(|set| ("campaign.description".to_owned(), set.to_owned())).into_iter().collect();
            let sources = Sources::read(&folder, "child.toml", &text, &settings).expect("readable");
            assert_eq!(of_sources(&sources, set.map(str::to_owned)).as_deref(), asked, "{parent}, {child}");
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
