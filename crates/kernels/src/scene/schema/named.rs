//! `named!`: choices that have names in campaign files.

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

            /// The name in campaign files.
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

pub(super) use named;
