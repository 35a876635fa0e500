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
    /// The value of a key that is not read yet: not a number.
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

/// The list in `pool` that equals `list` by `is_same`, or `list` itself, leaked into `pool`; a program has few lists.
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

impl Numbers for f64 {
    const COMPONENTS: &'static [&'static str] = SCALAR;
    const BLANK: Self = f64::NAN;
    #[inline(always)]
    fn numbers(&self) -> Option<&[f64]> {
        Some(std::slice::from_ref(self))
    }
    #[inline(always)]
    fn numbers_mut(&mut self) -> Option<&mut [f64]> {
        Some(std::slice::from_mut(self))
    }
}

macro_rules! arrays {
    ($($n:literal $components:ident $shape:ident)*) => { $(
        impl Numbers for [f64; $n] {
            const COMPONENTS: &'static [&'static str] = $components;
            const SHAPE: Shape = Shape::$shape;
            const BLANK: Self = [f64::NAN; $n];
            #[inline(always)]
            fn numbers(&self) -> Option<&[f64]> {
                Some(self)
            }
            #[inline(always)]
            fn numbers_mut(&mut self) -> Option<&mut [f64]> {
                Some(self)
            }
        }
    )* };
}

arrays! { 2 ACROSS Plain 3 XYZ Plain 4 WXYZ Quaternion }

impl Numbers for [[f64; 3]; 3] {
    const COMPONENTS: &'static [&'static str] = SYMMETRIC;
    const SHAPE: Shape = Shape::Symmetric;
    const BLANK: Self = [[f64::NAN; 3]; 3];
    #[inline(always)]
    fn numbers(&self) -> Option<&[f64]> {
        Some(self.as_flattened())
    }
    #[inline(always)]
    fn numbers_mut(&mut self) -> Option<&mut [f64]> {
        Some(self.as_flattened_mut())
    }
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
