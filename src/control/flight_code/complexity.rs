//! [`check`]: whether a module is simple enough to be compiled in seconds.
//!
//! A compiler's time and memory grow faster than the code: with the product of blocks and locals where one follows from the other. Code of compilers is far
//! below these limits.

use wasmparser::{FunctionBody, Operator, Parser, Payload};
use wasmtime::{Result, bail};

/// Most bytes of the bodies of all functions.
const MOST_CODE: usize = 512 << 10;
const MOST_FUNCTIONS: u32 = 5_000;
/// Most locals of a function.
const MOST_LOCALS: u64 = 1_000;
/// Most blocks, loops and conditions within each other.
const MOST_NESTED: u64 = 256;
/// Most targets of all tables of branches.
const MOST_TARGETS: u64 = 20_000;

/// Checks the code of a module that is valid.
///
/// # Errors
/// Which limit it exceeds.
pub fn check(bytes: &[u8]) -> Result<()> {
    let mut targets = 0;
    for payload in Parser::new(0).parse_all(bytes) {
        match payload? {
            Payload::CodeSectionStart { count, .. } if count > MOST_FUNCTIONS => {
                bail!("{count} functions are more than {MOST_FUNCTIONS}")
            }
            Payload::CodeSectionStart { size, .. } if size as usize > MOST_CODE => {
                bail!("{size} bytes of code are more than {MOST_CODE}")
            }
            Payload::CodeSectionEntry(body) => targets += targets_of(&body)?,
            _ => {}
        }
    }
    if targets > MOST_TARGETS {
        bail!("{targets} targets in tables of branches are more than {MOST_TARGETS}");
    }
    Ok(())
}

/// The number of targets in the tables of branches of a function whose locals and blocks are within their limits.
fn targets_of(body: &FunctionBody<'_>) -> Result<u64> {
    let mut locals = 0;
    for declared in body.get_locals_reader()? {
        locals += u64::from(declared?.0);
    }
    if locals > MOST_LOCALS {
        bail!("a function of {locals} locals has more than {MOST_LOCALS}");
    }
    let (mut nested, mut targets) = (0_u64, 0);
    for operator in body.get_operators_reader()? {
        match operator? {
            Operator::Block { .. } | Operator::Loop { .. } | Operator::If { .. } => nested += 1,
            Operator::End => nested = nested.saturating_sub(1),
            Operator::BrTable { targets: table } => targets += u64::from(table.len()),
            _ => {}
        }
        if nested > MOST_NESTED {
            bail!("more than {MOST_NESTED} blocks are within each other");
        }
    }
    Ok(targets)
}
