//! [`fitted`]: text that is shortened to a width.

/// What stands for letters that are left out.
const ELLIPSIS: &str = "...";

/// `text`, or its beginning and its end where it is wider than `width`: names that differ in a number at their end stay different.
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

    /// Law: text that fits is not changed; other text keeps its beginning and its end, and fits.
    #[test]
    fn text_is_shortened_in_its_middle() {
        let letters = |text: &str| text.chars().count();
        assert_eq!(fitted("wheel_number_7", 14, letters), "wheel_number_7");
        assert_eq!(fitted("wheel_number_7", 10, letters), "whee...r_7");
        assert_eq!(fitted("ωωωωωω", 5, letters), "ω...ω");
        assert_eq!(fitted("wheel_number_7", 3, letters), "...");
        assert_eq!(fitted("wheel_number_7", 2, letters), "");
    }
}
