//! Imports that most tests use.
#![allow(unused_imports)] // each program uses a part

pub use super::{
    campaigns::{
        DETUMBLE, DETUMBLE_MAGNETIC, FUSELAGE, NET_LAUNCH, SLEW_CLOSED, SMALL_BODY, SPACECRAFT_STATE, SPIN_DISPERSION,
        WHEEL1, WHEEL1_AT_REST, WHEEL2,
    },
    claims::hold,
    draws,
    every_key::{EVERY_TABLE, distribution_tables, every_scene, without_draws},
    exact::solved,
    golden::Golden,
    observed::{observed, request},
    orbits::{MU, body, circle, near_rounding, plated, tumbling},
    plans::{
        RowBits, campaign_text, files, parsed, planned, root, row_bits, rows, shipped, shortened, single, single_on,
        value,
    },
    runs::{
        DOP853, DORMAND_PRINCE, GAUSS_LEGENDRE, RUNGE_KUTTA, Run, adaptive, blocks, done, everything, fixed, propagate,
        propagate_on, propagate_one, relative, rotational, up_to_sign,
    },
    scenes::{Kind, Uniform, keep_wheels, many_wheels, mixed, random, resolved, set_wheel_rates},
    scratch_folder::{ScratchFolder, assert_fits, assert_says, batches, column, contents, ended, floats, texts},
};
pub use arrow_array::{
    Array, RecordBatch,
    cast::AsArray,
    types::{Float64Type, Int64Type},
};
pub use parquet::file::reader::{FileReader, SerializedFileReader};
pub use serde_json::Value;
pub use sha2::{Digest, Sha256};
pub use spindrift::{
    campaign::{CampaignError, Overrides, Plan, SceneDraws},
    control::laws::{KnownBody, LawInput},
    dynamics::{
        actuation::{BodyState, Laws, WheelState},
        effects::{Effect, ForceModel},
        magnetic_field::MagneticField,
    },
    ensemble::{Ensemble, Part, PartId, Parts, Rows, SingleRun, Supervision, run},
    math::{
        Isa, Real,
        double_double::DoubleDouble,
        vector::{
            conjugate, cross, dcm_from_quaternion, difference, dot, hamilton, norm, product, scaled, sum,
            transposed_product,
        },
    },
    observables::{Group, Groups, Observer, Request, Series, nominal_attitude::NominalAttitude},
    ode::{Control, Dop853, DormandPrince, GaussLegendre, Integrator, RungeKutta4, Tolerance},
    propagation::{
        CompletedRun, Method, PropagationSettings, RotationError, rotation_errors,
        taylor::reference_solution::{ReferenceSolution, TOLERANCE},
    },
    run::{Grid, LocalErrors, Outcome, StateField, StateFields, StateTable, Status, StepStatistics},
    sampling::{
        Design, DistributionKind, SampleId, Written,
        design::{Dimensions, PointSource},
    },
    scene::{
        Actuated, Actuation, ActuationInput, DebrisInput, EnvironmentInput, Epoch, FieldModel, Name, OrbitInput,
        Parameter, PlateInput, Scene, SceneInput, ThrusterInput, TorqueRod, WheelInput, WheelMode,
    },
    statistics::{
        gate::{GateLimit, mean_gate},
        moments::Moments,
        quantile::quantile,
    },
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
    sync::{Mutex, atomic::Ordering},
    time::{Duration, Instant},
};
