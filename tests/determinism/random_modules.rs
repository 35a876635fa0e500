//! [`module`]: WebAssembly modules at random: bytes, damaged ones, valid ones, and ones that are large in some respect.

use super::assembled_module::{constant, list, section, size, sized};
use super::random_code::{Numbers, SIGNATURES, Surroundings, TYPES, body};

/// The ways in which modules are made.
pub const KINDS: [&str; 4] = ["bytes", "damaged", "valid", "large"];

/// The exports of a module that the interface knows, and what a function that returns a place may answer.
const NAMES: [&str; 12] = [
    "spindrift_interface",
    "spindrift_input",
    "spindrift_output",
    "spindrift_step",
    "spindrift_init",
    "_initialize",
    "spindrift_parameters",
    "spindrift_parameter_table",
    "spindrift_measurements",
    "spindrift_measurement_table",
    "spindrift_telemetry",
    "spindrift_telemetry_table",
];
/// Where a module has the texts of its tables.
const TEXTS: i32 = 60_000;

/// Module `number` of those that begin with `seed`: how it was made, and its bytes; `shipped` are modules that fly.
pub fn module(seed: u64, number: u64, shipped: &[Vec<u8>]) -> (&'static str, Vec<u8>) {
    let mut numbers = Numbers(seed.wrapping_mul(0x5851_f42d_4c95_7f2d) ^ number.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let kind = match numbers.below(20) {
        0 => 0,
        1..8 => 1,
        8..18 => 2,
        _ => 3,
    };
    let bytes = match kind {
        0 => at_random(&mut numbers),
        1 => {
            // a valid one may be damaged too
            let whole =
                if numbers.once_in(4) { valid(&mut numbers) } else { shipped[numbers.below(shipped.len())].clone() };
            damaged(&mut numbers, whole, shipped)
        }
        2 => valid(&mut numbers),
        _ => large(&mut numbers),
    };
    (KINDS[kind], bytes)
}

/// Bytes at random, with the beginning of a module or without, or sections of them.
fn at_random(numbers: &mut Numbers) -> Vec<u8> {
    let length = numbers.below(4000);
    match numbers.below(3) {
        0 => numbers.bytes(length),
        1 => [b"\0asm\x01\0\0\0".to_vec(), numbers.bytes(length)].concat(),
        _ => {
            let sections = (0..numbers.below(14)).map(|_| {
                let content = numbers.below(60);
                section(numbers.below(14) as u8, numbers.bytes(content))
            });
            [b"\0asm\x01\0\0\0".to_vec(), sections.collect::<Vec<_>>().concat()].concat()
        }
    }
}

/// The sections of a module: where each begins, and the end.
fn sections(bytes: &[u8]) -> Vec<usize> {
    let mut places = vec![8.min(bytes.len())];
    loop {
        let mut at = places[places.len() - 1] + 1;
        let (mut length, mut shift) = (0, 0);
        while let Some(byte) = bytes.get(at).filter(|_| shift < 35) {
            length |= usize::from(byte & 0x7f) << shift;
            (at, shift) = (at + 1, shift + 7);
            if byte & 0x80 == 0 {
                break;
            }
        }
        if at + length > bytes.len() || length == 0 {
            return places;
        }
        places.push(at + length);
    }
}

/// `whole` with some changes of bytes, or of sections.
fn damaged(numbers: &mut Numbers, mut whole: Vec<u8>, shipped: &[Vec<u8>]) -> Vec<u8> {
    let most = numbers.of(&[1, 2, 4, 16]);
    for _ in 0..=numbers.below(most) {
        if whole.len() < 20 {
            return whole;
        }
        let at = numbers.below(whole.len());
        let to = (at + 1 + numbers.below(40)).min(whole.len());
        let places = sections(&whole);
        let some_section = |numbers: &mut Numbers, places: &[usize]| {
            let place = numbers.below(places.len().max(2) - 1);
            places[place]..*places.get(place + 1).unwrap_or(&places[place])
        };
        match numbers.below(12) {
            0..3 => whole[at] ^= 1 << numbers.below(8),
            3..5 => {
                whole[at] = numbers.of(&[0x00, 0x01, 0x0b, 0x0c, 0x0d, 0x10, 0x40, 0x7c, 0x7f, 0x80, 0xfc, 0xfd, 0xff]);
            }
            5 => whole[at] = numbers.next() as u8,
            6 => whole.truncate(at),
            7 => drop(whole.drain(at..to)),
            8 => {
                let copied = whole[at..to].to_vec();
                let place = numbers.below(whole.len());
                whole.splice(place..place, copied);
            }
            9 => drop(whole.drain(some_section(numbers, &places))),
            10 => {
                // a section of another module in the place of one
                let other = &shipped[numbers.below(shipped.len())];
                let taken = other[some_section(numbers, &sections(other))].to_vec();
                whole.splice(some_section(numbers, &places), taken);
            }
            _ => {
                // two sections change places
                let [one, two] = [0; 2].map(|_| some_section(numbers, &places));
                let (first, second) = if one.start < two.start { (one, two) } else { (two, one) };
                let between = whole[first.end.min(second.start)..second.start].to_vec();
                let swapped = [whole[second.clone()].to_vec(), between, whole[first.clone()].to_vec()].concat();
                if first.end <= second.start {
                    whole.splice(first.start..second.end, swapped);
                }
            }
        }
    }
    whole
}

/// A text such as a module declares its tables by, with something wrong in it now and then.
fn text(numbers: &mut Numbers, name: &str) -> Vec<u8> {
    let words =
        ["a", "gain_n_m", "rate_rad_s", "tracker", "star_tracker", "gyro", "1", "N m", "rad/s", "0.5", "nan", "", "é"];
    let line = |numbers: &mut Numbers| {
        let words = (0..numbers.of(&[1, 3, 4, 4, 4, 5])).map(|_| numbers.of(&words));
        words.collect::<Vec<_>>().join(" | ").into_bytes()
    };
    let fixed = [
        "",
        "gain_n_m | N m | 0.5 | Gain\n",
        "tracker | star_tracker\n",
        "gyro | rate_gyro\ntracker | star_tracker\ntachometers | tachometers\n",
        "error_rad | rad | Error\nratio | 1 | Ratio\n",
    ];
    let mut text = if numbers.once_in(8) {
        (0..numbers.below(4)).flat_map(|_| [line(numbers), b"\n".to_vec()].concat()).collect()
    } else {
        // mostly one of the table that it is
        let own = match name {
            "spindrift_parameter_table" => 1,
            "spindrift_measurement_table" => 2 + numbers.below(2),
            _ => 4,
        };
        let other = numbers.below(fixed.len());
        fixed[if numbers.once_in(6) { other } else { own }].as_bytes().to_vec()
    };
    if numbers.once_in(20) {
        text.push(0xff);
    }
    if !numbers.once_in(40) {
        text.push(0);
    }
    text
}

/// A valid module that exports what a module should, or nearly so.
fn valid(numbers: &mut Numbers) -> Vec<u8> {
    let functions = 4 * (1 + numbers.below(4));
    let (segments, pages) = (numbers.below(3), numbers.of(&[1, 1, 1, 2, 16, 256]));
    let statements = numbers.of(&[1, 3, 10, 40]);
    let mut bodies: Vec<Vec<u8>> =
        (0..functions).map(|own| body(numbers, Surroundings { functions, own, segments }, statements)).collect();
    let mut signatures: Vec<usize> = (0..functions).map(|function| function % 4).collect();
    let mut exports = vec![[sized(b"memory"), vec![2, 0]].concat()];
    let mut texts = Vec::new();
    let mut is_there = false;
    for (place, name) in NAMES.iter().enumerate() {
        let is_table = name.ends_with("_table");
        // a table stands behind its numbers, and belongs to them
        is_there = if is_table { is_there } else { place < 4 || numbers.once_in(if place < 6 { 12 } else { 3 }) };
        if !is_there || numbers.once_in(200) {
            continue;
        }
        let answer = match *name {
            "spindrift_interface" => numbers.of(&[1, 2, 2, 2, 2, 2, 2, 3]),
            _ if is_table => {
                let at = texts.len();
                texts.extend(text(numbers, name));
                TEXTS + at as i32
            }
            _ if numbers.once_in(60) => numbers.next() as i32,
            _ => 8 * numbers.below(7000) as i32,
        };
        let is_step = ["spindrift_step", "spindrift_init", "_initialize"].contains(name);
        let function = if is_step != numbers.once_in(100) {
            signatures.iter().position(|signature| *signature == 0).unwrap_or(0) + 4 * numbers.below(functions / 4)
        } else {
            signatures.push(1);
            bodies.push([vec![0], constant(answer), vec![0x0b]].concat());
            signatures.len() - 1
        };
        exports.push([sized(name.as_bytes()), vec![0], size(function)].concat());
    }
    let of_types = |list_of: &[usize]| list(&list_of.iter().map(|kind| vec![TYPES[*kind]]).collect::<Vec<_>>());
    let types = SIGNATURES.map(|(takes, gives)| [vec![0x60], of_types(takes), of_types(gives)].concat());
    let zeros: [Vec<u8>; 5] = [
        vec![0x41, 0],
        vec![0x42, 0],
        [vec![0x43], vec![0; 4]].concat(),
        [vec![0x44], vec![0; 8]].concat(),
        [vec![0xfd, 0x0c], vec![0; 16]].concat(),
    ];
    let globals: Vec<Vec<u8>> =
        TYPES.iter().zip(zeros).map(|(kind, zero)| [vec![*kind, 1], zero, vec![0x0b]].concat()).collect();
    let elements: Vec<Vec<u8>> = (0..functions).map(size).collect();
    let passive = |numbers: &mut Numbers| {
        let length = numbers.below(300);
        [vec![1], sized(&numbers.bytes(length))].concat()
    };
    let mut data: Vec<Vec<u8>> = (0..segments).map(|_| passive(numbers)).collect();
    data.push([vec![0], constant(TEXTS), vec![0x0b], sized(&texts)].concat());
    let mut parts = vec![
        section(1, list(&types)),
        section(3, list(&signatures.iter().map(|signature| size(*signature)).collect::<Vec<_>>())),
        section(4, list(&[[vec![0x70, 0], size(functions)].concat()])),
        section(5, list(&[[vec![0], size(pages)].concat()])),
        section(6, list(&globals)),
        section(7, list(&exports)),
    ];
    if numbers.once_in(20) {
        parts.push(section(8, size(4 * numbers.below(functions / 4))));
    }
    parts.push(section(9, list(&[[vec![0, 0x41, 0, 0x0b], list(&elements)].concat()])));
    parts.push(section(12, size(data.len())));
    parts.push(section(10, list(&bodies.iter().map(|body| sized(body)).collect::<Vec<_>>())));
    parts.push(section(11, list(&data)));
    [b"\0asm\x01\0\0\0".to_vec(), parts.concat()].concat()
}

/// A module that is large in one respect, up to and beyond what is allowed: what takes a compiler long.
fn large(numbers: &mut Numbers) -> Vec<u8> {
    // from some to a million, by powers of two
    let count = 1 << numbers.below(20);
    let count = count + numbers.below(count);
    let kinds = numbers.below(5);
    let kind = TYPES[kinds];
    let locals = numbers.of(&[0, 1, 100, 900]);
    let one_more: Vec<u8> = [vec![0x20, 0], vec![0x41, 3, 0x6a, 0x21, 0]].concat();
    let (mut types, mut globals, mut exports, mut data) = (0, 0, 0, 0);
    let mut functions = 0;
    let step: Vec<u8> = match numbers.below(14) {
        // values that live at once, on the stack of the module
        0 => [[0x20, 0].repeat(count), vec![0x6a; count - 1], vec![0x1a]].concat(),
        1 => [[0x02, 0x40].repeat(count), vec![0x0b; count]].concat(),
        2 => [[0x20, 0, 0x04, 0x40].to_vec(), one_more, vec![0x0b]].concat().repeat(count),
        3 => [vec![0x03, 0x40, 0x20, 0, 0x0d, 0, 0x0b]].concat().repeat(count),
        4 => [vec![0x02, 0x40, 0x20, 0, 0x0e], size(count), vec![0; count + 1], vec![0x0b]].concat(),
        5 => [vec![0x20, 0], [0x41, 7, 0x6c, 0x22, 0].repeat(count), vec![0x1a]].concat(),
        // through all locals
        6 => {
            let local = |at: usize| size(if locals == 0 { 0 } else { 1 + at % locals });
            (0..count).flat_map(|at| [vec![0x20], local(at), vec![0x21], local(7 * at + 1)].concat()).collect()
        }
        7 => [0x20, 0, 0x20, 0, 0x20, 0, 0x1b, 0x21, 0].repeat(count),
        8 => [0x41, 0, 0x41, 0, 0x41, 8, 0xfc, 0x0b, 0].repeat(count),
        9 => [0x10, 0].repeat(count),
        10 => {
            (functions, types) = (count, numbers.below(2) * count);
            vec![0x01]
        }
        11 => {
            globals = count;
            vec![0x01]
        }
        12 => {
            exports = count;
            vec![0x01]
        }
        _ => {
            data = count;
            vec![0x01]
        }
    };
    let kind = if locals == 0 || kinds == 0 { TYPES[0] } else { kind };
    let local = [vec![2], [1, TYPES[0]].to_vec(), [size(locals), vec![kind]].concat()].concat();
    let local = if kind == TYPES[0] { [vec![1], size(locals + 1), vec![kind]].concat() } else { local };
    let mut bodies = vec![[local, step, vec![0x0b]].concat()];
    let answers = [1 + numbers.below(2) as i32, 1024, 4096];
    bodies.extend(answers.map(|answer| [vec![0], constant(answer), vec![0x0b]].concat()));
    bodies.extend(vec![vec![0, 0x0b]; functions]);
    let mut signatures = vec![vec![0], vec![1], vec![1], vec![1]];
    signatures.extend(vec![vec![0]; functions]);
    let mut types_of: Vec<Vec<u8>> = vec![vec![0x60, 0, 0], vec![0x60, 0, 1, 0x7f]];
    types_of.extend((0..types).map(|at| [vec![0x60], list(&vec![vec![TYPES[at % 5]]; at % 20]), vec![0]].concat()));
    let mut names = vec![[sized(b"memory"), vec![2, 0]].concat()];
    for (name, function) in NAMES[..4].iter().zip([1, 2, 3, 0]) {
        names.push([sized(name.as_bytes()), vec![0, function]].concat());
    }
    names.extend((0..exports).map(|at| [sized(format!("e{at}").as_bytes()), vec![0, 0]].concat()));
    let mut parts = vec![
        section(1, list(&types_of)),
        section(3, list(&signatures)),
        section(5, list(&[[vec![0], size(numbers.of(&[1, 256]))].concat()])),
    ];
    if globals > 0 {
        parts.push(section(6, list(&vec![vec![0x7e, 1, 0x42, 0, 0x0b]; globals])));
    }
    parts.push(section(7, list(&names)));
    parts.push(section(10, list(&bodies.iter().map(|body| sized(body)).collect::<Vec<_>>())));
    if data > 0 {
        let one = if numbers.once_in(2) {
            vec![vec![0x00, 0x41, 0, 0x0b, 1, 7]; data]
        } else {
            vec![[vec![0, 0x41, 0, 0x0b], sized(&vec![7; 60_000])].concat(); data.min(80)]
        };
        parts.push(section(11, list(&one)));
    }
    [b"\0asm\x01\0\0\0".to_vec(), parts.concat()].concat()
}
