//! Properties of an expression's values that follow from its text: condition, total function, range.

use super::{Binary, Expression, Function, Step};

const ANYTHING: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl Expression {
    /// True if it is a condition: comparisons, joined by `and` and `or`, chosen by `if`, or the numbers 0 and 1.
    pub fn is_condition(&self) -> bool {
        let are_conditions = |operands: &[bool]| operands.iter().all(|is_condition| *is_condition);
        let of = |step: &Step, operands: &[bool]| match step {
            Step::Number(number) => *number == 0.0 || *number == 1.0,
            Step::Binary(Binary::Or | Binary::And) | Step::Function(Function::If) => are_conditions(operands),
            Step::Binary(operator) => operator.compares(),
            Step::Variable(_) | Step::Negate | Step::Function(_) => false,
        };
        self.fold(of) == Some(true)
    }

    /// True if it is a number wherever its variables are (barring overflow): it has no quotient, power, root or
    /// logarithm.
    pub fn is_total(&self) -> bool {
        const TOTAL: [&str; 5] = ["sin", "cos", "tan", "atan", "abs"];
        self.steps.iter().all(|step| match step {
            Step::Binary(operator) => !matches!(operator, Binary::Divide | Binary::Power),
            Step::Function(Function::One(name, _)) => TOTAL.contains(name),
            _ => true,
        })
    }

    /// A range that holds every value, by interval arithmetic over the ranges of the variables (each occurrence counts
    /// as a variable of its own). Functions other than `abs`, powers and quotients can be anything.
    pub fn range(&self, variable: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
        let of = |step: &Step, operands: &[[f64; 2]]| {
            let range = match (step, operands) {
                (Step::Number(number), _) => [*number; 2],
                (Step::Variable(place), _) => variable(*place),
                (Step::Negate, [[low, high]]) => [-high, -low],
                (Step::Binary(operator), [left, right]) => operator.range(*left, *right),
                (Step::Function(Function::One("abs", _)), [[low, high]]) => {
                    let least = if *low <= 0.0 && *high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
                    [least, low.abs().max(high.abs())]
                }
                (Step::Function(Function::If), [_, yes, no]) => [no[0].min(yes[0]), no[1].max(yes[1])],
                _ => ANYTHING,
            };
            if range.iter().any(|end| end.is_nan()) { ANYTHING } else { range }
        };
        self.fold(of).unwrap_or(ANYTHING)
    }
}

impl Binary {
    /// True if its value is 1 or 0 by comparison.
    fn compares(self) -> bool {
        use Binary::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual, NotEqual};
        matches!(self, Less | LessOrEqual | Greater | GreaterOrEqual | Equal | NotEqual)
    }

    fn range(self, a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
        let truth = |always: bool, never: bool| [f64::from(u8::from(always)), f64::from(u8::from(!never))];
        // x < y for all, and for none
        let less = |x: [f64; 2], y: [f64; 2]| truth(x[1] < y[0], x[0] >= y[1]);
        let at_most = |x: [f64; 2], y: [f64; 2]| truth(x[1] <= y[0], x[0] > y[1]);
        let is_apart = a[1] < b[0] || b[1] < a[0];
        let is_same = a[0] == a[1] && a == b;
        let (is_true, is_zero) = (|x: [f64; 2]| x[0] > 0.0 || x[1] < 0.0, |x: [f64; 2]| x == [0.0, 0.0]);
        match self {
            Binary::Or => truth(is_true(a) || is_true(b), is_zero(a) && is_zero(b)),
            Binary::And => truth(is_true(a) && is_true(b), is_zero(a) || is_zero(b)),
            Binary::Add => [a[0] + b[0], a[1] + b[1]],
            Binary::Subtract => [a[0] - b[1], a[1] - b[0]],
            Binary::Multiply => {
                let products = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
                // zero times infinity is unknown
                let is_known = products.iter().all(|product| !product.is_nan());
                let least = products.iter().copied().fold(f64::INFINITY, f64::min);
                if is_known { [least, products.iter().copied().fold(f64::NEG_INFINITY, f64::max)] } else { ANYTHING }
            }
            Binary::Divide | Binary::Power => ANYTHING,
            Binary::Less => less(a, b),
            Binary::LessOrEqual => at_most(a, b),
            Binary::Greater => less(b, a),
            Binary::GreaterOrEqual => at_most(b, a),
            Binary::Equal => truth(is_same, is_apart),
            Binary::NotEqual => truth(is_apart, is_same),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a number is none, whatever is done with it.
    #[test]
    fn conditions_are_comparisons() {
        for text in ["a < 1", "a < 1 and b > 2 or c == 3", "1", "if(a < 1, b < 2, 0)", "-a <= abs(b)", "(a != 1)"] {
            assert!(Expression::parse(text).expect(text).is_condition(), "{text}");
        }
        for text in
            ["a", "a and b < 1", "a < 1 or b", "-(a < 1)", "abs(a < 1)", "2", "if(a < 1, b, 1)", "(a < 1) + (b < 1)"]
        {
            assert!(!Expression::parse(text).expect(text).is_condition(), "{text}");
        }
    }

    #[test]
    fn what_is_total_has_a_value() {
        for text in ["a", "-a + 2 * b", "if(a < b and b > 1, sin(a), atan2(a, b))", "min(abs(a), cos(b))"] {
            assert!(Expression::parse(text).expect(text).is_total(), "{text}");
        }
        for text in
            ["1 / a", "a ^ 0.5", "sqrt(a)", "ln(a)", "log10(a)", "asin(a)", "if(a < acos(b), 1, 0)", "exp(a) - exp(b)"]
        {
            assert!(!Expression::parse(text).expect(text).is_total(), "{text}");
        }
    }

    /// Law: the range holds every value, and excludes impossible ones; it is exact if every variable occurs once.
    #[test]
    fn ranges_hold_every_value() {
        let ranges = [[0.0, f64::INFINITY], [0.0, 2.0], [-3.0, -1.0]];
        for (text, expected) in [
            ("a < 0", [0.0, 0.0]),
            ("a <= 0", [0.0, 1.0]),
            ("a >= 0", [1.0, 1.0]),
            ("b > 2", [0.0, 0.0]),
            ("b >= 2 or a < 0", [0.0, 1.0]),
            ("b < 3 and a < 0", [0.0, 0.0]),
            ("b - c > 5", [0.0, 0.0]),
            ("b - c >= 5", [0.0, 1.0]),
            ("2 * b + 1", [1.0, 5.0]),
            ("b * c", [-6.0, 0.0]),
            ("abs(c)", [1.0, 3.0]),
            ("abs(b - 1)", [0.0, 1.0]),
            ("-b", [-2.0, 0.0]),
            ("b == 3", [0.0, 0.0]),
            ("b != 3", [1.0, 1.0]),
            ("if(b < 1, b, c)", [-3.0, 2.0]),
            ("sin(b) > 2", [0.0, 1.0]),
            ("a - a < 0", [0.0, 1.0]),
            ("0 * a < 0", [0.0, 1.0]),
        ] {
            let expression = Expression::parse(text).expect(text);
            let place = |place: usize| ["a", "b", "c"].iter().position(|name| expression.variables()[place] == *name);
            let range = expression.range(|at| ranges[place(at).expect("a name")]);
            assert_eq!(range, expected, "{text}");
            for a in [0.0, 0.5, 1e9] {
                for (b, c) in [(0.0, -3.0), (1.0, -2.0), (2.0, -1.0)] {
                    let value = expression.value(|at| [a, b, c][place(at).expect("a name")]);
                    assert!((range[0]..=range[1]).contains(&value), "{text}: {value} of {range:?}");
                }
            }
        }
    }
}
