//! [`quoted`]: texts and paths as words of a POSIX shell.

use std::path::Path;

/// `text` as one word, in single quotes if needed.
pub fn quoted(text: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"_-./=+:,@".contains(&byte);
    if !text.is_empty() && text.bytes().all(is_plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

pub fn quoted_path(path: &Path) -> String {
    quoted(&path.to_string_lossy())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a shell reads a quoted text as that text.
    #[test]
    fn words_are_quoted_where_they_need_it() {
        assert_eq!(quoted("results/a-b_1.0"), "results/a-b_1.0");
        assert_eq!(quoted(""), "''");
        assert_eq!(quoted("my results/$(rm x)"), "'my results/$(rm x)'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted_path(Path::new("r out/plan.toml")), "'r out/plan.toml'");
    }
}
