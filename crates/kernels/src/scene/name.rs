//! [`Name`]: name of a wheel, thruster, part or arc.

use std::fmt::{self, Debug, Display, Formatter};

/// Largest number of letters of a name.
pub const MAX_LETTERS: usize = 23;

/// A lower-case letter, then lower-case letters, digits and underscores; in place, without allocation.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Name {
    bytes: [u8; MAX_LETTERS],
    len: u8,
}

impl Name {
    /// No name, for tables without instances.
    pub const NONE: Name = Name { bytes: [0; MAX_LETTERS], len: 0 };

    /// Description after "must be".
    pub const ALLOWED: &'static str =
        "a name of at most 23 lower-case letters, digits and underscores that starts with a letter";

    /// The name `text`, if valid.
    pub const fn new(text: &str) -> Option<Name> {
        let text = text.as_bytes();
        if text.is_empty() || text.len() > MAX_LETTERS || !text[0].is_ascii_lowercase() {
            return None;
        }
        let mut bytes = [0; MAX_LETTERS];
        let mut i = 0;
        while i < text.len() {
            if !(text[i].is_ascii_lowercase() || text[i].is_ascii_digit() || text[i] == b'_') {
                return None;
            }
            bytes[i] = text[i];
            i += 1;
        }
        Some(Name { bytes, len: text.len() as u8 })
    }

    /// The name `text`, known at compile time.
    ///
    /// # Panics
    /// If it is invalid.
    pub const fn of(text: &str) -> Name {
        match Name::new(text) {
            Some(name) => name,
            None => panic!("a name starts with a lower-case letter and has lower-case letters, digits and underscores"),
        }
    }

    /// The digits of `number`, for lists without names.
    pub fn number(number: usize) -> Name {
        let mut name = Name::NONE;
        for digit in number.to_string().bytes().take(MAX_LETTERS) {
            name.bytes[usize::from(name.len)] = digit;
            name.len += 1;
        }
        name
    }

    /// The text.
    pub fn as_str(&self) -> &str {
        // only ASCII letters are ever stored
        std::str::from_utf8(&self.bytes[..usize::from(self.len)]).unwrap_or_default()
    }
}

impl Display for Name {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl Debug for Name {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Debug::fmt(self.as_str(), f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_small_letters_digits_and_underscores() {
        for text in ["w1", "a", "reaction_wheel_2", "x23456789012345678901_3"] {
            assert_eq!(Name::new(text).expect(text).as_str(), text);
        }
        assert_eq!([0, 7, 20_000].map(|k| Name::number(k).to_string()), ["0", "7", "20000"]);
        for text in ["", "1w", "_w", "W1", "w-1", "w 1", "w.1", "roue_à", "a23456789012345678901234"] {
            assert_eq!(Name::new(text), None, "{text}");
        }
    }
}
