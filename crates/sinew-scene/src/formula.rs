//! Numbers that depend on the position.

use std::fmt;

/// A number as a formula of the position x, y, z (m), such as `75 * sin(pi * z / 0.24) * (y - 0.01)`.
///
/// It may contain numbers, `x`, `y`, `z`, `pi`, `+ - * / ^` with their usual order, round brackets, and `sin`, `cos`,
/// `exp`, `sqrt` and `abs`.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    text: String,
    /// Operations on a stack of numbers.
    operations: Vec<Operation>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Operation {
    Number(f64),
    Coordinate(usize),
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Negate,
    Function(Function),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Function {
    Sin,
    Cos,
    Exp,
    Sqrt,
    Abs,
}

const FUNCTIONS: [(&str, Function); 5] = [
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("exp", Function::Exp),
    ("sqrt", Function::Sqrt),
    ("abs", Function::Abs),
];

/// Largest number of characters of a formula, which also bounds the depth of its brackets.
const LONGEST: usize = 1000;

/// A text that is not a formula.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{found} at character {at} of the formula: expected {expected}")]
pub struct FormulaError {
    /// Number of the character, from 1 on.
    pub at: usize,
    /// The word, number or character there, in quotes, or "the end".
    pub found: String,
    /// Description of the text expected there.
    pub expected: &'static str,
}

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// [`FormulaError`] for the first character that does not fit.
    ///
    /// ```
    /// let formula = sinew_scene::Formula::parse("0.5 * z^2 - sin(pi * x)")?;
    /// assert_eq!(formula.at([0.5, 0.0, 2.0]), 1.0);
    /// # Ok::<(), sinew_scene::FormulaError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        let mut parser = Parser {
            rest: text,
            length: text.chars().count(),
            operations: Vec::new(),
        };
        if parser.length > LONGEST {
            return Err(FormulaError {
                at: LONGEST + 1,
                found: "more".to_owned(),
                expected: "an end: formulas have at most 1000 characters",
            });
        }
        parser.sum()?;
        match parser.peek() {
            None => Ok(Self {
                text: text.trim().to_owned(),
                operations: parser.operations,
            }),
            Some(_) => Err(parser.expected("an operator, a bracket or the end")),
        }
    }

    /// Its value at a position (m), which may be infinite or NaN.
    #[must_use]
    pub fn at(&self, place: [f64; 3]) -> f64 {
        let mut stack: Vec<f64> = Vec::new();
        for operation in &self.operations {
            // The parser leaves each operation its operands.
            let mut take = || stack.pop().unwrap_or(f64::NAN);
            let value = match *operation {
                Operation::Number(number) => number,
                Operation::Coordinate(axis) => place[axis],
                Operation::Negate => -take(),
                Operation::Function(function) => function.of(take()),
                of_two => {
                    let (b, a) = (take(), take());
                    match of_two {
                        Operation::Add => a + b,
                        Operation::Subtract => a - b,
                        Operation::Multiply => a * b,
                        Operation::Divide => a / b,
                        _ => a.powf(b),
                    }
                }
            };
            stack.push(value);
        }
        stack.pop().unwrap_or(f64::NAN)
    }
}

impl From<f64> for Formula {
    fn from(number: f64) -> Self {
        Self {
            text: format!("{number:?}"),
            operations: vec![Operation::Number(number)],
        }
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Function {
    fn of(self, x: f64) -> f64 {
        match self {
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Exp => x.exp(),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
        }
    }
}

/// A recursive-descent parser: sums of products of powers.
struct Parser<'a> {
    rest: &'a str,
    /// Characters of the whole text.
    length: usize,
    operations: Vec<Operation>,
}

impl Parser<'_> {
    fn peek(&mut self) -> Option<char> {
        self.rest = self.rest.trim_start();
        self.rest.chars().next()
    }

    /// Skips the next character if it is this one; true if it was.
    fn takes(&mut self, character: char) -> bool {
        let is_it = self.peek() == Some(character);
        if is_it {
            self.rest = &self.rest[character.len_utf8()..];
        }
        is_it
    }

    fn expected(&self, expected: &'static str) -> FormulaError {
        let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let word = self.rest.find(|c| !is_part(c)).unwrap_or(self.rest.len());
        let one = self.rest.chars().next().map_or(0, char::len_utf8);
        let found = match &self.rest[..word.max(one)] {
            "" => "the end".to_owned(),
            found => format!("`{}`", found.chars().take(40).collect::<String>()),
        };
        FormulaError {
            at: self.length - self.rest.chars().count() + 1,
            found,
            expected,
        }
    }

    fn sum(&mut self) -> Result<(), FormulaError> {
        self.product()?;
        loop {
            let operation = match self.peek() {
                Some('+') => Operation::Add,
                Some('-') => Operation::Subtract,
                _ => return Ok(()),
            };
            self.rest = &self.rest[1..];
            self.product()?;
            self.operations.push(operation);
        }
    }

    fn product(&mut self) -> Result<(), FormulaError> {
        self.signed()?;
        loop {
            let operation = match self.peek() {
                Some('*') => Operation::Multiply,
                Some('/') => Operation::Divide,
                _ => return Ok(()),
            };
            self.rest = &self.rest[1..];
            self.signed()?;
            self.operations.push(operation);
        }
    }

    /// Reads a power with signs before it, which have lower precedence: -x^2 is -(x^2).
    fn signed(&mut self) -> Result<(), FormulaError> {
        let mut is_negative = false;
        loop {
            if self.takes('-') {
                is_negative = !is_negative;
            } else if !self.takes('+') {
                break;
            }
        }
        self.power()?;
        if is_negative {
            self.operations.push(Operation::Negate);
        }
        Ok(())
    }

    fn power(&mut self) -> Result<(), FormulaError> {
        self.atom()?;
        if self.takes('^') {
            self.signed()?;
            self.operations.push(Operation::Power);
        }
        Ok(())
    }

    fn atom(&mut self) -> Result<(), FormulaError> {
        match self.peek() {
            Some('(') => {
                self.rest = &self.rest[1..];
                self.sum()?;
                match self.takes(')') {
                    true => Ok(()),
                    false => Err(self.expected("an operator or `)`")),
                }
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_ascii_alphabetic() => self.name(),
            _ => Err(self.expected("a number, x, y, z, pi, a function or `(`")),
        }
    }

    fn number(&mut self) -> Result<(), FormulaError> {
        let bytes = self.rest.as_bytes();
        let digits = |from: usize| {
            let digits = bytes[from..].iter();
            let is_part = |byte: &&u8| byte.is_ascii_digit() || **byte == b'.';
            from + digits.take_while(is_part).count()
        };
        let mut end = digits(0);
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let exponent = digits(end + 1 + sign);
            if exponent > end + 1 + sign {
                end = exponent;
            }
        }
        let number = self.rest[..end].parse().ok();
        let number = number.filter(|number: &f64| number.is_finite());
        let number = number.ok_or_else(|| self.expected("a finite number"))?;
        self.rest = &self.rest[end..];
        self.operations.push(Operation::Number(number));
        Ok(())
    }

    fn name(&mut self) -> Result<(), FormulaError> {
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let end = self.rest.find(|c| !is_part(c)).unwrap_or(self.rest.len());
        let name = &self.rest[..end];
        let operation = match name {
            "x" => Operation::Coordinate(0),
            "y" => Operation::Coordinate(1),
            "z" => Operation::Coordinate(2),
            "pi" => Operation::Number(std::f64::consts::PI),
            _ => {
                let function = FUNCTIONS.iter().find(|(other, _)| *other == name);
                let Some((_, function)) = function else {
                    return Err(self.expected("x, y, z, pi, sin, cos, exp, sqrt or abs"));
                };
                self.rest = &self.rest[end..];
                if self.peek() != Some('(') {
                    return Err(self.expected("`(` after a function"));
                }
                self.atom()?;
                self.operations.push(Operation::Function(*function));
                return Ok(());
            }
        };
        self.rest = &self.rest[end..];
        self.operations.push(operation);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACE: [f64; 3] = [2.0, 3.0, 5.0];

    #[test]
    fn operators_have_their_usual_order() {
        for (text, value) in [
            ("1 + 2 * 3", 7.0),
            ("(1 + 2) * 3", 9.0),
            ("2 - 3 - 4", -5.0),
            ("24 / 4 / 2", 3.0),
            ("2 ^ 3 ^ 2", 512.0),
            ("-x^2", -4.0),
            ("2^-x", 0.25),
            ("2 * -y", -6.0),
            ("--+z", 5.0),
            (" .5e1*y + 1e-1 ", 15.1),
            ("x*y-z", 1.0),
            ("sqrt(y + 1) * abs(-x)", 4.0),
            ("cos(0) + sin(0) + exp(0)", 2.0),
            ("sin(pi/2)", 1.0),
        ] {
            assert_eq!(Formula::parse(text).unwrap().at(PLACE), value, "{text}");
        }
    }

    #[test]
    fn a_text_that_is_no_formula_is_refused_at_its_place() {
        for (text, at) in [
            ("", 1),
            ("1 +", 4),
            ("(x", 3),
            ("x)", 2),
            ("2 x", 3),
            ("u", 1),
            ("1 + tan(x)", 5),
            ("sin x", 5),
            ("1..2", 1),
            ("1e999", 1),
            ("x * ä", 5),
            ("e", 1),
        ] {
            assert_eq!(Formula::parse(text).unwrap_err().at, at, "{text}");
        }
        for (text, words) in [
            (
                "2 * sinn(z)",
                "`sinn` at character 5 of the formula: expected x, y, z, pi, sin, cos, exp, sqrt or abs",
            ),
            (
                "2 * z)",
                "`)` at character 6 of the formula: expected an operator, a bracket or the end",
            ),
            (
                "2 * ",
                "the end at character 5 of the formula: expected a number, x, y, z, pi, a function or `(`",
            ),
            (
                "1.2.3 + x",
                "`1.2.3` at character 1 of the formula: expected a finite number",
            ),
        ] {
            assert_eq!(Formula::parse(text).unwrap_err().to_string(), words);
        }
        let deep = "(".repeat(5000);
        assert_eq!(Formula::parse(&deep).unwrap_err().at, LONGEST + 1);
    }

    #[test]
    fn a_formula_is_written_as_it_was() {
        assert_eq!(Formula::parse(" 0.5 * z").unwrap().to_string(), "0.5 * z");
        assert_eq!(Formula::from(0.001).to_string(), "0.001");
    }
}
