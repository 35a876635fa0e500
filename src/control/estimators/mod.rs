//! From measurements to an estimate of the state.
