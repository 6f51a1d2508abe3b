//! Views that come out far from their models, and tears that had to be given up, in words.

use crate::diag::Diagnostic;
use crate::kinds::ReliefKind;
use crate::mimic::Energy;
use crate::steps::StepSummary;

/// Normals turned by more than this on average are another shape, degrees: a nose or a limb is flat. What one is warned of at 15 still
/// looks like its model; at 35 faces of coins have lost their noses.
const FAR_DEG: f64 = 25.0;

/// What to warn of if a view's normals are turned by `mean_deg` on average. Energies that compress depth are not meant to keep them.
pub fn far_off(view: &str, mean_deg: f64, relief: &ReliefKind) -> Option<Diagnostic> {
    let help = match relief {
        ReliefKind::HeightField(Energy::Normal(_) | Energy::Curvature(_)) => {
            "`energy: Normal(steps: Allowed())` tears the surface where the eye does not see it; thicker layers (`front`, `back`) help too"
        }
        ReliefKind::Torn(..) | ReliefKind::Whole(..) => {
            "thicker layers (`front`, `back`), or supports that face the eye"
        }
        ReliefKind::HeightField(Energy::Linear | Energy::Gradient(_)) => return None,
    };
    let text = format!(
        "view \"{view}\": its surface is turned by {mean_deg:.1} degrees from its models' on average: the layer is too thin or too crooked for them"
    );
    (mean_deg > FAR_DEG).then(|| Diagnostic::warning(text).help(help))
}

/// More of a relief than this at a limit of its layer is seen as a plateau: of the bundled reliefs in one piece none has more than 0.013
/// (the herd), a coin whose nose is cut off has 0.13 to 0.21.
const PLATEAU: f64 = 0.05;

/// What to warn of if so large a `share` of a relief in one piece lies flat at a limit of its layer.
pub fn plateau(view: &str, share: f64, relief: &ReliefKind) -> Option<Diagnostic> {
    let help = match relief {
        ReliefKind::HeightField(Energy::Normal(_)) => {
            "thicker layers (`front`, `back`) leave it room; `energy: Curvature()` bends the surface instead, `energy: Normal(steps: Allowed())` tears it"
        }
        ReliefKind::HeightField(Energy::Curvature(_)) => {
            "thicker layers (`front`, `back`) leave it room"
        }
        // Torn pieces begin anew at steps, and compressed depths reach both limits by definition.
        ReliefKind::HeightField(_) | ReliefKind::Torn(..) | ReliefKind::Whole(..) => return None,
    };
    let text = format!(
        "view \"{view}\": {:.0} % of its relief lies flat at a limit of its layer: what stands out there is cut off",
        100.0 * share
    );
    (share > PLATEAU).then(|| Diagnostic::warning(text).help(help))
}

/// What to warn of if tears had to be given up.
pub fn tears_given_up(view: &str, found: &StepSummary) -> Option<Diagnostic> {
    let text = format!(
        "view \"{view}\": tears had to be given up {} times, because their bounds contradict each other: its surface is farther from its models than it might be",
        found.given_up
    );
    (found.given_up > 0)
        .then(|| Diagnostic::warning(text).help("thicker layers (`front`, `back`) leave them room"))
}
