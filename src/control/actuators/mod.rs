//! Models of actuators: what they make of a command.
