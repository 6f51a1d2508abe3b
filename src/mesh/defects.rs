//! What is wrong with a mesh, as values: how many of each kind and one place to look at.
//!
//! Takes a welded mesh (vertices at the same place are one vertex; else every seam is an open edge). A mesh without
//! blocking defects bounds a printable body: closed, consistently wound, every edge with two faces, every vertex with
//! one fan, no two faces in each other's way, material inside.

use crate::index::{FaceId, VertexId};
use crate::mesh::intersect::some_intersections;
use crate::mesh::shells::{ClosedSurface, Shell, shells_of};
use crate::mesh::topology::{Edges, HalfEdge, bowtie_vertices};
use crate::mesh::tri_mesh::TriMesh;
use crate::mesh::turns::projection_axis;
use crate::mesh::weld::duplicate_groups;
use glam::DVec3;
use std::fmt;

/// Kinds of defects, in the order in which they are reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DefectKind {
    NoFaces,
    /// Coordinates that are not finite numbers.
    NonFinite,
    /// Faces with a vertex index that does not exist.
    BadIndex,
    /// Faces that name a vertex twice.
    RepeatedIndex,
    /// Faces whose three different corners lie on one line.
    ZeroArea,
    /// Faces with the same three vertices as an earlier face.
    DuplicateFace,
    /// Edges with one face only.
    OpenEdge,
    /// Edges with three or more faces.
    CrowdedEdge,
    /// Edges whose two faces run the same way along them.
    MixedWinding,
    /// Vertices in which separate fans of faces meet tip to tip.
    BowtieVertex,
    /// Pairs of faces that cut, touch or overlap.
    SelfIntersection,
    /// The whole encloses no volume, or a negative one.
    InsideOut,
    /// Some shells face the wrong way, or lie inside of the material of another.
    MisplacedShell,
    /// Vertices that no face uses.
    UnreferencedVertex,
}

impl DefectKind {
    /// A stable name for programs.
    pub fn name(self) -> &'static str {
        match self {
            Self::NoFaces => "no_faces",
            Self::NonFinite => "non_finite",
            Self::BadIndex => "bad_index",
            Self::RepeatedIndex => "repeated_index",
            Self::ZeroArea => "zero_area",
            Self::DuplicateFace => "duplicate_face",
            Self::OpenEdge => "open_edge",
            Self::CrowdedEdge => "crowded_edge",
            Self::MixedWinding => "mixed_winding",
            Self::BowtieVertex => "bowtie_vertex",
            Self::SelfIntersection => "self_intersection",
            Self::InsideOut => "inside_out",
            Self::MisplacedShell => "misplaced_shell",
            Self::UnreferencedVertex => "unreferenced_vertex",
        }
    }
}

/// One kind of defect of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defect {
    pub kind: DefectKind,
    /// How many.
    pub count: usize,
    /// Whether counting was stopped at `count`.
    pub at_least: bool,
    /// One example, millimetres.
    pub place: Option<DVec3>,
}

impl Defect {
    fn new(kind: DefectKind, count: usize, place: Option<DVec3>) -> Self {
        Self {
            kind,
            count,
            at_least: false,
            place,
        }
    }

    /// Whether a mesh with it bounds no printable body.
    pub fn blocks_printing(&self) -> bool {
        self.kind != DefectKind::UnreferencedVertex
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use DefectKind::*;
        let (one, many) = match self.kind {
            NoFaces => return f.write_str("no faces"),
            SelfIntersection if self.count == 0 => {
                return f.write_str(
                    "faces that may cut each other: too many in one place to compare all",
                );
            }
            InsideOut => return f.write_str("encloses no volume or is inside out"),
            NonFinite => (
                "vertex that is not a finite point",
                "vertices that are not finite points",
            ),
            BadIndex => (
                "face with an index out of range",
                "faces with indices out of range",
            ),
            RepeatedIndex => (
                "face that uses a vertex twice",
                "faces that use a vertex twice",
            ),
            ZeroArea => ("face without area", "faces without area"),
            DuplicateFace => ("duplicate face", "duplicate faces"),
            OpenEdge => (
                "open edge (border of a hole)",
                "open edges (borders of holes)",
            ),
            CrowdedEdge => (
                "edge with more than two faces",
                "edges with more than two faces",
            ),
            MixedWinding => (
                "edge between faces that face opposite ways",
                "edges between faces that face opposite ways",
            ),
            BowtieVertex => (
                "vertex where surfaces only touch",
                "vertices where surfaces only touch",
            ),
            SelfIntersection => (
                "pair of faces that cut or touch each other",
                "pairs of faces that cut or touch each other",
            ),
            MisplacedShell => (
                "closed surface that is inside out or inside another body",
                "closed surfaces that are inside out or inside another body",
            ),
            UnreferencedVertex => ("vertex without a face", "vertices without a face"),
        };
        let least = if self.at_least { "at least " } else { "" };
        let noun = if self.count == 1 { one } else { many };
        write!(f, "{least}{} {noun}", self.count)?;
        match self.place {
            Some(p) => write!(
                f,
                ", {} ({:.3}, {:.3}, {:.3})",
                if self.count == 1 { "at" } else { "one at" },
                p.x,
                p.y,
                p.z
            ),
            None => Ok(()),
        }
    }
}

/// Pairs of intersecting faces are counted up to here: a mesh with that many is hopeless, and one with all faces in one
/// place has quadratically many.
const MAX_PAIRS: usize = 20_000;
/// Comparisons of faces in a mesh that has other defects already, or is only looked at, for each face and besides: a sound mesh needs
/// some twenty for each, while thousands of faces on one edge or in one place need the square of their number.
const COMPARISONS: [u64; 2] = [50, 20_000_000];

/// All defects of a welded mesh, in the order of [`DefectKind`]; empty for a printable one.
///
/// Intersections are looked for in any mesh with finite coordinates, the way shells lie only in otherwise sound ones.
pub fn check(mesh: &TriMesh) -> Vec<Defect> {
    checked(mesh, |hopeless| match hopeless {
        true => some_intersections(mesh, MAX_PAIRS, soon(mesh)),
        false => some_intersections(mesh, MAX_PAIRS, u64::MAX),
    })
}

/// The same of a mesh that is only looked at: millions of needles whose boxes all meet would take minutes to compare, and what is not
/// found soon is not told.
pub(crate) fn check_soon(mesh: &TriMesh) -> Vec<Defect> {
    checked(mesh, |_| {
        let (pairs, all) = some_intersections(mesh, MAX_PAIRS, soon(mesh));
        let none = pairs.is_empty();
        (pairs, all || none)
    })
}

/// As many comparisons of faces as sound meshes need, and some.
fn soon(mesh: &TriMesh) -> u64 {
    let [each, besides] = COMPARISONS;
    each * mesh.faces.len() as u64 + besides
}

fn checked(
    mesh: &TriMesh,
    intersections: impl FnOnce(bool) -> (Vec<[FaceId; 2]>, bool),
) -> Vec<Defect> {
    let fatal = unreadable(mesh);
    if !fatal.is_empty() {
        return fatal;
    }
    let edges = Edges::new(mesh);
    found(mesh, &edges, intersections, || shells_of(mesh, &edges))
}

/// The same of a surface whose faces are known to be in nobody's way.
pub(crate) fn check_parted(surface: &ClosedSurface) -> Vec<Defect> {
    let mesh = &surface.mesh;
    let fatal = unreadable(mesh);
    if !fatal.is_empty() {
        return fatal;
    }
    let none = |_| (Vec::new(), true);
    found(mesh, &surface.edges, none, || surface.shells.clone())
}

/// The defects of a mesh that can be read. `intersections` is asked for pairs of faces, and whether that are all; it is told whether
/// the mesh has other defects already.
fn found(
    mesh: &TriMesh,
    edges: &Edges,
    intersections: impl FnOnce(bool) -> (Vec<[FaceId; 2]>, bool),
    shells: impl FnOnce() -> Vec<Shell>,
) -> Vec<Defect> {
    let mut defects = face_defects(mesh);
    defects.extend(edge_defects(mesh, edges));
    let bowties = bowtie_vertices(mesh, edges);
    push(
        &mut defects,
        DefectKind::BowtieVertex,
        bowties.len(),
        || mesh.vertices[bowties[0]],
    );
    let (pairs, all) = intersections(!defects.is_empty());
    if !pairs.is_empty() || !all {
        defects.push(Defect {
            kind: DefectKind::SelfIntersection,
            count: pairs.len(),
            at_least: !all,
            place: pairs.first().map(|pair| meeting_place(mesh, *pair)),
        });
    }
    if defects.is_empty() {
        defects.extend(shell_defects(mesh, &shells()));
    }
    defects.extend(unreferenced(mesh));
    defects
}

fn push(defects: &mut Vec<Defect>, kind: DefectKind, count: usize, place: impl FnOnce() -> DVec3) {
    if count > 0 {
        defects.push(Defect::new(kind, count, Some(place())));
    }
}

/// What keeps all other checks from working.
fn unreadable(mesh: &TriMesh) -> Vec<Defect> {
    if mesh.faces.is_empty() {
        return vec![Defect::new(DefectKind::NoFaces, 1, None)];
    }
    let counts = [
        (
            DefectKind::NonFinite,
            mesh.vertices.iter().filter(|v| !v.is_finite()).count(),
        ),
        (
            DefectKind::BadIndex,
            mesh.faces
                .iter()
                .filter(|f| f.iter().any(|v| v.at() >= mesh.vertices.len()))
                .count(),
        ),
    ];
    counts
        .into_iter()
        .filter(|(_, count)| *count > 0)
        .map(|(kind, count)| Defect::new(kind, count, None))
        .collect()
}

fn face_defects(mesh: &TriMesh) -> Vec<Defect> {
    let mut defects = Vec::new();
    let repeats = |f: FaceId| {
        let [a, b, c] = mesh.faces[f];
        a == b || b == c || c == a
    };
    let faces = FaceId::all(mesh.faces.len());
    let repeated: Vec<FaceId> = faces.clone().filter(|f| repeats(*f)).collect();
    push(
        &mut defects,
        DefectKind::RepeatedIndex,
        repeated.len(),
        || mesh.corners(repeated[0])[0],
    );
    let flat: Vec<FaceId> = faces
        .filter(|f| !repeats(*f) && projection_axis(&mesh.corners(*f)).is_none())
        .collect();
    push(&mut defects, DefectKind::ZeroArea, flat.len(), || {
        centre(mesh, flat[0])
    });
    let duplicates = duplicate_groups(mesh);
    let extra = duplicates.iter().map(|g| g.len() - 1).sum();
    push(&mut defects, DefectKind::DuplicateFace, extra, || {
        centre(mesh, duplicates[0][1])
    });
    defects
}

/// Whether an edge, given by its half-edges, has a defect.
type EdgeTest = fn(&[HalfEdge]) -> bool;

fn edge_defects(mesh: &TriMesh, edges: &Edges) -> Vec<Defect> {
    let mut defects = Vec::new();
    let kinds: [(DefectKind, EdgeTest); 3] = [
        (DefectKind::OpenEdge, |e| e.len() == 1),
        (DefectKind::CrowdedEdge, |e| e.len() > 2),
        (DefectKind::MixedWinding, |e| {
            e.len() == 2 && e[0].forward == e[1].forward
        }),
    ];
    for (kind, is_bad) in kinds {
        let bad: Vec<&[HalfEdge]> = edges.iter().filter(|e| is_bad(e)).collect();
        push(&mut defects, kind, bad.len(), || {
            let end = |v: VertexId| mesh.vertices[v];
            end(bad[0][0].low).midpoint(end(bad[0][0].high))
        });
    }
    defects
}

/// The way the shells of a closed mesh lie.
fn shell_defects(mesh: &TriMesh, shells: &[Shell]) -> Vec<Defect> {
    let volume: f64 = shells.iter().map(|s| s.volume).sum();
    let wrong: Vec<&Shell> = shells.iter().filter(|s| !s.is_sound()).collect();
    let mut defects = Vec::new();
    if volume <= 0.0 {
        defects.push(Defect::new(DefectKind::InsideOut, 1, None));
    }
    if shells.len() > 1 {
        push(
            &mut defects,
            DefectKind::MisplacedShell,
            wrong.len(),
            || mesh.corners(wrong[0].first_face)[0],
        );
    }
    defects
}

fn unreferenced(mesh: &TriMesh) -> Option<Defect> {
    let mut used = vec![false; mesh.vertices.len()];
    for v in mesh.faces.iter().flatten() {
        used[*v] = true;
    }
    let count = used.iter().filter(|u| !**u).count();
    let first = used.iter().position(|u| !*u)?;
    Some(Defect::new(
        DefectKind::UnreferencedVertex,
        count,
        Some(mesh.vertices[first]),
    ))
}

fn centre(mesh: &TriMesh, face: FaceId) -> DVec3 {
    mesh.corners(face).into_iter().sum::<DVec3>() / 3.0
}

/// A point near which two faces meet: the middle of what their boxes share.
fn meeting_place(mesh: &TriMesh, [a, b]: [FaceId; 2]) -> DVec3 {
    let [a, b] = [a, b].map(|f| crate::mesh::boxes::Box3::of_face(mesh, f));
    a.lo.max(b.lo).midpoint(a.hi.min(b.hi))
}
