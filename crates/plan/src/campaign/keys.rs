//! Tables of declared keys ([`crate::sampling::keys`]): read from a campaign file and written as canonical text.

use super::known_columns::{KnownColumns, unit_of};
use super::lines::Lines;
use super::numbers::{FINITE, number, numbers_in_words, remedy_for_text, values, whole};
use super::parameter::{parameter, parameters};
use super::section::Section;
use super::{data_keys, display, units};
use crate::math::vector::norm;
use crate::run::Quantity;
use crate::sampling::expression::Expression;
use crate::sampling::keys::{ALL_BUT_ONE, Condition, Kind, Presence, Row, Rule, Value, Values, Written};
use crate::sampling::{DistributionKind, WrittenDistribution};
use crate::scene::schema::Limit;
use toml::de::DeValue;

impl Section<'_, '_> {
    /// The values of `rows` if all are valid and obey `rules`; problems are noted.
    pub(super) fn rows(&mut self, rows: &[Row], rules: &[Rule]) -> Option<Written> {
        let mut is_right = true;
        for rule in rules {
            is_right = self.obeys(rule, is_right) && is_right;
        }
        let written = self.right_rows(rows);
        let is_there = |row: &Row| {
            written.has(row.multiple_of.map_or(row.key, |(key, _)| key))
                || !(self.has(row.key) || matches!(row.presence, Presence::Required { .. }))
        };
        (is_right && rows.iter().all(is_there)).then_some(written)
    }

    /// [`Section::rows`] for a whole table: further keys are unknown.
    pub(super) fn whole(&mut self, rows: &[Row], rules: &[Rule]) -> Option<Written> {
        let written = self.rows(rows, rules);
        self.finish();
        written
    }

    /// The valid keys of `[header]` after `change`, kept for canonical text.
    pub(super) fn kept(&mut self, header: &'static str, rows: &[Row], change: impl FnOnce(&mut Written)) -> Written {
        let mut section = self.section(header.trim_matches(['[', ']']));
        let mut written = section.right_rows(rows);
        section.finish();
        change(&mut written);
        let written = written.completed(rows, &[]);
        self.document.keep(header, written.clone());
        written
    }

    /// The values of `rows`, without invalid ones, which are noted.
    pub fn right_rows(&mut self, rows: &[Row]) -> Written {
        let mut written = Written::default();
        for row in rows {
            if let Presence::Required { allowed, example } = row.presence {
                self.require(row.key, allowed, example);
            }
            match (self.row(row), row.multiple_of) {
                (Some(Value::Numbers(values)), Some((key, divisor))) => {
                    written.set(key, Value::Numbers(values.map(|x| x / divisor)));
                }
                (Some(value), _) => written.set(row.key, value),
                (None, _) => {}
            }
        }
        written
    }

    /// The written value of a row; the default word of a missing [`Kind::Word`].
    fn row(&mut self, row: &Row) -> Option<Value> {
        let key = row.key;
        if matches!(row.kind, Kind::Amount | Kind::Amounts | Kind::AmountList) {
            self.note_unit(key);
        }
        match row.kind {
            Kind::Amount
            | Kind::Amounts
            | Kind::AmountList
            | Kind::Numbers(_)
            | Kind::Number
            | Kind::Values
            | Kind::List
            | Kind::Vector
            | Kind::Matrix
            | Kind::Correlations => self.numbers(row).map(Value::Numbers),
            Kind::Count(_) | Kind::Counts(_) | Kind::Samples(_) => self.counts(row).map(Value::Counts),
            Kind::Text(limit) => {
                let text = self.text(key)?;
                if !(limit.test)(text) {
                    return self.refused(key, limit.allowed, limit.remedy);
                }
                Some(text.into())
            }
            Kind::Words(words, default) => {
                let found = |word: &str| words.contains(&word).then(|| word.to_owned());
                self.names(key, words, found, &default()).map(Value::Texts)
            }
            Kind::WordOrDirection(words) if self.has(key) && self.plain_text(key).is_none() => self.axis(row, words),
            Kind::Word(words) | Kind::WordOrDirection(words) if self.has(key) => self.word(key, words).map(Value::from),
            Kind::Word(words) | Kind::WordOrDirection(words) => {
                self.know(key);
                words.first().map(|word| (*word).into())
            }
            Kind::Distribution => {
                let mut table = self.section(key);
                let found = if table.is_present() { table.distribution() } else { None };
                found.map(|found| Value::Distribution(found.kind.name(), found.written))
            }
            Kind::Observable => self.quantity(key, KnownColumns::observable, KnownColumns::refusal),
            Kind::Band => self.quantity(key, KnownColumns::band, KnownColumns::band_refusal),
            Kind::Observables => self.observables(key).map(Value::Texts),
            Kind::Expression => {
                let text = self.text(key)?;
                match Expression::parse(text) {
                    Ok(_) => Some(text.into()),
                    Err(error) => self.refused(key, error, "correct the expression"),
                }
            }
            Kind::Flag => self.flag(key).map(Value::Flag),
            Kind::Yes => match self.flag(key)? {
                true => Some(Value::Flag(true)),
                false => self.refused(key, "true where it is written", format!("delete it, or write {key} = true")),
            },
            Kind::Units => Some(Value::Texts(display::of_quantities(self, key))),
            Kind::UnitsByName => Some(Value::Units(display::by_name(self, key))),
            Kind::Parameter => parameter(self, key),
            Kind::Parameters => parameters(self, key),
            // read by the table's own code
            Kind::Name | Kind::Names | Kind::ByName => {
                self.know(key);
                None
            }
            Kind::OneOf(words) => self.word(key, &words()).map(Value::from),
            Kind::Column => data_keys::column(self).map(Value::Column),
            Kind::Columns => data_keys::columns(self).map(Value::Columns),
        }
    }

    fn flag(&mut self, key: &str) -> Option<bool> {
        self.parsed(key, DeValue::as_bool, "true or false", "write it without quotes")
    }

    /// The finite numbers of a row in its arrangement, one number or a list within its limit.
    fn numbers(&mut self, row: &Row) -> Option<Values> {
        let (key, value) = (row.key, self.take(row.key)?.get_ref());
        let unit = match row.kind {
            Kind::Amount | Kind::Amounts | Kind::AmountList | Kind::Numbers(_) => self.unit,
            Kind::Correlations => "1",
            _ => units::in_name(key),
        };
        let limit = match row.kind {
            Kind::Amount | Kind::Number => Some(row.limit.unwrap_or(FINITE)),
            Kind::List | Kind::AmountList => row.limit,
            _ => None,
        };
        let is_arranged = |values: &Values| match (row.kind, values) {
            (Kind::Amount | Kind::Number, values) => values.are(1),
            (Kind::Vector, values) => values.are(3),
            (Kind::Matrix, values) => values.are(9),
            (Kind::Amounts | Kind::Values, Values::One(_) | Values::Each(_)) => true,
            (Kind::Correlations, Values::Rows(rows)) => rows.iter().all(|row| row.len() == rows[0].len()),
            (Kind::Correlations, values) => values.are(1),
            (_, values) => matches!(values, Values::Each(_)),
        };
        let found = values(value, &|value| number(value, unit)).filter(is_arranged);
        // the limit of one number decides whether it may be infinite
        let is_one = matches!(row.kind, Kind::Amount | Kind::Number);
        let Some(found) = found.filter(|found| is_one || found.flat().iter().all(|x| x.is_finite())) else {
            let (allowed, remedy) = match (row.kind, limit) {
                (Kind::Amount | Kind::Number, Some(limit)) => {
                    (limit.allowed.to_owned(), remedy_for_text(value).to_owned())
                }
                (Kind::Amounts | Kind::Values, _) => (
                    "a finite number, or an array of one for each component".to_owned(),
                    remedy_for_text(value).to_owned(),
                ),
                (Kind::Vector, _) => (numbers_in_words(3), format!("write it like {}", Limit::Direction.example(3))),
                (Kind::Matrix, _) => (numbers_in_words(9), format!("write it like {}", Limit::Finite.example(9))),
                (Kind::Correlations, _) => {
                    let allowed = "one number for two parameters, or rows of equally many finite numbers";
                    return self.refused(key, allowed, "write it like 0.5 or [[1.0, 0.5], [0.5, 1.0]]");
                }
                _ => ("an array of finite numbers".to_owned(), "write it like [1.0, 2.0]".to_owned()),
            };
            let is_list = matches!(row.kind, Kind::List | Kind::AmountList | Kind::Numbers(_));
            if is_list && !value.is_array() {
                return self.refused(key, allowed, remedy);
            }
            self.refuse_number(key, unit, value, allowed, remedy);
            return None;
        };
        let list = found.flat();
        match (row.kind, limit) {
            (Kind::Numbers(limit), _) if !(limit.test)(&list) => self.refused(key, limit.allowed, limit.remedy),
            (_, Some(limit)) if list.is_empty() || !list.iter().all(|x| limit.holds(*x)) => {
                self.refused(key, limit.allowed, limit.remedy)
            }
            _ => Some(found),
        }
    }

    fn counts(&mut self, row: &Row) -> Option<Values<u64>> {
        let value = self.take(row.key)?.get_ref();
        let [least, most] = match row.kind {
            Kind::Count(ends) => ends,
            Kind::Counts(most) => [1, most],
            _ => [0, u64::MAX],
        };
        let found = values(value, &|value| whole(value).filter(|count| (least..=most).contains(count)));
        let found = found.filter(|found| match (row.kind, found) {
            (Kind::Samples(most), Values::Each(list)) => {
                list.windows(2).all(|pair| pair[0] < pair[1]) && (1..=most).contains(&list.len())
            }
            (Kind::Counts(_), values) => !matches!(values, Values::Rows(_)),
            (_, values) => values.are(1) && !matches!(row.kind, Kind::Samples(_)),
        });
        if found.is_some() {
            return found;
        }
        let range = format!("a whole number from {least} to {most}");
        let (allowed, remedy) = match (row.kind, value) {
            (Kind::Samples(most), _) => (
                format!("1 to {most} numbers of samples, ascending and different"),
                "write it like [3, 17, 400], or leave it out for all samples",
            ),
            (Kind::Counts(_), _) => (format!("{range}, or an array of them"), "write it like 5 or [5, 3]"),
            (_, DeValue::Float(_)) => (range, "write it without a decimal point or exponent"),
            (_, DeValue::Integer(_)) => (range, "write a number within this range"),
            (_, other) => (range, remedy_for_text(other)),
        };
        self.refused(row.key, allowed, remedy)
    }

    fn quantity(
        &mut self,
        key: &str,
        find: for<'k> fn(&'k KnownColumns, &str) -> Option<&'k Quantity>,
        refusal: fn(&KnownColumns, &str) -> (String, String),
    ) -> Option<Value> {
        let name = self.text(key)?;
        let known = self.document.known.as_ref()?;
        let Some(quantity) = find(known, name) else {
            let (allowed, remedy) = refusal(known, name);
            return self.refused(key, allowed, remedy);
        };
        let unit = unit_of(quantity);
        self.describes(name.to_owned(), unit);
        Some(name.into())
    }

    fn observables(&mut self, key: &str) -> Option<Vec<String>> {
        let names = self.texts(key, "[\"energy_error_max\"]")?;
        let known = self.document.known.as_ref()?;
        for (index, name) in names.iter().enumerate() {
            if known.observable(name).is_none() {
                let (allowed, remedy) = known.refusal(name);
                self.refuse_value(key, format!("{name:?}"), format!("made of names, each {allowed}"), remedy);
                return None;
            }
            if names[..index].contains(name) {
                return self.refused(key, "different names", format!("delete the second {name:?}"));
            }
        }
        Some(names)
    }

    /// Remembers the first unit, other than its own, of the quantity that this table is about: reports show the
    /// quantity, and its course over time, in this unit.
    fn note_unit(&mut self, key: &str) {
        if let Some(unit) = self.unit_written(key).filter(|unit| *unit != self.unit)
            && let Some(name) = self.about.take()
        {
            let over_time = self.document.known.as_ref().and_then(|known| known.over_time(&name));
            self.document.units.extend(over_time.into_iter().chain([name]).map(|name| (name, unit)));
        }
    }

    /// A unit vector in F_s instead of one of `words`.
    fn axis(&mut self, row: &Row, words: &[&str]) -> Option<Value> {
        let direction = self.numbers(&Row { kind: Kind::Vector, ..*row })?.flat();
        let length = norm([direction[0], direction[1], direction[2]]);
        if !(length > 0.0 && length.is_finite()) {
            let names: Vec<String> = words.iter().map(|word| format!("{word:?}")).collect();
            let allowed = format!("{} or a direction in F_s", names.join(", "));
            return self.refused(row.key, allowed, "write it like [0.0, 0.0, 1.0]");
        }
        // keep the bits of a unit vector
        let is_unit = (length - 1.0).abs() <= 4.0 * f64::EPSILON;
        Some(Value::Numbers(Values::Each(direction).map(|x| if is_unit { *x } else { x / length })))
    }

    /// True if the table obeys `rule`; a violation is noted. `is_right`: it obeys the rules before.
    pub fn obeys(&mut self, rule: &Rule, is_right: bool) -> bool {
        let only = |table: &mut Self, written: &[&'static str], all: &[&'static str], remedy: &str| {
            let Some(second) = written.get(1) else { return true };
            table.refuse(second, format!("the only one of {}", all.join(", ")), remedy);
            false
        };
        match rule {
            Rule::One(ways, example, remedy) => {
                // named by its first written key, else by its first key
                let name = |way: &&[&'static str]| way.iter().copied().find(|key| self.has(key)).unwrap_or(way[0]);
                let names: Vec<&'static str> = ways.iter().map(name).collect();
                let written: Vec<&'static str> = names.iter().copied().filter(|key| self.has(key)).collect();
                if written.is_empty() {
                    self.require(names[0], &format!("given ({})", names.join(" or ")), example);
                    return false;
                }
                only(self, &written, &names, remedy)
            }
            Rule::AtMostOne(keys) => {
                let written: Vec<&'static str> = keys.iter().copied().filter(|key| self.has(key)).collect();
                only(self, &written, keys, ALL_BUT_ONE)
            }
            Rule::Together([(first, of_first), (second, of_second)]) => {
                if is_right && (self.has(first) || self.has(second)) {
                    self.require(first, &format!("given together with {second}"), of_first);
                    self.require(second, &format!("given together with {first}"), of_second);
                }
                self.has(first) == self.has(second)
            }
            Rule::Only { keys, with, allowed, remedy } => {
                let holds = |condition: &Condition| condition.holds(|key| self.has(key), |key| self.plain_text(key));
                if !is_right || with.iter().all(holds) {
                    return true;
                }
                let written: Vec<&str> = keys.iter().copied().filter(|key| self.has(key)).collect();
                for key in &written {
                    self.know(key);
                    self.refuse(key, *allowed, *remedy);
                }
                written.is_empty()
            }
        }
    }

    pub(super) fn distribution(&mut self) -> Option<WrittenDistribution> {
        let name = self.required_word("distribution", DistributionKind::NAMES, "\"normal\"");
        // the other keys depend on the distribution
        let kind = DistributionKind::from_name(name?)?;
        let written = self.whole(kind.keys(), kind.rules());
        written.map(|written| WrittenDistribution { kind, written })
    }

    pub(super) fn required_word(
        &mut self,
        key: &str,
        words: &'static [&'static str],
        example: &str,
    ) -> Option<&'static str> {
        self.require(key, &format!("one of {}", words.join(", ")), example);
        self.word(key, words)
    }

    fn word(&mut self, key: &str, words: &[&'static str]) -> Option<&'static str> {
        self.name(key, words, |word| words.iter().copied().find(|known| *known == word))
    }
}

impl Lines {
    pub(super) fn rows(&mut self, header: &str, written: &Written) {
        self.table(header);
        self.written(header, written);
    }

    /// A nested distribution becomes a table within `[header]`, after the other keys.
    pub(super) fn written(&mut self, header: &str, written: &Written) {
        for (key, value) in written.entries() {
            match value {
                Value::Numbers(numbers) => self.key(key, numbers),
                Value::Counts(counts) => self.key(key, counts),
                Value::Text(text) => self.text_key(key, text),
                Value::Distribution(name, written) => {
                    let header = format!("{header}.{key}");
                    self.table(&format!("[{header}]"));
                    self.key("distribution", name);
                    self.written(&header, written);
                }
                Value::Flag(flag) => self.key(key, flag),
                Value::ByName(numbers) if numbers.is_empty() => {}
                Value::ByName(numbers) => {
                    let entries = numbers.iter().map(|(name, number)| format!("{name} = {number:?}"));
                    self.raw(key, &format!("{{ {} }}", entries.collect::<Vec<_>>().join(", ")));
                }
                Value::Texts(texts) => self.key(key, texts),
                Value::Units(units) => {
                    let entry =
                        |(name, unit): (&String, &&str)| format!("{} = {unit:?}", toml::Value::from(name.as_str()));
                    let entries: Vec<String> = units.iter().map(entry).collect();
                    self.raw(key, &format!("{{ {} }}", entries.join(", ")));
                }
                Value::Column(column) => {
                    self.key(key, &column.file);
                    self.key("sha256", &column.sha256);
                    self.key("column", &column.column);
                }
                Value::Columns(columns) => {
                    let Some(first) = columns.first() else { continue };
                    self.key(key, &first.file);
                    self.key("sha256", &first.sha256);
                    let names: Vec<String> = columns.iter().map(|column| column.target_name()).collect();
                    let own: Vec<&str> = columns.iter().map(|column| column.column.as_str()).collect();
                    self.key("parameters", &names);
                    if names != own {
                        self.key("columns", &own);
                    }
                }
            }
        }
    }
}
