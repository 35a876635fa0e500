//! What most tests use.
#![allow(unused_imports)] // each program uses a part

pub use super::{
    campaigns::{
        DETUMBLE, DETUMBLE_MAGNETIC, FUSELAGE, NET_LAUNCH, SLEW_CLOSED, SPACECRAFT_STATE, SPIN_DISPERSION, WHEEL1,
        WHEEL1_AT_REST, WHEEL2,
    },
    claims::hold,
    draws,
    every_key::EVERY_TABLE,
    golden::Golden,
    observed::{observed, request},
    orbits::{MU, body, near_rounding, plated},
    plans::{parsed, planned, root, rows, shipped},
    runs::{
        DOP853, DORMAND_PRINCE, GAUSS_LEGENDRE, RUNGE_KUTTA, Run, adaptive, blocks, everything, fixed, propagate,
        propagate_on, propagate_one, relative, up_to_sign,
    },
    scenes::{Kind, Uniform, mixed, random, set_wheel_rates},
    scratch_folder::{ScratchFolder, assert_fits, batches, column, contents, ended, floats},
};
pub use arrow_array::{
    Array, RecordBatch,
    cast::AsArray,
    types::{Float64Type, Int64Type},
};
pub use serde_json::Value;
pub use spindrift::{
    campaign::{CampaignError, Overrides, Plan, SceneDraws},
    dynamics::{actuation::Laws, effects::ForceModel},
    ensemble::{Ensemble, Part, PartId, Parts, Rows, SingleRun, Supervision, run},
    math::{
        Isa,
        vector::{conjugate, cross, dcm_from_quaternion, difference, dot, hamilton, norm, product, scaled, sum},
    },
    observables::{Group, Groups, Observer, Request, Series, nominal_attitude::NominalAttitude},
    ode::{Control, Integrator, Tolerance},
    propagation::{
        CompletedRun, Method, PropagationSettings, RotationError, rotation_errors,
        taylor::reference_solution::{ReferenceSolution, TOLERANCE},
    },
    run::{Grid, Outcome, StateField, StateFields, StateTable, Status},
    sampling::{Design, SampleId},
    scene::{
        Actuated, Actuation, ActuationInput, DebrisInput, EnvironmentInput, Epoch, FieldModel, Name, OrbitInput,
        Parameter, PlateInput, Scene, SceneInput, ThrusterInput, WheelInput, WheelMode,
    },
    statistics::{gate::GateLimit, moments::Moments, quantile::quantile},
    workflow::{Campaign, Quiet, Results, Session},
};
pub use std::{
    array::from_fn,
    collections::{BTreeMap, BTreeSet, HashMap},
    f64::consts::PI,
    fs::{self, File},
    num::NonZeroUsize,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::Mutex,
    time::{Duration, Instant},
};
