//! Models of sensors: from the true state to measurements.
