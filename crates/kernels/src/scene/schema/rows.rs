//! The macros that turn rows of the schema into an input structure, its defaults, its checks and its
//! [`super::row::Row`]s.

/// [`super::row::Presence`] as in a row: the example of a key that must be written.
macro_rules! presence {
    () => {
        $crate::scene::schema::row::Presence::Optional
    };
    ($example:literal) => {
        $crate::scene::schema::row::Presence::Required($example)
    };
}

/// [`super::row::Needs`] as in a row.
macro_rules! needs {
    () => {
        $crate::scene::schema::row::Needs::Nothing
    };
    (debris) => {
        $crate::scene::schema::row::Needs::Debris
    };
}

/// Names of the components of a type, unless a row names them.
macro_rules! components {
    ($type:ty,) => {
        <$type as Numbers>::COMPONENTS
    };
    ($type:ty, $components:ident) => {
        $components
    };
}

/// An input structure from its rows. A row reads
///
/// ```text
/// key: type = default, "unit", "meaning", Limit [of COMPONENTS] [, required "example"] [, with debris];
/// ```
///
/// `in Table [table => table.part]` says where in the structure of the whole table this one is; `others` lists fields
/// that are not numbers.
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
            pub const ROWS: &'static [$crate::scene::schema::row::Row<$Table>] = &[ $(
                $crate::scene::schema::row::Row {
                    facts: $crate::scene::schema::row::Facts {
                        key: stringify!($key),
                        unit: $unit,
                        meaning: $meaning,
                        components: $crate::scene::schema::rows::components!($type, $($components)?),
                        shape: <$type as Numbers>::SHAPE,
                        presence: $crate::scene::schema::rows::presence!($($example)?),
                        needs: $crate::scene::schema::rows::needs!($($needs)?),
                        limit: $crate::scene::schema::limit::Limit::$limit $(($remedy))?,
                    },
                    read: |$table| Numbers::numbers(&$get.$key),
                    write: |$table| Numbers::numbers_mut(&mut $get.$key),
                    open: |$table| Numbers::open(&mut $get.$key),
                },
            )* ];

            /// Notes which values violate their limits; `name` makes a dotted name of the key. Without a loop over
            /// rows: every draw is checked.
            #[inline(always)]
            pub(in crate::scene) fn check(
                &self,
                has_debris: bool,
                problems: &mut $crate::scene::error::Problems,
                name: impl Fn(&'static str) -> std::borrow::Cow<'static, str>,
            ) {
                $( if $crate::scene::schema::rows::needs!($($needs)?).are_met(has_debris)
                    && let Some(numbers) = Numbers::numbers(&self.$key)
                {
                    const LIMIT: $crate::scene::schema::limit::Limit =
                        $crate::scene::schema::limit::Limit::$limit $(($remedy))?;
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

/// A row whose value a pattern finds in its table, by shared or by mutable reference; `open` makes the table match it.
macro_rules! row {
    (
        $key:ident, $unit:literal, $meaning:expr, $components:expr, $shape:ident, $limit:ident
        $(required $example:literal)?, $open:expr, $pattern:pat => $value:ident
    ) => {
        $crate::scene::schema::row::Row {
            facts: $crate::scene::schema::row::Facts {
                key: stringify!($key),
                unit: $unit,
                meaning: $meaning,
                components: $components,
                shape: $crate::scene::schema::row::Shape::$shape,
                presence: $crate::scene::schema::rows::presence!($($example)?),
                needs: $crate::scene::schema::row::Needs::Nothing,
                limit: $crate::scene::schema::limit::Limit::$limit,
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
    };
}

pub(super) use {components, needs, presence, row, rows};
