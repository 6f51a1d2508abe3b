//! Pure geometry: image planes, planar predicates, distances in space, solid angles.
//!
//! Millimetres, z up, f64 throughout. Nothing here knows meshes, scenes or files.

mod angles;
mod image_plane;
mod inscribed;
mod planar;
pub mod rings;
mod spatial;

pub use angles::{ARCMIN, SQUARE_ARCMIN, half_angle, parallax, solid_angle};
pub use image_plane::{FAR_MM, ImagePlane, READING_MM, nothing_mm};
pub use inscribed::{Circle, inscribed};
pub use planar::{
    barycentric, contains, gap, hull, narrowest, orient, polygon_area, segment_crossing, to_segment,
};
pub use spatial::{
    against, area_vector, distance_to_segment, distance_to_triangle, distance_within, height,
    nearest_points, share_on_segment,
};
