//! Enumerations whose values have names in files, and sets of values.

/// An enumeration from rows `Variant = "name"`, with `ALL`, `name` and `from_name`.
macro_rules! named {
    (
        $(#[$meta:meta])*
        pub enum $Enum:ident { $( $(#[$variant_meta:meta])* $Variant:ident = $name:literal, )* }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $Enum { $( $(#[$variant_meta])* $Variant, )* }

        impl $Enum {
            /// All values.
            pub const ALL: [$Enum; [$($name),*].len()] = [$($Enum::$Variant),*];

            /// The name in files.
            pub const fn name(self) -> &'static str {
                match self { $( $Enum::$Variant => $name, )* }
            }

            /// The value called `name`.
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|value| value.name() == name)
            }
        }
    };
}

/// The set `$Set` of `$Element`s.
macro_rules! bit_set {
    ($(#[$doc:meta])* $Set:ident of $Element:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub struct $Set(u32);

        impl $Set {
            /// The empty set.
            pub const NONE: $Set = $Set(0);

            /// This set and `element`.
            #[must_use]
            pub const fn with(self, element: $Element) -> Self {
                $Set(self.0 | 1 << element as u32)
            }

            /// True if the set contains `element`.
            pub const fn contains(self, element: $Element) -> bool {
                self.0 & (1 << element as u32) != 0
            }
        }
    };
}

pub(crate) use {bit_set, named};
