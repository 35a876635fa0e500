//! [`body`]: code of a function, at random, that is valid by construction: of the types that the instructions have
//! (WebAssembly 2.0, sections 2.4 and 5.4).

use super::assembled_module::{leb, size};

/// Numbers at random, the same on every machine: `SplitMix64` (G. Steele, D. Lea & C. Flood, 2014).
#[derive(Clone, Debug)]
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Below `end`, which is not zero.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    /// One of `list`.
    pub fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// Once in `n` times.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// One of the bytes from `first` to `last`.
    fn between(&mut self, first: u8, last: u8) -> u8 {
        first + self.below(usize::from(last - first) + 1) as u8
    }

    pub fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| self.next() as u8).collect()
    }
}

/// Types of values, by the places of their locals and globals.
const I32: usize = 0;
const I64: usize = 1;
const F32: usize = 2;
const F64: usize = 3;
const V128: usize = 4;
/// The same in a module.
pub const TYPES: [u8; 5] = [0x7f, 0x7e, 0x7d, 0x7c, 0x7b];
/// Locals of each type in a function, behind its arguments.
const LOCALS: usize = 3;
/// What functions take and give; function k of a module has signature k % 4.
pub const SIGNATURES: [(&[usize], &[usize]); 4] = [(&[], &[]), (&[], &[I32]), (&[F64, I32], &[F64]), (&[I32], &[V128])];

/// What code can name of its module.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings {
    /// Functions, of signature k % 4.
    pub functions: usize,
    /// The place of this one among them.
    pub own: usize,
    /// Passive segments of data.
    pub segments: usize,
}

/// The body of a function of a module, with its locals and its end.
pub fn body(numbers: &mut Numbers, surroundings: Surroundings, statements: usize) -> Vec<u8> {
    let (arguments, results) = SIGNATURES[surroundings.own % 4];
    let mut code = Code { numbers, surroundings, bytes: Vec::new(), arguments: arguments.len(), labels: 1, left: 4000 };
    for _ in 0..statements {
        code.statement(3);
    }
    results.iter().for_each(|result| code.value(*result, 4));
    code.op(&[0x0b]);
    let locals = TYPES.map(|kind| [size(LOCALS), vec![kind]].concat()).concat();
    [size(TYPES.len()), locals, code.bytes].concat()
}

struct Code<'a> {
    numbers: &'a mut Numbers,
    surroundings: Surroundings,
    bytes: Vec<u8>,
    arguments: usize,
    /// Blocks around what is written, and the function.
    labels: usize,
    /// Operations before there are leaves alone.
    left: usize,
}

/// Operators of one argument: how each is written, and the type of its argument. By the type of their result.
#[rustfmt::skip]
const UNARY: [&[(&[u8], usize)]; 5] = [
    &[
        (&[0x45], I32), (&[0x50], I64), (&[0x67], I32), (&[0x68], I32), (&[0x69], I32), (&[0xa7], I64), (&[0xa8],
        F32), (&[0xaa], F64),
        (&[0xab], F64), (&[0xbc], F32), (&[0xc0], I32), (&[0xc1], I32), (&[0xfc, 0], F32), (&[0xfc, 3], F64),
        (&[0xfd, 0x53], V128),
        (&[0xfd, 0x15, 3], V128), (&[0xfd, 0xa3, 1], V128), (&[0x40, 0], I32),
    ],
    &[
        (&[0x79], I64), (&[0x7a], I64), (&[0x7b], I64), (&[0xac], I32), (&[0xad], I32), (&[0xae], F32), (&[0xb1],
        F64), (&[0xbd], F64),
        (&[0xc2], I64), (&[0xc4], I64), (&[0xfc, 4], F32), (&[0xfc, 7], F64), (&[0xfd, 0x1d, 1], V128),
    ],
    &[
        (&[0x8b], F32), (&[0x8c], F32), (&[0x8d], F32), (&[0x90], F32), (&[0x91], F32), (&[0xb2], I32), (&[0xb5],
        I64), (&[0xb6], F64),
        (&[0xbe], I32), (&[0xfd, 0x1f, 2], V128),
    ],
    &[
        (&[0x99], F64), (&[0x9a], F64), (&[0x9b], F64), (&[0x9c], F64), (&[0x9e], F64), (&[0x9f], F64), (&[0xb7],
        I32), (&[0xba], I64),
        (&[0xbb], F32), (&[0xbf], I64), (&[0xfd, 0x21, 1], V128),
    ],
    &[
        (&[0xfd, 0x0f], I32), (&[0xfd, 0x11], I32), (&[0xfd, 0x12], I64), (&[0xfd, 0x13], F32), (&[0xfd, 0x14], F64),
        (&[0xfd, 0x4d], V128),
        (&[0xfd, 0x60], V128), (&[0xfd, 0x62], V128), (&[0xfd, 0xe0, 1], V128), (&[0xfd, 0xef, 1], V128), (&[0xfd,
        0xf8, 1], V128),
        (&[0xfd, 0xfc, 1], V128),
    ],
];
/// Operators of two arguments of the type of their result.
#[rustfmt::skip]
const BINARY_OF_VECTORS: [&[u8]; 16] = [
    &[0x4e], &[0x51], &[0x6e], &[0x71], &[0x0e], &[0x23], &[0x65], &[0xae, 1], &[0xb5, 1], &[0xe4, 1], &[0xe7, 1],
    &[0xe8, 1], &[0xf0, 1],
    &[0xf2, 1], &[0xf3, 1], &[0xf5, 1],
];
/// Loads: the operator, its largest alignment, and the type.
#[rustfmt::skip]
const LOADS: [(&[u8], u8, usize); 10] = [
    (&[0x28], 2, I32), (&[0x2c], 0, I32), (&[0x2f], 1, I32), (&[0x29], 3, I64), (&[0x35], 2, I64), (&[0x2a], 2, F32),
    (&[0x2b], 3, F64),
    (&[0xfd, 0], 4, V128), (&[0xfd, 7], 0, V128), (&[0xfd, 10], 3, V128),
];
#[rustfmt::skip]
const STORES: [(&[u8], u8, usize); 8] = [
    (&[0x36], 2, I32), (&[0x3a], 0, I32), (&[0x37], 3, I64), (&[0x3d], 1, I64), (&[0x38], 2, F32), (&[0x39], 3, F64),
    (&[0x39], 3, F64),
    (&[0xfd, 0x0b], 4, V128),
];

impl Code<'_> {
    fn op(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    fn local(&mut self, kind: usize) -> Vec<u8> {
        size(self.arguments + LOCALS * kind + self.numbers.below(LOCALS))
    }

    /// A number that programs are seldom tried with, more often than others.
    fn constant(&mut self, kind: usize) {
        let integers: [i64; 12] =
            [0, 1, -1, 8, 1024, 4096, 65_528, 65_536, i32::MAX.into(), i32::MIN.into(), i64::MIN, 255];
        let integer = if self.numbers.once_in(3) { self.numbers.next() as i64 } else { self.numbers.of(&integers) };
        let reals =
            [0.0, -0.0, 1.0, -1.5, 1e300, 1e-310, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.01, 2_147_483_648.0];
        let real = if self.numbers.once_in(3) { f64::from_bits(self.numbers.next()) } else { self.numbers.of(&reals) };
        let bytes = match kind {
            I32 => [vec![0x41], leb(i64::from(integer as i32))].concat(),
            I64 => [vec![0x42], leb(integer)].concat(),
            F32 => [vec![0x43], (real as f32).to_le_bytes().to_vec()].concat(),
            F64 => [vec![0x44], real.to_le_bytes().to_vec()].concat(),
            _ => [vec![0xfd, 0x0c], self.numbers.bytes(16)].concat(),
        };
        self.op(&bytes);
    }

    /// An address, or a number of bytes or elements: mostly within the first page.
    fn address(&mut self, depth: usize) {
        if self.numbers.once_in(3) {
            self.value(I32, depth);
            if !self.numbers.once_in(30) {
                self.op(&[vec![0x41], leb(0xff8), vec![0x71]].concat());
            }
        } else {
            let end = if self.numbers.once_in(50) { 8200 } else { 8100 };
            let place = self.numbers.below(end) * 8;
            self.op(&[vec![0x41], leb(place as i64)].concat());
        }
    }

    fn alignment_and_offset(&mut self, most: u8) -> Vec<u8> {
        let offset =
            if self.numbers.once_in(20) { self.numbers.next() as u32 as usize } else { self.numbers.below(64) };
        [vec![self.numbers.between(0, most)], size(offset)].concat()
    }

    /// Leaves a value of the type `kind`.
    fn value(&mut self, kind: usize, depth: usize) {
        self.left = self.left.saturating_sub(1);
        if depth == 0 || self.left == 0 {
            return match self.numbers.below(3) {
                0 => self.constant(kind),
                1 => {
                    let place = self.local(kind);
                    self.op(&[vec![0x20], place].concat());
                }
                _ => self.op(&[0x23, kind as u8]),
            };
        }
        let depth = depth - 1;
        match self.numbers.below(10) {
            0 | 1 => {
                let (operator, of) = self.numbers.of(UNARY[kind]);
                self.value(of, depth);
                self.op(operator);
            }
            2..=4 => self.binary(kind, depth),
            5 => {
                let loads: Vec<_> = LOADS.into_iter().filter(|load| load.2 == kind).collect();
                let (operator, most, _) = self.numbers.of(&loads);
                self.address(depth);
                let rest = self.alignment_and_offset(most);
                self.op(&[operator.to_vec(), rest].concat());
            }
            6 => {
                self.value(kind, depth);
                self.value(kind, depth);
                self.value(I32, depth);
                self.op(&[0x1c, 1, TYPES[kind]]);
            }
            7 => {
                self.value(I32, depth);
                self.op(&[0x04, TYPES[kind]]);
                self.value(kind, depth);
                self.op(&[0x05]);
                self.value(kind, depth);
                self.op(&[0x0b]);
            }
            8 => self.call_for(kind, depth),
            _ => self.value(kind, 0),
        }
    }

    fn binary(&mut self, kind: usize, depth: usize) {
        // comparisons give an i32
        let of = if kind == I32 { self.numbers.of(&[I32, I32, I64, F32, F64]) } else { kind };
        self.value(of, depth);
        self.value(of, depth);
        let is_comparison = kind == I32 && (of != I32 || self.numbers.once_in(3));
        let operator = match (of, is_comparison) {
            (I32, true) => self.numbers.between(0x46, 0x4f),
            (I64, true) => self.numbers.between(0x51, 0x5a),
            (F32, true) => self.numbers.between(0x5b, 0x60),
            (F64, true) => self.numbers.between(0x61, 0x66),
            (I32, _) => self.numbers.between(0x6a, 0x78),
            (I64, _) => self.numbers.between(0x7c, 0x8a),
            (F32, _) => self.numbers.between(0x92, 0x98),
            (F64, _) => self.numbers.between(0xa0, 0xa6),
            _ => {
                let operator = self.numbers.of(&BINARY_OF_VECTORS);
                return self.op(&[&[0xfd], operator].concat());
            }
        };
        self.op(&[operator]);
    }

    /// Calls a function that gives a value of this type, if there is one.
    fn call_for(&mut self, kind: usize, depth: usize) {
        let Some(signature) = SIGNATURES.iter().position(|(_, results)| *results == [kind]) else {
            return self.value(kind, 0);
        };
        self.call(signature, depth);
    }

    /// Calls a function of this signature: mostly one behind this one, so that not all calls go round in circles.
    fn call(&mut self, signature: usize, depth: usize) {
        let Surroundings { functions, own, .. } = self.surroundings;
        let first = if self.numbers.once_in(25) { 0 } else { own + 1 };
        let known: Vec<usize> = (first..functions).filter(|function| function % 4 == signature).collect();
        if known.is_empty() {
            return SIGNATURES[signature].1.iter().for_each(|result| self.constant(*result));
        }
        let function = self.numbers.of(&known);
        SIGNATURES[signature].0.iter().for_each(|argument| self.value(*argument, depth));
        if self.numbers.once_in(4) {
            // through the table, where there is seldom anything else
            self.op(&[vec![0x41], leb(function as i64)].concat());
            self.op(&[0x11, signature as u8, 0]);
        } else {
            self.op(&[vec![0x10], size(function)].concat());
        }
    }

    fn statements(&mut self, depth: usize) {
        for _ in 0..=self.numbers.below(3) {
            self.statement(depth);
        }
    }

    fn statement(&mut self, depth: usize) {
        self.left = self.left.saturating_sub(1);
        match self.numbers.below(if depth == 0 || self.left == 0 { 4 } else { 13 }) {
            0 | 1 => {
                let (operator, most, kind) = self.numbers.of(&STORES);
                self.address(depth);
                self.value(kind, depth + 1);
                let rest = self.alignment_and_offset(most);
                self.op(&[operator.to_vec(), rest].concat());
            }
            2 => {
                let kind = self.numbers.below(5);
                self.value(kind, depth + 1);
                let place = self.local(kind);
                self.op(&[vec![0x21], place].concat());
            }
            3 => {
                let kind = self.numbers.below(5);
                self.value(kind, depth);
                self.op(&[0x24, kind as u8]);
            }
            4 => {
                self.value(I32, depth);
                self.op(&[0x04, 0x40]);
                self.labels += 1;
                self.statements(depth - 1);
                self.op(&[0x05]);
                self.statements(depth - 1);
                self.op(&[0x0b]);
                self.labels -= 1;
            }
            5 | 6 => {
                self.op(&[0x03, 0x40]);
                self.labels += 1;
                self.statements(depth - 1);
                self.value(I32, depth);
                self.op(&[0x0d, 0, 0x0b]);
                self.labels -= 1;
            }
            7 => self.call(0, depth),
            8 => {
                // a table of branches out of some blocks
                let blocks = 1 + self.numbers.below(6);
                self.op(&[0x02, 0x40].repeat(blocks));
                self.value(I32, depth);
                let targets: Vec<u8> = (0..self.numbers.below(12)).map(|_| self.numbers.below(blocks) as u8).collect();
                self.op(&[vec![0x0e], size(targets.len()), targets, vec![0]].concat());
                self.labels += blocks;
                for _ in 0..blocks {
                    self.op(&[0x0b]);
                    self.labels -= 1;
                    self.statement(depth - 1);
                }
            }
            9 | 10 => self.bulk(depth),
            11 => {
                self.value(I32, depth);
                self.op(&[0x04, 0x40]);
                // traps, or leaves a block: this one or one around it
                let label = self.numbers.below(self.labels);
                let leave = if self.numbers.once_in(12) { vec![0x00] } else { [vec![0x0c], size(label)].concat() };
                self.op(&[leave, vec![0x0b]].concat());
            }
            _ => {
                self.value(I32, depth);
                self.op(&[0x40, 0, 0x1a]);
            }
        }
    }

    /// An operation on many bytes of the memory, or on elements of the table.
    fn bulk(&mut self, depth: usize) {
        let segments = self.surroundings.segments;
        let operation = self.numbers.below(if segments > 0 { 8 } else { 6 });
        // values of the stack, and the operator behind them
        let (arguments, operator): (usize, Vec<u8>) = match operation {
            0 => (3, vec![0xfc, 0x0b, 0]),
            1 => (3, vec![0xfc, 0x0a, 0, 0]),
            2 => (3, vec![0xfc, 0x0e, 0, 0]),
            3 => (3, vec![0xfc, 0x0c, 0, 0]),
            4 => {
                // grows the table
                self.op(&[0xd0, 0x70]);
                (1, vec![0xfc, 0x0f, 0, 0x1a])
            }
            5 => {
                // fills the table with one of its elements
                self.address(depth);
                self.op(&[0x41, 1, 0x25, 0]);
                (1, vec![0xfc, 0x11, 0])
            }
            6 => (3, [vec![0xfc, 0x08], size(self.numbers.below(segments)), vec![0]].concat()),
            _ => (0, [vec![0xfc, 0x09], size(self.numbers.below(segments))].concat()),
        };
        for _ in 0..arguments {
            self.address(depth);
        }
        self.op(&operator);
    }
}
