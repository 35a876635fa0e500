//! [`schema`]: the JSON Schema of campaign files, by which editors complete and check them, within draft 4.
//!
//! It is generated from the declared keys. It does not hold rules for several keys together, names of other tables and
//! units in texts, which `spindrift check` checks.

use std::ops::Bound;

use serde_json::{Map, Value as Json, json};

use super::control::{self, MODEL, MOST_PHASES};
use super::parameter::PARAMETER;
use super::scene_table::SceneTable;
use super::size::MOST_TABLES;
use super::{data_keys, draws, failure_tables, phase_tables, scene, sensor_tables, settings};
use crate::control::actuators::modulation;
use crate::control::guidance::phase::Maneuver;
use crate::control::guidance::target::TARGETS;
use crate::control::laws::rod_law::ROD_USES;
use crate::control::sensors::{self, SensorKind};
use crate::control::{estimators, laws, net_launch, parameters};
use crate::sampling::keys::{ANY, Kind, Presence, Range, Row, above, at_least};
use crate::sampling::{Design, DistributionKind};
use crate::scene::schema::{Facts, Limit, Shape};
use crate::scene::table::Table;
use crate::scene::{LawParameter, Name, schema};

/// The keys of one table, and which of them must be written.
#[derive(Clone, Default)]
struct Keys {
    properties: Map<String, Json>,
    required: Vec<String>,
}

impl Keys {
    fn of(rows: &[Row]) -> Self {
        let mut keys = Keys::default();
        rows.iter().for_each(|row| keys.add_row(row));
        keys
    }

    fn add(&mut self, key: &str, is_required: bool, value: Json) {
        self.properties.entry(key).or_insert(value);
        if is_required {
            self.required.push(key.to_owned());
        }
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
        self.add(row.key, matches!(row.presence, Presence::Required { .. }), value);
    }

    fn add_number(&mut self, facts: &Facts, default: Option<Json>) {
        let mut value = of_facts(facts);
        let unit = if facts.unit == "1" { String::new() } else { format!(", {}", facts.unit) };
        value["description"] = format!("{}{unit}", facts.meaning).into();
        if let Some(default) = default {
            value["default"] = default;
        }
        self.add(facts.key, matches!(facts.presence, schema::Presence::Required(_)), value);
    }

    fn add_parameters(&mut self, list: &[LawParameter]) {
        for parameter in list {
            let default = parameter.default.map(|numbers| match numbers {
                [number] => json!(number),
                several => json!(several),
            });
            self.add_number(&parameter.facts, default);
        }
    }

    /// A table of the scene.
    fn of_scene(table: &SceneTable) -> Self {
        let mut keys = Keys::default();
        for field in table.fields.into_iter().flatten() {
            keys.add_row(&field.row);
        }
        for key in table.numbers.iter().flat_map(|table| table.keys()) {
            keys.add_number(key.facts(), key.default_text().and_then(|text| serde_json::from_str(&text).ok()));
        }
        if table.numbers[0] == Table::Debris {
            // its ways to be described exclude each other
            keys.required.clear();
        }
        if table.most.is_some() {
            let is_named = table.numbers[0] != Table::Actuation;
            keys.add(
                "name",
                is_named,
                json!({"type": "string", "description": format!("Its name: {}", Name::ALLOWED)}),
            );
        }
        keys
    }

    /// A table with these keys and no others, and which of them a whole file has.
    fn table(self) -> Declared {
        let whole = if self.required.is_empty() { json!({}) } else { json!({"required": self.required}) };
        let value = json!({"type": "object", "properties": self.properties, "additionalProperties": false});
        Declared { value, whole }
    }
}

/// What a value may be, and what it must have besides in a file that does not extend another one.
struct Declared {
    value: Json,
    whole: Json,
}

/// A table for each kind, which `key` names.
fn one_of<'k>(key: &str, kinds: impl Iterator<Item = (&'k str, Keys)>) -> Declared {
    let (mut values, mut whole) = (Vec::new(), Vec::new());
    for (name, mut keys) in kinds {
        let named = json!({"enum": [name]});
        keys.required.push(key.to_owned());
        keys.properties.insert(key.to_owned(), named.clone());
        whole.push(json!({"properties": {key: named}, "required": keys.required}));
        values.push(keys.table().value);
    }
    Declared { value: json!({"anyOf": values}), whole: json!({"anyOf": whole}) }
}

/// The tables of a file while they are collected.
#[derive(Default)]
struct File {
    tables: Map<String, Json>,
    whole: Map<String, Json>,
}

impl File {
    /// Adds the table `header`, or a list of at most `most` tables, where its dotted name leads.
    fn add(&mut self, header: &str, most: Option<usize>, table: Declared) {
        let Declared { mut value, mut whole } = table;
        if let Some(most) = most {
            (value, whole) = (json!({"type": "array", "items": value}), json!({"items": whole}));
            if most < usize::MAX {
                value["maxItems"] = most.into();
            }
        }
        match header.split_once('.') {
            Some((outer, inner)) => {
                self.tables[outer]["properties"][inner] = value;
                self.whole[outer]["properties"][inner] = whole;
            }
            None => {
                self.tables.insert(header.to_owned(), value);
                self.whole.insert(header.to_owned(), whole);
            }
        }
    }
}

/// The JSON Schema of campaign files.
pub fn schema() -> Json {
    let mut file = File::default();
    for (header, rows) in settings::HEAD.iter().chain(&settings::TAIL) {
        file.add(header, None, Keys::of(rows).table());
    }
    for table in scene::TABLES.iter().chain([&failure_tables::TABLE]) {
        file.add(table.numbers[0].header(), table.most, Keys::of_scene(table).table());
    }
    file.add("control", None, control().table());
    file.add("control.model", None, Keys::of(&MODEL).table());
    file.add("sensors", Some(MOST_TABLES), one_of("kind", sensors::KINDS.iter().map(|kind| (kind.name, sensor(kind)))));
    file.add("guidance", Some(MOST_PHASES), guidance());
    file.add("design", None, one_of("kind", Design::NAMES.iter().map(|name| (*name, design(name)))));
    file.add("disperse", Some(MOST_TABLES), one_of("distribution", dispersions()));
    file.add("correlate", Some(MOST_TABLES), Keys::of(&draws::CORRELATE).table());
    file.add("derive", Some(MOST_TABLES), Keys::of(&draws::DERIVE).table());
    for (header, rows, _) in &settings::ANALYSIS {
        let most = header.starts_with("[[").then_some(MOST_TABLES);
        file.add(header.trim_matches(['[', ']']), most, Keys::of(rows).table());
    }
    let extends = json!({"type": "string", "description": "The file that this one changes"});
    file.tables.insert("extends".to_owned(), extends);
    json!({
        "$schema": "http://json-schema.org/draft-04/schema#",
        "title": "A spindrift campaign",
        "type": "object",
        "properties": file.tables,
        "additionalProperties": false,
        "anyOf": [{"required": ["extends"]}, {"required": ["campaign"], "properties": file.whole}],
    })
}

fn control() -> Keys {
    let mut keys = Keys::of(&control::ROWS);
    let estimators = estimators::KINDS.iter().map(|kind| kind.parameters);
    let modulations = (0..modulation::NAMES.len()).map(modulation::parameters);
    let others = [&parameters::LOOP[..], &parameters::THRUSTERS, &net_launch::parameters::DEBRIS];
    estimators.chain(modulations).chain(others).for_each(|list| keys.add_parameters(list));
    // each of them is a key of some loops alone
    keys.required.retain(|key| control::ROWS.iter().any(|row| row.key == key));
    keys
}

fn sensor(kind: &SensorKind) -> Keys {
    let mut keys = Keys::of(&sensor_tables::ROWS);
    keys.required.retain(|key| key != "kind");
    keys.add_parameters(kind.parameters);
    keys.required.retain(|key| !kind.replaced_by_epoch.is_some_and(|replaced| replaced == key));
    keys
}

/// A phase: with a law of this program, or with a law that a module or a program brings, whose keys are not known.
fn guidance() -> Declared {
    let mut keys = Keys::of(&phase_tables::ROWS);
    for (_, target) in TARGETS {
        parameters::of_phase(target, Maneuver::Transfer, [true, true])
            .iter()
            .for_each(|list| keys.add_parameters(list));
    }
    ROD_USES.iter().for_each(|(_, rods)| keys.add_parameters(rods.parameters()));
    laws::KINDS.iter().for_each(|kind| keys.add_parameters(kind.parameters));
    keys.required.retain(|key| phase_tables::ROWS.iter().any(|row| row.key == key));
    let laws = keys.properties["law"].clone();
    let of_others = json!({"required": ["law"], "properties": {"law": {"type": "string", "not": laws}}});
    let Declared { value, whole } = keys.table();
    Declared { value: json!({"anyOf": [value, of_others]}), whole }
}

fn design(name: &str) -> Keys {
    Design::keys_of(name).map(|(rows, _)| Keys::of(rows)).unwrap_or_default()
}

/// The distributions that `are_meant`, each with its keys.
fn distributions(are_meant: fn(DistributionKind) -> bool) -> impl Iterator<Item = (DistributionKind, Keys)> {
    let kinds = DistributionKind::ALL.iter().copied().filter(move |kind| are_meant(*kind));
    kinds.map(|kind| (kind, Keys::of(kind.keys())))
}

/// The keys of `[[disperse]]` with each distribution.
fn dispersions() -> impl Iterator<Item = (&'static str, Keys)> {
    distributions(|_| true).map(|(kind, mut keys)| {
        if !kind.names_parameters() {
            keys.add_row(&PARAMETER);
        }
        (kind.name(), keys)
    })
}

/// A number within `range`, or a text with a number and its unit.
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

/// An array of values, of this length where it is given.
fn list(items: Json, length: Option<usize>) -> Json {
    let mut value = json!({"type": "array", "items": items});
    if let Some(length) = length {
        value["minItems"] = length.into();
        value["maxItems"] = length.into();
    }
    value
}

/// One value or an array of them.
fn one_or_several(mut one: Json, types: &[&str]) -> Json {
    let items = one.clone();
    one["type"] = json!([types, &["array"]].concat());
    one["items"] = items;
    one
}

/// What the value of a row may be.
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
        | Kind::Column
        | Kind::Columns => text(),
        Kind::Observables | Kind::Names | Kind::Units => list(text(), None),
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
        Kind::Distribution => {
            let of_one = distributions(DistributionKind::is_of_one_number);
            one_of("distribution", of_one.map(|(kind, keys)| (kind.name(), keys))).value
        }
    }
}

/// What the numbers of a parameter may be.
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
