//! Tables of declared keys ([`crate::sampling::keys`]): read from a campaign file and written as canonical text.

use super::known_columns::{KnownColumns, unit_of};
use super::lines::Lines;
use super::numbers::FINITE;
use super::parameter::{parameter, parameters};
use super::section::Section;
use super::{data_keys, display, units};
use crate::math::vector::norm;
use crate::run::Quantity;
use crate::sampling::expression::Expression;
use crate::sampling::keys::{
    ALL_BUT_ONE, Condition, Counts, Kind, NumberLimit, Numbers, Presence, Row, Rule, TextLimit, Value, Values, Written,
};
use crate::sampling::{DistributionKind, WrittenDistribution};

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
    pub(super) fn right_rows(&mut self, rows: &[Row]) -> Written {
        let mut written = Written::default();
        for row in rows {
            if let Presence::Required { allowed, example } = row.presence {
                self.require(row.key, allowed, example);
            }
            match (self.row(row), row.multiple_of) {
                (Some(Value::Numbers(values)), Some((key, divisor))) => {
                    written.set(key, Value::Numbers(values.over(divisor)));
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
        let (of_target, own) = (self.unit, units::in_name(key));
        match row.kind {
            Kind::Amounts => {
                self.note_unit(key);
                self.values(key, of_target).map(Value::Numbers)
            }
            Kind::Values => self.values(key, own).map(Value::Numbers),
            Kind::AmountList => {
                self.note_unit(key);
                self.list(key, of_target, row.limit)
            }
            Kind::List => self.list(key, own, row.limit),
            Kind::Number => {
                let limit = row.limit.unwrap_or(FINITE);
                self.number(key, limit).map(Value::from)
            }
            Kind::Vector => {
                let vector = self.direction(key).filter(|vector| vector.iter().all(|x| x.is_finite()));
                vector.map(|vector| Value::Numbers(Values::Each(vector.to_vec())))
            }
            Kind::Matrix => {
                let matrix = self.matrix(key).filter(|matrix| matrix.as_flattened().iter().all(|x| x.is_finite()));
                matrix.map(Value::Matrix)
            }
            Kind::Count([least, most]) => self.count(key, least..=most).map(Value::from),
            Kind::Samples(most) => self.samples(key, most).map(|list| Value::Counts(Counts::Each(list))),
            Kind::Text(limit) => self.limited_text(key, limit).map(Value::from),
            Kind::Words(words, default) => {
                let found = |word: &str| words.iter().copied().find(|known| *known == word);
                self.names(key, words, found, &default()).map(Value::Words)
            }
            Kind::WordOrDirection(words) if self.has(key) && self.plain_text(key).is_none() => self.axis(key, words),
            Kind::Counts(most) => self.counts(key, 1..=most).map(Value::Counts),
            Kind::Word(words) | Kind::WordOrDirection(words) if self.has(key) => self.word(key, words).map(Value::Word),
            Kind::Word(words) | Kind::WordOrDirection(words) => {
                self.know(key);
                words.first().map(|word| Value::Word(word))
            }
            Kind::Distribution => {
                let mut table = self.section(key);
                let found = if table.is_present() { table.distribution() } else { None };
                found.map(|found| Value::Distribution(found.kind.name(), found.written))
            }
            Kind::Amount => {
                let number = self.number_in(key, of_target, row.limit.unwrap_or(FINITE));
                self.note_unit(key);
                number.map(Value::from)
            }
            Kind::Numbers(limit) => {
                let list = self.numbers(key, of_target)?;
                if !(limit.test)(&list) {
                    return self.refused(key, limit.allowed, limit.remedy);
                }
                Some(list.as_slice().into())
            }
            Kind::Observable => self.quantity(key, KnownColumns::observable, KnownColumns::refusal),
            Kind::Band => self.quantity(key, KnownColumns::band, KnownColumns::band_refusal),
            Kind::Observables => self.observables(key).map(Value::Texts),
            Kind::Expression => {
                let text = self.text(key)?;
                match Expression::parse(text) {
                    Ok(_) => Some(text.into()),
                    Err(error) => {
                        self.refuse(key, error, "correct the expression");
                        None
                    }
                }
            }
            Kind::Flag => self.flag(key).map(Value::Flag),
            Kind::Yes => {
                let is_yes = self.flag(key)?;
                if !is_yes {
                    self.refuse(key, "true where it is written", format!("delete it, or write {key} = true"));
                }
                is_yes.then_some(Value::Flag(true))
            }
            Kind::Units => Some(Value::Words(display::of_quantities(self, key))),
            Kind::UnitsByName => Some(Value::Units(display::by_name(self, key))),
            Kind::Parameter => parameter(self, key),
            Kind::Parameters => parameters(self, key),
            Kind::Correlations => self.correlations(key).map(Value::Correlations),
            // read by the table's own code
            Kind::Name | Kind::Names | Kind::ByName => {
                self.know(key);
                None
            }
            Kind::OneOf(words) => {
                let words = words();
                let found = self.name(key, &words, |word| words.iter().copied().find(|known| *known == word));
                found.map(Value::Word)
            }
            Kind::Column => data_keys::column(self).map(Value::Column),
            Kind::Columns => data_keys::columns(self).map(Value::Columns),
        }
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

    fn list(&mut self, key: &str, unit: &'static str, limit: Option<NumberLimit>) -> Option<Value> {
        let list = self.numbers(key, unit)?;
        if let Some(limit) = limit.filter(|limit| list.is_empty() || !list.iter().all(|x| limit.holds(*x))) {
            return self.refused(key, limit.allowed, limit.remedy);
        }
        Some(Value::Numbers(Values::Each(list)))
    }

    fn limited_text(&mut self, key: &str, limit: TextLimit) -> Option<&str> {
        let text = self.text(key)?;
        if !(limit.test)(text) {
            return self.refused(key, limit.allowed, limit.remedy);
        }
        Some(text)
    }

    /// A unit vector in F_s instead of one of `words`.
    fn axis(&mut self, key: &str, words: &[&str]) -> Option<Value> {
        let direction = self.direction(key)?;
        let length = norm(direction);
        if !(length > 0.0 && length.is_finite()) {
            if direction.iter().all(|x| x.is_finite()) {
                let names: Vec<String> = words.iter().map(|word| format!("{word:?}")).collect();
                let allowed = format!("{} or a direction in F_s", names.join(", "));
                self.refuse(key, allowed, "write it like [0.0, 0.0, 1.0]");
            }
            return None;
        }
        // keep the bits of a unit vector
        let is_unit = (length - 1.0).abs() <= 4.0 * f64::EPSILON;
        let axis = if is_unit { direction } else { direction.map(|x| x / length) };
        Some(Value::Numbers(Values::Each(axis.to_vec())))
    }

    /// Whether the table obeys `rule`; a violation is noted. `is_right`: it obeys the rules before.
    pub(super) fn obeys(&mut self, rule: &Rule, is_right: bool) -> bool {
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

    fn word(&mut self, key: &str, words: &'static [&'static str]) -> Option<&'static str> {
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
                Value::Numbers(Values::All(number)) => self.key(key, number),
                Value::Numbers(Values::Each(list)) => self.key(key, list),
                Value::Matrix(matrix) => self.key(key, matrix),
                Value::Correlations(Numbers::One(number)) => self.key(key, number),
                Value::Correlations(Numbers::Rows(rows)) => self.key(key, rows),
                Value::Counts(Counts::All(count)) => self.key(key, count),
                Value::Counts(Counts::Each(counts)) => self.key(key, counts),
                Value::Word(word) => self.key(key, word),
                Value::Words(words) => self.key(key, words),
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
