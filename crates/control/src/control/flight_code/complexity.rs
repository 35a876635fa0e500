//! [`check`]: limits on modules, so that they compile in seconds.
//!
//! Compile time and memory grow with the product of a function's blocks and locals and with the square of its blocks.
//! Flight code as compilers make it is below these limits.

use wasmparser::{CompositeInnerType, FunctionBody, Operator, Parser, Payload, SubType};
use wasmtime::{Result, bail};

/// Most bytes of all function bodies.
const MOST_CODE: usize = 512 << 10;
const MOST_FUNCTIONS: u32 = 5_000;
/// Most locals of a function.
const MOST_LOCALS: u64 = 1_000;
/// Most nested blocks, loops and conditions.
const MOST_NESTED: u64 = 1_000;
/// Most targets of all branch tables.
const MOST_TARGETS: u64 = 20_000;
/// Most data and element segments, each of which is code run by an instance at its start: 45,000 of data take half a
/// minute and over a gigabyte.
const MOST_SEGMENTS: u64 = 2_000;
/// Most parameters and results of all types plus those of all functions, for each of which the compiler makes code:
/// 4,000 types of 990 took 103 s and 618 MB.
const MOST_PASSED: u64 = 100_000;
/// Largest sum of squared block counts, that of one function of 5,000 (some seconds); 10,000 loops take nine.
const MOST_SQUARES: u64 = 25_000_000;
/// Largest sum of blocks times locals (some seconds).
const MOST_VALUES: u64 = 3_000_000;

/// Checks the code of a valid module.
///
/// # Errors
/// The exceeded limit.
pub fn check(bytes: &[u8]) -> Result<()> {
    let (mut counted, mut segments, mut passed) = ([0; 3], 0, 0);
    let mut types = Vec::new();
    for payload in Parser::new(0).parse_all(bytes) {
        match payload? {
            Payload::TypeSection(groups) => {
                for group in groups {
                    types.extend(group?.types().map(passed_by));
                }
                passed += types.iter().sum::<u64>();
            }
            Payload::FunctionSection(functions) => {
                for function in functions {
                    passed += types.get(function? as usize).copied().unwrap_or(0);
                }
            }
            Payload::CodeSectionStart { count, .. } if count > MOST_FUNCTIONS => {
                bail!("{count} functions are more than {MOST_FUNCTIONS}")
            }
            Payload::CodeSectionStart { size, .. } if size as usize > MOST_CODE => {
                bail!("{size} bytes of code are more than {MOST_CODE}")
            }
            Payload::CodeSectionEntry(body) => {
                counts(&body)?.into_iter().zip(&mut counted).for_each(|(one, all)| *all += one);
            }
            Payload::DataSection(list) => segments += u64::from(list.count()),
            Payload::ElementSection(list) => segments += u64::from(list.count()),
            _ => {}
        }
    }
    let [targets, values, squares] = counted;
    for (found, most, before, after) in [
        (passed, MOST_PASSED, "its types and functions have ", "parameters and results in all, which are"),
        (segments, MOST_SEGMENTS, "", "segments of data and elements are"),
        (squares, MOST_SQUARES, "the squares of the blocks of its functions are ", "in all, which is"),
        (values, MOST_VALUES, "its functions have ", "blocks times locals in all, which are"),
        (targets, MOST_TARGETS, "", "targets in tables of branches are"),
    ] {
        if found > most {
            bail!("{before}{found} {after} more than {most}");
        }
    }
    Ok(())
}

/// Number of parameters and results of a function type; 1 for other types.
fn passed_by(of: &SubType) -> u64 {
    match &of.composite_type.inner {
        CompositeInnerType::Func(function) => (function.params().len() + function.results().len()) as u64,
        _ => 1,
    }
}

/// Branch targets, blocks times locals, and squared blocks of a function whose locals are within their own limit.
fn counts(body: &FunctionBody<'_>) -> Result<[u64; 3]> {
    let mut locals = 0;
    for declared in body.get_locals_reader()? {
        locals += u64::from(declared?.0);
    }
    if locals > MOST_LOCALS {
        bail!("a function of {locals} locals has more than {MOST_LOCALS}");
    }
    let (mut nested, mut blocks, mut targets) = (0_u64, 0, 0);
    for operator in body.get_operators_reader()? {
        match operator? {
            Operator::Block { .. } | Operator::Loop { .. } | Operator::If { .. } => {
                nested += 1;
                blocks += 1;
            }
            Operator::End => nested = nested.saturating_sub(1),
            Operator::BrTable { targets: table } => targets += u64::from(table.len()),
            _ => {}
        }
        if nested > MOST_NESTED {
            bail!("more than {MOST_NESTED} blocks are within each other");
        }
    }
    Ok([targets, blocks * (1 + locals), blocks * blocks])
}
