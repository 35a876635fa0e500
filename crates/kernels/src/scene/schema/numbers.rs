//! `Numbers`: a field of an input structure as plain numbers. [`kept`]: lists of any length.

use super::components::{ACROSS, SCALAR, SYMMETRIC, WXYZ, XYZ};
use super::row::Shape;
use std::sync::{Mutex, PoisonError};

/// A value made of numbers, present or not.
pub(in crate::scene) trait Numbers {
    /// Names of its components.
    const COMPONENTS: &'static [&'static str];
    /// Arrangement of its numbers.
    const SHAPE: Shape = Shape::Plain;
    /// The value of a key that is not read yet: NaN.
    const BLANK: Self;
    /// The numbers; `None` where there is no value.
    fn numbers(&self) -> Option<&[f64]>;
    /// The numbers, to be changed.
    fn numbers_mut(&mut self) -> Option<&mut [f64]>;
    /// Makes a value that may be absent present.
    fn open(&mut self) {}
}

/// `numbers`, kept for good: for structures that are copied with every sample.
pub fn kept(numbers: &[f64]) -> &'static [f64] {
    static KEPT: Mutex<Vec<&'static [f64]>> = Mutex::new(Vec::new());
    let bits = |number: &f64| number.to_bits();
    interned(&KEPT, numbers.to_vec(), |a, b| a.iter().map(bits).eq(b.iter().map(bits)))
}

/// The list in `pool` that equals `list` by `is_same`, or `list` itself, leaked into `pool`.
pub(crate) fn interned<T>(
    pool: &Mutex<Vec<&'static [T]>>,
    list: Vec<T>,
    is_same: impl Fn(&[T], &[T]) -> bool,
) -> &'static [T] {
    let mut pool = pool.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = pool.iter().find(|known| is_same(known, &list)) {
        return known;
    }
    let list: &'static [T] = Vec::leak(list);
    pool.push(list);
    list
}

macro_rules! numbers {
    ($($type:ty: $components:ident $shape:ident, $blank:expr, |$value:ident| $read:expr, $write:expr;)*) => { $(
        impl Numbers for $type {
            const COMPONENTS: &'static [&'static str] = $components;
            const SHAPE: Shape = Shape::$shape;
            const BLANK: Self = $blank;
            #[inline(always)]
            fn numbers(&self) -> Option<&[f64]> {
                let $value = self;
                Some($read)
            }
            #[inline(always)]
            fn numbers_mut(&mut self) -> Option<&mut [f64]> {
                let $value = self;
                Some($write)
            }
        }
    )* };
}

numbers! {
    f64: SCALAR Plain, f64::NAN, |value| std::slice::from_ref(value), std::slice::from_mut(value);
    [f64; 2]: ACROSS Plain, [f64::NAN; 2], |value| value, value;
    [f64; 3]: XYZ Plain, [f64::NAN; 3], |value| value, value;
    [f64; 4]: WXYZ Quaternion, [f64::NAN; 4], |value| value, value;
    [[f64; 3]; 3]: SYMMETRIC Symmetric, [[f64::NAN; 3]; 3], |value| value.as_flattened(), value.as_flattened_mut();
}

impl<T: Numbers> Numbers for Option<T> {
    const COMPONENTS: &'static [&'static str] = T::COMPONENTS;
    const SHAPE: Shape = T::SHAPE;
    const BLANK: Self = Some(T::BLANK);
    #[inline(always)]
    fn numbers(&self) -> Option<&[f64]> {
        self.as_ref().and_then(T::numbers)
    }
    #[inline(always)]
    fn numbers_mut(&mut self) -> Option<&mut [f64]> {
        self.as_mut().and_then(T::numbers_mut)
    }
    fn open(&mut self) {
        self.get_or_insert(T::BLANK);
    }
}
