//! What cutting a forest into pieces found, in words.

use crate::diag::Diagnostic;
use crate::split::{Piece, Split, SplitError};

/// Why there are no pieces, with what to change.
pub fn refusal(error: &SplitError) -> Diagnostic {
    let help = match error {
        SplitError::ThinBase(_) => "a thicker base: `base: Disc(thickness: 5)`",
        SplitError::SmallBed => "the size of your printer: `printer: (bed: (256, 256, 256))`",
        SplitError::Body(_) => "without `--split`: slicers cut other bodies",
        SplitError::Carve(_) => "without `--split` the forest comes in one piece",
    };
    Diagnostic::error(format!("the forest cannot be split: {error}")).help(help)
}

/// What is worth telling of the pieces.
pub fn remarks(split: &Split) -> Vec<Diagnostic> {
    let named = |is: &dyn Fn(&Piece) -> bool| {
        let names = split.pieces.iter().filter(|p| is(p));
        let names: Vec<&str> = names.map(|p| p.name.as_str()).collect();
        (!names.is_empty()).then(|| names.join(", "))
    };
    let mut remarks = Vec::new();
    if named(&|p| p.is_plate).is_none() {
        let text = "the forest has no base: `--split` makes pillars without pegs, and no plates";
        remarks.push(Diagnostic::warning(text).help("layout.svg shows where they belong"));
    }
    if let Some(loose) = named(&|p| p.solid.parts() > 1) {
        let text = format!("of several loose parts: {loose}");
        remarks.push(Diagnostic::warning(text));
    }
    if let Some(mute) = named(&|p| !p.engraved) {
        let text = format!("no room to engrave the number of: {mute}");
        let help = "their files are numbered all the same, and layout.svg shows every number";
        remarks.push(Diagnostic::warning(text).help(help));
    }
    remarks
}

/// That the file of all pieces is missing, because one is not sound where it would stand.
pub fn left_out(piece: &str) -> Diagnostic {
    let text = format!("split.3mf is left out: {piece} is not sound beside the others");
    Diagnostic::warning(text).help("the files in split/ are complete")
}
