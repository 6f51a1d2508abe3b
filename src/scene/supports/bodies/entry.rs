//! One entry of `supports`: what its forms are read with.

use crate::scene::defaults;
use crate::scene::request::ReadFile;
use crate::scene::supports::depths::Wish;
use crate::scene::text::{Field, Reader, Span, names};
use glam::{DMat4, DVec2, DVec3};

/// One entry of `supports`.
pub(crate) struct BodyEntry<'a> {
    pub span: &'a Span,
    pub depth: &'a Wish,
    pub read: ReadFile<'a>,
}

impl BodyEntry<'_> {
    /// Lengths above zero that must be there.
    pub(crate) fn sizes<const N: usize>(
        &self,
        reader: &mut Reader,
        fields: [(&Field<f64>, &str); N],
    ) -> Option<[f64; N]> {
        for (field, name) in &fields {
            reader.need(field, name, "this support", self.span);
        }
        let found = fields.map(|(field, name)| reader.positive(field, name));
        let all: Option<Vec<f64>> = found.into_iter().collect();
        all?.try_into().ok()
    }
}

/// The entry's name, or the usual one of its form.
pub(crate) fn name(reader: &mut Reader, field: &Field<String>, usual: &str) -> Option<String> {
    match reader.given(field) {
        Some((name, span)) => names::checked(reader, name, &span, "support"),
        None => Some(usual.to_string()),
    }
}

/// Where a face stands and looks.
pub(crate) fn frame(
    reader: &mut Reader,
    at: &Field<[f64; 3]>,
    facing: &Field<[f64; 2]>,
    lean: &Field<f64>,
) -> Option<DMat4> {
    let at = reader
        .point_field(at, "at")
        .map_or(DVec3::ZERO, |(p, _)| p.into());
    let facing = match reader.point_field(facing, "facing") {
        Some((p, span)) => match DVec2::from(p).try_normalize() {
            Some(way) => way,
            None => {
                let text = "`facing` is (0, 0); it must point somewhere in the ground plane";
                reader.error(&span, text);
                return None;
            }
        },
        None => DVec2::from(defaults::FACING),
    };
    let lean = reader
        .within(lean, "lean", defaults::LEANS)
        .map_or(0.0, |(degrees, _)| degrees.to_radians());
    Some(leaning(at, facing, lean))
}

/// The frame of a face whose lower edge has its middle at `at`, that looks along the unit ground direction `facing` and leans back
/// by `lean` radians (a quarter turn: it lies, face up).
fn leaning(at: DVec3, facing: DVec2, lean: f64) -> DMat4 {
    let ahead = facing.extend(0.0);
    let out = lean.cos() * ahead + lean.sin() * DVec3::Z;
    let up = lean.cos() * DVec3::Z - lean.sin() * ahead;
    DMat4::from_cols(
        up.cross(out).extend(0.0),
        up.extend(0.0),
        out.extend(0.0),
        at.extend(1.0),
    )
}
