//! [`Plan`]: what will run. Defaults are filled in, scene and dispersions are checked; a row is a pure function of the
//! plan and a sample's id.

use super::analysis::Analysis;
use super::bands;
use super::chosen::Chosen;
use super::columns::request;
use super::description;
use super::document::Document;
use super::draws::DrawTables;
use super::event::Event;
use super::extreme::Extreme;
use super::forces;
use super::known_columns::KnownColumns;
use super::numbers::{FRACTION, LARGEST_SEED, MAX_SAMPLES};
use super::problem::{CampaignError, Problem};
use super::retention::Retention;
use super::settings::Compression;
use super::size;
use super::sources::Sources;
use super::spec::Spec;
use crate::control::laws::LawKind;
use crate::control::{ControlLaw, LoopSpec};
use crate::observables::request::NutationAxis;
use crate::observables::window::MAX_WINDOWS;
use crate::observables::{Group, Request};
use crate::ode::Tolerance;
use crate::propagation::Method;
use crate::run::Grid;
use crate::sampling::{Correlation, Derivation, Design, Dispersion, Dispersions, Draws, Written};
use crate::scene::schedule::applied;
use crate::scene::{Scene, SceneInput};
use std::path::{Path, PathBuf};

#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Name of the campaign and of its results folder.
    pub name: String,
    /// The question that the campaign answers: `campaign.description`, else the first sentence of the comments above
    /// the file's tables; of a file that says none, that of the file that it extends.
    pub description: Option<String>,
    /// Number of samples, at least 1; sample 0 is the nominal scene.
    pub samples: u64,
    /// The samples that run, where these are not all.
    pub chosen: Option<Chosen>,
    /// The number of samples that the file says, where the campaign has ended at another one (`[stop]`); the plan as
    /// text says this one.
    pub written_samples: Option<u64>,
    pub seed: u64,
    /// The times at which each run is observed.
    pub grid: Grid,
    pub method: Method,
    pub tolerance: Tolerance,
    /// The fixed step, s; `Some` exactly where the method has one.
    pub step_s: Option<f64>,
    /// Most steps of one run.
    pub max_steps: u64,
    /// What is observed, in the order of the columns.
    pub groups: Vec<Group>,
    /// Whose angle from the angular momentum nutation is.
    pub nutation_axis: NutationAxis,
    pub nominal: SceneInput,
    pub design: Design,
    pub dispersed: Vec<Dispersion>,
    pub correlated: Vec<Correlation>,
    /// The derived parameters as written.
    pub derived: Vec<Derivation>,
    /// The dispersions ready to be drawn.
    pub dispersions: Dispersions,
    /// Fraction of the samples that are audited: compared with a reference solution.
    pub audit_fraction: f64,
    /// Number of points at which quantiles over time are counted; 0 for none.
    pub band_points: usize,
    /// How many of the first dispersed runs quantiles over time are of ([`Plan::last_counted`]).
    pub band_runs: u64,
    /// Compression of the row files.
    pub compression: Compression,
    /// The control law of every run; its parameters are in the nominal scene.
    pub law: Option<ControlLaw>,
    /// The events that runs are watched for.
    pub events: Vec<Event>,
    /// The extremes that are looked for in them.
    pub extremes: Vec<Extreme>,
    /// What is made of the rows.
    pub analysis: Analysis,
    /// Which runs keep their full time series.
    pub retention: Retention,
    /// The tables of events, extremes, analysis and retention as canonical text has them.
    pub tables: Vec<(&'static str, Written)>,
    /// The keys of the file that have no effect, a sentence each; the plan as text is without them.
    pub ignored: Vec<String>,
}

/// The files that a plan was made from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilesRead {
    pub campaign: PathBuf,
    /// The files that it extends.
    pub extended: Vec<PathBuf>,
    /// The files of numbers and the module that it names, each with the SHA-256 of its bytes.
    pub data: Vec<(PathBuf, String)>,
}

impl FilesRead {
    pub fn paths(&self) -> Vec<PathBuf> {
        std::iter::once(&self.campaign)
            .chain(&self.extended)
            .chain(self.data.iter().map(|(path, _)| path))
            .cloned()
            .collect()
    }
}

/// What the command line says instead of the file, and what a program adds to it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// `--samples`.
    pub samples: Option<u64>,
    /// `--seed`.
    pub seed: Option<u64>,
    /// `--audit`.
    pub audit_fraction: Option<f64>,
    /// `--set`: dotted keys and their values as texts.
    pub settings: Vec<(String, String)>,
    /// The control law that the program brings: `[control]` of the file has its parameters.
    pub law: Option<ControlLaw>,
    /// The law of attitude that the program brings: phases may name it.
    pub attitude_law: Option<&'static LawKind>,
}

/// Observation points where the file does not say.
const POINTS: u64 = 101;
/// The tolerance down to which the error estimate of runs with plates covers their errors
/// (`tests/accuracy/error_estimate.rs`): beyond it the rounding of drag and light counts.
pub(super) const ROUNDING_OF_PLATES: f64 = 1e-12;
/// Tolerance where the file does not say. A Taylor series of higher order costs little: a run at 1e-14 takes about a
/// tenth longer than one at 1e-10, and its errors are near rounding. Runge-Kutta methods pay with many more steps.
fn default_tolerance(method: Method, scene: &SceneInput) -> f64 {
    match method {
        // a Runge-Kutta method is what integrates them
        Method::Auto if scene.environment.acts_on_plates() => ROUNDING_OF_PLATES,
        Method::Auto | Method::Taylor => 1e-14,
        Method::Gyrostat(_) | Method::NullSpace => 1e-10,
    }
}
/// Most steps of a run where the file does not say: minutes of the slowest kernel, so that a run that is stuck ends.
const MAX_STEPS: u64 = 10_000_000;

impl Plan {
    /// The control loop of the campaign file; `None` without one, and of a law that a program brings.
    pub fn loop_spec(&self) -> Option<&LoopSpec> {
        self.law.as_ref().and_then(ControlLaw::spec)
    }

    /// The plan of a campaign that `[stop]` looks at when it has `samples` samples, or at the next number of samples of
    /// a look; the same without `[stop]`.
    #[must_use]
    pub fn at_look(self, samples: u64) -> Plan {
        let look = self.looks().into_iter().find(|look| *look >= samples);
        match (&self.analysis.stop, look) {
            (Some(_), Some(samples)) => Plan { samples, written_samples: Some(self.first_samples()), ..self },
            _ => self,
        }
    }

    /// The number of samples that the file says: with `[stop]` that of the first look.
    pub fn first_samples(&self) -> u64 {
        self.written_samples.unwrap_or(self.samples)
    }

    /// The plan of the file at `path`.
    ///
    /// # Errors
    /// That the file cannot be read, or everything that is wrong with it.
    pub fn load(path: &Path, overrides: Overrides) -> Result<Plan, CampaignError> {
        Self::load_with_files(path, overrides).map(|(plan, _)| plan)
    }

    /// The same, and the files that were read.
    ///
    /// # Errors
    /// That the file cannot be read, or everything that is wrong with it.
    pub fn load_with_files(path: &Path, overrides: Overrides) -> Result<(Plan, FilesRead), CampaignError> {
        let text = size::read(path, &path.display().to_string())?;
        Self::from_text_of(path, &text, overrides)
    }

    /// The same of a file whose text has been read already.
    ///
    /// # Errors
    /// Everything that is wrong with the text.
    pub fn from_text_of(path: &Path, text: &str, overrides: Overrides) -> Result<(Plan, FilesRead), CampaignError> {
        let file =
            path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        let (plan, files) = read(path.parent().unwrap_or(Path::new("")), &file, text, overrides)?;
        Ok((plan, FilesRead { campaign: path.to_owned(), ..files }))
    }

    /// The plan of a file's text; `file` is its name in messages.
    ///
    /// # Errors
    /// Everything that is wrong with the text.
    pub fn from_text(file: &str, text: &str, overrides: Overrides) -> Result<Plan, CampaignError> {
        Self::from_text_in(Path::new(""), file, text, overrides)
    }

    /// The observables that it requests.
    pub fn request(&self) -> Request {
        self.request_over(self.grid.duration())
    }

    /// The observables that it requests of runs of `duration` seconds, which decides which commands of the schedule
    /// act.
    pub fn request_over(&self, duration: f64) -> Request {
        let acting = acting_scene(duration, &self.nominal, &self.dispersions);
        let mut request =
            request(&self.groups, &acting, self.method, self.law.as_ref(), (&self.events, &self.extremes));
        request.nutation_axis = self.nutation_axis;
        self.analysis.windows().take(MAX_WINDOWS).for_each(|window| request.windows.push(window));
        request
    }

    /// The same of a file in `folder`, from which the paths in the text count.
    ///
    /// # Errors
    /// Everything that is wrong with the text.
    pub fn from_text_in(folder: &Path, file: &str, text: &str, overrides: Overrides) -> Result<Plan, CampaignError> {
        read(folder, file, text, overrides).map(|(plan, _)| plan)
    }
}

fn read(folder: &Path, file: &str, text: &str, overrides: Overrides) -> Result<(Plan, FilesRead), CampaignError> {
    let sources = Sources::read(folder, file, text, &overrides.settings)?;
    let mut document = Document::new(&sources).under(overrides.law.clone(), overrides.attitude_law);
    let table = document.parse()?;
    let mut spec = Spec::read(&mut document, &table);
    override_spec(&mut spec, &overrides, &mut document);
    let plan = resolve(&spec, &mut document);
    let data = std::mem::take(&mut document.files);
    document.verdict()?;
    let plan = plan.ok_or_else(|| unreachable_plan(file))?;
    let description = description::of_sources(&sources, plan.description);
    Ok((Plan { description, ..plan }, FilesRead { campaign: PathBuf::new(), extended: sources.extended, data }))
}

/// The nominal scene with the commands that may act in a run of `duration` seconds: without arcs that start later,
/// unless draws move them.
fn acting_scene(duration: f64, scene: &SceneInput, dispersions: &Dispersions) -> SceneInput {
    let mut acting = scene.clone();
    if !dispersions.columns().iter().any(|column| column.parameter.facts().key.ends_with("_delay_s")) {
        let mut starts = (0..scene.actuation.len()).map(|arc| applied(scene, arc).start);
        acting.actuation.retain(|_| starts.next().is_some_and(|start| start < duration));
    }
    acting
}

/// A plan that is missing although no problem was found: impossible, and reported as an error.
fn unreachable_plan(file: &str) -> CampaignError {
    CampaignError::of(Problem {
        file: file.to_owned(),
        line: None,
        key: "plan".to_owned(),
        value: None,
        allowed: "complete".to_owned(),
        remedy: "this is an error of spindrift: please report it with the file".to_owned(),
        is_unknown: false,
        excerpt: None,
    })
}

fn override_spec(spec: &mut Spec, overrides: &Overrides, document: &mut Document<'_>) {
    let mut check = |flag: &str, value: Option<u64>, min: u64, max: u64| {
        if let Some(value) = value.filter(|value| !(min..=max).contains(value)) {
            let allowed = format!("a whole number from {min} to {max}");
            document.add(flag, Some(value.to_string()), allowed, "write a number within this range");
        }
    };
    check("--samples", overrides.samples, 1, MAX_SAMPLES);
    check("--seed", overrides.seed, 0, LARGEST_SEED);
    if let Some(fraction) = overrides.audit_fraction.filter(|fraction| !FRACTION.holds(*fraction)) {
        document.add("--audit", Some(format!("{fraction:?}")), FRACTION.allowed, FRACTION.remedy);
    }
    if let (Some(samples), Some(written), Some(design)) =
        (overrides.samples, spec.settings("campaign").count("samples"), &spec.design)
        && samples != written
        && let Some([why, remedy]) = design.facts().depends_on_samples
    {
        let allowed = format!(
            "left out with design {:?}, {why}: with other than the file's {written} samples every row would be another",
            design.name()
        );
        document.add("--samples", Some(samples.to_string()), allowed, remedy);
    }
    for (key, value) in [("samples", overrides.samples), ("seed", overrides.seed)] {
        value.into_iter().for_each(|value| spec.set("campaign", key, value));
    }
    overrides.audit_fraction.into_iter().for_each(|fraction| spec.set("audit", "fraction", fraction));
}

/// Fills in the defaults, checks what needs several keys, and calls the checks of the layers below; `None` where
/// something is wrong.
fn resolve(spec: &Spec, document: &mut Document<'_>) -> Option<Plan> {
    let (campaign, integrator) = (spec.settings("campaign"), spec.settings("integrator"));
    let (seed, duration_s, step_s) =
        (campaign.count("seed"), campaign.number("duration_s"), integrator.number("step_s"));
    let method = spec.method().unwrap_or(Method::Auto);
    if spec.method().is_some() {
        check_step(method, [step_s, duration_s], document);
    }
    let [both, relative, absolute] =
        ["tolerance", "relative_tolerance", "absolute_tolerance"].map(|key| integrator.number(key));
    if both.is_some() && relative.is_some() && absolute.is_some() {
        let allowed = "left out where relative_tolerance and absolute_tolerance are given";
        let value = both.map(|x| format!("{x:?}"));
        document.add("integrator.tolerance", value, allowed, "delete it: it has no effect");
    }
    let default = both.unwrap_or(default_tolerance(method, &spec.scene));
    let tolerance = Tolerance { relative: relative.unwrap_or(default), absolute: absolute.unwrap_or(default) };

    match Scene::resolve(&spec.scene) {
        Ok(scene) => forces::check(&spec.scene, &scene, method, document),
        Err(errors) => {
            let found = errors.into_iter().map(|e| (e.key.into_owned(), Some(e.value), e.allowed, e.remedy.to_owned()));
            document.add_from_below(found.collect());
        }
    }

    if document.is_loop_unknown {
        // what can be dispersed, and named in requirements, depends on it
        return None;
    }
    let drawn = DrawTables::of(&spec.dispersions, &spec.correlations, &spec.derivations);
    let draws = Draws {
        seed: seed.unwrap_or(0),
        samples: campaign.count("samples"),
        design: spec.design.as_ref().unwrap_or(&Design::DEFAULT),
        disperse: &drawn.dispersed.1,
        correlate: &drawn.correlated.1,
        derive: &drawn.derived.1,
    };
    let dispersions = match Dispersions::new(draws, &spec.scene) {
        Ok(dispersions) => Some(dispersions),
        Err(errors) => {
            let found = errors.into_iter().map(|e| (drawn.path(e.table, e.key), e.value, e.allowed, e.remedy));
            document.add_from_below(found.collect());
            None
        }
    };

    let groups = spec.groups();
    let points = spec.settings("observe").count("points").unwrap_or(POINTS);
    let band_points = bands::resolve(spec.settings("bands").count("points"), points, document);
    let dispersions = dispersions?;
    let acting = acting_scene(duration_s?, &spec.scene, &dispersions);
    let known =
        KnownColumns::new(request(&groups, &acting, method, document.law.as_ref(), (&spec.events, &spec.extremes)));
    let design = spec.design.as_ref().unwrap_or(&Design::DEFAULT);
    let grid = Grid::uniform(duration_s?, usize::try_from(points).ok()?);
    let band_times: Vec<f64> =
        grid.evenly(usize::try_from(band_points).ok()?).into_iter().map(|point| grid.times()[point]).collect();
    spec.analysis.check(
        document,
        &known,
        dispersions.columns(),
        dispersions.samples(),
        design,
        [grid.times(), &band_times],
    );
    let chosen = Chosen::of_written(campaign);
    if let Some(chosen) = &chosen {
        chosen.check(dispersions.samples(), spec.analysis.stop.is_some(), document);
    }
    Some(Plan {
        name: campaign.text("name")?.to_owned(),
        description: campaign.text("description").map(description::in_one_line),
        samples: dispersions.samples(),
        chosen,
        written_samples: None,
        seed: seed?,
        grid,
        method,
        tolerance,
        step_s,
        max_steps: integrator.count("max_steps").unwrap_or(MAX_STEPS),
        groups,
        nutation_axis: spec.nutation_axis(),
        nominal: spec.scene.clone(),
        design: spec.design.clone()?,
        dispersed: drawn.dispersed.1,
        correlated: drawn.correlated.1,
        derived: drawn.derived.1,
        dispersions,
        audit_fraction: spec.settings("audit").number("fraction").unwrap_or(0.0),
        band_points: usize::try_from(band_points).ok()?,
        band_runs: spec.settings("bands").count("runs").unwrap_or(bands::RUNS),
        compression: spec.settings("output").text("compression").and_then(Compression::from_name)?,
        events: spec.events.clone(),
        extremes: spec.extremes.clone(),
        analysis: spec.analysis.clone(),
        retention: spec.retention.clone().unwrap_or_default(),
        law: document.law.clone(),
        ignored: std::mem::take(&mut document.ignored),
        tables: std::mem::take(&mut document.tables),
    })
}

fn check_step(method: Method, [step_s, duration_s]: [Option<f64>; 2], document: &mut Document<'_>) {
    const KEY: &str = "integrator.step_s";
    if document.is_reported(KEY) {
        return;
    }
    let name = method.name();
    match (method.has_fixed_step(), step_s) {
        (true, None) => {
            let allowed = format!("the step of method {name:?}, a number > 0");
            document.add(KEY, None, allowed, "add step_s = 0.001 to [integrator]");
        }
        (true, Some(step)) if duration_s.is_some_and(|duration| step > duration) => {
            let allowed = format!("at most campaign.duration_s ({:?})", duration_s.unwrap_or(f64::NAN));
            document.add(KEY, Some(format!("{step:?}")), allowed, "write a smaller step");
        }
        (false, Some(step)) => {
            let allowed = format!("left out with method {name:?}, which chooses its steps itself");
            document.add(KEY, Some(format!("{step:?}")), allowed, "delete it, or choose a method with a fixed step");
        }
        _ => {}
    }
}
