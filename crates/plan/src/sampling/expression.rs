//! [`Expression`]: arithmetic over parameters, such as `0.5 * wheel1.density_kg_m3`.
//!
//! An operator-precedence parser (V. R. Pratt, *Top down operator precedence*, 1973) compiles to a stack machine. No
//! crate fits: names have dots, functions must be those of `libm` for equal bits everywhere, and draws may not
//! allocate. `exmex` uses the platform's functions, `evalexpr` is AGPL, `meval` and `fasteval` are unmaintained.
//!
//! | | |
//! | --- | --- |
//! | operators, weakest first | `or`, `and`, `< <= > >= == !=` (1 or 0), `+ -`, `* /`, unary `-`, `^` |
//! | functions | `sqrt exp ln log10 sin cos tan asin acos atan atan2 abs min max`, `if(condition, yes, no)` |
//! | truth | every number other than 0 |
//! | constants | `pi`, numbers such as `2`, `0.5`, `1e-3` |
//!
//! NaN, unknown, propagates through arithmetic and comparisons. Conditions follow Kleene's three-valued logic: `0 and
//! unknown` is 0, `1 or unknown` is 1. `if` with an unknown condition is unknown, else the chosen part.

mod bounds;

pub const DEEPEST: usize = 32;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Number(f64),
    Variable(usize),
    Negate,
    Binary(Binary),
    Function(Function),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Binary {
    Or,
    And,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
}

/// A function of one or two numbers, compared by name, since its address is not unique.
#[derive(Clone, Copy, Debug)]
enum Function {
    One(&'static str, fn(f64) -> f64),
    Two(&'static str, fn(f64, f64) -> f64),
    If,
}

impl Function {
    fn name(&self) -> &'static str {
        match self {
            Function::One(name, _) | Function::Two(name, _) => name,
            Function::If => "if",
        }
    }

    fn arguments(&self) -> usize {
        match self {
            Function::One(..) => 1,
            Function::Two(..) => 2,
            Function::If => 3,
        }
    }
}

impl PartialEq for Function {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

const FUNCTIONS: [Function; 15] = [
    Function::One("sqrt", f64::sqrt),
    Function::One("exp", libm::exp),
    Function::One("ln", libm::log),
    Function::One("log10", libm::log10),
    Function::One("sin", libm::sin),
    Function::One("cos", libm::cos),
    Function::One("tan", libm::tan),
    Function::One("asin", libm::asin),
    Function::One("acos", libm::acos),
    Function::One("atan", libm::atan),
    Function::Two("atan2", libm::atan2),
    Function::One("abs", f64::abs),
    Function::Two("min", libm::fmin),
    Function::Two("max", libm::fmax),
    Function::If,
];

#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    steps: Vec<Step>,
    variables: Vec<String>,
}

/// Follows `must be`.
pub type ExpressionError = String;

impl Expression {
    /// # Errors
    /// The expected text, and its place.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        let mut parser = Parser { text, at: 0, steps: Vec::new(), variables: Vec::new() };
        parser.expression(0)?;
        parser.space();
        if parser.at < text.len() {
            return Err(parser.expected("an operator or the end"));
        }
        let these = Expression { steps: parser.steps, variables: parser.variables };
        if these.depth() > DEEPEST { Err(format!("nested at most {DEEPEST} deep")) } else { Ok(these) }
    }

    /// Its variables, each once, in the order of their first use.
    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    /// The value for the values of [`Expression::variables`], by index. Allocates nothing.
    pub fn value(&self, variable: impl Fn(usize) -> f64) -> f64 {
        let mut stack = [0.0; DEEPEST + 2];
        let mut top = 0;
        for step in &self.steps {
            match *step {
                Step::Number(number) => {
                    stack[top] = number;
                    top += 1;
                }
                Step::Variable(place) => {
                    stack[top] = variable(place);
                    top += 1;
                }
                Step::Negate => stack[top - 1] = -stack[top - 1],
                Step::Function(Function::One(_, function)) => stack[top - 1] = function(stack[top - 1]),
                Step::Function(Function::Two(_, function)) => {
                    top -= 1;
                    stack[top - 1] = strict([stack[top - 1], stack[top]], function);
                }
                Step::Function(Function::If) => {
                    top -= 2;
                    let condition = stack[top - 1];
                    let chosen = if condition != 0.0 { stack[top] } else { stack[top + 1] };
                    stack[top - 1] = if condition.is_nan() { condition } else { chosen };
                }
                Step::Binary(operator) => {
                    top -= 1;
                    stack[top - 1] = operator.value(stack[top - 1], stack[top]);
                }
            }
        }
        stack[0]
    }

    fn depth(&self) -> usize {
        let (mut top, mut most) = (0, 0);
        for step in &self.steps {
            top = top + 1 - step.operands();
            most = most.max(top);
        }
        most
    }

    /// Evaluates the steps on a stack: `of` combines a step with its operands.
    fn fold<T>(&self, mut of: impl FnMut(&Step, &[T]) -> T) -> Option<T> {
        let mut stack: Vec<T> = Vec::new();
        for step in &self.steps {
            let operands = stack.split_off(stack.len().checked_sub(step.operands())?);
            stack.push(of(step, &operands));
        }
        stack.pop()
    }
}

impl Step {
    fn operands(&self) -> usize {
        match self {
            Step::Number(_) | Step::Variable(_) => 0,
            Step::Negate => 1,
            Step::Binary(_) => 2,
            Step::Function(function) => function.arguments(),
        }
    }
}

/// NaN if either number is: `libm` has min(NaN, 1) = 1 and NaN^0 = 1.
fn strict([a, b]: [f64; 2], function: impl Fn(f64, f64) -> f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { function(a, b) }
}

impl Binary {
    fn value(self, a: f64, b: f64) -> f64 {
        let truth = |is: bool| if is { 1.0 } else { 0.0 };
        let is_true = |number: f64| number != 0.0 && !number.is_nan();
        match self {
            Binary::Or if is_true(a) || is_true(b) => 1.0,
            Binary::And if a == 0.0 || b == 0.0 => 0.0,
            _ => strict([a, b], |a, b| match self {
                Binary::Or => 0.0,
                Binary::And => 1.0,
                Binary::Add => a + b,
                Binary::Subtract => a - b,
                Binary::Multiply => a * b,
                Binary::Divide => a / b,
                Binary::Power => libm::pow(a, b),
                Binary::Less => truth(a < b),
                Binary::LessOrEqual => truth(a <= b),
                Binary::Greater => truth(a > b),
                Binary::GreaterOrEqual => truth(a >= b),
                Binary::Equal => truth(a == b),
                Binary::NotEqual => truth(a != b),
            }),
        }
    }
}

/// Text, meaning, binding strengths on the left and on the right; longer texts first.
const OPERATORS: [(&str, Binary, u8, u8); 13] = [
    ("or", Binary::Or, 1, 2),
    ("and", Binary::And, 3, 4),
    ("<=", Binary::LessOrEqual, 5, 6),
    (">=", Binary::GreaterOrEqual, 5, 6),
    ("==", Binary::Equal, 5, 6),
    ("!=", Binary::NotEqual, 5, 6),
    ("<", Binary::Less, 5, 6),
    (">", Binary::Greater, 5, 6),
    ("+", Binary::Add, 7, 8),
    ("-", Binary::Subtract, 7, 8),
    ("*", Binary::Multiply, 9, 10),
    ("/", Binary::Divide, 9, 10),
    ("^", Binary::Power, 14, 13),
];
/// -x^2 is -(x^2), -x*y is (-x)*y.
const SIGN: u8 = 11;
/// Longer texts could overflow the parser's stack.
const DEEPEST_TEXT: usize = 1000;

struct Parser<'a> {
    text: &'a str,
    at: usize,
    steps: Vec<Step>,
    variables: Vec<String>,
}

impl Parser<'_> {
    fn space(&mut self) {
        self.at += self.rest().len() - self.rest().trim_start().len();
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn expected(&self, what: &str) -> ExpressionError {
        let found = self.rest().chars().next();
        let found = found.map_or("the end".to_owned(), |letter| format!("{letter:?}"));
        format!("an expression: {what} instead of {found} at character {}", self.text[..self.at].chars().count() + 1)
    }

    fn take(&mut self, token: &str) -> bool {
        self.space();
        let is_next = self.rest().starts_with(token);
        if is_next {
            self.at += token.len();
        }
        is_next
    }

    fn expression(&mut self, least: u8) -> Result<(), ExpressionError> {
        if self.text.len() > DEEPEST_TEXT {
            return Err(format!("at most {DEEPEST_TEXT} characters long"));
        }
        self.operand()?;
        loop {
            self.space();
            let is_word = |text: &str| text.starts_with(|letter: char| letter.is_ascii_alphabetic());
            let goes_on = |text: &str| {
                self.rest()[text.len()..].starts_with(|letter: char| letter.is_ascii_alphanumeric() || letter == '_')
            };
            let is_next = |text: &str| self.rest().starts_with(text) && !(is_word(text) && goes_on(text));
            let operator = OPERATORS.iter().find(|(text, ..)| is_next(text));
            let Some(&(text, operator, _, right)) = operator.filter(|(_, _, left, _)| *left >= least) else {
                return Ok(());
            };
            self.at += text.len();
            self.expression(right)?;
            self.steps.push(Step::Binary(operator));
        }
    }

    fn operand(&mut self) -> Result<(), ExpressionError> {
        if self.take("-") {
            self.expression(SIGN)?;
            self.steps.push(Step::Negate);
            return Ok(());
        }
        if self.take("(") {
            self.expression(0)?;
            return if self.take(")") { Ok(()) } else { Err(self.expected("\")\"")) };
        }
        let first = self.rest().chars().next();
        match first {
            Some(letter) if letter.is_ascii_digit() || letter == '.' => self.number(),
            Some(letter) if letter.is_ascii_alphabetic() => self.name(),
            _ => Err(self.expected("a number, a name, \"(\" or \"-\"")),
        }
    }

    fn number(&mut self) -> Result<(), ExpressionError> {
        let rest = self.rest();
        let digits = |from: usize| from + rest[from..].bytes().take_while(u8::is_ascii_digit).count();
        let mut end = digits(0);
        if rest[end..].starts_with('.') {
            end = digits(end + 1);
        }
        if rest[end..].starts_with(['e', 'E']) {
            let sign = usize::from(rest[end + 1..].starts_with(['+', '-']));
            let power = digits(end + 1 + sign);
            if power > end + 1 + sign {
                end = power;
            }
        }
        match rest[..end].parse::<f64>() {
            Ok(number) if number.is_finite() => {
                self.at += end;
                self.steps.push(Step::Number(number));
                Ok(())
            }
            _ => Err(self.expected("a finite number")),
        }
    }

    /// A function, `pi`, or a parameter with a component in brackets.
    fn name(&mut self) -> Result<(), ExpressionError> {
        let letters = |text: &str| text.bytes().take_while(|b| b.is_ascii_alphanumeric() || b"_.".contains(b)).count();
        let mut end = letters(self.rest());
        if self.rest()[end..].starts_with('[')
            && let Some(close) = self.rest()[end..].find(']')
        {
            end += close + 1;
        }
        let start = self.at;
        let name = self.rest()[..end].to_owned();
        self.at += end;
        if name == "pi" {
            self.steps.push(Step::Number(core::f64::consts::PI));
            return Ok(());
        }
        if !self.take("(") {
            let known = self.variables.iter().position(|known| *known == name);
            let place = known.unwrap_or_else(|| {
                self.variables.push(name);
                self.variables.len() - 1
            });
            self.steps.push(Step::Variable(place));
            return Ok(());
        }
        let Some(function) = FUNCTIONS.iter().find(|known| known.name() == name) else {
            self.at = start;
            let names = FUNCTIONS.map(|known| known.name()).join(", ");
            return Err(self.expected(&format!("a function ({names}), not {name:?},")));
        };
        let arguments = function.arguments();
        for argument in 0..arguments {
            if argument > 0 && !self.take(",") {
                return Err(self.expected(&format!("\",\" ({name} takes {arguments})")));
            }
            self.expression(0)?;
        }
        if !self.take(")") {
            return Err(self.expected(&format!("\")\" ({name} takes {arguments})")));
        }
        self.steps.push(Step::Function(*function));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let expression = Expression::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        expression.value(|place| [2.0, 3.0, 5.0][place])
    }

    #[test]
    fn values_are_those_of_arithmetic() {
        for (text, expected) in [
            ("1 + 2 * 3", 7.0),
            ("(1 + 2) * 3", 9.0),
            ("8 - 3 - 2", 3.0),
            ("8 / 4 / 2", 1.0),
            ("2 ^ 3 ^ 2", 512.0),
            ("-2 ^ 2", -4.0),
            ("2 ^ -1", 0.5),
            ("-2 * 3 + 1", -5.0),
            ("a.b * x[1] + wheel1.y_m", 11.0),
            ("a + a * a", 6.0),
            ("1 < 2 and 3 > 2 or 0", 1.0),
            ("1 > 2 and 3 > 2 or 2", 1.0),
            ("1 and (0 or 2 - 2)", 0.0),
            ("0 or 1 and 0", 0.0),
            ("1.5e-3*1E+3", 1.5),
            (".5", 0.5),
            ("max(1, min(4, 3))", 3.0),
            ("if(a < b, 10, 20)", 10.0),
            ("if(a >= b, 10, 20)", 20.0),
            ("(a == 2) + (b != 3)", 1.0),
            ("sqrt(16) + abs(-1)", 5.0),
            ("sin(pi / 2) + cos(0) + atan2(0, 1)", 2.0),
            ("ln(exp(2)) + log10(1000)", 5.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-15, "{text} = {}", value(text));
        }
        assert_eq!(Expression::parse("x.y + z[0] + x.y").map(|e| e.variables), Ok(vec!["x.y".into(), "z[0]".into()]));
    }

    /// Law: conditions follow Kleene's three-valued logic (`n` unknown, `t` true, `f` false); other results of an
    /// unknown number are unknown, and none is once `n` is known.
    #[test]
    fn what_is_computed_from_an_unknown_number_is_unknown() {
        let nan = f64::NAN;
        let of = |text: &str, unknown: f64| {
            let expression = Expression::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"));
            let value = |name: &str| match name {
                "n" => unknown,
                "t" => 2.0,
                _ => 0.0,
            };
            expression.value(|place| value(&expression.variables()[place]))
        };
        for (text, expected) in [
            ("n and t", nan),
            ("f and n", 0.0),
            ("n and n", nan),
            ("t or n", 1.0),
            ("n or f", nan),
            ("n < 1", nan),
            ("1 >= n", nan),
            ("n != 1", nan),
            ("n < 1 and t > 3", 0.0),
            ("n < 1 or t > 1", 1.0),
            ("if(n, 1, 0)", nan),
            ("if(t, 5, n)", 5.0),
            ("if(f, n, 5)", 5.0),
            ("if(t, n, 5)", nan),
            ("min(n, 1)", nan),
            ("max(1, n)", nan),
            ("n ^ 0", nan),
            ("1 ^ n", nan),
            ("0 * n", nan),
            ("-n + 1", nan),
            ("atan2(n, 1)", nan),
            ("if(sqrt(-1 - abs(n)) < 1, 1, 0)", nan),
        ] {
            let found = of(text, nan);
            assert!(found == expected || found.is_nan() && expected.is_nan(), "{text}: {found}");
            let is_never_known = text.contains("sqrt");
            assert_eq!(of(text, 1.0).is_nan(), is_never_known, "{text}");
        }
    }

    #[test]
    fn what_is_no_expression_is_refused_with_its_place() {
        for (text, says) in [
            ("", "instead of the end at character 1"),
            ("1 +", "instead of the end at character 4"),
            ("1 2", "an operator or the end instead of '2' at character 3"),
            ("(1", "\")\" instead of the end at character 3"),
            ("foo(1)", "not \"foo\""),
            ("max(1)", "max takes 2"),
            ("sqrt(1, 2)", "sqrt takes 1"),
            ("1e999", "a finite number"),
            ("a $ b", "instead of '$' at character 3"),
        ] {
            let error = Expression::parse(text).expect_err(text);
            assert!(error.contains(says), "{text}: {error}");
        }
        let deep = format!("{}1{}", "(1+".repeat(40), ")".repeat(40));
        assert_eq!(Expression::parse(&deep).expect_err("too deep"), "nested at most 32 deep");
        assert!(Expression::parse(&"-".repeat(1001)).is_err());
    }
}
