//! From a wanted torque and force to commands of wheels and thrusters.
