//! Compiled modules and their instances.
//!
//! A module's output is a function of its input: NaN are canonical, nothing is imported, and fuel counts instructions.
//! Only the call depth at which it traps depends on the processor ([`MOST_STACK`]). Bounds are checked by instructions,
//! since signals belong to the process.

use std::sync::{Mutex, OnceLock, PoisonError};

use wasmtime::{
    Config, Engine, Error, Instance, InstancePre, Linker, Memory, Module, Result, Store, StoreLimits,
    StoreLimitsBuilder, Trap, TypedFunc, WasmResults, bail, format_err,
};

use super::input::{self, MEASURED, NUMBERS};
use super::{complexity, declared};
use crate::control::laws::LawKind;
use crate::loops::attitude_law::{KnownBody, LawInput, LawSettings, PhaseLaw};
use crate::loops::failure::Failure;
use crate::loops::flight_code::{
    DeclaredTelemetry, FlightCode, INTERFACES, MOST_MEMORY, MOST_STACK, NAME, Refusal, START_FUEL, STEP_FUEL,
    WantedSensor,
};
use crate::scene::LawParameter;

/// Most tables of a module, and elements of each.
const MOST_TABLES: usize = 4;
const MOST_ELEMENTS: usize = 10_000;
/// Longest text of a table, bytes.
const LONGEST_TEXT: usize = 1 << 14;
/// Numbers in the output.
const OUTPUT: usize = 3;
/// Exports that return the address of numbers and of the text that declares them; the last two since interface 2.
const TABLES: [[&str; 2]; 3] = [
    ["spindrift_parameters", "spindrift_parameter_table"],
    ["spindrift_measurements", "spindrift_measurement_table"],
    ["spindrift_telemetry", "spindrift_telemetry_table"],
];
/// Their places in [`TABLES`].
const PARAMETERS: usize = 0;
const MEASUREMENTS: usize = 1;
const TELEMETRY: usize = 2;

/// The compiler of this process.
fn engine() -> Result<&'static Engine> {
    static ENGINE: OnceLock<Result<Engine>> = OnceLock::new();
    let make = || {
        let mut config = Config::new();
        config.cranelift_nan_canonicalization(true).consume_fuel(true).max_wasm_stack(MOST_STACK);
        config.wasm_relaxed_simd(false).wasm_multi_value(false).wasm_multi_memory(false).wasm_memory64(false);
        config.signals_based_traps(false).wasm_backtrace_max_frames(None).generate_address_map(false);
        // reserves the largest memory in place: the default would reserve gigabytes per run
        config.memory_reservation(MOST_MEMORY as u64).memory_may_move(false).memory_init_cow(false);
        Engine::new(&config)
    };
    ENGINE.get_or_init(make).as_ref().map_err(|error| format_err!("{error:#}"))
}

/// See [`super::kept`].
pub fn kept(bytes: &[u8], sha256: &str) -> std::result::Result<&'static FlightCode, Refusal> {
    static KEPT: Mutex<Vec<&'static FlightCode>> = Mutex::new(Vec::new());
    // locked while compiling, so that others wait for the same module
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = kept.iter().find(|known| known.sha256 == sha256) {
        return Ok(known);
    }
    let (compiled, declared) = compiled(bytes).map_err(|error| {
        let allowed = format!("a WebAssembly module that can be flown ({error:#})");
        (allowed, "build it as docs/flight-code.md shows".to_owned())
    })?;
    let Declared { parameters, sensors, telemetry } = declared;
    let make = move |settings: &LawSettings<'_>| ModuleLaw::new(compiled.clone(), &declared, settings);
    let kind = LawKind::new(NAME, parameters, make).reading(!sensors.is_empty());
    let code = Box::leak(Box::new(FlightCode { sha256: sha256.to_owned(), kind, sensors, telemetry }));
    kept.push(code);
    Ok(code)
}

/// A module ready to be instantiated.
type Compiled = InstancePre<StoreLimits>;

#[derive(Clone, Copy)]
struct Declared {
    parameters: &'static [LawParameter],
    sensors: &'static [WantedSensor],
    telemetry: &'static [DeclaredTelemetry],
}

/// The module and its declarations; a trial instance has started.
fn compiled(bytes: &[u8]) -> Result<(Compiled, Declared)> {
    match bytes {
        [0, b'a', b's', b'm', 1, 0, 0, 0, ..] => {}
        [0, b'a', b's', b'm', ..] => bail!("it is not a core module; is it a component?"),
        _ => bail!("it does not begin as one does"),
    }
    Module::validate(engine()?, bytes)?;
    complexity::check(bytes)?;
    let module = Module::new(engine()?, bytes)?;
    if let Some(import) = module.imports().next() {
        bail!("it imports {} of {}: a run has nothing to give to it", import.name(), import.module());
    }
    let compiled = Linker::new(module.engine()).instantiate_pre(&module)?;
    let mut running = Running::start(&compiled)?;
    let interface: i32 = running
        .optional("spindrift_interface")?
        .ok_or_else(|| missing("spindrift_interface"))?
        .call(&mut running.store, ())?;
    if !INTERFACES.contains(&interface) {
        let [first, last] = INTERFACES;
        bail!("its interface is {interface}, and this version of spindrift has {first} and {last}");
    }
    let later = TABLES[MEASUREMENTS..].as_flattened().iter().find(|name| module.get_export(name).is_some());
    if let Some(later) = later.filter(|_| interface < 2) {
        bail!("it exports {later}, which interface 2 has, and its interface is {interface}");
    }
    running.optional::<()>("spindrift_init")?;
    let declared = Declared {
        parameters: running.declared(PARAMETERS, 1, declared::parameters)?,
        sensors: running.declared(MEASUREMENTS, MEASURED, declared::sensors)?,
        telemetry: running.declared(TELEMETRY, 1, declared::telemetry)?,
    };
    Ok((compiled, declared))
}

/// An instance with its own memory.
struct Running {
    store: Store<StoreLimits>,
    instance: Instance,
    memory: Memory,
    step: TypedFunc<(), ()>,
    /// Addresses in its memory.
    input: usize,
    output: usize,
    tables: [Option<usize>; 3],
}

impl Running {
    /// An instance after its start function and constructors.
    fn start(compiled: &Compiled) -> Result<Self> {
        let limits = StoreLimitsBuilder::new().memory_size(MOST_MEMORY).tables(MOST_TABLES);
        let limits = limits.table_elements(MOST_ELEMENTS).build();
        let mut store = Store::new(compiled.module().engine(), limits);
        store.limiter(|limits| limits);
        store.set_fuel(START_FUEL)?;
        let instance = compiled.instantiate(&mut store)?;
        let memory = instance.get_memory(&mut store, "memory");
        let memory = memory.ok_or_else(|| format_err!("it does not export its memory as \"memory\""))?;
        if let Some(constructors) = function::<()>(&instance, &mut store, "_initialize")? {
            constructors.call(&mut store, ())?;
        }
        let step = function(&instance, &mut store, "spindrift_step")?.ok_or_else(|| missing("spindrift_step"))?;
        let mut running = Running { store, instance, memory, step, input: 0, output: 0, tables: [None; 3] };
        running.input = running.place("spindrift_input")?.ok_or_else(|| missing("spindrift_input"))?;
        running.output = running.place("spindrift_output")?.ok_or_else(|| missing("spindrift_output"))?;
        for (place, [name, _]) in TABLES.into_iter().enumerate() {
            running.tables[place] = running.place(name)?;
        }
        running.area(running.input, NUMBERS, "spindrift_input")?;
        running.area(running.output, OUTPUT, "spindrift_output")?;
        Ok(running)
    }

    fn optional<R: WasmResults>(&mut self, name: &str) -> Result<Option<TypedFunc<(), R>>> {
        function(&self.instance, &mut self.store, name)
    }

    /// The address that the function `name` returns, if it exists.
    fn place(&mut self, name: &str) -> Result<Option<usize>> {
        let Some(function) = self.optional::<i32>(name)? else { return Ok(None) };
        let place = function.call(&mut self.store, ())?;
        Ok(Some(place.cast_unsigned() as usize))
    }

    /// Checks that `numbers` numbers fit into memory at `place`, the result of `name`.
    fn area(&self, place: usize, numbers: usize, name: &str) -> Result<()> {
        let size = self.memory.data_size(&self.store);
        if place + 8 * numbers > size {
            bail!("{name} returns {place}, and {numbers} numbers from there on are beyond its memory of {size} bytes");
        }
        Ok(())
    }

    /// The declarations of a table of [`TABLES`], each of `count` numbers.
    fn declared<T>(
        &mut self,
        which: usize,
        count: usize,
        parse: fn(String) -> std::result::Result<&'static [T], String>,
    ) -> Result<&'static [T]> {
        let ([name, table], place) = (TABLES[which], self.tables[which]);
        let text = match (self.optional::<i32>(table)?, place) {
            (None, None) => return Ok(&[]),
            (Some(text), Some(_)) => text.call(&mut self.store, ())?,
            _ => bail!("it exports one of {name} and {table}; they belong together"),
        };
        let things = self.text(text).and_then(parse).map_err(|why| format_err!("{table}: {why}"))?;
        self.area(place.unwrap_or(0), count * things.len(), name)?;
        Ok(things)
    }

    /// The zero-terminated text at `place`.
    fn text(&self, place: i32) -> std::result::Result<String, String> {
        let memory = self.memory.data(&self.store).get(place.cast_unsigned() as usize..).unwrap_or_default();
        let longest = &memory[..memory.len().min(LONGEST_TEXT)];
        let end = longest.iter().position(|byte| *byte == 0);
        let end = end.ok_or_else(|| format!("there is no text that ends with a zero within {LONGEST_TEXT} bytes"))?;
        String::from_utf8(longest[..end].to_vec()).map_err(|_| "its text is not UTF-8".to_owned())
    }

    fn write(&mut self, place: usize, bytes: &[u8]) {
        if let Some(area) = self.memory.data_mut(&mut self.store).get_mut(place..place + bytes.len()) {
            area.copy_from_slice(bytes);
        }
    }

    /// Writes parameters and the first input, and calls `spindrift_init`.
    fn prepare(&mut self, parameters: &[f64], known: &Known) -> Result<()> {
        if let Some(place) = self.tables[PARAMETERS] {
            let bytes: Vec<u8> = parameters.iter().flat_map(|number| number.to_le_bytes()).collect();
            self.write(place, &bytes);
        }
        self.tell(known);
        match self.optional::<()>("spindrift_init")? {
            Some(init) => init.call(&mut self.store, ()),
            None => Ok(()),
        }
    }

    fn tell(&mut self, known: &Known) {
        self.write(self.input, &known.input);
        if let Some(place) = self.tables[MEASUREMENTS] {
            self.write(place, &known.measured);
        }
    }

    /// A step: the wanted torque, and telemetry.
    fn step(&mut self, known: &Known, telemetry: &mut [f64]) -> Result<[f64; OUTPUT]> {
        self.tell(known);
        self.store.set_fuel(STEP_FUEL)?;
        self.step.call(&mut self.store, ())?;
        telemetry.iter_mut().enumerate().for_each(|(index, value)| {
            let number = self.number(self.tables[TELEMETRY].unwrap_or(0) + 8 * index);
            *value = if number.is_finite() { number } else { f64::NAN };
        });
        Ok(std::array::from_fn(|index| self.number(self.output + 8 * index)))
    }

    fn number(&self, place: usize) -> f64 {
        let bytes = self.memory.data(&self.store).get(place..place + 8).and_then(|bytes| bytes.try_into().ok());
        bytes.map_or(f64::NAN, f64::from_le_bytes)
    }
}

struct Known {
    input: Vec<u8>,
    measured: Vec<u8>,
}

/// The function `name` without arguments, if it is exported.
fn function<R: WasmResults>(
    instance: &Instance,
    store: &mut Store<StoreLimits>,
    name: &str,
) -> Result<Option<TypedFunc<(), R>>> {
    if instance.get_export(&mut *store, name).is_none() {
        return Ok(None);
    }
    let wrong = |_| format_err!("{name} is not a function with the arguments and results that it must have");
    instance.get_typed_func(store, name).map(Some).map_err(wrong)
}

fn missing(name: &str) -> Error {
    format_err!("it does not export {name}")
}

/// The law of a phase in a run, with an instance from the phase's first tick on.
struct ModuleLaw {
    compiled: Compiled,
    declared: Declared,
    parameters: Vec<f64>,
    /// Control period and delay, s.
    times: [f64; 2],
    /// Telemetry of the last step; empty before the first and after a failure.
    telemetry: Vec<f64>,
    running: Option<Running>,
    failure: Option<Failure>,
}

impl ModuleLaw {
    fn new(compiled: Compiled, declared: &Declared, settings: &LawSettings<'_>) -> Self {
        let number =
            |parameter: &LawParameter| settings.table.named(parameter.facts.key).map_or(f64::NAN, |found| found[0]);
        ModuleLaw {
            compiled,
            declared: *declared,
            parameters: declared.parameters.iter().map(number).collect(),
            times: [settings.period, settings.delay],
            telemetry: Vec::new(),
            running: None,
            failure: None,
        }
    }

    fn step(&mut self, known: &Known) -> Result<[f64; OUTPUT]> {
        let running = match &mut self.running {
            Some(running) => running,
            none => {
                let mut running = Running::start(&self.compiled)?;
                running.prepare(&self.parameters, known)?;
                none.insert(running)
            }
        };
        self.telemetry.resize(self.declared.telemetry.len(), f64::NAN);
        running.step(known, &mut self.telemetry)
    }
}

impl PhaseLaw for ModuleLaw {
    fn torque(&mut self, body: &KnownBody, input: &LawInput<'_>, elapsed: f64) -> [f64; 3] {
        let known = Known {
            input: input::bytes(body, input, elapsed, self.times),
            measured: input::measured(self.declared.sensors, input),
        };
        self.step(&known).unwrap_or_else(|stopped| {
            self.telemetry.clear();
            self.failure = match stopped.downcast_ref() {
                Some(Trap::OutOfFuel) => Some(Failure::ModuleFuel),
                Some(_) => Some(Failure::ModuleTrap),
                // a trial instance has started before: this machine is at fault, and no row may blame the module
                None => panic!("no instance of the module can be made: {stopped:#}"),
            };
            [f64::NAN; 3]
        })
    }

    fn telemetry(&self) -> &[f64] {
        &self.telemetry
    }

    fn failure(&self) -> Option<Failure> {
        self.failure
    }
}

/// A clone restarts.
impl Clone for ModuleLaw {
    fn clone(&self) -> Self {
        let (compiled, parameters) = (self.compiled.clone(), self.parameters.clone());
        ModuleLaw { compiled, parameters, telemetry: Vec::new(), running: None, failure: None, ..*self }
    }
}
