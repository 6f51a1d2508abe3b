//! Flat parts of a surface, triangulated anew so that no face is thinner than it must be.
//!
//! A boolean cuts flat faces along lines of many corners and triangulates what is left in any way: fans of faces tens of millimetres
//! long and a millionth high, which rounding to f32 turns over. Takes a closed manifold; flips edges between faces of one plane until
//! every flat part is Delaunay (Lawson 1977). No corner moves, and the surface moves by less than [`FLAT_MM`].

use crate::index::{FaceId, VertexId};
use crate::mesh::topology::{DisjointSets, face_neighbours, sides};
use crate::mesh::tri_mesh::TriMesh;
use glam::DVec3;
use robust::Coord;

/// Corners this near to a face's plane lie in it, millimetres: an eighth of an f32 step at 100 mm, so that a flip moves the surface by
/// less than rounding does anyway.
const FLAT_MM: f64 = 1e-6;

/// Flips edges within flat parts until they are Delaunay; gives how many. Edges with other than two faces stay.
pub fn make_delaunay(mesh: &mut TriMesh) -> usize {
    let across = face_neighbours(mesh);
    let seen = flat_parts(mesh, &across);
    let mut queue: Vec<(FaceId, [VertexId; 2])> = Vec::new();
    for f in FaceId::all(mesh.faces.len()).rev() {
        for (side, n) in sides(mesh.faces[f]).into_iter().zip(across[f]) {
            if n.is_some_and(|g| g > f && seen[f].is_some() && seen[g] == seen[f]) {
                queue.push((f, side));
            }
        }
    }
    let mut work = Flips { mesh, across, seen };
    let mut flips = 0;
    // A part is seen the same way throughout, so every flip lowers its lifted surface (Lawson's potential): none comes back.
    while let Some((f, side)) = queue.pop() {
        let Some((k, g)) = work.beyond(f, side) else {
            continue;
        };
        if work.flip(f, k, g) {
            flips += 1;
            for h in [f, g] {
                queue.extend(sides(work.mesh.faces[h]).map(|side| (h, side)));
            }
        }
    }
    flips
}

/// How a flat part is seen as a figure in the plane: along an axis, from the front.
#[derive(Clone, Copy, PartialEq, Eq)]
struct FlatPart {
    /// The lowest face of the part.
    part: FaceId,
    axis: usize,
    from_below: bool,
}

impl FlatPart {
    fn of(&self, p: DVec3) -> Coord<f64> {
        let (x, y) = (p[(self.axis + 1) % 3], p[(self.axis + 2) % 3]);
        if self.from_below {
            Coord { x: y, y: x }
        } else {
            Coord { x, y }
        }
    }
}

/// How each face's flat part is seen; `None` for a face that is alone in its plane.
fn flat_parts(mesh: &TriMesh, across: &[[Option<FaceId>; 3]]) -> Vec<Option<FlatPart>> {
    let mut parts = DisjointSets::new(mesh.faces.len());
    for (f, near) in FaceId::all(mesh.faces.len()).zip(across) {
        for g in near.iter().flatten().filter(|g| **g > f) {
            if coplanar(mesh, f, *g) {
                parts.join(f.0, g.0);
            }
        }
    }
    let mut seen = vec![None; mesh.faces.len()];
    for part in parts.members().into_iter().filter(|p| p.len() > 1) {
        let normals = part.iter().map(|f| mesh.area_vector(FaceId::new(*f)));
        let largest = normals.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        let normal = largest.unwrap_or_default();
        let axis = normal.abs().max_position();
        for f in &part {
            seen[*f] = Some(FlatPart {
                part: FaceId::new(part[0]),
                axis,
                from_below: normal[axis] < 0.0,
            });
        }
    }
    seen
}

/// Whether the smaller of two faces lies in the plane of the larger.
fn coplanar(mesh: &TriMesh, f: FaceId, g: FaceId) -> bool {
    let (a, b) = (mesh.area_vector(f), mesh.area_vector(g));
    let (large, small, normal) = if a.length_squared() >= b.length_squared() {
        (f, g, a)
    } else {
        (g, f, b)
    };
    let foot = mesh.corners(large)[0];
    let length = normal.length();
    let off = mesh.corners(small).map(|p| (p - foot).dot(normal).abs());
    length > 0.0 && off.iter().all(|d| *d <= FLAT_MM * length)
}

struct Flips<'a> {
    mesh: &'a mut TriMesh,
    across: Vec<[Option<FaceId>; 3]>,
    seen: Vec<Option<FlatPart>>,
}

impl Flips<'_> {
    /// Which side of `f` that is, and the face beyond it; `None` if `f` has it no more.
    fn beyond(&self, f: FaceId, side: [VertexId; 2]) -> Option<(usize, FaceId)> {
        let k = sides(self.mesh.faces[f]).iter().position(|s| *s == side)?;
        Some((k, self.across[f][k]?))
    }

    /// Flips side `k` of `f`, beyond which `g` lies, if that is better.
    fn flip(&mut self, f: FaceId, k: usize, g: FaceId) -> bool {
        let face = self.mesh.faces[f];
        let (u, v, a) = (face[k], face[(k + 1) % 3], face[(k + 2) % 3]);
        let other = self.mesh.faces[g];
        let Some(j) = sides(other).iter().position(|s| *s == [v, u]) else {
            return false;
        };
        let b = other[(j + 2) % 3];
        if a == b || !self.improves(f, g, [u, v, a, b]) || self.has_edge(f, a, b) {
            return false;
        }
        let (va, au) = (self.across[f][(k + 1) % 3], self.across[f][(k + 2) % 3]);
        let (ub, bv) = (self.across[g][(j + 1) % 3], self.across[g][(j + 2) % 3]);
        self.mesh.faces[f] = [u, b, a];
        self.mesh.faces[g] = [b, v, a];
        self.across[f] = [ub, Some(g), au];
        self.across[g] = [bv, va, Some(f)];
        for (n, side, to) in [(ub, [b, u], f), (va, [a, v], g)] {
            if let Some((k, n)) = n.and_then(|n| Some((self.beyond(n, side)?.0, n))) {
                self.across[n][k] = Some(to);
            }
        }
        true
    }

    /// Whether `a` to `b` is the better diagonal of a figure in the plane.
    fn improves(&self, f: FaceId, g: FaceId, quad: [VertexId; 4]) -> bool {
        let Some(part) = self.seen[f].filter(|_| self.seen[f] == self.seen[g]) else {
            return false;
        };
        let [u, v, a, b] = quad.map(|x| part.of(self.mesh.vertices[x]));
        let upright = |p, q, r| robust::orient2d(p, q, r) > 0.0;
        upright(u, v, a)
            && upright(v, u, b)
            && upright(u, b, a)
            && upright(b, v, a)
            && robust::incircle(u, v, a, b) > 0.0
            && coplanar(self.mesh, f, g)
    }

    /// Whether a face around `a`, a corner of `f`, has `b` too.
    fn has_edge(&self, f: FaceId, a: VertexId, b: VertexId) -> bool {
        let mut at = f;
        loop {
            let face = self.mesh.faces[at];
            if face.contains(&b) {
                return true;
            }
            let k = face.iter().position(|v| *v == a);
            match k.and_then(|k| self.across[at][k]) {
                Some(next) if next != f => at = next,
                Some(_) => return false,
                // At an edge of more than two faces `b` may be anywhere beyond.
                None => return true,
            }
        }
    }
}
