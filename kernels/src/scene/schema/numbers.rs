//! `Numbers`: a field of an input structure seen as plain numbers. [`kept`]: lists of them, of any length.

use std::sync::{Mutex, PoisonError};

/// A value made of numbers, present or not.
pub(in crate::scene) trait Numbers {
    /// The value of a key that was announced and not read yet: not a number.
    const BLANK: Self;
    /// The numbers; `None` where there is no value.
    fn numbers(&self) -> Option<&[f64]>;
    /// The same, to be changed.
    fn numbers_mut(&mut self) -> Option<&mut [f64]>;
    /// Makes a value that may be absent present.
    fn open(&mut self) {}
}

/// `numbers`, kept once and for good: for structures that are copied with every sample. A program has as many lists as
/// its files have.
pub fn kept(numbers: &[f64]) -> &'static [f64] {
    static KEPT: Mutex<Vec<&'static [f64]>> = Mutex::new(Vec::new());
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let bits = |list: &[f64]| list.iter().map(|number| number.to_bits()).collect::<Vec<_>>();
    if let Some(known) = kept.iter().find(|known| bits(known) == bits(numbers)) {
        return known;
    }
    let list: &'static [f64] = Vec::leak(numbers.to_vec());
    kept.push(list);
    list
}

impl Numbers for f64 {
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

impl<const N: usize> Numbers for [f64; N] {
    const BLANK: Self = [f64::NAN; N];
    #[inline(always)]
    fn numbers(&self) -> Option<&[f64]> {
        Some(self)
    }
    #[inline(always)]
    fn numbers_mut(&mut self) -> Option<&mut [f64]> {
        Some(self)
    }
}

impl Numbers for [[f64; 3]; 3] {
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
