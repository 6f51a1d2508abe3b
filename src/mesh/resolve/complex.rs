//! Triangles with as many forward as backward sides at every edge, under changes that keep it so.
//!
//! No manifold: any number of faces may share an edge, and no change asks. What the faces enclose is found afterwards (see
//! [`regions`](super::regions)). Two faces with the same corners and opposite sides cancel as soon as they meet.
//!
//! A bent edge never comes back: whatever would bring it back gets the two edges in its place, each of them shorter. So any number of
//! bends through given corners comes to an end.

use crate::index::{FaceId, VertexId};
use crate::mesh::intersect::projection_axis;
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::weld::drop_unreferenced;
use glam::DVec3;
use std::collections::HashMap;

/// See the module. A face that is gone names one vertex three times.
pub(crate) struct Complex {
    pub mesh: TriMesh,
    /// Faces around each vertex, in no particular order.
    around: Vec<Vec<FaceId>>,
    /// How far each vertex is from the farthest place that was merged into it, millimetres.
    drift: Vec<f64>,
    /// The corner that each bent edge goes through, and each bent face. Looked up, never iterated.
    bent_edges: HashMap<[VertexId; 2], VertexId>,
    // Looked up, never iterated.
    bent_faces: HashMap<[VertexId; 3], VertexId>,
    /// Where each merged vertex went. Looked up, never iterated.
    merged: HashMap<VertexId, VertexId>,
    /// The largest distance that any point of the surface was moved by, millimetres.
    pub moved: f64,
}

impl Complex {
    /// Of a mesh whose faces name three different vertices.
    pub(crate) fn new(mesh: TriMesh) -> Self {
        let mut around = vec![Vec::new(); mesh.vertices.len()];
        for (f, face) in FaceId::all(mesh.faces.len()).zip(&mesh.faces) {
            face.iter().for_each(|v| around[*v].push(f));
        }
        Self {
            drift: vec![0.0; mesh.vertices.len()],
            mesh,
            around,
            bent_edges: Default::default(),
            bent_faces: Default::default(),
            merged: Default::default(),
            moved: 0.0,
        }
    }

    pub(crate) fn place(&self, v: VertexId) -> DVec3 {
        self.mesh.vertices[v]
    }

    pub(crate) fn is_alive(&self, f: FaceId) -> bool {
        let [a, b, _] = self.mesh.faces[f];
        a != b
    }

    /// Whether a face has no area.
    pub(crate) fn is_flat(&self, f: FaceId) -> bool {
        projection_axis(&self.mesh.corners(f)).is_none()
    }

    fn length(&self, [a, b]: [VertexId; 2]) -> f64 {
        self.place(a).distance(self.place(b))
    }

    /// A face's longest side, and the corner it does not have.
    pub(crate) fn longest_side(&self, face: [VertexId; 3]) -> ([VertexId; 2], VertexId) {
        let side = |k: usize| [face[k], face[(k + 1) % 3]];
        let by_length =
            |x: &usize, y: &usize| self.length(side(*x)).total_cmp(&self.length(side(*y)));
        let k = (0..3).max_by(by_length).unwrap_or(0);
        (side(k), face[(k + 2) % 3])
    }

    pub(crate) fn shortest_side(&self, face: [VertexId; 3]) -> [VertexId; 2] {
        let [a, b, c] = face;
        let sides = [[a, b], [b, c], [c, a]].into_iter();
        let shortest = sides.min_by(|x, y| self.length(*x).total_cmp(&self.length(*y)));
        shortest.unwrap_or([a, b])
    }

    /// Above its longest side, millimetres.
    pub(crate) fn height(&self, face: [VertexId; 3]) -> f64 {
        let [a, b, c] = face.map(|v| self.place(v));
        let longest = self.length(self.longest_side(face).0);
        if longest == 0.0 {
            0.0
        } else {
            (b - a).cross(c - a).length() / longest
        }
    }

    pub(crate) fn faces_at(&self, [a, b]: [VertexId; 2]) -> Vec<FaceId> {
        let faces = self.around[a].iter().copied();
        faces.filter(|f| self.mesh.faces[*f].contains(&b)).collect()
    }

    /// A vertex at the f32 place nearest to `p`, on no face yet.
    pub(crate) fn add_vertex(&mut self, p: DVec3) -> VertexId {
        let v = VertexId::new(self.mesh.vertices.len());
        self.mesh.vertices.push(p.as_vec3().as_dvec3());
        self.around.push(Vec::new());
        self.drift.push(0.0);
        v
    }

    /// Bends an edge to go through `v`, for good.
    pub(crate) fn bend_edge(&mut self, edge: [VertexId; 2], v: VertexId) {
        let faces = self.forbid(edge, v);
        self.add(faces);
    }

    /// Bends an edge to go through `v`; it may come back.
    pub(crate) fn flip_edge(&mut self, edge: [VertexId; 2], v: VertexId) {
        self.note_bend(edge, v);
        let [a, b] = edge;
        for f in self.faces_at(edge) {
            let face = self.mesh.faces[f];
            self.remove(f);
            if !face.contains(&v) {
                self.put(replaced(face, b, v));
                self.put(replaced(face, a, v));
            }
        }
    }

    /// Bends a face to go through `v`, for good.
    pub(crate) fn bend_face(&mut self, f: FaceId, v: VertexId) {
        let face = self.mesh.faces[f];
        let [a, b, c] = face.map(|x| self.place(x));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        self.note_move(v, (self.place(v) - a).dot(normal).abs());
        self.bent_faces.insert(sorted(face), v);
        self.remove(f);
        self.add(vec![face]);
    }

    /// Makes one vertex of two: the earlier, where that is.
    pub(crate) fn merge(&mut self, a: VertexId, b: VertexId) {
        let (from, to) = (a.max(b), a.min(b));
        self.drift[to] = self.drift[to].max(self.drift[from] + self.length([from, to]));
        self.note_move(to, 0.0);
        self.merged.insert(from, to);
        let faces = self.around[from].clone();
        let moved = faces
            .iter()
            .map(|f| replaced(self.mesh.faces[*f], from, to));
        let moved = moved.collect();
        faces.into_iter().for_each(|f| self.remove(f));
        self.add(moved);
    }

    fn note_bend(&mut self, [a, b]: [VertexId; 2], v: VertexId) {
        self.note_move(
            v,
            distance_to_segment(self.place(v), self.place(a), self.place(b)),
        );
    }

    fn note_move(&mut self, v: VertexId, bent: f64) {
        self.moved = self.moved.max(self.drift[v] + bent);
    }

    /// Where a vertex is now.
    fn now(&self, mut v: VertexId) -> VertexId {
        while let Some(to) = self.merged.get(&v) {
            v = *to;
        }
        v
    }

    /// Lets an edge go through `v` from now on; takes away the faces that have it, and gives them.
    fn forbid(&mut self, [a, b]: [VertexId; 2], v: VertexId) -> Vec<[VertexId; 3]> {
        self.note_bend([a, b], v);
        self.bent_edges.insert([a.min(b), a.max(b)], v);
        let faces = self.faces_at([a, b]);
        let corners = faces.iter().map(|f| self.mesh.faces[*f]).collect();
        faces.into_iter().for_each(|f| self.remove(f));
        corners
    }

    /// Adds faces, or what they became where they or their edges were bent before.
    fn add(&mut self, mut open: Vec<[VertexId; 3]>) {
        let mut seen: Vec<[VertexId; 3]> = Vec::new();
        while let Some(face) = open.pop() {
            let [a, b, c] = face;
            if a == b || b == c || c == a {
                continue;
            }
            if let Some(([a, b], v)) = self.bent_side(face) {
                if seen.contains(&face) {
                    // Four corners in a row with neither diagonal allowed: then the long side of the four goes through them too.
                    let (side, apex) = self.longest_side(face);
                    open.extend(self.forbid(side, apex));
                } else {
                    seen.push(face);
                    open.extend([replaced(face, b, v), replaced(face, a, v)]);
                }
                continue;
            }
            let through = self.bent_faces.get(&sorted(face)).map(|v| self.now(*v));
            match through.filter(|v| !face.contains(v)) {
                Some(v) => open.extend([[a, b, v], [b, c, v], [c, a, v]]),
                None => self.put(face),
            }
        }
    }

    /// A side of a face that was bent, and the corner it goes through.
    fn bent_side(&self, face: [VertexId; 3]) -> Option<([VertexId; 2], VertexId)> {
        (0..3).find_map(|k| {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            let v = self.now(*self.bent_edges.get(&[a.min(b), a.max(b)])?);
            (v != a && v != b).then_some(([a, b], v))
        })
    }

    /// Adds a face, or takes away its reverse.
    fn put(&mut self, face: [VertexId; 3]) {
        let [a, b, c] = face;
        let reverse = [[a, c, b], [c, b, a], [b, a, c]];
        let is_reverse = |f: &FaceId| reverse.contains(&self.mesh.faces[*f]);
        if let Some(f) = self.around[a].iter().copied().find(is_reverse) {
            self.remove(f);
            return;
        }
        let f = FaceId::new(self.mesh.faces.len());
        self.mesh.faces.push(face);
        face.iter().for_each(|v| self.around[*v].push(f));
    }

    fn remove(&mut self, f: FaceId) {
        let face = self.mesh.faces[f];
        for v in face {
            self.around[v].retain(|x| *x != f);
        }
        self.mesh.faces[f] = [face[0]; 3];
    }

    /// The faces that are left, and the vertices they use.
    pub(crate) fn into_mesh(self) -> TriMesh {
        let mut mesh = self.mesh;
        mesh.faces.retain(|[a, b, _]| a != b);
        drop_unreferenced(&mut mesh);
        mesh
    }
}

fn replaced(face: [VertexId; 3], out: VertexId, by: VertexId) -> [VertexId; 3] {
    face.map(|v| if v == out { by } else { v })
}

fn sorted(mut face: [VertexId; 3]) -> [VertexId; 3] {
    face.sort_unstable();
    face
}

/// Millimetres.
pub(crate) fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    p.distance(a.lerp(b, share_on_segment(p, a, b)))
}

/// Where on a segment the point nearest to `p` is, 0 to 1.
pub(crate) fn share_on_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let square = along.length_squared();
    if square == 0.0 {
        return 0.0;
    }
    ((p - a).dot(along) / square).clamp(0.0, 1.0)
}
