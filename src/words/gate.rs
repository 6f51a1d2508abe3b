//! What [`gate`](crate::mesh::gate) did to a model and could not do, and what [`size`](crate::mesh::size) doubts.

use crate::diag::{Diagnostic, Place};
use crate::mesh::gate::{Corrections, Gated, Refusal};
use crate::mesh::size::{SizeDoubt, SizeDoubtKind};
use glam::DVec3;

/// An error: the model of the file cannot be looked at.
pub fn refused(file: &str, why: Refusal) -> Diagnostic {
    let message = match why {
        Refusal::NoFaces => "the model has no faces".to_owned(),
        Refusal::NotFinite => "the model has a coordinate that is not a finite number".to_owned(),
        Refusal::NoExtent => "the model has no extent: all its points are in one place".to_owned(),
        Refusal::NoThickness(DVec3 { x, y, z }) => {
            format!("the model has no thickness: {x} x {y} x {z} mm")
        }
        Refusal::AllDegenerate => "all faces of the model are degenerate".to_owned(),
    };
    Diagnostic::error(message).at(Place::File(file.to_owned()))
}

/// One warning of all that was done or left; none if the model was sound.
pub fn repaired(file: &str, gated: &Gated) -> Option<Diagnostic> {
    let (done, left) = (done(&gated.corrections), left(gated));
    let mut message = String::new();
    if !done.is_empty() {
        message = format!("repaired on loading: {}", done.join(", "));
    }
    if !left.is_empty() {
        let joint = if done.is_empty() { "" } else { "; " };
        message = format!(
            "{message}{joint}not a sound closed surface: {}",
            left.join("; ")
        );
    }
    if message.is_empty() {
        return None;
    }
    let warning = Diagnostic::warning(message).at(Place::File(file.to_owned()));
    Some(match left.is_empty() {
        true => warning,
        false => warning.help("a view can show it all the same; it could not be printed as it is"),
    })
}

fn done(corrections: &Corrections) -> Vec<String> {
    let Corrections {
        stray,
        cracks,
        repeated,
        duplicates,
        turned,
        outwards,
    } = *corrections;
    let done = [
        (
            "dropped",
            stray,
            "vertex that no face uses",
            "vertices that no face uses",
        ),
        (
            "joined",
            cracks,
            "vertex across a crack",
            "vertices across cracks",
        ),
        (
            "dropped",
            repeated,
            "face that repeats a vertex",
            "faces that repeat a vertex",
        ),
        ("dropped", duplicates, "duplicate face", "duplicate faces"),
        (
            "turned",
            turned,
            "face to match its neighbours",
            "faces to match their neighbours",
        ),
        (
            "turned",
            outwards,
            "closed surface outwards",
            "closed surfaces outwards",
        ),
    ];
    let done = done.iter().filter(|(_, count, ..)| *count > 0);
    done.map(|(verb, count, one, many)| {
        let noun = if *count == 1 { one } else { many };
        format!("{verb} {count} {noun}")
    })
    .collect()
}

fn left(gated: &Gated) -> Vec<String> {
    let mut left: Vec<String> = gated.defects.iter().map(ToString::to_string).collect();
    let needles = gated.needles;
    if needles > 0 {
        let noun = if needles == 1 { "face" } else { "faces" };
        left.push(format!("{needles} needle-thin {noun}"));
    }
    left
}

/// A warning: the model may be saved in another unit, or too far off.
pub fn doubted(file: &str, doubt: SizeDoubt) -> Diagnostic {
    let SizeDoubt { kind, side: l } = doubt;
    let side = three_digits(l);
    let message = match kind {
        SizeDoubtKind::Dust => format!(
            "the model is {side} mm long, less than a printable file can hold: in which unit was it saved?"
        ),
        SizeDoubtKind::Metres => format!(
            "the model is {side} mm long: saved in metres? That would be {} mm",
            three_digits(l * 1000.0)
        ),
        SizeDoubtKind::Inches => format!(
            "the model is {side} mm long: saved in inches? That would be {} mm",
            three_digits(l * 25.4)
        ),
        SizeDoubtKind::Huge => {
            format!("the model is {side} mm long: in which unit was it saved?")
        }
        SizeDoubtKind::Far(far) => format!(
            "the model is {side} mm long but lies {} mm from the origin: files with 32-bit numbers keep steps of {} mm there",
            three_digits(far),
            three_digits(far * f64::from(f32::EPSILON))
        ),
    };
    Diagnostic::warning(message).at(Place::File(file.to_owned()))
}

/// Three significant digits or so, without an exponent where people would not write one.
fn three_digits(x: f64) -> String {
    if (1e-3..1e7).contains(&x.abs()) {
        let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 6) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.1e}")
    }
}
