//! Flight code in WebAssembly modules has the rows of the built-in law of the same operations.

use crate::prelude::*;

use super::{
    assembled_module::{Assembled, INPUT, NOTHING, OUTPUT, constant, copied, list, section, size},
    whole_rows::{bits, column, own_rows, rows},
};
use spindrift::{
    control::{
        flight_code::{self, FlightCode, MOST_BYTES},
        laws::LawSettings,
    },
    loops::{estimate::Estimate, failure::Failure, sensor_spec::Readings},
    scene::DeclaredTable,
    workflow::{Verification, verify},
};

pub const CAMPAIGN: &str = include_str!("../../examples/flight_code/flight_code.toml");
pub const BUILT: [&str; 2] = ["mrp_feedback_c.wasm", "mrp_feedback_rust.wasm"];

pub fn example(file: &str) -> PathBuf {
    root().join("examples/flight_code").join(file)
}

pub const LATER: &str = "gyro_feedback.wasm";

pub fn later() -> String {
    let lines = CAMPAIGN.lines().filter(|line| !line.starts_with("integral_"));
    lines.map(|line| format!("{line}\n")).collect::<String>().replace(BUILT[0], LATER)
}

pub fn plan_in(folder: &ScratchFolder, text: &str) -> Plan {
    folder.file("campaign.toml", text);
    Plan::load(&folder.path("campaign.toml"), Overrides::default()).unwrap()
}

fn folder(name: &str) -> ScratchFolder {
    let folder = ScratchFolder::new(name);
    BUILT.iter().chain([&LATER]).for_each(|file| assert!(std::fs::copy(example(file), folder.path(file)).is_ok()));
    folder
}

fn built_in() -> String {
    CAMPAIGN.replace("law = \"module\"", "law = \"mrp_feedback\"").replace("module = \"mrp_feedback_c.wasm\"\n", "")
}

/// Law: modules from C and Rust that compute the built-in law give its rows, bit for bit.
#[test]
fn modules_have_the_bits_of_the_built_in_law() {
    let folder = folder("flight-code-bits");
    let flown = |text: &str| bits(&rows(&plan_in(&folder, text), Isa::best(), 0, 60));
    let expected = flown(&built_in());
    for file in BUILT {
        assert!(flown(&CAMPAIGN.replace(BUILT[0], file)) == expected, "{file}");
    }
}

#[test]
fn rows_are_a_run_s_own() {
    let folder = folder("flight-code-own");
    [CAMPAIGN.to_owned(), later()].iter().for_each(|text| drop(own_rows(&plan_in(&folder, text), 21)));
}

#[test]
fn results_hold_without_the_module_s_own_file() {
    results_hold(folder("flight-code-results"), CAMPAIGN, BUILT[0]);
    results_hold(folder("flight-code-later-results"), &later(), LATER);
}

fn results_hold(folder: ScratchFolder, text: &str, file: &str) {
    folder.file("campaign.toml", text);
    let quiet = Quiet::default();
    let session = || Session::new(&quiet).unwrap();
    Campaign::from_file(folder.path("campaign.toml"), session())
        .samples(100)
        .store(folder.path("one"))
        .results()
        .unwrap();
    let copies: Vec<String> =
        contents(&folder.path("one")).into_keys().filter(|name| name.ends_with(".wasm")).collect();
    let sha256 = Sha256::digest(std::fs::read(example(file)).unwrap());
    let sha256: String = sha256.iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(copies, [format!("data/{sha256}.wasm")]);

    std::fs::remove_file(folder.path(file)).unwrap();
    let root = folder.path("one");
    let results = Results::open(&root, session()).unwrap();
    assert!(results.plan().text().contains(&format!("module_sha256 = \"{sha256}\"")));
    let replayed = results.replay(SampleId(7)).unwrap();
    for (place, column) in replayed.request.columns().iter().enumerate() {
        let stored = results.column(column.quantity.name()).unwrap()[7];
        assert_eq!(replayed.row[place].to_bits(), stored.to_bits(), "{}", column.quantity.name());
    }
    let verified = verify(&session(), &root, Verification { fraction: 0.05, repair: false }).unwrap().unwrap();
    assert_eq!(verified.checked.problems, 0);
}

#[test]
fn the_module_is_part_of_the_plan() {
    let folder = folder("flight-code-plan");
    let hash = |text: &str| plan_in(&folder, text).row_hash();
    let first = hash(CAMPAIGN);
    assert_ne!(hash(&CAMPAIGN.replace(BUILT[0], BUILT[1])), first);
    let bytes = std::fs::read(example(BUILT[1])).unwrap();
    std::fs::write(folder.path(BUILT[0]), bytes).unwrap();
    assert_ne!(hash(CAMPAIGN), first);
    let wrong = format!("\nmodule_sha256 = \"{}\"\nmodule = ", "ab".repeat(32));
    folder.file("wrong.toml", &CAMPAIGN.replace("\nmodule = ", &wrong));
    let error = Plan::load(&folder.path("wrong.toml"), Overrides::default()).expect_err("another checksum");
    assert!(error.to_string().contains("control.module_sha256"), "{error}");
}

fn kept(bytes: &[u8]) -> Result<&'static FlightCode, (String, String)> {
    let sha256: String = Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    flight_code::kept(bytes, &sha256)
}

fn first_torque(
    code: &'static FlightCode,
    table: &DeclaredTable,
    times: [f64; 3],
) -> impl Fn(&KnownBody, &LawInput<'_>) -> [f64; 3] + use<> {
    let [period, delay, elapsed] = times;
    let settings = LawSettings { table, gyroscopic: false, period, delay, sample: SampleId(0) };
    let law = code.kind.make(&settings);
    move |body, input| law.clone().torque(body, input, elapsed)
}

#[test]
fn the_input_is_laid_out_as_documented() {
    let number = |place: usize| 0.25 + place as f64;
    let numbers = |first: usize| from_fn(|k| number(first + k));
    let estimate = Estimate {
        q_es: from_fn(|k| number(29 + k)),
        gyro_bias_s: numbers(33),
        r_co_e: numbers(36),
        v_co_e: numbers(39),
        wheel_rates: from_fn(|k| number(42 + k)),
        omega_se_s: [0.0; 3],
        debris: None,
    };
    let input = LawInput {
        time: number(0),
        q_ts: from_fn(|k| number(4 + k)),
        omega_se_s: numbers(8),
        omega_te_s: numbers(11),
        acceleration_te_s: numbers(14),
        momentum_s: numbers(17),
        estimate: Some(&estimate),
        readings: Readings::NONE,
    };
    let body = KnownBody { inertia: from_fn(|row| numbers(20 + 3 * row)) };
    for place in 0..48_usize {
        let step = [copied(INPUT + 8 * place as i32, OUTPUT, 3), vec![0x0b]].concat();
        let code = kept(&Assembled::with_step(&step).bytes()).unwrap();
        let torque = first_torque(code, &DeclaredTable::NONE, [number(2), number(3), number(1)]);
        assert_eq!(torque(&body, &input), numbers(place), "from number {place} on");
    }
}

pub fn without_own_keys(text: &str) -> String {
    let is_of_module =
        |line: &&str| ["stiffness_n_m", "damping_n_m_s", "integral_"].iter().any(|key| line.starts_with(key));
    let text: String = text.lines().filter(|line| !is_of_module(line)).map(|line| format!("{line}\n")).collect();
    let own = text.find("[[disperse]]                # a parameter").unwrap();
    let end = text.find("[[require]]").unwrap();
    format!("{}{}", &text[..own], &text[end..])
}

pub fn with(folder: &ScratchFolder, module: &[u8]) -> String {
    std::fs::write(folder.path("hostile.wasm"), module).unwrap();
    without_own_keys(CAMPAIGN).replace(BUILT[0], "hostile.wasm")
}

#[test]
fn runs_end_with_the_reason_of_their_module() {
    let folder = ScratchFolder::new("flight-code-hostile-steps");
    let torque = |bits: u64| {
        let number = [vec![0x44], bits.to_le_bytes().to_vec()].concat();
        [constant(OUTPUT), number, vec![0x39, 3, 0, 0x0b]].concat()
    };
    let after = |seconds: f64, code: &[u8]| {
        let time = [constant(INPUT), vec![0x2b, 3, 0, 0x44], seconds.to_le_bytes().to_vec(), vec![0x66]].concat();
        [time, vec![0x04, 0x40], code.to_vec(), vec![0x0b, 0x0b]].concat()
    };
    let endless: &[u8] = &[0x03, 0x40, 0x0c, 0, 0x0b, 0x0b];
    let growing: &[u8] = &[0x03, 0x40, 0x41, 1, 0x40, 0, 0x1a, 0x0c, 0, 0x0b, 0x0b];
    let [trap, fuel, diverged] = [Failure::ModuleTrap, Failure::ModuleFuel, Failure::Diverged];
    let cases: [(&str, Vec<u8>, Failure, f64); 10] = [
        ("endless", endless.to_vec(), fuel, 0.0),
        ("growing", growing.to_vec(), fuel, 0.0),
        ("recursion", vec![0x10, 3, 0x0b], trap, 0.0),
        ("unreachable", vec![0x00, 0x0b], trap, 0.0),
        ("unreachable later", after(1.5, &[0x00]), trap, 1.5),
        ("division by zero", vec![0x41, 1, 0x41, 0, 0x6d, 0x1a, 0x0b], trap, 0.0),
        ("beyond its memory", [constant(-8), vec![0x2b, 3, 0, 0x1a, 0x0b]].concat(), trap, 0.0),
        ("NaN", torque(f64::NAN.to_bits()), diverged, 0.0),
        ("NaN of another form", torque(0xfff0_0000_dead_beef), diverged, 0.0),
        ("infinite", torque(f64::INFINITY.to_bits()), diverged, 0.0),
    ];
    for (name, step, failure, end) in cases {
        let plan = plan_in(&folder, &with(&folder, &Assembled::with_step(&step).bytes()));
        let rows = rows(&plan, Isa::best(), 0, 9);
        assert!(rows.statuses().iter().all(|status| *status == Status::Done), "{name}");
        assert_eq!(column(&plan, &rows, "failure"), [failure.code(); 9], "{name}");
        assert_eq!(column(&plan, &rows, "end_time_s"), [end; 9], "{name}");
    }
}

#[test]
fn modules_that_cannot_fly_are_refused() {
    let sound = Assembled::with_step(NOTHING);
    let endless: Vec<u8> = vec![0x03, 0x40, 0x0c, 0, 0x0b, 0x0b];
    let huge = {
        let filling = vec![0; MOST_BYTES as usize];
        [sound.bytes(), vec![0], filling].concat()
    };
    let nested = |depth| [[0x02, 0x40].repeat(depth), vec![0x0b; depth + 1]].concat();
    let branches = |count: usize| [vec![0x41, 0, 0x0e], size(count), vec![0; count + 1], vec![0x0b]].concat();
    let component = b"\0asm\x0d\0\x01\0".to_vec();
    // of types with so many parameters, and of empty functions
    let passing = |types: usize, parameters: usize, functions: usize| {
        let of_type = [vec![0x60], size(parameters), vec![0x7c; parameters], vec![0]].concat();
        let types = section(1, list(&vec![of_type; types]));
        let functions = [vec![vec![0]; functions], vec![vec![2, 0, 0x0b]; functions]].map(|all| list(&all));
        [b"\0asm\x01\0\0\0".to_vec(), types, section(3, functions[0].clone()), section(10, functions[1].clone())]
            .concat()
    };
    let truncated = sound.bytes()[..60].to_vec();
    let cases = vec![
        (Vec::new(), "does not begin as one does"),
        (b"(module)".to_vec(), "does not begin as one does"),
        (component, "not a core module"),
        (truncated, "unexpected end"),
        (huge, "at most 4194304 bytes"),
        (sound.changed(|m| m.step = [vec![0x01; 600_000], vec![0x0b]].concat()), "bytes of code are more than 524288"),
        (sound.changed(|m| m.functions = 6000), "functions are more than 5000"),
        (sound.changed(|m| m.locals = 1001), "a function of 1001 locals"),
        (sound.changed(|m| m.step = nested(1001)), "more than 1000 blocks"),
        (
            sound.changed(|m| {
                (m.locals, m.step) = (1000, [nested(500)[..1500].repeat(6), vec![0x0b]].concat());
            }),
            "3003000 blocks times locals",
        ),
        (sound.changed(|m| m.step = branches(20_001)), "20001 targets"),
        (sound.changed(|m| m.step = [[0x02, 0x40, 0x0b].repeat(5001), vec![0x0b]].concat()), "are 25010001 in all"),
        ([sound.bytes(), section(11, list(&vec![vec![0, 0x41, 0, 0x0b, 0]; 2001]))].concat(), "2001 segments"),
        (passing(101, 991, 0), "100091 parameters and results in all"),
        (passing(1, 100, 1_000), "100100 parameters and results in all"),
        (passing(1, 100, 999), "does not export its memory"),
        (sound.changed(|m| m.imports = true), "imports print of env"),
        (sound.changed(|m| m.misnamed = "memory"), "does not export its memory"),
        (sound.changed(|m| m.misnamed = "spindrift_interface"), "does not export spindrift_interface"),
        (sound.changed(|m| m.misnamed = "spindrift_input"), "does not export spindrift_input"),
        (sound.changed(|m| m.misnamed = "spindrift_output"), "does not export spindrift_output"),
        (sound.changed(|m| m.misnamed = "spindrift_step"), "does not export spindrift_step"),
        (sound.changed(|m| (m.is_mistyped, m.step) = (true, vec![0x41, 0, 0x0b])), "spindrift_step is not a function"),
        (sound.changed(|m| m.is_init_mistyped = true), "spindrift_init is not a function"),
        (sound.changed(|m| m.places[0] = 0), "its interface is 0"),
        (sound.changed(|m| m.places[1] = 65_536 - 8 * 50 + 1), "spindrift_input returns 65137"),
        (sound.changed(|m| m.places[1] = -1), "spindrift_input returns 4294967295"),
        (sound.changed(|m| m.places[2] = 65_520), "spindrift_output returns 65520"),
        (sound.changed(|m| m.start = Some(vec![0x00, 0x0b])), "unreachable"),
        (sound.changed(|m| m.start = Some(endless)), "fuel"),
        (sound.changed(|m| m.pages = 1000), "memory"),
        (sound.changed(|m| (m.table, m.misnamed) = (Some(""), "spindrift_parameters")), "belong together"),
        (sound.changed(|m| m.table = Some("gain_n_m | N m | 1\n")), "\"key | unit | default | meaning\""),
        (sound.changed(|m| m.table = Some("Gain | 1 | 1 | Gain\n")), "\"Gain\" is not a key"),
        (sound.changed(|m| m.table = Some("gain | 1 | much | Gain\n")), "not a finite number"),
        (sound.changed(|m| m.table = Some("gain | 1 | 1 | Gain\ngain | 1 | 1 | Gain\n")), "stands in it twice"),
        (sound.changed(|m| m.table = Some("gain_n_m | rad | 1 | Gain\n")), "ends in \"N m\", and says \"rad\""),
        (sound.changed(|m| m.table = Some("timeout_s | s | 1 | Time\n")), "\"timeout_s\" is"),
        (sound.changed(|m| m.table = Some("until | 1 | 1 | Time\n")), "\"until\" is"),
    ];
    refused("flight-code-refused", cases);
}

pub fn refused(folder: &str, cases: Vec<(Vec<u8>, &str)>) {
    let folder = ScratchFolder::new(folder);
    for (module, says) in cases {
        folder.file("campaign.toml", &with(&folder, &module));
        let error = Plan::load(&folder.path("campaign.toml"), Overrides::default()).expect_err(says).to_string();
        assert!(error.contains("control.module") && error.contains(says), "{says}: {error}");
        assert_eq!(error.matches("must be").count(), if says.ends_with("\" is") { 2 } else { 1 }, "{error}");
    }
}

#[test]
fn declared_parameters_are_keys() {
    let folder = ScratchFolder::new("flight-code-parameters");
    let mut module = Assembled::with_step(&[copied(16_384, OUTPUT, 3), vec![0x0b]].concat());
    module.table = Some("a_n_m | N m | 0.5 | First\n\nb_rad_s | rad/s | | Second\nc | 1 | -1e-3 | Third\n");
    let text = with(&folder, &module.bytes());
    folder.file("campaign.toml", &text);
    let missing = Plan::load(&folder.path("campaign.toml"), Overrides::default()).expect_err("b has no default");
    assert!(missing.to_string().contains("guidance.detumble.b_rad_s"), "{missing}");
    let given = text.replace("law = \"module\"\n", "law = \"module\"\nb_rad_s = \"1 deg/s\"\n");
    let plan = plan_in(&folder, &given);
    let code = plan.law.as_ref().unwrap().spec().unwrap().code().unwrap();
    let table = &plan.nominal.control.guidance[0];
    let one = |key: &str| table.named(key).unwrap()[0];
    let expected = [0.5, 1_f64.to_radians(), -1e-3];
    assert_eq!(["a_n_m", "b_rad_s", "c"].map(one), expected);
    let body = KnownBody { inertia: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
    assert_eq!(first_torque(code, table, [0.1, 0.0, 0.0])(&body, &LawInput::AT_TARGET), expected);
}
