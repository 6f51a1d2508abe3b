//! What would come off, and what is enclosed.

use super::check::{PrintCheck, PrintFinding};
use crate::certify::point::without_minus_zero;
use crate::index::{ComponentId, FaceId};
use crate::mesh::shells::shells;
use crate::mesh::{Solid, TriMesh, face_components};
use glam::DVec3;

/// What would come off, and what is enclosed. As many parts as there are `on_purpose` stay.
pub(crate) fn loose(whole: &Solid, on_purpose: usize) -> [PrintCheck; 2] {
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
    let check = |finding, found: &[(f64, (DVec3, f64))]| {
        let (place, size) = found.first().map_or_else(Default::default, |f| f.1);
        PrintCheck {
            finding,
            place: without_minus_zero(place),
            value_mm: size,
            wanted_mm: 0.0,
            limit_mm: 0.0,
            ok: found.is_empty(),
        }
    };
    let loose = &parts[on_purpose.min(parts.len())..];
    [
        check(PrintFinding::Part { count: loose.len() }, loose),
        check(
            PrintFinding::Cavity {
                count: cavities.len(),
            },
            &cavities,
        ),
    ]
}

/// Middle and diagonal of one component's box.
fn extent(mesh: &TriMesh, component: &[ComponentId], k: ComponentId) -> (DVec3, f64) {
    let corners = FaceId::all(mesh.faces.len())
        .filter(|f| component[*f] == k)
        .flat_map(|f| mesh.corners(f));
    let (lo, hi) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| {
        (lo.min(p), hi.max(p))
    });
    ((lo + hi) / 2.0, (hi - lo).length())
}
