//! [`distributions!`]: the enumerations over all distributions.

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

            /// True if each component of a parameter has this distribution by itself.
            pub const fn is_of_one_number(self) -> bool {
                matches!(self, $(Self::$Scalar)|*)
            }

            /// The keys and the rules between them.
            const fn table(self) -> (&'static [Row], &'static [Rule]) {
                match self {
                    $( Self::$Scalar => (<$Scalar as Scalar>::KEYS, <$Scalar as Scalar>::RULES), )*
                    $( Self::$Name => (<$Together as Together>::KEYS, <$Together as Together>::RULES), )*
                }
            }

            /// The distribution of each component; `None` for one of all components together.
            ///
            /// # Errors
            /// The numbers that do not fit the target.
            pub fn distributions(self, target: &Target<'_>) -> Result<Option<Vec<Distribution>>> {
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
            pub fn joint(self, target: &Target<'_>) -> Result<Option<Joint>> {
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

        impl Deref for Distribution {
            type Target = dyn Quantile;

            fn deref(&self) -> &Self::Target {
                match self { $( Self::$Scalar(quantile) => quantile, )* }
            }
        }

        /// A joint distribution of several numbers.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Joint {
            $(
                #[doc = concat!("See [`", stringify!($Together), "`].")]
                $Name($Together),
            )*
        }

        impl Deref for Joint {
            type Target = dyn Map;

            fn deref(&self) -> &Self::Target {
                match self { $( Self::$Name(map) => map, )* }
            }
        }
    };
}
pub(super) use distributions;
