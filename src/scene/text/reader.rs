//! From raw values to checked ones.
//!
//! A [`Reader`] collects every problem of one text; asking it for a value either gives it or notes why not.

use super::explain::explain;
use super::place::{Span, error_at, placed};
use super::spanned::{Field, Spanned};
use super::wanted::Wanted;
use super::wording::short;
use crate::diag::Diagnostic;
use crate::scene::defaults;

/// Collects the problems of one text.
pub(crate) struct Reader<'a> {
    pub text: &'a str,
    /// What the text is: a "scene" or a "layout".
    pub what: &'static str,
    pub problems: Vec<Diagnostic>,
    /// Millimetres per unit of the scene.
    pub unit: f64,
    pub unit_name: &'static str,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(text: &'a str, what: &'static str) -> Self {
        Self {
            text,
            what,
            problems: Vec::new(),
            unit: 1.0,
            unit_name: "mm",
        }
    }

    /// Where a value stands.
    pub(crate) fn span<T>(&self, spanned: &Spanned<T>) -> Span {
        let start = spanned
            .address
            .saturating_sub(self.text.as_ptr() as usize)
            .min(self.text.len());
        start..(start + spanned.length).min(self.text.len())
    }

    /// What became of a file that the scene names at `span`.
    pub(crate) fn read<T>(&mut self, done: Result<T, Diagnostic>, span: &Span) -> Option<T> {
        done.map_err(|problem| self.problems.push(placed(problem, span)))
            .ok()
    }

    pub(crate) fn error(&mut self, span: &Span, message: impl Into<String>) {
        self.problems.push(error_at(span, message));
    }

    /// The value if it could be read; otherwise its problem is noted.
    pub(crate) fn value<'v, T: Wanted>(&mut self, spanned: &'v Spanned<T>) -> Option<&'v T> {
        match &spanned.value {
            Ok(value) => Some(value),
            Err(error) => {
                let span = self.span(spanned);
                let found = explain(self.text, self.what, &span, error, T::WANTED);
                self.problems.extend(found);
                None
            }
        }
    }

    /// The value and place of a field if it is there and right.
    pub(crate) fn given<'v, T: Wanted>(&mut self, field: &'v Field<T>) -> Option<(&'v T, Span)> {
        match field {
            Field::Missing => None,
            Field::Given(spanned) => {
                let span = self.span(spanned);
                self.value(spanned).map(|value| (value, span))
            }
        }
    }

    /// As `given`, but a missing field is an error of `owner` ("view \"front\""), which stands at `place`.
    pub(crate) fn required<'v, T: Wanted>(
        &mut self,
        field: &'v Field<T>,
        name: &str,
        owner: &str,
        place: &Span,
    ) -> Option<(&'v T, Span)> {
        self.need(field, name, owner, place);
        self.given(field)
    }

    /// Notes an error if the field is missing.
    pub(crate) fn need<T: Wanted>(
        &mut self,
        field: &Field<T>,
        name: &str,
        owner: &str,
        place: &Span,
    ) {
        if matches!(field, Field::Missing) {
            let head = head_of(self.text, place);
            self.problems.push(
                error_at(&head, format!("{owner} has no `{name}`"))
                    .label(format!("`{name}` is missing here"))
                    .help(format!("add `{name}: ...`: {}", T::WANTED)),
            );
        }
    }

    /// A number that is neither NaN nor infinite.
    pub(crate) fn number(&mut self, field: &Field<f64>, name: &str) -> Option<(f64, Span)> {
        let (&value, span) = self.given(field)?;
        Some((self.finite(value, name, &span)?, span))
    }

    /// The number, if it is neither NaN nor infinite.
    pub(crate) fn finite(&mut self, value: f64, name: &str, span: &Span) -> Option<f64> {
        if value.is_finite() {
            return Some(value);
        }
        self.error(
            span,
            format!("`{name}` must be a finite number, found {value}"),
        );
        None
    }

    /// A number without unit, or an angle in degrees, within a range.
    pub(crate) fn within(
        &mut self,
        field: &Field<f64>,
        name: &str,
        range: std::ops::RangeInclusive<f64>,
    ) -> Option<(f64, Span)> {
        let (value, span) = self.number(field, name)?;
        if range.contains(&value) {
            return Some((value, span));
        }
        let (least, most) = (range.start(), range.end());
        self.error(
            &span,
            format!("`{name}` is {value}; it must be from {least} to {most}"),
        );
        None
    }

    /// A length in millimetres, signed, within ten metres.
    pub(crate) fn length(&mut self, field: &Field<f64>, name: &str) -> Option<(f64, Span)> {
        let (value, span) = self.number(field, name)?;
        let value = self.scaled(value, name, &span)?;
        Some((value, span))
    }

    /// A length of at least `least` millimetres.
    pub(crate) fn length_from(
        &mut self,
        field: &Field<f64>,
        name: &str,
        least: f64,
    ) -> Option<(f64, Span)> {
        let (&value, span) = self.given(field)?;
        let value = self.measured(value, name, least, &span)?;
        Some((value, span))
    }

    /// A number at `span` as a length of at least `least` millimetres.
    pub(crate) fn measured(
        &mut self,
        value: f64,
        name: &str,
        least: f64,
        span: &Span,
    ) -> Option<f64> {
        let value = self.finite(value, name, span)?;
        let value = self.scaled(value, name, span)?;
        if value >= least {
            return Some(value);
        }
        let wanted = if least > 0.0 {
            format!("be at least {least} mm")
        } else {
            "not be negative".to_string()
        };
        self.error(
            span,
            format!("`{name}` is {} mm; it must {wanted}", short(value)),
        );
        None
    }

    /// A length above zero.
    pub(crate) fn positive(&mut self, field: &Field<f64>, name: &str) -> Option<f64> {
        self.positive_at(field, name).map(|(value, _)| value)
    }

    /// A length above zero, or the usual one if it is not given.
    pub(crate) fn positive_or(
        &mut self,
        field: &Field<f64>,
        name: &str,
        usual: f64,
    ) -> Option<f64> {
        match field {
            Field::Missing => Some(usual),
            field => self.positive(field, name),
        }
    }

    /// A length above zero and its place.
    pub(crate) fn positive_at(&mut self, field: &Field<f64>, name: &str) -> Option<(f64, Span)> {
        let (value, span) = self.length(field, name)?;
        if value > 0.0 {
            return Some((value, span));
        }
        self.error(
            &span,
            format!("`{name}` is {value} mm; it must be more than 0"),
        );
        None
    }

    /// An angle given in degrees, radians; 0 if it is not given.
    pub(crate) fn turn(&mut self, field: &Field<f64>) -> f64 {
        self.number(field, "turn")
            .map_or(0.0, |(degrees, _)| degrees.to_radians())
    }

    /// Yes or no, or what holds if the text says neither.
    pub(crate) fn flag(&mut self, field: &Field<bool>, default: bool) -> bool {
        self.given(field).map_or(default, |(value, _)| *value)
    }

    /// A point in millimetres.
    pub(crate) fn point<const N: usize>(
        &mut self,
        values: &[f64; N],
        name: &str,
        span: &Span,
    ) -> Option<[f64; N]> {
        if let Some(bad) = values.iter().find(|v| !v.is_finite()) {
            self.error(
                span,
                format!("`{name}` has a coordinate that is not a finite number: {bad}"),
            );
            return None;
        }
        let mut scaled = [0.0; N];
        for (to, from) in scaled.iter_mut().zip(values) {
            *to = self.scaled(*from, name, span)?;
        }
        Some(scaled)
    }

    /// A field that is a point, in millimetres.
    pub(crate) fn point_field<const N: usize>(
        &mut self,
        field: &Field<[f64; N]>,
        name: &str,
    ) -> Option<([f64; N], Span)>
    where
        [f64; N]: Wanted,
    {
        let (values, span) = self.given(field)?;
        let point = self.point(values, name, &span)?;
        Some((point, span))
    }

    /// A whole number within a range.
    pub(crate) fn count(
        &mut self,
        field: &Field<u32>,
        name: &str,
        range: std::ops::RangeInclusive<u32>,
    ) -> Option<(u32, Span)> {
        let (&value, span) = self.given(field)?;
        if range.contains(&value) {
            return Some((value, span));
        }
        let wanted = match *range.end() {
            u32::MAX => format!("at least {}", range.start()),
            end => format!("from {} to {end}", range.start()),
        };
        self.error(&span, format!("`{name}` is {value}; it must be {wanted}"));
        None
    }

    fn scaled(&mut self, value: f64, name: &str, span: &Span) -> Option<f64> {
        let scaled = value * self.unit;
        if scaled.abs() <= defaults::LARGEST {
            return Some(scaled);
        }
        let metres = match self.unit_name {
            "m" => String::new(),
            _ => format!(", that is {} m", short(scaled / 1000.0)),
        };
        self.error(
            span,
            format!(
                "`{name}` is {value} {}{metres}; scenes end at 10 m",
                self.unit_name
            ),
        );
        None
    }
}

/// The first token of what stands at `place`, with its bracket.
fn head_of(text: &str, place: &Span) -> Span {
    let slice = &text[place.clone()];
    let end = slice.find(['(', '[']).map_or(slice.len().min(1), |i| i + 1);
    place.start..place.start + end
}
