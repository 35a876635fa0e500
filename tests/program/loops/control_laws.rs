//! A stored campaign under a control law of a program's own.

use crate::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64};

use spindrift::{
    control::{ControlLaw, LawContext},
    dynamics::actuation::Actuation,
    loops::OwnLaw,
    storage::claim::Shard,
    workflow::{CampaignOutcome, Finished, Outputs, Verification, Watch, WorkflowError, finish, verify},
};

#[path = "../../../examples/control_campaign.rs"]
#[expect(dead_code, reason = "the example runs in tests/project")]
mod example;

fn campaign<'a>(session: Session<'a>, root: &Path) -> Campaign<'a> {
    example::campaign(session).samples(600).audit(0.02).store(root)
}

fn threads(session: Session<'_>, threads: usize) -> Session<'_> {
    session.on_threads(NonZeroUsize::new(threads))
}

fn files(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let found = contents(root);
    assert!(found.len() > 5, "{:?}", found.keys());
    found
}

struct StopAfter {
    runs: u64,
    done: AtomicU64,
    stop: AtomicBool,
}

impl Watch for StopAfter {
    fn advance(&self, samples: u64) {
        if self.done.fetch_add(samples, Ordering::SeqCst) + samples >= self.runs {
            self.stop.store(true, Ordering::SeqCst);
        }
    }

    fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    fn abandon(&self) -> &AtomicBool {
        &self.stop
    }
}

fn net_launch<'a>(session: Session<'a>, root: &Path) -> Campaign<'a> {
    let text = NET_LAUNCH.replace("duration_s = 2400.0", "duration_s = 20.0");
    Campaign::from_text("net_launch.toml", &text, session).samples(600).audit(0.02).store(root)
}

#[test]
fn a_campaign_under_a_law_is_a_function_of_its_plan() {
    is_a_function_of_its_plan("own", Some(&example::law()), campaign);
    is_a_function_of_its_plan("loop", None, net_launch);
}

fn session<'a>(watch: &'a dyn Watch, law: Option<&'a OwnLaw>) -> Session<'a> {
    let session = Session::new(watch).unwrap();
    law.map_or(session, |law| session.under(law))
}

fn is_a_function_of_its_plan(
    which: &str,
    law: Option<&OwnLaw>,
    campaign: for<'a> fn(Session<'a>, &Path) -> Campaign<'a>,
) {
    let scratch = ScratchFolder::new(&format!("law-bytes-{which}"));
    let quiet = Quiet::default();
    let session_of = session;
    let session = session_of(&quiet, law);
    let of = |name: &str| scratch.path(name);
    campaign(threads(session, 1), &of("one")).results().unwrap();
    let expected = files(&of("one"));

    campaign(threads(session, 2), &of("two")).results().unwrap();
    assert!(files(&of("two")) == expected, "{which}: two threads");

    let stopping = StopAfter { runs: 300, done: AtomicU64::new(0), stop: AtomicBool::new(false) };
    let stopped = campaign(threads(session_of(&stopping, law), 1), &of("stopped")).prepare().unwrap();
    let Ok(CampaignOutcome::Stopped { samples: 600, left }) = stopped.unwrap().run() else { panic!("it is stopped") };
    assert!((1..600).contains(&left), "{left} left");
    campaign(session, &of("stopped")).results().unwrap();
    assert!(files(&of("stopped")) == expected, "{which}: stopped and continued");

    for number in 1..=3 {
        let shard = campaign(session, &of("shards")).shard(Shard { number, of: 3 }).prepare().unwrap().unwrap();
        assert!(matches!(shard.run(), Ok(CampaignOutcome::ShardDone { .. })));
    }
    let finished = finish(&session, &of("shards"), &Outputs::default(), &|_| Ok(())).unwrap();
    assert!(matches!(finished, Finished::Now(_)));
    assert!(files(&of("shards")) == expected, "{which}: three shards");

    let verified = verify(&session, &of("one"), Verification { fraction: 1.0, repair: false }).unwrap().unwrap();
    assert_eq!(verified.checked.problems, 0);
    let part = fs::read_dir(of("one").join("runs")).unwrap().next().unwrap().unwrap().path();
    fs::write(&part, b"no rows").unwrap();
    let repaired = verify(&session, &of("one"), Verification { fraction: 0.0, repair: true }).unwrap().unwrap();
    assert!(repaired.checked.problems > 0 && files(&of("one")) == expected);
}

#[test]
fn rows_under_a_law_are_its_runs() {
    let scratch = ScratchFolder::new("law-rows");
    let (quiet, law) = (Quiet::default(), example::law());
    let session = Session::new(&quiet).unwrap().under(&law);
    let results = campaign(session, &scratch.path("r")).results().unwrap();
    let columns = results.plan().request().columns();
    let rows: Vec<Vec<f64>> = columns.iter().map(|column| results.column(column.quantity.name()).unwrap()).collect();
    for sample in [0, 1, 7, 8, 255, 256, 599] {
        let run = results.replay(SampleId(sample)).unwrap();
        assert_eq!((run.outcome.status, run.arcs.len()), (Status::Done, 240));
        for ((column, row), value) in columns.iter().zip(&rows).zip(&run.row) {
            let stored = row[sample as usize];
            assert!(stored.to_bits() == value.to_bits() || (stored.is_nan() && value.is_nan()), "{sample} {column:?}");
        }
        assert!(run.audit(results.plan(), session.isa).unwrap().state() < 1e-11, "sample {sample}");
    }
    let audited: Vec<f64> =
        results.column("audit_state_error").unwrap().into_iter().filter(|error| !error.is_nan()).collect();
    assert!(audited.len() > 3 && audited.iter().all(|error| *error < 1e-11), "{audited:?}");
    let [own, of_audit] =
        ["state_error_estimate", "audit_state_error_estimate"].map(|name| results.column(name).unwrap());
    for (own, of_audit) in own.iter().zip(&of_audit).filter(|(_, of_audit)| !of_audit.is_nan()) {
        assert_eq!(own, of_audit);
    }
    let [work, energy, momentum] = ["work_motors_final_j", "energy_error_max", "angular_momentum_error_max"]
        .map(|name| results.column(name).unwrap());
    assert!(work.iter().skip(1).all(|work| work.abs() > 1e-6), "motors work in each run that is dispersed");
    assert!(energy.iter().chain(&momentum).all(|error| error.abs() < 1e-12));
    let stiffness = results.column("control_stiffness_n_m").unwrap();
    assert!(stiffness[0] == 0.6 && stiffness[1] != stiffness[2]);
    let last = ["x", "y", "z"].map(|axis| results.column(&format!("omega_se_s_{axis}_final_rad_s")).unwrap());
    let first = ["x", "y", "z"].map(|axis| results.column(&format!("initial_angular_velocity_{axis}_rad_s")).unwrap());
    let sum = |rates: &[Vec<f64>; 3]| rates.iter().flatten().map(|rate| rate * rate).sum::<f64>().sqrt();
    assert!(sum(&last) < 0.03 * sum(&first), "{} {}", sum(&last), sum(&first));
}

#[test]
fn the_law_is_part_of_the_plan() {
    let scratch = ScratchFolder::new("law-plan");
    let (quiet, law) = (Quiet::default(), example::law());
    let session = Session::new(&quiet).unwrap();
    let root = scratch.path("r");
    example::campaign(session.under(&law)).samples(20).store(&root).results().unwrap();
    let reason = |session: Session<'_>| match Results::open(&root, session) {
        Err(WorkflowError::Files(reason)) => reason,
        _ => panic!("refused"),
    };
    assert_says(reason(session), ["control", "plan.toml"]);
    let idle = |_: &LawContext<'_>| |_: f64, _: &BodyState, _: &WheelState| Actuation::none(f64::INFINITY);
    let other = OwnLaw::Loop(ControlLaw::new("idle", Actuated::NONE, &example::PARAMETERS, idle));
    let refused = reason(session.under(&other));
    assert_says(&refused, ["wheel_hold", "idle"]);
    scratch.shows("report r", 4, "control");
    let text = fs::read_to_string(root.join("plan.toml")).unwrap();
    let hash = |text: &str| {
        let prepared = Campaign::from_text("p.toml", text, session.under(&law)).prepare().unwrap().unwrap();
        prepared.plan().row_hash()
    };
    assert_says(&text, ["law = \"wheel_hold\"", "damping_n_m_s = 6.0"]);
    assert_ne!(hash(&text), hash(&text.replace("damping_n_m_s = 6.0", "damping_n_m_s = 6.5")));
    let negative = Campaign::from_text(
        "p.toml",
        &text.replace("damping_n_m_s = 6.0", "damping_n_m_s = -6.0"),
        session.under(&law),
    );
    let Err(WorkflowError::Input(reason)) = negative.prepare() else { panic!("refused") };
    assert_says(&reason, ["control.damping_n_m_s = -6.0"]);
}

#[test]
fn a_law_has_the_nominal_and_the_drawn_scene() {
    let make = |context: &LawContext<'_>| {
        let torque = [context.drawn.mass.total, context.nominal.mass.total, context.sample.0 as f64];
        move |_: f64, _: &BodyState, _: &WheelState| Actuation { body_torque: torque, ..Actuation::none(f64::INFINITY) }
    };
    let law = ControlLaw::new("scenes", Actuated { body_torque: true, ..Actuated::NONE }, &[], make);
    let overrides = Overrides { law: Some(OwnLaw::Loop(law)), ..Overrides::default() };
    let text = campaign_without_debris()
        + "[[disperse]]\nparameter = \"body.parts.fuselage.mass_scale\"\ndistribution = \"uniform\"\nmin = 0.5\nmax = \
            1.5\n";
    let scheduled = text.clone() + "[[actuation]]\nstart_s = 0.25\nend_s = 0.5\ntorque_n_m = { w1 = 3.0 }\n";
    let plan = |text: &str| Plan::from_text("scenes.toml", text, overrides.clone()).unwrap();
    let run = |text: &str, sample: u64| single(&plan(text), sample);
    let nominal = run(&text, 0).scene.mass.total;
    for sample in [0, 3, 9] {
        let run = run(&text, sample);
        assert_eq!(run.arcs.len(), 1);
        assert_eq!(run.arcs[0].applied.body_torque, [run.scene.mass.total, nominal, sample as f64]);
        assert_eq!(run.scene.mass.total == nominal, sample == 0, "the mass of sample {sample} is drawn");
    }
    let arcs = run(&scheduled, 3).arcs;
    let shown: Vec<(f64, f64, bool)> =
        arcs.iter().map(|arc| (arc.start, arc.applied.motor_torque[0], arc.applied.body_torque[2] == 3.0)).collect();
    assert_eq!(shown, [(0.0, 0.0, true), (0.25, 3.0, true), (0.5, 0.0, true)]);
}
