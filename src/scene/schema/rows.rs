//! The macros that turn rows of the schema into an input structure, its defaults, its checks and its [`super::Key`]s.

/// The dotted names of a key, one for each header of its table.
macro_rules! names {
    ([$($header:literal),+], $key:ident) => {
        &[$(concat!($header, ".", stringify!($key))),+]
    };
}

/// Whether a key must be written, as in a row.
macro_rules! presence {
    (optional $($gate:tt)*) => {
        $crate::scene::schema::Presence::Optional
    };
    (required $example:literal) => {
        $crate::scene::schema::Presence::Required($example)
    };
    (required $example:literal if $condition:path) => {
        $crate::scene::schema::Presence::RequiredIf($condition, $example)
    };
}

/// What else the scene must have for the key to exist, as in a row.
macro_rules! gate {
    (optional if $condition:path) => {
        $condition
    };
    ($($presence:tt)+) => {
        $crate::scene::schema::in_every_scene
    };
}

/// An input structure from its rows. A row reads
///
/// ```text
/// key: type = default, "unit", "meaning", components, shape, limit, (presence), acts, "remedy";
/// ```
///
/// and `of` and `of_mut` give the structure in a scene; `others` lists fields that are not numbers.
macro_rules! rows {
    (
        $(#[$doc:meta])*
        pub struct $Struct:ident in $Table:ident $headers:tt, $of:path, $of_mut:path {
        $(
            $key:ident: $type:ty = $default:expr, $unit:literal, $meaning:literal,
            $components:expr, $shape:ident, $limit:expr, ($($presence:tt)+), $acts:path, $remedy:expr;
        )*
        } others { $( $(#[$field_doc:meta])* $field:ident: $field_type:ty = $field_default:expr, )* }
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $Struct {
            $(
                #[doc = concat!($meaning, ", unit ", $unit, ".")]
                pub $key: $type,
            )*
            $( $(#[$field_doc])* pub $field: $field_type, )*
        }

        impl $Struct {
            /// Every value at its default; where a key has none in a campaign file, the report's spacecraft (Table II).
            pub const DEFAULT: $Struct = $Struct { $( $key: $default, )* $( $field: $field_default, )* };

            /// The rows of the schema.
            pub const ROWS: &'static [$crate::scene::schema::Key] = &[ $(
                $crate::scene::schema::Key {
                    table: $crate::scene::schema::Table::$Table,
                    key: stringify!($key),
                    names: $crate::scene::schema::rows::names!($headers, $key),
                    unit: $unit,
                    meaning: $meaning,
                    components: $components,
                    shape: $crate::scene::schema::Shape::$shape,
                    presence: $crate::scene::schema::rows::presence!($($presence)+),
                    limit: $limit,
                    remedy: $remedy,
                    read: |scene, instance| {
                        let exists = $crate::scene::schema::rows::gate!($($presence)+)(scene);
                        $of(scene, instance).filter(|_| exists).and_then(|table| Numbers::numbers(&table.$key))
                    },
                    write: |scene, instance| {
                        let exists = $crate::scene::schema::rows::gate!($($presence)+)(scene);
                        $of_mut(scene, instance).filter(|_| exists).and_then(|table| Numbers::numbers_mut(&mut table.$key))
                    },
                    open: |scene, instance| {
                        if let Some(table) = $of_mut(scene, instance) {
                            Numbers::open(&mut table.$key);
                        }
                    },
                    acts: $acts,
                },
            )* ];

            /// Notes which values violate their limits; `name` makes a dotted name of the key and its names in the schema.
            /// Without a loop over rows: every draw is checked.
            #[inline(always)]
            #[allow(unused_variables, reason = "a table may have no keys")]
            pub(in crate::scene) fn check(
                &self,
                scene: &SceneInput,
                problems: &mut Problems,
                name: impl Fn(&'static str, &'static [&'static str]) -> std::borrow::Cow<'static, str>,
            ) {
                $( if $crate::scene::schema::rows::gate!($($presence)+)(scene)
                    && let Some(numbers) = Numbers::numbers(&self.$key)
                {
                    const NAMES: &[&str] = $crate::scene::schema::rows::names!($headers, $key);
                    const LIMIT: $crate::scene::schema::Limit = $limit;
                    LIMIT.check(|| name(stringify!($key), NAMES), numbers, problems);
                } )*
            }
        }

        impl Default for $Struct {
            fn default() -> Self {
                Self::DEFAULT
            }
        }
    };
}

/// A row whose value a pattern finds in the scene, by shared or by mutable reference; `open` makes the scene match it.
macro_rules! row {
    (
        $Table:ident $headers:tt $key:ident, $unit:literal, $meaning:expr, $components:expr, $shape:ident, $limit:expr,
        ($($presence:tt)+), $remedy:expr, $open:expr, $pattern:pat => $value:ident
    ) => {
        $crate::scene::schema::Key {
            table: $crate::scene::schema::Table::$Table,
            key: stringify!($key),
            names: $crate::scene::schema::rows::names!($headers, $key),
            unit: $unit,
            meaning: $meaning,
            components: $components,
            shape: $crate::scene::schema::Shape::$shape,
            presence: $crate::scene::schema::rows::presence!($($presence)+),
            limit: $limit,
            remedy: $remedy,
            read: |scene, _| match scene {
                $pattern => Numbers::numbers($value),
                _ => None,
            },
            write: |scene, _| match scene {
                $pattern => Numbers::numbers_mut($value),
                _ => None,
            },
            open: $open,
            acts: $crate::scene::schema::always,
        }
    };
}

pub(super) use {gate, names, presence, row, rows};
