//! [`differences`]: the keys in which two plans differ, from their canonical texts.

use std::collections::BTreeMap;

/// The values of a canonical text by the path of their key: `[[wheels]]` number 1, key `radius_m` is `wheels[1].radius_m`.
fn values(text: &str) -> BTreeMap<String, &str> {
    let (mut table, mut counts, mut values) = (String::new(), BTreeMap::<&str, usize>::new(), BTreeMap::new());
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        if let Some(name) = line.strip_prefix("[[").and_then(|rest| rest.strip_suffix("]]")) {
            let count = counts.entry(name).or_default();
            table = format!("{name}[{count}]");
            *count += 1;
        } else if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            table = name.to_owned();
            if let Some((parent, rest)) = name.split_once('.')
                && let Some(count) = counts.get(parent)
            {
                table = format!("{parent}[{}].{rest}", count - 1);
            }
        } else if let Some((key, value)) = line.split_once(" = ") {
            values.insert(format!("{table}.{key}"), value);
        }
    }
    values
}

/// The keys whose values differ between the canonical texts `old` and `new`, each with both values; `absent` where a text lacks it.
pub fn differences(old: &str, new: &str) -> Vec<String> {
    let (old, new) = (values(old), values(new));
    let keys: std::collections::BTreeSet<&String> = old.keys().chain(new.keys()).collect();
    let value =
        |values: &BTreeMap<String, &str>, key: &String| values.get(key).map_or("absent", |value| *value).to_owned();
    keys.into_iter()
        .filter(|key| old.get(*key) != new.get(*key))
        .map(|key| format!("{key}: {} there, {} here", value(&old, key), value(&new, key)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const OLD: &str = "[campaign]\nseed = 1\n\n[[wheels]]\nradius_m = 0.5\n\n[[wheels]]\nradius_m = 0.6\n";

    /// Law: every changed, added and removed value is named with its table, and nothing else.
    #[test]
    fn changed_keys_are_named() {
        assert_eq!(differences(OLD, OLD), Vec::<String>::new());
        let new = OLD.replace("0.6", "0.7");
        assert_eq!(differences(OLD, &new), ["wheels[1].radius_m: 0.6 there, 0.7 here"]);
        let new = format!("{OLD}[audit]\nfraction = 0.5\n");
        assert_eq!(differences(OLD, &new), ["audit.fraction: absent there, 0.5 here"]);
        assert_eq!(differences(&new, OLD), ["audit.fraction: 0.5 there, absent here"]);
    }
}
