//! The generated tables of the documents are those of the source.
//!
//! `SPINDRIFT_WRITE_DOCS=1 cargo test --release --test project` writes them again.

use crate::prelude::*;
use std::fmt::Write as _;

use spindrift::{
    Quantity,
    campaign::{draws, failure_tables, scene::TABLES, settings},
    ensemble::plausibility::{
        looked::digits,
        rule::{Limit, Rule as PlausibilityRule},
        rules::RULES,
    },
    loops::condition::{GuidanceQuantity, QUANTITIES},
    observables::{LawColumns, LawSeries, band_series::band_series, request::wheel_names, table},
    sampling::keys::{Kind, Presence, Rule},
    scene::{LawParameter, table::Table},
    storage::{
        rows_file::{columns, parameter_columns},
        timeseries::time_series,
    },
    table::Column,
};

/// If this variable is set, the tables are written and not compared.
const WRITE: &str = "SPINDRIFT_WRITE_DOCS";

fn text(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

fn plan(name: &str) -> Plan {
    Plan::load(&root().join("campaigns").join(name), Overrides::default()).unwrap()
}

/// A table of Markdown.
fn markdown<const N: usize>(heads: [&str; N], rows: impl IntoIterator<Item = [String; N]>) -> String {
    let line = |cells: [String; N]| format!("| {} |\n", cells.map(|cell| cell.replace('|', "\\|")).join(" | "));
    let head = line(heads.map(str::to_owned)) + &line(from_fn(|_| "---".to_owned()));
    rows.into_iter().fold(head, |table, row| table + &line(row))
}

fn code(text: &str) -> String {
    format!("`{text}`")
}

fn unit_and_meaning(quantity: &Quantity) -> [String; 3] {
    [code(quantity.name()), quantity.unit().to_owned(), quantity.meaning().to_owned()]
}

fn columns_of_rows() -> String {
    let mut table = String::new();
    let mut section = |title: &str, rows: &[[String; 4]]| {
        let columns = markdown(["column", "unit", "what it is", "only"], rows.iter().cloned());
        let _ = writeln!(table, "<details><summary>{title} ({})</summary>\n\n{columns}\n</details>\n", rows.len());
    };
    let plan = plan("spin_sweep.toml");
    let all = columns(&Ensemble::new(&plan, Isa::best()));
    let only = |quantity: &Quantity, scenes: &str| {
        let [name, unit, meaning] = unit_and_meaning(quantity);
        [name, unit, meaning, scenes.to_owned()]
    };
    let row = |column: &Column| only(&column.quantity, "");
    let dispersed: Vec<[String; 4]> = parameter_columns(&plan).map(|column| row(&column)).collect();
    let own: Vec<[String; 4]> = all.iter().map(row).take_while(|row| dispersed.first() != Some(row)).collect();
    section("the sample", &own);
    section("dispersed values, here those of <code>spin_sweep.toml</code>", &dispersed);
    for group in Group::ALL {
        let of_group = table::all().filter(|column| column.group == group);
        let rows: Vec<_> = of_group.map(|column| only(&column.quantity, column.scenes())).collect();
        section(&format!("group <code>{}</code>", group.name()), &rows);
    }
    table
}

fn columns_of_series() -> String {
    let plan = plan("burn.toml");
    let series = time_series(SampleId(0), &single(&plan, 0), |_| true);
    let names: Vec<String> = series.columns.iter().map(|column| code(column.quantity.name())).collect();
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
    let bands = band_series(&request);
    markdown(["series", "unit", "what it is"], bands.iter().map(|band| unit_and_meaning(&band.quantity)))
}

fn rules() -> String {
    let row = |rule: &PlausibilityRule| {
        let (sign, limit) = match rule.limit {
            Limit::From(limit) => (">=", limit),
            Limit::Below(limit) => ("<", limit),
        };
        let (unit, factor) = if rule.known.0.is_empty() { (rule.unit, 1.0) } else { rule.known };
        let unit = if unit == "1" { "" } else { unit };
        let noted =
            if limit == 0.0 { "always".to_owned() } else { format!("{sign} {} {unit}", digits(limit * factor)) };
        [rule.subject, noted.trim_end(), rule.source, rule.usual].map(str::to_owned)
    };
    markdown(["looked at", "noted", "because", "usual"], RULES.iter().map(row))
}

/// Dependencies with their comments in the list of all packages.
fn dependencies() -> String {
    let mut rows = Vec::new();
    let listed = listed_dependencies();
    let [program, figures, python, benches] =
        ["Cargo.toml", "crates/figures/Cargo.toml", "crates/python/Cargo.toml", "benches/Cargo.toml"].map(manifest);
    let mut of_program = program["dependencies"].as_table().unwrap().clone();
    for name in ["kernels", "plan", "control", "ensemble", "report"] {
        of_program.extend(manifest(&format!("crates/{name}/Cargo.toml"))["dependencies"].as_table().unwrap().clone());
    }
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
                rows.push([name, version, why, place].map(str::to_owned));
            }
        }
    }
    let unused: Vec<&String> = listed.keys().filter(|name| !named.contains(name) && !own(name)).collect();
    assert!(unused.is_empty(), "no package uses {unused:?}");
    markdown(["crate", "version", "why", "where"], rows)
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
            let (components, limit, meaning) =
                (facts.components.join(", "), facts.limit.words(), facts.meaning.replace('|', "\\|"));
            let _ =
                writeln!(text, "| `{}` | {} | {components} | {default} | {limit} | {meaning} |", facts.key, facts.unit);
        }
    }
    text
}

fn keys_of_loops() -> String {
    use spindrift::control::{actuators::modulation, estimators, laws, parameters, sensors};
    use spindrift::loops::{launch_numbers, rod_law};
    let mut lists: Vec<(String, &[LawParameter])> =
        vec![("`[control]`".into(), &parameters::LOOP), ("`[control]` with thrusters".into(), &parameters::THRUSTERS)];
    for (place, name) in modulation::NAMES.iter().enumerate() {
        lists.push((format!("`[control]`, `modulation = \"{name}\"`"), modulation::parameters(place)));
    }
    lists.push(("`[control]` with debris".into(), &launch_numbers::DEBRIS));
    let named = |table: &str, key: &str, name: &str| format!("`{table}`, `{key} = \"{name}\"`");
    lists.extend(
        estimators::KINDS
            .iter()
            .map(|maker| &maker.kind)
            .map(|kind| (named("[control]", "estimator", kind.name), kind.parameters)),
    );
    lists.extend(
        sensors::KINDS
            .iter()
            .map(|maker| &maker.kind)
            .map(|kind| (named("[[sensors]]", "kind", kind.name), kind.parameters)),
    );
    lists.extend(laws::KINDS.iter().map(|kind| (named("[[guidance]]", "law", kind.name), kind.parameters)));
    lists.push(("`[[guidance]]`".into(), &parameters::PHASE));
    lists.push(("`[[guidance]]` with `until`".into(), &parameters::CONDITION));
    lists.push(("`[[guidance]]` with thrusters".into(), &laws::momentum_unloading::UNLOADING));
    for (name, of) in rod_law::ROD_LAWS {
        lists.push((named("[[guidance]]", "rods", name), of.parameters()));
    }
    lists.push(("`[[guidance]]`, target or thrust \"transfer\"".into(), &launch_numbers::TRANSFER));
    lists.push(("`[[guidance]]`, `target = \"attitude\"`".into(), &parameters::ATTITUDE));
    let row = |(table, parameter): (&String, &LawParameter)| {
        let facts = &parameter.facts;
        let default = match parameter.default {
            None => "required".to_owned(),
            Some([number]) => format!("`{number:?}`"),
            Some(numbers) => format!("`{numbers:?}`"),
        };
        [table.clone(), code(facts.key), facts.unit.to_owned(), default, facts.meaning.to_owned()]
    };
    let rows = lists.iter().flat_map(|(table, list)| list.iter().map(move |parameter| row((table, parameter))));
    markdown(["table", "key", "unit", "default", "meaning"], rows)
}

fn keys_of_tables() -> String {
    let mut all = Vec::new();
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
    let loops = spindrift::control::tables::TABLES
        .iter()
        .map(|(table, keys, rules)| (format!("`{table}`"), keys.to_vec(), *rules));
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
                Kind::Amounts => ("one number, or one for each component".into(), "of the parameter"),
                Kind::Values => ("one number, or one for each component".into(), ""),
                Kind::AmountList => ("an array of numbers".into(), "of the parameter"),
                Kind::List => ("an array of numbers".into(), ""),
                Kind::Number => ("a number".into(), ""),
                Kind::Amount => ("a number".into(), "of the observable or quantity"),
                Kind::Numbers(limit) => (limit.allowed.to_owned(), ""),
                Kind::Observable => ("the name of an observable".into(), ""),
                Kind::Observables => ("an array of names of observables".into(), ""),
                Kind::Band => ("the name of a quantity over time".into(), ""),
                Kind::Expression => ("an expression".into(), ""),
                Kind::Flag => ("`true` or `false`".into(), ""),
                Kind::Yes => ("`true`".into(), ""),
                Kind::Units => ("an array of units".into(), ""),
                Kind::UnitsByName => ("a table of units by name".into(), ""),
                Kind::Vector => ("three numbers".into(), ""),
                Kind::Matrix => ("three rows of three numbers".into(), ""),
                Kind::Count([least, most]) => (format!("a whole number from {least} to {most}"), ""),
                Kind::Samples(_) => ("ascending whole numbers".into(), ""),
                Kind::Text(limit) => (limit.allowed.to_owned(), ""),
                Kind::Words(words, _) => (format!("an array of `\"{}\"`", words.join("\"`, `\"")), ""),
                Kind::Counts(_) => ("whole numbers above zero".into(), ""),
                Kind::Word(words) | Kind::WordOrDirection(words) => {
                    let is_required = matches!(row.presence, Presence::Required { .. });
                    let mark = if is_required { "\"`" } else { "\"` (default)" };
                    (format!("`\"{}\"`", words.join("\"`, `\"")).replacen("\"`", mark, 1), "")
                }
                Kind::Correlations => ("a number, or a row of numbers for each parameter".into(), ""),
                Kind::ByName => ("a table of numbers by name".into(), ""),
                Kind::Name => ("a name of this file".into(), ""),
                Kind::Parameter => ("text".into(), ""),
                Kind::Names | Kind::Parameters => ("an array of names of this file".into(), ""),
                Kind::OneOf(words) => (format!("`\"{}\"`", words().join("\"`, `\"")), ""),
                Kind::Distribution => ("a table with a distribution of one number".into(), ""),
                Kind::Column | Kind::Columns => ("the path of a file".into(), ""),
            };
            let limit = row.limit.map_or("", |limit| limit.allowed);
            let [unit, limit, meaning] = [unit, limit, row.meaning].map(str::to_owned);
            all.push([table.clone(), code(row.key), value, unit, default, limit, meaning]);
        }
    }
    markdown(["table", "key", "value", "unit", "default", "limit", "meaning"], all)
}

fn quantities_of_conditions() -> String {
    let row = |quantity: &GuidanceQuantity| {
        let only = if quantity.needs_debris { "with debris" } else { "" };
        [code(quantity.name), quantity.meaning.to_owned(), only.to_owned()]
    };
    markdown(["name", "meaning", "only"], QUANTITIES.iter().map(row))
}

fn columns_of_loops() -> String {
    let plan = plan("net_launch.toml");
    let columns = plan.request().columns();
    let of_loops = columns.iter().filter(|column| column.group == Group::Control);
    markdown(["column", "unit", "what it is"], of_loops.map(|column| unit_and_meaning(&column.quantity)))
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
