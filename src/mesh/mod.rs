//! Triangle meshes and what can be said of them without an eye.

pub mod attributes;
pub mod boxes;
pub mod defects;
pub mod delaunay;
mod fans;
pub mod gate;
pub mod intersect;
pub mod order;
pub mod polygon;
pub mod resolve;
pub mod shells;
pub mod simplify;
pub mod size;
pub mod solid;
pub mod spare;
pub mod topology;
mod tri_mesh;
pub(crate) mod turns;
pub mod weld;

pub use attributes::{Attributes, LoweredFrom, NO_UV, Original, Uvs, VertexScalar, picked};
pub use defects::{Defect, DefectKind, check};
pub use intersect::{face_objects, self_intersections};
pub use resolve::{Resolved, Resolving, Tangled, resolved};
pub use shells::without_cavities;
pub use simplify::{Simplified, simplified};
pub use solid::Solid;
pub use spare::without_spare_corners;
pub(crate) use spare::without_spare_corners_where;
pub use topology::{DisjointSets, Edges, HalfEdge, face_components, face_neighbours, vertex_parts};
pub use tri_mesh::TriMesh;
pub use weld::{snap_to_f32, weld};
