//! The generated tables of the documents are those of the source.
//!
//! `SPINDRIFT_WRITE_DOCS=1 cargo test --release --test project` writes them again.

use crate::support::prelude::*;
use std::fmt::Write as _;

use spindrift::campaign::scene::TABLES;
use spindrift::campaign::{draws, failure_tables, settings};
use spindrift::dynamics::effects::Effect;
use spindrift::ensemble::plausibility::looked::digits;
use spindrift::ensemble::plausibility::{rule::Limit, rules::RULES};
use spindrift::observables::band_series::band_series;
use spindrift::observables::request::wheel_names;
use spindrift::observables::{LawColumns, LawSeries, table};
use spindrift::sampling::DistributionKind;
use spindrift::sampling::keys::{Kind, Presence, Rule};
use spindrift::scene::LawParameter;
use spindrift::scene::table::Table;
use spindrift::storage::rows_file::{columns, parameter_columns};
use spindrift::storage::timeseries::time_series;
use spindrift::table::Column;

/// If this variable is set, the tables are written and not compared.
const WRITE: &str = "SPINDRIFT_WRITE_DOCS";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

fn text(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

fn plan(name: &str) -> Plan {
    Plan::load(&root().join("campaigns").join(name), Overrides::default()).unwrap()
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

fn columns_of_rows() -> String {
    let mut table = String::new();
    let mut section = |title: &str, rows: &[[String; 4]]| {
        let _ = writeln!(table, "<details><summary>{title} ({})</summary>\n", rows.len());
        let _ = writeln!(table, "| column | unit | what it is | only |\n| --- | --- | --- | --- |");
        for [name, unit, meaning, only] in rows {
            let _ = writeln!(table, "| `{name}` | {unit} | {} | {only} |", cell(meaning));
        }
        let _ = writeln!(table, "\n</details>\n");
    };
    let plan = plan("spin_sweep.toml");
    let all = columns(&Ensemble::new(&plan, Isa::best()));
    let row = |column: &Column| {
        let quantity = &column.quantity;
        [quantity.name(), quantity.unit(), quantity.meaning(), ""].map(str::to_owned)
    };
    let dispersed: Vec<[String; 4]> = parameter_columns(&plan).map(|column| row(&column)).collect();
    let own: Vec<[String; 4]> = all.iter().map(row).take_while(|row| dispersed.first() != Some(row)).collect();
    section("the sample", &own);
    section("dispersed values, here those of <code>spin_sweep.toml</code>", &dispersed);
    for group in Group::ALL {
        let of_group = table::all().filter(|column| column.group == group);
        let rows: Vec<_> = of_group
            .map(|column| {
                let quantity = &column.quantity;
                [quantity.name(), quantity.unit(), quantity.meaning(), column.scenes()].map(str::to_owned)
            })
            .collect();
        section(&format!("group <code>{}</code>", group.name()), &rows);
    }
    table
}

fn columns_of_series() -> String {
    let plan = plan("burn.toml");
    let isa = Isa::best();
    let run = SingleRun::new(&plan, SampleId(0), plan.grid.clone(), isa).unwrap();
    let series = time_series(SampleId(0), &run, |_| true);
    let names: Vec<String> = series.columns.iter().map(|column| format!("`{}`", column.quantity.name())).collect();
    format!("{}.\n", names.join(", "))
}

fn quantities_over_time() -> String {
    let request = Request {
        groups: Groups::ALL,
        debris: true,
        actuated: Actuated::ALL,
        effects: Effect::ALL.into_iter().fold(ForceModel::NONE, ForceModel::with),
        constrained: false,
        wheels: wheel_names(&["w1"]),
        nutation_axis: spindrift::observables::request::NutationAxis::SpinAxis,
        of_law: LawColumns { over_time: LawSeries::ALL, ..LawColumns::NONE },
        windows: spindrift::observables::window::NO_WINDOWS,
    };
    let mut table = String::from("| series | unit | what it is |\n| --- | --- | --- |\n");
    for band in band_series(&request) {
        let quantity = &band.quantity;
        let _ = writeln!(table, "| `{}` | {} | {} |", quantity.name(), quantity.unit(), cell(quantity.meaning()));
    }
    table
}

fn rules() -> String {
    let mut table = String::from("| looked at | noted | because | usual |\n| --- | --- | --- | --- |\n");
    for rule in RULES {
        let (sign, limit) = match rule.limit {
            Limit::From(limit) => (">=", limit),
            Limit::Below(limit) => ("<", limit),
        };
        let (unit, factor) = if rule.known.0.is_empty() { (rule.unit, 1.0) } else { rule.known };
        let unit = if unit == "1" { "" } else { unit };
        let noted =
            if limit == 0.0 { "always".to_owned() } else { format!("{sign} {} {unit}", digits(limit * factor)) };
        let cells = [rule.subject, noted.trim_end(), rule.source, rule.usual].map(cell);
        let _ = writeln!(table, "| {} |", cells.join(" | "));
    }
    table
}

/// Dependencies with their comments in the list of all packages.
fn dependencies() -> String {
    let mut table = String::from("| crate | version | why | where |\n| --- | --- | --- | --- |\n");
    let listed = listed_dependencies();
    let [program, kernels, figures, python, benches] = [
        "Cargo.toml",
        "crates/kernels/Cargo.toml",
        "crates/figures/Cargo.toml",
        "crates/python/Cargo.toml",
        "benches/Cargo.toml",
    ]
    .map(manifest);
    let mut of_program = program["dependencies"].as_table().unwrap().clone();
    of_program.extend(kernels["dependencies"].as_table().unwrap().clone());
    let places = [
        (&toml::Value::Table(of_program), "program"),
        (&program["target"]["cfg(unix)"]["dependencies"], "program, on Unix"),
        (&program["build-dependencies"], "build of the program"),
        (&figures["dependencies"], "program with figures"),
        (&python["dependencies"], "Python package"),
        (&program["dev-dependencies"], "tests"),
        (&benches["dependencies"], "benches"),
    ];
    let own = |name: &str| ["spindrift", "spindrift-figures"].contains(&name);
    let mut named = BTreeSet::new();
    for (dependencies, place) in places {
        for name in dependencies.as_table().unwrap().keys().filter(|name| !own(name)) {
            if named.insert(name) {
                let (version, why) = &listed[name];
                let _ = writeln!(table, "| {name} | {version} | {} | {place} |", cell(why));
            }
        }
    }
    let unused: Vec<&String> = listed.keys().filter(|name| !named.contains(name) && !own(name)).collect();
    assert!(unused.is_empty(), "no package uses {unused:?}");
    table
}

fn listed_dependencies() -> BTreeMap<String, (String, String)> {
    let text = text("Cargo.toml");
    let (_, list) = text.split_once("\n[workspace.dependencies]\n").unwrap();
    let (mut listed, mut why) = (BTreeMap::new(), Vec::new());
    for line in list.lines().take_while(|line| !line.starts_with('[')) {
        if let Some(comment) = line.strip_prefix("# ") {
            why.push(comment);
        } else if let Some((name, value)) = line.split_once(" = ") {
            assert!(!why.is_empty(), "Cargo.toml does not say why there is {name}");
            let value: toml::Value = format!("v = {value}").parse::<toml::Table>().unwrap()["v"].clone();
            let version = value.get("version").unwrap_or(&value).as_str().unwrap().to_owned();
            listed.insert(name.to_owned(), (version, std::mem::take(&mut why).join(" ")));
        }
    }
    listed
}

fn manifest(file: &str) -> toml::Table {
    text(file).parse().unwrap_or_else(|error| panic!("{file}: {error}"))
}

fn parameters() -> String {
    let mut text = String::new();
    let mut last = "";
    for table in Table::ALL {
        // the errors of a table are keys of it too
        if table.header() != last {
            let header = header(*table);
            let newline = if last.is_empty() { "" } else { "\n" };
            let _ = writeln!(text, "{newline}## `{header}`\n");
            let _ = writeln!(
                text,
                "| key | unit | components | default | limit | meaning |\n| --- | --- | --- | --- | --- | --- |"
            );
            last = table.header();
        }
        for key in table.keys() {
            let facts = key.facts();
            let default = match facts.required {
                Some(_) => "required".to_owned(),
                None => key.default_text().map_or("none".to_owned(), |text| format!("`{text}`")),
            };
            let (components, limit, meaning) = (facts.components.join(", "), facts.limit.words(), cell(facts.meaning));
            let _ =
                writeln!(text, "| `{}` | {} | {components} | {default} | {limit} | {meaning} |", facts.key, facts.unit);
        }
    }
    text
}

fn keys_of_loops() -> String {
    use spindrift::control::{actuators::modulation, estimators, laws, net_launch, parameters, sensors};
    let mut lists: Vec<(String, &[LawParameter])> =
        vec![("`[control]`".into(), &parameters::LOOP), ("`[control]` with thrusters".into(), &parameters::THRUSTERS)];
    for (place, name) in modulation::NAMES.iter().enumerate() {
        lists.push((format!("`[control]`, `modulation = \"{name}\"`"), modulation::parameters(place)));
    }
    lists.push(("`[control]` with debris".into(), &net_launch::parameters::DEBRIS));
    let named = |table: &str, key: &str, name: &str| format!("`{table}`, `{key} = \"{name}\"`");
    lists.extend(estimators::KINDS.iter().map(|kind| (named("[control]", "estimator", kind.name), kind.parameters)));
    lists.extend(sensors::KINDS.iter().map(|kind| (named("[[sensors]]", "kind", kind.name), kind.parameters)));
    lists.extend(laws::KINDS.iter().map(|kind| (named("[[guidance]]", "law", kind.name), kind.parameters)));
    lists.push(("`[[guidance]]`".into(), &parameters::PHASE));
    lists.push(("`[[guidance]]` with `until`".into(), &parameters::CONDITION));
    lists.push(("`[[guidance]]` with thrusters".into(), &laws::momentum_unloading::UNLOADING));
    for (name, of) in laws::rod_law::ROD_LAWS {
        lists.push((named("[[guidance]]", "rods", name), of.parameters()));
    }
    lists.push(("`[[guidance]]`, target or thrust \"transfer\"".into(), &net_launch::parameters::TRANSFER));
    lists.push(("`[[guidance]]`, `target = \"attitude\"`".into(), &parameters::ATTITUDE));
    let mut text = String::from("| table | key | unit | default | meaning |\n| --- | --- | --- | --- | --- |\n");
    for (table, list) in lists {
        for parameter in list {
            let facts = &parameter.facts;
            let default = match parameter.default {
                None => "required".to_owned(),
                Some([number]) => format!("`{number:?}`"),
                Some(numbers) => format!("`{numbers:?}`"),
            };
            let _ =
                writeln!(text, "| {table} | `{}` | {} | {default} | {} |", facts.key, facts.unit, cell(facts.meaning));
        }
    }
    text
}

fn keys_of_tables() -> String {
    let mut text = String::from(
        "| table | key | value | unit | default | limit | meaning |\n| --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let kinds = DistributionKind::ALL.iter().map(|kind| {
        (format!("`[[disperse]]`, `distribution = \"{}\"`", kind.name()), kind.keys().to_vec(), kind.rules())
    });
    let designs = Design::NAMES.iter().map(|name| {
        let (rows, rules) = Design::keys_of(name).unwrap();
        (format!("`[design]`, `kind = \"{name}\"`"), rows.to_vec(), rules)
    });
    let settings = settings::HEAD
        .iter()
        .chain(&settings::TAIL)
        .map(|(header, keys)| (format!("`[{header}]`"), keys.to_vec(), &[][..]));
    let of_scene = TABLES.iter().chain([&failure_tables::TABLE]).map(|table| {
        let rows = table.fields.into_iter().flatten().map(|field| field.row).collect();
        (format!("`{}`", header(table.numbers[0])), rows, &[][..])
    });
    let draws = [("`[[correlate]]`", &draws::CORRELATE[..]), ("`[[derive]]`", &draws::DERIVE)]
        .map(|(table, keys)| (table.to_owned(), keys.to_vec(), &[][..]));
    let loops = settings::LOOPS.iter().map(|(table, keys, rules)| (format!("`{table}`"), keys.to_vec(), *rules));
    let analysis = settings::ANALYSIS.iter().map(|(table, keys, rules)| (format!("`{table}`"), keys.to_vec(), *rules));
    for (table, rows, rules) in
        settings.chain(of_scene).chain(loops).chain(kinds).chain(designs).chain(draws).chain(analysis)
    {
        for row in &rows {
            let is_of =
                |rule: &&Rule| matches!(rule, Rule::One(ways, ..) if ways.iter().any(|way| way.contains(&row.key)));
            let one = rules.iter().find(is_of).map(|rule| match rule {
                Rule::One(ways, ..) => {
                    ways.iter().map(|way| format!("`{}`", way.join("`, `"))).collect::<Vec<_>>().join(" or ")
                }
                _ => String::new(),
            });
            let default = match (row.presence, one) {
                (Presence::Required { .. }, _) => "required".to_owned(),
                (Presence::Or(number), _) => format!("`{number:?}`"),
                (Presence::OrNominal, _) => "the nominal value".to_owned(),
                (Presence::Optional, one) => one.unwrap_or_default(),
            };
            let (value, unit) = match row.kind {
                Kind::Amounts => ("one number, or one for each component".to_owned(), "of the parameter"),
                Kind::Values => ("one number, or one for each component".to_owned(), ""),
                Kind::AmountList => ("an array of numbers".to_owned(), "of the parameter"),
                Kind::List => ("an array of numbers".to_owned(), ""),
                Kind::Number => ("a number".to_owned(), ""),
                Kind::Amount => ("a number".to_owned(), "of the observable or quantity"),
                Kind::Numbers(limit) => (limit.allowed.to_owned(), ""),
                Kind::Observable => ("the name of an observable".to_owned(), ""),
                Kind::Observables => ("an array of names of observables".to_owned(), ""),
                Kind::Band => ("the name of a quantity over time".to_owned(), ""),
                Kind::Expression => ("an expression".to_owned(), ""),
                Kind::Flag => ("`true` or `false`".to_owned(), ""),
                Kind::Yes => ("`true`".to_owned(), ""),
                Kind::Units => ("an array of units".to_owned(), ""),
                Kind::UnitsByName => ("a table of units by name".to_owned(), ""),
                Kind::Vector => ("three numbers".to_owned(), ""),
                Kind::Matrix => ("three rows of three numbers".to_owned(), ""),
                Kind::Count([least, most]) => (format!("a whole number from {least} to {most}"), ""),
                Kind::Samples(_) => ("ascending whole numbers".to_owned(), ""),
                Kind::Text(limit) => (limit.allowed.to_owned(), ""),
                Kind::Words(words, _) => (format!("an array of `\"{}\"`", words.join("\"`, `\"")), ""),
                Kind::Counts(_) => ("whole numbers above zero".to_owned(), ""),
                Kind::Word(words) | Kind::WordOrDirection(words) => {
                    let is_required = matches!(row.presence, Presence::Required { .. });
                    let mark = if is_required { "\"`" } else { "\"` (default)" };
                    (format!("`\"{}\"`", words.join("\"`, `\"")).replacen("\"`", mark, 1), "")
                }
                Kind::Correlations => ("a number, or a row of numbers for each parameter".to_owned(), ""),
                Kind::ByName => ("a table of numbers by name".to_owned(), ""),
                Kind::Name => ("a name of this file".to_owned(), ""),
                Kind::Parameter => ("text".to_owned(), ""),
                Kind::Names | Kind::Parameters => ("an array of names of this file".to_owned(), ""),
                Kind::OneOf(words) => (format!("`\"{}\"`", words().join("\"`, `\"")), ""),
                Kind::Distribution => ("a table with a distribution of one number".to_owned(), ""),
                Kind::Column | Kind::Columns => ("the path of a file".to_owned(), ""),
            };
            let limit = row.limit.map_or("", |limit| limit.allowed);
            let meaning = cell(row.meaning);
            let _ = writeln!(text, "| {table} | `{}` | {value} | {unit} | {default} | {limit} | {meaning} |", row.key);
        }
    }
    text
}

fn quantities_of_conditions() -> String {
    let mut text = String::from("| name | meaning | only |\n| --- | --- | --- |\n");
    for quantity in &spindrift::control::guidance::condition::QUANTITIES {
        let only = if quantity.needs_debris { "with debris" } else { "" };
        let _ = writeln!(text, "| `{}` | {} | {only} |", quantity.name, cell(quantity.meaning));
    }
    text
}

fn columns_of_loops() -> String {
    let plan = plan("net_launch.toml");
    let mut text = String::from("| column | unit | what it is |\n| --- | --- | --- |\n");
    for column in plan.request().columns().iter().filter(|column| column.group == Group::Control) {
        let quantity = &column.quantity;
        let _ = writeln!(text, "| `{}` | {} | {} |", quantity.name(), quantity.unit(), cell(quantity.meaning()));
    }
    text
}

fn header(table: Table) -> String {
    let is_list = table.owners(&SceneInput::blank()).is_empty();
    if is_list { format!("[[{}]]", table.header()) } else { format!("[{}]", table.header()) }
}

fn replaced(document: &str, name: &str, table: &str) -> String {
    let (begin, end) = (format!("<!-- generated: {name} -->\n"), format!("<!-- end of {name} -->"));
    let from = document.find(&begin).unwrap_or_else(|| panic!("the document has no {begin}")) + begin.len();
    let to = from + document[from..].find(&end).unwrap_or_else(|| panic!("the document has no {end}"));
    format!("{}\n{}\n{}", &document[..from], table.trim_end(), &document[to..])
}

#[test]
fn the_generated_tables_are_up_to_date() {
    let columns = [("columns", columns_of_rows()), ("series", columns_of_series()), ("bands", quantities_over_time())];
    let dependencies = [("dependencies", dependencies())];
    let parameters = [("parameters", parameters()), ("other keys", keys_of_tables())];
    let loops = [
        ("keys of loops", keys_of_loops()),
        ("quantities", quantities_of_conditions()),
        ("columns of loops", columns_of_loops()),
    ];
    for (file, tables) in [
        ("docs/campaign-files.md", &[("rules", rules())][..]),
        ("docs/control.md", &loops[..]),
        ("docs/columns.md", &columns[..]),
        ("ARCHITECTURE.md", &dependencies[..]),
        ("docs/parameters.md", &parameters[..]),
    ] {
        let written = text(file);
        let fresh = tables.iter().fold(written.clone(), |document, (name, table)| replaced(&document, name, table));
        if std::env::var_os(WRITE).is_some() {
            std::fs::write(root().join(file), fresh).unwrap_or_else(|error| panic!("{file}: {error}"));
        } else {
            assert!(fresh == written, "{file} is out of date: {WRITE}=1 cargo test --release --test project");
        }
    }
}
