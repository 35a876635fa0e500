//! Macros that turn rows of the schema into an input structure, its defaults, checks and [`super::row::Row`]s.

/// An input structure from its rows. A row reads
///
/// ```text
/// key: type = default, "unit", "meaning", Limit [of COMPONENTS] [, required "example"] [, with debris];
/// ```
///
/// `in Table [table => table.part]` places the structure in that of the whole table; `others` are not numbers.
macro_rules! rows {
    (
        $(#[$doc:meta])*
        pub struct $Struct:ident in $Table:ident [$table:ident => $get:expr] {
        $(
            $key:ident: $type:ty = $default:expr, $unit:literal, $meaning:literal,
            $limit:ident $(($remedy:literal))? $(of $components:ident)?
            $(, required $example:literal)? $(, with $needs:ident)?;
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
            /// Every value at its default; where a key has none in a campaign file, zero or absent.
            pub const DEFAULT: $Struct = $Struct { $( $key: $default, )* $( $field: $field_default, )* };

            /// The rows of the schema.
            pub const ROWS: &'static [super::row::Row<$Table>] = &{
                use super::{limit::Limit, numbers::Numbers, row::{Facts, Row, first}};
                [ $( Row {
                    facts: Facts {
                        key: stringify!($key),
                        unit: $unit,
                        meaning: $meaning,
                        components: match first(&[$($components)?]) {
                            Some(components) => components,
                            None => <$type as Numbers>::COMPONENTS,
                        },
                        shape: <$type as Numbers>::SHAPE,
                        required: first(&[$($example)?]),
                        needs_debris: first::<&str>(&[$(stringify!($needs))?]).is_some(),
                        limit: Limit::$limit $(($remedy))?,
                    },
                    read: |$table| Numbers::numbers(&$get.$key),
                    write: |$table| Numbers::numbers_mut(&mut $get.$key),
                    open: |$table| Numbers::open(&mut $get.$key),
                }, )* ]
            };

            /// Notes violated limits; `name` makes a dotted name of the key. Unrolled, since every draw is checked.
            #[inline(always)]
            pub(in crate::scene) fn check(
                &self,
                has_debris: bool,
                problems: &mut $crate::scene::error::Problems,
                name: impl Fn(&'static str) -> std::borrow::Cow<'static, str>,
            ) {
                use super::{limit::Limit, numbers::Numbers, row::first};
                $( if (has_debris || const { first::<&str>(&[$(stringify!($needs))?]).is_none() })
                    && let Some(numbers) = Numbers::numbers(&self.$key)
                {
                    const LIMIT: Limit = Limit::$limit $(($remedy))?;
                    LIMIT.check(|| name(stringify!($key)), numbers, problems);
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

/// A row whose value is found in its table by a pattern, which `open` makes match.
macro_rules! row {
    (
        $key:ident, $unit:literal, $meaning:expr, $components:expr, $shape:ident, $limit:ident
        $(required $example:literal)?, $open:expr, $pattern:pat => $value:ident
    ) => {{
        use super::{limit::Limit, numbers::Numbers, row::{Facts, Row, Shape, first}};
        Row {
            facts: Facts {
                key: stringify!($key),
                unit: $unit,
                meaning: $meaning,
                components: $components,
                shape: Shape::$shape,
                required: first(&[$($example)?]),
                needs_debris: false,
                limit: Limit::$limit,
            },
            read: |table| match table {
                $pattern => Numbers::numbers($value),
                _ => None,
            },
            write: |table| match table {
                $pattern => Numbers::numbers_mut($value),
                _ => None,
            },
            open: $open,
        }
    }};
}

pub(super) use {row, rows};
