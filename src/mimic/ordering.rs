//! Which sheets lie before which (paper Eq 12): the depth order of the model along the eye's rays.
//!
//! For every vertex of a seen face, the nearest seen faces before and behind it on its ray. Vertex rows alone do not exclude
//! crossings of edges (the paper says so); reliefs are height fields over the view map, so none can self-intersect anyway.

use crate::bvh::Bvh;
use crate::groups::{Anchor, Groups, anchor};
use crate::mesh::TriMesh;
use crate::viewmap::{SupportField, Target, ViewMap};

/// Pairs nearer than this share of the model's depth touch rather than overlap: an order between them only adds noise.
const APART: f64 = 1e-4;

/// `front` stays before `back` on their common ray: `s_front depth_front / mu_front <= s_back depth_back / mu_back`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    pub front: Anchor,
    pub front_group: u32,
    pub back: Anchor,
    pub back_group: u32,
    /// `depth_front / depth_back` in the model, below 1.
    pub ratio: f64,
}

/// Orders of one view, by vertex, then front to back.
pub fn orders(target: &Target, map: &ViewMap, field: &SupportField, groups: &Groups) -> Vec<Order> {
    let lookup = FaceGroups::new(map, groups);
    let (sheet, faces) = seen_sheet(target, map);
    let bvh = Bvh::new(&sheet);
    let mut vertices: Vec<u32> = sheet.faces.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let incident = incident_faces(&sheet, &faces, target.mesh.vertices.len());
    let mut orders = Vec::new();
    for v in vertices {
        let q = target.image[v as usize];
        let direction = map.plane.direction(q);
        let Some((support, _)) = field.first_hit(map.plane.eye, direction) else {
            continue;
        };
        let own = incident[v as usize]
            .iter()
            .find_map(|f| lookup.get(*f, support));
        let (Some(own), depth) = (own, target.depth[v as usize]) else {
            continue;
        };
        let here = Anchor {
            vertices: [v; 3],
            weights: [1.0, 0.0, 0.0],
        };
        let hits = bvh.all_hits(map.plane.eye, direction);
        let others = hits
            .iter()
            .map(|h| (faces[h.face], h.t))
            .filter(|(f, _)| !target.mesh.faces[*f as usize].contains(&v));
        let apart = APART * depth;
        let nearest = |(f, t): (u32, f64)| {
            Some((anchor(target, f as usize, q).0, lookup.get(f, support)?, t))
        };
        let before = others
            .clone()
            .rfind(|h| h.1 < depth - apart)
            .and_then(nearest);
        let behind = others
            .clone()
            .find(|h| h.1 > depth + apart)
            .and_then(nearest);
        if let Some((front, front_group, t)) = before {
            orders.push(Order {
                front,
                front_group,
                back: here,
                back_group: own,
                ratio: t / depth,
            });
        }
        if let Some((back, back_group, t)) = behind {
            orders.push(Order {
                front: here,
                front_group: own,
                back,
                back_group,
                ratio: depth / t,
            });
        }
    }
    orders
}

/// The seen faces as a mesh over the target's vertices, and their indices in the target.
fn seen_sheet(target: &Target, map: &ViewMap) -> (TriMesh, Vec<u32>) {
    let mut faces: Vec<u32> = map.cells.iter().filter_map(|c| c.face).collect();
    faces.sort_unstable();
    faces.dedup();
    let sheet = faces
        .iter()
        .map(|f| target.mesh.faces[*f as usize])
        .collect();
    (
        TriMesh {
            vertices: target.mesh.vertices.clone(),
            faces: sheet,
        },
        faces,
    )
}

fn incident_faces(sheet: &TriMesh, faces: &[u32], vertices: usize) -> Vec<Vec<u32>> {
    let mut incident = vec![Vec::new(); vertices];
    for (i, face) in sheet.faces.iter().enumerate() {
        face.iter()
            .for_each(|v| incident[*v as usize].push(faces[i]));
    }
    incident
}

/// The group of a face on a support.
struct FaceGroups {
    /// `(face, support, group)`, sorted.
    entries: Vec<(u32, u32, u32)>,
}

impl FaceGroups {
    fn new(map: &ViewMap, groups: &Groups) -> Self {
        let entry = |(c, cell): (usize, &crate::viewmap::Cell)| {
            Some((cell.face?, cell.support?, groups.of_cell[c]?))
        };
        let mut entries: Vec<_> = map.cells.iter().enumerate().filter_map(entry).collect();
        entries.sort_unstable();
        entries.dedup();
        Self { entries }
    }

    fn get(&self, face: u32, support: u32) -> Option<u32> {
        let i = self
            .entries
            .partition_point(|e| (e.0, e.1) < (face, support));
        self.entries
            .get(i)
            .filter(|e| (e.0, e.1) == (face, support))
            .map(|e| e.2)
    }
}
