//! [`distributions!`]: the enumerations over all distributions, which pass each call on to its member.

macro_rules! distributions {
    (one number: $($Scalar:ident),* ; several together: $($Name:ident = $Together:ty),* $(,)?) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum DistributionKind {
            $(
                #[doc = concat!("See [`", stringify!($Scalar), "`].")]
                $Scalar,
            )*
            $(
                #[doc = concat!("See [`Joint::", stringify!($Name), "`].")]
                $Name,
            )*
        }

        impl DistributionKind {
            pub const ALL: &'static [DistributionKind] = &[$(Self::$Scalar,)* $(Self::$Name,)*];

            /// The names in campaign files.
            pub const NAMES: &'static [&'static str] =
                &[$(<$Scalar as Scalar>::NAME,)* $(<$Together as Together>::NAME,)*];

            /// Whether each component of a parameter has this distribution by itself.
            pub const fn is_of_one_number(self) -> bool {
                match self {
                    $( Self::$Scalar => true, )*
                    $( Self::$Name => false, )*
                }
            }

            pub const fn keys(self) -> &'static [Row] {
                match self {
                    $( Self::$Scalar => <$Scalar as Scalar>::KEYS, )*
                    $( Self::$Name => <$Together as Together>::KEYS, )*
                }
            }

            /// Rules between keys.
            pub const fn rules(self) -> &'static [Rule] {
                match self {
                    $( Self::$Scalar => <$Scalar as Scalar>::RULES, )*
                    $( Self::$Name => <$Together as Together>::RULES, )*
                }
            }

            /// The distribution of each component; `None` for one of all components together.
            ///
            /// # Errors
            /// The numbers that do not fit the target.
            pub fn distributions(self, target: &Target<'_>) -> Result<Option<Vec<Distribution>>, DispersionError> {
                Ok(match self {
                    $( Self::$Scalar => {
                        Some($Scalar::of(target)?.into_iter().map(Distribution::$Scalar).collect())
                    } )*
                    $( Self::$Name => None, )*
                })
            }

            /// The map of all components together; `None` for a distribution of one number.
            ///
            /// # Errors
            /// The target or the numbers that do not fit.
            pub fn joint(self, target: &Target<'_>) -> Result<Option<Joint>, DispersionError> {
                Ok(match self {
                    $( Self::$Scalar => None, )*
                    $( Self::$Name => Some(Joint::$Name(<$Together as Together>::map(target)?)), )*
                })
            }
        }

        /// A distribution of one number: a quantile function.
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

        /// A joint distribution of several numbers.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Joint {
            $(
                #[doc = concat!("See [`", stringify!($Together), "`].")]
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
