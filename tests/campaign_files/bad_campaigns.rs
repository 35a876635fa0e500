use crate::prelude::*;
use crate::refusals::good;

fn errors(text: &str) -> CampaignError {
    match parsed(text) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => error,
    }
}

fn changed(from: &str, to: &str) -> String {
    let good = good();
    assert!(good.contains(from), "{from}");
    good.replacen(from, to, 1)
}

#[test]
fn all_errors_of_a_file_come_at_once_in_the_order_of_lines() {
    let mut text = good();
    for (from, to) in [
        ("seed = 1\n", "sede = 1\n"),
        ("1e-10", "\"fine\""),
        ("points = 11", "points = 1.5"),
        ("outer_radius_m = 1.0", "outer_radius_m = -1.0"),
        ("side_m = 0.2", "side_m = 0"),
        ("thrust_n = { p1 = 100 }", "thrust_n = { p1 = -1 }"),
        ("parameter = \"body.parts.fuselage.density_kg_m3\"", "parameter = \"initial.attitude.q\""),
        (
            "sigmas = 3",
            "sigmas = 3\n[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"normal\"\nstd = -1",
        ),
    ] {
        text = text.replacen(from, to, 1);
    }
    let error = errors(&text);
    let found: Vec<(Option<usize>, &str)> = error.problems.iter().map(|p| (p.line, p.key.as_str())).collect();
    assert_eq!(
        found,
        [
            (Some(1), "campaign.seed"),
            (Some(4), "campaign.sede"),
            (Some(8), "integrator.tolerance"),
            (Some(10), "observe.points"),
            (Some(15), "body.parts.fuselage.outer_radius_m"),
            (Some(28), "debris.side_m"),
            (Some(40), "actuation[0].thrust_n.p1"),
            (Some(42), "disperse[0].parameter"),
            (Some(49), "disperse[1].std"),
        ],
        "{error}"
    );
    assert_eq!(error.to_string().lines().count(), found.len());
}

#[test]
fn an_empty_file_asks_for_its_tables() {
    let error = errors("");
    let keys: Vec<&str> = error.problems.iter().map(|p| p.key.as_str()).collect();
    assert_eq!(keys, ["campaign", "body"], "{error}");
    for p in &error.problems {
        assert!(p.line.is_none() && p.value.is_none(), "{}: line {:?}, value {:?}", p.key, p.line, p.value);
    }
}

#[test]
fn a_file_that_is_not_there_is_said_to_be_so() {
    let error = Plan::load(std::path::Path::new("no/such.toml"), Overrides::default()).expect_err("no such file");
    assert!(error.to_string().starts_with("no/such.toml: file = "), "{error}");
}

#[test]
fn a_syntax_error_is_told_alone() {
    let good = good();
    let line_of =
        |what: &str| good.lines().position(|line| line.contains(what)).unwrap_or_else(|| panic!("{what}")) + 1;
    for (from, to, line, marked, remedy) in [
        (
            "samples = 10",
            "samples = = 10",
            line_of("samples = 10"),
            "    | samples = = 10\n    |           ^",
            "fix this line",
        ),
        ("seed = 1", "seed = 1.0.3", line_of("seed = 1"), "    | seed = 1.0.3\n", "fix this line"),
        ("name = \"bad\"", "name = t", line_of("name = \"bad\""), "    | name = t\n", "text is written in quotes"),
        ("name = \"bad\"", "name = nominal", line_of("name = \"bad\""), "    | name = nominal\n", "written in quotes"),
        ("name = \"bad\"", "name = bad", line_of("name = \"bad\""), "    | name = bad\n", "written in quotes"),
        ("[initial]", "[initial", line_of("[initial]"), "    | [initial\n", "fix this line"),
        (
            "axis = [0, 1, 0]",
            "axis = [0, 1, 0",
            line_of("axis = [0, 1, 0]") + 1,
            "    | ^",
            "close with ] the array that begins here or above",
        ),
    ] {
        let error = errors(&changed(from, to).replace("duration_s = ", "duration_s = -"));
        let said = error.with_excerpts();
        assert_eq!((error.problems.len(), error.more, error.problems[0].line), (1, 0, Some(line)), "{said}");
        assert!(said.contains("must be valid TOML (") && said.contains(remedy) && said.contains(marked), "{said}");
        assert!(said.lines().count() == 3 && !said.contains("is this a campaign file"), "{said}");
    }
    let said = errors("0.5,0.25\n0.5,0.25\n").to_string();
    assert!(said.lines().count() == 2 && said.ends_with("is this a campaign file?"), "{said}");
}
