//! A program's own attitude law in the phases of a control loop.

use crate::prelude::*;
use spindrift::{
    control::laws::{LawKind, PhaseLaw},
    loops::OwnLaw,
    loops::vector::{cross, difference, product, scaled, sum},
    scene::{LawParameter, schema::Limit},
    workflow::WorkflowError,
};

/// B. Wie's quaternion feedback: u = -K (2 w^2 e + 2 zeta w omega_st) + omega x H - K (omega x omega_te).
#[derive(Clone, Debug)]
struct Feedback {
    bandwidth: f64,
    damping: f64,
    creep: f64,
    ticks: f64,
}

impl PhaseLaw for Feedback {
    fn torque(&mut self, body: &KnownBody, input: &LawInput, period: f64) -> [f64; 3] {
        self.ticks = if period == 0.0 { 0.0 } else { self.ticks + 1.0 };
        let [w, x, y, z] = input.q_ts;
        let error = if w < 0.0 { [-x, -y, -z] } else { [x, y, z] };
        let relative = difference(input.omega_se_s, input.omega_te_s);
        let spring = scaled(-2.0 * self.bandwidth * self.bandwidth, error);
        let wanted = sum(spring, scaled(-2.0 * self.damping * self.bandwidth, relative));
        let carried = difference(input.acceleration_te_s, cross(input.omega_se_s, input.omega_te_s));
        let ahead = sum(product(body.inertia, carried), cross(input.omega_se_s, input.momentum_s));
        let mut torque = sum(product(body.inertia, wanted), ahead);
        torque[2] += self.creep * self.ticks;
        torque
    }
}

static PARAMETERS: [LawParameter; 3] = [
    LawParameter::number("own_bandwidth_rad_s", "rad/s", "Bandwidth", Limit::Positive),
    LawParameter::number("own_damping", "1", "Damping ratio", Limit::NotNegative),
    LawParameter::number("creep_n_m", "N m", "Torque that a tick adds about s3", Limit::Finite).or(&[0.0]),
];

fn own_law() -> OwnLaw {
    OwnLaw::Phase(LawKind::new("own_feedback", &PARAMETERS, |settings| {
        let [bandwidth, damping, creep] =
            ["own_bandwidth_rad_s", "own_damping", "creep_n_m"].map(|key| settings.table.named(key).unwrap()[0]);
        Feedback { bandwidth, damping, creep, ticks: 0.0 }
    }))
}

fn with_own_law() -> String {
    let mut found = String::new();
    let mut is_own = false;
    for line in SLEW_CLOSED.lines() {
        is_own = if line.starts_with('[') { false } else { is_own || line == "law = \"quaternion_feedback\"" };
        let line = match line.split_once(" = ") {
            Some(("law", "\"quaternion_feedback\"")) => "law = \"own_feedback\"".to_owned(),
            Some((key @ ("bandwidth_rad_s" | "damping"), value)) if is_own => format!("own_{key} = {value}"),
            _ => line.to_owned(),
        };
        found += &(line + "\n");
    }
    assert_ne!(found, SLEW_CLOSED);
    found
}

/// Law: a program's law that computes a built-in one gives the same rows, bit for bit.
#[test]
fn a_law_of_a_program_flies_in_the_phases_of_a_loop() {
    let scratch = ScratchFolder::new("own-laws");
    let quiet = Quiet::default();
    let session = Session::new(&quiet).unwrap();
    let law = own_law();
    let own = session.under(&law);
    let run = |text: &str, session: Session<'_>, name: &str| {
        let campaign = Campaign::from_text("slew_closed.toml", text, session).samples(60).store(scratch.path(name));
        let results = campaign.results().unwrap();
        let columns = results.plan().request().columns();
        let of = |name: &str| results.column(name).unwrap().into_iter().map(f64::to_bits).collect::<Vec<_>>();
        columns.iter().map(|column| (column.quantity.name().to_owned(), of(column.quantity.name()))).collect::<Vec<_>>()
    };
    let built_in = run(SLEW_CLOSED, session, "built_in");
    let text = with_own_law();
    let found = run(&text, own, "own");
    assert!(found.len() > 40);
    for (expected, found) in built_in.iter().zip(&found) {
        assert!(expected == found, "{}", expected.0);
    }
    let creeping = text.replacen("own_damping", "creep_n_m = 1e-6\nown_damping", 1);
    assert_ne!(run(&creeping, own, "creeping"), found);

    let root = scratch.path("own");
    let Err(WorkflowError::Files(reason)) = Results::open(&root, session) else { panic!("refused") };
    assert_says(&reason, ["own_feedback", "quaternion_feedback"]);
    let negative = Campaign::from_text("slew_closed.toml", &text.replacen("own_damping = ", "own_damping = -", 1), own);
    let Err(WorkflowError::Input(reason)) = negative.prepare() else { panic!("refused") };
    assert_says(&reason, ["own_damping = -"]);
}
