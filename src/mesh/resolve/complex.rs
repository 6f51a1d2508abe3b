//! Triangles with as many forward as backward sides at every edge, under changes that keep it so.
//!
//! No manifold: any number of faces may share an edge, and no change asks. What the faces enclose is found afterwards (see
//! [`regions`](super::regions)). Two faces with the same corners and opposite sides cancel as soon as they meet.
//!
//! Bends are final ([`Bends`]), so any number of them through given corners comes to an end.

use super::bends::{Bends, Contradiction, replaced};
use crate::geom::{area_vector, distance_to_segment, height, nearest_points};
use crate::index::{FaceId, VertexId};
use crate::mesh::topology::{faces_around, sides};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::turns::projection_axis;
use crate::mesh::weld::drop_unreferenced;
use glam::DVec3;

/// Corners, edges and faces in each other's way that are nearer than this become one, millimetres. Sixty f32 steps at 100 mm, so that
/// rounding a new corner hardly ever brings about the next of its kind; a thousandth of a printed line, so that nobody sees it.
pub const NEAR_MM: f64 = 5e-4;

/// See the module. A face that is gone names one vertex three times.
pub(crate) struct Complex {
    pub mesh: TriMesh,
    /// Faces around each vertex, in no particular order.
    around: Vec<Vec<FaceId>>,
    /// How far each vertex is from the farthest place that was merged into it, millimetres.
    drift: Vec<f64>,
    bends: Bends,
    /// The largest distance that any point of the surface was moved by, millimetres.
    pub moved: f64,
    /// Where that was.
    pub moved_at: DVec3,
}

impl Complex {
    /// Of a mesh whose faces name three different vertices.
    pub(crate) fn new(mesh: TriMesh) -> Self {
        Self {
            drift: vec![0.0; mesh.vertices.len()],
            around: faces_around(&mesh),
            mesh,
            bends: Bends::default(),
            moved: 0.0,
            moved_at: DVec3::ZERO,
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
        let [a, b, c] = face;
        let all = sides(face).into_iter().zip([c, a, b]);
        let longest = all.max_by(|x, y| self.length(x.0).total_cmp(&self.length(y.0)));
        longest.unwrap_or(([a, b], c))
    }

    pub(crate) fn shortest_side(&self, face: [VertexId; 3]) -> [VertexId; 2] {
        let shortest = sides(face)
            .into_iter()
            .min_by(|x, y| self.length(*x).total_cmp(&self.length(*y)));
        shortest.unwrap_or([face[0], face[1]])
    }

    /// Above its longest side, millimetres.
    pub(crate) fn height(&self, face: [VertexId; 3]) -> f64 {
        height(face.map(|v| self.place(v)))
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
        self.note_move(v, self.bend(edge, v));
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

    /// Flips the edge between two faces that lie flat, if that makes better faces of them; tells whether it did.
    pub(crate) fn flip_if_better(&mut self, [a, b]: [VertexId; 2]) -> bool {
        let at_edge = self.faces_at([a, b]);
        let [f, g] = match at_edge[..] {
            [f, g] => [f, g].map(|f| self.mesh.faces[f]),
            _ => return false,
        };
        let apex = |face: [VertexId; 3]| face.into_iter().find(|v| *v != a && *v != b);
        let runs_on = |face| sides(face).contains(&[a, b]);
        let (Some(u), Some(v)) = (apex(f), apex(g)) else {
            return false;
        };
        let new = [replaced(g, b, u), replaced(g, a, u)];
        if u == v || runs_on(f) == runs_on(g) || new.iter().any(|x| self.bends.parts(*x).is_some())
        {
            return false;
        }
        let [p, q] = [[a, b], [u, v]].map(|edge| edge.map(|v| self.place(v)));
        let [p, q] = nearest_points(p, q);
        let normals = [f, g, new[0], new[1]].map(|face| self.area_vector(face));
        let lies_flat =
            p.distance(q) < NEAR_MM && normals.iter().all(|n| n.dot(normals[0] + normals[1]) > 0.0);
        // A flip for less than rounding might come back.
        if !lies_flat || self.badness(new) >= self.badness([f, g]) * (1.0 - 1e-9) {
            return false;
        }
        let end = if self.drift[u] > self.drift[v] { u } else { v };
        self.note_move(end, p.distance(q));
        at_edge.into_iter().for_each(|f| self.remove(f));
        new.into_iter().for_each(|face| self.put(face));
        true
    }

    fn area_vector(&self, face: [VertexId; 3]) -> DVec3 {
        area_vector(face.map(|v| self.place(v)))
    }

    /// Least for Delaunay faces, of all that have the same corners in a plane (Musin 1997, "Properties of the Delaunay triangulation").
    fn badness(&self, faces: [[VertexId; 3]; 2]) -> f64 {
        let of = |face: [VertexId; 3]| {
            let squares = sides(face).into_iter().map(|e| self.length(e).powi(2));
            squares.sum::<f64>() / self.area_vector(face).length()
        };
        faces.into_iter().map(of).sum()
    }

    /// Bends a face to go through `v`, for good.
    pub(crate) fn bend_face(&mut self, f: FaceId, v: VertexId) {
        let face = self.mesh.faces[f];
        let normal = self.area_vector(face).normalize_or_zero();
        let off = self.place(v) - self.place(face[0]);
        self.note_move(v, off.dot(normal).abs());
        self.bends.bend_face(face, v);
        self.remove(f);
        self.add(vec![face]);
    }

    /// Makes one vertex of two: the earlier, where that is.
    pub(crate) fn merge(&mut self, a: VertexId, b: VertexId) {
        let faces = self.join([a, b]);
        self.add(faces);
    }

    /// Makes one vertex of two; takes away the faces that change, and gives what becomes of them.
    fn join(&mut self, [a, b]: [VertexId; 2]) -> Vec<[VertexId; 3]> {
        let (from, to) = (a.max(b), a.min(b));
        self.drift[to] = self.drift[to].max(self.drift[from] + self.length([from, to]));
        self.note_move(to, 0.0);
        self.bends.merge(from, to);
        let faces = self.around[from].clone();
        let moved = faces
            .iter()
            .map(|f| replaced(self.mesh.faces[*f], from, to));
        let moved = moved.collect();
        faces.into_iter().for_each(|f| self.remove(f));
        moved
    }

    /// How far an edge is from a corner, millimetres.
    fn bend(&self, edge: [VertexId; 2], v: VertexId) -> f64 {
        let [a, b] = edge.map(|v| self.place(v));
        distance_to_segment(self.place(v), a, b)
    }

    fn note_move(&mut self, v: VertexId, bent: f64) {
        let moved = self.drift[v] + bent;
        if moved > self.moved {
            self.moved = moved;
            self.moved_at = self.place(v);
        }
    }

    /// Lets an edge go through `v` from now on; takes away the faces that have it, and gives them.
    fn forbid(&mut self, edge: [VertexId; 2], v: VertexId) -> Vec<[VertexId; 3]> {
        self.note_move(v, self.bend(edge, v));
        self.bends.bend_edge(edge, v);
        let faces = self.faces_at(edge);
        let corners = faces.iter().map(|f| self.mesh.faces[*f]).collect();
        faces.into_iter().for_each(|f| self.remove(f));
        corners
    }

    /// Adds faces, or what they became where they or their edges were bent before.
    fn add(&mut self, mut faces: Vec<[VertexId; 3]>) {
        let chain = loop {
            match self.bends.chain(&faces) {
                Ok(chain) => break chain,
                Err(found) => faces.extend(self.settle(&found)),
            }
            // Of corners that became one.
            for face in &mut faces {
                *face = face.map(|v| self.bends.now(v));
            }
        };
        for ([a, b, c], times) in chain {
            let face = if times < 0 { [a, c, b] } else { [a, b, c] };
            (0..times.abs()).for_each(|_| self.put(face));
        }
    }

    /// Ends a contradiction: corners in a row of which none may be left out, or bends that have nothing to do with each other. Takes what
    /// moves less of two: the long side goes through the third corner, or the two nearest corners become one. Gives what becomes of the
    /// faces that change.
    fn settle(&mut self, found: &Contradiction) -> Vec<[VertexId; 3]> {
        let [a, b, c] = found.face;
        let near = self.nearest_two([a, b, c, found.through]);
        let (side, apex) = self.longest_side(found.face);
        let is_free = !self.bends.is_bent_edge(side);
        if is_free && self.bend(side, apex) < self.length(near) {
            self.forbid(side, apex)
        } else {
            self.join(near)
        }
    }

    fn nearest_two(&self, corners: [VertexId; 4]) -> [VertexId; 2] {
        let pairs = (0..4).flat_map(|i| (0..i).map(move |k| [corners[k], corners[i]]));
        let nearest = pairs.min_by(|x, y| self.length(*x).total_cmp(&self.length(*y)));
        nearest.unwrap_or([corners[0], corners[1]])
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
