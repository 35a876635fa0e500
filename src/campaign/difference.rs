//! [`differences`], [`text_differences`]: the keys in which two plans differ.

use super::plan::Plan;

/// A key in which two plans differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyDifference {
    /// The dotted key, `integrator.method`, `disperse[2].std`.
    pub key: String,
    /// Its value in the first plan; `None` where it does not have the key.
    pub first: Option<String>,
    /// Its value in the second.
    pub second: Option<String>,
}

/// The keys in which two plans differ, in the order of their texts.
pub fn differences(first: &Plan, second: &Plan) -> Vec<KeyDifference> {
    text_differences(&first.text(), &second.text())
}

/// The same of two canonical texts, which have one key a line.
pub fn text_differences(first: &str, second: &str) -> Vec<KeyDifference> {
    let (first, second) = (keys(first), keys(second));
    let value = |list: &[(String, String)], key: &str| {
        list.iter().find(|(known, _)| known == key).map(|(_, value)| value.clone())
    };
    let gone = first.iter().filter_map(|(key, one)| {
        let other = value(&second, key);
        (other.as_ref() != Some(one)).then(|| KeyDifference {
            key: key.clone(),
            first: Some(one.clone()),
            second: other,
        })
    });
    let new = second.iter().filter(|(key, _)| value(&first, key).is_none());
    let new = new.map(|(key, one)| KeyDifference { key: key.clone(), first: None, second: Some(one.clone()) });
    gone.chain(new).collect()
}

/// Every key of a canonical text with its value; tables of a list have their number.
fn keys(text: &str) -> Vec<(String, String)> {
    let mut table = String::new();
    let mut lists: Vec<(String, usize)> = Vec::new();
    let mut found = Vec::new();
    for line in text.lines() {
        if let Some(list) = line.strip_prefix("[[").and_then(|rest| rest.strip_suffix("]]")) {
            let at = lists.iter().position(|(name, _)| name == list).unwrap_or_else(|| {
                lists.push((list.to_owned(), 0));
                lists.len() - 1
            });
            table = format!("{list}[{}]", lists[at].1);
            lists[at].1 += 1;
        } else if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            // a table within a table of a list, [disperse.angle_rad], belongs to the last of them
            let of_list = lists.iter().find_map(|(list, count)| {
                let rest = name.strip_prefix(list.as_str())?.strip_prefix('.')?;
                Some(format!("{list}[{}].{rest}", count - 1))
            });
            table = of_list.unwrap_or_else(|| name.to_owned());
        } else if let Some((key, value)) = line.split_once(" = ").filter(|_| !line.starts_with('#')) {
            found.push((format!("{table}.{key}"), value.to_owned()));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differing_keys_are_named() {
        let first = "[a]\nx = 1\ny = 2\n\n[[l]]\nname = \"p\"\n\n[l.inner]\nz = 3\n\n[[l]]\nname = \"q\"\n# x = 9\n";
        let second = "[a]\nx = 1\ny = 3\n\n[[l]]\nname = \"p\"\n\n[l.inner]\nz = 4\n\n[b]\nw = 5\n";
        let found = text_differences(first, second);
        let found: Vec<_> = found.iter().map(|d| (d.key.as_str(), d.first.as_deref(), d.second.as_deref())).collect();
        assert_eq!(
            found,
            [
                ("a.y", Some("2"), Some("3")),
                ("l[0].inner.z", Some("3"), Some("4")),
                ("l[1].name", Some("\"q\""), None),
                ("b.w", None, Some("5")),
            ]
        );
        assert!(text_differences(first, first).is_empty());
    }
}
