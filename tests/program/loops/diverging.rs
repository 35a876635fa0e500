//! Unstable loops end early, with their gains and the limit.

use crate::prelude::*;
use spindrift::control::laws::{LawKind, PhaseLaw};
use spindrift::loops::OwnLaw;

use crate::loops::closed_loops::small_craft;

const PERIOD: f64 = 0.25;

fn with_law(law: &str, initial: &str) -> String {
    let target = if law.contains("rate_damping") || law.contains("brake") {
        ""
    } else {
        "target = \"attitude\"\nattitude = [0, 0, 1, 0]\n"
    };
    let control = format!(
        "[control]\nperiod_s = {PERIOD}\nwheels = [\"w1\", \"w2\", \"w3\"]\n\
         [[guidance]]\nphase = \"p\"\n{target}{law}\n"
    );
    small_craft(&control, initial).replace("tolerance = 1e-14", "tolerance = 1e-8")
}

const SLOW: &str = "angular_velocity_rad_s = [0.01, -0.02, 0.03]";
const FAST: &str = "angular_velocity_rad_s = [3.0, -2.0, 1.0]";

/// The laws with gains at `share` of their limits: c T = 2 with the least inertia of 24 kg m^2; k T = 2 c.
fn laws(share: f64) -> [(String, &'static str); 4] {
    let gain = share * 2.0 * 24.0 / PERIOD;
    let bandwidth = share / PERIOD;
    [
        (format!("law = \"rate_damping\"\ngain_n_m_s = {gain:?}"), "gain_n_m_s"),
        (
            format!("law = \"mrp_feedback\"\nstiffness_n_m = {:?}\ndamping_n_m_s = {gain:?}", 0.1 * gain),
            "damping_n_m_s",
        ),
        (format!("law = \"quaternion_feedback\"\nbandwidth_rad_s = {bandwidth:?}\ndamping = 1.0"), "bandwidth_rad_s"),
        (format!("law = \"eigenaxis\"\nbandwidth_rad_s = {bandwidth:?}\ndamping = 1.0"), "bandwidth_rad_s"),
    ]
}

/// Law: at two and at fifty times the limit a run soon ends as `diverged` with the gain and the limit.
#[test]
fn unstable_loops_end_early_and_others_do_not() {
    for method in ["auto", "dop853"] {
        let flown = |law: &str, initial: &str| {
            let text = with_law(law, initial).replace("method = \"auto\"", &format!("method = \"{method}\""));
            single(&plan(&text), 0)
        };
        for (index, (stable, _)) in laws(0.8).iter().enumerate() {
            let healthy = flown(stable, SLOW);
            assert_eq!(healthy.outcome.status, Status::Done, "{stable}: {}", healthy.reason);
            assert_eq!(flown(stable, FAST).outcome.status, Status::Done, "{stable}");
            for times in [2.0, 50.0] {
                let (law, key) = &laws(times)[index];
                let run = flown(law, SLOW);
                let work = [&run, &healthy].map(|run| run.outcome.effort.evaluations as f64);
                assert_eq!(run.outcome.status, Status::Diverged, "{law}: {}", run.reason);
                assert!(run.reason.contains(key) && run.reason.contains("the limit is"), "{}", run.reason);
                assert!(!run.reason.contains("max_steps") && run.outcome.time < 60.0);
                assert!(work[0] < 5.0 * work[1], "{law}: {work:?}");
            }
        }
    }
}

/// u = -c omega.
#[derive(Clone, Debug)]
struct Brake;

impl PhaseLaw for Brake {
    fn torque(&mut self, _: &KnownBody, input: &LawInput<'_>, _: f64) -> [f64; 3] {
        input.omega_se_s.map(|rate| -2.5 * 24.0 / PERIOD * rate)
    }
}

#[test]
fn a_law_of_a_program_can_diverge() {
    let (scratch, quiet) = (ScratchFolder::new("diverging"), Quiet::default());
    let law = OwnLaw::Phase(LawKind::new("brake", &[], |_| Brake));
    let session = Session::new(&quiet).unwrap().under(&law);
    let text = with_law("law = \"brake\"", SLOW);
    let results = Campaign::from_text("loop.toml", &text, session).store(scratch.path("r")).results().unwrap();
    let replayed = results.replay(SampleId(1)).unwrap();
    assert_eq!(replayed.outcome.status, Status::Diverged, "{}", replayed.reason);
    assert!(replayed.reason.contains("guidance.p: the loop diverges"), "{}", replayed.reason);
}
