//! What a formula of x and y may say, checked before it is compiled, so that what is wrong is told with its place.

use crate::scene::text::nearest;

/// Functions of one value.
const FUNCTIONS: [&str; 25] = [
    "abs", "signum", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh",
    "acosh", "atanh", "floor", "round", "ceil", "trunc", "fract", "exp", "sqrt", "cbrt", "ln",
    "log2", "log10",
];
/// Functions of two.
const OF_TWO: [&str; 3] = ["min", "max", "atan2"];
/// Constants as people write them, and as they are compiled.
const CONSTANTS: [(&str, &str); 8] = [
    ("pi", "PI"),
    ("PI", "PI"),
    ("π", "PI"),
    ("e", "E"),
    ("E", "E"),
    ("tau", "TAU"),
    ("TAU", "TAU"),
    ("τ", "TAU"),
];
/// Deeper parentheses than a thoughtful formula has.
const DEEPEST: usize = 100;

/// What is wrong with a formula.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wrong {
    /// Byte of the formula, and length there.
    pub at: usize,
    pub length: usize,
    pub message: String,
    pub help: Option<String>,
}

/// The formula in words of the compiler, with all of it in parentheses that needs any.
///
/// # Errors
/// The first place where something else is wanted.
pub(super) fn checked(text: &str) -> Result<String, Wrong> {
    let mut parser = Parser {
        text,
        at: 0,
        depth: 0,
        out: String::new(),
    };
    parser.sum()?;
    match parser.peek() {
        None => Ok(parser.out),
        Some(',') => Err(Wrong {
            help: Some("decimals are written with a point: 2.5".to_owned()),
            ..parser.found("an operator (+ - * / ^) or the end")
        }),
        Some(_) => Err(parser.found("an operator (+ - * / ^) or the end")),
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    out: String,
}

impl<'a> Parser<'a> {
    /// The next character that is no blank.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        rest.trim_start().chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let is_it = self.peek() == Some(wanted);
        if is_it {
            self.at += wanted.len_utf8();
        }
        is_it
    }

    fn put(&mut self, token: &str) {
        self.out.push_str(token);
        self.out.push(' ');
    }

    /// The word, number or character here.
    fn token(&mut self) -> &'a str {
        self.peek();
        let rest = &self.text[self.at..];
        let first = rest.chars().next();
        let length = match first {
            Some(c) if c.is_alphabetic() || c == '_' => rest
                .find(|c: char| !(c.is_alphanumeric() || c == '_'))
                .unwrap_or(rest.len()),
            Some(c) if c.is_ascii_digit() || c == '.' => number_length(rest),
            Some(c) => c.len_utf8(),
            None => 0,
        };
        &rest[..length]
    }

    /// That what is here is not what is wanted.
    fn found(&mut self, wanted: &str) -> Wrong {
        let token = self.token();
        let place = self.text[..self.at].chars().count() + 1;
        let message = match token {
            "" => format!("the formula ends where {wanted} is wanted"),
            _ => format!(
                "the formula cannot be read at its character {place}: `{}` found, {wanted} wanted",
                crate::diag::escaped(token)
            ),
        };
        Wrong {
            at: self.at,
            length: token.len(),
            message,
            help: None,
        }
    }

    /// Operands with operators between them, as far as it goes.
    fn sum(&mut self) -> Result<(), Wrong> {
        loop {
            self.operand()?;
            let token = self.token();
            if !(matches!(token, "+" | "-" | "*" | "/" | "^") || OF_TWO.contains(&token)) {
                return Ok(());
            }
            self.at += token.len();
            self.put(token);
        }
    }

    fn operand(&mut self) -> Result<(), Wrong> {
        const WANTED: &str = "a number, x, y, a function or `(`";
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(Wrong {
                message: format!("the formula is nested more than {DEEPEST} deep"),
                ..self.found(WANTED)
            });
        }
        while let Some(sign @ ('+' | '-')) = self.peek() {
            self.at += 1;
            self.put(if sign == '-' { "-" } else { "+" });
        }
        let token = self.token();
        let first = token.chars().next();
        match first {
            Some('(') => {
                self.at += 1;
                self.put("(");
                self.sum()?;
                self.close()?;
            }
            Some(c) if c.is_ascii_digit() || c == '.' => {
                let Ok(value) = token.parse::<f64>() else {
                    return Err(self.found("a number, as 2.5 or 1e-3,"));
                };
                self.at += token.len();
                // Without an exponent, which the compiler does not know.
                self.put(&format!("{value}"));
            }
            Some(c) if c.is_alphabetic() || c == '_' => self.word(token)?,
            _ => return Err(self.found(WANTED)),
        }
        self.depth -= 1;
        Ok(())
    }

    fn word(&mut self, word: &'a str) -> Result<(), Wrong> {
        if let Some((_, constant)) = CONSTANTS.iter().find(|(name, _)| *name == word) {
            self.at += word.len();
            self.put(constant);
        } else if matches!(word, "x" | "y") {
            self.at += word.len();
            self.put(word);
        } else if FUNCTIONS.contains(&word) || word == "log" {
            self.at += word.len();
            self.put(word);
            self.operand()?;
        } else if OF_TWO.contains(&word) {
            self.at += word.len();
            if !self.take('(') {
                return Err(self.found("`(`"));
            }
            self.put("( (");
            self.sum()?;
            if !self.take(',') {
                return Err(self.found("`,` and a second value"));
            }
            self.put(")");
            self.put(word);
            self.put("(");
            self.sum()?;
            self.close()?;
            self.put(")");
        } else {
            let known = FUNCTIONS
                .iter()
                .chain(&OF_TWO)
                .copied()
                .chain(["pi", "x", "y"]);
            let guess = nearest(word, known).map(|n| format!("did you mean `{n}`?"));
            return Err(Wrong {
                message: format!(
                    "the formula has an unknown name: {}",
                    crate::diag::escaped(word)
                ),
                help: guess,
                ..self.found("x, y or a function")
            });
        }
        Ok(())
    }

    fn close(&mut self) -> Result<(), Wrong> {
        if !self.take(')') {
            return Err(self.found("`)`"));
        }
        self.put(")");
        Ok(())
    }
}

/// Of a number at the beginning: digits, a point, an exponent.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| {
        let rest = &text.as_bytes()[from..];
        from + rest.iter().take_while(|b| b.is_ascii_digit()).count()
    };
    let mut end = digits(0);
    while text[end..].starts_with('.') {
        end = digits(end + 1);
    }
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        let behind = digits(end + 1 + sign);
        if behind > end + 1 + sign {
            end = behind;
        }
    }
    end
}
