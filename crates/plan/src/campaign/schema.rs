//! [`schema`]: the JSON Schema (draft 4) of campaign files, with which editors complete and check them.
//!
//! It follows from the declared keys, without required keys, rules between keys, names of other tables and units in
//! texts, which `spindrift check` checks.

use super::loop_tables::LoopTables;
use super::parameter::PARAMETER;
use super::scene_table::SceneTable;
use super::size::MOST_TABLES;
use super::{data_keys, draws, failure_tables, scene, settings};
use crate::sampling::keys::{ANY, Kind, Presence, Range, Row, above, at_least};
use crate::sampling::{Design, DistributionKind};
use crate::scene::schema::{Facts, Limit, Shape};
use crate::scene::{LawParameter, Name};
use serde_json::{Map, Value as Json, json};
use std::ops::Bound;

/// The keys of a table, each with its schema.
#[derive(Default)]
pub struct Keys(pub Map<String, Json>);

impl Keys {
    pub fn of(rows: &[Row]) -> Self {
        let mut keys = Keys::default();
        rows.iter().for_each(|row| keys.add_row(row));
        keys
    }

    fn add(&mut self, key: &str, value: Json) {
        self.0.entry(key).or_insert(value);
    }

    fn add_row(&mut self, row: &Row) {
        let files: &[Row] = match row.kind {
            Kind::Column => &data_keys::COLUMN,
            Kind::Columns => &data_keys::COLUMNS,
            _ => &[],
        };
        files.iter().for_each(|row| self.add_row(row));
        let mut value = of_kind(row);
        value["description"] = row.meaning.into();
        if let Presence::Or(number) = row.presence {
            value["default"] = number.into();
        }
        self.add(row.key, value);
    }

    fn add_number(&mut self, facts: &Facts, default: Option<Json>) {
        let mut value = of_facts(facts);
        let unit = if facts.unit == "1" { String::new() } else { format!(", {}", facts.unit) };
        value["description"] = format!("{}{unit}", facts.meaning).into();
        if let Some(default) = default {
            value["default"] = default;
        }
        self.add(facts.key, value);
    }

    pub fn add_parameters(&mut self, list: &[LawParameter]) {
        for parameter in list {
            let default = parameter.default.map(|numbers| match numbers {
                [number] => json!(number),
                several => json!(several),
            });
            self.add_number(&parameter.facts, default);
        }
    }

    fn of_scene(table: &SceneTable) -> Self {
        let mut keys = Keys::default();
        for field in table.fields.into_iter().flatten() {
            keys.add_row(&field.row);
        }
        for key in table.numbers.iter().flat_map(|table| table.keys()) {
            keys.add_number(key.facts(), key.default_text().and_then(|text| serde_json::from_str(&text).ok()));
        }
        if table.most.is_some() {
            keys.add("name", json!({"type": "string", "description": format!("Its name: {}", Name::ALLOWED)}));
        }
        keys
    }

    pub fn table(self) -> Json {
        json!({"type": "object", "properties": self.0, "additionalProperties": false})
    }
}

/// One alternative for each kind, named by `key`.
pub fn one_of<'k>(key: &str, kinds: impl Iterator<Item = (&'k str, Keys)>) -> Json {
    let table = |(name, mut keys): (&str, Keys)| {
        keys.0.insert(key.to_owned(), json!({"enum": [name]}));
        keys.table()
    };
    json!({"anyOf": kinds.map(table).collect::<Vec<_>>()})
}

/// The JSON Schema of campaign files, with the tables of `loops`.
pub fn schema(loops: &dyn LoopTables) -> Json {
    let mut file = Keys::default();
    file.add("extends", json!({"type": "string", "description": "The file that this one changes"}));
    // adds a table, or a list of at most so many, at its dotted header
    let mut add = |header: &str, most: Option<usize>, table: Json| {
        let value = match most {
            Some(usize::MAX) => json!({"type": "array", "items": table}),
            Some(most) => json!({"type": "array", "items": table, "maxItems": most}),
            None => table,
        };
        match header.split_once('.') {
            Some((outer, inner)) => file.0[outer]["properties"][inner] = value,
            None => file.add(header, value),
        }
    };
    for (header, rows) in settings::HEAD.iter().chain(&settings::TAIL) {
        add(header, None, Keys::of(rows).table());
    }
    for table in scene::TABLES.iter().chain([&failure_tables::TABLE]) {
        add(table.numbers[0].header(), table.most, Keys::of_scene(table).table());
    }
    for (header, most, table) in loops.schema() {
        add(header, most, table);
    }
    add("design", None, one_of("kind", Design::NAMES.iter().map(|name| (*name, design(name)))));
    add("disperse", Some(MOST_TABLES), one_of("distribution", dispersions()));
    add("correlate", Some(MOST_TABLES), Keys::of(&draws::CORRELATE).table());
    add("derive", Some(MOST_TABLES), Keys::of(&draws::DERIVE).table());
    for (header, rows, _) in &settings::ANALYSIS {
        let most = header.starts_with("[[").then_some(MOST_TABLES);
        add(header.trim_matches(['[', ']']), most, Keys::of(rows).table());
    }
    let of_one = distributions(DistributionKind::is_of_one_number);
    let distribution = one_of("distribution", of_one.map(|(kind, keys)| (kind.name(), keys)));
    let mut schema = file.table();
    schema["$schema"] = "http://json-schema.org/draft-04/schema#".into();
    schema["title"] = "A spindrift campaign".into();
    schema["definitions"] = json!({"distribution": distribution});
    schema
}

fn design(name: &str) -> Keys {
    Design::keys_of(name).map(|(rows, _)| Keys::of(rows)).unwrap_or_default()
}

fn distributions(are_meant: fn(DistributionKind) -> bool) -> impl Iterator<Item = (DistributionKind, Keys)> {
    let kinds = DistributionKind::ALL.iter().copied().filter(move |kind| are_meant(*kind));
    kinds.map(|kind| (kind, Keys::of(kind.keys())))
}

fn dispersions() -> impl Iterator<Item = (&'static str, Keys)> {
    distributions(|_| true).map(|(kind, mut keys)| {
        if !kind.names_parameters() {
            keys.add_row(&PARAMETER);
        }
        (kind.name(), keys)
    })
}

/// A number within `range`, or a text with a unit.
fn number(range: Range) -> Json {
    let mut value = json!({"type": ["number", "string"]});
    for (bound, key, exclusive) in [(range.0, "minimum", "exclusiveMinimum"), (range.1, "maximum", "exclusiveMaximum")]
    {
        if let Bound::Included(bound) | Bound::Excluded(bound) = bound
            && bound.is_finite()
        {
            value[key] = bound.into();
        }
        if matches!(bound, Bound::Excluded(bound) if bound.is_finite()) {
            value[exclusive] = true.into();
        }
    }
    value
}

fn list(items: Json, length: Option<usize>) -> Json {
    let mut value = json!({"type": "array", "items": items});
    if let Some(length) = length {
        value["minItems"] = length.into();
        value["maxItems"] = length.into();
    }
    value
}

fn one_or_several(mut one: Json, types: &[&str]) -> Json {
    let items = one.clone();
    one["type"] = json!([types, &["array"]].concat());
    one["items"] = items;
    one
}

fn of_kind(row: &Row) -> Json {
    let text = || json!({"type": "string"});
    let of_row = || number(row.limit.map_or(ANY, |limit| limit.range));
    let whole = |least: u64, most: u64| json!({"type": "integer", "minimum": least, "maximum": most});
    match row.kind {
        Kind::Amount | Kind::Number => of_row(),
        Kind::Amounts | Kind::Values => one_or_several(of_row(), &["number", "string"]),
        Kind::Numbers(_) | Kind::AmountList | Kind::List => list(of_row(), None),
        Kind::Vector => list(number(ANY), Some(3)),
        Kind::Matrix => list(list(number(ANY), Some(3)), Some(3)),
        Kind::Correlations => json!({"anyOf": [{"type": "number"}, list(list(json!({"type": "number"}), None), None)]}),
        Kind::Count([least, most]) => whole(least, most),
        Kind::Counts(most) => one_or_several(whole(1, most), &["integer"]),
        Kind::Samples(most) => {
            json!({"type": "array", "items": whole(0, u64::MAX), "minItems": 1, "maxItems": most, "uniqueItems": true})
        }
        Kind::Text(_)
        | Kind::Name
        | Kind::Observable
        | Kind::Band
        | Kind::Expression
        | Kind::Parameter
        | Kind::Column
        | Kind::Columns => text(),
        Kind::Observables | Kind::Names | Kind::Parameters | Kind::Units => list(text(), None),
        Kind::UnitsByName => json!({"type": "object", "additionalProperties": text()}),
        Kind::ByName => json!({"type": "object", "additionalProperties": number(ANY)}),
        Kind::Flag => json!({"type": "boolean"}),
        Kind::Yes => json!({"enum": [true]}),
        Kind::Word(words) => json!({"enum": words}),
        Kind::OneOf(words) => json!({"enum": words()}),
        Kind::Words(words, _) => {
            json!({"type": "array", "items": {"enum": words}, "minItems": 1, "uniqueItems": true})
        }
        Kind::WordOrDirection(words) => json!({"anyOf": [{"enum": words}, list(number(ANY), Some(3))]}),
        Kind::Distribution => json!({"$ref": "#/definitions/distribution"}),
    }
}

fn of_facts(facts: &Facts) -> Json {
    let one = number(match facts.limit {
        Limit::Positive | Limit::PrincipalMoments => above(0.0),
        Limit::NotNegative | Limit::Thrust(_) => at_least(0.0),
        Limit::Finite | Limit::Direction | Limit::UnitQuaternion | Limit::Inertia => ANY,
    });
    match (facts.shape, facts.components.len()) {
        (Shape::Symmetric, _) => list(list(one, Some(3)), Some(3)),
        (_, 1) => one,
        (_, count) => list(one, Some(count)),
    }
}
