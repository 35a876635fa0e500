//! [`List`]: up to `N` values in place, so that samples are resolved without allocation.

use core::ops::{Deref, DerefMut};

/// Up to `N` values in place.
#[derive(Clone, Copy, Debug)]
pub struct List<T, const N: usize> {
    items: [T; N],
    len: usize,
}

impl<T: Copy, const N: usize> List<T, N> {
    /// An empty list; `blank` fills unused memory.
    pub const fn empty(blank: T) -> Self {
        List { items: [blank; N], len: 0 }
    }

    /// Appends a value.
    ///
    /// # Panics
    /// If the list is full.
    pub fn push(&mut self, value: T) {
        assert!(self.len < N, "a list of at most {N} values is full");
        self.items[self.len] = value;
        self.len += 1;
    }
}

impl<T, const N: usize> Deref for List<T, N> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.items[..self.len]
    }
}

impl<T, const N: usize> DerefMut for List<T, N> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.items[..self.len]
    }
}

impl<T: PartialEq, const N: usize> PartialEq for List<T, N> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<'a, T, const N: usize> IntoIterator for &'a List<T, N> {
    type Item = &'a T;
    type IntoIter = core::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}
