//! [`differences`], [`text_differences`]: the keys in which two plans differ.

use super::plan::Plan;

/// A key in which two plans differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyDifference {
    /// The dotted key, `integrator.method`, `guidance.coast.timeout_s`.
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

/// Every key of a canonical text with its value. A table of a list has its name, as `--set` writes it, or the parameter that it is about; one without
/// either has its number.
fn keys(text: &str) -> Vec<(String, String)> {
    let mut table = String::new();
    // lists, how many tables of each were read, and what the last one is called
    let mut lists: Vec<(&str, usize, String)> = Vec::new();
    let mut found = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(list) = line.strip_prefix("[[").and_then(|rest| rest.strip_suffix("]]")) {
            let at = lists.iter().position(|(name, ..)| *name == list).unwrap_or_else(|| {
                lists.push((list, 0, String::new()));
                lists.len() - 1
            });
            let (_, count, last) = &mut lists[at];
            *last = called(list, lines.clone()).unwrap_or_else(|| format!("{list}[{count}]"));
            *count += 1;
            table.clone_from(last);
        } else if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            // a table within a table of a list, [disperse.angle_rad], belongs to the last of them
            let of_list = lists.iter().find_map(|(list, _, last)| {
                let rest = name.strip_prefix(list)?.strip_prefix('.')?;
                Some(format!("{last}.{rest}"))
            });
            table = of_list.unwrap_or_else(|| name.to_owned());
        } else if let Some((key, value)) = line.split_once(" = ").filter(|_| !line.starts_with('#')) {
            found.push((format!("{table}.{key}"), value.to_owned()));
        }
    }
    found
}

/// What a table of `list` that has the keys in the first of `lines` is called: `guidance.coast`, `disperse[wheels.w1.rate_rad_s]`; `None` without a name.
fn called<'t>(list: &str, lines: impl Iterator<Item = &'t str>) -> Option<String> {
    let pairs = lines.take_while(|line| !line.starts_with('[')).filter_map(|line| line.split_once(" = "));
    let word = |value: &str| Some(value.strip_prefix('"')?.strip_suffix('"')?.to_owned());
    let mut words = pairs.filter_map(|(key, value)| Some((key, word(value)?)));
    words.find_map(|(key, word)| match key {
        "name" | "phase" => Some(format!("{list}.{word}")),
        "parameter" => Some(format!("{list}[{word}]")),
        _ => None,
    })
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
                ("l.p.inner.z", Some("3"), Some("4")),
                ("l.q.name", Some("\"q\""), None),
                ("b.w", None, Some("5")),
            ]
        );
        assert!(text_differences(first, first).is_empty());
        let names = |text: &str| keys(text).into_iter().map(|(key, _)| key).collect::<Vec<_>>();
        let text = "[[guidance]]\nuntil = \"launch\"\nphase = \"coast\"\n[[disperse]]\nparameter = \"w.x\"\n[[require]]\nat_most = 1\n[[require]]\nat_most = 2\n";
        assert_eq!(
            names(text),
            [
                "guidance.coast.until",
                "guidance.coast.phase",
                "disperse[w.x].parameter",
                "require[0].at_most",
                "require[1].at_most"
            ]
        );
    }
}
