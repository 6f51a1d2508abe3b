//! Whether a mesh is as large as a model in millimetres should be.
//!
//! For models used at the size they are saved in. Files of triangles name no unit; the length of a model gives the wrong ones away.

use crate::mesh::tri_mesh::TriMesh;

/// Longest side of a model, millimetres: up to which it is dust below the steps of printable files, up to which people
/// usually saved in metres (a hand is 0.2 of them), up to which in inches, and from which nothing prints it.
const DUST: f64 = 0.002;
const METRES: f64 = 0.5;
const INCHES: f64 = 2.0;
const HUGE: f64 = 1e5;
/// Files with f32 coordinates keep 1e-7 of them: this many lengths from the origin a thousandth of the model is lost.
const FAR: f64 = 1e4;

/// What is odd about the size of a model, taken as millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeDoubt {
    pub kind: SizeDoubtKind,
    /// Longest side, millimetres.
    pub side: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SizeDoubtKind {
    /// Less than a printable file can hold.
    Dust,
    /// As small as what was saved in metres.
    Metres,
    /// As small as what was saved in inches.
    Inches,
    Huge,
    /// So many millimetres from the origin that f32 files cannot hold it.
    Far(f64),
}

/// `None` if nothing is odd.
pub fn size_doubt(mesh: &TriMesh) -> Option<SizeDoubt> {
    let (lo, hi) = mesh.bounds()?;
    let side = (hi - lo).max_element();
    let far = lo.abs().max(hi.abs()).max_element();
    let kind = match side {
        l if l < DUST => SizeDoubtKind::Dust,
        l if l < METRES => SizeDoubtKind::Metres,
        l if l < INCHES => SizeDoubtKind::Inches,
        l if l > HUGE => SizeDoubtKind::Huge,
        l if far > FAR * l => SizeDoubtKind::Far(far),
        _ => return None,
    };
    Some(SizeDoubt { kind, side })
}
