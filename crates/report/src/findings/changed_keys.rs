//! The differing keys of two plans, as a [`table`] or as [`phrases`]. Keys with the same change share a line, as do all
//! keys of a table that only one plan has.

use crate::campaign::Plan;
use crate::campaign::difference::{KeyDifference, said};
use crate::findings::number::counted;
use crate::table::Table;
use crate::table::text::Align;
use crate::table::wrapped::fitted;

const LONGEST_VALUE: usize = 40;
const ABSENT: &str = "-";
/// Stands for the values of several keys.
const THERE: &str = "there";

/// A key, or the pattern of several keys, with the value in each plan.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Line {
    key: String,
    count: usize,
    values: [String; 2],
}

pub fn table(keys: &[KeyDifference], plans: [&Plan; 2]) -> Table<'static> {
    let heads = [("changed in the file", Align::Title), ("before", Align::Whole), ("after", Align::Whole)];
    let mut table = Table::with(heads);
    for Line { key, count, values } in lines(keys, Some(plans)) {
        let key = if count > 1 { format!("{key} ({count} keys)") } else { key };
        let [first, second] = values.each_ref().map(|value| fitted(value, LONGEST_VALUE, |text| text.chars().count()));
        table.row([key, first, second]);
    }
    table
}

/// At most `most` phrases, then the number of remaining keys. `plans` is given if both can be read.
pub fn phrases(keys: &[KeyDifference], plans: Option<[&Plan; 2]>, most: usize) -> Vec<String> {
    let all = lines(keys, plans);
    let phrase = |Line { key, values: [before, after], .. }: &Line| match (before.as_str(), after.as_str()) {
        (ABSENT, THERE) => format!("new: {key}"),
        (THERE, ABSENT) => format!("gone: {key}"),
        (ABSENT, after) => format!("new: {key} = {after}"),
        (before, ABSENT) => format!("gone: {key} = {before}"),
        (before, after) => format!("{key}: {before} -> {after}"),
    };
    let left: usize = all.iter().skip(most).map(|line| line.count).sum();
    let more = (left > 0).then(|| counted(left, "more key"));
    all.iter().take(most).map(phrase).chain(more).collect()
}

fn lines(keys: &[KeyDifference], plans: Option<[&Plan; 2]>) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for one in keys {
        let values = said(plans, &one.key, [one.first.as_deref(), one.second.as_deref()]);
        let values = values.map(|value| value.unwrap_or_else(|| ABSENT.to_owned()));
        match lines.iter_mut().find_map(|line| Some((common(&line.key, &one.key, &line.values, &values)?, line))) {
            Some(((key, values), line)) => *line = Line { key, count: line.count + 1, values },
            None => lines.push(Line { key: one.key.clone(), count: 1, values }),
        }
    }
    lines
}

/// Merges two keys if both changed alike (`guidance.*.bandwidth_rad_s`) or both belong to a table that only one plan
/// has. Returns the pattern and the values.
fn common(key: &str, other: &str, values: &[String; 2], of_other: &[String; 2]) -> Option<(String, [String; 2])> {
    let of = |key: &str| key.rsplit_once('.').map(|(table, last)| (table.to_owned(), last.to_owned()));
    let ((table, last), (other_table, other_last)) = (of(key)?, of(other)?);
    let [is_new, is_gone] = [0, 1].map(|side| values[side] == ABSENT && of_other[side] == ABSENT);
    let listed = key.strip_suffix(".*").unwrap_or(&table);
    if (is_new || is_gone) && listed == other_table {
        let (there, absent) = (THERE.to_owned(), ABSENT.to_owned());
        let values = if is_new { [absent, there] } else { [there, absent] };
        return Some((format!("{listed}.*"), values));
    }
    let list = |table: &str| table.split(['.', '[']).next().map(str::to_owned);
    let is_alike =
        last == other_last && values == of_other && table != other_table && list(&table) == list(&other_table);
    (is_alike && last != "*").then(|| (format!("{}.*.{last}", list(&table).unwrap_or_default()), values.clone()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::difference::{said, text_differences};
    use crate::findings::shipped;

    /// Law: keys with the same change share one line, tables that only one plan has take one line, every key is counted
    /// once.
    #[test]
    fn keys_that_changed_alike_stand_together() {
        let plan = shipped::plan("net_launch");
        let gains = |gain: &str| {
            format!("[[guidance]]\nphase = \"a\"\ngain = {gain}\nk = 1\n[[guidance]]\nphase = \"b\"\ngain = {gain}\n")
        };
        let first = gains("1.0") + "[campaign]\nseed = 1\n[[disperse]]\nparameter = \"x\"\nstd = 1.0\n";
        let second = gains("2.0").replace("k = 1", "k = 2")
            + "[campaign]\nseed = 1\n[[disperse]]\nparameter = \"y\"\nstd = 2.0\nmean = 0.0\n";
        let keys = text_differences(&first, &second);
        let found = lines(&keys, Some([&plan, &plan]));
        let line = |key: &str, count, values: [&str; 2]| Line {
            key: key.to_owned(),
            count,
            values: values.map(str::to_owned),
        };
        assert_eq!(
            found,
            [
                line("guidance.*.gain", 2, ["1", "2"]),
                line("guidance.a.k", 1, ["1", "2"]),
                line("disperse[x].*", 2, ["there", "-"]),
                line("disperse[y].*", 3, ["-", "there"]),
            ]
        );
        assert_eq!(found.iter().map(|line| line.count).sum::<usize>(), keys.len());
        assert_eq!(
            phrases(&keys, Some([&plan; 2]), 3),
            ["guidance.*.gain: 1 -> 2", "guidance.a.k: 1 -> 2", "gone: disperse[x].*", "3 more keys"]
        );
        assert_eq!(phrases(&text_differences("a = 1.0\n", "b = 2\n"), None, 4), ["gone: .a = 1", "new: .b = 2"]);
    }

    /// Law: both values of a key have one unit, in which they differ, shown with both or, if the key names it, with
    /// neither; requirements about different quantities keep their own.
    #[test]
    fn both_values_are_in_one_unit() {
        let plan = shipped::plan("net_launch");
        let radians = core::f64::consts::PI / 180.0;
        let rates = "initial.angular_velocity_rad_s";
        let ten = format!("[0.0, 0.0, {:?}]", 10.0 * radians);
        let near = format!("{:?}", 10.0 * radians + 1e-9);
        for (key, values, known) in [
            (rates, [&ten[..], "[0.0, 0.0, 0.25]"], ["[0, 0, 10] deg/s", "[0, 0, 14.324] deg/s"]),
            (rates, ["[0.0, 0.0, 0.25]", &ten[..]], ["[0, 0, 14.324] deg/s", "[0, 0, 10] deg/s"]),
            (rates, ["[0.0, 0.0, 0.5]", "[0.0, 0.0, 0.25]"], ["[0, 0, 0.5]", "[0, 0, 0.25]"]),
            ("disperse[initial.position_m].std", ["1.5", "2.0"], ["1.5 m", "2 m"]),
            ("guidance.aim.max_rate_rad_s", ["0.17453292", &near], ["0.17453292", &near]),
            ("campaign.duration_s", ["600.0", "30.0"], ["600", "30"]),
            ("integrator.method", ["\"auto\"", "\"taylor\""], ["\"auto\"", "\"taylor\""]),
        ] {
            let found = said(Some([&plan; 2]), key, values.map(Some));
            assert_eq!(found.each_ref().map(Option::as_deref), known.map(Some), "{key}");
        }
        let other = shipped::plan("nadir_pointing");
        let limit = format!("{:?}", 0.1 * radians);
        let found = said(Some([&plan, &other]), "require[0].at_most", [Some("1.0"), Some(&limit)]);
        assert_eq!(found, ["1", "0.1 deg"].map(|text| Some(text.to_owned())));
    }
}
