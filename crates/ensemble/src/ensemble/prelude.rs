//! The names of a plan, a scene, an observation and a run that most files share.

pub(crate) use super::threads::{Threads, unpoisoned};
pub(crate) use crate::campaign::{Plan, Requirement, SceneDraws};
pub(crate) use crate::math::Isa;
pub(crate) use crate::math::vector::{dot, norm};
pub(crate) use crate::observables::{Group, Observer, Request};
pub(crate) use crate::propagation::{CompletedRun, Engine, PropagationSettings};
pub(crate) use crate::run::{Grid, Outcome, Quantity, StateField, StateFields, StateTable, Status};
pub(crate) use crate::sampling::SampleId;
pub(crate) use crate::scene::{Parameter, Scene};
pub(crate) use std::collections::BTreeMap;
pub(crate) use std::num::NonZeroUsize;
