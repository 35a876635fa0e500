use crate::prelude::*;

use super::loops::{LOOP, plan};

fn cases() -> Vec<[String; 4]> {
    let lines = include_str!("loop_notes.txt").lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| {
            let fields: Vec<String> = line.split(" => ").map(|field| field.replace("\\n", "\n")).collect();
            fields.try_into().unwrap_or_else(|_| panic!("four fields: {line}"))
        })
        .collect()
}

#[test]
fn each_note_has_a_file_that_gets_it_and_a_neighbour_that_does_not() {
    assert_eq!(plan(LOOP).notes(), [""; 0]);
    for [from, wrong, says, right] in cases() {
        assert_eq!(LOOP.matches(&from).count(), 1, "{from}");
        let found = plan(&LOOP.replacen(&from, &wrong, 1)).notes();
        let notes: Vec<&str> = says.split(" | ").collect();
        let is_said = |text: &&str| text.split(" || ").all(|part| found.iter().any(|note| note.contains(part)));
        assert!(notes.iter().all(is_said) && found.len() == notes.len(), "{wrong}: {found:#?}");
        let neighbour = plan(&LOOP.replacen(&from, &right, 1)).notes();
        assert!(neighbour.is_empty(), "{right}: {neighbour:#?}");
    }
}

#[test]
fn the_tolerance_of_plates_is_the_one_down_to_which_estimates_cover() {
    let cases = cases();
    let [_, drag, ..] = cases.iter().find(|[_, wrong, ..]| wrong.contains("tolerance = 1e-13")).unwrap();
    for tolerance in ["tolerance = 1e-12", ""] {
        let found = plan(&LOOP.replacen("[initial]", &drag.replace("tolerance = 1e-13", tolerance), 1));
        assert_eq!(found.tolerance.relative, 1e-12);
        assert!(found.notes().iter().all(|note| !note.contains("rounding")), "{:?}", found.notes());
    }
}

#[test]
fn keys_without_effect_are_not_in_the_plan() {
    let settings = vec![("control.estimator".to_owned(), "perfect".to_owned())];
    let tried = Plan::from_text("loop.toml", LOOP, Overrides { settings, ..Overrides::default() }).unwrap();
    assert_eq!(tried.notes().len(), 1);
    assert!(!tried.text().contains("initial_attitude_sigma_rad"));
    let removed = LOOP.replacen("initial_attitude_sigma_rad = 0.1\n", "", 1).replacen("\"mekf\"", "\"perfect\"", 1);
    assert_eq!(plan(&removed).hash(), tried.hash());
    assert!(plan(&tried.text()).notes().is_empty());
    let misspelt = LOOP.replacen("initial_attitude_sigma_rad", "initial_attitude_sigma", 1);
    assert!(parsed(&misspelt).is_err());
}

/// Law: a key of `[environment]` without effect is noted and changes nothing; a dispersion on it is refused.
#[test]
fn keys_of_effects_that_do_not_act_change_nothing() {
    let orbit = "[orbit]\nsemi_major_axis_m = 7e6\n[initial]";
    let without = plan(&LOOP.replacen("[initial]", orbit, 1));
    for (key, value, setting) in [
        ("density_scale", "2.0", "environment.drag = true"),
        ("solar_pressure_n_m2", "1e-5", "environment.solar_pressure = true"),
        ("shadow", "\"cylinder\"", "environment.solar_pressure = true"),
        ("area_scale", "3.0", "environment.drag = true or solar_pressure = true"),
    ] {
        let text = LOOP.replacen("[initial]", &format!("[environment]\n{key} = {value}\n{orbit}"), 1);
        let found = plan(&text);
        assert_eq!((found.text(), found.request()), (without.text(), without.request()), "{key}");
        let notes = found.notes();
        assert!(notes.len() == 1 && notes[0].contains(key) && notes[0].ends_with(setting), "{notes:?}");
        if key != "shadow" {
            let table = format!("[[disperse]]\nparameter = \"environment.{key}\"\ndistribution = \"normal\"\n");
            let dispersed = format!("{text}\n{table}relative_std = 0.1\n");
            let error = parsed(&dispersed).expect_err(key);
            assert!(error.to_string().contains(setting), "{error}");
        }
    }
}
