//! `spindrift check`: what a campaign would run.

use std::fmt::Write as _;
use std::time::Instant;

use crate::campaign::Overrides;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::run_campaign::bytes;
use crate::cli::{CheckOptions, dispersions, isa, plan, screen};
use crate::dataset::rows_file::RowsFile;
use crate::ensemble::{Auditor, Ensemble, Part, PartId, Parts, Rows};
use crate::observables::Request;
use crate::run::StateField;
use crate::report::number::short;
use crate::run::Status;
use crate::sampling::SampleId;
use crate::scene::{MassProperties, Scene};

/// The probe runs about this long, s.
const PROBE_SECONDS: f64 = 0.5;
/// The probe runs at most this many samples.
const PROBE_SAMPLES: usize = 512;

/// Runs the command.
///
/// # Errors
/// Where the campaign file is wrong.
pub fn run(options: &CheckOptions) -> Result<CommandOutcome, Failure> {
    let plan = plan(&options.file, Overrides::default())?;
    let campaign = Ensemble::new(&plan, isa()?);
    let scene = Scene::resolve(&plan.nominal)
        .map_err(|errors| Failure::Input(errors.iter().map(|error| format!("{error}\n")).collect()))?;
    let mut text = String::new();
    let written = (|| {
        section(&mut text, &format!("Plan (hash {})", plan.hash()))?;
        text.push_str(&plan.text());
        masses(&mut text, &scene.mass)?;
        section(&mut text, "Dispersions")?;
        dispersions::table(&mut text, &plan)?;
        blocks(&mut text, &campaign)?;
        std::fmt::Result::Ok(())
    })();
    written.map_err(Failure::files)?;
    screen::print(&text)?;
    screen::print(&estimate(&campaign)?)?;
    screen::print(&audit_estimate(&campaign))?;
    Ok(CommandOutcome::Done)
}

fn section(text: &mut String, title: &str) -> std::fmt::Result {
    let gap = if text.is_empty() { "" } else { "\n" };
    writeln!(text, "{gap}== {title}")
}

/// Masses, centre of mass, inertia, with the convention.
fn masses(text: &mut String, mass: &MassProperties) -> std::fmt::Result {
    section(text, "Mass properties of the nominal scene")?;
    let [wheel1, wheel2] = &mass.wheels;
    let debris = mass.debris.as_ref().map(|debris| ("debris", debris.mass));
    for (body, mass) in [("fuselage", mass.fuselage.mass), ("wheel 1", wheel1.mass), ("wheel 2", wheel2.mass)]
        .into_iter()
        .chain([("spacecraft", mass.total)])
        .chain(debris)
    {
        writeln!(text, "{body:<12}{mass:>24?} kg")?;
    }
    let [x, y, z] = mass.center;
    writeln!(text, "centre of mass of the spacecraft, from p in F_s: [{x:?}, {y:?}, {z:?}] m")?;
    tensor(text, "inertia of the spacecraft, wheels locked, about its centre of mass", mass.inertia)?;
    tensor(text, "the same less the wheels' axial inertias (J*: wheels free)", mass.inertia_free)?;
    tensor(text, "inertia of the fuselage about its own centre of mass", mass.fuselage.inertia)?;
    for (number, wheel) in [(1, wheel1), (2, wheel2)] {
        let (axial, transverse, mode) = (wheel.axial, wheel.transverse, wheel.mode.name());
        writeln!(
            text,
            "wheel {number}: axial {axial:?}, transverse {transverse:?} kg m^2, {mode}, axis {:?} in F_s",
            wheel.axis
        )?;
    }
    writeln!(
        text,
        "Convention: tensors in F_s (origin p, s3 along the fuselage's axis, wheel 1 spins about s2, wheel 2 about s3);\n\
         off-diagonal entries are those of the tensor, J_xy = -integral of x y dm."
    )
}

fn tensor(text: &mut String, name: &str, rows: [[f64; 3]; 3]) -> std::fmt::Result {
    writeln!(text, "{name}, kg m^2:")?;
    for [x, y, z] in rows {
        writeln!(text, "  {x:>24?}{y:>24?}{z:>24?}")?;
    }
    Ok(())
}

/// What is integrated and why, and what is not.
fn blocks(text: &mut String, campaign: &Ensemble<'_>) -> std::fmt::Result {
    section(text, "What is computed")?;
    let reasons = campaign.request().reasons();
    for block in StateField::ALL {
        let name = block_name(block);
        match reasons.iter().find(|(needed, _)| *needed == block) {
            Some((_, reason)) => writeln!(text, "{name:<44} needed because of {reason}")?,
            None => writeln!(text, "{name:<44} skipped: {}", absence(campaign.request(), block))?,
        }
    }
    for (piece, scheduled) in [("thrust", campaign.propagator().thrust), ("wheel motors", campaign.propagator().motors)]
    {
        let why = if scheduled { "needed because the schedule has it" } else { "skipped: not in the schedule" };
        writeln!(text, "{piece:<44} {why}")?;
    }
    let asked: Vec<&str> = campaign.plan().groups.iter().map(|group| group.name()).collect();
    writeln!(text, "observed groups: {}", asked.join(", "))
}

/// Why a block is not computed.
fn absence(request: &Request, block: StateField) -> &'static str {
    match block {
        StateField::DebrisPosition
        | StateField::DebrisVelocity
        | StateField::DebrisAttitude
        | StateField::DebrisRate
            if !request.debris =>
        {
            "there is no debris"
        }
        StateField::Work | StateField::Impulse | StateField::AngularImpulse if !request.actuated => "no actuator works",
        StateField::Dcm | StateField::Residuals | StateField::KineticEnergies if !request.constrained => {
            "only the reference kernel has it"
        }
        _ => "nothing observed needs it",
    }
}

fn block_name(block: StateField) -> &'static str {
    match block {
        StateField::Rate => "angular velocity of the fuselage",
        StateField::Attitude => "attitude quaternion",
        StateField::WheelRates => "wheel rates",
        StateField::WheelAngles => "wheel angles",
        StateField::ComPosition => "position of the centre of mass",
        StateField::ComVelocity => "velocity of the centre of mass",
        StateField::Work => "work of the actuators",
        StateField::Impulse => "impulse of the thrusters",
        StateField::AngularImpulse => "angular impulse of the thrusters",
        StateField::DebrisPosition => "position of the debris",
        StateField::DebrisVelocity => "velocity of the debris",
        StateField::DebrisAttitude => "attitude of the debris",
        StateField::DebrisRate => "angular velocity of the debris",
        StateField::Dcm => "direction cosine matrix (reference kernel)",
        StateField::Residuals => "constraint residuals (reference kernel)",
        StateField::KineticEnergies => "kinetic energies of the redundant states (reference kernel)",
    }
}

/// What the audits would cost, from a short probe of the first samples.
fn audit_estimate(campaign: &Ensemble<'_>) -> String {
    let plan = campaign.plan();
    if plan.audit_fraction == 0.0 {
        return "no sample is audited ([audit] fraction = 0.01 or --audit 0.01 runs one in a hundred again exactly)\n"
            .to_owned();
    }
    let mut auditor = Auditor::new(plan, campaign.isa(), &plan.grid);
    let mut sampler = plan.dispersions.sampler();
    let mut input = plan.nominal.clone();
    let mut applied = vec![0.0; plan.dispersions.columns().len()];
    let start = Instant::now();
    let (mut audits, mut sample) = (0_u32, 0);
    while sample < plan.samples && start.elapsed().as_secs_f64() < PROBE_SECONDS {
        sampler.draw(SampleId(sample), &mut input, &mut applied);
        if let Ok(scene) = Scene::resolve(&input) {
            auditor.audit(&scene);
            audits += 1;
        }
        sample += 1;
    }
    let each = start.elapsed().as_secs_f64() / f64::from(audits.max(1));
    let count = plan.audit_fraction * plan.samples as f64;
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get);
    format!(
        "audit of {} of the samples, from {audits} audits: {:.1} ms each, about {} of them on {cores} cores: {} s more\n",
        short(plan.audit_fraction),
        each * 1e3,
        short(libm::round(count)),
        short(each * count / cores as f64),
    )
}

/// Time and disk from a short probe.
fn estimate(campaign: &Ensemble<'_>) -> Result<String, Failure> {
    let plan = campaign.plan();
    let most = usize::try_from(plan.samples).unwrap_or(usize::MAX).min(PROBE_SAMPLES);
    let mut rows = Rows::new(campaign.shape(), most);
    let mut worker = campaign.worker();
    let mut timed = |count: usize| {
        let start = Instant::now();
        worker.run(Part { id: PartId(0), first: SampleId(0), count }, &mut rows, &|_| {});
        start.elapsed().as_secs_f64()
    };
    timed(1); // warm
    let one = timed(1).max(1e-7);
    let count = ((PROBE_SECONDS / one) as usize).clamp(1, most);
    let each = timed(count) / count as f64;
    let failed = rows.statuses().iter().filter(|status| **status != Status::Done).count();

    let file = RowsFile::new(campaign).map_err(Failure::files)?;
    let mut packed = Vec::new();
    file.write(&rows, &mut packed).map_err(Failure::files)?;
    rows.start(Part { id: PartId(0), first: SampleId(0), count: 1 });
    let mut empty = Vec::new();
    file.write(&rows, &mut empty).map_err(Failure::files)?;
    let row = if count > 1 {
        packed.len().saturating_sub(empty.len()) as f64 / (count - 1) as f64
    } else {
        (file.columns() * size_of::<f64>()) as f64
    };
    let parts = Parts::of(plan.samples);
    let disk = row * plan.samples as f64 + empty.len() as f64 * parts.count() as f64;
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get);
    let seconds = each * plan.samples as f64 / cores as f64;
    Ok(format!(
        "\n== Estimate, from {count} runs\n\
         {:.3} ms a run on one core; {} samples on {cores} cores: about {} s\n\
         {} columns; {} file{} of rows: about {}\n\
         {}",
        each * 1e3,
        plan.samples,
        short(seconds),
        file.columns(),
        parts.count(),
        if parts.count() == 1 { "" } else { "s" },
        bytes(disk as u64),
        if failed == 0 { String::new() } else { format!("{failed} of the {count} runs failed\n") },
    ))
}
