//! [`Assembled`]: WebAssembly modules byte by byte (WebAssembly 1.0, section 5), beyond what compilers build.

pub const INPUT: i32 = 1024;
pub const OUTPUT: i32 = 4096;
pub const MEASURED: i32 = 20_480;
pub const REPORTED: i32 = 24_576;

const TEXTS: [i32; 3] = [8192, 28_672, 32_768];

pub const NOTHING: &[u8] = &[0x0b];

/// A module that is flown without a torque, but for the changes of a test.
#[derive(Clone, Debug, Default)]
pub struct Assembled {
    /// Answers of `spindrift_interface`, `_input`, `_output`, `_measurements` and `_telemetry`.
    pub places: [i32; 5],
    pub pages: u32,
    pub step: Vec<u8>,
    pub start: Option<Vec<u8>>,
    pub table: Option<&'static str>,
    pub tables: [Option<&'static str>; 2],
    pub misnamed: &'static str,
    pub imports: bool,
    pub is_mistyped: bool,
    pub is_init_mistyped: bool,
    pub locals: usize,
    pub functions: usize,
}

pub fn leb(mut number: i64) -> Vec<u8> {
    let mut bytes = Vec::new();
    loop {
        let low = (number & 0x7f) as u8;
        number >>= 7;
        if number == 0 && low & 0x40 == 0 || number == -1 && low & 0x40 != 0 {
            bytes.push(low);
            return bytes;
        }
        bytes.push(low | 0x80);
    }
}

pub fn size(mut number: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    while number >= 0x80 {
        bytes.push((number & 0x7f) as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
    bytes
}

pub fn sized(bytes: &[u8]) -> Vec<u8> {
    [size(bytes.len()), bytes.to_vec()].concat()
}

pub fn list(things: &[Vec<u8>]) -> Vec<u8> {
    [size(things.len()), things.concat()].concat()
}

pub fn section(id: u8, content: Vec<u8>) -> Vec<u8> {
    [vec![id], sized(&content)].concat()
}

pub fn constant(number: i32) -> Vec<u8> {
    [vec![0x41], leb(number.into())].concat()
}

pub fn copied(from: i32, to: i32, count: i32) -> Vec<u8> {
    let one = |index: i32| {
        let load = [constant(from + 8 * index), vec![0x2b, 3, 0]].concat();
        [constant(to + 8 * index), load, vec![0x39, 3, 0]].concat()
    };
    (0..count).flat_map(one).collect()
}

impl Assembled {
    pub fn with_step(step: &[u8]) -> Self {
        let places = [1, INPUT, OUTPUT, MEASURED, REPORTED];
        Assembled { places, pages: 1, step: step.to_vec(), ..Assembled::default() }
    }

    /// The bytes after `change`.
    pub fn changed(&self, change: impl FnOnce(&mut Self)) -> Vec<u8> {
        let mut module = self.clone();
        change(&mut module);
        module.bytes()
    }

    pub fn bytes(&self) -> Vec<u8> {
        let types = list(&[vec![0x60, 0, 0], vec![0x60, 0, 1, 0x7f]]);
        let step_type = u8::from(self.is_mistyped);
        let mut functions = vec![1, 1, 1, step_type, 1, 1, 1, 1, 1, 1];
        let [interface, input, output, measured, reported] = self.places;
        let answers = [interface, input, output, 0, 16_384, TEXTS[0], measured, TEXTS[1], reported, TEXTS[2]];
        let mut bodies: Vec<Vec<u8>> = answers.iter().map(|answer| [constant(*answer), vec![0x0b]].concat()).collect();
        bodies[3] = self.step.clone();
        if let Some(start) = &self.start {
            functions.push(0);
            bodies.push(start.clone());
        }
        functions.extend(vec![0; self.functions]);
        bodies.extend(vec![NOTHING.to_vec(); self.functions]);
        let first = usize::from(self.imports);
        let names = [
            "spindrift_interface",
            "spindrift_input",
            "spindrift_output",
            "spindrift_step",
            "spindrift_parameters",
            "spindrift_parameter_table",
            "spindrift_measurements",
            "spindrift_measurement_table",
            "spindrift_telemetry",
            "spindrift_telemetry_table",
        ];
        let texts = [self.table, self.tables[0], self.tables[1]];
        let named = |name: &str| if name == self.misnamed { "other".to_owned() } else { name.to_owned() };
        let is_exported = |place: &usize| *place < 4 || texts[(place - 4) / 2].is_some();
        let mut exports: Vec<Vec<u8>> = (0..names.len())
            .filter(is_exported)
            .map(|place| [sized(named(names[place]).as_bytes()), vec![0], size(first + place)].concat())
            .collect();
        if self.is_init_mistyped {
            exports.push([sized(b"spindrift_init"), vec![0], size(first)].concat());
        }
        exports.push([sized(named("memory").as_bytes()), vec![2, 0]].concat());
        let mut module = b"\0asm\x01\0\0\0".to_vec();
        module.extend(section(1, types));
        if self.imports {
            module.extend(section(2, list(&[[sized(b"env"), sized(b"print"), vec![0, 0]].concat()])));
        }
        module.extend(section(3, list(&functions.iter().map(|kind| vec![*kind]).collect::<Vec<_>>())));
        module.extend(section(5, list(&[[vec![0], size(self.pages as usize)].concat()])));
        module.extend(section(7, list(&exports)));
        if self.start.is_some() {
            module.extend(section(8, size(first + names.len())));
        }
        let code = |(place, body): (usize, &Vec<u8>)| {
            let locals =
                if place == 3 && self.locals > 0 { vec![[size(self.locals), vec![0x7c]].concat()] } else { vec![] };
            sized(&[list(&locals), body.clone()].concat())
        };
        module.extend(section(10, list(&bodies.iter().enumerate().map(code).collect::<Vec<_>>())));
        let text = |(place, text): (i32, Option<&str>)| {
            let of = |text: &str| [vec![0], constant(place), vec![0x0b], sized(text.as_bytes())].concat();
            text.map(of)
        };
        let data: Vec<Vec<u8>> = TEXTS.into_iter().zip(texts).filter_map(text).collect();
        if !data.is_empty() {
            module.extend(section(11, list(&data)));
        }
        module
    }
}
