//! The JSON Schema of campaign files accepts what the program accepts, and refuses wrong names and types.

use crate::prelude::*;
use serde_json::json;
use spindrift::campaign::schema::schema;
use spindrift::control::tables::Loops;

use crate::support::every_key::every_loop;

/// True if `value` obeys `schema`, whose keywords must be of draft 4.
fn obeys(schema: &Value, value: &Value) -> bool {
    is_valid(schema, schema, value)
}

fn is_valid(root: &Value, schema: &Value, value: &Value) -> bool {
    let obeys = |schema: &Value, value: &Value| is_valid(root, schema, value);
    let keywords = schema.as_object().unwrap();
    keywords.iter().all(|(keyword, wanted)| {
        let list = || wanted.as_array().expect(keyword);
        let size = || wanted.as_u64().expect(keyword) as usize;
        let bound = |is_within: fn(&f64, &f64) -> bool, exclusive: &str| {
            let is_exclusive = keywords.get(exclusive).is_some_and(|exclusive| exclusive == true);
            let bound = wanted.as_f64().expect(keyword);
            value.as_f64().is_none_or(|number| is_within(&number, &bound) && !(is_exclusive && number == bound))
        };
        match keyword.as_str() {
            "$ref" => {
                let place = wanted.as_str().and_then(|place| place.strip_prefix('#')).unwrap();
                obeys(root.pointer(place).expect(place), value)
            }
            "$schema" | "definitions" | "title" | "description" | "default" | "exclusiveMinimum"
            | "exclusiveMaximum" => true,
            "type" if wanted.is_array() => list().iter().any(|one| obeys(&json!({"type": one}), value)),
            "type" => match wanted.as_str().unwrap() {
                "object" => value.is_object(),
                "array" => value.is_array(),
                "string" => value.is_string(),
                "boolean" => value.is_boolean(),
                "integer" => value.is_i64() || value.is_u64(),
                "number" => value.is_number(),
                other => panic!("the type {other}"),
            },
            "enum" => list().contains(value),
            "minimum" => bound(f64::ge, "exclusiveMinimum"),
            "maximum" => bound(f64::le, "exclusiveMaximum"),
            "items" => value.as_array().is_none_or(|items| items.iter().all(|item| obeys(wanted, item))),
            "minItems" => value.as_array().is_none_or(|items| items.len() >= size()),
            "maxItems" => value.as_array().is_none_or(|items| items.len() <= size()),
            "uniqueItems" => value
                .as_array()
                .is_none_or(|items| items.iter().enumerate().all(|(place, item)| !items[..place].contains(item))),
            "properties" => value.as_object().is_none_or(|object| {
                object.iter().all(|(key, inner)| wanted.get(key).is_none_or(|schema| obeys(schema, inner)))
            }),
            "additionalProperties" => value.as_object().is_none_or(|object| {
                let others =
                    object.iter().filter(|(key, _)| keywords.get("properties").is_none_or(|of| of.get(key).is_none()));
                others
                    .into_iter()
                    .all(|(_, inner)| if wanted.is_object() { obeys(wanted, inner) } else { *wanted == true })
            }),
            "required" => value
                .as_object()
                .is_none_or(|object| list().iter().all(|key| object.contains_key(key.as_str().unwrap()))),
            "anyOf" => list().iter().any(|schema| obeys(schema, value)),
            "not" => !obeys(wanted, value),
            other => panic!("the keyword {other} is not of the ones that are checked here"),
        }
    })
}

fn parsed(text: &str) -> Value {
    let table: toml::Table = text.parse().unwrap_or_else(|error| panic!("{error}\n{text}"));
    serde_json::to_value(table).unwrap()
}

fn files() -> Vec<(String, String)> {
    let entries = std::fs::read_dir("campaigns").unwrap().map(|entry| entry.unwrap().path());
    let shipped = entries.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let text = |path: std::path::PathBuf| (path.display().to_string(), std::fs::read_to_string(path).unwrap());
    let mut files: Vec<(String, String)> = shipped.map(text).collect();
    assert!(files.len() > 10);
    let dispersed = distribution_tables().into_iter().map(|(_, table)| without_draws() + &table);
    let others = [EVERY_TABLE.to_owned()].into_iter().chain(every_scene()).chain(every_loop()).chain(dispersed);
    files.extend(others.map(|text| (text.clone(), text)));
    files
}

#[test]
fn valid_files_are_accepted() {
    let schema = schema(&Loops);
    for (name, text) in files() {
        assert!(obeys(&schema, &parsed(&text)), "{name}");
    }
}

/// `value` with the value at each place replaced by `other`, or its key by another one.
fn changed(value: &Value, other: &dyn Fn(&Value) -> Option<Value>, path: &str, found: &mut Vec<(String, Value)>) {
    let mut within = |path: String, inner: &Value, with: &dyn Fn(Value) -> Value| {
        let mut of_inner = Vec::new();
        changed(inner, other, &path, &mut of_inner);
        found.extend(of_inner.into_iter().map(|(path, inner)| (path, with(inner))));
    };
    match value {
        Value::Object(object) => {
            for (key, inner) in object {
                within(format!("{path}.{key}"), inner, &|inner| {
                    let mut object = object.clone();
                    object.insert(key.clone(), inner);
                    object.into()
                });
            }
        }
        Value::Array(list) if list.iter().all(Value::is_object) => {
            for (place, inner) in list.iter().enumerate() {
                within(format!("{path}[{place}]"), inner, &|inner| {
                    let mut list = list.clone();
                    list[place] = inner;
                    list.into()
                });
            }
        }
        _ => {}
    }
    found.extend(other(value).map(|value| (path.to_owned(), value)));
}

const BY_NAME: [&str; 3] = ["thrust_n", "torque_n_m", "display.columns"];

/// Law: a key that no table has is refused in every table, and a value of another type for every key.
#[test]
fn wrong_names_and_types_are_refused() {
    let schema = schema(&Loops);
    let mut count = 0;
    for (name, text) in files() {
        let mut wrong = Vec::new();
        let unknown = |value: &Value| {
            let mut object = value.as_object()?.clone();
            object.insert("no_such_key".to_owned(), json!(1));
            Some(object.into())
        };
        let of_no_type = |value: &Value| (!value.is_object()).then(|| json!({"no_such_key": [[null]]}));
        changed(&parsed(&text), &unknown, "", &mut wrong);
        changed(&parsed(&text), &of_no_type, "", &mut wrong);
        for (path, value) in wrong.into_iter().filter(|(path, _)| !BY_NAME.iter().any(|table| path.ends_with(table))) {
            count += 1;
            assert!(!obeys(&schema, &value), "accepted in {name}: {path}");
        }
    }
    assert!(count > 5000, "{count}");
}

/// Law: numbers beyond limits and words of no list are refused, and units accepted; a file that extends another may
/// leave out what that has.
#[test]
fn limits_and_words_are_those_of_the_program() {
    let schema = schema(&Loops);
    let is_accepted = |from: &str, to: &str| {
        assert!(EVERY_TABLE.contains(from), "{from}");
        obeys(&schema, &parsed(&EVERY_TABLE.replacen(from, to, 1)))
    };
    for (from, wrong, right) in [
        ("duration_s = 10.0\n", "duration_s = 0.0\n", "duration_s = 1\n"),
        ("seed = 1\n", "seed = 1.5\n", "seed = 0\n"),
        ("method = \"auto\"", "method = \"automatic\"", "method = \"taylor\""),
        ("tolerance = 1e-10", "tolerance = 1.0", "tolerance = 1e-2"),
        ("radius_m = 0.1", "radius_m = -0.1", "radius_m = \"10 cm\""),
    ] {
        assert!(!is_accepted(from, wrong) && is_accepted(from, right), "{wrong:?}, {right:?}");
    }
    let variant = "extends = \"base.toml\"\n[campaign]\nsamples = 5\n[[wheels]]\nname = \"w1\"\nrate_rad_s = 3\n";
    assert!(obeys(&schema, &parsed(variant)));
}
