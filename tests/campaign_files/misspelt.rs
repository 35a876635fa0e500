//! Every key and name, misspelt by one edit, gets the right suggestion.

use crate::prelude::*;

use crate::support::every_key::distributions;

const NOTHING: &str = "qqzzqqzz";

fn error(text: &str) -> CampaignError {
    parsed(text).expect_err(text)
}

fn edits(word: &str) -> BTreeSet<String> {
    let letters: Vec<char> = word.chars().collect();
    let mut found = BTreeSet::new();
    for at in [0, letters.len() / 2, letters.len() - 1] {
        let mut without = letters.clone();
        without.remove(at);
        let mut doubled = letters.clone();
        doubled.insert(at, letters[at]);
        let mut replaced = letters.clone();
        replaced[at] = 'q';
        let mut exchanged = letters.clone();
        exchanged.swap(at, (at + 1).min(letters.len() - 1));
        found.extend([without, doubled, replaced, exchanged].map(|letters| letters.into_iter().collect::<String>()));
    }
    found.remove(word);
    found.remove("");
    found
}

fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut table = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            if i == 0 || j == 0 {
                table[i][j] = i + j;
                continue;
            }
            let replaced = table[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(table[i - 1][j] + 1).min(table[i][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(table[i - 2][j - 2] + 1);
            }
            table[i][j] = least;
        }
    }
    table[a.len()][b.len()]
}

fn suggests(error: &CampaignError, written: &str, meant: &str, names: &[String]) -> bool {
    let is_as_near = |name: &String| distance(written, name) <= distance(written, meant);
    let right: Vec<&String> = names.iter().filter(|name| is_as_near(name)).collect();
    error.problems.iter().any(|problem| {
        // a doubled letter may make another unit, `radius_mm`: that is what was probably meant then
        let said = problem.remedy.split_once("did you mean ").or_else(|| problem.remedy.split_once("write "));
        let suggested = said.map(|(_, rest)| rest.split(',').next().unwrap_or_default().trim_matches(['?', '"']));
        suggested.is_some_and(|suggested| right.iter().any(|name| *name == suggested))
    })
}

/// Errors without the right suggestion, and the number of misspellings.
#[derive(Default)]
struct Tried(Vec<String>, usize);

impl Tried {
    fn misspell(&mut self, name: &str, names: &[String], most: usize, read: impl Fn(&str) -> CampaignError) {
        for edited in edits(name).into_iter().filter(|edited| !names.contains(edited)).take(most) {
            self.1 += 1;
            let error = read(&edited);
            if !suggests(&error, &edited, name, names) {
                self.0.push(format!("{edited} for {name}: {error}"));
            }
        }
    }

    fn has_none_wrong(&self, least: usize) {
        let Tried(wrong, tried) = self;
        assert!(wrong.is_empty(), "{} of {tried}:\n{}", wrong.len(), wrong.join("\n"));
        assert!(*tried > least, "{tried} misspellings");
    }
}

fn listed(error: &CampaignError, start: &str, end: char) -> Vec<String> {
    let message = error.problems.iter().find_map(|problem| problem.allowed.split_once(start)).map(|(_, rest)| rest);
    let names = message.map(|rest| rest.split(end).next().unwrap_or_default());
    names.unwrap_or_default().split(", ").filter(|name| !name.is_empty()).map(str::to_owned).collect()
}

fn tables() -> Vec<(String, [String; 2])> {
    let mut found = vec![("the file".to_owned(), [String::new(), EVERY_TABLE.to_owned()])];
    let mut start = 0;
    for line in EVERY_TABLE.split_inclusive('\n') {
        start += line.len();
        if line.starts_with('[') {
            found.push((line.trim().to_owned(), [EVERY_TABLE[..start].to_owned(), EVERY_TABLE[start..].to_owned()]));
        }
    }
    for (name, text) in distributions() {
        found.push((format!("distribution {name}"), [format!("{EVERY_TABLE}{text}"), String::new()]));
    }
    found
}

#[test]
fn every_misspelt_key_gets_its_suggestion() {
    if let Err(error) = parsed(EVERY_TABLE) {
        panic!("{error}");
    }
    let (mut tried, mut keys) = (Tried::default(), BTreeSet::new());
    for (table, [before, after]) in tables() {
        let with = |key: &str| format!("{before}{key} = {NOTHING:?}\n{after}");
        let unknown = error(&with(NOTHING));
        let problem = unknown.problems.iter().find(|problem| problem.key.ends_with(NOTHING));
        let problem = problem.unwrap_or_else(|| panic!("{table}: {unknown}"));
        let own = CampaignError { problems: vec![problem.clone()], more: 0, note: None, is_unreadable: false };
        let names = listed(&own, " (", ')');
        assert!(!names.is_empty(), "{table}: {problem}");
        for name in &names {
            keys.insert(format!("{table} {name}"));
            tried.misspell(name, &names, usize::MAX, |edited| {
                let mut error = error(&with(edited));
                error.problems.retain(|problem| problem.key.rsplit('.').next() == Some(edited));
                error
            });
        }
    }
    tried.has_none_wrong(2000);
    assert!(keys.len() > 200, "{} keys", keys.len());
}

const NAMED: [(&str, &str); 9] = [
    ("method = \"auto\"", "method = \"{}\""),
    ("groups = [\"effort\", \"energy_conservation\"]", "groups = [\"{}\"]"),
    ("shape = \"sphere\"", "shape = \"{}\""),
    ("mode = \"locked\"", "mode = \"{}\""),
    ("kind = \"random\"", "kind = \"{}\""),
    ("distribution = \"uniform\"", "distribution = \"{}\""),
    ("compression = \"zstd\"", "compression = \"{}\""),
    ("direction = \"falling\"", "direction = \"{}\""),
    ("which = \"last\"", "which = \"{}\""),
];

#[test]
fn every_misspelt_name_gets_its_suggestion() {
    let mut tried = Tried::default();
    for (line, pattern) in NAMED {
        assert!(EVERY_TABLE.contains(line), "{line}");
        let with = |name: &str| EVERY_TABLE.replacen(line, &pattern.replace("{}", name), 1);
        let names = listed(&error(&with(NOTHING)), "one of ", ';');
        assert!(names.len() > 1, "{line}: {}", error(&with(NOTHING)));
        for name in &names {
            tried.misspell(name, &names, usize::MAX, |edited| error(&with(edited)));
        }
    }
    tried.has_none_wrong(300);
}

#[test]
fn every_misspelt_parameter_and_observable_gets_its_suggestion() {
    let base = EVERY_TABLE.replace("groups = [\"effort\", \"energy_conservation\"]\n", "");
    let plan = planned(&base);
    let parameters: Vec<String> = Parameter::all(&plan.nominal).map(|parameter| parameter.name()).collect();
    let columns = plan.request().columns();
    let observables: Vec<String> = columns.iter().map(|column| column.quantity.name().to_owned()).collect();
    let mut tried = Tried::default();
    let lines = ["parameter = \"wheels.w1.radius_m\"", "observable = \"energy_error_max\""];
    for (line, names) in lines.into_iter().zip([parameters, observables]) {
        assert!(base.contains(line) && names.len() > 40, "{line}: {} names", names.len());
        let key = line.split(' ').next().unwrap_or_default();
        for name in &names {
            tried.misspell(name, &names, 1, |edited| error(&base.replacen(line, &format!("{key} = \"{edited}\""), 1)));
        }
    }
    tried.has_none_wrong(100);
}

const ON_AN_ORBIT: &str = "[campaign]\nname = \"o\"\nsamples = 2\nseed = 1\nduration_s = 10.0\n[body]\nmass_kg = 10\n\
         inertia_kg_m2 = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]\nincludes_wheels = false\n[initial]\nangular_velocity_rad_s \
         = [0, 0, 1]\n\
         [[wheels]]\nname = \"w\"\naxis = [0, 0, 1]\ndensity_kg_m3 = 1\nradius_m = 0.1\nlength_m = 0.1\n\
         [[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"normal\"\nstd = 0.1\n\
         [orbit]\nsemi_major_axis_m = 7e6\n";

#[test]
fn a_key_in_another_unit_gets_its_value_with_the_unit() {
    for (right, wrong, si) in [
        ("semi_major_axis_m = 7e6", "semi_major_axis_km = 7000", "semi_major_axis_m = 7000000.0"),
        ("", "inclination_deg = 90", "inclination_rad = 1.57079632679489"),
        ("", "incl_deg = 90", "inclination_rad = 1.57079632679489"),
        ("", "raan_deg = 90", "ascending_node_rad = 1.57079632679489"),
        ("", "true_anomaly_deg = 180", "true_anomaly_rad = 3.14159265358979"),
        ("", "mu_km3_s2 = 398600", "mu_m3_s2 = 398600000000000.0"),
        ("std = 0.1", "std_rpm = 30", "std = 3.14159265358979"),
        ("std = 0.1", "std_deg_s = 180", "std = 3.14159265358979"),
        ("density_kg_m3 = 1\n", "density_kg_m3 = 1\nrate_rpm = 30\n", "rate_rad_s = 3.14159265358979"),
        ("duration_s = 10.0", "duration_min = 2", "duration_s = 120.0"),
        ("duration_s = 10.0", "duration_hours = 2", "duration_s = 7200.0"),
        ("radius_m = 0.1", "radius_mm = 500", "radius_m = 0.5"),
    ] {
        let base = ON_AN_ORBIT;
        assert!(base.contains(right) && parsed(base).is_ok(), "{right}");
        let text = if right.is_empty() { base.to_owned() + wrong } else { base.replacen(right, wrong, 1) };
        let error = error(&text);
        let advice = error.problems.iter().find(|problem| problem.is_unknown);
        let advice = advice
            .and_then(|problem| problem.remedy.strip_prefix("write "))
            .unwrap_or_else(|| panic!("{wrong}: {error}"));
        let written = wrong.lines().next_back().unwrap_or_default();
        let plan = parsed(&text.replacen(written, advice, 1));
        let plan = plan.unwrap_or_else(|error| panic!("{advice}: {error}"));
        assert!(plan.text().contains(si), "{wrong}: {advice}: {}", plan.text());
    }
}
