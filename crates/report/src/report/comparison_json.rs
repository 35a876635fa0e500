//! A comparison of two results as JSON.

use serde_json::{Value, json};

use crate::analysis::comparison_table;
use crate::campaign::difference::KeyDifference;
use crate::findings::compared::{Compared, ComparedVerdict};
use crate::table::json::objects;

pub fn text(compared: &Compared<'_>) -> String {
    let Compared { comparison, keys, verdicts, tolerance, .. } = compared;
    let result = |name: String, which: usize| {
        let statistics = &comparison.statistics[which];
        json!({ "result": name, "samples": statistics.samples(), "ok": statistics.ok(),
            "only_here": comparison.alone[which] })
    };
    let key = |key: &KeyDifference| json!({ "key": key.key, "first": key.first, "second": key.second });
    let verdict = |one: &ComparedVerdict| {
        json!({
            "requirement": one.requirement,
            "first": one.word(0),
            "second": one.word(1),
            "is_worse": one.is_worse(),
            "is_within_chance": one.is_within_chance,
            "adjusted_p_value": one.p_value,
        })
    };
    let [first, second] = compared.names.clone();
    let failures = comparison.failures;
    let value = json!({
        "program": "spindrift",
        "version": env!("CARGO_PKG_VERSION"),
        "first": result(first, 0),
        "second": result(second, 1),
        "differing_keys": keys.iter().map(key).collect::<Vec<Value>>(),
        "compared_as": if comparison.pairs > 0 { "pairs" } else { "independent samples" },
        "pairs": comparison.pairs,
        "adjustment_of_p_values": "Holm",
        "level": comparison.level(),
        "tolerance": tolerance,
        "beyond_tolerance": tolerance.map(|tolerance| comparison.is_beyond(tolerance)),
        "share_not_ok": failures.shares(),
        "adjusted_p_value_not_ok": failures.adjusted_p_value,
        "requirements": verdicts.iter().map(verdict).collect::<Vec<Value>>(),
        "observables": objects(&comparison_table::table(comparison)),
    });
    format!("{value:#}\n")
}
