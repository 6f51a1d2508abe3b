//! Measures of the plan's page that its parts share, millimetres.

/// A4 on its side.
pub(crate) const WIDTH: f64 = 297.0;
pub(crate) const MARGIN: f64 = 11.0;
/// Edges of both columns.
pub(crate) const COLUMNS: [[f64; 2]; 2] = [[MARGIN, 146.0], [151.0, WIDTH - MARGIN]];
