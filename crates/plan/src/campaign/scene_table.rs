//! [`SceneTable`]: a table of the scene: numbers that [`crate::scene::schema`] declares, and other keys as [`Field`]s,
//! from which reading and canonical text follow.

use super::lines::Lines;
use super::section::Section;
use super::tables::{read_keys, read_name};
use crate::sampling::Written;
use crate::sampling::keys::{Row, Value};
use crate::scene::table::Table;
use crate::scene::{ArcErrors, Name, SceneInput};
use std::collections::HashSet;

/// A key of the scene that is not a number.
pub struct Field {
    pub row: Row,
    /// Its value; `None` to omit it from canonical text.
    pub get: fn(&SceneInput, usize) -> Option<Value>,
    pub set: fn(&mut SceneInput, usize, &Value),
}

type Add = fn(&mut SceneInput, Name);

pub struct SceneTable {
    /// Its tables of numbers in the schema.
    pub numbers: &'static [Table],
    /// Its other keys, before and behind the numbers in canonical text.
    pub fields: [&'static [Field]; 2],
    /// Most tables of a list.
    pub most: Option<usize>,
    /// Adds a table to a scene that need not have it.
    add: Option<Add>,
    /// True if canonical text shows it.
    is_shown: fn(&SceneInput) -> bool,
    /// Checks several keys together.
    check: fn(&mut Section<'_, '_>, &mut SceneInput, usize),
}

impl SceneTable {
    /// A table that every scene has.
    pub const fn new(numbers: &'static [Table], is_shown: fn(&SceneInput) -> bool) -> Self {
        SceneTable { numbers, fields: [&[], &[]], most: None, add: None, is_shown, check: |_, _, _| {} }
    }

    pub const fn list(numbers: &'static [Table], most: usize, add: Add) -> Self {
        SceneTable { most: Some(most), add: Some(add), ..Self::new(numbers, |_| true) }
    }

    pub const fn optional(self, add: Add) -> Self {
        SceneTable { add: Some(add), ..self }
    }

    pub const fn with(self, before: &'static [Field], behind: &'static [Field]) -> Self {
        SceneTable { fields: [before, behind], ..self }
    }

    pub const fn checked(self, check: fn(&mut Section<'_, '_>, &mut SceneInput, usize)) -> Self {
        SceneTable { check, ..self }
    }

    pub(super) fn read(&self, root: &mut Section<'_, '_>, scene: &mut SceneInput) {
        let header = self.numbers[0].header();
        match (header.split_once('.'), self.most, self.add) {
            (Some((outer, inner)), Some(most), Some(add)) => {
                self.read_list(&mut root.section(outer), inner, (most, add), scene);
            }
            (None, Some(most), Some(add)) => self.read_list(root, header, (most, add), scene),
            (_, _, add) => {
                let mut section = root.section(header);
                match add {
                    Some(_) if !section.is_present() => return,
                    Some(add) => add(scene, Name::NONE),
                    None => {}
                }
                self.read_one(&mut section, scene, 0);
            }
        }
    }

    fn read_list(&self, root: &mut Section<'_, '_>, key: &str, (most, add): (usize, Add), scene: &mut SceneInput) {
        let (mut taken, mut place) = (HashSet::new(), 0);
        root.sections(key, most, |section| {
            let name = read_name(section, self.numbers[0], &mut taken);
            add(scene, name);
            self.read_one(section, scene, place);
            place += 1;
        });
    }

    fn read_one(&self, section: &mut Section<'_, '_>, scene: &mut SceneInput, place: usize) {
        for field in self.fields.into_iter().flatten() {
            if let Some(value) = section.right_rows(&[field.row]).get(field.row.key) {
                (field.set)(scene, place, value);
            }
        }
        self.numbers.iter().for_each(|table| read_keys(section, *table, place, scene));
        (self.check)(section, scene, place);
        section.finish();
    }

    pub(super) fn write(&self, scene: &SceneInput, lines: &mut Lines) {
        let header = self.numbers[0].header();
        let header = if self.most.is_some() { format!("[[{header}]]") } else { format!("[{header}]") };
        let owners = if (self.is_shown)(scene) { self.numbers[0].owners(scene) } else { Vec::new() };
        for (place, owner) in owners.into_iter().enumerate() {
            let name = if self.numbers[0] == Table::Actuation { scene.actuation[place].name } else { owner };
            lines.table(&header);
            if name != Name::NONE {
                lines.key("name", name);
            }
            lines.written(&header, &self.written(0, scene, place));
            for table in self.numbers {
                // a schedule may have thousands of arcs, mostly without errors
                if *table != Table::ArcErrors || scene.actuation[place].errors != ArcErrors::DEFAULT {
                    lines.keys(*table, place, scene);
                }
            }
            lines.written(&header, &self.written(1, scene, place));
        }
    }

    fn written(&self, side: usize, scene: &SceneInput, place: usize) -> Written {
        self.fields[side].iter().fold(Written::NONE, |written, Field { row, get, .. }| match get(scene, place) {
            Some(value) if !row.is_sparse || row.default().as_ref() != Some(&value) => written.with(row.key, value),
            _ => written,
        })
    }
}

/// A field with one of the names of a type.
macro_rules! word {
    ($row:expr, $Type:ty, $scene:ident, $place:ident => $field:expr) => {
        Field {
            row: $row,
            get: |$scene, $place| Some($field.name().into()),
            set: |$scene, $place, value| {
                if let Some(named) = value.text().and_then(<$Type>::from_name) {
                    $field = named;
                }
            },
        }
    };
}

/// A flag of `[environment]`.
macro_rules! flag {
    ($key:ident, $meaning:literal) => {
        Field {
            row: Row::new(stringify!($key), Kind::Flag, $meaning).sparse(),
            get: |scene, _| Some(scene.environment.$key.into()),
            set: |scene, _, value| scene.environment.$key = *value == Value::Flag(true),
        }
    };
}

/// A list of numbers of `[environment]`.
macro_rules! list {
    ($key:ident, $meaning:literal) => {
        Field {
            row: Row::new(stringify!($key), Kind::List, $meaning),
            get: |scene, _| scene.environment.$key.map(Value::from),
            set: |scene, _, value| {
                if let Value::Numbers(values) = value {
                    scene.environment.$key = Some(kept(&values.flat()));
                }
            },
        }
    };
}

pub(super) use {flag, list, word};
