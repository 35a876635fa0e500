//! `Numbers`: a field of an input structure seen as plain numbers.

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
