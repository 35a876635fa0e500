//! What is done for each distribution of the list: `distributions!` makes the enumerations over all of them.

/// Declares the enumerations over all distributions, and passes each call on to the one that is meant.
macro_rules! distributions {
    (one number: $($Scalar:ident),* ; several together: $($Name:ident = $Together:ty),* $(,)?) => {
        /// A distribution as written.
        #[derive(Clone, Debug, PartialEq)]
        pub enum WrittenDistribution {
            $(
                #[doc = concat!("See [`", stringify!($Scalar), "`].")]
                $Scalar($Scalar),
            )*
            $(
                #[doc = concat!("See [`", stringify!($Name), "`].")]
                $Name($Together),
            )*
        }

        impl WrittenDistribution {
            /// The names in campaign files.
            pub const NAMES: &'static [&'static str] =
                &[$(<$Scalar as Scalar>::NAME,)* $(<$Together as Together>::NAME,)*];

            /// The name in campaign files.
            pub fn name(&self) -> &'static str {
                match self {
                    $( Self::$Scalar(_) => <$Scalar as Scalar>::NAME, )*
                    $( Self::$Name(_) => <$Together as Together>::NAME, )*
                }
            }

            /// Reads the keys of the distribution called `name`; `None` where there is none of that name or something is
            /// wrong, which is then noted.
            pub fn read_named(name: &str, keys: &mut dyn KeyReader) -> Option<Self> {
                $( if name == <$Scalar as Scalar>::NAME {
                    return <$Scalar as Scalar>::read(keys).map(Self::$Scalar);
                } )*
                $( if name == <$Together as Together>::NAME {
                    return <$Together as Together>::read(keys).map(Self::$Name);
                } )*
                None
            }

            /// The names of those that name their parameters themselves, in place of the key `parameter`.
            pub fn naming_parameters() -> Vec<&'static str> {
                let list = [$((<$Together as Together>::NAME, <$Together as Together>::NAMES_PARAMETERS),)*];
                list.into_iter().filter(|(_, names)| *names).map(|(name, _)| name).collect()
            }

            /// The columns of a file that it writes to parameters, of a distribution that names them itself.
            pub fn columns(&self) -> &[DataColumn] {
                match self {
                    $( Self::$Scalar(_) => &[], )*
                    $( Self::$Name(written) => written.columns(), )*
                }
            }

            /// Writes its name and its keys.
            pub fn write(&self, keys: &mut dyn KeyWriter) {
                keys.key("distribution", &self.name());
                match self {
                    $( Self::$Scalar(written) => written.write(keys), )*
                    $( Self::$Name(written) => written.write(keys), )*
                }
            }

            /// The distribution of each component; `None` for one of all components together.
            ///
            /// # Errors
            /// What about its numbers does not fit the target.
            pub fn distributions(&self, target: &Target<'_>) -> Result<Option<Vec<Distribution>>, DispersionError> {
                Ok(match self {
                    $( Self::$Scalar(written) => {
                        Some(written.quantiles(target)?.into_iter().map(Distribution::$Scalar).collect())
                    } )*
                    $( Self::$Name(_) => None, )*
                })
            }

            /// The map of all components together; `None` for a distribution of one number.
            ///
            /// # Errors
            /// What is wrong with target or numbers.
            pub fn joint(&self, target: &JointTarget<'_>) -> Result<Option<Joint>, DispersionError> {
                Ok(match self {
                    $( Self::$Scalar(_) => None, )*
                    $( Self::$Name(written) => Some(Joint::$Name(written.map(target)?)), )*
                })
            }
        }

        /// A distribution of one number, ready to be drawn: one quantile function.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Distribution {
            $(
                #[doc = concat!("See [`", stringify!($Scalar), "`].")]
                $Scalar(<$Scalar as Scalar>::Quantile),
            )*
        }

        impl Quantile for Distribution {
            #[inline]
            fn quantile(&self, u: f64) -> f64 {
                match self { $( Self::$Scalar(ready) => ready.quantile(u), )* }
            }

            #[inline]
            fn quantiles(&self, u: &[f64; 8], values: &mut [f64; 8]) {
                match self { $( Self::$Scalar(ready) => ready.quantiles(u, values), )* }
            }

            #[inline]
            fn of_scores(&self, z: &[f64; 8], values: &mut [f64; 8]) -> bool {
                match self { $( Self::$Scalar(ready) => ready.of_scores(z, values), )* }
            }

            #[inline]
            fn dimensions(&self) -> usize {
                match self { $( Self::$Scalar(ready) => ready.dimensions(), )* }
            }

            fn normal_std(&self) -> Option<f64> {
                match self { $( Self::$Scalar(ready) => ready.normal_std(), )* }
            }

            fn steps(&self) -> Option<Vec<f64>> {
                match self { $( Self::$Scalar(ready) => ready.steps(), )* }
            }

            fn text(&self, words: NumberWords<'_>) -> String {
                match self { $( Self::$Scalar(ready) => ready.text(words), )* }
            }
        }

        /// A distribution of several numbers together, ready to be drawn.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Joint {
            $(
                #[doc = concat!("See [`", stringify!($Name), "`].")]
                $Name(<$Together as Together>::Map),
            )*
        }

        impl Map for Joint {
            fn dimensions(&self) -> usize {
                match self { $( Self::$Name(map) => map.dimensions(), )* }
            }

            fn dimension_name(&self, dimension: usize) -> String {
                match self { $( Self::$Name(map) => map.dimension_name(dimension), )* }
            }

            fn components(&self) -> usize {
                match self { $( Self::$Name(map) => map.components(), )* }
            }

            fn values(&self, u: &[f64], values: &mut [f64]) {
                match self { $( Self::$Name(map) => map.values(u, values), )* }
            }

            fn text(&self, words: NumberWords<'_>) -> String {
                match self { $( Self::$Name(map) => map.text(words), )* }
            }
        }
    };
}
pub(super) use distributions;
