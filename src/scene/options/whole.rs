//! `relief`: whether whole meshes are deformed, and what a scene must be like for that.

use crate::kinds::Bounded;
use crate::mesh::{Edges, HalfEdge, TriMesh};
use crate::scene::defaults;
use crate::scene::language::raw::{RawBounded, RawEnergy, RawRelief, RawScene, RawSteps};
use crate::scene::text::{Field, Reader, Span, error_at, short};
use crate::support::{SUNK_MM, Support};

/// What of whole meshes is held; `None`: reliefs are height fields.
pub(crate) fn whole(reader: &mut Reader, raw: &RawScene) -> Option<Bounded> {
    let (relief, span) = reader.given(&raw.relief)?;
    let RawRelief::Whole(whole) = relief else {
        return None;
    };
    let bounded = match reader.given(&whole.bounded) {
        Some((RawBounded::Outline, _)) => Bounded::Outline,
        Some((RawBounded::Seen, _)) => Bounded::Seen,
        None => defaults::BOUNDED,
    };
    check_energy(reader, raw, &span);
    Some(bounded)
}

/// Only what is an optimum over the whole mesh, and never torn.
fn check_energy(reader: &mut Reader, raw: &RawScene, relief: &Span) {
    let Some((energy, at)) = reader.given(&raw.energy) else {
        return;
    };
    match energy {
        RawEnergy::Linear | RawEnergy::Gradient(_) => reader.problems.push(
            error_at(
                &at,
                "a whole mesh keeps its hidden parts in order, which this baseline cannot",
            )
            .help("`energy: Normal()` or `energy: Curvature()`, or `relief: HeightField`"),
        ),
        RawEnergy::Normal(normal) => {
            if let Some((RawSteps::Allowed(_), _)) = reader.given(&normal.steps) {
                reader.problems.push(
                    error_at(
                        relief,
                        "a whole mesh stays in one piece, but `energy` allows steps",
                    )
                    .help("`energy: Normal(steps: Never)`, or `relief: HeightField`"),
                );
            }
        }
        RawEnergy::Curvature(_) => {}
    }
}

/// Whole meshes stand on bodies, whose layers end at their surface.
pub(crate) fn check_supports(
    reader: &mut Reader,
    raw: &RawScene,
    whole: Option<Bounded>,
    bodies: &[Support],
) {
    if whole.is_none() {
        return;
    }
    if let Field::Given(_) = raw.pillars {
        let Some((_, span)) = reader.given(&raw.relief) else {
            return;
        };
        reader.problems.push(
            error_at(&span, "whole meshes stand on one support each, but this scene has pillars")
                .help("`supports: [Plate(width: 120, height: 90)]` in place of `pillars`, or `relief: HeightField`"),
        );
    }
    let carved = bodies.iter().find_map(|b| {
        let back = b.layer.filter(|l| !l.goes_through())?.back();
        (back > SUNK_MM).then_some((&b.name, back))
    });
    if let (Some((name, back)), Some((_, span))) = (carved, reader.given(&raw.relief)) {
        let text = format!(
            "whole meshes stand on their support, but the layer of \"{name}\" goes {} mm into it",
            short(back)
        );
        reader
            .problems
            .push(error_at(&span, text).help("leave `back` out of `depth`"));
    }
}

/// A whole mesh becomes a solid.
pub(crate) fn check_closed(reader: &mut Reader, mesh: &TriMesh, name: &str, file: &Span) {
    let unpaired = |e: &&[HalfEdge]| !matches!(e, [a, b] if a.forward != b.forward);
    let open = Edges::new(mesh).iter().filter(unpaired).count();
    if open > 0 {
        reader.problems.push(
            error_at(file, format!("model \"{name}\" is not closed: {open} of its edges do not join two faces, but a whole mesh becomes a solid"))
                .help("close its holes, or `relief: HeightField`, which builds only what is seen"),
        );
    }
}

/// The outlines of whole meshes lie on their supports.
pub(crate) fn hold_outlines(supports: &mut [Support]) {
    let layers = supports.iter_mut().filter_map(|s| s.layer.as_mut());
    layers.for_each(|layer| layer.hull = true);
}
