//! Numbers on axes and beside a pointer are written by a script, those in texts by `findings::number`: by one rule.

use rquickjs::{Context, Function, Runtime};
use spindrift::findings::number::{trimmed, typeset};
use spindrift::report::figure_files::drawing_scripts;

/// Law: a number has the same letters on an axis as in a sentence, whatever its size, its sign and its digits.
#[test]
fn axes_and_texts_have_one_formatter() {
    let [_, scripts] = drawing_scripts().unwrap();
    let context = Context::full(&Runtime::new().unwrap()).unwrap();
    context.with(|context| {
        context.eval::<(), _>(format!("{scripts}\nglobalThis.readable = readable;")).unwrap();
        let readable: Function<'_> = context.globals().get("readable").unwrap();
        let mut seen = 0;
        for power in -20..20 {
            for mantissa in [1.0, 4.1, 4.2, 9.999_96, 1.234_567_8, 5.000_01] {
                for value in [1.0, -1.0].map(|sign| sign * format!("{mantissa}e{power}").parse::<f64>().unwrap()) {
                    for digits in [3_usize, 4, 5] {
                        let found: String = readable.call((value, digits)).unwrap();
                        assert_eq!(found, typeset(&trimmed(value, digits)), "{value:e} in {digits} digits");
                        seen += 1;
                    }
                }
            }
        }
        assert_eq!(seen, 40 * 6 * 2 * 3);
    });
}
