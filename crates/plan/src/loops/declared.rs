//! [`declared!`]: numbers of a table, as key rows and as the struct that reads them.

use crate::scene::schema::Limit;
use crate::scene::{DeclaredTable, LawParameter};

/// A value of one key.
pub trait DeclaredValue: Sized {
    /// The value of the key of `row` in `table`; by default the row's default, else NaN.
    fn read(table: &DeclaredTable, row: &LawParameter) -> Self;
}

impl<const N: usize> DeclaredValue for [f64; N] {
    fn read(table: &DeclaredTable, row: &LawParameter) -> Self {
        let numbers = table.named(row.facts.key).or(row.default);
        numbers.and_then(|numbers| numbers.try_into().ok()).unwrap_or([f64::NAN; N])
    }
}

impl DeclaredValue for f64 {
    fn read(table: &DeclaredTable, row: &LawParameter) -> Self {
        let [number] = DeclaredValue::read(table, row);
        number
    }
}

/// `declared! { Name = ROWS { field: f64 = row; other: [f64; 3] = row; } }` defines the struct `Name`, its key rows
/// `ROWS` and `Name::of(&table)`.
#[doc(hidden)]
#[macro_export]
macro_rules! declared {
    ($(#[$about:meta])* $name:ident = $rows:ident { $($field:ident: $type:ty = $row:expr;)+ }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name {
            $(pub $field: $type,)+
        }

        pub static $rows: [$crate::scene::LawParameter; [$(stringify!($field)),+].len()] = [$($row),+];

        impl $name {
            /// Reads them from `table`; by default a key's default, else NaN.
            pub fn of(table: &$crate::scene::DeclaredTable) -> Self {
                $name { $($field: $crate::loops::declared::DeclaredValue::read(table, &$row)),+ }
            }
        }
    };
}
pub use declared;

/// A nonnegative number with a default.
pub const fn number(
    key: &'static str,
    unit: &'static str,
    meaning: &'static str,
    default: &'static [f64],
) -> LawParameter {
    LawParameter::number(key, unit, meaning, Limit::NotNegative).or(default)
}

/// A limit for which zero means none.
pub fn limit(number: f64) -> f64 {
    if number == 0.0 { f64::INFINITY } else { number }
}
