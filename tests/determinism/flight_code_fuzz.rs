use crate::prelude::*;

use super::assembled_module::section;
use super::flight_code::{BUILT, CAMPAIGN, LATER, example, later, without_own_keys};
use super::whole_rows::{bits, rows};
use rustix::time::{ClockId, clock_gettime};

const SEED: u64 = 20_261_126;
const MODULES: u64 = 250;
const MOST_CPU: f64 = 30.0;

struct Numbers(Uniform);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0.bits()
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| self.next() as u8).collect()
    }
}

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
        match numbers.below(11) {
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
            _ => {
                let other = &shipped[numbers.below(shipped.len())];
                let taken = other[some_section(numbers, &sections(other))].to_vec();
                whole.splice(some_section(numbers, &places), taken);
            }
        }
    }
    whole
}

fn cpu() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

fn is_flown(folder: &ScratchFolder, text: &str) -> bool {
    folder.file("campaign.toml", text);
    match Plan::load(&folder.path("campaign.toml"), Overrides::default()) {
        Ok(plan) => {
            let flown = bits(&rows(&plan, Isa::best(), 0, 3));
            assert!(flown.iter().all(|(status, _)| *status != Status::InternalError), "a panic in a run");
            assert!(flown == bits(&rows(&plan, Isa::best(), 0, 3)), "other rows the second time");
            true
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains("control.module") || text.contains("guidance"), "refused for another reason: {text}");
            false
        }
    }
}

#[test]
fn modules_at_random_are_refused_or_fly() {
    let folder = ScratchFolder::new("flight-code-fuzz");
    let shipped = [BUILT[0], BUILT[1], LATER].map(|file| fs::read(example(file)).unwrap());
    let short = |text: &str, file: &str| {
        let text = text.replace(file, "random.wasm").replace("\"3 min\"", "\"2 s\"");
        text.replace("points = 181", "points = 3")
    };
    let own = short(&CAMPAIGN[..CAMPAIGN.find("[[require]]").unwrap()], BUILT[0]);
    let gyro = short(&later(), LATER);
    let plain = short(&without_own_keys(CAMPAIGN), BUILT[0]);
    let mut outcomes: BTreeMap<(&str, bool), u32> = BTreeMap::new();
    for number in 0..MODULES {
        let seed = SEED.wrapping_mul(0x5851_f42d_4c95_7f2d) ^ number.wrapping_mul(0x2545_f491_4f6c_dd1d);
        let mut numbers = Numbers(Uniform::new(seed));
        let (kind, text, bytes) = match numbers.below(10) {
            0 => ("bytes", &plain, at_random(&mut numbers)),
            _ => {
                let place = numbers.below(shipped.len());
                let text = if place == 2 { &gyro } else { &own };
                ("damaged", text, damaged(&mut numbers, shipped[place].clone(), &shipped))
            }
        };
        std::fs::write(folder.path("random.wasm"), bytes).unwrap();
        let before = cpu();
        *outcomes.entry((kind, is_flown(&folder, text))).or_default() += 1;
        assert!(cpu() - before < MOST_CPU, "module {number}, {kind}: {} s", cpu() - before);
    }
    let expected = [("bytes", false), ("damaged", false), ("damaged", true)];
    assert!(expected.iter().all(|outcome| outcomes.contains_key(outcome)), "{outcomes:?}");
}
