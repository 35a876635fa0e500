//! [`PointMemory`]: the memory of one thread for each observation point.

use crate::observables::{Group, Request};
use crate::propagation::Method;

/// Bytes of each observation point in one thread, by what a campaign asks for.
struct Bytes {
    /// Runs of free scenes with the default groups: the trajectories of all lanes, and what is observed of one run.
    base: u64,
    /// Debris whose rotation is integrated.
    debris: u64,
    /// Thrust, motors, or torques on the body.
    actuated: u64,
    /// The group `motion`: the nominal run, which others are compared with.
    motion: u64,
    /// Audits: reference solutions in double-double numbers.
    audit: u64,
    /// Reference solutions of the debris, whether it turns or not.
    audit_debris: u64,
}

/// Largest of the slopes of peak memory over points, from 50,001 to 250,001 and from 60,001 to 160,001 points, of 17 samples in one thread: 0, 2 and 8
/// wheels, without and with a box as debris, without and with thrust and a motor torque, default and all groups, without and with audits of
/// all samples; of `taylor` and `null_space` some of these, with an allowance for the others. Slopes of the same campaign differ by a fifth and
/// more, since freed memory is used again or not. Those of the Runge-Kutta methods are of `dormand_prince`. Those of `motion`, and of reference
/// solutions of a debris that does not turn: also from 20,001 to 70,001 points, two wheels, without debris, with a cube and with a box.
fn bytes(method: Method) -> Bytes {
    match method {
        Method::Auto => {
            Bytes { base: 3300, debris: 2700, actuated: 1400, motion: 700, audit: 3900, audit_debris: 1500 }
        }
        Method::Taylor => {
            Bytes { base: 1950, debris: 1550, actuated: 1950, motion: 1000, audit: 2700, audit_debris: 700 }
        }
        Method::NullSpace => {
            Bytes { base: 1650, debris: 150, actuated: 600, motion: 300, audit: 2700, audit_debris: 900 }
        }
        Method::Gyrostat(_) => {
            Bytes { base: 1550, debris: 1050, actuated: 850, motion: 600, audit: 2200, audit_debris: 900 }
        }
    }
}

/// Bytes of each point of a reference solution under actuation, beyond those of a free one.
const AUDIT_ACTUATED: u64 = 1900;
/// Bytes of each point of a debris, whether it turns or not.
const OF_DEBRIS: u64 = 200;
/// Bytes of each point of a wheel, in all tables together.
const OF_A_WHEEL: u64 = 20;
/// Bytes of each point of a run whose time series is kept, and of its wheels.
const KEPT: [u64; 2] = [2000, 100];

/// What of a campaign decides how much memory an observation point takes.
#[derive(Clone, Copy, Debug)]
pub struct PointMemory {
    /// The method of its runs.
    pub method: Method,
    /// What is observed.
    pub request: Request,
    /// Whether the rotation of the debris is integrated, in the nominal scene or in any draw.
    pub debris_turns: bool,
    /// Whether samples are audited.
    pub audits: bool,
    /// Whether time series of runs are kept.
    pub keeps_series: bool,
}

impl PointMemory {
    /// Memory of one thread for each observation point, bytes: what it takes at most. Fewer groups need less.
    pub fn bytes(&self) -> u64 {
        let (of, request) = (bytes(self.method), &self.request);
        let wheels = request.wheels.len() as u64;
        let actuated = request.actuated.any();
        let if_so = |asked: bool, bytes: u64| if asked { bytes } else { 0 };
        of.base
            + OF_A_WHEEL * wheels
            + if_so(request.debris, OF_DEBRIS)
            + if_so(self.debris_turns, of.debris)
            + if_so(actuated, of.actuated)
            + if_so(request.groups.contains(Group::Motion), of.motion)
            + if_so(self.audits, of.audit)
            + if_so(self.audits && request.debris, of.audit_debris)
            + if_so(self.audits && actuated, AUDIT_ACTUATED)
            + if_so(self.keeps_series, KEPT[0] + KEPT[1] * wheels)
    }
}
