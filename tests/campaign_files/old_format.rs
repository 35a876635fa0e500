//! Files of the format before 0.2: refused, with the new text of their tables, which a person can paste.

use spindrift::campaign::{CampaignError, Overrides, Plan};

/// The shipped campaign `burn.toml` as it was in the old format.
const OLD: &str = include_str!("data/burn_of_the_old_format.toml");
/// The same in the new format.
const NEW: &str = include_str!("../../campaigns/burn.toml");

fn refused(text: &str) -> CampaignError {
    Plan::from_text("old.toml", text, Overrides::default()).expect_err("the old format")
}

/// `text` after a person did what every message says: paste the new text of a table in its place, delete a line, write another name.
fn repaired(text: &str, error: &CampaignError) -> String {
    let mut lines: Vec<Option<String>> = text.lines().map(|line| Some(line.to_owned())).collect();
    for problem in &error.problems {
        let at = problem.line.unwrap_or_else(|| panic!("no line: {problem}")) - 1;
        if let Some(new) = problem.remedy.strip_prefix("write instead\n") {
            // the table that the line belongs to: from its header to the next
            let is_header = |line: &str| line.trim_start().starts_with('[');
            let old: Vec<&str> = text.lines().collect();
            let start = (0..=at).rev().find(|k| is_header(old[*k])).expect("a header");
            let end = (start + 1..old.len()).find(|k| is_header(old[*k])).unwrap_or(old.len());
            lines[start..end].fill(None);
            lines[start] = Some(new.to_owned());
        } else if problem.remedy.starts_with("delete this line") {
            lines[at] = None;
        } else if let Some(name) = problem.remedy.strip_prefix("write ") {
            let value = problem.value.as_deref().expect("a name");
            let line = lines[at].take().expect("a line");
            lines[at] = Some(line.replace(value, &format!("{name:?}")));
        } else {
            panic!("what to do? {problem}");
        }
    }
    lines.into_iter().flatten().map(|line| line + "\n").collect()
}

/// Law: what the messages say to paste is the same scene, and with the names that they give for parameters the same plan, as the file
/// that was converted by hand.
#[test]
fn the_pasted_text_gives_the_plan_of_the_new_file() {
    let new = Plan::from_text("burn.toml", NEW, Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    // without dispersions first: the messages about tables say everything
    let scene_of = |text: &str| text[..text.find("[[disperse]]").expect("dispersions come last")].to_owned();
    let old_scene = scene_of(OLD);
    let pasted = repaired(&old_scene, &refused(&old_scene));
    let plan = Plan::from_text("burn.toml", &pasted, Overrides::default()).unwrap_or_else(|e| panic!("{e}\n{pasted}"));
    assert_eq!(plan.nominal, new.nominal);
    let bare = Plan::from_text("burn.toml", &scene_of(NEW), Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((plan.text(), plan.hash()), (bare.text(), bare.hash()));
    // the rest of the new file fits below it
    let dispersions = &NEW[NEW.find("[[disperse]]").expect("dispersions come last")..];
    let whole = Plan::from_text("burn.toml", &format!("{pasted}\n{dispersions}"), Overrides::default());
    assert_eq!(whole.unwrap_or_else(|error| panic!("{error}")), new);
}

/// Each old table and each old key is refused at its line, once, and nothing else is said of the file.
#[test]
fn every_old_table_and_key_is_named_at_its_line() {
    let error = refused(OLD);
    let line_of = |start: &str| OLD.lines().position(|line| line.starts_with(start)).expect(start) + 1;
    let found: Vec<(usize, &str)> = error
        .problems
        .iter()
        .map(|problem| (problem.line.unwrap_or_else(|| panic!("no line: {problem}")), problem.key.as_str()))
        .collect();
    for (start, key) in [
        ("[fuselage]", "fuselage"),
        ("[wheel1]", "wheel1"),
        ("[wheel2]", "wheel2"),
        ("wheel_rates_rad_s", "initial.wheel_rates_rad_s"),
        ("thrust_n", "actuation[0].thrust_n"),
    ] {
        assert!(found.contains(&(line_of(start), key)), "{key} at {}: {found:?}", line_of(start));
    }
    let (fuselage, wheel) = (&error.problems[0], &error.problems[1]);
    assert!(
        fuselage.remedy.contains("\n[[body.parts]]\nname = \"fuselage\"\nshape = \"hollow_cylinder\"\n"),
        "{fuselage}"
    );
    assert!(wheel.remedy.contains("\n[[wheels]]\nname = \"w1\"\naxis = [0, 1, 0]\n"), "{wheel}");
    for problem in &error.problems {
        assert!(!problem.allowed.is_empty() && !problem.remedy.is_empty(), "{problem}");
    }
}

/// The old names of parameters are refused with the new ones.
#[test]
fn old_names_of_parameters_are_answered_with_new_ones() {
    let scene = NEW[..NEW.find("[[disperse]]").expect("dispersions come last")].to_owned();
    for (old, new) in [
        ("fuselage.density_kg_m3", "write body.parts.fuselage.density_kg_m3"),
        ("fuselage.mass_scale", "write body.mass_scale"),
        ("fuselage.center_offset_m.x", "write body.center_offset_m.x"),
        (
            "fuselage.thruster_offset_m",
            "write thrusters.p3.position_m.y (and -thrusters.p3.position_m.y for p2, by [[derive]])",
        ),
        ("wheel1.radius_m", "write wheels.w1.radius_m"),
        ("wheel2.station_m", "write wheels.w2.position_m.z"),
        ("wheel2.offset_m.y", "write wheels.w2.position_m.y"),
        ("wheel1.tilt_rad.z", "write wheels.w1.tilt_rad.2"),
        ("wheel2.tilt_rad.x", "write wheels.w2.tilt_rad.1"),
        ("initial.wheel_rates_rad_s[0]", "write wheels.w1.rate_rad_s"),
        ("initial.wheel_rates_rad_s.2", "write wheels.w2.rate_rad_s"),
        ("initial.wheel_angles_rad", "write wheels.w1.angle_rad and wheels.w2.angle_rad, one table each"),
        ("actuators.thruster1_tilt_rad", "write thrusters.p1.tilt_rad"),
        ("actuators.thruster2_tilt_rad.y", "write thrusters.p2.tilt_rad.2"),
        ("actuators.thrust_scale[2]", "write thrusters.p3.thrust_scale"),
        ("actuators.thrust_scale", "write thrusters.p1.thrust_scale, and so on"),
        ("actuators.torque_scale[1]", "write wheels.w2.torque_scale"),
        ("actuators.torque_bias_n_m.1", "write wheels.w1.torque_bias_n_m"),
    ] {
        let text = format!("{scene}[[disperse]]\nparameter = {old:?}\ndistribution = \"normal\"\nstd = 0.1\n");
        let error = refused(&text);
        assert_eq!(error.problems.len(), 1, "{error}");
        assert_eq!(error.problems[0].remedy, new, "{old}");
        // and the new name, where it is one, is a name of this file
        let name = new.trim_start_matches("write ");
        if !name.contains(' ') {
            Plan::from_text("new.toml", &text.replace(old, name), Overrides::default())
                .unwrap_or_else(|e| panic!("{e}"));
        }
    }
}
