//! What was found out about printing, in words.

use super::carrier::PILLAR;
use crate::certify::printability::{PrintCheck, PrintFinding, STEEP_DEG};
use crate::diag::Diagnostic;

/// Extent and meaning of a check; nothing if there is nothing to say. `carrier` is what [supports are
/// called](super::carrier::carrier).
pub fn note(found: &PrintCheck, carrier: &str) -> String {
    let (wanted, limit) = (found.wanted_mm, found.limit_mm);
    match &found.finding {
        PrintFinding::Wall(None) => format!("no wall is thinner than {wanted:.2} mm"),
        PrintFinding::Wall(Some(lost)) => format!(
            "{:.0} mm2 of walls below {limit:.2} mm, in {} pieces of at most {:.1} mm2, will not be printed",
            lost.area_mm2, lost.pieces, lost.largest_mm2
        ),
        PrintFinding::Gap {
            joined_mm2,
            closed_mm2,
        } => format!(
            "below {limit:.2} mm: {joined_mm2:.1} mm2 between {carrier}s, which will touch there, and {closed_mm2:.1} mm2 of slots within {carrier}s, which will close"
        ),
        PrintFinding::Overhang { ledges: 0 } => "nothing needs supports".to_owned(),
        PrintFinding::Overhang { ledges } => format!(
            "{ledges} regions flatter than {STEEP_DEG} degrees reach farther than wanted: print with the slicer's supports"
        ),
        PrintFinding::Slenderness {
            support,
            ratio,
            most,
        } => format!("{support} is {ratio:.1} times as high as wide; {most} times is the limit"),
        PrintFinding::Bed { body } => bed(body.as_deref(), found.ok, carrier),
        PrintFinding::Part { count } => format!("{count} parts would come off"),
        PrintFinding::Cavity { count } => format!("{count} hollows are closed"),
        PrintFinding::Core { support, area_mm2 } => {
            format!("{support} is left with {area_mm2:.1} mm2 there after all views carved it")
        }
    }
}

fn bed(body: Option<&str>, fits: bool, carrier: &str) -> String {
    let name = body.unwrap_or("the forest");
    let help = match (fits, body) {
        (true, _) => "",
        (false, None) if carrier != PILLAR => {
            "; only forests of pillars can be divided (`build --split`)"
        }
        (false, None) => "; `build --split` makes plates that fit",
        (false, Some(_)) => "; it cannot be divided further",
    };
    format!("the tightest side of {name}{help}")
}

/// A check that does not hold: an error if it spoils what is seen, a warning if it is a matter of the machine. `check` is what checks
/// are called.
pub fn verdict(found: &PrintCheck, carrier: &str, check: &str) -> Diagnostic {
    let PrintCheck {
        finding,
        place: [x, y, z],
        value_mm,
        limit_mm,
        ..
    } = found;
    let name = finding.name();
    let note = note(found, carrier);
    let text = format!(
        "{check} `{name}`: {value_mm:.2} mm at ({x:.1}, {y:.1}, {z:.1}) mm, and the limit is {limit_mm:.2} mm"
    );
    match finding.is_of_machine() {
        true => Diagnostic::warning(text).help(note),
        false => Diagnostic::error(text).help(note),
    }
}
