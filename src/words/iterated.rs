//! Iterations that did not converge.

use crate::diag::Diagnostic;
use crate::mimic::{Ending, Iterated};

/// What to warn of, if it did not converge.
pub fn unsettled(view: &str, found: &Iterated) -> Option<Diagnostic> {
    let how = match found.ending {
        Ending::Converged => return None,
        Ending::Unfinished => format!("did not settle in {} rounds", found.allowed),
        Ending::Diverged => format!("diverged in round {}", found.rounds.len()),
        Ending::Failed => format!("could not be solved in round {}", found.rounds.len() + 1),
    };
    let kept = match found.kept {
        0 => "the linearised surface is kept".to_owned(),
        k => format!("the surface of round {k} is kept"),
    };
    let text = format!(
        "view \"{view}\": the iterated Laplacian {how}; {kept} (normals turned by {:.2} degrees on average, linearised {:.2})",
        found.kept_deg, found.linearised_deg
    );
    let help = "`iterate: 0` is the paper's own energy; iterating works for small, regular meshes";
    Some(Diagnostic::warning(text).help(help))
}
