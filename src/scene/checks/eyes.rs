//! Eyes: apart from each other, in the open, above the base.

use super::checked::Checked;
use crate::diag::Diagnostic;
use crate::scene::supports::shapes;
use crate::scene::text::{Reader, error_at, short};
use crate::scene::views::{Eye, Stand};
use glam::{DVec2, DVec3};

/// Two views cannot share an eye.
pub(crate) fn pairs(reader: &mut Reader, eyes: &[Eye]) {
    for (j, b) in eyes.iter().enumerate() {
        if let Some(a) = eyes[..j].iter().find(|a| a.stand.is_like(b.stand)) {
            let place = match b.stand {
                Stand::At(_) => "place",
                Stand::Towards(_) => "direction",
            };
            reader.problems.push(
                error_at(&b.span, format!("views \"{}\" and \"{}\" look from the same {place}: one eye cannot see two pictures", a.view, b.view))
                    .label(format!("also the eye of \"{}\"", a.view))
                    .help("move one eye, or show both models in one view: `models: [\"a\", \"b\"]`"),
            );
        }
    }
}

/// Every eye must be where it sees the forest.
pub(crate) fn places(reader: &mut Reader, checked: &Checked, eyes: &[Eye]) {
    for eye in eyes {
        let problem = match eye.stand {
            Stand::At(at) => place(eye, at, checked, reader.unit_name),
            Stand::Towards(from) => below(eye, from, checked),
        };
        reader.problems.extend(problem);
    }
}

/// An eye must stand in the open, at a distance, above the base.
fn place(eye: &Eye, at: DVec3, checked: &Checked, unit: &str) -> Option<Diagnostic> {
    let base = checked.base;
    let ground = at.truncate();
    let thickness = base.map_or(0.0, |b| b.thickness);
    if let Some(base) = base {
        if at.z < -thickness {
            return Some(
                error_at(
                    &eye.span,
                    format!(
                        "the eye of view \"{}\" is below the base: it sees only the underside",
                        eye.view
                    ),
                )
                .help("z points up; the top of the base is z = 0"),
            );
        }
        if at.z <= 0.0 && shapes::contains(&base.outline, ground) {
            return Some(error_at(
                &eye.span,
                format!("the eye of view \"{}\" is inside the base", eye.view),
            ));
        }
    }
    let (distance, nearest) = nearest(checked, ground)?;
    let tops = checked.pillars.iter().map(|p| p.height);
    let tops = tops.chain(checked.room.map(|r| r.tops)).fold(0.0, f64::max);
    if at.z > tops || distance > 20.0 {
        return None;
    }
    let where_ = if distance <= 0.0 {
        "inside".to_string()
    } else {
        format!("{} mm from", short(distance))
    };
    let mut problem = error_at(
        &eye.span,
        format!("the eye of view \"{}\" is {where_} {nearest}", eye.view),
    )
    .label("an eye stands outside the forest, some hundred mm away");
    if at.length() < 20.0 {
        problem = problem.help(format!("eyes are in {unit} like the rest of the scene: did you mean metres? Then write them times 1000"));
    }
    Some(problem)
}

/// An eye at infinity must not look from below, nor find its pillars to be found.
fn below(eye: &Eye, from: DVec3, checked: &Checked) -> Option<Diagnostic> {
    if checked.base.is_some() && from.z < 0.0 {
        let text = format!(
            "view \"{}\" looks from below the base: it sees only the underside",
            eye.view
        );
        return Some(
            error_at(&eye.span, text)
                .help("z points up: `from: (0, -1, 0.2)` is from the front and a little above"),
        );
    }
    if checked.mend || checked.room.is_some() {
        let text = format!(
            "view \"{}\" looks from infinity: pillars are found and mended only for eyes with a place",
            eye.view
        );
        return Some(error_at(&eye.span, text).help("give it an `eye: (x, y, z)` some metres away, keep the layout that is found, and include it with `pillars: File(\"layout.ron\")`"));
    }
    None
}

/// What stands nearest to a point in plan, and how far away, millimetres.
fn nearest(checked: &Checked, p: DVec2) -> Option<(f64, String)> {
    let pillars = checked.pillars.iter();
    let pillar = pillars
        .map(|s| (shapes::gap_to_point(&s.profile, p), s))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let room = checked.room.map(|r| shapes::gap_to_point(&r.region, p));
    match (pillar, room) {
        (pillar, Some(gap)) if pillar.is_none_or(|(g, _)| gap < g) => {
            Some((gap, "the region of the pillars".to_string()))
        }
        (pillar, _) => pillar.map(|(gap, s)| (gap, format!("pillar {}", s.name))),
    }
}
