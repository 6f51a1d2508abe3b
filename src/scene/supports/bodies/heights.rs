//! Height fields of waves by formula. The only module that names `exmex`.

use super::grammar;
use crate::scene::defaults;
use crate::scene::text::{Reader, Span, error_at};
use exmex::{Express, FlatEx};

/// Height over the face, millimetres, at x to the right of its middle and y above its lower edge, millimetres.
pub(crate) type Heights = Box<dyn Fn(f64, f64) -> f64>;

/// What a formula of x and y says.
pub(crate) fn formula(reader: &mut Reader, text: &str, span: &Span) -> Option<Heights> {
    if text.len() > defaults::LONGEST_FORMULA {
        let text = format!(
            "the formula has {} characters; the limit is {}",
            text.len(),
            defaults::LONGEST_FORMULA
        );
        reader.error(span, text);
        return None;
    }
    let help = "a formula of x and y in mm, as \"3 * sin(x / 8) + cos(y / 5)\"; angles are radians";
    let plain = match grammar::checked(text) {
        Ok(plain) => plain,
        Err(wrong) => {
            let place = within(reader.text, span, text, wrong.at..wrong.at + wrong.length);
            let problem =
                error_at(&place, wrong.message).help(wrong.help.as_deref().unwrap_or(help));
            reader.problems.push(problem);
            return None;
        }
    };
    let parsed = match exmex::parse::<f64>(&plain) {
        Ok(parsed) => parsed,
        Err(error) => {
            let text = format!("the formula cannot be read: {error}");
            reader.problems.push(error_at(span, text).help(help));
            return None;
        }
    };
    let names: Vec<String> = parsed.var_names().to_vec();
    Some(Box::new(move |x, y| value(&parsed, &names, [x, y])))
}

/// Where `part` of a text stands that is written at `span` of the scene; all of that if it is written with escapes.
fn within(scene: &str, span: &Span, text: &str, part: Span) -> Span {
    let written = scene.get(span.clone()).and_then(|w| w.find(text));
    match written {
        Some(quote) if !part.is_empty() => {
            let start = span.start + quote;
            start + part.start..start + part.end
        }
        _ => span.clone(),
    }
}

fn value(parsed: &FlatEx<f64>, names: &[String], [x, y]: [f64; 2]) -> f64 {
    let values: Vec<f64> = names.iter().map(|n| if n == "x" { x } else { y }).collect();
    parsed.eval(&values).unwrap_or(f64::NAN)
}
