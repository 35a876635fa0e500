//! Variants of a campaign without copies: `--set`, and `extends`.

use crate::prelude::*;

fn shipped() -> String {
    campaign_text("spin_sweep")
}

fn set(text: &str, settings: &[(&str, &str)]) -> Result<Plan, CampaignError> {
    let settings = settings.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    Plan::from_text("sweep.toml", text, Overrides { settings, ..Overrides::default() })
}

#[test]
fn what_is_set_is_as_if_it_were_written() {
    let text = shipped();
    let written = |plan: &Plan| planned(&plan.text());
    let plain = set(&text, &[]).unwrap();
    let plan =
        set(&text, &[("campaign.duration_s", "20"), ("wheels.w1.rate_rad_s", "600 rpm"), ("audit.fraction", "0.25")])
            .unwrap();
    assert_eq!(plan.grid.duration(), 20.0);
    assert!((plan.nominal.wheels[0].rate_rad_s - 20.0 * std::f64::consts::PI).abs() < 1e-12);
    assert_eq!(plan.audit_fraction, 0.25);
    assert_ne!(plan.hash(), plain.hash());
    assert_eq!(written(&plan), Plan { description: written(&plan).description, ..plan.clone() });
    let twice =
        set(&text, &[("campaign.seed", "5"), ("campaign.seed", "6"), ("observe.groups", "[\"exchange\"]")]).unwrap();
    assert_eq!((twice.seed, twice.groups.len()), (6, 1));
}

#[test]
fn wrong_settings_are_named() {
    let text = shipped();
    let said = |settings: &[(&str, &str)]| set(&text, settings).unwrap_err().to_string();
    for (key, value, allowed) in [
        ("campaign.duration_s", "-3", "--set campaign.duration_s: campaign.duration_s = -3: must be"),
        ("campaign.duration_s", "soon", "--set campaign.duration_s: campaign.duration_s = \"soon\": must be"),
        ("wheels.w1.radius_m", "\"3 kg\"", "--set wheels.w1.radius_m: wheels.w1.radius_m = \"3 kg\""),
        ("wheels.w9.radius_m", "3", "there is no such table in [[wheels]]"),
        ("campaign.duration", "3", "did you mean duration_s?"),
        ("scene.wheels.w1.rate_rad_s", "0", "scene: not a key of a campaign file; did you mean wheels.w1.rate_rad_s?"),
        ("campain.seed", "1", "campain: not a key of a campaign file; did you mean campaign.seed?"),
        ("xyzzy", "1", "xyzzy = 1: not a key of a campaign file (body, wheels, thrusters, "),
        ("require[99].quantile", "3", "require"),
    ] {
        assert!(said(&[(key, value)]).contains(allowed), "{}", said(&[(key, value)]));
    }
    let line = 1 + text.lines().position(|line| line.starts_with("duration_s")).unwrap();
    let text = text.replace("duration_s = ", "duration_s = -");
    let both = set(&text, &[("campaign.seed", "-1")]).unwrap_err().to_string();
    assert_says(
        &both,
        [&format!("sweep.toml:{line}: campaign.duration_s = -"), "--set campaign.seed: campaign.seed = -1"],
    );
}

#[test]
fn a_file_extends_another() {
    let scratch = ScratchFolder::new("extends");
    std::fs::create_dir_all(scratch.path("bases")).unwrap();
    scratch.file("bases/sweep.toml", &shipped());
    let variant = "extends = \"bases/sweep.toml\"\n[campaign]\nname = \"longer\"\nduration_s = 33.0\n[[wheels]]\nname \
        = \"w2\"\nrate_rad_s = 7.0\n";
    scratch.file("longer.toml", variant);
    let load = |name: &str| Plan::load_with_files(&scratch.path(name), Overrides::default());
    let (plan, files) = load("longer.toml").unwrap();
    let one = set(
        &shipped(),
        &[("campaign.name", "longer"), ("campaign.duration_s", "33.0"), ("wheels.w2.rate_rad_s", "7.0")],
    )
    .unwrap();
    assert_eq!(plan.row_text(), one.row_text());
    assert_eq!((plan.name.as_str(), plan.nominal.wheels.len()), ("longer", one.nominal.wheels.len()));
    assert!(files.paths().contains(&scratch.path("bases/sweep.toml")), "{:?}", files.paths());
    let line = 1 + shipped().lines().position(|line| line.starts_with("seed")).unwrap();
    scratch.file("bases/wrong.toml", &shipped().replace("seed = ", "seed = -"));
    scratch.file("of_wrong.toml", &variant.replace("sweep", "wrong"));
    assert_says(
        load("of_wrong.toml").unwrap_err().to_string(),
        [&format!("bases/wrong.toml:{line}: campaign.seed = -")],
    );
    scratch.file("own_error.toml", &variant.replace("33.0", "-33.0"));
    assert_says(load("own_error.toml").unwrap_err().to_string(), ["own_error.toml:4: campaign.duration_s = -33.0"]);
    scratch.file("gone.toml", "extends = \"none.toml\"\n");
    assert_says(load("gone.toml").unwrap_err().to_string(), ["gone.toml:1: extends = \"none.toml\": must be"]);
    scratch.file("circle.toml", "extends = \"circle.toml\"\n");
    assert_says(load("circle.toml").unwrap_err().to_string(), ["circle"]);
}
