//! Smaller meshes of the same form, for quick looks: the only module that names `alum`.
//!
//! Takes a mesh and the most vertices it may have. Collapses half-edges in the order of their quadric errors (Garland & Heckbert
//! 1997, planes weighted by area), each vertex into a neighbour. Promises: every vertex left is one of the mesh's own, where it
//! was; borders stay borders, and only their own points are left on them; a 2-manifold stays one, with its parts and handles;
//! the same mesh gives the same result. Vertices at which surfaces touch stay, and so do those whose going would move the surface by
//! more than [`LOST`]. Does not promise the number for these reasons (nor does a closed part get smaller than a tetrahedron), nor that
//! nothing intersects: no face turns by more than [`TURN`], which has been enough on all models tried.

use crate::geom::area_vector;
use crate::index::VertexId;
use crate::mesh::topology::{DisjointSets, Edges};
use crate::mesh::tri_mesh::TriMesh;
use alum::decimate::{Decimater, HasDecimation};
use alum::{Adaptor, Error, HH, Handle, HasIterators, PolyMeshT, VH};
use glam::{DMat3, DVec3};
use std::cell::Cell;

/// A smaller mesh, and which vertex of the larger one each of its vertices is.
#[derive(Clone, Debug, PartialEq)]
pub struct Simplified {
    pub mesh: TriMesh,
    /// Rising.
    pub vertices: Vec<VertexId>,
}

/// Cosine of the largest angle by which a collapse may turn a face: at 0 folds come up on thin fins, at 0.7 coarse meshes get
/// stuck above their number.
const TURN: f64 = 0.2;
/// A collapse makes no face thinner than this (height to longest side) unless it was before: normals of needles are noise.
const THINNEST: f64 = 0.05;
/// A face that is thinner becomes at most this much thinner still. Along a row of needles every collapse of two into one leans its
/// neighbours over: at 1 such rows stay, and what gives way instead is the form.
const THINNER: f64 = 0.5;
/// A collapse that moves the surface by more than this share of the mesh's diagonal (root of the mean square over the faces that a
/// vertex stands for) would lose its form. At 0.01 a ball ends at a hundred vertices, at 0.1 as a rock.
pub const LOST: f64 = 0.04;
/// A vertex with more edges stays until it has fewer: the poles of a ball by longitude and latitude. All of its edges are weighed after
/// every collapse beside it, each against all of its faces, so that a pole of 2000 took a minute.
const CROWDED: usize = 64;
/// Weight of the planes that hold borders, square to their faces.
const BORDER: f64 = 10.0;
/// Where errors are equal (flat parts) the shortest edge goes first: share of its length, to the fourth power as errors are.
const SHORTEST: f64 = 1e-9;

/// `mesh` with at most `most` vertices, as far as that goes. `None` if its faces cannot be told apart into surfaces.
pub fn simplified(mesh: &TriMesh, most: usize) -> Option<Simplified> {
    let surfaces = Surfaces::new(mesh);
    let mut halves = Halves::with_capacity(
        surfaces.vertex.len(),
        3 * mesh.faces.len() / 2,
        mesh.faces.len(),
    );
    let points: Vec<DVec3> = surfaces.points(mesh).collect();
    let handles: Vec<VH> = halves.add_vertices(&points).ok()?.collect();
    for face in &surfaces.faces {
        let [a, b, c] = face.map(|v| handles[v]);
        halves.add_tri_face(a, b, c).ok()?;
    }
    let (lo, hi) = mesh.bounds().unwrap_or_default();
    let mut by_error = ByError::new(&surfaces, points, LOST * lo.distance(hi));
    halves.decimate_to_vertex_count(&mut by_error, most).ok()?;
    Some(surfaces.left(mesh, &by_error.into))
}

/// The mesh as surfaces that touch nowhere: a vertex for every fan of faces that hang together.
struct Surfaces {
    faces: Vec<[VertexId; 3]>,
    /// The mesh's vertex of each.
    vertex: Vec<VertexId>,
    /// Those of which the mesh's vertex has several, or that lie on an edge of more than two faces.
    touching: Vec<bool>,
}

impl Surfaces {
    fn new(mesh: &TriMesh) -> Self {
        let mut fans = DisjointSets::new(3 * mesh.faces.len());
        for sides in Edges::new(mesh).iter() {
            if let [a, b] = sides
                && a.forward != b.forward
            {
                fans.join(a.end(0).0, b.end(1).0);
                fans.join(a.end(1).0, b.end(0).0);
            }
        }
        let (count, number) = fans.numbers();
        let faces: Vec<[VertexId; 3]> = number
            .chunks_exact(3)
            .map(|c| [c[0], c[1], c[2]].map(VertexId))
            .collect();
        let mut vertex = vec![VertexId(0); count];
        for (own, face) in faces.iter().flatten().zip(mesh.faces.iter().flatten()) {
            vertex[*own] = *face;
        }
        let mut fans_at = vec![0; mesh.vertices.len()];
        vertex.iter().for_each(|v| fans_at[*v] += 1);
        let touching = vertex.iter().map(|v| fans_at[*v] > 1).collect();
        Self {
            faces,
            vertex,
            touching,
        }
    }

    /// About the mesh's middle, so that errors far from the origin keep their digits.
    fn points(&self, mesh: &TriMesh) -> impl Iterator<Item = DVec3> {
        let (lo, hi) = mesh.bounds().unwrap_or_default();
        let middle = lo.midpoint(hi);
        self.vertex.iter().map(move |v| mesh.vertices[*v] - middle)
    }

    /// What is left when every vertex has gone `into` another, or stayed itself: the faces that still have three corners.
    fn left(&self, mesh: &TriMesh, into: &[VertexId]) -> Simplified {
        let end = |mut v: VertexId| {
            while into[v] != v {
                v = into[v];
            }
            self.vertex[v]
        };
        let faces = self.faces.iter().map(|f| f.map(end));
        let faces: Vec<[VertexId; 3]> = faces
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        let mut vertices: Vec<VertexId> = faces.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut number = vec![VertexId(0); mesh.vertices.len()];
        for (new, v) in VertexId::all(vertices.len()).zip(&vertices) {
            number[*v] = new;
        }
        let points = vertices.iter().map(|v| mesh.vertices[*v]);
        Simplified {
            mesh: TriMesh {
                vertices: points.collect(),
                faces: faces.iter().map(|f| f.map(|v| number[v])).collect(),
            },
            vertices,
        }
    }
}

/// Points as the library is to see them.
struct Points;

impl Adaptor<3> for Points {
    type Vector = DVec3;
    type Scalar = f64;

    fn vector(coords: [f64; 3]) -> DVec3 {
        DVec3::from_array(coords)
    }

    fn zero_vector() -> DVec3 {
        DVec3::ZERO
    }

    fn vector_coord(v: &DVec3, i: usize) -> f64 {
        v[i]
    }
}

type Halves = PolyMeshT<3, Points>;

fn number(v: VH) -> VertexId {
    VertexId(v.index())
}

/// Sum of weighted squared distances from planes: `p A p - 2 b p + c`.
#[derive(Clone, Copy, Default)]
struct Quadric {
    a: DMat3,
    b: DVec3,
    c: f64,
    /// Sum of the weights.
    weight: f64,
}

impl Quadric {
    const NONE: Self = Self {
        a: DMat3::ZERO,
        b: DVec3::ZERO,
        c: 0.0,
        weight: 0.0,
    };

    /// Of the plane through `point` with the unit `normal`.
    fn plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let (n, d) = (normal, normal.dot(point));
        Self {
            a: weight * DMat3::from_cols(n.x * n, n.y * n, n.z * n),
            b: weight * d * n,
            c: weight * d * d,
            weight,
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            a: self.a + other.a,
            b: self.b + other.b,
            c: self.c + other.c,
            weight: self.weight + other.weight,
        }
    }

    fn at(&self, p: DVec3) -> f64 {
        (p.dot(self.a * p) - 2.0 * self.b.dot(p) + self.c).max(0.0)
    }
}

/// The order of collapses, and where every vertex went.
struct ByError<'a> {
    surfaces: &'a Surfaces,
    points: Vec<DVec3>,
    quadrics: Vec<Quadric>,
    /// Itself: it is still there.
    into: Vec<VertexId>,
    /// Square of the distance that no collapse may reach.
    lost: f64,
    /// The vertex whose edges were counted last, and how many they were: those of one are weighed one after the other.
    counted: Cell<Option<(VertexId, usize)>>,
}

impl<'a> ByError<'a> {
    fn new(surfaces: &'a Surfaces, points: Vec<DVec3>, lost: f64) -> Self {
        let mut quadrics = vec![Quadric::NONE; points.len()];
        let mut add = |v: VertexId, q: Quadric| quadrics[v] = quadrics[v].plus(q);
        let area = |face: [VertexId; 3]| area_vector(face.map(|v| points[v]));
        for face in &surfaces.faces {
            let normal = area(*face);
            let at = points[face[0]];
            let own = Quadric::plane(normal.normalize_or_zero(), at, normal.length() / 2.0);
            face.iter().for_each(|v| add(*v, own));
        }
        let mesh = TriMesh {
            vertices: Vec::new(),
            faces: surfaces.faces.clone(),
        };
        for sides in Edges::new(&mesh).iter().filter(|sides| sides.len() == 1) {
            let ends = [sides[0].low, sides[0].high];
            let [a, b] = ends.map(|v| points[v]);
            let across = area(surfaces.faces[sides[0].face]).cross(b - a);
            let weight = BORDER * a.distance_squared(b);
            let own = Quadric::plane(across.normalize_or_zero(), a, weight);
            ends.iter().for_each(|v| add(*v, own));
        }
        Self {
            surfaces,
            lost: lost * lost,
            into: VertexId::all(points.len()).collect(),
            counted: Cell::new(None),
            points,
            quadrics,
        }
    }

    fn sum(&self, from: VH, to: VH) -> Quadric {
        let [a, b] = [from, to].map(|v| self.quadrics[number(v)]);
        a.plus(b)
    }

    /// Number of edges at a vertex, as far as that matters.
    fn edges_at(&self, mesh: &Halves, v: VH) -> usize {
        if let Some((_, edges)) = self.counted.get().filter(|(of, _)| *of == number(v)) {
            return edges;
        }
        let edges = mesh.vv_ccw_iter(v).take(CROWDED + 1).count();
        self.counted.set(Some((number(v), edges)));
        edges
    }

    /// Whether the faces that stay when a vertex goes to another neither fold nor become needles.
    fn stays_sound(&self, mesh: &Halves, from: VH, to: VH) -> bool {
        mesh.vf_ccw_iter(from).all(|face| {
            let mut corners = mesh.fv_ccw_iter(face);
            let [Some(a), Some(b), Some(c)] = [(); 3].map(|()| corners.next()) else {
                return false;
            };
            if [a, b, c].contains(&to) {
                return true;
            }
            let at = |v: VH| self.points[number(v)];
            let before = [a, b, c].map(at);
            let after = [a, b, c].map(|v| at(if v == from { to } else { v }));
            let [was, becomes] = [before, after].map(|p| area_vector(p).normalize_or_zero());
            let thinnest = match slimness(before) {
                needle if needle < THINNEST => THINNER * needle,
                _ => THINNEST,
            };
            was.dot(becomes) >= TURN && slimness(after) >= thinnest
        })
    }
}

/// Height over the longest side, relative to it.
fn slimness(p: [DVec3; 3]) -> f64 {
    let side = |k: usize| p[k].distance_squared(p[(k + 1) % 3]);
    area_vector(p).length() / side(0).max(side(1)).max(side(2))
}

impl Decimater<Halves> for ByError<'_> {
    type Cost = f64;

    fn collapse_cost(&self, mesh: &Halves, h: HH) -> Option<f64> {
        let (from, to) = (h.tail(mesh), h.head(mesh));
        let along_border = h.is_boundary(mesh) || h.opposite().is_boundary(mesh);
        let held =
            self.surfaces.touching[number(from)] || (from.is_boundary(mesh) && !along_border);
        let edges = self.edges_at(mesh, from);
        // A tetrahedron would become flat; it has three edges at every vertex.
        let last = !from.is_boundary(mesh) && edges <= 3;
        if held || last || edges > CROWDED {
            return None;
        }
        let [p, q] = [from, to].map(|v| self.points[number(v)]);
        let sum = self.sum(from, to);
        let error = sum.at(q);
        let keeps_form = error <= self.lost * sum.weight;
        (keeps_form && self.stays_sound(mesh, from, to))
            .then(|| error + SHORTEST * p.distance_squared(q).powi(2))
    }

    fn before_collapse(&mut self, mesh: &Halves, h: HH) -> Result<(), Error> {
        let (from, to) = (h.tail(mesh), h.head(mesh));
        self.quadrics[number(to)] = self.sum(from, to);
        self.into[number(from)] = number(to);
        self.counted.set(None);
        Ok(())
    }

    fn after_collapse(&mut self, _: &Halves, _: VH) -> Result<(), Error> {
        Ok(())
    }
}
