//! What is done for each design of the list: `designs!` makes the enumerations over all of them.

/// Declares the enumerations over all designs, and passes each call on to the one that is meant.
macro_rules! designs {
    ($($Name:ident = $Kind:ty),* $(,)?) => {
        #[derive(Clone, Debug, PartialEq)]
        pub enum Design {
            $(
                #[doc = concat!("See [`", stringify!($Kind), "`].")]
                $Name($Kind),
            )*
        }

        impl Design {
            /// The names in campaign files.
            pub const NAMES: &'static [&'static str] = &[$(<$Kind as Kind>::NAME),*];

            /// The name in campaign files.
            pub fn name(&self) -> &'static str {
                match self { $( Self::$Name(_) => <$Kind as Kind>::NAME, )* }
            }

            /// The keys and the rules of the design called `name`; `None` where there is none of that name.
            pub fn keys_of(name: &str) -> Option<(&'static [Row], &'static [Rule])> {
                let all = [$((<$Kind as Kind>::NAME, (<$Kind as Kind>::KEYS, <$Kind as Kind>::RULES)),)*];
                all.into_iter().find(|(known, _)| *known == name).map(|(_, keys)| keys)
            }

            /// The design called `name` of what a file says; `None` where there is none of that name.
            pub fn of(name: &str, written: &Written) -> Option<Self> {
                $( if name == <$Kind as Kind>::NAME {
                    return Some(Self::$Name(<$Kind as Kind>::of(written)));
                } )*
                None
            }

            /// What a file says of it.
            pub fn written(&self) -> Written {
                match self { $( Self::$Name(kind) => kind.written(), )* }
            }

            /// See [`Kind::HAS_SIZE`].
            pub fn has_size(&self) -> bool {
                match self { $( Self::$Name(_) => <$Kind as Kind>::HAS_SIZE, )* }
            }

            /// See [`Kind::LEAVES_NOMINAL`].
            pub fn leaves_nominal(&self) -> bool {
                match self { $( Self::$Name(_) => <$Kind as Kind>::LEAVES_NOMINAL, )* }
            }

            /// See [`Kind::MAX_DIMENSIONS`].
            pub fn max_dimensions(&self) -> usize {
                match self { $( Self::$Name(_) => <$Kind as Kind>::MAX_DIMENSIONS, )* }
            }

            /// See [`Kind::DEPENDS_ON_SAMPLES`].
            pub fn depends_on_samples(&self) -> Option<[&'static str; 2]> {
                match self { $( Self::$Name(_) => <$Kind as Kind>::DEPENDS_ON_SAMPLES, )* }
            }

            /// See [`Kind::EXCLUDES_CORRELATION`].
            pub fn excludes_correlation(&self) -> Option<[&'static str; 2]> {
                match self { $( Self::$Name(_) => <$Kind as Kind>::EXCLUDES_CORRELATION, )* }
            }

            /// See [`Kind::size`].
            pub fn size(&self, dimensions: usize) -> Size {
                match self { $( Self::$Name(kind) => kind.size(dimensions), )* }
            }

            /// See [`Kind::replicates`].
            pub fn replicates(&self) -> u64 {
                match self { $( Self::$Name(kind) => kind.replicates(), )* }
            }

            /// See [`Kind::check`].
            ///
            /// # Errors
            /// What keeps the design from having these dimensions and samples.
            pub fn check(&self, dimensions: Dimensions<'_>, samples: Option<u64>) -> Result<(), DispersionError> {
                match self { $( Self::$Name(kind) => kind.check(dimensions, samples), )* }
            }

            /// See [`Kind::columns`].
            pub fn columns(&self) -> &[DataColumn] {
                match self { $( Self::$Name(kind) => kind.columns(), )* }
            }
        }

        /// The points of a design, for one worker. What it keeps only makes neighbours cheap.
        #[derive(Debug)]
        pub enum Points {
            $(
                #[doc = concat!("See [`", stringify!($Kind), "`].")]
                $Name(<$Kind as Kind>::Points),
            )*
        }

        impl Points {
            /// The points of `design`.
            pub fn new(design: &Design, dimensions: Dimensions<'_>) -> Self {
                match design { $( Design::$Name(kind) => Points::$Name(kind.points(dimensions)), )* }
            }
        }

        impl PointSource for Points {
            fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
                match self { $( Self::$Name(points) => points.fill(block, u), )* }
            }
        }
    };
}
pub(super) use designs;
