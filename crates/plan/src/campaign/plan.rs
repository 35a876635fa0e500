//! [`Plan`]: a resolved and checked campaign. A row is a pure function of the plan and a sample's id.

use super::analysis::Analysis;
use super::columns::request;
use super::document::{Document, Overrides};
use super::event::Event;
use super::extreme::Extreme;
use super::known_columns::KnownColumns;
use super::loop_tables::LoopTables;
use super::numbers::{FRACTION, LARGEST_SEED, MAX_SAMPLES};
use super::problem::CampaignError;
use super::retention::Retention;
use super::settings::Compression;
use super::sources::Sources;
use super::spec::Spec;
use super::{bands, chosen, description, forces, size};
use crate::loops::{ControlLaw, LoopSpec};
use crate::observables::request::NutationAxis;
use crate::observables::window::MAX_WINDOWS;
use crate::observables::{Group, Request};
use crate::ode::Tolerance;
use crate::propagation::Method;
use crate::run::Grid;
use crate::sampling::keys::Value;
use crate::sampling::{Correlation, Derivation, Design, Dispersion, Dispersions, Draws, Written};
use crate::scene::schedule::applied;
use crate::scene::{Scene, SceneInput};
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub name: String,
    /// `campaign.description`, else the first sentence of the comments at the top of the file, else the description of
    /// the file that it extends.
    pub description: Option<String>,
    /// At least 1; sample 0 is the nominal scene.
    pub samples: u64,
    /// The samples to run, ascending and different; `None` for all.
    pub chosen: Option<Arc<[u64]>>,
    /// The file's number of samples, which canonical text keeps, if `[stop]` ended the campaign at another one.
    pub written_samples: Option<u64>,
    pub seed: u64,
    pub grid: Grid,
    pub method: Method,
    pub tolerance: Tolerance,
    /// Step, s; `Some` exactly for fixed-step methods.
    pub step_s: Option<f64>,
    pub max_steps: u64,
    /// Observed groups, in the order of the columns.
    pub groups: Vec<Group>,
    /// The axis whose angle from the angular momentum is the nutation angle.
    pub nutation_axis: NutationAxis,
    pub nominal: SceneInput,
    pub design: Design,
    pub dispersed: Vec<Dispersion>,
    pub correlated: Vec<Correlation>,
    pub derived: Vec<Derivation>,
    pub dispersions: Dispersions,
    /// Fraction of the samples that are compared with a reference solution.
    pub audit_fraction: f64,
    /// Points of the quantiles over time; 0 for none.
    pub band_points: usize,
    /// Number of leading dispersed runs in quantiles over time ([`Plan::last_counted`]).
    pub band_runs: u64,
    pub compression: Compression,
    /// The control law; its parameters are in the nominal scene.
    pub law: Option<ControlLaw>,
    pub events: Vec<Event>,
    pub extremes: Vec<Extreme>,
    pub analysis: Analysis,
    pub retention: Retention,
    /// Tables of events, extremes, analysis and retention, as in canonical text.
    pub tables: Vec<(&'static str, Written)>,
    /// One sentence for each key without effect; canonical text omits these keys.
    pub ignored: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilesRead {
    pub campaign: PathBuf,
    pub extended: Vec<PathBuf>,
    /// Data files and module, each with its SHA-256.
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

const POINTS: u64 = 101;
/// Below this tolerance, the rounding of drag and light exceeds the error estimate
/// (`tests/accuracy/error_estimate.rs`).
pub(super) const ROUNDING_OF_PLATES: f64 = 1e-12;
/// Default tolerance. A Taylor run at 1e-14 takes a tenth longer than at 1e-10, with errors near rounding; Runge-Kutta
/// methods need many more steps.
fn default_tolerance(method: Method, scene: &SceneInput) -> f64 {
    match method {
        // Runge-Kutta integrates them
        Method::Auto if scene.environment.acts_on_plates() => ROUNDING_OF_PLATES,
        Method::Auto | Method::Taylor => 1e-14,
        Method::Gyrostat(_) | Method::NullSpace => 1e-10,
    }
}
/// Default limit: minutes of the slowest kernel, so that a stuck run ends.
const MAX_STEPS: u64 = 10_000_000;

impl Plan {
    /// The file's control loop; `None` without one and for a law of the calling program.
    pub fn loop_spec(&self) -> Option<&LoopSpec> {
        self.law.as_ref().and_then(ControlLaw::spec)
    }

    /// The plan at the first look of `[stop]` with at least `samples` samples; unchanged without `[stop]`.
    #[must_use]
    pub fn at_look(self, samples: u64) -> Plan {
        let look = self.looks().into_iter().find(|look| *look >= samples);
        match (&self.analysis.stop, look) {
            (Some(_), Some(samples)) => Plan { samples, written_samples: Some(self.first_samples()), ..self },
            _ => self,
        }
    }

    /// The number of samples in the file, which is the first look's with `[stop]`.
    pub fn first_samples(&self) -> u64 {
        self.written_samples.unwrap_or(self.samples)
    }

    /// The plan of the file at `path`.
    ///
    /// # Errors
    /// An unreadable file, or all its problems.
    pub fn load<L: LoopTables>(path: &Path, overrides: Overrides<L>) -> Result<Plan, CampaignError> {
        Self::load_with_files(path, overrides).map(|(plan, _)| plan)
    }

    /// [`Plan::load`], with the files read.
    ///
    /// # Errors
    /// An unreadable file, or all its problems.
    pub fn load_with_files<L: LoopTables>(
        path: &Path,
        overrides: Overrides<L>,
    ) -> Result<(Plan, FilesRead), CampaignError> {
        let text = size::read(path, &path.display().to_string())?;
        Self::from_text_of(path, &text, overrides)
    }

    /// [`Plan::load_with_files`] for a file whose text is known.
    ///
    /// # Errors
    /// All problems of the text.
    pub fn from_text_of<L: LoopTables>(
        path: &Path,
        text: &str,
        overrides: Overrides<L>,
    ) -> Result<(Plan, FilesRead), CampaignError> {
        let file =
            path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        let (plan, files) = read(path.parent().unwrap_or(Path::new("")), &file, text, overrides)?;
        Ok((plan, FilesRead { campaign: path.to_owned(), ..files }))
    }

    /// The plan of a text, called `file` in messages.
    ///
    /// # Errors
    /// All problems of the text.
    pub fn from_text<L: LoopTables>(file: &str, text: &str, overrides: Overrides<L>) -> Result<Plan, CampaignError> {
        Self::from_text_in(Path::new(""), file, text, overrides)
    }

    pub fn request(&self) -> Request {
        self.request_over(self.grid.duration())
    }

    /// The observables of runs of `duration` seconds, which decides which commands of the schedule act.
    pub fn request_over(&self, duration: f64) -> Request {
        let acting = acting_scene(duration, &self.nominal, &self.dispersions);
        let mut request =
            request(&self.groups, &acting, self.method, self.law.as_ref(), (&self.events, &self.extremes));
        request.nutation_axis = self.nutation_axis;
        self.analysis.windows().take(MAX_WINDOWS).for_each(|window| request.windows.push(window));
        request
    }

    /// [`Plan::from_text`] with paths relative to `folder`.
    ///
    /// # Errors
    /// All problems of the text.
    pub fn from_text_in<L: LoopTables>(
        folder: &Path,
        file: &str,
        text: &str,
        overrides: Overrides<L>,
    ) -> Result<Plan, CampaignError> {
        read(folder, file, text, overrides).map(|(plan, _)| plan)
    }
}

fn read<L: LoopTables>(
    folder: &Path,
    file: &str,
    text: &str,
    overrides: Overrides<L>,
) -> Result<(Plan, FilesRead), CampaignError> {
    let sources = Sources::read(folder, file, text, &overrides.settings)?;
    let mut document = Document::new(&sources, &overrides);
    let table = document.parse()?;
    let mut spec = Spec::read(&mut document, &table, &overrides.loops);
    override_spec(&mut spec, &overrides, &mut document);
    let plan = resolve(&spec, &mut document);
    let data = std::mem::take(&mut document.files);
    document.verdict()?;
    let plan = plan.ok_or_else(|| {
        let remedy = "this is an error of spindrift: please report it with the file";
        CampaignError::new(file, "plan", None, "complete", remedy)
    })?;
    let description = description::of_sources(&sources, plan.description);
    Ok((Plan { description, ..plan }, FilesRead { campaign: PathBuf::new(), extended: sources.extended, data }))
}

/// The nominal scene without arcs that start after `duration` seconds, unless start times are dispersed.
fn acting_scene(duration: f64, scene: &SceneInput, dispersions: &Dispersions) -> SceneInput {
    let mut acting = scene.clone();
    if !dispersions.columns().iter().any(|column| column.parameter.facts().key.ends_with("_delay_s")) {
        let mut starts = (0..scene.actuation.len()).map(|arc| applied(scene, arc).start);
        acting.actuation.retain(|_| starts.next().is_some_and(|start| start < duration));
    }
    acting
}

fn override_spec<L>(spec: &mut Spec, overrides: &Overrides<L>, document: &mut Document<'_>) {
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

/// Fills in defaults, checks keys against each other and runs the checks of the layers below; `None` after a problem.
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
        // parameters and columns depend on the loop
        return None;
    }
    let design = spec.design.clone().unwrap_or_default();
    let draws = Draws {
        seed: seed.unwrap_or(0),
        samples: campaign.count("samples"),
        design: &design,
        disperse: &spec.dispersions,
        correlate: &spec.correlations,
        derive: &spec.derivations,
    };
    let dispersions = match Dispersions::new(draws, &spec.scene) {
        Ok(dispersions) => Some(dispersions),
        Err(errors) => {
            let found = errors.into_iter().map(|e| (format!("{}.{}", e.table, e.key), e.value, e.allowed, e.remedy));
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
    let grid = Grid::uniform(duration_s?, usize::try_from(points).ok()?);
    let band_times: Vec<f64> =
        grid.evenly(usize::try_from(band_points).ok()?).into_iter().map(|point| grid.times()[point]).collect();
    spec.analysis.check(
        document,
        &known,
        dispersions.columns(),
        dispersions.samples(),
        &design,
        [grid.times(), &band_times],
    );
    let chosen = if let Some(Value::Counts(samples)) = campaign.get("only") { Some(samples.flat()) } else { None };
    if let Some(chosen) = &chosen {
        chosen::check(chosen, dispersions.samples(), spec.analysis.stop.is_some(), document);
    }
    Some(Plan {
        name: campaign.text("name")?.to_owned(),
        description: campaign.text("description").map(description::in_one_line),
        samples: dispersions.samples(),
        chosen: chosen.map(Arc::from),
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
        dispersed: spec.dispersions.clone(),
        correlated: spec.correlations.clone(),
        derived: spec.derivations.clone(),
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
