//! What would come off, and what is enclosed.

use super::check::{Apart, PrintCheck, PrintFinding};
use crate::certify::point::without_minus_zero;
use crate::index::{ComponentId, FaceId};
use crate::mesh::shells::shells;
use crate::mesh::{Solid, TriMesh, face_components};
use glam::DVec3;

/// Parts that end less than this above the feet of others stand as they do, millimetres: what f32 files round.
const STANDS_MM: f64 = 0.01;

/// What would come off, and what is enclosed. Only the largest part stays, or those that stand `apart` on purpose.
pub(crate) fn loose(whole: &Solid, apart: Option<Apart>) -> [PrintCheck; 2] {
    let mesh = whole.mesh();
    let (mut parts, mut cavities) = (Vec::new(), Vec::new());
    if whole.parts() + whole.cavities() > 1 {
        let component = face_components(mesh);
        let shells = shells(mesh);
        for (k, shell) in ComponentId::all(shells.len()).zip(&shells) {
            let list = if shell.volume > 0.0 {
                &mut parts
            } else {
                &mut cavities
            };
            list.push((shell.volume.abs(), extent(mesh, &component, k)));
        }
    }
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    cavities.sort_by(|a, b| b.0.total_cmp(&a.0));
    let check = |finding, found: &[(f64, [DVec3; 2])]| {
        let [lo, hi] = found.first().map_or_else(Default::default, |f| f.1);
        PrintCheck {
            finding,
            place: without_minus_zero((lo + hi) / 2.0),
            value_mm: (hi - lo).length(),
            wanted_mm: 0.0,
            limit_mm: 0.0,
            ok: found.is_empty(),
        }
    };
    let stands = |part: &(f64, [DVec3; 2])| apart.is_none_or(|a| part.1[0].z <= a.foot + STANDS_MM);
    let (mut standing, mut loose): (Vec<_>, Vec<_>) = parts.into_iter().partition(stands);
    let most = apart.map_or(1, |a| a.parts).min(standing.len());
    loose.extend(standing.drain(most..));
    loose.sort_by(|a, b| b.0.total_cmp(&a.0));
    [
        check(PrintFinding::Part { count: loose.len() }, &loose),
        check(
            PrintFinding::Cavity {
                count: cavities.len(),
            },
            &cavities,
        ),
    ]
}

/// Corners of one component's box.
fn extent(mesh: &TriMesh, component: &[ComponentId], k: ComponentId) -> [DVec3; 2] {
    let corners = FaceId::all(mesh.faces.len())
        .filter(|f| component[*f] == k)
        .flat_map(|f| mesh.corners(f));
    let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    corners.fold(nothing, |[lo, hi], p| [lo.min(p), hi.max(p)])
}
